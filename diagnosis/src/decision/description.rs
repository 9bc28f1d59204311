//! Descriptions of a missing signal: which comes first, and the error that they leave.

/// The place of a rest without an explanation among descriptions, by the share that each explains of the signal before it: before the first
/// one that explains less than half. None if there is no such one.
pub fn place_of_rest(mut shares: impl Iterator<Item = f64>) -> Option<usize> {
    shares.position(|share| share < 1.0 - share)
}

/// Share of a root mean square error that descriptions leave, by the share of its power that each explains of the power before it.
pub fn error_left(shares: impl Iterator<Item = f64>) -> f64 {
    shares.map(|share| (1.0 - share.clamp(0.0, 1.0)).sqrt()).product()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rest_comes_before_a_description_that_explains_less() {
        let place = |shares: &[f64]| place_of_rest(shares.iter().copied());
        assert_eq!([place(&[]), place(&[0.12]), place(&[0.9])], [None, Some(0), None]);
        assert_eq!(place(&[0.9, 0.3]), Some(1));
    }

    #[test]
    fn a_second_description_has_only_the_error_that_the_first_one_leaves() {
        let left = |shares: &[f64]| error_left(shares.iter().copied());
        assert_eq!([left(&[]), left(&[1.0]), left(&[-0.5]), left(&[1.2])], [1.0, 0.0, 1.0, 0.0]);
        // A quarter of the power, and a ninth of that.
        assert!((left(&[0.75, 8.0 / 9.0]) - 1.0 / 6.0).abs() < 1e-12);
    }
}
