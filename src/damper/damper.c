#include "damper.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "linear.h"

/* Rows of the structure where a contact slides; to is ndof for the ground. Behind the contacts stands the load. */
struct places {
    size_t *at, *to, *output, load;
};

static struct places find_rows(const struct options *o, const struct structure *s)
{
    struct places r = {.load = find_degree(s, &o->load)};
    r.at = need_memory(2 * (o->contacts.count + 1) + o->outputs, sizeof *r.at);
    r.to = r.at + o->contacts.count + 1;
    r.output = r.to + o->contacts.count + 1;
    for (size_t k = 0; k < o->outputs; k++) {
        r.output[k] = find_degree(s, &o->output[k]);
    }
    for (size_t c = 0; c < o->contacts.count; c++) {
        const struct contact *contact = &o->contacts.contact[c];
        r.at[c] = find_degree(s, &contact->at);
        r.to[c] = contact->between ? find_degree(s, &contact->to) : s->ndof;
        if (r.at[c] == r.to[c]) {
            die("%s: both ends are the same node", contact->at.origin);
        }
    }
    r.at[o->contacts.count] = r.load;
    r.to[o->contacts.count] = s->ndof;
    return r;
}

/* A mode that moves a contact by less than this part of what the strongest mode does, does not move it: what is left there is
 * rounding, and counts as a body with an enormous mass. */
static const double UNMOVED = 1e-8;

static void clean_shape(const struct damper *d, double *shape)
{
    double most = 0.0;
    for (size_t k = 0; k < d->modes; k++) {
        most = fmax(most, fabs(shape[k]));
    }
    for (size_t k = 0; k < d->modes; k++) {
        shape[k] = fabs(shape[k]) < UNMOVED * most ? 0.0 : shape[k];
    }
}

/* What a unit amplitude of each mode does at the load and at the contacts. */
static void read_shapes(struct damper *d, const struct places *r)
{
    double *unit = need_memory(d->modes, sizeof *unit), *full = need_memory(d->ndof + 1, sizeof *full);
    for (size_t k = 0; k < d->modes; k++) {
        unit[k] = 1.0;
        need(tribo_system_expand(d->reduced, unit, full), NULL);
        unit[k] = 0.0;
        d->load_shape[k] = full[r->load];
        for (size_t i = 0; i < d->outputs; i++) {
            d->output_shape[i * d->modes + k] = full[r->output[i]];
        }
        for (size_t c = 0; c < d->contacts; c++) {
            d->contact_shape[c * d->modes + k] = full[r->at[c]] - full[r->to[c]]; /* full[ndof] = 0 is the ground */
        }
    }
    for (size_t c = 0; c < d->contacts; c++) {
        clean_shape(d, d->contact_shape + c * d->modes);
    }
    free(unit);
    free(full);
}

