//! What another process does with a library, act by act, and what came of it.

mod act;
mod exchange;
mod library;
mod logger;
mod memory;
mod process;
mod three;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use serde::{Deserialize, Serialize};

use crate::description::{Kind, Version};
pub use act::Act;
use library::Saved;
pub use library::{ABSENT, Instance, Library, Status};
pub use logger::Log;
pub use memory::Memory;
pub use process::{Ending, Probe, Run};

/// What to do with which library.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Orders {
    /// The library.
    pub library: PathBuf,
    /// The version of its interface.
    pub version: Version,
    /// What to do; the first failure of an act that must succeed ends it.
    pub acts: Vec<(Act, bool)>,
}

/// What an act came to.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Outcome {
    /// The function's status.
    pub status: i32,
    /// Bits of the reals that were read: what is no number is no number in JSON either.
    pub reals: Vec<u64>,
    /// Integers and Booleans that were read.
    pub integers: Vec<i32>,
    /// Texts that were read; none for null.
    pub texts: Vec<Option<String>>,
}

/// What came of all.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Answers {
    /// Why the library could not be loaded.
    pub unloadable: Option<String>,
    /// Its words on the FMI version and the platform's types.
    pub version: Option<String>,
    /// `default`.
    pub types: Option<String>,
    /// What each act came to, up to the first failure.
    pub outcomes: Vec<Outcome>,
    /// What was logged.
    pub log: Log,
    /// What became of the importer's memory.
    pub memory: Memory,
}

impl Outcome {
    fn of(status: i32) -> Self {
        Self { status, reals: Vec::new(), integers: Vec::new(), texts: Vec::new() }
    }

    /// Whether the call was successful, perhaps with a warning.
    pub fn is_fine(&self) -> bool {
        (0..=1).contains(&self.status)
    }

    /// The reals that were read.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.reals.iter().map(|bits| f64::from_bits(*bits))
    }
}

/// A status of our own: events lead to events, without an end.
pub const RESTLESS: i32 = -2;

const ORDERS: &str = "orders.json";
const ANSWERS: &str = "answers.json";
const CALLING: &str = "calling";

/// Does what the orders in a folder say and writes the answers beside them.
pub fn probe(folder: &Path) -> ExitCode {
    let orders = std::fs::read(folder.join(ORDERS)).ok();
    let Some(orders) = orders.and_then(|text| serde_json::from_slice::<Orders>(&text).ok()) else {
        eprintln!("error: there are no orders in `{}`; this command is for `check` alone", folder.display());
        return ExitCode::from(2);
    };
    let answers = obey(&orders, folder);
    let text = serde_json::to_vec(&answers).expect("answers are plain data");
    match std::fs::write(folder.join(ANSWERS), text) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: cannot write the answers: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Which function is being called, in a file: who ends this process tells nothing more.
struct Calling(Option<File>);

impl Calling {
    /// As long as the longest text.
    const LENGTH: usize = 64;

    fn new(folder: &Path) -> Self {
        Self(File::create(folder.join(CALLING)).ok())
    }

    /// Written over what was there: a file that is made anew each time has the disk wait for each.
    fn tell(&mut self, what: &str) {
        if let Some(file) = &mut self.0 {
            let text = format!("{what:<width$}", width = Self::LENGTH);
            // Without the file, the message on a crash does not name the function.
            let _ = file.rewind().and_then(|()| file.write_all(text.as_bytes()));
        }
    }
}

fn obey(orders: &Orders, folder: &Path) -> Answers {
    let mut calling = Calling::new(folder);
    calling.tell("its initialisation");
    let obeyed = match orders.version {
        Version::Two => Library::load(&orders.library).map(|library| {
            let told = Answers {
                version: library.word("fmi2GetVersion"),
                types: library.word("fmi2GetTypesPlatform"),
                ..Answers::default()
            };
            let mut stage =
                Stage { library: &library, instances: Vec::new(), current: 0, states: BTreeMap::new() };
            Answers { outcomes: outcomes(orders, &mut calling, |act| stage.perform(act)), ..told }
        }),
        Version::Three => three::Stage::load(&orders.library).map(|mut stage| {
            let outcomes = outcomes(orders, &mut calling, |act| stage.perform(act));
            Answers { version: stage.version(), outcomes, ..Answers::default() }
        }),
    };
    let mut answers =
        obeyed.unwrap_or_else(|error| Answers { unloadable: Some(error), ..Answers::default() });
    answers.log = logger::logged();
    answers.memory = memory::memory();
    calling.tell("the end of the process");
    answers
}

/// What each act comes to, up to the first failure.
fn outcomes(
    orders: &Orders,
    calling: &mut Calling,
    mut perform: impl FnMut(&Act) -> Outcome,
) -> Vec<Outcome> {
    let mut outcomes = Vec::new();
    for (act, must) in &orders.acts {
        // Each call is reported, so that the parent sees progress.
        calling.tell(&act.function(orders.version));
        let outcome = perform(act);
        let ends = outcome.status == 4 || (*must && !outcome.is_fine());
        outcomes.push(outcome);
        if ends {
            break;
        }
    }
    outcomes
}

struct Stage<'a> {
    library: &'a Library,
    instances: Vec<Instance>,
    current: usize,
    states: BTreeMap<usize, Saved>,
}

