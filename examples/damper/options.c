#include "options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../common/output.h"
#include "tribo/tribo.h"

static const char help[] =
    "friction_damper: a structure with friction contacts to ground, driven at a resonance.\n"
    "\n"
    "Reads mass and stiffness, keeps the lowest modes, and finds the steady motion for contacts of every limit (mu times\n"
    "normal force, the same for all) in a range: amplitude where the load acts, and the power that friction dissipates.\n"
    "Then it refines the limit that dissipates most, the optimum friction damper, and writes the motion there.\n"
    "\n"
    "Without options it is a steel beam on three contacts. A structure of your own needs the first five:\n"
    "  --mass FILE          Matrix Market, symmetric (lower triangle) or general\n"
    "  --stiffness FILE     the same\n"
    "  --dofs FILE          for each row of the matrices: row node direction x y z; direction 1, 2, 3 is\n"
    "                       x, y, z, and x y z are the node's place, lengths\n"
    "  --contact X,Y,Z,DIR  a contact to ground at the node with these coordinates, sliding along DIR = x, y or z; may be\n"
    "                       given up to %d times\n"
    "  --load X,Y,Z,DIR     where and in which direction the harmonic load acts\n"
    "\n"
    "  --frequencies FILE   natural frequencies in Hz from elsewhere, to be shown beside those found; \"none\"\n"
    "  --modes COUNT        lowest modes to keep; %d, or all where there are fewer\n"
    "  --damping RATIO      of every mode to critical damping, above 0 and below 1; %g\n"
    "  --force AMPLITUDE    of the load, a force; 1 (%g for the beam)\n"
    "  --drive HZ           frequency of the load; 0 (the default) means the first natural frequency\n"
    "  --limits FROM:TO:N   limits of the contacts, forces, N of them in equal ratios; %g and %g times the load's, %d\n"
    "  --step RADIANS       time step times the highest natural frequency kept, at most 1; %g (and 400 steps a period)\n"
    "  --law NAME           friction law; %s\n"
    "  --out FOLDER         where the tables go, which must exist; \"%s\"\n"
    "\n"
    "Any consistent units will do: N, m, kg, s; or N, mm, tonne, s. Frequencies are in Hz if time is in s, else in cycles a\n"
    "unit of time; powers in force times length over time (N mm/s = mW).\n"
    "\n"
    "The beam (N, mm, tonne, s):\n"
    "  --mass %s\n  --stiffness %s\n  --dofs %s\n  --frequencies %s\n"
    "  --contact %s --contact %s --contact %s --load %s\n";

static const struct options beam = {
    .mass = BEAM "/M.mtx",
    .stiffness = BEAM "/K.mtx",
    .dofs = BEAM "/dofs.txt",
    .frequencies = BEAM "/frequencies.txt",
    .contact = {{{200.0, 0.0, 5.0}, 3, "200,0,5,z"}, {{300.0, 0.0, 5.0}, 3, "300,0,5,z"}, {{400.0, 0.0, 5.0}, 3, "400,0,5,z"}},
    .load = {{400.0, 20.0, 5.0}, 3, "400,20,5,z"},
    .contacts = 3,
    .force = 0.1,
};

/* For any structure. */
static const struct options standard = {.out = ".", .damping = 0.002, .limit_points = 33, .step = 0.25, .law = TRIBO_QUINN};
static const double LIMIT_FROM = 1e-3, LIMIT_TO = 10.0; /* times the load */

static void print_help(void)
{
    printf(help, (int)MAX_CONTACTS, (int)DEFAULT_MODES, standard.damping, beam.force, LIMIT_FROM, LIMIT_TO,
           (int)standard.limit_points, standard.step, tribo_law_name(standard.law), standard.out, beam.mass, beam.stiffness,
           beam.dofs, beam.frequencies, beam.contact[0].text, beam.contact[1].text, beam.contact[2].text, beam.load.text);
}

/* Reads a number that ends with the character end, and returns what is behind that. */
static const char *read_number(const char *option, const char *whole, const char *at, char end, double *value)
{
    char *stop;
    *value = strtod(at, &stop);
    if (stop == at || *stop != end || !isfinite(*value)) {
        die("option %s %s: expected a finite number%s%.1s at \"%s\"", option, whole, end ? ", then " : "", &end, at);
    }
    return end ? stop + 1 : stop;
}

static double read_real(const char *option, const char *text, double smallest, int may_equal)
{
    double value;
    read_number(option, text, text, '\0', &value);
    if (value < smallest || (value == smallest && !may_equal)) {
        die("option %s %s: must be %s %g", option, text, may_equal ? "at least" : "above", smallest);
    }
    return value;
}

static size_t read_whole(const char *option, const char *whole, const char *text, size_t smallest)
{
    double value;
    read_number(option, whole, text, '\0', &value);
    if (value != floor(value) || value < (double)smallest || value > 1e6) {
        die("option %s %s: expected a whole number from %zu to 1000000, found %s", option, whole, smallest, text);
    }
    return (size_t)value;
}

static struct place read_place(const char *option, const char *text)
{
    struct place p = {{0.0, 0.0, 0.0}, 0, text};
    const char *at = text;
    for (int i = 0; i < 3; i++) {
        at = read_number(option, text, at, ',', &p.at[i]);
    }
    for (int d = 1; d <= 3; d++) {
        if (at[0] && !at[1] && (at[0] == "xyz"[d - 1] || at[0] == "123"[d - 1])) {
            p.direction = d;
        }
    }
    if (!p.direction) {
        die("option %s %s: direction \"%s\" must be x, y or z", option, text, at);
    }
    return p;
}

