//! Damage to files that every reader must survive.

use std::path::Path;

use rand::seq::IndexedRandom;
use rand::{Rng, RngExt};

/// Replacements for a number: text that is not a number, numbers that are too large, and counts without following
/// values.
const NUMBERS: [&str; 14] = [
    "NaN",
    "inf",
    "-1.#IND",
    "1e999",
    "1e39",
    "1e-320",
    "-0",
    "-1",
    "0",
    "1",
    "2.5",
    "4294967296",
    "99999999999999",
    "",
];
/// Bytes with a special meaning in some format.
const MARKS: [&[u8]; 12] = [b"{", b"}", b"[", b"\"", b",", b"#", b"&b;", b"<a>", b"</a>", b"\n", b"\0", b"\xff\xfe"];

/// `file` with one to four changes: to bits, numbers, lines, pieces of itself or of `other`, or its end.
pub fn mutant(random: &mut impl Rng, file: &[u8], other: &[u8]) -> Vec<u8> {
    let mut bytes = file.to_vec();
    for _ in 0..random.random_range(1..5) {
        match random.random_range(0..9) {
            0 => flip(random, &mut bytes),
            1 => overwrite(random, &mut bytes),
            2 | 3 => number(random, &mut bytes),
            4 => line(random, &mut bytes),
            5 => {
                let from = piece(random, other, 256);
                let to = piece(random, &bytes, 256);
                bytes.splice(to, other[from].iter().copied());
            }
            6 => {
                let from = piece(random, &bytes, 64);
                let copy = bytes[from].to_vec();
                let at = random.random_range(0..=bytes.len());
                bytes.splice(at..at, copy);
            }
            7 => {
                let (to, mark) = (piece(random, &bytes, 4), MARKS.choose(random).expect("a mark"));
                bytes.splice(to, mark.iter().copied());
            }
            _ => bytes.truncate(random.random_range(0..=bytes.len())),
        }
    }
    bytes
}

/// Reads every prefix of `bytes`. `read` returns `true` if it found a whole file, which it must not for a prefix of up
/// to half the length.
///
/// # Panics
/// If the whole file is not accepted, or such a short prefix is.
pub fn truncations(bytes: &[u8], read: impl Fn(&[u8]) -> bool) {
    assert!(read(bytes), "the whole file must be readable");
    for end in 0..bytes.len() {
        let complete = read(&bytes[..end]);
        assert!(!complete || end > bytes.len() / 2, "{end} of {} bytes are accepted as a whole file", bytes.len());
    }
}

/// Parses every prefix of a file. Each must give an error that names the file; prefixes of at least `sound` bytes may
/// also be accepted.
///
/// # Panics
/// If a prefix does neither.
pub fn truncate<T, E: std::fmt::Display>(
    name: &str,
    bytes: &[u8],
    sound: usize,
    parse: impl Fn(&Path, &[u8]) -> Result<T, E>,
) {
    if let Err(error) = parse(Path::new(name), bytes) {
        panic!("the whole file: {error}");
    }
    for length in 0..bytes.len() {
        match parse(Path::new(name), &bytes[..length]) {
            Ok(_) => assert!(length >= sound, "{length} bytes of {} are accepted", bytes.len()),
            Err(error) => assert!(error.to_string().starts_with(name), "{error}"),
        }
    }
}

/// Parses a file with every byte changed in turn to each of a few others; nothing may panic.
pub fn corrupt<T, E>(bytes: &[u8], parse: impl Fn(&Path, &[u8]) -> Result<T, E>) {
    let mut bytes = bytes.to_vec();
    for i in 0..bytes.len() {
        let kept = bytes[i];
        for other in [0, 0x20, 0x2d, 0x39, 0x7f, 0x80, 0xff] {
            bytes[i] = other;
            _ = parse(Path::new("corrupt"), &bytes);
        }
        bytes[i] = kept;
    }
}

/// A range of `bytes` that is not longer than `most`, and may be empty.
fn piece(random: &mut impl Rng, bytes: &[u8], most: usize) -> std::ops::Range<usize> {
    let start = random.random_range(0..=bytes.len());
    start..start + random.random_range(0..=most.min(bytes.len() - start))
}

fn flip(random: &mut impl Rng, bytes: &mut [u8]) {
    if let Some(last) = bytes.len().checked_sub(1) {
        bytes[random.random_range(0..=last)] ^= 1 << random.random_range(0..8);
    }
}

/// Overwrites bytes with an extreme integer or float, as binary files store them.
fn overwrite(random: &mut impl Rng, bytes: &mut [u8]) {
    let words: [&[u8]; 8] = [
        &u32::MAX.to_le_bytes(),
        &(1_u32 << 31).to_le_bytes(),
        &0_u64.to_le_bytes(),
        &1_u32.to_le_bytes(),
        &(1_u64 << 61).to_le_bytes(),
        &f32::NAN.to_le_bytes(),
        &f64::INFINITY.to_le_bytes(),
        &f32::MAX.to_le_bytes(),
    ];
    let word = words.choose(random).expect("a word");
    // Half of the changes are in the header, if the file has one.
    let end = if random.random() { bytes.len().min(256) } else { bytes.len() };
    if let Some(last) = end.checked_sub(word.len()) {
        let at = random.random_range(0..=last);
        bytes[at..at + word.len()].copy_from_slice(word);
    }
}

/// Replaces a number with another.
fn number(random: &mut impl Rng, bytes: &mut Vec<u8>) {
    let is_part = |byte: &u8| byte.is_ascii_digit() || b"+-.".contains(byte);
    let from = random.random_range(0..=bytes.len());
    let Some(start) = bytes[from..].iter().position(is_part).map(|at| from + at) else { return };
    let start = bytes[..start].iter().rposition(|byte| !is_part(byte)).map_or(0, |before| before + 1);
    let end = bytes[start..].iter().position(|byte| !is_part(byte)).map_or(bytes.len(), |at| start + at);
    let number = NUMBERS.choose(random).expect("a number");
    bytes.splice(start..end, number.bytes());
}

/// Doubles, removes or moves a line.
fn line(random: &mut impl Rng, bytes: &mut Vec<u8>) {
    let lines: Vec<&[u8]> = bytes.split_inclusive(|&byte| byte == b'\n').collect();
    let (Some(&chosen), Some(&other)) = (lines.choose(random), lines.choose(random)) else { return };
    let start = chosen.as_ptr() as usize - bytes.as_ptr() as usize;
    let at = other.as_ptr() as usize - bytes.as_ptr() as usize;
    let (end, copy) = (start + chosen.len(), chosen.to_vec());
    match random.random_range(0..3) {
        0 => drop(bytes.splice(start..start, copy)),
        1 => drop(bytes.drain(start..end)),
        _ => drop(bytes.splice(at..at, copy)),
    }
}
