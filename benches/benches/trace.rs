//! How fast are rays of each class traced in each form on each backend?
//!
//! The scene is a torus knot of 70 thousand triangles in a closed room, generated here so that the figures can be
//! reproduced anywhere. Before criterion's own figures, a table is printed for which all contestants take turns at
//! small pieces and the best of several runs of each counts, so its ratios are also valid on a busy machine.

use std::time::Instant;

use criterion::{BenchmarkId, Criterion, Throughput};
use lobe::Backend;
use lobe_benches::tracing::{self, RaySet};
use lobe_trace::{Form, HitSoA, Rays, Scene};

/// Traces rays; the flag means that any hit is enough.
type Run<'a> = Box<dyn Fn(Rays<'_>, bool) + 'a>;

/// A form on a backend.
struct Contestant<'a> {
    name: String,
    run: Run<'a>,
}

fn contestants(scene: &Scene) -> Vec<Contestant<'_>> {
    let backends = Backend::available();
    backends.into_iter().flat_map(|backend| Form::ALL.map(|form| contestant(scene, backend, form))).collect()
}

fn contestant(scene: &Scene, backend: Backend, form: Form) -> Contestant<'_> {
    Contestant {
        name: format!("{backend} {form:?}"),
        run: Box::new(move |rays, any| {
            if any {
                let mut out = vec![false; rays.len()];
                scene.occluded_by(backend, form, rays, &mut out);
                std::hint::black_box(out);
            } else {
                let mut hits = HitSoA::new(rays.len());
                scene.intersect_by(backend, form, rays, hits.view());
                std::hint::black_box(hits);
            }
        }),
    }
}

/// Rays per piece: a few milliseconds, which often pass without an interruption.
const PIECE: usize = 1 << 14;

/// The time of each contestant for each set: the sum of the best times of its pieces.
fn best_times(sets: &[RaySet], contestants: &[Contestant<'_>]) -> Vec<Vec<f64>> {
    let mut best = vec![vec![0.0; sets.len()]; contestants.len()];
    for (column, RaySet { rays, any, .. }) in sets.iter().enumerate() {
        let mut rest = rays.view();
        while !rest.is_empty() {
            let (piece, others) = rest.split_at(PIECE.min(rest.len()));
            rest = others;
            let mut times = vec![f64::INFINITY; contestants.len()];
            for _ in 0..5 {
                for (time, contestant) in times.iter_mut().zip(contestants) {
                    let start = Instant::now();
                    (contestant.run)(piece, *any);
                    *time = time.min(start.elapsed().as_secs_f64());
                }
            }
            times.iter().zip(&mut best).for_each(|(time, row)| row[column] += time);
        }
    }
    best
}

/// Millions of rays per second, and in brackets the ratio to the same form on the scalar backend.
fn table(title: &str, scene: &Scene, pixels: usize) {
    let (sets, contestants) = (tracing::sets(scene, pixels), contestants(scene));
    let best = best_times(&sets, &contestants);
    print!("\n{title}: Mrays/s (times the scalar backend)\n{:16}", "");
    sets.iter().for_each(|set| print!("{:>16}", set.name));
    println!();
    for (row, contestant) in best.iter().zip(&contestants) {
        print!("{:16}", contestant.name);
        let form = contestant.name.split(' ').next_back();
        let scalar = contestants.iter().position(|other| other.name.split(' ').next_back() == form).unwrap_or(0);
        for (column, time) in row.iter().enumerate() {
            let speed = sets[column].rays.len() as f64 / time * 1e-6;
            print!("{speed:>9.2} ({:4.2})", best[scalar][column] / time);
        }
        println!();
    }
}

fn main() {
    let scene: Scene = Scene::of_mesh(tracing::in_room(tracing::knot(700, 50)));
    table("70 thousand triangles", &scene, 512);
    let mut criterion = Criterion::default().configure_from_args().sample_size(10);
    for RaySet { name, rays, any, .. } in tracing::sets(&scene, 128) {
        let mut group = criterion.benchmark_group(format!("trace/{name}"));
        group.throughput(Throughput::Elements(rays.len() as u64));
        for contestant in contestants(&scene) {
            let id = BenchmarkId::from_parameter(&contestant.name);
            group.bench_function(id, |bencher| bencher.iter(|| (contestant.run)(rays.view(), any)));
        }
        group.finish();
    }
    criterion.final_summary();
}
