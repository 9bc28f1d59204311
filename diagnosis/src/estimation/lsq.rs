//! Bounded nonlinear least squares: Levenberg–Marquardt with Moré's scaling.
//!
//! A problem linearises itself to a triangular system, however it has its residuals: by a QR factorisation where they
//! are few, by accumulated normal equations where they are many. J. J. Moré, The Levenberg–Marquardt algorithm:
//! implementation and theory, Numerical Analysis, LNM 630 (1978).

mod linear;
mod stop;

use nalgebra::DVector;

pub use linear::Linear;
pub use stop::Stop;

/// A least-squares problem about points of its own.
pub trait Problem {
    /// A point, which may hold more than the coordinates.
    type Estimate: Clone;
    /// What linearising leaves behind.
    type Trace;
    /// Half the sum of squares; not finite where it cannot be told.
    fn cost(&self, point: &Self::Estimate) -> f64;
    /// Whether the coordinates of a point go together, beyond the bounds of each.
    fn is_possible(&self, _: &Self::Estimate) -> bool {
        true
    }
    /// The linearisation in the coordinates.
    fn linearise(&self, point: &Self::Estimate) -> (Linear, Self::Trace);
    /// The coordinates of a point.
    fn coordinates(&self, point: &Self::Estimate) -> DVector<f64>;
    /// The point with these coordinates, a step from one that was linearised.
    fn moved(
        &self,
        point: &Self::Estimate,
        trace: &Self::Trace,
        coordinates: &DVector<f64>,
    ) -> Self::Estimate;
    /// Changes what linearising left behind so that it leads no way uphill on its own; asked for once a step was not downhill.
    fn hold_back(&self, _: &Self::Estimate, _: &mut Self::Trace) {}
    /// Bounds of each coordinate.
    fn bounds(&self) -> &[(f64, f64)];
}

/// Linearisations from which on a minimum that is not in sight is given up.
const SOON: usize = 4;
/// Linearisations after which only the lowest of several ways goes on: by then they have left what is wrong about their starts.
const RACE: usize = 2;
/// Damping with which it is looked for: next to none, but for coordinates that the residuals do not depend on.
const FREELY: f64 = 1e-9;

/// How often the way to where a coordinate cannot be is halved, before it stays.
const HALVINGS: usize = 6;

/// A minimum.
#[derive(Clone, Debug)]
pub struct Minimum<P, T> {
    /// Where.
    pub point: P,
    /// Half the sum of squares.
    pub cost: f64,
    /// The linearisation there.
    pub linear: Linear,
    /// What linearising left behind.
    pub trace: T,
    /// Linearisations that it took.
    pub iterations: usize,
}

/// A way downhill, as far as it has gone.
struct Descent<'p, P: Problem> {
    problem: &'p P,
    at: Minimum<P::Estimate, P::Trace>,
    scale: DVector<f64>,
    lambda: f64,
    has_ended: bool,
}

/// Goes downhill from a point to a minimum within the bounds.
pub fn minimise<P: Problem>(problem: &P, start: P::Estimate, stop: Stop) -> Minimum<P::Estimate, P::Trace> {
    let mut descent = Descent::new(problem, start, stop);
    descent.go_on(stop);
    descent.at
}

/// Goes downhill from several points for some steps, and from the lowest by then to a minimum; none from no point.
pub fn minimise_from<P: Problem>(
    problem: &P,
    starts: impl Iterator<Item = P::Estimate>,
    stop: Stop,
) -> Option<Minimum<P::Estimate, P::Trace>> {
    let mut all: Vec<Descent<'_, P>> = starts.map(|start| Descent::new(problem, start, stop)).collect();
    if all.len() > 1 {
        let race = Stop { iterations: stop.iterations.min(RACE), ..stop };
        all.iter_mut().for_each(|it| it.go_on(race));
    }
    let mut lowest = all.into_iter().min_by(|a, b| a.at.cost.total_cmp(&b.at.cost))?;
    lowest.go_on(stop);
    Some(lowest.at)
}

