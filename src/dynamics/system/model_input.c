/* SPDX-License-Identifier: BSD-3-Clause */
/* tribo_model: the matrices of a structure as set by the caller, and systems built from them. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model.h"

/* ---------------------------------------------------------------------------------------------------------------------- life */

int tribo_model_create(tribo_model **model, size_t ndof, size_t ncontact)
{
    if (!model) {
        return TRIBO_ERR_NULL;
    }
    if (ndof == 0 || ndof > (size_t)1 << 24 || ncontact > (size_t)1 << 24) {
        return TRIBO_ERR_SIZE;
    }
    tribo_model *m = calloc(1, sizeof *m + TRIBO_MESSAGE);
    if (!m) {
        return TRIBO_ERR_MEMORY;
    }
    *m = (tribo_model){ndof, ncontact, .message = (char *)(m + 1)};
    *model = m;
    return TRIBO_OK;
}

void tribo_model_destroy(tribo_model *model)
{
    if (model) {
        tribo_model_free(model);
        free(model->compliance);
        free(model->normal);
        free(model);
    }
}

const char *tribo_model_message(const tribo_model *model)
{
    return model ? model->message : "model is NULL";
}

int tribo_model_refuse(tribo_model *model, int status, const char *message)
{
    return model ? tribo_error(model->message, status, "%s", message ? message : "") : status;
}

size_t tribo_model_ndof(const tribo_model *model)
{
    return model ? model->ndof : 0;
}

size_t tribo_model_ncontact(const tribo_model *model)
{
    return model ? model->ncontact : 0;
}

/* ------------------------------------------------------------------------------------------------------------------- matrices */

enum which { MASS, DAMPING, STIFFNESS, DIRECTION };

/* A matrix `to` of the model; its name for messages; its number of rows. model NULL: all other members are empty. */
struct input {
    tribo_model *model;
    struct matrix *to;
    const char *name;
    size_t rows;
};

static struct input model_input_of(tribo_model *m, enum which which)
{
    static const char *const name[] = {"mass", "damping", "stiffness", "direction"};
    if (!m) {
        return (struct input){0};
    }
    struct matrix *const to[] = {&m->mass, &m->damping, &m->stiffness, &m->direction};
    return (struct input){m, to[which], name[which], which == DIRECTION ? m->ncontact : m->ndof};
}

/* Sets *in->to = a if all entries are finite. done: 0 if there was no memory for a. Returns a status. */
static int model_take(const struct input *in, struct matrix *a, int done)
{
    size_t i, j;
    double x, y;
    if (!done) {
        return tribo_model_no_memory(in->model);
    }
    if (tribo_matrix_flaw(a, 0, &i, &j, &x, &y)) {
        tribo_matrix_free(a);
        return tribo_error(in->model->message, TRIBO_ERR_NOT_FINITE, "%s[%zu][%zu] = %g is not finite", in->name, i, j, x);
    }
    tribo_matrix_free(in->to);
    *in->to = *a;
    return TRIBO_OK;
}

/* Returns TRIBO_ERR_NULL if the model is NULL, or numbers is NULL with count > 0. part: name of an array of the matrix, or "". */
static int check_input(const struct input *in, const void *numbers, const char *part, size_t count)
{
    if (!in->model) {
        return TRIBO_ERR_NULL;
    }
    return numbers || !count ? TRIBO_OK : tribo_error(in->model->message, TRIBO_ERR_NULL, "%s%s is NULL", in->name, part);
}

/* entries [rows][ndof], or, if diagonal = 1, [rows]. */
static int set_dense(tribo_model *model, enum which which, int diagonal, const double *entries)
{
    const struct input in = model_input_of(model, which);
    struct matrix a = {0};
    const int status = check_input(&in, entries, "", in.rows);
    if (status) {
        return status;
    }
    struct triplets t = {0};
    for (size_t i = 0; diagonal && i < in.rows; i++) {
        tribo_triplets_put(&t, i, i, entries[i]);
    }
    return model_take(&in, &a,
                      diagonal ? tribo_triplets_finish(&t, in.rows, in.rows, &a)
                               : tribo_matrix_from_dense(&a, in.rows, model->ndof, entries));
}

/* Returns an error if rowptr does not begin at 0 and ascend, or a column is too large. Checks all of rowptr before reading
 * col. */
