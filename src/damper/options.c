/* SPDX-License-Identifier: BSD-3-Clause */
#include "options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tribo/tribo.h"

static const struct options standard = {.out = ".",
                                        .name = "damper",
                                        .drive = {0.0, 0.0, 1},
                                        .cycle = -1.0,
                                        .force = 1.0,
                                        .statics = 1,
                                        .step = 0.25,
                                        .law = TRIBO_COULOMB};
static const double DAMPING = 0.002;

/* ------------------------------------------------------------------------------------------------------------- readers */

/* Returns the index of the value among count words; all: the words, for the message. */
static int choose(const struct text *value, const char *const *word, int count, const char *all)
{
    int k = 0;
    while (k < count && strcmp(value->at, word[k]) != 0) {
        k++;
    }
    die_at_if(value, k == count, "must be %s", all);
    return k;
}

static void read_statics(struct text *value, void *statics)
{
    *(int *)statics = choose(value, (const char *const[]){"off", "on"}, 2, "off or on");
}

static void read_method(struct text *value, void *march)
{
    *(int *)march = choose(value, (const char *const[]){"exact", "march"}, 2, "exact or march");
}

static void read_follow(struct text *value, void *follow)
{
    static const char *const ways[] = {"down:events", "down", "", "up", "up:events"};
    *(int *)follow = choose(value, ways, 5, "up, down, up:events or down:events") - 2;
}

static void read_plot(struct text *value, void *plot)
{
    static const char *const formats[] = {"png", "svg"};
    *(const char **)plot = formats[choose(value, formats, 2, "png or svg")];
}

static void read_path(struct text *value, void *path)
{
    *(const char **)path = value->at;
}

static void read_count(struct text *value, void *count)
{
    *(size_t *)count = next_whole(value, "number", "", 1, MOST_COUNT);
}

static void read_check(struct text *value, void *count)
{
    *(size_t *)count = next_whole(value, "number", "", 0, MOST_COUNT);
}

static void check_ratio(const struct text *t, double ratio)
{
    die_at_if(t, !(ratio > 0.0 && ratio < 1.0), "%g: must be above 0 and below 1", ratio);
}

static void read_damping(struct text *value, void *to)
{
    struct list *ratios = to;
    read_list(value, ratios);
    for (size_t k = 0; k < ratios->count; k++) {
        check_ratio(value, ratios->value[k]);
    }
}

static void read_damping_file(struct text *value, void *to)
{
    struct list *ratios = to;
    struct text t = open_text(value->at);
    ratios->count = 0;
    while (next_data(&t)) {
        const double ratio = next_real(&t, "damping ratio", "");
        check_ratio(&t, ratio);
        add_number(ratios, ratio);
    }
    die_at_if(value, ratios->count == 0, "there is no damping ratio in it");
}

static void read_output(struct text *value, void *to)
{
    struct outputs *all = to;
    all->place = need_room(all->place, all->count, sizeof *all->place);
    all->place[all->count++] = read_place(value);
}

static void read_field(struct text *value, void *to)
{
    struct list *phases = to;
    read_list(value, phases);
    for (size_t k = 0; k < phases->count; k++) {
        die_at_if(value, !(phases->value[k] >= 0.0 && phases->value[k] <= 360.0), "%g: a phase must be from 0 to 360 degrees",
                  phases->value[k]);
    }
}

static void read_force(struct text *value, void *force)
{
    *(double *)force = next_positive(value, "force", "");
}

static void read_cycle(struct text *value, void *period)
{
    *(double *)period = next_real(value, "period", "");
    die_at_if(value, *(double *)period < 0.0, "must be at least 0");
}

static void read_drive(struct text *value, void *drive)
{
    if (strcmp(value->at, "0") == 0) {
        *(struct range *)drive = standard.drive;
    } else {
        read_range(value, drive);
    }
}

static void read_step(struct text *value, void *to)
{
    const double step = next_positive(value, "step", "");
    die_at_if(value, step > 1.0, "at most 1, for the highest mode kept to be followed");
    *(double *)to = step;
}

