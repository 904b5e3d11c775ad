C SPDX-License-Identifier: BSD-3-Clause
C     THE CHAIN OF NEWMARK_AFTER.F BY NEWMARK'S METHOD OF AVERAGE
C     ACCELERATION, BETA = 1/4, GAMMA = 1/2: IMPLICIT, EACH STEP SOLVED
C     BY NEWTON'S METHOD WITH THE TANGENTS OF THE FRICTION FORCES.
C     PRINTS THE ENERGY THAT FRICTION TAKES IN CYCLE 4 FOR FIVE STEPS;
C     THEN HOW NEWTON'S METHOD CONVERGES WHEN SPRINGS TO THE FLOOR,
C     CUB*U**3, ARE ADDED.
      PROGRAM NEWIMP
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (NMAX=32, DEXACT=0.0104949600025D0)
      COMMON /STRUC/ XM(NMAX), XK(NMAX,3), FMU(NMAX), CUB, N
      COMMON /LOAD/ ALPHA, OMEGA
      COMMON /MOTION/ U(NMAX), V(NMAX), A(NMAX), R(NMAX), F(NMAX)
      COMMON /TIME/ DT, T, WORK
      COMMON /NEWTON/ RES(0:30), NITER
      COMMON /TRIBO/ IH, IERR
      DIMENSION MODE(NMAX)
      CALL INPUT
      DO 20 K = 1, 5
         NSTEP = 250*2**K
         ITER = 0
         CALL START(NSTEP)
         DO 10 ICYC = 1, 4
            BEFORE = WORK
            DO 10 I = 1, NSTEP
               CALL STEP
   10          ITER = ITER + NITER
         D = WORK - BEFORE
   20    WRITE (6,600) K, DT, K, D, K, DABS(D/DEXACT - 1D0),
     1                 K, ITER/(4D0*NSTEP)
C     THE FIRST STEP THAT HAS EVERY CONTACT INSIDE ITS STICK BAND FROM
C     BEGINNING TO END, AND THE FIRST ONE THAT TAKES FOUR ITERATIONS
      CUB = 1D4
      NSTEP = 126
      CALL START(NSTEP)
      LBAND = 0
      LSLIDE = 0
      MOST = 0
      DO 60 I = 1, 4*NSTEP
         CALL STEP
         MOST = MAX0(MOST, NITER)
         IF (LBAND .NE. 0 .OR. NITER .NE. 1) GOTO 50
         CALL TRBSLP(IH, N, MODE, IERR)
         DO 40 J = 1, N
   40       IF (MODE(J) .NE. 0) GOTO 50
         LBAND = I
         WRITE (6,610) (J, RES(J), J = 0, NITER)
   50    IF (LSLIDE .NE. 0 .OR. NITER .NE. 4) GOTO 60
         LSLIDE = I
         WRITE (6,620) (J, RES(J), J = 0, NITER)
         WRITE (6,630) DLOG(RES(3)/RES(2))/DLOG(RES(2)/RES(1))
   60 CONTINUE
      WRITE (6,640) MOST
      CALL TRBDEL(IH, IERR)
      STOP
  600 FORMAT ('newmark.implicit.dt', I1, F20.12/
     1        'newmark.implicit.D', I1, F21.15/
     2        'newmark.implicit.error', I1, 1PE13.3/
     3        'newmark.implicit.iterations', I1, 0PF8.2)
  610 FORMAT ('newmark.implicit.band.residual', I1, 1PE10.1)
  620 FORMAT ('newmark.implicit.slide.residual', I1, 1PE10.1)
  630 FORMAT ('newmark.implicit.slide.order', F8.2)
  640 FORMAT ('newmark.implicit.iterations.most', I3)
      END
