//! A material on one shape, under a movable lamp and a sky, for looking at it interactively.
//!
//! The camera stands on the +z axis and looks along -z, a little down; +y is up.

use std::sync::Arc;

use lobe_mesh::{generate, shapes};

use crate::camera::Camera;
use crate::light::{Environment, EnvironmentError, Light};
use crate::preview::{CLOTH, LENS, cloth};
use crate::shader::{Backend, Lambert, Shader};
use crate::transform::Transform;
use crate::vec3::{Vec3, dot, scale, unit};
use crate::world::{World, WorldBuilder, WorldError};

/// The shape that has the material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// A ball on a stand.
    #[default]
    Ball,
    /// A draped cloth, with psi measured from its weft.
    Cloth,
    /// A flat sample that lies before the camera, its x axis to the right.
    Flat,
}

/// The surroundings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sky {
    /// The walls of a bright room.
    #[default]
    Studio,
    /// A clouded sky, three times as bright at the zenith as at the horizon (the overcast sky of CIE 110).
    Overcast,
    /// Blue above, orange at the horizon.
    Dusk,
    /// No light except the lamp.
    Dark,
}

/// A lamp and a sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lighting {
    /// The direction toward the lamp, which is far away; of any length except 0.
    pub toward: [f32; 3],
    /// The surroundings.
    pub sky: Sky,
}

/// The angle from the middle of the lamp to its rim, in radians.
const LAMP: f32 = 0.105;
/// The irradiance of a surface that faces the lamp.
const IRRADIANCE: f32 = 2.6;

/// Builds a scene of the shape and a floor that bends into a wall, with its lights and its camera. Everything except
/// the material runs on `backend`.
///
/// # Errors
/// If the lamp is nowhere.
pub fn stage(
    material: Arc<dyn Shader>,
    form: Form,
    lighting: &Lighting,
    backend: Backend,
) -> Result<(World, Camera), StageError> {
    let mut world = WorldBuilder::new();
    let material = world.material(material);
    let backdrop = world.material(Arc::new(Lambert::new([0.32; 3], backend)));
    let stand = world.material(Arc::new(Lambert::new([0.12; 3], backend)));
    let here = Transform { axes: Transform::IDENTITY, translate: [0.0; 3] };
    let cove = shapes::cove(24.0, 24);
    world.shape(&here.shape(&cove, cove.triangles.clone()), backdrop, None, false)?;
    match form {
        Form::Ball => {
            let ball = generate::ball().complete();
            for group in &ball.groups {
                let range = group.triangles.start as usize..group.triangles.end as usize;
                let shape = here.shape(&ball, ball.triangles[range].to_vec());
                world.shape(&shape, if group.name == "pedestal" { stand } else { material }, None, false)?;
            }
        }
        Form::Cloth => {
            let cloth = cloth();
            let moved = Transform { axes: Transform::IDENTITY.map(|axis| scale(axis, CLOTH)), translate: [0.0; 3] };
            world.shape(&moved.shape(&cloth, cloth.triangles.clone()), material, None, false)?;
        }
        Form::Flat => {
            let sample = shapes::plane(3.4, 1).complete();
            let raised = Transform { axes: Transform::IDENTITY, translate: [0.0, 0.25, 0.0] };
            world.shape(&raised.shape(&sample, sample.triangles.clone()), material, None, false)?;
            let slab = shapes::cuboid([3.4, 0.24, 3.4], 1).complete();
            let below = Transform { axes: Transform::IDENTITY, translate: [0.0, 0.125, 0.0] };
            world.shape(&below.shape(&slab, slab.triangles.clone()), stand, None, false)?;
        }
    }
    let camera = match form {
        Form::Ball => Camera { position: [0.0, 2.3, 8.4], target: [0.0, 1.22, 0.0], ..LENS },
        Form::Cloth => Camera { position: [0.0, 2.6, 7.4], target: [0.0, 0.9, 0.0], ..LENS },
        Form::Flat => Camera { position: [0.0, 4.6, 8.2], target: [0.0, 0.2, 0.0], ..LENS },
    };
    Ok((world.build()?.lit_by(lights(lighting)?), camera))
}

/// The reason why a stage cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StageError {
    /// The lamp has no direction.
    #[error("found the lamp toward {toward:?}; expected a finite direction other than 0")]
    Lamp {
        /// The requested direction.
        toward: [f32; 3],
    },
    /// The shapes do not form a world.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The surroundings do not form an environment.
    #[error(transparent)]
    Environment(#[from] EnvironmentError),
}

