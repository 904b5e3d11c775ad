/* SPDX-License-Identifier: BSD-3-Clause */
static char help[] =
    "A structure from Matrix Market files with friction contacts, distributed over the ranks: implicit midpoint rule, Coulomb's "
    "law\n"
    "at the end of each step. Any consistent units.\n"
    "  -mass FILE -stiffness FILE   symmetric matrices\n"
    "  -contacts FILE               a line each: row, other row (0: the ground), limit; v = u_row - u_other\n"
    "  -load_row R -load F -omega W the load F sin(W t) on a row; rows count from 1, as in the files\n"
    "  -damping B                   damping matrix B times stiffness (0)\n"
    "  -copies C                    of the structure, side by side; their loads follow each other by 1/C of a period (1)\n"
    "  -places FILE                 of each row: row, node, direction, x, y, z; for -vtk and for multigrid\n"
    "  -ts_dt H -ts_max_steps N     length of a step and their number; -every K: those that a line is printed for\n"
    "  -vtk FORMAT                  a file for each such line, e.g. 'motion-%04d.vtk'; copies stand -distance D apart\n"
    "Monitors of TS and options of KSP work. A step is solved by MUMPS; with -ksp_type cg -pc_type gamg nothing is factored.\n";

#include <petscts.h>

#include "structure.h"
#include "tribo_petsc.h"
#include "vtk.h"

static PetscErrorCode ReadOptions(Options *o)
{
    PetscFunctionBeginUser;
    PetscOptionsBegin(PETSC_COMM_WORLD, NULL, "A structure with friction contacts", NULL);
    PetscCall(PetscOptionsString("-mass", "file", NULL, o->mass, o->mass, sizeof o->mass, NULL));
    PetscCall(PetscOptionsString("-stiffness", "file", NULL, o->stiffness, o->stiffness, sizeof o->stiffness, NULL));
    PetscCall(PetscOptionsString("-contacts", "file", NULL, o->contacts, o->contacts, sizeof o->contacts, NULL));
    PetscCall(PetscOptionsString("-places", "file", NULL, o->places, o->places, sizeof o->places, NULL));
    PetscCall(PetscOptionsString("-vtk", "format of names", NULL, o->vtk, o->vtk, sizeof o->vtk, NULL));
    PetscCall(PetscOptionsReal("-load", "amplitude", NULL, o->load, &o->load, NULL));
    PetscCall(PetscOptionsReal("-omega", "frequency of the load, rad/time", NULL, o->omega, &o->omega, NULL));
    PetscCall(PetscOptionsReal("-damping", "times stiffness", NULL, o->damping, &o->damping, NULL));
    PetscCall(PetscOptionsReal("-distance", "of copies in files", NULL, o->distance, &o->distance, NULL));
    PetscCall(PetscOptionsRangeInt("-load_row", "from 1 on", NULL, o->load_row, &o->load_row, NULL, 1, PETSC_MAX_INT));
    PetscCall(PetscOptionsRangeInt("-copies", "of the structure", NULL, o->copies, &o->copies, NULL, 1, PETSC_MAX_INT));
    PetscCall(PetscOptionsRangeInt("-every", "steps, a line", NULL, o->every, &o->every, NULL, 1, PETSC_MAX_INT));
    PetscOptionsEnd();
    PetscCheck(o->mass[0] && o->stiffness[0] && o->contacts[0], PETSC_COMM_WORLD, PETSC_ERR_USER_INPUT,
               "-mass, -stiffness and -contacts are needed; see -help");
    PetscCheck(!o->vtk[0] || o->places[0], PETSC_COMM_WORLD, PETSC_ERR_USER_INPUT, "-vtk needs -places");
    PetscFunctionReturn(0);
}

