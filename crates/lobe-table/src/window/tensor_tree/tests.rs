use super::*;

#[test]
fn the_map_keeps_the_axes_and_the_diagonals() {
    let half = 0.5_f64.sqrt();
    let wanted = [
        ([0.0, 0.0], [0.5, 0.5]),
        ([1.0, 0.0], [1.0, 0.5]),
        ([0.0, 1.0], [0.5, 1.0]),
        ([-1.0, 0.0], [0.0, 0.5]),
        ([0.0, -1.0], [0.5, 0.0]),
        ([half, half], [1.0, 1.0]),
        ([-half, half], [0.0, 1.0]),
        ([-half, -half], [0.0, 0.0]),
        ([half, -half], [1.0, 0.0]),
    ];
    for ([x, y], [a, b]) in wanted {
        let [c, d] = square(x, y);
        assert!((a - c).abs() < 1e-12 && (b - d).abs() < 1e-12, "({x}, {y}) -> ({c}, {d}), not ({a}, {b})");
    }
}

#[test]
fn children_and_cells_are_in_opposite_orders() {
    // The low half along dimension 0, the first child's bit 0, holds a grid; dimension 0 varies slowest in a grid.
    let mut nodes = vec![Node::Branch(1)];
    nodes.push(Node::Leaf { first: 0, level: 1 });
    nodes.extend((8..15).map(|first| Node::Leaf { first, level: 0 }));
    let tree = TensorTree::new(Rank::Three, nodes, (0..15).map(|v| v as f32).collect()).expect("a tree");
    assert_eq!(tree.at([0.3, 0.1, 0.1, 0.0]), 4.0);
    assert_eq!(tree.at([0.1, 0.1, 0.3, 0.0]), 1.0);
    assert_eq!(tree.at([0.6, 0.1, 0.1, 0.0]), 8.0);
    assert_eq!(tree.at([0.1, 0.1, 0.6, 0.0]), 11.0);
    assert_eq!(tree.at([1.0, 1.0, 1.0, 0.0]), 14.0);
}

#[test]
fn invalid_trees_are_refused() {
    let leaf = Node::Leaf { first: 0, level: 0 };
    let new = |nodes| TensorTree::new(Rank::Three, nodes, vec![1.0]);
    assert_eq!(new(vec![]), Err(TreeError::Empty));
    assert_eq!(new(vec![Node::Branch(0)]), Err(TreeError::Children { node: 0, first: 0 }));
    assert_eq!(new(vec![Node::Branch(u32::MAX)]), Err(TreeError::Children { node: 0, first: u32::MAX }));
    assert_eq!(new(vec![leaf, leaf]), Err(TreeError::Parents { node: 1, parents: 0 }));
    assert_eq!(new(vec![Node::Leaf { first: 0, level: 1 }]), Err(TreeError::Values { node: 0 }));
    assert_eq!(new(vec![Node::Leaf { first: 0, level: 22 }]), Err(TreeError::Values { node: 0 }));
    assert_eq!(new(vec![Node::Leaf { first: 0, level: 25 }]), Err(TreeError::Depth { node: 0 }));
    assert_eq!(TensorTree::new(Rank::Three, vec![leaf], vec![f32::NAN]), Err(TreeError::ValueNotFinite { index: 0 }));
}

/// The integral over the hemisphere, from many points of equal projected solid angle.
fn integral(tree: &TensorTree, wi: [f64; 3]) -> f64 {
    const N: usize = 512;
    let mut sum = 0.0;
    for i in 0..N * N {
        let (radius, angle) = (
            ((i / N) as f64 + 0.5).sqrt() / (N as f64).sqrt(),
            std::f64::consts::TAU * ((i % N) as f64 + 0.5) / N as f64,
        );
        let (x, y) = (radius * angle.cos(), radius * angle.sin());
        sum += tree.eval(wi, [x, y, (1.0 - radius * radius).sqrt()]);
    }
    std::f64::consts::PI * sum / (N * N) as f64
}

#[test]
fn the_albedo_is_the_integral() {
    // A coarse tree with one finer branch, and a peak.
    for (rank, children) in [(Rank::Three, 8), (Rank::Four, 16)] {
        let mut nodes = vec![Node::Branch(1)];
        let mut values: Vec<f32> = Vec::new();
        let leaf = |values: &mut Vec<f32>, level: u32| {
            let first = values.len() as u32;
            let count = 1_usize << (level as usize * rank.dimensions());
            values.extend((0..count).map(|i| ((i * 7 + count) % 13) as f32 * if i % 5 == 0 { 3.0 } else { 0.1 }));
            Node::Leaf { first, level }
        };
        nodes.push(Node::Branch(1 + children));
        nodes.extend((1..children).map(|child| leaf(&mut values, child % 3)));
        nodes.extend((0..children).map(|child| leaf(&mut values, child % 2)));
        let tree = TensorTree::new(rank, nodes, values).expect("a tree");
        for (theta, phi) in [(0.1_f64, 0.3_f64), (0.7, 2.0), (1.2, 4.0), (1.5, 5.5)] {
            let wi = [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()];
            let (exact, sum) = (tree.albedo(wi), integral(&tree, wi));
            assert!((exact - sum).abs() < 5e-3 * sum, "{rank:?} at {theta}, {phi}: {exact}, not {sum}");
        }
    }
}
