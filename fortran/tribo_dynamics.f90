! SPDX-License-Identifier: BSD-3-Clause
!> Mechanical systems with friction, and their integration in time. To be used together with module tribo.
!>
!> A system is M q'' + C q' + K q = p(t) + J' f, v = J q' - b(t), with p and b sums of harmonics and tables; f are the friction
!> forces of its contacts, and v their relative velocities. Its state is y = q(ndof), q'(ndof), displacements of the sliders
!> of contacts with compliance, energy dissipated by friction since t = 0.
!>
!>     use tribo
!>     use tribo_dynamics
!>     type(tribo_system) :: chain
!>     type(tribo_driver) :: driver
!>     call chain%chain(20, limit=0.1_dp, alpha=1.0_dp, omega=0.5_dp)
!>     allocate (y(chain%dimension()), source=0.0_dp)
!>     call driver%create(chain, 'exact')
!>     call driver%advance(t, t1, y)
!>
!> Arguments, errors and threads as in module tribo; a system and its drivers belong to one thread. A new system or driver
!> replaces the one before; on error the one before stays. Systems and drivers cannot be copied: an assignment stops the program.
!> A driver keeps its system alive, also after the system's variable is destroyed.
!>
!> Programs use module tribo_dynamics, at the end of this file: module tribo_systems, and the constants of tribo_dynamics.h, see
!> tribo_dynamics_c.f90. In a build with GSL drivers also take its steppers, see tribo_gsl.f90.
module tribo_systems
  use tribo_dynamics_c
  use tribo_dynamics_constants
  use tribo_c, only: c_handle_add, c_handle_drop
  use tribo_constants
  use tribo, only: tribo_context
  use tribo_support
  use, intrinsic :: iso_fortran_env, only: int32, int64
  implicit none
  private

  public :: tribo_method_count, tribo_method_name, tribo_dynamics_has

  !> A sparse matrix.
  type, public :: tribo_sparse
    private
    integer :: rows = 0, columns = 0
    integer(c_size_t), allocatable :: first(:), col(:) ! from 0
    real(dp), allocatable :: val(:)
  contains
    procedure :: set_csr, set_coo
  end type tribo_sparse

  !> A structure as given: matrices, directions and compliance of its contacts. Copies its arguments; makes systems.
  !>
  !>     call model%create(ndof, ncontact)
  !>     call model%set_mass(m)            ! (ndof,ndof), (ndof) for a diagonal, or type(tribo_sparse); so damping and stiffness
  !>     call model%set_stiffness(k)
  !>     call model%set_direction(j)       ! (ncontact,ndof) or type(tribo_sparse)
  !>     call model%set_compliance(c)      ! (ncontact) 1/stiffness of the springs before sliders; 0: rigid
  !>     call model%set_normal(1, 2, mu, stiffness, gap)  ! limit of contact 1: mu stiffness max(0, J_2 q - gap)
  !>     call system%create(model)         ! or system%reduce(model, nmode)
  type, extends(tribo_object), public :: tribo_model
  contains
    procedure :: create => create_model
    procedure, private :: mass_dense, mass_diagonal, mass_sparse
    procedure, private :: damping_dense, damping_diagonal, damping_sparse
    procedure, private :: stiffness_dense, stiffness_diagonal, stiffness_sparse
    procedure, private :: direction_dense, direction_sparse
    generic :: set_mass => mass_dense, mass_diagonal, mass_sparse
    generic :: set_damping => damping_dense, damping_diagonal, damping_sparse
    generic :: set_stiffness => stiffness_dense, stiffness_diagonal, stiffness_sparse
    generic :: set_direction => direction_dense, direction_sparse
    procedure :: set_compliance
    procedure :: set_normal
    procedure :: set_ring => set_model_ring
    procedure :: message => model_message
    procedure, private :: assign_model
    generic :: assignment(=) => assign_model
  end type tribo_model

  type, extends(tribo_object), public :: tribo_system
  contains
    procedure :: create => create_system
    procedure :: reduce => reduce_system, reduce_to
    procedure :: oscillator, chain, belt
    procedure :: clone => clone_system
    procedure :: add_load, add_base_motion, add_load_table, add_base_table, add_limit
    procedure :: clear_loads, clear_base_motion, clear_limits
    procedure :: set_limit_table, get_limit, set_damping_ratio
    procedure :: get_frequencies, expand, get_truncation
    procedure :: ndof, ncontact, dimension
    procedure :: context
    procedure :: derivative, jacobian
    procedure :: contacts, accept
    procedure :: equilibrium, find_flutter
    procedure :: get_slip, get_count => get_system_count
    procedure :: message => system_message
    procedure, private :: assign_system
    generic :: assignment(=) => assign_system
  end type tribo_system

  type, extends(tribo_object), public :: tribo_driver
  contains
    procedure :: create
    procedure :: method
    procedure :: advance
    procedure, private :: count_short, count_long
    generic :: count => count_short, count_long
    procedure :: real => driver_real
    procedure :: set_ring, find_periodic, find_cycle, find_mode
    procedure :: follow_curve
    procedure :: get_multipliers
    procedure :: get_freedom
    procedure :: period_extremes, period_harmonic, period_dissipation, period_stick, period_derivatives
    procedure :: multiplier_derivatives
    procedure :: set_observer
    procedure :: set_step, set_tolerance, set_output, set_max_step
    procedure :: message => driver_message
    procedure, private :: assign_driver
    generic :: assignment(=) => assign_driver
  end type tribo_driver

  !> A moment of the motion: time, state, kind TRIBO_MOMENT_..., and the contact that changes, 0 for TRIBO_MOMENT_STEP. y is
  !> valid during the call.
  type, public :: tribo_moment
    real(dp) :: t = 0
    real(dp), pointer :: y(:) => null()
    integer :: kind = 0, contact = 0
  end type tribo_moment

  !> An observer of a driver: the caller extends this type by components of its own.
  type, abstract, public :: tribo_observer
  contains
    procedure(seen), deferred :: seen
  end type tribo_observer

  abstract interface
    !> Called at every moment, see tribo_driver_set_observer. Returns 0 to go on; else the advance ends with TRIBO_ERR_STOPPED.
    !> Must not change the system or the driver.
    integer function seen(this, moment)
      import :: tribo_moment, tribo_observer
      class(tribo_observer), intent(inout) :: this
      type(tribo_moment), intent(in) :: moment
    end function seen
  end interface

  !> A curve for follow_curve; members as in tribo_curve of tribo_dynamics.h. contact: of TRIBO_PARAMETER_LIMIT.
  type, public :: tribo_curve
    integer :: motion = TRIBO_MOTION_PERIODIC, parameter = TRIBO_PARAMETER_FREQUENCY, contact = 1, points = 0
    real(dp) :: least = 0, most = 0, step = 0, amplitude = 0
    logical :: coarse = .false.
    real(dp), allocatable :: c(:)
  end type tribo_curve

  !> A point of a curve; members as in tribo_curve_point of tribo_dynamics.h. contact 0: none. y is valid during the call.
  type, public :: tribo_curve_point
    real(dp) :: parameter = 0, t = 0, period = 0, zeta = 0
    real(dp), pointer :: y(:) => null()
    integer :: kind = 0, contact = 0, stable = 0
  end type tribo_curve_point

  !> An observer of curves: the caller extends this type by components of its own.
  type, abstract, public :: tribo_curve_observer
  contains
    procedure(point_seen), deferred :: seen
  end type tribo_curve_observer

  abstract interface
    !> Called at every point. Returns 0 to go on; else the curve ends with TRIBO_ERR_STOPPED. May ask the driver about the point.
    integer function point_seen(this, point)
      import :: tribo_curve_observer, tribo_curve_point
      class(tribo_curve_observer), intent(inout) :: this
      type(tribo_curve_point), intent(in) :: point
    end function point_seen
  end interface

  abstract interface
    !> tribo_model_set_mass and its kin, of full matrices and diagonals; of compressed rows.
    integer(c_int) function values_setter(model, x) bind(c)
      import :: c_int, c_ptr, c_double
      type(c_ptr), value :: model
      real(c_double), intent(in), optional :: x(*)
    end function values_setter

    integer(c_int) function rows_setter(model, rowptr, col, val) bind(c)
      import :: c_int, c_ptr, c_double, c_size_t
      type(c_ptr), value :: model
      integer(c_size_t), intent(in), optional :: rowptr(*), col(*)
      real(c_double), intent(in), optional :: val(*)
    end function rows_setter
  end interface

  !> A system of the library, its context's number, the degrees of freedom of its matrices, and the number of its users, the
  !> variable and drivers: tribo_held of dynamics.h.
  type, bind(c) :: held_system
    type(c_ptr) :: sys
    integer(c_int64_t) :: context, given, users
  end type held_system

  type :: held_driver
    type(c_ptr) :: drv
    type(held_system), pointer :: system
    class(tribo_observer), pointer :: observer => null()
  end type held_driver

  !> tribo_moment of tribo_dynamics.h.
  type, bind(c) :: c_moment
    integer(c_size_t) :: size
    real(c_double) :: t
    type(c_ptr) :: y
    integer(c_int) :: kind
    integer(c_size_t) :: contact
  end type c_moment

  !> tribo_curve and tribo_curve_point of tribo_dynamics.h.
  type, bind(c) :: c_curve
    integer(c_size_t) :: size
    integer(c_int) :: motion, parameter
    integer(c_size_t) :: index
    real(c_double) :: least, most, step
    integer(c_size_t) :: points
    integer(c_int) :: coarse
    real(c_double) :: amplitude
    type(c_ptr) :: c
  end type c_curve

  type, bind(c) :: c_curve_point
    integer(c_size_t) :: size
    real(c_double) :: parameter, t, period, zeta
    type(c_ptr) :: y
    integer(c_int) :: kind
    integer(c_size_t) :: contact
    integer(c_int) :: stable
  end type c_curve_point

  !> An observer of a curve, and the values of a state.
  type :: held_curve
    class(tribo_curve_observer), pointer :: observer => null()
    integer :: dimension = 0
  end type held_curve

