# TRIBO_HAVE_CHOLMOD: whether sparse factors are built in. Its long integers have to be as long as size_t.
set(TRIBO_HAVE_CHOLMOD OFF)
if(TRIBO_SPARSE)
  find_path(TRIBO_CHOLMOD_INCLUDE cholmod.h PATH_SUFFIXES suitesparse)
  find_library(TRIBO_CHOLMOD_LIBRARY cholmod)
  mark_as_advanced(TRIBO_CHOLMOD_INCLUDE TRIBO_CHOLMOD_LIBRARY)
  if(TRIBO_CHOLMOD_INCLUDE AND TRIBO_CHOLMOD_LIBRARY)
    cmake_push_check_state()
    list(APPEND CMAKE_REQUIRED_INCLUDES "${TRIBO_CHOLMOD_INCLUDE}")
    list(APPEND CMAKE_REQUIRED_LIBRARIES "${TRIBO_CHOLMOD_LIBRARY}")
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
  if(TRIBO_HAVE_CHOLMOD)
    set(TRIBO_CHOLMOD_FLAG -lcholmod)
  elseif(NOT TRIBO_SPARSE STREQUAL "AUTO")
    message(FATAL_ERROR "CHOLMOD was not found: install it (Debian: libsuitesparse-dev), or configure with -DTRIBO_SPARSE=OFF")
  endif()
endif()
