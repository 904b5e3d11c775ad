# SPDX-License-Identifier: BSD-3-Clause
# The lowest modes of what CalculiX writes, by scipy's eigsh (ARPACK, and SuperLU's factor): python3 peer_scipy.py name modes
# Prints values by name, as bench_modes does.
import sys
import time

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg

name, modes = sys.argv[1], int(sys.argv[2])
n = sum(1 for _ in open(name + '.dof'))


def matrix(path):
    a = np.fromfile(path, sep=' ').reshape(-1, 3)
    i, j, v = a[:, 0].astype(int) - 1, a[:, 1].astype(int) - 1, a[:, 2]
    other = i != j
    whole = sp.coo_matrix((np.r_[v, v[other]], (np.r_[i, j[other]], np.r_[j, i[other]])), shape=(n, n)).tocsc()
    whole.eliminate_zeros()
    return whole


def kilobytes(name):
    return next((int(line.split()[1]) for line in open('/proc/self/status') if line.startswith(name)), 0)


stiffness, mass = matrix(name + '.sti'), matrix(name + '.mas')
open('/proc/self/clear_refs', 'w').write('5')
before = kilobytes('VmRSS:')
begin = time.process_time()
values = scipy.sparse.linalg.eigsh(stiffness, modes, mass, sigma=0.0, return_eigenvectors=True)[0]
print('ndof %d\nmodes %.3f s' % (n, time.process_time() - begin))
print('memory %.0f MB' % ((kilobytes('VmHWM:') - before) * 1024e-6))
print('first %.9g Hz\nlast %.9g Hz' % tuple(np.sqrt(values[[0, -1]]) / (2 * np.pi)))
