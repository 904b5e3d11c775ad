# SPDX-License-Identifier: BSD-3-Clause
# The manual page of tribo-damper, from its --help:
#   cmake -D TOOL=<tribo-damper> -D MANUAL=<file> -P manual.cmake
# Lines stay as they are; those without indentation that end in a colon, after a blank one, become headings.
execute_process(COMMAND "${TOOL}" --help OUTPUT_VARIABLE text RESULT_VARIABLE status)
execute_process(COMMAND "${TOOL}" --version OUTPUT_VARIABLE version OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
if(status OR failed)
  message(FATAL_ERROR "${TOOL} does not print its help and version: ${status} ${failed}")
endif()
string(REGEX REPLACE "^tribo-damper: ([^\n]*)\\.\n" "" text "${text}")
set(purpose "${CMAKE_MATCH_1}")
string(REPLACE "\\" "\\e" text "${text}")
string(REPLACE "-" "\\-" text "${text}")
string(REGEX REPLACE "\n([.'])" "\n\\\\&\\1" text "${text}")
string(REGEX REPLACE "\n\n([A-Z][^\n]*):\n" "\n.fi\n.SH \"\\1\"\n.nf\n" text "${text}")
string(REPLACE "-" "\\-" purpose "${purpose}")
file(WRITE "${MANUAL}" ".TH TRIBO\\-DAMPER 1 \"\" \"${version}\" \"User Commands\"
.SH NAME
tribo\\-damper \\- ${purpose}
.SH SYNOPSIS
.nf
tribo\\-damper \\-\\-mass FILE \\-\\-stiffness FILE \\-\\-dofs FILE \\-\\-load PLACE \\-\\-contact CONTACT [OPTION VALUE]...
tribo\\-damper \\-\\-read FILE [OPTION VALUE]...
.fi
.SH DESCRIPTION
.nf
${text}.fi
")
