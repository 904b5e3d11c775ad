/* Method "exact": Coulomb's law itself on a linear structure, without time steps. Between events the motion is known in closed
 * form from the modes of the structure with its contacts at rest held (held.h); no event can be skipped (roots.h), since the
 * sixth derivative of a sum of exponentials is at most the sum of their amplitudes times |lambda|^6, which bounds how far it
 * strays from a quintic; and at an event the contacts at rest are decided about anew (modes.h). The energy integral is closed
 * too: a sliding force is constant, so that it dissipates its size times the distance slid. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "driver.h"
#include "held.h"
#include "modes.h"
#include "search.h"
#include "../real.h"

/* Decompositions are dropped when they take more than this. */
#define CACHE_BYTES ((size_t)256 << 20)

/* Over a time this short, in terms of the fastest exponent, three terms of a series are all of it. */
#define CLOSE 1e-6

struct exact {
    tribo_system *sys;
    struct modes modes;
    struct held **held;
    size_t helds, room, bytes, revision;

    /* the phase: it began at t0; amplitudes eta = off + vel t + acc t^2/2 (of modes that drift, from their state) + harmonics +
     * Re(r z) */
    const struct held *h;
    double t0, tau;                          /* tau: where w is */
    double fastest;                          /* exponent or harmonic */
    double *eta, *rate, *off, *vel, *acc;    /* [modes] at t0 */
    double *drift, *drift_rate;              /* [modes] of those that drift: what harmonics do not explain, at t0 */
    double *zr, *zi;                         /* [exponents] at t0 */
    double *wr, *wi, *w1r, *w1i, *w2r, *w2i; /* [exponents] z and its derivatives at tau */
    double *growth, *growth6;                /* [exponents] bounds of |z| and of its sixth derivative over lambda^6 */
    double *cos_t, *sin_t, *cos_0, *sin_0;   /* [harmonics] at t0 + tau, at t0 */
    double *now, *work;                      /* [modes] eta and eta' at tau; workspace */
    double *dq;                              /* [ndof] */
    double slowest, shown;                   /* 1/length of the advance; when the observer looks next */
    struct search search;
};

/* ---------------------------------------------------------------------------------------------- structures that are held */

static void drop_helds(struct exact *x)
{
    for (size_t i = 0; i < x->helds; i++) {
        tribo_held_free(x->held[i]);
    }
    x->helds = 0;
    x->bytes = 0;
    x->h = NULL;
}

static int rests_like(const struct held *h, const struct modes *m, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        if (h->key[i] != (m->mode[i] == 0) + m->holds[i]) {
            return 0;
        }
    }
    return 1;
}

/* Sets x->h to the structure with the contacts of mode 0 held. Those used last are looked at first. */
static int find_held(struct exact *x, tribo_driver *drv)
{
    tribo_system *sys = drv->sys;
    for (size_t i = x->helds; i-- > 0;) {
        struct held *h = x->held[i];
        if (rests_like(h, &x->modes, sys->ncontact)) {
            memmove(x->held + i, x->held + i + 1, (x->helds - 1 - i) * sizeof *x->held);
            x->held[x->helds - 1] = h;
            x->h = h;
            return TRIBO_OK;
        }
    }
    if (x->bytes > CACHE_BYTES) {
        drop_helds(x);
    }
    if (x->helds == x->room) {
        const size_t room = 2 * x->room + 16;
        struct held **more = realloc(x->held, room * sizeof *more);
        if (!more) {
            return tribo_driver_fail(drv, TRIBO_ERR_MEMORY, "out of memory for %zu held structures", room);
        }
        x->held = more;
        x->room = room;
    }
    struct held *h;
    const int status = tribo_held_create(&h, sys, x->modes.mode, x->modes.holds);
    if (status) {
        return tribo_driver_fail(drv, status, "%s", tribo_message(sys->contacts));
    }
    x->held[x->helds++] = h;
    x->bytes += h->bytes;
    x->h = h;
    return TRIBO_OK;
}

/* ----------------------------------------------------------------------------------------------------------- motion */

