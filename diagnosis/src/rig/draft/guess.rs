//! What a model's declarations suggest: which parameters are uncertain, and where a strut acts.

use std::collections::BTreeMap;

use strut_model::Declaration;
use strut_model::unit::{self, Base, Unit};

use crate::plant::Role;

use super::names::{Place, Quantity, go_together, place};

/// What a model of another maker declares, in base units of the SI.
#[derive(Clone, Debug, Default)]
pub struct Declared {
    /// Real inputs.
    pub inputs: Vec<Declaration>,
    /// Real outputs.
    pub outputs: Vec<Declaration>,
    /// Real parameters.
    pub parameters: Vec<Declaration>,
    /// Names of the variables on which each output depends at once; none if the model does not say.
    pub depends: Vec<Option<Vec<String>>>,
    /// How far each output has moved, in its unit, a moment after a step of an input, by the input's index. Inputs that
    /// were not tried are missing.
    pub moved: BTreeMap<usize, Vec<f64>>,
}

/// What the declarations suggest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Guess {
    /// Parameters that are never quite those of a data sheet: masses, spring rates and the like, other than zero.
    pub nominal: Vec<usize>,
    /// The other parameters.
    pub others: Vec<usize>,
    /// Outputs that are a deflection and its velocity.
    pub motions: Vec<Motion>,
    /// Inputs in N that can take the force of a strut, each with its sign if one is known.
    pub forces: Vec<(usize, Option<f64>)>,
    /// Parameters in N/m and in N.s/m.
    pub rates: [Vec<usize>; 2],
    /// Inputs that are the rate of change of another one: rate, input.
    pub input_rates: Vec<(usize, usize)>,
    /// Outputs that follow from the inputs alone, by the model's own word.
    pub at_once: Vec<usize>,
    /// The strut, where all of it is clear.
    pub strut: Option<Strut>,
}

/// A deflection and its velocity, by their outputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// In m.
    pub deflection: usize,
    /// In m/s.
    pub velocity: usize,
    /// Where it is.
    pub place: Option<Place>,
}

/// A strut between a body and a wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strut {
    /// Where it moves.
    pub motion: Motion,
    /// Where its force is found.
    pub force: Force,
    /// The input that takes the force of a strut of the library, and the sign.
    pub acts_on: Option<(usize, f64)>,
    /// Whether that strut replaces the spring and the damper of [`Force::Rates`].
    pub replaces: bool,
}

/// Where a strut's force is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Force {
    /// Parameters of its spring and of its damper.
    Rates(usize, usize),
    /// An output.
    Output(usize),
}

/// Units of parameters that are never quite those of a data sheet: masses, inertias, springs, dampers, windings, motors.
const UNCERTAIN: [Unit; 12] = [
    unit::KG,
    unit::KG_M2,
    unit::N_PER_M,
    unit::N_PER_M2,
    unit::N_PER_M3,
    unit::M_PER_N,
    unit::N_S_PER_M,
    unit::N_M_PER_RAD,
    unit::N_M_S_PER_RAD,
    unit::OHM,
    unit::H,
    unit::N_PER_A,
];

/// A rotary damper in an FMU that does not count the radian.
const N_M_S: Base = Base { kg: 1, m: 2, s: -1, ..Base::NONE };

/// Least motion in m that is more than rounding.
const STILL: f64 = 1e-12;

impl Declared {
    /// What it suggests.
    pub fn guess(&self) -> Guess {
        let uncertain = |index: &usize| {
            let declared = &self.parameters[*index];
            let is_known = UNCERTAIN.iter().any(|it| it.base == declared.unit.base);
            // Zero switches something off: nobody knows whether the rig has it.
            let is_on = declared.start != 0.0;
            is_on && (is_known || declared.unit.base == N_M_S) && !Role::Strut.has(&declared.name)
        };
        let (nominal, others) = (0..self.parameters.len()).partition(uncertain);
        let motions = self.motions();
        let motion = the_strut(&motions);
        let forces = motion.map_or_else(Vec::new, |motion| self.forces(&motion));
        let rates = [unit::N_PER_M, unit::N_S_PER_M].map(|unit| of_unit(&self.parameters, unit));
        let pair = self.pair(&rates);
        let force = pair.map(|(spring, damper)| Force::Rates(spring, damper)).or_else(|| self.force());
        let acts_on = match forces[..] {
            [(input, Some(sign))] => Some((input, sign)),
            _ => None,
        };
        let strut = motion.zip(force).map(|(motion, force)| Strut {
            motion,
            force,
            acts_on,
            replaces: acts_on.is_some() && pair.is_some(),
        });
        Guess {
            nominal,
            others,
            motions,
            forces,
            rates,
            input_rates: self.input_rates(),
            at_once: self.at_once(),
            strut,
        }
    }

