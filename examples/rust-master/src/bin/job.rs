//! Runs what it is told on standard input, one word of the table a line, and prints a row of signals every step:
//!
//! ```text
//! component NAME FILE.fmu
//! connect   COMPONENT.OUTPUT COMPONENT.INPUT
//! set       COMPONENT.VARIABLE NUMBER
//! signal    COMPONENT.VARIABLE
//! run       STEP COUNT
//! ```

#[path = "../system.rs"]
mod system;

use std::io::{BufRead, Write};
use std::path::Path;

use system::{Result, System};

#[derive(Default)]
struct Job {
    components: Vec<(String, String)>,
    connections: Vec<(String, String)>,
    values: Vec<(String, f64)>,
    signals: Vec<String>,
    run: Option<(f64, u32)>,
}

fn read() -> Result<Job> {
    let mut job = Job::default();
    for line in std::io::stdin().lock().lines() {
        let line = line?;
        let words: Vec<&str> = line.split('\t').collect();
        match words[..] {
            ["component", name, file] => {
                let stem = file.strip_suffix(".fmu").ok_or_else(|| format!("{file} is no .fmu"))?;
                job.components.push((name.into(), stem.into()));
            }
            ["connect", from, to] => job.connections.push((from.into(), to.into())),
            ["set", name, value] => job.values.push((name.into(), value.parse()?)),
            ["signal", name] => job.signals.push(name.into()),
            ["run", step, count] => job.run = Some((step.parse()?, count.parse()?)),
            _ => return Err(format!("not understood: {line}").into()),
        }
    }
    Ok(job)
}

fn main() -> Result<()> {
    let job = read()?;
    let (step, count) = job.run.ok_or("no line says how to run")?;
    fn borrowed(pairs: &[(String, String)]) -> Vec<(&str, &str)> {
        pairs.iter().map(|(one, other)| (one.as_str(), other.as_str())).collect()
    }
    let mut system = System::new(Path::new(""), &borrowed(&job.components), &borrowed(&job.connections))?;
    for (name, value) in &job.values {
        system.set(name, *value)?;
    }
    let signals: Vec<&str> = job.signals.iter().map(String::as_str).collect();
    let mut out = std::io::stdout().lock();
    for row in system.run(f64::from(count) * step, step, &signals)? {
        let row: Vec<String> = row.iter().map(|value| format!("{value:?}")).collect();
        writeln!(out, "{}", row.join("\t"))?;
    }
    Ok(())
}
