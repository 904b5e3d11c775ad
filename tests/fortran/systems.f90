! SPDX-License-Identifier: BSD-3-Clause
!> Every procedure of module tribo_dynamics that can succeed, with each of its results compared to that of the C call: systems.c plays
!> the same on its tape.
module counting
  use tribo, only: dp
  use tribo_dynamics, only: tribo_moment, tribo_observer
  implicit none
  private

  !> Adds up what it sees, and has enough after most times.
  type, extends(tribo_observer), public :: counter
    real(dp) :: sums(5) = 0, most = 0
  contains
    procedure :: seen => count_up
  end type counter

contains

  integer function count_up(this, moment)
    class(counter), intent(inout) :: this
    type(tribo_moment), intent(in) :: moment
    this%sums = this%sums + [1.0_dp, moment%t, moment%y(size(moment%y)), real(moment%kind, dp), real(moment%contact, dp)]
    count_up = merge(3, 0, this%sums(1) >= this%most)
  end function count_up
end module counting

program systems
  use, intrinsic :: iso_fortran_env, only: int64
  use check, only: alive, report, require, same_bits
  use counting, only: counter
  use making, only: make_linear, make_reduced
  use tape, only: compare, end_of_tape, record
  use tribo
  use tribo_dynamics
  implicit none

  interface
    subroutine systems_play() bind(c)
    end subroutine systems_play
  end interface

  integer, parameter :: dof = 4, ncontact = 3, knots = 3
  real(dp), parameter :: mass(dof, dof) = reshape([real(dp) :: 2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1.5, 0, 0, 0, 0, 0.5], [dof, dof]), &
    stiffness(dof, dof) = reshape([real(dp) :: 3, -1, 0, 0, -1, 2, -1, 0, 0, -1, 2, -1, 0, 0, -1, 1], [dof, dof]), &
    damping(dof, dof) = reshape([0.3_dp, -0.1_dp, 0.0_dp, 0.0_dp, -0.05_dp, 0.2_dp, -0.1_dp, 0.0_dp, &
    0.0_dp, -0.1_dp, 0.2_dp, -0.1_dp, 0.0_dp, 0.0_dp, -0.1_dp, 0.1_dp], [dof, dof]), &
    direction(ncontact, dof) = reshape([real(dp) :: 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 2], [ncontact, dof]), &
    cosine(dof) = [1.0_dp, 0.0_dp, -0.5_dp, 0.25_dp], sine(dof) = [0.0_dp, 0.75_dp, 0.0_dp, 0.5_dp], &
    limits(ncontact) = [0.2_dp, 0.1_dp, 0.05_dp], motion(ncontact) = [0.1_dp, 0.0_dp, -0.2_dp], &
    times(knots) = [0.0_dp, 1.0_dp, 3.0_dp], values(knots) = [0.0_dp, 1.0_dp, 0.5_dp], &
    limit_table(ncontact, knots) = reshape([0.2_dp, 0.1_dp, 0.05_dp, 0.3_dp, 0.2_dp, 0.1_dp, 0.1_dp, 0.0_dp, 0.15_dp], &
    [ncontact, knots])

  call record(systems_play)
  call methods()
  call all_systems()
  call periodic()
  call end_of_tape()
  call sections()
  call require(alive() == 0, 'everything is destroyed')
  call report()

