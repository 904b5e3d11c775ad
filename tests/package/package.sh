#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# One step of the package's tests; CMakeLists.txt beside it sets the environment. $WORK belongs to one kind of build:
#   build      the project
#   prefix     where it is installed to
#   elsewhere  where that is moved to then, since an installed tree should work from anywhere
set -eu
unset DESTDIR MAKEFLAGS LD_LIBRARY_PATH PKG_CONFIG_PATH
here=$(dirname "$0")
step=$1
shift

say() { # what fails, for people
    echo "$step: $*" >&2
}

# build <folder> <cmake option>...: the project, configured as if for the first time, in a folder whose objects are used again.
build() {
    folder=$1
    shift
    rm -rf "$folder/CMakeCache.txt" "$folder/CMakeFiles"
    "$CMAKE" -S "$ROOT" -B "$folder" "$@"
    "$CMAKE" --build "$folder" --parallel 2
}

# consume <folder> <cmake option>...: builds the consumers in $WORK/<folder> and runs them.
consume() {
    folder=$WORK/$1
    shift
    rm -rf "$folder"
    "$CMAKE" -S "$here/consumer" -B "$folder" "$@"
    "$CMAKE" --build "$folder" --parallel 2
    for program in "$folder"/*.run; do
        "$program"
    done
}

# bits <folder> <cmake option>...: builds the core and the consumer bits.c without a warning; what that prints is in
# <folder>/bits.
bits() {
    folder=$1
    shift
    rm -rf "$folder"
    "$CMAKE" -S "$here/consumer" -B "$folder" -DTRIBO_SOURCE="$ROOT" -DBUILD_SHARED_LIBS=ON -DCMAKE_BUILD_TYPE=Release \
        -DTRIBO_WERROR=ON -DCONSUMERS="bits.c C tribo" "$@"
    "$CMAKE" --build "$folder" --parallel 2
    if [ -e "$folder/bits.c.run" ]; then
        "$folder/bits.c.run" >"$folder/bits"
    else
        command -v wine || exit 77
        export WINEPATH="$folder/tribo/src" WINEPREFIX="$folder/wine" WINEDEBUG=-all
        wine "$folder/bits.c.run.exe" | tr -d '\r' >"$folder/bits"
    fi
    [ -s "$folder/bits" ]
}

# compile <source> <language> <output> <flag>...: strictly, since headers must not bring warnings into other people's code.
compile() {
    source=$here/consumer/$1 language=$2 output=$3
    shift 3
    strict="-Wall -Wextra -pedantic -Werror"
    case $language in
    C) "$CC" -std=c99 $strict "$source" -o "$output" "$@" ;;
    C90) "$CC" -std=c90 $strict "$source" -o "$output" "$@" -lm ;;
    CXX) "${CXX:-c++}" -std=c++98 $strict "$source" -o "$output" "$@" ;;
    Fortran) "$FC" $strict "$source" -o "$output" "$@" ;;
    esac
}

# page <page>: writes its programs, a block in C to user.c, one in Fortran to user.f if it begins in column 7, else to user.f90; its
# CMake to user.cmake, and its lines for the shell to lines.
page() {
    awk 'BEGIN { name["c"] = "user.c"; name["cmake"] = "user.cmake"; name["sh"] = "lines" }
         /^```/ { kind = substr($0, 4); on = !on; first = on; next }
         first { file = kind != "fortran" ? name[kind] : /^      / ? "user.f" : "user.f90"; first = 0
                 if (file && !(file in seen)) printf "" > file
                 seen[file] = 1 }
         on && file { print > file }' "$ROOT/$1"
}

# line <file> <beginning>: runs the one line of the file that begins so, as it stands there.
line() {
    [ "$(grep -c -e "^$2" "$1")" = 1 ] || {
        say "not one line begins with: $2"
        exit 1
    }
    eval "$(grep -e "^$2" "$1")"
}

# rests <command>...: the program's answer is that of the pages.
rests() {
    "$@" | tr -s ' ' >out
    grep -q '^rests at -0\.0200 m, held by -2\.00[0-9] N$' out || {
        cat out
        say "the result is another one"
        exit 1
    }
}

# follow <folder>: compiles and runs the programs in README.md and fortran/README.md by the lines beside them, as they stand there
# but for the folder that stands for any, and the version of the compiler. $searched stands before compilers of fixed form.
searched=
follow() {
    modules=$(basename "$1"/include/tribo/gfortran-*[0-9])
    for page in fortran/README.md README.md; do
        page $page
        sed -n -e "s,/opt/tribo,$1,g" -e "s,tribo/gfortran-12,tribo/$modules,g" -e "/ -ltribo/s,^gfortran ,$searched &," \
            -e '/^cc /p' -e '/^\(LIBRARY_PATH=[^ ]* \| \)*gfortran /p' lines | sed 's/# .*//' | sort -u >compile.lines
        while read -r compile; do
            rm -f a.out
            eval "$compile"
            rests ./a.out
        done <compile.lines
        [ "$(wc -l <compile.lines)" -ge 3 ] || {
            say "$page: too few lines compile something"
            exit 1
        }
    done
    # the program for a whole structure
    cp user.c rest.c
    cp user.cmake rest.cmake
    page src/dynamics/README.md
    eval "cc user.c -o structure $(pkg-config --cflags --libs tribo_dynamics)"
    ./structure >out
    grep -q '^between -0\.11634 and 0\.11634 m; friction takes 0\.38536 J a period$' out || {
        cat out
        say "the steady response is another one"
        exit 1
    }
    mv rest.c user.c
    mv rest.cmake user.cmake
    printf '%s\n' 'cmake_minimum_required(VERSION 3.22)' 'project(user C Fortran)' 'add_executable(user user.c)' >CMakeLists.user
    rm -rf user
    mkdir user
    cat CMakeLists.user user.cmake >user/CMakeLists.txt
    cp user.c user
    "$CMAKE" -S user -B user/build
    "$CMAKE" --build user/build
    rests user/build/user
}

