C SPDX-License-Identifier: BSD-3-Clause
C     CALLS VFRIC AS ABAQUS/EXPLICIT DOES WITH KINEMATIC CONTACT, ONCE
C     AN INCREMENT OF CENTRAL DIFFERENCES, WITH THE SLIP THAT IT WOULD
C     HAVE WITHOUT FRICTION.  TWO MASSES ON SPRINGS SLIDE AND STICK ON A
C     FOUNDATION, BOTH THE OSCILLATOR OF QUINN (2004), FIG. 7A, ONE
C     TWICE AS LARGE AND IN COUNTERPHASE.  PRINTS THE ENERGY THAT
C     FRICTION TAKES FROM EACH IN CYCLE 50, SCALED BACK, AND ITS ERROR,
C     FOR THREE INCREMENTS.
      PROGRAM HOST
      INCLUDE 'vaba_param.inc'
      PARAMETER (N=2, DEXACT=7.18924625072D0)
      CHARACTER*80 BLANK
      DIMENSION X(N), V(N), SIZE(N), WORK(N), D(N), VFREE(N)
      DIMENSION FT(1,N), DSLIP(2,N), FSTICK(N), FNORM(N), PROPS(1)
      DIMENSION FPREV(2,N), T1(2,N), TN(2,N), ZERO(8), JUID(N), JCON(N)
      DATA SIZE /1D0, -2D0/, FNORM /2D0, 4D0/, PROPS /0.5D0/
      DATA BLANK /' '/, ZERO /8*0D0/, JUID /11, 12/, JCON /1, 2/
      DATA DSLIP /4*0D0/, FPREV /4*0D0/, T1 /4*0D0/
      DATA TN /0D0, 1D0, 0D0, 1D0/
      DO 50 K = 1, 3
         NINC = 126*10**(K-1)
         DT = 16D0*DATAN(1D0)/NINC
         DO 10 I = 1, N
            X(I) = 0D0
            V(I) = 0D0
   10       WORK(I) = 0D0
         DO 40 ICYC = 1, 50
            D(1) = WORK(1)
            D(2) = WORK(2)
            DO 40 KINC = 1, NINC
               P = 1.5D0*DSIN(0.5D0*(KINC - 1 + (ICYC-1)*NINC)*DT)
               DO 20 I = 1, N
                  VFREE(I) = V(I) + DT*(SIZE(I)*P - X(I))
                  DSLIP(1,I) = DT*DABS(VFREE(I))
                  T1(1,I) = DSIGN(1D0, VFREE(I))
   20             FSTICK(I) = DABS(VFREE(I))/DT
               CALL VFRIC(FT,ZERO,
     1            1,KINC,N,1,N,1,
     2            1,2,1,1,1,1,1,
     3            JUID,1,JCON,JCON,DT*KINC,DT*KINC,
     4            DT,BLANK,BLANK,BLANK,1,
     5            DSLIP,FSTICK,FPREV,FNORM,0D0,
     6            ZERO,ZERO,ZERO,T1,TN,PROPS,
     7            ZERO,ZERO,ZERO,ZERO,ZERO)
               DO 30 I = 1, N
                  F = T1(1,I)*FT(1,I)
                  VOLD = V(I)
                  V(I) = VFREE(I) + DT*F
                  X(I) = X(I) + DT*V(I)
                  FPREV(1,I) = FT(1,I)
   30             WORK(I) = WORK(I) - 0.5D0*DT*F*(VOLD + V(I))
   40    CONTINUE
         DO 50 I = 1, N
            D(I) = (WORK(I) - D(I))/SIZE(I)**2
   50       WRITE (6,600) I, K, DT, I, K, D(I), I, K,
     1                    DABS(D(I)/DEXACT - 1D0)
  600 FORMAT ('vfric.', I1, '.dt', I1, F14.6/'vfric.', I1, '.D', I1,
     1        F19.11/'vfric.', I1, '.error', I1, 1PE13.3)
      END
C
      SUBROUTINE XPLB_EXIT
      STOP 1
      END
