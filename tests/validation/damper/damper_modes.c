/* SPDX-License-Identifier: BSD-3-Clause */
/* tribo-damper with few modes of the beam and the plate of the examples: errors, beside those that it prints. Works in the
 * current folder. */
#include <stdio.h>
#include <string.h>

#include "support.h"
#include "tool.h"

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
    assert_runs("--read " BEAM "/beam.txt --drive 80.0777694 --limits 0.1");
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

/* Errors at all limits are at most the one that is printed, and that is at most five times the largest: errors peak where
 * contacts just stick for ever. */
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

/* 12 modes keep up a stable stick-slip that 24 modes do not have: the tool warns with --modes 12, and takes 24 by default, which
 * slide. Stick-slip of the structure itself stays; its period changes by at most the error that is printed. */
#define ON_BELT "--mass " BEAM "/M.mtx --stiffness " BEAM "/K.mtx --dofs " BEAM "/dofs.txt --output 400,20,5,z --limits 0.5 "

TEST(cycle_of_few_modes)
{
    double period[2];
    struct outcome o = assert_runs(ON_BELT "--cycle 0 --modes 12 --contact 400,0,5,z:belt=2:static=1.5");
    require(says(o.out, "no cycle was found with 24 modes: this one may be of the modes kept only: take more --modes"), "%s",
            o.out);
    o = assert_runs(ON_BELT "--cycle 0 --contact 400,0,5,z:belt=2:static=1.5");
    require(says(o.out, "model: 24 modes") && says(o.out, "no cycle was found"), "%s", o.out);
    assert_exact(value_of("damper.gaps"), 1.0);
    for (int k = 1; k >= 0; k--) {
        assert_runs(k ? ON_BELT "--cycle 0 --modes 48 --damping 0.02 --contact 400,0,5,z:belt=5:static=1.5"
                      : ON_BELT "--cycle 0 --damping 0.02 --contact 400,0,5,z:belt=5:static=1.5");
        period[k] = value_of("damper.cycle.period");
    }
    assert_within_error("period", fabs(period[0] / period[1] - 1.0));
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

TEST_MAIN("damper_modes", {as_many_modes_as_it_takes, 1}, {error_of_few_modes, sizeof few_modes / sizeof *few_modes},
          {cycle_of_few_modes, 1}, {plate, 1})
