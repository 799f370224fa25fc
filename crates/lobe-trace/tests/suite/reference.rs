//! Every ray against every triangle, in double precision.

use lobe_trace::{Affine, HitSoA, MISS, Mesh, RaySoA, Scene};

type V = [f64; 3];

fn sub(a: V, b: V) -> V {
    std::array::from_fn(|i| a[i] - b[i])
}
fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The intersection of a line with the plane of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Intersection {
    pub t: f64,
    /// The smallest of the three weights: negative outside, and the distance from the edge in heights of the triangle.
    pub inside: f64,
    /// The change of t if the line is moved by a ten-millionth of the input numbers.
    pub uncertainty: f64,
}

/// Möller and Trumbore 1997.
fn intersect(origin: V, direction: V, corners: [V; 3]) -> Option<Intersection> {
    let (e, f) = (sub(corners[1], corners[0]), sub(corners[2], corners[0]));
    let p = cross(direction, f);
    let determinant = dot(e, p);
    let s = sub(origin, corners[0]);
    let q = cross(s, e);
    let (u, v, t) = (dot(s, p) / determinant, dot(direction, q) / determinant, dot(f, q) / determinant);
    let normal = cross(e, f);
    let reach = corners.iter().flatten().chain(&origin).fold(0f64, |most, x| most.max(x.abs()));
    let uncertainty = 1e-6 * reach * dot(normal, normal).sqrt() / determinant.abs();
    (t.is_finite() && u.is_finite() && v.is_finite()).then(|| Intersection {
        t,
        inside: u.min(v).min(1.0 - u - v),
        uncertainty,
    })
}

/// One corner of a triangle and the edges from it.
type Wedge = [V; 3];

fn wedges(mesh: &Mesh) -> Vec<Wedge> {
    let wedge = |triangle| {
        let [a, b, c] = corners(mesh, triangle);
        [a, sub(b, a), sub(c, a)]
    };
    (0..mesh.triangles().len()).map(wedge).collect()
}

/// `true` if a line hits a triangle: the test of [`intersect`] without its divisions, for many triangles.
fn crosses(origin: V, direction: V, [a, e, f]: &Wedge) -> bool {
    let p = cross(direction, *f);
    let determinant = dot(*e, p);
    let s = sub(origin, *a);
    let sign = determinant.signum();
    let (u, v) = (sign * dot(s, p), sign * dot(direction, cross(s, *e)));
    u.min(v).min(determinant.abs() - (u + v)) >= -1e-12 * determinant.abs()
}

/// A ray in the space of an instance.
fn transformed(map: &Affine, origin: V, direction: V) -> (V, V) {
    let m = map.rows.map(|row| row.map(f64::from));
    (m.map(|r| dot([r[0], r[1], r[2]], origin) + r[3]), m.map(|r| dot([r[0], r[1], r[2]], direction)))
}

fn corners(mesh: &Mesh, triangle: usize) -> [V; 3] {
    mesh.corners(triangle).map(|corner| corner.map(f64::from))
}

/// Compares hits with double precision. Returns the number of rays that hit something.
///
/// If a different triangle was hit, or none, there must be an explanation within the accuracy of single precision: the
/// ray passes an edge, or both triangles are hit at the same point, or the interval ends there.
pub fn check<const W: usize>(scene: &Scene<W>, rays: &RaySoA, hits: &HitSoA, name: &str) -> usize {
    let inverses: Vec<Affine> = (0..scene.instance_count()).map(|i| scene.to_world(i).inverse().unwrap()).collect();
    let wedges: Vec<Vec<Wedge>> = (0..scene.instance_count()).map(|i| wedges(scene.mesh_of(i))).collect();
    let mut count = 0;
    let mut explained = 0;
    for ray in 0..rays.len() {
        let origin: V = std::array::from_fn(|axis| rays.origin[axis][ray] as f64);
        let direction: V = std::array::from_fn(|axis| rays.direction[axis][ray] as f64);
        let (t_min, t_max) = (rays.t_min[ray] as f64, rays.t_max[ray] as f64);
        let mut best: Option<(Intersection, i32, i32)> = None;
        for (instance, inverse) in inverses.iter().enumerate() {
            let mesh = scene.mesh_of(instance);
            let (origin, direction) = transformed(inverse, origin, direction);
            for (triangle, wedge) in wedges[instance].iter().enumerate() {
                if !crosses(origin, direction, wedge) {
                    continue;
                }
                let Some(crossing) = intersect(origin, direction, corners(mesh, triangle)) else { continue };
                let nearest = best.is_none_or(|(best, ..)| crossing.t < best.t);
                if crossing.inside >= 0.0 && (t_min..=t_max).contains(&crossing.t) && nearest {
                    best = Some((crossing, triangle as i32, instance as i32));
                }
            }
        }
        let found = (hits.primitive[ray] != MISS).then(|| {
            let (primitive, instance) = (hits.primitive[ray], hits.instance[ray]);
            let mesh = scene.mesh_of(instance as usize);
            let (origin, direction) = transformed(&inverses[instance as usize], origin, direction);
            (intersect(origin, direction, corners(mesh, primitive as usize)), primitive, instance)
        });
        let text = || format!("{name}: ray {ray}: found {found:?} at {}, expected {best:?}", hits.t[ray]);
        // A ray near an edge, or near an end of its interval, may miss; for a ray along a triangle, anything is
        // allowed.
        let near = |m: &Intersection| {
            let end = (m.t - t_min).abs().min((m.t - t_max).abs());
            m.inside.abs() < 1e-4 || end < m.uncertainty + 1e-5 * m.t.abs() || m.uncertainty > 1e-2 * m.t.abs()
        };
        match (&found, &best) {
            (None, None) => {}
            (None, Some((truth, ..))) => {
                assert!(near(truth), "{}", text());
                explained += 1;
            }
            (Some((None, ..)), _) => panic!("{}: a triangle of no area", text()),
            (Some((Some(hit), primitive, instance)), best) => {
                count += 1;
                let error = (hits.t[ray] as f64 - hit.t).abs();
                assert!(error <= 1e-5 * hit.t.abs() + hit.uncertainty, "{}: t is {error:e} off", text());
                if best.is_some_and(|(_, p, i)| (p, i) == (*primitive, *instance)) {
                    continue;
                }
                let same_place = best.is_some_and(|(truth, ..)| {
                    (truth.t - hit.t).abs() <= 1e-5 * hit.t.abs() + truth.uncertainty + hit.uncertainty
                });
                let truth_near = best.is_some_and(|(truth, ..)| near(&truth));
                assert!(same_place || near(hit) || truth_near, "{}", text());
                explained += !same_place as usize;
            }
        }
    }
    assert!(explained * 100 <= rays.len(), "{name}: {explained} of {} rays had to be explained", rays.len());
    count
}
