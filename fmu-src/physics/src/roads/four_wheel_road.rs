//! The road under the four wheels of a car.

use std::path::Path;

use strut_model::{About, Experiment, Instant, Kind, Model, Real, Settings, Variables, bundles};

use crate::car::Corners;
use crate::signals::RoadMotion;

use super::{
    Course, Profile, Shape,
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
    /// Course
    course: Course,
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
pub type Roads<R> = Corners<RoadMotion<R>>;

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

    bundles! { settings: Options, parameters: Parameters, output: Roads }

    fn prepare(options: &Options, resources: Option<&Path>) -> Result<Self, String> {
        let track = |number: usize| options.course.profile(number, resources);
        Ok(Self { left: track(0)?, right: track(usize::from(!options.same_track))? })
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (strut_model::NoVariables, Roads<R>) {
        let Parameters { profile: shape, wheelbase } = now.parameters;
        let front = now.time - shape.start_time;
        let rear = front - *wheelbase / shape.speed;
        let under = |tau: R| {
            Profile::side_by_side([&self.left, &self.right], tau, shape)
                .map(|[position, velocity]| RoadMotion { position, velocity })
        };
        let ([front_left, front_right], [rear_left, rear_right]) = (under(front), under(rear));
        let output = Roads { front_left, front_right, rear_left, rear_right };
        (strut_model::NoVariables, output)
    }
}

#[cfg(test)]
mod tests {
    use super::super::RoadKind;
    use super::*;
    use proptest::prelude::*;
    use strut_model::{Bundle, Declarations, NoVariables};

    fn output(car: &FourWheelRoad, time: f64) -> Roads<f64> {
        let declared = Declarations::of::<Parameters<f64>>();
        let parameters = Bundle::from_fn(|i| declared[i].start);
        car.equations(Instant {
            time,
            state: &NoVariables,
            input: &NoVariables,
            parameters: &parameters,
            derived: &NoVariables,
            memory: &NoVariables,
            tick: 0,
        })
        .1
    }

    fn random(same_track: bool) -> FourWheelRoad {
        let course = Course { kind: RoadKind::Iso8608, ..Course::starts() };
        let options = Options { course, same_track };
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
