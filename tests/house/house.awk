# SPDX-License-Identifier: BSD-3-Clause
# Measures the sources that are its arguments, and prints a row a measure: name, value, largest example.
# Relies on .clang-format: a function begins at column 0, its body lies between "{" and "}" at column 0.

# Returns line without comments, strings and characters; in_comment carries over lines.
function code(line,    out, at) {
    out = ""
    while (line != "") {
        if (in_comment) {
            at = index(line, "*/")
            if (!at) {
                return out
            }
            in_comment = 0
            line = substr(line, at + 2)
        } else if (match(line, /\/\*|"([^"\\]|\\.)*"|'([^'\\]|\\.)*'/)) {
            out = out substr(line, 1, RSTART - 1) " "
            in_comment = substr(line, RSTART, 2) == "/*"
            line = substr(line, RSTART + RLENGTH)
        } else {
            out = out line
            line = ""
        }
    }
    return out
}

# Parameters of the function whose signature is text.
function parameters(text) {
    sub(/^[^(]*\(/, "", text)
    sub(/\)[^)]*$/, "", text)
    while (gsub(/\([^()]*\)/, "", text)) {
    }
    return text ~ /^ *(void)? *$/ ? 0 : gsub(/,/, ",", text) + 1
}

# The name before the first parenthesis of text.
function subject(text) {
    sub(/ *\(.*/, "", text)
    sub(/.*[^A-Za-z0-9_]/, "", text)
    return text
}

# Keeps the largest value of a row, and the name it belongs to.
function largest(row, value, what) {
    if (value > most[row] + 0) {
        most[row] = value
        example[row] = what
    }
}

# Counts the uses that the body of the function caller in this file makes of other names.
function uses(text, caller,    words, n, k) {
    gsub(/[^A-Za-z0-9_]+/, " ", text)
    n = split(text, words, " ")
    for (k = 1; k <= n; k++) {
        if (words[k] != caller) {
            in_file[words[k], FILENAME]++
            anywhere[words[k]]++
        }
    }
}

function begin_function(text) {
    name = subject(text)
    functions++
    largest("parameters", parameters(text), name)
    if (text ~ /(^|[^A-Za-z0-9_])static([^A-Za-z0-9_]|$)/) {
        static_name[++statics] = name
        static_file[statics] = FILENAME
        if (!((name, FILENAME) in own) && ++files_of[name] == 2) {
            shared++
            example["names"] = name
        }
        own[name, FILENAME] = 1
    }
}

FNR == 1 {
    in_comment = in_body = depth = 0
    signature = ""
    split("", known)
}

{
    lines++
    tool += FILENAME ~ /^src\/damper\//
    text = code($0)
    for (k = 1; k <= nfeature; k++) {
        if (!known[k] && tolower(text) ~ feature[k]) {
            known[k] = 1
            knows[k]++
        }
    }
}

/^#include "/ {
    from = FILENAME
    to = $2
    gsub(/"/, "", to)
    if (to ~ /\//) {
        sub(/^src\//, "", from)
        sub(/\/[^\/]*$/, "", from)
        sub(/\/[^\/]*$/, "", to)
        # a room and its sub-rooms are one: core/context.h is made of theirs, and their sources use it
        if (from != to && index(from "/", to "/") != 1 && index(to "/", from "/") != 1) {
            arrow[from, to] = 1
        }
    }
}

/^#/ { next }

# a structure's members: declarators at any depth within its braces
in_struct {
    plain = text
    while (gsub(/\([^()]*\)/, "", plain)) {
    }
    gsub(/\[[^\]]*\]/, "", plain)
    members += gsub(/[;,]/, "&", plain)
    depth += gsub(/{/, "{", plain) - gsub(/}/, "}", plain)
    if (depth == 0) {
        largest("members", members - (text ~ /;/), in_struct)
        in_struct = ""
    }
    next
}

!in_body && text ~ /^(typedef )?struct [a-z0-9_]* *{/ {
    in_struct = $0
    sub(/ *{.*/, "", in_struct)
    sub(/.* /, "", in_struct)
    depth = 1
    members = 0
    next
}

in_body && text ~ /^}/ {
    largest("longest", length_of_body, name)
    uses(body, name)
    in_body = 0
    next
}

in_body {
    body = body " " text
    length_of_body++
    next
}

text ~ /^{/ && signature ~ /\(/ {
    begin_function(signature)
    in_body = 1
    body = signature = ""
    length_of_body = 0
    next
}

text ~ /;/ || text ~ /^[ \t]*$/ {
    # a table of functions may call each of its entries from anywhere: each counts twice
    if (signature text !~ /\)[^=]*;/ || signature text ~ /=/) {
        uses(signature " " text " " signature " " text, "")
    }
    if (text ~ /;/) {
        signature = ""
    }
    next
}

{ signature = signature " " text }

# Counts the rooms in circles: removes, until none is removed, rooms with no arrow in or no arrow out.
function circles(    pair, room, from, to, out, into, gone, left) {
    for (pair in arrow) {
        split(pair, room, SUBSEP)
        node[room[1]] = node[room[2]] = 1
    }
    do {
        gone = 0
        for (from in node) {
            out = into = 0
            for (to in node) {
                out += (from, to) in arrow
                into += (to, from) in arrow
            }
            if (!out || !into) {
                delete node[from]
                gone = 1
            }
        }
    } while (gone)
    left = 0
    for (from in node) {
        left++
        example["circle"] = example["circle"] " " from
    }
    return left
}

BEGIN {
    nfeature = split("planar _static|static_|breakaway elastic massless|complian", feature, " ")
    split("planar contacts/static limits/elastic contacts/compliance of contacts", name_of, "/")
}

END {
    for (k = 1; k <= statics; k++) {
        count = static_file[k] ~ /\.h$/ ? anywhere[static_name[k]] : in_file[static_name[k], static_file[k]]
        single += count <= 1
    }
    printf "lines of src\t%d\n", lines
    printf "lines of src without the tool\t%d\n", lines - tool
    printf "functions\t%d\n", functions
    printf "static functions with one caller, of 1000 functions\t%d\n", 1000 * single / functions
    printf "lines of the longest function\t%d\t%s\n", most["longest"], example["longest"]
    printf "parameters of a function\t%d\t%s\n", most["parameters"], example["parameters"]
    printf "members of a struct\t%d\t%s\n", most["members"], example["members"]
    printf "static names in more than one file\t%d\t%s\n", shared, example["names"]
    printf "rooms in a circle\t%d\t%s\n", circles(), example["circle"]
    for (k = 1; k <= nfeature; k++) {
        printf "files that know %s\t%d\n", name_of[k], knows[k]
    }
}
