//! `[[object]]`: a mesh file or a named shape with a material and a place in the world.

use std::collections::BTreeMap;

use lobe_mesh::{Geometry, Shading, generate, shapes};

use super::node::{Node, SceneError};
use super::{Reading, light};
use crate::preview;
use crate::transform::Transform;
use crate::transport::Transport;

const SHAPES: &str = "sphere, plane, disk, cuboid, cove, ring, waves, knot, ball or drape";

pub(super) fn read<T: Transport>(root: &Node<'_, '_>, reading: &mut Reading<'_, T>) -> Result<(), SceneError> {
    for node in root.children("object")? {
        let geometry = geometry(&node, reading)?;
        let shading = match node.text("shading")? {
            None | Some("smooth") => Shading::Smooth,
            Some("flat") => Shading::Flat,
            Some(found) => return Err(node.error("shading", format!("found `{found}`; expected smooth or flat"))),
        };
        let geometry = if shading == Shading::Flat { geometry.with_normals(shading) } else { geometry };
        let geometry = refined(&node, geometry.complete())?;
        let place = self::place(&node)?;
        let radiance = reading.light(&node, "radiance")?;
        let two_sided = node.flag("two_sided")?;
        let polarisation = light::polarisation(&node, false)?;
        if polarisation.is_some() && radiance.is_none() {
            return Err(node.error("polarised", "found no `radiance`; expected a shape that emits light"));
        }
        let first_light = reading.world.light_count();
        let material = named(&node, reading, "material")?;
        let by_group = groups(&node, reading, &geometry)?;
        node.finish()?;
        // One shape for each group of triangles with a different material.
        let mut shapes: BTreeMap<usize, Vec<[u32; 3]>> = BTreeMap::new();
        for (group, number) in geometry.groups.iter().zip(by_group) {
            let range = group.triangles.start as usize..group.triangles.end as usize;
            shapes.entry(number.unwrap_or(material)).or_default().extend(&geometry.triangles[range]);
        }
        for (material, triangles) in shapes {
            let shape = place.shape(&geometry, triangles);
            let added = reading.world.shape(&shape, material, radiance, two_sided);
            added.map_err(|error| node.error("", error.to_string()))?;
        }
        if let Some(polarisation) = polarisation {
            reading.world.polarise(first_light, polarisation);
        }
    }
    Ok(())
}

fn geometry<T: Transport>(node: &Node<'_, '_>, reading: &mut Reading<'_, T>) -> Result<Geometry, SceneError> {
    let positive = |key: &str, default: f64| {
        let found = node.number(key, "a number above 0 and up to 1e6", |x| x > 1e-6 && x <= 1e6)?;
        Ok::<f32, SceneError>(found.unwrap_or(default) as f32)
    };
    match (reading.file(node, "file")?, node.text("shape")?) {
        (Some(path), None) => lobe_mesh::read(&path).map_err(|error| node.error("file", error.to_string())),
        (None, Some(shape)) => {
            let segments = node.whole("segments", 3..=2048)?;
            // Triangles for each pair of segments; shapes not listed have few.
            let each = [("sphere", 1), ("plane", 2), ("waves", 2), ("cuboid", 12)]
                .into_iter()
                .find(|(name, _)| *name == shape);
            room(node, "segments", each.map_or(0, |(_, each)| each * u64::from(segments.unwrap_or(1)).pow(2)))?;
            Ok(match shape {
                "sphere" => shapes::sphere(positive("radius", 1.0)?, segments.unwrap_or(128)),
                "plane" => shapes::plane(positive("size", 1.0)?, segments.unwrap_or(1)),
                "disk" => shapes::disk(positive("radius", 1.0)?, segments.unwrap_or(64)),
                "cuboid" => {
                    let edge = "three numbers above 0 and up to 1e6";
                    let size = node.three("size", edge, |x| x > 1e-6 && x <= 1e6)?.unwrap_or([1.0; 3]);
                    shapes::cuboid(size.map(|x| x as f32), segments.unwrap_or(1))
                }
                "cove" => shapes::cove(positive("size", 1.0)?, segments.unwrap_or(32)),
                "ring" => {
                    let (radius, thickness) = (positive("radius", 1.0)?, positive("thickness", 0.1)?);
                    shapes::ring(radius, thickness, positive("height", 0.5)?, segments.unwrap_or(256))
                }
                "waves" => {
                    let segments = segments.unwrap_or(256);
                    room(node, "segments", 2 * u64::from(segments).pow(2))?;
                    shapes::waves(positive("size", 1.0)?, segments)
                }
                "knot" => generate::knot(),
                "ball" => generate::ball(),
                "drape" => preview::cloth(),
                found => return Err(node.error("shape", format!("found `{found}`; expected {SHAPES}"))),
            })
        }
        _ => Err(node.error("", "found no or too many keys; expected either `file` or `shape`")),
    }
}

