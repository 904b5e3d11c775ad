/* SPDX-License-Identifier: BSD-3-Clause */
/* Random structures with contacts whose limits follow the motion: the motion keeps the equations of motion and the law, as this
 * file computes both from states only. TRIBO_SEED is the first seed, TRIBO_BLOCKS the number of blocks of seeds. */
#include <stdio.h>
#include <string.h>

#include "make.h"
#include "../validation/run.h"

enum { BLOCK = 25, DOFS = 6, ROWS = 8, FOLLOWERS = 4, WINDOWS = 24 };

/* Direction k of J in a planar contact. */
enum { ALONE, FIRST, SECOND };

#define DURATION 8.0

/* Step of the differences in time. */
#define STEP 5e-4

/* Rounding of a derivative by differences, in parts of what is differentiated; motions that are not stable grow to 1e9. */
#define ROUNDING (1e-15 / STEP)

/* Difference in a state, for derivatives. */
#define SHIFT 1e-6

struct wave {
    double omega, cosine[DOFS], sine[DOFS];
};

/* Rows of J: the followers, then the normals. */
struct scene {
    size_t n, followers, normals, rows;
    double mass[DOFS * DOFS], damping[DOFS * DOFS], stiffness[DOFS * DOFS], direction[ROWS * DOFS], compliance[ROWS];
    size_t normal[FOLLOWERS]; /* index of the normal of a follower */
    int pair[FOLLOWERS];
    double mu[FOLLOWERS], spring[FOLLOWERS], gap[FOLLOWERS];
    struct wave load[3];
    double belt[ROWS], shake[ROWS], shake_omega;
    double start[2 * DOFS];
    char name[120];
};

static int chance(struct random *g, double p)
{
    return uniform(g, 0.0, 1.0) < p;
}

static void make_matrices(struct scene *s, struct random *g)
{
    const size_t n = s->n, damping = below(g, 4);
    for (size_t i = 0; i < n; i++) {
        s->mass[i * n + i] = log_uniform(g, chance(g, 0.3) ? 2.0 : 0.3);
        s->stiffness[i * n + i] += uniform(g, 0.5, 6.0);
        for (size_t j = 0; j < i; j++) {
            const double k = chance(g, 0.5) ? uniform(g, -2.0, 4.0) : 0.0, size = fabs(k);
            s->stiffness[i * n + j] = s->stiffness[j * n + i] = -k;
            s->stiffness[i * n + i] += size;
            s->stiffness[j * n + j] += size;
        }
    }
    for (size_t k = 0; k < n * n && damping; k++) {
        s->damping[k] = (damping == 2 ? 0.02 : 0.002) * s->stiffness[k];
    }
    for (size_t i = 0; i < n && damping == 3; i++) {
        s->damping[i * n + i] += chance(g, 0.5) ? uniform(g, 0.0, 0.5) * s->mass[i * n + i] : 0.0;
    }
}

/* Tangential: a body, two bodies, or any; normal: another degree of freedom, oblique ones with all. */
static void make_directions(struct scene *s, struct random *g)
{
    const size_t n = s->n;
    const int oblique = chance(g, 0.4);
    for (size_t i = 0; i < s->rows; i++) {
        double *row = s->direction + i * n;
        const int of_normal = i >= s->followers;
        const size_t a = below(g, n), b = below(g, n);
        row[a] = 1.0;
        row[b] -= a != b && chance(g, 0.4) ? 1.0 : 0.0;
        for (size_t j = 0; j < n; j++) {
            row[j] += oblique && chance(g, of_normal ? 0.5 : 0.3) ? uniform(g, -0.6, 0.6) : 0.0;
        }
    }
    for (size_t k = 0; k < s->followers; k++) {
        s->normal[k] = k < s->normals ? k : below(g, s->normals);
    }
}

