//! Linear interpolation between scattered points of a plane, on their Delaunay triangulation.

use libm::hypot;
use spade::handles::{FixedDirectedEdgeHandle, FixedVertexHandle};
use spade::{
    DelaunayTriangulation, HasPosition, HierarchyHintGenerator, Point2, PositionInTriangulation, Triangulation,
};

use super::line::Line;
use super::rim::{Edge, Rim};

type Delaunay = DelaunayTriangulation<Vertex, (), (), (), HierarchyHintGenerator<f64>>;

/// Triangles at the rim that are lower than this, in radians, exist only due to rounding; and points no farther than
/// this from a line count as on it.
const FLAT: f64 = 1e-5;

/// Scattered points, and the interpolation between them.
#[derive(Clone, Debug)]
pub(crate) enum Mesh {
    /// A separate case, because there is nothing to triangulate, and trying it would take time quadratic in the number
    /// of points.
    Line(Line),
    Triangles(Box<Triangles>),
}

/// A point and its position in the given list.
#[derive(Clone, Copy, Debug)]
struct Vertex {
    at: Point2<f64>,
    index: usize,
}

impl HasPosition for Vertex {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

/// Points that are not on a line.
#[derive(Clone, Debug)]
pub(crate) struct Triangles {
    triangles: Delaunay,
    /// The edges around all triangles that are not [`FLAT`], by the indices of their ends.
    rim: Rim,
    /// By the index of a triangle, whether it is outside the rim.
    is_outside: Vec<bool>,
}

/// A triangle within the rim: the indices and places of its corners, in counterclockwise order.
#[cfg(feature = "scattered")]
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    pub(super) corners: [usize; 3],
    pub(super) at: [[f64; 2]; 3],
}

/// Up to three points and their weights, which are not negative and add up to 1.
pub(crate) type Weights = [(usize, f64); 3];

impl Mesh {
    /// Triangulates points that are finite and different from each other; `None` if there is no point.
    pub(crate) fn new(points: &[[f64; 2]]) -> Option<Self> {
        match Line::new(points, FLAT) {
            Some(line) => Some(Mesh::Line(line)),
            None => Triangles::new(points).map(|triangles| Mesh::Triangles(Box::new(triangles))),
        }
    }

    /// The weights at a point of the plane. Outside the convex hull, or if all points are on a line, they are those of
    /// the nearest point of the rim.
    pub(crate) fn weights(&self, point: [f64; 2]) -> Weights {
        match self {
            Mesh::Line(line) => {
                let [lower, upper] = line.weights(point);
                [lower, upper, (0, 0.0)]
            }
            Mesh::Triangles(triangles) => triangles.weights(point),
        }
    }
}

impl Triangles {
    fn new(points: &[[f64; 2]]) -> Option<Self> {
        // Coordinates that differ from zero only by rounding would be refused.
        let snap = |x: f64| if x.abs() < 1e-12 { 0.0 } else { x };
        // Inserted one by one in an order unrelated to that of the file: for any set of points, the time hardly more
        // than doubles with twice as many points. A sweep over all points takes quadratic time for some sets.
        let mut order: Vec<usize> = (0..points.len()).collect();
        order.sort_by_key(|&index| scrambled(index as u64));
        // As long as all points are on a line, each insertion takes time that grows with their number, so the corners
        // of a large triangle go first. Inserting them again later changes nothing.
        let mut triangles = Delaunay::new();
        for index in corners(points)?.into_iter().chain(order) {
            let [x, y] = points[index];
            triangles.insert(Vertex { at: Point2::new(snap(x), snap(y)), index }).ok()?;
        }
        if triangles.num_vertices() == 0 {
            return None;
        }
        // Points on a straight rim are slightly off it due to rounding, and then a long flat triangle covers them: at
        // the rim, its far ends would replace the points. So such triangles are removed, one after the other.
        let mut is_outside = vec![false; triangles.num_all_faces()];
        let mut rim = Vec::new();
        let mut pending: Vec<_> = triangles.convex_hull().map(|edge| edge.fix()).collect();
        while let Some(edge) = pending.pop() {
            let inner = triangles.directed_edge(edge).rev();
            let [a, b] = [inner.from(), inner.to()].map(|end| end.position());
            let face = inner.face().as_inner().map(|face| face.fix().index());
            let apex = inner.opposite_position();
            match face.zip(apex) {
                Some((face, apex)) if !is_outside[face] && area(a, b, apex) < FLAT * hypot(b.x - a.x, b.y - a.y) => {
                    is_outside[face] = true;
                    pending.extend([inner.next().fix(), inner.prev().fix()]);
                }
                _ => rim.push([inner.from(), inner.to()].map(|end| *end.data())),
            }
        }
        let rim = Rim::new(rim.into_iter().map(|ends| ends.map(|end| (end.index, [end.at.x, end.at.y]))));
        Some(Triangles { triangles, rim, is_outside })
    }

