//! What shines, and how light is drawn for a point of a surface.

mod area;
mod environment;
mod sums;

pub use area::AreaLight;
pub use environment::{Environment, EnvironmentError};

use crate::vec3::{Vec3, dot, length, scale, sub};

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

/// A place on a light, drawn for a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lit<const C: usize> {
    /// Toward the light, unit length.
    pub wi: Vec3,
    /// How far it is; may be infinite.
    pub distance: f32,
    /// Radiance; where the light has no extent, the irradiance of a surface that faces it.
    pub radiance: [f32; C],
    /// Density over solid angle, 1/sr; `None` where the light has no extent.
    pub pdf: Option<f32>,
}

impl<const C: usize> Light<C> {
    /// Draws a place on it for the point `from`. `None` where no light comes.
    pub(crate) fn draw(&self, from: Vec3, u: [f32; 2]) -> Option<Lit<C>> {
        match self {
            Light::Point { position, intensity } => at(from, *position, *intensity),
            Light::Spot { position, direction, intensity, falloff: [full, none] } => {
                let lit = at(from, *position, *intensity)?;
                let cos = -dot(lit.wi, *direction);
                let t = ((cos - none) / (full - none).max(1e-6)).clamp(0.0, 1.0);
                let share = t * t * (3.0 - 2.0 * t);
                (share > 0.0).then(|| Lit { radiance: lit.radiance.map(|x| x * share), ..lit })
            }
            Light::Directional { toward, irradiance } => {
                Some(Lit { wi: *toward, distance: f32::INFINITY, radiance: *irradiance, pdf: None })
            }
            Light::Area(area) => area.draw(from, u),
            Light::Environment(environment) => environment.draw(u),
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

/// A point light seen from a point.
fn at<const C: usize>(from: Vec3, position: Vec3, intensity: [f32; C]) -> Option<Lit<C>> {
    let toward = sub(position, from);
    let distance = length(toward);
    let near = 1.0 / (distance * distance);
    (distance > 0.0 && near.is_finite()).then(|| Lit {
        wi: scale(toward, 1.0 / distance),
        distance,
        radiance: intensity.map(|x| x * near),
        pdf: None,
    })
}

/// All lights of a scene and the chance of each to be chosen.
#[derive(Clone, Debug)]
pub(crate) struct Lights<const C: usize> {
    pub all: Vec<Light<C>>,
    /// The chance of each.
    chances: Vec<f32>,
    /// The sum of the chances up to and with each.
    sums: Vec<f32>,
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
        let chances: Vec<f32> = powers.iter().map(|&power| (0.5 * by_power(power) + 0.5 * equal) as f32).collect();
        let sums = chances.iter().scan(0.0, |sum, chance| Some(add_to(sum, *chance))).collect();
        let environment = all.iter().position(|light| matches!(light, Light::Environment(_)));
        Lights { all, chances, sums, environment }
    }

    /// A light and its chance, for a number in `[0, 1)`. `None` where there are no lights.
    pub fn choose(&self, u: f32) -> Option<(usize, f32)> {
        let last = self.all.len().checked_sub(1)?;
        let light = self.sums.partition_point(|&sum| sum <= u).min(last);
        Some((light, self.chances[light]))
    }

    /// The chance of a light.
    pub fn chance(&self, light: usize) -> f32 {
        self.chances[light]
    }
}

fn add_to(sum: &mut f32, chance: f32) -> f32 {
    *sum += chance;
    *sum
}
