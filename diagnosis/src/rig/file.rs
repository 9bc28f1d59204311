//! A rig that a file describes, with a model of the library or of another maker.

use std::fs;
use std::path::Path;

use strut_model::Value;

use crate::catalogue::Element;
use crate::plant::{self, Attachment, Foreign, Instance, Plant, Role, models};

use super::Rig;
use super::kind::{ElementSignals, ForceOf, Given, Kind};
use super::own::{fmu_of, is_fmu, is_manifest};

impl Rig {
    /// Reads a rig file. Paths in it are relative to its folder.
    ///
    /// # Errors
    /// If the file or its model cannot be read, or names what the model does not have: all of it, with what to do.
    pub fn read(path: &Path) -> Result<Self, String> {
        let failed = |error: String| format!("`{}`: {error}", path.display());
        let text = fs::read_to_string(path).map_err(|error| failed(error.to_string()))?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Self::parse(&text, name, path.parent().unwrap_or(Path::new("."))).map_err(failed)
    }

    /// The rig of a rig file's text, by its name. Paths in it are relative to a folder.
    ///
    /// # Errors
    /// If the text is no rig file, its model cannot be read, or it names what the model does not have.
    pub fn parse(text: &str, name: String, folder: &Path) -> Result<Self, String> {
        let kind = Kind::parse(text)?;
        // What a file does not say of a model of the library is as the library's own file has it.
        let own = Kind::published().iter().find(|it| it.model == kind.model);
        let mut kind = own.map_or_else(|| kind.clone(), |own| kind.clone().completed(own));
        if kind.is_foreign() {
            let model = folder.join(&kind.model);
            let model = std::path::absolute(&model).map_err(|error| error.to_string())?;
            kind.model = model.to_string_lossy().into_owned();
        }
        let plant = kind.plant()?;
        let mistakes = kind.mistakes(&plant);
        if !mistakes.is_empty() {
            return Err(mistakes.join("\n  "));
        }
        let fmu = plant.name.clone();
        let values: Vec<(&str, Value)> =
            kind.values.iter().map(|(name, given)| (name.as_str(), given.value())).collect();
        let given = values.iter().map(|(name, value)| (*name, value));
        let mut rig = Self::made((name, fmu), plant, kind.clone().into(), given)?;
        for (name, given) in &kind.values {
            if let Given::Measured { value, deviation } = given {
                let index = rig
                    .plant
                    .parameter(name)
                    .ok_or_else(|| format!("values, {name}: only a parameter may have a deviation"))?;
                if !deviation.is_finite() || *deviation <= 0.0 {
                    return Err(format!("values, {name}: the deviation has to be finite and positive"));
                }
                rig.known.push((index, *value, *deviation));
            }
        }
        if rig.kind.is_foreign() {
            // Who made the model said what its parameters are; of the library's elements nobody has said anything.
            let own = rig.plant.parameters.iter().map(|it| !kind.is_beside(&it.name));
            rig.stated.iter_mut().zip(own).for_each(|(stated, own)| *stated |= own);
        }
        Ok(rig)
    }
}

impl Given {
    fn value(&self) -> Value {
        match self {
            Self::Number(value) | Self::Measured { value, .. } => Value::Real(*value),
            Self::Flag(flag) => Value::Boolean(*flag),
            Self::Item(item) => Value::Text(item.clone()),
        }
    }
}

impl Kind {
    /// Whether the model is an FMU that is run as another maker's: a file, or that of a crate of one's own.
    pub fn is_foreign(&self) -> bool {
        let model = Path::new(&self.model);
        is_fmu(model) || is_manifest(model)
    }

    /// Where the library's elements are attached to the model.
    ///
    /// # Errors
    /// If the file does not say all that it takes.
    pub fn attached(&self) -> Result<Vec<Attachment>, String> {
        let attached = self.elements.iter().filter(|it| !it.acts_on.is_empty());
        let attached: Vec<Attachment> = attached.map(ElementSignals::attachment).collect::<Result<_, _>>()?;
        let twice =
            |(place, it): (usize, &Attachment)| attached[..place].iter().any(|other| other.role == it.role);
        match attached.iter().enumerate().find(|it| twice(*it)) {
            Some((_, it)) => {
                Err(format!("elements, {}: only one of a kind can have acts_on", it.role.name()))
            }
            None => Ok(attached),
        }
    }

    /// Whether a parameter or a state is that of an element of the library beside another maker's model.
    pub fn is_beside(&self, name: &str) -> bool {
        let attached = self.elements.iter().filter(|it| !it.acts_on.is_empty());
        attached.filter_map(ElementSignals::role).any(|it| it.has(name))
    }

