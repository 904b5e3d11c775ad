/* SPDX-License-Identifier: BSD-3-Clause */
/* tribo-damper from outside: damaged files and wrong options, each of which must end it with status 1 and one line that names
 * file, line and value; and structures as small as can be. Works in the current folder. TRIBO_CASES: how many random damages of
 * each kind. */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "support.h"
#include "tool.h"

/* ------------------------------------------------------------------------------------------------------------- structures */

#define OWN "--mass M.mtx --stiffness K.mtx --dofs dofs.txt"
#define CHAIN OWN " --frequencies hz.txt --contact 2,0,0,x --load 4,0,0,x --modes 2 --step 1 --limits 0.1:0.1:1"

enum { MASS, STIFFNESS, DOFS, FREQUENCIES, FILES };
static const char *const FILE_NAME[FILES] = {"M.mtx", "K.mtx", "dofs.txt", "hz.txt"};

struct text {
    char byte[TEXT];
    size_t length;
};

static void add(struct text *t, const char *line)
{
    t->length += (size_t)snprintf(t->byte + t->length, TEXT - t->length, "%s\n", line);
}

/* Four masses in a row, held at one end. */
static void make_chain(struct text *file)
{
    static const char *const lines[FILES][11] = {
        {"%%MatrixMarket matrix coordinate real symmetric", "% masses, kg", "4 4 4", "1 1 2.0", "2 2 2", "3 3 2.0", "4 4 2.0e0"},
        {"%%MatrixMarket matrix coordinate real symmetric", "% stiffness, N/m", "4 4 7", "1 1 400", "2 1 -200", "2 2 400",
         "3 2 -200.0", "3 3 400", "4 3 -2e2", "4 4 200.0"},
        {"# row node direction x y z", "1 11 1 1 0 0", "2 12 1 2.0 0 0", "3 13 1 3 0 0", "4 14 1 4 0 0.0"},
        {"# Hz", "0.5527", "1.5915", "2.4384", "2.9912"},
    };
    for (int f = 0; f < FILES; f++) {
        file[f].length = 0;
        for (int i = 0; lines[f][i]; i++) {
            add(&file[f], lines[f][i]);
        }
    }
}

static void write_files(const struct text *file)
{
    for (int f = 0; f < FILES; f++) {
        write_bytes(FILE_NAME[f], file[f].byte, file[f].length);
    }
}

static void write_chain(void)
{
    struct text file[FILES];
    make_chain(file);
    write_files(file);
}

/* -------------------------------------------------------------------------------------------------------------- damage */

static int lines_of(const struct text *t)
{
    int lines = 0;
    for (size_t i = 0; i < t->length; i++) {
        lines += t->byte[i] == '\n';
    }
    return lines;
}

/* Where a line begins; lines and words are counted from 1. */
static size_t line_at(const struct text *t, int line)
{
    size_t at = 0;
    for (; line > 1; line--) {
        at += strcspn(t->byte + at, "\n") + 1;
    }
    return at;
}

static int words_in(const struct text *t, int line)
{
    int words = 1;
    for (const char *c = t->byte + line_at(t, line); *c != '\n'; c++) {
        words += *c == ' ';
    }
    return words;
}

static void replace(struct text *t, size_t at, size_t length, const char *with, size_t with_length)
{
    memmove(t->byte + at + with_length, t->byte + at + length, t->length - at - length);
    memcpy(t->byte + at, with, with_length);
    t->length += with_length - length;
    t->byte[t->length] = '\0';
}

static void replace_word(struct text *t, int line, int word, const char *with)
{
    size_t at = line_at(t, line);
    for (; word > 1; word--) {
        at += strcspn(t->byte + at, " ") + 1;
    }
    replace(t, at, strcspn(t->byte + at, " \n"), with, strlen(with));
}

static int first_data(int f)
{
    return f == MASS || f == STIFFNESS ? 3 : 2;
}

static int is_whole(int f, int line, int word)
{
    return f == DOFS ? word <= 3 : f != FREQUENCIES && (line == 3 || word <= 2);
}

