#include "contact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lines.h"
#include "numbers.h"

static const char PARTED[] = " \t\r:";

static const char *read_coordinates(const char *origin, const char *text, char end, double *at)
{
    for (int i = 0; i < 3; i++) {
        text = read_number(origin, text, i < 2 ? ',' : end, &at[i]);
    }
    return text;
}

/* 1, 2, 3 for x, y, z; 0 for what is none. */
static int read_direction(char name)
{
    for (int d = 1; d <= 3; d++) {
        if (name == "xyz"[d - 1] || name == "123"[d - 1]) {
            return d;
        }
    }
    return 0;
}

struct place read_place(const char *origin, const char *text)
{
    struct place p = {.origin = origin};
    const char *at = read_coordinates(origin, text, ',', p.at);
    p.direction = at[0] && !at[1] ? read_direction(at[0]) : 0;
    if (!p.direction) {
        die("%s: direction \"%s\" must be x, y or z", origin, at);
    }
    return p;
}

/* The same where there may be two directions; *second is 0, or the other one. */
static struct place read_places(const char *origin, const char *text, int *second)
{
    struct place p = {.origin = origin};
    const char *at = read_coordinates(origin, text, ',', p.at);
    const int plane = at[0] && at[1];
    p.direction = read_direction(at[0]);
    *second = plane ? read_direction(at[1]) : 0;
    if (!p.direction || (plane && (!*second || at[2] || *second == p.direction))) {
        die("%s: direction \"%s\" must be x, y or z; or two of them, for a contact that slides in their plane", origin, at);
    }
    return p;
}

/* What a contact's words may be. Each value is kept as it was given, NaN if it was not. */
struct words {
    double limit, mu, load, stiffness;
};

static double *find_word(struct words *w, const char *name, size_t length)
{
    const struct {
        const char *name;
        double *value;
    } known[] = {{"limit", &w->limit}, {"mu", &w->mu}, {"load", &w->load}, {"stiffness", &w->stiffness}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        if (strlen(known[k].name) == length && strncmp(name, known[k].name, length) == 0) {
            return known[k].value;
        }
    }
    return NULL;
}

static void read_word(const char *origin, char *word, struct contact *c, struct words *w)
{
    const char *equals = strchr(word, '=');
    const size_t length = equals ? (size_t)(equals - word) : strlen(word);
    double *value = find_word(w, word, length);
    if (equals && (value ? !isnan(*value) : c->between && strncmp(word, "to=", 3) == 0)) {
        die("%s: %.*s= is there twice", origin, (int)length, word);
    }
    if (equals && value) {
        *value = read_real(origin, equals + 1, 0.0, value == &w->limit);
    } else if (strncmp(word, "to=", 3) == 0) {
        read_coordinates(origin, word + 3, '\0', c->to.at);
        c->between = 1;
    } else {
        die("%s: \"%s\" is none of to=X,Y,Z limit=FORCE mu=NUMBER load=FORCE stiffness=NUMBER", origin, word);
    }
}

static void add_contact(struct contacts *all, const struct contact *c)
{
    all->contact = need_room(all->contact, all->count, &all->room, sizeof *all->contact);
    all->contact[all->count++] = *c;
}

void read_contact(const char *origin, const char *text, struct contacts *all)
{
    struct contact c = {.mu = 1.0};
    int second;
    struct words w = {(double)NAN, (double)NAN, (double)NAN, (double)NAN};
    char *copy = new_text("%s", text), *place = copy + strspn(copy, PARTED), *word = place + strcspn(place, PARTED);
    if (*word) {
        *word++ = '\0';
    }
    c.at = read_places(origin, place, &second);
    for (word += strspn(word, PARTED); *word; word += strspn(word, PARTED)) {
        char *end = word + strcspn(word, PARTED);
        const int last = *end == '\0';
        *end = '\0';
        read_word(origin, word, &c, &w);
        word = last ? end : end + 1;
    }
    free(copy);
    if (!isnan(w.limit) && !(isnan(w.mu) && isnan(w.load))) {
        die("%s: either limit= or mu=, not both", origin);
    }
    if (isnan(w.mu) && !isnan(w.load)) {
        die("%s: load= needs mu=, too", origin);
    }
    c.mu = isnan(w.mu) ? 1.0 : w.mu;
    c.stiffness = isnan(w.stiffness) ? 0.0 : w.stiffness;
    c.limit = isnan(w.load) ? w.limit : w.mu * w.load;
    c.to.direction = c.at.direction;
    c.to.origin = origin;
    c.planar = second != 0;
    add_contact(all, &c);
    if (second) {
        c.planar = 0;
        c.at.direction = c.to.direction = second;
        add_contact(all, &c);
    }
}

static void cut_blanks(char *text)
{
    for (char *end = text + strlen(text); end > text && (end[-1] == ' ' || end[-1] == '\t');) {
        *--end = '\0';
    }
}

void read_contacts(const char *path, struct contacts *all)
{
    struct lines l = open_lines(path);
    const size_t before = all->count;
    while (next_data(&l)) {
        l.at[strcspn(l.at, "\r")] = '\0';
        cut_blanks(make_printable(l.at));
        read_contact(new_text("%s:%zu: contact %s", path, l.line, l.at), l.at, all);
    }
    close_lines(&l);
    if (all->count == before) {
        die("%s: there is no contact in it", path);
    }
}
