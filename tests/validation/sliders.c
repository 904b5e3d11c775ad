/* SPDX-License-Identifier: BSD-3-Clause */
#include "make.h"
#include "sliders.h"

tribo_system *linear(size_t n, size_t c, const double *mass, const double *damping, const double *stiffness,
                     const double *direction)
{
    tribo_system *s = NULL;
    char text[200] = "";
    const int status = dense_system(&s, n, c, mass, damping, stiffness, direction, 0, text, sizeof text);
    require(!status, "%s", text);
    return s;
}

tribo_system *element(double limit, size_t elements)
{
    const double share = 1.0 / (double)elements;
    double mass[9] = {1.0}, damping[9] = {0.1}, stiffness[9] = {2.0}, direction[6] = {0.0}, load[3] = {1.0};
    const size_t n = elements + 1;
    for (size_t i = 1; i < n; i++) {
        stiffness[i] = stiffness[i * n] = -share;
        stiffness[i * n + i] = share;
        direction[(i - 1) * n + i] = 1.0;
    }
    tribo_system *s = linear(n, elements, mass, damping, stiffness, direction);
    assert_ok(tribo_set_limit_all(tribo_system_context(s), limit * share));
    assert_ok(tribo_system_add_load(s, 1.1, load, NULL));
    return s;
}

const double masses[MASSES] = {1.0, 2.0, 1.5}, springs[SLIDERS] = {3.0, 1.5, 0.8}, limits[SLIDERS] = {0.4, 0.7, 0.25};
const double grounded[MASSES][MASSES] = {{3.0, -1.0, 0.0}, {-1.0, 2.5, -1.5}, {0.0, -1.5, 1.7}};
const double base_speed = 0.3, base_omega = 0.6, load_omega = 0.9, rigid_limit = 0.3;

tribo_system *structure(double between)
{
    double mass[DOFS * DOFS] = {0.0}, damping[DOFS * DOFS] = {0.0}, stiffness[DOFS * DOFS] = {0.0};
    double direction[(SLIDERS + 1) * DOFS] = {0.0}, base[SLIDERS + 1] = {0.0}, sine[DOFS] = {0.0, 0.9}, cosine[DOFS] = {0.0};
    for (size_t i = 0; i < MASSES; i++) {
        mass[i * DOFS + i] = masses[i];
        for (size_t j = 0; j < MASSES; j++) {
            stiffness[i * DOFS + j] = grounded[i][j];
            damping[i * DOFS + j] = 0.05 * grounded[i][j];
        }
    }
    const size_t on[SLIDERS] = {0, 0, 1};
    for (size_t i = 0; i < SLIDERS; i++) {
        const size_t q = on[i], w = MASSES + i;
        stiffness[q * DOFS + q] += springs[i];
        stiffness[w * DOFS + w] = springs[i];
        stiffness[q * DOFS + w] = stiffness[w * DOFS + q] = -springs[i];
        direction[i * DOFS + w] = 1.0;
    }
    for (size_t w = MASSES; w + 1 < DOFS; w++) {
        stiffness[w * DOFS + w] += between;
        stiffness[(w + 1) * DOFS + w + 1] += between;
        stiffness[w * DOFS + w + 1] = stiffness[(w + 1) * DOFS + w] = -between;
    }
    direction[1 * DOFS + 1] = -1.0;
    direction[SLIDERS * DOFS + 2] = 1.0;
    base[2] = base_speed;
    cosine[2] = 1.3;
    tribo_system *s = linear(DOFS, SLIDERS + 1, mass, damping, stiffness, direction);
    assert_ok(tribo_system_add_load(s, load_omega, cosine, sine));
    assert_ok(tribo_system_add_base_motion(s, base_omega, base, NULL));
    return s;
}

int see_most(const tribo_moment *moment, void *most)
{
    const double *y = moment->y;
    *(double *)most = fmax(*(double *)most, y[0]);
    return 0;
}
