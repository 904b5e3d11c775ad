/* SPDX-License-Identifier: BSD-3-Clause */
/* tribo-damper on structures of a few masses, the motions of which are known. Works in the current folder. */
#include <complex.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"
#include "tool.h"

#define HEAD "%%MatrixMarket matrix coordinate real symmetric\n"

#undef I
#define I ((double complex)_Complex_I) /* _Complex_I is of float */

/* What the force of the only contact takes along its displacement, over the three periods of a table. */
static double loop_power(const char *name, double hz)
{
    char line[500];
    double z, f, before[2] = {0.0, 0.0}, work = 0.0;
    size_t lines = 0;
    FILE *file = fopen(name, "r");
    require(file && fgets(line, sizeof line, file), "there is no %s", name);
    for (; fgets(line, sizeof line, file); lines++) {
        require(sscanf(line, "%*f,%*f,%*f,%*f,%lf,%*d,%lf", &f, &z) == 2, "%s", line);
        work -= lines ? 0.5 * (f + before[0]) * (z - before[1]) : 0.0;
        before[0] = f;
        before[1] = z;
    }
    fclose(file);
    return work * hz / 3.0;
}

/* x'' + 0.1 x' + x + f = cos 1.1 t, f of a slider of limit 0.5 on a spring of 1. */
TEST(spring)
{
    static const char structure[] = "--mass spring.mtx --stiffness spring.mtx --dofs spring.txt --load 1,0,0,x --damping 0.05 "
                                    "--drive 0.17507043740108488 --contact 1,0,0,x:stiffness=";
    write_text("spring.mtx", HEAD "1 1 1\n1 1 1.0\n");
    write_text("spring.txt", "1 1 1 1 0 0\n");
    const struct outcome o = assert_runs(form("%s1 --limits 0.25:1:3", structure));
    require(strstr(o.out, "           0.5       3.3866 ") != NULL, "%s", o.out);
    assert_close(value_of("damper.free"), 1.0 / hypot(1.0 - 1.21, 0.11), 1e-9);
    assert_close(value_of("damper.stuck"), 1.0 / hypot(2.0 - 1.21, 0.11), 1e-9);
    assert_close(value_of("damper.stuck.analytic"), 1.0 / hypot(2.0 - 1.21, 0.11), 1e-12);
    /* at the limit of most power it has its loop: 4 N (X - N/k) a period */
    const double limit = value_of("damper.best.limit");
    const double loop = 4.0 * limit * (value_of("damper.best.amplitude") - limit) * 0.17507043740108488;
    assert_close(value_of("damper.best.power"), loop, 1e-8);
    assert_exact(value_of("damper.gaps"), 0.0);
    assert_refused(form("%s0", structure), NULL, "stiffness=0: must be above 0");
    assert_refused(form("%s1e300", structure), NULL, "more than 1e+09 times that of the structure");
    for (int k = 0; k < 2; k++) {
        const struct outcome marched = assert_runs(form("%s1 --limits 0.5%s", structure, k ? " --method march" : " --check 1"));
        require(says(marched.out, "           0.5       3.3866 "), "%s", marched.out);
        assert_close(k ? 0.0 : value_of("damper.check.amplitude"), 0.0, 1e-4);
    }
    /* its loop at one limit takes the power; stuck, it lags by what damping makes of it */
    assert_runs(form("%s1 --limits 0.5 --output 1,0,0,x", structure));
    assert_close(loop_power("damper-loop.csv", 0.17507043740108488), column_of("damper-curve.csv", 4), 1e-4);
    assert_runs(form("%s1 --limits 1000 --output 1,0,0,x --output=1,0,0,x", structure));
    assert_close(column_of("damper-curve.csv", 11), 1.0 / hypot(0.79, 0.11), 1e-8);
    assert_close(column_of("damper-curve.csv", 12), -atan2(0.11, 0.79) * 180.0 / PI, 1e-6);
    assert_exact(column_of("damper-curve.csv", 14), column_of("damper-curve.csv", 12));
    assert_runs(form("%s1 --limits 1000 --output 1,0,0,x --method march --harmonics 2", structure));
    assert_close(column_of("damper-curve.csv", 11), 1.0 / hypot(0.79, 0.11), 1e-4);
    assert_close(column_of("damper-curve.csv", 12), -atan2(0.11, 0.79) * 180.0 / PI, 0.1);
    assert_close(column_of("damper-curve.csv", 13), 1.0 / hypot(0.79, 0.11), 1e-4);
    assert_close(column_of("damper-curve.csv", 14), 0.0, 1e-6);
    assert_refused(form("%s1 --output 2,0,0,x", structure), NULL, "option --output 2,0,0,x");
    assert_refused(form("%s1 --check 1 --law quinn", structure), NULL, "with --law quinn marching takes rigid contacts only");
}
END_TEST

