//! How fast is an anisotropic table evaluated in batches, by the library and by the paper's kernel?

mod common;

use criterion::{Criterion, criterion_group, criterion_main};

fn aniso(criterion: &mut Criterion) {
    common::bench(criterion, &["aniso", "aniso-paper"]);
}

criterion_group!(benches, aniso);
criterion_main!(benches);
