static char help[] =
    "Quinn's chain of blocks on a frictional surface, distributed over the ranks: energy that friction takes in each cycle.\n"
    "  -da_grid_x N    blocks (32)\n"
    "  -limit L        mu times normal load of the whole chain (1)\n"
    "  -alpha A        amplitude of the force that pulls the first block (0.25); -omega W: its frequency (0.5)\n"
    "  -cycles C       of the load (4), -steps S a cycle (2500); -ts_max_steps ends earlier\n"
    "  -lambda_dt X    rate at which stuck blocks come to rest, times the step (0.4)\n"
    "  -step_form      central differences and Coulomb's law over a step, in a plain loop, instead of TS and Quinn's law\n"
    "Every option of TS works in both: -ts_monitor, -ts_monitor_solution_vtk 'chain-%04D.vts', ...\n";

#include <petscdmda.h>
#include <petscts.h>

#include "tribo_petsc.h"

/* What a block knows: place, velocity, and the energy that its friction has taken. */
typedef struct {
    PetscScalar u, v, d;
} Block;

/* A rank has a context for its own blocks and nobody else's: blocks on the ground share no body, so that each is an island. */
typedef struct {
    DM da;
    PetscInt n, first, count; /* blocks of all ranks, and those of this one */
    PetscReal limit, alpha, omega, lambda_dt;
    tribo_context *contacts;
    PetscReal *v, *a, *f; /* [count] what tribo reads and writes */
    char where[80];       /* which blocks these are, for messages */
    PetscLogStage friction;
} Chain;