static struct scene scene_create(int seed)
{
    struct random g = random_of(seed);
    struct scene s = {.n = 1 + below(&g, DOFS), .followers = 1 + below(&g, FOLLOWERS)};
    s.normals = 1 + below(&g, s.followers);
    s.rows = s.followers + s.normals;
    make_matrices(&s, &g);
    make_directions(&s, &g);
    const int elastic = chance(&g, 0.5), belts = chance(&g, 0.5), moving = chance(&g, 0.5), shakes = chance(&g, 0.2);
    for (size_t k = 0; k < s.followers; k++) {
        s.mu[k] = uniform(&g, 0.05, 0.8);
        s.compliance[k] = elastic && chance(&g, 0.6) ? log_uniform(&g, 0.7) : 0.0;
        s.belt[k] = belts && chance(&g, 0.7) ? uniform(&g, -1.0, 1.0) : 0.0;
        s.shake[k] = shakes ? uniform(&g, -0.5, 0.5) : 0.0;
    }
    s.shake_omega = uniform(&g, 0.5, 3.0);
    for (size_t k = 0; k < s.normals; k++) {
        s.spring[k] = log_uniform(&g, 1.5) * 3.0;
        s.gap[k] = chance(&g, 0.4) ? 0.0 : uniform(&g, -1.0, 0.3);
    }
    for (size_t k = 0; k < 3; k++) {
        s.load[k].omega = k ? uniform(&g, 0.5, 4.0) : 0.0;
        for (size_t i = 0; i < s.n; i++) {
            s.load[k].cosine[i] = chance(&g, 0.6) ? uniform(&g, -2.0, k ? 2.0 : 3.0) : 0.0;
            s.load[k].sine[i] = k && chance(&g, 0.6) ? uniform(&g, -2.0, 2.0) : 0.0;
        }
    }
    for (size_t i = 0; moving && i < 2 * s.n; i++) {
        s.start[i] = uniform(&g, -1.0, 1.0);
    }
    const int is_free = chance(&g, 0.2);
    for (size_t i = 0; is_free && i < s.n; i++) { /* some bodies, which nothing holds */
        const size_t end = chance(&g, 0.5) ? s.n : 0;
        for (size_t j = 0; j < end; j++) {
            s.stiffness[i * s.n + j] = s.stiffness[j * s.n + i] = s.damping[i * s.n + j] = s.damping[j * s.n + i] = 0.0;
        }
    }
    snprintf(s.name, sizeof s.name, "%zu dofs, %zu contacts, %zu normals%s%s%s%s%s", s.n, s.followers, s.normals,
             is_free ? ", free" : "", elastic ? ", elastic" : "", belts ? ", belts" : "", shakes ? ", shaken" : "",
             moving ? ", moving" : "");
    return s;
}

/* Makes planar contacts of some followers: the second direction has the normal of the first. */
static void pair_up(struct scene *s, int seed, int elastic)
{
    struct random g = random_of(seed);
    int pushes[FOLLOWERS] = {0};
    for (size_t k = 0; k + 1 < s->followers; k++) {
        if (s->pair[k] == ALONE && (k == 0 || chance(&g, 0.6))) {
            s->pair[k] = FIRST;
            s->pair[k + 1] = SECOND;
            s->normal[k + 1] = s->normal[k];
            s->mu[k + 1] = s->mu[k];
        }
    }
    for (size_t k = 0; k < s->followers; k++) {
        s->compliance[k] = !elastic ? 0.0 : s->pair[k] == SECOND ? s->compliance[k - 1] : s->compliance[k];
        s->compliance[k] = elastic && s->pair[k] == FIRST ? log_uniform(&g, 0.7) : s->compliance[k];
        pushes[s->normal[k]] = 1;
        for (size_t j = 0; j < s->n; j++) { /* redundant contacts at rest are refused */
            s->direction[k * s->n + j] += uniform(&g, -0.3, 0.3);
        }
    }
    for (size_t k = 0; k < s->normals; k++) {
        s->spring[k] *= pushes[k];
    }
    strcat(s->name, elastic ? ", planar on springs" : ", planar");
}

/* NULL: bodies beside planar contacts are too light. */
static tribo_system *scene_system(const struct scene *s, int seed)
{
    tribo_model *model;
    tribo_system *sys = NULL;
    assert_ok(tribo_model_create(&model, s->n, s->rows));
    assert_ok(tribo_model_set_mass(model, s->mass));
    assert_ok(tribo_model_set_damping(model, s->damping));
    assert_ok(tribo_model_set_stiffness(model, s->stiffness));
    assert_ok(tribo_model_set_direction(model, s->direction));
    assert_ok(tribo_model_set_compliance(model, s->compliance));
    size_t first[FOLLOWERS], planes = 0;
    for (size_t k = 0; k < s->followers; k++) {
        const size_t n = s->normal[k];
        if (s->pair[k] != SECOND) {
            assert_ok(tribo_model_set_normal(model, k, s->followers + n, s->mu[k], s->spring[n], s->gap[n]));
        }
        if (s->pair[k] == FIRST) {
            first[planes++] = k;
        }
    }
    const int status = tribo_system_create(&sys, model);
    require(!status, "seed %d: %s", seed, tribo_model_message(model));
    tribo_model_destroy(model);
    const int planar = tribo_set_planar(tribo_system_context(sys), planes, first);
    if (planar) {
        require(planar == TRIBO_ERR_UNSUPPORTED, "seed %d: %s", seed, tribo_message(tribo_system_context(sys)));
        printf("seed %d, %s: %s\n", seed, s->name, tribo_message(tribo_system_context(sys)));
        tribo_system_destroy(sys);
        return NULL;
    }
    for (size_t k = 0; k < 3; k++) {
        assert_ok(tribo_system_add_load(sys, s->load[k].omega, s->load[k].cosine, s->load[k].sine));
    }
    assert_ok(tribo_system_add_base_motion(sys, 0.0, s->belt, NULL));
    assert_ok(tribo_system_add_base_motion(sys, s->shake_omega, s->shake, NULL));
    return sys;
}

