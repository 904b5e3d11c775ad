C SPDX-License-Identifier: BSD-3-Clause
C     CALLS FRIC AS ABAQUS/STANDARD DOES, WITH SPRINGS THAT END IN A
C     SLIDER, UNDER A PRESSURE THAT THE MOTION MAKES AND THAT LIFTS OFF:
C        X'' + 0.1 SQRT(12) X' + 12 X + TAU = 60 COS 5T
C        Y'' + 2 Y' + 21 Y + P = 100 + 60 COS 5T, P = 21 MAX(Y, 0)
C     STIFFNESS 5, COEFFICIENT 0.85.  FOR THREE INCREMENTS PRINTS OF
C     THE LAST OF 60 PERIODS
C        MAX, MIN    EXTREMES OF X
C        D           ENERGY THAT FRICTION TAKES
C        OPEN        SHARE OF THE PERIOD WITHOUT CONTACT
C        ITERATIONS  OF NEWTON'S METHOD, WITH FRIC'S TANGENT, A STEP
C     AND THE LARGEST RELATIVE ERROR OF DDTDDG AND DDTDDP IN TWO
C     DIRECTIONS.
      PROGRAM HOST
      INCLUDE 'ABA_PARAM.INC'
      DO 10 K = 1, 3
         NINC = 100*10**K
         CALL RUN(NINC, XMAX, XMIN, D, OPEN, XITER)
   10    WRITE (6,600) K, XMAX, K, XMIN, K, D, K, OPEN, K, XITER
      CALL CHECK
  600 FORMAT ('lift.max', I1, F13.7/'lift.min', I1, F13.7/
     1        'lift.D', I1, F15.7/'lift.open', I1, F12.7/
     2        'lift.iterations', I1, F6.2)
      END
C
C     NEWMARK'S AVERAGE ACCELERATION
      SUBROUTINE RUN(NINC, XMAX, XMIN, D, OPEN, XITER)
      INCLUDE 'ABA_PARAM.INC'
      PARAMETER (XN=21D0, TOL=1D-9)
      DIMENSION C(2), S(2), CONST(2), PROPS(4), U(2), V(2), A(2), B(2),
     1 DU(2), TAU(1), STIF(1), DTDP(1), DGAM(1), R(2)
      DATA S /12D0, 21D0/, CONST /0D0, 100D0/
      DATA PROPS /0.85D0, 0D0, 0D0, 5D0/
      C(1) = 0.1D0*DSQRT(12D0)
      C(2) = 2D0
      DTIME = 8D0*DATAN(1D0)/5D0/NINC
      Q = 0.25D0*DTIME**2
      H = 0.5D0*DTIME
      DO 10 I = 1, 2
         U(I) = 0D0
         V(I) = 0D0
   10    A(I) = CONST(I) + 60D0
      TOLD = 0D0
      ITER = 0
      DO 60 IPER = 1, 60
         XMAX = -1D9
         XMIN = 1D9
         D = 0D0
         OPEN = 0D0
         DO 60 KINC = 1, NINC
            P = 60D0*DCOS(5D0*KINC*DTIME)
            B(1) = A(1)
            B(2) = A(2)
            DO 30 K = 1, 20
               DO 20 I = 1, 2
   20             DU(I) = DTIME*V(I) + Q*(A(I) + B(I))
               PRESS = XN*DMAX1(U(2) + DU(2), 0D0)
               DPDU = 0D0
               IF (PRESS .GT. 0D0) DPDU = XN
               TAU(1) = TOLD
               DGAM(1) = DU(1)
               CALL CONTCT(TAU,STIF,DTDP,DGAM,PRESS,DTIME,PROPS,1)
               ITER = ITER + 1
               DO 25 I = 1, 2
   25             R(I) = B(I) + C(I)*(V(I) + H*(A(I) + B(I)))
     1                 + S(I)*(U(I) + DU(I)) - CONST(I) - P
               R(1) = R(1) + TAU(1)
               R(2) = R(2) + PRESS
               IF (DABS(R(1)) + DABS(R(2)) .LT. TOL) GOTO 40
