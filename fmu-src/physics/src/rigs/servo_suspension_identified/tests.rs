use nalgebra::{Complex, SMatrix};
use strut_model::{Bundle, NoVariables};

use super::*;

type Matrix = SMatrix<f64, 6, 6>;

/// Units of one, so that numbers are those of the document.
const PLAIN: Parameters<f64> = Parameters { length_unit: 1.0, pressure_unit: 1.0, power_unit: 1.0 };

fn rates(p: &Parameters<f64>, x: [f64; 6], u: [f64; 2]) -> [f64; 6] {
    let (rates, _) = ServoSuspensionIdentified.equations(Instant {
        time: 0.0,
        state: &Bundle::from_fn(|i| x[i]),
        input: &Bundle::from_fn(|i| u[i]),
        parameters: p,
        derived: &NoVariables,
        memory: &NoVariables,
        tick: 0,
    });
    let mut list = [0.0; 6];
    rates.for_each(|i, rate| list[i] = rate);
    list
}

/// Column by column from the rates at unit states.
fn state_matrix(p: &Parameters<f64>) -> Matrix {
    let columns: Vec<[f64; 6]> =
        (0..6).map(|j| rates(p, std::array::from_fn(|i| f64::from(i == j)), [0.0; 2])).collect();
    Matrix::from_fn(|i, j| columns[j][i])
}

fn input_matrix(p: &Parameters<f64>) -> SMatrix<f64, 6, 2> {
    let columns = [rates(p, [0.0; 6], [1.0, 0.0]), rates(p, [0.0; 6], [0.0, 1.0])];
    SMatrix::from_fn(|i, j| columns[j][i])
}

/// Coefficients of |sI − A| by Faddeev and LeVerrier; whole numbers of this size stay exact.
fn characteristic_polynomial(a: Matrix) -> Vec<f64> {
    let (mut coefficients, mut m) = (vec![1.0], Matrix::identity());
    for k in 1..=6 {
        let am = a * m;
        let c = -am.trace() / f64::from(k);
        coefficients.push(c);
        m = am + Matrix::identity() * c;
    }
    coefficients
}

#[test]
fn the_characteristic_polynomial_is_that_of_equation_4_2_to_the_last_digit() {
    let printed = [1.0, 177.0, 15_713.0, 300_095.0, 6_612_388.0, 14_887_015.0, 8_559_185.0];
    assert_eq!(characteristic_polynomial(state_matrix(&PLAIN)), printed);
}

#[test]
fn eigenvalues_frequencies_and_damping_ratios_are_those_printed() {
    // Whatever the units are.
    let found = [PLAIN, Parameters { length_unit: 1e-3, pressure_unit: 1e5, power_unit: 1e5 }]
        .map(|p| state_matrix(&p).complex_eigenvalues());
    for values in found {
        for (re, im, digits, frequency, frequency_digits, ratio) in [
            (-1.0, 0.0, 1e-9, 0.159_15, 5e-6, 1.0),
            // Printed as -1.439, which 0.22894 Hz contradicts.
            (-1.4385, 0.0, 5e-5, 0.228_94, 5e-6, 1.0),
            (-7.495, 20.570, 5e-4, 3.4843, 5e-5, 0.342_34),
            (-79.786, 77.775, 5e-4, 17.733, 5e-4, 0.716_07),
        ] {
            let printed = Complex::new(re, im);
            let nearest =
                values.iter().min_by(|a, b| (*a - printed).norm().total_cmp(&(*b - printed).norm())).unwrap();
            assert!((nearest - printed).norm() < 1.5 * digits, "{nearest} {printed}");
            let size = nearest.norm();
            assert!(
                (size / std::f64::consts::TAU - frequency).abs() < frequency_digits,
                "{size} {frequency}"
            );
            assert!((-nearest.re / size - ratio).abs() < 5e-6 + 1e-9, "{nearest} {ratio}");
        }
    }
}

#[test]
fn nothing_acts_on_the_power() {
    let (a, b) = (state_matrix(&PLAIN), input_matrix(&PLAIN));
    assert_eq!(a.row(5).iter().copied().collect::<Vec<_>>(), [0.0, 0.0, 0.0, 0.0, 0.0, -1.0]);
    assert!(b.row(5).iter().all(|entry| *entry == 0.0));
    // All else can be moved by the inputs.
    let mut reached = SMatrix::<f64, 6, 12>::zeros();
    let mut column = b;
    for k in 0..6 {
        // Directions only: high powers of A are large.
        let scaled = column.map_with_location(|_, j, entry| entry / b.column(j).norm());
        reached.fixed_columns_mut::<2>(2 * k).copy_from(&scaled);
        column = a * column / 100.0;
    }
    assert_eq!(reached.rank(1e-9), 5);
}

#[test]
fn a_raised_road_raises_everything_by_about_as_much() {
    let (a, b) = (state_matrix(&PLAIN), input_matrix(&PLAIN));
    let rest = -(a.try_inverse().unwrap() * b);
    for (state, expected) in [(0, 1.0114), (2, 1.0094)] {
        assert!((rest[(state, 1)] - expected).abs() < 5e-5, "{rest}");
    }
    assert!(rest[(1, 1)].abs() < 1e-9 && rest[(3, 1)].abs() < 1e-9 && rest[(4, 1)].abs() < 1e-3);
}

/// The answer of body position and pressure to a volt, in the document's units.
fn answer(frequency: f64) -> [f64; 2] {
    let s = Complex::new(0.0, std::f64::consts::TAU * frequency);
    let a = state_matrix(&PLAIN).map(|entry| Complex::new(entry, 0.0));
    let b = input_matrix(&PLAIN).column(0).map(|entry| Complex::new(entry, 0.0));
    let x = (SMatrix::<Complex<f64>, 6, 6>::identity() * s - a).lu().solve(&b).unwrap();
    [x[0].norm(), x[4].norm()]
}

#[test]
fn displacements_in_metres_would_be_absurd() {
    for (frequency, body, pressure) in [
        (0.1, 46.99, 2.72),
        (1.0, 11.85, 0.743),
        (3.5, 3.193, 0.287),
        (5.0, 0.6228, 0.427),
        (20.0, 0.2486, 0.395),
    ] {
        let [found_body, found_pressure] = answer(frequency);
        assert!(
            (found_body / body - 1.0).abs() < 2e-3 && (found_pressure / pressure - 1.0).abs() < 2e-3,
            "{frequency}"
        );
    }
}

#[test]
fn units_scale_the_answer_to_the_voltage_and_not_that_to_the_road() {
    let si = Parameters { length_unit: 1e-3, pressure_unit: 1e5, power_unit: 1e5 };
    let [plain, scaled] = [PLAIN, si].map(|p| rates(&p, [0.0; 6], [2.0, 0.0]));
    assert!((scaled[1] - 1e-3 * plain[1]).abs() < 1e-12 && (scaled[4] - 1e5 * plain[4]).abs() < 1e-6);
    let [plain, scaled] = [PLAIN, si].map(|p| rates(&p, [0.01, 0.2, -0.003, 0.1, 0.0, 0.0], [0.0, 0.05]));
    for i in 0..4 {
        assert!((scaled[i] - plain[i]).abs() < 1e-12, "{i}");
    }
}
