//! The blocks of a sheet in every band of wavelengths, as measured.

use super::blocks::{Block, Blocks, Component};

/// Klems matrices or tensor trees of the two sides of a sheet, in named bands of wavelengths.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Data {
    /// The bands in the order of the file. No two names differ only in case.
    pub bands: Vec<Band>,
}

/// The blocks of one band of wavelengths.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// The name in the file, such as `Visible`, or a wavelength in nm.
    pub wavelength: String,
    /// The values.
    pub window: Blocks,
}

impl Data {
    /// The values of a band by its name, in any case.
    pub fn band(&self, wavelength: &str) -> Option<&Blocks> {
        self.bands.iter().find(|band| band.wavelength.eq_ignore_ascii_case(wavelength)).map(|band| &band.window)
    }

    pub(super) fn components(&self) -> impl Iterator<Item = &Component> {
        self.bands.iter().flat_map(|band| Block::ALL.into_iter().filter_map(|block| band.window.block(block)))
    }
}