impl<'p, P: Problem> Descent<'p, P> {
    fn new(problem: &'p P, point: P::Estimate, stop: Stop) -> Self {
        let cost = problem.cost(&point);
        let (linear, trace) = problem.linearise(&point);
        let scale = unit_where_zero(&linear.column_norms());
        let at = Minimum { point, cost, linear, trace, iterations: 1 };
        Self { problem, at, scale, lambda: stop.damping, has_ended: false }
    }

    /// Goes on to the minimum, or as far as it may.
    fn go_on(&mut self, stop: Stop) {
        let Self { problem, at, scale, lambda, has_ended } = self;
        let mut free = vec![true; problem.bounds().len()];
        let mut is_held_back = false;
        while !*has_ended && at.iterations < stop.iterations {
            let here = problem.coordinates(&at.point);
            let candidate = clamped_step(&at.linear, *lambda, scale, &here, problem.bounds(), &free);
            // Not in shares of the coordinates themselves: one that is held as if it were measured exactly would make all steps small.
            if candidate.component_mul(scale).norm() <= stop.step * (2.0 * at.cost).sqrt() {
                *has_ended = true;
                break;
            }
            let moved = |step: &DVector<f64>| problem.moved(&at.point, &at.trace, &(&here + step));
            let possible = |step: &DVector<f64>| problem.is_possible(&moved(step));
            let (candidate, stuck) = within_reach(candidate, possible);
            if !stuck.is_empty() {
                stuck.into_iter().for_each(|index| free[index] = false);
                continue;
            }
            let trial = moved(&candidate);
            let expected = at.linear.fall(&candidate);
            let cost = problem.cost(&trial);
            let fall = at.cost - cost;
            if !(cost.is_finite() && fall > 0.0) {
                *lambda = (*lambda * 4.0).max(1e-12);
                *has_ended = *lambda > 1e14;
                if !is_held_back {
                    problem.hold_back(&at.point, &mut at.trace);
                    is_held_back = true;
                }
                continue;
            }
            let quality = fall / expected.max(f64::MIN_POSITIVE);
            // Nielsen's update: as well predicted as it was, as bold is the next step.
            *lambda *= (1.0 - (2.0 * quality - 1.0).powi(3)).clamp(1.0 / 9.0, 2.0);
            *lambda = lambda.max(1e-16);
            free.fill(true);
            is_held_back = false;
            let is_small = fall <= stop.cost * at.cost;
            let (linear, trace) = problem.linearise(&trial);
            *at = Minimum { point: trial, cost, linear, trace, iterations: at.iterations + 1 };
            *scale = scale.zip_map(&at.linear.column_norms(), f64::max);
            let in_sight = || {
                let here = problem.coordinates(&at.point);
                let freely = clamped_step(&at.linear, FREELY, scale, &here, problem.bounds(), &free);
                let as_now = (stop.iterations - at.iterations) as f64 * fall;
                at.cost - at.linear.fall(&freely).max(as_now) <= stop.below
            };
            *has_ended = is_small || stop.is_late() || at.iterations >= SOON && !in_sight();
        }
    }
}

/// A step, of which what alone would go where it cannot be goes a part of the way; next to the end, where it is to stay so that
/// the others take another step, it is told.
fn within_reach(
    mut step: DVector<f64>,
    possible: impl Fn(&DVector<f64>) -> bool,
) -> (DVector<f64>, Vec<usize>) {
    let alone = |index: usize| {
        DVector::from_fn(step.len(), |other, _| if other == index { step[index] } else { 0.0 })
    };
    if possible(&step) {
        return (step, Vec::new());
    }
    let stuck: Vec<usize> = (0..step.len()).filter(|index| !possible(&alone(*index))).collect();
    for _ in 0..HALVINGS {
        stuck.iter().for_each(|index| step[*index] *= 0.5);
        if !stuck.is_empty() && possible(&step) {
            return (step, Vec::new());
        }
    }
    (step, stuck)
}

