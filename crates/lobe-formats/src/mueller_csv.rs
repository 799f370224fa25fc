//! Mueller matrices in specular coordinates as tables: one line per node and wavelength.
//!
//! Columns, in any order, separated by commas, semicolons or tabs: `sigma_deg`, `psi_deg`, `theta_deg`, `phi_deg` (or
//! `_rad`; without psi, the material is isotropic), `wavelength_nm` (or `_um`), and the elements `m00` to `m33` in 1/sr,
//! rows before columns; elements other than the first may be relative to it, `m01/m00`. Lines that begin with `#` are
//! comments. Rows may be in any order, and have to be all nodes of a grid.

use std::fmt::Write as _;
use std::path::Path;

use lobe_files::{FormatError, write_whole};
use lobe_table::specular::AXIS_NAMES;
use lobe_table::{Channels, Data, polarised};

use crate::lines::{Line, lines, shown};
use crate::spec::{FormatSpec, Writer, commented, reflection, unfit};
use crate::{Document, Place};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "table of Mueller matrices",
    word: "mueller-csv",
    extensions: &["csv"],
    matches,
    read: Some(|bytes, path, _| Ok(Document::new(read(bytes, path)?))),
    read_set: None,
    writer: Some(Writer {
        // A .csv file without further request holds values of unpolarised light.
        extensions: &[],
        holds_channels: |channels| matches!(channels, Channels::Spectral(_)),
        channels: "wavelengths",
        holds: |document| matches!(document.only(), Some(Data::Polarised(_))),
        holds_sheets: false,
        scatter: reflection,
        resampled_as: Ok(polarised::KIND),
        write: |document, path| match document.only() {
            Some(Data::Polarised(data)) => commented("#", document, path, |path| write(data, path)),
            _ => Err(unfit(document, path, "Mueller matrices in specular coordinates")),
        },
    }),
};

/// The elements of a matrix.
const ELEMENTS: usize = 16;
/// The number of bytes that are examined to recognise a file.
const HEAD: usize = 1 << 16;
/// A comment at the beginning of written files.
const TITLE: &str = "# Mueller matrices in specular coordinates, in 1/sr";

/// The contents of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Column {
    /// An angle, and what turns it into radians.
    Angle(usize, f64),
    /// The wavelength, and what turns it into nm.
    Wavelength(f64),
    /// An element, and whether it is relative to the first.
    Element(usize, bool),
}

/// `true` if the first line that is not a comment has the names of angles and of elements.
pub fn matches(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(HEAD)]);
    let Some(header) = header(&mut lines(Path::new(""), &head)).map(|line| line.text.to_ascii_lowercase()) else {
        return false;
    };
    let has = |wanted: &str| cells(&header).any(|cell| cell.starts_with(wanted));
    has("sigma") && has("theta") && has("m00") && has("m33")
}

/// The first line that is neither empty nor a comment.
fn header<'a>(lines: &mut impl Iterator<Item = Line<'a>>) -> Option<Line<'a>> {
    lines.find(|line| !line.text.starts_with('#'))
}

fn cells(text: &str) -> impl Iterator<Item = &str> {
    text.split([',', ';', '\t']).map(|cell| cell.trim().trim_matches('"'))
}

