//! The sections of a file: head, specular data, tables of scatter.

use std::path::Path;

use lobe_table::Side;

use super::FIRST_LINE;
use crate::lines::{Line, lines, shown};
use crate::{FormatError, Place};

/// The names of the columns of a table of scatter.
const COLUMNS: [&str; 8] =
    ["Temperature", "Wavelength", "IncAngle", "AziAngle", "ScatterBeta", "ScatterAzimuth", "BRDF", "BTDF"];

/// The contents of a file.
pub(super) struct Property {
    /// The measurements from either side, or from one side of a property that distinguishes them.
    pub sheets: Vec<(Option<Side>, Sheet)>,
    /// Lines of the head.
    pub source: Vec<(String, String)>,
}

/// The measurements from one side.
#[derive(Default)]
pub(super) struct Sheet {
    pub specular: Vec<SpecularRow>,
    pub table: Vec<TableRow>,
}

/// The unscattered part of unpolarised light: the mean of both polarisations.
pub(super) struct SpecularRow {
    pub nm: f64,
    /// In degrees.
    pub theta: f64,
    pub reflectance: f64,
    pub transmittance: f64,
}

/// A row of a table of scatter; angles in degrees.
#[derive(Clone, Copy)]
pub(super) struct TableRow {
    pub nm: f64,
    pub theta: f64,
    pub phi: f64,
    pub beta: f64,
    pub azimuth: f64,
    pub brdf: f64,
    pub btdf: f64,
}

impl Sheet {
    /// The wavelengths of the table in nm, ascending.
    pub fn wavelengths(&self) -> Vec<f64> {
        let mut wavelengths: Vec<f64> = self.table.iter().map(|row| row.nm).collect();
        wavelengths.sort_by(f64::total_cmp);
        wavelengths.dedup();
        wavelengths
    }
}

/// The section of a file that contains a line.
enum Section {
    Head,
    /// The names of the columns of the specular data.
    Specular(Vec<String>),
    /// After the line that announces the table, and after the names of its columns.
    Announced,
    Table,
    End,
}

pub(super) fn read(file: &Path, text: &str) -> Result<Property, FormatError> {
    let mut all = lines(file, text);
    match all.next() {
        Some(line) if line.text.eq_ignore_ascii_case(FIRST_LINE) => {}
        Some(line) => return Err(line.error(shown(line.text), format!("`{FIRST_LINE}`"))),
        None => return Err(FormatError::new(file, Place::File, "an empty file", format!("`{FIRST_LINE}`"))),
    }
    let mut property = Property { sheets: vec![(None, Sheet::default())], source: Vec::new() };
    let mut section = Section::Head;
    let mut temperature = None;
    for line in all {
        let first = line.words().next().unwrap_or_default().to_ascii_lowercase();
        match (first.as_str(), &section) {
            ("side1_data" | "side2_data", _) => {
                let side = if first.starts_with("side1") { Side::Front } else { Side::Back };
                let is_first = property.sheets.len() == 1 && property.sheets[0].0.is_none();
                if is_first && property.sheets[0].1.specular.is_empty() && property.sheets[0].1.table.is_empty() {
                    property.sheets.clear();
                }
                if property.sheets.iter().any(|(other, _)| other.is_none() || *other == Some(side)) {
                    return Err(line.error(shown(line.text), "each side once, before its data"));
                }
                property.sheets.push((Some(side), Sheet::default()));
                section = Section::Head;
            }
            ("table_bsdf_data", _) => section = Section::Announced,
            ("gratingdata", _) => return Err(line.error("a grating", "a property without one")),
            ("save-data", _) => section = Section::End,
            ("temperature", Section::Announced) => {
                let names: Vec<&str> = line.words().collect();
                if names.len() != COLUMNS.len()
                    || names.iter().zip(COLUMNS).any(|(name, wanted)| !name.eq_ignore_ascii_case(wanted))
                {
                    let other = names.iter().zip(COLUMNS).find(|(name, wanted)| !name.eq_ignore_ascii_case(wanted));
                    let found = other.map_or_else(|| shown(line.text), |(name, _)| format!("a column {}", shown(name)));
                    return Err(line.error(found, format!("the columns {}", COLUMNS.join(", "))));
                }
                section = Section::Table;
            }
            ("temperature", Section::Head) => {
                section = Section::Specular(line.words().map(str::to_ascii_lowercase).collect());
            }
            (_, Section::Head) => property.source.push(fact(line.text)),
            (_, Section::Specular(names)) => {
                let row = specular(line, names)?;
                sheet(&mut property).specular.push(row);
            }
            (_, Section::Announced | Section::Table) => {
                section = Section::Table;
                let row = table(line, &mut temperature)?;
                sheet(&mut property).table.push(row);
            }
            (_, Section::End) => {
                return Err(line.error(shown(line.text), "one property per file: nothing after SAVE-DATA"));
            }
        }
    }
    property.sheets.retain(|(_, sheet)| !sheet.table.is_empty());
    if property.sheets.is_empty() {
        let expected = "rows after `Table_BSDF_Data`: other kinds of scatter (ABg, Gaussian, ...) are formulas";
        return Err(FormatError::new(file, Place::File, "a property without a table of scatter", expected));
    }
    Ok(property)
}

