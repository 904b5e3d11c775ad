#include "response.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_multifit.h>

#include "../common/output.h"
#include "linear.h"

/* The motion is run in blocks of cycles, and its transient extrapolated after each from the last KEEP + 1 of them. */
enum { BLOCK = 16, KEEP = 8, BLOCKS = 250, QUIET = 5 };
static const double TOLERANCE = 1e-6;
static const double NOTHING = 1e-13;                     /* so much of the motion without friction is none: less is rounding */
static const double LEAST_STEPS = 400, MOST_STEPS = 1e5; /* a period; an amplitude is the largest of the values there */

/* ------------------------------------------------------------------------------------------------------ construction */

static gsl_spmatrix *contact_directions(const size_t *row, size_t contacts, size_t ndof)
{
    gsl_spmatrix *j = gsl_spmatrix_alloc(contacts, ndof);
    for (size_t c = 0; c < contacts; c++) {
        if (!j || gsl_spmatrix_set(j, c, row[c], 1.0)) {
            die("out of memory for %zu contacts", contacts);
        }
    }
    return j;
}

/* What a unit amplitude of each mode does at the load and at the contacts. */
static void read_shapes(struct damper *d, size_t ndof, size_t load, const size_t *row)
{
    double *unit = need_memory(d->modes, sizeof *unit), *full = need_memory(ndof, sizeof *full);
    for (size_t k = 0; k < d->modes; k++) {
        unit[k] = 1.0;
        need(tribo_system_expand(d->sys, unit, full), NULL);
        unit[k] = 0.0;
        d->load_shape[k] = full[load];
        for (size_t c = 0; c < d->contacts; c++) {
            d->contact_shape[c * d->modes + k] = full[row[c]];
        }
    }
    free(unit);
    free(full);
}

static void add_load(struct damper *d, size_t ndof, size_t load)
{
    double *sine = need_memory(ndof, sizeof *sine);
    sine[load] = d->force;
    need(tribo_system_add_load(d->sys, d->drive, NULL, sine), tribo_message(tribo_system_context(d->sys)));
    free(sine);
}

/* The load's frequency, and the step that goes with it. */
static void set_drive(struct damper *d, const struct options *o)
{
    const double turn = 2.0 * acos(-1.0), highest = d->omega[d->modes - 1];
    d->drive = o->drive > 0.0 ? turn * o->drive : d->omega[0];
    if (!(d->drive > 1e-6 * highest)) {
        die("the load's frequency, %g Hz, is next to nothing beside %g Hz of the highest mode kept%s", d->drive / turn,
            highest / turn, o->drive > 0.0 ? "" : ": the structure can move freely; give --drive");
    }
    d->period = turn / d->drive;
    const double steps = fmax(LEAST_STEPS, ceil(d->period * fmax(highest, d->drive) / o->step));
    if (!(steps <= MOST_STEPS)) {
        die("a period of the load would take %g steps, more than %g: keep fewer --modes, or take a larger --step", steps,
            MOST_STEPS);
    }
    set_steps(d, (size_t)steps);
}

/* What motions are measured by; its square must be a number, too. */
static void set_scale(struct damper *d)
{
    d->amplitude = free_amplitude(d);
    d->power = 0.5 * d->force * d->drive * d->amplitude;
    d->norm = free_norm(d);
    if (!isnormal(d->amplitude * d->amplitude) || !isnormal(d->power * d->power) || !isnormal(NOTHING * d->norm * d->norm)) {
        die("without friction the load makes an amplitude of %g: nothing to compute with; see --load, --force and --modes",
            d->amplitude);
    }
}

struct damper create_damper(const struct options *o, const struct structure *s)
{
    struct damper d = {.modes = o->modes, .contacts = o->contacts, .damping = o->damping, .force = o->force};
    size_t row[MAX_CONTACTS];
    if (d.modes > s->ndof) {
        die("option --modes %zu: the structure has %zu degrees of freedom", d.modes, s->ndof);
    }
    if (d.modes == 0) {
        d.modes = s->ndof < DEFAULT_MODES ? s->ndof : DEFAULT_MODES;
    }
    for (size_t c = 0; c < d.contacts; c++) {
        row[c] = find_degree(s, "--contact", &o->contact[c]);
    }
    const size_t load = find_degree(s, "--load", &o->load);
    gsl_spmatrix *direction = contact_directions(row, d.contacts, s->ndof);
    char message[200] = "";
    const int status =
        tribo_system_linear_sparse(&d.sys, s->mass, NULL, s->stiffness, direction, d.modes, message, sizeof message);
    if (status) {
        die("%s and %s: %s%s", o->mass, o->stiffness, message, strchr(message, '[') ? " (counted from 0)" : "");
    }
    gsl_spmatrix_free(direction);