static void read_law(struct text *value, void *to)
{
    int *law = to;
    char names[200] = "";
    for (int i = 0; i < tribo_law_count(); i++) {
        strcat(strcat(names, " "), tribo_law_name(i));
    }
    die_at_if(value, tribo_law_find(value->at, law), "no law has this name; there are%s", names);
    /* nothing holds a velocity at 0 in rk4, whose four stages meet forces of either sign that may cancel */
    die_at_if(value, *law == TRIBO_KARNOPP,
              "the contacts of this law rest at velocities that are exactly zero, which marching does not make: take "
              "coulomb, quinn, quinn-reversal, velocity-limited or smooth");
}

static void read_name(struct text *value, void *name)
{
    die_at_if(value, strcspn(value->at, "/ \t") != strlen(value->at), "files cannot be named so");
    *(const char **)name = value->at;
}

static reader read_option_file;

/* --------------------------------------------------------------------------------------------------------------- table */

#define OPTION(function, member) function, offsetof(struct options, member)
#define TEXT NULL, 0

/* Help, and options in it: name and argument are the first words of the help. Of FILE and FOLDER, a relative path in a file of
 * options is relative to the folder of that file. */
static const struct option {
    reader *read;  /* of the value, into */
    size_t offset; /* the member there */
    const char *help;
} table[] = {
    {TEXT,
     "tribo-damper: steady response of a structure with friction contacts to a harmonic load.\n"
     "\n"
     "Reads mass and stiffness, keeps the lowest modes and the static responses to forces at contacts and loads, and finds the\n"
     "motion that repeats itself with every period of the load, to 1e-10 within the modes kept, under Coulomb friction itself:\n"
     "contacts slide, stick for a part of the period, or stick for ever. The model error is that of the modes left out:\n"
     "some points, more of them where changes are large, are computed again with twice the modes; 2.5 times the largest\n"
     "change is printed.\n"
     "  one frequency (--drive HZ):       response over the limits of the contacts, the limit at which friction dissipates\n"
     "                                    most, and the motion there; with one limit (--limits FORCE) the motion at that limit\n"
     "  a band (--drive FROM:TO:N):       response over frequency for each limit, and the best limit: the one with the smallest\n"
     "                                    of the largest amplitudes\n"
     "Points are added where curves bend. A motion that is not found leaves a gap in the table, with a message.\n"},
    {TEXT, "\n"
           "The structure:\n"},
    {OPTION(read_path, mass), "  --mass FILE          Matrix Market, symmetric (lower triangle) or general\n"},
    {OPTION(read_path, stiffness), "  --stiffness FILE     the same\n"},
    {OPTION(read_path, dofs),
     "  --dofs FILE          for each row of the matrices: row node direction x y z; direction 1, 2, 3 is x, y, z; x y z is the\n"
     "                       place of the node, lengths\n"},
    {OPTION(read_contact, contacts),
     "  --contact CONTACT    X,Y,Z,DIR: a contact to ground at the node with these coordinates, sliding along DIR (x, y or z);\n"
     "                       or in a plane, xy, xz or yz. A contact in a plane has two columns in the tables,\n"
     "                       one for each direction. Words may follow, separated by colons or blanks:\n"
     "                         to=X,Y,Z      the contact is not to ground but to this node\n"
     "                         limit=FORCE   its limit, in a plane in any direction; without, the limit is that of --limits\n"
     "                         mu=NUMBER     its limit is mu times the normal load, and --limits gives normal loads\n"
     "                         mu=NUMBER load=FORCE   its limit is the product\n"
     "                         stiffness=NUMBER   a spring before the slider, force over length: the contact gives way while it\n"
     "                                            sticks; with --law coulomb only\n"
     "                         normal=DIR,STIFFNESS   the normal load follows the motion: that of a spring along DIR, which\n"
     "                                            presses as the node moves along DIR (against it: -DIR), relative to the other\n"
     "                                            end, and lifts off; mu= is needed. At rest the spring has the load of load=\n"
     "                                            or --limits, which the structure holds; or, with gap=LENGTH, it begins to\n"
     "                                            press at this displacement, below 0 if it presses at rest\n"
     "                         belt=VELOCITY   with --cycle: the other end moves along the contact\n"
     "                         static=RATIO    with --cycle: limit at rest over limit of sliding, at least 1; rigid contacts\n"},
    {OPTION(read_contacts, contacts), "  --contacts FILE      contacts, one a line, in the same words\n"},
    {TEXT, "\n"
           "The loads, at least one --load or --base; each may be given several times:\n"},
    {OPTION(read_load, loads),
     "  --load LOAD          X,Y,Z,DIR: a force F sin(omega t + phase) at this node along DIR. Words may follow:\n"
     "                         force=FORCE     F; without, that of --force\n"
     "                         phase=DEGREES   0\n"},
    {OPTION(read_base, loads),
     "  --base BASE          DIR:acceleration=NUMBER, phase=DEGREES may follow: all supports move along DIR with acceleration\n"
     "                       A sin(omega t + phase), and the ground of contacts moves with the supports. The loads are -M r A,\n"
     "                       r being 1 for direction DIR; all displacements are relative to the supports\n"},
    {TEXT, "Amplitudes are measured at the first --load; without --load at the first --output.\n"
           "\n"
           "Optional:\n"},
    {OPTION(read_drive, drive),
     "  --drive HZ           frequency of the loads, or a band FROM:TO:N that begins with N frequencies; 0 (the default): the\n"
     "                       first natural frequency\n"},
    {OPTION(read_follow, follow),
     "  --follow up|down     a band: each curve is followed from its lower end up, or from its upper end down, also where it\n"
     "                       turns back (pseudo-arc-length), in steps of at most a distance of the N frequencies; whether\n"
     "                       motions are stable, and special points of the curve, are found. No best limit is looked for.\n"
     "                       up:events, down:events: changes of the sequence of events are special points, too, of which\n"
     "                       contacts on many modes have hundreds\n"},
    {OPTION(read_range, limits),
     "  --limits FROM:TO:N   N limits of contacts (forces), geometric from FROM to TO; or one limit. Default: 0.001 to 10 times\n"
     "                       the sum of the forces (of --base: moving mass times acceleration), 33 limits, or 9 for a band\n"},
    {OPTION(read_count, backbone),
     "  --backbone MODE      in the place of a response: natural frequency and damping ratio of this mode over the amplitude,\n"
     "                       as free vibrations have them (nonlinear mode), at one limit. MODE counts as with all contacts\n"
     "                       stuck. Loads do not act; without --load amplitudes are measured at the first --output. Contacts\n"
     "                       that stick for a part of the period need stiffness=\n"},
    {OPTION(read_range, amplitudes),
     "  --amplitudes FROM:TO:N   N amplitudes of --backbone, geometric from FROM to TO; or one\n"},
    {OPTION(read_cycle, cycle),
     "  --cycle PERIOD       in the place of a response: the motion that contacts on belts keep up by themselves, stick-slip or\n"
     "                       squeal, from rest, at one limit; PERIOD is a guess, 0: none. There are no loads; amplitudes are\n"
     "                       measured at the first --output. A cycle that twice the modes do not have is one of the modes kept:\n"
     "                       --modes left out, more of them are taken\n"},
    {OPTION(read_output, outputs),
     "  --output X,Y,Z,DIR   a further place: amplitude and phase there; may be given several times\n"},
    {OPTION(read_count, harmonics), "  --harmonics N        of each --output also the harmonics 1 to N\n"},
    {OPTION(read_field, field),
     "  --field DEG,DEG,...  displacements of the whole structure at these phases of the loads' period, 0 to 360, of each\n"
     "                       motion written (history, sticking, loop below): damper-loop.vtk, legacy VTK, for ParaView\n"},
    {OPTION(read_force, force), "  --force AMPLITUDE    of loads without force=; 1\n"},
    {OPTION(read_count, modes),
     "  --modes COUNT        the number of lowest modes. Default: 12 or more, up to 200, until the model error is below 1%\n"},
    {OPTION(read_statics, statics),
     "  --statics on|off     static responses beside the modes; on. Without them contacts that stick are too stiff\n"},
    {OPTION(read_damping, damping),
     "  --damping RATIOS     damping ratios of mode 1, 2, ..., separated by commas, above 0 and below 1; the last one holds for\n"
     "                       all further modes and static responses; 0.002\n"},
    {OPTION(read_damping_file, damping), "  --damping-ratios FILE   the same from a file, one a line\n"},
    {OPTION(read_path, damping_matrix),
     "  --damping-matrix FILE   viscous damping of the structure as a matrix, in the place of ratios\n"},
    {OPTION(read_path, frequencies),
     "  --frequencies FILE   natural frequencies in Hz from elsewhere, shown beside the natural frequencies found; \"none\"\n"},
    {OPTION(read_method, march),
     "  --method NAME        exact; or march: time steps until the motion repeats itself, slow, also for contacts in a\n"
     "                       plane with normal=\n"},
    {OPTION(read_check, check),
     "  --check N            computes N points also by marching, and shows the differences: another method, the same modes; 0\n"},
    {OPTION(read_law, law),
     "  --law NAME           friction law for marching: coulomb (the default), by the implicit midpoint rule; or by rk4 quinn,\n"
     "                       quinn-reversal, velocity-limited, smooth; the last two never stick\n"},
    {OPTION(read_step, step),
     "  --step NUMBER        time step for marching, at most 1: with 0.25 (the default) a period has 4000 steps; with rk4 the\n"
     "                       step is NUMBER by the highest natural frequency kept, and a period has at least 400 steps\n"},
    {OPTION(read_count, threads), "  --threads COUNT      default: one a core. Results do not depend on it\n"},
    {OPTION(read_path, out), "  --out FOLDER         folder of the tables, which must exist; \".\"\n"},
    {OPTION(read_name, name), "  --name WORD          first part of the names of tables; \"damper\"\n"},
    {OPTION(read_plot, plot),
     "  --plot png|svg       draws the tables by gnuplot: damper-family, damper-curve or damper-backbone, and the loops of\n"
     "                       contacts; the script damper-plot.gp stays beside them\n"},
    {read_option_file, 0,
     "  --read FILE          options from a file, one a line, without hyphens; names of files are relative to its folder; lines\n"
     "                       that begin with # are comments\n"},
    {TEXT,
     "  --help, -h           prints this text\n"
     "  --version            prints the name of the tool and the version of the library\n"
     "Values may also follow an equals sign: --limits=0.1:10:9.\n"
     "\n"
     "Any consistent units: N, m, kg, s; or N, mm, tonne, s. Frequencies are in Hz if time is in s, else in cycles a unit of\n"
     "time; powers in force times length over time (N mm/s = mW).\n"
     "\n"
     "Tables (comma-separated, in the folder of --out, damper being --name):\n"
     "  damper-frequencies.csv   mode, its natural frequency, that of --frequencies, relative difference, frequency with all\n"
     "                           contacts stuck\n"
     "  damper-curve.csv         one frequency: the response over the limit\n"
     "  damper-history.csv       one frequency: three periods at the limit of most power; cycle, time, displacement where\n"
     "                           amplitudes are measured; of each contact velocity (with a spring, of the slider), force,\n"
     "                           and slip (0 sticks, 1 and -1 slides, 2 open, 3 slides in a plane); then of each contact the\n"
     "                           displacement, over which the force makes its hysteresis loop; then each normal spring's load\n"
     "  damper-sticking.csv      the same at three times that limit\n"
     "  damper-loop.csv          one frequency and one limit: the same there\n"
     "  damper-history.vtk, damper-sticking.vtk, damper-loop.vtk   with --field: nodes, and vectors displacement_DEG\n"
     "  damper-family.csv        a band: the response over frequency, a blank line between curves\n"
     "  damper-best.csv          a band: the curve of the best limit\n"
     "  damper-linear.csv        a band: frequency, amplitude without friction, amplitude with all contacts stuck for ever\n"
     "  damper-check.csv         the points of --check, by marching\n"
     "  damper-cycle.csv         --cycle: as damper-history.csv, three periods of the cycle\n"
     "  damper-backbone.csv      --backbone: amplitude, frequency, damping ratio, of each contact the share of the period for\n"
     "                           which it sticks, message\n"
     "  values-damper.txt        all single results, with all digits\n"
     "Columns of responses: limit (1 if every contact has its own); frequency; amplitude (half of the way from the smallest to\n"
     "the largest displacement); mean powers over a period, lost to friction, lost to damping, put in by the loads; periods\n"
     "that were integrated; message, empty if the motion was found, but with normal= unstable motions are found, too; for each\n"
     "contact, in the order given, the power that it dissipates, the share of the period for which it sticks, and with normal=\n"
     "that for which it is open, all blank by marching; for each --output amplitude, phase of\n"
     "the first harmonic, and with --harmonics the amplitude of harmonic 1, amplitude and phase of harmonics 2 to N; harmonic h\n"
     "is a sin(h omega t + phase), phase in degrees.\n"
     "With --follow the message of a special point is its kind: fold (the curve turns back), flip (motions of twice the period\n"
     "begin), torus (motions of another frequency begin), branch (another curve crosses); or what changes in the sequence of\n"
     "events, with the contact or normal spring: stick, slide (it begins, ceases to stick, once more a period), graze (it\n"
     "begins or ceases to touch, to lift off or to reverse), order (events of several contacts). A column behind the message is\n"
     "1 for stable motions, 0 for unstable ones, blank at special points and where that is not known; periods are not counted.\n"
     "If a contact that follows --limits has mu=, the column, the texts, and best.load and band.load in values-damper.txt are\n"
     "normal loads, else limits: a contact slides at mu times the normal load.\n"
     "Sweeps up and down agree: with a linear structure and constant limits the motion is unique, except for the places of\n"
     "contacts that never slip, since friction takes energy from the difference of two motions. With normal= there may be\n"
     "several motions, or none that is stable, and friction may feed energy in: each point is searched from its neighbour.\n"},
    {TEXT,
     "\n"
     "Status 0; 1 with a message if something is wrong; 130 after Ctrl-C, the tables then hold the points found until then.\n"},
};

