use super::klems::KlemsMatrix;
use super::*;
use crate::window::klems::AngleBasis;

#[test]
fn the_sides_choose_the_block() {
    let (up, down) = ([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]);
    let basis = AngleBasis::quarter();
    let mut window = Blocks::default();
    for (index, block) in Block::ALL.into_iter().enumerate() {
        let values = vec![index as f32 + 1.0; basis.patches().pow(2)];
        let matrix = KlemsMatrix::new(basis.clone(), basis.clone(), values).expect("a square matrix");
        assert_eq!(window.set(block, Component::Klems(matrix)), None);
    }
    let found = [(down, up), (up, down), (down, down), (up, up)].map(|(wi, wo)| window.eval(wi, wo));
    assert_eq!(found, [1.0, 2.0, 3.0, 4.0]);
    assert_eq!(window.eval([1.0, 0.0, 0.0], up), 0.0);
}

#[test]
fn one_transmission_block_serves_both_ways() {
    let basis = AngleBasis::quarter();
    let n = basis.patches();
    let values = (0..n * n).map(|at| at as f32).collect();
    let matrix = KlemsMatrix::new(basis.clone(), basis, values).expect("a square matrix");
    let mut window = Blocks::default();
    window.set(Block::TransmissionBack, Component::Klems(matrix.clone()));
    let (above, below) = ([0.6, 0.0, 0.8], [0.0, 0.28, -0.96]);
    assert_eq!(window.eval(above, below), matrix.eval(above, below));
    assert_eq!(window.eval(below, above), matrix.eval(above, below));
    assert_eq!(window.eval(above, above), 0.0);
}
