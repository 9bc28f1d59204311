//! Where the arms come to rest.

use std::f64::consts::PI;

use strut_model::{Real, Variables};

use crate::effects::with_constant;

use super::{Contact, Parameters, SasRig};

/// Static equilibrium.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Rest<R> {
    /// Angle of the wheel arm; zero where it is locked
    #[var(unit = RAD)]
    pub wheel_arm_angle: R,
    /// Angle of the body arm
    #[var(unit = RAD)]
    pub body_arm_angle: R,
    /// Force of the tyre on the eccentric
    #[var(unit = N)]
    pub tire_force: R,
}

/// Steps towards it. Six are enough nearby; from further away the arms walk there.
const STEPS: usize = 40;
/// Longest step in radians.
const STRIDE: f64 = 0.1;
/// Moment of which it is said that it vanishes, in newton metres.
const NOTHING: f64 = 1e-6;

/// What turns the arms, and by how much that falls with their angles.
struct Balance<R> {
    on_wheel: R,
    on_body: R,
    /// What the tyre has against a turn of the wheel arm.
    tire_rate: R,
    /// What the spring has against a turn of either arm.
    spring_rates: [R; 2],
    /// What gravity adds to a turn of the body arm.
    falling: R,
}

impl SasRig {
    /// The angles at which nothing moves, the eccentric standing at its height of rest.
    ///
    /// Newton's method. Where the body arm would fall away from a position, the step goes on falling, so that
    /// what is found is stable.
    pub(super) fn rest<R: Real>(&self, p: &Parameters<R>) -> Rest<R> {
        let (mut wheel, mut body) = (R::from(if self.locked { 0.0 } else { -0.2 }), R::from(0.4));
        for _ in 0..STEPS {
            let [by_wheel, by_body] = self.balance(p, wheel, body).step(self.locked);
            wheel += by_wheel;
            body += by_body;
        }
        let compression = Contact::new(p, wheel, p.rest.eccentric_height).compression;
        let tire_force = p.tire.static_force(compression);
        Rest { wheel_arm_angle: wheel, body_arm_angle: body, tire_force }
    }

    /// Whether it is one: the arms rest, and one above the other.
    pub(super) fn is_rest(&self, p: &Parameters<f64>, rest: &Rest<f64>) -> bool {
        let between = rest.body_arm_angle - rest.wheel_arm_angle;
        let balance = self.balance(p, rest.wheel_arm_angle, rest.body_arm_angle);
        let at_rest = (self.locked || balance.on_wheel.abs() < NOTHING) && balance.on_body.abs() < NOTHING;
        at_rest && (0.0..PI).contains(&between)
    }

    fn balance<R: Real>(&self, p: &Parameters<R>, wheel: R, body: R) -> Balance<R> {
        let spring = p.spring.at(body - wheel, self.lever);
        let contact = Contact::new(p, wheel, p.rest.eccentric_height);
        let tire = p.tire.static_force(contact.compression) * contact.lever;
        Balance {
            on_wheel: with_constant(
                tire - spring.on_wheel_arm - p.wheel_arm.gravity_moment * contact.cosine,
                p.pivot.preload - p.wheel_arm.load,
            ),
            on_body: with_constant(
                spring.on_body_arm - p.body_arm.gravity_moment * body.cos(),
                -p.pivot.preload - p.body_arm.load,
            ),
            // The turning of lever and gravity hardly counts.
            tire_rate: p.tire.stiffness * contact.lever.squared(),
            spring_rates: spring.rates,
            falling: p.body_arm.gravity_moment * body.sin(),
        }
    }
}

impl<R: Real> Balance<R> {
    /// The step of both arms towards where nothing turns them.
    fn step(&self, locked: bool) -> [R; 2] {
        let [on_wheel, on_body] = self.spring_rates;
        let (alone, share) = if locked {
            (R::from(0.0), R::from(0.0))
        } else {
            let rate = self.tire_rate + on_wheel;
            (self.on_wheel / rate, on_wheel / rate)
        };
        // The wheel arm goes along with the body arm by its share. A rate of a thousandth of a newton metre is
        // none: then the stride decides.
        let rate = (on_body * (R::from(1.0) - share) - self.falling).max(R::from(1e-3));
        let by_body = limited((self.on_body + on_body * alone) / rate);
        [limited(alone + share * by_body), by_body]
    }
}

fn limited<R: Real>(step: R) -> R {
    step.clamp(R::from(-STRIDE), R::from(STRIDE))
}
