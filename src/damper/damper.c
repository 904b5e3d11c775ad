/* SPDX-License-Identifier: BSD-3-Clause */
#include "damper.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"

/* ------------------------------------------------------------------------------------------------------------- loads */

/* The mass of a row that moves along a direction with the supports. */
static double mass_along(const struct structure *s, size_t row, int direction)
{
    double mass = 0.0;
    for (size_t k = s->mass.first[row]; k < s->mass.first[row + 1]; k++) {
        mass += s->dof[s->mass.col[k]].direction == direction ? s->mass.val[k] : 0.0;
    }
    return mass;
}

void complete_options(struct options *o, const struct structure *s)
{
    static const double LIMIT_FROM = 1e-3, LIMIT_TO = 10.0; /* times the size of the loads */
    for (size_t k = 0; k < o->loads.count; k++) {
        struct load *l = &o->loads.load[k];
        double mass = l->supports ? 0.0 : 1.0;
        for (size_t i = 0; l->supports && i < s->ndof; i++) {
            mass += s->dof[i].direction == l->at.direction ? mass_along(s, i, l->at.direction) : 0.0;
        }
        l->size = isnan(l->size) ? o->force : l->size;
        o->size += l->size * mass;
    }
    if (!o->contacts.vary) {
        o->limits = (struct range){1.0, 1.0, 1};
    } else if (!o->limits.points) {
        o->limits = (struct range){LIMIT_FROM * o->size, LIMIT_TO * o->size, o->drive.points > 1 ? 9 : 33};
    }
    for (size_t c = 0; c < o->contacts.count; c++) {
        const struct contact *contact = &o->contacts.contact[c];
        const char *origin = contact->at.origin;
        die_if(!isfinite(isnan(contact->limit) ? contact->mu * o->limits.to : contact->limit),
               "%s: mu times the normal load, up to %g, is too large a limit", origin, o->limits.to);
        die_if(contact->stiffness > 0.0 && (o->march || o->check) && o->law != TRIBO_COULOMB,
               "%s: with --law %s marching takes rigid contacts only: leave out stiffness=, or --law", origin,
               tribo_law_name(o->law));
        die_if(contact->directions == 2 && contact->normal.direction && !o->march,
               "%s: a contact in a plane with normal= is for --method march: periodic motions are found of such contacts along "
               "one axis only",
               origin);
    }
    add_normals(&o->contacts);
}

/* Rows over the degrees of freedom [ndof]: directions of contacts, normal directions, then loads of size 1, then outputs, then
 * the place where amplitudes are measured. A load of the supports is -M r with r the direction, which is 1 along it. */
static struct sparse make_rows(const struct options *o, const struct structure *s)
{
    const size_t contacts = o->contacts.count + o->contacts.normals, loads = o->loads.count,
                 rows = contacts + loads + o->outputs.count + 1;
    struct sparse j = {.rows = rows, .first = need_memory(rows + 1, sizeof *j.first)};
    const size_t most = 2 * rows + loads * s->ndof;
    size_t count = 0;
    j.col = need_memory(most, sizeof *j.col);
    j.val = need_memory(most, sizeof *j.val);
    for (size_t r = 0; r < rows; r++) {
        const struct contact *contact = r < contacts ? &o->contacts.contact[r] : NULL;
        const struct load *load = r >= contacts && r < contacts + loads ? &o->loads.load[r - contacts] : NULL;
        const size_t output = r - contacts - loads;
        const double sign = contact && r >= o->contacts.count && contact->normal.direction < 0 ? -1.0 : 1.0;
        if (load && load->supports) {
            for (size_t i = 0; i < s->ndof; i++) {
                j.col[count] = i;
                j.val[count] = -mass_along(s, i, load->at.direction);
                count += j.val[count] != 0.0;
            }
        } else {
            const struct place *at = contact        ? &contact->at
                                     : load         ? &load->at
                                     : r + 1 < rows ? &o->outputs.place[output]
                                                    : measured_place(o);
            j.col[count] = find_degree(s, at);
            j.val[count++] = sign;
        }
        if (contact && contact->between) {
            j.col[count] = find_degree(s, &contact->to);
            j.val[count++] = -sign;
            die_if(j.col[count - 1] == j.col[count - 2], "%s: both ends are the same node", contact->at.origin);
        }
        j.first[r + 1] = count;
    }
    return j;
}

