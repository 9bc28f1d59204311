//! How large the effects must be: what counts is what no other values of the rig's parameters show, too. A fit would take
//! the rest for them, and nobody could tell.

use super::Columns;
use super::excitations::Excitation;
use crate::case::{Case, Present, Value};
use crate::catalogue::{Drawn, Entry, Place, Role, Scale};
use crate::random::Random;
use crate::rig::{Rig, is_uncertain, signals, true_signal};
use crate::sensors::{rms, swing};

/// Finds how large the effects must be.
pub(super) struct Sizing<'a> {
    case: &'a Case,
    plain: &'a Rig,
    train: &'a [Excitation],
    /// What is seen in each record without clutter and effects.
    seen: Vec<Columns>,
    /// Largest deflection of the strut.
    deflection: f64,
    /// Largest travel of the wheel.
    travel: f64,
    /// Largest command.
    command: f64,
    /// The plain rig's parameters.
    base: &'a [Value],
    /// What the clutter of the plant changes; none without.
    clutter: Option<Change>,
    /// What each of the rig's parameters changes.
    parameters: Vec<(&'a Value, Change)>,
}

/// What is seen otherwise: differences over each record's columns, in units of the column's root mean square about rest.
type Change = Vec<Vec<f64>>;

/// Number of the effect that every tyre has.
const LIFT_OFF: &str = "20";
/// By which share a parameter is changed to see what it changes.
const SHARE: f64 = 0.01;

impl<'a> Sizing<'a> {
    /// Runs the plain rig, and the cluttered one.
    pub(super) fn new(case: &'a Case, plain: &'a Rig, base: &'a [Value], train: &'a [Excitation]) -> Self {
        let (seen, clutter, parameters) = (vec![], None, vec![]);
        let (deflection, travel, command) = (0.0, 0.0, 0.0);
        let mut sizing =
            Self { case, plain, train, seen, deflection, travel, command, base, clutter, parameters };
        let length = if case.plant.is_car() { "suspension.deflection" } else { "motion.position" };
        let most = |signal: &[f64]| signal.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for excitation in train {
            let motion = plain.run(&excitation.road, &excitation.command, case.reach(), excitation.name);
            sizing.deflection = sizing.deflection.max(most(&true_signal(case.plant, &motion, length)));
            sizing.travel = sizing.travel.max(most(&motion.wheel));
            sizing.command = sizing.command.max(most(&motion.command));
            sizing.seen.push(plain.measured(case, &motion, "sizing"));
        }
        if case.clutter > 0 && !case.effects.is_empty() {
            let of = |(number, value): (usize, &'a Value)| {
                let mut others = base.to_vec();
                others[number].value *= 1.0 + SHARE;
                let mut other = Rig::new(case.plant, &others);
                // The controller is the rig's own, whatever it moves.
                other.drive.control = plain.drive.control;
                (value, sizing.change(&other))
            };
            let uncertain = base.iter().enumerate().filter(|(_, value)| is_uncertain(value));
            let parameters = uncertain.map(of).collect();
            let mut cluttered = plain.clone();
            cluttered.clutter_plant(f64::from(case.clutter), &mut Random::new(case.seed, "clutter"));
            let clutter = Some(sizing.change(&cluttered));
            (sizing.parameters, sizing.clutter) = (parameters, clutter);
        }
        sizing
    }

    /// What is seen of another rig than the plain one.
    fn change(&self, rig: &Rig) -> Change {
        let records = self.train.iter().zip(&self.seen).flat_map(|(excitation, seen)| {
            let motion = rig.run(&excitation.road, &excitation.command, self.case.reach(), excitation.name);
            let measured = rig.measured(self.case, &motion, "sizing");
            let column = |((.., before), (.., after)): (&(_, _, Vec<f64>), &(_, _, Vec<f64>))| {
                let size = swing(before);
                let unit = if size > 0.0 { 1.0 / size } else { 0.0 };
                before.iter().zip(after).map(|(before, after)| (after - before) * unit).collect()
            };
            seen.iter().zip(&measured).map(column).collect::<Vec<_>>()
        });
        records.collect()
    }

    /// Orthonormal changes that span what the rig's parameters change, less those that the effect is one of.
    fn imitations(&self, entry: &Entry) -> Vec<Change> {
        let own = |value: &Value| {
            entry.parameters.iter().any(|it| it.name.trim_end_matches(".added") == value.table())
        };
        let mut span: Vec<Change> = Vec::new();
        for (_, change) in self.parameters.iter().filter(|(value, _)| !own(value)) {
            let mut rest = without(change, &span);
            let (all, size) = (product(change, change), product(&rest, &rest));
            // What depends on the others but for rounding is none of its own.
            if size > 1e-9 * all {
                rest.iter_mut().flatten().for_each(|value| *value /= size.sqrt());
                span.push(rest);
            }
        }
        span
    }

