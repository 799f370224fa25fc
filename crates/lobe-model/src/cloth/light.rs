//! Light in the cloth.

use rand::RngExt;
use rand_pcg::Pcg32;

use super::height_field::HeightField;
use super::weave::{Thread, Weave};
use super::yarn::Yarn;
use crate::Model;
use crate::vec3::{Vec3, scale};

/// A woven cloth whose BRDF is computed by following light through it.
///
/// The light arrives from `wi` all over one period of the weave. Each path carries an equal share of it from yarn to
/// yarn. At each yarn that it hits, the light that this yarn scatters toward every viewer is added, if no other yarn is
/// in the way. So the value is smooth over the viewers (which share their paths) and, because the `n`-th path always
/// uses the same random numbers, also over `wi`. The same seed gives the same values, whatever else is computed and for
/// any number of threads.
///
/// With irradiance `E cos_i`, each of `n` paths starts with flux 1; the intensity of all paths divided by the projected
/// visible area is the radiance, so `f = 1 / (n cos_o)` times the sum over paths and hits of `flux f_yarn cos_yarn`
/// toward the viewer.
pub struct Cloth {
    field: HeightField,
    yarns: [Yarn; 2],
    paths: u32,
    seed: u64,
}

/// The number of hits of a path before Russian roulette starts.
const FIRST_HITS: u32 = 2;
/// The number of hits after which a path is dropped, because it might never leave a groove that absorbs nothing. The
/// flux that it still carries is lost; paths leave after 3 hits on average, so that is negligible.
const MOST_HITS: u32 = 1000;

impl Cloth {
    /// Weaves a cloth. `yarns` are warp and weft; `resolution` is the number of cells of the height field per yarn;
    /// `paths` the number of light paths per direction of the light, on which the noise depends.
    pub fn new(weave: &Weave, yarns: [Yarn; 2], resolution: usize, paths: u32, seed: u64) -> Cloth {
        Cloth { field: HeightField::new(weave, resolution), yarns, paths, seed }
    }

    fn yarn(&self, thread: Thread) -> &Yarn {
        match thread {
            Thread::Warp => &self.yarns[0],
            Thread::Weft => &self.yarns[1],
        }
    }

    /// Follows one path and adds the light that it sends to each viewer, times the cosine at the viewer, to
    /// `intensities`.
    fn follow(&self, number: u32, wi: Vec3, viewers: &[Vec3], intensities: &mut [Vec3]) {
        let mut rng = Pcg32::new(self.seed, u64::from(number));
        let mut origin = self.field.above(even_point(number));
        let mut direction = scale(wi, -1.0);
        let mut flux = [1.0; 3];
        for hits in 1..=MOST_HITS {
            let Some(hit) = self.field.first_hit(origin, direction) else { return };
            let (thread, frame) = self.field.facet(hit.facet);
            let yarn = self.yarn(*thread);
            let local_in = frame.to_local(scale(direction, -1.0));
            for (intensity, &viewer) in intensities.iter_mut().zip(viewers) {
                let local_out = frame.to_local(viewer);
                if local_out[2] > 0.0 && self.field.first_hit(hit.point, viewer).is_none() {
                    let f = yarn.f(local_in, local_out);
                    for c in 0..3 {
                        intensity[c] += flux[c] * f[c] * local_out[2];
                    }
                }
            }
            let Some((next, share)) = yarn.sample(local_in, &mut rng) else { return };
            flux = [0, 1, 2].map(|c| flux[c] * share[c]);
            let survival = if hits < FIRST_HITS { 1.0 } else { flux.into_iter().fold(0.0, f64::max).min(1.0) };
            if rng.random::<f64>() >= survival {
                return;
            }
            flux = flux.map(|f| f / survival);
            (origin, direction) = (hit.point, frame.to_world(next));
        }
    }
}

impl Model for Cloth {
    /// One viewer at a time: use [`Model::f_many`] for more.
    fn f(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
        self.f_many(wi, &[wo])[0]
    }

    fn f_many(&self, wi: [f64; 3], viewers: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut values = vec![[0.0; 3]; viewers.len()];
        if wi[2] <= 0.0 {
            return values;
        }
        for number in 0..self.paths {
            self.follow(number, wi, viewers, &mut values);
        }
        for (value, viewer) in values.iter_mut().zip(viewers) {
            let seen = viewer[2] > 0.0;
            *value = if seen { scale(*value, 1.0 / (f64::from(self.paths) * viewer[2])) } else { [0.0; 3] };
        }
        values
    }
}

/// The `n`-th point of a sequence that fills the unit square evenly for any number of points.
///
/// M. Roberts, *The unreasonable effectiveness of quasirandom sequences*, 2018: steps of `1/g` and `1/g^2`,
/// `g^3 = g + 1`.
fn even_point(n: u32) -> [f64; 2] {
    const PLASTIC: f64 = 1.324_717_957_244_746;
    [1.0 / PLASTIC, 1.0 / (PLASTIC * PLASTIC)].map(|step| (0.5 + f64::from(n) * step).fract())
}

