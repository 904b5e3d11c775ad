! SPDX-License-Identifier: BSD-3-Clause
!> Every procedure of module tribo that can succeed, with each of its results compared to that of the C call: scene.c plays the
!> same scene on its tape.
module results_mass
  use, intrinsic :: iso_c_binding
  use scene, only: scene_inverse_mass
  use tribo
  implicit none

  !> M**-1 of scene.c, and how often it has been asked for.
  type, extends(tribo_mass) :: mass_of_scene
    real(dp) :: shared
    integer :: calls = 0
  contains
    procedure :: apply
  end type mass_of_scene

contains

  !> Coulomb's law with friction that falls to data's part of the limit as contacts slide.
  integer(c_int) function falling(first, n, derivatives, v, limit, epsilon, box, data) bind(c)
    integer(c_size_t), value :: first, n
    integer(c_int), value :: derivatives
    real(c_double), intent(in) :: v(n), limit(n), epsilon(n)
    real(c_double), intent(inout) :: box(n, *)
    type(c_ptr), value :: data
    real(c_double), pointer :: part(:)

    call c_f_pointer(data, part, [first + n])
    box(:, 1) = merge(-limit, -sign(part(first + 1:)*limit, v), abs(v) <= epsilon)
    box(:, 2) = merge(limit, box(:, 1), abs(v) <= epsilon)
    box(:, 3) = 0
    if (derivatives == 1) box(:, 4:6) = 0
    falling = 0
  end function falling

  integer function apply(this, force, acceleration)
    class(mass_of_scene), intent(inout) :: this
    real(dp), intent(in) :: force(:)
    real(dp), intent(inout) :: acceleration(:)
    this%calls = this%calls + 1
    acceleration = scene_inverse_mass*force + this%shared*sum(force)
    apply = 0
  end function apply
end module results_mass

program results
  use, intrinsic :: iso_fortran_env, only: int64
  use check, only: report, require, same_bits
  use, intrinsic :: iso_c_binding, only: c_funloc, c_loc
  use results_mass, only: falling, mass_of_scene
  use scene
  use tape, only: compare, end_of_tape, record
  use tribo
  implicit none

  call record(scene_play)
  call registry()
  call contexts()
  call end_of_tape()
  call sections()
  call user_law()
  call no_contacts()
  call report()

