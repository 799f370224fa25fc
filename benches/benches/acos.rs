//! How fast are arc cosines, in eight terms and in the paper's four?

mod common;

use criterion::{Criterion, criterion_group, criterion_main};

fn acos(criterion: &mut Criterion) {
    common::bench(criterion, &["acos", "acos-paper"]);
}

criterion_group!(benches, acos);
criterion_main!(benches);
