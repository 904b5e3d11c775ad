C SPDX-License-Identifier: BSD-3-Clause
C     Sparse, reduced and copied structures from fixed form, and what
C     serves their integration: every result compared to that of the C
C     call (legacy_structures.c), then the errors.
      PROGRAM LEGSTR
      INTEGER NALIVE
      EXTERNAL NALIVE
      CALL STPLAY
      CALL METHOD
      CALL REDUCE
      CALL SPARSE(.FALSE.)
      CALL SPARSE(.TRUE.)
      CALL SCEND
      CALL ELASTC
      CALL NORMAL
      CALL BELT
      CALL FLUTTR
      CALL CREATE
      CALL NODRIV
      CALL WRONG
      CALL EXPECT('all deleted', NALIVE() .EQ. 0)
      CALL REPORT_ALL
      END
C
C     Six masses in a row between two walls, contacts on the second and
C     the fifth.
      SUBROUTINE ROWS(IRM, ICM, RM, IRK, ICK, RK, IRJ, ICJ, RJ)
      INTEGER IRM(7), ICM(6), IRK(7), ICK(16), IRJ(3), ICJ(2), I, J, K
      DOUBLE PRECISION RM(6), RK(16), RJ(2)
      K = 1
      DO 20 I = 1, 6
         IRM(I) = I
         ICM(I) = I
         RM(I) = 1D0 + 0.1D0*I
         IRK(I) = K
         DO 10 J = MAX(I - 1, 1), MIN(I + 1, 6)
            ICK(K) = J
            RK(K) = -1D0
            IF (I .EQ. J) RK(K) = 2D0
            K = K + 1
   10    CONTINUE
   20 CONTINUE
      IRM(7) = 7
      IRK(7) = K
      DO 30 I = 1, 2
         IRJ(I) = I
         ICJ(I) = 3*I - 1
         RJ(I) = 1D0
   30 CONTINUE
      IRJ(3) = 3
      END
C
      SUBROUTINE MKRED(NMODE, ISTAT, IH, TEXT, IERR)
      INTEGER NMODE, ISTAT, IH, IERR
      CHARACTER*(*) TEXT
      INTEGER IRM(7), ICM(6), IRK(7), ICK(16), IRJ(3), ICJ(2)
      DOUBLE PRECISION RM(6), RK(16), RJ(2)
      CALL ROWS(IRM, ICM, RM, IRK, ICK, RK, IRJ, ICJ, RJ)
      CALL TRBRED(6, 2, IRM, ICM, RM, IRK, ICK, RK, IRJ, ICJ, RJ,
     1            NMODE, ISTAT, IH, TEXT, IERR)
      END
C
C     Damping is a tenth of the stiffness, or none.
      SUBROUTINE MKSPRS(DAMPED, IH, TEXT, IERR)
      LOGICAL DAMPED
      INTEGER IH, IERR, K
      CHARACTER*(*) TEXT
      INTEGER IRM(7), ICM(6), IRC(7), IRK(7), ICK(16), IRJ(3), ICJ(2)
      DOUBLE PRECISION RM(6), C(16), RK(16), RJ(2)
      CALL ROWS(IRM, ICM, RM, IRK, ICK, RK, IRJ, ICJ, RJ)
      DO 10 K = 1, 7
         IRC(K) = 1
         IF (DAMPED) IRC(K) = IRK(K)
   10 CONTINUE
      DO 20 K = 1, 16
         C(K) = 0.1D0*RK(K)
   20 CONTINUE
      CALL TRBLSP(6, 2, IRM, ICM, RM, IRC, ICK, C, IRK, ICK, RK,
     1            IRJ, ICJ, RJ, IH, TEXT, IERR)
      END
C
      SUBROUTINE METHOD
      INTEGER N, K, IERR
      CHARACTER*20 TEXT
      CALL TRBHAS(0, N, IERR)
      CALL CMPI('TRBHAS', N)
      CALL TRBHAS(1, N, IERR)
      CALL CMPI('TRBHAS', N)
      CALL TRBNMT(N, IERR)
      CALL CMPI('TRBNMT', N)
      DO 10 K = 0, N - 1
         CALL TRBMNM(K, TEXT, IERR)
         CALL CMPT('TRBMNM', TEXT)
   10 CONTINUE
      TEXT = 'as it was'
      CALL TRBMNM(N, TEXT, IERR)
      CALL EXPECT('TRBMNM', IERR .NE. 0 .AND. TEXT .EQ. 'as it was')
      END
