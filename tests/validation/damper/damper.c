/* SPDX-License-Identifier: BSD-3-Clause */
/* tribo-damper on the beam of the examples: known amplitudes, the same on one and on two threads, and what an interrupted run
 * leaves. Works in the current folder, in which there are folders one and two. */
#define _POSIX_C_SOURCE 200809L
#include <complex.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "support.h"
#include "tool.h"

#undef I
#define I ((double complex)_Complex_I) /* _Complex_I is of float */

#define READ_BEAM "--read " BEAM "/beam.txt"
#define READ_FAMILY "--read " BEAM "/family.txt --name damper --drive 25:45:6 --limits 0.1:10:3 --check 1"

/* How many instants of a table of three periods show contact 1 at rest, with a force below the limit. */
static size_t instants_at_rest(const char *name, double limit)
{
    char *text = NULL;
    size_t length = 0, count = 0;
    double cycle, t, x, v, f;
    int slip;
    FILE *file = fopen(name, "r");
    require(file && fseek(file, 0, SEEK_END) == 0, "there is no %s", name);
    length = (size_t)ftell(file);
    rewind(file);
    text = calloc(length + 1, 1);
    require(text && fread(text, 1, length, file) == length, "cannot read %s", name);
    fclose(file);
    for (char *line = strchr(text, '\n'); line && line[1]; line = strchr(line + 1, '\n')) {
        require(sscanf(line, "%lf,%lf,%lf,%lf,%lf,%d", &cycle, &t, &x, &v, &f, &slip) == 6, "%.40s", line);
        count += slip == 0 && fabs(f) < 0.999 * limit;
    }
    free(text);
    return count;
}

/* Relative error of the amplitude without friction, of damping ratio zeta at resonance: after half a period the state comes back to
 * 1e-10 of the largest (tolerance of tribo_driver_find_periodic), and the mode keeps exp(-pi zeta) of a deviation. */
static double resonance_error(double zeta)
{
    return 1e-10 / (1.0 - exp(-PI * zeta));
}

/* Without friction and with all contacts stuck the motion is known; so is about how much friction takes at best: half of what the
 * load puts in. Marching agrees to what its step allows. */
TEST(beam)
{
    const struct outcome o = assert_runs(READ_BEAM " --limits 0.001:1:7 --check 2");
    require(!says(o.out, "not found"), "%s", o.out);
    /* all 288 modes, by numpy */
    assert_close(value_of("damper.free"), 11.45611358, 1e-6);
    assert_close(value_of("damper.free"), value_of("damper.free.analytic"), resonance_error(0.002) * 11.456);
    assert_close(value_of("damper.stuck"), 2.47230951e-4, 1e-10);
    assert_close(value_of("damper.stuck"), value_of("damper.stuck.analytic"), 1e-13);
    assert_close(value_of("damper.best.limit"), value_of("damper.best.limit.balance"), 1e-3 * 0.02);
    assert_close(value_of("damper.best.power"), value_of("damper.best.power.balance"), 1e-4 * 24.0);
    assert_close(value_of("damper.check.amplitude"), 0.0, 1e-4);
    assert_exact(value_of("damper.gaps"), 0.0);
    /* at three times the best limit contacts rest for a part of each period */
    const size_t rest = instants_at_rest("damper-sticking.csv", 3.0 * value_of("damper.best.limit"));
    require(rest > 500 && rest < 2900, "contact 1 rests at %zu of 3001 instants", rest);
}
END_TEST

/* Column k, from 1, of the first line of a table. */
static double column_of(const char *name, int k)
{
    char table[TEXT], *at = table;
    read_text(name, table);
    at = strchr(table, '\n');
    for (int column = 1; column < k && at; column++) {
        at = strchr(at + 1, ',');
    }
    require(at, "%s: no column %d: %s", name, k, table);
    return strtod(at + 1, NULL);
}

