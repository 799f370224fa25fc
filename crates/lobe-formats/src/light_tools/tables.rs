//! The tables between `DataBegin` and `DataEnd`.

use std::collections::{BTreeMap, HashSet};

use lobe_table::{Channels, Side};

use super::head::{Head, fact, keep_comments};
use crate::FormatError;
use crate::text::{Text, Token};

/// The key of a table of a measurement. Angles and wavelengths that are not negative are ordered like their bits.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Incidence {
    pub aoi: u64,
    pub poi: u64,
    /// The index of the tristimulus value; or the bits of the wavelength, 0 if the file states none.
    pub channel: u64,
}

/// Tables by their keys, with values in the order of the file.
pub(super) type ByIncidence = BTreeMap<Incidence, Vec<f32>>;

/// Everything after the head.
pub(super) struct Tables {
    /// By the side of the light, and whether they are of a BTDF.
    pub tables: BTreeMap<(Side, bool), ByIncidence>,
    /// Total integrated scatter of each table, in the order of the tables.
    pub tis: Vec<f32>,
    /// Lines and comments for people, each once.
    pub source: Vec<(String, String)>,
    /// `true` if there is a `DataEnd`.
    pub has_end: bool,
}

/// The statements that precede `TIS` and stay in force until they are replaced.
struct State {
    aoi: Option<f64>,
    poi: f64,
    /// The azimuth was stated as a whole turn, which is 0.
    is_turned: bool,
    side: Side,
    is_btdf: bool,
    tristimulus: Option<u64>,
    wavelength: Option<f64>,
    /// Something was stated, and no table has followed yet.
    is_open: bool,
}

/// Reads to `DataEnd`, or to the end of the file if that comes after a table.
pub(super) fn read(text: &mut Text<'_>, head: &Head) -> Result<Tables, FormatError> {
    let size = head.azimuths.len().saturating_mul(head.radials.len());
    let mut found = Tables { tables: BTreeMap::new(), tis: Vec::new(), source: Vec::new(), has_end: false };
    let mut totals = BTreeMap::new();
    let mut facts = HashSet::new();
    let (side, is_btdf) = (Side::Front, false);
    let mut state = State {
        aoi: None,
        poi: 0.0,
        is_turned: false,
        side,
        is_btdf,
        tristimulus: None,
        wavelength: None,
        is_open: true,
    };
    loop {
        let Some(key) = text.next() else {
            if state.is_open {
                return Err(text.error(text.line(), "the end of the file", "`TIS` and its values, or `DataEnd`"));
            }
            break;
        };
        if key.is("DataEnd") {
            found.has_end = true;
            break;
        }
        let is_stated = state.read(text, key)?;
        if is_stated {
            state.is_open = true;
        } else if key.is("TIS") {
            let total = text.value("a total integrated scatter")?;
            let incidence = state.incidence(text, key, &head.channels)?;
            totals.insert((state.side, state.is_btdf, incidence), total);
            text.room(Some(size), "values", key.line)?;
            let mut values = Vec::with_capacity(size);
            for _ in 0..size {
                values.push(text.value("a value")?);
            }
            let by_incidence = found.tables.entry((state.side, state.is_btdf)).or_default();
            // A whole turn of POI may end as it begins.
            let before = by_incidence.get(&incidence);
            if before.is_some_and(|before| !(state.is_turned && *before == values)) {
                let found = format!("a second table of {}", state.name());
                return Err(text.error(key.line, found, "one for each AOI, POI, wavelength or tristimulus value"));
            }
            by_incidence.insert(incidence, values);
            state.is_open = false;
        } else {
            let fact = fact(text, key, "a keyword of a table, or `DataEnd`")?;
            if facts.insert(fact.clone()) {
                found.source.push(fact);
            }
        }
    }
    if let Some(next) = text.peek() {
        return Err(text.unexpected(next, "nothing after `DataEnd`"));
    }
    found.tis = totals.into_values().collect();
    keep_comments(text, &mut found.source);
    if let (Channels::Mono, Some(wavelength)) = (&head.channels, state.wavelength) {
        found.state_wavelength(wavelength);
    }
    Ok(found)
}

