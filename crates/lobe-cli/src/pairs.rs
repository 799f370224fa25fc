//! Pairs of directions, from the command line or from a CSV file.

use std::fs::File;
use std::io::{BufRead, BufReader, Read, stdin};
use std::path::Path;

use crate::failure::Failure;

/// Unit vectors that point away from the surface, normal on +z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// To the light.
    pub wi: [f64; 3],
    /// To the viewer.
    pub wo: [f64; 3],
}

/// Parses `N` finite numbers with commas between them.
pub fn parse_numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let parts: Vec<&str> = text.split(',').collect();
    let parts: [&str; N] = parts
        .try_into()
        .map_err(|parts: Vec<&str>| format!("{} numbers; expected {N} with commas between", parts.len()))?;
    let mut numbers = [0.0; N];
    for (number, part) in numbers.iter_mut().zip(parts) {
        *number = parse_number(part)?;
    }
    Ok(numbers)
}

/// Parses a direction of any length but zero; the result has length 1.
pub fn parse_direction(text: &str) -> Result<[f64; 3], String> {
    normalise(parse_numbers(text)?)
}

fn parse_number(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.trim().parse().ok();
    number
        .filter(|number| number.is_finite())
        .ok_or_else(|| format!("found `{}`; expected a finite number", text.trim()))
}

fn normalise(v: [f64; 3]) -> Result<[f64; 3], String> {
    // Scaled by the largest component first, so that no square overflows or vanishes.
    let largest = v.iter().fold(0.0_f64, |largest, c| largest.max(c.abs()));
    if largest == 0.0 {
        return Err("found a direction of zero length; expected a non-zero vector".into());
    }
    let v = v.map(|c| c / largest);
    let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
    Ok(v.map(|c| c / length))
}

/// Reads six columns, wi then wo, with commas between, from a file, or from standard input if it is called `-`.
///
/// A first line without any number is a header; lines that start with `#` are comments.
pub fn read_pairs(path: &Path) -> Result<Vec<Pair>, Failure> {
    let unreadable = |error: &dyn std::fmt::Display| Failure::File(format!("{}: {error}", path.display()));
    let input: Box<dyn Read> = if path == Path::new("-") {
        Box::new(stdin().lock())
    } else {
        Box::new(File::open(path).map_err(|error| unreadable(&error))?)
    };
    let mut pairs = Vec::new();
    let mut first = true;
    for (index, line) in BufReader::new(input).lines().enumerate() {
        let line = line.map_err(|error| unreadable(&error))?;
        if line.trim().is_empty() || line.starts_with('#') {
            continue;
        }
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        let header = first && fields.iter().all(|field| field.parse::<f64>().is_err());
        first = false;
        if !header {
            let failed = |what| Failure::Usage(format!("{}:{}: {what}", path.display(), index + 1));
            pairs.push(parse_pair(&fields).map_err(failed)?);
        }
    }
    Ok(pairs)
}

fn parse_pair(fields: &[&str]) -> Result<Pair, String> {
    if fields.len() != 6 {
        return Err(format!("found {} columns; expected 6, wi and wo", fields.len()));
    }
    let mut numbers = [0.0; 6];
    for (number, field) in numbers.iter_mut().zip(fields) {
        *number = parse_number(field)?;
    }
    let [a, b, c, d, e, f] = numbers;
    Ok(Pair { wi: normalise([a, b, c])?, wo: normalise([d, e, f])? })
}
