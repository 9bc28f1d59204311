//! Makes the blind benchmark's cases, and scores reports.

use std::fmt::{self, Display, Formatter};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};
use strut_blind::run::{self, Run};
use strut_blind::{Case, ablation, cases, files, four_wheels, generate, score};

/// Data with hidden causes, and the score of whoever names them.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Show the cases' numbers and names
    List {
        #[command(flatten)]
        list: Selection,
    },
    /// Write the data of cases, and their truth in a folder `sealed` of its own
    Generate {
        /// The case's number or name; several if given several times, all if not given
        #[arg(long = "case")]
        cases: Vec<String>,
        #[command(flatten)]
        list: Selection,
        /// Where to: each case gets a folder there
        #[arg(long)]
        out: PathBuf,
    },
    /// Make cases, run a diagnosis on each, score it, and write a page; cases that have a report are not run again
    Run {
        #[command(flatten)]
        trial: Trial,
        #[command(flatten)]
        earlier: Earlier,
        /// Only cases whose name contains one of these
        #[arg(long = "only")]
        only: Vec<String>,
        #[command(flatten)]
        list: Selection,
        /// Further arguments of the program, after `--`
        #[arg(last = true)]
        arguments: Vec<String>,
    },
    /// Run a diagnosis on the compact list with each of its components left out in turn, and write a page; what has a report is
    /// not run again
    Ablation {
        #[command(flatten)]
        trial: Trial,
        /// Only without this component, beside the whole; several if given several times
        #[arg(long = "component")]
        components: Vec<String>,
    },
    /// Make cars on four wheels with a cause at one corner, at an axle, at all, and with none; run a diagnosis on each and write
    /// a page; cars that have a report are not run again
    FourWheels {
        #[command(flatten)]
        trial: Trial,
        #[command(flatten)]
        earlier: Earlier,
        /// Number of cars with a cause at one corner
        #[arg(long, default_value_t = 10)]
        seeds: u64,
    },
    /// Compare the reports in cases' folders with the truth
    Score {
        /// The cases' folders, each with a report.json
        #[arg(required = true)]
        folders: Vec<PathBuf>,
    },
}

/// Program, part of a list, and files of a trial.
#[derive(Args)]
struct Trial {
    /// The program, `diagnose` or one that takes its arguments
    #[arg(long)]
    program: PathBuf,
    /// A part of the list: `2/6` is every sixth one from the second on
    #[arg(long, value_parser = part)]
    part: Option<(usize, usize)>,
    /// Where to: each case gets a folder there
    #[arg(long)]
    out: PathBuf,
    /// The page
    #[arg(long)]
    page: PathBuf,
}

impl Trial {
    /// The part of a list.
    fn of<T>(&self, all: impl Iterator<Item = T>) -> impl Iterator<Item = T> {
        let (first, step) = self.part.unwrap_or((1, 1));
        all.skip(first - 1).step_by(step)
    }

    /// The part as it is given on the command line.
    fn told_part(&self) -> String {
        self.part.map_or_else(String::new, |(first, step)| format!(" --part {first}/{step}"))
    }

    /// The program as a page calls it.
    fn name(&self) -> String {
        self.program.file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Writes the page.
    fn write(&self, text: &str) -> Result<(), String> {
        std::fs::write(&self.page, text)
            .map_err(|error| format!("{} cannot be written: {error}", self.page.display()))
    }
}

/// The page that a trial is compared with.
#[derive(Args)]
struct Earlier {
    /// An earlier page: a case that is wrong now and was right there is an error
    #[arg(long)]
    no_worse_than: Option<PathBuf>,
}

impl Earlier {
    /// Refuses cases that are worse than on the page.
    fn compare(&self, worse: impl Fn(&str) -> Vec<String>) -> Result<(), String> {
        let Some(earlier) = &self.no_worse_than else { return Ok(()) };
        let text = std::fs::read_to_string(earlier)
            .map_err(|error| format!("{} cannot be read: {error}", earlier.display()))?;
        let worse = worse(&text);
        if worse.is_empty() {
            return Ok(());
        }
        Err(format!("wrong, and right in {}: {}", earlier.display(), worse.join(", ")))
    }
}

/// Which list of cases.
#[derive(Args)]
struct Selection {
    /// The whole benchmark with so many seeds, not the compact list
    #[arg(long)]
    full: Option<u64>,
    /// The first of these seeds
    #[arg(long, requires = "full", default_value_t = 1000)]
    seed: u64,
}

impl Selection {
    fn cases(&self) -> Vec<Case> {
        self.full.map_or_else(cases::compact, |seeds| cases::full(self.seed..self.seed + seeds))
    }
}

/// As it is given on the command line.
impl Display for Selection {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.full {
            Some(seeds) => write!(f, " --full {seeds} --seed {}", self.seed),
            None => Ok(()),
        }
    }
}

