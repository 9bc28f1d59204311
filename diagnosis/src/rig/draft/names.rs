//! What names say: which of them belong together, and which part of a rig they mean.

use std::collections::BTreeSet;

/// Words for a position or a deflection.
const POSITIONS: [&str; 18] = [
    "x",
    "y",
    "z",
    "s",
    "h",
    "l",
    "q",
    "pos",
    "position",
    "defl",
    "deflection",
    "disp",
    "displacement",
    "travel",
    "stroke",
    "height",
    "length",
    "way",
];
/// Words for a velocity.
const VELOCITIES: [&str; 10] = ["v", "w", "vel", "velocity", "speed", "rate", "der", "dot", "dt", "d"];
/// Words for a spring rate.
const STIFFNESSES: [&str; 6] = ["k", "c", "stiffness", "stiff", "spring", "rate"];
/// Words for a damping rate.
const DAMPINGS: [&str; 9] = ["d", "c", "b", "r", "damping", "damp", "damper", "rate", "coefficient"];

/// A kind of quantity, with the words by which names show it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A position or a deflection.
    Position,
    /// Its rate.
    Velocity,
    /// A spring rate.
    Stiffness,
    /// A damping rate.
    Damping,
}

impl Quantity {
    fn has(self, word: &str) -> bool {
        match self {
            Self::Position => POSITIONS.contains(&word),
            // `dz`, `zdot`, `zd` and `zp` are rates of `z`.
            Self::Velocity => {
                let of = word
                    .strip_prefix('d')
                    .or_else(|| ["dot", "d", "p"].iter().find_map(|end| word.strip_suffix(end)));
                VELOCITIES.contains(&word) || of.is_some_and(|of| POSITIONS.contains(&of))
            }
            Self::Stiffness => STIFFNESSES.contains(&word),
            Self::Damping => DAMPINGS.contains(&word),
        }
    }

    /// Single letters with which a short name begins: `zs`, `vrel`.
    fn letters(self) -> &'static str {
        match self {
            Self::Position => "xyzs",
            Self::Velocity => "v",
            Self::Stiffness => "kc",
            Self::Damping => "dcbr",
        }
    }

    /// The readings of a name without one word of this quantity: of `z_s`, both letters can be it.
    fn without_one(self, words: &[String]) -> impl Iterator<Item = Vec<String>> {
        let places = (0..words.len()).filter(move |place| self.has(&words[*place]));
        places.map(|place| [&words[..place], &words[place + 1..]].concat())
    }

    /// What a name says apart from its quantity. A name can be read in several ways: `zs` is a word, or the position `s`.
    fn stems(self, name: &str) -> BTreeSet<Vec<String>> {
        let words = words(name);
        let mut stems: BTreeSet<Vec<String>> = self.without_one(&words).collect();
        if stems.is_empty() {
            for (place, word) in words.iter().enumerate() {
                let mut letters = word.chars();
                let first = letters.next();
                if (2..=5).contains(&word.len()) && first.is_some_and(|it| self.letters().contains(it)) {
                    let mut shorter = words.clone();
                    letters.as_str().clone_into(&mut shorter[place]);
                    stems.insert(shorter);
                }
            }
        }
        match self {
            // `der(z_rel)` names the position as well.
            Self::Velocity => {
                let positions = |stem: &Vec<String>| Self::Position.without_one(stem).collect::<Vec<_>>();
                let more: Vec<Vec<String>> = stems.iter().flat_map(positions).collect();
                stems.extend(more);
            }
            // `k_spring` says twice what it is.
            Self::Stiffness | Self::Damping => {
                stems.insert(words.iter().filter(|word| !self.has(word)).cloned().collect());
            }
            Self::Position => {}
        }
        stems.insert(words);
        stems
    }
}

/// Whether two names differ only in the words of their quantities: `z_rel` and `v_rel`, `damper.s_rel` and `damper.v_rel`.
pub fn go_together(one: (Quantity, &str), other: (Quantity, &str)) -> bool {
    !one.0.stems(one.1).is_disjoint(&other.0.stems(other.1))
}

/// The part of a rig that a text means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Between wheel and road.
    Tire,
    /// Between body and wheel.
    Strut,
    /// The body.
    Body,
    /// The wheel.
    Wheel,
    /// The road.
    Road,
}