/* Two masses, 1 and 2, on springs: 3 from the ground to mass 1, 2 between them; damping 0.05 K and a dashpot 0.1 of mass 2; along
 * x and y alike. A contact at mass 1. */
#define PAIR "--mass pair-m.mtx --stiffness pair-k.mtx --dofs pair.txt --contact 1,0,0,x --drive 0.2 --limits 1e6 "

static void write_pair(void)
{
    write_text("pair-m.mtx", HEAD "4 4 4\n1 1 1\n2 2 1\n3 3 2\n4 4 2\n");
    write_text("pair-k.mtx", HEAD "4 4 6\n1 1 5\n2 2 5\n3 1 -2\n4 2 -2\n3 3 2\n4 4 2\n");
    write_text("pair-c.mtx", HEAD "4 4 6\n1 1 0.25\n2 2 0.25\n3 1 -0.1\n4 2 -0.1\n3 3 0.2\n4 4 0.2\n");
    write_text("pair.txt", "1 1 1 1 0 0\n2 1 2 1 0 0\n3 2 1 2 0 0\n4 2 2 2 0 0\n");
}

/* The complex amplitude of mass 2 under forces p1, p2. */
static double complex pair_motion(int stuck, double complex p1, double complex p2)
{
    const double w = 2.0 * PI * 0.2;
    const double complex i = (double complex)I, a = 5.0 - w * w + 0.25 * w * i, b = -2.0 - 0.1 * w * i,
                         d = 2.0 - 2.0 * w * w + 0.2 * w * i;
    return stuck ? p2 / d : (a * p2 - b * p1) / (a * d - b * b);
}

static double degrees_of(double complex x)
{
    return atan2(cimag(x), creal(x)) * 180.0 / PI;
}

/* Several loads with phases, supports that move, and a damping matrix: free and stuck as the whole structure has them, also by
 * marching; amplitude and phase of an output are those of a sine. */
TEST(loads)
{
    static const char *const given[] = {"--load 2,0,0,x --load=1,0,0,x:force=3:phase=60 --output 2,0,0,x",
                                        "--base x:acceleration=0.5:phase=-90 --output 2,0,0,x"};
    const double complex i = (double complex)I, turn = 0.5 + 0.5 * sqrt(3.0) * i;
    const double complex force[2][2] = {{3.0 * turn, 1.0}, {0.5 * i, i}};
    write_pair();
    for (int k = 0; k < 2; k++) {
        const double complex stuck = pair_motion(1, force[k][0], force[k][1]);
        for (int march = 0; march < 2; march++) {
            assert_runs(form(PAIR "--damping-matrix pair-c.mtx %s --method %s", given[k], march ? "march" : "exact"));
            assert_close(value_of("damper.free"), cabs(pair_motion(0, force[k][0], force[k][1])), march ? 1e-4 : 1e-9);
            assert_close(value_of("damper.stuck"), cabs(stuck), march ? 1e-4 : 1e-9);
            assert_close(value_of("damper.free"), value_of("damper.free.analytic"), march ? 1e-4 : 1e-9);
            assert_close(value_of("damper.stuck"), value_of("damper.stuck.analytic"), march ? 1e-4 : 1e-9);
            assert_close(column_of("damper-curve.csv", 11), cabs(stuck), march ? 1e-4 : 1e-9);
            assert_close(column_of("damper-curve.csv", 12), degrees_of(stuck), march ? 0.2 : 1e-6);
        }
        /* what the loads put in, damping and friction take: both powers found apart from each other */
        assert_runs(form(PAIR "--damping-matrix pair-c.mtx %s --limits 0.1 --check 1", given[k]));
        assert_close(value_of("damper.check.amplitude"), 0.0, 1e-4);
        assert_close(value_of("damper.check.balance"), 0.0, 1e-4);
    }
    assert_refused(PAIR "--base x:acceleration=1", "no place", "option --base x:acceleration=1: --output is missing");
    assert_refused(PAIR "--load 2,0,0,x --damping-matrix pair-c.mtx --damping 0.1", "both dampings",
                   "option --damping-matrix pair-c.mtx");
    assert_refused(PAIR "--load 2,0,0,x --damping-matrix pair.txt", "no matrix", "pair.txt:1");
    assert_refused(PAIR "--load 2,0,0,x --harmonics 3", "no place", "option --harmonics 3: --output is missing");
}
END_TEST

