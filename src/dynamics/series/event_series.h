/* SPDX-License-Identifier: BSD-3-Clause */
/* The Taylor series of the motion of method "event". Between events the motion is smooth; its coefficients follow from the
 * equations of motion, by one product with the structure's matrices and one solve for the holding contacts an order. */
#ifndef TRIBO_EVENT_SERIES_H
#define TRIBO_EVENT_SERIES_H

#include "dynamics/events/events.h"

/* Workspace. */
struct event_room {
    double *acceleration; /* [ndof] */
    double *base;         /* [ncontact], as the others */
    double *a;
    double *given;
    double *held;
    double *rate;
};

/* Series of a contact in a plane. The direction u, |u| = 1, of the force -weight g u is along n and the normal
 * t = (-n[1], n[0]). */
struct line {
    size_t at;         /* its first direction */
    double weight[2];  /* 1 with a spring */
    double n[2], t[2]; /* n: first direction of x */
    int asymptotic;    /* 1: series of perturbations do not converge */
    double *un, *ut;   /* [order + 2], as the arrays below but square: coefficients of u along n and t */
    double *xn, *xt;   /* x = weight v */
    double *speed;     /* |x|; with a spring the speed of the slider */
    double *g;         /* limit over weight */
    double *square;    /* [2 order + 1] |x|^2/time^(2s); of a contact at rest half the larger limit times |force/limit|^2 */

    /* with a spring before the slider: pair_series.c */
    size_t follows; /* 1: the force follows v, from a limit that is 0 or small; 0 of rigid contacts */
    int fades;      /* 1: the limit ends at 0, and is so small that u may stay */
    double *a;      /* u' = a r, r the normal of u */
};

struct lines {
    size_t count;      /* number of contacts in planes: all are rigid, or all have springs */
    size_t room;       /* for such contacts */
    double given;      /* > 0: un and ut are given for a step of this length, and all sliding contacts slide already */
    struct line *line; /* [count]; owns the memory of all; freed by method_event.c */
    size_t begins;     /* number of rigid contacts that begin to slide */
    size_t begin_room; /* for such contacts */
    size_t *begin;     /* [begins] these contacts */
    int *pivot;        /* [begins] */
    double *s, *lu;    /* [begins][begins] S, S + D */
    double *tau;       /* [begins] */
    double *answer;    /* [begins][ndof] q'' by unit t-parts */
    double *held;      /* [begins][ncontact] holding forces by unit t-parts */
};

#define TRIBO_CREEP_NODES 8

struct creep {
    double length;                                      /* of the next such step; 0: unknown */
    size_t waited, wait;                                /* steps since contacts creep, and number of steps to wait */
    size_t count, room;                                 /* sliding planar contacts, and room for them */
    double basis[TRIBO_CREEP_NODES][TRIBO_CREEP_NODES]; /* [node][power] of the polynomial that is 1 there, 0 at other nodes */
    double *weight;   /* [terms][node][node] effect at the first node of a force basis[second] that acts by time^term, in steps;
                         owns the memory of the members below; freed by method_event.c */
    double *angle;    /* [room][node] of u, from n of its line */
    double *u;        /* [room][node][2] cosine and sine of angle */
    double *response; /* [2 count][terms][2 count] series of x along n and t by u = n or t */
    size_t *slides;   /* [room] these contacts */
    int *pivot;       /* [room NODES] */
    double *matrix;   /* [room NODES][room NODES] Newton's */
    double *rest;     /* [room NODES] its right-hand side */
};

