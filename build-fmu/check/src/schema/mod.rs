//! The schemas of the standards: which elements and attributes there are, in which order, with which values.
//!
//! Each schema is declared once, as data, and read by one validator.

pub mod fmi;
pub mod related;
pub mod ssp;
mod validator;
mod values;

pub use validator::{Rules, validate};

/// An element.
#[derive(Debug)]
pub struct Element {
    /// Its name, without a prefix.
    pub name: &'static str,
    /// Its namespace, if its standard has one.
    pub namespace: Option<&'static str>,
    /// Its attributes, in groups that several elements share.
    pub attributes: &'static [&'static [Attribute]],
    /// What is in it.
    pub content: Content,
}

/// An element of a standard without a namespace, with elements in this order.
const fn element(
    name: &'static str,
    attributes: &'static [&'static [Attribute]],
    content: &'static [&'static [Particle]],
) -> Element {
    Element { name, namespace: None, attributes, content: Content::Sequence(content) }
}

/// What is in an element.
#[derive(Debug)]
pub enum Content {
    /// Elements, in this order.
    Sequence(&'static [&'static [Particle]]),
    /// Elements of other standards, one at most or any number.
    Foreign { one: bool },
}

/// One place in a sequence.
#[derive(Debug)]
pub struct Particle {
    /// The elements that may stand there: one of them at a time.
    pub elements: &'static [&'static Element],
    /// How many there must be.
    pub least: usize,
    /// How many there may be.
    pub most: usize,
}

/// An attribute.
#[derive(Debug)]
pub struct Attribute {
    /// Its name.
    pub name: &'static str,
    /// The type of its value.
    pub of: Type,
    /// Whether it must be there.
    pub required: bool,
}

/// The type of a value, by the names of XML Schema.
#[derive(Clone, Copy, Debug)]
pub enum Type {
    /// `xs:string`.
    Text,
    /// `xs:normalizedString`: a text in one line.
    Line,
    /// `xs:string` of one character at least.
    Named,
    /// `xs:ID`: a name without a colon.
    Id,
    /// `xs:anyURI`.
    Uri,
    /// `xs:double`.
    Double,
    /// `xs:int`.
    Int,
    /// `xs:unsignedInt`.
    UnsignedInt,
    /// `xs:boolean`.
    Boolean,
    /// `xs:dateTime`.
    DateTime,
    /// `xs:hexBinary`.
    Hex,
    /// One of these.
    OneOf(&'static [&'static str]),
    /// A list of `xs:double`.
    Doubles,
    /// A list of `xs:unsignedInt`.
    UnsignedInts,
    /// A list, each item one of these.
    ListOf(&'static [&'static str]),
}

/// An attribute that must be there.
const fn required(name: &'static str, of: Type) -> Attribute {
    Attribute { name, of, required: true }
}

/// An attribute that may be there.
const fn optional(name: &'static str, of: Type) -> Attribute {
    Attribute { name, of, required: false }
}

/// One element.
const fn one(elements: &'static [&'static Element]) -> Particle {
    Particle { elements, least: 1, most: 1 }
}

/// One element, or none.
const fn maybe(elements: &'static [&'static Element]) -> Particle {
    Particle { elements, least: 0, most: 1 }
}

/// Any number of elements.
const fn any(elements: &'static [&'static Element]) -> Particle {
    Particle { elements, least: 0, most: usize::MAX }
}

/// One element or more.
const fn some(elements: &'static [&'static Element]) -> Particle {
    Particle { elements, least: 1, most: usize::MAX }
}