C
C     A reduced structure, and its copy in its place.
      SUBROUTINE REDUCE
      INTEGER IH, IH2, IERR, NDOF
      DOUBLE PRECISION PC(6), PS(6), W(4), U(6), ERR(1), Y(9), T(1)
      CHARACTER*80 TEXT
      DATA PC /1D0, 0D0, 0D0, 0D0, 0D0, 0D0/, PS /6*0D0/, Y /9*0D0/
      TEXT = 'as it was'
      CALL MKRED(2, 1, IH, TEXT, IERR)
      CALL EXPECT('TRBRED', IERR .EQ. 0 .AND. TEXT .EQ. 'as it was')
      CALL TRBNDF(IH, NDOF, IERR)
      CALL CMPI('TRBNDF', NDOF)
      CALL TRBFRQ(IH, NDOF, W, IERR)
      CALL CMPR('TRBFRQ', 4, W)
      CALL TRBEXP(IH, NDOF, 6, W, U, IERR)
      CALL CMPR('TRBEXP', 6, U)
      CALL TRBTRC(IH, 0.5D0, ERR(1), IERR)
      CALL CMPR('TRBTRC', 1, ERR)
      CALL TRBZET(IH, 0.05D0, IERR)
      CALL CMPI('TRBZET', IERR)
      CALL TRBLOD(IH, 6, 0.5D0, PC, PS, IERR)
      CALL CMPI('TRBLOD', IERR)
      CALL TRBLM1(IH, 0.2D0, IERR)
      CALL TRBCLN(IH, IH2, IERR)
      CALL EXPECT('TRBCLN', IERR .EQ. 0 .AND. IH2 .NE. IH)
      CALL TRBDEL(IH, IERR)
      CALL TRBDRV(IH2, 'auto', 0.1D0, 1D-9, 1D-9, IERR)
      T(1) = 0D0
      CALL TRBADV(IH2, NDOF, T(1), 20D0, Y, IERR)
      CALL CMPI('TRBADV', IERR)
      CALL CMPR('TRBADV', 9, Y)
      CALL TRBMTH(IH2, TEXT, IERR)
      CALL CMPT('TRBMTH', TEXT)
      CALL TRBDVL(IH2, 101, ERR(1), IERR)
      CALL CMPR('TRBDVL', 1, ERR)
      CALL TRBDEL(IH2, IERR)
C     Modes alone
      CALL MKRED(2, 0, IH, TEXT, IERR)
      CALL TRBNDF(IH, NDOF, IERR)
      CALL CMPI('TRBNDF', NDOF)
      CALL TRBDEL(IH, IERR)
      END
C
C     The whole structure under a table of loads, its limits in another.
      SUBROUTINE SPARSE(DAMPED)
      LOGICAL DAMPED
      INTEGER IH, IERR, ISEEN(2)
      DOUBLE PRECISION TIME(3), VAL(3), PAT(6), FMUN(2,2), Y(13), T(1)
      DOUBLE PRECISION SUM(1)
      CHARACTER*80 TEXT
      EXTERNAL WATCH
      DATA TIME /0D0, 1D0, 3D0/, VAL /0D0, 2D0, -1D0/
      DATA PAT /1D0, 0D0, 0D0, -0.5D0, 0D0, 0D0/
      DATA FMUN /0.1D0, 0.2D0, 0.3D0, 0.1D0/
      TEXT = 'as it was'
      CALL MKSPRS(DAMPED, IH, TEXT, IERR)
      CALL EXPECT('TRBLSP', IERR .EQ. 0 .AND. TEXT .EQ. 'as it was')
      CALL TRBLTB(IH, 6, 3, TIME, VAL, PAT, IERR)
      CALL CMPI('TRBLTB', IERR)
      CALL TRBBTB(IH, 2, 3, TIME, VAL, FMUN, IERR)
      CALL CMPI('TRBBTB', IERR)
      CALL TRBLMT(IH, 2, 2, TIME, FMUN, IERR)
      CALL CMPI('TRBLMT', IERR)
      CALL START(Y)
      CALL LOOK(IH, Y)
