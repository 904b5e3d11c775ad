#include "constraint.h"
#include "common/layout.h"
#include "common/real.h"
#include "common/simd.h"
#include "common/zeros.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An entry that is so much smaller than what it is the sum of is rounding. */
#define ROUNDING (16.0 * DBL_EPSILON)

/* What has no mass follows before all others: as if its root were so small beside the lightest. */
#define MASSLESS 1e-8

/* What the constraints are made from. */
struct source {
    const struct matrix *direction, *mass;
    const size_t *row;
    size_t count;
    const unsigned char *last;
    size_t *parent; /* [cols] degrees of freedom that rows join form trees */
    size_t *place;  /* [cols] where a degree of freedom is listed in its tie, plus 1 */
    size_t *member; /* [count] the tie of a row */
    size_t *number; /* [cols] of a tie, plus 1, at the root of its tree */
};

/* Gaussian elimination in a tie: what is a pivot moves to the first rows and columns that have none. */
struct elimination {
    struct tie *tie; /* its entries: what is left; multipliers in columns of pivots */
    const unsigned char *last;
    double *size;   /* [rows][touched] what an entry is the sum of */
    double *weight; /* [touched] 1/sqrt(mass) */
    double *scale;  /* [rows] 1/largest weighted entry */
    double *most;   /* [rows] the largest weighted entry of a row beside the pivots; 0 if there is none */
    double *found;  /* [touched] workspace */
    double zero;    /* an entry so much smaller than its size counts as none */
};

void tribo_constraints_free(struct constraints *c)
{
    free(c->memory[0]);
    free(c->memory[1]);
    memset(c, 0, sizeof *c);
}

/* ------------------------------------------------------------------------------------------------------------ the ties */

static size_t root_of(const struct source *s, size_t dof)
{
    while (s->parent[dof] != dof) {
        dof = s->parent[dof] = s->parent[s->parent[dof]];
    }
    return dof;
}

/* First entry of a row of the list that is not zero; where the row ends if there is none. */
static size_t first_entry(const struct source *s, size_t p)
{
    const struct matrix *j = s->direction;
    size_t k = j->first[s->row[p]];
    while (k < j->first[s->row[p] + 1] && j->val[k] == 0.0) {
        k++;
    }
    return k;
}

/* Joins the degrees of freedom of every row. */
static void join(const struct source *s)
{
    const struct matrix *j = s->direction;
    for (size_t d = 0; d < j->cols; d++) {
        s->parent[d] = d;
    }
    for (size_t p = 0; p < s->count; p++) {
        const size_t first = first_entry(s, p);
        for (size_t k = first; k < j->first[s->row[p] + 1]; k++) {
            if (j->val[k] != 0.0) {
                s->parent[root_of(s, j->col[k])] = root_of(s, j->col[first]);
            }
        }
    }
}

/* Numbers the ties, and counts their rows and degrees of freedom. A row without entries is a tie of its own. */
static void count_ties(const struct source *s, struct constraints *c)
{
    const struct matrix *j = s->direction;
    for (size_t p = 0; p < s->count; p++) {
        const size_t first = first_entry(s, p), end = j->first[s->row[p] + 1];
        size_t *number = first < end ? &s->number[root_of(s, j->col[first])] : NULL;
        s->member[p] = number && *number ? *number - 1 : c->ties++;
        if (number) {
            *number = s->member[p] + 1;
        }
        struct tie *tie = &c->tie[s->member[p]];
        tie->rows++;
        for (size_t k = first; k < end; k++) {
            if (j->val[k] != 0.0 && s->place[j->col[k]] == 0) {
                s->place[j->col[k]] = ++tie->touched;
            }
        }
    }
}

