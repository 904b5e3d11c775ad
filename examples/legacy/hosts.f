C SPDX-License-Identifier: BSD-3-Clause
C     FOUR IMPLICIT METHODS THAT CALL TRIBO: NEWMARK, HILBER, HUGHES AND
C     TAYLOR (HHT), GENERALIZED ALPHA, BATHE.  EACH ONCE WITH COULOMB'S
C     LAW OVER THE STEP (TRBSTF), ONCE WITH TANGENTS (TRBBTN) AND
C     NEWTON'S METHOD, ONCE WITH A FORCE THAT IS CONSTANT OVER THE STEP
C     (TRBSTM).  THREE MASSES IN A ROW RUB ON THE GROUND.
C         legacy_hosts [FOLDER [STEPS]]
C     PRINTS ERRORS AGAINST THE EXACT MOTION FOR STEPS THAT ARE HALVED,
C     ITERATIONS A STEP, AND CREEP: HOW FAR THE MASSES MOVE IN STEPS
C     FROM 20000 ON (50000 WITHOUT STEPS), UNDER A STEADY LOAD THAT IS
C     SMALLER THAN THE LIMITS
      PROGRAM HOSTS
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=3, LEVELS=6, TEND=50D0)
      COMMON /STRUC/ XM(N), XC(N,N), XK(N,N), FMU(N)
      COMMON /LOAD/ PA(N), PC(N), OMEGA
      COMMON /MOTION/ T, U(N), V(N), A(N), F(N)
      COMMON /HOST/ ISTEP, IH, NITER
      DIMENSION UEX(N), UREST(N), ERR(LEVELS)
      CHARACTER*8 NAME(4), WAY(3)
      CHARACTER*80 TEXT
      DATA NAME /'newmark', 'hht', 'alpha', 'bathe'/
      DATA WAY /'step', 'tangent', 'mean'/
      NCREEP = 50000
      CALL GETARG(2, TEXT)
      IF (TEXT .NE. ' ') READ (TEXT, *) NCREEP
      DO 60 ISTEP = 1, 3
         DO 60 METHOD = 1, 4
            CALL INPUT(0D0)
            CALL EXACT(TEND, UEX)
            DO 30 K = 1, LEVELS
               NSTEP = 125*2**K
               CALL BEGIN(METHOD, TEND/NSTEP)
               DO 10 I = 1, NSTEP
   10             CALL STEP(METHOD, TEND/NSTEP)
               ERR(K) = 0D0
               DO 20 I = 1, N
   20             ERR(K) = DMAX1(ERR(K), DABS(U(I) - UEX(I)))
               WRITE (6,600) TRIM(NAME(METHOD)), TRIM(WAY(ISTEP)), K,
     1                       ERR(K)
               NITERS = NITER
   30          CALL DONE
            WRITE (6,610) TRIM(NAME(METHOD)), TRIM(WAY(ISTEP)),
     1         DLOG(ERR(1)/ERR(LEVELS))/DLOG(2D0)/(LEVELS - 1)
            WRITE (6,620) TRIM(NAME(METHOD)), TRIM(WAY(ISTEP)),
     1         NITERS/DBLE(NSTEP)
            CALL INPUT(1D0)
            CALL BEGIN(METHOD, 0.05D0)
            CREEP = 0D0
            DO 50 I = 1, 20000 + NCREEP
               CALL STEP(METHOD, 0.05D0)
               DO 40 J = 1, N
                  IF (I .EQ. 20000) UREST(J) = U(J)
   40             IF (I .GT. 20000) CREEP = DMAX1(CREEP,
     1                                     DABS(U(J) - UREST(J)))
   50       CONTINUE
            CALL DONE
   60       WRITE (6,630) TRIM(NAME(METHOD)), TRIM(WAY(ISTEP)), CREEP
      STOP
  600 FORMAT ('hosts.', A, '.', A, '.error', I1, 1PE13.3)
  610 FORMAT ('hosts.', A, '.', A, '.order', F8.3)
  620 FORMAT ('hosts.', A, '.', A, '.iterations', F8.3)
  630 FORMAT ('hosts.', A, '.', A, '.creep', 1PE13.3)
      END
