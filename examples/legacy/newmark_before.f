C SPDX-License-Identifier: BSD-3-Clause
C     FORCED VIBRATION OF A STRUCTURE ON A ROUGH FLOOR, STEP BY STEP BY
C     NEWMARK'S METHOD, BETA = 0, GAMMA = 1/2 (EXPLICIT).  DATA OF A
C     CHAIN OF BLOCKS THE FIRST OF WHICH IS SHAKEN, WITH THREE STEPS.
C     PRINTS THE STEP, THE ENERGY THAT FRICTION TAKES IN CYCLE 4, AND
C     THE RELATIVE ERROR OF THAT.
      PROGRAM NEWMRK
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (NMAX=100, DEXACT=0.0104949600025D0)
      COMMON /STRUC/ XM(NMAX), XK(NMAX,3), FMU(NMAX), N
      COMMON /LOAD/ ALPHA, OMEGA
      COMMON /MOTION/ U(NMAX), V(NMAX), A(NMAX), R(NMAX), F(NMAX)
      COMMON /TIME/ DT, T, WORK
      CALL INPUT
      DO 20 K = 1, 3
         NSTEP = 126*10**K
         DT = 8D0*DATAN(1D0)/OMEGA/NSTEP
         CALL START
         DO 10 ICYC = 1, 4
            BEFORE = WORK
            DO 10 I = 1, NSTEP
   10          CALL STEP
         D = WORK - BEFORE
   20    WRITE (6,600) K, DT, K, D, K, DABS(D/DEXACT - 1D0)
      STOP
  600 FORMAT ('newmark.before.dt', I1, F20.12/
     1        'newmark.before.D', I1, F21.15/
     2        'newmark.before.error', I1, 1PE13.3)
      END
C
C     N BLOCKS WITH MASS, LIMIT OF FRICTION, STIFFNESS (THREE DIAGONALS)
      SUBROUTINE INPUT
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (NMAX=100)
      COMMON /STRUC/ XM(NMAX), XK(NMAX,3), FMU(NMAX), N
      COMMON /LOAD/ ALPHA, OMEGA
      N = 32
      ALPHA = 0.25D0
      OMEGA = 0.5D0
      DO 10 I = 1, N
         XM(I) = 1D0/N
         FMU(I) = 1D0/N
         XK(I,1) = -N
         XK(I,2) = 2*N
   10    XK(I,3) = -N
      XK(1,1) = 0D0
      XK(1,2) = N
      XK(N,1) = -4D0*N/3D0
      XK(N,2) = 4*N
      XK(N,3) = 0D0
      RETURN
      END
C
C     AT REST
      SUBROUTINE START
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (NMAX=100)
      COMMON /STRUC/ XM(NMAX), XK(NMAX,3), FMU(NMAX), N
      COMMON /MOTION/ U(NMAX), V(NMAX), A(NMAX), R(NMAX), F(NMAX)
      COMMON /TIME/ DT, T, WORK
      T = 0D0
      WORK = 0D0
      DO 10 I = 1, N
         U(I) = 0D0
         V(I) = 0D0
   10    A(I) = 0D0
      RETURN
      END
C
C     LOAD LESS SPRING FORCES
      SUBROUTINE RESID
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (NMAX=100)
      COMMON /STRUC/ XM(NMAX), XK(NMAX,3), FMU(NMAX), N
      COMMON /LOAD/ ALPHA, OMEGA
      COMMON /MOTION/ U(NMAX), V(NMAX), A(NMAX), R(NMAX), F(NMAX)
      COMMON /TIME/ DT, T, WORK
      R(1) = -XK(1,2)*U(1) - XK(1,3)*U(2)
      DO 10 I = 2, N - 1
   10    R(I) = -XK(I,1)*U(I-1) - XK(I,2)*U(I) - XK(I,3)*U(I+1)
      R(N) = -XK(N,1)*U(N-1) - XK(N,2)*U(N)
      R(1) = R(1) + ALPHA*DSIN(OMEGA*T)
      RETURN
      END
C
C     ONE STEP: PREDICTOR, FORCES, CORRECTOR
      SUBROUTINE STEP
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (NMAX=100)
      COMMON /STRUC/ XM(NMAX), XK(NMAX,3), FMU(NMAX), N
      COMMON /MOTION/ U(NMAX), V(NMAX), A(NMAX), R(NMAX), F(NMAX)
      COMMON /TIME/ DT, T, WORK
      T = T + DT
      DO 10 I = 1, N
         U(I) = U(I) + DT*(V(I) + 0.5D0*DT*A(I))
   10    V(I) = V(I) + 0.5D0*DT*A(I)
      CALL RESID
      CALL FRICT
      DO 20 I = 1, N
         A(I) = (R(I) + F(I))/XM(I)
         V(I) = V(I) + 0.5D0*DT*A(I)
   20    WORK = WORK - DT*F(I)*V(I)
      RETURN
      END
C
C     FRICTION FORCES, SMOOTHED OVER A SMALL VELOCITY VS
      SUBROUTINE FRICT
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (NMAX=100)
      COMMON /STRUC/ XM(NMAX), XK(NMAX,3), FMU(NMAX), N
      COMMON /MOTION/ U(NMAX), V(NMAX), A(NMAX), R(NMAX), F(NMAX)
      COMMON /TIME/ DT, T, WORK
      VS = DT
      DO 10 I = 1, N
   10    F(I) = -FMU(I)*DTANH(V(I)/VS)
      RETURN
      END