    /// Its model.
    ///
    /// # Errors
    /// If there is none of that name, or it cannot be read.
    pub fn plant(&self) -> Result<Plant, String> {
        if !self.is_foreign() {
            let instances = self.instances();
            return models::named(&self.model).map(|it| it.with_instances(instances)).ok_or_else(|| {
                let names: Vec<&str> = Self::published().iter().map(|it| it.model.as_str()).collect();
                format!(
                    "model: there is no `{}`; name a file with the ending .fmu, a crate by its Cargo.toml, or one of {}",
                    self.model,
                    names.join(", ")
                )
            });
        }
        let is_own = |name: &&String| !self.is_beside(name);
        let mut parameters: Vec<String> = self.nominal.iter().filter(is_own).cloned().collect();
        let given = self.values.keys().filter(is_own).filter(|name| !parameters.contains(name));
        parameters.extend(given.cloned().collect::<Vec<_>>());
        let beside = self.attached()?;
        let locals = self.signals().map(str::to_owned).collect();
        let foreign = Foreign { fmu: fmu_of(Path::new(&self.model))?, parameters, locals, beside };
        Ok(foreign.plant()?.with_instances(self.instances()))
    }

    /// Elements of which there are several.
    fn instances(&self) -> Vec<Instance> {
        let of = |only: Element| {
            let own = self.elements.iter().map(|it| it.element).filter(|it| it.kind() == only.kind());
            let places: Vec<&str> = own.filter_map(Element::place).collect();
            Instance::of(only.name(), &places)
        };
        Element::ALL.into_iter().flat_map(of).collect()
    }

    /// All that is named as something to be measured.
    fn signals(&self) -> impl Iterator<Item = &str> {
        let forces = self.elements.iter().filter_map(|it| match &it.force {
            ForceOf::Output { output: name }
            | ForceOf::Inertia { acceleration: name, .. }
            | ForceOf::Moment { moment_of: name, .. } => Some(name),
            ForceOf::Input { .. } | ForceOf::SpringAndDamper { .. } => None,
        });
        let motions = self.elements.iter().flat_map(|it| std::iter::once(&it.deflection).chain(&it.velocity));
        let others = self.missing.iter().map(|it| &it.output).chain(&self.follows_inputs);
        let named = self.names.keys().chain(self.shows.keys());
        forces.chain(motions).chain(others).chain(named).map(String::as_str)
    }

    /// Takes from another what is not said here.
    fn completed(mut self, other: &Self) -> Self {
        let Self {
            model: _,
            values,
            nominal,
            elements,
            names,
            rates,
            shows,
            follows_inputs,
            imposed,
            opposed,
            missing,
            drives,
            excitation,
            segment,
            undriven,
        } = other.clone();
        fn or<T: IntoIterator + Clone>(own: &mut T, other: T) {
            if own.clone().into_iter().next().is_none() {
                *own = other;
            }
        }
        or(&mut self.values, values);
        or(&mut self.nominal, nominal);
        or(&mut self.elements, elements);
        for (signal, others) in names {
            let own = self.names.entry(signal).or_default();
            let more: Vec<String> = others.into_iter().filter(|it| !own.contains(it)).collect();
            own.extend(more);
        }
        for (rate, of) in rates {
            self.rates.entry(rate).or_insert(of);
        }
        or(&mut self.shows, shows);
        or(&mut self.follows_inputs, follows_inputs);
        self.imposed = self.imposed.or(imposed);
        self.opposed = self.opposed.or(opposed);
        self.segment = self.segment.or(segment);
        self.undriven = self.undriven.or(undriven);
        or(&mut self.missing, missing);
        or(&mut self.drives, drives);
        or(&mut self.excitation, excitation);
        self
    }
}

impl ElementSignals {
    /// Its role beside another maker's model, if it has one.
    fn role(&self) -> Option<Role> {
        Role::named(self.element.name())
    }

    fn attachment(&self) -> Result<Attachment, String> {
        let name = self.element.name();
        let roles = Role::ALL.map(Role::name);
        let role = self
            .role()
            .ok_or_else(|| format!("elements, {name}: acts_on is for one of {}", roles.join(", ")))?;
        if self.replaces.is_some() && role != Role::Strut {
            return Err(format!("elements, {name}: replaces is for the strut"));
        }
        let velocity = self
            .velocity
            .clone()
            .ok_or_else(|| format!("elements, {name}: an element that acts on inputs needs its velocity"))?;
        let factor = |name: &String| match name.strip_prefix('-') {
            Some(name) => (name.to_owned(), -1.0),
            None => (name.clone(), 1.0),
        };
        let replaces = self
            .replaces
            .as_ref()
            .map(|it| plant::Replaced { stiffness: it.stiffness.clone(), damping: it.damping.clone() });
        let (deflection, rest) = (self.deflection.clone(), self.rest);
        Ok(Attachment {
            role,
            deflection,
            rest,
            velocity,
            acts_on: self.acts_on.iter().map(factor).collect(),
            replaces,
        })
    }
}
