//! Which column of a table holds what.

use lobe_table::Channels;

use super::facts::Facts;
use super::names::{Angle, Meaning, Unit, meaning};
use crate::columns::channels;
use crate::lines::shown;
use crate::reading::{Content, Holds, Position, Quantity, ReadOptions};

/// Where an angle of a row is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Source {
    /// In a column, in the unit that its name states.
    Column(usize, Option<Unit>),
    /// In a line above the rows, or in what the user says.
    Fixed(f64, Option<Unit>),
    /// Each column of values has one of its own.
    Wide,
    Missing,
}

/// Where values are found.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Values {
    /// In a column per channel.
    Channels(Vec<usize>, Channels),
    /// In a column per value of an angle, with its unit.
    Wide(Vec<(usize, f64)>, Option<Unit>),
    /// In one column, for the wavelength of the row: its column, and what makes nm of it.
    ByWavelength { values: usize, wavelength: usize, nm: f64 },
}

/// Which column holds what.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub is_specular: bool,
    /// `theta_i`, `phi_i`, `theta_o`, `phi_o`, or `sigma`, `psi`, `theta`, `phi`.
    pub angles: [Source; 4],
    /// Whether an angle may change between the rows, as it is in a line of its own.
    pub is_from_facts: [bool; 4],
    pub values: Values,
    /// What the names say about the values.
    pub quantity: Option<Quantity>,
    /// Values are in hundredths.
    pub is_percent: bool,
    pub holds: Option<Holds>,
    /// Columns that are not read although they may matter: rows of the same directions must not differ in them.
    pub watched: Vec<usize>,
    pub notes: Vec<String>,
}

/// What a table lacks: what was found, and what was expected.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Trouble {
    pub found: String,
    pub expected: String,
}

impl Trouble {
    pub fn new(found: impl Into<String>, expected: impl Into<String>) -> Self {
        Trouble { found: found.into(), expected: expected.into() }
    }
}

pub(super) const SPHERICAL: [Angle; 4] = [Angle::ThetaI, Angle::PhiI, Angle::ThetaO, Angle::PhiO];
pub(super) const SPECULAR: [Angle; 4] = [Angle::Sigma, Angle::Psi, Angle::Theta, Angle::Phi];

const WANTED: &str =
    "theta_i and theta_o, with phi_o unless the viewer stays in the plane of incidence, or sigma, theta and phi";
const CHANNELS: &str = "R, G, B or X, Y, Z or wavelengths such as 550nm or one column such as BRDF";

/// What the names of columns say, with what the user says instead.
pub(super) fn meanings(names: &[String], width: usize, options: &ReadOptions) -> Result<Vec<Meaning>, Trouble> {
    let mut meanings: Vec<Meaning> = names.iter().map(|name| meaning(corner(name))).collect();
    meanings.resize(width.max(names.len()), Meaning::Unknown);
    let mut chosen = vec![None; meanings.len()];
    for column in &options.columns {
        let index = match &column.at {
            Position::Fixed(..) => continue,
            Position::Number(number) if *number <= meanings.len() => number - 1,
            Position::Named(name) => names
                .iter()
                .position(|other| other.trim().eq_ignore_ascii_case(name))
                .ok_or_else(|| Trouble::new(format!("no column {name:?} as in {column}"), named(names)))?,
            Position::Number(_) => {
                return Err(Trouble::new(
                    format!("{column} in rows of {} columns", meanings.len()),
                    "a column that is there",
                ));
            }
        };
        let stated = meanings[index].clone();
        let meaning = match &column.content {
            Content::Angle(angle) => Meaning::Angle(*angle, stated.unit()),
            Content::Wavelength => match stated {
                Meaning::Wavelength(nm) => Meaning::Wavelength(nm),
                _ => Meaning::Wavelength(1.0),
            },
            Content::Values(name) => match (meaning(name), stated) {
                (Meaning::Values { channel, quantity, is_transmission, .. }, Meaning::Values { unit, .. }) => {
                    Meaning::Values { channel, quantity, is_transmission, unit }
                }
                (Meaning::Values { channel, quantity, is_transmission, unit }, _) => {
                    Meaning::Values { channel, quantity, is_transmission, unit }
                }
                _ => Meaning::Values {
                    channel: name.clone(),
                    quantity: None,
                    unit: String::new(),
                    is_transmission: false,
                },
            },
        };
        if chosen[index].replace(meaning).is_some() {
            return Err(Trouble::new(format!("column {} twice, again as {column}", index + 1), "each column once"));
        }
    }
    let has_values = options.columns.iter().any(|column| matches!(column.content, Content::Values(_)));
    let is_chosen = |angle: Angle| options.columns.iter().any(|column| column.content == Content::Angle(angle));
    for (meaning, chosen) in meanings.iter_mut().zip(chosen) {
        match (chosen, &*meaning) {
            (Some(chosen), _) => *meaning = chosen,
            (None, Meaning::Angle(angle, _)) if !is_chosen(*angle) => {}
            (None, Meaning::EitherTheta(_) | Meaning::EitherPhi(_) | Meaning::AnyAngle(_)) => {}
            // A column that the user passes over when naming others.
            (None, Meaning::Angle(..)) => *meaning = Meaning::NoValue,
            (None, Meaning::Wavelength(_)) => {}
            (None, _) if has_values => *meaning = Meaning::NoValue,
            (None, _) => {}
        }
    }
    Ok(meanings)
}