/// Words of each part, the most special part first.
const PLACES: [(Place, &[&str]); 5] = [
    (Place::Tire, &["tire", "tyre"]),
    (
        Place::Strut,
        &[
            "strut",
            "suspension",
            "susp",
            "damper",
            "shock",
            "absorber",
            "spring",
            "rel",
            "relative",
            "srel",
            "vrel",
            "deflection",
            "defl",
            "stroke",
        ],
    ),
    (Place::Road, &["road", "ground", "track"]),
    (Place::Wheel, &["wheel", "unsprung", "axle", "hub"]),
    (Place::Body, &["body", "sprung", "chassis", "vehicle"]),
];

/// The part that a variable belongs to: by its name, else by its description.
pub fn place(name: &str, description: &str) -> Option<Place> {
    let named = |text: &str| {
        let words = words(text);
        let has = |of: &&(Place, &[&str])| words.iter().any(|word| of.1.contains(&word.as_str()));
        PLACES.iter().find(has).map(|(place, _)| *place)
    };
    named(name).or_else(|| named(description))
}

/// The words of a name in lower case: `springDamper.s_rel1` has spring, damper, s, rel and 1.
fn words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut before = ' ';
    for c in name.chars() {
        if c.is_alphanumeric() {
            let starts = !before.is_alphanumeric()
                || (c.is_uppercase() && before.is_lowercase())
                || c.is_numeric() != before.is_numeric();
            match words.last_mut() {
                Some(word) if !starts => word.extend(c.to_lowercase()),
                _ => words.push(c.to_lowercase().collect()),
            }
        }
        before = c;
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use Quantity::{Damping, Position, Stiffness, Velocity};

    #[test]
    fn names_have_words() {
        assert_eq!(words("springDamper.s_rel1"), ["spring", "damper", "s", "rel", "1"]);
        assert_eq!(words("der(z_rel)"), ["der", "z", "rel"]);
        assert_eq!(words("ACTUATOR[2].F"), ["actuator", "2", "f"]);
    }

    #[test]
    fn a_deflection_has_the_velocity_of_its_name() {
        for (deflection, velocity) in [
            ("z_rel", "v_rel"),
            ("suspension.deflection", "suspension.velocity"),
            ("springDamper.s_rel", "springDamper.v_rel"),
            ("zs", "vs"),
            ("x1", "v1"),
            ("z_rel", "der(z_rel)"),
            ("z_rel", "dz_rel"),
            ("suspTravel", "suspSpeed"),
            ("deflection", "velocity"),
            ("xrel", "xrel_dot"),
        ] {
            assert!(
                go_together((Position, deflection), (Velocity, velocity)),
                "{deflection} {velocity}: {:?} {:?}",
                Position.stems(deflection),
                Velocity.stems(velocity)
            );
        }
        for (deflection, velocity) in
            [("z_rel", "v_s"), ("z_s", "v_u"), ("x1", "v2"), ("tire.deflection", "suspension.velocity")]
        {
            assert!(
                !go_together((Position, deflection), (Velocity, velocity)),
                "{deflection} {velocity}: {:?} {:?}",
                Position.stems(deflection),
                Velocity.stems(velocity)
            );
        }
    }

    #[test]
    fn a_spring_has_the_damper_of_its_name() {
        for (stiffness, damping) in
            [("k_s", "d_s"), ("ks", "cs"), ("tyre.c", "tyre.d"), ("springRate", "damperRate")]
        {
            assert!(go_together((Stiffness, stiffness), (Damping, damping)), "{stiffness} {damping}");
        }
        assert!(!go_together((Stiffness, "k_t"), (Damping, "d_s")));
        assert!(!go_together((Stiffness, "tire.stiffness"), (Damping, "strut.damping")));
    }

    #[test]
    fn a_part_is_named_or_described() {
        assert_eq!(place("tire.deflection", ""), Some(Place::Tire));
        assert_eq!(place("z_rel", "distance of the wheel from the body"), Some(Place::Strut));
        assert_eq!(place("z_s", "position of the body"), Some(Place::Body));
        assert_eq!((place("k_t", "tyre stiffness"), place("x1", "")), (Some(Place::Tire), None));
    }
}
