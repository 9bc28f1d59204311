//! The strut's own law: a spring and a damper, and what hides in them.

use std::f64::consts::TAU;

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
    /// A slider behind a spring with play: its friction in N, the spring's stiffness in N/m, the play to each side in m.
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
    /// Amplitude in N, period in m and phase of a force that changes over the deflection.
    pub cogging: Option<(f64, f64, f64)>,
}

/// Hidden states: two Maxwell branches, the inner end of the bush, the bristles or the place of the slider.
pub type Inner = [f64; 4];

impl Strut {
    /// The force that pulls its ends together, and the rates of the hidden states.
    ///
    /// `time` in s, deflection `x` in m, `v` in m/s.
    pub fn force(&self, time: f64, x: f64, v: f64, inner: &Inner) -> (f64, Inner) {
        let mut rates = [0.0; 4];
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
        rate * effective + self.orifice * v * v.abs()
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
        let (force, rates) = plain().force(1.0, 0.01, -0.2, &[0.0; 4]);
        assert!((force - (84.0 - 141.4)).abs() < 1e-12);
        assert_eq!(rates, [0.0; 4]);
    }

    #[test]
    fn within_its_play_the_damper_does_nothing() {
        let strut = Strut { bush: Some((1e-3, 1e6)), ..plain() };
        assert_eq!(strut.force(0.0, 0.9e-3, 0.3, &[0.0; 4]).0, 8400.0 * 0.9e-3);
        let (force, rates) = strut.force(0.0, 1.1e-3, 0.3, &[0.0; 4]);
        assert!((force - 8400.0 * 1.1e-3 - 100.0).abs() < 1e-9);
        assert!((rates[2] - 100.0 / 707.0).abs() < 1e-12);
    }

    #[test]
    fn a_slider_rests_over_its_play_after_a_reversal() {
        let strut = Strut { loose_slider: Some((60.0, 1e5, 1e-3)), ..Strut::default() };
        let (mut x, mut inner, step) = (0.0, [0.0; 4], 1e-6);
        let mut go = |way: f64| {
            for _ in 0..(way.abs() / step).round() as usize {
                x += step * way.signum();
                inner[3] += step * strut.force(0.0, x, way.signum(), &inner).1[3];
            }
            strut.force(0.0, x, way.signum(), &inner).0
        };
        // 1 mm of play and 0.6 mm of spring to the one side; back over the spring, 2 mm of play, the spring on the other.
        for (way, force) in [(1.3e-3, 30.0), (9e-3, 60.0), (-0.3e-3, 30.0), (-1.3e-3, 0.0), (-1.3e-3, -30.0)]
        {
            let found = go(way);
            assert!((found - force).abs() < 0.5, "{found} N, not {force} N");
        }
    }

    #[test]
    fn bristles_end_at_the_friction() {
        let strut = Strut { bristles: Some((60.0, 1e5, 0.0)), ..Strut::default() };
        let mut inner = [0.0; 4];
        for _ in 0..20_000 {
            inner[3] += 1e-5 * strut.force(0.0, 0.0, 0.1, &inner).1[3];
        }
        assert!((strut.force(0.0, 0.0, 0.1, &inner).0 - 60.0).abs() < 1e-6);
    }
}
