//! Elements of which a model has several alike: parameters that are changed at all of them at once.
//!
//! A joint parameter is added to those of its members: `strut.front.coulomb.force` to that of both front struts. Where it has
//! its start value it changes nothing, and its derivative is the sum of its members'.

use std::ops::Range;
use std::sync::Arc;

use strut_model::Declaration;

use crate::{Drive, Dynamics, Follower, Linearised, Plant, Seed, Seen, Signals};

/// Name of all places of an element together.
pub const ALL: &str = "all";

/// Several elements of one kind, or one of them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Instance {
    /// The group of parameters: `strut`.
    pub group: String,
    /// The place, or the common name of several: `front_left`, `front`, `all`.
    pub place: String,
    /// Several places; empty if it is one.
    pub of: Vec<String>,
}

/// A parameter that stands for several.
#[derive(Clone, Debug)]
pub(super) struct Joint {
    start: f64,
    members: Vec<usize>,
}

impl Instance {
    /// Those of a group at these places: each of them, those that share the first word of their names, and all together.
    pub fn of(group: &str, places: &[&str]) -> Vec<Self> {
        let instance = |place: &str, of: Vec<&str>| Self {
            group: group.to_owned(),
            place: place.to_owned(),
            of: of.into_iter().map(str::to_owned).collect(),
        };
        let mut all: Vec<Self> = places.iter().map(|place| instance(place, Vec::new())).collect();
        let first = |place: &str| Some(place.split_once('_')?.0.to_owned());
        for word in places.iter().filter_map(|place| first(place)) {
            let has_it = |place: &&str| first(place).as_ref() == Some(&word);
            let shared: Vec<&str> = places.iter().copied().filter(has_it).collect();
            let is_new = all.iter().all(|it| it.place != word);
            if (2..places.len()).contains(&shared.len()) && is_new {
                all.push(instance(&word, shared));
            }
        }
        if places.len() > 1 && !places.contains(&ALL) {
            all.push(instance(ALL, places.to_vec()));
        }
        all
    }

    /// Whether it stands for several places.
    pub fn is_joint(&self) -> bool {
        !self.of.is_empty()
    }
}

/// The name of a parameter at a place: `strut.coulomb.force` is `strut.front_left.coulomb.force` there.
pub fn placed(parameter: &str, place: &str) -> String {
    match parameter.split_once('.') {
        Some((group, rest)) => format!("{group}.{place}.{rest}"),
        None => format!("{parameter}.{place}"),
    }
}

impl Plant {
    /// The same with joint parameters of these instances, behind its own.
    #[must_use]
    pub fn with_instances(self, instances: Vec<Instance>) -> Self {
        let (mut joints, mut declared) = (Vec::new(), Vec::<Declaration>::new());
        for instance in instances.iter().filter(|it| it.is_joint()) {
            let first = format!("{}.{}.", instance.group, instance.of[0]);
            for (index, parameter) in self.parameters.iter().enumerate() {
                let Some(rest) = parameter.name.strip_prefix(&first) else { continue };
                let member = |place: &String| self.parameter(&format!("{}.{place}.{rest}", instance.group));
                let Some(members) = instance.of.iter().map(member).collect::<Option<Vec<usize>>>() else {
                    continue;
                };
                let name = format!("{}.{}.{rest}", instance.group, instance.place);
                let doc = common(members.iter().map(|it| self.parameters[*it].doc.as_str()));
                // A constant is missing at one place, not at several at once.
                declared.push(Declaration { name, doc, port: false, ..parameter.clone() });
                joints.push(Joint { start: self.parameters[index].start, members });
            }
        }
        if joints.is_empty() {
            return Self { instances, ..self };
        }
        let (joints, inner): (Arc<[Joint]>, _) = (joints.into(), self.prepare);
        Self {
            parameters: self.parameters.into_iter().chain(declared).collect(),
            instances,
            joints: joints.clone(),
            prepare: Arc::new(move |choices| {
                Ok(Box::new(Together { inner: inner(choices)?, joints: joints.clone() }))
            }),
            ..self
        }
    }
}

/// The common parts of descriptions: `Strut: Front left: Damping rate` and that of the front right are of `Strut: Damping rate`.
fn common<'a>(docs: impl Iterator<Item = &'a str>) -> String {
    let all: Vec<Vec<&str>> = docs.map(|doc| doc.split(": ").collect()).collect();
    let first = all.first().cloned().unwrap_or_default();
    let alike = |(part, text): &(usize, &str)| all.iter().all(|doc| doc.get(*part) == Some(text));
    let parts: Vec<&str> = first.into_iter().enumerate().filter(alike).map(|(_, text)| text).collect();
    parts.join(": ")
}

