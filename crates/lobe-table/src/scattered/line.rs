//! Linear interpolation between points of a plane that are on a line.

/// Points on a line, and the interpolation between them.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    /// An end of the line, and its direction, which is zero if there is only one point.
    start: [f64; 2],
    direction: [f64; 2],
    /// The distance of each point along the line, ascending, and its index.
    points: Vec<(f64, usize)>,
}

impl Line {
    /// The points as a line; `None` if there is no point, or one is farther than `tolerance` from the line through the
    /// points at its ends.
    pub(crate) fn new(points: &[[f64; 2]], tolerance: f64) -> Option<Self> {
        let farthest = |from: [f64; 2]| {
            let distance = |point: &[f64; 2]| libm::hypot(point[0] - from[0], point[1] - from[1]);
            points.iter().copied().max_by(|a, b| distance(a).total_cmp(&distance(b)))
        };
        let start = farthest(*points.first()?)?;
        let end = farthest(start)?;
        let (dx, dy) = (end[0] - start[0], end[1] - start[1]);
        let length = libm::hypot(dx, dy);
        let direction = if length > 0.0 { [dx / length, dy / length] } else { [0.0; 2] };
        let mut line = Line { start, direction, points: Vec::new() };
        let off = |[x, y]: [f64; 2]| (direction[0] * (y - start[1]) - direction[1] * (x - start[0])).abs();
        if !points.iter().all(|&point| off(point) <= tolerance) {
            return None;
        }
        line.points = points.iter().enumerate().map(|(index, &point)| (line.along(point), index)).collect();
        line.points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Some(line)
    }

    /// The distance along the line of its point nearest to `point`.
    fn along(&self, [x, y]: [f64; 2]) -> f64 {
        self.direction[0] * (x - self.start[0]) + self.direction[1] * (y - self.start[1])
    }

    /// The origin of the distances of [`points`](Self::points).
    #[cfg(feature = "scattered")]
    pub(super) fn start(&self) -> [f64; 2] {
        self.start
    }

    /// The direction of the line, of length 1; zero if there is only one point.
    #[cfg(feature = "scattered")]
    pub(super) fn direction(&self) -> [f64; 2] {
        self.direction
    }

    /// The distance of each point along the line, ascending, and its index.
    #[cfg(feature = "scattered")]
    pub(super) fn points(&self) -> &[(f64, usize)] {
        &self.points
    }

    /// The two points around the point of the line nearest to `point`, and their weights.
    pub(crate) fn weights(&self, point: [f64; 2]) -> [(usize, f64); 2] {
        let at = self.along(point);
        let upper = self.points.partition_point(|&(along, _)| along < at).min(self.points.len() - 1);
        let lower = upper.saturating_sub(1);
        let ((from, lower), (to, upper)) = (self.points[lower], self.points[upper]);
        let share = if to > from { ((at - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        [(lower, 1.0 - share), (upper, share)]
    }
}
