//! Radiance matrix files.
//!
//! The header begins with a line of `#?` and a word, and ends with an empty line: `NROWS=`, `NCOLS=` and `NCOMP=` give
//! the shape, `FORMAT=` is `ascii`, `float` or `double`, and `BigEndian=1` says that numbers are big-endian. The
//! elements follow, row by row, each with its components. A text without a header has one row per line, with three
//! components per column; older programs write sky vectors like this.

use std::fmt::Write as _;
use std::path::Path;

use lobe_files::{FormatError, Place, excerpt, write_whole};

use super::Matrix;

/// How elements are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Numbers as text, with as many digits as an `f64` needs.
    Ascii,
    /// Little-endian `f32`.
    Float,
    /// Little-endian `f64`.
    Double,
}

impl Format {
    /// The name of the format in the header.
    pub fn name(self) -> &'static str {
        match self {
            Format::Ascii => "ascii",
            Format::Float => "float",
            Format::Double => "double",
        }
    }
}

/// The entries of the header.
#[derive(Default)]
struct Header {
    rows: Option<usize>,
    columns: Option<usize>,
    components: Option<usize>,
    format: Option<Format>,
    is_big_endian: bool,
}

/// Reads a matrix. `file` only names it in errors.
///
/// # Errors
/// [`FormatError`] if the header lacks a size or names another format, as pictures do; if there are more or fewer
/// elements than it says; or if an element is not a finite number.
pub fn read(bytes: &[u8], file: &Path) -> Result<Matrix, FormatError> {
    if !bytes.starts_with(b"#?") {
        return without_header(bytes, file);
    }
    let mut header = Header::default();
    let (mut at, mut line) = (0, 0);
    loop {
        let Some(length) = bytes[at..].iter().position(|&byte| byte == b'\n') else {
            let expected = "an empty line after the header";
            return Err(FormatError::new(file, Place::Line(line + 1), "the end of the file", expected));
        };
        line += 1;
        let text = String::from_utf8_lossy(&bytes[at..at + length]);
        at += length + 1;
        if text.trim().is_empty() {
            break;
        }
        header.take(text.trim(), file, line)?;
    }
    let size = |count: Option<usize>, name: &str| {
        let expected = format!("{name} with a number of at least 1");
        count.ok_or_else(|| FormatError::new(file, Place::File, format!("a header without {name}"), expected))
    };
    let (rows, columns) = (size(header.rows, "NROWS")?, size(header.columns, "NCOLS")?);
    let components = header.components.unwrap_or(3);
    let format = header.format.unwrap_or(Format::Ascii);
    let rest = &bytes[at..];
    // Checked before memory is allocated: a number takes at least this many bytes, as text with a space.
    let width = match format {
        Format::Ascii => 2,
        Format::Float => 4,
        Format::Double => 8,
    };
    let count = [rows, columns, components].into_iter().try_fold(1_usize, usize::checked_mul);
    let room = rest.len() / width + usize::from(format == Format::Ascii);
    let Some(count) = count.filter(|count| *count <= room) else {
        let found = format!("{rows} x {columns} elements of {components} components");
        let expected = format!("at most {room} numbers in the rest of the file");
        return Err(FormatError::new(file, Place::File, found, expected));
    };
    let elements = match format {
        Format::Ascii => numbers(rest, file, line, count)?,
        Format::Float | Format::Double => binary(rest, format, header.is_big_endian, [at, count], file)?,
    };
    Ok(Matrix::new([rows, columns, components], &elements))
}

impl Header {
    fn take(&mut self, text: &str, file: &Path, line: usize) -> Result<(), FormatError> {
        let Some((key, value)) = text.split_once('=') else { return Ok(()) };
        let value = value.trim();
        let wrong = |expected: &str| {
            let found = format!("{}={}", excerpt(key, 20), excerpt(value, 40));
            FormatError::new(file, Place::Line(line), found, expected)
        };
        let count = || {
            let count = value.parse().ok().filter(|count: &usize| *count > 0);
            count.ok_or_else(|| wrong("a number of at least 1"))
        };
        match key {
            "NROWS" => self.rows = Some(count()?),
            "NCOLS" => self.columns = Some(count()?),
            "NCOMP" => self.components = Some(count()?),
            "BigEndian" => self.is_big_endian = value == "1",
            "FORMAT" => {
                let all = [Format::Ascii, Format::Float, Format::Double];
                let format = all.into_iter().find(|format| format.name() == value);
                self.format = Some(format.ok_or_else(|| wrong("FORMAT=ascii, float or double"))?);
            }
            _ => {}
        }
        Ok(())
    }
}

