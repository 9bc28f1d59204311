//! What an FMU starts with.

use std::collections::BTreeMap;

use strut_check::import::Description;

use super::{Fmu, fine};

/// Share of its start value that a positive parameter without a lower bound has at least.
pub const LEAST: f64 = 1e-6;

impl Fmu {
    /// Start values of parameters and states, as the FMU itself has them.
    pub(super) fn read_starts(&mut self) -> Result<(), String> {
        let refused = "it does not start: see what it says with `build-fmu check`";
        let instance = self.instantiate().ok_or(refused)?;
        let mut values = vec![0.0; self.of_parameters.references.len()];
        let is_fine = self.begin(instance, self.start) && {
            let known = self.library.reals(instance, &self.of_parameters.references, &mut values);
            fine(known) && self.finish(instance).is_some()
        };
        let mut states = vec![0.0; self.states.len()];
        let is_fine = is_fine
            && (states.is_empty()
                || fine(self.library.array("fmi2GetContinuousStates", instance, &mut states)));
        self.release(instance);
        if !is_fine {
            return Err(refused.into());
        }
        let parameters = self.parameters.iter_mut().zip(&self.of_parameters.conversions);
        for ((declared, conversion), value) in parameters.zip(values) {
            declared.start = conversion.si(value);
            // A mass that would be zero ends some FMUs' process; few have bounds for it.
            if declared.min.is_none() && declared.start > 0.0 {
                declared.min = Some(LEAST * declared.start);
            }
        }
        for ((declared, conversion), value) in self.states.iter_mut().zip(&self.of_states).zip(states) {
            declared.start = conversion.si(value);
        }
        Ok(())
    }

    /// The states after an initialisation with these values, as the FMU has them, in base units; none if it refuses one.
    pub fn started(&self, values: &[(String, f64)]) -> Option<Vec<f64>> {
        let references: Option<Vec<u32>> =
            values.iter().map(|(name, _)| self.reals.get(name).copied()).collect();
        let (references, values) =
            (references?, values.iter().map(|(_, value)| *value).collect::<Vec<f64>>());
        let instance = self.instantiate()?;
        let mut states = vec![0.0; self.states.len()];
        let is_fine = (references.is_empty() || fine(self.library.set_reals(instance, &references, &values)))
            && self.begin(instance, self.start)
            && self.finish(instance).is_some()
            && (states.is_empty()
                || fine(self.library.array("fmi2GetContinuousStates", instance, &mut states)));
        self.release(instance);
        let si = states.iter().zip(&self.of_states).map(|(value, conversion)| conversion.si(*value));
        is_fine.then(|| si.collect())
    }
}

/// All real variables by name.
pub(super) fn references(description: &Description) -> BTreeMap<String, u32> {
    let reals = description.variables.iter().filter(|it| it.kind == "Real");
    reals.filter_map(|it| Some((it.name.clone(), it.reference?))).collect()
}
