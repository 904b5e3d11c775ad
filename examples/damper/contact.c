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

struct place read_place(const char *origin, const char *text)
{
    struct place p = {.origin = origin};
    const char *at = read_coordinates(origin, text, ',', p.at);
    for (int d = 1; d <= 3; d++) {
        if (at[0] && !at[1] && (at[0] == "xyz"[d - 1] || at[0] == "123"[d - 1])) {
            p.direction = d;
        }
    }
    if (!p.direction && at[0] && at[1] && strspn(at, "xyz") == strlen(at)) {
        die("%s: direction \"%s\": contacts slide along one axis here, x, y or z", origin, at);
    }
    if (!p.direction) {
        die("%s: direction \"%s\" must be x, y or z", origin, at);
    }
    return p;
}

/* What a contact's words may be. Each value is kept as it was given, NaN if it was not. */
struct words {
    double limit, mu, load;
};

static double *find_word(struct words *w, const char *name, size_t length)
{
    const struct {
        const char *name;
        double *value;
    } known[] = {{"limit", &w->limit}, {"mu", &w->mu}, {"load", &w->load}};
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
    if (equals && value) {
        *value = read_real(origin, equals + 1, 0.0, value == &w->limit);
    } else if (strncmp(word, "to=", 3) == 0) {
        read_coordinates(origin, word + 3, '\0', c->to.at);
        c->between = 1;
    } else if (strncmp(word, "stiffness=", 10) == 0) {
        die("%s: \"%s\": a contact that sticks is rigid here", origin, word);
    } else {
        die("%s: \"%s\" is none of to=X,Y,Z limit=FORCE mu=NUMBER load=FORCE", origin, word);
    }
}

struct contact read_contact(const char *origin, const char *text)
{
    struct contact c = {.mu = 1.0};
    struct words w = {(double)NAN, (double)NAN, (double)NAN};
    char *copy = new_text("%s", text), *place = copy + strspn(copy, PARTED), *word = place + strcspn(place, PARTED);
    if (*word) {
        *word++ = '\0';
    }
    c.at = read_place(origin, place);
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
    c.limit = isnan(w.load) ? w.limit : w.mu * w.load;
    c.to.direction = c.at.direction;
    c.to.origin = origin;
    return c;
}

/* Messages show what is in the line. */
static void make_printable(char *text)
{
    for (; *text; text++) {
        *text = (*text < ' ' && *text != '\t') || *text > '~' ? '?' : *text;
    }
    while (text[-1] == ' ' || text[-1] == '\t') {
        *--text = '\0';
    }
}

size_t read_contacts(const char *path, struct contact *contact, size_t count)
{
    struct lines l = open_lines(path);
    const size_t before = count;
    while (next_data(&l)) {
        if (count == MAX_CONTACTS) {
            die_at(&l, "there are %d contacts already", (int)MAX_CONTACTS);
        }
        l.at[strcspn(l.at, "\r")] = '\0';
        make_printable(l.at);
        contact[count++] = read_contact(new_text("%s:%zu: contact %s", path, l.line, l.at), l.at);
    }
    close_lines(&l);
    if (count == before) {
        die("%s: there is no contact in it", path);
    }
    return count;
}
