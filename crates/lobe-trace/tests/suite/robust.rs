//! Invalid and extreme input.

use lobe_backend::Backend;
use lobe_trace::{Affine, Form, MISS, Mesh, MeshError, Progress, RayClass, RaySoA, Scene, SceneBuilder, SceneError};

use crate::backends::intersect;
use crate::{meshes, rays, reference};

fn triangle(z: f32) -> Mesh {
    Mesh::new(vec![[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]], vec![[0, 1, 2]]).unwrap()
}

#[test]
fn invalid_meshes_are_refused() {
    let good = [0.0; 3];
    let error = Mesh::new(vec![good, [0.0, f32::NAN, 0.0]], vec![]).unwrap_err();
    assert!(matches!(error, MeshError::Coordinate { vertex: 1, axis: 1, found } if found.is_nan()), "{error}");
    let error = Mesh::new(vec![[0.0, 0.0, f32::INFINITY]], vec![]).unwrap_err();
    assert_eq!(error, MeshError::Coordinate { vertex: 0, axis: 2, found: f32::INFINITY });
    assert!(error.to_string().contains("vertex 0 has inf"), "{error}");
    let error = Mesh::new(vec![good; 3], vec![[0, 1, 2], [0, 1, 3]]).unwrap_err();
    assert_eq!(error, MeshError::Index { triangle: 1, corner: 2, found: 3, vertices: 3 });
}

#[test]
fn invalid_instances_are_refused() {
    let mut builder = SceneBuilder::new();
    builder.mesh(triangle(0.0));
    builder.instance(1, Affine::IDENTITY);
    assert_eq!(builder.build::<8>(|_| ()).unwrap_err(), SceneError::Mesh { instance: 0, found: 1, meshes: 1 });
    for bad in [0.0, f32::NAN, f32::INFINITY, 1e-30] {
        let mut builder = SceneBuilder::new();
        builder.mesh(triangle(0.0));
        builder.instance(0, Affine::IDENTITY);
        let mut rows = Affine::IDENTITY.rows;
        rows[1][1] = bad;
        builder.instance(0, Affine { rows });
        assert_eq!(builder.build::<8>(|_| ()).unwrap_err(), SceneError::Transform { instance: 1 }, "{bad}");
    }
}

#[test]
fn progress_counts_triangles() {
    let mut builder = SceneBuilder::new();
    builder.mesh(meshes::cloth(2));
    builder.mesh(triangle(0.0));
    let mut seen = Vec::new();
    builder.build::<4>(|progress| seen.push(progress)).unwrap();
    assert_eq!(seen, [Progress { done: 8, total: 9 }, Progress { done: 9, total: 9 }]);
}

#[test]
fn nothing_is_hit_in_an_empty_scene() {
    let mut rays = RaySoA::default();
    for _ in 0..70 {
        rays.push([0.0; 3], [1.0, 2.0, 3.0], 0.0, f32::INFINITY);
    }
    let empty = Mesh::new(vec![], vec![]).unwrap();
    let mut of_empty_mesh = SceneBuilder::new();
    of_empty_mesh.mesh(empty.clone());
    of_empty_mesh.instance(0, Affine::translation([1.0; 3]));
    let scenes =
        [Scene::<8>::of_mesh(empty), SceneBuilder::new().build(|_| ()).unwrap(), of_empty_mesh.build(|_| ()).unwrap()];
    for scene in &scenes {
        for form in Form::ALL {
            let hits = intersect(Backend::scalar(), scene, &rays, form);
            assert!(hits.primitive.iter().all(|&primitive| primitive == MISS));
            assert!(hits.t.iter().all(|&t| t == f32::INFINITY));
        }
    }
}

