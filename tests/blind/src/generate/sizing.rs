//! How large the effects must be.

use super::Columns;
use super::excitations::Excitation;
use crate::case::{Case, Present, Value};
use crate::catalogue::{Drawn, Entry, Scale};
use crate::random::Random;
use crate::rig::{Rig, difference, true_signal};
use crate::sensors::rms;

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
    /// What the clutter of the plant changes.
    clutter: f64,
}

impl<'a> Sizing<'a> {
    /// Runs the plain rig, and the cluttered one.
    pub(super) fn new(case: &'a Case, plain: &'a Rig, base: &'a [Value], train: &'a [Excitation]) -> Self {
        let (seen, clutter) = (vec![], 0.0);
        let (deflection, travel, command) = (0.0, 0.0, 0.0);
        let mut sizing = Self { case, plain, train, seen, deflection, travel, command, base, clutter };
        let length = if case.plant.is_car() { "suspension.deflection" } else { "motion.position" };
        let most = |signal: &[f64]| signal.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for excitation in train {
            let motion = plain.run(&excitation.road, &excitation.command, case.reach());
            sizing.deflection = sizing.deflection.max(most(&true_signal(case.plant, &motion, length)));
            sizing.travel = sizing.travel.max(most(&motion.wheel));
            sizing.command = sizing.command.max(most(&motion.command));
            sizing.seen.push(plain.measured(case, &motion, "sizing"));
        }
        if case.clutter > 0 && !case.effects.is_empty() {
            let mut cluttered = plain.clone();
            cluttered.clutter_plant(f64::from(case.clutter), &mut Random::new(case.seed, "clutter"));
            sizing.clutter = sizing.changed(&cluttered);
        }
        sizing
    }

    /// What another rig than the plain one changes, in the record that shows it best.
    fn changed(&self, rig: &Rig) -> f64 {
        self.train.iter().zip(&self.seen).fold(0.0, |most: f64, (excitation, seen)| {
            let motion = rig.run(&excitation.road, &excitation.command, self.case.reach());
            most.max(difference(seen, &rig.measured(self.case, &motion, "sizing")))
        })
    }

    /// The effect with this number in the case, its values and what it changes over what the clutter changes.
    pub(super) fn present(&self, number: usize) -> Result<(Present, Vec<f64>), String> {
        let hidden = &self.case.effects[number];
        let entry = Entry::find(&hidden.id)?;
        let drawn = entry.draw(&mut Random::new(self.case.seed, &format!("effect {number}: {}", hidden.id)));
        let seen = self.seen[0].iter().find(|column| column.0 == hidden.signal);
        let signal = seen.map_or(0.0, |column| rms(&column.2));
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
        // Enlarged until it is seen enough; its bounds may end that before.
        for _ in 0..5 {
            let mut rig = self.plain.clone();
            rig.put_in(entry, &sized(size), &hidden.signal)?;
            if self.clutter == 0.0 {
                break;
            }
            let changed = self.changed(&rig);
            ratio = Some(changed / self.clutter);
            let missing = self.case.ratio * self.clutter / changed.max(1e-9);
            if missing <= 1.0 || entry.parameters.is_empty() {
                break;
            }
            size *= (1.1 * missing).clamp(1.1, 4.0);
        }
        let values = sized(size);
        let of_sensor = !hidden.signal.is_empty();
        let named = entry.parameters.iter().zip(&values).map(|(parameter, value)| {
            let unit = seen.map_or("", |column| column.1.as_str());
            let name = if of_sensor && !parameter.name.contains('.') {
                format!("{}.{}", hidden.signal, parameter.name)
            } else {
                parameter.name.into()
            };
            let scaled = parameter.scale == Scale::Signal;
            let unit = if scaled { format!("{unit}{}", parameter.unit) } else { parameter.unit.into() };
            Value { name, unit, value: *value }
        });
        let present = Present {
            id: entry.id.into(),
            name: entry.name.into(),
            place: entry.place,
            signal: hidden.signal.clone(),
            variable: entry.variable.into(),
            parameters: named.collect(),
            ratio,
        };
        Ok((present, values))
    }
}
