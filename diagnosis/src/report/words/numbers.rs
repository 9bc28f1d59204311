//! Numbers and units as a reader sees them.

/// A number with a few significant digits: `57.3`, `−0.0042`, `1.2e7`; a dash if there is none.
pub fn number(value: f64) -> String {
    digits(value, 3)
}

/// The same with the number of significant digits.
pub fn digits(value: f64, significant: usize) -> String {
    if value.is_nan() {
        return "–".into();
    }
    if value.is_infinite() {
        return if value > 0.0 { "∞".into() } else { "−∞".into() };
    }
    if value == 0.0 {
        return "0".into();
    }
    let exact = format!("{value:.*e}", significant.saturating_sub(1));
    let exponent: i32 = exact.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0);
    let text = if (-4..6).contains(&exponent) {
        decimals(value, (significant as i32 - 1 - exponent).max(0) as usize)
    } else {
        let (mantissa, exponent) = exact.split_once('e').unwrap_or((&exact, "0"));
        let mantissa = if mantissa.contains('.') { mantissa.trim_end_matches('0') } else { mantissa };
        format!("{}e{exponent}", mantissa.trim_end_matches('.'))
    };
    text.replace('-', "−")
}

/// A number of at most `significant` digits, without zeros at its end: one that is typed into a tool.
pub fn trimmed(value: f64, significant: usize) -> String {
    let text = digits(value, significant);
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

fn decimals(value: f64, places: usize) -> String {
    let text = format!("{value:.places$}").replace('-', "−");
    if text.trim_start_matches('−').chars().all(|c| c == '0' || c == '.') {
        text.replace('−', "")
    } else {
        text
    }
}

/// A value with the ends of its interval, to the digits that the interval's width gives meaning to.
pub fn interval(value: f64, low: f64, high: f64) -> [String; 3] {
    let width = (high - low).abs();
    let largest = value.abs().max(low.abs()).max(high.abs());
    if !(width > 0.0 && width.is_finite() && (1e-4..1e6).contains(&largest)) {
        return [digits(value, 4), digits(low, 4), digits(high, 4)];
    }
    let places = (1.0 - (width / 2.0).log10().floor()).clamp(0.0, 8.0) as usize;
    [value, low, high]
        .map(|number| if number.is_finite() { decimals(number, places) } else { self::number(number) })
}

/// A fit (NRMSE) with this number of decimals: `0.08`, `−0.40`.
pub fn fit(phi: f64, places: usize) -> String {
    if phi.is_finite() && phi.abs() < 1e3 { decimals(phi, places) } else { number(phi) }
}

/// A share of one in per cent: `83 %`.
pub fn percent(share: f64) -> String {
    if !share.is_finite() {
        return "–".into();
    }
    let value = 100.0 * share;
    let sign = if value < 0.0 { "−" } else { "" };
    match value.abs() {
        size if size > 0.0 && size < 0.05 => return format!("{sign}<\u{2009}0.1 %"),
        size if size > 99.95 && size < 100.0 => return format!("{sign}>\u{2009}99.9 %"),
        _ => {}
    }
    let fine = value.abs() < 9.95 || (99.0..100.0).contains(&value.abs());
    let places = usize::from(fine && value != 0.0);
    if value.abs() < 1e6 {
        format!("{} %", decimals(value, places))
    } else {
        format!("{} %", digits(value, 2))
    }
}

/// A unit as it is printed: `N·s/m`, `m/s²`; nothing for a plain number.
pub fn unit(symbol: &str) -> String {
    if symbol == "1" || symbol == "-" {
        return String::new();
    }
    let mut text = String::new();
    let mut after_letter = false;
    for c in symbol.chars() {
        text.push(match c {
            '.' => '·',
            '2' if after_letter => '²',
            '3' if after_letter => '³',
            '4' if after_letter => '⁴',
            other => other,
        });
        after_letter = c.is_alphabetic();
    }
    text
}

/// A number with its unit.
pub fn quantity(value: f64, symbol: &str) -> String {
    format!("{} {}", number(value), unit(symbol)).trim_end().to_owned()
}

/// The same to the digits of a result.
pub fn value(value: f64, symbol: &str) -> String {
    format!("{} {}", digits(value, 4), unit(symbol)).trim_end().to_owned()
}

/// `name / unit`, for axes.
pub fn labelled(name: &str, symbol: &str) -> String {
    let unit = unit(symbol);
    if unit.is_empty() { name.to_owned() } else { format!("{name} / {unit}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_mean_something() {
        let texts = [57.34, -0.00423, 1.234e7, 0.0, f64::NAN, f64::NEG_INFINITY, 123_456.0].map(number);
        assert_eq!(texts, ["57.3", "−0.00423", "1.23e7", "0", "–", "−∞", "123456"]);
        assert_eq!(interval(57.34, 55.1, 59.4), ["57.3", "55.1", "59.4"]);
        assert_eq!(interval(0.01, f64::NAN, 0.02), ["0.01000", "–", "0.02000"]);
        assert_eq!(interval(2.0e7, 1.9e7, 2.1e7), ["2e7", "1.9e7", "2.1e7"]);
        assert_eq!(
            [0.834, 0.012, f64::NAN, -0.0, 0.9999, 1.0].map(percent),
            ["83 %", "1.2 %", "–", "0 %", ">\u{2009}99.9 %", "100 %"]
        );
    }

    #[test]
    fn a_number_to_be_typed_has_no_zeros_at_its_end() {
        let texts = [0.3, 15.0, 20.0, 0.006_12, 1.5e-7, 100.0].map(|it| trimmed(it, 6));
        assert_eq!(texts, ["0.3", "15", "20", "0.00612", "1.5e−7", "100"]);
    }

    #[test]
    fn fits_have_decimals() {
        assert_eq!([0.08, -0.4, f64::NAN, -1e7].map(|phi| fit(phi, 2)), ["0.08", "−0.40", "–", "−1e7"]);
    }

    #[test]
    fn units_are_printed_with_raised_digits() {
        assert_eq!(["m/s2", "N.s/m", "1", "m3"].map(unit), ["m/s²", "N·s/m", "", "m³"]);
    }
}
