//! A strut of the library that acts beside a model of another maker, between two of its outputs and its inputs.

use strut_model::{Bundle, Declaration, Declarations, Instant, Model, Settings};
use strut_physics::rigs::ElementDyno;

use super::exchange::{Fmu, LEAST, Session};
use crate::pace::{ACCURATE, FAST, RESERVE, rates};
use crate::{Between, Drive};

/// Where a strut is attached.
#[derive(Clone, Debug)]
pub struct Attachment {
    /// Output with its deflection, positive in rebound.
    pub deflection: String,
    /// What that output is where the strut's spring carries nothing, in m.
    pub rest: f64,
    /// Output with its rate.
    pub velocity: String,
    /// Inputs that its force is added to, each with a factor; the force is positive where it pulls the ends together.
    pub acts_on: Vec<(String, f64)>,
    /// What it does in the model's place; none: it comes on top.
    pub replaces: Option<Replaced>,
}

/// Parameters of a model that are zero while a strut of the library does what they did.
#[derive(Clone, Debug)]
pub struct Replaced {
    /// Spring rate.
    pub stiffness: String,
    /// Damping rate.
    pub damping: String,
}

type Parameters = <ElementDyno as Model>::Parameters<f64>;
type State = <ElementDyno as Model>::State<f64>;

/// Groups of parameters that change the strut's own spring or damper: without one they do nothing.
const OF_ITS_OWN: [&str; 7] = [
    "strut.stiffness",
    "strut.damping",
    "strut.asymmetry.",
    "strut.knee.",
    "strut.fade.",
    "strut.linkage.",
    "hysteresis.mount.",
];

/// Whether a parameter is one of the strut beside a model, and not the model's own.
pub fn is_of_strut(name: &str) -> bool {
    ["strut.", "hysteresis."].iter().any(|start| name.starts_with(start))
}

/// What of a replaced spring and damper the strut beside a model has to have itself, with these parameters: an effect
/// that changes a damper acts in the strut's own. Any other effect only adds a force.
pub fn needs_own<'a>(values: impl Iterator<Item = (&'a str, f64)>) -> Own {
    let declared = Declarations::of::<Parameters>();
    let neutral = |name: &str| declared.iter().find(|it| it.name == name).map(|it| it.start);
    let mut own = Own::default();
    for (name, _) in values.filter(|(name, value)| neutral(name) != Some(*value)) {
        let rates = ["strut.stiffness", "strut.damping"].contains(&name);
        if !rates && OF_ITS_OWN.iter().any(|group| name.starts_with(group)) {
            own.damper = true;
            // The linkage is between the wheel and the spring, too.
            own.spring |= name.starts_with("strut.linkage.");
        }
    }
    own
}

/// What a strut beside a model has of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Own {
    /// A spring.
    pub spring: bool,
    /// A damper.
    pub damper: bool,
}

/// An attached strut.
#[derive(Clone, Debug)]
pub struct Beside {
    /// Its parameters that may be changed.
    pub parameters: Vec<Declaration>,
    /// What it remembers.
    pub states: Vec<Declaration>,
    model: ElementDyno,
    /// Of each of `parameters`: its index in the model.
    indices: Vec<usize>,
    /// The model's parameters with all effects off.
    plain: Vec<f64>,
    deflection: usize,
    rest: f64,
    velocity: usize,
    acts_on: Vec<(usize, f64)>,
}

impl Beside {
    /// A strut at its place in a model.
    pub fn new(fmu: &Fmu, at: &Attachment) -> Result<Self, String> {
        let index = |declared: &[Declaration], name: &str, what: &str| {
            let found = declared.iter().position(|it| it.name == *name);
            found.ok_or_else(|| {
                format!("the strut is attached to {what} `{name}`, which {} does not have", fmu.name)
            })
        };
        let acts_on =
            at.acts_on.iter().map(|(name, factor)| Ok((index(&fmu.inputs, name, "the input")?, *factor)));
        let acts_on: Vec<(usize, f64)> = acts_on.collect::<Result<_, String>>()?;
        if acts_on.is_empty() {
            return Err("the strut acts on no input: name those that take its force in acts_on".into());
        }
        let declared = Declarations::of::<Parameters>();
        let mut plain: Vec<f64> = declared.iter().map(|it| it.start).collect();
        let mut own: Vec<(usize, Declaration)> = declared.into_iter().enumerate().collect();
        for (index, declared) in &mut own {
            let replaced = match (declared.name.as_str(), &fmu.replaced[..]) {
                ("strut.stiffness", [stiffness, _]) => *stiffness,
                ("strut.damping", [_, damping]) => *damping,
                ("strut.stiffness" | "strut.damping", _) => 0.0,
                _ => continue,
            };
            (plain[*index], declared.start) = (replaced, replaced);
            // On its own bench there may be no spring. Here it has the place of one.
            if declared.name == "strut.stiffness" && replaced > 0.0 {
                declared.min = Some(LEAST * replaced);
            }
        }
        own.retain(|(_, it)| is_of_strut(&it.name));
        if at.replaces.is_none() {
            own.retain(|(_, it)| !OF_ITS_OWN.iter().any(|group| it.name.starts_with(group)));
        }
        let (indices, parameters) = own.into_iter().unzip();
        Ok(Self {
            parameters,
            states: Declarations::of::<State>(),
            model: ElementDyno::prepare(&Settings::starts(), None)?,
            indices,
            plain,
            deflection: index(&fmu.outputs, &at.deflection, "the output")?,
            rest: at.rest,
            velocity: index(&fmu.outputs, &at.velocity, "the output")?,
            acts_on,
        })
    }