/// Reads matrices.
///
/// # Errors
/// [`FormatError`] with the line: unknown, missing or repeated columns, angles without a unit, rows of another length,
/// words that are not finite numbers, a node that appears twice; and if a node of the grid is missing.
pub fn read(bytes: &[u8], file: &Path) -> Result<polarised::Data, FormatError> {
    let text = String::from_utf8_lossy(bytes);
    let mut lines = lines(file, &text);
    let no_header =
        || FormatError::new(file, Place::File, "no names of columns", "sigma_deg, theta_deg, m00 and so on");
    let columns = columns(&header(&mut lines).ok_or_else(no_header)?)?;
    let mut rows: Vec<Row> = Vec::new();
    for line in lines.filter(|line| !line.text.starts_with('#')) {
        rows.push(row(&line, &columns)?);
    }
    let knots: [Vec<f64>; 5] = std::array::from_fn(|axis| {
        let mut knots: Vec<f64> = rows.iter().map(|row| row.at[axis]).collect();
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        knots
    });
    let count = knots.iter().try_fold(1_usize, |count, knots| count.checked_mul(knots.len()));
    let incomplete = |found: String| FormatError::new(file, Place::File, found, "a row for each node of a grid");
    let sizes = knots.each_ref().map(Vec::len);
    let place = |at: &[f64; 5]| {
        let index = |axis: usize| knots[axis].partition_point(|knot| *knot < at[axis]);
        (0..5).fold(0, |place, axis| place * sizes[axis] + index(axis))
    };
    // With fewer rows than nodes, the memory of the grid would not be justified by the file.
    if count.is_none_or(|count| count > rows.len()) || rows.is_empty() {
        let [sigma, psi, theta, phi, nm] = sizes;
        let found =
            format!("{} rows for {sigma} sigma x {psi} psi x {theta} theta x {phi} phi x {nm} wavelengths", rows.len());
        return Err(incomplete(found));
    }
    let count = count.unwrap_or_default();
    let (mut values, mut lines_of) = (vec![0.0; count * ELEMENTS], vec![0_usize; count]);
    for Row { line, at, elements } in &rows {
        let place = place(at);
        let before = std::mem::replace(&mut lines_of[place], *line);
        if before > 0 {
            let found = format!("the same angles and wavelength as in line {before}");
            return Err(FormatError::new(file, Place::Line(*line), found, "one row for each node"));
        }
        values[place * ELEMENTS..][..ELEMENTS].copy_from_slice(elements);
    }
    // As many rows as nodes, each at another node: none is missing.
    let [sigma, psi, theta, phi, wavelengths] = knots;
    polarised::Data::new([sigma, psi, theta, phi], wavelengths, values)
        .map_err(|error| FormatError::new(file, Place::File, error.to_string(), "matrices on a grid"))
}

/// A row: its line, its angles in radians and wavelength in nm, and its matrix.
struct Row {
    line: usize,
    at: [f64; 5],
    elements: [f32; ELEMENTS],
}

fn row(line: &Line<'_>, columns: &[Column]) -> Result<Row, FormatError> {
    let words: Vec<&str> = cells(line.text).collect();
    if words.len() != columns.len() {
        let expected = format!("{}, one for each column", columns.len());
        return Err(line.error(format!("{} cells", words.len()), expected));
    }
    let (mut at, mut elements, mut is_relative) = ([0.0; 5], [0.0_f32; ELEMENTS], [false; ELEMENTS]);
    for (word, column) in words.iter().zip(columns) {
        let number = line.number(word)?;
        match *column {
            Column::Angle(axis, unit) => at[axis] = number * unit,
            Column::Wavelength(unit) => at[4] = number * unit,
            // Rounded once, from the text.
            Column::Element(index, relative) => {
                let element = word.parse::<f32>().ok().filter(|element| element.is_finite());
                elements[index] = element.ok_or_else(|| line.error(shown(word), "a number of 32 bits"))?;
                is_relative[index] = relative;
            }
        }
    }
    // Zero has two signs, which are one angle.
    at.iter_mut().for_each(|x| *x += 0.0);
    let first = elements[0];
    for (element, relative) in elements.iter_mut().zip(is_relative) {
        *element *= if relative { first } else { 1.0 };
    }
    Ok(Row { line: line.number, at, elements })
}