    /// Every output in m with the outputs in m/s whose names go with it.
    fn motions(&self) -> Vec<Motion> {
        let outputs = &self.outputs;
        let motion = |(deflection, velocity): (usize, usize)| {
            let place = place(&outputs[deflection].name, &outputs[deflection].doc);
            Motion { deflection, velocity, place }
        };
        pairs(outputs).into_iter().map(motion).collect()
    }

    /// Every input in m/s with the only input in m whose name goes with it.
    fn input_rates(&self) -> Vec<(usize, usize)> {
        let all = pairs(&self.inputs);
        let is_only = |rate: usize| all.iter().filter(|(_, other)| *other == rate).count() == 1;
        let mut rates: Vec<(usize, usize)> =
            all.iter().filter(|(_, rate)| is_only(*rate)).map(|(motion, rate)| (*rate, *motion)).collect();
        rates.sort_unstable();
        rates
    }

    /// Inputs in N that move a strut, and not at once: then the strut's force would depend on itself.
    fn forces(&self, motion: &Motion) -> Vec<(usize, Option<f64>)> {
        let at_once = |input: &str| {
            [motion.deflection, motion.velocity]
                .into_iter()
                .any(|output| self.dependencies(output).is_some_and(|all| all.iter().any(|it| it == input)))
        };
        let mut forces = Vec::new();
        for (index, input) in self.inputs.iter().enumerate() {
            if input.unit.base != unit::N.base || at_once(&input.name) {
                continue;
            }
            let moved = self.moved.get(&index).and_then(|all| all.get(motion.deflection)).copied();
            match moved.filter(|it| it.is_finite()) {
                Some(moved) if moved.abs() <= STILL => {}
                // Force and deflection of a strut have one sign where it pulls its ends together.
                Some(moved) => forces.push((index, Some(-moved.signum()))),
                None => forces.push((index, None)),
            }
        }
        forces
    }

    /// Spring and damper of the strut: the only ones, those that are called so, or those whose names go together.
    fn pair(&self, [springs, dampers]: &[Vec<usize>; 2]) -> Option<(usize, usize)> {
        let at = |index: &usize| {
            let declared = &self.parameters[*index];
            place(&declared.name, &declared.doc)
        };
        let only = |of: &[usize]| match of {
            [one] => Some(*one),
            _ => None,
        };
        let of_strut = |all: &[usize]| -> Option<usize> {
            let called: Vec<usize> = all.iter().copied().filter(|it| at(it) == Some(Place::Strut)).collect();
            only(&called)
        };
        // One that is called a tyre's is no strut's, even if there is no other.
        let possible = |all: &[usize]| -> Vec<usize> {
            all.iter().copied().filter(|it| at(it).is_none_or(|place| place == Place::Strut)).collect()
        };
        let (springs, dampers) = (possible(springs), possible(dampers));
        if let (Some(spring), Some(damper)) =
            (only(&springs).or_else(|| of_strut(&springs)), only(&dampers).or_else(|| of_strut(&dampers)))
        {
            return Some((spring, damper));
        }
        let name = |index: usize| self.parameters[index].name.as_str();
        let pairs = springs.iter().flat_map(|spring| dampers.iter().map(move |damper| (*spring, *damper)));
        let pairs: Vec<(usize, usize)> = pairs
            .filter(|(spring, damper)| {
                go_together((Quantity::Stiffness, name(*spring)), (Quantity::Damping, name(*damper)))
            })
            .collect();
        match pairs[..] {
            [pair] => Some(pair),
            _ => None,
        }
    }

