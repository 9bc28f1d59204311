//! The elements of a rig, on which effects act.

use std::sync::{Mutex, PoisonError};

use serde::de::value::{Error as Unknown, StrDeserializer};
use serde::de::{Error, IntoDeserializer};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Kinds of elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ElementKind {
    /// Between body and wheel.
    Strut,
    /// Between body and ground.
    Guide,
    /// Between wheel and ground.
    WheelGuide,
    /// Between wheel and road.
    Tire,
    /// Between two arms that turn about it: forces are moments in N.m, deflections angles in rad.
    Pivot,
    /// From a command to the force; it deflects and moves as the strut does.
    Actuator,
    /// The valve of a hydraulic or pneumatic actuator: it deflects as its spool does.
    Valve,
    /// The pump of a hydraulic actuator, with its motor: torques in N.m for forces, speeds in rad/s.
    Pump,
    /// What carries the guides, and swings with the body.
    Frame,
    /// The cell that measures the wheel's force.
    ForceCell,
}

/// Where an effect acts; its parameters are measured in that element's own forces and motions. Where a rig has several of a
/// kind, each has a place: `strut.front_left`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Element {
    kind: ElementKind,
    name: &'static str,
}

/// Elements with a place, of all rigs that were read: they are few, and each is made once for the whole program.
static PLACED: Mutex<Vec<Element>> = Mutex::new(Vec::new());

impl Element {
    /// The strut.
    pub const STRUT: Self = Self::of(ElementKind::Strut);
    /// The body's guide.
    pub const GUIDE: Self = Self::of(ElementKind::Guide);
    /// The wheel's guide.
    pub const WHEEL_GUIDE: Self = Self::of(ElementKind::WheelGuide);
    /// The tyre.
    pub const TIRE: Self = Self::of(ElementKind::Tire);
    /// The pivot.
    pub const PIVOT: Self = Self::of(ElementKind::Pivot);
    /// The actuator.
    pub const ACTUATOR: Self = Self::of(ElementKind::Actuator);
    /// The valve.
    pub const VALVE: Self = Self::of(ElementKind::Valve);
    /// The pump.
    pub const PUMP: Self = Self::of(ElementKind::Pump);
    /// The frame.
    pub const FRAME: Self = Self::of(ElementKind::Frame);
    /// The cell that measures the wheel's force.
    pub const FORCE_CELL: Self = Self::of(ElementKind::ForceCell);

    /// One of each kind, the only one of its rig.
    pub const ALL: [Self; 10] = [
        Self::STRUT,
        Self::GUIDE,
        Self::WHEEL_GUIDE,
        Self::TIRE,
        Self::PIVOT,
        Self::ACTUATOR,
        Self::VALVE,
        Self::PUMP,
        Self::FRAME,
        Self::FORCE_CELL,
    ];

    const fn of(kind: ElementKind) -> Self {
        Self { kind, name: kind.name() }
    }

    /// The one at a place, of several of its kind.
    pub fn at(self, place: &str) -> Self {
        let name = format!("{}.{place}", self.kind.name());
        if let Some(known) = Self::named(&name) {
            return known;
        }
        let element = Self { name: Box::leak(name.into_boxed_str()), ..self };
        PLACED.lock().unwrap_or_else(PoisonError::into_inner).push(element);
        element
    }

    /// The element of a name, if some rig has it: `tire.front_left` may be one, `tire.deflection` is a signal.
    pub fn named(name: &str) -> Option<Self> {
        let placed = PLACED.lock().unwrap_or_else(PoisonError::into_inner);
        Self::ALL.iter().chain(placed.iter()).find(|it| it.name == name).copied()
    }

    /// The same, as the only one of its rig.
    pub fn only(self) -> Self {
        Self::of(self.kind)
    }

    /// Its kind.
    pub fn kind(self) -> ElementKind {
        self.kind
    }

    /// As in parameters' names, with its place.
    pub fn name(self) -> &'static str {
        self.name
    }

    /// Its place among several of its kind.
    pub fn place(self) -> Option<&'static str> {
        self.name.strip_prefix(self.kind.name())?.strip_prefix('.')
    }

    /// Whether it measures, so that the plant is not at fault.
    pub fn is_sensor(self) -> bool {
        self.kind == ElementKind::ForceCell
    }
}

impl ElementKind {
    const fn name(self) -> &'static str {
        match self {
            Self::Strut => "strut",
            Self::Guide => "guide",
            Self::WheelGuide => "wheel_guide",
            Self::Tire => "tire",
            Self::Pivot => "pivot",
            Self::Actuator => "actuator",
            Self::Valve => "valve",
            Self::Pump => "pump",
            Self::Frame => "frame",
            Self::ForceCell => "wheel.force",
        }
    }
}

/// As in rig files: `strut`, or `strut.front_left`.
impl<'de> Deserialize<'de> for Element {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        let (kind, place) = match text.split_once('.') {
            Some((kind, place)) => (kind, Some(place)),
            None => (text.as_str(), None),
        };
        let kind: StrDeserializer<'_, Unknown> = kind.into_deserializer();
        let only = Self::of(ElementKind::deserialize(kind).map_err(Error::custom)?);
        Ok(place.map_or(only, |place| only.at(place)))
    }
}

impl Serialize for Element {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let kind = if self.kind == ElementKind::ForceCell { "force_cell" } else { self.kind.name() };
        match self.place() {
            Some(place) => format!("{kind}.{place}").serialize(serializer),
            None => kind.serialize(serializer),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, PartialEq, Deserialize, Serialize)]
    struct File {
        element: Element,
    }

    #[test]
    fn an_element_is_read_as_it_is_written() {
        for element in
            Element::ALL.into_iter().chain([Element::STRUT.at("front_left"), Element::FORCE_CELL.at("rear")])
        {
            let file = File { element };
            assert_eq!(toml::from_str::<File>(&toml::to_string(&file).unwrap()).unwrap(), file);
        }
        let error = toml::from_str::<File>("element = \"spring.left\"").unwrap_err().to_string();
        assert!(error.contains("unknown variant `spring`, expected one of `strut`, `guide`"), "{error}");
    }

    #[test]
    fn places_tell_elements_of_a_kind_from_one_another() {
        let (left, right) = (Element::STRUT.at("left"), Element::STRUT.at("right"));
        assert_eq!(
            (left.name(), left.place(), left.kind()),
            ("strut.left", Some("left"), ElementKind::Strut)
        );
        assert!(left != right && left != Element::STRUT && left == Element::STRUT.at("left"));
        assert_eq!((Element::STRUT.place(), Element::FORCE_CELL.place()), (None, None));
    }
}
