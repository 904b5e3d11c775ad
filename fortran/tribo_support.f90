! SPDX-License-Identifier: BSD-3-Clause
!> Helpers of the modules tribo and tribo_dynamics and of the fixed-form routines: objects by number, sizes of arrays, texts,
!> begin and end of calls. Not for programs.
module tribo_support
  use tribo_c
  use tribo_constants
  use, intrinsic :: iso_fortran_env, only: error_unit
  implicit none
  private

  !> Kind of all reals here: double precision.
  integer, parameter, public :: dp = c_double

  public :: object_of, adopt, take, lend
  public :: begin, begin_const, finish, fail, expect_size, expect_shape, expect_count, expect_index, check_rows, blame
  public :: from_zero, to_int, transpose_in_place
  public :: to_text, message_of

  !> The base of all types: the number of an object of the library, see handle.c. Only the owner destroys a lent object.
  type, public :: tribo_object
    private
    integer(c_int64_t) :: handle = 0
    logical :: lent = .false.
  contains
    procedure :: destroy
    final :: finalize
  end type tribo_object

  !> What a call works on: the object of the library, the context for which messages are kept, the library's text of a failure
  !> (none: it keeps none, as calls on a const context), the number of contacts; of a system and its drivers the size of the
  !> state, and the degrees of freedom of the matrices given; how the call has gone so far, and the text of an error found here,
  !> with indices from 0 as in the library's messages.
  type, public :: work
    type(c_ptr) :: object = c_null_ptr, ctx = c_null_ptr, found = c_null_ptr
    integer :: n = 0, ndof = 0, dimension = 0, given = 0
    integer(c_int) :: status = TRIBO_ERR_NULL
    character(len=8) :: kind = 'context'
    character(len=:), allocatable :: text
  end type work

  interface blame
    procedure :: blame_one, blame_each
  end interface blame

  interface expect_size
    procedure :: expect_vector, expect_matrix
  end interface expect_size

  interface
    function c_strlen(s) result(n) bind(c, name='strlen')
      import :: c_ptr, c_size_t
      type(c_ptr), value :: s
      integer(c_size_t) :: n
    end function c_strlen
  end interface

