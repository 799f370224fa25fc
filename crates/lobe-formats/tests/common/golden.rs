//! Pairs of directions and what another implementation answered for them.

use std::path::Path;

/// One query and the answer of the other implementation.
pub struct Pair {
    /// The direction to the light.
    pub wi: [f64; 3],
    /// The direction to the viewer.
    pub wo: [f64; 3],
    /// The value of each channel.
    pub values: Vec<f64>,
}

/// Reads lines `wi.x wi.y wi.z wo.x wo.y wo.z -> value...`; lines that start with `#` are comments.
pub fn pairs(path: &Path) -> Vec<Pair> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let numbers = |text: &str| -> Vec<f64> { text.split_whitespace().map(|word| word.parse().unwrap()).collect() };
    text.lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let (query, answer) = line.split_once("->").unwrap();
            let query = numbers(query);
            Pair { wi: query[..3].try_into().unwrap(), wo: query[3..].try_into().unwrap(), values: numbers(answer) }
        })
        .collect()
}
