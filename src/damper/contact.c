/* SPDX-License-Identifier: BSD-3-Clause */
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

/* 1, 2, 3 for x, y, z; 0 for any other name. */
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

/* "X,Y,Z,DIR", DIR one direction or two; *second out: the second one, or 0. */
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

/* A word name=NUMBER, positive; *value is NaN until it is given. */
struct word {
    const char *name;
    double *value;
    int any_sign, may_be_zero;
};

/* Reads the words behind a place, parted by colons or blanks; to: the other end of a contact, or NULL; all: them all, for the
 * message. */
static void read_words(const char *origin, char *at, const struct word *known, size_t count, struct contact *to, const char *all)
{
    for (char *word = strtok(at, PARTED); word; word = strtok(NULL, PARTED)) {
        const char *equals = strchr(word, '=');
        const size_t length = equals ? (size_t)(equals - word) : strlen(word);
        const struct word *w = NULL;
        const int is_to = to && strncmp(word, "to=", 3) == 0;
        for (size_t k = 0; k < count; k++) {
            w = strlen(known[k].name) == length && strncmp(word, known[k].name, length) == 0 ? &known[k] : w;
        }
        if (!is_to && !(w && equals)) {
            die("%s: \"%s\" is none of %s", origin, word, all);
        }
        if (is_to ? to->between : !isnan(*w->value)) {
            die("%s: %.*s= is there twice", origin, (int)length, word);
        }
        if (is_to) {
            read_coordinates(origin, word + 3, '\0', to->to.at);
            to->between = 1;
        } else {
            *w->value = read_real(origin, equals + 1, w->any_sign ? -HUGE_VAL : 0.0, w->may_be_zero);
        }
    }
}

/* Ends the first word of text, which is returned; *rest is behind it. */
static char *first_word(char *text, char **rest)
{
    char *first = text + strspn(text, PARTED), *end = first + strcspn(first, PARTED);
    *rest = end + (*end != '\0');
    *end = '\0';
    return first;
}

static void add_contact(struct contacts *all, const struct contact *c)
{
    all->contact = need_room(all->contact, all->count, &all->room, sizeof *all->contact);
    all->contact[all->count++] = *c;
}

void read_contact(const char *origin, const char *text, struct contacts *all)
{
    struct contact c = {.mu = (double)NAN, .limit = (double)NAN, .stiffness = (double)NAN};
    double load = (double)NAN;
    const struct word known[] = {
        {"limit", &c.limit, 0, 1}, {"mu", &c.mu, 0, 0}, {"load", &load, 0, 0}, {"stiffness", &c.stiffness, 0, 0}};
    int second;
    char *copy = new_text("%s", text), *rest;
    c.at = read_places(origin, first_word(copy, &rest), &second);
    read_words(origin, rest, known, sizeof known / sizeof *known, &c,
               "to=X,Y,Z limit=FORCE mu=NUMBER load=FORCE stiffness=NUMBER");
    free(copy);
    if (!isnan(c.limit) && !(isnan(c.mu) && isnan(load))) {
        die("%s: either limit= or mu=, not both", origin);
    }
    if (isnan(c.mu) && !isnan(load)) {
        die("%s: load= needs mu=, too", origin);
    }
    c.by_load = isnan(c.limit) && isnan(load) && !isnan(c.mu);
    c.limit = isnan(load) ? c.limit : c.mu * load;
    c.mu = isnan(c.mu) ? 1.0 : c.mu;
    c.stiffness = isnan(c.stiffness) ? 0.0 : c.stiffness;
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

void read_load(const char *origin, const char *text, int supports, struct loads *all)
{
    struct load l = {.supports = supports, .size = (double)NAN, .phase = (double)NAN};
    const struct word known[] = {{supports ? "acceleration" : "force", &l.size, 0, 0}, {"phase", &l.phase, 1, 1}};
    char *copy = new_text("%s", text), *rest, *place = first_word(copy, &rest);
    if (supports) {
        l.at = (struct place){.origin = origin, .direction = place[0] && !place[1] ? read_direction(place[0]) : 0};
        if (!l.at.direction) {
            die("%s: direction \"%s\" must be x, y or z", origin, place);
        }
    } else {
        l.at = read_place(origin, place);
    }
    read_words(origin, rest, known, sizeof known / sizeof *known, NULL,
               supports ? "acceleration=NUMBER phase=DEGREES" : "force=FORCE phase=DEGREES");
    if (supports && isnan(l.size)) {
        die("%s: acceleration= is missing", origin);
    }
    l.phase = isnan(l.phase) ? 0.0 : l.phase;
    free(copy);
    all->load = need_room(all->load, all->count, &all->room, sizeof *all->load);
    all->load[all->count++] = l;
}

void read_contacts(const char *path, struct contacts *all)
{
    struct lines l = open_lines(path);
    const size_t before = all->count;
    while (next_data(&l)) {
        l.at[strcspn(l.at, "\r")] = '\0';
        make_printable(l.at);
        for (char *end = l.at + strlen(l.at); end > l.at && (end[-1] == ' ' || end[-1] == '\t');) {
            *--end = '\0';
        }
        read_contact(new_text("%s:%zu: contact %s", path, l.line, l.at), l.at, all);
    }
    close_lines(&l);
    if (all->count == before) {
        die("%s: there is no contact in it", path);
    }
}
