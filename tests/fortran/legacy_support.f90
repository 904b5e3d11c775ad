! SPDX-License-Identifier: BSD-3-Clause
!> For legacy.f: the scene and its tape, see scene.f90, as a program without modules can use them.

!> The scene's data, at the given places of an array that is larger, and matrices with a leading dimension ldr.
subroutine scdata(fmun, eps, rdiag, r, ldr, irow, icol, val, rminv, jrow, jcol, rj, flo, fup, shared)
  use scene
  use tribo, only: dp
  implicit none
  integer, intent(in) :: ldr
  real(dp), intent(inout) :: fmun(*), eps(*), rdiag(*), r(ldr, *), val(*), rminv(*), rj(*), flo(*), fup(*), shared
  integer, intent(inout) :: irow(*), icol(*), jrow(*), jcol(*)
  fmun(:n) = scene_limit
  eps(:n) = scene_epsilon
  rdiag(:n) = scene_diagonal
  r(:n, :n) = transpose(scene_dense)
  irow(:n + 1) = int(scene_rowptr) + 1
  icol(:8) = int(scene_col) + 1
  val(:8) = scene_val
  rminv(:ndof) = scene_inverse_mass
  jrow(:n + 1) = int(scene_j_rowptr) + 1
  jcol(:5) = int(scene_j_col) + 1
  rj(:5) = scene_j_val
  flo(:n) = scene_lower
  fup(:n) = scene_upper
  shared = scene_shared
end subroutine scdata

subroutine scstat(k, v, a, feq)
  use scene
  use tribo, only: dp
  implicit none
  integer, intent(in) :: k
  real(dp), intent(inout) :: v(*), a(*), feq(*)
  v(:n) = scene_v(:, k)
  a(:n) = scene_a(:, k)
  feq(:n) = scene_feq(:, k)
end subroutine scstat

subroutine scplay()
  use scene, only: scene_play
  use tape, only: record
  call record(scene_play)
end subroutine scplay

subroutine scend()
  use tape, only: end_of_tape
  call end_of_tape()
end subroutine scend

subroutine cmpr(label, n, x)
  use tape, only: compare
  use tribo, only: dp
  implicit none
  character(len=*), intent(in) :: label
  integer, intent(in) :: n
  real(dp), intent(in) :: x(n)
  call compare(label, x)
end subroutine cmpr

subroutine cmpi(label, i)
  use tape, only: compare
  implicit none
  character(len=*), intent(in) :: label
  integer, intent(in) :: i
  call compare(label, i)
end subroutine cmpi

!> A text, up to its last character that is not blank.
subroutine cmpt(label, text)
  use tape, only: compare
  implicit none
  character(len=*), intent(in) :: label, text
  call compare(label, trim(text))
end subroutine cmpt

subroutine expect(label, holds)
  use check, only: require
  implicit none
  character(len=*), intent(in) :: label
  logical, intent(in) :: holds
  call require(holds, label)
end subroutine expect

!> A call answered ierr and text, and should have answered icode and wants.
subroutine says(label, ierr, icode, text, wants)
  use check, only: require
  implicit none
  character(len=*), intent(in) :: label, text, wants
  integer, intent(in) :: ierr, icode
  character(len=400) :: full
  write (full, '(2a,i0,3a)') label, ': status ', ierr, ' "', trim(text), '"'
  call require(ierr == icode .and. text == wants, trim(full))
end subroutine says

!> The last call on ih answered ierr, and should have answered icode; what it has to say begins with text.
subroutine wanted(label, ih, ierr, icode, text)
  use check, only: require
  implicit none
  character(len=*), intent(in) :: label, text
  integer, intent(in) :: ih, ierr, icode
  character(len=120) :: found
  character(len=400) :: full
  integer :: idle
  external :: trbmsg
  idle = 0
  call trbmsg(ih, found, idle)
  write (full, '(2a,i0,3a)') label, ': status ', ierr, ' "', trim(found), '"'
  call require(ierr == icode .and. found == text, trim(full))
end subroutine wanted

subroutine report_all()
  use check, only: report
  call report()
end subroutine report_all

!> Contexts that exist.
integer function nalive()
  use check, only: alive
  implicit none
  nalive = int(alive())
end function nalive
