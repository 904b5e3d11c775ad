/* SPDX-License-Identifier: BSD-3-Clause */
#include "make.h"
#include "search.h"

struct search search_create(const char *method, size_t ndof, size_t contacts, const double *mass, const double *damping,
                            const double *stiffness, const double *direction, double omega, const double *cosine)
{
    struct search s = {.ndof = ndof, .omega = omega, .period = 2.0 * PI / omega};
    assert_ok(dense_system(&s.sys, ndof, contacts, mass, damping, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_load(s.sys, omega, cosine, NULL));
    s.drv = driver_create(s.sys, method, 0.1, 1e-14);
    return s;
}

struct search oscillator_search(const char *method, double damping, double limit, double force, double omega)
{
    const double one = 1.0;
    struct search s = search_create(method, 1, 1, &one, &damping, &one, &one, omega, &force);
    assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), limit));
    return s;
}

void search_free(struct search *s)
{
    tribo_driver_destroy(s->drv);
    tribo_system_destroy(s->sys);
}

void find(const struct search *s, double t, double *y)
{
    const int status = tribo_driver_find_periodic(s->drv, t, s->period, y);
    require(!status, "%s: %s", tribo_strerror(status), tribo_driver_message(s->drv));
}

double amplitude(const struct search *s, size_t dof)
{
    double c[2 * MOST_DOFS] = {0}, least, most;
    c[dof] = 1.0;
    const int status = tribo_driver_period_extremes(s->drv, c, &least, &most, NULL, NULL);
    require(!status, "%s", tribo_driver_message(s->drv));
    assert_close(least, -most, 1e-9);
    return most;
}

double dissipated(const struct search *s, double *y)
{
    double t = 0.0;
    driver_advance(s->drv, &t, s->period, y);
    return y[2 * s->ndof];
}