    /// The effect with this number in the case, its values and what it changes over what the clutter changes.
    pub(super) fn present(&self, number: usize) -> Result<(Present, Vec<f64>), String> {
        let hidden = &self.case.effects[number];
        let entry = Entry::find(&hidden.id)?;
        let drawn = entry.draw(&mut Random::new(self.case.seed, &format!("effect {number}: {}", hidden.id)));
        let seen = self.seen[0].iter().find(|column| column.0 == hidden.signal);
        let signal = seen.map_or(0.0, |column| swing(&column.2));
        let sized = |size: f64| -> Vec<f64> {
            let value = |(parameter, value): (&Drawn, &f64)| {
                let scale = match parameter.scale {
                    Scale::Unit => 1.0,
                    Scale::Deflection => self.deflection,
                    Scale::Travel => self.travel,
                    Scale::Command => self.command,
                    Scale::Base => {
                        let base = self.base.iter().find(|it| it.name == parameter.name);
                        base.map_or(0.0, |it| it.value)
                    }
                    Scale::Signal => signal,
                };
                scale * parameter.sized(*value, size)
            };
            entry.parameters.iter().zip(&drawn).map(value).collect()
        };
        let mut size = hidden.size;
        let mut ratio = None;
        let imitations = self.imitations(entry);
        let clutter = self.clutter.as_ref().map(|change| largest(&without(change, &imitations)));
        // Enlarged until it is seen enough; its bounds may end that before.
        for _ in 0..5 {
            let mut rig = self.plain.clone();
            rig.put_in(entry, &sized(size), &hidden.signal)?;
            // What leaves the road does so in the plain rig, too: there, the other one never does.
            rig.car.tire_is_glued = entry.id == LIFT_OFF;
            let Some(clutter) = clutter else { break };
            let changed = largest(&without(&self.change(&rig), &imitations));
            ratio = Some(changed / clutter);
            let missing = self.case.ratio * clutter / changed.max(1e-9);
            if missing <= 1.0 || entry.parameters.is_empty() {
                break;
            }
            size *= (1.1 * missing).clamp(1.1, 4.0);
        }
        let values = sized(size);
        // Where the model has no actuator, what one does is told as a fault of the command's signal.
        let bare = entry.place == Place::Actuator && !self.case.plant.is_car();
        let command = signals(self.case.plant, self.case.sensors)[1].0;
        let of_signal = bare || !hidden.signal.is_empty();
        let named = entry.parameters.iter().zip(&values).map(|(parameter, value)| {
            let unit = seen.map_or("", |column| column.1.as_str());
            let name = match parameter.name.split_once('.') {
                None if of_signal => format!("{}.{}", hidden.signal, parameter.name),
                Some((_, fault)) if bare => format!("{command}.{fault}"),
                _ => parameter.name.into(),
            };
            let scaled = parameter.scale == Scale::Signal;
            let unit = if scaled { format!("{unit}{}", parameter.unit) } else { parameter.unit.into() };
            // Of a signal's gain the change is told.
            let value = if of_signal && parameter.role == Role::AroundOne { value - 1.0 } else { *value };
            Value { name, unit, value }
        });
        let present = Present {
            id: entry.id.into(),
            name: entry.name.into(),
            place: entry.place,
            signal: hidden.signal.clone(),
            variable: entry.variable.into(),
            depends_on: entry.depends_on.iter().map(|word| (*word).to_owned()).collect(),
            parameters: named.collect(),
            ratio,
        };
        Ok((present, values))
    }
}

fn product(one: &Change, other: &Change) -> f64 {
    one.iter().flatten().zip(other.iter().flatten()).map(|(a, b)| a * b).sum()
}

/// A change less what it has of orthonormal ones.
fn without(change: &Change, span: &[Change]) -> Change {
    let mut rest = change.clone();
    for imitation in span {
        let share = product(&rest, imitation);
        for (value, imitated) in rest.iter_mut().flatten().zip(imitation.iter().flatten()) {
            *value -= share * imitated;
        }
    }
    rest
}

/// The root mean square in the record and the column that shows it best.
fn largest(change: &Change) -> f64 {
    change.iter().map(|column| rms(column)).fold(0.0, f64::max)
}
