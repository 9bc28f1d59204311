//! A signal that is computed from columns: `pA * 12.6 cm2 - pB * 8.2 cm2`.
//!
//! Columns come in with their units, numbers may have one, and the result has to be of the signal's kind: nobody adds a
//! pressure to a force. A column whose name is no word stands in braces: `{Weg FL} / 2`.
//!
//! ```text
//! sum     = product (("+" | "-") product)*
//! product = factor (("*" | "/") factor)*
//! factor  = "-" factor | atom ("^" integer)?
//! atom    = number unit? | function "(" sum ")" | name | "{" name "}" | "(" sum ")"
//! ```

use winnow::ascii::{dec_int, float, multispace0};
use winnow::combinator::{alt, delimited, eof, opt, preceded, repeat, terminated};
use winnow::error::{ContextError, ErrMode};
use winnow::prelude::*;
use winnow::token::{one_of, take_while};

use super::quantity::Quantity;

/// A formula that was read.
#[derive(Clone, Debug, PartialEq)]
pub enum Formula {
    /// A number in a unit; an empty one is 1.
    Number(f64, String),
    /// A column of the file.
    Column(String),
    /// Its negative.
    Negative(Box<Formula>),
    /// A function of one argument.
    Call(Function, Box<Formula>),
    /// Two parts and what is done with them.
    Pair(Box<Formula>, Operator, Box<Formula>),
    /// An integer power.
    Power(Box<Formula>, i8),
}

/// What two parts make.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// Sum.
    Add,
    /// Difference.
    Subtract,
    /// Product.
    Multiply,
    /// Quotient.
    Divide,
}

/// Functions that are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// Magnitude.
    Abs,
    /// Square root.
    Sqrt,
    /// Sine of an angle.
    Sin,
    /// Cosine of an angle.
    Cos,
}

const FUNCTIONS: [(&str, Function); 4] =
    [("abs", Function::Abs), ("sqrt", Function::Sqrt), ("sin", Function::Sin), ("cos", Function::Cos)];

/// Depth of brackets and signs beyond which nobody reads a formula, and no stack is safe.
const DEEPEST: usize = 64;

impl Formula {
    /// Reads a formula.
    ///
    /// # Errors
    /// It is none; the message shows where it ends to be one.
    pub fn parse(text: &str) -> Result<Self, String> {
        let nested = text.chars().filter(|it| matches!(it, '(' | '-')).count();
        if nested > DEEPEST {
            return Err(format!("`{text}`: more than {DEEPEST} brackets and signs"));
        }
        let mut rest = text;
        terminated(sum, (multispace0, eof)).parse_next(&mut rest).map_err(|_: ErrMode<ContextError>| {
            let at = if rest.trim().is_empty() { "its end".into() } else { format!("`{}`", rest.trim()) };
            format!(
                "`{text}` is no formula at {at}: known are + - * / ^, brackets, abs, sqrt, sin, cos, numbers with a unit as \
                 `12.6 cm2`, columns by their names, and in braces if a name is no word: `{{Weg FL}}`"
            )
        })
    }

    /// Every column of which it is made.
    pub fn columns(&self) -> Vec<&str> {
        match self {
            Self::Number(..) => Vec::new(),
            Self::Column(name) => vec![name],
            Self::Negative(of) | Self::Call(_, of) | Self::Power(of, _) => of.columns(),
            Self::Pair(a, _, b) => [a.columns(), b.columns()].concat(),
        }
    }

