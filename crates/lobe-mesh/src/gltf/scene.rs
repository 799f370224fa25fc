//! The tree of nodes, and the single mesh made from all of its meshes (section 3.5).

use glam::{DMat3, DMat4, DQuat, DVec3};
use lobe_files::FormatError;

use super::document::{Mesh, Node};
use super::{Budget, Source, skin};
use crate::file::{self, wrong};
use crate::geometry::{narrow, wide};
use crate::{Geometry, Group, Parts, normals};

/// Puts the meshes of the scene together.
pub(super) fn assemble(source: &Source<'_>, mut budget: Budget<'_>) -> Result<Geometry, FormatError> {
    let mut whole = Parts::default();
    let placed = placed(source)?;
    let mut nodes = vec![None; source.document.nodes.len()];
    placed.iter().for_each(|placed| nodes[placed.node] = Some(placed.place));
    for &Placed { node: index, place } in &placed {
        let node = &source.document.nodes[index];
        let Some(mesh) = node.mesh else { continue };
        let mesh = source.item(&source.document.meshes, mesh, "mesh")?;
        let shares = node.weights.as_ref().or(mesh.weights.as_ref()).map_or(&[][..], Vec::as_slice);
        for primitive in &mesh.primitives {
            let Some(mut parts) = source.primitive(primitive, shares, &mut budget)? else { continue };
            match node.skin {
                None => transform(&mut parts, |_| place),
                Some(skin) => {
                    let places = skin::places(source, skin, &primitive.attributes, &nodes, &mut budget)?;
                    if places.len() != parts.positions.len() {
                        let found = format!("joints of {} vertices of {}", places.len(), parts.positions.len());
                        return Err(wrong(source.path, found, "those of each vertex"));
                    }
                    transform(&mut parts, |vertex| places[vertex]);
                }
            }
            let material = match primitive.material {
                Some(index) => {
                    let material = source.item(&source.document.materials, index, "material")?;
                    Some(material.name.clone().unwrap_or_else(|| format!("material {index}")))
                }
                None => None,
            };
            let name = name(node, mesh);
            budget.take(1, name.len() + material.as_ref().map_or(0, String::len))?;
            append(&mut whole, parts, name, material);
        }
    }
    file::geometry(source.path, whole)
}

fn name(node: &Node, mesh: &Mesh) -> String {
    node.name.clone().or_else(|| mesh.name.clone()).unwrap_or_default()
}

/// A node of the scene and its transform to scene coordinates.
#[derive(Clone, Copy)]
struct Placed {
    node: usize,
    place: DMat4,
}

/// All nodes of the scene, parents first.
fn placed(source: &Source<'_>) -> Result<Vec<Placed>, FormatError> {
    let nodes = &source.document.nodes;
    let mut stack: Vec<(usize, DMat4)> = roots(source)?.into_iter().rev().map(|root| (root, DMat4::IDENTITY)).collect();
    let mut seen = vec![false; nodes.len()];
    let mut placed = Vec::new();
    while let Some((index, parent)) = stack.pop() {
        let node = source.item(nodes, index, "node")?;
        if std::mem::replace(&mut seen[index], true) {
            return Err(wrong(source.path, format!("node {index} in two places"), "a tree of nodes"));
        }
        let place = parent * local(node);
        stack.extend(node.children.iter().rev().map(|&child| (child, place)));
        placed.push(Placed { node: index, place });
    }
    Ok(placed)
}

/// The nodes at the top of the scene; if the file has no scenes, the nodes without a parent.
fn roots(source: &Source<'_>) -> Result<Vec<usize>, FormatError> {
    let document = source.document;
    if document.scenes.is_empty() {
        let mut top = vec![true; document.nodes.len()];
        for &child in document.nodes.iter().flat_map(|node| &node.children) {
            source.item(&document.nodes, child, "node")?;
            top[child] = false;
        }
        return Ok((0..top.len()).filter(|&node| top[node]).collect());
    }
    Ok(source.item(&document.scenes, document.scene.unwrap_or(0), "scene")?.nodes.clone())
}

fn local(node: &Node) -> DMat4 {
    if let Some(matrix) = &node.matrix {
        return DMat4::from_cols_array(matrix);
    }
    let rotation = node.rotation.map_or(DQuat::IDENTITY, DQuat::from_array);
    // Quaternions in files are rounded; one of length zero rotates nothing.
    let rotation = if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY };
    let scale = node.scale.map_or(DVec3::ONE, DVec3::from_array);
    DMat4::from_scale_rotation_translation(scale, rotation, node.translation.map_or(DVec3::ZERO, DVec3::from_array))
}

/// Transforms each vertex to its place. A reflection reverses the orientation of triangles and frames.
fn transform(parts: &mut Parts, place: impl Fn(usize) -> DMat4) {
    for (vertex, position) in parts.positions.iter_mut().enumerate() {
        *position = narrow(place(vertex).transform_point3(wide(*position)));
    }
    let linear = |vertex: usize| DMat3::from_mat4(place(vertex));
    let sign = |linear: &DMat3| if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
    for (vertex, normal) in parts.normals.iter_mut().flatten().enumerate() {
        let linear = linear(vertex);
        // The inverse transpose up to scale, which also exists if a mesh is squashed flat.
        let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
        let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign(&linear);
        *normal = narrow((cofactors * wide(*normal)).normalize_or_zero());
    }
    for (vertex, [x, y, z, w]) in parts.tangents.iter_mut().flatten().enumerate() {
        let linear = linear(vertex);
        [*x, *y, *z] = narrow((linear * wide([*x, *y, *z])).normalize_or_zero());
        *w *= sign(&linear) as f32;
    }
    for triangle in &mut parts.triangles {
        if linear(triangle[0] as usize).determinant() < 0.0 {
            triangle.swap(1, 2);
        }
    }
}

/// Adds a group. If only one of the two has normals or texture coordinates, the other gets smooth normals or (0, 0).
/// Unless both have tangents, they are left to be computed.
fn append(whole: &mut Parts, mut parts: Parts, name: String, material: Option<String>) {
    let (first, start) = (whole.positions.len() as u32, whole.triangles.len() as u32);
    if first == 0 {
        whole.normals = parts.normals.is_some().then(Vec::new);
        whole.uvs = parts.uvs.is_some().then(Vec::new);
        whole.tangents = parts.tangents.is_some().then(Vec::new);
    }
    match (&mut whole.normals, &mut parts.normals) {
        (None, None) | (Some(_), Some(_)) => {}
        (missing @ None, _) => *missing = Some(normals::smooth(&whole.positions, &whole.triangles)),
        (_, missing) => *missing = Some(normals::smooth(&parts.positions, &parts.triangles)),
    }
    match (&mut whole.uvs, &mut parts.uvs) {
        (None, None) | (Some(_), Some(_)) => {}
        (missing @ None, _) => *missing = Some(vec![[0.0; 2]; whole.positions.len()]),
        (_, missing) => *missing = Some(vec![[0.0; 2]; parts.positions.len()]),
    }
    if parts.tangents.is_none() {
        whole.tangents = None;
    }
    whole.positions.append(&mut parts.positions);
    whole.triangles.extend(parts.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
    for (all, mut more) in whole.normals.iter_mut().zip(parts.normals) {
        all.append(&mut more);
    }
    for (all, mut more) in whole.uvs.iter_mut().zip(parts.uvs) {
        all.append(&mut more);
    }
    for (all, mut more) in whole.tangents.iter_mut().zip(parts.tangents) {
        all.append(&mut more);
    }
    whole.groups.push(Group { name, material, triangles: start..whole.triangles.len() as u32 });
}