C     A stepper of GSL where there is one
      CALL TRBDRV(IH, 'rkf45', 0D0, 0D0, 0D0, IERR)
      IF (IERR .NE. 0) CALL TRBDRV(IH, 'rk4/fixed', 0D0, 0D0, 0D0, IERR)
      CALL TRBHST(IH, 0.1D0, IERR)
      CALL CMPI('TRBHST', IERR)
      CALL TRBTOL(IH, 1D-6, 1D-6, IERR)
      CALL CMPI('TRBTOL', IERR)
      CALL TRBOUT(IH, 0.1D0, IERR)
      CALL CMPI('TRBOUT', IERR)
      CALL TRBHMX(IH, 0.05D0, IERR)
      CALL CMPI('TRBHMX', IERR)
      ISEEN(1) = 0
      ISEEN(2) = 40
      SUM(1) = 0D0
      CALL TRBOBS(IH, WATCH, SUM, ISEEN, IERR)
      CALL CMPI('TRBOBS', IERR)
      T(1) = 0D0
      CALL TRBADV(IH, 6, T(1), 5D0, Y, IERR)
      CALL CMPI('TRBADV', IERR)
      CALL CMPR('TRBADV', 1, T)
      CALL CMPR('TRBADV', 13, Y)
      CALL CMPI('SEEN', ISEEN(1))
      CALL CMPR('SEEN', 1, SUM)
      CALL TRBSLM(IH, 2, 1.5D0, FMUN(1,1), IERR)
      CALL CMPI('TRBSLM', IERR)
      CALL CMPR('TRBSLM', 2, FMUN(1,1))
      CALL TRBSSL(IH, 2, ISEEN, IERR)
      CALL CMPI('TRBSSL', IERR)
      CALL CMPI('TRBSSL', ISEEN(1))
      CALL CMPI('TRBSSL', ISEEN(2))
      CALL TRBSCN(IH, 0, ISEEN(1), IERR)
      CALL CMPI('TRBSCN', IERR)
      CALL CMPI('TRBSCN', ISEEN(1))
      CALL TRBBSC(IH, IERR)
      CALL CMPI('TRBBSC', IERR)
      CALL TRBLMC(IH, IERR)
      CALL CMPI('TRBLMC', IERR)
      CALL TRBGLM(IH, 2, FMUN(1,1), IERR)
      CALL CMPR('TRBGLM', 2, FMUN(1,1))
      FMUN(1,1) = 0.1D0
      FMUN(2,1) = 0.2D0
      CALL TRBDEL(IH, IERR)
      END
C
      SUBROUTINE START(Y)
      INTEGER I
      DOUBLE PRECISION Y(13)
      DO 10 I = 1, 6
         Y(I) = 0.1D0*I
         Y(I+6) = 0.3D0 - 0.1D0*I
   10 CONTINUE
      Y(13) = 0D0
      END
C
C     What the contacts do in a state, and what integrators ask for.
      SUBROUTINE LOOK(IH, Y)
      INTEGER IH, IERR, J
      DOUBLE PRECISION Y(13), V(2), FEQ(2), F(2)
      DOUBLE PRECISION DYDT(13), DFDY(15,13), DFDT(13)
      CALL TRBCON(IH, 6, 2, 0.5D0, Y, V, FEQ, F, IERR)
      CALL CMPI('TRBCON', IERR)
      CALL CMPR('TRBCON', 2, V)
      CALL CMPR('TRBCON', 2, FEQ)
      CALL CMPR('TRBCON', 2, F)
      CALL TRBDER(IH, 6, 0.5D0, Y, DYDT, IERR)
      CALL CMPI('TRBDER', IERR)
      CALL CMPR('TRBDER', 13, DYDT)
      CALL TRBJAC(IH, 6, 0.5D0, Y, DFDY, 15, DFDT, IERR)
      CALL CMPI('TRBJAC', IERR)
      DO 10 J = 1, 13
         CALL CMPR('TRBJAC', 13, DFDY(1,J))
   10 CONTINUE
      CALL CMPR('TRBJAC', 13, DFDT)
      CALL TRBSAC(IH, 6, 0.5D0, Y, IERR)
      CALL CMPI('TRBSAC', IERR)
      END
C
C     Counts the steps, sums their times, and ends the run at the last.
      SUBROUTINE WATCH(T, NY, Y, KIND, ICON, RPAR, IPAR, ISTOP)
      INTEGER NY, KIND, ICON, IPAR(*), ISTOP
      DOUBLE PRECISION T, Y(*), RPAR(*)
      IPAR(1) = IPAR(1) + 1 + KIND + ICON
      RPAR(1) = RPAR(1) + T*Y(NY)
      IF (IPAR(1) .EQ. IPAR(2)) ISTOP = 1
      END
C
C     Points of a curve: the last special one; stops at the first one if
C     IPAR(2) is 1.
      SUBROUTINE POINT(PT, NY, Y, KIND, ICON, ISTAB, RPAR, IPAR, ISTOP)
      INTEGER NY, KIND, ICON, ISTAB, IPAR(*), ISTOP
      DOUBLE PRECISION PT(4), Y(*), RPAR(*)
      IF (KIND .NE. 0) THEN
         IPAR(1) = 10*KIND + ICON
         RPAR(1) = PT(1)
      END IF
      IF (ISTAB .NE. -1 .OR. NY .NE. 4 .OR. Y(NY) .NE. 0D0) ISTOP = 9
      IF (IPAR(2) .EQ. 1) ISTOP = 1
      END
