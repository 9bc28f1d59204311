//! The complete state of a simulation, to go back to.

use strut_integrators::Array;

use crate::{
    Bundle, Error, Model, Settings, Value,
    bundle::{from_slice, to_array},
    layout::{Layout, SolverSettings},
};

use super::{Simulation, input::InputPath};

/// Everything that a simulation's future depends on: time, states, inputs with their derivatives,
/// parameters, settings, sampled memory, tick count, and the integrator's memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot<M: Model> {
    words: Vec<u64>,
    settings: M::Settings,
    solver_settings: SolverSettings,
}

impl<M: Model> Simulation<M> {
    /// The state as it is now.
    pub fn save(&self) -> Snapshot<M> {
        let mut words =
            vec![self.time.to_bits(), self.start.to_bits(), self.ticks, u64::from(self.initializing)];
        let numbers =
            |words: &mut Vec<u64>, slice: &[f64]| words.extend(slice.iter().map(|number| number.to_bits()));
        numbers(&mut words, self.state.as_slice());
        numbers(&mut words, to_array(&self.memory).as_slice());
        numbers(&mut words, to_array(&self.parameters).as_slice());
        numbers(&mut words, to_array(&self.solver).as_slice());
        words.extend(self.input.words());
        words.extend(self.integrator.save());
        Snapshot { words, settings: self.settings.clone(), solver_settings: self.solver_settings.clone() }
    }

    /// Goes back to a saved state; what follows is bit for bit what followed then.
    ///
    /// # Errors
    /// If the snapshot is not one of this model; the simulation is then unchanged.
    pub fn restore(&mut self, snapshot: &Snapshot<M>) -> Result<(), Error> {
        self.try_restore(snapshot).ok_or(Error::Snapshot("its length is not that of this model's state"))
    }

    fn try_restore(&mut self, snapshot: &Snapshot<M>) -> Option<()> {
        let mut words = snapshot.words.iter().copied();
        let words = &mut words;
        let (time, start) = (f64::from_bits(words.next()?), f64::from_bits(words.next()?));
        let (ticks, initializing) = (words.next()?, flag(words)?);
        let state = array(words)?;
        let memory = bundle(words)?;
        let parameters = bundle(words)?;
        let solver = bundle(words)?;
        let input = InputPath::from_words(words)?;
        let mut integrator = self.integrator.clone();
        if integrator.method() != snapshot.solver_settings.method.into() {
            integrator = super::new_integrator::<M>(&snapshot.solver_settings, &solver).ok()?;
        }
        integrator.load(words)?;
        if words.next().is_some() {
            return None;
        }
        let same_parameters = to_array(&parameters) == to_array(&self.parameters);
        self.underived |= !same_parameters || to_array(&solver) != to_array(&self.solver);
        if self.settings != snapshot.settings || self.solver_settings != snapshot.solver_settings {
            self.settings.clone_from(&snapshot.settings);
            self.solver_settings.clone_from(&snapshot.solver_settings);
            self.unprepared = true;
        }
        (self.time, self.start, self.ticks, self.initializing) = (time, start, ticks, initializing);
        (self.state, self.memory, self.parameters, self.solver) = (state, memory, parameters, solver);
        (self.input, self.integrator) = (input, integrator);
        self.stale = true;
        Some(())
    }
}

impl<M: Model> Snapshot<M> {
    /// As bytes, for another process: the words in little endian, then the settings.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = (self.words.len() as u64).to_le_bytes().to_vec();
        bytes.extend(self.words.iter().flat_map(|word| word.to_le_bytes()));
        let own = (0..).map_while(|index| self.settings.get(index));
        let solver = (0..).map_while(|index| self.solver_settings.get(index));
        for value in own.chain(solver).take(Layout::<M>::SETTINGS) {
            match value {
                Value::Real(number) => bytes.extend(number.to_le_bytes()),
                Value::Integer(number) => bytes.extend(number.to_le_bytes()),
                Value::Boolean(flag) => bytes.push(u8::from(flag)),
                Value::Text(text) => {
                    bytes.extend((text.len() as u64).to_le_bytes());
                    bytes.extend(text.as_bytes());
                }
            }
        }
        bytes
    }

    /// From bytes.
    ///
    /// # Errors
    /// If they are not the bytes of a snapshot of this model.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        Self::read(bytes).ok_or(Error::Snapshot("the bytes are damaged or belong to another model"))
    }

    fn read(mut bytes: &[u8]) -> Option<Self> {
        let count = usize::try_from(u64::from_le_bytes(take(&mut bytes)?)).ok()?;
        // More words than bytes would be an allocation on the word of a damaged length.
        if count > bytes.len() / 8 {
            return None;
        }
        let words = (0..count).map(|_| take(&mut bytes).map(u64::from_le_bytes)).collect::<Option<_>>()?;
        let mut settings = M::Settings::starts();
        let mut solver_settings = SolverSettings::starts();
        let own = M::Settings::COUNT;
        for index in 0..Layout::<M>::SETTINGS {
            if index < own {
                let value = read_like(&settings.get(index)?, &mut bytes)?;
                settings.set(index, value)?;
            } else {
                let value = read_like(&solver_settings.get(index - own)?, &mut bytes)?;
                solver_settings.set(index - own, value)?;
            }
        }
        bytes.is_empty().then_some(Self { words, settings, solver_settings })
    }
}

/// Reads a value of the same type as another.
fn read_like(value: &Value, bytes: &mut &[u8]) -> Option<Value> {
    Some(match value {
        Value::Real(_) => Value::Real(f64::from_le_bytes(take(bytes)?)),
        Value::Integer(_) => Value::Integer(i32::from_le_bytes(take(bytes)?)),
        Value::Boolean(_) => match take(bytes)? {
            [0] => Value::Boolean(false),
            [1] => Value::Boolean(true),
            _ => return None,
        },
        Value::Text(_) => {
            let len = usize::try_from(u64::from_le_bytes(take(bytes)?)).ok()?;
            let (text, rest) = bytes.split_at_checked(len)?;
            *bytes = rest;
            Value::Text(String::from_utf8(text.to_vec()).ok()?)
        }
    })
}

fn take<const N: usize>(bytes: &mut &[u8]) -> Option<[u8; N]> {
    let (first, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(*first)
}

/// The next numbers of a snapshot.
pub(super) fn array<A: Array>(words: &mut impl Iterator<Item = u64>) -> Option<A> {
    let mut array = A::zeros();
    for number in array.as_mut_slice() {
        *number = f64::from_bits(words.next()?);
    }
    Some(array)
}

/// The next word of a snapshot as what it can only be.
pub(super) fn flag(words: &mut impl Iterator<Item = u64>) -> Option<bool> {
    match words.next()? {
        0 => Some(false),
        1 => Some(true),
        _ => None,
    }
}

fn bundle<B: Bundle<f64>>(words: &mut impl Iterator<Item = u64>) -> Option<B> {
    let numbers: B::Array = array(words)?;
    Some(from_slice(numbers.as_slice()))
}