struct event {
    tribo_driver *drv;
    tribo_system *sys;
    struct events events;
    size_t order;              /* of the series of a phase */
    size_t most_order;         /* room */
    double tolerance;          /* relative */
    double abstol;             /* that of the driver when tolerance was found */
    double fastest;            /* bound of the frequencies of the motion, without growth by falling friction */
    size_t revision;           /* of the system that fastest is of */
    size_t planes;             /* planar contacts when order was found */
    double moves[3];           /* change of q, u and d within the time of the fastest motion; if abstol = 0 */
    double error;              /* allowed in velocities where planar contacts slide */
    double length;             /* of the step, and of the interval of bounds */
    double *q, *u;             /* [order + 1][ndof] coefficients of the powers of time of displacements and velocities; q owns the
                                  memory of the arrays below; NULL: revision, abstol and what follows from them are not set */
    double *watch;             /* [order + 1][ncontact] velocities of sliding contacts, forces of contacts at rest */
    double *limit;             /* [order + 1][ncontact] limits, below 0 where a contact has lifted off */
    size_t terms;              /* number of rows of limit that are not zero */
    double *slide;             /* [order + 1][ncontact] limits to slide: limit, or fall */
    size_t slide_terms;        /* number of rows of slide that are not zero */
    double *fall, *part;       /* [order + 1][ncontact] limits that fall with the speed; exp(-|v|/velocity) */
    double *d;                 /* [order + 1] dissipated energy */
    double *force;             /* [order + 1][ncontact] forces of compliant contacts, and of contacts that slide in a plane */
    struct curve *curve;       /* [ncontact] watch; squares of planar contacts */
    struct curve *limit_curve; /* [ncontact] limit */
    struct event_room room;
    struct lines lines;
    struct creep creep;
};

/* Number of rows of limit that are not zero, up to the order. */
static inline size_t tribo_event_limit_terms(const struct event *e)
{
    return e->terms <= e->order ? e->terms : e->order + 1;
}

/* Coefficient k of a product of series, the sum of x_j y_(k - j) for from <= j < to; coefficients are stride doubles apart. */
static inline double tribo_series_product(const double *x, const double *y, size_t stride, size_t k, size_t from, size_t to)
{
    double sum = 0.0;
    for (size_t j = from; j < to; j++) {
        sum += x[j * stride] * y[(k - j) * stride];
    }
    return sum;
}

/* The same of coefficients that stand together. */
static inline double tribo_product_of(const double *x, const double *y, size_t k, size_t from, size_t to)
{
    return tribo_series_product(x, y, 1, k, from, to);
}

/* The same of a square, of a series with the powers up to `last`. */
static inline double tribo_series_square(const double *x, size_t stride, size_t k, size_t last)
{
    return tribo_series_product(x, x, stride, k, k < last ? 0 : k - last, k < last ? k + 1 : last + 1);
}

/* Returns the value at h of a series x [powers + 1]. */
static inline double tribo_series_value(const double *x, size_t powers, double h)
{
    double sum = 0.0;
    for (size_t k = powers + 1; k-- > 0;) {
        sum = sum * h + x[k];
    }
    return sum;
}

/* Returns the sum of the sizes of the terms of a series x at h, coefficients stride doubles apart. */
static inline double tribo_series_size(const double *x, size_t stride, size_t powers, double h)
{
    double sum = 0.0;
    for (size_t k = powers + 1; k-- > 0;) {
        sum = sum * h + fabs(x[k * stride]);
    }
    return sum;
}

/* Returns h, shortened to a part of the radius of convergence of 1/x, x [powers + 1]; inverse [powers + 1]: workspace. */
double tribo_series_within(const double *x, size_t powers, double *inverse, double h);

/* Error of a direction in a periodic motion: that of perturbations. */
#define TRIBO_STRAIGHT 1e-8

/* Returns the limit by which the guard (|f|^2 - limit^2)/2 of a contact at rest is divided: the least one of the step, not below
 * a part of the largest one, `most`. */
double tribo_series_reference(double least, double most);

/* Finds the coefficients of the motion from (t, y) on: first those known at the start, then the series, which collocation
 * repeats with other directions of sliding forces. Returns a status. */
int tribo_event_start(struct event *e, double t, const double *y);
int tribo_event_series(struct event *e);

