#include "multifrontal.h"
#include "common/real.h"
#include "common/simd.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tribo/tribo.h"

/* Columns that are eliminated before the rest of a front learns of them; the rest is worked at in tiles of TALL rows and WIDE
 * columns, which is as much as registers hold. */
enum { PANEL = 48, TALL = 4, WIDE = 8 };

/* What the elimination of a group leaves of its other rows: the lower triangle, row by row. */
struct rest {
    double *x;
    size_t next; /* the next group with the same parent, or none */
};

struct fronts {
    const struct lower_columns *a;
    const struct supernodes *s;
    size_t *group;     /* [n] of each column */
    size_t *place;     /* [n] of the rows of L in the front at hand */
    size_t *child;     /* [count] the first group whose rest goes into this one, or none */
    struct rest *rest; /* [count] */
    double *sum;       /* [n] of |L_ik|^2 |D_k| */
    size_t stride;
    double *x;    /* [a few more than the rows][stride] the front, of which the lower triangle counts */
    double *tile; /* [rows / WIDE + 1][PANEL][WIDE] D L' of a panel */
    size_t negative;
};

static size_t columns_of(const struct supernodes *s, size_t g)
{
    return s->first[g + 1] - s->first[g];
}

static size_t rows_of(const struct supernodes *s, size_t g)
{
    return s->begin[g + 1] - s->begin[g];
}

/* ----------------------------------------------------------------------------------------------------------- a dense front */

/* Eliminates columns k to end - 1, of which only these learn; 0 if a pivot is zero or not a number. L takes their place, D the
 * diagonal's. */
static int eliminate_panel(struct fronts *f, size_t begin, size_t end, size_t rows, const size_t *row)
{
    double u[PANEL];
    for (size_t k = begin; k < end; k++) {
        const double d = f->x[k * f->stride + k];
        if (!(fabs(d) > 0.0) || !isfinite(d)) {
            return 0;
        }
        f->negative += d < 0.0;
        f->sum[row[k]] += fabs(d);
        for (size_t j = k + 1; j < end; j++) {
            u[j - k] = f->x[j * f->stride + k];
        }
        for (size_t i = k + 1; i < rows; i++) {
            double *x = f->x + i * f->stride;
            const double l = x[k] / d;
            f->sum[row[i]] += fabs(l * x[k]);
            x[k] = l;
            const size_t last = i < end ? i + 1 : end;
            for (size_t j = k + 1; j < last; j++) {
                x[j] -= l * u[j - k];
            }
        }
    }
    return 1;
}

/* D L' of columns begin to end - 1, for rows from end on. */
static void fill_tiles(struct fronts *f, size_t begin, size_t end, size_t rows)
{
    const size_t width = end - begin;
    for (size_t j = end; j < rows; j += WIDE) {
        double *tile = f->tile + (j - end) * width;
        for (size_t k = 0; k < width; k++) {
            const double d = f->x[(begin + k) * f->stride + begin + k];
            for (size_t c = 0; c < WIDE; c++) {
                tile[k * WIDE + c] = j + c < rows ? d * f->x[(j + c) * f->stride + begin + k] : 0.0;
            }
        }
    }
}

/* TALL rows of x, WIDE columns from to on, lose the product of their columns from from on and a tile. The innermost loop is one
 * or two instructions, if the compiler leaves it a loop. */
static inline void subtract_product(size_t width, size_t stride, const double *restrict from, const double *restrict tile,
                                    double *restrict to)
{
    double sum[TALL][WIDE] = {{0.0}};
    for (size_t k = 0; k < width; k++) {
        for (size_t r = 0; r < TALL; r++) {
#if defined(TRIBO_GNU_C)
#pragma GCC unroll 1
#endif
            for (size_t c = 0; c < WIDE; c++) {
                sum[r][c] += from[r * stride + k] * tile[k * WIDE + c];
            }
        }
    }
    for (size_t r = 0; r < TALL; r++) {
        for (size_t c = 0; c < WIDE; c++) {
            to[r * stride + c] -= sum[r][c];
        }
    }
}

/* Rows from end on learn of columns begin to end - 1. The front has rows and columns to spare for the last tiles. */
TRIBO_SIMD static void update_rest(const struct fronts *f, size_t begin, size_t end, size_t rows)
{
    const size_t width = end - begin;
    for (size_t i = end; i < rows; i += TALL) {
        double *x = f->x + i * f->stride;
        for (size_t j = end; j < i + TALL && j < rows; j += WIDE) {
            subtract_product(width, f->stride, x + begin, f->tile + (j - end) * width, x + j);
        }
    }
}

static int multifrontal_eliminate(struct fronts *f, size_t columns, size_t rows, const size_t *row)
{
    for (size_t begin = 0; begin < columns; begin += PANEL) {
        const size_t end = begin + PANEL < columns ? begin + PANEL : columns;
        if (!eliminate_panel(f, begin, end, rows, row)) {
            return 0;
        }
        fill_tiles(f, begin, end, rows);
        update_rest(f, begin, end, rows);
    }
    return 1;
}