contains

  ! ------------------------------------------------------------------------------------------------------------ sparse matrices

  !> A matrix of size(rowptr) - 1 rows: the entries of row i are val(k) at column col(k), k = rowptr(i) to rowptr(i+1) - 1, in any
  !> order, each at most once; rowptr(1) = 1. Of a symmetric matrix both triangles.
  subroutine set_csr(this, columns, rowptr, col, val, stat, errmsg)
    class(tribo_sparse), intent(inout) :: this
    integer, intent(in) :: columns, rowptr(:), col(:)
    real(dp), intent(in) :: val(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    w%status = TRIBO_OK
    call check_rows(w, rowptr, col, val, max(size(rowptr) - 1, 0), columns)
    if (w%status == TRIBO_OK) call fill(this, w, columns, rowptr, col, val)
    call finish(w, stat, errmsg)
  end subroutine set_csr

  !> A matrix of rows by columns: val(k) at row(k), col(k), in any order, each at most once.
  subroutine set_coo(this, rows, columns, row, col, val, stat, errmsg)
    class(tribo_sparse), intent(inout) :: this
    integer, intent(in) :: rows, columns, row(:), col(:)
    real(dp), intent(in) :: val(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    integer, allocatable :: rowptr(:), order(:)
    integer :: k

    w%status = TRIBO_OK
    call expect_count(w, 'rows', rows)
    call expect_shape(w, 'col', shape(col), shape(row))
    call expect_shape(w, 'val', shape(val), shape(row))
    if (w%status == TRIBO_OK) then
      do k = 1, size(row)
        call expect_index(w, 'row', k, row(k), rows)
        call expect_index(w, 'col', k, col(k), columns)
      end do
    end if
    if (w%status == TRIBO_OK) then
      ! Counts, then places, then entries: row by row, and within a row as they came.
      allocate (rowptr(rows + 1), order(size(row)))
      rowptr = 0
      do k = 1, size(row)
        rowptr(row(k)) = rowptr(row(k)) + 1
      end do
      rowptr(rows + 1) = size(row) + 1
      do k = rows, 1, -1
        rowptr(k) = rowptr(k + 1) - rowptr(k)
      end do
      do k = 1, size(row)
        order(rowptr(row(k))) = k
        rowptr(row(k)) = rowptr(row(k)) + 1
      end do
      rowptr = [1, rowptr(:rows)]
      call fill(this, w, columns, rowptr, col(order), val(order))
    end if
    call finish(w, stat, errmsg)
  end subroutine set_coo

  subroutine fill(this, w, columns, rowptr, col, val)
    class(tribo_sparse), intent(inout) :: this
    type(work), intent(inout) :: w
    integer, intent(in) :: columns, rowptr(:), col(:)
    real(dp), intent(in) :: val(:)
    character(len=80) :: text
    integer, allocatable :: last(:)
    integer :: i, k

    call expect_count(w, 'columns', columns)
    if (w%status /= TRIBO_OK) return
    allocate (last(columns), source=0)
    do i = 1, size(rowptr) - 1
      do k = rowptr(i), rowptr(i + 1) - 1
        if (last(col(k)) == i) then
          write (text, '(2(a,i0))') 'entry [', i - 1, '][', col(k) - 1
          call fail(w, TRIBO_ERR_DUPLICATE, trim(text) // '] is given twice')
        end if
        last(col(k)) = i
      end do
    end do
    if (w%status /= TRIBO_OK) return
    this%rows = size(rowptr) - 1
    this%columns = columns
    this%first = from_zero(rowptr)
    this%col = from_zero(col)
    this%val = val
  end subroutine fill

  ! --------------------------------------------------------------------------------------------------------------------- models

  !> A model of ndof degrees of freedom and ncontact contacts, without matrices.
  subroutine create_model(this, ndof, ncontact, stat, errmsg)
    class(tribo_model), intent(inout) :: this
    integer, intent(in) :: ndof, ncontact
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    type(c_ptr) :: model

    w%status = TRIBO_OK
    call expect_count(w, 'ndof', ndof)
    call expect_count(w, 'ncontact', ncontact)
    if (w%status == TRIBO_OK) w%status = c_model_create(model, int(ndof, c_size_t), int(ncontact, c_size_t))
    if (w%status == TRIBO_ERR_SIZE .and. ndof == 0) w%text = 'ndof = 0: a model has a degree of freedom at least'
    if (w%status == TRIBO_OK) then
      w%status = adopt(this, model, c_funloc(release_model))
      if (w%status /= TRIBO_OK) call c_model_destroy(model)
    end if
    call finish(w, stat, errmsg)
  end subroutine create_model

  !> Mass as a full matrix, as its diagonal, or sparse. A new one takes the place of the last one.
  subroutine mass_dense(this, m, stat, errmsg)
    class(tribo_model), intent(inout) :: this
    real(dp), intent(in) :: m(:,:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    call set_dense(this, 'mass', m, c_model_set_mass, stat, errmsg)
  end subroutine mass_dense

  subroutine mass_diagonal(this, m, stat, errmsg)
    class(tribo_model), intent(inout) :: this
    real(dp), intent(in) :: m(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    call set_diagonal(this, 'mass', m, c_model_set_mass_diagonal, stat, errmsg)
  end subroutine mass_diagonal

  subroutine mass_sparse(this, m, stat, errmsg)
    class(tribo_model), intent(inout) :: this
    type(tribo_sparse), intent(in) :: m
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    call set_sparse(this, 'mass', m, c_model_set_mass_csr, stat, errmsg)
  end subroutine mass_sparse

  !> Damping as a full matrix, as its diagonal, or sparse. A new one takes the place of the last one.
  subroutine damping_dense(this, c, stat, errmsg)
    class(tribo_model), intent(inout) :: this
    real(dp), intent(in) :: c(:,:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    call set_dense(this, 'damping', c, c_model_set_damping, stat, errmsg)
  end subroutine damping_dense

  subroutine damping_diagonal(this, c, stat, errmsg)
    class(tribo_model), intent(inout) :: this
    real(dp), intent(in) :: c(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    call set_diagonal(this, 'damping', c, c_model_set_damping_diagonal, stat, errmsg)
  end subroutine damping_diagonal

  subroutine damping_sparse(this, c, stat, errmsg)
    class(tribo_model), intent(inout) :: this
    type(tribo_sparse), intent(in) :: c
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    call set_sparse(this, 'damping', c, c_model_set_damping_csr, stat, errmsg)
  end subroutine damping_sparse

  !> Stiffness as a full matrix, as its diagonal, or sparse. A new one takes the place of the last one.
  subroutine stiffness_dense(this, k, stat, errmsg)
    class(tribo_model), intent(inout) :: this
    real(dp), intent(in) :: k(:,:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    call set_dense(this, 'stiffness', k, c_model_set_stiffness, stat, errmsg)
  end subroutine stiffness_dense

  subroutine stiffness_diagonal(this, k, stat, errmsg)
    class(tribo_model), intent(inout) :: this
    real(dp), intent(in) :: k(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    call set_diagonal(this, 'stiffness', k, c_model_set_stiffness_diagonal, stat, errmsg)
  end subroutine stiffness_diagonal

  subroutine stiffness_sparse(this, k, stat, errmsg)
    class(tribo_model), intent(inout) :: this
    type(tribo_sparse), intent(in) :: k
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    call set_sparse(this, 'stiffness', k, c_model_set_stiffness_csr, stat, errmsg)
  end subroutine stiffness_sparse

  !> J (ncontact,ndof), full or sparse: v = J q'.
  subroutine direction_dense(this, j, stat, errmsg)
    class(tribo_model), intent(inout) :: this
    real(dp), intent(in) :: j(:,:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    call set_dense(this, 'direction', j, c_model_set_direction, stat, errmsg)
  end subroutine direction_dense

  subroutine direction_sparse(this, j, stat, errmsg)
    class(tribo_model), intent(inout) :: this
    type(tribo_sparse), intent(in) :: j
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    call set_sparse(this, 'direction', j, c_model_set_direction_csr, stat, errmsg)
  end subroutine direction_sparse

  !> A matrix called name to the model, by set: full, its diagonal, or sparse. The direction has a row a contact.
  subroutine set_dense(this, name, x, set, stat, errmsg)
    class(tribo_model), intent(in) :: this
    character(len=*), intent(in) :: name
    real(dp), intent(in) :: x(:,:)
    procedure(values_setter) :: set
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_model(this, w)
    call expect_size(w, name, x, w%dimension, rows_of(w, name))
    if (w%status == TRIBO_OK) w%status = set(w%object, transpose(x))
    call finish_model(w, stat, errmsg)
  end subroutine set_dense

  subroutine set_diagonal(this, name, x, set, stat, errmsg)
    class(tribo_model), intent(in) :: this
    character(len=*), intent(in) :: name
    real(dp), intent(in) :: x(:)
    procedure(values_setter) :: set
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_model(this, w)
    call expect_size(w, name, x, w%dimension)
    if (w%status == TRIBO_OK) w%status = set(w%object, x)
    call finish_model(w, stat, errmsg)
  end subroutine set_diagonal

  subroutine set_sparse(this, name, x, set, stat, errmsg)
    class(tribo_model), intent(in) :: this
    character(len=*), intent(in) :: name
    type(tribo_sparse), intent(in) :: x
    procedure(rows_setter) :: set
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_model(this, w)
    if (.not. allocated(x%val)) call fail(w, TRIBO_ERR_NULL, name // ' has not been set')
    if (w%status == TRIBO_OK) call expect_shape(w, name, [x%rows, x%columns], [rows_of(w, name), w%dimension])
    if (w%status == TRIBO_OK) w%status = set(w%object, x%first, x%col, x%val)
    call finish_model(w, stat, errmsg)
  end subroutine set_sparse

  pure integer function rows_of(w, name)
    type(work), intent(in) :: w
    character(len=*), intent(in) :: name
    rows_of = merge(w%n, w%dimension, name == 'direction')
  end function rows_of

  !> Springs before the sliders of contacts, c(ncontact) = 1/stiffness >= 0; 0: a rigid contact.
  subroutine set_compliance(this, c, stat, errmsg)
    class(tribo_model), intent(inout) :: this
    real(dp), intent(in) :: c(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_model(this, w)
    call expect_size(w, 'compliance', c, w%n)
    if (w%status == TRIBO_OK) w%status = c_model_set_compliance(w%object, c)
    call finish_model(w, stat, errmsg)
  end subroutine set_compliance

  !> The limit of a contact follows the motion: mu N, N = stiffness max(0, J_n q - gap), n = normal, another row of J. It gets -N.
  subroutine set_normal(this, contact, normal, mu, stiffness, gap, stat, errmsg)
    class(tribo_model), intent(inout) :: this
    integer, intent(in) :: contact, normal
    real(dp), intent(in) :: mu, stiffness, gap
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_model(this, w)
    if (w%status == TRIBO_OK) call expect_index(w, 'contact', 1, contact, w%n)
    if (w%status == TRIBO_OK) call expect_index(w, 'normal', 1, normal, w%n)
    if (w%status == TRIBO_OK) then
      w%status = c_model_set_normal(w%object, int(contact - 1, c_size_t), int(normal - 1, c_size_t), mu, stiffness, gap)
    end if
    call finish_model(w, stat, errmsg)
  end subroutine set_normal

  !> The text of the last error on the model, also of a system that was not made; empty before any.
  function model_message(this) result(text)
    class(tribo_model), intent(in) :: this
    character(len=:), allocatable :: text
    type(work) :: w

    call find_model(this, w)
    if (w%status == TRIBO_OK) call to_text(c_model_message(w%object), w%text)
    call message_of(w, text)
  end function model_message

  !> The system of all degrees of freedom of the model. Its context starts with Quinn's law, limit 0 (all contacts open) and
  !> R = J M**-1 J'. No load, no motion yet.
  subroutine create_system(this, model, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    class(tribo_model), intent(in) :: model
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    type(c_ptr) :: sys

    call find_model(model, w)
    if (w%status == TRIBO_OK) w%status = c_system_create(sys, w%object)
    call adopt_system(this, w, sys, w%dimension)
    call finish_model(w, stat, errmsg)
  end subroutine create_system

  !> The system of the nmode lowest modes of the model, and of static responses of its contacts beside them: static_contacts,
  !> TRIBO_STATICS_NONE, _MASS (where absent) or _COMPLIANCE. Without damping, see set_damping_ratio.
  subroutine reduce_system(this, model, nmode, static_contacts, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    class(tribo_model), intent(in) :: model
    integer, intent(in) :: nmode
    integer, intent(in), optional :: static_contacts
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    type(c_ptr) :: sys
    integer(c_int) :: statics

    statics = TRIBO_STATICS_MASS
    if (present(static_contacts)) statics = int(static_contacts, c_int)
    call find_model(model, w)
    call expect_count(w, 'nmode', nmode)
    if (w%status == TRIBO_OK) w%status = c_system_reduce(sys, w%object, int(nmode, c_size_t), statics)
    call adopt_system(this, w, sys, w%dimension)
    call finish_model(w, stat, errmsg)
  end subroutine reduce_system

  !> The same with so many modes that the error of get_truncation at omega, rad/time, is at most tolerance.
  subroutine reduce_to(this, model, omega, tolerance, static_contacts, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    class(tribo_model), intent(in) :: model
    real(dp), intent(in) :: omega, tolerance
    integer, intent(in), optional :: static_contacts
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    type(c_ptr) :: sys
    integer(c_int) :: statics

    statics = TRIBO_STATICS_MASS
    if (present(static_contacts)) statics = int(static_contacts, c_int)
    call find_model(model, w)
    if (w%status == TRIBO_OK) w%status = c_system_reduce_to(sys, w%object, omega, tolerance, statics)
    call adopt_system(this, w, sys, w%dimension)
    call finish_model(w, stat, errmsg)
  end subroutine reduce_to

  !> Matrices of a ring of equal sectors, from the model of one; see tribo_model_set_ring.
  subroutine set_model_ring(this, sector, sectors, stat, errmsg)
    class(tribo_model), intent(inout) :: this
    class(tribo_model), intent(in) :: sector
    integer, intent(in) :: sectors
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_model(this, w)
    call expect_count(w, 'sectors', sectors)
    if (w%status == TRIBO_OK) w%status = c_model_set_ring(w%object, object_of(sector), int(sectors, c_size_t))
    call finish_model(w, stat, errmsg)
  end subroutine set_model_ring

  !> Begins a call on a model: w%dimension degrees of freedom, w%n contacts.
  subroutine find_model(this, w)
    class(tribo_model), intent(in) :: this
    type(work), intent(out) :: w

    w%kind = 'model'
    w%object = object_of(this)
    if (.not. c_associated(w%object)) return
    w%dimension = int(c_model_ndof(w%object))
    w%n = int(c_model_ncontact(w%object))
    w%status = TRIBO_OK
  end subroutine find_model

  !> Ends a call on a model: the text of an error is the model's, or w%text.
  subroutine finish_model(w, stat, errmsg)
    type(work), intent(inout) :: w
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg

    if (w%status /= TRIBO_OK .and. c_associated(w%object) .and. .not. allocated(w%text)) &
      call to_text(c_model_message(w%object), w%text)
    call finish(w, stat, errmsg)
  end subroutine finish_model

  subroutine release_model(object) bind(c, name='')
    type(c_ptr), value :: object
    call c_model_destroy(object)
  end subroutine release_model

  impure elemental subroutine assign_model(to, from)
    class(tribo_model), intent(inout) :: to
    type(tribo_model), intent(in) :: from
    if (c_associated(object_of(from))) call refuse('model')
    call to%destroy()
  end subroutine assign_model

  ! -------------------------------------------------------------------------------------------------------------------- systems

  !> Quinn's three reference systems (Quinn 2004, doi:10.1115/1.1760564), nondimensional.
  !> x'' + x = f + alpha*sin(omega*t). Eq. 5.
  subroutine oscillator(this, limit, alpha, omega, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: limit, alpha, omega
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    type(c_ptr) :: sys

    w%status = c_system_oscillator(sys, limit, alpha, omega)
    call blame(w, 'limit', limit)
    call blame(w, 'alpha', alpha)
    call blame(w, 'omega', omega)
    call adopt_system(this, w, sys)
    call finish(w, stat, errmsg)
  end subroutine oscillator

  !> A copy that shares nothing, with loads, motions, tables, and the context and its settings; e.g. one a thread.
  subroutine clone_system(this, copy, stat, errmsg)
    class(tribo_system), intent(in) :: this
    class(tribo_system), intent(inout) :: copy
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    type(c_ptr) :: sys

    call find_system(this, w)
    if (w%status == TRIBO_OK) then
      w%status = c_system_clone(w%object, sys)
      call adopt_system(copy, w, sys, w%given)
    end if
    call finish(w, stat, errmsg)
  end subroutine clone_system

  !> n >= 2 blocks on a frictional surface, pulled by alpha*sin(omega*t) at the first one. Fig. 8. limit is the paper's mu N_i.
  !> Contacts have the limit mu N_i/n and R = n, the last one 3/4 of that limit and 4/3 of that R, see tribo_dynamics.h. The
  !> last entry of the state is the paper's D.
  subroutine chain(this, n, limit, alpha, omega, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    integer, intent(in) :: n
    real(dp), intent(in) :: limit, alpha, omega
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    type(c_ptr) :: sys

    w%status = TRIBO_OK
    call expect_count(w, 'n', n)
    if (n == 0 .or. n == 1) call fail(w, TRIBO_ERR_SIZE, 'n = ' // merge('0', '1', n == 0) // ' is less than 2')
    if (w%status == TRIBO_OK) w%status = c_system_chain(sys, int(n, c_size_t), limit, alpha, omega)
    call blame(w, 'limit', limit)
    call blame(w, 'alpha', alpha)
    call blame(w, 'omega', omega)
    call adopt_system(this, w, sys)
    call finish(w, stat, errmsg)
  end subroutine chain

  !> Two blocks, the upper on the lower, the lower on a belt that moves with speed*sin(omega*t): contact 1 is between belt and
  !> lower block (limit1), contact 2 between the blocks (limit2); kappa is the stiffness of the upper spring. Eq. 7, Fig. 10.
  subroutine belt(this, kappa, limit1, limit2, speed, omega, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: kappa, limit1, limit2, speed, omega
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    type(c_ptr) :: sys

    w%status = c_system_belt(sys, kappa, limit1, limit2, speed, omega)
    call blame(w, 'limit1', limit1)
    call blame(w, 'limit2', limit2)
    call blame(w, 'kappa', kappa)
    call blame(w, 'speed', speed)
    call blame(w, 'omega', omega)
    call adopt_system(this, w, sys)
    call finish(w, stat, errmsg)
  end subroutine belt

  !> Adds a harmonic to the load, p(t) = ... + cosine*cos(omega*t) + sine*sin(omega*t); forces on the degrees of freedom of the
  !> matrices given, also for a reduced system.
  subroutine add_load(this, omega, cosine, sine, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: omega
    real(dp), intent(in), optional, contiguous :: cosine(:), sine(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    if (present(cosine)) call expect_size(w, 'cosine', cosine, w%given)
    if (present(sine)) call expect_size(w, 'sine', sine, w%given)
    if (w%status == TRIBO_OK) w%status = c_system_add_load(w%object, omega, cosine, sine)
    call finish(w, stat, errmsg)
  end subroutine add_load

  !> Adds a harmonic to the driven velocities of the contacts, b(t) = ... + cosine*cos(omega*t) + sine*sin(omega*t), as of a belt.
  subroutine add_base_motion(this, omega, cosine, sine, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: omega
    real(dp), intent(in), optional, contiguous :: cosine(:), sine(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    if (present(cosine)) call expect_size(w, 'cosine', cosine, w%n)
    if (present(sine)) call expect_size(w, 'sine', sine, w%n)
    if (w%status == TRIBO_OK) w%status = c_system_add_base_motion(w%object, omega, cosine, sine)
    call finish(w, stat, errmsg)
  end subroutine add_base_motion

  !> Adds a harmonic to the limits, limit(t) = max(0, ... + cosine*cos(omega*t) + sine*sin(omega*t)), e.g. of a normal load that
  !! changes: mu times it. At 0 the contact has lifted off. They are added to the limits of the context, or of the table.
  subroutine add_limit(this, omega, cosine, sine, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: omega
    real(dp), intent(in), optional, contiguous :: cosine(:), sine(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    if (present(cosine)) call expect_size(w, 'cosine', cosine, w%n)
    if (present(sine)) call expect_size(w, 'sine', sine, w%n)
    if (w%status == TRIBO_OK) w%status = c_system_add_limit(w%object, omega, cosine, sine)
    call finish(w, stat, errmsg)
  end subroutine add_limit

  !> Removes all loads, harmonics and tables, also the loads of a new system. Base motions and limits stay.
  subroutine clear_loads(this, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    if (w%status == TRIBO_OK) w%status = c_system_clear_loads(w%object)
    call finish(w, stat, errmsg)
  end subroutine clear_loads

  !> Removes all base motions.
  subroutine clear_base_motion(this, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    if (w%status == TRIBO_OK) w%status = c_system_clear_base_motion(w%object)
    call finish(w, stat, errmsg)
  end subroutine clear_base_motion

  !> Removes the table and all harmonics of the limits: the limits of the context remain.
  subroutine clear_limits(this, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    if (w%status == TRIBO_OK) w%status = c_system_clear_limits(w%object)
    call finish(w, stat, errmsg)
  end subroutine clear_limits

  !> Adds a load that follows a table, p(t) = ... + pattern*value(t), with value linear between its knots at time, which ascends,
  !> and constant outside. pattern: as in add_load.
  subroutine add_load_table(this, time, value, pattern, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: time(:), value(:), pattern(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    call expect_size(w, 'value', value, size(time))
    call expect_size(w, 'pattern', pattern, w%given)
    if (w%status == TRIBO_OK) w%status = c_system_add_load_table(w%object, size(time, kind=c_size_t), time, value, pattern)
    call finish(w, stat, errmsg)
  end subroutine add_load_table

  !> Adds driven velocities that follow a table, b(t) = ... + pattern(ncontact)*value(t), value as in add_load_table.
  subroutine add_base_table(this, time, value, pattern, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: time(:), value(:), pattern(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    call expect_size(w, 'value', value, size(time))
    call expect_size(w, 'pattern', pattern, w%n)
    if (w%status == TRIBO_OK) w%status = c_system_add_base_table(w%object, size(time, kind=c_size_t), time, value, pattern)
    call finish(w, stat, errmsg)
  end subroutine add_base_table

  !> limit(ncontact): the limits at time t, with harmonics or table.
  subroutine get_limit(this, t, limit, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: limit(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    call expect_size(w, 'limit', limit, w%n)
    if (w%status == TRIBO_OK) w%status = c_system_get_limit(w%object, t, limit)
    call finish(w, stat, errmsg)
  end subroutine get_limit

  !> Lets the limits follow a table, limit(ncontact,knots) >= 0, linear between its knots at time and constant outside,
  !> in place of the limits of the context.
  subroutine set_limit_table(this, time, limit, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: time(:), limit(:,:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    call expect_size(w, 'limit', limit, size(time), w%n)
    if (w%status == TRIBO_OK) w%status = c_system_set_limit_table(w%object, size(time, kind=c_size_t), time, limit)
    call finish(w, stat, errmsg)
  end subroutine set_limit_table

  !> Reduced systems: damping ratio >= 0 of every mode, C = diag(2*zeta*omega_k).
  subroutine set_damping_ratio(this, zeta, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: zeta
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    if (w%status == TRIBO_OK) w%status = c_system_set_damping_ratio(w%object, zeta)
    call finish(w, stat, errmsg)
  end subroutine set_damping_ratio

  !> Reduced systems: natural frequencies omega(ndof), ascending, rad/time.
  subroutine get_frequencies(this, omega, stat, errmsg)
    class(tribo_system), intent(in) :: this
    real(dp), intent(inout) :: omega(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    call expect_size(w, 'omega', omega, this%ndof())
    if (w%status == TRIBO_OK) w%status = c_system_get_frequencies(w%object, omega)
    call finish(w, stat, errmsg)
  end subroutine get_frequencies

  !> Reduced systems: displacements full of the whole structure from the modal ones, reduced(ndof).
  subroutine expand(this, reduced, full, stat, errmsg)
    class(tribo_system), intent(in) :: this
    real(dp), intent(in) :: reduced(:)
    real(dp), intent(inout) :: full(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    call expect_size(w, 'reduced', reduced, this%ndof())
    call expect_size(w, 'full', full, w%given)
    if (w%status == TRIBO_OK) w%status = c_system_expand(w%object, reduced, full)
    call finish(w, stat, errmsg)
  end subroutine expand

  !> Reduced systems: a bound of the error at the contacts up to the frequency omega, as a part of the work of the contact forces
  !> on the whole elastic structure.
  subroutine get_truncation(this, omega, error, stat, errmsg)
    class(tribo_system), intent(in) :: this
    real(dp), intent(in) :: omega
    real(dp), intent(inout) :: error
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    real(dp) :: found(1)

    call find_system(this, w)
    found = error
    if (w%status == TRIBO_OK) w%status = c_system_get_truncation(w%object, omega, found)
    error = found(1)
    call finish(w, stat, errmsg)
  end subroutine get_truncation

  !> Sizes; 0 for a system that has not been created. dimension: values of a state. Arrays may be declared with these functions.
  pure integer function ndof(this)
    class(tribo_system), intent(in) :: this
    ndof = int(c_fortran_ndof(object_of(this)))
  end function ndof

  pure integer function ncontact(this)
    class(tribo_system), intent(in) :: this
    ncontact = int(c_fortran_ncontact(object_of(this)))
  end function ncontact

  pure integer function dimension(this)
    class(tribo_system), intent(in) :: this
    dimension = int(c_fortran_dimension(object_of(this)))
  end function dimension

  !> Makes c the settings of the system's contacts, borrowed: set law, limits, epsilon and coupling there. The system reads c and
  !> never writes into it. Its operator is the system's, and fixed. c is as if destroyed when the system is destroyed; c%destroy
  !> does nothing to the system.
  subroutine context(this, c, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    type(tribo_context), intent(inout) :: c
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: held
    type(work) :: w

    call find_system(this, w)
    held => system_of(this)
    if (w%status == TRIBO_OK) call lend(c, held%context)
    call finish(w, stat, errmsg)
  end subroutine context

  !> For integrators of the caller's: dydt(dimension), and the Jacobian dfdy(i,j) = d(dydt(i))/d(y(j)), dfdt(i) = d(dydt(i))/dt. See
  !> accept.
  subroutine derivative(this, t, y, dydt, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(inout) :: dydt(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    call expect_size(w, 'y', y, w%dimension)
    call expect_size(w, 'dydt', dydt, w%dimension)
    if (w%status == TRIBO_OK) w%status = c_system_derivative(w%object, t, y, dydt)
    call finish(w, stat, errmsg)
  end subroutine derivative

  subroutine jacobian(this, t, y, dfdy, dfdt, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(inout) :: dfdy(:,:), dfdt(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    call expect_size(w, 'y', y, w%dimension)
    call expect_size(w, 'dfdy', dfdy, w%dimension)
    call expect_size(w, 'dfdt', dfdt, w%dimension)
    if (w%status == TRIBO_OK) then
      w%status = c_system_jacobian(w%object, t, y, dfdy, dfdt)
      if (w%status == TRIBO_OK) call transpose_in_place(dfdy)
    end if
    call finish(w, stat, errmsg)
  end subroutine jacobian

  !> Velocities v, feq and forces f of the contacts in a state, as balance of a context has them.
  subroutine contacts(this, t, y, v, feq, f, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(inout), optional, contiguous :: v(:), feq(:), f(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    call expect_size(w, 'y', y, w%dimension)
    if (present(v)) call expect_size(w, 'v', v, w%n)
    if (present(feq)) call expect_size(w, 'feq', feq, w%n)
    if (present(f)) call expect_size(w, 'f', f, w%n)
    if (w%status == TRIBO_OK) w%status = c_system_contacts(w%object, t, y, v, feq, f)
    call finish(w, stat, errmsg)
  end subroutine contacts

  !> slip(ncontact), TRIBO_SLIP_...: states of the contacts when the system last computed forces by the law, as contacts does.
  subroutine get_slip(this, slip, stat, errmsg)
    class(tribo_system), intent(in) :: this
    integer, intent(inout) :: slip(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    integer(c_signed_char) :: small(size(slip))
    type(work) :: w

    call find_system(this, w)
    call expect_shape(w, 'slip', shape(slip), [w%n])
    if (w%status == TRIBO_OK) w%status = c_system_get_slip(w%object, small)
    if (w%status == TRIBO_OK) slip = int(small)
    call finish(w, stat, errmsg)
  end subroutine get_slip

  !> TRIBO_COUNT_... of a context, of the same calls.
  subroutine get_system_count(this, which, value, stat, errmsg)
    class(tribo_system), intent(in) :: this
    integer, intent(in) :: which
    integer, intent(inout) :: value
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    integer(c_size_t) :: count
    type(work) :: w

    call find_system(this, w)
    if (w%status == TRIBO_OK) w%status = c_system_get_count(w%object, to_int(which), count)
    if (w%status == TRIBO_OK) value = int(min(count, int(huge(value), c_size_t)))
    call finish(w, stat, errmsg)
  end subroutine get_system_count

  !> Equilibrium of steady sliding at which contacts rest as in y, and its exponents; see tribo_system_equilibrium. y(dimension),
  !> slip(ncontact), count exponents re(2 ndof), im(2 ndof); given(ncontact): directions of sliding, 0: as found.
  subroutine equilibrium(this, y, slip, count, re, im, given, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(inout) :: y(:), re(:), im(:)
    integer, intent(inout) :: slip(:), count
    integer, intent(in), optional :: given(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    integer(c_signed_char) :: small(size(slip)), directions(size(slip))
    integer(c_size_t) :: exponents
    type(work) :: w

    call find_system(this, w)
    call expect_size(w, 'y', y, w%dimension)
    call expect_shape(w, 'slip', shape(slip), [w%n])
    call expect_size(w, 're', re, 2*w%ndof)
    call expect_size(w, 'im', im, 2*w%ndof)
    directions = 0_c_signed_char
    if (present(given)) then
      call expect_shape(w, 'given', shape(given), [w%n])
      if (w%status == TRIBO_OK) directions = int(max(-9, min(given, 9)), c_signed_char)
    end if
    if (w%status == TRIBO_OK) w%status = c_system_equilibrium(w%object, directions, y, small, exponents, re, im)
    if (w%status == TRIBO_OK) slip = int(small)
    if (w%status == TRIBO_OK) count = int(exponents)
    call finish(w, stat, errmsg)
  end subroutine equilibrium

  !> The first factor of TRIBO_FLUTTER_... between bounds at which steady sliding is not stable, and the frequency there; see
  !> tribo_system_find_flutter. given, y: as in equilibrium.
  subroutine find_flutter(this, parameter, from, to, critical, omega, given, y, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    integer, intent(in) :: parameter
    real(dp), intent(in) :: from, to
    real(dp), intent(inout) :: critical, omega
    integer, intent(in), optional :: given(:)
    real(dp), intent(in), optional, contiguous :: y(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    integer(c_signed_char), allocatable :: directions(:)
    type(work) :: w
    real(dp) :: factor(1), frequency(1)

    call find_system(this, w)
    if (present(y)) call expect_size(w, 'y', y, w%dimension)
    allocate(directions(max(w%n, 0)), source=0_c_signed_char)
    if (present(given)) then
      call expect_shape(w, 'given', shape(given), [w%n])
      if (w%status == TRIBO_OK) directions = int(max(-9, min(given, 9)), c_signed_char)
    end if
    factor = critical
    frequency = omega
    if (w%status == TRIBO_OK) then
      w%status = c_system_find_flutter(w%object, to_int(parameter), directions, y, from, to, factor, frequency)
    end if
    critical = factor(1)
    omega = frequency(1)
    call finish(w, stat, errmsg)
  end subroutine find_flutter

  !> accept of the context for the state (t, y): to be called after each accepted step by integrators other than tribo_driver.
  subroutine accept(this, t, y, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: t, y(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_system(this, w)
    call expect_size(w, 'y', y, w%dimension)
    if (w%status == TRIBO_OK) w%status = c_system_accept(w%object, t, y)
    call finish(w, stat, errmsg)
  end subroutine accept

  !> The text of the last error on the system or a driver of it; empty before any.
  function system_message(this) result(text)
    class(tribo_system), intent(in) :: this
    character(len=:), allocatable :: text
    type(work) :: w

    call find_system(this, w)
    call message_of(w, text)
  end function system_message

  ! -------------------------------------------------------------------------------------------------------------------- drivers

  !> A driver of a system by a method, in any case of letters, and its settings as far as they are given. Coulomb's law: exact,
  !> event, auto; central/fixed, moreau/fixed. The law of the context: rk4/fixed; with GSL adaptive rk2, rk4, rkf45, rkck,
  !> rk8pd, rk1imp, rk2imp, rk4imp, bsimp, msadams, msbdf. Methods with fixed steps need step; other settings have defaults.
  !> step      see set_step; abstol, reltol: see set_tolerance, reltol where absent 0; output: see set_output;
  !> max_step  see set_max_step. A method that does not take one of them refuses it, TRIBO_ERR_UNSUPPORTED
  subroutine create(this, sys, method, step, abstol, reltol, output, max_step, stat, errmsg)
    class(tribo_driver), intent(inout) :: this
    class(tribo_system), intent(inout) :: sys
    character(len=*), intent(in) :: method
    real(dp), intent(in), optional :: step, abstol, reltol, output, max_step
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_driver), pointer :: held
    type(work) :: w
    type(c_ptr) :: drv

    call find_system(sys, w)
    if (present(reltol) .and. .not. present(abstol)) call fail(w, TRIBO_ERR_NULL, 'reltol is given, but abstol is not')
    if (w%status == TRIBO_OK) w%status = c_fortran_driver_create(drv, w%object, trim(method) // c_null_char)
    if (w%status == TRIBO_OK) call set_all(w, drv, step, abstol, reltol, output, max_step)
    if (w%status == TRIBO_OK) then
      allocate (held)
      held%drv = drv
      held%system => system_of(sys)
      held%system%users = held%system%users + 1
      w%status = adopt(this, c_loc(held), c_funloc(release_driver))
      if (w%status /= TRIBO_OK) call release_driver(c_loc(held))
    end if
    call finish(w, stat, errmsg)
  end subroutine create

  !> Settings of a new driver, as far as they are given; on error destroys it.
  subroutine set_all(w, drv, step, abstol, reltol, output, max_step)
    type(work), intent(inout) :: w
    type(c_ptr), intent(in) :: drv
    real(dp), intent(in), optional :: step, abstol, reltol, output, max_step
    real(dp) :: relative

    relative = 0
    if (present(reltol)) relative = reltol
    if (present(step)) w%status = c_driver_set_step(drv, step)
    if (w%status == TRIBO_OK .and. present(abstol)) w%status = c_driver_set_tolerance(drv, abstol, relative)
    if (w%status == TRIBO_OK .and. present(output)) w%status = c_driver_set_output(drv, output)
    if (w%status == TRIBO_OK .and. present(max_step)) w%status = c_driver_set_max_step(drv, max_step)
    if (w%status == TRIBO_OK) return
    call to_text(c_driver_message(drv), w%text)
    call c_driver_destroy(drv)
  end subroutine set_all

  !> Name of the method; for auto, of the method in use. Empty for a driver that has not been created.
  function method(this) result(text)
    class(tribo_driver), intent(in) :: this
    character(len=:), allocatable :: text
    type(work) :: w

    call find_driver(this, w)
    if (w%status == TRIBO_OK) then
      call to_text(c_driver_method(w%object), text)
    else
      text = ''
    end if
  end function method

  !> Whether this build has a feature, TRIBO_FEATURE_...
  logical function tribo_dynamics_has(feature)
    integer, intent(in) :: feature
    tribo_dynamics_has = c_dynamics_has(to_int(feature)) /= 0
  end function tribo_dynamics_has

  !> Names of the methods, method 0 to tribo_method_count() - 1; empty outside.
  integer function tribo_method_count()
    tribo_method_count = int(c_fortran_method_count())
  end function tribo_method_count

  function tribo_method_name(method) result(text)
    integer, intent(in) :: method
    character(len=:), allocatable :: text
    call to_text(c_fortran_method_name(to_int(method)), text)
  end function tribo_method_name

  !> Integrates from t to t1 >= t; y, the system and its context's settings may be changed between calls. On error t and y hold
  !> the last good step.
  subroutine advance(this, t, t1, y, stat, errmsg)
    class(tribo_driver), intent(inout) :: this
    real(dp), intent(inout) :: t, y(:)
    real(dp), intent(in) :: t1
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    real(dp) :: time(1)

    call find_driver(this, w)
    call expect_size(w, 'y', y, w%dimension)
    if (w%status == TRIBO_OK) then
      time = t
      w%status = c_driver_advance(w%object, time, t1, y)
      t = time(1)
    end if
    call finish(w, stat, errmsg)
  end subroutine advance

  !> One of TRIBO_COUNT_STEPS, _REJECTED, _EVALUATIONS, _JACOBIANS, _EVENTS, _PERIODS, _NEWTON, _RESTED, since creation.
  subroutine count_long(this, which, value, stat, errmsg)
    class(tribo_driver), intent(in) :: this
    integer, intent(in) :: which
    integer(int64), intent(inout) :: value
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call get_count(this, which, huge(value), value, w)
    call finish(w, stat, errmsg)
  end subroutine count_long

  subroutine count_short(this, which, value, stat, errmsg)
    class(tribo_driver), intent(in) :: this
    integer, intent(in) :: which
    integer(int32), intent(inout) :: value
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    integer(int64) :: long

    long = 0
    call get_count(this, which, int(huge(value), int64), long, w)
    if (w%status == TRIBO_OK) value = int(long, int32)
    call finish(w, stat, errmsg)
  end subroutine count_short

  subroutine get_count(this, which, most, value, w)
    class(tribo_driver), intent(in) :: this
    integer, intent(in) :: which
    integer(int64), intent(in) :: most
    integer(int64), intent(inout) :: value
    type(work), intent(out) :: w
    integer(c_size_t) :: count

    call find_driver(this, w)
    if (w%status == TRIBO_OK) w%status = c_driver_count(w%object, to_int(which), count)
    if (w%status /= TRIBO_OK) return
    if (count > most) then
      call fail(w, TRIBO_ERR_SIZE, 'the count is too large for the kind of value')
    else
      value = int(count, int64)
    end if
  end subroutine get_count

  !> One of TRIBO_REAL_EXCESS, _BACKSLIP.
  subroutine driver_real(this, which, value, stat, errmsg)
    class(tribo_driver), intent(in) :: this
    integer, intent(in) :: which
    real(dp), intent(inout) :: value
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    real(dp) :: found(1)

    call find_driver(this, w)
    if (w%status == TRIBO_OK) w%status = c_driver_real(w%object, to_int(which), found)
    if (w%status == TRIBO_OK) value = found(1)
    call finish(w, stat, errmsg)
  end subroutine driver_real

  !> find_periodic is about a ring of equal sectors from now on, sectors 0: no ring; see tribo_driver_set_ring.
  subroutine set_ring(this, sectors, order, stat, errmsg)
    class(tribo_driver), intent(inout) :: this
    integer, intent(in) :: sectors, order
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_driver(this, w)
    call expect_count(w, 'sectors', sectors)
    call expect_count(w, 'order', order)
    if (w%status == TRIBO_OK) w%status = c_driver_set_ring(w%object, int(sectors, c_size_t), int(order, c_size_t))
    call finish(w, stat, errmsg)
  end subroutine set_ring

  !> A periodic motion, from a guess y; see tribo_driver_find_periodic.
  subroutine find_periodic(this, t, period, y, stat, errmsg)
    class(tribo_driver), intent(inout) :: this
    real(dp), intent(in) :: t, period
    real(dp), intent(inout) :: y(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_driver(this, w)
    call expect_size(w, 'y', y, w%dimension)
    if (w%status == TRIBO_OK) w%status = c_driver_find_periodic(w%object, t, period, y)
    call finish(w, stat, errmsg)
  end subroutine find_periodic

  !> A cycle and its period, from guesses of both in period, or 0, and y; see tribo_driver_find_cycle.
  subroutine find_cycle(this, t, period, y, stat, errmsg)
    class(tribo_driver), intent(inout) :: this
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: period, y(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    real(dp) :: found(1)

    call find_driver(this, w)
    call expect_size(w, 'y', y, w%dimension)
    found = period
    if (w%status == TRIBO_OK) w%status = c_driver_find_cycle(w%object, t, found, y)
    period = found(1)
    call finish(w, stat, errmsg)
  end subroutine find_cycle

  !> A nonlinear mode of this amplitude of the signal c, from a guess omega, or 0, zeta and y; see tribo_driver_find_mode.
  subroutine find_mode(this, c, amplitude, omega, zeta, y, stat, errmsg)
    class(tribo_driver), intent(inout) :: this
    real(dp), intent(in) :: c(:), amplitude
    real(dp), intent(inout) :: omega, zeta, y(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    real(dp) :: frequency(1), ratio(1)

    call find_driver(this, w)
    call expect_size(w, 'c', c, 2*w%ndof)
    call expect_size(w, 'y', y, w%dimension)
    frequency = omega
    ratio = zeta
    if (w%status == TRIBO_OK) w%status = c_driver_find_mode(w%object, c, amplitude, frequency, ratio, y)
    omega = frequency(1)
    zeta = ratio(1)
    call finish(w, stat, errmsg)
  end subroutine find_mode

  !> Follows periodic motions over a parameter, from guesses period and y, which become those of the last point; see
  !> tribo_driver_follow_curve. Each point is shown to observer%seen, see tribo_curve_observer.
  subroutine follow_curve(this, curve, t, period, y, observer, stat, errmsg)
    class(tribo_driver), intent(inout) :: this
    type(tribo_curve), intent(in) :: curve
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: period, y(:)
    class(tribo_curve_observer), intent(inout), target :: observer
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_curve), target :: held
    type(c_curve), target :: given
    real(dp), allocatable, target :: c(:)
    real(dp) :: found(1)
    type(work) :: w

    call find_driver(this, w)
    call expect_size(w, 'y', y, w%dimension)
    if (w%status == TRIBO_OK .and. curve%parameter == TRIBO_PARAMETER_LIMIT) call expect_index(w, 'contact', 1, curve%contact, w%n)
    given%size = c_sizeof(given)
    given%motion = to_int(curve%motion)
    given%parameter = to_int(curve%parameter)
    given%index = int(max(curve%contact, 1) - 1, c_size_t)
    given%least = curve%least
    given%most = curve%most
    given%step = curve%step
    given%points = int(max(curve%points, 0), c_size_t)
    given%coarse = merge(1_c_int, 0_c_int, curve%coarse)
    given%amplitude = curve%amplitude
    given%c = c_null_ptr
    if (allocated(curve%c)) then
      call expect_size(w, 'c', curve%c, 2*w%ndof)
      c = curve%c
      given%c = c_loc(c)
    end if
    held%observer => observer
    held%dimension = w%dimension
    found = period
    if (w%status == TRIBO_OK) then
      w%status = c_driver_follow_curve(w%object, c_loc(given), t, found, y, c_funloc(tell_point), c_loc(held))
    end if
    period = found(1)
    call finish(w, stat, errmsg)
  end subroutine follow_curve

  !> Floquet multipliers of the last periodic motion found, re and im (dimension - 1), the largest first.
  subroutine get_multipliers(this, re, im, stat, errmsg)
    class(tribo_driver), intent(in) :: this
    real(dp), intent(inout) :: re(:), im(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_driver(this, w)
    call expect_size(w, 're', re, w%dimension - 1)
    call expect_size(w, 'im', im, w%dimension - 1)
    if (w%status == TRIBO_OK) w%status = c_driver_get_multipliers(w%object, re, im)
    call finish(w, stat, errmsg)
  end subroutine get_multipliers

  !> The dimension of the family that the last periodic motion found belongs to; see tribo_driver_get_freedom.
  subroutine get_freedom(this, freedom, stat, errmsg)
    class(tribo_driver), intent(in) :: this
    integer, intent(inout) :: freedom
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    integer(c_size_t) :: found

    call find_driver(this, w)
    if (w%status == TRIBO_OK) w%status = c_driver_get_freedom(w%object, found)
    if (w%status == TRIBO_OK) freedom = int(found)
    call finish(w, stat, errmsg)
  end subroutine get_freedom

  !> The extremes over that period of c(1:ndof)*q + c(ndof+1:2*ndof)*q', and their times from the t of find_periodic on.
  subroutine period_extremes(this, c, least, most, at_least, at_most, stat, errmsg)
    class(tribo_driver), intent(in) :: this
    real(dp), intent(in) :: c(:)
    real(dp), intent(inout) :: least, most
    real(dp), intent(inout), optional :: at_least, at_most
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    real(dp) :: low(1), high(1), at_low(1), at_high(1)

    call find_driver(this, w)
    call expect_size(w, 'c', c, 2*w%ndof)
    if (w%status == TRIBO_OK) w%status = c_driver_period_extremes(w%object, c, low, high, at_low, at_high)
    if (w%status == TRIBO_OK) then
      least = low(1)
      most = high(1)
      if (present(at_least)) at_least = at_low(1)
      if (present(at_most)) at_most = at_high(1)
    end if
    call finish(w, stat, errmsg)
  end subroutine period_extremes

  !> Its harmonic k >= 0, cosine*cos(k*2*pi*t/period) + sine*sin(k*2*pi*t/period).
  subroutine period_harmonic(this, c, k, cosine, sine, stat, errmsg)
    class(tribo_driver), intent(in) :: this
    real(dp), intent(in) :: c(:)
    integer, intent(in) :: k
    real(dp), intent(inout) :: cosine, sine
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    real(dp) :: re(1), im(1)

    call find_driver(this, w)
    call expect_size(w, 'c', c, 2*w%ndof)
    call expect_count(w, 'k', k)
    if (w%status == TRIBO_OK) w%status = c_driver_period_harmonic(w%object, c, int(k, c_size_t), re, im)
    if (w%status == TRIBO_OK) then
      cosine = re(1)
      sine = im(1)
    end if
    call finish(w, stat, errmsg)
  end subroutine period_harmonic

  !> Energy that each contact dissipates in that period, energy(ncontact).
  subroutine period_dissipation(this, energy, stat, errmsg)
    class(tribo_driver), intent(in) :: this
    real(dp), intent(inout) :: energy(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_driver(this, w)
    call expect_size(w, 'energy', energy, w%n)
    if (w%status == TRIBO_OK) w%status = c_driver_period_dissipation(w%object, energy)
    call finish(w, stat, errmsg)
  end subroutine period_dissipation

  !> Share of that period for which each contact rests, share(ncontact).
  subroutine period_stick(this, share, stat, errmsg)
    class(tribo_driver), intent(in) :: this
    real(dp), intent(inout) :: share(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_driver(this, w)
    call expect_size(w, 'share', share, w%n)
    if (w%status == TRIBO_OK) w%status = c_driver_period_stick(w%object, share)
    call finish(w, stat, errmsg)
  end subroutine period_stick

  !> contact = index - 1, as C counts contacts; refuses an index of TRIBO_PARAMETER_LIMIT that is not in 1 to w%n.
  subroutine to_contacts(w, kind, index, contact)
    type(work), intent(inout) :: w
    integer, intent(in) :: kind(:), index(:)
    integer(c_size_t), intent(out) :: contact(:)
    integer :: i

    do i = 1, min(size(kind), size(index))
      if (kind(i) == TRIBO_PARAMETER_LIMIT) call expect_index(w, 'index', i, index(i), w%n)
      contact(i) = int(max(index(i), 1) - 1, c_size_t)
    end do
  end subroutine to_contacts

  !> Derivatives of that motion by parameters, kind(n) TRIBO_PARAMETER_... and index(n), the contacts of limits: of the extremes of
  !> period_extremes for c, extremes(2,n), of the energies of period_dissipation, energy(ncontact,n), and of its state, y(dimension,n).
  subroutine period_derivatives(this, kind, index, c, extremes, energy, y, stat, errmsg)
    class(tribo_driver), intent(in) :: this
    integer, intent(in) :: kind(:), index(:)
    real(dp), intent(in), optional, contiguous :: c(:)
    real(dp), intent(inout), optional, contiguous :: extremes(:,:), energy(:,:), y(:,:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    integer(c_size_t) :: contact(size(index))
    type(work) :: w
    integer :: n

    n = size(kind)
    call find_driver(this, w)
    call expect_shape(w, 'index', shape(index), shape(kind))
    if (present(c)) call expect_size(w, 'c', c, 2*w%ndof)
    if (present(extremes)) call expect_shape(w, 'extremes', shape(extremes), [2, n])
    if (present(energy)) call expect_shape(w, 'energy', shape(energy), [w%n, n])
    if (present(y)) call expect_shape(w, 'y', shape(y), [w%dimension, n])
    call to_contacts(w, kind, index, contact)
    if (w%status == TRIBO_OK) then
      w%status = c_driver_period_derivatives(w%object, int(n, c_size_t), to_int(kind), contact, c, extremes, energy, y)
    end if
    call finish(w, stat, errmsg)
  end subroutine period_derivatives

  !> Derivatives of multiplier `which` (from 1, in the order of get_multipliers) of that motion by parameters, kind(n)
  !> TRIBO_PARAMETER_... and index(n), the contacts of limits: of its real and imaginary part, re(n), im(n).
  subroutine multiplier_derivatives(this, which, kind, index, re, im, stat, errmsg)
    class(tribo_driver), intent(in) :: this
    integer, intent(in) :: which, kind(:), index(:)
    real(dp), intent(inout) :: re(:), im(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    integer(c_size_t) :: contact(size(index))
    type(work) :: w

    call find_driver(this, w)
    call expect_shape(w, 'index', shape(index), shape(kind))
    call expect_shape(w, 're', shape(re), shape(kind))
    call expect_shape(w, 'im', shape(im), shape(kind))
    call expect_index(w, 'which', 1, which, w%dimension - 1)
    call to_contacts(w, kind, index, contact)
    if (w%status == TRIBO_OK) then
      w%status = c_driver_multiplier_derivatives(w%object, int(which - 1, c_size_t), int(size(kind), c_size_t), to_int(kind), &
        contact, re, im)
    end if
    call finish(w, stat, errmsg)
  end subroutine multiplier_derivatives

  !> Advances call observer%seen, see tribo_observer; without observer, none. The observer must have the attribute target (or be a
  !> pointer) where it is declared, and must outlive its use.
  subroutine set_observer(this, observer, stat, errmsg)
    class(tribo_driver), intent(inout) :: this
    class(tribo_observer), intent(inout), optional, target :: observer
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_driver), pointer :: held
    type(work) :: w
    type(c_funptr) :: call_back

    call find_driver(this, w)
    if (w%status == TRIBO_OK) then
      held => driver_of(this)
      nullify (held%observer)
      call_back = c_null_funptr
      if (present(observer)) then
        held%observer => observer
        call_back = c_funloc(tell_observer)
      end if
      w%status = c_driver_set_observer(held%drv, call_back, c_loc(held))
    end if
    call finish(w, stat, errmsg)
  end subroutine set_observer

  !> The step dt > 0 of a method with fixed steps; the first one of an adaptive method.
  subroutine set_step(this, dt, stat, errmsg)
    class(tribo_driver), intent(inout) :: this
    real(dp), intent(in) :: dt
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_driver(this, w)
    if (w%status == TRIBO_OK) w%status = c_driver_set_step(w%object, dt)
    call finish(w, stat, errmsg)
  end subroutine set_step

  !> event, auto and adaptive methods: the error of a step, below abstol + reltol times the largest displacement, velocity, or the
  !> energy; abstol > 0, reltol >= 0.
  subroutine set_tolerance(this, abstol, reltol, stat, errmsg)
    class(tribo_driver), intent(inout) :: this
    real(dp), intent(in) :: abstol, reltol
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_driver(this, w)
    if (w%status == TRIBO_OK) w%status = c_driver_set_tolerance(w%object, abstol, reltol)
    call finish(w, stat, errmsg)
  end subroutine set_tolerance

  !> exact, event, auto: an observer also sees the motion every dt > 0 from the start of an advance on. Default: not.
  subroutine set_output(this, dt, stat, errmsg)
    class(tribo_driver), intent(inout) :: this
    real(dp), intent(in) :: dt
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_driver(this, w)
    if (w%status == TRIBO_OK) w%status = c_driver_set_output(w%object, dt)
    call finish(w, stat, errmsg)
  end subroutine set_output

  !> The largest step h > 0 of an adaptive method; by default 0.1 over the highest frequency of structure and loads, since while
  !> all contacts rest no estimate sees how long a step is. An infinite h: none.
  subroutine set_max_step(this, h, stat, errmsg)
    class(tribo_driver), intent(inout) :: this
    real(dp), intent(in) :: h
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call find_driver(this, w)
    if (w%status == TRIBO_OK) w%status = c_driver_set_max_step(w%object, h)
    call finish(w, stat, errmsg)
  end subroutine set_max_step

  !> The text of the last error on the driver or its system; empty before any.
  function driver_message(this) result(text)
    class(tribo_driver), intent(in) :: this
    character(len=:), allocatable :: text
    type(work) :: w

    call find_driver(this, w)
    call message_of(w, text)
  end function driver_message

  ! ------------------------------------------------------------------------------------------------------- helpers of the calls

  !> The record of a system or driver; null if it has not been created.
  function system_of(this) result(held)
    class(tribo_system), intent(in) :: this
    type(held_system), pointer :: held
    nullify (held)
    if (c_associated(object_of(this))) call c_f_pointer(object_of(this), held)
  end function system_of

  function driver_of(this) result(held)
    class(tribo_driver), intent(in) :: this
    type(held_driver), pointer :: held
    nullify (held)
    if (c_associated(object_of(this))) call c_f_pointer(object_of(this), held)
  end function driver_of

  !> Begin a call on a system or driver.
  subroutine find_system(this, w)
    class(tribo_system), intent(in) :: this
    type(work), intent(out) :: w
    type(held_system), pointer :: held

    w%kind = 'system'
    held => system_of(this)
    if (associated(held)) call work_on(w, held, held%sys)
  end subroutine find_system

  subroutine find_driver(this, w)
    class(tribo_driver), intent(in) :: this
    type(work), intent(out) :: w
    type(held_driver), pointer :: held

    w%kind = 'driver'
    held => driver_of(this)
    if (.not. associated(held)) return
    call work_on(w, held%system, held%drv)
    w%found = c_driver_message(held%drv)
  end subroutine find_driver

  subroutine work_on(w, held, object)
    type(work), intent(inout) :: w
    type(held_system), intent(in) :: held
    type(c_ptr), intent(in) :: object

    w%object = object
    w%ctx = c_system_context(held%sys)
    w%found = c_system_message(held%sys)
    w%n = int(c_system_ncontact(held%sys))
    w%ndof = int(c_system_ndof(held%sys))
    w%dimension = int(c_system_dimension(held%sys))
    w%given = int(held%given)
    w%status = TRIBO_OK
  end subroutine work_on

  !> If w has no error, makes sys the object of this. given: degrees of freedom of the matrices, ndof where absent.
  subroutine adopt_system(this, w, sys, given)
    class(tribo_system), intent(inout) :: this
    type(work), intent(inout) :: w
    type(c_ptr), intent(in) :: sys
    integer, intent(in), optional :: given
    type(held_system), pointer :: held

    if (w%status /= TRIBO_OK) return
    allocate (held)
    held%sys = sys
    held%users = 1
    held%given = int(c_system_ndof(sys), c_int64_t)
    if (present(given)) held%given = given
    held%context = c_handle_add(c_system_context(sys), c_null_funptr)
    if (held%context == 0) w%status = TRIBO_ERR_MEMORY
    if (w%status == TRIBO_OK) w%status = adopt(this, c_loc(held), c_funloc(release_system))
    if (w%status /= TRIBO_OK) call release_system(c_loc(held))
  end subroutine adopt_system

  !> The variable is destroyed, and with it the number of the context.
  subroutine release_system(object) bind(c, name='')
    type(c_ptr), value :: object
    type(held_system), pointer :: held

    call c_f_pointer(object, held)
    call c_handle_drop(held%context)
    call leave(held)
  end subroutine release_system

  subroutine release_driver(object) bind(c, name='')
    type(c_ptr), value :: object
    type(held_driver), pointer :: held

    call c_f_pointer(object, held)
    call c_driver_destroy(held%drv)
    call leave(held%system)
    deallocate (held)
  end subroutine release_driver

  !> One user less; destroys the system after the last one.
  subroutine leave(held)
    type(held_system), pointer, intent(inout) :: held
    held%users = held%users - 1
    if (held%users > 0) return
    call c_system_destroy(held%sys)
    deallocate (held)
  end subroutine leave

  !> Calls the observer for the library. SIZE_MAX, the contact of a step, is -1 here.
  integer(c_int) function tell_observer(seen, data) bind(c, name='')
    type(c_moment), intent(in) :: seen
    type(c_ptr), value :: data
    type(held_driver), pointer :: held
    type(tribo_moment) :: moment

    call c_f_pointer(data, held)
    moment%t = seen%t
    moment%kind = int(seen%kind)
    moment%contact = int(seen%contact + 1)
    call c_f_pointer(seen%y, moment%y, [c_system_dimension(held%system%sys)])
    tell_observer = to_int(held%observer%seen(moment))
  end function tell_observer

  !> Calls the observer of a curve for the library. SIZE_MAX, no contact, is -1 here.
  integer(c_int) function tell_point(seen, data) bind(c, name='')
    type(c_curve_point), intent(in) :: seen
    type(c_ptr), value :: data
    type(held_curve), pointer :: held
    type(tribo_curve_point) :: point

    call c_f_pointer(data, held)
    point%parameter = seen%parameter
    point%t = seen%t
    point%period = seen%period
    point%zeta = seen%zeta
    point%kind = int(seen%kind)
    point%contact = int(seen%contact + 1)
    point%stable = int(seen%stable)
    call c_f_pointer(seen%y, point%y, [held%dimension])
    tell_point = to_int(held%observer%seen(point))
  end function tell_point

  impure elemental subroutine assign_system(to, from)
    class(tribo_system), intent(inout) :: to
    type(tribo_system), intent(in) :: from
    if (c_associated(object_of(from))) call refuse('system')
    call to%destroy()
  end subroutine assign_system

  impure elemental subroutine assign_driver(to, from)
    class(tribo_driver), intent(inout) :: to
    type(tribo_driver), intent(in) :: from
    if (c_associated(object_of(from))) call refuse('driver')
    call to%destroy()
  end subroutine assign_driver

  subroutine refuse(kind)
    character(len=*), intent(in) :: kind
    type(work) :: w
    w%status = TRIBO_ERR_UNSUPPORTED
    w%text = 'a ' // kind // ' cannot be copied'
    call finish(w)
  end subroutine refuse

end module tribo_systems

!> The module for programs: the module above, and the constants of tribo_dynamics.h.
module tribo_dynamics
  use tribo_dynamics_constants
  use tribo_systems
  implicit none
  public
end module tribo_dynamics