contains

  ! -------------------------------------------------------------------------------------------------------------------- objects

  !> Releases the object; one that has not been created is fine.
  subroutine destroy(this)
    class(tribo_object), intent(inout) :: this
    if (this%handle /= 0 .and. .not. this%lent) call c_handle_drop(this%handle)
    this%handle = 0
    this%lent = .false.
  end subroutine destroy

  impure elemental subroutine finalize(this)
    type(tribo_object), intent(inout) :: this
    call this%destroy()
  end subroutine finalize

  !> Null if it has not been created, or has been destroyed.
  pure type(c_ptr) function object_of(this)
    class(tribo_object), intent(in) :: this
    object_of = c_handle_find(this%handle)
  end function object_of

  !> Makes an object of the library the object of this, in place of the one before. remove destroys it.
  integer(c_int) function adopt(this, object, remove) result(status)
    class(tribo_object), intent(inout) :: this
    type(c_ptr), intent(in) :: object
    type(c_funptr), value :: remove ! by reference gfortran would keep the address in read-only memory
    integer(c_int64_t) :: handle

    handle = c_handle_add(object, remove)
    status = TRIBO_ERR_MEMORY
    if (handle == 0) return
    call this%destroy()
    this%handle = handle
    status = TRIBO_OK
  end function adopt

  !> Moves the object of from to this, in place of the one before.
  subroutine take(this, from)
    class(tribo_object), intent(inout) :: this, from
    call this%destroy()
    this%handle = from%handle
    from%handle = 0
  end subroutine take

  !> Lets this name an object of another owner's, by its number.
  subroutine lend(this, handle)
    class(tribo_object), intent(inout) :: this
    integer(c_int64_t), intent(in) :: handle
    call this%destroy()
    this%handle = handle
    this%lent = .true.
  end subroutine lend

  ! ---------------------------------------------------------------------------------------------------------------------- calls

  !> Begins a call on a context.
  subroutine begin(this, w)
    class(tribo_object), intent(in) :: this
    type(work), intent(out) :: w

    call begin_const(this, w)
    w%found = c_message(w%ctx)
  end subroutine begin

  !> Begins a call on a const context: the library keeps no message of its errors.
  subroutine begin_const(this, w)
    class(tribo_object), intent(in) :: this
    type(work), intent(out) :: w
    integer(c_size_t) :: n

    w%ctx = object_of(this)
    w%status = c_get_ncontact(w%ctx, n)
    if (w%status == TRIBO_OK) w%n = int(n)
  end subroutine begin_const

  !> Ends a call: sets stat, and errmsg on error; without stat an error stops the program.
  subroutine finish(w, stat, errmsg)
    type(work), intent(in) :: w
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    character(len=:), allocatable :: zero, found
    integer(c_int) :: status

    if (present(stat)) stat = int(w%status)
    if (w%status == TRIBO_OK) return
    call failure_of(w, zero)
    if (c_associated(w%ctx)) status = c_handle_note(w%ctx, w%status, zero // c_null_char)
    call from_one(zero, found)
    if (present(errmsg)) errmsg = found
    if (present(stat)) return
    write (error_unit, '(2a)') 'tribo: ', found
    error stop 1
  end subroutine finish

  !> The first error of a call.
  subroutine fail(w, status, text)
    type(work), intent(inout) :: w
    integer, intent(in) :: status
    character(len=*), intent(in) :: text
    if (w%status /= TRIBO_OK) return
    w%status = int(status, c_int)
    w%text = text
  end subroutine fail

  !> The same for one of many values.
  subroutine fail_at(w, status, name, i, value, text)
    type(work), intent(inout) :: w
    integer, intent(in) :: status, i, value
    character(len=*), intent(in) :: name, text
    character(len=200) :: full
    write (full, '(2a,i0,a,i0,2a)') name, '[', i - 1, '] = ', value, ' ', text
    call fail(w, status, trim(full))
  end subroutine fail_at

  !> Expects a vector of n values, or a matrix of n by n or rows by n.
  subroutine expect_vector(w, name, x, n)
    type(work), intent(inout) :: w
    character(len=*), intent(in) :: name
    real(dp), intent(in) :: x(:)
    integer, intent(in) :: n
    if (size(x) /= n) call expect_shape(w, name, shape(x), [n])
  end subroutine expect_vector

  subroutine expect_matrix(w, name, x, n, rows)
    type(work), intent(inout) :: w
    character(len=*), intent(in) :: name
    real(dp), intent(in) :: x(:,:)
    integer, intent(in) :: n
    integer, intent(in), optional :: rows
    integer :: wanted(2)
    wanted = n
    if (present(rows)) wanted(1) = rows
    call expect_shape(w, name, shape(x), wanted)
  end subroutine expect_matrix

  subroutine expect_shape(w, name, found, wanted)
    type(work), intent(inout) :: w
    character(len=*), intent(in) :: name
    integer, intent(in) :: found(:), wanted(:)
    character(len=120) :: text

    if (all(found == wanted)) return
    write (text, '(2a,*(i0,:," x "))') name, ' has size ', found
    write (text, '(2a,*(i0,:," x "))') trim(text), ', not ', wanted
    call fail(w, TRIBO_ERR_SIZE, trim(text))
  end subroutine expect_shape

  !> Expects a number that is not negative.
  subroutine expect_count(w, name, n)
    type(work), intent(inout) :: w
    character(len=*), intent(in) :: name
    integer, intent(in) :: n
    character(len=60) :: text
    if (n >= 0) return
    write (text, '(2a,i0,a)') name, ' = ', n, ' is negative'
    call fail(w, TRIBO_ERR_NEGATIVE, trim(text))
  end subroutine expect_count

  !> Expects one of many indices to be one of 1 to most.
  subroutine expect_index(w, name, i, index, most)
    type(work), intent(inout) :: w
    character(len=*), intent(in) :: name
    integer, intent(in) :: i, index, most
    character(len=40) :: text
    if (index >= 1 .and. index <= most) return
    write (text, '(a,i0)') 'is not in 1 to ', most
    call fail_at(w, TRIBO_ERR_RANGE, name, i, index, trim(text))
  end subroutine expect_index

  !> For calls that have no context, and so no message of the library's: names the value that was refused, which is the first that
  !> the status speaks of. What may be negative is asked about after what may not.
  subroutine blame_one(w, name, x)
    type(work), intent(inout) :: w
    character(len=*), intent(in) :: name
    real(dp), intent(in) :: x
    character(len=80) :: text

    if (w%status == TRIBO_OK .or. allocated(w%text)) return
    if (.not. is_meant(w%status, x)) return
    write (text, '(2a,g0.7)') name, ' = ', x
    select case (w%status)
    case (TRIBO_ERR_NOT_FINITE)
      w%text = trim(text) // ' is not finite'
    case (TRIBO_ERR_NEGATIVE)
      w%text = trim(text) // ' is negative'
    case default
      w%text = trim(text) // ' is not positive'
    end select
  end subroutine blame_one

  subroutine blame_each(w, name, x)
    type(work), intent(inout) :: w
    character(len=*), intent(in) :: name
    real(dp), intent(in) :: x(:)
    character(len=80) :: text
    integer :: i

    do i = 1, merge(0, size(x), w%status == TRIBO_OK)
      write (text, '(2a,i0,a)') name, '[', i - 1, ']'
      call blame_one(w, trim(text), x(i))
    end do
  end subroutine blame_each

  !> Whether a status may speak of x. Numbers that are not finite are in no comparison that could raise an exception.
  elemental logical function is_meant(status, x)
    use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
    integer(c_int), intent(in) :: status
    real(dp), intent(in) :: x
    real(dp) :: finite

    finite = merge(x, 1.0_dp, ieee_is_finite(x))
    select case (status)
    case (TRIBO_ERR_NOT_FINITE)
      is_meant = .not. ieee_is_finite(x)
    case (TRIBO_ERR_NEGATIVE)
      is_meant = finite < 0
    case (TRIBO_ERR_NOT_POSITIVE)
      is_meant = finite <= 0
    case default
      is_meant = .false.
    end select
  end function is_meant

  !> Compressed rows as far as sizes and indices go. As in the library's messages indices count from 0 here, see from_one.
  subroutine check_rows(w, rowptr, col, val, rows, columns)
    type(work), intent(inout) :: w
    integer, intent(in) :: rowptr(:), col(:), rows, columns
    real(dp), intent(in) :: val(:)
    integer :: i, k

    call expect_shape(w, 'rowptr', shape(rowptr), [rows + 1])
    call expect_shape(w, 'val', shape(val), [size(col)])
    if (w%status /= TRIBO_OK) return
    if (rowptr(1) /= 1) call fail_at(w, TRIBO_ERR_SIZE, 'rowptr', 1, rowptr(1), 'is not 1')
    do i = 2, rows + 1
      if (rowptr(i) < rowptr(i - 1)) call fail_at(w, TRIBO_ERR_SIZE, 'rowptr', i, rowptr(i), 'is less than the one before')
    end do
    if (rowptr(rows + 1) /= size(col) + 1) then
      call fail_at(w, TRIBO_ERR_SIZE, 'rowptr', rows + 1, rowptr(rows + 1), 'does not end where col does')
    end if
    do k = 1, size(col)
      call expect_index(w, 'col', k, col(k), columns)
    end do
  end subroutine check_rows

  elemental integer(c_size_t) function from_zero(i)
    integer, intent(in) :: i
    from_zero = int(i, c_size_t) - 1
  end function from_zero

  !> For an int of C: values beyond its range become its ends, which are no index and no choice of the library.
  elemental integer(c_int) function to_int(i)
    integer, intent(in) :: i
    to_int = int(max(min(i, int(huge(0_c_int))), -int(huge(0_c_int))), c_int)
  end function to_int

  !> x = transpose(x), which would allocate.
  pure subroutine transpose_in_place(x)
    real(dp), intent(inout) :: x(:,:)
    real(dp) :: upper
    integer :: i, j

    do j = 2, size(x, 2)
      do i = 1, j - 1
        upper = x(i, j)
        x(i, j) = x(j, i)
        x(j, i) = upper
      end do
    end do
  end subroutine transpose_in_place

  ! ---------------------------------------------------------------------------------------------------------------------- texts
  ! No function that returns a text of deferred length is called in here: gfortran keeps the length in static memory, which
  ! threads would share.

  !> The text of a C string; empty for none.
  subroutine to_text(s, text)
    type(c_ptr), intent(in) :: s
    character(len=:), allocatable, intent(out) :: text
    character(kind=c_char), pointer :: chars(:)
    integer :: i

    if (c_associated(s)) then
      call c_f_pointer(s, chars, [c_strlen(s)])
      allocate (character(len=size(chars)) :: text)
      do i = 1, size(chars)
        text(i:i) = chars(i)
      end do
    else
      text = ''
    end if
  end subroutine to_text

  !> The text of an error, with indices from 0.
  subroutine failure_of(w, text)
    type(work), intent(in) :: w
    character(len=:), allocatable, intent(out) :: text

    if (allocated(w%text)) then
      text = w%text
    else if (c_associated(w%ctx) .and. c_associated(w%found)) then
      call to_text(w%found, text)
    else if (c_associated(w%ctx) .or. w%status /= TRIBO_ERR_NULL) then
      call to_text(c_strerror(w%status), text)
    else
      text = 'the ' // trim(w%kind) // ' has not been created, or has been destroyed'
    end if
  end subroutine failure_of

  !> The text of the last error: the one noted by Fortran, or else the library's.
  subroutine message_of(w, text)
    type(work), intent(in) :: w
    character(len=:), allocatable, intent(out) :: text
    character(len=:), allocatable :: zero
    character(kind=c_char) :: noted(300)
    integer :: i, length

    call c_handle_noted(w%ctx, int(size(noted), c_size_t), noted)
    if (.not. c_associated(w%ctx)) then
      call failure_of(w, zero)
    else if (noted(1) /= c_null_char) then
      length = findloc(noted, c_null_char, 1) - 1
      allocate (character(len=length) :: zero)
      do i = 1, length
        zero(i:i) = noted(i)
      end do
    else
      call to_text(w%found, zero)
    end if
    call from_one(zero, text)
  end subroutine message_of

  !> A message for Fortran. The library counts from 0 and writes x[i][j]; here it counts from 1, and is x(i,j). In the library's
  !> messages an index stands in brackets or after one of the words below, and no other number does (a test checks this), except in
  !> quotes, around names given by the caller.
  subroutine from_one(zero, text)
    character(len=*), intent(in) :: zero
    character(len=:), allocatable, intent(out) :: text
    character(len=*), parameter :: words(5) = &
      [character(len=18) :: 'contact', 'contacts', 'column', 'degree of freedom', 'mode']
    character(len=20) :: index
    logical :: is_index, quoted
    integer :: i, k, length, number

    text = ''
    is_index = .false.
    quoted = .false.
    i = 1
    do while (i <= len(zero))
      if (zero(i:i) == '"') quoted = .not. quoted
      length = max(1, verify(zero(i:) // '.', '0123456789') - 1)
      if (quoted) length = 1
      select case (merge('"', zero(i:i), quoted))
      case ('0':'9')
        is_index = ends(zero(:i - 1), '[') .or. (is_index .and. ends(text, ', '))
        do k = 1, size(words)
          is_index = is_index .or. ends(' ' // text, ' ' // trim(words(k)) // ' ')
        end do
        if (is_index) then
          read (zero(i:i + length - 1), *) number
          write (index, '(i0)') number + 1
          text = text // trim(index)
        else
          text = text // zero(i:i + length - 1)
        end if
      case ('[')
        if (ends(text, ')')) then
          text(len(text):) = ','
        else
          text = text // '('
        end if
      case (']')
        text = text // ')'
      case default
        text = text // zero(i:i)
      end select
      i = i + length
    end do
  end subroutine from_one

  pure logical function ends(text, word)
    character(len=*), intent(in) :: text, word
    ends = len(text) >= len(word)
    if (ends) ends = text(len(text) - len(word) + 1:) == word
  end function ends
end module tribo_support
