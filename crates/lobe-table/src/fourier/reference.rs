//! The evaluation of [`Data`] one query at a time in `f64`: the reference for the lanes.

use super::data::Data;
use super::place::{Place, colours};

impl Data {
    /// The channels of `f` in 1/sr for light from `wi` to `wo`, unit vectors that point away from the surface, on
    /// either side of it.
    ///
    /// Radiance that passes into another medium changes with the square of the refractive index, and `f` with it. Zero
    /// for directions that graze the surface, and where series are negative.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3]) -> Vec<f64> {
        let channels = self.parts().channels.count();
        let mut out = vec![0.0; channels];
        if let Some(place) = Place::find(self, wi, wo) {
            let phi = place.cos_phi.acos();
            let sums = self.sums(&place, |coefficient, order| coefficient * (order as f64 * phi).cos());
            let values = colours(sums, channels);
            out.iter_mut().zip(values).for_each(|(out, value)| *out = value * place.scale);
        }
        out
    }

    /// The largest error of a value in the lanes of a [`Table`](super::Table), which sum coefficients in `f32` that may
    /// cancel each other.
    pub fn bound(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        const ROUNDINGS: f64 = 1e-6;
        let Some(place) = Place::find(self, wi, wo) else { return 0.0 };
        let magnitudes = (0..16).filter_map(|corner| place.corner(corner)).map(|([viewer, light], weight)| {
            let series = self.series(viewer, light);
            let of_channel =
                |channel: usize| self.coefficients(series, channel).iter().map(|a| f64::from(a.abs())).sum::<f64>();
            weight.abs() * (0..self.parts().channels.count()).map(of_channel).sum::<f64>()
        });
        // Green contains the luminance one and a half times.
        1.5 * ROUNDINGS * place.scale * magnitudes.sum::<f64>()
    }

    /// The sums of terms over all series around a place, one per channel.
    fn sums(&self, place: &Place, term: impl Fn(f64, usize) -> f64) -> [f64; 3] {
        let mut sums = [0.0; 3];
        for corner in 0..16 {
            let Some(([viewer, light], weight)) = place.corner(corner) else { continue };
            let series = self.series(viewer, light);
            for (channel, sum) in sums.iter_mut().enumerate().take(self.parts().channels.count()) {
                let coefficients = self.coefficients(series, channel).iter().enumerate();
                *sum += weight * coefficients.map(|(order, a)| term(f64::from(*a), order)).sum::<f64>();
            }
        }
        sums
    }
}
