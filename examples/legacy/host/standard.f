C SPDX-License-Identifier: BSD-3-Clause
C     CALLS FRIC AS ABAQUS/STANDARD DOES, FROM THE NEWTON ITERATIONS OF
C     AN IMPLICIT ANALYSIS (HILBER, HUGHES AND TAYLOR, ALPHA = -0.05).
C     A MASS ON A SPRING SLIDES AND STICKS ON A FOUNDATION, THE
C     OSCILLATOR OF QUINN (2004), FIG. 7A.  FOR THREE INCREMENTS, WITH
C     THE MASS IN PROPS(3) AND WITHOUT IT, EACH WITH THE EPSILON THAT
C     SUITS IT, PRINTS
C        D      ENERGY THAT FRICTION TAKES IN CYCLE 50, AND ITS ERROR
C        FORCE  ERROR OF THE FORCE WHILE THE CONTACT STICKS, MEAN OVER
C               TIME, IN UNITS OF THE LIMIT
C     AND THE LARGEST RELATIVE ERROR OF DDTDDG AND DDTDDP.
      PROGRAM HOST
      INCLUDE 'ABA_PARAM.INC'
      PARAMETER (DEXACT=7.18924625072D0)
      CHARACTER*7 WHAT(2)
      DIMENSION PROPS(3)
      DATA WHAT /'mass', 'without'/
      DO 10 M = 1, 2
         DO 10 K = 1, 3
            NINC = 126*10**(K-1)
            DTIME = 16D0*DATAN(1D0)/NINC
            PROPS(1) = 0.5D0
            PROPS(2) = 4D0*DTIME
            IF (M .EQ. 2) PROPS(2) = DTIME
            PROPS(3) = 2 - M
            CALL RUN(NINC, DTIME, PROPS, D, FORCE, XITER)
            L = INDEX(WHAT(M)//' ', ' ') - 1
   10       WRITE (6,600) WHAT(M)(1:L), K, DTIME, WHAT(M)(1:L), K, D,
     1         WHAT(M)(1:L), K, DABS(D/DEXACT - 1D0),
     2         WHAT(M)(1:L), K, FORCE, WHAT(M)(1:L), K, XITER
      CALL CHECK
  600 FORMAT ('fric.', A, '.dt', I1, F14.6/'fric.', A, '.D', I1, F19.11/
     1        'fric.', A, '.error', I1, 1PE13.3/
     2        'fric.', A, '.force', I1, 1PE13.3/
     3        'fric.', A, '.iterations', I1, 0PF6.2)
      END
C
C     50 CYCLES OF NINC INCREMENTS
      SUBROUTINE RUN(NINC, DTIME, PROPS, D, FORCE, XITER)
      INCLUDE 'ABA_PARAM.INC'
      PARAMETER (XMASS=1D0, STIFF=1D0, PRESS=2D0, TOL=1D-9)
      PARAMETER (ALPHA=-0.05D0, BETA=(1D0-ALPHA)**2/4D0)
      PARAMETER (GAMMA=0.5D0-ALPHA)
      DIMENSION PROPS(3), STATEV(2), SOLD(2)
      X = 0D0
      V = 0D0
      A = 0D0
      G = 0D0
      TOLD = 0D0
      SOLD(1) = 0D0
      SOLD(2) = 0D0
      WORK = 0D0
      STUCK = 0D0
      FORCE = 0D0
      ITER = 0
      DO 40 ICYC = 1, 50
         D = WORK
         DO 40 KINC = 1, NINC
            P = 1.5D0*DSIN(0.5D0*(KINC + (ICYC-1)*NINC)*DTIME)
            ANEW = A
            DO 10 K = 1, 20
               DGAM = DTIME*(V + DTIME*((0.5D0-BETA)*A + BETA*ANEW))
               STATEV(1) = SOLD(1)
               STATEV(2) = SOLD(2)
               TAU = TOLD
               CALL CONTCT(TAU,STIF,DTDP,STATEV,DGAM,PRESS,DTIME,PROPS)
               ITER = ITER + 1
               GNEW = STIFF*(X + DGAM) + TAU - P
               RES = XMASS*ANEW + (1D0+ALPHA)*GNEW - ALPHA*G
               IF (DABS(RES) .LT. TOL) GOTO 20
   10          ANEW = ANEW - RES/
     1            (XMASS + (1D0+ALPHA)*BETA*DTIME**2*(STIFF + STIF))
            WRITE (6,*) 'NO CONVERGENCE IN CYCLE', ICYC, ' INC', KINC
            STOP 1
   20       X = X + DGAM
            V = V + DTIME*((1D0-GAMMA)*A + GAMMA*ANEW)
            A = ANEW
            G = GNEW
            SOLD(1) = STATEV(1)
            SOLD(2) = STATEV(2)
            WORK = WORK + 0.5D0*(TOLD + TAU)*DGAM
            TOLD = TAU
            IF (DABS(P - STIFF*X) .GT. PROPS(1)*PRESS) GOTO 40
            IF (DABS(DGAM) .GT. PROPS(2)*DTIME) GOTO 40
            STUCK = STUCK + 1D0
            FORCE = FORCE + DABS(TAU - P + STIFF*X)/(PROPS(1)*PRESS)
   40 CONTINUE
      D = WORK - D
      FORCE = FORCE/STUCK
      XITER = ITER/(50D0*NINC)
      RETURN
      END
C
C     ONE CALL OF FRIC, FOR A CONTACT THAT WAS CLOSED AND SLIPPED
      SUBROUTINE CONTCT(TAU,STIF,DTDP,STATEV,DGAM,PRESS,DTIME,PROPS)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 BLANK
      DIMENSION STATEV(2), PROPS(3), ZERO(4)
      DATA BLANK /' '/, ZERO /4*0D0/
      LM = 0
      CALL FRIC(LM,TAU,STIF,DTDP,ZERO,0D0,0D0,
     1 ZERO,1D0,STATEV,DGAM,ZERO,PRESS,0D0,0D0,ZERO,
     2 1,1,ZERO,DTIME,1,BLANK,BLANK,BLANK,1,1,
     3 1,ZERO,ZERO,ZERO,ZERO,ZERO,1,2,1,
     4 2,1D0,PROPS,3)
      RETURN
      END
C
C     DDTDDG AND DDTDDP AGAINST DIFFERENCES: STICKING, STICKING WITH A
C     FORCE BEYOND THE LIMIT, SLIDING
      SUBROUTINE CHECK
      INCLUDE 'ABA_PARAM.INC'
      PARAMETER (DTIME=0.01D0, PRESS=2D0, H=1D-6)
      DIMENSION PROPS(3), T(4), G(4), TAU(5), X(2), Y(2)
      DATA PROPS /0.5D0, 0.04D0, 1D0/
      DATA T /0.3D0, -0.6D0, 0.9D0, 0.2D0/
      DATA G /1D-5, 5D-5, -1.5D-4, 9D-4/
      ERRG = 0D0
      ERRP = 0D0
      DO 20 K = 1, 4
         DO 10 L = 1, 5
            TAU(L) = T(K)
            X(1) = 0.1D0
            X(2) = 0.2D0*K
            DG = 0D0
            DP = 0D0
            IF (L .EQ. 2) DG = H*DTIME
            IF (L .EQ. 3) DG = -H*DTIME
            IF (L .EQ. 4) DP = H
            IF (L .EQ. 5) DP = -H
            CALL CONTCT(TAU(L), SG, SP, X, G(K) + DG, PRESS + DP, DTIME,
     1                  PROPS)
            IF (L .GT. 1) GOTO 10
            Y(1) = SG
            Y(2) = SP
   10    CONTINUE
         DG = (TAU(2) - TAU(3))/(2D0*H*DTIME)
         DP = (TAU(4) - TAU(5))/(2D0*H)
         WRITE (6,600) K, Y(1), DG, Y(2), DP
         ERRG = DMAX1(ERRG, DABS(DG - Y(1))/DMAX1(1D0, DABS(DG)))
   20    ERRP = DMAX1(ERRP, DABS(DP - Y(2))/DMAX1(1D0, DABS(DP)))
      WRITE (6,610) ERRG, ERRP
      RETURN
  600 FORMAT ('# STATE', I2, ': DDTDDG', 2F12.5, ', DDTDDP', 2F10.6)
  610 FORMAT ('fric.ddtddg', 1PE12.2/'fric.ddtddp', E12.2)
      END
C
      SUBROUTINE XIT
      STOP 1
      END
