//! What is published of each rig: the parameters that its model starts with.

use crate::case::{Plant, Value};
use crate::pump::POINTS;
use crate::random::Random;

/// A parameter as the FMU calls it, its unit and its value.
type Published = (&'static str, &'static str, f64);

/// TUM Table 10; damping 2 ζ √(c m) with ζ = 0.397, asymmetry from Table 9.
const TUM: [Published; 10] = [
    ("sprung_mass", "kg", 94.38),
    ("unsprung_mass", "kg", 23.92),
    ("strut.stiffness", "N/m", 8400.0),
    ("strut.damping", "N.s/m", 707.0),
    ("strut.asymmetry.ratio", "1", 0.312_211_221_122_112_2),
    ("strut.coulomb.force", "N", 115.0),
    ("guide.coulomb.force", "N", 20.0),
    ("tire.stiffness", "N/m", 152_140.0),
    ("tire.quadratic", "N/m2", 4_075_400.0),
    ("tire.damping", "N.s/m", 50.0),
];

/// Konieczny, Notations.
const KONIECZNY: [Published; 18] = [
    ("sprung_mass", "kg", 86.0),
    ("unsprung_mass", "kg", 11.5),
    ("strut.stiffness", "N/m", 8652.0),
    ("strut.damping", "N.s/m", 1161.2),
    ("tire.stiffness", "N/m", 37_412.0),
    ("tire.damping", "N.s/m", 72.0),
    ("actuator.spool.gain", "m/V", 0.025e-3),
    ("actuator.spool.time_constant", "s", 2.32e-3),
    ("actuator.fluid.bulk_modulus", "Pa", 1.4e9),
    ("actuator.cylinder.leakage", "m5/(N.s)", 15e-12),
    ("actuator.supply.pressure", "Pa", 12e6),
    ("actuator.fluid.density", "kg/m3", 880.0),
    ("actuator.cylinder.area", "m2", 0.765_786e-3),
    ("actuator.cylinder.volume", "m3", 45.9458e-6),
    ("actuator.cylinder.hose_volume", "m3", 80.0398e-6),
    ("actuator.valve.discharge_coefficient", "1", 0.611),
    ("actuator.valve.perimeter", "m", 15.708e-3),
    ("actuator.spool.stroke", "m", 0.5e-3),
];

/// The set AjalaSoftPumpHydraulicActuator; all of it is assumed, as the document has no values.
const AJALA: [Published; 8] = [
    ("pump.displacement", "m3", 12e-6),
    ("motor.inertia", "kg.m2", 3.3e-4),
    ("piston.compression_area", "m2", 10.2e-4),
    ("piston.rebound_area", "m2", 8.6e-4),
    ("gas.charge_pressure", "Pa", 3e6),
    ("gas.exponent", "1", 1.3),
    ("gas.compression_volume", "m3", 0.5e-3),
    ("gas.rebound_volume", "m3", 0.5e-3),
];

/// Its valves: flows, and what they cost in compression and in rebound.
const VALVES: [(&str, &str, [f64; POINTS]); 4] = [
    ("valve.compression.flow", "m3/s", FLOWS),
    (
        "valve.compression.pressure_drop",
        "Pa",
        [-1.4e5, -1e5, -0.7e5, -0.4e5, 0.0, 0.4e5, 1.6e5, 2.7e5, 3.9e5],
    ),
    ("valve.rebound.flow", "m3/s", FLOWS),
    ("valve.rebound.pressure_drop", "Pa", [-1.4e5, -1e5, -0.7e5, -0.4e5, 0.0, 0.4e5, 3.8e5, 6.7e5, 9.8e5]),
];

const FLOWS: [f64; POINTS] = [-1e-3, -6e-4, -3e-4, -5e-5, 0.0, 5e-5, 3e-4, 6e-4, 1e-3];

/// Kogut 3.1.2 and 3.2.2: k_s = a_1 I/r_s2, M_1 = a_3 I_1, M_2 = a_6 I_2, k_t = a_1 I_1/R, and of the tyre's damping b_t over its
/// lever at rest.
const KOGUT: [Published; 16] = [
    ("wheel_arm.inertia", "kg.m2", 0.2116),
    ("wheel_arm.gravity_moment", "N.m", 9.883_836),
    ("wheel_arm.length", "m", 0.21),
    ("wheel_arm.offset", "rad", 0.234),
    ("body_arm.inertia", "kg.m2", 1.37),
    ("body_arm.gravity_moment", "N.m", 30.2359),
    ("spring.stiffness", "N/m", 3_791.313_612_565_445),
    ("spring.free_length", "m", 0.189),
    ("spring.wheel_arm_mount", "m", 0.275),
    ("spring.body_arm_mount", "m", 0.191),
    ("wheel.rim_radius", "m", 0.075),
    ("wheel.tire_thickness", "m", 0.02),
    ("tire.stiffness", "N/m", 108_822.857_142_857_14),
    ("tire.damping", "N.s/m", 1595.557),
    ("eccentric.depth", "m", 0.22),
    ("rest.eccentric_height", "m", 0.04),
];

