//! How long does a call for one query take, isotropic and anisotropic?

mod common;

use criterion::{Criterion, criterion_group, criterion_main};

fn single(criterion: &mut Criterion) {
    common::bench(criterion, &["iso-single", "aniso-single"]);
}

criterion_group!(benches, single);
criterion_main!(benches);
