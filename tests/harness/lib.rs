//! What the tests share: the FMUs, built once, and a Python with the masters that run them.
//!
//! Nothing has to be installed by hand: the environment is made under `target/` at first use, with
//! pinned packages.

mod browser;
mod cross;

use std::env::consts::EXE_EXTENSION;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Once, OnceLock};

pub use browser::Browser;
pub use cross::{missing_for, runs};

/// Lists of packages, and what each says: a changed one makes a new environment.
const MASTERS: (&str, &str) = ("requirements.txt", include_str!("../masters/requirements.txt"));
const COFMUPY: (&str, &str) =
    ("requirements-cofmupy.txt", include_str!("../masters/requirements-cofmupy.txt"));

/// The project's root folder.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Where everything that the tests make goes.
pub fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

/// The folder with every FMU and system, and those of FMI 3.0 in its folder `fmi3`, built on the first call; or the one that `STRUT_FMUS` names, for
/// who works on a test and has built what it needs.
pub fn fmus() -> &'static Path {
    static FMUS: OnceLock<PathBuf> = OnceLock::new();
    FMUS.get_or_init(|| {
        if let Some(folder) = std::env::var_os("STRUT_FMUS") {
            return folder.into();
        }
        let out = target().join("tested-fmus");
        let _lock = lock("fmus.lock");
        run(build_fmu().args(["--fmi", "2", "--fmi", "3", "--out"]).arg(&out));
        out
    })
}

/// Tells that a test leaves something out that `.ci/install` would bring: what did not run has not passed.
///
/// # Panics
/// Where `CI` is set: there everything is installed.
pub fn skip(what: &str) {
    assert!(
        std::env::var_os("CI").is_none(),
        "{what}: nothing is left out in CI, where .ci/install brings it all"
    );
    tell(&format!("skipped: {what}; .ci/install brings what is missing"));
}

