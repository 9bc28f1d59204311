//! The systems that the tests integrate.

use strut_integrators::{Array, Integrator, Method, Settings, Square, System};

/// The derivative by state and by time, from rows.
pub fn jacobian<const N: usize>(
    rows: [[f64; N]; N],
    by_time: [f64; N],
) -> (<[f64; N] as Array>::Square, [f64; N]) {
    let mut matrix = <[f64; N] as Array>::Square::zeros();
    for (row, values) in rows.iter().enumerate() {
        for (column, value) in values.iter().enumerate() {
            *matrix.at_mut(row, column) = *value;
        }
    }
    (matrix, by_time)
}

/// An integrator whose states all have the same magnitude.
pub fn integrator<const N: usize>(method: Method, tolerance: f64, nominal: f64) -> Integrator<[f64; N]> {
    Integrator::new(method, Settings::new(tolerance, &[nominal; N])).expect("usable settings")
}

/// Integrates from 0 to `end` in `calls` calls of equal length.
pub fn run<const N: usize>(
    integrator: &mut Integrator<[f64; N]>,
    system: &mut impl System<[f64; N]>,
    end: f64,
    calls: u32,
    x: &mut [f64; N],
) {
    let time = |i: u32| end * f64::from(i) / f64::from(calls);
    for i in 0..calls {
        integrator.advance(system, time(i), time(i + 1), x).expect("a harmless system");
    }
}

/// The largest difference, relative to a value's magnitude or `floor`.
pub fn difference<const N: usize>(x: &[f64; N], exact: &[f64; N], floor: f64) -> f64 {
    x.iter().zip(exact).map(|(a, b)| (a - b).abs() / b.abs().max(floor)).fold(0.0, f64::max)
}

/// x' = A x.
pub struct Linear<const N: usize>(pub [[f64; N]; N]);

impl<const N: usize> System<[f64; N]> for Linear<N> {
    fn rates(&mut self, _t: f64, x: &[f64; N]) -> [f64; N] {
        std::array::from_fn(|i| (0..N).map(|j| self.0[i][j] * x[j]).sum())
    }
    fn jacobian(&mut self, _t: f64, _x: &[f64; N]) -> (<[f64; N] as Array>::Square, [f64; N]) {
        jacobian(self.0, [0.0; N])
    }
}

/// x'' = -(2 pi)^2 x: period 1.
pub fn oscillator() -> Linear<2> {
    let omega = std::f64::consts::TAU;
    Linear([[0.0, 1.0], [-omega * omega, 0.0]])
}

/// Autonomous and not linear; from (1, 1, 0) the solution is (exp(sin t), cos t, sin t).
pub struct Curved;

impl System<[f64; 3]> for Curved {
    fn rates(&mut self, _t: f64, x: &[f64; 3]) -> [f64; 3] {
        [x[0] * x[1], -x[2], x[1]]
    }
    fn jacobian(&mut self, _t: f64, x: &[f64; 3]) -> (<[f64; 3] as Array>::Square, [f64; 3]) {
        jacobian([[x[1], x[0], 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]], [0.0; 3])
    }
}

impl Curved {
    pub fn exact(t: f64) -> [f64; 3] {
        [t.sin().exp(), t.cos(), t.sin()]
    }
}

/// Prothero and Robinson's problem, with the solution cos t whatever the stiffness; the slope is
/// not linear in the deviation, and depends on time.
pub struct Forced {
    pub stiffness: f64,
}

impl System<[f64; 1]> for Forced {
    fn rates(&mut self, t: f64, x: &[f64; 1]) -> [f64; 1] {
        let d = x[0] - t.cos();
        [-self.stiffness * (d + d * d) - t.sin()]
    }
    fn jacobian(&mut self, t: f64, x: &[f64; 1]) -> (<[f64; 1] as Array>::Square, [f64; 1]) {
        let slope = -self.stiffness * (1.0 + 2.0 * (x[0] - t.cos()));
        jacobian([[slope]], [slope * t.sin() - t.cos()])
    }
}

impl Forced {
    /// The deviation d from cos t obeys the logistic equation d' = -stiffness (d + d^2).
    pub fn exact(&self, t: f64, start: f64) -> [f64; 1] {
        let d = start - 1.0;
        let z = d / (1.0 + d) * (-self.stiffness * t).exp();
        [t.cos() + z / (1.0 - z)]
    }
}

