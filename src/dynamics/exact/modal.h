/* A structure some of whose contacts are held: its modes of vibration, and what the motion in them means for every contact.
 *
 * With the contacts of a set I held (J_I q' = b_I), q = Phi eta + what the held contacts are moved by, and the amplitudes eta are
 * free: eta'' + C~ eta' + diag(omega^2) eta = constant + ramp + harmonics. Apart from the response to the right-hand side they
 * are sums of damped complex exponentials, eta = Re(r z), z_p' = lambda_p z_p, and so are the velocities of the sliding contacts
 * and the forces of the held ones. All of it depends on which contacts are held, and not on where the others slide to: it is kept
 * for sets that come back. */
#ifndef TRIBO_MODAL_H
#define TRIBO_MODAL_H

#include <math.h>

#include "dynamics/system/system.h"

/* How many terms are done side by side: the number of terms is a multiple of this. */
enum { TRIBO_TERMS = 4 };

/* What a contact's velocity (sliding) or force (held) is made of: Re(sum c_p z_p) + constant + ramp t. The terms z_p are of the
 * exponents, and then of the harmonics: z = e^{i Omega t}, c = response. */
struct output {
    size_t contact;
    double *cr, *ci, *size; /* [terms] c_p, |c_p| */
    double *rr, *ri, *wave; /* [harmonics] those of them that are of harmonics */
    double *on_rate; /* [modes] held contacts: what a constant eta' adds to the ramp; sliding ones: what a constant eta'' does */
    double ramp;     /* from belts of constant speed */
};

/* What forces the modes: a harmonic of the system; or of a limit, what it makes of the force of one contact that does not hold,
 * per direction of that. */
struct forcing {
    double omega;
    size_t harmonic, contact; /* contact: the system's ncontact if it is none's */
};

/* Forces of the contacts that hold, those of compliant contacts last. */
struct held_forces {
    double *by_q, *by_u;  /* [modes][contacts that hold] by eta and eta' */
    size_t springs;       /* compliant contacts at rest; their outputs are the last ones */
    double *fr, *fi, *f0; /* [given][springs], [springs] f' by bases; by bases of constant speed */
};

struct modal {
    signed char *key; /* [ncontact] 1: the contact rests, 2: and holds */

    size_t moving, *dof; /* degrees of freedom that move */
    size_t modes;
    double *phi, *psi;   /* [modes][moving] and M phi; */
    double *columns;     /* [moving][modes] the transpose of M phi, unless most of it is 0; */
    size_t *begin, *end; /* [modes] these are 0 but for degrees of freedom from begin to end - 1 of those that move */
    double *omega2, *damping;
    double *coupling;      /* [modes][modes] C~, or NULL if it is diagonal */
    unsigned char *drifts; /* [modes] omega = 0 and no damping */
    struct held_forces held;

    size_t exponents, terms;   /* terms: with harmonics, and zeros after them, at least TRIBO_TERMS */
    double *lr, *li, *size;    /* [terms] lambda (of harmonics: i Omega), and its absolute value, */
    double *sixth;             /* and this to the power of six */
    double *ar, *ai, *br, *bi; /* [exponents] z = a eta + b eta'; coupled: z = b (eta' - omega^2 eta/lambda), b [modes][exponents], */
    double *rr, *ri;           /* [exponents][modes] and eta = Re(r z) */
    size_t *owner;             /* the mode of an exponent, if not coupled (then r = 1) */

    size_t given, harmonics;   /* as many as the system has, and in its order; and with those of single contacts after them */
    struct forcing *forcing;   /* [harmonics] */
    double *gr, *gi, *xr, *xi; /* [harmonics][modes] forcing and response of eta */
    double *yr, *yi;           /* [given][moving] velocities from the belts that hold */
    double *y0;                /* [moving] the same from belts of constant speed */
    double
        *constant; /* [modes] forcing by constant loads, and by damping, where belts of constant speed move contacts or modes */
    double *ramp;  /* [modes] forcing per unit of time, from belts of constant speed */
    int any_resonant;
    unsigned char *resonant; /* [harmonics][modes] the response is not in x, since it would be close to infinite */

    size_t outputs, sliding; /* the first ones are of sliding contacts, the others of held ones */
    struct output *output;
    double fastest;       /* largest |lambda| */
    double quickest;      /* the largest of these and the frequencies of harmonics */
    double decay, growth; /* the largest rate of decay, and of growth */
    void *memory;         /* of itself and all arrays */
    size_t bytes, *users; /* besides the one that made it: tribo_modal_free leaves it to them */
    const struct modal *base; /* whose arrays it shares, or NULL */
};

/* |re + i im|: hypot, which takes ten times as long. */
static inline double tribo_modal_magnitude(double re, double im)
{
    const double square = re * re + im * im;
    return square > 1e-280 && square < 1e300 ? sqrt(square) : hypot(re, im);
}

/* Structures with contacts held, as far as loads and limits do not change them, by the contacts that hold. */
struct modal_known {
    struct modal_piece *first;
    size_t bytes; /* of all */
};

void tribo_modal_forget(struct modal_known *known);

/* What the structures of one system with contacts held share. */
struct modal_shared {
    tribo_system *sys;
    const struct matrix *stiffness, *damping; /* K and C, or NULL */
    struct matrix own_stiffness, own_damping; /* where the system has only M^-1 K and M^-1 C */
    struct modal_known *known;                /* the caller's, or NULL */
    void *scratch;                            /* for the next one */
};

/* Returns a status; its message is on the system's context. tribo_modal_shared_free takes zeros, too. */
int tribo_modal_shared_create(struct modal_shared *shared, tribo_system *sys);
void tribo_modal_shared_free(struct modal_shared *shared);

/* The structure with the contacts held whose slip is 0, those of them that hold being marked (see stick_slip.h); the others at
 * rest depend on those. Returns a status; its message is on the system's context. */
int tribo_modal_create(struct modal **modal, struct modal_shared *shared, const signed char *slip, const unsigned char *holds);
void tribo_modal_free(const struct modal *h);

/* For another user. */
const struct modal *tribo_modal_share(const struct modal *h);

/* eta [modes][columns] = amplitudes of displacements v [ndof][columns], and of velocities, which follow v after `block` numbers, next
 * numbers after eta; and v += what amplitudes and rates are, changed. work [2][moving][columns]. */
void tribo_modal_amplitudes(const struct modal *h, size_t columns, const double *v, size_t block, double *eta, size_t next,
                            double *work);
void tribo_modal_add(const struct modal *h, size_t columns, const double *eta, size_t next, double *v, size_t block, double *work);

#endif