/* Lists the rows and degrees of freedom of the ties. */
static void list_ties(const struct source *s, struct constraints *c)
{
    const struct matrix *j = s->direction;
    for (size_t k = 0; k < c->ties; k++) {
        c->tie[k].rows = 0;
    }
    for (size_t p = 0; p < s->count; p++) {
        struct tie *tie = &c->tie[s->member[p]];
        tie->order[tie->rows++] = p;
        for (size_t k = j->first[s->row[p]]; k < j->first[s->row[p] + 1]; k++) {
            if (j->val[k] != 0.0) {
                tie->dof[s->place[j->col[k]] - 1] = j->col[k];
            }
        }
    }
}

/* --------------------------------------------------------------------------------------------------------- elimination */

/* The weighted entry of row i in a column, 0 if it counts as none. */
static inline double weighted(const struct elimination *e, size_t i, size_t column)
{
    const size_t at = i * e->tie->touched + column;
    const double x = fabs(e->tie->entry[at]), y = x * e->weight[column];
    return x > e->zero * e->size[at] ? y : 0.0;
}

/* The largest weighted entry of row i from the column of the next pivot on: halves are laid upon each other until one is left. */
TRIBO_SIMD static double find_most(const struct elimination *e, size_t i)
{
    const size_t first = e->tie->rank;
    double *found = e->found;
    size_t left = e->tie->touched - first;
    for (size_t l = 0; l < left; l++) {
        found[l] = weighted(e, i, first + l);
    }
    for (size_t half = left / 2; half > 0; half = left / 2) {
        const double *other = found + (left - half);
        for (size_t l = 0; l < half; l++) {
            found[l] = greater(found[l], other[l]);
        }
        left -= half;
    }
    return left ? found[0] : 0.0;
}

/* When row i must wait for others. */
static unsigned char last_of(const struct elimination *e, size_t i)
{
    return e->last ? e->last[e->tie->order[i]] : 0;
}

/* The row with the next pivot; as many as there are rows if there is none. */
static size_t find_pivot(const struct elimination *e)
{
    const struct tie *tie = e->tie;
    size_t found = tie->rows;
    double most = 0.0;
    for (size_t i = tie->rank; i < tie->rows; i++) {
        const double pivot = e->scale[i] * e->most[i];
        const int wait = found < tie->rows ? last_of(e, i) - last_of(e, found) : 0;
        if (e->most[i] > 0.0 && (found == tie->rows || wait < 0 || (wait == 0 && pivot > most))) {
            found = i;
            most = pivot;
        }
    }
    return found;
}

static void exchange_values(double *x, double *y)
{
    const double z = *x;
    *x = *y;
    *y = z;
}

static void exchange_indices(size_t *list, size_t i, size_t k)
{
    const size_t x = list[i];
    list[i] = list[k];
    list[k] = x;
}

/* Brings the pivot of row i to where the next one belongs. */
static void bring(const struct elimination *e, size_t i)
{
    const struct tie *tie = e->tie;
    const size_t t = tie->touched, to = tie->rank;
    size_t column = to;
    while (!(weighted(e, i, column) >= e->most[i])) {
        column++;
    }
    for (size_t l = 0; l < t; l++) {
        exchange_values(&tie->entry[to * t + l], &tie->entry[i * t + l]);
        exchange_values(&e->size[to * t + l], &e->size[i * t + l]);
    }
    for (size_t p = 0; p < tie->rows; p++) {
        exchange_values(&tie->entry[p * t + to], &tie->entry[p * t + column]);
        exchange_values(&e->size[p * t + to], &e->size[p * t + column]);
    }
    exchange_values(&e->weight[to], &e->weight[column]);
    exchange_values(&e->scale[to], &e->scale[i]);
    exchange_values(&e->most[to], &e->most[i]);
    exchange_indices(tie->order, to, i);
    exchange_indices(tie->dof, to, column);
}

/* row -= factor from, entries first to end - 1. */
TRIBO_SIMD static void eliminate(double *restrict row, double *restrict size, const double *restrict from, double factor,
                                 size_t first, size_t end)
{
    for (size_t l = first; l < end; l++) {
        const double part = factor * from[l], left = row[l] - part;
        size[l] += fabs(part);
        row[l] = fabs(left) > ROUNDING * size[l] ? left : 0.0;
    }
}