/* A word that is no number, or none that may stand there: the message names file, line and word. */
static void damage_word(struct text *file, struct random *r)
{
    static const char *const word[] = {"nan",
                                       "-inf",
                                       "1e999",
                                       "1..2",
                                       "0x",
                                       "--3",
                                       "1d5d",
                                       "12a",
                                       "1,5",
                                       "\"",
                                       "+",
                                       "e5",
                                       "1e-",
                                       "\033[",
                                       "\377",
                                       "1e99999999",
                                       "0/0",
                                       "1\0012",
                                       /* whole numbers only */ "-1",
                                       "1.5",
                                       "4294967296",
                                       "1e300",
                                       "1e19",
                                       "0x1p70"};
    enum { WHOLE = 6 };
    const int f = (int)below(r, FILES), line = first_data(f) + (int)below(r, (size_t)(lines_of(&file[f]) - first_data(f) + 1)),
              at = 1 + (int)below(r, (size_t)words_in(&file[f], line));
    const char *with = word[below(r, COUNT(word) - (is_whole(f, line, at) ? 0 : WHOLE))];
    char place[40], shown[40], what[100];
    snprintf(place, sizeof place, "%s:%d: ", FILE_NAME[f], line);
    snprintf(shown, sizeof shown, "\"%s\"", with);
    for (char *c = shown; *c; c++) {
        *c = *c < ' ' || *c > '~' ? '?' : *c;
    }
    snprintf(what, sizeof what, "%s word %d is %s", place, at, shown);
    replace_word(&file[f], line, at, with);
    write_files(file);
    assert_refused(CHAIN, what, place);
    assert_refused(CHAIN, what, shown);
}

/* A file that ends too early. Only that of frequencies may end after any line. */
static void damage_end(struct text *file, struct random *r)
{
    const int f = (int)below(r, FILES);
    char what[100];
    file[f].length = below(r, file[f].length);
    if (f == FREQUENCIES && (file[f].length == 0 || file[f].byte[file[f].length - 1] == '\n')) {
        return;
    }
    write_files(file);
    snprintf(what, sizeof what, "%s ends after %zu bytes", FILE_NAME[f], file[f].length);
    assert_refused(CHAIN, what, f == DOFS ? "" : FILE_NAME[f]);
}

static void damage_header(struct text *file, struct random *r)
{
    static const char *const word[] = {"%%matrixmarket_", "%MatrixMarket", "vector", "array",          "complex", "pattern",
                                       "hermitian",       "double",        "x",      "skew-symmetric", "\001",    ""};
    const int f = below(r, 2) ? MASS : STIFFNESS, at = 1 + (int)below(r, 5);
    char place[40], what[100];
    const char *with = word[below(r, COUNT(word))];
    replace_word(&file[f], 1, at, with);
    write_files(file);
    snprintf(place, sizeof place, "%s:1: ", FILE_NAME[f]);
    snprintf(what, sizeof what, "%s word %d is \"%s\"", place, at, with);
    assert_refused(CHAIN, what, place);
}

/* A head that lies about what follows. */
static void damage_sizes(struct text *file, struct random *r)
{
    static const char *const number[] = {"0", "1", "3", "5", "100000", "2000000000", "2147483647", "2147483648", "1e18"};
    const int f = below(r, 2) ? MASS : STIFFNESS, at = 1 + (int)below(r, 3);
    const char *with = number[below(r, COUNT(number))];
    char place[40], what[100];
    replace_word(&file[f], 3, at, with);
    if (below(r, 2) && at < 3) {
        replace_word(&file[f], 3, 3 - at, with); /* square all the same */
    }
    write_files(file);
    snprintf(place, sizeof place, "%s:", FILE_NAME[f]);
    snprintf(what, sizeof what, "%s size %d is %s", place, at, with);
    assert_refused(CHAIN, what, place);
}

/* A line less than announced, or one twice, announced or not. */
static void damage_lines(struct text *file, struct random *r)
{
    const int f = (int)below(r, FREQUENCIES),
              line = first_data(f) + 1 + (int)below(r, (size_t)(lines_of(&file[f]) - first_data(f))), twice = (int)below(r, 2),
              announced = twice && below(r, 2);
    const size_t from = line_at(&file[f], line), to = line_at(&file[f], line + 1);
    char copy[TEXT], what[100], place[40] = "", count[20];
    memcpy(copy, file[f].byte + from, to - from);
    replace(&file[f], from, twice ? 0 : to - from, copy, twice ? to - from : 0);
    if (f != DOFS && announced) {
        snprintf(count, sizeof count, "%d", lines_of(&file[f]) - 3);
        replace_word(&file[f], 3, 3, count);
    }
    if (twice) {
        snprintf(place, sizeof place, "%s:%d: ", FILE_NAME[f], f == DOFS || announced ? line + 1 : lines_of(&file[f]));
    }
    write_files(file);
    snprintf(what, sizeof what, "%s line %d %s%s", FILE_NAME[f], line, twice ? "twice" : "missing",
             announced ? ", announced" : "");
    assert_refused(CHAIN, what, place);
}