/* A result that is off by no more than a hundredth, and by no more than the error that is printed with it. */
static void assert_within_error(const char *what, double off)
{
    const double bound = value_of("damper.model.error");
    require(off < 0.01 && off <= bound && bound <= 0.01, "%s is off by %g, model error %g", what, off, bound);
}

/* Three times the first frequency, where the modes alone give 36 times the power. Of the whole structure: 288 modes, as the
 * bench has them. */
TEST(as_many_modes_as_it_takes)
{
    assert_runs(READ_BEAM " --drive 80.0777694 --limits 0.1");
    assert_within_error("power", fabs(column_of("damper-curve.csv", 4) / 2.6134e-4 - 1.0));
    assert_within_error("amplitude, stuck", fabs(value_of("damper.stuck") / 2.5202023e-4 - 1.0));
    require(value_of("damper.model.modes") < 100.0, "%g modes", value_of("damper.model.modes"));
}
END_TEST

/* With few modes; known: amplitude, power of friction and input with 80 modes at six limits, from `from` to 1000 times that. */
static const struct few_modes {
    const char *options;
    double from, known[6][3];
} few_modes[] = {
#define FEW_ON_BEAM                                                                                                              \
    "--mass " BEAM "/M.mtx --stiffness " BEAM "/K.mtx --dofs " BEAM "/dofs.txt --load 400,20,5,z --force 0.1 "                   \
    "--limits 0.0003:0.3:6 --contact 400,0,5,z --contact 200,0,5,z --drive 80.0777694 --modes 10"
    {FEW_ON_BEAM,
     0.0003,
     {{0.00398863323507, 6.79123537428e-4, 9.88314347793e-4},
      {0.0039863621373, 0.00270218544567, 0.00301132423596},
      {0.00396289944255, 0.0106934126056, 0.011001703339},
      {0.0036105685266, 0.0388825201347, 0.0391506239047},
      {0.00214673820087, 0.0524345351722, 0.0525118748379},
      {2.52332733541e-4, 0.0, 2.00209421298e-6}}},
#if defined(DAMPER_ZLIB)
#define FEW_ON_PLATE                                                                                                             \
    "--mass " PLATE "/M.mtx.gz --stiffness " PLATE "/K.mtx.gz --dofs " PLATE "/dofs.txt --load 300,50,4,z "                      \
    "--limits 0.003:3:6 --contact 150,100,4,z"
    {FEW_ON_PLATE " --modes 10",
     0.003,
     {{18.5727069544, 2.80543129707, 2233.70960068},
      {18.5030821721, 11.1267461315, 2225.33589068},
      {18.2259009234, 43.6326680449, 2191.99955089},
      {17.1224225293, 163.185746448, 2059.28519413},
      {12.7294088427, 482.938987527, 1530.94100083},
      {0.037606383154, 0.177923309645, 0.187012823596}}},
#define FEW_ON_EIGHT                                                                                                             \
    FEW_ON_PLATE " --contact 150,0,4,z --contact 50,0,4,z --contact 50,100,4,z --contact 100,0,4,z --contact 100,100,4,z "       \
                 "--contact 200,0,4,z --contact 200,100,4,z"
#define OF_EIGHT                                                                                                                 \
    {                                                                                                                            \
        {18.4455910623, 17.9505881308, 2218.42153787}, {17.9970246725, 69.7246979667, 2164.47301507},                            \
            {16.2112496697, 250.035466317, 1949.70006867}, {9.10195456474, 558.873131689, 1094.67397398},                        \
            {0.0156592326297, 0.989765179547, 0.991773382852},                                                                   \
        {                                                                                                                        \
            0.00571095885706, 0.0, 2.53827310972e-4                                                                              \
        }                                                                                                                        \
    }
    {FEW_ON_EIGHT " --modes 10", 0.003, OF_EIGHT},
    {FEW_ON_EIGHT " --modes 5", 0.003, OF_EIGHT},
#endif
};

/* Errors at all limits are at most the one that is printed, and that is at most five times the largest: errors peak where contacts
 * just stick for ever. */
