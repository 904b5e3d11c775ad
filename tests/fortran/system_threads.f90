! SPDX-License-Identifier: BSD-3-Clause
!> Systems, their contexts and drivers in several threads at once, all of one thread's own: the bits of one thread alone.
program system_threads
  use check, only: alive, report, require, same_bits
  use tribo
  use tribo_dynamics
  implicit none

  integer, parameter :: jobs = 32
  real(dp) :: alone(11, jobs), among(11, jobs)
  logical :: fine(jobs), still_fine(jobs)
  integer :: i

  do i = 1, jobs
    call job(i, alone(:, i), fine(i))
  end do
  !$omp parallel do schedule(dynamic)
  do i = 1, jobs
    call job(i, among(:, i), still_fine(i))
  end do
  !$omp end parallel do
  call require(all(same_bits(alone, among)), 'the same bits alone and among others')
  call require(all(fine) .and. all(still_fine), 'every thread has its own message')
  call require(all(abs(alone(1, 2:) - alone(1, 1)) > 0), 'jobs differ')
  call require(alive() == 0, 'everything is destroyed')
  call report()

contains

  subroutine job(i, y, fine)
    integer, intent(in) :: i
    real(dp), intent(inout) :: y(:)
    logical, intent(inout) :: fine
    type(tribo_system) :: chain
    type(tribo_driver) :: driver
    type(tribo_context) :: contacts
    character(len=60) :: text, wanted
    integer :: stat, k
    real(dp) :: t

    fine = .true.
    write (wanted, '(a,i0,a)') 'limit = -', i, ' is negative'
    do k = 1, 20
      call chain%chain(5, 0.01_dp*i, 1.0_dp, 0.5_dp)
      call chain%context(contacts)
      call contacts%set_limit(-1.0_dp*i, stat, text)
      fine = fine .and. stat == TRIBO_ERR_NEGATIVE .and. text == wanted
      call driver%create(chain, 'exact')
      t = 0
      y = 0
      call driver%advance(t, 10.0_dp, y)
    end do
  end subroutine job
end program system_threads