impl Stage<'_> {
    fn perform(&mut self, act: &Act) -> Outcome {
        let library = self.library;
        if let Act::Instantiate { kind, guid, resources, logging } = act {
            return match library.instantiate(*kind == Kind::CoSimulation, guid, resources, *logging) {
                Some(instance) => {
                    self.current = self.instances.len();
                    self.instances.push(instance);
                    Outcome::of(0)
                }
                None => Outcome::of(3),
            };
        }
        if let Act::Use(number) = act {
            self.current = *number;
            return Outcome::of(0);
        }
        let Some(instance) = self.instances.get(self.current).copied() else { return Outcome::of(ABSENT) };
        let mut outcome = Outcome::of(0);
        let mut reals = Vec::new();
        outcome.status = match act {
            Act::Instantiate { .. } | Act::Use(_) => 0,
            Act::SetUp { start, stop, tolerance } => library.set_up(instance, *start, *stop, *tolerance),
            Act::Plain(_) => library.plain(&act.function(Version::Two), instance),
            Act::Free => {
                library.free(instance);
                0
            }
            Act::FreeNothing => {
                library.free_nothing();
                0
            }
            Act::Reals(references) => {
                reals = vec![0.0; references.len()];
                library.reals(instance, references, &mut reals)
            }
            Act::Integers(references, booleans) => {
                outcome.integers = vec![0; references.len()];
                let function = if *booleans { "fmi2GetBoolean" } else { "fmi2GetInteger" };
                library.integers(function, instance, references, &mut outcome.integers)
            }
            Act::Texts(references) => library.texts(instance, references, &mut outcome.texts),
            Act::SetReals(references, values) => library.set_reals(instance, references, values),
            Act::Step(time, size) => library.step(instance, *time, *size),
            Act::Save(number) => {
                let (status, state) = library.save(instance, self.states.get(number).copied());
                self.states.insert(*number, state);
                status
            }
            Act::Restore(number) => {
                self.states.get(number).map_or(ABSENT, |state| library.restore(instance, *state))
            }
            Act::FreeState(number) => self.states.remove(number).map_or(ABSENT, |state| {
                let (status, is_null) = library.free_state(instance, state);
                outcome.integers = vec![i32::from(is_null)];
                status
            }),
            Act::Serialize(from, to) => match self.states.get(from) {
                None => ABSENT,
                Some(state) => {
                    let (mut status, bytes) = library.serialize(instance, *state);
                    if (0..=1).contains(&status) {
                        let (received, state) = library.deserialize(instance, &bytes);
                        status = received;
                        self.states.insert(*to, state);
                    }
                    status
                }
            },
            Act::Directional(unknowns, known) => {
                reals = vec![0.0; unknowns.len()];
                library.directional(instance, unknowns, *known, &mut reals)
            }
            Act::InputDerivatives(references, rates) => {
                library.set_input_derivatives(instance, references, rates)
            }
            Act::OutputDerivatives(references, order) => {
                reals = vec![0.0; references.len()];
                library.output_derivatives(instance, references, *order, &mut reals)
            }
            Act::Nominals(states) => {
                reals = vec![0.0; *states];
                library.array(&act.function(Version::Two), instance, &mut reals)
            }
            Act::DiscreteStates => discrete_states(library, instance),
            Act::Euler { states, indicators, time, size } => {
                euler(library, instance, (*states, *indicators), *time, *size)
            }
        };
        outcome.reals = reals.into_iter().map(f64::to_bits).collect();
        outcome
    }
}

/// Event iteration by the standard; a model that never comes to rest has failed.
fn discrete_states(library: &Library, instance: Instance) -> i32 {
    for _ in 0..100 {
        let (status, discrete) = library.new_discrete_states(instance);
        if !discrete.again || !(0..=1).contains(&status) {
            return status;
        }
    }
    RESTLESS
}

fn euler(
    library: &Library,
    instance: Instance,
    (states, indicators): (usize, usize),
    time: f64,
    size: f64,
) -> i32 {
    let (mut x, mut rates) = (vec![0.0; states], vec![0.0; states]);
    let mut calls = || -> Result<(), i32> {
        let fine = |status: i32| if (0..=1).contains(&status) { Ok(()) } else { Err(status) };
        if states > 0 {
            fine(library.array("fmi2GetContinuousStates", instance, &mut x))?;
            fine(library.rates(instance, &mut rates))?;
        }
        fine(library.set_time(instance, time + size))?;
        if states > 0 {
            x.iter_mut().zip(&rates).for_each(|(x, rate)| *x += size * rate);
            fine(library.set_states(instance, &x))?;
        }
        if indicators > 0 {
            fine(library.array("fmi2GetEventIndicators", instance, &mut vec![0.0; indicators]))?;
        }
        let (status, event) = library.completed_step(instance);
        fine(status)?;
        if event {
            fine(library.plain("fmi2EnterEventMode", instance))?;
            fine(discrete_states(library, instance))?;
            fine(library.plain("fmi2EnterContinuousTimeMode", instance))?;
        }
        Ok(())
    };
    calls().err().unwrap_or(0)
}
