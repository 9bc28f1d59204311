//! An FMU on the test bench: what is set, what is read, and in which steps.

use std::path::{MAIN_SEPARATOR, Path, PathBuf};

use crate::description::{Description, Interface, Kind, Variable, Version};
use crate::probe::{Act, Orders, Outcome, RESTLESS, Run};

/// How many steps a run has.
pub const STEPS: usize = 40;
/// Half of them: where runs are interrupted.
pub const HALF: usize = STEPS / 2;

/// What runs are made of.
pub struct Subject<'a> {
    /// Its description.
    pub description: &'a Description,
    /// The interface that is run.
    pub interface: &'a Interface,
    /// Path of the library below the FMU's folder.
    pub library: String,
    /// The version of its interface.
    pub version: Version,
    inputs: Vec<(u32, f64, f64, f64, f64)>,
    reads: Vec<Act>,
    start: f64,
    /// Communication step in seconds.
    pub step: f64,
}

type Acts = Vec<(Act, bool)>;

/// The real variables of a role that a run can read and set.
pub fn reals<'a>(
    description: &'a Description,
    of: &'a dyn Fn(&Variable) -> bool,
) -> impl Iterator<Item = (u32, &'a Variable)> {
    let reals = description.variables.iter().filter(|variable| variable.kind == "Real" && of(variable));
    reals.filter_map(|variable| Some((variable.reference?, variable)))
}

impl<'a> Subject<'a> {
    /// What is to be done with an interface.
    pub fn new(
        description: &'a Description,
        version: Version,
        interface: &'a Interface,
        library: String,
    ) -> Self {
        let moved =
            |variable: &Variable| variable.causality == "input" && variable.variability == "continuous";
        let inputs = reals(description, &moved)
            .map(|(reference, variable)| {
                let start = number(variable).unwrap_or(0.0);
                // Enough to move something, little enough to hurt nothing.
                let swing = 0.01 * variable.nominal.unwrap_or(start.abs().max(1.0));
                let (min, max) = (variable.min.unwrap_or(f64::MIN), variable.max.unwrap_or(f64::MAX));
                (reference, start, swing, min, max)
            })
            .collect();
        let of = |kinds: &[&str]| -> Vec<u32> {
            let all = description.variables.iter().filter(|variable| kinds.contains(&variable.kind.as_str()));
            all.filter(|variable| variable.causality == "output")
                .filter_map(|variable| variable.reference)
                .collect()
        };
        let mut references = of(&["Real"]);
        if references.is_empty() {
            // Who has no outputs shows its states.
            let local =
                |variable: &Variable| variable.causality == "local" && variable.variability == "continuous";
            references = reals(description, &local).map(|(reference, _)| reference).take(50).collect();
        }
        let mut reads = vec![
            Act::Reals(references),
            Act::Integers(of(&["Integer", "Enumeration"]), false),
            Act::Integers(of(&["Boolean"]), true),
            Act::Texts(of(&["String"])),
        ];
        reads.retain(|act| match act {
            Act::Reals(references) | Act::Integers(references, _) | Act::Texts(references) => {
                !references.is_empty()
            }
            _ => true,
        });
        let experiment = description.experiment;
        let start = experiment.start.unwrap_or(0.0);
        let length = experiment.stop.map_or(1.0, |stop| stop - start).max(0.0);
        let positive = |value: &f64| *value > 0.0 && value.is_finite();
        let fifty = if length > 0.0 { length / 500.0 } else { 1e-2 };
        let mut step = experiment.step.filter(positive).unwrap_or(fifty);
        if length > 0.0 {
            step = step.min(length / STEPS as f64);
        }
        if interface.kind == Kind::ModelExchange {
            // Explicit Euler steps, short enough for anything.
            step = 1e-6 * if length > 0.0 { length } else { 1.0 };
        }
        Self { description, interface, library, version, inputs, reads, start, step }
    }

    /// Acts for the library of an unpacked FMU.
    pub fn orders(&self, folder: &Path, acts: Acts) -> Orders {
        let library: PathBuf = folder.join(&self.library);
        Orders { library, version: self.version, acts }
    }

    /// Makes an instance.
    pub fn instantiate(&self, folder: &Path, guid: &str, logging: bool) -> (Act, bool) {
        let resources = folder.join("resources");
        let resources = match self.version {
            Version::Two => uri(&resources),
            Version::Three => format!("{}{MAIN_SEPARATOR}", resources.display()),
        };
        let act = Act::Instantiate { kind: self.interface.kind, guid: guid.into(), resources, logging };
        (act, true)
    }

