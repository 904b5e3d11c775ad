! SPDX-License-Identifier: BSD-3-Clause
!> tribo: dry friction in structural dynamics.
!>
!> Quantities. A contact has a relative velocity v = dz/dt and a friction force f along +z. Its limit is mu times the normal
!> load, so that sliding means f = -limit*sign(v). With v = J u, u being the velocities of the bodies, these get the forces J' f:
!> a contact with z = x1 - x2 puts f on body 1 and -f on body 2. Contact accelerations are z'' = R f + a, where R = J M**-1 J'
!> is symmetric and positive semidefinite, and a is everything but friction. f_eq is the friction force that makes a contact's
!> z'' zero. Any consistent set of units will do.
!>
!>     use tribo
!>     type(tribo_context) :: c
!>     call c%create(n)
!>     call c%set_limit(mu_n)
!>     call c%set_operator(inverse_mass)
!>     call c%set_epsilon(step=dt)
!>     call c%balance(v, a_free, f=f)
!>
!> Arguments. Arrays hold one value a contact unless said otherwise, and sections of arrays will do. A size that does not fit is
!> an error (TRIBO_ERR_SIZE). On error outputs stay as they were: that is why they are intent(inout).
!>
!> Errors. Every call that can fail takes stat (TRIBO_OK or one of TRIBO_ERR_...) and errmsg, which follows errmsg of
!> ALLOCATE: any character variable, padded or cut to its length, and unchanged without an error. Without stat an error
!> stops the program with its text.
!>
!> Contexts. b = a makes b a copy that shares nothing with a; b must exist, so an allocatable b is allocated first. A context
!> that goes out of scope is destroyed. Where a compiler copies a context without its assignment - allocate(b, source=a),
!> and in gfortran assignment of a type in which it is an allocatable component - both names mean one context until one of
!> them is destroyed; the other is as if destroyed then. gfortran before version 13 does not destroy the result of a function:
!> prefer a subroutine.
!>
!> Threads. Procedures that take a context as intent(in) may be called by several threads on one context; all others need one
!> context a thread. In threads get texts by errmsg: for a function of deferred length, like message, gfortran
!> keeps the length in static memory.
!>
!> Names. Programs use module tribo, at the end of this file: module tribo_contexts, and the constants of tribo.h, see tribo_c.f90.
!>
!> Source: D. D. Quinn, "A New Regularization of Coulomb Friction", J. Vib. Acoust. 126 (2004) 391-397, doi:10.1115/1.1760564.
module tribo_contexts
  use tribo_c
  use tribo_constants
  use tribo_support
  use, intrinsic :: iso_fortran_env, only: int32, int64
  implicit none
  private

  !> Kind of all reals here: double precision.
  public :: dp
  public :: tribo_version, tribo_version_string, tribo_strerror
  public :: tribo_law_count, tribo_law_name, tribo_law_reference, tribo_law_find, tribo_law_eval, tribo_elastic_force
  public :: tribo_contact_force, tribo_dahl_force, tribo_lugre_force, tribo_bouc_wen_force, tribo_iwan_force

  !> A set of contacts with their law, limits, epsilon, operator R, solver memory and workspace.
  type, extends(tribo_object), public :: tribo_context
  contains
    procedure :: create, clone
    procedure :: copy_settings
    procedure :: fix_operator
    procedure :: message
    procedure :: get_ncontact
    procedure, private :: set_law_number, set_law_name
    generic :: set_law => set_law_number, set_law_name
    procedure :: set_user_law
    procedure :: get_law
    procedure, private :: set_limit_each, set_limit_all
    generic :: set_limit => set_limit_each, set_limit_all
    procedure :: set_normal_load
    procedure :: set_planar
    procedure :: get_limit
    procedure :: set_static, get_static
    procedure, private :: set_epsilon_each, set_epsilon_all
    generic :: set_epsilon => set_epsilon_each, set_epsilon_all
    procedure :: get_epsilon
    procedure, private :: set_operator_diagonal, set_operator_dense
    generic :: set_operator => set_operator_diagonal, set_operator_dense
    procedure :: set_operator_csr, set_operator_mass, set_operator_callback
    procedure :: update_operator
    procedure :: set_coupling, get_coupling
    procedure :: set_sharing, get_sharing
    procedure :: force, force_tangent, force_tangent_planar
    procedure :: balance, balance_tangent, tangent_product, limit_product
    procedure :: step_force, step_force_mean
    procedure :: solve_box
    procedure :: accept
    procedure :: get_slip
    procedure, private :: get_count_short, get_count_long
    generic :: get_count => get_count_short, get_count_long
    procedure :: get_real
    procedure, private :: assign
    generic :: assignment(=) => assign
  end type tribo_context

  !> A mass matrix with a solver of the caller's, for set_operator_callback. The caller extends this type by components, such as
  !> the factors of the matrix.
  type, abstract, public :: tribo_mass
  contains
    procedure(apply), deferred :: apply
  end type tribo_mass

  abstract interface
    !> acceleration = M**-1 force, to 1e-11. A result other than 0 ends the call. Must not change the context.
    integer function apply(this, force, acceleration)
      import :: dp, tribo_mass
      class(tribo_mass), intent(inout) :: this
      real(dp), intent(in) :: force(:)
      real(dp), intent(inout) :: acceleration(:)
    end function apply
  end interface

  type :: held_mass
    class(tribo_mass), pointer :: mass
  end type held_mass

  !> On a line, or in the plane.
  interface tribo_elastic_force
    procedure :: elastic_force_line, elastic_force_plane
  end interface tribo_elastic_force