static PetscErrorCode CreateContacts(Chain *c, PetscReal dt)
{
    PetscFunctionBeginUser;
    PetscCall(PetscSNPrintf(c->where, sizeof c->where, "its contact 0 is block %" PetscInt_FMT, c->first));
    PetscCall(PetscMalloc3(c->count, &c->v, c->count, &c->a, c->count, &c->f));
    PetscCheck(!tribo_create(&c->contacts, (size_t)c->count), PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for contacts");
    for (PetscInt i = 0; i < c->count; i++) {
        c->v[i] = (PetscReal)c->n; /* blocks weigh 1/n */
    }
    PetscCallTribo(tribo_set_operator_diagonal(c->contacts, c->v), tribo_message(c->contacts), c->where);
    PetscCallTribo(tribo_set_limit_all(c->contacts, c->limit / (PetscReal)c->n), tribo_message(c->contacts), c->where);
    PetscCallTribo(tribo_set_epsilon_step(c->contacts, dt, c->lambda_dt), tribo_message(c->contacts), c->where);
    PetscCall(PetscLogStageRegister("friction", &c->friction));
    PetscFunctionReturn(0);
}

/* Accelerations without friction, a, and velocities, v, of the rank's blocks. x is indexed by block and has ghosts. */
static void Accelerate(const Chain *c, PetscReal t, const Block *x)
{
    const PetscReal n = (PetscReal)c->n, spring = n * n;
    for (PetscInt k = 0; k < c->count; k++) {
        const PetscInt i = c->first + k;
        if (i == 0) {
            c->a[k] = spring * (x[1].u - x[0].u) + n * c->alpha * PetscSinReal(c->omega * t);
        } else if (i == c->n - 1) {
            c->a[k] = spring * (4.0 / 3.0 * x[i - 1].u - 4.0 * x[i].u);
        } else {
            c->a[k] = spring * (x[i - 1].u - 2.0 * x[i].u + x[i + 1].u);
        }
        c->v[k] = x[i].v;
    }
}

/* Fills v and a from the state: the ranks tell each other the places of the blocks at their borders. */
static PetscErrorCode FindAccelerations(Chain *c, PetscReal t, Vec state)
{
    Vec local;
    const Block *x;

    PetscFunctionBeginUser;
    PetscCall(DMGetLocalVector(c->da, &local));
    PetscCall(DMGlobalToLocal(c->da, state, INSERT_VALUES, local));
    PetscCall(DMDAVecGetArrayRead(c->da, local, &x));
    Accelerate(c, t, x);
    PetscCall(DMDAVecRestoreArrayRead(c->da, local, &x));
    PetscCall(DMRestoreLocalVector(c->da, &local));
    PetscFunctionReturn(0);
}

/* For TS: u' = v, v' = a + n f, and d' = -f v, with f from Quinn's law. */
static PetscErrorCode RHSFunction(TS ts, PetscReal t, Vec state, Vec derivative, void *chain)
{
    Chain *c = chain;
    Block *y;

    PetscFunctionBeginUser;
    (void)ts;
    PetscCall(FindAccelerations(c, t, state));
    PetscCall(PetscLogStagePush(c->friction));
    PetscCallTribo(tribo_balance(c->contacts, c->v, c->a, NULL, c->f), tribo_message(c->contacts), c->where);
    PetscCall(PetscLogStagePop());
    PetscCall(DMDAVecGetArrayWrite(c->da, derivative, &y));
    for (PetscInt k = 0; k < c->count; k++) {
        const Block rate = {c->v[k], c->a[k] + (PetscReal)c->n * c->f[k], -c->f[k] * c->v[k]};
        y[c->first + k] = rate;
    }
    PetscCall(DMDAVecRestoreArrayWrite(c->da, derivative, &y));
    PetscFunctionReturn(0);
}

/* Central differences: velocities live half a step before places. Takes them over the time h, around t, and the places on by
 * dt. The force is the one that leaves the blocks in Coulomb's law at the end of h. */
static PetscErrorCode StepForm(Chain *c, PetscReal t, PetscReal h, PetscReal dt, Vec state)
{
    Block *x;

    PetscFunctionBeginUser;
    PetscCall(FindAccelerations(c, t, state));
    PetscCall(DMDAVecGetArray(c->da, state, &x));
    for (PetscInt k = 0; k < c->count; k++) {
        c->v[k] += h * c->a[k];
    }
    PetscCall(PetscLogStagePush(c->friction));
    PetscCallTribo(tribo_step_force(c->contacts, h, c->v, c->f), tribo_message(c->contacts), c->where);
    PetscCall(PetscLogStagePop());
    for (PetscInt k = 0; k < c->count; k++) {
        Block *b = &x[c->first + k];
        const PetscReal end = c->v[k] + h * (PetscReal)c->n * c->f[k];
        b->d -= h * c->f[k] * 0.5 * (b->v + end);
        b->v = end;
        b->u += dt * end;
    }
    PetscCall(DMDAVecRestoreArray(c->da, state, &x));
    PetscFunctionReturn(0);
}

/* What TSSolve does, for StepForm: up to the TS's largest number of steps. */
static PetscErrorCode SolveStepForm(Chain *c, TS ts, Vec state)
{
    PetscReal t, dt;
    PetscInt step, last;

    PetscFunctionBeginUser;
    PetscCall(TSGetTime(ts, &t));
    PetscCall(TSGetTimeStep(ts, &dt));
    PetscCall(TSGetStepNumber(ts, &step));
    PetscCall(TSGetMaxSteps(ts, &last));
    for (; step < last; t += dt, step++) {
        PetscCall(TSMonitor(ts, step, t, state));
        PetscCall(StepForm(c, t, step ? dt : 0.5 * dt, dt, state)); /* from velocities at t = 0 */
    }
    PetscCall(TSMonitor(ts, step, t, state));
    PetscCall(TSSetTime(ts, t));
    PetscCall(TSSetStepNumber(ts, step));
    PetscFunctionReturn(0);
}

/* Energy that friction has taken up to the TS's time. That of StepForm is half a step behind: a copy goes there. */
static PetscErrorCode FindDissipation(Chain *c, TS ts, PetscBool step_form, Vec state, PetscReal *d)
{
    PetscReal t, dt;
    Vec now;

    PetscFunctionBeginUser;
    PetscCall(VecDuplicate(state, &now));
    PetscCall(VecCopy(state, now));
    if (step_form) {
        PetscCall(TSGetTime(ts, &t));
        PetscCall(TSGetTimeStep(ts, &dt));
        PetscCall(StepForm(c, t, 0.5 * dt, 0.0, now));
    }
    PetscCall(VecStrideSum(now, 2, d));
    PetscCall(VecDestroy(&now));
    PetscFunctionReturn(0);
}

/* Runs cycle after cycle and prints what each takes. */
static PetscErrorCode Run(Chain *c, TS ts, PetscInt cycles, PetscInt steps, PetscBool step_form)
{
    PetscReal before = 0.0, after = 0.0;
    PetscInt most;
    Vec state;

    PetscFunctionBeginUser;
    PetscCall(DMCreateGlobalVector(c->da, &state));
    PetscCall(PetscObjectSetName((PetscObject)state, "chain"));
    PetscCall(TSSetSolution(ts, state));
    PetscCall(TSGetMaxSteps(ts, &most));
    for (PetscInt cycle = 1; cycle <= cycles && (cycle - 1) * steps < most; cycle++, before = after) {
        PetscCall(TSSetMaxSteps(ts, PetscMin(cycle * steps, most)));
        PetscCall(step_form ? SolveStepForm(c, ts, state) : TSSolve(ts, state));
        PetscCall(FindDissipation(c, ts, step_form, state, &after));
        PetscCall(PetscPrintf(PETSC_COMM_WORLD, "cycle %" PetscInt_FMT " dissipates %.13g\n", cycle, (double)(after - before)));
    }
    PetscCall(VecDestroy(&state));
    PetscFunctionReturn(0);
}

/* Steps of one length, counted: a last one that ends at a time would differ from the others by rounding. */
static PetscErrorCode CreateTS(Chain *c, PetscReal dt, TS *ts)
{
    TSAdapt adapt;

    PetscFunctionBeginUser;
    PetscCall(TSCreate(PETSC_COMM_WORLD, ts));
    PetscCall(TSSetDM(*ts, c->da));
    PetscCall(TSSetType(*ts, TSRK));
    PetscCall(TSRKSetType(*ts, TSRK4));
    PetscCall(TSSetRHSFunction(*ts, NULL, RHSFunction, c));
    PetscCall(TSGetAdapt(*ts, &adapt));
    PetscCall(TSAdaptSetType(adapt, TSADAPTNONE));
    PetscCall(TSSetExactFinalTime(*ts, TS_EXACTFINALTIME_STEPOVER));
    PetscCall(TSSetMaxTime(*ts, PETSC_MAX_REAL));
    PetscCall(TSSetMaxSteps(*ts, PETSC_MAX_INT));
    PetscCall(TSSetFromOptions(*ts));
    PetscCall(TSSetTimeStep(*ts, dt));
    PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
    Chain c = {.n = 32, .limit = 1.0, .alpha = 0.25, .omega = 0.5, .lambda_dt = 0.4};
    PetscInt cycles = 4, steps = 2500;
    PetscBool step_form = PETSC_FALSE;
    TS ts;

    PetscFunctionBeginUser;
    PetscCall(PetscInitialize(&argc, &argv, NULL, help));
    PetscOptionsBegin(PETSC_COMM_WORLD, NULL, "Quinn's chain", NULL);
    PetscCall(PetscOptionsReal("-limit", "mu times normal load of the whole chain", NULL, c.limit, &c.limit, NULL));
    PetscCall(PetscOptionsReal("-alpha", "amplitude of the load", NULL, c.alpha, &c.alpha, NULL));
    PetscCall(PetscOptionsReal("-omega", "frequency of the load", NULL, c.omega, &c.omega, NULL));
    PetscCall(PetscOptionsReal("-lambda_dt", "rate of stuck blocks times step", NULL, c.lambda_dt, &c.lambda_dt, NULL));
    PetscCall(PetscOptionsInt("-cycles", "of the load", NULL, cycles, &cycles, NULL));
    PetscCall(PetscOptionsRangeInt("-steps", "a cycle", NULL, steps, &steps, NULL, 1, PETSC_MAX_INT));
    PetscCall(PetscOptionsBool("-step_form", "central differences in a plain loop", NULL, step_form, &step_form, NULL));
    PetscOptionsEnd();
    PetscCheck(cycles <= PETSC_MAX_INT / steps, PETSC_COMM_WORLD, PETSC_ERR_ARG_OUTOFRANGE, "too many steps to be counted");
    PetscCall(DMDACreate1d(PETSC_COMM_WORLD, DM_BOUNDARY_NONE, c.n, 3, 1, NULL, &c.da));
    PetscCall(DMSetFromOptions(c.da));
    PetscCall(DMSetUp(c.da));
    PetscCall(DMDASetFieldName(c.da, 0, "displacement"));
    PetscCall(DMDASetFieldName(c.da, 1, "velocity"));
    PetscCall(DMDASetFieldName(c.da, 2, "dissipated"));
    PetscCall(DMDAGetInfo(c.da, NULL, &c.n, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL));
    PetscCheck(c.n >= 2, PETSC_COMM_WORLD, PETSC_ERR_ARG_OUTOFRANGE, "a chain has 2 blocks at least, not %" PetscInt_FMT, c.n);
    PetscCall(DMDAGetCorners(c.da, &c.first, NULL, NULL, &c.count, NULL, NULL));
    const PetscReal dt = 2.0 * PETSC_PI / c.omega / (PetscReal)steps,
                    stable = (step_form ? 2.0 : 2.828) / (2.1492 * (PetscReal)c.n);
    PetscCheck(dt < stable, PETSC_COMM_WORLD, PETSC_ERR_ARG_OUTOFRANGE,
               "steps of %g are not stable: less than %g, 2 (rk4: 2.828) over the chain's highest frequency", (double)dt,
               (double)stable);
    PetscCall(CreateContacts(&c, dt));
    PetscCall(CreateTS(&c, dt, &ts));
    PetscCall(Run(&c, ts, cycles, steps, step_form));
    tribo_destroy(c.contacts);
    PetscCall(PetscFree3(c.v, c.a, c.f));
    PetscCall(TSDestroy(&ts));
    PetscCall(DMDestroy(&c.da));
    PetscCall(PetscFinalize());
    return 0;
}
