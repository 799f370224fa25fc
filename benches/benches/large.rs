//! How fast are tables beyond the caches, in single and in half precision?

mod common;

use criterion::{Criterion, criterion_group, criterion_main};

fn large(criterion: &mut Criterion) {
    common::bench(criterion, &["large", "large-aniso"]);
}

criterion_group!(benches, large);
criterion_main!(benches);
