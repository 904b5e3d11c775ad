# SPDX-License-Identifier: BSD-3-Clause
# awk -v increments=N -v way=WAY -f deck.awk modes.dat: beam.inp and friction.txt in this folder. R of the contacts is the sum over
# the modes of the products of their displacements at them, since CalculiX scales modes to modal mass 1.
/E I G E N V A L U E    N U M B E R/ { mode++ }
mode && NF == 4 && ($1 == 23 || $1 == 24) { phi[mode, $1 - 22] = $4 }
END {
    cycles = 40
    limit = 5
    force = 1
    omega = 60 * atan2(0, -1)
    period = 1 / 30
    printf "2 1 %d %.17g %.17g\n", way, omega, (cycles - 1 - 0.5 / increments) * period >"friction.txt"
    for (i = 1; i <= 2; i++) {
        printf "%d 3 %g", 22 + i, limit >"friction.txt"
        for (j = 1; j <= 2; j++) {
            r = 0
            for (k = 1; k <= mode; k++) {
                r += phi[k, i] * phi[k, j]
            }
            printf " %.17g", r >"friction.txt"
        }
        printf "\n" >"friction.txt"
    }
    printf "96 3 %g\n", force >"friction.txt"
    print "*INCLUDE,INPUT=../mesh.inp\n*STEP\n*FREQUENCY,STORAGE=YES\n" mode "\n*END STEP" >"beam.inp"
    printf "*STEP,INC=%d\n*MODAL DYNAMIC\n%.15g,%.15g\n", 2 * cycles * increments, period / increments, cycles * period >"beam.inp"
    print "*MODAL DAMPING\n1," mode ",0.05\n*CLOAD,USER\n23,3\n24,3\n96,3\n*NODE FILE,FREQUENCY=10000000\nU\n*END STEP" >"beam.inp"
}