static void eliminate_all(struct elimination *e)
{
    struct tie *tie = e->tie;
    const size_t t = tie->touched;
    for (size_t i = 0; i < tie->rows; i++) {
        e->most[i] = find_most(e, i);
    }
    for (size_t p = find_pivot(e); p < tie->rows; p = find_pivot(e)) {
        bring(e, p);
        const size_t done = tie->rank++;
        const double *from = tie->entry + done * t;
        for (size_t i = tie->rank; i < tie->rows; i++) {
            double *row = tie->entry + i * t, *size = e->size + i * t;
            if (row[done] != 0.0) {
                row[done] /= from[done];
                eliminate(row, size, from, row[done], tie->rank, t);
                e->most[i] = find_most(e, i);
            }
        }
    }
}

/* U^-1 from the left to what independent rows have beside the slaves. size [touched] */
static void solve_rest(const struct tie *tie, double *size)
{
    const size_t t = tie->touched, s = tie->rank;
    for (size_t p = s; p-- > 0;) {
        double *row = tie->entry + p * t;
        for (size_t l = s; l < t; l++) {
            size[l] = fabs(row[l]);
        }
        for (size_t q = p + 1; q < s; q++) {
            for (size_t l = s; row[q] != 0.0 && l < t; l++) {
                const double term = row[q] * tie->entry[q * t + l];
                row[l] -= term;
                size[l] += fabs(term);
            }
        }
        for (size_t l = s; l < t; l++) {
            row[l] = fabs(row[l]) > ROUNDING * size[l] ? row[l] / row[p] : 0.0;
        }
    }
}

/* Begins with a tie: its entries, and what goes with them. */
static void fill(struct elimination *e, const struct source *s)
{
    const struct tie *tie = e->tie;
    const struct matrix *j = s->direction;
    const size_t t = tie->touched;
    double lightest = DBL_MIN;
    memset(tie->entry, 0, tie->rows * t * sizeof *tie->entry);
    memset(e->size, 0, tie->rows * t * sizeof *e->size);
    for (size_t l = 0; l < t; l++) {
        const double mass = s->mass->rows ? tribo_matrix_get(s->mass, tie->dof[l], tie->dof[l]) : 1.0;
        e->weight[l] = mass > 0.0 ? 1.0 / sqrt(mass) : 0.0;
        lightest = greater(lightest, e->weight[l]);
    }
    for (size_t l = 0; l < t; l++) {
        e->weight[l] = e->weight[l] > 0.0 ? e->weight[l] : lightest / MASSLESS;
    }
    for (size_t p = 0; p < tie->rows; p++) {
        const size_t row = s->row[tie->order[p]];
        double most = 0.0;
        for (size_t k = j->first[row]; k < j->first[row + 1]; k++) {
            if (j->val[k] != 0.0) {
                const size_t l = s->place[j->col[k]] - 1;
                tie->entry[p * t + l] = j->val[k];
                e->size[p * t + l] = fabs(j->val[k]);
                most = greater(most, e->size[p * t + l] * e->weight[l]);
            }
        }
        e->scale[p] = most > 0.0 ? 1.0 / most : 0.0; /* a row of zeros has no pivot */
    }
}

static void eliminate_ties(const struct source *s, struct constraints *c, struct elimination *e)
{
    for (size_t k = 0; k < c->ties; k++) {
        struct tie *tie = &c->tie[k];
        e->tie = tie;
        e->zero = s->last ? sqrt(4.0 * (double)(tie->rows + 4) * DBL_EPSILON) : ROUNDING;
        fill(e, s);
        eliminate_all(e);
        if (!s->last) {
            solve_rest(tie, e->weight);
        }
        c->rank += tie->rank;
    }
}

