//! The classical Runge–Kutta method over the samples of a record, for any scalar.

use strut_model::{Bundle, Declarations, Instant, Model, Real};

use super::jet::{Jet, Scalar};
use super::pace::Pace;
use super::{DIRECTIONS, Drive, Linearised, Seed, outputs_of};

/// A model that is ready to be run.
pub(super) struct Equations<M> {
    pub model: M,
}

/// A model on its way through a record.
pub(super) struct Run<'a, M: Model, R: Scalar> {
    model: &'a M,
    parameters: M::Parameters<R>,
    derived: M::Derived<R>,
    memory: M::Memory<R>,
    state: M::State<R>,
    /// Which states are measured, as (state, output).
    measured: Vec<(usize, usize)>,
    start: f64,
    step: f64,
    pub pace: Pace,
    period: Option<f64>,
    ticks: u64,
}

impl<'a, M: Model, R: Scalar> Run<'a, M, R> {
    /// `numbers` are the parameters without derivatives.
    pub fn new(
        model: &'a M,
        numbers: &[f64],
        parameters: M::Parameters<R>,
        state: M::State<R>,
        drive: &Drive,
    ) -> Self {
        let plain: M::Parameters<f64> = Bundle::from_fn(|i| numbers[i]);
        let outputs = <M::Output<f64> as Bundle<f64>>::LEN;
        let states = Declarations::of::<M::State<f64>>();
        let measured = states.iter().enumerate().filter(|(_, state)| state.output).map(|(index, _)| index);
        let memory = Declarations::of::<M::Memory<f64>>();
        let period = M::period(&plain);
        Self {
            model,
            parameters,
            derived: model.derive(&parameters),
            memory: Bundle::from_fn(|i| R::from(memory[i].start)),
            state,
            measured: measured.zip(outputs..).collect(),
            start: drive.start,
            step: drive.step,
            pace: Pace::of(model, &plain, drive),
            period,
            // The tick at the start or the last one before it is made first.
            ticks: period.map_or(0, |period| (drive.start / period + 1e-6) as u64),
        }
    }

    /// Goes through all samples and hands out the outputs at each, by their index; `input` gives an input at a share of the
    /// way from a sample to the next.
    pub fn through(
        &mut self,
        samples: usize,
        input: impl Fn(usize, usize, f64) -> R,
        mut put: impl FnMut(usize, R),
    ) {
        for sample in 0..samples {
            let (first, rates) = self.outputs(sample, |i, share| input(i, sample, share), &mut put);
            if sample + 1 < samples {
                self.reach_next(sample, &first, &rates, |i, share| input(i, sample, share));
            }
        }
    }

    /// Hands out the outputs at a sample, by their index; the inputs and the rates there.
    #[inline(always)]
    pub fn outputs(
        &mut self,
        sample: usize,
        input: impl Fn(usize, f64) -> R,
        mut put: impl FnMut(usize, R),
    ) -> (M::Input<R>, M::State<R>) {
        let (time, first) =
            (self.start + sample as f64 * self.step, M::Input::<R>::from_fn(|i| input(i, 0.0)));
        self.tick_at(time, &first);
        let (rates, output) = self.equations(R::from(time), &self.state, &first);
        output.for_each(&mut put);
        let mut states = self.measured.iter().peekable();
        self.state.for_each(|index, value| {
            if let Some((_, output)) = states.next_if(|(state, _)| *state == index) {
                put(*output, value);
            }
        });
        (first, rates)
    }

    /// Goes on to the next sample, in as many steps as the pace asks for.
    #[inline(always)]
    fn reach_next(
        &mut self,
        sample: usize,
        first: &M::Input<R>,
        rates: &M::State<R>,
        input: impl Fn(usize, f64) -> R,
    ) {
        self.pace.reach(&self.state);
        let state = self.state;
        loop {
            let need =
                self.advance(sample, first, rates, |share| M::Input::<R>::from_fn(|i| input(i, share)));
            if !self.pace.refuse(need) {
                break;
            }
            self.state = state;
        }
    }

    /// Puts the model in a state; what its sampled part remembers is kept without derivatives.
    pub fn place(&mut self, state: impl FnMut(usize) -> R) {
        self.state = Bundle::from_fn(state);
        let mut numbers = Vec::new();
        self.memory.for_each(|_, value| numbers.push(value.number()));
        self.memory = Bundle::from_fn(|i| R::from(numbers[i]));
    }

    /// Goes from the state at a sample, where inputs and rates are known, to the next one and hands out the states there, by their
    /// index.
    pub fn advanced(
        &mut self,
        sample: usize,
        (first, rates): &(M::Input<R>, M::State<R>),
        input: impl Fn(usize, f64) -> R,
        put: impl FnMut(usize, R),
    ) {
        self.reach_next(sample, first, rates, input);
        self.state.for_each(put);
    }

    /// Whether it has a sampled part, which changes where no state moves.
    pub fn is_sampled(&self) -> bool {
        self.period.is_some()
    }

