! SPDX-License-Identifier: BSD-3-Clause
!> For legacy_systems.f: its tape.
subroutine syplay()
  use tape, only: record
  implicit none
  interface
    subroutine play() bind(c, name='legacy_systems_play')
    end subroutine play
  end interface
  call record(play)
end subroutine syplay