    /// Its value; `column` gives a column in SI.
    ///
    /// # Errors
    /// A unit is not known, or quantities do not go together.
    pub fn value(&self, column: &impl Fn(&str) -> Result<Quantity, String>) -> Result<Quantity, String> {
        Ok(match self {
            Self::Number(value, unit) => Quantity::new(&[*value], unit)?,
            Self::Column(name) => column(name)?,
            Self::Negative(of) => of.value(column)?.map(|it| -it),
            Self::Call(function, of) => call(*function, of.value(column)?)?,
            Self::Power(of, exponent) => of.value(column)?.power(*exponent)?,
            Self::Pair(a, operator, b) => {
                let (a, b) = (a.value(column)?, b.value(column)?);
                match operator {
                    Operator::Add => a.sum(&b, |a, b| a + b)?,
                    Operator::Subtract => a.sum(&b, |a, b| a - b)?,
                    Operator::Multiply => a.product(&b, 1)?,
                    Operator::Divide => a.product(&b, -1)?,
                }
            }
        })
    }
}

fn call(function: Function, of: Quantity) -> Result<Quantity, String> {
    if matches!(function, Function::Sin | Function::Cos) && !of.is_angle() {
        return Err(format!("sine and cosine are of an angle, and not of a quantity in {}", of.unit()));
    }
    match function {
        Function::Abs => Ok(of.map(f64::abs)),
        Function::Sqrt => of.root(),
        Function::Sin => Ok(of.number(f64::sin)),
        Function::Cos => Ok(of.number(f64::cos)),
    }
}

type Parsed<T> = Result<T, ErrMode<ContextError>>;

/// A sign or a bracket behind any white space.
fn sign<'a>(any: &'static [char]) -> impl Parser<&'a str, char, ErrMode<ContextError>> {
    preceded(multispace0, one_of(any))
}

fn sum(text: &mut &str) -> Parsed<Formula> {
    chain(text, product, &['+', '-'])
}

fn product(text: &mut &str) -> Parsed<Formula> {
    chain(text, factor, &['*', '/'])
}

/// Parts with operators of one rank between them, from the left.
fn chain(text: &mut &str, part: fn(&mut &str) -> Parsed<Formula>, any: &'static [char]) -> Parsed<Formula> {
    let first = part(text)?;
    let rest: Vec<(char, Formula)> = repeat(0.., (sign(any), part)).parse_next(text)?;
    Ok(rest.into_iter().fold(first, |left, (operator, right)| {
        let operator = match operator {
            '+' => Operator::Add,
            '-' => Operator::Subtract,
            '*' => Operator::Multiply,
            _ => Operator::Divide,
        };
        Formula::Pair(Box::new(left), operator, Box::new(right))
    }))
}

fn factor(text: &mut &str) -> Parsed<Formula> {
    if opt(sign(&['-'])).parse_next(text)?.is_some() {
        return Ok(Formula::Negative(Box::new(factor(text)?)));
    }
    let atom = atom(text)?;
    let exponent = opt(preceded(sign(&['^']), preceded(multispace0, dec_int))).parse_next(text)?;
    Ok(match exponent {
        Some(exponent) => Formula::Power(Box::new(atom), exponent),
        None => atom,
    })
}

fn atom(text: &mut &str) -> Parsed<Formula> {
    preceded(multispace0, alt((braced, bracketed, word, number))).parse_next(text)
}

fn braced(text: &mut &str) -> Parsed<Formula> {
    let name = delimited('{', take_while(1.., |it| it != '}'), '}').parse_next(text)?;
    Ok(Formula::Column(name.trim().into()))
}

fn bracketed(text: &mut &str) -> Parsed<Formula> {
    delimited('(', sum, sign(&[')'])).parse_next(text)
}

/// A function or a column.
fn word(text: &mut &str) -> Parsed<Formula> {
    let begins = |it: char| it.is_alphabetic() || it == '_';
    let name =
        (take_while(1, begins), take_while(0.., |it: char| it.is_alphanumeric() || it == '_' || it == '.'));
    let name = name.take().parse_next(text)?;
    let known = FUNCTIONS.iter().find(|(known, _)| *known == name);
    match (known, text.trim_start().starts_with('(')) {
        (Some((_, function)), true) => {
            let of = preceded(multispace0, bracketed).parse_next(text)?;
            Ok(Formula::Call(*function, Box::new(of)))
        }
        _ => Ok(Formula::Column(name.into())),
    }
}

