//! Where on a step an indicator crosses zero.

/// Share of a step to which an event's place is found: a change of a parameter that a difference is made with moves it by more.
const SHARP: f64 = 1e-13;

/// Hermite's cubic at a share of a step, from the values at both ends and the rates there times the step.
pub fn between(share: f64, [from, to]: [f64; 2], [rate, last]: [f64; 2]) -> f64 {
    let rest = 1.0 - share;
    let values = from * (1.0 + 2.0 * share) * rest * rest + to * share * share * (1.0 + 2.0 * rest);
    values + rate * share * rest * rest - last * share * share * rest
}

/// The least share known, below a last one, at which a function has the sign that it has at the last; it is asked there at last.
/// The Illinois method (M. Dowell, P. Jarratt, A modified regula falsi method, BIT 11, 1971).
pub fn root((first, last): (f64, f64), most: f64, mut of: impl FnMut(f64) -> f64) -> f64 {
    let (mut low, mut below, mut high, mut above) = (0.0, first, most, last);
    let mut kept = 0;
    while high - low > SHARP {
        let line = (low * above - high * below) / (above - below);
        let share = if line > low && line < high { line } else { 0.5 * (low + high) };
        let value = of(share);
        if (value > 0.0) == (first > 0.0) {
            (low, below) = (share, value);
            if kept < 0 {
                above *= 0.5;
            }
            kept = -1;
        } else {
            (high, above) = (share, value);
            if kept > 0 {
                below *= 0.5;
            }
            kept = 1;
        }
    }
    of(high);
    high
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_cubic_is_met_between_its_ends(c in prop::array::uniform4(-3.0..3.0_f64), share in 0.0..1.0_f64) {
            let value = |x: f64| c[0] + x * (c[1] + x * (c[2] + x * c[3]));
            let rate = |x: f64| c[1] + x * (2.0 * c[2] + x * 3.0 * c[3]);
            let found = between(share, [value(0.0), value(1.0)], [rate(0.0), rate(1.0)]);
            prop_assert!((found - value(share)).abs() < 1e-12, "{found} {}", value(share));
        }

        #[test]
        fn an_event_is_behind_its_root_by_next_to_nothing(root_at in 0.001..0.999_f64, bend in 0.0..5.0_f64, up: bool) {
            let sign = if up { 1.0 } else { -1.0 };
            let of = |share: f64| sign * (share - root_at) * (1.0 + bend * share * share);
            let (mut asked, mut last) = (0, 0.0);
            let found = root((of(0.0), of(1.0)), 1.0, |share| {
                (asked, last) = (asked + 1, share);
                of(share)
            });
            prop_assert!((found - root_at).abs() < 1e-12 && (of(found) > 0.0) != (of(0.0) > 0.0));
            prop_assert!(asked < 60 && last == found, "{asked}");
        }
    }

    #[test]
    fn what_crosses_at_once_is_found_at_the_beginning() {
        assert!(root((0.0, 1.0), 1.0, |share| share) < 1e-12);
    }
}