/// The model's own parameters with what joint ones add, which are the last.
pub(super) fn own(joints: &[Joint], parameters: &[f64]) -> Vec<f64> {
    let (own, behind) = parameters.split_at(parameters.len() - joints.len());
    let mut all = own.to_vec();
    for (joint, value) in joints.iter().zip(behind) {
        joint.members.iter().for_each(|member| all[*member] += value - joint.start);
    }
    all
}

/// Equations whose joint parameters are added to their members.
struct Together {
    inner: Box<dyn Dynamics>,
    joints: Arc<[Joint]>,
}

impl Together {
    /// The joint parameter of a seed; `parameters` is the number of all parameters.
    fn joint(&self, seed: &Seed, parameters: usize) -> Option<&Joint> {
        let Seed::Parameter(index) = seed else { return None };
        self.joints.get(index.checked_sub(parameters - self.joints.len())?)
    }

    /// Seeds of the model's own, with the range of each seed's members, where a joint parameter is among them.
    fn members(&self, seeds: &[Seed], parameters: usize) -> Option<(Vec<Seed>, Vec<Range<usize>>)> {
        if seeds.iter().all(|seed| self.joint(seed, parameters).is_none()) {
            return None;
        }
        let (mut all, mut ranges) = (Vec::new(), Vec::new());
        for seed in seeds {
            let first = all.len();
            match self.joint(seed, parameters) {
                Some(joint) => all.extend(joint.members.iter().map(|it| Seed::Parameter(*it))),
                None => all.push(seed.clone()),
            }
            ranges.push(first..all.len());
        }
        Some((all, ranges))
    }
}

impl Dynamics for Together {
    fn outputs(&self, parameters: &[f64], start: &[f64], drive: &Drive) -> Signals {
        self.inner.outputs(&own(&self.joints, parameters), start, drive)
    }

    fn linearised(
        &self,
        parameters: &[f64],
        start: &[f64],
        drive: &Drive,
        seeds: &[Seed],
        wanted: &[usize],
    ) -> Linearised {
        let numbers = own(&self.joints, parameters);
        let Some((members, ranges)) = self.members(seeds, parameters.len()) else {
            return self.inner.linearised(&numbers, start, drive, seeds, wanted);
        };
        let mut all = self.inner.linearised(&numbers, start, drive, &members, wanted);
        let mut own = std::mem::take(&mut all.slopes).into_iter();
        all.slopes = ranges
            .into_iter()
            .map(|range| {
                let mut sum = own.next().unwrap_or_default();
                for more in own.by_ref().take(range.len() - 1) {
                    for (sum, more) in sum.iter_mut().flatten().zip(more.into_iter().flatten()) {
                        *sum += more;
                    }
                }
                sum
            })
            .collect();
        all
    }

    fn followed(
        &self,
        parameters: &[f64],
        start: &[f64],
        drive: &Drive,
        (seeds, wanted): (&[Seed], &[usize]),
        follower: &mut dyn Follower,
    ) {
        let numbers = own(&self.joints, parameters);
        let Some((members, ranges)) = self.members(seeds, parameters.len()) else {
            return self.inner.followed(&numbers, start, drive, (seeds, wanted), follower);
        };
        let mut summed = Summed { follower, ranges, members: members.len(), slopes: Vec::new() };
        self.inner.followed(&numbers, start, drive, (&members, wanted), &mut summed);
    }

    fn check(&self, parameters: &[f64]) -> Result<(), String> {
        self.inner.check(&own(&self.joints, parameters))
    }
}

/// Hands the slopes of joint parameters on, the sums of their members'.
struct Summed<'a> {
    follower: &'a mut dyn Follower,
    ranges: Vec<Range<usize>>,
    members: usize,
    slopes: Vec<f64>,
}

impl Summed<'_> {
    fn sum(&mut self, slopes: &[f64]) {
        self.slopes.clear();
        for row in slopes.chunks(self.members) {
            self.slopes.extend(self.ranges.iter().map(|range| row[range.clone()].iter().sum::<f64>()));
        }
    }
}

