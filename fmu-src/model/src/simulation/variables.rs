//! Reading and writing variables by value reference.

use strut_integrators::Array;

use crate::{
    Declaration, Error, Model, Settings, Value,
    bundle::{from_slice, to_array},
    layout::{Layout, Section, check_bounds, display, expected, name_in},
};

use super::{Simulation, input::MAX_ORDER};

/// What may be changed at the moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Access {
    /// Inputs and continuous states: while an outside integrator works.
    Continuous,
    /// Inputs and tunable parameters: between steps and at events.
    Tunable,
    /// Inputs, tunable parameters and continuous states: at events of an outside integrator (FMI 3.0).
    Event,
    /// Inputs, parameters and start values: until initialisation ends.
    All,
}

impl Access {
    /// Whether an outside integrator is at work.
    fn is_integrators(self) -> bool {
        matches!(self, Self::Continuous | Self::Event)
    }
}

impl<M: Model> Simulation<M> {
    /// Reads real variables.
    ///
    /// # Errors
    /// For an unknown reference, or if the model refuses its settings.
    #[inline(always)]
    pub fn real(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Error> {
        for (reference, value) in references.iter().zip(values) {
            let (section, index) = Layout::<M>::locate(*reference)?;
            if matches!(section, Section::Output | Section::Rate | Section::Derived) {
                self.evaluate()?;
            }
            *value = match section {
                Section::Input => self.input.at(self.time).as_slice()[index],
                Section::Output => self.output.as_slice()[index],
                Section::State => self.state.as_slice()[index],
                Section::Rate => self.rates.as_slice()[index],
                Section::Parameter => to_array(&self.parameters).as_slice()[index],
                Section::Derived => to_array(&self.derived).as_slice()[index],
                Section::Solver => to_array(&self.solver).as_slice()[index],
            };
        }
        Ok(())
    }

    /// Reads what has a start value that may be read before anything is calculated.
    ///
    /// # Errors
    /// For an unknown reference or a variable that is calculated.
    #[cold]
    pub fn real_before_initialization(&self, references: &[u32], values: &mut [f64]) -> Result<(), Error> {
        for (reference, value) in references.iter().zip(values) {
            let (section, index) = Layout::<M>::locate(*reference)?;
            *value = match section {
                Section::Input => self.input.at(self.time).as_slice()[index],
                Section::State => self.state.as_slice()[index],
                Section::Parameter => to_array(&self.parameters).as_slice()[index],
                Section::Solver => to_array(&self.solver).as_slice()[index],
                Section::Output | Section::Rate | Section::Derived => {
                    return Err(Error::NotCalculated { name: Layout::<M>::declared().name(*reference) });
                }
            };
        }
        Ok(())
    }

    /// Sets real variables; all of them or, on an error, those before the one in question.
    ///
    /// # Errors
    /// For an unknown reference, a variable that may not be set now, a value that is not finite or not
    /// within the declared bounds.
    #[inline(always)]
    pub fn set_real(&mut self, references: &[u32], values: &[f64], access: Access) -> Result<(), Error> {
        for (reference, value) in references.iter().zip(values) {
            match Layout::<M>::locate(*reference)? {
                (Section::Input, index) if value.is_finite() => {
                    if self.input.set(index, *value) {
                        self.changed();
                    }
                }
                // As `set_states`: what a solver tries may be out of bounds.
                (Section::State, index) if access.is_integrators() && value.is_finite() => {
                    self.state.as_mut_slice()[index] = *value;
                    self.changed();
                }
                (section, index) => self.set_rarely(section, index, *value, access)?,
            }
        }
        Ok(())
    }

    /// Everything but the finite value of an input.
    #[cold]
    fn set_rarely(
        &mut self,
        section: Section,
        index: usize,
        value: f64,
        access: Access,
    ) -> Result<(), Error> {
        check_settable(section, &Layout::<M>::declarations(section)[index], value, access)?;
        match section {
            Section::State => self.state.as_mut_slice()[index] = value,
            Section::Solver => {
                let mut numbers = to_array(&self.solver);
                numbers.as_mut_slice()[index] = value;
                self.solver = from_slice(numbers.as_slice());
            }
            _ => {
                let mut numbers = to_array(&self.parameters);
                numbers.as_mut_slice()[index] = value;
                self.parameters = from_slice(numbers.as_slice());
            }
        }
        self.underived = true;
        self.changed();
        Ok(())
    }

    /// Sets derivatives of inputs with respect to time at the present time; they hold for the next step.
    ///
    /// # Errors
    /// For a variable that is no input, an unsupported order or a value that is not finite.
    pub fn set_input_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &[f64],
    ) -> Result<(), Error> {
        for ((reference, order), value) in references.iter().zip(orders).zip(values) {
            let name = || Layout::<M>::declared().name(*reference);
            let (Section::Input, index) = Layout::<M>::locate(*reference)? else {
                return Err(Error::NotSettable {
                    name: name(),
                    reason: "only inputs have derivatives to be set",
                });
            };
            let Some(order) = usize::try_from(*order).ok().filter(|order| (1..=MAX_ORDER).contains(order))
            else {
                return Err(Error::Order {
                    name: name(),
                    order: *order,
                    supported: "inputs have orders 1 and 2",
                });
            };
            if !value.is_finite() {
                return Err(Error::NotFinite { name: name(), value: *value });
            }
            self.input.set_derivative(index, order, *value, self.time);
            self.changed();
        }
        Ok(())
    }

