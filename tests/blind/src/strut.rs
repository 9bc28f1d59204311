//! The strut's own law: a spring and a damper, and what hides in them.

use std::f64::consts::{PI, TAU};

/// A hump over the deflection: `exp(−((x − centre)/width)²)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hump {
    /// Its height: newton, or a share of the damping.
    pub height: f64,
    /// In m.
    pub centre: f64,
    /// In m.
    pub width: f64,
}

impl Hump {
    fn at(self, x: f64) -> f64 {
        self.height * (-((x - self.centre) / self.width).powi(2)).exp()
    }
}

/// Slots in the wall of a damper past its piston, over a zone of its stroke; at speed they choke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bypass {
    /// Share of the damper's force that is lost at low speed, where the slots are; at most all of it.
    pub zone: Hump,
    /// Velocity at which half of that is lost, in m/s.
    pub velocity: f64,
}

impl Bypass {
    /// The share of the force that is left.
    fn left(self, x: f64, v: f64) -> f64 {
        1.0 - self.zone.at(x) / (1.0 + v.abs() / self.velocity)
    }
}

/// Springs in series with dampers of a [`Memory`].
pub const BRANCHES: usize = 12;

/// Stiffness in N/m and time constant in s of many springs in series with dampers.
pub type Memory = [(f64, f64); BRANCHES];

/// The branches whose force is nearly `stiffness` N/m, at 1 rad/s, times the derivative of a fractional order between 0 and 1 of the
/// deflection: ∫ exp(−t/τ) τ^−α d ln τ = Γ(α) t^−α, whose sum is taken from 0.5 ms to 50 s. What is slower is a spring, what is faster a
/// damper: a fit takes them for the strut's own.
pub fn memory(stiffness: f64, order: f64) -> Memory {
    let (shortest, longest) = (5e-4_f64, 50.0_f64);
    let ratio = (longest / shortest).powf(1.0 / (BRANCHES as f64 - 1.0));
    std::array::from_fn(|branch| {
        let time_constant = shortest * ratio.powf(branch as f64);
        let share = (PI * order).sin() / PI * ratio.ln() * time_constant.powf(-order);
        (stiffness * share, time_constant)
    })
}

/// A spring and a damper; what is `None` or zero is not there.
#[derive(Clone, Debug, Default)]
pub struct Strut {
    /// N/m.
    pub stiffness: f64,
    /// N s/m.
    pub damping: f64,
    /// α of d(1 ± α), by the sign of the velocity.
    pub asymmetry: f64,
    /// Velocity beyond which the rate is another one, and by which share it is larger.
    pub knee: Option<(f64, f64)>,
    /// N s²/m².
    pub orifice: f64,
    /// Springs in series with dampers: stiffness in N/m and time constant in s. The second one is clutter.
    pub maxwell: [Option<(f64, f64)>; 2],
    /// N/m².
    pub quadratic: f64,
    /// N/m³.
    pub cubic: f64,
    /// Deflection in m and stiffness in N/m of the stops at both ends.
    pub stop: Option<(f64, f64)>,
    /// Share of the damping that is lost, and its time constant in s.
    pub fade: Option<(f64, f64)>,
    /// Play of the damper's bush to each side in m, and the bush's stiffness in N/m.
    pub bush: Option<(f64, f64)>,
    /// Bristles: friction in N, stiffness in N/m, damping in N s/m.
    pub bristles: Option<(f64, f64, f64)>,
    /// A slider behind a spring with backlash: its friction in N, the spring's stiffness in N/m, the backlash to each side in m.
    pub loose_slider: Option<(f64, f64, f64)>,
    /// Yield force in N, velocity over which it changes its sign in m/s, and how much the change lags behind, in
    /// 1/m: `F tanh(v/v_y + β x)`, as magnetorheological dampers have it.
    pub yielding: Option<(f64, f64, f64)>,
    /// Change of the lever ratio with the deflection, in 1/m.
    pub linkage: f64,
    /// Force over the deflection, in N.
    pub hump: Option<Hump>,
    /// Damping over the deflection, as a share.
    pub thick_spot: Option<Hump>,
    /// Damper that loses force over the deflection and the velocity.
    pub bypass: Option<Bypass>,
    /// A force that remembers the deflection over many times.
    pub memory: Option<Memory>,
    /// Amplitude in N, period in m and phase of a force that changes over the deflection.
    pub cogging: Option<(f64, f64, f64)>,
}

/// How many hidden states there are.
pub const INNER: usize = 4 + BRANCHES;

/// Hidden states: two Maxwell branches, the inner end of the bush, the bristles or the place of the slider; the memory's branches.
pub type Inner = [f64; INNER];

