//! Bundles of real variables, declared once.

use strut_integrators::Array;

use crate::Real;
use crate::unit::{ANY, Unit};

/// What is declared about a real variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Declaration {
    /// Structured name: `strut.coulomb.force`.
    pub name: String,
    /// The doc comment, as one line.
    pub doc: String,
    /// Unit; values are in base units of the SI.
    pub unit: Unit,
    /// Start value.
    pub start: f64,
    /// Smallest legal value.
    pub min: Option<f64>,
    /// Largest legal value.
    pub max: Option<f64>,
    /// Typical magnitude.
    pub nominal: Option<f64>,
    /// A parameter that is fixed at initialisation (others are tunable).
    pub fixed: bool,
    /// A state that is an output as well.
    pub output: bool,
    /// An additive constant at which the diagnosis looks for a missing signal.
    pub port: bool,
    /// Position from zero in the array that it is an element of, and the array's length.
    pub element: Option<(usize, usize)>,
}

impl Declaration {
    /// A declaration of which only the name is known.
    pub fn named(name: &str) -> Self {
        Self {
            name: name.into(),
            doc: String::new(),
            unit: ANY,
            start: 0.0,
            min: None,
            max: None,
            nominal: None,
            fixed: false,
            output: false,
            port: false,
            element: None,
        }
    }
}

/// Collects declarations and prefixes the names of groups.
#[derive(Debug, Default)]
pub struct Declarations {
    list: Vec<Declaration>,
    groups: Vec<(&'static str, &'static str)>,
}

impl Declarations {
    /// All declarations of a bundle, in the order of its array.
    pub fn of<B: Bundle<f64>>() -> Vec<Declaration> {
        let mut declarations = Self::default();
        B::declare(&mut declarations);
        declarations.into_list()
    }

    /// What was declared.
    pub fn into_list(self) -> Vec<Declaration> {
        self.list
    }

    /// Adds a variable to the current group.
    pub fn variable(&mut self, mut declaration: Declaration) {
        for (name, doc) in self.groups.iter().rev() {
            declaration.name = format!("{name}.{}", declaration.name);
            declaration.doc = format!("{doc}: {}", declaration.doc);
        }
        self.list.push(declaration);
    }

    /// Adds the variables of a group.
    pub fn group<B: Bundle<f64>>(&mut self, name: &'static str, doc: &'static str) {
        self.groups.push((name, doc));
        B::declare(self);
        self.groups.pop();
    }
}

impl Declarations {
    /// Adds the variables of a group, some of which have a smaller lower bound here: where a spring stands alone there may be
    /// none.
    ///
    /// # Panics
    /// If the group has no variable of such a name.
    pub fn bounded_group<B: Bundle<f64>>(
        &mut self,
        name: &'static str,
        doc: &'static str,
        least: &[(&str, f64)],
    ) {
        let first = self.list.len();
        self.group::<B>(name, doc);
        let outer: String = self.groups.iter().map(|(group, _)| format!("{group}.")).collect();
        for (own, min) in least {
            let full = format!("{outer}{name}.{own}");
            let found = self.list[first..].iter_mut().find(|it| it.name == full);
            found.unwrap_or_else(|| panic!("there is no variable `{full}`")).min = Some(*min);
        }
    }
}

/// A struct of declared real variables; made by `#[derive(Variables)]`.
pub trait Bundle<R>: Copy {
    /// Number of variables.
    const LEN: usize;
    /// The same number of plain numbers.
    type Array: Array;
    /// Builds the struct from its variables in order of declaration.
    fn gather(next: &mut impl FnMut() -> R) -> Self;
    /// Hands out the variables in order of declaration.
    fn scatter(&self, put: &mut impl FnMut(R));
    /// Makes each variable of its own value and those of the others.
    fn combine<const N: usize>(&self, others: [&Self; N], f: &mut impl FnMut(&R, [&R; N]) -> R) -> Self;
    /// Declares the variables in order.
    fn declare(declarations: &mut Declarations);

    /// Variable `i` is `f(i)`.
    #[inline]
    fn from_fn(mut f: impl FnMut(usize) -> R) -> Self {
        let mut index = 0;
        Self::gather(&mut || {
            index += 1;
            f(index - 1)
        })
    }

    /// Calls `f(i, variable i)`.
    #[inline]
    fn for_each(&self, mut f: impl FnMut(usize, R)) {
        let mut index = 0;
        self.scatter(&mut |value| {
            f(index, value);
            index += 1;
        });
    }
}

/// An array of variables, at least one; what the derived implementations of [`Bundle`] are made of.
///
/// By a loop, as [`each`] is: the closures of `array::from_fn` and `array::map` are compiled once more for each field of each model.
#[doc(hidden)]
#[inline]
pub fn elements<R: Copy, const N: usize>(next: &mut impl FnMut() -> R) -> [R; N] {
    let mut elements = [next(); N];
    for element in &mut elements[1..] {
        *element = next();
    }
    elements
}

/// The same part of each of several bundles, at least one.
#[doc(hidden)]
#[inline(always)]
pub fn each<'a, B, T, const N: usize>(bundles: [&'a B; N], part: impl Fn(&'a B) -> &'a T) -> [&'a T; N] {
    let mut parts = [part(bundles[0]); N];
    for i in 1..N {
        parts[i] = part(bundles[i]);
    }
    parts
}

