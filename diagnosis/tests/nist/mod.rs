//! The nonlinear regressions of the NIST Statistical Reference Datasets, with their certified results.
//!
//! The `.dat` files are NIST's own (a work of the United States government, in the public domain), see
//! <https://www.itl.nist.gov/div898/strd/nls/nls_main.shtml>.

mod models;

pub use models::model;

/// A data set.
#[derive(Clone, Debug)]
pub struct Set {
    /// What NIST calls it.
    pub name: String,
    /// `Lower`, `Average` or `Higher` level of difficulty.
    pub difficulty: String,
    /// Starting values far from the solution, and nearer ones.
    pub starts: [Vec<f64>; 2],
    /// The solution.
    pub certified: Vec<f64>,
    /// Standard deviations of the solution.
    pub standard_errors: Vec<f64>,
    /// Certified sum of squares.
    pub residual_sum_of_squares: f64,
    /// Values of the predictors, for each observation.
    pub x: Vec<Vec<f64>>,
    /// What was observed. Of `Nelson` it is the logarithm, which is what its model is for.
    pub y: Vec<f64>,
}

macro_rules! sets {
    ($($name:literal),* $(,)?) => {
        /// All sets.
        pub fn all() -> Vec<Set> {
            vec![$(Set::parse($name, include_str!(concat!($name, ".dat")))),*]
        }
    };
}

sets![
    "Misra1a", "Chwirut2", "Chwirut1", "Lanczos3", "Gauss1", "Gauss2", "DanWood", "Misra1b", "Kirby2",
    "Hahn1", "Nelson", "MGH17", "Lanczos1", "Lanczos2", "Gauss3", "Misra1c", "Misra1d", "Roszman1", "ENSO",
    "MGH09", "Thurber", "BoxBOD", "Rat42", "MGH10", "Eckerle4", "Rat43", "Bennett5",
];

impl Set {
    fn parse(name: &str, text: &str) -> Self {
        let lines: Vec<&str> = text.lines().collect();
        let numbers =
            |line: &str| -> Vec<f64> { line.split_whitespace().filter_map(|w| w.parse().ok()).collect() };
        let mut set = Self {
            name: name.into(),
            difficulty: String::new(),
            starts: [vec![], vec![]],
            certified: vec![],
            standard_errors: vec![],
            residual_sum_of_squares: f64::NAN,
            x: vec![],
            y: vec![],
        };
        for line in &lines {
            let trimmed = line.trim();
            if let Some(level) = trimmed.strip_suffix(" Level of Difficulty") {
                set.difficulty = level.into();
            } else if let Some(value) = trimmed.strip_prefix("Residual Sum of Squares:") {
                set.residual_sum_of_squares = value.trim().parse().expect("a number");
            } else if let Some((left, right)) = trimmed.split_once('=')
                && left.trim().strip_prefix('b').is_some_and(|digits| digits.parse::<usize>().is_ok())
            {
                let [far, near, certified, error] = numbers(right)[..] else {
                    panic!("{name}: four numbers in `{line}`")
                };
                set.starts[0].push(far);
                set.starts[1].push(near);
                set.certified.push(certified);
                set.standard_errors.push(error);
            }
        }
        // The observations follow the last line that names their columns.
        let head = lines.iter().rposition(|line| line.starts_with("Data:")).expect("a head of the data");
        for row in lines[head + 1..].iter().map(|line| numbers(line)).filter(|row| !row.is_empty()) {
            set.y.push(if name == "Nelson" { row[0].ln() } else { row[0] });
            set.x.push(row[1..].to_vec());
        }
        set
    }
}
