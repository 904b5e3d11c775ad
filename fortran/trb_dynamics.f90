! SPDX-License-Identifier: BSD-3-Clause
!> tribo_dynamics for fixed-form Fortran: linear structures with friction contacts, their integration, and periodic motions.
!> Arguments as in trb.f90.
!>
!> TRBLIN makes a structure M q'' + C q' + K q = p(t) + J' f, and a handle IH of its contacts: all of trb.f90 works with it
!> (limits by TRBLIM, messages by TRBMSG, the end by TRBDEL), but the operator is the structure's. TRBDRV gives it an integrator.
!> TRBLSP does the same from sparse matrices, TRBRED reduces a large structure to its lowest modes, and TRBCLN copies a structure.
!> A handle of TRBNEW or TRBCPY has contacts only, and is refused here with TRIBO_ERR_STATE.
!>
!> NDOF   degrees of freedom: NDOF of TRBLIN or TRBLSP; of a reduced structure the result of TRBNDF
!> NFULL  degrees of freedom of the matrices; differs from NDOF in a reduced structure
!> Y      displacements(NDOF), velocities(NDOF), sliders of contacts with compliance, energy that friction has dissipated:
!>        2*NDOF + 1 values, and one more for each contact with compliance
!> CV     2*NDOF values: a combination of displacements and velocities
!>
!>   TRBLIN(NDOF, N, RM, C, RK, LDM, RJ, LDJ, IH,    RM(LDM,NDOF), C(LDM,NDOF),        IH new: N contacts, limit 0, no loads;
!>          TEXT, IERR)                              RK(LDM,NDOF) mass, damping,       TEXT the text of an error, else unchanged
!>                                                   stiffness; RJ(LDJ,NDOF): row I
!>                                                   makes the velocity of contact I
!>   TRBLSP(NDOF, N, IRM, ICM, RM, IRC, ICC, C,      the same from sparse matrices     IH, TEXT as of TRBLIN
!>          IRK, ICK, RK, IRJ, ICJ, RJ,              NDOF x NDOF, and N x NDOF: rows
!>          IH, TEXT, IERR)                          as in TRBOPS. Both triangles.
!>                                                   IRC(NDOF+1) = 1: no damping
!>   TRBRED(NFULL, N, IRM, ICM, RM, IRK, ICK, RK,    such matrices, reduced to NMODE   IH, TEXT as of TRBLIN
!>          IRJ, ICJ, RJ, NMODE, ISTAT,              lowest modes and, unless ISTAT
!>          IH, TEXT, IERR)                          is 0, static responses of the
!>                                                   contacts, at most one more
!>                                                   motion a contact
!>   TRBMOD(NFULL, N, IRM, ICM, RM, IRC, ICC, C,     all of it: damping, CMP(N) =      IH, TEXT as of TRBLIN
!>          IRK, ICK, RK, IRJ, ICJ, RJ, CMP,         1/stiffness of the springs in
!>          NMODE, ISTAT, IH, TEXT, IERR)            series with the sliders, 0: a
!>                                                   rigid contact; NMODE = 0: not
!>                                                   reduced
!>   TRBNML(NFULL, N, IRM, ICM, RM, IRC, ICC, C,     all of TRBMOD, and limits that    IH, TEXT as of TRBLIN
!>          IRK, ICK, RK, IRJ, ICJ, RJ, CMP,         follow the motion: NRM(I) = row
!>          NRM, RN,                                 of J that is the normal of
!>          NMODE, ISTAT, IH, TEXT, IERR)            contact I, 0: none; RN(3,N):
!>                                                   friction coefficient, normal
!>                                                   stiffness, gap of contact I
!>   TRBCLN(IH, IHNEW, IERR)                         IH                                IHNEW a copy that shares nothing, with
!>                                                                                     loads and tables, without integrator
!>   TRBNDF(IH, NDOF, IERR)                          IH                                NDOF
!>   TRBLOD(IH, NFULL, OMEGA, PC, PS, IERR)          adds PC(NFULL)*COS(OMEGA*t) + PS(NFULL)*SIN(OMEGA*t) to the load
!>   TRBLTB(IH, NFULL, KNOTS, TIME, VAL, PAT, IERR)  adds PAT(NFULL)*value(t), value linear between VAL(KNOTS) at TIME(KNOTS)
!>   TRBBTB(IH, N, KNOTS, TIME, VAL, PAT, IERR)      adds PAT(N)*value(t) to the velocities of the bases, value as in TRBLTB
!>   TRBCLL(IH, IERR)                                removes all loads
!>   TRBBAS(IH, N, OMEGA, BC, BS, IERR)              adds BC(N)*COS(OMEGA*t) + BS(N)*SIN(OMEGA*t) to the velocities of the bases
!>   TRBHLM(IH, N, OMEGA, FC, FS, IERR)              adds FC(N)*COS(OMEGA*t) + FS(N)*SIN(OMEGA*t) to the limits
!>   TRBHAS(IFEAT, IHAS, IERR)                       IFEAT TRIBO_FEATURE_...           IHAS 1 if this build has it, else 0
!>   TRBBSC(IH, IERR)                                removes all base motions
!>   TRBLMC(IH, IERR)                                removes the table and all harmonics of the limits
!>   TRBSLM(IH, N, T, FMUN, IERR)                    limits at time T                  FMUN(N)
!>   TRBSSL(IH, N, ISLIP, IERR)                      slips where forces were found last  ISLIP(N)
!>   TRBSCN(IH, IWHICH, IVAL, IERR)                  IWHICH TRIBO_COUNT_... of contacts  IVAL
!>   TRBLMT(IH, N, KNOTS, TIME, FMUN, IERR)          limits linear between FMUN(N,KNOTS) at TIME(KNOTS)
!>   TRBCON(IH, NDOF, N, T, Y, V, FEQ, F, IERR)      T, Y                              V(N), FEQ(N), F(N) of the contacts there
!> Steady sliding
!>   TRBEQU(IH, NDOF, N, IGIVEN, Y, ISLIP, NEXP,     IGIVEN(N) directions of slip, 0 as    Y: equilibrium, ISLIP(N), NEXP exponents
!>          RE, AI, IERR)                            found; Y: where contacts rest         RE(2*NDOF), AI(2*NDOF)
!>   TRBFLT(IH, NDOF, N, IPAR, IGIVEN, Y, FROM, TO,  IPAR TRIBO_FLUTTER_...; as TRBEQU;    CRIT: first factor that is not stable,
!>          CRIT, OMEGA, IERR)                       FROM and TO of the factor             OMEGA: frequency there
!> Reduced structures
!>   TRBZET(IH, ZETA, IERR)                          ZETA >= 0: damping ratio of every mode
!>   TRBFRQ(IH, NDOF, W, IERR)                                                         W(NDOF): natural frequencies, rad/time
!>   TRBEXP(IH, NDOF, NFULL, Q, U, IERR)             Q(NDOF) of Y                      U(NFULL): displacements that belong to it
!>   TRBTRC(IH, OMEGA, ERR, IERR)                    OMEGA the highest frequency       ERR: bound of the error at contacts
!> Integrators of your own
!>   TRBDER(IH, NDOF, T, Y, DYDT, IERR)              T, Y                              DYDT(2*NDOF+1)
!>   TRBJAC(IH, NDOF, T, Y, DFDY, LDJ, DFDT, IERR)   T, Y; LDJ >= 2*NDOF+1             DFDY(LDJ,2*NDOF+1): (I,J) of DYDT(I) by Y(J);
!>                                                                                     DFDT(2*NDOF+1) by T
!>   TRBSAC(IH, NDOF, T, Y, IERR)                    T, Y: the step was accepted
!> Integrators of the library
!>   TRBDRV(IH, NAME, DT, ATOL, RTOL, IERR)          NAME of a method, e.g. 'exact': an integrator in the place of the one
!>                                                   before. DT > 0 as TRBHST, or for exact, event and auto as TRBOUT; ATOL
!>                                                   and RTOL as TRBTOL; 0, or both 0: not set
!>   TRBHST(IH, DT, IERR)                            DT > 0: the step of a method with fixed steps, or the first step
!>   TRBTOL(IH, ATOL, RTOL, IERR)                    ATOL > 0, RTOL >= 0: tolerances of event, auto and adaptive methods
!>   TRBOUT(IH, DT, IERR)                            DT > 0: exact, event and auto call SEEN of TRBOBS also every DT
!>   TRBMTH(IH, TEXT, IERR)                                                            TEXT its name; of 'auto', of the one in use
!>   TRBNMT(NMETH, IERR)                                                               NMETH methods: 0 to NMETH - 1
!>   TRBMNM(METH, TEXT, IERR)                        METH                              TEXT its name
!>   TRBHMX(IH, H, IERR)                             H > 0: the largest step of an adaptive method
!>   TRBOBS(IH, SEEN, RPAR, IPAR, IERR)              CALL SEEN(T, NY, Y, KIND, ICON, RPAR, IPAR, ISTOP) at each moment, NY being
!>                                                   2*NDOF+1, KIND TRIBO_MOMENT_... and ICON the contact, 0 for a step (KIND 0):
!>                                                   SEEN, which is EXTERNAL in your program, ends the run by an ISTOP, 0 before,
!>                                                   that is not 0. RPAR(*), IPAR(*) are SEEN's alone. Until the next TRBOBS or
!>                                                   TRBDRV
!>   TRBADV(IH, NDOF, T, T1, Y, IERR)                T, Y, T1 >= T                     T, Y there; on error the last good step
!>   TRBPER(IH, NDOF, T, PERIOD, Y, IERR)            T, PERIOD of the loads; Y guess   Y at T of a periodic motion
!>   TRBRNG(IH, NSECT, IORDER, IERR)                 NSECT equal sectors, 0: no ring; IORDER: engine order of TRBPER's loads
!>   TRBCYC(IH, NDOF, T, PERIOD, Y, IERR)            T; PERIOD, Y guess, PERIOD 0: none    PERIOD and Y at T of a cycle
!>   TRBNLM(IH, NDOF, CV, AMPL, OMEGA, ZETA, Y,      CV(2*NDOF), AMPL of CV'Y; OMEGA, ZETA OMEGA, ZETA and Y of a nonlinear mode
!>          IERR)                                    and Y guess, OMEGA 0, Y 0: none
!>   TRBCRV(IH, NDOF, IOPT, ROPT, CV, T, PERIOD, Y,  IOPT(5): MOTION 0 of TRBPER, 1 of TRBCYC, 2 of TRBNLM; TRIBO_PARAMETER_...;
!>          SEEN, RPAR, IPAR, IERR)                  the contact of a limit; points, 0: 10000; 1: coarse. ROPT(4): LEAST,
!>                                                   MOST, STEP, AMPL, see tribo_curve. CV(2*NDOF) of modes. T, PERIOD, Y as of
!>                                                   the motion; then those of the last point. At each point CALL SEEN(PT, NY, Y,
!>                                                   KIND, ICON, ISTAB, RPAR, IPAR, ISTOP), PT(4): parameter, T, period, zeta;
!>                                                   KIND TRIBO_POINT_..., ICON a contact or 0; ISTAB 1 stable, 0 not, -1 not
!>                                                   known; ISTOP, 0 before, ends the curve if not 0
!> Of the periodic motion found last
!>   TRBFAM(IH, NFREE, IERR)                                                           NFREE: dimension of the family it belongs to
!>   TRBMUL(IH, NDOF, RE, AI, IERR)                                                    RE, AI: Floquet multipliers, one less than values of Y
!>   TRBEXT(IH, NDOF, CV, XMIN, XMAX, TMIN, TMAX,    CV(2*NDOF)                        the extremes of CV'Y, and when
!>          IERR)
!>   TRBHAR(IH, NDOF, CV, K, XC, XS, IERR)           CV(2*NDOF), K >= 0                XC*COS(K*w*t) + XS*SIN(K*w*t) of CV'Y
!>   TRBDIS(IH, N, E, IERR)                                                            E(N): energy that each contact dissipates
!>   TRBSHS(IH, N, SHARE, IERR)                                                        SHARE(N) of the period for which each rests
!> Its derivatives by NP parameters, KIND(NP) TRIBO_PARAMETER_... of tribo_dynamics.h, INDX(NP) contacts of limits (KIND 0)
!>   TRBDEX(IH, NDOF, NP, KIND, INDX, CV, DX, IERR)  CV(2*NDOF)                        DX(2,NP): of XMIN and XMAX of TRBEXT
!>   TRBDEN(IH, N, NP, KIND, INDX, DE, IERR)                                           DE(N,NP): of E of TRBDIS
!>   TRBDEY(IH, NDOF, NP, KIND, INDX, DY, LDY, IERR) LDY >= values of Y                DY(LDY,NP): of Y of TRBPER
!>   TRBDML(IH, NDOF, K, NP, KIND, INDX, DR, DI,     K: multiplier, in TRBMUL's order  DR(NP), DI(NP): of RE(K) and AI(K) of TRBMUL
!>          IERR)
!> Counts and real quantities
!>   TRBDCT(IH, IWHICH, IVAL, IERR)                  IWHICH TRIBO_COUNT_... of a       IVAL
!>                                                   driver, see tribo_dynamics.h
!>   TRBDVL(IH, IWHICH, VAL, IERR)                   IWHICH TRIBO_REAL_... of a driver VAL

