//! Development aid: what is missing in a case.

use std::path::PathBuf;
use std::time::Instant;

use strut_diagnosis::catalogue::naming;
use strut_diagnosis::data::map::Map;
use strut_diagnosis::dataset::import::{align, choose_drive, import};
use strut_diagnosis::dataset::recorded::Recorded;
use strut_diagnosis::estimation::hypothesis::{Term, World};
use strut_diagnosis::explain::features::{Group, Motion, column, features};
use strut_diagnosis::missing::innovations::{Column, Noise};
use strut_diagnosis::missing::likelihood::Sums;
use strut_diagnosis::missing::ports::{Entry, Port};
use strut_diagnosis::missing::trajectory::{Setting, Window};
use strut_diagnosis::plant::Follower;
use strut_diagnosis::rig::Rig;

struct All(Vec<Vec<f64>>);
impl Follower for All {
    fn state(&mut self, _: usize, _: &mut [f64]) {}
    fn seen(&mut self, _: usize, s: strut_diagnosis::plant::Seen<'_>, _: &mut [f64]) {
        self.0.push(s.outputs.to_vec());
    }
    fn advanced(&mut self, _: usize, _: &[f64], _: &[f64]) {}
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let (rig_name, files) = args.split_first().unwrap();
    let mut rig = if rig_name.ends_with(".toml") {
        Rig::of(&strut_model::ParameterSet::parse(&std::fs::read_to_string(rig_name).unwrap()).unwrap()).unwrap()
    } else {
        Rig::published(rig_name).unwrap()
    };
    let map = Map::default();
    choose_drive(&mut rig, &PathBuf::from(&files[0]), &map).unwrap();
    let mut records = Vec::new();
    let mut train = 0;
    for f in files {
        if f == "--test" {
            train = records.len();
            continue;
        }
        records.extend(import(&rig, &PathBuf::from(f), &map).unwrap().recorded);
    }
    align(&mut records).unwrap();
    let records: Vec<Recorded> = records.iter().map(Recorded::conditioned).collect();
    let t0 = Instant::now();
    let mut world = World {
        rig: &rig,
        train: &records[..train],
        test: &records[train..],
        typical: Vec::new(),
        known: Vec::new(),
        held: Vec::new(),
        punctual: false,
        only: Vec::new(),
        criterion: Default::default(),
        looks: 1.0,
        sigma: vec![1.0; rig.plant.outputs.len()],
        floor: Vec::new(),
    };
    let dynamics = world.dynamics(&[]).unwrap();
    let ports = Port::all(&rig, &records[0]);
    let base = rig.base();
    let env = |name: &str, or: f64| std::env::var(name).ok().and_then(|it| it.parse().ok()).unwrap_or(or);
    let accuracy = env("ACC", 0.01);
    let nominal: Vec<f64> = rig.plant.states.iter().map(|it| it.nominal.unwrap_or(1.0)).collect();
    let mut point = world.origin();
    let mut precisions: Vec<f64> =
        base.iter().map(|it| if rig.parameters[*it] == 0.0 { 0.0 } else { (0.3 * rig.parameters[*it]).powi(-2) }).collect();
    let cut = |records: &[Recorded]| -> Vec<(usize, std::ops::Range<usize>)> {
        let mut all = Vec::new();
        for (r, record) in records.iter().enumerate() {
            let length = (env("LEN", 20.0) / record.step) as usize;
            for section in &record.sections {
                let mut at = section.start;
                while at < section.end {
                    let end = if section.end - at < 3 * length / 2 { section.end } else { at + length };
                    if at == section.start || env("WHOLE", 0.0) > 0.0 {
                        all.push((r, at..end));
                    }
                    at = end;
                }
            }
        }
        all
    };
    let mut windows: Vec<Window> = Vec::new();
    let all = cut(&records);
    for round in 0..2 {
        let mut setting = Setting::new(&*dynamics, (&point, &rig.start), &ports, &base, &nominal, &records);
        for (row, noise) in setting.noise.iter_mut().enumerate() {
            let size = setting.sizes[ports.iter().position(|p| p.entry == Entry::Sensor(row)).unwrap()];
            *noise += (accuracy * size).powi(2);
        }
        if round == 0 {
            println!("active {:?}", setting.active.iter().map(|it| &rig.plant.states[*it].name).collect::<Vec<_>>());
            println!("sizes {:?}", setting.sizes);
        }
        let t = Instant::now();
        use rayon::prelude::*;
        windows = all
            .par_iter()
            .map(|(r, range)| {
                let part = Recorded { sections: vec![range.clone()], ..records[*r].clone() };
                let start = world.starts(std::slice::from_ref(&part)).remove(0);
                setting.window(&records, *r, range.clone(), &start).expect("a trajectory")
            })
            .collect();
        println!("windows {} in {:?}", windows.len(), t.elapsed());
        let timing: Vec<Term> = world.coordinates(&[]).into_iter().filter_map(|c| match c.handle {
            strut_diagnosis::estimation::fit::Handle::Output(..) => Some(Term::Fault(c.handle)),
            _ => None,
        }).collect();
        if round == 0 { precisions.extend(timing.iter().map(|_| (1e-3 / 4e-4_f64).powi(2))); }
        for term in &timing {
            let strut_diagnosis::estimation::hypothesis::Term::Fault(handle) = term else { continue };
            let mut at = point.clone();
            at.set(*handle, 1e-3);
            let made: Vec<Column> = windows.par_iter().map(|w| setting.changed((&records, w), (*term, &*dynamics), &at).unwrap()).collect();
            windows.iter_mut().zip(made).for_each(|(w, c)| w.timing.push(c));
        }
        let noise = Noise { ports: setting.sizes.iter().zip(&ports).map(|(s, p)| if p.is_sensor() { 0.0 } else { env("BG", 0.03) * s }).collect(), outputs: setting.noise.clone() };
        let blocks = setting.innovations(&windows, &noise, &[]);
        let sums = Sums::of(blocks.iter()).unwrap();
        let columns: Vec<usize> = (1..=precisions.len()).collect();
        let fit = sums.fitted(&columns, &precisions).unwrap();
        for (i, index) in base.iter().enumerate() {
            let before = point.parameters[*index];
            let after = before + fit.values[i];
            let low = if before > 0.0 { 0.3 * before } else { f64::NEG_INFINITY };
            println!("  {} {:.5} -> {:.5} ± {:.5}", rig.plant.parameters[*index].name, before, after, fit.covariance[(i, i)].sqrt());
            if round == 0 {
                point.parameters[*index] = after.max(low);
            }
        }
    }
    let mut setting = Setting::new(&*dynamics, (&point, &rig.start), &ports, &base, &nominal, &records);
        for (row, noise) in setting.noise.iter_mut().enumerate() {
            let size = setting.sizes[ports.iter().position(|p| p.entry == Entry::Sensor(row)).unwrap()];
            *noise += (accuracy * size).powi(2);
        }
    let t = Instant::now();
    let location = setting.located(&windows, &precisions);
    println!("located in {:?}, background {:?}", t.elapsed(), location.background.ports);
    for it in &location.ranked {
        println!("  {:<24} {:9.1}  sd {:.4} {} (size {:.4})", ports[it.port].place, it.gain, it.deviation, ports[it.port].unit, setting.sizes[it.port]);
    }
    let best = &location.ranked[0];
    let mut noise = location.background.clone();
    noise.ports[best.port] = noise.ports[best.port].max(best.deviation * env("RW", 1.0));

