! SPDX-License-Identifier: BSD-3-Clause
!> A program that stops at invalid operations, divisions by zero and overflows (-ffpe-trap) runs through all calls that compute,
!> by the module and by the fixed-form routines: with contacts that friction cannot move (R = 0), open ones, and limits that are
!> never reached.
module traps_mass
  use tribo, only: dp, tribo_mass
  implicit none
  private
  public :: divide_fixed

  type, extends(tribo_mass), public :: two_bodies
  contains
    procedure :: apply => divide
  end type two_bodies

contains

  integer function divide(this, force, acceleration) result(answer)
    class(two_bodies), intent(inout) :: this
    real(dp), intent(in) :: force(:)
    real(dp), intent(inout) :: acceleration(:)
    acceleration(1) = 0.5_dp*force(1)
    acceleration(2) = 0
    answer = merge(0, 1, same_type_as(this, two_bodies()))
  end function divide

  !> The same for TRBOPC.
  subroutine divide_fixed(ndof, force, acc, rpar, ipar, ier)
    integer, intent(in) :: ndof
    real(dp), intent(in) :: force(*)
    real(dp), intent(inout) :: acc(*), rpar(*)
    integer, intent(inout) :: ipar(*), ier
    acc(1) = 0.5_dp*force(1)
    acc(2) = 0
    rpar(1) = rpar(1) + 1
    ipar(1) = ipar(1) + 1
    if (ndof /= 2) ier = 1
  end subroutine divide_fixed
end module traps_mass

program traps
  use check, only: report, require
  use traps_mass, only: divide_fixed, two_bodies
  use tribo
  implicit none

  integer, parameter :: n = 4, ndof = 2, forms = 5
  !> Contacts of two bodies, the second of which is held: 1 and 4 with the ground, 2 between the two, 3 of the held one alone.
  integer, parameter :: rowptr(n + 1) = [1, 2, 4, 5, 6], col(5) = [1, 1, 2, 2, 1]
  real(dp), parameter :: val(5) = [1.0_dp, -1.0_dp, 1.0_dp, 1.0_dp, 1.0_dp], inverse_mass(ndof) = [0.5_dp, 0.0_dp], &
    r(n, n) = 0.5_dp*reshape([1, -1, 0, 1, -1, 1, 0, -1, 0, 0, 0, 0, 1, -1, 0, 1], [n, n]), &
    diagonal(n) = [1.0_dp, 2.0_dp, 0.0_dp, 0.5_dp]
  real(dp), parameter :: limits(n, 3) = reshape([1.0_dp, 2.0_dp, 0.5_dp, 0.0_dp, 1e300_dp, 1.0_dp, 1.0_dp, 1.0_dp, &
    0.0_dp, 0.0_dp, huge(1.0_dp), 1e-310_dp], [n, 3])
  integer :: law, coupling, form, limit, width

  do law = 0, tribo_law_count() - 1
    do coupling = TRIBO_CONSISTENT, TRIBO_PARTITION
      do form = 1, forms
        do limit = 1, 3
          do width = 1, 3
            call by_module(law, coupling, form, limits(:, limit), width)
            call by_routines(law, coupling, form, max(limits(:, limit), merge(1e-280_dp, 0.0_dp, limits(:, limit) > 0)), width)
          end do
        end do
      end do
    end do
  end do
  call report()

