//! Whether records want different values of a parameter.

use super::criteria::CRITERIA;

/// The value that a record on its own would choose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wish {
    /// The record's number, estimation records first.
    pub record: usize,
    /// The value.
    pub value: f64,
    /// Its standard deviation.
    pub deviation: f64,
}

/// The wish of a record from what its pieces say: values with their variances. Pieces that differ by more than these widen it
/// (R. T. Birge, The calculation of errors by the method of least squares, Physical Review 40 (1932)). None if no piece knows.
pub fn wish(record: usize, pieces: &[(f64, f64)]) -> Option<Wish> {
    let known =
        |(value, variance): &&(f64, f64)| value.is_finite() && variance.is_finite() && *variance > 0.0;
    let known: Vec<&(f64, f64)> = pieces.iter().filter(known).collect();
    let weight: f64 = known.iter().map(|(_, variance)| 1.0 / variance).sum();
    if weight == 0.0 {
        return None;
    }
    let value = known.iter().map(|(value, variance)| value / variance).sum::<f64>() / weight;
    let excess: f64 = known.iter().map(|(own, variance)| (own - value).powi(2) / variance).sum();
    let ratio = excess / (known.len() as f64 - 1.0).max(1.0);
    Some(Wish { record, value, deviation: (ratio.max(1.0) / weight).sqrt() })
}

/// The lowest and the highest wish of two records that clearly disagree on a parameter of this value; none if none do.
pub fn disagreement(wishes: &[Wish], value: f64) -> Option<(Wish, Wish)> {
    let pairs = wishes.iter().flat_map(|one| wishes.iter().map(move |two| (*one, *two)));
    let apart = |(low, high): &(Wish, Wish)| (high.value - low.value) / low.deviation.hypot(high.deviation);
    let matters = CRITERIA.visible * value.abs();
    let clear = pairs.filter(|it| apart(it) > CRITERIA.apart && it.1.value - it.0.value > matters);
    clear.max_by(|a, b| apart(a).total_cmp(&apart(b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn at(record: usize, value: f64, deviation: f64) -> Wish {
        Wish { record, value, deviation }
    }

    proptest! {
        #[test]
        fn only_what_is_clear_and_matters_is_a_disagreement(
            value in 1.0..1e3_f64, share in 0.0..1.0_f64, deviation in 1e-4..1.0_f64,
        ) {
            let wishes = [at(0, value, deviation * value), at(1, value * (1.0 + share), deviation * value)];
            let (apart, matters) = (CRITERIA.apart * deviation * 2.0_f64.sqrt(), CRITERIA.visible);
            let clear = share > apart && share > matters;
            let found = disagreement(&wishes, value);
            // At the edge, rounding decides.
            if (share - matters).abs() > 1e-9 && (share / apart - 1.0).abs() > 1e-9 {
                prop_assert_eq!(found.is_some(), clear);
            }
            // A factor of both changes nothing, nor does the order.
            let other = [at(1, wishes[1].value, wishes[1].deviation), at(0, wishes[0].value, wishes[0].deviation)];
            prop_assert_eq!(disagreement(&other, value), found);
        }
    }

    #[test]
    fn the_clearest_pair_is_told_the_lowest_first() {
        let wishes = [at(0, 100.0, 1.0), at(1, 130.0, 20.0), at(2, 80.0, 1.0)];
        assert_eq!(disagreement(&wishes, 100.0), Some((wishes[2], wishes[0])));
        assert_eq!(disagreement(&wishes[..1], 100.0), None);
    }

    #[test]
    fn pieces_that_differ_widen_what_their_record_wants() {
        let alike = wish(3, &[(1.0, 0.04), (1.1, 0.04)]).unwrap();
        assert_eq!(alike.record, 3);
        assert!((alike.value - 1.05).abs() < 1e-12 && (alike.deviation - 0.02_f64.sqrt()).abs() < 1e-12);
        let apart = wish(3, &[(0.0, 0.04), (2.0, 0.04)]).unwrap();
        assert!((apart.deviation - 1.0).abs() < 1e-12, "{apart:?}");
        let unknown = [(5.0, f64::INFINITY), (f64::NAN, 1.0), (5.0, 0.0)];
        assert_eq!(wish(3, &unknown), None);
        let some = wish(3, &[unknown[0], unknown[1], unknown[2], (1.0, 0.25)]).unwrap();
        assert_eq!((some.value, some.deviation), (1.0, 0.5));
    }
}
