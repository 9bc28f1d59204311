//! A constant beside another quantity.

use strut_model::Real;

/// Another force, torque or flow and a constant one; without the constant it costs one question.
#[inline]
pub fn with_constant<R: Real>(other: R, constant: R) -> R {
    if constant.vanishes() { other } else { other + constant }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::Dual64;

    #[test]
    fn a_constant_is_added_and_a_varied_zero_has_a_derivative() {
        assert_eq!([with_constant(2.0, 0.0), with_constant(2.0, -3.0)], [2.0, -1.0]);
        let varied = with_constant(Dual64::from(2.0), Dual64::new(0.0, 1.0));
        assert_eq!((varied.re, varied.eps), (2.0, 1.0));
    }
}
