# SPDX-License-Identifier: BSD-3-Clause
"""Two masses on springs, each with a friction contact: libtribo from Python by ctypes, on numpy arrays in place.

    python3 friction.py [path of libtribo.so]
"""
import ctypes
import sys

import numpy as np

tribo = ctypes.CDLL(sys.argv[1] if len(sys.argv) > 1 else "libtribo.so.1")
tribo.tribo_message.restype = ctypes.c_char_p
vector = np.ctypeslib.ndpointer(dtype=np.float64, ndim=1, flags="C_CONTIGUOUS")
tribo.tribo_balance.argtypes = [ctypes.c_void_p, vector, vector, ctypes.c_void_p, vector]
tribo.tribo_set_epsilon_step.argtypes = [ctypes.c_void_p, ctypes.c_double, ctypes.c_double]
for name in ("tribo_set_limit", "tribo_set_operator_diagonal"):
    getattr(tribo, name).argtypes = [ctypes.c_void_p, vector]


def need(status):
    if status:
        raise ValueError(tribo.tribo_message(contacts).decode())


mass, spring, limit, dt = np.array([2.0, 1.0]), np.array([100.0, 100.0]), np.array([3.0, 0.5]), 1e-3
x, v, f = np.array([0.2, 0.2]), np.zeros(2), np.zeros(2)
contacts = ctypes.c_void_p()
need(tribo.tribo_create(ctypes.byref(contacts), ctypes.c_size_t(2)))
need(tribo.tribo_set_limit(contacts, limit))
need(tribo.tribo_set_operator_diagonal(contacts, 1 / mass))
need(tribo.tribo_set_epsilon_step(contacts, dt, 0.4))
for step in range(20000):
    need(tribo.tribo_balance(contacts, v, -spring * x / mass, None, f))
    v += dt * (f - spring * x) / mass
    x += dt * v
tribo.tribo_destroy(contacts)
print("at rest at", x, "held by", f)
assert np.all(np.abs(v) < 1e-12) and np.allclose(f, spring * x, rtol=1e-9) and np.all(np.abs(f) <= limit)
