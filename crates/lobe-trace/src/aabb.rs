//! Axis-aligned boxes, outside lanes.

/// A box given by its two extreme corners; empty if a lower coordinate is above the upper one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The smallest coordinates.
    pub lower: [f32; 3],
    /// The largest coordinates.
    pub upper: [f32; 3],
}

impl Aabb {
    /// The empty box, which no ray hits.
    pub const EMPTY: Aabb = Aabb { lower: [f32::INFINITY; 3], upper: [f32::NEG_INFINITY; 3] };

    /// The smallest box around the points.
    #[inline]
    pub fn of(points: impl IntoIterator<Item = [f32; 3]>) -> Self {
        points.into_iter().fold(Aabb::EMPTY, |sum, point| sum.union(Aabb { lower: point, upper: point }))
    }

    /// The smallest box around both.
    #[inline]
    pub fn union(self, other: Aabb) -> Aabb {
        // Not `f32::min`, which takes four instructions instead of one because it handles NaN.
        let least = |a: f32, b: f32| if b < a { b } else { a };
        let most = |a: f32, b: f32| if b > a { b } else { a };
        Aabb {
            lower: std::array::from_fn(|axis| least(self.lower[axis], other.lower[axis])),
            upper: std::array::from_fn(|axis| most(self.upper[axis], other.upper[axis])),
        }
    }

    /// Half the surface area, to which the probability that a ray hits the box is proportional.
    #[inline]
    pub fn half_area(self) -> f32 {
        let size = |axis: usize| self.upper[axis] - self.lower[axis];
        let [x, y, z]: [f32; 3] = std::array::from_fn(|axis| if size(axis) > 0.0 { size(axis) } else { 0.0 });
        x * y + y * z + z * x
    }

    /// The largest magnitude of a coordinate; 0 for the empty box.
    pub fn reach(self) -> f32 {
        if self.lower[0] > self.upper[0] {
            return 0.0;
        }
        self.lower.iter().chain(&self.upper).fold(0.0, |most, x| x.abs().max(most))
    }

    /// In the order of a node's rows: lower x, upper x, lower y, ...
    pub(crate) fn rows(self) -> [f32; 6] {
        let ([a, c, e], [b, d, f]) = (self.lower, self.upper);
        [a, b, c, d, e, f]
    }
}
