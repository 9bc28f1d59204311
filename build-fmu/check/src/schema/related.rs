//! The manifest of FMI-LS-REF (`fmi3LayeredStandardReferenceManifest.xsd`) and MA-HS-Experiments
//! (`maHarmonizedSpecificationExperiments.xsd`, and the form of its text: times as attributes of `<Experiment>`).

use super::Type::{Double, Text, Uri};
use super::{Attribute, Content, Element, any, element, maybe, optional, required, some};

static ANNOTATIONS: Element = element("Annotations", &[], &[&[some(&[&ANNOTATION])]]);
static ANNOTATION: Element = Element {
    name: "Annotation",
    namespace: None,
    attributes: &[&[required("type", Text)]],
    content: Content::Foreign { one: false },
};

/// `<Related>`; the root, whose attributes are of another namespace, has rules of its own.
pub static RELATED: Element = element(
    "Related",
    &[&[
        optional("type", Text),
        required("source", Uri),
        required("role", Text),
        optional("description", Text),
    ]],
    &[&[any(&[&LABEL]), maybe(&[&ANNOTATIONS])]],
);
static LABEL: Element = element("Label", &[&[required("name", Text), optional("description", Text)]], &[]);

const NAMED: &[Attribute] = &[required("name", Text), optional("description", Text)];
const TIMES: &[Attribute] =
    &[optional("startTime", Double), optional("stopTime", Double), optional("stepSize", Double)];
const SOURCE: &[Attribute] = &[optional("type", Text), required("source", Uri)];

/// `<Experiments>`.
pub static EXPERIMENTS: Element =
    element("Experiments", &[NAMED], &[&[some(&[&EXPERIMENT]), maybe(&[&ANNOTATIONS])]]);
static EXPERIMENT: Element = element(
    "Experiment",
    &[NAMED, TIMES, &[optional("tolerance", Double)]],
    &[&[
        maybe(&[
            &TRANSIENT,
            &STEADY_STATE,
            &PARAMETERS_OPTIMISED,
            &SET_POINT,
            &SENSITIVITY,
            &TRAJECTORY,
            &LINEARIZATION,
        ]),
        maybe(&[&PARAMETERS]),
        maybe(&[&STIMULI]),
        maybe(&[&REFERENCES]),
        maybe(&[&ANNOTATIONS]),
    ]],
);
static TRANSIENT: Element = element("TransientSimulation", &[TIMES], &[]);
static STEADY_STATE: Element = element("SteadyState", &[], &[]);
static PARAMETERS_OPTIMISED: Element = element("ParameterOptimization", &[], &[]);
static SET_POINT: Element = element("SetPointOptimization", &[], &[]);
static SENSITIVITY: Element = element("SensitivityAnalysis", &[], &[]);
static TRAJECTORY: Element = element("TrajectoryOptimization", &[], &[]);
static LINEARIZATION: Element = element("Linearization", &[], &[]);
static PARAMETERS: Element = element("Parameters", &[SOURCE], &[&[maybe(&[&ANNOTATIONS])]]);
static STIMULI: Element = element("Stimuli", &[SOURCE], &[&[maybe(&[&ANNOTATIONS])]]);
static REFERENCES: Element = element("References", &[SOURCE], &[&[maybe(&[&ANNOTATIONS])]]);