fn sheet(property: &mut Property) -> &mut Sheet {
    if property.sheets.is_empty() {
        property.sheets.push((None, Sheet::default()));
    }
    let last = property.sheets.len() - 1;
    &mut property.sheets[last].1
}

/// A line of the head: a name, then a tab or several spaces, or a colon, or one space, and the value.
fn fact(line: &str) -> (String, String) {
    let parted = line.split_once('\t').or_else(|| line.split_once(": ")).or_else(|| line.split_once("  "));
    let (name, value) = parted.or_else(|| line.split_once(' ')).unwrap_or((line, ""));
    (name.trim().trim_end_matches(':').into(), value.trim().into())
}

fn specular(line: Line<'_>, names: &[String]) -> Result<SpecularRow, FormatError> {
    let numbers = line.numbers()?;
    let value = |name: &str| {
        let at = names.iter().position(|found| found == name);
        at.and_then(|at| numbers.get(at)).copied()
    };
    let needed = |name: &str| value(name).ok_or_else(|| line.error(format!("no {name}"), "a value in each column"));
    if numbers.len() < names.len() {
        return Err(line.error(format!("{} numbers", numbers.len()), format!("{}, one for each name", names.len())));
    }
    // Some files name fewer columns than the program does: without both polarisations there is no such light.
    let mean = |s: &str, p: &str| match (value(s), value(p)) {
        (Some(s), Some(p)) => Ok((s + p) / 2.0),
        (None, None) => Ok(0.0),
        _ => Err(line.error(format!("only one of {s} and {p}"), "both polarisations")),
    };
    Ok(SpecularRow {
        nm: nanometres(line, needed("wavelength")?)?,
        theta: polar(line, needed("incangle")?)?,
        reflectance: mean("refl_s", "refl_p")?,
        transmittance: mean("tran_s", "tran_p")?,
    })
}

fn table(line: Line<'_>, temperature: &mut Option<f64>) -> Result<TableRow, FormatError> {
    let [kelvin, micrometres, theta, phi, beta, azimuth, brdf, btdf] = line.exactly("8 columns")?;
    if *temperature.get_or_insert(kelvin) != kelvin {
        return Err(line.error(format!("a second temperature, {kelvin} K"), "the table of one temperature"));
    }
    if !(0.0..=2.0).contains(&beta) {
        return Err(line.error(format!("ScatterBeta {beta}"), "0 to 2"));
    }
    Ok(TableRow { nm: nanometres(line, micrometres)?, theta: polar(line, theta)?, phi, beta, azimuth, brdf, btdf })
}

fn nanometres(line: Line<'_>, micrometres: f64) -> Result<f64, FormatError> {
    let nm = (micrometres * 1e9).round() / 1e6;
    match nm > 0.0 && nm.is_finite() {
        true => Ok(nm),
        false => Err(line.error(format!("wavelength {micrometres}"), "a positive number of micrometres")),
    }
}

fn polar(line: Line<'_>, degrees: f64) -> Result<f64, FormatError> {
    match (0.0..=90.0).contains(&degrees) {
        true => Ok(degrees + 0.0),
        false => Err(line.error(format!("IncAngle {degrees}"), "0 to 90 degrees")),
    }
}
