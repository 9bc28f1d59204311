//! What the catalogue says of a term.

use strut_model::Declaration;

use super::signals::At;
use super::{Distortion, Onset, Prevalence, RESPONSE, Signal, distortion, distortions, effects, tables};
use crate::estimation::hypothesis::Term;
use crate::estimation::unknowns::Unknown;
use crate::plant::Plant;
use crate::signal::distortion::Fault;

pub use super::signals::{ACTUATORS, is_command};

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
        Term::Effect(effect) => Name {
            id: effect.id.into(),
            element: effect.element.name().into(),
            name: effect.name.into(),
            equation: effect.equation.into(),
            experiment: effect.experiment.into(),
            sensor: effect.element.is_sensor(),
        },
        Term::Table(table) => Name {
            id: table.law.id.into(),
            element: table.element.name().into(),
            name: table.name(),
            equation: table.equation(),
            experiment: table.law.experiment.into(),
            sensor: false,
        },
        Term::Fault(handle) => {
            let (fault, signal, declared) = distorted(handle, plant);
            of_signal(distortion(fault), signal, declared)
        }
        Term::Response(output) => of_signal(&RESPONSE, Signal::Output, &plant.outputs[output]),
    }
}

/// How common a term's effect is.
pub fn prevalence(term: Term, plant: &Plant) -> Prevalence {
    match term {
        Term::Effect(effect) => effect.prevalence,
        Term::Table(table) => table.law.prevalence,
        Term::Fault(handle) => {
            let (fault, signal, _) = distorted(handle, plant);
            distortion(fault).at(signal).prevalence
        }
        Term::Response(_) => RESPONSE.at(Signal::Output).prevalence,
    }
}

/// When a term's effect acts.
pub fn onset(term: Term) -> Onset {
    match term {
        Term::Effect(effect) => effect.onset,
        Term::Fault(Unknown::Input(_, fault) | Unknown::Output(_, fault)) => distortion(fault).onset,
        Term::Table(_) | Term::Response(_) | Term::Fault(Unknown::Parameter(_)) => Onset::Always,
    }
}

/// Numbers of all effects that are looked for in a plant, ascending.
pub fn numbers(plant: &Plant) -> Vec<String> {
    let inputs = plant.inputs.iter().enumerate().flat_map(|(index, declared)| {
        let faults = distortions(Signal::of_input(&declared.name), &declared.name);
        faults.map(move |fault| Unknown::Input(index, fault))
    });
    let outputs = plant.outputs.iter().enumerate().flat_map(|(index, declared)| {
        let faults = distortions(Signal::Output, &declared.name);
        faults.map(move |fault| Unknown::Output(index, fault))
    });
    let faults = inputs.chain(outputs).map(Term::Fault);
    let responses = (0..plant.outputs.len()).map(Term::Response);
    let plants = effects(plant).map(Term::Effect).chain(tables(plant).map(Term::Table));
    let terms = plants.chain(faults).chain(responses);
    let mut numbers: Vec<String> = terms.map(|term| name(term, plant).id).collect();
    numbers.sort();
    numbers.dedup();
    numbers
}

/// A distortion with its signal; a parameter is as wrong as a sensor's gain.
fn distorted(handle: Unknown, plant: &Plant) -> (Fault, Signal, &Declaration) {
    match handle {
        Unknown::Input(index, fault) => {
            let declared = &plant.inputs[index];
            (fault, Signal::of_input(&declared.name), declared)
        }
        Unknown::Output(index, fault) => (fault, Signal::Output, &plant.outputs[index]),
        Unknown::Parameter(index) => (Fault::Gain, Signal::Output, &plant.parameters[index]),
    }
}

fn of_signal(own: &'static Distortion, signal: Signal, declared: &Declaration) -> Name {
    let At { id, with, .. } = own.at(signal);
    let law = with.map_or(own, distortion);
    Name {
        id: (*id).into(),
        element: declared.name.clone(),
        name: law.called(signal),
        equation: law.equation.into(),
        experiment: law.experiment.into(),
        sensor: signal != Signal::Command,
    }
}

/// Name and unit of what a fit changes.
pub fn handle(handle: Unknown, plant: &Plant) -> (String, String) {
    match handle {
        Unknown::Parameter(index) => {
            let declared = &plant.parameters[index];
            (declared.name.clone(), declared.unit.symbol.to_owned())
        }
        Unknown::Input(index, fault) => amount(&plant.inputs[index], fault),
        Unknown::Output(index, fault) => amount(&plant.outputs[index], fault),
    }
}

/// What a fault of a signal amounts to where it arises, from the amount in a fit. A fit corrects a measured input: it takes away what its
/// sensor has done. A lag stays what the fit has, since no filter undoes one.
pub fn arisen(handle: Unknown, plant: &Plant, amount: f64) -> f64 {
    match handle {
        Unknown::Input(index, fault) if Signal::of_input(&plant.inputs[index].name) == Signal::Input => {
            match fault {
                Fault::Delay | Fault::Offset | Fault::Drift => -amount,
                Fault::Gain | Fault::Rate => 1.0 / (1.0 + amount) - 1.0,
                _ => amount,
            }
        }
        _ => amount,
    }
}

fn amount(declared: &Declaration, fault: Fault) -> (String, String) {
    (format!("{}.{}", declared.name, fault.name()), fault.unit(declared.unit.symbol))
}
