//! Random roads with the power spectral densities of ISO 8608.

use std::f64::consts::{PI, TAU};

use strut_model::{Choice, Lanes, Real, uniform};

use super::profile::HeightAndSlope;

/// Class of a road, from very good to impassable.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum IsoClass {
    /// Gd(n0) = 16e-6 m³
    A,
    /// Gd(n0) = 64e-6 m³
    B,
    /// Gd(n0) = 256e-6 m³
    C,
    /// Gd(n0) = 1024e-6 m³
    D,
    /// Gd(n0) = 4096e-6 m³
    E,
    /// Gd(n0) = 16384e-6 m³
    F,
    /// Gd(n0) = 65536e-6 m³
    G,
    /// Gd(n0) = 262144e-6 m³
    H,
}

impl IsoClass {
    /// Displacement density Gd(n0) in m³ at the reference n0 = 0.1 cycles/m: the geometric mean of the class.
    pub fn roughness(self) -> f64 {
        16e-6 * 4_f64.powi(self as i32)
    }
}

/// Number of waves. A multiple of the number of lanes.
const WAVES: usize = 256;
/// Lowest and highest spatial frequency in cycles/m, as ISO 8608 reports them.
const LOWEST: f64 = 0.011;
const HIGHEST: f64 = 2.83;
/// Reference spatial frequency n0 in cycles/m.
const REFERENCE: f64 = 0.1;

/// One track of a random road: a sum of waves with random phases whose power in every band is that of
/// `Gd(n) = Gd(n0) (n/n0)^−2`.
///
/// Bands are logarithmic; a wave stands at the geometric mean n_i of its band, whose width is Δn_i, and has
/// the amplitude √(2 Gd(n_i) Δn_i), with which it has just the power of the band: for an exponent of −2 the
/// density at the geometric mean times the width is the integral.
#[derive(Clone, Debug, PartialEq)]
pub struct IsoTrack {
    waves: Box<[Waves; WAVES / Lanes::COUNT]>,
    /// Height at the start, which is subtracted: a rig starts at rest on the road.
    origin: f64,
}

/// As many waves as there are lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Waves {
    /// In cycles/m: the same for all tracks.
    frequency: Lanes,
    /// Amplitude of the sine that begins at distance zero, in m.
    sine: Lanes,
    /// Amplitude of the cosine, in m. Both instead of amplitude and phase, so that tracks at the same distance
    /// share the functions.
    cosine: Lanes,
}

impl IsoTrack {
    /// Track number `track` of a seed: tracks of a seed use its random numbers one after the other.
    pub fn new(class: IsoClass, seed: i32, track: usize) -> Self {
        // The bits of the seed, so that every number is a seed of its own.
        let phases: Vec<f64> = uniform(i64::from(seed) as u64).skip(track * WAVES).take(WAVES).collect();
        let end = |i: usize| LOWEST * (HIGHEST / LOWEST).powf(i as f64 / WAVES as f64);
        let wave = |i: usize| {
            let (low, high) = (end(i), end(i + 1));
            let centre = (low * high).sqrt();
            let density = class.roughness() * (centre / REFERENCE).powi(-2);
            let amplitude = (2.0 * density * (high - low)).sqrt();
            let phase = phases[i] * TAU;
            [centre, amplitude * Real::cos(phase), amplitude * Real::sin(phase)]
        };
        let waves = std::array::from_fn(|chunk| {
            let wave = |lane: usize| wave(Lanes::COUNT * chunk + lane);
            let part = |which: usize| Lanes::new(std::array::from_fn(|lane| wave(lane)[which]));
            Waves { frequency: part(0), sine: part(1), cosine: part(2) }
        });
        let mut track = Self { waves: Box::new(waves), origin: 0.0 };
        let [[height, ..]] = Self::shapes([&track], 0.0);
        track.origin = height;
        track
    }

    /// Height above the starting point and slope after a distance in metres.
    pub(super) fn at<R: Real>(&self, distance: R) -> HeightAndSlope<R> {
        let [height, slope] = distance.lookup(|distance| {
            let [[height, slope, curvature]] = Self::shapes([self], distance);
            ([height, slope], [slope, curvature])
        });
        HeightAndSlope(height, slope)
    }

    /// Those of two tracks after the same distance, in two thirds of the time.
    pub(super) fn side_by_side<R: Real>(tracks: [&Self; 2], distance: R) -> [HeightAndSlope<R>; 2] {
        let [left_height, left_slope, right_height, right_slope] = distance.lookup(|distance| {
            let [left, right] = Self::shapes(tracks, distance);
            ([left[0], left[1], right[0], right[1]], [left[1], left[2], right[1], right[2]])
        });
        [HeightAndSlope(left_height, left_slope), HeightAndSlope(right_height, right_slope)]
    }