C
C     MASSES OF 1, SPRINGS OF 1 BETWEEN THEM AND TO A WALL, SOME
C     DAMPING, LIMITS.  A LOAD OF 1.2 COS 0.7T ON THE FIRST MASS; OR A
C     STEADY ONE (STEADY = 1)
      SUBROUTINE INPUT(STEADY)
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=3)
      COMMON /STRUC/ XM(N), XC(N,N), XK(N,N), FMU(N)
      COMMON /LOAD/ PA(N), PC(N), OMEGA
      OMEGA = 0.7D0
      DO 20 J = 1, N
         DO 10 I = 1, N
            XK(I,J) = 0D0
            IF (I .EQ. J) XK(I,J) = 2D0
   10       IF (IABS(I - J) .EQ. 1) XK(I,J) = -1D0
         XM(J) = 1D0
         FMU(J) = 0.1D0*J
         PA(J) = STEADY*0.7D0*FMU(J)
   20    PC(J) = 0D0
      PC(1) = (1D0 - STEADY)*1.2D0
      DO 30 J = 1, N
         DO 30 I = 1, N
   30       XC(I,J) = 0.01D0*XK(I,J)
      RETURN
      END
C
C     THE EXACT MOTION FROM REST AT THE TIME TEND
      SUBROUTINE EXACT(TEND, UEX)
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=3)
      COMMON /STRUC/ XM(N), XC(N,N), XK(N,N), FMU(N)
      COMMON /LOAD/ PA(N), PC(N), OMEGA
      DIMENSION UEX(N), RM(N,N), RJ(N,N), PS(N), Y(2*N+1)
      CHARACTER*80 TEXT
      DO 20 J = 1, N
         DO 10 I = 1, N
            RM(I,J) = 0D0
   10       RJ(I,J) = 0D0
         RM(J,J) = XM(J)
         RJ(J,J) = 1D0
   20    PS(J) = 0D0
      DO 30 J = 1, 2*N + 1
   30    Y(J) = 0D0
      CALL TRBLIN(N, N, RM, XC, XK, N, RJ, N, IH, TEXT, IERR)
      IF (IERR .EQ. 0) CALL TRBLIM(IH, N, FMU, IERR)
      IF (IERR .EQ. 0) CALL TRBLOD(IH, N, OMEGA, PC, PS, IERR)
      IF (IERR .EQ. 0) CALL TRBDRV(IH, 'auto', 0D0, 0D0, 0D0, IERR)
      T = 0D0
      IF (IERR .EQ. 0) CALL TRBADV(IH, N, T, TEND, Y, IERR)
      CALL CHECK(IH, IERR)
      CALL TRBDEL(IH, IERR)
      DO 40 J = 1, N
   40    UEX(J) = Y(J)
      RETURN
      END
C
C     STOPS WITH TRIBO'S MESSAGE
      SUBROUTINE CHECK(IH, IERR)
      CHARACTER*160 TEXT
      IF (IERR .EQ. 0) RETURN
      CALL TRBMSG(IH, TEXT, IERR)
      WRITE (6,*) IERR, TEXT
      STOP 1
      END
