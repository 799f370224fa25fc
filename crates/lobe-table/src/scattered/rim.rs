//! The nearest of many edges in a plane, found with boxes around halves, quarters, and so on.

/// The number of edges in a box of the lowest level.
const LEAF: usize = 8;

/// A line between two points, each with its index in a list.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    ends: [usize; 2],
    from: [f64; 2],
    to: [f64; 2],
}

/// The weights of the two ends of an edge at its point nearest to a given point; they add up to 1.
pub(super) type Share = [(usize, f64); 2];

impl Edge {
    pub(super) fn new([(i, from), (j, to)]: [(usize, [f64; 2]); 2]) -> Self {
        Edge { ends: [i, j], from, to }
    }

    /// The point of the edge that is nearest to `at`, and its squared distance.
    pub(super) fn nearest(&self, at: [f64; 2]) -> (Share, f64) {
        let ([ax, ay], [bx, by]) = (self.from, self.to);
        let (dx, dy) = (bx - ax, by - ay);
        let length2 = dx * dx + dy * dy;
        let t = if length2 > 0.0 { (((at[0] - ax) * dx + (at[1] - ay) * dy) / length2).clamp(0.0, 1.0) } else { 0.0 };
        let distance2 = (ax + t * dx - at[0]).powi(2) + (ay + t * dy - at[1]).powi(2);
        ([(self.ends[0], 1.0 - t), (self.ends[1], t)], distance2)
    }

    fn middle(&self, axis: usize) -> f64 {
        0.5 * (self.from[axis] + self.to[axis])
    }
}

/// A box around edges.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    lower: [f64; 2],
    upper: [f64; 2],
}

impl Bounds {
    fn of(edges: &[(usize, Edge)]) -> Self {
        let mut bounds = Bounds { lower: [f64::INFINITY; 2], upper: [f64::NEG_INFINITY; 2] };
        for end in edges.iter().flat_map(|(_, edge)| [edge.from, edge.to]) {
            bounds.lower = [0, 1].map(|axis| bounds.lower[axis].min(end[axis]));
            bounds.upper = [0, 1].map(|axis| bounds.upper[axis].max(end[axis]));
        }
        bounds
    }

    fn distance2(&self, at: [f64; 2]) -> f64 {
        let off = |axis: usize| (self.lower[axis] - at[axis]).max(at[axis] - self.upper[axis]).max(0.0);
        off(0).powi(2) + off(1).powi(2)
    }

    fn wider_axis(&self) -> usize {
        usize::from(self.upper[1] - self.lower[1] > self.upper[0] - self.lower[0])
    }
}

/// Edges, among which the nearest is found in logarithmic time.
#[derive(Clone, Debug)]
pub(super) struct Rim {
    /// Each with its place in the order in which they were given.
    edges: Vec<(usize, Edge)>,
    /// In depth-first order: a box, the boxes of its first half, the boxes of its second half.
    boxes: Vec<Box>,
}

/// The bounds of some edges, and the box around the second half of them.
#[derive(Clone, Copy, Debug)]
struct Box {
    bounds: Bounds,
    second: usize,
}

/// The nearest edge so far.
struct Best {
    distance2: f64,
    place: usize,
    share: Option<Share>,
}

impl Rim {
    pub(super) fn new(edges: impl Iterator<Item = [(usize, [f64; 2]); 2]>) -> Self {
        let mut rim = Rim { edges: edges.map(Edge::new).enumerate().collect(), boxes: Vec::new() };
        rim.build(0, rim.edges.len());
        rim
    }

    fn build(&mut self, begin: usize, end: usize) {
        let bounds = Bounds::of(&self.edges[begin..end]);
        let number = self.boxes.len();
        self.boxes.push(Box { bounds, second: 0 });
        if let Some(half) = half(begin, end) {
            let axis = bounds.wider_axis();
            let by = |a: &(usize, Edge), b: &(usize, Edge)| a.1.middle(axis).total_cmp(&b.1.middle(axis));
            self.edges[begin..end].select_nth_unstable_by(half - begin, by);
            self.build(begin, half);
            self.boxes[number].second = self.boxes.len();
            self.build(half, end);
        }
    }

    /// The weights of the ends of the nearest edge; of several equally near ones, the first in the given order; `None`
    /// if there are no edges.
    pub(super) fn nearest(&self, at: [f64; 2]) -> Option<Share> {
        let mut best = Best { distance2: f64::INFINITY, place: usize::MAX, share: None };
        self.search(0, [0, self.edges.len()], at, &mut best);
        best.share
    }

    fn search(&self, node: usize, [begin, end]: [usize; 2], at: [f64; 2], best: &mut Best) {
        let Some(half) = half(begin, end) else {
            for (place, edge) in &self.edges[begin..end] {
                let (share, distance2) = edge.nearest(at);
                if (distance2, *place) < (best.distance2, best.place) || best.share.is_none() {
                    *best = Best { distance2, place: *place, share: Some(share) };
                }
            }
            return;
        };
        let halves = [(node + 1, [begin, half]), (self.boxes[node].second, [half, end])];
        let distances = halves.map(|(node, _)| self.boxes[node].bounds.distance2(at));
        let order = if distances[1] < distances[0] { [1, 0] } else { [0, 1] };
        for side in order {
            // Rounding may put an edge slightly nearer than the box around it.
            if distances[side] * (1.0 - 1e-12) <= best.distance2 {
                self.search(halves[side].0, halves[side].1, at, best);
            }
        }
    }
}

/// The position at which a box is split; `None` if it is of the lowest level.
fn half(begin: usize, end: usize) -> Option<usize> {
    (end - begin > LEAF).then(|| begin + (end - begin) / 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_edge_equals_a_search_of_all() {
        let point = |seed: usize| [(seed as f64 * 0.754_877_67).fract(), (seed as f64 * 0.569_840_29).fract()];
        for count in [0, 1, 2, 8, 9, 17, 100, 1000] {
            // Pairs of equal edges among them: the first of them counts.
            let ends = |k: usize| [(2 * k, point(k / 2)), (2 * k + 1, point(k / 2 + 1))];
            let rim = Rim::new((0..count).map(ends));
            for query in 0..200 {
                let at = point(7 * query + 3).map(|x| 3.0 * x - 1.0);
                let all = (0..count).map(|k| Edge::new(ends(k)).nearest(at));
                let expected = all.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(share, _)| share);
                assert_eq!(rim.nearest(at), expected, "{at:?} of {count}");
            }
        }
    }
}