    fn weights(&self, point: [f64; 2]) -> Weights {
        let at = Point2::new(point[0], point[1]);
        match self.triangles.locate(at) {
            PositionInTriangulation::OnVertex(vertex) => [(self.index(vertex), 1.0), (0, 0.0), (0, 0.0)],
            PositionInTriangulation::OnFace(face) if !self.is_outside[face.index()] => {
                let corners = self.triangles.face(face).vertices();
                let [a, b, c] = corners.map(|corner| corner.position());
                let parts = [area(at, b, c), area(a, at, c), area(a, b, at)];
                let whole: f64 = parts.iter().sum();
                // A triangle too thin to have an area: any corner is as near as rounding allows.
                let weight = |index: usize| if whole > 0.0 { parts[index] / whole } else { 1.0 / 3.0 };
                std::array::from_fn(|index| (corners[index].data().index, weight(index)))
            }
            PositionInTriangulation::OnEdge(edge) if self.is_inside(edge) => {
                let edge = self.triangles.directed_edge(edge);
                let ends = [edge.from(), edge.to()].map(|end| *end.data());
                weights_along(Edge::new(ends.map(|end| (end.index, [end.at.x, end.at.y]))).nearest(point).0)
            }
            _ => self.rim.nearest(point).map_or([(0, 1.0), (0, 0.0), (0, 0.0)], weights_along),
        }
    }

    /// All triangles within the rim.
    #[cfg(feature = "scattered")]
    pub(super) fn triangles(&self) -> Vec<Triangle> {
        let inside = self.triangles.inner_faces().filter(|face| !self.is_outside[face.fix().index()]);
        let triangle = |corners: [Vertex; 3]| Triangle {
            corners: corners.map(|corner| corner.index),
            at: corners.map(|corner| [corner.at.x, corner.at.y]),
        };
        inside.map(|face| triangle(face.vertices().map(|corner| *corner.data()))).collect()
    }

    fn index(&self, vertex: FixedVertexHandle) -> usize {
        self.triangles.vertex(vertex).data().index
    }

    /// `true` if a triangle within the rim has this edge.
    fn is_inside(&self, edge: FixedDirectedEdgeHandle) -> bool {
        let edge = self.triangles.directed_edge(edge);
        [edge, edge.rev()].iter().any(|side| side.face().as_inner().is_some_and(|f| !self.is_outside[f.fix().index()]))
    }
}

fn weights_along([from, to]: [(usize, f64); 2]) -> Weights {
    [from, to, (0, 0.0)]
}

/// Three points that are far from collinear.
fn corners(points: &[[f64; 2]]) -> Option<[usize; 3]> {
    let farthest = |distance: &dyn Fn([f64; 2]) -> f64| {
        (0..points.len()).max_by(|&i, &j| distance(points[i]).total_cmp(&distance(points[j])))
    };
    let [x, y] = *points.first()?;
    let second = farthest(&|point| hypot(point[0] - x, point[1] - y))?;
    let (dx, dy) = (points[second][0] - x, points[second][1] - y);
    let third = farthest(&|point| (dx * (point[1] - y) - dy * (point[0] - x)).abs())?;
    Some([0, second, third])
}

