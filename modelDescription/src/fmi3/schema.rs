//! The elements of FMI 3.0's model description and terminals, in the order that the schemas want, where they are not those of
//! FMI 2.0.

use serde::Serialize;

use crate::schema::{About, Category, Common, Experiment, Item, List, Real, Unit};

/// `<fmiModelDescription>`.
#[derive(Serialize)]
pub struct Document {
    #[serde(rename = "@fmiVersion")]
    pub fmi_version: &'static str,
    #[serde(rename = "@modelName")]
    pub model_name: String,
    #[serde(rename = "@instantiationToken")]
    pub token: String,
    #[serde(flatten)]
    pub about: About,
    #[serde(rename = "ModelExchange")]
    pub model_exchange: ModelExchange,
    #[serde(rename = "CoSimulation")]
    pub co_simulation: CoSimulation,
    #[serde(rename = "UnitDefinitions", skip_serializing_if = "List::is_empty")]
    pub units: List<Unit>,
    #[serde(rename = "TypeDefinitions", skip_serializing_if = "List::is_empty")]
    pub types: List<Type>,
    #[serde(rename = "LogCategories", skip_serializing_if = "List::is_empty")]
    pub log_categories: List<Category>,
    #[serde(rename = "DefaultExperiment")]
    pub experiment: Experiment,
    #[serde(rename = "ModelVariables")]
    pub variables: List<Variable>,
    #[serde(rename = "ModelStructure")]
    pub structure: List<Element>,
}

/// What an importer of model exchange may ask for.
#[derive(Serialize)]
pub struct ModelExchange {
    #[serde(flatten)]
    pub common: Capabilities,
}

/// What an importer of co-simulation may ask for.
#[derive(Serialize)]
pub struct CoSimulation {
    #[serde(flatten)]
    pub common: Capabilities,
    #[serde(rename = "@canHandleVariableCommunicationStepSize")]
    pub variable_step: bool,
    #[serde(rename = "@maxOutputDerivativeOrder")]
    pub output_derivatives: u32,
    #[serde(rename = "@mightReturnEarlyFromDoStep")]
    pub returns_early: bool,
    #[serde(rename = "@hasEventMode")]
    pub event_mode: bool,
}

/// What both interfaces can.
#[derive(Serialize)]
pub struct Capabilities {
    #[serde(rename = "@modelIdentifier")]
    pub identifier: String,
    #[serde(rename = "@canGetAndSetFMUState")]
    pub state: bool,
    #[serde(rename = "@canSerializeFMUState")]
    pub serializes: bool,
    #[serde(rename = "@providesDirectionalDerivatives")]
    pub directional: bool,
    #[serde(rename = "@providesAdjointDerivatives")]
    pub adjoint: bool,
}

/// A type; only enumerations are declared as types.
#[derive(Serialize)]
pub enum Type {
    EnumerationType(EnumerationType),
}

/// `<EnumerationType>`.
#[derive(Serialize)]
pub struct EnumerationType {
    #[serde(rename = "@name")]
    pub name: &'static str,
    #[serde(rename = "@description", skip_serializing_if = "str::is_empty")]
    pub description: &'static str,
    #[serde(rename = "$value")]
    pub items: Vec<EnumerationItem>,
}

/// The element that an item of an enumeration is.
#[derive(Serialize)]
pub enum EnumerationItem {
    Item(Item),
}

/// A variable; its type is the element's name.
#[derive(Serialize)]
pub enum Variable {
    Float64(Float64),
    Int32(Start<i32>),
    Boolean(Start<bool>),
    String(Text),
    Enumeration(Choice),
}

/// `<Float64>`.
#[derive(Serialize)]
pub struct Float64 {
    #[serde(flatten)]
    pub common: Common,
    #[serde(flatten)]
    pub real: Real,
    #[serde(rename = "Dimension", skip_serializing_if = "Option::is_none")]
    pub dimension: Option<Dimension>,
}

