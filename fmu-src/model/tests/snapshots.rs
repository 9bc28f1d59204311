//! A saved state continues bit for bit, also elsewhere; a damaged one is refused or harmless.

use crate::models::{Counter, Oscillator, read, set, started};
use proptest::prelude::*;
use strut_model::{Access, Simulation, Snapshot, Value};

proptest! {
    #[test]
    fn a_snapshot_continues_bit_for_bit(
        before in prop::collection::vec(1e-4..0.1_f64, 1..8),
        after in prop::collection::vec(1e-4..0.1_f64, 1..8),
        force in -3.0..3.0_f64,
        slope in -3.0..3.0_f64,
    ) {
        let run = |simulation: &mut Simulation<Oscillator>, steps: &[f64]| {
            for size in steps {
                let from = simulation.time();
                simulation.set_input_derivatives(&[0], &[1], &[slope]).unwrap();
                simulation.step(from, *size).unwrap();
            }
            (simulation.states().iter().map(|x| x.to_bits()).collect::<Vec<_>>(), simulation.time().to_bits())
        };
        let mut simulation = started::<Oscillator>();
        simulation.set_real(&[0], &[force], Access::Continuous).unwrap();
        run(&mut simulation, &before);
        let snapshot = simulation.save();
        let expected = run(&mut simulation, &after);
        simulation.restore(&snapshot).unwrap();
        prop_assert_eq!(&run(&mut simulation, &after), &expected);
        let mut other = Simulation::<Oscillator>::new(None, None).unwrap();
        other.restore(&Snapshot::from_bytes(&snapshot.to_bytes()).unwrap()).unwrap();
        prop_assert_eq!(&run(&mut other, &after), &expected);
    }

    #[test]
    fn sampled_memory_and_noise_are_part_of_a_snapshot(ticks in 0_u32..40) {
        let mut simulation = Simulation::<Counter>::new(None, None).unwrap();
        simulation.set_setting(1, Value::Integer(2), Access::All).unwrap();
        simulation.initialize().unwrap();
        for tick in 0..ticks {
            simulation.step(f64::from(tick) * 0.01, 0.01).unwrap();
        }
        let bytes = simulation.save().to_bytes();
        let from = simulation.time();
        simulation.step(from, 0.5).unwrap();
        let mut other = started::<Counter>();
        other.restore(&Snapshot::from_bytes(&bytes).unwrap()).unwrap();
        other.step(from, 0.5).unwrap();
        prop_assert_eq!(read(&mut other, "sum").to_bits(), read(&mut simulation, "sum").to_bits());
    }

    #[test]
    fn damaged_bytes_are_refused_or_harmless(
        place in 0_usize..400, value: u8, len in 0_usize..400, random in prop::collection::vec(any::<u8>(), 0..200),
    ) {
        let bytes = started::<Counter>().save().to_bytes();
        let mut damaged = bytes.clone();
        let end = damaged.len();
        damaged[place % end] ^= value;
        for blob in [damaged, bytes[..len.min(end)].to_vec(), random] {
            if let Ok(snapshot) = Snapshot::<Counter>::from_bytes(&blob) {
                let mut simulation = started::<Counter>();
                let _ = simulation.restore(&snapshot);
            }
        }
    }
}

/// A tolerance that was changed holds for the next step, whether or not an output is read before it.
#[test]
fn reading_before_a_step_does_not_change_the_step() {
    let run = |reads: bool| {
        let mut simulation = started::<Oscillator>();
        simulation.step(0.0, 0.1).unwrap();
        set(&mut simulation, "solver.tolerance", 1e-3, Access::Tunable).unwrap();
        let snapshot = simulation.save();
        if reads {
            read(&mut simulation, "energy");
            assert!(simulation.save().to_bytes() == snapshot.to_bytes(), "reading has changed the state");
        }
        simulation.step(0.1, 2.0).unwrap();
        let mut other = started::<Oscillator>();
        other.restore(&snapshot).unwrap();
        if reads {
            read(&mut other, "energy");
            assert!(other.save().to_bytes() == snapshot.to_bytes(), "reading has changed the restored state");
        }
        other.step(0.1, 2.0).unwrap();
        assert!(other.save().to_bytes() == simulation.save().to_bytes(), "the restored step is another one");
        simulation.states().to_vec()
    };
    assert_eq!(run(false), run(true));
}

#[test]
fn what_no_save_gives_is_refused() {
    let mut simulation = started::<Oscillator>();
    let mut bytes = simulation.save().to_bytes();
    // The fourth word, after their count, says whether initialisation is under way.
    bytes[8 + 3 * 8] = 2;
    let snapshot = Snapshot::from_bytes(&bytes).unwrap();
    assert!(simulation.restore(&snapshot).is_err());
}
