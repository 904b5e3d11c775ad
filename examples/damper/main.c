/* A structure with friction contacts, as a user meets it: matrices from a finite-element program, contacts by coordinates, and
 * the question which contact force makes the best friction damper. friction_damper --help tells the rest. */
#include <math.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>

#include "../common/output.h"
#include "linear.h"

/* What the whole run has at hand. */
struct job {
    const struct options *options;
    struct damper *damper;
    double *y; /* [2 modes + 1] */
    FILE *values;
};

static void show_frequencies(const struct job *job)
{
    const struct damper *d = job->damper;
    const char *given = job->options->frequencies;
    double *hz = need_memory(d->modes, sizeof *hz), worst = 0.0;
    const size_t known = given ? read_frequencies(given, hz, d->modes) : 0;
    FILE *table = create_file(job->options->out, "damper-frequencies.csv");
    fprintf(table, "mode,frequency,given,relative difference\n");
    printf("natural frequencies, Hz\n  mode         here%s\n", known ? "        given  relative difference" : "");
    for (size_t k = 0; k < d->modes; k++) {
        const double here = d->omega[k] / (2.0 * acos(-1.0));
        printf("  %4zu %12.7g", k + 1, here);
        fprintf(table, "%zu,%.10g", k + 1, here);
        if (k < known) {
            printf(" %12.7g  %.1e", hz[k], here / hz[k] - 1.0);
            fprintf(table, ",%.10g,%.3g", hz[k], here / hz[k] - 1.0);
            worst = fmax(worst, fabs(here / hz[k] - 1.0));
        }
        printf("\n");
        fprintf(table, "%s\n", k < known ? "" : ",,");
        write_value(job->values, here, "damper.frequency%zu", k + 1);
    }
    if (known) {
        write_value(job->values, worst, "damper.frequency.error");
    }
    close_file(table, "damper-frequencies.csv");
    free(hz);
}

/* Why the step is what it is: rk4 damps a mode by (omega dt)^5/144 of critical, and follows it up to omega dt = 2.8. */
static void show_step(const struct job *job)
{
    const struct damper *d = job->damper;
    const double dt = d->period / (double)d->steps, top = d->omega[d->modes - 1] * dt;
    printf("load at %.7g Hz; %zu steps a period, dt = %.4g: omega dt = %.3g at the highest mode kept,\n"
           "which rk4 damps by %.1e of critical, beside the structure's own %g; stuck contacts relax at 1/dt\n",
           1.0 / d->period, d->steps, dt, top, pow(top, 5) / 144.0, d->damping);
}

static struct response respond(const struct job *job, double limit)
{
    const struct response r = find_response(job->damper, limit, job->y);
    if (!r.steady) {
        printf("not steady at limit %g after %zu cycles\n", limit, r.cycles);
    }
    return r;
}

static void write_response(FILE *table, const struct response *r)
{
    fprintf(table, "%.10g,%.10g,%.10g,%.10g,%.10g,%zu,%d\n", r->limit, r->amplitude, r->friction, r->damped, r->input, r->cycles,
            r->steady);
    printf("  %12.5g %12.5g %14.5g %14.5g %8zu%s\n", r->limit, r->amplitude, r->friction, r->damped, r->cycles,
           r->steady ? "" : "  not steady");
    fflush(stdout);
}

/* Relative difference; none between zeros. */
static double difference(double a, double b)
{
    return a == b ? 0.0 : fabs(a - b) / fmax(fabs(a), fabs(b));
}

/* The curve; returns the place in r [points] of the largest dissipated power. */
static size_t run_curve(const struct job *job, struct response *r)
{
    const struct options *o = job->options;
    FILE *table = create_file(o->out, "damper-curve.csv");
    size_t best = 0;
    double unbalanced = 0.0, all_steady = 1.0;
    fprintf(table, "limit,amplitude,friction power,damping power,input power,cycles,steady\n");
    printf("         limit    amplitude friction power  damping power   cycles\n");
    for (size_t i = 0; i < o->limit_points; i++) {
        const double exponent = i ? (double)i / (double)(o->limit_points - 1) : 0.0;
        r[i] = respond(job, o->limit_from * pow(o->limit_to / o->limit_from, exponent));
        write_response(table, &r[i]);
        best = r[i].friction > r[best].friction ? i : best;
        unbalanced = fmax(unbalanced, difference(r[i].input, r[i].friction + r[i].damped));
        all_steady = r[i].steady ? all_steady : 0.0;
    }
    write_value(job->values, unbalanced, "damper.balance");
    write_value(job->values, all_steady, "damper.steady");
    close_file(table, "damper-curve.csv");
    return best;
}

/* Golden section for the most power, on the logarithm of the limit, between the neighbours of the best point of the curve. */
static struct response find_optimum(const struct job *job, double low, double high)
{
    const double ratio = 0.5 * (sqrt(5.0) - 1.0);
    double a = log(low), b = log(high);
    struct response left = respond(job, exp(b - ratio * (b - a))), right = respond(job, exp(a + ratio * (b - a)));
    while (b - a > 1e-3) {
        if (left.friction > right.friction) {
            b = log(right.limit);
            right = left;
            left = respond(job, exp(b - ratio * (b - a)));
        } else {
            a = log(left.limit);
            left = right;
            right = respond(job, exp(a + ratio * (b - a)));
        }
    }
    return left.friction > right.friction ? left : right;
}

