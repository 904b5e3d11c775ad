! SPDX-License-Identifier: BSD-3-Clause
!> Systems from matrices in one call, by a model.
module making
  use tribo, only: dp, TRIBO_OK
  use tribo_dynamics
  implicit none
  private
  public :: make_linear, make_reduced

  !> All degrees of freedom, or the nmode lowest modes where nmode is present and not 0; full matrices,
  !> or sparse ones of a model with size(1) degrees of freedom and size(2) contacts.
  interface make_linear
    procedure :: linear_dense, linear_sparse
  end interface make_linear

contains

  subroutine linear_dense(sys, mass, stiffness, direction, damping, nmode, stat, errmsg)
    type(tribo_system), intent(inout) :: sys
    real(dp), intent(in) :: mass(:,:), stiffness(:,:), direction(:,:)
    real(dp), intent(in), optional :: damping(:,:)
    integer, intent(in), optional :: nmode
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(tribo_model) :: model
    character(len=240) :: text
    integer :: status

    call model%create(size(mass, 1), size(direction, 1), status, text)
    if (status == TRIBO_OK) call model%set_mass(mass, status, text)
    if (status == TRIBO_OK) call model%set_stiffness(stiffness, status, text)
    if (status == TRIBO_OK) call model%set_direction(direction, status, text)
    if (status == TRIBO_OK .and. present(damping)) call model%set_damping(damping, status, text)
    call make(sys, model, status, text, nmode, TRIBO_STATICS_NONE)
    call finish(status, text, stat, errmsg)
  end subroutine linear_dense

  subroutine linear_sparse(sys, size, mass, stiffness, direction, damping, nmode, stat, errmsg)
    type(tribo_system), intent(inout) :: sys
    integer, intent(in) :: size(2)
    type(tribo_sparse), intent(in) :: mass, stiffness, direction
    type(tribo_sparse), intent(in), optional :: damping
    integer, intent(in), optional :: nmode
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(tribo_model) :: model
    character(len=240) :: text
    integer :: status

    call fill(model, size, mass, stiffness, direction, status, text)
    if (status == TRIBO_OK .and. present(damping)) call model%set_damping(damping, status, text)
    call make(sys, model, status, text, nmode, TRIBO_STATICS_NONE)
    call finish(status, text, stat, errmsg)
  end subroutine linear_sparse

  !> The nmode lowest modes and, unless statics is .false., static responses of the contacts.
  subroutine make_reduced(sys, size, mass, stiffness, direction, nmode, statics, stat, errmsg)
    type(tribo_system), intent(inout) :: sys
    integer, intent(in) :: size(2)
    type(tribo_sparse), intent(in) :: mass, stiffness, direction
    integer, intent(in) :: nmode
    logical, intent(in), optional :: statics
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(tribo_model) :: model
    character(len=240) :: text
    integer :: status

    call fill(model, size, mass, stiffness, direction, status, text)
    if (status == TRIBO_OK) then
      if (present(statics)) then
        call sys%reduce(model, nmode, merge(TRIBO_STATICS_MASS, TRIBO_STATICS_NONE, statics), status, text)
      else
        call sys%reduce(model, nmode, stat=status, errmsg=text)
      end if
    end if
    call finish(status, text, stat, errmsg)
  end subroutine make_reduced

  subroutine fill(model, size, mass, stiffness, direction, status, text)
    type(tribo_model), intent(inout) :: model
    integer, intent(in) :: size(2)
    type(tribo_sparse), intent(in) :: mass, stiffness, direction
    integer, intent(out) :: status
    character(len=*), intent(inout) :: text

    call model%create(size(1), size(2), status, text)
    if (status == TRIBO_OK) call model%set_mass(mass, status, text)
    if (status == TRIBO_OK) call model%set_stiffness(stiffness, status, text)
    if (status == TRIBO_OK) call model%set_direction(direction, status, text)
  end subroutine fill

  subroutine make(sys, model, status, text, nmode, statics)
    type(tribo_system), intent(inout) :: sys
    type(tribo_model), intent(in) :: model
    integer, intent(inout) :: status
    character(len=*), intent(inout) :: text
    integer, intent(in), optional :: nmode
    integer, intent(in) :: statics
    integer :: modes

    modes = 0
    if (present(nmode)) modes = nmode
    if (status /= TRIBO_OK) return
    if (modes /= 0) then
      call sys%reduce(model, modes, statics, status, text)
    else
      call sys%create(model, status, text)
    end if
  end subroutine make

  subroutine finish(status, text, stat, errmsg)
    integer, intent(in) :: status
    character(len=*), intent(in) :: text
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg

    if (present(stat)) stat = status
    if (status == TRIBO_OK) return
    if (present(errmsg)) errmsg = text
    if (.not. present(stat)) error stop 'a system was not made'
  end subroutine finish
end module making
