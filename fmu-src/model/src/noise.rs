//! Random numbers as functions of a seed and a place in the sequence.
//!
//! A generator that is a function keeps no state: a saved simulation continues with the same numbers
//! because its tick count is the same, and two instances never share anything.

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::SplitMix64;

/// The uniform numbers in [0, 1) that belong to a seed: the upper 53 bits of SplitMix64.
pub fn uniform(seed: u64) -> impl Iterator<Item = f64> {
    let mut generator = SplitMix64::from_seed(seed.to_le_bytes());
    std::iter::repeat_with(move || (generator.next_u64() >> 11) as f64 / (1_u64 << 53) as f64)
}

/// A standard normal number for a seed, a stream (one for each noise source of a model) and a tick
/// (Box–Muller).
pub fn noise(seed: u64, stream: u64, tick: u64) -> f64 {
    // SplitMix64's own output is the hash that spreads neighbouring seeds, streams and ticks apart.
    let spread = |number: u64| SplitMix64::from_seed(number.to_le_bytes()).next_u64();
    let mut pair = uniform(spread(spread(spread(seed) ^ stream) ^ tick));
    let (radius, angle) = (pair.next().unwrap_or(0.0), pair.next().unwrap_or(0.0));
    (-2.0 * libm::log(1.0 - radius)).sqrt() * libm::cos(std::f64::consts::TAU * angle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uniform_numbers_are_those_of_the_published_generator() {
        // First outputs of SplitMix64 for the seed 0, from its authors' C program.
        let expected = [0xe220_a839_7b1d_cdaf_u64, 0x6e78_9e6a_a1b9_65f4, 0x06c4_5d18_8009_454f];
        for (number, word) in uniform(0).zip(expected) {
            assert_eq!(number, (word >> 11) as f64 / (1_u64 << 53) as f64);
        }
    }

    #[test]
    fn noise_is_standard_normal_and_streams_are_uncorrelated() {
        let n = 20_000;
        let (mut sum, mut squares, mut cross, mut lag) = (0.0, 0.0, 0.0, 0.0);
        for tick in 0..n {
            let (a, b) = (noise(7, 0, tick), noise(7, 1, tick));
            sum += a;
            squares += a * a;
            cross += a * b;
            lag += a * noise(7, 0, tick + 1);
        }
        let n = n as f64;
        // Five standard errors.
        let bound = 5.0 / n.sqrt();
        assert!((sum / n).abs() < bound, "mean {}", sum / n);
        assert!((squares / n - 1.0).abs() < bound * 2_f64.sqrt(), "variance {}", squares / n);
        assert!((cross / n).abs() < bound && (lag / n).abs() < bound);
    }
}
