/* What is known of a structure with contacts held: modes, forces of those that hold, and what cannot be. */
#include "modal.h"
#include "support.h"

static int decompose(struct modal **h, tribo_system *sys, const signed char *slip, const unsigned char *holds)
{
    struct modal_whole whole;
    int status = tribo_modal_whole_create(&whole, sys);
    status = status ? status : tribo_modal_create(h, &whole, slip, holds);
    tribo_modal_whole_free(&whole);
    return status;
}

/* Body 2 on a spring of 4 to body 1, which is heavy; contacts between the ground and the light body 0, and between 0 and 1. */
static tribo_system *sandwich(double light)
{
    const double mass[] = {light, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.25}, direction[] = {1.0, 0.0, 0.0, -1.0, 1.0, 0.0};
    const double stiffness[] = {0.0, 0.0, 0.0, 0.0, 4.0, -4.0, 0.0, -4.0, 4.0}, load[] = {0.5, 3.0, 0.0};
    tribo_system *sys;
    assert_ok(tribo_system_linear(&sys, 3, 2, mass, NULL, stiffness, direction, 0, NULL, 0));
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
    require(status == TRIBO_OK, "%s", tribo_message(tribo_system_context(sys)));
    ck_assert_uint_eq(h->modes, 1);
    ck_assert_uint_eq(h->exponents, 1);
    ck_assert_uint_eq(h->outputs, 2);
    ck_assert_uint_eq(h->sliding, 0);
    ck_assert_uint_eq(h->moving, 1);
    assert_close(h->omega2[0], 16.0, 1e-14);
    assert_close(fabs(h->phi[0]), 2.0, 1e-14);
    for (size_t k = 0; k < 2; k++) {
        const struct output *out = &h->output[k];
        assert_close(out->size[0], 8.0, 1e-13);
        assert_close(out->rr[0], out->contact == 0 ? -3.5 : -3.0, 1e-14);
        assert_close(out->ri[0], 0.0, 1e-14);
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
    ck_assert_uint_eq(h->modes, 2);
    ck_assert_uint_eq(h->outputs, 2);
    ck_assert_uint_eq(h->sliding, 1);
    assert_exact(h->omega2[0], 0.0);
    ck_assert(h->drifts[0]);
    assert_close(h->omega2[1] / (4.0 * (1.0 / whole + 4.0)), 1.0, 1e-14);
    /* what it carries is what accelerates the light body: light (spring + load)/whole - load of the light one; the spring's is
     * part of the exponent and of the response to the load, the direct part of the load is what is left of it */
    const struct output *out = &h->output[1];
    ck_assert_uint_eq(out->contact, 1);
    const double at = 4.0 * (1.0 / whole + 4.0) - 1.0; /* omega^2 - 1 of the stretch, which 3.5/whole shakes */
    const double stretch = -3.5 / whole / at, pull = 4.0 * stretch;
    assert_close(out->rr[0], 0.5 - light * (3.5 + pull) / whole, 1e-13);
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
    assert_ok(tribo_system_linear(&sys, 2, 1, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(decompose(&h, sys, mode, holds));
    ck_assert_uint_eq(h->modes, 1);
    assert_close(h->omega2[0], omega2, 1e-15);
    assert_close(h->output[0].size[0], fabs((7.0 - 3.0 * omega2) * 2.0 * phi), 1e-14);
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
    assert_ok(tribo_system_linear(&sys, 2, 2, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_status(decompose(&h, sys, mode, holds), TRIBO_ERR_INDEFINITE);
    assert_says(tribo_message(tribo_system_context(sys)), "contact 1 cannot hold");
    ck_assert(stained(&h, sizeof h));
    tribo_system_destroy(sys);
}

TEST_MAIN("modal", {both_hold, 17}, {upper_holds, 17}, {lever, 1}, {too_many_hold, 1})
