//! How fast are materials of the EPFL database evaluated and sampled?

mod common;

use criterion::{Criterion, criterion_group, criterion_main};

fn rgl(criterion: &mut Criterion) {
    common::bench(criterion, &["rgl-eval", "rgl-pdf", "rgl-sample"]);
}

criterion_group!(benches, rgl);
criterion_main!(benches);
