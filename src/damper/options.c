/* SPDX-License-Identifier: BSD-3-Clause */
#include "options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lines.h"
#include "tribo/tribo.h"

static const struct options standard = {
    .out = ".", .name = "damper", .force = 1.0, .statics = 1, .step = 0.25, .law = TRIBO_COULOMB};
static const double DAMPING = 0.002, LIMIT_FROM = 1e-3, LIMIT_TO = 10.0; /* times the size of the loads */
enum { CURVE_LIMITS = 33, FAMILY_LIMITS = 9 };

/* ------------------------------------------------------------------------------------------------------------- setters */

/* Puts the value of an option into o; origin, for messages, is "option NAME VALUE", or file and line. */
typedef void setter(const char *origin, const char *value, struct options *o);

static void set_statics(const char *origin, const char *value, struct options *o)
{
    o->statics = strcmp(value, "on") == 0;
    if (!o->statics && strcmp(value, "off") != 0) {
        die("%s: must be on or off", origin);
    }
}

static void check_ratio(const char *origin, double ratio)
{
    if (!(ratio > 0.0 && ratio < 1.0)) {
        die("%s: must be above 0 and below 1", origin);
    }
}

static void set_damping(const char *origin, const char *value, struct options *o)
{
    o->damping.count = 0;
    read_list(origin, value, &o->damping);
    for (size_t k = 0; k < o->damping.count; k++) {
        check_ratio(origin, o->damping.value[k]);
    }
}

static void set_damping_ratios(const char *origin, const char *value, struct options *o)
{
    struct lines l = open_lines(value);
    o->damping.count = 0;
    while (next_data(&l)) {
        add_number(&o->damping, next_real(&l, "damping ratio"));
        expect_end(&l);
        check_ratio(new_text("%s:%zu: %g", value, l.line, o->damping.value[o->damping.count - 1]),
                    o->damping.value[o->damping.count - 1]);
    }
    close_lines(&l);
    if (o->damping.count == 0) {
        die("%s: there is no damping ratio in it", origin);
    }
}

static void set_contact(const char *origin, const char *value, struct options *o)
{
    read_contact(origin, value, &o->contacts);
}

static void set_contacts(const char *origin, const char *value, struct options *o)
{
    (void)origin;
    read_contacts(value, &o->contacts);
}

static void set_load(const char *origin, const char *value, struct options *o)
{
    read_load(origin, value, 0, &o->loads);
}

static void set_base(const char *origin, const char *value, struct options *o)
{
    read_load(origin, value, 1, &o->loads);
}

static void set_output(const char *origin, const char *value, struct options *o)
{
    o->output = need_room(o->output, o->outputs, &o->output_room, sizeof *o->output);
    o->output[o->outputs++] = read_place(origin, value);
}

static void set_field(const char *origin, const char *value, struct options *o)
{
    o->field.count = 0;
    read_list(origin, value, &o->field);
    for (size_t k = 0; k < o->field.count; k++) {
        if (!(o->field.value[k] >= 0.0 && o->field.value[k] <= 360.0)) {
            die("%s: a phase must be from 0 to 360 degrees", origin);
        }
    }
}

static void set_limits(const char *origin, const char *value, struct options *o)
{
    o->limits = read_range(origin, value);
}

static void set_force(const char *origin, const char *value, struct options *o)
{
    o->force = read_real(origin, value, 0.0, 0);
}

static void set_drive(const char *origin, const char *value, struct options *o)
{
    const int first = strcmp(value, "0") == 0;
    o->drive = first ? (struct range){0.0, 0.0, 1} : read_range(origin, value);
}

static void set_method(const char *origin, const char *value, struct options *o)
{
    o->march = strcmp(value, "march") == 0;
    if (!o->march && strcmp(value, "exact") != 0) {
        die("%s: methods are exact and march", origin);
    }
}

static void set_step(const char *origin, const char *value, struct options *o)
{
    o->step = read_real(origin, value, 0.0, 0);
    if (o->step > 1.0) {
        die("%s: at most 1, for the highest mode kept to be followed", origin);
    }
}

static void set_law(const char *origin, const char *value, struct options *o)
{
    char names[200] = "";
    if (tribo_law_find(value, &o->law)) {
        for (int i = 0; i < tribo_law_count(); i++) {
            const size_t length = strlen(names);
            snprintf(names + length, sizeof names - length, " %s", tribo_law_name(i));
        }
        die("%s: no law has this name; there are%s", origin, names);
    }
    /* nothing holds a velocity at 0 in rk4, whose four stages meet forces of either sign that may cancel */
    if (o->law == TRIBO_KARNOPP) {
        die("%s: the contacts of this law rest at velocities that are exactly zero, which marching does not make: take coulomb, "
            "quinn, quinn-reversal, velocity-limited or smooth",
            origin);
    }
}

static void set_plot(const char *origin, const char *value, struct options *o)
{
    if (strcmp(value, "png") != 0 && strcmp(value, "svg") != 0) {
        die("%s: must be png or svg", origin);
    }
    o->plot = value;
}

