//! The sides of a sheet, as matrices over patches or as trees.

use lobe_table::Channels;
use lobe_table::window::{Band, Block, Blocks, Component, Data};

use super::Sides;

/// The blocks of a sheet that are not dark; `measure` gives the blocks of all channels.
pub(super) fn measure<E>(
    channels: &Channels,
    sides: Sides,
    progress: &(dyn Fn() + Sync),
    measure: impl Fn(Block, &(dyn Fn() + Sync)) -> Result<Vec<Component>, E>,
) -> Result<Data, E> {
    let names: Vec<String> = match channels {
        // Radiance uses X and Z in addition to Visible for colour.
        Channels::Xyz => ["CIE-X", "Visible", "CIE-Z"].map(String::from).into(),
        Channels::Mono => vec!["Visible".into()],
        other => other.names(),
    };
    let mut bands: Vec<Band> =
        names.into_iter().map(|wavelength| Band { wavelength, window: Blocks::default() }).collect();
    for block in sides.blocks() {
        let components = measure(block, progress)?;
        if components.iter().all(|component| values(component).iter().all(|f| *f == 0.0)) {
            continue;
        }
        for (band, component) in bands.iter_mut().zip(components) {
            band.window.set(block, component);
        }
    }
    Ok(Data { bands })
}

fn values(component: &Component) -> &[f32] {
    match component {
        Component::Klems(matrix) => matrix.values(),
        Component::Tree(tree) => tree.values(),
    }
}