/// The columns by their names.
fn columns(header: &Line<'_>) -> Result<Vec<Column>, FormatError> {
    let mut columns = Vec::new();
    for name in cells(header.text) {
        let column = column(&name.to_ascii_lowercase()).ok_or_else(|| {
            let expected = "sigma_deg, psi_deg, theta_deg, phi_deg (or _rad), wavelength_nm (or _um), and m00 to m33";
            header.error(format!("the column {}", shown(name)), expected)
        })?;
        let is_same = |other: &Column| match (*other, column) {
            (Column::Angle(a, _), Column::Angle(b, _)) | (Column::Element(a, _), Column::Element(b, _)) => a == b,
            (Column::Wavelength(_), Column::Wavelength(_)) => true,
            _ => false,
        };
        if columns.iter().any(is_same) {
            return Err(header.error(format!("two columns for {}", shown(name)), "one"));
        }
        columns.push(column);
    }
    let has_angle =
        |axis: usize| columns.iter().any(|column| matches!(column, Column::Angle(known, _) if *known == axis));
    let has_element =
        |index: usize| columns.iter().any(|column| matches!(column, Column::Element(known, _) if *known == index));
    let missing = [0, 2, 3].into_iter().find(|axis| !has_angle(*axis)).map(|axis| format!("{}_deg", AXIS_NAMES[axis]));
    let missing = missing.or_else(|| {
        let has_wavelength = columns.iter().any(|column| matches!(column, Column::Wavelength(_)));
        (!has_wavelength).then(|| "wavelength_nm".into())
    });
    let element =
        || (0..ELEMENTS).find(|index| !has_element(*index)).map(|index| format!("m{}{}", index / 4, index % 4));
    match missing.or_else(element) {
        Some(missing) => {
            Err(header.error(format!("no column {missing}"), "all angles, the wavelength and 16 elements"))
        }
        None => Ok(columns),
    }
}

fn column(name: &str) -> Option<Column> {
    if let Some((axis, unit)) = name.split_once('_')
        && let Some(axis) = AXIS_NAMES.into_iter().position(|known| known == axis)
    {
        let unit = [("deg", 1_f64.to_radians()), ("rad", 1.0)].into_iter().find(|(known, _)| *known == unit)?.1;
        return Some(Column::Angle(axis, unit));
    }
    match name {
        "wavelength_nm" => return Some(Column::Wavelength(1.0)),
        "wavelength_um" => return Some(Column::Wavelength(1000.0)),
        _ => {}
    }
    let (element, relative) = match name.split_once('/') {
        Some((element, first)) => (element, (first.trim() == "m00").then_some(true)?),
        None => (name, false),
    };
    let [b'm', row @ b'0'..=b'3', column @ b'0'..=b'3'] = *element.trim().as_bytes() else { return None };
    let index = 4 * usize::from(row - b'0') + usize::from(column - b'0');
    (index > 0 || !relative).then_some(Column::Element(index, relative))
}

/// Writes a file, replacing an existing one atomically: angles, wavelengths and elements that are read as the same
/// 32-bit numbers, as in [tensor files](crate::polarised).
///
/// # Errors
/// [`FormatError`] if the file system refuses.
pub fn write(data: &polarised::Data, path: &Path) -> Result<(), FormatError> {
    write_whole(path, to_text(data).as_bytes())
}

/// Numbers with as few decimal places as restore each as the same 32-bit number, or nine if that would make two equal:
/// 15 degrees as 15, although a conversion through radians gives 14.999999999999998.
fn short(knots: &[f64], written: impl Fn(f64) -> f64, read: impl Fn(f64) -> f64) -> Vec<f64> {
    let to = |value: f64, digits: i32| (value * 10_f64.powi(digits)).round() / 10_f64.powi(digits);
    let of = |knot: &f64| {
        let value = written(*knot);
        let fits = |digits: &i32| read(to(value, *digits)) as f32 == *knot as f32;
        to(value, (0..=9).find(fits).unwrap_or(9))
    };
    let short: Vec<f64> = knots.iter().map(of).collect();
    let ascends = short.windows(2).all(|pair| pair[0] < pair[1]);
    if ascends { short } else { knots.iter().map(|knot| to(written(*knot), 9)).collect() }
}

