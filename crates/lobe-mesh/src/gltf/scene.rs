//! The tree of nodes, and the single mesh made from all of its meshes (section 3.5).

use glam::{DMat3, DMat4, DQuat, DVec3};
use lobe_files::FormatError;

use super::document::{Mesh, Node};
use super::{Budget, Source};
use crate::file::{self, wrong};
use crate::geometry::{narrow, wide};
use crate::{Geometry, Group, Parts, normals};

/// Puts the meshes of the scene together.
pub(super) fn assemble(source: &Source<'_>, mut budget: Budget<'_>) -> Result<Geometry, FormatError> {
    let mut whole = Parts::default();
    for (node, place) in placed(source)? {
        let Some(mesh) = node.mesh else { continue };
        let mesh = source.item(&source.document.meshes, mesh, "mesh")?;
        for primitive in &mesh.primitives {
            let Some(mut parts) = source.primitive(primitive, &mut budget)? else { continue };
            transform(&mut parts, place);
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

/// All nodes of the scene with their transforms to scene coordinates, parents first.
fn placed<'a>(source: &Source<'a>) -> Result<Vec<(&'a Node, DMat4)>, FormatError> {
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
        placed.push((node, place));
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

/// Transforms a mesh to its place. A reflection reverses the orientation of triangles and frames.
fn transform(parts: &mut Parts, place: DMat4) {
    for position in &mut parts.positions {
        *position = narrow(place.transform_point3(wide(*position)));
    }
    let linear = DMat3::from_mat4(place);
    let mirrored = linear.determinant() < 0.0;
    // The inverse transpose up to scale, which also exists if a mesh is squashed flat.
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
    let sign = if mirrored { -1.0 } else { 1.0 };
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign;
    for normal in parts.normals.iter_mut().flatten() {
        *normal = narrow((cofactors * wide(*normal)).normalize_or_zero());
    }
    for [x, y, z, w] in parts.tangents.iter_mut().flatten() {
        [*x, *y, *z] = narrow((linear * wide([*x, *y, *z])).normalize_or_zero());
        *w *= sign as f32;
    }
    if mirrored {
        parts.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
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
