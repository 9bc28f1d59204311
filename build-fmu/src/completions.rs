//! Completion for shells.

use clap::CommandFactory;
use clap::builder::PossibleValuesParser;
use clap_complete::Shell;

use crate::cli::CommandLine;
use crate::plan::Plan;

/// The names of the FMUs and systems that there are.
pub fn names(plan: &Plan) -> Vec<String> {
    let fmus = plan.fmus.iter().map(|fmu| fmu.name.clone());
    fmus.chain(plan.systems.iter().map(|(system, _)| system.name.clone())).collect()
}

/// A command, with its subcommands, whose arguments for FMUs and systems know these names. Only a shell's script is made of
/// it: the program's own parser takes names from files that are given beside them, too.
pub fn with_names(command: clap::Command, names: &[String]) -> clap::Command {
    let subcommands: Vec<String> = command.get_subcommands().map(|it| it.get_name().to_owned()).collect();
    let takes = |it: &clap::Arg| it.is_positional() && (it.get_id() == "names" || it.get_id() == "name");
    let ids: Vec<_> = command.get_arguments().filter(|it| takes(it)).map(|it| it.get_id().clone()).collect();
    let command = ids.into_iter().fold(command, |command, id| {
        command.mut_arg(id, |argument| argument.value_parser(PossibleValuesParser::new(names.to_vec())))
    });
    let known = |name: &str| ["list", "describe"].contains(&name);
    subcommands
        .into_iter()
        .filter(|name| known(name))
        .fold(command, |command, name| command.mut_subcommand(name, |it| with_names(it, names)))
}

/// The script for a shell; those for bash and zsh have the names of the FMUs and systems that there are.
pub fn script(shell: Shell, plan: &Plan) -> String {
    let mut command = with_names(CommandLine::command(), &names(plan));
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, "build-fmu", &mut script);
    let script = String::from_utf8_lossy(&script).into_owned();
    // clap_complete 4.6 writes the hyphen of our name in two ways, so that no subcommand is found in bash.
    if shell == Shell::Bash { script.replace("build__subcmd__fmu", "build__fmu") } else { script }
}
