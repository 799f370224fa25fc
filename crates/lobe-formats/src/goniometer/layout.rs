//! The meaning of each column of a table.

use std::collections::BTreeSet;

use lobe_table::Channels;

use super::chosen::{list, list_of};
use super::directions::{has_twice, settle, wide};
use super::facts::Facts;
use super::meaning::Meaning;
use super::source::{SPECULAR, SPHERICAL, Source};
use super::stated::{other_values, unit_of_angle};
use super::trouble::Trouble;
use crate::angle::{Angle, Unit};
use crate::columns::channels;
use crate::lines::shown;
use crate::reading::{Content, Holds, Position, Quantity, ReadOptions};

/// The location of values.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Values {
    /// In one column per channel.
    Channels(Vec<usize>, Channels),
    /// In one column per value of an angle, with its unit.
    Wide(Vec<(usize, f64)>, Option<Unit>),
    /// In one column, for the wavelength of the row: the column of the wavelength, and its factor to nm.
    ByWavelength { values: usize, wavelength: usize, nm: f64 },
}

/// The meaning of the columns.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub is_specular: bool,
    /// `theta_i`, `phi_i`, `theta_o`, `phi_o`, or `sigma`, `psi`, `theta`, `phi`.
    pub angles: [Source; 4],
    /// `true` if an angle may change between the rows, because it is in a separate line.
    pub is_from_facts: [bool; 4],
    pub values: Values,
    /// The quantity that the names state.
    pub quantity: Option<Quantity>,
    /// Values are in per cent.
    pub is_percent: bool,
    pub holds: Option<Holds>,
    /// Columns that are not read although they may matter: rows with the same directions must not differ in them.
    pub watched: Vec<usize>,
    pub notes: Vec<String>,
}

const WANTED: &str =
    "theta_i and theta_o, with phi_o unless the viewer stays in the plane of incidence, or sigma, theta and phi";
/// A number below this, in nm, counts as a wavelength only with its unit.
const SHORTEST: f64 = 100.0;
/// In degrees.
const FULL_TURN: f64 = 360.0;

const CHANNELS: &str = "R, G, B or X, Y, Z or wavelengths such as 550nm or one column such as BRDF";

