/* SPDX-License-Identifier: BSD-3-Clause */
#include "contact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char PARTED[] = " :";

/* 1, 2, 3 for x, y, z; 0 for any other name. */
static int direction_of(char name)
{
    static const char names[] = "xyz123";
    const char *at = name ? strchr(names, name) : NULL;
    return at ? (int)(at - names) % 3 + 1 : 0;
}

/* One direction; or two if second is not NULL. *second out: the second one, or 0. */
static int next_direction(struct text *t, const char *separators, int *second)
{
    const char *word = next_word(t, "direction", separators);
    const int first = direction_of(word[0]), other = word[1] ? direction_of(word[1]) : 0;
    die_at_if(t, !first || (word[1] && (!second || !other || other == first || word[2])),
              "direction \"%.40s\" must be x, y or z%s", word,
              second ? "; or two of them, for a contact that slides in their plane" : "");
    if (second) {
        *second = other;
    }
    return first;
}

static struct place next_place(struct text *t, const char *separators, int *second)
{
    struct place p = {.origin = t->place};
    next_coordinates(t, ",", ",", 3, p.at);
    p.direction = next_direction(t, separators, second);
    return p;
}

struct place read_place(struct text *t)
{
    return next_place(t, "", NULL);
}

/* A word name=NUMBER; *value is NaN until it is given. */
struct word {
    const char *name;
    double *value;
    enum { POSITIVE, NOT_NEGATIVE, ANY } sign;
};

/* Reads the words behind a place; to: the contact, or NULL; all: them all, for the message. */
static void read_words(struct text *t, const struct word *known, size_t count, struct contact *to, const char *all)
{
    while (*rest_of(t)) {
        const char *name = next_word(t, "a word", " :=");
        const struct word *w = NULL;
        const int is_to = to && strcmp(name, "to") == 0, is_normal = to && strcmp(name, "normal") == 0;
        for (size_t k = 0; k < count; k++) {
            w = strcmp(known[k].name, name) == 0 ? &known[k] : w;
        }
        die_at_if(t, t->end != '=' || !(w || is_to || is_normal), "\"%.40s\" is none of %s", name, all);
        die_at_if(t, is_to ? to->between : is_normal ? to->normal.direction : !isnan(*w->value), "%s= is there twice", name);
        if (is_to) {
            next_coordinates(t, ",", PARTED, 3, to->to.at);
            to->between = 1;
        } else if (is_normal) {
            const char *word = next_word(t, "direction", ",");
            const int against = word[0] == '-', signs = against || word[0] == '+', along = direction_of(word[signs]);
            die_at_if(t, !along || word[signs + 1], "normal=%.40s must be x, y or z, or one of them with a sign", word);
            die_at_if(t, t->end != ',', "normal=%.40s needs a stiffness: normal=%.40s,STIFFNESS", word, word);
            to->normal.direction = against ? -along : along;
            to->normal.stiffness = next_positive(t, "stiffness", PARTED);
        } else {
            *w->value = (w->sign == POSITIVE ? next_positive : next_real)(t, name, PARTED);
            die_at_if(t, *w->value < 0.0 && w->sign == NOT_NEGATIVE, "must be at least 0");
        }
    }
}

/* Checks the words of a contact, which may slide along a second direction. */
static void check_contact(const struct text *t, const struct contact *c, int second)
{
    const struct normal *n = &c->normal;
    const int along = abs(n->direction);
    die_at_if(t, !isnan(c->limit) && !(isnan(c->mu) && isnan(n->load)), "either limit= or mu=, not both");
    die_at_if(t, isnan(c->mu) && !isnan(n->load), "load= needs mu=, too");
    die_at_if(t, !along && !isnan(n->gap), "gap=%g needs normal=, too", n->gap);
    die_at_if(t, along && isnan(c->mu),
              "normal= needs mu=, in the place of limit=: the limit is mu times the load of the normal spring");
    die_at_if(t, along && (along == c->at.direction || along == second),
              "normal=%c is a direction along which the contact slides", " xyz"[along]);
    die_at_if(t, c->ratio < 1.0, "static=%g: the limit at rest is at least that while sliding", c->ratio);
    die_at_if(t, second && c->belt != 0.0 && !isnan(c->belt), "belt= is for contacts along one axis");
    die_at_if(t, !isnan(n->gap) && !isnan(n->load), "either gap=%g or load=%g, not both", n->gap, n->load);
}