    /// The only output in N that is called a strut's.
    fn force(&self) -> Option<Force> {
        let of_strut = |it: &usize| {
            let declared = &self.outputs[*it];
            declared.unit.base == unit::N.base && place(&declared.name, &declared.doc) == Some(Place::Strut)
        };
        let outputs: Vec<usize> = (0..self.outputs.len()).filter(of_strut).collect();
        match outputs[..] {
            [output] => Some(Force::Output(output)),
            _ => None,
        }
    }

    /// Outputs that depend on some inputs and on nothing else.
    fn at_once(&self) -> Vec<usize> {
        let is_input = |name: &String| self.inputs.iter().any(|it| it.name == *name);
        let follows = |output: &usize| {
            self.dependencies(*output).is_some_and(|all| !all.is_empty() && all.iter().all(is_input))
        };
        (0..self.outputs.len()).filter(follows).collect()
    }

    fn dependencies(&self, output: usize) -> Option<&[String]> {
        self.depends.get(output)?.as_deref()
    }
}

/// Variables of a unit, by their places in a list.
fn of_unit(declared: &[Declaration], unit: Unit) -> Vec<usize> {
    (0..declared.len()).filter(|it| declared[*it].unit.base == unit.base).collect()
}

/// Positions in m and velocities in m/s whose names go together, by their places in a list.
fn pairs(declared: &[Declaration]) -> Vec<(usize, usize)> {
    let velocities = of_unit(declared, unit::M_PER_S);
    let go = |position: usize, velocity: usize| {
        let name = |index: usize| declared[index].name.as_str();
        go_together((Quantity::Position, name(position)), (Quantity::Velocity, name(velocity)))
    };
    let mut pairs = Vec::new();
    for position in of_unit(declared, unit::M) {
        let fitting = velocities.iter().filter(|velocity| go(position, **velocity));
        pairs.extend(fitting.map(|velocity| (position, *velocity)));
    }
    pairs
}

