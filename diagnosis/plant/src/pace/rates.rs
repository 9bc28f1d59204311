//! How fast a model's states change: what no step may be longer than.

use num_dual::Dual64;
use strut_model::unit::{M_PER_S, N, RAD_PER_S};
use strut_model::{Bundle, Declaration, Declarations, Instant, Model, Real};

use super::{ACCURATE, STABLE};
use crate::Drive;

/// How far what friction and bushes remember is displaced to look for contact, SI: beyond any backlash.
const DISPLACED: f64 = 0.1;
/// The same of what follows behind a backlash, whatever its unit: beyond the band its rate has one slope.
const BEYOND_BANDS: f64 = 1e9;
/// How often a newton is doubled to look for the force at which a backlash is gone, or friction slides.
const DOUBLED: usize = 24;
/// How often the distance to the force at which friction slides is halved.
const HALVED: usize = 40;
/// A velocity in m/s or rad/s that suspensions seldom exceed: friction before it slides forgets the faster the faster it is moved.
pub(crate) const FAST: f64 = 1.0;

/// The fastest rate of change at rest, and in fast motion, in contact behind a backlash, and where friction slides, too; and the largest
/// slope of a delay's states, per second.
pub(crate) fn rates<M: Model>(
    model: &M,
    parameters: &M::Parameters<f64>,
    drive: &Drive,
    declared: &[Declaration],
) -> [f64; 3] {
    let states = declared.len();
    let lifted: M::Parameters<Dual64> = lift(parameters);
    let derived = model.derive(&lifted);
    let memory = Declarations::of::<M::Memory<f64>>();
    let memory = Bundle::from_fn(|i| Dual64::from(memory[i].start));
    let slopes = |state: &M::State<Dual64>, input: &M::Input<Dual64>| {
        let now = Instant {
            time: Dual64::from(0.0),
            state,
            input,
            parameters: &lifted,
            derived: &derived,
            memory: &memory,
            tick: 0,
        };
        model.equations(now).0
    };
    let jacobian_at = |at: &[f64], inputs: &[f64]| {
        let input = Bundle::from_fn(|i| Dual64::from(inputs[i]));
        let mut jacobian = nalgebra::DMatrix::<f64>::zeros(states, states);
        let mut moves = vec![false; states];
        for column in 0..states {
            let state = Bundle::from_fn(|i| Dual64::new(at[i], f64::from(i == column)));
            slopes(&state, &input).for_each(|row, rate| {
                jacobian[(row, column)] = rate.eps;
                moves[row] |= rate.re != 0.0 || rate.eps != 0.0;
            });
        }
        (jacobian, moves)
    };
    let fastest_of = |jacobian: &nalgebra::DMatrix<f64>| -> f64 {
        if !jacobian.iter().all(|entry| entry.is_finite()) {
            return f64::INFINITY;
        }
        jacobian.complex_eigenvalues().iter().map(|value| value.norm()).fold(0.0, f64::max)
    };
    let rest: Vec<f64> = declared.iter().map(|state| state.start).collect();
    let first: Vec<f64> = drive.inputs.iter().map(|it| it.first().copied().unwrap_or(0.0)).collect();
    let (resting, _) = jacobian_at(&rest, &first);
    let [moved, moving] = moved(declared, &Declarations::of::<M::Input<f64>>(), (&rest, &first), drive);
    let (when_moved, moves) = jacobian_at(&moved, &moving);
    let at_rest = fastest_of(&resting);
    let mut fastest = at_rest.max(fastest_of(&when_moved));
    // What has backlash is loose at rest: it is looked at where it is in contact, too. What is off does not move.
    for (index, state) in declared.iter().enumerate().filter(|(index, _)| moves[*index]) {
        let displaced = |at: &[f64], by: f64| {
            let mut displaced = at.to_vec();
            displaced[index] += by;
            displaced
        };
        match &state.name {
            name if name.starts_with("hysteresis.") && state.unit == N => {
                let at = |by: f64| jacobian_at(&displaced(&moved, by), &moving).0;
                // Not much beyond it, where some laws grow without end.
                let mut forces = std::iter::once(0.0).chain(doubled()).map(|by| (by, at(by)));
                let Some((contact, jacobian)) = forces.find(|(_, it)| it[(index, index)] != 0.0) else {
                    continue;
                };
                fastest = fastest.max(fastest_of(&jacobian));
                let input = Bundle::from_fn(|i| Dual64::from(moving[i]));
                let slope = |by: f64| {
                    let state = displaced(&moved, by);
                    let mut own = 0.0;
                    slopes(&Bundle::from_fn(|i| Dual64::from(state[i])), &input).for_each(|row, slope| {
                        if row == index {
                            own = slope.re;
                        }
                    });
                    own
                };
                // With an exponent below one it comes back to where it slides much faster than it builds up. As it is at rest there, a step
                // has to be stable only.
                if let Some(sliding) = sliding(slope, contact) {
                    fastest = fastest.max(ACCURATE / STABLE * fastest_of(&at(sliding)));
                }
            }
            name if ["hysteresis.", "clevis."].iter().any(|it| name.starts_with(it))
                || name.ends_with(".follower") =>
            {
                let by = if name.ends_with(".follower") { BEYOND_BANDS } else { DISPLACED };
                for (at, inputs) in [(&rest, &first), (&moved, &moving)] {
                    fastest = fastest.max(fastest_of(&jacobian_at(&displaced(at, by), inputs).0));
                }
            }
            _ => {}
        }
    }
    // The rational function of a delay is one only in steps well below it.
    let late = declared.iter().enumerate().filter(|(_, state)| state.name.contains(".delay."));
    [at_rest, fastest, late.map(|(row, _)| resting.row(row).amax()).fold(0.0, f64::max)]
}

