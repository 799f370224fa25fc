//! `[camera]`, `[film]` and `[integrator]`.

use std::sync::Arc;

use super::node::{Node, SceneError};
use crate::camera::{Camera, Filter, View};
use crate::integrator::{self, INTEGRATORS, Integrator};

/// The largest side of a picture.
const SIDE: u32 = 65_536;
/// The largest number of pixels of a picture: its sums take a hundred and fifty times as many bytes.
const AREA: u64 = 1 << 27;

pub(super) fn camera(root: &Node<'_, '_>) -> Result<Camera, SceneError> {
    let Some(node) = root.child("camera")? else {
        return Err(root.error("camera", "found nothing; expected the table [camera]"));
    };
    let degrees = "degrees above 0 and below 180";
    let length = "a number from 0 to 1e6";
    let camera = Camera {
        position: node.required_vector("position")?,
        target: node.required_vector("target")?,
        up: node.vector("up")?.unwrap_or([0.0, 1.0, 0.0]),
        field_of_view: node
            .number("field_of_view", degrees, |x| x > 0.01 && x < 179.9)?
            .map_or(40f32.to_radians(), |x| x.to_radians() as f32),
        lens_radius: node.number("lens_radius", length, |x| (0.0..=1e6).contains(&x))?.unwrap_or(0.0) as f32,
        focus_distance: node
            .number("focus_distance", "a number above 0 and up to 1e9", |x| x > 1e-9 && x <= 1e9)?
            .map(|x| x as f32),
    };
    node.finish()?;
    View::new(&camera, [1, 1], Filter::Box).map_err(|error| node.error("target", error.to_string()))?;
    Ok(camera)
}

pub(super) fn film(root: &Node<'_, '_>) -> Result<([u32; 2], Filter, f32), SceneError> {
    let Some(node) = root.child("film")? else { return Ok(([800, 600], Filter::default(), 0.0)) };
    let size = [node.whole("width", 1..=SIDE)?.unwrap_or(800), node.whole("height", 1..=SIDE)?.unwrap_or(600)];
    if u64::from(size[0]) * u64::from(size[1]) > AREA {
        let message = format!("found {} x {} pixels; expected at most {AREA}", size[0], size[1]);
        return Err(node.error("width", message));
    }
    let filter = match node.text("filter")? {
        None | Some("tent") => Filter::Tent,
        Some("box") => Filter::Box,
        Some(found) => return Err(node.error("filter", format!("found `{found}`; expected box or tent"))),
    };
    let exposure = node.number("exposure", "stops from -30 to 30", |x| x.abs() <= 30.0)?.unwrap_or(0.0);
    node.finish()?;
    Ok((size, filter, exposure as f32))
}

/// An integrator and the samples per pixel.
pub(super) fn integrator(root: &Node<'_, '_>) -> Result<(Arc<dyn Integrator>, u32), SceneError> {
    const SAMPLES: u32 = 64;
    let first = &INTEGRATORS[0];
    let Some(node) = root.child("integrator")? else { return Ok(((first.default)(), SAMPLES)) };
    let kind = node.text("kind")?.unwrap_or(first.name);
    let Some(spec) = integrator::named(kind) else {
        let names: Vec<&str> = INTEGRATORS.iter().map(|spec| spec.name).collect();
        let (last, others) = names.split_last().expect("there are integrators");
        let message = format!("found `{kind}`; expected {} or {last}", others.join(", "));
        return Err(node.error("kind", message));
    };
    let integrator = (spec.read)(&node)?;
    let samples = node.whole("samples", 1..=u32::MAX - 1)?.unwrap_or(SAMPLES);
    node.finish()?;
    Ok((integrator, samples))
}
