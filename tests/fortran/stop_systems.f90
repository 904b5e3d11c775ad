! SPDX-License-Identifier: BSD-3-Clause
!> Ends by an error that no stat takes; the argument says by which. See stop.cmake.
program stop_systems
  use tribo
  use tribo_dynamics
  implicit none

  type(tribo_system) :: s, other_system
  type(tribo_driver) :: d, other_driver
  type(tribo_sparse) :: m
  character(len=20) :: which
  real(dp) :: t, y(3)

  call s%oscillator(0.1_dp, 1.0_dp, 1.0_dp)
  call d%create(s, 'exact')
  call get_command_argument(1, which)
  select case (which)
  case ('system')
    other_system = s
  case ('driver')
    other_driver = d
  case ('no_system')
    call other_driver%create(other_system, 'exact')
  case ('advance')
    t = 1
    y = 0
    call d%advance(t, 0.0_dp, y)
  case ('sparse')
    call m%set_coo(1, 1, [1], [2], [1.0_dp])
  end select
  print '(a)', 'still running'
end program stop_systems