impl Strut {
    /// The force that pulls its ends together, and the rates of the hidden states.
    ///
    /// `time` in s, deflection `x` in m, `v` in m/s.
    pub fn force(&self, time: f64, x: f64, v: f64, inner: &Inner) -> (f64, Inner) {
        let mut rates = [0.0; INNER];
        let mut force = self.spring(x);
        if let Some((gap, stiffness)) = self.bush {
            let stretched = x - inner[2];
            let carried = stiffness * (stretched - stretched.clamp(-gap, gap));
            rates[2] = self.damper_velocity(carried);
            force += carried;
        } else {
            force += self.damper(time, x, v);
        }
        for (branch, maxwell) in self.maxwell.iter().enumerate() {
            if let Some((stiffness, time_constant)) = maxwell {
                force += stiffness * inner[branch];
                rates[branch] = v - inner[branch] / time_constant;
            }
        }
        for (branch, (stiffness, time_constant)) in self.memory.iter().flatten().enumerate() {
            force += stiffness * inner[4 + branch];
            rates[4 + branch] = v - inner[4 + branch] / time_constant;
        }
        if let Some((sliding, stiffness, damping)) = self.bristles {
            rates[3] = v - stiffness * v.abs() / sliding * inner[3];
            force += stiffness * inner[3] + damping * rates[3];
        }
        if let Some((sliding, stiffness, gap)) = self.loose_slider {
            let stretched = x - inner[3];
            let carried = stiffness * (stretched - stretched.clamp(-gap, gap));
            force += carried.clamp(-sliding, sliding);
            // It stays where it is until the spring carries its friction, and then goes along.
            rates[3] = if carried.abs() >= sliding && carried * v > 0.0 { v } else { 0.0 };
        }
        if let Some((most, velocity, slope)) = self.yielding {
            force += most * (v / velocity + slope * x).tanh();
        }
        (force, rates)
    }

    /// Its length less that at rest, at a deflection in m of the ends of its linkage.
    pub fn length(&self, x: f64) -> f64 {
        x * (1.0 + 0.5 * self.linkage * x)
    }

    /// Its static force in N, less that at rest, at a deflection in m.
    pub fn spring(&self, x: f64) -> f64 {
        let mut force = x * (self.stiffness + x * (self.quadratic + x * self.cubic));
        if let Some((clearance, stiffness)) = self.stop {
            force += stiffness * (x - x.clamp(-clearance, clearance));
        }
        if let Some(hump) = self.hump {
            // Less its force at rest, where the rig has settled.
            force += hump.at(x) - hump.at(0.0);
        }
        if let Some((size, period, phase)) = self.cogging {
            force += size * ((TAU * x / period + phase).sin() - phase.sin());
        }
        force
    }

    fn damper(&self, time: f64, x: f64, v: f64) -> f64 {
        let mut rate = self.damping;
        if let Some((share, time_constant)) = self.fade {
            rate *= 1.0 - share * (1.0 - (-time / time_constant).exp());
        }
        if let Some(spot) = self.thick_spot {
            rate *= 1.0 + spot.at(x);
        }
        // Each side has a valve of its own, which opens at the knee.
        rate *= 1.0 + self.asymmetry * v.signum();
        let mut effective = v;
        if let Some((corner, change)) = self.knee {
            effective += change * (v.abs() - corner).max(0.0) * v.signum();
        }
        let force = rate * effective + self.orifice * v * v.abs();
        self.bypass.map_or(force, |bypass| bypass.left(x, v) * force)
    }

