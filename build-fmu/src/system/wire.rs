//! What leads from component to component.

use super::face::Variable;

/// A variable of a component, found.
#[derive(Clone, Copy)]
pub struct End<'a> {
    /// Position of the component.
    pub component: usize,
    /// The variable.
    pub variable: &'a Variable,
}

/// From an output to an input.
pub struct Wire<'a> {
    /// Where from.
    pub from: Source<'a>,
    /// Where to.
    pub to: Sink<'a>,
    /// What happens on the way.
    pub way: Way,
}

/// Where a wire begins.
#[derive(Clone, Copy)]
pub enum Source<'a> {
    /// At an output of a component.
    Output(End<'a>),
    /// At the adapter of this position.
    Adapter(usize),
}

/// Where a wire ends.
#[derive(Clone, Copy)]
pub enum Sink<'a> {
    /// At an input of a component.
    Input(End<'a>),
    /// At the adapter of this position, which transforms it.
    Adapter(usize),
    /// At the adapter of this position, which adds it.
    Added(usize),
}

/// What happens to a signal on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// Nothing.
    Straight,
    /// Nothing, whatever the units are: it was said so.
    AsItIs,
    /// The connection transforms it.
    Transformed {
        /// Factor.
        factor: f64,
        /// What is added.
        offset: f64,
    },
}

impl End<'_> {
    /// Whether it is the same variable.
    pub fn is(&self, other: End) -> bool {
        self.component == other.component && self.variable.name == other.variable.name
    }
}

impl Wire<'_> {
    /// Whether it ends at this input.
    pub fn leads_to(&self, end: End) -> bool {
        matches!(self.to, Sink::Input(to) if to.is(end))
    }
}
