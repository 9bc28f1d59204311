//! The road under the four wheels of a car.

use std::path::Path;

use strut_model::{About, Experiment, Kind, Model, Now, Real, Settings, Variables, bundles};

use crate::signals::RoadMotion;

use super::{
    IsoClass, Profile, RoadKind, Shape,
    road::{EQUATIONS, NOTES},
};

/// The road under four wheels: the rear wheels follow the front wheels after the wheelbase.
#[derive(Clone, Debug, PartialEq)]
pub struct FourWheelRoad {
    left: Profile,
    right: Profile,
}

/// What road it is.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// Shape of the road
    #[set(start = RoadKind::Bump)]
    kind: RoadKind,
    /// Class of a random road (ISO 8608)
    #[set(start = IsoClass::C)]
    iso_class: IsoClass,
    /// Seed of a random road: equal seeds give equal roads
    #[set(start = 1)]
    seed: i32,
    /// File of a measured profile in the FMU's resources, or an absolute path: CSV with the header
    /// `time [s], position [m]`
    #[set(start = "profile.csv")]
    file: String,
    /// Left and right wheels run over the same random track (others are the same anyway)
    #[set(start = false)]
    same_track: bool,
}

/// What shapes the road.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Profile
    pub profile: Shape<R>,
    /// Distance from the front to the rear wheels
    #[var(unit = M, start = 2.7, min = 0.0)]
    pub wheelbase: R,
}

/// The motion of the road under each wheel.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Front left
    pub front_left: RoadMotion<R>,
    /// Front right
    pub front_right: RoadMotion<R>,
    /// Rear left
    pub rear_left: RoadMotion<R>,
    /// Rear right
    pub rear_right: RoadMotion<R>,
}

impl Model for FourWheelRoad {
    const ABOUT: About = About {
        name: "FourWheelRoad",
        summary: "The road under four wheels: the rear ones follow the front ones after the wheelbase",
        kind: Kind::Road,
        equations: EQUATIONS,
        notes: NOTES,
        experiment: Experiment {
            stop: 4.0,
            step: 1e-3,
            plot: &["front_left.position", "rear_left.position"],
            ..Experiment::DEFAULT
        },
        ..About::DEFAULT
    };

    bundles! { settings: Options, parameters: Parameters, output: Output }

    fn prepare(options: &Options, resources: Option<&Path>) -> Result<Self, String> {
        let Options { kind, iso_class, seed, file, same_track } = options;
        let track = |number: usize| Profile::new(*kind, *iso_class, *seed, number, file, resources);
        Ok(Self { left: track(0)?, right: track(usize::from(!same_track))? })
    }

    fn equations<R: Real>(&self, now: Now<'_, Self, R>) -> (strut_model::Nothing, Output<R>) {
        let Parameters { profile: shape, wheelbase } = now.parameters;
        let front = now.time - shape.start_time;
        let rear = front - *wheelbase / shape.speed;
        let under = |track: &Profile, tau: R| {
            let [position, velocity] = track.at(tau, shape);
            RoadMotion { position, velocity }
        };
        let output = Output {
            front_left: under(&self.left, front),
            front_right: under(&self.right, front),
            rear_left: under(&self.left, rear),
            rear_right: under(&self.right, rear),
        };
        (strut_model::Nothing, output)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use strut_model::{Bundle, Declarations, Nothing};

    fn output(car: &FourWheelRoad, time: f64) -> Output<f64> {
        let declared = Declarations::of::<Parameters<f64>>();
        let parameters = Bundle::from_fn(|i| declared[i].start);
        car.equations(Now {
            time,
            state: &Nothing,
            input: &Nothing,
            parameters: &parameters,
            derived: &Nothing,
            memory: &Nothing,
            tick: 0,
        })
        .1
    }

    fn random(same_track: bool) -> FourWheelRoad {
        let options = Options { kind: RoadKind::Iso8608, same_track, ..Options::starts() };
        FourWheelRoad::prepare(&options, None).unwrap()
    }

    proptest! {
        #[test]
        fn rear_wheels_follow_after_the_wheelbase(time in 0.0..20.0_f64) {
            let car = random(false);
            // 2.7 m at 10 m/s.
            let (now, later) = (output(&car, time), output(&car, time + 0.27));
            prop_assert!((now.front_left.position - later.rear_left.position).abs() < 1e-9);
            prop_assert!((now.front_right.velocity - later.rear_right.velocity).abs() < 1e-7);
        }

        #[test]
        fn tracks_are_the_same_only_where_that_is_asked(time in 0.5..20.0_f64) {
            let (same, other) = (output(&random(true), time), output(&random(false), time));
            prop_assert_eq!(same.front_left, same.front_right);
            prop_assert_eq!(same.front_left, other.front_left);
            prop_assert_ne!(other.front_left, other.front_right);
        }
    }
}
