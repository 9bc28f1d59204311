//! Episodes: sequences of calls that follow from a seed and a number.

use std::ffi::CString;

use fastrand::Rng;

use crate::call::{Action, BLOBS, Call, Damage, Fault, Handles, INSTANCES, Null, STATES};
use crate::package::{Kind, Package, Variable};
use crate::standard::Version;

/// Calls of an episode.
pub const LENGTH: usize = 1000;

/// What an episode calls.
pub fn episode(package: &Package, seed: u64, number: u64) -> Vec<Call> {
    let mut rng = Rng::with_seed(seed ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let mut source = Source { package, rng: &mut rng };
    let mut calls = Vec::with_capacity(LENGTH + 4 * INSTANCES);
    for instance in 0..INSTANCES {
        let action = source.instantiate(Fault::None);
        calls.push(Call { instance, action, checked: false });
        // From where most of the functions are legal; what goes before comes at random, too.
        if source.rng.u8(..4) > 0 {
            let enter = source.enter_initialization_mode();
            for action in [enter, Action::ExitInitializationMode] {
                calls.push(Call { instance, action, checked: false });
            }
        }
    }
    for _ in 0..LENGTH {
        let instance = source.rng.usize(..INSTANCES);
        calls.push(Call { instance, action: source.action(), checked: source.rng.u8(..4) == 0 });
    }
    calls
}

struct Source<'a> {
    package: &'a Package,
    rng: &'a mut Rng,
}