/// `<Dimension>` of an array.
#[derive(Serialize)]
pub struct Dimension {
    #[serde(rename = "@start")]
    pub start: usize,
}

/// `<Int32>` and `<Boolean>`.
#[derive(Serialize)]
pub struct Start<T> {
    #[serde(flatten)]
    pub common: Common,
    #[serde(rename = "@start")]
    pub start: T,
}

/// `<String>`.
#[derive(Serialize)]
pub struct Text {
    #[serde(flatten)]
    pub common: Common,
    #[serde(rename = "Start")]
    pub start: TextStart,
}

/// `<Start>` of a `<String>`.
#[derive(Serialize)]
pub struct TextStart {
    #[serde(rename = "@value")]
    pub value: String,
}

/// `<Enumeration>`.
#[derive(Serialize)]
pub struct Choice {
    #[serde(flatten)]
    pub common: Common,
    #[serde(flatten)]
    pub choice: crate::schema::Choice,
}

/// An element of `<ModelStructure>`.
#[derive(Serialize)]
pub enum Element {
    Output(Dependent),
    ContinuousStateDerivative(Dependent),
    InitialUnknown(Dependent),
    EventIndicator(Indicator),
}

/// What an unknown depends on; an empty list is written, for it says that there is nothing, where a missing one would say
/// that it is everything.
#[derive(Serialize)]
pub struct Dependent {
    #[serde(rename = "@valueReference")]
    pub reference: usize,
    #[serde(rename = "@dependencies")]
    pub dependencies: String,
}

/// An event indicator, which may depend on everything.
#[derive(Serialize)]
pub struct Indicator {
    #[serde(rename = "@valueReference")]
    pub reference: usize,
}

/// `<fmiTerminalsAndIcons>`.
#[derive(Serialize)]
pub struct TerminalsAndIcons {
    #[serde(rename = "@fmiVersion")]
    pub fmi_version: &'static str,
    #[serde(rename = "GraphicalRepresentation")]
    pub graphics: Graphics,
    #[serde(rename = "Terminals", skip_serializing_if = "Option::is_none")]
    pub terminals: Option<Terminals>,
}

/// `<GraphicalRepresentation>`.
#[derive(Serialize)]
pub struct Graphics {
    #[serde(rename = "CoordinateSystem")]
    pub system: CoordinateSystem,
    #[serde(rename = "Icon")]
    pub icon: Extent,
}

/// `<CoordinateSystem>`.
#[derive(Serialize)]
pub struct CoordinateSystem {
    #[serde(flatten)]
    pub extent: Extent,
    #[serde(rename = "@suggestedScalingFactorTo_mm")]
    pub scaling: &'static str,
}

/// Two corners.
#[derive(Clone, Copy, Serialize)]
pub struct Extent {
    #[serde(rename = "@x1")]
    pub x1: i32,
    #[serde(rename = "@y1")]
    pub y1: i32,
    #[serde(rename = "@x2")]
    pub x2: i32,
    #[serde(rename = "@y2")]
    pub y2: i32,
}

/// `<Terminals>`.
#[derive(Serialize)]
pub struct Terminals {
    #[serde(rename = "Terminal")]
    pub items: Vec<Terminal>,
}

/// `<Terminal>`.
#[derive(Serialize)]
pub struct Terminal {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "@matchingRule")]
    pub rule: &'static str,
    #[serde(rename = "TerminalMemberVariable", skip_serializing_if = "Vec::is_empty")]
    pub members: Vec<Member>,
    #[serde(rename = "Terminal", skip_serializing_if = "Vec::is_empty")]
    pub terminals: Vec<Terminal>,
}

/// `<TerminalMemberVariable>`.
#[derive(Serialize)]
pub struct Member {
    #[serde(rename = "@variableName")]
    pub variable: String,
    #[serde(rename = "@memberName")]
    pub name: String,
    #[serde(rename = "@variableKind")]
    pub kind: &'static str,
}