contains

  subroutine methods()
    integer :: i
    call compare('tribo_method_count', tribo_method_count())
    do i = -1, tribo_method_count()
      call compare('tribo_method_name', tribo_method_name(i))
    end do
  end subroutine methods

  subroutine all_systems()
    type(tribo_system) :: sys
    type(tribo_sparse) :: m, c, k, j
    integer :: stat

    call sys%oscillator(0.4_dp, 1.0_dp, 0.75_dp, stat)
    call compare('oscillator', stat)
    call reference(sys)
    call sys%chain(5, 0.1_dp, 1.0_dp, 0.5_dp, stat)
    call compare('chain', stat)
    call reference(sys)
    call sys%belt(1.5_dp, 0.3_dp, 0.2_dp, 1.0_dp, 0.8_dp, stat)
    call compare('belt', stat)
    call reference(sys)
    call make_linear(sys, mass, stiffness, direction, stat=stat)
    call compare('linear', stat)
    call linear(sys, .false.)
    call make_linear(sys, mass, stiffness, direction, damping, stat=stat)
    call compare('linear', stat)
    call linear(sys, .false.)
    call make_linear(sys, mass, stiffness, direction, nmode=2, stat=stat)
    call compare('linear', stat)
    call linear(sys, .true.)
    ! Mass and direction by triplets, backwards; the others by rows.
    call m%set_coo(dof, dof, [4, 3, 2, 1], [4, 3, 2, 1], [0.5_dp, 1.5_dp, 1.0_dp, 2.0_dp])
    call j%set_coo(ncontact, dof, [3, 2, 2, 1], [4, 3, 2, 1], [real(dp) :: 2, -1, 1, 1])
    call k%set_csr(dof, [1, 3, 6, 9, 11], [1, 2, 2, 1, 3, 2, 3, 4, 3, 4], [real(dp) :: 3, -1, 2, -1, -1, -1, 2, -1, -1, 1])
    call c%set_csr(dof, [1, 3, 6, 9, 11], [1, 2, 2, 1, 3, 2, 3, 4, 3, 4], &
      [0.3_dp, -0.05_dp, 0.2_dp, -0.1_dp, -0.1_dp, -0.1_dp, 0.2_dp, -0.1_dp, -0.1_dp, 0.1_dp])
    call make_linear(sys, [dof, ncontact], m, k, j, stat=stat)
    call compare('linear, sparse', stat)
    call linear(sys, .false.)
    call make_linear(sys, [dof, ncontact], m, k, j, c, stat=stat)
    call compare('linear, sparse', stat)
    call linear(sys, .false.)
    call make_linear(sys, [dof, ncontact], m, k, j, nmode=2, stat=stat)
    call compare('linear, sparse', stat)
    call linear(sys, .true.)
    call make_reduced(sys, [dof, ncontact], m, k, j, 2, .false., stat)
    call compare('reduced', stat)
    call linear(sys, .true.)
    call make_reduced(sys, [dof, ncontact], m, k, j, 1, stat=stat)
    call compare('reduced, statics', stat)
    call truncation(sys)
  end subroutine all_systems

  subroutine truncation(sys)
    type(tribo_system), intent(in) :: sys
    real(dp) :: error
    integer :: stat
    call sizes(sys)
    call sys%get_truncation(0.25_dp, error, stat)
    call compare('get_truncation', stat)
    call compare('get_truncation', error)
  end subroutine truncation

  subroutine sizes(sys)
    type(tribo_system), intent(in) :: sys
    call compare('ndof', sys%ndof())
    call compare('ncontact', sys%ncontact())
    call compare('dimension', sys%dimension())
  end subroutine sizes

  subroutine reference(sys)
    type(tribo_system), intent(inout) :: sys
    type(tribo_system) :: copy
    type(tribo_context) :: c
    integer :: stat, i

    call sizes(sys)
    call sys%context(c)
    call c%set_epsilon(0.05_dp, stat=stat)
    call compare('set_epsilon of the context', stat)
    call state(sys)
    do i = 0, tribo_method_count() - 1
      call run(sys, tribo_method_name(i) // '  ', 1e9_dp)
    end do
    call sys%clone(copy, stat)
    call compare('clone', stat)
    call sys%clear_loads(stat)
    call compare('clear_loads', stat)
    call run(sys, 'central/fixed', 1e9_dp)
    call run(copy, 'central/fixed', 1e9_dp)
  end subroutine reference

  subroutine linear(sys, reduced)
    type(tribo_system), intent(inout) :: sys
    logical, intent(in) :: reduced
    type(tribo_context) :: c
    real(dp) :: omega(2), full(dof), limits_now(ncontact)
    integer :: stat, stuck, slip(ncontact)

    call sizes(sys)
    call sys%context(c)
    call c%set_limit(limits, stat)
    call compare('set_limit of the context', stat)
    call c%set_epsilon(step=0.05_dp, stat=stat)
    call compare('set_epsilon of the context', stat)
    call sys%add_load(1.25_dp, cosine, sine, stat)
    call compare('add_load', stat)
    call sys%add_load(2.0_dp, sine=cosine, stat=stat)
    call compare('add_load', stat)
    call sys%add_load(0.0_dp, sine, stat=stat)
    call compare('add_load', stat)
    call sys%add_base_motion(0.75_dp, motion, stat=stat)
    call compare('add_base_motion', stat)
    call sys%add_base_motion(0.5_dp, sine=limits, stat=stat)
    call compare('add_base_motion', stat)
    call sys%add_limit(1.5_dp, limits, motion, stat)
    call compare('add_limit', stat)
    call sys%add_limit(0.5_dp, sine=limits, stat=stat)
    call compare('add_limit', stat)
    if (reduced) then
      call sys%set_damping_ratio(0.02_dp, stat)
      call compare('set_damping_ratio', stat)
      call sys%get_frequencies(omega, stat)
      call compare('get_frequencies', stat)
      call compare('get_frequencies', omega)
      call sys%expand([0.25_dp, -0.5_dp], full, stat)
      call compare('expand', stat)
      call compare('expand', full)
    end if
    call state(sys)
    call run(sys, 'exact', 1e9_dp)
    call run(sys, 'auto', 4.0_dp)
    call run(sys, 'rk4/fixed', 7.0_dp)
    call sys%add_load_table(times, values, sine, stat)
    call compare('add_load_table', stat)
    call sys%add_base_table(times, values, limit_table(:, 1), stat)
    call compare('add_base_table', stat)
    call sys%set_limit_table(times, limit_table, stat)
    call compare('set_limit_table', stat)
    call state(sys)
    call run(sys, 'event', 1e9_dp)
    call run(sys, 'central/fixed', 1e9_dp)
    call sys%get_limit(1.25_dp, limits_now, stat)
    call compare('get_limit', stat)
    call compare('get_limit', limits_now)
    call sys%get_slip(slip, stat)
    call compare('get_slip', stat)
    call compare('get_slip', real(slip, dp))
    call sys%get_count(TRIBO_COUNT_STUCK, stuck, stat)
    call compare('get_count', stat)
    call compare('get_count', stuck)
    call sys%clear_limits(stat)
    call compare('clear_limits', stat)
    call sys%clear_base_motion(stat)
    call compare('clear_base_motion', stat)
    call run(sys, 'moreau/fixed', 1e9_dp)
  end subroutine linear

  subroutine state(sys)
    type(tribo_system), intent(inout) :: sys
    real(dp), dimension(sys%dimension()) :: y, dydt, dfdt
    real(dp), dimension(sys%ncontact()) :: v, feq, f
    real(dp) :: dfdy(sys%dimension(), sys%dimension())
    integer :: i, stat

    y = [(0.1_dp*i - 0.35_dp, i=1, size(y))]
    call sys%derivative(0.5_dp, y, dydt, stat)
    call compare('derivative', stat)
    call compare('derivative', dydt)
    call sys%jacobian(0.5_dp, y, dfdy, dfdt, stat)
    call compare('jacobian', stat)
    call compare('jacobian: dfdy', [transpose(dfdy)])
    call compare('jacobian: dfdt', dfdt)
    call sys%contacts(0.5_dp, y, v, feq, f, stat)
    call compare('contacts', stat)
    call compare('contacts: v', v)
    call compare('contacts: feq', feq)
    call compare('contacts: f', f)
    call sys%accept(0.5_dp, y, stat)
    call compare('accept', stat)
  end subroutine state

  subroutine run(sys, method, most)
    type(tribo_system), intent(inout) :: sys
    character(len=*), intent(in) :: method
    real(dp), intent(in) :: most
    type(tribo_driver) :: drv
    type(counter), target :: sees
    real(dp) :: y(sys%dimension()), t, value
    integer :: stat, which, count
    integer(int64) :: long

    y = 0
    t = 0
    call drv%create(sys, method, stat=stat)
    call compare('create', stat)
    call drv%set_step(0.05_dp, stat)
    call compare('set_step', stat)
    call drv%set_tolerance(1e-5_dp, 1e-5_dp, stat)
    call compare('set_tolerance', stat)
    call drv%set_output(0.05_dp, stat)
    call compare('set_output', stat)
    call compare('method', drv%method())
    call drv%set_max_step(0.04_dp, stat)
    call compare('set_max_step', stat)
    call drv%advance(t, 0.5_dp, y, stat)
    call compare('advance', stat)
    sees%most = most
    call drv%set_observer(sees, stat)
    call compare('set_observer', stat)
    call drv%advance(t, 2.5_dp, y, stat)
    call compare('advance', stat)
    call compare('advance: t', t)
    call compare('advance: y', y)
    call compare('what an observer sees', sees%sums)
    call drv%set_observer(stat=stat)
    call compare('set_observer', stat)
    call drv%advance(t, 3.0_dp, y, stat)
    call compare('advance', stat)
    call compare('what an observer no longer sees', sees%sums)
    call compare('advance: y', y)
    do which = TRIBO_COUNT_STEPS, TRIBO_COUNT_RESTED
      count = 0
      call drv%count(which, count, stat)
      call compare('count', stat)
      call compare('count', count)
      if (stat == TRIBO_OK) call drv%count(which, long)
      call require(stat /= TRIBO_OK .or. long == count, 'count of a long integer')
    end do
    do which = TRIBO_REAL_EXCESS, TRIBO_REAL_BACKSLIP
      value = -1
      call drv%real(which, value, stat)
      call compare('real', stat)
      call compare('real', value)
    end do
  end subroutine run

  !> What the period of a forced oscillator holds.
  subroutine periodic()
    type(tribo_system) :: sys
    type(tribo_driver) :: drv
    real(dp), parameter :: period = 8.975979010256552_dp, c(2) = [1.0_dp, 0.5_dp]
    real(dp) :: y(3), re(2), im(2), a, b, at(2), contact(1), by_extremes(2, 3), by_energy(1, 3), by_y(3, 3)
    integer :: stat, freedom

    y = 0
    call sys%oscillator(0.3_dp, 1.0_dp, 0.7_dp, stat)
    call compare('oscillator', stat)
    call drv%create(sys, 'exact')
    call drv%get_multipliers(re, im, stat)
    call compare('get_multipliers', stat)
    freedom = -1
    call drv%get_freedom(freedom, stat)
    call compare('get_freedom', stat)
    call require(freedom == -1, 'get_freedom: output')
    call drv%find_periodic(0.5_dp, period, y, stat)
    call compare('find_periodic', stat)
    call compare('find_periodic: y', y)
    call drv%get_freedom(freedom, stat)
    call compare('get_freedom', freedom)
    call drv%get_multipliers(re, im)
    call compare('get_multipliers: re', re)
    call compare('get_multipliers: im', im)
    call drv%period_extremes(c, a, b, stat=stat)
    call compare('period_extremes', stat)
    call compare('period_extremes: least', a)
    call compare('period_extremes: most', b)
    call drv%period_extremes(c, a, b, at(1), at(2), stat)
    call compare('period_extremes', stat)
    call compare('period_extremes: extremes', [a, b])
    call compare('period_extremes: times', at)
    call drv%period_harmonic(c, 3, a, b, stat)
    call compare('period_harmonic', stat)
    call compare('period_harmonic: cosine', a)
    call compare('period_harmonic: sine', b)
    call drv%period_harmonic(c, -1, a, b, stat)
    call require(stat == TRIBO_ERR_NEGATIVE, 'a negative harmonic')
    call drv%period_dissipation(contact, stat)
    call compare('period_dissipation', stat)
    call compare('period_dissipation: energy', contact)
    call drv%period_stick(contact, stat)
    call compare('period_stick', stat)
    call compare('period_stick: share', contact)
    call drv%period_derivatives([TRIBO_PARAMETER_LIMIT, TRIBO_PARAMETER_LOADS, TRIBO_PARAMETER_FREQUENCY], [1, 0, 0], c, &
      by_extremes, by_energy, by_y, stat)
    call compare('period_derivatives', stat)
    call compare('period_derivatives: extremes', reshape(by_extremes, [6]))
    call compare('period_derivatives: energy', reshape(by_energy, [3]))
    call compare('period_derivatives: y', reshape(by_y, [size(by_y)]))
    call drv%period_derivatives([TRIBO_PARAMETER_LIMIT], [2], c, by_extremes(:, :1), stat=stat)
    call require(stat == TRIBO_ERR_RANGE, 'a limit of no contact')
    call drv%period_derivatives([TRIBO_PARAMETER_LIMIT], [1], c, by_extremes(:, :2), stat=stat)
    call require(stat == TRIBO_ERR_SIZE, 'more derivatives than parameters')
    call drv%multiplier_derivatives(1, [TRIBO_PARAMETER_LIMIT, TRIBO_PARAMETER_FREQUENCY], [1, 0], re, im, stat)
    call compare('multiplier_derivatives', stat)
    call compare('multiplier_derivatives: re', re)
    call compare('multiplier_derivatives: im', im)
    call drv%multiplier_derivatives(3, [TRIBO_PARAMETER_LIMIT], [1], re(:1), im(:1), stat)
    call require(stat == TRIBO_ERR_RANGE, 'no such multiplier')
  end subroutine periodic

  !> Arrays as sections against whole arrays, and outputs each by itself.
  subroutine sections()
    type(tribo_system) :: a, b
    type(tribo_driver) :: drv
    type(tribo_context) :: c
    real(dp), parameter :: gap = 5
    real(dp) :: wide(2*dof, 2*dof, 3), rows(2, 3*dof), x(9, 4), y(2, 9, 4), q(9, 9), r(18, 9), t
    integer :: i

    wide = gap
    wide(::2, ::2, 1) = mass
    wide(2:2*ncontact:2, :dof, 3) = direction
    call make_linear(a, mass, stiffness, direction)
    call make_linear(b, wide(::2, ::2, 1), stiffness, wide(2:2*ncontact:2, :dof, 3))
    rows = gap
    rows(1, :dof) = cosine
    rows(2, 3*dof:2*dof + 1:-1) = sine
    call a%add_load(1.0_dp, cosine, sine)
    call b%add_load(1.0_dp, rows(1, :dof), rows(2, 3*dof:2*dof + 1:-1))
    rows(1, :ncontact) = motion
    call a%add_base_motion(1.0_dp, motion, motion)
    call b%add_base_motion(1.0_dp, rows(1, :ncontact), rows(1, :ncontact))
    call a%add_limit(2.0_dp, motion, motion)
    call b%add_limit(2.0_dp, rows(1, :ncontact), rows(1, :ncontact))
    call a%add_load_table(times, values, sine)
    rows(1, 1::4) = times
    rows(1, 2::4) = values
    call b%add_load_table(rows(1, 1::4), rows(1, 2::4), rows(2, 3*dof:2*dof + 1:-1))
    wide(:2*ncontact:2, ::3, 1) = limit_table
    call a%set_limit_table(times, limit_table)
    call b%set_limit_table(rows(1, 1::4), wide(:2*ncontact:2, ::3, 1))
    call a%context(c)
    call c%set_epsilon(0.1_dp)
    call b%context(c)
    call c%set_epsilon(0.1_dp)
    y = gap
    y(1, :, 1) = [(0.1_dp*i - 0.35_dp, i=1, 9)]
    x(:, 1) = y(1, :, 1)
    call a%derivative(0.5_dp, x(:, 1), x(:, 2))
    call b%derivative(0.5_dp, y(1, :, 1), y(1, 9:1:-1, 2))
    call require(all(same_bits(x(:, 2), y(1, 9:1:-1, 2))), 'sections: derivative')
    call a%jacobian(0.5_dp, x(:, 1), q, x(:, 3))
    call b%jacobian(0.5_dp, y(1, :, 1), r(::2, :), y(1, :, 3))
    call require(all(same_bits(q, r(::2, :))) .and. all(same_bits(x(:, 3), y(1, :, 3))), 'sections: jacobian')
    call a%contacts(0.5_dp, x(:, 1), x(:3, 2), x(:3, 3), x(:3, 4))
    call b%contacts(0.5_dp, y(1, :, 1), v=y(1, :5:2, 2))
    call b%contacts(0.5_dp, y(1, :, 1), feq=y(1, 3:1:-1, 3))
    call b%contacts(0.5_dp, y(1, :, 1), f=y(1, :3, 4))
    call b%contacts(0.5_dp, y(1, :, 1))
    y(1, :3, 2) = y(1, :5:2, 2)
    y(1, :3, 3) = y(1, 3:1:-1, 3)
    call require(all(same_bits(x(:3, 2:), y(1, :3, 2:))), 'sections: contacts')
    call a%accept(0.5_dp, x(:, 1))
    call b%accept(0.5_dp, y(1, :, 1))
    t = 0.5_dp
    call drv%create(a, 'rk4/fixed', step=0.01_dp)
    call drv%advance(t, 1.0_dp, x(:, 1))
    t = 0.5_dp
    call drv%create(b, 'rk4/fixed', 0.01_dp)
    call drv%advance(t, 1.0_dp, y(1, :, 1))
    call require(all(same_bits(x(:, 1), y(1, :, 1))) .and. all(same_bits(y(2, :, :), gap)), 'sections: advance')
    call make_linear(a, mass, stiffness, direction, nmode=2)
    call a%get_frequencies(x(:2, 1))
    call a%get_frequencies(y(1, :9:8, 1))
    call require(all(same_bits(x(:2, 1), y(1, ::8, 1))), 'sections: get_frequencies')
    call a%expand(x(:2, 1), x(:dof, 2))
    call a%expand(y(1, ::8, 1), y(1, 2*dof:1:-2, 2))
    call require(all(same_bits(x(:dof, 2), y(1, 2*dof:1:-2, 2))), 'sections: expand')
    call drv%destroy()
  end subroutine sections
end program systems
