/* SPDX-License-Identifier: BSD-3-Clause */
/* The strings of files, for builds without libFuzzer. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int main(int argc, char **argv)
{
    static uint8_t data[1 << 16];
    for (int k = 1; k < argc; k++) {
        FILE *file = fopen(argv[k], "rb");
        if (!file) {
            fprintf(stderr, "cannot open %s\n", argv[k]);
            return EXIT_FAILURE;
        }
        const size_t size = fread(data, 1, sizeof data, file);
        fclose(file);
        fprintf(stderr, "%s\n", argv[k]);
        LLVMFuzzerTestOneInput(data, size);
    }
    return argc > 1 ? EXIT_SUCCESS : EXIT_FAILURE;
}
