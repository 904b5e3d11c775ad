C SPDX-License-Identifier: BSD-3-Clause
C     The errors of the fixed-form routines, for legacy.f.
C
C     Every routine that takes a handle, with one that is none.
      SUBROUTINE NOHAND
      INTEGER N
      PARAMETER (N = 2)
      INTEGER IHS(5), IH, I, K, IERR, IH2, J, IROW(3), ICOL(2), NONE
      INTEGER IPAR(2)
      DOUBLE PRECISION X(N), Y(N), Z(N), D(N), E(N), Q(N,N), P(N,N)
      CHARACTER*80 TEXT
      CHARACTER*80 SAYS
      EXTERNAL MINV, BOXLAW
      DATA IPAR /0, 0/
      CALL TRBNEW(N, IHS(1), IERR)
      CALL TRBDEL(IHS(1), IERR)
      CALL EXPECT('deleted', IERR .EQ. 0)
      IHS(2) = 0
      IHS(3) = -IHS(1)
      IHS(4) = 2147483647
      IHS(5) = 12345
      NONE = -777
      DO 10 I = 1, N
         X(I) = 1D0
         Y(I) = -777D0
         Z(I) = -777D0
         D(I) = -777D0
         E(I) = -777D0
   10 CONTINUE
      CALL DIAGON(N, IROW, ICOL)
      CALL CLEAR(N*N, Q)
      CALL CLEAR(N*N, P)
      DO 100 K = 1, 5
         IH = IHS(K)
         J = NONE
         IH2 = NONE
         WRITE (SAYS, 20) IH
   20    FORMAT ('IH = ', I11,
     1           ' is no handle: it was never given, or has been delet',
     2           'ed')
         IERR = 0
         CALL TRBMSG(IH, TEXT, IERR)
         CALL EXPECT('TRBMSG', IERR .EQ. 1)
         IERR = 42
         CALL TRBMSG(IH, TEXT, IERR)
         CALL EXPECT('TRBMSG leaves IERR alone', IERR .EQ. 42)
         CALL SQUEEZ(SAYS)
         CALL EXPECT('text of no handle', TEXT .EQ. SAYS)
         CALL TRBCPY(IH, IH2, IERR)
         CALL WANTED('TRBCPY', IH, IERR, 1, SAYS)
         CALL TRBDEL(IH, IERR)
         CALL WANTED('TRBDEL', IH, IERR, 1, SAYS)
         CALL TRBNUM(IH, J, IERR)
         CALL WANTED('TRBNUM', IH, IERR, 1, SAYS)
         CALL TRBLAW(IH, 0, IERR)
         CALL WANTED('TRBLAW', IH, IERR, 1, SAYS)
         CALL TRBNAM(IH, 'coulomb', IERR)
         CALL WANTED('TRBNAM', IH, IERR, 1, SAYS)
         CALL TRBULW(IH, BOXLAW, X, IPAR, IERR)
         CALL WANTED('TRBULW', IH, IERR, 1, SAYS)
         CALL TRBGLW(IH, J, IERR)
         CALL WANTED('TRBGLW', IH, IERR, 1, SAYS)
         CALL TRBLIM(IH, N, X, IERR)
         CALL WANTED('TRBLIM', IH, IERR, 1, SAYS)
         CALL TRBLM1(IH, 1D0, IERR)
         CALL WANTED('TRBLM1', IH, IERR, 1, SAYS)
         CALL TRBGLM(IH, N, Y, IERR)
         CALL WANTED('TRBGLM', IH, IERR, 1, SAYS)
         CALL TRBEPS(IH, N, X, IERR)
         CALL WANTED('TRBEPS', IH, IERR, 1, SAYS)
         CALL TRBEP1(IH, 1D0, IERR)
         CALL WANTED('TRBEP1', IH, IERR, 1, SAYS)
         CALL TRBSTP(IH, 1D0, 1D0, IERR)
         CALL WANTED('TRBSTP', IH, IERR, 1, SAYS)
         CALL TRBGEP(IH, N, Y, IERR)
         CALL WANTED('TRBGEP', IH, IERR, 1, SAYS)
         CALL TRBOPD(IH, N, X, IERR)
         CALL WANTED('TRBOPD', IH, IERR, 1, SAYS)
         CALL TRBOPF(IH, N, Q, N, IERR)
         CALL WANTED('TRBOPF', IH, IERR, 1, SAYS)
         CALL TRBOPS(IH, N, IROW, ICOL, X, IERR)
         CALL WANTED('TRBOPS', IH, IERR, 1, SAYS)
         CALL TRBOPM(IH, N, N, X, IROW, ICOL, X, IERR)
         CALL WANTED('TRBOPM', IH, IERR, 1, SAYS)
         CALL TRBOPC(IH, N, N, MINV, IROW, ICOL, X, X, IPAR, IERR)
         CALL WANTED('TRBOPC', IH, IERR, 1, SAYS)
         CALL TRBUPD(IH, N, X, IERR)
         CALL WANTED('TRBUPD', IH, IERR, 1, SAYS)
         CALL TRBCPL(IH, 0, IERR)
         CALL WANTED('TRBCPL', IH, IERR, 1, SAYS)
         CALL TRBGCP(IH, J, IERR)
         CALL WANTED('TRBGCP', IH, IERR, 1, SAYS)
         CALL TRBSHR(IH, 0, IERR)
         CALL WANTED('TRBSHR', IH, IERR, 1, SAYS)
         CALL TRBSTA(IH, N, X, X, IERR)
         CALL WANTED('TRBSTA', IH, IERR, 1, SAYS)
         CALL TRBGST(IH, N, Y, Z, IERR)
         CALL WANTED('TRBGST', IH, IERR, 1, SAYS)
         CALL TRBGSH(IH, J, IERR)
         CALL WANTED('TRBGSH', IH, IERR, 1, SAYS)
         CALL TRBFRC(IH, N, X, X, Y, IERR)
         CALL WANTED('TRBFRC', IH, IERR, 1, SAYS)
         CALL TRBFTN(IH, N, X, X, Y, Z, D, E, IERR)
         CALL WANTED('TRBFTN', IH, IERR, 1, SAYS)
         CALL TRBFTP(IH, N, X, X, Y, Z, D, E, IERR)
         CALL WANTED('TRBFTP', IH, IERR, 1, SAYS)
         CALL TRBBAL(IH, N, X, X, Y, Z, IERR)
         CALL WANTED('TRBBAL', IH, IERR, 1, SAYS)
         CALL TRBBTN(IH, N, X, X, Y, Z, Q, P, N, IERR)
         CALL WANTED('TRBBTN', IH, IERR, 1, SAYS)
         CALL TRBTPR(IH, N, X, X, Y, IERR)
         CALL WANTED('TRBTPR', IH, IERR, 1, SAYS)
         CALL TRBLPR(IH, N, X, Y, IERR)
         CALL WANTED('TRBLPR', IH, IERR, 1, SAYS)
         CALL TRBSTF(IH, N, 1D0, X, Y, IERR)
         CALL WANTED('TRBSTF', IH, IERR, 1, SAYS)
         CALL TRBBOX(IH, N, X, X, X, Y, IERR)
         CALL WANTED('TRBBOX', IH, IERR, 1, SAYS)
         CALL TRBACC(IH, N, X, X, IERR)
         CALL WANTED('TRBACC', IH, IERR, 1, SAYS)
         CALL TRBSLP(IH, N, ICOL, IERR)
         CALL WANTED('TRBSLP', IH, IERR, 1, SAYS)
         CALL TRBCNT(IH, 0, J, IERR)
         CALL WANTED('TRBCNT', IH, IERR, 1, SAYS)
         CALL TRBVAL(IH, 0, Y(1), IERR)
         CALL WANTED('TRBVAL', IH, IERR, 1, SAYS)
         CALL EXPECT('integers stay', J .EQ. NONE .AND. IH2 .EQ. NONE
     1      .AND. ICOL(1) .EQ. 1 .AND. ICOL(2) .EQ. 2 .AND.
     2      IPAR(1) .EQ. 0)
         CALL EXPECT('reals stay', Y(1) .EQ. -777D0 .AND. Y(2) .EQ.
     1      -777D0 .AND. Z(1) .EQ. -777D0 .AND. D(2) .EQ. -777D0 .AND.
     2      E(1) .EQ. -777D0 .AND. Q(1,2) .EQ. 0D0 .AND. P(2,1) .EQ.
     3      0D0)
  100 CONTINUE
      END