C
C     x'' + 0.1 x' + x + f = cos 1.1 t, f of a slider of limit 0.5 on a
C     spring of 1: the amplitude is 3.38660810; also of the only mode.
      SUBROUTINE ELASTC
      INTEGER IH, IERR, IRM(2), ICM(1), K, NDOF
      DOUBLE PRECISION ONE(1), C(1), CMP(1), ZERO(1), HALF(1), Y(4)
      DOUBLE PRECISION CV(2), XMIN, XMAX, TMIN, TMAX, RE(4), AI(4)
      DOUBLE PRECISION OMEGA, ZETA, PERIOD, SUM(1), ROPT(4)
      INTEGER IOPT(5), ISEEN(2)
      EXTERNAL POINT
      CHARACTER*80 TEXT
      INTEGER IGIVEN(1), ISLIP(1), NEXP
      DATA IOPT /2, 5, 1, 0, 0/, ROPT /0.1D0, 1D0, 0.1D0, 0.3D0/
      DATA IGIVEN /0/
      DATA IRM /1, 2/, ICM /1/, ONE /1D0/, C /0.1D0/, CMP /1D0/
      DATA ZERO /0D0/, HALF /0.5D0/, CV /1D0, 0D0/
      DO 10 K = 0, 1
         CALL TRBMOD(1, 1, IRM, ICM, ONE, IRM, ICM, C, IRM, ICM, ONE,
     1               IRM, ICM, ONE, CMP, K, 0, IH, TEXT, IERR)
         CALL EXPECT('TRBMOD', IERR .EQ. 0)
         CALL TRBNDF(IH, NDOF, IERR)
         CALL EXPECT('one degree of freedom', NDOF .EQ. 1)
         CALL TRBLIM(IH, 1, HALF, IERR)
         CALL TRBLOD(IH, 1, 1.1D0, ONE, ZERO, IERR)
         CALL TRBDRV(IH, 'exact', 0D0, 0D0, 0D0, IERR)
         Y(1) = 0D0
         Y(2) = 0D0
         Y(3) = 0D0
         Y(4) = 0D0
         RE(4) = -7D0
         CALL TRBPER(IH, 1, 0D0, 2D0*ACOS(-1D0)/1.1D0, Y, IERR)
         CALL EXPECT('TRBPER', IERR .EQ. 0)
         CALL TRBEXT(IH, 1, CV, XMIN, XMAX, TMIN, TMAX, IERR)
         CALL EXPECT('amplitude', ABS(XMAX - 3.38660810D0) .LT. 1D-7)
         CALL TRBMUL(IH, 1, RE, AI, IERR)
         CALL EXPECT('three multipliers', IERR .EQ. 0 .AND.
     1               ABS(RE(4) + 7D0) .LT. 1D-9)
         OMEGA = 0D0
         ZETA = 0D0
         CALL TRBNLM(IH, 1, CV, 1D0, OMEGA, ZETA, Y, IERR)
         CALL EXPECT('TRBNLM', IERR .EQ. 0)
         CALL EXPECT('omega', ABS(OMEGA - 1.2258676901977D0) .LT. 1D-9)
         CALL EXPECT('zeta', ABS(ZETA - 0.105752880426D0 - 5D-2/OMEGA)
     1               .LT. 1D-9)
         PERIOD = 0D0
         SUM(1) = 0D0
         ISEEN(1) = 0
         ISEEN(2) = 0
         Y(1) = 0D0
         Y(2) = 0D0
         Y(3) = 0D0
         CALL TRBCRV(IH, 1, IOPT, ROPT, CV, 0D0, PERIOD, Y, POINT, SUM,
     1               ISEEN, IERR)
         CALL EXPECT('TRBCRV', IERR .EQ. 0)
         CALL EXPECT('omega at the end', ABS(8D0*ATAN(1D0)/PERIOD -
     1               OMEGA) .LT. 1D-9)
         CALL EXPECT('ceases to stick', ISEEN(1) .EQ. 61 .AND.
     1               ABS(SUM(1) - 0.5D0) .LT. 1D-8)
         ISEEN(2) = 1
         CALL TRBCRV(IH, 1, IOPT, ROPT, CV, 0D0, PERIOD, Y, POINT, SUM,
     1               ISEEN, IERR)
         CALL EXPECT('stopped', IERR .EQ. 60)
         Y(1) = 0D0
         Y(3) = 0D0
         CALL TRBEQU(IH, 1, 1, IGIVEN, Y, ISLIP, NEXP, RE, AI, IERR)
         CALL EXPECT('TRBEQU', IERR .EQ. 0 .AND. NEXP .EQ. 2)
         CALL EXPECT('at rest', ISLIP(1) .EQ. 0 .AND. Y(1) .EQ. 0D0)
         CALL EXPECT('exponents', ABS(RE(1) + 5D-2) .LT. 1D-12 .AND.
     1               ABS(AI(2) + SQRT(1.9975D0)) .LT. 1D-12)
         CALL TRBFLT(IH, 1, 1, 0, IGIVEN, Y, 0.1D0, 2D0, XMAX, OMEGA,
     1               IERR)
         CALL EXPECT('TRBFLT', IERR .EQ. 0 .AND. XMAX .GT. 1D300)
         CALL TRBDEL(IH, IERR)
   10 CONTINUE
      IH = -777
      CMP(1) = -1D0
      CALL TRBMOD(1, 1, IRM, ICM, ONE, IRM, ICM, C, IRM, ICM, ONE,
     1            IRM, ICM, ONE, CMP, 0, 0, IH, TEXT, IERR)
      CALL SAYS('CMP', IERR, 3, TEXT, 'compliance(1) = -1 is negative')
      CALL TRBMOD(1, 1, IRM, ICM, ONE, IRM, ICM, C, IRM, ICM, ONE,
     1            IRM, ICM, ONE, CMP, -1, 0, IH, TEXT, IERR)
      CALL SAYS('NMODE', IERR, 6, TEXT, 'NMODE = -1 is less than 0')
      CALL TRBMOD(1, -1, IRM, ICM, ONE, IRM, ICM, C, IRM, ICM, ONE,
     1            IRM, ICM, ONE, CMP, 0, 0, IH, TEXT, IERR)
      CALL SAYS('N', IERR, 6, TEXT, 'N = -1 is less than 0')
      CALL TRBMOD(-1, 1, IRM, ICM, ONE, IRM, ICM, C, IRM, ICM, ONE,
     1            IRM, ICM, ONE, CMP, 0, 0, IH, TEXT, IERR)
      CALL SAYS('NFULL', IERR, 6, TEXT, 'NFULL = -1 is less than 0')
      CALL EXPECT('no handle', IH .EQ. -777)
      END