/* Ratios of the modes, the last one of all others, as a list and from a file: the same as their matrix. */
TEST(damping_by_mode)
{
    /* at the first frequency the free amplitude is nearly that of mode 1, with half the damping twice as large */
    double amplitude[3];
    write_pair();
    write_text("ratios.txt", "# of mode\n0.01\n0.02\n");
    static const char *const way[] = {"--damping 0.01,0.02", "--damping-ratios ratios.txt", "--damping 0.02"};
    for (int k = 0; k < 3; k++) {
        assert_runs(form(PAIR "--drive 0 --load 2,0,0,x %s", way[k]));
        amplitude[k] = value_of("damper.free");
        assert_close(amplitude[k], value_of("damper.free.analytic"), 1e-9 * amplitude[k]);
    }
    assert_exact(amplitude[1], amplitude[0]);
    assert_close(amplitude[0] / amplitude[2], 2.0, 1e-2);
    write_text("ratios.txt", "0.01\n1.5\n");
    assert_refused(PAIR "--load 2,0,0,x --damping-ratios ratios.txt", "a ratio", "ratios.txt:2: 1.5");
    write_text("ratios.txt", "# none\n");
    assert_refused(PAIR "--load 2,0,0,x --damping-ratios ratios.txt", "no ratio", "ratios.txt");
    assert_refused(PAIR "--load 2,0,0,x --damping-ratios nowhere.txt", "no file", "nowhere.txt");
}
END_TEST

/* Displacement fields: nodes once each, and the displacement at the measured place as the table of the motion has it. */
TEST(field)
{
    char text[TEXT], *at;
    double x, y, u[3][6];
    write_pair();
    assert_runs(PAIR "--load 2,0,0,x --damping 0.05 --limits 0.2 --field 0,18,360");
    read_text("damper-loop.vtk", text);
    require(strncmp(text, "# vtk DataFile Version 3.0\n", 27) == 0, "%s", text);
    require(says(text, "DATASET POLYDATA\nPOINTS 2 double\n1 0 0\n2 0 0\n"), "%s", text);
    for (int k = 0; k < 3; k++) {
        static const char *const name[] = {"displacement_0 double\n", "displacement_18 double\n", "displacement_360 double\n"};
        at = strstr(text, name[k]);
        require(at && sscanf(at + strlen(name[k]), "%lf %lf %lf %lf %lf %lf", &u[k][0], &u[k][1], &u[k][2], &u[k][3], &u[k][4],
                             &u[k][5]) == 6,
                "%s", text);
        assert_exact(u[k][1], 0.0);
        assert_exact(u[k][5], 0.0);
    }
    read_text("damper-loop.csv", text);
    for (int k = 0; k < 2; k++) {
        at = strstr(text, k ? "\n0.05," : "\n0,");
        require(at && sscanf(at + 1, "%*f,%*f,%lf,%*f,%*f,%*d,%lf", &x, &y) == 2, "%.400s", text);
        assert_close(u[k][3], x, 1e-7);
        assert_close(u[k][0], y, 1e-7);
    }
    assert_close(u[2][3], u[0][3], 1e-7);
    assert_refused(PAIR "--load 2,0,0,x --drive 0.1:0.2:3 --field 0", "a band", "option --field: displacement fields are");
}
END_TEST

/* With mu= tables and texts speak of normal loads. */
TEST(normal_load)
{
    char text[TEXT];
    write_pair();
    const struct outcome o = assert_runs("--mass pair-m.mtx --stiffness pair-k.mtx --dofs pair.txt --contact 1,0,0,x:mu=0.5 "
                                         "--load 2,0,0,x --drive 0.05:0.4:9 --limits 0.02:200:5 --damping 0.01");
    require(says(o.out, "best normal load of the band"), "%s", o.out);
    require(value_of("damper.band.load") > 0.02, "%g", value_of("damper.band.load"));
    read_text("damper-family.csv", text);
    require(strncmp(text, "normal load,frequency,", 22) == 0, "%s", text);
    assert_runs(PAIR "--load 2,0,0,x");
    read_text("damper-curve.csv", text);
    require(strncmp(text, "limit,frequency,", 16) == 0, "%s", text);
}
END_TEST

/* Normal loads that follow the motion: the elastic contact of tests/validation/series/normals.c, x'' + cx x' + 12 x + f, y'' + 2
 * y' + 21 y + N, case 4, which lifts off; its normal load at rest, 50, once from load=, once from --limits, and once by a gap,
 * where the constant load is missing and y moves about another place of rest. What is refused. */
#define FOLLOWS                                                                                                                  \
    "--mass follow-m.mtx --stiffness follow-k.mtx --damping-matrix follow-c.mtx --dofs follow.txt --drive 0.79577471545947673 "  \
    "--load 0,0,0,x:force=60:phase=90 --load 0,0,0,y:force=60:phase=90 --contact 0,0,0,x:stiffness=5:"

