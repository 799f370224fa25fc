//! The sides of a sheet, as matrices over patches.

use lobe_model::Surface;
use lobe_model::goniometer::klems as patches;
use lobe_table::Channels;
use lobe_table::window::klems::{AngleBasis, KlemsError};
use lobe_table::window::{Band, Blocks, Component, Data};

use super::Sides;

/// The blocks of a sheet that are not dark.
pub(super) fn measure(
    surface: &dyn Surface,
    basis: &AngleBasis,
    sides: Sides,
    progress: impl Fn() + Sync,
) -> Result<Data, KlemsError> {
    let names: Vec<String> = match surface.channels() {
        // Radiance uses X and Z in addition to Visible for colour.
        Channels::Xyz => ["CIE-X", "Visible", "CIE-Z"].map(String::from).into(),
        Channels::Mono => vec!["Visible".into()],
        other => other.names(),
    };
    let mut bands: Vec<Band> =
        names.into_iter().map(|wavelength| Band { wavelength, window: Blocks::default() }).collect();
    for block in sides.blocks() {
        let matrices = patches::measure(surface, [basis, basis], block, &progress)?;
        if matrices.iter().all(|matrix| matrix.values().iter().all(|f| *f == 0.0)) {
            continue;
        }
        for (band, matrix) in bands.iter_mut().zip(matrices) {
            band.window.set(block, Component::Klems(matrix));
        }
    }
    Ok(Data { bands })
}