/// The most triangles that `refine` may make from a mesh: a short scene must not fill the memory.
const MOST: u64 = 1 << 26;

/// The mesh, with its triangles cut as finely as `refine` requires.
fn refined(node: &Node<'_, '_>, geometry: Geometry) -> Result<Geometry, SceneError> {
    let Some(pieces) = node.whole("refine", 1..=32)? else { return Ok(geometry) };
    let triangles = geometry.triangles.len() as u64 * u64::from(pieces).pow(2);
    if triangles > MOST {
        return Err(node.error("refine", format!("found {pieces}, {triangles} triangles; expected at most {MOST}")));
    }
    room(node, "refine", triangles)?;
    geometry.refined(pieces).map_err(|error| node.error("refine", error.to_string()))
}

/// Fails if there is no memory for this many more triangles.
fn room(node: &Node<'_, '_>, key: &str, triangles: u64) -> Result<(), SceneError> {
    /// Bytes of a triangle: half a vertex, indices and its part of the tree, and copies made during construction.
    const TRIANGLE: u64 = 400;
    lobe_memory::require(triangles * TRIANGLE).map_err(|no_room| {
        node.error(
            key,
            format!("found {triangles} triangles, which take {no_room}; expected as many as fit into memory"),
        )
    })
}

/// The index of the material that a key names.
fn named<T: Transport>(node: &Node<'_, '_>, reading: &Reading<'_, T>, key: &str) -> Result<usize, SceneError> {
    let name = node.required_text(key, "the name of a material")?;
    reading.materials.get(name).copied().ok_or_else(|| {
        let known: Vec<&str> = reading.materials.keys().map(String::as_str).collect();
        node.error(key, format!("found `{name}`; expected one of the materials: {}", known.join(", ")))
    })
}

/// For each group of triangles, the material that `materials` gives for the name of its material or its own name.
fn groups<T: Transport>(
    node: &Node<'_, '_>,
    reading: &Reading<'_, T>,
    geometry: &Geometry,
) -> Result<Vec<Option<usize>>, SceneError> {
    let Some(table) = node.child("materials")? else { return Ok(vec![None; geometry.groups.len()]) };
    let mut found = vec![None; geometry.groups.len()];
    for name in table.keys() {
        let number = named(&table, reading, &name)?;
        let mut used = false;
        for (group, found) in geometry.groups.iter().zip(&mut found) {
            if group.material.as_deref() == Some(&*name) || group.name == name {
                (*found, used) = (Some(number), true);
            }
        }
        if !used {
            let names: Vec<&str> =
                geometry.groups.iter().map(|group| group.material.as_deref().unwrap_or(&group.name)).collect();
            return Err(table.error(&name, format!("no such group in the mesh; expected one of {}", names.join(", "))));
        }
    }
    Ok(found)
}

/// A transform that scales, then rotates about x, y and z in this order, then moves.
fn place(node: &Node<'_, '_>) -> Result<Transform, SceneError> {
    let size = |x: f64| (1e-6..=1e6).contains(&x);
    let scale = node.number("scale", "a number from 1e-6 to 1e6", size)?.unwrap_or(1.0);
    let turn = node.three("rotate", "three angles in degrees", |x| x.abs() <= 3600.0)?.unwrap_or([0.0; 3]);
    let translate = node.vector("translate")?.unwrap_or([0.0; 3]);
    let mut axes = [[scale, 0.0, 0.0], [0.0, scale, 0.0], [0.0, 0.0, scale]];
    for (axis, degrees) in turn.into_iter().enumerate() {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        for image in &mut axes {
            (image[a], image[b]) = (cos * image[a] - sin * image[b], sin * image[a] + cos * image[b]);
        }
    }
    Ok(Transform { axes: axes.map(|axis| axis.map(|x| x as f32)), translate })
}