/// What a gauge, a manometer or the oil's data sheet tells exactly.
const EXACT: [&str; 24] = [
    "ground_spring.stiffness",
    "actuator.supply.pressure",
    "actuator.fluid.density",
    "actuator.cylinder.area",
    "actuator.cylinder.volume",
    "actuator.cylinder.hose_volume",
    "actuator.valve.discharge_coefficient",
    "actuator.valve.perimeter",
    "actuator.spool.stroke",
    "piston.compression_area",
    "piston.rebound_area",
    "gas.compression_volume",
    "gas.rebound_volume",
    "valve.compression.flow",
    "valve.rebound.flow",
    "wheel_arm.length",
    "wheel_arm.offset",
    "spring.free_length",
    "spring.wheel_arm_mount",
    "spring.body_arm_mount",
    "wheel.rim_radius",
    "wheel.tire_thickness",
    "eccentric.depth",
    "rest.eccentric_height",
];

/// A damper of the size of those on shakers: some 1 kN s/m without current, a gas spring. No seed has one.
const MAGNETORHEOLOGICAL: [Published; 2] =
    [("strut.stiffness", "N/m", 1500.0), ("strut.damping", "N.s/m", 900.0)];

/// A carriage of 20 kg on oiled rails. No seed has a drive.
const DRIVE: [Published; 2] = [("moving_mass", "kg", 20.0), ("guide.damping", "N.s/m", 40.0)];

/// 3.6 Hz, a tenth of the critical damping; the spring was measured before. No seed has one.
const GUIDED_MASS: [Published; 3] = [
    ("moving_mass", "kg", 12.0),
    ("guide.damping", "N.s/m", 60.0),
    ("ground_spring.stiffness", "N/m", 6000.0),
];

/// What of a pneumatic cylinder no drawing tells: 8 kg on a level guide, a valve that lets 0.42 m³/min of free air pass at 7 bar.
/// No seed has one.
const PNEUMATIC: [Published; 3] = [
    ("moving_mass", "kg", 8.0),
    ("guide.damping", "N.s/m", 40.0),
    ("actuator.valve.conductance", "m5/(N.s)", 1e-8),
];

/// What the linear rigs do not have.
const BEYOND_LINEAR: [&str; 4] =
    ["strut.asymmetry.ratio", "strut.coulomb.force", "guide.coulomb.force", "tire.quadratic"];

/// Parameters that the model of a plant starts with.
pub fn start(plant: Plant) -> Vec<Value> {
    let published: &[Published] = match plant {
        Plant::LinearQuarter | Plant::RegulatedQuarter | Plant::PublishedQuarter | Plant::StrutDyno => &TUM,
        Plant::ServoQuarter => &KONIECZNY,
        Plant::MrDyno => &MAGNETORHEOLOGICAL,
        Plant::LinearDrive => &DRIVE,
        Plant::GuidedMass => &GUIDED_MASS,
        Plant::PumpDyno => &AJALA,
        Plant::SasRig => &KOGUT,
        Plant::PneumaticCylinder => &PNEUMATIC,
    };
    let wanted = |name: &str| plant != Plant::StrutDyno || name.starts_with("strut.");
    let value = |(name, unit, value): &Published| {
        let off = plant != Plant::PublishedQuarter && BEYOND_LINEAR.contains(name);
        Value { name: (*name).into(), unit: (*unit).into(), value: if off { 0.0 } else { *value } }
    };
    let tables: &[_] = if plant == Plant::PumpDyno { &VALVES } else { &[] };
    let points = tables.iter().flat_map(|(name, unit, values)| {
        let point = move |(number, value): (usize, &f64)| Value {
            name: format!("{name}[{}]", number + 1),
            unit: (*unit).into(),
            value: *value,
        };
        values.iter().enumerate().map(point)
    });
    published.iter().filter(|(name, ..)| wanted(name)).map(value).chain(points).collect()
}

/// The true nominal parameters: those of `start`, off by a share of `off`, at most twice that.
pub fn true_base(start: &[Value], off: f64, random: &mut Random) -> Vec<Value> {
    let mut base = start.to_vec();
    for value in base.iter_mut().filter(|value| is_uncertain(value)) {
        value.value *= 1.0 + off * random.normal().clamp(-2.0, 2.0);
    }
    base
}

/// Whether a nominal parameter is one that the rig has and that has to be measured.
pub fn is_uncertain(value: &Value) -> bool {
    value.value != 0.0 && !EXACT.contains(&value.table())
}
