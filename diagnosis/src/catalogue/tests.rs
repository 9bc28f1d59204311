//! Whether entries of the catalogue mean what there is.

mod shapes;

use std::collections::BTreeSet;

use super::signals::{Among, DISTORTIONS};
use super::tables::{TABLES, UNNAMED};
use super::*;
use crate::estimation::unknowns::Unknown;
use crate::rig::Rig;
use build_fmu::literature::works;

/// What is wrong with entries, in words.
fn mistakes(effects: &[Effect], models: &[Plant]) -> Vec<String> {
    let mut mistakes = Vec::new();
    let mut seen = BTreeSet::new();
    let keys: Vec<String> = works(strut_physics::LITERATURE).into_iter().map(|work| work.key).collect();
    for effect in effects {
        let mut wrong =
            |what: String| mistakes.push(format!("{} {}: {what}", effect.id, effect.element.name()));
        if !seen.insert((effect.element, effect.id)) {
            wrong("the number is there twice".into());
        }
        for part in effect.parts {
            if !models.iter().any(|plant| plant.parameter(part.parameter).is_some()) {
                wrong(format!("no model has the parameter `{}`", part.parameter));
            }
        }
        if let Some(setting) = effect.setting
            && !models.iter().any(|plant| plant.setting(setting).is_some())
        {
            wrong(format!("no model has the setting `{setting}`"));
        }
        if !models.iter().any(|plant| effect.is_in(plant)) {
            wrong("no model has all of its parameters".into());
        }
        if effect.parts.is_empty() && effect.setting.is_none() {
            wrong("nothing switches it on".into());
        }
        for id in effect.contains {
            if *id == effect.id || !effects.iter().any(|it| it.element == effect.element && it.id == *id) {
                wrong(format!("it contains `{id}`, which its element does not have"));
            }
        }
        if let Some(replaced) = effect.replaces {
            let is_own = |plant: &Plant| plant.inputs.iter().any(|it| it.name.starts_with(replaced.inputs));
            if !models.iter().any(|plant| effect.is_in(plant) && is_own(plant)) {
                wrong(format!("no model with it has an input `{}…`", replaced.inputs));
            }
        }
        if effect.literature.is_empty() {
            wrong("it has no literature".into());
        }
        for key in effect.literature {
            if !keys.iter().any(|it| it == key) {
                wrong(format!("the literature has no `{key}`"));
            }
        }
        for (what, text) in [
            ("number", effect.id),
            ("name", effect.name),
            ("law", effect.equation),
            ("experiment", effect.experiment),
        ] {
            if text.is_empty() {
                wrong(format!("it has no {what}"));
            }
        }
    }
    mistakes
}

#[test]
fn every_entry_is_complete_and_means_what_models_have() {
    let models: Vec<Plant> = Rig::models().collect();
    let effects: Vec<Effect> = all().copied().collect();
    assert_eq!(mistakes(&effects, &models), Vec::<String>::new());
}

#[test]
fn a_wrong_entry_is_noticed() {
    let models: Vec<Plant> = Rig::models().collect();
    let right = *all().next().unwrap();
    let told = |effect: Effect, text: &str| {
        let mistakes = mistakes(&[right, effect], &models);
        assert!(mistakes.iter().any(|it| it.contains(text)), "{text}: {mistakes:?}");
    };
    const MISTYPED: &[Part] = &[part("strut.coulomb.forse", Scale::FORCE, (0.0, 1.0), &[0.1])];
    let other = Effect { id: "99", ..right };
    assert_eq!(mistakes(&[right, other], &models), Vec::<String>::new());
    told(right, "twice");
    told(Effect { parts: MISTYPED, ..other }, "`strut.coulomb.forse`");
    told(Effect { setting: Some("tire.liftoff"), ..other }, "`tire.liftoff`");
    told(Effect { parts: &[], ..other }, "nothing switches it on");
    told(Effect { contains: &["98"], ..other }, "`98`");
    told(Effect { replaces: Some(Replaced { inputs: "rode", distortion: Fault::Lag }), ..other }, "`rode…`");
    told(Effect { literature: &[], ..other }, "no literature");
    told(Effect { literature: &["Nobody1900"], ..other }, "`Nobody1900`");
    told(Effect { experiment: "", ..other }, "no experiment");
}

