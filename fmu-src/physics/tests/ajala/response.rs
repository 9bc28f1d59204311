//! Frequency responses, measured.

use std::f64::consts::{PI, TAU};

use super::system::System;

/// Length of a period of the excitation in seconds: lines are 0.1 Hz apart.
const PERIOD: f64 = 10.0;
/// A number of the complex plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Complex {
    pub re: f64,
    pub im: f64,
}

impl Complex {
    pub fn magnitude(self) -> f64 {
        self.re.hypot(self.im)
    }
    pub fn times(self, other: Self) -> Self {
        Self { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }
    pub fn over(self, other: Self) -> Self {
        let size = other.re.powi(2) + other.im.powi(2);
        self.times(Self { re: other.re / size, im: -other.im / size })
    }
    pub fn less(self, other: Self) -> Self {
        Self { re: self.re - other.re, im: self.im - other.im }
    }
}

/// The part of a frequency in whole periods of samples, the first being at time `start`.
pub fn part(samples: &[f64], start: f64, step: f64, frequency: f64) -> Complex {
    let mut sum = Complex { re: 0.0, im: 0.0 };
    for (k, sample) in samples.iter().enumerate() {
        let (sine, cosine) = (TAU * frequency * (start + k as f64 * step)).sin_cos();
        sum.re += sample * cosine;
        sum.im -= sample * sine;
    }
    let scale = 2.0 / samples.len() as f64;
    Complex { re: scale * sum.re, im: scale * sum.im }
}

/// Magnitudes of the response of outputs to one input, line by line.
pub struct Response {
    lines: Vec<f64>,
    magnitudes: Vec<Vec<f64>>,
}

impl Response {
    /// Excites `input` by sines at every tenth of a hertz from 0.3 to 25 Hz, all of one amplitude, and looks at one
    /// period after some for settling.
    pub fn measured(
        system: &mut System,
        settling: usize,
        input: &str,
        amplitude: f64,
        outputs: &[&str],
    ) -> Self {
        let step = system.step;
        let lines: Vec<f64> = (3..=250).map(|tenths| f64::from(tenths) / PERIOD).collect();
        let samples = (PERIOD / step).round() as usize;
        let excitation: Vec<f64> = (0..samples)
            .map(|k| {
                // Phases by Schroeder: no peak stands out.
                let phase = |i: usize| PI * (i * i) as f64 / lines.len() as f64;
                let sum = |(i, line): (usize, &f64)| (TAU * line * k as f64 * step - phase(i)).sin();
                amplitude * lines.iter().enumerate().map(sum).sum::<f64>()
            })
            .collect();
        let mut seen = vec![Vec::with_capacity(samples); outputs.len()];
        for period in 0..=settling {
            for value in &excitation {
                system.set(input, *value);
                system.advance();
                if period == settling {
                    for (output, seen) in outputs.iter().zip(&mut seen) {
                        seen.push(system.get(output));
                    }
                }
            }
        }
        let magnitude = |seen: &[f64], line: f64| part(seen, 0.0, step, line).magnitude() / amplitude;
        let magnitudes = seen.iter().map(|seen| lines.iter().map(|&line| magnitude(seen, line)).collect());
        Self { magnitudes: magnitudes.collect(), lines }
    }

    /// Magnitude of an output at a line.
    pub fn at(&self, output: usize, frequency: f64) -> f64 {
        let line = self.lines.iter().position(|line| (line - frequency).abs() < 1e-6).expect("a line");
        self.magnitudes[output][line]
    }

    /// Frequency and magnitude of the largest value in a band.
    pub fn largest(&self, output: usize, low: f64, high: f64) -> (f64, f64) {
        let band = self.lines.iter().zip(&self.magnitudes[output]);
        band.filter(|(line, _)| (low..=high).contains(*line)).fold(
            (0.0, 0.0),
            |largest, (line, magnitude)| if *magnitude > largest.1 { (*line, *magnitude) } else { largest },
        )
    }

    /// Frequencies of the maxima inside a band.
    pub fn peaks(&self, output: usize, low: f64, high: f64) -> Vec<f64> {
        let values = &self.magnitudes[output];
        (1..values.len() - 1)
            .filter(|&i| {
                (low..=high).contains(&self.lines[i])
                    && values[i] > values[i - 1]
                    && values[i] > values[i + 1]
            })
            .map(|i| self.lines[i])
            .collect()
    }
}
