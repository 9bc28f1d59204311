//! Effects in signals: the distortions of sensors and actuators.

use super::{Onset, Prevalence};
use crate::signal::distortion::Fault;

/// A distortion of a signal; its number depends on the signal.
#[derive(Debug)]
pub struct Distortion {
    /// The amount that is fitted.
    pub fault: Fault,
    /// What it is called.
    pub name: &'static str,
    /// Its law in plain text.
    pub equation: &'static str,
    /// Distortions of the same signal that it contains as special cases.
    pub contains: &'static [Fault],
    /// Distortions of the same signal with nearly the same shape. They are fitted together, since a rough shape of one may hide another.
    pub alike: &'static [Fault],
    /// When it acts.
    pub onset: Onset,
    /// Smallest and largest amount.
    pub bounds: Bounds,
    /// Where its law is published, by keys of the literature.
    pub literature: &'static [&'static str],
    /// What separates it from others.
    pub experiment: &'static str,
    /// Of an input that an actuator follows.
    pub command: At,
    /// Of another input, which a sensor measures.
    pub input: At,
    /// Of an output, which a sensor measures.
    pub output: At,
}

impl Distortion {
    /// What it is at a kind of signal.
    pub fn at(&self, signal: Signal) -> &At {
        match signal {
            Signal::Command => &self.command,
            Signal::Input => &self.input,
            Signal::Output => &self.output,
        }
    }

    /// What it is called at a kind of signal.
    pub fn called(&self, signal: Signal) -> String {
        format!("{} of the {}", self.name, signal.place())
    }
}

/// A kind of signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signal {
    /// An input that an actuator follows.
    Command,
    /// Another input.
    Input,
    /// An output.
    Output,
}

impl Signal {
    /// Every kind.
    pub const ALL: [Self; 3] = [Self::Command, Self::Input, Self::Output];

    /// The kind of an input, by its name.
    pub fn of_input(name: &str) -> Self {
        if is_command(name) { Self::Command } else { Self::Input }
    }

    /// What makes the distortion.
    pub fn place(self) -> &'static str {
        if self == Self::Command { "actuator" } else { "sensor" }
    }
}

/// What the names of inputs begin with that act through an actuator, and not through a sensor alone.
pub const ACTUATORS: [&str; 6] = ["actuator", "brake", "command", "control", "motor", "voltage"];

/// Whether an input, by its name, is an actuator's command.
pub fn is_command(input: &str) -> bool {
    ACTUATORS.iter().any(|prefix| input.starts_with(prefix))
}

/// A distortion at a kind of signal.
#[derive(Debug)]
pub struct At {
    /// Its number; 39 and 42 are families.
    pub id: &'static str,
    /// Which signals of the kind it is looked for in.
    pub among: Among,
    /// How common it is there.
    pub prevalence: Prevalence,
    /// A second amount that is fitted with it, whose law this is then.
    pub with: Option<Fault>,
}

/// Which signals a distortion is looked for in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Among {
    /// In all.
    All,
    /// In those whose names end so.
    Ending(&'static str),
    /// In those whose names do not end so.
    NotEnding(&'static str),
    /// In none: another distortion covers it, or the check of the data finds it.
    None,
}

impl Among {
    /// Whether a signal is one of them.
    pub fn has(self, name: &str) -> bool {
        match self {
            Self::All => true,
            Self::Ending(end) => name.ends_with(end),
            Self::NotEnding(end) => !name.ends_with(end),
            Self::None => false,
        }
    }
}

/// Smallest and largest amount of a distortion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bounds {
    /// In the amount's own unit.
    Between(f64, f64),
    /// Shares of the signal's largest magnitude.
    OfLargest(f64, f64),
    /// Seconds to either side, or of an input a quarter of its period: what is later is as well reversed and early by the rest. Of an
    /// output, which is predicted in short sections, more would be lost at the begin of each.
    QuarterOfPeriod(f64),
    /// Without any.
    Free,
}

const fn at(id: &'static str) -> At {
    At { id, among: Among::All, prevalence: Prevalence::Occasional, with: None }
}

const fn nowhere(id: &'static str) -> At {
    At { among: Among::None, ..at(id) }
}

/// What every sensor has a little of.
const fn usual(id: &'static str) -> At {
    At { prevalence: Prevalence::Background, ..at(id) }
}

const GAIN: Distortion = Distortion {
    fault: Fault::Gain,
    name: "gain",
    equation: "(1 + gain) y",
    contains: &[],
    alike: &[],
    onset: Onset::Always,
    // None is off by more; a sign is another matter.
    bounds: Bounds::Between(-0.5, 0.5),
    literature: &["Doebelin2003", "Isermann2006"],
    experiment: "weigh the masses, or turn the sensor over",
    command: at("25"),
    input: at("42"),
    output: at("34"),
};