impl Layout {
    /// The layout of a table whose columns have these meanings. `is_text` says which columns hold words.
    pub fn new(
        names: &[String],
        mut meanings: Vec<Meaning>,
        is_text: &[bool],
        facts: &Facts,
        options: &ReadOptions,
    ) -> Result<Self, Trouble> {
        let mut notes = Vec::new();
        let fixed = |angle: Angle| {
            let given = options.columns.iter().find_map(|column| match (&column.content, &column.at) {
                (Content::Angle(other), Position::Fixed(value, unit)) if *other == angle => {
                    Some(Source::Fixed(*value, Some(*unit)))
                }
                _ => None,
            });
            let stated = || {
                facts
                    .angles
                    .iter()
                    .find(|fixed| fixed.angle == angle)
                    .map(|fixed| Source::Fixed(fixed.value, fixed.unit))
            };
            given.or_else(stated)
        };
        settle(&mut meanings, |angle| fixed(angle).is_some());
        let of = |meanings: &[Meaning], angle: Angle| {
            meanings.iter().any(|m| matches!(m, Meaning::Angle(other, _) if *other == angle))
        };
        let is_there = |angle: Angle| of(&meanings, angle) || fixed(angle).is_some();
        let is_specular = is_there(Angle::Sigma) && !(is_there(Angle::ThetaI) && is_there(Angle::ThetaO));
        let axes = if is_specular { SPECULAR } else { SPHERICAL };
        let mut angles = [Source::Missing; 4];
        let mut is_from_facts = [false; 4];
        for (axis, &angle) in axes.iter().enumerate() {
            let mut columns = meanings.iter().enumerate().filter_map(|(column, meaning)| match meaning {
                Meaning::Angle(other, unit) if *other == angle => Some((column, *unit)),
                _ => None,
            });
            if let Some((column, unit)) = columns.next() {
                if unit.is_none()
                    && options.unit.is_none()
                    && let Some(stated) = names.get(column).and_then(|name| unit_of_angle(name))
                {
                    let found = format!("{angle} as {stated}, in column {}", shown(&names[column]));
                    return Err(Trouble::new(found, "degrees, radians or mrad from the normal"));
                }
                angles[axis] = Source::Column(column, unit);
                if columns.next().is_some() {
                    return Err(Trouble::new(format!("a second column of {angle}"), "each angle once"));
                }
            } else if let Some(source) = fixed(angle) {
                angles[axis] = source;
                is_from_facts[axis] = !options.columns.iter().any(|column| column.content == Content::Angle(angle));
            }
        }
        let wide = if is_specular { None } else { wide(&meanings, &mut angles) };
        let needed: &[usize] = if is_specular { &[0, 2, 3] } else { &[0, 2] };
        if let Some(&axis) = needed.iter().find(|&&axis| angles[axis] == Source::Missing) {
            return Err(Trouble::new(
                format!("no column of {} among {}", axes[axis], list(names, meanings.len())),
                WANTED,
            ));
        }
        let mut layout = Layout {
            is_specular,
            angles,
            is_from_facts,
            values: Values::Channels(Vec::new(), Channels::Mono),
            quantity: None,
            is_percent: false,
            holds: None,
            watched: Vec::new(),
            notes: Vec::new(),
        };
        match wide {
            Some((columns, unit)) => layout.values = Values::Wide(columns, unit),
            None => layout.find_values(names, &meanings, is_text, options)?,
        }
        let used: BTreeSet<usize> = layout.used().into_iter().collect();
        let mut passed = Vec::new();
        for (column, meaning) in meanings.iter().enumerate().filter(|(column, _)| !used.contains(column)) {
            let Some(name) = names.get(column).filter(|name| !name.trim().is_empty()) else { continue };
            if matches!(meaning, Meaning::Unknown | Meaning::Values { .. } | Meaning::Angle(..)) {
                layout.watched.push(column);
            }
            passed.push(shown(name));
        }
        if !passed.is_empty() {
            notes.push(format!("not read: {}", passed.join(", ")));
        }
        layout.notes = notes;
        Ok(layout)
    }

    /// The columns that are read.
    pub fn used(&self) -> Vec<usize> {
        let mut used: Vec<usize> = self
            .angles
            .iter()
            .filter_map(|source| match source {
                Source::Column(column, _) => Some(*column),
                _ => None,
            })
            .collect();
        match &self.values {
            Values::Channels(columns, _) => used.extend(columns),
            Values::Wide(columns, _) => used.extend(columns.iter().map(|(column, _)| column)),
            Values::ByWavelength { values, wavelength, .. } => used.extend([values, wavelength]),
        }
        used
    }

