//! The laws of a model, part by part.

use strut_model::{Bundle, Declarations, Value};
use strut_physics::elements::{Guide, ServoCylinder, WheelGuide};

use crate::catalogue::LIFT_OFF;
use crate::plant::{Drive, Dynamics, Plant, models};
use crate::rig::{Rig, choice};

/// What a model of a body and a wheel says of each part alone. Strut and tyre are moved on a dyno, so that they have
/// their memories there as in the rig.
pub(super) struct Laws {
    /// In kilograms.
    pub sprung_mass: f64,
    /// In kilograms.
    pub unsprung_mass: f64,
    strut: Dyno,
    tire: Dyno,
    guide: Option<Guide<f64>>,
    wheel_guide: Option<WheelGuide<f64>>,
    actuator: Option<ServoCylinder<f64>>,
}

impl Laws {
    /// The laws of a rig with these choices and parameters; none if it is no body on a strut and a wheel on a tyre.
    pub fn of(rig: &Rig, choices: &[Value], parameters: &[f64]) -> Option<Self> {
        let plant = &rig.plant;
        let parameter = |name: &str| Some(parameters[plant.parameter(name)?]);
        let (sprung_mass, unsprung_mass) = (parameter("sprung_mass")?, parameter("unsprung_mass")?);
        plant.output("suspension.deflection")?;
        let lift_off = plant.setting(LIFT_OFF).map_or(Value::Boolean(false), |it| choices[it].clone());
        let dyno = |element: &str| {
            let named = |name: &str| match name {
                "carried_mass" => Some(sprung_mass + unsprung_mass),
                _ => parameter(name),
            };
            Dyno::of(element, &lift_off, named)
        };
        Some(Self {
            sprung_mass,
            unsprung_mass,
            strut: dyno("Strut")?,
            tire: dyno("Tire")?,
            guide: part(plant, parameters, "guide"),
            wheel_guide: part(plant, parameters, "wheel_guide"),
            actuator: part(plant, parameters, "actuator"),
        })
    }

    /// The force with which the strut pulls its ends together, its lower end being moved.
    pub fn strut(&self, motion: &Drive) -> Vec<f64> {
        self.strut.force(motion).into_iter().map(|force| -force).collect()
    }

    /// The force with which the tyre presses on the road, the road being moved.
    pub fn tire(&self, motion: &Drive) -> Vec<f64> {
        self.tire.force(motion)
    }

    /// What the guide resists the body's velocity with.
    pub fn on_body(&self, velocity: &[f64]) -> Vec<f64> {
        let resistance = |v: &f64| {
            self.guide.as_ref().map_or(0.0, |guide| guide.added_to(|| 0.0, *v, guide.active_effects()))
        };
        velocity.iter().map(resistance).collect()
    }

    /// What the guide resists the wheel's velocity with.
    pub fn on_wheel(&self, velocity: &[f64]) -> Vec<f64> {
        velocity.iter().map(|v| self.wheel_guide.as_ref().map_or(0.0, |guide| guide.resistance(*v))).collect()
    }

    /// What the actuator's pressure pushes with; none if the model has no actuator.
    pub fn actuator(&self, pressure: &[f64]) -> Option<Vec<f64>> {
        let actuator = self.actuator.as_ref()?;
        Some(pressure.iter().map(|pressure| actuator.force(*pressure)).collect())
    }
}

/// One element, its upper end clamped.
struct Dyno {
    dynamics: Box<dyn Dynamics>,
    parameters: Vec<f64>,
    start: Vec<f64>,
    inputs: usize,
    output: usize,
}

impl Dyno {
    fn of(element: &str, lift_off: &Value, named: impl Fn(&str) -> Option<f64>) -> Option<Self> {
        let plant = models::named("ElementDyno")?;
        let mut choices = plant.choices.clone();
        let clamped = plant.setting("element")?;
        choices[clamped] = choice(&plant, clamped, &Value::Text(element.into())).ok()?;
        choices[plant.setting(LIFT_OFF)?] = lift_off.clone();
        Some(Self {
            dynamics: plant.prepare(&choices).ok()?,
            // What a rig cannot have is neutral.
            parameters: plant.parameters.iter().map(|it| named(&it.name).unwrap_or(it.start)).collect(),
            start: plant.states.iter().map(|it| it.start).collect(),
            inputs: plant.inputs.len(),
            output: plant.output("force")?,
        })
    }