pub struct VanDerPol(pub f64);

impl System<[f64; 2]> for VanDerPol {
    fn rates(&mut self, _t: f64, x: &[f64; 2]) -> [f64; 2] {
        [x[1], self.0 * (1.0 - x[0] * x[0]) * x[1] - x[0]]
    }
    fn jacobian(&mut self, _t: f64, x: &[f64; 2]) -> (<[f64; 2] as Array>::Square, [f64; 2]) {
        let row = [-2.0 * self.0 * x[0] * x[1] - 1.0, self.0 * (1.0 - x[0] * x[0])];
        jacobian([[0.0, 1.0], row], [0.0; 2])
    }
}

pub struct Robertson;

impl System<[f64; 3]> for Robertson {
    fn rates(&mut self, _t: f64, x: &[f64; 3]) -> [f64; 3] {
        let (slow, fast, square) = (0.04 * x[0], 1e4 * x[1] * x[2], 3e7 * x[1] * x[1]);
        [fast - slow, slow - fast - square, square]
    }
    fn jacobian(&mut self, _t: f64, x: &[f64; 3]) -> (<[f64; 3] as Array>::Square, [f64; 3]) {
        let (by_1, by_2, square) = (1e4 * x[2], 1e4 * x[1], 6e7 * x[1]);
        jacobian([[-0.04, by_1, by_2], [0.04, -by_1 - square, -by_2], [0.0, square, 0.0]], [0.0; 3])
    }
}

pub struct Hires;

impl System<[f64; 8]> for Hires {
    fn rates(&mut self, _t: f64, y: &[f64; 8]) -> [f64; 8] {
        let pair = 280.0 * y[5] * y[7];
        [
            -1.71 * y[0] + 0.43 * y[1] + 8.32 * y[2] + 0.0007,
            1.71 * y[0] - 8.75 * y[1],
            -10.03 * y[2] + 0.43 * y[3] + 0.035 * y[4],
            8.32 * y[1] + 1.71 * y[2] - 1.12 * y[3],
            -1.745 * y[4] + 0.43 * y[5] + 0.43 * y[6],
            -pair + 0.69 * y[3] + 1.71 * y[4] - 0.43 * y[5] + 0.69 * y[6],
            pair - 1.81 * y[6],
            -pair + 1.81 * y[6],
        ]
    }
    fn jacobian(&mut self, _t: f64, y: &[f64; 8]) -> (<[f64; 8] as Array>::Square, [f64; 8]) {
        let (by_5, by_7) = (280.0 * y[7], 280.0 * y[5]);
        let rows = [
            [-1.71, 0.43, 8.32, 0.0, 0.0, 0.0, 0.0, 0.0],
            [1.71, -8.75, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, -10.03, 0.43, 0.035, 0.0, 0.0, 0.0],
            [0.0, 8.32, 1.71, -1.12, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, -1.745, 0.43, 0.43, 0.0],
            [0.0, 0.0, 0.0, 0.69, 1.71, -by_5 - 0.43, 0.69, -by_7],
            [0.0, 0.0, 0.0, 0.0, 0.0, by_5, -1.81, by_7],
            [0.0, 0.0, 0.0, 0.0, 0.0, -by_5, 1.81, -by_7],
        ];
        jacobian(rows, [0.0; 8])
    }
}

/// Mass on a spring with dry friction tanh(125 v), driven by a force.
pub struct Friction;

impl System<[f64; 2]> for Friction {
    fn rates(&mut self, t: f64, x: &[f64; 2]) -> [f64; 2] {
        [x[1], 20.0 * (5.0 * t).sin() - 100.0 * x[0] - 5.0 * (125.0 * x[1]).tanh()]
    }
    fn jacobian(&mut self, t: f64, x: &[f64; 2]) -> (<[f64; 2] as Array>::Square, [f64; 2]) {
        let tanh = (125.0 * x[1]).tanh();
        let row = [-100.0, -625.0 * (1.0 - tanh * tanh)];
        jacobian([[0.0, 1.0], row], [0.0, 100.0 * (5.0 * t).cos()])
    }
}

