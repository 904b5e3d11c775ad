C SPDX-License-Identifier: BSD-3-Clause
C     The fixed-form routines, called as a code of 1978 would: no module,
C     no interface block, every array a piece of a bigger one.
C     First everything that can succeed, with each of its results
C     compared to that of the C call (see scene.c); then every error.
      PROGRAM LEGACY
      INTEGER NALIVE
      EXTERNAL NALIVE
      CALL SCPLAY
      CALL LAWS
      CALL PLAY
      CALL SCEND
      CALL NOHAND
      CALL SINGLE
      CALL ERRORS
      CALL HANDLE
      CALL OWNLAW
      CALL EXPECT('all deleted', NALIVE() .EQ. 0)
      CALL REPORT_ALL
      END
C
      SUBROUTINE LAWS
      INTEGER N
      PARAMETER (N = 4)
      INTEGER IVER, NLAW, LAW, IERR, I, J, IROW(5), ICOL(8), JROW(5)
      INTEGER JCOL(5), K
      DOUBLE PRECISION P(3,2), DP(3,3,2), DT(18)
      DOUBLE PRECISION FMUN(N), EPS(N), D(N), R(N,N), VAL(8), RM(6)
      DOUBLE PRECISION RJ(5), FLO(N), FUP(N), V(N), A(N), FEQ(N), W(4)
      DOUBLE PRECISION SHARED, ST(20)
      CHARACTER*200 TEXT
      CALL SCDATA(FMUN, EPS, D, R, N, IROW, ICOL, VAL, RM, JROW, JCOL,
     1            RJ, FLO, FUP, SHARED)
      CALL SCSTAT(4, V, A, FEQ)
      CALL TRBVER(IVER, IERR)
      CALL CMPI('TRBVER', IVER)
      CALL TRBVST(TEXT, IERR)
      CALL CMPT('TRBVST', TEXT)
      DO 10 I = -1, 63
         CALL TRBTXT(I, TEXT, IERR)
         CALL CMPT('TRBTXT', TEXT)
   10 CONTINUE
      CALL TRBNLW(NLAW, IERR)
      CALL CMPI('TRBNLW', NLAW)
      DO 40 LAW = -1, NLAW
         TEXT = ' '
         CALL TRBLNM(LAW, TEXT, IERR)
         CALL CMPT('TRBLNM', TEXT)
         IF (IERR .EQ. 0) THEN
            CALL TRBFND(TEXT, J, IERR)
            CALL EXPECT('TRBFND', J .EQ. LAW .AND. IERR .EQ. 0)
         ELSE
            CALL EXPECT('TRBLNM of no law', IERR .EQ. 5)
         END IF
         TEXT = ' '
         CALL TRBREF(LAW, TEXT, IERR)
         CALL CMPT('TRBREF', TEXT)
         DO 30 I = 1, N
            DO 20 J = 1, 4
               W(J) = 0D0
   20       CONTINUE
            CALL TRBEVL(LAW, V(I), FEQ(I), FMUN(I), EPS(I), W(1), W(2),
     1                  W(3), W(4), IERR)
            CALL CMPI('TRBEVL', IERR)
            CALL CMPR('TRBEVL', 4, W)
   30    CONTINUE
   40 CONTINUE
      CALL TRBELF(N, V, EPS, FMUN, FEQ, W, IERR)
      CALL CMPI('TRBELF', IERR)
      CALL CMPR('TRBELF', N, FEQ)
      CALL CMPR('TRBELF', N, W)
      CALL SCSTAT(4, V, A, FEQ)
      CALL TRBELP(N/2, V, EPS, FMUN, FEQ, VAL, IERR)
      CALL CMPI('TRBELP', IERR)
      CALL CMPR('TRBELP', N, FEQ)
      CALL CMPR('TRBELP', 2*N, VAL)
      CALL SCSTAT(4, V, A, FEQ)
      P(1,1) = FEQ(1)
      P(2,1) = FEQ(2)
      P(3,1) = FEQ(3)
      P(1,2) = FEQ(4)
      P(2,2) = 0D0
      P(3,2) = 0D0
      CALL TRBCTF(2, V, FMUN, D, D, EPS, P, DP, IERR)
      DO 60 K = 1, 2
         DO 50 I = 1, 3
            DT(9*K-9+I) = DP(1, I, K)
            DT(9*K-6+I) = DP(2, I, K)
            DT(9*K-3+I) = DP(3, I, K)
   50    CONTINUE
   60 CONTINUE
      CALL CMPI('TRBCTF', IERR)
      CALL CMPR('TRBCTF', 6, P)
      CALL CMPR('TRBCTF', 18, DT)
      DO 65 LAW = 0, 3
         DO 62 I = 0, 11
            DT(I+1) = EPS(MOD(I, N)+1) + 0.25D0
            IF (LAW .EQ. 2 .AND. (I .EQ. 4 .OR. I .EQ. 9)) DT(I+1) = 1D0
   62    CONTINUE
         DO 64 I = 1, 10
            ST(I) = 0D0
            ST(I+10) = 0D0
   64    CONTINUE
         FEQ(1) = 0D0
         FEQ(2) = 0D0
         IF (LAW .EQ. 0) CALL TRBDAH(2, V, EPS, FMUN, FEQ, VAL, IERR)
         IF (LAW .EQ. 1)
     1      CALL TRBLUG(2, 0.5D0, V, DT, ST, FEQ, VAL, IERR)
         IF (LAW .EQ. 2) CALL TRBBWN(2, V, DT, ST, FEQ, VAL, IERR)
         IF (LAW .EQ. 3)
     1      CALL TRBIWN(2, 1, V, DT, ST(11), FEQ, VAL, IERR)
         CALL CMPI('TRBDAH', IERR)
         CALL CMPR('TRBDAH', 2, FEQ)
         CALL CMPR('TRBDAH', 2, VAL)
         CALL CMPR('TRBDAH', 2, ST)
         CALL CMPR('TRBDAH', 10, ST(11))
   65 CONTINUE
      J = -7
      CALL TRBFND('quin', J, IERR)
      CALL EXPECT('TRBFND of no law', J .EQ. -7 .AND. IERR .EQ. 7)
      END
