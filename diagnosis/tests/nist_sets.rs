//! The reference data sets are read as they are meant, and their models are written as they are printed.

use crate::nist::{self, Set};
use num_dual::Dual64;

/// The residuals at the certified solution, and their derivatives by each parameter.
fn residuals(set: &Set) -> (Vec<f64>, Vec<Vec<f64>>) {
    let residual = |k: usize| -> Vec<Dual64> {
        let mut b: Vec<Dual64> = set.certified.iter().map(|value| Dual64::from_re(*value)).collect();
        b[k] = b[k].derivative();
        set.x.iter().zip(&set.y).map(|(x, y)| nist::model(&set.name, &b, x) - *y).collect()
    };
    let all: Vec<Vec<Dual64>> = (0..set.certified.len()).map(residual).collect();
    let values = all[0].iter().map(|residual| residual.re).collect();
    (values, all.iter().map(|column| column.iter().map(|residual| residual.eps).collect()).collect())
}

/// By how much each residual may be off, as the certified solution has eleven digits.
fn rounding(set: &Set, slopes: &[Vec<f64>]) -> Vec<f64> {
    let of =
        |i: usize| slopes.iter().zip(&set.certified).map(|(slope, b)| slope[i].abs() * b.abs() * 5e-11).sum();
    (0..set.y.len()).map(of).collect()
}

#[test]
fn all_sets_are_there_and_whole() {
    let sets = nist::all();
    assert_eq!(sets.len(), 27);
    for set in &sets {
        let count = set.certified.len();
        assert!(count >= 2 && set.y.len() > count && set.x.len() == set.y.len(), "{}", set.name);
        assert!(set.starts.iter().all(|start| start.len() == count), "{}", set.name);
        assert_eq!(set.standard_errors.len(), count, "{}", set.name);
        assert!(["Lower", "Average", "Higher"].contains(&set.difficulty.as_str()), "{}", set.name);
    }
}

#[test]
fn the_certified_solution_has_the_certified_sum_of_squares() {
    for set in nist::all() {
        let (residuals, slopes) = residuals(&set);
        let sum: f64 = residuals.iter().map(|r| r * r).sum();
        let off = residuals.iter().zip(rounding(&set, &slopes)).map(|(r, off)| (2.0 * r.abs() + off) * off);
        let certified = set.residual_sum_of_squares;
        let allowed = 1e-10 * certified + off.sum::<f64>();
        assert!((sum - certified).abs() <= allowed, "{}: {sum} for {certified}, {allowed}", set.name);
    }
}

/// At a minimum no parameter changes the sum of squares to first order, but for the certified digits' rounding.
#[test]
fn the_certified_solution_is_a_minimum() {
    for set in nist::all() {
        let (residuals, slopes) = residuals(&set);
        let off = rounding(&set, &slopes);
        for (k, slope) in slopes.iter().enumerate() {
            let gradient: f64 = slope.iter().zip(&residuals).map(|(s, r)| s * r).sum();
            let allowed: f64 = slope.iter().zip(&off).map(|(s, off)| s.abs() * off).sum();
            assert!(gradient.abs() <= allowed, "{} b{}: {gradient}, {allowed}", set.name, k + 1);
        }
    }
}

/// Standard errors are √(s² (JᵀJ)⁻¹): of a parameter alone it would be at most the certified one.
#[test]
fn standard_errors_are_no_smaller_than_those_of_a_parameter_alone() {
    for set in nist::all() {
        let (residuals, slopes) = residuals(&set);
        let freedom = (set.y.len() - set.certified.len()) as f64;
        let variance = set.residual_sum_of_squares / freedom;
        for (slope, error) in slopes.iter().zip(&set.standard_errors) {
            let alone = (variance / slope.iter().map(|s| s * s).sum::<f64>()).sqrt();
            assert!(alone <= error * (1.0 + 1e-8), "{}: {alone} over {error}", set.name);
        }
        assert_eq!(residuals.len(), set.y.len());
    }
}
