//! Sources of one signal. They differ in its unit only, so that one declaration makes them all.

use std::f64::consts::TAU;
use std::path::Path;

use strut_model::{
    About, Choice, Equation, Experiment, Instant, Kind, Model, NoVariables, Real, Settings, Variables,
};

use crate::waveform::{Chirp, edge, sine, square, stairs};

/// The shape of a signal.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// `offset` throughout
    Constant,
    /// From `offset` by `amplitude`, once
    Step,
    /// From `offset` at `ramp.rate` for `ramp.duration`, then held (Kogut Fig. 4)
    Ramp,
    /// Each `stairs.level` for `stairs.duration`, the last one held (Kogut Fig. 5)
    Stairs,
    /// Sine of `amplitude` and `swing_frequency` about `offset`
    Sine,
    /// Alternates between plus and minus `amplitude` about `offset` at `swing_frequency`
    Square,
    /// Sine about `offset` whose frequency grows linearly with time, then stays (Konieczny 3.1)
    Chirp,
}

/// What holds for every source.
const NOTES: &[&str] = &[
    "Before start_time the signal is at its offset. At a switching instant it has the value that follows.",
    "An edge of step and square takes edge_time, along a cosine half wave that begins at the switching \
     instant; with edge_time = 0 it is a jump.",
];

/// The formulas of the shapes.
const EQUATIONS: &[Equation] = &[
    Equation { text: "step: offset + A for tau >= 0", source: "definition" },
    Equation { text: "ramp: offset + r min(tau, T)", source: "Kogut Fig. 4, 3.2: 0.1 Hz/s" },
    Equation { text: "stairs: level k for (k - 1) T <= tau < k T, k = 1, 2 ...", source: "Kogut Fig. 5" },
    Equation { text: "sine: offset + A sin(2 pi f tau)", source: "definition" },
    Equation { text: "square: edges at k/(2f), to offset + A and offset - A in turn", source: "definition" },
    Equation {
        text: "chirp: offset + A sin(2 pi (f0 tau + (f1 - f0) tau^2/(2 T))) up to T, then f1 with continuous \
            phase",
        source: "Konieczny 3.1",
    },
];

/// How many levels stairs have.
const LEVELS: usize = 12;

/// A value from the start on, zero before. A time that rounding puts just before the start is the start.
fn begun<R: Real>(tau: R, value: R) -> R {
    (tau + 1e-9).select(value, R::from(0.0))
}

/// A source: a model, and a module with its bundles.
macro_rules! source {
    (
        $(#[$doc:meta])* $name:ident { $summary:literal, $signal:ident: $unit:ident, $rate:ident },
        $shape:expr, ramp: $slope:literal for $duration:literal, stairs: [$($level:literal),*]
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name {
            shape: Shape,
        }

        /// Its declarations.
        pub mod $signal {
            use super::*;

            /// Which shape it is.
            #[derive(Settings, Clone, Debug, PartialEq)]
            pub struct Options {
                /// Shape of the signal
                #[set(start = $shape)]
                pub shape: Shape,
            }

            /// What shapes the signal; each shape uses some.
            #[derive(Variables, Clone, Copy, Debug, PartialEq)]
            pub struct Parameters<R> {
                /// Time at which the signal begins
                #[var(unit = S, start = 0.0)]
                pub start_time: R,
                /// Value before the start, and about which sine, square and chirp swing
                #[var(unit = $unit, start = 0.0)]
                pub offset: R,
                /// Amplitude of sine, square and chirp, height of a step
                #[var(unit = $unit, start = 1.0)]
                pub amplitude: R,
                /// Frequency at which sine and square swing
                #[var(unit = HZ, start = 1.0, min = 1e-6)]
                pub swing_frequency: R,
                /// Duration of an edge of step and square
                #[var(unit = S, start = 0.0, min = 0.0)]
                pub edge_time: R,
                /// Chirp
                pub chirp: Chirp<R>,
                /// Ramp
                pub ramp: Ramp<R>,
                /// Stairs
                pub stairs: Stairs<R>,
            }

            /// A linear rise.
            #[derive(Variables, Clone, Copy, Debug, PartialEq)]
            pub struct Ramp<R> {
                /// Growth of the signal
                #[var(unit = $rate, start = $slope)]
                pub rate: R,
                /// Duration of the growth
                #[var(unit = S, start = $duration, min = 1e-6)]
                pub duration: R,
            }

            /// A sequence of levels.
            #[derive(Variables, Clone, Copy, Debug, PartialEq)]
            pub struct Stairs<R> {
                /// Level
                #[var(unit = $unit, start = [$($level),*])]
                pub level: [R; LEVELS],
                /// Duration of each level
                #[var(unit = S, start = 5.0, min = 1e-6)]
                pub duration: R,
            }

            /// The signal.
            #[derive(Variables, Clone, Copy, Debug, PartialEq)]
            pub struct Output<R> {
                /// Signal
                #[var(unit = $unit)]
                pub $signal: R,
            }
        }

        impl Model for $name {
            const ABOUT: About = About {
                name: stringify!($name),
                summary: $summary,
                kind: Kind::Source,
                equations: EQUATIONS,
                notes: NOTES,
                experiment: Experiment { plot: &[stringify!($signal)], ..Experiment::DEFAULT },
                ..About::DEFAULT
            };

            type Settings = $signal::Options;
            type Parameters<R: Real> = $signal::Parameters<R>;
            type Derived<R: Real> = NoVariables;
            type Input<R: Real> = NoVariables;
            type State<R: Real> = NoVariables;
            type Memory<R: Real> = NoVariables;
            type Output<R: Real> = $signal::Output<R>;

            fn prepare(options: &$signal::Options, _: Option<&Path>) -> Result<Self, String> {
                Ok(Self { shape: options.shape })
            }

            fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (NoVariables, $signal::Output<R>) {
                let (p, zero) = (now.parameters, R::from(0.0));
                let since = now.time - p.start_time;
                let tau = since.max(zero);
                let above = match self.shape {
                    Shape::Constant => zero,
                    Shape::Step => edge(tau, zero, p.amplitude, p.edge_time)[0],
                    Shape::Ramp => p.ramp.rate * tau.min(p.ramp.duration),
                    Shape::Stairs => stairs(tau, &p.stairs.level, p.stairs.duration) - p.offset,
                    Shape::Sine => sine(p.amplitude, tau * p.swing_frequency * TAU, p.swing_frequency * TAU)[0],
                    Shape::Square => square(tau, p.amplitude, p.swing_frequency, p.edge_time)[0],
                    Shape::Chirp => p.chirp.at(tau, p.amplitude)[0],
                };
                (NoVariables, $signal::Output { $signal: p.offset + begun(since, above) })
            }
        }
    };
}

source! {
    /// A voltage over time: set-points and test signals for drives and valves.
    VoltageSource {
        "A voltage over time: constant, step, ramp, stairs, sine, square, chirp", voltage: V, V_PER_S
    },
    Shape::Sine, ramp: 1.0 for 10.0, stairs: [0.0, 1.0, 2.0, 3.0, 2.0, 1.0, 0.0, -1.0, -2.0, -3.0, -2.0, -1.0]
}

source! {
    /// A frequency over time: set-points of an excitation.
    FrequencySource {
        "A frequency over time: constant, step, ramp, stairs, sine, square, chirp", frequency: HZ, HZ_PER_S
    },
    Shape::Ramp, ramp: 0.1 for 60.0, stairs: [0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 3.0, 2.0, 1.0, 0.0]
}

#[cfg(test)]
mod tests;
