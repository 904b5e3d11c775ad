#include "damper.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "linear.h"

/* Rows of the structure where a contact slides; to is no row for the ground. */
struct rows {
    size_t at[MAX_CONTACTS], to[MAX_CONTACTS], load;
};

static struct rows find_rows(const struct options *o, const struct structure *s)
{
    struct rows r = {.load = find_degree(s, &o->load)};
    for (size_t c = 0; c < o->contacts; c++) {
        const struct contact *contact = &o->contact[c];
        r.at[c] = find_degree(s, &contact->at);
        r.to[c] = contact->between ? find_degree(s, &contact->to) : s->ndof;
        if (r.at[c] == r.to[c]) {
            die("%s: both ends are the same node", contact->at.origin);
        }
    }
    return r;
}

static gsl_spmatrix *contact_directions(const struct rows *r, size_t contacts, size_t ndof)
{
    gsl_spmatrix *j = gsl_spmatrix_alloc(contacts, ndof);
    for (size_t c = 0; c < contacts; c++) {
        if (!j || gsl_spmatrix_set(j, c, r->at[c], 1.0) || (r->to[c] < ndof && gsl_spmatrix_set(j, c, r->to[c], -1.0))) {
            die("out of memory for %zu contacts", contacts);
        }
    }
    return j;
}

/* What a unit amplitude of each mode does at the load and at the contacts. */
static void read_shapes(struct damper *d, const struct rows *r)
{
    double *unit = need_memory(d->modes, sizeof *unit), *full = need_memory(d->ndof + 1, sizeof *full);
    for (size_t k = 0; k < d->modes; k++) {
        unit[k] = 1.0;
        need(tribo_system_expand(d->sys, unit, full), NULL);
        unit[k] = 0.0;
        d->load_shape[k] = full[r->load];
        for (size_t c = 0; c < d->contacts; c++) {
            d->contact_shape[c * d->modes + k] = full[r->at[c]] - full[r->to[c]]; /* full[ndof] = 0 is the ground */
        }
    }
    free(unit);
    free(full);
}

static void allocate(struct damper *d)
{
    d->omega = need_memory(d->modes, sizeof *d->omega);
    d->load_shape = need_memory(d->modes, sizeof *d->load_shape);
    d->contact_shape = need_memory(d->contacts * d->modes, sizeof *d->contact_shape);
    d->limit = need_memory(d->contacts, sizeof *d->limit);
    d->mu = need_memory(d->contacts, sizeof *d->mu);
    d->stiffness = need_memory(d->contacts, sizeof *d->stiffness);
}

static void reduce(struct damper *d, const struct options *o, const struct structure *s, const struct rows *r)
{
    gsl_spmatrix *direction = contact_directions(r, d->contacts, d->ndof);
    char message[200] = "";
    const int status =
        tribo_system_linear_sparse(&d->sys, s->mass, NULL, s->stiffness, direction, d->modes, message, sizeof message);
    if (status) {
        const int counts = strchr(message, '[') || strstr(message, "degree of freedom ");
        die("%s and %s: %s%s", o->mass, o->stiffness, message, counts ? " (counted from 0)" : "");
    }
    gsl_spmatrix_free(direction);
    tribo_context *contacts = tribo_system_context(d->sys);
    need(tribo_system_get_frequencies(d->sys, d->omega), tribo_message(contacts));
    need(tribo_system_set_damping_ratio(d->sys, d->damping), tribo_message(contacts));
    need(tribo_set_law(contacts, o->law), tribo_message(contacts));
    size_t first[MAX_CONTACTS];
    for (size_t c = 0; c < d->contacts; c++) {
        if (o->contact[c].planar) {
            first[d->planar++] = c;
        }
    }
    need(tribo_set_planar(contacts, d->planar, first), tribo_message(contacts));
}

/* A spring so many times as stiff as the lowest mode that is no rigid body's leaves of its frequency what is still right. */
static const double MOST_STIFF = 1e9;

static void check_spring(const struct damper *d, size_t c, const char *origin)
{
    double lowest = HUGE_VAL, spring = 0.0;
    for (size_t k = 0; k < d->modes; k++) {
        const double shape = d->contact_shape[c * d->modes + k];
        spring += d->stiffness[c] * shape * shape;
        lowest = d->omega[k] > 1e-6 * d->omega[d->modes - 1] ? fmin(lowest, d->omega[k]) : lowest;
    }
    if (!(spring <= MOST_STIFF * lowest * lowest)) {
        die("%s: stiffness=%g is more than %g times that of the structure there: leave it out for a rigid contact", origin,
            d->stiffness[c], MOST_STIFF);
    }
}

