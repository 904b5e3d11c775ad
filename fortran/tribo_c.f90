! SPDX-License-Identifier: BSD-3-Clause
! Written by interface.awk from the headers of C, and not to be changed by hand: see target fortran-refresh.

!> The constants, as in C.
module tribo_constants
  implicit none
  private

  integer, parameter, public :: TRIBO_OK = 0
  !> a required pointer is NULL
  integer, parameter, public :: TRIBO_ERR_NULL = 1
  !> NaN or infinity
  integer, parameter, public :: TRIBO_ERR_NOT_FINITE = 2
  !> a value must be >= 0
  integer, parameter, public :: TRIBO_ERR_NEGATIVE = 3
  !> a value must be > 0
  integer, parameter, public :: TRIBO_ERR_NOT_POSITIVE = 4
  !> an index or a choice is out of range
  integer, parameter, public :: TRIBO_ERR_RANGE = 5
  !> sizes do not fit each other, or are too large
  integer, parameter, public :: TRIBO_ERR_SIZE = 6
  !> no law or method has this name
  integer, parameter, public :: TRIBO_ERR_NAME = 7
  !> another call must come first
  integer, parameter, public :: TRIBO_ERR_STATE = 8
  !> not available for this system, law or build
  integer, parameter, public :: TRIBO_ERR_UNSUPPORTED = 9
  integer, parameter, public :: TRIBO_ERR_MEMORY = 10
  integer, parameter, public :: TRIBO_ERR_NOT_SYMMETRIC = 20
  !> not positive semidefinite, or a mass matrix that is not positive definite
  integer, parameter, public :: TRIBO_ERR_INDEFINITE = 21
  !> an entry is given twice
  integer, parameter, public :: TRIBO_ERR_DUPLICATE = 22
  !> partition coupling: no f_eq balances this a; the outputs hold the least-squares one
  integer, parameter, public :: TRIBO_ERR_INCONSISTENT = 40
  integer, parameter, public :: TRIBO_ERR_NO_CONVERGENCE = 41
  !> the observer ended the run
  integer, parameter, public :: TRIBO_ERR_STOPPED = 60
  !> the step size fell below what time resolves
  integer, parameter, public :: TRIBO_ERR_STEP = 61
  !> a function of the caller failed
  integer, parameter, public :: TRIBO_ERR_CALLBACK = 62
  !> too many events in too short a time: "central/fixed" and "moreau/fixed" step over them
  integer, parameter, public :: TRIBO_ERR_CHATTER = 63

  integer, parameter, public :: TRIBO_COULOMB = 0
  integer, parameter, public :: TRIBO_VELOCITY_LIMITED = 1
  integer, parameter, public :: TRIBO_SMOOTH = 2
  integer, parameter, public :: TRIBO_KARNOPP = 3
  integer, parameter, public :: TRIBO_QUINN = 4
  integer, parameter, public :: TRIBO_QUINN_REVERSAL = 5
  !> a function of the caller, see tribo_set_user_law; for tribo_get_law only
  integer, parameter, public :: TRIBO_USER_LAW = -1

  integer, parameter, public :: TRIBO_CONSISTENT = 0
  integer, parameter, public :: TRIBO_PARTITION = 1

  integer, parameter, public :: TRIBO_SHARE_LEAST_NORM = 0
  integer, parameter, public :: TRIBO_SHARE_PREVIOUS = 1

  !> slides towards -z, f = limit
  integer, parameter, public :: TRIBO_SLIP_BACK = -1
  integer, parameter, public :: TRIBO_SLIP_STUCK = 0
  !> slides towards +z, f = -limit
  integer, parameter, public :: TRIBO_SLIP_FORTH = 1
  !> limit 0, f = 0
  integer, parameter, public :: TRIBO_SLIP_OPEN = 2
  !> slides in the plane; stands at both directions of a planar contact
  integer, parameter, public :: TRIBO_SLIP_PLANE = 3

  !> contacts with slip 0; 0 if tribo_get_slip fails
  integer, parameter, public :: TRIBO_COUNT_STUCK = 0
  !> sum of the ranks of the matrices that the last call solved with
  integer, parameter, public :: TRIBO_COUNT_RANK = 1
  !> groups of coupled contacts in the operator, and single contacts
  integer, parameter, public :: TRIBO_COUNT_ISLANDS = 2
  !> islands solved by the solver
  integer, parameter, public :: TRIBO_COUNT_SOLVES = 3
  !> islands that need no solver: a single contact, or no contact near stick
  integer, parameter, public :: TRIBO_COUNT_SKIPPED = 4
  !> matrices factorized
  integer, parameter, public :: TRIBO_COUNT_FACTORIZATIONS = 5
  !> contacts that entered or left a stick set
  integer, parameter, public :: TRIBO_COUNT_UPDATES = 6
  !> reversal marks set or cleared by tribo_accept
  integer, parameter, public :: TRIBO_COUNT_REVERSALS = 7
  !> solves that kept the stick set and the factor of the solve before
  integer, parameter, public :: TRIBO_COUNT_REUSED = 8
  !> planar contacts
  integer, parameter, public :: TRIBO_COUNT_PLANAR = 9
  !> calls that changed a setting or the operator
  integer, parameter, public :: TRIBO_COUNT_SETTINGS = 10
  !> values that tribo_update_operator reads; 0 if it cannot be called
  integer, parameter, public :: TRIBO_COUNT_VALUES = 11

  integer, parameter, public :: TRIBO_REAL_RESIDUAL = 0
  integer, parameter, public :: TRIBO_REAL_MAX_RATE = 1
  integer, parameter, public :: TRIBO_REAL_MAX_STEP = 2
