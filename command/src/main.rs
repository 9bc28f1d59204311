//! One command for all: `strut fmu` is `build-fmu`, `strut diagnose` is `diagnose`.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use build_fmu::{CheckArguments, CommandLine, DescribeArguments, ListArguments, NewArguments};
use clap::{CommandFactory, Parser, Subcommand};
use clap_complete::Shell;
use strut_diagnosis::app::cli::Arguments as DiagnoseArguments;

const EXAMPLES: &str = "\
Examples:
  strut list                                  the FMUs and systems that there are
  strut fmu TumQuarterVehicle --set strut.stiffness=9000
                                              an FMU with another value, into fmus/
  strut check fmus/TumQuarterVehicle.fmu      whether an FMU, anyone's, is fit for other tools
  strut diagnose simulate --hide strut.coulomb.force=60 --out records
                                              records of a virtual rig with friction hidden in it
  strut diagnose --rig tum-linear-measured-quarter-car --train records/train.csv --test records/test.csv
                                              what the model lacks, where and how much, into report/
  strut new my-rig                            a crate for a model of your own, with a test
  strut completions bash > ~/.local/share/bash-completion/completions/strut
                                              completion for a shell

`build-fmu` is the same as `strut fmu`, and `diagnose` as `strut diagnose`.";

/// FMUs of active suspensions, and a diagnosis that finds in measured data what a model lacks
#[derive(Parser)]
#[command(name = "strut", version = build_fmu::VERSION, after_help = EXAMPLES)]
struct Strut {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Makes FMUs and systems of them (SSP)
    #[command(name = "fmu")]
    Fmu(Box<CommandLine>),
    /// Finds in measured data what a model lacks; lists rigs and effects, makes records of a virtual rig
    #[command(name = "diagnose")]
    Diagnose(Box<DiagnoseArguments>),
    /// Checks an FMU or SSP, anyone's: description, libraries, behaviour
    Check(CheckArguments),
    /// Lists the FMUs and systems that can be built
    List(ListArguments),
    /// Shows an FMU's variables, equations and sources, or a system's components and connections
    Describe(DescribeArguments),
    /// Makes a crate for a model of your own, with a test against scipy
    New(NewArguments),
    /// Prints a script that completes commands, options and names in a shell
    Completions {
        /// The shell
        #[arg(value_enum)]
        shell: Shell,
    },
    /// Prints the help of all commands as a page in Markdown, or writes the pages of all FMUs' variables
    #[command(hide = true)]
    Reference {
        /// Writes the variables of all FMUs into this folder of the book
        #[arg(long, value_name = "DIR")]
        variables: Option<PathBuf>,
        /// Compares with the files there and writes nothing
        #[arg(long, requires = "variables")]
        check: bool,
    },
    /// Runs a library, for `check`: a crash ends this program and not that one
    #[command(hide = true)]
    Probe {
        /// Where the orders are and the answers go.
        folder: PathBuf,
    },
}

fn main() -> ExitCode {
    let line = match Strut::parse().command {
        Command::Fmu(line) => *line,
        Command::Diagnose(arguments) => return strut_diagnosis::app::run::execute(&arguments),
        Command::Check(arguments) => CommandLine::of(build_fmu::Command::Check(arguments)),
        Command::List(arguments) => CommandLine::of(build_fmu::Command::List(arguments)),
        Command::Describe(arguments) => CommandLine::of(build_fmu::Command::Describe(arguments)),
        Command::New(arguments) => CommandLine::of(build_fmu::Command::New(arguments)),
        Command::Completions { shell } => return print(&completions(shell)),
        Command::Reference { variables: Some(folder), check } => {
            return match variables(&folder, check) {
                Ok(()) => ExitCode::SUCCESS,
                Err(message) => {
                    eprintln!("error: {message}");
                    ExitCode::FAILURE
                }
            };
        }
        Command::Reference { variables: None, .. } => return print(&reference()),
        Command::Probe { folder } => return strut_check::probe(&folder),
    };
    build_fmu::run(&build_fmu::strut(), &line)
}

