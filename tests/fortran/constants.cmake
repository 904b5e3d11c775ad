# The constants of the Fortran sources are those of the C header, by name and value, and all of them.
#   HEADER, SOURCES   files; SOURCES may be several
#   LEAST             so many constants the header has at least
function(constants variable)
  set(all "")
  foreach(file IN LISTS ARGN)
    file(READ "${file}" text)
    string(REGEX MATCHALL "TRIBO_[A-Z_]+ = [0-9]+" found "${text}")
    list(APPEND all ${found})
  endforeach()
  list(SORT all)
  set(${variable} "${all}" PARENT_SCOPE)
endfunction()

constants(wanted "${HEADER}")
constants(found ${SOURCES})
list(LENGTH wanted count)
if(count LESS LEAST OR NOT found STREQUAL wanted)
  set(missing ${wanted})
  list(REMOVE_ITEM missing ${found})
  list(REMOVE_ITEM found ${wanted})
  message(FATAL_ERROR "${count} constants in ${HEADER}; missing in ${SOURCES}: ${missing}; there only: ${found}")
endif()
