//! All lights of a scene, and the choice of the one to sample.

use lobe_lane::{Floats, Ints, Lanes, MAX_LANES, Mask};

use super::cdf::Cdf;
use super::sample::{Emitted, LightRay, LightSample, SceneBounds};
use super::{Light, LightPolarisation};
use crate::channels::Channels;

/// All lights of a scene and their probabilities of being chosen.
#[derive(Clone, Debug)]
pub(crate) struct Lights<S: Channels> {
    pub all: Vec<Light<S>>,
    /// How the light of each is polarised.
    polarisation: Vec<Option<LightPolarisation>>,
    /// The probability of each light.
    pub(super) chances: Vec<f32>,
    pub(super) cdf: Cdf,
    pub bounds: SceneBounds,
    /// The index of the environment.
    pub environment: Option<usize>,
}

impl<S: Channels> Lights<S> {
    /// Half of the probability is proportional to power, and half is uniform, because a light may be weak and near.
    pub fn new(all: Vec<Light<S>>, bounds: SceneBounds) -> Self {
        let weights: Vec<f64> = all.iter().map(|light| light.weight(bounds.radius)).collect();
        let total: f64 = weights.iter().sum();
        let equal = 1.0 / all.len().max(1) as f64;
        let by_power = |weight: f64| if total > 0.0 { weight / total } else { equal };
        let chances: Vec<f64> = weights.iter().map(|&weight| 0.5 * by_power(weight) + 0.5 * equal).collect();
        let cdf = Cdf::new(all.len(), &chances);
        let environment = all.iter().position(|light| matches!(light, Light::Environment(_)));
        let chances = chances.into_iter().map(|chance| chance as f32).collect();
        Lights { polarisation: vec![None; all.len()], all, chances, cdf, bounds, environment }
    }

    /// The same, with lights that are polarised, by their numbers.
    pub fn polarised(mut self, polarised: &[(usize, LightPolarisation)]) -> Self {
        polarised.iter().for_each(|(light, polarisation)| self.polarisation[*light] = Some(*polarisation));
        self
    }

    /// How the light is polarised; `None` if it is not.
    pub fn polarisation(&self, light: usize) -> Option<&LightPolarisation> {
        self.polarisation[light].as_ref()
    }

    /// The lights that numbers in `[0, 1)` choose.
    #[inline(always)]
    pub fn chosen_by<L: Lanes>(&self, lanes: L, choice: L::F) -> L::I {
        self.cdf.sample(lanes, lanes.splat_int(0), choice).0
    }

    /// Samples the given light, or lights chosen by the first number, as seen from the points `from`. The radiance is
    /// divided by the density of the sample. There must be a light.
    #[inline(always)]
    pub fn sample_li<L: Lanes>(
        &self,
        lanes: L,
        light: Option<usize>,
        from: [L::F; 3],
        [choice, u, v]: [L::F; 3],
    ) -> LightSample<L, S> {
        let (mut sample, chance) = match light {
            Some(light) => (self.all[light].sample_li(lanes, from, [u, v]), lanes.splat(1.0)),
            None => {
                let (chosen, _) = self.cdf.sample(lanes, lanes.splat_int(0), choice);
                (self.sample_chosen(lanes, chosen, from, [u, v]), lanes.gather(&self.chances, chosen))
            }
        };
        let density = sample.pdf * chance;
        let extended = sample.pdf.lt(lanes.splat(f32::INFINITY));
        let divisor = lanes.select(extended, density, chance);
        for radiance in sample.radiance.as_mut() {
            *radiance = *radiance / divisor;
        }
        LightSample { pdf: density, ..sample }
    }

    /// Samples lights that differ between lanes.
    #[inline(always)]
    fn sample_chosen<L: Lanes>(&self, lanes: L, chosen: L::I, from: [L::F; 3], u: [L::F; 2]) -> LightSample<L, S> {
        let mut numbers = [0; MAX_LANES];
        lanes.store_int(&mut numbers, chosen);
        let zero = lanes.splat(0.0);
        let mut sample = LightSample::new(lanes, [zero; 3], zero, S::ZERO, zero, zero.lt(zero));
        let mut left = (1u32 << L::LANES) - 1;
        while left != 0 {
            let number = numbers[left.trailing_zeros() as usize & (MAX_LANES - 1)];
            let here = chosen.eq(lanes.splat_int(number));
            sample = sample.or(lanes, here, self.all[number as usize].sample_li(lanes, from, u));
            left &= !here.bits();
        }
        sample
    }

