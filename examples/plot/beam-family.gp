# SPDX-License-Identifier: BSD-3-Clause
# The beam with two contacts near its root: from the free resonance to the stuck one, and the best limit between them.
name = 'beam-family'; wide = 900; high = 520
family = 'beam'
set xrange [20:60]
set yrange [5e-3:20]
load 'style-family.gp'