/// The corner of a table with a column per angle names both: `theta_o \\ theta_i`. Its own column holds the first.
fn corner(name: &str) -> &str {
    match name.split_once(['\\', '/']) {
        Some((rows, columns)) if [rows, columns].iter().all(|part| matches!(meaning(part), Meaning::Angle(..))) => rows,
        _ => name,
    }
}

/// The names of a table for an error.
fn named(names: &[String]) -> String {
    let shown: Vec<String> =
        names.iter().take(12).enumerate().map(|(i, name)| format!("{}: {}", i + 1, shown(name))).collect();
    let more = if names.len() > 12 { format!(" and {} more", names.len() - 12) } else { String::new() };
    format!("one of the columns {}{more}", shown.join(", "))
}

impl Layout {
    /// The layout of a table whose columns have these meanings. `is_text` says which of them hold words.
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
        let used = layout.used();
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
            let is_said = options.values.is_some() || options.scale.is_some();
            columns = match (unknown.len(), signals.len()) {
                (1, 0) => unknown,
                (0, 1) | (1, 1) if is_said => signals,
                (_, 1..) => {
                    let found = format!("values called {}", list_of(names, &signals));
                    let expected =
                        "f in 1/sr, as BRDF, or what they are: values = f, luminance-factor or f-cos, and scale";
                    return Err(Trouble::new(found, expected));
                }
                (0, 0) => {
                    return Err(Trouble::new(format!("no values among {}", list(names, meanings.len())), CHANNELS));
                }
                _ => return Err(Trouble::new(format!("channels {}", list_of(names, &unknown)), CHANNELS)),
            };
        }
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
                    if super::names::is_signal_unit(unit) && options.scale.is_none() {
                        let found = format!("values in {unit}, in column {}", shown(name));
                        return Err(Trouble::new(found, "f in 1/sr, or the scale that makes it of them"));
                    }
                    if *is_transmission {
                        self.holds = Some(Holds::Transmission);
                    }
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
            && (1..nm.len()).any(|i| nm[..i].contains(&nm[i]))
        {
            return Err(Trouble::new(format!("a wavelength twice in {}", list_of(names, &columns)), "each once"));
        }
        self.values = Values::Channels(columns, channels);
        Ok(())
    }
}

/// Whether columns with these meanings say where the light and the viewer are.
pub(super) fn has_directions(mut meanings: Vec<Meaning>, facts: &Facts) -> bool {
    let is_fixed = |angle: Angle| facts.angles.iter().any(|fixed| fixed.angle == angle);
    settle(&mut meanings, is_fixed);
    let is_column = |angle: Angle| meanings.iter().any(|m| matches!(m, Meaning::Angle(other, _) if *other == angle));
    let has = |angle: Angle| is_fixed(angle) || is_column(angle);
    let numbers = meanings.iter().filter(|meaning| matches!(meaning, Meaning::Number(..))).count();
    let is_wide = numbers >= 2 && (is_column(Angle::ThetaI) || is_column(Angle::ThetaO));
    let has_viewer = is_column(Angle::ThetaO) || is_column(Angle::ThetaI) || is_column(Angle::Theta);
    let is_known =
        (has(Angle::ThetaI) && has(Angle::ThetaO)) || [Angle::Sigma, Angle::Theta, Angle::Phi].into_iter().all(has);
    is_wide || (has_viewer && is_known)
}

