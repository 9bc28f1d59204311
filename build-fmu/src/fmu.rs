//! An FMU: a model, perhaps with a parameter set, and its archive.

use std::path::PathBuf;

use strut_model::{Causality, Entry, Error, Interface, ParameterSet};
#[cfg(feature = "strut")]
use strut_model::{Inputs, Trajectory};
use strut_model_description::Header;
use strut_related::{Files, Related, media};

use crate::archive::Archive;
use crate::declared;
use crate::documentation::{self, Page};
use crate::failure::{Failure, Result};
use crate::{literature, platform::Platform, related, version::Version};

/// A published parameter set with where it comes from.
#[derive(Clone, Debug)]
pub struct Set {
    /// As read.
    pub parsed: ParameterSet,
    /// Verbatim.
    pub text: String,
    /// Where its files are.
    pub folder: PathBuf,
}

/// What an FMU is made of.
#[derive(Clone, Debug)]
pub struct Fmu {
    /// Its name, and the name of the library in it.
    pub name: String,
    /// The model.
    pub entry: Entry,
    /// The parameter set; none for the model's own start values.
    pub set: Option<Set>,
    /// What travels with it in place of its parameter set and its default experiment.
    pub related: Option<Files>,
}

/// A packed FMU.
#[derive(Clone, Debug)]
pub struct Packed {
    /// The archive.
    pub bytes: Vec<u8>,
    /// What it offers.
    pub interface: Interface,
}

impl Fmu {
    /// What it is, in one sentence.
    pub fn title(&self) -> &str {
        self.set.as_ref().map_or(self.entry.about.summary, |set| &set.parsed.title)
    }

    /// Its variables with the start values of its parameter set.
    ///
    /// # Errors
    /// If the parameter set does not fit the model, or its declarations contradict each other.
    pub fn interface(&self) -> Result<Interface> {
        let interface =
            self.entry.interface(self.parsed(), self.folder()).map_err(|error| self.refused(&error))?;
        declared::check(&interface)?;
        Ok(interface)
    }

    /// Numbers of inputs and outputs.
    pub fn ports(interface: &Interface) -> (usize, usize) {
        let count =
            |causality| interface.variables.iter().filter(|variable| variable.causality == causality).count();
        (count(Causality::Input), count(Causality::Output))
    }

    /// An archive for each version of the standard, with a library for each platform. `literature` is where the keys of
    /// sources are looked up.
    ///
    /// # Errors
    /// If the parameter set does not fit the model, a file of it is missing, or the default experiment
    /// fails.
    pub fn pack(
        &self,
        versions: &[Version],
        libraries: &[(Platform, Vec<u8>)],
        (license, literature): (&str, &str),
    ) -> Result<Vec<Packed>> {
        let interface = self.interface()?;
        let trajectory =
            self.entry.demonstrate(self.parsed(), self.folder()).map_err(|error| self.refused(&error))?;
        let page = documentation::html(&Page {
            fmu: self,
            interface: &interface,
            trajectory: &trajectory,
            works: &literature::works(literature),
        });
        let recorded = self.entry.record(self.parsed(), self.folder(), related::STEPS);
        let (recorded, inputs) = recorded.map_err(|error| self.refused(&error))?;
        let archive = |version: &Version| {
            let mut archive = self.archive(*version, (&interface, &page), libraries, license)?;
            let mut files = related::files(self, *version, &interface, (&recorded, inputs));
            if !license.is_empty() {
                let source = format!("../../{}", version.license());
                files.name(Related::new(media::TEXT, &source, "document", "Licence"));
            }
            files.archived().for_each(|(path, contents)| archive.add(path, contents));
            let bytes = archive.bytes();
            Ok(Packed { bytes, interface: interface.clone() })
        };
        versions.iter().map(archive).collect()
    }

    fn archive(
        &self,
        version: Version,
        (interface, page): (&Interface, &str),
        libraries: &[(Platform, Vec<u8>)],
        license: &str,
    ) -> Result<Archive> {
        let generated = generation_time();
        let header = Header {
            name: &self.name,
            description: self.title(),
            license: license.lines().next().unwrap_or_default(),
            generated: generated.as_deref(),
            ..Header::default()
        };
        let mut archive = Archive::default();
        version.describe(&mut archive, interface, &header);
        for (platform, library) in libraries {
            for folder in version.binaries(platform, libraries) {
                let file = format!("binaries/{folder}/{}{}", self.name, platform.ending);
                archive.add_library(file, library.as_slice());
            }
        }
        archive.add("documentation/index.html", page);
        if !license.is_empty() {
            archive.add(version.license(), license);
        }
        if let Some(set) = &self.set {
            archive.add("resources/parameters.toml", set.text.as_str());
            for file in &set.parsed.files {
                archive.add(format!("resources/{file}"), self.resource(set, file)?);
            }
        }
        Ok(archive)
    }

