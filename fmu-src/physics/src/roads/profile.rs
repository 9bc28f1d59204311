//! The shapes that a road can have, as functions of the time since the start.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use strut_model::{Choice, Real, Variables};

use super::{IsoClass, IsoTrack, Recorded};

/// The shape of a road.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum RoadKind {
    /// Zero throughout
    Flat,
    /// Sine of `amplitude` and `frequency`
    Sine,
    /// Alternates between plus and minus `amplitude` at `frequency` (Quanser 3.1.1)
    Square,
    /// Sine whose frequency grows linearly with time, then stays (Quanser 3.2.2)
    Chirp,
    /// Sine whose frequency grows linearly with time without end (Kogut 3.2)
    FrequencyRamp,
    /// One step (Konieczny Fig. 9)
    Step,
    /// One versed sine, as a speed bump
    Bump,
    /// Random road of a class of ISO 8608
    Iso8608,
    /// Measured profile from a file
    Recorded,
}

/// What shapes a road; each kind uses some.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Shape<R> {
    /// Time at which the road begins; before it is flat
    #[var(unit = S, start = 0.0)]
    pub start_time: R,
    /// Amplitude of sine, square, chirp and frequency ramp
    #[var(unit = M, start = 0.01)]
    pub amplitude: R,
    /// Frequency of sine and square
    #[var(unit = HZ, start = 1.0, min = 1e-6)]
    pub frequency: R,
    /// Duration of an edge of square and step: a cosine half wave, so that the velocity is finite
    #[var(unit = S, start = 0.02, min = 1e-6)]
    pub edge_time: R,
    /// Chirp
    pub chirp: Chirp<R>,
    /// Frequency ramp
    pub ramp: Ramp<R>,
    /// Step
    pub step: Step<R>,
    /// Bump
    pub bump: Bump<R>,
    /// Speed of travel over a bump or a random road
    #[var(unit = M_PER_S, start = 10.0, min = 1e-3)]
    pub speed: R,
}

/// A sweep of the frequency.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Chirp<R> {
    /// Frequency at the start
    #[var(unit = HZ, start = 1.0, min = 0.0)]
    pub start_frequency: R,
    /// Frequency at the end, and afterwards
    #[var(unit = HZ, start = 8.0, min = 0.0)]
    pub end_frequency: R,
    /// Duration of the sweep
    #[var(unit = S, start = 25.0, min = 1e-3)]
    pub duration: R,
}

/// A frequency that grows.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Ramp<R> {
    /// Growth of the frequency
    #[var(unit = HZ_PER_S, start = 0.1)]
    pub rate: R,
}

/// A step.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Step<R> {
    /// Height
    #[var(unit = M, start = 0.05)]
    pub height: R,
}

/// A bump.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Bump<R> {
    /// Height
    #[var(unit = M, start = 0.05)]
    pub height: R,
    /// Length in the direction of travel
    #[var(unit = M, start = 1.0, min = 1e-3)]
    pub length: R,
}

/// A road, ready to be driven on.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// Given by a formula.
    Formula(RoadKind),
    /// Random.
    Iso8608(IsoTrack),
    /// Measured.
    Recorded(Recorded),
}

impl Profile {
    /// The profile of a kind; `track` tells the random tracks of a seed apart.
    ///
    /// # Errors
    /// If the file of a measured profile cannot be used.
    pub fn new(
        kind: RoadKind,
        class: IsoClass,
        seed: i32,
        track: usize,
        file: &str,
        resources: Option<&Path>,
    ) -> Result<Self, String> {
        Ok(match kind {
            RoadKind::Iso8608 => Self::Iso8608(IsoTrack::new(class, seed, track)),
            RoadKind::Recorded => Self::Recorded(Recorded::read(file, resources)?),
            formula => Self::Formula(formula),
        })
    }

    /// Height and its rate of change, `tau` seconds after the start.
    #[inline]
    pub fn at<R: Real>(&self, tau: R, shape: &Shape<R>) -> [R; 2] {
        let zero = R::from(0.0);
        let active = match self {
            Self::Iso8608(track) => track.at(tau * shape.speed).into_position_and_velocity(shape.speed),
            Self::Recorded(recorded) => recorded.at(tau),
            Self::Formula(kind) => match kind {
                RoadKind::Sine => sine(shape.amplitude, tau * shape.frequency * TAU, shape.frequency * TAU),
                RoadKind::Square => square(tau, shape),
                RoadKind::Chirp => chirp(tau, shape),
                RoadKind::FrequencyRamp => {
                    let frequency = shape.ramp.rate * tau * TAU;
                    sine(shape.amplitude, frequency * tau * 0.5, frequency)
                }
                RoadKind::Step => edge(tau, zero, shape.step.height, shape.edge_time),
                RoadKind::Bump => bump(tau, shape),
                RoadKind::Flat | RoadKind::Iso8608 | RoadKind::Recorded => [zero; 2],
            },
        };
        // At the start itself the road is under way: its velocity is that from the right.
        if let Self::Recorded(_) = self {
            return active;
        }
        active.map(|value| (-tau).select(zero, value))
    }
}

/// Height and slope over the distance.
pub(super) struct HeightAndSlope<R>(pub R, pub R);

impl<R: Real> HeightAndSlope<R> {
    fn into_position_and_velocity(self, speed: R) -> [R; 2] {
        [self.0, self.1 * speed]
    }
}

/// `A sin φ` and its rate, φ' being the angular frequency.
fn sine<R: Real>(amplitude: R, phase: R, angular_frequency: R) -> [R; 2] {
    [amplitude * phase.sin(), amplitude * angular_frequency * phase.cos()]
}

