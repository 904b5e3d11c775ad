C SPDX-License-Identifier: BSD-3-Clause
C     TWO BLOCKS, ONE ON THE OTHER, ON A BELT THAT GOES TO AND FRO
C     (QUINN 2004, FIG. 10 AND 11), WITH THE INTEGRATOR RK45.
C     PRINTS THE STATE AT T = 60 AND ITS LARGEST ERROR, FOR EPSILON
C     1D-2, 1D-3 AND 1D-4.
      PROGRAM BELT
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=4, NC=2)
      EXTERNAL FCN
      DIMENSION Y(N), YEXACT(N), WORK(N,9), IWORK(3), RPAR(2), IPAR(2)
      DIMENSION FMUN(NC), R(NC,NC)
      CHARACTER*80 TEXT
      DATA FMUN /0.5D0, 0.25D0/
      DATA R /1D0, -1D0, -1D0, 2D0/
      DATA YEXACT /-0.9541857100410D0, -0.1323742578991D0,
     1             -0.109011134358D0, -0.109011134358D0/
C     STIFFNESS OF THE UPPER SPRING, FREQUENCY OF THE BELT
      DATA RPAR /2D0, 0.5D0/
C     TWO CONTACTS: LOWER BLOCK ON BELT, UPPER ON LOWER BLOCK
      CALL TRBNEW(NC, IH, IERR)
      IF (IERR .EQ. 0) CALL TRBLIM(IH, NC, FMUN, IERR)
      IF (IERR .EQ. 0) CALL TRBOPF(IH, NC, R, NC, IERR)
      IPAR(1) = IH
      DO 30 K = 1, 3
         EPS = 10D0**(-K-1)
         IF (IERR .EQ. 0) CALL TRBEP1(IH, EPS, IERR)
         IPAR(2) = IERR
         DO 10 I = 1, N
   10       Y(I) = 0D0
         T = 0D0
         H = 1D-3
         IWORK(1) = 1000000
         CALL RK45(N, FCN, T, Y, 60D0, 1D-9, 1D-9, H, WORK, IWORK, RPAR,
     1             IPAR, IDID)
         IERR = IPAR(2)
         IF (IERR .NE. 0) GOTO 40
         IF (IDID .NE. 1) GOTO 50
         ERR = 0D0
         DO 20 I = 1, N
   20       ERR = DMAX1(ERR, DABS(Y(I) - YEXACT(I)))
   30    WRITE (6,600) K, EPS, (K, I, Y(I), I = 1, N), K, ERR,
     1                 K, IWORK(2)
      CALL TRBDEL(IH, IERR)
      STOP
   40 CALL TRBMSG(IH, TEXT, IERR)
      WRITE (6,*) IERR, TEXT
      STOP 1
   50 WRITE (6,*) 'RK45 STOPPED AT T =', T, ', IDID =', IDID
      STOP 1
  600 FORMAT ('rk45.epsilon', I1, 1PE16.1/
     1        4('rk45.y', I1, '.', I1, 0PF22.12/),
     2        'rk45.error', I1, 1PE20.3/
     3        'rk45.steps', I1, I20)
      END
C
C     Y: POSITIONS OF THE BLOCKS, VELOCITIES.  IPAR(1) IS THE HANDLE OF
C     THE CONTACTS, IPAR(2) ITS FIRST ERROR.
      SUBROUTINE FCN(N, T, Y, F, RPAR, IPAR)
      IMPLICIT REAL*8 (A-H,O-Z)
      DIMENSION Y(N), F(N), RPAR(2), IPAR(2)
      DIMENSION VREL(2), AREL(2), FEQ(2), FR(2)
      S1 = -Y(1)
      S2 = -RPAR(1)*Y(2)
      VREL(1) = Y(3) - DSIN(RPAR(2)*T)
      VREL(2) = Y(4) - Y(3)
      AREL(1) = S1 - RPAR(2)*DCOS(RPAR(2)*T)
      AREL(2) = S2 - S1
      IF (IPAR(2) .EQ. 0)
     1   CALL TRBBAL(IPAR(1), 2, VREL, AREL, FEQ, FR, IPAR(2))
      F(1) = Y(3)
      F(2) = Y(4)
      F(3) = S1 + FR(1) - FR(2)
      F(4) = S2 + FR(2)
      RETURN
      END
