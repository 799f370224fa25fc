//! Asserts that shapes and generated meshes are closed, face outward, and have frames that follow their texture
//! coordinates.

use std::f64::consts::PI;

use crate::common::{assert_frames, open_edges, wide};
use lobe_mesh::{generate, shapes};
use lobe_testing::files::fixture;

#[test]
fn a_sphere_is_a_sphere() {
    let (radius, segments) = (1.5f32, 128);
    let sphere = shapes::sphere(radius, segments);
    assert_eq!(open_edges(&sphere), 0);
    assert_eq!(sphere.triangles.len(), 2 * 128 * 64 - 2 * 128);
    // The polyhedron lies inside: its area is smaller by about the square of a step.
    let exact = 4.0 * PI * f64::from(radius) * f64::from(radius);
    let step = 2.0 * PI / f64::from(segments);
    assert!(sphere.area() < exact && sphere.area() > exact * (1.0 - step * step), "{} of {exact}", sphere.area());
    let normals = sphere.normals.as_ref().expect("normals");
    for (p, n) in sphere.positions.iter().zip(normals) {
        assert!((wide(*p).length() - f64::from(radius)).abs() < 1e-6);
        assert!((wide(*p) / f64::from(radius) - wide(*n)).length() < 1e-6);
    }
    assert_frames(&sphere, 0.99);
}

#[test]
fn coarse_shapes_are_closed() {
    for segments in [0, 1, 3, 4, 5, 7] {
        assert_eq!(open_edges(&shapes::sphere(1.0, segments)), 0, "sphere of {segments}");
        assert_eq!(open_edges(&shapes::cuboid([1.0, 2.0, 3.0], segments)), 0, "cuboid of {segments}");
        assert_eq!(open_edges(&shapes::torus_knot(2, 3, 0.1, 8 * segments, segments)), 0, "knot of {segments}");
    }
}

#[test]
fn flat_shapes_have_their_areas_and_face_up() {
    let plane = shapes::plane(3.0, 4);
    assert!((plane.area() - 9.0).abs() < 1e-6);
    assert_eq!(open_edges(&plane), 16);
    let disk = shapes::disk(2.0, 256);
    assert!((disk.area() / (4.0 * PI) - 1.0).abs() < 2e-4);
    assert_eq!(open_edges(&disk), 256);
    for shape in [plane, disk] {
        assert_eq!(shape.normals.as_ref().expect("normals")[0], [0.0, 1.0, 0.0]);
        assert_frames(&shape, 0.9999);
    }
}

#[test]
fn a_cove_bends_from_the_floor_into_the_wall() {
    let cove = shapes::cove(6.0, 64);
    assert_eq!(cove.bounds(), Some(([-3.0, 0.0, -2.0], [3.0, 6.0, 3.0])));
    // Floor, a quarter of a circle, and wall.
    let length = 4.0 + PI / 2.0 + 5.0;
    assert!((cove.area() / (6.0 * length) - 1.0).abs() < 1e-4, "{} of {}", cove.area(), 6.0 * length);
    assert_frames(&cove, 0.9999);
}

#[test]
fn a_cuboid_has_six_faces() {
    let cuboid = shapes::cuboid([1.0, 2.0, 3.0], 3);
    assert!((cuboid.area() - 22.0).abs() < 1e-5);
    assert_eq!(cuboid.bounds(), Some(([-0.5, -1.0, -1.5], [0.5, 1.0, 1.5])));
    assert_eq!(open_edges(&cuboid), 0);
    assert_frames(&cuboid, 0.9999);
}

#[test]
fn knots_are_closed_and_smooth() {
    let knot = generate::knot();
    assert_eq!(open_edges(&knot), 0);
    assert_frames(&knot, 0.97);
    let (low, high) = knot.bounds().expect("vertices");
    assert!(low[1] > -0.65 && high[1] < 0.65 && low[0] > -1.7 && high[0] < 1.7, "{low:?} {high:?}");
}

#[test]
fn the_ball_stands_on_the_ground_in_three_closed_parts() {
    let ball = generate::ball();
    assert_eq!(open_edges(&ball), 0);
    assert_frames(&ball, 0.9);
    let names: Vec<&str> = ball.groups.iter().map(|group| group.name.as_str()).collect();
    assert_eq!(names, ["ball", "ring", "pedestal"]);
    let (low, high) = ball.bounds().expect("vertices");
    assert!(low[1] == 0.0 && (2.5..2.75).contains(&high[1]), "{low:?} {high:?}");
}

#[test]
fn the_files_of_the_project_hold_the_generated_meshes() {
    let file = |name: &str| lobe_mesh::read(&fixture("scenes").join(name)).unwrap_or_else(|error| panic!("{error}"));
    for (name, made) in [("ball.ply", generate::ball()), ("knot.ply", generate::knot())] {
        let read = file(name);
        assert!(read.tangents.is_none());
        assert!(read.positions == made.positions && read.triangles == made.triangles && read.groups == made.groups);
        assert_frames(&read.complete(), 0.9);
    }
    let drape = file("drape.ply").complete();
    assert_eq!((drape.positions.len(), drape.triangles.len()), (128 * 128, 2 * 127 * 127));
    assert_eq!(open_edges(&drape), 4 * 127);
    assert!(drape.tangents.is_some());
}
