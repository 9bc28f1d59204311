//! The elements of FMI 2.0's model description, in the order that the schema wants.
//!
//! Attributes and lists that are empty are left out: the schema requires at least one entry in each
//! list that is present.

use serde::Serialize;

/// `<fmiModelDescription>`.
#[derive(Serialize)]
pub struct Document {
    #[serde(rename = "@fmiVersion")]
    pub fmi_version: &'static str,
    #[serde(rename = "@modelName")]
    pub model_name: String,
    #[serde(rename = "@guid")]
    pub guid: String,
    #[serde(flatten)]
    pub about: About,
    #[serde(rename = "@numberOfEventIndicators")]
    pub event_indicators: usize,
    #[serde(rename = "ModelExchange")]
    pub model_exchange: ModelExchange,
    #[serde(rename = "CoSimulation")]
    pub co_simulation: CoSimulation,
    #[serde(rename = "UnitDefinitions", skip_serializing_if = "List::is_empty")]
    pub units: List<Unit>,
    #[serde(rename = "TypeDefinitions", skip_serializing_if = "List::is_empty")]
    pub types: List<SimpleType>,
    #[serde(rename = "LogCategories", skip_serializing_if = "List::is_empty")]
    pub log_categories: List<Category>,
    #[serde(rename = "DefaultExperiment")]
    pub experiment: Experiment,
    #[serde(rename = "ModelVariables")]
    pub variables: List<ScalarVariable>,
    #[serde(rename = "ModelStructure")]
    pub structure: ModelStructure,
}

/// What either version says of an FMU as a whole.
#[derive(Serialize)]
pub struct About {
    #[serde(rename = "@description", skip_serializing_if = "String::is_empty")]
    pub description: String,
    #[serde(rename = "@author", skip_serializing_if = "String::is_empty")]
    pub author: String,
    #[serde(rename = "@version", skip_serializing_if = "String::is_empty")]
    pub version: String,
    #[serde(rename = "@copyright", skip_serializing_if = "String::is_empty")]
    pub copyright: String,
    #[serde(rename = "@license", skip_serializing_if = "String::is_empty")]
    pub license: String,
    #[serde(rename = "@generationTool", skip_serializing_if = "String::is_empty")]
    pub generation_tool: String,
    #[serde(rename = "@generationDateAndTime", skip_serializing_if = "Option::is_none")]
    pub generated: Option<String>,
    #[serde(rename = "@variableNamingConvention")]
    pub naming: &'static str,
}

/// An element that holds others of one kind.
#[derive(Serialize)]
pub struct List<T> {
    #[serde(rename = "$value")]
    pub items: Vec<T>,
}

impl<T> List<T> {
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }
}

impl<T> FromIterator<T> for List<T> {
    fn from_iter<I: IntoIterator<Item = T>>(items: I) -> Self {
        Self { items: items.into_iter().collect() }
    }
}

/// What a model-exchange master may ask for.
#[derive(Serialize)]
pub struct ModelExchange {
    #[serde(rename = "@modelIdentifier")]
    pub identifier: String,
    #[serde(rename = "@completedIntegratorStepNotNeeded")]
    pub completed_step_not_needed: bool,
    #[serde(flatten)]
    pub common: Capabilities,
}

/// What a co-simulation master may ask for.
#[derive(Serialize)]
pub struct CoSimulation {
    #[serde(rename = "@modelIdentifier")]
    pub identifier: String,
    #[serde(rename = "@canHandleVariableCommunicationStepSize")]
    pub variable_step: bool,
    #[serde(rename = "@canInterpolateInputs")]
    pub interpolates_inputs: bool,
    #[serde(rename = "@maxOutputDerivativeOrder")]
    pub output_derivatives: u32,
    #[serde(flatten)]
    pub common: Capabilities,
}

/// What both interfaces can.
#[derive(Clone, Copy, Serialize)]
pub struct Capabilities {
    #[serde(rename = "@canBeInstantiatedOnlyOncePerProcess")]
    pub only_once: bool,
    #[serde(rename = "@canNotUseMemoryManagementFunctions")]
    pub own_memory: bool,
    #[serde(rename = "@canGetAndSetFMUstate")]
    pub state: bool,
    #[serde(rename = "@canSerializeFMUstate")]
    pub serializes: bool,
    #[serde(rename = "@providesDirectionalDerivative")]
    pub directional: bool,
}

/// `<Unit>`.
#[derive(Serialize)]
pub struct Unit {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "BaseUnit", skip_serializing_if = "Option::is_none")]
    pub base: Option<BaseUnit>,
}

/// `<BaseUnit>`; exponents that are zero are left out.
#[derive(Default, Serialize)]
pub struct BaseUnit {
    #[serde(rename = "@kg", skip_serializing_if = "is_zero")]
    pub kg: i8,
    #[serde(rename = "@m", skip_serializing_if = "is_zero")]
    pub m: i8,
    #[serde(rename = "@s", skip_serializing_if = "is_zero")]
    pub s: i8,
    #[serde(rename = "@A", skip_serializing_if = "is_zero")]
    pub a: i8,
    #[serde(rename = "@K", skip_serializing_if = "is_zero")]
    pub k: i8,
    #[serde(rename = "@mol", skip_serializing_if = "is_zero")]
    pub mol: i8,
    #[serde(rename = "@cd", skip_serializing_if = "is_zero")]
    pub cd: i8,
    #[serde(rename = "@rad", skip_serializing_if = "is_zero")]
    pub rad: i8,
    #[serde(rename = "@factor", skip_serializing_if = "Option::is_none")]
    pub factor: Option<String>,
    #[serde(rename = "@offset", skip_serializing_if = "Option::is_none")]
    pub offset: Option<String>,
}

