//! Experiments: what drives an FMU, and what is expected of it.
//!
//! The text of MA-HS-Experiments and its example have times as attributes of `<Experiment>`; its newest schema has them in
//! `<TransientSimulation>`. The former is written, both are read. The draft has no place for how close an FMU has to come, so that
//! stands in an annotation.

use roxmltree::{Document, Node};

use crate::{Element, media};

/// Type of the annotation.
const ANNOTATION: &str = "io.github.strut-fmu.agreement";
const NAMESPACE: &str = "https://github.com/strut-fmu/strut/agreement";

/// `<Experiments>`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Experiments {
    /// What they are called together.
    pub name: String,
    /// What they are, for people.
    pub description: String,
    /// Each.
    pub all: Vec<Experiment>,
}

/// `<Experiment>`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Experiment {
    /// Its name.
    pub name: String,
    /// What it is, for people.
    pub description: String,
    /// Start time in seconds.
    pub start: Option<f64>,
    /// Stop time in seconds.
    pub stop: Option<f64>,
    /// Communication step in seconds.
    pub step: Option<f64>,
    /// Tolerance of the integration.
    pub tolerance: Option<f64>,
    /// Address of a parameter set.
    pub parameters: Option<String>,
    /// Address of the inputs.
    pub stimuli: Option<Table>,
    /// Address of the expected outputs.
    pub references: Option<Table>,
    /// How close the FMU comes.
    pub agreement: Option<Agreement>,
    /// Another kind of analysis than a simulation, if it is one.
    pub analysis: Option<String>,
}

/// A time series by its address.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// MIME type.
    pub media: String,
    /// Address, relative to the document.
    pub source: String,
}

impl Table {
    /// A CSV file.
    pub fn csv(source: &str) -> Self {
        Self { media: media::TABLE.into(), source: source.into() }
    }
}

/// How inputs go on from a row to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Between {
    /// They keep their value, as an importer without derivatives of inputs has it.
    #[default]
    Held,
    /// Straight, by derivatives of inputs.
    Linear,
}

/// What the expected outputs are, and how close the FMU comes to them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Agreement {
    /// How inputs go on.
    pub inputs: Between,
    /// Where the expected outputs come from: a sentence.
    pub origin: String,
    /// Of each signal.
    pub signals: Vec<Stated>,
}

/// The root mean square of an expected output less the FMU's.
#[derive(Clone, Debug, PartialEq)]
pub struct Stated {
    /// The output.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The stated error.
    pub rms: f64,
    /// By how much a replay's may differ from it.
    pub within: f64,
}

impl Experiments {
    /// The document.
    pub fn document(&self) -> Vec<u8> {
        let root =
            Element::new("Experiments").with("name", &self.name).with("description", &self.description);
        root.of(self.all.iter().map(Experiment::element)).document()
    }

    /// Reads a document, as it is.
    ///
    /// # Errors
    /// If its root is another, or a number of the agreement is none.
    pub fn read(document: &Document) -> Result<Self, String> {
        let root = document.root_element();
        if root.tag_name().name() != "Experiments" {
            return Err(format!("its root is <{}> and not <Experiments>", root.tag_name().name()));
        }
        let all = children(root, "Experiment").map(Experiment::read).collect::<Result<_, _>>()?;
        Ok(Self { name: text(root, "name"), description: text(root, "description"), all })
    }
}

impl Experiment {
    fn element(&self) -> Element {
        let number = |value: f64| format!("{value:?}");
        let element =
            Element::new("Experiment").with("name", &self.name).with("description", &self.description);
        let numbers = [
            ("startTime", self.start),
            ("stopTime", self.stop),
            ("stepSize", self.step),
            ("tolerance", self.tolerance),
        ];
        let given = numbers.into_iter().filter_map(|(name, value)| Some((name, number(value?))));
        let element = given.fold(element, |element, (name, value)| element.with(name, value));
        let parameters =
            self.parameters.iter().map(|source| Element::new("Parameters").with("source", source));
        let tables = [("Stimuli", &self.stimuli), ("References", &self.references)];
        let tables = tables.into_iter().filter_map(|(name, table)| {
            let table = table.as_ref()?;
            Some(Element::new(name).with("type", &table.media).with("source", &table.source))
        });
        element
            .of(parameters.chain(tables))
            .list("Annotations", self.agreement.iter().map(Agreement::element))
    }

