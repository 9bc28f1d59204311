use super::*;
use crate::rig::Kind;

fn of(name: &str) -> String {
    capability(&Rig::published(name).unwrap(), &Foreign::default()).unwrap()
}

/// A dyno's plant in the place of an FMU with a strut beside it.
fn foreign(element: &str) -> Rig {
    let mut rig = Rig::published("element-dyno").unwrap();
    let text = format!(
        "model = \"my.fmu\"\nnominal = [\"strut.stiffness\"]\n[[elements]]\nelement = \"strut\"\ndeflection = \"z\"\n{element}"
    );
    rig.kind = Kind::parse(&text).unwrap().into();
    rig
}

#[test]
fn every_rig_of_the_library_says_all_it_can() {
    for name in Rig::names() {
        let (rig, text) = (Rig::published(&name).unwrap(), of(&name));
        let outputs = rig.plant.outputs.iter().filter(|it| !rig.is_trivial(&it.name));
        for signal in rig.plant.inputs.iter().chain(outputs) {
            assert!(text.contains(&format!("  {} ", signal.name)), "{name}: {}\n{text}", signal.name);
        }
        for effect in catalogue::all() {
            let number = format!("{} {}", effect.id, effect.name);
            assert!(text.replace("\n    ", " ").contains(&number), "{name}: {number}\n{text}");
        }
        for index in rig.base() {
            assert!(text.contains(&format!("  {} ", rig.plant.parameters[index].name)), "{name}");
        }
        assert!(text.lines().all(|line| !line.ends_with(' ')), "{name}");
    }
}

#[test]
fn places_are_elements_commands_and_sensors() {
    let text = of("servo-suspension");
    let section = text.split("\n\n").find(|it| it.starts_with("Places")).unwrap();
    let kinds = ["by `strut.preload`", "a command", "a sensor"];
    assert!(kinds.iter().all(|it| section.contains(it)), "{section}");
    let mut passive = Rig::published("element-dyno").unwrap();
    passive.plant.inputs.retain(|it| it.name.starts_with("motion."));
    let alone = capability(&passive, &Foreign::default()).unwrap();
    assert!(alone.contains("No input counts as a command"), "{alone}");
}

#[test]
fn a_drive_has_several_ways() {
    let text = of("linear-drive").replace("\n    ", " ");
    assert!(text.contains("One way is `drive = Force`: by `force`, or a column"), "{text}");
}

#[test]
fn a_strut_that_changes_the_model_is_noted() {
    let element = "velocity = \"v\"\nforce = { output = \"f\" }\nacts_on = [\"-F\"]\n\
                   replaces = { stiffness = \"k\", damping = \"d\" }";
    let rig = foreign(element);
    let note = |difference: f64| {
        said(&rig, &Foreign { difference: Some(difference), ..Foreign::default() }).remove(0)
    };
    assert!(note(1e-3).ends_with("changes the outputs by 0.1 % at most."), "{}", note(1e-3));
    assert!(note(0.4).contains("40 %. Check the signs in acts_on and of z"), "{}", note(0.4));
    assert!(note(1e-9).ends_with("does not change the outputs."), "{}", note(1e-9));
    assert!(note(280.0).contains("more than 10 times their size. Check"), "{}", note(280.0));
    assert!(note(f64::NAN).contains("cannot be run"), "{}", note(f64::NAN));
    let on_top = foreign("force = { output = \"f\" }\nacts_on = [\"F\"]");
    let notes = said(&on_top, &Foreign::default());
    assert!(notes[0].contains("derivative of `z`") && notes[1].contains("on top"), "{notes:?}");
}

#[test]
fn parameters_of_an_fmu_that_the_file_does_not_name_are_given() {
    let rig = foreign("force = { output = \"f\" }");
    let unnamed = vec!["g".to_owned(), "m_u".to_owned()];
    let text = capability(&rig, &Foreign { unnamed, ..Foreign::default() }).unwrap();
    assert!(text.starts_with("element-dyno: the FMU my.fmu, of another maker\n"), "{text}");
    assert!(text.contains("the file does not name them: g, m_u."), "{text}");
}

#[test]
fn whether_there_will_be_an_augmented_model_is_said() {
    let rig = foreign("velocity = \"v\"\nforce = { output = \"f\" }\nacts_on = [\"F\"]");
    let said = |augmented| said(&rig, &Foreign { augmented, ..Foreign::default() }).join("\n");
    assert!(!said(None).contains("augmented.ssp"));
    let text = said(Some(Err("the FMU is for model exchange only".into())));
    assert!(
        text.contains("A diagnosis writes no augmented.ssp: the FMU is for model exchange only."),
        "{text}"
    );
    let text = said(Some(Ok(vec!["a is no output of the FMU".into()])));
    assert!(text.contains("what was found beside it. a is no output of the FMU."), "{text}");
}

#[test]
fn a_model_that_no_record_can_be_compared_with_is_refused() {
    let mut rig = Rig::published("quarter-car").unwrap();
    rig.plant.inputs.clear();
    assert!(capability(&rig, &Foreign::default()).unwrap_err().contains("no real input"));
    let mut rig = Rig::published("quarter-car").unwrap();
    rig.plant.outputs.clear();
    assert!(capability(&rig, &Foreign::default()).unwrap_err().contains("no output"));
}
