/* SPDX-License-Identifier: BSD-3-Clause */
/* A structure with a set I of contacts held: its modes of vibration, and from the modes the velocities and forces of contacts.
 *
 * J_I q' = b_I. Then q = Phi eta, with the mode shapes, eta'' + C~ eta' + diag(omega^2) eta = constant + ramp t + harmonics,
 * and with further shapes, the displacements by the bases of I, of known eta. eta of a mode is the response to the right-hand
 * side plus a sum of damped complex exponentials, Re(r z), z_p' = lambda_p z_p. Velocities of sliding contacts and forces of
 * held contacts are sums of the same terms. struct modal depends on I alone, struct forced on loads and limits, too; neither
 * depends on the directions in which the other contacts slide: both are kept for later phases with the same I. */
#ifndef TRIBO_MODAL_H
#define TRIBO_MODAL_H

#include <math.h>

#include "common/imaginary.h"
#include "dynamics/system/system.h"
#include "numerics/constraint.h"

/* Number of terms computed side by side. The number of terms of a structure is a multiple of TRIBO_TERMS. */
enum { TRIBO_TERMS = 4 };

/* What a contact does in a structure. At rest without force of its own; at rest and holds; a normal that is apart, or pressed;
 * slides, or is tied at its limit, which follows the motion, with a force > 0 (BACK) or < 0 (FORTH). */
enum { KEY_FREE, KEY_RESTS, KEY_HOLDS, KEY_APART, KEY_PRESSED, KEY_BACK, KEY_FORTH, KEY_TIED_BACK, KEY_TIED_FORTH };

/* Arrays that are freed together. */
struct modal_store {
    struct modal_block *last;
    size_t bytes;
    int failed; /* 1: an array is NULL */
};

/* Returns a zeroed array of elements; NULL, with failed = 1, if out of memory. */
void *tribo_modal_take(struct modal_store *store, size_t count, size_t size);

/* Coordinates Phi that are orthonormal in M, and no modes, of `users` structures: motions are powers of time (powers.c). */
struct modal_powers {
    size_t users;
    struct matrix stiffness, damping; /* Phi'K Phi and Phi'C Phi [modes][modes]; without damping the second has no rows */
    double *reach, array[];           /* [contacts][modes] J Phi; omega2, damping, phi, psi and reach */
};

/* z = a eta + b eta' of the exponents: [exponents], eta of the owner; coupled: [modes][exponents]. */
struct left_vectors {
    double *ar, *ai, *br, *bi;
};

/* The structure without loads. */
struct modal {
    struct modal_store store; /* memory of all arrays */
    size_t users;             /* number of users besides the first; the last tribo_modal_free frees */
    struct modal *next;       /* of the caller's list */
    size_t run;               /* the caller's: of coordinates, the run in which modes took their place */
    struct forced *forced;    /* the structure under the loads; NULL: not created since the loads changed */
    size_t within[2];         /* first and end of n degrees of freedom: all that modes, or M, K or C times modes, move */
    signed char *key;         /* [contacts] KEY_ */
    size_t rests, springs;    /* numbers of rigid contacts, and of others, that hold */
    size_t *rest;             /* [rests + springs] these, the rigid ones first */
    struct constraints ties;  /* constraints between degrees of freedom by the rigid contacts that hold */

    size_t modes;
    double *phi; /* [modes][n] mode shapes, of the degrees of freedom within */
    double *psi; /* [modes][n] M times the mode shapes */
    double *omega2, *damping;
    struct modal_powers *powers; /* NULL: Phi are modes; else there are no exponents, and omega2 and damping are 0 */
    double *coupling;            /* [modes][modes] C~; NULL if C~ is diagonal, or without modes */
    double *stiff, *give; /* [modes][modes] K~ where contacts slide at limits that follow the motion, or K is not symmetric; its
                                    inverse over the modes with omega2 != 0; NULL: diag(omega2) */
    double *on;           /* [contacts][modes] contact that holds: force per eta; normal: N per eta; else: velocity per eta' */
    double *by_u; /* [contacts][modes] rigid contact that holds: force per eta'; else 0; NULL without damping or such contacts */

    size_t exponents;
    double *lr, *li; /* [exponents] lambda */
    struct left_vectors left;
    double *rr, *ri; /* [exponents][modes] coupled: eta = rr Re z + ri Im z */
    size_t *owner;   /* [exponents] mode of an exponent: eta = sum of Re z; NULL if coupled */
};

/* Velocity of a sliding contact, force of a held contact, N of a normal, or part of a limit: Re(sum c_p z_p) + constant + ramp t,
 * of N also + square t^2. First the terms z_p of the exponents, then the terms of the harmonics: z = e^{i Omega t}, c = response. */
struct output {
    size_t contact;
    double *cr, *ci, *size; /* [terms] c_p, |c_p| */
    const double
        *on_rate; /* [shapes] held, normal: per eta, ramp per eta'; sliding: velocity per eta', ramp per eta''; of a limit
                              NULL */
};

