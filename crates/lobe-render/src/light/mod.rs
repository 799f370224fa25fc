//! What shines, and how light is drawn for a point of a surface.

mod area;
mod cdf;
mod environment;

pub use area::AreaLight;
pub use environment::{Environment, EnvironmentError};

use lobe_lane::{Floats, Ints, Lanes, MAX_LANES, Mask};

use crate::vectors::{dot, scale, select, sub};
use cdf::Cdf;

/// A light of `C` channels.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Light<const C: usize> {
    /// From one point into all directions.
    Point {
        /// Where.
        position: [f32; 3],
        /// Radiant intensity in W/sr.
        intensity: [f32; C],
    },
    /// From one point into a cone.
    Spot {
        /// Where.
        position: [f32; 3],
        /// The axis, a unit vector away from the light.
        direction: [f32; 3],
        /// Radiant intensity along the axis in W/sr.
        intensity: [f32; C],
        /// Cosines of the angles from the axis where the light begins to fall off and where it ends, the larger first.
        falloff: [f32; 2],
    },
    /// Parallel light from infinitely far away.
    Directional {
        /// A unit vector toward the light.
        toward: [f32; 3],
        /// Irradiance of a surface that faces the light, in W/m^2.
        irradiance: [f32; C],
    },
    /// Triangles that radiate.
    Area(AreaLight<C>),
    /// Radiance from all directions.
    Environment(Environment<C>),
}

/// A place on a light a lane, drawn for points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightSample<L: Lanes, const C: usize> {
    /// Toward the light, unit length.
    pub wi: [L::F; 3],
    /// How far it is; may be infinite.
    pub distance: L::F,
    /// Radiance; where the light has no extent, the irradiance of a surface that faces it.
    pub radiance: [L::F; C],
    /// Density over solid angle, 1/sr; infinite where the light has no extent.
    pub pdf: L::F,
    /// Whether light comes at all; where none does, the other numbers may be any.
    pub valid: L::M,
}

impl<L: Lanes, const C: usize> LightSample<L, C> {
    /// The same radiance in all lanes.
    #[inline(always)]
    fn new(lanes: L, wi: [L::F; 3], distance: L::F, radiance: [f32; C], pdf: L::F, valid: L::M) -> Self {
        let mut sample = LightSample { wi, distance, radiance: [lanes.splat(0.0); C], pdf, valid };
        for (sample, radiance) in sample.radiance.iter_mut().zip(radiance) {
            *sample = lanes.splat(radiance);
        }
        sample
    }

    /// The radiance multiplied.
    #[inline(always)]
    fn scaled(mut self, factor: L::F) -> Self {
        for radiance in &mut self.radiance {
            *radiance = *radiance * factor;
        }
        self
    }

    /// `other` in the lanes of `mask`.
    #[inline(always)]
    fn or(mut self, lanes: L, mask: L::M, other: Self) -> Self {
        self.wi = select(lanes, mask, other.wi, self.wi);
        self.distance = lanes.select(mask, other.distance, self.distance);
        for (radiance, other) in self.radiance.iter_mut().zip(other.radiance) {
            *radiance = lanes.select(mask, other, *radiance);
        }
        self.pdf = lanes.select(mask, other.pdf, self.pdf);
        self.valid = (mask & other.valid) | (!mask & self.valid);
        self
    }
}

impl<const C: usize> Light<C> {
    /// Draws places on it for the points `from`.
    #[inline(always)]
    fn sample_li<L: Lanes>(&self, lanes: L, from: [L::F; 3], u: [L::F; 2]) -> LightSample<L, C> {
        match self {
            Light::Point { position, intensity } => at(lanes, from, *position, *intensity),
            Light::Spot { position, direction, intensity, falloff: [full, none] } => {
                let sample = at(lanes, from, *position, *intensity);
                let cos = -dot::<L>(sample.wi, lanes.splat_xyz(*direction));
                let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
                let t = (cos - lanes.splat(*none)) / lanes.splat((full - none).max(1e-6));
                let t = t.max(zero).min(one);
                let share = t * t * (lanes.splat(3.0) - lanes.splat(2.0) * t);
                LightSample { valid: sample.valid & zero.lt(share), ..sample.scaled(share) }
            }
            Light::Directional { toward, irradiance } => {
                let (wi, infinite) = (lanes.splat_xyz(*toward), lanes.splat(f32::INFINITY));
                LightSample::new(lanes, wi, infinite, *irradiance, infinite, infinite.eq(infinite))
            }
            Light::Area(area) => area.sample_li(lanes, from, u),
            Light::Environment(environment) => environment.sample_li(lanes, u),
        }
    }

    /// Whether it has no extent, so that no ray finds it by chance.
    pub fn is_delta(&self) -> bool {
        !matches!(self, Light::Area(_) | Light::Environment(_))
    }

