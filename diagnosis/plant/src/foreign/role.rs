//! The elements of the library that can act beside a model of another maker.

/// An element beside a model. Each is a law that ElementDyno measures, under the names that the element's own parameters have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Between body and wheel.
    Strut,
    /// Between body, or carriage, and ground.
    Guide,
    /// Between wheel and ground.
    WheelGuide,
    /// Between wheel and road.
    Tire,
}

/// How parameters' names begin: the element's own, and on the bench. A name that ends here is a parameter, one that ends in a dot
/// a group.
type Laws = &'static [(&'static str, &'static str)];

const STRUT: Laws = &[("strut.", "strut."), ("hysteresis.", "hysteresis.")];

/// A guide is a strut between body and ground.
const GUIDE: Laws = &[
    ("guide.coulomb.", "strut.coulomb."),
    ("guide.stribeck.", "strut.stribeck."),
    ("guide.damping", "strut.damping"),
    ("guide.preload", "strut.preload"),
    ("guide.curve.scale", "strut.curve.scale"),
    ("guide.curve.velocity_range", "strut.curve.velocity_range"),
    ("guide.curve.over_velocity", "strut.curve.over_velocity"),
    ("ground_spring.stiffness", "strut.stiffness"),
    ("ground_spring.progression.", "strut.spring."),
];

const WHEEL_GUIDE: Laws = &[
    ("wheel_guide.coulomb.", "strut.coulomb."),
    ("wheel_guide.damping", "strut.damping"),
    ("wheel_guide.preload", "strut.preload"),
];

const TIRE: Laws = &[
    ("tire.quadratic", "tire.quadratic"),
    ("tire.preload", "tire.preload"),
    ("tire.coulomb.", "tire.coulomb."),
    ("tire.curve.", "tire.curve."),
];

impl Role {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Strut, Self::Guide, Self::WheelGuide, Self::Tire];

    /// The element's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Strut => "strut",
            Self::Guide => "guide",
            Self::WheelGuide => "wheel_guide",
            Self::Tire => "tire",
        }
    }

    /// The one of an element's name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|it| it.name() == name)
    }

    /// Whether a parameter, or a state, is the element's.
    pub fn has(self, name: &str) -> bool {
        self.on_bench(name).is_some()
    }

    /// The bench's name of one of its parameters; none if the parameter is another one's.
    pub fn on_bench(self, name: &str) -> Option<String> {
        self.laws().iter().find_map(|(own, bench)| renamed(name, own, bench))
    }

    /// The element's name of a parameter of the bench; none if the element does not have it.
    pub fn beside(self, name: &str) -> Option<String> {
        self.laws().iter().find_map(|(own, bench)| renamed(name, bench, own))
    }

    /// Whether it is clamped in as a tyre, and not as a strut.
    pub fn is_tire(self) -> bool {
        self == Self::Tire
    }

    /// Its spring rate and its damping rate on the bench.
    pub fn rates(self) -> [&'static str; 2] {
        if self.is_tire() { ["tire.stiffness", "tire.damping"] } else { ["strut.stiffness", "strut.damping"] }
    }

    fn laws(self) -> Laws {
        match self {
            Self::Strut => STRUT,
            Self::Guide => GUIDE,
            Self::WheelGuide => WHEEL_GUIDE,
            Self::Tire => TIRE,
        }
    }
}

/// A name that begins otherwise: `start` is a group, a parameter, or a table of them.
fn renamed(name: &str, start: &str, other: &str) -> Option<String> {
    let rest = name.strip_prefix(start)?;
    let whole = start.ends_with('.') || rest.is_empty() || rest.starts_with('[');
    whole.then(|| format!("{other}{rest}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Plant;
    use strut_physics::rigs::{ElementDyno, LinearDrive, QuarterCar};

    /// The bench's parameters.
    fn bench() -> Vec<String> {
        Plant::of::<ElementDyno>().parameters.into_iter().map(|it| it.name).collect()
    }

    #[test]
    fn every_name_begins_as_some_parameter_does() {
        let bench = bench();
        for role in Role::ALL {
            for (own, start) in role.laws() {
                assert!(bench.iter().any(|it| renamed(it, start, own).is_some()), "{start}");
            }
        }
    }

    #[test]
    fn a_name_goes_to_the_bench_and_back() {
        for role in Role::ALL {
            for name in bench() {
                if let Some(own) = role.beside(&name) {
                    assert_eq!(role.on_bench(&own).as_ref(), Some(&name));
                    assert!(role.has(&own));
                }
            }
        }
    }

    /// The effects of the catalogue have the names of the library's rigs.
    #[test]
    fn guides_and_tyre_are_called_as_in_a_rig_of_the_library() {
        let own = [Plant::of::<QuarterCar>(), Plant::of::<LinearDrive>()];
        for role in Role::ALL {
            for name in bench().iter().filter_map(|it| role.beside(it)) {
                assert!(own.iter().any(|it| it.parameter(&name).is_some()), "{name}");
            }
        }
    }

    #[test]
    fn a_name_that_only_begins_alike_is_another() {
        assert_eq!(Role::Tire.on_bench("tire.quadratic_2"), None);
        assert_eq!(Role::Tire.on_bench("tire.stiffness"), None);
        assert_eq!(
            Role::Guide.on_bench("guide.curve.over_velocity[3]").unwrap(),
            "strut.curve.over_velocity[3]"
        );
        assert!(!Role::Strut.has("guide.damping") && !Role::Guide.has("wheel_guide.damping"));
        assert_eq!(Role::named("wheel_guide"), Some(Role::WheelGuide));
        assert_eq!(Role::named("valve"), None);
    }
}
