//! The options that supply facts that a file leaves open.

use std::path::Path;

use lobe::{Material, Options};
use lobe_formats::goniometer::Unit;
use lobe_formats::reading::{AzimuthFrom, Column, Holds, InPlane, OF_ALL_FORMATS, Quantity, Scale, parse_columns};
use lobe_formats::{Document, Format, FormatError, ReadOptions, open_with};
use lobe_ops::Subject;

use crate::failure::Failure;

/// Arguments of the commands that read a file.
#[derive(clap::Args, Clone, Debug, Default)]
#[command(next_help_heading = "Reading the file (kept in FILE.lobe.toml by lobe import)")]
pub struct Reading {
    /// The meaning of the columns of a table: theta_i=1,phi_i=2,theta_o=3,phi_o=4,f=5 (or R=5,G=6,B=7 or 550nm=5),
    /// wavelength=6 if each row has its own, names of columns instead of numbers, and theta_i=30deg for an angle that
    /// is the same in all rows.
    #[arg(long, value_name = "NAME=COLUMN,...", value_parser = columns)]
    columns: Option<Columns>,
    /// The unit of angles that do not state it: deg or rad.
    #[arg(long, value_parser = str::parse::<Unit>)]
    unit: Option<Unit>,
    /// The quantity of the values: f, luminance-factor (pi f) or f-cos.
    #[arg(long, value_parser = str::parse::<Quantity>)]
    values: Option<Quantity>,
    /// A factor for the values, or tis: the factor that makes their integral the total that the file states.
    #[arg(long, value_name = "X|tis", value_parser = str::parse::<Scale>)]
    scale: Option<Scale>,
    /// The scatter that a table holds: reflection, transmission, or both if values beyond 90 degrees are transmission.
    #[arg(long, value_parser = str::parse::<Holds>)]
    holds: Option<Holds>,
    /// A table without azimuths is in the plane of incidence: same-sign if the mirror direction is at theta_o =
    /// theta_i, opposite-sign if it is at -theta_i.
    #[arg(long, value_name = "SIGN", value_parser = str::parse::<InPlane>)]
    in_plane: Option<InPlane>,
    /// The direction from which azimuths of the viewer are counted, if there are none of the light: light or mirror.
    #[arg(long, value_name = "SIDE", value_parser = str::parse::<AzimuthFrom>)]
    azimuth_from: Option<AzimuthFrom>,
    /// Numbers in a table have decimal commas.
    #[arg(long)]
    decimal_comma: bool,
}

#[derive(Clone, Debug)]
struct Columns(Vec<Column>);

fn columns(text: &str) -> Result<Columns, String> {
    parse_columns(text).map(Columns)
}

impl Reading {
    /// The options that the user gave.
    pub fn options(&self) -> ReadOptions {
        ReadOptions {
            columns: self.columns.clone().map(|Columns(columns)| columns).unwrap_or_default(),
            unit: self.unit,
            values: self.values,
            scale: self.scale,
            holds: self.holds,
            in_plane: self.in_plane,
            azimuth_from: self.azimuth_from,
            decimal_comma: self.decimal_comma.then_some(true),
        }
    }

    /// Opens a file; its sidecar supplies options that the user does not give.
    pub fn open(&self, path: &Path) -> Result<(Format, Document), Failure> {
        open_with(path, &self.options()).map_err(|error| self.failure(error))
    }

    /// The failure to open a file: wrong usage if an option of the user does not apply to it.
    pub fn failure(&self, error: FormatError) -> Failure {
        match error.expected == OF_ALL_FORMATS && !self.options().is_empty() {
            true => Failure::Usage(error.to_string()),
            false => error.into(),
        }
    }

    /// Refuses options for a file to which none applies.
    pub fn refuse(&self, path: &Path, what: &str) -> Result<(), Failure> {
        match self.options() == ReadOptions::default() {
            true => Ok(()),
            false => Err(Failure::Usage(format!(
                "{}: found options for tables, but the file is {what}; expected none",
                path.display()
            ))),
        }
    }

    /// Opens a file for an operation.
    pub fn subject(&self, path: &Path, options: &Options) -> Result<Subject, Failure> {
        let (format, document) = self.open(path)?;
        let material = Material::from_document(&document, options).map_err(|error| error.in_file(path))?;
        Ok(Subject::new(format, document, material, options))
    }
}