contains

  !> What contacts meet in a call: rest, the band, sliding; pulls that can be balanced and others.
  subroutine state(k, v, a)
    integer, intent(in) :: k
    real(dp), intent(out) :: v(n), a(n)
    v = 0
    if (mod(k, 3) == 1) v = [1e-9_dp, -1e-9_dp, 0.0_dp, 1e-9_dp]
    if (mod(k, 3) == 2) v = [3.0_dp, -3.0_dp, 1e10_dp, -1e-300_dp]
    a = 0
    if (k > 2) a = [0.25_dp, -0.25_dp, 7.0_dp, 0.25_dp]
  end subroutine state

  subroutine require_finite(x, label)
    real(dp), intent(in) :: x(:)
    character(len=*), intent(in) :: label
    call require(all(abs(x) <= huge(1.0_dp)), label)
  end subroutine require_finite

  subroutine by_module(law, coupling, form, limit, width)
    integer, intent(in) :: law, coupling, form, width
    real(dp), intent(in) :: limit(n)
    type(tribo_context) :: c
    type(two_bodies) :: mass
    real(dp) :: v(n), a(n), feq(n), f(n), dv(n), dfeq(n), dlimit(n), by_v(n, n), by_a(n, n), x
    integer :: k, stat, mode(n)

    call c%create(n)
    call c%set_law(law)
    call c%set_coupling(coupling)
    call c%set_limit(limit)
    if (form == 1) call c%set_operator(diagonal)
    if (form == 2) call c%set_operator(r)
    if (form == 3) call c%set_operator_csr([1, 4, 7, 7, 10], [1, 2, 4, 1, 2, 4, 1, 2, 4], &
      0.5_dp*[1, -1, 1, -1, 1, -1, 1, -1, 1])
    if (form == 4) call c%set_operator_mass(inverse_mass, rowptr, col, val)
    if (form == 5) call c%set_operator_callback(ndof, mass, rowptr, col, val)
    if (width == 1) call c%set_epsilon(1e-6_dp)
    if (width == 2) call c%set_epsilon(1e-300_dp)
    if (width == 3) call c%set_epsilon(step=1e-3_dp)
    do k = 0, 5
      call state(k, v, a)
      call c%balance(v, a, feq, f, stat)
      call require(stat == TRIBO_OK .or. stat == TRIBO_ERR_INCONSISTENT, 'balance')
      call require_finite([feq, f], 'balance')
      call c%balance_tangent(v, a, feq, f, by_v, by_a, stat)
      if (stat == TRIBO_OK) then
        call require_finite([reshape(by_v, [n*n]), reshape(by_a, [n*n])], 'balance_tangent')
        call c%tangent_product(v, a, f)
        call require_finite(f, 'tangent_product')
        call c%limit_product(a, f)
        call require_finite(f, 'limit_product')
      end if
      call c%step_force(1e-3_dp, v, f)
      call require_finite(f, 'step_force')
      call c%get_slip(mode)
      call c%solve_box(a, -limit, limit, f)
      call require_finite(f, 'solve_box')
      call c%force_tangent(v, feq, f, dv, dfeq, dlimit)
      call require_finite([f, dv, dfeq, dlimit], 'force_tangent')
      call c%accept(v, feq)
      call tribo_law_eval(law, v(1), feq(1), limit(1), 1e-6_dp, f(1), dv(1), dfeq(1), dlimit(1))
    end do
    do k = TRIBO_REAL_RESIDUAL, TRIBO_REAL_MAX_RATE
      call c%get_real(k, x)
      call require_finite([x], 'get_real')
    end do
    call c%get_real(TRIBO_REAL_MAX_STEP, x)
  end subroutine by_module

  subroutine by_routines(law, coupling, form, limit, width)
    integer, intent(in) :: law, coupling, form, width
    real(dp), intent(in) :: limit(n)
    external :: trbnew, trblaw, trbcpl, trblim, trbopd, trbopf, trbops, trbopm, trbopc, trbep1, trbstp, trbbal, trbbtn, trbtpr, &
      trbstf, trbbox, trbftn, trbacc, trbval, trbdel
    real(dp) :: v(n), a(n), feq(n), f(n), dv(n), dfeq(n), dlimit(n), by_v(n, n), by_a(n, n), x, rpar(1)
    integer :: k, ih, ierr, ipar(1), bad

    bad = 0
    ipar = 0
    rpar = 0
    call trbnew(n, ih, ierr)
    bad = bad + ierr
    call trblaw(ih, law, ierr)
    bad = bad + ierr
    call trbcpl(ih, coupling, ierr)
    bad = bad + ierr
    call trblim(ih, n, limit, ierr)
    bad = bad + ierr
    if (form == 1) call trbopd(ih, n, diagonal, ierr)
    if (form == 2) call trbopf(ih, n, r, n, ierr)
    if (form == 3) call trbops(ih, n, [1, 4, 7, 7, 10], [1, 2, 4, 1, 2, 4, 1, 2, 4], 0.5_dp*[1, -1, 1, -1, 1, -1, 1, -1, 1], ierr)
    if (form == 4) call trbopm(ih, n, ndof, inverse_mass, rowptr, col, val, ierr)
    if (form == 5) call trbopc(ih, n, ndof, divide_fixed, rowptr, col, val, rpar, ipar, ierr)
    bad = bad + ierr
    if (width == 1) call trbep1(ih, 1e-6_dp, ierr)
    if (width == 2) call trbep1(ih, 1e-300_dp, ierr)
    if (width == 3) call trbstp(ih, 1e-3_dp, 1.0_dp, ierr)
    bad = bad + ierr
    do k = 0, 5
      call state(k, v, a)
      feq = 0
      call trbbal(ih, n, v, a, feq, f, ierr)
      bad = bad + merge(0, ierr, ierr == TRIBO_ERR_INCONSISTENT)
      call trbbtn(ih, n, v, a, feq, f, by_v, by_a, n, ierr)
      if (ierr == TRIBO_OK) call trbtpr(ih, n, v, a, f, ierr)
      bad = bad + merge(0, ierr, ierr == TRIBO_ERR_INCONSISTENT)
      call trbstf(ih, n, 1e-3_dp, v, f, ierr)
      bad = bad + ierr
      call require_finite(f, 'TRBSTF')
      call trbbox(ih, n, a, -limit, limit, f, ierr)
      bad = bad + ierr
      call trbftn(ih, n, v, feq, f, dv, dfeq, dlimit, ierr)
      bad = bad + ierr
      call require_finite([f, dv, dfeq, dlimit], 'TRBFTN')
      call trbacc(ih, n, v, feq, ierr)
      bad = bad + ierr
    end do
    call trbval(ih, TRIBO_REAL_MAX_STEP, x, ierr)
    bad = bad + ierr
    call trbdel(ih, ierr)
    call require(bad + ierr == 0, 'fixed-form routines')
  end subroutine by_routines
end program traps
