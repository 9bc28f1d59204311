//! The search as a grey-box fit with the Bayesian information criterion does it, to compare with: whatever lowers the
//! criterion on the training data most is added, until nothing does.

use std::slice::from_ref;

use crate::estimation::fit::Residuals;
use crate::estimation::hypothesis::{Fitted, World};
use crate::estimation::lsq::Stop;
use crate::report::findings::Evidence;

use super::{Accepted, Found, MOST, Tried, merge};

/// Fall of the criterion that counts as very strong (R. E. Kass and A. E. Raftery, Bayes factors, Journal of the American
/// Statistical Association 90, 1995).
const VERY_STRONG: f64 = 10.0;

impl World<'_> {
    /// Looks for causes by the criterion alone.
    ///
    /// # Errors
    /// If the model refuses its settings or diverges.
    pub(super) fn search_by_bic(
        &self,
        mut found: Found,
        progress: &(dyn Fn(&str) + Sync),
    ) -> Result<Found, String> {
        while found.accepted.len() < MOST {
            progress("comparing every cause to what is missing");
            let screened = self.beyond(&found)?;
            let mut promising = self.promising(&found.base, &screened);
            promising.extend(self.curves(&found.base, &screened, 0.0));
            progress(&format!("fitting {} causes", promising.len()));
            let tried = self.try_all(&found.base, &found.extended, &promising);
            let now = self.bic(&found.extended);
            let fall =
                |it: &Tried| it.fitted.as_ref().map_or(f64::NEG_INFINITY, |fitted| now - self.bic(fitted));
            let best = tried.iter().max_by(|a, b| fall(a).total_cmp(&fall(b))).cloned();
            let chosen = best.filter(|it| fall(it) > VERY_STRONG);
            merge(&mut found.tried, tried);
            let Some(Tried { term, fitted: Ok(fitted), evidence, .. }) = chosen else { break };
            let evidence = Evidence { delta_bic: now - self.bic(&fitted), ..evidence };
            found.accepted.push(Accepted { term, evidence, rivals: Vec::new() });
            found.extended = self.fitted(&fitted.terms, from_ref(&fitted.point), Stop::NOISY)?;
        }
        Ok(found)
    }

    /// The criterion, every sample counting as independent.
    fn bic(&self, fitted: &Fitted) -> f64 {
        let counts = counts(&fitted.train);
        let squares = self.errors(&fitted.train).mean_squares();
        let misfit: f64 = counts.iter().zip(&squares).map(|(n, square)| n * square.ln()).sum();
        misfit + fitted.coordinates.len() as f64 * counts.iter().sum::<f64>().max(1.0).ln()
    }
}

/// Number of known samples of each signal.
fn counts(residuals: &Residuals) -> Vec<f64> {
    let rows = residuals.first().map_or(0, Vec::len);
    let known = |row: usize| {
        residuals.iter().map(|record| record[row].iter().filter(|it| it.is_finite()).count()).sum::<usize>()
    };
    (0..rows).map(|row| known(row) as f64).collect()
}
