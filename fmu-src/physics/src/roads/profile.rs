//! The shapes that a road can have, as functions of the time since the start.

use std::f64::consts::TAU;
use std::path::Path;

use strut_model::{Choice, Real, Settings, Variables};

use crate::waveform::{Chirp, edge, sine, square};

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

/// Which road it is.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Course {
    /// Shape of the road
    #[set(start = RoadKind::Sine)]
    pub kind: RoadKind,
    /// Class of a random road (ISO 8608)
    #[set(start = IsoClass::C)]
    pub iso_class: IsoClass,
    /// Seed of a random road: equal seeds give equal roads
    #[set(start = 1)]
    pub seed: i32,
    /// File of a measured profile in the FMU's resources, or an absolute path: CSV with the header
    /// `time [s], position [m]`
    #[set(start = "profile.csv")]
    pub file: String,
}

impl Course {
    /// Its profile; `track` tells the random tracks of a seed apart.
    ///
    /// # Errors
    /// If the file of a measured profile cannot be used.
    pub fn profile(&self, track: usize, resources: Option<&Path>) -> Result<Profile, String> {
        Ok(match self.kind {
            RoadKind::Iso8608 => Profile::Iso8608(IsoTrack::new(self.iso_class, self.seed, track)),
            RoadKind::Recorded => Profile::Recorded(Recorded::read(&self.file, resources)?),
            formula => Profile::Formula(formula),
        })
    }
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
    /// Height and its rate of change, `tau` seconds after the start.
    #[inline]
    pub fn at<R: Real>(&self, tau: R, shape: &Shape<R>) -> [R; 2] {
        let zero = R::from(0.0);
        let active = match self {
            Self::Iso8608(track) => track.at(tau * shape.speed).into_position_and_velocity(shape.speed),
            Self::Recorded(recorded) => recorded.at(tau),
            Self::Formula(kind) => match kind {
                RoadKind::Sine => sine(shape.amplitude, tau * shape.frequency * TAU, shape.frequency * TAU),
                RoadKind::Square => square(tau, shape.amplitude, shape.frequency, shape.edge_time),
                RoadKind::Chirp => shape.chirp.at(tau, shape.amplitude),
                RoadKind::FrequencyRamp => {
                    let frequency = shape.ramp.rate * tau * TAU;
                    sine(shape.amplitude, frequency * tau * 0.5, frequency)
                }
                RoadKind::Step => edge(tau, zero, shape.step.height, shape.edge_time),
                RoadKind::Bump => bump(tau, shape),
                RoadKind::Flat | RoadKind::Iso8608 | RoadKind::Recorded => [zero; 2],
            },
        };
        if let Self::Recorded(_) = self {
            return active;
        }
        since_start(tau, active)
    }

    /// Two tracks, `tau` seconds after the start: random ones have the same waves, whose sines they share.
    pub fn side_by_side<R: Real>(tracks: [&Self; 2], tau: R, shape: &Shape<R>) -> [[R; 2]; 2] {
        let [Self::Iso8608(left), Self::Iso8608(right)] = tracks else {
            return tracks.map(|track| track.at(tau, shape));
        };
        IsoTrack::side_by_side([left, right], tau * shape.speed)
            .map(|track| since_start(tau, track.into_position_and_velocity(shape.speed)))
    }
}

/// At the start itself the road is under way: its velocity is that from the right.
fn since_start<R: Real>(tau: R, [position, velocity]: [R; 2]) -> [R; 2] {
    [position, velocity].map(|value| (-tau).select(R::from(0.0), value))
}

/// Height and slope over the distance.
pub(super) struct HeightAndSlope<R>(pub R, pub R);

impl<R: Real> HeightAndSlope<R> {
    fn into_position_and_velocity(self, speed: R) -> [R; 2] {
        [self.0, self.1 * speed]
    }
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
