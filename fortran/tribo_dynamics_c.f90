! SPDX-License-Identifier: BSD-3-Clause
! Written by interface.awk from the headers of C, and not to be changed by hand: see target fortran-refresh.

!> The constants, as in C.
module tribo_dynamics_constants
  implicit none
  private

  !> sparse factors: systems of many degrees of freedom with a mass matrix that is not diagonal
  integer, parameter, public :: TRIBO_FEATURE_CHOLMOD = 0

  integer, parameter, public :: TRIBO_STATICS_NONE = 0
  integer, parameter, public :: TRIBO_STATICS_MASS = 1
  integer, parameter, public :: TRIBO_STATICS_COMPLIANCE = 2

  !> limits, and coefficients of friction of tribo_model_set_normal
  integer, parameter, public :: TRIBO_FLUTTER_FRICTION = 0
  !> velocities of bases
  integer, parameter, public :: TRIBO_FLUTTER_SPEED = 1

  !> end of a step, output, end of an advance, or an event without a change of a contact
  integer, parameter, public :: TRIBO_MOMENT_STEP = 0
  !> a contact comes to rest
  integer, parameter, public :: TRIBO_MOMENT_STICK = 1
  !> a contact breaks away
  integer, parameter, public :: TRIBO_MOMENT_SLIP = 2
  !> the direction of sliding turns without rest
  integer, parameter, public :: TRIBO_MOMENT_REVERSE = 3
  !> the limit falls to 0
  integer, parameter, public :: TRIBO_MOMENT_LIFT = 4
  !> the limit rises from 0
  integer, parameter, public :: TRIBO_MOMENT_TOUCH = 5

  !> the limit of contact `index`
  integer, parameter, public :: TRIBO_PARAMETER_LIMIT = 0
  !> a factor of all loads and base motions, at 1
  integer, parameter, public :: TRIBO_PARAMETER_LOADS = 1
  !> a factor of all frequencies, at 1; base motions keep their displacements
  integer, parameter, public :: TRIBO_PARAMETER_FREQUENCY = 2
  !> a factor of the damping matrix, at 1
  integer, parameter, public :: TRIBO_PARAMETER_DAMPING = 3
  !> curves: a factor of all limits, at 1; none may follow a normal load
  integer, parameter, public :: TRIBO_PARAMETER_LIMITS = 4
  !> curves: the amplitude of a nonlinear mode
  integer, parameter, public :: TRIBO_PARAMETER_AMPLITUDE = 5
  !> curves: a factor of the loads and base motions that change in time, at 1
  integer, parameter, public :: TRIBO_PARAMETER_SWING = 6
  !> curves: a factor of all base motions, at 1
  integer, parameter, public :: TRIBO_PARAMETER_BASES = 7

  !> of tribo_driver_find_periodic
  integer, parameter, public :: TRIBO_MOTION_PERIODIC = 0
  !> of tribo_driver_find_cycle
  integer, parameter, public :: TRIBO_MOTION_CYCLE = 1
  !> of tribo_driver_find_mode
  integer, parameter, public :: TRIBO_MOTION_MODE = 2

  integer, parameter, public :: TRIBO_POINT_REGULAR = 0
  !> the curve turns back: a multiplier 1, or a change of the sequence of events of `contact`
  integer, parameter, public :: TRIBO_POINT_FOLD = 1
  !> a multiplier -1: motions of twice the period begin
  integer, parameter, public :: TRIBO_POINT_FLIP = 2
  !> a complex pair of multipliers of modulus 1 (Neimark-Sacker)
  integer, parameter, public :: TRIBO_POINT_TORUS = 3
  !> a multiplier 1, and the curve goes on: another curve crosses, as where symmetry is lost
  integer, parameter, public :: TRIBO_POINT_BRANCH = 4
  !> `contact` begins to stick, once more a period
  integer, parameter, public :: TRIBO_POINT_STICK = 5
  !> `contact` ceases to stick, once more a period
  integer, parameter, public :: TRIBO_POINT_SLIDE = 6
  !> `contact` begins or ceases to touch, to lift off or to reverse
  integer, parameter, public :: TRIBO_POINT_GRAZE = 7
  !> events of several contacts change their order
  integer, parameter, public :: TRIBO_POINT_ORDER = 8
  !> a cycle shrinks to a state of rest (Hopf); the curve ends there
  integer, parameter, public :: TRIBO_POINT_REST = 9

  !> accepted steps
  integer, parameter, public :: TRIBO_COUNT_STEPS = 100
  !> rejected steps
  integer, parameter, public :: TRIBO_COUNT_REJECTED = 101
  !> evaluations of the right-hand side
  integer, parameter, public :: TRIBO_COUNT_EVALUATIONS = 102
  !> evaluations of the Jacobian of the right-hand side
  integer, parameter, public :: TRIBO_COUNT_JACOBIANS = 103
  !> events located
  integer, parameter, public :: TRIBO_COUNT_EVENTS = 104
  !> periods integrated by tribo_driver_find_periodic, rounded up for each search
  integer, parameter, public :: TRIBO_COUNT_PERIODS = 105
  !> Newton steps of tribo_driver_find_periodic
  integer, parameter, public :: TRIBO_COUNT_NEWTON = 106
  !> degrees of freedom at rest that steps skipped
  integer, parameter, public :: TRIBO_COUNT_RESTED = 107

  !> the largest force of a contact at rest beyond its limit
  integer, parameter, public :: TRIBO_REAL_EXCESS = 100
  !> the largest velocity of a sliding contact against its direction of sliding
  integer, parameter, public :: TRIBO_REAL_BACKSLIP = 101
