//! What can go wrong in a simulation, in sentences that say what to do.

use strut_integrators::IntegrationError;

/// An error of a simulation. The simulation stays usable unless said otherwise.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A value reference that no variable of the type has.
    #[error(
        "value reference {reference} is no {kind} variable of {model}; see modelDescription.xml for the references"
    )]
    UnknownReference {
        /// Type asked for.
        kind: &'static str,
        /// The reference.
        reference: u32,
        /// Name of the model.
        model: &'static str,
    },
    /// A variable that may not be set (now).
    #[error("`{name}` cannot be set: {reason}")]
    NotSettable {
        /// Name of the variable.
        name: String,
        /// Why not.
        reason: &'static str,
    },
    /// A value that is not a finite number.
    #[error("`{name}` cannot be {value}: give a finite number")]
    NotFinite {
        /// Name of the variable.
        name: String,
        /// The value.
        value: f64,
    },
    /// A value out of its bounds.
    #[error("`{name}` = {value} {unit} is out of bounds: it must be {bound}")]
    OutOfBounds {
        /// Name of the variable.
        name: String,
        /// The value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// The bound in words: `at least 0`.
        bound: String,
    },
    /// A value that a setting cannot have.
    #[error("`{name}` cannot be {value}: {expected}")]
    NotAChoice {
        /// Name of the setting.
        name: &'static str,
        /// The value.
        value: String,
        /// What would be right.
        expected: String,
    },
    /// A variable that is read before it is calculated.
    #[error("`{name}` is calculated and has no value yet: read it in Initialization Mode or later")]
    NotCalculated {
        /// Name of the variable.
        name: String,
    },
    /// A start value for a variable that does not exist.
    #[error("there is no parameter `{name}` in {model}{}", .similar.as_ref().map(|name| format!("; did you mean `{name}`?")).unwrap_or_default())]
    UnknownName {
        /// The name.
        name: String,
        /// Name of the model.
        model: &'static str,
        /// The most similar name.
        similar: Option<String>,
    },
    /// A start value in a unit that is not the declared one.
    #[error("`{name}` is given in {given:?} but declared in {declared:?}: convert the value")]
    WrongUnit {
        /// Name of the variable.
        name: String,
        /// The unit that was given.
        given: String,
        /// The declared unit.
        declared: String,
    },
    /// The parameters do not fit together, or a resource is missing.
    #[error("{0}")]
    Refused(String),
    /// A derivative of an order that is not supported.
    #[error("derivative order {order} of `{name}` is not supported: {supported}")]
    Order {
        /// Name of the variable.
        name: String,
        /// The order.
        order: i32,
        /// What is supported.
        supported: &'static str,
    },
    /// A communication step that does not start where the last one ended, or does not go forward.
    #[error("{0}")]
    Time(String),
    /// The integration failed; the states are those before the step.
    #[error(transparent)]
    Integration(#[from] IntegrationError),
    /// A snapshot that does not belong to the model or is damaged.
    #[error("the saved state does not fit: {0}")]
    Snapshot(&'static str),
}