case $step in
install) # <cmake option>...
    rm -rf "$WORK/prefix" "$WORK/elsewhere"
    build "$WORK/build" "$@" -DCMAKE_INSTALL_PREFIX="$WORK/prefix" -DCMAKE_INSTALL_LIBDIR=lib
    "$CMAKE" --install "$WORK/build"
    mv "$WORK/prefix" "$WORK/elsewhere"
    ;;

copy) # <build folder>: the same of the build that these tests are part of. What it was installed to before is not forgotten.
    rm -rf "$WORK/prefix" "$WORK/elsewhere"
    mkdir -p "$WORK"
    ln -sfn "$1" "$WORK/build"
    manifest=$1/install_manifest.txt
    [ ! -e "$manifest" ] || mv "$manifest" "$WORK/manifest.before"
    "$CMAKE" --install "$1" --prefix "$WORK/prefix"
    mv "$manifest" "$WORK/manifest"
    [ ! -e "$WORK/manifest.before" ] || mv "$WORK/manifest.before" "$manifest"
    mv "$WORK/prefix" "$WORK/elsewhere"
    ;;

components) # Each component alone holds what its name says; the three together are the whole.
    out=$WORK/components
    rm -rf "$out"
    for component in runtime development tool; do
        "$CMAKE" --install "$WORK/build" --prefix "$out/$component" --component $component
        (cd "$out/$component" && find . ! -type d ! -name LICENSE | sort) >"$out/$component.list"
        [ -f "$out/$component/share/doc/tribo/LICENSE" ] || {
            say "$component comes without LICENSE"
            exit 1
        }
    done
    (cd "$WORK/elsewhere" && find . ! -type d ! -name LICENSE | sort) >"$out/whole.list"
    sort "$out/runtime.list" "$out/development.list" "$out/tool.list" | diff "$out/whole.list" -
    if grep -v '^\./lib/libtribo[a-z0-9_]*\.so\.[0-9.]*$' "$out/runtime.list" || grep '\.so\.' "$out/development.list"; then
        say "not of this component"
        exit 1
    fi
    cp -a "$out/runtime/lib" "$out/tool"
    [ ! -e "$out/tool/bin" ] || "$out/tool/bin/tribo-damper" --version
    ;;

again) # The tree as git archives it, in another folder, passes its tests and installs the same bytes. The objects are new.
    again=$WORK/again/in/another/folder
    rm -rf "$WORK/again"
    mkdir -p "$again"
    if [ -e "$ROOT/.git" ]; then
        tree=$(git -C "$ROOT" stash create) # what is not committed yet; empty if there is nothing
        git -C "$ROOT" archive "${tree:-HEAD}" | tar -xf - -C "$again"
    else
        tar --exclude=./build -cf - -C "$ROOT" . | tar -xf - -C "$again"
    fi
    cd "$again"
    export CCACHE_DISABLE=1
    sh tests/run.sh --no-install -L '^(house|unit|fortran|example|abi)$'
    "$CMAKE" --install build/release --prefix "$WORK/again/prefix"
    diff -r "$WORK/elsewhere" "$WORK/again/prefix"
    rm -rf "$WORK/again"
    ;;