fn main() -> ExitCode {
    match execute(Arguments::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

fn execute(command: Command) -> Result<(), String> {
    match command {
        Command::List { list } => {
            for (number, case) in list.cases().iter().enumerate() {
                println!("{number:4} {}", case.name);
            }
        }
        Command::Generate { cases, list, out } => {
            let all = list.cases();
            let wanted: Vec<&Case> = if cases.is_empty() {
                all.iter().collect()
            } else {
                cases.iter().map(|wanted| find(&all, wanted)).collect::<Result<_, _>>()?
            };
            for case in wanted {
                println!("{}", files::write(&generate(case)?, &out)?.display());
            }
        }
        Command::Run { trial, earlier, only, list, arguments } => {
            let wanted =
                |case: &&Case| only.is_empty() || only.iter().any(|part| case.name.contains(part.as_str()));
            let others =
                if arguments.is_empty() { String::new() } else { format!(" -- {}", arguments.join(" ")) };
            let all = list.cases();
            let run = Run { program: trial.program.clone(), arguments, out: trial.out.clone() };
            let mut scores = vec![];
            let mut failed = vec![];
            for case in trial.of(all.iter().filter(wanted)) {
                match run.case(case) {
                    Ok(score) => {
                        eprintln!("{}: {:?}, called {}", score.case, score.outcome, score.first);
                        scores.push(score);
                    }
                    Err(error) => {
                        eprintln!("error: {error}");
                        failed.push(case.name.as_str());
                    }
                }
            }
            let mut parts: Vec<String> = only.iter().map(|part| format!(" --only {part}")).collect();
            parts.push(trial.told_part());
            let command = format!("blind run --program {}{list}{}{others}", trial.name(), parts.concat());
            trial.write(&run::page(&command, &scores))?;
            if !failed.is_empty() {
                return Err(format!("no report of {}", failed.join(", ")));
            }
            earlier.compare(|page| run::worse(&scores, page).iter().map(|it| it.case.clone()).collect())?;
        }
        Command::Ablation { trial, components } => {
            let cases: Vec<Case> = trial.of(cases::compact().into_iter()).collect();
            let mut scores = vec![];
            for (component, case) in ablation::list(&cases, &components)? {
                let score = ablation::judged(&trial.program, &trial.out, (component, case))?;
                eprintln!("{}, {}: {:?}", ablation::COMPONENTS[component].1, score.case, score.outcome);
                scores.push((component, score));
            }
            let asked: Vec<String> = components.iter().map(|it| format!(" --component {it}")).collect();
            let (name, part) = (trial.name(), trial.told_part());
            let command = format!("blind ablation --program {name}{part}{}", asked.concat());
            trial.write(&ablation::page(&command, &scores))?;
        }
        Command::FourWheels { trial, earlier, seeds } => {
            let mut rows = vec![];
            for (seed, hidden) in trial.of(four_wheels::list(seeds).into_iter()) {
                let row = four_wheels::judged(&trial.program, seed, hidden.as_ref(), &trial.out)?;
                eprint!("{row}");
                rows.push(row);
            }
            trial.write(&four_wheels::page(&trial.name(), seeds, &rows))?;
            earlier.compare(|page| four_wheels::worse(&rows, page))?;
        }
        Command::Score { folders } => {
            let mut scores = vec![];
            for folder in folders {
                scores.push(files::judge(&folder)?);
            }
            for judged in &scores {
                eprintln!("{}: {:?}, {} called {}", judged.case, judged.outcome, judged.truth, judged.first);
            }
            print!("{}", score::markdown(&scores));
        }
    }
    Ok(())
}

/// `2/6`: the number of a part and the number of parts.
fn part(text: &str) -> Result<(usize, usize), String> {
    let numbers =
        text.split_once('/').and_then(|(part, parts)| Some((part.parse().ok()?, parts.parse().ok()?)));
    numbers
        .filter(|(part, parts)| (1..=*parts).contains(part))
        .ok_or_else(|| "write the number of the part and the number of parts, as in 2/6".into())
}

fn find<'a>(all: &'a [Case], wanted: &str) -> Result<&'a Case, String> {
    let number = wanted.parse::<usize>().ok().and_then(|number| all.get(number));
    number.or_else(|| all.iter().find(|case| case.name == wanted)).ok_or_else(|| {
        format!("there is no case {wanted}: take a name or a number below {}, see `blind list`", all.len())
    })
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_is_sound_and_tells_of_its_list() {
        Arguments::command().debug_assert();
        let parsed = |line: &str| Arguments::try_parse_from(line.split(' ')).map(|it| it.command);
        let Ok(Command::List { list }) = parsed("blind list --full 2 --seed 1001") else { panic!("a list") };
        assert_eq!(list.to_string(), " --full 2 --seed 1001");
        assert!(list.cases().iter().any(|case| case.name == "single-01-1002"));
        let Ok(Command::List { list }) = parsed("blind list") else { panic!("a list") };
        assert_eq!((list.to_string().as_str(), list.cases().len()), ("", cases::compact().len()));
        assert_eq!((part("2/6"), part("6/6")), (Ok((2, 6)), Ok((6, 6))));
        assert!(["0/6", "7/6", "2", "a/6"].iter().all(|text| part(text).is_err()));
        assert!(parsed("blind list --seed 1001").is_err(), "of the compact list there is one");
    }
}
