! SPDX-License-Identifier: BSD-3-Clause
!> Ends by an error that no stat takes; the argument says by which. See stop.cmake.
program stop
  use tribo
  implicit none

  type(tribo_context) :: c
  character(len=20) :: which
  character(len=80) :: msg
  real(dp) :: f
  integer :: law

  call get_command_argument(1, which)
  select case (which)
  case ('no_context')
    call c%set_limit(1.0_dp)
  case ('create')
    call c%create(-1)
  case ('value')
    call c%create(2)
    call c%set_limit([1.0_dp, -2.0_dp])
  case ('size')
    call c%create(2)
    call c%set_limit([1.0_dp])
  case ('errmsg')
    call c%create(2)
    call c%set_law('quin', errmsg=msg)
  case ('law')
    call tribo_law_find('quin', law)
  case ('eval')
    call tribo_law_eval(TRIBO_QUINN, 0.0_dp, 0.0_dp, 1.0_dp, 0.0_dp, f)
  end select
  print '(a)', 'still running'
end program stop
