! SPDX-License-Identifier: BSD-3-Clause
!> A tape of results of the C interface, which is compared with bit for bit: see tape.h.
module tape
  use, intrinsic :: iso_c_binding, only: c_double, c_funloc, c_funptr, c_size_t
  use check, only: require, same_bits
  use tribo, only: dp
  implicit none
  private
  public :: record, end_of_tape, compare

  !> Compares with what comes next on the tape.
  interface compare
    procedure :: compare_reals, compare_real, compare_integer, compare_text
  end interface compare

  interface
    function tape_record(play, values, n) result(used) bind(c)
      import :: c_double, c_funptr, c_size_t
      type(c_funptr), value :: play
      real(c_double), intent(inout) :: values(*)
      integer(c_size_t), value :: n
      integer(c_size_t) :: used
    end function tape_record
  end interface

  real(dp), allocatable :: values(:)
  integer :: at = 0

contains

  !> Records what play puts on the tape, and winds back.
  subroutine record(play)
    interface
      subroutine play() bind(c)
      end subroutine play
    end interface

    allocate (values(200000))
    at = int(tape_record(c_funloc(play), values, size(values, kind=c_size_t)))
    call require(at <= size(values), 'the tape is long enough')
    values = values(:min(at, size(values)))
    at = 0
  end subroutine record

  subroutine end_of_tape()
    call require(at == size(values), 'the tape has been compared to its end')
  end subroutine end_of_tape

  subroutine compare_reals(label, x)
    character(len=*), intent(in) :: label
    real(dp), intent(in) :: x(:)
    integer :: i
    do i = 1, size(x)
      call compare_real(label, x(i))
    end do
  end subroutine compare_reals

  subroutine compare_real(label, x)
    character(len=*), intent(in) :: label
    real(dp), intent(in) :: x
    real(dp) :: wanted
    character(len=200) :: text

    at = at + 1
    wanted = huge(wanted)
    if (at <= size(values)) wanted = values(at)
    text = label
    if (.not. same_bits(x, wanted)) then
      write (text, '(2a,es24.16,a,es24.16,a,i0)') label, ' is', x, ', from C', wanted, ', on the tape at ', at
    end if
    call require(same_bits(x, wanted), trim(text))
  end subroutine compare_real

  subroutine compare_integer(label, i)
    character(len=*), intent(in) :: label
    integer, intent(in) :: i
    call compare_real(label, real(i, dp))
  end subroutine compare_integer

  subroutine compare_text(label, text)
    character(len=*), intent(in) :: label, text
    integer :: i
    call compare_integer('length of ' // label, len(text))
    do i = 1, len(text)
      call compare_integer(label, iachar(text(i:i)))
    end do
  end subroutine compare_text
end module tape
