//! Where in a trace something is to be seen: the largest errors, and what acts beyond a threshold only.

use strut_model::Value;
use strut_physics::GRAVITY;

use crate::catalogue::{self, LIFT_OFF};
use crate::dataset::recorded::Dataset;
use crate::diagnosis::{Diagnosis, simulated};
use crate::report::findings::{LARGEST, Mark};
use crate::signal::derivative;

use super::shown;

/// Blocks that are marked for their error.
const BLOCKS: usize = 3;
/// Time in seconds within which an element that acts again is still at it.
const PAUSE: f64 = 0.02;
/// Share of the static load below which a wheel that has left the road presses on it, by rounding.
const ROUNDING: f64 = 1e-9;

/// The blocks with the largest errors, in the order of time.
pub(super) fn largest(errors: &[f64], record: &Dataset) -> Vec<Mark> {
    let length = record.block();
    let power = |block: &[f64]| block.iter().filter(|it| it.is_finite()).map(|it| it * it).sum::<f64>();
    let mut blocks: Vec<(usize, f64)> = errors.chunks_exact(length).map(power).enumerate().collect();
    // A record of few blocks is as good as marked everywhere.
    if blocks.len() < 2 * BLOCKS {
        return Vec::new();
    }
    blocks.sort_by(|a, b| b.1.total_cmp(&a.1));
    blocks.truncate(BLOCKS);
    blocks.sort_by_key(|(block, _)| *block);
    let time = |block: usize| (block * length) as f64 * record.step;
    let mark = |(block, _)| Mark { what: LARGEST.into(), from: time(block), to: time(block + 1) };
    blocks.into_iter().map(mark).collect()
}

impl Diagnosis<'_> {
    /// Where in what is shown the extended model is beyond a threshold that it has.
    pub(super) fn active(&self) -> Vec<Mark> {
        let (baseline, extended) = (&self.baseline, &self.found.extended);
        let (rig, parameters) = (baseline.rig, &extended.point.parameters);
        let Some(record) = baseline.test.first() else { return Vec::new() };
        let Ok(dynamics) = baseline.dynamics(&extended.terms) else { return Vec::new() };
        let point = baseline.held_out_point(&*dynamics, &extended.point);
        let simulated = simulated(baseline, &extended.terms, &point, baseline.test);
        let Some(signals) = simulated.first() else { return Vec::new() };
        let signal = |name: &str| Some(&signals[rig.plant.output(name)?][..shown(record)]);
        let parameter = |name: &str| Some(parameters[rig.plant.parameter(name)?]);
        let mut marks = Vec::new();
        if let Some(x) = signal("suspension.deflection").or_else(|| signal("deflection")) {
            let v = derivative(x, record.step);
            let acting = catalogue::effects(&rig.plant).filter(|effect| {
                effect
                    .parts
                    .first()
                    .and_then(|amount| parameter(amount.parameter))
                    .is_some_and(|it| it != 0.0)
            });
            for part in acting.flat_map(|effect| effect.parts) {
                if let (Some(beyond), Some(threshold)) = (part.beyond, parameter(part.parameter)) {
                    let passed = |(x, v): (&f64, &f64)| beyond.is_passed(*x, *v, threshold);
                    marks.extend(stretches(beyond.name(), x.iter().zip(&v).map(passed), record.step));
                }
            }
        }
        let lifts = rig
            .plant
            .setting(LIFT_OFF)
            .is_some_and(|index| baseline.choices(&extended.terms)[index] == Value::Boolean(true));
        if let (true, Some(force), Some(body), Some(wheel)) =
            (lifts, signal("wheel.force"), parameter("sprung_mass"), parameter("unsprung_mass"))
        {
            let lifted = -(body + wheel) * GRAVITY * (1.0 - ROUNDING);
            let in_the_air = force.iter().map(|force| *force <= lifted);
            marks.extend(stretches("wheel off the road", in_the_air, record.step));
        }
        marks
    }
}

/// The stretches of time in which something is so, short pauses included.
fn stretches(what: &str, so: impl Iterator<Item = bool>, step: f64) -> Vec<Mark> {
    let mut marks: Vec<Mark> = Vec::new();
    for (sample, _) in so.enumerate().filter(|(_, so)| *so) {
        let (from, to) = (sample as f64 * step, (sample + 1) as f64 * step);
        match marks.last_mut() {
            Some(last) if from - last.to < PAUSE => last.to = to,
            _ => marks.push(Mark { what: what.into(), from, to }),
        }
    }
    marks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_blocks_are_marked_in_the_order_of_time() {
        let record = Dataset { step: 0.01, sections: vec![], ..Dataset::default() };
        // Blocks of fifty samples; missing samples do not count.
        let mut errors = vec![0.1; 1000];
        (errors[820], errors[130], errors[470], errors[10]) = (9.0, 5.0, -7.0, f64::NAN);
        let marks = largest(&errors, &record);
        let times: Vec<(f64, f64)> = marks.iter().map(|mark| (mark.from, mark.to)).collect();
        assert_eq!(times, [(1.0, 1.5), (4.5, 5.0), (8.0, 8.5)]);
        assert!(largest(&errors[..250], &record).is_empty());
    }

    #[test]
    fn short_pauses_do_not_end_a_stretch() {
        let so = "..xx.x......x..".chars().map(|c| c == 'x');
        let marks = stretches("stop", so, 0.01);
        let times: Vec<[i32; 2]> =
            marks.iter().map(|mark| [mark.from, mark.to].map(|it| (100.0 * it).round() as i32)).collect();
        assert_eq!(times, [[2, 6], [12, 13]]);
    }
}
