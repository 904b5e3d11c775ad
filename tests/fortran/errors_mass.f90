! SPDX-License-Identifier: BSD-3-Clause
!> For errors.f90.
module errors_mass
  use tribo
  implicit none

  !> A mass matrix that fails: at the given call it answers so, or accelerates what it should not by so much.
  type, extends(tribo_mass) :: broken_mass
    integer :: calls = 0, at = 0, answer = 0
    real(dp) :: more = 0
  contains
    procedure :: apply
  end type broken_mass

contains

  integer function apply(this, force, acceleration)
    class(broken_mass), intent(inout) :: this
    real(dp), intent(in) :: force(:)
    real(dp), intent(inout) :: acceleration(:)
    this%calls = this%calls + 1
    acceleration = force
    apply = 0
    if (this%calls /= this%at) return
    acceleration(1) = acceleration(1) + this%more
    apply = this%answer
  end function apply
end module errors_mass
