! SPDX-License-Identifier: BSD-3-Clause
!> The oscillator, driven by the exact method.
program systems
  use tribo
  use tribo_dynamics
  implicit none
  type(tribo_system) :: system
  type(tribo_driver) :: driver
  real(dp) :: t, y(3)

  call system%oscillator(0.25_dp, 1.0_dp, 1.0_dp)
  call driver%create(system, 'exact')
  t = 0
  y = 0
  call driver%advance(t, 10.0_dp, y)
  if (abs(t - 10) > 0 .or. y(3) <= 0) error stop 1
end program systems
