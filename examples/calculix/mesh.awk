# SPDX-License-Identifier: BSD-3-Clause
# awk -v nx=8 -v ny=1 -v length_x=400 -v length_y=20 -v length_z=5 -f mesh.awk: a clamped plate of 20-node bricks, one layer, for
# CalculiX; its nodes are numbered as in examples/data.
function node(a, b, c) {
    if (!((a, b, c) in number)) {
        number[a, b, c] = ++nodes
        place[nodes] = sprintf("%d,%.10g,%.10g,%.10g", nodes, length_x * a / (2 * nx), length_y * b / (2 * ny), length_z * c / 2)
        if (a == 0) {
            fixed[++holds] = nodes
        }
    }
    return number[a, b, c]
}
BEGIN {
    corners = "0 0 0 2 0 0 2 2 0 0 2 0 0 0 2 2 0 2 2 2 2 0 2 2 1 0 0 2 1 0 1 2 0 0 1 0 1 0 2 2 1 2 1 2 2 0 1 2 0 0 1 2 0 1 2 2 1 0 2 1"
    split(corners, at, " ")
    for (j = 0; j < ny; j++) {
        for (i = 0; i < nx; i++) {
            line = ++elements
            for (k = 0; k < 20; k++) {
                line = line "," (k == 10 ? "\n" : "") node(2 * i + at[3 * k + 1], 2 * j + at[3 * k + 2], at[3 * k + 3])
            }
            element[elements] = line
        }
    }
    print "*NODE,NSET=NALL"
    for (k = 1; k <= nodes; k++) {
        print place[k]
    }
    print "*ELEMENT,TYPE=C3D20,ELSET=EALL"
    for (k = 1; k <= elements; k++) {
        print element[k]
    }
    print "*NSET,NSET=FIX"
    for (k = 1; k <= holds; k++) {
        print fixed[k] ","
    }
    print "*BOUNDARY\nFIX,1,3\n*MATERIAL,NAME=STEEL\n*ELASTIC\n210000.,0.3\n*DENSITY\n7.85E-9"
    print "*SOLID SECTION,ELSET=EALL,MATERIAL=STEEL"
}