TEST(error_of_few_modes)
{
    const struct few_modes *few = &few_modes[_i];
    static char text[1 << 16];
    double most = 0.0;
    size_t met = 0;
    assert_runs(few->options);
    FILE *file = fopen("damper-curve.csv", "r");
    require(file, "there is no table");
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    for (const char *at = strchr(text, '\n'); at && at[1]; at = strchr(at + 1, '\n')) {
        double limit, amplitude, power, input;
        require(sscanf(at, "%lf,%*f,%lf,%lf,%*f,%lf", &limit, &amplitude, &power, &input) == 4, "%.60s", at);
        for (int k = 0; k < 6; k++) {
            const double *known = few->known[k];
            if (fabs(limit / (few->from * pow(10.0, 0.6 * k)) - 1.0) < 1e-6) {
                most = fmax(most, fabs(amplitude - known[0]) / fmax(amplitude, known[0]));
                most = fmax(most, fabs(power - known[1]) / fmax(input, known[2]));
                met++;
            }
        }
    }
    const double bound = value_of("damper.model.error");
    ck_assert_uint_eq(met, 6);
    require(most <= bound && bound <= 5.0 * most, "errors up to %g, model error %g", most, bound);
}
END_TEST

#if defined(DAMPER_ZLIB) /* the plate's matrices are compressed */

/* Row k of the modes, from 1: the frequency with all contacts stuck. */
static double stuck_frequency(int k)
{
    char table[TEXT], *at = table;
    double hz = 0.0;
    read_text("damper-frequencies.csv", table);
    for (int line = 0; line < k && at; line++) {
        at = strchr(at + 1, '\n');
    }
    require(at && sscanf(at + 1, "%*d,%*[^,],%*[^,],%*[^,],%lf", &hz) + sscanf(at + 1, "%*d,%*[^,],,,%lf", &hz) > 0, "%s", table);
    return hz;
}

/* A cantilever plate of 1188 degrees of freedom with two contacts in its middle; references of the whole structure by scipy. */
TEST(plate)
{
    static const double hz[] = {99.9223839, 470.36835567, 678.57926086};
    assert_runs("--mass " PLATE "/M.mtx.gz --stiffness " PLATE "/K.mtx.gz --dofs " PLATE "/dofs.txt --load 300,50,4,z "
                "--contact 150,0,4,z --contact 150,100,4,z --drive 120 --limits 0.1:10:3");
    for (int k = 0; k < 3; k++) {
        assert_close(stuck_frequency(k + 1), hz[k], 1e-5 * hz[k]);
    }
    assert_within_error("amplitude, stuck", fabs(value_of("damper.stuck") / 0.04074455119 - 1.0));
    assert_within_error("amplitude, free", fabs(value_of("damper.free") / 0.005416358303 - 1.0));
    /* at three times the first frequency, limit 0.1: amplitude and power with 192 modes */
    assert_runs("--mass " PLATE "/M.mtx.gz --stiffness " PLATE "/K.mtx.gz --dofs " PLATE "/dofs.txt --load 300,50,4,z "
                "--contact 150,0,4,z --contact 150,100,4,z --drive 114.84759 --limits 0.1");
    assert_within_error("amplitude", fabs(column_of("damper-curve.csv", 3) / 0.006413656 - 1.0));
    assert_within_error("power", fabs(column_of("damper-curve.csv", 4) / 0.44438871 - 1.0));
}
END_TEST

#else

TEST(plate)
{
}
END_TEST

#endif