C
      SUBROUTINE PLAY
      INTEGER N, LDR
      PARAMETER (N = 4, LDR = 7)
      INTEGER IH, IH2, IERR, IFORM, ISET, LAW, NLAW, IPAR(3), K
      INTEGER IWORK(40)
      DOUBLE PRECISION W(200), R(LDR,LDR), RATIO(N), ZERO(1)
      CHARACTER*40 TEXT
      EXTERNAL MINV
C     Where things begin in W and IWORK
      INTEGER LF, LE, LD, LV, LM, LJ, LLO, LUP
      PARAMETER (LF = 3, LE = 9, LD = 15, LV = 21, LM = 31, LJ = 41,
     1           LLO = 51, LUP = 61)
      CALL SCDATA(W(LF), W(LE), W(LD), R(2,1), LDR, IWORK(2), IWORK(9),
     1            W(LV), W(LM), IWORK(19), IWORK(29), W(LJ), W(LLO),
     2            W(LUP), W(LM-1))
      CALL TRBNEW(N, IH, IERR)
      CALL CMPI('TRBNEW', IERR)
      TEXT = 'as is'
      CALL TRBMSG(IH, TEXT, IERR)
      CALL CMPT('TRBMSG', TEXT)
      CALL SETTIN(IH)
      CALL QUERY(IH)
      CALL TRBNLD(IH, N, W(LE), W(LF), IERR)
      CALL CMPI('TRBNLD', IERR)
      CALL SETTIN(IH)
      CALL TRBLIM(IH, N, W(LF), IERR)
      CALL CMPI('TRBLIM', IERR)
      CALL TRBEPS(IH, N, W(LE), IERR)
      CALL CMPI('TRBEPS', IERR)
      CALL SETTIN(IH)
      CALL TRBNLW(NLAW, IERR)
      DO 30 IFORM = 1, 5
         IF (IFORM .EQ. 1) CALL TRBOPD(IH, N, W(LD), IERR)
         IF (IFORM .EQ. 2) CALL TRBOPF(IH, N, R(2,1), LDR, IERR)
         IF (IFORM .EQ. 3) CALL TRBOPS(IH, N, IWORK(2), IWORK(9), W(LV),
     1                                 IERR)
         IF (IFORM .EQ. 4) CALL TRBOPM(IH, N, 6, W(LM), IWORK(19),
     1                                 IWORK(29), W(LJ), IERR)
         IPAR(2) = 0
         IPAR(3) = 0
         IF (IFORM .EQ. 5) CALL TRBOPC(IH, N, 6, MINV, IWORK(19),
     1                                 IWORK(29), W(LJ), W(LM-1),
     2                                 IPAR(2), IERR)
         CALL CMPI('TRBOP', IERR)
         IF (IFORM .EQ. 1) CALL TRBUPD(IH, N, W(LD), IERR)
         IF (IFORM .EQ. 3) CALL TRBUPD(IH, IWORK(2+N)-1, W(LV), IERR)
         IF (IFORM .EQ. 4) CALL TRBUPD(IH, IWORK(19+N)-1, W(LJ), IERR)
         IF (IFORM .EQ. 1 .OR. IFORM .EQ. 3 .OR. IFORM .EQ. 4)
     1      CALL CMPI('TRBUPD', IERR)
         IF (IFORM .EQ. 5) CALL EXPECT('MINV', IPAR(2) .EQ. N)
         DO 20 ISET = 0, 2
            CALL TRBCPL(IH, MOD(ISET, 2), IERR)
            CALL CMPI('TRBCPL', IERR)
            CALL TRBSHR(IH, ISET/2, IERR)
            CALL CMPI('TRBSHR', IERR)
            DO 10 LAW = 0, NLAW - 1
               CALL TRBLNM(LAW, TEXT, IERR)
               IF (MOD(LAW, 2) .EQ. 0) CALL TRBLAW(IH, LAW, IERR)
               IF (MOD(LAW, 2) .EQ. 1) CALL TRBNAM(IH, TEXT, IERR)
               CALL CMPI('TRBLAW', IERR)
               CALL SETTIN(IH)
               CALL FORCES(IH, W(LLO), W(LUP))
   10       CONTINUE
   20    CONTINUE
   30 CONTINUE
      CALL TRBCPL(IH, 0, IERR)
      CALL CMPI('TRBCPL', IERR)
      CALL PLANAR(IH)
      CALL TRBSTP(IH, 0.01D0, 0.4D0, IERR)
      CALL CMPI('TRBSTP', IERR)
      CALL SETTIN(IH)
      CALL TRBSTP(IH, 0.01D0, 1D0, IERR)
      CALL CMPI('TRBSTP', IERR)
      CALL SETTIN(IH)
      CALL FORCES(IH, W(LLO), W(LUP))
      DO 35 K = 1, N
         RATIO(K) = 1D0 + 32D0*W(LE-1+K)
   35 CONTINUE
      ZERO(1) = 0D0
      CALL TRBSTA(IH, N, RATIO, ZERO, IERR)
      CALL CMPI('TRBSTA', IERR)
      CALL SETTIN(IH)
      CALL FORCES(IH, W(LLO), W(LUP))
      CALL TRBSTA(IH, N, RATIO, W(LE), IERR)
      CALL CMPI('TRBSTA', IERR)
      CALL SETTIN(IH)
      CALL FORCES(IH, W(LLO), W(LUP))
      CALL TRBEP1(IH, 0.03125D0, IERR)
      CALL CMPI('TRBEP1', IERR)
      CALL TRBLM1(IH, 0.75D0, IERR)
      CALL CMPI('TRBLM1', IERR)
      CALL SETTIN(IH)
      CALL TRBCPY(IH, IH2, IERR)
      CALL CMPI('TRBCPY', IERR)
      CALL TRBCPS(IH2, IH, IERR)
      CALL CMPI('TRBCPS', IERR)
      CALL TRBLAW(IH, 2, IERR)
      CALL CMPI('TRBLAW', IERR)
      CALL FORCES(IH, W(LLO), W(LUP))
      CALL SETTIN(IH2)
      CALL QUERY(IH2)
      CALL FORCES(IH2, W(LLO), W(LUP))
      CALL TRBDEL(IH, IERR)
      CALL EXPECT('TRBDEL', IERR .EQ. 0)
      CALL TRBFIX(IH2, IERR)
      CALL CMPI('TRBFIX', IERR)
      CALL TRBDEL(IH2, IERR)
      CALL EXPECT('TRBDEL of the copy', IERR .EQ. 0)
      END
