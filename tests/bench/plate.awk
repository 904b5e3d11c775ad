# SPDX-License-Identifier: BSD-3-Clause
# awk -v nx=40 -v ny=12 -v modes=20 -v solver=ARPACK -f plate.awk: CalculiX's input of a steel plate of nx by ny bricks of 20 nodes,
# 300 x 100 x 4 mm, clamped at x = 0 (tonne, mm, s). The solver MATRIXSTORAGE writes the matrices instead of the modes.

# The number of node (i, j, k), in halves of an element from the corner; a new one is noted with its coordinates.
function node(i, j, k) {
    if (!((i, j, k) in number)) {
        number[i, j, k] = ++nodes
        at[nodes] = sprintf("%.10g,%.10g,%.10g", 300 * i / (2 * nx), 100 * j / (2 * ny), 4 * k / 2)
        if (i == 0) fixed = fixed (fixed ? ",\n" : "") nodes
    }
    return number[i, j, k]
}

BEGIN {
    corners = split("000 200 220 020 002 202 222 022 100 210 120 010 102 212 122 012 001 201 221 021", offset, " ")
    for (y = 0; y < ny; y++)
        for (x = 0; x < nx; x++) {
            line = ++elements
            for (c = 1; c <= corners; c++)
                line = line (c == 11 ? ",\n" : ",") node(2 * x + substr(offset[c], 1, 1), 2 * y + substr(offset[c], 2, 1),
                                                         0 + substr(offset[c], 3, 1))
            element[elements] = line
        }
    print "*NODE,NSET=NALL"
    for (n = 1; n <= nodes; n++) print n "," at[n]
    print "*ELEMENT,TYPE=C3D20,ELSET=EALL"
    for (e = 1; e <= elements; e++) print element[e]
    print "*NSET,NSET=FIX\n" fixed "\n*BOUNDARY\nFIX,1,3\n*MATERIAL,NAME=ST\n*ELASTIC\n210000.,0.3\n*DENSITY\n7.85E-9"
    print "*SOLID SECTION,ELSET=EALL,MATERIAL=ST\n*STEP\n*FREQUENCY,STORAGE=YES,SOLVER=" solver "\n" modes
    print (solver == "MATRIXSTORAGE" ? "" : "*NODE FILE\nU\n") "*END STEP"
}