/* Energy that sliding contact i dissipates until tau; own: struct event. */
double tribo_event_work(void *own, size_t i, double tau);

/* Moves perturbations v [2 ndof + compliant contacts][columns] of the state by tau in the phase. As transition of struct
 * motion. */
int tribo_event_transition(void *own, const void *phase, double tau, size_t columns, double *v, const struct source *source);

/* method_event.c: returns the length of the step on which the last two terms of all series are below the tolerance; sets
 * plane->error. */
double tribo_event_length(struct event *e);

/* A step ends where the speed of a planar contact falls to this part: at a small speed the direction turns fast, and a stop is
 * approached in ever shorter steps. */
#define TRIBO_SLOWER 1e-2

/* ------------------------------------------------------------------------------------------------------ planar_series.c */

/* Makes room for e->lines, and for `begins` contacts that begin to slide. Returns a status, its message on the system's
 * context, as functions below. */
int tribo_lines_reserve(struct event *e, size_t begins);

/* Sets n = (x, y), and its normal t. */
void tribo_line_set_direction(struct line *l, double x, double y);

/* Component d of u and of its normal r, of order j. */
static inline double tribo_line_along(const struct line *l, size_t d, size_t j)
{
    return l->n[d] * l->un[j] + l->t[d] * l->ut[j];
}

static inline double tribo_line_across(const struct line *l, size_t d, size_t j)
{
    return l->t[d] * l->un[j] - l->n[d] * l->ut[j];
}

/* f [2] = the force of contact l, of order k, from coefficients of g of the orders from <= j < to. */
void tribo_line_force(const struct line *l, size_t k, size_t from, size_t to, double *f);

/* The least time in which friction would stop a planar contact that slides already; HUGE_VAL if there is none. */
double tribo_planar_series_first_stop(const struct stick_slip *m);

/* Sets the order for a phase; makes room; finds S for contacts that begin to slide. Returns a status. */
int tribo_planar_series_begin(struct event *e);

/* Takes the k-th coefficients v [ncontact] of velocities, and sets those to 0 that are before contacts slide; sets coefficients
 * of sliding forces e->force and room.given, without the t-parts of contacts that begin to slide. */
int tribo_planar_series_forces(struct event *e, size_t k, double *v);

/* Finds these t-parts, and adds their effect to the k-th coefficients e->force, room.acceleration and room.held. room.base: those of
 * accelerations of bases. */
int tribo_planar_series_finish(struct event *e, size_t k);

/* Adds the guards of planar contacts: speed, or the force at rest. */
void tribo_planar_series_guards(struct event *e);

/* Sets plane->error [ncontact]: error of velocities, at most e->error. */
void tribo_planar_series_errors(struct event *e);

/* Returns a bound, until tau, of the largest deceleration of planar contact k by its friction along a direction. */
double tribo_planar_series_brake(const struct event *e, size_t k, double tau);

/* Returns h, shortened until the velocities of contacts at h are right to plane->error, by the difference between the series of u
 * and x/|x|, and no speed grows so much that it is lost in rounding. */
double tribo_planar_series_shorten(const struct event *e, double h);

/* Terms x^(k) tau^k/k! of perturbations of the state. Arrays are [...][columns]; [rows] holds the last orders, order k in row
 * k % rows; arrays without it hold one order. Loads and bases do not depend on the state. */
struct perturbed {
    size_t columns;
    size_t rows; /* 1; more than order + 1 of the series where forces turn, or limits fall */
    double tau;
    double power;    /* tau^(k - 1) */
    double *project; /* [ndof][ndof] projection onto accelerations that leave holding contacts at rest */
    double *q, *u;   /* [ndof] */
    double *next;    /* [ndof] workspace */
    double *spring;  /* [ncontact] forces of compliant contacts */
    double *force;   /* [ncontact] forces by limits that fall, or follow the motion, and of planar contacts */
    double *v;       /* [rows][ncontact] velocities of contacts */
    double *z, *g;   /* [rows][lines] turns of directions u; limits that follow */
    double *w;       /* [lines] workspace */
    double *drag;    /* [ndof] workspace, one column: AC q' */
    const struct source *source;
};

