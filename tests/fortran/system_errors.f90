! SPDX-License-Identifier: BSD-3-Clause
!> Every error that a procedure of module tribo_dynamics can answer: status, text, outputs left alone; and how systems, drivers and
!> borrowed contexts end.
module stoppers
  use tribo_dynamics, only: tribo_moment, tribo_observer
  implicit none
  private

  type, extends(tribo_observer), public :: stopper
    integer :: calls = 0, answer = 0
  contains
    procedure :: seen => answer_it
  end type stopper

contains

  integer function answer_it(this, moment)
    class(stopper), intent(inout) :: this
    type(tribo_moment), intent(in) :: moment
    this%calls = this%calls + merge(1, 0, moment%t >= 0 .and. size(moment%y) > 0 .and. moment%contact == 0)
    answer_it = this%answer
  end function answer_it
end module stoppers

program system_errors
  use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
  use check, only: alive, blank, blank_integer, expect_error, report, require, untouched
  use stoppers, only: stopper
  use tribo
  use making, only: make_linear, make_reduced
  use tribo_dynamics
  implicit none

  character(len=*), parameter :: no_system = 'the system has not been created, or has been destroyed', &
    no_driver = 'the driver has not been created, or has been destroyed', &
    no_context = 'the context has not been created, or has been destroyed'
  real(dp), parameter :: one(2, 2) = reshape([real(dp) :: 1, 0, 0, 1], [2, 2])
  integer :: stat = blank_integer
  character(len=200) :: msg = ''
  real(dp) :: nan

  nan = ieee_value(nan, ieee_quiet_nan)
  call nothing()
  call creation()
  call matrices()
  call settings()
  call states()
  call drivers()
  call require(alive() == 0, 'nothing is left of the errors')
  call borrowed()
  call shared()
  call copies()
  call require(alive() == 0, 'nothing is left of the objects')
  call report()