static int read_law(const char *option, const char *text)
{
    char names[200] = "";
    int law;
    if (tribo_law_find(text, &law)) {
        for (int i = 0; i < tribo_law_count(); i++) {
            const size_t length = strlen(names);
            snprintf(names + length, sizeof names - length, " %s", tribo_law_name(i));
        }
        die("option %s %s: no law has this name; there are%s", option, text, names);
    }
    return law;
}

/* One setter for each option: its name (for messages), its value, and where to put that. */
typedef void setter(const char *name, const char *value, struct options *o);

static void set_mass(const char *name, const char *value, struct options *o)
{
    (void)name;
    o->mass = value;
}

static void set_stiffness(const char *name, const char *value, struct options *o)
{
    (void)name;
    o->stiffness = value;
}

static void set_dofs(const char *name, const char *value, struct options *o)
{
    (void)name;
    o->dofs = value;
}

static void set_frequencies(const char *name, const char *value, struct options *o)
{
    (void)name;
    o->frequencies = value;
}

static void set_out(const char *name, const char *value, struct options *o)
{
    (void)name;
    o->out = value;
}

static void set_modes(const char *name, const char *value, struct options *o)
{
    o->modes = read_whole(name, value, value, 1);
}

static void set_damping(const char *name, const char *value, struct options *o)
{
    o->damping = read_real(name, value, 0.0, 0);
    if (o->damping >= 1.0) {
        die("option %s %s: must be below 1", name, value);
    }
}

static void add_contact(const char *name, const char *value, struct options *o)
{
    if (o->contacts == MAX_CONTACTS) {
        die("option %s %s: there are %d contacts already", name, value, (int)MAX_CONTACTS);
    }
    o->contact[o->contacts++] = read_place(name, value);
}

static void set_load(const char *name, const char *value, struct options *o)
{
    o->load = read_place(name, value);
}

static void set_force(const char *name, const char *value, struct options *o)
{
    o->force = read_real(name, value, 0.0, 0);
}

static void set_drive(const char *name, const char *value, struct options *o)
{
    o->drive = read_real(name, value, 0.0, 1);
}

static void set_limits(const char *name, const char *value, struct options *o)
{
    const char *at = read_number(name, value, value, ':', &o->limit_from);
    at = read_number(name, value, at, ':', &o->limit_to);
    o->limit_points = read_whole(name, value, at, 1);
    if (o->limit_from <= 0.0 || o->limit_to < o->limit_from || (o->limit_to == o->limit_from && o->limit_points > 1)) {
        die("option %s %s: limits must be positive and ascend", name, value);
    }
}

static void set_step(const char *name, const char *value, struct options *o)
{
    o->step = read_real(name, value, 0.0, 0);
    if (o->step > 1.0) {
        die("option %s %s: at most 1, for the highest mode kept to be followed", name, value);
    }
}

static void set_law(const char *name, const char *value, struct options *o)
{
    o->law = read_law(name, value);
}

static const struct {
    const char *name;
    setter *set;
} table[] = {
    {"--mass", set_mass},       {"--stiffness", set_stiffness},
    {"--dofs", set_dofs},       {"--frequencies", set_frequencies},
    {"--modes", set_modes},     {"--damping", set_damping},
    {"--contact", add_contact}, {"--load", set_load},
    {"--force", set_force},     {"--drive", set_drive},
    {"--limits", set_limits},   {"--step", set_step},
    {"--law", set_law},         {"--out", set_out},
};

static setter *find_setter(const char *name)
{
    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        if (strcmp(name, table[k].name) == 0) {
            return table[k].set;
        }
    }
    die("there is no option \"%s\"; see --help", name);
    return NULL;
}

/* Nothing of the beam belongs to a structure of the user's own, nor may a part of that be missing. */
static void need_structure(const struct options *o)
{
    const struct {
        const char *name;
        int given;
    } part[] = {{"--mass", o->mass != NULL},
                {"--stiffness", o->stiffness != NULL},
                {"--dofs", o->dofs != NULL},
                {"--contact", o->contacts > 0},
                {"--load", o->load.text != NULL}};
    char missing[80] = "";
    for (size_t k = 0; k < sizeof part / sizeof *part; k++) {
        if (!part[k].given) {
            strcat(strcat(missing, " "), part[k].name);
        }
    }
    if (missing[0]) {
        die("a structure of your own needs also%s; see --help", missing);
    }
}

static void take_beam(struct options *o)
{
    o->mass = beam.mass;
    o->stiffness = beam.stiffness;
    o->dofs = beam.dofs;
    o->frequencies = o->frequencies ? o->frequencies : beam.frequencies;
    o->force = o->force > 0.0 ? o->force : beam.force;
    if (o->contacts == 0) {
        memcpy(o->contact, beam.contact, sizeof o->contact);
        o->contacts = beam.contacts;
    }
    if (!o->load.text) {
        o->load = beam.load;
    }
}

/* What has not been given. */
static void complete(struct options *o)
{
    if (o->mass || o->stiffness || o->dofs) {
        need_structure(o);
    } else {
        take_beam(o);
    }
    if (o->frequencies && strcmp(o->frequencies, "none") == 0) {
        o->frequencies = NULL;
    }
    o->force = o->force > 0.0 ? o->force : 1.0;
    if (!(o->limit_to > 0.0)) {
        o->limit_from = LIMIT_FROM * o->force;
        o->limit_to = LIMIT_TO * o->force;
    }
}

struct options read_options(int argc, char **argv)
{
    struct options o = standard;
    for (int i = 1; i < argc; i += 2) {
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) {
            print_help();
            exit(EXIT_SUCCESS);
        }
        setter *set = find_setter(argv[i]);
        if (i + 1 == argc) {
            die("option %s needs a value; see --help", argv[i]);
        }
        set(argv[i], argv[i + 1], &o);
    }
    complete(&o);
    return o;
}
