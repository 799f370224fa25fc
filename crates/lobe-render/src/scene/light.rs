//! `[[light]]`: points, spots, directions and the environment. Shapes that emit light are objects.

use super::Reading;
use super::node::{Node, SceneError};
use crate::light::{Environment, Light, LightPolarisation};
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
        let polarisation = polarisation(&node, matches!(light, Light::Environment(_)))?;
        node.finish()?;
        let number = reading.world.light_count();
        reading.world.light(light);
        if let Some(polarisation) = polarisation {
            reading.world.polarise(number, polarisation);
        }
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

/// The polarisation of a light: `axis` and `stokes`, or the `sun` and `degree` of a sky.
pub(super) fn polarisation(node: &Node<'_, '_>, is_sky: bool) -> Result<Option<LightPolarisation>, SceneError> {
    let Some(table) = node.child("polarised")? else { return Ok(None) };
    let direction = |key: &str| {
        let Some(vector) = table.vector(key)? else { return Ok(None) };
        let message = "found a direction of length 0; expected three numbers that are not all 0";
        unit(vector).map(Some).ok_or_else(|| table.error(key, message))
    };
    let found = match (direction("axis")?, direction("sun")?) {
        (Some(axis), None) => {
            let fits = |x: f64| x.abs() <= 1.0;
            let stokes = table.three("stokes", "three numbers from -1 to 1", fits)?.unwrap_or([1.0, 0.0, 0.0]);
            let degree = stokes.iter().map(|x| x * x).sum::<f64>().sqrt();
            if degree > 1.0 + 1e-6 {
                let found = format!("found light that is {:.1} % polarised", 100.0 * degree);
                return Err(table.error("stokes", format!("{found}; expected S1, S2 and S3 over S0 of at most 100 %")));
            }
            LightPolarisation::Axis { axis, stokes: stokes.map(|x| x as f32) }
        }
        (None, Some(sun)) if is_sky => {
            let degree = table.number("degree", "a number from 0 to 1", |x| (0.0..=1.0).contains(&x))?;
            LightPolarisation::Sky { sun, degree: degree.unwrap_or(1.0) as f32 }
        }
        _ => {
            let expected = if is_sky { "either `axis` or `sun`" } else { "`axis`" };
            return Err(table.error("", format!("found no or too many keys; expected {expected}")));
        }
    };
    table.finish()?;
    Ok(Some(found))
}
