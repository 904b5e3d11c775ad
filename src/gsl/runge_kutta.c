/* Runge-Kutta methods, explicit and implicit, from their tables. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>

#include "newton.h"
#include "stepper.h"
#include "../common/real.h"
#include "../common/simd.h"

/* Stage i is at t + c_i h and y + h sum_j a_ij k_j; the step ends at y + h sum_i b_i k_i. The error is h times the sum of
 * before f(t, y), e_i k_i and after f at the end, and, where the step is made twice, what half steps change over halves; it goes
 * with the order-th power of h. */
struct tableau {
    size_t stages;
    int implicit;
    const double *c, *a, *b, *e; /* a: row i has i entries, of an implicit method all */
    double before, after, order;
    double halves; /* 0: once */
};

/* ------------------------------------------------------------------------------------------------------------- tables */

/* clang-format off */

/* The rule of third order, of second order without its first and last stage. */
static const double half_c[] = {0.0, 0.5, 1.0};
static const double half_a[] = {0.5,
                                -1.0, 2.0};
static const double half_b[] = {1.0 / 6, 2.0 / 3, 1.0 / 6};
static const double half_e[] = {1.0 / 6, -1.0 / 3, 1.0 / 6};

/* Kutta 1901. */
static const double classical_c[] = {0.0, 0.5, 0.5, 1.0};
static const double classical_a[] = {0.5,
                                     0.0, 0.5,
                                     0.0, 0.0, 1.0};
static const double classical_b[] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};

/* It twice over half the step; stages 1 to 3 are for comparison with once over all of it. */
static const double doubled_c[] = {0.0, 0.5, 0.5, 1.0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1.0};
static const double doubled_a[] = {0.5,
                                   0.0, 0.5,
                                   0.0, 0.0, 1.0,
                                   0.25, 0.0, 0.0, 0.0,
                                   0.0, 0.0, 0.0, 0.0, 0.25,
                                   0.0, 0.0, 0.0, 0.0, 0.0, 0.5,
                                   1.0 / 12, 0.0, 0.0, 0.0, 1.0 / 6, 1.0 / 6, 1.0 / 12,
                                   1.0 / 12, 0.0, 0.0, 0.0, 1.0 / 6, 1.0 / 6, 1.0 / 12, 0.25,
                                   1.0 / 12, 0.0, 0.0, 0.0, 1.0 / 6, 1.0 / 6, 1.0 / 12, 0.0, 0.25,
                                   1.0 / 12, 0.0, 0.0, 0.0, 1.0 / 6, 1.0 / 6, 1.0 / 12, 0.0, 0.0, 0.5};
static const double doubled_b[] = {1.0 / 12, 0.0, 0.0, 0.0, 1.0 / 6, 1.0 / 6, 1.0 / 12, 1.0 / 12, 1.0 / 6, 1.0 / 6, 1.0 / 12};
static const double doubled_e[] = {-1.0 / 12, -1.0 / 3, -1.0 / 3, -1.0 / 6,
                                   1.0 / 6, 1.0 / 6, 1.0 / 12, 1.0 / 12, 1.0 / 6, 1.0 / 6, 1.0 / 12};

/* Fehlberg 1969, orders 5 and 4. */
static const double fehlberg_c[] = {0.0, 1.0 / 4, 3.0 / 8, 12.0 / 13, 1.0, 1.0 / 2};
static const double fehlberg_a[] = {1.0 / 4,
                                    3.0 / 32, 9.0 / 32,
                                    1932.0 / 2197, -7200.0 / 2197, 7296.0 / 2197,
                                    439.0 / 216, -8.0, 3680.0 / 513, -845.0 / 4104,
                                    -8.0 / 27, 2.0, -3544.0 / 2565, 1859.0 / 4104, -11.0 / 40};
static const double fehlberg_b[] = {16.0 / 135, 0.0, 6656.0 / 12825, 28561.0 / 56430, -9.0 / 50, 2.0 / 55};
static const double fehlberg_e[] = {1.0 / 360, 0.0, -128.0 / 4275, -2197.0 / 75240, 1.0 / 50, 2.0 / 55};

/* Cash and Karp 1990, orders 5 and 4. */
static const double cash_c[] = {0.0, 1.0 / 5, 3.0 / 10, 3.0 / 5, 1.0, 7.0 / 8};
static const double cash_a[] = {1.0 / 5,
                                3.0 / 40, 9.0 / 40,
                                3.0 / 10, -9.0 / 10, 6.0 / 5,
                                -11.0 / 54, 5.0 / 2, -70.0 / 27, 35.0 / 27,
                                1631.0 / 55296, 175.0 / 512, 575.0 / 13824, 44275.0 / 110592, 253.0 / 4096};
