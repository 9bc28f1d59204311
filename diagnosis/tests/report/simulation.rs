//! A quarter car on a bumpy road, so that the samples' curves look like what a rig gives.

use strut_diagnosis::report::findings::{
    Binned, Coherence, Mark, Missing, Parity, Periodogram, PlaceLikelihood, Signal, Spectrum, Trace,
};

/// In seconds.
const STEP: f64 = 1e-3;

/// The signals of one run.
pub struct Run {
    pub body: Vec<f64>,
    pub wheel: Vec<f64>,
    pub deflection: Vec<f64>,
    pub speed: Vec<f64>,
}

/// Uniform noise between −1 and 1, the same at every run.
pub fn noise(index: usize) -> f64 {
    let mixed = (index as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ (mixed >> 31)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    (mixed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// The run of a car with this friction (N) and damping (N s/m) over `seconds`.
pub fn run(friction: f64, damping: f64, seconds: f64) -> Run {
    let (body_mass, wheel_mass, stiffness, tire) = (94.4, 15.0, 11_000.0, 110_000.0);
    let (mut x, mut v) = ([0.0; 2], [0.0; 2]);
    let count = (seconds / STEP) as usize;
    let mut run = Run { body: vec![], wheel: vec![], deflection: vec![], speed: vec![] };
    let mut road = 0.0;
    for index in 0..count {
        let time = index as f64 * STEP;
        let bump = if (time % 9.0) < 0.3 { 0.012 * (1.0 - (time % 9.0 * 20.944).cos()) } else { 0.0 };
        road += STEP * (0.35 * noise(index) - 0.6 * road);
        let waves = 0.004 * (7.0 * time).sin() + 0.0015 * (23.0 * time + 1.0).sin();
        let (travel, speed) = (x[0] - x[1], v[0] - v[1]);
        let strut = stiffness * travel + damping * speed + friction * (speed / 0.008).tanh();
        let accelerations =
            [-strut / body_mass, (strut + tire * (road + bump + waves - x[1]) - 60.0 * v[1]) / wheel_mass];
        for mass in 0..2 {
            v[mass] += STEP * accelerations[mass];
            x[mass] += STEP * v[mass];
        }
        run.body.push(accelerations[0]);
        run.wheel.push(accelerations[1]);
        run.deflection.push(travel);
        run.speed.push(speed);
    }
    run
}

/// A measured signal and what the starting, the fitted and the extended model make of it.
pub struct Comparison {
    pub name: &'static str,
    pub unit: &'static str,
    pub measured: Vec<f64>,
    pub start: Vec<f64>,
    pub fitted: Vec<f64>,
    pub extended: Vec<f64>,
    pub noise: f64,
}

/// Three signals of a car with a friction of 57 N and 40 dB of noise; the extended model leaves a little over.
pub fn comparisons(seconds: f64) -> Vec<Comparison> {
    let [truth, start, fitted, extended] = [(57.0, 420.0), (0.0, 600.0), (0.0, 640.0), (53.0, 440.0)]
        .map(|(force, damping)| run(force, damping, seconds));
    let pick = |name, unit, of: fn(&Run) -> &Vec<f64>| {
        let noise_floor = 0.01 * rms(of(&truth).iter().copied());
        let noisy = |(index, value): (usize, &f64)| value + 1.73 * noise_floor * noise(index + 99);
        Comparison {
            name,
            unit,
            measured: of(&truth).iter().enumerate().map(noisy).collect(),
            start: of(&start).clone(),
            fitted: of(&fitted).clone(),
            extended: of(&extended).clone(),
            noise: noise_floor,
        }
    };
    vec![
        pick("body.acceleration", "m/s2", |run| &run.body),
        pick("wheel.acceleration", "m/s2", |run| &run.wheel),
        pick("suspension.deflection", "m", |run| &run.deflection),
    ]
}

fn rms(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count() as f64;
    (values.map(|value| value * value).sum::<f64>() / count).sqrt()
}

impl Comparison {
    fn error(&self, simulated: &[f64]) -> f64 {
        rms(self.measured.iter().zip(simulated).map(|(measured, simulated)| measured - simulated))
    }

    pub fn signal(&self) -> Signal {
        let whole = rms(self.measured.iter().copied());
        let errors = [&self.start, &self.fitted, &self.extended].map(|simulated| self.error(simulated));
        let [fit_before, fit_fitted, fit_after] = errors.map(|error| 1.0 - error / whole);
        let [rms_before, rms_fitted, rms_after] = errors;
        Signal {
            name: self.name.into(),
            unit: self.unit.into(),
            fit_before,
            fit_fitted,
            fit_after,
            fit_without_input_noise: fit_after,
            rms_before,
            rms_fitted,
            rms_after,
            noise_floor: self.noise,
            repeatability: (self.name == "body.acceleration").then_some(1.4 * self.noise),
        }
    }

    pub fn trace(&self) -> Trace {
        Trace {
            signal: self.name.into(),
            unit: self.unit.into(),
            time: (0..self.measured.len()).map(|index| index as f64 * STEP).collect(),
            measured: self.measured.clone(),
            before: self.fitted.clone(),
            after: self.extended.clone(),
            marks: [
                ("largest error", 9.0, 9.5),
                ("largest error", 27.0, 27.5),
                ("rebound stop", 18.12, 18.2),
            ]
            .map(|(what, from, to)| Mark { what: what.into(), from, to })
            .into(),
        }
    }

    /// An error that the road drives below 10 Hz; nothing drives what the extended model leaves.
    pub fn coherence(&self) -> Coherence {
        let frequency: Vec<f64> = (1..60).map(|index| 0.5 * f64::from(index)).collect();
        let driven = |(index, f): (usize, &f64)| {
            (*f < 25.0).then(|| 0.9 / (1.0 + (f / 10.0).powi(4)) + 0.05 * noise(index))
        };
        Coherence {
            signal: self.name.into(),
            input: "road.position".into(),
            before: frequency.iter().enumerate().map(driven).collect(),
            after: (0..frequency.len())
                .map(|index| (index < 49).then(|| 0.06 + 0.05 * noise(index)))
                .collect(),
            frequency,
            limit: 0.17,
        }
    }

    pub fn periodogram(&self) -> Periodogram {
        let frequency: Vec<f64> = (1..200).map(f64::from).collect();
        Periodogram {
            signal: self.name.into(),
            before: frequency.iter().map(|f| 1.0 - (-f / 12.0).exp()).collect(),
            after: frequency.iter().map(|f| f / 199.0).collect(),
            frequency,
            distance_before: 0.8,
            distance_after: 0.015,
            limit: 0.021,
        }
    }

    pub fn spectrum(&self) -> Spectrum {
        let difference = |simulated: &[f64]| -> Vec<f64> {
            self.measured.iter().zip(simulated).map(|(measured, simulated)| measured - simulated).collect()
        };
        let frequency: Vec<f64> = (0..90).map(|index| 0.5 * 10_f64.powf(f64::from(index) / 36.0)).collect();
        Spectrum {
            signal: self.name.into(),
            unit: self.unit.into(),
            measured: density(&self.measured, &frequency),
            before: density(&difference(&self.fitted), &frequency),
            after: density(&difference(&self.extended), &frequency),
            frequency,
        }
    }
}

/// Power spectral density by Goertzel's sums over Hann windows of four seconds.
fn density(values: &[f64], frequency: &[f64]) -> Vec<f64> {
    let length = (4.0 / STEP) as usize;
    let one = |frequency: &f64| {
        let segments = values.chunks_exact(length.min(values.len()));
        let count = segments.len().max(1) as f64;
        let power = segments.map(|segment| {
            let (mut cosine, mut sine) = (0.0, 0.0);
            for (index, value) in segment.iter().enumerate() {
                let turn = std::f64::consts::TAU * index as f64;
                let window = 0.5 - 0.5 * (turn / segment.len() as f64).cos();
                cosine += window * value * (turn * STEP * frequency).cos();
                sine += window * value * (turn * STEP * frequency).sin();
            }
            (cosine * cosine + sine * sine) * 2.0 * STEP / (0.375 * segment.len() as f64)
        });
        power.sum::<f64>() / count
    };
    frequency.iter().map(one).collect()
}

/// Balances of a car with a friction of 57 N: one that shows it, one that cannot be formed.
pub fn balances() -> Vec<Parity> {
    let run = run(57.0, 420.0, 10.0);
    let force = |friction: f64| -> Vec<f64> {
        let noisy = |(index, v): (usize, &f64)| friction * (v / 0.008).tanh() + 2.0 * noise(index);
        run.speed.iter().step_by(6).enumerate().map(noisy).collect()
    };
    let formed = Parity {
        id: "r1".into(),
        name: "forces on the body".into(),
        equation: "m_s a_s + F_strut + F_guide - F_act".into(),
        meaning: "the strut has a law that the model lacks".into(),
        needs: None,
        unit: "N".into(),
        band: 30.0,
        rms_before: 54.3,
        rms_fitted: 54.2,
        rms_after: 1.6,
        noise: 1.2,
        time: (0..run.speed.len().div_ceil(6)).map(|index| index as f64 * 6.0 * STEP).collect(),
        before: force(57.0),
        after: force(0.4),
    };
    let unformed = Parity {
        id: "r4".into(),
        name: "kinematics".into(),
        needs: Some("the wheel’s acceleration".into()),
        time: vec![],
        before: vec![],
        after: vec![],
        rms_before: f64::NAN,
        rms_fitted: f64::NAN,
        rms_after: f64::NAN,
        noise: f64::NAN,
        ..formed.clone()
    };
    vec![formed, unformed]
}

/// The missing force of the car over its strut's speed or deflection.
pub fn binned(variable: &str, unit: &str, over: impl Fn(&Run, usize) -> f64) -> Binned {
    let run = run(57.0, 420.0, 30.0);
    let force = |index: usize| {
        57.0 * (run.speed[index] / 0.008).tanh() - 0.3 * 190.0 * run.speed[index] + 15.0 * noise(index)
    };
    let count = run.speed.len();
    let values: Vec<f64> = (0..count).map(|index| over(&run, index)).collect();
    let largest = 2.2 * rms(values.iter().copied());
    let bins = 31;
    let mut sums = vec![[(0.0, 0.0, 0.0); 2]; bins];
    for index in 1..count {
        let bin = ((values[index] / largest + 1.0) / 2.0 * bins as f64).floor();
        if (0.0..bins as f64).contains(&bin) {
            let sum = &mut sums[bin as usize][usize::from(values[index] < values[index - 1])];
            *sum = (sum.0 + 1.0, sum.1 + force(index), sum.2 + force(index).powi(2));
        }
    }
    let mean = |sum: &(f64, f64, f64)| (sum.0 > 40.0).then(|| sum.1 / sum.0);
    // One sample in fifty is independent of the others.
    let width = |sum: &(f64, f64, f64)| {
        mean(sum).map(|mean| 2.0 * ((sum.2 / sum.0 - mean * mean).max(0.0) / sum.0 * 50.0).sqrt())
    };
    Binned {
        quantity: "Force missing in the strut".into(),
        unit: "N".into(),
        variable: variable.into(),
        variable_unit: unit.into(),
        x: (0..bins).map(|bin| largest * ((bin as f64 + 0.5) / bins as f64 * 2.0 - 1.0)).collect(),
        rising: sums.iter().map(|[rising, _]| mean(rising)).collect(),
        falling: sums.iter().map(|[_, falling]| mean(falling)).collect(),
        two_sigma: sums.iter().map(|[rising, _]| width(rising)).collect(),
    }
}

/// The missing force of the car at its strut over ten seconds.
pub fn missing() -> Missing {
    let run = run(57.0, 420.0, 10.5);
    let samples = || (0..1500).map(|index| 7 * index);
    let force = |index: usize| 57.0 * (run.speed[index] / 0.008).tanh() + 6.0 * noise(index);
    let place =
        |(place, log_likelihood): (&str, f64)| PlaceLikelihood { place: place.into(), log_likelihood };
    Missing {
        place: "strut".into(),
        unit: "N".into(),
        equivalent_places: vec![],
        places: [
            ("strut", 2241.3),
            ("guide", 1712.8),
            ("tire", 690.2),
            ("body.acceleration", 112.0),
            ("wheel.acceleration", 61.5),
            ("suspension.deflection", 4.2),
        ]
        .map(place)
        .into(),
        time: samples().map(|index| index as f64 * STEP).collect(),
        value: samples().map(force).collect(),
        deviation: samples().map(|index| 4.0 + 2.0 * noise(index + 7).abs()).collect(),
        deflection: samples().map(|index| run.deflection[index]).collect(),
        velocity: samples().map(|index| run.speed[index]).collect(),
    }
}
