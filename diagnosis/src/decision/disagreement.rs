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
    /// Share of the power of the record's errors that goes where all parameters are what it would choose.
    pub share: f64,
}

/// A parameter's value, and what each record would choose.
pub type Wishes = (f64, Vec<Wish>);

/// The wish of a record from what its pieces say: values with their variances. Pieces that differ by more than these widen it
/// (R. T. Birge, The calculation of errors by the method of least squares, Physical Review 40 (1932)). None if no piece knows. `share`
/// as in [`Wish`].
pub fn wish(record: usize, pieces: &[(f64, f64)], share: f64) -> Option<Wish> {
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
    Some(Wish { record, value, deviation: (ratio.max(1.0) / weight).sqrt(), share })
}

/// The lowest and the highest wish of two records that clearly disagree on a parameter of this value; none if none do, or if neither's
/// errors would be visibly smaller with its own parameters.
pub fn disagreement(wishes: &[Wish], value: f64) -> Option<(Wish, Wish)> {
    let matters = CRITERIA.visible * value.abs();
    let pairs = wishes.iter().flat_map(|one| wishes.iter().map(move |two| (*one, *two)));
    let clear = pairs.filter(|it| {
        apart(it) > CRITERIA.apart
            && it.1.value - it.0.value > matters
            && it.0.share.max(it.1.share) > CRITERIA.visible
    });
    clear.max_by(|a, b| apart(a).total_cmp(&apart(b)))
}

/// Which of several parameters is the same in all records where these tell only ratios: by the parameter, what each record would
/// choose for all of them. Two parameters whose ratio differs most clearly cannot both be the same; the one is beside which fewer
/// others differ. None if no ratio clearly differs.
pub fn yardstick(beside: &[(usize, Vec<Wishes>)]) -> Option<usize> {
    let clear = |way: &[Wishes]| -> Vec<(usize, f64)> {
        let of = |(index, (value, wishes)): (usize, &Wishes)| {
            disagreement(wishes, *value).map(|it| (index, apart(&it)))
        };
        way.iter().enumerate().filter_map(of).collect()
    };
    let all: Vec<(usize, Vec<(usize, f64)>)> = beside.iter().map(|(held, way)| (*held, clear(way))).collect();
    let ratios = all.iter().flat_map(|(held, differing)| differing.iter().map(move |it| (*held, *it)));
    let (one, (other, _)) = ratios.max_by(|(_, a), (_, b)| a.1.total_cmp(&b.1))?;
    let of_pair = all.iter().filter(|(held, _)| *held == one || *held == other);
    of_pair.min_by_key(|(_, differing)| differing.len()).map(|(held, _)| *held)
}

/// Standard deviations between two wishes.
fn apart((low, high): &(Wish, Wish)) -> f64 {
    (high.value - low.value) / low.deviation.hypot(high.deviation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn at(record: usize, value: f64, deviation: f64) -> Wish {
        Wish { record, value, deviation, share: 0.5 }
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
            // What neither's errors show is none.
            let hidden = wishes.map(|it| Wish { share: 0.9 * CRITERIA.visible, ..it });
            prop_assert_eq!(disagreement(&hidden, value), None);
        }
    }

    #[test]
    fn what_fewer_differ_beside_is_the_yardstick() {
        let same = (10.0, vec![at(0, 10.0, 0.1), at(1, 10.0, 0.1)]);
        let differs = |by: f64| (10.0, vec![at(0, 10.0, 0.1), at(1, 10.0 + by, 0.1)]);
        let nothing = (10.0, vec![]);
        let untold = (10.0, vec![at(0, 10.0, 3.0), at(1, 12.0, 3.0)]);
        // A stiffer spring beside the same mass and damping. How heavy the wheel is then, no record tells.
        let beside_mass = (0, vec![nothing.clone(), differs(2.0), same.clone(), untold.clone()]);
        let beside_spring = (1, vec![differs(-2.5), nothing.clone(), differs(-2.0), untold.clone()]);
        let beside_damping = (2, vec![same, differs(2.0), nothing.clone(), untold.clone()]);
        let beside_wheel = (3, vec![untold.clone(), untold.clone(), untold, nothing]);
        let ways = [beside_wheel, beside_spring, beside_mass, beside_damping];
        assert_eq!(yardstick(&ways), Some(0));
        assert_eq!(yardstick(&ways[..1]), None);
        assert_eq!(yardstick(&[]), None);
    }

    #[test]
    fn the_clearest_pair_is_told_the_lowest_first() {
        let wishes = [at(0, 100.0, 1.0), at(1, 130.0, 20.0), at(2, 80.0, 1.0)];
        assert_eq!(disagreement(&wishes, 100.0), Some((wishes[2], wishes[0])));
        assert_eq!(disagreement(&wishes[..1], 100.0), None);
    }

    #[test]
    fn pieces_that_differ_widen_what_their_record_wants() {
        let alike = wish(3, &[(1.0, 0.04), (1.1, 0.04)], 0.5).unwrap();
        assert_eq!(alike.record, 3);
        assert!((alike.value - 1.05).abs() < 1e-12 && (alike.deviation - 0.02_f64.sqrt()).abs() < 1e-12);
        let apart = wish(3, &[(0.0, 0.04), (2.0, 0.04)], 0.5).unwrap();
        assert!((apart.deviation - 1.0).abs() < 1e-12, "{apart:?}");
        let unknown = [(5.0, f64::INFINITY), (f64::NAN, 1.0), (5.0, 0.0)];
        assert_eq!(wish(3, &unknown, 0.5), None);
        let some = wish(3, &[unknown[0], unknown[1], unknown[2], (1.0, 0.25)], 0.5).unwrap();
        assert_eq!((some.value, some.deviation), (1.0, 0.5));
    }
}