    d.omega = need_memory(d.modes, sizeof *d.omega);
    d.load_shape = need_memory(d.modes, sizeof *d.load_shape);
    d.contact_shape = need_memory(d.contacts * d.modes, sizeof *d.contact_shape);
    tribo_context *contacts = tribo_system_context(d.sys);
    need(tribo_system_get_frequencies(d.sys, d.omega), tribo_message(contacts));
    need(tribo_system_set_damping_ratio(d.sys, d.damping), tribo_message(contacts));
    need(tribo_set_law(contacts, o->law), tribo_message(contacts));
    read_shapes(&d, s->ndof, load, row);
    set_drive(&d, o);
    set_scale(&d);
    add_load(&d, s->ndof, load);
    return d;
}

void free_damper(struct damper *d)
{
    tribo_driver_destroy(d->drv);
    tribo_system_destroy(d->sys);
    free(d->omega);
    free(d->load_shape);
    free(d->contact_shape);
}

void set_steps(struct damper *d, size_t steps)
{
    const double dt = d->period / (double)steps;
    tribo_context *contacts = tribo_system_context(d->sys);
    tribo_driver_destroy(d->drv);
    d->steps = steps;
    /* stuck contacts relax within a step or so, which rk4 still follows; epsilon then goes along with each limit */
    need(tribo_set_epsilon_step(contacts, dt, 1.0), tribo_message(contacts));
    need(tribo_driver_create(&d->drv, d->sys, "rk4/fixed", dt, 0.0, 0.0), tribo_message(contacts));
}

double load_displacement(const struct damper *d, const double *y)
{
    double x = 0.0;
    for (size_t k = 0; k < d->modes; k++) {
        x += d->load_shape[k] * y[k];
    }
    return x;
}

/* -------------------------------------------------------------------------------------------------------- one cycle */

static double damping_power(const struct damper *d, const double *y)
{
    double power = 0.0;
    for (size_t k = 0; k < d->modes; k++) {
        power += 2.0 * d->damping * d->omega[k] * y[d->modes + k] * y[d->modes + k];
    }
    return power;
}

static double load_power(const struct damper *d, double t, const double *y)
{
    return d->force * sin(d->drive * t) * load_displacement(d, y + d->modes);
}

/* Runs y through one period and measures it. The load is the same in every period, so that time may begin at 0 again. */
static struct response run_cycle(struct damper *d, double *y)
{
    struct response r = {0};
    double t = 0.0, least = HUGE_VAL, most = -HUGE_VAL;
    y[2 * d->modes] = 0.0;
    for (size_t i = 1; i <= d->steps; i++) {
        need(tribo_driver_advance(d->drv, &t, d->period * (double)i / (double)d->steps, y), tribo_driver_message(d->drv));
        const double x = load_displacement(d, y);
        least = fmin(least, x);
        most = fmax(most, x);
        r.damped += damping_power(d, y) / (double)d->steps;
        r.input += load_power(d, t, y) / (double)d->steps;
    }
    r.amplitude = 0.5 * (most - least);
    r.friction = y[2 * d->modes] / d->period;
    return r;
}

/* ----------------------------------------------------------------------------------------------------- steady motion */

/* Energy norm of the difference of two states; of a itself if b is NULL. */
static double distance(const struct damper *d, const double *a, const double *b)
{
    double sum = 0.0;
    for (size_t k = 0; k < 2 * d->modes; k++) {
        const double x = (k < d->modes ? d->omega[k] : 1.0) * (a[k] - (b ? b[k] : 0.0));
        sum += x * x;
    }
    return sqrt(sum);
}

/* Where the sequence of states y_0 ... y_keep+1 leads to, if each is a linear function of the one before, as it is close to a
 * steady motion: reduced rank extrapolation, s = y_0 - dY (d2Y)^+ dy_0 with first and second differences (Eddy 1979, Mesina
 * 1977). Plain repetition would do too, but a mode with a damping ratio of 0.2% takes a thousand cycles. */
