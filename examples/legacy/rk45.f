C SPDX-License-Identifier: BSD-3-Clause
C     INTEGRATES Y' = F(T,Y) FROM T TO TEND BY THE RUNGE-KUTTA PAIR OF
C     DORMAND AND PRINCE, J. COMP. APPL. MATH. 6 (1980) 19, ORDERS 5 AND
C     4, WITH CONTROL OF THE STEP.
C        N       NUMBER OF EQUATIONS
C        FCN     SUBROUTINE FCN(N,T,Y,F,RPAR,IPAR) GIVES F(N)
C        T, Y(N) STATE, ON RETURN THAT AT TEND OR THE LAST ONE REACHED
C        RTOL, ATOL  ERROR PER STEP IS KEPT BELOW ATOL + RTOL*ABS(Y)
C        H       STEP TO BEGIN WITH, ON RETURN THE ONE TO GO ON WITH
C        WORK(N,9)   SCRATCH
C        IWORK(3)    ON ENTRY IWORK(1) = LARGEST NUMBER OF STEPS, ON
C                RETURN IWORK(2) = STEPS TAKEN, IWORK(3) = REJECTED
C        RPAR, IPAR  FOR FCN, NOT TOUCHED HERE
C        IDID    1 = DONE, -1 = TOO MANY STEPS, -2 = STEP TOO SMALL
      SUBROUTINE RK45(N,FCN,T,Y,TEND,RTOL,ATOL,H,WORK,IWORK,RPAR,IPAR,
     1                IDID)
      IMPLICIT REAL*8 (A-H,O-Z)
      EXTERNAL FCN
      DIMENSION Y(N), WORK(N,9), IWORK(3), RPAR(*), IPAR(*)
      DIMENSION A(6,6), C(6), E(7)
      SAVE A, C, E
      DATA C /0.2D0, 0.3D0, 0.8D0, 0D0, 1D0, 1D0/
      DATA A /36*0D0/
      C(4) = 8D0/9D0
      A(1,1) = 0.2D0
      A(1,2) = 3D0/40D0
      A(2,2) = 9D0/40D0
      A(1,3) = 44D0/45D0
      A(2,3) = -56D0/15D0
      A(3,3) = 32D0/9D0
      A(1,4) = 19372D0/6561D0
      A(2,4) = -25360D0/2187D0
      A(3,4) = 64448D0/6561D0
      A(4,4) = -212D0/729D0
      A(1,5) = 9017D0/3168D0
      A(2,5) = -355D0/33D0
      A(3,5) = 46732D0/5247D0
      A(4,5) = 49D0/176D0
      A(5,5) = -5103D0/18656D0
      A(1,6) = 35D0/384D0
      A(3,6) = 500D0/1113D0
      A(4,6) = 125D0/192D0
      A(5,6) = -2187D0/6784D0
      A(6,6) = 11D0/84D0
      E(1) = 71D0/57600D0
      E(2) = 0D0
      E(3) = -71D0/16695D0
      E(4) = 71D0/1920D0
      E(5) = -17253D0/339200D0
      E(6) = 22D0/525D0
      E(7) = -1D0/40D0
      IWORK(2) = 0
      IWORK(3) = 0
      CALL FCN(N, T, Y, WORK(1,1), RPAR, IPAR)
   10 IF (T .GE. TEND) GOTO 90
      IF (IWORK(2) + IWORK(3) .GE. IWORK(1)) GOTO 91
      IF (T + 0.1D0*H .LE. T) GOTO 92
      HS = DMIN1(H, TEND - T)
C     STAGES 2 TO 7, THE LAST ONE AT THE END OF THE STEP
      DO 40 K = 1, 6
         DO 30 I = 1, N
            S = 0D0
            DO 20 J = 1, K
   20          S = S + A(J,K)*WORK(I,J)
   30       WORK(I,8) = Y(I) + HS*S
   40    CALL FCN(N, T + C(K)*HS, WORK(1,8), WORK(1,K+1), RPAR, IPAR)
C     ERROR, IN UNITS OF WHAT IS ALLOWED
      ERR = 0D0
      DO 60 I = 1, N
         S = 0D0
         DO 50 J = 1, 7
   50       S = S + E(J)*WORK(I,J)
         TOL = ATOL + RTOL*DMAX1(DABS(Y(I)), DABS(WORK(I,8)))
   60    ERR = DMAX1(ERR, DABS(HS*S)/TOL)
      FAC = 5D0
      IF (ERR .GT. 0D0) FAC = DMIN1(5D0, DMAX1(0.2D0, 0.9D0/ERR**0.2D0))
      IF (ERR .GT. 1D0) GOTO 80
      IWORK(2) = IWORK(2) + 1
      T = T + HS
      IF (HS .LT. H) T = TEND
      DO 70 I = 1, N
         Y(I) = WORK(I,8)
   70    WORK(I,1) = WORK(I,7)
      IF (HS .GE. H) H = HS*FAC
      GOTO 10
   80 IWORK(3) = IWORK(3) + 1
      H = HS*DMIN1(FAC, 0.9D0)
      GOTO 10
   90 IDID = 1
      RETURN
   91 IDID = -1
      RETURN
   92 IDID = -2
      RETURN
      END