/* ---------------------------------------------------------------------------------------------------------------- the law */

static double row_of(const double *row, const double *x, size_t n)
{
    double sum = 0.0;
    for (size_t j = 0; j < n; j++) {
        sum += row[j] * x[j];
    }
    return sum;
}

/* Weights of the derivative by 9 points. */
static const double weight[9] = {1.0 / 280, -4.0 / 105, 0.2, -0.8, 0.0, 0.8, -0.2, 4.0 / 105, -1.0 / 280};

/* Derivative of value k of the states y [9]. */
static double derivative(double y[9][2 * DOFS + FOLLOWERS + 1], size_t k)
{
    double sum = 0.0;
    for (size_t p = 0; p < 9; p++) {
        sum += weight[p] * y[p][k];
    }
    return sum / STEP;
}

/* f [count] = the forces in directions row [count][n] that leave the least of r [n], by normal equations; r becomes what they
 * leave. Returns 0 if the directions depend on each other. */
static int find_forces(size_t n, size_t count, const double *const *row, double *r, double *f)
{
    double a[FOLLOWERS][FOLLOWERS + 1];
    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j < count; j++) {
            a[i][j] = row_of(row[i], row[j], n);
        }
        a[i][count] = row_of(row[i], r, n);
    }
    for (size_t i = 0; i < count; i++) {
        if (fabs(a[i][i]) < 1e-6) {
            return 0;
        }
        for (size_t k = 0; k < count; k++) {
            const double by = k == i ? 0.0 : a[k][i] / a[i][i];
            for (size_t j = i; j <= count && k != i; j++) {
                a[k][j] -= by * a[i][j];
            }
        }
    }
    for (size_t i = 0; i < count; i++) {
        f[i] = a[i][count] / a[i][i];
        for (size_t j = 0; j < n; j++) {
            r[j] -= f[i] * row[i][j];
        }
    }
    return 1;
}

/* The velocity of direction k at t in the state y. */
static double velocity(const struct scene *s, size_t k, double t, const double *y)
{
    return row_of(s->direction + k * s->n, y + s->n, s->n) - s->belt[k] - s->shake[k] * cos(s->shake_omega * t);
}

/* f [2] = force of the planar contact on springs with first direction k in the state y. */
static void spring_force(const struct scene *s, size_t k, const double *y, double *f)
{
    size_t springs = 0;
    for (size_t i = 0; i < k; i++) {
        springs += s->compliance[i] > 0.0;
    }
    for (size_t d = 0; d < 2; d++) {
        f[d] = (y[2 * s->n + springs + d] - row_of(s->direction + (k + d) * s->n, y, s->n)) / s->compliance[k];
    }
}

/* Returns 1 if a planar contact turns fast, or stops nearby, so that differences in time are not exact. */
static int turns(const struct scene *s, double t, double y[9][2 * DOFS + FOLLOWERS + 1])
{
    for (size_t k = 0; k < s->followers; k++) {
        double speed = 0.0, change = 0.0;
        for (size_t d = k; s->pair[k] == FIRST && d < k + 2; d++) {
            speed = hypot(speed, velocity(s, d, t, y[4]));
            change = hypot(change, velocity(s, d, t + 4.0 * STEP, y[8]) - velocity(s, d, t - 4.0 * STEP, y[0]));
        }
        if (s->pair[k] == FIRST && s->compliance[k] > 0.0) {
            double first[2], last[2];
            spring_force(s, k, y[0], first);
            spring_force(s, k, y[8], last);
            speed = hypot(last[0], last[1]);
            change = hypot(last[0] - first[0], last[1] - first[1]);
        }
        if (speed > 1e-8 && change > 0.1 * speed) {
            return 1;
        }
    }
    return 0;
}

/* Residual of the equations of motion and of the law at t, the middle of states y, less the rounding of differences; largest
 * number of these in *size. */