static void reduce(struct damper *d, const struct options *o, const struct structure *s, const struct places *r)
{
    /* with statics the load is a contact, too: its static response is needed as those of contacts */
    tribo_model *model = model_of(s, d->contacts + (size_t)o->statics, r->at, r->to);
    if (tribo_system_reduce(&d->reduced, model, d->kept, o->statics ? TRIBO_STATICS_MASS : TRIBO_STATICS_NONE)) {
        const char *message = tribo_model_message(model);
        const int counts = strchr(message, '[') || strstr(message, "degree of freedom ");
        die("%s and %s: %s%s", o->mass, o->stiffness, message, counts ? " (counted from 0)" : "");
    }
    tribo_model_destroy(model);
    d->modes = tribo_system_ndof(d->reduced);
    d->omega = need_memory(d->modes, sizeof *d->omega);
    d->load_shape = need_memory(d->modes, sizeof *d->load_shape);
    d->contact_shape = need_memory(d->contacts * d->modes, sizeof *d->contact_shape);
    d->output_shape = need_memory(d->outputs * d->modes, sizeof *d->output_shape);
    need(tribo_system_get_frequencies(d->reduced, d->omega), tribo_system_message(d->reduced));
    read_shapes(d, r);
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

static void set_contacts(struct damper *d, const struct options *o)
{
    tribo_context *contacts = tribo_system_context(d->sys);
    size_t *first = need_memory(d->contacts, sizeof *first);
    for (size_t c = 0; c < d->contacts; c++) {
        if (o->contacts.contact[c].planar) {
            first[d->planar++] = c;
        }
    }
    need(tribo_set_law(contacts, o->law), tribo_message(contacts));
    need(tribo_set_planar(contacts, d->planar, first), tribo_message(contacts));
    free(first);
}

/* The system of modes, and of sliders behind springs. */
static void build(struct damper *d, const struct options *o)
{
    double *mass = need_memory(3 * d->modes + d->contacts, sizeof *mass);
    double *damping = mass + d->modes, *stiffness = damping + d->modes, *compliance = stiffness + d->modes;
    tribo_model *model = NULL;
    for (size_t k = 0; k < d->modes; k++) {
        mass[k] = 1.0;
        damping[k] = 2.0 * d->damping * d->omega[k];
        stiffness[k] = d->omega[k] * d->omega[k];
    }
    for (size_t c = 0; c < d->contacts; c++) {
        if (d->stiffness[c] > 0.0) {
            check_spring(d, c, o->contacts.contact[c].at.origin);
            compliance[c] = 1.0 / d->stiffness[c];
        }
    }
    need(tribo_model_create(&model, d->modes, d->contacts), NULL);
    need(tribo_model_set_mass_diagonal(model, mass), tribo_model_message(model));
    need(tribo_model_set_damping_diagonal(model, damping), tribo_model_message(model));
    need(tribo_model_set_stiffness_diagonal(model, stiffness), tribo_model_message(model));
    need(tribo_model_set_direction(model, d->contact_shape), tribo_model_message(model));
    need(tribo_model_set_compliance(model, compliance), tribo_model_message(model));
    if (tribo_system_create(&d->sys, model)) {
        die("modes and sliders: %s", tribo_model_message(model));
    }
    tribo_model_destroy(model);
    free(mass);
    set_contacts(d, o);
}

/* Rigid contacts must not hold all of what the modes let move, unless they hold the structure itself. */
static void check_freedom(const struct damper *d)
{
    double *stuck = need_memory(d->modes, sizeof *stuck);
    if (d->modes < d->ndof && stuck_frequencies(d, stuck) == 0) {
        die("the contacts, if they stick, hold all that the %zu mode%s of the reduced structure let%s move: keep more --modes",
            d->modes, d->modes == 1 ? "" : "s", d->modes == 1 ? "s" : "");
    }
    free(stuck);
}

struct damper create_damper(const struct options *o, const struct structure *s, size_t kept)
{
    struct damper d = {.ndof = s->ndof,
                       .kept = kept,
                       .contacts = o->contacts.count,
                       .outputs = o->outputs,
                       .damping = o->damping,
                       .force = o->force,
                       .step = o->step,
                       .law = o->law};
    if (o->modes > s->ndof) {
        die("option --modes %zu: the structure has %zu degrees of freedom", o->modes, s->ndof);
    }
    const struct places rows = find_rows(o, s);
    d.limit = need_memory(d.contacts, sizeof *d.limit);
    d.mu = need_memory(d.contacts, sizeof *d.mu);
    d.stiffness = need_memory(d.contacts, sizeof *d.stiffness);
    reduce(&d, o, s, &rows);
    free(rows.at);
    d.dimension = 2 * d.modes + 1;
    for (size_t c = 0; c < d.contacts; c++) {
        d.limit[c] = o->contacts.contact[c].limit;
        d.mu[c] = o->contacts.contact[c].mu;
        d.stiffness[c] = o->contacts.contact[c].stiffness;
        d.dimension += d.stiffness[c] > 0.0;
    }
    check_freedom(&d);
    build(&d, o);
    d.load = need_memory(d.modes, sizeof *d.load);
    for (size_t k = 0; k < d.modes; k++) {
        d.load[k] = d.force * d.load_shape[k];
    }
    return d;
}

void free_damper(struct damper *d)
{
    tribo_system_destroy(d->reduced);
    tribo_system_destroy(d->sys);
    free(d->omega);
    free(d->load_shape);
    free(d->contact_shape);
    free(d->output_shape);
    free(d->load);
    free(d->limit);
    free(d->mu);
    free(d->stiffness);
}

double lowest_drive(const struct options *o, const struct damper *d)
{
    return o->drive.from > 0.0 ? o->drive.from : d->omega[0] / TURN;
}

double highest_drive(const struct options *o, const struct damper *d)
{
    return o->drive.from > 0.0 ? o->drive.to : d->omega[0] / TURN;
}

void check_drive(const struct damper *d, double hz)
{
    const double highest = d->omega[d->modes - 1];
    if (!(TURN * hz > 1e-6 * highest)) {
        die("the load's frequency, %g Hz, is next to nothing beside %g Hz of the highest mode kept; see --drive", hz,
            highest / TURN);
    }
    const struct scale s = free_scale(d, TURN * hz);
    if (isnan(s.amplitude)) {
        die("the load's frequency, %g Hz, is beyond what can be computed with; see --drive", hz);
    }
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
