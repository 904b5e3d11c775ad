!> tribo with GSL for fixed-form Fortran: linear structures with friction contacts, their integration, and periodic motions.
!> Arguments as in trb.f90.
!>
!> TRBLIN makes a structure M q'' + C q' + K q = p(t) + J' f, and a handle IH of its contacts: all of trb.f90 works with it
!> (limits by TRBLIM, messages by TRBMSG, the end by TRBDEL), but the operator is the structure's. TRBDRV gives it an integrator.
!> A handle of TRBNEW or TRBCPY has contacts only, and is refused here with TRIBO_ERR_STATE.
!>
!> NDOF   degrees of freedom; must be that of TRBLIN
!> Y      2*NDOF + 1 values: displacements, velocities, energy that friction has taken
!> CV     2*NDOF values: a combination of displacements and velocities
!>
!>   TRBLIN(NDOF, N, RM, C, RK, LDM, RJ, LDJ, IH,    RM(LDM,NDOF), C(LDM,NDOF),        IH new: N contacts, limit 0, no loads;
!>          TEXT, IERR)                              RK(LDM,NDOF) mass, damping,       TEXT on error what is wrong, else as it was
!>                                                   stiffness; RJ(LDJ,NDOF): row I
!>                                                   makes the velocity of contact I
!>   TRBLOD(IH, NDOF, OMEGA, PC, PS, IERR)           adds PC(NDOF)*COS(OMEGA*t) + PS(NDOF)*SIN(OMEGA*t) to the load
!>   TRBCLL(IH, IERR)                                takes all loads away
!>   TRBBAS(IH, N, OMEGA, BC, BS, IERR)              adds BC(N)*COS(OMEGA*t) + BS(N)*SIN(OMEGA*t) to the velocities of the bases
!>   TRBHLM(IH, N, OMEGA, FC, FS, IERR)              adds FC(N)*COS(OMEGA*t) + FS(N)*SIN(OMEGA*t) to the limits
!>   TRBDRV(IH, NAME, DT, ATOL, RTOL, IERR)          NAME of a method, e.g. 'exact', DT step, tolerances: an integrator in the
!>                                                   place of the one before
!>   TRBADV(IH, NDOF, T, T1, Y, IERR)                T, Y, T1 >= T                     T, Y there; on error the last good step
!>   TRBPER(IH, NDOF, T, PERIOD, Y, IERR)            T, PERIOD of the loads; Y guess   Y at T of a motion that comes back after it
!> Of the periodic motion found last
!>   TRBMUL(IH, NDOF, RE, AI, IERR)                                                    RE(2*NDOF), AI(2*NDOF): Floquet multipliers
!>   TRBEXT(IH, NDOF, CV, XMIN, XMAX, TMIN, TMAX,    CV(2*NDOF)                        the extremes of CV'Y, and when
!>          IERR)
!>   TRBHAR(IH, NDOF, CV, K, XC, XS, IERR)           CV(2*NDOF), K >= 0                XC*COS(K*w*t) + XS*SIN(K*w*t) of CV'Y
!>   TRBDIS(IH, N, E, IERR)                                                            E(N): what each contact dissipates in it
!>   TRBSHS(IH, N, SHARE, IERR)                                                        SHARE(N) of the period for which each rests
!> Counts
!>   TRBDCT(IH, IWHICH, IVAL, IERR)                  IWHICH TRIBO_COUNT_... of a       IVAL
!>                                                   driver, see tribo_gsl.h

!> What they share: the owner of a handle of TRBLIN is a structure with its driver, as module tribo_gsl has them.
module tribo_fixed_gsl
  use tribo_fixed, only: c_handle_add_part, c_handle_drop, c_handle_owner, c_set_message, find, refuse_value => refuse
  use tribo_c
  use tribo
  use tribo_gsl
  use tribo_support, only: object_of
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_f_pointer, c_funloc, c_int, c_int64_t, c_loc, c_null_char, c_ptr
  implicit none
  public

  type :: structure
    type(tribo_system) :: system
    type(tribo_driver) :: driver
  end type structure

