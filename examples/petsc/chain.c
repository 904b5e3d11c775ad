/* SPDX-License-Identifier: BSD-3-Clause */
static char help[] =
    "Quinn's chain of blocks on a frictional surface, distributed over the ranks: energy that friction takes in each cycle.\n"
    "  -da_grid_x N    blocks (32)\n"
    "  -limit L        mu times normal load of the whole chain (1)\n"
    "  -alpha A        amplitude of the force that pulls the first block (0.25); -omega W: its frequency (0.5)\n"
    "  -cycles C       of the load (4), -steps S a cycle (2500); -ts_max_steps ends earlier\n"
    "  -velocity V     the chain begins with a wave of 8 lengths and this amplitude of velocity (0)\n"
    "  -lambda_dt X    rate at which stuck blocks come to rest, times the step (0.4)\n"
    "  -step_form      central differences and Coulomb's law over a step, in a plain loop, instead of TS and Quinn's law\n"
    "Every option of TS works in both: -ts_monitor, -ts_monitor_solution_vtk 'chain-%04D.vts', ...\n";

#include <petscts.h>

#include "blocks.h"

static PetscErrorCode RHSFunction(TS ts, PetscReal t, Vec state, Vec rates, void *chain)
{
    PetscFunctionBeginUser;
    (void)ts;
    PetscCall(FindRates(chain, t, state, rates));
    PetscFunctionReturn(0);
}

/* What TSSolve does, for the step form: up to the TS's largest number of steps. */
static PetscErrorCode SolveStepForm(Chain *c, TS ts, Vec state)
{
    PetscReal t, dt;
    PetscInt step, last;

    PetscFunctionBeginUser;
    PetscCall(TSGetTime(ts, &t));
    PetscCall(TSGetTimeStep(ts, &dt));
    PetscCall(TSGetStepNumber(ts, &step));
    PetscCall(TSGetMaxSteps(ts, &last));
    for (; step < last; t += dt, step++) {
        PetscCall(TSMonitor(ts, step, t, state));
        PetscCall(Kick(c, t, step ? dt : 0.5 * dt, dt, state)); /* from velocities at t = 0 */
    }
    PetscCall(TSMonitor(ts, step, t, state));
    PetscCall(TSSetTime(ts, t));
    PetscCall(TSSetStepNumber(ts, step));
    PetscFunctionReturn(0);
}

/* Energy that friction has taken up to the TS's time. That of the step form is half a step behind: a copy goes there. */
static PetscErrorCode FindDissipation(Chain *c, TS ts, PetscBool step_form, Vec state, PetscReal *d)
{
    PetscReal t, dt;
    Vec now;

    PetscFunctionBeginUser;
    PetscCall(VecDuplicate(state, &now));
    PetscCall(VecCopy(state, now));
    if (step_form) {
        PetscCall(TSGetTime(ts, &t));
        PetscCall(TSGetTimeStep(ts, &dt));
        PetscCall(Kick(c, t, 0.5 * dt, 0.0, now));
    }
    PetscCall(VecStrideSum(now, 2, d));
    PetscCall(VecDestroy(&now));
    PetscFunctionReturn(0);
}

static PetscErrorCode SetVelocities(const Chain *c, PetscReal velocity, Vec state)
{
    PetscInt first, count;
    Block *x;

    PetscFunctionBeginUser;
    PetscCall(DMDAGetCorners(c->da, &first, NULL, NULL, &count, NULL, NULL));
    PetscCall(DMDAVecGetArray(c->da, state, &x));
    for (PetscInt i = first; i < first + count; i++) {
        x[i].v = velocity * PetscSinReal(16.0 * PETSC_PI * (PetscReal)i / (PetscReal)c->n);
    }
    PetscCall(DMDAVecRestoreArray(c->da, state, &x));
    PetscFunctionReturn(0);
}

/* Runs cycle after cycle and prints what each takes. */
static PetscErrorCode Run(Chain *c, TS ts, PetscReal velocity, PetscInt cycles, PetscInt steps, PetscBool step_form)
{
    PetscReal before = 0.0, after = 0.0;
    PetscInt most;
    Vec state;

    PetscFunctionBeginUser;
    PetscCall(DMCreateGlobalVector(c->da, &state));
    PetscCall(PetscObjectSetName((PetscObject)state, "chain"));
    PetscCall(SetVelocities(c, velocity, state));
    PetscCall(TSSetSolution(ts, state));
    PetscCall(TSGetMaxSteps(ts, &most));
    for (PetscInt cycle = 1; cycle <= cycles && (cycle - 1) * steps < most; cycle++, before = after) {
        PetscCall(TSSetMaxSteps(ts, PetscMin(cycle * steps, most)));
        PetscCall(step_form ? SolveStepForm(c, ts, state) : TSSolve(ts, state));
        PetscCall(FindDissipation(c, ts, step_form, state, &after));
        PetscCall(PetscPrintf(PETSC_COMM_WORLD, "cycle %" PetscInt_FMT " dissipates %.13g\n", cycle, (double)(after - before)));
    }
    PetscCall(VecDestroy(&state));
    PetscFunctionReturn(0);
}

