//! Properties that hold for any linear system, any subdivision of time and any moment of saving.

use crate::common::*;
use proptest::prelude::*;
use strut_integrators::Method;

/// Row by row diagonally dominant, so that every solution decays.
fn stable_system() -> impl Strategy<Value = [[f64; 3]; 3]> {
    prop::array::uniform3(prop::array::uniform3(-5.0..5.0)).prop_map(|mut rows: [[f64; 3]; 3]| {
        for (i, row) in rows.iter_mut().enumerate() {
            row[i] = 0.0;
            row[i] = -0.1 - row.iter().map(|value| value.abs()).sum::<f64>();
        }
        rows
    })
}

fn state() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-2.0..2.0)
}

fn method() -> impl Strategy<Value = Method> {
    prop::sample::select(Method::ALL.to_vec())
}

/// exp(A t) x by the series, over intervals short enough that nothing cancels.
fn exponential(rows: &[[f64; 3]; 3], t: f64, x: [f64; 3]) -> [f64; 3] {
    let parts = 200;
    let h = t / f64::from(parts);
    (0..parts).fold(x, |x, _| {
        let mut sum = x;
        let mut term = x;
        for k in 1..16 {
            term =
                std::array::from_fn(|i| (0..3).map(|j| rows[i][j] * term[j]).sum::<f64>() * h / f64::from(k));
            sum = std::array::from_fn(|i| sum[i] + term[i]);
        }
        sum
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn linear_systems_follow_the_matrix_exponential(
        rows in stable_system(), start in state(), method in method(), calls in 1_u32..50,
    ) {
        let mut x = start;
        run(&mut integrator(method, 1e-9, 1.0), &mut Linear(rows), 2.0, calls, &mut x);
        let exact = exponential(&rows, 2.0, start);
        prop_assert!(difference(&x, &exact, 1.0) < 1e-7, "{x:?} {exact:?}");
    }

    #[test]
    fn any_subdivision_gives_the_same_result(
        rows in stable_system(), start in state(), method in method(),
        mut times in prop::collection::vec(0.0..2.0, 0..30),
    ) {
        times.extend([0.0, 2.0]);
        times.sort_by(f64::total_cmp);
        let mut once = start;
        run(&mut integrator(method, 1e-9, 1.0), &mut Linear(rows), 2.0, 1, &mut once);
        let mut often = start;
        let mut integrator = integrator(method, 1e-9, 1.0);
        for pair in times.windows(2) {
            integrator.advance(&mut Linear(rows), pair[0], pair[1], &mut often).expect("harmless");
        }
        prop_assert!(difference(&once, &often, 1.0) < 1e-7, "{once:?} {often:?}");
    }

    #[test]
    fn a_saved_integrator_continues_with_the_same_bits(
        start in prop::array::uniform2(-1.0..1.0), method in method(), tolerance in -9..-2,
        before in 0_u32..20, after in 1_u32..20, length in 1e-4..0.1, invalid: bool,
    ) {
        let mut original = integrator(method, 10_f64.powi(tolerance), 1.0);
        let mut x = start;
        let time = |i: u32| length * f64::from(i);
        for i in 0..before {
            original.advance(&mut Friction, time(i), time(i + 1), &mut x).expect("harmless");
        }
        if invalid {
            original.invalidate();
        }
        let words: Vec<u64> = original.save().collect();
        // Another past must not matter.
        let mut restored = integrator(method, 10_f64.powi(tolerance), 1.0);
        run(&mut restored, &mut Friction, 0.3, 3, &mut [1.0, 0.0]);
        prop_assert!(restored.load(&mut words.into_iter()).is_some());
        let mut y = x;
        for i in before..before + after {
            original.advance(&mut Friction, time(i), time(i + 1), &mut x).expect("harmless");
            restored.advance(&mut Friction, time(i), time(i + 1), &mut y).expect("harmless");
            prop_assert_eq!(x.map(f64::to_bits), y.map(f64::to_bits));
        }
        prop_assert!(original.save().eq(restored.save()));
    }
}