C
C     AT REST; A HANDLE WITH LIMITS.  R IS SET BY SOLVE, WITH TANGENTS
C     THE INVERSE MASS HERE, AND A CONTACT THAT STICKS COMES TO REST IN
C     TWO STEPS
      SUBROUTINE BEGIN(METHOD, DT)
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=3)
      COMMON /STRUC/ XM(N), XC(N,N), XK(N,N), FMU(N)
      COMMON /MOTION/ T, U(N), V(N), A(N), F(N)
      COMMON /HOST/ ISTEP, IH, NITER
      COMMON /KEPT/ EINV(N,N), EMAT(N,N), WAS(4), RMEAN(N,N)
      DIMENSION RINV(N)
      T = 0D0
      NITER = 0
      DO 10 I = 1, 4
   10    WAS(I) = 0D0
      DO 20 I = 1, N
         RINV(I) = 1D0/XM(I)
         U(I) = 0D0
         V(I) = 0D0
         F(I) = 0D0
   20    A(I) = 0D0
      CALL TRBNEW(N, IH, IERR)
      IF (IERR .EQ. 0) CALL TRBLIM(IH, N, FMU, IERR)
      IF (ISTEP .NE. 2) GOTO 30
      IF (IERR .EQ. 0) CALL TRBOPD(IH, N, RINV, IERR)
      IF (IERR .EQ. 0) CALL TRBSTP(IH, DT, 2D0, IERR)
   30 CALL CHECK(IH, IERR)
      CALL START
      RETURN
      END
C
      SUBROUTINE DONE
      COMMON /HOST/ ISTEP, IH, NITER
      CALL TRBDEL(IH, IERR)
      RETURN
      END
C
C     ACCELERATIONS AT T = 0, BY THE BALANCE OF THE CONTACTS; WITHOUT
C     FRICTION WHERE THE FORCE IS CONSTANT OVER THE STEP
      SUBROUTINE START
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=3)
      COMMON /STRUC/ XM(N), XC(N,N), XK(N,N), FMU(N)
      COMMON /MOTION/ T, U(N), V(N), A(N), F(N)
      COMMON /HOST/ ISTEP, IH, NITER
      DIMENSION P(N)
      CALL LOADS(0D0, P)
      DO 10 I = 1, N
         F(I) = -DMIN1(DMAX1(P(I), -FMU(I)), FMU(I))
         A(I) = P(I)/XM(I)
   10    IF (ISTEP .NE. 3) A(I) = A(I) + F(I)/XM(I)
      RETURN
      END
C
      SUBROUTINE LOADS(T, P)
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=3)
      COMMON /LOAD/ PA(N), PC(N), OMEGA
      DIMENSION P(N)
      DO 10 I = 1, N
   10    P(I) = PA(I) + PC(I)*DCOS(OMEGA*T)
      RETURN
      END
C
C     Q = K U + C V
      SUBROUTINE INNER(U, V, Q)
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=3)
      COMMON /STRUC/ XM(N), XC(N,N), XK(N,N), FMU(N)
      DIMENSION U(N), V(N), Q(N)
      DO 10 I = 1, N
         Q(I) = 0D0
         DO 10 J = 1, N
   10       Q(I) = Q(I) + XK(I,J)*U(J) + XC(I,J)*V(J)
      RETURN
      END
C
      SUBROUTINE STEP(METHOD, DT)
      IMPLICIT REAL*8 (A-H,O-Z)
      IF (METHOD .EQ. 1) CALL NEWMRK(DT)
      IF (METHOD .EQ. 2) CALL HHT(DT)
      IF (METHOD .EQ. 3) CALL GALPHA(DT)
      IF (METHOD .EQ. 4) CALL BATHE(DT)
      RETURN
      END
C
C     NEWMARK'S METHOD, BETA 1/4, GAMMA 1/2
      SUBROUTINE NEWMRK(DT)
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=3, BETA=0.25D0, GAMMA=0.5D0)
      COMMON /MOTION/ T, U(N), V(N), A(N), F(N)
      COMMON /MEAN/ GN, BN, AN
      DIMENSION UP(N), VP(N), P(N)
      DO 10 I = 1, N
         UP(I) = U(I) + DT*(V(I) + (0.5D0 - BETA)*DT*A(I))
   10    VP(I) = V(I) + (1D0 - GAMMA)*DT*A(I)
      T = T + DT
      CALL LOADS(T, P)
      GN = (1D0 - GAMMA)*DT
      BN = (0.5D0 - BETA)*DT**2
      AN = 0D0
      CALL SOLVE(1D0, 1D0, GAMMA*DT, BETA*DT**2, UP, VP, P)
      RETURN
      END
