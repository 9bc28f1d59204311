//! Whether a model's declarations fit together: what the compiler cannot see.

use strut_model::{Causality, Interface, VariableKind};

use crate::failure::{Failure, Result, similar};

/// Start values lie within their bounds, the default experiment drives inputs, and its plot shows variables that exist.
///
/// # Errors
/// The first contradiction.
pub fn check(interface: &Interface) -> Result<()> {
    let model = interface.about.name;
    for variable in &interface.variables {
        let VariableKind::Real { start: Some(start), min, max, unit, .. } = &variable.kind else { continue };
        let outside = min.is_some_and(|min| *start < min) || max.is_some_and(|max| *start > max);
        if outside || !start.is_finite() {
            let bounds = match (min, max) {
                (Some(min), Some(max)) => format!("{min} to {max}"),
                (Some(min), None) => format!("at least {min}"),
                (None, Some(max)) => format!("at most {max}"),
                (None, None) => "finite numbers".into(),
            };
            let (name, unit) = (&variable.name, &unit.symbol);
            return Err(Failure::new(format!(
                "{model}: the start value {start} {unit} of `{name}` is out of its bounds, {bounds}"
            ))
            .help("change `start`, `min` or `max` of its `#[var(…)]`"));
        }
    }
    let experiment = interface.about.experiment;
    let names = |causality: Option<Causality>| {
        let of =
            move |it: &&strut_model::Variable| causality.is_none_or(|causality| it.causality == causality);
        interface.variables.iter().filter(of).map(|it| it.name.as_str())
    };
    let known = |name: &str, causality: Option<Causality>, what: String| {
        if names(causality).any(|it| it == name) {
            return Ok(());
        }
        let failure = Failure::new(format!("{model}: {what}"));
        Err(match similar(name, names(causality)) {
            Some(help) => failure.help(help),
            None => failure.help("change `experiment` of its `ABOUT`"),
        })
    };
    for (name, _) in experiment.stimuli {
        let what = format!("the default experiment drives `{name}`, which is no input");
        known(name, Some(Causality::Input), what)?;
    }
    for name in experiment.plot {
        known(name, None, format!("the default experiment plots `{name}`, which is no variable"))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use strut_model::Stimulus;

    use super::*;

    fn road_rig() -> Interface {
        let entry = strut_physics::CATALOGUE.iter().find(|entry| entry.about.name == "QuarterCar").unwrap();
        entry.interface(None, None).unwrap()
    }

    #[test]
    fn a_start_out_of_its_bounds_is_refused() {
        let mut interface = road_rig();
        let mass = interface.variables.iter_mut().find(|it| it.name == "sprung_mass").unwrap();
        let VariableKind::Real { start, .. } = &mut mass.kind else { panic!() };
        *start = Some(-3.0);
        let error = check(&interface).unwrap_err().to_string();
        assert!(error.contains("QuarterCar: the start value -3 kg of `sprung_mass`"), "{error}");
    }

    #[test]
    fn a_stimulus_without_an_input_and_a_plot_without_a_variable_are_refused() {
        let mut interface = road_rig();
        interface.about.experiment.stimuli = &[("road.positon", Stimulus::Step { at: 0.0, height: 1.0 })];
        let error = check(&interface).unwrap_err().to_string();
        assert!(error.contains("drives `road.positon`") && error.contains("`road.position`"), "{error}");
        interface.about.experiment.stimuli = &[];
        interface.about.experiment.plot = &["body.accelaration"];
        let error = check(&interface).unwrap_err().to_string();
        assert!(error.contains("plots `body.accelaration`"), "{error}");
    }
}
