//! How long does interpolation take if the angles are known?

mod common;

use criterion::{Criterion, criterion_group, criterion_main};

fn interpolation(criterion: &mut Criterion) {
    common::bench(criterion, &["iso-interpolation", "aniso-interpolation"]);
}

criterion_group!(benches, interpolation);
criterion_main!(benches);
