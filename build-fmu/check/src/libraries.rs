//! Rules for the shared libraries, each by its file.

use std::collections::BTreeMap;

use strut_binary::{Binary, Glibc};

use crate::description::{Description, Kind, Version};
use crate::finding::{Finding, names};
use crate::functions;
use crate::package::Package;
use crate::rules::{fmi, practice};

/// The folder of `binaries/` for the machine that this runs on, in FMI 2.0 and 3.0; none if FMI has no name for it.
const HOST: Option<[&str; 2]> = if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
    Some(["linux64", "x86_64-linux"])
} else if cfg!(all(target_os = "linux", target_arch = "aarch64")) {
    Some(["aarch64-linux", "aarch64-linux"])
} else if cfg!(all(target_os = "windows", target_arch = "x86_64")) {
    Some(["win64", "x86_64-windows"])
} else if cfg!(all(target_os = "macos", target_arch = "x86_64")) {
    Some(["darwin64", "x86_64-darwin"])
} else if cfg!(all(target_os = "macos", target_arch = "aarch64")) {
    Some(["aarch64-darwin", "aarch64-darwin"])
} else {
    None
};

/// The folder of `binaries/` for the machine that this runs on; none if FMI has no name for it.
pub fn host(version: Version) -> Option<&'static str> {
    HOST.map(|[two, three]| if version == Version::Two { two } else { three })
}

/// Version of glibc that every Linux since 2012 has (CentOS 7): what many tools still run on.
const OLD_ENOUGH: Glibc = Glibc { major: 2, minor: 17 };

/// What a platform's libraries are called.
pub fn ending(platform: &str) -> &'static str {
    match platform {
        windows if windows.contains("win") && !windows.contains("darwin") => ".dll",
        darwin if darwin.contains("darwin") => ".dylib",
        _ => ".so",
    }
}

/// The path of an interface's library in the archive.
pub fn path(platform: &str, identifier: &str) -> String {
    format!("binaries/{platform}/{identifier}{}", ending(platform))
}

/// What is wrong with them, and the platforms that there are.
///
/// # Errors
/// If the archive is damaged.
pub fn findings(
    package: &mut Package,
    description: &Description,
) -> Result<(Vec<Finding>, Vec<String>), String> {
    let mut platforms: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for file in package.files() {
        if let Some((platform, file)) = file.strip_prefix("binaries/").and_then(|rest| rest.split_once('/')) {
            platforms.entry(platform.into()).or_default().push(file.into());
        }
    }
    let mut findings = Vec::new();
    let sources = package.files().any(|file| file.starts_with("sources/"));
    if platforms.is_empty() {
        findings.push(if sources {
            Finding::note(practice::PLATFORM, "there is no library, only source code")
                .help("most importers do not compile; bring libraries for win64 and linux64 too")
        } else {
            Finding::error(
                fmi::IMPLEMENTATION,
                "there is neither a library nor source code, so that nothing can be run",
            )
        });
    } else {
        let missing: Vec<&str> =
            ["win64", "linux64"].into_iter().filter(|platform| !platforms.contains_key(*platform)).collect();
        if !missing.is_empty() {
            let message = format!("there is no library for {}", names(&missing));
            findings.push(Finding::note(practice::PLATFORM, message).help(
                "most users of FMI tools are on Windows, most clusters on Linux: one FMU can carry both",
            ));
        }
    }
    for interface in &description.interfaces {
        let missing: Vec<&str> = interface
            .sources
            .iter()
            .filter(|source| {
                let plain = source.trim_start_matches("./");
                !package.files().any(|file| file.strip_prefix("sources/") == Some(plain))
            })
            .map(String::as_str)
            .collect();
        if !missing.is_empty() {
            let message = format!("<SourceFiles> names files that are not in sources/: {}", names(&missing));
            // Who keeps the source code to himself often leaves the list in.
            findings.push(if sources {
                Finding::error(fmi::SOURCES, message).line(interface.line)
            } else {
                Finding::warning(fmi::SOURCES, message).line(interface.line).help("leave <SourceFiles> out")
            });
        }
    }
    let mut interfaces: BTreeMap<&str, Vec<Kind>> = BTreeMap::new();
    for interface in &description.interfaces {
        interfaces.entry(&interface.identifier).or_default().push(interface.kind);
    }
    for (platform, files) in &platforms {
        for (identifier, kinds) in &interfaces {
            let path = path(platform, identifier);
            match package.read(&path)? {
                Some(bytes) => findings.extend(library(platform, &path, &bytes, kinds, files)),
                None => {
                    // The file systems of Windows and macOS find it all the same.
                    let alike =
                        |file: &String| format!("binaries/{platform}/{file}").eq_ignore_ascii_case(&path);
                    let found = !platform.contains("linux") && files.iter().any(alike);
                    let message = format!("there is no `{path}`");
                    let finding = if found {
                        Finding::warning(fmi::BINARY_NAME, message)
                    } else {
                        Finding::error(fmi::BINARY_NAME, message)
                    };
                    let finding = finding.help("the library must be named after the modelIdentifier");
                    let known = files.iter().any(|file| file.ends_with(ending(platform)));
                    findings.push(if known {
                        finding.help(format!("`binaries/{platform}` has {}", names(files)))
                    } else {
                        finding
                    });
                }
            }
        }
    }
    Ok((findings, platforms.into_keys().collect()))
}