static double dot(const double *x, const double *y, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += x[i] * y[i];
    }
    return sum;
}

/* (e^{delta tau} - 1)/delta. */
static void ramp_up(double dr, double di, double tau, double *re, double *im)
{
    const double size = hypot(dr, di);
    if (size * tau < 0.5) {
        double tr = tau, ti = 0.0;
        *re = tr;
        *im = ti;
        for (int k = 2; k < 20; k++) {
            const double nr = (tr * dr - ti * di) * tau / k, ni = (tr * di + ti * dr) * tau / k;
            tr = nr;
            ti = ni;
            *re += tr;
            *im += ti;
        }
        return;
    }
    const double e = exp(dr * tau), er = e * cos(di * tau) - 1.0, ei = e * sin(di * tau), square = size * size;
    *re = (er * dr + ei * di) / square;
    *im = (ei * dr - er * di) / square;
}

/* Adds what a resonant harmonic does to an exponent, from nothing at t0 on: z' = lambda z - (i/nu) Re(g e^{i Omega t}). */
static void add_resonance(struct exact *x, const tribo_system *sys, size_t p, size_t s, double tau)
{
    const struct held *h = x->h;
    const double omega = sys->harmonic[s].omega, nu = h->li[p];
    const double c0 = cos(omega * x->t0), s0 = sin(omega * x->t0);
    const double gr = h->gr[s * h->modes + h->owner[p]], gi = h->gi[s * h->modes + h->owner[p]];
    const double e = exp(h->lr[p] * tau), er = e * cos(nu * tau), ei = e * sin(nu * tau);
    double zr = 0.0, zi = 0.0;
    for (int conjugate = 0; conjugate < 2; conjugate++) {
        const double side = conjugate ? -1.0 : 1.0;
        double ur, ui;
        ramp_up(-h->lr[p], side * omega - nu, tau, &ur, &ui);
        /* (g e^{i Omega t0})/2, or its conjugate, times e^{lambda tau} times u */
        const double ar = 0.5 * (gr * c0 - gi * s0), ai = 0.5 * side * (gr * s0 + gi * c0);
        const double br = ar * er - ai * ei, bi = ar * ei + ai * er;
        zr += br * ur - bi * ui;
        zi += br * ui + bi * ur;
    }
    const double yr = zi / nu, yi = -zr / nu; /* times -i/nu */
    const double ct = x->cos_t[s], st = x->sin_t[s];
    const double force = -(gr * ct - gi * st) / nu, rate = omega * (gr * st + gi * ct) / nu;
    const double y1r = h->lr[p] * yr - nu * yi, y1i = h->lr[p] * yi + nu * yr + force;
    x->wr[p] += yr;
    x->wi[p] += yi;
    x->w1r[p] += y1r;
    x->w1i[p] += y1i;
    x->w2r[p] += h->lr[p] * y1r - nu * y1i;
    x->w2i[p] += h->lr[p] * y1i + nu * y1r + rate;
}

static void for_resonances(struct exact *x, const tribo_system *sys, double tau)
{
    const struct held *h = x->h;
    for (size_t s = 0; s < h->harmonics && h->any_resonant; s++) {
        for (size_t p = 0; p < h->exponents; p++) {
            if (h->resonant[s * h->modes + h->owner[p]]) {
                add_resonance(x, sys, p, s, tau);
            }
        }
    }
}

/* e^{lambda delta} of an exponent. */
static void grow(const struct held *h, size_t p, double delta, double *re, double *im)
{
    const double size = h->lr[p] != 0.0 ? exp(h->lr[p] * delta) : 1.0;
    *re = size * cos(h->li[p] * delta);
    *im = size * sin(h->li[p] * delta);
}

/* The same where |lambda delta| is tiny. */
static void grow_little(const struct held *h, size_t p, double delta, double *re, double *im)
{
    const double x = h->lr[p] * delta, y = h->li[p] * delta;
    *re = 1.0 + x + 0.5 * (x * x - y * y);
    *im = y + x * y;
}