C
C     An elastic contact that lifts off, as in models.f90.
      SUBROUTINE NORMAL
      INTEGER IH, IERR, IR(3), IC(2), NRM(2)
      DOUBLE PRECISION ONE(2), C(2), RK(2), CMP(2), RN(3, 2)
      DOUBLE PRECISION PC(2), PS(2), Y(6)
      CHARACTER*80 TEXT
      DATA IR /1, 2, 3/, IC /1, 2/, ONE /2*1D0/, RK /12D0, 21D0/
      DATA CMP /0.2D0, 0D0/, NRM /2, 0/, PS /2*0D0/, Y /6*0D0/
      DATA RN /0.85D0, 21D0, 0D0, 3*0D0/
      C(1) = 0.1D0*SQRT(12D0)
      C(2) = 2D0
      CALL TRBNML(2, 2, IR, IC, ONE, IR, IC, C, IR, IC, RK, IR, IC, ONE,
     1            CMP, NRM, RN, 0, 0, IH, TEXT, IERR)
      CALL EXPECT('TRBNML', IERR .EQ. 0)
      PC(1) = 0D0
      PC(2) = 100D0
      CALL TRBLOD(IH, 2, 0D0, PC, PS, IERR)
      PC(1) = 60D0
      PC(2) = 60D0
      CALL TRBLOD(IH, 2, 5D0, PC, PS, IERR)
      CALL TRBDRV(IH, 'event', 0D0, 0D0, 0D0, IERR)
      CALL TRBPER(IH, 2, 0D0, 2D0*ACOS(-1D0)/5D0, Y, IERR)
      CALL EXPECT('TRBPER', IERR .EQ. 0)
      CALL EXPECT('steady', ABS(Y(1) + 5.44592597D0) .LT. 1D-8)
      CALL TRBDEL(IH, IERR)
      IH = -777
      NRM(1) = 1
      CALL TRBNML(2, 2, IR, IC, ONE, IR, IC, C, IR, IC, RK, IR, IC, ONE,
     1            CMP, NRM, RN, 0, 0, IH, TEXT, IERR)
      CALL SAYS('NRM', IERR, 5, TEXT,
     1          'contact 1 is to be its own normal')
      CALL EXPECT('no handle', IH .EQ. -777)
      END
