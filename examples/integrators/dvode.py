# SPDX-License-Identifier: BSD-3-Clause
"""tribo inside DVODE, as scipy.integrate.ode has it, by ctypes: an oscillator with long times of rest.

    python3 dvode.py [path of libtribo.so]

x'' + x = f + 1.5 sin 0.5 t, |f| <= 1. Prints the error of the energy that friction takes in ten cycles, for settings that are right
and wrong. In Fortran max_step is HMAX, RWORK(6) with IOPT = 1; nsteps is IWORK(6); a Jacobian is MF = 21.
"""
import ctypes
import math
import sys

from scipy.integrate import ode

tribo = ctypes.CDLL(sys.argv[1] if len(sys.argv) > 1 else "libtribo.so.1")
contact = ctypes.c_void_p()
number = ctypes.c_double
energy = 67.67360117824  # by driver "exact"


def need(status):
    if status:
        raise ValueError("tribo: status %d" % status)


def balance(t, y):
    """v, a, f, df/dv, df/da"""
    v, a = number(y[1]), number(1.5 * math.sin(0.5 * t) - y[0])
    f, df_dv, df_da = number(), number(), number()
    need(tribo.tribo_balance_tangent(contact, ctypes.byref(v), ctypes.byref(a), None, ctypes.byref(f), ctypes.byref(df_dv),
                                     ctypes.byref(df_da)))
    return v.value, a.value, f.value, df_dv.value, df_da.value


def right_side(t, y):
    calls[0] += 1
    v, a, f, _, _ = balance(t, y)
    return [v, a + f, -f * v]


def jacobian(t, y):
    jacobians[0] += 1
    v, a, f, df_dv, df_da = balance(t, y)
    return [[0.0, 1.0, 0.0], [-1.0 - df_da, df_dv, 0.0], [v * df_da, -f - v * df_dv, 0.0]]


one = number(1.0)
need(tribo.tribo_create(ctypes.byref(contact), ctypes.c_size_t(1)))
need(tribo.tribo_set_limit(contact, ctypes.byref(one)))
need(tribo.tribo_set_operator_diagonal(contact, ctypes.byref(one)))
error = {}
# name, epsilon, largest step (0: none), tolerances: relative, absolute of x and energy, absolute of v; tangents
for name, epsilon, longest, relative, absolute, velocity, tangents in (
    ("wide", 1e-2, 0.1, 1e-8, 1e-8, 1e-5, True), ("middle", 1e-3, 0.1, 1e-8, 1e-8, 1e-6, True),
    ("narrow", 1e-4, 0.1, 1e-8, 1e-8, 1e-7, True), ("fine", 1e-5, 0.1, 1e-11, 1e-11, 1e-9, True),
    ("unbounded", 1e-4, 0.0, 1e-8, 1e-8, 1e-7, True), ("tolerant", 1e-4, 0.1, 1e-8, 1e-8, 1e-4, True),
    ("differences", 1e-4, 0.1, 1e-8, 1e-8, 1e-7, False),
):
    calls, jacobians = [0], [0]
    need(tribo.tribo_set_epsilon_all(contact, number(epsilon)))
    vode = ode(right_side, jacobian if tangents else None)
    vode.set_integrator("vode", method="bdf", with_jacobian=True, rtol=relative, atol=[absolute, velocity, absolute], max_step=longest,
                        nsteps=1000000)
    y = vode.set_initial_value([0.0, 0.0, 0.0], 0.0).integrate(40.0 * math.pi)
    assert vode.successful()
    error[name] = abs(y[2] / energy - 1.0)
    print("dvode.%s.error %.3e\ndvode.%s.calls %d\ndvode.%s.jacobians %d" % (name, error[name], name, calls[0], name, jacobians[0]))
tribo.tribo_destroy(contact)
for name, most in (("wide", 2e-5), ("middle", 3e-5), ("narrow", 3e-6), ("fine", 3e-8), ("tolerant", 1e-2), ("differences", 3e-6)):
    assert error[name] < most, name
assert abs(error["unbounded"] - 1.0) < 0.01  # passes over all of it, with success