contains

  ! ------------------------------------------------------------------------------------------------------ version, status, laws

  !> 10000*major + 100*minor + patch of the library that is running.
  integer function tribo_version()
    tribo_version = int(c_version())
  end function tribo_version

  function tribo_version_string() result(text)
    character(len=:), allocatable :: text
    call to_text(c_version_string(), text)
  end function tribo_version_string

  !> Text for a status; any integer gets one.
  function tribo_strerror(status) result(text)
    integer, intent(in) :: status
    character(len=:), allocatable :: text
    call to_text(c_strerror(to_int(status)), text)
  end function tribo_strerror

  !> Number of laws; their numbers are 0 to tribo_law_count() - 1.
  integer function tribo_law_count()
    tribo_law_count = int(c_law_count())
  end function tribo_law_count

  !> Name of a law; empty if law is not a law.
  function tribo_law_name(law) result(text)
    integer, intent(in) :: law
    character(len=:), allocatable :: text
    call to_text(c_law_name(to_int(law)), text)
  end function tribo_law_name

  !> Reference of a law; empty if law is not a law.
  function tribo_law_reference(law) result(text)
    integer, intent(in) :: law
    character(len=:), allocatable :: text
    call to_text(c_law_reference(to_int(law)), text)
  end function tribo_law_reference

  !> Number of the law called name, in upper or lower case.
  subroutine tribo_law_find(name, law, stat, errmsg)
    character(len=*), intent(in) :: name
    integer, intent(inout) :: law
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    w%status = number_of(name, law)
    if (w%status /= TRIBO_OK) call tell_laws(name, w%text)
    call finish(w, stat, errmsg)
  end subroutine tribo_law_find

  integer(c_int) function number_of(name, law) result(status)
    character(len=*), intent(in) :: name
    integer, intent(inout) :: law
    integer(c_int) :: number
    status = c_law_find(trim(name) // c_null_char, number)
    if (status == TRIBO_OK) law = int(number)
  end function number_of

  !> The text of an unknown name, with the names of the laws.
  subroutine tell_laws(name, text)
    character(len=*), intent(in) :: name
    character(len=:), allocatable, intent(out) :: text
    character(len=:), allocatable :: law
    integer :: i
    text = 'no law is called "' // name(:min(len_trim(name), 40)) // '": there are'
    do i = 0, tribo_law_count() - 1
      call to_text(c_law_name(to_int(i)), law)
      text = text // ' ' // law // ','
    end do
    text = text(:len(text) - 1)
  end subroutine tell_laws

  !> One contact, no context: the force and its derivatives, one-sided at a kink, df_dv = 0 at a jump. Elemental: with arrays,
  !> stat and errmsg are arrays too. TRIBO_QUINN_REVERSAL: as for a contact that comes in sliding.
  impure elemental subroutine tribo_law_eval(law, v, feq, limit, epsilon, f, df_dv, df_dfeq, df_dlimit, stat, errmsg)
    integer, intent(in) :: law
    real(dp), intent(in) :: v, feq, limit, epsilon
    real(dp), intent(inout) :: f
    real(dp), intent(inout), optional :: df_dv, df_dfeq, df_dlimit
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    real(dp) :: x(4)
    type(work) :: w

    w%status = c_law_eval(to_int(law), v, feq, limit, epsilon, x(1), x(2), x(3), x(4))
    if (w%status == TRIBO_OK) then
      f = x(1)
      if (present(df_dv)) df_dv = x(2)
      if (present(df_dfeq)) df_dfeq = x(3)
      if (present(df_dlimit)) df_dlimit = x(4)
    end if
    call blame(w, 'limit', limit)
    call blame(w, 'epsilon', epsilon)
    call blame(w, 'v', v)
    call blame(w, 'feq', feq)
    call finish(w, stat, errmsg)
  end subroutine tribo_law_eval

  !> Elastic contacts, no context: each a spring in series with a Coulomb slider. f = clamp(f - stiffness*dz, -limit, limit) after a
  !> displacement dz, and df_dz is its derivative by dz. dz, stiffness, limit, f and df_dz are of one size.
  subroutine elastic_force_line(dz, stiffness, limit, f, df_dz, stat, errmsg)
    real(dp), intent(in) :: dz(:), stiffness(:), limit(:)
    real(dp), intent(inout) :: f(:)
    real(dp), intent(inout), optional, contiguous :: df_dz(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg

    call limited_force(c_elastic_force, dz, stiffness, limit, f, df_dz, stat, errmsg)
  end subroutine elastic_force_line

  !> Forces f by an element of C that has a stiffness and a limit.
  subroutine limited_force(element, dz, stiffness, limit, f, df_dz, stat, errmsg)
    procedure(c_elastic_force) :: element
    real(dp), intent(in) :: dz(:), stiffness(:), limit(:)
    real(dp), intent(inout) :: f(:)
    real(dp), intent(inout), optional, contiguous :: df_dz(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    w%status = TRIBO_OK
    w%n = size(f)
    call expect_size(w, 'dz', dz, w%n)
    call expect_size(w, 'stiffness', stiffness, w%n)
    call expect_size(w, 'limit', limit, w%n)
    if (present(df_dz)) call expect_size(w, 'df_dz', df_dz, w%n)
    if (w%status == TRIBO_OK) w%status = element(int(w%n, c_size_t), dz, stiffness, limit, f, df_dz)
    call blame(w, 'stiffness', stiffness)
    call blame(w, 'limit', limit)
    call blame(w, 'dz', dz)
    call blame(w, 'f', f)
    call finish(w, stat, errmsg)
  end subroutine limited_force

  !> The same in the plane: dz(2,n), f(2,n), stiffness(n), limit(n), df_dz(2,2,n).
  subroutine elastic_force_plane(dz, stiffness, limit, f, df_dz, stat, errmsg)
    real(dp), intent(in) :: dz(:,:), stiffness(:), limit(:)
    real(dp), intent(inout) :: f(:,:)
    real(dp), intent(inout), optional, contiguous :: df_dz(:,:,:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    w%status = TRIBO_OK
    w%n = size(f, 2)
    call expect_shape(w, 'f', shape(f), [2, w%n])
    call expect_shape(w, 'dz', shape(dz), [2, w%n])
    call expect_size(w, 'stiffness', stiffness, w%n)
    call expect_size(w, 'limit', limit, w%n)
    if (present(df_dz)) call expect_shape(w, 'df_dz', shape(df_dz), [2, 2, w%n])
    if (w%status == TRIBO_OK) w%status = c_elastic_force_planar(int(w%n, c_size_t), dz, stiffness, limit, f, df_dz)
    call blame(w, 'stiffness', stiffness)
    call blame(w, 'limit', limit)
    call finish(w, stat, errmsg)
  end subroutine elastic_force_plane

  !> Contact elements, no context: tangential springs that end in a slider, a normal spring that lifts off. dz(2,n) displacement
  !> since f; depth, tangential, normal, mu (n); f(3,n) two tangential forces and -normal*max(depth, 0); df(i,j,k) = df(i)/d(dz(1),
  !> dz(2), depth)(j) of element k.
  subroutine tribo_contact_force(dz, depth, tangential, normal, mu, f, df, stat, errmsg)
    real(dp), intent(in) :: dz(:,:), depth(:), tangential(:), normal(:), mu(:)
    real(dp), intent(inout) :: f(:,:)
    real(dp), intent(inout), optional, contiguous :: df(:,:,:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    integer :: k
    type(work) :: w

    w%status = TRIBO_OK
    w%n = size(f, 2)
    call expect_shape(w, 'f', shape(f), [3, w%n])
    call expect_shape(w, 'dz', shape(dz), [2, w%n])
    call expect_size(w, 'depth', depth, w%n)
    call expect_size(w, 'tangential', tangential, w%n)
    call expect_size(w, 'normal', normal, w%n)
    call expect_size(w, 'mu', mu, w%n)
    if (present(df)) call expect_shape(w, 'df', shape(df), [3, 3, w%n])
    if (w%status == TRIBO_OK) then
      w%status = c_contact_force(int(w%n, c_size_t), dz, depth, tangential, normal, mu, f, df)
      if (w%status == TRIBO_OK .and. present(df)) then
        do k = 1, w%n
          call transpose_in_place(df(:, :, k))
        end do
      end if
    end if
    call blame(w, 'tangential', tangential)
    call blame(w, 'normal', normal)
    call blame(w, 'mu', mu)
    call blame(w, 'depth', depth) ! last: it may be negative
    call finish(w, stat, errmsg)
  end subroutine tribo_contact_force

  !> Friction laws with a state, no context, in closed form over a step of constant velocity; df_dz is the derivative of f by dz.
  !> Dahl's law: dz, stiffness, limit, f, df_dz (n); f is the state, in and out.
  subroutine tribo_dahl_force(dz, stiffness, limit, f, df_dz, stat, errmsg)
    real(dp), intent(in) :: dz(:), stiffness(:), limit(:)
    real(dp), intent(inout) :: f(:)
    real(dp), intent(inout), optional, contiguous :: df_dz(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg

    call limited_force(c_dahl_force, dz, stiffness, limit, f, df_dz, stat, errmsg)
  end subroutine tribo_dahl_force

  !> LuGre: parameter(6,n) = s0, s1, s2, fc, fs, vs; state z(n); velocity dz/dt.
  subroutine tribo_lugre_force(dt, dz, parameter, z, f, df_dz, stat, errmsg)
    real(dp), intent(in) :: dt, dz(:), parameter(:,:)
    real(dp), intent(inout) :: z(:), f(:)
    real(dp), intent(inout), optional, contiguous :: df_dz(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    w%status = TRIBO_OK
    w%n = size(f)
    call expect_elements(w, dz, parameter, 6, z, df_dz)
    if (w%status == TRIBO_OK) w%status = c_lugre_force(int(w%n, c_size_t), dt, dz, parameter, z, f, df_dz)
    call blame(w, 'dt', dt)
    call blame_elements(w, dz, parameter, ['s0', 's1', 's2', 'fc', 'fs', 'vs'], z)
    call finish(w, stat, errmsg)
  end subroutine tribo_lugre_force

  !> Bouc and Wen: parameter(5,n) = stiffness, a, beta, gamma, m; state z(n).
  subroutine tribo_bouc_wen_force(dz, parameter, z, f, df_dz, stat, errmsg)
    real(dp), intent(in) :: dz(:), parameter(:,:)
    real(dp), intent(inout) :: z(:), f(:)
    real(dp), intent(inout), optional, contiguous :: df_dz(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    w%status = TRIBO_OK
    w%n = size(f)
    call expect_elements(w, dz, parameter, 5, z, df_dz)
    if (w%status == TRIBO_OK) w%status = c_bouc_wen_force(int(w%n, c_size_t), dz, parameter, z, f, df_dz)
    call blame_elements(w, dz, parameter, [character(len=9) :: 'stiffness', 'a', 'beta', 'gamma', 'm'], z)
    call finish(w, stat, errmsg)
  end subroutine tribo_bouc_wen_force

  !> Iwan's parallel sliders, Segalman's form: parameter(4,n) = kt, fs, chi, beta; state(3+2*room,n) for room turns.
  subroutine tribo_iwan_force(room, dz, parameter, state, f, df_dz, stat, errmsg)
    integer, intent(in) :: room
    real(dp), intent(in) :: dz(:), parameter(:,:)
    real(dp), intent(inout) :: state(:,:), f(:)
    real(dp), intent(inout), optional, contiguous :: df_dz(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    w%status = TRIBO_OK
    w%n = size(f)
    call expect_shape(w, 'state', shape(state), [3 + 2*max(room, 0), w%n])
    call expect_elements(w, dz, parameter, 4, f, df_dz)
    if (room < 0) w%status = TRIBO_ERR_NEGATIVE
    if (w%status == TRIBO_OK) w%status = c_iwan_force(int(w%n, c_size_t), int(room, c_size_t), dz, parameter, state, f, df_dz)
    call blame(w, 'room', real(room, dp))
    call blame_elements(w, dz, parameter, ['kt  ', 'fs  ', 'chi ', 'beta'], reshape(state, [size(state)]))
    call finish(w, stat, errmsg)
  end subroutine tribo_iwan_force

  !> Expects the sizes of w%n elements of a number of parameters each.
  subroutine expect_elements(w, dz, parameter, numbers, z, df_dz)
    type(work), intent(inout) :: w
    real(dp), intent(in) :: dz(:), parameter(:,:), z(:)
    integer, intent(in) :: numbers
    real(dp), intent(in), optional :: df_dz(:)

    call expect_size(w, 'dz', dz, w%n)
    call expect_shape(w, 'parameter', shape(parameter), [numbers, w%n])
    call expect_size(w, 'z', z, w%n)
    if (present(df_dz)) call expect_size(w, 'df_dz', df_dz, w%n)
  end subroutine expect_elements

  !> Names the parameter, the displacement or the state of which a status speaks.
  subroutine blame_elements(w, dz, parameter, name, state)
    type(work), intent(inout) :: w
    real(dp), intent(in) :: dz(:), parameter(:,:), state(:)
    character(len=*), intent(in) :: name(:)
    integer :: k

    if (w%status == TRIBO_ERR_NEGATIVE .or. w%status == TRIBO_ERR_NOT_FINITE .or. w%status == TRIBO_ERR_NOT_POSITIVE) then
      do k = 1, size(name)
        call blame(w, trim(name(k)), parameter(k, :))
      end do
    end if
    if (w%status == TRIBO_ERR_NOT_FINITE) then
      call blame(w, 'dz', dz)
      call blame(w, 'state', state)
    end if
  end subroutine blame_elements

  ! ---------------------------------------------------------------------------------------------------------- life of a context

  !> A context for ncontact contacts (0 is fine), in place of the one before: Quinn's law, limit 0, epsilon 1e-6, consistent
  !> coupling, no operator. Calls that need the operator return TRIBO_ERR_STATE until one is set.
  subroutine create(this, ncontact, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    integer, intent(in) :: ncontact
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(c_ptr) :: ctx
    type(work) :: w

    w%status = TRIBO_OK
    call expect_count(w, 'ncontact', ncontact)
    if (w%status == TRIBO_OK) w%status = c_create(ctx, int(ncontact, c_size_t))
    if (w%status == TRIBO_OK) w%status = adopted(this, ctx)
    call finish(w, stat, errmsg)
  end subroutine create

  !> Makes copy a context with the same settings and memory as this one, and nothing shared.
  subroutine clone(this, copy, stat, errmsg)
    class(tribo_context), intent(in) :: this
    class(tribo_context), intent(inout) :: copy
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    type(c_ptr) :: ctx

    call begin_const(this, w)
    if (w%status == TRIBO_OK) w%status = c_clone(w%ctx, ctx)
    if (w%status == TRIBO_OK) then
      if (adopted(copy, ctx) /= TRIBO_OK) call fail(w, TRIBO_ERR_MEMORY, 'out of memory for a copy')
    end if
    call finish(w, stat, errmsg)
  end subroutine clone

  ! from is not polymorphic, so that types that extend this one assign their own components.
  impure elemental subroutine assign(to, from)
    class(tribo_context), intent(inout) :: to
    type(tribo_context), intent(in) :: from
    if (c_associated(object_of(from))) then
      call from%clone(to)
    else
      call to%destroy()
    end if
  end subroutine assign

  !> Gives this context the settings of from, which has as many contacts; operator, forces, counts and memory stay.
  subroutine copy_settings(this, from, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    class(tribo_context), intent(in) :: from
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    if (w%status == TRIBO_OK) w%status = c_copy_settings(w%ctx, object_of(from))
    call finish(w, stat, errmsg)
  end subroutine copy_settings

  !> Fixes the operator: the set_operator procedures are refused afterwards. The operator of a clone can be changed.
  subroutine fix_operator(this, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    if (w%status == TRIBO_OK) w%status = c_fix_operator(w%ctx)
    call finish(w, stat, errmsg)
  end subroutine fix_operator

  !> The text of the last error on this context: argument, contact and value; empty before any.
  function message(this) result(text)
    class(tribo_context), intent(in) :: this
    character(len=:), allocatable :: text
    type(work) :: w
    call begin(this, w)
    call message_of(w, text)
  end function message

  ! ------------------------------------------------------------------------------------------------------------------- settings

  !> Number of contacts.
  subroutine get_ncontact(this, ncontact, stat, errmsg)
    class(tribo_context), intent(in) :: this
    integer, intent(inout) :: ncontact
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin_const(this, w)
    if (w%status == TRIBO_OK) ncontact = w%n
    call finish(w, stat, errmsg)
  end subroutine get_ncontact

  !> Law of all contacts, by number or by name (in upper or lower case); clears the reversal memory.
  subroutine set_law_number(this, law, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    integer, intent(in) :: law
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    if (w%status == TRIBO_OK) w%status = c_set_law(w%ctx, to_int(law))
    call finish(w, stat, errmsg)
  end subroutine set_law_number

  subroutine set_law_name(this, law, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    character(len=*), intent(in) :: law
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    character(len=:), allocatable :: text
    integer(c_int) :: found
    integer :: number

    call begin(this, w)
    number = 0
    found = number_of(law, number)
    if (found /= TRIBO_OK) then
      call tell_laws(law, text)
      call fail(w, int(found), text)
    end if
    if (w%status == TRIBO_OK) w%status = c_set_law(w%ctx, to_int(number))
    call finish(w, stat, errmsg)
  end subroutine set_law_name

  !> A law of the caller: c_funloc of an integer(c_int) function with bind(c), called for contacts first + 1 to first + n:
  !>   law(first, n, derivatives, v, limit, epsilon, box, data)
  !>   integer(c_size_t), value :: first, n;  integer(c_int), value :: derivatives;  type(c_ptr), value :: data
  !>   real(c_double), intent(in) :: v(n), limit(n), epsilon(n);  real(c_double), intent(inout) :: box(n, *)
  !> box(:,1:3) = lower, upper, shift; with derivatives = 1 also box(:,4:6) by v and box(:,7:9) by limit: f = min(max(feq - shift,
  !> lower), upper). A result other than 0 ends the call. Conditions and threads: tribo_set_user_law in tribo.h.
  subroutine set_user_law(this, law, data, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    type(c_funptr), value :: law
    type(c_ptr), value :: data
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    if (w%status == TRIBO_OK) w%status = c_set_user_law(w%ctx, law, data)
    call finish(w, stat, errmsg)
  end subroutine set_user_law

  subroutine get_law(this, law, stat, errmsg)
    class(tribo_context), intent(in) :: this
    integer, intent(inout) :: law
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    integer(c_int) :: number

    call begin_const(this, w)
    if (w%status == TRIBO_OK) w%status = c_get_law(w%ctx, number)
    if (w%status == TRIBO_OK) law = int(number)
    call finish(w, stat, errmsg)
  end subroutine get_law

  !> Limits mu*N >= 0, one a contact or one for all; 0 means an open contact, which carries no force and costs nothing.
  subroutine set_limit_each(this, limit, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in) :: limit(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    call expect_size(w, 'limit', limit, w%n)
    if (w%status == TRIBO_OK) w%status = c_set_limit(w%ctx, limit)
    call finish(w, stat, errmsg)
  end subroutine set_limit_each

  !> Limits mu*max(load, 0) from normal loads; a contact with a load <= 0 has lifted off.
  subroutine set_normal_load(this, mu, load, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in) :: mu(:), load(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    call expect_size(w, 'mu', mu, w%n)
    call expect_size(w, 'load', load, w%n)
    if (w%status == TRIBO_OK) w%status = c_set_normal_load(w%ctx, mu, load)
    call finish(w, stat, errmsg)
  end subroutine set_normal_load

  !> Static friction above kinetic: a contact at rest holds up to ratio*limit, ratio >= 1. Once it slides, its limit drops to
  !> limit at once; with velocity > 0 (Stribeck) it is limit*(1 + (ratio - 1)*exp(-abs(v)/velocity)). Without ratio, or with
  !> ratio 1: no static friction. tribo_set_static of tribo.h has the meaning in each law.
  subroutine set_static(this, ratio, velocity, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in), optional, contiguous :: ratio(:), velocity(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    if (present(ratio)) call expect_size(w, 'ratio', ratio, w%n)
    if (present(velocity)) call expect_size(w, 'velocity', velocity, w%n)
    if (w%status == TRIBO_OK) w%status = c_set_static(w%ctx, ratio, velocity)
    call finish(w, stat, errmsg)
  end subroutine set_static

  !> The ratios and velocities set; 1 and 0 by default.
  subroutine get_static(this, ratio, velocity, stat, errmsg)
    class(tribo_context), intent(in) :: this
    real(dp), intent(inout), optional, contiguous :: ratio(:), velocity(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin_const(this, w)
    if (present(ratio)) call expect_size(w, 'ratio', ratio, w%n)
    if (present(velocity)) call expect_size(w, 'velocity', velocity, w%n)
    if (w%status == TRIBO_OK) w%status = c_get_static(w%ctx, ratio, velocity)
    call finish(w, stat, errmsg)
  end subroutine get_static
  !> Planar contacts: contacts first(k) and first(k) + 1 become the two tangential directions of one, with limits as semi-axes; an
  !> array without elements: there are none.
  subroutine set_planar(this, first, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    integer, intent(in) :: first(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    integer :: k

    call begin(this, w)
    do k = 1, size(first)
      call expect_index(w, 'first', k, first(k), w%n - 1)
    end do
    if (w%status == TRIBO_OK) w%status = c_set_planar(w%ctx, size(first, kind=c_size_t), from_zero(first))
    call finish(w, stat, errmsg)
  end subroutine set_planar

  subroutine set_limit_all(this, limit, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in) :: limit
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    if (w%status == TRIBO_OK) w%status = c_set_limit_all(w%ctx, limit)
    call finish(w, stat, errmsg)
  end subroutine set_limit_all

  subroutine get_limit(this, limit, stat, errmsg)
    class(tribo_context), intent(in) :: this
    real(dp), intent(inout) :: limit(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin_const(this, w)
    call expect_size(w, 'limit', limit, w%n)
    if (w%status == TRIBO_OK) w%status = c_get_limit(w%ctx, limit)
    call finish(w, stat, errmsg)
  end subroutine get_limit

  !> Velocity scale > 0 of the regularized laws, one a contact.
  subroutine set_epsilon_each(this, epsilon, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in) :: epsilon(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    call expect_size(w, 'epsilon', epsilon, w%n)
    if (w%status == TRIBO_OK) w%status = c_set_epsilon(w%ctx, epsilon)
    call finish(w, stat, errmsg)
  end subroutine set_epsilon_each

  !> Velocity scale for all contacts: epsilon itself, or the time step of the caller's integrator. With step, epsilon follows
  !> limits and operator: the rate at which stuck contacts relax, 2*limit*R_ii/epsilon, is lambda_dt/step (a few times more in the
  !> partition coupling, see TRIBO_REAL_MAX_RATE). The paper has lambda_dt = 1 for the oscillator (the default) and 0.4 for the
  !> chain; rk4 is stable to 2.785. With step and without operator there is no epsilon.
  subroutine set_epsilon_all(this, epsilon, step, lambda_dt, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in), optional :: epsilon, step, lambda_dt
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    real(dp) :: rate

    call begin(this, w)
    rate = 1
    if (present(lambda_dt)) rate = lambda_dt
    if (present(epsilon) .eqv. present(step)) then
      call fail(w, TRIBO_ERR_RANGE, 'set_epsilon takes either epsilon or step')
    else if (present(epsilon) .and. present(lambda_dt)) then
      call fail(w, TRIBO_ERR_RANGE, 'set_epsilon takes lambda_dt with step only')
    else if (present(epsilon)) then
      w%status = c_set_epsilon_all(w%ctx, epsilon)
    else
      w%status = c_set_epsilon_step(w%ctx, step, rate)
    end if
    call finish(w, stat, errmsg)
  end subroutine set_epsilon_all

  subroutine get_epsilon(this, epsilon, stat, errmsg)
    class(tribo_context), intent(in) :: this
    real(dp), intent(inout) :: epsilon(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin_const(this, w)
    call expect_size(w, 'epsilon', epsilon, w%n)
    if (w%status == TRIBO_OK) w%status = c_get_epsilon(w%ctx, epsilon)
    call finish(w, stat, errmsg)
  end subroutine get_epsilon

  !> The operator R of z'' = R f + a; on error the old one stays. The operator of a system's context cannot be set
  !> (TRIBO_ERR_UNSUPPORTED). A vector r >= 0: R diagonal, for contacts that share no body.
  subroutine set_operator_diagonal(this, r, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in) :: r(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    call expect_size(w, 'r', r, w%n)
    if (w%status == TRIBO_OK) w%status = c_set_operator_diagonal(w%ctx, r)
    call finish(w, stat, errmsg)
  end subroutine set_operator_diagonal

  !> A matrix: symmetric to rounding, positive semidefinite; contacts may be redundant.
  subroutine set_operator_dense(this, r, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in) :: r(:,:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    call expect_size(w, 'r', r, w%n)
    ! Transposed, so that r(i,j) of a message is r(i,j) of the caller.
    if (w%status == TRIBO_OK) w%status = c_set_operator_dense(w%ctx, transpose(r))
    call finish(w, stat, errmsg)
  end subroutine set_operator_dense

  !> The same in compressed rows, both triangles: the entries of row i are val(k) at column col(k), k = rowptr(i) to rowptr(i+1)
  !> - 1, in any order, each at most once; rowptr(1) = 1.
  subroutine set_operator_csr(this, rowptr, col, val, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    integer, intent(in) :: rowptr(:), col(:)
    real(dp), intent(in) :: val(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    call check_rows(w, rowptr, col, val, w%n, w%n)
    if (w%status == TRIBO_OK) w%status = c_set_operator_csr(w%ctx, from_zero(rowptr), from_zero(col), val)
    call finish(w, stat, errmsg)
  end subroutine set_operator_csr

  !> R = J diag(inverse_mass) J', J in compressed rows: v = J u, u(size(inverse_mass)) being the velocities of the degrees of
  !> freedom. inverse_mass >= 0 (0: a degree of freedom with prescribed motion).
  subroutine set_operator_mass(this, inverse_mass, rowptr, col, val, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in) :: inverse_mass(:)
    integer, intent(in) :: rowptr(:), col(:)
    real(dp), intent(in) :: val(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    call check_rows(w, rowptr, col, val, w%n, size(inverse_mass))
    if (w%status == TRIBO_OK) then
      w%status = c_set_operator_mass(w%ctx, size(inverse_mass, kind=c_size_t), inverse_mass, &
        from_zero(rowptr), from_zero(col), val)
    end if
    call finish(w, stat, errmsg)
  end subroutine set_operator_mass

  !> New values of the operator, in the form that was set: val is the diagonal; a matrix column by column; val of R or J in compressed
  !> rows. Its first two calls allocate.
  subroutine update_operator(this, val, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in) :: val(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    integer(c_size_t) :: count

    count = 0
    call begin(this, w)
    if (w%status == TRIBO_OK) w%status = c_get_count(w%ctx, to_int(TRIBO_COUNT_VALUES), count)
    if (count > 0) call expect_size(w, 'val', val, int(count))
    if (w%status == TRIBO_OK) w%status = c_update_operator(w%ctx, val)
    call finish(w, stat, errmsg)
  end subroutine update_operator

  !> R = J M**-1 J' with J [n][ndof] as above, for a mass matrix with a solver of the caller's: calls mass%apply once a contact.
  !> Contacts that do not act on each other have no entry in R.
  subroutine set_operator_callback(this, ndof, mass, rowptr, col, val, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    integer, intent(in) :: ndof
    class(tribo_mass), intent(inout), target :: mass
    integer, intent(in) :: rowptr(:), col(:)
    real(dp), intent(in) :: val(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(held_mass), target :: held
    type(work) :: w

    call begin(this, w)
    call expect_count(w, 'ndof', ndof)
    call check_rows(w, rowptr, col, val, w%n, ndof)
    if (w%status == TRIBO_OK) then
      held%mass => mass
      w%status = c_set_operator_callback(w%ctx, int(ndof, c_size_t), c_funloc(ask_mass), c_loc(held), &
        from_zero(rowptr), from_zero(col), val)
    end if
    call finish(w, stat, errmsg)
  end subroutine set_operator_callback

  !> Calls mass%apply for the library.
  integer(c_int) function ask_mass(ndof, force, acceleration, data) bind(c, name='')
    integer(c_size_t), value :: ndof
    real(c_double), intent(in) :: force(ndof)
    real(c_double), intent(inout) :: acceleration(ndof)
    type(c_ptr), value :: data
    type(held_mass), pointer :: held

    call c_f_pointer(data, held)
    ask_mass = to_int(held%mass%apply(force, acceleration))
  end function ask_mass

  !> TRIBO_CONSISTENT or TRIBO_PARTITION.
  subroutine set_coupling(this, coupling, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    integer, intent(in) :: coupling
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    if (w%status == TRIBO_OK) w%status = c_set_coupling(w%ctx, to_int(coupling))
    call finish(w, stat, errmsg)
  end subroutine set_coupling

  subroutine get_coupling(this, coupling, stat, errmsg)
    class(tribo_context), intent(in) :: this
    integer, intent(inout) :: coupling
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    integer(c_int) :: number

    call begin_const(this, w)
    if (w%status == TRIBO_OK) w%status = c_get_coupling(w%ctx, number)
    if (w%status == TRIBO_OK) coupling = int(number)
    call finish(w, stat, errmsg)
  end subroutine get_coupling

  !> TRIBO_SHARE_LEAST_NORM or TRIBO_SHARE_PREVIOUS.
  subroutine set_sharing(this, sharing, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    integer, intent(in) :: sharing
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    if (w%status == TRIBO_OK) w%status = c_set_sharing(w%ctx, to_int(sharing))
    call finish(w, stat, errmsg)
  end subroutine set_sharing

  subroutine get_sharing(this, sharing, stat, errmsg)
    class(tribo_context), intent(in) :: this
    integer, intent(inout) :: sharing
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    integer(c_int) :: number

    call begin_const(this, w)
    if (w%status == TRIBO_OK) w%status = c_get_sharing(w%ctx, number)
    if (w%status == TRIBO_OK) sharing = int(number)
    call finish(w, stat, errmsg)
  end subroutine get_sharing

  ! --------------------------------------------------------------------------------------------------------------------- forces

  !> Friction force of every contact from its law and f_eq; reads feq where abs(v) <= epsilon. abs(f) <= limit.
  subroutine force(this, v, feq, f, stat, errmsg)
    class(tribo_context), intent(in) :: this
    real(dp), intent(in) :: v(:), feq(:)
    real(dp), intent(inout) :: f(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin_const(this, w)
    call expect_size(w, 'v', v, w%n)
    call expect_size(w, 'feq', feq, w%n)
    call expect_size(w, 'f', f, w%n)
    if (w%status == TRIBO_OK) w%status = c_force(w%ctx, v, feq, f)
    call blame(w, 'v', v)
    call blame(w, 'feq', feq)
    call finish(w, stat, errmsg)
  end subroutine force

  !> The same with derivatives. df_dlimit includes the change of an epsilon that follows the limit (set_epsilon with step).
  subroutine force_tangent(this, v, feq, f, df_dv, df_dfeq, df_dlimit, stat, errmsg)
    class(tribo_context), intent(in) :: this
    real(dp), intent(in) :: v(:), feq(:)
    real(dp), intent(inout), optional, contiguous :: f(:), df_dv(:), df_dfeq(:), df_dlimit(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin_const(this, w)
    call expect_size(w, 'v', v, w%n)
    call expect_size(w, 'feq', feq, w%n)
    if (present(f)) call expect_size(w, 'f', f, w%n)
    if (present(df_dv)) call expect_size(w, 'df_dv', df_dv, w%n)
    if (present(df_dfeq)) call expect_size(w, 'df_dfeq', df_dfeq, w%n)
    if (present(df_dlimit)) call expect_size(w, 'df_dlimit', df_dlimit, w%n)
    if (w%status == TRIBO_OK) w%status = c_force_tangent(w%ctx, v, feq, f, df_dv, df_dfeq, df_dlimit)
    call blame(w, 'v', v)
    call blame(w, 'feq', feq)
    call finish(w, stat, errmsg)
  end subroutine force_tangent

  !> The same where contacts may be planar: df_dv(:, i), df_dfeq(:, i), df_dlimit(:, i) are the derivatives of component i of the
  !> force by the first and the second direction of its contact; of a scalar contact its derivative and 0.
  subroutine force_tangent_planar(this, v, feq, f, df_dv, df_dfeq, df_dlimit, stat, errmsg)
    class(tribo_context), intent(in) :: this
    real(dp), intent(in) :: v(:), feq(:)
    real(dp), intent(inout), optional, contiguous :: f(:), df_dv(:, :), df_dfeq(:, :), df_dlimit(:, :)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin_const(this, w)
    call expect_size(w, 'v', v, w%n)
    call expect_size(w, 'feq', feq, w%n)
    if (present(f)) call expect_size(w, 'f', f, w%n)
    if (present(df_dv)) call expect_shape(w, 'df_dv', shape(df_dv), [2, w%n])
    if (present(df_dfeq)) call expect_shape(w, 'df_dfeq', shape(df_dfeq), [2, w%n])
    if (present(df_dlimit)) call expect_shape(w, 'df_dlimit', shape(df_dlimit), [2, w%n])
    if (w%status == TRIBO_OK) w%status = c_force_tangent_planar(w%ctx, v, feq, f, df_dv, df_dfeq, df_dlimit)
    call blame(w, 'v', v)
    call blame(w, 'feq', feq)
    call finish(w, stat, errmsg)
  end subroutine force_tangent_planar

  !> f_eq and f of coupled contacts, z'' = R f + a. a is the relative acceleration without friction, minus the contact's driven
  !> acceleration; feq is 0 for open contacts; abs(f) <= limit. Where contacts are redundant R f is unique and f one of the
  !> solutions, see set_sharing.
  subroutine balance(this, v, a, feq, f, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in) :: v(:), a(:)
    real(dp), intent(inout), optional, contiguous :: feq(:), f(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    call expect_size(w, 'v', v, w%n)
    call expect_size(w, 'a', a, w%n)
    if (present(feq)) call expect_size(w, 'feq', feq, w%n)
    if (present(f)) call expect_size(w, 'f', f, w%n)
    if (w%status == TRIBO_OK) w%status = c_balance(w%ctx, v, a, feq, f)
    call finish(w, stat, errmsg)
  end subroutine balance

  !> The same with derivatives of f, for Newton's method of an implicit integrator: df_dv(i,j) = df(i)/dv(j), df_da alike.
  subroutine balance_tangent(this, v, a, feq, f, df_dv, df_da, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in) :: v(:), a(:)
    real(dp), intent(inout), optional, contiguous :: feq(:), f(:), df_dv(:,:), df_da(:,:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    call expect_size(w, 'v', v, w%n)
    call expect_size(w, 'a', a, w%n)
    if (present(feq)) call expect_size(w, 'feq', feq, w%n)
    if (present(f)) call expect_size(w, 'f', f, w%n)
    if (present(df_dv)) call expect_size(w, 'df_dv', df_dv, w%n)
    if (present(df_da)) call expect_size(w, 'df_da', df_da, w%n)
    if (w%status == TRIBO_OK) then
      w%status = c_balance_tangent(w%ctx, v, a, feq, f, df_dv, df_da)
      if (w%status == TRIBO_OK .and. present(df_dv)) call transpose_in_place(df_dv)
      if (w%status == TRIBO_OK .and. present(df_da)) call transpose_in_place(df_da)
    end if
    call finish(w, stat, errmsg)
  end subroutine balance_tangent

  !> Product of these derivatives with a change of v and a, for solvers that need no matrix: df = df_dv dv + df_da da at the point
  !> of the last balance_tangent, with or without its matrices. TRIBO_ERR_STATE before any, and after another balance
  !> or setting.
  subroutine tangent_product(this, dv, da, df, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in), optional, contiguous :: dv(:), da(:)
    real(dp), intent(inout) :: df(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    if (present(dv)) call expect_size(w, 'dv', dv, w%n)
    if (present(da)) call expect_size(w, 'da', da, w%n)
    call expect_size(w, 'df', df, w%n)
    if (w%status == TRIBO_OK) w%status = c_tangent_product(w%ctx, dv, da, df)
    call finish(w, stat, errmsg)
  end subroutine tangent_product

  !> The same for a change of limits, for normal loads that follow the motion: df = df_dlimit dlimit. Contacts with limit 0 stay
  !> open.
  subroutine limit_product(this, dlimit, df, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in), contiguous :: dlimit(:)
    real(dp), intent(inout) :: df(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    call expect_size(w, 'dlimit', dlimit, w%n)
    call expect_size(w, 'df', df, w%n)
    if (w%status == TRIBO_OK) w%status = c_limit_product(w%ctx, dlimit, df)
    call finish(w, stat, errmsg)
  end subroutine limit_product

  !> Coulomb's law over one time step, for integrators with fixed steps; needs no epsilon. The constant force over the step dt
  !> with Coulomb's law at its end: v_end = vfree + dt R f, and v_end(i) = 0 or f(i) =
  !> -limit(i)*sign(v_end(i)).
  subroutine step_force(this, dt, vfree, f, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in) :: dt, vfree(:)
    real(dp), intent(inout) :: f(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    call expect_size(w, 'vfree', vfree, w%n)
    call expect_size(w, 'f', f, w%n)
    if (w%status == TRIBO_OK) w%status = c_step_force(w%ctx, dt, vfree, f)
    call finish(w, stat, errmsg)
  end subroutine step_force

  !> The same to second order where sliding turns in the plane or reverses within the step, v being the velocities at its start.
  subroutine step_force_mean(this, dt, v, vfree, f, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in) :: dt, v(:), vfree(:)
    real(dp), intent(inout) :: f(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    call expect_size(w, 'v', v, w%n)
    call expect_size(w, 'vfree', vfree, w%n)
    call expect_size(w, 'f', f, w%n)
    if (w%status == TRIBO_OK) w%status = c_step_force_mean(w%ctx, dt, v, vfree, f)
    call finish(w, stat, errmsg)
  end subroutine step_force_mean

  !> The box-constrained problem of these calls, the minimum of f'Rf/2 + a'f with lower <= f <= upper, for laws of the caller's
  !> own. Reads the operator alone: no limits, law or epsilon.
  subroutine solve_box(this, a, lower, upper, f, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in) :: a(:), lower(:), upper(:)
    real(dp), intent(inout) :: f(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    call expect_size(w, 'a', a, w%n)
    call expect_size(w, 'lower', lower, w%n)
    call expect_size(w, 'upper', upper, w%n)
    call expect_size(w, 'f', f, w%n)
    if (w%status == TRIBO_OK) w%status = c_solve_box(w%ctx, a, lower, upper, f)
    call finish(w, stat, errmsg)
  end subroutine solve_box

  !> The integrator has accepted a step that ended at v, feq. Advances the memory of TRIBO_QUINN_REVERSAL: a contact is
  !> marked when abs(v) > epsilon, and unmarked when abs(v) <= epsilon and abs(feq) <= limit. Does nothing for other laws.
  subroutine accept(this, v, feq, stat, errmsg)
    class(tribo_context), intent(inout) :: this
    real(dp), intent(in) :: v(:), feq(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w

    call begin(this, w)
    call expect_size(w, 'v', v, w%n)
    call expect_size(w, 'feq', feq, w%n)
    if (w%status == TRIBO_OK) w%status = c_accept(w%ctx, v, feq)
    call finish(w, stat, errmsg)
  end subroutine accept

  ! -------------------------------------------------------------------------------------------------------------------- queries

  !> State of each contact in the last balance or step_force: TRIBO_SLIP_STUCK, _FORTH, _BACK, _OPEN or _PLANE. TRIBO_ERR_STATE
  !> before any, and after solve_box.
  subroutine get_slip(this, slip, stat, errmsg)
    class(tribo_context), intent(in) :: this
    integer, intent(inout) :: slip(:)
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    integer(c_signed_char) :: small(size(slip))

    call begin_const(this, w)
    call expect_shape(w, 'slip', shape(slip), [w%n])
    if (w%status == TRIBO_OK) w%status = c_get_slip(w%ctx, small)
    if (w%status == TRIBO_OK) slip = int(small)
    call finish(w, stat, errmsg)
  end subroutine get_slip

  !> One of TRIBO_COUNT_...; value is a default integer, or one of eight bytes for large sums.
  subroutine get_count_short(this, which, value, stat, errmsg)
    class(tribo_context), intent(in) :: this
    integer, intent(in) :: which
    integer(int32), intent(inout) :: value
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    integer(c_size_t) :: count

    call begin_const(this, w)
    if (w%status == TRIBO_OK) w%status = c_get_count(w%ctx, to_int(which), count)
    if (w%status == TRIBO_OK) then
      if (count > huge(value)) call fail(w, TRIBO_ERR_SIZE, 'the count is too large for the kind of value')
    end if
    if (w%status == TRIBO_OK) value = int(count, int32)
    call finish(w, stat, errmsg)
  end subroutine get_count_short

  subroutine get_count_long(this, which, value, stat, errmsg)
    class(tribo_context), intent(in) :: this
    integer, intent(in) :: which
    integer(int64), intent(inout) :: value
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    integer(c_size_t) :: count

    call begin_const(this, w)
    if (w%status == TRIBO_OK) w%status = c_get_count(w%ctx, to_int(which), count)
    if (w%status == TRIBO_OK) value = int(count, int64)
    call finish(w, stat, errmsg)
  end subroutine get_count_long

  !> One of TRIBO_REAL_...
  subroutine get_real(this, which, value, stat, errmsg)
    class(tribo_context), intent(in) :: this
    integer, intent(in) :: which
    real(dp), intent(inout) :: value
    integer, intent(out), optional :: stat
    character(len=*), intent(inout), optional :: errmsg
    type(work) :: w
    real(dp) :: found(1)

    call begin_const(this, w)
    if (w%status == TRIBO_OK) w%status = c_get_real(w%ctx, to_int(which), found)
    if (w%status == TRIBO_OK) value = found(1)
    call finish(w, stat, errmsg)
  end subroutine get_real

  ! ------------------------------------------------------------------------------------------------------- helpers of the calls

  !> Makes a context of the library the object of this, in place of the one before.
  integer(c_int) function adopted(this, ctx) result(status)
    class(tribo_context), intent(inout) :: this
    type(c_ptr), intent(in) :: ctx
    status = adopt(this, ctx, c_funloc(c_destroy))
    if (status /= TRIBO_OK) call c_destroy(ctx)
  end function adopted
end module tribo_contexts

!> The module for programs: the module above, and the constants of tribo.h.
module tribo
  use tribo_constants
  use tribo_contexts
  implicit none
  public
end module tribo