// The reference is serde's wish.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_zero(exponent: &i8) -> bool {
    *exponent == 0
}

/// `<SimpleType>`; only enumerations are declared as types.
#[derive(Serialize)]
pub struct SimpleType {
    #[serde(rename = "@name")]
    pub name: &'static str,
    #[serde(rename = "@description", skip_serializing_if = "str::is_empty")]
    pub description: &'static str,
    #[serde(rename = "Enumeration")]
    pub items: List<Item>,
}

/// `<Item>` of an enumeration.
#[derive(Serialize)]
pub struct Item {
    #[serde(rename = "@name")]
    pub name: &'static str,
    #[serde(rename = "@value")]
    pub value: i32,
    #[serde(rename = "@description", skip_serializing_if = "str::is_empty")]
    pub description: &'static str,
}

/// `<Category>` of log messages.
#[derive(Serialize)]
pub struct Category {
    #[serde(rename = "@name")]
    pub name: &'static str,
    #[serde(rename = "@description")]
    pub description: &'static str,
}

/// `<DefaultExperiment>`.
#[derive(Serialize)]
pub struct Experiment {
    #[serde(rename = "@startTime")]
    pub start: String,
    #[serde(rename = "@stopTime")]
    pub stop: String,
    #[serde(rename = "@tolerance")]
    pub tolerance: String,
    #[serde(rename = "@stepSize")]
    pub step: String,
}

/// What variables of every type say.
#[derive(Serialize)]
pub struct Common {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "@valueReference")]
    pub reference: usize,
    #[serde(rename = "@description", skip_serializing_if = "String::is_empty")]
    pub description: String,
    #[serde(rename = "@causality")]
    pub causality: &'static str,
    #[serde(rename = "@variability")]
    pub variability: &'static str,
    #[serde(rename = "@initial", skip_serializing_if = "Option::is_none")]
    pub initial: Option<&'static str>,
}

/// `<ScalarVariable>`. Its attributes stand beside an element without a name, which a flattened struct cannot.
#[derive(Serialize)]
pub struct ScalarVariable {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "@valueReference")]
    pub reference: usize,
    #[serde(rename = "@description", skip_serializing_if = "String::is_empty")]
    pub description: String,
    #[serde(rename = "@causality")]
    pub causality: &'static str,
    #[serde(rename = "@variability")]
    pub variability: &'static str,
    #[serde(rename = "@initial", skip_serializing_if = "Option::is_none")]
    pub initial: Option<&'static str>,
    #[serde(rename = "$value")]
    pub kind: Kind,
}

/// The element that says a variable's type.
#[derive(Serialize)]
pub enum Kind {
    Real(Real),
    Integer(Start<i32>),
    Boolean(Start<bool>),
    String(Start<String>),
    Enumeration(Choice),
}

/// What `<Real>` of FMI 2.0 and `<Float64>` of FMI 3.0 say; `start` of an array is that of its elements.
#[derive(Default, Serialize)]
pub struct Real {
    #[serde(rename = "@unit", skip_serializing_if = "String::is_empty")]
    pub unit: String,
    #[serde(rename = "@min", skip_serializing_if = "Option::is_none")]
    pub min: Option<String>,
    #[serde(rename = "@max", skip_serializing_if = "Option::is_none")]
    pub max: Option<String>,
    #[serde(rename = "@nominal", skip_serializing_if = "Option::is_none")]
    pub nominal: Option<String>,
    #[serde(rename = "@start", skip_serializing_if = "Option::is_none")]
    pub start: Option<String>,
    #[serde(rename = "@derivative", skip_serializing_if = "Option::is_none")]
    pub derivative: Option<usize>,
}

/// `<Integer>`, `<Boolean>` and `<String>`.
#[derive(Serialize)]
pub struct Start<T> {
    #[serde(rename = "@start")]
    pub start: T,
}

/// What `<Enumeration>` of a variable says.
#[derive(Serialize)]
pub struct Choice {
    #[serde(rename = "@declaredType")]
    pub declared_type: &'static str,
    #[serde(rename = "@min")]
    pub min: i32,
    #[serde(rename = "@max")]
    pub max: usize,
    #[serde(rename = "@start")]
    pub start: i32,
}

/// `<ModelStructure>`.
#[derive(Serialize)]
pub struct ModelStructure {
    #[serde(rename = "Outputs", skip_serializing_if = "List::is_empty")]
    pub outputs: List<Unknown>,
    #[serde(rename = "Derivatives", skip_serializing_if = "List::is_empty")]
    pub derivatives: List<Unknown>,
    #[serde(rename = "InitialUnknowns", skip_serializing_if = "List::is_empty")]
    pub initial_unknowns: List<Unknown>,
}

/// `<Unknown>`; an empty list of dependencies is written, for it says that there are none, where a
/// missing one would say that everything is one.
#[derive(Serialize)]
pub struct Unknown {
    #[serde(rename = "@index")]
    pub index: usize,
    #[serde(rename = "@dependencies")]
    pub dependencies: String,
}
