//! Components of the method that can be left out, to measure their contribution.

/// A component of the method. `tests/blind/ablation.md` has the benchmark's figures without each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Component {
    /// The missing signal at ports: without it, every effect is fitted in each round, and nothing is reported without a name.
    Ports,
    /// Free features: without them, only effects with a name are compared to the missing signal.
    Features,
    /// Confirmation: without it, the best fit is accepted whatever the other data say, and nothing is taken back.
    Confirmation,
    /// The account: without it, background effects need more evidence even where a signal misses by far more than its noise.
    Account,
    /// The tolerances of the parameter set as priors of the nominal parameters.
    Tolerances,
    /// The priors of background and expected effects: without them, both need as much evidence as others.
    Background,
}