static double residual(const struct scene *s, double t, double y[9][2 * DOFS + FOLLOWERS + 1], double *size)
{
    const size_t n = s->n;
    const double *q = y[4], *u = q + n;
    double r[DOFS], rounding[DOFS] = {0.0}, f[FOLLOWERS], off = 0.0, power = 0.0, largest = 0.0;
    const double *stuck[FOLLOWERS];
    size_t held[FOLLOWERS], count = 0, springs = 0;
    *size = 1.0;
    for (size_t d = 0; d < 2 * n; d++) {
        largest = fmax(largest, fabs(q[d]));
    }
    const double still = 1e-8 + ROUNDING * largest;
    for (size_t d = 0; d < n; d++) {
        r[d] = row_of(s->stiffness + d * n, q, n) + row_of(s->damping + d * n, u, n);
        *size = fmax(*size, fabs(r[d]));
        for (size_t e = 0; e < n; e++) {
            r[d] += s->mass[d * n + e] * derivative(y, n + e);
            rounding[d] += ROUNDING * fabs(s->mass[d * n + e] * u[e]);
        }
        for (size_t k = 0; k < 3; k++) {
            r[d] -= s->load[k].cosine[d] * cos(s->load[k].omega * t) + s->load[k].sine[d] * sin(s->load[k].omega * t);
        }
        for (size_t k = 0; k < s->normals; k++) {
            const double *row = s->direction + (s->followers + k) * n;
            r[d] += row[d] * s->spring[k] * fmax(row_of(row, q, n) - s->gap[k], 0.0);
        }
    }
    for (size_t k = 0; k < s->followers; k++) {
        const double *row = s->direction + k * n, *across = s->direction + (s->followers + s->normal[k]) * n;
        const double limit = s->mu[k] * s->spring[s->normal[k]] * fmax(row_of(across, q, n) - s->gap[s->normal[k]], 0.0);
        double v = velocity(s, k, t, q);
        if (s->pair[k] == FIRST && s->compliance[k] > 0.0) {
            double slides[2], force[2];
            spring_force(s, k, q, force);
            for (size_t e = 0; e < 2; e++) {
                slides[e] = velocity(s, k + e, t, q) + derivative(y, 2 * n + springs++) - row_of(row + e * n, u, n);
            }
            const double moves = hypot(slides[0], slides[1]);
            off = fmax(off, hypot(force[0], force[1]) - limit);
            *size = fmax(*size, limit);
            for (size_t e = 0; e < 2; e++) {
                const double part = moves > 0.0 && limit > 0.0 ? fmin(moves, fabs(force[e] + limit * slides[e] / moves)) : 0.0;
                off = fmax(off, part);
                power -= force[e] * slides[e];
                for (size_t d = 0; d < n; d++) {
                    r[d] -= row[e * n + d] * force[e];
                }
            }
            k++;
            continue;
        }
        const int elastic = s->compliance[k] > 0.0;
        *size = fmax(*size, limit);
        if (elastic) {
            f[k] = (q[2 * n + springs] - row_of(row, q, n)) / s->compliance[k];
            v += derivative(y, 2 * n + springs++) - row_of(row, u, n);
            off = fmax(off, fabs(f[k]) - limit);
        }
        const double other = s->pair[k] == ALONE ? 0.0 : velocity(s, s->pair[k] == FIRST ? k + 1 : k - 1, t, q);
        const double speed = hypot(v, other);
        if (limit == 0.0) {
            off = fmax(off, elastic ? fabs(f[k]) : 0.0);
            f[k] = 0.0;
        } else if (s->pair[k] != ALONE && speed > still) {
            f[k] = -limit * v / speed;
        } else if (speed > still) {
            off = elastic ? fmax(off, fmin(fabs(f[k] + copysign(limit, v)), fabs(v))) : off;
            f[k] = -copysign(limit, v);
        } else if (!elastic) {
            held[count] = k;
            stuck[count++] = row;
            continue;
        }
        power -= f[k] * v;
        for (size_t d = 0; d < n; d++) {
            r[d] -= row[d] * f[k];
        }
    }
    double hold[FOLLOWERS];
    if (turns(s, t, y) || !find_forces(n, count, stuck, r, hold)) {
        return 0.0;
    }
    for (size_t k = 0; k < count; k++) {
        const double *across = s->direction + (s->followers + s->normal[held[k]]) * n;
        const size_t c = s->normal[held[k]];
        const double force = s->pair[held[k]] == FIRST ? hypot(hold[k], hold[k + 1]) : fabs(hold[k]);
        off = fmax(off, force - s->mu[held[k]] * s->spring[c] * fmax(row_of(across, q, n) - s->gap[c], 0.0));
    }
    for (size_t d = 0; d < n; d++) {
        off = fmax(off, fabs(r[d]) - rounding[d]);
    }
    const double lost = fabs(derivative(y, 2 * n + springs) - power) - ROUNDING * fabs(q[2 * n + springs]);
    return fmax(off, lost * *size / fmax(*size, fabs(power)));
}

static int count_events(const tribo_moment *moment, void *data)
{
    *(int *)data += moment->kind != TRIBO_MOMENT_STEP;
    return 0;
}

/* Moves scene s by a method from its start; checks the law in windows in which no event falls. y: the states at the ends of
 * WINDOWS pieces. Returns the driver's status. */
