//! Ports: constants that are off, may have either sign, and move something that can be measured.

use num_dual::Dual64;
use strut_model::{
    Bundle, Declaration, Declarations, Dependencies, Instant, Model, Real, SettingKind, Settings, Value,
};
use strut_physics::{CATALOGUE, actuators, controllers, rigs, roads, sensors, sources};

/// A model's ports.
struct Ports {
    model: &'static str,
    names: Vec<String>,
}

/// Checks the ports of all models of the library, and lists them.
macro_rules! ports_of {
    ($($model:ty)*) => { [$(ports::<$model>()),*] };
}

fn all() -> impl Iterator<Item = Ports> {
    ports_of! {
        rigs::QuarterCar
        rigs::FullCar
        rigs::SprungMass
        rigs::SasRig
        rigs::ServoSuspension
        rigs::ServoSuspensionIdentified
        rigs::ElementDyno
        rigs::LinearDrive
        rigs::RotaryDrive
        rigs::PneumaticCylinder
        actuators::LinearMotor
        actuators::ServoHydraulicActuator
        actuators::PumpHydraulicActuator
        actuators::PumpHydraulicActuatorLinear
        actuators::ExcitationMotor
        actuators::MrRotaryBrake
        actuators::EccentricDrive
        controllers::ForcePid
        controllers::ForceTwoDof
        controllers::ForceTwoDofLpv
        controllers::LqrController
        controllers::Skyhook
        controllers::ModalSkyhook
        controllers::ExcitationSpeedController
        sensors::SensorChain
        sensors::AngleSensorChain
        sensors::VelocityEstimator
        sensors::SignalAdapter
        roads::Road
        roads::FourWheelRoad
        sources::VoltageSource
        sources::FrequencySource
        sources::RecordedSource
    }
    .into_iter()
}

#[test]
fn every_model_of_the_library_is_asked() {
    let asked: Vec<&str> = all().map(|ports| ports.model).collect();
    let listed: Vec<&str> = CATALOGUE.iter().map(|entry| entry.about.name).collect();
    assert_eq!(asked, listed);
}

#[test]
fn the_ports_are_these() {
    let found: Vec<String> = all()
        .filter(|ports| !ports.names.is_empty())
        .map(|Ports { model, names }| format!("{model}: {}", names.join(", ")))
        .collect();
    let expected = [
        "QuarterCar: strut.preload, guide.preload, tire.preload, wheel_guide.preload",
        "FullCar: strut.front_left.preload, strut.front_right.preload, strut.rear_left.preload, \
         strut.rear_right.preload, tire.front_left.preload, tire.front_right.preload, tire.rear_left.preload, \
         tire.rear_right.preload",
        "SprungMass: strut.preload, guide.preload",
        "SasRig: wheel_arm.load, body_arm.load, pivot.preload, tire.preload",
        "ServoSuspension: strut.preload, guide.preload, tire.preload, wheel_guide.preload, \
         actuator.cylinder.preload, actuator.cylinder.flow_offset",
        "ElementDyno: strut.preload, tire.preload",
        "LinearDrive: constant_load",
        "RotaryDrive: constant_load",
        "PneumaticCylinder: constant_load, actuator.cylinder.chamber_a.flow_offset, \
         actuator.cylinder.chamber_b.flow_offset",
        "ServoHydraulicActuator: cylinder.preload, cylinder.flow_offset",
        "PumpHydraulicActuator: pump.load, pump.flow_offset, piston.preload",
        "ExcitationMotor: constant_load",
    ];
    assert_eq!(found, expected);
}