/* z and its derivatives, and the harmonics, at t0 + tau: from t0, or, if that is close, from the last look. */
static void look(void *motion, double tau)
{
    struct exact *x = motion;
    const tribo_system *sys = x->sys;
    const struct held *h = x->h;
    const double delta = tau - x->tau;
    const int close = fabs(delta) * x->fastest < CLOSE && !h->any_resonant;
    for (size_t s = 0; s < h->harmonics; s++) {
        const double omega = sys->harmonic[s].omega;
        if (close) {
            const double turn = omega * delta, c = 1.0 - 0.5 * turn * turn, ct = x->cos_t[s], st = x->sin_t[s];
            x->cos_t[s] = c * ct - turn * st;
            x->sin_t[s] = c * st + turn * ct;
        } else {
            const double phase = omega * (x->t0 + tau);
            x->cos_t[s] = cos(phase);
            x->sin_t[s] = sin(phase);
        }
    }
    for (size_t p = 0; p < h->exponents; p++) {
        const double lr = h->lr[p], li = h->li[p], zr = close ? x->wr[p] : x->zr[p], zi = close ? x->wi[p] : x->zi[p];
        double er, ei;
        (close ? grow_little : grow)(h, p, close ? delta : tau, &er, &ei);
        const double wr = zr * er - zi * ei, wi = zr * ei + zi * er;
        const double w1r = lr * wr - li * wi, w1i = lr * wi + li * wr;
        x->wr[p] = wr;
        x->wi[p] = wi;
        x->w1r[p] = w1r;
        x->w1i[p] = w1i;
        x->w2r[p] = lr * w1r - li * w1i;
        x->w2i[p] = lr * w1i + li * w1r;
    }
    for_resonances(x, sys, tau);
    x->tau = tau;
}

/* A guard where look() was. */
static struct sample read_guard(const void *motion, const struct guard *g)
{
    const struct exact *x = motion;
    const tribo_system *sys = x->sys;
    const struct watch *w = g->watch;
    double v0 = g->start + g->ramp * x->tau, v1 = g->ramp, v2 = 0.0;
    for (size_t p = 0; p < x->h->exponents; p++) {
        v0 += w->cr[p] * x->wr[p] - w->ci[p] * x->wi[p];
        v1 += w->cr[p] * x->w1r[p] - w->ci[p] * x->w1i[p];
        v2 += w->cr[p] * x->w2r[p] - w->ci[p] * x->w2i[p];
    }
    for (size_t s = 0; s < x->h->harmonics; s++) {
        const double omega = sys->harmonic[s].omega, ct = x->cos_t[s], st = x->sin_t[s];
        const double re = w->rr[s] * ct - w->ri[s] * st, im = -w->rr[s] * st - w->ri[s] * ct;
        v0 += re;
        v1 += omega * im;
        v2 -= omega * omega * re;
    }
    return (struct sample){g->offset + g->side * v0, g->side * v1, g->side * v2};
}

/* Energy dissipated since t0: a sliding contact's constant force times the distance slid, J dq minus the belt's way. */
static double dissipated(const struct exact *x, const tribo_system *sys, double tau)
{
    const struct matrix *j = &sys->direction;
    double energy = 0.0;
    for (size_t k = 0; k < x->h->sliding; k++) {
        const size_t i = x->h->watch[k].contact;
        double way = 0.0;
        for (size_t e = j->first[i]; e < j->first[i + 1]; e++) {
            way += j->val[e] * x->dq[j->col[e]];
        }
        energy -= x->modes.force[i] * way;
    }
    for (size_t s = 0; s < sys->harmonics; s++) {
        const struct harmonic *w = &sys->harmonic[s];
        for (size_t e = 0; w->moves_base && e < w->count; e++) {
            const double c = w->cosine[e], d = w->sine[e];
            const double way =
                w->omega == 0.0 ? c * tau : (c * (x->sin_t[s] - x->sin_0[s]) - d * (x->cos_t[s] - x->cos_0[s])) / w->omega;
            energy += x->modes.mode[w->index[e]] ? x->modes.force[w->index[e]] * way : 0.0;
        }
    }
    return sys->power * energy;
}

