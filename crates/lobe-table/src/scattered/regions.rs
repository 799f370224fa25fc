//! A mesh as regions of the plane, each with the lines behind which other regions begin; lanes walk through them.
//!
//! A triangle is a region, and so is the area outside the rim that is nearest to one of its edges. For points on a
//! line, there is a strip across it for each pair of neighbours. In each region, weights are linear.

use std::collections::HashMap;

use super::mesh::{Mesh, Triangle};

/// A region narrower than this, in radians, is too narrow for single precision, in which a place is off by some 5e-7.
const NARROW: f64 = 2e-5;

/// A region of the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    /// The coefficients of `x`, `y` and 1 that give the distance of a point inside each side.
    pub(super) inside: [[f64; 3]; 3],
    /// The region on the other side, or itself if there is none.
    pub(super) next: [usize; 3],
    /// The points that have weights in it.
    pub(super) corners: [usize; 3],
    /// The factors from the distances inside the first and second side to the weights of the second and third corner.
    pub(super) scale: [f64; 2],
    /// `true` if double precision is needed.
    pub(super) is_narrow: bool,
}

/// A side that has all points inside.
const NO_SIDE: [f64; 3] = [0.0, 0.0, 1.0];

impl Region {
    /// The distance of a point inside.
    pub(super) fn depth(&self, [x, y]: [f64; 2]) -> f64 {
        self.inside.iter().map(|[a, b, c]| a * x + b * y + c).fold(f64::INFINITY, f64::min)
    }

    /// `true` if a part of a square may be in it.
    pub(super) fn may_reach(&self, [x, y]: [f64; 2], half: f64) -> bool {
        self.inside.iter().all(|[a, b, c]| a * x + b * y + c + half * (a.abs() + b.abs()) >= 0.0)
    }
}

/// The regions of a mesh; `None` if its rim is not a simple curve, which rounding may cause.
pub(super) fn regions(mesh: &Mesh) -> Option<Vec<Region>> {
    match mesh {
        Mesh::Line(line) => Some(of_line(line.start(), line.direction(), line.points())),
        Mesh::Triangles(triangles) => of_triangles(&triangles.triangles()),
    }
}

/// The half plane to the left of a line through `from` in the direction `along`, a unit vector.
fn left_of(from: [f64; 2], along: [f64; 2]) -> [f64; 3] {
    ahead_of(from, [-along[1], along[0]])
}

/// The half plane ahead of a point in a direction, a unit vector.
fn ahead_of(from: [f64; 2], along: [f64; 2]) -> [f64; 3] {
    [along[0], along[1], -(along[0] * from[0] + along[1] * from[1])]
}

fn reversed(side: [f64; 3]) -> [f64; 3] {
    side.map(|x| -x)
}

/// From one point to another: the unit vector and the distance.
fn way(from: [f64; 2], to: [f64; 2]) -> ([f64; 2], f64) {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let length = libm::hypot(dx, dy);
    ([dx / length, dy / length], length)
}

fn of_line(start: [f64; 2], direction: [f64; 2], points: &[(f64, usize)]) -> Vec<Region> {
    let at = |along: f64| [start[0] + along * direction[0], start[1] + along * direction[1]];
    let mut regions: Vec<Region> = Vec::new();
    let apart = points.windows(2).filter(|ends| ends[1].0 - ends[0].0 > 1e-12);
    for ends in apart {
        let ((from, lower), (to, upper)) = (ends[0], ends[1]);
        regions.push(Region {
            inside: [ahead_of(at(from), direction), reversed(ahead_of(at(to), direction)), NO_SIDE],
            next: [0; 3],
            corners: [lower, upper, lower],
            scale: [1.0 / (to - from), 0.0],
            is_narrow: to - from < NARROW,
        });
    }
    let last = regions.len().saturating_sub(1);
    for (index, region) in regions.iter_mut().enumerate() {
        region.next = [index.saturating_sub(1), (index + 1).min(last), index];
    }
    if regions.is_empty() {
        let only = points.first().map_or(0, |(_, index)| *index);
        let inside = [NO_SIDE; 3];
        regions.push(Region { inside, next: [0; 3], corners: [only; 3], scale: [0.0; 2], is_narrow: false });
    }
    regions
}