    fn force(&self, motion: &Drive) -> Vec<f64> {
        // Motion comes first among its inputs; no coil is driven.
        let mut motion = motion.clone();
        let samples = motion.inputs.first().map_or(0, Vec::len);
        motion.inputs.resize(self.inputs, vec![0.0; samples]);
        let mut outputs = self.dynamics.outputs(&self.parameters, &self.start, &motion);
        outputs.swap_remove(self.output)
    }
}

/// A part of a model with the model's values; none if the model does not have all of it.
fn part<B: Bundle<f64>>(plant: &Plant, parameters: &[f64], group: &str) -> Option<B> {
    let declared = Declarations::of::<B>();
    let indices: Option<Vec<usize>> =
        declared.iter().map(|it| plant.parameter(&format!("{group}.{}", it.name))).collect();
    let indices = indices?;
    Some(B::from_fn(|i| parameters[indices[i]]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::derivative;

    /// On its own path through its simulation, a model's parts balance.
    #[test]
    fn the_parts_of_a_rig_make_the_whole() {
        let mut rig = Rig::published("tum-linear-measured-quarter-car").unwrap();
        for (name, value) in [
            ("strut.coulomb.force", 40.0),
            ("guide.coulomb.force", 20.0),
            ("guide.coulomb.velocity", 0.02),
            ("wheel_guide.damping", 30.0),
            ("tire.quadratic", 2e6),
            ("hysteresis.maxwell.stiffness", 3e3),
            ("hysteresis.maxwell.time", 0.01),
        ] {
            let index = rig.plant.parameter(name).unwrap();
            rig.parameters[index] = value;
        }
        let step = 1e-3;
        let wave = |f: f64, size: f64| -> Vec<f64> {
            (0..4000).map(|k| size * (f * k as f64 * step).sin() * (k as f64 / 400.0).min(1.0)).collect()
        };
        let road = wave(30.0, 4e-3);
        let road_velocity = derivative(&road, step);
        let force = wave(11.0, 50.0);
        let drive = Drive::sampled(step, vec![road.clone(), road_velocity, force.clone()]);
        let names: Vec<&str> = rig.plant.inputs.iter().map(|it| it.name.as_str()).collect();
        assert_eq!(names, ["road.position", "road.velocity", "actuator.force"]);
        let dynamics = rig.plant.prepare(&rig.choices).unwrap();
        let outputs = dynamics.outputs(&rig.parameters, &rig.start, &drive);
        let signal = |name: &str| &outputs[rig.plant.output(name).unwrap()];
        let laws = Laws::of(&rig, &rig.choices, &rig.parameters).unwrap();
        let negative = |values: &[f64]| values.iter().map(|it| -it).collect::<Vec<_>>();
        let moved = |name: &str, rate: Vec<f64>| Drive::sampled(step, vec![negative(signal(name)), rate]);
        let strut = laws.strut(&moved("suspension.deflection", negative(signal("suspension.velocity"))));
        let tire =
            laws.tire(&moved("tire.deflection", derivative(&negative(signal("tire.deflection")), step)));
        let (on_body, on_wheel) =
            (laws.on_body(signal("body.velocity")), laws.on_wheel(signal("wheel.velocity")));
        for k in 500..3999 {
            let at = |name: &str| signal(name)[k];
            let body = laws.sprung_mass * at("body.acceleration") + strut[k] + on_body[k] - force[k];
            let wheel = laws.unsprung_mass * at("wheel.acceleration") - strut[k] + force[k] + on_wheel[k]
                - at("wheel.force");
            assert!(body.abs() < 0.2 && wheel.abs() < 0.2, "{k}: {body} N, {wheel} N");
            assert!((tire[k] - at("wheel.force")).abs() < 2.0, "{k}: {} N", tire[k] - at("wheel.force"));
        }
    }

    #[test]
    fn what_is_no_quarter_car_has_no_such_laws() {
        for name in ["element-dyno", "sas-rig", "linear-drive"] {
            let rig = Rig::published(name).unwrap();
            assert!(Laws::of(&rig, &rig.choices, &rig.parameters).is_none(), "{name}");
        }
        let rig = Rig::published("servo-suspension").unwrap();
        let laws = Laws::of(&rig, &rig.choices, &rig.parameters).unwrap();
        let area = rig.parameters[rig.plant.parameter("actuator.cylinder.area").unwrap()];
        assert_eq!(laws.actuator(&[2e6]).unwrap(), [2e6 * area]);
    }
}