    /// Goes from a sample, where input and rates are known, to the next; the largest need of its steps, as [`Pace::need`].
    #[inline]
    fn advance(
        &mut self,
        sample: usize,
        first: &M::Input<R>,
        rates: &M::State<R>,
        at: impl Fn(f64) -> M::Input<R>,
    ) -> f64 {
        let (mut first, mut k1, mut need) = (*first, *rates, 0.0_f64);
        let steps = self.pace.steps as f64;
        let h = self.step / steps;
        for part in 0..self.pace.steps {
            let share = |offset: f64| (part as f64 + offset) / steps;
            let time = |offset: f64| self.start + (sample as f64 + share(offset)) * self.step;
            let now = [time(0.0), time(0.5), time(1.0)];
            if part > 0 {
                self.tick_at(now[0], &first);
                (k1, _) = self.equations(R::from(now[0]), &self.state, &first);
            }
            let x = self.state;
            let (middle, last) = (at(share(0.5)), at(share(1.0)));
            let (k2, _) = self.equations(R::from(now[1]), &along::<M, R, 1>(&x, [0.5 * h], [&k1]), &middle);
            let (k3, _) = self.equations(R::from(now[1]), &along::<M, R, 1>(&x, [0.5 * h], [&k2]), &middle);
            let (k4, _) = self.equations(R::from(now[2]), &along::<M, R, 1>(&x, [h], [&k3]), &last);
            need = need.max(self.pace.need(h, [&k1, &k2, &k3, &k4]));
            let (sixth, third) = (h / 6.0, h / 3.0);
            self.state = along::<M, R, 4>(&x, [sixth, third, third, sixth], [&k1, &k2, &k3, &k4]);
            first = last;
        }
        need
    }

    #[inline]
    fn equations(&self, time: R, state: &M::State<R>, input: &M::Input<R>) -> (M::State<R>, M::Output<R>) {
        self.model.equations(self.now(time, state, input))
    }

    #[inline]
    fn now<'b>(&'b self, time: R, state: &'b M::State<R>, input: &'b M::Input<R>) -> Instant<'b, M, R> {
        let (parameters, derived, memory) = (&self.parameters, &self.derived, &self.memory);
        Instant { time, state, input, parameters, derived, memory, tick: self.ticks }
    }

    /// Makes the tick of a sampled part that is due.
    fn tick_at(&mut self, time: f64, input: &M::Input<R>) {
        if let Some(period) = self.period
            && self.ticks as f64 * period <= time + 1e-6 * period
        {
            self.memory = self.model.tick(self.now(R::from(time), &self.state, input));
            self.ticks += 1;
        }
    }
}

/// `x + Σ h k`.
#[inline(always)]
fn along<M: Model, R: Real, const N: usize>(
    x: &M::State<R>,
    h: [f64; N],
    slopes: [&M::State<R>; N],
) -> M::State<R> {
    x.combine(slopes, &mut |x, slopes| {
        let mut moved = *x;
        for (slope, h) in slopes.into_iter().zip(h) {
            moved += *slope * h;
        }
        moved
    })
}

type Dual = Jet<DIRECTIONS>;

/// The direction of one seed.
pub(super) fn direction(index: usize) -> [f64; DIRECTIONS] {
    std::array::from_fn(|i| f64::from(i == index))
}

/// Which seeds change each input.
pub(super) struct Seeding<'a> {
    /// Of each input: the number of the seed and the change.
    changes: Vec<Vec<(usize, &'a [f64])>>,
}

impl<'a> Seeding<'a> {
    /// Of at most [`DIRECTIONS`] seeds.
    pub fn new(seeds: &'a [Seed], drive: &Drive) -> Self {
        let of = |input: usize| {
            let changing = seeds.iter().enumerate().filter_map(|(index, seed)| match seed {
                Seed::Inputs(changes) => Some(changes.iter().map(move |change| (index, change))),
                Seed::Parameter(_) | Seed::State(_) => None,
            });
            let of_input = changing.flatten().filter(|(_, (changed, _))| *changed == input);
            of_input.map(|(index, (_, signal))| (index, signal.as_slice())).collect()
        };
        Self { changes: (0..drive.inputs.len()).map(of).collect() }
    }

    /// An input at a share of the way from a sample to the next, with its derivatives.
    #[inline]
    pub fn value(&self, drive: &Drive, input: usize, sample: usize, share: f64) -> Dual {
        let between = |signal: &[f64]| drive.value(signal, sample, share);
        let value = between(&drive.inputs[input]);
        let mut slopes = [0.0; DIRECTIONS];
        for (index, signal) in &self.changes[input] {
            slopes[*index] = between(signal);
        }
        Dual { value, slopes }
    }
}

/// The outputs that are asked for and their derivatives, as [`Dynamics::linearised`](super::Dynamics::linearised), for at
/// most [`DIRECTIONS`] seeds.
pub(super) fn linearised<M: Model>(
    model: &M,
    parameters: &[f64],
    start: &[f64],
    drive: &Drive,
    seeds: &[Seed],
    wanted: &[usize],
) -> Linearised {
    // What several parameters are joined in is asked for beside one of them: a seed may be there twice.
    let seeded = |value: f64, seed: Seed| Dual {
        value,
        slopes: std::array::from_fn(|index| f64::from(seeds.get(index) == Some(&seed))),
    };
    let mut run = Run::<M, Dual>::new(
        model,
        parameters,
        Bundle::from_fn(|i| seeded(parameters[i], Seed::Parameter(i))),
        Bundle::from_fn(|i| seeded(start[i], Seed::State(i))),
        drive,
    );
    let seeding = Seeding::new(seeds, drive);
    let input = |i: usize, sample: usize, share: f64| seeding.value(drive, i, sample, share);
    let empty = || vec![Vec::with_capacity(drive.len()); wanted.len()];
    let mut found = Linearised { outputs: empty(), slopes: seeds.iter().map(|_| empty()).collect() };
    let rows: Vec<Option<usize>> =
        (0..outputs_of::<M>()).map(|output| wanted.iter().position(|it| *it == output)).collect();
    run.through(drive.len(), input, |output, value| {
        if let Some(row) = rows[output] {
            found.outputs[row].push(value.value);
            for (slopes, slope) in found.slopes.iter_mut().zip(value.slopes) {
                slopes[row].push(slope);
            }
        }
    });
    found
}