/* Three contacts hold all that two modes alone let move, but not what three more motions do. */
TEST(nothing_left_to_move)
{
    assert_refused(READ_BEAM " --modes 2 --statics off", "two modes", "all that the 2 modes of the reduced structure let move");
    assert_refused(READ_BEAM " --modes 3 --statics off", "three modes", "keep more --modes");
    assert_runs(READ_BEAM " --modes 1 --limits 0.1:0.1:1");
    assert_close(value_of("damper.stuck"), 2.47230951e-4, 1e-9);
}
END_TEST

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
    char options[400];
    write_text("spring.mtx", "%%MatrixMarket matrix coordinate real symmetric\n1 1 1\n1 1 1.0\n");
    write_text("spring.txt", "1 1 1 1 0 0\n");
    snprintf(options, sizeof options, "%s1 --limits 0.25:1:3", structure);
    const struct outcome o = assert_runs(options);
    require(strstr(o.out, "           0.5       3.3866 ") != NULL, "%s", o.out);
    assert_close(value_of("damper.free"), 1.0 / hypot(1.0 - 1.21, 0.11), 1e-9);
    assert_close(value_of("damper.stuck"), 1.0 / hypot(2.0 - 1.21, 0.11), 1e-9);
    assert_close(value_of("damper.stuck.analytic"), 1.0 / hypot(2.0 - 1.21, 0.11), 1e-12);
    /* at the limit of most power it has its loop: 4 N (X - N/k) a period */
    const double limit = value_of("damper.best.limit");
    const double loop = 4.0 * limit * (value_of("damper.best.amplitude") - limit) * 0.17507043740108488;
    assert_close(value_of("damper.best.power"), loop, 1e-8);
    assert_exact(value_of("damper.gaps"), 0.0);
    snprintf(options, sizeof options, "%s0", structure);
    assert_refused(options, options, "stiffness=0: must be above 0");
    snprintf(options, sizeof options, "%s1e300", structure);
    assert_refused(options, options, "more than 1e+09 times that of the structure");
    for (int k = 0; k < 2; k++) {
        snprintf(options, sizeof options, "%s1 --limits 0.5%s", structure, k ? " --method march" : " --check 1");
        const struct outcome marched = assert_runs(options);
        require(says(marched.out, "           0.5       3.3866 "), "%s", marched.out);
        assert_close(k ? 0.0 : value_of("damper.check.amplitude"), 0.0, 1e-4);
    }
    /* its loop at one limit takes the power; stuck, it lags by what damping makes of it */
    snprintf(options, sizeof options, "%s1 --limits 0.5 --output 1,0,0,x", structure);
    assert_runs(options);
    assert_close(loop_power("damper-loop.csv", 0.17507043740108488), column_of("damper-curve.csv", 4), 1e-4);
    snprintf(options, sizeof options, "%s1 --limits 1000 --output 1,0,0,x --output=1,0,0,x", structure);
    assert_runs(options);
    assert_close(column_of("damper-curve.csv", 11), 1.0 / hypot(0.79, 0.11), 1e-8);
    assert_close(column_of("damper-curve.csv", 12), -atan2(0.11, 0.79) * 180.0 / PI, 1e-6);
    assert_exact(column_of("damper-curve.csv", 14), column_of("damper-curve.csv", 12));
    snprintf(options, sizeof options, "%s1 --limits 1000 --output 1,0,0,x --method march --harmonics 2", structure);
    assert_runs(options);
    assert_close(column_of("damper-curve.csv", 11), 1.0 / hypot(0.79, 0.11), 1e-4);
    assert_close(column_of("damper-curve.csv", 12), -atan2(0.11, 0.79) * 180.0 / PI, 0.1);
    assert_close(column_of("damper-curve.csv", 13), 1.0 / hypot(0.79, 0.11), 1e-4);
    assert_close(column_of("damper-curve.csv", 14), 0.0, 1e-6);
    snprintf(options, sizeof options, "%s1 --output 2,0,0,x", structure);
    assert_refused(options, options, "option --output 2,0,0,x");
    snprintf(options, sizeof options, "%s1 --check 1 --law quinn", structure);
    assert_refused(options, options, "with --law quinn marching takes rigid contacts only");
}
END_TEST

/* Two masses, 1 and 2, on springs: 3 from the ground to mass 1, 2 between them; damping 0.05 K and a dashpot 0.1 of mass 2; along
 * x and y alike. A contact at mass 1. */
