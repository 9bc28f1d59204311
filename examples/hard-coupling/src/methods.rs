//! How a master can take coupled FMUs over a step. `methods.py` says what each does and where it comes from.

use nalgebra::{DMatrix, DVector};

use crate::Error;
use crate::coupled::Coupled;

/// When an iteration ends: the change of all inputs, by their scales; and when it is given up.
const TOLERANCE: f64 = 1e-5;
const ITERATIONS: usize = 50;
/// Intervals of Simpson's rule for the integrals of a fit.
const INTERVALS: usize = 16;

/// A method; orders are those of the components' indices.
pub enum Method {
    /// Inputs are held at what the outputs are.
    Constant,
    /// Inputs go on with the slopes of the outputs.
    Extrapolated,
    /// One after the other.
    GaussSeidel(Vec<usize>),
    /// Steps are repeated until inputs end where the outputs do.
    FixedPoint(Relaxation, Vec<usize>),
    /// The same with interface Jacobians.
    Newton,
    /// Inputs fit the course of the linearised system: polynomials of this order, 0 or 2.
    Foreseen(usize),
}

/// How guesses are made from guesses and answers.
pub enum Relaxation {
    /// A factor that follows from the last two residuals.
    Aitken {
        /// The present factor.
        factor: f64,
    },
    /// The mixture of the last answers whose residual is least.
    Anderson,
}

impl Method {
    /// Takes the system over a step.
    pub fn step(&mut self, system: &mut Coupled, time: f64, size: f64) -> Result<(), Error> {
        match self {
            Self::Constant => {
                let y = system.read()?;
                system.steer(time, &[y])?;
                system.advance(time, size, true)
            }
            Self::Extrapolated => {
                let path = start(system, time)?;
                system.steer(time, &path)?;
                system.advance(time, size, true)
            }
            Self::GaussSeidel(order) => {
                let mut y = [system.read()?];
                for index in order {
                    system.parts[*index].steer(time, &y)?;
                    system.advance_one(*index, time, size, true)?;
                    system.parts[*index].read(&mut y[0])?;
                }
                Ok(())
            }
            Self::FixedPoint(relaxation, order) => fixed_point(relaxation, order, system, time, size),
            Self::Newton => newton(system, time, size),
            Self::Foreseen(order) => foreseen(*order, system, time, size),
        }
    }
}

/// Outputs and their slopes, which depend on the inputs: these come first.
fn start(system: &mut Coupled, time: f64) -> Result<[DVector<f64>; 2], Error> {
    let y = system.read()?;
    system.steer(time, std::slice::from_ref(&y))?;
    let slopes = system.slopes()?;
    Ok([y, slopes])
}

/// The paths from `y` to `end`, arriving there with `slope`.
fn parabola(y: &DVector<f64>, end: &DVector<f64>, slope: &DVector<f64>, size: f64) -> [DVector<f64>; 3] {
    let curvature = (y - end + slope * size) * (2.0 / (size * size));
    [y.clone(), slope - &curvature * size, curvature]
}

fn fixed_point(
    relaxation: &mut Relaxation,
    order: &[usize],
    system: &mut Coupled,
    time: f64,
    size: f64,
) -> Result<(), Error> {
    let [y, mut slope] = start(system, time)?;
    // The connections that lead back.
    let place = |index: &usize| order.iter().position(|other| other == index);
    let fed = |of: fn(&crate::coupled::Part) -> &Vec<usize>, j: usize| {
        system.parts.iter().position(|part| of(part).contains(&j)).and_then(|index| place(&index))
    };
    let back: Vec<usize> =
        (0..system.width()).filter(|j| fed(|part| &part.made, *j) >= fed(|part| &part.taken, *j)).collect();
    let mut end = &y + &slope * size;
    system.save()?;
    let n = back.len();
    let scale = DVector::from_fn(2 * n, |i, _| system.scales[back[i % n]] / if i < n { 1.0 } else { size });
    let gather = |end: &DVector<f64>, slope: &DVector<f64>| {
        DVector::from_fn(2 * n, |i, _| if i < n { end[back[i]] } else { slope[back[i - n]] })
            .component_div(&scale)
    };
    let mut guess = gather(&end, &slope);
    let (mut guesses, mut answers) = (vec![], vec![]);
    for _ in 0..ITERATIONS {
        for (i, j) in back.iter().enumerate() {
            (end[*j], slope[*j]) = (guess[i] * scale[i], guess[n + i] * scale[n + i]);
        }
        for index in order {
            system.parts[*index].steer(time, &parabola(&y, &end, &slope, size))?;
            system.advance_one(*index, time, size, false)?;
            system.parts[*index].read(&mut end)?;
            system.parts[*index].slopes(&mut slope)?;
        }
        let answer = gather(&end, &slope);
        if (&answer - &guess).amax() < TOLERANCE {
            return Ok(());
        }
        guesses.push(guess);
        answers.push(answer);
        guess = relaxation.next(&guesses, &answers)?;
        system.rewind()?;
    }
    Err(Error::NotConverged { time })
}

