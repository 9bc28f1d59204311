use proptest::prelude::*;
use strut_model::{Bundle, Declarations, Settings};

use super::*;

type Parameters = voltage::Parameters<f64>;

fn parameters() -> Parameters {
    let declared = Declarations::of::<Parameters>();
    Bundle::from_fn(|i| declared[i].start)
}

fn at(shape: Shape, time: f64, p: &Parameters) -> f64 {
    let source = VoltageSource { shape };
    let now = Instant {
        time,
        state: &NoVariables,
        input: &NoVariables,
        parameters: p,
        derived: &NoVariables,
        memory: &NoVariables,
        tick: 0,
    };
    source.equations(now).1.voltage
}

#[test]
fn the_sweep_of_konieczny_goes_from_0_063_to_40_hertz_in_40_seconds() {
    let chirp = Chirp { start_frequency: 0.063, end_frequency: 40.0, duration: 40.0 };
    let p = Parameters { amplitude: 3.0, chirp, ..parameters() };
    // The phase is (f0 + f1)/2 · T = 801.26 turns at the end, and grows by 40 turns a second from there on.
    assert!((at(Shape::Chirp, 40.0, &p) - 3.0 * (TAU * 0.26).sin()).abs() < 1e-9);
    assert!((at(Shape::Chirp, 41.0, &p) - 3.0 * (TAU * 0.26).sin()).abs() < 1e-9);
    // A quarter turn after 0.2489… s: f0 t + (f1 − f0) t²/(2 T) = 1/4.
    let growth = (40.0 - 0.063) / 40.0;
    let quarter = ((0.063_f64.powi(2) + 0.5 * growth).sqrt() - 0.063) / growth;
    assert!((at(Shape::Chirp, quarter, &p) - 3.0).abs() < 1e-12);
}

#[test]
fn the_ramp_of_kogut_grows_by_a_tenth_of_a_hertz_a_second() {
    let declared = Declarations::of::<frequency::Parameters<f64>>();
    let p: frequency::Parameters<f64> = Bundle::from_fn(|i| declared[i].start);
    assert_eq!(frequency::Options::starts().shape, Shape::Ramp);
    assert_eq!((p.ramp.rate, p.ramp.duration), (0.1, 60.0));
    let p = Parameters { ramp: voltage::Ramp { rate: 0.1, duration: 60.0 }, ..parameters() };
    for (time, value) in [(-1.0, 0.0), (0.0, 0.0), (16.0, 1.6), (60.0, 6.0), (70.0, 6.0)] {
        assert!((at(Shape::Ramp, time, &p) - value).abs() < 1e-12, "{time}");
    }
}

#[test]
fn stairs_go_through_their_levels_and_stay_at_the_last() {
    let stairs = voltage::Stairs { level: std::array::from_fn(|i| 1.5 + i as f64), duration: 0.1 };
    let p = Parameters { start_time: 0.7, offset: -4.0, stairs, ..parameters() };
    assert_eq!(at(Shape::Stairs, 0.6999, &p), -4.0);
    for stair in 0..LEVELS {
        // Steps of 0.1 s, added up with all their rounding, meet each stair at its beginning.
        let time = (0..7 + stair).fold(0.0, |time, _| time + 0.1);
        assert!((at(Shape::Stairs, time, &p) - 1.5 - stair as f64).abs() < 1e-12, "{stair}");
        assert!((at(Shape::Stairs, time + 0.0999, &p) - 1.5 - stair as f64).abs() < 1e-12, "{stair}");
    }
    assert!((at(Shape::Stairs, 100.0, &p) - 12.5).abs() < 1e-12);
}

#[test]
fn steps_and_squares_have_the_value_after_the_switch() {
    let p = Parameters { start_time: 0.5, offset: 1.0, amplitude: 2.0, swing_frequency: 5.0, ..parameters() };
    for (time, step, square) in
        [(0.49, 1.0, 1.0), (0.5, 3.0, 3.0), (0.59, 3.0, 3.0), (0.6, 3.0, -1.0), (0.7, 3.0, 3.0)]
    {
        let found = (at(Shape::Step, time, &p), at(Shape::Square, time, &p));
        assert_eq!(found, (step, square), "{time}");
    }
    // Switches of 10 per second met by steps of 1 ms that are added up.
    let mut time = 0.0;
    for k in 0..3000 {
        let half = if k < 500 { 1.0 } else { [3.0, -1.0][(k - 500) / 100 % 2] };
        assert_eq!(at(Shape::Square, time, &p), half, "{k}");
        time += 1e-3;
    }
}

#[test]
fn an_edge_with_a_duration_is_half_way_up_in_its_middle() {
    let p = Parameters { amplitude: 2.0, edge_time: 0.04, ..parameters() };
    assert!((at(Shape::Step, 0.02, &p) - 1.0).abs() < 1e-12);
    assert!((at(Shape::Square, 0.52, &p)).abs() < 1e-12);
    assert!((at(Shape::Square, 0.6, &p) + 2.0).abs() < 1e-12);
}

const SHAPES: [Shape; 7] =
    [Shape::Constant, Shape::Step, Shape::Ramp, Shape::Stairs, Shape::Sine, Shape::Square, Shape::Chirp];

proptest! {
    #[test]
    fn before_the_start_there_is_the_offset(time in -10.0..1.9999_f64, offset in -5.0..5.0_f64, index in 0..7_usize) {
        let p = Parameters { start_time: 2.0, offset, ..parameters() };
        prop_assert_eq!(at(SHAPES[index], time, &p), offset);
    }

    #[test]
    fn what_swings_keeps_to_its_amplitude(time in 0.0..100.0_f64, index in 4..7_usize, edge_time in 0.0..0.5_f64) {
        let p = Parameters { amplitude: 1.7, offset: 0.4, edge_time, ..parameters() };
        prop_assert!((at(SHAPES[index], time, &p) - 0.4).abs() <= 1.7 + 1e-12);
    }
}