/* Any bytes: whatever that means, it is neither a crash nor a hang, nor a result that is no number. */
static void damage_bytes(struct text *file, struct random *r)
{
    char what[200] = "";
    for (size_t k = 1 + below(r, 4); k > 0; k--) {
        const int f = (int)below(r, FILES);
        const size_t at = below(r, file[f].length), length = strlen(what);
        file[f].byte[at] = below(r, 2) ? "0123456789+-.eE \n"[below(r, 17)] : (char)below(r, 256);
        snprintf(what + length, sizeof what - length, "%s[%zu] = %d ", FILE_NAME[f], at, file[f].byte[at]);
    }
    write_files(file);
    const struct outcome o = run_tool(CHAIN);
    if (o.status) {
        assert_ends(&o, what);
    }
    require(!has_no_number(o.out), "%s: %s", what, o.out);
}

TEST(damage)
{
    static void (*const kind[])(struct text *, struct random *) = {damage_word,  damage_end,   damage_header,
                                                                   damage_sizes, damage_lines, damage_bytes};
    struct random r = random_of(_i);
    for (int k = setting("TRIBO_CASES", 100); k > 0; k--) {
        struct text file[FILES];
        make_chain(file);
        kind[_i](file, &r);
    }
}
END_TEST

/* Files that look different, and say the same. */
TEST(the_same)
{
    static const char *const end[] = {"\r\n", " \t\n", "\n\n", "\n% nothing\n", "\n# nothing\n"};
    write_chain();
    const struct outcome plain = assert_runs(CHAIN);
    for (size_t k = 0; k < COUNT(end); k++) {
        struct text file[FILES];
        make_chain(file);
        for (int f = 0; f < FILES; f++) {
            for (int line = lines_of(&file[f]); line > 0; line--) {
                replace(&file[f], line_at(&file[f], line + 1) - 1, 1, end[k], strlen(end[k]));
            }
        }
        write_files(file);
        const struct outcome o = assert_runs(CHAIN);
        require(strcmp(o.out, plain.out) == 0, "%zu: %s\nnot\n%s", k, o.out, plain.out);
    }
    struct text file[FILES];
    make_chain(file);
    for (int f = 0; f < FILES; f++) {
        replace(&file[f], 0, 0, "\xEF\xBB\xBF", 3);
    }
    write_files(file);
    const struct outcome o = assert_runs(CHAIN);
    require(strcmp(o.out, plain.out) == 0, "with the mark of UTF-8: %s\nnot\n%s", o.out, plain.out);
}
END_TEST

/* What is no text, or not there. */
TEST(no_files)
{
    static char zeros[100], wide[100000];
    memset(wide, '1', sizeof wide);
    for (int f = 0; f < FILES; f++) {
        write_chain();
        write_bytes(FILE_NAME[f], zeros, sizeof zeros);
        assert_refused(CHAIN, "zeros", FILE_NAME[f]);
        write_bytes(FILE_NAME[f], wide, sizeof wide);
        assert_refused(CHAIN, "a line without an end", FILE_NAME[f]);
        remove(FILE_NAME[f]);
        assert_refused(CHAIN, "no file", FILE_NAME[f]);
        if (f != FREQUENCIES) {
            write_text(FILE_NAME[f], "");
            assert_refused(CHAIN, "an empty file", FILE_NAME[f]);
        }
    }
    write_chain();
    assert_refused(CHAIN " --mass /dev/zero", "endless", "/dev/zero:1: ");
    assert_refused(CHAIN " --dofs /", "a folder", "/:1: cannot be read");
    assert_refused(CHAIN " --out nowhere", "no folder", "nowhere/");
    if (symlink("/dev/full", "damper-curve.csv") == 0) {
        assert_refused(CHAIN, "a full disk", "cannot write ./damper-curve.csv: No space left");
        remove("damper-curve.csv");
    }
    write_text("options.txt", "\x1b[2J\xff 1\n");
    assert_refused(CHAIN " --read options.txt", "no option", "options.txt:1: there is no option \"?[2J?\"");
}
END_TEST