/* f of all contacts from the velocities that they would end the step with: each rank solves its own islands. */
static PetscErrorCode FindForces(Structure *s)
{
    Share *mine = &s->share;
    const PetscScalar *end;
    PetscScalar *f;

    PetscFunctionBeginUser;
    PetscCall(PetscLogStagePush(s->friction));
    PetscCall(VecScatterBegin(mine->gather, s->end, mine->end, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecScatterEnd(mine->gather, s->end, mine->end, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecGetArrayRead(mine->end, &end));
    PetscCall(VecGetArrayWrite(mine->f, &f));
    PetscCallTribo(tribo_step_force(mine->contacts, s->h, end, f), tribo_message(mine->contacts), "contacts:%s", mine->where);
    PetscCall(VecRestoreArrayRead(mine->end, &end));
    PetscCall(VecRestoreArrayWrite(mine->f, &f));
    PetscCall(VecScatterBegin(mine->gather, mine->f, s->f, INSERT_VALUES, SCATTER_REVERSE));
    PetscCall(VecScatterEnd(mine->gather, mine->f, s->f, INSERT_VALUES, SCATTER_REVERSE));
    PetscCall(PetscLogStagePop());
    PetscFunctionReturn(0);
}

/* What all contacts do, as tribo_get_slip has it, into end. */
static PetscErrorCode FindSlip(Structure *s)
{
    Share *mine = &s->share;
    signed char *slip;
    PetscScalar *here;

    PetscFunctionBeginUser;
    PetscCall(PetscMalloc1(mine->count, &slip));
    PetscCallTribo(tribo_get_slip(mine->contacts, slip), tribo_message(mine->contacts), "contacts:%s", mine->where);
    PetscCall(VecGetArrayWrite(mine->end, &here));
    for (PetscInt i = 0; i < mine->count; i++) {
        here[i] = slip[i];
    }
    PetscCall(VecRestoreArrayWrite(mine->end, &here));
    PetscCall(PetscFree(slip));
    PetscCall(VecScatterBegin(mine->gather, mine->end, s->end, INSERT_VALUES, SCATTER_REVERSE));
    PetscCall(VecScatterEnd(mine->gather, mine->end, s->end, INSERT_VALUES, SCATTER_REVERSE));
    PetscFunctionReturn(0);
}

static PetscErrorCode AddLoad(Structure *s, const Options *o, PetscReal t)
{
    const PetscScalar part[2] = {0.5 * s->h * PetscSinReal(o->omega * t), 0.5 * s->h * PetscCosReal(o->omega * t)};

    PetscFunctionBeginUser;
    PetscCall(VecMAXPY(s->force, 2, part, s->load));
    PetscFunctionReturn(0);
}

static PetscErrorCode Step(Structure *s, const Options *o, PetscReal t)
{
    PetscScalar work[2];

    PetscFunctionBeginUser;
    PetscCall(VecWAXPY(s->change, 0.5 * s->h + o->damping, s->u, s->q));
    PetscCall(MatMult(s->stiffness, s->change, s->force));
    PetscCall(VecScale(s->force, -s->h));
    PetscCall(AddLoad(s, o, t));
    PetscCall(AddLoad(s, o, t + s->h));
    PetscCall(KSPSolve(s->solver, s->force, s->change));
    PetscCall(VecAXPY(s->q, 0.5 * s->h, s->u));
    PetscCall(VecAXPY(s->u, 1.0, s->change));
    PetscCall(MatMult(s->direction, s->u, s->end));
    PetscCall(FindForces(s));
    PetscCall(MatMult(s->response, s->f, s->change));
    PetscCall(VecAXPY(s->u, s->h, s->change));
    PetscCall(VecAXPY(s->q, 0.5 * s->h, s->u));
    PetscCall(MatMult(s->direction, s->u, s->end));
    const Vec ends[2] = {s->v, s->end};
    PetscCall(VecMDot(s->f, 2, ends, work));
    s->dissipated -= 0.5 * s->h * PetscRealPart(work[0] + work[1]);
    PetscCall(VecCopy(s->end, s->v));
    PetscFunctionReturn(0);
}

/* One line: time, displacement of the load's row (of the first copy), norms of the state, energy that friction took, contacts at
 * rest. And a file for whoever wants to see. */
static PetscErrorCode Report(Structure *s, const Options *o, PetscInt step, PetscReal t)
{
    size_t here;
    PetscScalar at;
    PetscReal norm[2];

    PetscFunctionBeginUser;
    PetscCallTribo(tribo_get_count(s->share.contacts, TRIBO_COUNT_STUCK, &here), tribo_message(s->share.contacts), "contacts:%s",
                   s->share.where);
    PetscInt stuck = (PetscInt)here;
    PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &stuck, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
    PetscCall(VecDot(s->shape, s->q, &at));
    PetscCall(VecNorm(s->q, NORM_2, &norm[0]));
    PetscCall(VecNorm(s->u, NORM_2, &norm[1]));
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%.9g %.13g %.13g %.13g %.13g %" PetscInt_FMT "\n", (double)t,
                          (double)PetscRealPart(at), (double)norm[0], (double)norm[1], (double)s->dissipated, stuck));
    if (o->vtk[0]) {
        char path[PETSC_MAX_PATH_LEN];
        PetscCall(PetscSNPrintf(path, sizeof path, o->vtk, (int)(step / o->every)));
        PetscCall(FindSlip(s));
        PetscCall(WriteVtk(path, s->place, s->q, &s->contacts, s->f, s->end));
    }
    PetscFunctionReturn(0);
}

static PetscErrorCode Run(Structure *s, const Options *o, TS ts)
{
    PetscInt steps;

    PetscFunctionBeginUser;
    PetscCall(TSGetMaxSteps(ts, &steps));
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "# %" PetscInt_FMT " islands; time, displacement, |q|, |u|, dissipated, at rest\n",
                          s->share.islands));
    for (PetscInt step = 0; step < steps; step++) {
        PetscCall(TSMonitor(ts, step, (PetscReal)step * s->h, s->q));
        PetscCall(Step(s, o, (PetscReal)step * s->h));
        if ((step + 1) % o->every == 0) {
            PetscCall(Report(s, o, step + 1, (PetscReal)(step + 1) * s->h));
        }
    }
    PetscCall(TSMonitor(ts, steps, (PetscReal)steps * s->h, s->q));
    PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
    static Options o = {.load = 1.0, .omega = 1.0, .load_row = 1, .copies = 1, .every = 1};
    static Structure s;
    TS ts; /* for its options and monitors: a method with forces that jump is none of TS's own */

    PetscFunctionBeginUser;
    PetscCall(PetscInitialize(&argc, &argv, NULL, help));
    PetscCall(ReadOptions(&o));
    PetscCall(TSCreate(PETSC_COMM_WORLD, &ts));
    PetscCall(TSSetTimeStep(ts, 1e-4));
    PetscCall(TSSetMaxSteps(ts, 100));
    PetscCall(TSSetFromOptions(ts));
    PetscCall(TSGetTimeStep(ts, &s.h));
    PetscCall(CreateStructure(&s, &o));
    PetscCall(Run(&s, &o, ts));
    PetscCall(DestroyStructure(&s));
    PetscCall(TSDestroy(&ts));
    PetscCall(PetscFinalize());
    return 0;
}