static void set_name(const char *origin, const char *value, struct options *o)
{
    if (*value == '\0' || strcspn(value, "/ \t") != strlen(value)) {
        die("%s: files cannot be named so", origin);
    }
    o->name = value;
}

/* --------------------------------------------------------------------------------------------------------------- table */

#define FILE_OPTION(name) "--" #name, NULL, offsetof(struct options, name), 1, 0, 0
#define COUNT_OPTION(name, least) "--" #name, NULL, offsetof(struct options, name), 0, 1, least
#define OPTION(name) "--" #name, set_##name, 0, 0, 0, 0

static const struct option {
    const char *name;
    setter *set;   /* NULL: the value itself is kept, or the count */
    size_t offset; /* of the member that keeps it */
    int is_path, is_count;
    size_t least; /* of a count */
} table[] = {
    {FILE_OPTION(mass)},
    {FILE_OPTION(stiffness)},
    {FILE_OPTION(dofs)},
    {FILE_OPTION(frequencies)},
    {FILE_OPTION(out)},
    {OPTION(name)},
    {COUNT_OPTION(modes, 1)},
    {OPTION(statics)},
    {OPTION(damping)},
    {"--damping-ratios", set_damping_ratios, 0, 1, 0, 0},
    {"--damping-matrix", NULL, offsetof(struct options, damping_matrix), 1, 0, 0},
    {OPTION(contact)},
    {"--contacts", set_contacts, 0, 1, 0, 0},
    {OPTION(load)},
    {OPTION(base)},
    {OPTION(output)},
    {COUNT_OPTION(harmonics, 1)},
    {OPTION(field)},
    {OPTION(force)},
    {OPTION(drive)},
    {OPTION(limits)},
    {OPTION(method)},
    {COUNT_OPTION(check, 0)},
    {OPTION(step)},
    {OPTION(law)},
    {COUNT_OPTION(threads, 1)},
    {OPTION(plot)},
};

/* name has length characters, and no hyphens in front. */
static const struct option *find_option(const char *name, size_t length)
{
    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        if (strlen(table[k].name) == length + 2 && strncmp(name, table[k].name + 2, length) == 0) {
            return &table[k];
        }
    }
    return NULL;
}

static void apply(const struct option *option, const char *origin, const char *value, struct options *o)
{
    if (option->set) {
        option->set(origin, value, o);
    } else if (option->is_count) {
        const size_t count = read_whole(origin, value, option->least);
        memcpy((char *)o + option->offset, &count, sizeof count);
    } else {
        memcpy((char *)o + option->offset, &value, sizeof value);
    }
}

/* ---------------------------------------------------------------------------------------------------- files of options */

/* A relative path is relative to the folder of the file that holds the option. */
static const char *path_beside(const char *file, const char *path)
{
    const char *slash = strrchr(file, '/');
    const int as_it_is = path[0] == '/' || !slash || strcmp(path, "none") == 0;
    return as_it_is ? new_text("%s", path) : new_text("%.*s/%s", (int)(slash - file), file, path);
}

/* An option a line: its name without hyphens, a blank or an equals sign, and its value up to the end of the line. */
static void read_option_file(const char *path, struct options *o)
{
    struct lines l = open_lines(path);
    while (next_data(&l)) {
        const size_t length = strcspn(l.at, "= \t\r");
        const struct option *option = find_option(l.at, length);
        char *value = l.at + length + (l.at[length] == '='), *end = l.at + strlen(l.at);
        value += strspn(value, " \t\r");
        while (end > value && strchr(" \t\r", end[-1])) {
            *--end = '\0';
        }
        if (!option) {
            die_at(&l, "there is no option \"%.*s\"; see --help", (int)length, l.at);
        }
        if (*value == '\0') {
            die_at(&l, "option %s needs a value", option->name + 2);
        }
        apply(option, make_printable(new_text("%s:%zu: %s %s", path, l.line, option->name + 2, value)),
              option->is_path ? path_beside(path, value) : new_text("%s", value), o);
    }
    close_lines(&l);
}

/* ------------------------------------------------------------------------------------------------------------- the whole */

static void need_structure(const struct options *o)
{
    const struct {
        const char *name;
        int given;
    } part[] = {{"--mass", o->mass != NULL},
                {"--stiffness", o->stiffness != NULL},
                {"--dofs", o->dofs != NULL},
                {"--contact", o->contacts.count > 0},
                {"--load", o->loads.count > 0}};
    char missing[80] = "";
    for (size_t k = 0; k < sizeof part / sizeof *part; k++) {
        if (!part[k].given) {
            strcat(strcat(missing, " "), part[k].name);
        }
    }
    if (missing[0]) {
        die("what is missing:%s; see --help", missing);
    }
}

int limits_vary(const struct options *o)
{
    int vary = 0;
    for (size_t c = 0; c < o->contacts.count; c++) {
        vary = vary || isnan(o->contacts.contact[c].limit);
    }
    return vary;
}

