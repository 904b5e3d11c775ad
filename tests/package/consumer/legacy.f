C SPDX-License-Identifier: BSD-3-Clause
C     A sliding contact, by the fixed-form routines.
      PROGRAM LEGACY
      INTEGER IH, IERR
      DOUBLE PRECISION V(1), A(1), FEQ(1), F(1)
      EXTERNAL TRBNEW, TRBLM1, TRBOPD, TRBBAL, TRBDEL
      V(1) = 1D0
      A(1) = 0D0
      F(1) = 0D0
      CALL TRBNEW(1, IH, IERR)
      IF (IERR .EQ. 0) CALL TRBLM1(IH, 0.5D0, IERR)
      IF (IERR .EQ. 0) CALL TRBOPD(IH, 1, V, IERR)
      IF (IERR .EQ. 0) CALL TRBBAL(IH, 1, V, A, FEQ, F, IERR)
      IF (IERR .EQ. 0) CALL TRBDEL(IH, IERR)
      IF (IERR .NE. 0 .OR. ABS(F(1) + 0.5D0) .GT. 0D0) STOP 1
      END