C
      SUBROUTINE INPUT
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (NMAX=32)
      COMMON /STRUC/ XM(NMAX), XK(NMAX,3), FMU(NMAX), CUB, N
      COMMON /LOAD/ ALPHA, OMEGA
      COMMON /TRIBO/ IH, IERR
      DIMENSION RINV(NMAX)
      N = 32
      ALPHA = 0.25D0
      OMEGA = 0.5D0
      CUB = 0D0
      DO 10 I = 1, N
         XM(I) = 1D0/N
         RINV(I) = 1D0/XM(I)
         FMU(I) = 1D0/N
         XK(I,1) = -N
         XK(I,2) = 2*N
   10    XK(I,3) = -N
      XK(1,1) = 0D0
      XK(1,2) = N
      XK(N,1) = -4D0*N/3D0
      XK(N,2) = 4*N
      XK(N,3) = 0D0
      CALL TRBNEW(N, IH, IERR)
      IF (IERR .EQ. 0) CALL TRBLIM(IH, N, FMU, IERR)
      IF (IERR .EQ. 0) CALL TRBOPD(IH, N, RINV, IERR)
      RETURN
      END
C
C     AT REST.  WITH LAMBDA*DT = 2 A STICKING CONTACT COMES TO REST IN
C     TWO STEPS OF THIS METHOD; FAR BEYOND, IT WOULD GO ON RINGING.
      SUBROUTINE START(NSTEP)
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (NMAX=32)
      COMMON /STRUC/ XM(NMAX), XK(NMAX,3), FMU(NMAX), CUB, N
      COMMON /LOAD/ ALPHA, OMEGA
      COMMON /MOTION/ U(NMAX), V(NMAX), A(NMAX), R(NMAX), F(NMAX)
      COMMON /TIME/ DT, T, WORK
      COMMON /TRIBO/ IH, IERR
      T = 0D0
      WORK = 0D0
      DO 10 I = 1, N
         U(I) = 0D0
         V(I) = 0D0
   10    A(I) = 0D0
      DT = 8D0*DATAN(1D0)/OMEGA/NSTEP
      IF (IERR .EQ. 0) CALL TRBSTP(IH, DT, 2D0, IERR)
      RETURN
      END
C
C     ONE STEP: PREDICTOR, THEN NEWTON'S METHOD FOR THE ACCELERATIONS.
C     RES(K) IS THE RESIDUAL AFTER K ITERATIONS, IN UNITS OF THE LIMIT
      SUBROUTINE STEP
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (NMAX=32, TOL=1D-11)
      COMMON /STRUC/ XM(NMAX), XK(NMAX,3), FMU(NMAX), CUB, N
      COMMON /MOTION/ U(NMAX), V(NMAX), A(NMAX), R(NMAX), F(NMAX)
      COMMON /TIME/ DT, T, WORK
      COMMON /NEWTON/ RES(0:30), NITER
      COMMON /SYSTEM/ XJ(NMAX,NMAX), G(NMAX)
      DIMENSION UP(NMAX), VP(NMAX), FOLD(NMAX), VOLD(NMAX)
      T = T + DT
      DO 10 I = 1, N
         FOLD(I) = F(I)
         VOLD(I) = V(I)
         UP(I) = U(I) + DT*(V(I) + 0.25D0*DT*A(I))
   10    VP(I) = V(I) + 0.5D0*DT*A(I)
      DO 40 NITER = 0, 30
         DO 20 I = 1, N
            U(I) = UP(I) + 0.25D0*DT**2*A(I)
   20       V(I) = VP(I) + 0.5D0*DT*A(I)
         CALL RESID
         RES(NITER) = 0D0
         DO 30 I = 1, N
   30       RES(NITER) = DMAX1(RES(NITER), DABS(G(I))/FMU(I))
         IF (RES(NITER) .LT. TOL) GOTO 50
         CALL SOLVE(N, NMAX, XJ, G)
         DO 40 I = 1, N
   40       A(I) = A(I) - G(I)
      WRITE (6,*) 'NEWTON''S METHOD DID NOT CONVERGE AT T =', T
      STOP 1
   50 DO 60 I = 1, N
   60    WORK = WORK - 0.5D0*DT*(FOLD(I)*VOLD(I) + F(I)*V(I))
      RETURN
      END
