//! How much tests do on an emulated processor.

/// A number of random draws: `count`, or a sixteenth of it on an emulated processor, which takes ten to thirty times as
/// long. `cargo xtask cross` sets the environment variable `LOBE_EMULATED` there. What is checked of each draw is the
/// same.
pub fn draws(count: usize) -> usize {
    if std::env::var_os("LOBE_EMULATED").is_some() { count.div_ceil(16) } else { count }
}
