//! The simulated cloth.

mod common;

use common::{corners, wide};
use lobe_mesh::generate::{Drape, drape};

/// A coarse cloth, quickly made.
fn coarse() -> Drape {
    Drape { vertices: 33, duration: 1.5, ..Drape::default() }
}

#[test]
fn the_cloth_lies_on_the_sphere_and_the_ground() {
    let settings = coarse();
    let cloth = drape(&settings);
    assert_eq!((cloth.positions.len(), cloth.triangles.len()), (33 * 33, 2 * 32 * 32));
    for &p in &cloth.positions {
        let from_centre = (wide(p) - glam::DVec3::Y * settings.radius).length();
        assert!(from_centre > settings.radius && p[1] > 0.0, "{p:?} is inside");
    }
    let (low, high) = cloth.bounds().expect("vertices");
    let top = 2.0 * settings.radius as f32;
    assert!((top..top + 0.1).contains(&high[1]), "it lies on the sphere: {high:?}");
    assert!(low[1] < 0.15, "its corners hang down: {low:?}");
    assert!(high[0] - low[0] < 1.7, "it hangs rather than floats: {low:?} {high:?}");
}

#[test]
fn the_weave_keeps_its_lengths_and_its_texture() {
    let settings = coarse();
    let cloth = drape(&settings);
    let uvs = cloth.uvs.as_ref().expect("texture coordinates");
    let (mut longest, mut edges) = (0f64, 0);
    for &triangle in &cloth.triangles {
        let p = corners(&cloth, triangle);
        let uv = triangle.map(|index| uvs[index as usize]);
        for i in 0..3 {
            let (a, b) = (uv[i], uv[(i + 1) % 3]);
            if a[0] == b[0] || a[1] == b[1] {
                let woven = f64::from((a[0] - b[0]).abs() + (a[1] - b[1]).abs()) * settings.side;
                longest = longest.max(p[i].distance(p[(i + 1) % 3]) / woven);
                edges += 1;
            }
        }
    }
    assert_eq!(edges, 4 * 32 * 32);
    assert!(longest < 1.05, "a thread is stretched to {longest}");
    let complete = cloth.complete();
    assert_eq!(complete.positions.len(), 33 * 33, "nothing is mirrored");
    // On top, where the cloth lies as it fell: u along +x, v along -z.
    let middle = 16 * 33 + 16;
    let tangent = complete.tangents.as_ref().expect("tangents")[middle];
    assert!(tangent[0] > 0.95 && tangent[3] == 1.0, "{tangent:?}");
    assert!(complete.normals.as_ref().expect("normals")[middle][1] > 0.95);
}

#[test]
fn a_seed_gives_one_cloth() {
    let short = Drape { duration: 0.3, ..coarse() };
    assert_eq!(drape(&short), drape(&short));
    assert_ne!(drape(&short), drape(&Drape { seed: 1, ..short }));
}
