//! Time per `advance` of 1 ms, beside a hand-written Runge–Kutta step of order 4 without error
//! control. The best of several runs counts: all else is other programs' doing.
//!
//! `cargo bench -p strut-integrators`

use std::{hint::black_box, time::Instant};

use strut_integrators::{Array, Integrator, Method, Settings, System};

/// Calls per run, and runs; just enough to run through if this is not a benchmark but a test.
fn effort() -> (u32, u32) {
    if std::env::args().any(|argument| argument == "--bench") { (200_000, 7) } else { (1000, 1) }
}

const STEP: f64 = 1e-3;

struct Decay;

impl System<[f64; 1]> for Decay {
    #[inline]
    fn rates(&mut self, _t: f64, x: &[f64; 1]) -> [f64; 1] {
        [-x[0]]
    }
    fn jacobian(&mut self, _t: f64, _x: &[f64; 1]) -> (<[f64; 1] as Array>::Square, [f64; 1]) {
        ([[-1.0]].into(), [0.0])
    }
}

/// Wheel and body of a quarter car over a sinusoidal road, with friction in damper and top mount.
/// States: positions of wheel and body in m, their velocities in m/s.
struct QuarterCar;

impl QuarterCar {
    const WHEEL: f64 = 40.0;
    const BODY: f64 = 400.0;
    const SPRING: f64 = 25e3;
    const TYRE: f64 = 220e3;
    const DAMPING: f64 = 1500.0;
    const FRICTION: f64 = 50.0;
    const SLOPE: f64 = 125.0;
}

impl System<[f64; 4]> for QuarterCar {
    #[inline]
    fn rates(&mut self, t: f64, x: &[f64; 4]) -> [f64; 4] {
        let [wheel, body, wheel_speed, body_speed] = *x;
        let road = 0.01 * (10.0 * t).sin();
        let speed = body_speed - wheel_speed;
        let strut = Self::SPRING * (body - wheel)
            + Self::DAMPING * speed
            + Self::FRICTION * (Self::SLOPE * speed).tanh();
        let mount = Self::FRICTION * (Self::SLOPE * body_speed).tanh();
        let tyre = Self::TYRE * (wheel - road);
        [wheel_speed, body_speed, (strut - tyre) / Self::WHEEL, -(strut + mount) / Self::BODY]
    }

    fn jacobian(&mut self, t: f64, x: &[f64; 4]) -> (<[f64; 4] as Array>::Square, [f64; 4]) {
        let [_, _, wheel_speed, body_speed] = *x;
        let stiffness = |speed: f64| {
            let tanh = (Self::SLOPE * speed).tanh();
            Self::FRICTION * Self::SLOPE * (1.0 - tanh * tanh)
        };
        let d = Self::DAMPING + stiffness(body_speed - wheel_speed);
        let mount = stiffness(body_speed);
        let (w, b, k) = (Self::WHEEL, Self::BODY, Self::SPRING);
        let rows = [
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [-(k + Self::TYRE) / w, k / w, -d / w, d / w],
            [k / b, -k / b, d / b, -(d + mount) / b],
        ];
        let mut jacobian = <[f64; 4] as Array>::Square::zeros();
        for (row, values) in rows.iter().enumerate() {
            for (column, value) in values.iter().enumerate() {
                jacobian[(row, column)] = *value;
            }
        }
        (jacobian, [0.0, 0.0, Self::TYRE / w * 0.1 * (10.0 * t).cos(), 0.0])
    }
}

/// The classical method, four evaluations a step.
#[inline]
fn runge_kutta_4<const N: usize>(system: &mut impl System<[f64; N]>, t: f64, h: f64, x: &mut [f64; N]) {
    let along = |x: &[f64; N], h: f64, k: &[f64; N]| std::array::from_fn(|i| x[i] + h * k[i]);
    let k1 = system.rates(t, x);
    let k2 = system.rates(t + 0.5 * h, &along(x, 0.5 * h, &k1));
    let k3 = system.rates(t + 0.5 * h, &along(x, 0.5 * h, &k2));
    let k4 = system.rates(t + h, &along(x, h, &k3));
    for i in 0..N {
        x[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
    }
}

/// The shortest time per call, in ns, over several runs of many calls from the same start.
fn nanoseconds<const N: usize>(start: [f64; N], mut call: impl FnMut(f64, &mut [f64; N])) -> f64 {
    let (calls, runs) = effort();
    (0..runs)
        .map(|_| {
            let mut x = start;
            let begin = Instant::now();
            for i in 0..calls {
                call(f64::from(black_box(i)) * STEP, &mut x);
            }
            let elapsed = begin.elapsed();
            black_box(x);
            elapsed.as_secs_f64() / f64::from(calls) * 1e9
        })
        .fold(f64::INFINITY, f64::min)
}

fn measure<const N: usize, S: System<[f64; N]>>(name: &str, mut system: S, start: [f64; N])
where
    [f64; N]: Array,
{
    let fixed = nanoseconds(start, |t, x| runge_kutta_4(&mut system, t, STEP, x));
    println!("{name}: Runge-Kutta 4 without control {fixed:.1} ns");
    for method in Method::ALL {
        let settings = Settings::new(1e-6, &[0.1; N]);
        let mut integrator = Integrator::new(method, settings).expect("usable settings");
        let time = nanoseconds(start, |t, x| {
            if t == 0.0 {
                integrator.reset();
            }
            integrator.advance(&mut system, t, t + STEP, x).expect("a harmless system");
        });
        let work = integrator.work();
        let per_call = |count: u64| count as f64 / f64::from(effort().0);
        println!(
            "  {method:?}: {time:.1} ns, {:.2} times as long; per call {:.3} rates, {:.3} steps, \
             {:.4} rejected",
            time / fixed,
            per_call(work.rates),
            per_call(work.accepted),
            per_call(work.rejected),
        );
    }
}

fn main() {
    measure("scalar decay", Decay, [1.0]);
    measure("quarter car with two frictions", QuarterCar, [0.0; 4]);
}
