# SPDX-License-Identifier: BSD-3-Clause
include(CheckLinkerFlag)
include(CheckSymbolExists)
include(CMakePushCheckState)

# traps.c sets traps for floating-point exceptions where that can be done.
cmake_push_check_state()
set(CMAKE_REQUIRED_DEFINITIONS -D_GNU_SOURCE)
set(CMAKE_REQUIRED_LIBRARIES m)
check_symbol_exists(feenableexcept fenv.h TRIBO_HAVE_FEENABLEEXCEPT)
cmake_pop_check_state()

# tribo_test(<label> <room>/<suite> [<file or library>...]): the suite <label>/<suite>, from <room>/<suite>.c and other parts.
function(tribo_test label name)
  get_filename_component(suite "${name}" NAME)
  set(target test_${label}_${suite})
  add_executable(${target} ${name}.c "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/support.c")
  foreach(part IN LISTS ARGN)
    if(part MATCHES "\\.c$|TARGET_OBJECTS")
      target_sources(${target} PRIVATE "${part}")
      if(part MATCHES "traps\\.c$" AND TRIBO_HAVE_FEENABLEEXCEPT)
        target_compile_definitions(${target} PRIVATE TRIBO_HAVE_FEENABLEEXCEPT _GNU_SOURCE)
      endif()
    else()
      target_link_libraries(${target} PRIVATE "${part}")
    endif()
  endforeach()
  if("tribo_gsl" IN_LIST ARGN OR ARGN MATCHES "TARGET_OBJECTS:tribo_gsl")
    target_sources(${target} PRIVATE "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/make.c")
  endif()
  target_include_directories(${target} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}" "${CMAKE_CURRENT_FUNCTION_LIST_DIR}"
    "${PROJECT_SOURCE_DIR}/include")
  target_link_libraries(${target} PRIVATE PkgConfig::CHECK ${TRIBO_LIBM})
  tribo_warnings(${target})
  add_test(NAME ${label}/${suite} COMMAND ${target})
  set_tests_properties(${label}/${suite} PROPERTIES LABELS ${label})
endfunction()

# tribo_test_memory(<label> <name> <library> [...]): the same with the library's objects linked in, and its allocations counted
# and made to fail (unit/memory.h), where the linker can do that.
check_linker_flag(C "LINKER:--wrap=tribo_nothing" TRIBO_HAVE_WRAP)
function(tribo_test_memory label name library)
  if(TRIBO_HAVE_WRAP)
    tribo_test(${label} ${name} "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/unit/memory.c" "$<TARGET_OBJECTS:${library}>" ${ARGN})
    get_filename_component(suite "${name}" NAME)
    target_include_directories(test_${label}_${suite} PRIVATE "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/unit")
    target_link_options(test_${label}_${suite} PRIVATE
      "LINKER:--wrap=malloc" "LINKER:--wrap=calloc" "LINKER:--wrap=realloc" "LINKER:--wrap=free")
  endif()
endfunction()
