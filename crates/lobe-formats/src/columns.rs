//! The meaning of the names of value columns.

use lobe_table::Channels;

/// The channels that columns with these names hold: `R,G,B`, `X,Y,Z`, wavelengths in nm (`550` or `550nm`), or one
/// column with any other name. `None` for other sets of names.
pub(crate) fn channels(names: &[&str]) -> Option<Channels> {
    let is = |wanted: [&str; 3]| names.len() == 3 && names.iter().zip(wanted).all(|(a, b)| a.eq_ignore_ascii_case(b));
    let wavelength = |name: &&str| {
        let digits = name.strip_suffix("nm").or_else(|| name.strip_suffix("NM")).unwrap_or(name);
        digits.trim().parse().ok().filter(|nm: &f64| nm.is_finite() && *nm > 0.0)
    };
    match names {
        [] => None,
        _ if is(["R", "G", "B"]) => Some(Channels::Rgb),
        _ if is(["X", "Y", "Z"]) => Some(Channels::Xyz),
        _ => match names.iter().map(wavelength).collect::<Option<Vec<f64>>>() {
            Some(wavelengths) => Some(Channels::Spectral(wavelengths)),
            None if names.len() == 1 => Some(Channels::Mono),
            None => None,
        },
    }
}