/// The force at which friction slides, where it neither grows nor falls: in the direction in which it grows at rest, or, if it does
/// not there, in contact. Behind a backlash, contact may be found beyond that force.
fn sliding(slope: impl Fn(f64) -> f64, contact: f64) -> Option<f64> {
    let sign = [0.0, contact].map(&slope).into_iter().find(|it| *it != 0.0)?.signum();
    let falls = |by: &f64| sign * slope(sign * by) <= 0.0;
    let (mut below, mut limit) = (0.0, doubled().find(falls)?);
    for _ in 0..HALVED {
        let middle = 0.5 * (below + limit);
        *(if falls(&middle) { &mut limit } else { &mut below }) = middle;
    }
    Some(sign * limit)
}

/// A newton, doubled again and again.
fn doubled() -> impl Iterator<Item = f64> {
    std::iter::successors(Some(1.0), |by| Some(2.0 * by)).take(DOUBLED)
}

/// States and inputs where everything moves fast, one thing against the next, so that no two of them go together; an input as fast
/// as it becomes.
fn moved(
    states: &[Declaration],
    inputs: &[Declaration],
    (rest, first): (&[f64], &[f64]),
    drive: &Drive,
) -> [Vec<f64>; 2] {
    let (mut moved, mut moving, mut sign) = (rest.to_vec(), first.to_vec(), 1.0);
    let mut next = || {
        sign = -sign;
        -sign
    };
    let is_velocity = |declared: &Declaration| [M_PER_S, RAD_PER_S].contains(&declared.unit);
    for (value, _) in moved.iter_mut().zip(states).filter(|(_, it)| is_velocity(it)) {
        *value += FAST * next();
    }
    for (index, _) in inputs.iter().enumerate().filter(|(_, it)| is_velocity(it)) {
        moving[index] = drive.inputs[index].iter().fold(0.0, |most: f64, it| most.max(it.abs())) * next();
    }
    [moved, moving]
}

fn lift<R: Real, A: Bundle<f64>, B: Bundle<R>>(bundle: &A) -> B {
    let mut numbers = Vec::with_capacity(A::LEN);
    bundle.for_each(|_, value| numbers.push(value));
    B::from_fn(|i| R::from(numbers[i]))
}