/// From `origin` to `target` on a cosine half wave that begins at zero.
fn edge<R: Real>(tau: R, origin: R, target: R, duration: R) -> [R; 2] {
    let rate = R::from(PI) / duration;
    let half = (target - origin) * 0.5;
    let under_way = duration - tau;
    [
        under_way.select(origin + half * (R::from(1.0) - (rate * tau).cos()), target),
        under_way.select(half * rate * (rate * tau).sin(), R::from(0.0)),
    ]
}

/// Edges at k/(2f): from zero up at k = 0, then down and up in turn.
fn square<R: Real>(tau: R, shape: &Shape<R>) -> [R; 2] {
    let half_period = R::from(0.5) / shape.frequency;
    // Number of the edge, whether it leads up, and whether there is one before it. An edge is a kink in
    // time only, so that none of these has a slope.
    let [count, up, later] = (tau / half_period).lookup(|halves| {
        let count = halves.floor();
        ([count, if count.rem_euclid(2.0) == 0.0 { 1.0 } else { -1.0 }, f64::from(count > 0.0)], [0.0; 3])
    });
    let target = shape.amplitude * up;
    edge(tau - count * half_period, -(target * later), target, shape.edge_time)
}

/// The frequency grows linearly over the duration; the phase is its integral and goes on without a jump.
fn chirp<R: Real>(tau: R, shape: &Shape<R>) -> [R; 2] {
    let Chirp { start_frequency: from, end_frequency: to, duration } = shape.chirp;
    let past = tau - duration;
    let growth = (to - from) / duration;
    let cycles =
        past.select((from + to) * duration * 0.5 + to * past, from * tau + growth * tau.squared() * 0.5);
    let frequency = past.select(to, from + growth * tau);
    sine(shape.amplitude, cycles * TAU, frequency * TAU)
}

/// `h (1 − cos(2π s/L))/2` over the length L.
fn bump<R: Real>(tau: R, shape: &Shape<R>) -> [R; 2] {
    let rate = shape.speed * TAU / shape.bump.length;
    let half = shape.bump.height * 0.5;
    let past = tau * shape.speed - shape.bump.length;
    [half * (R::from(1.0) - (rate * tau).cos()), half * rate * (rate * tau).sin()]
        .map(|value| past.select(R::from(0.0), value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use strut_model::{Bundle, Declarations};

    fn shape() -> Shape<f64> {
        let declared = Declarations::of::<Shape<f64>>();
        Bundle::from_fn(|i| declared[i].start)
    }

    /// Central difference.
    fn derivative(f: impl Fn(f64) -> f64, x: f64) -> f64 {
        let h = 1e-6;
        (f(x + h) - f(x - h)) / (2.0 * h)
    }

    const FORMULAS: [RoadKind; 7] = [
        RoadKind::Flat,
        RoadKind::Sine,
        RoadKind::Square,
        RoadKind::Chirp,
        RoadKind::FrequencyRamp,
        RoadKind::Step,
        RoadKind::Bump,
    ];

    fn profiles() -> Vec<Profile> {
        let mut list: Vec<_> = FORMULAS.into_iter().map(Profile::Formula).collect();
        list.push(Profile::Iso8608(IsoTrack::new(IsoClass::C, 5, 0)));
        list
    }

    proptest! {
        #[test]
        fn velocity_is_the_rate_of_position(tau in 0.001..40.0_f64, index in 0..8_usize) {
            let shape = shape();
            // Not across a corner of the piecewise formulas.
            let half = 0.5 / shape.frequency;
            let since = tau % half;
            prop_assume!(since > 1e-4 && (since - shape.edge_time).abs() > 1e-4 && (tau - 0.1).abs() > 1e-4);
            prop_assume!((tau - shape.chirp.duration).abs() > 1e-4);
            let profile = &profiles()[index];
            let [_, velocity] = profile.at(tau, &shape);
            let difference = derivative(|tau| profile.at(tau, &shape)[0], tau);
            let error = (velocity - difference).abs() / (1.0 + velocity.abs());
            prop_assert!(error < 1e-6, "{profile:?} {velocity} {difference}");
        }

        #[test]
        fn before_the_start_every_road_is_flat(tau in -10.0..-1e-9_f64, index in 0..8_usize) {
            prop_assert_eq!(profiles()[index].at(tau, &shape()), [0.0, 0.0]);
        }
    }

    #[test]
    fn the_square_of_quanser_starts_up_and_alternates() {
        let shape = Shape { amplitude: 0.01, frequency: 0.3, ..shape() };
        let square = Profile::Formula(RoadKind::Square);
        let half = 0.5 / 0.3;
        for (tau, height) in [
            (0.0, 0.0),
            (0.01, 0.005),
            (0.02, 0.01),
            (half - 1e-9, 0.01),
            (half + 0.021, -0.01),
            (2.5 * half, 0.01),
        ] {
            assert!((square.at(tau, &shape)[0] - height).abs() < 1e-12, "{tau}");
        }
        assert!((square.at(half + 0.01, &shape)[0]).abs() < 1e-12);
    }

    #[test]
    fn the_chirp_of_quanser_reaches_8_hertz_at_25_seconds() {
        let shape = Shape { amplitude: 0.0015, ..shape() };
        let chirp = Profile::Formula(RoadKind::Chirp);
        let frequency = |tau: f64| {
            let [z, v] = chirp.at(tau, &shape);
            let acceleration = derivative(|tau| chirp.at(tau, &shape)[1], tau);
            // Of a sine with slowly changing frequency: ω² = (v² − z a)/A².
            ((v * v - z * acceleration) / 0.0015_f64.powi(2)).sqrt() / TAU
        };
        assert!((frequency(24.99) - 8.0).abs() < 0.01);
        assert!((frequency(26.0) - 8.0).abs() < 1e-3);
    }
}