static int follow(const struct scene *s, int seed, const char *method, double y[WINDOWS][2 * DOFS + FOLLOWERS + 1])
{
    tribo_system *sys = scene_system(s, seed);
    const size_t all = sys ? tribo_system_dimension(sys) : 0;
    tribo_driver *d = NULL;
    double t = 0.0, at[9][2 * DOFS + FOLLOWERS + 1] = {{0.0}}, state[2 * DOFS + FOLLOWERS + 1] = {0.0}, size;
    int status = sys ? tribo_driver_create(&d, sys, method) : TRIBO_ERR_UNSUPPORTED, events = 0;
    if (status) {
        tribo_system_destroy(sys);
        return status;
    }
    memcpy(state, s->start, 2 * s->n * sizeof *state);
    assert_ok(tribo_driver_set_observer(d, count_events, &events));
    for (size_t w = 0; !status && w < WINDOWS; w++) {
        const double end = DURATION * (double)(w + 1) / WINDOWS;
        for (size_t p = 0; !status && p < 9; p++) {
            status = tribo_driver_advance(d, &t, end + ((double)p - 8.0) * STEP, state);
            memcpy(at[p], state, all * sizeof *state);
            events = p ? events : 0;
        }
        memcpy(y[w], state, all * sizeof *state);
        if (!status && !events) {
            const double off = residual(s, end - 4.0 * STEP, at, &size);
            require(off < 1e-7 * size, "seed %d, %s: %s breaks the law at t = %.17g by %g of %g", seed, s->name, method,
                    end - 4.0 * STEP, off, size);
        }
    }
    if (status) {
        printf("seed %d, %s, %s: %s\n", seed, s->name, method, tribo_driver_message(d));
    }
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
    return status;
}

/* Moves a scene by event and exact, which agree. */
static void both(const struct scene *s, int seed)
{
    double y[2][WINDOWS][2 * DOFS + FOLLOWERS + 1] = {{{0.0}}};
    const int event = follow(s, seed, "event", y[0]), exact = follow(s, seed, "exact", y[1]);
    require(!event, "seed %d, %s: event: %d", seed, s->name, event);
    require(!exact || exact == TRIBO_ERR_UNSUPPORTED, "seed %d, %s: exact: %d", seed, s->name, exact);
    for (size_t w = 0; !exact && w < WINDOWS; w++) {
        double off = 0.0, size = 1.0;
        for (size_t i = 0; i < 2 * DOFS + FOLLOWERS + 1; i++) {
            off = fmax(off, fabs(y[0][w][i] - y[1][w][i]));
            size = fmax(size, fabs(y[0][w][i]));
        }
        require(off <= 1e-9 * size, "seed %d, %s: at piece %zu exact and event differ by %g of %g", seed, s->name, w, off, size);
    }
}

TEST(agree)
{
    const int first = setting("TRIBO_SEED", 0) + BLOCK * _i;
    for (int seed = first; seed < first + BLOCK; seed++) {
        const struct scene s = scene_create(seed);
        both(&s, seed);
    }
}

/* Adds a part to the stiffness of s that is not symmetric, as of loads that follow the structure. */
static void circulate(struct scene *s, int seed)
{
    struct random g = random_of(seed + 1000000);
    const double size = uniform(&g, 0.02, 0.6);
    for (size_t i = 0; i < s->n; i++) {
        for (size_t j = 0; j < i; j++) {
            const double own = sqrt(fabs(s->stiffness[i * (s->n + 1)] * s->stiffness[j * (s->n + 1)]));
            const double part = chance(&g, 0.6) ? uniform(&g, -size, size) * own : 0.0;
            s->stiffness[i * s->n + j] += part;
            s->stiffness[j * s->n + i] -= part;
        }
    }
}

/* Structures with a stiffness that is not symmetric, and limits that follow the motion. */
TEST(circulatory)
{
    const int first = setting("TRIBO_SEED", 0) + BLOCK * _i;
    for (int seed = first; seed < first + BLOCK; seed++) {
        struct scene s = scene_create(seed);
        circulate(&s, seed);
        both(&s, seed);
    }
}

/* Planar contacts: by event alone. */
TEST(planes)
{
    const int first = setting("TRIBO_SEED", 0) + BLOCK * _i;
    for (int seed = first; seed < first + BLOCK; seed++) {
        double y[WINDOWS][2 * DOFS + FOLLOWERS + 1] = {{0.0}};
        struct scene s = scene_create(seed);
        if (s.followers > 1 && s.n > 1) {
            pair_up(&s, seed, seed % 2);
            const int event = follow(&s, seed, "event", y);
            require(!event || event == TRIBO_ERR_UNSUPPORTED, "seed %d, %s: event: %d", seed, s.name, event);
        }
    }
}

/* Finds a periodic motion of s by a method: y, its multipliers sorted by modulus, re [dimension - 1], and by event how far the
 * motion is from there after a period. Returns a status. */
