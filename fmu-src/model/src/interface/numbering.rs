//! How FMI 3.0 counts the variables: one numbering for all types, and an array is one variable.

use crate::{Declaration, layout::Section};

use super::{Interface, VariableKind};

/// Real variables that are the elements of an array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// Name of the array.
    pub name: String,
    /// Description of the array.
    pub doc: String,
    /// Position of the first element in the list of variables.
    pub first: usize,
    /// Number of elements.
    pub len: usize,
}

/// The arrays among a section's declarations. States are listed one by one, as an integrator knows them.
pub(super) fn tables(section: Section, first: usize, list: &[Declaration]) -> Vec<Table> {
    if matches!(section, Section::State | Section::Rate) {
        return Vec::new();
    }
    let heads = list.iter().enumerate().filter_map(|(index, declaration)| match declaration.element {
        Some((0, len)) => Some((index, len, declaration)),
        _ => None,
    });
    heads
        .map(|(index, len, Declaration { name, doc, .. })| Table {
            name: name.strip_suffix("[1]").unwrap_or(name).into(),
            doc: doc.strip_suffix(", 1").unwrap_or(doc).into(),
            first: first + index,
            len,
        })
        .collect()
}

/// The value references of FMI 3.0. Those of the real variables are the same as in FMI 2.0; an array has that of its first
/// element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Numbering {
    /// Number of elements of a real variable, by reference; zero for what is a part of an array.
    pub lengths: Vec<usize>,
    /// All references below this one are those of single real variables.
    pub singles: u32,
    /// The first of the settings.
    pub settings: u32,
    /// The first of the event indicators.
    pub indicators: u32,
    /// Time.
    pub time: u32,
}

impl Interface {
    /// The value references of FMI 3.0.
    pub fn numbering(&self) -> Numbering {
        let reals =
            self.variables.iter().filter(|variable| matches!(variable.kind, VariableKind::Real { .. }));
        let mut lengths = vec![1; reals.count()];
        for table in &self.tables {
            lengths[table.first..table.first + table.len].fill(0);
            lengths[table.first] = table.len;
        }
        // References are 32 bits wide, and nobody declares as many variables.
        let settings = lengths.len() as u32;
        let indicators = self.variables.len() as u32;
        let singles = lengths.iter().take_while(|length| **length == 1).count() as u32;
        let time = indicators + self.event_indicators as u32;
        Numbering { lengths, singles, settings, indicators, time }
    }
}
