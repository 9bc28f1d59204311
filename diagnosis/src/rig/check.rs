//! The names in a rig file against its model: every mistake at once.

use strut_model::Declaration;

use crate::data::table::did_you_mean;
use crate::plant::Plant;

use super::kind::{DrivenBy, ElementSignals, ForceOf, Kind, Undriven};

impl Kind {
    /// What is wrong with the names in a rig file of a plant, in sentences.
    pub fn mistakes(&self, plant: &Plant) -> Vec<String> {
        let mut names = Names { plant, mistakes: Vec::new() };
        self.nominal.iter().for_each(|name| names.parameter("nominal", name));
        for element in &self.elements {
            names.element(element);
        }
        self.names.keys().for_each(|name| names.signal("names", name));
        for (rate, of) in &self.rates {
            names.input("rates", rate);
            names.input("rates", of);
        }
        for (output, state) in &self.shows {
            names.output("shows", output);
            names.state("shows", state);
        }
        self.follows_inputs.iter().for_each(|name| names.output("follows_inputs", name));
        self.opposed.iter().for_each(|it| names.signal("opposed", &it.signal));
        for missing in &self.missing {
            names.output("missing", &missing.output);
            missing.times.iter().for_each(|name| names.parameter("missing, times", name));
            for element in
                missing.over.iter().filter(|it| self.elements.iter().all(|own| own.element != **it))
            {
                names.wrong(format!("missing, over: there is no element `{}`", element.name()));
            }
        }
        self.drives.iter().for_each(|by| names.driven(by));
        if let Some(Undriven { input, model }) = &self.undriven {
            names.input("undriven", input);
            let all = Self::published().iter().map(|it| it.model.as_str());
            if all.clone().all(|it| it != model) {
                let hint = did_you_mean(model, all);
                names.wrong(format!("undriven: the library has no model `{model}`{hint}"));
            }
        }
        self.excitation.iter().for_each(|it| names.input("excitation", &it.input));
        let own = self.segment.map(|it| ("segment", it));
        let of_drives = self.drives.iter().filter_map(|by| Some(("drives, segment", by.segment?)));
        for (key, segment) in own.into_iter().chain(of_drives) {
            if segment.is_nan() || segment <= 0.0 {
                names.wrong(format!("{key}: {segment} s is no duration"));
            }
        }
        names.mistakes
    }
}

/// Looks names up and collects those that a plant lacks.
struct Names<'a> {
    plant: &'a Plant,
    mistakes: Vec<String>,
}

impl Names<'_> {
    fn wrong(&mut self, text: String) {
        if !self.mistakes.contains(&text) {
            self.mistakes.push(text);
        }
    }

    fn look<'a>(&mut self, place: &str, what: &str, name: &str, all: impl Iterator<Item = &'a str> + Clone) {
        if !all.clone().any(|it| it == name) {
            let hint = did_you_mean(name, all);
            self.wrong(format!("{place}: {} has no {what} `{name}`{hint}", self.plant.name));
        }
    }

    fn parameter(&mut self, place: &str, name: &str) {
        self.look(place, "parameter", name, named(&self.plant.parameters));
    }

    fn output(&mut self, place: &str, name: &str) {
        self.look(place, "output", name, named(&self.plant.outputs));
    }

    fn input(&mut self, place: &str, name: &str) {
        self.look(place, "input", name, named(&self.plant.inputs));
    }

    fn state(&mut self, place: &str, name: &str) {
        self.look(place, "state", name, named(&self.plant.states));
    }

    fn signal(&mut self, place: &str, name: &str) {
        let signals = named(&self.plant.inputs).chain(named(&self.plant.outputs));
        self.look(place, "input or output", name, signals);
    }

    fn element(&mut self, element: &ElementSignals) {
        let place = format!("elements, {}", element.element.name());
        self.output(&place, &element.deflection);
        element.velocity.iter().for_each(|name| self.output(&place, name));
        match &element.force {
            ForceOf::Output { output } => self.output(&place, output),
            ForceOf::Input { input } => self.input(&place, input),
            ForceOf::SpringAndDamper { stiffness, damping } => {
                [stiffness, damping].into_iter().for_each(|name| self.parameter(&place, name));
            }
            ForceOf::Inertia { acceleration: output, mass: parameter }
            | ForceOf::Moment { moment_of: output, lever: parameter } => {
                self.output(&place, output);
                self.parameter(&place, parameter);
            }
        }
    }

    fn driven(&mut self, by: &DrivenBy) {
        self.look("drives", "setting", &by.setting, self.plant.settings.iter().map(|it| it.name));
        self.input("drives", &by.input);
        by.nominal.iter().for_each(|name| self.parameter("drives, nominal", name));
        by.follows_inputs.iter().for_each(|name| self.output("drives, follows_inputs", name));
        if let Some(inverse) = &by.inverse {
            self.output("drives, inverse", &inverse.force);
            inverse.rate.iter().for_each(|name| self.output("drives, inverse", name));
            inverse.instead.iter().for_each(|name| self.signal("drives, inverse", name));
            let inputs = [&inverse.position, &inverse.derivative];
            inputs.into_iter().for_each(|name| self.input("drives, inverse", name));
        }
    }
}