/// The lights of a stage, for [`World::lit_by`].
///
/// # Errors
/// If the lamp is nowhere.
pub fn lights(lighting: &Lighting) -> Result<Vec<Light>, StageError> {
    const WIDTH: usize = 256;
    const HEIGHT: usize = 128;
    let Lighting { toward, sky } = *lighting;
    let lamp = unit(toward).filter(|lamp| lamp.iter().all(|c| c.is_finite())).ok_or(StageError::Lamp { toward })?;
    // A disk of this radiance gives the irradiance; its rim is as soft as a texel.
    let radiance = IRRADIANCE / (std::f32::consts::PI * LAMP * LAMP);
    let softness = std::f32::consts::PI / HEIGHT as f32;
    let mut texels = Vec::with_capacity(WIDTH * HEIGHT);
    for row in 0..HEIGHT {
        let polar = std::f32::consts::PI * (row as f32 + 0.5) / HEIGHT as f32;
        let (sin, cos) = (libm::sinf(polar), libm::cosf(polar));
        let ground = sky.radiance(cos);
        for column in 0..WIDTH {
            // The middle of the image is -z, and its right quarter +x.
            let turn = std::f32::consts::TAU * ((column as f32 + 0.5) / WIDTH as f32 - 0.5);
            let direction: Vec3 = [sin * libm::sinf(turn), cos, -sin * libm::cosf(turn)];
            let angle = libm::acosf(dot(direction, lamp).clamp(-1.0, 1.0));
            let cover = ((LAMP - angle) / softness + 0.5).clamp(0.0, 1.0);
            texels.push([0, 1, 2].map(|k| ground[k] + cover * radiance * [1.0, 0.98, 0.94][k]));
        }
    }
    Ok(vec![Light::Environment(Environment::image(WIDTH, HEIGHT, texels, 0.0)?)])
}

impl Sky {
    /// The radiance in a direction; `height` is the cosine of its angle from the zenith.
    fn radiance(self, height: f32) -> Vec3 {
        let between = |from: Vec3, to: Vec3, t: f32| [0, 1, 2].map(|k| from[k] + t * (to[k] - from[k]));
        let (up, t) = (height > 0.0, libm::sqrtf(height.abs()));
        match self {
            Sky::Studio => between([0.34, 0.35, 0.37], if up { [0.6, 0.63, 0.7] } else { [0.1; 3] }, t),
            Sky::Overcast if up => [0.3, 0.31, 0.33].map(|c| c * (1.0 + 2.0 * height)),
            Sky::Overcast => between([0.3, 0.31, 0.33], [0.12; 3], t),
            Sky::Dusk => between([0.95, 0.5, 0.24], if up { [0.05, 0.1, 0.26] } else { [0.05, 0.04, 0.05] }, t),
            Sky::Dark => [0.0; 3],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lamp_has_its_direction_and_its_irradiance() {
        for toward in [[-0.5, 0.7, 0.6], [0.0, 2.0, 0.1], [0.9, 0.1, -0.4]] {
            let lights = lights(&Lighting { toward, sky: Sky::Dark }).unwrap();
            let [Light::Environment(environment)] = lights.as_slice() else { panic!("{lights:?}") };
            // All light comes from the lamp, so the mean over the sphere is about its irradiance over 4 pi.
            let mean = environment.mean() as f32 * 4.0 * std::f32::consts::PI;
            assert!((mean / (0.973 * IRRADIANCE) - 1.0).abs() < 0.06, "{mean} from {toward:?}");
            let lamp = unit(toward).unwrap();
            assert!(environment.radiance_and_pdf(lamp).0[1] > 60.0, "{toward:?}");
            assert_eq!(environment.radiance_and_pdf(scale(lamp, -1.0)).0, [0.0; 3]);
        }
    }

    #[test]
    fn a_lamp_without_a_direction_is_refused() {
        let error = lights(&Lighting { toward: [0.0; 3], sky: Sky::Studio }).unwrap_err();
        assert!(error.to_string().contains("expected a finite direction"), "{error}");
        assert!(lights(&Lighting { toward: [f32::NAN, 0.0, 0.0], sky: Sky::Studio }).is_err());
    }
}
