//! What the report's pictures show.

use crate::catalogue::Element;
use crate::diagnosis::{Diagnosis, outputs};
use crate::findings::{Binned, Pictures, Spectrum, Trace};
use crate::recorded::derivative;
use crate::rig::Missing;

/// Seconds of a record that are shown.
const TRACE: f64 = 10.0;
/// Samples of a segment of a spectrum: a power of two.
const SEGMENT: usize = 2048;
/// Bins of a variable.
const BINS: usize = 24;
/// Samples that a bin needs.
const ENOUGH: usize = 10;

impl Diagnosis<'_> {
    pub(super) fn pictures(&self) -> Pictures {
        Pictures { traces: self.traces(), spectra: self.spectra(), scatters: self.scatters() }
    }

    fn traces(&self) -> Vec<Trace> {
        let Some(record) = self.world.test.first() else { return Vec::new() };
        let (base, extended) = (&self.found.base.test[0], &self.found.extended.test[0]);
        let rows = record.measured.iter().enumerate();
        rows.map(|(row, measured)| {
            let declared = &self.world.rig.plant.outputs[measured.output];
            let simulated = |residuals: &[f64]| -> Vec<f64> {
                measured.values.iter().zip(residuals).map(|(value, residual)| value - residual).collect()
            };
            let shown = measured.values.len().min((TRACE / record.step) as usize);
            let part = |mut values: Vec<f64>| {
                values.truncate(shown);
                values
            };
            Trace {
                signal: declared.name.clone(),
                unit: declared.unit.symbol.into(),
                time: (0..shown).map(|k| k as f64 * record.step).collect(),
                measured: part(measured.values.clone()),
                before: part(simulated(&base[row])),
                after: part(simulated(&extended[row])),
            }
        })
        .collect()
    }

    fn spectra(&self) -> Vec<Spectrum> {
        let Some(record) = self.world.test.first() else { return Vec::new() };
        let (base, extended) = (&self.found.base.test[0], &self.found.extended.test[0]);
        let rows = record.measured.iter().enumerate();
        rows.map(|(row, measured)| {
            let declared = &self.world.rig.plant.outputs[measured.output];
            let (frequency, of_measured) = power_spectrum(&measured.values, record.step);
            Spectrum {
                signal: declared.name.clone(),
                unit: declared.unit.symbol.into(),
                frequency,
                measured: of_measured,
                before: power_spectrum(&base[row], record.step).1,
                after: power_spectrum(&extended[row], record.step).1,
            }
        })
        .collect()
    }

    fn scatters(&self) -> Vec<Binned> {
        let all = outputs(&self.world, &self.found.base);
        let kind = self.world.rig.kind;
        let pairs = kind.missing.iter().flat_map(|missing| missing.over.iter().map(move |it| (missing, *it)));
        pairs
            .flat_map(|(missing, element)| {
                [false, true].map(|velocity| self.binned(missing, element, velocity, &all))
            })
            .flatten()
            .collect()
    }

    fn binned(
        &self,
        missing: &Missing,
        element: Element,
        over_velocity: bool,
        outputs: &[Vec<Vec<f64>>],
    ) -> Option<Binned> {
        let plant = &self.world.rig.plant;
        let signals = self.world.rig.kind.elements.iter().find(|it| it.element == element)?;
        let (output, position) = (plant.output(missing.output)?, plant.output(signals.deflection)?);
        let factor = match missing.factor {
            Some((name, sign)) => sign * self.found.base.point.parameters[plant.parameter(name)?],
            None => 1.0,
        };
        // Variable, its rate, force.
        let mut points: Vec<(f64, f64, f64)> = Vec::new();
        for ((record, residuals), outputs) in self.world.train.iter().zip(&self.found.base.train).zip(outputs)
        {
            let row = record.measured.iter().position(|it| it.output == output)?;
            let x = &outputs[position];
            let v = derivative(x, record.step);
            let (variable, rate) =
                if over_velocity { (v.clone(), derivative(&v, record.step)) } else { (x.clone(), v) };
            let known = residuals[row].iter().zip(variable).zip(rate).filter(|((e, _), _)| e.is_finite());
            points.extend(known.map(|((e, x), rate)| (x, rate, factor * e)));
        }
        let reach = points.iter().map(|(x, _, _)| x.abs()).fold(0.0, f64::max);
        if reach == 0.0 {
            return None;
        }
        let of = |rising: bool| -> Vec<Vec<f64>> {
            let mut bins = vec![Vec::new(); BINS];
            for (x, rate, force) in &points {
                if (*rate > 0.0) == rising {
                    let bin = ((x / reach + 1.0) * 0.5 * BINS as f64) as usize;
                    bins[bin.min(BINS - 1)].push(*force);
                }
            }
            bins
        };
        let (rising, falling) = (of(true), of(false));
        let mean = |bin: &Vec<f64>| (bin.len() >= ENOUGH).then(|| bin.iter().sum::<f64>() / bin.len() as f64);
        let two_sigma = rising.iter().zip(&falling).map(|(rising, falling)| {
            let n = rising.len().max(falling.len());
            let larger = if rising.len() >= falling.len() { rising } else { falling };
            let middle = mean(larger)?;
            let variance = larger.iter().map(|it| (it - middle).powi(2)).sum::<f64>() / n as f64;
            Some(2.0 * (variance / n as f64).sqrt())
        });
        Some(Binned {
            quantity: missing.quantity.into(),
            unit: "N".into(),
            variable: format!("{} {}", element.name(), if over_velocity { "velocity" } else { "deflection" }),
            variable_unit: if over_velocity { "m/s" } else { "m" }.into(),
            x: (0..BINS).map(|bin| reach * (2.0 * (bin as f64 + 0.5) / BINS as f64 - 1.0)).collect(),
            two_sigma: two_sigma.collect(),
            rising: rising.iter().map(mean).collect(),
            falling: falling.iter().map(mean).collect(),
        })
    }
}

/// Frequencies in hertz and power spectral density by Welch's method: Hann windows, half overlapping.
fn power_spectrum(signal: &[f64], step: f64) -> (Vec<f64>, Vec<f64>) {
    let known: Vec<f64> = signal.iter().map(|value| if value.is_finite() { *value } else { 0.0 }).collect();
    let mut length = SEGMENT;
    while length > known.len() && length > 2 {
        length /= 2;
    }
    let window: Vec<f64> =
        (0..length).map(|k| 0.5 - 0.5 * (std::f64::consts::TAU * k as f64 / length as f64).cos()).collect();
    let scale = step / window.iter().map(|w| w * w).sum::<f64>();
    let mut planner = rustfft::FftPlanner::new();
    let fft = planner.plan_fft_forward(length);
    let mut power = vec![0.0; length / 2];
    let mut segments = 0;
    let mut first = 0;
    while first + length <= known.len() {
        let part = &known[first..first + length];
        let mean = part.iter().sum::<f64>() / length as f64;
        let mut buffer: Vec<rustfft::num_complex::Complex<f64>> =
            part.iter().zip(&window).map(|(value, w)| ((value - mean) * w).into()).collect();
        fft.process(&mut buffer);
        for (sum, bin) in power.iter_mut().zip(&buffer) {
            *sum += 2.0 * scale * bin.norm_sqr();
        }
        segments += 1;
        first += length / 2;
    }
    power.iter_mut().for_each(|it| *it /= f64::from(segments.max(1)));
    let frequency = (1..length / 2).map(|k| k as f64 / (length as f64 * step)).collect();
    (frequency, power.split_off(1.min(power.len())))
}