impl Source<'_> {
    fn action(&mut self) -> Action {
        use Action as A;
        let null = self.null();
        let three = self.package.version == Version::Three;
        // Weights: what works goes on for a while between what ends it.
        match self.rng.u8(..128) {
            0 => {
                let fault = self.fault();
                self.instantiate(fault)
            }
            1 if self.rng.u8(..4) == 0 => A::FreeInstance,
            1..=2 => A::Reset,
            3 if self.rng.u8(..2) == 0 => A::Terminate,
            3..=4 => A::SetDebugLogging { on: self.rng.bool(), categories: self.categories(), null },
            5..=6 => A::SetupExperiment {
                tolerance: self.maybe(Self::number),
                start: self.time(),
                stop: self.maybe(Self::time),
            },
            7..=9 => self.enter_initialization_mode(),
            10..=12 => A::ExitInitializationMode,
            13..=28 => {
                let kind = self.kind();
                A::Get { kind, references: self.references(kind), null }
            }
            29..=44 => {
                let references = self.references(Kind::Real);
                let values =
                    references.into_iter().map(|reference| (reference, self.value(reference))).collect();
                A::SetReal { values, null }
            }
            45..=46 => {
                let kind = if three && self.rng.bool() { Kind::Choice } else { Kind::Integer };
                let references = self.references(kind);
                let values = references.into_iter().map(|reference| (reference, self.integer())).collect();
                A::SetInteger { kind, values, null }
            }
            47 => {
                let references = self.references(Kind::Boolean);
                let values = references.into_iter().map(|reference| (reference, self.integer())).collect();
                A::SetBoolean { values, null }
            }
            48 => {
                let references = self.references(Kind::Text);
                let values = references.into_iter().map(|reference| (reference, self.text())).collect();
                A::SetString { values, null }
            }
            49..=53 => {
                let knowns = self.references(Kind::Real);
                A::GetDirectionalDerivative {
                    unknowns: self.references(Kind::Real),
                    knowns: knowns.into_iter().map(|reference| (reference, self.number())).collect(),
                    null,
                }
            }
            54..=59 => A::GetFmuState { state: self.state(), null },
            60..=64 => A::SetFmuState { state: self.state() },
            65..=67 => A::FreeFmuState { state: self.state(), null },
            68 => A::SerializedFmuStateSize { state: self.state(), null },
            69..=71 => A::SerializeFmuState {
                state: self.state(),
                blob: self.rng.usize(..BLOBS),
                excess: self.excess(),
                null,
            },
            72..=75 => A::DeSerializeFmuState {
                blob: self.rng.usize(..BLOBS),
                damage: self.damage(),
                state: self.state(),
                null,
            },
            76..=78 => A::EnterEventMode,
            79..=81 => A::NewDiscreteStates { null },
            82..=84 => A::EnterContinuousTimeMode,
            85..=86 => A::CompletedIntegratorStep { null },
            87..=89 => A::SetTime { time: self.time() },
            90..=92 => A::SetContinuousStates {
                values: (0..4).map(|_| self.number()).collect(),
                excess: self.excess(),
                null,
            },
            93..=95 => A::GetDerivatives { excess: self.excess(), null },
            96 => A::GetContinuousStates { excess: self.excess(), null },
            97 => A::GetNominals { excess: self.excess(), null },
            98 => A::GetEventIndicators { excess: self.excess(), null },
            99..=100 if three => {
                let unknowns = self.references(Kind::Real);
                A::GetAdjointDerivative {
                    unknowns: unknowns.into_iter().map(|reference| (reference, self.number())).collect(),
                    knowns: self.references(Kind::Real),
                    null,
                }
            }
            101..=102 if three => A::EnterStepMode,
            99..=102 => {
                let references = self.references(Kind::Real);
                let values = references
                    .into_iter()
                    .map(|reference| (reference, self.rng.i32(-1..5), self.number()))
                    .collect();
                A::SetRealInputDerivatives { values, null }
            }
            103..=105 => {
                let references = self.references(Kind::Real);
                let orders =
                    references.into_iter().map(|reference| (reference, self.rng.i32(-1..4))).collect();
                A::GetRealOutputDerivatives { orders, null }
            }
            106..=121 => self.step(),
            122 if three => A::GetNumberOfContinuousStates { null },
            123 if three => A::GetUInt16 { references: self.references(Kind::Integer) },
            124 if three => A::SetFloat32 { references: self.references(Kind::Real) },
            125 if three => A::EnterConfigurationMode,
            126 if three => A::EvaluateDiscreteStates,
            _ if three => A::EnterStepMode,
            122 => A::CancelStep,
            123 => A::GetStatus { kind: self.status(), null },
            124 => A::GetRealStatus { kind: self.status(), null },
            125 => A::GetIntegerStatus { kind: self.status(), null },
            126 => A::GetBooleanStatus { kind: self.status(), null },
            _ => A::GetStringStatus { kind: self.status(), null },
        }
    }

    fn instantiate(&mut self, fault: Fault) -> Action {
        let (cosimulation, logging) = (self.rng.u8(..3) > 0, self.rng.bool());
        let mut handles = Handles::default();
        if self.package.version == Version::Three {
            handles = Handles { events: self.rng.bool(), early_return: self.rng.bool() };
        }
        Action::Instantiate { cosimulation, logging, handles, fault }
    }

    /// In FMI 3.0 it sets the experiment up, too.
    fn enter_initialization_mode(&self) -> Action {
        match self.package.version {
            Version::Two => Action::EnterInitializationMode,
            Version::Three => Action::SetupExperiment { tolerance: None, start: 0.0, stop: None },
        }
    }

    fn fault(&mut self) -> Fault {
        use Fault as F;
        let faults = [
            F::NoName,
            F::EmptyName,
            F::WrongGuid,
            F::NoGuid,
            F::UnknownType,
            F::ForeignResources,
            F::NoCallbacks,
        ];
        if self.rng.bool() { F::None } else { faults[self.rng.usize(..faults.len())] }
    }

    fn null(&mut self) -> Null {
        match self.rng.u8(..32) {
            0 => Null::First,
            1 => Null::Last,
            _ => Null::None,
        }
    }

    fn maybe(&mut self, make: impl FnOnce(&mut Self) -> f64) -> Option<f64> {
        self.rng.bool().then(|| make(self))
    }

    fn kind(&mut self) -> Kind {
        match self.rng.u8(..8) {
            0 if self.package.version == Version::Three && self.rng.bool() => Kind::Choice,
            0 => Kind::Integer,
            1 => Kind::Boolean,
            2 => Kind::Text,
            _ => Kind::Real,
        }
    }

    /// Mostly those that there are, some twice, some not.
    fn references(&mut self, kind: Kind) -> Vec<u32> {
        let count = match self.rng.u8(..16) {
            0 => 0,
            1 => self.rng.usize(..200),
            _ => self.rng.usize(1..4),
        };
        let known: Vec<u32> = self.all(kind).map(|variable| variable.reference).collect();
        (0..count)
            .map(|_| match self.rng.u8(..64) {
                0 => self.rng.u32(..),
                1 => u32::MAX,
                2 => known.len() as u32,
                _ if known.is_empty() => self.rng.u32(..3),
                _ => known[self.rng.usize(..known.len())],
            })
            .collect()
    }

    fn all(&self, kind: Kind) -> impl Iterator<Item = &Variable> {
        self.package.variables.iter().filter(move |variable| variable.kind == kind)
    }

    /// Small inputs mostly: a simulation that has blown up is not worth much. Parameters near their start
    /// values, or at their bounds.
    fn value(&mut self, reference: u32) -> f64 {
        let variable = self.package.variable(Kind::Real, reference);
        match (variable, self.rng.u8(..8)) {
            (Some(variable), 1..) if variable.is_input() => self.rng.f64() * 0.02 - 0.01,
            (Some(variable), 1) => variable.min,
            (Some(variable), 2) => variable.max,
            (Some(variable), 3..=5) => variable.start * 10_f64.powf(self.rng.f64() * 2.0 - 1.0),
            _ => self.number(),
        }
    }

    fn number(&mut self) -> f64 {
        match self.rng.u8(..20) {
            0 => f64::NAN,
            1 => f64::INFINITY,
            2 => f64::NEG_INFINITY,
            3 => -0.0,
            4 => 0.0,
            5 => f64::from_bits(self.rng.u64(..)),
            6 => f64::MIN_POSITIVE / 2.0,
            7 => f64::MAX,
            8 => 10_f64.powf(self.rng.f64() * 24.0 - 12.0),
            _ => self.rng.f64() * 4.0 - 2.0,
        }
    }

    fn integer(&mut self) -> i32 {
        if self.rng.u8(..8) == 0 { self.rng.i32(..) } else { self.rng.i32(-1..8) }
    }

    fn time(&mut self) -> f64 {
        if self.rng.u8(..8) == 0 { self.number() } else { self.rng.f64() * 10.0 }
    }

    fn text(&mut self) -> Option<CString> {
        let texts: [&[u8]; 8] = [
            b"",
            b"profile.csv",
            b"r\xc3\xa4der <&> \"'",
            b"\xff\xfe not UTF-8",
            b"%s%n%d",
            b"../../../../../../etc/hostname",
            b"/dev/zero",
            b"/",
        ];
        match self.rng.usize(..10) {
            8 => None,
            9 => CString::new(vec![b'x'; 100_000]).ok(),
            index => CString::new(texts[index]).ok(),
        }
    }

    fn categories(&mut self) -> Vec<Option<CString>> {
        let names = ["logAll", "logStatusDiscard", "logSolver", "logStatusError", "logEvents", ""];
        (0..self.rng.usize(..3))
            .map(|_| match self.rng.usize(..16) {
                0 => None,
                index => CString::new(names[index % names.len()]).ok(),
            })
            .collect()
    }

    fn state(&mut self) -> usize {
        self.rng.usize(..STATES)
    }

    fn status(&mut self) -> i32 {
        if self.rng.u8(..8) == 0 { self.rng.i32(..) } else { self.rng.i32(0..4) }
    }

    fn excess(&mut self) -> isize {
        if self.rng.u8(..16) == 0 { self.rng.isize(-3..4) } else { 0 }
    }

    fn damage(&mut self) -> Damage {
        match self.rng.u8(..8) {
            0 => Damage::Flip(self.rng.f64(), self.rng.u8(1..)),
            1 => Damage::Cut(self.rng.f64()),
            2 => Damage::Longer(self.rng.usize(1..20)),
            3 => {
                let word = match self.rng.u8(..3) {
                    0 => self.rng.u64(..),
                    1 => self.number().to_bits(),
                    _ => self.rng.u64(..20),
                };
                Damage::Forge(self.rng.f64(), word)
            }
            4 => Damage::Random(self.rng.u64(..), self.rng.usize(..200)),
            _ => Damage::None,
        }
    }

    /// Short ones that are right mostly: a long one is a matter of minutes.
    fn step(&mut self) -> Action {
        let short = 10_f64.powf(self.rng.f64() * 3.0 - 4.5);
        let (offset, size) = match self.rng.u8(..16) {
            0 => (self.number(), short),
            1 => (0.0, [0.0, -0.0, -1e-3, f64::NAN, f64::INFINITY, 1e-300, 1e300][self.rng.usize(..7)]),
            _ => (0.0, short),
        };
        Action::DoStep { offset, size }
    }
}