/// A pseudorandom number for each index (the finaliser of splitmix64; Steele, Lea and Flood, OOPSLA 2014).
fn scrambled(index: u64) -> u64 {
    let mut x = index.wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Twice the area of a triangle with counterclockwise corners, or 0.
fn area(a: Point2<f64>, b: Point2<f64>, c: Point2<f64>) -> f64 {
    ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(mesh: &Mesh, values: &[f64], point: [f64; 2]) -> f64 {
        mesh.weights(point).iter().map(|&(index, weight)| values[index] * weight).sum()
    }

    #[test]
    fn a_plane_is_reproduced_inside_and_held_outside() {
        let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.3, 0.6]];
        let plane = |[x, y]: [f64; 2]| 2.0 * x - 3.0 * y + 1.0;
        let (mesh, values) = (Mesh::new(&points).expect("points"), points.map(plane));
        for point in [[0.3, 0.6], [0.1, 0.1], [0.9, 0.2], [0.5, 0.5], [0.0, 0.25], [1.0, 1.0]] {
            assert!((value(&mesh, &values, point) - plane(point)).abs() < 1e-12, "{point:?}");
        }
        assert!((value(&mesh, &values, [0.5, -9.0]) - plane([0.5, 0.0])).abs() < 1e-12);
        assert!((value(&mesh, &values, [7.0, 7.0]) - plane([1.0, 1.0])).abs() < 1e-12);
    }

    #[test]
    fn points_on_a_line_and_single_points_are_accepted() {
        let mesh = Mesh::new(&[[0.0, 0.0], [2.0, 0.0], [4.0, 0.0]]).expect("points");
        assert_eq!(value(&mesh, &[1.0, 2.0, 6.0], [3.0, 0.0]), 4.0);
        assert_eq!(value(&mesh, &[1.0, 2.0, 6.0], [1.0, 5.0]), 1.5);
        assert_eq!(value(&mesh, &[1.0, 2.0, 6.0], [-1.0, -5.0]), 1.0);
        let mesh = Mesh::new(&[[0.5, 0.5]]).expect("a point");
        assert_eq!(value(&mesh, &[7.0], [0.1, 0.0]), 7.0);
        assert!(Mesh::new(&[]).is_none());
    }

    /// Straight, skewed, and with rounding errors: a hostile file may contain as many as fit into it.
    #[test]
    fn a_hundred_thousand_points_on_a_line_are_quick() {
        for jitter in [0.0, 1e-13, 1e-7] {
            let offset = |index: i32| jitter * f64::from(index * 7 % 11 - 5);
            let point = |index: i32| [f64::from(index) * 1e-5, f64::from(index) * 3e-6 + offset(index)];
            let points: Vec<_> = (0..100_000).map(point).collect();
            let mesh = Mesh::new(&points).expect("points");
            assert!(matches!(mesh, Mesh::Line(_)));
            let values: Vec<f64> = (0..points.len()).map(|index| index as f64).collect();
            let found = value(&mesh, &values, [0.500_005, 0.150_001_5]);
            assert!((found - 50_000.5).abs() < 0.05, "{jitter}: {found}");
        }
    }

    #[test]
    fn points_on_a_straight_rim_keep_their_values() {
        // A fan of rays whose outermost points are collinear except for rounding.
        let mut points = vec![[0.0, 0.0]];
        for ray in 0..4 {
            let (sin, cos) = (0.3 + 0.2 * f64::from(ray)).sin_cos();
            points.extend((1..9).map(|step| [0.1 * f64::from(step) * cos, 0.1 * f64::from(step) * sin]));
        }
        let mesh = Mesh::new(&points).expect("points");
        let values: Vec<f64> = (0..points.len()).map(|index| (index as f64).sin()).collect();
        for (index, [x, y]) in points.iter().enumerate() {
            for (dx, dy) in [(0.0, 0.0), (1e-9, -1e-9), (-1e-9, 1e-9), (1e-15, 0.0), (0.0, 1e-15)] {
                let found = value(&mesh, &values, [x + dx, y + dy]);
                assert!((found - values[index]).abs() < 1e-6, "point {index}: {found}, not {}", values[index]);
            }
        }
    }

    /// A circle, whose rim has as many edges as points, queried from outside: not every edge of the rim may be
    /// searched.
    #[test]
    fn a_long_rim_is_searched_quickly() {
        let count = 100_000;
        let angle = |index: usize| index as f64 / count as f64 * std::f64::consts::TAU;
        let points: Vec<_> = (0..count).map(|index| [angle(index).cos(), angle(index).sin()]).collect();
        let mesh = Mesh::new(&points).expect("points");
        let values: Vec<f64> = points.iter().map(|[x, _]| *x).collect();
        for index in 0..100_000 {
            let angle = f64::from(index) * 0.618;
            let found = value(&mesh, &values, [1.5 * angle.cos(), 1.5 * angle.sin()]);
            assert!((found - angle.cos()).abs() < 1e-4, "{found}, not {}", angle.cos());
        }
    }

    /// Sets for which a sweep over all points takes quadratic time, which would make this test take minutes.
    #[test]
    fn no_set_of_points_takes_quadratic_time() {
        let count = 100_000;
        let part = |index: usize| index as f64 / count as f64;
        type Curve = fn(f64) -> [f64; 2];
        let sets: [(&str, Curve); 4] = [
            ("a parabola", |t| [t, t * t]),
            ("a line and points off it", |t| if t < 1e-4 { [0.3, 0.5 + t] } else { [t, 0.0] }),
            ("two lines", |t| if t < 0.5 { [2.0 * t, 0.0] } else { [2.0 * t - 1.0, 0.5] }),
            ("a cross", |t| if t < 0.5 { [4.0 * t - 1.0, 0.0] } else { [0.0, 4.0 * t - 3.0 + 1e-6] }),
        ];
        for (name, set) in sets {
            let points: Vec<_> = (0..count).map(|index| set(part(index))).collect();
            let mesh = Mesh::new(&points).expect("points");
            let values: Vec<f64> = points.iter().map(|[x, y]| 2.0 * x - 3.0 * y).collect();
            let at = set(0.750_003);
            assert!((value(&mesh, &values, at) - (2.0 * at[0] - 3.0 * at[1])).abs() < 1e-4, "{name}");
        }
    }
}
