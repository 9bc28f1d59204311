//! Where a report says that its first cause sits.

use super::Report;
use crate::case::{Plant, Present, Sensors, Truth};
use crate::catalogue::Place;
use crate::rig::signals;

/// Numbers of what an actuator does to its command.
const OF_ACTUATORS: [&str; 5] = ["23", "24", "25", "26", "26s"];

/// What the names of inputs begin with that act through an actuator.
pub(super) const ACTUATORS: [&str; 5] = ["actuator", "voltage", "command", "motor", "brake"];

/// The cause that comes first in a report.
pub(super) struct Spot<'a> {
    /// Its number; none if it has no name.
    id: Option<&'a str>,
    /// An element or a signal.
    place: &'a str,
    /// Whether it is a signal.
    signal: bool,
    /// The case's rig, and whether the tyre's force is measured there.
    rig: (Plant, bool),
}

impl<'a> Spot<'a> {
    /// None if the report has no cause.
    pub(super) fn of(report: &'a Report, truth: &Truth) -> Option<Self> {
        let named = report.effects.first().map(|it| (Some(it.id.as_str()), it.element.as_str()));
        let (id, place) = named.or(report.unmodelled.first().map(|it| (None, it.place.as_str())))?;
        Some(Self::at(id, place, truth))
    }

    /// The largest cause of a report that no effect of the catalogue accounts for.
    pub(super) fn unmodelled(report: &'a Report, truth: &Truth) -> Option<Self> {
        report.unmodelled.first().map(|it| Self::at(None, &it.place, truth))
    }

    fn at(id: Option<&'a str>, place: &'a str, truth: &Truth) -> Self {
        let columns = signals(truth.case.plant, truth.case.sensors);
        let signal = place.contains('.') || columns.iter().any(|column| column.0 == place);
        let rig = (truth.case.plant, truth.case.sensors == Sensors::Full);
        Self { id, place, signal, rig }
    }

    /// Whether it sits between a command and what it makes: such a cause is told by the command's signal, but it
    /// is the plant's.
    fn is_actuator(&self) -> bool {
        let commanded = ACTUATORS.iter().any(|prefix| self.place.starts_with(prefix));
        commanded && (!self.signal || self.id.is_none_or(|id| OF_ACTUATORS.contains(&id)))
    }

    /// Whether it sits in a sensor.
    pub(super) fn is_sensor(&self) -> bool {
        self.signal && !self.is_actuator()
    }

    /// Whether it is where the effect is.
    pub(super) fn is_of(&self, effect: &Present) -> bool {
        let place = self.place;
        match effect.place {
            Place::Strut => place.starts_with("strut"),
            Place::Guide => place.starts_with("guide") || place == "body_guide",
            Place::WheelGuide => place.starts_with("wheel_guide"),
            Place::Tire => place.starts_with("tire"),
            Place::Frame => place.starts_with("frame"),
            Place::Actuator => self.is_actuator(),
            Place::Pump => place.starts_with("pump"),
            Place::Pivot => place.starts_with("pivot"),
            Place::Cylinder => place.starts_with("cylinder") || place.starts_with("valve"),
            Place::Sensor => place == effect.signal,
        }
    }

    /// Whether no record can tell this place from the effect's. For causes in no catalogue.
    pub(super) fn is_like(&self, effect: &Present) -> bool {
        let place = self.place;
        let begins = |names: &[&str]| names.iter().any(|name| place.starts_with(name));
        let (plant, force_cell) = self.rig;
        match effect.place {
            // A force between body and wheel.
            Place::Strut | Place::Actuator if plant.is_car() => begins(&["strut", "actuator", "voltage"]),
            // A force on the body alone.
            Place::Guide if plant.is_car() => {
                let through = effect.depends_on.iter().any(|word| word == "command") && self.is_actuator();
                begins(&["guide", "frame", "body_guide"]) || place == "body" || through
            }
            // A force on the only mass.
            Place::Guide => {
                begins(&["guide", "ground_spring", "actuator", "motor", "frame"]) || place == "force"
            }
            // A force on the wheel: what the road does to the tyre, and without a cell what the wheel's guide does.
            Place::Tire => begins(&["tire", "road"]) || !force_cell && begins(&["wheel_guide"]),
            Place::WheelGuide => begins(&["wheel_guide"]) || !force_cell && begins(&["tire", "road"]),
            _ => self.is_of(effect),
        }
    }

    /// As the confusion matrix shows it.
    pub(super) fn label(&self) -> String {
        match self.id {
            Some(id) if self.signal => format!("{id} {}", self.place),
            Some(id) => id.into(),
            None => format!("unmodelled {}", self.place),
        }
    }
}