C
C     HILBER, HUGHES AND TAYLOR (1977), ALPHA -0.1: SPRINGS, DAMPING AND
C     LOADS BETWEEN BOTH ENDS OF THE STEP
      SUBROUTINE HHT(DT)
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=3, ALPHA=-0.1D0, GAMMA=0.5D0-ALPHA,
     1           BETA=0.25D0*(1D0-ALPHA)**2)
      COMMON /MOTION/ T, U(N), V(N), A(N), F(N)
      COMMON /MEAN/ GN, BN, AN
      DIMENSION UP(N), VP(N), P(N), POLD(N), Q(N)
      CALL LOADS(T, POLD)
      CALL INNER(U, V, Q)
      T = T + DT
      CALL LOADS(T, P)
      DO 10 I = 1, N
         UP(I) = U(I) + DT*(V(I) + (0.5D0 - BETA)*DT*A(I))
         VP(I) = V(I) + (1D0 - GAMMA)*DT*A(I)
   10    P(I) = (1D0 + ALPHA)*P(I) - ALPHA*(POLD(I) - Q(I))
      GN = (1D0 - GAMMA)*DT
      BN = (0.5D0 - BETA)*DT**2
      AN = 0D0
      CALL SOLVE(1D0, 1D0 + ALPHA, GAMMA*DT, BETA*DT**2, UP, VP, P)
      RETURN
      END
C
C     GENERALIZED ALPHA (CHUNG AND HULBERT 1993), RHO = 0.8: THE INERTIA
C     FORCES, TOO
      SUBROUTINE GALPHA(DT)
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=3, RHO=0.8D0, AM=(2D0*RHO-1D0)/(RHO+1D0),
     1           AF=RHO/(RHO+1D0), GAMMA=0.5D0-AM+AF,
     2           BETA=0.25D0*(1D0-AM+AF)**2)
      COMMON /STRUC/ XM(N), XC(N,N), XK(N,N), FMU(N)
      COMMON /MOTION/ T, U(N), V(N), A(N), F(N)
      COMMON /MEAN/ GN, BN, AN
      DIMENSION UP(N), VP(N), P(N), POLD(N), Q(N)
      CALL LOADS(T, POLD)
      CALL INNER(U, V, Q)
      T = T + DT
      CALL LOADS(T, P)
      DO 10 I = 1, N
         UP(I) = U(I) + DT*(V(I) + (0.5D0 - BETA)*DT*A(I))
         VP(I) = V(I) + (1D0 - GAMMA)*DT*A(I)
   10    P(I) = (1D0 - AF)*P(I) + AF*(POLD(I) - Q(I)) - AM*XM(I)*A(I)
      GN = (1D0 - GAMMA)*DT
      BN = (0.5D0 - BETA)*DT**2
      AN = AM
      CALL SOLVE(1D0 - AM, 1D0 - AF, GAMMA*DT, BETA*DT**2, UP, VP, P)
      RETURN
      END
