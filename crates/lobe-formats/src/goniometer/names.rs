//! The meaning of the names of columns: an angle and its unit, or values.

use super::angles::side;
use super::meaning::{Meaning, Name};
use super::quantities::{COLOURS, LENGTHS, SIGNALS, is_signal_unit, nanometres};
use super::stated::is_percent;
use super::words::{FILLERS, OF_NO_VALUE, WHOLE};
use crate::angle::Unit;

/// The meaning of the name of a column.
pub(crate) fn meaning(name: &str) -> Meaning {
    let name = Name::new(name);
    if let Some(angle) = name.whole_angle() {
        return angle;
    }
    // Colours for people, in spaces that are not linear.
    if ["l*", "a*", "b*", "c*", "h*", "u*", "v*"].contains(&name.text.as_str()) {
        return Meaning::Signal;
    }
    name.wavelength().or_else(|| name.number()).or_else(|| name.values()).unwrap_or_else(|| {
        let is = |list: &[&str]| name.words.iter().any(|word| list.contains(&word.as_str()));
        match () {
            () if is(OF_NO_VALUE) => Meaning::NoValue,
            () if is(SIGNALS) || name.text == "i/f" || is_signal_unit(&name.unit) => Meaning::Signal,
            () => Meaning::Unknown,
        }
    })
}

impl Name {
    pub(super) fn new(text: &str) -> Self {
        let text = text.trim().trim_matches('"');
        let mut spelled = String::new();
        let mut before = ' ';
        for c in text.chars() {
            // `thetaIn` is two words; `BRDF` is one, and so is `nm`.
            if c.is_uppercase() && before.is_lowercase() {
                spelled.push(' ');
            }
            match c {
                'θ' | 'ϑ' | 'Θ' => spelled.push_str(" theta "),
                'φ' | 'ϕ' | 'Φ' => spelled.push_str(" phi "),
                'λ' => spelled.push_str(" lambda "),
                // Signs that look like that of degrees.
                'º' | '˚' => spelled.push('°'),
                'Δ' => spelled.push_str(" delta "),
                'ᵢ' => spelled.push_str(" i"),
                'ₒ' => spelled.push_str(" o"),
                'ᵣ' => spelled.push_str(" r"),
                'ₛ' => spelled.push_str(" s"),
                _ => spelled.extend(c.to_lowercase()),
            }
            before = c;
        }
        let mut spelled = spelled.trim().to_string();
        let (mut unit, mut angle_unit) = (String::new(), None);
        if let Some((open, close)) = [('[', ']'), ('(', ')')].into_iter().find(|(_, close)| spelled.ends_with(*close))
            && let Some((head, inner)) = spelled.trim_end_matches(close).rsplit_once(open)
        {
            let inner = inner.trim().trim_start_matches("in ");
            angle_unit = inner.parse().ok();
            if angle_unit.is_some() || !is_part_of_a_name(inner) {
                unit = if is_percent(inner) { "%".into() } else { inner.to_string() };
                spelled = head.trim().to_string();
            }
        }
        let is_apart = |c: char| !(c.is_alphanumeric() || c == '.' || c == '°' || c == '%');
        let mut words: Vec<String> = spelled.split(is_apart).filter(|w| !w.is_empty()).map(String::from).collect();
        if angle_unit.is_none() && words.len() > 1 {
            angle_unit = words.last().and_then(|word| word.parse().ok());
            if angle_unit.is_some()
                && let Some(unit) = words.pop()
                && let Some(at) = spelled.rfind(&unit)
            {
                // Signs and letters of several bytes may follow.
                spelled.truncate(at);
                spelled.truncate(spelled.trim_end_matches(is_apart).len());
            }
        }
        if unit.is_empty() && words.len() > 1 && words.last().is_some_and(|word| is_percent(word)) {
            unit = "%".into();
            words.pop();
            if words.last().is_some_and(|word| word == "in" || word == "per") {
                words.pop();
            }
        }
        if let Some(last) = words.last_mut()
            && let Some(short) = last.strip_suffix('°')
        {
            angle_unit = Some(Unit::Deg);
            *last = short.into();
        }
        words.retain(|word| !FILLERS.contains(&word.as_str()) && !word.is_empty());
        let compact = words.concat();
        Name { words, compact, text: spelled, unit, angle_unit }
    }

    /// An angle, named by one word or by several.
    fn whole_angle(&self) -> Option<Meaning> {
        let whole = WHOLE.iter().find(|(word, _)| *word == self.compact);
        whole.map(|(_, angle)| Meaning::Angle(*angle, self.angle_unit)).or_else(|| self.angle())
    }

    /// A name that is a number, perhaps after the name of an angle: `30`, `-30°`, `theta_i=30`, `AOI 10`.
    fn number(&self) -> Option<Meaning> {
        if LENGTHS.contains(&self.unit.as_str()) {
            return None;
        }
        let number = |word: &str| {
            let word = word.trim().trim_end_matches('°').replace(',', ".");
            word.parse().ok().filter(|number: &f64| number.is_finite())
        };
        if let Some(found) = number(&self.text) {
            return Some(Meaning::Number(found, self.angle_unit, None));
        }
        let (head, tail) = self.text.rsplit_once(['=', ':', ' ', '_'])?;
        let value = number(tail)?;
        // Do not look for a number in the head again: a name may have as many separators as a line has characters.
        match Name::new(head).whole_angle()? {
            Meaning::Angle(angle, unit) => Some(Meaning::Number(value, self.angle_unit.or(unit), Some(angle))),
            _ => None,
        }
    }
}

/// `true` if the text in brackets belongs to the name: `theta (in)`, `f(450 nm)`, `BRDF (R)`.
fn is_part_of_a_name(inner: &str) -> bool {
    let word = inner.trim();
    side(word).is_some()
        || COLOURS.iter().any(|names| names.contains(&word))
        || nanometres(&word.replace(' ', ""), "").is_some()
        || ["incident", "scattered", "reflected"].contains(&word)
}