C
C     M**-1 of scene.c: RPAR holds what is shared, then the inverse
C     masses. IPAR counts the calls; at call IPAR(2) it fails.
      SUBROUTINE MINV(NDOF, FORCE, ACC, RPAR, IPAR, IER)
      INTEGER NDOF, IPAR(*), IER, I
      DOUBLE PRECISION FORCE(NDOF), ACC(NDOF), RPAR(*), S
      S = 0D0
      DO 10 I = 1, NDOF
         S = S + RPAR(1)*FORCE(I)
   10 CONTINUE
      DO 20 I = 1, NDOF
         ACC(I) = RPAR(1+I)*FORCE(I) + S
   20 CONTINUE
      IPAR(1) = IPAR(1) + 1
      IF (IPAR(1) .EQ. IPAR(2)) IER = 17
      END
C
C     Quinn's law, by its box
      SUBROUTINE BOXLAW(I1, N, IDER, V, FMUN, EPS, BOX, RPAR, IPAR, IER)
      INTEGER I1, N, IDER, IPAR(*), IER, I
      DOUBLE PRECISION V(N), FMUN(N), EPS(N), BOX(N,*), RPAR(*), S
      IPAR(1) = IPAR(1) + 1
      DO 10 I = 1, N
         S = RPAR(1)*FMUN(I)/EPS(I)
         BOX(I,1) = -FMUN(I)
         BOX(I,2) = FMUN(I)
         BOX(I,3) = S*V(I)
         IF (V(I) .LT. 0D0) BOX(I,1) = MIN(FMUN(I), -FMUN(I)-BOX(I,3))
         IF (V(I) .GT. 0D0) BOX(I,2) = MAX(-FMUN(I), FMUN(I)-BOX(I,3))
         IF (ABS(V(I)) .GT. EPS(I)) THEN
            BOX(I,1) = -SIGN(FMUN(I), V(I))
            BOX(I,2) = BOX(I,1)
            BOX(I,3) = 0D0
         END IF
         IF (IDER .EQ. 1) THEN
            BOX(I,4) = 0D0
            BOX(I,5) = 0D0
            BOX(I,6) = 0D0
            IF (ABS(V(I)) .LE. EPS(I)) THEN
               IF (V(I) .LE. 0D0) BOX(I,4) = -S
               IF (V(I) .GE. 0D0) BOX(I,5) = -S
               BOX(I,6) = S
            END IF
         END IF
         IF (I1 + I - 1 .EQ. IPAR(2)) IER = 9
   10 CONTINUE
      END