/* A displacement of a place below this part of that of its strongest mode is rounding: of a contact, it would be a body of
 * enormous mass. */
static const double UNMOVED = 1e-8;

static double row_product(const struct sparse *m, size_t row, const double *x)
{
    double sum = 0.0;
    for (size_t k = m->first[row]; k < m->first[row + 1]; k++) {
        sum += m->val[k] * x[m->col[k]];
    }
    return sum;
}

/* An entry of the modal damping matrix below this part of the largest sum of its terms is rounding. */
static const double UNDAMPED = 1e-13;

/* Modal damping: of ratios, or Phi' C Phi. */
static void put_damping(struct damper *d, const struct structure *s, const double *full)
{
    const struct options *o = d->options;
    double *c = d->open.damping, *force = need_memory(d->ndof, sizeof *force);
    for (size_t k = 0; k < d->modes; k++) {
        const size_t last = o->damping.count ? o->damping.count - 1 : 0;
        for (size_t i = 0; o->damping_matrix && i < d->ndof; i++) {
            force[i] = row_product(&s->damping, i, full + k * d->ndof);
        }
        for (size_t j = 0; o->damping_matrix && j < d->modes; j++) {
            double sum = 0.0, terms = 0.0;
            for (size_t i = 0; i < d->ndof; i++) {
                sum += full[j * d->ndof + i] * force[i];
                terms += fabs(full[j * d->ndof + i] * force[i]);
            }
            c[j * d->modes + k] = fabs(sum) > UNDAMPED * terms ? sum : 0.0;
        }
        if (!o->damping_matrix) {
            c[k * d->modes + k] = 2.0 * o->damping.value[k < last ? k : last] * d->open.omega[k];
        }
    }
    find_coupling(&d->open);
    free(force);
}

/* Finds the modes; and contacts, loads, outputs and damping in them. */
static void reduce(struct damper *d, const struct structure *s)
{
    const struct options *o = d->options;
    /* with statics the loads are contacts, too: their static responses are needed as those of contacts */
    const size_t loads = o->loads.count, directions = d->rows + (o->statics ? loads : 0);
    struct sparse rows = make_rows(o, s);
    tribo_model *model = NULL;
    need(tribo_model_create(&model, s->ndof, directions), NULL);
    need(tribo_model_set_mass_csr(model, s->mass.first, s->mass.col, s->mass.val), tribo_model_message(model));
    need(tribo_model_set_stiffness_csr(model, s->stiffness.first, s->stiffness.col, s->stiffness.val),
         tribo_model_message(model));
    need(tribo_model_set_direction_csr(model, rows.first, rows.col, rows.val), tribo_model_message(model));
    if (tribo_system_reduce(&d->reduced, model, d->kept, o->statics ? TRIBO_STATICS_MASS : TRIBO_STATICS_NONE)) {
        const char *message = tribo_model_message(model);
        const int counts = strchr(message, '[') || strstr(message, "degree of freedom ");
        die("%s and %s: %s%s", o->mass, o->stiffness, message, counts ? " (counted from 0)" : "");
    }
    tribo_model_destroy(model);
    const size_t n = d->modes = tribo_system_ndof(d->reduced);
    double *unit = need_memory(n, sizeof *unit), *full = need_memory(n * d->ndof, sizeof *full);
    double *shape = need_memory(rows.rows * n, sizeof *shape);
    d->open = create_linear(n);
    d->contact_shape = shape;
    d->output_shape = shape + (d->rows + loads) * n;
    need(tribo_system_get_frequencies(d->reduced, d->open.omega), tribo_system_message(d->reduced));
    for (size_t k = 0; k < n; k++) {
        unit[k] = 1.0;
        need(tribo_system_expand(d->reduced, unit, full + k * d->ndof), NULL);
        unit[k] = 0.0;
        for (size_t r = 0; r < rows.rows; r++) {
            shape[r * n + k] = row_product(&rows, r, full + k * d->ndof);
        }
        d->open.measured[k] = d->output_shape[o->outputs.count * n + k];
    }
    for (size_t i = 0; i < loads * n; i++) {
        const struct load *load = &o->loads.load[i / n];
        const double force = load->size * shape[d->rows * n + i], phase = TURN / 360.0 * load->phase;
        d->open.cosine[i % n] += phase != 0.0 ? force * sin(phase) : 0.0;
        d->open.sine[i % n] += phase != 0.0 ? force * cos(phase) : force;
    }
    for (size_t c = 0; c < d->rows; c++, shape += n) {
        double most = 0.0;
        for (size_t k = 0; k < n; k++) {
            most = fmax(most, fabs(shape[k]));
        }
        for (size_t k = 0; k < n; k++) {
            shape[k] = fabs(shape[k]) < UNMOVED * most ? 0.0 : shape[k];
        }
    }
    put_damping(d, s, full);
    free_sparse(&rows);
    free(unit);
    free(full);
}