/// Prints past the test runner, which keeps what a passing test prints.
pub fn tell(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// The packager, at the root as the first page runs it.
pub fn build_fmu() -> Command {
    let mut command = Command::new(program("build-fmu"));
    command
        .current_dir(root())
        .env("CARGO_MANIFEST_DIR", root().join("build-fmu"))
        .env("CARGO", env!("CARGO"));
    command
}

/// A program of the workspace, or an example (`examples/linearise`), compiled as the tests are.
///
/// All of them are asked for at once, as `cargo test` does: a single package would be compiled with other features of
/// what it depends on, and most of the workspace again with it.
pub fn program(name: &str) -> PathBuf {
    static COMPILED: Once = Once::new();
    COMPILED.call_once(|| {
        run(cargo().args(["build", "--quiet", "--bins", "--examples"]));
    });
    target().join("debug").join(name).with_extension(EXE_EXTENSION)
}

/// A program of those that the `fmi` crate is in; compiled at once for the same reason.
pub fn program_with_fmi(name: &str) -> PathBuf {
    static COMPILED: Once = Once::new();
    COMPILED.call_once(|| {
        let packages = ["--package", "rust-master", "--package", "hard-coupling"];
        run(cargo_with_libclang().args(["build", "--quiet", "--bins"]).args(packages));
    });
    target().join("debug").join(name).with_extension(EXE_EXTENSION)
}

/// Cargo, at the root.
pub fn cargo() -> Command {
    let mut command = Command::new(env!("CARGO"));
    command.current_dir(root());
    command
}

/// Runs a Python script of the project with arguments; returns what it prints.
///
/// # Panics
/// If it fails: with everything that it printed.
pub fn python<S: AsRef<OsStr>>(script: &str, arguments: impl IntoIterator<Item = S>) -> String {
    let mut command = Command::new(interpreter());
    command.arg(root().join(script)).args(arguments);
    // One core a test: the tests themselves run side by side.
    command.env("OMP_NUM_THREADS", "1").env("OPENBLAS_NUM_THREADS", "1").env("MPLBACKEND", "Agg");
    command.env("LD_LIBRARY_PATH", environment().join("lib"));
    let output = run(&mut command);
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// The Python interpreter that has the masters.
pub fn interpreter() -> PathBuf {
    interpreter_of(environment())
}

/// The Python interpreter that has cofmupy, which wants another FMPy than the rest.
pub fn cofmupy() -> PathBuf {
    static ENVIRONMENT: OnceLock<PathBuf> = OnceLock::new();
    interpreter_of(ENVIRONMENT.get_or_init(|| made(COFMUPY)))
}

fn interpreter_of(environment: &Path) -> PathBuf {
    environment.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" })
}

/// OMSimulator's command line, where `STRUT_OMSIMULATOR` names it: it is in no registry.
pub fn omsimulator() -> Option<PathBuf> {
    named("STRUT_OMSIMULATOR")
}

/// The Reference FMUs' program, where `STRUT_FMUSIM` names it.
pub fn fmusim() -> Option<PathBuf> {
    named("STRUT_FMUSIM")
}

/// The Python interpreter that has PyFMI, where `STRUT_PYFMI` names it: no registry has it built.
pub fn pyfmi() -> Option<PathBuf> {
    named("STRUT_PYFMI")
}

/// What a variable names. Without it the tests say that they leave it out.
fn named(variable: &str) -> Option<PathBuf> {
    let program = std::env::var_os(variable).map(PathBuf::from);
    if program.is_none() {
        tell(&format!("left out: {variable} names no program"));
    }
    program
}

/// Cargo, at the root, for packages that the `fmi` crate is in.
pub fn cargo_with_libclang() -> Command {
    let (native, headers) = libclang();
    let include: OsString = [OsStr::new("-I"), headers.as_os_str()].into_iter().collect();
    let mut command = cargo();
    command.env("LIBCLANG_PATH", native).env("BINDGEN_EXTRA_CLANG_ARGS", include);
    command
}

/// The folder of libclang, which building the `fmi` crate needs, and the folder of the C compiler's own
/// headers, which libclang's package lacks.
fn libclang() -> (PathBuf, PathBuf) {
    let script = "import clang, pathlib; print(pathlib.Path(clang.__file__).parent / 'native', end='')";
    let native = run(Command::new(interpreter()).args(["-c", script]));
    let headers = run(Command::new("cc").arg("-print-file-name=include"));
    let path = |output: Output| PathBuf::from(String::from_utf8_lossy(&output.stdout).trim());
    (path(native), path(headers))
}

/// The Python environment, made on the first call.
fn environment() -> &'static Path {
    static ENVIRONMENT: OnceLock<PathBuf> = OnceLock::new();
    ENVIRONMENT.get_or_init(|| made(MASTERS))
}

/// The Python environment of a list of packages; a changed list makes a new one.
fn made((list, text): (&str, &str)) -> PathBuf {
    let mut hasher = DefaultHasher::new();
    text.hash(&mut hasher);
    let folder = target().join(format!("python-{:016x}", hasher.finish()));
    let _lock = lock("python.lock");
    let complete = folder.join("complete");
    if !complete.exists() {
        eprintln!("making the Python environment of the tests in {}", folder.display());
        let base = if cfg!(windows) { "python" } else { "python3" };
        run(Command::new(base).args(["-m", "venv", "--clear"]).arg(&folder));
        let pip = folder.join(if cfg!(windows) { "Scripts/pip.exe" } else { "bin/pip" });
        run(Command::new(pip)
            .args(["install", "--quiet", "--disable-pip-version-check", "--requirement"])
            .arg(root().join("tests/masters").join(list)));
        fs::write(&complete, text).expect("the environment's folder is writable");
    }
    folder
}

/// Held while something shared is made: test programs run at the same time.
fn lock(name: &str) -> File {
    fs::create_dir_all(target()).expect("the target folder can be made");
    let path = target().join(name);
    let file = File::create(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    file.lock().unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    file
}

/// Runs a command to its end.
///
/// # Panics
/// If it cannot be started or fails: with the command and everything that it printed.
pub fn run(command: &mut Command) -> Output {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?} cannot be started: {error}"));
    assert!(
        output.status.success(),
        "{command:?} failed ({})\n{}{}",
        output.status,
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    output
}
