//! A small tree of elements, for documents whose shape follows from data.

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, Event};

/// An element.
#[derive(Clone, Debug, Default)]
pub struct Element {
    name: &'static str,
    attributes: Vec<(&'static str, String)>,
    children: Vec<Element>,
}

impl Element {
    /// An element without anything in it.
    pub fn new(name: &'static str) -> Self {
        Self { name, ..Self::default() }
    }

    /// An element with a unit, if that has a symbol.
    pub fn with_unit(name: &'static str, unit: &str) -> Self {
        match unit {
            "" => Self::new(name),
            unit => Self::new(name).with("unit", unit),
        }
    }

    /// With an attribute.
    #[must_use]
    #[expect(clippy::needless_pass_by_value, reason = "literals and numbers read better without a reference")]
    pub fn with(mut self, name: &'static str, value: impl ToString) -> Self {
        self.attributes.push((name, value.to_string()));
        self
    }

    /// With children.
    #[must_use]
    pub fn of(mut self, children: impl IntoIterator<Item = Element>) -> Self {
        self.children.extend(children);
        self
    }

    /// With these children in a list element, if there are any: an empty list is mostly illegal.
    #[must_use]
    pub fn list(self, name: &'static str, children: impl IntoIterator<Item = Element>) -> Self {
        let list = Self::new(name).of(children);
        if list.children.is_empty() { self } else { self.of([list]) }
    }

    /// The document.
    pub fn document(&self) -> Vec<u8> {
        let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
        let declaration = Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None));
        // Memory is written without errors.
        writer
            .write_event(declaration)
            .and_then(|()| self.write(&mut writer))
            .expect("a vector takes everything");
        let mut document = writer.into_inner();
        document.push(b'\n');
        document
    }

    fn write(&self, writer: &mut Writer<Vec<u8>>) -> std::io::Result<()> {
        let attributes = self.attributes.iter().map(|(name, value)| (*name, value.as_str()));
        let start = BytesStart::new(self.name).with_attributes(attributes);
        if self.children.is_empty() {
            return writer.write_event(Event::Empty(start));
        }
        writer.write_event(Event::Start(start))?;
        self.children.iter().try_for_each(|child| child.write(writer))?;
        writer.write_event(Event::End(BytesEnd::new(self.name)))
    }
}
