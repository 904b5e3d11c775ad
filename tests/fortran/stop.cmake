# SPDX-License-Identifier: BSD-3-Clause
# The program must end with a status other than 0, TEXT on stderr and nothing on stdout.
execute_process(COMMAND "${PROGRAM}" "${WHICH}" RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE err)
string(FIND "${err}" "tribo: ${TEXT}\n" place)
if(status EQUAL 0 OR place EQUAL -1 OR NOT out STREQUAL "")
  message(FATAL_ERROR "status ${status}, stdout \"${out}\", stderr \"${err}\", should hold \"${TEXT}\"")
endif()