impl Relaxation {
    /// The next guess.
    fn next(&mut self, guesses: &[DVector<f64>], answers: &[DVector<f64>]) -> Result<DVector<f64>, Error> {
        let residual = |i: usize| &answers[i] - &guesses[i];
        let last = guesses.len() - 1;
        match self {
            Self::Aitken { factor } => {
                if last == 0 {
                    *factor = 0.5;
                } else {
                    let (before, change) = (residual(last - 1), residual(last) - residual(last - 1));
                    *factor *= -before.dot(&change) / change.dot(&change);
                }
                Ok(&guesses[last] + residual(last) * *factor)
            }
            Self::Anderson => {
                let oldest = last.saturating_sub(5);
                let n = answers[last].len();
                let changes = DMatrix::from_fn(n, last - oldest, |i, j| {
                    residual(oldest + j + 1)[i] - residual(oldest + j)[i]
                });
                let of_answers = DMatrix::from_fn(n, last - oldest, |i, j| {
                    answers[oldest + j + 1][i] - answers[oldest + j][i]
                });
                if last == oldest {
                    return Ok(answers[last].clone());
                }
                let svd = changes.svd(true, true);
                let least = f64::EPSILON * n.max(last - oldest) as f64 * svd.singular_values.max();
                let weights = svd
                    .solve(&residual(last), least)
                    .map_err(|what| Error::Fmi(format!("least squares: {what}")))?;
                Ok(&answers[last] - of_answers * weights)
            }
        }
    }
}

/// Solves equations that the components' derivatives make up.
fn solve(matrix: DMatrix<f64>, right: &DMatrix<f64>, time: f64) -> Result<DMatrix<f64>, Error> {
    matrix.lu().solve(right).ok_or(Error::NotConverged { time })
}

