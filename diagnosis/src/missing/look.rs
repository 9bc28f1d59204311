//! A first look at a rig: which of its states matter, and what a signal at each port does.

use std::ops::Range;

use crate::plant::{Follower, Seen};

/// Share of what a port does that another one does not, below which the two are one place.
const TIED: f64 = 1e-6;

/// Samples at most in which a signal is followed on its way.
const LONGEST: usize = 10_000;

/// Which states matter: the largest derivatives over the first samples.
pub(super) struct Look {
    width: usize,
    next: Vec<f64>,
    outputs: Vec<f64>,
}

impl Look {
    /// Before anything is seen, for so many seeds.
    pub fn new(width: usize) -> Self {
        Self { width, next: Vec::new(), outputs: Vec::new() }
    }

    /// States that reach a measured output, directly or by others.
    pub fn active(&self, states: usize) -> Vec<usize> {
        let mut reaches: Vec<bool> = (0..states)
            .map(|state| self.outputs.chunks_exact(self.width).any(|row| row[state] > 0.0))
            .collect();
        loop {
            let before = reaches.clone();
            for (to, row) in self.next.chunks_exact(self.width).enumerate() {
                for (from, slope) in row[..states].iter().enumerate() {
                    reaches[from] |= before[to] && *slope > 0.0;
                }
            }
            if reaches == before {
                return (0..states).filter(|it| reaches[*it]).collect();
            }
        }
    }

    /// Whether two seeds do the same but for their size.
    pub fn same(&self, a: usize, b: usize) -> bool {
        let rows = || self.next.chunks_exact(self.width).chain(self.outputs.chunks_exact(self.width));
        let (mut aa, mut ab, mut bb) = (0.0, 0.0, 0.0);
        for row in rows() {
            aa += row[a] * row[a];
            ab += row[a] * row[b];
            bb += row[b] * row[b];
        }
        aa > 0.0 && bb > 0.0 && ab * ab > (1.0 - TIED) * aa * bb
    }

    /// The only output in which a seed shows, if it moves no state: what it does, a fault of that output's sensor could do.
    pub fn shows_only_in(&self, seed: usize) -> Option<usize> {
        let mut shown = self.outputs.chunks_exact(self.width).enumerate().filter(|(_, row)| row[seed] > 0.0);
        let moves = self.next.chunks_exact(self.width).any(|row| row[seed] > 0.0);
        let first = shown.next().filter(|_| !moves).map(|(row, _)| row)?;
        shown.next().is_none().then_some(first)
    }

    /// The least size of a state that moves a sensor's signal at once as far as it moves; zero if no sensor shows it at once.
    pub fn shown(&self, state: usize, magnitudes: &[f64]) -> f64 {
        let least = self.least(magnitudes, |row| row[state]);
        if least.is_finite() { least } else { 0.0 }
    }

    /// The least size of a signal with these slopes in the outputs that moves one of them as far as it moves.
    fn least(&self, magnitudes: &[f64], slope: impl Fn(&[f64]) -> f64) -> f64 {
        let shown = self.outputs.chunks_exact(self.width).zip(magnitudes);
        let shown = shown.map(|(row, size)| (slope(row), size)).filter(|(slope, _)| *slope > 0.0);
        shown.map(|(slope, size)| size / slope).fold(f64::INFINITY, f64::min)
    }

    /// The size of a port's signal that moves what the sensors show as far as it moves; where a port shows more by what it
    /// does to the states within a sample than at once, the size that moves the states as far as the inputs do, or where those rest, in
    /// the time in which the sensors' signals move as far. `changes`: of each signal from sample to sample.
    pub fn size(&self, port: usize, magnitudes: &[f64], changes: &[f64], inputs: &Range<usize>) -> f64 {
        let next = || self.next.chunks_exact(self.width).map(|row| row[port]);
        let at_once = self.least(magnitudes, |row| row[port]);
        let by_states = self.least(magnitudes, |row| row.iter().zip(next()).map(|(h, next)| h * next).sum());
        if at_once.is_finite() && at_once <= by_states {
            return at_once;
        }
        let driven = self.next.chunks_exact(self.width).filter(|row| row[port] > 0.0);
        let driven = driven.flat_map(|row| row[inputs.clone()].iter().map(move |it| it / row[port]));
        let driven = Some(driven.fold(0.0, f64::max));
        let is_size = |it: &f64| *it > 0.0 && it.is_finite();
        let in_time = || Some(at_once.min(self.least_in_time(port, magnitudes, changes)));
        // What shows nowhere is not missed.
        driven.filter(is_size).or_else(in_time).filter(is_size).unwrap_or(f64::MIN_POSITIVE)
    }

    /// The least constant signal at a port that moves one of the outputs as far as it moves, in the time in which that does.
    fn least_in_time(&self, port: usize, magnitudes: &[f64], changes: &[f64]) -> f64 {
        let mut states = vec![0.0; self.next.len() / self.width];
        let samples = magnitudes.iter().zip(changes).map(|(size, change)| (size / change) as usize);
        let samples: Vec<usize> = samples.map(|it| it.clamp(1, LONGEST)).collect();
        let mut least = f64::INFINITY;
        for sample in 1..=samples.iter().copied().max().unwrap_or(0) {
            let by = |row: &[f64], states: &[f64]| -> f64 {
                row.iter().zip(states).map(|(slope, state)| slope * state).sum()
            };
            let next = self.next.chunks_exact(self.width);
            states = next.map(|row| by(row, &states) + row[port]).collect();
            let outputs = self.outputs.chunks_exact(self.width).zip(magnitudes).zip(&samples);
            let reached = outputs.filter(|(_, samples)| **samples == sample);
            let sizes = reached.map(|((row, size), _)| size / by(row, &states)).filter(|it| *it > 0.0);
            least = sizes.fold(least, f64::min);
        }
        least
    }
}

impl Follower for Look {
    fn state(&mut self, _: usize, _: &mut [f64]) {}

    fn seen(&mut self, _: usize, seen: Seen<'_>, _: &mut [f64]) {
        larger(&mut self.outputs, seen.slopes);
    }

    fn advanced(&mut self, _: usize, _: &[f64], slopes: &[f64]) {
        larger(&mut self.next, slopes);
    }
}

fn larger(most: &mut Vec<f64>, slopes: &[f64]) {
    most.resize(slopes.len(), 0.0);
    most.iter_mut().zip(slopes).for_each(|(most, slope)| *most = most.max(slope.abs()));
}