#define PAIR "--mass pair-m.mtx --stiffness pair-k.mtx --dofs pair.txt --contact 1,0,0,x --drive 0.2 --limits 1e6 "

static void write_pair(void)
{
#define HEAD "%%MatrixMarket matrix coordinate real symmetric\n"
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
        char options[400];
        const double complex stuck = pair_motion(1, force[k][0], force[k][1]);
        for (int march = 0; march < 2; march++) {
            snprintf(options, sizeof options, PAIR "--damping-matrix pair-c.mtx %s --method %s", given[k],
                     march ? "march" : "exact");
            assert_runs(options);
            assert_close(value_of("damper.free"), cabs(pair_motion(0, force[k][0], force[k][1])), march ? 1e-4 : 1e-9);
            assert_close(value_of("damper.stuck"), cabs(stuck), march ? 1e-4 : 1e-9);
            assert_close(value_of("damper.free"), value_of("damper.free.analytic"), march ? 1e-4 : 1e-9);
            assert_close(value_of("damper.stuck"), value_of("damper.stuck.analytic"), march ? 1e-4 : 1e-9);
            assert_close(column_of("damper-curve.csv", 11), cabs(stuck), march ? 1e-4 : 1e-9);
            assert_close(column_of("damper-curve.csv", 12), degrees_of(stuck), march ? 0.2 : 1e-6);
        }
        /* what the loads put in, damping and friction take: both powers found apart from each other */
        snprintf(options, sizeof options, PAIR "--damping-matrix pair-c.mtx %s --limits 0.1 --check 1", given[k]);
        assert_runs(options);
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
        char options[400];
        snprintf(options, sizeof options, PAIR "--drive 0 --load 2,0,0,x %s", way[k]);
        assert_runs(options);
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

/* Masses that hang together, the last of which has no spring: said, with the reason why no motion is found. */
TEST(loose_row)
{
#define MATRIX "%%MatrixMarket matrix coordinate real symmetric\n4 4 "
#define STRUCTURE " --stiffness loose.mtx --dofs loose.txt --load 2,0,0,x --contact 1,0,0,x"
    write_text("loose.mtx", MATRIX "4\n1 1 1.0\n2 2 2.0\n3 3 7.0\n4 4 0.0\n");
    write_text("together.mtx", MATRIX "10\n1 1 2\n2 1 1\n3 1 0.5\n4 1 0.7\n2 2 3\n3 2 0.4\n4 2 1\n3 3 2\n4 3 0.6\n4 4 2\n");
    write_text("minus.mtx", MATRIX "4\n1 1 1.0\n2 2 -1.0\n3 3 1.0\n4 4 1.0\n");
    write_text("loose.txt", "1 1 1 1 0 0\n2 2 1 2 0 0\n3 3 1 3 0 0\n4 7 3 4 0 0\n");
    const struct outcome o = assert_runs("--mass together.mtx" STRUCTURE " --damping 0.05 --drive 0.1:0.2:3 --limits 0.1:1:3");
    require(strstr(o.out, "loose.mtx: no stiffness holds row 4 (node 7, direction z)\n") != NULL, "%s", o.out);
    require(strstr(o.out, "no motion was found at any of these limits: not available here") != NULL, "%s", o.out);
    const struct outcome minus = run_tool("--mass minus.mtx" STRUCTURE);
    ck_assert_int_eq(minus.status, 1);
    require(strstr(minus.err, "at degree of freedom 1 (counted from 0)") != NULL, "%s", minus.err);
}
END_TEST

/* Without friction and stuck are those that closed forms know, also where a contact has its own limit, or none. */
TEST(own_limit)
{
    static const char *const own[] = {"limit=3", "limit=0"};
    char options[400];
    write_text("own-m.mtx", "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 1.0\n2 2 1.0\n");
    write_text("own-k.mtx", "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 2.0\n2 1 -1.0\n2 2 2.0\n");
    write_text("own.txt", "1 1 1 0 0 0\n2 2 1 1 0 0\n");
    for (size_t k = 0; k < 2; k++) {
        snprintf(options, sizeof options,
                 "--mass own-m.mtx --stiffness own-k.mtx --dofs own.txt --load 1,0,0,x --damping 0.05 --contact 0,0,0,x:%s "
                 "--contact 1,0,0,x --limits 0.1:1:3",
                 own[k]);
        assert_runs(options);
        assert_close(value_of("damper.free"), value_of("damper.free.analytic"), 1e-9);
        assert_close(value_of("damper.stuck"), value_of("damper.stuck.analytic"), 1e-12);
    }
}
END_TEST

/* The stiffer the springs, the more they are like none; a rigid contact among them. */
TEST(stiff_springs)
{
    static const char own[] = "--mass " BEAM "/M.mtx --stiffness " BEAM "/K.mtx --dofs " BEAM "/dofs.txt --load 400,20,5,z "
                              "--force 0.1 --contact 200,0,5,z --limits 0.005:0.1:4 --contact ";
    double limit[3], power[3], stuck[3];
    for (int k = 0; k < 3; k++) {
        static const char *const words[] = {"", ":stiffness=1e4", ":stiffness=1e6"};
        char options[800];
        snprintf(options, sizeof options, "%s300,0,5,z%s --contact 400,0,5,z%s", own, words[k], words[k]);
        const struct outcome o = assert_runs(options);
        require(!says(o.out, "not found"), "%s", o.out);
        limit[k] = value_of("damper.best.limit");
        power[k] = value_of("damper.best.power");
        stuck[k] = value_of("damper.stuck");
        assert_close(stuck[k], value_of("damper.stuck.analytic"), 1e-13);
    }
    assert_close(limit[2], limit[0], 1e-6 * limit[0]);
    assert_close(power[2], power[0], 1e-7 * power[0]);
    /* what they give way is 1/stiffness */
    assert_close((stuck[1] - stuck[0]) / (stuck[2] - stuck[0]), 100.0, 2.0);
}
END_TEST

static char *read_all(const char *folder, const char *name, size_t *length)
{
    enum { MOST = 1 << 22 };
    char path[100], *text = malloc(MOST);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "r");
    require(file && text, "there is no %s", path);
    *length = fread(text, 1, MOST - 1, file);
    text[*length] = '\0';
    fclose(file);
    return text;
}