fn of_triangles(triangles: &[Triangle]) -> Option<Vec<Region>> {
    // Each edge by its ends, ordered so that the triangle is on the left.
    let mut owner = HashMap::new();
    for (index, triangle) in triangles.iter().enumerate() {
        for k in 0..3 {
            owner.insert([triangle.corners[(k + 1) % 3], triangle.corners[(k + 2) % 3]], index);
        }
    }
    let mut regions = Vec::with_capacity(triangles.len());
    let mut rim = Vec::new();
    for (index, Triangle { corners, at }) in triangles.iter().enumerate() {
        let mut region =
            Region { inside: [NO_SIDE; 3], next: [0; 3], corners: *corners, scale: [0.0; 2], is_narrow: false };
        // The sides opposite to the second, the third and the first corner.
        for (side, corner) in [1, 2, 0].into_iter().enumerate() {
            let [from, to] = [(corner + 1) % 3, (corner + 2) % 3];
            let (along, length) = way(at[from], at[to]);
            let inside = left_of(at[from], along);
            let height = inside[0] * at[corner][0] + inside[1] * at[corner][1] + inside[2];
            if !(height > 0.0 && length > 0.0) {
                return None;
            }
            region.inside[side] = inside;
            region.is_narrow |= height < NARROW;
            if side < 2 {
                region.scale[side] = 1.0 / height;
            }
            match owner.get(&[corners[to], corners[from]]) {
                Some(&other) => region.next[side] = other,
                None => {
                    region.next[side] = triangles.len() + rim.len();
                    rim.push(Edge { ends: [corners[from], corners[to]], at: [at[from], at[to]], triangle: index });
                }
            }
        }
        regions.push(region);
    }
    strips(&rim, &mut regions)?;
    Some(regions)
}

/// An edge of the rim, with its triangle on the left.
struct Edge {
    ends: [usize; 2],
    at: [[f64; 2]; 2],
    triangle: usize,
}

/// Adds the region outside each edge; `None` if the edges do not form one closed curve.
fn strips(rim: &[Edge], regions: &mut Vec<Region>) -> Option<()> {
    let first = regions.len();
    let starts: HashMap<usize, usize> = rim.iter().enumerate().map(|(index, edge)| (edge.ends[0], index)).collect();
    let stops: HashMap<usize, usize> = rim.iter().enumerate().map(|(index, edge)| (edge.ends[1], index)).collect();
    if rim.is_empty() || starts.len() != rim.len() || stops.len() != rim.len() {
        return None;
    }
    let (mut around, mut edge) = (0, 0);
    loop {
        edge = *starts.get(&rim[edge].ends[1])?;
        around += 1;
        if edge == 0 {
            break;
        }
    }
    if around != rim.len() {
        return None;
    }
    for (index, Edge { ends: [from, to], at: [start, stop], triangle }) in rim.iter().enumerate() {
        let (before, after) = (*stops.get(from)?, *starts.get(to)?);
        let (along, length) = way(*start, *stop);
        let (onward, _) = way(rim[after].at[0], rim[after].at[1]);
        regions.push(Region {
            // Points nearest to the end of an edge belong to it, and not to the next one.
            inside: [ahead_of(*start, along), reversed(ahead_of(*stop, onward)), reversed(left_of(*start, along))],
            next: [first + before, first + after, *triangle],
            corners: [*from, *to, *from],
            scale: [1.0 / length, 0.0],
            is_narrow: length < NARROW,
        });
        debug_assert_eq!(regions.len(), first + index + 1);
    }
    Some(())
}
