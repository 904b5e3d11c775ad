# SPDX-License-Identifier: BSD-3-Clause
# awk -v contacts="NODE NODE..." -v loaded=NODE -v limit=N -v force=N -v hertz=F -v increments=N -v way=WAY
#     -f deck.awk modes.dat
# beam.inp and friction.txt in this folder, for *MODAL DYNAMIC; all forces along z. R of the contacts is
# the sum over the modes of the products of their displacements at them, since CalculiX scales modes to modal mass 1; in way 3 a stiffness
# stands in its place.
BEGIN {
    count = split(contacts, node, " ")
    for (i = 1; i <= count; i++) {
        index_of[node[i]] = i
    }
}
/E I G E N V A L U E    N U M B E R/ { mode++ }
mode && NF == 4 && ($1 in index_of) { phi[mode, index_of[$1]] = $4 }
END {
    cycles = 40
    period = 1 / hertz
    printf "%d 1 %d %.17g %.17g\n", count, way, 2 * atan2(0, -1) * hertz, (cycles - 1 - 0.5 / increments) * period >"friction.txt"
    users = loaded ",3"
    for (i = 1; i <= count; i++) {
        users = node[i] ",3\n" users
        printf "%d 3 %g", node[i], limit >"friction.txt"
        for (j = 1; j <= count; j++) {
            r = 0
            for (k = 1; k <= mode; k++) {
                r += phi[k, i] * phi[k, j]
            }
            printf " %.17g", way == 3 ? 500 : r >"friction.txt"
        }
        printf "\n" >"friction.txt"
    }
    printf "%d 3 %g\n", loaded, force >"friction.txt"
    print "*INCLUDE,INPUT=../mesh.inp\n*STEP\n*FREQUENCY,STORAGE=YES\n" mode "\n*END STEP" >"beam.inp"
    printf "*STEP,INC=%d\n*MODAL DYNAMIC\n%.15g,%.15g\n", 2 * cycles * increments, period / increments, cycles * period >"beam.inp"
    print "*MODAL DAMPING\n1," mode ",0.05" >"beam.inp"
    print "*CLOAD,USER\n" users "\n*NODE FILE,FREQUENCY=10000000\nU\n*END STEP" >"beam.inp"
}
