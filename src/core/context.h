/* What the files of src/core share. */
#ifndef TRIBO_CONTEXT_H
#define TRIBO_CONTEXT_H

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "tribo/tribo.h"

#include "core/operator/operator.h"
#include "core/law/law.h"
#include "core/planar/planar.h"
#include "common/layout.h"
#include "common/compiler.h"
#include "common/plural.h"
#include "common/real.h"
#include "common/simd.h"

struct message;

/* Whether all contacts of a chunk have the same width and rate, and also those of the chunk before. */
enum { UNEVEN, EVEN, EVEN_AS_BEFORE };

/* What of a chunk's contacts changes with settings only. */
struct chunk {
    double least, largest; /* limit */
    double widest;         /* width */
    double band;           /* no epsilon of a contact that is not open is larger; negative if all are open */
    double quickest;       /* R_ii */
    size_t like;           /* from this contact on 1/R_ii are the same: the first of all such chunks, which is near as a rule */
    int plain;             /* 1/R_ii are TRIBO_PLAIN at most */
    int even;              /* UNEVEN, ... */
    int alike;             /* all have the same width, rate, and limit, above 0 */
    size_t model;          /* from this contact on widths and rates are the same, and limits if alike: see like */
};

/* From this number of contacts on an output does not stay in any cache. */
#define TRIBO_MANY ((size_t)1 << 22)

static inline size_t tribo_chunks(size_t n)
{
    return (n + TRIBO_CHUNK - 1) / TRIBO_CHUNK;
}

/* What a contact did in the last call that found forces: it slid towards v < 0 or v > 0, which is to say that its force is its
 * limit; or its force is stored in f. Before limits change slips take the place of that, with the same numbers (see
 * tribo_get_slip): 0 for stuck, and TRIBO_SLIP_OPEN. */
enum { STORED = TRIBO_SLIP_STUCK };

/* Of how many contacts of a chunk the force is stored; of all only if they say so. */
enum { NONE_STORED, SOME_STORED, ALL_STORED };

struct deeds {
    signed char *of;       /* [n] */
    unsigned char *stored; /* [chunks] */
    int all_stored;        /* the forces of all contacts are */
};

/* What is known of the slips of the last call: nothing, or they follow from forces and limits, or they are written down. */
enum { NO_SLIPS, SLIPS_IN_FORCES, SLIPS_WRITTEN };

/* How a contact lets go: at the limit by which it slides; or at a static one, which then drops at once, or falls with speed. */
enum { NEVER, DROPS, FALLS };

/* What the caller set. */
struct settings {
    const struct law *law;
    int coupling, sharing;
    double step, lambda_dt; /* tribo_set_epsilon_step; step 0: epsilon was given */
    double *limit;          /* [n] */
    double *width, *rate;   /* [n] see law.h; of an epsilon that follows the operator, what follows from that */
    int breaking;           /* DROPS or FALLS: limits are those of static.c; NEVER: the following is not read */
    double *ratio;          /* [n] static limit to limit */
    double *stribeck;       /* [n] FALLS: velocity scale */
};

/* What follows from settings and operator. */
struct following {
    struct contacts contacts;        /* all of them, as laws see them; of far limits with what is cut: */
    double *cut_limit, *cut_factor;  /* [n] limits as the solver takes them, and widths or rates, whichever multiply them */
    double *hold, *hold_width, *now; /* [n] with static limits: these; epsilon; the limits of the last call. cut_limit, cut_factor
                                        are then the limits by which contacts slide, and rates */
    double largest, steepest;        /* limit; and factor, or 1 */
    struct chunk *chunk;             /* [chunks] */
};

/* What the last call found. */
struct last {
    struct deeds did;
    double *feq, *f;         /* [n] f where it is stored */
    double *v;               /* [n] velocities, and the law's derivatives there, after tribo_balance_tangent */
    struct tangent *tangent; /* [n] */
    int slips;               /* NO_SLIPS, ... */
    double holds;            /* a contact is stuck if |f| is less than this part of the limit */
    int linearized;          /* tangent is that of the last call */
    int far;                 /* a limit or a bound was so large that solutions may be beyond op->most */
    double residual;
    size_t rank;
};

/* What adds up since tribo_create, but for what the solver counts. */
struct counters {
    size_t solves, reused, skipped, marks;
};