/* Steps of one length, counted: a last one that ends at a time would differ from the others by rounding. */
static PetscErrorCode CreateTS(Chain *c, PetscReal dt, TS *ts)
{
    TSAdapt adapt;

    PetscFunctionBeginUser;
    PetscCall(TSCreate(PETSC_COMM_WORLD, ts));
    PetscCall(TSSetDM(*ts, c->da));
    PetscCall(TSSetType(*ts, TSRK));
    PetscCall(TSRKSetType(*ts, TSRK4));
    PetscCall(TSSetRHSFunction(*ts, NULL, RHSFunction, c));
    PetscCall(TSGetAdapt(*ts, &adapt));
    PetscCall(TSAdaptSetType(adapt, TSADAPTNONE));
    PetscCall(TSSetExactFinalTime(*ts, TS_EXACTFINALTIME_STEPOVER));
    PetscCall(TSSetMaxTime(*ts, PETSC_MAX_REAL));
    PetscCall(TSSetMaxSteps(*ts, PETSC_MAX_INT));
    PetscCall(TSSetFromOptions(*ts));
    PetscCall(TSSetTimeStep(*ts, dt));
    PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
    Chain c = {.n = 32, .limit = 1.0, .alpha = 0.25, .omega = 0.5, .lambda_dt = 0.4};
    PetscInt cycles = 4, steps = 2500;
    PetscBool step_form = PETSC_FALSE;
    PetscReal velocity = 0.0;
    TS ts;

    PetscFunctionBeginUser;
    PetscCall(PetscInitialize(&argc, &argv, NULL, help));
    PetscOptionsBegin(PETSC_COMM_WORLD, NULL, "Quinn's chain", NULL);
    PetscCall(PetscOptionsReal("-limit", "mu times normal load of the whole chain", NULL, c.limit, &c.limit, NULL));
    PetscCall(PetscOptionsReal("-alpha", "amplitude of the load", NULL, c.alpha, &c.alpha, NULL));
    PetscCall(PetscOptionsReal("-omega", "frequency of the load", NULL, c.omega, &c.omega, NULL));
    PetscCall(PetscOptionsReal("-lambda_dt", "rate of stuck blocks times step", NULL, c.lambda_dt, &c.lambda_dt, NULL));
    PetscCall(PetscOptionsReal("-velocity", "amplitude of the wave", NULL, velocity, &velocity, NULL));
    PetscCall(PetscOptionsInt("-cycles", "of the load", NULL, cycles, &cycles, NULL));
    PetscCall(PetscOptionsRangeInt("-steps", "a cycle", NULL, steps, &steps, NULL, 1, PETSC_MAX_INT));
    PetscCall(PetscOptionsBool("-step_form", "central differences in a plain loop", NULL, step_form, &step_form, NULL));
    PetscOptionsEnd();
    PetscCheck(cycles <= PETSC_MAX_INT / steps, PETSC_COMM_WORLD, PETSC_ERR_ARG_OUTOFRANGE, "too many steps to be counted");
    PetscCall(DMDACreate1d(PETSC_COMM_WORLD, DM_BOUNDARY_NONE, c.n, 3, 1, NULL, &c.da));
    PetscCall(DMSetFromOptions(c.da));
    PetscCall(DMSetUp(c.da));
    PetscCall(DMDASetFieldName(c.da, 0, "displacement"));
    PetscCall(DMDASetFieldName(c.da, 1, "velocity"));
    PetscCall(DMDASetFieldName(c.da, 2, "dissipated"));
    PetscCall(DMDAGetInfo(c.da, NULL, &c.n, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL));
    PetscCheck(c.n >= 2, PETSC_COMM_WORLD, PETSC_ERR_ARG_OUTOFRANGE, "a chain has 2 blocks at least, not %" PetscInt_FMT, c.n);
    const PetscReal dt = 2.0 * PETSC_PI / c.omega / (PetscReal)steps,
                    stable = (step_form ? 2.0 : 2.828) / (2.1492 * (PetscReal)c.n);
    PetscCheck(dt < stable, PETSC_COMM_WORLD, PETSC_ERR_ARG_OUTOFRANGE,
               "steps of %g are not stable: less than %g, 2 (rk4: 2.828) over the chain's highest frequency", (double)dt,
               (double)stable);
    PetscCall(CreateTiles(&c, dt));
    PetscCall(CreateTS(&c, dt, &ts));
    PetscCall(Run(&c, ts, velocity, cycles, steps, step_form));
    PetscCall(DestroyTiles(&c));
    PetscCall(TSDestroy(&ts));
    PetscCall(DMDestroy(&c.da));
    PetscCall(PetscFinalize());
    return 0;
}