/* Three periods of the steady motion at a limit, with what each contact does. */
static void write_history(const struct job *job, double limit, const char *name)
{
    struct damper *d = job->damper;
    tribo_context *contacts = tribo_system_context(d->sys);
    double *v = need_memory(2 * d->contacts, sizeof *v), *f = v + d->contacts, t = 0.0;
    signed char *mode = need_memory(d->contacts, sizeof *mode);
    FILE *table = create_file(job->options->out, name);
    respond(job, limit);
    fprintf(table, "cycle,t,displacement");
    for (size_t c = 0; c < d->contacts; c++) {
        fprintf(table, ",v%zu,f%zu,mode%zu", c + 1, c + 1, c + 1);
    }
    fprintf(table, "\n");
    for (size_t i = 0; i <= 3 * d->steps; i++) {
        const double cycle = (double)i / (double)d->steps;
        need(tribo_driver_advance(d->drv, &t, cycle * d->period, job->y), tribo_driver_message(d->drv));
        need(tribo_system_contacts(d->sys, t, job->y, v, NULL, f), tribo_message(contacts));
        need(tribo_get_slip(contacts, mode), tribo_message(contacts));
        fprintf(table, "%.8g,%.10g,%.10g", cycle, t, load_displacement(d, job->y));
        for (size_t c = 0; c < d->contacts; c++) {
            fprintf(table, ",%.8g,%.8g,%d", v[c], f[c], mode[c]);
        }
        fprintf(table, "\n");
    }
    close_file(table, name);
    free(v);
    free(mode);
}

/* Without friction, and with so much that nothing slips: both are known. */
static void check_extremes(const struct job *job)
{
    const struct response open = respond(job, 0.0), stuck = respond(job, 1e6 * job->options->force);
    const double amplitude[] = {free_amplitude(job->damper), stuck_amplitude(job->damper)};
    printf("amplitude without friction %.8g, from the modes' resonance curves %.8g\n", open.amplitude, amplitude[0]);
    printf("amplitude with all contacts stuck %.8g, from the modes held at the contacts %.8g\n", stuck.amplitude, amplitude[1]);
    write_value(job->values, open.amplitude, "damper.free");
    write_value(job->values, amplitude[0], "damper.free.analytic");
    write_value(job->values, stuck.amplitude, "damper.stuck");
    write_value(job->values, amplitude[1], "damper.stuck.analytic");
}

/* The same with half the step: what the step, and with it epsilon, does to the results. */
static void check_step(const struct job *job, const struct response *r, const char *key)
{
    const size_t steps = job->damper->steps;
    set_steps(job->damper, 2 * steps);
    const struct response half = respond(job, r->limit);
    set_steps(job->damper, steps);
    const double amplitude = difference(r->amplitude, half.amplitude), power = difference(r->friction, half.friction);
    printf("limit %.5g with half the step: amplitude differs by %.1e, power by %.1e\n", r->limit, amplitude, power);
    write_value(job->values, amplitude, "damper.%s.step.amplitude", key);
    write_value(job->values, power, "damper.%s.step.power", key);
}

static void report_optimum(const struct job *job, const struct response *best)
{
    const struct optimum simple = harmonic_balance(job->damper);
    printf("optimum: limit %.5g dissipates %.6g (harmonic balance of the driven mode: %.5g, %.6g), amplitude %.6g\n", best->limit,
           best->friction, simple.limit, simple.power, best->amplitude);
    write_value(job->values, best->limit, "damper.best.limit");
    write_value(job->values, simple.limit, "damper.best.limit.balance");
    write_value(job->values, best->friction, "damper.best.power");
    write_value(job->values, simple.power, "damper.best.power.balance");
    write_value(job->values, best->amplitude, "damper.best.amplitude");
    write_value(job->values, simple.amplitude, "damper.best.amplitude.balance");
}

static void run(const struct job *job)
{
    const size_t points = job->options->limit_points;
    struct response *r = need_memory(points, sizeof *r);
    show_frequencies(job);
    show_step(job);
    check_extremes(job);
    const size_t at = run_curve(job, r);
    if (r[at].friction <= 0.0) {
        printf("friction dissipates nothing at any of these limits: nothing slips, or the contacts are where nothing moves\n");
    } else if (at == 0 || at == points - 1) {
        printf("most power is dissipated at the end of the range, at limit %g: widen --limits to find the optimum\n",
               r[at].limit);
    } else {
        const struct response best = find_optimum(job, r[at - 1].limit, r[at + 1].limit);
        check_step(job, &best, "best");
        write_history(job, best.limit, "damper-history.csv");
        /* above the optimum contacts rest for a part of each period */
        const struct response sticking = respond(job, 3.0 * best.limit);
        check_step(job, &sticking, "sticking");
        write_history(job, sticking.limit, "damper-sticking.csv");
        report_optimum(job, &best);
    }
    free(r);
}

int main(int argc, char **argv)
{
    program = "friction_damper";
    gsl_set_error_handler_off();
    const struct options options = read_options(argc, argv);
    struct structure structure = read_structure(&options);
    struct damper damper = create_damper(&options, &structure);
    free_structure(&structure);
    struct job job = {&options, &damper, need_memory(2 * damper.modes + 1, sizeof(double)),
                      create_file(options.out, "values-damper.txt")};
    run(&job);
    close_file(job.values, "values-damper.txt");
    free(job.y);
    free_damper(&damper);
    return 0;
}
