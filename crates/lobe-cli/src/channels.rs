//! Surfaces with the channels of a format.

use lobe::Channels;
use lobe_formats::ChannelMap;
use lobe_model::Surface;

/// A surface whose channels are mapped.
pub struct Mapped<'a> {
    /// The surface.
    pub surface: &'a dyn Surface,
    /// How its channels are mapped.
    pub map: &'a ChannelMap,
}

impl Surface for Mapped<'_> {
    fn channels(&self) -> &Channels {
        &self.map.channels
    }

    fn f(&self, wi: [f64; 3], viewers: &[[f64; 3]], out: &mut [f64]) {
        let (from, to) = (self.map.rows[0].len(), self.map.rows.len());
        let mut texels = vec![0.0; viewers.len() * from];
        self.surface.f(wi, viewers, &mut texels);
        for (out, texel) in out.chunks_exact_mut(to).zip(texels.chunks_exact(from)) {
            for (out, row) in out.iter_mut().zip(&self.map.rows) {
                *out = row.iter().zip(texel).map(|(weight, f)| weight * f).sum();
            }
        }
    }
}
