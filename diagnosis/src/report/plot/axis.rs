//! Axes with ticks at round numbers, linear or logarithmic.

/// Decades that a logarithmic axis shows at most: what lies deeper is numerical noise.
const DECADES: f64 = 8.0;

/// Beyond this, differences of two values would overflow.
const LARGEST: f64 = 1e300;

/// One axis of a plot.
pub struct Axis {
    /// What is printed at the axis.
    pub label: String,
    /// Where ticks stand, as a share of the axis' length, with their text.
    pub ticks: Vec<(f64, String)>,
    logarithmic: bool,
    low: f64,
    high: f64,
}

impl Axis {
    /// From the smallest to the largest of the finite values, with a margin, and about `count` ticks.
    pub fn linear(label: &str, values: impl IntoIterator<Item = f64>, count: usize) -> Self {
        let (low, high) = range(values).unwrap_or((0.0, 0.0));
        let margin = (high - low) * 0.06;
        Self::between(label, low - margin, high + margin, count)
    }

    /// From the smallest to the largest of the finite values, without a margin.
    pub fn tight(label: &str, values: impl IntoIterator<Item = f64>, count: usize) -> Self {
        let (low, high) = range(values).unwrap_or((0.0, 0.0));
        Self::between(label, low, high, count)
    }

    fn between(label: &str, low: f64, high: f64, count: usize) -> Self {
        // A constant gets room to lie in the middle of.
        let room = if high > low { 0.0 } else { low.abs().max(f64::MIN_POSITIVE.sqrt()) * 0.5 };
        let room = if low == 0.0 && high == 0.0 { 1.0 } else { room };
        let (low, high) = (low - room, high + room);
        let step = step((high - low) / count.max(1) as f64);
        let first = (low / step - 1e-9).ceil();
        let last = (high / step + 1e-9).floor();
        let number = (last - first).clamp(0.0, 4.0 * count as f64) as usize;
        let largest = low.abs().max(high.abs());
        let ticks = (0..=number)
            .map(|index| (first + index as f64) * step)
            .map(|value| ((value - low) / (high - low), linear_label(value, step, largest)))
            .filter(|(share, _)| (-1e-6..=1.0 + 1e-6).contains(share))
            .collect();
        Self { label: label.to_owned(), ticks, logarithmic: false, low, high }
    }

    /// Over the finite positive values, with a margin as a share of the axis' length.
    pub fn logarithmic(label: &str, values: impl IntoIterator<Item = f64>, margin: f64) -> Self {
        let positive = values.into_iter().filter(|value| *value > 0.0).map(f64::log10);
        let (low, high) = range(positive).unwrap_or((0.0, 1.0));
        let low = low.max(high - DECADES);
        let (low, high) = if high - low > 0.05 { (low, high) } else { (low - 0.5, high + 0.5) };
        let margin = margin * (high - low);
        let (low, high) = (low - margin, high + margin);
        let plain = low >= -2.001 && high <= 4.001;
        let label_of = |exponent: i32, factor: f64| {
            if plain { format!("{}", factor * 10_f64.powi(exponent)) } else { power(exponent, factor) }
        };
        let (first, last) = (low.floor() as i32, high.ceil() as i32);
        let stride = if high - low > 5.0 { 2 } else { 1 };
        let factors: &[f64] = if high - low < 2.2 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let ticks = (first..=last)
            .filter(|exponent| exponent.rem_euclid(stride) == 0)
            .flat_map(|exponent| factors.iter().map(move |factor| (exponent, *factor)))
            .map(|(exponent, factor)| (f64::from(exponent) + factor.log10(), label_of(exponent, factor)))
            .map(|(place, label)| ((place - low) / (high - low), label))
            .filter(|(share, _)| (-1e-9..=1.0 + 1e-9).contains(share))
            .collect();
        Self { label: label.to_owned(), ticks, logarithmic: true, low, high }
    }