C
C     A law of the program's own moves forces and derivatives as the
C     built-in one does
      SUBROUTINE OWNLAW
      INTEGER N
      PARAMETER (N = 3)
      INTEGER IH(3), IERR, I, J, K, LAW, IPAR(2)
      DOUBLE PRECISION R(N,N), V(N), A(N), FMUN(N), EPS(N), RPAR(1)
      DOUBLE PRECISION FEQ(N,3), F(N,3), DFDV(N,N,3), DFDA(N,N,3), OFF
      CHARACTER*200 TEXT
      EXTERNAL BOXLAW
      COMMON /OWNPAR/ RPAR, IPAR
      DATA R /2D0, 1D0, 0D0, 1D0, 2D0, 1D0, 0D0, 1D0, 2D0/
      DATA V /0.01D0, -0.02D0, 0.5D0/, A /0.3D0, -9D0, 1D0/
      DATA FMUN /1D0, 2D0, 1.5D0/, EPS /0.1D0, 0.2D0, 0.1D0/
      RPAR(1) = 2D0
      IPAR(1) = 0
      IPAR(2) = 0
      DO 20 K = 1, 3
         IF (K .LT. 3) CALL TRBNEW(N, IH(K), IERR)
         IF (K .EQ. 3) CALL TRBCPY(IH(2), IH(3), IERR)
         CALL TRBLIM(IH(K), N, FMUN, IERR)
         CALL TRBEPS(IH(K), N, EPS, IERR)
         IF (K .LT. 3) CALL TRBOPF(IH(K), N, R, N, IERR)
         IF (K .EQ. 2) CALL TRBULW(IH(K), BOXLAW, RPAR, IPAR, IERR)
         CALL TRBBTN(IH(K), N, V, A, FEQ(1,K), F(1,K), DFDV(1,1,K),
     1               DFDA(1,1,K), N, IERR)
         CALL EXPECT('TRBULW', IERR .EQ. 0)
   20 CONTINUE
      CALL TRBGLW(IH(2), LAW, IERR)
      CALL EXPECT('number of TRBULW', LAW .EQ. -1)
      CALL EXPECT('calls of TRBULW', IPAR(1) .EQ. 4)
      OFF = 0D0
      DO 50 K = 2, 3
         DO 40 I = 1, N
            OFF = MAX(OFF, ABS(FEQ(I,K)-FEQ(I,1)), ABS(F(I,K)-F(I,1)))
            DO 30 J = 1, N
               OFF = MAX(OFF, ABS(DFDV(I,J,K)-DFDV(I,J,1))*1D-2,
     1                   ABS(DFDA(I,J,K)-DFDA(I,J,1)))
   30       CONTINUE
   40    CONTINUE
   50 CONTINUE
      CALL EXPECT('results of TRBULW', OFF .LT. 1D-14)
      CALL TRBDEL(IH(2), IERR)
      IPAR(2) = 2
      CALL TRBBAL(IH(3), N, V, A, FEQ, F, IERR)
      CALL EXPECT('failure of TRBULW', IERR .EQ. 62)
      CALL TRBMSG(IH(3), TEXT, IERR)
      CALL EXPECT('message of TRBULW', TEXT .EQ.
     1 'law answered 9 for 3 contacts, of which the first is contact 1')
      CALL TRBDEL(IH(3), IERR)
      CALL TRBDEL(IH(1), IERR)
      END
