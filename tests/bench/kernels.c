/* SPDX-License-Identifier: BSD-3-Clause */
/* What calls on contacts that share no body cost, beside a loop over arrays that is compiled the same way, in the same process:
 * the least of many short repetitions of both, since others use the machine too. bench_kernels --help tells the options. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../src/damper/output.h"
#include "../../src/common/simd.h"
#include "../user_quinn.h"
#include "elements.h"
#include "harness.h"
#include "kernel_scene.h"

static const char help[] = "bench_kernels: what a call costs a contact, beside a loop over arrays.\n"
                           "\n"
                           "  --quick          fewer repetitions, and 1e6 contacts in place of 1e7\n"
                           "  --smoke          no times: fails if a kernel fails, for ctest\n";

struct arrays {
    size_t n;
    double *o, *b, *c, *d;
    const double *a;
};

TRIBO_SIMD static void add_products(size_t n, double *restrict o, const double *restrict a, const double *restrict b,
                                    const double *restrict c, const double *restrict d)
{
    for (size_t i = 0; i < n; i++) {
        o[i] = a[i] + b[i] * c[i] + d[i];
    }
}

static void run_arrays(void *data)
{
    const struct arrays *s = data;
    add_products(s->n, s->o, s->a, s->b, s->c, s->d);
}

/* The memory that a call has to pass over: what it is given is looked at as a whole before anything is written; then it is read
 * again, with what the context knows of each contact, while outputs are written. */
struct traffic {
    size_t n, read, written;
    const double *checked[2], *in[8];
    double *out[4];
    int odd;
};

TRIBO_SIMD static int any_odd(size_t n, const double *x, const double *y)
{
    int64_t any = 0;
    TRIBO_UNROLLED
    for (size_t i = 0; i < n; i++) {
        int64_t bits[2];
        memcpy(&bits[0], x + i, sizeof *bits);
        memcpy(&bits[1], y + i, sizeof *bits);
        any |= bits[0] | bits[1];
    }
    return (int)(any & 1);
}

TRIBO_SIMD static void add_to(size_t n, double *restrict sum, const double *restrict x)
{
    for (size_t i = 0; i < n; i++) {
        sum[i] += x[i];
    }
}

static void run_traffic(void *data)
{
    struct traffic *t = data;
    t->odd += any_odd(t->n, t->checked[0], t->checked[1]);
    for (size_t i = 0; i < t->n; i += TRIBO_CHUNK) {
        double sum[TRIBO_CHUNK] = {0};
        const size_t n = tribo_chunk_from(t->n, i);
        for (size_t k = 0; k < t->read; k++) {
            add_to(n, sum, t->in[k] + i);
        }
        for (size_t k = 0; k < t->written; k++) {
            memcpy(t->out[k] + i, sum, n * sizeof *sum);
        }
    }
}

/* Arrays that a call reads and writes: given ones that it checks, and of these the ones that it reads again; what the context
 * knows of each contact anyway; limits, and widths and rates, where these differ; outputs. */
static const struct passes {
    size_t given, again, known, limits, widths, written;
} passes[KERNELS] = {[FORCE] = {2, 2, 0, 1, 2, 1},   [FORCE_SLIDE] = {2, 1, 0, 1, 0, 1},   [FORCE_TANGENT] = {2, 2, 0, 1, 2, 4},
                     [BALANCE] = {2, 2, 1, 1, 2, 1}, [BALANCE_STUCK] = {2, 2, 1, 1, 2, 1}, [BALANCE_SLIDE] = {2, 1, 0, 1, 0, 1},
                     [STEP] = {1, 1, 0, 1, 0, 1},    [STEP_STUCK] = {1, 1, 1, 1, 0, 1},    [SET_LIMIT] = {1, 1, 0, 0, 0, 1}};

static struct traffic traffic_of(const struct kernel_scene *s, enum likeness like, double *known)
{
    const struct passes *p = &passes[s->kernel];
    struct traffic t = {s->n,
                        p->again + p->known + (like < ALL ? p->limits : 0) + (like == NOTHING ? p->widths : 0),
                        p->written,
                        {s->v, p->given > 1 ? s->a : s->v},
                        {s->v, s->a},
                        {NULL},
                        0};
    for (size_t k = p->again; k < t.read; k++) {
        t.in[k] = known + (k - p->again) * s->n;
    }
    for (size_t k = 0; k < t.written; k++) {
        t.out[k] = s->out[k];
    }
    return t;
}