/* eta (into now) and eta' (into work) where look() was. */
static void amplitudes(struct exact *x, const tribo_system *sys)
{
    const struct held *h = x->h;
    const size_t m = h->modes, e = h->exponents;
    for (size_t k = 0; k < m; k++) {
        const double start = h->drifts[k] ? x->drift[k] + x->drift_rate[k] * x->tau : 0.0;
        x->now[k] = x->off[k] + x->tau * (x->vel[k] + 0.5 * x->acc[k] * x->tau) + start;
        x->work[k] = x->vel[k] + x->acc[k] * x->tau + (h->drifts[k] ? x->drift_rate[k] : 0.0);
    }
    for (size_t p = 0; h->owner && p < e; p++) {
        x->now[h->owner[p]] += x->wr[p];
        x->work[h->owner[p]] += h->lr[p] * x->wr[p] - h->li[p] * x->wi[p];
    }
    for (size_t k = 0; !h->owner && k < m; k++) {
        for (size_t p = 0; p < e; p++) {
            const double rr = h->rr[k * e + p], ri = h->ri[k * e + p];
            x->now[k] += rr * x->wr[p] - ri * x->wi[p];
            x->work[k] += rr * (h->lr[p] * x->wr[p] - h->li[p] * x->wi[p]) - ri * (h->lr[p] * x->wi[p] + h->li[p] * x->wr[p]);
        }
    }
    for (size_t s = 0; s < h->harmonics; s++) {
        const double omega = sys->harmonic[s].omega, ct = x->cos_t[s], st = x->sin_t[s];
        for (size_t k = 0; k < m; k++) {
            const double xr = h->xr[s * m + k], xi = h->xi[s * m + k];
            x->now[k] += xr * ct - xi * st;
            x->work[k] -= omega * (xr * st + xi * ct);
        }
    }
}

/* The state at t0 + tau. from is the state at t0; to may be the same. */
static void move_to(struct exact *x, const tribo_system *sys, double tau, const double *from, double *to)
{
    const struct held *h = x->h;
    const size_t n = sys->ndof;
    look(x, tau);
    amplitudes(x, sys);
    memset(x->dq, 0, n * sizeof *x->dq);
    if (to != from) {
        memcpy(to, from, (2 * n + 1) * sizeof *to);
    }
    for (size_t i = 0; i < h->moving; i++) {
        double dq = h->y0[i] * tau, u = h->y0[i];
        for (size_t s = 0; s < h->harmonics; s++) {
            const double omega = sys->harmonic[s].omega, yr = h->yr[s * h->moving + i], yi = h->yi[s * h->moving + i];
            u += yr * x->cos_t[s] - yi * x->sin_t[s];
            dq += omega != 0.0 ? (yr * (x->sin_t[s] - x->sin_0[s]) + yi * (x->cos_t[s] - x->cos_0[s])) / omega : 0.0;
        }
        x->dq[h->dof[i]] = dq;
        to[n + h->dof[i]] = u;
    }
    for (size_t k = 0; k < h->modes; k++) {
        const double *phi = h->phi + k * h->moving, change = x->now[k] - x->eta[k];
        for (size_t i = 0; i < h->moving; i++) {
            x->dq[h->dof[i]] += phi[i] * change;
            to[n + h->dof[i]] += phi[i] * x->work[k];
        }
    }
    for (size_t i = 0; i < h->moving; i++) {
        to[h->dof[i]] += x->dq[h->dof[i]];
    }
    to[2 * n] += dissipated(x, sys, tau);
}

/* ------------------------------------------------------------------------------------------------------------- phases */

