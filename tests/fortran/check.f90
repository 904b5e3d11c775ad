! SPDX-License-Identifier: BSD-3-Clause
!> What the tests share: failures are told and counted, and end the program when all is done.
module check
  use, intrinsic :: iso_c_binding, only: c_int32_t
  use, intrinsic :: iso_fortran_env, only: error_unit, int64
  use tribo, only: dp
  implicit none
  private
  public :: require, same_bits, expect_error, report, untouched, alive
  public :: blank, blank_integer

  !> What outputs hold before a call that must not touch them.
  real(dp), parameter :: blank = -777.25_dp
  integer, parameter :: blank_integer = -777

  !> Whether outputs still hold that.
  interface untouched
    procedure :: untouched_real, untouched_integer
  end interface untouched

  integer :: checks = 0, failures = 0

  interface
    !> Contexts that exist.
    function alive() result(count) bind(c, name='tribo_handle_count')
      import :: c_int32_t
      integer(c_int32_t) :: count
    end function alive
  end interface

contains

  subroutine require(holds, label)
    logical, intent(in) :: holds
    character(len=*), intent(in) :: label
    checks = checks + 1
    if (holds) return
    failures = failures + 1
    write (error_unit, '(2a)') 'failed: ', label
  end subroutine require

  elemental logical function same_bits(x, y)
    real(dp), intent(in) :: x, y
    same_bits = transfer(x, 0_int64) == transfer(y, 0_int64)
  end function same_bits

  elemental logical function untouched_real(x)
    real(dp), intent(in) :: x
    untouched_real = same_bits(x, blank)
  end function untouched_real

  elemental logical function untouched_integer(i)
    integer, intent(in) :: i
    untouched_integer = i == blank_integer
  end function untouched_integer

  !> A call answered stat and errmsg, and should have answered wanted and text. Wipes both for the next call.
  subroutine expect_error(stat, errmsg, wanted, text)
    integer, intent(inout) :: stat
    character(len=*), intent(inout) :: errmsg
    integer, intent(in) :: wanted
    character(len=*), intent(in) :: text
    character(len=400) :: label
    write (label, '(a,i0,5a,i0,3a)') 'status ', stat, ' "', trim(errmsg), '", should be', ' ', 'status ', wanted, ' "', text, '"'
    call require(stat == wanted .and. errmsg == text, trim(label))
    stat = blank_integer
    errmsg = ''
  end subroutine expect_error

  subroutine report()
    write (*, '(i0,a,i0,a)') checks, ' checks, ', failures, ' failed'
    if (failures > 0) error stop 1
  end subroutine report
end module check