    /// Where a value lies, as a share of the axis' length; none if it cannot be shown.
    pub fn share(&self, value: f64) -> Option<f64> {
        let value = if self.logarithmic { value.log10() } else { value };
        let share = (value.clamp(-LARGEST, LARGEST) - self.low) / (self.high - self.low);
        // What a logarithmic axis leaves out runs along its bottom.
        let share = if self.logarithmic { share.max(0.0) } else { share };
        (value.is_finite() && share.is_finite()).then_some(share)
    }
}

/// Smallest and largest finite value.
fn range(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    finite.map(|value| value.clamp(-LARGEST, LARGEST)).fold(None, |range, value| match range {
        None => Some((value, value)),
        Some((low, high)) => Some((value.min(low), value.max(high))),
    })
}

/// A round step, not below the rough one.
fn step(rough: f64) -> f64 {
    let rough = rough.max(f64::MIN_POSITIVE);
    let magnitude = 10_f64.powf(rough.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * magnitude);
    steps.into_iter().find(|step| *step >= rough * 0.999).unwrap_or(rough)
}

fn linear_label(value: f64, step: f64, largest: f64) -> String {
    if value.abs() < step * 1e-6 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&largest) {
        return format!("{value:.1e}").replace(".0e", "e").replace('-', "−");
    }
    let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
    format!("{value:.decimals$}").replace('-', "−")
}

/// `2·10⁻³`.
fn power(exponent: i32, factor: f64) -> String {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| c.to_digit(10).map_or('⁻', |digit| digits[digit as usize]);
    let power: String = exponent.to_string().chars().map(raised).collect();
    if factor == 1.0 { format!("10{power}") } else { format!("{factor}·10{power}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<&str> {
        axis.ticks.iter().map(|(_, label)| label.as_str()).collect()
    }

    #[test]
    fn linear_ticks_are_round_numbers() {
        assert_eq!(labels(&Axis::tight("", [0.0, 10.0], 5)), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(labels(&Axis::tight("", [-0.012, 0.031], 5)), ["−0.01", "0", "0.01", "0.02", "0.03"]);
        assert_eq!(labels(&Axis::tight("", [0.0, 4.0e13], 4)), ["0", "1e13", "2e13", "3e13", "4e13"]);
        assert_eq!(labels(&Axis::tight("", [], 2)), ["−1", "0", "1"]);
    }

    #[test]
    fn logarithmic_ticks_are_powers_of_ten() {
        assert_eq!(labels(&Axis::logarithmic("", [0.5, 100.0], 0.0)), ["1", "10", "100"]);
        assert_eq!(
            labels(&Axis::logarithmic("", [1e-5, 3e-3, f64::NAN, 0.0], 0.0)),
            ["10⁻⁵", "10⁻⁴", "10⁻³"]
        );
        assert_eq!(labels(&Axis::logarithmic("", [1.0, 12.0], 0.0)), ["1", "2", "5", "10"]);
    }

    #[test]
    fn values_have_a_place_unless_they_are_not_finite_or_not_positive_on_a_logarithmic_axis() {
        let linear = Axis::tight("", [0.0, 10.0], 5);
        assert_eq!(linear.share(2.5), Some(0.25));
        assert_eq!(linear.share(f64::NAN), None);
        let logarithmic = Axis::logarithmic("", [1.0, 100.0], 0.0);
        assert_eq!(logarithmic.share(10.0), Some(0.5));
        assert_eq!(logarithmic.share(0.0), None);
    }

    #[test]
    fn ends_of_the_number_range_give_a_usable_axis() {
        for values in [[f64::MIN, f64::MAX], [5e-324, 1e-323], [1e16, 1e16 + 2.0], [1e300, 1e300]] {
            let linear = Axis::linear("", values, 5);
            assert!(linear.ticks.len() < 25 && linear.ticks.iter().all(|(share, _)| share.is_finite()));
            assert!(Axis::logarithmic("", values, 0.0).ticks.len() < 40);
        }
    }
}
