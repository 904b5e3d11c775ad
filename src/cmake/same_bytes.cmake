# SPDX-License-Identifier: BSD-3-Clause
# Builds in two folders give the same bytes: no path of the machine is in what is built. Debug builds keep the paths of the sources,
# since debuggers look there.
include(CheckCCompilerFlag)

set(CMAKE_BUILD_RPATH_USE_ORIGIN ON)
check_c_compiler_flag("-ffile-prefix-map=/folder/=" TRIBO_HAVE_PREFIX_MAP)
if(TRIBO_HAVE_PREFIX_MAP)
  add_compile_options("$<$<AND:$<COMPILE_LANGUAGE:C>,$<NOT:$<CONFIG:Debug>>>:-ffile-prefix-map=${PROJECT_SOURCE_DIR}/=>")
endif()

# tribo_fortran_same_bytes(<variable>): replaces the Fortran sources in a list of paths by copies in the build folder. gfortran
# puts the path of a source into the library, for messages, and no option maps it: the first lines of a copy name the source alone.
function(tribo_fortran_same_bytes variable)
  if(NOT CMAKE_Fortran_COMPILER_ID STREQUAL "GNU" OR CMAKE_BUILD_TYPE STREQUAL "Debug")
    return()
  endif()
  set(files)
  foreach(source IN LISTS ${variable})
    if(source MATCHES "[^/]*\\.f90$")
      set(name "${CMAKE_MATCH_0}")
      set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${source}")
      file(READ "${source}" text)
      set(source "${CMAKE_CURRENT_BINARY_DIR}/${name}")
      file(CONFIGURE OUTPUT "${source}" CONTENT "# 1 \"@name@\"\n# 1 \"<built-in>\"\n# 1 \"@name@\"\n@text@" @ONLY)
      set_source_files_properties("${source}" PROPERTIES COMPILE_OPTIONS "-fpreprocessed;-ffree-form")
    endif()
    list(APPEND files "${source}")
  endforeach()
  set(${variable} "${files}" PARENT_SCOPE)
endfunction()
