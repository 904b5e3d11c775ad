# SPDX-License-Identifier: BSD-3-Clause
# TRIBO_HAVE_CHOLMOD: 1 if sparse factors are built in. CHOLMOD's long integers have to be as long as size_t.
set(TRIBO_HAVE_CHOLMOD OFF)
if(TRIBO_SPARSE)
  include("${CMAKE_CURRENT_LIST_DIR}/cholmod.cmake")
  if(TARGET tribo::cholmod)
    cmake_push_check_state()
    list(APPEND CMAKE_REQUIRED_LIBRARIES tribo::cholmod)
    check_c_source_compiles([[
      #include <cholmod.h>
      int main(void)
      {
          char as_long[sizeof(SuiteSparse_long) == sizeof(size_t) ? 1 : -1] = {0};
          cholmod_common common;
          return cholmod_l_start(&common) + cholmod_l_finish(&common) + as_long[0];
      }]] TRIBO_CHOLMOD_WORKS)
    cmake_pop_check_state()
    set(TRIBO_HAVE_CHOLMOD "${TRIBO_CHOLMOD_WORKS}")
  endif()
  if(NOT TRIBO_HAVE_CHOLMOD)
    message(FATAL_ERROR "CHOLMOD was not found: install it (Debian: libsuitesparse-dev), or configure with -DTRIBO_SPARSE=OFF")
  endif()
  set(TRIBO_CHOLMOD_FLAG -lcholmod)
endif()