/* Friction feeds energy in where a spring couples x and y. */
#define PAIR_FOLLOWS                                                                                                             \
    "--mass follow-m.mtx --stiffness follow-k.mtx --dofs follow.txt --load 0,0,0,x:force=20:phase=90 "                           \
    "--load 0,0,0,y:force=10:phase=90 --drive 0.3 --contact 0,0,0,x:normal=y,21:mu=1.2:load="

TEST(normal_follows)
{
    const double open = (0.908836362 - 0.585951290) * 2.5 / PI;
    write_text("follow-m.mtx", HEAD "2 2 2\n1 1 1\n2 2 1\n");
    write_text("follow-k.mtx", HEAD "2 2 2\n1 1 12\n2 2 21\n");
    write_text("follow-c.mtx", HEAD "2 2 2\n1 1 0.34641016151377546\n2 2 2\n");
    write_text("follow.txt", "1 1 1 0 0 0\n2 1 2 0 0 0\n");
    static const char *const given[] = {FOLLOWS "mu=0.85:normal=y,21:load=50 --output 0,0,0,y",
                                        FOLLOWS "mu=0.85:normal=y,21 --limits 50 --output 0,0,0,y",
                                        FOLLOWS "mu=0.85:normal=y,21:gap=-2.3809523809523809 --output 0,0,0,y"};
    for (size_t k = 0; k < 3; k++) {
        assert_runs(given[k]);
        const double off = k < 2 ? 0.0 : fabs(column_of("damper-curve.csv", 12) - open);
        require(k < 2 || off > 0.01, "open for %g", open);
        if (k < 2) {
            assert_close(column_of("damper-curve.csv", 3), 0.5 * (6.2164272 + 5.6224136), 1e-6);
            assert_close(column_of("damper-curve.csv", 4), 91.379129104 * 2.5 / PI, 1e-7);
            assert_close(column_of("damper-curve.csv", 11), open, 1e-8);
        }
    }
    assert_runs(FOLLOWS "mu=0.85:normal=y,21:load=50 --check 1");
    assert_close(value_of("damper.check.amplitude"), 0.0, 1e-4);
    /* a motion that others leave: told in its row */
    write_text("follow-k.mtx", HEAD "2 2 3\n1 1 12\n2 1 14\n2 2 21\n");
    char text[TEXT];
    assert_runs(PAIR_FOLLOWS "5");
    read_text("damper-curve.csv", text);
    require(says(text, "unstable: motions beside it leave it by a factor of 3.8"), "%s", text);
    assert_refused(PAIR_FOLLOWS "0.1 --drive 0.3:0.4:2 --follow up", NULL,
                   "option --follow: no motion was found: a solver did not converge");
    assert_exact(value_of("damper.gaps"), 1.0);
    write_text("follow-k.mtx", HEAD "2 2 2\n1 1 12\n2 2 21\n");
    /* periods of each load are those of its own search */
    assert_runs(FOLLOWS "mu=0.85:normal=y,21 --limits 40:60:3");
    read_text("damper-curve.csv", text);
    size_t lines = 0;
    for (const char *line = strchr(text, '\n'); line && line[1]; line = strchr(line + 1, '\n'), lines++) {
        double periods = HUGE_VAL;
        require(sscanf(line, "%*f,%*f,%*f,%*f,%*f,%*f,%lf", &periods) == 1 && periods < 1000.0, "%s", line);
    }
    ck_assert_uint_ge(lines, 3);
    /* a band of loads: a curve for each, and a best one */
    const struct outcome o = assert_runs(FOLLOWS "mu=0.85:normal=y,21 --drive 0.5:0.75:3 --limits 5:500:3");
    require(says(o.out, "best normal load of the band"), "%s", o.out);
    assert_exact(value_of("damper.gaps"), 0.0);
    assert_refused(FOLLOWS "mu=0.85:normal=x,21", "along x", "normal=x is a direction along which the contact slides");
    assert_refused(FOLLOWS "mu=0.85:normal=w,21", "w", "0,0,0,x:stiffness=5:mu=0.85:normal=w,21: normal=w must be x, y or z");
    assert_refused(FOLLOWS "mu=0.85:normal=-y", "none", "normal=-y needs a stiffness: normal=-y,STIFFNESS");
    assert_refused(FOLLOWS "mu=0.85:normal=y,0", "zero", "must be above 0");
    assert_refused(FOLLOWS "normal=y,21", "no mu", "normal= needs mu=");
    assert_refused(FOLLOWS "mu=0.85:gap=1", "gap alone", "gap=1 needs normal=, too");
    assert_refused(FOLLOWS "mu=0.85:normal=y,21:gap=1:load=2", "both", "either gap=1 or load=2, not both");
    assert_refused(FOLLOWS "mu=0.85:normal=z,21:load=1", "z", "the node there cannot move along z");
}
END_TEST

