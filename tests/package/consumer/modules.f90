! SPDX-License-Identifier: BSD-3-Clause
! Friction balances the two contacts of core.c by (3, -3).
program modules
  use tribo
  implicit none
  type(tribo_context) :: c
  real(dp) :: r(2, 2) = reshape([2.0_dp, 1.0_dp, 1.0_dp, 2.0_dp], [2, 2]), v(2) = 0, a(2) = [-3.0_dp, 3.0_dp], f(2) = 0

  call c%create(2)
  call c%set_limit(5.0_dp)
  call c%set_operator(r)
  call c%balance(v, a, f=f)
  print '(a, 2f6.2)', 'f =', f
  if (any(abs(f - [3, -3]) > 1e-12_dp)) error stop 1
end program modules
