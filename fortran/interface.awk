# SPDX-License-Identifier: BSD-3-Clause
# Fortran interfaces of the functions of C headers, and their constants:
#   awk -v name=<name> -f interface.awk <header>...
# writes a module <name>_constants with the enumerators, if the headers have any, and a module <name>_c with an interface block for
# each function. It reads what follows TRIBO_API to the semicolon, and enumerations whose numbers are given; a type that it does not
# know is an error.
#
# tribo_get_limit is c_get_limit in Fortran. Of its arguments
#   double, int, size_t ...    are values
#   const double *, char * ... are optional arrays, NULL where absent; the header has those that may be NULL
#   double *                   too; where it is one output, that must be an element of an array
#   int *, size_t *            are one output
#   tribo_context ** ...       are one output, the address of an object
# and all other addresses are type(c_ptr). Outputs are intent(inout), so that a compiler does not copy back a section that the call
# has not written. TRIBO_PURE before the type, a macro without text, makes a pure function.

function trim(s) { gsub(/^[ \t]+|[ \t]+$/, "", s); return s }

function fail(text) { print FILENAME ": " text > "/dev/stderr"; failed = 1; exit 1 }

# The Fortran type of a value or an element.
function kind(type) {
    if (!(type in kinds)) fail("no Fortran type is known for " type)
    return kinds[type]
}

# The declaration of an argument, and its name in the list of arguments.
function declare(text,    constant, stars, type, argument) {
    if (text ~ /\(\*/) {
        sub(/^.*\(\*/, "", text); sub(/\).*$/, "", text)
        list = list ", " text
        return "type(c_funptr), value :: " text
    }
    constant = text ~ /const /
    sub(/const /, "", text)
    stars = gsub(/\*/, " ", text)
    argument = type = trim(text)
    sub(/^.* /, "", argument)
    sub(/ +[^ ]*$/, "", type)
    list = list ", " argument
    if (type ~ /^(struct |tribo_|gsl_|void$)/) return "type(c_ptr), " (stars == 2 ? "intent(inout)" : "value") " :: " argument
    if (!stars) return kind(type) ", value :: " argument
    if (!constant && type ~ /^(int|size_t)$/) return kind(type) ", intent(inout) :: " argument
    return kind(type) ", intent(" (constant ? "in" : "inout") "), optional :: " argument "(*)"
}

# Divides arguments at the commas outside of parentheses.
function divide(text, parts,    i, c, depth, n) {
    n = 1
    parts[1] = ""
    for (i = 1; i <= length(text); i++) {
        c = substr(text, i, 1)
        depth += (c == "(") - (c == ")")
        if (c == "," && !depth) parts[++n] = ""
        else parts[n] = parts[n] c
    }
    return text == "void" ? 0 : n
}

# A line, continued where it grows long.
function put(text,    cut) {
    while (length(text) > 126) {
        cut = 120
        while (substr(text, cut, 1) != " ") cut--
        functions = functions substr(text, 1, cut) "&\n"
        text = "      " substr(text, cut + 1)
    }
    functions = functions text "\n"
}

function read_function(text,    open, head, symbol, pure, i, n, parts, lines, what, result) {
    sub(/\);$/, "", text)
    open = index(text, "(")
    head = trim(substr(text, 1, open - 1))
    pure = sub(/^TRIBO_PURE /, "", head) ? "pure " : ""
    symbol = head
    sub(/^.*[ *]/, "", symbol)
    head = trim(substr(head, 1, length(head) - length(symbol)))
    sub(/const /, "", head)
    what = head == "void" ? "subroutine" : "function"
    result = head ~ /\*$/ ? "type(c_ptr)" : what == "function" ? kind(head) : ""
    list = lines = ""
    n = divide(substr(text, open + 1), parts)
    for (i = 1; i <= n; i++) lines = lines "\n      " declare(trim(parts[i]))
    if (pure) gsub(/, value/, ", intent(in), value", lines)
    fortran = symbol
    sub(/^tribo_/, "c_", fortran)
    put("    " pure what " " fortran "(" substr(list, 3) ")" (result ? " result(answer)" : "") " bind(c,name='" symbol "')")
    functions = functions "      import" lines "\n" (result ? "      " result " :: answer\n" : "")
    functions = functions "    end " what " " fortran "\n\n"
}

# Enumerators of a line, below its comment.
function read_constants(line,    comment) {
    comment = line
    if (!sub(/^.*\/\* /, "  !> ", comment)) comment = ""
    sub(/ *\*\/$/, "", comment)
    if (comment) comment = comment "\n"
    sub(/\/\*.*/, "", line)
    while (match(line, /TRIBO_[A-Z0-9_]+ = -?[0-9]+/)) {
        constants = constants comment "  integer, parameter, public :: " substr(line, RSTART, RLENGTH) "\n"
        comment = ""
        line = substr(line, 1, RSTART - 1) substr(line, RSTART + RLENGTH)
    }
    if (line ~ /TRIBO_/) fail("a constant without a number: " line)
}

BEGIN {
    kinds["double"] = "real(c_double)"
    kinds["int"] = "integer(c_int)"
    kinds["size_t"] = "integer(c_size_t)"
    kinds["int64_t"] = "integer(c_int64_t)"
    kinds["uint32_t"] = "integer(c_int32_t)"
    kinds["signed char"] = "integer(c_signed_char)"
    kinds["char"] = "character(kind=c_char)"
}

/^enum \{/ { enumeration = 1 }
enumeration { read_constants($0) }
enumeration && /\};/ { enumeration = 0; constants = constants "\n" }

/^TRIBO_API / { prototype = ""; inside = 1; $0 = substr($0, 11) }
inside { prototype = prototype " " trim($0) }
inside && /;$/ { inside = 0; read_function(trim(prototype)) }

END {
    if (failed) exit 1
    if (!functions) fail("no functions")
    gsub(/\n\n$/, "\n", constants)
    gsub(/\n\n$/, "\n", functions)
    print "! SPDX-License-Identifier: BSD-3-Clause"
    print "! Written by interface.awk from the headers of C, and not to be changed by hand: see target fortran-refresh."
    if (constants) {
        print "\n!> The constants, as in C.\nmodule " name "_constants\n  implicit none\n  private\n"
        printf "%send module %s_constants\n", constants, name
    }
    print "\n!> The functions of C, see interface.awk. Not for programs.\nmodule " name "_c"
    print "  use, intrinsic :: iso_c_binding\n  implicit none\n  public\n\n  interface"
    printf "%s  end interface\nend module %s_c\n", functions, name
}