C
C     Stick-slip on a belt, as in models.f90.
      SUBROUTINE BELT
      INTEGER IH, IERR, IR(2), IC(1)
      DOUBLE PRECISION ONE(1), ZERO(1), V(1), F(1), R(1), Y(3), PERIOD
      CHARACTER*80 TEXT
      DATA IR /1, 2/, IC /1/, ONE /1D0/, ZERO /0D0/, V /0.2D0/
      DATA F /0.6D0/, Y /3*0D0/, PERIOD /0D0/
      R(1) = 1D0/0.6D0
      CALL TRBMOD(1, 1, IR, IC, ONE, IR, IC, ZERO, IR, IC, ONE,
     1            IR, IC, ONE, ZERO, 0, 0, IH, TEXT, IERR)
      CALL EXPECT('TRBMOD', IERR .EQ. 0)
      CALL TRBLIM(IH, 1, F, IERR)
      CALL TRBSTA(IH, 1, R, ZERO, IERR)
      CALL EXPECT('TRBSTA', IERR .EQ. 0)
      CALL TRBBAS(IH, 1, 0D0, V, ZERO, IERR)
      CALL TRBDRV(IH, 'exact', 0D0, 0D0, 0D0, IERR)
      CALL TRBCYC(IH, 1, 0D0, PERIOD, Y, IERR)
      CALL EXPECT('TRBCYC', IERR .EQ. 0)
      CALL EXPECT('period', ABS(PERIOD - 8.0688878716D0) .LT. 1D-9)
      CALL EXPECT('break-away', ABS(Y(1) - 1D0) .LT. 1D-9)
      CALL TRBCYC(IH, 2, 0D0, PERIOD, Y, IERR)
      CALL EXPECT('NDOF', IERR .EQ. 6)
      CALL TRBDEL(IH, IERR)
      END
C
C     Steady sliding on a belt, friction that falls from 1 to 0.6 by the
C     speed 0.5: stable while 0.8 exp(-2 speed) is below the damping.
      SUBROUTINE FLUTTR
      INTEGER IH, IERR, IR(2), IC(1), IGIVEN(1), ISLIP(1), NEXP
      DOUBLE PRECISION ONE(1), ZERO(1), F(1), R(1), FALL(1), D(1), Y(3)
      DOUBLE PRECISION RE(2), AI(2), CRIT, OMEGA
      CHARACTER*80 TEXT
      DATA IR /1, 2/, IC /1/, ONE /1D0/, ZERO /0D0/, F /0.6D0/
      DATA FALL /0.5D0/, D /0.115D0/, Y /3*0D0/, IGIVEN /0/
      R(1) = 1D0/0.6D0
      CALL TRBMOD(1, 1, IR, IC, ONE, IR, IC, D, IR, IC, ONE,
     1            IR, IC, ONE, ZERO, 0, 0, IH, TEXT, IERR)
      CALL TRBLIM(IH, 1, F, IERR)
      CALL TRBSTA(IH, 1, R, FALL, IERR)
      CALL TRBBAS(IH, 1, 0D0, ONE, ZERO, IERR)
      CALL TRBFLT(IH, 1, 1, 1, IGIVEN, Y, 2D0, 0.1D0, CRIT, OMEGA,
     1            IERR)
      CALL EXPECT('flutter', IERR .EQ. 0)
      CALL EXPECT('speed at the onset', ABS(CRIT - 0.5D0*LOG(0.8D0/D(1)
     1            )) .LT. 1D-10 .AND. ABS(OMEGA - 1D0) .LT. 1D-10)
      CALL TRBEQU(IH, 1, 1, IGIVEN, Y, ISLIP, NEXP, RE, AI, IERR)
      CALL EXPECT('slides back', IERR .EQ. 0 .AND. ISLIP(1) .EQ. -1)
      CALL EXPECT('force of sliding', ABS(Y(1) - 0.6D0 -
     1            0.4D0*EXP(-2D0)) .LT. 1D-12)
      CALL EXPECT('growth', ABS(RE(1) + 0.5D0*(D(1) - 0.8D0*EXP(-2D0)))
     1            .LT. 1D-12)
      IGIVEN(1) = 7
      CALL TRBEQU(IH, 1, 1, IGIVEN, Y, ISLIP, NEXP, RE, AI, IERR)
      CALL EXPECT('IGIVEN', IERR .EQ. 5)
      CALL TRBDEL(IH, IERR)
      END