    /// Height above the starting point, slope and curvature of each track.
    fn shapes<const N: usize>(tracks: [&Self; N], distance: f64) -> [[f64; 3]; N] {
        let mut sums = [[Lanes::from(0.0); 3]; N];
        for i in 0..WAVES / Lanes::COUNT {
            let frequency = tracks[0].waves[i].frequency;
            let (sine, cosine) = sine_and_cosine(frequency * distance);
            let wave_number = frequency * TAU;
            for (sum, track) in sums.iter_mut().zip(tracks) {
                let wave = &track.waves[i];
                let height = wave.sine * sine + wave.cosine * cosine;
                sum[0] += height;
                sum[1] += wave_number * (wave.sine * cosine - wave.cosine * sine);
                sum[2] -= wave_number.squared() * height;
            }
        }
        let mut shapes = sums.map(|sums| sums.map(|sum| sum.to_array().into_iter().sum()));
        for (shape, track) in shapes.iter_mut().zip(tracks) {
            shape[0] -= track.origin;
        }
        shapes
    }
}

/// Sine and cosine of an angle in cycles, with an absolute error below 1.5e-15.
///
/// A road is hundreds of waves at every step: counted in cycles an angle loses its whole turns by one
/// rounding, and both functions follow from those of half the angle, |πf| ≤ π/2, whose Taylor series are cut
/// where they end in rounding. Four times as fast as the general functions.
#[inline]
fn sine_and_cosine(cycles: Lanes) -> (Lanes, Lanes) {
    // Adding and subtracting this number leaves the nearest whole one.
    const ROUNDING: f64 = 1.5 * (1_u64 << 52) as f64;
    let half = (cycles - (cycles + ROUNDING - ROUNDING)) * PI;
    let square = half.squared();
    let series = |coefficients: &[f64]| {
        let (last, rest) = coefficients.split_last().unwrap_or((&0.0, &[]));
        rest.iter().rev().fold(Lanes::from(*last), |sum, coefficient| sum * square + *coefficient)
    };
    let (sine, cosine) = (half * series(&TAYLOR[1]), series(&TAYLOR[0]));
    (sine * cosine * 2.0, Lanes::from(1.0) - sine.squared() * 2.0)
}

/// (−1)^k/(2k)! and (−1)^k/(2k + 1)!: the coefficients of cos x and of (sin x)/x in x².
const TAYLOR: [[f64; 11]; 2] = {
    let mut list = [[1.0; 11]; 2];
    let mut k = 1;
    while k < 11 {
        let even = 2.0 * k as f64;
        list[0][k] = -list[0][k - 1] / (even * (even - 1.0));
        list[1][k] = -list[1][k - 1] / (even * (even + 1.0));
        k += 1;
    }
    list
};

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn classes_quadruple_from_16_to_262144() {
        assert_eq!(IsoClass::A.roughness(), 16e-6);
        assert!((IsoClass::H.roughness() - 262_144e-6).abs() < 1e-12);
    }

    #[test]
    fn the_power_is_the_integral_of_the_density() {
        let track = IsoTrack::new(IsoClass::A, 3, 0);
        let power: f64 = track
            .waves
            .iter()
            .flat_map(|wave| (wave.sine.squared() + wave.cosine.squared()).to_array())
            .map(|square| 0.5 * square)
            .sum();
        // ∫ Gd(n0) n0² n⁻² dn.
        let exact = 16e-6 * REFERENCE.powi(2) * (1.0 / LOWEST - 1.0 / HIGHEST);
        assert!((power / exact - 1.0).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn sine_and_cosine_of_cycles_are_exact(cycles in -1000.0..1000.0_f64) {
            let (sine, cosine) = sine_and_cosine(Lanes::from(cycles));
            // The remainder of cycles is exact, so that only the functions differ.
            let (exact_sine, exact_cosine) = (TAU * (cycles - cycles.round())).sin_cos();
            let sines = sine.to_array().map(|found| (found, exact_sine));
            let cosines = cosine.to_array().map(|found| (found, exact_cosine));
            for (found, exact) in sines.into_iter().chain(cosines) {
                // The angle in radians, that the exact ones are of, is rounded, too.
                prop_assert!((found - exact).abs() < 2e-15, "{found} {exact}");
            }
        }

        #[test]
        fn four_times_the_density_is_twice_the_height(s in 0.0..300.0_f64, seed in any::<i32>()) {
            let [a, b] = [IsoClass::A, IsoClass::B].map(|class| IsoTrack::new(class, seed, 0).at(s));
            prop_assert!((2.0 * a.0 - b.0).abs() < 1e-12);
        }

        #[test]
        fn tracks_side_by_side_are_the_tracks(s in 0.0..300.0_f64) {
            let tracks = [0, 1].map(|track| IsoTrack::new(IsoClass::C, 1, track));
            let together = IsoTrack::side_by_side(tracks.each_ref(), s);
            for (track, HeightAndSlope(height, slope)) in tracks.iter().zip(together) {
                let alone = track.at(s);
                prop_assert_eq!((alone.0, alone.1), (height, slope));
            }
        }

        #[test]
        fn seeds_and_tracks_differ_and_repeat(s in 1.0..300.0_f64, seed in -1000..1000_i32) {
            let height = |seed: i32, track: usize| IsoTrack::new(IsoClass::C, seed, track).at(s).0;
            prop_assert_eq!(height(seed, 0), height(seed, 0));
            prop_assert_ne!(height(seed, 0), height(seed, 1));
            prop_assert_ne!(height(seed, 0), height(seed + 1, 0));
        }
    }

    #[test]
    fn the_start_is_at_zero() {
        assert_eq!(IsoTrack::new(IsoClass::D, 1, 0).at(0.0).0, 0.0);
    }
}
