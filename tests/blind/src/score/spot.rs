//! Where a report says that its first cause sits.

use super::Report;
use crate::case::{Present, Truth};
use crate::catalogue::Place;
use crate::rig::signals;

/// Numbers of what an actuator does to its command.
const OF_ACTUATORS: [&str; 5] = ["23", "24", "25", "26", "26s"];

/// What the names of inputs begin with that act through an actuator.
const ACTUATORS: [&str; 5] = ["actuator", "voltage", "command", "motor", "brake"];

/// The cause that comes first in a report.
pub(super) struct Spot<'a> {
    /// Its number; none if it has no name.
    id: Option<&'a str>,
    /// An element or a signal.
    place: &'a str,
    /// Whether it is a signal.
    signal: bool,
}

impl<'a> Spot<'a> {
    /// None if the report has no cause.
    pub(super) fn of(report: &'a Report, truth: &Truth) -> Option<Self> {
        let named = report.effects.first().map(|it| (Some(it.id.as_str()), it.element.as_str()));
        let (id, place) = named.or(report.unnamed.as_ref().map(|it| (None, it.location.as_str())))?;
        let columns = signals(truth.case.plant, truth.case.sensors);
        let signal = place.contains('.') || columns.iter().any(|column| column.0 == place);
        Some(Self { id, place, signal })
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
            Place::Sensor => place == effect.signal,
        }
    }

    /// As the confusion matrix shows it.
    pub(super) fn label(&self) -> String {
        match self.id {
            Some(id) if self.signal => format!("{id} {}", self.place),
            Some(id) => id.into(),
            None => format!("unnamed {}", self.place),
        }
    }
}