static int find_return(const struct scene *s, int seed, const char *method, double period, double *y, double *multiplier,
                       double *modulus, double *off)
{
    tribo_system *sys = scene_system(s, seed);
    const size_t all = sys ? tribo_system_dimension(sys) : 0;
    tribo_driver *d = NULL;
    double re[2 * DOFS + FOLLOWERS], im[2 * DOFS + FOLLOWERS], t = 0.0, z[2 * DOFS + FOLLOWERS + 1];
    *off = 0.0;
    if (!sys) {
        return TRIBO_ERR_UNSUPPORTED;
    }
    assert_ok(tribo_driver_create(&d, sys, method));
    int status = tribo_driver_find_periodic(d, 0.0, period, y);
    status = status ? status : tribo_driver_get_multipliers(d, re, im);
    if (status) {
        printf("seed %d, %s, %s: %s\n", seed, s->name, method, tribo_driver_message(d));
    }
    tribo_driver_destroy(d);
    if (!status) {
        for (size_t i = 0; i + 1 < all; i++) {
            multiplier[i] = re[i];
            modulus[i] = hypot(re[i], im[i]);
        }
        memcpy(z, y, all * sizeof *z);
        assert_ok(tribo_driver_create(&d, sys, "event"));
        status = tribo_driver_advance(d, &t, period, z);
        require(!status || status == TRIBO_ERR_UNSUPPORTED, "seed %d, %s: %s", seed, s->name, tribo_driver_message(d));
        for (size_t i = 0; i + 1 < all; i++) {
            *off = fmax(*off, fabs(z[i] - y[i]));
        }
        tribo_driver_destroy(d);
    }
    tribo_system_destroy(sys);
    return status;
}

/* Gives the loads and the base one period, and each body damping. Returns the period. */
static double give_period(struct scene *s)
{
    s->load[2].omega = 2.0 * s->load[1].omega;
    s->shake_omega = s->load[1].omega;
    for (size_t i = 0; i < s->n; i++) {
        s->damping[i * (s->n + 1)] += 0.2 * s->mass[i * (s->n + 1)];
    }
    return 2.0 * PI / s->load[1].omega;
}

/* Periodic motions by event and by exact return, and have the same multipliers. Bodies that nothing holds return to any place. */
TEST(periodic)
{
    const int first = setting("TRIBO_SEED", 0) + BLOCK * _i;
    for (int seed = first; seed < first + BLOCK; seed++) {
        struct scene s = scene_create(seed);
        double y[2][2 * DOFS + FOLLOWERS + 1] = {{0.0}}, modulus[2][2 * DOFS + FOLLOWERS] = {{0.0}},
                                           multiplier[2 * DOFS + FOLLOWERS], off[2], size = 1.0, same = 0.0;
        if (strstr(s.name, "free")) {
            continue;
        }
        const double period = give_period(&s);
        int status[2];
        for (int k = 0; k < 2; k++) {
            status[k] = find_return(&s, seed, k ? "exact" : "event", period, y[k], multiplier, modulus[k], &off[k]);
        }
        for (size_t i = 0; i < 2 * DOFS + FOLLOWERS; i++) {
            size = fmax(size, fmax(fabs(y[0][i]), modulus[0][i]));
            same = fmax(same, fabs(y[0][i] - y[1][i]));
        }
        require(status[0] || off[0] < 1e-9 * size, "seed %d, %s: event does not return by %g", seed, s.name, off[0]);
        require(status[1] || off[1] < 1e-9 * size, "seed %d, %s: exact does not return by %g", seed, s.name, off[1]);
        for (size_t i = 0; !status[0] && !status[1] && same < 1e-9 * size && i < 2 * DOFS + FOLLOWERS; i++) {
            require(fabs(modulus[0][i] - modulus[1][i]) < 1e-6 * size, "seed %d, %s: multiplier %zu: %g by event, %g by exact",
                    seed, s.name, i, modulus[0][i], modulus[1][i]);
        }
    }
}

/* Sum over the diagonal of the derivative of the motion over a period by its start y, by differences. */
static double trace_of(const struct scene *s, int seed, double period, const double *y)
{
    tribo_system *sys = scene_system(s, seed);
    const size_t all = tribo_system_dimension(sys);
    tribo_driver *d = NULL;
    double sum = 0.0;
    assert_ok(tribo_driver_create(&d, sys, "event"));
    for (size_t i = 0; i + 1 < all; i++) {
        for (double side = -1.0; side <= 1.0; side += 2.0) {
            double t = 0.0, z[2 * DOFS + FOLLOWERS + 1];
            memcpy(z, y, all * sizeof *z);
            z[i] += side * SHIFT;
            assert_ok(tribo_driver_advance(d, &t, period, z));
            sum += side * z[i] / (2.0 * SHIFT);
        }
    }
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
    return sum;
}

