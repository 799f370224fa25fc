//! Klems matrices and tensor trees, by their `f64` reference. Each band of wavelengths is a channel.

use lobe_formats::window_xml::WindowXml;
use lobe_table::Channels;
use lobe_table::window::{Block, Component};

use super::evaluator::{Evaluator, pair_by_pair};
use crate::Kind;

#[derive(Debug)]
pub(super) struct Bands {
    data: WindowXml,
    channels: Channels,
    kind: Kind,
}

impl Bands {
    pub(super) fn new(data: WindowXml) -> Self {
        let channels = Channels::Named(data.bands.iter().map(|band| band.wavelength.clone()).collect());
        let mut components =
            data.bands.iter().flat_map(|band| Block::ALL.into_iter().filter_map(|block| band.window.block(block)));
        let is_tree = components.any(|component| matches!(component, Component::Tree(_)));
        drop(components);
        Bands { data, channels, kind: if is_tree { Kind::TensorTree } else { Kind::Klems } }
    }
}

impl Evaluator for Bands {
    fn kind(&self) -> Kind {
        self.kind
    }

    fn channels(&self) -> &Channels {
        &self.channels
    }

    fn eval_batch(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        pair_by_pair(wi, wo, out, |wi, wo, texel| {
            for (out, band) in texel.iter_mut().zip(&self.data.bands) {
                *out = band.window.eval(wi, wo) as f32;
            }
        });
    }
}
