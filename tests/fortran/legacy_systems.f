C SPDX-License-Identifier: BSD-3-Clause
C     Structures and their periodic motions from fixed form: every result
C     compared to that of the C call (legacy_systems.c), then the errors.
      PROGRAM LEGSYS
      INTEGER NALIVE
      EXTERNAL NALIVE
      CALL SYPLAY
      CALL STRUCT(.FALSE.)
      CALL STRUCT(.TRUE.)
      CALL SCEND
      CALL CREATE
      CALL NODRIV
      CALL WRONG
      CALL EXPECT('all deleted', NALIVE() .EQ. 0)
      CALL REPORT_ALL
      END
C
C     The structure, its matrices in corners of bigger ones; IERR of
C     everything up to here.
      SUBROUTINE BUILD(DAMPED, IH, IERR)
      INTEGER IH, IERR, I, J
      LOGICAL DAMPED
      DOUBLE PRECISION RM(3,2), C(3,2), RK(3,2), RJ(4,2), F(2)
      CHARACTER*80 TEXT
      DATA RM /1D0, 0D0, -9D0, 0D0, 2D0, -9D0/
      DATA RK /3D0, -1D0, -9D0, -1D0, 2D0, -9D0/
      DATA RJ /1D0, -1D0, -9D0, -9D0, 0D0, 1D0, -9D0, -9D0/
      DATA F /0.3D0, 0.2D0/
      DO 20 J = 1, 2
         DO 10 I = 1, 3
            C(I,J) = 0D0
   10    CONTINUE
         C(3,J) = -9D0
   20 CONTINUE
      IF (DAMPED) THEN
         C(1,1) = 0.3D0
         C(2,1) = -0.1D0
         C(1,2) = -0.1D0
         C(2,2) = 0.1D0
      END IF
      TEXT = 'as it was'
      CALL TRBLIN(2, 2, RM, C, RK, 3, RJ, 4, IH, TEXT, IERR)
      CALL EXPECT('TRBLIN', IERR .EQ. 0 .AND. TEXT .EQ. 'as it was')
      CALL TRBLIM(IH, 2, F, IERR)
      END
C
      SUBROUTINE STRUCT(DAMPED)
      LOGICAL DAMPED
      INTEGER IH, IERR, I
      DOUBLE PRECISION PC(2), PS(2), BC(2), Z(2), S(2), Y(5), T(1)
      DATA PC /1D0, -0.5D0/, PS /0.2D0, 0.7D0/, BC /0.1D0, 0D0/
      DATA Z /0D0, 0D0/, S /0.05D0, 0D0/
      CALL BUILD(DAMPED, IH, IERR)
      IF (IERR .EQ. 0) CALL TRBLOD(IH, 2, 0.8D0, PS, PC, IERR)
      IF (IERR .EQ. 0) CALL TRBCLL(IH, IERR)
      IF (IERR .EQ. 0) CALL TRBLOD(IH, 2, 0.8D0, PC, PS, IERR)
      IF (IERR .EQ. 0) CALL TRBBAS(IH, 2, 0.8D0, BC, Z, IERR)
      IF (IERR .EQ. 0) CALL TRBHLM(IH, 2, 1.6D0, Z, S, IERR)
      IF (IERR .EQ. 0) CALL TRBDRV(IH, 'event', 0.1D0, 1D-9, 1D-9, IERR)
      DO 10 I = 1, 5
         Y(I) = 0D0
   10 CONTINUE
      CALL PERIOD(IH, Y)
      CALL TRBDRV(IH, 'Exact ', 0.1D0, 0D0, 0D0, IERR)
      CALL PERIOD(IH, Y)
      T(1) = 0.5D0
      CALL TRBADV(IH, 2, T(1), 3D0, Y, IERR)
      CALL CMPI('TRBADV', IERR)
      CALL CMPR('TRBADV', 1, T)
      CALL CMPR('TRBADV', 5, Y)
      CALL TRBDEL(IH, IERR)
      CALL EXPECT('TRBDEL', IERR .EQ. 0)
      END