    /// Roughly the power that reaches a scene of this radius, to choose lights by.
    fn power(&self, radius: f64) -> f64 {
        use std::f64::consts::PI;
        let mean = |x: &[f32; C]| x.iter().map(|x| f64::from(*x)).sum::<f64>() / C as f64;
        let disk = PI * radius * radius;
        match self {
            Light::Point { intensity, .. } => 4.0 * PI * mean(intensity),
            Light::Spot { intensity, falloff, .. } => {
                2.0 * PI * (1.0 - 0.5 * f64::from(falloff[0] + falloff[1])) * mean(intensity)
            }
            Light::Directional { irradiance, .. } => disk * mean(irradiance),
            Light::Area(area) => PI * area.area() * mean(&area.radiance()),
            Light::Environment(environment) => 4.0 * PI * disk * environment.mean(),
        }
    }
}

/// A point light seen from points.
#[inline(always)]
fn at<L: Lanes, const C: usize>(
    lanes: L,
    from: [L::F; 3],
    position: [f32; 3],
    intensity: [f32; C],
) -> LightSample<L, C> {
    let toward = sub::<L>(lanes.splat_xyz(position), from);
    let (zero, one, infinite) = (lanes.splat(0.0), lanes.splat(1.0), lanes.splat(f32::INFINITY));
    let distance = dot::<L>(toward, toward).sqrt();
    let near = one / (distance * distance);
    let wi = scale::<L>(toward, one / distance);
    let valid = zero.lt(distance) & near.lt(infinite);
    LightSample::new(lanes, wi, distance, intensity, infinite, valid).scaled(near)
}

/// All lights of a scene and the chance of each to be chosen.
#[derive(Clone, Debug)]
pub(crate) struct Lights<const C: usize> {
    pub all: Vec<Light<C>>,
    /// The chance of each.
    chances: Vec<f32>,
    sums: Cdf,
    /// Which one is the environment.
    pub environment: Option<usize>,
}

impl<const C: usize> Lights<C> {
    /// Chances are by power, but half of them are equal: a light may be weak and near.
    pub fn new(all: Vec<Light<C>>, radius: f64) -> Self {
        let powers: Vec<f64> = all.iter().map(|light| light.power(radius)).collect();
        let total: f64 = powers.iter().sum();
        let equal = 1.0 / all.len().max(1) as f64;
        let by_power = |power: f64| if total > 0.0 { power / total } else { equal };
        let chances: Vec<f64> = powers.iter().map(|&power| 0.5 * by_power(power) + 0.5 * equal).collect();
        let sums = Cdf::new(all.len(), &chances);
        let environment = all.iter().position(|light| matches!(light, Light::Environment(_)));
        Lights { all, chances: chances.into_iter().map(|chance| chance as f32).collect(), sums, environment }
    }

    /// Draws places for the points `from`: on that light, or on lights chosen by the first number. The radiance is over
    /// the density of the drawing. There must be a light.
    #[inline(always)]
    pub fn sample_li<L: Lanes>(
        &self,
        lanes: L,
        light: Option<usize>,
        from: [L::F; 3],
        [choice, u, v]: [L::F; 3],
    ) -> LightSample<L, C> {
        let (mut sample, chance) = match light {
            Some(light) => (self.all[light].sample_li(lanes, from, [u, v]), lanes.splat(1.0)),
            None => {
                let (chosen, _) = self.sums.sample(lanes, lanes.splat_int(0), choice);
                (self.sample_chosen(lanes, chosen, from, [u, v]), lanes.gather(&self.chances, chosen))
            }
        };
        let density = sample.pdf * chance;
        let extended = sample.pdf.lt(lanes.splat(f32::INFINITY));
        let divisor = lanes.select(extended, density, chance);
        for radiance in &mut sample.radiance {
            *radiance = *radiance / divisor;
        }
        LightSample { pdf: density, ..sample }
    }

    /// Samples on as many lights as there are in the lanes.
    #[inline(always)]
    fn sample_chosen<L: Lanes>(&self, lanes: L, chosen: L::I, from: [L::F; 3], u: [L::F; 2]) -> LightSample<L, C> {
        let mut numbers = [0; MAX_LANES];
        lanes.store_int(&mut numbers, chosen);
        let zero = lanes.splat(0.0);
        let mut sample = LightSample::new(lanes, [zero; 3], zero, [0.0; C], zero, zero.lt(zero));
        let mut left = (1u32 << L::LANES) - 1;
        while left != 0 {
            let number = numbers[left.trailing_zeros() as usize & (MAX_LANES - 1)];
            let here = chosen.eq(lanes.splat_int(number));
            sample = sample.or(lanes, here, self.all[number as usize].sample_li(lanes, from, u));
            left &= !here.bits();
        }
        sample
    }

    /// The chance of a light.
    pub fn chance(&self, light: usize) -> f32 {
        self.chances[light]
    }
}

#[cfg(test)]
mod tests {
    use lobe_scalar::{Reference, Scalar};

    use super::*;

    fn lights() -> Lights<3> {
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
        Lights::new(all, 2.0)
    }

    #[test]
    fn lanes_on_different_lights_draw_what_each_draws_alone() {
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
                let (chosen, _) = lights.sums.sample(alone, alone.splat_int(0), u[0]);
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
