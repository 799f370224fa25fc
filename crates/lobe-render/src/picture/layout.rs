//! The names of channels in spectral pictures: A. Fichet, R. Pacanowski, A. Wilkie, "An OpenEXR Layout for Spectral
//! Images", JCGT 10(3), 2021.

/// A channel of a spectral picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Name {
    /// `S0.550nm` to `S3.550nm`: a Stokes component of radiance at a wavelength in nm.
    Stokes(usize, f64),
    /// `S0.R` and so on: a Stokes component of red, green or blue, as `lobe render` writes without wavelengths.
    Colour(usize, usize),
    /// `T.550nm`: a share of light at a wavelength in nm.
    Share(f64),
    /// `T.450nm.550nm`: light that changes its wavelength.
    Fluorescence,
}

impl Name {
    /// The meaning of a name; `None` if it belongs to no spectrum.
    pub(super) fn of(name: &str) -> Option<Self> {
        if let Some(rest) = name.strip_prefix("T.") {
            return match rest.split_once('.') {
                Some((from, to)) if wavelength(from).is_some() && wavelength(to).is_some() => Some(Name::Fluorescence),
                _ => wavelength(rest).map(Name::Share),
            };
        }
        let (component, rest) = name.split_once('.')?;
        let component = ["S0", "S1", "S2", "S3"].into_iter().position(|known| known == component)?;
        match ["R", "G", "B"].into_iter().position(|known| known == rest) {
            Some(colour) => Some(Name::Colour(component, colour)),
            None => wavelength(rest).map(|nm| Name::Stokes(component, nm)),
        }
    }
}

/// SI prefixes, with their powers of ten.
const PREFIXES: [(&str, i32); 21] = [
    ("", 0),
    ("Y", 24),
    ("Z", 21),
    ("E", 18),
    ("P", 15),
    ("T", 12),
    ("G", 9),
    ("M", 6),
    ("k", 3),
    ("h", 2),
    ("da", 1),
    ("d", -1),
    ("c", -2),
    ("m", -3),
    ("u", -6),
    ("n", -9),
    ("p", -12),
    ("f", -15),
    ("a", -18),
    ("z", -21),
    ("y", -24),
];

/// The speed of light in nm/s.
const LIGHT: f64 = 299_792_458e9;

/// A wavelength or a frequency such as `550nm`, `0,55um` or `545THz`, in nm.
fn wavelength(text: &str) -> Option<f64> {
    let (rest, is_frequency) = match text.strip_suffix("Hz") {
        Some(rest) => (rest, true),
        None => (text.strip_suffix('m')?, false),
    };
    let scaled = |(prefix, power): (&str, i32)| {
        let number = rest.strip_suffix(prefix)?;
        // Words such as `inf` are numbers to Rust.
        let is_number = number.starts_with(|c: char| c.is_ascii_digit() || c == ',');
        let number: f64 = number.replace(',', ".").parse().ok().filter(|_| is_number)?;
        let nm = match is_frequency {
            true => LIGHT / (number * 10_f64.powi(power)),
            false => number * 10_f64.powi(power + 9),
        };
        (nm > 0.0 && nm.is_finite()).then_some(nm)
    };
    PREFIXES.into_iter().find_map(scaled)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_the_layout_are_understood() {
        for (name, expected) in [
            ("S0.550nm", Name::Stokes(0, 550.0)),
            ("S3.512,5nm", Name::Stokes(3, 512.5)),
            ("S1.5,5E2nm", Name::Stokes(1, 550.0)),
            ("S2.B", Name::Colour(2, 2)),
            ("T.400nm", Name::Share(400.0)),
            ("T.400nm.500nm", Name::Fluorescence),
        ] {
            assert_eq!(Name::of(name), Some(expected), "{name}");
        }
        for (name, nm) in [("S0.0,55um", 550.0), ("S0.545,077196THz", 550.0), ("S0.5,5e-7m", 550.0)] {
            let Some(Name::Stokes(0, found)) = Name::of(name) else { panic!("{name}") };
            assert!((found - nm).abs() < 1e-6, "{name}: {found}");
        }
        for name in ["S0", "S4.550nm", "S0.nm", "S0.-5nm", "S0.0nm", "S0.infnm", "T.a.b", "R", "S0.550", "depth.Z"] {
            assert_eq!(Name::of(name), None, "{name}");
        }
    }
}