/* The largest stiffness of a spring, times that of the lowest elastic mode: below, that mode's frequency keeps digits. */
static const double MOST_STIFF = 1e9;

static void check_spring(const struct damper *d, size_t c)
{
    const double stiffness = d->contact[c].stiffness;
    double lowest = HUGE_VAL, spring = 0.0;
    for (size_t k = 0; k < d->modes; k++) {
        const double shape = d->contact_shape[c * d->modes + k];
        spring += stiffness * shape * shape;
        lowest = d->open.omega[k] > LOOSE * d->open.omega[d->modes - 1] ? fmin(lowest, d->open.omega[k]) : lowest;
    }
    die_if(!(spring <= MOST_STIFF * lowest * lowest), "%s: stiffness=%g is more than %g times that of the structure there%s",
           d->contact[c].at.origin, stiffness, MOST_STIFF,
           c < d->contacts ? ": leave it out for a rigid contact" : "; that of normal=");
}

double rest_load(const struct contact *c, double limit)
{
    return !isnan(c->normal.gap) ? 0.0 : isnan(c->normal.load) ? limit : c->normal.load;
}

tribo_system *create_system(const struct damper *d, double limit)
{
    const size_t n = d->modes;
    double *mass = need_memory(3 * n + 3 * d->rows, sizeof *mass), *ratio = mass + 3 * n + 2 * d->rows;
    double *stiffness = mass + n, *damping = stiffness + n, *compliance = damping + n, *belt = compliance + d->rows;
    size_t *first = need_memory(d->contacts, sizeof *first), planar = 0, row = d->contacts, moves = 0;
    tribo_model *model = NULL;
    tribo_system *sys = NULL;
    for (size_t k = 0; k < n; k++) {
        mass[k] = 1.0;
        stiffness[k] = d->open.omega[k] * d->open.omega[k];
        damping[k] = d->open.damping[k * (n + 1)];
    }
    for (size_t c = 0; c < d->rows; c++) {
        belt[c] = d->contact[c].belt;
        ratio[c] = d->contact[c].ratio;
        moves += belt[c] != 0.0;
        if (c < d->contacts && d->contact[c].stiffness > 0.0) {
            compliance[c] = 1.0 / d->contact[c].stiffness;
        }
        if (d->contact[c].directions == 2) {
            first[planar++] = c;
        }
    }
    need(tribo_model_create(&model, n, d->rows), NULL);
    need(tribo_model_set_mass_diagonal(model, mass), tribo_model_message(model));
    need(tribo_model_set_stiffness_diagonal(model, stiffness), tribo_model_message(model));
    need(d->open.coupled ? tribo_model_set_damping(model, d->open.damping) : tribo_model_set_damping_diagonal(model, damping),
         tribo_model_message(model));
    need(tribo_model_set_direction(model, d->contact_shape), tribo_model_message(model));
    need(tribo_model_set_compliance(model, compliance), tribo_model_message(model));
    for (size_t c = 0; c < d->contacts; c++) {
        const struct contact *contact = &d->contact[c];
        if (contact->directions && contact->normal.direction) {
            const struct normal *to = &contact->normal;
            const double gap = isnan(to->gap) ? -rest_load(contact, limit) / to->stiffness : to->gap;
            need(tribo_model_set_normal(model, c, row++, contact->mu, to->stiffness, gap), tribo_model_message(model));
        }
    }
    die_if(tribo_system_create(&sys, model), "modes and springs: %s", tribo_model_message(model));
    tribo_context *context = tribo_system_context(sys);
    need(tribo_set_law(context, d->law), tribo_message(context));
    need(tribo_set_planar(context, planar, first), tribo_message(context));
    need(tribo_set_static(context, ratio, NULL), tribo_message(context));
    need(moves ? tribo_system_add_base_motion(sys, 0.0, belt, NULL) : TRIBO_OK, tribo_system_message(sys));
    tribo_model_destroy(model);
    free(mass);
    free(first);
    return sys;
}

