! SPDX-License-Identifier: BSD-3-Clause
!> Every error that a procedure of module tribo can answer: status, text, outputs left alone, context as it was.
program errors
  use, intrinsic :: iso_c_binding, only: c_null_funptr, c_null_ptr
  use, intrinsic :: ieee_arithmetic, only: ieee_positive_inf, ieee_quiet_nan, ieee_value
  use check, only: blank, blank_integer, expect_error, report, require, untouched
  use errors_mass, only: broken_mass
  use tribo
  implicit none

  integer, parameter :: n = 3
  character(len=*), parameter :: none = 'the context has not been created, or has been destroyed', &
    laws = ': there are coulomb, velocity-limited, smooth, karnopp, quinn, quinn-reversal'
  integer :: stat = blank_integer
  character(len=200) :: msg = ''
  real(dp) :: nan, inf

  nan = ieee_value(nan, ieee_quiet_nan)
  inf = ieee_value(inf, ieee_positive_inf)
  call no_context()
  call creation()
  call registry()
  call settings()
  call operators()
  call compressed_rows()
  call callbacks()
  call forces()
  call queries()
  call messages()
  call report()

contains

  !> Three contacts, with settings that errors must not change.
  subroutine make(c)
    type(tribo_context), intent(inout) :: c
    call c%create(n)
    call c%set_limit([1.0_dp, 2.0_dp, 3.0_dp])
    call c%set_epsilon([0.25_dp, 0.5_dp, 0.75_dp])
    call c%set_operator([1.0_dp, 0.5_dp, 0.25_dp])
  end subroutine make

  !> Whether settings and forces of c are those of make.
  logical function as_made(c)
    type(tribo_context), intent(inout) :: c
    type(tribo_context) :: fresh
    real(dp) :: limit(n), epsilon(n), f(n), wanted(n), rate, wanted_rate
    integer :: law, coupling, sharing

    call make(fresh)
    call c%get_limit(limit)
    call c%get_epsilon(epsilon)
    call c%get_law(law)
    call c%get_coupling(coupling)
    call c%get_sharing(sharing)
    call c%get_real(TRIBO_REAL_MAX_RATE, rate)
    call fresh%get_real(TRIBO_REAL_MAX_RATE, wanted_rate)
    call c%step_force(1.0_dp, [0.3_dp, 0.2_dp, 9.0_dp], f)
    call fresh%step_force(1.0_dp, [0.3_dp, 0.2_dp, 9.0_dp], wanted)
    as_made = all(abs(limit - [1, 2, 3]) <= 0) .and. all(abs(epsilon - [0.25_dp, 0.5_dp, 0.75_dp]) <= 0) .and. &
      law == TRIBO_QUINN .and. coupling == TRIBO_CONSISTENT .and. sharing == TRIBO_SHARE_LEAST_NORM .and. &
      all(abs(f - wanted) <= 0) .and. abs(rate - wanted_rate) <= 0
  end function as_made

  !> Every procedure on a context that has not been created.
  subroutine no_context()
    type(tribo_context) :: c, other
    type(broken_mass) :: mass
    real(dp) :: x(n), y(n), z(n), w(n), q(n, n), p(n, n)
    integer :: i, slip(n)

    x = blank; y = blank; z = blank
    w = blank; q = blank; p = blank
    i = blank_integer
    slip = blank_integer
    call require(c%message() == none, 'message of no context')
    call c%clone(other, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call require(other%message() == none, 'a clone of nothing is nothing')
    call c%get_ncontact(i, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_law(TRIBO_COULOMB, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_law('coulomb', stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_law('nothing', stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_user_law(c_null_funptr, c_null_ptr, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%get_law(i, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_limit(1.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_limit(x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%get_limit(x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_static(x, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%get_static(x, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_epsilon(1.0_dp, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_epsilon(step=1.0_dp, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_epsilon(stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_epsilon(x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%get_epsilon(x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_operator(x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_operator(q, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_operator_csr([1], [1], x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_operator_mass(x, [1], [1], x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_operator_callback(0, mass, [1], [1], x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_coupling(TRIBO_PARTITION, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%get_coupling(i, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%set_sharing(TRIBO_SHARE_PREVIOUS, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%get_sharing(i, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%force(x, x, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%force_tangent(x, x, y, z, w, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%balance(x, x, y, z, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%balance_tangent(x, x, y, z, q, p, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%tangent_product(x, x, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%limit_product(x, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%solve_box(x, x, x, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%step_force(1.0_dp, x, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%accept(x, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%get_slip(slip, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%get_count(TRIBO_COUNT_STUCK, i, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call c%get_real(TRIBO_REAL_RESIDUAL, x(1), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
    call require(all(untouched([x, y, z, w]) .and. all(untouched([q, p]))) .and. all(untouched([i, slip])), 'no context: outputs')
    call c%destroy()
    call make(c)
    call c%destroy()
    call c%get_ncontact(i, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, none)
  end subroutine no_context

  subroutine creation()
    type(tribo_context) :: c
    call make(c)
    call c%create(-2, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'ncontact = -2 is negative')
    call require(as_made(c), 'create: the old context stays')
  end subroutine creation

  subroutine registry()
    integer :: law, stats(3)
    character(len=200) :: msgs(3)
    real(dp) :: f, df_dv, df_dfeq, df_dlimit, values(3), forces(3, 2), z(1), turns(3, 1)
    real(dp), parameter :: ones(2, 2) = 1.0_dp

    law = blank_integer
    call tribo_law_find('quin', law, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NAME, 'no law is called "quin"' // laws)
    call tribo_law_find('VELOCITY-limited  ', law, stat)
    call require(stat == TRIBO_OK .and. law == TRIBO_VELOCITY_LIMITED, 'names in upper case, with blanks')
    stat = blank_integer
    law = blank_integer
    call tribo_law_find('', law, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NAME, 'no law is called ""' // laws)
    ! What stands in quotes is the caller's, and no index.
    call tribo_law_find('contact 3[1]', law, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NAME, 'no law is called "contact 3[1]"' // laws)
    call require(untouched(law), 'tribo_law_find: law')
    f = blank; df_dv = blank; df_dfeq = blank
    df_dlimit = blank
    call tribo_law_eval(99, 1.0_dp, 1.0_dp, 1.0_dp, 1.0_dp, f, df_dv, df_dfeq, df_dlimit, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, tribo_strerror(TRIBO_ERR_RANGE))
    call tribo_law_eval(TRIBO_QUINN, nan, 1.0_dp, 1.0_dp, 1.0_dp, f, df_dv, df_dfeq, df_dlimit, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'v = NaN is not finite')
    call tribo_law_eval(TRIBO_QUINN, 1.0_dp, 1.0_dp, -1.0_dp, 1.0_dp, f, df_dv, df_dfeq, df_dlimit, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'limit = -1.000000 is negative')
    call tribo_law_eval(TRIBO_QUINN, 1.0_dp, 1.0_dp, 1.0_dp, 0.0_dp, f, df_dv, df_dfeq, df_dlimit, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_POSITIVE, 'epsilon = 0.000000 is not positive')
    call require(all(untouched([f, df_dv, df_dfeq, df_dlimit])), 'tribo_law_eval: outputs')
    values = blank
    call tribo_elastic_force([1.0_dp, 1.0_dp], [1.0_dp, 1.0_dp, 1.0_dp], [1.0_dp, 1.0_dp, 1.0_dp], values, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'dz has size 2, not 3')
    call tribo_elastic_force([1.0_dp, 1.0_dp, 1.0_dp], [1.0_dp, 1.0_dp, 1.0_dp], [-0.0_dp, 1.0_dp, -2.0_dp], values, stat=stat, &
      errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'limit(3) = -2.000000 is negative')
    call require(all(untouched(values)), 'tribo_elastic_force: f')
    forces = blank
    call tribo_contact_force(ones, [1.0_dp, 1.0_dp], [1.0_dp], [1.0_dp, 1.0_dp], [1.0_dp, 1.0_dp], forces, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'tangential has size 1, not 2')
    call tribo_contact_force(ones, [-1.0_dp, 1.0_dp], [1.0_dp, 1.0_dp], [1.0_dp, 1.0_dp], [1.0_dp, -2.0_dp], forces, stat=stat, &
      errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'mu(2) = -2.000000 is negative')
    call tribo_contact_force(ones, [-1.0_dp, nan], [1.0_dp, 1.0_dp], [1.0_dp, 1.0_dp], [1.0_dp, 2.0_dp], forces, stat=stat, &
      errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'depth(2) = NaN is not finite')
    call require(all(untouched(reshape(forces, [6]))), 'tribo_contact_force: f')
    values = blank
    z = 0
    turns = blank
    call tribo_lugre_force(0.1_dp, [0.1_dp], reshape([1.0_dp, 0.0_dp, 0.0_dp, 1.0_dp, 1.0_dp], [5, 1]), z, values(:1), &
      stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'parameter has size 5 x 1, not 6 x 1')
    call tribo_lugre_force(0.1_dp, [0.1_dp], reshape([1.0_dp, 0.0_dp, -2.0_dp, 1.0_dp, 1.0_dp, 1.0_dp], [6, 1]), z, values(:1), &
      stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 's2(1) = -2.000000 is negative')
    call tribo_bouc_wen_force([0.1_dp], reshape([1.0_dp, 1.0_dp, nan, 1.0_dp, 1.0_dp], [5, 1]), z, values(:1), stat=stat, &
      errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'beta(1) = NaN is not finite')
    call tribo_iwan_force(-1, [0.1_dp], reshape([1.0_dp, 1.0_dp, 1.0_dp, 1.0_dp], [4, 1]), turns, values(:1), stat=stat, errmsg=msg)
    call require(stat /= TRIBO_OK, 'room of less than nothing')
    call require(all(untouched([values, turns(:, 1)])), 'laws with a state: f')
    values = blank
    msgs = ''
    call tribo_law_eval(TRIBO_QUINN, [9.0_dp, inf, -9.0_dp], 0.0_dp, 2.0_dp, 1.0_dp, values, stat=stats, errmsg=msgs)
    call require(all(stats == [TRIBO_OK, TRIBO_ERR_NOT_FINITE, TRIBO_OK]), 'tribo_law_eval of arrays: stat')
    call require(all(abs(values - [-2.0_dp, blank, 2.0_dp]) <= 0), 'tribo_law_eval of arrays: f')
    call require(msgs(1) == '', 'tribo_law_eval of arrays: no errmsg')
    call expect_error(stats(2), msgs(2), TRIBO_ERR_NOT_FINITE, 'v = Inf is not finite')
  end subroutine registry

  subroutine settings()
    type(tribo_context) :: c
    real(dp) :: x(4)

    call make(c)
    call c%set_law(6, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'law = 6 is none of the 6 laws')
    ! No number is cut to the half of it that an int of C takes, where integers have eight bytes: that half is a law.
    call c%set_law(shiftl(1, bit_size(1)/2), stat)
    call require(stat == TRIBO_ERR_RANGE, 'set_law: a large number')
    call c%set_user_law(c_null_funptr, c_null_ptr, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, 'law is NULL')
    call c%set_law('Quin', stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NAME, 'no law is called "Quin"' // laws)
    call c%set_law(repeat('x', 500), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NAME, 'no law is called "' // repeat('x', 40) // '"' // laws)
    call c%set_coupling(2, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'coupling = 2 is neither TRIBO_CONSISTENT nor TRIBO_PARTITION')
    call c%set_sharing(-1, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'sharing = -1 is neither TRIBO_SHARE_LEAST_NORM nor TRIBO_SHARE_PREVIOUS')
    call c%set_limit([1.0_dp, 2.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'limit has size 2, not 3')
    call c%set_planar([1, 3], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'first(2) = 3 is not in 1 to 2')
    call c%set_planar([0], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'first(1) = 0 is not in 1 to 2')
    call c%set_planar([1, 2], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_DUPLICATE, 'first(2) takes contact 2, which first(1) has taken')
    call c%set_limit([1.0_dp, nan, 2.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'limit(2) = nan is not finite')
    call c%set_limit([1.0_dp, 1.0_dp, -0.5_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'limit(3) = -0.5 is negative')
    call c%set_planar([2], stat, msg)
    call c%set_static([1.0_dp, 1.5_dp, 2.0_dp], stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'ratio(2) = 1.5 and ratio(3) = 2 are of one planar contact, and differ')
    call c%set_planar([integer ::], stat, msg)
    call c%set_static([1.0_dp, 2.0_dp], stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'ratio has size 2, not 3')
    call c%set_static([1.0_dp, 2.0_dp, 0.5_dp], stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'ratio(3) = 0.5 is below 1')
    call c%set_static([1.0_dp, 2.0_dp, 2.0_dp], [1.0_dp, 0.0_dp, 1.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_POSITIVE, 'velocity(2) = 0 is not positive')
    call c%set_static([1.0_dp, 2.0_dp, 2.0_dp], [1.0_dp, 1.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'velocity has size 2, not 3')
    call c%set_limit(inf, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'limit = inf is not finite')
    call c%set_limit(-1.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'limit = -1 is negative')
    call c%set_epsilon([1.0_dp, 2.0_dp, 3.0_dp, 4.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'epsilon has size 4, not 3')
    call c%set_epsilon([inf, 1.0_dp, 1.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'epsilon(1) = inf is not finite')
    call c%set_epsilon([1.0_dp, 1.0_dp, 0.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_POSITIVE, 'epsilon(3) = 0 is not positive')
    call c%set_epsilon(0.0_dp, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_POSITIVE, 'epsilon = 0 is not positive')
    call c%set_epsilon(step=-1.0_dp, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_POSITIVE, 'dt = -1 is not positive')
    call c%set_epsilon(step=1.0_dp, lambda_dt=nan, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'lambda_dt = nan is not finite')
    call c%set_epsilon(stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'set_epsilon takes either epsilon or step')
    call c%set_epsilon(1.0_dp, step=1.0_dp, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'set_epsilon takes either epsilon or step')
    call c%set_epsilon(1.0_dp, lambda_dt=1.0_dp, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'set_epsilon takes lambda_dt with step only')
    x = blank
    call c%get_limit(x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'limit has size 4, not 3')
    call c%get_epsilon(x(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'epsilon has size 2, not 3')
    call require(all(untouched(x)), 'settings: outputs')
    call require(as_made(c), 'settings stay')
  end subroutine settings

  subroutine operators()
    type(tribo_context) :: c
    real(dp) :: r(n, n)

    call make(c)
    call c%set_operator([1.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'r has size 1, not 3')
    call c%set_operator([1.0_dp, -1.0_dp, 1.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'r(2) = -1 is negative')
    r = reshape([2, 1, 0, 1, 2, 0, 0, 0, 2], [n, n])
    call c%set_operator(r(:2, :), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'r has size 2 x 3, not 3 x 3')
    call c%set_operator(r(:, :2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'r has size 3 x 2, not 3 x 3')
    r(1, 3) = nan
    call c%set_operator(r, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'r(1,3) = nan is not finite')
    r(1, 3) = 0
    r(1, 2) = 0.5_dp
    call c%set_operator(r, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_SYMMETRIC, 'r of contacts 1, 2 is 0.5 one way and 1 the other')
    r(1:2, 1:2) = reshape([1, 2, 2, 1], [2, 2])
    call c%set_operator(r, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_INDEFINITE, &
      "r of contacts 1, 2 is 2, more than the root of their diagonal entries' product, 1")
    r = -0.75_dp
    r(1, 1) = 1
    r(2, 2) = 1
    r(3, 3) = 1
    call c%set_operator(r, stat, msg)
    call require(index(msg, ' at contact 3, in a group of 3 coupled contacts') > 0, 'indefinite r: ' // trim(msg))
    call require(stat == TRIBO_ERR_INDEFINITE, 'indefinite r')
    call require(as_made(c), 'the operator stays')
  end subroutine operators

  subroutine compressed_rows()
    type(tribo_context) :: c
    real(dp), parameter :: val(4) = [1, 2, 3, 4], minv(2) = [1, 1]

    call make(c)
    call csr(c, [1, 2, 5], [1, 2, 3, 1], val, TRIBO_ERR_SIZE, 'rowptr has size 3, not 4')
    call csr(c, [1, 2, 4, 5], [1, 2, 3], val, TRIBO_ERR_SIZE, 'val has size 4, not 3')
    call csr(c, [0, 2, 4, 5], [1, 2, 3, 1], val, TRIBO_ERR_SIZE, 'rowptr(1) = 0 is not 1')
    call csr(c, [1, 4, 2, 5], [1, 2, 3, 1], val, TRIBO_ERR_SIZE, 'rowptr(3) = 2 is less than the one before')
    call csr(c, [1, 2, 3, 4], [1, 2, 3, 1], val, TRIBO_ERR_SIZE, 'rowptr(4) = 4 does not end where col does')
    call csr(c, [1, 2, 3, 9], [1, 2, 3, 1], val, TRIBO_ERR_SIZE, 'rowptr(4) = 9 does not end where col does')
    call csr(c, [1, 2, 4, 5], [1, 0, 3, 1], val, TRIBO_ERR_RANGE, 'col(2) = 0 is not in 1 to 3')
    call csr(c, [1, 2, 4, 5], [1, 2, 3, 4], val, TRIBO_ERR_RANGE, 'col(4) = 4 is not in 1 to 3')
    call csr(c, [1, 2, 4, 5], [-3, 2, 3, 1], val, TRIBO_ERR_RANGE, 'col(1) = -3 is not in 1 to 3')
    call csr(c, [1, 2, 4, 5], [1, 2, 3, 3], [val(:3), nan], TRIBO_ERR_NOT_FINITE, 'val(4) = nan of contact 3 is not finite')
    call csr(c, [1, 2, 4, 5], [1, 2, 2, 3], val, TRIBO_ERR_DUPLICATE, 'contact 2 has column 2 twice')
    call csr(c, [1, 2, 4, 5], [1, 2, 3, 3], val, TRIBO_ERR_NOT_SYMMETRIC, 'r of contacts 2, 3 is 3 one way and 0 the other')
    call c%set_operator_mass([1.0_dp, -1.0_dp], [1, 2, 3, 4], [1, 2, 1], val(:3), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'inverse_mass(2) = -1 is negative')
    call c%set_operator_mass(minv, [1, 2, 3], [1, 2, 1], val(:3), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'rowptr has size 3, not 4')
    call c%set_operator_mass(minv, [1, 2, 3, 4], [1, 2, 3], val(:3), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'col(3) = 3 is not in 1 to 2')
    call c%set_operator_mass(minv, [1, 2, 3, 4], [1, 2, 1], val, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'val has size 4, not 3')
    call c%set_operator_mass(minv, [1, 3, 4, 5], [1, 1, 2, 1], val, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_DUPLICATE, 'contact 1 has column 1 twice')
    call require(as_made(c), 'the operator in compressed rows stays')
  end subroutine compressed_rows

  subroutine callbacks()
    type(tribo_context) :: c
    type(broken_mass) :: mass
    integer, parameter :: rowptr(n + 1) = [1, 2, 3, 4], col(n) = [1, 2, 3]
    real(dp), parameter :: val(n) = 1

    call make(c)
    call callback(c, mass, -1, rowptr, col, TRIBO_ERR_NEGATIVE, 'ndof = -1 is negative')
    call callback(c, mass, 3, rowptr(:n), col, TRIBO_ERR_SIZE, 'rowptr has size 3, not 4')
    call callback(c, mass, 3, rowptr, [col, 1], TRIBO_ERR_SIZE, 'val has size 3, not 4')
    call callback(c, mass, 2, rowptr, col, TRIBO_ERR_RANGE, 'col(3) = 3 is not in 1 to 2')
    call callback(c, mass, 3, [1, 3, 3, 4], [1, 1, 2], TRIBO_ERR_DUPLICATE, 'contact 1 has column 1 twice')
    call require(mass%calls == 0, 'apply is called for nothing that is wrong')
    mass%at = 2
    mass%answer = -7
    call callback(c, mass, 3, rowptr, col, TRIBO_ERR_CALLBACK, 'apply answered -7 for contact 2')
    call require(mass%calls == 2, 'apply is called no more')
    mass = broken_mass(at=3, more=nan)
    call callback(c, mass, 3, rowptr, col, TRIBO_ERR_NOT_FINITE, 'apply makes r of contacts 1, 3 nan')
    mass = broken_mass(at=3, more=0.5_dp)
    call callback(c, mass, 3, rowptr, col, TRIBO_ERR_NOT_SYMMETRIC, 'r of contacts 3, 1 is 0.5 one way and 0 the other')
    mass = broken_mass(at=1, more=-2.0_dp)
    call callback(c, mass, 3, rowptr, col, TRIBO_ERR_INDEFINITE, 'r: the diagonal entry of contact 1 is -1')
    call require(as_made(c), 'the operator by a callback stays')
    mass = broken_mass()
    call c%set_operator_callback(3, mass, rowptr, col, val, stat)
    call require(stat == TRIBO_OK .and. mass%calls == n, 'the same without a fault')
  end subroutine callbacks

  subroutine callback(c, mass, ndof, rowptr, col, wanted, text)
    type(tribo_context), intent(inout) :: c
    type(broken_mass), intent(inout) :: mass
    integer, intent(in) :: ndof, rowptr(:), col(:), wanted
    character(len=*), intent(in) :: text
    real(dp), parameter :: val(n) = 1
    call c%set_operator_callback(ndof, mass, rowptr, col, val, stat, msg)
    call expect_error(stat, msg, wanted, text)
  end subroutine callback

  subroutine csr(c, rowptr, col, val, wanted, text)
    type(tribo_context), intent(inout) :: c
    integer, intent(in) :: rowptr(:), col(:), wanted
    real(dp), intent(in) :: val(:)
    character(len=*), intent(in) :: text
    call c%set_operator_csr(rowptr, col, val, stat, msg)
    call expect_error(stat, msg, wanted, text)
  end subroutine csr

  subroutine forces()
    type(tribo_context) :: c
    real(dp), parameter :: v(n) = [0.1_dp, 0.2_dp, 0.3_dp]
    real(dp) :: bad(n), x(n), y(n), z(n), w(n), q(n, n), p(n, n)

    call c%create(n)
    x = blank
    call c%balance(v, v, f=x, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_STATE, &
      'no operator: call tribo_set_operator_diagonal or another tribo_set_operator_... first')
    call c%step_force(1.0_dp, v, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_STATE, &
      'no operator: call tribo_set_operator_diagonal or another tribo_set_operator_... first')
    call require(all(untouched(x)), 'no operator: outputs')
    call make(c)
    bad = [0.0_dp, nan, 0.0_dp]
    x = blank; y = blank; z = blank
    w = blank; q = blank; p = blank
    call c%force(v(:2), v, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'v has size 2, not 3')
    call c%force(v, [v, v], x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'feq has size 6, not 3')
    call c%force(v, v, x(:1), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'f has size 1, not 3')
    call c%force(bad, v, x(n:1:-1), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'v(2) = NaN is not finite')
    call c%force(v, bad, q(2, :), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'feq(2) = NaN is not finite')

    call c%force_tangent(v(:0), v, x, y, z, w, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'v has size 0, not 3')
    call c%force_tangent(v, v(:2), x, y, z, w, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'feq has size 2, not 3')
    call c%force_tangent(v, v, x(:2), y, z, w, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'f has size 2, not 3')
    call c%force_tangent(v, v, x, y(::2), z, w, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'df_dv has size 2, not 3')
    call c%force_tangent(v, v, x, y, z(:2), w, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'df_dfeq has size 2, not 3')
    call c%force_tangent(v, v, x, y, z, w(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'df_dlimit has size 2, not 3')
    call c%force_tangent_planar(v, v, x, q(:, :2), stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'df_dv has size 3 x 2, not 2 x 3')
    call c%force_tangent_planar(v, v, x, df_dfeq=q, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'df_dfeq has size 3 x 3, not 2 x 3')
    call c%force_tangent_planar(v, v, x, df_dlimit=q, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'df_dlimit has size 3 x 3, not 2 x 3')
    call c%force_tangent_planar(v, v(:1), stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'feq has size 1, not 3')
    call c%force_tangent(bad, v, x, y(n:1:-1), q(1, :), q(:, 1), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'v(2) = NaN is not finite')

    call c%balance(v(:2), v, x, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'v has size 2, not 3')
    call c%balance(v, v(:2), x, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'a has size 2, not 3')
    call c%balance(v, v, x(:2), y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'feq has size 2, not 3')
    call c%balance(v, v, f=y(:2), stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'f has size 2, not 3')
    call c%balance(bad, v, x(n:1:-1), q(:, 3), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'v(2) = nan is not finite')
    call c%balance(v, bad, q(1, :), q(3, :), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'a(2) = nan is not finite')

    call c%balance_tangent(v(:2), v, x, y, q, p, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'v has size 2, not 3')
    call c%balance_tangent(v, v(:2), x, y, q, p, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'a has size 2, not 3')
    call c%balance_tangent(v, v, x(:2), y, q, p, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'feq has size 2, not 3')
    call c%balance_tangent(v, v, x, y(:2), q, p, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'f has size 2, not 3')
    call c%balance_tangent(v, v, x, y, q(:2, :), p, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'df_dv has size 2 x 3, not 3 x 3')
    call c%balance_tangent(v, v, x, y, q, p(:, ::2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'df_da has size 3 x 2, not 3 x 3')
    call c%balance_tangent(v, bad, x, y, q(n:1:-1, :), p, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'a(2) = nan is not finite')

    call c%tangent_product(v, v, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_STATE, 'no tribo_balance_tangent since the last balance or change')
    call c%balance_tangent(v, v)
    call c%tangent_product(v(:2), v, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'dv has size 2, not 3')
    call c%tangent_product(v, v(::2), x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'da has size 2, not 3')
    call c%tangent_product(v, v, x(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'df has size 2, not 3')
    call c%tangent_product(bad, v, q(3, :), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'dv(2) = nan is not finite')
    call c%tangent_product(da=bad, df=x(n:1:-1), stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'da(2) = nan is not finite')
    call c%limit_product(v(:2), x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'dlimit has size 2, not 3')
    call c%limit_product(v, x(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'df has size 2, not 3')
    call c%limit_product(bad, x(n:1:-1), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'dlimit(2) = nan is not finite')
    call c%balance(v, v)
    call c%limit_product(v, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_STATE, 'no tribo_balance_tangent since the last balance or change')
    call c%tangent_product(v, v, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_STATE, 'no tribo_balance_tangent since the last balance or change')

    call c%step_force(0.0_dp, v, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_POSITIVE, 'dt = 0 is not positive')
    call c%step_force(inf, v, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'dt = inf is not finite')
    call c%step_force(1.0_dp, v(:2), x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'vfree has size 2, not 3')
    call c%step_force(1.0_dp, v, x(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'f has size 2, not 3')
    call c%step_force(1.0_dp, bad, q(3, :), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'vfree(2) = nan is not finite')

    call c%accept(v(:2), v, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'v has size 2, not 3')
    call c%accept(v, v(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'feq has size 2, not 3')
    call c%accept(bad, v, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'v(2) = nan is not finite')
    call c%set_law(TRIBO_QUINN_REVERSAL)
    call c%accept(v, bad, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'feq(2) = nan is not finite')
    call c%set_law(TRIBO_QUINN)

    call require(all(untouched([x, y, z, w])) .and. all(untouched([q, p])), 'forces: outputs')
    call require(as_made(c), 'forces: settings')

    ! The one error that comes with outputs: the least-squares f_eq.
    q = 1
    call c%set_operator(q)
    call c%set_coupling(TRIBO_PARTITION)
    call c%balance([0.0_dp, 0.0_dp, 0.0_dp], [0.3_dp, 0.3_dp, 0.9_dp], x, y, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_INCONSISTENT, &
      'no f_eq balances the 3 contacts near stick around contact 1: rank 1, and a is outside its range')
    call c%solve_box(v(:2), v, v, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'a has size 2, not 3')
    call c%solve_box(v, v(:2), v, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'lower has size 2, not 3')
    call c%solve_box(v, v, v(2:), x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'upper has size 2, not 3')
    call c%solve_box(v, v, v, x(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'f has size 2, not 3')
    call c%solve_box(v, bad, v, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_FINITE, 'lower(2) = nan is not finite')
    call c%solve_box(v, v + 1, v, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'lower(1) = 1.1 is above upper(1) = 0.1')
    call require(.not. any(untouched([x, y])), 'balance: outputs of TRIBO_ERR_INCONSISTENT')
  end subroutine forces

  subroutine queries()
    type(tribo_context) :: c
    integer :: slip(n), i
    real(dp) :: x

    call make(c)
    slip = blank_integer
    i = blank_integer
    x = blank
    call c%get_slip(slip, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_STATE, &
      'another call must come first')
    call c%balance([0.0_dp, 0.0_dp, 0.0_dp], [0.0_dp, 0.0_dp, 0.0_dp])
    call c%get_slip(slip(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'slip has size 2, not 3')
    call c%get_count(99, i, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'an index or a choice is out of range')
    call c%get_real(-1, x, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'an index or a choice is out of range')
    call require(all(untouched([slip, i])) .and. untouched(x), 'queries: outputs')
  end subroutine queries

  !> What becomes of errmsg, and of the message of a context.
  subroutine messages()
    type(tribo_context) :: c
    character(len=7) :: short
    character(len=60) :: long
    character(len=:), allocatable :: own

    call make(c)
    call require(c%message() == '', 'no message yet')
    short = 'as is'
    call c%set_limit(1.0_dp, stat, short)
    call require(stat == TRIBO_OK .and. short == 'as is', 'errmsg without an error')
    call c%set_limit(-1.0_dp, stat, short)
    call require(short == 'limit =', 'a short errmsg')
    long = repeat('x', len(long))
    call c%set_limit(-1.0_dp, stat, long)
    call require(long == 'limit = -1 is negative', 'a long errmsg')
    own = repeat('y', 30)
    call c%set_limit(-1.0_dp, stat, own)
    call require(own == 'limit = -1 is negative' .and. len(own) == 30, 'an allocated errmsg')
    call c%set_limit(2.0_dp)
    call require(c%message() == 'limit = -1 is negative', 'a message stays')
    call c%set_limit(-1.0_dp, stat)
    call require(stat == TRIBO_ERR_NEGATIVE, 'stat without errmsg')
    call c%set_limit([1.0_dp, 1.0_dp], stat)
    call require(c%message() == 'limit has size 2, not 3', 'the message of an error that Fortran finds')
  end subroutine messages
end program errors
