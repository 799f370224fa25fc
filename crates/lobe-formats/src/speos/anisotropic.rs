//! `.anisotropicbsdf`: tables per rotation of the sample and incident angle, and one spectrum.

use std::f64::consts::PI;

use lobe_table::{Channels, Scatter, scattered};

use super::table::{Source, Table, incident_angles};
use crate::records::Records;
use crate::{FormatError, Sides};

/// A rotation of the sample, in radians, and its incident angles.
struct Rotation {
    phi: f64,
    incidences: Vec<f64>,
}

/// Percentages by wavelength, and the incident direction to which they apply.
struct Spectrum {
    theta: f64,
    phi: f64,
    wavelengths: Vec<f64>,
    percentages: Vec<f64>,
}

pub(super) fn read(source: &mut Source<'_>) -> Result<Sides<scattered::Data>, FormatError> {
    // The vector orients the sample in its scene; in the coordinates of the surface, it is +x.
    source.list(3, "the anisotropy vector")?;
    let sides = [source.flag("whether there is reflection")?, source.flag("whether there is transmission")?];
    let is_intensity = !source.flag("whether values are of the BSDF")?;
    let mut rotations = [None, None];
    let mut spectra = [None, None];
    let mut found = [None, None];
    // Both sides' directions come first, then both spectra, then all tables.
    for side in (0..2).filter(|&side| sides[side]) {
        rotations[side] = Some(read_rotations(source)?);
    }
    for side in (0..2).filter(|&side| sides[side]) {
        spectra[side] = Some(read_spectrum(source)?);
    }
    for (side, scatter) in [Scatter::Reflection, Scatter::Transmission].into_iter().enumerate() {
        if let (Some(rotations), Some(spectrum)) = (&rotations[side], &spectra[side]) {
            found[side] = Some(read_tables(source, is_intensity, scatter, rotations, spectrum)?);
        }
    }
    let [reflection, transmission] = found;
    Ok(Sides { reflection, transmission })
}

fn read_rotations(source: &mut Source<'_>) -> Result<Vec<Rotation>, FormatError> {
    let count = source.count("the number of rotations")?;
    let phis = source.list(count, "a rotation")?;
    let rotation = |phi: f64| {
        let count = source.count("the number of incident angles")?;
        Ok(Rotation { phi: phi.to_radians(), incidences: incident_angles(source, count)? })
    };
    phis.into_iter().map(rotation).collect()
}

fn read_spectrum(source: &mut Source<'_>) -> Result<Spectrum, FormatError> {
    let theta = source.number("the incident angle of the spectrum")?.to_radians();
    let phi = source.number("the rotation of the spectrum")?.to_radians();
    source.line("the end of the line")?;
    source.line("a comment on the spectrum")?;
    let count = source.count("the number of wavelengths")?;
    let (mut wavelengths, mut percentages) = (Vec::new(), Vec::new());
    for _ in 0..count {
        let nm = source.number("a wavelength in nm")?;
        if nm <= 0.0 {
            return Err(source.error(format!("wavelength {nm}"), "a positive number of nm"));
        }
        wavelengths.push(nm);
        percentages.push(source.number("a percentage")?);
    }
    Ok(Spectrum { theta, phi, wavelengths, percentages })
}

fn read_tables(
    source: &mut Source<'_>,
    is_intensity: bool,
    scatter: Scatter,
    rotations: &[Rotation],
    spectrum: &Spectrum,
) -> Result<scattered::Data, FormatError> {
    let mut tables = Vec::new();
    for rotation in rotations {
        for &theta in &rotation.incidences {
            tables.push((rotation.phi, theta, Table::read(source, is_intensity, scatter)?));
        }
    }
    let scale = scale(&tables, spectrum);
    if !(scale.is_finite() && scale > 0.0) {
        return Err(
            source.error("tables without light at the direction of the spectrum", "values with a positive integral")
        );
    }
    // All samples are stored once per wavelength, so a file with many of both would take the square of its size. Files
    // of instruments have a few hundred wavelengths, and write a sample in eight characters or more.
    const VALUES_PER_BYTE: usize = 64;
    let samples: usize = tables.iter().map(|(_, _, table)| table.samples(1.0).count()).sum();
    let most = source.size.saturating_mul(VALUES_PER_BYTE);
    if samples.checked_mul(spectrum.wavelengths.len()).is_none_or(|values| values > most) {
        let found = format!("{samples} samples at {} wavelengths", spectrum.wavelengths.len());
        return Err(source.error(found, format!("at most {most} values in all, {VALUES_PER_BYTE} for each byte")));
    }
    let mut records = Records::default();
    for (rotation, theta_i, table) in &tables {
        for (theta_o, phi, f) in table.samples(scale) {
            let angles = [*theta_i, rotation + PI, theta_o, rotation + phi];
            records.push(angles, spectrum.percentages.iter().map(|percentage| f * percentage / 100.0));
        }
    }
    records.scattered(source.file, scatter, Channels::Spectral(spectrum.wavelengths.clone()))
}

/// The factor that makes the albedo 1 at the incident direction of the spectrum: from the nearest rotation, linear
/// between the two incident angles around it, and constant outside them.
fn scale(tables: &[(f64, f64, Table)], spectrum: &Spectrum) -> f64 {
    let off = |phi: f64| (phi - spectrum.phi).abs();
    let nearest = tables.iter().map(|table| table.0).min_by(|a, b| off(*a).total_cmp(&off(*b)));
    let mut around: Vec<_> = tables.iter().filter(|table| Some(table.0) == nearest).collect();
    around.sort_by(|a, b| a.1.total_cmp(&b.1));
    let upper = around.partition_point(|table| table.1 < spectrum.theta);
    let at = |index: usize| around.get(index).map_or(f64::NAN, |table| 1.0 / table.2.integral());
    match upper {
        0 => at(0),
        upper if upper == around.len() => at(upper - 1),
        upper => {
            let (low, high) = (around[upper - 1].1, around[upper].1);
            let share = (spectrum.theta - low) / (high - low);
            at(upper - 1) * (1.0 - share) + at(upper) * share
        }
    }
}
