//! What lies between an actuator's command and its force.

use strut_model::{Real, Variables};

use crate::effects::{
    CommandCurve, DelayState, LagState, Saturation, Slew, SlewState, delayed, lagged, switched_on,
};

/// An actuator that does not quite do what it is told: `F = R(sat(k T(D(u))) + s f(k T(D(u))))` with the delay D, the lag T,
/// an unnamed curve and the slew limit R (docs/effects.md, 23–26, G). A force without a command is a strut's preload.
///
/// The slew limit comes last. It is the force that cannot jump, whatever is asked for; and a force at its limit comes back at
/// once, while one that was limited in its rate first would have to unwind what was asked for beyond.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Actuation<R> {
    /// Force over the commanded one (k)
    #[var(unit = ONE, start = 1.0)]
    pub gain: R,
    /// Delay
    #[var(unit = S, start = 0.0, min = 0.0)]
    pub delay: R,
    /// Time constant of the lag
    #[var(unit = S, start = 0.0, min = 0.0)]
    pub lag: R,
    /// Limit
    pub saturation: Saturation<R>,
    /// Slew limit
    pub slew: Slew<R>,
    /// Unnamed force
    pub curve: CommandCurve<R>,
}

/// What is on its way from command to force.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct ActuationState<R> {
    /// Delay
    pub delay: DelayState<R>,
    /// Lag
    pub lag: LagState<R>,
    /// Slew limit
    pub slew: SlewState<R>,
}

impl<R: Real> Actuation<R> {
    /// The force that acts, and the rates of what is on its way; `further` is zero if the actuator does what it is told.
    #[inline]
    pub fn force(&self, state: ActuationState<R>, command: R, further: R) -> (R, ActuationState<R>) {
        if further.vanishes() {
            return (command, Self::rest());
        }
        let (late, delay) = delayed(self.delay, state.delay, command);
        let (late, lag) = lagged(self.lag, state.lag, late);
        let asked = self.gain * late;
        let made = self.saturation.limited(asked) + self.curve.force(asked);
        let (force, slew) = self.slew.limited(state.slew, made);
        (force, ActuationState { delay, lag, slew })
    }

    /// How many effects are on.
    pub fn active_effects(&self) -> R {
        let Self { gain, delay, lag, saturation, slew, curve } = *self;
        switched_on([gain - 1.0, delay, lag, saturation.ratio, slew.slowness, curve.scale])
    }

    /// Nothing on its way.
    #[inline]
    pub fn rest() -> ActuationState<R> {
        let zero = R::from(0.0);
        ActuationState {
            delay: DelayState { slow: zero, fast: zero },
            lag: LagState { arrived: zero },
            slew: SlewState { force: zero },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::POINTS;
    use proptest::prelude::*;

    fn neutral() -> Actuation<f64> {
        let curve = CommandCurve { scale: 0.0, force_range: 1.0, over_force: [0.0; POINTS] };
        let saturation = Saturation { ratio: 0.0, force: 100.0 };
        let slew = Slew { slowness: 0.0 };
        Actuation { gain: 1.0, delay: 0.0, lag: 0.0, saturation, slew, curve }
    }

    #[test]
    fn the_limit_is_that_of_the_force_not_of_the_command() {
        let weak = Actuation { gain: 0.5, saturation: Saturation { ratio: 1.0, force: 100.0 }, ..neutral() };
        let of = |command| weak.force(Actuation::rest(), command, weak.active_effects()).0;
        assert_eq!((of(100.0), of(180.0), of(300.0), of(-300.0)), (50.0, 90.0, 100.0, -100.0));
        assert_eq!(weak.active_effects(), 2.0);
    }

    #[test]
    fn a_force_at_its_limit_comes_back_at_once() {
        // 10 kN/s, and a limit of 100 N that the command was beyond for long.
        let saturation = Saturation { ratio: 1.0, force: 100.0 };
        let slow = Actuation { saturation, slew: Slew { slowness: 1e-4 }, ..neutral() };
        let held = ActuationState { slew: SlewState { force: 100.0 }, ..Actuation::rest() };
        assert_eq!(slow.force(held, 300.0, slow.active_effects()), (100.0, Actuation::rest()));
        let (force, rates) = slow.force(held, -300.0, slow.active_effects());
        assert!((force - 95.0).abs() < 1e-9 && (rates.slew.force + 1e4).abs() < 1e-6, "{force} {rates:?}");
    }

    proptest! {
        #[test]
        fn a_neutral_one_does_what_it_is_told(command in -1e4..1e4_f64) {
            prop_assert_eq!(neutral().active_effects(), 0.0);
            for further in [0.0, 1.0] {
                let (force, rates) = neutral().force(Actuation::rest(), command, further);
                prop_assert_eq!((force, rates), (command, Actuation::rest()));
            }
        }
    }
}
