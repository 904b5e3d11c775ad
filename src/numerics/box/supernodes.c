/* A new factor of a sparse group, supernode by supernode. A supernode is a run of columns of L with the same rows below it, which
 * is therefore a dense trapezoid in memory (Ng and Peyton 1993, SIAM J. Sci. Comput. 14, 1034, doi:10.1137/0914063):
 *
 *     for each supernode J   its columns of R
 *         for each K before it with rows among J's columns   J -= L_K D L_K', rows below counting
 *         eliminate within J
 *
 * Contacts that are not in the factor are rows and columns of zeros. */
#include "factor_sparse.h"

#include <math.h>
#include <string.h>

#include "common/simd.h"

void tribo_supernodes_find(struct sparse *s, const size_t *parent)
{
    s->supernodes = 0;
    for (size_t k = 0; k < s->r.n; k++) {
        const size_t before = k > 0 ? s->column[k] - s->column[k - 1] : 0, own = s->column[k + 1] - s->column[k];
        if (k == 0 || parent[k - 1] != k || before != own + 1) {
            s->supernode[s->supernodes++] = k;
        }
        s->member_of[k] = s->supernodes - 1;
    }
    s->supernode[s->supernodes] = s->r.n;
}

/* Columns times numbers that are to be added to a column: four at a time, so that it is read and written less often. */
struct sum {
    double *to;
    size_t n, count;
    const double *column[4];
    double factor[4];
};

TRIBO_SIMD static void add_four(size_t n, const double *restrict a, const double *restrict b, const double *restrict c,
                                const double *restrict d, const double *factor, double *restrict to)
{
    const double x = factor[0], y = factor[1], z = factor[2], w = factor[3];
    for (size_t i = 0; i < n; i++) {
        to[i] += (a[i] * x + b[i] * y) + (c[i] * z + d[i] * w);
    }
}

static void flush(struct sum *s)
{
    for (size_t k = 0; s->count < 4 && k < s->count; k++) {
        for (size_t i = 0; i < s->n; i++) {
            s->to[i] += s->column[k][i] * s->factor[k];
        }
    }
    if (s->count == 4) {
        add_four(s->n, s->column[0], s->column[1], s->column[2], s->column[3], s->factor, s->to);
    }
    s->count = 0;
}

static inline void add(struct sum *s, const double *column, double factor)
{
    s->column[s->count] = column;
    s->factor[s->count++] = factor;
    if (s->count == 4) {
        flush(s);
    }
}

/* A supernode: its columns [begin, end), and the rows below. */
struct node {
    size_t begin, end, below;
    const size_t *row;
};

static struct node node_of(const struct sparse *s, size_t k)
{
    const size_t end = s->supernode[k + 1], first = s->column[end - 1];
    return (struct node){s->supernode[k], end, s->column[end] - first, s->row_of + first};
}

static inline int is_free(const struct box_qp *p, size_t k)
{
    return p->at[p->group->sparse->place[k]] == FREE;
}

/* What R has in the columns of a node; diagonals go to d. where [size] says which row of the node a row is. */
static void load(const struct box_qp *p, const struct node *j, const size_t *where)
{
    const struct sparse *s = p->group->sparse;
    for (size_t t = j->begin; t < j->end; t++) {
        const size_t i = s->place[t];
        for (size_t e = s->r.first[i]; p->at[i] == FREE && e < s->r.first[i + 1]; e++) {
            const size_t other = s->r.col[e], k = s->position[other];
            if (k < t || p->at[other] != FREE) {
                continue;
            }
            const double x = p->scale[i] * s->r.val[e] * p->scale[other];
            if (k == t) {
                p->sparse.d[t] = x;
            } else {
                p->sparse.l[s->column[t] + where[k] - where[t] - 1] = x;
            }
        }
    }
}

/* What node k eliminates of column t, which is row a of those below it: sum [k->below - a]. 0 if that is nothing. */
static int outer_product(const struct box_qp *p, const struct node *k, size_t a, double *sum)
{
    const struct sparse *s = p->group->sparse;
    struct sum u = {.to = sum, .n = k->below - a};
    int any = 0;
    for (size_t c = k->begin; c < k->end; c++) {
        const double *l = p->sparse.l + s->column[c] + (k->end - 1 - c) + a;
        if (*l != 0.0) {
            if (!any) {
                memset(sum, 0, u.n * sizeof *sum);
            }
            any = 1;
            add(&u, l, *l / p->sparse.d[c]);
        }
    }
    flush(&u);
    return any;
}

