# SPDX-License-Identifier: BSD-3-Clause
# Module trb_interfaces: the interfaces of the routines TRB..., from their sources.
#   awk -f trb_interfaces.awk trb.f90 trb_dynamics.f90
# Of a routine it takes the first line, and the declarations of arguments: lines with an intent, or of a procedure.
BEGIN {
    print "! SPDX-License-Identifier: BSD-3-Clause"
    print "! Written by trb_interfaces.awk from trb.f90 and trb_dynamics.f90, not to be changed by hand: see target fortran-refresh."
    print "\n!> Interfaces of all routines TRB...: with USE TRB_INTERFACES compilers check the arguments of calls."
    print "module trb_interfaces\n  implicit none\n  public\n\n  interface"
}

/^subroutine trb/ {
    print (count++ ? "\n" : "") "    " $0
    name = $2
    sub(/\(.*/, "", name)
    next
}

name && /intent\(/ {
    sub(/real\(dp\)/, "double precision")
    print "    " $0
}

name && /^  procedure\(.*\) ::/ {
    sub(/procedure\(.*\)/, "external")
    print "    " $0
}

name && /^end subroutine/ {
    print "    " $0
    name = ""
}

END {
    print "  end interface\nend module trb_interfaces"
    if (!count) exit 1
}
