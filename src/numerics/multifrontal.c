#include "multifrontal.h"
#include "common/real.h"
#include "common/simd.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tribo/tribo.h"

/* A front is eliminated by panels of PANEL columns. A panel updates the rest in tiles of TALL rows and WIDE columns, as much as
 * registers hold. */
enum { PANEL = 48, TALL = 4, WIDE = 8 };

/* The Schur complement of a group in its other rows. */
struct rest {
    double *x;   /* lower triangle, row by row */
    size_t next; /* the next group of the same parent, or none */
};

struct fronts {
    const struct lower_columns *a;
    const struct supernodes *s;
    size_t *group;     /* [n] group of a column */
    size_t *place;     /* [n] place of a row of L in the front */
    size_t *child;     /* [count] the first group whose rest is added to this one, or none */
    struct rest *rest; /* [count] */
    double *sum;       /* [n] sum_k |L_ik|^2 |D_k| */
    size_t stride;
    double *x;    /* [rows + TALL][stride] the front, by its lower triangle */
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

/* Eliminates columns begin to end - 1, and updates these columns: L takes their place, D that of the diagonal. Returns 0 if a
 * pivot is 0 or not finite. */
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

/* to [TALL][WIDE] -= from [TALL][width] tile [width][WIDE]. The innermost loop is one or two instructions, if the compiler leaves
 * it a loop. */
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

/* Updates rows and columns from end on by the panel begin to end - 1. The front has rows and columns to spare for the last
 * tiles. */
TRIBO_SIMD static void update_rest(const struct fronts *f, size_t begin, size_t end, size_t rows)
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
    for (size_t i = end; i < rows; i += TALL) {
        double *x = f->x + i * f->stride;
        for (size_t j = end; j < i + TALL && j < rows; j += WIDE) {
            subtract_product(width, f->stride, x + begin, f->tile + (j - end) * width, x + j);
        }
    }
}

/* Fills the front of group g with its columns of the matrix, and the rests of its children, which are freed. */
static void assemble(struct fronts *f, size_t g)
{
    const struct supernodes *s = f->s;
    const size_t rows = rows_of(s, g), *row = s->row + s->begin[g];
    for (size_t i = 0; i < rows; i++) {
        f->place[row[i]] = i;
    }
    f->stride = rows + WIDE;
    memset(f->x, 0, (rows + TALL) * f->stride * sizeof *f->x);
    for (size_t c = s->first[g]; c < s->first[g + 1]; c++) {
        for (size_t k = f->a->first[c]; k < f->a->first[c + 1]; k++) {
            f->x[f->place[f->a->row[k]] * f->stride + c - s->first[g]] += f->a->val[k];
        }
    }
    for (size_t c = f->child[g]; c < s->count; c = f->rest[c].next) {
        const size_t columns = columns_of(s, c), left = rows_of(s, c) - columns, *own = s->row + s->begin[c] + columns;
        const double *from = f->rest[c].x;
        for (size_t i = 0; i < left; i++) {
            double *to = f->x + f->place[own[i]] * f->stride;
            for (size_t j = 0; j <= i; j++) {
                to[f->place[own[j]]] += *from++;
            }
        }
        free(f->rest[c].x);
        f->rest[c].x = NULL;
    }
}

/* Eliminates the columns of group g, and leaves the rest to the group of its first row. Returns a status. */
static int do_group(struct fronts *f, size_t g)
{
    const size_t columns = columns_of(f->s, g), rows = rows_of(f->s, g), *row = f->s->row + f->s->begin[g];
    assemble(f, g);
    for (size_t begin = 0; begin < columns; begin += PANEL) {
        const size_t end = begin + PANEL < columns ? begin + PANEL : columns;
        if (!eliminate_panel(f, begin, end, rows, row)) {
            return TRIBO_ERR_INDEFINITE;
        }
        update_rest(f, begin, end, rows);
    }
    const size_t left = rows - columns;
    if (left == 0) {
        return TRIBO_OK;
    }
    double *to = f->rest[g].x = malloc(left * (left + 1) / 2 * sizeof *to);
    for (size_t i = columns; to && i < rows; i++) {
        memcpy(to, f->x + i * f->stride + columns, (i + 1 - columns) * sizeof *to);
        to += i + 1 - columns;
    }
    const size_t parent = f->group[row[columns]];
    f->rest[g].next = f->child[parent];
    f->child[parent] = g;
    return to ? TRIBO_OK : TRIBO_ERR_MEMORY;
}

int tribo_multifrontal_inertia(const struct lower_columns *a, const struct supernodes *s, const double *size,
                               struct inertia *found)
{
    struct fronts f = {.a = a, .s = s};
    size_t most = 0;
    for (size_t g = 0; g < s->count; g++) {
        most = rows_of(s, g) > most ? rows_of(s, g) : most;
    }
    f.group = malloc((2 * s->n + s->count + 1) * sizeof *f.group);
    f.rest = calloc(s->count + 1, sizeof *f.rest);
    f.sum = calloc(s->n + 1, sizeof *f.sum);
    f.x = malloc((most + TALL) * (most + WIDE) * sizeof *f.x);
    f.tile = malloc((most + WIDE) * PANEL * sizeof *f.tile);
    int status = f.group && f.rest && f.sum && f.x && f.tile ? TRIBO_OK : TRIBO_ERR_MEMORY;
    if (!status) {
        f.place = f.group + s->n;
        f.child = f.place + s->n;
        for (size_t g = 0; g < s->count; g++) {
            f.child[g] = s->count;
            for (size_t c = s->first[g]; c < s->first[g + 1]; c++) {
                f.group[c] = g;
            }
        }
    }
    for (size_t g = 0; !status && g < s->count; g++) {
        status = do_group(&f, g);
    }
    if (!status) {
        *found = (struct inertia){f.negative, 0.0};
        for (size_t i = 0; i < s->n; i++) {
            found->growth = greater(found->growth, f.sum[i] / fabs(size[s->order[i]]));
        }
    }
    for (size_t g = 0; f.rest && g < s->count; g++) {
        free(f.rest[g].x);
    }
    free(f.group);
    free(f.rest);
    free(f.sum);
    free(f.x);
    free(f.tile);
    return status;
}
