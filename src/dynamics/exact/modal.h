/* A structure with a set I of contacts held: its modes of vibration, and from the modes the velocities and forces of contacts.
 *
 * J_I q' = b_I. Then q = Phi eta + the displacements by the bases of I, with free amplitudes eta: eta'' + C~ eta' +
 * diag(omega^2) eta = constant + ramp t + harmonics. eta is the response to the right-hand side plus a sum of damped complex
 * exponentials, Re(r z), z_p' = lambda_p z_p. Velocities of sliding contacts and forces of held contacts are sums of the same
 * terms. Structures depend on I, and not on the directions in which the other contacts slide: structures are kept for later
 * phases with the same I. */
#ifndef TRIBO_MODAL_H
#define TRIBO_MODAL_H

#include <math.h>

#include "dynamics/system/system.h"

/* Number of terms computed side by side. The number of terms of a structure is a multiple of TRIBO_TERMS. */
enum { TRIBO_TERMS = 4 };

/* Velocity of a sliding contact or force of a held contact: Re(sum c_p z_p) + constant + ramp t. First the terms z_p of the
 * exponents, then the terms of the harmonics: z = e^{i Omega t}, c = response. */
struct output {
    size_t contact;
    double *cr, *ci, *size; /* [terms] c_p, |c_p| */
    double *rr, *ri, *wave; /* [harmonics] the tail of cr, ci, size that belongs to harmonics */
    double *on_rate; /* [modes] held: force per eta, ramp per eta'; sliding: velocity per eta', ramp per eta'' */
    double ramp;     /* rate of a held contact's force by bases of constant speed */
};

/* Forcing of the modes: a harmonic of the system; or a harmonic of the limit of one contact that does not hold, for the force
 * f = limit of this contact. */
struct forcing {
    double omega;
    size_t harmonic, contact; /* harmonic: index in the system; contact: of the limit, else ncontact */
};

/* Forces of the contacts that hold, first of rigid contacts, then of compliant contacts. */
struct held_forces {
    double *by_q, *by_u;  /* [modes][contacts that hold] force per eta; per eta' */
    size_t springs;       /* number of compliant contacts at rest: the contacts of the last `springs` outputs */
    double *fr, *fi, *f0; /* fr, fi [given][springs] f' by harmonics of bases; f0 [springs] by bases of constant speed */
};

struct modal {
    signed char *key; /* [ncontact] 1: at rest; 2: at rest and holds; 0: else */

    size_t moving, *dof; /* [moving] degrees of freedom that move */
    size_t modes;
    double *phi, *psi;   /* [modes][moving] mode shapes; M phi */
    double *columns;     /* [moving][modes] transpose of psi; NULL if modes are few, or phi and psi mostly 0 */
    size_t *begin, *end; /* [modes] phi and psi of mode k are 0 outside the places begin[k] to end[k] - 1 of dof */
    double *omega2, *damping;
    double *coupling;      /* [modes][modes] C~; NULL if C~ is diagonal */
    unsigned char *drifts; /* [modes] 1: omega = 0 and no damping */
    struct held_forces held;

    size_t exponents, terms;   /* terms: exponents, harmonics, and zeros up to a multiple of TRIBO_TERMS; not 0 */
    double *lr, *li, *size;    /* [terms] lambda (harmonics: i Omega); |lambda| */
    double *sixth;             /* [terms] |lambda|^6 */
    double *ar, *ai, *br, *bi; /* z = a eta + b eta': [exponents]; coupled: b [modes][exponents], a = -b omega^2/lambda */
    double *rr, *ri;           /* [exponents][modes] coupled: eta = Re(r z) */
    size_t *owner;             /* [exponents] mode of an exponent, with r = 1; NULL if coupled */

    size_t given, harmonics;   /* given: harmonics of the system, in order; harmonics: given, then harmonics of limits */
    struct forcing *forcing;   /* [harmonics] */
    double *gr, *gi, *xr, *xi; /* [harmonics][modes] g: forcing of eta; x: response of eta */
    double *yr, *yi;           /* [given][moving] velocities by harmonics of the bases of contacts that hold */
    double *y0;                /* [moving] velocities by bases of constant speed */
    double
        *constant; /* [modes] constant forcing: by constant loads, by damping of y0, and by damping of eta' = ramp/omega^2 */
    double *ramp;  /* [modes] rate of the forcing by bases of constant speed */
    int any_resonant;
    unsigned char *resonant; /* [harmonics][modes] 1: the response is not in x, since the divisor is close to 0 */

    size_t outputs, sliding; /* output [0, sliding): velocities; [sliding, outputs): forces of contacts that hold */
    struct output *output;
    double fastest;       /* largest |lambda| of exponents */
    double quickest;      /* largest |lambda| of exponents and harmonics */
    double decay, growth; /* largest -Re lambda; largest Re lambda; at least 0 */
    void *memory;         /* blocks of memory: the structure and all arrays */
    size_t bytes, *users; /* bytes: of memory; users: number of users besides the first; the last tribo_modal_free frees */
    const struct modal *base; /* structure whose arrays this one uses; NULL: none */
};

/* Returns |re + i im|, without hypot where the square is safe: hypot takes ten times as long. */
static inline double tribo_modal_magnitude(double re, double im)
{
    const double square = re * re + im * im;
    return square > 1e-280 && square < 1e300 ? sqrt(square) : hypot(re, im);
}

/* The parts of structures that do not depend on loads and limits, listed by the contacts that hold. */
struct modal_known {
    struct modal_piece *first;
    size_t bytes; /* of all pieces */
};

void tribo_modal_forget(struct modal_known *known);

/* Data that all structures of one system share. */
struct modal_shared {
    tribo_system *sys;
    const struct matrix *stiffness, *damping; /* K; C, or NULL without damping */
    struct matrix own_stiffness, own_damping; /* memory of K and C where the system has only M^-1 K and M^-1 C */
    struct modal_known *known;                /* the caller's; NULL: none */
    void *scratch;                            /* blocks of workspace, kept for the next structure */
};

/* Sets K and C. Returns a status, message on the system's context. tribo_modal_shared_free also takes zeros. */
int tribo_modal_shared_create(struct modal_shared *shared, tribo_system *sys);
void tribo_modal_shared_free(struct modal_shared *shared);

/* Creates the structure with all contacts at rest, slip[i] = 0, held. holds[i] = 1: contact i holds (set H of stick_slip.h);
 * other contacts at rest depend on H. Returns a status, message on the system's context. */
int tribo_modal_create(struct modal **modal, struct modal_shared *shared, const signed char *slip, const unsigned char *holds);
void tribo_modal_free(const struct modal *h);

/* Adds one user; every user calls tribo_modal_free in the end. Returns h. */
const struct modal *tribo_modal_share(const struct modal *h);

/* v [ndof][columns]: displacements; v + block: velocities. amplitudes: eta [modes][columns] = Phi'M v, eta + next = Phi'M (v +
 * block). add: v += Phi eta, v + block += Phi (eta + next). work [2][moving][columns]. */
void tribo_modal_amplitudes(const struct modal *h, size_t columns, const double *v, size_t block, double *eta, size_t next,
                            double *work);
void tribo_modal_add(const struct modal *h, size_t columns, const double *eta, size_t next, double *v, size_t block, double *work);

#endif