C
C     Nothing is made of what is wrong, and the handle stays as it was.
      SUBROUTINE CREATE
      INTEGER IH, IERR, IRM(7), ICM(6), IRK(7), ICK(16), IRJ(3), ICJ(2)
      DOUBLE PRECISION RM(6), RK(16), RJ(2)
      CHARACTER*80 TEXT
      CALL ROWS(IRM, ICM, RM, IRK, ICK, RK, IRJ, ICJ, RJ)
      IH = -777
      CALL TRBRED(-1, 2, IRM, ICM, RM, IRK, ICK, RK, IRJ, ICJ, RJ, 2, 1,
     1            IH, TEXT, IERR)
      CALL SAYS('NFULL', IERR, 6, TEXT, 'NFULL = -1 is less than 0')
      CALL TRBRED(6, -1, IRM, ICM, RM, IRK, ICK, RK, IRJ, ICJ, RJ, 2, 1,
     1            IH, TEXT, IERR)
      CALL SAYS('N', IERR, 6, TEXT, 'N = -1 is less than 0')
      CALL MKRED(0, 1, IH, TEXT, IERR)
      CALL SAYS('NMODE', IERR, 6, TEXT, 'NMODE = 0 is less than 1')
      CALL MKRED(7, 1, IH, TEXT, IERR)
      CALL SAYS('NMODE', IERR, 6, TEXT,
     1          'nmode = 7 is more than the 6 degrees of freedom')
      CALL TRBLSP(-1, 2, IRM, ICM, RM, IRK, ICK, RK, IRK, ICK, RK, IRJ,
     1            ICJ, RJ, IH, TEXT, IERR)
      CALL SAYS('NDOF', IERR, 6, TEXT, 'NDOF = -1 is less than 0')
      CALL TRBLSP(6, -1, IRM, ICM, RM, IRK, ICK, RK, IRK, ICK, RK, IRJ,
     1            ICJ, RJ, IH, TEXT, IERR)
      CALL SAYS('N', IERR, 6, TEXT, 'N = -1 is less than 0')
      ICK(3) = 7
      CALL TRBLSP(6, 2, IRM, ICM, RM, IRM, ICM, RM, IRK, ICK, RK, IRJ,
     1            ICJ, RJ, IH, TEXT, IERR)
      CALL SAYS('ICK', IERR, 5, TEXT,
     1          'stiffness: col(3) = 7 is not in 1 to 6')
      ICK(3) = 1
      IRJ(1) = 2
      CALL TRBRED(6, 2, IRM, ICM, RM, IRK, ICK, RK, IRJ, ICJ, RJ, 2, 1,
     1            IH, TEXT, IERR)
      CALL SAYS('IRJ', IERR, 6, TEXT,
     1          'direction: rowptr(1) = 2 is not 1')
      IRJ(1) = 1
      RM(2) = -1D0
      CALL TRBRED(6, 2, IRM, ICM, RM, IRK, ICK, RK, IRJ, ICJ, RJ, 2, 1,
     1            IH, TEXT, IERR)
      CALL EXPECT('mass', IERR .NE. 0 .AND. TEXT(1:4) .EQ. 'mass')
      CALL EXPECT('no handle', IH .EQ. -777)
      END
