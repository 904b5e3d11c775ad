! SPDX-License-Identifier: BSD-3-Clause
!> GSL's steppers: names, settings of their drivers, errors.
program steppers
  use check, only: alive, report, require, same_bits
  use tribo
  use tribo_gsl
  implicit none
  type(tribo_system) :: s
  type(tribo_driver) :: a, b
  type(tribo_context) :: c
  character(len=200) :: msg
  real(dp) :: x(3), y(3), t
  character(len=20) :: name
  integer :: i, count, stat

  call s%oscillator(0.4_dp, 1.0_dp, 0.75_dp)
  call s%context(c)
  call c%set_epsilon(0.05_dp)
  count = tribo_gsl_stepper_count()
  call require(count == 11, 'eleven steppers')
  call require(len(tribo_gsl_stepper_name(-1)) == 0, 'no name before the first')
  call require(len(tribo_gsl_stepper_name(count)) == 0, 'no name after the last')
  do i = 0, count - 1
    name = tribo_gsl_stepper_name(i)
    call require(tribo_method_name(tribo_method_count() - count + i) == name, 'steppers follow the methods')
    call a%create(s, name, abstol=1e-6_dp)
    call require(a%method() == name, 'a driver by its name')
    t = 0
    y = 0
    call a%advance(t, 1.0_dp, y)
    call require(y(3) > 0, 'friction dissipates: ' // a%method())
  end do

  ! Settings by keyword and by calls.
  x = 0
  t = 0
  call a%create(s, 'rkf45', abstol=1e-6_dp, step=0.01_dp, max_step=0.02_dp)
  call a%advance(t, 1.0_dp, x)
  y = 0
  t = 0
  call b%create(s, 'RKF45', 0.01_dp, 1e-6_dp, 0.0_dp)
  call b%set_max_step(0.02_dp)
  call b%advance(t, 1.0_dp, y)
  call require(all(same_bits(x, y)), 'the same motion')
  call require(b%method() == 'rkf45', 'letters of any case')

  call b%create(s, 'rkf45', 0.0_dp, 1e-6_dp, stat=stat, errmsg=msg)
  call expect(TRIBO_ERR_NOT_POSITIVE, 'dt = 0 is not positive')
  call b%create(s, 'rkf45', 0.1_dp, 0.0_dp, stat=stat, errmsg=msg)
  call expect(TRIBO_ERR_NOT_POSITIVE, 'abstol = 0 is not positive')
  call b%create(s, 'rkf45', 0.1_dp, 1e-6_dp, -1.0_dp, stat=stat, errmsg=msg)
  call expect(TRIBO_ERR_NEGATIVE, 'reltol = -1 is negative')
  call b%set_max_step(0.0_dp, stat, msg)
  call expect(TRIBO_ERR_NOT_POSITIVE, 'h = 0 is not positive')
  call b%set_output(0.1_dp, stat, msg)
  call expect(TRIBO_ERR_UNSUPPORTED, 'method rkf45 takes no output; exact, event and auto do')
  call b%real(TRIBO_REAL_EXCESS, t, stat, msg)
  call expect(TRIBO_ERR_UNSUPPORTED, 'method rkf45 does not bound how far the motion strays')
  call a%destroy()
  call b%destroy()
  call s%destroy()
  call require(alive() == 0, 'everything is destroyed')
  call report()

contains

  subroutine expect(status, text)
    integer, intent(in) :: status
    character(len=*), intent(in) :: text
    call require(stat == status .and. msg == text, text // ', not ' // trim(msg))
  end subroutine expect
end program steppers
