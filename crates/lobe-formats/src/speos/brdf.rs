//! `.brdf`: a table, and an albedo, for every incident angle and wavelength.

use std::f64::consts::PI;

use lobe_table::{Scatter, scattered};

use super::table::{Source, Table, incident_angles};
use crate::records::ByWavelength;
use crate::{FormatError, Sides};

pub(super) fn read(source: &mut Source<'_>) -> Result<Sides<scattered::Data>, FormatError> {
    let sides = [source.flag("whether there is reflection")?, source.flag("whether there is transmission")?];
    let is_intensity = !source.flag("whether values are of the BSDF")?;
    let (incidences, wavelengths) =
        (source.count("the number of incident angles")?, source.count("the number of wavelengths")?);
    let incidences = incident_angles(source, incidences)?;
    let wavelengths = source.list(wavelengths, "a wavelength in nm")?;
    if let Some(nm) = wavelengths.iter().find(|nm| **nm <= 0.0) {
        return Err(source.error(format!("wavelength {nm}"), "a positive number of nm"));
    }
    let mut found = [None, None];
    for ((has_side, scatter), found) in
        sides.into_iter().zip([Scatter::Reflection, Scatter::Transmission]).zip(&mut found)
    {
        if !has_side {
            continue;
        }
        let mut samples = ByWavelength::default();
        for &theta_i in &incidences {
            for &nm in &wavelengths {
                let percentage = source.number("a percentage")?;
                let table = Table::read(source, is_intensity, scatter)?;
                let integral = table.integral();
                // A table without light stays 0, whatever the percentage.
                let scale = match integral > 0.0 {
                    true => percentage / 100.0 / integral,
                    false if table.is_black() => 0.0,
                    false => {
                        let found = format!("a table whose integral is {integral}");
                        return Err(source.error(found, "a positive integral, which the percentage scales"));
                    }
                };
                for (theta_o, phi, f) in table.samples(scale) {
                    samples.push(nm, [theta_i, 0.0, theta_o, phi + PI], f);
                }
            }
        }
        *found = Some(samples.scattered(source.file, scatter)?);
    }
    let [reflection, transmission] = found;
    Ok(Sides { reflection, transmission })
}