static void extrapolate(const struct damper *d, double *const *y, size_t keep, double *to)
{
    const size_t n = 2 * d->modes;
    gsl_matrix *second = gsl_matrix_alloc(n, keep), *covariance = gsl_matrix_alloc(keep, keep);
    gsl_vector *first = gsl_vector_alloc(n), *c = gsl_vector_alloc(keep);
    gsl_multifit_linear_workspace *work = gsl_multifit_linear_alloc(n, keep);
    double unused;
    size_t rank;
    if (!second || !covariance || !first || !c || !work) {
        die("out of memory for %zu modes", d->modes);
    }
    for (size_t i = 0; i < n; i++) {
        const double weight = i < d->modes ? d->omega[i] : 1.0;
        gsl_vector_set(first, i, weight * (y[1][i] - y[0][i]));
        for (size_t k = 0; k < keep; k++) {
            gsl_matrix_set(second, i, k, weight * (y[k + 2][i] - 2.0 * y[k + 1][i] + y[k][i]));
        }
    }
    if (gsl_multifit_linear_tsvd(second, first, 1e-9, c, covariance, &unused, &rank, work)) {
        gsl_vector_set_zero(c);
    }
    for (size_t i = 0; i < n; i++) {
        to[i] = y[0][i];
        for (size_t k = 0; k < keep; k++) {
            to[i] -= gsl_vector_get(c, k) * (y[k + 1][i] - y[k][i]);
        }
    }
    gsl_matrix_free(second);
    gsl_matrix_free(covariance);
    gsl_vector_free(first);
    gsl_vector_free(c);
    gsl_multifit_linear_free(work);
}

/* Whether amplitude and dissipated power have not changed for QUIET cycles. Powers are compared with the input, since friction
 * dissipates nothing where contacts never slip. */
static int quiet(const struct damper *d, const struct response *r)
{
    for (int k = BLOCK - QUIET; k < BLOCK; k++) {
        const double power = r[k].friction + fabs(r[k].damped);
        if (fabs(r[k].amplitude - r[k - 1].amplitude) > fmax(TOLERANCE * r[k].amplitude, NOTHING * d->amplitude) ||
            fabs(r[k].friction - r[k - 1].friction) > fmax(TOLERANCE * power, NOTHING * d->power)) {
            return 0;
        }
    }
    return 1;
}

/* Runs a block of cycles from state[0] on; state[k] is that at the beginning of cycle k. */
static void run_block(struct damper *d, double *const *state, struct response *r)
{
    for (size_t k = 0; k < BLOCK; k++) {
        memcpy(state[k + 1], state[k], (2 * d->modes + 1) * sizeof *state[k]);
        r[k] = run_cycle(d, state[k + 1]);
    }
}

static double unless_nothing(double x, double whole)
{
    return fabs(x) < NOTHING * whole ? 0.0 : x;
}

struct response find_response(struct damper *d, double limit, double *y)
{
    const size_t n = 2 * d->modes + 1, keep = n - 1 < KEEP ? n - 1 : KEEP;
    double *memory = need_memory((BLOCK + 2) * n, sizeof *memory), *state[BLOCK + 2], *ahead = memory + (BLOCK + 1) * n;
    struct response r[BLOCK] = {{0}};
    tribo_context *contacts = tribo_system_context(d->sys);
    need(tribo_set_limit_all(contacts, limit), tribo_message(contacts));
    for (size_t k = 0; k < BLOCK + 2; k++) {
        state[k] = memory + k * n;
    }
    size_t cycles = 0, pause = 0, wait = 0;
    double change = HUGE_VAL;
    int steady = 0;
    while (!steady && cycles < BLOCKS * BLOCK) {
        run_block(d, state, r);
        cycles += BLOCK;
        const double last = distance(d, state[BLOCK], state[BLOCK - 1]);
        memcpy(ahead, state[BLOCK], n * sizeof *y);
        if (last > NOTHING * d->norm) {
            extrapolate(d, state + BLOCK - (keep + 1), keep, ahead);
        }
        steady = quiet(d, r) &&
                 distance(d, ahead, state[BLOCK]) < fmax(TOLERANCE * distance(d, state[BLOCK], NULL), NOTHING * d->norm);
        /* contacts may begin or cease to stick on the way to where the extrapolation leads: then rather wait, longer each time */
        if (wait == 0 && last > 0.5 * change) {
            pause = 2 * pause + 1;
            wait = pause;
        } else if (wait > 0) {
            wait--;
        }
        change = last;
        memcpy(state[0], wait || steady ? state[BLOCK] : ahead, n * sizeof *y);
    }
    memcpy(y, state[0], n * sizeof *y);
    struct response last = r[BLOCK - 1];
    last.limit = limit;
    last.amplitude = unless_nothing(last.amplitude, d->amplitude);
    last.friction = unless_nothing(last.friction, fmax(10.0 * last.damped, d->power));
    last.damped = unless_nothing(last.damped, d->power);
    last.input = unless_nothing(last.input, d->power);
    last.cycles = cycles;
    last.steady = steady;
    free(memory);
    return last;
}
