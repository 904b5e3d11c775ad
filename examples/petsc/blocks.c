/* SPDX-License-Identifier: BSD-3-Clause */
#include "blocks.h"
#include "tribo_petsc.h"

#define FROM "contact 0 is block %" PetscInt_FMT /* where the contacts of a message are */

static PetscErrorCode CreateTile(const Chain *c, PetscReal dt, Tile *tile)
{
    double inverse_mass[TILE];

    PetscFunctionBeginUser;
    for (PetscInt i = 0; i < tile->count; i++) {
        inverse_mass[i] = (double)c->n;
    }
    PetscCheck(!tribo_create(&tile->contacts, (size_t)tile->count), PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for contacts");
    const char *message = tribo_message(tile->contacts);
    PetscCallTribo(tribo_set_operator_diagonal(tile->contacts, inverse_mass), message, FROM, tile->first);
    PetscCallTribo(tribo_set_limit_all(tile->contacts, c->limit / (PetscReal)c->n), message, FROM, tile->first);
    PetscCallTribo(tribo_set_epsilon_step(tile->contacts, dt, c->lambda_dt), message, FROM, tile->first);
    PetscFunctionReturn(0);
}

PetscErrorCode CreateTiles(Chain *c, PetscReal dt)
{
    PetscInt first, count;

    PetscFunctionBeginUser;
    PetscCall(DMDAGetCorners(c->da, &first, NULL, NULL, &count, NULL, NULL));
    c->tiles = (count + TILE - 1) / TILE;
    PetscCall(PetscMalloc1(c->tiles, &c->tile));
    for (PetscInt k = 0; k < c->tiles; k++) {
        c->tile[k].first = first + k * TILE;
        c->tile[k].count = PetscMin(TILE, count - k * TILE);
        PetscCall(CreateTile(c, dt, &c->tile[k]));
    }
    PetscCall(PetscLogStageRegister("friction", &c->friction));
    PetscFunctionReturn(0);
}

/* Velocities of a tile's blocks, and accelerations without friction. x is indexed by block and has ghosts. */
static void Accelerate(const Chain *c, const Tile *tile, PetscReal t, const Block *x, double *v, double *a)
{
    const PetscReal n = (PetscReal)c->n, spring = n * n;
    for (PetscInt k = 0; k < tile->count; k++) {
        const PetscInt i = tile->first + k;
        if (i == 0) {
            a[k] = spring * (x[1].u - x[0].u) + n * c->alpha * PetscSinReal(c->omega * t);
        } else if (i == c->n - 1) {
            a[k] = spring * (4.0 / 3.0 * x[i - 1].u - 4.0 * x[i].u);
        } else {
            a[k] = spring * (x[i - 1].u - 2.0 * x[i].u + x[i + 1].u);
        }
        v[k] = x[i].v;
    }
}

static PetscErrorCode FindTileRates(const Chain *c, const Tile *tile, double *v, const double *a, Block *y)
{
    double f[TILE];

    PetscFunctionBeginUser;
    PetscCall(PetscLogStagePush(c->friction));
    PetscCallTribo(tribo_balance(tile->contacts, v, a, NULL, f), tribo_message(tile->contacts), FROM, tile->first);
    PetscCall(PetscLogStagePop());
    for (PetscInt k = 0; k < tile->count; k++) {
        const Block rate = {v[k], a[k] + (PetscReal)c->n * f[k], -f[k] * v[k]};
        y[tile->first + k] = rate;
    }
    PetscFunctionReturn(0);
}

static PetscErrorCode KickTile(const Chain *c, const Tile *tile, double *v, const double *a, Block *y)
{
    double f[TILE];

    PetscFunctionBeginUser;
    for (PetscInt k = 0; k < tile->count; k++) {
        v[k] += c->h * a[k];
    }
    PetscCall(PetscLogStagePush(c->friction));
    PetscCallTribo(tribo_step_force(tile->contacts, c->h, v, f), tribo_message(tile->contacts), FROM, tile->first);
    PetscCall(PetscLogStagePop());
    for (PetscInt k = 0; k < tile->count; k++) {
        Block *b = &y[tile->first + k];
        const PetscReal end = v[k] + c->h * (PetscReal)c->n * f[k];
        b->d -= c->h * f[k] * 0.5 * (b->v + end);
        b->v = end;
        b->u += c->dt * end;
    }
    PetscFunctionReturn(0);
}

/* Works on all tiles, from the state into another vector or itself: the ranks tell each other where the blocks at their borders
 * are. */
static PetscErrorCode Sweep(Chain *c, PetscReal t, Vec state, Vec into,
                            PetscErrorCode (*work)(const Chain *, const Tile *, double *, const double *, Block *))
{
    double v[TILE], a[TILE];
    Vec local;
    const Block *x;
    Block *y;

    PetscFunctionBeginUser;
    PetscCall(DMGetLocalVector(c->da, &local));
    PetscCall(DMGlobalToLocal(c->da, state, INSERT_VALUES, local));
    PetscCall(DMDAVecGetArrayRead(c->da, local, &x));
    PetscCall(DMDAVecGetArray(c->da, into, &y));
    for (PetscInt k = 0; k < c->tiles; k++) {
        Accelerate(c, &c->tile[k], t, x, v, a);
        PetscCall(work(c, &c->tile[k], v, a, y));
    }
    PetscCall(DMDAVecRestoreArrayRead(c->da, local, &x));
    PetscCall(DMDAVecRestoreArray(c->da, into, &y));
    PetscCall(DMRestoreLocalVector(c->da, &local));
    PetscFunctionReturn(0);
}

PetscErrorCode FindRates(Chain *c, PetscReal t, Vec state, Vec rates)
{
    PetscFunctionBeginUser;
    PetscCall(Sweep(c, t, state, rates, FindTileRates));
    PetscFunctionReturn(0);
}

PetscErrorCode Kick(Chain *c, PetscReal t, PetscReal h, PetscReal dt, Vec state)
{
    PetscFunctionBeginUser;
    c->h = h;
    c->dt = dt;
    PetscCall(Sweep(c, t, state, state, KickTile));
    PetscFunctionReturn(0);
}

PetscErrorCode DestroyTiles(Chain *c)
{
    PetscFunctionBeginUser;
    for (PetscInt k = 0; k < c->tiles; k++) {
        tribo_destroy(c->tile[k].contacts);
    }
    PetscCall(PetscFree(c->tile));
    PetscFunctionReturn(0);
}
