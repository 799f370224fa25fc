//! NIST's expansions in Zernike polynomials: the coefficient files of SCATMECH's `ZernikeExpansion_BRDF_Model`, which
//! T. A. Germer published for sintered PTFE.
//!
//! Lines of eight numbers separated by commas or blanks: row and column of the Mueller matrix, from 1; the radial
//! orders n and m; the azimuthal orders k and l; the power of the wavelength in micrometres; the coefficient. Only row
//! and column 1, the unpolarised BRDF, are read; for them, k equals l.

use std::path::Path;

use lobe_table::Channels;
use lobe_table::zernike::{Data, Term};

use crate::lines::{Line, lines, shown};
use crate::spec::FormatSpec;
use crate::{Document, FormatError, Place};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "NIST Zernike coefficients",
    word: "zernike",
    extensions: &["csv"],
    matches,
    read: Some(|bytes, path, _| read(bytes, path)),
    read_set: None,
    writer: None,
};

/// The wavelengths of NIST's measurements, in nm: files say that terms depend on the wavelength, but not where they are
/// valid.
const WAVELENGTHS: [f64; 4] = [351.0, 532.0, 633.0, 1064.0];

/// The number of lines that are examined to recognise a file.
const HEAD: usize = 4;

/// `true` if the first lines are seven whole numbers, the first two of which index a matrix, and a coefficient.
pub fn matches(bytes: &[u8]) -> bool {
    let head = std::str::from_utf8(&bytes[..bytes.len().min(1 << 10)]).unwrap_or_default();
    let is_row = |line: &Line<'_>| {
        let words: Vec<&str> = line.words().collect();
        let [indices @ .., coefficient] = words.as_slice() else { return false };
        let numbers: Option<Vec<i32>> = indices.iter().map(|word| word.parse().ok()).collect();
        let is_element = |index: &i32| (1..=4).contains(index);
        coefficient.parse::<f64>().is_ok()
            && numbers.is_some_and(|numbers| numbers.len() == 7 && numbers[..2].iter().all(is_element))
    };
    let first: Vec<Line<'_>> = lines(Path::new(""), head).take(HEAD).collect();
    first.len() == HEAD && first.iter().all(is_row)
}

/// Reads the terms of the unpolarised BRDF. `file` is only its name in errors.
///
/// # Errors
/// [`FormatError`] with the line that is not eight numbers, or has orders that do not fit together; and if no line
/// belongs to the unpolarised BRDF.
pub fn read(bytes: &[u8], file: &Path) -> Result<Document, FormatError> {
    let text = String::from_utf8_lossy(bytes);
    let (mut terms, mut polarised) = (Vec::new(), 0);
    for line in lines(file, &text) {
        let words: Vec<&str> = line.words().collect();
        let [i, j, n, m, k, l, power, coefficient] = words[..] else {
            return Err(line.error(format!("{} fields", words.len()), "seven whole numbers and a coefficient"));
        };
        let whole = |word: &str| {
            word.parse::<i32>()
                .map_err(|_| line.error(shown(word), "a whole number, such as the order of a polynomial"))
        };
        let element = [whole(i)?, whole(j)?];
        if !element.iter().all(|index| (1..=4).contains(index)) {
            return Err(line.error(format!("element {i}, {j}"), "the row and column of a Mueller matrix, from 1 to 4"));
        }
        let [n, m, k, l, power] = [whole(n)?, whole(m)?, whole(k)?, whole(l)?, whole(power)?];
        let coefficient = line.number(coefficient)?;
        if element != [1, 1] {
            polarised += 1;
            continue;
        }
        let small = |order: i32| u8::try_from(order).ok();
        let term = match (small(n), small(m), small(k), small(l), small(power)) {
            (Some(n), Some(m), Some(k), Some(l), Some(power)) if k == l => {
                Term { radial: [n, m], azimuthal: l, power, coefficient }
            }
            _ => {
                let found = format!("n {n}, m {m}, k {k}, l {l} and power {power}");
                return Err(line.error(found, "small orders, of which k is l for the unpolarised BRDF"));
            }
        };
        // An error in a term names its line.
        Data::new(vec![Term { power: 0, ..term }], Channels::Mono)
            .map_err(|error| line.error(error.found, error.expected))?;
        terms.push(term);
    }
    let depends = terms.iter().any(|term| term.power > 0);
    let channels = if depends { Channels::Spectral(WAVELENGTHS.to_vec()) } else { Channels::Mono };
    let data = Data::new(terms, channels).map_err(|error| {
        FormatError::new(file, Place::File, format!("{}: {}", error.part, error.found), error.expected)
    })?;
    let mut document = Document::new(data);
    if depends {
        document.notes.push("evaluated at 351, 532, 633 and 1064 nm, where the material was measured".into());
    }
    if polarised > 0 {
        document.notes.push(format!("{polarised} coefficients of polarised light are not read"));
    }
    Ok(document)
}