/* Rows of z and of g of order k, of contact c of e->lines. */
static inline double *tribo_turn_of(const struct event *e, const struct perturbed *p, double *rows, size_t k, size_t c)
{
    return rows + (k % p->rows * e->lines.count + c) * p->columns;
}

/* force [ncontact][columns] += terms of order k of the force of contact c by z and g. */
void tribo_line_turn_force(const struct event *e, size_t c, size_t k, const struct perturbed *p, double *force);

/* Sets the k-th terms of turns, and force [ncontact][columns] = those of forces of sliding planar contacts; without the turns of
 * contacts that begin to slide, which finish finds: it adds their effect to the terms of order k + 1 of velocities
 * u [ndof][columns]. */
void tribo_planar_series_turn(const struct event *e, size_t k, const struct perturbed *p, double *force);
int tribo_planar_series_turn_finish(struct event *e, size_t k, const struct perturbed *p, double *u);

/* -------------------------------------------------------------------------------------------------------- pair_series.c */

/* Sets the order for a phase; makes room. Returns a status, its message on the system's context. */
int tribo_pair_series_begin(struct event *e);

/* Sets entries of slide [ncontact], the k-th coefficients of the rates of forces, of pairs with slip TRIBO_SLIP_PLANE, from the
 * k-th coefficients v [ncontact] of velocities. */
void tribo_pair_series_slide(const struct event *e, size_t k, const double *v, double *slide);

/* turn: sets g of order k of all pairs, and, of pairs with slip TRIBO_SLIP_PLANE, z of order k + 1, or k if follows = 1, from
 * terms of order k of q and v. force: sets g of order k and the two rows of force [ncontact][columns], terms of order k, of pairs
 * with slip TRIBO_SLIP_PLANE; for k = 0 and follows = 0 first z, from the part of these rows across u. */
void tribo_pair_series_turn(const struct event *e, size_t k, const struct perturbed *p);
void tribo_pair_series_force(const struct event *e, size_t k, const struct perturbed *p, double *force);

/* Returns h without such contacts, else at most `most`, shortened until forces follow velocities, and in a periodic motion until
 * series of perturbations converge, and do not cancel. */
double tribo_pair_series_shorten(const struct event *e, double h, double most);

/* Adds their guards: the speed of the slider, or the force at rest. */
void tribo_pair_series_guards(struct event *e);

/* ------------------------------------------------------------------------------------------------------ normal_series.c */

/* Sets the k-th coefficients of normal loads, in the rows of their directions, and of limits that follow them; < 0 where a
 * contact has lifted off. */
void tribo_normal_series_expand(struct event *e, size_t k);

/* g [columns] = change of the limit of contact i by perturbations q [ndof][columns] of displacements. */
void tribo_event_perturb_limit(const struct event *e, size_t i, const double *q, size_t columns, double *g);

/* slide [ncontact] = the k-th coefficients of the rates of forces of contacts that slide at limits that follow; 0 of others. */
void tribo_normal_series_slide(const struct event *e, size_t k, double *slide);

/* to [ncontact][columns] = forces of pressed normals, and of contacts that slide, by perturbations x [ndof][columns] of
 * displacements. */
void tribo_normal_series_perturb(const struct event *e, size_t columns, const double *x, double *to);

/* -------------------------------------------------------------------------------------------------------- event_creep.c */

/* Where planar contacts creep, tries steps from (t, y) of at most `most` with directions by collocation. *length = length of the
 * step whose series is found; 0: there is none. Returns a status. */
int tribo_creep_begin(struct event *e, double t, const double *y, double most, double *length);

#endif
