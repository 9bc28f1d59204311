//! Signals as functions of the time since their start, with their rates of change: what roads and sources are
//! made of.

use std::f64::consts::{PI, TAU};

use strut_model::{Real, Variables};

/// Switching instants that rounding puts this part of a half period too late are met all the same.
const ROUNDING: f64 = 1e-9;

/// A sweep of the frequency.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Chirp<R> {
    /// Frequency at the start
    #[var(unit = HZ, start = 1.0, min = 0.0)]
    pub start_frequency: R,
    /// Frequency at the end, and afterwards
    #[var(unit = HZ, start = 8.0, min = 0.0)]
    pub end_frequency: R,
    /// Duration of the sweep
    #[var(unit = S, start = 25.0, min = 1e-3)]
    pub duration: R,
}

impl<R: Real> Chirp<R> {
    /// The frequency grows linearly over the duration; the phase is its integral and goes on without a jump.
    pub fn at(&self, tau: R, amplitude: R) -> [R; 2] {
        let Self { start_frequency: from, end_frequency: to, duration } = *self;
        let past = tau - duration;
        let growth = (to - from) / duration;
        let cycles =
            past.select((from + to) * duration * 0.5 + to * past, from * tau + growth * tau.squared() * 0.5);
        let frequency = past.select(to, from + growth * tau);
        sine(amplitude, cycles * TAU, frequency * TAU)
    }
}

/// `A sin φ` and its rate, φ' being the angular frequency.
pub fn sine<R: Real>(amplitude: R, phase: R, angular_frequency: R) -> [R; 2] {
    [amplitude * phase.sin(), amplitude * angular_frequency * phase.cos()]
}

/// From `origin` to `target` on a cosine half wave that begins at zero; without a duration at once.
pub fn edge<R: Real>(tau: R, origin: R, target: R, duration: R) -> [R; 2] {
    // A duration of zero has no cosine, which is not wanted then but must be a number.
    let rate = R::from(PI) / duration.max(R::from(1e-12));
    let half = (target - origin) * 0.5;
    let under_way = duration - tau;
    [
        under_way.select(origin + half * (R::from(1.0) - (rate * tau).cos()), target),
        under_way.select(half * rate * (rate * tau).sin(), R::from(0.0)),
    ]
}

/// Edges at k/(2f): from zero up at k = 0, then down and up in turn.
pub fn square<R: Real>(tau: R, amplitude: R, frequency: R, edge_time: R) -> [R; 2] {
    let half_period = R::from(0.5) / frequency;
    // Number of the edge, whether it leads down (1) or up (0), and whether there is one before it. An edge is a
    // kink in time only, so that none of these has a slope.
    let count = (tau / half_period + ROUNDING).floor();
    let down = count - (count * 0.5).floor() * 2.0;
    let later = count.select(R::from(1.0), R::from(0.0));
    let target = amplitude * (R::from(1.0) - down * 2.0);
    let since = (tau - count * half_period).max(R::from(0.0));
    edge(since, -(target * later), target, edge_time)
}

/// `levels` in turn, each for `duration`, the last one for ever.
pub fn stairs<R: Real, const N: usize>(tau: R, levels: &[R; N], duration: R) -> R {
    let reached = tau / duration + ROUNDING;
    (1..N).fold(levels[0], |level, stair| (R::from(stair as f64) - reached).select(level, levels[stair]))
}