/* Each curve begins from rest and goes its own way, whichever thread does it. */
TEST(threads)
{
    static const char *const name[] = {"damper-frequencies.csv", "damper-family.csv", "damper-best.csv",
                                       "damper-linear.csv",      "damper-check.csv",  "values-damper.txt"};
    for (size_t k = 0; k < COUNT(name); k++) {
        char path[2][100];
        snprintf(path[0], sizeof path[0], "one/%s", name[k]);
        snprintf(path[1], sizeof path[1], "two/%s", name[k]);
        remove(path[0]);
        remove(path[1]);
    }
    assert_runs(READ_FAMILY " --threads 1 --out one");
    assert_runs(READ_FAMILY " --threads 2 --out two");
    for (size_t k = 0; k < COUNT(name); k++) {
        size_t length[2];
        char *one = read_all("one", name[k], &length[0]), *two = read_all("two", name[k], &length[1]);
        require(length[0] > 0 && length[0] == length[1] && memcmp(one, two, length[0]) == 0, "%s differs", name[k]);
        free(one);
        free(two);
    }
}
END_TEST

/* How many lines of a table hold motions; each line is whole. */
static size_t motions_in(const char *name)
{
    size_t length, lines = 0;
    char *text = read_all(".", name, &length), *end;
    require(length > 0 && text[length - 1] == '\n', "%s ends within a line", name);
    for (char *line = text; (end = strchr(line, '\n')) != NULL; line = end + 1) {
        size_t commas = 0;
        for (const char *c = line; c < end; c++) {
            commas += *c == ',';
        }
        require(end == line || commas == 7 + 2 * 3, "%s: %zu commas in %.*s", name, commas, (int)(end - line), line);
        lines += end > line;
    }
    free(text);
    return lines - 1;
}