    fn read(node: Node) -> Result<Self, String> {
        let name = text(node, "name");
        let failed = |error: String| format!("the experiment `{name}`: {error}");
        let child = |name: &'static str| children(node, name).next();
        let simulation = child("TransientSimulation");
        let number = |name: &str| -> Option<f64> {
            let given = node.attribute(name).or_else(|| simulation?.attribute(name))?;
            given.trim().parse().ok()
        };
        let table = |name: &'static str| {
            child(name).map(|it| Table {
                media: it.attribute("type").unwrap_or(media::TABLE).into(),
                source: text(it, "source"),
            })
        };
        const DATA: [&str; 5] = ["TransientSimulation", "Parameters", "Stimuli", "References", "Annotations"];
        let other = node.children().find(|it| it.is_element() && !DATA.contains(&it.tag_name().name()));
        let annotations = child("Annotations").into_iter().flat_map(|list| children(list, "Annotation"));
        let own =
            annotations.filter(|it| it.attribute("type") == Some(ANNOTATION)).flat_map(|it| it.children());
        let agreement = own.filter(Node::is_element).find(|it| it.tag_name().name() == "Agreement");
        Ok(Self {
            description: text(node, "description"),
            start: number("startTime"),
            stop: number("stopTime"),
            step: number("stepSize"),
            tolerance: number("tolerance"),
            parameters: child("Parameters").map(|it| text(it, "source")),
            stimuli: table("Stimuli"),
            references: table("References"),
            agreement: agreement.map(Agreement::read).transpose().map_err(failed)?,
            analysis: other.map(|it| it.tag_name().name().into()),
            name,
        })
    }
}

impl Agreement {
    fn element(&self) -> Element {
        let inputs = match self.inputs {
            Between::Held => "held",
            Between::Linear => "linear",
        };
        let signals = self.signals.iter().map(|it| {
            let signal = Element::new("Signal").with("name", &it.name).with("unit", &it.unit);
            signal.with("rms", format!("{:?}", it.rms)).with("within", format!("{:?}", it.within))
        });
        let agreement = Element::new("Agreement").with("xmlns", NAMESPACE).with("inputs", inputs);
        Element::new("Annotation")
            .with("type", ANNOTATION)
            .of([agreement.with("origin", &self.origin).of(signals)])
    }

    fn read(node: Node) -> Result<Self, String> {
        let inputs = match node.attribute("inputs") {
            None | Some("held") => Between::Held,
            Some("linear") => Between::Linear,
            Some(other) => return Err(format!("inputs are `held` or `linear`, and not `{other}`")),
        };
        let signal = |node: Node| {
            let name = text(node, "name");
            let number = |of: &str| {
                let value = node.attribute(of).and_then(|it| it.trim().parse::<f64>().ok());
                let good = value.filter(|it| it.is_finite() && *it >= 0.0);
                good.ok_or_else(|| format!("`{of}` of `{name}` is no number from zero on"))
            };
            Ok(Stated {
                unit: text(node, "unit"),
                rms: number("rms")?,
                within: number("within")?,
                name: name.clone(),
            })
        };
        let all = node.children().filter(|it| it.is_element() && it.tag_name().name() == "Signal");
        let signals = all.map(signal).collect::<Result<_, String>>()?;
        Ok(Self { inputs, origin: text(node, "origin"), signals })
    }
}

fn children<'a, 'input>(node: Node<'a, 'input>, name: &'a str) -> impl Iterator<Item = Node<'a, 'input>> {
    node.children().filter(move |it| it.is_element() && it.tag_name().name() == name)
}

fn text(node: Node, name: &str) -> String {
    node.attribute(name).unwrap_or_default().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one() -> Experiments {
        let signals =
            vec![Stated { name: "body.acceleration".into(), unit: "m/s2".into(), rms: 0.25, within: 1e-3 }];
        let origin = "measured".to_owned();
        let experiment = Experiment {
            name: "validation".into(),
            start: Some(0.0),
            stop: Some(5.0),
            step: Some(1e-3),
            parameters: Some("start.ssv".into()),
            stimuli: Some(Table::csv("in.csv")),
            references: Some(Table::csv("out.csv")),
            agreement: Some(Agreement { inputs: Between::Linear, origin, signals }),
            ..Experiment::default()
        };
        Experiments { name: "all".into(), description: "each".into(), all: vec![experiment] }
    }

    fn read(text: &str) -> Result<Experiments, String> {
        Experiments::read(&Document::parse(text).unwrap())
    }

    #[test]
    fn experiments_read_back() {
        assert_eq!(read(&String::from_utf8(one().document()).unwrap()), Ok(one()));
    }

    #[test]
    fn both_forms_of_the_draft_are_read() {
        let text = "<Experiments name='a'><Experiment name='b' tolerance='1e-4'><TransientSimulation startTime='1' \
                    stopTime='2' stepSize='0.5'/><References source='r.h5' type='application/hdf5'/></Experiment>\
                    <Experiment name='c'><SteadyState/></Experiment></Experiments>";
        let found = read(text).unwrap();
        assert_eq!(
            (found.all[0].start, found.all[0].stop, found.all[0].step),
            (Some(1.0), Some(2.0), Some(0.5))
        );
        assert_eq!(found.all[0].references.as_ref().unwrap().media, "application/hdf5");
        assert_eq!(
            (found.all[0].analysis.as_deref(), found.all[1].analysis.as_deref()),
            (None, Some("SteadyState"))
        );
    }

    #[test]
    fn a_broken_agreement_says_what_is_wrong() {
        let text = String::from_utf8(one().document()).unwrap();
        let error = read(&text.replace("rms=\"0.25\"", "rms=\"little\"")).unwrap_err();
        assert_eq!(
            error,
            "the experiment `validation`: `rms` of `body.acceleration` is no number from zero on"
        );
        assert!(read(&text.replace("\"linear\"", "\"cubic\"")).unwrap_err().contains("not `cubic`"));
    }
}
