//! From the effects found to a system of FMUs, as text: no file is read, nothing is run.

use std::collections::BTreeSet;
use std::fmt::Write;

use strut_check::import::Unit;

use crate::plant::{Attachment, Conversion, FaceVariable, Own, Role, models};
use crate::report::words;
use crate::signal::distortion::{Correction, Fault};

use super::material::{Material, Value};

/// The system's name, and the name of its file without the ending.
pub const NAME: &str = "augmented";
/// The component of the other maker's FMU.
const MODEL: &str = "model";
/// The model that each of Strut's elements is.
const BENCH: &str = "ElementDyno";
/// Where every value of a set comes from.
const SOURCE: &str = "found by the diagnosis";

/// A system as the packager takes it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct System {
    /// Name and text of each file; the first one is the system's.
    pub files: Vec<(String, String)>,
    /// What it does not show, or not as the report does, in sentences.
    pub notes: Vec<String>,
}

/// A system on its way.
struct Draft<'m> {
    material: &'m Material<'m>,
    components: Vec<(String, String)>,
    connections: Vec<String>,
    parameters: String,
    outputs: Vec<String>,
    taken: BTreeSet<String>,
    system: System,
}

/// The system: the FMU, what drives it, the elements beside it, and the sensors that change what they measure.
///
/// # Errors
/// Why there can be none, in a sentence.
pub fn system(material: &Material<'_>) -> Result<System, String> {
    let mut draft = Draft {
        material,
        components: vec![(MODEL.into(), format!("{{ fmu = {} }}", quoted(&material.fmu.to_string_lossy())))],
        connections: Vec::new(),
        parameters: String::new(),
        outputs: Vec::new(),
        taken: Role::ALL.map(Role::name).into_iter().chain([MODEL]).map(str::to_owned).collect(),
        system: System::default(),
    };
    let needed: Vec<(Own, &Attachment)> =
        material.beside.iter().filter_map(|at| Some((material.own(at)?, at))).collect();
    draft.inputs(&needed)?;
    draft.values();
    for (own, at) in needed {
        draft.element(own, at)?;
    }
    draft.sensors();
    Ok(draft.finished())
}