C
C     Takes the blanks after an equals sign but for one.
      SUBROUTINE SQUEEZ(TEXT)
      CHARACTER*(*) TEXT
   10 IF (INDEX(TEXT, '=  ') .EQ. 0) RETURN
      TEXT = TEXT(1:INDEX(TEXT, '=  ')) // TEXT(INDEX(TEXT, '=  ')+2:)
      GO TO 10
      END
C
C     The errors of calls with a handle that is one.
      SUBROUTINE ERRORS
      INTEGER N
      PARAMETER (N = 3)
      INTEGER IH, IERR, J, NM, K, IROW(4), ICOL(4), MODE(3), NOS(3)
      INTEGER IPAR(2)
      DOUBLE PRECISION X(4), Y(4), Z(4), D(4), E(4), Q(4,4), P(4,4)
      DOUBLE PRECISION NEG(3), VAL(4)
      INTEGER IPL(2)
      CHARACTER*60 SAYS
      LOGICAL SAME
      EXTERNAL MINV, BOXLAW
      DATA NEG /1D0, 2D0, -1D0/, VAL /1D0, 1D0, 1D0, 1D0/
      DATA NOS /2, 4, -3/, IPAR /0, 2/
      IH = -777
      CALL TRBNEW(-1, IH, IERR)
      CALL EXPECT('TRBNEW', IERR .EQ. 3 .AND. IH .EQ. -777)
      CALL TRBNEW(N, IH, IERR)
      CALL EXPECT('TRBNEW', IERR .EQ. 0 .AND. IH .GT. 0)
      J = -777
      CALL TRBEVL(99, 0D0, 0D0, 1D0, 1D0, X(1), X(2), X(3), X(4), IERR)
      CALL EXPECT('TRBEVL', IERR .EQ. 5)
      CALL TRBELF(-1, X, X, X, X, Y, IERR)
      CALL EXPECT('TRBELF', IERR .EQ. 3)
      CALL TRBELP(-1, X, X, X, X, Y, IERR)
      CALL EXPECT('TRBELP', IERR .EQ. 3)
      CALL TRBCTF(-1, X, X, X, X, X, X, Y, IERR)
      CALL EXPECT('TRBCTF', IERR .EQ. 3)
      CALL TRBDAH(-1, X, X, X, X, Y, IERR)
      CALL EXPECT('TRBDAH', IERR .EQ. 3)
      CALL TRBLUG(-1, 1D0, X, X, X, X, Y, IERR)
      CALL EXPECT('TRBLUG', IERR .EQ. 3)
      CALL TRBBWN(-1, X, X, X, X, Y, IERR)
      CALL EXPECT('TRBBWN', IERR .EQ. 3)
      CALL TRBIWN(1, -1, X, X, X, X, Y, IERR)
      CALL EXPECT('TRBIWN', IERR .EQ. 3)
      DO 10 K = 1, 4
         X(K) = 0D0
         Y(K) = -777D0
         Z(K) = -777D0
         D(K) = -777D0
         E(K) = -777D0
   10 CONTINUE
      CALL CLEAR(16, Q)
      CALL CLEAR(16, P)