#[test]
fn every_table_is_in_some_model_and_of_a_published_kind() {
    let models: Vec<Plant> = Rig::models().collect();
    let keys: Vec<String> = works(strut_physics::LITERATURE).into_iter().map(|work| work.key).collect();
    for table in TABLES {
        let has = |plant: &Plant| table.is_in(plant) && plant.parameter(table.range).is_some();
        assert!(models.iter().any(has), "{}", table.points);
        let same = |it: &&Table| {
            (it.law.id, it.element, it.variable) == (table.law.id, table.element, table.variable)
        };
        assert_eq!(TABLES.iter().filter(same).count(), 1, "{}", table.points);
    }
    for law in UNNAMED {
        assert!(TABLES.iter().any(|it| it.law.id == law.id), "{}", law.id);
        assert!(
            !law.literature.is_empty() && law.literature.iter().all(|key| keys.iter().any(|it| it == key))
        );
        assert!(all().all(|it| it.id != law.id), "{}", law.id);
    }
}

#[test]
fn every_distortion_has_an_entry_of_its_own_with_literature() {
    let keys: Vec<String> = works(strut_physics::LITERATURE).into_iter().map(|work| work.key).collect();
    assert_eq!(DISTORTIONS.map(|it| it.fault), Fault::NAMED);
    for own in DISTORTIONS.into_iter().chain([&RESPONSE]) {
        assert_eq!(distortion(own.fault).fault, own.fault);
        assert!(
            !own.literature.is_empty() && own.literature.iter().all(|key| keys.iter().any(|it| it == key))
        );
        let signals = Signal::ALL.map(|signal| own.at(signal));
        let with_another = DISTORTIONS.iter().any(|it| it.output.with == Some(own.fault));
        assert!(with_another || signals.iter().any(|it| it.among != Among::None), "{}", own.name);
    }
}

/// Families share a number, other distortions of a signal do not.
#[test]
fn a_number_of_a_signal_is_one_effect_or_a_family() {
    for signal in Signal::ALL {
        let sought: Vec<&Distortion> =
            DISTORTIONS.into_iter().filter(|it| it.at(signal).among != Among::None).collect();
        let twice =
            |own: &&&Distortion| sought.iter().filter(|it| it.at(signal).id == own.at(signal).id).count() > 1;
        let families: BTreeSet<&str> = sought.iter().filter(twice).map(|it| it.at(signal).id).collect();
        assert!(families.iter().all(|id| ["39", "42"].contains(id)), "{signal:?}: {families:?}");
    }
}

#[test]
fn what_a_signal_s_name_ends_in_is_a_model_s_signal() {
    let models: Vec<Plant> = Rig::models().collect();
    for own in DISTORTIONS {
        for signal in Signal::ALL {
            let (Among::Ending(end) | Among::NotEnding(end)) = own.at(signal).among else { continue };
            let has = |plant: &Plant| {
                plant.inputs.iter().chain(&plant.outputs).any(|declared| declared.name.ends_with(end))
            };
            assert!(models.iter().any(has), "{end}");
        }
    }
}

/// A column is late and 10 % too large: what makes it right is early, and 9 % smaller.
#[test]
fn a_measured_input_s_fault_is_what_its_sensor_does() {
    let rig = Rig::published("tum-linear-measured-quarter-car").unwrap();
    let of = |name: &str, fault: Fault, amount: f64| {
        naming::arisen(Unknown::Input(rig.plant.input(name).unwrap(), fault), &rig.plant, amount)
    };
    assert_eq!(of("road.position", Fault::Delay, -0.02), 0.02);
    assert!((of("road.position", Fault::Gain, -1.0 / 11.0) - 0.1).abs() < 1e-12);
    assert_eq!(of("actuator.force", Fault::Delay, 0.02), 0.02);
    assert_eq!(naming::arisen(Unknown::Output(0, Fault::Delay), &rig.plant, 0.02), 0.02);
}

#[test]
fn a_plant_s_own_law_stands_for_a_distortion_of_its_input() {
    let rig = Rig::published("tum-linear-measured-quarter-car").unwrap();
    assert!(is_replaced(&rig.plant, "road.position", Fault::Lag));
    assert!(is_replaced(&rig.plant, "actuator.force", Fault::Offset));
    assert!(is_replaced(&rig.plant, "actuator.force", Fault::Limit));
    assert!(!is_replaced(&rig.plant, "actuator.force", Fault::Lag));
    assert!(!is_replaced(&rig.plant, "road.position", Fault::Gain));
}

#[test]
fn distortions_are_alike_in_both_directions() {
    for one in DISTORTIONS {
        for other in one.alike {
            assert!(distortion(*other).alike.contains(&one.fault), "{:?}, {other:?}", one.fault);
        }
    }
}
