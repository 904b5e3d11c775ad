! SPDX-License-Identifier: BSD-3-Clause
!> tribo for fixed-form Fortran: external routines that need no module and no interface block. Those for structures are in
!> trb_dynamics.f90.
!>
!> I... are default INTEGER, as are N, NDOF, LDR, LDJ, LAW and NLAW; all other numbers are DOUBLE PRECISION; NAME and TEXT are
!> CHARACTER*(*); MINV is a subroutine. Arrays hold one value a contact, N of them, unless said otherwise; an element of a bigger
!> array may be passed, and the array then begins there. Contacts, rows and columns are counted from 1.
!>
!> IH     handle of a set of contacts. It fits a default INTEGER and is never given twice (after two thousand million handles TRBNEW
!>        returns TRIBO_ERR_MEMORY). A handle that was never given, or is deleted, gives TRIBO_ERR_NULL. One handle belongs to one
!>        thread at a time.
!> N      number of contacts; must be that of TRBNEW
!>        Limits, epsilons, RDIAG, FMU, DT and RLDT that are denormal, or not 0 but at most 1E-290 beside numbers of at least
!>        1E-200 in one array, give TRIBO_ERR_RANGE: so a REAL for a DOUBLE PRECISION often reads. Values of other operators may
!>        decay: R and VAL that are denormal give it unless the array has others below 1E-200.
!> IERR   0, or one of the codes of module tribo (TRIBO_ERR_...): outputs are unchanged, and TRBMSG returns the text.
!>
!> Registry                                          in                                out
!>   TRBVER(IVER, IERR)                                                                IVER 10000*major + 100*minor + patch
!>   TRBVST(TEXT, IERR)                                                                TEXT version
!>   TRBTXT(ICODE, TEXT, IERR)                       ICODE any status                  TEXT its meaning
!>   TRBNLW(NLAW, IERR)                                                                NLAW number of laws: 0 to NLAW - 1
!>   TRBLNM(LAW, TEXT, IERR)                         LAW                               TEXT its name
!>   TRBREF(LAW, TEXT, IERR)                         LAW                               TEXT its reference
!>   TRBFND(NAME, LAW, IERR)                         NAME e.g. 'quinn', 'QUINN'        LAW its number
!>   TRBEVL(LAW, V, FEQ, FMUN, EPS,                  one contact, no handle            F and its derivatives by V, FEQ, FMUN
!>          F, DFDV, DFDQ, DFDN, IERR)
!>   TRBELF(N, DZ, STIF, FMUN, F, DFDZ, IERR)        N elements, no handle             F after a displacement DZ, its derivative
!>   TRBELP(N, DZ, STIF, FMUN, F, DFDZ, IERR)        the same in the plane: DZ(2,N)    F(2,N), DFDZ(2,2,N)
!>   TRBCTF(N, DZ, DEPTH, TANG, RNORM, FMU, F, DF,   N elements with a normal spring   F(3,N): tangential forces, and normal force
!>          IERR)                                    that lifts off, no handle: DZ(2,N)   -RNORM*max(DEPTH, 0); DF(I,J,N) = dF(I)
!>                                                   since F, DEPTH at the end, TANG and  by (DZ(1), DZ(2), DEPTH)(J)
!>                                                   RNORM stiffness, FMU friction
!>   TRBDAH(N, DZ, STIF, FMUN, F, DFDZ, IERR)        Dahl's law, no handle             F in/out: the state
!>   TRBLUG(N, DT, DZ, PAR, Z, F, DFDZ, IERR)        LuGre, no handle: PAR(6,N) = s0,  Z in/out, F, DFDZ
!>                                                   s1, s2, fc, fs, vs
!>   TRBBWN(N, DZ, PAR, Z, F, DFDZ, IERR)            Bouc and Wen, no handle: PAR(5,N) Z in/out, F, DFDZ
!>                                                   = stiffness, a, beta, gamma, m
!>   TRBIWN(N, NROOM, DZ, PAR, STATE, F, DFDZ, IERR) Iwan's sliders, no handle:        STATE(3+2*NROOM,N) in/out, F, DFDZ
!>                                                   PAR(4,N) = kt, fs, chi, beta
!> Life
!>   TRBNEW(N, IH, IERR)                             N >= 0                            IH new: quinn, limit 0, epsilon 1E-6,
!>                                                                                     no operator yet
!>   TRBCPY(IH, IHNEW, IERR)                         IH                                IHNEW a copy that shares nothing
!>   TRBCPS(IH, IFROM, IERR)                         IFROM another handle              gives IH the settings of IFROM
!>   TRBFIX(IH, IERR)                                                                  the operator cannot be changed any more
!>   TRBDEL(IH, IERR)                                IH
!>   TRBNUM(IH, N, IERR)                             IH                                N number of contacts
!>   TRBMSG(IH, TEXT, IERR)                          IH; IERR of the call that failed, TEXT of its last error;
!>                                                   or 0                              always defined, even if IH is no handle.
!>                                                                                     An IERR that is not 0 stays as it is
!> Settings
!>   TRBLAW(IH, LAW, IERR)                           LAW
!>   TRBNAM(IH, NAME, IERR)                          NAME of the law
!>   TRBULW(IH, LAW, RPAR, IPAR, IERR)               a law of yours, EXTERNAL in your program, for contacts I1 to I1 + N - 1: CALL
!>                                                   LAW(I1, N, IDER, V, FMUN, EPS, BOX, RPAR, IPAR, IER) sets BOX(N,3) to lower
!>                                                   and upper bound and shift of F = MIN(MAX(FEQ - shift, lower), upper), with
!>                                                   IDER 1 also BOX(N,4) to BOX(N,6) to their derivatives by V(N) and BOX(N,7) to
!>                                                   BOX(N,9) by FMUN(N), or IER, 0 before, to another value; inside FMUN, and
!>                                                   lower = upper where ABS(V) > EPS. RPAR(*) and IPAR(*) stay in use:
!>                                                   declare them in a COMMON block
!>   TRBGLW(IH, LAW, IERR)                                                             LAW
!>   TRBLIM(IH, N, FMUN, IERR)                       FMUN(N) limits mu*N >= 0
!>   TRBNLD(IH, N, FMU, FN, IERR)                    FMU(N) >= 0, FN(N) normal loads   the limits FMU*max(FN, 0)
!>   TRBSTA(IH, N, RATIO, VSTR, IERR)                RATIO(N) >= 1 static limit to limit; VSTR(N) > 0: falls with the speed, or
!>                                                   VSTR(1) = 0: drops at once, VSTR(2) and on are not read
!>   TRBGST(IH, N, RATIO, VSTR, IERR)                                                  RATIO(N), VSTR(N), 0 if it drops at once
!>   TRBPLN(IH, NPL, IFIRST, IERR)                   contacts IFIRST(NPL) and the next of each are the two directions of one
!>                                                   planar contact; NPL 0: none are
!>   TRBLM1(IH, FMUN, IERR)                          FMUN one for all
!>   TRBGLM(IH, N, FMUN, IERR)                                                         FMUN(N)
!>   TRBEPS(IH, N, EPS, IERR)                        EPS(N) > 0
!>   TRBEP1(IH, EPS, IERR)                           EPS one for all
!>   TRBSTP(IH, DT, RLDT, IERR)                      DT step, RLDT lambda*dt: epsilon follows
!>   TRBGEP(IH, N, EPS, IERR)                                                          EPS(N)
!>   TRBOPD(IH, N, RDIAG, IERR)                      RDIAG(N) >= 0: R diagonal
!>   TRBOPF(IH, N, R, LDR, IERR)                     R(LDR,N) full, symmetric; LDR >= N
!>   TRBOPS(IH, N, IROW, ICOL, VAL, IERR)            R sparse: row I is VAL(K) at column ICOL(K),
!>                                                   K = IROW(I) to IROW(I+1) - 1; IROW(N+1), IROW(1) = 1
!>   TRBOPM(IH, N, NDOF, RMINV, IROW, ICOL, VAL,     R = J diag(RMINV(NDOF)) J', J (N x NDOF) sparse as above
!>          IERR)
!>   TRBOPC(IH, N, NDOF, MINV, IROW, ICOL, VAL,      R = J M**-1 J', J as above, by CALL MINV(NDOF, FORCE, ACC, RPAR, IPAR, IER),
!>          RPAR, IPAR, IERR)                        once a contact: MINV, which is EXTERNAL in your program, sets ACC(NDOF) to
!>                                                   M**-1 FORCE(NDOF), to 1E-11, or IER, 0 before, to another value: IERR is
!>                                                   TRIBO_ERR_CALLBACK then. RPAR(*) and IPAR(*) are for MINV alone
!>   TRBUPD(IH, NVAL, VAL, IERR)                     VAL(NVAL) new values: RDIAG, R(N,N), VAL of TRBOPS or TRBOPM
!>   TRBCPL(IH, ICPL, IERR)                          ICPL 0 consistent, 1 partition
!>   TRBGCP(IH, ICPL, IERR)                                                            ICPL
!>   TRBSHR(IH, ISHR, IERR)                          ISHR: redundant contacts share    0 by least norm, 1 as in the last call
!>   TRBGSH(IH, ISHR, IERR)                                                            ISHR
!> Forces
!>   TRBFRC(IH, N, V, FEQ, F, IERR)                  V(N), FEQ(N)                      F(N)
!>   TRBFTN(IH, N, V, FEQ, F, DFDV, DFDQ, DFDN,      V(N), FEQ(N)                      F(N), its derivatives by V, FEQ, limit
!>          IERR)
!>   TRBFTP(IH, N, V, FEQ, F, DFDV, DFDQ, DFDN,      V(N), FEQ(N)                      the same of planar contacts: DFDV(2,N) and
!>          IERR)                                                                      so on, (J,I) how F(I) follows direction J
!>                                                                                     of its contact; scalar ones: (2,I) is 0
!>   TRBBAL(IH, N, V, A, FEQ, F, IERR)               V(N), A(N)                        FEQ(N), F(N)
!>   TRBBTN(IH, N, V, A, FEQ, F, DFDV, DFDA, LDJ,    V(N), A(N); LDJ >= N              FEQ(N), F(N), DFDV(LDJ,N) and DFDA(LDJ,N):
!>          IERR)                                                                      (I,J) of F(I) by V(J), A(J)
!>   TRBTPR(IH, N, DV, DA, DF, IERR)                 DV(N), DA(N): changes of V, A     DF(N) = DFDV DV + DFDA DA of TRBBTN
!>   TRBLPR(IH, N, DLIM, DF, IERR)                   DLIM(N): change of the limits     DF(N): change of the forces of TRBBTN
!>   TRBSTF(IH, N, DT, VFREE, F, IERR)               DT, VFREE(N)                      F(N): Coulomb's law over one step
!>   TRBSTM(IH, N, DT, V, VFREE, F, IERR)            DT, V(N) at its start, VFREE(N)   F(N): the same to second order
!>   TRBBOX(IH, N, A, FLO, FUP, F, IERR)             A(N), FLO(N) <= FUP(N)            F(N): minimum of F'RF/2 + A'F in the box
!>   TRBACC(IH, N, V, FEQ, IERR)                     V(N), FEQ(N) of an accepted step
!> Queries
!>   TRBSLP(IH, N, ISLIP, IERR)                                                        ISLIP(N): 0 stuck, +1 -1 sliding, 2 open,
!>                                                                                     3 sliding in the plane
!>   TRBCNT(IH, IWHICH, IVAL, IERR)                  IWHICH TRIBO_COUNT_...            IVAL
!>   TRBVAL(IH, IWHICH, VAL, IERR)                   IWHICH TRIBO_REAL_...             VAL