const OFFSET: Distortion = Distortion {
    fault: Fault::Offset,
    name: "offset",
    equation: "y + offset",
    contains: &[],
    alike: &[],
    onset: Onset::Always,
    bounds: Bounds::Free,
    literature: &["Doebelin2003", "Isermann2006"],
    experiment: "record a standstill",
    // Positions count from wherever equilibrium is.
    command: At { among: Among::NotEnding("position"), ..at("41") },
    input: At { among: Among::NotEnding("position"), ..at("33") },
    output: At { with: Some(Fault::Drift), ..at("33") },
};

/// A drift is looked for with the offset that it starts from.
const DRIFT: Distortion = Distortion {
    fault: Fault::Drift,
    equation: "y + offset + drift t",
    experiment: "record a standstill of the same length",
    command: nowhere("41"),
    input: nowhere("33"),
    output: nowhere("33"),
    ..OFFSET
};

const LAG: Distortion = Distortion {
    fault: Fault::Lag,
    name: "lag",
    equation: "lag y' + y = y_true",
    contains: &[],
    alike: &[Fault::Delay],
    onset: Onset::Always,
    bounds: Bounds::Between(0.0, 0.2),
    literature: &["Doebelin2003"],
    experiment: "sweep to high frequencies",
    command: at("24"),
    input: at("42"),
    output: usual("35"),
};

const DELAY: Distortion = Distortion {
    fault: Fault::Delay,
    name: "delay",
    equation: "y(t - delay)",
    contains: &[],
    alike: &[Fault::Lag, Fault::Rate],
    onset: Onset::Always,
    bounds: Bounds::QuarterOfPeriod(0.05),
    literature: &["Bjorklund2003"],
    experiment: "strike once and compare the signals' onsets",
    command: at("23"),
    input: at("42"),
    output: usual("36"),
};

const QUADRATIC: Distortion = Distortion {
    fault: Fault::Quadratic,
    name: "curvature",
    equation: "y + quadratic y^2",
    contains: &[],
    alike: &[],
    onset: Onset::Always,
    bounds: Bounds::Free,
    literature: &["Doebelin2003"],
    experiment: "calibrate with gauge blocks",
    command: nowhere("39"),
    input: nowhere("42"),
    output: At { among: Among::Ending("deflection"), ..at("39") },
};

const CUBIC: Distortion = Distortion { fault: Fault::Cubic, equation: "y + cubic y^3", ..QUADRATIC };

const RATE: Distortion = Distortion {
    fault: Fault::Rate,
    name: "sampling rate",
    equation: "y((1 + rate) t)",
    contains: &[],
    alike: &[Fault::Delay],
    onset: Onset::Always,
    bounds: Bounds::Between(-0.02, 0.02),
    literature: &["MarkovichGolan2012"],
    experiment: "compare the clocks, or record for longer",
    command: nowhere("40"),
    input: nowhere("40"),
    output: at("40"),
};

const LIMIT: Distortion = Distortion {
    fault: Fault::Limit,
    name: "limit",
    equation: "clamp(y, -limit, limit)",
    contains: &[],
    alike: &[],
    onset: Onset::Threshold,
    // A limit far below the usual commands would be a gain.
    bounds: Bounds::OfLargest(0.2, 1.0),
    literature: &["Slotine1991"],
    experiment: "repeat the run with half the command",
    command: at("26"),
    input: nowhere("26"),
    output: nowhere("26"),
};

/// A linear response of a sensor without a name.
pub const RESPONSE: Distortion = Distortion {
    fault: Fault::Response(0),
    name: "unnamed response",
    equation: "a table of the step response over time",
    contains: &[Fault::Gain, Fault::Lag, Fault::Delay],
    alike: &[],
    onset: Onset::Always,
    bounds: Bounds::Between(-10.0, 10.0),
    literature: &["Ljung1999", "Pillonetto2014"],
    experiment: "sweep the sensor beside one whose response is known",
    command: nowhere("G5"),
    input: nowhere("G5"),
    output: usual("G5"),
};

/// Every distortion with a name.
pub const DISTORTIONS: [&Distortion; 9] =
    [&GAIN, &OFFSET, &DRIFT, &LAG, &DELAY, &QUADRATIC, &CUBIC, &RATE, &LIMIT];

/// The entry of a distortion.
pub fn distortion(fault: Fault) -> &'static Distortion {
    match fault {
        Fault::Gain => &GAIN,
        Fault::Offset => &OFFSET,
        Fault::Drift => &DRIFT,
        Fault::Lag => &LAG,
        Fault::Delay => &DELAY,
        Fault::Quadratic => &QUADRATIC,
        Fault::Cubic => &CUBIC,
        Fault::Rate => &RATE,
        Fault::Limit => &LIMIT,
        Fault::Response(_) => &RESPONSE,
    }
}

/// The distortions that are looked for in a signal.
pub fn distortions(signal: Signal, name: &str) -> impl Iterator<Item = Fault> {
    DISTORTIONS.into_iter().filter(move |it| it.at(signal).among.has(name)).map(|it| it.fault)
}
