/* SPDX-License-Identifier: BSD-3-Clause */
/* TRB routines as a Fortran program calls them: contexts and systems of up to four contacts and degrees of freedom are created,
 * set, asked, moved and deleted in any order, with legal and illegal handles, sizes and numbers. After each call the status is
 * known; a status other than 0 of a call with a handle has a message. */
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tribo/tribo.h"

enum { HANDLES = 4, ROOM = 64, TEXT = 200, MOST_CALLS = 60, MOST_SIZE = 4 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef const double *in;
typedef double *out;
typedef const int *whole;
void trbnew_(whole n, int *ih, int *ierr), trbcpy_(whole ih, int *copy, int *ierr), trbdel_(whole ih, int *ierr),
    trbcps_(whole ih, whole from, int *ierr), trbfix_(whole ih, int *ierr),
    trbmsg_(whole ih, char *text, int *ierr, size_t length),
    trblin_(whole ndof, whole n, in m, in c, in k, whole ldm, in j, whole ldj, int *ih, char *text, int *ierr, size_t length),
    trbcln_(whole ih, int *copy, int *ierr),
    trbdrv_(whole ih, const char *name, in dt, in atol, in rtol, int *ierr, size_t length),
    trbadv_(whole ih, whole ndof, out t, in t1, out y, int *ierr),
    trbper_(whole ih, whole ndof, in t, in period, out y, int *ierr),
    trbcon_(whole ih, whole ndof, whole n, in t, in y, out v, out feq, out f, int *ierr);
void trblim_(whole, whole, in, int *), trbeps_(whole, whole, in, int *), trbopd_(whole, whole, in, int *);
void trbglm_(whole, whole, out, int *), trbgep_(whole, whole, out, int *), trbdis_(whole, whole, out, int *),
    trbfrq_(whole, whole, out, int *);
void trbnld_(whole, whole, in, in, int *), trbsta_(whole, whole, in, in, int *), trbacc_(whole, whole, in, in, int *);
void trblm1_(whole, in, int *), trbep1_(whole, in, int *), trbzet_(whole, in, int *), trbout_(whole, in, int *),
    trbhmx_(whole, in, int *), trbhst_(whole, in, int *);
void trblaw_(whole, whole, int *), trbcpl_(whole, whole, int *), trbshr_(whole, whole, int *);
void trbglw_(whole, int *, int *), trbgcp_(whole, int *, int *), trbgsh_(whole, int *, int *), trbnum_(whole, int *, int *),
    trbndf_(whole, int *, int *), trbfam_(whole, int *, int *);
void trbcll_(whole, int *), trbbsc_(whole, int *), trblmc_(whole, int *);
void trblod_(whole, whole, in, in, in, int *), trbbas_(whole, whole, in, in, in, int *), trbhlm_(whole, whole, in, in, in, int *);
void trbfrc_(whole, whole, in, in, out, int *), trbbal_(whole, whole, in, in, in, out, int *),
    trbbox_(whole, whole, in, in, in, out, int *), trbtpr_(whole, whole, in, in, out, int *);
void trbopf_(whole, whole, in, whole, int *), trbops_(whole, whole, whole, whole, in, int *), trbstp_(whole, in, in, int *);

struct bytes {
    const uint8_t *at;
    size_t left;
};

static int take(struct bytes *b, int n)
{
    if (!b->left) {
        return 0;
    }
    b->left--;
    return *b->at++ % n;
}

static double number(struct bytes *b)
{
    static const double some[] = {0.0, 1.0, 2.0, 0.5, -1.0, 1e-3, 10.0, 1e-300, 1e300, -3.0, 0.25, 4.0};
    const int k = take(b, 16);
    return k < 12 ? some[k] : take(b, 200) / 20.0 - 5.0;
}

static void numbers(struct bytes *b, double *x)
{
    for (int i = 0; i < ROOM; i++) {
        x[i] = i < 8 ? number(b) : x[i % 8];
    }
}

/* Symmetric, and more often than not definite. */
static void matrix(struct bytes *b, double *x, int n)
{
    memset(x, 0, ROOM * sizeof *x);
    for (int i = 0; i < n; i++) {
        x[i * n + i] = take(b, 8) ? 2.0 + take(b, 8) : number(b);
        if (i > 0) {
            x[i * n + i - 1] = x[(i - 1) * n + i] = take(b, 4) ? -1.0 : number(b);
        }
    }
}

struct scene {
    int ih[HANDLES], n, whole[ROOM];
    double x[5][ROOM], y[ROOM];
};

static int create(struct bytes *b, struct scene *s, int *ih)
{
    char text[TEXT];
    const int n = take(b, MOST_SIZE + 1), ndof = take(b, 4) ? n : take(b, MOST_SIZE + 1);
    int ierr;
    if (take(b, 2)) {
        trbnew_(&n, ih, &ierr);
        return ierr;
    }
    matrix(b, s->x[0], ndof);
    matrix(b, s->x[1], take(b, 3) ? 0 : ndof);
    matrix(b, s->x[2], ndof);
    numbers(b, s->x[3]);
    trblin_(&ndof, &n, s->x[0], s->x[1], s->x[2], &ndof, s->x[3], &n, ih, text, &ierr, sizeof text);
    return ierr;
}

static int drive(struct bytes *b, struct scene *s, const int *ih)
{
    static const char *const method[] = {"exact", "event", "central/fixed", "moreau/fixed", "rk4/fixed", "auto", "none"};
    static const double zero = 0.0;
    const char *name = method[take(b, 7)];
    const double dt = 0.01 * (1 + take(b, 10)), t1 = 0.1 * take(b, 30);
    double t = 0.0;
    int ierr, ndof = s->n;
    trbdrv_(ih, name, &dt, &zero, &zero, &ierr, strlen(name));
    trbndf_(ih, &ndof, &ierr);
    if (take(b, 2)) {
        trbadv_(ih, &ndof, &t, &t1, s->y, &ierr);
    } else {
        trbper_(ih, &ndof, &t, &t1, s->y, &ierr);
    }
    return ierr;
}

static int set(struct bytes *b, struct scene *s, const int *ih)
{
    const int k = take(b, 16), w = take(b, 9) - 2;
    const double *x = s->x[0], *z = s->x[1], omega = number(b);
    int ierr = 0;
    numbers(b, s->x[0]);
    numbers(b, s->x[1]);
    switch (k) {
    case 0:
        trblim_(ih, &s->n, x, &ierr);
        break;
    case 1:
        trbeps_(ih, &s->n, x, &ierr);
        break;
    case 2:
        trbopd_(ih, &s->n, x, &ierr);
        break;
    case 3:
        trbnld_(ih, &s->n, x, z, &ierr);
        break;
    case 4:
        trbsta_(ih, &s->n, x, z, &ierr);
        break;
    case 5:
        trbacc_(ih, &s->n, x, z, &ierr);
        break;
    case 6:
        (take(b, 2) ? trblm1_ : trbep1_)(ih, x, &ierr);
        break;
    case 7:
        (take(b, 2) ? trbzet_ : trbout_)(ih, x, &ierr);
        break;
    case 8:
        (take(b, 2) ? trbhmx_ : trbhst_)(ih, x, &ierr);
        break;
    case 9:
        (take(b, 2) ? trblaw_ : take(b, 2) ? trbcpl_ : trbshr_)(ih, &w, &ierr);
        break;
    case 10:
        trblod_(ih, &s->n, &omega, x, z, &ierr);
        break;
    case 11:
        trbbas_(ih, &s->n, &omega, x, z, &ierr);
        break;
    case 12:
        trbhlm_(ih, &s->n, &omega, x, z, &ierr);
        break;
    case 13:
        (take(b, 2) ? trbcll_ : take(b, 2) ? trbbsc_ : trblmc_)(ih, &ierr);
        break;
    case 14:
        matrix(b, s->x[0], s->n), trbopf_(ih, &s->n, x, take(b, 4) ? &s->n : &w, &ierr);
        break;
    default:
        for (int i = 0; i < ROOM; i++) {
            s->whole[i] = i <= s->n ? (take(b, 4) ? 1 + i : take(b, 20) - 2) : 1 + i % (s->n + 1);
        }
        trbops_(ih, &s->n, s->whole, s->whole + s->n + 1, x, &ierr);
    }
    return ierr;
}

static int ask(struct bytes *b, struct scene *s, const int *ih)
{
    static void (*const wholes[])(whole, int *, int *) = {trbglw_, trbgcp_, trbgsh_, trbnum_, trbndf_, trbfam_};
    static void (*const lists[])(whole, whole, out, int *) = {trbglm_, trbgep_, trbdis_, trbfrq_};
    const int k = take(b, 8);
    int ierr = 0, value, ndof = s->n;
    for (int i = 0; i < 4; i++) {
        numbers(b, s->x[i]);
    }
    switch (k) {
    case 0:
        wholes[take(b, 6)](ih, &value, &ierr);
        break;
    case 1:
        lists[take(b, 4)](ih, &s->n, s->x[4], &ierr);
        break;
    case 2:
        trbfrc_(ih, &s->n, s->x[0], s->x[1], s->x[4], &ierr);
        break;
    case 3:
        trbbal_(ih, &s->n, s->x[0], s->x[1], s->x[2], s->x[4], &ierr);
        break;
    case 4:
        trbbox_(ih, &s->n, s->x[0], s->x[1], s->x[2], s->x[4], &ierr);
        break;
    case 5:
        trbtpr_(ih, &s->n, s->x[0], s->x[1], s->x[4], &ierr);
        break;
    case 6:
        trbcon_(ih, &ndof, &s->n, s->x[0], s->y, s->x[2], s->x[3], s->x[4], &ierr);
        break;
    default:
        trbstp_(ih, s->x[0], s->x[1], &ierr);
    }
    return ierr;
}

static int call(struct bytes *b, struct scene *s)
{
    int *ih = &s->ih[take(b, HANDLES)], wrong = take(b, 200) - 100, ierr = 0;
    const int *handle = take(b, 16) ? ih : &wrong, what = take(b, 16);
    if (take(b, 8)) {
        trbnum_(ih, &s->n, &ierr); /* the size that fits */
    } else {
        s->n = take(b, MOST_SIZE + 1);
    }
    if (s->n < 0 || s->n > MOST_SIZE) {
        abort();
    }
    if (!*ih || what == 0) {
        trbdel_(ih, &ierr);
        *ih = 0;
        return create(b, s, ih);
    }
    switch (what) {
    case 1:
        trbdel_(handle, &ierr);
        return ierr;
    case 2:
        (take(b, 2) ? trbcpy_ : trbcln_)(handle, &s->ih[take(b, HANDLES)], &ierr);
        return ierr;
    case 3:
        trbcps_(handle, &s->ih[take(b, HANDLES)], &ierr);
        return ierr;
    case 4:
        trbfix_(handle, &ierr);
        return ierr;
    case 5:
    case 6:
    case 7:
        return drive(b, s, handle);
    case 8:
    case 9:
    case 10:
    case 11:
        return set(b, s, handle);
    default:
        return ask(b, s, handle);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct scene s;
    struct bytes b = {data, size};
    memset(&s, 0, sizeof s);
    for (int k = 0; k < MOST_CALLS && b.left; k++) {
        const int status = call(&b, &s);
        if (strcmp(tribo_strerror(status), tribo_strerror(-1)) == 0 || (status && !tribo_strerror(status)[0])) {
            fprintf(stderr, "status %d is unknown\n", status);
            abort();
        }
    }
    for (int k = 0; k < HANDLES; k++) {
        char text[TEXT];
        int ierr;
        trbmsg_(&s.ih[k], text, &ierr, sizeof text);
        trbdel_(&s.ih[k], &ierr);
    }
    return 0;
}
