/* What of tribo_gsl.h Fortran cannot call as it is, since structures of GSL's stand in between, and
 * what must be pure there. */
#include <string.h>

#include "gsl.h"

size_t tribo_fortran_ndof(const struct tribo_held *held)
{
    return held ? tribo_system_ndof(held->sys) : 0;
}

size_t tribo_fortran_ncontact(const struct tribo_held *held)
{
    return held ? tribo_system_ncontact(held->sys) : 0;
}

size_t tribo_fortran_given(const struct tribo_held *held)
{
    return held ? (size_t)held->given : 0;
}

/* Borrows the arrays: nothing in here changes them. */
static gsl_spmatrix borrow(const struct tribo_rows *a)
{
    gsl_spmatrix m;
    memset(&m, 0, sizeof m);
    m.size1 = a->rows;
    m.size2 = a->columns;
    m.p = (int *)a->first;
    m.i = (int *)a->col;
    m.data = (double *)a->val;
    m.nz = m.nzmax = (size_t)a->first[a->rows];
    m.sptype = GSL_SPMATRIX_CSR;
    return m;
}

int tribo_fortran_linear(tribo_system **sys, const struct tribo_rows *mass, const struct tribo_rows *damping,
                         const struct tribo_rows *stiffness, const struct tribo_rows *direction, size_t nmode, char *message,
                         size_t size)
{
    const gsl_spmatrix m = borrow(mass), k = borrow(stiffness), j = borrow(direction), c = damping ? borrow(damping) : m;
    return tribo_system_linear_sparse(sys, &m, damping ? &c : NULL, &k, &j, nmode, message, size);
}

int tribo_fortran_reduced(tribo_system **sys, const struct tribo_rows *mass, const struct tribo_rows *stiffness,
                          const struct tribo_rows *direction, size_t nmode, int static_contacts, char *message, size_t size)
{
    const gsl_spmatrix m = borrow(mass), k = borrow(stiffness), j = borrow(direction);
    return tribo_system_reduced(sys, &m, &k, &j, nmode, static_contacts, message, size);
}

/* GSL's status tells less than what the same state gets from tribo. */
static int status_of(tribo_system *sys, double t, const double *y, int gsl_status)
{
    const int status = gsl_status ? tribo_system_contacts(sys, t, y, NULL, NULL, NULL) : TRIBO_OK;
    return gsl_status && !status ? TRIBO_ERR_MEMORY : status;
}

int tribo_fortran_derivative(tribo_system *sys, double t, const double *y, double *dydt)
{
    const gsl_odeiv2_system *s = tribo_system_odeiv2(sys);
    return status_of(sys, t, y, s->function(t, y, dydt, s->params));
}

int tribo_fortran_jacobian(tribo_system *sys, double t, const double *y, double *dfdy, double *dfdt)
{
    const gsl_odeiv2_system *s = tribo_system_odeiv2(sys);
    return status_of(sys, t, y, s->jacobian(t, y, dfdy, dfdt, s->params));
}
