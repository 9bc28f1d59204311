//! The masses that an actuator in an FMU of its own drives apart, as it estimates them.

use strut_model::{Real, Variables};

use crate::elements::{Hydraulics, ServoCylinder};

/// What the actuator moves, as far as it is told.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Load<R> {
    /// Mass that the force accelerates, m_1 m_2/(m_1 + m_2) of two that it drives apart; zero: there is no estimate
    #[var(unit = KG, start = 0.0, min = 0.0, fixed)]
    pub mass: R,
    /// Communication step of the master, which holds force and velocity through it
    #[var(unit = S, start = 1e-3, min = 1e-6, fixed)]
    pub interval: R,
}

/// What is known of the load since the last communication point.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct LoadMemory<R> {
    /// Velocity there
    #[var(unit = M_PER_S)]
    pub velocity: R,
    /// Force from there on
    #[var(unit = N)]
    pub force: R,
    /// Acceleration by all other forces
    #[var(unit = M_PER_S2)]
    pub acceleration: R,
}

/// Pressure and flow through the valve at a time.
#[derive(Clone, Copy)]
pub struct Pressed<R> {
    pub pressure: R,
    pub flow: R,
}

impl<R: Real> Load<R> {
    /// `on` with an estimate, `off` without.
    pub fn choose(&self, on: impl FnOnce() -> R, off: R) -> R {
        if self.mass.vanishes() { off } else { self.mass.select(on(), off) }
    }

    /// By how much the velocity's mean in this interval differs from that at its start.
    pub fn gain(&self, memory: &LoadMemory<R>) -> R {
        self.interval * 0.5 * (memory.force * self.mobility() + memory.acceleration)
    }

    /// The cylinder's force now; with an estimate of the force that is best held until the next communication point.
    #[inline(always)]
    pub fn force(
        &self,
        cylinder: &ServoCylinder<R>,
        hydraulics: &Hydraulics<R>,
        now: Pressed<R>,
        known: &LoadMemory<R>,
        tick: u64,
    ) -> R {
        let to_come = || {
            let velocity = self.expected(known, tick);
            self.mean_force(cylinder, hydraulics, now, velocity, known.acceleration)
        };
        self.choose(to_come, cylinder.force(now.pressure))
    }

    /// The velocity at the end of this interval; before the first one that at the start.
    fn expected(&self, memory: &LoadMemory<R>, tick: u64) -> R {
        if tick == 0 { memory.velocity } else { memory.velocity + self.gain(memory) * 2.0 }
    }

    /// The mean force of the interval that begins with this velocity, by the implicit midpoint rule: P and v at its
    /// middle follow from each other's rates there.
    fn mean_force(
        &self,
        cylinder: &ServoCylinder<R>,
        hydraulics: &Hydraulics<R>,
        now: Pressed<R>,
        velocity: R,
        acceleration: R,
    ) -> R {
        let half = self.interval * 0.5;
        let (area, leakage) = (cylinder.cylinder.area, cylinder.cylinder.leakage);
        let compression = half * hydraulics.coefficient;
        // The piston's constant force is the part of the mean force that does not follow the pressure.
        let preload = cylinder.cylinder.preload;
        let acceleration =
            if preload.vanishes() { acceleration } else { acceleration - preload * self.mobility() };
        let free = now.pressure + compression * (now.flow - area * (velocity + half * acceleration));
        let stiffening = compression * (leakage + half * area * area * self.mobility());
        cylinder.force(free / (stiffening + 1.0))
    }

    /// What is remembered from a communication point on, where the velocity has come and the force goes out. Of the
    /// change of velocity in the last interval, what its force does not explain is the other forces'; they are taken
    /// as half of what they were before and half of that.
    pub fn remember(&self, before: &LoadMemory<R>, tick: u64, velocity: R, force: R) -> LoadMemory<R> {
        let acceleration = if tick == 0 {
            R::from(0.0)
        } else {
            let other = (velocity - before.velocity) / self.interval - before.force * self.mobility();
            (before.acceleration + other) * 0.5
        };
        LoadMemory { velocity, force, acceleration }
    }

    /// 1/mass; finite without an estimate, where it is not used.
    fn mobility(&self) -> R {
        R::from(1.0) / self.mass.select(self.mass, R::from(1.0))
    }
}
