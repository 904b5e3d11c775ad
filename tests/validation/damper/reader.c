/* SPDX-License-Identifier: BSD-3-Clause */
/* What tribo-damper reads: Matrix Market, CalculiX's matrices, degrees of freedom and input, compressed or not; and what it
 * refuses, by file and line. Works in the current folder. */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#if defined(DAMPER_ZLIB)
#include <zlib.h>
#endif

#include "degrees.h"
#include "matrix.h"
#include "support.h"

enum { ROWS = 4, TEXT = 2000 };

static const struct rows rows = {ROWS, "other.dof"};

/* A chain of four masses, and its stiffness in both formats; entries that are zero, and in no order. */
static const double chain[ROWS][ROWS] = {
    {400.0, -200.0, 0.0, 0.0}, {-200.0, 400.0, -200.0, 0.0}, {0.0, -200.0, 400.0, -200.0}, {0.0, 0.0, -200.0, 200.0}};
static const char market[] = "%%MatrixMarket matrix coordinate real symmetric\n% N/m\n4 4 8\n4 4 200\n1 1 400\n2 1 -200\n3 1 0\n"
                             "3 3 400\n2 2 4e2\n4 3 -200\n3 2 -200.0\n",
                  calculix[] = "1 1  4.0000000000000e+02\n1 2 -2.0000000000000e+02\n2 2  4.0000000000000e+02\n"
                               "1 3  0.0000000000000e+00\n2 3 -2.0000000000000e+02\n3 3  4.0000000000000e+02\n"
                               "1 4  0.0000000000000e+00\n3 4 -2.0000000000000e+02\n4 4  2.0000000000000e+02\n",
                  dofs[] = "11.1\n12.3\n7.2\n12.1\n",
                  input[] =
                      "** a chain\n*Heading\n 1, 2, 3\n* node , nset=all\n11, 1.0\n** in between\n12,2,0.5,-1e-1,\n 7 ,3, 4\n"
                      "*ELEMENT\n11,12\n*NODE PRINT, NSET=all\nU\n*NODE FILE\n";

/* ---------------------------------------------------------------------------------------------------------------- files */

static void write_plain(const char *path, const char *bytes, size_t length)
{
    FILE *file = fopen(path, "wb");
    require(file && fwrite(bytes, 1, length, file) == length && fclose(file) == 0, "cannot write %s", path);
}

static size_t read_plain(const char *path, char *bytes)
{
    FILE *file = fopen(path, "rb");
    require(file, "there is no %s", path);
    const size_t length = fread(bytes, 1, TEXT - 1, file);
    fclose(file);
    bytes[length] = '\0';
    return length;
}

static void write_file(const char *path, const char *text)
{
#if defined(DAMPER_ZLIB)
    if (strstr(path, ".gz")) {
        gzFile file = gzopen(path, "wb");
        require(file && gzwrite(file, text, (unsigned)strlen(text)) == (int)strlen(text) && gzclose(file) == Z_OK,
                "cannot write %s", path);
        return;
    }
#endif
    write_plain(path, text, strlen(text));
}

/* -------------------------------------------------------------------------------------------------------------- refusals */

static int is_list(const char *path)
{
    return strstr(path, ".dof") || strstr(path, ".txt");
}

static void read_any(const char *path)
{
    size_t count;
    if (is_list(path)) {
        free(read_degrees(path, &count));
    } else {
        struct sparse m = read_matrix(path, &rows);
        free_sparse(&m);
    }
}

/* What ends a program that reads the file, or "" if nothing does. */
static const char *refusal(const char *path)
{
    static char text[TEXT];
    int status;
    const pid_t child = fork();
    if (child == 0) {
        if (freopen("err", "w", stderr)) {
            read_any(path);
        }
        fflush(stderr);
        _exit(0);
    }
    require(child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status), "%s: no end", path);
    read_plain("err", text);
    require((WEXITSTATUS(status) == 1) == (text[0] != '\0'), "%s: status %d, %s", path, WEXITSTATUS(status), text);
    return text;
}