/// A model's ports, each of which is what a port has to be.
fn ports<M: Model>() -> Ports {
    let model = M::ABOUT.name;
    for others in [
        Declarations::of::<M::Derived<f64>>(),
        Declarations::of::<M::Input<f64>>(),
        Declarations::of::<M::State<f64>>(),
        Declarations::of::<M::Memory<f64>>(),
        Declarations::of::<M::Output<f64>>(),
    ] {
        let flagged = others.iter().find(|declared| declared.port);
        assert!(flagged.is_none(), "{model}: {flagged:?} is no parameter");
    }
    let mut names = Vec::new();
    for (index, declared) in Declarations::of::<M::Parameters<f64>>().into_iter().enumerate() {
        if declared.port {
            check::<M>(index, &declared);
            names.push(declared.name);
        }
    }
    Ports { model, names }
}

fn check<M: Model>(index: usize, declared: &Declaration) {
    let (model, Declaration { name, start, min, max, unit, .. }) = (M::ABOUT.name, declared);
    assert!(*start == 0.0, "{model}: {name} starts at {start}");
    assert!(min.is_none_or(|min| min < 0.0), "{model}: {name} has the bound {min:?}");
    assert!(max.is_none_or(|max| max > 0.0), "{model}: {name} has the bound {max:?}");
    assert!(["N", "N.m", "m3/s"].contains(&unit.symbol), "{model}: {name} is in {}", unit.symbol);
    let moves = |prepared: &M| {
        let seeded = |i: usize, start: f64| Dual64::new(start, f64::from(u8::from(i == index)));
        let signals: Vec<Dual64> = signals(prepared, seeded);
        assert!(signals.iter().all(|signal| signal.re.is_finite()), "{model}: {name}");
        signals.iter().any(|signal| signal.eps != 0.0)
    };
    let traced = |prepared: &M| {
        let set = |i: usize, _| if i == index { Dependencies::on(0) } else { Dependencies::default() };
        signals(prepared, set).iter().any(|signal: &Dependencies| signal.contains(0))
    };
    let prepared = prepared::<M>();
    assert!(prepared.iter().any(moves), "{model}: {name} moves nothing");
    assert!(prepared.iter().any(traced), "{model}: {name} is no dependency");
}

/// The model as it is declared, and with every other choice of each of its settings.
fn prepared<M: Model>() -> Vec<M> {
    let mut list = vec![M::prepare(&M::Settings::starts(), None).unwrap()];
    for (index, declared) in M::Settings::declare().iter().enumerate() {
        let values: Vec<Value> = match declared.kind {
            SettingKind::Boolean => [false, true].map(Value::Boolean).into(),
            SettingKind::Choice(choice) => (1..).take(choice.items.len()).map(Value::Integer).collect(),
            SettingKind::Integer | SettingKind::Text => Vec::new(),
        };
        for value in values {
            let mut settings = M::Settings::starts();
            settings.set(index, value).unwrap();
            list.extend(M::prepare(&settings, None));
        }
    }
    list
}

/// Rates and outputs somewhere near the start, where nothing is zero by chance.
fn signals<M: Model, R: Real>(model: &M, parameter: impl Fn(usize, f64) -> R) -> Vec<R> {
    let near = |declared: &[Declaration], i: usize| {
        let Declaration { start, nominal, .. } = declared[i];
        R::from(start + 0.03 * nominal.unwrap_or(0.1) * (1.0 + 2.7 * i as f64).sin())
    };
    let declared = Declarations::of::<M::Parameters<f64>>();
    let parameters = Bundle::from_fn(|i| parameter(i, declared[i].start));
    let declared = Declarations::of::<M::State<f64>>();
    let state = Bundle::from_fn(|i| near(&declared, i));
    let declared = Declarations::of::<M::Input<f64>>();
    let input = Bundle::from_fn(|i| near(&declared, i));
    let declared = Declarations::of::<M::Memory<f64>>();
    let (rates, output) = model.equations(Instant {
        time: R::from(0.3),
        state: &state,
        input: &input,
        parameters: &parameters,
        derived: &model.derive(&parameters),
        memory: &Bundle::from_fn(|i| R::from(declared[i].start)),
        tick: 0,
    });
    let mut list = Vec::new();
    rates.for_each(|_, rate| list.push(rate));
    output.for_each(|_, value| list.push(value));
    list
}