!> Helpers. The owner of a handle of TRBLIN is a structure with its driver, as module tribo_dynamics has them.
module tribo_fixed_dynamics
  use tribo_fixed, only: c_handle_add_part, c_handle_drop, c_handle_owner, c_handle_note, find, hand_out, refuse_value => refuse
  use tribo_c
  use tribo
  use tribo_dynamics
  use tribo_dynamics_c, only: c_fortran_given
  use tribo_support, only: object_of
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_f_pointer, c_funloc, c_int, c_int64_t, c_loc, c_null_char, c_ptr
  implicit none
  public

  abstract interface
    !> SEEN of TRBOBS.
    subroutine sees(t, ny, y, kind, icon, rpar, ipar, istop)
      import :: dp
      real(dp), intent(in) :: t, y(*)
      integer, intent(in) :: ny, kind, icon
      real(dp), intent(inout) :: rpar(*)
      integer, intent(inout) :: ipar(*), istop
    end subroutine sees

    !> SEEN of TRBCRV.
    subroutine sees_point(pt, ny, y, kind, icon, istab, rpar, ipar, istop)
      import :: dp
      real(dp), intent(in) :: pt(4), y(*)
      integer, intent(in) :: ny, kind, icon, istab
      real(dp), intent(inout) :: rpar(*)
      integer, intent(inout) :: ipar(*), istop
    end subroutine sees_point
  end interface

  !> rpar and ipar begin where the caller's do; how long these are only the caller knows.
  type, extends(tribo_observer) :: external_observer
    procedure(sees), pointer, nopass :: see => null()
    real(dp), pointer, contiguous :: rpar(:) => null()
    integer, pointer, contiguous :: ipar(:) => null()
  contains
    procedure :: seen => call_see
  end type external_observer

  type, extends(tribo_curve_observer) :: external_curve
    procedure(sees_point), pointer, nopass :: see => null()
    real(dp), pointer, contiguous :: rpar(:) => null()
    integer, pointer, contiguous :: ipar(:) => null()
  contains
    procedure :: seen => call_see_point
  end type external_curve

  type :: structure
    type(tribo_system) :: system
    type(tribo_driver) :: driver
    type(external_observer) :: observer
  end type structure