/* Amplitudes of eta at t0, split into what the right-hand side makes of it and exponentials. */
static void split_motion(struct exact *x, tribo_system *sys, const double *y)
{
    const struct held *h = x->h;
    const size_t n = sys->ndof, m = h->modes;
    tribo_system_set_time(sys, x->t0);
    for (size_t s = 0; s < h->harmonics; s++) {
        x->cos_0[s] = sys->harmonic[s].cos_t;
        x->sin_0[s] = sys->harmonic[s].sin_t;
    }
    for (size_t k = 0; k < m; k++) {
        const double *psi = h->psi + k * h->moving;
        double q = 0.0, u = 0.0, a = 0.0;
        for (size_t i = 0; i < h->moving; i++) {
            q += psi[i] * y[h->dof[i]];
            u += psi[i] * y[n + h->dof[i]];
            a += psi[i] * x->modes.acceleration[h->dof[i]];
        }
        x->eta[k] = q;
        x->rate[k] = u;
        x->now[k] = a;
    }
    for (size_t k = 0; k < m; k++) {
        /* the constant part of the right-hand side is what the present acceleration leaves */
        const double damping = h->coupling ? dot(h->coupling + k * m, x->rate, m) : h->damping[k] * x->rate[k];
        double force = x->now[k] + damping + h->omega2[k] * x->eta[k];
        for (size_t s = 0; s < h->harmonics; s++) {
            force -= sys->harmonic[s].omega != 0.0 ? h->gr[s * m + k] * x->cos_0[s] - h->gi[s * m + k] * x->sin_0[s] : 0.0;
        }
        x->off[k] = x->vel[k] = x->acc[k] = 0.0;
        if (h->drifts[k]) {
            x->acc[k] = force;
        } else if (h->omega2[k] == 0.0) {
            x->vel[k] = force / h->damping[k];
        } else {
            x->vel[k] = h->ramp[k] / h->omega2[k];
            x->off[k] = force / h->omega2[k];
        }
    }
    for (size_t k = 0; k < m; k++) {
        if (h->omega2[k] != 0.0) {
            x->off[k] -= (h->coupling ? dot(h->coupling + k * m, x->vel, m) : h->damping[k] * x->vel[k]) / h->omega2[k];
        }
    }
    for (size_t k = 0; k < m; k++) {
        double q = x->off[k], u = x->vel[k];
        for (size_t s = 0; s < h->harmonics; s++) {
            const double xr = h->xr[s * m + k], xi = h->xi[s * m + k];
            q += xr * x->cos_0[s] - xi * x->sin_0[s];
            u -= sys->harmonic[s].omega * (xr * x->sin_0[s] + xi * x->cos_0[s]);
        }
        x->now[k] = x->eta[k] - q;
        x->work[k] = x->rate[k] - u;
        x->drift[k] = x->now[k];
        x->drift_rate[k] = x->work[k];
    }
    for (size_t p = 0; p < h->exponents; p++) {
        if (h->owner) {
            const double q = x->now[h->owner[p]], u = x->work[h->owner[p]];
            x->zr[p] = h->ar[p] * q + h->br[p] * u;
            x->zi[p] = h->ai[p] * q + h->bi[p] * u;
        } else {
            x->zr[p] = dot(h->ar + p * m, x->now, m) + dot(h->br + p * m, x->work, m);
            x->zi[p] = dot(h->ai + p * m, x->now, m) + dot(h->bi + p * m, x->work, m);
        }
    }
}

/* How long the bounds of this phase hold: for good, unless something grows. */
static double bound_motion(struct exact *x, double longest)
{
    const struct held *h = x->h;
    for (size_t p = 0; p < h->exponents; p++) {
        longest = h->lr[p] > 0.0 ? lesser(longest, 1.0 / h->lr[p]) : longest;
    }
    longest = h->any_resonant ? lesser(longest, 16.0 / h->fastest) : longest;
    for (size_t p = 0; p < h->exponents; p++) {
        const double lambda = h->size[p];
        x->growth[p] = sqrt(x->zr[p] * x->zr[p] + x->zi[p] * x->zi[p]) * (h->lr[p] > 0.0 ? exp(h->lr[p] * longest) : 1.0);
        x->growth6[p] = x->growth[p];
        for (size_t s = 0; s < h->harmonics && h->any_resonant; s++) {
            const size_t at = s * h->modes + h->owner[p];
            if (h->resonant[at]) {
                const double force = hypot(h->gr[at], h->gi[at]) / h->li[p];
                /* the frequencies are within RESONANCE of each other */
                x->growth[p] += force * longest;
                x->growth6[p] += force * (longest + 6.1 / lambda);
            }
        }
    }
    return longest;
}