    /// The light that arrives along a ray that has reached this light.
    #[inline]
    pub fn emitted(&self, light: usize, ray: &LightRay) -> Emitted<S> {
        let chance = self.chances[light];
        match &self.all[light] {
            Light::Area(area) => {
                let pdf_li = chance * self.all[light].pdf_li(ray);
                Emitted { radiance: area.emitted(ray.cos > 0.0), pdf_li }
            }
            Light::Environment(environment) => {
                let (radiance, pdf) = environment.radiance_and_pdf(ray.wi);
                Emitted { radiance, pdf_li: chance * pdf }
            }
            Light::Point { .. } | Light::Spot { .. } | Light::Directional { .. } => {
                Emitted { radiance: S::ZERO, pdf_li: 0.0 }
            }
        }
    }

    /// The probability that a light is chosen.
    pub fn chance(&self, light: usize) -> f32 {
        self.chances[light]
    }
}

#[cfg(test)]
mod tests {
    use lobe_scalar::{Reference, Scalar};

    use super::*;
    use crate::light::{AreaLight, Environment};

    fn lights() -> Lights<[f32; 3]> {
        let corners =
            [[[-1.0, 2.0, 0.0], [1.0, 2.0, 0.0], [0.0, 2.0, 1.0]], [[1.0, 2.0, 0.0], [0.0, 3.0, 0.0], [0.0; 3]]];
        let sky = Environment::gradient([0.2, 0.3, 0.9], [0.8; 3], [0.1; 3]).unwrap();
        let (position, direction) = ([0.3, 1.5, 0.2], [0.0, -1.0, 0.0]);
        let all = vec![
            Light::Point { position, intensity: [1.0, 2.0, 3.0] },
            Light::Spot { position, direction, intensity: [3.0, 2.0, 1.0], falloff: [0.9, 0.5] },
            Light::Directional { toward: [0.0, 1.0, 0.0], irradiance: [4.0; 3] },
            Light::Area(AreaLight::new(corners.into(), [5.0, 6.0, 7.0], true).unwrap()),
            Light::Environment(sky),
        ];
        Lights::new(all, SceneBounds { center: [0.0; 3], radius: 2.0 })
    }

    #[test]
    fn lanes_on_different_lights_sample_as_each_does_alone() {
        let (lights, lanes, alone) = (lights(), Scalar::<8>, Reference::default());
        let mut found = [0; 5];
        for round in 0..64 {
            let number = |lane: usize, step: f32| ((8 * round + lane) as f32 * step).fract();
            let row = |step: f32| lanes.load(&[0, 1, 2, 3, 4, 5, 6, 7].map(|lane| number(lane, step)));
            let from = [row(0.37), row(0.11), row(0.23)];
            let u = [row(0.618_034), row(0.754_878), row(0.569_84)];
            let many = lights.sample_li(lanes, None, from, u);
            for lane in 0..8 {
                let [from, u] = [from, u].map(|rows| alone.splat_xyz(lanes.extract_xyz(rows, lane)));
                let (chosen, _) = lights.cdf.sample(alone, alone.splat_int(0), u[0]);
                let light = alone.extract_int(chosen, 0) as usize;
                let one = lights.sample_li(alone, Some(light), from, u);
                assert_eq!(one.valid.any(), many.valid.bits() >> lane & 1 != 0, "light {light}");
                if !one.valid.any() {
                    continue;
                }
                found[light] += 1;
                assert_eq!(alone.extract_xyz(one.wi, 0), lanes.extract_xyz(many.wi, lane), "light {light}");
                assert_eq!(alone.extract(one.distance, 0), lanes.extract(many.distance, lane), "light {light}");
                let chance = lights.chance(light);
                let pdf = alone.extract(one.pdf, 0) * chance;
                assert_eq!(pdf, lanes.extract(many.pdf, lane), "light {light}");
                assert_eq!(pdf == f32::INFINITY, lights.all[light].is_delta());
                let radiance = alone.extract_xyz(one.radiance, 0).map(|x| x / chance);
                for (expected, found) in radiance.into_iter().zip(lanes.extract_xyz(many.radiance, lane)) {
                    assert!((expected - found).abs() <= 1e-6 * expected, "light {light}: {found}, not {expected}");
                }
            }
        }
        assert!(found.iter().all(|&n| n > 10), "{found:?}");
    }
}