/* ------------------------------------------------------------------------------------------------------------- options */

TEST(options)
{
    static const struct {
        const char *option, *values; /* parted by blanks */
    } bad[] = {
        {"--modes", "0 -1 1.5 5 1e9 nan x 1e300 2x"},
        {"--damping", "0 -1 1 2 nan inf 0,1 0.1, 0.1,x ,0.1 0.1,2"},
        {"--harmonics", "0 -1 x 1.5"},
        {"--field", "-1 361 x 0,x 0,,90 nan"},
        {"--base", "w x x:acceleration=0 x:acceleration=nan x:force=1 xy:acceleration=1 2,0,0,x x:acceleration=1:acceleration=1"},
        {"--output", "2,0,0 2,0,0,w 2,0,0,y 2,0,0.1,x"},
        {"--force", "0 -1 nan inf 1N 1e999"},
        {"--drive", "-1 nan inf 5Hz 1:2 1:2:0 2:1:3 1:1:2 0:1:3 1:2:x"},
        {"--limits", "0 1:2 1:2:0 1:2:1.5 2:1:3 1:1:2 0:1:3 -1:1:3 nan:1:3 1:inf:3 1:2:3:4 1:2:1e300 :: 1;2;3"},
        {"--step", "0 -1 1.1 nan 1/4"},
        {"--law", "quin quinnn 4 karnopp"},
        {"--statics", "none ON 1"},
        {"--contact",
         "2,0,0 2,0,0, 2,0,0,w 2,0,0,4 2,0,0,y 2,0,x 2.1,0,0,x nan,0,0,x 2,0,0,xx , x 1e300,0,0,x 2,0,0,xy 2,0,0,x:stiffness=0 "
         "2,0,0,x:stiffness=nan "
         "2,0,0,x:limit=-1 2,0,0,x:limit= 2,0,0,x:limit 2,0,0,x:load=1 2,0,0,x:mu=1:limit=1 2,0,0,x:mu=1:mu=1 "
         "2,0,0,x:to=1,0,0:to=1,0,0 2,0,0,x:mu=0 2,0,0,x:mu=1:load=0 "
         "2,0,0,x:to=2,0,0 2,0,0,x:to=9,0,0 2,0,0,x:to=1,0 2,0,0,x:to=1,0,0,x 2,0,0,x:limit=1:foo"},
        {"--method", "shoot Exact -1"},
        {"--check", "-1 x 0.5"},
        {"--threads", "0 -1 x"},
        {"--name", "a/b"},
        {"--load", "2,0,0 2,0,0,w 2,0,0,y 2,0,0.1,x nan,0,0,x 2,0,0,x:force=0 2,0,0,x:force=x 2,0,0,x:phase=inf "
                   "2,0,0,x:phase=1:phase=2 2,0,0,x:to=1,0,0 2,0,0,x:acceleration=1"},
    };
    write_chain();
    for (size_t k = 0; k < COUNT(bad); k++) {
        char option[100], values[200];
        snprintf(values, sizeof values, "%s", bad[k].values);
        for (char *value = strtok(values, " "); value; value = strtok(NULL, " ")) {
            snprintf(option, sizeof option, "%s %s", bad[k].option, value);
            assert_refused(form("%s %s", CHAIN, option), option, option);
        }
    }
    /* what only the structure can tell: too much work, or nothing to work with */
    assert_refused(CHAIN " --check 1 --step 1e-300", "step", "--step");
    assert_refused(CHAIN " --check 1 --law quinn --step 1e-300", "step", "--step");
    assert_refused(CHAIN " --drive 1e-9", "drive", "1e-09 Hz");
    assert_refused(CHAIN " --drive 1e200", "drive", "1e+200 Hz");
    assert_refused(CHAIN " --drive 1e300", "drive", "1e+300 Hz");
    assert_refused(CHAIN " --limits 1e-300:1e300:5 --contact 3,0,0,x:mu=1e10", "a product", "too large a limit");
    assert_refused(CHAIN " --contact 3,0,0,x:mu=1e200:load=1e200", "a product", "too large a limit");
    const struct outcome o = assert_runs(CHAIN " --limits 1e-300:1e300:5");
    require(says(o.out, "      1e-300 ") && says(o.out, "      1e+300 "), "%s", o.out);
    assert_refused(CHAIN " --force 1e-300", "force", "--force");
    assert_refused(CHAIN " --force 1e300", "force", "--force");
    assert_refused(CHAIN " --nonsense 1", "no option", "\"--nonsense\"");
    assert_refused(CHAIN " --modes", "no value", "--modes");
    assert_refused(CHAIN " --modes=", "no value", "--modes");
    assert_refused(CHAIN " --modes=x", "no number", "option --modes x");
    assert_refused(CHAIN " --modes=2=2", "no number", "option --modes 2=2");
    assert_refused(CHAIN " --nonsense=1", "no option", "\"--nonsense\"");
    assert_runs("--help");
}
END_TEST

