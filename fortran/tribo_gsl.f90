!> tribo with GSL: mechanical systems with friction, and their integration in time. To be used together with module tribo.
!>
!> A system is M q'' + C q' + K q = p(t) + J' f, v = J q' - b(t), with p and b sums of harmonics and tables; f are the friction
!> forces of its contacts, and v their relative velocities. Its state is y = q(ndof), q'(ndof), energy dissipated by friction
!> since t = 0: 2*ndof + 1 values.
!>
!>     use tribo
!>     use tribo_gsl
!>     type(tribo_system) :: chain
!>     type(tribo_driver) :: driver
!>     call chain%chain(20, limit=0.1_dp, alpha=1.0_dp, omega=0.5_dp)
!>     allocate (y(chain%dimension()), source=0.0_dp)
!>     call driver%create(chain, 'exact', dt=0.1_dp)
!>     call driver%advance(t, t1, y)
!>
!> Arguments, errors and threads as in module tribo; a system and its drivers belong to one thread. What creates a system or a
!> driver puts it in the place of the one before, and leaves that if it fails. Systems and drivers cannot be copied: an assignment
!> stops the program. A driver keeps its system alive: it goes on working when the variable has gone.
!>
!> GSL is under the GPL, and so is what is linked with libtribo_gsl.
module tribo_gsl
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_double, c_f_pointer, c_funloc, c_funptr, c_int, c_int64_t, c_loc, &
    c_null_char, c_null_funptr, c_null_ptr, c_ptr, c_size_t
  use, intrinsic :: iso_fortran_env, only: int32, int64
  use tribo, only: tribo_context
  use tribo_support
  implicit none
  private

  !> For count of a driver: since its creation.
  integer, parameter, public :: &
    TRIBO_COUNT_STEPS = 100, &       !< accepted steps
    TRIBO_COUNT_REJECTED = 101, &    !< steps tried and undone
    TRIBO_COUNT_EVALUATIONS = 102, & !< evaluations of the right-hand side
    TRIBO_COUNT_JACOBIANS = 103, &   !< evaluations of its Jacobian
    TRIBO_COUNT_EVENTS = 104         !< events located

  !> For real of a driver: how far the motion of "exact" and "event" has strayed from Coulomb's law since its creation.
  integer, parameter, public :: &
    TRIBO_REAL_EXCESS = 100, &       !< the largest force of a contact at rest beyond its limit
    TRIBO_REAL_BACKSLIP = 101        !< the largest velocity of a contact against the direction of its slip

  public :: tribo_method_count, tribo_method_name

  !> A sparse matrix.
  type, public :: tribo_sparse
    private
    integer :: rows = 0, columns = 0
    integer(c_int), allocatable :: first(:), col(:)
    real(dp), allocatable :: val(:)
  contains
    procedure :: set_csr, set_coo
  end type tribo_sparse

  type, extends(tribo_object), public :: tribo_system
  contains
    procedure :: oscillator, chain, belt
    procedure :: clone => clone_system
    procedure, private :: linear_dense, linear_sparse
    generic :: linear => linear_dense, linear_sparse
    procedure :: add_load, add_base_motion, add_load_table, add_limit
    procedure :: clear_loads
    procedure :: set_limit_table, set_damping_ratio
    procedure :: get_frequencies, expand
    procedure :: ndof, ncontact, dimension
    procedure :: context
    procedure :: derivative, jacobian
    procedure :: contacts, accept
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
    procedure :: set_observer
    procedure :: set_max_step
    procedure :: message => driver_message
    procedure, private :: assign_driver
    generic :: assignment(=) => assign_driver
  end type tribo_driver

  !> What watches a driver: a type of the caller's that extends this one, and so has the caller's data at hand.
  type, abstract, public :: tribo_observer
  contains
    procedure(seen), deferred :: seen
  end type tribo_observer

  abstract interface
    !> Called after every accepted step (event 0) and at events (event 1: a contact sticks, breaks away or reverses). What it
    !> answers ends the run unless 0. It must not change the system or the driver.
    integer function seen(this, t, y, event)
      import :: dp, tribo_observer
      class(tribo_observer), intent(inout) :: this
      real(dp), intent(in) :: t, y(:)
      integer, intent(in) :: event
    end function seen
  end interface

  !> The library's system with what Fortran needs to know of it: tribo_held of gsl.h. users counts the variable and the drivers.
  type, bind(c) :: held_system
    type(c_ptr) :: sys
    integer(c_int64_t) :: context, given, users
  end type held_system

  type :: held_driver
    type(c_ptr) :: drv
    type(held_system), pointer :: system
    class(tribo_observer), pointer :: observer => null()
  end type held_driver

  !> tribo_rows of gsl.h.
  type, bind(c) :: rows_of
    integer(c_size_t) :: rows, columns
    type(c_ptr) :: first, col, val
  end type rows_of

  interface
    function c_oscillator(sys, limit, alpha, omega) result(status) bind(c, name='tribo_system_oscillator')
      import :: c_double, c_int, c_ptr
      type(c_ptr), intent(inout) :: sys
      real(c_double), value :: limit, alpha, omega
      integer(c_int) :: status
    end function c_oscillator

    function c_chain(sys, n, limit, alpha, omega) result(status) bind(c, name='tribo_system_chain')
      import :: c_double, c_int, c_ptr, c_size_t
      type(c_ptr), intent(inout) :: sys
      integer(c_size_t), value :: n
      real(c_double), value :: limit, alpha, omega
      integer(c_int) :: status
    end function c_chain

    function c_belt(sys, kappa, limit1, limit2, speed, omega) result(status) bind(c, name='tribo_system_belt')
      import :: c_double, c_int, c_ptr
      type(c_ptr), intent(inout) :: sys
      real(c_double), value :: kappa, limit1, limit2, speed, omega
      integer(c_int) :: status
    end function c_belt

    function c_linear(sys, ndof, ncontact, mass, damping, stiffness, direction, nmode, message, size) result(status) &
      bind(c, name='tribo_system_linear')
      import :: c_char, c_double, c_int, c_ptr, c_size_t
      type(c_ptr), intent(inout) :: sys
      integer(c_size_t), value :: ndof, ncontact, nmode, size
      real(c_double), intent(in) :: mass(*), stiffness(*), direction(*)
      type(c_ptr), value :: damping
      character(kind=c_char), intent(inout) :: message(*)
      integer(c_int) :: status
    end function c_linear

    function c_linear_sparse(sys, mass, damping, stiffness, direction, nmode, message, size) result(status) &
      bind(c, name='tribo_fortran_linear')
      import :: c_char, c_int, c_ptr, c_size_t, rows_of
      type(c_ptr), intent(inout) :: sys
      type(rows_of), intent(in) :: mass, stiffness, direction
      type(c_ptr), value :: damping
      integer(c_size_t), value :: nmode, size
      character(kind=c_char), intent(inout) :: message(*)
      integer(c_int) :: status
    end function c_linear_sparse

    subroutine c_system_destroy(sys) bind(c, name='tribo_system_destroy')
      import :: c_ptr
      type(c_ptr), value :: sys
    end subroutine c_system_destroy

    function c_add_load(sys, omega, cosine, sine) result(status) bind(c, name='tribo_system_add_load')
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: sys, cosine, sine
      real(c_double), value :: omega
      integer(c_int) :: status
    end function c_add_load

    function c_add_base_motion(sys, omega, cosine, sine) result(status) bind(c, name='tribo_system_add_base_motion')
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: sys, cosine, sine
      real(c_double), value :: omega
      integer(c_int) :: status
    end function c_add_base_motion

    function c_add_limit(sys, omega, cosine, sine) result(status) bind(c, name='tribo_system_add_limit')
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: sys, cosine, sine
      real(c_double), value :: omega
      integer(c_int) :: status
    end function c_add_limit

    function c_clear_loads(sys) result(status) bind(c, name='tribo_system_clear_loads')
      import :: c_int, c_ptr
      type(c_ptr), value :: sys
      integer(c_int) :: status
    end function c_clear_loads

    function c_clone_system(sys, copy) result(status) bind(c, name='tribo_system_clone')
      import :: c_int, c_ptr
      type(c_ptr), value :: sys
      type(c_ptr), intent(inout) :: copy
      integer(c_int) :: status
    end function c_clone_system

    function c_add_load_table(sys, knots, time, value, pattern) result(status) bind(c, name='tribo_system_add_load_table')
      import :: c_double, c_int, c_ptr, c_size_t
      type(c_ptr), value :: sys
      integer(c_size_t), value :: knots
      real(c_double), intent(in) :: time(*), value(*), pattern(*)
      integer(c_int) :: status
    end function c_add_load_table

    function c_set_limit_table(sys, knots, time, limit) result(status) bind(c, name='tribo_system_set_limit_table')
      import :: c_double, c_int, c_ptr, c_size_t
      type(c_ptr), value :: sys
      integer(c_size_t), value :: knots
      real(c_double), intent(in) :: time(*), limit(*)
      integer(c_int) :: status
    end function c_set_limit_table

    function c_set_damping_ratio(sys, zeta) result(status) bind(c, name='tribo_system_set_damping_ratio')
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: sys
      real(c_double), value :: zeta
      integer(c_int) :: status
    end function c_set_damping_ratio

    function c_get_frequencies(sys, omega) result(status) bind(c, name='tribo_system_get_frequencies')
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: sys
      real(c_double), intent(inout) :: omega(*)
      integer(c_int) :: status
    end function c_get_frequencies

    function c_expand(sys, reduced, full) result(status) bind(c, name='tribo_system_expand')
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: sys
      real(c_double), intent(in) :: reduced(*)
      real(c_double), intent(inout) :: full(*)
      integer(c_int) :: status
    end function c_expand

    pure function c_held_ndof(held) result(n) bind(c, name='tribo_fortran_ndof')
      import :: c_ptr, c_size_t
      type(c_ptr), intent(in), value :: held
      integer(c_size_t) :: n
    end function c_held_ndof

    pure function c_held_ncontact(held) result(n) bind(c, name='tribo_fortran_ncontact')
      import :: c_ptr, c_size_t
      type(c_ptr), intent(in), value :: held
      integer(c_size_t) :: n
    end function c_held_ncontact

    function c_ndof(sys) result(n) bind(c, name='tribo_system_ndof')
      import :: c_ptr, c_size_t
      type(c_ptr), value :: sys
      integer(c_size_t) :: n
    end function c_ndof

    function c_ncontact(sys) result(n) bind(c, name='tribo_system_ncontact')
      import :: c_ptr, c_size_t
      type(c_ptr), value :: sys
      integer(c_size_t) :: n
    end function c_ncontact

    function c_context(sys) result(ctx) bind(c, name='tribo_system_context')
      import :: c_ptr
      type(c_ptr), value :: sys
      type(c_ptr) :: ctx
    end function c_context

    function c_derivative(sys, t, y, dydt) result(status) bind(c, name='tribo_fortran_derivative')
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: sys
      real(c_double), value :: t
      real(c_double), intent(in) :: y(*)
      real(c_double), intent(inout) :: dydt(*)
      integer(c_int) :: status
    end function c_derivative

    function c_jacobian(sys, t, y, dfdy, dfdt) result(status) bind(c, name='tribo_fortran_jacobian')
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: sys
      real(c_double), value :: t
      real(c_double), intent(in) :: y(*)
      real(c_double), intent(inout) :: dfdy(*), dfdt(*)
      integer(c_int) :: status
    end function c_jacobian

    function c_contacts(sys, t, y, v, feq, f) result(status) bind(c, name='tribo_system_contacts')
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: sys, v, feq, f
      real(c_double), value :: t
      real(c_double), intent(in) :: y(*)
      integer(c_int) :: status
    end function c_contacts

    function c_accept(sys, t, y) result(status) bind(c, name='tribo_system_accept')
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: sys
      real(c_double), value :: t
      real(c_double), intent(in) :: y(*)
      integer(c_int) :: status
    end function c_accept

    function c_driver_create(drv, sys, method, dt, abstol, reltol) result(status) bind(c, name='tribo_driver_create')
      import :: c_char, c_double, c_int, c_ptr
      type(c_ptr), intent(inout) :: drv
      type(c_ptr), value :: sys
      character(kind=c_char), intent(in) :: method(*)
      real(c_double), value :: dt, abstol, reltol
      integer(c_int) :: status
    end function c_driver_create

    subroutine c_driver_destroy(drv) bind(c, name='tribo_driver_destroy')
      import :: c_ptr
      type(c_ptr), value :: drv
    end subroutine c_driver_destroy

    function c_driver_method(drv) result(s) bind(c, name='tribo_driver_method')
      import :: c_ptr
      type(c_ptr), value :: drv
      type(c_ptr) :: s
    end function c_driver_method

    function c_method_count() result(count) bind(c, name='tribo_method_count')
      import :: c_int
      integer(c_int) :: count
    end function c_method_count

    function c_method_name(method) result(s) bind(c, name='tribo_method_name')
      import :: c_int, c_ptr
      integer(c_int), value :: method
      type(c_ptr) :: s
    end function c_method_name

    function c_advance(drv, t, t1, y) result(status) bind(c, name='tribo_driver_advance')
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: drv
      real(c_double), intent(inout) :: t, y(*)
      real(c_double), value :: t1
      integer(c_int) :: status
    end function c_advance

    function c_driver_real(drv, which, value) result(status) bind(c, name='tribo_driver_real')
      import :: c_ptr, c_int, c_double
      type(c_ptr), value :: drv
      integer(c_int), value :: which
      real(c_double), intent(inout) :: value
      integer(c_int) :: status
    end function c_driver_real

    function c_driver_count(drv, which, value) result(status) bind(c, name='tribo_driver_count')
      import :: c_int, c_ptr, c_size_t
      type(c_ptr), value :: drv
      integer(c_int), value :: which
      integer(c_size_t), intent(inout) :: value
      integer(c_int) :: status
    end function c_driver_count

    function c_set_observer(drv, seen, data) result(status) bind(c, name='tribo_driver_set_observer')
      import :: c_funptr, c_int, c_ptr
      type(c_ptr), value :: drv, data
      type(c_funptr), value :: seen
      integer(c_int) :: status
    end function c_set_observer

    function c_set_max_step(drv, h) result(status) bind(c, name='tribo_driver_set_max_step')
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: drv
      real(c_double), value :: h
      integer(c_int) :: status
    end function c_set_max_step

    function c_driver_message(drv) result(s) bind(c, name='tribo_driver_message')
      import :: c_ptr
      type(c_ptr), value :: drv
      type(c_ptr) :: s
    end function c_driver_message

    function c_copy_message(ctx, status, text) result(same_status) bind(c, name='tribo_set_message')
      import :: c_int, c_ptr
      type(c_ptr), value :: ctx, text
      integer(c_int), value :: status
      integer(c_int) :: same_status
    end function c_copy_message
  end interface

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
        if (row(k) < 1 .or. row(k) > rows) call fail_at(w, TRIBO_ERR_RANGE, 'row', k, row(k), 'is out of range')
        if (col(k) < 1 .or. col(k) > columns) call fail_at(w, TRIBO_ERR_RANGE, 'col', k, col(k), 'is out of range')
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
    this%first = int(rowptr - 1, c_int)
    this%col = int(col - 1, c_int)
    this%val = val
  end subroutine fill

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

    w%status = c_oscillator(sys, limit, alpha, omega)
    call adopt_system(this, w, sys)
    call finish(w, stat, errmsg)
  end subroutine oscillator

  !> A copy that shares nothing, with loads, motions, tables, and the context and its settings; e.g. one a thread.
  subroutine clone_system(this, copy, stat, errmsg)
    class(tribo_system), intent(in) :: this
    class(tribo_system), intent(inout) :: copy
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: held
    type(work) :: w
    type(c_ptr) :: sys

    call find_system(this, held, w)
    if (w%status == TRIBO_OK) then
      w%status = c_clone_system(held%sys, sys)
      call adopt_system(copy, w, sys, int(held%given))
    end if
    call finish(w, stat, errmsg)
  end subroutine clone_system

  !> n >= 2 blocks on a frictional surface, pulled by alpha*sin(omega*t) at the first one. Fig. 8. limit is the paper's mu N_i; the
  !> context keeps the paper's scaling, limits mu N_i and R = 1; the last entry of the state is the paper's D.
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
    if (w%status == TRIBO_OK) w%status = c_chain(sys, int(n, c_size_t), limit, alpha, omega)
    call adopt_system(this, w, sys)
    call finish(w, stat, errmsg)
  end subroutine chain

  !> Two blocks, the upper on the lower, the lower on a belt that moves with speed*sin(omega*t): contact 1 is between belt and lower
  !> block (limit1), contact 2 between the blocks (limit2); kappa is the stiffness of the upper spring. Eq. 7, Fig. 10.
  subroutine belt(this, kappa, limit1, limit2, speed, omega, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: kappa, limit1, limit2, speed, omega
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    type(c_ptr) :: sys

    w%status = c_belt(sys, kappa, limit1, limit2, speed, omega)
    call adopt_system(this, w, sys)
    call finish(w, stat, errmsg)
  end subroutine belt

  !> Any linear structure, from its matrices in the caller's units.
  !> mass       (ndof,ndof)      symmetric, positive definite; diagonal is fastest
  !> damping    (ndof,ndof)      none where absent
  !> stiffness  (ndof,ndof)      symmetric
  !> direction  (ncontact,ndof)  J: row i is how the velocities of the degrees of freedom make that of contact i
  !> nmode      keep only the motion in the nmode lowest modes of (K, M): q then holds their amplitudes (modes have modal mass 1),
  !>            ndof of the system is nmode, and damping must be absent (see set_damping_ratio)
  !> The context starts with Quinn's law and limit 0 (all contacts open), and with R = J M**-1 J'. No load, no motion yet.
  subroutine linear_dense(this, mass, stiffness, direction, damping, nmode, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: mass(:,:), stiffness(:,:), direction(:,:)
    real(dp), intent(in), optional :: damping(:,:)
    integer, intent(in), optional :: nmode
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    type(c_ptr) :: sys, at
    real(dp), allocatable, target :: given_damping(:,:)
    character(kind=c_char) :: message(240)
    integer :: n

    n = size(mass, 1)
    w%status = TRIBO_OK
    call expect_size(w, 'mass', mass, n)
    if (present(nmode)) call expect_count(w, 'nmode', nmode)
    call expect_size(w, 'stiffness', stiffness, n)
    call expect_size(w, 'direction', direction, n, size(direction, 1))
    at = c_null_ptr
    if (present(damping)) then
      call expect_size(w, 'damping', damping, n)
      given_damping = transpose(damping)
      if (size(damping) > 0) at = c_loc(given_damping)
    end if
    if (w%status == TRIBO_OK) then
      message = c_null_char
      w%status = c_linear(sys, int(n, c_size_t), size(direction, 1, c_size_t), transpose(mass), at, transpose(stiffness), &
        transpose(direction), modes(nmode), message, size(message, kind=c_size_t))
      call note(w, message)
    end if
    call adopt_system(this, w, sys, n)
    call finish(w, stat, errmsg)
  end subroutine linear_dense

  !> The same from sparse matrices. Without reduction a mass matrix that is not diagonal makes the system dense.
  subroutine linear_sparse(this, mass, stiffness, direction, damping, nmode, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    type(tribo_sparse), intent(in), target :: mass, stiffness, direction
    type(tribo_sparse), intent(in), optional, target :: damping
    integer, intent(in), optional :: nmode
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    type(rows_of), target :: rows
    type(c_ptr) :: sys, at
    character(kind=c_char) :: message(240)

    w%status = TRIBO_OK
    call expect_given(w, 'mass', mass)
    if (present(nmode)) call expect_count(w, 'nmode', nmode)
    call expect_given(w, 'stiffness', stiffness)
    call expect_given(w, 'direction', direction)
    at = c_null_ptr
    if (present(damping)) then
      call expect_given(w, 'damping', damping)
      if (w%status == TRIBO_OK) rows = borrowed(damping)
      at = c_loc(rows)
    end if
    if (w%status == TRIBO_OK) then
      message = c_null_char
      w%status = c_linear_sparse(sys, borrowed(mass), at, borrowed(stiffness), borrowed(direction), modes(nmode), message, &
        size(message, kind=c_size_t))
      call note(w, message)
    end if
    call adopt_system(this, w, sys, mass%rows)
    call finish(w, stat, errmsg)
  end subroutine linear_sparse

  !> Adds a harmonic to the load, p(t) = ... + cosine*cos(omega*t) + sine*sin(omega*t); forces on the degrees of freedom of the
  !> matrices given, also for a reduced system.
  subroutine add_load(this, omega, cosine, sine, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: omega
    real(dp), intent(in), optional, contiguous, target :: cosine(:), sine(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: held
    type(work) :: w
    type(c_ptr) :: at(2)

    call find_system(this, held, w)
    at = c_null_ptr
    if (w%status == TRIBO_OK) then
      if (present(cosine)) call find_input(w, 'cosine', cosine, int(held%given), at(1))
      if (present(sine)) call find_input(w, 'sine', sine, int(held%given), at(2))
    end if
    if (w%status == TRIBO_OK) w%status = c_add_load(held%sys, omega, at(1), at(2))
    call finish(w, stat, errmsg)
  end subroutine add_load

  !> Adds a harmonic to the driven velocities of the contacts, b(t) = ... + cosine*cos(omega*t) + sine*sin(omega*t), e.g. of a belt.
  subroutine add_base_motion(this, omega, cosine, sine, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: omega
    real(dp), intent(in), optional, contiguous, target :: cosine(:), sine(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: held
    type(work) :: w
    type(c_ptr) :: at(2)

    call find_system(this, held, w)
    at = c_null_ptr
    if (present(cosine)) call find_input(w, 'cosine', cosine, w%n, at(1))
    if (present(sine)) call find_input(w, 'sine', sine, w%n, at(2))
    if (w%status == TRIBO_OK) w%status = c_add_base_motion(held%sys, omega, at(1), at(2))
    call finish(w, stat, errmsg)
  end subroutine add_base_motion

  !> Adds a harmonic to the limits, limit(t) = max(0, ... + cosine*cos(omega*t) + sine*sin(omega*t)), e.g. of a normal load that
  !! changes: mu times it. At 0 the contact has lifted off. What is set in the context, or the table's, is what they are added to.
  subroutine add_limit(this, omega, cosine, sine, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: omega
    real(dp), intent(in), optional, contiguous, target :: cosine(:), sine(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: held
    type(work) :: w
    type(c_ptr) :: at(2)

    call find_system(this, held, w)
    at = c_null_ptr
    if (present(cosine)) call find_input(w, 'cosine', cosine, w%n, at(1))
    if (present(sine)) call find_input(w, 'sine', sine, w%n, at(2))
    if (w%status == TRIBO_OK) w%status = c_add_limit(held%sys, omega, at(1), at(2))
    call finish(w, stat, errmsg)
  end subroutine add_limit

  !> Takes all loads away, harmonics and tables, those that a system came with, too. Motions of the bases and limits stay.
  subroutine clear_loads(this, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: held
    type(work) :: w

    call find_system(this, held, w)
    if (w%status == TRIBO_OK) w%status = c_clear_loads(held%sys)
    call finish(w, stat, errmsg)
  end subroutine clear_loads

  !> Adds a load that follows a table, p(t) = ... + pattern*value(t), with value linear between its knots at time, which ascends,
  !> and constant outside. pattern: as in add_load.
  subroutine add_load_table(this, time, value, pattern, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: time(:), value(:), pattern(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: held
    type(work) :: w

    call find_system(this, held, w)
    call expect_size(w, 'value', value, size(time))
    if (w%status == TRIBO_OK) call expect_size(w, 'pattern', pattern, int(held%given))
    if (w%status == TRIBO_OK) w%status = c_add_load_table(held%sys, size(time, kind=c_size_t), time, value, pattern)
    call finish(w, stat, errmsg)
  end subroutine add_load_table

  !> Lets the limits follow a table, limit(ncontact,knots) >= 0, linear between its knots at time and constant outside, instead of
  !> what the context says; limits that are set there meanwhile have no effect. Without knots it ends, and harmonics of the limits
  !> do: limits are again those that the context had before.
  subroutine set_limit_table(this, time, limit, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: time(:), limit(:,:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: held
    type(work) :: w

    call find_system(this, held, w)
    call expect_size(w, 'limit', limit, size(time), w%n)
    if (w%status == TRIBO_OK) w%status = c_set_limit_table(held%sys, size(time, kind=c_size_t), time, limit)
    call finish(w, stat, errmsg)
  end subroutine set_limit_table

  !> Reduced systems: damping ratio >= 0 of every mode, C = diag(2*zeta*omega_k).
  subroutine set_damping_ratio(this, zeta, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: zeta
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: held
    type(work) :: w

    call find_system(this, held, w)
    if (w%status == TRIBO_OK) w%status = c_set_damping_ratio(held%sys, zeta)
    call finish(w, stat, errmsg)
  end subroutine set_damping_ratio

  !> Reduced systems: natural frequencies omega(ndof), ascending, rad/time.
  subroutine get_frequencies(this, omega, stat, errmsg)
    class(tribo_system), intent(in) :: this
    real(dp), intent(inout) :: omega(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: held
    type(work) :: w

    call find_system(this, held, w)
    call expect_size(w, 'omega', omega, this%ndof())
    if (w%status == TRIBO_OK) w%status = c_get_frequencies(held%sys, omega)
    call finish(w, stat, errmsg)
  end subroutine get_frequencies

  !> Reduced systems: the displacements of the whole structure that belong to the modal ones, reduced(ndof).
  subroutine expand(this, reduced, full, stat, errmsg)
    class(tribo_system), intent(in) :: this
    real(dp), intent(in) :: reduced(:)
    real(dp), intent(inout) :: full(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: held
    type(work) :: w

    call find_system(this, held, w)
    call expect_size(w, 'reduced', reduced, this%ndof())
    if (w%status == TRIBO_OK) call expect_size(w, 'full', full, int(held%given))
    if (w%status == TRIBO_OK) w%status = c_expand(held%sys, reduced, full)
    call finish(w, stat, errmsg)
  end subroutine expand

  !> Sizes; 0 for a system that has not been created. dimension is 2*ndof + 1. Arrays may be declared with them.
  pure integer function ndof(this)
    class(tribo_system), intent(in) :: this
    ndof = int(c_held_ndof(object_of(this)))
  end function ndof

  pure integer function ncontact(this)
    class(tribo_system), intent(in) :: this
    ncontact = int(c_held_ncontact(object_of(this)))
  end function ncontact

  pure integer function dimension(this)
    class(tribo_system), intent(in) :: this
    dimension = 0
    if (c_associated(object_of(this))) dimension = 2*this%ndof() + 1
  end function dimension

  !> Makes c the context of the system's contacts, borrowed: set law, limits, epsilon and coupling there. Its operator is the
  !> system's. When the system has gone, c is as if destroyed; c%destroy does nothing to the system.
  subroutine context(this, c, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    type(tribo_context), intent(inout) :: c
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: held
    type(work) :: w

    call find_system(this, held, w)
    if (w%status == TRIBO_OK) call lend(c, held%context)
    call finish(w, stat, errmsg)
  end subroutine context

  !> For anyone's own integrator: dydt(dimension), and the Jacobian dfdy(i,j) = d(dydt(i))/d(y(j)), dfdt(i) = d(dydt(i))/dt. See
  !> accept.
  subroutine derivative(this, t, y, dydt, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(inout) :: dydt(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: held
    type(work) :: w

    call find_system(this, held, w)
    call expect_size(w, 'y', y, this%dimension())
    call expect_size(w, 'dydt', dydt, this%dimension())
    if (w%status == TRIBO_OK) w%status = c_derivative(held%sys, t, y, dydt)
    call finish(w, stat, errmsg)
  end subroutine derivative

  subroutine jacobian(this, t, y, dfdy, dfdt, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(inout) :: dfdy(:,:), dfdt(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: held
    type(work) :: w

    call find_system(this, held, w)
    call expect_size(w, 'y', y, this%dimension())
    call expect_size(w, 'dfdy', dfdy, this%dimension())
    call expect_size(w, 'dfdt', dfdt, this%dimension())
    if (w%status == TRIBO_OK) then
      w%status = c_jacobian(held%sys, t, y, dfdy, dfdt)
      if (w%status == TRIBO_OK) call transpose_in_place(dfdy)
    end if
    call finish(w, stat, errmsg)
  end subroutine jacobian

  !> What the contacts do in a state: v, feq and f as in balance of a context.
  subroutine contacts(this, t, y, v, feq, f, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(inout), optional, contiguous, target :: v(:), feq(:), f(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: held
    type(work) :: w
    type(c_ptr) :: at(3)

    call find_system(this, held, w)
    at = c_null_ptr
    call expect_size(w, 'y', y, this%dimension())
    if (present(v)) call find(w, 'v', v, at(1))
    if (present(feq)) call find(w, 'feq', feq, at(2))
    if (present(f)) call find(w, 'f', f, at(3))
    if (w%status == TRIBO_OK) w%status = c_contacts(held%sys, t, y, at(1), at(2), at(3))
    call finish(w, stat, errmsg)
  end subroutine contacts

  !> accept of the context for the state (t, y): to be called after each accepted step by integrators other than tribo_driver.
  subroutine accept(this, t, y, stat, errmsg)
    class(tribo_system), intent(inout) :: this
    real(dp), intent(in) :: t, y(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: held
    type(work) :: w

    call find_system(this, held, w)
    call expect_size(w, 'y', y, this%dimension())
    if (w%status == TRIBO_OK) w%status = c_accept(held%sys, t, y)
    call finish(w, stat, errmsg)
  end subroutine accept

  !> What the last call that failed on the system, its context or a driver of it found; empty before any.
  function system_message(this) result(text)
    class(tribo_system), intent(in) :: this
    character(len=:), allocatable :: text
    type(held_system), pointer :: held
    type(work) :: w

    call find_system(this, held, w)
    call message_of(w, text)
  end function system_message

  ! -------------------------------------------------------------------------------------------------------------------- drivers

  !> An integrator for a system. Methods, in any case of letters: see tribo_method_name.
  !>   Coulomb's law itself, epsilon to 0:
  !>   exact      the motion in closed form between events, to 12 digits; linear systems with harmonic loads. dt: how often an
  !>              observer sees the motion between events
  !>   event      high-order steps between events, with the tolerances; any system
  !>   central/fixed, moreau/fixed   fixed steps of dt in the step form, by central differences (explicit; a dt that is not stable
  !>              is refused) and by the implicit midpoint rule (Moreau and Jean); second order
  !>   auto       exact where it can do the system and that is small, else event
  !>   The law, coupling and epsilon of the context:
  !>   rk4/fixed  the classical Runge-Kutta method in steps of dt, as in the paper
  !>   rk2, rk4, rkf45, rkck, rk8pd   explicit Runge-Kutta methods, adaptive from dt on
  !>   rk1imp, rk2imp, rk4imp, msbdf  implicit ones, adaptive: Euler's, those of Gauss, backward differences; for small epsilon:
  !>              msbdf
  !> dt > 0: step, or first step. abstol, reltol >= 0, where absent 0; abstol > 0 for adaptive methods and event. Adaptive: the
  !> error of a step is below abstol + reltol times the largest displacement, velocity, or the energy, and for velocities of
  !> contacts below epsilon/1000 at least. See also set_max_step.
  subroutine create(this, sys, method, dt, abstol, reltol, stat, errmsg)
    class(tribo_driver), intent(inout) :: this
    class(tribo_system), intent(inout) :: sys
    character(len=*), intent(in) :: method
    real(dp), intent(in) :: dt
    real(dp), intent(in), optional :: abstol, reltol
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_system), pointer :: system
    type(held_driver), pointer :: held
    type(work) :: w
    type(c_ptr) :: drv
    real(dp) :: tolerance(2)

    call find_system(sys, system, w)
    tolerance = 0
    if (present(abstol)) tolerance(1) = abstol
    if (present(reltol)) tolerance(2) = reltol
    if (w%status == TRIBO_OK) then
      w%status = c_driver_create(drv, system%sys, trim(method) // c_null_char, dt, tolerance(1), tolerance(2))
    end if
    if (w%status == TRIBO_OK) then
      allocate (held)
      held%drv = drv
      held%system => system
      system%users = system%users + 1
      w%status = adopt(this, c_loc(held), c_funloc(release_driver))
      if (w%status /= TRIBO_OK) call release_driver(c_loc(held))
    end if
    call finish(w, stat, errmsg)
  end subroutine create

  !> Name of the method; for auto, of the one at work. Empty for a driver that has not been created.
  function method(this) result(text)
    class(tribo_driver), intent(in) :: this
    character(len=:), allocatable :: text
    type(held_driver), pointer :: held
    type(work) :: w

    call find_driver(this, held, w)
    if (w%status == TRIBO_OK) then
      call to_text(c_driver_method(held%drv), text)
    else
      text = ''
    end if
  end function method

  !> Names of the methods, method 0 to tribo_method_count() - 1; empty outside.
  integer function tribo_method_count()
    tribo_method_count = int(c_method_count())
  end function tribo_method_count

  function tribo_method_name(method) result(text)
    integer, intent(in) :: method
    character(len=:), allocatable :: text
    call to_text(c_method_name(int(method, c_int)), text)
  end function tribo_method_name

  !> Integrates from t to t1 >= t; y, the system and its context's settings may be changed between calls. On error t and y hold the
  !> last good step.
  subroutine advance(this, t, t1, y, stat, errmsg)
    class(tribo_driver), intent(inout) :: this
    real(dp), intent(inout) :: t, y(:)
    real(dp), intent(in) :: t1
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_driver), pointer :: held
    type(work) :: w

    call find_driver(this, held, w)
    if (w%status == TRIBO_OK) call expect_size(w, 'y', y, 2*int(c_ndof(held%system%sys)) + 1)
    if (w%status == TRIBO_OK) then
      w%status = c_advance(held%drv, t, t1, y)
      ! One place for messages, that of the context.
      if (w%status /= TRIBO_OK) w%status = c_copy_message(w%ctx, w%status, c_driver_message(held%drv))
    end if
    call finish(w, stat, errmsg)
  end subroutine advance

  !> One of TRIBO_COUNT_STEPS, _REJECTED, _EVALUATIONS, _JACOBIANS, _EVENTS, since creation.
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
    type(held_driver), pointer :: held
    integer(c_size_t) :: count
    character(len=60) :: text

    call find_driver(this, held, w)
    if (w%status /= TRIBO_OK) return
    if (c_driver_count(held%drv, int(which, c_int), count) /= TRIBO_OK) then
      write (text, '(a,i0,a)') 'which = ', which, ' is none of the counts of a driver'
      call fail(w, TRIBO_ERR_RANGE, trim(text))
    else if (count > most) then
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
    type(held_driver), pointer :: held
    character(len=60) :: text

    call find_driver(this, held, w)
    if (w%status == TRIBO_OK) then
      w%status = c_driver_real(held%drv, int(which, c_int), value)
      if (w%status == TRIBO_ERR_RANGE) then
        write (text, '(a,i0,a)') 'which = ', which, ' is no real quantity of a driver'
        call fail(w, TRIBO_ERR_RANGE, trim(text))
      else if (w%status == TRIBO_ERR_UNSUPPORTED) then
        call fail(w, TRIBO_ERR_UNSUPPORTED, 'this method does not know how far it strays from Coulomb''s law')
      end if
    end if
    call finish(w, stat, errmsg)
  end subroutine driver_real

  !> Has observer%seen called from now on, see tribo_observer; without observer, nothing. The observer must have the attribute
  !> target (or be a pointer) where it is declared, and live as long as it may be called.
  subroutine set_observer(this, observer, stat, errmsg)
    class(tribo_driver), intent(inout) :: this
    class(tribo_observer), intent(inout), optional, target :: observer
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_driver), pointer :: held
    type(work) :: w
    type(c_funptr) :: call_back

    call find_driver(this, held, w)
    if (w%status == TRIBO_OK) then
      nullify (held%observer)
      call_back = c_null_funptr
      if (present(observer)) then
        held%observer => observer
        call_back = c_funloc(tell_observer)
      end if
      w%status = c_set_observer(held%drv, call_back, c_loc(held))
    end if
    call finish(w, stat, errmsg)
  end subroutine set_observer

  !> The largest step h > 0 of an adaptive method; by default 0.1 over the highest frequency of structure and loads, since while all
  !> contacts rest no estimate sees how long a step is. An infinite h: none.
  subroutine set_max_step(this, h, stat, errmsg)
    class(tribo_driver), intent(inout) :: this
    real(dp), intent(in) :: h
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_driver), pointer :: held
    type(work) :: w

    call find_driver(this, held, w)
    if (w%status == TRIBO_OK) then
      w%status = c_set_max_step(held%drv, h)
      if (w%status /= TRIBO_OK) w%status = c_copy_message(w%ctx, w%status, c_driver_message(held%drv))
    end if
    call finish(w, stat, errmsg)
  end subroutine set_max_step

  !> What the last call that failed on the driver or its system found; empty before any.
  function driver_message(this) result(text)
    class(tribo_driver), intent(in) :: this
    character(len=:), allocatable :: text
    type(held_driver), pointer :: held
    type(work) :: w

    call find_driver(this, held, w)
    call message_of(w, text)
  end function driver_message

  ! ------------------------------------------------------------------------------------------------------- what the calls share

  subroutine find_system(this, held, w)
    class(tribo_system), intent(in) :: this
    type(held_system), pointer, intent(out) :: held
    type(work), intent(out) :: w

    w%kind = 'system'
    w%object = object_of(this)
    nullify (held)
    if (.not. c_associated(w%object)) return
    call c_f_pointer(w%object, held)
    w%ctx = c_context(held%sys)
    w%n = int(c_ncontact(held%sys))
    w%status = TRIBO_OK
  end subroutine find_system

  subroutine find_driver(this, held, w)
    class(tribo_driver), intent(in) :: this
    type(held_driver), pointer, intent(out) :: held
    type(work), intent(out) :: w

    w%kind = 'driver'
    w%object = object_of(this)
    nullify (held)
    if (.not. c_associated(w%object)) return
    call c_f_pointer(w%object, held)
    w%ctx = c_context(held%system%sys)
    w%status = TRIBO_OK
  end subroutine find_driver

  !> Gives what a call has created, if it has, to this. given: degrees of freedom of the matrices, ndof where absent.
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
    held%given = int(c_ndof(sys), c_int64_t)
    if (present(given)) held%given = given
    held%context = register(c_context(sys))
    if (held%context == 0) w%status = TRIBO_ERR_MEMORY
    if (w%status == TRIBO_OK) w%status = adopt(this, c_loc(held), c_funloc(release_system))
    if (w%status /= TRIBO_OK) call release_system(c_loc(held))
  end subroutine adopt_system

  !> The variable has gone: its context has, too.
  subroutine release_system(object) bind(c, name='')
    type(c_ptr), value :: object
    type(held_system), pointer :: held

    call c_f_pointer(object, held)
    call forget(held%context)
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

  !> One user less; the last one sees to the end.
  subroutine leave(held)
    type(held_system), pointer, intent(inout) :: held
    held%users = held%users - 1
    if (held%users > 0) return
    call c_system_destroy(held%sys)
    deallocate (held)
  end subroutine leave

  !> Passes on what the library sees.
  integer(c_int) function tell_observer(t, y, event, data) bind(c, name='')
    real(c_double), value :: t
    type(c_ptr), value :: y, data
    integer(c_int), value :: event
    type(held_driver), pointer :: held
    real(dp), pointer :: state(:)

    call c_f_pointer(data, held)
    call c_f_pointer(y, state, [2*c_ndof(held%system%sys) + 1])
    tell_observer = int(held%observer%seen(t, state, int(event)), c_int)
  end function tell_observer

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

  integer(c_size_t) function modes(nmode)
    integer, intent(in), optional :: nmode
    modes = 0
    if (present(nmode)) modes = int(nmode, c_size_t)
  end function modes

  !> Keeps the text of a creation that failed.
  subroutine note(w, message)
    type(work), intent(inout) :: w
    character(kind=c_char), intent(in) :: message(:)
    integer :: i
    if (w%status == TRIBO_OK) return
    w%text = ''
    do i = 1, size(message)
      if (message(i) == c_null_char) exit
      w%text = w%text // message(i)
    end do
  end subroutine note

  subroutine expect_given(w, name, x)
    type(work), intent(inout) :: w
    character(len=*), intent(in) :: name
    type(tribo_sparse), intent(in) :: x
    if (.not. allocated(x%val)) call fail(w, TRIBO_ERR_NULL, name // ' has not been set')
  end subroutine expect_given

  type(rows_of) function borrowed(x)
    type(tribo_sparse), intent(in), target :: x
    borrowed%rows = int(x%rows, c_size_t)
    borrowed%columns = int(x%columns, c_size_t)
    borrowed%first = c_loc(x%first)
    borrowed%col = c_null_ptr
    borrowed%val = c_null_ptr
    if (size(x%val) == 0) return
    borrowed%col = c_loc(x%col)
    borrowed%val = c_loc(x%val)
  end function borrowed
end module tribo_gsl
