/* SPDX-License-Identifier: BSD-3-Clause */
/* What is known of a structure with contacts held: modes, forces of those that hold, and what cannot be. */
#include "make.h"
#include "dynamics/exact/motion.h"
#include "dynamics/exact/modal.h"
#include "support.h"
#include "../../set_up_driver.h"

/* tribo_modal_create by slip and holds. */
static int create(struct modal **h, tribo_system *sys, const signed char *slip, const unsigned char *holds, int powers,
                  const struct modal *like)
{
    signed char key[256];
    ck_assert_uint_le(tribo_system_ncontact(sys), sizeof key);
    for (size_t i = 0; i < tribo_system_ncontact(sys); i++) {
        key[i] = (signed char)((slip[i] == 0) + holds[i]);
    }
    return tribo_modal_create(h, sys, slip, key, powers, like);
}

static int decompose(struct modal **h, tribo_system *sys, const signed char *slip, const unsigned char *holds)
{
    struct modal *found = NULL;
    const int status = create(&found, sys, slip, holds, 0, NULL);
    if (!status) {
        *h = found;
    }
    return status;
}

/* Response of an output to the first harmonic. */
static double complex response_of(const struct forced *f, const struct output *out)
{
    return out->cr[f->modal->exponents] + out->ci[f->modal->exponents] * I;
}

/* Body 2 on a spring of 4 to body 1, which is heavy; contacts between the ground and the light body 0, and between 0 and 1. */
static tribo_system *sandwich(double light)
{
    const double mass[] = {light, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.25}, direction[] = {1.0, 0.0, 0.0, -1.0, 1.0, 0.0};
    const double stiffness[] = {0.0, 0.0, 0.0, 0.0, 4.0, -4.0, 0.0, -4.0, 4.0}, load[] = {0.5, 3.0, 0.0};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 3, 2, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_load(sys, 1.0, load, NULL));
    return sys;
}

/* With both contacts held body 2 swings with omega = 4, as (cos 4t, sin 4t) of amplitude 2 (modal mass 1): either contact carries
 * -4 times that, and the load on what is below. */
TEST(both_hold)
{
    const signed char mode[] = {0, 0};
    const unsigned char holds[] = {1, 1};
    tribo_system *sys = sandwich(pow(10.0, -_i));
    struct modal *h;
    const int status = decompose(&h, sys, mode, holds);
    require(status == TRIBO_OK, "%s", tribo_system_message(sys));
    const struct forced *f = h->forced;
    ck_assert_uint_eq(h->modes, 1);
    ck_assert_uint_eq(h->exponents, 1);
    ck_assert_uint_eq(f->outputs, 2);
    ck_assert_uint_eq(f->sliding, 0);
    assert_close(h->omega2[0], 16.0, 1e-14);
    ck_assert_uint_eq(h->within[0], 1); /* K phi moves body 1 */
    ck_assert_uint_eq(h->within[1], 3);
    ck_assert_int_eq(h->phi[0] == 0.0, 1);
    assert_close(fabs(h->phi[1]), 2.0, 1e-14);
    for (size_t k = 0; k < 2; k++) {
        const struct output *out = &f->output[k];
        assert_close(out->size[0], 8.0, 1e-13);
        assert_close(creal(response_of(f, out)), out->contact == 0 ? -3.5 : -3.0, 1e-14);
        assert_close(cimag(response_of(f, out)), 0.0, 1e-14);
    }
    tribo_modal_free(h);
    tribo_system_destroy(sys);
}

