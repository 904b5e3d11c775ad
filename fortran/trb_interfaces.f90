! SPDX-License-Identifier: BSD-3-Clause
! Written by trb_interfaces.awk from trb.f90 and trb_dynamics.f90, not to be changed by hand: see target fortran-refresh.

!> Interfaces of all routines TRB...: with USE TRB_INTERFACES compilers check the arguments of calls.
module trb_interfaces
  implicit none
  public

  interface
    subroutine trbver(iver, ierr)
      integer, intent(out) :: iver, ierr
    end subroutine trbver

    subroutine trbvst(text, ierr)
      character(len=*), intent(inout) :: text
      integer, intent(out) :: ierr
    end subroutine trbvst

    subroutine trbtxt(icode, text, ierr)
      integer, intent(in) :: icode
      character(len=*), intent(inout) :: text
      integer, intent(out) :: ierr
    end subroutine trbtxt

    subroutine trbnlw(nlaw, ierr)
      integer, intent(out) :: nlaw, ierr
    end subroutine trbnlw

    subroutine trblnm(law, text, ierr)
      integer, intent(in) :: law
      character(len=*), intent(inout) :: text
      integer, intent(out) :: ierr
    end subroutine trblnm

    subroutine trbref(law, text, ierr)
      integer, intent(in) :: law
      character(len=*), intent(inout) :: text
      integer, intent(out) :: ierr
    end subroutine trbref

    subroutine trbfnd(name, law, ierr)
      character(len=*), intent(in) :: name
      integer, intent(inout) :: law
      integer, intent(out) :: ierr
    end subroutine trbfnd

    subroutine trbevl(law, v, feq, fmun, eps, f, dfdv, dfdq, dfdn, ierr)
      integer, intent(in) :: law
      double precision, intent(in) :: v, feq, fmun, eps
      double precision, intent(inout) :: f, dfdv, dfdq, dfdn
      integer, intent(out) :: ierr
    end subroutine trbevl

    subroutine trbelf(n, dz, stif, fmun, f, dfdz, ierr)
      integer, intent(in) :: n
      double precision, intent(in) :: dz(*), stif(*), fmun(*)
      double precision, intent(inout) :: f(*), dfdz(*)
      integer, intent(out) :: ierr
    end subroutine trbelf

    subroutine trbelp(n, dz, stif, fmun, f, dfdz, ierr)
      integer, intent(in) :: n
      double precision, intent(in) :: dz(2, *), stif(*), fmun(*)
      double precision, intent(inout) :: f(2, *), dfdz(2, 2, *)
      integer, intent(out) :: ierr
    end subroutine trbelp

    subroutine trbctf(n, dz, depth, tang, rnorm, fmu, f, df, ierr)
      integer, intent(in) :: n
      double precision, intent(in) :: dz(2, *), depth(*), tang(*), rnorm(*), fmu(*)
      double precision, intent(inout) :: f(3, *), df(3, 3, *)
      integer, intent(out) :: ierr
    end subroutine trbctf

    subroutine trbdah(n, dz, stif, fmun, f, dfdz, ierr)
      integer, intent(in) :: n
      double precision, intent(in) :: dz(*), stif(*), fmun(*)
      double precision, intent(inout) :: f(*), dfdz(*)
      integer, intent(out) :: ierr
    end subroutine trbdah

    subroutine trblug(n, dt, dz, par, z, f, dfdz, ierr)
      integer, intent(in) :: n
      double precision, intent(in) :: dt, dz(*), par(6, *)
      double precision, intent(inout) :: z(*), f(*), dfdz(*)
      integer, intent(out) :: ierr
    end subroutine trblug

    subroutine trbbwn(n, dz, par, z, f, dfdz, ierr)
      integer, intent(in) :: n
      double precision, intent(in) :: dz(*), par(5, *)
      double precision, intent(inout) :: z(*), f(*), dfdz(*)
      integer, intent(out) :: ierr
    end subroutine trbbwn

    subroutine trbiwn(n, nroom, dz, par, state, f, dfdz, ierr)
      integer, intent(in) :: n, nroom
      double precision, intent(in) :: dz(*), par(4, *)
      double precision, intent(inout) :: state(3 + 2*max(nroom, 0), *), f(*), dfdz(*)
      integer, intent(out) :: ierr
    end subroutine trbiwn

    subroutine trbnew(n, ih, ierr)
      integer, intent(in) :: n
      integer, intent(inout) :: ih
      integer, intent(out) :: ierr
    end subroutine trbnew

    subroutine trbcpy(ih, ihnew, ierr)
      integer, intent(in) :: ih
      integer, intent(inout) :: ihnew
      integer, intent(out) :: ierr
    end subroutine trbcpy

    subroutine trbdel(ih, ierr)
      integer, intent(in) :: ih
      integer, intent(out) :: ierr
    end subroutine trbdel

    subroutine trbcps(ih, ifrom, ierr)
      integer, intent(in) :: ih, ifrom
      integer, intent(out) :: ierr
    end subroutine trbcps

    subroutine trbfix(ih, ierr)
      integer, intent(in) :: ih
      integer, intent(out) :: ierr
    end subroutine trbfix

    subroutine trbnum(ih, n, ierr)
      integer, intent(in) :: ih
      integer, intent(inout) :: n
      integer, intent(out) :: ierr
    end subroutine trbnum

    subroutine trbmsg(ih, text, ierr)
      integer, intent(in) :: ih
      character(len=*), intent(inout) :: text
      integer, intent(inout) :: ierr
    end subroutine trbmsg

    subroutine trblaw(ih, law, ierr)
      integer, intent(in) :: ih, law
      integer, intent(out) :: ierr
    end subroutine trblaw

    subroutine trbnam(ih, name, ierr)
      integer, intent(in) :: ih
      character(len=*), intent(in) :: name
      integer, intent(out) :: ierr
    end subroutine trbnam

    subroutine trbulw(ih, law, rpar, ipar, ierr)
      integer, intent(in) :: ih
      external :: law
      double precision, intent(inout), target :: rpar(*)
      integer, intent(inout), target :: ipar(*)
      integer, intent(out) :: ierr
    end subroutine trbulw

    subroutine trbglw(ih, law, ierr)
      integer, intent(in) :: ih
      integer, intent(inout) :: law
      integer, intent(out) :: ierr
    end subroutine trbglw

    subroutine trblim(ih, n, fmun, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: fmun(*)
      integer, intent(out) :: ierr
    end subroutine trblim

    subroutine trbnld(ih, n, fmu, fn, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: fmu(*), fn(*)
      integer, intent(out) :: ierr
    end subroutine trbnld

    subroutine trbsta(ih, n, ratio, vstr, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: ratio(*), vstr(*)
      integer, intent(out) :: ierr
    end subroutine trbsta

    subroutine trbgst(ih, n, ratio, vstr, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(inout) :: ratio(*), vstr(*)
      integer, intent(out) :: ierr
    end subroutine trbgst

    subroutine trbpln(ih, npl, ifirst, ierr)
      integer, intent(in) :: ih, npl, ifirst(*)
      integer, intent(out) :: ierr
    end subroutine trbpln

    subroutine trblm1(ih, fmun, ierr)
      integer, intent(in) :: ih
      double precision, intent(in) :: fmun
      integer, intent(out) :: ierr
    end subroutine trblm1

    subroutine trbglm(ih, n, fmun, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(inout) :: fmun(*)
      integer, intent(out) :: ierr
    end subroutine trbglm

    subroutine trbeps(ih, n, eps, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: eps(*)
      integer, intent(out) :: ierr
    end subroutine trbeps

    subroutine trbep1(ih, eps, ierr)
      integer, intent(in) :: ih
      double precision, intent(in) :: eps
      integer, intent(out) :: ierr
    end subroutine trbep1

    subroutine trbstp(ih, dt, rldt, ierr)
      integer, intent(in) :: ih
      double precision, intent(in) :: dt, rldt
      integer, intent(out) :: ierr
    end subroutine trbstp

    subroutine trbgep(ih, n, eps, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(inout) :: eps(*)
      integer, intent(out) :: ierr
    end subroutine trbgep

    subroutine trbopd(ih, n, rdiag, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: rdiag(*)
      integer, intent(out) :: ierr
    end subroutine trbopd

    subroutine trbopf(ih, n, r, ldr, ierr)
      integer, intent(in) :: ih, n, ldr
      double precision, intent(in) :: r(ldr, *)
      integer, intent(out) :: ierr
    end subroutine trbopf

    subroutine trbops(ih, n, irow, icol, val, ierr)
      integer, intent(in) :: ih, n, irow(*), icol(*)
      double precision, intent(in) :: val(*)
      integer, intent(out) :: ierr
    end subroutine trbops

    subroutine trbopm(ih, n, ndof, rminv, irow, icol, val, ierr)
      integer, intent(in) :: ih, n, ndof, irow(*), icol(*)
      double precision, intent(in) :: rminv(*), val(*)
      integer, intent(out) :: ierr
    end subroutine trbopm

    subroutine trbopc(ih, n, ndof, minv, irow, icol, val, rpar, ipar, ierr)
      integer, intent(in) :: ih, n, ndof, irow(*), icol(*)
      external :: minv
      double precision, intent(in) :: val(*)
      double precision, intent(inout), target :: rpar(*)
      integer, intent(inout), target :: ipar(*)
      integer, intent(out) :: ierr
    end subroutine trbopc

    subroutine trbupd(ih, nval, val, ierr)
      integer, intent(in) :: ih, nval
      double precision, intent(in) :: val(*)
      integer, intent(out) :: ierr
    end subroutine trbupd

    subroutine trbcpl(ih, icpl, ierr)
      integer, intent(in) :: ih, icpl
      integer, intent(out) :: ierr
    end subroutine trbcpl

    subroutine trbgcp(ih, icpl, ierr)
      integer, intent(in) :: ih
      integer, intent(inout) :: icpl
      integer, intent(out) :: ierr
    end subroutine trbgcp

    subroutine trbshr(ih, ishr, ierr)
      integer, intent(in) :: ih, ishr
      integer, intent(out) :: ierr
    end subroutine trbshr

    subroutine trbgsh(ih, ishr, ierr)
      integer, intent(in) :: ih
      integer, intent(inout) :: ishr
      integer, intent(out) :: ierr
    end subroutine trbgsh

    subroutine trbfrc(ih, n, v, feq, f, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: v(*), feq(*)
      double precision, intent(inout) :: f(*)
      integer, intent(out) :: ierr
    end subroutine trbfrc

    subroutine trbftn(ih, n, v, feq, f, dfdv, dfdq, dfdn, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: v(*), feq(*)
      double precision, intent(inout) :: f(*), dfdv(*), dfdq(*), dfdn(*)
      integer, intent(out) :: ierr
    end subroutine trbftn

    subroutine trbftp(ih, n, v, feq, f, dfdv, dfdq, dfdn, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: v(*), feq(*)
      double precision, intent(inout) :: f(*), dfdv(*), dfdq(*), dfdn(*)
      integer, intent(out) :: ierr
    end subroutine trbftp

    subroutine trbbal(ih, n, v, a, feq, f, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: v(*), a(*)
      double precision, intent(inout) :: feq(*), f(*)
      integer, intent(out) :: ierr
    end subroutine trbbal

    subroutine trbbtn(ih, n, v, a, feq, f, dfdv, dfda, ldj, ierr)
      integer, intent(in) :: ih, n, ldj
      double precision, intent(in) :: v(*), a(*)
      double precision, intent(inout) :: feq(*), f(*), dfdv(ldj, *), dfda(ldj, *)
      integer, intent(out) :: ierr
    end subroutine trbbtn

    subroutine trbtpr(ih, n, dv, da, df, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: dv(*), da(*)
      double precision, intent(inout) :: df(*)
      integer, intent(out) :: ierr
    end subroutine trbtpr

    subroutine trblpr(ih, n, dlim, df, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: dlim(*)
      double precision, intent(inout) :: df(*)
      integer, intent(out) :: ierr
    end subroutine trblpr

    subroutine trbstf(ih, n, dt, vfree, f, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: dt, vfree(*)
      double precision, intent(inout) :: f(*)
      integer, intent(out) :: ierr
    end subroutine trbstf

    subroutine trbstm(ih, n, dt, v, vfree, f, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: dt, v(*), vfree(*)
      double precision, intent(inout) :: f(*)
      integer, intent(out) :: ierr
    end subroutine trbstm

    subroutine trbbox(ih, n, a, flo, fup, f, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: a(*), flo(*), fup(*)
      double precision, intent(inout) :: f(*)
      integer, intent(out) :: ierr
    end subroutine trbbox

    subroutine trbacc(ih, n, v, feq, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: v(*), feq(*)
      integer, intent(out) :: ierr
    end subroutine trbacc

    subroutine trbslp(ih, n, slip, ierr)
      integer, intent(in) :: ih, n
      integer, intent(inout) :: slip(*)
      integer, intent(out) :: ierr
    end subroutine trbslp

    subroutine trbcnt(ih, iwhich, ival, ierr)
      integer, intent(in) :: ih, iwhich
      integer, intent(inout) :: ival
      integer, intent(out) :: ierr
    end subroutine trbcnt

    subroutine trbval(ih, iwhich, val, ierr)
      integer, intent(in) :: ih, iwhich
      double precision, intent(inout) :: val
      integer, intent(out) :: ierr
    end subroutine trbval

    subroutine trblin(ndof, n, rm, c, rk, ldm, rj, ldj, ih, text, ierr)
      integer, intent(in) :: ndof, n, ldm, ldj
      double precision, intent(in) :: rm(ldm, *), c(ldm, *), rk(ldm, *), rj(ldj, *)
      integer, intent(inout) :: ih
      character(len=*), intent(inout) :: text
      integer, intent(out) :: ierr
    end subroutine trblin

    subroutine trblsp(ndof, n, irm, icm, rm, irc, icc, c, irk, ick, rk, irj, icj, rj, ih, text, ierr)
      integer, intent(in) :: ndof, n, irm(*), icm(*), irc(*), icc(*), irk(*), ick(*), irj(*), icj(*)
      double precision, intent(in) :: rm(*), c(*), rk(*), rj(*)
      integer, intent(inout) :: ih
      character(len=*), intent(inout) :: text
      integer, intent(out) :: ierr
    end subroutine trblsp

    subroutine trbmod(nfull, n, irm, icm, rm, irc, icc, c, irk, ick, rk, irj, icj, rj, cmp, nmode, istat, ih, text, ierr)
      integer, intent(in) :: nfull, n, irm(*), icm(*), irc(*), icc(*), irk(*), ick(*), irj(*), icj(*), nmode, istat
      double precision, intent(in) :: rm(*), c(*), rk(*), rj(*), cmp(*)
      integer, intent(inout) :: ih
      character(len=*), intent(inout) :: text
      integer, intent(out) :: ierr
    end subroutine trbmod

    subroutine trbnml(nfull, n, irm, icm, rm, irc, icc, c, irk, ick, rk, irj, icj, rj, cmp, nrm, rn, nmode, istat, ih, text, ierr)
      integer, intent(in) :: nfull, n, irm(*), icm(*), irc(*), icc(*), irk(*), ick(*), irj(*), icj(*), nrm(*), nmode, istat
      double precision, intent(in) :: rm(*), c(*), rk(*), rj(*), cmp(*), rn(3, *)
      integer, intent(inout) :: ih
      character(len=*), intent(inout) :: text
      integer, intent(out) :: ierr
    end subroutine trbnml

    subroutine trbred(nfull, n, irm, icm, rm, irk, ick, rk, irj, icj, rj, nmode, istat, ih, text, ierr)
      integer, intent(in) :: nfull, n, irm(*), icm(*), irk(*), ick(*), irj(*), icj(*), nmode, istat
      double precision, intent(in) :: rm(*), rk(*), rj(*)
      integer, intent(inout) :: ih
      character(len=*), intent(inout) :: text
      integer, intent(out) :: ierr
    end subroutine trbred

    subroutine trbcln(ih, ihnew, ierr)
      integer, intent(in) :: ih
      integer, intent(inout) :: ihnew
      integer, intent(out) :: ierr
    end subroutine trbcln

    subroutine trbndf(ih, ndof, ierr)
      integer, intent(in) :: ih
      integer, intent(inout) :: ndof
      integer, intent(out) :: ierr
    end subroutine trbndf

    subroutine trblod(ih, nfull, omega, pc, ps, ierr)
      integer, intent(in) :: ih, nfull
      double precision, intent(in) :: omega, pc(*), ps(*)
      integer, intent(out) :: ierr
    end subroutine trblod

    subroutine trbltb(ih, nfull, knots, time, val, pat, ierr)
      integer, intent(in) :: ih, nfull, knots
      double precision, intent(in) :: time(*), val(*), pat(*)
      integer, intent(out) :: ierr
    end subroutine trbltb

    subroutine trbbtb(ih, n, knots, time, val, pat, ierr)
      integer, intent(in) :: ih, n, knots
      double precision, intent(in) :: time(*), val(*), pat(*)
      integer, intent(out) :: ierr
    end subroutine trbbtb

    subroutine trbcll(ih, ierr)
      integer, intent(in) :: ih
      integer, intent(out) :: ierr
    end subroutine trbcll

    subroutine trbbas(ih, n, omega, bc, bs, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: omega, bc(*), bs(*)
      integer, intent(out) :: ierr
    end subroutine trbbas

    subroutine trbhlm(ih, n, omega, fc, fs, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: omega, fc(*), fs(*)
      integer, intent(out) :: ierr
    end subroutine trbhlm

    subroutine trblmt(ih, n, knots, time, fmun, ierr)
      integer, intent(in) :: ih, n, knots
      double precision, intent(in) :: time(*), fmun(n, *)
      integer, intent(out) :: ierr
    end subroutine trblmt

    subroutine trblmc(ih, ierr)
      integer, intent(in) :: ih
      integer, intent(out) :: ierr
    end subroutine trblmc

    subroutine trbbsc(ih, ierr)
      integer, intent(in) :: ih
      integer, intent(out) :: ierr
    end subroutine trbbsc

    subroutine trbslm(ih, n, t, fmun, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(in) :: t
      double precision, intent(inout) :: fmun(*)
      integer, intent(out) :: ierr
    end subroutine trbslm

    subroutine trbssl(ih, n, slip, ierr)
      integer, intent(in) :: ih, n
      integer, intent(inout) :: slip(*)
      integer, intent(out) :: ierr
    end subroutine trbssl

    subroutine trbscn(ih, which, value, ierr)
      integer, intent(in) :: ih, which
      integer, intent(inout) :: value
      integer, intent(out) :: ierr
    end subroutine trbscn

    subroutine trbcon(ih, ndof, n, t, y, v, feq, f, ierr)
      integer, intent(in) :: ih, ndof, n
      double precision, intent(in) :: t, y(*)
      double precision, intent(inout) :: v(*), feq(*), f(*)
      integer, intent(out) :: ierr
    end subroutine trbcon

    subroutine trbequ(ih, ndof, n, given, y, slip, nexp, re, ai, ierr)
      integer, intent(in) :: ih, ndof, n, given(*)
      integer, intent(inout) :: slip(*), nexp
      double precision, intent(inout) :: y(*), re(*), ai(*)
      integer, intent(out) :: ierr
    end subroutine trbequ

    subroutine trbflt(ih, ndof, n, ipar, given, y, from, to, crit, omega, ierr)
      integer, intent(in) :: ih, ndof, n, ipar, given(*)
      double precision, intent(in) :: y(*), from, to
      double precision, intent(inout) :: crit, omega
      integer, intent(out) :: ierr
    end subroutine trbflt

    subroutine trbzet(ih, zeta, ierr)
      integer, intent(in) :: ih
      double precision, intent(in) :: zeta
      integer, intent(out) :: ierr
    end subroutine trbzet

    subroutine trbfrq(ih, ndof, w, ierr)
      integer, intent(in) :: ih, ndof
      double precision, intent(inout) :: w(*)
      integer, intent(out) :: ierr
    end subroutine trbfrq

    subroutine trbexp(ih, ndof, nfull, q, u, ierr)
      integer, intent(in) :: ih, ndof, nfull
      double precision, intent(in) :: q(*)
      double precision, intent(inout) :: u(*)
      integer, intent(out) :: ierr
    end subroutine trbexp

    subroutine trbtrc(ih, omega, err, ierr)
      integer, intent(in) :: ih
      double precision, intent(in) :: omega
      double precision, intent(inout) :: err
      integer, intent(out) :: ierr
    end subroutine trbtrc

    subroutine trbder(ih, ndof, t, y, dydt, ierr)
      integer, intent(in) :: ih, ndof
      double precision, intent(in) :: t, y(*)
      double precision, intent(inout) :: dydt(*)
      integer, intent(out) :: ierr
    end subroutine trbder

    subroutine trbjac(ih, ndof, t, y, dfdy, ldj, dfdt, ierr)
      integer, intent(in) :: ih, ndof, ldj
      double precision, intent(in) :: t, y(*)
      double precision, intent(inout) :: dfdy(ldj, *), dfdt(*)
      integer, intent(out) :: ierr
    end subroutine trbjac

    subroutine trbsac(ih, ndof, t, y, ierr)
      integer, intent(in) :: ih, ndof
      double precision, intent(in) :: t, y(*)
      integer, intent(out) :: ierr
    end subroutine trbsac

    subroutine trbnmt(nmeth, ierr)
      integer, intent(out) :: nmeth, ierr
    end subroutine trbnmt

    subroutine trbhas(ifeat, ihas, ierr)
      integer, intent(in) :: ifeat
      integer, intent(out) :: ihas, ierr
    end subroutine trbhas

    subroutine trbmnm(meth, text, ierr)
      integer, intent(in) :: meth
      character(len=*), intent(inout) :: text
      integer, intent(out) :: ierr
    end subroutine trbmnm

    subroutine trbdrv(ih, name, dt, atol, rtol, ierr)
      integer, intent(in) :: ih
      character(len=*), intent(in) :: name
      double precision, intent(in) :: dt, atol, rtol
      integer, intent(out) :: ierr
    end subroutine trbdrv

    subroutine trbhst(ih, dt, ierr)
      integer, intent(in) :: ih
      double precision, intent(in) :: dt
      integer, intent(out) :: ierr
    end subroutine trbhst

    subroutine trbtol(ih, atol, rtol, ierr)
      integer, intent(in) :: ih
      double precision, intent(in) :: atol, rtol
      integer, intent(out) :: ierr
    end subroutine trbtol

    subroutine trbout(ih, dt, ierr)
      integer, intent(in) :: ih
      double precision, intent(in) :: dt
      integer, intent(out) :: ierr
    end subroutine trbout

    subroutine trbmth(ih, text, ierr)
      integer, intent(in) :: ih
      character(len=*), intent(inout) :: text
      integer, intent(out) :: ierr
    end subroutine trbmth

    subroutine trbhmx(ih, h, ierr)
      integer, intent(in) :: ih
      double precision, intent(in) :: h
      integer, intent(out) :: ierr
    end subroutine trbhmx

    subroutine trbobs(ih, seen, rpar, ipar, ierr)
      integer, intent(in) :: ih
      external :: seen
      double precision, intent(inout), target :: rpar(*)
      integer, intent(inout), target :: ipar(*)
      integer, intent(out) :: ierr
    end subroutine trbobs

    subroutine trbadv(ih, ndof, t, t1, y, ierr)
      integer, intent(in) :: ih, ndof
      double precision, intent(inout) :: t, y(*)
      double precision, intent(in) :: t1
      integer, intent(out) :: ierr
    end subroutine trbadv

    subroutine trbper(ih, ndof, t, period, y, ierr)
      integer, intent(in) :: ih, ndof
      double precision, intent(in) :: t, period
      double precision, intent(inout) :: y(*)
      integer, intent(out) :: ierr
    end subroutine trbper

    subroutine trbrng(ih, nsect, iorder, ierr)
      integer, intent(in) :: ih, nsect, iorder
      integer, intent(out) :: ierr
    end subroutine trbrng

    subroutine trbcyc(ih, ndof, t, period, y, ierr)
      integer, intent(in) :: ih, ndof
      double precision, intent(in) :: t
      double precision, intent(inout) :: period, y(*)
      integer, intent(out) :: ierr
    end subroutine trbcyc

    subroutine trbnlm(ih, ndof, cv, ampl, omega, zeta, y, ierr)
      integer, intent(in) :: ih, ndof
      double precision, intent(in) :: cv(*), ampl
      double precision, intent(inout) :: omega, zeta, y(*)
      integer, intent(out) :: ierr
    end subroutine trbnlm

    subroutine trbcrv(ih, ndof, iopt, ropt, cv, t, period, y, seen, rpar, ipar, ierr)
      integer, intent(in) :: ih, ndof, iopt(5)
      double precision, intent(in) :: ropt(4), cv(*), t
      double precision, intent(inout) :: period, y(*)
      external :: seen
      double precision, intent(inout), target :: rpar(*)
      integer, intent(inout), target :: ipar(*)
      integer, intent(out) :: ierr
    end subroutine trbcrv

    subroutine trbdct(ih, iwhich, ival, ierr)
      integer, intent(in) :: ih, iwhich
      integer, intent(inout) :: ival
      integer, intent(out) :: ierr
    end subroutine trbdct

    subroutine trbdvl(ih, iwhich, val, ierr)
      integer, intent(in) :: ih, iwhich
      double precision, intent(inout) :: val
      integer, intent(out) :: ierr
    end subroutine trbdvl

    subroutine trbmul(ih, ndof, re, ai, ierr)
      integer, intent(in) :: ih, ndof
      double precision, intent(inout) :: re(*), ai(*)
      integer, intent(out) :: ierr
    end subroutine trbmul

    subroutine trbfam(ih, nfree, ierr)
      integer, intent(in) :: ih
      integer, intent(inout) :: nfree
      integer, intent(out) :: ierr
    end subroutine trbfam

    subroutine trbext(ih, ndof, cv, xmin, xmax, tmin, tmax, ierr)
      integer, intent(in) :: ih, ndof
      double precision, intent(in) :: cv(*)
      double precision, intent(inout) :: xmin, xmax, tmin, tmax
      integer, intent(out) :: ierr
    end subroutine trbext

    subroutine trbhar(ih, ndof, cv, k, xc, xs, ierr)
      integer, intent(in) :: ih, ndof, k
      double precision, intent(in) :: cv(*)
      double precision, intent(inout) :: xc, xs
      integer, intent(out) :: ierr
    end subroutine trbhar

    subroutine trbdis(ih, n, e, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(inout) :: e(*)
      integer, intent(out) :: ierr
    end subroutine trbdis

    subroutine trbshs(ih, n, share, ierr)
      integer, intent(in) :: ih, n
      double precision, intent(inout) :: share(*)
      integer, intent(out) :: ierr
    end subroutine trbshs

    subroutine trbdex(ih, ndof, np, kind, indx, cv, dx, ierr)
      integer, intent(in) :: ih, ndof, np, kind(*), indx(*)
      double precision, intent(in) :: cv(*)
      double precision, intent(inout) :: dx(2, *)
      integer, intent(out) :: ierr
    end subroutine trbdex

    subroutine trbden(ih, n, np, kind, indx, de, ierr)
      integer, intent(in) :: ih, n, np, kind(*), indx(*)
      double precision, intent(inout) :: de(n, *)
      integer, intent(out) :: ierr
    end subroutine trbden

    subroutine trbdey(ih, ndof, np, kind, indx, dy, ldy, ierr)
      integer, intent(in) :: ih, ndof, np, kind(*), indx(*), ldy
      double precision, intent(inout) :: dy(ldy, *)
      integer, intent(out) :: ierr
    end subroutine trbdey

    subroutine trbdml(ih, ndof, k, np, kind, indx, dr, di, ierr)
      integer, intent(in) :: ih, ndof, k, np, kind(*), indx(*)
      double precision, intent(inout) :: dr(*), di(*)
      integer, intent(out) :: ierr
    end subroutine trbdml
  end interface
end module trb_interfaces
