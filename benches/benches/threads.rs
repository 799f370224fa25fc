//! How much faster are two threads than one?

mod common;

use criterion::{Criterion, criterion_group, criterion_main};

fn threads(criterion: &mut Criterion) {
    common::bench(criterion, &["threads"]);
}

criterion_group!(benches, threads);
criterion_main!(benches);
