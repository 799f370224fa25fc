//! Skins: meshes whose vertices follow joints instead of their node (section 3.7.3).

use glam::DMat4;
use lobe_files::FormatError;

use super::document::Attributes;
use super::{Budget, Source};
use crate::file::wrong;

/// The transform of each vertex to scene coordinates: the mean of those of its joints, by their weights. `nodes` are the
/// transforms of all nodes, `None` for those that are not in the scene.
pub(super) fn places(
    source: &Source<'_>,
    skin: usize,
    attributes: &Attributes,
    nodes: &[Option<DMat4>],
    budget: &mut Budget<'_>,
) -> Result<Vec<DMat4>, FormatError> {
    let refused = |found: String, expected: &str| Err(wrong(source.path, found, expected));
    let number = skin;
    let skin = source.item(&source.document.skins, skin, "skin")?;
    let (Some(joints), Some(weights), None) = (attributes.joints, attributes.weights, attributes.more_joints) else {
        return refused(format!("a mesh of skin {number}"), "JOINTS_0 and WEIGHTS_0, for four joints per vertex");
    };
    let inverse: Vec<[f64; 16]> = match skin.inverse_bind_matrices {
        Some(accessor) => source.numbers(accessor, "MAT4", budget)?,
        None => vec![DMat4::IDENTITY.to_cols_array(); skin.joints.len()],
    };
    if inverse.len() < skin.joints.len() {
        return refused(format!("{} matrices of skin {number}", inverse.len()), "one for each joint");
    }
    budget.take(skin.joints.len(), 2 * size_of::<DMat4>())?;
    let mut of_joints = Vec::new();
    for (joint, inverse) in skin.joints.iter().zip(&inverse) {
        let Some(place) = nodes.get(*joint).copied().flatten() else {
            return refused(format!("joint {joint} of skin {number}"), "a node of the scene");
        };
        of_joints.push(place * DMat4::from_cols_array(inverse));
    }
    let joints: Vec<[f64; 4]> = source.numbers(joints, "VEC4", budget)?;
    let weights: Vec<[f64; 4]> = source.numbers(weights, "VEC4", budget)?;
    if joints.len() != weights.len() {
        return refused(format!("{} joints and {} weights", joints.len(), weights.len()), "those of each vertex");
    }
    budget.take(joints.len(), size_of::<DMat4>())?;
    let mut out = Vec::with_capacity(joints.len());
    for (vertex, (joints, weights)) in joints.iter().zip(&weights).enumerate() {
        let sum: f64 = weights.iter().sum();
        if !(sum > 0.0 && sum.is_finite()) {
            return refused(format!("weights of the joints of vertex {vertex} that add up to {sum}"), "1");
        }
        let mut place = DMat4::ZERO;
        for (&joint, &weight) in joints.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            let Some(of_joint) = of_joints.get(joint as usize).filter(|_| joint >= 0.0) else {
                return refused(format!("joint {joint} of vertex {vertex}"), "a joint of the skin");
            };
            place += *of_joint * (weight / sum);
        }
        out.push(place);
    }
    Ok(out)
}
