//! Surfaces on the bins of the MERL database.

use std::f64::consts::PI;

use lobe_table::{Channels, Invalid, half_diff};
use rayon::prelude::*;

use crate::Surface;
use crate::vec3::{Vec3, spherical};

/// The bins of `theta_h`, `theta_d` and `phi_d` in the database.
pub const MERL: [usize; 3] = [90, 90, 180];
/// The value of a bin without directions above the surface.
const NOT_MEASURED: f32 = -1.0;

/// Measures an isotropic surface in the middle of each bin; if that is below the horizon, at those of eight points
/// around it that are above. Negative values become 0, because they mean "not measured" here.
///
/// Half a turn of `phi_d` represents a full turn, so a bin is the mean of a pair of directions and the exchanged pair.
/// Values of `theta_h` are divided among the threads of rayon; `progress` is called after each of them.
///
/// # Errors
/// [`Invalid`] if the channels are not RGB, there are no bins, or a value is not finite.
pub fn measure(
    surface: &dyn Surface,
    bins: [usize; 3],
    progress: impl Fn() + Sync,
) -> Result<half_diff::Data, Invalid> {
    if *surface.channels() != Channels::Rgb {
        let found = surface.channels().names().join(" ");
        return Err(Invalid { part: "channels", found, expected: "R G B".into() });
    }
    let [halves, differences, turns] = bins;
    let planes: Vec<Vec<[f32; 3]>> = (0..halves)
        .into_par_iter()
        .map(|h| {
            let bin = |i: usize| measure_bin(surface, [h, i / turns, i % turns], bins);
            let plane = (0..differences * turns).map(bin).collect();
            progress();
            plane
        })
        .collect();
    let values = (0..3).flat_map(|channel| planes.iter().flatten().map(move |texel| texel[channel])).collect();
    half_diff::Data::new(bins, values)
}

fn measure_bin(surface: &dyn Surface, bin: [usize; 3], bins: [usize; 3]) -> [f32; 3] {
    let pair = |offset: [f64; 3]| {
        let [h, d, p] = [0, 1, 2].map(|axis| (bin[axis] as f64 + offset[axis]) / bins[axis] as f64);
        let (sin, cos) = (h * h * PI / 2.0).sin_cos();
        let tilt = |[x, y, z]: Vec3| [cos * x + sin * z, y, cos * z - sin * x];
        let (theta_d, phi_d) = (d * PI / 2.0, p * PI);
        let (wi, wo) = (tilt(spherical(theta_d, phi_d)), tilt(spherical(theta_d, phi_d + PI)));
        (wi[2] > 0.0 && wo[2] > 0.0).then_some((wi, wo))
    };
    let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { 0.1 } else { 0.9 });
    let pairs: Vec<_> = match pair([0.5; 3]) {
        Some(middle) => vec![middle],
        None => (0..8).filter_map(|i| pair(corner(i))).collect(),
    };
    if pairs.is_empty() {
        return [NOT_MEASURED; 3];
    }
    let mut sum = [0.0; 3];
    for (wi, wo) in &pairs {
        let (mut there, mut back) = ([0.0; 3], [0.0; 3]);
        surface.f(*wi, &[*wo], &mut there);
        surface.f(*wo, &[*wi], &mut back);
        sum = [0, 1, 2].map(|c| sum[c] + there[c] + back[c]);
    }
    sum.map(|f| (f / (2 * pairs.len()) as f64).max(0.0) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Conductor, Ggx, Model, Rgb};

    #[test]
    fn the_middle_of_a_bin_is_the_model_and_the_horizon_is_closed() {
        let gold = Conductor { ggx: Ggx { alpha: [0.3; 2] }, eta: [0.143, 0.375, 1.442], k: [3.983, 2.386, 1.603] };
        let bins = [12, 10, 20];
        let table = measure(&Rgb(&gold), bins, || {}).expect("a table");
        let mut dark = 0;
        for n in 1..400 {
            let [a, b, c, _] = crate::halton(n);
            let (wi, wo) = (spherical(1.5 * a, 0.0), spherical(1.5 * b, 6.0 * c));
            let bin = table.bin(wi, wo);
            // Every pair above the horizon falls into a bin with a value, except for slivers of bins.
            dark += usize::from(!table.is_measured(bin));
            let (sin, cos) = (((bin[0] as f64 + 0.5) / 12.0).powi(2) * PI / 2.0).sin_cos();
            let tilt = |[x, y, z]: Vec3| [cos * x + sin * z, y, cos * z - sin * x];
            let (theta_d, phi_d) = ((bin[1] as f64 + 0.5) / 10.0 * PI / 2.0, (bin[2] as f64 + 0.5) / 20.0 * PI);
            let (wi, wo) = (tilt(spherical(theta_d, phi_d)), tilt(spherical(theta_d, phi_d + PI)));
            if wi[2] > 0.0 && wo[2] > 0.0 {
                assert_eq!(table.texel(bin), gold.f(wi, wo).map(|f| f as f32));
            }
        }
        assert!(dark < 4, "{dark} pairs above the horizon without a value");
        assert_eq!(table.texel([11, 9, 0]), [NOT_MEASURED; 3], "half vector and difference both near 90 degrees");
    }

    #[test]
    fn other_channels_are_refused() {
        struct Grey;
        impl Surface for Grey {
            fn channels(&self) -> &Channels {
                &Channels::Mono
            }
            fn f(&self, _: [f64; 3], _: &[[f64; 3]], out: &mut [f64]) {
                out.fill(1.0);
            }
        }
        assert_eq!(measure(&Grey, MERL, || {}).expect_err("one channel").part, "channels");
    }
}
