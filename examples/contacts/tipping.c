/* SPDX-License-Identifier: BSD-3-Clause */
/* A tall box that falls on a rough floor, slides, tips over an edge and comes to rest. Each of its eight corners is a planar
 * contact; those in the air have limit 0. R follows the box by tribo_update_operator at each step. The normal loads are of
 * springs in this program: tribo finds no gaps and no impacts. Core library only. Units: kg, m, s, N.
 *
 *     contact_tipping FOLDER
 *
 * Writes FOLDER/tipping.csv, FOLDER/tipping-energy.csv and FOLDER/values-tipping.txt. */
#include <math.h>
#include <string.h>

#include "../../src/damper/output.h"
#include "tribo/tribo.h"

/* 3 velocities of the centre, in the room; 3 of the rotation, in the axes of the box, where its inertia is constant. */
enum { CORNERS = 8, DIRECTIONS = 2 * CORNERS, DOFS = 6 };

static const double mass = 10.0, gravity = 9.81, half[3] = {0.1, 0.15, 0.3};
static const double stiffness = 2.5e4, loss = 10.0; /* of the floor at a corner: N = k d (1 + loss d') for a depth d > 0 */

struct box {
    tribo_context *corners;
    double mu, inverse[DOFS];          /* 1/mass, 1/inertia */
    double place[3], turn[4], u[DOFS]; /* of the centre; a quaternion; velocities */
    double corner[CORNERS][3];         /* from the centre, in the axes of the box */
    double arm[DIRECTIONS][3];         /* J: the velocity of direction i is u[i % 2] + arm' (u[3], u[4], u[5]) */
    double load[DIRECTIONS], f[DIRECTIONS];
    double start, highest, miss; /* energy; how far it rises within a step; how far forces are off Coulomb's law */
};

/* to = the rotation matrix: columns are the axes of the box in the room. */
static void axes(const double *q, double to[3][3])
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double all[3][3] = {{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)},
                              {2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)},
                              {2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)}};
    memcpy(to, all, sizeof all);
}