/* A file of that text is refused: file and line, then what is wrong. */
static void assert_refused(const char *path, const char *text, const char *message)
{
    write_file(path, text);
    assert_says(refusal(path), message);
}

/* ----------------------------------------------------------------------------------------------------------------- tests */

static void assert_is_chain(const char *path)
{
    struct sparse m = read_matrix(path, &rows);
    require(m.first[ROWS] == 10, "%s: %zu entries", path, m.first[ROWS]);
    for (size_t i = 0; i < ROWS; i++) {
        for (size_t k = m.first[i]; k < m.first[i + 1]; k++) {
            assert_exact(m.val[k], chain[i][m.col[k]]);
            require(k == m.first[i] || m.col[k] > m.col[k - 1], "%s: columns of row %zu", path, i);
        }
    }
    free_sparse(&m);
}

static void assert_chain(const char *path, const char *text)
{
    write_file(path, text);
    assert_is_chain(path);
}

TEST(matrices)
{
    assert_chain("K.mtx", market);
    assert_chain("p.sti", calculix);
    assert_chain("p.mas", calculix);
#if defined(DAMPER_ZLIB)
    assert_chain("K.mtx.gz", market);
    assert_chain("p.sti.gz", calculix);
    write_plain("plain.mtx.gz", market, strlen(market)); /* as gunzip -f would have it */
    assert_says(refusal("plain.mtx.gz"), "");
#else
    assert_refused("K.mtx.gz", market, "without zlib");
#endif
}
END_TEST

TEST(places)
{
    static const struct degree want[ROWS] = {{{1.0, 0.0, 0.0}, 1, 1, 11, 1},
                                             {{2.0, 0.5, -0.1}, 3, 2, 12, 2},
                                             {{3.0, 4.0, 0.0}, 2, 3, 7, 3},
                                             {{2.0, 0.5, -0.1}, 1, 4, 12, 4}};
    size_t count;
    write_file("p.inp", input);
    write_file("p.dof", dofs);
    struct degree *got = read_degrees("p.dof", &count);
    require(count == ROWS, "%zu rows", count);
    for (size_t i = 0; i < ROWS; i++) {
        assert_all_exact(got[i].at, want[i].at, 3);
        require(got[i].direction == want[i].direction && got[i].row == want[i].row && got[i].node == want[i].node, "row %zu", i);
    }
    free(got);
}
END_TEST

/* Entries of a large matrix in an order that no sorting likes, each where it belongs. */
TEST(order)
{
    enum { MANY = 100003, STEP = 31607 };
    FILE *file = fopen("many.mas", "w");
    require(file, "no file");
    for (size_t k = 0, i = 0; k < MANY; k++, i = (i + STEP) % MANY) {
        fprintf(file, "%zu %zu %zu\n", i + 1, i + 1, i + 1);
        if (i > 0) {
            fprintf(file, "%zu %zu %g\n", i, i + 1, -0.5 * (double)i);
        }
    }
    fclose(file);
    struct sparse m = read_matrix("many.mas", &(struct rows){MANY, "many.dof"});
    remove("many.mas");
    require(m.first[MANY] == 3 * MANY - 2, "%zu entries", m.first[MANY]);
    for (size_t i = 0; i < MANY; i++) {
        const size_t first = m.first[i] + (i > 0);
        require(m.col[first] == i && m.val[first] == (double)(i + 1), "diagonal of row %zu", i);
        require(i == 0 || (m.col[first - 1] == i - 1 && m.val[first - 1] == -0.5 * (double)i), "row %zu", i);
        require(i + 1 == MANY || (m.col[first + 1] == i + 1 && m.val[first + 1] == -0.5 * (double)(i + 1)), "row %zu", i);
    }
    free_sparse(&m);
}
END_TEST