/* Every part of a structure is asked for. */
TEST(parts)
{
    write_chain();
    assert_refused("--mass M.mtx", "mass", " missing: --stiffness --dofs --contact --load;");
    assert_refused("--stiffness K.mtx --load 4,0,0,x", "stiffness", " missing: --mass --dofs --contact;");
    assert_refused("--dofs dofs.txt", "dofs", " missing: --mass --stiffness --contact --load;");
    assert_refused(OWN " --contact 2,0,0,x", "load", " missing: --load;");
    assert_refused(OWN " --load 2,0,0,x", "contact", " missing: --contact;");
    const struct outcome o = assert_runs(OWN " --contact 2,0,0,x --load 4,0,0,x --limits 0.1:0.1:1");
    require(!says(o.out, "given"), "frequencies from nowhere: %s", o.out);
    require(says(o.out, "\n     4 "), "not all four modes: %s", o.out);
}
END_TEST

/* Files of options and of contacts: what is wrong with them is told by file and line. */
TEST(files_of_words)
{
    static const struct {
        const char *text, *place;
    } files[] = {{"modes 2\nnonsense 1\n", "o.txt:2: "},
                 {"modes\n", "o.txt:1: "},
                 {"modes 0\n", "o.txt:1: "},
                 {"# nothing\n\ncontact 2,0,0,x limit=-1\n", "o.txt:3: "},
                 {"contacts nowhere.txt\n", "nowhere.txt"},
                 {"modes 2", "o.txt:1: "}},
      contacts[] = {{"2,0,0,x\n3,0,0,x limit=1 mu=2\n", "c.txt:2: "},
                    {"2,0,0,x\n\n3,0,0\n", "c.txt:3: "},
                    {"2,0,0,x limit=\033[\n", "c.txt:1: "},
                    {"7,0,0,x\n", "c.txt:1: "},
                    {"# none\n", "c.txt: "},
                    {"2,0,0,yz\n", "c.txt:1: "},
                    {"2,0,0,x stiffness=-3\n", "c.txt:1: "}};
    write_chain();
    for (size_t k = 0; k < COUNT(files); k++) {
        write_text("o.txt", files[k].text);
        assert_refused(CHAIN " --read o.txt", files[k].text, files[k].place);
    }
    for (size_t k = 0; k < COUNT(contacts); k++) {
        write_text("c.txt", contacts[k].text);
        assert_refused(OWN " --load 4,0,0,x --contacts c.txt", contacts[k].text, contacts[k].place);
    }
    assert_refused("--read", "no value", "--read");
    assert_refused("--read nowhere.txt", "no file", "nowhere.txt");
}
END_TEST

