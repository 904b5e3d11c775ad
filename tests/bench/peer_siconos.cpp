/* SPDX-License-Identifier: BSD-3-Clause */
/* Siconos: the time stepping of Moreau and Jean, theta = 1/2, with Coulomb's law as a relay between velocity and impulse. Its
 * answers are those of moreau/fixed, to the tolerance of its solver. Systems whose contacts do not move by themselves, J = 1.
 *
 * As fast as its own interfaces allow: one interaction for all contacts (one for each is ten times slower), a linear and
 * time-invariant system, so that all matrices are made once, and the solver that measured fastest, projected Gauss-Seidel. */
#include <cmath>
#include <memory>

#include <SiconosKernel.hpp>
#include <SolverOptions.h>

extern "C" {
#include "methods.h"
}

namespace {

void load(double t, unsigned n, double *force, unsigned, double *z)
{
    std::fill(force, force + n, 0.0);
    force[0] = z[0] * std::sin(z[1] * t);
}

template <class T, class... Arguments> std::shared_ptr<T> make(Arguments... arguments)
{
    return std::make_shared<T>(arguments...);
}

/* Motion, and the work that friction takes. */
class Simulated {
public:
    Simulated(const struct model &m, double step);
    void advance(size_t steps);
    double dissipated = 0.0;

private:
    std::shared_ptr<LagrangianLinearTIDS> body;
    std::shared_ptr<Interaction> contacts;
    std::shared_ptr<TimeStepping> stepping;
    std::vector<double> before;
};

Simulated::Simulated(const struct model &m, double step) : before(m.n, 0.0)
{
    const unsigned n = static_cast<unsigned>(m.n);
    const double k = n > 1 ? n : 1.0;
    const auto mass = make<SimpleMatrix>(n, n), stiffness = make<SimpleMatrix>(n, n), direction = make<SimpleMatrix>(n, n);
    const auto offset = make<SiconosVector>(n), parameters = make<SiconosVector>(2u);
    for (unsigned i = 0; i < n; i++) {
        (*mass)(i, i) = 1.0 / k;
        (*direction)(i, i) = 1.0;
        (*stiffness)(i, i) = n == 1 ? 1.0 : i == 0 ? k : i + 1 == n ? 4.0 * k : 2.0 * k;
        if (i > 0) {
            (*stiffness)(i, i - 1) = i + 1 == n ? -4.0 / 3.0 * k : -k;
            (*stiffness)(i - 1, i) = -k;
        }
        (*offset)(i) = -1e9; /* a position far below the surface: the contact is always closed */
    }
    (*parameters)(0) = m.alpha;
    (*parameters)(1) = m.omega;
    body = make<LagrangianLinearTIDS>(make<SiconosVector>(n), make<SiconosVector>(n), mass);
    body->setKPtr(stiffness);
    body->setzPtr(parameters);
    body->setComputeFExtFunction(load);
    const double impulse = step * m.limit[0] / k;
    contacts = make<Interaction>(make<RelayNSL>(n, -impulse, impulse), make<LagrangianLinearTIR>(direction, offset));
    const auto all = make<NonSmoothDynamicalSystem>(0.0, 1e9);
    all->insertDynamicalSystem(body);
    all->link(contacts, body);
    const auto solver = make<Relay>(static_cast<int>(SICONOS_RELAY_PGS));
    solver->numericsSolverOptions()->dparam[SICONOS_DPARAM_TOL] = 1e-12;
    solver->numericsSolverOptions()->iparam[SICONOS_IPARAM_MAX_ITER] = 10000;
    stepping = make<TimeStepping>(all, make<TimeDiscretisation>(0.0, step), make<MoreauJeanOSI>(0.5), solver);
    stepping->setNewtonOptions(SICONOS_TS_LINEAR);
}

void Simulated::advance(size_t steps)
{
    for (size_t k = 0; k < steps; k++) {
        stepping->computeOneStep();
        const SiconosVector &impulse = *contacts->lambda(1), &velocity = *body->velocity();
        for (unsigned i = 0; i < before.size(); i++) {
            dissipated -= 0.5 * impulse(i) * (velocity(i) + before[i]);
            before[i] = velocity(i);
        }
        stepping->nextStep();
    }
}

void run(const struct method *, const struct scene *s, double dt, struct outcome *o)
{
    const double cycle = s->end - s->begin;
    const size_t steps = static_cast<size_t>(std::ceil(cycle / dt * (1.0 - 1e-9)));
    const size_t first = static_cast<size_t>(std::lround(s->begin / cycle)) * steps;
    try {
        Simulated simulated(s->model, cycle / static_cast<double>(steps));
        simulated.advance(first);
        const double begin = simulated.dissipated;
        simulated.advance(steps);
        o->answer[0] = simulated.dissipated - begin;
        o->steps = o->evaluations = first + steps;
    } catch (...) {
        outcome_fail(o, "Siconos throws");
    }
}

int fits(const struct scene *s)
{
    return s->model.kind == OSCILLATOR || (s->model.kind == CHAIN && s->model.n <= 128);
}

const struct method all[] = {{"siconos", "moreau-jean", "coulomb", STEP, 0.0, fits, run, 0.0, 0}};

} // namespace

extern "C" const struct methods siconos_methods = {all, sizeof all / sizeof *all};
