//! Elements of the library that act beside a model of another maker, between its outputs and its inputs.

use strut_model::{Bundle, Declaration, Declarations, Instant, Model, Settings};
use strut_physics::rigs::ElementDyno;

use super::exchange::{Fmu, LEAST, Session};
use super::role::Role;
use crate::Drive;
use crate::pace::{ACCURATE, FAST, RESERVE, rates};

/// Where an element is attached.
#[derive(Clone, Debug)]
pub struct Attachment {
    /// Its role.
    pub role: Role,
    /// Output with its deflection, positive in rebound.
    pub deflection: String,
    /// What that output is where the element's spring carries nothing, in m.
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

/// What of a replaced spring and damper the strut beside a model has to have itself, with these parameters: an effect
/// that changes a damper acts in the strut's own. Any other effect only adds a force.
pub fn needs_own<'a>(values: impl Iterator<Item = (&'a str, f64)>) -> Own {
    let declared = Declarations::of::<Parameters>();
    let neutral = |name: &str| declared.iter().find(|it| it.name == name).map(|it| it.start);
    let mut own = Own::default();
    for (name, _) in values.filter(|(name, value)| neutral(name) != Some(*value)) {
        if !Role::Strut.rates().contains(&name) && OF_ITS_OWN.iter().any(|group| name.starts_with(group)) {
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

/// The elements beside a model.
#[derive(Clone, Debug)]
pub struct Beside {
    /// Their parameters that may be changed.
    pub parameters: Vec<Declaration>,
    /// Their memory.
    pub states: Vec<Declaration>,
    all: Vec<Attached>,
}

/// An attached element.
#[derive(Clone, Debug)]
struct Attached {
    role: Role,
    model: ElementDyno,
    /// Of each of its parameters: its index in the model.
    indices: Vec<usize>,
    /// How many states are its own.
    states: usize,
    /// The model's parameters with all effects off.
    plain: Vec<f64>,
    deflection: usize,
    rest: f64,
    velocity: usize,
    acts_on: Vec<(usize, f64)>,
}

impl Beside {
    /// Elements at their places in a model.
    ///
    /// # Errors
    /// If the model lacks a signal that an element is attached to.
    pub fn new(fmu: &Fmu, attachments: &[Attachment]) -> Result<Self, String> {
        let mut beside = Self { parameters: Vec::new(), states: Vec::new(), all: Vec::new() };
        for at in attachments {
            let (attached, parameters) = Attached::new(fmu, at)?;
            beside.parameters.extend(parameters);
            beside.states.extend(at.role.states());
            beside.all.push(attached);
        }
        Ok(beside)
    }

    /// Their parameters as the models have them.
    pub fn set(&self, parameters: &[f64]) -> Set {
        Set(self.each(parameters).map(|(it, own)| it.set(own)).collect())
    }

    /// Each element with its own of the parameters.
    fn each<'p>(&self, parameters: &'p [f64]) -> impl Iterator<Item = (&Attached, &'p [f64])> {
        self.all.iter().scan(parameters, |rest, it| {
            let own;
            (own, *rest) = rest.split_at(it.indices.len());
            Some((it, own))
        })
    }

    /// Steps that their memory asks for over a time in s from where these are the model's outputs.
    pub fn steps(&self, set: &Set, time: f64, outputs: &[f64]) -> usize {
        let one = |(it, set): (&Attached, &Laws)| it.steps(set, time, outputs);
        self.all.iter().zip(&set.0).map(one).max().unwrap_or(0)
    }

    /// Refuses parameters that do not go together.
    pub fn check(&self, parameters: &[f64]) -> Result<(), String> {
        self.each(parameters).try_for_each(|(it, own)| {
            let parameters = it.on_bench(own);
            it.model.check(&parameters, &it.model.derive(&parameters))
        })
    }

    /// Adds their forces to the inputs of a placed model, and computes the rates of their memory.
    pub fn act(
        &self,
        set: &Set,
        time: f64,
        session: &mut Session,
        (inputs, mut states, mut rates): (&mut [f64], &[f64], &mut [f64]),
    ) {
        for (it, set) in self.all.iter().zip(&set.0) {
            let (own, of_own);
            (own, states) = states.split_at(it.states);
            (of_own, rates) = rates.split_at_mut(it.states);
            let force = it.force(set, time, session, (own, of_own));
            it.acts_on.iter().for_each(|(input, factor)| inputs[*input] += factor * force);
        }
        // After all of them: no force changes a motion at once.
        for (input, _) in self.all.iter().flat_map(|it| &it.acts_on) {
            session.push(*input, inputs[*input]);
        }
    }

    /// Of each element: its name, and the inputs that it changes.
    pub fn acts_on(&self) -> impl Iterator<Item = (&'static str, impl Iterator<Item = usize>)> {
        self.all.iter().map(|it| (it.role.name(), it.acts_on.iter().map(|(input, _)| *input)))
    }

    /// The outputs that they need.
    pub fn motions(&self) -> Vec<usize> {
        self.all.iter().flat_map(|it| [it.deflection, it.velocity]).collect()
    }
}

impl Role {
    /// Its memory.
    fn states(self) -> impl Iterator<Item = Declaration> {
        Declarations::of::<State>().into_iter().filter(move |it| self.has(&it.name))
    }
}

impl Attached {
    /// The element with its parameters that may be changed, under its own names.
    fn new(fmu: &Fmu, at: &Attachment) -> Result<(Self, Vec<Declaration>), String> {
        let name = at.role.name();
        let index = |declared: &[Declaration], signal: &str, what: &str| {
            let found = declared.iter().position(|it| it.name == *signal);
            found.ok_or_else(|| {
                format!("the {name} is attached to {what} `{signal}`, which {} does not have", fmu.name)
            })
        };
        let acts_on =
            at.acts_on.iter().map(|(name, factor)| Ok((index(&fmu.inputs, name, "the input")?, *factor)));
        let acts_on: Vec<(usize, f64)> = acts_on.collect::<Result<_, String>>()?;
        let mut declared = Declarations::of::<Parameters>();
        let rates = match (&at.replaces, &fmu.replaced[..]) {
            (Some(_), [stiffness, damping]) => [*stiffness, *damping],
            _ => [0.0; 2],
        };
        let [spring, damper] = at.role.rates();
        for it in &mut declared {
            if it.name == spring {
                it.start = rates[0];
                // On its own bench there may be no spring. Here it may have the place of one.
                it.min = Some(LEAST * rates[0]);
            } else if it.name == damper {
                it.start = rates[1];
            }
        }
        let plain = declared.iter().map(|it| it.start).collect();
        // The strut's own rates are the model's; on top of them, a strut only adds forces.
        let adds = |name: &str| {
            let own = at.role == Role::Strut && OF_ITS_OWN.iter().any(|group| name.starts_with(group));
            !own || at.replaces.is_some()
        };
        let own = declared.into_iter().enumerate().filter(|(_, it)| adds(&it.name));
        let named = own
            .filter_map(|(index, it)| Some((index, Declaration { name: at.role.beside(&it.name)?, ..it })));
        let (indices, parameters) = named.unzip();
        let attached = Self {
            role: at.role,
            model: if at.role.is_tire() {
                ElementDyno::of_a_tire()
            } else {
                ElementDyno::prepare(&Settings::starts(), None)?
            },
            indices,
            states: at.role.states().count(),
            plain,
            deflection: index(&fmu.outputs, &at.deflection, "the output")?,
            rest: at.rest,
            velocity: index(&fmu.outputs, &at.velocity, "the output")?,
            acts_on,
        };
        Ok((attached, parameters))
    }

    /// Its parameters among those of the bench.
    fn on_bench(&self, parameters: &[f64]) -> Parameters {
        let mut all = self.plain.clone();
        for (index, value) in self.indices.iter().zip(parameters) {
            all[*index] = *value;
        }
        Bundle::from_fn(|i| all[i])
    }

    fn set(&self, parameters: &[f64]) -> Laws {
        let parameters = self.on_bench(parameters);
        let forgets = [0.0, FAST].map(|velocity| {
            if self.states == 0 {
                return 0.0;
            }
            let inputs = Declarations::of::<<ElementDyno as Model>::Input<f64>>();
            let moved = |it: &Declaration| vec![if it.name == "motion.velocity" { velocity } else { 0.0 }];
            let inputs = inputs.iter().map(moved).collect();
            let drive = Drive::sampled(1.0, inputs);
            rates(&self.model, &parameters, &drive, &Declarations::of::<State>())[1]
        });
        Laws { derived: self.model.derive(&parameters), parameters, forgets }
    }

    fn steps(&self, set: &Laws, time: f64, outputs: &[f64]) -> usize {
        let [at_rest, fast] = set.forgets;
        let moved = RESERVE * fast * outputs[self.velocity].abs() / FAST;
        (time * at_rest.max(moved) / ACCURATE).ceil() as usize
    }

    /// The force that pulls its ends together; the rates of its memory go into the last slice.
    fn force(
        &self,
        set: &Laws,
        time: f64,
        session: &mut Session,
        (states, rates): (&[f64], &mut [f64]),
    ) -> f64 {
        let [deflection, velocity] = session.some([self.deflection, self.velocity]);
        // The bench moves the lower end: its deflection is the motion's negative.
        let moved = [self.rest - deflection, -velocity];
        let input = <ElementDyno as Model>::Input::from_fn(|i| moved.get(i).copied().unwrap_or(0.0));
        let state: State = Bundle::from_fn(|i| states.get(i).copied().unwrap_or(0.0));
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
        change.for_each(|index, rate| rates.iter_mut().skip(index).take(1).for_each(|it| *it = rate));
        // What the bench measures is positive in compression.
        -output.force
    }
}

/// Parameters of all elements with values derived from them.
#[derive(Clone, Debug)]
pub struct Set(Vec<Laws>);

/// Parameters of an element with values derived from them.
#[derive(Clone, Debug)]
struct Laws {
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
