/* Structures with contacts held: amplitudes of modes from displacements and velocities, and displacements from amplitudes. */
#include "modal.h"

#include <string.h>

void tribo_modal_amplitudes(const struct modal *h, size_t columns, const double *v, size_t block, double *eta, size_t next,
                            double *work)
{
    const size_t second = h->moving * columns;
    const int sparse = !h->columns;
    for (size_t part = 0; part < 2; part++, v += block) {
        double *to = eta + part * next;
        memset(to, 0, h->modes * columns * sizeof *to);
        for (size_t k = 0; sparse && k < h->modes; k++, to += columns) {
            for (size_t i = h->begin[k], end = h->end[k]; i < end; i++) {
                for (size_t j = 0; j < columns; j++) {
                    to[j] += h->psi[k * h->moving + i] * v[h->dof[i] * columns + j];
                }
            }
        }
        for (size_t i = 0; !sparse && i < h->moving; i++) {
            memcpy(work + part * second + i * columns, v + h->dof[i] * columns, columns * sizeof *v);
        }
    }
    if (!sparse) {
        tribo_multiply_transposed_two(h->moving, h->modes, columns, h->columns, work, second, eta, next);
    }
}

void tribo_modal_add(const struct modal *h, size_t columns, const double *eta, size_t next, double *v, size_t block, double *work)
{
    const size_t second = h->moving * columns;
    const int sparse = !h->columns;
    if (!sparse) {
        memset(work, 0, 2 * second * sizeof *work);
        tribo_multiply_transposed_two(h->modes, h->moving, columns, h->phi, eta, next, work, second);
    }
    for (size_t part = 0; part < 2; part++, v += block) {
        const double *from = eta + part * next;
        for (size_t k = 0; sparse && k < h->modes; k++, from += columns) {
            for (size_t i = h->begin[k], end = h->end[k]; i < end; i++) {
                for (size_t j = 0; j < columns; j++) {
                    v[h->dof[i] * columns + j] += h->phi[k * h->moving + i] * from[j];
                }
            }
        }
        for (size_t i = 0; !sparse && i < h->moving; i++) {
            tribo_add(v + h->dof[i] * columns, 1.0, work + part * second + i * columns, columns);
        }
    }
}