void read_contact(struct text *t, void *contacts)
{
    struct contacts *all = contacts;
    const double none = (double)NAN;
    struct contact c = {
        .mu = none, .limit = none, .stiffness = none, .belt = none, .ratio = none, .normal = {.gap = none, .load = none}};
    const struct word known[] = {{"limit", &c.limit, NOT_NEGATIVE},  {"mu", &c.mu, POSITIVE},
                                 {"load", &c.normal.load, POSITIVE}, {"stiffness", &c.stiffness, POSITIVE},
                                 {"gap", &c.normal.gap, ANY},        {"belt", &c.belt, ANY},
                                 {"static", &c.ratio, POSITIVE}};
    int second;
    c.at = next_place(t, PARTED, &second);
    read_words(t, known, sizeof known / sizeof *known, &c,
               "to=X,Y,Z limit=FORCE mu=NUMBER load=FORCE stiffness=NUMBER normal=DIR,STIFFNESS gap=LENGTH "
               "belt=VELOCITY static=RATIO");
    check_contact(t, &c, second);
    c.limit = !isnan(c.normal.gap) ? 0.0 : isnan(c.normal.load) ? c.limit : c.mu * c.normal.load;
    all->vary |= isnan(c.limit);
    all->by_load |= isnan(c.limit) && !isnan(c.mu);
    c.mu = isnan(c.mu) ? 1.0 : c.mu;
    c.stiffness = isnan(c.stiffness) ? 0.0 : c.stiffness;
    c.belt = isnan(c.belt) ? 0.0 : c.belt;
    c.ratio = isnan(c.ratio) ? 1.0 : c.ratio;
    c.to.direction = c.at.direction;
    c.to.origin = t->place;
    c.directions = second ? 2 : 1;
    for (int k = second ? 2 : 1; k > 0; k--) {
        all->contact = need_room(all->contact, all->count, sizeof *all->contact);
        all->contact[all->count++] = c;
        c.directions = 0;
        c.at.direction = c.to.direction = second;
    }
}

static void add_load(struct text *t, int supports, struct loads *all)
{
    struct load l = {.supports = supports, .size = (double)NAN, .phase = (double)NAN};
    const struct word known[] = {{supports ? "acceleration" : "force", &l.size, POSITIVE}, {"phase", &l.phase, ANY}};
    if (supports) {
        l.at = (struct place){.origin = t->place, .direction = next_direction(t, PARTED, NULL)};
    } else {
        l.at = next_place(t, PARTED, NULL);
    }
    read_words(t, known, sizeof known / sizeof *known, NULL,
               supports ? "acceleration=NUMBER phase=DEGREES" : "force=FORCE phase=DEGREES");
    die_at_if(t, supports && isnan(l.size), "acceleration= is missing");
    l.phase = isnan(l.phase) ? 0.0 : l.phase;
    all->load = need_room(all->load, all->count, sizeof *all->load);
    all->load[all->count++] = l;
}

void read_load(struct text *t, void *loads)
{
    add_load(t, 0, loads);
}

void read_base(struct text *t, void *loads)
{
    add_load(t, 1, loads);
}

void read_contacts(struct text *path, void *contacts)
{
    struct text t = open_text(path->at);
    const struct contacts *all = contacts;
    const size_t before = all->count;
    while (next_data(&t)) {
        char *value = make_printable(rest_of(&t));
        const size_t at = all->count;
        char *line = new_text("%s:%zu: contact %s", path->at, t.line, value);
        struct text contact = text_of(line, value);
        read_contact(&contact, contacts);
        all->contact[at].line = line;
    }
    die_if(all->count == before, "%s: there is no contact in it", path->at);
}

void add_normals(struct contacts *all)
{
    for (size_t c = 0; c < all->count; c++) {
        struct contact n = all->contact[c];
        if (n.directions && n.normal.direction) {
            n.at.direction = n.to.direction = abs(n.normal.direction);
            n.stiffness = n.normal.stiffness;
            n.belt = 0.0;
            n.ratio = 1.0;
            n.directions = 0;
            n.line = NULL;
            all->contact = need_room(all->contact, all->count + all->normals, sizeof *all->contact);
            all->contact[all->count + all->normals++] = n;
        }
    }
}

void free_contacts(struct contacts *all)
{
    for (size_t c = 0; c < all->count; c++) {
        free(all->contact[c].line);
    }
    free(all->contact);
}
