//! Formats figures.

/// A ratio with a suitable number of digits.
pub fn times(ratio: f64) -> String {
    if ratio >= 100.0 {
        format!("{ratio:.0}×")
    } else if ratio >= 10.0 {
        format!("{ratio:.1}×")
    } else {
        format!("{ratio:.2}×")
    }
}

/// Nanoseconds with three digits.
pub fn nanoseconds(ns: f64) -> String {
    let decimals = if ns >= 100.0 {
        0
    } else if ns >= 10.0 {
        1
    } else {
        2
    };
    format!("{ns:.decimals$}")
}