static void cross(const double *a, const double *b, double *to)
{
    to[0] = a[1] * b[2] - a[2] * b[1];
    to[1] = a[2] * b[0] - a[0] * b[2];
    to[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double height(const struct box *b, double r[3][3], int k)
{
    return b->place[2] + dot(r[2], b->corner[k]);
}

static double energy(const struct box *b)
{
    double r[3][3], sum = mass * gravity * b->place[2];
    axes(b->turn, r);
    for (int i = 0; i < DOFS; i++) {
        sum += 0.5 * b->u[i] * b->u[i] / b->inverse[i];
    }
    for (int k = 0; k < CORNERS; k++) {
        const double depth = fmax(-height(b, r, k), 0.0);
        sum += 0.5 * stiffness * depth * depth;
    }
    return sum;
}

/* J, of the place that the box has. Contacts act at the level of the floor: corners rest deeper by their loads, and rows of J
 * that differ by so little would make R nearly singular. */
static void find_rows(struct box *b)
{
    double r[3][3], point[3];
    axes(b->turn, r);
    for (int i = 0; i < DIRECTIONS; i++) {
        for (int k = 0; k < 3; k++) {
            point[k] = b->corner[i / 2][k] - height(b, r, i / 2) * r[2][k];
        }
        cross(point, r[i % 2], b->arm[i]);
    }
}

/* r = J M^-1 J'. */
static void find_operator(const struct box *b, double *r)
{
    for (int i = 0; i < DIRECTIONS; i++) {
        for (int j = 0; j < DIRECTIONS; j++) {
            double sum = i % 2 == j % 2 ? b->inverse[0] : 0.0;
            for (int k = 0; k < 3; k++) {
                sum += b->arm[i][k] * b->inverse[3 + k] * b->arm[j][k];
            }
            r[i * DIRECTIONS + j] = sum;
        }
    }
}

static void create(struct box *b, double mu)
{
    size_t planar[CORNERS];
    double r[DIRECTIONS * DIRECTIONS];
    *b = (struct box){.mu = mu, .turn = {1.0, 0.0, 0.0, 0.0}};
    for (int i = 0; i < 3; i++) {
        const double a = half[(i + 1) % 3], c = half[(i + 2) % 3];
        b->inverse[i] = 1.0 / mass;
        b->inverse[3 + i] = 3.0 / (mass * (a * a + c * c));
    }
    for (size_t k = 0; k < CORNERS; k++) {
        planar[k] = 2 * k;
        for (int i = 0; i < 3; i++) {
            b->corner[k][i] = k >> i & 1 ? half[i] : -half[i];
        }
    }
    need(tribo_create(&b->corners, DIRECTIONS), NULL);
    need(tribo_set_planar(b->corners, CORNERS, planar), tribo_message(b->corners));
    find_rows(b);
    find_operator(b, r);
    need(tribo_set_operator_dense(b->corners, r), tribo_message(b->corners));
}

/* Sets loads, and the velocities that the box has after a step without friction. */
static void push(struct box *b, double dt)
{
    double r[3][3], force[DOFS] = {0.0, 0.0, -mass * gravity}, spin[3], arm[3];
    axes(b->turn, r);
    for (int i = 0; i < 3; i++) {
        spin[i] = b->u[3 + i] / b->inverse[3 + i];
    }
    cross(spin, b->u + 3, force + 3); /* of the turning axes */
    for (int k = 0; k < CORNERS; k++) {
        cross(b->corner[k], r[2], arm);
        const double depth = -height(b, r, k), rate = -(b->u[2] + dot(arm, b->u + 3));
        const double load = depth > 0.0 ? fmax(stiffness * depth * (1.0 + loss * rate), 0.0) : 0.0;
        force[2] += load;
        for (int i = 0; i < 3; i++) {
            force[3 + i] += load * arm[i];
        }
        b->load[2 * k] = b->load[2 * k + 1] = load;
    }
    for (int i = 0; i < DOFS; i++) {
        b->u[i] += dt * b->inverse[i] * force[i];
    }
}

static double slip(const struct box *b, int direction)
{
    return b->u[direction % 2] + dot(b->arm[direction], b->u + 3);
}

/* Moves and turns by the velocities. */
static void move(struct box *b, double dt)
{
    const double rate = sqrt(dot(b->u + 3, b->u + 3)), angle = 0.5 * dt * rate;
    const double part = rate > 0.0 ? sin(angle) / rate : 0.0, *q = b->turn;
    const double by[4] = {cos(angle), part * b->u[3], part * b->u[4], part * b->u[5]};
    double to[4] = {
        q[0] * by[0] - q[1] * by[1] - q[2] * by[2] - q[3] * by[3], q[0] * by[1] + q[1] * by[0] + q[2] * by[3] - q[3] * by[2],
        q[0] * by[2] - q[1] * by[3] + q[2] * by[0] + q[3] * by[1], q[0] * by[3] + q[1] * by[2] - q[2] * by[1] + q[3] * by[0]};
    const double size = sqrt(to[0] * to[0] + dot(to + 1, to + 1));
    for (int i = 0; i < 4; i++) {
        b->turn[i] = to[i] / size;
    }
    for (int i = 0; i < 3; i++) {
        b->place[i] += dt * b->u[i];
    }
}

/* Coulomb's law of each corner, with the velocities after the step. */
static void check_law(struct box *b)
{
    for (int k = 0; k < DIRECTIONS; k += 2) {
        const double limit = b->mu * b->load[k], *f = b->f + k, size = hypot(f[0], f[1]);
        const double v[2] = {slip(b, k), slip(b, k + 1)}, speed = hypot(v[0], v[1]);
        const double over = fmax(size - limit, 0.0);
        const double off = speed > 1e-9 ? hypot(f[0] + limit * v[0] / speed, f[1] + limit * v[1] / speed) : 0.0;
        b->miss = fmax(b->miss, fmax(over, off) / (mass * gravity));
    }
}

static void step(struct box *b, double dt)
{
    double r[DIRECTIONS * DIRECTIONS], mu[DIRECTIONS], v[DIRECTIONS];
    const double before = energy(b);
    push(b, dt);
    find_rows(b);
    find_operator(b, r);
    for (int i = 0; i < DIRECTIONS; i++) {
        mu[i] = b->mu;
        v[i] = slip(b, i);
    }
    need(tribo_update_operator(b->corners, r), tribo_message(b->corners));
    need(tribo_set_normal_load(b->corners, mu, b->load), tribo_message(b->corners));
    need(tribo_step_force(b->corners, dt, v, b->f), tribo_message(b->corners));
    for (int i = 0; i < DIRECTIONS; i++) {
        b->u[i % 2] += dt * b->inverse[i % 2] * b->f[i];
        for (int k = 0; k < 3; k++) {
            b->u[3 + k] += dt * b->inverse[3 + k] * b->arm[i][k] * b->f[i];
        }
    }
    check_law(b);
    move(b, dt);
    b->highest = fmax(b->highest, energy(b) - before);
}

/* The 12 edges, seen from the side. */
static void draw(const struct box *b, FILE *table, double t)
{
    double r[3][3];
    axes(b->turn, r);
    for (int k = 0; k < CORNERS; k++) {
        for (int bit = 1; bit < CORNERS; bit *= 2) {
            for (int end = 0; !(k & bit) && end < 2; end++) {
                const double *c = b->corner[end ? k | bit : k];
                fprintf(table, "%.6g,%.6g,%.6g%s", t, b->place[0] + dot(r[0], c), b->place[2] + dot(r[2], c),
                        end ? "\n\n" : "\n");
            }
        }
    }
}

static double fastest(const struct box *b)
{
    double most = 0.0;
    for (int i = 0; i < DIRECTIONS; i++) {
        most = fmax(most, b->load[i] > 0.0 ? fabs(slip(b, i)) : 0.0);
    }
    return most;
}

/* The box falls, pushed and turning a little. Writes table and course unless they are NULL. *drift = the way of the box in the
 * last half second. */
static void fall(struct box *b, double dt, FILE *table, FILE *course, double *drift)
{
    const double end = 1.6;
    const long steps = lround(end / dt);
    double at[2] = {0.0, 0.0};
    create(b, 0.6);
    b->place[2] = half[2] + 0.05;
    b->u[0] = 1.5;
    b->u[5] = 0.6;
    b->start = energy(b);
    for (long k = 0; k <= steps; k++) {
        const double t = (double)k * dt;
        if (table && k % lround(0.15 / dt) == 0 && t < 0.76) {
            draw(b, table, t);
        }
        if (course && k % lround(0.005 / dt) == 0) {
            int used = 0;
            for (int i = 0; i < DIRECTIONS; i += 2) {
                used += b->load[i] > 0.0;
            }
            fprintf(course, "%.6g,%.8g,%d,%.6g\n", t, energy(b), used, fastest(b));
        }
        if (k == lround((end - 0.5) / dt)) {
            memcpy(at, b->place, sizeof at);
        }
        if (k < steps) {
            step(b, dt);
        }
    }
    *drift = hypot(b->place[0] - at[0], b->place[1] - at[1]);
    tribo_destroy(b->corners);
}

/* A box that friction does not tip, mu < half[0]/half[2]: the way that it slides. */
static double slide(double mu, double speed, double dt)
{
    struct box b;
    create(&b, mu);
    b.place[2] = half[2] - mass * gravity / (4.0 * stiffness);
    b.u[0] = speed;
    for (long k = 0; k < lround(0.7 / dt); k++) {
        step(&b, dt);
    }
    tribo_destroy(b.corners);
    return b.place[0];
}

int main(int argc, char **argv)
{
    program = "contact_tipping";
    if (argc != 2) {
        die("usage: contact_tipping FOLDER");
    }
    FILE *table = create_file(argv[1], "tipping.csv"), *course = create_file(argv[1], "tipping-energy.csv");
    FILE *values = create_file(argv[1], "values-tipping.txt");
    fprintf(table, "t,x,z\n");
    fprintf(course, "t,energy,corners,slip\n");
    enum { RUNS = 3 };
    double drift[RUNS], x[RUNS];
    struct box b;
    for (int k = 0; k < RUNS; k++) {
        const int last = k == RUNS - 1;
        fall(&b, ldexp(4e-4, -k), last ? table : NULL, last ? course : NULL, &drift[k]);
        x[k] = b.place[0];
        printf("steps of %g s: at rest at x = %.6f m, its centre %.6f m high\n", ldexp(4e-4, -k), x[k], b.place[2]);
    }
    const double sink = mass * gravity / (4.0 * stiffness), mu = 0.2, way = slide(mu, 1.0, 2e-4);
    /* it stops leaning forward on the springs of the floor, and comes back */
    const double lean = mu * mass * gravity * half[2] * half[2] / (4.0 * stiffness * half[0] * half[0]);
    write_value(values, x[RUNS - 1], "tipping.x");
    write_value(values, log2(fabs((x[0] - x[1]) / (x[1] - x[2]))), "tipping.order");
    write_value(values, b.place[2], "tipping.height");
    write_value(values, half[0] - sink, "tipping.height.formula");
    write_value(values, fastest(&b), "tipping.slip");
    write_value(values, drift[RUNS - 1], "tipping.drift");
    write_value(values, b.miss, "tipping.law");
    write_value(values, b.highest / b.start, "tipping.energy");
    write_value(values, way, "tipping.way");
    write_value(values, 1.0 / (2.0 * mu * gravity) - lean, "tipping.way.formula");
    printf("tips and stops at x = %.4f m; with less friction it stays upright and slides %.5f m\n", x[RUNS - 1], way);
    close_file(table, "tipping.csv");
    close_file(course, "tipping-energy.csv");
    close_file(values, "values-tipping.txt");
    return 0;
}