struct tribo_context {
    size_t n;
    int fixed; /* the operator cannot be changed */
    struct settings set;
    struct following follow;
    struct delassus *op;   /* constant; clones have it in common */
    struct memory memory;  /* of the groups, from call to call */
    struct planar *planar; /* NULL: all contacts are scalar */
    struct plane plane;
    const size_t *group_of; /* [n] the group in which a box is solved for, or TRIBO_ALONE */
    unsigned char *moving;  /* [n] reversal memory */
    struct last last;
    struct deeds spare; /* room for the next call */
    struct counters count;
    size_t revision; /* counts changes of settings and operator */
    struct message *message;
};

/* message.c: keeps the text for tribo_message and returns status. ctx NULL: keeps nothing, as calls on a const context. */
int tribo_fail(tribo_context *ctx, int status, const char *format, ...)
#if defined(TRIBO_GNU_C)
    __attribute__((format(printf, 3, 4)))
#endif
    ;
size_t tribo_message_size(void); /* one of zeros is empty */

/* Contacts of the chunk that begins with i. */
static inline size_t tribo_chunk_size(const tribo_context *ctx, size_t i)
{
    return ctx->n - i < TRIBO_CHUNK ? ctx->n - i : TRIBO_CHUNK;
}

/* The contacts of the chunk that begins with i, as laws see them. */
static inline struct contacts tribo_chunk_contacts(const tribo_context *ctx, size_t i)
{
    const struct chunk *chunk = &ctx->follow.chunk[i / TRIBO_CHUNK];
    const struct contacts *c = &ctx->follow.contacts;
    const size_t limits = chunk->alike ? chunk->model : i;
    return (struct contacts){
        c->limit + limits, c->bound + limits, c->width + chunk->model, c->rate + chunk->model, c->moving + i, c->follows,
        c->scales,         chunk->alike};
}

/* Bounds of contacts; lower NULL: -upper. */
struct bounds {
    const double *lower, *upper;
};

static inline double tribo_lower(const struct bounds *b, size_t i)
{
    return b->lower ? b->lower[i] : -b->upper[i];
}

static inline struct bounds tribo_bounds_from(const struct bounds *b, size_t i)
{
    return (struct bounds){b->lower ? b->lower + i : NULL, b->upper + i};
}

/* check.c: whether all numbers are finite, and none is larger than most, which is finite. Whatever they are, no floating-point
 * exception is raised. */
int tribo_all_within(const double *x, size_t n, double most);

/* The same of two arrays: 1 for x, and 2 for y. Memory gives more if it is asked for both at once. */
int tribo_two_within(const double *x, double most_x, const double *y, double most_y, size_t n);

/* TRIBO_OK, or a failure that names the argument, the first offending contact and its value. */
int tribo_fail_not_finite(tribo_context *ctx, const char *name, const double *x, size_t n);

int tribo_check_nonnegative(tribo_context *ctx, const char *name, const double *x, size_t n);
int tribo_check_positive(tribo_context *ctx, const char *name, const double *x, size_t n);

/* TRIBO_OK, or a failure that tells which call is missing: there is no operator, or none that epsilon could follow. */
int tribo_fail_without_operator(tribo_context *ctx);

/* settings.c: brings what follows from settings and operator up to date: after a change of limits; or of anything, then with
 * width and rate of an epsilon that follows the operator. */
void tribo_refresh_limits(tribo_context *ctx);
void tribo_refresh(tribo_context *ctx);

/* classify.c: copies the limits of a chunk's contacts, n > 0, and finds the least and the largest. */
void tribo_take_limits(size_t n, const double *from, double *to, struct chunk *chunk);

/* Returns epsilon of the n contacts from i on, n <= TRIBO_CHUNK; room [n]. */
const double *tribo_epsilons(const struct contacts *c, size_t i, size_t n, double *room);

/* All forces of this call will be stored. */
void tribo_store_all(tribo_context *ctx);

/* Checks v and a, and finds the contacts near stick; a status, and on failure all is as after the last call. */
int tribo_classify(tribo_context *ctx, const double *v, const double *a);

/* f of contacts that need no solver, where ctx->last.f is to hold it, and their f_eq, or that of all contacts if wanted, as if
 * all were alone. */
void tribo_forces_alone(tribo_context *ctx, const double *v, const double *a, int wanted);

