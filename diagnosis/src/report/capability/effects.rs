//! Which effects of the catalogue can be identified in a rig, and why others cannot.

use std::collections::{BTreeMap, BTreeSet};

use crate::catalogue::{self, Effect, Element, RESPONSE, Signal};
use crate::plant::Role;
use crate::report::words::list;
use crate::rig::{ElementSignals, Rig};

/// Effects of one place: what it is called, and numbers with names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Possible {
    /// The element, or the signals.
    pub place: String,
    /// `01 Coulomb friction`.
    pub effects: Vec<String>,
}

/// Why effects cannot be identified.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Obstacle {
    /// No element of this kind stands beside the FMU.
    NotBeside,
    /// The strut beside the FMU has no spring and no damper of its own that they could change.
    NotReplaced,
    /// No element of the library that can stand beside an FMU has them.
    Elsewhere,
    /// The model has no effect of this element.
    NoElement,
    /// The model lacks this parameter or setting.
    Lacks(&'static str),
}

impl Obstacle {
    /// What is to be said, with what to do if something can be done.
    pub fn sentence(&self, model: &str) -> String {
        match self {
            Self::NotBeside => {
                "No such element has `acts_on`, the inputs that take the force of one of the library. Without it, none stands \
                 beside the FMU."
                    .into()
            }
            Self::NotReplaced => {
                "They change a spring or a damper of the strut's own. Name those of the FMU in `replaces` \
                                  for the strut to take their place."
                    .into()
            }
            Self::Elsewhere => {
                "No element of the library that can stand beside an FMU has them.".into()
            }
            Self::NoElement => format!("{model} has no such element."),
            Self::Lacks(name) => format!("{model} has no `{name}`."),
        }
    }
}

/// What keeps an effect from being identified in a rig; nothing if it can be.
pub fn obstacle(effect: &'static Effect, rig: &Rig) -> Option<Obstacle> {
    let plant = &rig.plant;
    let effect = catalogue::first_of(plant, effect);
    if effect.is_in(plant) {
        return None;
    }
    if rig.kind.is_foreign() {
        let is_it = |it: &&ElementSignals| it.element == effect.element && !it.acts_on.is_empty();
        return Some(match rig.kind.elements.iter().find(is_it) {
            _ if !is_beside(effect) => Obstacle::Elsewhere,
            None => Obstacle::NotBeside,
            Some(_) => Obstacle::NotReplaced,
        });
    }
    if !catalogue::effects(plant).any(|it| it.element.kind() == effect.element.kind()) {
        return Some(Obstacle::NoElement);
    }
    let lacking = effect.parts.iter().map(|it| it.parameter).find(|it| plant.parameter(it).is_none());
    let lacking = lacking.or_else(|| effect.setting.filter(|it| plant.setting(it).is_none()));
    lacking.map(Obstacle::Lacks)
}

/// Whether an element beside another maker's model can have an effect: no coil drives it, and it leaves nothing by a setting.
fn is_beside(effect: &Effect) -> bool {
    let of_parts = |role: Role| effect.parts.iter().all(|it| role.has(it.parameter));
    !effect.parts.is_empty() && Role::named(effect.element.name()).is_some_and(of_parts)
}

/// Effects that cannot be identified, with what keeps them.
pub fn impossible(rig: &Rig) -> BTreeMap<Obstacle, Vec<&'static Effect>> {
    let mut all: BTreeMap<Obstacle, Vec<&Effect>> = BTreeMap::new();
    for effect in catalogue::all() {
        if let Some(obstacle) = obstacle(effect, rig) {
            all.entry(obstacle).or_default().push(effect);
        }
    }
    for effects in all.values_mut() {
        effects.sort_by_key(|it| (it.element, it.id));
    }
    all
}

/// Effects that can be identified in the elements of a rig.
pub fn in_elements(rig: &Rig) -> Vec<Possible> {
    let of = |element: Element| -> Vec<String> {
        let named = catalogue::effects(&rig.plant).filter(|it| it.element == element);
        let mut named: Vec<String> = named.map(|it| format!("{} {}", it.id, it.name)).collect();
        named.sort();
        let tables = catalogue::tables(&rig.plant).filter(|it| it.element == element);
        named.extend(tables.map(|it| format!("{} {}", it.law.id, it.name())));
        named
    };
    let plant = &rig.plant;
    let named = catalogue::effects(plant).map(|it| it.element);
    let all: BTreeSet<Element> = named.chain(catalogue::tables(plant).map(|it| it.element)).collect();
    let mut groups: Vec<(Vec<&str>, Vec<String>)> = Vec::new();
    for element in all {
        let effects = of(element);
        match groups.iter_mut().find(|(_, own)| *own == effects) {
            Some((names, _)) => names.push(element.name()),
            None => groups.push((vec![element.name()], effects)),
        }
    }
    groups.into_iter().map(|(names, effects)| Possible { place: names.join(", "), effects }).collect()
}

