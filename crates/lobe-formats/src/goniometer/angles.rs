//! Names of angles.

use super::meaning::{Meaning, Name};
use super::words::{AZIMUTHS, INCOMING, OUTGOING, POLARS, RELATIVE};
use crate::angle::Angle;

impl Name {
    /// An angle, if each word belongs to one.
    pub fn angle(&self) -> Option<Meaning> {
        let (mut is_polar, mut is_azimuth, mut is_angle, mut is_relative) = (false, false, false, false);
        let mut sides: Vec<Side> = Vec::new();
        for word in &self.words {
            let word = word.as_str();
            match () {
                () if POLARS.contains(&word) => is_polar = true,
                () if AZIMUTHS.contains(&word) => is_azimuth = true,
                () if ["angle", "angles", "ang", "winkel"].contains(&word) => is_angle = true,
                () if RELATIVE.contains(&word) => is_relative = true,
                () => match side(word) {
                    Some(side) => sides.push(side),
                    None => {
                        // One word for both, as in `thetai` and `Einfallswinkel`.
                        let (part, kind) = parted(word)?;
                        match kind {
                            Kind::Polar => is_polar = true,
                            Kind::Azimuth => is_azimuth = true,
                            Kind::Angle => is_angle = true,
                        }
                        match side(part) {
                            Some(side) => sides.push(side),
                            None if RELATIVE.contains(&part) => is_relative = true,
                            None => return None,
                        }
                    }
                },
            }
        }
        let unit = self.angle_unit;
        let side = match sides[..] {
            [] => None,
            [first, ref others @ ..] if others.iter().all(|other| *other == first) => Some(first),
            _ => return None,
        };
        match (is_polar, is_azimuth, side) {
            (true, true, _) => None,
            (_, true, None) if is_relative => Some(Meaning::Angle(Angle::PhiO, unit)),
            _ if is_relative => None,
            (_, true, Some(Side::Light)) => Some(Meaning::Angle(Angle::PhiI, unit)),
            (_, true, Some(Side::Viewer)) => Some(Meaning::Angle(Angle::PhiO, unit)),
            (_, true, Some(Side::Either)) => Some(Meaning::EitherPhi(unit)),
            (true, _, Some(Side::Light)) => Some(Meaning::Angle(Angle::ThetaI, unit)),
            (true, _, Some(Side::Viewer)) => Some(Meaning::Angle(Angle::ThetaO, unit)),
            (true, _, Some(Side::Either)) => Some(Meaning::EitherTheta(unit)),
            // A single letter next to `angle` says too little.
            (_, _, Some(Side::Light)) if is_angle && self.is_spelled() => Some(Meaning::Angle(Angle::ThetaI, unit)),
            (_, _, Some(Side::Viewer)) if is_angle && self.is_spelled() => Some(Meaning::Angle(Angle::ThetaO, unit)),
            (true, _, None) if self.compact == "theta" => Some(Meaning::Angle(Angle::Theta, unit)),
            (_, true, None) if self.compact == "phi" => Some(Meaning::Angle(Angle::Phi, unit)),
            (_, true, None) => Some(Meaning::Angle(Angle::PhiO, unit)),
            (true, _, None) => Some(Meaning::AnyAngle(unit)),
            (_, _, None) if is_angle => Some(Meaning::AnyAngle(unit)),
            _ => None,
        }
    }

    fn is_spelled(&self) -> bool {
        self.words.iter().all(|word| word.len() > 1)
    }
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Side {
    Light,
    Viewer,
    Either,
}

enum Kind {
    Polar,
    Azimuth,
    Angle,
}

pub(super) fn side(word: &str) -> Option<Side> {
    match word {
        "s" => Some(Side::Either),
        _ if INCOMING.contains(&word) => Some(Side::Light),
        _ if OUTGOING.contains(&word) => Some(Side::Viewer),
        _ => None,
    }
}

/// The part of a compound word that names the direction, and the kind of angle that the rest names.
fn parted(word: &str) -> Option<(&str, Kind)> {
    for (prefix, kind) in [
        ("theta", Kind::Polar),
        ("phi", Kind::Azimuth),
        ("azimuth", Kind::Azimuth),
        ("azimut", Kind::Azimuth),
        ("zenith", Kind::Polar),
        ("th", Kind::Polar),
    ] {
        if let Some(rest) = word.strip_prefix(prefix)
            && (side(rest).is_some() || RELATIVE.contains(&rest))
        {
            return Some((rest, kind));
        }
    }
    for (suffix, kind) in [
        ("swinkel", Kind::Angle),
        ("winkel", Kind::Angle),
        ("angle", Kind::Angle),
        ("theta", Kind::Polar),
        ("phi", Kind::Azimuth),
    ] {
        if let Some(rest) = word.strip_suffix(suffix)
            && (side(rest).is_some() || RELATIVE.contains(&rest))
        {
            return Some((rest, kind));
        }
    }
    None
}
