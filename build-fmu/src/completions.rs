//! Completion for shells.

use clap::CommandFactory;
use clap::builder::PossibleValuesParser;
use clap_complete::Shell;

use crate::cli::CommandLine;
use crate::plan::Plan;

/// The script for a shell; those for bash and zsh have the names of the FMUs and systems that there are.
pub fn script(shell: Shell, plan: &Plan) -> String {
    let fmus = plan.fmus.iter().map(|fmu| fmu.name.clone());
    let names: Vec<String> = fmus.chain(plan.systems.iter().map(|(system, _)| system.name.clone())).collect();
    // Only the script's parser knows the names: the program's own takes those of files given beside them too.
    let parser = || PossibleValuesParser::new(names.clone());
    let mut command = CommandLine::command()
        .mut_arg("names", |argument| argument.value_parser(parser()))
        .mut_subcommand("list", |list| list.mut_arg("names", |argument| argument.value_parser(parser())))
        .mut_subcommand("describe", |describe| {
            describe.mut_arg("name", |argument| argument.value_parser(parser()))
        });
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, "build-fmu", &mut script);
    let script = String::from_utf8_lossy(&script).into_owned();
    // clap_complete 4.6 writes the hyphen of our name in two ways, so that no subcommand is found in bash.
    if shell == Shell::Bash { script.replace("build__subcmd__fmu", "build__fmu") } else { script }
}