    /// The inverse of a damper with nothing but asymmetry.
    fn damper_velocity(&self, force: f64) -> f64 {
        force / (self.damping * (1.0 + self.asymmetry * force.signum()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain() -> Strut {
        Strut { stiffness: 8400.0, damping: 707.0, ..Strut::default() }
    }

    #[test]
    fn without_effects_it_is_a_spring_and_a_damper() {
        let (force, rates) = plain().force(1.0, 0.01, -0.2, &[0.0; INNER]);
        assert!((force - (84.0 - 141.4)).abs() < 1e-12);
        assert_eq!(rates, [0.0; INNER]);
    }

    #[test]
    fn within_its_play_the_damper_does_nothing() {
        let strut = Strut { bush: Some((1e-3, 1e6)), ..plain() };
        assert_eq!(strut.force(0.0, 0.9e-3, 0.3, &[0.0; INNER]).0, 8400.0 * 0.9e-3);
        let (force, rates) = strut.force(0.0, 1.1e-3, 0.3, &[0.0; INNER]);
        assert!((force - 8400.0 * 1.1e-3 - 100.0).abs() < 1e-9);
        assert!((rates[2] - 100.0 / 707.0).abs() < 1e-12);
    }

    #[test]
    fn a_slider_rests_over_its_play_after_a_reversal() {
        let strut = Strut { loose_slider: Some((60.0, 1e5, 1e-3)), ..Strut::default() };
        let (mut x, mut inner, step) = (0.0, [0.0; INNER], 1e-6);
        let mut go = |way: f64| {
            for _ in 0..(way.abs() / step).round() as usize {
                x += step * way.signum();
                inner[3] += step * strut.force(0.0, x, way.signum(), &inner).1[3];
            }
            strut.force(0.0, x, way.signum(), &inner).0
        };
        // 1 mm of backlash and 0.6 mm of spring to the one side; back over the spring, 2 mm of backlash, the spring on the other.
        for (way, force) in [(1.3e-3, 30.0), (9e-3, 60.0), (-0.3e-3, 30.0), (-1.3e-3, 0.0), (-1.3e-3, -30.0)]
        {
            let found = go(way);
            assert!((found - force).abs() < 0.5, "{found} N, not {force} N");
        }
    }

    #[test]
    fn bristles_end_at_the_friction() {
        let strut = Strut { bristles: Some((60.0, 1e5, 0.0)), ..Strut::default() };
        let mut inner = [0.0; INNER];
        for _ in 0..20_000 {
            inner[3] += 1e-5 * strut.force(0.0, 0.0, 0.1, &inner).1[3];
        }
        assert!((strut.force(0.0, 0.0, 0.1, &inner).0 - 60.0).abs() < 1e-6);
    }

    /// k_a (iω)^α, less the spring and the damper that the slower and the faster branches would be: the rest of the integral over
    /// τ^−α, beyond the last branch by half a step.
    #[test]
    fn a_memory_is_a_fractional_derivative() {
        for order in [0.2, 0.4, 0.6] {
            let (branches, ratio) = (memory(2000.0, order), 1e5_f64.powf(0.5 / 11.0));
            let size = 2000.0 * (PI * order).sin() / PI;
            let slow = size / order * (50.0 * ratio).powf(-order);
            let fast = size / (1.0 - order) * (5e-4 / ratio).powf(1.0 - order);
            for frequency in [0.3, 1.0, 5.0, 20.0] {
                let omega = TAU * frequency;
                let start = (slow, fast * omega);
                let found = branches.iter().fold(start, |sum, (stiffness, time)| {
                    let (ratio, below) = (omega * time, 1.0 + (omega * time).powi(2));
                    (sum.0 + stiffness * ratio * ratio / below, sum.1 + stiffness * ratio / below)
                });
                let (sine, cosine) = (0.5 * PI * order).sin_cos();
                let due = 2000.0 * omega.powf(order);
                let apart = (found.0 - due * cosine).hypot(found.1 - due * sine);
                assert!(apart < 0.02 * due, "{order}, {frequency} Hz: {found:?} for {due} N/m");
            }
        }
        assert!(memory(0.0, 0.4).iter().all(|branch| branch.0 == 0.0));
    }

    /// Over a closed motion from rest to rest a memory takes work, and gives none.
    #[test]
    fn a_memory_is_passive() {
        let strut = Strut { memory: Some(memory(3000.0, 0.5)), ..Strut::default() };
        let (mut inner, mut work, step) = ([0.0; INNER], 0.0, 1e-4);
        for k in 0..20_000 {
            let t = f64::from(k) * step;
            let (x, v) = (0.01 * (TAU * 3.0 * t).sin(), 0.01 * TAU * 3.0 * (TAU * 3.0 * t).cos());
            let (force, rates) = strut.force(t, x, v, &inner);
            inner.iter_mut().zip(rates).for_each(|(state, rate)| *state += step * rate);
            work += force * v * step;
            let stored: f64 =
                memory(3000.0, 0.5).iter().zip(&inner[4..]).map(|(it, y)| 0.5 * it.0 * y * y).sum();
            assert!(work > 0.98 * stored - 1e-4, "{work} J, of which {stored} J are stored");
        }
        assert!(work > 0.1, "{work} J");
    }

    #[test]
    fn a_bypass_takes_force_where_it_is_and_not_at_speed() {
        let zone = Hump { height: 0.8, centre: 2e-3, width: 3e-3 };
        let strut = Strut { bypass: Some(Bypass { zone, velocity: 0.2 }), ..plain() };
        let damping = |x: f64, v: f64| strut.force(0.0, x, v, &[0.0; INNER]).0 - 8400.0 * x;
        // In the middle of the zone, at the velocity at which half is lost: 0.6 of 707 N s/m.
        assert!((damping(2e-3, 0.2) - 0.6 * 707.0 * 0.2).abs() < 1e-9);
        assert!((damping(2e-3, 1e-5) - 0.2 * 707.0 * 1e-5).abs() < 1e-6);
        assert!((damping(0.03, -0.2) + 707.0 * 0.2).abs() < 1e-9);
        for k in 0..400 {
            let (x, v) = (1e-4 * f64::from(k % 20), 0.01 * f64::from(k / 20 - 10));
            assert!(damping(x, v) * v >= 0.0, "it takes power");
        }
        let absent =
            Strut { bypass: Some(Bypass { zone: Hump { height: 0.0, ..zone }, velocity: 0.2 }), ..plain() };
        assert_eq!(absent.force(0.0, 2e-3, 0.2, &[0.0; INNER]), plain().force(0.0, 2e-3, 0.2, &[0.0; INNER]));
    }
}