/// The script for a shell, with the names of FMUs, systems and rigs.
fn completions(shell: Shell) -> String {
    let names = build_fmu::names(&build_fmu::strut());
    let mut command = Strut::command()
        .mut_subcommand("fmu", |fmu| build_fmu::with_names(fmu, &names))
        .mut_subcommand("list", |list| build_fmu::with_names(list, &names))
        .mut_subcommand("describe", |describe| build_fmu::with_names(describe, &names))
        .mut_subcommand("diagnose", strut_diagnosis::app::completions::with_rigs);
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, "strut", &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

/// The page of the book with the help of all commands.
fn reference() -> String {
    let mut page = String::from(
        "<!-- Printed by `strut reference`. -->\n# Commands\n\n\
         `build-fmu` is `strut fmu`, and `diagnose` is `strut diagnose`. Results go to stdout, messages to stderr. The exit code is 0, 1 \
         after a failure, and 2 for a command line that is not understood.\n",
    );
    let mut strut = Strut::command();
    strut.build();
    chapter(&mut page, &strut, "strut");
    page
}

/// Writes the pages of all FMUs' variables into a folder, or says which are not as there.
fn variables(folder: &Path, check: bool) -> Result<(), String> {
    let pages = build_fmu::variables(&build_fmu::strut())?;
    let there = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let there = there.filter_map(|entry| entry.file_name().into_string().ok());
    // Of what else is there, only earlier pages are touched.
    let mark = |text: &str| text.lines().next().map(str::to_owned);
    let own = pages.first().and_then(|(_, text)| mark(text));
    let is_gone = |name: &String| {
        let is_page = || std::fs::read_to_string(folder.join(name)).is_ok_and(|text| mark(&text) == own);
        !pages.iter().any(|(page, _)| page == name) && is_page()
    };
    let gone: Vec<String> = there.filter(is_gone).collect();
    if check {
        let is_same = |(name, text): &&(String, String)| {
            std::fs::read_to_string(folder.join(name)).is_ok_and(|it| it == *text)
        };
        let other = pages.iter().filter(|page| !is_same(page)).map(|(name, _)| name.clone());
        let stale: Vec<String> = other.chain(gone).collect();
        return if stale.is_empty() {
            Ok(())
        } else {
            Err(format!(
                "{} in {} is not what the models declare; run `strut reference --variables {}`",
                stale.join(", "),
                folder.display(),
                folder.display()
            ))
        };
    }
    let failed = |error: std::io::Error| format!("cannot write into {}: {error}", folder.display());
    std::fs::create_dir_all(folder).map_err(failed)?;
    pages.iter().try_for_each(|(name, text)| std::fs::write(folder.join(name), text)).map_err(failed)?;
    gone.iter().try_for_each(|name| std::fs::remove_file(folder.join(name))).map_err(failed)
}

fn chapter(page: &mut String, command: &clap::Command, path: &str) {
    // Values of the environment are this machine's.
    let mut shown = command.clone().bin_name(path).mut_args(|it| it.hide_env_values(true));
    let help = shown.render_help().to_string();
    let lines: Vec<&str> = help.lines().map(str::trim_end).collect();
    *page += &format!("\n## `{path}`\n\n```text\n{}\n```\n", lines.join("\n").trim_end());
    for inner in command.get_subcommands().filter(|it| !it.is_hide_set() && it.get_name() != "help") {
        chapter(page, inner, &format!("{path} {}", inner.get_name()));
    }
}

fn print(text: &str) -> ExitCode {
    // Whoever closed the pipe has read enough.
    let _ = std::io::stdout().write_all(text.as_bytes());
    ExitCode::SUCCESS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_sound() {
        Strut::command().debug_assert();
    }

    #[test]
    fn the_old_names_lead_to_the_same() {
        for line in [
            "fmu QuarterCar --out x",
            "new my-rig",
            "fmu check a.fmu",
            "check a.fmu",
            "list --json",
            "diagnose rigs",
        ] {
            assert!(Strut::try_parse_from(["strut"].into_iter().chain(line.split(' '))).is_ok(), "{line}");
        }
    }

    #[test]
    fn the_page_of_commands_is_what_they_say() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/cli.md");
        let page = std::fs::read_to_string(file).unwrap_or_default();
        assert_eq!(page, reference(), "run `cargo run --package strut-command -- reference > docs/cli.md`");
    }

    #[test]
    fn the_pages_of_variables_are_what_the_models_declare() {
        variables(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/variables")), true).unwrap();
    }

    #[test]
    fn completions_know_commands_fmus_and_rigs() {
        for shell in [Shell::Bash, Shell::Zsh] {
            let script = completions(shell);
            for word in
                ["completions", "sample-rate", "TumQuarterVehicle", "quanser-lqr", "tum-quarter-vehicle"]
            {
                assert!(script.contains(word), "{word} is missing for {shell}");
            }
        }
        assert!(completions(Shell::Fish).contains("sample-rate"));
    }

    /// What bash offers for the last of some words.
    #[cfg(unix)]
    fn offered(words: &str) -> String {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("completions");
        std::fs::write(&path, completions(Shell::Bash)).unwrap();
        let asks = format!(
            "source '{}'; COMP_WORDS=({words}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); \
             $(complete -p strut | sed 's/.*-F \\([^ ]*\\).*/\\1/') strut \"${{COMP_WORDS[-1]}}\" \
             \"${{COMP_WORDS[-2]}}\"; echo \"${{COMPREPLY[*]}}\"",
            path.display()
        );
        let output = std::process::Command::new("bash").args(["-c", &asks]).output().unwrap();
        String::from_utf8(output.stdout).unwrap().trim().to_owned()
    }

    #[cfg(unix)]
    #[test]
    fn bash_completes() {
        assert_eq!(offered("strut desc"), "describe");
        assert_eq!(offered("strut describe TumQ"), "TumQuarterVehicle");
        assert_eq!(offered("strut fmu QuanserQ"), "QuanserQuarterCar");
        assert_eq!(offered("strut fmu check --str"), "--strict");
        assert_eq!(offered("strut diagnose rigs kogut-s"), "kogut-sas-rig");
        assert_eq!(offered("strut diagnose simulate --samp"), "--sample-rate");
    }
}