/* The same limit in all the ways to say it, and from a file. */
TEST(same_limit)
{
    static const char *const way[] = {
        "--contact 2,0,0,x:limit=0.1",
        "--contact 2,0,0,x --limits 0.1",
        "--contact 2,0,0,x:mu=0.5 --limits 0.2",
        "--contacts c.txt",
        "--contact 2,0,0,x:mu=2:load=0.05",
        "--read o.txt",
        "--contact=2,0,0,x:limit=0.1",
        "--contact=2,0,0,x --limits=0.1",
        "--read=o.txt",
    };
    double first = 0.0;
    write_chain();
    write_text("c.txt", "# steel on steel\n2,0,0,x  mu=2 load=0.05 \r\n");
    write_text("o.txt", "contact 2,0,0,x limit=0.1\n");
    for (size_t k = 0; k < COUNT(way); k++) {
        char table[TEXT];
        double limit, hz, amplitude;
        assert_runs(form(OWN " --load 4,0,0,x %s", way[k]));
        read_text("damper-curve.csv", table);
        require(sscanf(strchr(table, '\n'), "%lf,%lf,%lf", &limit, &hz, &amplitude) == 3, "%s", table);
        first = k ? first : amplitude;
        require(amplitude > 0.0 && amplitude == first, "%s: %.17g, not %.17g", way[k], amplitude, first);
    }
    assert_refused(OWN " --load 4,0,0,x --contact 2,0,0,x:limit=0.1 --limits 0.1:1:3", "nothing varies", "--limits");
}
END_TEST

/* Every option with an equals sign, on the command line and in a file, as with a blank. */
TEST(equals)
{
    static const char *const option[] = {"mass M.mtx",
                                         "stiffness K.mtx",
                                         "dofs dofs.txt",
                                         "frequencies hz.txt",
                                         "contact 2,0,0,x",
                                         "contacts c.txt",
                                         "load 4,0,0,x",
                                         "base x:acceleration=1",
                                         "output 3,0,0,x",
                                         "harmonics 2",
                                         "force 2",
                                         "drive 0.7",
                                         "limits 0.1",
                                         "modes 3",
                                         "statics on",
                                         "damping 0.01,0.02",
                                         "damping-ratios r.txt",
                                         "method exact",
                                         "check 1",
                                         "law coulomb",
                                         "step 1",
                                         "threads 1",
                                         "out .",
                                         "name damper",
                                         "field 0,90"};
    char line[3][TEXT] = {"", "", "--read o.txt"}, file[TEXT] = "", values[3][TEXT];
    write_chain();
    write_text("c.txt", "3,0,0,x\n");
    write_text("r.txt", "0.03\n");
    for (size_t k = 0; k < COUNT(option); k++) {
        const int name = (int)strcspn(option[k], " ");
        for (int way = 0; way < 2; way++) {
            const size_t length = strlen(line[way]);
            snprintf(line[way] + length, TEXT - length, "%s--%.*s%c%s", length ? " " : "", name, option[k], " ="[way],
                     option[k] + name + 1);
        }
        const size_t length = strlen(file);
        snprintf(file + length, TEXT - length, "%.*s=%s\n", name, option[k], option[k] + name + 1);
    }
    write_text("o.txt", file);
    for (int way = 0; way < 3; way++) {
        assert_runs(line[way]);
        read_text("values-damper.txt", values[way]);
        require(strcmp(values[way], values[0]) == 0, "%s: %.2000s", line[way], values[way]);
        assert_exact(value_of("damper.model.modes"), 3.0);
    }
}
END_TEST

/* A contact between two nodes: both ends move alike when it sticks. */
TEST(between)
{
    write_chain();
    assert_runs(OWN " --contact 2,0,0,x:to=3,0,0 --load 4,0,0,x --drive 0.7");
    const double free_amplitude = value_of("damper.free.analytic"), held = value_of("damper.stuck.analytic");
    assert_close(value_of("damper.free"), free_amplitude, 1e-9 * free_amplitude);
    assert_close(value_of("damper.stuck"), held, 1e-9 * held);
    /* three masses, the middle one of 4 kg, on springs of 200 N/m; at 0.7 Hz, hardly damped */
    const double w2 = pow(2.0 * PI * 0.7, 2), top = 200.0 - 2.0 * w2, middle = 400.0 - 4.0 * w2, low = 400.0 - 2.0 * w2;
    const double rest = middle - 200.0 * 200.0 / low;
    assert_close(held, 1.0 / fabs(top - 200.0 * 200.0 / rest), 1e-2 * held);
}
END_TEST

/* A mass of 1 kg on springs that couple x and y, driven along x at 2.5 Hz with 5% damping: the amplitude along x with a contact
 * of limit 0.4 in the plane, by small steps of their own. */