static const double cash_b[] = {37.0 / 378, 0.0, 250.0 / 621, 125.0 / 594, 0.0, 512.0 / 1771};
static const double cash_e[] = {37.0 / 378 - 2825.0 / 27648, 0.0, 250.0 / 621 - 18575.0 / 48384, 125.0 / 594 - 13525.0 / 55296,
                                -277.0 / 14336, 512.0 / 1771 - 1.0 / 4};

/* Prince and Dormand 1981, orders 8 and 7. */
static const double prince_c[] = {0.0, 1.0 / 18, 1.0 / 12, 1.0 / 8, 5.0 / 16, 3.0 / 8, 59.0 / 400, 93.0 / 200,
                                  5490023248.0 / 9719169821.0, 13.0 / 20, 1201146811.0 / 1299019798.0, 1.0, 1.0};
static const double prince_a[] = {
    1.0 / 18,
    1.0 / 48, 1.0 / 16,
    1.0 / 32, 0.0, 3.0 / 32,
    5.0 / 16, 0.0, -75.0 / 64, 75.0 / 64,
    3.0 / 80, 0.0, 0.0, 3.0 / 16, 3.0 / 20,
    29443841.0 / 614563906.0, 0.0, 0.0, 77736538.0 / 692538347.0, -28693883.0 / 1125000000.0, 23124283.0 / 1800000000.0,
    16016141.0 / 946692911.0, 0.0, 0.0, 61564180.0 / 158732637.0, 22789713.0 / 633445777.0, 545815736.0 / 2771057229.0,
        -180193667.0 / 1043307555.0,
    39632708.0 / 573591083.0, 0.0, 0.0, -433636366.0 / 683701615.0, -421739975.0 / 2616292301.0, 100302831.0 / 723423059.0,
        790204164.0 / 839813087.0, 800635310.0 / 3783071287.0,
    246121993.0 / 1340847787.0, 0.0, 0.0, -37695042795.0 / 15268766246.0, -309121744.0 / 1061227803.0, -12992083.0 / 490766935.0,
        6005943493.0 / 2108947869.0, 393006217.0 / 1396673457.0, 123872331.0 / 1001029789.0,
    -1028468189.0 / 846180014.0, 0.0, 0.0, 8478235783.0 / 508512852.0, 1311729495.0 / 1432422823.0, -10304129995.0 / 1701304382.0,
        -48777925059.0 / 3047939560.0, 15336726248.0 / 1032824649.0, -45442868181.0 / 3398467696.0, 3065993473.0 / 597172653.0,
    185892177.0 / 718116043.0, 0.0, 0.0, -3185094517.0 / 667107341.0, -477755414.0 / 1098053517.0, -703635378.0 / 230739211.0,
        5731566787.0 / 1027545527.0, 5232866602.0 / 850066563.0, -4093664535.0 / 808688257.0, 3962137247.0 / 1805957418.0,
        65686358.0 / 487910083.0,
    403863854.0 / 491063109.0, 0.0, 0.0, -5068492393.0 / 434740067.0, -411421997.0 / 543043805.0, 652783627.0 / 914296604.0,
        11173962825.0 / 925320556.0, -13158990841.0 / 6184727034.0, 3936647629.0 / 1978049680.0, -160528059.0 / 685178525.0,
        248638103.0 / 1413531060.0, 0.0};
static const double prince_b[] = {
    14005451.0 / 335480064.0, 0.0, 0.0, 0.0, 0.0, -59238493.0 / 1068277825.0, 181606767.0 / 758867731.0, 561292985.0 / 797845732.0,
    -1041891430.0 / 1371343529.0, 760417239.0 / 1151165299.0, 118820643.0 / 751138087.0, -528747749.0 / 2220607170.0, 1.0 / 4};
static const double prince_e[] = {
    14005451.0 / 335480064.0 - 13451932.0 / 455176623.0, 0.0, 0.0, 0.0, 0.0,
    -59238493.0 / 1068277825.0 + 808719846.0 / 976000145.0, 181606767.0 / 758867731.0 - 1757004468.0 / 5645159321.0,
    561292985.0 / 797845732.0 - 656045339.0 / 265891186.0, -1041891430.0 / 1371343529.0 + 3867574721.0 / 1518517206.0,
    760417239.0 / 1151165299.0 - 465885868.0 / 322736535.0, 118820643.0 / 751138087.0 - 53011238.0 / 667516719.0,
    -528747749.0 / 2220607170.0 - 2.0 / 45, 1.0 / 4};