impl Tables {
    /// A single wavelength is a fact; several are channels.
    fn state_wavelength(&mut self, wavelength: f64) {
        let mut incidences = self.tables.values().flat_map(BTreeMap::keys);
        if incidences.all(|incidence| incidence.channel == wavelength.to_bits()) {
            self.source.push(("Wavelength".into(), format!("{wavelength} nm")));
        }
    }
}

impl State {
    /// Reads the statement of a keyword. `false` if the word is not a keyword.
    fn read(&mut self, text: &mut Text<'_>, key: Token<'_>) -> Result<bool, FormatError> {
        if key.is("AOI") {
            let angle = text.number("an angle of incidence")?;
            if !(0.0..=90.0).contains(&angle) {
                return Err(text.error(text.line(), format!("AOI {angle}"), "0 to 90 degrees"));
            }
            self.aoi = Some(angle + 0.0);
        } else if key.is("POI") {
            let angle = text.number("the azimuth of the plane of incidence")?;
            if !(-360.0..=360.0).contains(&angle) {
                return Err(text.error(text.line(), format!("POI {angle}"), "-360 to 360 degrees"));
            }
            // Adding zero removes the sign of a zero.
            self.poi = angle.rem_euclid(360.0) + 0.0;
            self.is_turned = angle.abs() == 360.0;
        } else if key.is("Wavelength") {
            self.wavelength = Some(wavelength(text)?);
        } else if key.is("Side") {
            let value = text.expect("a side")?;
            self.side = match () {
                () if value.is("Front") => Side::Front,
                () if value.is("Back") => Side::Back,
                () => return Err(text.unexpected(value, "Front or Back")),
            };
        } else if key.is("ScatterType") {
            let value = text.expect("a kind of scatter")?;
            self.is_btdf = value.is("BTDF");
            if !(self.is_btdf || value.is("BRDF")) {
                return Err(text.unexpected(value, "BRDF or BTDF"));
            }
        } else if key.is("TristimulusValue") {
            let value = text.expect("a tristimulus value")?;
            let index = (0..).zip(["TrisX", "TrisY", "TrisZ"]).find(|(_, name)| value.is(name));
            let (index, _) = index.ok_or_else(|| text.unexpected(value, "TrisX, TrisY or TrisZ"))?;
            self.tristimulus = Some(index);
        } else {
            return Ok(false);
        }
        Ok(true)
    }

    /// The key of the following table.
    fn incidence(&self, text: &Text<'_>, key: Token<'_>, channels: &Channels) -> Result<Incidence, FormatError> {
        let Some(aoi) = self.aoi else {
            return Err(text.unexpected(key, "AOI first"));
        };
        let channel = match channels {
            Channels::Mono => self.wavelength.map_or(0, f64::to_bits),
            _ => self.tristimulus.ok_or_else(|| text.unexpected(key, "TristimulusValue first"))?,
        };
        Ok(Incidence { aoi: aoi.to_bits(), poi: self.poi.to_bits(), channel })
    }

    fn name(&self) -> String {
        let wavelength = self.wavelength.map_or(String::new(), |nm| format!(", {nm} nm"));
        format!("AOI {}, POI {}{wavelength}", self.aoi.unwrap_or_default(), self.poi)
    }
}

/// A wavelength in nm; its unit may follow, with or without a space.
fn wavelength(text: &mut Text<'_>) -> Result<f64, FormatError> {
    const UNITS: [(&str, f64); 4] = [("nm", 1.0), ("um", 1e3), ("\u{b5}m", 1e3), ("\u{3bc}m", 1e3)];
    let token = text.expect("a wavelength")?;
    let word = token.text().to_lowercase();
    let ending = UNITS.iter().find_map(|(unit, scale)| Some((word.strip_suffix(unit)?, scale)));
    let next = text.peek().filter(|next| next.line == token.line).map(|next| next.text().to_lowercase());
    let (digits, scale) = match (ending, next.and_then(|next| UNITS.iter().find(|(unit, _)| next == *unit))) {
        (Some((digits, scale)), _) => (digits, scale),
        (None, Some((_, scale))) => {
            text.next();
            (word.as_str(), scale)
        }
        (None, None) => (word.as_str(), &1.0),
    };
    let nm = digits.parse().ok().map(|number: f64| number * scale).filter(|nm| nm.is_finite() && *nm > 0.0);
    nm.ok_or_else(|| text.unexpected(token, "a wavelength in nm"))
}