fn number(word: &str, file: &Path, line: usize) -> Result<f64, FormatError> {
    let number = word.parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| FormatError::new(file, Place::Line(line), excerpt(word, 40), "a finite number"))
}

/// Reads `count` numbers from a text that starts after line `after`.
fn numbers(bytes: &[u8], file: &Path, after: usize, count: usize) -> Result<Vec<f64>, FormatError> {
    let mut found = Vec::new();
    for (index, line) in bytes.split(|&byte| byte == b'\n').enumerate() {
        for word in String::from_utf8_lossy(line).split_whitespace() {
            if found.len() == count {
                let (place, found) = (Place::Line(after + index + 1), excerpt(word, 40));
                return Err(FormatError::new(file, place, found, format!("the end after {count} numbers")));
            }
            found.push(number(word, file, after + index + 1)?);
        }
    }
    match found.len() == count {
        true => Ok(found),
        false => {
            let (found, expected) = (format!("{} numbers", found.len()), format!("{count}, as the header says"));
            Err(FormatError::new(file, Place::File, found, expected))
        }
    }
}

fn binary(
    bytes: &[u8],
    format: Format,
    is_big_endian: bool,
    [at, count]: [usize; 2],
    file: &Path,
) -> Result<Vec<f64>, FormatError> {
    let width = if format == Format::Float { 4 } else { 8 };
    if bytes.len() != count * width {
        let found = format!("{} bytes after the header", bytes.len());
        return Err(FormatError::new(file, Place::File, found, format!("{}, as the header says", count * width)));
    }
    let value = |bytes: &[u8]| -> f64 {
        let mut word = [0; 8];
        let word = &mut word[..width];
        word.copy_from_slice(bytes);
        if is_big_endian {
            word.reverse();
        }
        match *word {
            [a, b, c, d] => f64::from(f32::from_le_bytes([a, b, c, d])),
            [a, b, c, d, e, f, g, h] => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
            _ => f64::NAN,
        }
    };
    let elements: Vec<f64> = bytes.chunks_exact(width).map(value).collect();
    match elements.iter().position(|value| !value.is_finite()) {
        Some(index) => {
            let found = format!("the number {}", elements[index]);
            Err(FormatError::new(file, Place::Byte((at + index * width) as u64), found, "a finite number"))
        }
        None => Ok(elements),
    }
}

/// Reads one row per line, with three numbers per column.
fn without_header(bytes: &[u8], file: &Path) -> Result<Matrix, FormatError> {
    let expected = "a Radiance matrix: `#?RADIANCE` and a header, or lines of numbers";
    if bytes.contains(&0) {
        return Err(FormatError::new(file, Place::File, "bytes without a header", expected));
    }
    let (mut elements, mut rows, mut width) = (Vec::new(), 0, 0);
    for (index, line) in String::from_utf8_lossy(bytes).lines().enumerate() {
        let before = elements.len();
        for word in line.split_whitespace() {
            elements.push(number(word, file, index + 1)?);
        }
        let found = elements.len() - before;
        if found == 0 {
            continue;
        }
        if rows > 0 && found != width || found % 3 != 0 {
            let expected = if rows > 0 { format!("{width}, as in earlier lines") } else { "3 for each column".into() };
            return Err(FormatError::new(file, Place::Line(index + 1), format!("{found} numbers"), expected));
        }
        (rows, width) = (rows + 1, found);
    }
    match rows {
        0 => Err(FormatError::new(file, Place::File, "no numbers", expected)),
        _ => Ok(Matrix::new([rows, width / 3, 3], &elements)),
    }
}

/// The bytes of a matrix file. `made_by` is a line of the header that says how it was made.
pub fn to_bytes(matrix: &Matrix, format: Format, made_by: &str) -> Vec<u8> {
    let [rows, columns, components] = matrix.shape();
    let made_by: String = made_by.chars().filter(|character| !character.is_control()).collect();
    let mut head = format!("#?RADIANCE\n{made_by}\nNROWS={rows}\nNCOLS={columns}\nNCOMP={components}\n");
    if format != Format::Ascii {
        head.push_str("BigEndian=0\n");
    }
    let _ = writeln!(head, "FORMAT={}\n", format.name());
    let mut bytes = head.into_bytes();
    for row in 0..rows {
        for column in 0..columns {
            for component in 0..components {
                let value = matrix.at(row, column, component);
                match format {
                    Format::Ascii => {
                        let end = match (component + 1 == components, column + 1 == columns) {
                            (false, _) => ' ',
                            (true, false) => '\t',
                            (true, true) => '\n',
                        };
                        bytes.extend_from_slice(format!("{value}{end}").as_bytes());
                    }
                    Format::Float => bytes.extend_from_slice(&(value as f32).to_le_bytes()),
                    Format::Double => bytes.extend_from_slice(&value.to_le_bytes()),
                }
            }
        }
    }
    bytes
}