!> Helpers. A handle stands for a context of the library, the object of minus its number, see handle.h. Doubles go to the library
!> directly. For arguments that Fortran stores otherwise (indices, matrices, integers, texts) a routine borrows the context as a
!> tribo_context, and calls module tribo.
module tribo_fixed
  use tribo_c
  use tribo
  use tribo_support, only: lend, message_of, to_int, to_text, work
  implicit none
  public

  abstract interface
    !> MINV of TRBOPC.
    subroutine inverse_of_mass(ndof, force, acc, rpar, ipar, ier)
      import :: dp
      integer, intent(in) :: ndof
      real(dp), intent(in) :: force(*)
      real(dp), intent(inout) :: acc(*), rpar(*)
      integer, intent(inout) :: ipar(*), ier
    end subroutine inverse_of_mass
  end interface

  abstract interface
    !> LAW of TRBULW.
    subroutine boxes_of_law(i1, n, ider, v, fmun, eps, box, rpar, ipar, ier)
      import :: dp
      integer, intent(in) :: i1, n, ider
      real(dp), intent(in) :: v(*), fmun(*), eps(*)
      real(dp), intent(inout) :: box(n, *), rpar(*)
      integer, intent(inout) :: ipar(*), ier
    end subroutine boxes_of_law
  end interface

  !> What tribo_handle_law keeps.
  type, bind(c) :: external_law
    type(c_funptr) :: law
    type(c_ptr) :: rpar, ipar
  end type external_law

  !> rpar and ipar point to the first elements of the caller's arrays of unknown length.
  type, extends(tribo_mass) :: external_mass
    procedure(inverse_of_mass), pointer, nopass :: minv => null()
    real(dp), pointer, contiguous :: rpar(:) => null()
    integer, pointer, contiguous :: ipar(:) => null()
  contains
    procedure :: apply => call_minv
  end type external_mass

