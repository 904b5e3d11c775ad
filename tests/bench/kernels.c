/* What calls on contacts that share no body cost, beside a loop over arrays that is compiled the same way, in the same process:
 * the least of many short repetitions of both, since others use the machine too. bench_kernels --help tells the options. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../examples/common/output.h"
#include "../../src/common/simd.h"
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

static void measure(size_t n, int alike, size_t contacts, int repeats)
{
    printf("\n| n = %zu, %s | ns a contact | times the array loop |\n|---|---|---|\n", n,
           alike ? "one limit, one epsilon" : "limits and epsilons that differ");
    for (int k = 0; k < KERNELS; k++) {
        struct kernel_scene s;
        kernel_scene_create(&s, (enum kernel)k, n, alike);
        struct arrays w = {n, s.out[0], s.out[1], s.out[2], s.limit, s.v};
        const size_t times = contacts / n + 1;
        double loop = 1.0, kernel = 1.0;
        for (int j = 0; j < repeats; j++) {
            loop = lesser_of(loop, seconds_a_contact(run_arrays, &w, n, times));
            kernel = lesser_of(kernel, seconds_a_contact(run_kernel, &s, n, times));
        }
        printf("| %s | %.2f | %.2f of %.2f |\n", kernel_name[k], 1e9 * kernel, kernel / loop, 1e9 * loop);
        kernel_scene_destroy(&s);
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
        for (int alike = 1; alike >= 0; alike--) {
            measure(sizes[k], alike, smoke ? 1 : 200000, repeats);
        }
    }
    return EXIT_SUCCESS;
}