/// Gives names that may mean either direction, or none, the one that the others leave.
fn settle(meanings: &mut [Meaning], is_fixed: impl Fn(Angle) -> bool) {
    let has = |meanings: &[Meaning], angle: Angle| {
        is_fixed(angle) || meanings.iter().any(|m| matches!(m, Meaning::Angle(other, _) if *other == angle))
    };
    let light_is_known = has(meanings, Angle::ThetaI);
    let viewer_is_known = has(meanings, Angle::ThetaO);
    let [theta, phi] = match (light_is_known, viewer_is_known) {
        (true, false) => [Angle::ThetaO, Angle::PhiO],
        (false, true) => [Angle::ThetaI, Angle::PhiI],
        _ => return,
    };
    // `theta` and `phi` next to `theta_i`.
    let is_specular = has(meanings, Angle::Sigma);
    for meaning in meanings.iter_mut() {
        *meaning = match meaning {
            Meaning::EitherTheta(unit) => Meaning::Angle(theta, *unit),
            Meaning::EitherPhi(unit) => Meaning::Angle(phi, *unit),
            Meaning::AnyAngle(unit) if light_is_known => Meaning::Angle(theta, *unit),
            Meaning::Angle(Angle::Theta, unit) if light_is_known && !is_specular => Meaning::Angle(theta, *unit),
            Meaning::Angle(Angle::Phi, unit) if light_is_known && !is_specular => Meaning::Angle(phi, *unit),
            _ => continue,
        };
    }
}

/// The columns of a table with one per incident or outgoing polar angle, if it is one: all that have numbers as names.
type Wide = (Vec<(usize, f64)>, Option<Unit>);

fn wide(meanings: &[Meaning], angles: &mut [Source; 4]) -> Option<Wide> {
    let numbers = meanings.iter().enumerate().filter_map(|(column, meaning)| match meaning {
        Meaning::Number(number, unit, angle) => Some((column, *number, *unit, *angle)),
        _ => None,
    });
    let numbers: Vec<_> = numbers.collect();
    let &(_, _, unit, angle) = numbers.first()?;
    let missing = match (angles[0] == Source::Missing, angles[2] == Source::Missing) {
        (true, false) => 0,
        (false, true) => 2,
        _ => return None,
    };
    let fits = |&(_, number, of, which): &(usize, f64, Option<Unit>, Option<Angle>)| {
        of == unit && which == angle && which.is_none_or(|angle| angle == SPHERICAL[missing]) && number.abs() <= 90.0
    };
    let has_values = meanings.iter().any(|meaning| matches!(meaning, Meaning::Values { .. }));
    if has_values
        || !numbers.iter().all(fits)
        || (1..numbers.len()).any(|i| numbers[..i].iter().any(|other| other.1 == numbers[i].1))
    {
        return None;
    }
    angles[missing] = Source::Wide;
    Some((numbers.into_iter().map(|(column, number, ..)| (column, number)).collect(), unit))
}

/// Names for an error.
fn list(names: &[String], width: usize) -> String {
    match names.is_empty() {
        true => format!("{width} columns without names"),
        false => list_of(names, &(0..names.len()).collect::<Vec<_>>()),
    }
}

fn list_of(names: &[String], columns: &[usize]) -> String {
    let name = |column: &usize| names.get(*column).map_or_else(|| format!("column {}", column + 1), |name| shown(name));
    let shown: Vec<String> = columns.iter().take(12).map(name).collect();
    let more = if columns.len() > 12 { format!(" and {} more", columns.len() - 12) } else { String::new() };
    format!("{}{more}", shown.join(", "))
}
