//! Shared by all benchmarks: builds a contest, checks its values, and passes its contenders to criterion.

use criterion::{BenchmarkId, Criterion, Throughput};
use lobe_benches::contest::Question;
use lobe_benches::workload::Input;

/// Queries per run: enough to exceed the first cache, as a renderer's batches do.
const COUNT: usize = 1 << 14;

/// Benchmarks all contenders of the questions with these ids, on both inputs.
///
/// # Panics
/// If the values of a contender differ from the reference.
pub fn bench(criterion: &mut Criterion, ids: &[&str]) {
    for id in ids {
        let question = Question::named(id).expect("a question of the contests");
        let mut group = criterion.benchmark_group(*id);
        for input in Input::ALL {
            let mut contest = question.contest(input, COUNT);
            group.throughput(Throughput::Elements(contest.count as u64));
            if let Err(wrong) = contest.verify() {
                panic!("{id}, {}: {wrong}", input.name());
            }
            for contender in contest.baselines.iter_mut().chain(&mut contest.contenders) {
                let name = BenchmarkId::new(contender.name, input.name());
                group.bench_function(name, |bencher| bencher.iter(|| contender.run()));
            }
        }
    }
}