/* name: without hyphens in front. */
static const struct option *find_option(const char *name)
{
    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        const struct option *t = &table[k];
        const size_t length = t->read ? strcspn(t->help + 4, " ") : 0;
        if (length == strlen(name) && strncmp(t->help + 4, name, length) == 0) {
            return t;
        }
    }
    return NULL;
}

/* Returns text, which lives until free_options. */
static char *keep(struct options *o, char *text)
{
    o->texts.text = need_room(o->texts.text, o->texts.count, sizeof *o->texts.text);
    o->texts.text[o->texts.count++] = text;
    return text;
}

/* An option a line: its name without hyphens, a blank or an equals sign, and its value up to the end of the line. */
static void read_option_file(struct text *path, void *options)
{
    struct text t = open_text(path->at);
    const char *slash = strrchr(path->at, '/');
    while (next_data(&t)) {
        const char *name = next_word(&t, "an option", "= ");
        const struct option *option = find_option(name);
        char *value = keep(options, new_text("%s", rest_of(&t)));
        die_at_if(&t, !option || option->read == read_option_file, "there is no option \"%s\"; see --help", name);
        die_at_if(&t, *value == '\0', "option %s needs a value", name);
        const char *argument = option->help + 5 + strlen(name);
        struct text text =
            text_of(make_printable(keep(options, new_text("%s:%zu: %s %s", path->at, t.line, name, value))), value);
        if (slash && *value != '/' && strcmp(value, "none") != 0 &&
            (strncmp(argument, "FILE ", 5) == 0 || strncmp(argument, "FOLDER ", 7) == 0)) {
            text.at = keep(options, new_text("%.*s/%s", (int)(slash - path->at), path->at, value));
        }
        option->read(&text, (char *)options + option->offset);
    }
}