C
C     Every routine with what is no handle, with one of contacts alone,
C     and, if it works on a driver, without one.
      SUBROUTINE NODRIV
      INTEGER IHS(3), ICODE(3), IH, K, IERR, I, IDLE(1)
      DOUBLE PRECISION X(13)
      CHARACTER*80 TEXT(3), NAME
      EXTERNAL WATCH
      IHS(1) = 12345
      CALL TRBNEW(2, IHS(2), IERR)
      CALL MKSPRS(.TRUE., IHS(3), NAME, IERR)
      ICODE(1) = 1
      ICODE(2) = 8
      ICODE(3) = 8
      TEXT(1) = 'IH = 12345 is no handle: it was never given, or has '//
     1          'been deleted'
      TEXT(2) = 'IH has contacts only: TRBLIN makes a structure'
      TEXT(3) = 'IH has no integrator: call TRBDRV first'
      DO 10 I = 1, 13
         X(I) = -777D0
   10 CONTINUE
      I = -777
      NAME = 'as it was'
      DO 20 K = 1, 3
         IH = IHS(K)
         IF (K .LT. 3) THEN
            CALL TRBCLN(IH, I, IERR)
            CALL WANTED('TRBCLN', IH, IERR, ICODE(K), TEXT(K))
            CALL TRBNDF(IH, I, IERR)
            CALL WANTED('TRBNDF', IH, IERR, ICODE(K), TEXT(K))
            CALL TRBLTB(IH, 6, 1, X, X, X, IERR)
            CALL WANTED('TRBLTB', IH, IERR, ICODE(K), TEXT(K))
            CALL TRBBTB(IH, 2, 1, X, X, X, IERR)
            CALL WANTED('TRBBTB', IH, IERR, ICODE(K), TEXT(K))
            CALL TRBLMT(IH, 2, 1, X, X, IERR)
            CALL WANTED('TRBLMT', IH, IERR, ICODE(K), TEXT(K))
            CALL TRBCON(IH, 6, 2, 0D0, X, X, X, X, IERR)
            CALL WANTED('TRBCON', IH, IERR, ICODE(K), TEXT(K))
            CALL TRBZET(IH, 0.1D0, IERR)
            CALL WANTED('TRBZET', IH, IERR, ICODE(K), TEXT(K))
            CALL TRBFRQ(IH, 6, X, IERR)
            CALL WANTED('TRBFRQ', IH, IERR, ICODE(K), TEXT(K))
            CALL TRBEXP(IH, 6, 6, X, X, IERR)
            CALL WANTED('TRBEXP', IH, IERR, ICODE(K), TEXT(K))
            CALL TRBTRC(IH, 1D0, X(1), IERR)
            CALL WANTED('TRBTRC', IH, IERR, ICODE(K), TEXT(K))
            CALL TRBDER(IH, 6, 0D0, X, X, IERR)
            CALL WANTED('TRBDER', IH, IERR, ICODE(K), TEXT(K))
            CALL TRBJAC(IH, 6, 0D0, X, X, 13, X, IERR)
            CALL WANTED('TRBJAC', IH, IERR, ICODE(K), TEXT(K))
            CALL TRBSAC(IH, 6, 0D0, X, IERR)
            CALL WANTED('TRBSAC', IH, IERR, ICODE(K), TEXT(K))
         END IF
         CALL TRBMTH(IH, NAME, IERR)
         CALL WANTED('TRBMTH', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBHMX(IH, 1D0, IERR)
         CALL WANTED('TRBHMX', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBHST(IH, 1D0, IERR)
         CALL WANTED('TRBHST', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBTOL(IH, 1D0, 0D0, IERR)
         CALL WANTED('TRBTOL', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBOUT(IH, 1D0, IERR)
         CALL WANTED('TRBOUT', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBFAM(IH, IDLE(1), IERR)
         CALL WANTED('TRBFAM', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBOBS(IH, WATCH, X, IDLE, IERR)
         CALL WANTED('TRBOBS', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBDVL(IH, 100, X(1), IERR)
         CALL WANTED('TRBDVL', IH, IERR, ICODE(K), TEXT(K))
   20 CONTINUE
      DO 30 K = 1, 13
         CALL EXPECT('untouched', X(K) .EQ. -777D0 .AND. I .EQ. -777)
   30 CONTINUE
      CALL EXPECT('untouched', NAME .EQ. 'as it was')
      CALL TRBDEL(IHS(2), IERR)
      CALL TRBDEL(IHS(3), IERR)
      END
C
C     Sizes that are not those of the structure, and what the library
C     finds, counted from 1.
      SUBROUTINE WRONG
      INTEGER IH, IERR
      DOUBLE PRECISION X(13)
      CHARACTER*80 TEXT, SIX
      DATA X /13*0D0/
      CALL MKRED(2, 0, IH, TEXT, IERR)
      SIX = 'NFULL = 2, but the degrees of freedom of the '//
     1      'matrices are 6'
      CALL TRBLOD(IH, 2, 1D0, X, X, IERR)
      CALL WANTED('TRBLOD', IH, IERR, 6, SIX)
      CALL TRBLTB(IH, 2, 1, X, X, X, IERR)
      CALL WANTED('TRBLTB', IH, IERR, 6, SIX)
      CALL TRBEXP(IH, 2, 2, X, X, IERR)
      CALL WANTED('TRBEXP', IH, IERR, 6, SIX)
      CALL TRBEXP(IH, 6, 6, X, X, IERR)
      CALL WANTED('TRBEXP', IH, IERR, 6,
     1            'NDOF = 6, but the degrees of freedom are 2')
      CALL TRBLTB(IH, 6, 0, X, X, X, IERR)
      CALL WANTED('TRBLTB', IH, IERR, 6, 'KNOTS = 0 is less than 1')
      CALL TRBBTB(IH, 2, 0, X, X, X, IERR)
      CALL WANTED('TRBBTB', IH, IERR, 6, 'KNOTS = 0 is less than 1')
      CALL TRBLMT(IH, 2, -1, X, X, IERR)
      CALL WANTED('TRBLMT', IH, IERR, 6, 'KNOTS = -1 is less than 1')
      CALL TRBLMT(IH, 1, 1, X, X, IERR)
      CALL WANTED('TRBLMT', IH, IERR, 6,
     1            'N = 1, but the number of contacts is 2')
      CALL TRBJAC(IH, 2, 0D0, X, X, 4, X, IERR)
      CALL WANTED('TRBJAC', IH, IERR, 6, 'LDJ = 4 is less than 5')
      CALL TRBZET(IH, -1D0, IERR)
      CALL WANTED('TRBZET', IH, IERR, 3, 'zeta = -1 is negative')
      X(2) = -1D0
      CALL TRBLMT(IH, 2, 1, X, X, IERR)
      CALL WANTED('TRBLMT', IH, IERR, 3,
     1            'limit(1) = -1 of contact 2 is negative')
      CALL TRBDRV(IH, 'exact', 0.1D0, 0D0, 0D0, IERR)
      CALL TRBHMX(IH, 1D0, IERR)
      CALL EXPECT('TRBHMX of exact', IERR .EQ. 9)
      CALL TRBDEL(IH, IERR)
      END