impl<'m> Draft<'m> {
    /// A name that no component has yet.
    fn named(&mut self, start: &str, name: &str) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let name: String = format!("{start}_{name}").chars().map(plain).collect();
        let numbered = (2_u32..).map(|number| format!("{name}_{number}"));
        let free = std::iter::once(name.clone()).chain(numbered).find(|it| !self.taken.contains(it));
        let free = free.unwrap_or(name);
        self.taken.insert(free.clone());
        free
    }

    /// Adds a component of Strut's with a parameter set of its own.
    fn component(&mut self, name: &str, set: String) {
        let file = format!("{name}.toml");
        self.components.push((name.to_owned(), format!("{{ parameters = {} }}", quoted(&file))));
        self.system.files.push((file, set));
    }

    /// What drives the FMU: a record for what moves, a value for what rests.
    fn inputs(&mut self, beside: &[(Own, &Attachment)]) -> Result<(), String> {
        let material = self.material;
        for declared in material.face.variables.iter().filter(|it| it.causality == "input") {
            if declared.kind != "Real" {
                self.resting(declared)?;
                continue;
            }
            let Some((name, values)) = material.inputs.iter().find(|(name, _)| *name == declared.name) else {
                return Err(format!("nothing drives its input {}", declared.name));
            };
            let own: Vec<f64> = values.iter().map(|value| declared.conversion.own(*value)).collect();
            let rests = own.iter().all(|value| Some(value) == own.first());
            let mut forces = beside.iter().flat_map(|(_, at)| &at.acts_on);
            let acted_on = forces.any(|(input, _)| input == name);
            match own.first() {
                Some(value) if rests && !acted_on => self.value(declared, *value),
                _ => self.recorded(declared, &own),
            }
        }
        Ok(())
    }

    /// An input that is no real number keeps its start value.
    fn resting(&mut self, declared: &FaceVariable) -> Result<(), String> {
        let name = &declared.name;
        let start = declared.start.as_deref().unwrap_or("").trim();
        let text = match (declared.kind.as_str(), start) {
            ("Boolean", "true" | "1") => "true".to_owned(),
            ("Boolean", _) => "false".to_owned(),
            ("Integer", "") => "0".to_owned(),
            ("Integer", number) => number.to_owned(),
            ("String", text) => quoted(text),
            (kind, _) => return Err(format!("nothing drives its input {name} of type {kind}")),
        };
        let _ = writeln!(self.parameters, "{} = {{ value = {text} }}", quoted(&format!("{MODEL}.{name}")));
        Ok(())
    }

    fn recorded(&mut self, declared: &FaceVariable, values: &[f64]) {
        let name = self.named("record", &declared.name);
        let symbol = declared.unit.as_ref().map_or("", |unit| &unit.symbol);
        let mut csv = format!("time [s], signal [{symbol}]\n");
        for (index, value) in values.iter().enumerate() {
            // Nanoseconds: a product of floating-point numbers would have sixteen digits.
            let time = (index as f64 * self.material.sampling * 1e9).round() / 1e9;
            let _ = writeln!(csv, "{time},{value}");
        }
        let file = format!("{name}.csv");
        let title = format!("{} as it enters the model: {}", declared.name, self.material.record);
        let unit = declared.unit.as_ref();
        let set = format!(
            "fmu = {}\nmodel = \"RecordedSource\"\ntitle = {}\nsource = \"diagnosis\"\nfiles = [{}]\n\n[values]\n\
             file = {{ value = {}, source = \"the record\" }}\n{}",
            quoted(&format!("Augmented_{name}")),
            quoted(&title),
            quoted(&file),
            quoted(&file),
            units(&[("signal", unit)])
        );
        self.system.files.push((file, csv));
        self.component(&name, set);
        self.connect(&format!("{name}.signal"), &declared.name, "");
    }

    fn connect(&mut self, from: &str, input: &str, way: &str) {
        let to = quoted(&format!("{MODEL}.{input}"));
        self.connections.push(format!("{{ from = {}, to = {to}{way} }}", quoted(from)));
    }

    /// A start value of the FMU, in its own unit.
    fn value(&mut self, declared: &FaceVariable, own: f64) {
        let symbol = declared.unit.as_ref().map(|unit| format!(", unit = {}", quoted(&unit.symbol)));
        let name = quoted(&format!("{MODEL}.{}", declared.name));
        let _ = writeln!(self.parameters, "{name} = {{ value = {own:?}{} }}", symbol.unwrap_or_default());
    }

    /// The FMU's fitted parameters and its start values.
    fn values(&mut self) {
        for (name, value) in self.material.given() {
            if let Some(declared) = self.material.face.variable(&name) {
                self.value(declared, declared.conversion.own(value));
            }
        }
    }

    /// An element beside the FMU. Its bench moves the lower end: motion and force are the negatives of deflection and
    /// force.
    fn element(&mut self, own: Own, at: &Attachment) -> Result<(), String> {
        let (material, name) = (self.material, at.role.name());
        let missing = |name: &str, what: &str| {
            format!(
                "{what} {name} is no output of the FMU, and no output follows it; export the FMU with it as an output"
            )
        };
        let deflection = material
            .shown(&at.deflection)
            .ok_or_else(|| missing(&at.deflection, &format!("the deflection of the {name}")))?;
        // For a rate, the output's own offset does not count.
        let Conversion { factor, offset } = deflection.output.conversion;
        let zero = deflection.factor * offset + deflection.offset - at.rest;
        let to = |input: &str, from: &str, way: &str| {
            format!(
                "{{ from = {}, to = \"{name}.motion.{input}\"{way} }}",
                quoted(&format!("{MODEL}.{from}"))
            )
        };
        let along = deflection.factor * factor;
        let position = format!(", factor = {:?}, offset = {:?}", -along, -zero);
        let velocity = match material.shown(&at.velocity) {
            Some(shown) => {
                let Conversion { factor, offset } = shown.output.conversion;
                let way = format!(
                    ", factor = {:?}, offset = {:?}",
                    -shown.factor * factor,
                    -(shown.factor * offset + shown.offset)
                );
                to("velocity", &shown.output.name, &way)
            }
            None => {
                self.system.notes.push(format!(
                    "{} is no output of the FMU: the velocity of the {name} is the rate of change of {}",
                    at.velocity, deflection.output.name
                ));
                let way = format!(", factor = {:?}, operation = \"derivative\"", -along);
                to("velocity", &deflection.output.name, &way)
            }
        };
        let position = to("position", &deflection.output.name, &position);
        self.connections.extend([position, velocity]);
        for (input, factor) in &at.acts_on {
            let conversion = material.face.variable(input).map_or(Conversion::NONE, |it| it.conversion);
            let way = format!(", factor = {:?}", -factor / conversion.factor);
            self.connect(&format!("{name}.force"), input, &way);
        }
        let set = self.set(own, at.role);
        self.component(name, set);
        // All but its motion rests: no coil sets its damper.
        let bench = models::named(BENCH).ok_or_else(|| format!("there is no {BENCH}"))?;
        for it in bench.inputs.iter().filter(|it| !it.name.starts_with("motion.")) {
            let input = quoted(&format!("{name}.{}", it.name));
            let _ = writeln!(
                self.parameters,
                "{input} = {{ value = {:?}, unit = \"{}\" }}",
                it.start, it.unit.symbol
            );
        }
        self.outputs.push(format!("{name}.force"));
        Ok(())
    }

    /// The parameter set of an element's bench, under the bench's names: the effects found.
    fn set(&self, own: Own, role: Role) -> String {
        let (material, name) = (self.material, role.name());
        let mut set = format!(
            "fmu = \"Augmented_{name}\"\nmodel = \"{BENCH}\"\ntitle = \"The {name} beside the model, with the effects \
             found\"\nsource = \"diagnosis\"\n\n[values]\n",
        );
        let mut given = |name: &str, value: &str| {
            let _ = writeln!(set, "{} = {{ value = {value}, source = \"{SOURCE}\" }}", quoted(name));
        };
        let quantity = |value: f64, unit: &str| format!("{value:?}, unit = \"{unit}\"");
        let rates = role.rates();
        if role.is_tire() {
            given("element", "\"Tire\"");
            given("tire.lift_off", "false");
        }
        let named = |bench: &str| {
            let found = |it: &&Value<'_>| role.on_bench(it.name).as_deref() == Some(bench);
            material.parameters.iter().find(found).map(|it| it.value)
        };
        for ((rate, unit), has) in rates.into_iter().zip(["N/m", "N.s/m"]).zip([own.spring, own.damper]) {
            given(rate, &quantity(named(rate).filter(|_| has).unwrap_or(0.0), unit));
        }
        for it in material.parameters.iter().chain(&material.memory).filter(|it| it.value != it.start) {
            let bench = role.on_bench(it.name).filter(|name| !rates.contains(&name.as_str()));
            bench.iter().for_each(|name| given(name, &quantity(it.value, it.unit)));
        }
        set
    }

    /// The measured signals, as their sensors show them.
    fn sensors(&mut self) {
        let material = self.material;
        for (signal, correction) in &material.measured {
            let Some(shown) = material.shown(signal) else {
                self.system.notes.push(format!("{signal} is no output of the FMU and cannot be looked at"));
                continue;
            };
            self.untold(signal, correction);
            let amounts = [Fault::Gain, Fault::Offset, Fault::Lag].map(|it| correction.get(it));
            if shown.is_itself() && amounts == [0.0; 3] {
                self.outputs.push(format!("{MODEL}.{}", shown.output.name));
                continue;
            }
            let [gain, offset, lag] = amounts;
            // Behind the sensor, the signal is in the output's unit: (1 + gain) (factor y + offset) + the sensor's offset.
            let conversion = shown.output.conversion;
            let factor = (1.0 + gain) * shown.factor;
            let zero = factor * conversion.offset + (1.0 + gain) * shown.offset + offset - conversion.offset;
            let name = self.named("sensor", signal);
            let unit = shown.output.unit.as_ref();
            let step = material.step;
            let (operation, filter) = if lag > 0.0 { ("Lag", lag) } else { ("Value", 0.0) };
            let title = format!("What the sensor of {signal} shows");
            let set = format!(
                "fmu = {}\nmodel = \"SignalAdapter\"\ntitle = {}\nsource = \"diagnosis\"\n\n[values]\n\
                 operation = {{ value = \"{operation}\", source = \"{SOURCE}\" }}\n\
                 factor = {{ value = {factor:?}, source = \"{SOURCE}\" }}\n\
                 offset = {{ value = {:?}, source = \"{SOURCE}\" }}\n\
                 filter = {{ value = {filter:?}, unit = \"s\", source = \"{SOURCE}\" }}\n\
                 period = {{ value = {step:?}, unit = \"s\", source = \"the communication step\" }}\n{}",
                quoted(&format!("Augmented_{name}")),
                quoted(&title),
                zero / conversion.factor,
                units(&[("input", unit), ("added", unit), ("output", unit)])
            );
            self.component(&name, set);
            let from = quoted(&format!("{MODEL}.{}", shown.output.name));
            self.connections.push(format!("{{ from = {from}, to = \"{name}.input\" }}"));
            let _ = writeln!(self.parameters, "\"{name}.added\" = {{ value = 0.0{} }}", unit_of(unit));
            self.outputs.push(format!("{name}.output"));
        }
    }

    /// What a sensor does beyond gain, offset and lag. A delay of less than a step is none in a tool that makes steps.
    fn untold(&mut self, signal: &str, correction: &Correction) {
        let told = [Fault::Gain, Fault::Offset, Fault::Lag];
        let seen = |it: &Fault| match it {
            Fault::Delay => correction.get(*it).abs() >= self.material.step,
            _ => correction.get(*it) != 0.0,
        };
        let named = Fault::NAMED.into_iter().filter(|it| !told.contains(it) && seen(it));
        let mut others: Vec<String> = named.map(|it| it.name().to_owned()).collect();
        if !correction.response().is_neutral() {
            others.push("response".into());
        }
        if !others.is_empty() {
            let others = words::list(&others, "and");
            self.system
                .notes
                .push(format!("the sensor of {signal} is without its {others}, which the report has"));
        }
    }

    fn finished(self) -> System {
        let Self { material, components, connections, parameters, outputs, mut system, .. } = self;
        let samples = material.inputs.iter().map(|(_, values)| values.len()).max().unwrap_or(0);
        let stop = samples.saturating_sub(1) as f64 * material.sampling;
        let name = material.fmu.file_stem().unwrap_or_default().to_string_lossy();
        let title = format!("{name} as a diagnosis has augmented it, driven by {}", material.record);
        let mut text = format!(
            "name = \"{NAME}\"\ntitle = {}\nsource = \"diagnosis\"\nconnections = [\n",
            quoted(&title)
        );
        connections.iter().for_each(|it| text += &format!("    {it},\n"));
        let outputs: Vec<String> = outputs.iter().map(|it| quoted(it)).collect();
        let _ = write!(text, "]\noutputs = [{}]\n\n[components]\n", outputs.join(", "));
        components.iter().for_each(|(name, part)| text += &format!("{name} = {part}\n"));
        let _ = write!(text, "\n[experiment]\nstop = {stop:?}\nstep = {:?}\n\n[parameters]\n", material.step);
        text += &parameters;
        system.files.insert(0, (format!("{NAME}.toml"), text));
        system
    }
}

/// The units of a set's signals, if the FMU states one.
fn units(signals: &[(&str, Option<&Unit>)]) -> String {
    let stated = signals.iter().filter_map(|(name, unit)| Some(build_fmu::stated_unit(name, (*unit)?)));
    let all: String = stated.collect();
    if all.is_empty() { all } else { format!("\n[units]\n{all}") }
}

fn unit_of(unit: Option<&Unit>) -> String {
    unit.map_or_else(String::new, |unit| format!(", unit = {}", quoted(&unit.symbol)))
}

/// A text in TOML.
fn quoted(text: &str) -> String {
    toml::Value::String(text.into()).to_string()
}
