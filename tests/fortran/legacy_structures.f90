! SPDX-License-Identifier: BSD-3-Clause
!> For legacy_structures.f: its tape.
subroutine stplay()
  use tape, only: record
  implicit none
  interface
    subroutine play() bind(c, name='legacy_structures_play')
    end subroutine play
  end interface
  call record(play)
end subroutine stplay