    /// Reads a setting; its type must be the one asked for (an enumeration's is integer).
    ///
    /// # Errors
    /// For an unknown reference or a setting of another type.
    pub fn setting(&self, reference: u32, kind: &'static str) -> Result<Value, Error> {
        let index = reference as usize;
        let value = match index.checked_sub(M::Settings::COUNT) {
            None => self.settings.get(index),
            Some(rest) if Layout::<M>::STATES > 0 => self.solver_settings.get(rest),
            Some(_) => None,
        };
        value.filter(|value| kind_of(value) == kind).ok_or(Error::UnknownReference {
            kind,
            reference,
            model: M::ABOUT.name,
        })
    }

    /// Sets a setting.
    ///
    /// # Errors
    /// For an unknown reference, a value of another type or one that the setting cannot have, or a
    /// setting that may not be changed now.
    pub fn set_setting(&mut self, reference: u32, value: Value, access: Access) -> Result<(), Error> {
        self.setting(reference, kind_of(&value))?;
        let index = reference as usize;
        let declaration = Layout::<M>::settings()[index];
        if access == Access::Continuous || (access < Access::All && !declaration.tunable) {
            let reason = "it is a parameter that is fixed: set it before initialisation ends";
            return Err(Error::NotSettable { name: declaration.name.into(), reason });
        }
        let shown = display(&value);
        let done = match index.checked_sub(M::Settings::COUNT) {
            None => self.settings.set(index, value),
            Some(rest) => self.solver_settings.set(rest, value),
        };
        done.ok_or_else(|| Error::NotAChoice {
            name: declaration.name,
            value: shown,
            expected: expected(declaration.kind),
        })?;
        self.unprepared = true;
        self.changed();
        Ok(())
    }

    /// The continuous states.
    pub fn states(&self) -> &[f64] {
        self.state.as_slice()
    }

    /// Sets the continuous states, for an outside integrator.
    ///
    /// # Errors
    /// If a value is not finite.
    pub fn set_states(&mut self, values: &[f64]) -> Result<(), Error> {
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            let name = Layout::<M>::declarations(Section::State)[index].name.clone();
            return Err(Error::NotFinite { name, value: values[index] });
        }
        self.state.as_mut_slice().copy_from_slice(values);
        self.changed();
        Ok(())
    }

    /// The rates of the continuous states.
    ///
    /// # Errors
    /// If the model refuses its settings.
    pub fn rates(&mut self) -> Result<&[f64], Error> {
        self.evaluate()?;
        Ok(self.rates.as_slice())
    }
}

/// Refuses a variable that may not be set now, and a value that it cannot have.
fn check_settable(
    section: Section,
    declaration: &Declaration,
    value: f64,
    access: Access,
) -> Result<(), Error> {
    let reason = match section {
        Section::Input => return Err(Error::NotFinite { name: declaration.name.clone(), value }),
        Section::Output => "it is an output",
        Section::Rate => "it is the derivative of a state",
        Section::Derived => "it is calculated from parameters",
        Section::State if access.is_integrators() => {
            return Err(Error::NotFinite { name: declaration.name.clone(), value });
        }
        Section::State if access < Access::All => {
            "a state may be set until initialisation ends and, for model exchange, in Continuous-Time Mode only"
        }
        Section::Parameter | Section::Solver if access == Access::Continuous => {
            "parameters may be set before initialisation, at events and between steps only"
        }
        Section::Parameter if declaration.fixed && access < Access::All => {
            "it is a fixed parameter: set it before initialisation ends"
        }
        Section::State | Section::Parameter | Section::Solver => return check_bounds(declaration, value),
    };
    Err(Error::NotSettable { name: name_in(section, declaration), reason })
}

/// Name of a value's type in messages; an enumeration's values are integers.
fn kind_of(value: &Value) -> &'static str {
    match value {
        Value::Real(_) => "real",
        Value::Integer(_) => "integer",
        Value::Boolean(_) => "boolean",
        Value::Text(_) => "string",
    }
}
