/* Methods "central/fixed" and "moreau/fixed": second order, an energy balance of the discrete motion that closes to rounding, exact
 * stick, and nothing that depends on epsilon. */
#include <string.h>

#include "coulomb.h"
#include "model.h"

static const char *const methods[] = {"central/fixed", "moreau/fixed"};

/* -------------------------------------------------------------------------------------------------------------- accuracy */

/* Where contacts stick, second order; a step of which a contact reverses without stick is taken for one of stick, and the error
 * falls with dt only: 7b. Orders over a factor of 100; errors jump with where the steps are. */
TEST(orders)
{
    const double dt[] = {0.03, 0.01, 0.003, 0.001, 0.0003}, least[] = {1.7, 0.7, 0.7, 1.7, 1.7, 1.7, 1.7};
    const struct reference *r = &references[_i % REFERENCES];
    double error[COUNT(dt)];
    for (size_t k = 0; k < COUNT(dt); k++) {
        error[k] = reference_error(r, methods[_i / REFERENCES], dt[k], 0.0, NULL);
    }
    const double order = order_of(dt, error, COUNT(dt));
    require(order >= least[_i % REFERENCES], "%s, %s: order %.2f, errors %.2g to %.2g", r->name, methods[_i / REFERENCES], order,
            error[0], error[COUNT(dt) - 1]);
}

TEST_MAIN("step_form", {orders, 2 * REFERENCES})
