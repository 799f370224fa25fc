//! Linear interpolation between scattered points of a plane, on their Delaunay triangulation.

use spade::{DelaunayTriangulation, HierarchyHintGenerator, Point2, PositionInTriangulation, Triangulation};

type Delaunay = DelaunayTriangulation<Point2<f64>, (), (), (), HierarchyHintGenerator<f64>>;

/// Scattered points and how to interpolate between them.
#[derive(Clone, Debug)]
pub(crate) struct Mesh {
    triangles: Delaunay,
}

/// Up to three points and what each counts for; the weights are not negative and add up to 1.
pub(crate) type Weights = [(usize, f64); 3];

impl Mesh {
    /// Triangulates points that are finite and different from each other; `None` where there is no point.
    pub(crate) fn new(points: &[[f64; 2]]) -> Option<Self> {
        // Coordinates that only rounding keeps from zero would be refused.
        let snap = |x: f64| if x.abs() < 1e-12 { 0.0 } else { x };
        let points: Vec<_> = points.iter().map(|[x, y]| Point2::new(snap(*x), snap(*y))).collect();
        let triangles = Delaunay::bulk_load_stable(points).ok()?;
        (triangles.num_vertices() > 0).then_some(Mesh { triangles })
    }

    /// The weights at a point of the plane. Outside of the convex hull they are those of the nearest point of the hull,
    /// and so they are where all points lie on a line.
    pub(crate) fn weights(&self, point: [f64; 2]) -> Weights {
        let at = Point2::new(point[0], point[1]);
        let ends = |edge: spade::handles::FixedDirectedEdgeHandle| {
            let edge = self.triangles.directed_edge(edge);
            [edge.from(), edge.to()].map(|end| (end.index(), end.position()))
        };
        match self.triangles.locate(at) {
            PositionInTriangulation::OnVertex(vertex) => [(vertex.index(), 1.0), (0, 0.0), (0, 0.0)],
            PositionInTriangulation::OnEdge(edge) => along(ends(edge), at).0,
            PositionInTriangulation::OnFace(face) => {
                let corners = self.triangles.face(face).vertices();
                let [a, b, c] = corners.map(|corner| corner.position());
                let area = |p: Point2<f64>, q: Point2<f64>, r: Point2<f64>| {
                    ((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x)).max(0.0)
                };
                let parts = [area(at, b, c), area(a, at, c), area(a, b, at)];
                let whole: f64 = parts.iter().sum();
                // A triangle too thin for its area to show: any corner is as near as rounding allows.
                let weight = |index: usize| if whole > 0.0 { parts[index] / whole } else { 1.0 / 3.0 };
                std::array::from_fn(|index| (corners[index].index(), weight(index)))
            }
            PositionInTriangulation::OutsideOfConvexHull(_) => {
                let hull = self.triangles.convex_hull().map(|edge| along(ends(edge.fix()), at));
                let nearest = hull.min_by(|(_, a), (_, b)| a.total_cmp(b));
                nearest.map_or([(0, 1.0), (0, 0.0), (0, 0.0)], |(weights, _)| weights)
            }
            PositionInTriangulation::NoTriangulation => [(0, 1.0), (0, 0.0), (0, 0.0)],
        }
    }
}

/// The weights of the point of an edge that is nearest to `at`, and its squared distance.
fn along([(i, a), (j, b)]: [(usize, Point2<f64>); 2], at: Point2<f64>) -> (Weights, f64) {
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    let length2 = dx * dx + dy * dy;
    let t = if length2 > 0.0 { (((at.x - a.x) * dx + (at.y - a.y) * dy) / length2).clamp(0.0, 1.0) } else { 0.0 };
    let distance2 = (a.x + t * dx - at.x).powi(2) + (a.y + t * dy - at.y).powi(2);
    ([(i, 1.0 - t), (j, t), (0, 0.0)], distance2)
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
    fn points_on_a_line_and_single_points_will_do() {
        let mesh = Mesh::new(&[[0.0, 0.0], [2.0, 0.0], [4.0, 0.0]]).expect("points");
        assert_eq!(value(&mesh, &[1.0, 2.0, 6.0], [3.0, 0.0]), 4.0);
        assert_eq!(value(&mesh, &[1.0, 2.0, 6.0], [1.0, 5.0]), 1.5);
        assert_eq!(value(&mesh, &[1.0, 2.0, 6.0], [-1.0, -5.0]), 1.0);
        let mesh = Mesh::new(&[[0.5, 0.5]]).expect("a point");
        assert_eq!(value(&mesh, &[7.0], [0.1, 0.0]), 7.0);
        assert!(Mesh::new(&[]).is_none());
    }
}
