# Compares the interfaces that Fortran sources give to C functions, bind(c, name=...), with the functions' prototypes: number and order
# of arguments, their types, values or addresses, what is only read, and what is returned.
#   awk -v least=<n> -f signatures.awk <prototypes.c>... <source.f90>...
# fails if one differs, or fewer than n were compared. An argument that may be NULL is type(c_ptr) by value in Fortran, whatever
# it points to.

function trim(s) { gsub(/^[ \t]+|[ \t]+$/, "", s); return s }

# A C declaration of an argument or function as one word: int, double*, const double*, void**, callback ...
function c_type(text, stars, constant) {
    if (text ~ /\(\*/) return "callback"
    stars = gsub(/\*/, " ", text)
    constant = text ~ /(^|[ ])const[ ]/
    gsub(/TRIBO_API|const/, " ", text)
    text = trim(text)
    if (text == "void" && !stars) return "void"
    sub(/[ ]+[A-Za-z_0-9]+$/, "", text)
    text = trim(text)
    if (text ~ /^(tribo_|gsl_)/ || text == "void") { text = "void"; constant = 0 }
    return (constant && stars ? "const " : "") text substr("****", 1, stars)
}

# Arguments of a C function, at commas outside of parentheses.
function c_arguments(name, text,    i, depth, start, c, n, one) {
    depth = 0; start = 1; n = 0
    for (i = 1; i <= length(text) + 1; i++) {
        c = substr(text, i, 1)
        if (c == "(") depth++
        if (c == ")") depth--
        if ((c == "," && depth == 0) || i > length(text)) {
            one = trim(substr(text, start, i - start))
            if (one != "" && one != "void") argument[name, ++n] = c_type(one)
            start = i + 1
        }
    }
    arguments[name] = n
}

function read_prototype(text,    open, head, name) {
    open = index(text, "(")
    head = substr(text, 1, open - 1)
    name = head
    sub(/^.*[ *]/, "", name)
    sub(/\)[ ]*;.*$/, "", text)
    c_arguments(name, substr(text, open + 1))
    returned[name] = c_type(head)
}

# A Fortran declaration as the same words: address of a type, or value.
function fortran_type(spec,    base, constant) {
    if (spec ~ /^type\(c_ptr\)/) return spec ~ /value/ ? "pointer" : "void**"
    if (spec ~ /^type\(c_funptr\)/) return "callback"
    base = spec ~ /^real\(c_double\)/ ? "double" : spec ~ /^integer\(c_int\)/ ? "int" : spec ~ /^integer\(c_size_t\)/ ? "size_t" : \
           spec ~ /^integer\(c_signed_char\)/ ? "signed char" : spec ~ /^character/ ? "char" : "other"
    if (spec ~ /value/) return base
    constant = spec ~ /intent\(in\)/ ? "const " : ""
    return constant base "*"
}

function fits(fortran, c) {
    if (fortran == "pointer") return c ~ /\*$/ && c !~ /\*\*/
    return fortran == c
}

function complain(name, text) { print FILENAME ": " name ": " text; wrong++ }

function compare(name,    k, list, n, of) {
    if (!(name in arguments)) {
        if (name ~ /^tribo_/ && name !~ /^tribo_(fortran|handle)_/) complain(name, "is no function of the headers")
        return
    }
    compared++
    n = split(dummies, list, /[ ]*,[ ]*/)
    if (trim(dummies) == "") n = 0
    if (n != arguments[name]) { complain(name, n " arguments, not " arguments[name]); return }
    for (k = 1; k <= n; k++) {
        of = declared[tolower(trim(list[k]))]
        if (!fits(of, argument[name, k])) complain(name, trim(list[k]) " is " of ", not " argument[name, k])
    }
    of = result == "" ? "void" : declared[tolower(result)]
    if (of == "void**") of = returned[name] ~ /\*$/ ? returned[name] : of
    if (result != "" && of ~ /\*$/ && returned[name] !~ /\*$/) sub(/\*$/, "", of)
    if (of != returned[name]) complain(name, "returns " of ", not " returned[name])
}

FNR == 1 { text = ""; inside = 0 }

FILENAME ~ /\.c$/ {
    if ($0 ~ /^TRIBO_API/) text = ""
    if ($0 ~ /^(TRIBO_API| )/) {
        text = text " " trim($0)
        if ($0 ~ /;[ ]*$/) { read_prototype(text); text = "" }
    }
    next
}

# A statement, its continuations joined.
{
    line = $0
    sub(/[ \t]*!.*$/, "", line)
    text = text " " trim(line)
    if (text ~ /&[ ]*$/) { sub(/&[ ]*$/, "", text); next }
    statement = trim(text)
    text = ""
}

statement ~ /bind\(c, *name=/ {
    inside = 1
    name = statement; sub(/^.*bind\(c, *name='/, "", name); sub(/'.*$/, "", name)
    dummies = statement; sub(/^[^(]*\(/, "", dummies); sub(/\).*$/, "", dummies)
    result = ""
    if (statement ~ /result\(/) { result = statement; sub(/^.*result\(/, "", result); sub(/\).*$/, "", result) }
    split("", declared)
    next
}

inside && statement ~ /::/ && statement !~ /^import/ {
    spec = statement; sub(/[ ]*::.*$/, "", spec)
    names = statement; sub(/^.*::[ ]*/, "", names)
    gsub(/\([^)]*\)/, "", names)
    n = split(names, list, /[ ]*,[ ]*/)
    for (k = 1; k <= n; k++) declared[tolower(trim(list[k]))] = fortran_type(spec)
}

inside && statement ~ /^end (function|subroutine)/ { inside = 0; compare(name) }

END {
    if (compared < least) { print compared " interfaces compared, not " least; wrong++ }
    exit wrong > 0
}