/// Effects that can be identified in the signals of a rig; signals with the same effects stand together.
pub fn in_signals(rig: &Rig) -> Vec<Possible> {
    let plant = &rig.plant;
    let mut groups: Vec<(Vec<String>, Vec<String>)> = Vec::new();
    let mut add = |name: &str, effects: Vec<String>| match groups.iter_mut().find(|(_, own)| *own == effects)
    {
        Some((names, _)) => names.push(name.to_owned()),
        None => groups.push((vec![name.to_owned()], effects)),
    };
    let of = |signal: Signal, name: &str| -> Vec<String> {
        let faults = catalogue::distortions(signal, name);
        let faults =
            faults.filter(|it| signal == Signal::Output || !catalogue::is_replaced(plant, name, *it));
        let distortions = faults.map(catalogue::distortion);
        let mut named: Vec<String> =
            distortions.map(|it| format!("{} {}", it.at(signal).id, it.name)).collect();
        named.dedup();
        if signal == Signal::Output {
            named.push(format!("{} {}", RESPONSE.at(signal).id, RESPONSE.name));
        }
        named
    };
    for declared in &plant.inputs {
        add(&declared.name, of(Signal::of_input(&declared.name), &declared.name));
    }
    for declared in plant.outputs.iter().filter(|it| !rig.is_trivial(&it.name)) {
        add(&declared.name, of(Signal::Output, &declared.name));
    }
    let place = |names: &[String]| format!("signal {}", list(names, "and"));
    groups.into_iter().map(|(names, effects)| Possible { place: place(&names), effects }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Kind;

    /// A rig with a dyno's plant in the place of an FMU with a strut beside it.
    fn foreign(element: &str, remove: &[&str]) -> Rig {
        let mut rig = Rig::published("element-dyno").unwrap();
        let text =
            format!("model = \"my.fmu\"\n[[elements]]\nelement = \"strut\"\ndeflection = \"z\"\n{element}");
        rig.kind = Kind::parse(&text).unwrap().into();
        rig.plant.settings.clear();
        rig.plant
            .parameters
            .retain(|it| Role::Strut.has(&it.name) && !remove.iter().any(|start| it.name.starts_with(start)));
        rig
    }

    fn numbers(effects: Option<&Vec<&Effect>>) -> Vec<&'static str> {
        effects.into_iter().flatten().map(|it| it.id).collect()
    }

    #[test]
    fn without_a_strut_beside_it_an_fmu_has_no_effect_of_one() {
        let rig = foreign("force = { output = \"f\" }", &["strut.", "hysteresis."]);
        let impossible = impossible(&rig);
        let beside = catalogue::all().filter(|it| is_beside(it)).count();
        assert_eq!(impossible[&Obstacle::NotBeside].len(), beside);
        assert_eq!(
            impossible[&Obstacle::NotBeside].len() + impossible[&Obstacle::Elsewhere].len(),
            catalogue::all().count()
        );
        assert_eq!(in_elements(&rig), []);
        assert!(Obstacle::NotBeside.sentence("").contains("`acts_on`"));
    }

    #[test]
    fn a_strut_on_top_has_no_damper_that_could_change() {
        let element = "force = { output = \"f\" }\nvelocity = \"v\"\nacts_on = [\"-F\"]";
        let removed =
            ["strut.asymmetry.", "strut.knee.", "strut.fade.", "strut.linkage.", "hysteresis.mount."];
        let rig = foreign(element, &removed);
        let all = impossible(&rig);
        assert_eq!(numbers(all.get(&Obstacle::NotReplaced)), ["04", "05", "10", "12", "13", "14"]);
        let of_strut = |it: &&Effect| it.element == Element::STRUT;
        assert!(!all[&Obstacle::NotBeside].iter().any(of_strut));
        assert!(in_elements(&rig)[0].effects.contains(&"01 Coulomb friction".to_owned()));
    }

    #[test]
    fn a_strut_that_replaces_spring_and_damper_has_every_effect() {
        let element = "force = { output = \"f\" }\nvelocity = \"v\"\nacts_on = [\"-F\"]\n\
                       replaces = { stiffness = \"k\", damping = \"d\" }";
        let all = impossible(&foreign(element, &[]));
        assert_eq!(all.keys().collect::<Vec<_>>(), [&Obstacle::NotBeside, &Obstacle::Elsewhere]);
        assert!(all[&Obstacle::NotBeside].iter().all(|it| it.element != Element::STRUT));
        assert!(all[&Obstacle::Elsewhere].iter().all(|it| !is_beside(it)));
    }

    #[test]
    fn a_model_of_the_library_lacks_elements_or_parameters() {
        let rig = Rig::published("quarter-car").unwrap();
        let all = impossible(&rig);
        let pivot = catalogue::all().find(|it| it.element == Element::PIVOT).unwrap();
        assert_eq!(obstacle(pivot, &rig), Some(Obstacle::NoElement));
        for (obstacle, effects) in all {
            assert!(!effects.is_empty() && obstacle.sentence("QuarterCar").ends_with('.'), "{obstacle:?}");
        }
    }

    #[test]
    fn every_signal_that_is_compared_can_be_distorted() {
        for name in Rig::names() {
            let rig = Rig::published(&name).unwrap();
            let places: Vec<String> = in_signals(&rig).into_iter().map(|it| it.place).collect();
            for output in rig.plant.outputs.iter().filter(|it| !rig.is_trivial(&it.name)) {
                assert!(places.iter().any(|it| it.contains(&output.name)), "{name}: {}", output.name);
            }
        }
    }
}
