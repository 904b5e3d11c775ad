! SPDX-License-Identifier: BSD-3-Clause
! Written by interface.awk from the headers of C, and not to be changed by hand: see target fortran-refresh.

!> The functions of C, see interface.awk. Not for programs.
module tribo_gsl_c
  use, intrinsic :: iso_c_binding
  implicit none
  public

  interface
    function c_gsl_model_set_mass(model, m) result(answer) bind(c,name='tribo_gsl_model_set_mass')
      import
      type(c_ptr), value :: model
      type(c_ptr), value :: m
      integer(c_int) :: answer
    end function c_gsl_model_set_mass

    function c_gsl_model_set_damping(model, c) result(answer) bind(c,name='tribo_gsl_model_set_damping')
      import
      type(c_ptr), value :: model
      type(c_ptr), value :: c
      integer(c_int) :: answer
    end function c_gsl_model_set_damping

    function c_gsl_model_set_stiffness(model, k) result(answer) bind(c,name='tribo_gsl_model_set_stiffness')
      import
      type(c_ptr), value :: model
      type(c_ptr), value :: k
      integer(c_int) :: answer
    end function c_gsl_model_set_stiffness

    function c_gsl_model_set_direction(model, j) result(answer) bind(c,name='tribo_gsl_model_set_direction')
      import
      type(c_ptr), value :: model
      type(c_ptr), value :: j
      integer(c_int) :: answer
    end function c_gsl_model_set_direction

    function c_gsl_driver_create(drv, sys, stepper) result(answer) bind(c,name='tribo_gsl_driver_create')
      import
      type(c_ptr), intent(inout) :: drv
      type(c_ptr), value :: sys
      character(kind=c_char), intent(in), optional :: stepper(*)
      integer(c_int) :: answer
    end function c_gsl_driver_create

    function c_gsl_stepper_count() result(answer) bind(c,name='tribo_gsl_stepper_count')
      import
      integer(c_int) :: answer
    end function c_gsl_stepper_count

    function c_gsl_stepper_name(stepper) result(answer) bind(c,name='tribo_gsl_stepper_name')
      import
      integer(c_int), value :: stepper
      type(c_ptr) :: answer
    end function c_gsl_stepper_name

    function c_gsl_system(sys) result(answer) bind(c,name='tribo_gsl_system')
      import
      type(c_ptr), value :: sys
      type(c_ptr) :: answer
    end function c_gsl_system
  end interface
end module tribo_gsl_c
