# SPDX-License-Identifier: BSD-3-Clause
include(CheckCCompilerFlag)
include(CheckCSourceCompiles)
include(CheckCSourceRuns)
include(CheckLinkerFlag)
include(CMakePushCheckState)

check_linker_flag(C "LINKER:--version-script=${CMAKE_CURRENT_SOURCE_DIR}/src/core/tribo.map" TRIBO_HAVE_VERSION_SCRIPT)

# Whether functions with clones work is seen when they run: musl's loader refuses them, though they compile and link. Where a
# cross-compiled program cannot be run, whoever knows that the target can do it (glibc, FreeBSD) says so.
# Clang 14 leaves a global symbol of a fixed name for every static function with clones.
if(TRIBO_SIMD AND CMAKE_C_COMPILER_ID STREQUAL "GNU")
  if(CMAKE_CROSSCOMPILING AND NOT CMAKE_CROSSCOMPILING_EMULATOR)
    set(TRIBO_HAVE_CLONES OFF CACHE BOOL "When cross-compiling: the target's loader chooses among target_clones (ifunc)")
  endif()
  check_c_source_runs([[
    __attribute__((target_clones("avx2", "default"))) static int zero(void) { return 0; }
    int main(void) { return zero(); }]] TRIBO_HAVE_CLONES)
  check_c_source_compiles([[
    __attribute__((target_clones("arch=x86-64-v4", "avx2", "default"))) static int zero(void) { return 0; }
    int main(void) { return zero(); }]] TRIBO_HAVE_CLONES_512)
endif()

# Linking decides where the functions of math.h are, since a library of that name may be another system's (gcc -m32).
set(math [[
  #include <math.h>
  int main(int count, char **argument)
  {
      int exponent;
      const double x = count;
      (void)argument;
      return (int)(sqrt(x) + tanh(x) + log1p(x) + frexp(x, &exponent));
  }]])
check_c_source_compiles("${math}" TRIBO_MATH_IN_LIBC)
if(NOT TRIBO_MATH_IN_LIBC)
  cmake_push_check_state()
  list(APPEND CMAKE_REQUIRED_LIBRARIES m)
  check_c_source_compiles("${math}" TRIBO_MATH_IN_LIBM)
  cmake_pop_check_state()
  if(NOT TRIBO_MATH_IN_LIBM)
    message(FATAL_ERROR "No program that calls sqrt, tanh, log1p and frexp can be linked, with -lm or without; "
      "is there a C library for \"${CMAKE_C_COMPILER} ${CMAKE_C_FLAGS}\"?")
  endif()
  set(TRIBO_LIBM m)
endif()

# 32-bit x86 computes in 80 bits, and rounds when it pleases. With SSE2 results are the same bits as elsewhere.
check_c_source_compiles([[
  #include <float.h>
  #if !defined(__i386__) || FLT_EVAL_METHOD == 0
  #error
  #endif
  int main(void) { return 0; }]] TRIBO_X87)
if(TRIBO_X87)
  add_compile_options("$<$<COMPILE_LANGUAGE:C,Fortran>:-msse2;-mfpmath=sse>")
endif()