/* The same for a node of one column l, taken from column t at once. */
static void take_one(const struct box_qp *p, const struct node *k, size_t a, const size_t *where, const double *l)
{
    const size_t t = k->row[a];
    const double y = l[a] / p->sparse.d[k->begin];
    double *to = p->sparse.l + p->group->sparse->column[t] - where[t] - 1;
    p->sparse.d[t] -= l[a] * y;
    for (size_t i = a + 1; i < k->below; i++) {
        to[where[k->row[i]]] -= l[i] * y;
    }
}

/* Takes from the columns of j what node k, whose rows from `from` on are not before j, eliminates there. Returns from which row
 * on they are behind j. sum [size] is workspace. */
static size_t update(const struct box_qp *p, const struct node *j, const struct node *k, size_t from, const size_t *where,
                     double *sum)
{
    const struct sparse *s = p->group->sparse;
    size_t a = from;
    for (const double *l = p->sparse.l + s->column[k->begin]; k->end - k->begin == 1 && a < k->below && k->row[a] < j->end; a++) {
        if (l[a] != 0.0) {
            take_one(p, k, a, where, l);
        }
    }
    for (; a < k->below && k->row[a] < j->end; a++) {
        if (!outer_product(p, k, a, sum)) {
            continue;
        }
        const size_t t = k->row[a];
        double *to = p->sparse.l + s->column[t] - where[t] - 1;
        p->sparse.d[t] -= sum[0];
        for (size_t i = 1; i < k->below - a; i++) {
            to[where[k->row[a + i]]] -= sum[i];
        }
    }
    return a;
}

/* Eliminates within the node. A pivot that counts as zero leaves its column out; *left gets the largest entry that is left there,
 * and *who whose it is. */
static void eliminate(const struct box_qp *p, const struct node *j, double *left, size_t *who)
{
    const struct sparse *s = p->group->sparse;
    for (size_t t = j->begin; t < j->end; t++) {
        double *column = p->sparse.l + s->column[t];
        const size_t entries = s->column[t + 1] - s->column[t];
        struct sum u = {.to = column, .n = entries};
        if (!is_free(p, t)) {
            continue;
        }
        for (size_t c = j->begin; c < t; c++) {
            const double *l = p->sparse.l + s->column[c] + (t - 1 - c);
            if (*l != 0.0) {
                const double y = *l / p->sparse.d[c];
                p->sparse.d[t] -= y * *l;
                add(&u, l + 1, -y);
            }
        }
        flush(&u);
        const double pivot = p->sparse.d[t];
        if (pivot > TRIBO_SPARSE_ZERO) {
            p->sparse.d[t] = 1.0 / pivot;
            for (size_t q = 0; q < entries; q++) {
                column[q] *= p->sparse.d[t];
            }
            continue;
        }
        p->sparse.d[t] = 0.0;
        for (size_t q = 0; q <= entries; q++) {
            const double x = fabs(q < entries ? column[q] : pivot);
            if (x > *left) {
                *left = x;
                *who = s->place[q < entries ? s->row_of[s->column[t] + q] : t];
            }
        }
        memset(column, 0, entries * sizeof *column);
    }
}

double tribo_supernodes_factorize(const struct box_qp *p, size_t *who)
{
    const struct sparse *s = p->group->sparse;
    const size_t size = s->r.n;
    /* lists of nodes by the node that they change next; which of their rows is the first to do so */
    size_t *head = p->sparse.work, *next = head + size, *from = next + size, *where = from + size;
    double left = 0.0;
    memset(p->sparse.l, 0, s->column[size] * sizeof *p->sparse.l);
    memset(p->sparse.d, 0, size * sizeof *p->sparse.d);
    memset(head, 0xff, size * sizeof *head);
    for (size_t n = 0; n < s->supernodes; n++) {
        const struct node j = node_of(s, n);
        for (size_t t = j.begin; t < j.end; t++) {
            where[t] = t - j.begin;
        }
        for (size_t i = 0; i < j.below; i++) {
            where[j.row[i]] = j.end - j.begin + i;
        }
        load(p, &j, where);
        from[n] = 0;
        for (size_t k = head[n], after; k != NONE; k = after) {
            const struct node other = node_of(s, k);
            after = next[k];
            from[k] = update(p, &j, &other, from[k], where, p->sparse.w);
            if (from[k] < other.below) {
                const size_t to = s->member_of[other.row[from[k]]];
                next[k] = head[to];
                head[to] = k;
            }
        }
        eliminate(p, &j, &left, who);
        if (j.below > 0) {
            const size_t to = s->member_of[j.row[0]];
            next[n] = head[to];
            head[to] = n;
        }
    }
    memset(p->sparse.w, 0, size * sizeof *p->sparse.w);
    return left;
}
