! SPDX-License-Identifier: BSD-3-Clause
!> A block on a spring comes to rest by friction; two blocks, one upon the other, are pulled until one slides.
program friction
  use tribo
  implicit none
  call one_block()
  call two_blocks()
contains

  !> Mass 1, spring 1, limit 1, let go at x = 2.75: it swings twice and stops at -0.75. Classical Runge-Kutta steps.
  subroutine one_block()
    type(tribo_context) :: c
    real(dp), parameter :: dt = 0.01_dp
    real(dp) :: y(2), k(2, 4)
    integer :: step

    call c%create(1)
    call c%set_limit(1.0_dp)
    call c%set_operator([1.0_dp])       ! 1/mass
    call c%set_epsilon(step=dt)         ! as small as the integrator can take
    y = [2.75_dp, 0.0_dp]
    do step = 1, 1500
      k(:, 1) = slope(c, y)
      k(:, 2) = slope(c, y + dt/2*k(:, 1))
      k(:, 3) = slope(c, y + dt/2*k(:, 2))
      k(:, 4) = slope(c, y + dt*k(:, 3))
      y = y + dt/6*(k(:, 1) + 2*k(:, 2) + 2*k(:, 3) + k(:, 4))
    end do
    print '(a, f10.7, a)', 'one block: at rest at x =', y(1), ', by Coulomb''s law -0.75'
    if (abs(y(1) + 0.7500899_dp) > 5e-7_dp .or. abs(y(2)) > 1e-6_dp) error stop 'one block: wrong place'
  end subroutine one_block

  function slope(c, y) result(dy)
    type(tribo_context), intent(inout) :: c
    real(dp), intent(in) :: y(2)
    real(dp) :: dy(2), f(1)
    call c%balance(y(2:2), -y(1:1), f=f)
    dy = [y(2), -y(1) + f(1)]
  end function slope

  !> Contact 1: the lower block on the ground; contact 2: the upper block, which is pulled, on the lower one.
  subroutine two_blocks()
    type(tribo_context) :: c
    real(dp), parameter :: pull(3) = [0.3_dp, 0.5_dp, 0.8_dp], v(2) = 0
    real(dp) :: feq(2), f(2), again(2)
    integer :: i, mode(2)

    call c%create(2)
    call c%set_limit([1.0_dp, 0.6_dp])
    call c%set_operator(reshape([1.0_dp, -1.0_dp, -1.0_dp, 2.0_dp], [2, 2]))
    print '(a)', 'two blocks:  pull   friction on the ground, between the blocks   stuck'
    do i = 1, size(pull)
      call c%balance(v, [0.0_dp, pull(i)], feq, f)
      call c%get_slip(mode)
      call c%force(v, feq, again)
      print '(f17.2, f25.2, f20.2, l14, l3)', pull(i), f, mode == 0
      if (any(abs(f + min(pull(i), 0.6_dp)) > 1e-12_dp) .or. any(abs(f - again) > 0)) error stop 'two blocks: wrong force'
    end do
  end subroutine two_blocks
end program friction