fn newton(system: &mut Coupled, time: f64, size: f64) -> Result<(), Error> {
    let y = system.read()?;
    system.steer(time, std::slice::from_ref(&y))?;
    let linear = system.linear(time)?;
    let (width, n) = (y.len(), linear.rates.len());
    // Columns: inputs that are 1, s and s²/2 in turn; the rates; the stimulus.
    let forces = width + 2;
    let mut chain = DMatrix::zeros(n + 3 * forces, n + 3 * forces);
    chain.view_mut((0, 0), (n, n)).copy_from(&linear.a);
    chain.view_mut((0, n), (n, width)).copy_from(&linear.b);
    chain.view_mut((0, n + width), (n, 1)).copy_from(&linear.rates);
    chain.view_mut((0, n + width + 1), (n, 1)).copy_from(&linear.moved);
    chain.view_mut((n, n + forces), (2 * forces, 2 * forces)).fill_with_identity();
    let grown = (chain * size).exp();
    let by =
        |power: usize, first: usize, count: usize| grown.view((0, n + power * forces + first), (n, count));
    let identity = DMatrix::<f64>::identity(width, width);
    let beside = |left: &DMatrix<f64>, right: &DMatrix<f64>| {
        let mut both = DMatrix::zeros(left.nrows(), left.ncols() + right.ncols());
        both.columns_mut(0, left.ncols()).copy_from(left);
        both.columns_mut(left.ncols(), right.ncols()).copy_from(right);
        both
    };
    // By the paths' first and second derivative, and what comes without them.
    let by_path = beside(&by(1, 0, width).into(), &by(2, 0, width).into());
    let free: DVector<f64> = by(0, width, 1).column(0) + by(1, width + 1, 1).column(0);
    let line = beside(&(&identity * size), &(&identity * (0.5 * size * size)));
    let incline = beside(&identity, &(&identity * size));
    let end_by_path = &linear.c * &by_path + &linear.d * &line;
    let slope_by_path = &linear.c * (&linear.a * &by_path + &linear.b * &line) + &linear.d * &incline;
    let stack = |top: DMatrix<f64>, bottom: DMatrix<f64>| {
        let mut both = DMatrix::zeros(2 * width, top.ncols());
        both.rows_mut(0, width).copy_from(&top);
        both.rows_mut(width, width).copy_from(&(bottom * size));
        both
    };
    let jacobian = stack(end_by_path - &line, slope_by_path - &incline);
    let end = &linear.c * &free + &linear.seen * size;
    let slope = &linear.c * (&linear.rates + &linear.a * &free + &linear.moved * size) + &linear.seen;
    let column = |vector: DVector<f64>| DMatrix::from_column_slice(width, 1, vector.as_slice());
    let mut moves = -solve(jacobian.clone(), &stack(column(end), column(slope)), time)?;
    system.save()?;
    for _ in 0..ITERATIONS {
        let path =
            [y.clone(), moves.rows(0, width).column(0).into(), moves.rows(width, width).column(0).into()];
        system.steer(time, &path)?;
        system.advance(time, size, false)?;
        let end = column(system.read()? - &y) - &line * &moves;
        let slope = column(system.slopes()?) - &incline * &moves;
        let residual = stack(end, slope);
        let missed = residual.iter().enumerate().map(|(i, value)| value.abs() / system.scales[i % width]);
        if missed.fold(0.0, f64::max) < TOLERANCE {
            return Ok(());
        }
        moves -= solve(jacobian.clone(), &residual, time)?;
        system.rewind()?;
    }
    Err(Error::NotConverged { time })
}

fn foreseen(order: usize, system: &mut Coupled, time: f64, size: f64) -> Result<(), Error> {
    let y = system.read()?;
    system.steer(time, std::slice::from_ref(&y))?;
    let linear = system.linear(time)?;
    let (width, n) = (y.len(), linear.rates.len());
    // Inputs are the outputs: u = c x + d u + seen s.
    let open = DMatrix::<f64>::identity(width, width) - &linear.d;
    let by_state = solve(open.clone(), &linear.c, time)?;
    let seen = DMatrix::from_column_slice(width, 1, linear.seen.as_slice());
    let by_time = solve(open, &seen, time)?;
    // x, 1 and s.
    let mut matrix = DMatrix::zeros(n + 2, n + 2);
    matrix.view_mut((0, 0), (n, n)).copy_from(&(&linear.a + &linear.b * &by_state));
    matrix.view_mut((0, n), (n, 1)).copy_from(&linear.rates);
    matrix.view_mut((0, n + 1), (n, 1)).copy_from(&(&linear.moved + (&linear.b * &by_time).column(0)));
    matrix[(n + 1, n)] = 1.0;
    let ahead = (matrix * (size / INTERVALS as f64)).exp();
    let mut state = DVector::zeros(n + 2);
    state[n] = 1.0;
    // Legendre's polynomials on the step, by Simpson's rule.
    let (mut mean, mut tilt, mut bend) =
        (DVector::zeros(width), DVector::zeros(width), DVector::zeros(width));
    for index in 1..=INTERVALS {
        state = &ahead * state;
        let course: DVector<f64> = &by_state * state.rows(0, n) + by_time.column(0) * state[n + 1];
        let share = index as f64 / INTERVALS as f64;
        let simpson = if index == INTERVALS { 1.0 } else { [2.0, 4.0][index % 2] };
        let weighted = course * (simpson / (3.0 * INTERVALS as f64));
        tilt += &weighted * (3.0 * (2.0 * share - 1.0));
        bend += &weighted * (5.0 * (6.0 * share * share - 6.0 * share + 1.0));
        mean += weighted;
    }
    let path = match order {
        0 => vec![y + mean],
        _ => vec![y + mean - &tilt + &bend, (tilt * 2.0 - &bend * 6.0) / size, bend * (12.0 / (size * size))],
    };
    system.steer(time, &path)?;
    system.advance(time, size, true)
}