/* clang-format on */

/* Implicit: Euler's, and those of Gauss. Their estimates compare the stages with the slopes at both ends, so that a force that
 * jumps anywhere in the step is seen: Euler's by the trapezoidal rule, the midpoint rule by Simpson's, the third by the part of
 * the slope that is cubic in time. These two are nothing for linear equations, so that there are halves too. */
#define ROOT_3 1.7320508075688772935
static const double euler_c[] = {1.0}, euler_a[] = {1.0}, euler_b[] = {1.0}, euler_e[] = {0.5};
static const double midpoint_c[] = {0.5}, midpoint_a[] = {0.5}, midpoint_b[] = {1.0}, midpoint_e[] = {1.0 / 3};
static const double gauss_c[] = {0.5 - ROOT_3 / 6, 0.5 + ROOT_3 / 6};
static const double gauss_a[] = {0.25, 0.25 - ROOT_3 / 6, 0.25 + ROOT_3 / 6, 0.25};
static const double gauss_b[] = {0.5, 0.5}, gauss_e[] = {ROOT_3 / 12, -ROOT_3 / 12};

static const struct tableau half = {3, 0, half_c, half_a, half_b, half_e, 0.0, 0.0, 3.0, 0.0},
                            classical = {4, 0, classical_c, classical_a, classical_b, NULL, 0.0, 0.0, 0.0, 0.0},
                            doubled = {11, 0, doubled_c, doubled_a, doubled_b, doubled_e, 0.0, 0.0, 5.0, 0.0},
                            fehlberg = {6, 0, fehlberg_c, fehlberg_a, fehlberg_b, fehlberg_e, 0.0, 0.0, 5.0, 0.0},
                            cash = {6, 0, cash_c, cash_a, cash_b, cash_e, 0.0, 0.0, 5.0, 0.0},
                            prince = {13, 0, prince_c, prince_a, prince_b, prince_e, 0.0, 0.0, 8.0, 0.0},
                            euler = {1, 1, euler_c, euler_a, euler_b, euler_e, -0.5, 0.0, 2.0, 0.0},
                            midpoint = {1, 1, midpoint_c, midpoint_a, midpoint_b, midpoint_e, -1.0 / 6, -1.0 / 6, 3.0, 3.0},
                            gauss = {2, 1, gauss_c, gauss_a, gauss_b, gauss_e, -1.0 / 12, 1.0 / 12, 4.0, 15.0};

/* -------------------------------------------------------------------------------------------------------------- steps */

/* to = from + h sum_j w_j k_j. */
TRIBO_SIMD static void combine(size_t n, size_t count, double h, const double *w, const double *restrict k,
                               const double *restrict from, double *restrict to)
{
    const double *now = from;
    for (size_t j = 0; j < count; j++) {
        const double factor = h * w[j];
        const double *restrict kj = k + j * n;
        if (factor != 0.0) {
            for (size_t m = 0; m < n; m++) {
                to[m] = now[m] + factor * kj[m];
            }
            now = to;
        }
    }
    if (now == from) {
        memcpy(to, from, n * sizeof *to);
    }
}

static int find_explicit(const struct tableau *r, tribo_system *sys, const struct step *s, double *k)
{
    const size_t n = sys->odeiv2.dimension;
    const double *a = r->a;
    memcpy(k, s->slope, n * sizeof *k);
    for (size_t i = 1; i < r->stages; a += i, i++) {
        combine(n, i, s->h, a, k, s->y, s->to);
        const int status = sys->odeiv2.function(s->t + r->c[i] * s->h, s->to, k + i * n, sys);
        if (status) {
            return status;
        }
    }
    combine(n, r->stages, s->h, r->b, k, s->y, s->to);
    return GSL_SUCCESS;
}

int tribo_rk4_step(tribo_system *sys, struct step *s, double *work)
{
    return find_explicit(&classical, sys, s, work);
}

struct runge_kutta {
    const struct tableau *table;
    size_t n;
    double *k, *once, *middle; /* [stages][n]; [n] after one step, after half of it */
    struct newton newton[2];   /* of whole and half steps */
};

/* One step of the table's implicit method over h; its slopes stay in k. */
static int step_implicit(struct runge_kutta *w, int which, tribo_system *sys, const struct step *s, double t, double h,
                         const double *from, double *to)
{
    const struct tableau *r = w->table;
    double time[2];
    for (size_t i = 0; i < r->stages; i++) {
        time[i] = t + r->c[i] * h;
        memcpy(w->k + i * w->n, s->slope, w->n * sizeof *w->k);
    }
    const int status = tribo_newton_solve(&w->newton[which], sys, time, h, r->a, from, s->tolerance, w->k);
    if (!status) {
        combine(w->n, r->stages, h, r->b, w->k, from, to);
    }
    return status;
}

