//! `[[light]]`: points, spots, directions and the environment. Shapes that emit light are objects.

use super::Reading;
use super::node::{Node, SceneError};
use crate::light::{Environment, Light};
use crate::picture::read_environment_as;
use crate::transport::Transport;
use crate::vec3::{neg, sub, unit};

pub(super) fn read<T: Transport>(root: &Node<'_, '_>, reading: &mut Reading<'_, T>) -> Result<(), SceneError> {
    let mut surrounded = false;
    for node in root.children("light")? {
        let light = match node.required_text("kind", "point, spot, directional or environment")? {
            "point" => Light::Point {
                position: node.required_vector("position")?,
                intensity: reading.required_light(&node, "intensity")?,
            },
            "spot" => spot(&node, reading)?,
            "directional" => {
                let direction = node.required_vector("direction")?;
                let toward = unit(neg(direction)).ok_or_else(|| {
                    node.error(
                        "direction",
                        "found a direction of length 0; expected the direction in which the light travels",
                    )
                })?;
                Light::Directional { toward, irradiance: reading.required_light(&node, "irradiance")? }
            }
            "environment" => {
                if std::mem::replace(&mut surrounded, true) {
                    return Err(node.error("kind", "found a second environment; expected one at most"));
                }
                Light::Environment(environment(&node, reading)?)
            }
            found => {
                let message = format!("found `{found}`; expected point, spot, directional or environment");
                return Err(node.error("kind", message));
            }
        };
        node.finish()?;
        reading.world.light(light);
    }
    Ok(())
}

fn spot<T: Transport>(node: &Node<'_, '_>, reading: &Reading<'_, T>) -> Result<Light<T::Spectrum>, SceneError> {
    let position = node.required_vector("position")?;
    let target = node.required_vector("target")?;
    let direction = unit(sub(target, position))
        .ok_or_else(|| node.error("target", "found the position of the light itself; expected another point"))?;
    let half = "degrees above 0 and up to 180";
    let angle = node.number("angle", half, |x| x > 0.0 && x <= 180.0)?.unwrap_or(45.0);
    let inner = node.number("inner_angle", "degrees from 0 to `angle`", |x| (0.0..=angle).contains(&x))?;
    let cos = |angle: f64| libm::cos(0.5 * angle.to_radians()) as f32;
    let falloff = [cos(inner.unwrap_or(0.8 * angle)), cos(angle)];
    Ok(Light::Spot { position, direction, intensity: reading.required_light(node, "intensity")?, falloff })
}

/// An image, one radiance from all directions, or a gradient from the zenith through the horizon to the ground.
fn environment<T: Transport>(
    node: &Node<'_, '_>,
    reading: &mut Reading<'_, T>,
) -> Result<Environment<T::Spectrum>, SceneError> {
    let basis = reading.world.basis();
    if let Some(path) = reading.file(node, "file")? {
        let turn = node.number("turn", "degrees from -360 to 360", |x| x.abs() <= 360.0)?.unwrap_or(0.0);
        let scale = node.number("scale", "a number from 0 to 1e9", |x| (0.0..=1e9).contains(&x))?.unwrap_or(1.0);
        let emission = |rgb| T::emission(basis, rgb);
        return read_environment_as(&path, turn.to_radians() as f32, scale as f32, emission)
            .map_err(|error| node.error("file", error.to_string()));
    }
    if let Some(radiance) = reading.light(node, "radiance")? {
        return Environment::constant(radiance).map_err(|error| node.error("radiance", error.to_string()));
    }
    let zenith = node.required_colour("zenith", f64::MAX)?;
    let horizon = node.required_colour("horizon", f64::MAX)?;
    let ground = node.colour("ground", f64::MAX)?.unwrap_or(horizon);
    let [zenith, horizon, ground] = [zenith, horizon, ground].map(|rgb| T::emission(basis, rgb));
    Environment::gradient(zenith, horizon, ground).map_err(|error| node.error("zenith", error.to_string()))
}