C
      SUBROUTINE SETTIN(IH)
      INTEGER IH, N, LAW, ICPL, ISHR, IERR
      DOUBLE PRECISION X(6), VSTR(4)
      CALL TRBNUM(IH, N, IERR)
      CALL CMPI('TRBNUM', IERR)
      CALL CMPI('TRBNUM', N)
      CALL TRBGLW(IH, LAW, IERR)
      CALL CMPI('TRBGLW', IERR)
      CALL CMPI('TRBGLW', LAW)
      CALL TRBGCP(IH, ICPL, IERR)
      CALL CMPI('TRBGCP', IERR)
      CALL CMPI('TRBGCP', ICPL)
      CALL TRBGSH(IH, ISHR, IERR)
      CALL CMPI('TRBGSH', IERR)
      CALL CMPI('TRBGSH', ISHR)
      X(1) = 5D0
      X(6) = 5D0
      CALL TRBGLM(IH, N, X(2), IERR)
      CALL CMPI('TRBGLM', IERR)
      CALL CMPR('TRBGLM', N, X(2))
      CALL TRBGST(IH, N, X(2), VSTR, IERR)
      CALL CMPI('TRBGST', IERR)
      CALL CMPR('TRBGST', N, X(2))
      CALL CMPR('TRBGST', N, VSTR)
      CALL TRBGEP(IH, N, X(2), IERR)
      CALL CMPI('TRBGEP', IERR)
      CALL CMPR('TRBGEP', N, X(2))
      CALL EXPECT('around it', X(1) .EQ. 5D0 .AND. X(6) .EQ. 5D0)
      END