C
C     BATHE (2007): THE TRAPEZOIDAL RULE OVER HALF A STEP, THEN THE
C     BACKWARD FORMULA OF THREE POINTS
      SUBROUTINE BATHE(DT)
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=3)
      COMMON /STRUC/ XM(N), XC(N,N), XK(N,N), FMU(N)
      COMMON /MOTION/ T, U(N), V(N), A(N), F(N)
      COMMON /HOST/ ISTEP, IH, NITER
      COMMON /MEAN/ GN, BN, AN
      DIMENSION UP(N), VP(N), P(N), UOLD(N), VOLD(N)
      H = 0.5D0*DT
      DO 10 I = 1, N
         UOLD(I) = U(I)
         VOLD(I) = V(I)
         UP(I) = U(I) + H*(V(I) + 0.25D0*H*A(I))
   10    VP(I) = V(I) + 0.5D0*H*A(I)
      T = T + H
      CALL LOADS(T, P)
      GN = 0.5D0*H
      BN = 0.25D0*H**2
      AN = 0D0
      CALL SOLVE(1D0, 1D0, 0.5D0*H, 0.25D0*H**2, UP, VP, P)
      GN = H/3D0
      BN = DT/3D0*GN
      DO 20 I = 1, N
         VP(I) = V(I) + (V(I) - VOLD(I))/3D0
         IF (ISTEP .EQ. 3) VP(I) = VP(I) - GN*F(I)/XM(I)
   20    UP(I) = U(I) + (U(I) - UOLD(I))/3D0 + DT/3D0*VP(I)
      T = T + H
      CALL LOADS(T, P)
      CALL SOLVE(1D0, 1D0, DT/3D0, (DT/3D0)**2, UP, VP, P)
      RETURN
      END
C
C     THE STEP OF ANY OF THEM: A WITH WM M A + WK (K U + C V) = P + F,
C     U = UP + B A, V = VP + G A.  E = WM M + WK (B K + G C) IS INVERTED
C     WHERE A WEIGHT HAS CHANGED
      SUBROUTINE SOLVE(WM, WK, G, B, UP, VP, P)
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=3)
      COMMON /STRUC/ XM(N), XC(N,N), XK(N,N), FMU(N)
      COMMON /HOST/ ISTEP, IH, NITER
      COMMON /KEPT/ EINV(N,N), EMAT(N,N), WAS(4), RMEAN(N,N)
      DIMENSION UP(N), VP(N), P(N), Q(N), RHS(N)
      IF (WAS(1) .EQ. WM .AND. WAS(2) .EQ. WK .AND. WAS(3) .EQ. G
     1    .AND. WAS(4) .EQ. B) GOTO 20
      WAS(1) = WM
      WAS(2) = WK
      WAS(3) = G
      WAS(4) = B
      DO 10 J = 1, N
         DO 10 I = 1, N
            EMAT(I,J) = WK*(B*XK(I,J) + G*XC(I,J))
   10       IF (I .EQ. J) EMAT(I,J) = EMAT(I,J) + WM*XM(I)
      CALL INVERT(EMAT, EINV)
      IF (ISTEP .EQ. 1) CALL TRBOPF(IH, N, EINV, N, IERR)
      IF (ISTEP .EQ. 1) CALL CHECK(IH, IERR)
      IF (ISTEP .EQ. 3) CALL REACT(WK, G)
   20 CALL INNER(UP, VP, Q)
      DO 30 I = 1, N
   30    RHS(I) = P(I) - WK*Q(I)
      IF (ISTEP .EQ. 1) CALL BYSTEP(G, B, UP, VP, RHS)
      IF (ISTEP .EQ. 2) CALL BYTANG(G, B, UP, VP, RHS)
      IF (ISTEP .EQ. 3) CALL BYMEAN(G, B, UP, VP, RHS)
      RETURN
      END
C
C     COULOMB'S LAW OVER THE STEP: V = VFREE + G R F WITH R = 1/E.  A
C     CONTACT THAT STICKS HAS V = 0 AND NO ACCELERATION FROM HERE ON
      SUBROUTINE BYSTEP(G, B, UP, VP, RHS)
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=3)
      COMMON /MOTION/ T, U(N), V(N), A(N), F(N)
      COMMON /HOST/ ISTEP, IH, NITER
      COMMON /KEPT/ EINV(N,N), EMAT(N,N), WAS(4), RMEAN(N,N)
      DIMENSION UP(N), VP(N), RHS(N), VFREE(N), ISLIP(N)
      DO 20 I = 1, N
         VFREE(I) = VP(I)
         DO 20 J = 1, N
   20       VFREE(I) = VFREE(I) + G*EINV(I,J)*RHS(J)
      CALL TRBSTF(IH, N, G, VFREE, F, IERR)
      IF (IERR .EQ. 0) CALL TRBSLP(IH, N, ISLIP, IERR)
      CALL CHECK(IH, IERR)
      NITER = NITER + 1
      DO 40 I = 1, N
         V(I) = VFREE(I)
         DO 30 J = 1, N
   30       V(I) = V(I) + G*EINV(I,J)*F(J)
         IF (ISLIP(I) .EQ. 0) V(I) = 0D0
         A(I) = (V(I) - VP(I))/G
         U(I) = UP(I) + B*A(I)
   40    IF (ISLIP(I) .EQ. 0) A(I) = 0D0
      RETURN
      END
