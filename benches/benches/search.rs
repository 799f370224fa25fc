//! How fast is the cell of an angle found, by the library's search and by the paper's?

mod common;

use criterion::{Criterion, criterion_group, criterion_main};

fn search(criterion: &mut Criterion) {
    common::bench(criterion, &["search", "search-paper", "search-33", "search-65"]);
}

criterion_group!(benches, search);
criterion_main!(benches);
