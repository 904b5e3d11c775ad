! SPDX-License-Identifier: BSD-3-Clause
!> A program that stops at invalid operations, divisions by zero and overflows (-ffpe-trap) runs all methods on all systems, with
!> a contact that friction cannot move (R = 0) and one that is open.
program system_traps
  use check, only: report, require
  use tribo
  use making, only: make_linear
  use tribo_dynamics
  implicit none

  integer :: i

  do i = 0, tribo_method_count() - 1
    call all_systems(tribo_method_name(i))
  end do
  call refused([real(dp) :: -1, 0, 0, 2], 'pivot -1 at degree of freedom 1')
  call refused([real(dp) :: 1, 2, 2, 1], 'pivot -3 at degree of freedom 2')
  call report()

contains

  !> A mass matrix that is not positive definite is refused with a message, as a whole and where modes are wanted.
  subroutine refused(mass, text)
    real(dp), intent(in) :: mass(4)
    character(len=*), intent(in) :: text
    real(dp), parameter :: stiffness(2, 2) = reshape([real(dp) :: 2, -1, -1, 1], [2, 2]), &
      direction(1, 2) = reshape([real(dp) :: 1, 1], [1, 2])
    type(tribo_system) :: sys
    integer :: nmode, stat
    character(len=240) :: message

    do nmode = 0, 1
      message = ''
      call make_linear(sys, reshape(mass, [2, 2]), stiffness, direction, nmode=nmode, stat=stat, errmsg=message)
      call require(stat /= TRIBO_OK .and. index(message, text) > 0, text // ': ' // trim(message))
    end do
  end subroutine refused

  subroutine all_systems(method)
    character(len=*), intent(in) :: method
    real(dp), parameter :: mass(2, 2) = reshape([real(dp) :: 1, 0, 0, 2], [2, 2]), &
      stiffness(2, 2) = reshape([real(dp) :: 2, -1, -1, 1], [2, 2]), &
      direction(3, 2) = reshape([real(dp) :: 1, -1, 0, 0, 1, 0], [3, 2])
    type(tribo_system) :: sys
    type(tribo_context) :: c
    integer, parameter :: continuous(3) = [TRIBO_VELOCITY_LIMITED, TRIBO_SMOOTH, TRIBO_QUINN]
    integer :: k, law

    do k = 1, size(continuous)
      law = continuous(k)
      call sys%oscillator(0.5_dp, 0.1_dp, 0.7_dp)
      call run(sys, method, law)
      call sys%belt(1.0_dp, 0.5_dp, 0.25_dp, 1.0_dp, 0.5_dp)
      call run(sys, method, law)
      call make_linear(sys, mass, stiffness, direction)
      call sys%add_load(1.0_dp, sine=[1.0_dp, 0.0_dp])
      call sys%context(c)
      call c%set_limit([0.5_dp, 0.0_dp, 0.25_dp])
      call run(sys, method, law)
    end do
  end subroutine all_systems

  subroutine run(sys, method, law)
    type(tribo_system), intent(inout) :: sys
    character(len=*), intent(in) :: method
    integer, intent(in) :: law
    type(tribo_context) :: c
    type(tribo_driver) :: drv
    real(dp) :: y(sys%dimension()), t
    integer :: stat
    character(len=240) :: message

    call sys%context(c)
    call c%set_law(law)
    call c%set_epsilon(1e-2_dp)
    y = 0
    t = 0
    message = ''
    call drv%create(sys, method)
    call drv%set_step(0.05_dp, stat)
    call drv%set_tolerance(1e-4_dp, 1e-4_dp, stat)
    call drv%advance(t, 2.0_dp, y, stat, message)
    call require(stat == TRIBO_OK, method // ', law ' // tribo_law_name(law) // ': ' // trim(message))
  end subroutine run
end program system_traps