/* A periodic motion of planar contacts by event returns, and has the multipliers of the motions beside it, to `error` of its
 * size. */
static void check_planes(int seed, int elastic, double error)
{
    struct scene s = scene_create(seed);
    double y[2 * DOFS + FOLLOWERS + 1] = {0.0}, re[2 * DOFS + FOLLOWERS] = {0.0}, modulus[2 * DOFS + FOLLOWERS], off, size = 1.0,
                                    sum = 0.0;
    if (strstr(s.name, "free") || s.followers < 2 || s.n < 2) {
        return;
    }
    pair_up(&s, seed, elastic);
    const double period = give_period(&s);
    if (!find_return(&s, seed, "event", period, y, re, modulus, &off)) {
        for (size_t i = 0; i < 2 * DOFS; i++) {
            size = fmax(size, fabs(y[i]));
        }
        for (size_t i = 0; i < 2 * DOFS + FOLLOWERS; i++) {
            sum += re[i];
        }
        require(off < 1e-9 * size, "seed %d, %s: event does not return by %g", seed, s.name, off);
        const double want = trace_of(&s, seed, period, y);
        require(fabs(sum - want) < error * size, "seed %d, %s: multipliers have the sum %g, motions beside %g", seed, s.name, sum,
                want);
    }
}

TEST(periodic_planes)
{
    const int first = setting("TRIBO_SEED", 0) + BLOCK * _i;
    for (int seed = first; seed < first + BLOCK; seed++) {
        check_planes(seed, seed % 2, 1e-3);
    }
}

/* Planar contacts on springs that slide as they lift off, or long at a small limit: perturbations across the force fade fast. */
TEST(fading_planes)
{
    const int seeds[] = {151, 373, 425, 5021};
    check_planes(seeds[_i], 1, 1e-6);
}

/* A body of mass 1 with x and y on springs; the contact acts in x, the normal in y, of stiffness 3, gap 0; elastic or rigid.
 * Copies of the body, each with its contact. */
static struct scene bodies(size_t copies, int elastic, double mu)
{
    struct scene s = {.n = 2 * copies, .followers = copies, .normals = copies, .rows = 2 * copies, .name = "by hand"};
    for (size_t k = 0; k < copies; k++) {
        for (size_t i = 2 * k; i < 2 * k + 2; i++) {
            s.mass[i * (s.n + 1)] = s.stiffness[i * (s.n + 1)] = 1.0;
        }
        s.direction[k * s.n + 2 * k] = s.direction[(copies + k) * s.n + 2 * k + 1] = 1.0;
        s.normal[k] = k;
        s.mu[k] = mu;
        s.spring[k] = 3.0;
        s.compliance[k] = elastic ? 0.5 : 0.0;
    }
    return s;
}

enum {
    EQUAL,
    DOUBLE,
    TOUCHES_AT_REST,
    GRAZES,
    LIFTS_AT_REST,
    NO_LOAD,
    LATE_LOAD,
    VANISH_TOGETHER,
    AT_THE_LIMIT,
    SLIDES_TO_0,
    CASES
};

static struct scene degenerate_scene(int which, size_t copies, int elastic)
{
    struct scene s = bodies(which == EQUAL ? copies : 1, elastic, 0.5);
    s.load[1].omega = 1.5;
    switch (which) {
    case EQUAL: /* touch, stick, slide and lift at the same times */
        for (size_t k = 0; k < copies; k++) {
            s.load[1].cosine[2 * k] = 2.0;
            s.load[1].sine[2 * k + 1] = 1.5;
        }
        break;
    case DOUBLE: /* three contacts of one body share a normal */
        s.followers = 3;
        s.rows = 4;
        memcpy(s.direction, (double[]){1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0}, 8 * sizeof(double));
        s.normal[1] = s.normal[2] = 0;
        s.mu[1] = s.mu[2] = 0.25;
        s.compliance[1] = s.compliance[2] = s.compliance[0];
        s.load[1].cosine[0] = 3.0;
        s.load[1].sine[1] = 1.5;
        break;
    case TOUCHES_AT_REST: /* the load presses from 0 on, at first by its third derivative */
        s.load[0].cosine[1] = -1.0;
        s.load[1].cosine[1] = 1.0;
        s.load[1].sine[0] = 1.0;
        break;
    case GRAZES: /* y = -1 - cos t rises to 0, and touches there */
        s.load[0].cosine[1] = -1.0;
        s.start[1] = -2.0;
        s.load[1].cosine[0] = 1.0;
        break;
    case LIFTS_AT_REST: /* y = (1 - cos 2 t)/4 falls to 0 */
        s.load[0].cosine[1] = 1.0;
        s.load[1].cosine[0] = 1.0;
        break;
    case NO_LOAD: /* y = 0, N = 0 */
        s.load[1].cosine[0] = 1.0;
        s.start[2] = 0.3;
        break;
    case LATE_LOAD: /* the normal of y and a body that does not move: N = 0 until the contact moves it */
        s.direction[s.n + 0] = 0.25;
        s.start[0] = -1.0;
        break;
    case VANISH_TOGETHER: /* x pulls by N/2 against mu = 0.6 */
    case AT_THE_LIMIT:    /* and against 0.5, the limit */
        s.stiffness[0] = 4.0;
        s.stiffness[1] = s.stiffness[2] = -1.5;
        s.mu[0] = which == VANISH_TOGETHER ? 0.6 : 0.5;
        s.load[0].cosine[1] = 1.0;
        s.load[1].cosine[1] = 2.0;
        break;
    default: /* stops where it lifts off: v and N are 0 at t = pi/2 */
        s.start[1] = 0.0;
        s.start[3] = -1.0;
        s.start[0] = -1.0;
        break;
    }
    snprintf(s.name, sizeof s.name, "case %d%s", which, elastic ? ", elastic" : "");
    return s;
}