impl Follower for Summed<'_> {
    fn given(&self) -> Option<&[usize]> {
        self.follower.given()
    }

    fn state(&mut self, sample: usize, state: &mut [f64]) {
        self.follower.state(sample, state);
    }

    fn seen(&mut self, sample: usize, seen: Seen<'_>, state: &mut [f64]) {
        self.sum(seen.slopes);
        self.follower.seen(sample, Seen { slopes: &self.slopes, ..seen }, state);
    }

    fn advanced(&mut self, sample: usize, state: &[f64], slopes: &[f64]) {
        self.sum(slopes);
        self.follower.advanced(sample, state, &self.slopes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strut_physics::rigs::FullCar;

    /// A car with its struts together, a drive over one wheel, and parameters with friction at both front struts.
    fn car() -> (Plant, Drive, Vec<f64>) {
        let places = ["front_left", "front_right", "rear_left", "rear_right"];
        let plant = Plant::of::<FullCar>().with_instances(Instance::of("strut", &places));
        let mut inputs: Vec<Vec<f64>> = std::iter::repeat_n(vec![0.0; 200], plant.inputs.len()).collect();
        inputs[0] = (0..200).map(|k| 0.01 * (0.1 * f64::from(k)).sin()).collect();
        let drive = Drive::sampled(2e-3, inputs);
        let mut parameters: Vec<f64> = plant.parameters.iter().map(|it| it.start).collect();
        parameters[plant.parameter("strut.front.coulomb.force").unwrap()] = 40.0;
        (plant, drive, parameters)
    }

    #[test]
    fn what_several_places_share_is_their_first_word() {
        let instances = Instance::of("strut", &["front_left", "front_right", "rear_left", "rear_right"]);
        let names: Vec<&str> = instances.iter().map(|it| it.place.as_str()).collect();
        assert_eq!(names, ["front_left", "front_right", "rear_left", "rear_right", "front", "rear", "all"]);
        assert_eq!(instances[4].of, ["front_left", "front_right"]);
        let mixed = Instance::of("strut", &["front_left", "rear_left", "front_right", "rear_right"]);
        let names: Vec<&str> = mixed[4..].iter().map(|it| it.place.as_str()).collect();
        assert_eq!(names, ["front", "rear", "all"]);
        let two: Vec<Instance> = Instance::of("strut", &["a", "b"]);
        assert_eq!(two.iter().map(|it| it.of.len()).collect::<Vec<_>>(), [0, 0, 2]);
        assert_eq!(Instance::of("strut", &["left_one", "left_two"]).len(), 3);
        assert_eq!(Instance::of("strut", &["only"]).len(), 1);
    }

    #[test]
    fn a_joint_parameter_changes_its_members() {
        let (plant, drive, joint) = car();
        let dynamics = plant.prepare(&plant.choices).unwrap();
        let start = vec![0.0; plant.states.len()];
        let mut single: Vec<f64> = plant.parameters.iter().map(|it| it.start).collect();
        for place in ["front_left", "front_right"] {
            single[plant.parameter(&format!("strut.{place}.coulomb.force")).unwrap()] = 40.0;
        }
        let [one, other] = [&joint, &single].map(|it| dynamics.outputs(it, &start, &drive));
        assert_eq!(one, other);
        let own = Plant::of::<FullCar>().parameters.len();
        assert_eq!(plant.own(&joint), single[..own]);
        assert!(plant.parameters[own..].iter().all(|it| !it.port));
        let damping = plant.parameter("strut.front.damping").unwrap();
        assert!(plant.is_joint(damping) && !plant.is_joint(own - 1));
        assert!(
            plant.parameters[damping].doc.starts_with("Strut: Damping rate"),
            "{}",
            plant.parameters[damping].doc
        );
    }

    #[test]
    fn its_derivative_is_the_sum_of_its_members() {
        let (plant, drive, parameters) = car();
        let dynamics = plant.prepare(&plant.choices).unwrap();
        let start = vec![0.0; plant.states.len()];
        let seed = |name: &str| Seed::Parameter(plant.parameter(name).unwrap());
        let seeds = [
            seed("strut.front.damping"),
            seed("strut.front_left.damping"),
            seed("strut.front_right.damping"),
            Seed::State(0),
        ];
        let wanted =
            [plant.output("heave.acceleration").unwrap(), plant.output("roll.acceleration").unwrap()];
        let found = dynamics.linearised(&parameters, &start, &drive, &seeds, &wanted);
        for row in 0..2 {
            for k in 0..200 {
                let slope = |seed: usize| found.slopes[seed][row][k];
                assert!(slope(1) * slope(2) != 0.0 || k < 2);
                assert!((slope(0) - slope(1) - slope(2)).abs() < 1e-12);
            }
        }
        struct Kept(Vec<Vec<f64>>);
        impl Follower for Kept {
            fn state(&mut self, _: usize, _: &mut [f64]) {}
            fn seen(&mut self, _: usize, seen: Seen<'_>, _: &mut [f64]) {
                self.0.push(seen.slopes.to_vec());
            }
            fn advanced(&mut self, _: usize, _: &[f64], slopes: &[f64]) {
                self.0.push(slopes.to_vec());
            }
        }
        let mut kept = Kept(Vec::new());
        dynamics.followed(&parameters, &start, &drive, (&seeds, &wanted), &mut kept);
        assert!(kept.0.iter().flat_map(|it| it.chunks(4)).all(|it| (it[0] - it[1] - it[2]).abs() < 1e-12));
        assert!(kept.0.iter().flatten().any(|it| *it != 0.0));
    }
}