/// A mass that bounces on a spring and damper which only press: a tyre that lifts off. Without the
/// damper, the acceleration has kinks; with it, a jump whenever the mass touches down.
pub struct Bounce {
    /// Natural frequency in contact, in rad/s.
    pub omega: f64,
    /// Twice the damping ratio times omega, in 1/s.
    pub damping: f64,
}

const GRAVITY: f64 = 9.81;

impl System<[f64; 2]> for Bounce {
    fn rates(&mut self, _t: f64, x: &[f64; 2]) -> [f64; 2] {
        let contact = -self.omega * self.omega * x[0] - self.damping * x[1];
        [x[1], if x[0] < 0.0 { contact - GRAVITY } else { -GRAVITY }]
    }
    fn jacobian(&mut self, _t: f64, x: &[f64; 2]) -> (<[f64; 2] as Array>::Square, [f64; 2]) {
        let row = [-self.omega * self.omega, -self.damping];
        jacobian([[0.0, 1.0], if x[0] < 0.0 { row } else { [0.0; 2] }], [0.0; 2])
    }
}

impl Bounce {
    /// The exact state at `end`, from position 0 with `speed` upwards at t = 0, piece by piece; and
    /// the number of times that the piece changed.
    pub fn exact(&self, end: f64, mut speed: f64) -> ([f64; 2], u32) {
        let mut t = 0.0;
        let mut changes = 0;
        loop {
            let flight = 2.0 * speed / GRAVITY;
            if t + flight >= end {
                let s = end - t;
                return ([speed * s - 0.5 * GRAVITY * s * s, speed - GRAVITY * s], changes);
            }
            t += flight;
            // Undamped, gravity apart, lift-off is after half a period.
            let period = std::f64::consts::TAU / self.damped();
            let (mut early, mut late) = (0.3 * period, 0.75 * period);
            for _ in 0..60 {
                let middle = 0.5 * (early + late);
                if self.contact(middle, -speed)[0] < 0.0 {
                    early = middle;
                } else {
                    late = middle;
                }
            }
            changes += 1;
            if t + late >= end {
                return (self.contact(end - t, -speed), changes);
            }
            t += late;
            speed = self.contact(late, -speed)[1];
            changes += 1;
        }
    }

    fn damped(&self) -> f64 {
        (self.omega * self.omega - 0.25 * self.damping * self.damping).sqrt()
    }

    /// The state a time `s` after touching down with velocity `v`.
    fn contact(&self, s: f64, v: f64) -> [f64; 2] {
        let (w, decay) = (self.damped(), 0.5 * self.damping);
        let rest = -GRAVITY / (self.omega * self.omega);
        let (a, b) = (-rest, (v - decay * rest) / w);
        let (sin, cos) = (w * s).sin_cos();
        let fade = (-decay * s).exp();
        let x = fade * (a * cos + b * sin);
        [rest + x, fade * w * (b * cos - a * sin) - decay * x]
    }
}

/// Remembers where its rates were evaluated last.
pub struct Watched<S, A> {
    pub inner: S,
    pub rates: u64,
    pub jacobians: u64,
    pub last: Option<(f64, A)>,
}

impl<S, A> Watched<S, A> {
    pub fn new(inner: S) -> Self {
        Watched { inner, rates: 0, jacobians: 0, last: None }
    }
}

impl<A: Array, S: System<A>> System<A> for Watched<S, A> {
    fn rates(&mut self, t: f64, x: &A) -> A {
        self.rates += 1;
        self.last = Some((t, *x));
        self.inner.rates(t, x)
    }
    fn jacobian(&mut self, t: f64, x: &A) -> (A::Square, A) {
        self.jacobians += 1;
        self.inner.jacobian(t, x)
    }
}

/// A system given by its rates; the derivative by state is numerical, that by time left out.
pub struct Scalar<F>(pub F);

impl<F: FnMut(f64, f64) -> f64> System<[f64; 1]> for Scalar<F> {
    fn rates(&mut self, t: f64, x: &[f64; 1]) -> [f64; 1] {
        [(self.0)(t, x[0])]
    }
    fn jacobian(&mut self, t: f64, x: &[f64; 1]) -> (<[f64; 1] as Array>::Square, [f64; 1]) {
        let d = 1e-6 * x[0].abs().max(1.0);
        jacobian([[((self.0)(t, x[0] + d) - (self.0)(t, x[0] - d)) / (2.0 * d)]], [0.0])
    }
}
