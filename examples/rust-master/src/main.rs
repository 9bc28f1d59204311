//! The systems of the Python examples, composed from Rust with the `fmi` crate:
//! `rust-master [FOLDER OF THE FMUS [FOLDER FOR THE CSV FILES]]`. Prints the same numbers.

mod system;

use std::path::{Path, PathBuf};
use system::{Result, System};

const STEP: f64 = 1e-3;

fn main() -> Result<()> {
    let argument = |index, default: &str| std::env::args_os().nth(index).unwrap_or_else(|| default.into());
    let (fmus, out) = (PathBuf::from(argument(1, "fmus")), PathBuf::from(argument(2, ".")));
    quanser(&fmus, &out)?;
    tum(&fmus, &out)
}

fn quanser(fmus: &Path, out: &Path) -> Result<()> {
    let components =
        [("road", "QuanserRoad"), ("rig", "QuanserQuarterCar"), ("controller", "QuanserLqrController")];
    let connections = [
        ("road.position", "rig.road.position"),
        ("road.velocity", "rig.road.velocity"),
        ("rig.suspension.deflection", "controller.suspension.deflection"),
        ("rig.body.velocity", "controller.body.velocity"),
        ("rig.tire.deflection", "controller.tire.deflection"),
        ("rig.wheel.velocity", "controller.wheel.velocity"),
        ("controller.force", "rig.actuator.force"),
    ];
    let signals = ["road.position", "rig.body.position", "rig.body.acceleration", "controller.force"];
    let run = |frequency, switch_on, stop| -> Result<_> {
        let mut system = System::new(fmus, &components, &connections)?;
        system.set("road.frequency", frequency)?;
        system.set("controller.switch_on_time", switch_on)?;
        system.run(stop, STEP, &signals)
    };
    // Settling takes longer than the guide's road allows: a slower one, its edge at 5 s in open loop, at 10 s with LQR.
    let slow = run(0.1, 10.0, 15.0)?;
    for (label, edge) in [("open loop", 5_000), ("LQR", 10_000)] {
        let (old, new) = (slow[edge - 1][0], slow[edge + 4_999][0]);
        let outside = |row: &Vec<f64>| (row[1] - new).abs() > 0.05 * (new - old).abs();
        let last = slow[edge..edge + 5_000].iter().rposition(outside).unwrap_or(0);
        println!("{label:<10} settles within 5 % in {:.3} s", last as f64 * STEP);
    }
    let rows = run(0.3, 5.0, 10.0)?;
    println!("largest body acceleration: {:.3} m/s2 in open loop", largest(&rows[..=5_000], 2));
    println!("largest body acceleration: {:.3} m/s2 with LQR", largest(&rows[5_001..], 2));
    println!("largest force of the controller: {:.3} N\n", largest(&rows, 3));
    write(&out.join("quanser_lqr.csv"), &signals, &rows)
}

fn tum(fmus: &Path, out: &Path) -> Result<()> {
    let components = [
        ("road", "TumRoad"),
        ("rig", "TumQuarterVehicle"),
        ("controller", "TumSkyhook"),
        ("motor", "LinearMotor"),
    ];
    let connections = [
        ("road.position", "rig.road.position"),
        ("road.velocity", "rig.road.velocity"),
        ("rig.body.velocity", "controller.body.velocity"),
        ("controller.force", "motor.force_reference"),
        ("rig.suspension.deflection", "motor.suspension.deflection"),
        ("rig.suspension.velocity", "motor.suspension.velocity"),
        ("motor.force", "rig.actuator.force"),
    ];
    let signals = [
        "rig.body.velocity",
        "rig.body.acceleration",
        "rig.suspension.deflection",
        "rig.wheel.force",
        "motor.force",
    ];
    for (label, damping) in [("passive", 0.0), ("Skyhook", 1500.0)] {
        let mut system = System::new(fmus, &components, &connections)?;
        system.set("controller.damping", damping)?;
        let rows = system.run(10.0, STEP, &signals)?;
        println!("{label}\n  RMS body velocity in mm/s      {:>8.2}", 1e3 * rms(&rows, 0));
        println!("  RMS body acceleration in m/s2  {:>8.2}", rms(&rows, 1));
        println!("  largest deflection in mm       {:>8.2}", 1e3 * largest(&rows, 2));
        println!("  RMS wheel force in N           {:>8.2}", rms(&rows, 3));
        println!("  RMS motor force in N           {:>8.2}", rms(&rows, 4));
        write(&out.join(format!("tum_{label}.csv").to_lowercase()), &signals, &rows)?;
    }
    Ok(())
}

fn rms(rows: &[Vec<f64>], signal: usize) -> f64 {
    (rows.iter().map(|row| row[signal].powi(2)).sum::<f64>() / rows.len() as f64).sqrt()
}

fn largest(rows: &[Vec<f64>], signal: usize) -> f64 {
    rows.iter().fold(0.0, |largest, row| row[signal].abs().max(largest))
}

fn write(path: &Path, signals: &[&str], rows: &[Vec<f64>]) -> Result<()> {
    let mut text = format!("time,{}", signals.join(","));
    for (index, row) in rows.iter().enumerate() {
        text += &format!("\n{}", index as f64 * STEP);
        row.iter().for_each(|value| text += &format!(",{value}"));
    }
    std::fs::write(path, text + "\n").map_err(|error| format!("{}: {error}", path.display()).into())
}
