/* SPDX-License-Identifier: BSD-3-Clause */
/* What tribo-damper reads: the first character says what the rest is, a Matrix Market file (m), a compressed one (g), CalculiX's
 * matrix (s), a compressed one (z), CalculiX's degrees of freedom, a line "=" and its input (d), or a table of degrees of freedom
 * (t). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "degrees.h"
#include "ending.h"
#include "matrix.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char *path;

static void demand(int holds)
{
    if (!holds) {
        abort();
    }
}

static void read_one_matrix(void)
{
    const struct rows rows = {4, "other.dof"};
    struct sparse m = read_matrix(path, &rows);
    demand(m.rows == rows.count && m.first[0] == 0);
    for (size_t i = 0; i < m.rows; i++) {
        demand(m.first[i] <= m.first[i + 1]);
        for (size_t k = m.first[i]; k < m.first[i + 1]; k++) {
            demand(m.col[k] < m.rows && (k == m.first[i] || m.col[k] > m.col[k - 1]) && isfinite(m.val[k]) && m.val[k] != 0.0);
        }
    }
    free_sparse(&m);
}

static void read_list(void)
{
    size_t count;
    struct degree *dof = read_degrees(path, &count);
    for (size_t i = 0; i < count; i++) {
        demand(dof[i].direction >= 1 && dof[i].direction <= 3 && isfinite(dof[i].at[0] + dof[i].at[1] + dof[i].at[2]));
    }
    free(dof);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char kinds[] = "mgszdt", *const paths[] = {"a.mtx", "a.mtx.gz", "a.sti", "a.mas.gz", "a.dof", "a.txt"};
    const char *kind = size > 1 ? memchr(kinds, data[0], sizeof kinds - 1) : NULL;
    if (!kind) {
        return -1;
    }
    struct part part[] = {{".inp", data + 1, size - 1}, {"", data + 1, size - 1}};
    for (size_t i = 1; *kind == 'd' && i + 2 < size; i++) {
        if (memcmp(data + i, "\n=\n", 3) == 0) {
            part[1].size = i;
            part[0] = (struct part){".inp", data + i + 2, size - i - 2};
            break;
        }
    }
    path = paths[kind - kinds];
    run_to_its_end(strchr("dt", *kind) ? read_list : read_one_matrix, part, 2);
    return 0;
}