/* The frequency, rad/time, of the mode of --backbone: with all contacts stuck, or without friction where such modes are fewer. Ends
 * the program if the mode does not move the place where amplitudes are measured. */
static double find_mode(const struct damper *d, size_t mode)
{
    const struct linear *l = mode <= d->stuck.count ? &d->stuck : &d->open;
    double most = 0.0;
    for (size_t k = 0; k < l->count; k++) {
        most = fmax(most, fabs(l->measured[k]));
    }
    die_if(!(fabs(l->measured[mode - 1]) > UNMOVED * most),
           "option --backbone %zu: the mode does not move the place where amplitudes are measured, %s", mode,
           measured_place(d->options)->origin);
    return l->omega[mode - 1];
}

struct damper create_damper(const struct options *o, const struct structure *s, size_t kept)
{
    struct damper d = {.options = o,
                       .ndof = s->ndof,
                       .kept = kept,
                       .contacts = o->contacts.count,
                       .rows = o->contacts.count + o->contacts.normals,
                       .contact = o->contacts.contact,
                       .law = o->law};
    die_if(o->modes > s->ndof, "option --modes %zu: the structure has %zu degrees of freedom", o->modes, s->ndof);
    reduce(&d, s);
    die_if(o->backbone > d.kept, "option --backbone %zu: the model keeps %zu mode%s: take more --modes", o->backbone, d.kept,
           d.kept == 1 ? "" : "s");
    d.lowest = o->drive.from > 0.0 ? o->drive.from : d.open.omega[o->backbone ? o->backbone - 1 : 0] / TURN;
    d.highest = o->drive.from > 0.0 ? o->drive.to : d.lowest;
    d.stuck = stick(&d.open, d.contact, d.rows, d.contact_shape);
    d.backbone = o->backbone ? find_mode(&d, o->backbone) : 0.0;
    /* rigid contacts must not hold all motions of the modes, unless they hold the structure itself */
    die_if(d.modes < d.ndof && d.stuck.count == 0,
           "the contacts, if they stick, hold all that the %zu mode%s of the reduced structure let%s move: keep more --modes",
           d.modes, d.modes == 1 ? "" : "s", d.modes == 1 ? "s" : "");
    for (size_t c = 0; c < d.rows; c++) {
        if (d.contact[c].stiffness > 0.0) {
            check_spring(&d, c);
        }
        d.in_plane |= d.contact[c].directions == 2;
        d.marched |= d.contact[c].directions == 2 && d.contact[c].normal.direction;
    }
    d.sys = create_system(&d, o->limits.from);
    d.dimension = tribo_system_dimension(d.sys);
    d.output = 1 + 2 * (o->harmonics ? o->harmonics : 1);
    d.record = d.dimension + 3 * d.contacts + d.output * o->outputs.count;
    return d;
}

void free_damper(struct damper *d)
{
    tribo_system_destroy(d->reduced);
    tribo_system_destroy(d->sys);
    free_linear(&d->open);
    free_linear(&d->stuck);
    free(d->contact_shape);
}

void check_drive(const struct damper *d, double hz)
{
    const double highest = d->open.omega[d->modes - 1];
    die_if(!(TURN * hz > LOOSE * highest),
           "the load's frequency, %g Hz, is next to nothing beside %g Hz of the highest mode kept; see --drive", hz,
           highest / TURN);
    const struct scale s = scale_of(&d->open, TURN * hz);
    die_if(isnan(s.amplitude), "the load's frequency, %g Hz, is beyond what can be computed with; see --drive", hz);
    die_if(!isnormal(s.amplitude * s.amplitude) || !isnormal(s.power * s.power) || !isnormal(NOTHING * s.norm * s.norm),
           "without friction the load makes an amplitude of %g: nothing to compute with; see --load, --base, --force, "
           "--output and --modes",
           s.amplitude);
}