TEST(refusals)
{
    static const struct {
        const char *path, *text, *message;
    } bad[] = {
        {"p.sti", "1 1 1\n2 2 1\n3 3\n", "p.sti:3: the line ends before value"},
        {"p.sti", "1 1 1\n2 2 1\n5 3 1\n", "p.sti:3: row 5, but the degrees of freedom in other.dof are 4"},
        {"p.sti", "1 1 1\n2 0 1\n", "p.sti:2: column \"0\" is no whole number from 1 to 2147483647"},
        {"p.sti", "1 1 1\n2 5 1\n", "p.sti:2: column 5, but the degrees of freedom in other.dof are 4"},
        {"p.sti", "1 1 1\n2 2 nan\n", "p.sti:2: value \"nan\" is no finite number"},
        {"p.sti", "1 1 1\n2 2 1e999\n", "p.sti:2: value \"1e999\" is no finite number"},
        {"p.sti", "1 1 1\n2 2 1 7\n", "p.sti:2: \"7\" is too much"},
        {"p.sti", "1 1 1\n1 2 3\n2 2 1\n2 1 3\n3 3 1\n4 4 1\n", "p.sti:4: row 2, column 1 has been given in line 2"},
        {"p.mas", "1 1 1\n2 2 1\n4 4 1\n",
         "p.mas: row 3 of 4 has no entry on the diagonal: is the file cut off, or does it belong to other degrees of "
         "freedom than those in other.dof?"},
        {"p.mas", "", "p.mas: row 1 of 4 has no entry on the diagonal"},
        {"K.mtx", "%%MatrixMarket matrix coordinate real general\n4 4 2\n1 1 1\n", "K.mtx:3: the file ends after 1 entries of 2"},
        {"K.mtx", "%%MatrixMarket matrix coordinate real general\n4 4 1\n1 1 1\n2 2 1\n", "K.mtx:4: more entries than the 1"},
        {"K.mtx", "%%MatrixMarket matrix coordinate real general\n4 4 2\n1 2 1\n1 2 2\n",
         "K.mtx:4: row 1, column 2 has been given"},
        {"K.mtx", "%%MatrixMarket matrix coordinate real general\n5 5 1\n1 2 1\n",
         "K.mtx:2: 5 rows and 5 columns, but the degrees of freedom in other.dof are 4"},
        {"p.dof", "11.1\n12\n", "p.dof:2: expected node.direction"},
        {"p.dof", "11.1\n12.3.1\n", "p.dof:2: expected node.direction"},
        {"p.dof", "11.1\n12.4\n", "p.dof:2: direction \"4\" is no whole number from 1 to 3"},
        {"p.dof", "11.1\n12.\n", "p.dof:2: the line ends before direction"},
        {"p.dof", "11.1\n12.2\n13.1\n", "p.dof:3: node 13 has no place in p.inp"},
        {"p.dof", "", "p.dof: there is no degree of freedom"},
        {"q.dof", "1.1\n", "cannot open q.inp"},
        {"d.txt", "1 1 1 0 0 0\n3 1 1 0 0 0\n", "d.txt:2: row 3, but there is no row 2"},
    };
    write_file("p.inp", input);
    for (size_t k = 0; k < COUNT(bad); k++) {
        assert_refused(bad[k].path, bad[k].text, bad[k].message);
    }
}
END_TEST

TEST(inputs)
{
    static const struct {
        const char *text, *message;
    } bad[] = {
        {"*NODE\n11,1\n11,2\n", "p.inp:3: node 11 has been given in line 2"},
        {"*NODE\n11,1,,2\n", "p.inp:2: coordinate y is missing before"},
        {"*NODE\n11,1,2,3,4\n", "p.inp:2: \"4\" is too much"},
        {"*NODE\n11,1,x\n", "p.inp:2: coordinate y \"x\" is no finite number"},
        {"*NODE\n11,1\n*TRANSFORM, NSET=a\n1,0,0,0,1,0\n", "p.inp:3: *TRANSFORM turns directions"},
        {"*NODE\n11,1", "p.inp:2: the file ends within this line"},
        {"*NODE PRINT\n11,1\n", "p.dof:1: node 11 has no place in p.inp"},
    };
    write_file("p.dof", dofs);
    for (size_t k = 0; k < COUNT(bad); k++) {
        write_file("p.inp", bad[k].text);
        assert_says(refusal("p.dof"), bad[k].message);
    }
}
END_TEST