C
      SUBROUTINE PERIOD(IH, Y)
      INTEGER IH, IERR, I, KIND(2), INDX(2)
      DOUBLE PRECISION Y(5), CV(4), RE(4), AI(4), X(4), E(2), DX(4)
      DOUBLE PRECISION DY(10)
      DATA CV /1D0, -0.5D0, 0.25D0, 0D0/
      DATA KIND, INDX /0, 2, 2, 1/
      CALL TRBPER(IH, 2, 0.5D0, 7.853981633974483D0, Y, IERR)
      CALL CMPI('TRBPER', IERR)
      CALL CMPR('TRBPER', 5, Y)
      CALL TRBMUL(IH, 2, RE, AI, IERR)
      CALL CMPR('TRBMUL', 4, RE)
      CALL CMPR('TRBMUL', 4, AI)
      CALL TRBEXT(IH, 2, CV, X(1), X(2), X(3), X(4), IERR)
      CALL CMPR('TRBEXT', 4, X)
      CALL TRBHAR(IH, 2, CV, 3, X(1), X(2), IERR)
      CALL CMPR('TRBHAR', 2, X)
      CALL TRBDIS(IH, 2, E, IERR)
      CALL CMPR('TRBDIS', 2, E)
      CALL TRBSHS(IH, 2, E, IERR)
      CALL CMPR('TRBSHS', 2, E)
      CALL TRBDEX(IH, 2, 2, KIND, INDX, CV, DX, IERR)
      CALL CMPI('TRBDEX', IERR)
      CALL CMPR('TRBDEX', 4, DX)
      CALL TRBDEY(IH, 2, 2, KIND, INDX, DY, 5, IERR)
      CALL CMPI('TRBDEY', IERR)
      CALL CMPR('TRBDEY', 10, DY)
      CALL TRBDEN(IH, 2, 2, KIND, INDX, DX, IERR)
      CALL CMPI('TRBDEN', IERR)
      CALL TRBDML(IH, 2, 2, 2, KIND, INDX, RE, AI, IERR)
      CALL CMPI('TRBDML', IERR)
      CALL CMPR('TRBDML', 2, RE)
      CALL CMPR('TRBDML', 2, AI)
      CALL TRBRNG(IH, 2, 1, IERR)
      CALL CMPI('TRBRNG', IERR)
      CALL TRBPER(IH, 2, 0.5D0, 7.853981633974483D0, Y, IERR)
      CALL CMPI('TRBPER', IERR)
      CALL TRBRNG(IH, 0, 0, IERR)
      CALL CMPI('TRBRNG', IERR)
      CALL TRBDCT(IH, 105, I, IERR)
      CALL CMPI('TRBDCT', I)
      END
C
C     Nothing is made of what is wrong, and the handle stays as it was.
      SUBROUTINE CREATE
      INTEGER IH, IERR
      DOUBLE PRECISION ONE(1), BAD(1)
      CHARACTER*80 TEXT
      DATA ONE /1D0/, BAD /-1D0/
      IH = -777
      CALL TRBLIN(-1, 1, ONE, ONE, ONE, 1, ONE, 1, IH, TEXT, IERR)
      CALL SAYS('NDOF', IERR, 6, TEXT, 'NDOF = -1 is less than 0')
      CALL TRBLIN(1, -2, ONE, ONE, ONE, 1, ONE, 1, IH, TEXT, IERR)
      CALL SAYS('N', IERR, 6, TEXT, 'N = -2 is less than 0')
      CALL TRBLIN(1, 1, ONE, ONE, ONE, 0, ONE, 1, IH, TEXT, IERR)
      CALL SAYS('LDM', IERR, 6, TEXT, 'LDM = 0 is less than 1')
      CALL TRBLIN(1, 1, ONE, ONE, ONE, 1, ONE, 0, IH, TEXT, IERR)
      CALL SAYS('LDJ', IERR, 6, TEXT, 'LDJ = 0 is less than 1')
      CALL TRBLIN(1, 1, BAD, ONE, ONE, 1, ONE, 1, IH, TEXT, IERR)
      CALL EXPECT('mass', IERR .NE. 0 .AND. TEXT .NE. ' ')
      CALL EXPECT('no handle', IH .EQ. -777)
      END
