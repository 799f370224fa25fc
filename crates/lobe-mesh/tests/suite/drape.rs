//! Tests of the simulated cloth.

use std::sync::LazyLock;

use crate::common::{corners, wide};
use lobe_mesh::Geometry;
use lobe_mesh::generate::{Drape, drape};

/// Vertices along a side.
const N: usize = 65;

/// Half the resolution of the fixture, and a shorter fall.
static SETTINGS: LazyLock<Drape> = LazyLock::new(|| Drape { vertices: N, duration: 1.5, ..Drape::default() });
static CLOTH: LazyLock<Geometry> = LazyLock::new(|| drape(&SETTINGS));

#[test]
fn the_cloth_lies_on_the_sphere_and_the_ground() {
    let cloth = &*CLOTH;
    assert_eq!((cloth.positions.len(), cloth.triangles.len()), (N * N, 2 * (N - 1) * (N - 1)));
    for &p in &cloth.positions {
        let from_centre = (wide(p) - glam::DVec3::Y * SETTINGS.radius).length();
        assert!(from_centre > SETTINGS.radius && p[1] > 0.0, "{p:?} is inside");
    }
    let (low, high) = cloth.bounds().expect("vertices");
    let top = 2.0 * SETTINGS.radius as f32;
    assert!((top..top + 0.1).contains(&high[1]), "it lies on the sphere: {high:?}");
    assert!(low[1] < 0.1, "its corners are on the ground: {low:?}");
    let (half, last) = (N / 2, N - 1);
    for middle in [half, half * N, half * N + last, last * N + half] {
        let [x, _, z] = cloth.positions[middle];
        assert!(x.hypot(z) < 0.75, "the middles of its sides, 1 m from the axis before, hang down: {x} {z}");
    }
}

#[test]
fn the_weave_keeps_its_lengths_and_its_texture() {
    let cloth = &*CLOTH;
    let uvs = cloth.uvs.as_ref().expect("texture coordinates");
    let mut stretches = Vec::new();
    for &triangle in &cloth.triangles {
        let p = corners(cloth, triangle);
        let uv = triangle.map(|index| uvs[index as usize]);
        for i in 0..3 {
            let (a, b) = (uv[i], uv[(i + 1) % 3]);
            if a[0] == b[0] || a[1] == b[1] {
                let woven = f64::from((a[0] - b[0]).abs() + (a[1] - b[1]).abs()) * SETTINGS.side;
                stretches.push(p[i].distance(p[(i + 1) % 3]) / woven);
            }
        }
    }
    assert_eq!(stretches.len(), 4 * (N - 1) * (N - 1));
    let mean = stretches.iter().sum::<f64>() / stretches.len() as f64;
    let longest = stretches.iter().fold(0f64, |longest, stretch| longest.max(*stretch));
    assert!((mean - 1.0).abs() < 0.01 && longest < 1.2, "threads are stretched to {mean}, at most {longest}");
    let complete = cloth.clone().complete();
    assert_eq!(complete.positions.len(), N * N, "nothing is mirrored");
    // On top, where the cloth lies as it fell: u along +x, v along -z.
    let middle = N / 2 * N + N / 2;
    let tangent = complete.tangents.as_ref().expect("tangents")[middle];
    assert!(tangent[0] > 0.95 && tangent[3] == 1.0, "{tangent:?}");
    assert!(complete.normals.as_ref().expect("normals")[middle][1] > 0.95);
}

#[test]
fn folds_of_the_file_touch_and_do_not_cross() {
    let cloth = lobe_mesh::read(&lobe_testing::files::fixture("scenes/drape.ply")).expect("the fixture");
    let settings = Drape::default();
    let n = settings.vertices;
    let spacing = settings.side / (n - 1) as f64;
    let places: Vec<_> = cloth.positions.iter().map(|&p| wide(p)).collect();
    let mut closest = f64::INFINITY;
    for (a, p) in places.iter().enumerate() {
        for (b, q) in places.iter().enumerate().skip(a + 1) {
            if (a % n).abs_diff(b % n) > 2 || b / n - a / n > 2 {
                closest = closest.min(p.distance_squared(*q));
            }
        }
    }
    // Vertices keep 0.9 of the spacing, up to the error left by the last step.
    let closest = closest.sqrt() / spacing;
    assert!((0.85..1.0).contains(&closest), "vertices of two folds are {closest} spacings apart");
}

#[test]
fn a_seed_gives_one_cloth() {
    let short = Drape { vertices: 33, duration: 0.3, ..Drape::default() };
    assert!(drape(&short) == drape(&short));
    assert!(drape(&short) != drape(&Drape { seed: 1, ..short }));
}