static double plane_amplitude(void)
{
    const double w[2] = {20.0, sqrt(200.0)}, c[2] = {0.05 * (w[0] + w[1]), 0.05 * (w[0] - w[1])}, period = 0.4, limit = 0.4;
    const int steps = 20000, periods = 60;
    const double dt = period / steps;
    double x = 0.0, y = 0.0, u = 0.0, v = 0.0, most = 0.0, least = 0.0;
    for (int k = 0; k < periods * steps; k++) {
        const double p = sin(2.0 * PI * k / steps);
        const double a = u + dt * (p - 300.0 * x - 100.0 * y - c[0] * u - c[1] * v);
        const double b = v + dt * (-100.0 * x - 300.0 * y - c[1] * u - c[0] * v);
        const double speed = hypot(a, b), left = speed > dt * limit ? 1.0 - dt * limit / speed : 0.0;
        u = left * a;
        v = left * b;
        x += dt * u;
        y += dt * v;
        most = k < (periods - 1) * steps ? x : fmax(most, x);
        least = k < (periods - 1) * steps ? x : fmin(least, x);
    }
    return 0.5 * (most - least);
}

/* A contact in a plane, in all the ways to say it, by events and by marching; with a normal load that follows by marching. */
TEST(plane)
{
    static const char *const way[] = {"--contact 0,0,0,xy:limit=0.4", "--contact 0,0,0,yx:mu=0.5:load=0.8", "--contacts c.txt"};
    const double want = plane_amplitude();
    write_text("M.mtx", "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 1\n2 2 1\n");
    write_text("K.mtx", "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 300\n2 1 100\n2 2 300\n");
    write_text("dofs.txt", "1 1 1 0 0 0\n2 1 2 0 0 0\n");
    write_text("c.txt", "# steel on steel\n0,0,0,xy mu=0.4 load=1\n");
    for (size_t k = 0; k < COUNT(way); k++) {
        char line[TEXT], table[TEXT];
        double limit, hz, amplitude;
        snprintf(line, sizeof line, OWN " --load 0,0,0,x --damping 0.05 --drive 2.5 %s", way[k]);
        for (int march = 0; march < 2; march++) {
            strcat(line, march ? " --method march" : "");
            const struct outcome o = assert_runs(line);
            require(!says(o.out, "not found"), "%s", o.out);
            read_text("damper-curve.csv", table);
            require(sscanf(strchr(table, '\n'), "%lf,%lf,%lf", &limit, &hz, &amplitude) == 3, "%s", table);
            assert_close(amplitude, want, 1e-3 * want);
        }
    }
    assert_runs(OWN " --load 0,0,0,x --damping 0.05 --drive 2.5 --contact 0,0,0,xy --limits 0.05:0.5:3 --method march");
    require(value_of("damper.best.limit") > 0.05, "best limit %g", value_of("damper.best.limit"));
    assert_refused(OWN " --load 0,0,0,xy --contact 0,0,0,x", "a load in a plane", "must be x, y or z");
    assert_refused(OWN " --load 0,0,0,x --contact 0,0,0,xyz", "three directions", "or two of them");
}
END_TEST

/* ---------------------------------------------------------------------------------------------------------- small ones */

/* One mass: without friction the amplitude is F/(2 zeta k), and friction dissipates most at pi F/8, where it has half of that.
 * Held in its only place it does not move, and that is found at once. */
TEST(one_mass)
{
    const double force = 3.0, free_amplitude = force / (2.0 * 0.002 * 200.0);
    write_text("M.mtx", "%%MatrixMarket matrix coordinate real general\n1 1 1\n1 1 2\n");
    write_text("K.mtx", "%%MatrixMarket matrix coordinate integer general\n1 1 1\n1 1 200\n");
    write_text("dofs.txt", "1 1 2 0 0 0\n");
    const struct outcome o = assert_runs(OWN " --contact 0,0,0,y --load 0,0,0,y --force 3");
    require(!says(o.out, "not found"), "%s", o.out);
    assert_close(value_of("damper.free"), free_amplitude, 1e-9 * free_amplitude);
    assert_close(value_of("damper.best.limit"), PI * force / 8.0, 5e-3 * force);
    assert_close(value_of("damper.best.amplitude"), 0.5 * free_amplitude, 1e-2 * free_amplitude);
    assert_exact(value_of("damper.stuck"), 0.0);
    assert_exact(value_of("damper.stuck.analytic"), 0.0);
}
END_TEST