C              UNSYMMETRIC: Y ACTS ON X BY THE LIMIT, X NOT ON Y
               DY = R(2)/(1D0 + H*C(2) + Q*(S(2) + DPDU))
               B(2) = B(2) - DY
   30          B(1) = B(1) - (R(1) - Q*DTDP(1)*DPDU*DY)/
     1                       (1D0 + H*C(1) + Q*(S(1) + STIF(1)))
            WRITE (6,*) 'NO CONVERGENCE IN PERIOD', IPER, ' INC', KINC
            STOP 1
   40       DO 50 I = 1, 2
               U(I) = U(I) + DU(I)
               V(I) = V(I) + H*(A(I) + B(I))
   50          A(I) = B(I)
            D = D + 0.5D0*(TOLD + TAU(1))*DU(1)
            TOLD = TAU(1)
            XMAX = DMAX1(XMAX, U(1))
            XMIN = DMIN1(XMIN, U(1))
   60       IF (PRESS .LE. 0D0) OPEN = OPEN + 1D0/NINC
      XITER = ITER/(60D0*NINC)
      RETURN
      END
C
C     ONE CALL OF FRIC, FOR A CONTACT THAT WAS CLOSED AND SLIPPED
      SUBROUTINE CONTCT(TAU,STIF,DTDP,DGAM,PRESS,DTIME,PROPS,NFDIR)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 BLANK
      DIMENSION TAU(NFDIR), STIF(NFDIR,NFDIR), DTDP(NFDIR),
     1 DGAM(NFDIR), PROPS(4), ZERO(4), STATEV(2)
      DATA BLANK /' '/, ZERO /4*0D0/, STATEV /2*0D0/
      LM = 0
      CALL FRIC(LM,TAU,STIF,DTDP,ZERO,0D0,0D0,
     1 ZERO,1D0,STATEV,DGAM,ZERO,PRESS,0D0,0D0,ZERO,
     2 1,1,ZERO,DTIME,1,BLANK,BLANK,BLANK,1,1,
     3 1,ZERO,ZERO,ZERO,ZERO,ZERO,NFDIR,NFDIR+1,1,
     4 2,1D0,PROPS,4)
      RETURN
      END
C
C     DDTDDG AND DDTDDP AGAINST DIFFERENCES IN TWO DIRECTIONS: STICKING,
C     SLIDING, SLIDING ANOTHER WAY, OPEN
      SUBROUTINE CHECK
      INCLUDE 'ABA_PARAM.INC'
      PARAMETER (H=1D-5, N=4)
      DIMENSION PROPS(4), T(2,N), G(2,N), P(N), S(2,3)
      DIMENSION X(3), TAU(2,2), DG(2,2), DP(2)
      DATA PROPS /0.5D0, 0D0, 0D0, 3D0/
      DATA T /0.3D0,-0.6D0, 0.9D0,0.2D0, 0.1D0,0.2D0, 0.4D0,0.1D0/
      DATA G /0.1D0,0.05D0, 0.7D0,-0.4D0, -0.3D0,-0.6D0, 0.1D0,0.1D0/
      DATA P /2D0, 2D0, 1D0, -1D0/
      ERRG = 0D0
      ERRP = 0D0
      DO 50 K = 1, N
         DO 30 L = 1, 3
            DO 20 M = 1, 2
               X(1) = G(1,K)
               X(2) = G(2,K)
               X(3) = P(K)
               X(L) = X(L) + H*(3 - 2*M)
               TAU(1,M) = T(1,K)
               TAU(2,M) = T(2,K)
   20          CALL CONTCT(TAU(1,M), DG, DP, X, X(3), 1D0, PROPS, 2)
            DO 30 I = 1, 2
   30          S(I,L) = (TAU(I,1) - TAU(I,2))/(2D0*H)
         TAU(1,1) = T(1,K)
         TAU(2,1) = T(2,K)
         CALL CONTCT(TAU, DG, DP, G(1,K), P(K), 1D0, PROPS, 2)
         DO 40 I = 1, 2
            ERRP = DMAX1(ERRP, DABS(DP(I) - S(I,3)))
            DO 40 L = 1, 2
   40          ERRG = DMAX1(ERRG, DABS(DG(I,L) - S(I,L)))
   50    WRITE (6,600) K, DG, DP
      WRITE (6,610) ERRG, ERRP
      RETURN
  600 FORMAT ('# STATE', I2, ': DDTDDG', 4F10.5, ', DDTDDP', 2F10.6)
  610 FORMAT ('lift.ddtddg', 1PE12.2/'lift.ddtddp', E12.2)
      END
C
      SUBROUTINE XIT
      STOP 1
      END