/// Writes a matrix completely or not at all. `made_by` is a line of the header that says how it was made.
///
/// # Errors
/// [`FormatError`] if the file cannot be written.
pub fn write(matrix: &Matrix, format: Format, made_by: &str, path: &Path) -> Result<(), FormatError> {
    write_whole(path, &to_bytes(matrix, format, made_by))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix() -> Matrix {
        let elements: Vec<f64> = (0..24).map(|index| f64::from(index) * 0.1 - 0.7).collect();
        Matrix::new([2, 4, 3], &elements)
    }

    fn file() -> &'static Path {
        Path::new("file")
    }

    #[test]
    fn matrices_come_back() {
        for format in [Format::Ascii, Format::Float, Format::Double] {
            let back = read(&to_bytes(&matrix(), format, "lobe matrix"), file()).expect("a matrix");
            let bound = if format == Format::Float { 1e-7 } else { 0.0 };
            assert_eq!(back.shape(), [2, 4, 3]);
            for (row, column, component) in [(0, 0, 0), (1, 3, 2), (0, 2, 1)] {
                let apart = back.at(row, column, component) - matrix().at(row, column, component);
                assert!(apart.abs() <= bound, "{format:?}");
            }
        }
        let mut swapped = to_bytes(&matrix(), Format::Double, "x");
        let text = swapped.windows(12).position(|bytes| bytes == b"BigEndian=0\n").expect("a line");
        swapped[text + 10] = b'1';
        let start = swapped.len() - 24 * 8;
        swapped[start..].as_chunks_mut::<8>().0.iter_mut().for_each(|word| word.reverse());
        assert_eq!(read(&swapped, file()).expect("a matrix"), matrix());
    }

    #[test]
    fn texts_without_a_header_are_rows_of_three() {
        let sky = read(b"1 2 3\n4 5 6\n", file()).expect("a vector");
        assert_eq!((sky.shape(), sky.at(1, 0, 2)), ([2, 1, 3], 6.0));
        for (wrong, found) in [
            ("1 2\n", "2 numbers"),
            ("1 2 3\n1 2 3 4 5 6\n", "6 numbers"),
            ("", "no numbers"),
            ("1 2 x\n", "x"),
            ("\0\0\0\0", "bytes without a header"),
        ] {
            let error = read(wrong.as_bytes(), file()).expect_err(wrong).to_string();
            assert!(error.contains(found), "{error}");
        }
    }

    #[test]
    fn damaged_files_are_refused_with_a_reason() {
        let head = |rest: &str| format!("#?RADIANCE\n{rest}\n\n1 2 3 4 5 6\n");
        for (wrong, found) in [
            (head("NROWS=1"), "without NCOLS"),
            (head("NROWS=2\nNCOLS=2\nNCOMP=3"), "2 x 2 elements"),
            (head("NROWS=1\nNCOLS=1\nNCOMP=3"), "found 4"),
            (head("NROWS=4000000000\nNCOLS=4000000000\nNCOMP=3"), "4000000000 x 4000000000"),
            (head("NROWS=0\nNCOLS=1"), "NROWS=0"),
            (head("NROWS=1\nNCOLS=2\nFORMAT=32-bit_rle_rgbe"), "32-bit_rle_rgbe"),
            (head("NROWS=1\nNCOLS=2\nFORMAT=double"), "elements of 3 components"),
            ("#?RADIANCE\nNROWS=1".into(), "the end of the file"),
        ] {
            let error = read(wrong.as_bytes(), file()).expect_err(&wrong).to_string();
            assert!(error.contains(found), "{error}");
        }
        let whole = to_bytes(&matrix(), Format::Float, "x");
        for end in 0..whole.len() {
            assert!(read(&whole[..end], file()).is_err(), "{end} of {} bytes", whole.len());
        }
        let mut broken = whole.clone();
        let last = broken.len() - 4;
        broken[last..].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(read(&broken, file()).expect_err("NaN").to_string().contains("NaN"));
    }
}
