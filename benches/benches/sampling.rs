//! How fast are directions sampled in proportion to a table?

mod common;

use criterion::{Criterion, criterion_group, criterion_main};

fn sampling(criterion: &mut Criterion) {
    common::bench(criterion, &["iso-sample", "aniso-sample"]);
}

criterion_group!(benches, sampling);
criterion_main!(benches);