    {
        let mut out = String::new();
        use std::fmt::Write as _;
        let moved = vec![0.0; base.len()];
        let n = setting.active.len();
        let mut index = 0;
        for (p, sd) in noise.ports.iter().enumerate() {
            if p == best.port { break; }
            if *sd > 0.0 { index += 1; }
        }
        for w in &windows {
            let smooth = setting.smoothed(w, &noise, &[], &moved);
            for (k, s) in smooth.iter().enumerate() {
                write!(out, "{} {}", w.record, w.step * (w.samples.start + k) as f64).unwrap();
                for (i, a) in setting.active.iter().enumerate() {
                    write!(out, " {}", w.trajectory[k][*a] + s.x[i]).unwrap();
                }
                writeln!(out, " {} {}", s.x[n + index], s.variance[n + index].sqrt()).unwrap();
            }
        }
        std::fs::write(std::env::var("OUT").unwrap() + ".f", out).unwrap();
    }
    // Candidates.
    let t = Instant::now();
    let wanted: Vec<usize> = (0..rig.plant.outputs.len()).collect();
    let outputs: Vec<Vec<Vec<f64>>> = windows
        .iter()
        .map(|w| {
            struct On<'a>(&'a [usize], &'a Window, All);
            impl Follower for On<'_> {
                fn state(&mut self, k: usize, state: &mut [f64]) {
                    for i in self.0 {
                        state[*i] = self.1.trajectory[k][*i];
                    }
                }
                fn seen(&mut self, k: usize, s: strut_diagnosis::plant::Seen<'_>, x: &mut [f64]) {
                    self.2.seen(k, s, x);
                }
                fn advanced(&mut self, _: usize, _: &[f64], _: &[f64]) {}
            }
            let mut on = On(&setting.active, w, All(vec![]));
            dynamics.followed(&point.parameters, &w.trajectory[0], &w.drive, (&[], &wanted), &mut on);
            (0..wanted.len()).map(|o| on.2.0.iter().map(|v| v[o]).collect()).collect()
        })
        .collect();
    let mut whole: Vec<Vec<Vec<f64>>> = records.iter().map(|r| vec![vec![f64::NAN; r.len()]; wanted.len()]).collect();
    for (w, o) in windows.iter().zip(&outputs) {
        for (to, from) in whole[w.record].iter_mut().zip(o) {
            to[w.samples.clone()].copy_from_slice(from);
        }
    }
    world.typical = strut_diagnosis::screening::typical(&rig, &records, &whole);
    println!("typical {:?}", world.typical);
    let terms = world.terms();
    let timing = windows[0].timing.len();
    let mut names = Vec::new();
    let mut columns: Vec<Vec<Column>> = windows.iter().map(|_| Vec::new()).collect();
    let mut groups: Vec<std::ops::Range<usize>> = Vec::new();
    let mut count = 1 + base.len() + timing;
    for (index, term) in terms.iter().enumerate() {
        let Ok(own) = world.dynamics(&[*term]) else { continue };
        for probe in world.probes(index, *term, &point) {
            use rayon::prelude::*;
            let made: Option<Vec<Vec<Column>>> = windows
                .par_iter()
                .map(|w| probe.points.iter().map(|p| setting.changed((&records, w), (*term, &*own), p)).collect())
                .collect();
            let Some(made) = made else { continue };
            let name = naming::name(*term, &rig.plant);
            names.push(format!("{} {} {}", name.id, name.element, name.name));
            groups.push(count..count + probe.points.len());
            count += probe.points.len();
            for (all, made) in columns.iter_mut().zip(made) {
                all.extend(made);
            }
        }
    }
    println!("{} named probes, {} columns in {:?}", names.len(), count, t.elapsed());
    let commands: Vec<usize> = ports.iter().filter_map(|p| if let Entry::Input(i) = p.entry { Some(i) } else { None }).collect();
    let mut place = setting.active.len();
    for port in &ports {
        if port.is_sensor() {
            continue;
        }
        place += 1;
        let Some(element) = port.element else { continue };
        let signals = rig.kind.elements.iter().find(|it| it.element == element).unwrap();
        let motions: Vec<Motion> = windows
            .iter()
            .zip(&outputs)
            .map(|(w, o)| {
                let deflection = o[rig.plant.output(signals.deflection).unwrap()].clone();
                let velocity = match signals.velocity.and_then(|n| rig.plant.output(n)) {
                    Some(i) => o[i].clone(),
                    None => strut_diagnosis::dataset::recorded::derivative(&deflection, w.step),
                };
                Motion { deflection, velocity }
            })
            .collect();
        let mut kinds = vec![Group::Deflection, Group::Velocity, Group::Acceleration, Group::Memory, Group::DeflectionAndVelocity, Group::Time];
        kinds.extend(commands.iter().map(|i| Group::Command(*i)));
        for group in kinds {
            let signals = features(group, &motions, &windows);
            names.push(format!("-- {} {:?}", port.place, group));
            groups.push(count..count + signals.len());
            count += signals.len();
            for signal in &signals {
                for ((all, w), s) in columns.iter_mut().zip(&windows).zip(signal) {
                    all.push(column(port, place - 1, w, s));
                }
            }
        }
    }
    println!("{count} columns in {:?}", t.elapsed());
    let t = Instant::now();
    let blocks = setting.innovations(&windows, &noise, &columns);
    println!("innovations in {:?}", t.elapsed());
    let sums = |r: usize| Sums::of(blocks.iter().filter(|b| b.record == r)).unwrap();
    let mut out = String::new();
    use std::fmt::Write as _;
    writeln!(out, "{} {} {}", base.len(), timing, train).unwrap();
    for (i, index) in base.iter().enumerate() {
        writeln!(out, "{} {} {}", rig.plant.parameters[*index].name, point.parameters[*index], precisions[i]).unwrap();
    }
    writeln!(out, "{}", names.len()).unwrap();
    for (name, range) in names.iter().zip(&groups) {
        writeln!(out, "{} {} {}", range.start, range.end, name).unwrap();
    }
    std::fs::write(std::env::var("OUT").unwrap() + ".txt", out).unwrap();
    let mut bytes: Vec<u8> = Vec::new();
    bytes.extend((records.len() as u64).to_le_bytes());
    bytes.extend((count as u64).to_le_bytes());
    for r in 0..records.len() {
        let s = sums(r);
        bytes.extend((s.count as f64).to_le_bytes());
        bytes.extend(s.log_variance.to_le_bytes());
        for v in s.normal.iter() {
            bytes.extend(v.to_le_bytes());
        }
    }
    std::fs::write(std::env::var("OUT").unwrap() + ".bin", bytes).unwrap();
    println!("all in {:?}", t0.elapsed());
}
