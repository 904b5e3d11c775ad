! SPDX-License-Identifier: BSD-3-Clause
!> Points of a curve.
module curve_points
  use tribo
  use tribo_dynamics
  implicit none
  private

  !> Counts points, and keeps the special ones.
  type, extends(tribo_curve_observer), public :: points
    integer :: count = 0, special = 0, contact = 0, stop = 0
    real(dp) :: parameter = 0, last = 0, size = 0, zeta = 0
  contains
    procedure :: seen => point_seen
  end type points

contains

  integer function point_seen(this, point) result(answer)
    class(points), intent(inout) :: this
    type(tribo_curve_point), intent(in) :: point

    this%count = this%count + 1
    this%last = point%parameter
    this%size = point%y(1)
    this%zeta = point%zeta
    if (point%kind /= TRIBO_POINT_REGULAR) then
      this%special = point%kind
      this%contact = point%contact
      this%parameter = point%parameter
    end if
    answer = merge(1, 0, this%count == this%stop)
  end function point_seen

end module curve_points

!> Models: dense, diagonal and sparse matrices make the same system, errors name what is wrong, and a contact with compliance is a
!> spring before a slider.
program models
  use tribo
  use tribo_dynamics
  use curve_points
  use check
  implicit none
  integer :: stat
  character(len=240) :: msg
  real(dp), parameter :: mass(3) = [1.0_dp, 2.0_dp, 0.5_dp]
  real(dp), parameter :: k(3,3) = reshape([3.0_dp, -1.0_dp, 0.0_dp, -1.0_dp, 4.0_dp, -2.0_dp, 0.0_dp, -2.0_dp, 5.0_dp], [3, 3])
  real(dp), parameter :: j(2,3) = reshape([1.0_dp, 0.0_dp, 0.0_dp, -1.0_dp, 0.0_dp, 1.0_dp], [2, 3])

  call forms()
  call errors()
  call compliance()
  call normal()
  call cycle_of_belt()
  call ring_of_three()
  call report()

