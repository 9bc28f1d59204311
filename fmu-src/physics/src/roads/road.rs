//! The road under one wheel.

use std::path::Path;

use strut_model::{About, Equation, Experiment, Instant, Kind, Model, Real, bundles};

use crate::signals::RoadMotion;

use super::{Course, Profile, Shape};

/// The road under one wheel.
#[derive(Clone, Debug, PartialEq)]
pub struct Road {
    profile: Profile,
}

/// What must be known about any road.
pub(super) const NOTES: &[&str] = &[
    "The velocity is the exact derivative of the position. It jumps where a sine or a random road starts.",
    "Square and step have edges of finite duration (a cosine half wave beginning at the switching instant): \
     the sources switch at once, which no tyre damper could follow.",
    "A random road is the sum of 256 waves between 0.011 and 2.83 cycles/m with the power of Gd(n) = Gd(n0) \
     (n/n0)^-2 and phases from SplitMix64 of the seed; it counts from its height at the start.",
];

/// The formulas of the shapes.
pub(super) const EQUATIONS: &[Equation] = &[
    Equation {
        text: "square: edges at k/(2f), from 0 to +A at k = 0, then to -A and +A in turn",
        source: "Quanser 3.1.1",
    },
    Equation {
        text: "chirp: A sin(2 pi (f0 tau + (f1 - f0) tau^2/(2 T))) up to T, then f1 with continuous phase",
        source: "Quanser 3.2.2",
    },
    Equation { text: "frequency ramp: A sin(pi r tau^2)", source: "Kogut 3.2" },
    Equation { text: "step: 0 to h at tau = 0", source: "Konieczny Fig. 9" },
    Equation { text: "bump: h (1 - cos(2 pi s/L))/2, s = speed tau", source: "versed sine" },
    Equation {
        text: "random: z(s) - z(0), z = sum of sqrt(2 Gd(n_i) dn_i) sin(2 pi n_i s + phi_i), s = speed tau",
        source: "ISO 8608",
    },
];

impl Model for Road {
    const ABOUT: About = About {
        name: "Road",
        summary: "The road under one wheel: test signals, random roads of ISO 8608, measured profiles",
        kind: Kind::Road,
        equations: EQUATIONS,
        notes: NOTES,
        experiment: Experiment {
            stop: 10.0,
            step: 1e-3,
            plot: &["position", "velocity"],
            ..Experiment::DEFAULT
        },
        ..About::DEFAULT
    };

    bundles! { settings: Course, parameters: Shape, output: RoadMotion }

    fn prepare(course: &Course, resources: Option<&Path>) -> Result<Self, String> {
        Ok(Self { profile: course.profile(0, resources)? })
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (strut_model::NoVariables, RoadMotion<R>) {
        let shape = now.parameters;
        let [position, velocity] = self.profile.at(now.time - shape.start_time, shape);
        (strut_model::NoVariables, RoadMotion { position, velocity })
    }
}
