/* tribo-damper on the beam of the examples: known amplitudes, the same on one and on two threads, and what an interrupted run
 * leaves. Works in the current folder, in which there are folders one and two. */
#define _POSIX_C_SOURCE 200809L
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "support.h"
#include "tool.h"

#define READ_BEAM "--read " BEAM "/beam.txt"
#define READ_FAMILY "--read " BEAM "/family.txt --name damper --drive 25:45:6 --limits 0.1:10:3 --check 1"

/* Without friction and with all contacts stuck the motion is known; so is about how much friction takes at best: half of what the
 * load puts in. Marching agrees to what its step allows. */
TEST(beam)
{
    const struct outcome o = assert_runs(READ_BEAM " --limits 0.001:1:7 --check 2");
    require(!says(o.out, "not found"), "%s", o.out);
    assert_close(value_of("damper.free"), 11.456113474338, 1e-8);
    assert_close(value_of("damper.free"), value_of("damper.free.analytic"), 1e-9);
    assert_close(value_of("damper.stuck"), 2.2239839911872e-4, 1e-13);
    assert_close(value_of("damper.stuck"), value_of("damper.stuck.analytic"), 1e-13);
    assert_close(value_of("damper.best.limit"), value_of("damper.best.limit.balance"), 1e-3 * 0.02);
    assert_close(value_of("damper.best.power"), value_of("damper.best.power.balance"), 1e-4 * 24.0);
    assert_close(value_of("damper.check.amplitude"), 0.0, 1e-3);
    assert_exact(value_of("damper.gaps"), 0.0);
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
static size_t interrupt_after(long milliseconds)
{
    const struct timespec moment = {0, 1000000}, wait = {milliseconds / 1000, milliseconds % 1000 * 1000000};
    char out[TEXT] = "";
    write_text("out", "");
    const pid_t child = begin_tool(READ_BEAM " --drive 20:60:20000 --limits 0.001:1:5");
    while (!says(out, "all contacts stuck: amplitude")) {
        nanosleep(&moment, NULL);
        read_text("out", out);
    }
    nanosleep(&wait, NULL);
    require(kill(child, SIGINT) == 0, "the run has ended by itself");
    const struct outcome o = end_tool(child);
    require(o.status == 130, "status %d: %s", o.status, o.err);
    require(says(o.out, "interrupted"), "%s", o.out);
    return motions_in("damper-family.csv");
}

TEST(interrupted)
{
    size_t motions = 0;
    for (long wait = 100; motions == 0 && wait < 10000; wait *= 2) {
        motions = interrupt_after(wait);
    }
    require(motions > 0 && motions < 5 * 20000, "%zu motions", motions);
}
END_TEST

TEST_MAIN("damper", {beam, 1}, {threads, 1}, {interrupted, 1})