C     A number of contacts that is not that of the handle
      DO 30 K = 1, 3
         NM = NOS(K)
         WRITE (SAYS, 20) NM
   20    FORMAT ('N = ', I2, ', but the number of contacts is 3')
         CALL SQUEEZ(SAYS)
         CALL TRBLIM(IH, NM, X, IERR)
         CALL WANTED('TRBLIM', IH, IERR, 6, SAYS)
         CALL TRBGLM(IH, NM, Y, IERR)
         CALL WANTED('TRBGLM', IH, IERR, 6, SAYS)
         CALL TRBSTA(IH, NM, X, X, IERR)
         CALL WANTED('TRBSTA', IH, IERR, 6, SAYS)
         CALL TRBGST(IH, NM, Y, Z, IERR)
         CALL WANTED('TRBGST', IH, IERR, 6, SAYS)
         CALL TRBEPS(IH, NM, X, IERR)
         CALL WANTED('TRBEPS', IH, IERR, 6, SAYS)
         CALL TRBGEP(IH, NM, Y, IERR)
         CALL WANTED('TRBGEP', IH, IERR, 6, SAYS)
         CALL TRBOPD(IH, NM, X, IERR)
         CALL WANTED('TRBOPD', IH, IERR, 6, SAYS)
         CALL TRBOPF(IH, NM, Q, 4, IERR)
         CALL WANTED('TRBOPF', IH, IERR, 6, SAYS)
         CALL TRBOPS(IH, NM, IROW, ICOL, VAL, IERR)
         CALL WANTED('TRBOPS', IH, IERR, 6, SAYS)
         CALL TRBOPM(IH, NM, 2, X, IROW, ICOL, VAL, IERR)
         CALL WANTED('TRBOPM', IH, IERR, 6, SAYS)
         CALL TRBOPC(IH, NM, 2, MINV, IROW, ICOL, VAL, X, IPAR, IERR)
         CALL WANTED('TRBOPC', IH, IERR, 6, SAYS)
         CALL TRBFRC(IH, NM, X, X, Y, IERR)
         CALL WANTED('TRBFRC', IH, IERR, 6, SAYS)
         CALL TRBFTN(IH, NM, X, X, Y, Z, D, E, IERR)
         CALL WANTED('TRBFTN', IH, IERR, 6, SAYS)
         CALL TRBFTP(IH, NM, X, X, Y, Z, D, E, IERR)
         CALL WANTED('TRBFTP', IH, IERR, 6, SAYS)
         CALL TRBBAL(IH, NM, X, X, Y, Z, IERR)
         CALL WANTED('TRBBAL', IH, IERR, 6, SAYS)
         CALL TRBBTN(IH, NM, X, X, Y, Z, Q, P, 4, IERR)
         CALL WANTED('TRBBTN', IH, IERR, 6, SAYS)
         CALL TRBTPR(IH, NM, X, X, Y, IERR)
         CALL WANTED('TRBTPR', IH, IERR, 6, SAYS)
         CALL TRBLPR(IH, NM, X, Y, IERR)
         CALL WANTED('TRBLPR', IH, IERR, 6, SAYS)
         CALL TRBSTF(IH, NM, 1D0, X, Y, IERR)
         CALL WANTED('TRBSTF', IH, IERR, 6, SAYS)
         CALL TRBBOX(IH, NM, X, X, X, Y, IERR)
         CALL WANTED('TRBBOX', IH, IERR, 6, SAYS)
         CALL TRBACC(IH, NM, X, X, IERR)
         CALL WANTED('TRBACC', IH, IERR, 6, SAYS)
         MODE(1) = -777
         CALL TRBSLP(IH, NM, MODE, IERR)
         CALL WANTED('TRBSLP', IH, IERR, 6, SAYS)
   30 CONTINUE
      SAME = MODE(1) .EQ. -777
      DO 40 K = 1, 4
         SAME = SAME .AND. Y(K) .EQ. -777D0 .AND. Z(K) .EQ. -777D0 .AND.
     1      D(K) .EQ. -777D0 .AND. E(K) .EQ. -777D0
   40 CONTINUE
      CALL EXPECT('outputs stay', SAME)