contains

  integer function call_minv(this, force, acceleration) result(ier)
    class(external_mass), intent(inout) :: this
    real(dp), intent(in) :: force(:)
    real(dp), intent(inout) :: acceleration(:)
    ier = 0
    call this%minv(size(force), force, acceleration, this%rpar, this%ipar, ier)
  end function call_minv

  !> Calls LAW of TRBULW for the library.
  integer(c_int) function call_law(first, n, derivatives, v, limit, epsilon, box, data) bind(c, name='')
    integer(c_size_t), value :: first, n
    integer(c_int), value :: derivatives
    real(c_double), intent(in) :: v(n), limit(n), epsilon(n)
    real(c_double), intent(inout) :: box(n, *)
    type(c_ptr), value :: data
    type(external_law), pointer :: held
    procedure(boxes_of_law), pointer :: law
    real(dp), pointer :: rpar(:)
    integer, pointer :: ipar(:)
    integer :: ier

    call c_f_pointer(data, held)
    call c_f_procpointer(held%law, law)
    call c_f_pointer(held%rpar, rpar, [1])
    call c_f_pointer(held%ipar, ipar, [1])
    ier = 0
    call law(int(first) + 1, int(n), int(derivatives), v, limit, epsilon, box, rpar, ipar, ier)
    call_law = to_int(ier)
  end function call_law

  !> The context of a handle; ierr is an error if it has none, or not n contacts.
  subroutine find(ih, ctx, ierr, n)
    integer, intent(in) :: ih
    type(c_ptr), intent(out) :: ctx
    integer, intent(out) :: ierr
    integer, intent(in), optional :: n
    integer(c_size_t) :: found

    ctx = c_null_ptr
    if (ih > 0) ctx = c_handle_find(-int(ih, c_int64_t))
    ierr = c_get_ncontact(ctx, found)
    if (ierr /= TRIBO_OK .or. .not. present(n)) return
    if (n /= found) call refuse(ctx, ierr, 'N', n, ', but the number of contacts is ', int(found))
  end subroutine find

  !> Status of a call on ctx; notes its message on error, also of a call on a const context, which keeps none.
  integer function told(ctx, status)
    type(c_ptr), intent(in) :: ctx
    integer(c_int), intent(in) :: status
    character(len=:), allocatable :: text

    told = int(status)
    if (status == TRIBO_OK) return
    call to_text(c_message(ctx), text)
    told = int(c_handle_note(ctx, status, text // c_null_char))
  end function told

  integer function told_const(ctx, status)
    type(c_ptr), intent(in) :: ctx
    integer(c_int), intent(in) :: status

    told_const = int(status)
    if (status /= TRIBO_OK) told_const = int(c_handle_note(ctx, status))
  end function told_const

  !> The same as a tribo_context; and value, the argument called name, must be least at least.
  subroutine borrow(ih, c, ierr, n, name, value, least)
    integer, intent(in) :: ih
    type(tribo_context), intent(inout) :: c
    integer, intent(out) :: ierr
    integer, intent(in), optional :: n, value, least
    character(len=*), intent(in), optional :: name
    type(c_ptr) :: ctx

    call find(ih, ctx, ierr, n)
    if (ierr == TRIBO_OK .and. present(name)) then
      if (value < least) call refuse(ctx, ierr, name, value, ' is less than ', least)
    end if
    if (ierr == TRIBO_OK) call lend(c, -int(ih, c_int64_t))
  end subroutine borrow

  !> The error of an argument with a wrong value.
  subroutine refuse(ctx, ierr, name, value, but, other)
    type(c_ptr), intent(in) :: ctx
    integer, intent(inout) :: ierr
    character(len=*), intent(in) :: name, but
    integer, intent(in) :: value, other
    character(len=80) :: text

    write (text, '(2a,i0,a,i0)') name, ' = ', value, but, other
    ierr = c_handle_note(ctx, int(TRIBO_ERR_SIZE, c_int), trim(text) // c_null_char)
  end subroutine refuse

  !> Fails if x(n), or x(1) without n, has a denormal number, or one of at most 1E-290 beside one of at least 1E-200: a REAL that is
  !> read as a DOUBLE PRECISION often is such a number. 0 is none. Bits have the order of sizes, and no comparison of them traps.
  subroutine check_precision(ctx, ierr, name, x, n)
    type(c_ptr), intent(in) :: ctx
    integer, intent(inout) :: ierr
    character(len=*), intent(in) :: name
    real(dp), intent(in) :: x(*)
    integer, intent(in), optional :: n
    integer(c_int64_t) :: bits, least, most, refused
    integer :: i, count
    character(len=20) :: place

    if (ierr /= TRIBO_OK) return
    count = 1
    if (present(n)) count = n
    least = huge(least)
    most = 0
    do i = 1, count
      bits = size_bits(x(i))
      most = max(most, bits)
      if (bits > 0) least = min(least, bits)
    end do
    refused = size_bits(tiny(x)) - 1
    if (most >= size_bits(1e-200_dp)) refused = size_bits(1e-290_dp)
    if (least > refused) return
    do i = 1, count
      if (size_bits(x(i)) == least) exit
    end do
    place = ''
    if (present(n)) write (place, '(a,i0,a)') '(', i, ')'
    call doubt_precision(ctx, ierr, name, trim(place), x(i))
  end subroutine check_precision

  !> Fails if one of the values of an operator, x(:n, :columns), is denormal. Values may decay so far: no failure if another one is
  !> between the least normal number and 1E-200; a REAL that is read as a DOUBLE PRECISION seldom is.
  subroutine check_values(ctx, ierr, name, x, ldx, n, columns)
    type(c_ptr), intent(in) :: ctx
    integer, intent(inout) :: ierr
    character(len=*), intent(in) :: name
    integer, intent(in) :: ldx, n
    real(dp), intent(in) :: x(ldx, *)
    integer, intent(in), optional :: columns
    integer(c_int64_t) :: bits
    integer :: i, j, count, found(2)
    character(len=40) :: place

    if (ierr /= TRIBO_OK) return
    count = 1
    if (present(columns)) count = columns
    found = 0
    do j = 1, count
      do i = 1, n
        bits = size_bits(x(i, j))
        if (bits >= size_bits(tiny(x)) .and. bits < size_bits(1e-200_dp)) return
        if (bits > 0 .and. bits < size_bits(tiny(x)) .and. found(1) == 0) found = [i, j]
      end do
    end do
    if (found(1) == 0) return
    write (place, '(a,i0,a)') '(', found(1), ')'
    if (present(columns)) write (place, '(a,i0,a,i0,a)') '(', found(1), ',', found(2), ')'
    call doubt_precision(ctx, ierr, name, trim(place), x(found(1), found(2)))
  end subroutine check_values

  !> check_values of the entries VAL of n sparse rows; no failure if a row is wrong, or a column, 1 to width, which the library says.
  subroutine check_entries(ih, ierr, n, width, irow, icol, val)
    integer, intent(in) :: ih, n, width, irow(*), icol(*)
    integer, intent(inout) :: ierr
    real(dp), intent(in) :: val(*)
    type(c_ptr) :: ctx
    integer :: count

    if (ierr /= TRIBO_OK) return
    if (irow(1) /= 1 .or. any(irow(2:n + 1) < irow(:n))) return
    count = irow(n + 1) - 1
    if (any(icol(:count) < 1 .or. icol(:count) > width)) return
    call find(ih, ctx, ierr)
    call check_values(ctx, ierr, 'VAL', val, max(count, 1), count)
  end subroutine check_entries

  !> Bits of |x|, larger for larger |x|.
  elemental integer(c_int64_t) function size_bits(x)
    real(dp), intent(in) :: x

    size_bits = iand(transfer(x, size_bits), huge(size_bits))
  end function size_bits

  !> The error of an argument that may be a REAL.
  subroutine doubt_precision(ctx, ierr, name, place, x)
    type(c_ptr), intent(in) :: ctx
    integer, intent(inout) :: ierr
    character(len=*), intent(in) :: name, place
    real(dp), intent(in) :: x
    character(len=120) :: text

    write (text, '(3a,es10.3e3,3a)') name, place, ' = ', x, ' is neither 0 nor of a usual size: is ', name, ' DOUBLE PRECISION?'
    ierr = c_handle_note(ctx, int(TRIBO_ERR_RANGE, c_int), trim(text) // c_null_char)
  end subroutine doubt_precision

  !> A handle for a context, if there is no error yet.
  subroutine give(ctx, ih, ierr)
    type(c_ptr), intent(in) :: ctx
    integer, intent(inout) :: ih, ierr
    integer(c_int64_t) :: number

    if (ierr /= TRIBO_OK) return
    number = c_handle_add_short(ctx, c_funloc(c_destroy))
    if (number == 0) then
      call c_destroy(ctx)
      ierr = TRIBO_ERR_MEMORY
    else
      ih = -int(number)
    end if
  end subroutine give

  !> Returns a text of the library, if it has one.
  subroutine hand_out(s, text, ierr)
    type(c_ptr), intent(in) :: s
    character(len=*), intent(inout) :: text
    integer, intent(out) :: ierr
    character(len=:), allocatable :: found

    call to_text(s, found)
    ierr = TRIBO_ERR_RANGE
    if (len(found) == 0) return
    text = found
    ierr = TRIBO_OK
  end subroutine hand_out
end module tribo_fixed

! ---------------------------------------------------------------------------------------------------------------------- registry

subroutine trbver(iver, ierr)
  use tribo_fixed
  implicit none
  integer, intent(out) :: iver, ierr
  iver = tribo_version()
  ierr = TRIBO_OK
end subroutine trbver

subroutine trbvst(text, ierr)
  use tribo_fixed
  implicit none
  character(len=*), intent(inout) :: text
  integer, intent(out) :: ierr
  call hand_out(c_version_string(), text, ierr)
end subroutine trbvst

subroutine trbtxt(icode, text, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: icode
  character(len=*), intent(inout) :: text
  integer, intent(out) :: ierr
  call hand_out(c_strerror(to_int(icode)), text, ierr)
end subroutine trbtxt

subroutine trbnlw(nlaw, ierr)
  use tribo_fixed
  implicit none
  integer, intent(out) :: nlaw, ierr
  nlaw = tribo_law_count()
  ierr = TRIBO_OK
end subroutine trbnlw

subroutine trblnm(law, text, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: law
  character(len=*), intent(inout) :: text
  integer, intent(out) :: ierr
  call hand_out(c_law_name(to_int(law)), text, ierr)
end subroutine trblnm

subroutine trbref(law, text, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: law
  character(len=*), intent(inout) :: text
  integer, intent(out) :: ierr
  call hand_out(c_law_reference(to_int(law)), text, ierr)
end subroutine trbref

subroutine trbfnd(name, law, ierr)
  use tribo_fixed
  implicit none
  character(len=*), intent(in) :: name
  integer, intent(inout) :: law
  integer, intent(out) :: ierr
  call tribo_law_find(name, law, ierr)
end subroutine trbfnd

subroutine trbevl(law, v, feq, fmun, eps, f, dfdv, dfdq, dfdn, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: law
  real(dp), intent(in) :: v, feq, fmun, eps
  real(dp), intent(inout) :: f, dfdv, dfdq, dfdn
  integer, intent(out) :: ierr
  call tribo_law_eval(law, v, feq, fmun, eps, f, dfdv, dfdq, dfdn, ierr)
end subroutine trbevl

subroutine trbelf(n, dz, stif, fmun, f, dfdz, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: n
  real(dp), intent(in) :: dz(*), stif(*), fmun(*)
  real(dp), intent(inout) :: f(*), dfdz(*)
  integer, intent(out) :: ierr
  ierr = TRIBO_ERR_NEGATIVE
  if (n >= 0) call tribo_elastic_force(dz(:n), stif(:n), fmun(:n), f(:n), dfdz(:n), ierr)
end subroutine trbelf

subroutine trbelp(n, dz, stif, fmun, f, dfdz, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: n
  real(dp), intent(in) :: dz(2, *), stif(*), fmun(*)
  real(dp), intent(inout) :: f(2, *), dfdz(2, 2, *)
  integer, intent(out) :: ierr
  ierr = TRIBO_ERR_NEGATIVE
  if (n >= 0) call tribo_elastic_force(dz(:, :n), stif(:n), fmun(:n), f(:, :n), dfdz(:, :, :n), ierr)
end subroutine trbelp

subroutine trbctf(n, dz, depth, tang, rnorm, fmu, f, df, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: n
  real(dp), intent(in) :: dz(2, *), depth(*), tang(*), rnorm(*), fmu(*)
  real(dp), intent(inout) :: f(3, *), df(3, 3, *)
  integer, intent(out) :: ierr
  ierr = TRIBO_ERR_NEGATIVE
  if (n >= 0) call tribo_contact_force(dz(:, :n), depth(:n), tang(:n), rnorm(:n), fmu(:n), f(:, :n), df(:, :, :n), ierr)
end subroutine trbctf

subroutine trbdah(n, dz, stif, fmun, f, dfdz, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: n
  real(dp), intent(in) :: dz(*), stif(*), fmun(*)
  real(dp), intent(inout) :: f(*), dfdz(*)
  integer, intent(out) :: ierr
  ierr = TRIBO_ERR_NEGATIVE
  if (n >= 0) call tribo_dahl_force(dz(:n), stif(:n), fmun(:n), f(:n), dfdz(:n), ierr)
end subroutine trbdah

subroutine trblug(n, dt, dz, par, z, f, dfdz, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: n
  real(dp), intent(in) :: dt, dz(*), par(6, *)
  real(dp), intent(inout) :: z(*), f(*), dfdz(*)
  integer, intent(out) :: ierr
  ierr = TRIBO_ERR_NEGATIVE
  if (n >= 0) call tribo_lugre_force(dt, dz(:n), par(:, :n), z(:n), f(:n), dfdz(:n), ierr)
end subroutine trblug

subroutine trbbwn(n, dz, par, z, f, dfdz, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: n
  real(dp), intent(in) :: dz(*), par(5, *)
  real(dp), intent(inout) :: z(*), f(*), dfdz(*)
  integer, intent(out) :: ierr
  ierr = TRIBO_ERR_NEGATIVE
  if (n >= 0) call tribo_bouc_wen_force(dz(:n), par(:, :n), z(:n), f(:n), dfdz(:n), ierr)
end subroutine trbbwn

subroutine trbiwn(n, nroom, dz, par, state, f, dfdz, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: n, nroom
  real(dp), intent(in) :: dz(*), par(4, *)
  real(dp), intent(inout) :: state(3 + 2*max(nroom, 0), *), f(*), dfdz(*)
  integer, intent(out) :: ierr
  ierr = TRIBO_ERR_NEGATIVE
  if (n >= 0 .and. nroom >= 0) call tribo_iwan_force(nroom, dz(:n), par(:, :n), state(:, :n), f(:n), dfdz(:n), ierr)
end subroutine trbiwn

! -------------------------------------------------------------------------------------------------------------------------- life

subroutine trbnew(n, ih, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: n
  integer, intent(inout) :: ih
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  ierr = TRIBO_ERR_NEGATIVE
  if (n >= 0) ierr = c_create(ctx, int(n, c_size_t))
  call give(ctx, ih, ierr)
end subroutine trbnew

subroutine trbcpy(ih, ihnew, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih
  integer, intent(inout) :: ihnew
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx, copy

  call find(ih, ctx, ierr)
  if (ierr == TRIBO_OK) ierr = told_const(ctx, c_clone(ctx, copy))
  call give(copy, ihnew, ierr)
end subroutine trbcpy

subroutine trbdel(ih, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr)
  if (ierr == TRIBO_OK) call c_handle_drop(-int(ih, c_int64_t))
end subroutine trbdel

subroutine trbcps(ih, ifrom, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, ifrom
  integer, intent(out) :: ierr
  type(tribo_context) :: c, from

  call borrow(ifrom, from, ierr)
  if (ierr == TRIBO_OK) call borrow(ih, c, ierr)
  if (ierr == TRIBO_OK) call c%copy_settings(from, ierr)
end subroutine trbcps

subroutine trbfix(ih, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih
  integer, intent(out) :: ierr
  type(tribo_context) :: c

  call borrow(ih, c, ierr)
  if (ierr == TRIBO_OK) call c%fix_operator(ierr)
end subroutine trbfix

subroutine trbnum(ih, n, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih
  integer, intent(inout) :: n
  integer, intent(out) :: ierr
  type(tribo_context) :: c

  call borrow(ih, c, ierr)
  if (ierr == TRIBO_OK) call c%get_ncontact(n, ierr)
end subroutine trbnum

subroutine trbmsg(ih, text, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih
  character(len=*), intent(inout) :: text
  integer, intent(inout) :: ierr
  type(work) :: w
  character(len=:), allocatable :: found
  character(len=80) :: none
  integer :: no_handle

  call find(ih, w%ctx, no_handle)
  if (no_handle == TRIBO_OK) then
    w%found = c_message(w%ctx)
    call message_of(w, found)
    text = found
  else
    write (none, '(a,i0,a)') 'IH = ', ih, ' is no handle: it was never given, or has been deleted'
    text = none
  end if
  if (ierr == TRIBO_OK) ierr = no_handle
end subroutine trbmsg

! ---------------------------------------------------------------------------------------------------------------------- settings

subroutine trblaw(ih, law, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, law
  integer, intent(out) :: ierr
  type(tribo_context) :: c

  call borrow(ih, c, ierr)
  if (ierr == TRIBO_OK) call c%set_law(law, ierr)
end subroutine trblaw

subroutine trbnam(ih, name, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih
  character(len=*), intent(in) :: name
  integer, intent(out) :: ierr
  type(tribo_context) :: c

  call borrow(ih, c, ierr)
  if (ierr == TRIBO_OK) call c%set_law(name, ierr)
end subroutine trbnam

subroutine trbulw(ih, law, rpar, ipar, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih
  procedure(boxes_of_law) :: law
  real(dp), intent(inout), target :: rpar(*)
  integer, intent(inout), target :: ipar(*)
  integer, intent(out) :: ierr
  type(tribo_context) :: c
  type(c_ptr) :: data

  call borrow(ih, c, ierr)
  if (ierr /= TRIBO_OK) return
  data = c_handle_law(c_funloc(law), c_loc(rpar), c_loc(ipar))
  ierr = TRIBO_ERR_MEMORY
  if (c_associated(data)) call c%set_user_law(c_funloc(call_law), data, ierr)
end subroutine trbulw

subroutine trbglw(ih, law, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih
  integer, intent(inout) :: law
  integer, intent(out) :: ierr
  type(tribo_context) :: c

  call borrow(ih, c, ierr)
  if (ierr == TRIBO_OK) call c%get_law(law, ierr)
end subroutine trbglw

subroutine trblim(ih, n, fmun, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: fmun(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  call check_precision(ctx, ierr, 'FMUN', fmun, n)
  if (ierr == TRIBO_OK) ierr = told(ctx, c_set_limit(ctx, fmun))
end subroutine trblim

subroutine trbnld(ih, n, fmu, fn, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: fmu(*), fn(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  call check_precision(ctx, ierr, 'FMU', fmu, n)
  if (ierr == TRIBO_OK) ierr = told(ctx, c_set_normal_load(ctx, fmu, fn))
end subroutine trbnld

subroutine trbsta(ih, n, ratio, vstr, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: ratio(*), vstr(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx
  logical :: drops

  call find(ih, ctx, ierr, n)
  if (ierr /= TRIBO_OK) return
  drops = n < 1
  if (.not. drops) drops = abs(vstr(1)) <= 0
  if (drops) then
    ierr = told(ctx, c_set_static(ctx, ratio))
  else
    ierr = told(ctx, c_set_static(ctx, ratio, vstr))
  end if
end subroutine trbsta

subroutine trbgst(ih, n, ratio, vstr, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(inout) :: ratio(*), vstr(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  if (ierr == TRIBO_OK) ierr = told_const(ctx, c_get_static(ctx, ratio, vstr))
end subroutine trbgst
subroutine trbpln(ih, npl, ifirst, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, npl, ifirst(*)
  integer, intent(out) :: ierr
  type(tribo_context) :: c

  call borrow(ih, c, ierr, name='NPL', value=npl, least=0)
  if (ierr == TRIBO_OK) call c%set_planar(ifirst(:npl), ierr)
end subroutine trbpln

subroutine trblm1(ih, fmun, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih
  real(dp), intent(in) :: fmun
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr)
  call check_precision(ctx, ierr, 'FMUN', [fmun])
  if (ierr == TRIBO_OK) ierr = told(ctx, c_set_limit_all(ctx, fmun))
end subroutine trblm1

subroutine trbglm(ih, n, fmun, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(inout) :: fmun(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  if (ierr == TRIBO_OK) ierr = told_const(ctx, c_get_limit(ctx, fmun))
end subroutine trbglm

subroutine trbeps(ih, n, eps, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: eps(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  call check_precision(ctx, ierr, 'EPS', eps, n)
  if (ierr == TRIBO_OK) ierr = told(ctx, c_set_epsilon(ctx, eps))
end subroutine trbeps

subroutine trbep1(ih, eps, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih
  real(dp), intent(in) :: eps
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr)
  call check_precision(ctx, ierr, 'EPS', [eps])
  if (ierr == TRIBO_OK) ierr = told(ctx, c_set_epsilon_all(ctx, eps))
end subroutine trbep1

subroutine trbstp(ih, dt, rldt, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih
  real(dp), intent(in) :: dt, rldt
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr)
  call check_precision(ctx, ierr, 'DT', [dt])
  call check_precision(ctx, ierr, 'RLDT', [rldt])
  if (ierr == TRIBO_OK) ierr = told(ctx, c_set_epsilon_step(ctx, dt, rldt))
end subroutine trbstp

subroutine trbgep(ih, n, eps, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(inout) :: eps(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  if (ierr == TRIBO_OK) ierr = told_const(ctx, c_get_epsilon(ctx, eps))
end subroutine trbgep

subroutine trbopd(ih, n, rdiag, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: rdiag(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  call check_precision(ctx, ierr, 'RDIAG', rdiag, n)
  if (ierr == TRIBO_OK) ierr = told(ctx, c_set_operator_diagonal(ctx, rdiag))
end subroutine trbopd

subroutine trbopf(ih, n, r, ldr, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n, ldr
  real(dp), intent(in) :: r(ldr, *)
  integer, intent(out) :: ierr
  type(tribo_context) :: c
  type(c_ptr) :: ctx

  call borrow(ih, c, ierr, n, 'LDR', ldr, n)
  if (ierr == TRIBO_OK) call find(ih, ctx, ierr)
  call check_values(ctx, ierr, 'R', r, ldr, n, n)
  if (ierr == TRIBO_OK) call c%set_operator(r(:n, :n), ierr)
end subroutine trbopf

subroutine trbops(ih, n, irow, icol, val, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n, irow(*), icol(*)
  real(dp), intent(in) :: val(*)
  integer, intent(out) :: ierr
  type(tribo_context) :: c

  call borrow(ih, c, ierr, n)
  call check_entries(ih, ierr, n, n, irow, icol, val)
  if (ierr == TRIBO_OK) call c%set_operator_csr(irow(:n + 1), icol(:max(irow(n + 1) - 1, 0)), val(:max(irow(n + 1) - 1, 0)), ierr)
end subroutine trbops

subroutine trbopm(ih, n, ndof, rminv, irow, icol, val, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n, ndof, irow(*), icol(*)
  real(dp), intent(in) :: rminv(*), val(*)
  integer, intent(out) :: ierr
  type(tribo_context) :: c

  call borrow(ih, c, ierr, n, 'NDOF', ndof, 0)
  call check_entries(ih, ierr, n, ndof, irow, icol, val)
  if (ierr /= TRIBO_OK) return
  call c%set_operator_mass(rminv(:ndof), irow(:n + 1), icol(:max(irow(n + 1) - 1, 0)), val(:max(irow(n + 1) - 1, 0)), ierr)
end subroutine trbopm

subroutine trbopc(ih, n, ndof, minv, irow, icol, val, rpar, ipar, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n, ndof, irow(*), icol(*)
  procedure(inverse_of_mass) :: minv
  real(dp), intent(in) :: val(*)
  real(dp), intent(inout), target :: rpar(*)
  integer, intent(inout), target :: ipar(*)
  integer, intent(out) :: ierr
  type(tribo_context) :: c
  type(external_mass) :: mass

  call borrow(ih, c, ierr, n, 'NDOF', ndof, 0)
  call check_entries(ih, ierr, n, ndof, irow, icol, val)
  if (ierr /= TRIBO_OK) return
  mass%minv => minv
  mass%rpar => rpar(:1)
  mass%ipar => ipar(:1)
  call c%set_operator_callback(ndof, mass, irow(:n + 1), icol(:max(irow(n + 1) - 1, 0)), val(:max(irow(n + 1) - 1, 0)), ierr)
end subroutine trbopc

subroutine trbupd(ih, nval, val, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, nval
  real(dp), intent(in) :: val(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx
  integer(c_size_t) :: count

  call find(ih, ctx, ierr)
  if (ierr == TRIBO_OK) ierr = c_get_count(ctx, int(TRIBO_COUNT_VALUES, c_int), count)
  if (ierr /= TRIBO_OK) return
  if (count > 0 .and. nval /= count) call refuse(ctx, ierr, 'NVAL', nval, ' is not ', int(count))
  call check_values(ctx, ierr, 'VAL', val, max(nval, 1), int(count))
  if (ierr == TRIBO_OK) ierr = told(ctx, c_update_operator(ctx, val))
end subroutine trbupd

subroutine trbcpl(ih, icpl, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, icpl
  integer, intent(out) :: ierr
  type(tribo_context) :: c

  call borrow(ih, c, ierr)
  if (ierr == TRIBO_OK) call c%set_coupling(icpl, ierr)
end subroutine trbcpl

subroutine trbgcp(ih, icpl, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih
  integer, intent(inout) :: icpl
  integer, intent(out) :: ierr
  type(tribo_context) :: c

  call borrow(ih, c, ierr)
  if (ierr == TRIBO_OK) call c%get_coupling(icpl, ierr)
end subroutine trbgcp

subroutine trbshr(ih, ishr, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, ishr
  integer, intent(out) :: ierr
  type(tribo_context) :: c

  call borrow(ih, c, ierr)
  if (ierr == TRIBO_OK) call c%set_sharing(ishr, ierr)
end subroutine trbshr

subroutine trbgsh(ih, ishr, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih
  integer, intent(inout) :: ishr
  integer, intent(out) :: ierr
  type(tribo_context) :: c

  call borrow(ih, c, ierr)
  if (ierr == TRIBO_OK) call c%get_sharing(ishr, ierr)
end subroutine trbgsh

! ------------------------------------------------------------------------------------------------------------------------ forces

subroutine trbfrc(ih, n, v, feq, f, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: v(*), feq(*)
  real(dp), intent(inout) :: f(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  if (ierr == TRIBO_OK) ierr = told_const(ctx, c_force(ctx, v, feq, f))
end subroutine trbfrc

subroutine trbftn(ih, n, v, feq, f, dfdv, dfdq, dfdn, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: v(*), feq(*)
  real(dp), intent(inout) :: f(*), dfdv(*), dfdq(*), dfdn(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  if (ierr == TRIBO_OK) ierr = told_const(ctx, c_force_tangent(ctx, v, feq, f, dfdv, dfdq, dfdn))
end subroutine trbftn

subroutine trbftp(ih, n, v, feq, f, dfdv, dfdq, dfdn, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: v(*), feq(*)
  real(dp), intent(inout) :: f(*), dfdv(*), dfdq(*), dfdn(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  if (ierr == TRIBO_OK) ierr = told_const(ctx, c_force_tangent_planar(ctx, v, feq, f, dfdv, dfdq, dfdn))
end subroutine trbftp

subroutine trbbal(ih, n, v, a, feq, f, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: v(*), a(*)
  real(dp), intent(inout) :: feq(*), f(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  if (ierr == TRIBO_OK) ierr = told(ctx, c_balance(ctx, v, a, feq, f))
end subroutine trbbal

subroutine trbbtn(ih, n, v, a, feq, f, dfdv, dfda, ldj, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n, ldj
  real(dp), intent(in) :: v(*), a(*)
  real(dp), intent(inout) :: feq(*), f(*), dfdv(ldj, *), dfda(ldj, *)
  integer, intent(out) :: ierr
  type(tribo_context) :: c

  call borrow(ih, c, ierr, n, 'LDJ', ldj, n)
  if (ierr == TRIBO_OK) call c%balance_tangent(v(:n), a(:n), feq(:n), f(:n), dfdv(:n, :n), dfda(:n, :n), ierr)
end subroutine trbbtn

subroutine trbtpr(ih, n, dv, da, df, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: dv(*), da(*)
  real(dp), intent(inout) :: df(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  if (ierr == TRIBO_OK) ierr = told(ctx, c_tangent_product(ctx, dv, da, df))
end subroutine trbtpr

subroutine trblpr(ih, n, dlim, df, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: dlim(*)
  real(dp), intent(inout) :: df(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  if (ierr == TRIBO_OK) ierr = told(ctx, c_limit_product(ctx, dlim, df))
end subroutine trblpr

subroutine trbstf(ih, n, dt, vfree, f, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: dt, vfree(*)
  real(dp), intent(inout) :: f(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  if (ierr == TRIBO_OK) ierr = told(ctx, c_step_force(ctx, dt, vfree, f))
end subroutine trbstf

subroutine trbstm(ih, n, dt, v, vfree, f, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: dt, v(*), vfree(*)
  real(dp), intent(inout) :: f(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  if (ierr == TRIBO_OK) ierr = told(ctx, c_step_force_mean(ctx, dt, v, vfree, f))
end subroutine trbstm

subroutine trbbox(ih, n, a, flo, fup, f, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: a(*), flo(*), fup(*)
  real(dp), intent(inout) :: f(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  if (ierr == TRIBO_OK) ierr = told(ctx, c_solve_box(ctx, a, flo, fup, f))
end subroutine trbbox

subroutine trbacc(ih, n, v, feq, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  real(dp), intent(in) :: v(*), feq(*)
  integer, intent(out) :: ierr
  type(c_ptr) :: ctx

  call find(ih, ctx, ierr, n)
  if (ierr == TRIBO_OK) ierr = told(ctx, c_accept(ctx, v, feq))
end subroutine trbacc

! ----------------------------------------------------------------------------------------------------------------------- queries

subroutine trbslp(ih, n, slip, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, n
  integer, intent(inout) :: slip(*)
  integer, intent(out) :: ierr
  type(tribo_context) :: c

  call borrow(ih, c, ierr, n)
  if (ierr == TRIBO_OK) call c%get_slip(slip(:n), ierr)
end subroutine trbslp

subroutine trbcnt(ih, iwhich, ival, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, iwhich
  integer, intent(inout) :: ival
  integer, intent(out) :: ierr
  type(tribo_context) :: c

  call borrow(ih, c, ierr)
  if (ierr == TRIBO_OK) call c%get_count(iwhich, ival, ierr)
end subroutine trbcnt

subroutine trbval(ih, iwhich, val, ierr)
  use tribo_fixed
  implicit none
  integer, intent(in) :: ih, iwhich
  real(dp), intent(inout) :: val
  integer, intent(out) :: ierr
  type(tribo_context) :: c

  call borrow(ih, c, ierr)
  if (ierr == TRIBO_OK) call c%get_real(iwhich, val, ierr)
end subroutine trbval
