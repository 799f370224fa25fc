//! Light that is mirrored or goes straight through, which has no value for a pair of directions.

use lobe_table::{Aspect, Scatter, Side, mirror};

/// A mirror reflectance or a straight-through transmittance, and the side from which it was measured.
#[derive(Clone, Debug)]
pub(crate) struct Mirror {
    /// `None` means both sides.
    pub(crate) side: Option<Side>,
    pub(crate) data: mirror::Data,
}

impl Mirror {
    /// `true` if this applies to an aspect.
    pub(crate) fn answers(&self, aspect: Aspect) -> bool {
        self.data.scatter() == aspect.scatter && self.side.is_none_or(|side| side == aspect.light)
    }

    /// The share of the light from `wi` that continues, one value per channel.
    pub(crate) fn reflectance(&self, [x, y, z]: [f32; 3]) -> Vec<f32> {
        let [x, y, z] = [x, y, z.abs()].map(f64::from);
        let sigma = x.hypot(y).atan2(z);
        let psi = if x == 0.0 && y == 0.0 { 0.0 } else { y.atan2(x).rem_euclid(std::f64::consts::TAU) };
        self.data.at(sigma, psi).iter().map(|&share| share.max(0.0) as f32).collect()
    }
}

/// The direction in which light from `wi` continues: mirrored about the normal, or straight on.
pub(crate) fn mirrored([x, y, z]: [f32; 3], scatter: Scatter) -> [f32; 3] {
    match scatter {
        Scatter::Reflection => [-x, -y, z],
        Scatter::Transmission => [-x, -y, -z],
    }
}