    /// Simulates the model: see [`Entry::simulate`].
    ///
    /// # Errors
    /// If inputs or values do not fit, or the integration fails.
    #[cfg(feature = "strut")]
    pub fn simulate(&self, inputs: Option<&Inputs>, times: [f64; 2]) -> Result<Trajectory> {
        let simulated = self.entry.simulate(self.parsed(), self.folder(), inputs, times);
        simulated.map_err(|error| Failure::new(format!("{}: {error}", self.name)))
    }

    fn parsed(&self) -> Option<&ParameterSet> {
        self.set.as_ref().map(|set| &set.parsed)
    }

    fn folder(&self) -> Option<&std::path::Path> {
        self.set.as_ref().map(|set| set.folder.as_path())
    }

    fn resource(&self, set: &Set, file: &str) -> Result<Vec<u8>> {
        // A name that climbs out of the archive's folder would be written over someone else's file.
        let escapes = file.split(['/', '\\']).any(|part| part.is_empty() || part == "..");
        if escapes || file == "parameters.toml" {
            return Err(Failure::new(format!(
                "the parameter set of {} cannot bring the file `{file}`",
                self.name
            ))
            .help("name files beside the parameter set, without `..`"));
        }
        let path = set.folder.join(file);
        std::fs::read(&path).map_err(|error| {
            Failure::new(format!("the parameter set of {} needs `{}`: {error}", self.name, path.display()))
        })
    }

    fn refused(&self, error: &Error) -> Failure {
        Failure::new(match &self.set {
            Some(_) => format!("the parameter set of {} does not fit: {error}", self.name),
            None => format!("{}: {error}", self.name),
        })
    }
}

/// The time that reproducible builds agree on, if there is one.
fn generation_time() -> Option<String> {
    let seconds: u64 = std::env::var("SOURCE_DATE_EPOCH").ok()?.parse().ok()?;
    Some(date_and_time(seconds))
}