static int check_csr(const struct input *in, const size_t *rowptr, const size_t *col)
{
    const tribo_model *m = in->model;
    if (rowptr[0] != 0) {
        return tribo_error(m->message, TRIBO_ERR_SIZE, "%s: rowptr[%zu] = %zu is not 0", in->name, (size_t)0, rowptr[0]);
    }
    for (size_t i = 1; i <= in->rows; i++) {
        if (rowptr[i] < rowptr[i - 1]) {
            return tribo_error(m->message, TRIBO_ERR_SIZE, "%s: rowptr[%zu] = %zu is below rowptr[%zu] = %zu", in->name, i,
                               rowptr[i], i - 1, rowptr[i - 1]);
        }
    }
    for (size_t i = 0; i < in->rows; i++) {
        for (size_t k = rowptr[i]; k < rowptr[i + 1]; k++) {
            if (col[k] >= m->ndof) {
                return tribo_error(m->message, TRIBO_ERR_RANGE, "%s: col[%zu] = %zu is not below %zu, the number of columns",
                                   in->name, k, col[k], m->ndof);
            }
        }
    }
    return TRIBO_OK;
}

static int set_csr(tribo_model *model, enum which which, const size_t *rowptr, const size_t *col, const double *val)
{
    const struct input in = model_input_of(model, which);
    struct matrix a = {0};
    int status = check_input(&in, rowptr, ": rowptr", 1);
    const size_t entries = !status && rowptr[0] == 0 ? rowptr[in.rows] : 0;
    status = status ? status : check_input(&in, col, ": col", entries);
    status = status ? status : check_input(&in, val, ": val", entries);
    status = status ? status : check_csr(&in, rowptr, col);
    if (status) {
        return status;
    }
    const struct matrix rows = {
        .rows = in.rows, .cols = model->ndof, .first = (size_t *)rowptr, .col = (size_t *)col, .val = (double *)val};
    struct matrix turned = {0}; /* a transposed matrix has ascending columns */
    struct triplets t = {0};    /* without entries that are 0, which would pass for bodies that a contact moves */
    int done = tribo_matrix_transpose(&turned, &rows) && tribo_matrix_transpose(&a, &turned), zeros = 0;
    tribo_matrix_free(&turned);
    for (size_t i = 0; done && i < in.rows; i++) {
        for (size_t k = a.first[i]; k < a.first[i + 1]; k++) {
            zeros |= a.val[k] == 0.0;
            if (k > a.first[i] && a.col[k] == a.col[k - 1]) {
                status = tribo_error(model->message, TRIBO_ERR_DUPLICATE, "%s[%zu][%zu] is given twice", in.name, i, a.col[k]);
            }
        }
    }
    for (size_t i = 0; !status && zeros && i < in.rows; i++) {
        tribo_triplets_put_row(&t, i, &a, i);
    }
    if (status || zeros) {
        tribo_matrix_free(&a);
    }
    if (!status && zeros) {
        done = tribo_triplets_finish(&t, in.rows, model->ndof, &a);
    }
    return status ? status : model_take(&in, &a, done);
}

/* Defines tribo_model_set_NAME and tribo_model_set_NAME_csr. */
#define SETTERS(name, which)                                                                                                     \
    int tribo_model_set_##name(tribo_model *model, const double *entries)                                                        \
    {                                                                                                                            \
        return set_dense(model, which, 0, entries);                                                                              \
    }                                                                                                                            \
    int tribo_model_set_##name##_csr(tribo_model *model, const size_t *rowptr, const size_t *col, const double *val)             \
    {                                                                                                                            \
        return set_csr(model, which, rowptr, col, val);                                                                          \
    }

/* Defines tribo_model_set_NAME_diagonal. */
#define DIAGONAL_SETTER(name, which)                                                                                             \
    int tribo_model_set_##name##_diagonal(tribo_model *model, const double *entries)                                             \
    {                                                                                                                            \
        return set_dense(model, which, 1, entries);                                                                              \
    }

SETTERS(mass, MASS)
SETTERS(damping, DAMPING)
SETTERS(stiffness, STIFFNESS)
SETTERS(direction, DIRECTION)
DIAGONAL_SETTER(mass, MASS)
DIAGONAL_SETTER(damping, DAMPING)
DIAGONAL_SETTER(stiffness, STIFFNESS)

int tribo_model_set_compliance(tribo_model *model, const double *c)
{
    const struct input in = {.model = model, .name = "compliance"};
    const size_t n = model ? model->ncontact : 0;
    int status = check_input(&in, c, "", n);
    status = status ? status : tribo_check_array(model->message, NOT_NEGATIVE, "compliance", c, n);
    for (size_t i = 0; !status && i < n; i++) {
        if (c[i] > 0.0 && !(c[i] > 1.0 / DBL_MAX)) {
            return tribo_error(model->message, TRIBO_ERR_RANGE,
                               "compliance[%zu] = %g is of a stiffness that overflows: 0 is a rigid contact", i, c[i]);
        }
    }
    double *copy = status ? NULL : malloc((n + 1) * sizeof *copy);
    if (!copy) {
        return status ? status : tribo_model_no_memory(model);
    }
    if (n) {
        memcpy(copy, c, n * sizeof *copy);
    }
    free(model->compliance);
    model->compliance = copy;
    return TRIBO_OK;
}