contains

  !> The structure of a handle, which must have ndof degrees of freedom.
  subroutine find_structure(ih, s, ierr, ndof)
    integer, intent(in) :: ih
    type(structure), pointer, intent(out) :: s
    integer, intent(out) :: ierr
    integer, intent(in), optional :: ndof
    type(c_ptr) :: ctx, owner

    nullify (s)
    call find(ih, ctx, ierr)
    if (ierr /= TRIBO_OK) return
    owner = c_handle_owner(-int(ih, c_int64_t))
    if (.not. c_associated(owner)) then
      ierr = c_set_message(ctx, int(TRIBO_ERR_STATE, c_int), 'IH has contacts only: TRBLIN makes a structure' // c_null_char)
      return
    end if
    call c_f_pointer(owner, s)
    if (.not. present(ndof)) return
    if (ndof /= s%system%ndof()) call refuse_value(ctx, ierr, 'NDOF', ndof, ', but the degrees of freedom are ', s%system%ndof())
  end subroutine find_structure

  !> The same, which must have a driver.
  subroutine find_driven(ih, s, ierr, ndof)
    integer, intent(in) :: ih
    type(structure), pointer, intent(out) :: s
    integer, intent(out) :: ierr
    integer, intent(in), optional :: ndof
    type(c_ptr) :: ctx

    call find_structure(ih, s, ierr, ndof)
    if (ierr /= TRIBO_OK) return
    if (c_associated(object_of(s%driver))) return
    call find(ih, ctx, ierr)
    ierr = c_set_message(ctx, int(TRIBO_ERR_STATE, c_int), 'IH has no integrator: call TRBDRV first' // c_null_char)
  end subroutine find_driven

  !> The same of which all contacts are asked for.
  subroutine find_contacts(ih, s, ierr, n)
    integer, intent(in) :: ih, n
    type(structure), pointer, intent(out) :: s
    integer, intent(out) :: ierr
    type(c_ptr) :: ctx

    nullify (s)
    call find(ih, ctx, ierr, n)
    if (ierr == TRIBO_OK) call find_structure(ih, s, ierr)
  end subroutine find_contacts

  !> Gives a handle of its contacts to a structure, which it frees where there is none to be had.
  subroutine give_structure(s, ih, ierr)
    type(structure), pointer, intent(in) :: s
    integer, intent(inout) :: ih
    integer, intent(out) :: ierr
    type(tribo_context) :: contacts
    integer(c_int64_t) :: number

    call s%system%context(contacts, ierr)
    number = c_handle_add_part(object_of(contacts), c_loc(s), c_funloc(release_structure))
    if (number /= 0) then
      ih = -int(number)
    else
      ierr = TRIBO_ERR_MEMORY
      call release_structure(c_loc(s))
    end if
  end subroutine give_structure

  subroutine release_structure(object) bind(c, name='')
    type(c_ptr), value :: object
    type(structure), pointer :: s

    call c_f_pointer(object, s)
    call s%driver%destroy()
    call s%system%destroy()
    deallocate (s)
  end subroutine release_structure

  !> For TRBLIN, which has no context yet that could keep a message: value, the argument called name, must be least at least.
  subroutine expect_least(name, value, least, text, ierr)
    character(len=*), intent(in) :: name
    integer, intent(in) :: value, least
    character(len=*), intent(inout) :: text
    integer, intent(inout) :: ierr
    character(len=80) :: found

    if (ierr /= TRIBO_OK .or. value >= least) return
    ierr = TRIBO_ERR_SIZE
    write (found, '(2a,i0,a,i0)') name, ' = ', value, ' is less than ', least
    text = found
  end subroutine expect_least
end module tribo_fixed_gsl

! --------------------------------------------------------------------------------------------------------------------- structure

subroutine trblin(ndof, n, rm, c, rk, ldm, rj, ldj, ih, text, ierr)
  use tribo_fixed_gsl
  implicit none
  integer, intent(in) :: ndof, n, ldm, ldj
  real(dp), intent(in) :: rm(ldm, *), c(ldm, *), rk(ldm, *), rj(ldj, *)
  integer, intent(inout) :: ih
  character(len=*), intent(inout) :: text
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  ierr = TRIBO_OK
  call expect_least('NDOF', ndof, 0, text, ierr)
  call expect_least('N', n, 0, text, ierr)
  call expect_least('LDM', ldm, ndof, text, ierr)
  call expect_least('LDJ', ldj, n, text, ierr)
  if (ierr /= TRIBO_OK) return
  allocate (s)
  if (all(abs(c(:ndof, :ndof)) <= 0)) then
    call s%system%linear(rm(:ndof, :ndof), rk(:ndof, :ndof), rj(:n, :ndof), stat=ierr, errmsg=text)
  else
    call s%system%linear(rm(:ndof, :ndof), rk(:ndof, :ndof), rj(:n, :ndof), c(:ndof, :ndof), stat=ierr, errmsg=text)
  end if
  if (ierr == TRIBO_OK) then
    call give_structure(s, ih, ierr)
  else
    deallocate (s)
  end if
end subroutine trblin

subroutine trblod(ih, ndof, omega, pc, ps, ierr)
  use tribo_fixed_gsl
  implicit none
  integer, intent(in) :: ih, ndof
  real(dp), intent(in) :: omega, pc(*), ps(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_structure(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%system%add_load(omega, pc(:ndof), ps(:ndof), ierr)
end subroutine trblod

subroutine trbcll(ih, ierr)
  use tribo_fixed_gsl
  implicit none
  integer, intent(in) :: ih
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_structure(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%system%clear_loads(ierr)
end subroutine trbcll

subroutine trbbas(ih, n, omega, bc, bs, ierr)
  use tribo_fixed_gsl
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: omega, bc(*), bs(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_contacts(ih, s, ierr, n)
  if (ierr == TRIBO_OK) call s%system%add_base_motion(omega, bc(:n), bs(:n), ierr)
end subroutine trbbas

subroutine trbhlm(ih, n, omega, fc, fs, ierr)
  use tribo_fixed_gsl
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: omega, fc(*), fs(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_contacts(ih, s, ierr, n)
  if (ierr == TRIBO_OK) call s%system%add_limit(omega, fc(:n), fs(:n), ierr)
end subroutine trbhlm

! -------------------------------------------------------------------------------------------------------------------- integrator

subroutine trbdrv(ih, name, dt, atol, rtol, ierr)
  use tribo_fixed_gsl
  implicit none
  integer, intent(in) :: ih
  character(len=*), intent(in) :: name
  real(dp), intent(in) :: dt, atol, rtol
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_structure(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%driver%create(s%system, name, dt, atol, rtol, ierr)
end subroutine trbdrv

subroutine trbadv(ih, ndof, t, t1, y, ierr)
  use tribo_fixed_gsl
  implicit none
  integer, intent(in) :: ih, ndof
  real(dp), intent(inout) :: t, y(*)
  real(dp), intent(in) :: t1
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%driver%advance(t, t1, y(:2*ndof + 1), ierr)
end subroutine trbadv

subroutine trbper(ih, ndof, t, period, y, ierr)
  use tribo_fixed_gsl
  implicit none
  integer, intent(in) :: ih, ndof
  real(dp), intent(in) :: t, period
  real(dp), intent(inout) :: y(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%driver%find_periodic(t, period, y(:2*ndof + 1), ierr)
end subroutine trbper

subroutine trbdct(ih, iwhich, ival, ierr)
  use tribo_fixed_gsl
  implicit none
  integer, intent(in) :: ih, iwhich
  integer, intent(inout) :: ival
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%driver%count(iwhich, ival, ierr)
end subroutine trbdct

! --------------------------------------------------------------------------------------------------------------- periodic motion

subroutine trbmul(ih, ndof, re, ai, ierr)
  use tribo_fixed_gsl
  implicit none
  integer, intent(in) :: ih, ndof
  real(dp), intent(inout) :: re(*), ai(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%driver%get_multipliers(re(:2*ndof), ai(:2*ndof), ierr)
end subroutine trbmul

subroutine trbext(ih, ndof, cv, xmin, xmax, tmin, tmax, ierr)
  use tribo_fixed_gsl
  implicit none
  integer, intent(in) :: ih, ndof
  real(dp), intent(in) :: cv(*)
  real(dp), intent(inout) :: xmin, xmax, tmin, tmax
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%driver%period_extremes_at(cv(:2*ndof), xmin, xmax, tmin, tmax, ierr)
end subroutine trbext

subroutine trbhar(ih, ndof, cv, k, xc, xs, ierr)
  use tribo_fixed_gsl
  implicit none
  integer, intent(in) :: ih, ndof, k
  real(dp), intent(in) :: cv(*)
  real(dp), intent(inout) :: xc, xs
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%driver%period_harmonic(cv(:2*ndof), k, xc, xs, ierr)
end subroutine trbhar

subroutine trbdis(ih, n, e, ierr)
  use tribo_fixed_gsl
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(inout) :: e(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_contacts(ih, s, ierr, n)
  if (ierr == TRIBO_OK) call find_driven(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%driver%period_dissipation(e(:n), ierr)
end subroutine trbdis

subroutine trbshs(ih, n, share, ierr)
  use tribo_fixed_gsl
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(inout) :: share(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_contacts(ih, s, ierr, n)
  if (ierr == TRIBO_OK) call find_driven(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%driver%period_stick(share(:n), ierr)
end subroutine trbshs