/// The only motion that is called a strut's; without any, the only one that is not called another part's.
fn the_strut(motions: &[Motion]) -> Option<Motion> {
    let at = |place: Option<Place>| motions.iter().filter(move |it| it.place == place);
    let (mut named, mut plain) = (at(Some(Place::Strut)), at(None));
    match (named.next(), named.next(), plain.next(), plain.next()) {
        (Some(one), None, _, _) | (None, _, Some(one), None) => Some(*one),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn declared(name: &str, unit: Unit, doc: &str) -> Declaration {
        Declaration { doc: doc.into(), unit, start: 1.0, ..Declaration::named(name) }
    }

    /// A quarter car of another maker: a force moves its ends apart.
    pub(super) fn quarter() -> Declared {
        let some = |names: &[&str]| Some(names.iter().map(|it| (*it).to_owned()).collect());
        Declared {
            inputs: vec![declared("z_r", unit::M, "road"), declared("F_act", unit::N, "actuator")],
            outputs: vec![
                declared("a_s", unit::M_PER_S2, "acceleration of the body"),
                declared("z_rel", unit::M, "z_s - z_u"),
                declared("v_rel", unit::M_PER_S, ""),
                declared("z_u", unit::M, "position of the wheel"),
                declared("v_u", unit::M_PER_S, ""),
                declared("road_seen", unit::M, "road"),
            ],
            parameters: vec![
                declared("m_s", unit::KG, "sprung mass"),
                declared("m_u", unit::KG, "unsprung mass"),
                declared("k_s", unit::N_PER_M, ""),
                declared("d_s", unit::N_S_PER_M, ""),
                declared("k_t", unit::N_PER_M, ""),
                declared("g", unit::M_PER_S2, "gravity"),
                declared("strut.mass", unit::KG, "of a name that the library's strut has"),
            ],
            depends: vec![
                some(&["z_s", "v_s", "F_act"]),
                some(&["z_s", "z_u"]),
                some(&["v_s", "v_u"]),
                some(&["z_u"]),
                some(&["v_u"]),
                some(&["z_r"]),
            ],
            moved: [(1, vec![1.0, 2e-5, 1e-3, -1e-5, -1e-3, 0.0])].into(),
        }
    }

    fn names<'a>(of: &'a [Declaration], indices: &[usize]) -> Vec<&'a str> {
        indices.iter().map(|it| of[*it].name.as_str()).collect()
    }

    #[test]
    fn a_quarter_car_suggests_its_strut() {
        let quarter = quarter();
        let guess = quarter.guess();
        assert_eq!(names(&quarter.parameters, &guess.nominal), ["m_s", "m_u", "k_s", "d_s", "k_t"]);
        assert_eq!(names(&quarter.parameters, &guess.others), ["g", "strut.mass"]);
        assert_eq!(names(&quarter.outputs, &guess.at_once), ["road_seen"]);
        let strut = guess.strut.unwrap();
        let motion = [strut.motion.deflection, strut.motion.velocity];
        assert_eq!(names(&quarter.outputs, &motion), ["z_rel", "v_rel"]);
        // The force moves the ends apart: a strut that pulls them together is its negative.
        assert_eq!((strut.acts_on, strut.replaces), (Some((1, -1.0)), true));
        assert_eq!(strut.force, Force::Rates(2, 3));
    }

    #[test]
    fn what_is_not_clear_is_not_chosen() {
        let mut two = quarter();
        two.outputs[3].name = "susp.travel".into();
        two.outputs[4].name = "susp.speed".into();
        let guess = two.guess();
        assert_eq!((guess.motions.len(), guess.strut), (2, None));

        let mut springs = quarter();
        springs.parameters[4].name = "spring".into();
        springs.parameters[2].name = "coil".into();
        let guess = springs.guess();
        assert_eq!(
            guess.strut.map(|it| it.force),
            Some(Force::Rates(4, 3)),
            "the one that is called a spring"
        );

        let mut forces = quarter();
        forces.inputs.push(declared("F_body", unit::N, ""));
        forces.moved.insert(2, vec![1.0, 1e-5, 0.0, 0.0, 0.0, 0.0]);
        let guess = forces.guess();
        assert_eq!(guess.forces, [(1, Some(-1.0)), (2, Some(-1.0))]);
        assert_eq!(guess.strut.map(|it| (it.acts_on, it.replaces)), Some((None, false)));
    }

    #[test]
    fn a_force_that_shows_at_once_or_not_at_all_takes_no_strut() {
        let mut direct = quarter();
        direct.depends[2] = Some(vec!["v_s".into(), "F_act".into()]);
        assert_eq!(direct.guess().forces, []);
        let mut elsewhere = quarter();
        elsewhere.moved.insert(1, vec![0.0; 6]);
        assert_eq!(elsewhere.guess().forces, []);
        let mut untried = quarter();
        untried.moved.clear();
        assert_eq!(untried.guess().forces, [(1, None)]);
        assert_eq!(untried.guess().strut.map(|it| it.acts_on), Some(None));
    }

    #[test]
    fn a_tyre_s_spring_is_no_strut_s() {
        let mut tyre = quarter();
        tyre.parameters[4].doc = "stiffness of the tyre".into();
        tyre.parameters[2].name = "stiffness".into();
        tyre.parameters[3].name = "damping".into();
        assert_eq!(tyre.guess().strut.map(|it| it.force), Some(Force::Rates(2, 3)));
        tyre.parameters.remove(2);
        assert_eq!(tyre.guess().strut, None);
    }

    #[test]
    fn a_road_s_velocity_is_the_rate_of_its_position() {
        let mut road = quarter();
        assert_eq!(road.guess().input_rates, []);
        road.inputs.push(declared("v_r", unit::M_PER_S, ""));
        assert_eq!(road.guess().input_rates, [(2, 0)]);
        road.inputs.push(declared("x_r", unit::M, "another wheel's"));
        assert_eq!(road.guess().input_rates, []);
    }

    #[test]
    fn a_mass_of_zero_is_not_fitted() {
        let mut zero = quarter();
        zero.parameters[1].start = 0.0;
        let guess = zero.guess();
        assert!(!guess.nominal.contains(&1) && guess.others.contains(&1));
    }

    #[test]
    fn without_units_nothing_is_guessed() {
        let mut plain = quarter();
        for it in plain.inputs.iter_mut().chain(&mut plain.outputs).chain(&mut plain.parameters) {
            it.unit = unit::ANY;
        }
        let guess = plain.guess();
        assert_eq!((guess.nominal.len(), guess.motions.len(), guess.strut), (0, 0, None));
    }
}