C     Values
      CALL TRBLIM(IH, N, NEG, IERR)
      CALL WANTED('TRBLIM', IH, IERR, 3, 'limit(3) = -1 is negative')
      IPL(1) = 1
      IPL(2) = N
      CALL TRBPLN(IH, 2, IPL, IERR)
      CALL WANTED('TRBPLN', IH, IERR, 5,
     1            'first(2) = 3 is not in 1 to 2')
      IPL(2) = 2
      CALL TRBPLN(IH, 2, IPL, IERR)
      CALL WANTED('TRBPLN', IH, IERR, 22,
     1            'first(2) takes contact 2, which first(1) has taken')
      CALL TRBPLN(IH, -1, IPL, IERR)
      CALL WANTED('TRBPLN', IH, IERR, 6, 'NPL = -1 is less than 0')
      CALL TRBNLD(IH, N, NEG, X, IERR)
      CALL WANTED('TRBNLD', IH, IERR, 3, 'mu(3) = -1 is negative')
      CALL TRBSTA(IH, N, NEG, X, IERR)
      CALL WANTED('TRBSTA', IH, IERR, 5, 'ratio(3) = -1 is below 1')
      CALL TRBLM1(IH, -2D0, IERR)
      CALL WANTED('TRBLM1', IH, IERR, 3, 'limit = -2 is negative')
      CALL TRBMSG(IH, SAYS, IERR)
      CALL EXPECT('TRBMSG leaves IERR alone', IERR .EQ. 3)
      IERR = 0
      CALL TRBMSG(IH, SAYS, IERR)
      CALL EXPECT('TRBMSG after all', IERR .EQ. 0)
      CALL TRBEPS(IH, N, NEG, IERR)
      CALL WANTED('TRBEPS', IH, IERR, 4,
     1            'epsilon(3) = -1 is not positive')
      CALL TRBEP1(IH, 0D0, IERR)
      CALL WANTED('TRBEP1', IH, IERR, 4, 'epsilon = 0 is not positive')
      CALL TRBSTP(IH, -1D0, 1D0, IERR)
      CALL WANTED('TRBSTP', IH, IERR, 4, 'dt = -1 is not positive')
      CALL TRBSTP(IH, 1D0, 0D0, IERR)
      CALL WANTED('TRBSTP', IH, IERR, 4,
     1            'lambda_dt = 0 is not positive')
      CALL TRBLAW(IH, 6, IERR)
      CALL WANTED('TRBLAW', IH, IERR, 5, 'law = 6 is none of the 6 laws'
     1            )
      CALL TRBNAM(IH, 'quin', IERR)
      CALL WANTED('TRBNAM', IH, IERR, 7, 'no law is called "quin": th'//
     1'ere are coulomb, velocity-limited, smooth, karnopp, quinn, quin'
     2//'n-reversal')
      CALL TRBNAM(IH, 'KARNOPP   ', IERR)
      CALL TRBGLW(IH, J, IERR)
      CALL EXPECT('upper case', IERR .EQ. 0 .AND. J .EQ. 3)
      J = -777
      CALL TRBCPL(IH, 2, IERR)
      CALL WANTED('TRBCPL', IH, IERR, 5,
     1'coupling = 2 is neither TRIBO_CONSISTENT nor TRIBO_PARTITION')
      CALL TRBSHR(IH, 2, IERR)
      CALL WANTED('TRBSHR', IH, IERR, 5,
     1'sharing = 2 is neither TRIBO_SHARE_LEAST_NORM nor '//
     2'TRIBO_SHARE_PREVIOUS')
      CALL TRBOPD(IH, N, NEG, IERR)
      CALL WANTED('TRBOPD', IH, IERR, 3, 'r(3) = -1 is negative')
      CALL TRBUPD(IH, N, NEG, IERR)
      CALL WANTED('TRBUPD', IH, IERR, 8,
     1'no operator: call tribo_set_operator_diagonal or another '//
     2'tribo_set_operator_... first')
      CALL TRBOPF(IH, N, Q, 2, IERR)
      CALL WANTED('TRBOPF', IH, IERR, 6, 'LDR = 2 is less than 3')
      CALL TRBBTN(IH, N, X, X, Y, Z, Q, P, 2, IERR)
      CALL WANTED('TRBBTN', IH, IERR, 6, 'LDJ = 2 is less than 3')
      CALL TRBNEW(N, J, IERR)
      CALL TRBOPD(J, N, VAL, IERR)
      CALL TRBUPD(J, N, NEG, IERR)
      CALL WANTED('TRBUPD', J, IERR, 3, 'val(3) = -1 is negative')
      CALL TRBUPD(J, 2, VAL, IERR)
      CALL WANTED('TRBUPD', J, IERR, 6, 'NVAL = 2 is not 3')
      CALL TRBDEL(J, IERR)
      J = -777
      Q(1,1) = 1D0
      Q(2,2) = 1D0
      Q(3,3) = 1D0
      Q(1,3) = 0.5D0
      CALL TRBOPF(IH, N, Q, 4, IERR)
      CALL WANTED('TRBOPF', IH, IERR, 20,
     1            'r of contacts 1, 3 is 0.5 one way and 0 the other')
      CALL DIAGON(N, IROW, ICOL)
      ICOL(2) = 4
      CALL TRBOPS(IH, N, IROW, ICOL, VAL, IERR)
      CALL WANTED('TRBOPS', IH, IERR, 5, 'col(2) = 4 is not in 1 to 3')
      ICOL(2) = 2
      CALL TRBOPM(IH, N, 2, VAL, IROW, ICOL, VAL, IERR)
      CALL WANTED('TRBOPM', IH, IERR, 5, 'col(3) = 3 is not in 1 to 2')
      CALL TRBOPC(IH, N, 2, MINV, IROW, ICOL, VAL, VAL, IPAR, IERR)
      CALL WANTED('TRBOPC', IH, IERR, 5, 'col(3) = 3 is not in 1 to 2')
      CALL EXPECT('MINV not called', IPAR(1) .EQ. 0)
      CALL TRBOPC(IH, N, 3, MINV, IROW, ICOL, VAL, VAL, IPAR, IERR)
      CALL WANTED('TRBOPC', IH, IERR, 62,
     1            'apply answered 17 for contact 2')
      CALL EXPECT('MINV called no more', IPAR(1) .EQ. 2)
      IROW(4) = 0
      CALL TRBOPS(IH, N, IROW, ICOL, VAL, IERR)
      CALL WANTED('TRBOPS', IH, IERR, 6,
     1            'rowptr(4) = 0 is less than the one before')
      CALL TRBOPM(IH, N, 3, VAL, IROW, ICOL, VAL, IERR)
      CALL WANTED('TRBOPM', IH, IERR, 6,
     1            'rowptr(4) = 0 is less than the one before')
      CALL TRBOPM(IH, N, -1, VAL, IROW, ICOL, VAL, IERR)
      CALL WANTED('TRBOPM', IH, IERR, 6, 'NDOF = -1 is less than 0')
      CALL TRBOPC(IH, N, 3, MINV, IROW, ICOL, VAL, VAL, IPAR, IERR)
      CALL WANTED('TRBOPC', IH, IERR, 6,
     1            'rowptr(4) = 0 is less than the one before')
      CALL TRBOPC(IH, N, -1, MINV, IROW, ICOL, VAL, VAL, IPAR, IERR)
      CALL WANTED('TRBOPC', IH, IERR, 6, 'NDOF = -1 is less than 0')
      CALL TRBTPR(IH, N, X, X, Y, IERR)
      CALL WANTED('TRBTPR', IH, IERR, 8,
     1    'no tribo_balance_tangent since the last balance or change')
      CALL TRBLPR(IH, N, X, Y, IERR)
      CALL WANTED('TRBLPR', IH, IERR, 8,
     1    'no tribo_balance_tangent since the last balance or change')
      CALL TRBSLP(IH, N, MODE, IERR)
      CALL WANTED('TRBSLP', IH, IERR, 8,
     1    'another call must come first')
      CALL TRBCNT(IH, 99, J, IERR)
      CALL WANTED('TRBCNT', IH, IERR, 5,
     1            'an index or a choice is out of range')
      CALL TRBVAL(IH, -1, Y(1), IERR)
      CALL WANTED('TRBVAL', IH, IERR, 5,
     1            'an index or a choice is out of range')
      CALL TRBSTF(IH, N, 0D0, X, Y, IERR)
      CALL WANTED('TRBSTF', IH, IERR, 4, 'dt = 0 is not positive')
      CALL TRBBAL(IH, N, X, X, Y, Z, IERR)
      CALL WANTED('TRBBAL', IH, IERR, 8, 'no operator: call tribo_set'//
     1'_operator_diagonal or another tribo_set_operator_... first')
      CALL TRBSTP(IH, 1D0, 1D0, IERR)
      CALL TRBGEP(IH, N, Y, IERR)
      CALL WANTED('TRBGEP', IH, IERR, 8,
     1    'another call must come first')
      CALL TRBOPD(IH, N, VAL, IERR)
      CALL TRBBOX(IH, N, X, VAL, X, Y, IERR)
      CALL WANTED('TRBBOX', IH, IERR, 5,
     1            'lower(1) = 1 is above upper(1) = 0')
      CALL EXPECT('outputs', Y(1) .EQ. -777D0 .AND. J .EQ. -777)
      CALL TRBDEL(IH, IERR)
      CALL EXPECT('TRBDEL', IERR .EQ. 0)
      END
C
C     No contacts are fine; handles are never given twice.
      SUBROUTINE HANDLE
      INTEGER IH, IERR, I, IOLD, IROW(1), ICOL(1), N
      DOUBLE PRECISION X(1)
      LOGICAL NEW
      IROW(1) = 1
      CALL TRBNEW(0, IH, IERR)
      CALL TRBLIM(IH, 0, X, IERR)
      CALL EXPECT('no contacts', IERR .EQ. 0)
      CALL TRBOPS(IH, 0, IROW, ICOL, X, IERR)
      CALL EXPECT('no contacts', IERR .EQ. 0)
      CALL TRBOPF(IH, 0, X, 1, IERR)
      CALL EXPECT('no contacts', IERR .EQ. 0)
      CALL TRBBAL(IH, 0, X, X, X, X, IERR)
      CALL EXPECT('no contacts', IERR .EQ. 0)
      CALL TRBDEL(IH, IERR)
C     A place in the table lasts for 2047 handles.
      IOLD = IH
      NEW = .TRUE.
      DO 10 I = 1, 5000
         CALL TRBNEW(1, IH, IERR)
         NEW = NEW .AND. IERR .EQ. 0 .AND. IH .NE. IOLD .AND. IH .GT. 0
         CALL TRBNUM(IOLD, N, IERR)
         NEW = NEW .AND. IERR .EQ. 1
         CALL TRBDEL(IH, IERR)
   10 CONTINUE
      CALL EXPECT('every handle is new', NEW)
      END
C
C     Rows of a diagonal matrix.
      SUBROUTINE DIAGON(N, IROW, ICOL)
      INTEGER N, IROW(N+1), ICOL(N), K
      DO 10 K = 1, N
         IROW(K) = K
         ICOL(K) = K
   10 CONTINUE
      IROW(N+1) = N + 1
      END
C
C     A REAL that is read as a DOUBLE PRECISION is refused; 0 is not.
      SUBROUTINE SINGLE
      INTEGER IH, IERR, IROW(3), ICOL(2)
      REAL S(2)
      DOUBLE PRECISION D(1), X(2), Y(2), R(2,2)
      CHARACTER*56 SAYS
      EXTERNAL MINV
      EQUIVALENCE (S, D)
      CALL TRBNEW(2, IH, IERR)
      S(1) = 1.0
      S(2) = 0.0
      CALL TRBLM1(IH, D(1), IERR)
      CALL WANTED('TRBLM1', IH, IERR, 5, 'FMUN = 5.264E-315 is'//
     1' neither 0 nor of a usual size: is FMUN DOUBLE PRECISION?')
      CALL TRBEP1(IH, D(1), IERR)
      CALL WANTED('TRBEP1', IH, IERR, 5, 'EPS = 5.264E-315 is'//
     1' neither 0 nor of a usual size: is EPS DOUBLE PRECISION?')
      CALL TRBSTP(IH, 1D0, D(1), IERR)
      CALL WANTED('TRBSTP', IH, IERR, 5, 'RLDT = 5.264E-315 is'//
     1' neither 0 nor of a usual size: is RLDT DOUBLE PRECISION?')
      CALL TRBSTP(IH, D(1), 1D0, IERR)
      CALL EXPECT('DT', IERR .EQ. 5)
      X(1) = 2D0
      X(2) = 1D-300
      CALL TRBLIM(IH, 2, X, IERR)
      CALL WANTED('TRBLIM', IH, IERR, 5, 'FMUN(2) = 1.000E-300 is'//
     1' neither 0 nor of a usual size: is FMUN DOUBLE PRECISION?')
      CALL TRBEPS(IH, 2, X, IERR)
      CALL EXPECT('TRBEPS', IERR .EQ. 5)
      CALL TRBOPD(IH, 2, X, IERR)
      CALL EXPECT('TRBOPD', IERR .EQ. 5)
      CALL TRBNLD(IH, 2, X, X, IERR)
      CALL EXPECT('TRBNLD', IERR .EQ. 5)
      CALL TRBGLM(IH, 2, Y, IERR)
      CALL EXPECT('limits stay', Y(1) .EQ. 0D0 .AND. Y(2) .EQ. 0D0)
C     Not in the way of others: 0, small ones alone, and far ones.
      X(2) = 0D0
      CALL TRBLIM(IH, 2, X, IERR)
      CALL EXPECT('0 beside 2', IERR .EQ. 0)
      X(2) = 1D-280
      CALL TRBLIM(IH, 2, X, IERR)
      CALL EXPECT('1D-280 beside 2', IERR .EQ. 0)
      X(1) = 1D-300
      X(2) = 1D-300
      CALL TRBLIM(IH, 2, X, IERR)
      CALL EXPECT('1D-300 alone', IERR .EQ. 0)
C     Values of operators; small ones beside one of 1D-250 decay.
      SAYS = ' neither 0 nor of a usual size: is VAL DOUBLE PRECISION?'
      X(1) = 2D0
      X(2) = 3D0
      CALL TRBOPD(IH, 2, X, IERR)
      X(2) = D(1)
      CALL TRBUPD(IH, 2, X, IERR)
      CALL WANTED('TRBUPD', IH, IERR, 5, 'VAL(2) = 5.264E-315 is'//SAYS)
      X(1) = 1D-250
      CALL TRBUPD(IH, 2, X, IERR)
      CALL EXPECT('TRBUPD, decay', IERR .EQ. 0)
      R(1,1) = 2D0
      R(1,2) = D(1)
      R(2,1) = D(1)
      R(2,2) = 3D0
      CALL TRBOPF(IH, 2, R, 2, IERR)
      CALL WANTED('TRBOPF', IH, IERR, 5, 'R(2,1) = 5.264E-315 is'//
     1' neither 0 nor of a usual size: is R DOUBLE PRECISION?')
      R(2,2) = 1D-250
      CALL TRBOPF(IH, 2, R, 2, IERR)
      CALL EXPECT('TRBOPF, decay', IERR .EQ. 0)
      R(2,2) = 3D0
      CALL TRBUPD(IH, 4, R, IERR)
      CALL WANTED('TRBUPD', IH, IERR, 5, 'VAL(2) = 5.264E-315 is'//SAYS)
      R(1,2) = 0D0
      R(2,1) = -0D0
      CALL TRBUPD(IH, 4, R, IERR)
      CALL EXPECT('TRBUPD, 0', IERR .EQ. 0)
      CALL DIAGON(2, IROW, ICOL)
      X(1) = 2D0
      Y(1) = 1D0
      Y(2) = 1D0
      CALL TRBOPS(IH, 2, IROW, ICOL, X, IERR)
      CALL WANTED('TRBOPS', IH, IERR, 5, 'VAL(2) = 5.264E-315 is'//SAYS)
      CALL TRBOPM(IH, 2, 2, Y, IROW, ICOL, X, IERR)
      CALL WANTED('TRBOPM', IH, IERR, 5, 'VAL(2) = 5.264E-315 is'//SAYS)
      CALL TRBOPC(IH, 2, 2, MINV, IROW, ICOL, X, Y, IROW, IERR)
      CALL WANTED('TRBOPC', IH, IERR, 5, 'VAL(2) = 5.264E-315 is'//SAYS)
C     A wrong row or column is named first.
      ICOL(2) = 3
      CALL TRBOPS(IH, 2, IROW, ICOL, X, IERR)
      CALL WANTED('TRBOPS', IH, IERR, 5,
     1            'col(2) = 3 is not in 1 to 2')
      ICOL(2) = 2
      IROW(2) = 4
      CALL TRBOPM(IH, 2, 2, Y, IROW, ICOL, X, IERR)
      CALL EXPECT('TRBOPM, row', IERR .NE. 0 .AND. IERR .NE. 5)
      CALL TRBDEL(IH, IERR)
      END