/* A contact in a plane, by events: a force of size 1 that turns at 0.6 makes a circle of radius sqrt(1 - N^2)/(1 - 0.36) on a
 * mass of 1, but for the damping of 1e-9; each direction takes half of the power. On a whole curve nothing is missing. */
#define TURNS                                                                                                                    \
    "--mass turn.mtx --stiffness turn.mtx --dofs follow.txt --damping 1e-9 --drive 0.0954929658551372 "                          \
    "--load 0,0,0,x:force=1:phase=90 --load 0,0,0,y:force=1 --contact 0,0,0,xy:"

TEST(plane)
{
    const double radius = sqrt(1.0 - 0.09) / 0.64, power = 0.5 * 0.3 * radius * 0.6;
    write_text("turn.mtx", HEAD "2 2 2\n1 1 1\n2 2 1\n");
    write_text("follow.txt", "1 1 1 0 0 0\n2 1 2 0 0 0\n");
    assert_runs(TURNS "limit=0.3 --output 0,0,0,y");
    assert_close(column_of("damper-curve.csv", 3), radius, 1e-8);
    assert_close(column_of("damper-curve.csv", 4), 2.0 * power, 1e-8);
    assert_close(column_of("damper-curve.csv", 9), power, 1e-8);
    assert_exact(column_of("damper-curve.csv", 10), 0.0);
    assert_close(column_of("damper-curve.csv", 11), power, 1e-8);
    assert_close(column_of("damper-curve.csv", 13), radius, 1e-8);
    assert_runs(TURNS "mu=1 --limits 0.05:2:5");
    assert_exact(value_of("damper.gaps"), 0.0);
    assert_refused(TURNS "mu=0.3:normal=z,1:load=1", "normal", "a contact in a plane with normal= is for --method march");
}
END_TEST

/* Masses that hang together, the last of which has no spring: said, and motions are found all the same, by events. */
TEST(loose_row)
{
#define MATRIX HEAD "4 4 "
#define STRUCTURE " --stiffness loose.mtx --dofs loose.txt --load 2,0,0,x --contact 1,0,0,x"
    write_text("loose.mtx", MATRIX "4\n1 1 1.0\n2 2 2.0\n3 3 7.0\n4 4 0.0\n");
    write_text("together.mtx", MATRIX "10\n1 1 2\n2 1 1\n3 1 0.5\n4 1 0.7\n2 2 3\n3 2 0.4\n4 2 1\n3 3 2\n4 3 0.6\n4 4 2\n");
    write_text("loose.txt", "1 1 1 1 0 0\n2 2 1 2 0 0\n3 3 1 3 0 0\n4 7 3 4 0 0\n");
    const struct outcome o = assert_runs("--mass together.mtx" STRUCTURE " --damping 0.05 --drive 0.1:0.2:3 --limits 0.1:1:3");
    require(strstr(o.out, "loose.mtx: no stiffness holds row 4 (node 7, direction z)\n") != NULL, "%s", o.out);
    require(says(o.out, "best limit of the band: "), "%s", o.out);
    assert_close(value_of("damper.free"), value_of("damper.free.analytic"), 1e-9);
    assert_close(value_of("damper.stuck"), value_of("damper.stuck.analytic"), 1e-9);
    assert_exact(value_of("damper.gaps"), 0.0);
    /* from rest, a mass that nothing holds comes to drift, and never back to where it was */
    write_text("loose.mtx", HEAD "2 2 2\n1 1 1\n2 2 0\n");
    write_text("unit.mtx", HEAD "2 2 2\n1 1 1\n2 2 1\n");
    write_text("loose.txt", "1 1 1 1 0 0\n2 2 1 2 0 0\n");
    for (int k = 0; k < 2; k++) {
        const struct outcome drifts =
            assert_runs(form("--mass unit.mtx" STRUCTURE " --method march --step 1 --limits 0.1:0.2:2 %s",
                             k ? "--drive 0.1:0.2:2" : "--drive 0.1"));
        require(says(drifts.out, "no motion was found at any of these limits: not steady"), "%s", drifts.out);
    }
    write_text("minus.mtx", HEAD "2 2 2\n1 1 1.0\n2 2 -1.0\n");
    const struct outcome minus = run_tool("--mass minus.mtx" STRUCTURE);
    ck_assert_int_eq(minus.status, 1);
    require(strstr(minus.err, "at degree of freedom 1 (counted from 0)") != NULL, "%s", minus.err);
}
END_TEST

