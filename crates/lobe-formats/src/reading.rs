//! Options for facts that a file leaves open.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use crate::angle::{Angle, Unit};
use crate::words::words;
use crate::{FormatError, Place};

/// Options for facts that a file leaves open. Each may be `None`: then the file, its sidecar or the rule of its format
/// decides.
///
/// On the command line each field is an option of the same name; in a [sidecar](crate::sidecar) it is a key.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// The meaning of the columns of a table, if their names do not state it. If one of these holds values, no other
    /// columns do.
    pub columns: Vec<Column>,
    /// The unit of angles in tables that do not state it.
    pub unit: Option<Unit>,
    /// The quantity of the values.
    pub values: Option<Quantity>,
    /// The factor of the values.
    pub scale: Option<Scale>,
    /// The kind of scatter that a table holds: reflection, transmission or both.
    pub holds: Option<Holds>,
    /// The sign of polar angles in tables within the plane of incidence.
    pub in_plane: Option<InPlane>,
    /// The origin of the azimuths of the viewer in tables without azimuths of the light.
    pub azimuth_from: Option<AzimuthFrom>,
    /// `true` if numbers in a table have decimal commas.
    pub decimal_comma: Option<bool>,
}

words! {
    /// The quantity of the values of a file.
    Quantity:
    /// `f` in 1/sr, without the cosine.
    F = "f" or "brdf" or "btdf" or "bsdf",
    /// Luminance factors, pi f: relative to a perfect white diffuser lit and seen in the same way.
    LuminanceFactor = "luminance-factor" or "radiance-factor" or "reflectance-factor" or "pi-f",
    /// `f` times the cosine of the viewer's polar angle.
    FCos = "f-cos" or "cosine-corrected",
}

words! {
    /// The scatter that a table holds.
    Holds:
    /// Both directions on one side.
    Reflection = "reflection" or "brdf",
    /// The directions on opposite sides. The viewer's polar angles are below 90 degrees, or all above.
    Transmission = "transmission" or "btdf",
    /// Both: light beyond 90 degrees is transmitted.
    Both = "both" or "bsdf",
}

words! {
    /// The sign of polar angles in a table within the plane of incidence.
    InPlane:
    /// The mirror direction has the angle of the light.
    SameSign = "same-sign",
    /// The mirror direction has the angle of the light with the opposite sign.
    OppositeSign = "opposite-sign",
}

words! {
    /// The origin of azimuths of the viewer.
    AzimuthFrom:
    /// The side of the light: the mirror direction is at 180 degrees.
    Light = "light",
    /// The side of the mirror direction.
    Mirror = "mirror",
}

/// The factor of the values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// A positive number.
    By(f64),
    /// The factor that makes the integral of `f cos` over the hemisphere equal to the total integrated scatter that the
    /// file states for the block of values.
    Tis,
}

impl FromStr for Scale {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        if word.trim().eq_ignore_ascii_case("tis") {
            return Ok(Scale::Tis);
        }
        let factor = word.trim().parse().ok().filter(|factor: &f64| factor.is_finite() && *factor > 0.0);
        factor.map(Scale::By).ok_or_else(|| format!("found {word:?}; expected a number above 0, or tis"))
    }
}

impl fmt::Display for Scale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Scale::By(factor) => write!(f, "{factor}"),
            Scale::Tis => f.write_str("tis"),
        }
    }
}

/// The meaning of one column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The quantity.
    pub content: Content,
    /// The location of the quantity.
    pub at: Position,
}

/// The quantity in a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// An angle.
    Angle(Angle),
    /// The wavelength of the values in the row, in nm, unless its name says micrometres.
    Wavelength,
    /// Values of the channel with this name.
    Values(String),
}

/// The location of a quantity.
#[derive(Clone, Debug, PartialEq)]
pub enum Position {
    /// In a column, counted from 1.
    Number(usize),
    /// In the column with this name.
    Named(String),
    /// Nowhere: an angle that is the same in all rows.
    Fixed(f64, Unit),
}