/* Returns an error if contact and row of `in` cannot be a contact and its normal beside the normals of the model. */
static int check_roles(const tribo_model *m, const struct normal_input *in)
{
    const size_t index[] = {in->contact, in->row};
    for (int k = 0; k < 2; k++) {
        if (index[k] >= m->ncontact) {
            return tribo_error(m->message, TRIBO_ERR_RANGE, "%s = %zu is not below %zu, the number of contacts",
                               k ? "normal" : "contact", index[k], m->ncontact);
        }
    }
    if (in->contact == in->row) {
        return tribo_error(m->message, TRIBO_ERR_RANGE, "contact %zu is to be its own normal", in->contact);
    }
    for (size_t k = 0; k < m->normals; k++) {
        const struct normal_input *o = m->normal + k;
        if (o->row == in->contact || o->contact == in->row) {
            const struct normal_input *normal = o->row == in->contact ? o : in;
            return tribo_error(m->message, TRIBO_ERR_RANGE,
                               "contact %zu is the normal of contact %zu, and takes no normal itself", normal->row,
                               normal->contact);
        }
        if (o->row == in->row && o->contact != in->contact && (o->stiffness != in->stiffness || o->gap != in->gap)) {
            const int gap = o->stiffness == in->stiffness;
            return tribo_error(
                m->message, TRIBO_ERR_RANGE, "%s = %.17g of contact %zu, but %.17g of contact %zu with the same normal",
                gap ? "gap" : "stiffness", gap ? in->gap : in->stiffness, in->contact, gap ? o->gap : o->stiffness, o->contact);
        }
    }
    return TRIBO_OK;
}

int tribo_model_set_normal(tribo_model *model, size_t contact, size_t normal, double mu, double stiffness, double gap)
{
    if (!model) {
        return TRIBO_ERR_NULL;
    }
    const struct normal_input in = {contact, normal, mu, stiffness, gap};
    int status = tribo_check_number(model->message, NOT_NEGATIVE, mu, "mu = %g of contact %zu", mu, contact);
    status =
        status ? status
               : tribo_check_number(model->message, NOT_NEGATIVE, stiffness, "stiffness = %g of contact %zu", stiffness, contact);
    status = status ? status : tribo_check_number(model->message, FINITE, gap, "gap = %g of contact %zu", gap, contact);
    status = status ? status : check_roles(model, &in);
    if (status) {
        return status;
    }
    size_t k = 0;
    while (k < model->normals && model->normal[k].contact != contact) {
        k++;
    }
    if (k == model->normals) {
        struct normal_input *more = realloc(model->normal, (k + 1) * sizeof *more);
        if (!more) {
            return tribo_model_no_memory(model);
        }
        model->normal = more;
        model->normals++;
    }
    model->normal[k] = in;
    return TRIBO_OK;
}

/* -------------------------------------------------------------------------------------------------------------------- systems */

/* Checks the model, and the arguments of tribo_system_reduce if reduces = 1; builds a system from copies of the model's matrices.
 * Returns a status. */
static int build_system(tribo_system **sys, const tribo_model *m, int reduces, size_t nmode, int statics)
{
    if (!m) {
        return TRIBO_ERR_NULL;
    }
    const char *missing = !m->mass.first                       ? "mass"
                          : !m->stiffness.first                ? "stiffness"
                          : !m->direction.first && m->ncontact ? "direction"
                                                               : NULL;
    if (!sys) {
        return tribo_error(m->message, TRIBO_ERR_NULL, "sys is NULL");
    }
    if (missing) {
        return tribo_error(m->message, TRIBO_ERR_STATE, "%s has not been set: call tribo_model_set_%s", missing, missing);
    }
    if (reduces && nmode == 0) {
        return tribo_error(m->message, TRIBO_ERR_SIZE, "nmode = 0: a reduced system has a mode at least");
    }
    if (nmode > m->ndof) {
        return tribo_error(m->message, TRIBO_ERR_SIZE, "nmode = %zu is more than the %zu degree%s of freedom", nmode, m->ndof,
                           plural(m->ndof));
    }
    if (statics < TRIBO_STATICS_NONE || statics > TRIBO_STATICS_COMPLIANCE) {
        return tribo_error(m->message, TRIBO_ERR_RANGE, "static_contacts = %d is not TRIBO_STATICS_...", statics);
    }
    if (m->damping.first && statics == TRIBO_STATICS_COMPLIANCE) {
        return tribo_error(m->message, TRIBO_ERR_UNSUPPORTED,
                           "TRIBO_STATICS_COMPLIANCE takes no damping matrix: call tribo_system_set_damping_ratio, or take "
                           "TRIBO_STATICS_MASS");
    }
    tribo_model copy = *m;
    copy.mass = copy.damping = copy.stiffness = copy.direction = (struct matrix){0};
    copy.nmode = nmode;
    copy.attachments = statics == TRIBO_STATICS_MASS;
    copy.flexible = statics == TRIBO_STATICS_COMPLIANCE;
    const int done = tribo_matrix_copy(&copy.mass, &m->mass) && tribo_matrix_copy(&copy.damping, &m->damping) &&
                     tribo_matrix_copy(&copy.stiffness, &m->stiffness) &&
                     (m->direction.first ? tribo_matrix_copy(&copy.direction, &m->direction)
                                         : tribo_matrix_from_dense(&copy.direction, 0, m->ndof, NULL));
    if (!done) {
        tribo_model_free(&copy);
        return tribo_model_no_memory(m);
    }
    return tribo_model_build(&copy, sys);
}

