//! Parameter sets of SSP 1.0 (SSV), each value with its source and interval.
//!
//! SSP 1.0 has no attribute for either: a description is for people, an annotation for programs.

use strut_model::Value;

use crate::Element;

/// Type of the annotation.
const ANNOTATION: &str = "io.github.strut-fmu.parameter";
const NAMESPACE: &str = "https://github.com/strut-fmu/strut/parameter";

/// A value as an element of SSP 1.0, a real one with its unit, if that has a symbol.
pub fn typed(value: &Value, unit: &str) -> Element {
    match value {
        Value::Real(value) => Element::with_unit("ssv:Real", unit).with("value", format!("{value:?}")),
        Value::Integer(value) => Element::new("ssv:Integer").with("value", value),
        Value::Boolean(value) => Element::new("ssv:Boolean").with("value", value),
        Value::Text(value) => Element::new("ssv:String").with("value", value),
    }
}

/// The root of a document with a parameter set.
pub fn root(name: &str) -> Element {
    Element::new("ssv:ParameterSet")
        .with("xmlns:ssc", "http://ssp-standard.org/SSP1/SystemStructureCommon")
        .with("xmlns:ssv", "http://ssp-standard.org/SSP1/SystemStructureParameterValues")
        .with("version", "1.0")
        .with("name", name)
}

/// A parameter set.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParameterSet {
    /// Its name.
    pub name: String,
    /// What it is.
    pub description: String,
    /// Its values.
    pub values: Vec<Given>,
}

/// A value with its provenance.
#[derive(Clone, Debug, PartialEq)]
pub struct Given {
    /// Name of the variable.
    pub name: String,
    /// In the variable's unit.
    pub value: Value,
    /// The variable's unit, for people: conversions are the importer's.
    pub unit: String,
    /// Where the value comes from.
    pub source: String,
    /// Ends of the 95 % interval.
    pub interval: Option<[f64; 2]>,
}

impl Given {
    fn element(&self) -> Element {
        let number = |value: f64| format!("{value:?}");
        let (unit, source) = (&self.unit, &self.source);
        let interval = self.interval.map(|[low, high]| format!("95 % interval {low:.6} to {high:.6} {unit}"));
        let words: Vec<&str> = [source.as_str(), interval.as_deref().unwrap_or_default()]
            .into_iter()
            .filter(|text| !text.is_empty())
            .collect();
        let mut told =
            Element::new("Provenance").with("xmlns", NAMESPACE).with("unit", unit).with("source", source);
        if let Some([low, high]) = self.interval {
            told = told.with("low", number(low)).with("high", number(high)).with("level", "0.95");
        }
        let mut parameter = Element::new("ssv:Parameter").with("name", &self.name);
        if !words.is_empty() {
            parameter = parameter.with("description", words.join("; "));
        }
        let annotation = Element::new("ssc:Annotation").with("type", ANNOTATION).of([told]);
        parameter.of([typed(&self.value, ""), Element::new("ssv:Annotations").of([annotation])])
    }
}

impl ParameterSet {
    /// The document.
    pub fn document(&self) -> Vec<u8> {
        root(&self.name)
            .with("description", &self.description)
            .of([Element::new("ssv:Parameters").of(self.values.iter().map(Given::element))])
            .document()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_has_its_source_and_interval() {
        let value = Given {
            name: "strut.coulomb.force".into(),
            value: Value::Real(60.5),
            unit: "N".into(),
            source: "fitted to the records".into(),
            interval: Some([59.0, 62.0]),
        };
        let set = ParameterSet { name: "rig".into(), values: vec![value], ..ParameterSet::default() };
        let text = String::from_utf8(set.document()).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let told = document.descendants().find(|it| it.tag_name().name() == "Provenance").unwrap();
        assert_eq!((told.attribute("low"), told.attribute("high")), (Some("59.0"), Some("62.0")));
        assert!(text.contains("fitted to the records; 95 % interval 59.000000 to 62.000000 N"));
    }
}