/// The text of a file.
pub fn to_text(data: &polarised::Data) -> String {
    let knots = data.knots().each_ref().map(|knots| short(knots, f64::to_degrees, f64::to_radians));
    let wavelengths = short(data.wavelengths(), |nm| nm, |nm| nm);
    let names: Vec<String> = (0..ELEMENTS).map(|index| format!("m{}{}", index / 4, index % 4)).collect();
    let axes = AXIS_NAMES.map(|axis| format!("{axis}_deg"));
    let mut out = format!("{TITLE}\n{},wavelength_nm,{}\n", axes.join(","), names.join(","));
    let mut matrices = data.values().chunks_exact(ELEMENTS);
    let [sigmas, psis, thetas, phis] = &knots;
    for sigma in sigmas {
        for psi in psis {
            for theta in thetas {
                for phi in phis {
                    for (nm, matrix) in wavelengths.iter().zip(&mut matrices) {
                        let _ = write!(out, "{sigma},{psi},{theta},{phi},{nm}");
                        matrix.iter().for_each(|element| {
                            let _ = write!(out, ",{element}");
                        });
                        out.push('\n');
                    }
                }
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn data() -> polarised::Data {
        let knots = [vec![0.0, 15_f64.to_radians()], vec![0.0], vec![0.0, 0.5, 1.5], vec![0.0, 3.0]];
        let values =
            (0..2 * 3 * 2 * 2 * 16).map(|i| (0.1 + (i % 7) as f32 / 3.0) * if i % 3 == 2 { -1.0 } else { 1.0 });
        polarised::Data::new(knots, vec![450.5, 650.0], values.collect()).expect("matrices")
    }

    fn parse(text: &str) -> Result<polarised::Data, FormatError> {
        read(text.as_bytes(), Path::new("x.csv"))
    }

    #[test]
    fn tables_are_restored_in_any_order_and_recognised() {
        let text = to_text(&data());
        assert!(matches(text.as_bytes()));
        assert_eq!(crate::sniff(text.as_bytes()), Some(crate::Format::MuellerCsv));
        let found = parse(&text).expect("matrices");
        assert_eq!((found.values(), found.wavelengths()), (data().values(), data().wavelengths()));
        for (found, knots) in found.knots().iter().flatten().zip(data().knots().iter().flatten()) {
            assert_eq!(*found as f32, *knots as f32);
        }
        assert_eq!(to_text(&found), text);
        let mut rows: Vec<&str> = text.lines().collect();
        rows[2..].reverse();
        assert_eq!(parse(&rows.join("\r\n")).expect("matrices"), found);
        // Semicolons, other units, a column less, and relative elements.
        let isotropic: String = text
            .lines()
            .skip(1)
            .map(|line| {
                let mut cells: Vec<&str> = line.split(',').collect();
                cells.remove(1);
                cells.join(";") + "\n"
            })
            .collect();
        assert_eq!(parse(&isotropic).expect("matrices"), found);
        let one = "sigma_rad,theta_rad,phi_rad,wavelength_um,M00,".to_string()
            + &(1..16).map(|k| format!("m{}{}/m00", k / 4, k % 4)).collect::<Vec<_>>().join(",")
            + "\n0.5,0,0,0.55,0.5,"
            + &["-0.5"; 15].join(",");
        let one = parse(&one).expect("a matrix");
        assert_eq!((one.knots()[0][0], one.wavelengths()[0], one.values()[0]), (0.5, 550.0, 0.5));
        assert!(one.values()[1..].iter().all(|element| *element == -0.25));
    }

    #[test]
    fn errors_name_the_line_and_what_is_missing() {
        let text = to_text(&data());
        let rows: Vec<&str> = text.lines().collect();
        let without = |row: usize| [&rows[..row], &rows[row + 1..]].concat().join("\n");
        for (text, expected) in [
            (without(5), "23 rows for 2 sigma x 1 psi x 3 theta x 2 phi x 2 wavelengths"),
            (format!("{text}{}", rows[3]), "x.csv:27: found the same angles and wavelength as in line 4"),
            (text.replacen(",m11", "", 1), "no column m11"),
            (text.replacen("m12", "m11", 1), "two columns for \"m11\""),
            (text.replacen("sigma_deg", "sigma", 1), "the column \"sigma\""),
            (text.replacen("wavelength_nm", "m34", 1), "the column \"m34\""),
            (format!("{text}1,2,3"), "x.csv:27: found 3 cells; expected 21"),
            (text.replacen("450.5", "blue", 1), "x.csv:3: found \"blue\""),
            (text.replacen("450.5", "nan", 1), "x.csv:3: "),
            (text.replacen(",0.1,", ",1e300,", 1), "a number of 32 bits"),
            (rows[..2].join("\n"), "0 rows"),
            (String::new(), "no names of columns"),
        ] {
            let error = parse(&text).expect_err(expected).to_string();
            assert!(error.contains(expected), "{error}, not {expected}");
        }
    }
}
