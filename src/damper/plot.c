/* SPDX-License-Identifier: BSD-3-Clause */
#include "tables.h"

#include <stdlib.h>
#include <string.h>

#include "output.h"

/* Blue to red, as dark as lines on white must be. */
static const char palette[] = "set palette defined (0 '#1d4f91', 1 '#0072b2', 2 '#2a9d8f', 3 '#8ab17d', 4 '#d9a528', "
                              "5 '#e07a1f', 6 '#c1121f', 7 '#7a0019')\nunset colorbox\n";

/* text between single quotes; a quote inside becomes `quote`. */
static char *quoted(const char *text, const char *quote)
{
    char *to = need_memory(strlen(text) * strlen(quote) + 3, 1), *end = to;
    *end++ = '\'';
    for (; *text; text++) {
        if (*text == '\'') {
            end += strlen(strcpy(end, quote));
        } else {
            *end++ = *text;
        }
    }
    strcpy(end, "'");
    return to;
}

/* NAME-what.ending as gnuplot reads it. */
static char *file_of(const struct tables *t, const char *what, const char *ending)
{
    char *name = new_text("%s-%s.%s", t->name, what, ending), *text = quoted(name, "''");
    free(name);
    return text;
}

void open_plots(struct tables *t)
{
    if (!t->plot) {
        return;
    }
    die_if(system("gnuplot --version >/dev/null 2>&1") != 0, "option --plot %s: gnuplot cannot be run: is it installed?",
           t->plot);
    const int png = strcmp(t->plot, "png") == 0;
    t->script = create_table(t, "plot", "gp");
    fprintf(t->script, "# Pictures of tribo-damper's tables: gnuplot %s-plot.gp, in this folder.\n", t->name);
    fprintf(t->script, "set terminal %s font 'DejaVu Sans,%d' linewidth 1.4 noenhanced%s\n",
            png ? "pngcairo size 900,540" : "svg size 900,540 dynamic", png ? 11 : 13, png ? "" : " background 'white'");
    fprintf(t->script,
            "set datafile separator ','\nset encoding utf8\nset border linewidth 0.8 linecolor '#404040'\n"
            "set tics nomirror\nset grid linetype 1 linecolor '#e4e4e4' linewidth 0.6\n"
            "set key noautotitle outside right top Left reverse spacing 1.25 samplen 2.2\n%s",
            palette);
}

/* Begins a picture NAME-what. */
static void begin_picture(const struct tables *t, const char *what, const char *along, const char *up)
{
    char *picture = file_of(t, what, t->plot);
    fprintf(t->script, "\nset output %s\nset xlabel '%s'\nset ylabel '%s'\n", picture, along, up);
    free(picture);
}

/* Columns `left` and left + 1 of NAME-what.csv over the first one, on scales of their own; axis [3]: titles of the axes;
 * title [2]: titles of the columns. */
static void plot_two(const struct tables *t, const char *what, const char *scale, int left, const char *const *axis,
                     const char *const *title)
{
    if (t->script && t->motions > 0) {
        char *file = file_of(t, what, "csv");
        begin_picture(t, what, axis[0], axis[1]);
        fprintf(t->script,
                "set y2label '%s'\nset logscale %s\nset y2tics\nset key bottom\n"
                "plot %s using 1:%d with lines linecolor '#0072b2' title '%s', \\\n"
                "     %s using 1:%d axes x1y2 with lines linecolor '#d55e00' dashtype (10, 5) title '%s'\n"
                "unset logscale\nunset y2label\nunset y2tics\nset key top\n",
                axis[2], scale, file, left, title[0], file, left + 1, title[1]);
        free(file);
    }
}

void plot_curve(const struct tables *t)
{
    const char *const axis[] = {t->limit, "amplitude where the load acts", "mean power that friction takes"};
    plot_two(t, "curve", "xy", 3, axis, (const char *const[]){"amplitude", "power"});
}

void plot_backbone(const struct tables *t)
{
    static const char *const axis[] = {"amplitude", "natural frequency", "damping ratio"};
    plot_two(t, "backbone", "x", 2, axis, (const char *const[]){"frequency", "damping"});
}

void plot_family(const struct tables *t, const double *limit, size_t count, double best)
{
    if (!t->script) {
        return;
    }
    char *family = file_of(t, "family", "csv"), *linear = file_of(t, "linear", "csv"), *optimum = file_of(t, "best", "csv");
    begin_picture(t, "family", "frequency of the load", "amplitude where the load acts");
    fprintf(t->script, "set logscale y\nset key title '%s'\n", t->limit);
    fprintf(t->script, "plot %s using 1:2 with lines linecolor '#9a9a9a' dashtype (2, 3) title 'no friction', \\\n", linear);
    const char *const stable = t->followed ? "(strcol(9) eq '0' ? NaN : $3)" : "3";
    for (size_t k = 0; k < count; k++) {
        const double part = count > 1 ? (double)k / (double)(count - 1) : 0.0;
        for (int unstable = 0; unstable <= t->followed; unstable++) { /* stable parts, then dashed the unstable ones */
            fprintf(t->script, "     %s skip 1 every :::%zu::%zu using 2:%s with lines linecolor palette frac %.4g ", family, k,
                    k, unstable ? "(strcol(9) eq '1' ? NaN : $3)" : stable, part);
            fprintf(t->script, unstable ? "dashtype (6, 4), \\\n" : "title '%.3g', \\\n", limit[k]);
        }
    }
    if (best > 0.0) {
        fprintf(t->script, "     %s using 2:3 with lines linecolor '#000000' linewidth 2.2 title 'best: %.3g', \\\n", optimum,
                best);
    }
    fprintf(t->script, "     %s using 1:3 with lines linecolor '#404040' dashtype (2, 3) title 'all stuck'\n", linear);
    fprintf(t->script, "unset logscale\nset key title ''\n");
    free(family);
    free(linear);
    free(optimum);
}

void plot_loops(const struct tables *t, size_t contacts, double limit, const char *what)
{
    if (t->script) {
        char *file = file_of(t, what, "csv");
        begin_picture(t, what, "displacement of the contact", "friction force");
        fprintf(
            t->script,
            "set key title 'limit %.4g'\nset offsets graph 0.04, graph 0.04, graph 0.08, graph 0.08\nplot for [c = 1:%zu] %s \\\n"
            "     using ($1 >= 2 ? column(%zu + c) : 1 / 0):(column(3 * c + 2)) with lines \\\n"
            "     linecolor palette frac (%zu > 1 ? (c - 1.0) / %zu : 0) title sprintf('contact %%d', c)\n"
            "set key title ''\nunset offsets\n",
            limit, contacts, file, 3 + 3 * contacts, contacts, contacts > 1 ? contacts - 1 : 1);
        free(file);
    }
}

void draw_plots(const struct tables *t)
{
    if (t->script) {
        char *name = new_text("%s-plot.gp", t->name), *script = quoted(name, "'\\''"), *folder = quoted(t->out, "'\\''");
        char *command = new_text("cd %s && gnuplot %s", folder, script);
        close_table(t, t->script, "plot", "gp");
        die_if(system(command) != 0, "gnuplot could not draw %s/%s", t->out, name);
        free(name);
        free(script);
        free(folder);
        free(command);
    }
}
