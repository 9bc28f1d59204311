//! Models of other makers: an FMU (FMI 2.0, model exchange) as a predictor, alone or with elements of the library
//! beside it.
//!
//! The FMU is run in this process. Who fears that it crashes has to be another process.

mod beside;
mod crossing;
mod differences;
mod exchange;
mod face;
mod lanes;
mod role;
mod units;
mod walk;

use std::path::PathBuf;
use std::sync::Arc;

use crate::{Dynamics, Plant};

use beside::Beside;
use differences::Differences;
use exchange::Fmu;

pub use beside::{Attachment, Own, Replaced, needs_own};
pub use face::{Face, FaceVariable};
pub use role::Role;
pub use units::Conversion;

/// What a predictor is made of.
#[derive(Clone, Debug)]
pub struct Foreign {
    /// The FMU.
    pub fmu: PathBuf,
    /// Its parameters that the diagnosis may change.
    pub parameters: Vec<String>,
    /// Its local variables that count as outputs. What it does not have is left out.
    pub locals: Vec<String>,
    /// Elements of the library that act beside the model, one of each role at most.
    pub beside: Vec<Attachment>,
}

impl Foreign {
    /// The FMU as a plant: its real inputs, outputs and states, and the parameters that were named, in base units of the
    /// SI; those of the elements beside it come after the FMU's own.
    ///
    /// # Errors
    /// If the FMU cannot be read or run here, or lacks what was named: all of it in one text, with what to do.
    pub fn plant(&self) -> Result<Plant, String> {
        let replaced = self.beside.iter().find_map(|it| it.replaces.as_ref());
        let taken: Vec<&str> =
            replaced.iter().flat_map(|it| [it.stiffness.as_str(), it.damping.as_str()]).collect();
        let fmu = Fmu::load(self, &taken)?;
        let beside = Beside::new(&fmu, &self.beside)?;
        let (mut parameters, mut states) = (fmu.parameters.clone(), fmu.states.clone());
        parameters.extend(beside.parameters.iter().cloned());
        states.extend(beside.states.iter().cloned());
        let (name, inputs, outputs) = (fmu.name.clone(), fmu.inputs.clone(), fmu.outputs.clone());
        let equations = Differences::new(fmu, beside, &parameters, &states);
        equations.refuse_loops()?;
        let prepare =
            Arc::new(move |_: &[strut_model::Value]| Ok(Box::new(equations.clone()) as Box<dyn Dynamics>));
        Ok(Plant {
            name,
            inputs,
            outputs,
            parameters,
            states,
            settings: Vec::new(),
            choices: Vec::new(),
            instances: Vec::new(),
            joints: Arc::new([]),
            prepare,
        })
    }

    /// The states that the FMU on its own has after its initialisation with start values of parameters and of other
    /// variables, in base units; none if it does not take them.
    ///
    /// # Errors
    /// If the FMU cannot be read or run here.
    pub fn started(&self, values: &[(String, f64)]) -> Result<Option<Vec<f64>>, String> {
        let face = Face::read(&self.fmu)?;
        let own = |(name, value): &(String, f64)| {
            let conversion = face.variable(name).map_or(Conversion::NONE, |it| it.conversion);
            (name.clone(), conversion.own(*value))
        };
        let values: Vec<(String, f64)> = values.iter().map(own).collect();
        Ok(Fmu::load(&Self { beside: Vec::new(), ..self.clone() }, &[])?.started(&values))
    }
}