/* ------------------------------------------------------------------------------------------------------------- the whole */
int is_unloaded(const struct options *o)
{
    return o->backbone || o->cycle >= 0.0;
}

const struct place *measured_place(const struct options *o)
{
    for (size_t k = 0; k < o->loads.count; k++) {
        if (!o->loads.load[k].supports) {
            return &o->loads.load[k].at;
        }
    }
    return o->outputs.count ? &o->outputs.place[0] : NULL;
}

/* Ends the program where --backbone, --cycle or --follow exclude other options, or need them. */
static void check_study(const struct options *o)
{
    const char *march = o->march ? "--method march" : o->check ? "--check" : NULL;
    const char *unloaded = o->limits.points > 1  ? "more than one limit"
                           : o->drive.from > 0.0 ? "--drive"
                           : march               ? march
                           : o->field.count      ? "--field"
                           : o->harmonics        ? "--harmonics"
                                                 : NULL;
    die_if(is_unloaded(o) && unloaded, "option %s: it takes no %s", o->backbone ? "--backbone" : "--cycle", unloaded);
    die_if(o->follow && o->drive.points < 2, "option --follow: it is for a band, --drive FROM:TO:N");
    die_if(o->follow && march, "option --follow: it takes no %s", march);
    const char *driven = o->backbone ? "--backbone" : !o->loads.count ? NULL : o->loads.load->supports ? "--base" : "--load";
    die_if(o->cycle >= 0.0 && driven, "option --cycle: it takes no %s", driven);
    for (const struct contact *c = o->contacts.contact; c < o->contacts.contact + o->contacts.count; c++) {
        die_if(o->cycle < 0.0 && (c->belt != 0.0 || c->ratio > 1.0), "%s: belt= and static= are for --cycle", c->at.origin);
    }
}

