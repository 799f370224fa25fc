//! Surfaces that send a ray into one or two exact directions.

use super::{Evaluated, Sampled, Scratch, Shader};
use crate::vec3::Vec3;

/// One of the directions that light comes from, and the share of it that goes on to the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeltaSample<const C: usize> {
    /// Toward the light.
    pub wi: [f32; 3],
    /// What radiance is multiplied by.
    pub weight: [f32; C],
}

/// What a smooth surface does to a ray.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Delta<const C: usize> {
    /// Mirrors a constant share of the light.
    Mirror([f32; C]),
    /// Mirrors a share of the light that depends on the angle to the normal: rising angles in radians with a share each.
    Measured(Vec<(f32, [f32; C])>),
    /// Mirrors and refracts by the equations of Fresnel.
    Glass {
        /// Refractive index inside (where the normal does not point) over that outside.
        eta: f32,
        /// What mirrored and refracted light are multiplied by.
        tint: [f32; C],
    },
}

impl<const C: usize> Delta<C> {
    /// The mirrored direction, and the refracted one where there is one, for a viewer in the direction `wo`.
    pub fn samples(&self, wo: [f32; 3]) -> (DeltaSample<C>, Option<DeltaSample<C>>) {
        let mirrored = [-wo[0], -wo[1], wo[2]];
        match self {
            Delta::Mirror(share) => (DeltaSample { wi: mirrored, weight: *share }, None),
            Delta::Measured(shares) => (DeltaSample { wi: mirrored, weight: share_at(shares, wo) }, None),
            Delta::Glass { eta, tint } => {
                let ratio = if wo[2] > 0.0 { 1.0 / eta } else { *eta };
                let (share, refracted) = refract(wo, ratio);
                let mirror = DeltaSample { wi: mirrored, weight: tint.map(|t| t * share) };
                let through = refracted.map(|wi| {
                    // Radiance is squeezed into the smaller cone of the denser medium.
                    let weight = tint.map(|t| t * (1.0 - share) * (ratio * ratio));
                    DeltaSample { wi, weight }
                });
                (mirror, through)
            }
        }
    }
}

/// The share that is mirrored, and the refracted direction unless all is; `ratio` is the index on the side of `wo` over
/// that of the other side.
fn refract(wo: Vec3, ratio: f32) -> (f32, Option<Vec3>) {
    let cos = wo[2].abs().min(1.0);
    let sin2 = ratio * ratio * (1.0 - cos * cos);
    if sin2 >= 1.0 {
        return (1.0, None);
    }
    let through = (1.0 - sin2).sqrt();
    let parallel = (cos - ratio * through) / (cos + ratio * through);
    let perpendicular = (ratio * cos - through) / (ratio * cos + through);
    let share = 0.5 * (parallel * parallel + perpendicular * perpendicular);
    let z = if wo[2] > 0.0 { -through } else { through };
    (share, Some([-ratio * wo[0], -ratio * wo[1], z]))
}

/// Linear between the angles, constant beyond them.
fn share_at<const C: usize>(shares: &[(f32, [f32; C])], wo: Vec3) -> [f32; C] {
    let theta = libm::acosf(wo[2].abs().min(1.0));
    let after = shares.partition_point(|(angle, _)| *angle <= theta);
    match (after.checked_sub(1).and_then(|before| shares.get(before)), shares.get(after)) {
        (Some((from, a)), Some((to, b))) => {
            let t = (theta - from) / (to - from);
            std::array::from_fn(|k| a[k] + t * (b[k] - a[k]))
        }
        (Some((_, only)), None) | (None, Some((_, only))) => *only,
        (None, None) => [0.0; C],
    }
}

/// A material that is a [`Delta`] and nothing else.
#[derive(Clone, Debug, PartialEq)]
pub struct DeltaShader<const C: usize>(pub Delta<C>);

impl<const C: usize> Shader<C> for DeltaShader<C> {
    fn transmits(&self) -> bool {
        matches!(self.0, Delta::Glass { .. })
    }

    fn delta(&self) -> Option<&Delta<C>> {
        Some(&self.0)
    }

    /// White, as denoisers want smooth surfaces to be.
    fn albedo(&self) -> [f32; C] {
        [1.0; C]
    }

    fn eval(&self, _: &[[f32; 3]], _: &[[f32; 3]], out: Evaluated<'_, C>, _: &mut Scratch) {
        out.f.fill([0.0; C]);
        out.pdf.fill(0.0);
    }

    fn sample(&self, _: &[[f32; 3]], _: &[[f32; 2]], out: Sampled<'_, C>, _: &mut Scratch) {
        out.weight.fill([0.0; C]);
        out.pdf.fill(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glass_divides_light_and_obeys_snell() {
        let glass = Delta::Glass { eta: 1.5, tint: [1.0] };
        let wo = [0.6, 0.0, 0.8];
        let (mirror, through) = glass.samples(wo);
        let through = through.unwrap();
        assert_eq!(mirror.wi, [-0.6, 0.0, 0.8]);
        assert!((through.wi[0] + 0.6 / 1.5).abs() < 1e-6 && through.wi[2] < 0.0);
        // Without the factor of the cones, what is not mirrored goes through.
        assert!((mirror.weight[0] + through.weight[0] * 1.5 * 1.5 - 1.0).abs() < 1e-6);
        // And the way back is the same way.
        let (_, back) = glass.samples(through.wi);
        let back = back.unwrap().wi;
        assert!(wo.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-6), "{back:?}");
        // From inside at a flat angle all is mirrored.
        assert!(glass.samples([0.9, 0.0, -0.43589]).1.is_none());
        // At the normal: ((n - 1) / (n + 1))^2.
        assert!((glass.samples([0.0, 0.0, 1.0]).0.weight[0] - 0.04).abs() < 1e-6);
    }

    #[test]
    fn measured_shares_are_linear_between_angles() {
        let mirror = Delta::Measured(vec![(0.0, [0.2]), (1.0, [0.6])]);
        let at = |theta: f32| mirror.samples([theta.sin(), 0.0, theta.cos()]).0.weight[0];
        assert!((at(0.5) - 0.4).abs() < 1e-5 && (at(1.3) - 0.6).abs() < 1e-6, "{} {}", at(0.5), at(1.3));
    }
}