end module tribo_constants

!> The functions of C, see interface.awk. Not for programs.
module tribo_c
  use, intrinsic :: iso_c_binding
  implicit none
  public

  interface
    function c_version() result(answer) bind(c,name='tribo_version')
      import
      integer(c_int) :: answer
    end function c_version

    function c_version_string() result(answer) bind(c,name='tribo_version_string')
      import
      type(c_ptr) :: answer
    end function c_version_string

    function c_strerror(status) result(answer) bind(c,name='tribo_strerror')
      import
      integer(c_int), value :: status
      type(c_ptr) :: answer
    end function c_strerror

    function c_law_count() result(answer) bind(c,name='tribo_law_count')
      import
      integer(c_int) :: answer
    end function c_law_count

    function c_law_name(law) result(answer) bind(c,name='tribo_law_name')
      import
      integer(c_int), value :: law
      type(c_ptr) :: answer
    end function c_law_name

    function c_law_reference(law) result(answer) bind(c,name='tribo_law_reference')
      import
      integer(c_int), value :: law
      type(c_ptr) :: answer
    end function c_law_reference

    function c_law_find(name, law) result(answer) bind(c,name='tribo_law_find')
      import
      character(kind=c_char), intent(in), optional :: name(*)
      integer(c_int), intent(inout) :: law
      integer(c_int) :: answer
    end function c_law_find

    function c_law_eval(law, v, feq, limit, epsilon, f, df_dv, df_dfeq, df_dlimit) result(answer) &
      bind(c,name='tribo_law_eval')
      import
      integer(c_int), value :: law
      real(c_double), value :: v
      real(c_double), value :: feq
      real(c_double), value :: limit
      real(c_double), value :: epsilon
      real(c_double), intent(inout), optional :: f(*)
      real(c_double), intent(inout), optional :: df_dv(*)
      real(c_double), intent(inout), optional :: df_dfeq(*)
      real(c_double), intent(inout), optional :: df_dlimit(*)
      integer(c_int) :: answer
    end function c_law_eval

    function c_elastic_force(n, dz, stiffness, limit, f, df_dz) result(answer) bind(c,name='tribo_elastic_force')
      import
      integer(c_size_t), value :: n
      real(c_double), intent(in), optional :: dz(*)
      real(c_double), intent(in), optional :: stiffness(*)
      real(c_double), intent(in), optional :: limit(*)
      real(c_double), intent(inout), optional :: f(*)
      real(c_double), intent(inout), optional :: df_dz(*)
      integer(c_int) :: answer
    end function c_elastic_force

    function c_elastic_force_planar(n, dz, stiffness, limit, f, df_dz) result(answer) &
      bind(c,name='tribo_elastic_force_planar')
      import
      integer(c_size_t), value :: n
      real(c_double), intent(in), optional :: dz(*)
      real(c_double), intent(in), optional :: stiffness(*)
      real(c_double), intent(in), optional :: limit(*)
      real(c_double), intent(inout), optional :: f(*)
      real(c_double), intent(inout), optional :: df_dz(*)
      integer(c_int) :: answer
    end function c_elastic_force_planar

    function c_contact_force(n, dz, depth, tangential, normal, mu, f, df) result(answer) bind(c,name='tribo_contact_force')
      import
      integer(c_size_t), value :: n
      real(c_double), intent(in), optional :: dz(*)
      real(c_double), intent(in), optional :: depth(*)
      real(c_double), intent(in), optional :: tangential(*)
      real(c_double), intent(in), optional :: normal(*)
      real(c_double), intent(in), optional :: mu(*)
      real(c_double), intent(inout), optional :: f(*)
      real(c_double), intent(inout), optional :: df(*)
      integer(c_int) :: answer
    end function c_contact_force

    function c_dahl_force(n, dz, stiffness, limit, f, df_dz) result(answer) bind(c,name='tribo_dahl_force')
      import
      integer(c_size_t), value :: n
      real(c_double), intent(in), optional :: dz(*)
      real(c_double), intent(in), optional :: stiffness(*)
      real(c_double), intent(in), optional :: limit(*)
      real(c_double), intent(inout), optional :: f(*)
      real(c_double), intent(inout), optional :: df_dz(*)
      integer(c_int) :: answer
    end function c_dahl_force

    function c_lugre_force(n, dt, dz, parameter, z, f, df_dz) result(answer) bind(c,name='tribo_lugre_force')
      import
      integer(c_size_t), value :: n
      real(c_double), value :: dt
      real(c_double), intent(in), optional :: dz(*)
      real(c_double), intent(in), optional :: parameter(*)
      real(c_double), intent(inout), optional :: z(*)
      real(c_double), intent(inout), optional :: f(*)
      real(c_double), intent(inout), optional :: df_dz(*)
      integer(c_int) :: answer
    end function c_lugre_force

    function c_bouc_wen_force(n, dz, parameter, z, f, df_dz) result(answer) bind(c,name='tribo_bouc_wen_force')
      import
      integer(c_size_t), value :: n
      real(c_double), intent(in), optional :: dz(*)
      real(c_double), intent(in), optional :: parameter(*)
      real(c_double), intent(inout), optional :: z(*)
      real(c_double), intent(inout), optional :: f(*)
      real(c_double), intent(inout), optional :: df_dz(*)
      integer(c_int) :: answer
    end function c_bouc_wen_force

    function c_iwan_force(n, room, dz, parameter, state, f, df_dz) result(answer) bind(c,name='tribo_iwan_force')
      import
      integer(c_size_t), value :: n
      integer(c_size_t), value :: room
      real(c_double), intent(in), optional :: dz(*)
      real(c_double), intent(in), optional :: parameter(*)
      real(c_double), intent(inout), optional :: state(*)
      real(c_double), intent(inout), optional :: f(*)
      real(c_double), intent(inout), optional :: df_dz(*)
      integer(c_int) :: answer
    end function c_iwan_force

    function c_create(ctx, ncontact) result(answer) bind(c,name='tribo_create')
      import
      type(c_ptr), intent(inout) :: ctx
      integer(c_size_t), value :: ncontact
      integer(c_int) :: answer
    end function c_create

    function c_clone(ctx, copy) result(answer) bind(c,name='tribo_clone')
      import
      type(c_ptr), value :: ctx
      type(c_ptr), intent(inout) :: copy
      integer(c_int) :: answer
    end function c_clone

    subroutine c_destroy(ctx) bind(c,name='tribo_destroy')
      import
      type(c_ptr), value :: ctx
    end subroutine c_destroy

    function c_message(ctx) result(answer) bind(c,name='tribo_message')
      import
      type(c_ptr), value :: ctx
      type(c_ptr) :: answer
    end function c_message

    function c_copy_settings(ctx, from) result(answer) bind(c,name='tribo_copy_settings')
      import
      type(c_ptr), value :: ctx
      type(c_ptr), value :: from
      integer(c_int) :: answer
    end function c_copy_settings

    function c_get_ncontact(ctx, ncontact) result(answer) bind(c,name='tribo_get_ncontact')
      import
      type(c_ptr), value :: ctx
      integer(c_size_t), intent(inout) :: ncontact
      integer(c_int) :: answer
    end function c_get_ncontact

    function c_set_law(ctx, law) result(answer) bind(c,name='tribo_set_law')
      import
      type(c_ptr), value :: ctx
      integer(c_int), value :: law
      integer(c_int) :: answer
    end function c_set_law

    function c_get_law(ctx, law) result(answer) bind(c,name='tribo_get_law')
      import
      type(c_ptr), value :: ctx
      integer(c_int), intent(inout) :: law
      integer(c_int) :: answer
    end function c_get_law

    function c_set_user_law(ctx, law, data) result(answer) bind(c,name='tribo_set_user_law')
      import
      type(c_ptr), value :: ctx
      type(c_funptr), value :: law
      type(c_ptr), value :: data
      integer(c_int) :: answer
    end function c_set_user_law

    function c_set_limit(ctx, limit) result(answer) bind(c,name='tribo_set_limit')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(in), optional :: limit(*)
      integer(c_int) :: answer
    end function c_set_limit

    function c_set_limit_all(ctx, limit) result(answer) bind(c,name='tribo_set_limit_all')
      import
      type(c_ptr), value :: ctx
      real(c_double), value :: limit
      integer(c_int) :: answer
    end function c_set_limit_all

    function c_get_limit(ctx, limit) result(answer) bind(c,name='tribo_get_limit')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(inout), optional :: limit(*)
      integer(c_int) :: answer
    end function c_get_limit

    function c_set_normal_load(ctx, mu, load) result(answer) bind(c,name='tribo_set_normal_load')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(in), optional :: mu(*)
      real(c_double), intent(in), optional :: load(*)
      integer(c_int) :: answer
    end function c_set_normal_load

    function c_set_static(ctx, ratio, velocity) result(answer) bind(c,name='tribo_set_static')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(in), optional :: ratio(*)
      real(c_double), intent(in), optional :: velocity(*)
      integer(c_int) :: answer
    end function c_set_static

    function c_get_static(ctx, ratio, velocity) result(answer) bind(c,name='tribo_get_static')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(inout), optional :: ratio(*)
      real(c_double), intent(inout), optional :: velocity(*)
      integer(c_int) :: answer
    end function c_get_static

    function c_set_epsilon(ctx, epsilon) result(answer) bind(c,name='tribo_set_epsilon')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(in), optional :: epsilon(*)
      integer(c_int) :: answer
    end function c_set_epsilon

    function c_set_epsilon_all(ctx, epsilon) result(answer) bind(c,name='tribo_set_epsilon_all')
      import
      type(c_ptr), value :: ctx
      real(c_double), value :: epsilon
      integer(c_int) :: answer
    end function c_set_epsilon_all

    function c_set_epsilon_step(ctx, dt, lambda_dt) result(answer) bind(c,name='tribo_set_epsilon_step')
      import
      type(c_ptr), value :: ctx
      real(c_double), value :: dt
      real(c_double), value :: lambda_dt
      integer(c_int) :: answer
    end function c_set_epsilon_step

    function c_get_epsilon(ctx, epsilon) result(answer) bind(c,name='tribo_get_epsilon')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(inout), optional :: epsilon(*)
      integer(c_int) :: answer
    end function c_get_epsilon

    function c_set_planar(ctx, count, first) result(answer) bind(c,name='tribo_set_planar')
      import
      type(c_ptr), value :: ctx
      integer(c_size_t), value :: count
      integer(c_size_t), intent(in), optional :: first(*)
      integer(c_int) :: answer
    end function c_set_planar

    function c_set_operator_diagonal(ctx, r) result(answer) bind(c,name='tribo_set_operator_diagonal')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(in), optional :: r(*)
      integer(c_int) :: answer
    end function c_set_operator_diagonal

    function c_set_operator_dense(ctx, r) result(answer) bind(c,name='tribo_set_operator_dense')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(in), optional :: r(*)
      integer(c_int) :: answer
    end function c_set_operator_dense

    function c_set_operator_csr(ctx, rowptr, col, val) result(answer) bind(c,name='tribo_set_operator_csr')
      import
      type(c_ptr), value :: ctx
      integer(c_size_t), intent(in), optional :: rowptr(*)
      integer(c_size_t), intent(in), optional :: col(*)
      real(c_double), intent(in), optional :: val(*)
      integer(c_int) :: answer
    end function c_set_operator_csr

    function c_set_operator_mass(ctx, ndof, inverse_mass, rowptr, col, val) result(answer) &
      bind(c,name='tribo_set_operator_mass')
      import
      type(c_ptr), value :: ctx
      integer(c_size_t), value :: ndof
      real(c_double), intent(in), optional :: inverse_mass(*)
      integer(c_size_t), intent(in), optional :: rowptr(*)
      integer(c_size_t), intent(in), optional :: col(*)
      real(c_double), intent(in), optional :: val(*)
      integer(c_int) :: answer
    end function c_set_operator_mass

    function c_set_operator_callback(ctx, ndof, apply, data, rowptr, col, val) result(answer) &
      bind(c,name='tribo_set_operator_callback')
      import
      type(c_ptr), value :: ctx
      integer(c_size_t), value :: ndof
      type(c_funptr), value :: apply
      type(c_ptr), value :: data
      integer(c_size_t), intent(in), optional :: rowptr(*)
      integer(c_size_t), intent(in), optional :: col(*)
      real(c_double), intent(in), optional :: val(*)
      integer(c_int) :: answer
    end function c_set_operator_callback

    function c_update_operator(ctx, val) result(answer) bind(c,name='tribo_update_operator')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(in), optional :: val(*)
      integer(c_int) :: answer
    end function c_update_operator

    function c_fix_operator(ctx) result(answer) bind(c,name='tribo_fix_operator')
      import
      type(c_ptr), value :: ctx
      integer(c_int) :: answer
    end function c_fix_operator

    function c_set_coupling(ctx, coupling) result(answer) bind(c,name='tribo_set_coupling')
      import
      type(c_ptr), value :: ctx
      integer(c_int), value :: coupling
      integer(c_int) :: answer
    end function c_set_coupling

    function c_get_coupling(ctx, coupling) result(answer) bind(c,name='tribo_get_coupling')
      import
      type(c_ptr), value :: ctx
      integer(c_int), intent(inout) :: coupling
      integer(c_int) :: answer
    end function c_get_coupling

    function c_set_sharing(ctx, sharing) result(answer) bind(c,name='tribo_set_sharing')
      import
      type(c_ptr), value :: ctx
      integer(c_int), value :: sharing
      integer(c_int) :: answer
    end function c_set_sharing

    function c_get_sharing(ctx, sharing) result(answer) bind(c,name='tribo_get_sharing')
      import
      type(c_ptr), value :: ctx
      integer(c_int), intent(inout) :: sharing
      integer(c_int) :: answer
    end function c_get_sharing

    function c_force(ctx, v, feq, f) result(answer) bind(c,name='tribo_force')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(in), optional :: v(*)
      real(c_double), intent(in), optional :: feq(*)
      real(c_double), intent(inout), optional :: f(*)
      integer(c_int) :: answer
    end function c_force

    function c_force_tangent(ctx, v, feq, f, df_dv, df_dfeq, df_dlimit) result(answer) bind(c,name='tribo_force_tangent')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(in), optional :: v(*)
      real(c_double), intent(in), optional :: feq(*)
      real(c_double), intent(inout), optional :: f(*)
      real(c_double), intent(inout), optional :: df_dv(*)
      real(c_double), intent(inout), optional :: df_dfeq(*)
      real(c_double), intent(inout), optional :: df_dlimit(*)
      integer(c_int) :: answer
    end function c_force_tangent

    function c_force_tangent_planar(ctx, v, feq, f, df_dv, df_dfeq, df_dlimit) result(answer) &
      bind(c,name='tribo_force_tangent_planar')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(in), optional :: v(*)
      real(c_double), intent(in), optional :: feq(*)
      real(c_double), intent(inout), optional :: f(*)
      real(c_double), intent(inout), optional :: df_dv(*)
      real(c_double), intent(inout), optional :: df_dfeq(*)
      real(c_double), intent(inout), optional :: df_dlimit(*)
      integer(c_int) :: answer
    end function c_force_tangent_planar

    function c_balance(ctx, v, a, feq, f) result(answer) bind(c,name='tribo_balance')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(in), optional :: v(*)
      real(c_double), intent(in), optional :: a(*)
      real(c_double), intent(inout), optional :: feq(*)
      real(c_double), intent(inout), optional :: f(*)
      integer(c_int) :: answer
    end function c_balance

    function c_balance_tangent(ctx, v, a, feq, f, df_dv, df_da) result(answer) bind(c,name='tribo_balance_tangent')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(in), optional :: v(*)
      real(c_double), intent(in), optional :: a(*)
      real(c_double), intent(inout), optional :: feq(*)
      real(c_double), intent(inout), optional :: f(*)
      real(c_double), intent(inout), optional :: df_dv(*)
      real(c_double), intent(inout), optional :: df_da(*)
      integer(c_int) :: answer
    end function c_balance_tangent

    function c_tangent_product(ctx, dv, da, df) result(answer) bind(c,name='tribo_tangent_product')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(in), optional :: dv(*)
      real(c_double), intent(in), optional :: da(*)
      real(c_double), intent(inout), optional :: df(*)
      integer(c_int) :: answer
    end function c_tangent_product

    function c_limit_product(ctx, dlimit, df) result(answer) bind(c,name='tribo_limit_product')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(in), optional :: dlimit(*)
      real(c_double), intent(inout), optional :: df(*)
      integer(c_int) :: answer
    end function c_limit_product

    function c_step_force(ctx, dt, vfree, f) result(answer) bind(c,name='tribo_step_force')
      import
      type(c_ptr), value :: ctx
      real(c_double), value :: dt
      real(c_double), intent(in), optional :: vfree(*)
      real(c_double), intent(inout), optional :: f(*)
      integer(c_int) :: answer
    end function c_step_force

    function c_step_force_mean(ctx, dt, v, vfree, f) result(answer) bind(c,name='tribo_step_force_mean')
      import
      type(c_ptr), value :: ctx
      real(c_double), value :: dt
      real(c_double), intent(in), optional :: v(*)
      real(c_double), intent(in), optional :: vfree(*)
      real(c_double), intent(inout), optional :: f(*)
      integer(c_int) :: answer
    end function c_step_force_mean

    function c_solve_box(ctx, a, lower, upper, f) result(answer) bind(c,name='tribo_solve_box')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(in), optional :: a(*)
      real(c_double), intent(in), optional :: lower(*)
      real(c_double), intent(in), optional :: upper(*)
      real(c_double), intent(inout), optional :: f(*)
      integer(c_int) :: answer
    end function c_solve_box

    function c_accept(ctx, v, feq) result(answer) bind(c,name='tribo_accept')
      import
      type(c_ptr), value :: ctx
      real(c_double), intent(in), optional :: v(*)
      real(c_double), intent(in), optional :: feq(*)
      integer(c_int) :: answer
    end function c_accept

    function c_get_slip(ctx, slip) result(answer) bind(c,name='tribo_get_slip')
      import
      type(c_ptr), value :: ctx
      integer(c_signed_char), intent(inout), optional :: slip(*)
      integer(c_int) :: answer
    end function c_get_slip

    function c_get_count(ctx, which, value) result(answer) bind(c,name='tribo_get_count')
      import
      type(c_ptr), value :: ctx
      integer(c_int), value :: which
      integer(c_size_t), intent(inout) :: value
      integer(c_int) :: answer
    end function c_get_count

    function c_get_real(ctx, which, value) result(answer) bind(c,name='tribo_get_real')
      import
      type(c_ptr), value :: ctx
      integer(c_int), value :: which
      real(c_double), intent(inout), optional :: value(*)
      integer(c_int) :: answer
    end function c_get_real

    function c_handle_add(object, destroy) result(answer) bind(c,name='tribo_handle_add')
      import
      type(c_ptr), value :: object
      type(c_funptr), value :: destroy
      integer(c_int64_t) :: answer
    end function c_handle_add

    function c_handle_add_short(object, destroy) result(answer) bind(c,name='tribo_handle_add_short')
      import
      type(c_ptr), value :: object
      type(c_funptr), value :: destroy
      integer(c_int64_t) :: answer
    end function c_handle_add_short

    function c_handle_add_part(object, owner, destroy) result(answer) bind(c,name='tribo_handle_add_part')
      import
      type(c_ptr), value :: object
      type(c_ptr), value :: owner
      type(c_funptr), value :: destroy
      integer(c_int64_t) :: answer
    end function c_handle_add_part

    pure function c_handle_owner(number) result(answer) bind(c,name='tribo_handle_owner')
      import
      integer(c_int64_t), intent(in), value :: number
      type(c_ptr) :: answer
    end function c_handle_owner

    pure function c_handle_find(number) result(answer) bind(c,name='tribo_handle_find')
      import
      integer(c_int64_t), intent(in), value :: number
      type(c_ptr) :: answer
    end function c_handle_find

    subroutine c_handle_drop(number) bind(c,name='tribo_handle_drop')
      import
      integer(c_int64_t), value :: number
    end subroutine c_handle_drop

    function c_handle_note(object, status, text) result(answer) bind(c,name='tribo_handle_note')
      import
      type(c_ptr), value :: object
      integer(c_int), value :: status
      character(kind=c_char), intent(in), optional :: text(*)
      integer(c_int) :: answer
    end function c_handle_note

    subroutine c_handle_noted(object, size, text) bind(c,name='tribo_handle_noted')
      import
      type(c_ptr), value :: object
      integer(c_size_t), value :: size
      character(kind=c_char), intent(inout), optional :: text(*)
    end subroutine c_handle_noted

    function c_handle_law(law, rpar, ipar) result(answer) bind(c,name='tribo_handle_law')
      import
      type(c_funptr), value :: law
      type(c_ptr), value :: rpar
      type(c_ptr), value :: ipar
      type(c_ptr) :: answer
    end function c_handle_law

    function c_handle_count() result(answer) bind(c,name='tribo_handle_count')
      import
      integer(c_int32_t) :: answer
    end function c_handle_count
  end interface
end module tribo_c