C
C     A FORCE THAT IS CONSTANT OVER THE STEP: A IS THE ACCELERATION BY
C     SPRINGS AND LOADS ALONE, AND F/M IS ADDED AT BOTH ENDS.
C     ACCELERATION AT THE END BY A FORCE: RMEAN; R DT = GN/M + G RMEAN
      SUBROUTINE REACT(WK, G)
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=3)
      COMMON /STRUC/ XM(N), XC(N,N), XK(N,N), FMU(N)
      COMMON /HOST/ ISTEP, IH, NITER
      COMMON /MEAN/ GN, BN, AN
      COMMON /KEPT/ EINV(N,N), EMAT(N,N), WAS(4), RMEAN(N,N)
      DIMENSION R(N,N)
      DO 30 J = 1, N
         DO 20 I = 1, N
            RMEAN(I,J) = (1D0 - AN)*EINV(I,J)
            DO 10 K = 1, N
   10          RMEAN(I,J) = RMEAN(I,J)
     1            - WK*EINV(I,K)*(BN*XK(K,J) + GN*XC(K,J))/XM(J)
   20       R(I,J) = G*RMEAN(I,J)
   30    R(J,J) = R(J,J) + GN/XM(J)
      DO 40 J = 1, N
         DO 40 I = 1, J
            R(I,J) = 0.5D0*(R(I,J) + R(J,I))
   40       R(J,I) = R(I,J)
      CALL TRBOPF(IH, N, R, N, IERR)
      CALL CHECK(IH, IERR)
      RETURN
      END
C
      SUBROUTINE BYMEAN(G, B, UP, VP, RHS)
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=3)
      COMMON /STRUC/ XM(N), XC(N,N), XK(N,N), FMU(N)
      COMMON /MOTION/ T, U(N), V(N), A(N), F(N)
      COMMON /HOST/ ISTEP, IH, NITER
      COMMON /MEAN/ GN, BN, AN
      COMMON /KEPT/ EINV(N,N), EMAT(N,N), WAS(4), RMEAN(N,N)
      DIMENSION UP(N), VP(N), RHS(N), AFREE(N), VFREE(N), ISLIP(N)
      DO 20 I = 1, N
         AFREE(I) = 0D0
         DO 10 J = 1, N
   10       AFREE(I) = AFREE(I) + EINV(I,J)*RHS(J)
   20    VFREE(I) = VP(I) + G*AFREE(I)
      CALL TRBSTM(IH, N, 1D0, V, VFREE, F, IERR)
      IF (IERR .EQ. 0) CALL TRBSLP(IH, N, ISLIP, IERR)
      CALL CHECK(IH, IERR)
      NITER = NITER + 1
      DO 50 I = 1, N
         ACC = AFREE(I)
         DO 30 J = 1, N
   30       ACC = ACC + RMEAN(I,J)*F(J)
         VOLD = V(I)
         V(I) = VP(I) + GN*F(I)/XM(I) + G*ACC
         IF (ISLIP(I) .NE. 0) GOTO 40
         V(I) = 0D0
         ACC = 0D0
         IF (VOLD .EQ. 0D0) GOTO 50
   40    U(I) = UP(I) + BN*F(I)/XM(I)
     1        + B/G*(V(I) - VP(I) - GN*F(I)/XM(I))
   50    A(I) = ACC - F(I)/XM(I)
      RETURN
      END