C
C     Every routine with what is no handle, with one of contacts alone,
C     and, if it works on a driver, without one.
      SUBROUTINE NODRIV
      INTEGER IHS(3), ICODE(3), IH, K, IERR, I, M(1)
      DOUBLE PRECISION X(5)
      CHARACTER*80 TEXT(3)
      IHS(1) = 12345
      CALL TRBNEW(2, IHS(2), IERR)
      CALL BUILD(.TRUE., IHS(3), IERR)
      ICODE(1) = 1
      ICODE(2) = 8
      ICODE(3) = 8
      TEXT(1) = 'IH = 12345 is no handle: it was never given, or has '//
     1          'been deleted'
      TEXT(2) = 'IH has contacts only: TRBLIN makes a structure'
      TEXT(3) = 'IH has no integrator: call TRBDRV first'
      DO 10 I = 1, 5
         X(I) = -777D0
   10 CONTINUE
      I = -777
      DO 20 K = 1, 3
         IH = IHS(K)
         IF (K .LT. 3) THEN
            CALL TRBLOD(IH, 2, 1D0, X, X, IERR)
            CALL WANTED('TRBLOD', IH, IERR, ICODE(K), TEXT(K))
            CALL TRBCLL(IH, IERR)
            CALL WANTED('TRBCLL', IH, IERR, ICODE(K), TEXT(K))
            CALL TRBBAS(IH, 2, 1D0, X, X, IERR)
            CALL WANTED('TRBBAS', IH, IERR, ICODE(K), TEXT(K))
            CALL TRBHLM(IH, 2, 1D0, X, X, IERR)
            CALL WANTED('TRBHLM', IH, IERR, ICODE(K), TEXT(K))
            CALL TRBDRV(IH, 'exact', 1D0, 0D0, 0D0, IERR)
            CALL WANTED('TRBDRV', IH, IERR, ICODE(K), TEXT(K))
         END IF
         CALL TRBADV(IH, 2, X(1), 1D0, X, IERR)
         CALL WANTED('TRBADV', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBPER(IH, 2, 0D0, 1D0, X, IERR)
         CALL WANTED('TRBPER', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBRNG(IH, 2, 1, IERR)
         CALL WANTED('TRBRNG', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBMUL(IH, 2, X, X, IERR)
         CALL WANTED('TRBMUL', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBEXT(IH, 2, X, X(1), X(2), X(3), X(4), IERR)
         CALL WANTED('TRBEXT', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBHAR(IH, 2, X, 1, X(1), X(2), IERR)
         CALL WANTED('TRBHAR', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBDIS(IH, 2, X, IERR)
         CALL WANTED('TRBDIS', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBSHS(IH, 2, X, IERR)
         CALL WANTED('TRBSHS', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBDEX(IH, 2, 1, M, M, X, X, IERR)
         CALL WANTED('TRBDEX', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBDEN(IH, 2, 1, M, M, X, IERR)
         CALL WANTED('TRBDEN', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBDEY(IH, 2, 1, M, M, X, 5, IERR)
         CALL WANTED('TRBDEY', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBDML(IH, 2, 1, 1, M, M, X, X, IERR)
         CALL WANTED('TRBDML', IH, IERR, ICODE(K), TEXT(K))
         CALL TRBDCT(IH, 100, I, IERR)
         CALL WANTED('TRBDCT', IH, IERR, ICODE(K), TEXT(K))
   20 CONTINUE
      DO 30 K = 1, 5
         CALL EXPECT('untouched', X(K) .EQ. -777D0 .AND. I .EQ. -777)
   30 CONTINUE
      CALL TRBDEL(IHS(2), IERR)
      CALL TRBDEL(IHS(3), IERR)
      END
C
C     Sizes that are not those of the structure, what the library finds,
C     and copies, which have contacts alone.
      SUBROUTINE WRONG
      INTEGER IH, IERR, IH2
      DOUBLE PRECISION Y(7), R(2)
      DATA Y /7*0D0/, R /1D0, 1D0/
      CALL BUILD(.TRUE., IH, IERR)
      CALL TRBDRV(IH, 'rk5', 0.1D0, 0D0, 0D0, IERR)
      CALL EXPECT('TRBDRV', IERR .EQ. 7)
      CALL TRBDRV(IH, 'rk4/fixed', 0.1D0, 1D-9, 1D-9, IERR)
      CALL WANTED('TRBDRV', IH, IERR, 9, 'method rk4/fixed takes no '//
     1  'tolerance; event, auto and GSL''s adaptive methods do')
      CALL TRBDRV(IH, 'event', 0.1D0, 0D0, 1D-9, IERR)
      CALL WANTED('TRBDRV', IH, IERR, 4, 'abstol = 0 is not positive')
      CALL TRBDRV(IH, 'exact', 0.1D0, 0D0, 0D0, IERR)
      CALL TRBPER(IH, 3, 0D0, 1D0, Y, IERR)
      CALL WANTED('TRBPER', IH, IERR, 6,
     1            'NDOF = 3, but the degrees of freedom are 2')
      CALL TRBLOD(IH, 1, 1D0, Y, Y, IERR)
      CALL WANTED('TRBLOD', IH, IERR, 6,
     1  'NFULL = 1, but the degrees of freedom of the matrices are 2')
      CALL TRBDIS(IH, 1, Y, IERR)
      CALL WANTED('TRBDIS', IH, IERR, 6,
     1            'N = 1, but the number of contacts is 2')
      CALL TRBPER(IH, 2, 0D0, -1D0, Y, IERR)
      CALL WANTED('TRBPER', IH, IERR, 4, 'period = -1 is not positive')
      CALL TRBDIS(IH, 2, Y, IERR)
      CALL EXPECT('TRBDIS of nothing', IERR .EQ. 8)
      CALL TRBOPD(IH, 2, R, IERR)
      CALL EXPECT('the operator stays', IERR .NE. 0)
      CALL TRBCPY(IH, IH2, IERR)
      CALL TRBCLL(IH2, IERR)
      CALL WANTED('copy', IH2, IERR, 8,
     1            'IH has contacts only: TRBLIN makes a structure')
      CALL TRBDEL(IH2, IERR)
      CALL TRBDEL(IH, IERR)
      CALL TRBCLL(IH, IERR)
      CALL EXPECT('a deleted structure', IERR .EQ. 1)
      END
