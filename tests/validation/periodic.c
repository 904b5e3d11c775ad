/* Periodic motions against closed forms: Den Hartog's oscillator (1931), and what follows from it. */
#include "run.h"

#include <string.h>

/* x'' + x = cos(omega t) + f, |f| <= limit; method exact (0) or event (1). */
struct search {
    tribo_system *sys;
    tribo_driver *drv;
    double period;
};

static const char *const methods[] = {"exact", "event"};

static struct search oscillator_search(int method, double damping, double limit, double force, double omega)
{
    const double one = 1.0, cosine = force;
    struct search s = {.period = 2.0 * PI / omega};
    assert_ok(tribo_system_linear(&s.sys, 1, 1, &one, &damping, &one, &one, 0, NULL, 0));
    assert_ok(tribo_system_add_load(s.sys, omega, &cosine, NULL));
    assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), limit));
    s.drv = driver_create(s.sys, methods[method], 0.1, 1e-14);
    return s;
}

static void search_free(struct search *s)
{
    tribo_driver_destroy(s->drv);
    tribo_system_destroy(s->sys);
}

static void find(const struct search *s, double t, double *y)
{
    const int status = tribo_driver_find_periodic(s->drv, t, s->period, y);
    require(!status, "%s: %s", tribo_strerror(status), tribo_driver_message(s->drv));
}

/* The largest x comes where the velocity is zero: the search is begun there, and finds the same motion. */
static double amplitude(const struct search *s)
{
    double y[3] = {0}, t = 0.0, most = 0.0;
    find(s, 0.0, y);
    for (int k = 1; k <= 2000; k++) {
        driver_advance(s->drv, &t, s->period * k / 2000.0, y);
        most = fmax(most, fabs(y[0]));
    }
    return most;
}

static const struct {
    double beta, r, x0;
} hartog[] = {{0.6, 0.3, 1.5356018093}, {0.7, 0.3, 1.8856998504}, {0.8, 0.4, 2.5017878810}};

TEST(den_hartog)
{
    const int method = _i % 2;
    struct search s = oscillator_search(method, 0.0, hartog[_i / 2].r, 1.0, hartog[_i / 2].beta);
    assert_close(amplitude(&s), hartog[_i / 2].x0, 1e-5);
    search_free(&s);
}

TEST(multipliers)
{
    struct search s = oscillator_search(_i, 0.0, 0.3, 1.0, 0.7);
    double y[3] = {0}, re[2], im[2];
    find(&s, 0.0, y);
    assert_ok(tribo_driver_get_multipliers(s.drv, re, im));
    assert_close(re[0], -0.4533657390, 1e-8);
    assert_close(re[1], -0.4533657390, 1e-8);
    assert_close(im[0], 0.2331451411, 1e-8);
    assert_close(im[1], -0.2331451411, 1e-8);
    search_free(&s);
}

TEST_MAIN("periodic", {den_hartog, 6}, {multipliers, 2})