TEST(degenerate)
{
    const struct scene s = degenerate_scene(_i % CASES, 3, _i / CASES);
    both(&s, _i);
}

/* The same scene with another degree of freedom across each contact, and planar contacts with directions askew. */
static struct scene askew(const struct scene *s)
{
    struct scene p = {.n = s->n + s->followers, .followers = 2 * s->followers, .normals = s->normals};
    const double c = 0.6, across = 0.8;
    p.rows = p.followers + p.normals;
    for (size_t i = 0; i < p.n; i++) {
        p.mass[i * (p.n + 1)] = p.stiffness[i * (p.n + 1)] = 1.0;
        for (size_t j = 0; j < s->n && i < s->n; j++) {
            p.mass[i * p.n + j] = s->mass[i * s->n + j];
            p.stiffness[i * p.n + j] = s->stiffness[i * s->n + j];
        }
    }
    for (size_t i = 0; i < p.rows; i++) {
        const size_t from = i < p.followers ? i / 2 : i - s->followers;
        const double along = i >= p.followers ? 1.0 : i % 2 ? -across : c;
        for (size_t j = 0; j < s->n; j++) {
            p.direction[i * p.n + j] = along * s->direction[from * s->n + j];
        }
        if (i < p.followers) {
            p.direction[i * p.n + s->n + i / 2] = i % 2 ? c : across;
            p.normal[i] = s->normal[i / 2];
            p.mu[i] = s->mu[i / 2];
            p.compliance[i] = s->compliance[i / 2];
            p.pair[i] = i % 2 ? SECOND : FIRST;
        }
    }
    memcpy(p.spring, s->spring, sizeof p.spring);
    memcpy(p.gap, s->gap, sizeof p.gap);
    memcpy(p.load, s->load, sizeof p.load);
    for (size_t i = 0; i < s->n; i++) {
        p.start[i] = s->start[i];
        p.start[p.n + i] = s->start[s->n + i];
    }
    snprintf(p.name, sizeof p.name, "%.90s, planar", s->name);
    return p;
}

/* A planar contact that moves on a line is the scalar one. */
TEST(degenerate_planes)
{
    double y[2][WINDOWS][2 * DOFS + FOLLOWERS + 1] = {{{0.0}}};
    const struct scene s = degenerate_scene(_i % CASES, 2, _i / CASES), p = askew(&s);
    const size_t springs = _i / CASES ? s.followers : 0;
    if (_i % CASES == DOUBLE) { /* redundant at rest, or more directions than a scene has */
        return;
    }
    assert_ok(follow(&s, _i, "event", y[0]));
    const int status = follow(&p, _i, "event", y[1]);
    require(!status, "%s: %d", p.name, status);
    for (size_t w = 0; w < WINDOWS; w++) {
        double off = fabs(y[0][w][2 * s.n + springs] - y[1][w][2 * (p.n + springs)]);
        for (size_t i = 0; i < s.n; i++) {
            off = fmax(off, fabs(y[0][w][i] - y[1][w][i]));
            off = fmax(off, fabs(y[0][w][s.n + i] - y[1][w][p.n + i]));
        }
        require(off < 1e-9, "%s: at piece %zu scalar and planar contacts differ by %g", p.name, w, off);
    }
}

int main(void)
{
    const struct test tests[] = {{agree, setting("TRIBO_BLOCKS", 12)},
                                 {circulatory, setting("TRIBO_BLOCKS", 4)},
                                 {planes, setting("TRIBO_BLOCKS", 12)},
                                 {periodic, 2},
                                 {periodic_planes, 2},
                                 {fading_planes, 4},
                                 {degenerate, 2 * CASES},
                                 {degenerate_planes, 2 * CASES}};
    return run_suite("following", tests, COUNT(tests));
}