/* Guards of a watch, for a phase that lasts no longer than longest. now is what it watches at t0. */
static void add_guards(struct exact *x, const struct watch *w, int slides, double now, double longest)
{
    const struct held *h = x->h;
    const size_t i = w->contact;
    double start = now, bend = 0.0, size = fabs(now), ramp = w->ramp;
    for (size_t p = 0; p < h->exponents; p++) {
        start -= w->cr[p] * x->zr[p] - w->ci[p] * x->zi[p];
        bend += w->bend[p] * x->growth6[p];
        size += w->size[p] * x->growth[p];
    }
    for (size_t s = 0; s < h->harmonics; s++) {
        start -= w->rr[s] * x->cos_0[s] - w->ri[s] * x->sin_0[s];
        size += w->wave[s];
        bend += w->wave_bend[s];
    }
    for (size_t k = 0; k < h->modes; k++) {
        ramp += w->on_rate[k] * (slides ? x->acc[k] : x->vel[k]);
    }
    const double range = size - fabs(now) + fabs(start) + fabs(ramp) * longest, limit = x->modes.limit[i];
    struct guard g = {
        .contact = i, .watch = w, .side = x->modes.mode[i], .start = start, .ramp = ramp, .size = size, .bend = bend};
    if (slides) {
        g.from_zero = x->modes.rested[i];
        x->search.guard[x->search.guards++] = g;
        return;
    }
    /* far from the limit for the whole phase: nothing to guard */
    g.offset = limit;
    g.size += limit;
    for (int side = -1; side <= 1 && range >= limit; side += 2) {
        g.side = side;
        g.from_zero = x->modes.weak[i] && side * x->modes.force[i] < 0.0;
        x->search.guard[x->search.guards++] = g;
    }
}

/* Starts a phase at (t, y) with modes, forces and accelerations as decided. Returns how long its bounds hold. */
static double begin_phase(struct exact *x, tribo_system *sys, double t, const double *y, double longest)
{
    const struct held *h = x->h;
    x->t0 = t;
    split_motion(x, sys, y);
    x->tau = 0.0;
    x->fastest = h->fastest;
    for (size_t s = 0; s < h->harmonics; s++) {
        x->fastest = greater(x->fastest, fabs(sys->harmonic[s].omega));
        x->cos_t[s] = x->cos_0[s];
        x->sin_t[s] = x->sin_0[s];
    }
    memcpy(x->wr, x->zr, h->exponents * sizeof *x->wr);
    memcpy(x->wi, x->zi, h->exponents * sizeof *x->wi);
    longest = bound_motion(x, longest);
    x->search.guards = 0;
    for (size_t k = 0; k < h->watches; k++) {
        const struct watch *w = &h->watch[k];
        if (x->modes.mode[w->contact] != 2) {
            const int slides = k < h->sliding;
            const double v = x->modes.rested[w->contact] ? 0.0 : tribo_modes_velocity(&x->modes, sys, w->contact, y);
            add_guards(x, w, slides, slides ? v : x->modes.force[w->contact], longest);
        }
    }
    return longest;
}

/* --------------------------------------------------------------------------------------------------------- the driver */

static void destroy(tribo_driver *drv)
{
    struct exact *x = drv->own;
    if (x) {
        drop_helds(x);
        free(x->held);
        tribo_modes_free(&x->modes);
        free(x->eta);
        free(x->cos_t);
        free(x->search.guard);
        free(x);
    }
}

