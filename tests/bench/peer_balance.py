# SPDX-License-Identifier: BSD-3-Clause
# Steady motions of the beam of the examples by harmonic balance, free of this library: numpy and scipy only.
#   python3 peer_balance.py ../../examples/data/beam 0.001 101,201,401,801 40 80.1 120 160
# Folder of the matrices, limit of the contacts (N), highest harmonics, frequencies of the load (Hz). Prints for each frequency and
# highest harmonic the power that friction dissipates (mW), of which values are those of
#   tribo-damper --read beam.txt --modes 12 --limits 0.001 --drive 40
# The structure is that of the tool: 12 modes and the static responses to forces at contacts and load. Coulomb's law holds at each
# sample of time as f = clip(f + r v), with no smoothing (Nacivet et al. 2003, J. Sound Vib. 265, 201); the harmonics
# of f are found by Newton's method. Motion and friction are odd over half a period: harmonics 1, 3, 5, ...
import sys
import time

import numpy as np
import scipy.io
import scipy.linalg
import scipy.sparse.linalg

MODES, DAMPING, FORCE = 12, 0.002, 0.1
CONTACTS = [(200, 0, 5), (300, 0, 5), (400, 0, 5)]
LOAD = (400, 20, 5)
SAMPLES = 4  # of half a period, times the highest harmonic
GAIN = 10.0  # r of a contact, times the smallest driving force per velocity: for all r > 0 the solution is the same

folder, limit = sys.argv[1], float(sys.argv[2])
highest, drives = [int(s) for s in sys.argv[3].split(',')], [float(s) for s in sys.argv[4:]]


def reduced():
    """Natural frequencies, and the values of the modes at contacts and load."""
    mass, stiffness = (scipy.io.mmread(f'{folder}/{name}.mtx').tocsc() for name in ('M', 'K'))
    row = {}
    for line in open(f'{folder}/dofs.txt'):
        if not line.startswith('#'):
            word = line.split()
            if word[2] == '3':
                row[tuple(float(x) for x in word[3:6])] = int(word[0]) - 1
    places = [row[place] for place in CONTACTS + [LOAD]]
    factor = scipy.sparse.linalg.splu(stiffness)
    modes = scipy.linalg.eigh(stiffness.toarray(), mass.toarray(), subset_by_index=[0, MODES - 1])[1]
    for _ in range(8):  # removes the rounding of the dense solver, which is relative to the highest mode
        modes = np.column_stack([factor.solve(x) for x in (mass @ modes).T])
        modes = modes @ scipy.linalg.eigh(modes.T @ (stiffness @ modes), modes.T @ (mass @ modes))[1]
    unit = np.zeros((mass.shape[0], len(places)))
    unit[places, range(len(places))] = 1.0
    basis = np.c_[modes, np.column_stack([factor.solve(x) for x in unit.T])]
    for _ in range(2):
        for j in range(basis.shape[1]):
            for i in range(j):
                basis[:, j] -= basis[:, i] * (basis[:, i] @ (mass @ basis[:, j]))
            basis[:, j] /= np.sqrt(basis[:, j] @ (mass @ basis[:, j]))
    square, turn = scipy.linalg.eigh(basis.T @ (stiffness @ basis))
    at = (basis @ turn)[places]
    return np.sqrt(square), at[:-1], at[-1]


def solve(hz, top, start):
    """Harmonics of friction [contacts][2 harmonics: real, imaginary parts], and the power; start: those of fewer harmonics."""
    h = np.arange(1, top + 1, 2)
    n, omega = 2 * len(h), 2 * np.pi * hz * h[:, None]
    velocity = 1j * omega / (nature**2 - omega**2 + 2j * DAMPING * nature * omega)
    mobility = np.einsum('am,hm,bm->hab', contact, velocity, contact)
    free = np.zeros((len(h), len(contact)), complex)
    free[0] = -1j * FORCE * (contact * velocity[0]) @ load
    real = lambda y: np.block([[np.diag(y.real), np.diag(-y.imag)], [np.diag(y.imag), np.diag(y.real)]])
    y = np.block([[real(mobility[:, a, b]) for b in range(len(contact))] for a in range(len(contact))])
    free = np.concatenate([np.r_[v.real, v.imag] for v in free.T])
    samples = SAMPLES * (top + 1)
    angle = np.outer(np.arange(samples) * np.pi / samples, h)
    wave = np.c_[np.cos(angle), -np.sin(angle)]
    gain = [GAIN / abs(mobility[:, a, a]).max() for a in range(len(contact))]
    f = np.zeros((len(contact), n))
    if start is not None:
        old = start.shape[1] // 2
        f[:, :old], f[:, n // 2:n // 2 + old] = start[:, :old], start[:, old:]
    f = f.ravel()
    for steps in range(60):
        residual, slope = f.copy(), np.eye(len(f))
        v = free - y @ f
        for a, r in enumerate(gain):
            of = slice(a * n, (a + 1) * n)
            trial = wave @ (f[of] + r * v[of])
            residual[of] -= 2.0 / samples * wave.T @ trial.clip(-limit, limit)
            inside = wave[abs(trial) < limit]
            change = -r * y[of]
            change[:, of] += np.eye(n)
            slope[of] -= 2.0 / samples * (inside.T @ inside) @ change
        if abs(residual).max() < 1e-13 * limit:
            return f.reshape(len(contact), n), 0.5 * f @ (free - y @ f), steps
        f -= np.linalg.solve(slope, residual)
    raise SystemExit(f'{hz} Hz, {top} harmonics: Newton does not converge')


nature, contact, load = reduced()
for hz in drives:
    found = None
    for top in highest:
        begin = time.time()
        found, power, steps = solve(hz, top, found)
        print(f'{hz:g} Hz, harmonics to {top}: {power:.10g} mW, {steps} steps, {time.time() - begin:.1f} s', flush=True)