C
C     RESIDUAL G = M A - R - F, AND ITS DERIVATIVES XJ BY A; R IS LOAD
C     LESS SPRING FORCES, WITH STIFFNESS XT
      SUBROUTINE RESID
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (NMAX=32)
      COMMON /STRUC/ XM(NMAX), XK(NMAX,3), FMU(NMAX), CUB, N
      COMMON /LOAD/ ALPHA, OMEGA
      COMMON /MOTION/ U(NMAX), V(NMAX), A(NMAX), R(NMAX), F(NMAX)
      COMMON /TIME/ DT, T, WORK
      COMMON /SYSTEM/ XJ(NMAX,NMAX), G(NMAX)
      COMMON /TRIBO/ IH, IERR
      DIMENSION AFREE(NMAX), FEQ(NMAX), DFDV(NMAX,NMAX)
      DIMENSION DFDA(NMAX,NMAX), XT(NMAX,NMAX)
      CHARACTER*80 TEXT
      DO 10 J = 1, N
         DO 10 I = 1, N
   10       XT(I,J) = 0D0
      DO 20 I = 1, N
         XT(I,I) = XK(I,2) + 3D0*CUB*U(I)**2
         IF (I .EQ. N) GOTO 20
         XT(I,I+1) = XK(I,3)
         XT(I+1,I) = XK(I+1,1)
   20 CONTINUE
      DO 30 I = 1, N
   30    R(I) = 2D0*CUB*U(I)**3
      R(1) = R(1) + ALPHA*DSIN(OMEGA*T)
      DO 40 J = 1, N
         DO 40 I = 1, N
   40       R(I) = R(I) - XT(I,J)*U(J)
      DO 50 I = 1, N
   50    AFREE(I) = R(I)/XM(I)
      IF (IERR .EQ. 0) CALL TRBBTN(IH, N, V, AFREE, FEQ, F, DFDV, DFDA,
     1                             NMAX, IERR)
      IF (IERR .NE. 0) GOTO 90
      DO 70 J = 1, N
         DO 70 I = 1, N
            S = XT(I,J)
            DO 60 K = MAX0(1, J-1), MIN0(N, J+1)
   60          S = S + DFDA(I,K)/XM(K)*XT(K,J)
   70       XJ(I,J) = 0.25D0*DT**2*S - 0.5D0*DT*DFDV(I,J)
      DO 80 I = 1, N
         G(I) = XM(I)*A(I) - R(I) - F(I)
   80    XJ(I,I) = XJ(I,I) + XM(I)
      RETURN
   90 CALL TRBMSG(IH, TEXT, IERR)
      WRITE (6,*) IERR, TEXT
      STOP 1
      END
C
C     SOLVES A X = B BY ELIMINATION WITH ROW EXCHANGES.  X REPLACES B
      SUBROUTINE SOLVE(N, LDA, A, B)
      IMPLICIT REAL*8 (A-H,O-Z)
      DIMENSION A(LDA,N), B(N)
      DO 40 K = 1, N
         L = K
         DO 10 I = K, N
   10       IF (DABS(A(I,K)) .GT. DABS(A(L,K))) L = I
         DO 20 J = K, N
            S = A(L,J)
            A(L,J) = A(K,J)
   20       A(K,J) = S
         S = B(L)
         B(L) = B(K)
         B(K) = S
         DO 40 I = K + 1, N
            S = A(I,K)/A(K,K)
            DO 30 J = K + 1, N
   30          A(I,J) = A(I,J) - S*A(K,J)
   40       B(I) = B(I) - S*B(K)
      DO 60 K = N, 1, -1
         DO 50 J = K + 1, N
   50       B(K) = B(K) - A(K,J)*B(J)
   60    B(K) = B(K)/A(K,K)
      RETURN
      END