/* A band whose best limit is at an end has its check all the same. */
TEST(check_at_the_end)
{
    write_chain();
    const struct outcome o =
        assert_runs(OWN " --contact 2,0,0,x --load 4,0,0,x --drive 0.4:0.5:3 --limits 1e-4:1e-3:3 --damping 0.05 --check 1");
    require(says(o.out, "widen --limits") && says(o.out, "by marching in time"), "%s", o.out);
    assert_close(value_of("damper.check.amplitude"), 0.0, 1e-3);
}
END_TEST

/* More contacts than modes, and few limits. */
TEST(few)
{
    for (int modes = 1; modes <= 4; modes++) {
        for (int limits = 1; limits <= 4; limits++) {
            char line[TEXT];
            snprintf(line, sizeof line,
                     OWN " --contact 1,0,0,x --contact 2,0,0,x --contact 3,0,0,x --load 4,0,0,x --modes %d --limits 0.05:%g:%d",
                     modes, limits == 1 ? 0.05 : 0.2, limits);
            write_chain();
            const struct outcome o = assert_runs(line);
            require(!says(o.out, "not found"), "%s: %s", line, o.out);
            const double free_amplitude = value_of("damper.free.analytic"), held = value_of("damper.stuck.analytic");
            assert_close(value_of("damper.free"), free_amplitude, 1e-9 * free_amplitude);
            assert_close(value_of("damper.stuck"), held, 1e-9 * held + 1e-12 * free_amplitude);
        }
    }
}
END_TEST

/* A row of masses of 2 kg on springs of 200 N/m, held at one end, of which all but the last few are on contacts. */
TEST(many_contacts)
{
    enum { MASSES = 60, CONTACTS = 50 };
    static struct text m, k, dofs, contacts;
    char line[100];
    m.length = k.length = dofs.length = contacts.length = 0;
    add(&m, "%%MatrixMarket matrix coordinate real symmetric\n60 60 60");
    add(&k, "%%MatrixMarket matrix coordinate real symmetric\n60 60 119");
    for (int i = 1; i <= MASSES; i++) {
        snprintf(line, sizeof line, "%d %d 2", i, i);
        add(&m, line);
        snprintf(line, sizeof line, "%d %d %d", i, i, i < MASSES ? 400 : 200);
        add(&k, line);
        snprintf(line, sizeof line, "%d %d -200", i + 1, i);
        add(&k, i < MASSES ? line : "%");
        snprintf(line, sizeof line, "%d %d 1 %d 0 0", i, i, i);
        add(&dofs, line);
        snprintf(line, sizeof line, "%d,0,0,x", i);
        add(&contacts, i <= CONTACTS ? line : "");
    }
    write_bytes("M.mtx", m.byte, m.length);
    write_bytes("K.mtx", k.byte, k.length);
    write_bytes("dofs.txt", dofs.byte, dofs.length);
    write_bytes("c.txt", contacts.byte, contacts.length);
    assert_runs(OWN " --contacts c.txt --load 60,0,0,x --drive 0.1 --damping 0.05 --limits 0.1:0.1:1");
    /* stuck, ten masses are left: their receptance at the end by a continued fraction, without damping to a thousandth */
    const double w2 = pow(2.0 * PI * 0.1, 2);
    double behind = 0.0;
    for (int i = CONTACTS + 1; i <= MASSES; i++) {
        const double series = behind == 0.0 ? 200.0 : 1.0 / (1.0 / 200.0 + 1.0 / behind);
        behind = series - 2.0 * w2;
    }
    assert_close(value_of("damper.stuck"), 1.0 / behind, 1e-2 / behind);
    assert_close(value_of("damper.stuck"), value_of("damper.stuck.analytic"), 1e-9);
}
END_TEST

TEST_MAIN("damper", {damage, 6}, {the_same, 1}, {no_files, 1}, {options, 1}, {parts, 1}, {files_of_words, 1}, {same_limit, 1},
          {equals, 1}, {between, 1}, {plane, 1}, {one_mass, 1}, {few, 1}, {many_contacts, 1}, {check_at_the_end, 1})