/* Modes with a spring from contact c to the slider in row w. */
static void add_slider(const struct damper *d, size_t c, size_t w, double *stiffness)
{
    const double *shape = d->contact_shape + c * d->modes, k = d->stiffness[c];
    for (size_t i = 0; i < d->modes; i++) {
        for (size_t j = 0; j < d->modes; j++) {
            stiffness[i * d->motions + j] += k * shape[i] * shape[j];
        }
        stiffness[i * d->motions + w] = stiffness[w * d->motions + i] = -k * shape[i];
    }
    stiffness[w * d->motions + w] = k;
}

/* The system of modes and sliders takes the place of that of modes. */
static void add_sliders(struct damper *d, const struct options *o)
{
    const size_t n = d->motions;
    double *mass = need_memory(3 * n * n, sizeof *mass), *damping = mass + n * n, *stiffness = mass + 2 * n * n;
    double *direction = need_memory(d->contacts * n, sizeof *direction);
    char message[200] = "";
    for (size_t k = 0; k < d->modes; k++) {
        mass[k * n + k] = 1.0;
        damping[k * n + k] = 2.0 * d->damping * d->omega[k];
        stiffness[k * n + k] = d->omega[k] * d->omega[k];
    }
    for (size_t c = 0, w = d->modes; c < d->contacts; c++) {
        if (d->stiffness[c] > 0.0) {
            check_spring(d, c, o->contact[c].at.origin);
            add_slider(d, c, w, stiffness);
            direction[c * n + w++] = 1.0;
        } else {
            memcpy(direction + c * n, d->contact_shape + c * d->modes, d->modes * sizeof *direction);
        }
    }
    tribo_system_destroy(d->sys);
    d->sys = NULL;
    if (tribo_system_linear(&d->sys, n, d->contacts, mass, damping, stiffness, direction, 0, message, sizeof message)) {
        die("modes and sliders: %s", message);
    }
    need(tribo_set_law(tribo_system_context(d->sys), o->law), tribo_message(tribo_system_context(d->sys)));
    free(mass);
    free(direction);
}

/* The amplitude of the load, on the structure, or on modes and sliders. */
static void set_load(struct damper *d, size_t row)
{
    const int sliders = d->motions > d->modes;
    d->load = need_memory(sliders ? d->motions : d->ndof, sizeof *d->load);
    for (size_t k = 0; sliders && k < d->modes; k++) {
        d->load[k] = d->force * d->load_shape[k];
    }
    if (!sliders) {
        d->load[row] = d->force;
    }
}

struct damper create_damper(const struct options *o, const struct structure *s)
{
    struct damper d = {
        .ndof = s->ndof, .modes = o->modes, .contacts = o->contacts, .damping = o->damping, .force = o->force, .step = o->step};
    if (d.modes > s->ndof) {
        die("option --modes %zu: the structure has %zu degrees of freedom", d.modes, s->ndof);
    }
    if (d.modes == 0) {
        d.modes = s->ndof < DEFAULT_MODES ? s->ndof : DEFAULT_MODES;
    }
    const struct rows rows = find_rows(o, s);
    allocate(&d);
    reduce(&d, o, s, &rows);
    read_shapes(&d, &rows);
    d.motions = d.modes;
    for (size_t c = 0; c < d.contacts; c++) {
        d.limit[c] = o->contact[c].limit;
        d.mu[c] = o->contact[c].mu;
        d.stiffness[c] = o->contact[c].stiffness;
        d.motions += d.stiffness[c] > 0.0;
    }
    if (d.motions > d.modes) {
        add_sliders(&d, o);
    }
    set_load(&d, rows.load);
    return d;
}

void free_damper(struct damper *d)
{
    tribo_system_destroy(d->sys);
    free(d->omega);
    free(d->load_shape);
    free(d->contact_shape);
    free(d->load);
    free(d->limit);
    free(d->mu);
    free(d->stiffness);
}

void check_drive(const struct damper *d, double hz)
{
    const double highest = d->omega[d->modes - 1];
    if (!(TURN * hz > 1e-6 * highest)) {
        die("the load's frequency, %g Hz, is next to nothing beside %g Hz of the highest mode kept; see --drive", hz,
            highest / TURN);
    }
    const struct scale s = free_scale(d, TURN * hz);
    if (!isnormal(s.amplitude * s.amplitude) || !isnormal(s.power * s.power) || !isnormal(NOTHING * s.norm * s.norm)) {
        die("without friction the load makes an amplitude of %g: nothing to compute with; see --load, --force and --modes",
            s.amplitude);
    }
}

double load_displacement(const struct damper *d, const double *y)
{
    double x = 0.0;
    for (size_t k = 0; k < d->modes; k++) {
        x += d->load_shape[k] * y[k];
    }
    return x;
}

double damping_power(const struct damper *d, const double *y)
{
    double power = 0.0;
    for (size_t k = 0; k < d->modes; k++) {
        power += 2.0 * d->damping * d->omega[k] * y[d->modes + k] * y[d->modes + k];
    }
    return power;
}
