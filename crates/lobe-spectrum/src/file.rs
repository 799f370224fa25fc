//! Spectra in text files: a wavelength in nm and a number on each line.

use std::path::Path;

use lobe_files::{FormatError, Place};

use crate::Spectrum;

impl Spectrum {
    /// Reads a spectrum: a wavelength in nm and a number on each line, separated by blanks, a comma, a semicolon or a
    /// tab. Empty lines, lines that begin with `#`, and a first line of names are ignored.
    ///
    /// # Errors
    /// [`FormatError`] names the file and the line.
    pub fn open(path: &Path) -> Result<Self, FormatError> {
        let bytes = lobe_files::read(path)?;
        Spectrum::parse(&String::from_utf8_lossy(&bytes), path)
    }

    /// Like [`open`](Self::open), for a text that was already read; `path` is only its name in errors.
    ///
    /// # Errors
    /// The same as for [`open`](Self::open).
    pub fn parse(text: &str, path: &Path) -> Result<Self, FormatError> {
        let (mut wavelengths, mut values) = (Vec::new(), Vec::new());
        let mut named = false;
        for (number, line) in text.lines().enumerate() {
            let line = line.trim_start_matches('\u{feff}').trim();
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let words: Vec<&str> =
                line.split([' ', '\t', ',', ';']).map(str::trim).filter(|word| !word.is_empty()).collect();
            let numbers: Option<Vec<f64>> = words.iter().map(|word| word.parse().ok()).collect();
            match numbers.as_deref() {
                Some(&[nm, value]) => {
                    wavelengths.push(nm);
                    values.push(value);
                }
                None if wavelengths.is_empty() && !named => named = true,
                _ => {
                    let found = lobe_files::excerpt(line, 40);
                    let place = Place::Line(number + 1);
                    return Err(FormatError::new(path, place, found, "a wavelength in nm and a number"));
                }
            }
        }
        Spectrum::new(wavelengths, values)
            .map_err(|error| FormatError::new(path, Place::File, error.to_string(), "a spectrum"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_pairs_of_numbers() {
        let read = |text: &str| Spectrum::parse(text, Path::new("x.csv"));
        let expected = Spectrum::new(vec![400.0, 500.0], vec![0.5, 1.0]).unwrap();
        for text in ["400 0.5\n500 1", "# mine\nnm, power\n400,0.5\n\n500,1\n", "\u{feff}400;0.5\r\n500;1\r\n"] {
            assert_eq!(read(text).unwrap(), expected, "{text}");
        }
        for (text, expected) in
            [("400 0.5 7\n", "400 0.5 7"), ("400 0.5\nx 1\n", "x 1"), ("400 1\n300 1\n", "300"), ("", "0 wave")]
        {
            let error = read(text).expect_err(text).to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
