//! What a difference between a measured and a modelled value counts.

/// The weights of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weights {
    /// Differences of `f` times the root of both cosines: what an eye sees of a lit surface.
    Cosine,
    /// Differences of `f`.
    Value,
    /// Differences of the logarithm of `f`: dim directions count like bright ones. Noise makes its mean a little low.
    Log,
    /// Differences of `f` relative to the model, which is what measurements with a relative error ask for.
    Relative,
}

impl Weights {
    /// All of them.
    pub const ALL: [Weights; 4] = [Weights::Cosine, Weights::Value, Weights::Log, Weights::Relative];

    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Weights::Cosine => "cosine",
            Weights::Value => "value",
            Weights::Log => "log",
            Weights::Relative => "relative",
        }
    }
}