contains

  subroutine registry()
    real(dp) :: parameters(12), z(2), state(5, 2)
    real(dp) :: f(n), df_dv(n), df_dfeq(n), df_dlimit(n), plane(2, n/2), turn(2, 2, n/2), pressed(3, 2), df(3, 3, 2)
    integer :: status, law, number, i, stat(n)

    call compare('tribo_version', tribo_version())
    call compare('tribo_version_string', tribo_version_string())
    do status = -1, 63
      call compare('tribo_strerror', tribo_strerror(status))
    end do
    call compare('tribo_law_count', tribo_law_count())
    do law = -1, tribo_law_count()
      call compare('tribo_law_name', tribo_law_name(law))
      call compare('tribo_law_reference', tribo_law_reference(law))
      f = 0
      df_dv = 0
      df_dfeq = 0
      df_dlimit = 0
      call tribo_law_eval(law, scene_v(:, 4), scene_feq(:, 4), scene_limit, scene_epsilon, f, df_dv, df_dfeq, df_dlimit, stat)
      do i = 1, n
        call compare('tribo_law_eval', stat(i))
        call compare('tribo_law_eval', [f(i), df_dv(i), df_dfeq(i), df_dlimit(i)])
      end do
    end do
    f = scene_feq(:, 4)
    call tribo_elastic_force(scene_v(:, 4), scene_epsilon, scene_limit, f, df_dv, stat(1))
    call compare('tribo_elastic_force', stat(1))
    call compare('tribo_elastic_force', f)
    call compare('tribo_elastic_force', df_dv)
    f = scene_feq(:, 4)
    call tribo_elastic_force(scene_v(:, 4), scene_epsilon, scene_limit, f)
    f = scene_feq(:, 4)
    plane = reshape(f, shape(plane))
    call tribo_elastic_force(reshape(scene_v(:, 4), shape(plane)), scene_epsilon(:n/2), scene_limit(:n/2), plane, turn, stat(1))
    call compare('tribo_elastic_force in the plane', stat(1))
    call compare('tribo_elastic_force in the plane', reshape(plane, [n]))
    call compare('tribo_elastic_force in the plane', reshape(turn, [2*n]))
    pressed = reshape([scene_feq(:, 4), scene_feq(:2, 5)], shape(pressed))
    call tribo_contact_force(reshape(scene_v(:, 4), [2, 2]), scene_limit(:2), scene_diagonal(:2), scene_diagonal(:2), &
      scene_epsilon(:2), pressed, df, stat(1))
    call compare('tribo_contact_force', stat(1))
    call compare('tribo_contact_force', reshape(pressed, [6]))
    call compare('tribo_contact_force', [transpose(df(:, :, 1)), transpose(df(:, :, 2))])
    pressed = reshape([scene_feq(:, 4), scene_feq(:2, 5)], shape(pressed))
    call tribo_contact_force(reshape(scene_v(:, 4), [2, 2]), scene_limit(:2), scene_diagonal(:2), scene_diagonal(:2), &
      scene_epsilon(:2), pressed)
    do law = 0, 3
      do i = 0, 11
        number = mod(i, n) + 1
        parameters(i + 1) = merge(1.0_dp, scene_epsilon(number) + 0.25_dp, law == 2 .and. (i == 4 .or. i == 9))
      end do
      z = 0
      state = 0
      f(:2) = 0
      select case (law)
      case (0)
        call tribo_dahl_force(scene_v(:2, 4), scene_epsilon(:2), scene_limit(:2), f(:2), df_dv(:2), stat(1))
      case (1)
        call tribo_lugre_force(0.5_dp, scene_v(:2, 4), reshape(parameters, [6, 2]), z, f(:2), df_dv(:2), stat(1))
      case (2)
        call tribo_bouc_wen_force(scene_v(:2, 4), reshape(parameters, [5, 2]), z, f(:2), df_dv(:2), stat(1))
      case (3)
        call tribo_iwan_force(1, scene_v(:2, 4), reshape(parameters, [4, 2]), state, f(:2), df_dv(:2), stat(1))
      end select
      call compare('a law with a state', stat(1))
      call compare('a law with a state', f(:2))
      call compare('a law with a state', df_dv(:2))
      call compare('a law with a state', z)
      call compare('a law with a state', reshape(state, [10]))
    end do
    do law = 0, tribo_law_count() - 1
      number = -1
      call tribo_law_find(tribo_law_name(law) // '  ', number)
      call require(number == law, 'tribo_law_find of ' // tribo_law_name(law))
      call tribo_law_eval(law, 1e-3_dp, 0.3_dp, 0.5_dp, 1e-2_dp, f(1), df_dlimit=df_dlimit(1))
      call tribo_law_eval(law, 1e-3_dp, 0.3_dp, 0.5_dp, 1e-2_dp, f(2), df_dv(2), df_dfeq(2), df_dlimit(2))
      call require(all(same_bits([f(1), df_dlimit(1)], [f(2), df_dlimit(2)])), 'tribo_law_eval of one derivative')
    end do
  end subroutine registry

  subroutine contexts()
    type(tribo_context) :: c, copy
    integer :: stat, form, setting, law

    call c%create(n, stat)
    call compare('create', stat)
    call compare('message', c%message())
    call settings(c)
    call queries(c)
    call c%set_normal_load(scene_epsilon, scene_limit, stat)
    call compare('set_normal_load', stat)
    call settings(c)
    call c%set_limit(scene_limit, stat)
    call compare('set_limit', stat)
    call c%set_epsilon(scene_epsilon, stat)
    call compare('set_epsilon', stat)
    call settings(c)
    do form = 1, 5
      call set_operator(c, form)
      do setting = 0, 2
        call c%set_coupling(mod(setting, 2), stat)
        call compare('set_coupling', stat)
        call c%set_sharing(setting/2, stat)
        call compare('set_sharing', stat)
        do law = 0, tribo_law_count() - 1
          if (mod(law, 2) == 0) then
            call c%set_law(law, stat)
          else
            call c%set_law(tribo_law_name(law), stat)
          end if
          call compare('set_law', stat)
          call settings(c)
          call forces(c)
        end do
      end do
    end do
    call c%set_coupling(TRIBO_CONSISTENT, stat)
    call compare('set_coupling', stat)
    call planar(c)
    call c%set_epsilon(step=0.01_dp, lambda_dt=0.4_dp, stat=stat)
    call compare('set_epsilon, step and lambda_dt', stat)
    call settings(c)
    call c%set_epsilon(step=0.01_dp, stat=stat)
    call compare('set_epsilon, step', stat)
    call settings(c)
    call forces(c)
    call c%set_static(1 + 32*scene_epsilon, stat=stat)
    call compare('set_static', stat)
    call settings(c)
    call forces(c)
    call c%set_static(1 + 32*scene_epsilon, scene_epsilon, stat)
    call compare('set_static, with velocity', stat)
    call settings(c)
    call forces(c)
    call c%set_epsilon(0.03125_dp, stat=stat)
    call compare('set_epsilon, scalar', stat)
    call c%set_limit(0.75_dp, stat)
    call compare('set_limit, scalar', stat)
    call settings(c)
    call c%clone(copy, stat)
    call compare('clone', stat)
    call copy%copy_settings(c, stat)
    call compare('copy_settings', stat)
    call c%set_law(TRIBO_SMOOTH, stat)
    call compare('set_law', stat)
    call forces(c)
    call settings(copy)
    call queries(copy)
    call forces(copy)
    call copy%fix_operator(stat)
    call compare('fix_operator', stat)
    call c%destroy()
    call c%destroy()
  end subroutine contexts

  subroutine planar(c)
    type(tribo_context), intent(inout) :: c
    real(dp) :: feq(n), f(n), x(2, n, 3)
    integer :: stat, k

    x = 0
    call c%set_planar([2], stat)
    call compare('set_planar', stat)
    do k = 1, states
      call c%balance(scene_v(:, k), scene_a(:, k), feq, f, stat)
      call compare('planar: balance', stat)
      call compare('planar: feq', feq)
      call compare('planar: f', f)
      call queries(c)
      call c%force_tangent_planar(scene_v(:, k), scene_feq(:, k), f, x(:, :, 1), x(:, :, 2), x(:, :, 3), stat)
      call compare('planar: force_tangent_planar', stat)
      call compare('planar: force_tangent_planar: f', f)
      call compare('planar: force_tangent_planar: derivatives', reshape(x, [6 * n]))
      call c%step_force_mean(0.125_dp, scene_a(:, k), scene_v(:, k), f, stat)
      call compare('planar: step_force_mean', stat)
      call compare('planar: step_force_mean: f', f)
      call queries(c)
    end do
    call c%set_planar([integer ::], stat)
    call compare('set_planar', stat)
  end subroutine planar

  subroutine set_operator(c, form)
    type(tribo_context), intent(inout) :: c
    integer, intent(in) :: form
    type(mass_of_scene) :: mass
    integer :: stat

    select case (form)
    case (1)
      call c%set_operator(scene_diagonal, stat)
    case (2)
      call c%set_operator(transpose(scene_dense), stat)
    case (3)
      call c%set_operator_csr(int(scene_rowptr) + 1, int(scene_col) + 1, scene_val, stat)
    case (4)
      call c%set_operator_mass(scene_inverse_mass, int(scene_j_rowptr) + 1, int(scene_j_col) + 1, scene_j_val, stat)
    case default
      mass%shared = scene_shared
      call c%set_operator_callback(ndof, mass, int(scene_j_rowptr) + 1, int(scene_j_col) + 1, scene_j_val, stat)
      call require(mass%calls == n, 'set_operator_callback: one call a contact')
    end select
    call compare('set_operator', stat)
    if (form == 1) call c%update_operator(scene_diagonal, stat)
    if (form == 3) call c%update_operator(scene_val, stat)
    if (form == 4) call c%update_operator(scene_j_val, stat)
    if (form == 1 .or. form == 3 .or. form == 4) call compare('update_operator', stat)
  end subroutine set_operator

  subroutine settings(c)
    type(tribo_context), intent(in) :: c
    integer :: stat, i
    real(dp) :: x(n), velocity(n)

    call c%get_ncontact(i, stat)
    call compare('get_ncontact', stat)
    call compare('get_ncontact', i)
    call c%get_law(i, stat)
    call compare('get_law', stat)
    call compare('get_law', i)
    call c%get_coupling(i, stat)
    call compare('get_coupling', stat)
    call compare('get_coupling', i)
    call c%get_sharing(i, stat)
    call compare('get_sharing', stat)
    call compare('get_sharing', i)
    call c%get_limit(x, stat)
    call compare('get_limit', stat)
    call compare('get_limit', x)
    call c%get_static(x, velocity, stat)
    call compare('get_static', stat)
    call compare('get_static', x)
    call compare('get_static', velocity)
    call c%get_epsilon(x, stat)
    call compare('get_epsilon', stat)
    call compare('get_epsilon', x)
  end subroutine settings

  subroutine queries(c)
    type(tribo_context), intent(in) :: c
    integer :: stat, mode(n), which, count
    integer(int64) :: long
    real(dp) :: value

    mode = 9
    call c%get_slip(mode, stat)
    call compare('get_slip', stat)
    call compare('get_slip', real(mode, dp))
    do which = 0, counts - 1
      call c%get_count(which, count, stat)
      call compare('get_count', stat)
      call compare('get_count', count)
      if (stat == TRIBO_OK) then
        call c%get_count(which, long)
        call require(long == count, 'get_count of a long integer')
      end if
    end do
    do which = 0, reals - 1
      call c%get_real(which, value, stat)
      call compare('get_real', stat)
      call compare('get_real', value)
    end do
  end subroutine queries

  subroutine forces(c)
    type(tribo_context), intent(inout) :: c
    real(dp), parameter :: wiped = huge(wiped)
    real(dp) :: f(n), feq(n), df_dv(n), df_dfeq(n), df_dlimit(n), jacobian_v(n, n), jacobian_a(n, n), df(n, 3)
    integer :: stat, k

    do k = 1, states
      associate (v => scene_v(:, k), a => scene_a(:, k), given => scene_feq(:, k))
        call c%force(v, given, f, stat)
        call compare('force', stat)
        call compare('force: f', f)
        f = wiped
        call c%force_tangent(v, given, f, df_dv, df_dfeq, df_dlimit, stat)
        call compare('force_tangent', stat)
        call compare('force_tangent: f', f)
        call compare('force_tangent: df_dv', df_dv)
        call compare('force_tangent: df_dfeq', df_dfeq)
        call compare('force_tangent: df_dlimit', df_dlimit)
        f = wiped
        call c%balance(v, a, feq, f, stat)
        call compare('balance', stat)
        call compare('balance: feq', feq)
        call compare('balance: f', f)
        call queries(c)
        feq = wiped
        f = wiped
        jacobian_v = 0
        jacobian_a = 0
        call c%balance_tangent(v, a, feq, f, jacobian_v, jacobian_a, stat)
        call compare('balance_tangent', stat)
        call compare('balance_tangent: feq', feq)
        call compare('balance_tangent: f', f)
        call compare('balance_tangent: df_dv', [transpose(jacobian_v)])
        call compare('balance_tangent: df_da', [transpose(jacobian_a)])
        df(:, 1) = feq ! where C's are on failure
        df(:, 2:) = reshape([df_dfeq, df_dlimit], [n, 2])
        call c%tangent_product(given, a, df(:, 1), stat)
        call compare('tangent_product', stat)
        call c%tangent_product(given, df=df(:, 2), stat=stat)
        call compare('tangent_product, dv', stat)
        call c%tangent_product(da=a, df=df(:, 3), stat=stat)
        call compare('tangent_product, da', stat)
        call compare('tangent_product: df', [df])
        call c%limit_product(a, df(:, 1), stat)
        call compare('limit_product', stat)
        call compare('limit_product: df', df(:, 1))
        f = wiped
        call c%step_force(0.125_dp, v, f, stat)
        call compare('step_force', stat)
        call compare('step_force: f', f)
        call queries(c)
        call c%step_force_mean(0.125_dp, a, v, f, stat)
        call compare('step_force_mean', stat)
        call compare('step_force_mean: f', f)
        f = wiped
        call c%solve_box(a, scene_lower, scene_upper, f, stat)
        call compare('solve_box', stat)
        call compare('solve_box: f', f)
        call c%accept(v, given, stat)
        call compare('accept', stat)
      end associate
    end do
  end subroutine forces

  !> Every array as a section with a stride, backwards or a row of a matrix, and outputs each by itself, against whole arrays.
  !> What lies between the elements of an output stays.
  subroutine sections()
    type(tribo_context) :: c, d
    real(dp), parameter :: gap = 5
    real(dp) :: x(n, 4), y(2*n, 4), wide(3, 2*n, 3), feq(n, 2), f(n, 2), q(n, n, 2), jacobian(2*n, n, 2)
    integer :: rowptr(2*(n + 1)), col(16), mode(2*n), straight(n), coupling, stat
    type(mass_of_scene) :: mass

    call c%create(n)
    call d%create(n)
    wide = gap
    wide(2, ::2, 1) = scene_limit
    wide(2, n:1:-1, 2) = scene_epsilon
    call c%set_limit(scene_limit)
    call d%set_limit(wide(2, ::2, 1))
    call c%set_epsilon(scene_epsilon)
    call d%set_epsilon(wide(2, n:1:-1, 2))
    y = gap
    call c%get_limit(x(:, 1))
    call d%get_limit(y(::2, 1))
    call c%get_epsilon(x(:, 2))
    call d%get_epsilon(y(2*n:1:-2, 2))
    call require(all(same_bits(x(:, 1), y(::2, 1))) .and. all(same_bits(y(2::2, 1), gap)), 'sections: limit')
    call require(all(same_bits(x(:, 2), y(2*n:1:-2, 2))) .and. all(same_bits(y(::2, 2), gap)), 'sections: epsilon')

    wide(2, :n, 1) = scene_diagonal
    call c%set_operator(scene_diagonal)
    call d%set_operator(wide(2, :n, 1))
    call compare_forces(c, d, 'diagonal')
    jacobian = gap
    jacobian(::2, :, 1) = scene_dense
    call c%set_operator(scene_dense)
    call d%set_operator(jacobian(::2, :, 1))
    call compare_forces(c, d, 'dense')
    rowptr = 99
    rowptr(::2) = int(scene_rowptr) + 1
    col = 99
    col(::2) = int(scene_col) + 1
    wide = gap
    wide(1, :, 1) = scene_val
    call c%set_operator_csr(int(scene_rowptr) + 1, int(scene_col) + 1, scene_val)
    call d%set_operator_csr(rowptr(::2), col(::2), wide(1, :, 1))
    call compare_forces(c, d, 'csr')
    rowptr(::2) = int(scene_j_rowptr) + 1
    col(:10:2) = int(scene_j_col) + 1
    wide(3, ndof:1:-1, 3) = scene_inverse_mass
    y(:5, 1) = scene_j_val(5:1:-1)
    call c%set_operator_mass(scene_inverse_mass, int(scene_j_rowptr) + 1, int(scene_j_col) + 1, scene_j_val)
    call d%set_operator_mass(wide(3, ndof:1:-1, 3), rowptr(::2), col(:10:2), y(5:1:-1, 1))
    call compare_forces(c, d, 'mass')
    call c%set_operator_mass(scene_inverse_mass, int(scene_j_rowptr) + 1, int(scene_j_col) + 1, 2*scene_j_val)
    call d%update_operator(2*y(5:1:-1, 1))
    call compare_forces(c, d, 'new values')
    call d%update_operator(y(4:1:-1, 1), stat)
    call require(stat == TRIBO_ERR_SIZE, 'too few values')
    mass%shared = scene_shared
    call c%set_operator_callback(ndof, mass, int(scene_j_rowptr) + 1, int(scene_j_col) + 1, scene_j_val)
    call d%set_operator_callback(ndof, mass, rowptr(::2), col(:10:2), y(5:1:-1, 1))
    call compare_forces(c, d, 'callback')

    call c%set_operator(scene_dense)
    do coupling = 0, 1
      call c%set_coupling(coupling)
      mode = 9
      call c%balance(scene_v(:, 2), scene_a(:, 2), feq(:, 1), f(:, 1))
      call c%balance(scene_v(:, 2), scene_a(:, 2))
      call c%balance(scene_v(:, 2), scene_a(:, 2), f=f(:, 2))
      call c%balance(scene_v(:, 2), scene_a(:, 2), feq(:, 2))
      call require(all(same_bits(f(:, 1), f(:, 2)) .and. same_bits(feq(:, 1), feq(:, 2))), 'balance of one output')
      call c%get_slip(straight)
      call c%get_slip(mode(2*n:1:-2))
      call require(all(mode(2*n:1:-2) == straight) .and. all(mode(1::2) == 9), 'sections: get_slip')
      call c%balance_tangent(scene_v(:, 2), scene_a(:, 2), df_dv=jacobian(:n, :, 1), df_da=jacobian(:n, :, 2))
      call c%balance_tangent(scene_v(:, 2), scene_a(:, 2), df_da=q(:, :, 2))
      call c%balance_tangent(scene_v(:, 2), scene_a(:, 2), df_dv=q(:, :, 1))
      call require(all(same_bits(q, jacobian(:n, :, :))), 'balance_tangent of one output')
    end do
  end subroutine sections

  !> c is asked by whole arrays, d by sections.
  subroutine compare_forces(c, d, label)
    type(tribo_context), intent(inout) :: c, d
    character(len=*), intent(in) :: label
    real(dp), parameter :: gap = 5
    real(dp) :: v(2, n), other(n, 3), x(n, 4), y(3, n, 4), q(n, n, 2), r(2*n, 2*n, 2)
    integer :: k

    do k = 1, states
      v(2, :) = scene_v(:, k)
      other(n:1:-1, 3) = scene_a(:, k)
      other(n:1:-1, 2) = scene_feq(:, k)
      y = gap
      call c%force(scene_v(:, k), scene_feq(:, k), x(:, 1))
      call d%force(v(2, :), other(n:1:-1, 2), y(2, :, 1))
      call c%step_force(0.5_dp, scene_v(:, k), x(:, 2))
      call d%step_force(0.5_dp, v(2, :), y(2, :, 2))
      call c%balance(scene_v(:, k), scene_a(:, k), x(:, 3), x(:, 4))
      call d%balance(v(2, :), other(n:1:-1, 3), y(2, :, 3), y(2, n:1:-1, 4))
      y(2, :, 4) = y(2, n:1:-1, 4)
      call require(all(same_bits(x, y(2, :, :))), 'sections: forces, ' // label)
      v(1, :) = scene_lower
      other(:, 1) = scene_upper(n:1:-1)
      call c%solve_box(scene_a(:, k), scene_lower, scene_upper, x(:, 1))
      call d%solve_box(other(n:1:-1, 3), v(1, :), other(n:1:-1, 1), y(2, n:1:-1, 1))
      call require(all(same_bits(x(:, 1), y(2, n:1:-1, 1))), 'sections: solve_box, ' // label)
      call c%force_tangent(scene_v(:, k), scene_feq(:, k), x(:, 1), x(:, 2), x(:, 3), x(:, 4))
      call d%force_tangent(v(2, :), other(n:1:-1, 2), y(2, :, 1), y(2, :, 2), y(2, :, 3), y(2, :, 4))
      call require(all(same_bits(x, y(2, :, :))), 'sections: force_tangent, ' // label)
      call d%force_tangent(v(2, :), other(n:1:-1, 2), df_dlimit=y(2, n:1:-1, 1))
      call require(all(same_bits(x(:, 4), y(2, n:1:-1, 1))), 'sections: force_tangent of one output, ' // label)
      r = gap
      call c%balance_tangent(scene_v(:, k), scene_a(:, k), x(:, 1), x(:, 2), q(:, :, 1), q(:, :, 2))
      call d%balance_tangent(v(2, :), other(n:1:-1, 3), y(2, :, 1), y(2, :, 2), r(2::2, ::2, 1), r(2*n:1:-2, 2::2, 2))
      r(2::2, ::2, 2) = r(2*n:1:-2, 2::2, 2)
      call require(all(same_bits(x(:, :2), y(2, :, :2))), 'sections: balance_tangent, ' // label)
      call c%tangent_product(scene_v(:, k), scene_a(:, k), x(:, 3))
      call d%tangent_product(v(2, :), other(n:1:-1, 3), y(2, n:1:-1, 3))
      call require(all(same_bits(x(:, 3), y(2, n:1:-1, 3))), 'sections: tangent_product, ' // label)
      call c%limit_product(scene_a(:, k), x(:, 3))
      call d%limit_product(other(n:1:-1, 3), y(2, n:1:-1, 3))
      call require(all(same_bits(x(:, 3), y(2, n:1:-1, 3))), 'sections: limit_product, ' // label)
      call require(all(same_bits(q, r(2::2, ::2, :))), 'sections: balance_tangent, matrices, ' // label)
      call require(all(same_bits(y([1, 3], :, :), gap)), 'sections: between vectors, ' // label)
      call require(all(same_bits(r(1::2, 1::2, :), gap)), 'sections: between matrices, ' // label)
      call c%accept(scene_v(:, k), scene_feq(:, k))
      call d%accept(v(2, :), other(n:1:-1, 2))
    end do
  end subroutine compare_forces

  !> A law of the program, in a context and in its clone.
  subroutine user_law()
    type(tribo_context) :: c, copy
    real(dp), target :: part(3) = [0.5_dp, 0.25_dp, 0.75_dp]
    real(dp) :: f(3), feq(3), df_dv(3), df_dfeq(3)
    integer :: law

    call c%create(3)
    call c%set_limit([1.0_dp, 2.0_dp, 4.0_dp])
    call c%set_epsilon(0.1_dp)
    call c%set_operator([1.0_dp, 1.0_dp, 1.0_dp])
    call c%set_user_law(c_funloc(falling), c_loc(part))
    call c%get_law(law)
    call require(law == TRIBO_USER_LAW, 'number of a law of the caller')
    call c%clone(copy)
    call copy%balance([1.0_dp, 0.0_dp, -1.0_dp], [0.3_dp, 0.3_dp, 0.3_dp], feq, f)
    call require(maxval(abs(f - [-0.5_dp, -0.3_dp, 3.0_dp])) <= 0, 'law of the caller: balance')
    call c%force_tangent([1.0_dp, 0.0_dp, -1.0_dp], feq, f, df_dv, df_dfeq)
    call require(maxval(abs([f - [-0.5_dp, -0.3_dp, 3.0_dp], df_dv, df_dfeq - [0, 1, 0]])) <= 0, &
      'law of the caller: derivatives')
  end subroutine user_law

  !> No contacts at all are fine everywhere.
  subroutine no_contacts()
    type(tribo_context) :: c
    type(mass_of_scene) :: mass
    real(dp) :: x(0), q(0, 0)
    integer :: mode(0), i

    call c%create(0)
    call c%set_limit(x)
    call c%set_epsilon(x)
    call c%set_operator(x)
    call c%set_operator(q)
    call c%set_operator_csr([1], mode, x)
    call c%set_operator_mass(x, [1], mode, x)
    call c%set_operator_callback(0, mass, [1], mode, x)
    call c%force(x, x, x)
    call c%force_tangent(x, x, x, x, x, x)
    call c%balance(x, x, x, x)
    call c%balance_tangent(x, x, x, x, q, q)
    call c%tangent_product(x, x, x)
    call c%limit_product(x, x)
    call c%solve_box(x, x, x, x)
    call c%step_force(1.0_dp, x, x)
    call c%accept(x, x)
    call c%get_slip(mode)
    call c%get_count(TRIBO_COUNT_STUCK, i)
    call require(i == 0 .and. mass%calls == 0, 'no contacts')
  end subroutine no_contacts
end program results