/* With the upper contact held alone, the light body is a part of the heavy one. */
TEST(upper_holds)
{
    const double light = pow(10.0, -_i), whole = 1.0 + light;
    const signed char mode[] = {1, 0};
    const unsigned char holds[] = {0, 1};
    tribo_system *sys = sandwich(light);
    struct modal *h;
    assert_ok(decompose(&h, sys, mode, holds));
    const struct forced *f = h->forced;
    ck_assert_uint_eq(h->modes, 2);
    ck_assert_uint_eq(f->outputs, 2);
    ck_assert_uint_eq(f->sliding, 1);
    assert_exact(h->omega2[0], 0.0);
    ck_assert(tribo_modal_drifts(h, 0));
    assert_close(h->omega2[1] / (4.0 * (1.0 / whole + 4.0)), 1.0, 1e-14);
    /* what it carries is what accelerates the light body: light (spring + load)/whole - load of the light one; the spring's is
     * part of the exponent and of the response to the load, the direct part of the load is what is left of it */
    const struct output *out = &f->output[1];
    ck_assert_uint_eq(out->contact, 1);
    const double at = 4.0 * (1.0 / whole + 4.0) - 1.0; /* omega^2 - 1 of the stretch, which 3.5/whole shakes */
    const double stretch = -3.5 / whole / at, pull = 4.0 * stretch;
    assert_close(creal(response_of(f, out)), 0.5 - light * (3.5 + pull) / whole, 1e-13);
    tribo_modal_free(h);
    tribo_system_destroy(sys);
}

