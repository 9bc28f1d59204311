//! What a car has four of and two of, and where its corners are.
//!
//! Axes: x forwards, y to the left, z upwards from the centre of mass. Roll turns about x, positive if the left
//! side rises; pitch turns about y, positive if the rear rises (ISO 8855).

use strut_model::{Bundle, Declarations, Real, Variables};

use crate::elements::{AntiRollBar, Load, Mode, Strut, Tire};
use crate::signals::{Command, Deflection, Motion, Pushing, RoadMotion, Travel, WheelMotion};

/// One of a kind at each corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corners<T> {
    /// Front left.
    pub front_left: T,
    /// Front right.
    pub front_right: T,
    /// Rear left.
    pub rear_left: T,
    /// Rear right.
    pub rear_right: T,
}

impl<T> Corners<T> {
    /// In the order of the fields.
    #[inline]
    pub fn to_array(self) -> [T; 4] {
        [self.front_left, self.front_right, self.rear_left, self.rear_right]
    }

    /// Each, without a copy.
    #[inline]
    pub fn each(&self) -> [&T; 4] {
        [&self.front_left, &self.front_right, &self.rear_left, &self.rear_right]
    }
}

impl<T> From<[T; 4]> for Corners<T> {
    #[inline]
    fn from([front_left, front_right, rear_left, rear_right]: [T; 4]) -> Self {
        Self { front_left, front_right, rear_left, rear_right }
    }
}

/// Something for each corner. Arrays of the standard library are made by closures that copy their elements some times, and
/// numbers with derivatives are large.
#[inline(always)]
pub(crate) fn four<T>(of: impl Fn(usize) -> T) -> [T; 4] {
    [of(0), of(1), of(2), of(3)]
}

/// One of a kind at each axle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axles<T> {
    /// Front.
    pub front: T,
    /// Rear.
    pub rear: T,
}

/// Groups of variables that there are several of. Not generic over the group: on stable Rust no length can be
/// computed from that of a type parameter.
macro_rules! bundle_of {
    ($several:ident $fields:tt: $($group:ident)*) => {
        $(bundle_of!(@one $several $fields $group);)*
    };
    (@one $several:ident { $($field:ident: $doc:literal),* } $group:ident) => {
        impl $several<$group<f64>> {
            /// Number of variables.
            pub const COUNT: usize = [$($doc),*].len() * $group::<f64>::COUNT;
        }
        impl<R: Real> Bundle<R> for $several<$group<R>> {
            const LEN: usize = $several::<$group<f64>>::COUNT;
            type Array = [f64; $several::<$group<f64>>::COUNT];
            #[inline]
            fn gather(next: &mut impl FnMut() -> R) -> Self {
                Self { $($field: Bundle::<R>::gather(next)),* }
            }
            #[inline]
            fn scatter(&self, put: &mut impl FnMut(R)) {
                $(Bundle::<R>::scatter(&self.$field, put);)*
            }
            #[inline]
            fn combine<const N: usize>(&self, others: [&Self; N], f: &mut impl FnMut(&R, [&R; N]) -> R) -> Self {
                Self { $($field: Bundle::<R>::combine(&self.$field, strut_model::each(others, |it| &it.$field), f)),* }
            }
            fn declare(declarations: &mut Declarations) {
                $(declarations.group::<$group<f64>>(stringify!($field), $doc);)*
            }
        }
    };
}

bundle_of! {
    Corners { front_left: "Front left", front_right: "Front right", rear_left: "Rear left", rear_right: "Rear right" }:
    RoadMotion Motion Pushing Command WheelMotion Travel Deflection Load Strut Tire Mode
}
bundle_of! {
    Axles { front: "Front", rear: "Rear" }: AntiRollBar
}

/// Where the wheels are.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Geometry<R> {
    /// Distance from the centre of mass to the front axle (l_f)
    #[var(unit = M, start = 1.35, min = 1e-3)]
    pub front: R,
    /// Distance from the centre of mass to the rear axle (l_r)
    #[var(unit = M, start = 1.35, min = 1e-3)]
    pub rear: R,
    /// Distance from the centre of mass to the left wheels (w_l)
    #[var(unit = M, start = 0.78, min = 1e-3)]
    pub left: R,
    /// Distance from the centre of mass to the right wheels (w_r)
    #[var(unit = M, start = 0.78, min = 1e-3)]
    pub right: R,
}

/// Of a body: along z, about x, about y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Modal<R> {
    /// Height, vertical velocity, or force.
    pub heave: R,
    /// Roll angle, its rate, or moment.
    pub roll: R,
    /// Pitch angle, its rate, or moment.
    pub pitch: R,
}

impl<R: Real> Geometry<R> {
    /// Distance between the axles.
    #[inline]
    pub fn wheelbase(&self) -> R {
        self.front + self.rear
    }

    /// Distance between left and right wheels.
    #[inline]
    pub fn track(&self) -> R {
        self.left + self.right
    }

    /// Coordinates x and y of the corners.
    #[inline]
    fn corners(&self) -> [[R; 2]; 4] {
        let Self { front, rear, left, right } = *self;
        [[front, left], [front, -right], [-rear, left], [-rear, -right]]
    }

