//! Versions of the standard: where they put what into the archive.

use std::iter;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use strut_model::Interface;
use strut_model_description::{Header, write, write_fmi3, write_terminals};

use crate::archive::Archive;
use crate::cli::Arguments;
use crate::failure::{Failure, Result};
use crate::icon;
use crate::plan::Plan;
use crate::platform::Platform;

/// A version of the standard. The library in an FMU is the same for both.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Version {
    /// FMI 2.0
    #[value(name = "2")]
    Two,
    /// FMI 3.0
    #[value(name = "3")]
    Three,
}

impl Version {
    /// Those that were asked for, each once; FMI 2.0 if none was.
    pub fn wanted(given: &[Self]) -> Vec<Self> {
        let wanted = [Self::Two, Self::Three].into_iter().filter(|version| given.contains(version));
        let wanted: Vec<Self> = wanted.collect();
        if wanted.is_empty() { vec![Self::Two] } else { wanted }
    }

    /// Where its FMUs are written to: FMUs of both versions have the same name.
    pub fn folder(self, out: &Path, wanted: &[Self]) -> PathBuf {
        if self == Self::Three && wanted.len() > 1 { out.join("fmi3") } else { out.into() }
    }

    /// Adds the description and the icon.
    pub fn describe(self, archive: &mut Archive, interface: &Interface, header: &Header<'_>) {
        let icon = icon::png(interface.about.kind);
        match self {
            Self::Two => {
                archive.add("modelDescription.xml", write(interface, header));
                archive.add("model.png", icon);
            }
            Self::Three => {
                archive.add("modelDescription.xml", write_fmi3(interface, header));
                archive.add("terminalsAndIcons/terminalsAndIcons.xml", write_terminals(interface));
                archive.add("terminalsAndIcons/icon.png", icon);
            }
        }
    }

    /// The folders below `binaries/` of one of several platforms.
    pub fn binaries(self, platform: &Platform, all: &[(Platform, Vec<u8>)]) -> Vec<String> {
        match self {
            Self::Two => {
                let free = |folder: &&String| all.iter().all(|(other, _)| other.folder != **folder);
                let known_as = platform.known_as.as_ref().filter(free);
                iter::once(&platform.folder).chain(known_as).cloned().collect()
            }
            Self::Three => vec![platform.tuple()],
        }
    }

    /// Where the licence goes.
    pub fn license(self) -> &'static str {
        match self {
            Self::Two => "documentation/licenses/LICENSE.txt",
            Self::Three => "documentation/licenses/license.txt",
        }
    }
}

/// Leaves the systems out where no FMU of FMI 2.0 is made: SSP 1.0 knows no other. Tells so if there were any.
///
/// # Errors
/// If one was asked for.
pub fn without_systems(plan: &mut Plan, arguments: &Arguments) -> Result<Option<String>> {
    let asked_for = !arguments.systems.is_empty() || !arguments.names.is_empty();
    match plan.systems.first() {
        Some((system, _)) if asked_for => Err(Failure::new(format!(
            "the system {} is made of FMUs of FMI 2.0, as SSP 1.0 wants",
            system.name
        ))
        .help("add `--fmi 2`")),
        Some(_) => {
            let count = std::mem::take(&mut plan.systems).len();
            Ok(Some(format!(
                "{count} systems are left out, as SSP 1.0 wants FMI 2.0: add `--fmi 2` for them"
            )))
        }
        None => Ok(None),
    }
}
