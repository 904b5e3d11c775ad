! SPDX-License-Identifier: BSD-3-Clause
!> Quinn (2004), Fig. 9, from Fortran: dissipation of the chain of 32 blocks over cycle 4 against the time step, for the paper's
!> three laws, and exactly.
!>
!>     paper_chain FOLDER
!>
!> Classical Runge-Kutta method as in the paper, dt = 10^-1.5 to 10^-3.5, epsilon in proportion. Writes FOLDER/fig9-fortran.csv
!> and FOLDER/values-paper_chain.txt.
program paper_chain
  use tribo
  use tribo_dynamics
  implicit none
  character(len=*), parameter :: laws(3) = [character(len=16) :: 'coulomb', 'velocity-limited', 'quinn']
  integer, parameter :: blocks = 32
  real(dp), parameter :: omega = 0.5_dp, period = 2*acos(-1.0_dp)/omega
  character(len=1000) :: folder
  real(dp) :: dt, exact, d(size(laws))
  integer :: k, i, table, values

  call get_command_argument(1, folder)
  if (folder == '') error stop 'usage: paper_chain FOLDER'
  open (newunit=table, file=trim(folder)//'/fig9-fortran.csv', action='write')
  open (newunit=values, file=trim(folder)//'/values-paper_chain.txt', action='write')

  exact = dissipation('quinn', 'exact', period)
  write (values, '(a, es24.16)') 'fortran.fig9.exact', exact
  write (table, '(*(a, :, ","))') 'dt', (trim(laws(i)), i=1, size(laws)), 'exact'
  do k = 3, 7
    dt = period/ceiling(period*10**(k/2.0_dp))
    do i = 1, size(laws)
      d(i) = dissipation(laws(i), 'rk4/fixed', dt)
      write (values, '(3a, i0, es24.16)') 'fortran.fig9.', trim(laws(i)), '.D', k, d(i)
      write (values, '(3a, i0, es24.16)') 'fortran.fig9.', trim(laws(i)), '.error', k, abs(d(i)/exact - 1)
    end do
    write (table, '(*(es20.12, :, ","))') dt, d, exact
  end do
  close (table)
  close (values)
  print '(a, f16.13, a, es8.1, a, es8.1)', 'fig9 from Fortran: exact D', exact, ', quinn off by', d(3)/exact - 1, ' at dt', dt

contains

  !> Energy that friction takes in cycle 4, from rest.
  real(dp) function dissipation(law, method, dt)
    character(len=*), intent(in) :: law, method
    real(dp), intent(in) :: dt
    type(tribo_system) :: chain
    type(tribo_context) :: contacts
    type(tribo_driver) :: driver
    real(dp) :: y(2*blocks + 1), t, before
    integer :: cycle

    call chain%chain(blocks, limit=1.0_dp, alpha=0.25_dp, omega=omega)
    call chain%context(contacts)
    call contacts%set_law(trim(law))
    call contacts%set_epsilon(10*omega*dt)
    call driver%create(chain, method)
    if (method == 'rk4/fixed') call driver%set_step(dt)
    t = 0
    y = 0
    before = 0
    do cycle = 1, 4
      before = y(size(y))
      call driver%advance(t, cycle*period, y)
    end do
    dissipation = y(size(y)) - before
  end function dissipation
end program paper_chain