/* Without friction and stuck are those that closed forms know, also where a contact has its own limit, or none. */
TEST(own_limit)
{
    static const char *const own[] = {"limit=3", "limit=0"};
    write_text("own-m.mtx", HEAD "2 2 2\n1 1 1.0\n2 2 1.0\n");
    write_text("own-k.mtx", HEAD "2 2 3\n1 1 2.0\n2 1 -1.0\n2 2 2.0\n");
    write_text("own.txt", "1 1 1 0 0 0\n2 2 1 1 0 0\n");
    for (size_t k = 0; k < 2; k++) {
        assert_runs(
            form("--mass own-m.mtx --stiffness own-k.mtx --dofs own.txt --load 1,0,0,x --damping 0.05 --contact 0,0,0,x:%s "
                 "--contact 1,0,0,x --limits 0.1:1:3",
                 own[k]));
        assert_close(value_of("damper.free"), value_of("damper.free.analytic"), 1e-9);
        assert_close(value_of("damper.stuck"), value_of("damper.stuck.analytic"), 1e-12);
    }
    /* stuck, friction takes nothing, but a law that never sticks lets it take some: all of it is the difference */
    assert_runs("--mass own-m.mtx --stiffness own-k.mtx --dofs own.txt --load 1,0,0,x --damping 0.05 --contact 0,0,0,x "
                "--limits 50 --drive 0.2 --check 1 --law smooth");
    assert_exact(value_of("damper.check.power"), 1.0);
}
END_TEST

/* The nonlinear mode of m = k = kt = 1, limit 0.5, values by another code; damping adds 0.05/omega to its ratio. The structure is
 * whole; of two masses the second mode is found, too, and a load does not act. */
TEST(backbone)
{
    static const double values[][3] = {{0.3, 1.4142135623731, 0.0},
                                       {0.6, 1.3747608670481, 0.046412663224},
                                       {1.0, 1.2258676901977, 0.105752880426},
                                       {2.0, 1.0935981120212, 0.101057277142}};
    static const char one[] = "--mass one.mtx --stiffness one.mtx --dofs one.txt --damping 0.05 --output 1,0,0,x "
                              "--contact 1,0,0,x:stiffness=1";
    write_text("one.mtx", HEAD "1 1 1\n1 1 1.0\n");
    write_text("one.txt", "1 1 1 1 0 0\n");
    for (size_t k = 0; k < COUNT(values); k++) {
        const struct outcome o =
            assert_runs(form("%s --backbone 1 --limits 0.5 --amplitudes %g%s", one, values[k][0], k ? " --load 1,0,0,x" : ""));
        require(says(o.out, "model error: none"), "%s", o.out);
        assert_exact(column_of("damper-backbone.csv", 1), values[k][0]);
        assert_close(2.0 * PI * column_of("damper-backbone.csv", 2), values[k][1], 1e-8);
        assert_close(column_of("damper-backbone.csv", 3), values[k][2] + 0.05 / values[k][1], 1e-9);
        assert_close(value_of("damper.backbone.damping"), values[k][2] + 0.05 / values[k][1], 1e-9);
        require((column_of("damper-backbone.csv", 4) < 1.0) == (k > 0), "sticks for %g", column_of("damper-backbone.csv", 4));
    }
    assert_runs(form("%s --backbone 1 --limits 0.5 --amplitudes 0.6:2:9", one));
    assert_close(column_of("damper-backbone.csv", 2) * 2.0 * PI, values[1][1], 1e-8);
    require(value_of("damper.backbone.damping") > values[2][2] + 0.05 / values[2][1], "the largest damping is less than another");
    assert_exact(value_of("damper.gaps"), 0.0);
    static const char *const wrong[][2] = {
        {"--backbone 1 --limits 0.5", "what is missing: --amplitudes"},
        {"--backbone 1 --amplitudes 1", "what is missing: --limits"},
        {"--amplitudes 1 --load 1,0,0,x", "--backbone is missing"},
        {"--backbone 1 --limits 0.5:1:3 --amplitudes 1", "--backbone: it takes no more than one limit"},
        {"--backbone 1 --limits 1 --amplitudes 1 --drive 0.1", "--backbone: it takes no --drive"},
        {"--backbone 1 --limits 1 --amplitudes 1 --method march", "--backbone: it takes no --method march"},
        {"--backbone 1 --limits 1 --amplitudes 1 --check 1", "--backbone: it takes no --check"},
        {"--cycle 10 --limits 1 --amplitudes 1 --backbone 1", "--cycle: it takes no --backbone"},
        {"--cycle 10 --limits 1 --load 1,0,0,x", "--cycle: it takes no --load"},
        {"--cycle 10 --limits 1 --base x:acceleration=1", "--cycle: it takes no --base"},
        {"--backbone 2 --limits 1 --amplitudes 1", "the model keeps 1 mode"}};
    for (size_t k = 0; k < COUNT(wrong); k++) {
        assert_refused(form("%s %s", one, wrong[k][0]), NULL, wrong[k][1]);
    }
    write_text("two-m.mtx", HEAD "2 2 2\n1 1 1.0\n2 2 1.0\n");
    write_text("two-k.mtx", HEAD "2 2 3\n1 1 2.0\n2 1 -1.0\n2 2 2.0\n");
    write_text("two.txt", "1 1 1 0 0 0\n2 2 1 1 0 0\n");
    for (int mode = 1; mode <= 2; mode++) { /* above all slip, both frequencies are those without friction */
        assert_runs(form("--mass two-m.mtx --stiffness two-k.mtx --dofs two.txt --output 0,0,0,x --contact 1,0,0,x:stiffness=1 "
                         "--limits 1e-6 --amplitudes 1 --backbone %d",
                         mode));
        assert_close(2.0 * PI * column_of("damper-backbone.csv", 2), sqrt(2.0 * mode - 1.0), 1e-5);
    }
    write_text("two-k.mtx", HEAD "2 2 2\n1 1 1\n2 2 4\n"); /* mode 2 moves the other mass */
    assert_refused("--mass two-m.mtx --stiffness two-k.mtx --dofs two.txt --output 0,0,0,x --contact 0,0,0,x:stiffness=1 "
                   "--limits 0.5 --amplitudes 1 --backbone 2",
                   "mode 2",
                   "--backbone 2: the mode does not move the place where amplitudes are measured, option --output 0,0,0,x");
}
END_TEST

