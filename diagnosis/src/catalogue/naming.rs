//! What terms are called, by the catalogue's numbers.

use crate::catalogue::{causes, tables};
use crate::estimation::fit::Handle;
use crate::estimation::hypothesis::Term;
use crate::plant::Plant;
use crate::signal::distortion::Fault;

/// A term in words.
#[derive(Clone, Debug, PartialEq)]
pub struct Name {
    /// Number in the catalogue.
    pub id: String,
    /// Where it acts.
    pub element: String,
    /// What it is called.
    pub name: String,
    /// Its law.
    pub equation: String,
    /// What separates it from others.
    pub experiment: String,
    /// Whether it is a measurement that is wrong rather than the plant.
    pub sensor: bool,
}

impl Name {
    /// Number and place, as rivals are listed.
    pub fn short(&self) -> String {
        format!("{} {}", self.id, self.element)
    }
}

/// What a term is called.
pub fn name(term: Term, plant: &Plant) -> Name {
    match term {
        Term::Cause(cause) => Name {
            id: cause.id.into(),
            element: cause.element.name().into(),
            name: cause.name.into(),
            equation: cause.equation.into(),
            experiment: cause.experiment.into(),
            sensor: cause.element.is_sensor(),
        },
        Term::Table(table) => Name {
            id: table.id.into(),
            element: table.element.name().into(),
            name: format!("unnamed {} over {}", table.quantity().0, table.variable),
            equation: format!("a table over {}", table.variable),
            experiment: "sweep the variable slowly through the covered range and beyond".into(),
            sensor: false,
        },
        Term::Fault(handle) => of_fault(handle, plant),
        Term::Response(output) => Name {
            id: "G5".into(),
            element: plant.outputs[output].name.clone(),
            name: "unnamed response of the sensor".into(),
            equation: "a table of the step response over time".into(),
            experiment: "sweep the sensor beside one whose response is known".into(),
            sensor: true,
        },
    }
}

/// Numbers of all that may be the matter with a plant, ascending.
pub fn numbers(plant: &Plant) -> Vec<String> {
    let inputs = (0..plant.inputs.len()).flat_map(|it| Fault::NAMED.map(|fault| Handle::Input(it, fault)));
    let outputs = (0..plant.outputs.len()).flat_map(|it| Fault::NAMED.map(|fault| Handle::Output(it, fault)));
    let faults = inputs.chain(outputs).map(Term::Fault);
    let responses = (0..plant.outputs.len()).map(Term::Response);
    let plants = causes(plant).map(Term::Cause).chain(tables(plant).map(Term::Table));
    let terms = plants.chain(faults).chain(responses);
    let mut numbers: Vec<String> = terms.map(|term| name(term, plant).id).collect();
    numbers.sort();
    numbers.dedup();
    numbers
}

/// What the names of inputs begin with that act through an actuator, and not through a sensor alone.
const ACTUATORS: &[&str] = &["actuator", "brake", "command", "motor", "voltage"];

/// Whether an input, by its name, is what an actuator is told.
pub fn is_command(input: &str) -> bool {
    ACTUATORS.iter().any(|prefix| input.starts_with(prefix))
}

fn of_fault(handle: Handle, plant: &Plant) -> Name {
    let (signal, fault, input) = match handle {
        Handle::Input(index, fault) => (plant.inputs[index].name.clone(), fault, true),
        Handle::Output(index, fault) => (plant.outputs[index].name.clone(), fault, false),
        Handle::Parameter(index) => (plant.parameters[index].name.clone(), Fault::Gain, false),
    };
    let actuator = input && is_command(&signal);
    let id = match (fault, input, actuator) {
        (Fault::Gain, true, true) => "25",
        (Fault::Limit, _, _) => "26",
        (Fault::Delay, true, true) => "23",
        (Fault::Lag, true, true) => "24",
        (Fault::Offset | Fault::Drift, true, true) => "41",
        (Fault::Offset | Fault::Drift, _, _) => "33",
        (_, true, false) if fault != Fault::Rate => "42",
        (Fault::Gain, _, _) => "34",
        (Fault::Lag, _, _) => "35",
        (Fault::Delay, _, _) => "36",
        (Fault::Quadratic | Fault::Cubic, _, _) => "39",
        (Fault::Rate, _, _) => "40",
        (Fault::Response(_), _, _) => "G5",
    };
    let (what, equation, experiment) = match fault {
        Fault::Gain => ("gain", "(1 + gain) y", "weigh the masses, or turn the sensor over"),
        Fault::Offset | Fault::Drift if input => ("offset", "y + offset", "record a standstill"),
        Fault::Offset | Fault::Drift => {
            ("offset", "y + offset + drift t", "record a standstill of the same length")
        }
        Fault::Lag => ("lag", "lag y' + y = y_true", "sweep to high frequencies"),
        Fault::Delay => ("delay", "y(t - delay)", "strike once and compare the signals' onsets"),
        Fault::Quadratic => ("curvature", "y + quadratic y^2", "calibrate with gauge blocks"),
        Fault::Cubic => ("curvature", "y + cubic y^3", "calibrate with gauge blocks"),
        Fault::Response(_) => ("response", "a step response", "sweep to high frequencies"),
        Fault::Limit => ("limit", "clamp(y, -limit, limit)", "repeat the run with half the command"),
        Fault::Rate => ("sampling rate", "y((1 + rate) t)", "compare the clocks, or record for longer"),
    };
    Name {
        id: id.into(),
        name: format!("{what} of the {}", if actuator { "actuator" } else { "sensor" }),
        element: signal,
        equation: equation.into(),
        experiment: experiment.into(),
        sensor: !actuator,
    }
}

/// Name and unit of what a fit changes.
pub fn handle(handle: Handle, plant: &Plant) -> (String, String) {
    match handle {
        Handle::Parameter(index) => {
            let declared = &plant.parameters[index];
            (declared.name.clone(), declared.unit.symbol.to_owned())
        }
        Handle::Input(index, fault) => of_signal(&plant.inputs[index], fault),
        Handle::Output(index, fault) => of_signal(&plant.outputs[index], fault),
    }
}

fn of_signal(declared: &strut_model::Declaration, fault: Fault) -> (String, String) {
    (format!("{}.{}", declared.name, fault.name()), fault.unit(declared.unit.symbol))
}
