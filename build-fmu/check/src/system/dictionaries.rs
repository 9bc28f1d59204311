//! Rules for signal dictionaries: each can be read, its signals are told apart, and each reference finds one.

use std::collections::BTreeMap;

use super::connectors::meant;
use super::documents::Wanted;
use super::signals::{Declared, Dictionary, Signal};
use super::structure::{Connector, Content, Element, FILE};
use super::{System, at, found};
use crate::finding::{Finding, Report, repeated};
use crate::package::Package;
use crate::rules::{Rule, practice, ssp};
use crate::unit::{Fit, Unit};

/// The dictionaries of all systems, and who refers to them.
#[derive(Default)]
pub struct Dictionaries {
    /// Each of them; none of what could not be read.
    known: Vec<Option<Dictionary>>,
    /// Which of them each reference is for, by the reference's path.
    references: BTreeMap<String, usize>,
}

impl Dictionaries {
    /// How many signals there are.
    pub fn signals(&self) -> usize {
        self.known.iter().flatten().map(|known| known.signals.len()).sum()
    }
}

impl System {
    /// Reads the dictionaries of a system and of those within it. Names are looked for from the inside out, so those of
    /// the systems around come along.
    pub(super) fn read_dictionaries(
        &self,
        system: &Element,
        around: &[(&str, usize)],
        read: &mut Dictionaries,
        package: &mut Package,
        report: &mut Report,
    ) {
        let Content::System { elements, dictionaries, .. } = &system.content else { return };
        let mut scope: Vec<(&str, usize)> = Vec::new();
        for declared in dictionaries {
            if scope.iter().any(|(name, _)| *name == declared.name) {
                let message =
                    format!("{} has two signal dictionaries of the name `{}`", system.shown(), declared.name);
                report.findings.push(Finding::error(ssp::DICTIONARY_TWICE, message).at(at(declared.line)));
                continue;
            }
            scope.push((&declared.name, read.known.len()));
            read.known.push(self.read_dictionary(declared, package, report));
        }
        scope.extend(around);
        for element in elements {
            let Content::Dictionary(name) = &element.content else {
                self.read_dictionaries(element, &scope, read, package, report);
                continue;
            };
            if let Some((_, index)) = scope.iter().find(|(known, _)| known == name) {
                read.references.insert(element.path.clone(), *index);
                continue;
            }
            let message = format!(
                "{} refers to the signal dictionary `{name}`, which there is none of in the systems around it",
                element.shown()
            );
            let finding = Finding::error(ssp::REFERENCE, message).at(at(element.line));
            report.findings.push(meant(finding, name, scope.iter().map(|(known, _)| *known)));
        }
    }

    /// The signals of a dictionary; none if they cannot be read, which is told.
    fn read_dictionary(
        &self,
        declared: &Declared,
        package: &mut Package,
        report: &mut Report,
    ) -> Option<Dictionary> {
        let Declared { name, media, source, inline, line } = declared;
        if media != Dictionary::MEDIA {
            report.skipped.push(format!("the signal dictionary `{name}`, which is of the type {media}"));
            return None;
        }
        let mut found = Vec::new();
        let mut wrong = |finding: Finding| report.findings.push(finding);
        let one_of_both = |message: &str| {
            Finding::error(ssp::DICTIONARY, format!("the signal dictionary `{name}` {message}"))
                .at(at(*line))
                .help("give the source of a file, or the signals in place")
        };
        let (dictionary, file) = match (source, inline) {
            (Some(_), Some(_)) => {
                wrong(one_of_both("has a file and signals in place"));
                return None;
            }
            (None, None) => {
                wrong(one_of_both("has neither a file nor signals in place"));
                return None;
            }
            (None, Some(inline)) => (inline.clone(), FILE.to_owned()),
            (Some(source), None) => {
                let rule = ssp::DICTIONARY;
                let wanted = Wanted { rule, what: "signals", source, within: None, line: *line };
                match self.document(&wanted, package, Dictionary::parse, &mut found) {
                    Ok(read) => read?,
                    Err(finding) => {
                        wrong(finding);
                        return None;
                    }
                }
            }
        };
        found.into_iter().for_each(&mut wrong);
        let names = dictionary.signals.iter().map(|signal| signal.name.as_str());
        for (signal, again) in dictionary.signals.iter().zip(repeated(names)) {
            if again {
                let message =
                    format!("the dictionary `{name}` has two signals of the name `{}`", signal.name);
                wrong(Finding::error(ssp::SIGNAL_TWICE, message).at(format!("{file}:{}", signal.line)));
            }
        }
        Some(dictionary)
    }

    /// Number and name of the dictionary that an element refers to, if it does.
    pub(super) fn referred<'a>(&self, element: &'a Element) -> Option<(usize, &'a str)> {
        let Content::Dictionary(name) = &element.content else { return None };
        self.dictionaries.references.get(&element.path).map(|index| (*index, name.as_str()))
    }

    /// The dictionary that an element refers to, if it could be read.
    fn dictionary(&self, element: &Element) -> Option<&Dictionary> {
        let (index, _) = self.referred(element)?;
        self.dictionaries.known[index].as_ref()
    }

    /// The signal that a reference's connector is for.
    pub(super) fn signal(&self, element: &Element, name: &str) -> Option<&Signal> {
        self.dictionary(element)?.signals.iter().find(|signal| signal.name == name)
    }

    /// The unit of such a signal.
    pub(super) fn unit_of_signal(&self, element: &Element, name: &str) -> Option<Unit> {
        let symbol = self.signal(element, name)?.unit.as_deref()?;
        Some(found(&self.dictionary(element)?.units, symbol))
    }

    /// What is wrong with a connector of a reference.
    pub(super) fn connector_of_signal(&self, element: &Element, connector: &Connector) -> Option<Finding> {
        let dictionary = self.dictionary(element)?;
        let Connector { name, line, .. } = connector;
        let shown = element.of(name);
        let wrong = |rule: &'static Rule, message: String| Finding::error(rule, message).at(at(*line));
        let Some(signal) = self.signal(element, name) else {
            let (_, of) = self.referred(element)?;
            let finding =
                wrong(ssp::CONNECTOR_VARIABLE, format!("`{shown}` is no signal of the dictionary `{of}`"));
            return Some(meant(finding, name, dictionary.signals.iter().map(|it| it.name.as_str())));
        };
        if let (Some(own), Some(theirs)) = (&connector.of_type, &signal.of_type)
            && own != theirs
        {
            let message = format!("`{shown}` is of type {own}, but its signal is {theirs}");
            return Some(wrong(practice::CONNECTOR_TYPE, message));
        }
        let (own, theirs) = (self.own_unit(connector)?, self.unit_of_signal(element, name)?);
        if own.fit(&theirs, 0) == Fit::Same {
            return None;
        }
        let (own, theirs) = (own.symbol, theirs.symbol);
        let message = format!("`{shown}` has the unit \"{own}\", but its signal has \"{theirs}\"");
        Some(wrong(practice::CONNECTOR_UNIT, message).help("give the signal's unit, or none"))
    }
}
