//! How many effects are on.

use strut_model::Real;

/// The number of magnitudes that do not vanish.
///
/// A model counts its effects where it derives parameters. While the count is zero one question leaves all of
/// them out, however many there are; only if it is not, each is asked for itself.
pub fn switched_on<R: Real>(magnitudes: impl IntoIterator<Item = R>) -> R {
    let (none, one) = (R::from(0.0), R::from(1.0));
    magnitudes.into_iter().fold(none, |count, magnitude| {
        // Which value it has does not matter; that it is asked for declares what the count depends on.
        if magnitude.vanishes() { count } else { count + magnitude.select(one, one) }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::Dual64;
    use strut_model::Dependencies;

    #[test]
    fn only_what_is_on_counts_negative_magnitudes_too() {
        assert_eq!(switched_on([0.0, 3.0, -0.0, -1e-9]), 2.0);
        assert!(switched_on([0.0, 0.0]).vanishes());
    }

    #[test]
    fn an_effect_that_is_being_varied_is_on() {
        let count = switched_on([Dual64::from(0.0), Dual64::new(0.0, 1.0)]);
        assert_eq!((count.re, count.eps), (1.0, 0.0));
    }

    #[test]
    fn it_depends_on_every_magnitude() {
        let count = switched_on([Dependencies::on(3), Dependencies::on(5)]);
        assert!(count.contains(3) && count.contains(5));
    }
}