fn named(declared: &[Declaration]) -> impl Iterator<Item = &str> + Clone {
    declared.iter().map(|it| it.name.as_str())
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::plant::models;
    use crate::rig::Rig;

    #[test]
    fn the_library_s_rig_files_speak_of_what_their_models_have() {
        for kind in Kind::published() {
            let plant = models::named(&kind.model).unwrap();
            assert_eq!(kind.mistakes(&plant), Vec::<String>::new(), "{}", kind.model);
        }
    }

    #[test]
    fn everything_that_is_wrong_is_told_at_once() {
        let text = r#"
            model = "QuarterCar"
            nominal = ["sprung_mas"]
            segment = 0.0
            [names]
            "road.hight" = ["road"]
            [shows]
            "wheel.force" = "wheel.speed"
            [[elements]]
            element = "strut"
            deflection = "suspension.deflexion"
            force = { stiffness = "strut.stifness", damping = "strut.damping" }
            [[missing]]
            quantity = "force"
            output = "body.acceleration"
            over = ["tire"]
            [[excitation]]
            input = "voltage"
            amplitude = 1.0
            band = [1.0, 2.0]
        "#;
        let told = Kind::parse(text).unwrap().mistakes(&models::named("QuarterCar").unwrap());
        let expected = [
            "nominal: QuarterCar has no parameter `sprung_mas`: did you mean `sprung_mass`?",
            "elements, strut: QuarterCar has no output `suspension.deflexion`: did you mean `suspension.deflection`?",
            "elements, strut: QuarterCar has no parameter `strut.stifness`: did you mean `strut.stiffness`?",
            "names: QuarterCar has no input or output `road.hight`",
            "shows: QuarterCar has no state `wheel.speed`",
            "missing, over: there is no element `tire`",
            "excitation: QuarterCar has no input `voltage`",
            "segment: 0 s is no duration",
        ];
        assert_eq!(told.len(), expected.len(), "{told:#?}");
        for (told, expected) in told.iter().zip(expected) {
            assert!(told.starts_with(expected), "{told}");
        }
    }

    #[test]
    fn what_a_file_leaves_out_is_as_in_the_library_s_file() {
        let folder = Path::new(".");
        let rig = |text: &str| Rig::parse(text, "mine".into(), folder).unwrap();
        let own = Rig::published("linear-drive").unwrap();
        let plain = rig("model = \"LinearDrive\"");
        assert_eq!((plain.segment(), plain.base()), (own.segment(), own.base()));
        assert!(own.segment() < 60.0);
        assert_eq!(rig("model = \"LinearDrive\"\nsegment = 3.0").segment(), 3.0);
    }

    #[test]
    fn a_word_that_no_rig_file_has_is_refused_where_it_stands() {
        let refused = Kind::parse("model = \"QuarterCar\"\nnominl = []").unwrap_err();
        assert!(refused.contains("line 2") && refused.contains("nominl"), "{refused}");
        let element =
            "model = \"X\"\n[[elements]]\nelement = \"strut\"\ndeflection = \"x\"\nforce = { outpt = \"f\" }";
        let refused = Kind::parse(element).unwrap_err();
        assert!(refused.contains("write output, input, stiffness and damping"), "{refused}");
    }
}