/* Lists the independent rows of all ties, and then the others. */
static void list_order(struct constraints *c)
{
    size_t independent = 0, other = c->rank;
    for (size_t k = 0; k < c->ties; k++) {
        for (size_t p = 0; p < c->tie[k].rows; p++) {
            c->order[p < c->tie[k].rank ? independent++ : other++] = c->tie[k].order[p];
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------- memory */

static void lay_out_constraints(struct source *s, struct constraints *c, struct layout *l)
{
    const size_t n = s->direction->cols;
    c->memory[0] = tribo_layout_array(l, 0, 1);
    c->tie = tribo_layout_array(l, s->count, sizeof *c->tie);
    c->work = tribo_layout_array(l, s->count, sizeof *c->work);
    c->order = tribo_layout_array(l, 2 * s->count + 3 * n, sizeof *c->order);
    if (c->order) {
        s->member = c->order + s->count;
        s->parent = s->member + s->count;
        s->place = s->parent + n;
        s->number = s->place + n;
    }
}

static int create_constraints(struct source *s, struct constraints *c)
{
    struct layout l = {0};
    lay_out_constraints(s, c, &l);
    const int done = tribo_layout_zeros(&l);
    if (done) {
        lay_out_constraints(s, c, &l);
    }
    return done;
}

/* The ties' arrays, and workspace for the largest of them. */
static void lay_out_ties(struct constraints *c, struct elimination *e, struct layout *l)
{
    size_t rows = 0, touched = 0, area = 0;
    c->memory[1] = tribo_layout_array(l, 0, 1);
    for (struct tie *tie = c->tie; tie < c->tie + c->ties; tie++) {
        tie->order = tribo_layout_array(l, tie->rows, sizeof *tie->order);
        tie->dof = tribo_layout_array(l, tie->touched, sizeof *tie->dof);
        tie->entry = tribo_layout_array(l, tie->rows * tie->touched, sizeof *tie->entry);
        rows = tie->rows > rows ? tie->rows : rows;
        touched = tie->touched > touched ? tie->touched : touched;
        area = tie->rows * tie->touched > area ? tie->rows * tie->touched : area;
    }
    e->size = tribo_layout_array(l, area, sizeof *e->size);
    e->weight = tribo_layout_array(l, touched, sizeof *e->weight);
    e->found = tribo_layout_array(l, touched, sizeof *e->found);
    e->scale = tribo_layout_array(l, rows, sizeof *e->scale);
    e->most = tribo_layout_array(l, rows, sizeof *e->most);
}

static int create_ties(struct constraints *c, struct elimination *e)
{
    struct layout l = {0};
    lay_out_ties(c, e, &l);
    const int done = tribo_layout_create(&l);
    if (done) {
        lay_out_ties(c, e, &l);
    }
    return done;
}

int tribo_constraints_create(struct constraints *c, const struct matrix *direction, const struct matrix *mass, const size_t *row,
                             size_t count, const unsigned char *last)
{
    struct source s = {.direction = direction, .mass = mass, .row = row, .count = count, .last = last};
    struct elimination e = {.last = last};
    *c = (struct constraints){.count = count};
    if (count == 0) {
        return 1;
    }
    if (!create_constraints(&s, c)) {
        return 0;
    }
    join(&s);
    count_ties(&s, c);
    if (!create_ties(c, &e)) {
        return 0;
    }
    list_ties(&s, c);
    eliminate_ties(&s, c, &e);
    list_order(c);
    return 1;
}

size_t tribo_constraints_rank(const struct matrix *direction, const struct matrix *mass)
{
    const size_t n = direction->rows;
    struct constraints c = {0};
    size_t *all = tribo_zeros(n + n / sizeof *all + 1, sizeof *all);
    for (size_t i = 0; all && i < n; i++) {
        all[i] = i;
    }
    const int done = all && tribo_constraints_create(&c, direction, mass, all, n, (const unsigned char *)(all + n));
    const size_t rank = done ? c.rank : n + 1;
    tribo_constraints_free(&c);
    free(all);
    return rank;
}

/* ----------------------------------------------------------------------------------------------- displacements, forces */

/* Numbers the degrees of freedom that are no slaves; those get ndof. Returns how many they are. */
static size_t number_masters(const struct constraints *c, size_t ndof, size_t *number)
{
    size_t masters = 0;
    memset(number, 0, ndof * sizeof *number);
    for (size_t k = 0; k < c->ties; k++) {
        for (size_t p = 0; p < c->tie[k].rank; p++) {
            number[c->tie[k].dof[p]] = ndof;
        }
    }
    for (size_t d = 0; d < ndof; d++) {
        number[d] = number[d] ? ndof : masters++;
    }
    return masters;
}

/* A matrix under construction. */
struct list {
    size_t count, *i, *j;
    double *v;
};

static void put(struct list *l, size_t i, size_t j, double v)
{
    l->i[l->count] = i;
    l->j[l->count] = j;
    l->v[l->count++] = v;
}

static void put_slaves(struct list *l, const struct tie *tie, const size_t *number)
{
    for (size_t p = 0; p < tie->rank; p++) {
        for (size_t k = tie->rank; k < tie->touched; k++) {
            if (tie->entry[p * tie->touched + k] != 0.0) {
                put(l, tie->dof[p], number[tie->dof[k]], -tie->entry[p * tie->touched + k]);
            }
        }
    }
}

int tribo_constraints_basis(const struct constraints *c, size_t ndof, struct matrix *z)
{
    size_t room = ndof + 1;
    for (size_t k = 0; k < c->ties; k++) {
        room += c->tie[k].rank * (c->tie[k].touched - c->tie[k].rank);
    }
    double *v = malloc(room * sizeof *v + (ndof + 2 * room) * sizeof(size_t));
    int done = v != NULL;
    if (done) {
        size_t *number = (size_t *)(v + room);
        struct list l = {0, number + ndof, number + ndof + room, v};
        const size_t masters = number_masters(c, ndof, number);
        for (size_t d = 0; d < ndof; d++) {
            if (number[d] < ndof) {
                put(&l, d, number[d], 1.0);
            }
        }
        for (size_t k = 0; k < c->ties; k++) {
            put_slaves(&l, &c->tie[k], number);
        }
        done = tribo_matrix_from_triplets(z, ndof, masters, l.count, l.i, l.j, l.v);
    }
    free(v);
    return done;
}

void tribo_constraints_follow(const struct constraints *c, const double *b, double *q)
{
    for (const struct tie *tie = c->tie; tie < c->tie + c->ties; tie++) {
        const size_t t = tie->touched, s = tie->rank;
        double *x = c->work;
        for (size_t p = 0; p < s; p++) {
            x[p] = b[tie->order[p]];
            for (size_t k = 0; k < p; k++) {
                x[p] -= tie->entry[p * t + k] * x[k];
            }
        }
        for (size_t p = s; p-- > 0;) {
            for (size_t k = p + 1; k < s; k++) {
                x[p] -= tie->entry[p * t + k] * x[k];
            }
            x[p] /= tie->entry[p * t + p];
            q[tie->dof[p]] += x[p];
        }
    }
}

void tribo_constraints_react(const struct constraints *c, const double *force, double *f)
{
    for (const struct tie *tie = c->tie; tie < c->tie + c->ties; tie++) {
        const size_t t = tie->touched, s = tie->rank;
        double *x = c->work;
        for (size_t p = 0; p < s; p++) {
            x[p] = force[tie->dof[p]];
        }
        for (size_t p = 0; p < s; p++) {
            x[p] /= tie->entry[p * t + p];
            for (size_t k = p + 1; k < s; k++) {
                x[k] -= tie->entry[p * t + k] * x[p];
            }
        }
        for (size_t p = s; p-- > 0;) {
            for (size_t k = 0; k < p; k++) {
                x[k] -= tie->entry[p * t + k] * x[p];
            }
            f[tie->order[p]] = x[p];
        }
    }
}
