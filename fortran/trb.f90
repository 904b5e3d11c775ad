!> tribo for fixed-form Fortran: external routines that need no module and no interface block.
!>
!> I... are default INTEGER, as are N, NDOF, LDR, LDJ, LAW and MODE; all other numbers are DOUBLE PRECISION; NAME and TEXT are
!> CHARACTER*(*). Arrays hold one value a contact, N of them, unless said otherwise; an element of a bigger array may be passed,
!> and the array then begins there. Contacts, rows and columns are counted from 1.
!>
!> IH     handle of a set of contacts. It fits a default INTEGER and is never given twice; handles that were never given, or
!>        whose contacts have been deleted, are recognized. One handle belongs to one thread at a time.
!> N      number of contacts; must be that of TRBNEW
!> IERR   0, or one of the codes of module tribo (TRIBO_ERR_...). Outputs are untouched then, and TRBMSG tells what is wrong.
!>
!> Registry                                          in                                out
!>   TRBVER(IVER, IERR)                                                                IVER 10000*major + 100*minor + patch
!>   TRBVST(TEXT, IERR)                                                                TEXT version
!>   TRBTXT(ICODE, TEXT, IERR)                       ICODE any status                  TEXT what it means
!>   TRBNLW(NLAW, IERR)                                                                NLAW number of laws: 0 to NLAW - 1
!>   TRBLNM(LAW, TEXT, IERR)                         LAW                               TEXT its name
!>   TRBREF(LAW, TEXT, IERR)                         LAW                               TEXT where it comes from
!>   TRBFND(NAME, LAW, IERR)                         NAME e.g. 'quinn'                 LAW its number
!>   TRBEVL(LAW, V, FEQ, FMUN, EPS,                  one contact, no handle            F and its derivatives by V, FEQ, FMUN
!>          F, DFDV, DFDQ, DFDN, IERR)
!> Life
!>   TRBNEW(N, IH, IERR)                             N >= 0                            IH new: quinn, limit 0, epsilon 1E-6, R = 1
!>   TRBCPY(IH, IHNEW, IERR)                         IH                                IHNEW a copy that shares nothing
!>   TRBDEL(IH, IERR)                                IH
!>   TRBNUM(IH, N, IERR)                             IH                                N number of contacts
!>   TRBMSG(IH, TEXT, IERR)                          IH                                TEXT what its last failing call found;
!>                                                                                     always defined, even if IH is no handle
!> Settings
!>   TRBLAW(IH, LAW, IERR)                           LAW
!>   TRBNAM(IH, NAME, IERR)                          NAME of the law
!>   TRBGLW(IH, LAW, IERR)                                                             LAW
!>   TRBLIM(IH, N, FMUN, IERR)                       FMUN(N) limits mu*N >= 0
!>   TRBLM1(IH, FMUN, IERR)                          FMUN one for all
!>   TRBGLM(IH, N, FMUN, IERR)                                                         FMUN(N)
!>   TRBEPS(IH, N, EPS, IERR)                        EPS(N) > 0
!>   TRBEP1(IH, EPS, IERR)                           EPS one for all
!>   TRBSTP(IH, DT, RLDT, IERR)                      DT step, RLDT lambda*dt: epsilon follows
!>   TRBGEP(IH, N, EPS, IERR)                                                          EPS(N)
!>   TRBOPD(IH, N, RDIAG, IERR)                      RDIAG(N) >= 0: R diagonal
!>   TRBOPF(IH, N, R, LDR, IERR)                     R(LDR,N) full, symmetric; LDR >= N
!>   TRBOPS(IH, N, IROW, ICOL, VAL, IERR)            R sparse: row I is VAL(K) at column ICOL(K),
!>                                                   K = IROW(I) to IROW(I+1) - 1; IROW(N+1), IROW(1) = 1
!>   TRBOPM(IH, N, NDOF, RMINV, IROW, ICOL, VAL,     R = J diag(RMINV(NDOF)) J', J (N x NDOF) sparse as above
!>          IERR)
!>   TRBCPL(IH, ICPL, IERR)                          ICPL 0 consistent, 1 partition
!>   TRBGCP(IH, ICPL, IERR)                                                            ICPL
!> Forces
!>   TRBFRC(IH, N, V, FEQ, F, IERR)                  V(N), FEQ(N)                      F(N)
!>   TRBFTN(IH, N, V, FEQ, F, DFDV, DFDQ, DFDN,      V(N), FEQ(N)                      F(N), its derivatives by V, FEQ, limit, (N) each
!>          IERR)
!>   TRBBAL(IH, N, V, A, FEQ, F, IERR)               V(N), A(N)                        FEQ(N), F(N)
!>   TRBBTN(IH, N, V, A, FEQ, F, DFDV, DFDA, LDJ,    V(N), A(N); LDJ >= N              FEQ(N), F(N), DFDV(LDJ,N) and DFDA(LDJ,N):
!>          IERR)                                                                      (I,J) is the derivative of F(I) by V(J), A(J)
!>   TRBSTF(IH, N, DT, VFREE, F, IERR)               DT, VFREE(N)                      F(N): Coulomb's law over one step
!>   TRBBOX(IH, N, A, FLO, FUP, F, IERR)             A(N), FLO(N) <= FUP(N)            F(N): minimum of F'RF/2 + A'F in the box
!>   TRBACC(IH, N, V, FEQ, IERR)                     V(N), FEQ(N) of an accepted step
!> Queries
!>   TRBMOD(IH, N, MODE, IERR)                                                         MODE(N): 0 stuck, +1 -1 sliding, 2 open
!>   TRBCNT(IH, IWHICH, IVAL, IERR)                  IWHICH TRIBO_COUNT_...            IVAL
!>   TRBVAL(IH, IWHICH, VAL, IERR)                   IWHICH TRIBO_REAL_...             VAL