/* Stick-slip of m = k = 1 on a belt, limit 0.6 and 1 at rest: closed form. Mode coupling as in validation/squeal.c, the preload
 * as the load of the normal spring at the equilibrium without friction. */
TEST(cycle)
{
    static const char one[] = "--mass one.mtx --stiffness one.mtx --dofs one.txt --output 1,0,0,x --limits 0.6 "
                              "--contact 1,0,0,x:belt=0.2";
    const double xx = 23.25, xy = 2.25 * sqrt(3.0), yy = 7.75, load = 110.0 * xx / (xx * (yy + 11.0) - xy * xy);
    write_text("one.mtx", HEAD "1 1 1\n1 1 1.0\n");
    write_text("one.txt", "1 1 1 1 0 0\n");
    for (int k = 0; k < 2; k++) {
        const struct outcome o = assert_runs(form("%s:static=1.6666666666666667 --damping 1e-13 --cycle %d", one, 8 * k));
        assert_close(value_of("damper.cycle.period"), 8.0688878716, 1e-9);
        assert_close(value_of("damper.cycle.amplitude"), hypot(0.4, 0.2), 1e-10);
        assert_close(value_of("damper.cycle.stick1"), 4.0 / 8.0688878716, 1e-9);
        assert_close(value_of("damper.cycle.multiplier"), 0.0, 1e-9);
        assert_close(value_of("damper.sliding.frequency"), 0.5 / PI, 1e-9);
        require(says(o.out, "stable\n"), "%s", o.out);
    }
    /* without static= the block comes to slide */
    require(says(assert_runs(form("%s --damping 0.05 --cycle 0", one)).out, "no cycle was found"), "a cycle");
    assert_exact(value_of("damper.gaps"), 1.0);
    write_text("squeal-m.mtx", HEAD "2 2 2\n1 1 1.0\n2 2 1.0\n");
    write_text("squeal-c.mtx", HEAD "2 2 2\n1 1 0.1\n2 2 0.1\n");
    write_text("squeal-k.mtx", form("%s2 2 3\n1 1 %.17g\n2 1 %.17g\n2 2 %.17g\n", HEAD, xx, xy, yy));
    write_text("squeal.txt", "1 1 1 0 0 0\n2 1 2 0 0 0\n");
    const struct outcome o = assert_runs(
        form("--mass squeal-m.mtx --stiffness squeal-k.mtx --dofs squeal.txt --damping-matrix squeal-c.mtx --output 0,0,0,x "
             "--contact 0,0,0,x:belt=0.5:normal=y,11:mu=0.6:load=%.17g --cycle 0",
             load));
    assert_close(value_of("damper.cycle.period"), 1.53650780675, 1e-9);
    assert_close(value_of("damper.cycle.amplitude"), 0.5 * (0.27080300 + 0.14959332), 1e-7);
    assert_close(value_of("damper.cycle.multiplier"), hypot(0.758384, 0.424284), 1e-5);
    require(value_of("damper.sliding.growth") > 0.1 && says(o.out, "steady sliding: unstable"), "%s", o.out);
    static const char *const wrong[][2] = {{"--step 0.5", "what is missing: --load"},
                                           {"--load 1,0,0,x", "belt= and static= are for --cycle"},
                                           {"--cycle 0 --load 1,0,0,x", "it takes no --load"},
                                           {"--cycle 0 --drive 1", "no --drive"},
                                           {"--cycle -1", "must be at least 0"},
                                           {"--cycle 0 --contact 1,0,0,x:static=0.5", "at least that while sliding"}};
    for (size_t k = 0; k < COUNT(wrong); k++) {
        assert_refused(form("%s %s", one, wrong[k][0]), NULL, wrong[k][1]);
    }
}
END_TEST

