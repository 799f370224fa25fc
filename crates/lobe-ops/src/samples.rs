//! Code shared by operations on tables.

pub(crate) use lobe_table::data::closes_circle;
use lobe_table::specular::coords::angles_to_directions;
use lobe_table::specular::reference::zenith;
use lobe_table::{Edges, GridError, specular};

/// The same table with other values.
pub(crate) fn with_values(samples: &specular::Data, values: Vec<f32>) -> Result<specular::Data, GridError> {
    let table = specular::Data::new(samples.scatter(), samples.knots().clone(), samples.channels().clone(), values)?;
    match samples.refraction() {
        Some(offsets) => table.with_refraction(offsets.to_vec()),
        None => Ok(table),
    }
}

/// The edge policy with which repairs look up values: that of the evaluation, with negative values kept.
pub(crate) fn signed_edges() -> Edges {
    Edges { non_negative: false, ..Edges::default() }
}

/// The nodes of a table in the order of its values: the knot indices of sigma, psi, theta and phi.
pub(crate) fn nodes(samples: &specular::Data) -> impl Iterator<Item = [usize; 4]> {
    let counts = samples.knots().each_ref().map(Vec::len);
    (0..counts.iter().product()).map(move |index| node(counts, index))
}

/// The node at a position in the order of the values.
pub(crate) fn node(counts: [usize; 4], mut index: usize) -> [usize; 4] {
    let mut node = [0; 4];
    for axis in (0..4).rev() {
        node[axis] = index % counts[axis];
        index /= counts[axis];
    }
    node
}

/// The position of a node in the order of the values.
pub(crate) fn position(counts: [usize; 4], node: [usize; 4]) -> usize {
    node.into_iter().zip(counts).fold(0, |at, (index, count)| at * count + index)
}

/// The angles of a node.
pub(crate) fn angles(samples: &specular::Data, node: [usize; 4]) -> [f64; 4] {
    std::array::from_fn(|axis| samples.knots()[axis][node[axis]])
}

/// The directions of a node, both with z > 0 for nodes above the horizon.
pub(crate) fn directions(samples: &specular::Data, node: [usize; 4]) -> ([f64; 3], [f64; 3]) {
    angles_to_directions(angles(samples, node), |sigma| zenith(samples, &Edges::default(), sigma))
}