/* What the stages say about the error. */
static void estimate(const struct runge_kutta *w, const struct step *s)
{
    const struct tableau *r = w->table;
    for (size_t m = 0; m < w->n; m++) {
        double sum = r->before * s->slope[m];
        for (size_t i = 0; i < r->stages; i++) {
            sum += r->e[i] * w->k[i * w->n + m];
        }
        s->error[m] = s->h * sum;
    }
}

/* The step once more, in two halves; then the slope at its end; and what both add to the error. */
static int halve(struct runge_kutta *w, tribo_system *sys, struct step *s)
{
    const struct tableau *r = w->table;
    const double h = 0.5 * s->h;
    memcpy(w->once, s->to, w->n * sizeof *s->to);
    int status = step_implicit(w, 1, sys, s, s->t, h, s->y, w->middle);
    status = status ? status : step_implicit(w, 1, sys, s, s->t + h, h, w->middle, s->to);
    status = status ? status : sys->odeiv2.function(s->t + s->h, s->to, s->end, sys);
    for (size_t m = 0; !status && m < w->n; m++) {
        s->error[m] = fabs(s->error[m] + s->h * r->after * s->end[m]) + fabs(s->to[m] - w->once[m]) / r->halves;
    }
    s->ends = !status;
    return status;
}

static int attempt(void *own, tribo_system *sys, struct step *s)
{
    struct runge_kutta *w = own;
    const struct tableau *r = w->table;
    const int status = r->implicit ? step_implicit(w, 0, sys, s, s->t, s->h, s->y, s->to) : find_explicit(r, sys, s, w->k);
    if (status) {
        return status;
    }
    estimate(w, s);
    if (r->halves > 0.0) {
        return halve(w, sys, s);
    }
    if (r->implicit) { /* Euler's stage is the end */
        memcpy(s->end, w->k, w->n * sizeof *s->end);
        s->ends = 1;
    }
    return GSL_SUCCESS;
}

static void destroy(void *own)
{
    struct runge_kutta *w = own;
    if (w) {
        tribo_newton_free(&w->newton[0]);
        tribo_newton_free(&w->newton[1]);
        free(w->k);
        free(w);
    }
}

static void *create(const struct stepper *kind, size_t dimension)
{
    struct runge_kutta *w = calloc(1, sizeof *w);
    if (!w) {
        return NULL;
    }
    w->table = kind->with;
    w->n = dimension;
    w->k = malloc((w->table->stages + 2) * dimension * sizeof *w->k);
    int done = w->k != NULL;
    for (int i = 0; done && i < (w->table->halves > 0.0 ? 2 : w->table->implicit); i++) {
        done = tribo_newton_create(&w->newton[i], dimension, w->table->stages);
    }
    if (!done) {
        destroy(w);
        return NULL;
    }
    w->once = w->k + w->table->stages * dimension;
    w->middle = w->once + dimension;
    return w;
}

static void restart(void *own)
{
    struct runge_kutta *w = own;
    w->newton[0].h = w->newton[1].h = 0.0;
}

double tribo_stepper_growth(double size, double order)
{
    return size > 0.0 ? clamp(0.9 * pow(size, -1.0 / order), 0.2, 5.0) : 5.0;
}

static double reject(void *own, double size)
{
    const struct runge_kutta *w = own;
    return tribo_stepper_growth(size, w->table->order);
}

static double accept(void *own, const struct step *s, double size)
{
    (void)s;
    return reject(own, size);
}

#define STEPPER(name, table, stable)                                                                                             \
    const struct stepper name = {create, destroy, restart, attempt, accept, reject, stable, &table};
STEPPER(tribo_stepper_rk2, half, 2.5)
STEPPER(tribo_stepper_rk4, doubled, 5.5)
STEPPER(tribo_stepper_rkf45, fehlberg, 3.6)
STEPPER(tribo_stepper_rkck, cash, 3.7)
STEPPER(tribo_stepper_rk8pd, prince, 5.1)
STEPPER(tribo_stepper_rk1imp, euler, HUGE_VAL)
STEPPER(tribo_stepper_rk2imp, midpoint, HUGE_VAL)
STEPPER(tribo_stepper_rk4imp, gauss, HUGE_VAL)
