//! Writes Zemax tabular BSDFs.

use std::fmt::Write as _;
use std::path::Path;

use lobe_table::{Channels, Scatter, specular};

use super::{AXES, XYZ};
use crate::integra::units::reflectances;
use crate::text::push_row;
use crate::{FormatError, Place};
use lobe_files::write_whole;

/// Writes `path` whole or not at all, over the full circle of phi. The total integrated scatter of each block is
/// computed from its interpolated values over the hemisphere.
///
/// Values have nine significant digits and are restored exactly when they are read again. The format stores angles as
/// `f32` degrees: knots that came from such a file are restored exactly, others within 2e-5 degrees.
///
/// # Errors
/// [`FormatError`] if the file cannot be written, the channels are neither one nor XYZ, the table has refraction
/// offsets, or two knots are equal in `f32` degrees.
pub fn write(samples: &specular::Data, path: &Path) -> Result<(), FormatError> {
    let refuse = |found: String, expected: &str| Err(FormatError::new(path, Place::File, found, expected));
    let (content, names): (_, &[&str]) = match samples.channels() {
        Channels::Mono => ("Monochrome", &["Monochrome"]),
        Channels::Xyz => ("XYZ", &XYZ),
        other => {
            return refuse(format!("the channels {}", other.names().join(" ")), "one channel or X Y Z in this format");
        }
    };
    if samples.refraction().is_some() {
        return refuse("refraction offsets".into(), "none in this format");
    }
    let degrees =
        samples.knots().each_ref().map(|knots| knots.iter().map(|a| a.to_degrees() as f32).collect::<Vec<_>>());
    if degrees.iter().any(|list| list.windows(2).any(|pair| pair[0] >= pair[1])) {
        return refuse("knots that are equal in f32 degrees".into(), "distinct ones");
    }
    let symmetry = if samples.is_isotropic() { "Asymmetrical" } else { "Asymmetrical4D" };
    let kind = if samples.scatter() == Scatter::Reflection { "BRDF" } else { "BTDF" };
    let mut out = format!("Source  Measured\nSymmetry  {symmetry}\nSpectralContent  {content}\nScatterType  {kind}\n");
    for axis in [1, 0, 3, 2] {
        let _ = writeln!(out, "{}  {}", AXES[axis], degrees[axis].len());
        push_row(&mut out, degrees[axis].iter().map(|&angle| f64::from(angle)));
    }
    let [sigmas, _, thetas, phis] = samples.knots().each_ref().map(Vec::len);
    let totals: Vec<Vec<f64>> = reflectances(samples);
    for (channel, name) in names.iter().enumerate() {
        let _ = writeln!(out, "\n{name}\nDataBegin");
        for (slice, total) in totals.iter().enumerate() {
            out.push_str("TIS");
            push_row(&mut out, std::iter::once(total[channel]));
            for h in 0..phis {
                let texel = |t| f64::from(samples.texel([slice % sigmas, slice / sigmas, t, h])[channel]);
                push_row(&mut out, (0..thetas).map(texel));
            }
        }
        out.push_str("DataEnd\n");
    }
    write_whole(path, out.as_bytes())
}