row) # <preset>
    cd "$ROOT"
    rm -rf "build/$1/CMakeCache.txt" "build/$1/CMakeFiles"
    "$CMAKE" --preset "$1"
    "$CMAKE" --build --preset "$1" --parallel 2
    if "$CTEST" --list-presets | grep -q "\"$1\""; then
        "$CTEST" --preset "$1" --parallel 2
    fi
    ;;

blas) # <preset> <build folder> <libtribo_dynamics>: the preset's tests, listed in a folder of their own, since ctest writes there.
    case $1 in openblas) folder=/openblas ;; *) folder=/blas/ ;; esac
    if ldd "$3" | awk '/libblas\.so/ { print $3 }' | xargs readlink -f | grep -q "$folder"; then
        echo "This is the machine's own: the suites run with it anyway."
        exit
    fi
    paths=$(sed -n "/\"name\": \"$1\"/,/}/s/.*\"LD_LIBRARY_PATH\": \"\([^\"]*\)\".*/\1/p" "$ROOT/CMakePresets.json")
    export LD_LIBRARY_PATH="$paths" OPENBLAS_NUM_THREADS=1
    ldd "$3" | grep -E "lib(blas|lapack)\.so" >"$WORK.libraries" || true
    grep -q "$folder" "$WORK.libraries" || {
        cat "$WORK.libraries"
        say "this LAPACK is not there (Debian: libopenblas0-pthread, liblapack3)"
        exit 1
    }
    rm -rf "$WORK"
    mkdir -p "$WORK"
    for room in unit validation; do
        printf 'subdirs("%s/tests/%s")\n' "$2" $room
    done >"$WORK/CTestTestfile.cmake"
    "$CTEST" --test-dir "$WORK" --parallel 2 --output-on-failure --no-tests=error -L '^(unit|validation)$' -LE '^(long|slow)$'
    ;;

find_package) # <source> <language> <component> [OPTIONAL_COMPONENTS <component>...]
    consume "find_package-$1" -DCMAKE_PREFIX_PATH="$WORK/elsewhere" -DCONSUMERS="$*"
    ;;

pkgconfig) # <source> <language> <component>
    case $3 in tribo) package=tribo ;; *) package=tribo_$3 ;; esac
    export PKG_CONFIG_PATH="$WORK/elsewhere/lib/pkgconfig"
    pkg-config --print-errors --exists "$package >= 1.0" "$package < 2.0"
    program=$WORK/pkgconfig-$1
    # As distributions link: what the program does not call itself must be found by the library that does.
    set -- "$1" "$2" "$program" -Wl,--as-needed -Wl,-rpath,"$WORK/elsewhere/lib"
    eval "compile \"\$@\" $(pkg-config --cflags --libs "$package")" # since pkg-config escapes blanks in paths
    "$program"
    ;;

tool) # The tool runs where it was installed to, and finds the libraries and its beam there.
    tool=$WORK/elsewhere/bin/tribo-damper out=$WORK/tool
    rm -rf "$out"
    mkdir -p "$out"
    "$tool" --help | grep -q -e '--contacts FILE'
    "$tool" --version | grep -q '^tribo-damper [0-9]'
    grep -q 'contacts FILE' "$WORK/elsewhere/share/man/man1/tribo-damper.1"
    "$tool" --read "$WORK/elsewhere/share/tribo/beam/beam.txt" --limits 0.02 --out "$out"
    grep -q '^damper.free 11\.456' "$out/values-damper.txt"
    ;;

pages) # usual | elsewhere: installs as README.md says, into /usr/local as root or elsewhere, and follows the pages. The rest of
    # the environment is bare, as a newcomer's.
    mkdir -p "$WORK/clone"
    cd "$WORK/clone"
    for entry in "$ROOT"/*; do
        [ "${entry##*/}" = build ] || ln -sfn "$entry" .
    done
    page README.md
    grep '^cmake' lines >install.lines
    CMAKE_BUILD_PARALLEL_LEVEL=2 line install.lines 'cmake -S'
    case $1 in
    usual)
        unshare --map-root-user --mount true || exit 77
        unshare --map-root-user --mount sh "$0" root
        ;;
    elsewhere)
        export HOME="$WORK/home"
        line install.lines 'cmake --install build --prefix'
        line lines export
        searched=$(sed -n 's/^\(LIBRARY_PATH=[^ ]*\) gfortran .*/\1/p' lines)
        follow "$HOME/tribo"
        ;;
    esac
    ;;

