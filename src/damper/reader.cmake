# SPDX-License-Identifier: BSD-3-Clause
# damper_reader(<target>): adds the readers of matrices and degrees of freedom; of compressed files if zlib is there.
find_package(ZLIB QUIET)
set(damper_folder "${CMAKE_CURRENT_LIST_DIR}")
function(damper_reader target)
  foreach(file source text matrix degrees output)
    target_sources(${target} PRIVATE "${damper_folder}/${file}.c")
  endforeach()
  target_include_directories(${target} PRIVATE "${damper_folder}")
  if(ZLIB_FOUND)
    target_link_libraries(${target} PRIVATE ZLIB::ZLIB)
    target_compile_definitions(${target} PRIVATE DAMPER_ZLIB)
  endif()
endfunction()
