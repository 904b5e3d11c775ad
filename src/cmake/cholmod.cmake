# SPDX-License-Identifier: BSD-3-Clause
# tribo::cholmod, if CHOLMOD is there: SuiteSparse's own target, or what is found by names. Also read by an installed triboConfig.
if(NOT TARGET tribo::cholmod)
  find_package(CHOLMOD CONFIG QUIET)
  if(TARGET SuiteSparse::CHOLMOD)
    add_library(tribo::cholmod INTERFACE IMPORTED)
    set_target_properties(tribo::cholmod PROPERTIES INTERFACE_LINK_LIBRARIES SuiteSparse::CHOLMOD)
  else()
    find_path(TRIBO_CHOLMOD_INCLUDE cholmod.h PATH_SUFFIXES suitesparse)
    find_library(TRIBO_CHOLMOD_LIBRARY cholmod)
    mark_as_advanced(TRIBO_CHOLMOD_INCLUDE TRIBO_CHOLMOD_LIBRARY)
    if(TRIBO_CHOLMOD_INCLUDE AND TRIBO_CHOLMOD_LIBRARY)
      add_library(tribo::cholmod INTERFACE IMPORTED)
      set_target_properties(tribo::cholmod PROPERTIES INTERFACE_LINK_LIBRARIES "${TRIBO_CHOLMOD_LIBRARY}"
        INTERFACE_INCLUDE_DIRECTORIES "${TRIBO_CHOLMOD_INCLUDE}")
    endif()
  endif()
endif()
