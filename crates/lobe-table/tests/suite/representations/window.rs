//! Klems matrices and tensor trees.

use lobe_backend::Backend;
use lobe_table::Directions;
use lobe_table::window::klems::{AngleBasis, KlemsMatrix, Ring};
use lobe_table::window::tensor_tree::{Node, Rank, TensorTree};
use lobe_table::window::{self, Block, Component};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use super::common::{COUNT, Evaluate, NOWHERE, Pairs, evaluate};

impl Evaluate for window::Table {
    fn run(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.eval_batch(backend, wi, wo, out);
    }
}

/// Every pair of patches has a different value.
fn klems(incident: &AngleBasis, exit: &AngleBasis) -> Component {
    let values = (0..incident.patches() * exit.patches()).map(|i| 1.0 + i as f32).collect();
    Component::Klems(KlemsMatrix::new(incident.clone(), exit.clone(), values).expect("a matrix"))
}

/// Rings that end before the horizon; one of them is empty.
fn short() -> AngleBasis {
    let ring = |lower, upper, patches| Ring { lower, upper, patches };
    let rings = vec![ring(0.0, 20.0, 3), ring(20.0, 40.0, 7), ring(39.9995, 39.9999, 2), ring(40.0, 70.0, 1)];
    AngleBasis::new("short", rings).expect("a basis")
}

/// Every cell has a different value.
fn tree(rank: Rank, seed: u64) -> Component {
    let children = 1 << rank.dimensions();
    let mut rng = Pcg32::seed_from_u64(seed);
    let (mut nodes, mut values) = (vec![Node::Leaf { first: 0, level: 0 }], Vec::new());
    let mut pending = vec![(0, 0)];
    while let Some((node, depth)) = pending.pop() {
        if depth < 3 && (depth == 0 || rng.random_range(0..3) == 0) {
            let first = nodes.len();
            nodes[node] = Node::Branch(first as u32);
            nodes.extend((0..children).map(|_| Node::Leaf { first: 0, level: 0 }));
            pending.extend((first..first + children).map(|child| (child, depth + 1)));
        } else {
            let level = rng.random_range(0..3);
            nodes[node] = Node::Leaf { first: values.len() as u32, level };
            let count = 1_usize << (level as usize * rank.dimensions());
            let next = values.len() as f32;
            values.extend((0..count).map(|i| 1.0 + next + i as f32));
        }
    }
    Component::Tree(TensorTree::new(rank, nodes, values).expect("a tree"))
}

fn check(name: &str, bands: Vec<window::Blocks>) {
    let pairs = Pairs::new(true);
    let table = window::Table::new(bands.clone()).expect("a small table");
    let width = bands.len();
    for (form, values) in evaluate(&table, &pairs, width) {
        let (mut certain, mut lit) = (0, 0);
        for query in 0..COUNT - NOWHERE {
            let (wi, wo) = pairs.exact(query);
            for (band, window) in bands.iter().enumerate() {
                let found = f64::from(values[query * width + band]);
                let candidates = window.candidates(wi, wo);
                assert!(candidates.contains(&window.eval(wi, wo)), "{name} {query}: the reference itself");
                let expected = &candidates[0];
                assert!(
                    candidates.contains(&found),
                    "{name} {form} {query} {band}: {found}, not {expected}: {wi:?} {wo:?}"
                );
                certain += usize::from(candidates.iter().all(|value| value == expected));
                lit += usize::from(found != 0.0);
            }
        }
        println!("{name} {form}: {certain} of {} far from any border, {lit} lit", COUNT * width);
        assert!(certain > COUNT * width * 9 / 10 && lit > COUNT * width / 5, "{name}: {certain} certain, {lit} lit");
    }
}

fn window(components: [Option<Component>; 4]) -> window::Blocks {
    let mut window = window::Blocks::default();
    for (block, component) in Block::ALL.into_iter().zip(components) {
        component.map(|component| window.set(block, component));
    }
    window
}

#[test]
fn patches_agree_with_the_reference() {
    let [full, half, quarter] = [AngleBasis::full(), AngleBasis::half(), AngleBasis::quarter()];
    let all = |basis: &AngleBasis| window([0; 4].map(|_| Some(klems(basis, basis))));
    check("full", vec![all(&full)]);
    check("half", vec![all(&half), all(&half)]);
    check("quarter and short", vec![all(&quarter), all(&short())]);
    check("two bases", vec![window([None, Some(klems(&full, &quarter)), Some(klems(&short(), &half)), None])]);
}

#[test]
fn cells_of_trees_agree_with_the_reference() {
    for rank in [Rank::Three, Rank::Four] {
        let trees = [1, 2, 3, 4].map(|seed| Some(tree(rank, seed)));
        check("trees", vec![window(trees)]);
        check("one way through", vec![window([Some(tree(rank, 5)), None, None, Some(tree(rank, 6))])]);
        let leaf = TensorTree::new(rank, vec![Node::Leaf { first: 0, level: 0 }], vec![2.0]).expect("a leaf");
        check("a leaf", vec![window([0; 4].map(|_| Some(Component::Tree(leaf.clone()))))]);
    }
}

#[test]
fn bands_of_different_kinds_are_independent() {
    let quarter = AngleBasis::quarter();
    let bands = vec![
        window([Some(klems(&quarter, &quarter)), None, None, Some(tree(Rank::Four, 7))]),
        window([None, Some(tree(Rank::Three, 8)), Some(tree(Rank::Four, 9)), Some(klems(&short(), &quarter))]),
        window([Some(tree(Rank::Four, 10)), None, Some(klems(&quarter, &quarter)), Some(tree(Rank::Four, 11))]),
    ];
    check("a mixture", bands);
}