    fn find_values(
        &mut self,
        names: &[String],
        meanings: &[Meaning],
        is_text: &[bool],
        options: &ReadOptions,
    ) -> Result<(), Trouble> {
        let is_word = |column: usize| is_text.get(column).copied().unwrap_or(false);
        let is_said = options.values.is_some() || options.scale.is_some();
        let mut columns = Vec::new();
        for (column, meaning) in meanings.iter().enumerate() {
            if matches!(meaning, Meaning::Values { .. } | Meaning::Number(..)) && !is_word(column) {
                columns.push(column);
            }
        }
        if columns.is_empty() {
            let of = |wanted: fn(&Meaning) -> bool| {
                let columns =
                    meanings.iter().enumerate().filter(|(column, meaning)| wanted(meaning) && !is_word(*column));
                columns.map(|(column, _)| column).collect::<Vec<usize>>()
            };
            let (unknown, signals) = (of(|m| *m == Meaning::Unknown), of(|m| *m == Meaning::Signal));
            columns = match (unknown.len(), signals.len()) {
                (1, 0) => unknown,
                (0, 1) | (1, 1) if is_said => signals,
                (_, 1..) => {
                    let found = format!("values called {}", list_of(names, &signals));
                    let expected =
                        "f in 1/sr, as BRDF, or their quantity: values = f, luminance-factor or f-cos, and scale";
                    return Err(Trouble::new(found, expected));
                }
                (0, 0) => {
                    return Err(Trouble::new(format!("no values among {}", list(names, meanings.len())), CHANNELS));
                }
                _ => return Err(Trouble::new(format!("channels {}", list_of(names, &unknown)), CHANNELS)),
            };
        }
        for name in columns.iter().filter_map(|column| names.get(*column)) {
            let Some(stated) = other_values(name) else { continue };
            if !stated.remedy.is_said(options) {
                return Err(Trouble::new(format!("{} in column {}", stated.found, shown(name)), stated.expected));
            }
        }
        let is_turn = |column: &usize| matches!(meanings[*column], Meaning::Number(number, ..) if number <= FULL_TURN);
        let may_be_azimuths = self.angles[3] == Source::Missing && columns.len() > 1 && columns.iter().all(is_turn);
        let mut channel_names = Vec::new();
        let mut quantities = Vec::new();
        let mut percents = Vec::new();
        for &column in &columns {
            let name = names.get(column).map_or("f", String::as_str);
            match &meanings[column] {
                Meaning::Values { channel, quantity, unit, is_transmission } => {
                    channel_names.push(if channel.is_empty() { "f".to_string() } else { channel.clone() });
                    quantities.push(*quantity);
                    percents.push(unit == "%");
                    if super::quantities::is_signal_unit(unit) && options.scale.is_none() {
                        let found = format!("values in {unit}, in column {}", shown(name));
                        return Err(Trouble::new(found, "f in 1/sr, or the scale that converts to it"));
                    }
                    if *is_transmission {
                        self.holds = Some(Holds::Transmission);
                    }
                }
                // In nm it would be an X-ray, and micrometres are not stated. Without azimuths, it may be one.
                Meaning::Number(number, ..) if *number < SHORTEST || may_be_azimuths => {
                    let found = format!("the name {}, which may be a wavelength or something else", shown(name));
                    return Err(Trouble::new(
                        found,
                        "wavelengths with their unit, such as 550nm or 0.55um, in the names or with columns",
                    ));
                }
                Meaning::Number(number, ..) => {
                    channel_names.push(number.to_string());
                    quantities.push(None);
                    percents.push(false);
                }
                _ => {
                    channel_names.push("f".into());
                    quantities.push(None);
                    percents.push(false);
                }
            }
        }
        let all_same = |list: &[Option<Quantity>]| list.windows(2).all(|pair| pair[0] == pair[1]);
        if !all_same(&quantities) || percents.windows(2).any(|pair| pair[0] != pair[1]) {
            return Err(Trouble::new(
                format!("different quantities in {}", list_of(names, &columns)),
                "values of one kind",
            ));
        }
        self.quantity = quantities.first().copied().flatten();
        self.is_percent = percents.first().copied().unwrap_or(false);
        let wavelength = meanings.iter().enumerate().find_map(|(column, meaning)| match meaning {
            Meaning::Wavelength(nm) => Some((column, *nm)),
            _ => None,
        });
        if let Some((wavelength, nm)) = wavelength {
            let [values] = columns[..] else {
                return Err(Trouble::new(
                    format!("a column of wavelengths, and values in {}", list_of(names, &columns)),
                    "one column of values",
                ));
            };
            self.values = Values::ByWavelength { values, wavelength, nm };
            return Ok(());
        }
        let wanted: Vec<&str> = channel_names.iter().map(String::as_str).collect();
        let channels = channels(&wanted)
            .ok_or_else(|| Trouble::new(format!("channels {}", list_of(names, &columns)), CHANNELS))?;
        if let Channels::Spectral(nm) = &channels
            && has_twice(nm.clone())
        {
            return Err(Trouble::new(format!("a wavelength twice in {}", list_of(names, &columns)), "each once"));
        }
        self.values = Values::Channels(columns, channels);
        Ok(())
    }
}