/// `theta_i=1`, `f=BRDF` or `theta_i=45deg`.
impl FromStr for Column {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = "NAME=COLUMN, such as theta_i=1, f=BRDF or theta_i=45deg";
        let wrong = || format!("found {text:?}; expected {wanted}");
        let (name, place) = text.split_once('=').ok_or_else(wrong)?;
        let (name, place) = (name.trim(), place.trim());
        if name.is_empty() || place.is_empty() {
            return Err(wrong());
        }
        let content = match Angle::WORDS.iter().find(|(word, _)| word.eq_ignore_ascii_case(name)) {
            Some((_, angle)) => Content::Angle(*angle),
            None if name.eq_ignore_ascii_case("wavelength") => Content::Wavelength,
            None => Content::Values(name.into()),
        };
        let fixed = || {
            let number = place.trim_end_matches(|c: char| c.is_alphabetic() || c == '°');
            let unit = place[number.len()..].parse().ok()?;
            let number = number.trim().parse().ok().filter(|number: &f64| number.is_finite())?;
            matches!(content, Content::Angle(_)).then_some(Position::Fixed(number, unit))
        };
        let at = match place.parse::<usize>() {
            Ok(0) => return Err(format!("found column 0 in {text:?}; expected columns counted from 1")),
            Ok(number) => Position::Number(number),
            Err(_) => fixed()
                .unwrap_or_else(|| Position::Named(place.trim_matches(|c: char| c == '"' || c.is_whitespace()).into())),
        };
        Ok(Column { content, at })
    }
}

impl fmt::Display for Column {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.content {
            Content::Angle(angle) => write!(f, "{angle}")?,
            Content::Wavelength => f.write_str("wavelength")?,
            Content::Values(name) => f.write_str(name)?,
        }
        match &self.at {
            Position::Number(number) => write!(f, "={number}"),
            // In quotes, so that a name such as 5 is not the number of a column.
            Position::Named(name) => write!(f, "=\"{name}\""),
            Position::Fixed(angle, unit) => write!(f, "={angle}{unit}"),
        }
    }
}

/// A list of columns separated by commas, as on the command line.
///
/// # Errors
/// What was found, and what was expected.
pub fn parse_columns(text: &str) -> Result<Vec<Column>, String> {
    let columns: Vec<Column> =
        text.split(',').filter(|part| !part.trim().is_empty()).map(str::parse).collect::<Result<_, _>>()?;
    for (index, column) in columns.iter().enumerate() {
        if columns[..index].iter().any(|other| other.content == column.content) {
            return Err(format!("found {column} after another column for the same; expected each once"));
        }
    }
    match columns.is_empty() {
        true => Err("found no columns; expected a list such as theta_i=1,theta_o=2,f=3".into()),
        false => Ok(columns),
    }
}

impl ReadOptions {
    /// `true` if no option is given.
    pub fn is_empty(&self) -> bool {
        *self == ReadOptions::default()
    }

    /// The same, with missing options taken from others.
    #[must_use]
    pub fn or(self, other: ReadOptions) -> Self {
        ReadOptions {
            columns: if self.columns.is_empty() { other.columns } else { self.columns },
            unit: self.unit.or(other.unit),
            values: self.values.or(other.values),
            scale: self.scale.or(other.scale),
            holds: self.holds.or(other.holds),
            in_plane: self.in_plane.or(other.in_plane),
            azimuth_from: self.azimuth_from.or(other.azimuth_from),
            decimal_comma: self.decimal_comma.or(other.decimal_comma),
        }
    }

    /// The names of the given options that apply only to tables with named columns.
    pub(crate) fn of_tables(&self) -> Vec<&'static str> {
        let given = [
            ("columns", !self.columns.is_empty()),
            ("unit", self.unit.is_some()),
            ("holds", self.holds.is_some()),
            ("in-plane", self.in_plane.is_some()),
            ("azimuth-from", self.azimuth_from.is_some()),
            ("decimal-comma", self.decimal_comma.is_some()),
        ];
        given.into_iter().filter(|(_, is_given)| *is_given).map(|(name, _)| name).collect()
    }

    /// Refuses options for tables if the file has another format.
    pub(crate) fn check_no_table(&self, path: &Path, format: &str) -> Result<(), FormatError> {
        let given = self.of_tables();
        if given.is_empty() {
            return Ok(());
        }
        let found = format!("options for tables with named columns ({}), for a file of {format}", given.join(", "));
        Err(FormatError::new(path, Place::File, found, OF_ALL_FORMATS))
    }
}

/// What is expected if options are given that do not apply to the format of a file.
pub const OF_ALL_FORMATS: &str = "only values and scale";