/* f_eq [n] of the contacts of the chunk that begins with i, as if all were alone; 0 for open ones. */
void tribo_find_feq(const tribo_context *ctx, size_t i, size_t n, const double *a, double *feq);

/* No contact of chunk k that is faster is near stick; and whether any of n contacts is not. What they did if none is. */
double tribo_widest_band(const tribo_context *ctx, size_t k);
int tribo_any_in_band(size_t n, const double *v, double band);
void tribo_find_directions(size_t n, const double *v, signed char *did);

/* alone.c: the whole of tribo_balance and tribo_step_force, where tribo_all_alone. f_eq and f of the balance may be NULL. */
int tribo_balance_alone(tribo_context *ctx, const double *v, const double *a, double *feq, double *f);
int tribo_step_alone(tribo_context *ctx, double dt, const double *v, double *f);

/* Forces over a step of dt of the n contacts of chunk k that share no body: what stops them, within the bounds of these n. */
void tribo_stop_alone(const tribo_context *ctx, size_t k, double dt, const double *v, struct bounds b, double *f);

/* 1/R_ii of the contacts of chunk k. */
static inline const double *tribo_inverses(const tribo_context *ctx, size_t k)
{
    return ctx->op->inverse + ctx->follow.chunk[k].like;
}

/* The forces of all contacts, f [n], while limits are those of the balance; or of one. */
void tribo_forces(const tribo_context *ctx, double *f);

/* The steepest that the law of contact i relaxes by: with its static limit, if it has one. */
static inline double tribo_steepest_slope(const tribo_context *ctx, size_t i)
{
    const struct contacts *c = &ctx->follow.contacts;
    return ctx->set.breaking ? c->rate[i] * ctx->follow.hold[i] : tribo_slope_of(c, i);
}

static inline double tribo_force_of(const tribo_context *ctx, size_t i)
{
    const int did = ctx->last.did.of[i];
    const double limit = ctx->follow.contacts.limit[i];
    return did == STORED ? ctx->last.f[i] : did == TRIBO_SLIP_FORTH ? -limit : limit;
}

/* static.c: what follows from settings and operator where limits are static. */
void tribo_refresh_static(tribo_context *ctx);

/* Whether a law can do without stick what breaking wants of it; a status. */
int tribo_check_breaking(tribo_context *ctx, const struct law *law, int breaking, const double *ratio);

/* Both directions of a planar contact have one ratio, and one velocity if there are any; a status. */
int tribo_check_one_ratio(tribo_context *ctx, const double *ratio, const double *velocity, size_t count, const size_t *first);

/* For what knows no static limits: fails if there are any. who: "... knows no". */
int tribo_refuse_static(tribo_context *ctx, const char *who);

/* limit [n] = the limits of contacts i, i + 1, ... at v by these f_eq; NULL: those near stick hold. Where limits are static. */
void tribo_find_limits(const tribo_context *ctx, size_t i, size_t n, const double *v, const double *feq, double *limit);

/* The limit by which contact i slides at this speed. */
double tribo_limit_at(const tribo_context *ctx, size_t i, double speed);

/* d(limit)/dv; 0 without a Stribeck velocity. */
double tribo_limit_rate(const tribo_context *ctx, size_t i, double v);

/* The law's derivatives for contacts i, i + 1, ..., of which c is a view. */
void tribo_law_tangents(const tribo_context *ctx, const struct contacts *c, size_t i, size_t n, const double *v,
                        const double *feq, const struct tangents *d);

/* static.c. The second: over a step of dt all contacts hold, for now, but those that come in sliding at v [n]; v NULL: nobody
 * knows who does. Where f [n], or NULL, does not act against v, a contact has come to a stop on the way, and holds from there on.
 * The first: whether there is one. */
int tribo_any_turns(const tribo_context *ctx, double dt, const double *v, const double *f);
void tribo_hold_for_step(const tribo_context *ctx, double dt, const double *v, const double *f);

/* The near contacts of a problem hold, for now. */
void tribo_hold(const tribo_context *ctx, const struct box_qp *p);

/* Those that the solution cannot hold, by their f_eq, have the limit by which they slide from here on, at the end of a step of
 * dt or (0) from rest. Returns how many. */
size_t tribo_break_away(tribo_context *ctx, const struct box_qp *p, double dt);

