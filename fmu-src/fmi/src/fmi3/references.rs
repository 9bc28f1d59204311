//! From the value references of FMI 3.0, which count all types in one and take an array for one variable, to those of the
//! model.

use strut_model::Model;

use super::types::ValueReference;
use crate::interface::{instance::Instance, log::Failure};

/// What a reference of type Float64 stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Number {
    /// Real variables, the first and how many.
    Reals(u32, usize),
    /// An event indicator.
    Indicator(usize),
    /// Time.
    Time,
}

impl<M: Model> Instance<M> {
    /// Whether each of the references is one of the single real variables before the first array, and has one value. That
    /// is so in nearly every call: inputs, outputs and states come first.
    #[inline]
    pub fn are_singles(&self, references: &[ValueReference], values: usize) -> bool {
        let singles = self.origin.numbering.singles;
        references.len() == values && references.iter().all(|reference| *reference < singles)
    }

    /// What a reference stands for.
    pub fn number(&self, reference: ValueReference) -> Result<Number, Failure> {
        let numbering = &self.origin.numbering;
        match numbering.lengths.get(reference as usize) {
            Some(length) if *length > 0 => Ok(Number::Reals(reference, *length)),
            None if reference == numbering.time => Ok(Number::Time),
            None if (numbering.indicators..numbering.time).contains(&reference) => {
                Ok(Number::Indicator((reference - numbering.indicators) as usize))
            }
            _ => Err(unknown::<M>(reference, "Float64")),
        }
    }

    /// The real variables of references that are no others, arrays element by element.
    pub fn reals(&self, references: &[ValueReference], values: usize) -> Result<Vec<u32>, Failure> {
        let mut reals = Vec::with_capacity(values);
        for reference in references {
            match self.number(*reference)? {
                Number::Reals(first, length) => reals.extend((first..).take(length)),
                Number::Indicator(_) => {
                    return Err(Failure::error(format!(
                        "value reference {reference} is an event indicator, which cannot be set or derived"
                    )));
                }
                Number::Time => {
                    return Err(Failure::error(format!(
                        "value reference {reference} is time, which cannot be set as a variable or be an unknown"
                    )));
                }
            }
        }
        check_count(values, reals.len())?;
        Ok(reals)
    }

    /// The setting of a reference; `choice` says whether it has to be an enumeration, where that matters.
    pub fn setting_of(
        &self,
        reference: ValueReference,
        kind: &str,
        choice: Option<bool>,
    ) -> Result<u32, Failure> {
        let numbering = &self.origin.numbering;
        let setting = reference.checked_sub(numbering.settings).filter(|_| reference < numbering.indicators);
        setting
            .filter(|setting| {
                let is_choice = self.origin.choices.get(*setting as usize).copied();
                choice.is_none() || is_choice == choice
            })
            .ok_or_else(|| unknown::<M>(reference, kind))
    }
}

/// Refuses a number of values that is not that of the variables.
pub fn check_count(given: usize, right: usize) -> Result<(), Failure> {
    if given == right {
        return Ok(());
    }
    Err(Failure::error(format!(
        "{given} values for variables that have {right} together: an array has as many as its dimension says"
    )))
}

/// Says that there is no such variable.
#[cold]
pub fn unknown<M: Model>(reference: ValueReference, kind: &str) -> Failure {
    Failure::error(format!(
        "value reference {reference} is no {kind} variable of {}; see modelDescription.xml for the references",
        M::ABOUT.name
    ))
}