const char *word_for_limit(const struct options *o)
{
    int by_load = 0;
    for (size_t c = 0; c < o->contacts.count; c++) {
        by_load = by_load || o->contacts.contact[c].by_load;
    }
    return by_load ? "normal load" : "limit";
}

const struct place *measured_place(const struct options *o)
{
    for (size_t k = 0; k < o->loads.count; k++) {
        if (!o->loads.load[k].supports) {
            return &o->loads.load[k].at;
        }
    }
    return o->outputs ? &o->output[0] : NULL;
}

/* Options that need others, or exclude them. */
static void check_together(const struct options *o)
{
    if (!measured_place(o)) {
        die("%s: --output is missing, the place where amplitudes are measured", o->loads.load[0].at.origin);
    }
    if (o->damping_matrix && o->damping.count) {
        die("option --damping-matrix %s: either a matrix or damping ratios, not both", o->damping_matrix);
    }
    if (o->harmonics && !o->outputs) {
        die("option --harmonics %zu: --output is missing, a place where they are wanted", o->harmonics);
    }
    if (o->field.count && o->drive.points > 1) {
        die("option --field: displacement fields are for one frequency: --drive HZ");
    }
    for (size_t c = 0; c < o->contacts.count; c++) {
        if (o->contacts.contact[c].stiffness > 0.0 && (o->march || o->check) && o->law != TRIBO_COULOMB) {
            die("%s: with --law %s marching takes rigid contacts only: leave out stiffness=, or --law",
                o->contacts.contact[c].at.origin, tribo_law_name(o->law));
        }
        if (o->contacts.contact[c].planar && !o->march) {
            die("%s: contacts in a plane are for --method march; method exact knows contacts along one axis only",
                o->contacts.contact[c].at.origin);
        }
    }
}

/* The mass that moves along a direction with the supports. */
static double mass_along(const struct structure *s, int direction)
{
    double mass = 0.0;
    for (size_t i = 0; i < s->ndof; i++) {
        for (size_t k = s->mass.first[i]; s->dof[i].direction == direction && k < s->mass.first[i + 1]; k++) {
            mass += s->dof[s->mass.col[k]].direction == direction ? s->mass.val[k] : 0.0;
        }
    }
    return mass;
}

void complete_options(struct options *o, const struct structure *s)
{
    for (size_t k = 0; k < o->loads.count; k++) {
        struct load *l = &o->loads.load[k];
        l->size = isnan(l->size) ? o->force : l->size;
        o->size += l->supports ? l->size * mass_along(s, l->at.direction) : l->size;
    }
    if (!limits_vary(o)) {
        o->limits = (struct range){1.0, 1.0, 1};
    } else if (!o->limits.points) {
        o->limits =
            (struct range){LIMIT_FROM * o->size, LIMIT_TO * o->size, o->drive.points > 1 ? FAMILY_LIMITS : CURVE_LIMITS};
    }
    for (size_t c = 0; c < o->contacts.count; c++) {
        const struct contact *contact = &o->contacts.contact[c];
        const double most = isnan(contact->limit) ? contact->mu * o->limits.to : contact->limit;
        if (!isfinite(most)) {
            die("%s: mu times the normal load, up to %g, is too large a limit", contact->at.origin, o->limits.to);
        }
    }
}

/* --help and --version: prints, and ends the program. */
static void answer(const char *name)
{
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0) {
        print_help();
    } else if (strcmp(name, "--version") == 0) {
        printf("%s %s\n", program, tribo_version_string());
    } else {
        return;
    }
    close_file(stdout, "standard output");
    exit(EXIT_SUCCESS);
}

struct options read_options(int argc, char **argv)
{
    struct options o = standard;
    o.drive.points = 1;
    for (int i = 1; i < argc; i++) {
        const size_t length = strcspn(argv[i], "=");
        const char *name = new_text("%.*s", (int)length, argv[i]);
        const struct option *option = strncmp(name, "--", 2) == 0 ? find_option(name + 2, length - 2) : NULL;
        const int read = strcmp(name, "--read") == 0;
        answer(argv[i]);
        if (!option && !read) {
            die("there is no option \"%s\"; see --help", name);
        }
        const char *value = argv[i][length] ? argv[i] + length + 1 : argv[++i];
        if (!value || !*value) {
            die("option %s needs a value; see --help", name);
        }
        if (read) {
            read_option_file(value, &o);
        } else {
            apply(option, new_text("option %s %s", name, value), value, &o);
        }
    }
    need_structure(&o);
    check_together(&o);
    if (!limits_vary(&o) && o.limits.points) {
        die("option --limits: every contact has a limit of its own, and none follows");
    }
    if (!o.damping.count && !o.damping_matrix) {
        add_number(&o.damping, DAMPING);
    }
    if (o.frequencies && strcmp(o.frequencies, "none") == 0) {
        o.frequencies = NULL;
    }
    return o;
}