    /// Makes an instance with the right GUID.
    pub fn fresh(&self, folder: &Path) -> Acts {
        vec![self.instantiate(folder, self.description.guid.as_deref().unwrap_or_default(), false)]
    }

    /// Up to where the initial values can be read.
    pub fn begin(&self) -> Acts {
        let experiment = self.description.experiment;
        let set_up = Act::SetUp {
            start: self.start,
            stop: experiment.stop.filter(|stop| *stop > self.start),
            tolerance: experiment.tolerance.filter(|tolerance| *tolerance > 0.0),
        };
        vec![(set_up, true), plain("EnterInitializationMode")]
    }

    /// Up to the first step.
    pub fn initialize(&self) -> Acts {
        let mut acts = self.begin();
        acts.push(plain("ExitInitializationMode"));
        if self.interface.kind == Kind::ModelExchange {
            acts.push((Act::DiscreteStates, true));
            acts.push(plain("EnterContinuousTimeMode"));
        }
        acts
    }

    /// Time of a step.
    pub fn time(&self, index: usize) -> f64 {
        self.start + index as f64 * self.step
    }

    /// Sets the inputs for a step; `scale` makes another run of it.
    pub fn excite(&self, index: usize, scale: f64) -> Option<(Act, bool)> {
        let values = self.inputs.iter().map(|(_, start, swing, min, max)| {
            let phase = std::f64::consts::TAU * index as f64 / STEPS as f64;
            (start + scale * swing * phase.sin()).clamp(*min, *max)
        });
        let references: Vec<u32> = self.inputs.iter().map(|(reference, ..)| *reference).collect();
        (!references.is_empty()).then(|| (Act::SetReals(references, values.collect()), true))
    }

    /// A step from a time.
    pub fn advance(&self, time: f64) -> (Act, bool) {
        let act = match self.interface.kind {
            Kind::CoSimulation => Act::Step(time, self.step),
            Kind::ModelExchange => Act::Euler {
                states: self.description.derivatives.len(),
                indicators: self.description.event_indicators,
                time,
                size: self.step,
            },
        };
        (act, true)
    }

    /// Some steps, with the outputs read after each.
    pub fn steps(&self, range: std::ops::Range<usize>, scale: f64) -> Acts {
        let mut acts = Vec::new();
        for index in range {
            acts.extend(self.excite(index, scale));
            acts.push(self.advance(self.time(index)));
            acts.extend(self.reads());
        }
        acts
    }

    /// Reads the outputs.
    pub fn reads(&self) -> Acts {
        self.reads.iter().map(|act| (act.clone(), true)).collect()
    }

    /// The name of a status.
    pub fn status(&self, status: i32) -> String {
        const NAMES: [&str; 6] = ["OK", "Warning", "Discard", "Error", "Fatal", "Pending"];
        if status == RESTLESS {
            return "without ever coming to rest: it asks for another event iteration a hundred times"
                .to_owned();
        }
        match usize::try_from(status).ok().and_then(|index| NAMES.get(index)) {
            Some(name) => format!("{}{name}", self.version.prefix()),
            None => "a status that FMI does not know".to_owned(),
        }
    }

    /// How many acts read the outputs once.
    pub fn width(&self) -> usize {
        self.reads.len()
    }
}

/// A function without arguments, which must succeed.
pub fn plain(function: &str) -> (Act, bool) {
    (Act::Plain(function.into()), true)
}

/// The start value of a real variable.
pub fn number(variable: &Variable) -> Option<f64> {
    variable.start.as_deref()?.trim().parse().ok()
}

/// What was read in a run, in order.
pub fn read(run: &Run) -> Vec<&Outcome> {
    let outcomes = run.acts.iter().zip(&run.answers.outcomes);
    let is_read = |act: &Act| matches!(act, Act::Reals(_) | Act::Integers(..) | Act::Texts(_));
    outcomes.filter(|((act, _), _)| is_read(act)).map(|(_, outcome)| outcome).collect()
}

/// A path as an address (RFC 8089): what is no plain character is encoded.
pub fn uri(path: &Path) -> String {
    let mut uri = String::from("file://");
    let text = path.to_string_lossy().replace('\\', "/");
    if !text.starts_with('/') {
        uri.push('/');
    }
    for byte in text.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' | b':' => {
                uri.push(byte as char);
            }
            other => uri.push_str(&format!("%{other:02X}")),
        }
    }
    uri
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_encoded() {
        assert_eq!(uri(Path::new("/tmp/a b/ü")), "file:///tmp/a%20b/%C3%BC");
        assert_eq!(uri(Path::new("C:\\x")), "file:///C:/x");
    }
}
