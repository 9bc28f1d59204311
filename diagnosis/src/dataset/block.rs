//! Blocks of time over which errors and scores are summed: longer than the errors' memory, so that each is a witness of its own.

use crate::screening::rms;

use super::recorded::Dataset;

/// The shortest block in seconds: what suspensions and their sensors remember is over by then.
pub const SHORTEST: f64 = 0.5;
/// Blocks of a record at least: of one that swings less often, they are shorter than a swing.
const BLOCKS: usize = 8;

impl Dataset {
    /// Number of samples in a block: half a second, or of a slow machine half a swing of its fastest output. Errors of friction
    /// or of a curve last as long as a stroke.
    pub fn block(&self) -> usize {
        let outputs = 0..self.measured.len();
        let swing = outputs.map(|row| half_swing(&self.bent(row))).fold(f64::INFINITY, f64::min);
        let least = (SHORTEST / self.step).max(4.0);
        let longest = (self.len() as f64 / BLOCKS as f64).max(least);
        // Of no outputs at all, no swing is known.
        let samples = if swing.is_finite() { swing.clamp(least, longest) } else { least };
        samples.round() as usize
    }
}

/// Samples from one side to the other on the mean. A side is reached at the root mean square, which noise about zero is not.
fn half_swing(values: &[f64]) -> f64 {
    let side = rms(values);
    let mut sides = values.iter().filter(|it| it.abs() > side).map(|it| it.is_sign_positive());
    let Some(mut last) = sides.next() else { return f64::INFINITY };
    let mut swings = 1.0;
    for here in sides {
        if here != last {
            swings += 1.0;
        }
        last = here;
    }
    values.len() as f64 / swings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::recorded::Measured;

    fn record(step: f64, of: &[&dyn Fn(f64) -> f64]) -> Dataset {
        let values = |signal: &&dyn Fn(f64) -> f64| (0..4000).map(|k| signal(f64::from(k) * step)).collect();
        let measured = of.iter().map(|it| Measured { output: 0, values: values(it), noise_floor: 0.0 });
        Dataset {
            step,
            measured: measured.collect(),
            sections: std::iter::once(0..4000).collect(),
            ..Dataset::default()
        }
    }

    #[test]
    fn a_slow_machine_has_longer_blocks() {
        let swings = |frequency: f64| move |time: f64| (std::f64::consts::TAU * frequency * time).sin();
        let (slow, fast) = (swings(0.05), swings(5.0));
        assert_eq!(record(0.01, &[&fast]).block(), 50);
        // Two swings of twenty seconds: halves are of ten, and eight blocks of five is what there is room for.
        assert_eq!(record(0.01, &[&slow]).block(), 500);
        assert_eq!(record(0.05, &[&slow]).block(), 200);
        // One fast signal is enough, and a slow offset beneath it does no harm.
        assert_eq!(record(0.05, &[&slow, &fast]).block(), 10);
        assert_eq!(record(0.01, &[&|time| 20.0 * time + fast(time)]).block(), 50);
        assert_eq!(record(0.01, &[]).block(), 50);
        assert!(half_swing(&[0.0; 3]).is_infinite());
    }
}
