!> The data of scene.c and its tape of results, which is compared with bit for bit.
module scene
  use, intrinsic :: iso_c_binding, only: c_double, c_size_t
  use check, only: require, same_bits
  use tribo, only: dp
  implicit none
  private
  public :: rewind_tape, end_of_tape, compare

  integer, parameter, public :: n = 4, ndof = 6, states = 5, counts = 8, reals = 3

  real(c_double), bind(c), public :: scene_limit(n), scene_epsilon(n), scene_diagonal(n), scene_dense(n, n)
  integer(c_size_t), bind(c), public :: scene_rowptr(n + 1), scene_col(8), scene_j_rowptr(n + 1), scene_j_col(5)
  real(c_double), bind(c), public :: scene_val(8), scene_inverse_mass(ndof), scene_j_val(5)
  real(c_double), bind(c), public :: scene_lower(n), scene_upper(n)
  real(c_double), bind(c), public :: scene_v(n, states), scene_a(n, states), scene_feq(n, states)

  !> Compares with what comes next on the tape.
  interface compare
    procedure :: compare_reals, compare_real, compare_integer, compare_text
  end interface compare

  interface
    function scene_play(values, n) result(used) bind(c)
      import :: c_double, c_size_t
      real(c_double), intent(inout) :: values(*)
      integer(c_size_t), value :: n
      integer(c_size_t) :: used
    end function scene_play
  end interface

  real(dp), allocatable :: tape(:)
  integer :: at = 0

contains

  subroutine rewind_tape()
    allocate (tape(200000))
    at = int(scene_play(tape, size(tape, kind=c_size_t)))
    call require(at <= size(tape), 'the tape is long enough')
    tape = tape(:min(at, size(tape)))
    at = 0
  end subroutine rewind_tape

  subroutine end_of_tape()
    call require(at == size(tape), 'the tape has been compared to its end')
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
    if (at <= size(tape)) wanted = tape(at)
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
end module scene