/* Ends the program where options are missing, need others, or exclude them. */
static void check_options(const struct options *o)
{
    const struct {
        const char *name;
        int given;
    } part[] = {{"--mass", o->mass != NULL},
                {"--stiffness", o->stiffness != NULL},
                {"--dofs", o->dofs != NULL},
                {"--contact", o->contacts.count > 0},
                {"--load", o->loads.count > 0 || is_unloaded(o)},
                {"--output", o->outputs.count > 0 || o->loads.count > 0 || !is_unloaded(o)},
                {"--amplitudes", o->amplitudes.points || !o->backbone},
                {"--limits", o->limits.points || !o->contacts.vary || !is_unloaded(o)}};
    char missing[80] = "";
    for (size_t k = 0; k < sizeof part / sizeof *part; k++) {
        if (!part[k].given) {
            strcat(strcat(missing, " "), part[k].name);
        }
    }
    die_if(missing[0], "what is missing:%s; see --help", missing);
    die_if(!measured_place(o), "%s: --output is missing, the place where amplitudes are measured", o->loads.load[0].at.origin);
    die_if(o->amplitudes.points && !o->backbone, "option --amplitudes: --backbone is missing, the mode that has them");
    check_study(o);
    die_if(o->damping_matrix && o->damping.count, "option --damping-matrix %s: either a matrix or damping ratios, not both",
           o->damping_matrix);
    die_if(o->harmonics && !o->outputs.count, "option --harmonics %zu: --output is missing, a place where they are wanted",
           o->harmonics);
    die_if(o->field.count && o->drive.points > 1, "option --field: displacement fields are for one frequency: --drive HZ");
    die_if(o->limits.points && !o->contacts.vary, "option --limits: every contact has a limit of its own, and none follows");
}

