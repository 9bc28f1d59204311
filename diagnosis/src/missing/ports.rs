//! Places where a signal may be missing: the additive constants that a model declares, its commands, and the offset of
//! every sensor.

use strut_model::Declaration;

use crate::catalogue::Element;
use crate::catalogue::naming::is_command;
use crate::dataset::recorded::{Dataset, Source};
use crate::plant::Seed;
use crate::rig::Rig;

/// Where a signal may be missing.
#[derive(Clone, Debug, PartialEq)]
pub struct Port {
    /// As people call it: `strut`, `guide`, or the name of a signal.
    pub place: String,
    /// Unit of the missing signal.
    pub unit: &'static str,
    /// The element of the model there; none for a sensor.
    pub element: Option<Element>,
    /// What adds the signal.
    pub entry: Entry,
}

/// The element that a variable is of, by its name.
fn element_of(rig: &Rig, variable: &str) -> Option<Element> {
    let all = rig.kind.elements.iter().map(|it| it.element);
    let mut own = all.filter(|it| variable.strip_prefix(it.name()).is_some_and(|rest| rest.starts_with('.')));
    own.next()
}

/// Whether an input is a prescribed motion: its errors are a sensor's.
fn is_motion(rig: &Rig, input: &Declaration) -> bool {
    let rates = &rig.kind.rates;
    let base = input.unit.base;
    matches!((base.m, base.rad, base.kg), (1, 0, 0) | (0, 1, 0))
        || rates.contains_key(&input.name)
        || rates.values().any(|it| *it == input.name)
}

/// What adds a port's signal to the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Entry {
    /// A parameter that is an additive constant, by its index.
    Constant(usize),
    /// An input, by its index.
    Input(usize),
    /// A measured output's offset, by its row among a record's measured outputs.
    Sensor(usize),
}

impl Port {
    /// Every place in a rig with these records.
    pub fn all(rig: &Rig, record: &Dataset) -> Vec<Self> {
        let mut ports = Self::of_model(rig, |input| matches!(record.inputs[input], Source::Measured(_)));
        for (row, measured) in record.measured.iter().enumerate() {
            let declared = &rig.plant.outputs[measured.output];
            ports.push(Self {
                place: declared.name.clone(),
                unit: declared.unit.symbol,
                element: None,
                entry: Entry::Sensor(row),
            });
        }
        ports
    }

    /// The places that are no sensors: additive constants, and the commands among the inputs that were measured, by their
    /// indices. A model without elements has all its measured inputs but prescribed motions.
    pub fn of_model(rig: &Rig, is_measured: impl Fn(usize) -> bool) -> Vec<Self> {
        let plant = &rig.plant;
        let mut ports: Vec<Self> = Vec::new();
        for (index, declared) in plant.parameters.iter().enumerate().filter(|(_, it)| it.port) {
            let group = declared.name.split_once('.').map(|(group, _)| group);
            // A drive has one element, and its constant stands beside it.
            let alone = || rig.kind.elements.first().filter(|_| group.is_none()).map(|it| it.element);
            let element = element_of(rig, &declared.name).or_else(alone);
            let place = element.map_or(group.unwrap_or(&declared.name), |it| it.name());
            ports.push(Self {
                place: place.to_owned(),
                unit: declared.unit.symbol,
                element,
                entry: Entry::Constant(index),
            });
        }
        for (index, declared) in plant.inputs.iter().enumerate() {
            let acts =
                is_command(&declared.name) || rig.kind.elements.is_empty() && !is_motion(rig, declared);
            if is_measured(index) && acts {
                let only = || rig.kind.elements.iter().find(|it| it.element == Element::ACTUATOR);
                let element = element_of(rig, &declared.name).or_else(|| only().map(|it| it.element));
                ports.push(Self {
                    place: declared.name.clone(),
                    unit: declared.unit.symbol,
                    element,
                    entry: Entry::Input(index),
                });
            }
        }
        ports
    }

    /// Whether it is a sensor that adds the signal, and not the plant.
    pub fn is_sensor(&self) -> bool {
        matches!(self.entry, Entry::Sensor(_))
    }

    /// What the model's derivative is taken with respect to; none for a sensor.
    pub fn seed(&self, samples: usize) -> Option<Seed> {
        match self.entry {
            Entry::Constant(index) => Some(Seed::Parameter(index)),
            Entry::Input(index) => Some(Seed::Inputs(vec![(index, vec![1.0; samples])])),
            Entry::Sensor(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_port_is_at_the_element_whose_name_its_constant_has() {
        let rig = Rig::published("full-car").unwrap();
        let ports = Port::of_model(&rig, |_| true);
        let (constants, commands) = ports.split_at(8);
        for (port, element) in constants.iter().zip(rig.kind.elements.iter().map(|it| it.element)) {
            assert_eq!((port.place.as_str(), port.element), (element.name(), Some(element)));
        }
        let of_command = |place: &str| commands.iter().find(|it| it.place == place).unwrap().element;
        let rear_left = Element::ACTUATOR.at("rear_left");
        assert_eq!((commands.len(), of_command("actuator.rear_left.force")), (4, Some(rear_left)));
        let quarter = Rig::published("quarter-car").unwrap();
        let force = Port::of_model(&quarter, |_| true).pop().unwrap();
        assert_eq!((force.place.as_str(), force.element), ("actuator.force", Some(Element::ACTUATOR)));
    }
    #[test]
    fn a_model_without_elements_has_places_at_its_inputs_but_not_at_motions() {
        let mut rig = Rig::published("quarter-car").unwrap();
        let inputs = |rig: &Rig| -> Vec<String> {
            let all = Port::of_model(rig, |_| true).into_iter();
            all.filter(|it| matches!(it.entry, Entry::Input(_))).map(|it| it.place).collect()
        };
        assert_eq!(inputs(&rig), ["actuator.force"]);
        let mut kind = (*rig.kind).clone();
        kind.elements.clear();
        rig.kind = kind.into();
        rig.plant.inputs.push(Declaration { unit: strut_model::unit::N, ..Declaration::named("push") });
        rig.plant.inputs.push(Declaration { unit: strut_model::unit::M, ..Declaration::named("lift") });
        rig.plant.inputs.push(Declaration::named("rate"));
        assert_eq!(inputs(&rig), ["actuator.force", "push", "rate"]);
        let mut kind = (*rig.kind).clone();
        kind.rates.insert("rate".into(), "lift".into());
        rig.kind = kind.into();
        assert_eq!(inputs(&rig), ["actuator.force", "push"]);
    }
}