C
      SUBROUTINE QUERY(IH)
      INTEGER IH, IERR, MODE(6), I, IVAL
      DOUBLE PRECISION VAL(1), X(4)
      DO 10 I = 1, 6
         MODE(I) = 9
   10 CONTINUE
      CALL TRBSLP(IH, 4, MODE(2), IERR)
      CALL CMPI('TRBSLP', IERR)
      DO 20 I = 1, 4
         X(I) = MODE(I + 1)
   20 CONTINUE
      CALL CMPR('TRBSLP', 4, X)
      CALL EXPECT('around', MODE(1) .EQ. 9 .AND. MODE(6) .EQ. 9)
      DO 30 I = 0, 9
         CALL TRBCNT(IH, I, IVAL, IERR)
         CALL CMPI('TRBCNT', IERR)
         CALL CMPI('TRBCNT', IVAL)
   30 CONTINUE
      DO 40 I = 0, 2
         CALL TRBVAL(IH, I, VAL(1), IERR)
         CALL CMPI('TRBVAL', IERR)
         CALL CMPR('TRBVAL', 1, VAL)
   40 CONTINUE
      END
C
      SUBROUTINE PLANAR(IH)
      INTEGER N
      PARAMETER (N = 4)
      INTEGER IH, IERR, K, IFIRST(1)
      DOUBLE PRECISION V(N), A(N), FEQ(N), F(N), GIVEN(N), X(2*N,3)
      CALL CLEAR(6*N, X)
      IFIRST(1) = 2
      CALL TRBPLN(IH, 1, IFIRST, IERR)
      CALL CMPI('TRBPLN', IERR)
      DO 10 K = 1, 5
         CALL SCSTAT(K, V, A, FEQ)
         CALL TRBBAL(IH, N, V, A, FEQ, F, IERR)
         CALL CMPI('TRBBAL', IERR)
         CALL CMPR('TRBBAL', N, FEQ)
         CALL CMPR('TRBBAL', N, F)
         CALL QUERY(IH)
         CALL SCSTAT(K, V, A, GIVEN)
         CALL TRBFTP(IH, N, V, GIVEN, F, X(1,1), X(1,2), X(1,3), IERR)
         CALL CMPI('TRBFTP', IERR)
         CALL CMPR('TRBFTP', N, F)
         CALL CMPR('TRBFTP', 6*N, X)
         CALL TRBSTM(IH, N, 0.125D0, A, V, F, IERR)
         CALL CMPI('TRBSTM', IERR)
         CALL CMPR('TRBSTM', N, F)
         CALL QUERY(IH)
   10 CONTINUE
      CALL TRBPLN(IH, 0, IFIRST, IERR)
      CALL CMPI('TRBPLN', IERR)
      END
C
      SUBROUTINE FORCES(IH, FLO, FUP)
      INTEGER N, LDJ
      PARAMETER (N = 4, LDJ = 6)
      INTEGER IH, IERR, K, I, J
      DOUBLE PRECISION FLO(*), FUP(*), V(N), A(N), FEQ(N)
      DOUBLE PRECISION F(N+2), G(N+2), X(N,3), DV(LDJ,N), DA(LDJ,N)
      DOUBLE PRECISION QV(N,N), QA(N,N), ROW(N), ZERO(N), DF(N+2)
      LOGICAL SAME
      DATA ZERO /N*0D0/
      DF(1) = 5D0
      DF(N+2) = 5D0
      F(N+1) = 5D0
      DO 100 K = 1, 5
         CALL SCSTAT(K, V, A, FEQ)
         CALL TRBFRC(IH, N, V, FEQ, F, IERR)
         CALL CMPI('TRBFRC', IERR)
         CALL CMPR('TRBFRC', N, F)
         CALL TRBFTN(IH, N, V, FEQ, F, X(1,1), X(1,2), X(1,3), IERR)
         CALL CMPI('TRBFTN', IERR)
         CALL CMPR('TRBFTN', N, F)
         CALL CMPR('TRBFTN', 3*N, X)