static void run_kernel(void *data)
{
    kernel_call(data);
}

/* Seconds a contact of a job that is run so often. */
static double seconds_a_contact(void (*run)(void *), void *data, size_t n, size_t times)
{
    const double begin = cpu_seconds();
    for (size_t k = 0; k < times; k++) {
        run(data);
    }
    return (cpu_seconds() - begin) / (double)times / (double)n;
}

static double lesser_of(double x, double y)
{
    return x < y ? x : y;
}

static const char *const likeness_name[LIKENESSES] = {"limits and epsilons that differ", "limits that differ, one epsilon",
                                                      "one limit, one epsilon"};

static void measure(size_t n, enum likeness like, size_t contacts, int repeats)
{
    enum { MOST_KNOWN = 4 };
    double *known = need_memory(MOST_KNOWN * n, sizeof *known);
    memset(known, 0, MOST_KNOWN * n * sizeof *known);
    printf("\n| n = %zu, %s | ns a contact | times the array loop | times its own traffic |\n|---|---|---|---|\n", n,
           likeness_name[like]);
    for (int k = 0; k < KERNELS; k++) {
        struct kernel_scene s;
        kernel_scene_create(&s, (enum kernel)k, n, like);
        struct arrays w = {n, s.out[0], s.out[1], s.out[2], s.limit, s.v};
        struct traffic t = traffic_of(&s, like, known);
        const size_t times = contacts / n + 1;
        double loop = 1.0, kernel = 1.0, traffic = 1.0;
        for (int j = 0; j < repeats; j++) {
            loop = lesser_of(loop, seconds_a_contact(run_arrays, &w, n, times));
            traffic = lesser_of(traffic, seconds_a_contact(run_traffic, &t, n, times));
            kernel = lesser_of(kernel, seconds_a_contact(run_kernel, &s, n, times));
        }
        printf("| %s | %.2f | %.2f of %.2f | %.2f of %.2f |\n", kernel_name[k], 1e9 * kernel, kernel / loop, 1e9 * loop,
               kernel / traffic, 1e9 * traffic);
        kernel_scene_destroy(&s);
    }
    free(known);
}

/* R of islands of 4 contacts, each of which shares a body with the next one. */
static void couple(tribo_context *ctx, size_t n)
{
    size_t *row = need_memory(n + 1, sizeof *row), *col = need_memory(3 * n, sizeof *col), count = 0;
    double *val = need_memory(3 * n, sizeof *val);
    for (size_t i = 0; i < n; i++) {
        row[i] = count;
        for (size_t j = i > 0 ? i - 1 : i; j < n && j <= i + 1; j++) {
            if (i / 4 == j / 4) {
                val[count] = i == j ? 2.0 : -1.0;
                col[count++] = j;
            }
        }
    }
    row[n] = count;
    need(tribo_set_operator_csr(ctx, row, col, val), tribo_message(ctx));
    free(row);
    free(col);
    free(val);
}

/* Calls with Quinn's law as a function of the caller. */
struct own {
    struct kernel_scene s;
    struct quinn quinn;
    double *epsilon;
};

/* The function of the caller alone, on pieces as calls give to it. */
static void run_law(void *data)
{
    struct own *o = data;
    double box[9 * TRIBO_CHUNK];
    for (size_t i = 0; i < o->s.n; i += TRIBO_CHUNK) {
        const size_t n = tribo_chunk_from(o->s.n, i);
        quinn_box(i, n, o->s.kernel == FORCE_TANGENT, o->s.v + i, o->s.limit + i, o->epsilon + i, box, &o->quinn);
    }
}