/// No variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoVariables;

impl<R> Bundle<R> for NoVariables {
    const LEN: usize = 0;
    type Array = [f64; 0];
    #[inline]
    fn gather(_: &mut impl FnMut() -> R) -> Self {
        Self
    }
    #[inline]
    fn scatter(&self, _: &mut impl FnMut(R)) {}
    #[inline]
    fn combine<const N: usize>(&self, _: [&Self; N], _: &mut impl FnMut(&R, [&R; N]) -> R) -> Self {
        Self
    }
    fn declare(_: &mut Declarations) {}
}

/// The variables as plain numbers.
#[inline]
pub(crate) fn to_array<B: Bundle<f64>>(bundle: &B) -> B::Array {
    let mut array = B::Array::zeros();
    let slice = array.as_mut_slice();
    bundle.for_each(|i, value| slice[i] = value);
    array
}

/// The bundle with these numbers, as any scalar.
#[inline]
pub(crate) fn from_slice<R: Real, B: Bundle<R>>(numbers: &[f64]) -> B {
    B::from_fn(|i| R::from(numbers[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Variables, unit};

    /// A friction.
    #[derive(Variables, Clone, Copy, Debug, PartialEq)]
    struct Friction<R> {
        /// Force
        #[var(unit = N, start = 3.0, min = 0.0, max = 400.0)]
        force: R,
        /// Velocity scale.
        #[var(unit = M_PER_S, start = 0.008, fixed)]
        velocity: R,
    }

    /// An element.
    #[derive(Variables, Clone, Copy, Debug, PartialEq)]
    struct Element<R> {
        /// Stiffness
        #[var(unit = N_PER_M, start = 2.0e4, nominal = 1e4)]
        stiffness: R,
        /// Friction
        coulomb: Friction<R>,
        /// A custom unit
        #[var(unit = Unit::coherent("N2", unit::Base { kg: 2, ..unit::Base::NONE }))]
        odd: R,
        /// Table
        #[var(unit = N, start = [1.0, 2.0])]
        table: [R; 2],
    }

    #[test]
    fn combining_meets_each_variable_with_its_own_in_the_others() {
        let numbered = |from: f64| -> Element<f64> { Bundle::from_fn(|i| from + i as f64) };
        let [x, y, z] = [0.0, 100.0, 1000.0].map(numbered);
        let found = x.combine([&y, &z], &mut |x, [y, z]| x + 2.0 * y - z);
        assert_eq!(found, Bundle::from_fn(|i| 2.0 * i as f64 - 800.0));
    }

    #[test]
    fn a_group_prefixes_names_and_docs() {
        let list = Declarations::of::<Element<f64>>();
        let names: Vec<_> = list.iter().map(|declaration| declaration.name.as_str()).collect();
        assert_eq!(names, ["stiffness", "coulomb.force", "coulomb.velocity", "odd", "table[1]", "table[2]"]);
        assert_eq!(list[1].doc, "Friction: Force");
        assert_eq!((list[1].min, list[1].max, list[1].fixed), (Some(0.0), Some(400.0), false));
        assert!(list[2].fixed);
        assert_eq!(list[3].unit.symbol, "N2");
        assert_eq!((list[5].start, list[5].doc.as_str()), (2.0, "Table, 2"));
        assert_eq!(Element::<f64>::COUNT, 6);
    }

    /// A bench on which there may be no spring.
    #[derive(Variables, Clone, Copy, Debug, PartialEq)]
    struct Bench<R> {
        /// Element
        #[var(min(stiffness = 0.0))]
        element: Element<R>,
        /// Another one
        other: Element<R>,
    }

    #[test]
    fn a_group_may_have_bounds_of_its_own() {
        let of = |name: &str| {
            let list = Declarations::of::<Bench<f64>>();
            list.into_iter().find(|it| it.name == name).expect("it is declared").min
        };
        assert_eq!(["element.stiffness", "other.stiffness"].map(of), [Some(0.0), None]);
        assert_eq!(of("element.coulomb.force"), Some(0.0));
    }

    /// An element with more.
    #[derive(Variables, Clone, Copy, Debug, PartialEq)]
    struct More<R> {
        /// What every element has
        #[var(flatten)]
        element: Element<R>,
        /// Damping rate
        #[var(unit = N_S_PER_M)]
        damping: R,
        /// Force offset
        #[var(unit = N, port)]
        preload: R,
    }

    #[test]
    fn a_flattened_group_stands_among_the_others() {
        let [all, own] = [Declarations::of::<More<f64>>(), Declarations::of::<Element<f64>>()];
        assert_eq!((&all[..6], all[6].name.as_str()), (&own[..], "damping"));
        let more: More<f64> = from_slice(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
        assert_eq!((more.element.coulomb.velocity, more.damping), (3.0, 7.0));
    }

    #[test]
    fn only_the_flagged_variable_is_a_port() {
        let ports: Vec<_> = Declarations::of::<More<f64>>().into_iter().filter(|it| it.port).collect();
        assert_eq!(ports.iter().map(|it| it.name.as_str()).collect::<Vec<_>>(), ["preload"]);
    }

    #[test]
    fn arrays_and_structs_hold_the_same_numbers() {
        let element: Element<f64> = from_slice(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!((element.coulomb.velocity, element.table), (3.0, [5.0, 6.0]));
        assert_eq!(to_array(&element), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    }
}
