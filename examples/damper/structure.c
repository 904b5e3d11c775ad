#include "structure.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../common/output.h"
#include "matrix_market.h"

static FILE *open_file(const char *path)
{
    FILE *file = fopen(path, "r");
    if (!file) {
        die("cannot open %s: %s", path, strerror(errno));
    }
    return file;
}

/* The numbers of the next line that is not empty and no comment (#), at most room of them; -1 at the end of the file. */
static int read_numbers(FILE *file, const char *path, size_t *line, double *number, int room)
{
    char text[1024];
    while (fgets(text, sizeof text, file)) {
        ++*line;
        int count = 0;
        char *at = text + strspn(text, " \t\r\n"), *end;
        while (*at && *at != '#') {
            const double value = strtod(at, &end);
            if (end == at || !isfinite(value) || count == room) {
                die("%s:%zu: \"%.*s\" is no finite number, or one too many (%d expected)", path, *line,
                    (int)strcspn(at, " \t\r\n"), at, room);
            }
            number[count++] = value;
            at = end + strspn(end, " \t\r\n");
        }
        if (count) {
            return count;
        }
    }
    if (ferror(file)) {
        die("cannot read %s: %s", path, strerror(errno));
    }
    return -1;
}

static void read_degree(struct structure *s, const char *path, size_t line, const double *number)
{
    const double row = number[0], direction = number[2];
    if (row != floor(row) || row < 1.0 || row > (double)s->ndof) {
        die("%s:%zu: row %g of matrices with %zu", path, line, row, s->ndof);
    }
    if (direction != 1.0 && direction != 2.0 && direction != 3.0) {
        die("%s:%zu: direction %g is not 1, 2 or 3", path, line, direction);
    }
    struct degree *d = &s->dof[(size_t)row - 1];
    if (d->direction) {
        die("%s:%zu: row %g is given twice", path, line, row);
    }
    d->direction = (int)direction;
    memcpy(d->at, number + 3, sizeof d->at);
}

static void read_degrees(struct structure *s, const char *path)
{
    FILE *file = open_file(path);
    double number[6];
    int count;
    size_t line = 0, rows = 0;
    while ((count = read_numbers(file, path, &line, number, 6)) >= 0) {
        if (count != 6) {
            die("%s:%zu: %d numbers, not the six row node direction x y z", path, line, count);
        }
        read_degree(s, path, line, number);
        rows++;
    }
    fclose(file);
    if (rows != s->ndof) {
        die("%s: %zu rows, but the matrices have %zu", path, rows, s->ndof);
    }
}

struct structure read_structure(const struct options *o)
{
    struct structure s = {.mass = read_matrix(o->mass), .stiffness = read_matrix(o->stiffness)};
    s.ndof = s.mass->size1;
    if (s.stiffness->size1 != s.ndof) {
        die("%s has %zu rows, but %s has %zu", o->mass, s.ndof, o->stiffness, s.stiffness->size1);
    }
    s.dof = need_memory(s.ndof, sizeof *s.dof);
    read_degrees(&s, o->dofs);
    return s;
}

void free_structure(struct structure *s)
{
    gsl_spmatrix_free(s->mass);
    gsl_spmatrix_free(s->stiffness);
    free(s->dof);
}

size_t find_degree(const struct structure *s, const char *option, const struct place *p)
{
    double nearest = HUGE_VAL, size = 0.0;
    size_t node = 0, found = s->ndof;
    for (size_t i = 0; i < s->ndof; i++) {
        const double *at = s->dof[i].at;
        const double distance = hypot(hypot(at[0] - p->at[0], at[1] - p->at[1]), at[2] - p->at[2]);
        size = fmax(size, hypot(hypot(at[0], at[1]), at[2]));
        if (distance < nearest) {
            nearest = distance;
            node = i;
            found = s->ndof;
        }
        if (distance == nearest && s->dof[i].direction == p->direction) {
            found = i;
        }
    }
    const double *at = s->dof[node].at;
    if (nearest > 1e-6 * size) {
        die("option %s %s: no free node is there; the nearest is at %g,%g,%g", option, p->text, at[0], at[1], at[2]);
    }
    if (found == s->ndof) {
        die("option %s %s: the node there cannot move along %c", option, p->text, "xyz"[p->direction - 1]);
    }
    return found;
}

size_t read_frequencies(const char *path, double *hz, size_t room)
{
    FILE *file = open_file(path);
    size_t line = 0, count = 0;
    while (count < room && read_numbers(file, path, &line, &hz[count], 1) >= 0) {
        if (hz[count] <= 0.0) {
            die("%s:%zu: frequency %g is not positive", path, line, hz[count]);
        }
        count++;
    }
    fclose(file);
    return count;
}