/* Forcing of the modes: a harmonic or table of the system; or a harmonic or table of the limit of one contact that does not hold,
 * for the force f = limit of this contact. */
struct forcing {
    double omega;
    size_t harmonic, contact; /* harmonic: index in the system; contact: of the limit, else ncontact */
    size_t table;             /* 1 + the shape of a table; 0: a harmonic */
};

/* The structure under the loads of the system. Shapes: the modes, then a shape for each part, cosine or sine, of a harmonic of
 * bases: the velocities of the structure, with Phi'M y = 0, for eta' = e^{i Omega t} or i e^{i Omega t}; or for bases of
 * constant speed, if steady: eta' = 1; or for a table of bases: eta' is its value. Last, a shape without displacements for each
 * other table: eta is the value of the table less that at t0. */
struct forced {
    struct modal *modal;
    struct modal_store store;
    size_t shapes;
    int steady;
    size_t within[2];        /* first and end of the degrees of freedom of phi */
    double *phi, *on, *by_u; /* of the modal, with further rows, or columns, [shapes] */
    double *speed;           /* [shapes] eta' of a shape for bases of constant speed, 1; else 0 */

    size_t harmonics;        /* the harmonics of the system, in order, then harmonics of limits */
    struct forcing *forcing; /* [harmonics] */
    double complex *g, *x;   /* [harmonics][modes] forcing of eta; [harmonics][shapes] response eta; of tables 0, and
                                g of a table of bases: forcing per eta of its shape + i forcing per eta' */
    double
        *constant; /* [modes] constant forcing: by constant loads, by damping of y0, by damping of eta' = ramp/omega^2; with K~:
                         eta' = K~^-1 ramp */
    double *ramp;  /* [modes] rate of the forcing by bases of constant speed */
    unsigned char *resonant; /* [harmonics][modes] 1: the response is not in x, since the divisor is close to 0; NULL: none */
    double resonates;        /* largest Omega of these */

    size_t terms;            /* exponents, harmonics, and zeros up to a multiple of TRIBO_TERMS; not 0 */
    double *lr, *li, *size;  /* [terms] lambda (harmonics: i Omega); |lambda| */
    double *sixth;           /* [terms] |lambda|^6 */
    size_t outputs, sliding; /* output [0, sliding): velocities; [sliding, holding): forces of contacts that hold */
    size_t holding;          /* output [holding, limits): N of the normals, in their order */
    size_t limits; /* output [limits, outputs): parts of limits by functions of time, of all contacts, if there are any */
    struct output *output;
    double quickest;      /* largest |lambda| of exponents and harmonics; without modes a bound of these */
    double decay, growth; /* largest -Re lambda; largest Re lambda; at least 0 */
};

/* Returns |re + i im|, without hypot where the square is safe: hypot takes ten times as long. */
static inline double tribo_modal_magnitude(double re, double im)
{
    const double square = re * re + im * im;
    return square > 1e-280 && square < 1e300 ? sqrt(square) : hypot(re, im);
}

/* Returns the number of degrees of freedom within. */
static inline size_t tribo_modal_wide(const size_t *within)
{
    return within[1] - within[0];
}

/* Returns 1 if mode k has omega = 0 and no damping. */
static inline int tribo_modal_drifts(const struct modal *h, size_t k)
{
    return h->omega2[k] == 0.0 && h->damping[k] == 0.0;
}

/* Creates *modal, if it is NULL, the structure with all contacts at rest, slip[i] = 0, held; and forced, if it is NULL, by the
 * loads. key: of tribo_follow_key. powers = 1: without modes, which takes a small part of the time, where no base moves at a
 * constant speed and no limit varies; like: NULL, or such a structure without rigid contacts that hold, for its coordinates.
 * KEY_HOLDS: set H of stick_slip.h; other contacts at rest depend on H. Returns a status, message on the system's context; after
 * an error *modal and forced stay NULL. Every user of the structure besides the first one adds 1 to users. tribo_modal_free frees
 * h->forced, too, and takes NULL; tribo_forced_free frees h->forced, which may be NULL. */
int tribo_modal_create(struct modal **modal, tribo_system *sys, const signed char *slip, const signed char *key, int powers,
                       const struct modal *like);
void tribo_modal_free(struct modal *h);
void tribo_forced_free(struct modal *h);

/* follow.c. side: sign of the force of a contact with this key that slides, or is tied, at a limit that follows; else 0. spring:
 * the force of compliant contact i changes by the returned factor times row *row of `on`. slide: force [ncontact][columns] =
 * forces of contacts with a side by way [ncontact][columns] = J q. */
double tribo_follow_side(signed char key);
double tribo_follow_spring(const tribo_system *sys, const struct modal *h, size_t i, size_t *row);
void tribo_follow_slide(const tribo_system *sys, const signed char *key, size_t columns, const double *way, double *force);

/* Returns c of the part Re(c z) of term p in place'eta + speed'eta', place, speed [shapes] or NULL. */
double complex tribo_forced_weight(const struct forced *f, size_t p, const double *place, const double *speed);

#endif