int tribo_system_create(tribo_system **sys, tribo_model *model)
{
    return build_system(sys, model, 0, 0, TRIBO_STATICS_NONE);
}

int tribo_system_reduce(tribo_system **sys, tribo_model *model, size_t nmode, int static_contacts)
{
    return build_system(sys, model, 1, nmode, static_contacts);
}

/* -------------------------------------------------------------------------------------------------------------------- rings */

/* to [sectors rows][sectors columns] = the sum of the matrix a of all sectors, each `rows` and `columns` after the one before;
 * what is beyond the last sector belongs to the first. a is at most twice as large. Returns 1, or 0 if out of memory. */
static int repeat_around(const struct matrix *a, size_t sectors, size_t rows, size_t columns, struct matrix *to)
{
    struct triplets all = {0};
    double *sum = calloc(sectors * columns + 1, sizeof *sum);
    for (size_t row = 0; sum && row < sectors * rows; row++) {
        for (size_t pass = 0; pass < 4; pass++) { /* add up the row of its sector and of the one before, then take them out */
            const size_t i = row % rows + pass % 2 * rows, s = row / rows + pass % 2 * (sectors - 1);
            for (size_t k = i < a->rows ? a->first[i] : 0; i < a->rows && k < a->first[i + 1]; k++) {
                const size_t at = (s * columns + a->col[k]) % (sectors * columns);
                if (pass < 2) {
                    sum[at] += a->val[k];
                } else {
                    tribo_triplets_put(&all, row, at, sum[at]);
                    sum[at] = 0.0;
                }
            }
        }
    }
    all.failed |= !sum;
    free(sum);
    return tribo_triplets_finish(&all, sectors * rows, sectors * columns, to);
}

int tribo_model_set_ring(tribo_model *model, tribo_model *sector, size_t sectors)
{
    if (!model) {
        return TRIBO_ERR_NULL;
    }
    if (!sector || sector == model) {
        return tribo_error(model->message, TRIBO_ERR_NULL, "sector is NULL, or the model itself");
    }
    const size_t own = sectors ? model->ndof / sectors : 0, each = sector->ncontact;
    if (!own || model->ndof % sectors || model->ncontact != sectors * each || sector->ndof < own || sector->ndof > 2 * own) {
        return tribo_error(model->message, TRIBO_ERR_SIZE,
                           "%zu degree%s of freedom and %zu contact%s are not those of a ring of this sector, sectors = %zu",
                           model->ndof, plural(model->ndof), model->ncontact, plural(model->ncontact), sectors);
    }
    int status = TRIBO_OK;
    for (int which = MASS; !status && which <= DIRECTION; which++) {
        const struct input in = model_input_of(model, (enum which)which), from = model_input_of(sector, (enum which)which);
        struct matrix a = {0};
        if (from.to->first) {
            const int done = repeat_around(from.to, sectors, which == DIRECTION ? each : own, own, &a);
            status = model_take(&in, &a, done);
        } else if (which != DAMPING && from.rows) {
            status = tribo_error(model->message, TRIBO_ERR_STATE, "%s of the sector has not been set", in.name);
        } else {
            tribo_matrix_free(in.to);
        }
    }
    free(status ? NULL : model->compliance);
    model->compliance = status ? model->compliance : NULL;
    model->normals = status ? model->normals : 0;
    double *c = !status && sector->compliance ? malloc((model->ncontact + 1) * sizeof *c) : NULL;
    for (size_t i = 0; c && i < model->ncontact; i++) {
        c[i] = sector->compliance[i % each];
    }
    status = c ? tribo_model_set_compliance(model, c) : !status && sector->compliance ? tribo_model_no_memory(model) : status;
    for (size_t k = 0; !status && k < sectors * sector->normals; k++) {
        const struct normal_input *n = sector->normal + k % sector->normals;
        const size_t first = k / sector->normals * each;
        status = tribo_model_set_normal(model, first + n->contact, first + n->row, n->mu, n->stiffness, n->gap);
    }
    free(c);
    return status;
}
