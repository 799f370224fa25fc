//! Previews of a material on a ball and on a draped cloth in a studio, without a scene file.

use std::path::Path;
use std::sync::Arc;

use lobe_mesh::{Geometry, generate, ply, shapes};

use crate::camera::Camera;
use crate::light::{Environment, Light};
use crate::shader::{Backend, Lambert, Shader};
use crate::transform::Transform;
use crate::vec3::{Vec3, add, cross, scale, sub, unit};
use crate::world::{Shape, World, WorldBuilder, WorldError};

/// The objects that show the material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Show {
    /// A ball next to a cloth.
    #[default]
    Both,
    /// The ball alone.
    Ball,
    /// The cloth alone.
    Cloth,
}

/// The studio with a material in it, and the camera. Everything except the material runs on the backend.
///
/// # Errors
/// Never: the shapes come with the program.
pub fn studio(material: Arc<dyn Shader>, show: Show, backend: Backend) -> Result<(World, Camera), WorldError> {
    let mut world = WorldBuilder::new();
    let material = world.material(material);
    let backdrop = world.material(Arc::new(Lambert::new([0.32; 3], backend)));
    let stand = world.material(Arc::new(Lambert::new([0.12; 3], backend)));
    let black = world.material(Arc::new(Lambert::new([0.0; 3], backend)));
    let cove = shapes::cove(24.0, 24);
    let moved = Transform { axes: Transform::IDENTITY, translate: [0.0; 3] };
    world.shape(&moved.shape(&cove, cove.triangles.clone()), backdrop, None, false)?;

    let (ball_at, cloth_at) = match show {
        Show::Both => ([-1.32, 0.0, 0.1], [1.42, 0.0, -0.1]),
        Show::Ball | Show::Cloth => ([0.0; 3], [0.0; 3]),
    };
    if show != Show::Cloth {
        let ball = generate::ball().complete();
        let moved = Transform { axes: Transform::IDENTITY, translate: ball_at };
        for group in &ball.groups {
            let range = group.triangles.start as usize..group.triangles.end as usize;
            let shape = moved.shape(&ball, ball.triangles[range].to_vec());
            world.shape(&shape, if group.name == "pedestal" { stand } else { material }, None, false)?;
        }
    }
    if show != Show::Ball {
        let cloth = cloth().refined(PIECES).expect("a mesh of few triangles");
        let moved = Transform { axes: Transform::IDENTITY.map(|axis| scale(axis, CLOTH)), translate: cloth_at };
        world.shape(&moved.shape(&cloth, cloth.triangles.clone()), material, None, false)?;
    }

    // A large key light from the upper left, a strip on the right that draws a rim, and a faint sky.
    let aim = [0.0, 0.9, 0.0];
    world.shape(&panel([-4.2, 5.6, 4.4], aim, [3.4, 3.4]), black, Some([9.0, 8.8, 8.4]), false)?;
    world.shape(&panel([5.2, 3.2, -1.4], aim, [1.2, 3.6]), black, Some([7.0, 7.4, 8.0]), false)?;
    world.light(Light::Environment(
        Environment::gradient([0.55, 0.6, 0.7], [0.32, 0.33, 0.35], [0.08; 3]).expect("radiances"),
    ));
    let camera = match show {
        Show::Both => Camera { position: [0.0, 2.35, 9.6], target: [0.02, 1.06, 0.0], ..LENS },
        Show::Ball => Camera { position: [0.0, 2.3, 8.0], target: [0.0, 1.2, 0.0], ..LENS },
        Show::Cloth => Camera { position: [0.0, 2.6, 7.6], target: [0.0, 0.85, 0.0], ..LENS },
    };
    Ok((world.build()?, camera))
}

/// Size of the cloth in the studio over that in its file.
pub(crate) const CLOTH: f32 = 2.1;

/// The number of pieces into which each edge of the cloth is cut; without that, a fold that shadows itself would show
/// facets.
const PIECES: u32 = 3;

pub(crate) const LENS: Camera = Camera {
    position: [0.0; 3],
    target: [0.0; 3],
    up: [0.0, 1.0, 0.0],
    field_of_view: 0.40,
    lens_radius: 0.0,
    focus_distance: None,
};

/// A rectangle that faces a point.
fn panel(at: Vec3, aim: Vec3, [width, height]: [f32; 2]) -> Shape {
    let normal = unit(sub(aim, at)).expect("a panel is not at the point that it faces");
    let right = unit(cross([0.0, 1.0, 0.0], normal)).expect("a panel that is not overhead");
    let up = cross(normal, right);
    let corner = |x: f32, y: f32| add(at, add(scale(right, x * width / 2.0), scale(up, y * height / 2.0)));
    Shape {
        positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        normals: vec![normal; 4],
        tangents: vec![[right[0], right[1], right[2], 1.0]; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

/// The cloth of [`generate::drape`], whose fall takes seconds to compute, from a file.
pub(crate) fn cloth() -> Geometry {
    const FILE: &[u8] = include_bytes!("../assets/drape.ply");
    ply::parse(Path::new("drape.ply"), FILE).expect("a file that comes with the program").complete()
}

#[cfg(test)]
mod tests {
    /// A package must have its own copy of the file, and copies may become different.
    #[test]
    fn the_cloth_equals_the_fixture() {
        let fixture = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/scenes/drape.ply");
        match std::fs::read(fixture) {
            Ok(bytes) => assert!(bytes == include_bytes!("../assets/drape.ply"), "copy {fixture} to assets"),
            Err(error) => println!("skipped: {fixture}: {error}"),
        }
    }
}