    /// What a small motion of the body is at its corners, upwards.
    #[inline]
    pub fn at_corners(&self, body: Modal<R>) -> [R; 4] {
        let corners = self.corners();
        four(|i| body.heave + corners[i][1] * body.roll - corners[i][0] * body.pitch)
    }

    /// Force and moments of upward forces at the corners.
    #[inline]
    pub fn resultant(&self, forces: [R; 4]) -> Modal<R> {
        let zero = R::from(0.0);
        let mut sum = Modal { heave: zero, roll: zero, pitch: zero };
        for ([x, y], force) in self.corners().iter().zip(&forces) {
            sum.heave += *force;
            sum.roll += *y * *force;
            sum.pitch -= *x * *force;
        }
        sum
    }

    /// Forces at the corners that have a given resultant: Ajala eq. 48, `M F_V`.
    ///
    /// M is that of eq. 49 with two corrections. Its denominator (w_f + w_r) means (w_l + w_r), and its last entry
    /// −w_l means +w_l: only then is M the right inverse of what [`resultant`](Self::resultant) does.
    /// There are other right inverses: forces in the ratio 1 : −1 : −1 : 1 twist the body and move nothing.
    #[inline]
    pub fn distribution(&self, demand: Modal<R>) -> [R; 4] {
        let Self { front, rear, left, right } = *self;
        let one_over = R::from(1.0) / (self.wheelbase() * self.track());
        let Modal { heave, roll, pitch } = demand;
        [
            rear * right * heave + rear * roll - right * pitch,
            rear * left * heave - rear * roll - left * pitch,
            front * right * heave + front * roll + right * pitch,
            front * left * heave - front * roll + left * pitch,
        ]
        .map(|numerator| numerator * one_over)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const CAR: Geometry<f64> = Geometry { front: 1.2, rear: 1.5, left: 0.8, right: 0.7 };

    fn list(modal: Modal<f64>) -> [f64; 3] {
        [modal.heave, modal.roll, modal.pitch]
    }

    #[test]
    fn equation_49_as_it_must_read() {
        let column = |heave: f64, roll: f64, pitch: f64| CAR.distribution(Modal { heave, roll, pitch });
        let expected = |numerators: [f64; 4]| numerators.map(|numerator| numerator / (2.7 * 1.5));
        let (lf, lr, wl, wr) = (1.2, 1.5, 0.8, 0.7);
        for (found, expected) in [
            (column(1.0, 0.0, 0.0), expected([lr * wr, lr * wl, lf * wr, lf * wl])),
            (column(0.0, 1.0, 0.0), expected([lr, -lr, lf, -lf])),
            (column(0.0, 0.0, 1.0), expected([-wr, -wl, wr, wl])),
        ] {
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-15);
            }
        }
        // As it is printed, w_f being zero or w_r and the last entry −w_l, a pitch demand would lift the car.
        let printed = [-wr, -wl, wr, -wl];
        assert!((CAR.resultant(printed).heave + 2.0 * wl).abs() < 1e-15);
    }

    #[test]
    fn left_up_is_positive_roll_and_rear_up_is_positive_pitch() {
        let tilted = |roll: f64, pitch: f64| CAR.at_corners(Modal { heave: 0.0, roll, pitch });
        assert_eq!(tilted(0.1, 0.0), [0.8 * 0.1, -0.7 * 0.1, 0.8 * 0.1, -0.7 * 0.1]);
        assert_eq!(tilted(0.0, 0.1), [-1.2 * 0.1, -1.2 * 0.1, 1.5 * 0.1, 1.5 * 0.1]);
        assert!(CAR.resultant([0.0, 0.0, 1.0, 1.0]).pitch > 0.0);
        assert!(CAR.resultant([1.0, 0.0, 1.0, 0.0]).roll > 0.0);
    }

    proptest! {
        #[test]
        fn demands_come_out_as_they_went_in(
            lengths in prop::array::uniform4(0.1..3.0_f64),
            demand in prop::array::uniform3(-1e3..1e3_f64),
        ) {
            let [front, rear, left, right] = lengths;
            let car = Geometry { front, rear, left, right };
            let [heave, roll, pitch] = demand;
            let found = list(car.resultant(car.distribution(Modal { heave, roll, pitch })));
            for (found, wanted) in found.into_iter().zip(demand) {
                prop_assert!((found - wanted).abs() < 1e-9, "{found} {wanted}");
            }
        }

        /// Kinematics and statics are each other's transpose: no power is lost between them.
        #[test]
        fn power_at_the_corners_is_power_of_the_body(
            forces in prop::array::uniform4(-1e3..1e3_f64),
            motion in prop::array::uniform3(-1.0..1.0_f64),
        ) {
            let [heave, roll, pitch] = motion;
            let corners = CAR.at_corners(Modal { heave, roll, pitch });
            let power: f64 = corners.iter().zip(forces).map(|(v, f)| v * f).sum();
            let modal: f64 = list(CAR.resultant(forces)).iter().zip(motion).map(|(f, v)| f * v).sum();
            prop_assert!((power - modal).abs() < 1e-9);
        }
    }
}