static int create(tribo_driver *drv)
{
    const size_t n = drv->sys->ndof, c = drv->sys->ncontact;
    struct exact *x = calloc(1, sizeof *x);
    drv->own = x;
    if (!x) {
        return tribo_system_fail(drv->sys, TRIBO_ERR_MEMORY, "out of memory for method exact");
    }
    x->sys = drv->sys;
    x->search.look = look;
    x->search.read = read_guard;
    x->search.motion = x;
    const int status = tribo_modes_create(&x->modes, drv->sys);
    if (status) {
        return status;
    }
    double **const by_mode[] = {&x->eta, &x->rate, &x->off,   &x->vel,        &x->acc,
                                &x->now, &x->work, &x->drift, &x->drift_rate, &x->dq};
    double **const by_exponent[] = {&x->zr, &x->zi, &x->wr, &x->wi, &x->w1r, &x->w1i, &x->w2r, &x->w2i, &x->growth, &x->growth6};
    double *work = malloc((10 * n + 20 * n + 1) * sizeof *work);
    x->search.guard = malloc((2 * c + 1) * sizeof *x->search.guard);
    if (!work || !x->search.guard) {
        free(work);
        return tribo_system_fail(drv->sys, TRIBO_ERR_MEMORY, "out of memory for method exact");
    }
    for (size_t k = 0; k < 10; k++) {
        *by_mode[k] = work + k * n;
        *by_exponent[k] = work + (10 + 2 * k) * n;
    }
    return TRIBO_OK;
}

/* Room for the harmonics of the system, which may have become more since the last advance; what was held knew the old ones. */
static int prepare(struct exact *x, tribo_system *sys)
{
    if (x->revision != sys->revision || !x->cos_t) {
        double *more = realloc(x->cos_t, 4 * (sys->harmonics + 1) * sizeof *more);
        if (!more) {
            return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for %zu harmonics", sys->harmonics);
        }
        x->cos_t = more;
        x->sin_t = more + (sys->harmonics + 1);
        x->cos_0 = more + 2 * (sys->harmonics + 1);
        x->sin_0 = more + 3 * (sys->harmonics + 1);
        drop_helds(x);
        x->revision = sys->revision;
    }
    return TRIBO_OK;
}

/* Shows the observer the motion in steps of dt, up to tau. */
static int show(struct exact *x, tribo_driver *drv, double tau, const double *y)
{
    int status = TRIBO_OK;
    while (drv->seen && !status && x->shown < x->t0 + tau) {
        move_to(x, drv->sys, x->shown - x->t0, y, drv->slope);
        status = tribo_driver_accept(drv, x->shown, drv->slope, 0);
        x->shown += drv->dt;
    }
    return status;
}

static int advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    struct exact *x = drv->own;
    tribo_system *sys = drv->sys;
    if (sys->tables || sys->limits.knots) {
        return tribo_driver_fail(drv, TRIBO_ERR_UNSUPPORTED,
                                 "method exact takes harmonic loads only; method event takes tables too");
    }
    int status = prepare(x, sys);
    status = status ? status : tribo_modes_start(&x->modes, sys, *t, y, continues);
    if (status) {
        return tribo_driver_fail(drv, status, "%s", tribo_message(sys->contacts));
    }
    status = find_held(x, drv);
    x->slowest = 1.0 / (t1 - *t);
    x->shown = *t + drv->dt;
    while (!status && *t < t1) {
        double longest = begin_phase(x, sys, *t, y, t1 - *t), when = 0.0;
        const struct guard *event = tribo_search(&x->search, longest, &when);
        when = event ? lesser(when, longest) : longest;
        status = show(x, drv, when, y);
        if (status) {
            break;
        }
        move_to(x, sys, when, y, y);
        *t = !event && longest == t1 - *t ? t1 : lesser(*t + when, t1);
        drv->steps++;
        status = tribo_modes_proceed(&x->modes, drv, &x->search, event, *t, y, 1.0 / greater(x->h->fastest, x->slowest));
        status = status ? status : find_held(x, drv);
        if (!status && (event || *t >= t1)) {
            status = tribo_driver_accept(drv, *t, y, event != NULL);
        }
    }
    sys->evaluations += x->search.looks;
    x->search.looks = 0;
    return status;
}

const struct method tribo_method_exact = {"exact", 0, create, destroy, advance, NULL};