end module tribo_dynamics_constants

!> The functions of C, see interface.awk. Not for programs.
module tribo_dynamics_c
  use, intrinsic :: iso_c_binding
  implicit none
  public

  interface
    function c_model_create(model, ndof, ncontact) result(answer) bind(c,name='tribo_model_create')
      import
      type(c_ptr), intent(inout) :: model
      integer(c_size_t), value :: ndof
      integer(c_size_t), value :: ncontact
      integer(c_int) :: answer
    end function c_model_create

    subroutine c_model_destroy(model) bind(c,name='tribo_model_destroy')
      import
      type(c_ptr), value :: model
    end subroutine c_model_destroy

    function c_model_message(model) result(answer) bind(c,name='tribo_model_message')
      import
      type(c_ptr), value :: model
      type(c_ptr) :: answer
    end function c_model_message

    function c_model_set_mass(model, m) result(answer) bind(c,name='tribo_model_set_mass')
      import
      type(c_ptr), value :: model
      real(c_double), intent(in), optional :: m(*)
      integer(c_int) :: answer
    end function c_model_set_mass

    function c_model_set_mass_diagonal(model, m) result(answer) bind(c,name='tribo_model_set_mass_diagonal')
      import
      type(c_ptr), value :: model
      real(c_double), intent(in), optional :: m(*)
      integer(c_int) :: answer
    end function c_model_set_mass_diagonal

    function c_model_set_mass_csr(model, rowptr, col, val) result(answer) bind(c,name='tribo_model_set_mass_csr')
      import
      type(c_ptr), value :: model
      integer(c_size_t), intent(in), optional :: rowptr(*)
      integer(c_size_t), intent(in), optional :: col(*)
      real(c_double), intent(in), optional :: val(*)
      integer(c_int) :: answer
    end function c_model_set_mass_csr

    function c_model_set_damping(model, c) result(answer) bind(c,name='tribo_model_set_damping')
      import
      type(c_ptr), value :: model
      real(c_double), intent(in), optional :: c(*)
      integer(c_int) :: answer
    end function c_model_set_damping

    function c_model_set_damping_diagonal(model, c) result(answer) bind(c,name='tribo_model_set_damping_diagonal')
      import
      type(c_ptr), value :: model
      real(c_double), intent(in), optional :: c(*)
      integer(c_int) :: answer
    end function c_model_set_damping_diagonal

    function c_model_set_damping_csr(model, rowptr, col, val) result(answer) bind(c,name='tribo_model_set_damping_csr')
      import
      type(c_ptr), value :: model
      integer(c_size_t), intent(in), optional :: rowptr(*)
      integer(c_size_t), intent(in), optional :: col(*)
      real(c_double), intent(in), optional :: val(*)
      integer(c_int) :: answer
    end function c_model_set_damping_csr

    function c_model_set_stiffness(model, k) result(answer) bind(c,name='tribo_model_set_stiffness')
      import
      type(c_ptr), value :: model
      real(c_double), intent(in), optional :: k(*)
      integer(c_int) :: answer
    end function c_model_set_stiffness

    function c_model_set_stiffness_diagonal(model, k) result(answer) bind(c,name='tribo_model_set_stiffness_diagonal')
      import
      type(c_ptr), value :: model
      real(c_double), intent(in), optional :: k(*)
      integer(c_int) :: answer
    end function c_model_set_stiffness_diagonal

    function c_model_set_stiffness_csr(model, rowptr, col, val) result(answer) bind(c,name='tribo_model_set_stiffness_csr')
      import
      type(c_ptr), value :: model
      integer(c_size_t), intent(in), optional :: rowptr(*)
      integer(c_size_t), intent(in), optional :: col(*)
      real(c_double), intent(in), optional :: val(*)
      integer(c_int) :: answer
    end function c_model_set_stiffness_csr

    function c_model_set_direction(model, j) result(answer) bind(c,name='tribo_model_set_direction')
      import
      type(c_ptr), value :: model
      real(c_double), intent(in), optional :: j(*)
      integer(c_int) :: answer
    end function c_model_set_direction

    function c_model_set_direction_csr(model, rowptr, col, val) result(answer) bind(c,name='tribo_model_set_direction_csr')
      import
      type(c_ptr), value :: model
      integer(c_size_t), intent(in), optional :: rowptr(*)
      integer(c_size_t), intent(in), optional :: col(*)
      real(c_double), intent(in), optional :: val(*)
      integer(c_int) :: answer
    end function c_model_set_direction_csr

    function c_model_set_compliance(model, c) result(answer) bind(c,name='tribo_model_set_compliance')
      import
      type(c_ptr), value :: model
      real(c_double), intent(in), optional :: c(*)
      integer(c_int) :: answer
    end function c_model_set_compliance

    function c_model_set_normal(model, contact, normal, mu, stiffness, gap) result(answer) &
      bind(c,name='tribo_model_set_normal')
      import
      type(c_ptr), value :: model
      integer(c_size_t), value :: contact
      integer(c_size_t), value :: normal
      real(c_double), value :: mu
      real(c_double), value :: stiffness
      real(c_double), value :: gap
      integer(c_int) :: answer
    end function c_model_set_normal

    function c_model_ndof(model) result(answer) bind(c,name='tribo_model_ndof')
      import
      type(c_ptr), value :: model
      integer(c_size_t) :: answer
    end function c_model_ndof

    function c_model_ncontact(model) result(answer) bind(c,name='tribo_model_ncontact')
      import
      type(c_ptr), value :: model
      integer(c_size_t) :: answer
    end function c_model_ncontact

    function c_model_refuse(model, status, message) result(answer) bind(c,name='tribo_model_refuse')
      import
      type(c_ptr), value :: model
      integer(c_int), value :: status
      character(kind=c_char), intent(in), optional :: message(*)
      integer(c_int) :: answer
    end function c_model_refuse

    function c_dynamics_has(feature) result(answer) bind(c,name='tribo_dynamics_has')
      import
      integer(c_int), value :: feature
      integer(c_int) :: answer
    end function c_dynamics_has

    function c_model_set_ring(model, sector, sectors) result(answer) bind(c,name='tribo_model_set_ring')
      import
      type(c_ptr), value :: model
      type(c_ptr), value :: sector
      integer(c_size_t), value :: sectors
      integer(c_int) :: answer
    end function c_model_set_ring

    function c_system_create(sys, model) result(answer) bind(c,name='tribo_system_create')
      import
      type(c_ptr), intent(inout) :: sys
      type(c_ptr), value :: model
      integer(c_int) :: answer
    end function c_system_create

    function c_system_reduce(sys, model, nmode, static_contacts) result(answer) bind(c,name='tribo_system_reduce')
      import
      type(c_ptr), intent(inout) :: sys
      type(c_ptr), value :: model
      integer(c_size_t), value :: nmode
      integer(c_int), value :: static_contacts
      integer(c_int) :: answer
    end function c_system_reduce

    function c_system_reduce_to(sys, model, omega, tolerance, static_contacts) result(answer) &
      bind(c,name='tribo_system_reduce_to')
      import
      type(c_ptr), intent(inout) :: sys
      type(c_ptr), value :: model
      real(c_double), value :: omega
      real(c_double), value :: tolerance
      integer(c_int), value :: static_contacts
      integer(c_int) :: answer
    end function c_system_reduce_to

    function c_system_oscillator(sys, limit, alpha, omega) result(answer) bind(c,name='tribo_system_oscillator')
      import
      type(c_ptr), intent(inout) :: sys
      real(c_double), value :: limit
      real(c_double), value :: alpha
      real(c_double), value :: omega
      integer(c_int) :: answer
    end function c_system_oscillator

    function c_system_chain(sys, n, limit, alpha, omega) result(answer) bind(c,name='tribo_system_chain')
      import
      type(c_ptr), intent(inout) :: sys
      integer(c_size_t), value :: n
      real(c_double), value :: limit
      real(c_double), value :: alpha
      real(c_double), value :: omega
      integer(c_int) :: answer
    end function c_system_chain

    function c_system_belt(sys, kappa, limit1, limit2, speed, omega) result(answer) bind(c,name='tribo_system_belt')
      import
      type(c_ptr), intent(inout) :: sys
      real(c_double), value :: kappa
      real(c_double), value :: limit1
      real(c_double), value :: limit2
      real(c_double), value :: speed
      real(c_double), value :: omega
      integer(c_int) :: answer
    end function c_system_belt

    subroutine c_system_destroy(sys) bind(c,name='tribo_system_destroy')
      import
      type(c_ptr), value :: sys
    end subroutine c_system_destroy

    function c_system_clone(sys, copy) result(answer) bind(c,name='tribo_system_clone')
      import
      type(c_ptr), value :: sys
      type(c_ptr), intent(inout) :: copy
      integer(c_int) :: answer
    end function c_system_clone

    function c_system_add_load(sys, omega, cosine, sine) result(answer) bind(c,name='tribo_system_add_load')
      import
      type(c_ptr), value :: sys
      real(c_double), value :: omega
      real(c_double), intent(in), optional :: cosine(*)
      real(c_double), intent(in), optional :: sine(*)
      integer(c_int) :: answer
    end function c_system_add_load

    function c_system_clear_loads(sys) result(answer) bind(c,name='tribo_system_clear_loads')
      import
      type(c_ptr), value :: sys
      integer(c_int) :: answer
    end function c_system_clear_loads

    function c_system_add_base_motion(sys, omega, cosine, sine) result(answer) bind(c,name='tribo_system_add_base_motion')
      import
      type(c_ptr), value :: sys
      real(c_double), value :: omega
      real(c_double), intent(in), optional :: cosine(*)
      real(c_double), intent(in), optional :: sine(*)
      integer(c_int) :: answer
    end function c_system_add_base_motion

    function c_system_add_load_table(sys, knots, time, value, pattern) result(answer) &
      bind(c,name='tribo_system_add_load_table')
      import
      type(c_ptr), value :: sys
      integer(c_size_t), value :: knots
      real(c_double), intent(in), optional :: time(*)
      real(c_double), intent(in), optional :: value(*)
      real(c_double), intent(in), optional :: pattern(*)
      integer(c_int) :: answer
    end function c_system_add_load_table

    function c_system_add_base_table(sys, knots, time, value, pattern) result(answer) &
      bind(c,name='tribo_system_add_base_table')
      import
      type(c_ptr), value :: sys
      integer(c_size_t), value :: knots
      real(c_double), intent(in), optional :: time(*)
      real(c_double), intent(in), optional :: value(*)
      real(c_double), intent(in), optional :: pattern(*)
      integer(c_int) :: answer
    end function c_system_add_base_table

    function c_system_clear_base_motion(sys) result(answer) bind(c,name='tribo_system_clear_base_motion')
      import
      type(c_ptr), value :: sys
      integer(c_int) :: answer
    end function c_system_clear_base_motion

    function c_system_add_limit(sys, omega, cosine, sine) result(answer) bind(c,name='tribo_system_add_limit')
      import
      type(c_ptr), value :: sys
      real(c_double), value :: omega
      real(c_double), intent(in), optional :: cosine(*)
      real(c_double), intent(in), optional :: sine(*)
      integer(c_int) :: answer
    end function c_system_add_limit

    function c_system_set_limit_table(sys, knots, time, limit) result(answer) bind(c,name='tribo_system_set_limit_table')
      import
      type(c_ptr), value :: sys
      integer(c_size_t), value :: knots
      real(c_double), intent(in), optional :: time(*)
      real(c_double), intent(in), optional :: limit(*)
      integer(c_int) :: answer
    end function c_system_set_limit_table

    function c_system_clear_limits(sys) result(answer) bind(c,name='tribo_system_clear_limits')
      import
      type(c_ptr), value :: sys
      integer(c_int) :: answer
    end function c_system_clear_limits

    function c_system_get_limit(sys, t, limit) result(answer) bind(c,name='tribo_system_get_limit')
      import
      type(c_ptr), value :: sys
      real(c_double), value :: t
      real(c_double), intent(inout), optional :: limit(*)
      integer(c_int) :: answer
    end function c_system_get_limit

    function c_system_set_damping_ratio(sys, zeta) result(answer) bind(c,name='tribo_system_set_damping_ratio')
      import
      type(c_ptr), value :: sys
      real(c_double), value :: zeta
      integer(c_int) :: answer
    end function c_system_set_damping_ratio

    function c_system_get_frequencies(sys, omega) result(answer) bind(c,name='tribo_system_get_frequencies')
      import
      type(c_ptr), value :: sys
      real(c_double), intent(inout), optional :: omega(*)
      integer(c_int) :: answer
    end function c_system_get_frequencies

    function c_system_expand(sys, reduced, full) result(answer) bind(c,name='tribo_system_expand')
      import
      type(c_ptr), value :: sys
      real(c_double), intent(in), optional :: reduced(*)
      real(c_double), intent(inout), optional :: full(*)
      integer(c_int) :: answer
    end function c_system_expand

    function c_system_get_truncation(sys, omega, error) result(answer) bind(c,name='tribo_system_get_truncation')
      import
      type(c_ptr), value :: sys
      real(c_double), value :: omega
      real(c_double), intent(inout), optional :: error(*)
      integer(c_int) :: answer
    end function c_system_get_truncation

    function c_system_ndof(sys) result(answer) bind(c,name='tribo_system_ndof')
      import
      type(c_ptr), value :: sys
      integer(c_size_t) :: answer
    end function c_system_ndof

    function c_system_ncontact(sys) result(answer) bind(c,name='tribo_system_ncontact')
      import
      type(c_ptr), value :: sys
      integer(c_size_t) :: answer
    end function c_system_ncontact

    function c_system_dimension(sys) result(answer) bind(c,name='tribo_system_dimension')
      import
      type(c_ptr), value :: sys
      integer(c_size_t) :: answer
    end function c_system_dimension

    function c_system_context(sys) result(answer) bind(c,name='tribo_system_context')
      import
      type(c_ptr), value :: sys
      type(c_ptr) :: answer
    end function c_system_context

    function c_system_message(sys) result(answer) bind(c,name='tribo_system_message')
      import
      type(c_ptr), value :: sys
      type(c_ptr) :: answer
    end function c_system_message

    function c_system_contacts(sys, t, y, v, feq, f) result(answer) bind(c,name='tribo_system_contacts')
      import
      type(c_ptr), value :: sys
      real(c_double), value :: t
      real(c_double), intent(in), optional :: y(*)
      real(c_double), intent(inout), optional :: v(*)
      real(c_double), intent(inout), optional :: feq(*)
      real(c_double), intent(inout), optional :: f(*)
      integer(c_int) :: answer
    end function c_system_contacts

    function c_system_get_slip(sys, slip) result(answer) bind(c,name='tribo_system_get_slip')
      import
      type(c_ptr), value :: sys
      integer(c_signed_char), intent(inout), optional :: slip(*)
      integer(c_int) :: answer
    end function c_system_get_slip

    function c_system_get_count(sys, which, value) result(answer) bind(c,name='tribo_system_get_count')
      import
      type(c_ptr), value :: sys
      integer(c_int), value :: which
      integer(c_size_t), intent(inout) :: value
      integer(c_int) :: answer
    end function c_system_get_count

    function c_system_accept(sys, t, y) result(answer) bind(c,name='tribo_system_accept')
      import
      type(c_ptr), value :: sys
      real(c_double), value :: t
      real(c_double), intent(in), optional :: y(*)
      integer(c_int) :: answer
    end function c_system_accept

    function c_system_equilibrium(sys, given, y, slip, count, re, im) result(answer) bind(c,name='tribo_system_equilibrium')
      import
      type(c_ptr), value :: sys
      integer(c_signed_char), intent(in), optional :: given(*)
      real(c_double), intent(inout), optional :: y(*)
      integer(c_signed_char), intent(inout), optional :: slip(*)
      integer(c_size_t), intent(inout) :: count
      real(c_double), intent(inout), optional :: re(*)
      real(c_double), intent(inout), optional :: im(*)
      integer(c_int) :: answer
    end function c_system_equilibrium

    function c_system_find_flutter(sys, parameter, given, y, from, to, critical, omega) result(answer) &
      bind(c,name='tribo_system_find_flutter')
      import
      type(c_ptr), value :: sys
      integer(c_int), value :: parameter
      integer(c_signed_char), intent(in), optional :: given(*)
      real(c_double), intent(in), optional :: y(*)
      real(c_double), value :: from
      real(c_double), value :: to
      real(c_double), intent(inout), optional :: critical(*)
      real(c_double), intent(inout), optional :: omega(*)
      integer(c_int) :: answer
    end function c_system_find_flutter

    function c_system_derivative(sys, t, y, dydt) result(answer) bind(c,name='tribo_system_derivative')
      import
      type(c_ptr), value :: sys
      real(c_double), value :: t
      real(c_double), intent(in), optional :: y(*)
      real(c_double), intent(inout), optional :: dydt(*)
      integer(c_int) :: answer
    end function c_system_derivative

    function c_system_jacobian(sys, t, y, dfdy, dfdt) result(answer) bind(c,name='tribo_system_jacobian')
      import
      type(c_ptr), value :: sys
      real(c_double), value :: t
      real(c_double), intent(in), optional :: y(*)
      real(c_double), intent(inout), optional :: dfdy(*)
      real(c_double), intent(inout), optional :: dfdt(*)
      integer(c_int) :: answer
    end function c_system_jacobian

    function c_system_get_force(sys, f) result(answer) bind(c,name='tribo_system_get_force')
      import
      type(c_ptr), value :: sys
      real(c_double), intent(inout), optional :: f(*)
      integer(c_int) :: answer
    end function c_system_get_force

    function c_system_set_message(sys, status, text) result(answer) bind(c,name='tribo_system_set_message')
      import
      type(c_ptr), value :: sys
      integer(c_int), value :: status
      character(kind=c_char), intent(in), optional :: text(*)
      integer(c_int) :: answer
    end function c_system_set_message

    function c_system_attach(sys, key, data, destroy) result(answer) bind(c,name='tribo_system_attach')
      import
      type(c_ptr), value :: sys
      type(c_ptr), value :: key
      type(c_ptr), value :: data
      type(c_funptr), value :: destroy
      integer(c_int) :: answer
    end function c_system_attach

    function c_system_attached(sys, key) result(answer) bind(c,name='tribo_system_attached')
      import
      type(c_ptr), value :: sys
      type(c_ptr), value :: key
      type(c_ptr) :: answer
    end function c_system_attached

    function c_driver_create(drv, sys, method) result(answer) bind(c,name='tribo_driver_create')
      import
      type(c_ptr), intent(inout) :: drv
      type(c_ptr), value :: sys
      character(kind=c_char), intent(in), optional :: method(*)
      integer(c_int) :: answer
    end function c_driver_create

    function c_driver_create_stepper(drv, sys, stepper, data) result(answer) bind(c,name='tribo_driver_create_stepper')
      import
      type(c_ptr), intent(inout) :: drv
      type(c_ptr), value :: sys
      type(c_ptr), value :: stepper
      type(c_ptr), value :: data
      integer(c_int) :: answer
    end function c_driver_create_stepper

    function c_driver_method(drv) result(answer) bind(c,name='tribo_driver_method')
      import
      type(c_ptr), value :: drv
      type(c_ptr) :: answer
    end function c_driver_method

    function c_method_count() result(answer) bind(c,name='tribo_method_count')
      import
      integer(c_int) :: answer
    end function c_method_count

    function c_method_name(method) result(answer) bind(c,name='tribo_method_name')
      import
      integer(c_int), value :: method
      type(c_ptr) :: answer
    end function c_method_name

    function c_driver_set_step(drv, dt) result(answer) bind(c,name='tribo_driver_set_step')
      import
      type(c_ptr), value :: drv
      real(c_double), value :: dt
      integer(c_int) :: answer
    end function c_driver_set_step

    function c_driver_set_tolerance(drv, abstol, reltol) result(answer) bind(c,name='tribo_driver_set_tolerance')
      import
      type(c_ptr), value :: drv
      real(c_double), value :: abstol
      real(c_double), value :: reltol
      integer(c_int) :: answer
    end function c_driver_set_tolerance

    function c_driver_set_output(drv, dt) result(answer) bind(c,name='tribo_driver_set_output')
      import
      type(c_ptr), value :: drv
      real(c_double), value :: dt
      integer(c_int) :: answer
    end function c_driver_set_output

    function c_driver_set_max_step(drv, h) result(answer) bind(c,name='tribo_driver_set_max_step')
      import
      type(c_ptr), value :: drv
      real(c_double), value :: h
      integer(c_int) :: answer
    end function c_driver_set_max_step

    function c_driver_advance(drv, t, t1, y) result(answer) bind(c,name='tribo_driver_advance')
      import
      type(c_ptr), value :: drv
      real(c_double), intent(inout), optional :: t(*)
      real(c_double), value :: t1
      real(c_double), intent(inout), optional :: y(*)
      integer(c_int) :: answer
    end function c_driver_advance

    function c_driver_set_observer(drv, seen, data) result(answer) bind(c,name='tribo_driver_set_observer')
      import
      type(c_ptr), value :: drv
      type(c_funptr), value :: seen
      type(c_ptr), value :: data
      integer(c_int) :: answer
    end function c_driver_set_observer

    function c_driver_find_periodic(drv, t, period, y) result(answer) bind(c,name='tribo_driver_find_periodic')
      import
      type(c_ptr), value :: drv
      real(c_double), value :: t
      real(c_double), value :: period
      real(c_double), intent(inout), optional :: y(*)
      integer(c_int) :: answer
    end function c_driver_find_periodic

    function c_driver_set_ring(drv, sectors, order) result(answer) bind(c,name='tribo_driver_set_ring')
      import
      type(c_ptr), value :: drv
      integer(c_size_t), value :: sectors
      integer(c_size_t), value :: order
      integer(c_int) :: answer
    end function c_driver_set_ring

    function c_driver_find_cycle(drv, t, period, y) result(answer) bind(c,name='tribo_driver_find_cycle')
      import
      type(c_ptr), value :: drv
      real(c_double), value :: t
      real(c_double), intent(inout), optional :: period(*)
      real(c_double), intent(inout), optional :: y(*)
      integer(c_int) :: answer
    end function c_driver_find_cycle

    function c_driver_find_mode(drv, c, amplitude, omega, zeta, y) result(answer) bind(c,name='tribo_driver_find_mode')
      import
      type(c_ptr), value :: drv
      real(c_double), intent(in), optional :: c(*)
      real(c_double), value :: amplitude
      real(c_double), intent(inout), optional :: omega(*)
      real(c_double), intent(inout), optional :: zeta(*)
      real(c_double), intent(inout), optional :: y(*)
      integer(c_int) :: answer
    end function c_driver_find_mode

    function c_driver_get_multipliers(drv, re, im) result(answer) bind(c,name='tribo_driver_get_multipliers')
      import
      type(c_ptr), value :: drv
      real(c_double), intent(inout), optional :: re(*)
      real(c_double), intent(inout), optional :: im(*)
      integer(c_int) :: answer
    end function c_driver_get_multipliers

    function c_driver_get_freedom(drv, freedom) result(answer) bind(c,name='tribo_driver_get_freedom')
      import
      type(c_ptr), value :: drv
      integer(c_size_t), intent(inout) :: freedom
      integer(c_int) :: answer
    end function c_driver_get_freedom

    function c_driver_period_extremes(drv, c, least, most, at_least, at_most) result(answer) &
      bind(c,name='tribo_driver_period_extremes')
      import
      type(c_ptr), value :: drv
      real(c_double), intent(in), optional :: c(*)
      real(c_double), intent(inout), optional :: least(*)
      real(c_double), intent(inout), optional :: most(*)
      real(c_double), intent(inout), optional :: at_least(*)
      real(c_double), intent(inout), optional :: at_most(*)
      integer(c_int) :: answer
    end function c_driver_period_extremes

    function c_driver_period_harmonic(drv, c, k, cosine, sine) result(answer) bind(c,name='tribo_driver_period_harmonic')
      import
      type(c_ptr), value :: drv
      real(c_double), intent(in), optional :: c(*)
      integer(c_size_t), value :: k
      real(c_double), intent(inout), optional :: cosine(*)
      real(c_double), intent(inout), optional :: sine(*)
      integer(c_int) :: answer
    end function c_driver_period_harmonic

    function c_driver_period_dissipation(drv, energy) result(answer) bind(c,name='tribo_driver_period_dissipation')
      import
      type(c_ptr), value :: drv
      real(c_double), intent(inout), optional :: energy(*)
      integer(c_int) :: answer
    end function c_driver_period_dissipation

    function c_driver_period_stick(drv, share) result(answer) bind(c,name='tribo_driver_period_stick')
      import
      type(c_ptr), value :: drv
      real(c_double), intent(inout), optional :: share(*)
      integer(c_int) :: answer
    end function c_driver_period_stick

    function c_driver_period_derivatives(drv, count, kind, index, c, extremes, energy, y) result(answer) &
      bind(c,name='tribo_driver_period_derivatives')
      import
      type(c_ptr), value :: drv
      integer(c_size_t), value :: count
      integer(c_int), intent(in), optional :: kind(*)
      integer(c_size_t), intent(in), optional :: index(*)
      real(c_double), intent(in), optional :: c(*)
      real(c_double), intent(inout), optional :: extremes(*)
      real(c_double), intent(inout), optional :: energy(*)
      real(c_double), intent(inout), optional :: y(*)
      integer(c_int) :: answer
    end function c_driver_period_derivatives

    function c_driver_multiplier_derivatives(drv, which, count, kind, index, re, im) result(answer) &
      bind(c,name='tribo_driver_multiplier_derivatives')
      import
      type(c_ptr), value :: drv
      integer(c_size_t), value :: which
      integer(c_size_t), value :: count
      integer(c_int), intent(in), optional :: kind(*)
      integer(c_size_t), intent(in), optional :: index(*)
      real(c_double), intent(inout), optional :: re(*)
      real(c_double), intent(inout), optional :: im(*)
      integer(c_int) :: answer
    end function c_driver_multiplier_derivatives

    function c_driver_follow_curve(drv, curve, t, period, y, seen, data) result(answer) &
      bind(c,name='tribo_driver_follow_curve')
      import
      type(c_ptr), value :: drv
      type(c_ptr), value :: curve
      real(c_double), value :: t
      real(c_double), intent(inout), optional :: period(*)
      real(c_double), intent(inout), optional :: y(*)
      type(c_funptr), value :: seen
      type(c_ptr), value :: data
      integer(c_int) :: answer
    end function c_driver_follow_curve

    function c_driver_count(drv, which, value) result(answer) bind(c,name='tribo_driver_count')
      import
      type(c_ptr), value :: drv
      integer(c_int), value :: which
      integer(c_size_t), intent(inout) :: value
      integer(c_int) :: answer
    end function c_driver_count

    function c_driver_real(drv, which, value) result(answer) bind(c,name='tribo_driver_real')
      import
      type(c_ptr), value :: drv
      integer(c_int), value :: which
      real(c_double), intent(inout), optional :: value(*)
      integer(c_int) :: answer
    end function c_driver_real

    function c_driver_message(drv) result(answer) bind(c,name='tribo_driver_message')
      import
      type(c_ptr), value :: drv
      type(c_ptr) :: answer
    end function c_driver_message

    subroutine c_driver_destroy(drv) bind(c,name='tribo_driver_destroy')
      import
      type(c_ptr), value :: drv
    end subroutine c_driver_destroy

    pure function c_fortran_ndof(held) result(answer) bind(c,name='tribo_fortran_ndof')
      import
      type(c_ptr), intent(in), value :: held
      integer(c_size_t) :: answer
    end function c_fortran_ndof

    pure function c_fortran_dimension(held) result(answer) bind(c,name='tribo_fortran_dimension')
      import
      type(c_ptr), intent(in), value :: held
      integer(c_size_t) :: answer
    end function c_fortran_dimension

    pure function c_fortran_ncontact(held) result(answer) bind(c,name='tribo_fortran_ncontact')
      import
      type(c_ptr), intent(in), value :: held
      integer(c_size_t) :: answer
    end function c_fortran_ncontact

    pure function c_fortran_given(held) result(answer) bind(c,name='tribo_fortran_given')
      import
      type(c_ptr), intent(in), value :: held
      integer(c_size_t) :: answer
    end function c_fortran_given

    function c_fortran_method_count() result(answer) bind(c,name='tribo_fortran_method_count')
      import
      integer(c_int) :: answer
    end function c_fortran_method_count

    function c_fortran_method_name(method) result(answer) bind(c,name='tribo_fortran_method_name')
      import
      integer(c_int), value :: method
      type(c_ptr) :: answer
    end function c_fortran_method_name

    function c_fortran_driver_create(drv, sys, method) result(answer) bind(c,name='tribo_fortran_driver_create')
      import
      type(c_ptr), intent(inout) :: drv
      type(c_ptr), value :: sys
      character(kind=c_char), intent(in), optional :: method(*)
      integer(c_int) :: answer
    end function c_fortran_driver_create
  end interface
end module tribo_dynamics_c
