# SPDX-License-Identifier: BSD-3-Clause
# Fortran finds the indices in the library's messages by the words around them (from_one of tribo_support.f90). So every %zu of a
# format must be an index in a form that it knows, or a number that is plainly none.
file(GLOB_RECURSE files "${ROOT}/src/*.c")
list(FILTER files EXCLUDE REGEX "/src/damper/") # a program, whose messages no Fortran sees
set(count 0)
foreach(file IN LISTS files)
  file(READ "${file}" text)
  string(REPLACE ";" "," text "${text}")
  string(REGEX MATCHALL "\"[^\"\n]*%zu[^\"\n]*\"" formats "${text}")
  foreach(format IN LISTS formats)
    math(EXPR count "${count} + 1")
    set(rest "${format}")
    # indices
    string(REGEX REPLACE "\\[%zu\\]" "" rest "${rest}")
    string(REGEX REPLACE "contacts %zu, %zu" "" rest "${rest}")
    string(REGEX REPLACE "(contact|column|degree of freedom|of mode) %zu" "" rest "${rest}")
    # numbers of things (of one, too: text.h), sizes of matrices, ranks, and values of a name
    string(REGEX REPLACE "%zu (coupled |held )?[a-z]+%s( |\"|,|:)" "" rest "${rest}")
    string(REGEX REPLACE "the system has %zu" "" rest "${rest}")
    string(REGEX REPLACE "%zu x %zu" "" rest "${rest}")
    string(REGEX REPLACE "(rank|below) %zu" "" rest "${rest}")
    string(REGEX REPLACE "[a-z] = %zu" "" rest "${rest}")
    # of Fortran's own check_rows; never seen there
    string(REGEX REPLACE "^\"(rowptr|rowptr\\[0\\]|col) = %zu.*" "" rest "${rest}")
    if(rest MATCHES "%zu")
      message(SEND_ERROR "${file}: is %zu an index or not? ${format}")
    endif()
  endforeach()
endforeach()
if(count LESS 35)
  message(SEND_ERROR "only ${count} formats were found")
endif()
