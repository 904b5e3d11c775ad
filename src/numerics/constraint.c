#include "constraint.h"
#include "common/layout.h"
#include "common/real.h"
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

/* Gaussian elimination in a tie, of rows that stay where they are: order and slot say who is whose pivot. */
struct elimination {
    struct tie *tie;
    const unsigned char *last;
    double *entry, *size; /* [rows][touched] what is left, and what it is the sum of; multipliers in columns of pivots */
    double *weight;       /* [touched] 1/sqrt(mass) */
    double *scale;        /* [rows] 1/largest weighted entry */
    size_t *order;        /* [rows] */
    size_t *slot;         /* [touched] columns, those of pivots first */
    size_t *best;         /* [rows] column of the largest entry of a row, touched if there is none */
    double zero;          /* an entry so much smaller than its size counts as none */
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

static double weighted(const struct elimination *e, size_t i, size_t column)
{
    return fabs(e->entry[i * e->tie->touched + column]) * e->weight[column];
}

/* Finds the pivot that row i would have among the slots from first on. */
static void find_best(struct elimination *e, size_t i, size_t first)
{
    const size_t t = e->tie->touched;
    double most = 0.0;
    e->best[i] = t;
    for (size_t l = first; l < t; l++) {
        const size_t k = e->slot[l];
        if (fabs(e->entry[i * t + k]) > e->zero * e->size[i * t + k] && weighted(e, i, k) > most) {
            most = weighted(e, i, k);
            e->best[i] = k;
        }
    }
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
    for (size_t p = tie->rank; p < tie->rows; p++) {
        const size_t i = e->order[p];
        if (e->best[i] == tie->touched) {
            continue;
        }
        const double pivot = e->scale[i] * weighted(e, i, e->best[i]);
        const int wait = found < tie->rows ? last_of(e, i) - last_of(e, found) : 0;
        if (found == tie->rows || wait < 0 || (wait == 0 && pivot > most)) {
            found = i;
            most = pivot;
        }
    }
    return found;
}

/* Brings x, which stands somewhere from place at on, to that place. */
static void bring(size_t *list, size_t at, size_t x)
{
    size_t from = at;
    while (list[from] != x) {
        from++;
    }
    list[from] = list[at];
    list[at] = x;
}

/* Takes pivot row p out of row i. */
static void eliminate(struct elimination *e, size_t p, size_t i)
{
    const size_t t = e->tie->touched, first = e->tie->rank, pivot = e->slot[first];
    double *row = e->entry + i * t, *size = e->size + i * t;
    const double *from = e->entry + p * t, *from_size = e->size + p * t;
    const double factor = row[pivot] / from[pivot];
    row[pivot] = factor;
    for (size_t l = first + 1; l < t; l++) {
        const size_t k = e->slot[l];
        if (from[k] != 0.0) {
            row[k] -= factor * from[k];
            size[k] += fabs(factor) * from_size[k];
            row[k] = fabs(row[k]) > ROUNDING * size[k] ? row[k] : 0.0;
        }
    }
}

static void eliminate_all(struct elimination *e)
{
    struct tie *tie = e->tie;
    for (size_t i = 0; i < tie->rows; i++) {
        find_best(e, i, 0);
    }
    for (size_t p = find_pivot(e); p < tie->rows; p = find_pivot(e)) {
        const size_t pivot = e->best[p];
        bring(e->order, tie->rank, p);
        bring(e->slot, tie->rank, pivot);
        for (size_t k = tie->rank + 1; k < tie->rows; k++) {
            const size_t i = e->order[k];
            if (e->entry[i * tie->touched + pivot] != 0.0) {
                eliminate(e, p, i);
                find_best(e, i, tie->rank + 1);
            }
        }
        tie->rank++;
    }
}

/* list [n] in another order. work [n] */
static void permute(size_t *list, size_t n, const size_t *order, size_t *work)
{
    for (size_t k = 0; k < n; k++) {
        work[k] = list[order[k]];
    }
    memcpy(list, work, n * sizeof *list);
}

/* Keeps the rows in their order, with columns in theirs. */
static void arrange(const struct elimination *e)
{
    const struct tie *tie = e->tie;
    const size_t t = tie->touched;
    for (size_t p = 0; p < tie->rows; p++) {
        for (size_t l = 0; l < t; l++) {
            tie->entry[p * t + l] = e->entry[e->order[p] * t + e->slot[l]];
        }
    }
    permute(tie->order, tie->rows, e->order, e->best);
    memcpy(e->order, e->slot, t * sizeof *e->order);
    permute(tie->dof, t, e->order, e->slot);
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
    memset(e->entry, 0, tie->rows * t * sizeof *e->entry);
    memset(e->size, 0, tie->rows * t * sizeof *e->size);
    for (size_t l = 0; l < t; l++) {
        e->slot[l] = l;
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
        e->order[p] = p;
        for (size_t k = j->first[row]; k < j->first[row + 1]; k++) {
            if (j->val[k] != 0.0) {
                const size_t l = s->place[j->col[k]] - 1;
                e->entry[p * t + l] = j->val[k];
                e->size[p * t + l] = fabs(j->val[k]);
                most = greater(most, weighted(e, p, l));
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
        arrange(e);
        solve_rest(tie, e->weight);
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
    e->entry = tribo_layout_array(l, 2 * area + touched + rows, sizeof *e->entry);
    e->order = tribo_layout_array(l, 3 * (rows + touched), sizeof *e->order);
    if (e->entry && e->order) {
        e->size = e->entry + area;
        e->weight = e->size + area;
        e->scale = e->weight + touched;
        e->slot = e->order + rows + touched;
        e->best = e->slot + rows + touched;
    }
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
