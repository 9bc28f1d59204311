//! What builds for other platforms than this machine's, and whether it is there.

use std::path::Path;
use std::process::Command;

use crate::run;

/// Whether a command is there that tells its version.
pub fn runs(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success())
}

/// What is missing for building for a target by a linker: nothing if the packager can.
pub fn missing_for(triple: &str, linker: &str) -> Vec<String> {
    let mut missing = Vec::new();
    if std::env::var_os("STRUT_CROSS").is_none() && !is_installed(triple) {
        missing.push(format!("the target {triple} (or STRUT_CROSS)"));
    }
    if !runs(linker) {
        missing.push(linker.to_owned());
    }
    missing
}

/// Whether the compiler has a target of its own.
fn is_installed(triple: &str) -> bool {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = run(Command::new(rustc).args(["--print", "sysroot"]));
    let sysroot = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    Path::new(&sysroot).join("lib/rustlib").join(triple).is_dir()
}