fn library(platform: &str, path: &str, bytes: &[u8], kinds: &[Kind], beside: &[String]) -> Vec<Finding> {
    let binary = match Binary::parse(bytes) {
        Ok(binary) => binary,
        Err(error) => {
            return vec![Finding::error(practice::BINARY_READ, format!("`{path}` cannot be read: {error}"))];
        }
    };
    let mut findings = Vec::new();
    // darwin64 may hold both of Apple's, in one file or not.
    let other = binary.platform.filter(|other| *other != platform && !platform.contains("darwin"));
    if let Some(other) = other {
        let message = format!("the library is one for {other}");
        let help = format!("it belongs into `binaries/{other}`");
        findings.push(Finding::error(practice::BINARY_PLATFORM, message).at(path).help(help));
    }
    let lacks = binary.lacks(functions::of(kinds));
    if !lacks.is_empty() {
        let message = format!("the library does not export {}", names(&lacks));
        findings.push(
            Finding::error(fmi::FUNCTIONS, message)
                .at(path)
                .help("FMI 2.0 wants every function, also those of capabilities that are not there: importers load them all")
                .help("a function of a missing capability returns fmi2Error"),
        );
    }
    if let Some(oldest) = binary.glibc.filter(|version| *version > OLD_ENOUGH) {
        let message = format!("the library loads only where glibc is {oldest} or newer");
        findings.push(Finding::note(practice::GLIBC, message).at(path).help(format!(
            "link it against an old glibc ({OLD_ENOUGH} runs everywhere), e.g. with zig or in a manylinux container"
        )));
    }
    let beside = |name: &str| beside.iter().any(|file| file.rsplit('/').next() == Some(name));
    let unusual: Vec<&str> = binary.unusual().into_iter().filter(|name| !beside(name)).collect();
    if !unusual.is_empty() {
        let message = format!("not every machine has what the library needs: {}", names(&unusual));
        // The compiler's own is part of nearly every installation.
        let common = unusual.iter().all(|name| name.starts_with("libgcc_s") || name.starts_with("libstdc++"));
        let finding = if common {
            Finding::note(practice::LIBRARIES, message)
        } else {
            Finding::warning(practice::LIBRARIES, message)
        };
        findings.push(
            finding
                .at(path)
                .help("link it statically, or put it beside the library with an rpath of $ORIGIN"),
        );
    }
    findings
}