set(TRIBO_CMAKE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/tribo")
set(TRIBO_PKGCONFIG_DIR "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
set_property(GLOBAL PROPERTY TRIBO_COMPONENTS "")

# What C compilers are to find fault with. Clang takes each NAN for a float that is promoted. MinGW's headers are another matter:
# there format(printf) does not mean C99's, and isfinite begins with a conversion to float.
function(tribo_warnings target)
  target_compile_options(${target} PRIVATE
    "$<$<COMPILE_LANG_AND_ID:C,GNU,Clang,AppleClang>:-Wall;-Wextra;-Wpedantic;-Wconversion;-Wshadow>"
    "$<$<COMPILE_LANG_AND_ID:C,GNU>:-Wdouble-promotion>"
    "$<$<AND:$<COMPILE_LANG_AND_ID:C,GNU>,$<BOOL:${MINGW}>>:-Wno-format;-Wno-float-conversion>"
    "$<$<AND:$<COMPILE_LANG_AND_ID:C,GNU,Clang,AppleClang>,$<BOOL:${TRIBO_WERROR}>>:-Werror>")
endfunction()

# What all the project's libraries have in common: flags, libm, soname, symbol versions, installation, export, pkg-config.
# The caller adds what is its own by target_link_libraries, and installs its headers or modules. C and Fortran sources.
#
#   tribo_library(<target> EXPORT <name> MAP <file> DESCRIPTION <text> SOURCES <file>...
#                 [INCLUDES <folder>...] [CFLAGS <flag>...] [REQUIRES <package>...] [REQUIRES_PRIVATE <package>...]
#                 [LIBS_PRIVATE <flag>...])
#
#   <target>          is also the name of its pkg-config package
#   EXPORT            the target is tribo::<name>, in the tree and installed; <name> is its component in find_package(tribo)
#   MAP               version script with the library's symbols
#   DESCRIPTION       one line, for pkg-config
#   INCLUDES          further include folders of consumers, under the prefix (e.g. of modules)
#   CFLAGS            further flags of consumers, for pkg-config
#   REQUIRES          pkg-config packages whose headers or modules a consumer sees through those of this one
#   REQUIRES_PRIVATE  pkg-config packages that this library needs by itself
#   LIBS_PRIVATE      the same for libraries that pkg-config does not know
function(tribo_library target)
  cmake_parse_arguments(ARG "" "EXPORT;MAP;DESCRIPTION" "SOURCES;INCLUDES;CFLAGS;REQUIRES;REQUIRES_PRIVATE;LIBS_PRIVATE" ${ARGN})
  add_library(${target} ${ARG_SOURCES})
  add_library(tribo::${ARG_EXPORT} ALIAS ${target})
  # A new SOVERSION is due when a symbol goes, or what a call means changes: the major version. The installed libraries find each
  # other wherever they are moved to.
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${ARG_EXPORT} VERSION ${PROJECT_VERSION}
                                             SOVERSION ${PROJECT_VERSION_MAJOR})
  if(NOT CMAKE_INSTALL_RPATH)
    set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN")
  endif()
  target_include_directories(${target} PUBLIC
    "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>" "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR};${ARG_INCLUDES}>")
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/src")
  # Products and sums stay apart, so that every variant of a kernel gives the same bits.
  target_compile_options(${target} PRIVATE
    "$<$<COMPILE_LANG_AND_ID:C,GNU,Clang,AppleClang>:-ffp-contract=off;-fno-math-errno>")
  tribo_warnings(${target})
  get_target_property(type ${target} TYPE)
  if(WIN32 AND type STREQUAL "SHARED_LIBRARY")
    if(ARG_SOURCES MATCHES "\\.f90") # which has no words for it
      target_link_options(${target} PRIVATE "LINKER:--export-all-symbols")
    else()
      target_compile_definitions(${target} PRIVATE "TRIBO_API=__declspec(dllexport)")
    endif()
  endif()
  if(TRIBO_SIMD AND TRIBO_HAVE_CLONES)
    target_compile_definitions(${target} PRIVATE TRIBO_CLONES $<$<BOOL:${TRIBO_HAVE_CLONES_512}>:TRIBO_CLONES_512>)
  endif()
  if(TRIBO_LIBM)
    target_link_libraries(${target} PRIVATE m)
  endif()
  if(TRIBO_HAVE_VERSION_SCRIPT)
    target_link_options(${target} PRIVATE "LINKER:--version-script=${ARG_MAP}")
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS "${ARG_MAP}")
  endif()

  install(TARGETS ${target} EXPORT tribo_${ARG_EXPORT}
    RUNTIME COMPONENT runtime
    LIBRARY COMPONENT runtime NAMELINK_COMPONENT development
    ARCHIVE COMPONENT development)
  install(EXPORT tribo_${ARG_EXPORT} NAMESPACE tribo:: FILE tribo-${ARG_EXPORT}.cmake DESTINATION "${TRIBO_CMAKE_DIR}"
    COMPONENT development)
  set_property(GLOBAL APPEND PROPERTY TRIBO_COMPONENTS ${ARG_EXPORT})
  tribo_pkgconfig(${target})
endfunction()

# Writes and installs <target>.pc; part of tribo_library, whose arguments it sees. Paths are relative to the file, so that the
# installed tree may be moved.
function(tribo_pkgconfig target)
  file(RELATIVE_PATH prefix "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
  file(RELATIVE_PATH libdir "${CMAKE_INSTALL_PREFIX}" "${CMAKE_INSTALL_FULL_LIBDIR}")
  file(RELATIVE_PATH includedir "${CMAKE_INSTALL_PREFIX}" "${CMAKE_INSTALL_FULL_INCLUDEDIR}")
  set(cflags ${ARG_CFLAGS})
  foreach(folder IN LISTS ARG_INCLUDES)
    get_filename_component(folder "${folder}" ABSOLUTE BASE_DIR "${CMAKE_INSTALL_PREFIX}")
    file(RELATIVE_PATH folder "${CMAKE_INSTALL_PREFIX}" "${folder}")
    list(APPEND cflags "-I\${prefix}/${folder}")
  endforeach()
  list(JOIN cflags " " cflags)
  set(requires ${ARG_REQUIRES})
  set(requires_private ${ARG_REQUIRES_PRIVATE})
  set(libs "-L\${libdir} -l${target}")
  set(libs_private ${ARG_LIBS_PRIVATE})
  if(TRIBO_LIBM)
    list(APPEND libs_private "-lm")
  endif()
  list(JOIN libs_private " " libs_private)
  # A static library has no private needs: whoever links it links those too, with or without pkg-config --static.
  if(type STREQUAL "STATIC_LIBRARY")
    list(APPEND requires ${requires_private})
    string(APPEND libs " ${libs_private}")
    set(requires_private "")
    set(libs_private "")
  endif()
  list(JOIN requires ", " requires)
  list(JOIN requires_private ", " requires_private)
  configure_file("${PROJECT_SOURCE_DIR}/src/cmake/library.pc.in" "${CMAKE_CURRENT_BINARY_DIR}/${target}.pc" @ONLY)
  install(FILES "${CMAKE_CURRENT_BINARY_DIR}/${target}.pc" DESTINATION "${TRIBO_PKGCONFIG_DIR}" COMPONENT development)
endfunction()

# Links what no consumer of the target sees: in a shared library the installed target does not name the dependency.
function(tribo_link_privately target dependency)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "STATIC_LIBRARY")
    target_link_libraries(${target} PRIVATE ${dependency})
  else()
    target_link_libraries(${target} PRIVATE "$<BUILD_INTERFACE:${dependency}>")
  endif()
endfunction()