    /// Its parameters as the model has them.
    pub fn set(&self, parameters: &[f64]) -> Set {
        let mut all = self.plain.clone();
        for (index, value) in self.indices.iter().zip(parameters) {
            all[*index] = *value;
        }
        let parameters = Bundle::from_fn(|i| all[i]);
        let forgets = [0.0, FAST].map(|velocity| {
            let inputs = Declarations::of::<<ElementDyno as Model>::Input<f64>>();
            let moved = |it: &Declaration| vec![if it.name == "motion.velocity" { velocity } else { 0.0 }];
            let inputs = inputs.iter().map(moved).collect();
            let drive = Drive { start: 0.0, step: 1.0, inputs, finer: 1, between: Between::Lines };
            rates(&self.model, &parameters, &drive, &self.states)[0]
        });
        Set { derived: self.model.derive(&parameters), parameters, forgets }
    }

    /// Steps that its memory asks for over a time in s from where these are the model's outputs.
    pub fn steps(&self, set: &Set, time: f64, outputs: &[f64]) -> usize {
        let [at_rest, fast] = set.forgets;
        let moved = RESERVE * fast * outputs[self.velocity].abs() / FAST;
        (time * at_rest.max(moved) / ACCURATE).ceil() as usize
    }

    /// Refuses parameters that do not go together.
    pub fn check(&self, parameters: &[f64]) -> Result<(), String> {
        let Set { parameters, derived, .. } = self.set(parameters);
        self.model.check(&parameters, &derived)
    }

    /// Adds its force to the inputs of a placed model, and computes the rates of its memory.
    pub fn act(
        &self,
        set: &Set,
        time: f64,
        session: &mut Session,
        (inputs, states, rates): (&mut [f64], &[f64], &mut [f64]),
    ) {
        let (deflection, velocity) =
            (session.output(self.deflection) - self.rest, session.output(self.velocity));
        // The bench moves the lower end: its deflection is the motion's negative.
        let moved = [-deflection, -velocity];
        let input = <ElementDyno as Model>::Input::from_fn(|i| moved.get(i).copied().unwrap_or(0.0));
        let state: State = Bundle::from_fn(|i| states[i]);
        let memory = Bundle::from_fn(|_| 0.0);
        let now = Instant {
            time,
            state: &state,
            input: &input,
            parameters: &set.parameters,
            derived: &set.derived,
            memory: &memory,
            tick: 0,
        };
        let (change, output) = self.model.equations(now);
        change.for_each(|index, rate| rates[index] = rate);
        // What the bench measures is positive in compression.
        self.acts_on.iter().for_each(|(input, factor)| inputs[*input] -= factor * output.force);
        session.drive(inputs);
    }

    /// The outputs that it needs, and the inputs that it changes.
    pub fn ends(&self) -> ([usize; 2], impl Iterator<Item = usize>) {
        ([self.deflection, self.velocity], self.acts_on.iter().map(|(input, _)| *input))
    }
}

/// Parameters of a strut with what follows from them.
#[derive(Clone, Debug)]
pub struct Set {
    parameters: Parameters,
    derived: <ElementDyno as Model>::Derived<f64>,
    /// How fast its memory changes at rest and in fast motion, per second.
    forgets: [f64; 2],
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strut_has_of_its_own_what_an_effect_changes() {
        let own = |values: &[(&'static str, f64)]| needs_own(values.iter().copied());
        let rates = [("strut.stiffness", 9e3), ("strut.damping", 12.0)];
        let with = |effect: (&'static str, f64)| own(&[rates[0], rates[1], effect]);
        for effect in
            ["strut.coulomb.force", "hysteresis.maxwell.stiffness", "strut.stop.stiffness", "strut.preload"]
        {
            assert_eq!(with((effect, 5.0)), Own::default(), "{effect}");
        }
        for effect in
            ["strut.asymmetry.ratio", "strut.knee.ratio", "strut.fade.ratio", "hysteresis.mount.compliance"]
        {
            assert_eq!(with((effect, 0.5)), Own { spring: false, damper: true }, "{effect}");
        }
        assert_eq!(with(("strut.linkage.slope", 0.5)), Own { spring: true, damper: true });
        // Off, it changes nothing.
        assert_eq!(with(("strut.asymmetry.ratio", 0.0)), Own::default());
    }
}