/* Ctrl-C some time after the search has begun; returns how many motions the table holds. */
static size_t interrupt_after(const char *seen, long milliseconds)
{
    const struct timespec moment = {0, 1000000}, wait = {milliseconds / 1000, milliseconds % 1000 * 1000000};
    char out[TEXT] = "";
    write_text("out", "");
    const pid_t child = begin_tool(READ_BEAM " --drive 20:60:20000 --limits 0.001:1:5");
    while (!says(out, seen)) {
        nanosleep(&moment, NULL);
        read_text("out", out);
    }
    nanosleep(&wait, NULL);
    require(kill(child, SIGINT) == 0, "the run has ended by itself");
    const struct outcome o = end_tool(child);
    require(o.status == 130, "status %d: %s", o.status, o.err);
    const size_t motions = motions_in("damper-family.csv");
    require(says(o.out, motions ? "interrupted: tables hold" : "interrupted before a motion was found"), "%zu motions: %s",
            motions, o.out);
    return motions;
}

TEST(interrupted)
{
    size_t motions = interrupt_after("natural frequencies", 0);
    for (long wait = 100; motions == 0 && wait < 10000; wait *= 2) {
        motions = interrupt_after("all contacts stuck: amplitude", wait);
    }
    require(motions > 0 && motions < 5 * 20000, "%zu motions", motions);
}
END_TEST

/* --plot runs gnuplot on a script beside the tables, also where names hold a quote; without gnuplot it is refused before any work.
 * A script stands for gnuplot: it keeps what it is given. */
TEST(plots)
{
    char script[TEXT], path[4096], longer[4096 + 2];
    snprintf(path, sizeof path, "%s", getenv("PATH"));
    snprintf(longer, sizeof longer, ".:%s", path);
    write_text("gnuplot", "#!/bin/sh\n[ \"$1\" = --version ] || { echo drawn by \"$1\"; cat \"$1\"; } >drawn\n");
    assert_exact(chmod("gnuplot", 0755), 0);
    assert_exact(setenv("PATH", longer, 1), 0);
    assert_runs(READ_BEAM " --limits 0.001:1:5 --name o'b --plot svg");
    read_text("drawn", script);
    require(says(script, "drawn by o'b-plot.gp\n"), "%s", script);
    require(says(script, "set output 'o''b-curve.svg'\n") && says(script, "plot 'o''b-curve.csv' using 1:3"), "%s", script);
    require(says(script, "set output 'o''b-history.svg'\n") && says(script, "for [c = 1:3] 'o''b-history.csv'"), "%s", script);
    assert_runs(READ_FAMILY " --plot png");
    read_text("drawn", script);
    require(says(script, "skip 1 every :::2::2 using 2:3") && !says(script, ":::3::3"), "%s", script);
    write_text("gnuplot", "#!/bin/sh\n[ \"$1\" = --version ]\n");
    assert_refused(READ_BEAM " --limits 0.01:0.01:1 --plot png", "gnuplot fails", "gnuplot could not draw");
    assert_exact(setenv("PATH", "/nonexistent", 1), 0);
    assert_refused(READ_BEAM " --plot png", "no gnuplot", "is it installed?");
    assert_exact(setenv("PATH", path, 1), 0);
    assert_refused(READ_BEAM " --plot pdf", "a format", "png or svg");
}
END_TEST

TEST_MAIN("damper", {beam, 1}, {as_many_modes_as_it_takes, 1}, {error_of_few_modes, sizeof few_modes / sizeof *few_modes},
          {plate, 1}, {nothing_left_to_move, 1}, {spring, 1}, {loads, 1}, {damping_by_mode, 1}, {field, 1}, {normal_load, 1},
          {loose_row, 1}, {own_limit, 1}, {stiff_springs, 1}, {threads, 1}, {interrupted, 1}, {plots, 1})