contains

  subroutine forms()
    type(tribo_model) :: model
    type(tribo_system) :: s
    type(tribo_sparse) :: sm, sk, sj
    real(dp) :: y(7, 3), full(3, 3), omega(3), low(2)
    integer :: form, i

    full = 0
    do i = 1, 3
      full(i, i) = mass(i)
    end do
    call sm%set_coo(3, 3, [1, 2, 3], [1, 2, 3], mass)
    call sk%set_coo(3, 3, [1, 1, 2, 2, 2, 3, 3], [1, 2, 1, 2, 3, 2, 3], &
      [3.0_dp, -1.0_dp, -1.0_dp, 4.0_dp, -2.0_dp, -2.0_dp, 5.0_dp])
    call sj%set_coo(2, 3, [1, 2, 2], [1, 2, 3], [1.0_dp, -1.0_dp, 1.0_dp])
    do form = 1, 3
      call model%create(3, 2)
      if (form == 1) call model%set_mass(full)
      if (form == 2) call model%set_mass(mass)
      if (form == 3) call model%set_mass(sm)
      if (form == 1) call model%set_damping(0.1_dp*full)
      if (form == 2) call model%set_damping(0.1_dp*mass)
      if (form == 3) then
        call sm%set_coo(3, 3, [1, 2, 3], [1, 2, 3], 0.1_dp*mass)
        call model%set_damping(sm)
      end if
      if (form < 3) call model%set_stiffness(k)
      if (form < 3) call model%set_direction(j)
      if (form == 3) call model%set_stiffness(sk)
      if (form == 3) call model%set_direction(sj)
      call s%create(model)
      call model%destroy()
      call follow(s, y(:, form))
    end do
    call require(all(same_bits(y(:, 2), y(:, 1))) .and. all(same_bits(y(:, 3), y(:, 1))), 'forms: the same system')
    call require(abs(y(1, 1)) > 1e-3_dp, 'forms: it moves')
    call model%create(3, 2)
    call model%set_mass(mass)
    call model%set_stiffness(k)
    call model%set_direction(j)
    call s%reduce(model, 3, TRIBO_STATICS_NONE)
    call s%get_frequencies(omega)
    call s%reduce(model, 2, static_contacts=TRIBO_STATICS_NONE)
    call s%get_frequencies(low)
    call require(s%ndof() == 2 .and. all(abs(low - omega(:2)) < 1e-12_dp), 'forms: the lowest modes')
    call s%reduce(model, 1)
    call require(s%ndof() == 3, 'forms: a mode and two static responses')
    call s%reduce_to(model, 0.1_dp*omega(1), 1e-3_dp)
    call require(s%ndof() == 3, 'forms: within a tolerance')
    call s%reduce_to(model, -1.0_dp, 1e-3_dp, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'omega = -1 is negative')
  end subroutine forms

  subroutine follow(s, y)
    type(tribo_system), intent(inout) :: s
    real(dp), intent(out) :: y(7)
    type(tribo_driver) :: d
    type(tribo_context) :: c
    real(dp) :: t

    call s%context(c)
    call c%set_limit([0.2_dp, 0.1_dp])
    call s%add_load(1.3_dp, cosine=[1.0_dp, 0.0_dp, 0.5_dp])
    call d%create(s, 'exact')
    t = 0
    y = 0
    call d%advance(t, 20.0_dp, y)
  end subroutine follow

  subroutine errors()
    type(tribo_model) :: model
    type(tribo_system) :: s
    type(tribo_sparse) :: unset, wide
    real(dp) :: x(3, 3)

    call model%set_mass(mass, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, 'the model has not been created, or has been destroyed')
    call model%create(-1, 2, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'ndof = -1 is negative')
    call model%create(3, 2)
    call s%create(model, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_STATE, 'mass has not been set: call tribo_model_set_mass')
    call require(model%message() == 'mass has not been set: call tribo_model_set_mass', 'errors: the message stays')
    call model%set_mass(mass(:2), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'mass has size 2, not 3')
    call model%set_stiffness(k(:2, :), stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'stiffness has size 2 x 3, not 3 x 3')
    call model%set_direction(k, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'direction has size 3 x 3, not 2 x 3')
    call model%set_direction(unset, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NULL, 'direction has not been set')
    call wide%set_coo(3, 4, [1], [4], [1.0_dp])
    call model%set_mass(wide, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'mass has size 3 x 4, not 3 x 3')
    x = k
    x(1, 2) = 7
    call model%set_mass(mass)
    call model%set_stiffness(x)
    call model%set_direction(j)
    call s%reduce(model, 2, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NOT_SYMMETRIC, &
                      'stiffness(1,2) = 7, but stiffness(2,1) = -1: ' // &
                      'modes for a reduction are those of a symmetric stiffness')
    call model%set_compliance([0.0_dp, -1.0_dp], stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'compliance(2) = -1 is negative')
    call model%set_normal(1, 3, 0.5_dp, 1.0_dp, 0.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'normal(1) = 3 is not in 1 to 2')
    call model%set_normal(0, 2, 0.5_dp, 1.0_dp, 0.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'contact(1) = 0 is not in 1 to 2')
    call model%set_normal(2, 2, 0.5_dp, 1.0_dp, 0.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_RANGE, 'contact 2 is to be its own normal')
    call model%set_normal(1, 2, -0.5_dp, 1.0_dp, 0.0_dp, stat, msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'mu = -0.5 of contact 1 is negative')
    call model%set_stiffness(k)
    call s%reduce(model, 4, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_SIZE, 'nmode = 4 is more than the 3 degrees of freedom')
    call s%reduce(model, -1, stat=stat, errmsg=msg)
    call expect_error(stat, msg, TRIBO_ERR_NEGATIVE, 'nmode = -1 is negative')
    call s%create(model, stat, msg)
    call require(stat == TRIBO_OK .and. s%ndof() == 3 .and. s%ncontact() == 2, 'errors: the model is as it was')
  end subroutine errors

  !> x'' + 0.1 x' + x + f = cos 1.1 t, stiffness 1, limit 0.5: the exact steady amplitude is 3.38660810.
  subroutine compliance()
    type(tribo_model) :: model
    type(tribo_system) :: s
    type(tribo_driver) :: d
    type(tribo_context) :: c
    real(dp) :: y(4), least, most

    call model%create(1, 1)
    call model%set_mass([1.0_dp])
    call model%set_damping([0.1_dp])
    call model%set_stiffness([1.0_dp])
    call model%set_direction(reshape([1.0_dp], [1, 1]))
    call model%set_compliance([1.0_dp])
    call s%create(model)
    call s%context(c)
    call c%set_limit(0.5_dp)
    call s%add_load(1.1_dp, cosine=[1.0_dp])
    call d%create(s, 'exact')
    y = 0
    call d%find_periodic(0.0_dp, 2*acos(-1.0_dp)/1.1_dp, y)
    call d%period_extremes([1.0_dp, 0.0_dp], least, most)
    call require(abs(most - 3.38660810_dp) < 1e-7_dp, 'compliance: the amplitude')
    call mode_of_contact()
    call flutter()
  end subroutine compliance

  !> Nonlinear mode of m = k = kt = 1, limit 0.5: values of another code.
  subroutine mode_of_contact()
    type(tribo_model) :: model
    type(tribo_system) :: s
    type(tribo_driver) :: d
    type(tribo_context) :: c
    type(points), target :: seen
    real(dp) :: y(4), omega, zeta, period
    integer :: stat

    call model%create(1, 1)
    call model%set_mass([1.0_dp])
    call model%set_stiffness([1.0_dp])
    call model%set_direction(reshape([1.0_dp], [1, 1]))
    call model%set_compliance([1.0_dp])
    call s%create(model)
    call s%context(c)
    call c%set_limit(0.5_dp)
    call d%create(s, 'exact')
    y = 0
    omega = 0
    zeta = 0
    call d%find_mode([1.0_dp, 0.0_dp], 1.0_dp, omega, zeta, y)
    call require(abs(omega - 1.2258676901977_dp) < 1e-9_dp, 'mode: omega')
    call require(abs(zeta - 0.105752880426_dp) < 1e-9_dp, 'mode: zeta')
    call d%find_mode([1.0_dp], 1.0_dp, omega, zeta, y, stat)
    call require(stat == TRIBO_ERR_SIZE, 'mode: a short signal')
    call d%find_mode([1.0_dp, 0.0_dp], -1.0_dp, omega, zeta, y, stat)
    call require(stat == TRIBO_ERR_NOT_POSITIVE .and. abs(omega - 1.2258676901977_dp) < 1e-9_dp, 'mode: a negative amplitude')
    y = 0
    period = 0
    call d%follow_curve(curve_of([1.0_dp, 0.0_dp]), 0.0_dp, period, y, seen)
    call require(seen%count > 5 .and. abs(seen%last - 1) <= 0 .and. abs(seen%size - 1) < 1e-9_dp, 'curve: its end')
    call require(seen%special == TRIBO_POINT_SLIDE .and. seen%contact == 1, 'curve: a contact ceases to stick')
    call require(abs(seen%parameter - 0.5_dp) < 1e-8_dp, 'curve: the amplitude at which it does')
    call require(abs(8*atan(1.0_dp)/period - 1.2258676901977_dp) < 1e-9_dp, 'curve: omega')
    call require(abs(seen%zeta - 0.105752880426_dp) < 1e-9_dp, 'curve: zeta')
    seen%stop = seen%count + 2
    y = 0
    period = 0
    call d%follow_curve(curve_of([1.0_dp, 0.0_dp]), 0.0_dp, period, y, seen, stat, msg)
    call require(stat == TRIBO_ERR_STOPPED .and. index(msg, 'the observer answered 1') > 0, 'curve: stopped')
    call d%follow_curve(curve_of([1.0_dp]), 0.0_dp, period, y, seen, stat)
    call require(stat == TRIBO_ERR_SIZE, 'curve: a short signal')
  end subroutine mode_of_contact

  !> Mode coupling: springs 11 at 150 and 20 at 30 degrees, normal stiffness 11, preload 10, friction 0.6 on a belt.
  subroutine flutter()
    type(tribo_model) :: model
    type(tribo_system) :: s
    real(dp), parameter :: x = 23.25_dp, z = 7.75_dp
    real(dp) :: y(5), re(4), im(4), critical, omega, xz
    integer :: slip(2), count, stat

    xz = 9*sqrt(3.0_dp)/4
    call model%create(2, 2)
    call model%set_mass([1.0_dp, 1.0_dp])
    call model%set_stiffness(reshape([x, xz, xz, z], [2, 2]))
    call model%set_direction(reshape([1.0_dp, 0.0_dp, 0.0_dp, 1.0_dp], [2, 2]))
    call model%set_normal(1, 2, 0.6_dp, 11.0_dp, 0.0_dp)
    call s%create(model)
    call s%add_load(0.0_dp, [0.0_dp, 10.0_dp])
    y = 0
    call s%equilibrium(y, slip, count, re, im, [TRIBO_SLIP_BACK, 0])
    call require(count == 4 .and. slip(1) == TRIBO_SLIP_BACK, 'equilibrium: slip')
    call require(abs(x*y(1) + (xz - 6.6_dp)*y(2)) < 1e-12_dp, 'equilibrium: along the belt')
    call require(re(1) > 0.1_dp .and. abs(re(1) + re(3)) < 1e-12_dp .and. abs(im(1) + im(2)) < 1e-12_dp, 'equilibrium: exponents')
    call s%find_flutter(TRIBO_FLUTTER_FRICTION, 0.0_dp, 1.0_dp, critical, omega, [TRIBO_SLIP_BACK, 0], y)
    call require(abs(0.6_dp*critical - 0.47237749297_dp) < 1e-11_dp, 'flutter: coefficient of friction')
    call require(abs(omega - 4.5825756950_dp) < 1e-9_dp, 'flutter: frequency')
    call s%equilibrium(y(:4), slip, count, re, im, stat=stat)
    call require(stat == TRIBO_ERR_SIZE, 'equilibrium: a short state')
    call s%equilibrium(y, slip, count, re, im, [99999, 0], stat)
    call require(stat == TRIBO_ERR_RANGE, 'equilibrium: no direction')
    call s%find_flutter(7, 0.0_dp, 1.0_dp, critical, omega, stat=stat)
    call require(stat == TRIBO_ERR_RANGE, 'flutter: no parameter')
  end subroutine flutter

  function curve_of(c) result(curve)
    real(dp), intent(in) :: c(:)
    type(tribo_curve) :: curve

    curve%motion = TRIBO_MOTION_MODE
    curve%parameter = TRIBO_PARAMETER_AMPLITUDE
    curve%least = 0.1_dp
    curve%most = 1
    curve%step = 0.1_dp
    curve%amplitude = 0.3_dp
    allocate (curve%c, source=c)
  end function curve_of

  !> An elastic contact that lifts off: x'' + 0.1 sqrt(12) x' + 12 x + f = 60 cos 5 t, y'' + 2 y' + 21 y + N = 100 + 60 cos 5 t,
  !> stiffness 5, mu = 0.85, N = 21 max(y, 0): the steady motion at t = 0 by two other codes.
  subroutine normal()
    type(tribo_model) :: model
    type(tribo_system) :: s
    type(tribo_driver) :: d
    real(dp) :: y(6)

    call model%create(2, 2)
    call model%set_mass([1.0_dp, 1.0_dp])
    call model%set_damping([0.1_dp*sqrt(12.0_dp), 2.0_dp])
    call model%set_stiffness([12.0_dp, 21.0_dp])
    call model%set_direction(reshape([1.0_dp, 0.0_dp, 0.0_dp, 1.0_dp], [2, 2]))
    call model%set_compliance([0.2_dp, 0.0_dp])
    call model%set_normal(1, 2, 0.85_dp, 21.0_dp, 0.0_dp)
    call s%create(model)
    call s%add_load(0.0_dp, cosine=[0.0_dp, 100.0_dp])
    call s%add_load(5.0_dp, cosine=[60.0_dp, 60.0_dp])
    call d%create(s, 'event')
    y = 0
    call d%find_periodic(0.0_dp, 2*acos(-1.0_dp)/5, y)
    call require(abs(y(1) + 5.44592597_dp) < 1e-8_dp, 'normal: x')
    call require(abs(y(3) - 7.32000819_dp) < 1e-8_dp, 'normal: velocity')
  end subroutine normal

  !> Stick-slip of a block on a belt at speed 0.2, m = k = 1, limit 0.6, at rest 1, in closed form.
  subroutine cycle_of_belt()
    type(tribo_model) :: model
    type(tribo_system) :: s
    type(tribo_driver) :: d
    type(tribo_context) :: c
    real(dp) :: y(3), period
    integer :: stat

    call model%create(1, 1)
    call model%set_mass([1.0_dp])
    call model%set_stiffness([1.0_dp])
    call model%set_direction(reshape([1.0_dp], [1, 1]))
    call s%create(model)
    call s%context(c)
    call c%set_limit(0.6_dp)
    call c%set_static([1/0.6_dp])
    call s%add_base_motion(0.0_dp, cosine=[0.2_dp])
    call d%create(s, 'exact')
    y = 0
    period = 0
    call d%find_cycle(0.0_dp, period, y)
    call require(abs(period - 8.0688878716_dp) < 1e-9_dp, 'cycle: period')
    call require(abs(y(1) - 1) < 1e-9_dp .and. abs(y(2) - 0.2_dp) < 1e-9_dp, 'cycle: state')
    period = -1
    call d%find_cycle(0.0_dp, period, y, stat)
    call require(stat == TRIBO_ERR_NOT_POSITIVE .and. abs(period + 1) < 1e-9_dp, 'cycle: a negative period')
    call d%find_cycle(0.0_dp, period, y(:2), stat)
    call require(stat == TRIBO_ERR_SIZE, 'cycle: a short state')
  end subroutine cycle_of_belt

  !> Three equal bodies in a ring, under a load of order 1: as without the ring, whose other direction is refused.
  subroutine ring_of_three()
    type(tribo_model) :: model, sector
    type(tribo_system) :: s
    type(tribo_driver) :: d
    type(tribo_context) :: c
    real(dp) :: y(7), ring(7), third
    integer :: j, stat

    third = 2*acos(-1.0_dp)/3
    call sector%create(2, 1)
    call sector%set_mass([1.0_dp, 0.0_dp])
    call sector%set_damping([0.1_dp, 0.0_dp])
    call sector%set_stiffness(reshape([1.5_dp, -0.5_dp, -0.5_dp, 0.5_dp], [2, 2]))
    call model%create(3, 3)
    call model%set_ring(sector, 3, stat)
    call require(stat == TRIBO_ERR_STATE, 'ring: a sector without directions')
    call sector%set_direction(reshape([1.0_dp, 0.0_dp], [1, 2]))
    call model%set_ring(sector, 2, stat)
    call require(stat == TRIBO_ERR_SIZE, 'ring: three bodies in two sectors')
    call model%set_ring(sector, 3)
    call s%create(model)
    call s%context(c)
    call c%set_limit(0.3_dp)
    call s%add_load(0.9_dp, cosine=[(cos(j*third), j=0, 2)], sine=[(sin(j*third), j=0, 2)])
    call d%create(s, 'exact')
    y = 0
    call d%find_periodic(0.0_dp, 3*third/0.9_dp, y)
    call d%set_ring(3, 1)
    ring = 0
    call d%find_periodic(0.0_dp, 3*third/0.9_dp, ring)
    call require(all(abs(ring - y) < 1e-11_dp) .and. abs(y(1)) > 0.1_dp, 'ring: the same motion')
    call d%set_ring(3, 2)
    call d%find_periodic(0.0_dp, 3*third/0.9_dp, ring, stat)
    call require(stat == TRIBO_ERR_RANGE, 'ring: the other direction')
    call d%set_ring(2, 1, stat)
    call require(stat == TRIBO_ERR_RANGE, 'ring: two sectors of three bodies')
    call d%set_ring(-3, 1, stat)
    call require(stat == TRIBO_ERR_NEGATIVE, 'ring: a negative number of sectors')
  end subroutine ring_of_three
end program models