/// Seconds since 1970 as in ISO 8601, by H. Hinnant's `civil_from_days`: years begin in March, so that
/// the leap day is the last.
fn date_and_time(seconds: u64) -> String {
    let (days, rest) = (seconds / 86_400 + 719_468, seconds % 86_400);
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}T{:02}:{:02}:{:02}Z", rest / 3600, rest / 60 % 60, rest % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recorded_road(files: &[&str]) -> Fmu {
        let (_, text) =
            strut_physics::PARAMETER_SETS.iter().find(|(name, _)| *name == "RecordedRoad.toml").unwrap();
        let mut parsed = ParameterSet::parse(text).unwrap();
        parsed.files = files.iter().map(|file| (*file).to_owned()).collect();
        let folder =
            PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../fmu-src/physics/parameters/resources");
        let entry = *strut_physics::CATALOGUE.iter().find(|entry| entry.about.name == "Road").unwrap();
        let set = Set { parsed, text: (*text).into(), folder };
        Fmu { name: set.parsed.fmu.clone(), entry, set: Some(set), related: None }
    }

    fn archived(fmu: &Fmu, version: Version, libraries: &[(Platform, Vec<u8>)], license: &str) -> Packed {
        fmu.pack(&[version], libraries, (license, "")).unwrap().remove(0)
    }

    #[test]
    fn an_archive_has_everything_in_its_place() {
        let platforms =
            ["x86_64-unknown-linux-gnu", "x86_64-pc-windows-gnu"].map(|triple| Platform::of(triple).unwrap());
        let libraries = platforms.map(|platform| (platform, b"library".to_vec()));
        let fmu = recorded_road(&["profile.csv"]);
        let packed = archived(&fmu, Version::Two, &libraries, "MIT License\n\n...");
        assert_eq!(packed.bytes, archived(&fmu, Version::Two, &libraries, "MIT License\n\n...").bytes);
        let mut zip = zip::ZipArchive::new(std::io::Cursor::new(packed.bytes)).unwrap();
        let names: Vec<String> = zip.file_names().map(|name| name.unwrap().into_owned()).collect();
        assert_eq!(
            names,
            [
                "modelDescription.xml",
                "model.png",
                "binaries/linux64/RecordedRoad.so",
                "binaries/win64/RecordedRoad.dll",
                "documentation/index.html",
                "documentation/licenses/LICENSE.txt",
                "resources/parameters.toml",
                "resources/profile.csv",
                "extra/org.fmi-standard.fmi-ls-ref/fmi-ls-manifest.xml",
                "extra/org.fmi-standard.fmi-ls-ref/parameters.ssv",
                "extra/org.fmi-standard.fmi-ls-ref/default-experiment.exp",
                "extra/org.fmi-standard.fmi-ls-ref/default-experiment-out.csv",
            ]
        );
        let mut xml = String::new();
        std::io::Read::read_to_string(&mut zip.by_name("modelDescription.xml").unwrap(), &mut xml).unwrap();
        assert!(xml.contains("modelIdentifier=\"RecordedRoad\"") && xml.contains("license=\"MIT License\""));
        assert!(xml.contains(&packed.interface.guid()));
    }

    #[test]
    fn an_archive_of_fmi_3_has_everything_in_its_place() {
        let platforms = ["i686-unknown-linux-gnu", "aarch64-unknown-linux-gnu", "x86_64-pc-windows-gnu"];
        let platforms = platforms.map(|triple| Platform::of(triple).unwrap());
        let libraries = platforms.map(|platform| (platform, b"library".to_vec()));
        let packed = archived(&recorded_road(&["profile.csv"]), Version::Three, &libraries, "MIT License");
        let mut zip = zip::ZipArchive::new(std::io::Cursor::new(packed.bytes)).unwrap();
        let names: Vec<String> = zip.file_names().map(|name| name.unwrap().into_owned()).collect();
        assert_eq!(
            names,
            [
                "modelDescription.xml",
                "terminalsAndIcons/terminalsAndIcons.xml",
                "terminalsAndIcons/icon.png",
                "binaries/x86-linux/RecordedRoad.so",
                "binaries/aarch64-linux/RecordedRoad.so",
                "binaries/x86_64-windows/RecordedRoad.dll",
                "documentation/index.html",
                "documentation/licenses/license.txt",
                "resources/parameters.toml",
                "resources/profile.csv",
                "extra/org.fmi-standard.fmi-ls-ref/fmi-ls-manifest.xml",
                "extra/org.fmi-standard.fmi-ls-ref/parameters.ssv",
                "extra/org.fmi-standard.fmi-ls-ref/default-experiment.exp",
                "extra/org.fmi-standard.fmi-ls-ref/default-experiment-out.csv",
            ]
        );
        let mut xml = String::new();
        std::io::Read::read_to_string(&mut zip.by_name("modelDescription.xml").unwrap(), &mut xml).unwrap();
        let token = format!("instantiationToken=\"{}\"", packed.interface.guid());
        assert!(xml.contains("fmiVersion=\"3.0\"") && xml.contains(&token));
    }

    #[test]
    fn a_library_for_another_processor_takes_the_folder_of_intels_if_that_is_free() {
        let names = |triples: &[&str]| {
            let platform = |triple: &&str| (Platform::of(triple).unwrap(), triple.as_bytes().to_vec());
            let libraries: Vec<_> = triples.iter().map(platform).collect();
            let packed = archived(&recorded_road(&["profile.csv"]), Version::Two, &libraries, "");
            let zip = zip::ZipArchive::new(std::io::Cursor::new(packed.bytes)).unwrap();
            let mut names: Vec<String> = zip.file_names().map(|name| name.unwrap().into_owned()).collect();
            names.retain(|name| name.starts_with("binaries/"));
            names
        };
        let (intel, arm) = ("x86_64-unknown-linux-gnu", "aarch64-unknown-linux-gnu");
        let [tuple, common] =
            ["binaries/aarch64-linux/RecordedRoad.so", "binaries/linux64/RecordedRoad.so"].map(String::from);
        assert_eq!(names(&[arm]), [tuple.clone(), common.clone()]);
        assert_eq!(names(&[arm, intel]), [tuple, common]);
    }

    #[test]
    fn files_stay_within_the_archive() {
        for file in ["../../../LICENSE", "/etc/hostname", "a//b", "parameters.toml", "c\\..\\d"] {
            let error = recorded_road(&[file]).pack(&[Version::Two], &[], ("", "")).unwrap_err().to_string();
            assert!(error.contains("cannot bring the file"), "{error}");
        }
        let error =
            recorded_road(&["missing.csv"]).pack(&[Version::Two], &[], ("", "")).unwrap_err().to_string();
        assert!(error.contains("RecordedRoad needs") && error.contains("missing.csv"), "{error}");
    }

    #[test]
    fn seconds_become_a_date() {
        assert_eq!(date_and_time(0), "1970-01-01T00:00:00Z");
        assert_eq!(date_and_time(951_782_400), "2000-02-29T00:00:00Z");
        assert_eq!(date_and_time(1_767_225_599), "2025-12-31T23:59:59Z");
    }
}