struct options read_options(int argc, char **argv)
{
    struct options o = standard;
    for (int i = 1; i < argc; i++) {
        const int help = strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0;
        if (help || strcmp(argv[i], "--version") == 0) {
            for (size_t k = 0; help && k < sizeof table / sizeof *table; k++) {
                fputs(table[k].help, stdout);
            }
            if (!help) {
                printf("%s %s\n", program, tribo_version_string());
            }
            close_file(stdout, "standard output");
            exit(EXIT_SUCCESS);
        }
        char *name = argv[i], *equals = strchr(name, '=');
        if (equals) {
            *equals = '\0';
        }
        const struct option *option = strncmp(name, "--", 2) == 0 ? find_option(name + 2) : NULL;
        die_if(!option, "there is no option \"%s\"; see --help", name);
        char *value = equals ? equals + 1 : argv[++i];
        die_if(!value || !*value, "option %s needs a value; see --help", name);
        struct text text = text_of(keep(&o, new_text("option %s %s", name, value)), value);
        option->read(&text, (char *)&o + option->offset);
    }
    check_options(&o);
    if (!o.damping.count && !o.damping_matrix) {
        add_number(&o.damping, DAMPING);
    }
    if (o.frequencies && strcmp(o.frequencies, "none") == 0) {
        o.frequencies = NULL;
    }
    return o;
}

void free_options(struct options *o)
{
    for (size_t k = 0; k < o->texts.count; k++) {
        free(o->texts.text[k]);
    }
    free(o->texts.text);
    free(o->damping.value);
    free_contacts(&o->contacts);
    free(o->loads.load);
    free(o->outputs.place);
    free(o->field.value);
}
