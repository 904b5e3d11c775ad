! SPDX-License-Identifier: BSD-3-Clause
!
!     User subroutine CLOAD of CalculiX, called for each load of
!     *CLOAD,USER in each increment: friction by tribo, and harmonic
!     loads. Reads friction.txt:
!
!         contacts, loads, way, omega, time of the record's beginning
!         node, direction, limit, row of R     of each contact
!         node, direction, amplitude           of each load
!
!     way: 1 Coulomb's law over the step; 2 Quinn's law with
!     lambda dt = 0.2; 3 a spring before the slider of each contact:
!     the first number in the row of R is the stiffness of the spring.
!     R, accelerations of contacts by their forces, is that of the
!     modes. Writes record.txt: time, velocity at the first load,
!     velocity and force of each contact.
!
!     CalculiX gives displacements and velocities at the start of the
!     increment, and lets loads vary linearly to what CLOAD returns.
!     Acceleration by springs and loads is extrapolated from the last
!     two increments. The force at the end has the share 1/2 of the
!     increment; with that, forces of contacts that stick would ring
!     from increment to increment for ever. A share of 0.6 makes that
!     fall to 0.41 of it in each.
!
      subroutine cload(xload,kstep,kinc,time,node,idof,coords,vold,
     &  mi,ntrans,trab,inotr,veold)
      implicit none
      integer kstep,kinc,node,idof,mi(*),ntrans,inotr(2,*)
      real*8 xload,time(2),coords(3),vold(0:mi(2),*),trab(7,*),
     &  veold(0:mi(2),*)
!
      integer most
      parameter(most=20)
      integer n,nload,way,nodes(most),dofs(most),lnode(most),
     &  ldof(most),ih,ierr,i,j,known
      real*8 limit(most),r(most,most),amp(most),omega,begin,last,
     &  v(most),v0(most),f(most),f0(most),a(most),a0(most),ax(most),
     &  vfree(most),feq(most),dt,share,
     &  dz(most),held(most),stiff(most),dfdz(most)
      character*200 text
      save n,nload,way,nodes,dofs,lnode,ldof,ih,known,limit,r,amp,
     &  omega,begin,last,v0,f,f0,a0,held,stiff
      data ih /0/, ierr /0/, share /0.6d0/
!
      if(ih.eq.0) then
        open(71,file='friction.txt',status='old')
        read(71,*) n,nload,way,omega,begin
        do i=1,n
          read(71,*) nodes(i),dofs(i),limit(i),(r(i,j),j=1,n)
          f(i)=0.d0
          v0(i)=0.d0
          held(i)=0.d0
          stiff(i)=r(i,1)
        enddo
        do i=1,nload
          read(71,*) lnode(i),ldof(i),amp(i)
        enddo
        close(71)
        open(72,file='record.txt')
        call trbnew(n,ih,ierr)
        if(ierr.eq.0) call trblim(ih,n,limit,ierr)
        if(ierr.eq.0.and.way.lt.3) call trbopf(ih,n,r,most,ierr)
        last=time(1)
        known=0
      endif
!
      if(time(1).gt.last) then
        dt=time(1)-last
        do i=1,n
          v(i)=veold(dofs(i),nodes(i))
        enddo
        if(last.ge.begin) write(72,'(50(1pe17.9))') last,
     &    veold(ldof(1),lnode(1)),(v(i),f(i),i=1,n)
        if(way.eq.3) then
!
!         the spring forces at the start of the increment, then those
!         that the motion foreseen gives at its end
!
          do i=1,n
            dz(i)=0.5d0*dt*(v0(i)+v(i))
          enddo
          if(ierr.eq.0) call trbelf(n,dz,stiff,limit,held,dfdz,ierr)
          do i=1,n
            a(i)=(v(i)-v0(i))/dt
            if(known.eq.0) a0(i)=a(i)
            dz(i)=dt*(v(i)+0.5d0*dt*(1.5d0*a(i)-0.5d0*a0(i)))
            f(i)=held(i)
            v0(i)=v(i)
            a0(i)=a(i)
          enddo
          if(ierr.eq.0) call trbelf(n,dz,stiff,limit,f,dfdz,ierr)
        else
!
!         mean acceleration without friction over the last increment,
!         and over the next one
!
          do i=1,n
            a(i)=(v(i)-v0(i))/dt
            do j=1,n
              if(known.ge.1) a(i)=a(i)-0.5d0*r(i,j)*(f0(j)+f(j))
            enddo
            if(known.eq.0) a(i)=0.d0
            ax(i)=a(i)
            if(known.ge.2) ax(i)=2.d0*a(i)-a0(i)
          enddo
          do i=1,n
            vfree(i)=v(i)+dt*ax(i)
            do j=1,n
              vfree(i)=vfree(i)+(1.d0-share)*dt*r(i,j)*f(j)
            enddo
            v0(i)=v(i)
            f0(i)=f(i)
            a0(i)=a(i)
          enddo
          if(way.eq.1) then
            if(ierr.eq.0) call trbstf(ih,n,share*dt,vfree,f,ierr)
          else
            if(ierr.eq.0) call trbstp(ih,dt,0.2d0,ierr)
            if(ierr.eq.0) call trbbal(ih,n,v,ax,feq,f,ierr)
          endif
        endif
        known=known+1
        last=time(1)
      endif
!
      if(ierr.ne.0) then
        call trbmsg(ih,text,ierr)
        write(*,*) '*ERROR in cload: ',ierr,text
        call exit(201)
      endif
      do i=1,n
        if(nodes(i).eq.node.and.dofs(i).eq.idof) xload=f(i)
      enddo
      do i=1,nload
        if(lnode(i).eq.node.and.ldof(i).eq.idof)
     &    xload=amp(i)*dsin(omega*time(1))
      enddo
      return
      end
