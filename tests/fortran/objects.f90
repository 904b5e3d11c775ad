! SPDX-License-Identifier: BSD-3-Clause
!> Life of contexts as Fortran objects: assignment copies, what goes out of scope is destroyed, and nothing is destroyed twice,
!> whatever compilers do with objects inside of objects.
module scopes
  use check, only: alive, require
  use tribo
  implicit none

  type :: holder
    type(tribo_context) :: c
    integer :: mark = 0
  end type holder

  type :: allocatable_holder
    type(tribo_context), allocatable :: c
  end type allocatable_holder

  type, extends(tribo_context) :: extended
    integer :: mark = 0
  end type extended
contains

  !> Nothing is left of a scope.
  subroutine run(scope, label)
    interface
      subroutine scope()
      end subroutine scope
    end interface
    character(len=*), intent(in) :: label
    integer :: before

    before = int(alive())
    call scope()
    call require(alive() == before, label // ' leave no context behind')
  end subroutine run

  subroutine make(c, limit)
    class(tribo_context), intent(inout) :: c
    real(dp), intent(in) :: limit
    call c%create(2)
    call c%set_limit(limit)
  end subroutine make

  !> The limit of a context's contacts; -1 for none.
  real(dp) function limit_of(c)
    class(tribo_context), intent(in) :: c
    real(dp) :: limit(2)
    integer :: stat
    limit = -1
    call c%get_limit(limit, stat)
    limit_of = limit(2)
  end function limit_of

  logical function holds(c, limit)
    class(tribo_context), intent(in) :: c
    real(dp), intent(in) :: limit
    holds = abs(limit_of(c) - limit) <= 0
  end function holds

  subroutine copies()
    type(tribo_context) :: a, b, nothing
    integer :: before

    before = int(alive())
    call make(a, 1.0_dp)
    b = a
    call require(alive() == before + 2, 'a copy is a context')
    call a%set_limit(2.0_dp)
    call require(holds(a, 2.0_dp) .and. holds(b, 1.0_dp), 'a copy is independent')
    b = a
    call require(alive() == before + 2 .and. holds(b, 2.0_dp), 'assignment replaces')
    a = a
    call require(alive() == before + 2 .and. holds(a, 2.0_dp), 'a = a')
    call a%destroy()
    call require(alive() == before + 1 .and. holds(b, 2.0_dp) .and. holds(a, -1.0_dp), 'a copy outlives')
    call b%clone(a)
    call require(alive() == before + 2 .and. holds(a, 2.0_dp), 'clone')
    b = nothing
    call require(alive() == before + 1 .and. holds(b, -1.0_dp), 'a copy of nothing')
    b = nothing
    call b%destroy()
    call make(b, 5.0_dp)
    call require(holds(b, 5.0_dp), 'created again')
  end subroutine copies

  subroutine again()
    type(tribo_context) :: c
    integer :: before
    before = int(alive())
    call make(c, 1.0_dp)
    call make(c, 2.0_dp)
    call require(alive() == before + 1 .and. holds(c, 2.0_dp), 'create replaces')
  end subroutine again

  subroutine arrays()
    type(tribo_context) :: a(3), b(3), c(2, 2)
    integer :: i

    do i = 1, 3
      call make(a(i), real(i, dp))
    end do
    b = a
    b(1:2) = a(2:3)
    call require(holds(b(1), 2.0_dp) .and. holds(b(2), 3.0_dp) .and. holds(b(3), 3.0_dp), 'arrays copy')
    a(1:2) = a(2:3)
    call require(holds(a(1), 2.0_dp) .and. holds(a(2), 3.0_dp) .and. holds(a(3), 3.0_dp), 'overlapping arrays copy')
    c = b(3)
    call b(3)%destroy()
    call require(holds(c(1, 1), 3.0_dp) .and. holds(c(2, 2), 3.0_dp), 'a scalar copies to an array')
  end subroutine arrays

  subroutine components()
    type(holder) :: a, b
    call make(a%c, 1.0_dp)
    call make(b%c, 7.0_dp)
    a%mark = 3
    b = a
    call a%c%set_limit(2.0_dp)
    call require(holds(b%c, 1.0_dp) .and. b%mark == 3, 'components copy')
    b = a
    a = a
    call require(holds(a%c, 2.0_dp) .and. holds(b%c, 2.0_dp), 'components copy again')
  end subroutine components

  subroutine extensions()
    type(extended) :: a, b
    call make(a, 1.0_dp)
    call make(b, 7.0_dp)
    a%mark = 3
    b = a
    call a%set_limit(2.0_dp)
    call require(holds(b, 1.0_dp) .and. b%mark == 3, 'extensions copy')
    b = a
    call require(holds(a, 2.0_dp) .and. holds(b, 2.0_dp), 'extensions copy again')
  end subroutine extensions

  subroutine allocatables()
    type(tribo_context) :: a
    type(tribo_context), allocatable :: b, c, list(:)
    class(tribo_context), allocatable :: d

    call make(a, 1.0_dp)
    allocate (b, list(2))
    allocate (extended :: d)
    b = a
    list(2) = a
    call d%create(2)
    call move_alloc(b, c)
    call require(holds(c, 1.0_dp) .and. holds(list(2), 1.0_dp), 'allocatables copy and move')
    deallocate (list)
  end subroutine allocatables

  !> Compilers without the assignment that the standard asks for here leave one context under two names: still, it is never
  !> destroyed twice, and never used when it has gone.
  subroutine allocatable_components()
    type(allocatable_holder) :: a, b
    allocate (a%c)
    call make(a%c, 1.0_dp)
    b = a
    call require(holds(a%c, 1.0_dp) .and. holds(b%c, 1.0_dp), 'allocatable components copy')
    call a%c%destroy()
    call require(holds(b%c, 1.0_dp) .or. holds(b%c, -1.0_dp), 'or share')
    call make(a%c, 2.0_dp)
    call require(holds(b%c, 1.0_dp) .or. holds(b%c, -1.0_dp), 'but not with the next context')
  end subroutine allocatable_components

  !> The same for sources; here the standard itself wants one context under two names.
  subroutine sources()
    type(tribo_context) :: a
    type(tribo_context), allocatable :: b
    call make(a, 1.0_dp)
    allocate (b, source=a)
    call require(holds(b, 1.0_dp), 'sources')
    deallocate (b)
    call require(holds(a, 1.0_dp) .or. holds(a, -1.0_dp), 'sources share')
    call make(a, 2.0_dp)
    call require(holds(a, 2.0_dp), 'created again after sharing')
  end subroutine sources

  subroutine arguments()
    type(tribo_context) :: a
    call make(a, 1.0_dp)
    call by_value(a)
    call require(holds(a, 1.0_dp) .or. holds(a, -1.0_dp), 'a value argument')
  end subroutine arguments

  subroutine by_value(c)
    type(tribo_context), value :: c
    call require(holds(c, 1.0_dp), 'by value')
  end subroutine by_value

  !> More contexts at once than a chunk of the table has places, given back in another order.
  subroutine many()
    type(tribo_context), allocatable :: c(:)
    integer :: i
    logical :: right

    allocate (c(5000))
    do i = 1, size(c)
      call make(c(i), real(i, dp))
    end do
    do i = 1, size(c), 2
      call c(i)%destroy()
    end do
    do i = 1, size(c), 4
      call make(c(i), real(2*i, dp))
    end do
    right = .true.
    do i = 1, size(c)
      right = right .and. holds(c(i), real(merge(2*i, merge(-1, i, mod(i, 4) == 3), mod(i, 4) == 1), dp))
    end do
    call require(right, 'many contexts are kept apart')
  end subroutine many

  !> gfortran before version 13 does not finalize the result of a function.
  subroutine functions()
    type(tribo_context) :: a
    integer :: before
    before = int(alive())
    a = made(6.0_dp)
    call require(holds(a, 6.0_dp), 'a function result')
    call require(alive() <= before + 2, 'a function leaves one context behind at most')
  end subroutine functions

  function made(limit) result(c)
    real(dp), intent(in) :: limit
    type(tribo_context) :: c
    call make(c, limit)
  end function made
end module scopes

program objects
  use check, only: report
  use scopes
  implicit none

  call run(copies, 'copies')
  call run(arrays, 'arrays')
  call run(again, 'again')
  call run(components, 'components')
  call run(extensions, 'extensions')
  call run(allocatables, 'allocatables')
  call run(allocatable_components, 'allocatable components')
  call run(sources, 'sources')
  call run(arguments, 'arguments')
  call run(many, 'many')
  call functions()
  call report()
end program objects
