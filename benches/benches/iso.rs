//! How fast is an isotropic table evaluated in batches, by the library and by the paper's kernel?

mod common;

use criterion::{Criterion, criterion_group, criterion_main};

fn iso(criterion: &mut Criterion) {
    common::bench(criterion, &["iso", "iso-paper"]);
}

criterion_group!(benches, iso);
criterion_main!(benches);