C        On failure C's outputs were zero here, or the forces before
         CALL CLEAR(N, G)
         CALL TRBBAL(IH, N, V, A, X, F, IERR)
         CALL CMPI('TRBBAL', IERR)
         CALL CMPR('TRBBAL, FEQ', N, X)
         CALL CMPR('TRBBAL, F', N, F)
         CALL QUERY(IH)
         CALL CLEAR(LDJ*N, DV)
         CALL CLEAR(LDJ*N, DA)
         CALL CLEAR(N*N, QV)
         CALL CLEAR(N*N, QA)
         CALL TRBBTN(IH, N, V, A, X, F, DV, DA, LDJ, IERR)
         CALL CMPI('TRBBTN', IERR)
         CALL CMPR('TRBBTN, FEQ', N, X)
         CALL CMPR('TRBBTN, F', N, F)
         DO 20 I = 1, N
            DO 10 J = 1, N
               ROW(J) = DV(I,J)
   10       CONTINUE
            CALL CMPR('TRBBTN, DFDV', N, ROW)
   20    CONTINUE
         DO 40 I = 1, N
            DO 30 J = 1, N
               ROW(J) = DA(I,J)
   30       CONTINUE
            CALL CMPR('TRBBTN, DFDA', N, ROW)
   40    CONTINUE
C        On failure C's outputs were f_eq and derivatives
         CALL TRBTPR(IH, N, FEQ, A, X(1,1), IERR)
         CALL CMPI('TRBTPR', IERR)
         CALL TRBTPR(IH, N, FEQ, ZERO, X(1,2), IERR)
         CALL CMPI('TRBTPR', IERR)
         CALL TRBTPR(IH, N, ZERO, A, X(1,3), IERR)
         CALL CMPI('TRBTPR', IERR)
         CALL CMPR('TRBTPR', 3*N, X)
         CALL TRBLPR(IH, N, A, X(1,1), IERR)
         CALL CMPI('TRBLPR', IERR)
         CALL CMPR('TRBLPR', N, X)
         CALL TRBTPR(IH, N, FEQ, A, DF(2), IERR)
         CALL TRBSTF(IH, N, 0.125D0, V, F, IERR)
         CALL CMPI('TRBSTF', IERR)
         CALL CMPR('TRBSTF', N, F)
         CALL QUERY(IH)
         CALL TRBSTM(IH, N, 0.125D0, A, V, F, IERR)
         CALL CMPI('TRBSTM', IERR)
         CALL CMPR('TRBSTM', N, F)
         CALL TRBBOX(IH, N, A, FLO, FUP, F, IERR)
         CALL CMPI('TRBBOX', IERR)
         CALL CMPR('TRBBOX', N, F)
         CALL TRBACC(IH, N, V, FEQ, IERR)
         CALL CMPI('TRBACC', IERR)
C        Below the matrix, and past the vector, nothing has changed.
         SAME = F(N+1) .EQ. 5D0 .AND. DF(1) .EQ. 5D0 .AND.
     1      DF(N+2) .EQ. 5D0
         DO 50 J = 1, N
            SAME = SAME .AND. DV(5,J) .EQ. 0D0 .AND. DA(6,J) .EQ. 0D0
   50    CONTINUE
         CALL EXPECT('around the forces', SAME)
  100 CONTINUE
      END
C
      SUBROUTINE CLEAR(N, X)
      INTEGER N, I
      DOUBLE PRECISION X(N)
      DO 10 I = 1, N
         X(I) = 0D0
   10 CONTINUE
      END