/// A million identical boxes, for which plain clustering would join one pair per round.
#[test]
fn a_million_triangles_in_one_place() {
    let corners = vec![[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
    let scene: Scene = Scene::of_mesh(Mesh::new(corners, vec![[0, 1, 2]; 1_000_000]).unwrap());
    let mut rays = RaySoA::default();
    rays.push([0.25, 0.25, 0.0], [0.0, 0.0, 1.0], 0.0, f32::INFINITY);
    rays.push([2.0, 0.25, 0.0], [0.0, 0.0, 1.0], 0.0, f32::INFINITY);
    for form in Form::ALL {
        let hits = intersect(Backend::scalar(), &scene, &rays, form);
        assert_eq!((hits.primitive[0], hits.t[0], hits.primitive[1]), (0, 1.0, MISS), "{form:?}");
    }
}

#[test]
fn a_long_fence_and_points_and_needles() {
    let mut positions = Vec::new();
    let mut add = |corners: [[f32; 3]; 3]| positions.extend(corners);
    for i in 0..50_000 {
        let x = i as f32;
        add([[x, 0.0, 0.0], [x + 0.5, 0.0, 0.0], [x, 1.0, 0.0]]);
        add([[1.0, 1.0, 1.0]; 3]);
        add([[2.0, 1.0, 1.0], [3.0, 1.0, 1.0], [4.0, 1.0, 1.0]]);
    }
    let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let scene: Scene = Scene::of_mesh(Mesh::new(positions, triangles).unwrap());
    let mut rays = RaySoA::default();
    for post in [0, 777, 49_999] {
        rays.push([post as f32 + 0.125, 0.25, 5.0], [0.0, 0.0, -1.0], 0.0, f32::INFINITY);
    }
    rays.push([1.0, 1.0, 5.0], [0.0, 0.0, -1.0], 0.0, f32::INFINITY);
    rays.push([3.0, 1.0, 5.0], [0.0, 0.0, -1.0], 0.0, 4.5);
    for form in Form::ALL {
        let hits = intersect(Backend::scalar(), &scene, &rays, form);
        // The point touches the tip of a post and hides it from no ray.
        assert_eq!(hits.primitive, [0, 3 * 777, 3 * 49_999, 3, MISS], "{form:?}");
    }
}

#[test]
fn the_smallest_numbers_win_among_equal_hits() {
    let corners = vec![[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
    let mesh = Mesh::new(corners, vec![[0, 1, 2]; 37]).unwrap();
    let mut builder = SceneBuilder::new();
    let mesh = builder.mesh(mesh);
    for _ in 0..5 {
        builder.instance(mesh, Affine::translation([0.0, 0.0, 1.0]));
    }
    let scene: Scene = builder.build(|_| ()).unwrap();
    let mut rays = RaySoA::default();
    rays.push([0.25, 0.25, 0.0], [0.0, 0.0, 1.0], 0.0, f32::INFINITY);
    for form in Form::ALL {
        let hits = intersect(Backend::scalar(), &scene, &rays, form);
        assert_eq!((hits.primitive[0], hits.instance[0]), (0, 0), "{form:?}");
    }
}

#[test]
fn intervals_are_closed() {
    let scene: Scene = Scene::of_mesh(triangle(2.0));
    let below = f32::from_bits(2f32.to_bits() - 1);
    let above = f32::from_bits(2f32.to_bits() + 1);
    let mut rays = RaySoA::default();
    for (t_min, t_max) in [(0.0, 2.0), (2.0, 5.0), (2.0, 2.0), (0.0, below), (above, 5.0)] {
        rays.push([0.25, 0.25, 0.0], [0.0, 0.0, 1.0], t_min, t_max);
    }
    for form in Form::ALL {
        let hits = intersect(Backend::scalar(), &scene, &rays, form);
        assert_eq!(hits.primitive, [0, 0, 0, MISS, MISS], "{form:?}");
    }
}

/// Needles, far from the origin, tiny and huge: hits agree with double precision.
#[test]
fn scale_and_place_do_not_matter() {
    for (scale, shift) in [(1e-6, 0.0), (1e9, 0.0), (1.0, 100.0), (1e-3, 1.0)] {
        let mesh = meshes::torus_knot(80, 8);
        let moved = mesh.positions().iter().map(|p| p.map(|x| x * scale + shift)).collect();
        let scene: Scene = Scene::of_mesh(Mesh::new(moved, mesh.triangles().to_vec()).unwrap());
        let rays = rays::camera(scene.bounds(), 24);
        let hits = intersect(Backend::scalar(), &scene, &rays, Form::Large);
        assert!(reference::check(&scene, &rays, &hits, &format!("scale {scale} shift {shift}")) > 50);
    }
}

#[test]
fn paths_have_the_right_class() {
    let mirror = RayClass::Camera.bounce(true);
    assert_eq!(mirror, RayClass::Mirror);
    assert_eq!(mirror.shadow(true), RayClass::Shadow);
    assert_eq!(RayClass::Camera.shadow(false), RayClass::SoftShadow);
    let diffuse = mirror.bounce(false);
    assert_eq!((diffuse, diffuse.bounce(true)), (RayClass::Diffuse, RayClass::Diffuse));
    assert_eq!(diffuse.shadow(true), RayClass::ScatteredShadow);
}