/// A number, and behind a blank its unit.
fn number(text: &mut &str) -> Parsed<Formula> {
    let begins = |it: char| it.is_alphabetic() || matches!(it, '°' | '%' | 'µ');
    let part = |it: char| begins(it) || it.is_ascii_digit() || matches!(it, '²' | '³');
    let symbols = (take_while(1, begins), take_while(0.., move |it| part(it) || matches!(it, '.' | '/')));
    let value: f64 = float(text)?;
    let unit = opt(preceded(one_of(' '), symbols.take())).parse_next(text)?;
    Ok(Formula::Number(value, unit.unwrap_or_default().into()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn value(text: &str) -> Result<(f64, String), String> {
        let column = |name: &str| match name {
            "pA" => Quantity::new(&[10.0], "bar"),
            "pB" => Quantity::new(&[4.0], "bar"),
            "Weg FL" => Quantity::new(&[9.0], "mm"),
            "angle" => Quantity::new(&[30.0], "deg"),
            _ => Err(format!("no column {name}")),
        };
        let found = Formula::parse(text)?.value(&column)?;
        Ok((found.values[0], found.unit()))
    }

    #[test]
    fn two_pressures_on_two_areas_are_a_force() {
        let (force, unit) = value("pA * 12.6 cm2 - pB*8.2 cm2").unwrap();
        assert!((force - (1e6 * 12.6e-4 - 4e5 * 8.2e-4)).abs() < 1e-9, "{force}");
        assert_eq!(unit, "m·kg/s2");
    }

    #[test]
    fn signs_brackets_and_powers_bind_as_on_paper() {
        for (text, wanted) in [
            ("1 - 2 - 3", -4.0),
            ("2 * (1 + 3) / 4", 2.0),
            ("-2^2", -4.0),
            ("12 / 2 / 3", 2.0),
            ("2 + 3 * 4 ^ 2", 50.0),
            ("--1.5e1", 15.0),
            ("sqrt({Weg FL} / 4 mm) * abs(-2)", 3.0),
            ("sin(angle)", 0.5),
            ("cos( 60 deg )", 0.5),
            ("{Weg FL} ^ 2 / {Weg FL} / 1 m", 0.009),
        ] {
            let (found, unit) = value(text).unwrap_or_else(|error| panic!("{text}: {error}"));
            assert!((found - wanted).abs() < 1e-12 && unit == "1", "{text}: {found} {unit}");
        }
    }

    #[test]
    fn what_does_not_go_together_is_refused_in_words() {
        for (text, says) in [
            ("pA + 3 N", "kg/(m·s2) and m·kg/s2 are not added"),
            ("pA * 2 furlong", "`furlong` is not a unit"),
            ("pC * 2", "no column pC"),
            ("sqrt(pA)", "no square root"),
            ("sin(pA)", "of an angle"),
            ("pA * ", "no formula at `*`"),
            ("pA pB", "no formula at `pB`"),
            ("", "no formula at its end"),
            ("(pA", "is no formula"),
            ("pA ^ 200", "is no formula"),
            ("pA ^ 60", "power"),
        ] {
            let error = value(text).unwrap_err();
            assert!(error.contains(says), "{text}: {error}");
        }
        assert!(value(&"(".repeat(100_000)).is_err());
    }

    proptest! {
        #[test]
        fn any_text_is_a_formula_or_an_error(text in "[-+*/^(){} .0-9a-zµ°é²]{0,40}") {
            let _ = value(&text);
        }

        #[test]
        fn sums_and_products_are_those_of_numbers(a in -1e3..1e3_f64, b in 1e-3..1e3_f64, c in -1e3..1e3_f64) {
            let (found, _) = value(&format!("({a:?}) + ({b:?}) * ({c:?}) / {b:?}")).unwrap();
            prop_assert!((found - (a + b * c / b)).abs() <= 1e-9);
        }
    }
}