/* The stop of validation/periodic/curves.c, mass, stiffness and load 0.4, beside a direction along which the contact slides: the
 * resonance turns back twice, up and down at the same frequencies, by det(D - I) = 0; between the folds motions are unstable. */
#define STOPS                                                                                                                    \
    "--mass turn.mtx --stiffness turn.mtx --damping-matrix stop-c.mtx --dofs follow.txt --load 0,0,0,y:force=0.4:phase=90 "      \
    "--load 0,0,0,x:force=0.2 --contact 0,0,0,x:mu=0.5:normal=y,1.5:gap=1 "

TEST(follow)
{
    static const double folds[] = {1.959116208891, 1.946569623911};
    char text[TEXT];
    write_text("turn.mtx", HEAD "2 2 2\n1 1 1\n2 2 1\n");
    write_text("stop-c.mtx", HEAD "2 2 2\n1 1 0.1\n2 2 0.1\n");
    write_text("follow.txt", "1 1 1 0 0 0\n2 1 2 0 0 0\n");
    for (int down = 0; down < 2; down++) {
        struct outcome o =
            assert_runs(down ? STOPS "--drive 0.1:0.24:31 --follow down" : STOPS "--drive 0.1:0.24:31 --follow up");
        for (int k = 0; k < 2; k++) {
            assert_close(2.0 * PI * value_of(k ? "damper.fold1.2" : "damper.fold1.1"), 0.6 * folds[down ? 1 - k : k], 1e-8);
        }
        require(says(o.out, "the curve turns back at 0.18708181"), "%s", o.out);
        assert_exact(value_of("damper.gaps"), 0.0);
        read_text("damper-family.csv", text);
        require(says(text, ",periods,message,stable,power1,stick1,open1\n"), "%.200s", text);
        /* stable, fold, unstable, fold, stable */
        const char *first = strstr(text, "\"fold\",,"), *second = first ? strstr(first + 1, "\"fold\",,") : NULL,
                   *unstable = strstr(text, ",0,,0,");
        require(first && second && unstable > first && unstable < second && !strstr(second, ",0,,0,"), "%s", text);
        require(strstr(text, ",0,,1,") < first && strstr(second, ",0,,1,"), "%s", text);
        assert_exact(column_of("damper-family.csv", 2), down ? 0.24 : 0.1);
        assert_exact(column_of("damper-family.csv", 12), 1.0); /* too far from the resonance to meet the stop */
    }
    assert_runs(STOPS "--drive 0.1:0.13:4 --follow up:events"); /* where the amplitude without a stop is the gap */
    read_text("damper-family.csv", text);
    const char *graze = strstr(text, "\"graze of contact 1\"");
    const double mean = 1.0 - 0.005, hz = sqrt(mean - sqrt(mean * mean - 0.84)) / (2.0 * PI);
    require(graze, "%s", text);
    while (graze[-1] != '\n') {
        graze--;
    }
    assert_close(strtod(strchr(graze, ',') + 1, NULL), hz, 1e-8);
    static const char *const wrong[][2] = {{"--drive 0.1 --follow up", "it is for a band"},
                                           {"--drive 0.1:0.2:3 --follow up --check 1", "it takes no --check"},
                                           {"--drive 0.1:0.2:3 --follow on", "must be up, down, up:events or down:events"}};
    for (size_t k = 0; k < COUNT(wrong); k++) {
        assert_refused(form(STOPS "%s", wrong[k][0]), wrong[k][0], wrong[k][1]);
    }
}
END_TEST

TEST_MAIN("damper_small", {spring, 1}, {backbone, 1}, {cycle, 1}, {follow, 1}, {loads, 1}, {damping_by_mode, 1}, {field, 1},
          {normal_load, 1}, {normal_follows, 1}, {plane, 1}, {loose_row, 1}, {own_limit, 1})
