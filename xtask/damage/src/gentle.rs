//! Damage that a reader may not notice: numbers are replaced by others, which the commands then have to cope with.

use rand::seq::IndexedRandom as _;
use rand::{Rng, RngExt as _};

/// The replacements for numbers in a text.
const NUMBERS: [&str; 12] = ["0", "1", "-1", "0.5", "90", "180", "360", "1e-30", "1e30", "3.4e38", "-0.001", "1000000"];
/// The replacements for floats in a binary file.
const FLOATS: [f32; 10] = [0.0, 1.0, -1.0, 0.5, 1e-30, 1e30, f32::MAX, f32::NAN, f32::INFINITY, -1e-3];

/// Returns `file` with one to four numbers replaced.
pub fn mutant(random: &mut impl Rng, file: &[u8]) -> Vec<u8> {
    let mut bytes = file.to_vec();
    for _ in 0..random.random_range(1..5) {
        match std::str::from_utf8(&bytes) {
            Ok(_) => number(random, &mut bytes),
            Err(_) => float(random, &mut bytes),
        }
    }
    bytes
}

/// Replaces a complete number in a text, or one of its digits.
fn number(random: &mut impl Rng, bytes: &mut Vec<u8>) {
    let from = random.random_range(0..=bytes.len());
    let Some(at) = bytes[from..].iter().position(u8::is_ascii_digit).map(|at| from + at) else { return };
    if random.random_bool(0.4) {
        bytes[at] = b'0' + random.random_range(0..10);
        return;
    }
    let is_part = |byte: &u8| byte.is_ascii_digit() || b"+-.eE".contains(byte);
    let start = bytes[..at].iter().rposition(|byte| !is_part(byte)).map_or(0, |before| before + 1);
    let end = bytes[at..].iter().position(|byte| !is_part(byte)).map_or(bytes.len(), |end| at + end);
    // Part of a word, such as a name.
    if start > 0 && bytes[start - 1].is_ascii_alphabetic() {
        return;
    }
    let number = NUMBERS.choose(random).expect("a number");
    bytes.splice(start..end, number.bytes());
}

/// Overwrites a float, mostly one after the header.
fn float(random: &mut impl Rng, bytes: &mut [u8]) {
    let Some(last) = (bytes.len() / 4).checked_sub(1) else { return };
    let first = if random.random_bool(0.9) { last / 2 } else { 0 };
    // Values of most formats lie at multiples of four bytes from the end.
    let at = bytes.len() - 4 * (random.random_range(first..=last) - first + 1);
    let float = FLOATS.choose(random).expect("a float");
    bytes[at..at + 4].copy_from_slice(&float.to_le_bytes());
}
