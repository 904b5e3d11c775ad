/* SPDX-License-Identifier: BSD-3-Clause */
/* The registry of laws, and a law for one contact. */

#include "tribo/tribo.h"

#include "law.h"
#include "common/text.h"

static const struct law *const laws[] = {
    [TRIBO_COULOMB] = &tribo_law_coulomb, [TRIBO_VELOCITY_LIMITED] = &tribo_law_velocity_limited,
    [TRIBO_SMOOTH] = &tribo_law_smooth,   [TRIBO_KARNOPP] = &tribo_law_karnopp,
    [TRIBO_QUINN] = &tribo_law_quinn,     [TRIBO_QUINN_REVERSAL] = &tribo_law_quinn_reversal,
};

int tribo_law_count(void)
{
    return (int)(sizeof laws / sizeof *laws);
}

const struct law *tribo_law(int id)
{
    return id >= 0 && id < tribo_law_count() ? laws[id] : NULL;
}

const char *tribo_law_name(int law)
{
    const struct law *l = tribo_law(law);
    return l ? l->name : NULL;
}

const char *tribo_law_reference(int law)
{
    const struct law *l = tribo_law(law);
    return l ? l->reference : NULL;
}

int tribo_law_find(const char *name, int *law)
{
    if (!name || !law) {
        return TRIBO_ERR_NULL;
    }
    for (int i = 0; i < tribo_law_count(); i++) {
        if (tribo_same_name(laws[i]->name, name)) {
            *law = i;
            return TRIBO_OK;
        }
    }
    return TRIBO_ERR_NAME;
}

int tribo_law_eval(int law, double v, double feq, double limit, double epsilon, double *f, double *df_dv, double *df_dfeq,
                   double *df_dlimit)
{
    const struct law *l = tribo_law(law);
    if (!l) {
        return TRIBO_ERR_RANGE;
    }
    if (!f) {
        return TRIBO_ERR_NULL;
    }
    const int needs_feq = l->uses_feq && fabs(v) <= epsilon;
    if (!isfinite(v) || !isfinite(limit) || !isfinite(epsilon) || (needs_feq && !isfinite(feq))) {
        return TRIBO_ERR_NOT_FINITE;
    }
    if (limit < 0.0) {
        return TRIBO_ERR_NEGATIVE;
    }
    if (epsilon <= 0.0) {
        return TRIBO_ERR_NOT_POSITIVE;
    }
    const double bound = lesser(limit, TRIBO_FAR), read = needs_feq ? cut(feq) : 0.0;
    const double rate = lesser(tribo_rate(epsilon), TRIBO_FAR / greater(bound, 1.0));
    const unsigned char moving = 1;
    const struct contacts c = {&limit, &bound, &epsilon, &rate, &moving, 0, 0, 0, 0, NULL};
    double ignored[3];
    const struct tangents to = {f, df_dv ? df_dv : ignored, df_dfeq ? df_dfeq : ignored + 1, df_dlimit ? df_dlimit : ignored + 2};
    l->tangent(&c, 1, &v, &read, &to);
    return TRIBO_OK;
}
