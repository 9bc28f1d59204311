//! Errors of the predictions by noise of measured inputs.
//!
//! A road that is measured with an error of 80 µm shakes a tyre of 200 kN/m with 16 N: as much as a small cause does. A smoother
//! with exact inputs would take that for a missing signal. So the remaining noise of the inputs adds to the variances of next states
//! and outputs.

use crate::dataset::recorded::Dataset;
use crate::estimation::unknowns::Estimate;

use super::trajectory::{Setting, Window};

/// Samples over which noise may have a memory.
const LAGS: usize = 100;

impl Setting<'_> {
    /// Adds the variances of next states and outputs by errors of the inputs, at a point with the laws of the window; `disturbed`
    /// is the window's record with such errors.
    pub fn roughen(&self, disturbed: &Dataset, window: &mut Window, point: &Estimate) {
        let drive = disturbed.drive(&window.samples, &point.inputs);
        let made = self.driven_otherwise(disturbed, window, &drive, point);
        add(&mut window.loose.0, &made.next, window.states);
        add(&mut window.loose.1, &made.outputs, window.outputs);
    }
}

/// Adds the variance of each signal's changes to what each of its samples has.
fn add(variances: &mut Vec<f64>, changes: &[f32], signals: usize) {
    variances.resize(changes.len(), 0.0);
    for signal in 0..signals {
        let own: Vec<f64> = changes.iter().skip(signal).step_by(signals).map(|it| f64::from(*it)).collect();
        let variance = as_if_white(&own);
        variances.iter_mut().skip(signal).step_by(signals).for_each(|it| *it += variance);
    }
}

/// Variance of white noise that is as uncertain as noise with a memory. Such noise has fewer independent samples: by the ratio of
/// the bandwidths, which is the sum of its squared autocorrelations
/// (M. S. Bartlett, Journal of the Royal Statistical Society 98 (1935)).
fn as_if_white(noise: &[f64]) -> f64 {
    let product =
        |lag: usize| -> f64 { noise.iter().zip(&noise[lag..]).map(|(now, later)| now * later).sum() };
    let power = product(0);
    if power == 0.0 {
        return 0.0;
    }
    let memory: f64 = (1..LAGS.min(noise.len())).map(|lag| (product(lag) / power).powi(2)).sum();
    power / noise.len() as f64 * (1.0 + 2.0 * memory)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::recorded::{Measured, Source};
    use crate::rig::Rig;
    use crate::signal::random::with_noise;

    #[test]
    fn noise_with_a_memory_has_fewer_independent_samples() {
        let white = with_noise(&[0.0; 20_000], 0.1, 3);
        let of_white = as_if_white(&white);
        assert!((of_white / 0.01 - 1.0).abs() < 0.05, "{of_white}");
        // A first-order recursion with a factor a: variance 1/(1 - a²), and (1 + a²)/(1 - a²) as few samples.
        let mut last = 0.0;
        let slow: Vec<f64> = white
            .iter()
            .map(|it| {
                last = 0.8 * last + it;
                last
            })
            .collect();
        let wanted = 0.01 / 0.36 * 1.64 / 0.36;
        let of_slow = as_if_white(&slow);
        assert!((of_slow / wanted - 1.0).abs() < 0.1, "{of_slow}, {wanted}");
        assert_eq!((as_if_white(&[]), as_if_white(&[0.0; 9])), (0.0, 0.0));
    }

    /// 50 µm on a tyre of k N/m: a force of 5e-5 k on the wheel and in the force cell below it.
    #[test]
    fn noise_of_a_road_shakes_the_wheel() {
        let rig = Rig::published("quarter-car").unwrap();
        let plant = &rig.plant;
        let dynamics = plant.prepare(&rig.choices).unwrap();
        let [road, rate] = ["road.position", "road.velocity"].map(|name| plant.input(name).unwrap());
        let samples = 2000;
        let inputs = (0..plant.inputs.len()).map(|input| match input {
            it if it == road => Source::Measured(vec![0.0; samples]),
            it if it == rate => Source::DerivativeOf(road),
            _ => Source::Constant(0.0),
        });
        let errors = |deviation: f64| {
            let of = |input| {
                if input == road { with_noise(&vec![0.0; samples], deviation, 5) } else { Vec::new() }
            };
            (0..plant.inputs.len()).map(of).collect::<Vec<_>>()
        };
        let measured = ["body.acceleration", "wheel.acceleration", "wheel.force"].map(|name| Measured {
            output: plant.output(name).unwrap(),
            values: vec![0.0; samples],
            noise_floor: 1e-3,
        });
        let step = 2.5e-3;
        let still = Dataset {
            step,
            inputs: inputs.collect(),
            errors: errors(0.0),
            measured: measured.to_vec(),
            sections: std::iter::once(0..samples).collect(),
            ..Dataset::default()
        };
        let point = Estimate::undistorted(plant, &rig.parameters);
        let nominal: Vec<f64> = plant.states.iter().map(|it| it.nominal.unwrap_or(1.0)).collect();
        let records = [Dataset { errors: errors(5e-5), ..still.clone() }];
        let setting = Setting::new(&*dynamics, (&point, &rig.start), &[], &[], &nominal, &records);
        let mut window = setting.window(&records, 0, 0..samples, &rig.start).unwrap();
        assert_eq!(still.disturbed(), None);
        setting.roughen(&records[0].disturbed().unwrap(), &mut window, &point);
        let value = |name: &str| rig.parameters[plant.parameter(name).unwrap()];
        let force = 5e-5 * value("tire.stiffness");
        let wheel = plant.state("wheel.velocity").unwrap();
        let place = setting.active.iter().position(|it| *it == wheel).unwrap();
        let kick = window.loose.0[place].sqrt();
        // Within a step the road goes straight from one error to the next: half of the variance, and neighbours share one, whose
        // correlation of a half makes it 1.5 times as much.
        let wanted = 0.75_f64.sqrt() * force * step / value("unsprung_mass");
        assert!((kick / wanted - 1.0).abs() < 0.05, "{kick} of {wanted}");
        let cell = window.loose.1[2].sqrt();
        assert!((cell / force - 1.0).abs() < 0.1, "{cell} of {force}");
        assert!(window.loose.1[0].sqrt() < 1e-6, "the body does not feel it at once");
    }
}