contains

  integer function call_see(this, moment) result(istop)
    class(external_observer), intent(inout) :: this
    type(tribo_moment), intent(in) :: moment
    istop = 0
    call this%see(moment%t, size(moment%y), moment%y, moment%kind, moment%contact, this%rpar, this%ipar, istop)
  end function call_see

  integer function call_see_point(this, point) result(istop)
    class(external_curve), intent(inout) :: this
    type(tribo_curve_point), intent(in) :: point
    istop = 0
    call this%see([point%parameter, point%t, point%period, point%zeta], size(point%y), point%y, point%kind, point%contact, &
      point%stable, this%rpar, this%ipar, istop)
  end function call_see_point

  !> The structure of a handle, which must have ndof degrees of freedom, and nfull of its matrices, as far as these are given.
  subroutine find_structure(ih, s, ierr, ndof, nfull)
    integer, intent(in) :: ih
    type(structure), pointer, intent(out) :: s
    integer, intent(out) :: ierr
    integer, intent(in), optional :: ndof, nfull
    integer :: given
    type(c_ptr) :: ctx, owner

    nullify (s)
    call find(ih, ctx, ierr)
    if (ierr /= TRIBO_OK) return
    owner = c_handle_owner(-int(ih, c_int64_t))
    if (.not. c_associated(owner)) then
      ierr = c_handle_note(ctx, int(TRIBO_ERR_STATE, c_int), 'IH has contacts only: TRBLIN makes a structure' // c_null_char)
      return
    end if
    call c_f_pointer(owner, s)
    if (present(ndof)) then
      if (ndof /= s%system%ndof()) call refuse_value(ctx, ierr, 'NDOF', ndof, ', but the degrees of freedom are ', s%system%ndof())
    end if
    if (present(nfull)) then
      given = int(c_fortran_given(object_of(s%system)))
      if (nfull /= given) call refuse_value(ctx, ierr, 'NFULL', nfull, ', but the degrees of freedom of the matrices are ', given)
    end if
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
    ierr = c_handle_note(ctx, int(TRIBO_ERR_STATE, c_int), 'IH has no integrator: call TRBDRV first' // c_null_char)
  end subroutine find_driven

  !> The same for calls with arrays of its n contacts.
  subroutine find_contacts(ih, s, ierr, n)
    integer, intent(in) :: ih, n
    type(structure), pointer, intent(out) :: s
    integer, intent(out) :: ierr
    type(c_ptr) :: ctx

    nullify (s)
    call find(ih, ctx, ierr, n)
    if (ierr == TRIBO_OK) call find_structure(ih, s, ierr)
  end subroutine find_contacts

  !> For a handle that has been found: value, the argument called name, must be least at least.
  subroutine require_least(ih, name, value, least, ierr)
    integer, intent(in) :: ih, value, least
    character(len=*), intent(in) :: name
    integer, intent(inout) :: ierr
    type(c_ptr) :: ctx

    if (ierr /= TRIBO_OK .or. value >= least) return
    call find(ih, ctx, ierr)
    call refuse_value(ctx, ierr, name, value, ' is less than ', least)
  end subroutine require_least

  !> Gives a handle of its contacts to a structure. Frees it where there is none to be had, or an error already.
  subroutine give_structure(s, ih, ierr)
    type(structure), pointer, intent(in) :: s
    integer, intent(inout) :: ih, ierr
    type(tribo_context) :: contacts
    integer(c_int64_t) :: number

    if (ierr /= TRIBO_OK) then
      call release_structure(c_loc(s))
      return
    end if
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

  !> Gives the matrix called name to the model. Without effect if ierr is an error already.
  subroutine set_rows(model, name, rows, columns, irow, icol, val, text, ierr)
    type(tribo_model), intent(inout) :: model
    character(len=*), intent(in) :: name
    integer, intent(in) :: rows, columns, irow(*), icol(*)
    real(dp), intent(in) :: val(*)
    character(len=*), intent(inout) :: text
    integer, intent(inout) :: ierr
    type(tribo_sparse) :: x
    character(len=240) :: found
    integer :: entries

    if (ierr /= TRIBO_OK) return
    entries = max(irow(rows + 1) - 1, 0)
    call x%set_csr(columns, irow(:rows + 1), icol(:entries), val(:entries), ierr, found)
    if (ierr /= TRIBO_OK) then
      text = name // ': ' // found
      return
    end if
    select case (name)
    case ('mass')
      call model%set_mass(x, ierr, text)
    case ('damping')
      if (entries > 0) call model%set_damping(x, ierr, text)
    case ('stiffness')
      call model%set_stiffness(x, ierr, text)
    case ('direction')
      call model%set_direction(x, ierr, text)
    end select
  end subroutine set_rows

  !> For TRBLSP, TRBMOD and TRBRED: creates the model, label its ndof, with all matrices but the damping. Without effect if ierr is
  !> an error already.
  subroutine create_model(model, label, ndof, n, irm, icm, rm, irk, ick, rk, irj, icj, rj, text, ierr)
    type(tribo_model), intent(inout) :: model
    character(len=*), intent(in) :: label
    integer, intent(in) :: ndof, n, irm(*), icm(*), irk(*), ick(*), irj(*), icj(*)
    real(dp), intent(in) :: rm(*), rk(*), rj(*)
    character(len=*), intent(inout) :: text
    integer, intent(inout) :: ierr

    call expect_least(label, ndof, 0, text, ierr)
    call expect_least('N', n, 0, text, ierr)
    if (ierr == TRIBO_OK) call model%create(ndof, n, ierr, text)
    call set_rows(model, 'mass', ndof, ndof, irm, icm, rm, text, ierr)
    call set_rows(model, 'stiffness', ndof, ndof, irk, ick, rk, text, ierr)
    call set_rows(model, 'direction', n, ndof, irj, icj, rj, text, ierr)
  end subroutine create_model

  !> A structure of the model, reduced where nmode is present, and its handle.
  subroutine make_structure(model, ih, text, ierr, nmode, istat)
    type(tribo_model), intent(in) :: model
    integer, intent(inout) :: ih
    character(len=*), intent(inout) :: text
    integer, intent(out) :: ierr
    integer, intent(in), optional :: nmode, istat
    type(structure), pointer :: s

    allocate (s)
    if (present(nmode)) then
      call s%system%reduce(model, nmode, merge(TRIBO_STATICS_NONE, TRIBO_STATICS_MASS, istat == 0), ierr, text)
    else
      call s%system%create(model, ierr, text)
    end if
    call give_structure(s, ih, ierr)
  end subroutine make_structure

  !> The same, reduced to nmode modes, or, if nmode = 0, not reduced.
  subroutine make_from_modes(model, nmode, istat, ih, text, ierr)
    type(tribo_model), intent(in) :: model
    integer, intent(in) :: nmode, istat
    integer, intent(inout) :: ih
    character(len=*), intent(inout) :: text
    integer, intent(out) :: ierr

    if (nmode == 0) then
      call make_structure(model, ih, text, ierr)
    else
      call make_structure(model, ih, text, ierr, nmode, istat)
    end if
  end subroutine make_from_modes
end module tribo_fixed_dynamics

! --------------------------------------------------------------------------------------------------------------------- structure

subroutine trblin(ndof, n, rm, c, rk, ldm, rj, ldj, ih, text, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ndof, n, ldm, ldj
  real(dp), intent(in) :: rm(ldm, *), c(ldm, *), rk(ldm, *), rj(ldj, *)
  integer, intent(inout) :: ih
  character(len=*), intent(inout) :: text
  integer, intent(out) :: ierr
  type(tribo_model) :: model

  ierr = TRIBO_OK
  call expect_least('NDOF', ndof, 0, text, ierr)
  call expect_least('N', n, 0, text, ierr)
  call expect_least('LDM', ldm, ndof, text, ierr)
  call expect_least('LDJ', ldj, n, text, ierr)
  if (ierr == TRIBO_OK) call model%create(ndof, n, ierr, text)
  if (ierr == TRIBO_OK) call model%set_mass(rm(:ndof, :ndof), ierr, text)
  if (ierr == TRIBO_OK) then
    if (.not. all(abs(c(:ndof, :ndof)) <= 0)) call model%set_damping(c(:ndof, :ndof), ierr, text)
  end if
  if (ierr == TRIBO_OK) call model%set_stiffness(rk(:ndof, :ndof), ierr, text)
  if (ierr == TRIBO_OK) call model%set_direction(rj(:n, :ndof), ierr, text)
  if (ierr == TRIBO_OK) call make_structure(model, ih, text, ierr)
end subroutine trblin

subroutine trblsp(ndof, n, irm, icm, rm, irc, icc, c, irk, ick, rk, irj, icj, rj, ih, text, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ndof, n, irm(*), icm(*), irc(*), icc(*), irk(*), ick(*), irj(*), icj(*)
  real(dp), intent(in) :: rm(*), c(*), rk(*), rj(*)
  integer, intent(inout) :: ih
  character(len=*), intent(inout) :: text
  integer, intent(out) :: ierr
  type(tribo_model) :: model

  ierr = TRIBO_OK
  call create_model(model, 'NDOF', ndof, n, irm, icm, rm, irk, ick, rk, irj, icj, rj, text, ierr)
  call set_rows(model, 'damping', ndof, ndof, irc, icc, c, text, ierr)
  if (ierr == TRIBO_OK) call make_structure(model, ih, text, ierr)
end subroutine trblsp

subroutine trbmod(nfull, n, irm, icm, rm, irc, icc, c, irk, ick, rk, irj, icj, rj, cmp, nmode, istat, ih, text, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: nfull, n, irm(*), icm(*), irc(*), icc(*), irk(*), ick(*), irj(*), icj(*), nmode, istat
  real(dp), intent(in) :: rm(*), c(*), rk(*), rj(*), cmp(*)
  integer, intent(inout) :: ih
  character(len=*), intent(inout) :: text
  integer, intent(out) :: ierr
  type(tribo_model) :: model

  ierr = TRIBO_OK
  call expect_least('NMODE', nmode, 0, text, ierr)
  call create_model(model, 'NFULL', nfull, n, irm, icm, rm, irk, ick, rk, irj, icj, rj, text, ierr)
  call set_rows(model, 'damping', nfull, nfull, irc, icc, c, text, ierr)
  if (ierr == TRIBO_OK) call model%set_compliance(cmp(:n), ierr, text)
  if (ierr == TRIBO_OK) call make_from_modes(model, nmode, istat, ih, text, ierr)
end subroutine trbmod

subroutine trbnml(nfull, n, irm, icm, rm, irc, icc, c, irk, ick, rk, irj, icj, rj, cmp, nrm, rn, nmode, istat, ih, text, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: nfull, n, irm(*), icm(*), irc(*), icc(*), irk(*), ick(*), irj(*), icj(*), nrm(*), nmode, istat
  real(dp), intent(in) :: rm(*), c(*), rk(*), rj(*), cmp(*), rn(3, *)
  integer, intent(inout) :: ih
  character(len=*), intent(inout) :: text
  integer, intent(out) :: ierr
  type(tribo_model) :: model
  integer :: i

  ierr = TRIBO_OK
  call expect_least('NMODE', nmode, 0, text, ierr)
  call create_model(model, 'NFULL', nfull, n, irm, icm, rm, irk, ick, rk, irj, icj, rj, text, ierr)
  call set_rows(model, 'damping', nfull, nfull, irc, icc, c, text, ierr)
  if (ierr == TRIBO_OK) call model%set_compliance(cmp(:n), ierr, text)
  do i = 1, n
    if (ierr == TRIBO_OK) then
      if (nrm(i) /= 0) call model%set_normal(i, nrm(i), rn(1, i), rn(2, i), rn(3, i), ierr, text)
    end if
  end do
  if (ierr == TRIBO_OK) call make_from_modes(model, nmode, istat, ih, text, ierr)
end subroutine trbnml

subroutine trbred(nfull, n, irm, icm, rm, irk, ick, rk, irj, icj, rj, nmode, istat, ih, text, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: nfull, n, irm(*), icm(*), irk(*), ick(*), irj(*), icj(*), nmode, istat
  real(dp), intent(in) :: rm(*), rk(*), rj(*)
  integer, intent(inout) :: ih
  character(len=*), intent(inout) :: text
  integer, intent(out) :: ierr
  type(tribo_model) :: model

  ierr = TRIBO_OK
  call expect_least('NMODE', nmode, 1, text, ierr)
  call create_model(model, 'NFULL', nfull, n, irm, icm, rm, irk, ick, rk, irj, icj, rj, text, ierr)
  if (ierr == TRIBO_OK) call make_structure(model, ih, text, ierr, nmode, istat)
end subroutine trbred

subroutine trbcln(ih, ihnew, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih
  integer, intent(inout) :: ihnew
  integer, intent(out) :: ierr
  type(structure), pointer :: s, copy

  call find_structure(ih, s, ierr)
  if (ierr /= TRIBO_OK) return
  allocate (copy)
  call s%system%clone(copy%system, ierr)
  call give_structure(copy, ihnew, ierr)
end subroutine trbcln

subroutine trbndf(ih, ndof, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih
  integer, intent(inout) :: ndof
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_structure(ih, s, ierr)
  if (ierr == TRIBO_OK) ndof = s%system%ndof()
end subroutine trbndf

subroutine trblod(ih, nfull, omega, pc, ps, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, nfull
  real(dp), intent(in) :: omega, pc(*), ps(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_structure(ih, s, ierr, nfull=nfull)
  if (ierr == TRIBO_OK) call s%system%add_load(omega, pc(:nfull), ps(:nfull), ierr)
end subroutine trblod

subroutine trbltb(ih, nfull, knots, time, val, pat, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, nfull, knots
  real(dp), intent(in) :: time(*), val(*), pat(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_structure(ih, s, ierr, nfull=nfull)
  call require_least(ih, 'KNOTS', knots, 1, ierr)
  if (ierr == TRIBO_OK) call s%system%add_load_table(time(:knots), val(:knots), pat(:nfull), ierr)
end subroutine trbltb

subroutine trbbtb(ih, n, knots, time, val, pat, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, n, knots
  real(dp), intent(in) :: time(*), val(*), pat(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_contacts(ih, s, ierr, n)
  call require_least(ih, 'KNOTS', knots, 1, ierr)
  if (ierr == TRIBO_OK) call s%system%add_base_table(time(:knots), val(:knots), pat(:n), ierr)
end subroutine trbbtb

subroutine trbcll(ih, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_structure(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%system%clear_loads(ierr)
end subroutine trbcll

subroutine trbbas(ih, n, omega, bc, bs, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: omega, bc(*), bs(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_contacts(ih, s, ierr, n)
  if (ierr == TRIBO_OK) call s%system%add_base_motion(omega, bc(:n), bs(:n), ierr)
end subroutine trbbas

subroutine trbhlm(ih, n, omega, fc, fs, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: omega, fc(*), fs(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_contacts(ih, s, ierr, n)
  if (ierr == TRIBO_OK) call s%system%add_limit(omega, fc(:n), fs(:n), ierr)
end subroutine trbhlm

subroutine trblmt(ih, n, knots, time, fmun, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, n, knots
  real(dp), intent(in) :: time(*), fmun(n, *)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_contacts(ih, s, ierr, n)
  call require_least(ih, 'KNOTS', knots, 1, ierr)
  if (ierr == TRIBO_OK) call s%system%set_limit_table(time(:knots), fmun(:, :knots), ierr)
end subroutine trblmt

subroutine trblmc(ih, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_structure(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%system%clear_limits(ierr)
end subroutine trblmc

subroutine trbbsc(ih, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_structure(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%system%clear_base_motion(ierr)
end subroutine trbbsc

subroutine trbslm(ih, n, t, fmun, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: t
  real(dp), intent(inout) :: fmun(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_contacts(ih, s, ierr, n)
  if (ierr == TRIBO_OK) call s%system%get_limit(t, fmun(:n), ierr)
end subroutine trbslm

subroutine trbssl(ih, n, slip, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, n
  integer, intent(inout) :: slip(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_contacts(ih, s, ierr, n)
  if (ierr == TRIBO_OK) call s%system%get_slip(slip(:n), ierr)
end subroutine trbssl

subroutine trbscn(ih, which, value, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, which
  integer, intent(inout) :: value
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_structure(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%system%get_count(which, value, ierr)
end subroutine trbscn

subroutine trbcon(ih, ndof, n, t, y, v, feq, f, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof, n
  real(dp), intent(in) :: t, y(*)
  real(dp), intent(inout) :: v(*), feq(*), f(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_contacts(ih, s, ierr, n)
  if (ierr == TRIBO_OK) call find_structure(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%system%contacts(t, y(:s%system%dimension()), v(:n), feq(:n), f(:n), ierr)
end subroutine trbcon

subroutine trbequ(ih, ndof, n, given, y, slip, nexp, re, ai, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof, n, given(*)
  integer, intent(inout) :: slip(*), nexp
  real(dp), intent(inout) :: y(*), re(*), ai(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_contacts(ih, s, ierr, n)
  if (ierr == TRIBO_OK) call find_structure(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%system%equilibrium(y(:s%system%dimension()), slip(:n), nexp, re(:2*ndof), ai(:2*ndof), given(:n), &
    ierr)
end subroutine trbequ

subroutine trbflt(ih, ndof, n, ipar, given, y, from, to, crit, omega, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof, n, ipar, given(*)
  real(dp), intent(in) :: y(*), from, to
  real(dp), intent(inout) :: crit, omega
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_contacts(ih, s, ierr, n)
  if (ierr == TRIBO_OK) call find_structure(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%system%find_flutter(ipar, from, to, crit, omega, given(:n), y(:s%system%dimension()), ierr)
end subroutine trbflt

! ------------------------------------------------------------------------------------------------------------ reduced structures

subroutine trbzet(ih, zeta, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih
  real(dp), intent(in) :: zeta
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_structure(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%system%set_damping_ratio(zeta, ierr)
end subroutine trbzet

subroutine trbfrq(ih, ndof, w, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof
  real(dp), intent(inout) :: w(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_structure(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%system%get_frequencies(w(:ndof), ierr)
end subroutine trbfrq

subroutine trbexp(ih, ndof, nfull, q, u, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof, nfull
  real(dp), intent(in) :: q(*)
  real(dp), intent(inout) :: u(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_structure(ih, s, ierr, ndof, nfull)
  if (ierr == TRIBO_OK) call s%system%expand(q(:ndof), u(:nfull), ierr)
end subroutine trbexp

subroutine trbtrc(ih, omega, err, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih
  real(dp), intent(in) :: omega
  real(dp), intent(inout) :: err
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_structure(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%system%get_truncation(omega, err, ierr)
end subroutine trbtrc

! ---------------------------------------------------------------------------------------------------- integrators of the caller's

subroutine trbder(ih, ndof, t, y, dydt, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof
  real(dp), intent(in) :: t, y(*)
  real(dp), intent(inout) :: dydt(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_structure(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%system%derivative(t, y(:s%system%dimension()), dydt(:s%system%dimension()), ierr)
end subroutine trbder

subroutine trbjac(ih, ndof, t, y, dfdy, ldj, dfdt, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof, ldj
  real(dp), intent(in) :: t, y(*)
  real(dp), intent(inout) :: dfdy(ldj, *), dfdt(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s
  integer :: m

  m = 2*ndof + 1
  call find_structure(ih, s, ierr, ndof)
  call require_least(ih, 'LDJ', ldj, m, ierr)
  if (ierr == TRIBO_OK) call s%system%jacobian(t, y(:m), dfdy(:m, :m), dfdt(:m), ierr)
end subroutine trbjac

subroutine trbsac(ih, ndof, t, y, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof
  real(dp), intent(in) :: t, y(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_structure(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%system%accept(t, y(:s%system%dimension()), ierr)
end subroutine trbsac

! ------------------------------------------------------------------------------------------------------ integrators of the library

subroutine trbnmt(nmeth, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(out) :: nmeth, ierr
  nmeth = tribo_method_count()
  ierr = TRIBO_OK
end subroutine trbnmt

subroutine trbhas(ifeat, ihas, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ifeat
  integer, intent(out) :: ihas, ierr
  ihas = merge(1, 0, tribo_dynamics_has(ifeat))
  ierr = TRIBO_OK
end subroutine trbhas

subroutine trbmnm(meth, text, ierr)
  use tribo_fixed_dynamics
  use tribo_dynamics_c, only: c_fortran_method_name
  use tribo_support, only: to_int
  implicit none
  integer, intent(in) :: meth
  character(len=*), intent(inout) :: text
  integer, intent(out) :: ierr
  call hand_out(c_fortran_method_name(to_int(meth)), text, ierr)
end subroutine trbmnm

subroutine trbdrv(ih, name, dt, atol, rtol, ierr)
  use tribo_fixed_dynamics
  use tribo_support, only: take
  implicit none
  integer, intent(in) :: ih
  character(len=*), intent(in) :: name
  real(dp), intent(in) :: dt, atol, rtol
  integer, intent(out) :: ierr
  type(structure), pointer :: s
  type(tribo_driver) :: trial
  type(c_ptr) :: ctx
  integer :: status

  call find_structure(ih, s, ierr)
  if (ierr /= TRIBO_OK) return
  call trial%create(s%system, name, stat=ierr)
  if (ierr == TRIBO_OK .and. .not. abs(dt) <= 0) then
    call trial%set_output(dt, ierr)
    if (ierr == TRIBO_ERR_UNSUPPORTED) call trial%set_step(dt, ierr)
  end if
  if (ierr == TRIBO_OK .and. .not. (abs(atol) <= 0 .and. abs(rtol) <= 0)) call trial%set_tolerance(atol, rtol, ierr)
  if (ierr == TRIBO_OK) then
    call take(s%driver, trial)
  else if (c_associated(object_of(trial))) then
    call find(ih, ctx, status)
    ierr = c_handle_note(ctx, int(ierr, c_int), trial%message() // c_null_char)
  end if
end subroutine trbdrv

subroutine trbhst(ih, dt, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih
  real(dp), intent(in) :: dt
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%driver%set_step(dt, ierr)
end subroutine trbhst

subroutine trbtol(ih, atol, rtol, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih
  real(dp), intent(in) :: atol, rtol
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%driver%set_tolerance(atol, rtol, ierr)
end subroutine trbtol

subroutine trbout(ih, dt, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih
  real(dp), intent(in) :: dt
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%driver%set_output(dt, ierr)
end subroutine trbout

subroutine trbmth(ih, text, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih
  character(len=*), intent(inout) :: text
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr)
  if (ierr == TRIBO_OK) text = s%driver%method()
end subroutine trbmth

subroutine trbhmx(ih, h, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih
  real(dp), intent(in) :: h
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%driver%set_max_step(h, ierr)
end subroutine trbhmx

subroutine trbobs(ih, seen, rpar, ipar, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih
  procedure(sees) :: seen
  real(dp), intent(inout), target :: rpar(*)
  integer, intent(inout), target :: ipar(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr)
  if (ierr /= TRIBO_OK) return
  s%observer%see => seen
  s%observer%rpar => rpar(:1)
  s%observer%ipar => ipar(:1)
  call s%driver%set_observer(s%observer, ierr)
end subroutine trbobs

subroutine trbadv(ih, ndof, t, t1, y, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof
  real(dp), intent(inout) :: t, y(*)
  real(dp), intent(in) :: t1
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%driver%advance(t, t1, y(:s%system%dimension()), ierr)
end subroutine trbadv

subroutine trbper(ih, ndof, t, period, y, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof
  real(dp), intent(in) :: t, period
  real(dp), intent(inout) :: y(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%driver%find_periodic(t, period, y(:s%system%dimension()), ierr)
end subroutine trbper

subroutine trbrng(ih, nsect, iorder, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, nsect, iorder
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%driver%set_ring(nsect, iorder, ierr)
end subroutine trbrng

subroutine trbcyc(ih, ndof, t, period, y, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof
  real(dp), intent(in) :: t
  real(dp), intent(inout) :: period, y(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%driver%find_cycle(t, period, y(:s%system%dimension()), ierr)
end subroutine trbcyc

subroutine trbnlm(ih, ndof, cv, ampl, omega, zeta, y, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof
  real(dp), intent(in) :: cv(*), ampl
  real(dp), intent(inout) :: omega, zeta, y(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%driver%find_mode(cv(:2*ndof), ampl, omega, zeta, y(:s%system%dimension()), ierr)
end subroutine trbnlm

subroutine trbcrv(ih, ndof, iopt, ropt, cv, t, period, y, seen, rpar, ipar, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof, iopt(5)
  real(dp), intent(in) :: ropt(4), cv(*), t
  real(dp), intent(inout) :: period, y(*)
  procedure(sees_point) :: seen
  real(dp), intent(inout), target :: rpar(*)
  integer, intent(inout), target :: ipar(*)
  integer, intent(out) :: ierr
  type(external_curve), target :: observer
  type(tribo_curve) :: curve
  type(structure), pointer :: s

  call find_driven(ih, s, ierr, ndof)
  if (ierr /= TRIBO_OK) return
  curve = tribo_curve(motion=iopt(1), parameter=iopt(2), contact=iopt(3), points=iopt(4), coarse=iopt(5) /= 0, least=ropt(1), &
    most=ropt(2), step=ropt(3), amplitude=ropt(4))
  if (iopt(1) == TRIBO_MOTION_MODE) curve%c = cv(:2*ndof)
  observer%see => seen
  observer%rpar => rpar(:1)
  observer%ipar => ipar(:1)
  call s%driver%follow_curve(curve, t, period, y(:s%system%dimension()), observer, ierr)
end subroutine trbcrv

subroutine trbdct(ih, iwhich, ival, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, iwhich
  integer, intent(inout) :: ival
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%driver%count(iwhich, ival, ierr)
end subroutine trbdct

subroutine trbdvl(ih, iwhich, val, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, iwhich
  real(dp), intent(inout) :: val
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%driver%real(iwhich, val, ierr)
end subroutine trbdvl

! --------------------------------------------------------------------------------------------------------------- periodic motion

subroutine trbmul(ih, ndof, re, ai, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof
  real(dp), intent(inout) :: re(*), ai(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%driver%get_multipliers(re(:s%system%dimension() - 1), ai(:s%system%dimension() - 1), ierr)
end subroutine trbmul

subroutine trbfam(ih, nfree, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih
  integer, intent(inout) :: nfree
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%driver%get_freedom(nfree, ierr)
end subroutine trbfam

subroutine trbext(ih, ndof, cv, xmin, xmax, tmin, tmax, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof
  real(dp), intent(in) :: cv(*)
  real(dp), intent(inout) :: xmin, xmax, tmin, tmax
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr, ndof)
  if (ierr == TRIBO_OK) call s%driver%period_extremes(cv(:2*ndof), xmin, xmax, tmin, tmax, ierr)
end subroutine trbext

subroutine trbhar(ih, ndof, cv, k, xc, xs, ierr)
  use tribo_fixed_dynamics
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
  use tribo_fixed_dynamics
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
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(inout) :: share(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_contacts(ih, s, ierr, n)
  if (ierr == TRIBO_OK) call find_driven(ih, s, ierr)
  if (ierr == TRIBO_OK) call s%driver%period_stick(share(:n), ierr)
end subroutine trbshs

subroutine trbdex(ih, ndof, np, kind, indx, cv, dx, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof, np, kind(*), indx(*)
  real(dp), intent(in) :: cv(*)
  real(dp), intent(inout) :: dx(2, *)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr, ndof)
  call require_least(ih, 'NP', np, 1, ierr)
  if (ierr == TRIBO_OK) call s%driver%period_derivatives(kind(:np), indx(:np), c=cv(:2*ndof), extremes=dx(:, :np), stat=ierr)
end subroutine trbdex

subroutine trbden(ih, n, np, kind, indx, de, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, n, np, kind(*), indx(*)
  real(dp), intent(inout) :: de(n, *)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_contacts(ih, s, ierr, n)
  if (ierr == TRIBO_OK) call find_driven(ih, s, ierr)
  call require_least(ih, 'NP', np, 1, ierr)
  if (ierr == TRIBO_OK) call s%driver%period_derivatives(kind(:np), indx(:np), energy=de(:, :np), stat=ierr)
end subroutine trbden

subroutine trbdey(ih, ndof, np, kind, indx, dy, ldy, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof, np, kind(*), indx(*), ldy
  real(dp), intent(inout) :: dy(ldy, *)
  integer, intent(out) :: ierr
  type(structure), pointer :: s
  integer :: m

  call find_driven(ih, s, ierr, ndof)
  call require_least(ih, 'NP', np, 1, ierr)
  m = 1
  if (ierr == TRIBO_OK) m = s%system%dimension()
  call require_least(ih, 'LDY', ldy, m, ierr)
  if (ierr == TRIBO_OK) call s%driver%period_derivatives(kind(:np), indx(:np), y=dy(:m, :np), stat=ierr)
end subroutine trbdey

subroutine trbdml(ih, ndof, k, np, kind, indx, dr, di, ierr)
  use tribo_fixed_dynamics
  implicit none
  integer, intent(in) :: ih, ndof, k, np, kind(*), indx(*)
  real(dp), intent(inout) :: dr(*), di(*)
  integer, intent(out) :: ierr
  type(structure), pointer :: s

  call find_driven(ih, s, ierr, ndof)
  call require_least(ih, 'NP', np, 1, ierr)
  if (ierr == TRIBO_OK) call s%driver%multiplier_derivatives(k, kind(:np), indx(:np), dr(:np), di(:np), ierr)
end subroutine trbdml
