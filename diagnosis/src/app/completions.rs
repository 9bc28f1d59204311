//! Completion for shells.

use clap::CommandFactory;
use clap::builder::PossibleValuesParser;
use clap_complete::Shell;

use super::cli::Arguments;
use crate::rig::Rig;

/// A command line of a diagnosis whose arguments for rigs know their names: only a shell's script is made of it. The
/// program's own parser names the likeliest rig instead of all.
pub fn with_rigs(command: clap::Command) -> clap::Command {
    let rigs = || PossibleValuesParser::new(Rig::names());
    command
        .mut_arg("rig", |argument| argument.value_parser(rigs()))
        .mut_subcommand("simulate", |it| it.mut_arg("rig", |argument| argument.value_parser(rigs())))
        .mut_subcommand("rigs", |it| it.mut_arg("name", |argument| argument.value_parser(rigs())))
}

/// The script for a shell.
pub fn script(shell: Shell) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut with_rigs(Arguments::command()), "diagnose", &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scripts_know_commands_options_and_rigs() {
        for shell in [Shell::Bash, Shell::Zsh, Shell::Fish] {
            let script = script(shell);
            // Fish's script knows no values of positional arguments.
            let words = ["simulate", "sample-rate", "time-limit", "tum-quarter-vehicle"];
            for word in &words[..if shell == Shell::Fish { 3 } else { 4 }] {
                assert!(script.contains(word), "{word} is missing for {shell}");
            }
        }
    }
}