contains

  !> Every procedure on a system or driver that has not been created.
  subroutine nothing()
    type(tribo_system) :: s
    type(tribo_driver) :: d
    type(tribo_context) :: c
    real(dp) :: x(3), y(3), z(3), w(3), q(3, 3), t
    integer :: i

    x = blank
    y = blank
    z = blank
    w = blank
    q = blank
    t = blank
    i = blank_integer
    call require(s%ndof() == 0 .and. s%ncontact() == 0 .and. s%dimension() == 0, 'sizes of nothing')
    call require(s%message() == no_system, 'message of no system')
    call require(d%message() == no_driver, 'message of no driver')
    call require(d%method() == '', 'method of no driver')
    call s%add_load(1.0_dp, x, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_system)
    call s%add_base_motion(1.0_dp, x, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_system)
    call s%add_limit(1.0_dp, x, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_system)
    call s%add_load_table(x, x, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_system)
    call s%set_limit_table(x, q, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_system)
    call s%set_damping_ratio(0.1_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_system)
    call s%get_frequencies(y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_system)
    call s%get_truncation(1.0_dp, y(1), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_system)
    call s%expand(x, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_system)
    call s%context(c, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_system)
    call require(c%message() == no_context, 'context of nothing')
    call s%derivative(0.0_dp, x, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_system)
    call s%jacobian(0.0_dp, x, q, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_system)
    call s%contacts(0.0_dp, x, y, z, w, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_system)
    call s%accept(0.0_dp, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_system)
    call d%create(s, 'exact', stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_system)
    call d%advance(t, 1.0_dp, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_driver)
    call d%count(TRIBO_COUNT_STEPS, i, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_driver)
    call d%set_observer(stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_driver)
    call d%set_max_step(1.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_driver)
    call d%set_step(1.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_driver)
    call d%set_tolerance(1.0_dp, 1.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_driver)
    call d%set_output(1.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_driver)
    call d%get_freedom(i, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_driver)
    call require(all(untouched([x, y, z, w, t])) .and. all(untouched(q)) .and. untouched(i), 'nothing: outputs')
    call s%destroy()
    call d%destroy()
  end subroutine nothing

  !> What cannot be created leaves the system that was there.
  subroutine creation()
    type(tribo_system) :: s
    real(dp) :: m(2, 2)

    call s%belt(1.0_dp, 1.0_dp, 1.0_dp, 1.0_dp, 1.0_dp)
    call s%oscillator(-1.0_dp, 1.0_dp, 1.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'limit = -1.000000 is negative')
    call s%chain(1, 0.1_dp, 1.0_dp, 1.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'n = 1 is less than 2')
    call s%chain(-1, 0.1_dp, 1.0_dp, 1.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'n = -1 is negative')
    call s%belt(nan, 0.1_dp, 1.0_dp, 1.0_dp, 1.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'kappa = NaN is not finite')
    call make_linear(s, one(:, :1), one, one, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'mass has size 2 x 1, not 2 x 2')
    call make_linear(s, one, one(:1, :), one, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'stiffness has size 1 x 2, not 2 x 2')
    call make_linear(s, one, one, one(:1, :1), stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'direction has size 1 x 1, not 1 x 2')
    call make_linear(s, one, one, one, one(:1, :1), stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'damping has size 1 x 1, not 2 x 2')
    call make_linear(s, one, one, one, nmode=-1, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'nmode = -1 is negative')
    call make_linear(s, one, one, one, nmode=3, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'nmode = 3 is more than the 2 degrees of freedom')
    call make_linear(s, one(:0, :0), one(:0, :0), one(:0, :0), stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, &
      'ndof = 0: a model has a degree of freedom at least')
    m = one
    m(1, 2) = nan
    call make_linear(s, one, m, one, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'stiffness(1,2) = nan is not finite')
    call make_linear(s, one, one, m, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'direction(1,2) = nan is not finite')
    m(1, 2) = 0.5_dp
    call make_linear(s, m, one, one, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_SYMMETRIC, 'mass(1,2) = 0.5, but mass(2,1) = 0')
    call make_linear(s, one, m, one, nmode=1, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_SYMMETRIC, &
                      'stiffness(1,2) = 0.5, but stiffness(2,1) = 0: ' // &
                      'modes for a reduction are those of a symmetric stiffness')
    m = one
    m(2, 2) = -1
    call make_linear(s, m, one, one, stat=stat, errmsg=msg)
    call require(stat == TRIBO_ERR_INDEFINITE .and. index(msg, 'at degree of freedom 2') > 0, 'mass: ' // trim(msg))
    call make_linear(s, one, m, one, nmode=1, stat=stat, errmsg=msg)
    call require(stat == TRIBO_ERR_INDEFINITE .and. index(msg, 'of mode 1') > 0, 'stiffness: ' // trim(msg))
    call require(s%ndof() == 2 .and. s%ncontact() == 2, 'creation: the old system stays')
    call require(s%message() == '', 'creation: no message on the old system')
  end subroutine creation

  subroutine matrices()
    type(tribo_system) :: s
    type(tribo_sparse) :: a, unset, wide
    integer, parameter :: none(0) = 0

    call a%set_csr(2, [1, 2, 3], [1, 2], [1.0_dp, 1.0_dp])
    call a%set_csr(2, none, [1], [1.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'rowptr has size 0, not 1')
    call a%set_csr(2, [1, 2, 3], [1, 2], [1.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'val has size 1, not 2')
    call a%set_csr(2, [1, 2, 4], [1, 2], [1.0_dp, 1.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'rowptr(3) = 4 does not end where col does')
    call a%set_csr(2, [1, 2, 3], [1, 3], [1.0_dp, 1.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'col(2) = 3 is not in 1 to 2')
    call a%set_csr(2, [1, 1, 3], [2, 2], [1.0_dp, 1.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_DUPLICATE, 'entry (2,2) is given twice')
    call a%set_csr(-1, [1, 1], none, [real(dp) ::], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'columns = -1 is negative')
    call a%set_coo(2, 2, [1, 2], [1], [1.0_dp, 1.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'col has size 1, not 2')
    call a%set_coo(2, 2, [1, 2], [1, 2], [1.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'val has size 1, not 2')
    call a%set_coo(2, 2, [1, 0], [1, 2], [1.0_dp, 1.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'row(2) = 0 is not in 1 to 2')
    call a%set_coo(2, 2, [1, 2], [3, 2], [1.0_dp, 1.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'col(1) = 3 is not in 1 to 2')
    call a%set_coo(2, 2, [2, 1, 2], [1, 1, 1], [1.0_dp, 1.0_dp, 2.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_DUPLICATE, 'entry (2,1) is given twice')
    call a%set_coo(-1, 2, none, none, [real(dp) ::], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'rows = -1 is negative')
    call a%set_coo(1, -2, none, none, [real(dp) ::], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'columns = -2 is negative')
    ! Through all that a stays the unit matrix.
    call make_linear(s, [2, 2], a, a, a)
    call require(s%ndof() == 2 .and. s%ncontact() == 2, 'matrices: the old one stays')
    call make_linear(s, [2, 2], unset, a, a, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, 'mass has not been set')
    call make_linear(s, [2, 2], a, unset, a, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, 'stiffness has not been set')
    call make_reduced(s, [2, 2], a, unset, a, 1, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, 'stiffness has not been set')
    call make_reduced(s, [2, 2], a, a, a, -1, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'nmode = -1 is negative')
    call make_reduced(s, [2, 2], a, a, a, 0, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'nmode = 0: a reduced system has a mode at least')
    call make_linear(s, [2, 2], a, a, unset, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, 'direction has not been set')
    call make_linear(s, [2, 2], a, a, a, unset, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, 'damping has not been set')
    call wide%set_coo(2, 3, [1, 2], [1, 3], [1.0_dp, 1.0_dp])
    call make_linear(s, [2, 2], a, wide, a, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'stiffness has size 2 x 3, not 2 x 2')
    call make_linear(s, [2, 2], a, a, a, nmode=-2, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'nmode = -2 is negative')
    call a%set_coo(2, 2, [1, 1, 2], [1, 2, 2], [1.0_dp, 2.0_dp, 1.0_dp])
    call make_linear(s, [2, 2], a, a, a, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_SYMMETRIC, 'mass(1,2) = 2, but mass(2,1) = 0')
    ! No contacts at all.
    call a%set_csr(2, [1, 2, 3], [1, 2], [1.0_dp, 1.0_dp])
    call wide%set_csr(2, [1], none, [real(dp) ::])
    call make_linear(s, [2, 0], a, a, wide)
    call require(s%ndof() == 2 .and. s%ncontact() == 0, 'no contacts')
  end subroutine matrices

  subroutine settings()
    type(tribo_system) :: s
    real(dp) :: x(3)

    x = 0
    call make_linear(s, one, one, one(:1, :))
    call s%add_load(1.0_dp, x, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'cosine has size 3, not 2')
    call s%add_load(1.0_dp, sine=x(:1), stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'sine has size 1, not 2')
    call s%add_load(1.0_dp, [0.0_dp, nan], stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'cosine(2) = nan is not finite')
    call s%add_load(nan, x(:2), stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'omega = nan is not finite')
    call s%add_base_motion(1.0_dp, x(:2), stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'cosine has size 2, not 1')
    call s%add_base_motion(1.0_dp, sine=[nan], stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'sine(1) = nan is not finite')
    call s%add_limit(1.0_dp, x(:2), stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'cosine has size 2, not 1')
    call s%add_limit(1.0_dp, sine=[nan], stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'sine(1) = nan is not finite')
    call s%add_load_table([0.0_dp, 1.0_dp], x, x(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'value has size 3, not 2')
    call s%add_load_table([0.0_dp, 1.0_dp], x(:2), x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'pattern has size 3, not 2')
    call s%add_load_table([1.0_dp, 1.0_dp], x(:2), x(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'time(2) = 1 is not after time(1) = 1')
    call s%add_load_table(x(:0), x(:0), x(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'knots = 0')
    call s%add_base_table([0.0_dp, 1.0_dp], x(:2), x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'pattern has size 3, not 1')
    call s%set_limit_table([0.0_dp, 1.0_dp], one, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'limit has size 2 x 2, not 1 x 2')
    call s%set_limit_table([0.0_dp, 1.0_dp], reshape([1.0_dp, -2.0_dp], [1, 2]), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'limit(2) = -2 of contact 1 is negative')
    call s%set_limit_table([0.0_dp, 1.0_dp], reshape([1.0_dp, nan], [1, 2]), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'limit(2) = nan of contact 1 is not finite')
    call s%set_damping_ratio(0.1_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_UNSUPPORTED, 'the system is not reduced to modes')
    x = blank
    call s%get_frequencies(x(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_UNSUPPORTED, 'the system is not reduced to modes')
    call s%expand([0.0_dp, 0.0_dp], x(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_UNSUPPORTED, 'the system is not reduced to modes')
    call s%get_truncation(1.0_dp, x(1), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_UNSUPPORTED, 'the system is not reduced to modes')
    call make_linear(s, one, one, one, nmode=1)
    call s%get_truncation(nan, x(1), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'omega = nan is not finite')
    call s%get_frequencies(x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'omega has size 3, not 1')
    call s%expand([0.0_dp, 0.0_dp], x(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'reduced has size 2, not 1')
    call s%expand([0.0_dp], x(:1), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'full has size 1, not 2')
    call s%set_damping_ratio(-1.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'zeta = -1 is negative')
    call require(s%message() == 'zeta = -1 is negative', 'message of a system')
    call require(all(untouched(x)), 'settings: outputs')
  end subroutine settings

  subroutine states()
    type(tribo_system) :: s
    real(dp) :: y(3), x(3), q(3, 3), v(1)

    y = 0
    x = blank
    q = blank
    v = blank
    call s%oscillator(1.0_dp, 1.0_dp, 1.0_dp)
    call s%derivative(0.0_dp, y(:2), x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'y has size 2, not 3')
    call s%derivative(0.0_dp, y, x(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'dydt has size 2, not 3')
    call s%jacobian(0.0_dp, y(:2), q, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'y has size 2, not 3')
    call s%jacobian(0.0_dp, y, q(:2, :), x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'dfdy has size 2 x 3, not 3 x 3')
    call s%jacobian(0.0_dp, y, q, x(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'dfdt has size 2, not 3')
    call s%contacts(0.0_dp, y(:2), v, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'y has size 2, not 3')
    call s%contacts(0.0_dp, y, x, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'v has size 3, not 1')
    call s%contacts(0.0_dp, y, feq=x, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'feq has size 3, not 1')
    call s%contacts(0.0_dp, y, f=x(:0), stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'f has size 0, not 1')
    call s%contacts(nan, y, v, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 't = nan is not finite')
    call s%accept(0.0_dp, y(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'y has size 2, not 3')
    y(2) = nan
    call s%accept(0.0_dp, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'y(2) = nan is not finite')
    call s%contacts(0.0_dp, y, v, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'y(2) = nan is not finite')
    call require(all(untouched(x)) .and. all(untouched(q)) .and. all(untouched(v)), 'states: outputs')
    call s%derivative(0.0_dp, y, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'y(2) = nan is not finite')
    call s%jacobian(0.0_dp, y, q, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'y(2) = nan is not finite')
  end subroutine states

  subroutine drivers()
    type(tribo_system) :: s
    type(tribo_context) :: c
    type(tribo_driver) :: d
    type(stopper), target :: sees
    real(dp) :: t, x, y(3), pair(2)
    integer :: i

    call s%oscillator(0.1_dp, 1.0_dp, 1.0_dp)
    call d%create(s, 'exact')
    call d%create(s, 'exactly', stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NAME, 'method "exactly" is unknown; there are ' // &
      'rk4/fixed, exact, event, central/fixed, moreau/fixed, auto; ' // &
      'tribo_gsl_driver_create takes GSL''s steppers')
    call d%create(s, 'rk4/fixed', 0.0_dp, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_POSITIVE, 'dt = 0 is not positive')
    call d%create(s, 'event', abstol=0.0_dp, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_POSITIVE, 'abstol = 0 is not positive')
    call d%create(s, 'event', reltol=1e-6_dp, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, 'reltol is given, but abstol is not')
    call d%create(s, 'auto', step=0.1_dp, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_UNSUPPORTED, &
      "method auto takes no step; rk4/fixed, central/fixed, moreau/fixed and GSL's adaptive methods do")
    call d%create(s, 'rk4/fixed', output=0.1_dp, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_UNSUPPORTED, 'method rk4/fixed takes no output; exact, event and auto do')
    call d%create(s, 'event', max_step=0.1_dp, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_UNSUPPORTED, "method event takes no largest step; GSL's adaptive methods do")
    call d%create(s, 'event', abstol=1e-6_dp, reltol=-1.0_dp, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'reltol = -1 is negative')
    call require(d%method() == 'exact', 'create: the old driver stays')
    call require(d%message() == 'reltol = -1 is negative', 'create: message of the old driver')
    t = 1
    y = 0
    call d%advance(t, 2.0_dp, y(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'y has size 2, not 3')
    call d%advance(t, 0.5_dp, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 't1 = 0.5 is before t = 1')
    call require(d%message() == 't1 = 0.5 is before t = 1', 'message of a driver')
    call d%advance(t, nan, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 't1 = nan is not finite')
    y(3) = nan
    call d%advance(t, 2.0_dp, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'y(3) = nan is not finite')
    y(3) = 0
    i = blank_integer
    call d%count(7, i, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'which = 7 is no count of a driver')
    call require(untouched(i), 'count: output')
    x = blank
    call d%real(7, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'which = 7 is no real quantity of a driver')
    call d%set_max_step(1.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_UNSUPPORTED, "method exact takes no largest step; GSL's adaptive methods do")
    call d%period_harmonic(y(:2), -1, x, t, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'k = -1 is negative')
    call d%get_multipliers(pair, pair, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_STATE, 'no periodic motion was found: call tribo_driver_find_periodic first')
    call d%create(s, 'RK4/Fixed', 0.1_dp)
    call require(d%method() == 'rk4/fixed', 'create: letters of any case')
    call d%real(TRIBO_REAL_EXCESS, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_UNSUPPORTED, 'method rk4/fixed does not bound how far the motion strays')
    call require(untouched(x), 'real: output')
    call d%create(s, 'mode 3[1]', stat=stat, errmsg=msg)
    call require(index(msg, '"mode 3[1]"') > 0, 'create: a name stays as it is: ' // msg)
    ! The observer's answer ends the run.
    call d%create(s, 'rk4/fixed')
    t = 0
    y = 0
    call d%advance(t, 1.0_dp, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_STATE, 'method rk4/fixed has no step: call tribo_driver_set_step')
    call d%set_step(0.25_dp)
    sees%answer = 5
    call d%set_observer(sees)
    call d%advance(t, 1.0_dp, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_STOPPED, 'the observer answered 5 at t = 0.25')
    call require(abs(t - 0.25_dp) <= 0 .and. sees%calls == 1, 'where the observer stopped')
    sees%answer = shiftl(1, bit_size(1)/2)
    call d%advance(t, 1.0_dp, y, stat)
    call require(stat == TRIBO_ERR_STOPPED, 'the observer answers a large number')
    sees%answer = 0
    call d%advance(t, 1.0_dp, y)
    call require(sees%calls == 4, 'what the observer saw')
    ! A method that cannot do what the system has become.
    call d%create(s, 'exact')
    call s%context(c)
    call c%set_static([2.0_dp], [1.0_dp])
    call d%advance(t, 2.0_dp, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_UNSUPPORTED, &
      'contact 1 has a static limit that falls with the speed, and method exact takes such that drop at once only: '// &
      'take event or auto')
  end subroutine drivers

  !> A borrowed context does what its system does, and goes with it.
  subroutine borrowed()
    type(tribo_system) :: s
    type(tribo_context) :: c, b, copy
    real(dp) :: limit(1)
    integer :: before

    before = int(alive())
    call s%oscillator(0.5_dp, 1.0_dp, 1.0_dp)
    call s%context(c)
    call s%context(b)
    call c%set_limit(0.25_dp)
    call b%get_limit(limit)
    call require(abs(limit(1) - 0.25_dp) <= 0, 'two names of one context')
    call c%set_operator([2.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_UNSUPPORTED, &
      'the operator is fixed, as that of a tribo_system is: set that of a copy (tribo_clone)')
    call b%destroy()
    call use_up(s)
    call c%get_limit(limit)
    call require(abs(limit(1) - 0.25_dp) <= 0, 'a borrowed context is not destroyed')
    copy = c
    call copy%set_operator([2.0_dp])
    call c%set_limit(0.125_dp)
    call copy%get_limit(limit)
    call require(abs(limit(1) - 0.25_dp) <= 0, 'a copy of a borrowed context')
    call s%chain(2, 0.5_dp, 1.0_dp, 1.0_dp)
    call c%get_limit(limit, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_context)
    call s%context(c)
    call s%destroy()
    call c%set_limit(1.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_context)
    call c%create(3)
    call c%destroy()
    call copy%get_limit(limit)
    call copy%destroy()
    call require(alive() == before, 'borrowed contexts leave nothing')
  end subroutine borrowed

  subroutine use_up(s)
    type(tribo_system), intent(inout) :: s
    type(tribo_context) :: c
    call s%context(c)
  end subroutine use_up

  !> A driver goes on when the variable of its system has gone.
  subroutine shared()
    type(tribo_system) :: s
    type(tribo_driver) :: d, e
    real(dp) :: t, y(3), u, z(3)

    call s%oscillator(0.1_dp, 1.0_dp, 1.0_dp)
    call d%create(s, 'exact')
    call e%create(s, 'exact')
    t = 0
    y = 0
    u = 0
    z = 0
    call d%advance(t, 2.0_dp, y)
    call s%destroy()
    call e%advance(u, 2.0_dp, z)
    call require(all(abs(y - z) <= 0), 'the same with and without the variable')
    call d%advance(t, -1.0_dp, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 't1 = -1 is before t = 2')
    call d%destroy()
    call e%advance(u, 3.0_dp, z)
    call e%destroy()
    call e%advance(u, 4.0_dp, z, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_driver)
    call require(alive() == 0, 'the last driver takes its system along')
  end subroutine shared

  !> Bits may be copied without an assignment: then both names mean one object, until one of them goes. Nothing is freed twice.
  subroutine copies()
    type(tribo_system), allocatable :: s, r
    type(tribo_driver), allocatable :: d, e
    type(tribo_system) :: empty, full
    real(dp) :: t, y(3)

    allocate (s, d)
    call s%oscillator(0.1_dp, 1.0_dp, 1.0_dp)
    call d%create(s, 'exact')
    allocate (r, source=s)
    allocate (e, source=d)
    deallocate (s, d)
    call require(r%ndof() == 0, 'a system that went by another name')
    t = 0
    y = 0
    call e%advance(t, 1.0_dp, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, no_driver)
    deallocate (r, e)
    ! What has not been created can be assigned.
    call full%oscillator(0.1_dp, 1.0_dp, 1.0_dp)
    full = empty
    call require(full%ndof() == 0, 'assignment of nothing')
  end subroutine copies
end program system_errors