/* x_0 = 2 x_1 by a lever: mass 4 m_0 + m_1, stiffness 4 k_0 + k_1; the contact carries what body 0 needs. */
TEST(lever)
{
    const double mass[] = {3.0, 0.0, 0.0, 0.5}, stiffness[] = {7.0, 0.0, 0.0, 2.0}, direction[] = {1.0, -2.0};
    const double omega2 = 30.0 / 12.5, phi = sqrt(1.0 / 12.5);
    const signed char mode[] = {0};
    const unsigned char holds[] = {1};
    tribo_system *sys;
    struct modal *h;
    assert_ok(dense_system(&sys, 2, 1, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(decompose(&h, sys, mode, holds));
    const struct forced *f = h->forced;
    ck_assert_uint_eq(h->modes, 1);
    assert_close(h->omega2[0], omega2, 1e-15);
    assert_close(f->output[0].size[0], fabs((7.0 - 3.0 * omega2) * 2.0 * phi), 1e-14);
    tribo_modal_free(h);
    tribo_system_destroy(sys);
}

/* Two contacts between the same bodies cannot both be the ones that hold. */
TEST(too_many_hold)
{
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {2.0, -1.0, -1.0, 2.0}, direction[] = {1.0, -1.0, -2.0, 2.0};
    const signed char mode[] = {0, 0};
    const unsigned char holds[] = {1, 1};
    tribo_system *sys;
    struct modal *h;
    stain(&h, sizeof h);
    assert_ok(dense_system(&sys, 2, 2, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_status(decompose(&h, sys, mode, holds), TRIBO_ERR_INDEFINITE);
    assert_says(tribo_system_message(sys), "contact 1 cannot hold");
    ck_assert(stained(&h, sizeof h));
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------- what is kept of a set */

#define BODIES 9
#define CONTACTS (BODIES + 1)

/* A row of bodies on springs, each on a contact, and a contact between bodies 1 and 5. Loads on bodies 0 and 6. */
static tribo_system *row_of_bodies(struct random *r, double damping)
{
    double mass[BODIES * BODIES] = {0.0}, stiffness[BODIES * BODIES] = {0.0}, viscous[BODIES * BODIES] = {0.0};
    double direction[CONTACTS * BODIES] = {0.0};
    const double load[BODIES] = {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.5};
    for (size_t i = 0; i < BODIES; i++) {
        const double spring = uniform(r, 0.5, 2.0);
        mass[i * BODIES + i] = uniform(r, 1.0, 3.0);
        direction[i * BODIES + i] = uniform(r, 0.5, 1.5);
        stiffness[i * BODIES + i] += 0.1 + spring;
        if (i + 1 < BODIES) {
            stiffness[(i + 1) * BODIES + i + 1] += spring;
            stiffness[i * BODIES + i + 1] = stiffness[(i + 1) * BODIES + i] = -spring;
        }
    }
    for (size_t k = 0; k < BODIES * BODIES; k++) {
        viscous[k] = damping * stiffness[k];
    }
    direction[BODIES * BODIES + 1] = 1.0;
    direction[BODIES * BODIES + 5] = -1.0;
    tribo_system *sys;
    assert_ok(dense_system(&sys, BODIES, CONTACTS, mass, damping > 0.0 ? viscous : NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_load(sys, 0.3, load, NULL));
    return sys;
}

/* The same, to the bit. */
static void compare(const struct forced *f, const struct forced *g)
{
    ck_assert_uint_eq(f->terms, g->terms);
    ck_assert_uint_eq(f->sliding, g->sliding);
    ck_assert_uint_eq(f->outputs, g->outputs);
    assert_all_exact(f->lr, g->lr, f->terms);
    assert_all_exact(f->li, g->li, f->terms);
    for (size_t k = 0; k < f->outputs; k++) {
        const struct output *x = &f->output[k], *y = &g->output[k];
        ck_assert_uint_eq(x->contact, y->contact);
        assert_all_exact(x->cr, y->cr, f->terms);
        assert_all_exact(x->ci, y->ci, f->terms);
        assert_all_exact(x->on_rate, y->on_rate, f->shapes);
    }
}

/* Loads that change leave the decomposition of a set as it is; with it the set is what it is without. */
TEST(kept)
{
    struct random r = random_of(_i);
    tribo_system *sys = row_of_bodies(&r, _i % 2 ? 0.05 : 0.0);
    struct modal *same = NULL;
    for (int k = 0; k < 3; k++) {
        const double load[BODIES] = {0.0, 1.0, 0.0, -0.3};
        signed char slip[CONTACTS];
        unsigned char holds[CONTACTS];
        struct modal *h;
        for (size_t i = 0; i < CONTACTS; i++) {
            holds[i] = i == BODIES; /* the one between two bodies */
            slip[i] = !holds[i];
        }
        assert_ok(create(&same, sys, slip, holds, 0, NULL));
        assert_ok(decompose(&h, sys, slip, holds));
        compare(same->forced, h->forced);
        tribo_forced_free(same);
        tribo_modal_free(h);
        assert_ok(tribo_system_add_load(sys, 0.4 + k, load, NULL));
    }
    tribo_modal_free(same);
    tribo_system_destroy(sys);
}

/* Perturbations move over a short phase as they do by modes: of bodies in a row; and of equal ones without springs between them,
 * of one omega. Contacts on two bodies and between two hold. */
TEST(powers)
{
    struct random r = random_of(_i);
    const size_t columns = 3, size = 2 * BODIES * columns;
    double mass[BODIES * BODIES] = {0.0}, stiffness[BODIES * BODIES] = {0.0}, direction[CONTACTS * BODIES] = {0.0};
    double v[2 * BODIES * 3], w[2 * BODIES * 3];
    tribo_system *sys = _i % 3 ? row_of_bodies(&r, _i % 3 == 2 ? 0.05 : 0.0) : NULL;
    for (size_t i = 0; i < BODIES; i++) {
        mass[i * (BODIES + 1)] = stiffness[i * (BODIES + 1)] = direction[i * (BODIES + 1)] = 2.0;
    }
    direction[BODIES * BODIES + 1] = direction[BODIES * BODIES + 5] = 1.0;
    if (!sys) {
        assert_ok(dense_system(&sys, BODIES, CONTACTS, mass, NULL, stiffness, direction, 0, NULL, 0));
    }
    signed char slip[CONTACTS];
    unsigned char holds[CONTACTS];
    for (size_t i = 0; i < CONTACTS; i++) {
        holds[i] = i == 0 || i == 7 || i == BODIES;
        slip[i] = !holds[i];
    }
    struct modal *modes = NULL, *none = NULL;
    struct exact own = {.sys = sys};
    assert_ok(create(&modes, sys, slip, holds, 0, NULL));
    assert_ok(create(&none, sys, slip, holds, 1, NULL));
    ck_assert_ptr_null(modes->powers);
    ck_assert_uint_eq(none->exponents, 0);
    for (size_t k = 0; k < size; k++) {
        v[k] = w[k] = uniform(&r, -1.0, 1.0);
    }
    const double tau = TRIBO_POWERS_REACH / none->forced->quickest;
    require(none->forced->quickest >= modes->forced->quickest, "a bound of %g", none->forced->quickest);
    assert_ok(tribo_modal_transition(&own, modes, tau, columns, v, NULL));
    assert_ok(tribo_modal_transition(&own, none, tau, columns, w, NULL));
    assert_all_close(w, v, size, 1e-14);
    tribo_modal_free(modes);
    tribo_modal_free(none);
    tribo_system_destroy(sys);
}

/* The same of a row by 4 modes and the compliance that they lack at 3 contacts, of which `set` hold: of several perturbations,
 * and of each alone. Without modes all sets share one set of coordinates, which lasts as long as one of them. */
TEST(springs)
{
    enum { MODES = 4, SPRINGS = 3, COLUMNS = 2, ALL = 2 * MODES + SPRINGS };
    struct random r = random_of(_i);
    double mass[BODIES * BODIES] = {0.0}, stiffness[BODIES * BODIES] = {0.0}, direction[SPRINGS * BODIES] = {0.0};
    for (size_t i = 0; i < BODIES; i++) {
        mass[i * (BODIES + 1)] = uniform(&r, 1.0, 3.0);
        stiffness[i * (BODIES + 1)] = 2.1;
        if (i > 0) {
            stiffness[i * (BODIES + 1) - 1] = stiffness[(i - 1) * (BODIES + 1) + 1] = -1.0;
        }
        direction[i % SPRINGS * BODIES + i] = uniform(&r, 0.5, 1.5);
    }
    tribo_model *model;
    tribo_system *sys;
    assert_ok(tribo_model_create(&model, BODIES, SPRINGS));
    assert_ok(tribo_model_set_mass(model, mass));
    assert_ok(tribo_model_set_stiffness(model, stiffness));
    assert_ok(tribo_model_set_direction(model, direction));
    assert_ok(tribo_system_reduce(&sys, model, MODES, TRIBO_STATICS_COMPLIANCE));
    assert_ok(tribo_system_set_damping_ratio(sys, _i % 2 ? 0.02 : 0.0));
    tribo_model_destroy(model);
    struct exact own = {.sys = sys};
    struct modal *none[SPRINGS + 1] = {NULL};
    for (size_t set = 0; set <= SPRINGS; set++) {
        const signed char slip[] = {set < 1, set < 2, set < 3};
        const unsigned char holds[] = {set > 0, set > 1, set > 2};
        double v[ALL * COLUMNS], w[ALL * COLUMNS], one[ALL];
        struct modal *modes = NULL;
        assert_ok(create(&modes, sys, slip, holds, 0, NULL));
        assert_ok(create(&none[set], sys, slip, holds, 1, set ? none[set - 1] : NULL));
        ck_assert_ptr_eq(none[set]->powers, none[0]->powers);
        for (size_t k = 0; k < ALL * COLUMNS; k++) {
            v[k] = w[k] = k / COLUMNS < 2 * MODES + set ? uniform(&r, -1.0, 1.0) : 0.0; /* forces of contacts at rest */
        }
        for (size_t k = 0; k < ALL; k++) {
            one[k] = v[k * COLUMNS + 1];
        }
        require(none[set]->forced->quickest >= modes->forced->quickest, "a bound of %g", none[set]->forced->quickest);
        const double tau = TRIBO_POWERS_REACH / none[set]->forced->quickest;
        assert_ok(tribo_modal_transition(&own, modes, tau, COLUMNS, v, NULL));
        assert_ok(tribo_modal_transition(&own, none[set], tau, COLUMNS, w, NULL));
        assert_ok(tribo_modal_transition(&own, none[set], tau, 1, one, NULL));
        assert_all_close(w, v, ALL * COLUMNS, 1e-13);
        for (size_t k = 0; k < ALL; k++) {
            assert_close(one[k], w[k * COLUMNS + 1], 1e-14);
        }
        tribo_modal_free(modes);
    }
    for (size_t set = 0; set <= SPRINGS; set++) {
        tribo_modal_free(none[set]);
    }
    tribo_system_destroy(sys);
}

/* Damping of one side: body 1, which is held, feels how body 0 moves, and not the other way round. */
TEST(one_sided)
{
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {4.0, 0.0, 0.0, 1.0}, damping[] = {0.0, 0.0, 0.25, 0.0};
    const double direction[] = {0.0, 1.0};
    const signed char slip[] = {0};
    const unsigned char holds[] = {1};
    tribo_system *sys;
    struct modal *h;
    assert_ok(dense_system(&sys, 2, 1, mass, damping, stiffness, direction, 0, NULL, 0));
    assert_ok(decompose(&h, sys, slip, holds));
    ck_assert_uint_eq(h->modes, 1);
    ck_assert_uint_eq(h->forced->outputs, 1);
    assert_close(h->forced->output[0].size[0], 0.25 * 2.0, 1e-14);
    tribo_modal_free(h);
    tribo_system_destroy(sys);
}

/* Two bodies on no spring, and a damper between them: the damping couples two modes of one omega, which is 0. */
TEST(damper_alone)
{
    const double mass[] = {1.0, 0.0, 0.0, 2.0}, stiffness[4] = {0.0}, damping[] = {1.0, -1.0, -1.0, 1.0},
                 direction[] = {1.0, 0.0};
    const signed char slip[] = {1};
    const unsigned char holds[] = {0};
    tribo_system *sys;
    struct modal *h;
    assert_ok(dense_system(&sys, 2, 1, mass, damping, stiffness, direction, 0, NULL, 0));
    assert_status(decompose(&h, sys, slip, holds), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_system_message(sys), "a mode without stiffness");
    tribo_system_destroy(sys);
}

/* Free structures of four bodies with a full mass matrix, of which the last is on no spring: two motions have no frequency but
 * rounding, and that says how they mix. They are orthonormal nevertheless: phi'M phi = 1. */
TEST(free_motions)
{
    struct random g = random_of(1);
    double most = 0.0;
    for (int k = 0; k < 10000; k++) {
        const double a = uniform(&g, 0.2, 2.0), b = uniform(&g, 0.2, 2.0), direction[] = {1.0, 0.0, 0.0, 0.0};
        const double stiffness[16] = {a, -a, 0.0, 0.0, -a, a + b, -b, 0.0, 0.0, -b, b};
        double mass[16] = {0.0}, omega[4], phi[16], unit[4];
        for (size_t i = 0; i < 4; i++) {
            mass[5 * i] = uniform(&g, 0.5, 2.0);
            for (size_t j = 0; j < i; j++) {
                mass[4 * i + j] = mass[4 * j + i] = uniform(&g, -0.05, 0.05);
            }
        }
        tribo_system *sys;
        assert_ok(dense_system(&sys, 4, 1, mass, NULL, stiffness, direction, 4, NULL, 0));
        assert_ok(tribo_system_get_frequencies(sys, omega));
        assert_all_exact(omega, ((const double[2]){0.0}), 2);
        for (size_t m = 0; m < 4; m++) {
            for (size_t n = 0; n < 4; n++) {
                unit[n] = m == n;
            }
            assert_ok(tribo_system_expand(sys, unit, phi + 4 * m));
        }
        for (size_t m = 0; m < 16; m++) {
            double sum = 0.0;
            for (size_t ij = 0; ij < 16; ij++) {
                sum += phi[4 * (m / 4) + ij / 4] * mass[ij] * phi[4 * (m % 4) + ij % 4];
            }
            most = fmax(most, fabs(sum - (m % 5 == 0)));
        }
        tribo_system_destroy(sys);
    }
    require(most <= 1e-14, "off by %.3g", most);
}

/* A mode that moves all bodies alike moves no contact between two of them: there is nothing that it could hold, and the motion is
 * that without it. */
TEST(moved_alike)
{
    const double mass[16] = {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0};
    const double stiffness[16] = {2.6, -1.3, 0.0, 0.0, -1.3, 3.9, -1.3, 0.0, 0.0, -1.3, 3.9, -1.3, 0.0, 0.0, -1.3, 2.6};
    const double direction[2][8] = {{-1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}}, limit[] = {0.6, 0.3};
    const double load[4] = {0.0, 1.0, 0.0, 0.0};
    double y[2][3] = {{0.5, 0.2, 0.0}, {0.5, 0.2, 0.0}}, v[2], t;
    for (int alone = 0; alone < 2; alone++) {
        tribo_system *sys;
        tribo_driver *drv;
        assert_ok(dense_system(&sys, 4, alone ? 1 : 2, mass, NULL, stiffness, direction[alone], 1, NULL, 0));
        assert_ok(tribo_set_limit(tribo_system_context(sys), limit + alone));
        assert_ok(tribo_system_add_load(sys, 0.8, load, NULL));
        assert_ok(tribo_system_contacts(sys, 0.0, y[alone], v, NULL, NULL));
        assert_close(v[0], alone ? 0.1 : 0.0, alone ? 1e-12 : 0.0);
        assert_ok(set_up_driver(&drv, sys, "exact", 1.0, 0.0, 0.0));
        t = 0.0;
        assert_ok(tribo_driver_advance(drv, &t, 20.0, y[alone]));
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    assert_all_close(y[0], y[1], 3, 1e-12);
}

/* ------------------------------------------------------------------------------------------------- damping that couples */

#define COUPLED 48

/* Kinds of structures of COUPLED modes: how far frequencies are apart, and damping ratios. */
static const struct coupled_kind {
    double ratio, apart, damping;
    size_t equal; /* frequencies come in groups of so many equal ones */
    double tolerance;
} coupled_kind[] = {
    {1.06, 0.0, 0.002, 1, 1e-12},  {1.2, 0.0, 0.002, 1, 1e-12},  {1.06, 1e-3, 0.002, 2, 1e-11}, {1.06, 1e-5, 0.002, 2, 1e-11},
    {1.06, 0.0, 0.002, 2, 1e-11},  {1.06, 0.0, 0.002, 4, 1e-11}, {1.06, 0.0, 0.05, 1, 1e-11},   {1.2, 0.0, 0.5, 1, 1e-10},
    {1.003, 0.0, 0.002, 1, 1e-10}, {1.06, 1e-9, 1e-7, 2, 1e-7},
};

/* omega^2 and C of coupled modes; C is G G' with entries that fall off the diagonal by a half. */
static void coupled_matrices(const struct coupled_kind *kind, double *omega2, double *damping)
{
    struct random r = random_of(7);
    double g[COUPLED * COUPLED], omega = 1.0;
    for (size_t k = 0; k < COUPLED; k++) {
        omega *= k % kind->equal ? 1.0 + kind->apart : kind->ratio;
        omega2[k] = omega * omega;
        for (size_t l = 0; l < COUPLED; l++) {
            g[k * COUPLED + l] = sqrt(2.0 * kind->damping * omega) * (k == l ? 1.0 : uniform(&r, -0.1, 0.1));
        }
    }
    for (size_t k = 0; k < COUPLED; k++) {
        for (size_t l = 0; l < COUPLED; l++) {
            damping[k * COUPLED + l] = 0.0;
            for (size_t i = 0; i < COUPLED; i++) {
                damping[k * COUPLED + l] += g[k * COUPLED + i] * g[l * COUPLED + i];
            }
        }
    }
}

/* Each exponent and its shape r solve (lambda^2 + lambda C + diag(omega^2)) r = 0; with all of them a displacement and a velocity
 * at the start come out: sum Re(r b) = 0 and sum Re(lambda r b) = 1. */
TEST(coupled)
{
    static double omega2[COUPLED], damping[COUPLED * COUPLED], mass[COUPLED * COUPLED], stiffness[COUPLED * COUPLED];
    const struct coupled_kind *kind = &coupled_kind[_i];
    const double direction[COUPLED] = {1.0};
    const signed char slip[] = {1};
    const unsigned char holds[] = {0};
    coupled_matrices(kind, omega2, damping);
    for (size_t k = 0; k < COUPLED; k++) {
        mass[k * (COUPLED + 1)] = 1.0;
        stiffness[k * (COUPLED + 1)] = omega2[k];
    }
    tribo_system *sys;
    struct modal *h;
    assert_ok(dense_system(&sys, COUPLED, 1, mass, damping, stiffness, direction, 0, NULL, 0));
    const int status = decompose(&h, sys, slip, holds);
    require(status == TRIBO_OK, "%s", tribo_system_message(sys));
    ck_assert(h->coupling && h->modes == COUPLED);
    const size_t m = h->modes, e = h->exponents;
    double worst = 0.0, lack = 0.0;
    for (size_t p = 0; p < e; p++) {
        const double complex lambda = h->lr[p] + h->li[p] * I;
        double size = 0.0, missed = 0.0;
        for (size_t k = 0; k < m; k++) {
            const double complex r = h->rr[p * m + k] - h->ri[p * m + k] * I;
            double complex sum = (lambda * lambda + h->omega2[k]) * r;
            for (size_t l = 0; l < m; l++) {
                sum += lambda * h->coupling[k * m + l] * (h->rr[p * m + l] - h->ri[p * m + l] * I);
            }
            missed = fmax(missed, cabs(sum) / fmax(cabs(lambda) * cabs(lambda), h->omega2[k]));
            size = fmax(size, cabs(r));
        }
        worst = fmax(worst, missed / size);
    }
    for (size_t k = 0; k < m; k++) {
        for (size_t l = 0; l < m; l++) {
            double complex at = 0.0, rate = 0.0;
            for (size_t p = 0; p < e; p++) {
                const double complex part =
                    (h->rr[p * m + k] - h->ri[p * m + k] * I) * (h->left.br[l * e + p] + h->left.bi[l * e + p] * I);
                at += creal(part);
                rate += creal((h->lr[p] + h->li[p] * I) * part);
            }
            lack = fmax(lack, fmax(cabs(at) * sqrt(h->omega2[k]), cabs(rate - (k == l))));
        }
    }
    require(worst <= kind->tolerance && lack <= kind->tolerance, "residual %.2g, sums %.2g", worst, lack);
    tribo_modal_free(h);
    tribo_system_destroy(sys);
}

/* (e^z - 1)/z on both sides of where its series ends, in eight directions, by functions that lose no digits:
 * e^{a + ib} - 1 = expm1(a) cos b - 2 sin^2(b/2) + i e^a sin b. */
TEST(exponential_from_one)
{
    const double sizes[] = {1e-9, 0.03, 0.1, 0.49, 0.51}, size = sizes[_i];
    for (int k = 0; k < 8; k++) {
        const double a = size * cos(k * PI / 4.0), b = size * sin(k * PI / 4.0), half = sin(0.5 * b);
        const double complex z = a + b * I, grown = expm1(a) * cos(b) - 2.0 * half * half + exp(a) * sin(b) * I;
        const double complex by = tribo_exp_1(z);
        assert_close(creal(by), creal(grown / z), 1e-15);
        assert_close(cimag(by), cimag(grown / z), 1e-15);
    }
}

/* A row of bodies, each with a contact to the ground; those of one end, which the loads and bases move, slide now and then. Body
 * d is row d of the matrices, or, mirrored, the last row but d. Sets y, what oscillates as body 1, the sum of the
 * multipliers, and by [2][dimension], the derivatives of y by frequency and damping. */
static void move_row(size_t n, int damped, int bases, int mirrored, double *y, double *harmonic, double *trace, double *by)
{
    enum { MOST = 44 };
    static double mass[MOST * MOST], damping[MOST * MOST], stiffness[MOST * MOST], direction[MOST * MOST];
    double load[MOST] = {0.0}, base[MOST] = {0.0}, limit[MOST], c[2 * MOST] = {0.0}, re[2 * MOST], im[2 * MOST];
    tribo_system *sys;
    tribo_driver *drv;
    for (size_t k = 0; k < n * n; k++) {
        mass[k] = damping[k] = stiffness[k] = direction[k] = 0.0;
    }
    for (size_t d = 0; d < n; d++) {
        const size_t i = mirrored ? n - 1 - d : d, beside = mirrored ? i - 1 : i + 1;
        mass[i * (n + 1)] = 1.0 + 0.01 * (double)d;
        stiffness[i * (n + 1)] = 2.5;
        damping[i * (n + 1)] = 0.1 + 0.01 * (double)d;
        direction[d * n + i] = 1.0;
        limit[d] = d < 3 ? 0.3 + 0.1 * (double)d : 1e3;
        base[d] = d > 2 ? 0.02 * (double)d : 0.0;
        if (d + 1 < n) {
            stiffness[i * n + beside] = stiffness[beside * n + i] = -1.0;
            mass[i * n + beside] = mass[beside * n + i] = 0.1;
        }
    }
    load[mirrored ? n - 1 : 0] = 1.5;
    c[mirrored ? n - 2 : 1] = 1.0;
    c[n + (mirrored ? n - 2 : 1)] = 0.5;
    assert_ok(dense_system(&sys, n, n, mass, damped ? damping : NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    assert_ok(tribo_system_add_load(sys, 0.7, load, NULL));
    if (bases) {
        assert_ok(tribo_system_add_base_motion(sys, 0.7, NULL, base));
    }
    assert_ok(set_up_driver(&drv, sys, "exact", 0.01, 0.0, 0.0));
    require(tribo_driver_find_periodic(drv, 0.0, 2.0 * PI / 0.7, y) == TRIBO_OK, "%s", tribo_driver_message(drv));
    assert_ok(tribo_driver_get_multipliers(drv, re, im));
    assert_ok(tribo_driver_period_harmonic(drv, c, 1, &harmonic[0], &harmonic[1]));
    const int kind[] = {TRIBO_PARAMETER_FREQUENCY, TRIBO_PARAMETER_DAMPING};
    const size_t index[] = {0, 0};
    const int status = tribo_driver_period_derivatives(drv, 2, kind, index, NULL, NULL, NULL, by);
    require(!status, "%s", tribo_driver_message(drv));
    *trace = 0.0;
    for (size_t k = 0; k < 2 * n; k++) {
        *trace += re[k];
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Which bodies move does not depend on which rows these are. */
TEST(mirrored)
{
    const size_t n = _i & 4 ? 44 : 8;
    double y[2][2 * 44 + 1] = {{0.0}}, harmonic[2][2], trace[2], by[2][2 * (2 * 44 + 1)], far = 0.0;
    for (int k = 0; k < 2; k++) {
        move_row(n, _i & 1, _i & 2, k, y[k], harmonic[k], &trace[k], by[k]);
    }
    for (size_t d = 0; d < n; d++) {
        assert_close(y[1][n - 1 - d], y[0][d], 1e-10);
        assert_close(y[1][2 * n - 1 - d], y[0][n + d], 1e-10);
    }
    assert_close(harmonic[1][0], harmonic[0][0], 1e-10);
    assert_close(harmonic[1][1], harmonic[0][1], 1e-10);
    assert_close(trace[1], trace[0], 1e-9);
    for (size_t p = 0; p < 2; p++) {
        const double *const to = by[0] + p * (2 * n + 1), *const back = by[1] + p * (2 * n + 1);
        for (size_t d = 0; d < n; d++) {
            assert_close(back[n - 1 - d], to[d], 1e-9);
            assert_close(back[2 * n - 1 - d], to[n + d], 1e-9);
            far = fmax(far, fabs(to[d]));
        }
    }
    ck_assert_double_gt(far, 0.01);
}

TEST_MAIN("modal", {both_hold, 17}, {upper_holds, 17}, {lever, 1}, {too_many_hold, 1}, {kept, 10}, {powers, 9}, {springs, 6},
          {one_sided, 1}, {damper_alone, 1}, {free_motions, 1}, {moved_alike, 1}, {coupled, 10}, {exponential_from_one, 5},
          {mirrored, 8})
