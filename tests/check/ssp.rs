//! A system to be checked, in files that can be spoilt.

use std::sync::OnceLock;

use zip::CompressionMethod;

use crate::subject::{Parts, archive, parts};

pub const FMU: &str = "resources/Faulty one.fmu";
pub const DESCRIPTION: &str = "SystemStructure.ssd";
/// For one of the components.
pub const VALUES: &str = "resources/first.ssv";
/// What is shared by the elements of both systems.
pub const SIGNALS: &str = "resources/signals.ssb";

/// Two instances of the small FMU, one of them in a system within the system, with values from files and in place, and signals
/// that both systems share.
pub struct Ssp(Vec<(String, Vec<u8>)>);

pub fn faultless() -> Ssp {
    static BYTES: OnceLock<Vec<u8>> = OnceLock::new();
    let files: [(&str, Vec<u8>); 6] = [
        (DESCRIPTION, include_bytes!("SystemStructure.ssd").to_vec()),
        (FMU, BYTES.get_or_init(|| parts("").bytes()).clone()),
        (VALUES, include_bytes!("first.ssv").to_vec()),
        (SIGNALS, include_bytes!("signals.ssb").to_vec()),
        ("resources/mapped.ssv", include_bytes!("mapped.ssv").to_vec()),
        ("resources/mapping.ssm", include_bytes!("mapping.ssm").to_vec()),
    ];
    Ssp(files.map(|(name, bytes)| (name.to_owned(), bytes)).into())
}

/// The system with another text in one of its files.
pub fn with(file: &str, from: &str, to: &str) -> Ssp {
    let mut ssp = faultless();
    let (_, bytes) = ssp.0.iter_mut().find(|(name, _)| *name == file).unwrap();
    let text = String::from_utf8(bytes.clone()).unwrap();
    assert_eq!(text.matches(from).count(), 1, "{from}");
    *bytes = text.replace(from, to).into_bytes();
    ssp
}

/// The system with other contents of one of its files.
pub fn replaced(file: &str, contents: &[u8]) -> Ssp {
    faultless().and(file, contents)
}

/// The system without one of its files.
pub fn without(file: &str) -> Ssp {
    let mut ssp = faultless();
    ssp.0.retain(|(name, _)| *name != file);
    ssp
}

/// The system with another FMU.
pub fn of(fmu: &Parts) -> Ssp {
    replaced(FMU, &fmu.bytes())
}

/// The system with values within its FMU, one text of which is another. FMPy does not look for them there.
pub fn with_own(from: &str, to: &str) -> Ssp {
    let (file, values) = ("resources/own.ssv", include_str!("own.ssv"));
    assert_eq!(values.matches(from).count(), 1, "{from}");
    let mut fmu = parts("");
    fmu.files.push((file.into(), values.replace(from, to).into(), CompressionMethod::Deflated));
    let binding = "<ssd:ParameterBinding source=\"resources/first.ssv\"/>";
    let own = format!("{binding}<ssd:ParameterBinding source=\"{file}\" sourceBase=\"component\"/>");
    let ssp = with(DESCRIPTION, binding, &own);
    ssp.and(FMU, &fmu.bytes())
}

impl Ssp {
    /// The system with a file more.
    pub fn with_file(mut self, name: &str) -> Self {
        self.0.push((name.into(), b"x".to_vec()));
        self
    }

    /// The system with one more text of a file changed.
    pub fn also(self, name: &str, from: &str, to: &str) -> Self {
        let (_, bytes) = self.0.iter().find(|(known, _)| known == name).unwrap();
        let text = String::from_utf8(bytes.clone()).unwrap();
        assert_eq!(text.matches(from).count(), 1, "{from}");
        self.and(name, text.replace(from, to).as_bytes())
    }

    /// The system with other contents of a file.
    pub fn and(mut self, name: &str, contents: &[u8]) -> Self {
        self.0.iter_mut().find(|(known, _)| known == name).unwrap().1 = contents.to_vec();
        self
    }

    pub fn bytes(&self) -> Vec<u8> {
        archive(
            self.0.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice(), CompressionMethod::Deflated)),
        )
    }
}

/// Checks systems by our own rules, without running them: each has problems of its rule, and no others.
pub fn each_has_its_problem(cases: &[(&str, Ssp, &str, &str)]) {
    let packed: Vec<_> =
        cases.iter().map(|(name, ssp, rule, message)| (*name, ssp.bytes(), *rule, *message)).collect();
    crate::subject::each_has_its_problem(&packed, "ssp", &["--no-run"]);
}
