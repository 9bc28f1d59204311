//! The experiment that separates rivals, as it is reported.

use crate::catalogue::naming::name;
use crate::diagnosis::Diagnosis;
use crate::experiment::{Contest, Rival, Separation, Trial, Wave, files};
use crate::report::findings::{
    DecidingExperiment, Distinction, Drive, ExperimentLimit, Findings, Setting, SourceFmu, Value,
};
use crate::report::words::experiment;

impl Findings {
    /// Takes an experiment that was computed in the place of the catalogue's advice.
    pub fn decide(&mut self, deciding: DecidingExperiment) {
        self.experiment = Some(experiment(self, &deciding));
        self.deciding_experiment = Some(deciding);
    }
}

impl Diagnosis<'_> {
    /// What is reported of the experiment that was computed.
    pub(crate) fn told(
        &self,
        contest: &Contest<'_>,
        compared: usize,
        best: Option<&Trial>,
    ) -> DecidingExperiment {
        let rig = self.baseline.rig;
        let of_rival = |(number, (rival, present)): (usize, (&Rival, Separation))| {
            let expected = best.map_or(Separation::default(), |it| it.separations[number]);
            Distinction {
                effect: name(rival.in_place_of, &rig.plant).short(),
                rival: name(rival.term, &rig.plant).short(),
                distance: expected.distance,
                probability: expected.probability(),
                excess: expected.excess,
                decides: expected.decides(),
                recorded: present.distance,
            }
        };
        let pairs = contest.rivals().iter().zip(contest.present()).enumerate().map(of_rival);
        let pairs: Vec<Distinction> = pairs.collect();
        let decides = pairs.iter().any(|it| it.decides);
        let duration = contest.bounds.duration;
        let shown = best.filter(|_| decides);
        let step = self.measured.first().map_or(contest.step(), |it| it.step);
        DecidingExperiment {
            decides,
            compared,
            duration,
            drives: shown.map_or(Vec::new(), |it| {
                it.excitation.waves.iter().map(|it| self.drive(it, duration)).collect()
            }),
            limits: self.limits(contest, shown),
            pairs,
            files: shown.map_or(Vec::new(), |it| files(rig, &it.excitation, step, duration)),
        }
    }

    fn drive(&self, wave: &Wave, duration: f64) -> Drive {
        let declared = &self.baseline.rig.plant.inputs[wave.input];
        let unit = declared.unit.symbol;
        let (frequency, to) = wave.shape.frequencies();
        let source = wave.shape.source((wave.amplitude, declared.start), unit, duration);
        let source = source.map(|it| SourceFmu {
            fmu: it.fmu.into(),
            settings: it
                .settings
                .into_iter()
                .map(|(name, choice)| Setting { name: name.into(), choice })
                .collect(),
            parameters: it
                .parameters
                .into_iter()
                .map(|(name, value, unit)| Value { name: name.into(), value, unit })
                .collect(),
            adapter: it.adapter,
        });
        Drive {
            input: declared.name.clone(),
            unit: unit.into(),
            shape: wave.shape.name().into(),
            amplitude: wave.amplitude,
            frequency,
            last_frequency: to,
            source,
        }
    }

    /// Every limit, and how much of it the experiment takes.
    fn limits(&self, contest: &Contest<'_>, best: Option<&Trial>) -> Vec<ExperimentLimit> {
        let plant = &self.baseline.rig.plant;
        let outputs =
            contest.bounds.outputs.iter().enumerate().map(|(number, (output, limit))| ExperimentLimit {
                signal: plant.outputs[*output].name.clone(),
                unit: plant.outputs[*output].unit.symbol.into(),
                limit: *limit,
                reached: best.map(|it| it.reached[number]),
            });
        let inputs = contest.bounds.inputs.iter().flat_map(|bound| {
            let declared = &plant.inputs[bound.input];
            let signal = best.map(|it| {
                let step = contest.step();
                let count = (contest.bounds.duration / step) as usize;
                let signal = it.excitation.signal(self.baseline.rig, bound.input, step, count);
                let largest = signal.iter().fold(0.0_f64, |most, it| most.max((it - declared.start).abs()));
                let rate = signal.windows(2).map(|it| (it[1] - it[0]).abs() / step).fold(0.0, f64::max);
                (largest, rate)
            });
            let unit = declared.unit.symbol;
            [
                ExperimentLimit {
                    signal: declared.name.clone(),
                    unit: unit.into(),
                    limit: bound.amplitude,
                    reached: signal.map(|it| it.0),
                },
                ExperimentLimit {
                    signal: format!("rate of {}", declared.name),
                    unit: format!("{unit}/s"),
                    limit: bound.rate,
                    reached: signal.map(|it| it.1),
                },
            ]
        });
        outputs.chain(inputs).collect()
    }
}
