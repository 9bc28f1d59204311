//! `fuzz`: calls at random to the shared library of an FMU. `README.md` tells how it is used.

use std::fs::File;
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use clap::{Args, Parser, Subcommand};
use strut_hardening::api::{Api, load};
use strut_hardening::call::Call;
use strut_hardening::generate::episode;
use strut_hardening::package::Package;
use strut_hardening::player::Player;
use strut_hardening::shrink::shrink;

/// Calls an FMU's functions at random and checks every answer against the standard's state machines
#[derive(Parser)]
struct Cli {
    #[command(subcommand)]
    command: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Plays episode after episode
    Run {
        #[command(flatten)]
        subject: Subject,
        /// Calls to be made, in all
        #[arg(long, default_value_t = 1_000_000)]
        calls: u64,
        /// Threads, each with instances of its own
        #[arg(long, default_value_t = 1)]
        threads: u64,
        /// Where the episode under way is written, for `shrink` after a crash
        #[arg(long)]
        journal: Option<PathBuf>,
    },
    /// Plays one episode, or some of its calls
    Play {
        #[command(flatten)]
        subject: Subject,
        /// Number of the episode
        #[arg(long)]
        episode: u64,
        /// Indices of the calls to be made; all if it is not given
        #[arg(long, value_delimiter = ',')]
        keep: Option<Vec<usize>>,
    },
    /// Finds the shortest part of an episode that goes wrong, be it by a crash
    Shrink {
        #[command(flatten)]
        subject: Subject,
        /// Number of the episode
        #[arg(long)]
        episode: u64,
        /// Seconds after which an episode counts as hanging
        #[arg(long, default_value_t = 60)]
        patience: u64,
    },
}

#[derive(Args, Clone)]
struct Subject {
    /// The FMU
    fmu: PathBuf,
    /// Another build of its library, say one with a sanitizer
    #[arg(long)]
    library: Option<PathBuf>,
    /// What the episodes follow from
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Task::Run { subject, calls, threads, journal } => run(&subject, calls, threads, journal.as_deref()),
        Task::Play { subject, episode, keep } => play(&subject, episode, keep.as_deref()),
        Task::Shrink { subject, episode, patience } => {
            shrink_in_children(&subject, episode, Duration::from_secs(patience))
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(wrong) => {
            eprintln!("{wrong}");
            ExitCode::FAILURE
        }
    }
}

fn run(subject: &Subject, calls: u64, threads: u64, journal: Option<&Path>) -> Result<(), String> {
    let package = Package::open(&subject.fmu)?;
    let library = load(subject.library.as_ref().unwrap_or(&package.library()))?;
    let api = Api::of(&library, package.version)?;
    let journal =
        journal.map(|path| File::create(path).map_err(|error| format!("{}: {error}", path.display())));
    let journal = Mutex::new(journal.transpose()?);
    let (made, next) = (AtomicU64::new(0), AtomicU64::new(0));
    let wrong: Mutex<Option<String>> = Mutex::new(None);
    let clock = Instant::now();
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while made.load(Ordering::Relaxed) < calls && wrong.lock().expect("no panic").is_none() {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if let Some(file) = &mut *journal.lock().expect("no panic") {
                        let _ = file.rewind().and_then(|()| write!(file, "{number:<20}"));
                    }
                    let episode = episode(&package, subject.seed, number);
                    match Player::new(api, &package).play(&episode) {
                        Ok(count) => {
                            made.fetch_add(count, Ordering::Relaxed);
                        }
                        Err((index, message)) => {
                            let told =
                                tell(api, &package, &episode[..=index], subject.seed, number, &message);
                            wrong.lock().expect("no panic").get_or_insert(told);
                        }
                    }
                }
            });
        }
    });
    if let Some(wrong) = wrong.into_inner().expect("no panic") {
        return Err(wrong);
    }
    println!(
        "{}: {} calls in {} episodes, {threads} threads, seed {}, {:.0} s: nothing wrong",
        package.name,
        made.into_inner(),
        next.into_inner(),
        subject.seed,
        clock.elapsed().as_secs_f64()
    );
    Ok(())
}

/// What went wrong, with the shortest sequence of calls that shows it.
fn tell(api: Api, package: &Package, calls: &[Call], seed: u64, number: u64, message: &str) -> String {
    let fails = |calls: &[Call]| Player::new(api, package).play(calls).is_err();
    let short = shrink(calls, fails);
    let now = Player::new(api, package).play(&short).err().map_or_else(String::new, |(_, message)| message);
    format!(
        "{}, seed {seed}, episode {number}: {message}\nthe shortest sequence: {now}\n{}",
        package.name,
        listing(&short)
    )
}

fn listing(calls: &[Call]) -> String {
    calls.iter().map(|call| format!("  #{} {:?}\n", call.instance, call.action)).collect()
}

fn play(subject: &Subject, number: u64, keep: Option<&[usize]>) -> Result<(), String> {
    let package = Package::open(&subject.fmu)?;
    let library = load(subject.library.as_ref().unwrap_or(&package.library()))?;
    let api = Api::of(&library, package.version)?;
    let all = episode(&package, subject.seed, number);
    let calls: Vec<Call> = match keep {
        None => all,
        Some(indices) => indices.iter().filter_map(|index| all.get(*index).cloned()).collect(),
    };
    Player::new(api, &package).play(&calls).map(|_| ()).map_err(|(_, message)| {
        format!("{}, seed {}, episode {number}: {message}\n{}", package.name, subject.seed, listing(&calls))
    })
}

/// Each trial is a process of its own, which may crash or hang.
fn shrink_in_children(subject: &Subject, number: u64, patience: Duration) -> Result<(), String> {
    let package = Package::open(&subject.fmu)?;
    let calls = episode(&package, subject.seed, number);
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let fails = |indices: &[usize]| -> bool {
        let keep: Vec<String> = indices.iter().map(ToString::to_string).collect();
        let mut command = Command::new(&program);
        command.arg("play").arg(&subject.fmu).args(["--seed", &subject.seed.to_string()]);
        command.args(["--episode", &number.to_string()]);
        if !keep.is_empty() {
            command.args(["--keep", &keep.join(",")]);
        }
        if let Some(library) = &subject.library {
            command.arg("--library").arg(library);
        }
        command.stdout(Stdio::null()).stderr(Stdio::null());
        !keep.is_empty() && !ends_well(&mut command, patience)
    };
    let indices: Vec<usize> = (0..calls.len()).collect();
    if !fails(&indices) {
        println!("{}, seed {}, episode {number}: nothing wrong", package.name, subject.seed);
        return Ok(());
    }
    let short: Vec<Call> = shrink(&indices, fails).into_iter().map(|index| calls[index].clone()).collect();
    Err(format!(
        "{}, seed {}, episode {number}: the shortest sequence that fails, crashes or hangs\n{}",
        package.name,
        subject.seed,
        listing(&short)
    ))
}

fn ends_well(command: &mut Command, patience: Duration) -> bool {
    let Ok(mut child) = command.spawn() else { return false };
    let clock = Instant::now();
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return status.success(),
            Ok(None) if clock.elapsed() < patience => thread::sleep(Duration::from_millis(5)),
            _ => {
                let _ = child.kill();
                let _ = child.wait();
                return false;
            }
        }
    }
}