#[cfg(test)]
mod tests {
    use super::super::weave::Ply;
    use super::*;
    use crate::albedo;
    use crate::vec3::spherical;

    fn weave() -> Weave {
        let plies = [Ply { along: 1, across: 3.0, depth: 0.05 }, Ply::SMOOTH];
        Weave { over: 2, under: 1, crimp: 0.2, roundness: 0.4, plies }
    }

    fn matte(body: [f64; 3]) -> Yarn {
        Yarn { body, shine: [0.0; 3], share: 0.0, roughness: [0.2, 0.5] }
    }

    /// Warp and weft with different colours and shine.
    fn silk() -> [Yarn; 2] {
        [
            Yarn { body: [0.1, 0.2, 0.8], shine: [0.6, 0.8, 1.0], share: 0.4, roughness: [0.2, 0.5] },
            Yarn { body: [0.8, 0.4, 0.1], shine: [1.0, 0.8, 0.5], share: 0.4, roughness: [0.2, 0.5] },
        ]
    }

    #[test]
    fn a_white_cloth_reflects_all_light() {
        let cloth = Cloth::new(&weave(), [matte([1.0; 3]); 2], 16, 4000, 7);
        for theta in [0.0, 0.6, 1.2, 1.45] {
            let [all, ..] = albedo(&cloth, spherical(theta, 0.7), 12);
            assert!((all - 1.0).abs() < 0.02, "{all} at {theta}");
        }
    }

    #[test]
    fn a_coloured_cloth_absorbs_light() {
        let cloth = Cloth::new(&weave(), [matte([0.8, 0.5, 0.2]); 2], 16, 2000, 7);
        let yarns = Cloth::new(&weave(), silk(), 16, 2000, 7);
        for theta in [0.0, 0.9, 1.4] {
            let back = albedo(&cloth, spherical(theta, 0.7), 12);
            // Light that hits a second yarn before it leaves is absorbed twice, so the cloth reflects less than the
            // yarn itself.
            for (all, body) in back.into_iter().zip([0.8, 0.5, 0.2]) {
                assert!(all < body && all > 0.6 * body, "{all} of {body} at {theta}");
            }
            let back = albedo(&yarns, spherical(theta, 0.7), 12);
            assert!(back.into_iter().all(|all| all > 0.1 && all < 1.0), "{back:?} at {theta}");
        }
    }

    #[test]
    fn reciprocal() {
        let cloth = Cloth::new(&weave(), silk(), 16, 40_000, 3);
        for (a, b) in [((0.2, 0.1), (1.0, 2.0)), ((0.8, 1.0), (0.9, 4.3)), ((1.3, 5.0), (0.5, 1.5))] {
            let (a, b) = (spherical(a.0, a.1), spherical(b.0, b.1));
            for (there, back) in cloth.f(a, b).into_iter().zip(cloth.f(b, a)) {
                assert!((there - back).abs() < 0.02 * there, "{there} one way, {back} the other");
            }
        }
    }

    #[test]
    fn a_single_bounce_off_a_flat_cloth_is_the_yarn() {
        let flat = Weave { over: 1, under: 1, crimp: 0.0, roundness: 0.0, plies: [Ply::SMOOTH; 2] };
        let [warp, _] = silk();
        let cloth = Cloth::new(&flat, [warp; 2], 4, 50, 1);
        let (wi, wo) = (spherical(0.6, 0.3), spherical(0.5, 3.0));
        // If heights are equal, the warp counts as on top: fibres along y, the yarn's x axis.
        let turn = |[x, y, z]: Vec3| [y, -x, z];
        for (got, expected) in cloth.f(wi, wo).into_iter().zip(warp.f(turn(wi), turn(wo))) {
            assert!((got - expected).abs() < 1e-12, "{got} instead of {expected}");
        }
    }

    #[test]
    fn colour_and_shine_turn_with_the_sample() {
        let plain = Weave { over: 1, under: 1, crimp: 0.05, roundness: 0.3, plies: [Ply::SMOOTH; 2] };
        let cloth = Cloth::new(&plain, silk(), 16, 2000, 1);
        // Off the mirror direction, across the warp (x) and across the weft (y): round yarns shine across their axis.
        let quarter = std::f64::consts::FRAC_PI_2;
        let pair = |phi: f64| cloth.f(spherical(0.2, phi), spherical(1.2, phi + 2.0 * quarter));
        let (across_warp, across_weft) = (pair(0.0), pair(quarter));
        let redness = |[r, _, b]: Vec3| r / b;
        let change = redness(across_weft) / redness(across_warp);
        assert!(change > 1.5, "redness changes by {change}");
    }
}
