/* SPDX-License-Identifier: BSD-3-Clause */
static char help[] =
    "A study: steady response of a structure with friction over frequency and limit, each point by shooting (libtribo_gsl). "
    "Points are\n"
    "dealt to ranks; each rank has a structure of its own.\n"
    "  -mass FILE -stiffness FILE   symmetric matrices (Matrix Market)\n"
    "  -contacts FILE               a line each: row, other row (0: the ground), limit\n"
    "  -load_row R -load F          the load F sin(omega t) on a row, counted from 1\n"
    "  -modes N -damping Z          lowest modes that are kept (12), and their damping ratio (0.002)\n"
    "  -omega FROM,TO -omegas N     frequencies, N at equal distances\n"
    "  -scale FROM,TO -scales N     what the limits of the file are multiplied by, N in equal ratios\n"
    "  -out FILE                    results, a line a point, in order; what is there already is not computed again (study.txt)\n"
    "Columns: point, omega, scale, amplitude of the loaded row, energy that friction takes in a period, status (0, or why there "
    "is no\n"
    "result).\n";

#include "point.h"
#include "records.h"

enum { LINE = 110, HEAD = 512 };

static PetscErrorCode ReadOptions(Options *o)
{
    PetscInt two = 2, both = 2;

    PetscFunctionBeginUser;
    PetscOptionsBegin(PETSC_COMM_WORLD, NULL, "A study of a structure with friction", NULL);
    PetscCall(PetscOptionsString("-mass", "file", NULL, o->mass, o->mass, sizeof o->mass, NULL));
    PetscCall(PetscOptionsString("-stiffness", "file", NULL, o->stiffness, o->stiffness, sizeof o->stiffness, NULL));
    PetscCall(PetscOptionsString("-contacts", "file", NULL, o->contacts, o->contacts, sizeof o->contacts, NULL));
    PetscCall(PetscOptionsString("-out", "file", NULL, o->out, o->out, sizeof o->out, NULL));
    PetscCall(PetscOptionsReal("-load", "amplitude", NULL, o->load, &o->load, NULL));
    PetscCall(PetscOptionsReal("-damping", "ratio of every mode", NULL, o->damping, &o->damping, NULL));
    PetscCall(PetscOptionsRealArray("-omega", "first and last, rad/time", NULL, o->omega, &two, NULL));
    PetscCall(PetscOptionsRealArray("-scale", "first and last, of the limits", NULL, o->scale, &both, NULL));
    PetscCall(PetscOptionsRangeInt("-load_row", "from 1 on", NULL, o->load_row, &o->load_row, NULL, 1, PETSC_MAX_INT));
    PetscCall(PetscOptionsRangeInt("-modes", "kept", NULL, o->modes, &o->modes, NULL, 1, PETSC_MAX_INT));
    PetscCall(PetscOptionsRangeInt("-omegas", "frequencies", NULL, o->omegas, &o->omegas, NULL, 1, 10000));
    PetscCall(PetscOptionsRangeInt("-scales", "of limits", NULL, o->scales, &o->scales, NULL, 1, 10000));
    PetscOptionsEnd();
    PetscCheck((o->omegas == 1 || two == 2) && (o->scales == 1 || both == 2), PETSC_COMM_WORLD, PETSC_ERR_USER_INPUT,
               "several -omegas or -scales need a first and a last one");
    PetscCheck(o->mass[0] && o->stiffness[0] && o->contacts[0], PETSC_COMM_WORLD, PETSC_ERR_USER_INPUT,
               "-mass, -stiffness and -contacts are needed; see -help");
    PetscCheck(o->omega[0] > 0.0 && o->omega[1] > 0.0 && o->scale[0] > 0.0 && o->scale[1] > 0.0, PETSC_COMM_WORLD,
               PETSC_ERR_ARG_OUTOFRANGE, "-omega and -scale must be positive");
    PetscFunctionReturn(0);
}

/* What the results belong to: the first line of their file. */
static PetscErrorCode Describe(const Options *o, char *head)
{
    PetscFunctionBeginUser;
    PetscCall(PetscSNPrintf(head, HEAD,
                            "# %s, %s, %s: load %.17g on row %" PetscInt_FMT ", %" PetscInt_FMT
                            " modes, damping %.17g; %" PetscInt_FMT " omega %.17g to %.17g, %" PetscInt_FMT
                            " scale %.17g to %.17g",
                            o->mass, o->stiffness, o->contacts, o->load, o->load_row, o->modes, o->damping, o->omegas,
                            o->omega[0], o->omega[1], o->scales, o->scale[0], o->scale[1]));
    PetscFunctionReturn(0);
}

/* Point k: frequency after frequency, and for each all limits. */
static PetscErrorCode RunPoint(const Study *s, const Options *o, PetscInt k, Records *results)
{
    const PetscInt i = k / o->scales, j = k % o->scales;
    const PetscReal along = o->omegas > 1 ? (PetscReal)i / (PetscReal)(o->omegas - 1) : 0.0,
                    up = o->scales > 1 ? (PetscReal)j / (PetscReal)(o->scales - 1) : 0.0,
                    omega = o->omega[0] + along * (o->omega[1] - o->omega[0]),
                    scale = o->scale[0] * PetscPowReal(o->scale[1] / o->scale[0], up);
    double amplitude, energy;
    int status;
    char line[LINE];

    PetscFunctionBeginUser;
    PetscCall(ComputePoint(s, omega, scale, &amplitude, &energy, &status));
    PetscCall(
        PetscSNPrintf(line, LINE, "%" PetscInt_FMT " %.15e %.15e %.15e %.15e %d", k, omega, scale, amplitude, energy, status));
    PetscCall(WriteRecord(results, k, line));
    PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
    static Options o = {.out = "study.txt",
                        .load = 1.0,
                        .damping = 0.002,
                        .omega = {1.0, 1.0},
                        .scale = {1.0, 1.0},
                        .load_row = 1,
                        .modes = 12,
                        .omegas = 1,
                        .scales = 1};
    static Study s;
    Records results;
    PetscMPIInt rank, size;
    PetscInt done = 0;
    PetscBool there;
    char head[HEAD];

    PetscFunctionBeginUser;
    PetscCall(PetscInitialize(&argc, &argv, NULL, help));
    PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
    PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
    PetscCall(ReadOptions(&o));
    PetscCall(CreateStudy(&s, &o));
    PetscCall(Describe(&o, head));
    PetscCall(OpenRecords(o.out, head, LINE, &results));
    for (PetscInt k = rank; k < o.omegas * o.scales; k += size) { /* neighbours cost about the same: dealt like cards */
        PetscCall(HasRecord(&results, k, &there));
        if (!there) {
            PetscCall(RunPoint(&s, &o, k, &results));
            done++;
        }
    }
    PetscCall(CloseRecords(&results));
    PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &done, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
    PetscCall(
        PetscPrintf(PETSC_COMM_WORLD, "computed %" PetscInt_FMT " of %" PetscInt_FMT " points\n", done, o.omegas * o.scales));
    PetscCall(DestroyStudy(&s));
    PetscCall(PetscFinalize());
    return 0;
}
