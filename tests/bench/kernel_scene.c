/* SPDX-License-Identifier: BSD-3-Clause */
#include "kernel_scene.h"

#include <math.h>
#include <stdlib.h>

#include "../../src/damper/output.h"

const char *const kernel_name[KERNELS] = {"tribo_force",
                                          "tribo_force, all slide",
                                          "tribo_force_tangent",
                                          "tribo_balance, diagonal R",
                                          "tribo_balance, all inside epsilon",
                                          "tribo_balance, all slide",
                                          "tribo_step_force, all slide",
                                          "tribo_step_force, all stop",
                                          "tribo_set_limit"};

void kernel_scene_create(struct kernel_scene *s, enum kernel kernel, size_t n, enum likeness like)
{
    double *width = need_memory(n, sizeof *width);
    const int slide = kernel == STEP || kernel == FORCE_SLIDE || kernel == BALANCE_SLIDE;
    *s = (struct kernel_scene){.kernel = kernel, .n = n};
    s->limit = need_memory(n, sizeof *s->limit);
    s->v = need_memory(n, sizeof *s->v);
    s->a = need_memory(n, sizeof *s->a);
    for (int k = 0; k < 4; k++) {
        s->out[k] = need_memory(n, sizeof *s->out[k]);
    }
    for (size_t i = 0; i < n; i++) {
        const double x = sin((double)i), y = sin(1.7 * (double)i);
        s->limit[i] = like == ALL ? 1.0 : 1.5 + x;
        width[i] = like != NOTHING ? 1e-3 : 1e-3 * (1.5 + y);
        s->v[i] = slide ? 1.0 + 0.5 * y : width[i] * (kernel == BALANCE_STUCK ? 1.0 : 2.0) * sin(3.1 * (double)i);
        s->a[i] = 2.0 * sin(0.6 * (double)i);
        s->out[1][i] = s->out[2][i] = 1.0 + 0.5 * x;
    }
    need(tribo_create(&s->ctx, n), NULL);
    need(tribo_set_limit(s->ctx, s->limit), tribo_message(s->ctx));
    need(tribo_set_epsilon(s->ctx, width), tribo_message(s->ctx));
    need(tribo_set_operator_diagonal(s->ctx, s->out[1]), tribo_message(s->ctx));
    free(width);
    kernel_call(s); /* pages are there, and what is prepared once is prepared */
}

void kernel_scene_destroy(struct kernel_scene *s)
{
    tribo_destroy(s->ctx);
    free(s->limit);
    free(s->v);
    free(s->a);
    for (int k = 0; k < 4; k++) {
        free(s->out[k]);
    }
}

void kernel_call(struct kernel_scene *s)
{
    int status = 0;
    switch (s->kernel) {
    case FORCE:
    case FORCE_SLIDE:
        status = tribo_force(s->ctx, s->v, s->a, s->out[0]);
        break;
    case FORCE_TANGENT:
        status = tribo_force_tangent(s->ctx, s->v, s->a, s->out[0], s->out[1], s->out[2], s->out[3]);
        break;
    case STEP:
    case STEP_STUCK:
        status = tribo_step_force(s->ctx, s->kernel == STEP ? 1e-3 : 1.0, s->v, s->out[0]);
        break;
    case SET_LIMIT:
        status = tribo_set_limit(s->ctx, s->limit);
        break;
    default:
        status = tribo_balance(s->ctx, s->v, s->a, NULL, s->out[0]);
    }
    need(status, tribo_message(s->ctx));
}