/* Wherever a file is cut off, it is refused. */
static void assert_no_part_of(const char *path, const char *text)
{
    char bytes[TEXT];
    write_file(path, text);
    const size_t length = read_plain(path, bytes);
    assert_exact((double)strlen(refusal(path)), 0.0);
    for (size_t part = 0; part < length; part++) {
        write_plain(path, bytes, part);
        const char *message = refusal(path);
        require(says(message, path), "%s, %zu of %zu bytes: \"%s\"", path, part, length, message);
    }
}

TEST(cut_off)
{
    assert_no_part_of("p.sti", calculix);
    assert_no_part_of("K.mtx", market);
#if defined(DAMPER_ZLIB)
    assert_no_part_of("p.mas.gz", calculix);
    assert_no_part_of("K.mtx.gz", market);
#endif
}
END_TEST

/* A compressed file of which a byte is wrong is refused, or says what it said: the last bits before its sum may mean nothing. */
TEST(damaged)
{
#if defined(DAMPER_ZLIB)
    char bytes[TEXT];
    write_file("K.mtx.gz", market);
    const size_t length = read_plain("K.mtx.gz", bytes), head = 10;
    size_t refused = 0;
    for (size_t at = head; at < length; at++) {
        bytes[at] ^= 0x10;
        write_plain("K.mtx.gz", bytes, length);
        bytes[at] ^= 0x10;
        if (says(refusal("K.mtx.gz"), "K.mtx.gz")) {
            refused++;
        } else {
            assert_is_chain("K.mtx.gz");
        }
    }
    require(refused + 1 >= length - head, "%zu of %zu", refused, length - head);
#endif
}
END_TEST

/* Members may follow each other, as gzip -c a b makes them; other bytes behind them are none of the file's. */
TEST(members)
{
#if defined(DAMPER_ZLIB)
    char bytes[TEXT];
    const size_t half = strlen(market) / 2;
    size_t length = 0;
    for (int part = 0; part < 2; part++) {
        char text[TEXT] = {0}, packed[TEXT];
        memcpy(text, market + (part ? half : 0), part ? strlen(market) - half : half);
        write_file("part.gz", text);
        const size_t more = read_plain("part.gz", packed);
        memcpy(bytes + length, packed, more);
        length += more;
    }
    write_plain("K.mtx.gz", bytes, length);
    assert_is_chain("K.mtx.gz");
    memcpy(bytes + length, "garbage", 7);
    write_plain("K.mtx.gz", bytes, length + 7);
    assert_says(refusal("K.mtx.gz"), "other bytes behind its compressed ones");
    memset(bytes + length, 0, 7);
    write_plain("K.mtx.gz", bytes, length + 7);
    assert_says(refusal("K.mtx.gz"), "other bytes behind its compressed ones");
#endif
}
END_TEST

/* Exponents as Nastran and old Fortran write them; hexadecimal digits d are digits. */
TEST(fortran_exponents)
{
    static const char written[] =
        "1 1  4.0000000000000D+02\n1 2 -2.0000000000000d+02\n2 2  4.0D2\n1 3  0.D0\n2 3 -.2D+3\n3 3  400D0\n"
        "1 4  0.0000000000000D+00\n3 4 -2.0000000000000D+02\n4 4  2.0000000000000D+02\n";
    assert_chain("p.sti", written);
    assert_refused("p.sti", "1 1 4.0D\n", "\"4.0D\" is no finite number");
    assert_refused("p.sti", "1 1 4.0D+\n", "\"4.0D+\" is no finite number");
    assert_refused("p.sti", "1 1 4.0D2D1\n", "\"4.0D2D1\" is no finite number");
    assert_refused("p.sti", "1 1 1D400\n", "\"1D400\" is no finite number");
}
END_TEST

TEST_MAIN("reader", {members, 1}, {fortran_exponents, 1}, {matrices, 1}, {places, 1}, {order, 1}, {refusals, 1}, {inputs, 1},
          {cut_off, 1}, {damaged, 1})
