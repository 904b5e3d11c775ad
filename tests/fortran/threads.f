C SPDX-License-Identifier: BSD-3-Clause
C     Several handles at once, one a thread: what threads compute side
C     by side has the bits of what one thread computes, and each handle
C     keeps its own message. Handles come and go meanwhile.
      PROGRAM THREAD
      INTEGER NJOB, I, NALIVE, OMP_GET_MAX_THREADS
      EXTERNAL NALIVE, OMP_GET_MAX_THREADS
      PARAMETER (NJOB = 64)
      DOUBLE PRECISION X(3,NJOB), Y(3,NJOB)
      INTEGER NBAD(NJOB), MBAD(NJOB)
      CALL EXPECT('two threads', OMP_GET_MAX_THREADS() .GE. 2)
      DO 10 I = 1, NJOB
         CALL JOB(I, X(1,I), NBAD(I))
   10 CONTINUE
C$OMP PARALLEL DO SCHEDULE(DYNAMIC) DEFAULT(SHARED) PRIVATE(I)
      DO 20 I = 1, NJOB
         CALL JOB(I, Y(1,I), MBAD(I))
   20 CONTINUE
C$OMP END PARALLEL DO
      DO 30 I = 1, NJOB
         CALL EXPECT('no error alone', NBAD(I) .EQ. 0)
         CALL EXPECT('no error among others', MBAD(I) .EQ. 0)
         CALL EXPECT('same bits', X(1,I) .EQ. Y(1,I) .AND.
     1      X(2,I) .EQ. Y(2,I) .AND. X(3,I) .EQ. Y(3,I))
   30 CONTINUE
C$OMP PARALLEL DO SCHEDULE(STATIC,1) DEFAULT(SHARED) PRIVATE(I)
      DO 40 I = 1, NJOB
         CALL BURST(I, MBAD(I))
   40 CONTINUE
C$OMP END PARALLEL DO
      DO 50 I = 1, NJOB
         CALL EXPECT('handles kept apart', MBAD(I) .EQ. 0)
   50 CONTINUE
      CALL EXPECT('jobs differ', X(1,1) .NE. X(1,2))
      CALL EXPECT('all deleted', NALIVE() .EQ. 0)
      CALL REPORT_ALL
      END
C
C     Handles given and taken back as fast as can be; each is asked for
C     the number of contacts that it was made with.
      SUBROUTINE BURST(ID, NBAD)
      INTEGER ID, NBAD, MANY, I, K, N, IERR
      PARAMETER (MANY = 40)
      INTEGER IH(MANY)
      NBAD = 0
      DO 40 K = 1, 100
         DO 10 I = 1, MANY
            CALL TRBNEW(MOD(ID + I, 7), IH(I), IERR)
            NBAD = NBAD + IERR
   10    CONTINUE
         DO 20 I = 1, MANY
            CALL TRBNUM(IH(I), N, IERR)
            IF (IERR .NE. 0 .OR. N .NE. MOD(ID + I, 7)) NBAD = NBAD + 1
   20    CONTINUE
         DO 30 I = 1, MANY
            CALL TRBDEL(IH(I), IERR)
            NBAD = NBAD + IERR
   30    CONTINUE
   40 CONTINUE
      END
C
C     Three masses in a row, on each other, started with speeds that
C     depend on the job; NBAD counts what should not have happened.
      SUBROUTINE JOB(ID, X, NBAD)
      INTEGER ID, NBAD, N, IH, IH2, IERR, I, K
      PARAMETER (N = 3)
      DOUBLE PRECISION X(N), V(N), A(N), FEQ(N), F(N), R(N,N), DT
      DOUBLE PRECISION FMUN(N)
      CHARACTER*80 TEXT, SAYS
      NBAD = 0
      DT = 1D-2
      DO 20 I = 1, N
         DO 10 K = 1, N
            R(K,I) = 0D0
   10    CONTINUE
         R(I,I) = 2D0
         FMUN(I) = 0.1D0*I
         X(I) = 0D0
         V(I) = 0.1D0*MOD(7*ID + I, 11) - 0.5D0
   20 CONTINUE
      DO 25 I = 1, N - 1
         R(I+1,I) = -1D0
         R(I,I+1) = -1D0
   25 CONTINUE
      CALL TRBNEW(N, IH, IERR)
      NBAD = NBAD + IERR
      CALL TRBLIM(IH, N, FMUN, IERR)
      NBAD = NBAD + IERR
      CALL TRBOPF(IH, N, R, N, IERR)
      NBAD = NBAD + IERR
      CALL TRBSTP(IH, DT, 0.4D0, IERR)
      NBAD = NBAD + IERR
      WRITE (SAYS, 30) -ID
   30 FORMAT ('limit = ', I3, ' is negative')
      IF (ID .LT. 10) SAYS = SAYS(1:8) // SAYS(10:)
      DO 60 K = 1, 300
         DO 40 I = 1, N
            A(I) = 0.3D0*SIN(0.02D0*K + ID) - X(I)
   40    CONTINUE
         CALL TRBBAL(IH, N, V, A, FEQ, F, IERR)
         NBAD = NBAD + IERR
         DO 50 I = 1, N
            V(I) = V(I) + DT*(A(I) + F(I))
            X(I) = X(I) + DT*V(I)
   50    CONTINUE
         CALL TRBCPY(IH, IH2, IERR)
         NBAD = NBAD + IERR
         CALL TRBLM1(IH, -1D0*ID, IERR)
         IF (IERR .NE. 3) NBAD = NBAD + 1
         CALL TRBMSG(IH, TEXT, IERR)
         IF (TEXT .NE. SAYS) NBAD = NBAD + 1
         CALL TRBDEL(IH, IERR)
         NBAD = NBAD + IERR
         CALL TRBNUM(IH, I, IERR)
         IF (IERR .NE. 1) NBAD = NBAD + 1
         IH = IH2
   60 CONTINUE
      CALL TRBDEL(IH, IERR)
      NBAD = NBAD + IERR
      END
