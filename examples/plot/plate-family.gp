# SPDX-License-Identifier: BSD-3-Clause
# The plate on six contacts: the same.
name = 'plate-family'; wide = 900; high = 520
family = 'plate'
set xrange [30:150]
set yrange [2e-3:30]
load 'style-family.gp'
