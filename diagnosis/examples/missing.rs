//! Development aid: what is missing in a case.

use std::path::PathBuf;
use std::time::Instant;

use strut_diagnosis::catalogue::naming;
use strut_diagnosis::data::map::Map;
use strut_diagnosis::dataset::import::{align, choose_drive, import};
use strut_diagnosis::dataset::split::Records;
use strut_diagnosis::estimation::hypothesis::{Term, World};
use strut_diagnosis::explain::candidates::{Kind, outputs};
use strut_diagnosis::explain::selection::{Choice, Limits, choose};
use strut_diagnosis::rig::Rig;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let (rig_name, files) = args.split_first().unwrap();
    let mut rig = if rig_name.ends_with(".toml") {
        Rig::of(&strut_model::ParameterSet::parse(&std::fs::read_to_string(rig_name).unwrap()).unwrap())
            .unwrap()
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
    let test = records.split_off(train);
    let records = Records::new(&records, test);
    let t0 = Instant::now();
    let mut world = World::new(&rig, &records, Default::default());
    let frame = world.frame(&[], &world.origin()).unwrap();
    let mut missing = world.missing(&frame).unwrap();
    println!("windows {} {:?}", missing.windows.len(), t0.elapsed());
    for index in rig.base() {
        println!(
            "  {} {} -> {}",
            rig.plant.parameters[index].name, rig.parameters[index], missing.setting.point.parameters[index]
        );
    }
    let signals = outputs(&missing.setting, &missing.windows, rig.plant.outputs.len());
    world.typical = world.typical_along(&missing, &signals);
    let mut explained: Vec<Term> = Vec::new();
    for step in 0..3 {
        let t = Instant::now();
        let location = missing.located();
        println!("step {step} located {:?}", t.elapsed());
        for it in location.ranked.iter().take(5) {
            let port = &missing.setting.ports[it.port];
            println!(
                "   @ {:<24} {:9.1}  sd {:.4} {} (size {:.4})",
                port.place, it.gain, it.deviation, port.unit, missing.setting.sizes[it.port]
            );
        }
        let noise = location.background.clone();
        let candidates = world.candidates(&missing, &signals, &explained);
        println!("candidates {:?}", t.elapsed());
        let compared = world.compared(&missing, candidates, &noise).unwrap();
        println!("compared {:?}", t.elapsed());
        let mut all: Vec<_> = compared.named.iter().chain(&compared.features).copied().collect();
        all.sort_by(|a, b| b.share.total_cmp(&a.share));
        for it in all.iter().take(14) {
            let name = match &compared.candidates.list[it.candidate].kind {
                Kind::Named { term, .. } => {
                    let n = naming::name(*term, &rig.plant);
                    format!("{} {} {}", n.id, n.element, n.name)
                }
                Kind::Feature { port, group } => {
                    format!("-- {} {:?}", missing.setting.ports[*port].place, group)
                }
            };
            println!(
                "     {:6.3} {:6.3} {name} {:?}",
                it.share,
                it.validated,
                compared.amounts(it.candidate).iter().take(3).collect::<Vec<_>>()
            );
        }
        let choice = choose(compared.misses, &compared.named, &compared.features, Limits::USUAL);
        let taken = match &choice {
            Choice::Nothing => {
                println!("=> nothing");
                break;
            }
            Choice::Named(scores) => {
                let Kind::Named { term, .. } = compared.candidates.list[scores[0].candidate].kind else {
                    panic!()
                };
                let n = naming::name(term, &rig.plant);
                println!("=> NAMED {} {} {}", n.id, n.element, n.name);
                explained.push(term);
                scores[0].candidate
            }
            Choice::Unmodelled(score) => {
                let (p, g) = compared.feature(score.candidate).unwrap();
                println!("=> UNMODELLED {} {:?}", missing.setting.ports[p].place, g);
                score.candidate
            }
        };
        missing.explain(compared.columns(taken).into_iter());
    }
    println!("all in {:?}", t0.elapsed());
}
