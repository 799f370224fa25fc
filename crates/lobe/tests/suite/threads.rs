//! Sharing a batch among threads changes nothing.
#![cfg(feature = "rayon")]

use lobe::{Channels, Material, Options, PARALLEL_FROM, Scatter, specular};

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let knots = [vec![0.0, 0.5, 1.2], vec![0.0], vec![0.0, 0.1, 0.7, 3.0], vec![0.0, 2.0, 4.0]];
    let values = (0..3 * 4 * 3 * 3).map(|i| (i * 37 % 101) as f32).collect();
    let samples = specular::Data::new(Scatter::Reflection, knots, Channels::Rgb, values).unwrap();
    let material = Material::from_samples(samples, &Options::default()).unwrap();

    // Neither a multiple of the block nor of the task.
    let count = 3 * PARALLEL_FROM + 77;
    let direction = |i: usize| {
        let (turn, z) = (i as f32 * 0.7, 0.05 + 0.9 * (i % 1013) as f32 / 1013.0);
        let across = (1.0 - z * z).sqrt();
        [across * turn.cos(), across * turn.sin(), z]
    };
    let wi: Vec<_> = (0..count).map(direction).collect();
    let wo: Vec<_> = (0..count).map(|i| direction(7 * i + 3)).collect();
    let evaluate = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut out = vec![f32::NAN; 3 * count];
        pool.install(|| material.eval_batch(&wi, &wo, &mut out));
        out
    };
    let one = evaluate(1);
    assert!(one.iter().all(|x| x.is_finite()) && one.iter().any(|x| *x > 0.0));
    for threads in [2, 5] {
        assert_eq!(evaluate(threads), one, "{threads} threads");
    }
    // And with the same queries in pieces too small to be shared.
    let mut pieces = vec![f32::NAN; 3 * count];
    for (at, out) in pieces.chunks_mut(3 * 1000).enumerate() {
        let range = 1000 * at..1000 * at + out.len() / 3;
        material.eval_batch(&wi[range.clone()], &wo[range], out);
    }
    assert_eq!(pieces, one);
}
