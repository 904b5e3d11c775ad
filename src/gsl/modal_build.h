/* What is needed only while a modal structure is built, and what the parts of that share. */
#ifndef TRIBO_MODAL_BUILD_H
#define TRIBO_MODAL_BUILD_H

#include "modal.h"

/* Vectors of the whole structure: [ndof], modes of it [modes][ndof]. */
struct build {
    tribo_system *sys;
    struct modal *h;
    size_t n;
    size_t *rest;       /* [h->rest] the contacts that hold */
    double *r_diagonal; /* [rest] R_II, if the contacts share no body; */
    struct cholesky r;  /* its factor, if they do */
    double *phi, *psi, *ak_phi, *ac_phi;
    double *g, *g_rate; /* [modes][rest] force of the held contacts per unit of eta, eta' */
    double *yr, *yi;    /* [harmonics][ndof] */
    double *y0;         /* [ndof] velocities from belts of constant speed */
    void *scratch;      /* list of what is freed at the end */
    int status;         /* of a failure other than of memory */
};

/* Zeroed memory that the structure keeps, or that is freed when it is built. NULL if there is none left. */
double *tribo_modal_keep(struct build *b, size_t count);
size_t *tribo_modal_keep_indices(struct build *b, size_t count);
unsigned char *tribo_modal_keep_bytes(struct build *b, size_t count);
struct output *tribo_modal_keep_outputs(struct build *b, size_t count);
double *tribo_modal_scratch(struct build *b, size_t count);
size_t *tribo_modal_scratch_indices(struct build *b, size_t count);

/* x [rest] = R_II^-1 x. */
void tribo_modal_solve_rest(const struct build *b, double *x);

/* x [rest] = factor * J_I q + keep_part * x. */
void tribo_modal_at_rest(const struct build *b, double factor, const double *q, double keep_part, double *x);

/* One part (0 cosine, 1 minus sine: harmonics are Re((c - i s) e^{i Omega t})) of a harmonic of b_I. */
void tribo_modal_base_part(const struct build *b, const struct harmonic *w, int part, double *x);

/* The exponents of eta. Returns a status. */
int tribo_modal_exponents(struct build *b);

/* These return 0 if out of memory, or with the status in b. */
int tribo_modal_forcing(struct build *b);
int tribo_modal_response(struct build *b);
int tribo_modal_outputs(struct build *b);

static inline double dot(const double *x, const double *y, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += x[i] * y[i];
    }
    return sum;
}

static inline void add(double *to, double factor, const double *x, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        to[i] += factor * x[i];
    }
}

#endif
