/* SPDX-License-Identifier: BSD-3-Clause */
#define _POSIX_C_SOURCE 200809L
#include "tool.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define BOUND_MEMORY 0 /* they reserve terabytes */
#else
#define BOUND_MEMORY 1
#endif
enum { MOST_SECONDS = 60, MOST_MEGABYTES = 4096, MOST_WORDS = 64 };

void read_text(const char *path, char *text)
{
    FILE *file = fopen(path, "r");
    require(file, "there is no %s", path);
    text[fread(text, 1, TEXT - 1, file)] = '\0';
    fclose(file);
}

void write_bytes(const char *path, const char *bytes, size_t length)
{
    FILE *file = fopen(path, "w");
    require(file && fwrite(bytes, 1, length, file) == length && fclose(file) == 0, "cannot write %s", path);
}

void write_text(const char *path, const char *text)
{
    write_bytes(path, text, strlen(text));
}

/* In the child: a hang, or greed for memory, ends it by a signal or an error. The bound is wide because OpenBLAS, where it is the
 * machine's BLAS, reserves 128 MB a thread, and tries for ever when it does not get them. */
static void become(char *const *argument)
{
    const struct rlimit seconds = {MOST_SECONDS, MOST_SECONDS},
                        bytes = {(rlim_t)MOST_MEGABYTES << 20, (rlim_t)MOST_MEGABYTES << 20};
    setrlimit(RLIMIT_CPU, &seconds);
    if (BOUND_MEMORY) {
        setrlimit(RLIMIT_AS, &bytes);
    }
    if (freopen("out", "w", stdout) && freopen("err", "w", stderr)) {
        execv(DAMPER, argument);
    }
    _exit(99);
}

pid_t begin_tool(const char *options)
{
    static char text[TEXT];
    char *argument[MOST_WORDS] = {"tribo-damper"};
    int count = 1;
    snprintf(text, sizeof text, "%s", options);
    for (char *word = text; word && count < MOST_WORDS - 1; count++) {
        char *blank = strchr(word, ' ');
        if (blank) {
            *blank++ = '\0';
        }
        argument[count] = word;
        word = blank;
    }
    const pid_t child = fork();
    if (child == 0) {
        become(argument);
    }
    require(child > 0, "no child");
    return child;
}

struct outcome end_tool(pid_t child)
{
    static struct outcome o;
    int status;
    require(waitpid(child, &status, 0) == child, "no child");
    o.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    read_text("out", o.out);
    read_text("err", o.err);
    return o;
}

const char *form(const char *format, ...)
{
    static char text[TEXT];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return text;
}

struct outcome run_tool(const char *options)
{
    return end_tool(begin_tool(options));
}

void assert_ends(const struct outcome *o, const char *what)
{
    const size_t length = strlen(o->err);
    require(o->status == 1, "%s: status %d, %s", what, o->status, o->err);
    require(strncmp(o->err, "tribo-damper: ", 14) == 0 && strcspn(o->err, "\n") + 1 == length, "%s: %s", what, o->err);
    for (size_t i = 0; i + 1 < length; i++) {
        require(o->err[i] >= ' ' && o->err[i] <= '~', "%s: %s", what, o->err);
    }
}

void assert_refused(const char *options, const char *what, const char *part)
{
    const struct outcome o = run_tool(options);
    what = what ? what : options;
    assert_ends(&o, what);
    require(says(o.err, part), "%s: \"%s\" is not in %s", what, part, o.err);
}

int has_no_number(const char *text)
{
    return says(text, " nan") || says(text, " -nan") || says(text, " inf") || says(text, " -inf");
}

struct outcome assert_runs(const char *options)
{
    const struct outcome o = run_tool(options);
    require(o.status == 0 && !*o.err, "%s: status %d, %s", options, o.status, o.err);
    require(!has_no_number(o.out), "%s: %s", options, o.out);
    return o;
}

double value_of(const char *key)
{
    char text[TEXT];
    read_text("values-damper.txt", text);
    const char *at = strstr(text, key);
    require(at && at[strlen(key)] == ' ', "no value %s", key);
    return strtod(at + strlen(key), NULL);
}

double column_of(const char *name, int k)
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
