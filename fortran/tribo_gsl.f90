! SPDX-License-Identifier: BSD-3-Clause
!> Module tribo_dynamics in a build with GSL, and the names of GSL's steppers, which drivers take beside the methods of
!> tribo_dynamics: `driver%create(system, 'rkf45')`.
!>
!> GSL is under the GPL, and so is a program that is linked with libtribo_gsl.
module tribo_gsl
  use tribo_dynamics
  use tribo_gsl_c, only: c_gsl_stepper_count, c_gsl_stepper_name
  use tribo_support, only: to_int, to_text
  implicit none
  public
  private :: c_gsl_stepper_count, c_gsl_stepper_name, to_int, to_text

contains

  !> Names of the steppers, 0 to tribo_gsl_stepper_count() - 1; empty outside.
  integer function tribo_gsl_stepper_count()
    tribo_gsl_stepper_count = int(c_gsl_stepper_count())
  end function tribo_gsl_stepper_count

  function tribo_gsl_stepper_name(stepper) result(text)
    integer, intent(in) :: stepper
    character(len=:), allocatable :: text
    call to_text(c_gsl_stepper_name(to_int(stepper)), text)
  end function tribo_gsl_stepper_name
end module tribo_gsl