root) # The part of "pages usual" that is root's: in a name space of its own, where what it writes vanishes with it.
    cd "$WORK/clone"
    mkdir -p layers
    mount -t tmpfs tmpfs layers || exit 77
    for folder in /usr/local /opt /etc /var/cache; do
        mkdir -p "layers$folder/upper" "layers$folder/work"
        mount -t overlay overlay -o "lowerdir=$folder,upperdir=layers$folder/upper,workdir=layers$folder/work" $folder || exit 77
    done
    line install.lines 'cmake --install build &&'
    "$CMAKE" --install build --prefix /opt/tribo >/dev/null # as the page for Fortran has it
    follow /opt/tribo
    ;;

subdirectory) # <cmake option>... <consumer>...
    consumers=
    for argument; do
        shift
        case $argument in
        -*) set -- "$@" "$argument" ;;
        *) consumers="$consumers;$argument" ;;
        esac
    done
    consume subdirectory -DTRIBO_SOURCE="$ROOT" -DCONSUMERS="${consumers#;}" "$@"
    ;;

foreign) # "<compiler> <flag>..." <cmake option>...: the core for another machine or C library gives the same bits as here.
    # Skipped where the compiler, or what runs its programs, is missing.
    compiler=${1%% *} flags=${1#"${1%% *}"}
    shift
    mkdir -p "$WORK"
    echo 'int main(void) { return 0; }' >"$WORK/probe.c"
    $compiler $flags "$WORK/probe.c" -o "$WORK/probe" || exit 77
    bits "$WORK/here"
    bits "$WORK/there" -DCMAKE_C_COMPILER="$compiler" -DCMAKE_C_FLAGS="$flags" "$@"
    cmp "$WORK/here/bits" "$WORK/there/bits" || {
        say "the results differ"
        exit 1
    }
    ;;

refused) # <name> <message> -S <folder> <cmake option>...
    folder=$WORK/refused-$1 message=$2
    shift 2
    rm -rf "$folder"
    if "$CMAKE" -B "$folder" -DCMAKE_PREFIX_PATH="$WORK/elsewhere" "$@" >"$folder.log" 2>&1; then
        say "this was accepted: $*"
        exit 1
    fi
    # CMake breaks its messages into lines as it likes.
    tr -s ' \n' '  ' <"$folder.log" | grep -qF "$message" || {
        cat "$folder.log"
        say "the message is not: $message"
        exit 1
    }
    ;;

archives) # A static library's names land in the program of its user.
    if nm -g --defined-only "$WORK"/elsewhere/lib/*.a |
        awk 'NF == 3 && $3 !~ /^(tribo_|trb[a-z0-9]*_$|__tribo[a-z_]*_MOD_)/ { print; bad = 1 } END { exit !bad }'; then
        say "names that may be the user's own"
        exit 1
    fi
    ;;

needs) # The core needs a C compiler, libc and libm.
    if grep -E '^CMAKE_(CXX|Fortran)_COMPILER:|^GSL_|^PKG_CONFIG_EXECUTABLE' "$WORK/build/CMakeCache.txt"; then
        say "more than a C compiler was looked for"
        exit 1
    fi
    if grep -rn 'include.*gsl' "$ROOT/src/core" "$ROOT/src/numerics/box" "$ROOT/src/numerics/disc" "$ROOT/src/common" "$ROOT/include/tribo/tribo.h"; then
        say "the core includes GSL"
        exit 1
    fi
    if objdump -p "$WORK/elsewhere/lib/libtribo.so" | awk '$1 == "NEEDED" { print $2 }' | grep -Ev '^lib[cm]\.'; then
        say "libtribo needs more than libc and libm"
        exit 1
    fi
    ;;

uninstall)
    mv "$WORK/elsewhere" "$WORK/prefix"
    if [ -e "$WORK/manifest" ]; then
        "$CMAKE" -D MANIFEST="$WORK/manifest" -P "$ROOT/src/cmake/uninstall.cmake"
    else
        "$CMAKE" --build "$WORK/build" --target uninstall
    fi
    if find "$WORK/prefix" ! -type d -o -name 'tribo*' | grep .; then
        say "this was left behind"
        exit 1
    fi
    ;;
esac
