//! Materials as surfaces to be measured again.

use lobe::{Channels, Material, Scatter};
use lobe_formats::ChannelMap;
use lobe_model::Surface;

/// A material from a file, or one measurement of it.
pub struct MaterialSurface {
    /// The material.
    pub material: Material,
    /// The scatter to measure, for light from the front; `None` for everything, on both sides.
    pub scatter: Option<Scatter>,
}

impl Surface for MaterialSurface {
    fn channels(&self) -> &Channels {
        self.material.channels()
    }

    fn f(&self, wi: [f64; 3], viewers: &[[f64; 3]], out: &mut [f64]) {
        let narrow = |direction: [f64; 3]| direction.map(|c| c as f32);
        let wo: Vec<_> = viewers.iter().copied().map(narrow).collect();
        let mut values = vec![0.0; out.len()];
        self.material.eval_batch(&vec![narrow(wi); wo.len()], &wo, &mut values);
        let channels = self.material.channel_count();
        for ((texel, values), wo) in out.chunks_exact_mut(channels).zip(values.chunks_exact(channels)).zip(viewers) {
            let passes = (wi[2] > 0.0) != (wo[2] > 0.0);
            let is_held = match self.scatter {
                None => true,
                Some(Scatter::Reflection) => !passes && wi[2] > 0.0,
                Some(Scatter::Transmission) => passes && wi[2] > 0.0,
            };
            texel.iter_mut().zip(values).for_each(|(out, f)| *out = if is_held { f64::from(*f) } else { 0.0 });
        }
    }
}

/// The smallest height at which [`Lifted`] surfaces are evaluated: 3.4 degrees.
const HEIGHT: f64 = 0.06;

/// A surface that is never evaluated near its horizon: directions there are raised, at the same azimuth.
pub struct Lifted<'a>(pub &'a dyn Surface);

impl Surface for Lifted<'_> {
    fn channels(&self) -> &Channels {
        self.0.channels()
    }

    fn f(&self, wi: [f64; 3], viewers: &[[f64; 3]], out: &mut [f64]) {
        let away = |[x, y, z]: [f64; 3]| {
            if z.abs() >= HEIGHT {
                return [x, y, z];
            }
            let stretch = (1.0 - HEIGHT * HEIGHT).sqrt() / x.hypot(y);
            [x * stretch, y * stretch, HEIGHT.copysign(z)]
        };
        let viewers: Vec<_> = viewers.iter().copied().map(away).collect();
        self.0.f(away(wi), &viewers, out);
    }
}

/// A surface whose channels are mapped.
pub struct Mapped<'a> {
    /// The surface.
    pub surface: &'a dyn Surface,
    /// The map of its channels.
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
