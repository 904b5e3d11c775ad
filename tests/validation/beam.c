#include "beam.h"

#include "support.h"

gsl_spmatrix *beam_matrix(const char *name)
{
    char path[500];
    snprintf(path, sizeof path, "%s/%s", TRIBO_BEAM, name);
    FILE *file = fopen(path, "r");
    require(file, "cannot open %s", path);
    gsl_spmatrix *lower = gsl_spmatrix_fscanf(file);
    fclose(file);
    require(lower, "cannot read %s", path);
    gsl_spmatrix *whole = gsl_spmatrix_alloc(lower->size1, lower->size2);
    for (size_t k = 0; k < lower->nz; k++) {
        const size_t i = (size_t)lower->i[k], j = (size_t)lower->p[k];
        gsl_spmatrix_set(whole, i, j, lower->data[k]);
        gsl_spmatrix_set(whole, j, i, lower->data[k]);
    }
    gsl_spmatrix_free(lower);
    return whole;
}