C
C     QUINN'S LAW WITH TANGENTS: NEWTON'S METHOD FOR A, AT LEAST ONE
C     ITERATION.  EACH FIFTH ONE GOES HALF THE WAY, WHICH ENDS CYCLES
C     BETWEEN THE TWO DIRECTIONS OF SLIDING
      SUBROUTINE BYTANG(G, B, UP, VP, RHS)
      IMPLICIT REAL*8 (A-H,O-Z)
      PARAMETER (N=3, TOL=1D-13)
      COMMON /STRUC/ XM(N), XC(N,N), XK(N,N), FMU(N)
      COMMON /MOTION/ T, U(N), V(N), A(N), F(N)
      COMMON /HOST/ ISTEP, IH, NITER
      COMMON /KEPT/ EINV(N,N), EMAT(N,N), WAS(4), RMEAN(N,N)
      DIMENSION UP(N), VP(N), RHS(N), P(N), Q(N), AFREE(N), FEQ(N)
      DIMENSION DFDV(N,N), DFDA(N,N), XJ(N,N), XINV(N,N), RES(N)
      CALL LOADS(T, P)
      DO 50 ITER = 1, 30
         DO 10 I = 1, N
            V(I) = VP(I) + G*A(I)
   10       U(I) = UP(I) + B*A(I)
         CALL INNER(U, V, Q)
         DO 20 I = 1, N
   20       AFREE(I) = (P(I) - Q(I))/XM(I)
         CALL TRBBTN(IH, N, V, AFREE, FEQ, F, DFDV, DFDA, N, IERR)
         CALL CHECK(IH, IERR)
         SIZE = 0D0
         DO 40 I = 1, N
            RES(I) = -RHS(I) - F(I)
            DO 40 J = 1, N
               RES(I) = RES(I) + EMAT(I,J)*A(J)
               XJ(I,J) = EMAT(I,J) - G*DFDV(I,J)
               DO 40 K = 1, N
   40             XJ(I,J) = XJ(I,J) + DFDA(I,K)/XM(K)
     1                                *(B*XK(K,J) + G*XC(K,J))
         DO 45 I = 1, N
   45       SIZE = DMAX1(SIZE, DABS(RES(I))/FMU(I))
         IF (SIZE .LT. TOL .AND. ITER .GT. 1) RETURN
         NITER = NITER + 1
         CALL INVERT(XJ, XINV)
         FAC = 1D0
         IF (MOD(ITER,5) .EQ. 0) FAC = 0.5D0
         DO 50 I = 1, N
            DO 50 J = 1, N
   50          A(I) = A(I) - FAC*XINV(I,J)*RES(J)
      WRITE (6,*) 'NEWTON''S METHOD DID NOT CONVERGE AT T =', T, SIZE
      STOP 1
      END
C
C     AI = INVERSE OF A, 3 X 3, BY COFACTORS
      SUBROUTINE INVERT(A, AI)
      IMPLICIT REAL*8 (A-H,O-Z)
      DIMENSION A(3,3), AI(3,3)
      DO 10 I = 1, 3
         I1 = MOD(I,3) + 1
         I2 = MOD(I+1,3) + 1
         DO 10 J = 1, 3
            J1 = MOD(J,3) + 1
            J2 = MOD(J+1,3) + 1
   10       AI(J,I) = A(I1,J1)*A(I2,J2) - A(I1,J2)*A(I2,J1)
      D = A(1,1)*AI(1,1) + A(1,2)*AI(2,1) + A(1,3)*AI(3,1)
      DO 20 I = 1, 3
         DO 20 J = 1, 3
   20       AI(J,I) = AI(J,I)/D
      RETURN
      END
