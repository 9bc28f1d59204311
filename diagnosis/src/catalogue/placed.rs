//! Effects at elements of which a rig has several: those of the catalogue, with the parameters of each.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use super::{Effect, Element, Part, Table, all, effects, tables};
use crate::plant::{self, Instance, Plant};

/// The catalogue's entries at one element.
#[derive(Clone, Copy)]
pub(super) struct Placed {
    pub effects: &'static [Effect],
    pub tables: &'static [Table],
}

/// The catalogue's entries at each element of which a plant has several.
pub(super) fn placed(plant: &Plant) -> impl Iterator<Item = Placed> {
    plant.instances.iter().filter_map(|it| Some(Placed::at(element(it)?)))
}

/// Elements that stand for several of a plant at once, with those.
pub fn joints(plant: &Plant) -> impl Iterator<Item = (Element, Vec<Element>)> {
    let joint = plant.instances.iter().filter(|it| it.is_joint());
    joint.filter_map(|it| {
        let own = element(it)?;
        Some((own, it.of.iter().map(|place| own.at(place)).collect()))
    })
}

/// Whether an element stands for several.
pub fn is_joint(plant: &Plant, element: Element) -> bool {
    joints(plant).any(|(joint, _)| joint == element)
}

/// The same law at several elements at once, of which an effect's is one.
pub fn joints_of(plant: &Plant, effect: &Effect) -> Vec<&'static Effect> {
    let several = joints(plant).filter(|(_, of)| of.contains(&effect.element));
    let several: Vec<Element> = several.map(|(joint, _)| joint).collect();
    effects(plant).filter(|it| it.id == effect.id && several.contains(&it.element)).collect()
}

/// An effect as it would be in a plant: at the first place, if the plant has several of its element.
pub fn first_of(plant: &Plant, effect: &'static Effect) -> &'static Effect {
    let is_it = |it: &&'static Effect| it.id == effect.id && it.element.kind() == effect.element.kind();
    placed(plant).flat_map(|it| it.effects).find(is_it).unwrap_or(effect)
}

/// The element whose parameters an instance has.
fn element(instance: &Instance) -> Option<Element> {
    let kind = Element::ALL.into_iter().find(|it| it.name() == instance.group)?;
    Some(kind.at(&instance.place))
}

impl Placed {
    /// Made once for the whole program: an effect is known by where it is.
    fn at(element: Element) -> Self {
        static MADE: Mutex<BTreeMap<Element, Placed>> = Mutex::new(BTreeMap::new());
        let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
        *made.entry(element).or_insert_with(|| Self::made(element))
    }

    fn made(element: Element) -> Self {
        let place = element.place().unwrap_or_default();
        let name = |parameter: &str| -> &'static str { plant::placed(parameter, place).leak() };
        // An effect that is a setting of the model alone has no place.
        let own = all().filter(|it| it.element.kind() == element.kind() && !it.parts.is_empty());
        let effects = own.map(|effect| {
            let part = |part: &Part| Part { parameter: name(part.parameter), ..*part };
            let parts: Vec<Part> = effect.parts.iter().map(part).collect();
            Effect { element, parts: parts.leak(), ..*effect }
        });
        let own = tables::TABLES.iter().filter(|it| it.element.kind() == element.kind());
        let tables = own.map(|table| Table {
            element,
            switch: name(table.switch),
            range: name(table.range),
            points: name(table.points),
            ..*table
        });
        Self { effects: effects.collect::<Vec<_>>().leak(), tables: tables.collect::<Vec<_>>().leak() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::ElementKind;
    use crate::rig::Rig;

    fn of_struts<'a>(plant: &'a Plant, id: &'a str) -> impl Iterator<Item = &'static Effect> + use<'a> {
        effects(plant).filter(move |it| it.id == id && it.element.kind() == ElementKind::Strut)
    }

    #[test]
    fn an_effect_is_at_each_place_at_each_axle_and_at_all() {
        let plant = Rig::published("full-car").unwrap().plant;
        let names: Vec<&str> = of_struts(&plant, "01").map(|it| it.element.name()).collect();
        let places = ["front_left", "front_right", "rear_left", "rear_right", "front", "rear", "all"];
        assert_eq!(names, places.map(|place| format!("strut.{place}")));
        let joint: Vec<bool> = of_struts(&plant, "01").map(|it| is_joint(&plant, it.element)).collect();
        assert_eq!(joint, [false, false, false, false, true, true, true]);
        for effect in of_struts(&plant, "08") {
            let names: Vec<&str> = effect.parts.iter().map(|it| it.parameter).collect();
            let name = effect.element.name();
            assert_eq!(names, ["cubic", "quadratic"].map(|it| format!("{name}.spring.{it}")));
        }
    }

    #[test]
    fn one_place_is_part_of_its_axle_and_of_all() {
        let plant = Rig::published("full-car").unwrap().plant;
        let at = |place: &str| of_struts(&plant, "04").find(|it| it.element.place() == Some(place)).unwrap();
        let several: Vec<&str> =
            joints_of(&plant, at("rear_left")).iter().map(|it| it.element.name()).collect();
        assert_eq!(several, ["strut.rear", "strut.all"]);
        assert!(joints_of(&plant, at("all")).is_empty());
        let only = all().find(|it| it.id == "01" && it.element == Element::STRUT).unwrap();
        assert_eq!(first_of(&plant, only).element.name(), "strut.front_left");
        let quarter = Rig::published("quarter-car").unwrap().plant;
        assert!(std::ptr::eq(first_of(&quarter, only), only) && joints_of(&quarter, only).is_empty());
    }

    #[test]
    fn an_entry_is_made_once() {
        let made = || Placed::at(Element::TIRE.at("rear_left")).effects.as_ptr();
        assert_eq!(made(), made());
    }

    #[test]
    fn a_setting_alone_has_no_place() {
        let plant = Rig::published("full-car").unwrap().plant;
        let lift_off: Vec<&Effect> = effects(&plant).filter(|it| it.id == "20").collect();
        assert_eq!(lift_off.iter().map(|it| it.element).collect::<Vec<_>>(), [Element::TIRE]);
    }
}