/* The same for contacts in no group, from their forces with static limits; these become right. */
void tribo_break_alone(tribo_context *ctx, double dt, const double *vfree);

/* queries.c: writes slips down, before limits change. */
void tribo_write_slips(tribo_context *ctx);

/* The force of the contact at place k of a group as the solver takes it. */
static inline double tribo_carried(const tribo_context *ctx, const struct box_qp *p, size_t k)
{
    const double f = tribo_force_of(ctx, p->member[k]);
    return ctx->last.far ? tribo_cut(p, k, f) : f;
}

/* step.c: solves v_end = v + dt R f for all contacts, f [n]; known [n], or NULL for none: not 0 for scalar contacts of
 * clusters that have a force already, there. */
int tribo_solve_step(tribo_context *ctx, double dt, const double *v, struct bounds b, const signed char *known, double *f);

/* tribo_step_force, of arguments that are checked; v as in tribo_hold_for_step. */
int tribo_step_at_end(tribo_context *ctx, double dt, const double *v, const double *vfree, double *f);

/* Views of group k. */
static inline struct box_qp *tribo_problem(tribo_context *ctx, size_t k)
{
    return tribo_memory_problem(ctx->op, &ctx->memory, k);
}

/* Whether every contact can be looked at by itself, at the limit that is set. */
static inline int tribo_all_alone(const tribo_context *ctx)
{
    return !ctx->op->groups && !ctx->planar && !ctx->set.breaking;
}

/* planar.c: contacts and clusters for an operator that op is to become, and their taking the place of the old ones. */
int tribo_planar_prepare(tribo_context *ctx, size_t count, const size_t *first, const struct delassus *op, struct memory *m,
                         struct planar **planar, struct plane *plane);
void tribo_planar_install(tribo_context *ctx, struct planar *planar, const struct plane *plane);

/* Groups, with what planar contacts join counted as one, and single contacts. */
static inline size_t tribo_islands(const tribo_context *ctx)
{
    return ctx->planar && ctx->op->diagonal ? ctx->planar->islands : ctx->op->islands;
}

/* planar_force.c, for contexts with planar contacts: forces of the clusters, once those of all others are known, in
 * ctx->last.f; a status. f_eq of their contacts. */
int tribo_planar_balance(tribo_context *ctx, const double *v, const double *a);
int tribo_planar_step(tribo_context *ctx, double dt, const double *vfree, const signed char *known);
void tribo_planar_feq(tribo_context *ctx, const double *a);

/* Forces f of planar contacts whose f_eq is known, which where it matters must be finite; a status. */
int tribo_planar_check_feq(const tribo_context *ctx, tribo_context *note, const double *v, const double *feq);
int tribo_planar_force(const tribo_context *ctx, const double *v, const double *feq, double *f);

/* What is given of planar contact k at v and f_eq, [2] each; and near stick the point of its lens that is nearest to
 * f_eq - kappa, as R_d measures it: x->p.y, in parts of limits. 1, or 0 without convergence. */
void tribo_planar_given(const tribo_context *ctx, size_t k, const double *v, const double *feq, struct given *g);
int tribo_planar_given_near(const tribo_context *ctx, size_t k, const struct given *g, const double *feq, struct disc_alone *x);

/* Derivatives of these forces, [n][2] each or NULL; a status. */
int tribo_planar_blocks(const tribo_context *ctx, const double *v, const double *feq, double *df_dv, double *df_dfeq,
                        double *df_dlimit);

/* R f at place k of a cluster, with the contact's own force or without it. */
double tribo_planar_feels(const tribo_context *ctx, const struct cluster *g, size_t k, int own);

/* What planar contact k did in the last call; and slip of the directions of all. */
signed char tribo_planar_slip(const tribo_context *ctx, size_t k);
void tribo_planar_slips(const tribo_context *ctx, signed char *slip);

/* The rate at which planar contact k relaxes. */
double tribo_planar_rate(const tribo_context *ctx, size_t k);

/* The problem of a cluster: the contacts in it, which are near stick at v: returns whether there are any. The last one of these,
 * at a. The units of force and R in it. */
struct unit {
    double force, r;
};
int tribo_planar_collect(tribo_context *ctx, const struct cluster *g, const double *v);
void tribo_planar_resume(tribo_context *ctx, const struct cluster *g, const double *a);
struct unit tribo_planar_units(const tribo_context *ctx, const struct cluster *g);

