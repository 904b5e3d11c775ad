! SPDX-License-Identifier: BSD-3-Clause
!> The data of scene.c, and what records its tape.
module scene
  use, intrinsic :: iso_c_binding, only: c_double, c_size_t
  implicit none
  private
  public :: scene_play

  integer, parameter, public :: n = 4, ndof = 6, states = 5, counts = 10, reals = 3

  real(c_double), bind(c), public :: scene_limit(n), scene_epsilon(n), scene_diagonal(n), scene_dense(n, n)
  integer(c_size_t), bind(c), public :: scene_rowptr(n + 1), scene_col(8), scene_j_rowptr(n + 1), scene_j_col(5)
  real(c_double), bind(c), public :: scene_val(8), scene_inverse_mass(ndof), scene_j_val(5), scene_shared
  real(c_double), bind(c), public :: scene_lower(n), scene_upper(n)
  real(c_double), bind(c), public :: scene_v(n, states), scene_a(n, states), scene_feq(n, states)

  interface
    subroutine scene_play() bind(c)
    end subroutine scene_play
  end interface
end module scene
