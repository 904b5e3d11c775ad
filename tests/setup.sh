# SPDX-License-Identifier: BSD-3-Clause
# For the run scripts, which source it. POSIX sh.
#   setup <Debian package>...   returns when what the packages bring is there. Installs the missing ones where it may (as root, or
#                               by sudo without a password), else says what to install and ends the script with status 1.
#                               With setup_install=no it installs nothing, and ends with the list of what is missing.
setup_install=yes

# A tool counts wherever it comes from; dpkg is asked about what is none, or not found.
setup_has() {
    case $1 in
    libc6-dev) echo '#include <math.h>' | gcc -E - ;;
    liblapack-dev) echo 'int main(void) { return 0; }' | gcc -x c -o /dev/null - -llapack -lblas ;;
    libgsl-dev) pkg-config --exists 'gsl >= 2.7' ;;
    libsuitesparse-dev) echo '#include <suitesparse/cholmod.h>' | gcc -E - ;;
    zlib1g-dev) echo '#include <zlib.h>' | gcc -E - ;;
    check) pkg-config --exists check ;;
    gnuplot-nox) command -v gnuplot ;;
    petsc-dev | libpetsc-real-dev) pkg-config --exists 'PETSc >= 3.18' ;;
    mpi-default-dev) command -v mpicc ;;
    mpi-default-bin) command -v mpiexec ;;
    libclang-rt-dev) echo 'int main(void) { return 0; }' | clang -fsanitize=address -x c -o /dev/null - ;;
    gcc-multilib) echo 'int main(void) { return 0; }' | gcc -m32 -x c -o /dev/null - ;;
    musl-tools) command -v musl-gcc ;;
    gcc-mingw-w64-x86-64) command -v x86_64-w64-mingw32-gcc ;;
    abigail-tools) command -v abidw && command -v abidiff ;;
    libopenblas0-pthread) ls /usr/lib/*/openblas-pthread/liblapack.so.3 ;;
    *) command -v "$1" ;;
    esac >/dev/null 2>&1 || dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null | grep -qx installed
}

setup_missing() {
    for setup_package; do
        setup_has "$setup_package" || printf '%s ' "$setup_package"
    done
}

setup_stop() {
    printf '%s\n' "$@" >&2
    exit 1
}

# OpenBLAS installed beside another BLAS does not become the machine's default: what is chosen by priority stays chosen.
setup_keep_blas() {
    update-alternatives --get-selections | awk '$1 ~ /^lib(blas|lapack)\.so/ && $2 == "auto" { print $1, $3 }' |
        while read -r setup_name setup_value; do
            $setup_sudo update-alternatives --set "$setup_name" "$setup_value" </dev/null
        done
}

setup_bring() {
    setup_line="apt-get install -y --no-install-recommends $*"
    [ "$setup_install" = yes ] || setup_stop "Missing (the names are Debian's): $*"
    command -v apt-get >/dev/null || setup_stop "Please install first (the names are Debian's): $*"
    if [ "$(id -u)" = 0 ]; then
        setup_sudo=
    elif sudo -n true 2>/dev/null; then
        setup_sudo=sudo
    else
        setup_stop "Some packages are missing. Please run, as root:" "    $setup_line"
    fi
    echo "== Installing $*"
    $setup_sudo apt-get update || echo "== The package lists could not be updated, going on with those that are here"
    case " $* " in *" libopenblas"*) setup_keep_blas ;; esac
    $setup_sudo env DEBIAN_FRONTEND=noninteractive $setup_line || setup_stop "This failed: $setup_line"
    setup_list=$(setup_missing "$@")
    [ -z "$setup_list" ] || setup_stop "Installed, but not found or too old: $setup_list"
}

setup() {
    setup_list=$(setup_missing "$@")
    [ -z "$setup_list" ] || setup_bring $setup_list
}
