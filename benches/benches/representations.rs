//! How fast are the representations other than specular tables evaluated?

mod common;

use criterion::{Criterion, criterion_group, criterion_main};

fn representations(criterion: &mut Criterion) {
    common::bench(
        criterion,
        &[
            "half-diff",
            "half-diff-linear",
            "spherical",
            "scattered",
            "utia",
            "klems",
            "tensor-tree",
            "mueller",
            "mueller-matrices",
            "polarised-matrices",
        ],
    );
}

criterion_group!(benches, representations);
criterion_main!(benches);