/* -------------------------------------------------------------------------------------------------------- one after another */

static void add_entries(struct fronts *f, size_t g)
{
    const struct supernodes *s = f->s;
    for (size_t c = s->first[g]; c < s->first[g + 1]; c++) {
        for (size_t k = f->a->first[c]; k < f->a->first[c + 1]; k++) {
            f->x[f->place[f->a->row[k]] * f->stride + c - s->first[g]] += f->a->val[k];
        }
    }
}

/* Adds what group g has left to the front at hand, and frees it. */
static void multifrontal_add_rest(struct fronts *f, size_t g)
{
    const size_t columns = columns_of(f->s, g), rows = rows_of(f->s, g) - columns;
    const size_t *row = f->s->row + f->s->begin[g] + columns;
    const double *from = f->rest[g].x;
    for (size_t i = 0; i < rows; i++) {
        double *to = f->x + f->place[row[i]] * f->stride;
        for (size_t j = 0; j <= i; j++) {
            to[f->place[row[j]]] += *from++;
        }
    }
    free(f->rest[g].x);
    f->rest[g].x = NULL;
}

/* Leaves the rest of group g to the group of its first row. 0 if out of memory. */
static int leave_rest(struct fronts *f, size_t g)
{
    const size_t columns = columns_of(f->s, g), all = rows_of(f->s, g), rows = all - columns;
    if (rows == 0) {
        return 1;
    }
    double *to = malloc(rows * (rows + 1) / 2 * sizeof *to);
    f->rest[g].x = to;
    for (size_t i = columns; to && i < all; i++) {
        memcpy(to, f->x + i * f->stride + columns, (i + 1 - columns) * sizeof *to);
        to += i + 1 - columns;
    }
    const size_t parent = f->group[f->s->row[f->s->begin[g] + columns]];
    f->rest[g].next = f->child[parent];
    f->child[parent] = g;
    return to != NULL;
}

static int do_group(struct fronts *f, size_t g)
{
    const size_t columns = columns_of(f->s, g), rows = rows_of(f->s, g), *row = f->s->row + f->s->begin[g];
    for (size_t i = 0; i < rows; i++) {
        f->place[row[i]] = i;
    }
    f->stride = rows + WIDE;
    memset(f->x, 0, (rows + TALL) * f->stride * sizeof *f->x);
    add_entries(f, g);
    for (size_t c = f->child[g]; c < f->s->count; c = f->rest[c].next) {
        multifrontal_add_rest(f, c);
    }
    return !multifrontal_eliminate(f, columns, rows, row) ? TRIBO_ERR_INDEFINITE : leave_rest(f, g) ? TRIBO_OK : TRIBO_ERR_MEMORY;
}

/* ------------------------------------------------------------------------------------------------------------------- all */

static int begin(struct fronts *f)
{
    const struct supernodes *s = f->s;
    size_t most = 0;
    for (size_t g = 0; g < s->count; g++) {
        most = rows_of(s, g) > most ? rows_of(s, g) : most;
    }
    f->group = malloc((2 * s->n + s->count + 1) * sizeof *f->group);
    f->rest = calloc(s->count + 1, sizeof *f->rest);
    f->sum = calloc(s->n + 1, sizeof *f->sum);
    f->x = malloc((most + TALL) * (most + WIDE) * sizeof *f->x);
    f->tile = malloc((most + WIDE) * PANEL * sizeof *f->tile);
    if (!f->group || !f->rest || !f->sum || !f->x || !f->tile) {
        return 0;
    }
    f->place = f->group + s->n;
    f->child = f->place + s->n;
    for (size_t g = 0; g < s->count; g++) {
        f->child[g] = s->count;
        for (size_t c = s->first[g]; c < s->first[g + 1]; c++) {
            f->group[c] = g;
        }
    }
    return 1;
}

static void end(struct fronts *f)
{
    for (size_t g = 0; f->rest && g < f->s->count; g++) {
        free(f->rest[g].x);
    }
    free(f->group);
    free(f->rest);
    free(f->sum);
    free(f->x);
    free(f->tile);
}

int tribo_multifrontal_inertia(const struct lower_columns *a, const struct supernodes *s, const double *size,
                               struct inertia *found)
{
    struct fronts f = {.a = a, .s = s};
    int status = begin(&f) ? TRIBO_OK : TRIBO_ERR_MEMORY;
    for (size_t g = 0; !status && g < s->count; g++) {
        status = do_group(&f, g);
    }
    if (!status) {
        *found = (struct inertia){f.negative, 0.0};
        for (size_t i = 0; i < s->n; i++) {
            found->growth = greater(found->growth, f.sum[i] / fabs(size[s->order[i]]));
        }
    }
    end(&f);
    return status;
}
