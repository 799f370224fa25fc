//! Surfaces on pairs of Klems patches.

use std::f64::consts::TAU;

use lobe_table::window::Block;
use lobe_table::window::klems::{AngleBasis, KlemsError, KlemsMatrix};
use rayon::prelude::*;

use crate::Surface;
use crate::vec3::Vec3;

/// The numbers of rows of polar angle and of azimuth of the directions in a patch.
const ROWS: usize = 4;

/// Measures a block of a sheet, one matrix per channel: each value is the mean of `f` over 16 directions of the one
/// patch and 16 of the other, which represent equal projected solid angles. So the flux from patch to patch is right,
/// and a lobe narrower than a patch is spread over it.
///
/// Incident patches are divided among the threads of rayon; `progress` is called after each of them.
///
/// # Errors
/// [`KlemsError::ValueNotFinite`] if the surface has a value that is not finite.
pub fn measure(
    surface: &dyn Surface,
    [incident, exit]: [&AngleBasis; 2],
    block: Block,
    progress: impl Fn() + Sync,
) -> Result<Vec<KlemsMatrix>, KlemsError> {
    let (above_i, above_o) = match block {
        Block::TransmissionFront => (-1.0, 1.0),
        Block::TransmissionBack => (1.0, -1.0),
        Block::ReflectionFront => (-1.0, -1.0),
        Block::ReflectionBack => (1.0, 1.0),
    };
    let channels = surface.channels().count();
    let viewers: Vec<Vec3> = patches(exit).into_iter().flatten().map(|[x, y, z]| [x, y, above_o * z]).collect();
    let rows: Vec<Vec<f64>> = patches(incident)
        .into_par_iter()
        .map(|lights| {
            let mut sums = vec![0.0; exit.patches() * channels];
            let mut f = vec![0.0; viewers.len() * channels];
            let share = 1.0 / (lights.len() * ROWS * ROWS) as f64;
            for [x, y, z] in lights {
                // The patch of incident light is that of the direction in which it travels.
                surface.f([-x, -y, above_i * z], &viewers, &mut f);
                for (sum, patch) in sums.chunks_exact_mut(channels).zip(f.chunks_exact(ROWS * ROWS * channels)) {
                    for texel in patch.chunks_exact(channels) {
                        sum.iter_mut().zip(texel).for_each(|(sum, f)| *sum += share * f);
                    }
                }
            }
            progress();
            sums
        })
        .collect();
    let of_channel = |channel: usize| {
        let values = rows.iter().flat_map(|row| row.iter().skip(channel).step_by(channels).map(|&f| f as f32));
        KlemsMatrix::new(incident.clone(), exit.clone(), values.collect())
    };
    (0..channels).map(of_channel).collect()
}

/// For each patch of the upper hemisphere, the middles of equal parts of its projected solid angle.
fn patches(basis: &AngleBasis) -> Vec<Vec<Vec3>> {
    let middle = |i: usize| (i as f64 + 0.5) / ROWS as f64;
    let mut patches = Vec::with_capacity(basis.patches());
    for ring in basis.rings() {
        let [lower, upper] = [ring.lower, ring.upper].map(|degrees| degrees.to_radians().cos().powi(2));
        for sector in 0..ring.patches {
            let part = |i: usize| {
                let cos2 = lower + (upper - lower) * middle(i / ROWS);
                // The first sector is centred on +x.
                let (sin_phi, cos_phi) =
                    (TAU * (f64::from(sector) - 0.5 + middle(i % ROWS)) / f64::from(ring.patches)).sin_cos();
                let sin = (1.0 - cos2).sqrt();
                [sin * cos_phi, sin * sin_phi, cos2.sqrt()]
            };
            patches.push((0..ROWS * ROWS).map(part).collect());
        }
    }
    patches
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Conductor, Ggx, Lambert, Rgb, albedo};

    #[test]
    fn directions_of_a_patch_are_in_it() {
        for basis in [AngleBasis::full(), AngleBasis::half(), AngleBasis::quarter()] {
            for (index, directions) in patches(&basis).into_iter().enumerate() {
                assert!(
                    directions.into_iter().all(|d| basis.patch(d) == Some(index)),
                    "patch {index} of {}",
                    basis.name()
                );
            }
        }
    }

    #[test]
    fn the_flux_agrees_with_the_surface() {
        let silver = Conductor { ggx: Ggx { alpha: [0.4; 2] }, eta: [1.0; 3], k: [1e6; 3] };
        let basis = AngleBasis::full();
        let matrices = measure(&Rgb(silver), [&basis, &basis], Block::ReflectionBack, || {}).expect("matrices");
        assert_eq!(matrices.len(), 3);
        let (all, expected) = (matrices[1].albedo(0), albedo(&silver, [0.0, 0.0, 1.0], 200)[1]);
        assert!((all - expected).abs() < 5e-3, "{all} of {expected} is reflected for light from the zenith");
        // Light from +x continues to -x: it travels toward the patch of the viewers.
        let (s, c) = 0.7f64.sin_cos();
        let [mirror, back] = [-s, s].map(|x| matrices[0].eval([s, 0.0, c], [x, 0.0, c]));
        assert!(mirror > 5.0 * back, "{mirror} in the mirror direction, {back} back");
    }

    #[test]
    fn the_other_side_of_a_model_is_dark() {
        let basis = AngleBasis::quarter();
        let matte = Rgb(Lambert { albedo: [0.5; 3] });
        for block in [Block::ReflectionFront, Block::TransmissionFront, Block::TransmissionBack] {
            let matrices = measure(&matte, [&basis, &basis], block, || {}).expect("matrices");
            assert!(matrices.iter().all(|matrix| matrix.values().iter().all(|f| *f == 0.0)), "{block:?}");
        }
    }
}
