/* SPDX-License-Identifier: BSD-3-Clause */
#include "elements.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../src/damper/output.h"
#include "tribo/tribo.h"

enum { ROOM = 4, IWAN_STATE = 3 + 2 * ROOM, HALF_CYCLE = 16 };

const char *const element_name[ELEMENT_LAWS] = {"tribo_dahl_force", "tribo_lugre_force", "tribo_bouc_wen_force",
                                                "tribo_iwan_force"};

static const size_t numbers[ELEMENT_LAWS] = {2, 6, 5, 4};

void elements_create(struct elements *e, enum element_law law, size_t n)
{
    *e = (struct elements){.law = law, .n = n};
    e->dz = need_memory(n, sizeof *e->dz);
    e->parameter = need_memory(numbers[law] * n, sizeof *e->parameter);
    e->state = need_memory(IWAN_STATE * n, sizeof *e->state);
    e->f = need_memory(n, sizeof *e->f);
    e->df_dz = need_memory(n, sizeof *e->df_dz);
    memset(e->state, 0, IWAN_STATE * n * sizeof *e->state);
    for (size_t i = 0; i < n; i++) {
        const double x = sin((double)i), y = sin(1.7 * (double)i), square = i % 2 ? 2.0 : 1.0;
        const double all[ELEMENT_LAWS][6] = {{1.0 + 0.5 * x, 1.0 + 0.5 * y},
                                             {100.0 * (1.5 + x), 1.0 + 0.1 * y, 0.1, 1.0 + 0.2 * x, 1.5 + 0.2 * y, 0.1},
                                             {1.0 + 0.5 * x, 1.0, 0.5 + 0.1 * y, 0.5, square},
                                             {1.0 + 0.5 * x, 1.0 + 0.3 * y, -0.5 + 0.2 * x, 0.5}};
        for (size_t k = 0; k < numbers[law]; k++) {
            e->parameter[law == DAHL ? n * k + i : numbers[law] * i + k] = all[law][k];
        }
        e->f[i] = 0.0;
    }
    elements_step(e);
}

void elements_destroy(struct elements *e)
{
    free(e->dz);
    free(e->parameter);
    free(e->state);
    free(e->f);
    free(e->df_dz);
}

void elements_step(void *elements)
{
    struct elements *e = elements;
    const size_t n = e->n;
    const double way = e->steps++ / HALF_CYCLE % 2 ? -0.1 : 0.1;
    for (size_t i = 0; i < n; i++) {
        e->dz[i] = way;
    }
    need(e->law == DAHL       ? tribo_dahl_force(n, e->dz, e->parameter, e->parameter + n, e->f, e->df_dz)
         : e->law == LUGRE    ? tribo_lugre_force(n, 0.01, e->dz, e->parameter, e->state, e->f, e->df_dz)
         : e->law == BOUC_WEN ? tribo_bouc_wen_force(n, e->dz, e->parameter, e->state, e->f, e->df_dz)
                              : tribo_iwan_force(n, ROOM, e->dz, e->parameter, e->state, e->f, e->df_dz),
         NULL);
}