/* planar_reach.c: what stands for the limit of direction i in the problem, so that it is no farther from the force than numbers
 * tell: at most the limit, and where it is less, which is where cut says so, the force is within it. */
static inline double tribo_planar_reach(const tribo_context *ctx, size_t i)
{
    return lesser(ctx->follow.contacts.bound[i], ctx->plane.radius[i]);
}
static inline int tribo_planar_cut(const tribo_context *ctx, size_t i)
{
    return ctx->plane.radius[i] < ctx->follow.contacts.bound[i];
}

/* Which directions of the problem share a set, and their shift in parts of the reach. */
void tribo_planar_arrange(tribo_context *ctx, const struct cluster *g);

/* pull [size] += what the shifts of contacts, [size], and their own blocks of R make of it. */
void tribo_planar_turn(const tribo_context *ctx, const double *shift, double *pull);

/* Finds the reach of all contacts of the problem from what pulls at them. */
void tribo_planar_estimate(tribo_context *ctx, const struct cluster *g);

/* Widens the reach that forces of the solution come up against; returns how many directions did. */
size_t tribo_planar_widen(tribo_context *ctx, const struct cluster *g);

/* The force of a planar contact that is not near stick. */
void tribo_planar_slide_force(const struct law *law, const struct slide *s, const double *limit, double *f);

/* R f + a at place k of a cluster without the forces of the contact that begins at place from; all of them: directions 0. */
double tribo_planar_others(const tribo_context *ctx, const struct cluster *g, size_t k, size_t from, size_t directions, double a);

/* planar_static.c, where limits are static: limit [2] of the planar contact at i: those to stick, or by which it slides at v. */
void tribo_planar_limits(const tribo_context *ctx, size_t i, int holds, const double *v, double *limit);

/* What laws see of the planar contact at i, with limits to stick; its limits become limit [2]. */
struct contacts tribo_planar_view(const tribo_context *ctx, size_t i, double *limit);

/* Contacts of a cluster near stick at v hold, for now, the others have the limit by which they slide. */
void tribo_planar_hold(tribo_context *ctx, const struct cluster *g, const double *v);

/* Those that the solution cannot hold slide from here on, at the end of a step of dt from v = 0, or (0) from rest; returns how
 * many. a [n] is what pulls. */
size_t tribo_planar_break(tribo_context *ctx, const struct cluster *g, double dt, const double *a);

/* What changes about all contacts, [n] each, or NULL for nothing. */
struct change {
    const double *v, *a, *limit;
};

static inline double tribo_entry(const double *x, size_t i)
{
    return x ? x[i] : 0.0;
}

/* An open contact stays open. */
static inline double tribo_limit_change(const tribo_context *ctx, const struct change *d, size_t i)
{
    return ctx->set.limit[i] > 0.0 ? tribo_entry(d->limit, i) : 0.0;
}

/* The same in parts of the limit that it goes by. */
static inline double tribo_limit_growth(const tribo_context *ctx, const struct change *d, size_t i)
{
    const double limit = ctx->follow.contacts.limit[i];
    return limit > 0.0 ? quotient(tribo_entry(d->limit, i), limit) : 0.0;
}

/* planar_tangent.c: the derivatives of a cluster's forces at the last tribo_balance_tangent. */
void tribo_planar_linearize(tribo_context *ctx, const double *v, const double *a);
void tribo_planar_columns(tribo_context *ctx, double *df_dv, double *df_da);
void tribo_planar_product(tribo_context *ctx, const struct change *d, double *df);

/* balance.c: what calls that find forces have in common. Begins one: nothing is solved yet. */
void tribo_begin_call(tribo_context *ctx);

/* Solves the problem of a group; q, lo and hi are set. */
int tribo_solve_group(tribo_context *ctx, struct box_qp *p);

/* Keeps forces for shares that go on from them, also in groups that no solver saw. */
void tribo_remember_forces(tribo_context *ctx);

/* The contacts of group k in the problem's order, those near stick first. */
struct box_qp *tribo_collect(tribo_context *ctx, size_t k);

/* memcpy, but fine with NULL for no elements. */
static inline void tribo_copy(double *to, const double *from, size_t n)
{
    if (n) {
        memcpy(to, from, n * sizeof *to);
    }
}

#endif
