/* SPDX-License-Identifier: BSD-3-Clause */
/* tribo-damper on the beam of the examples: known amplitudes, the same on one and on two threads, and what an interrupted run
 * leaves. Works in the current folder, in which there are folders one and two. */
#define _POSIX_C_SOURCE 200809L
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "support.h"
#include "tool.h"

#define READ_BEAM "--read " BEAM "/beam.txt"
#define READ_FAMILY "--read " BEAM "/family.txt --name damper --drive 25:45:6 --limits 0.1:10:3 --modes 4 --check 1"

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

/* Relative error of the amplitude without friction, of damping ratio zeta at resonance: after half a period the state comes back
 * to 1e-10 of the largest (tolerance of tribo_driver_find_periodic), and the mode keeps exp(-pi zeta) of a deviation. */
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

/* Three contacts hold all that two modes alone let move, but not what three more motions do. */
TEST(nothing_left_to_move)
{
    assert_refused(READ_BEAM " --modes 2 --statics off", "two modes", "all that the 2 modes of the reduced structure let move");
    assert_refused(READ_BEAM " --modes 3 --statics off", "three modes", "keep more --modes");
    assert_runs(READ_BEAM " --modes 1 --limits 0.1:0.1:1");
    assert_close(value_of("damper.stuck"), 2.47230951e-4, 1e-9);
}
END_TEST

/* The stiffer the springs, the more they are like none; a rigid contact among them. */
TEST(stiff_springs)
{
    static const char own[] = "--mass " BEAM "/M.mtx --stiffness " BEAM "/K.mtx --dofs " BEAM "/dofs.txt --load 400,20,5,z "
                              "--force 0.1 --contact 200,0,5,z --limits 0.005:0.1:4 --modes 4 --contact ";
    double limit[3], power[3], stuck[3];
    for (int k = 0; k < 3; k++) {
        static const char *const words[] = {"", ":stiffness=1e4", ":stiffness=1e6"};
        const struct outcome o = assert_runs(form("%s300,0,5,z%s --contact 400,0,5,z%s", own, words[k], words[k]));
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

/* --plot runs gnuplot on a script beside the tables, also where names hold a quote; without gnuplot it is refused before any
 * work. A script stands for gnuplot: it keeps what it is given. */
TEST(plots)
{
    char script[TEXT], path[4096], longer[4096 + 2];
    snprintf(path, sizeof path, "%s", getenv("PATH"));
    snprintf(longer, sizeof longer, ".:%s", path);
    write_text("gnuplot", "#!/bin/sh\n[ \"$1\" = --version ] || { echo drawn by \"$1\"; cat \"$1\"; } >drawn\n");
    assert_exact(chmod("gnuplot", 0755), 0);
    assert_exact(setenv("PATH", longer, 1), 0);
    assert_runs(READ_BEAM " --limits 0.001:1:5 --modes 4 --name o'b --plot svg");
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

TEST_MAIN("damper", {beam, 1}, {nothing_left_to_move, 1}, {stiff_springs, 1}, {threads, 1}, {interrupted, 1}, {plots, 1})