fn unit_where_zero(norms: &DVector<f64>) -> DVector<f64> {
    norms.map(|norm| if norm > 0.0 { norm } else { 1.0 })
}

/// A step of what is free within the bounds: a coordinate that would leave them stops there, and the others take another step.
fn clamped_step(
    linear: &Linear,
    lambda: f64,
    scale: &DVector<f64>,
    at: &DVector<f64>,
    bounds: &[(f64, f64)],
    free: &[bool],
) -> DVector<f64> {
    let mut free = free.to_vec();
    loop {
        let step = linear.step(lambda, scale, &free);
        let leaving = (0..at.len()).find(|&i| {
            let (low, high) = bounds[i];
            free[i] && ((at[i] <= low && step[i] < 0.0) || (at[i] >= high && step[i] > 0.0))
        });
        match leaving {
            Some(index) => free[index] = false,
            None => {
                return DVector::from_fn(at.len(), |i, _| {
                    (at[i] + step[i]).clamp(bounds[i].0, bounds[i].1) - at[i]
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use std::time::Instant;

    /// Distances from a target, the first two of which must ascend: the third is reached all the same.
    struct Ascending([f64; 3]);

    impl Problem for Ascending {
        type Estimate = DVector<f64>;
        type Trace = ();

        fn is_possible(&self, point: &DVector<f64>) -> bool {
            point[0] < point[1]
        }

        fn cost(&self, point: &DVector<f64>) -> f64 {
            let distance = point - DVector::from_row_slice(&self.0);
            if self.is_possible(point) { 0.5 * distance.norm_squared() } else { f64::INFINITY }
        }

        fn linearise(&self, point: &DVector<f64>) -> (Linear, ()) {
            let gradient = point - DVector::from_row_slice(&self.0);
            (Linear::by_cholesky(&DMatrix::identity(3, 3), &gradient), ())
        }

        fn coordinates(&self, point: &DVector<f64>) -> DVector<f64> {
            point.clone()
        }

        fn moved(&self, _: &DVector<f64>, (): &(), coordinates: &DVector<f64>) -> DVector<f64> {
            coordinates.clone()
        }

        fn bounds(&self) -> &[(f64, f64)] {
            &[(-10.0, 10.0); 3]
        }
    }

    /// A sum of squares whose minimum takes many steps.
    #[test]
    fn time_that_is_up_leaves_one_step() {
        let start = || DVector::from_row_slice(&[0.0, 1.0, 0.0]);
        let careful = Stop { damping: 100.0, ..Stop::NOISY };
        let problem = Ascending([-1.0, 2.0, 3.0]);
        let late = minimise(&problem, start(), Stop { until: Some(Instant::now()), ..careful });
        let whole = minimise(&problem, start(), careful);
        assert_eq!(late.iterations, 2);
        assert!(whole.iterations > 2 && whole.cost < late.cost && late.cost < problem.cost(&start()));
    }

    #[test]
    fn the_lowest_of_several_ways_goes_on_to_the_minimum() {
        let problem = Ascending([-1.0, 2.0, 3.0]);
        let starts = [[-900.0, 5.0, 8.0], [0.0, 1.0, 0.0], [-1.0, 90.0, 3.0]];
        let careful = Stop { damping: 100.0, ..Stop::EXACT };
        let starts = || starts.iter().map(|it| DVector::from_row_slice(it));
        let found = minimise_from(&problem, starts(), careful).unwrap();
        assert!((found.point - DVector::from_row_slice(&problem.0)).norm() < 1e-9);
        assert!(minimise_from(&problem, starts().take(0), careful).is_none());
        // Together with the steps of the race, no way is longer than that of the lowest alone.
        let alone = starts().nth(1).map(|it| minimise(&problem, it, careful).iterations);
        assert_eq!(Some(found.iterations), alone);
    }

    /// An exponential that is to be three, beside a coordinate that is held where it is.
    struct Held;

    impl Problem for Held {
        type Estimate = DVector<f64>;
        type Trace = ();

        fn cost(&self, point: &DVector<f64>) -> f64 {
            0.5 * ((point[0].exp() - 3.0).powi(2) + (1e6 * (point[1] - 1.0)).powi(2) + 1.0)
        }

        fn linearise(&self, point: &DVector<f64>) -> (Linear, ()) {
            let [slope, held] = [point[0].exp(), 1e6_f64];
            let h = DMatrix::from_diagonal(&DVector::from_row_slice(&[slope * slope, held * held]));
            let g = [slope * (slope - 3.0), held * held * (point[1] - 1.0)];
            (Linear::by_cholesky(&h, &DVector::from_row_slice(&g)), ())
        }

        fn coordinates(&self, point: &DVector<f64>) -> DVector<f64> {
            point.clone()
        }

        fn moved(&self, _: &DVector<f64>, (): &(), coordinates: &DVector<f64>) -> DVector<f64> {
            coordinates.clone()
        }

        fn bounds(&self) -> &[(f64, f64)] {
            &[(-10.0, 10.0), (0.0, 2.0)]
        }
    }

    #[test]
    fn a_coordinate_that_is_held_ends_no_other_s_way() {
        let found = minimise(&Held, DVector::from_row_slice(&[3.0, 1.0]), Stop::ROUGH);
        assert!((found.point[0] - 3.0_f64.ln()).abs() < 1e-3, "{}", found.point);
    }

    /// A distance from one, beside something hidden whose own way, as it is linearised, leads uphill.
    struct Misled;

    impl Problem for Misled {
        type Estimate = [f64; 2];
        type Trace = f64;

        fn cost(&self, [x, hidden]: &[f64; 2]) -> f64 {
            0.5 * (x - 1.0).powi(2) + 100.0 * hidden.abs()
        }

        fn linearise(&self, [x, _]: &[f64; 2]) -> (Linear, f64) {
            (Linear::by_cholesky(&DMatrix::identity(1, 1), &DVector::from_element(1, x - 1.0)), 5.0)
        }

        fn coordinates(&self, [x, _]: &[f64; 2]) -> DVector<f64> {
            DVector::from_element(1, *x)
        }

        fn moved(&self, [_, hidden]: &[f64; 2], own: &f64, x: &DVector<f64>) -> [f64; 2] {
            [x[0], hidden + own]
        }

        fn hold_back(&self, _: &[f64; 2], own: &mut f64) {
            *own = 0.0;
        }

        fn bounds(&self) -> &[(f64, f64)] {
            &[(-10.0, 10.0)]
        }
    }

    #[test]
    fn what_leads_uphill_on_its_own_does_not_keep_the_coordinates_where_they_are() {
        let found = minimise(&Misled, [-3.0, 0.0], Stop::EXACT);
        assert!((found.point[0] - 1.0).abs() < 1e-6 && found.point[1] == 0.0, "{:?}", found.point);
    }

    #[test]
    fn what_cannot_go_together_holds_nothing_else_up() {
        let start = || DVector::from_row_slice(&[0.0, 1.0, 0.0]);
        let found = |target: [f64; 3]| minimise(&Ascending(target), start(), Stop::EXACT).point;
        let free = found([-1.0, 2.0, 3.0]);
        assert!((free - DVector::from_row_slice(&[-1.0, 2.0, 3.0])).norm() < 1e-9);
        let stuck = found([3.0, 0.9, 5.0]);
        assert!(stuck[0] < stuck[1] && stuck[1] - stuck[0] < 0.1, "{stuck}");
        assert!((stuck[2] - 5.0).abs() < 1e-6, "{stuck}");
    }
}