/* Quinn's law as a function of the caller beside the built-in one. */
static void measure_own(size_t n, enum likeness like, size_t contacts, int repeats)
{
    static const struct {
        const char *name;
        enum kernel kernel;
    } row[] = {{"tribo_force", FORCE},
               {"tribo_force_tangent", FORCE_TANGENT},
               {"tribo_balance, diagonal R", BALANCE},
               {"tribo_balance, islands of 4 contacts", BALANCE}};
    enum { ROWS = sizeof row / sizeof *row, JOBS = 3 };
    struct kernel_scene s;
    struct own o = {.epsilon = need_memory(n, sizeof *o.epsilon)};
    kernel_scene_create(&s, FORCE, n, like);
    kernel_scene_create(&o.s, FORCE, n, like);
    need(tribo_get_epsilon(o.s.ctx, o.epsilon), tribo_message(o.s.ctx));
    need(tribo_set_user_law(o.s.ctx, quinn_box, &o.quinn), tribo_message(o.s.ctx));
    printf("\n| n = %zu, %s | built-in law, ns a contact | law of the caller | ratio | its function alone "
           "|\n|---|---|---|---|---|\n",
           n, likeness_name[like]);
    for (size_t k = 0; k < ROWS; k++) {
        double least[JOBS] = {1.0, 1.0, 1.0};
        const size_t times = contacts / n + 1;
        s.kernel = o.s.kernel = row[k].kernel;
        if (k == ROWS - 1) {
            couple(s.ctx, n);
            couple(o.s.ctx, n);
        }
        kernel_call(&s);
        kernel_call(&o.s);
        for (int j = 0; j < repeats; j++) {
            least[0] = lesser_of(least[0], seconds_a_contact(run_kernel, &s, n, times));
            least[1] = lesser_of(least[1], seconds_a_contact(run_kernel, &o.s, n, times));
            least[2] = lesser_of(least[2], seconds_a_contact(run_law, &o, n, times));
        }
        printf("| %s | %.2f | %.2f | %.2f | %.2f |\n", row[k].name, 1e9 * least[0], 1e9 * least[1], least[1] / least[0],
               1e9 * least[2]);
    }
    kernel_scene_destroy(&s);
    kernel_scene_destroy(&o.s);
    free(o.epsilon);
}

static void measure_elements(size_t n, size_t elements, int repeats)
{
    printf(
        "\n| n = %zu, elements with a state, a step with derivatives | ns an element | times the array loop |\n|---|---|---|\n",
        n);
    for (int k = 0; k < ELEMENT_LAWS; k++) {
        struct elements e;
        elements_create(&e, (enum element_law)k, n);
        struct arrays w = {n, e.df_dz, e.f, e.dz, e.parameter, e.state};
        const size_t times = elements / n + 1;
        double loop = 1.0, mean = 0.0;
        for (int j = 0; j < repeats; j++) { /* the mean: steps after a turn take longer */
            mean += seconds_a_contact(elements_step, &e, n, times) / repeats;
            loop = lesser_of(loop, seconds_a_contact(run_arrays, &w, n, times));
        }
        printf("| %s | %.2f | %.2f of %.2f |\n", element_name[k], 1e9 * mean, mean / loop, 1e9 * loop);
        elements_destroy(&e);
    }
}

int main(int count, char **argument)
{
    program = "bench_kernels";
    const int quick = count == 2 && strcmp(argument[1], "--quick") == 0,
              smoke = count == 2 && strcmp(argument[1], "--smoke") == 0;
    if (count > 1 && !quick && !smoke) {
        printf("%s", help);
        return strcmp(argument[1], "--help") == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
    }
    const size_t sizes[] = {1, 1000, quick ? 1000000 : 10000000};
    const int repeats = smoke ? 1 : quick ? 15 : 40;
    for (size_t k = 0; k < (smoke ? 2 : 3); k++) {
        for (int like = ALL; like >= NOTHING; like--) {
            measure(sizes[k], (enum likeness)like, smoke ? 1 : 200000, repeats);
        }
        measure_own(sizes[k], ALL, smoke ? 1 : 200000, repeats);
        measure_own(sizes[k], NOTHING, smoke ? 1 : 200000, repeats);
        measure_elements(sizes[k] < 1000000 ? sizes[k] : 1000000, smoke ? 1 : 200000, repeats);
    }
    return EXIT_SUCCESS;
}
