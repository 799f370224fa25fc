//! How fast are rays of each class, by each way through the tree, on each backend?
//!
//! A torus knot of 70 thousand triangles in a closed room, made here, so that the figures can be had anywhere. Before
//! criterion's own figures stands a table in which all contestants take turns at small pieces and the best of several
//! runs of each counts: its ratios hold on a busy machine too.

use std::f32::consts::TAU;
use std::time::Instant;

use criterion::{BenchmarkId, Criterion, Throughput};
use lobe_lane::Lanes;
use lobe_scalar::Scalar;
use lobe_trace::{Form, HitSoA, Intersect, MISS, Mesh, Occluded, RayClass, RaySoA, Rays, Scene};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

type V = [f32; 3];

fn add(a: V, b: V, s: f32) -> V {
    std::array::from_fn(|i| a[i] + s * b[i])
}
fn dot(a: V, b: V) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
fn normalized(a: V) -> V {
    a.map(|x| x / dot(a, a).sqrt())
}

/// The knot and the room.
fn scene<const W: usize>(along: usize, around: usize) -> Scene<W> {
    let center = |i: usize| -> V {
        let a = TAU * i as f32 / along as f32;
        let r = 1.0 + 0.4 * (3.0 * a).cos();
        [r * (2.0 * a).cos(), r * (2.0 * a).sin(), 0.4 * (3.0 * a).sin()]
    };
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..along {
        let p = center(i);
        let across = normalized(cross(add(center(i + 1), p, -1.0), [p[0], p[1], p[2] + 0.3]));
        let up = normalized(cross(add(center(i + 1), p, -1.0), across));
        for j in 0..around {
            let (sin, cos) = (TAU * j as f32 / around as f32).sin_cos();
            positions.push(add(add(p, across, 0.2 * cos), up, 0.2 * sin));
            let at = |i: usize, j: usize| (i % along * around + j % around) as u32;
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let base = positions.len() as u32;
    positions.extend((0..8).map(|i| -> V { std::array::from_fn(|axis| if i >> axis & 1 == 0 { -3.0 } else { 3.0 }) }));
    for [a, b, c, d] in [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]] {
        triangles.extend([[a, b, c], [a, c, d]].map(|corners| corners.map(|corner| corner + base)));
    }
    Scene::of_mesh(Mesh::new(positions, triangles).expect("a good mesh"))
}

/// A picture in tiles of 8 by 8 pixels, about 50 degrees wide.
fn camera(pixels: usize) -> RaySoA {
    let mut rays = RaySoA::with_capacity(pixels * pixels);
    for at in 0..pixels * pixels {
        let (tile, within) = (at / 64, at % 64);
        let (x, y) = (tile % (pixels / 8) * 8 + within % 8, tile / (pixels / 8) * 8 + within / 8);
        let [s, t] = [x, y].map(|x| (x as f32 + 0.5) / pixels as f32 * 2.0 - 1.0);
        rays.push([0.9, -0.3, 2.6], [0.5 * s - 0.4, 0.5 * t + 0.05, -1.0], 0.0, f32::INFINITY);
    }
    rays
}

/// Secondary rays: what happens at each hit is told by a function of the ray's direction, place and normal.
fn next<const W: usize>(scene: &Scene<W>, rays: &RaySoA, mut turn: impl FnMut(V, V, V) -> (V, f32)) -> RaySoA {
    let mut hits = HitSoA::new(rays.len());
    Scalar::<4>.vectorize(Intersect::new(scene, RayClass::Diffuse, rays.view(), hits.view()));
    let mut out = RaySoA::with_capacity(rays.len());
    for ray in 0..rays.len() {
        if hits.primitive[ray] == MISS {
            continue;
        }
        let at = |rows: &[Vec<f32>; 3]| -> V { [rows[0][ray], rows[1][ray], rows[2][ray]] };
        let (origin, direction) = (at(&rays.origin), at(&rays.direction));
        let [a, b, c] = scene.mesh_of(0).corners(hits.primitive[ray] as usize);
        let normal = normalized(cross(add(b, a, -1.0), add(c, a, -1.0)));
        let normal = if dot(normal, direction) > 0.0 { normal.map(|x| -x) } else { normal };
        let place = add(add(origin, direction, hits.t[ray]), normal, 1e-4);
        let (direction, end) = turn(direction, place, normal);
        out.push(place, direction, 0.0, end);
    }
    out
}

/// The sets of rays; the flag says that any hit is enough.
fn sets<const W: usize>(scene: &Scene<W>, pixels: usize) -> Vec<(&'static str, RaySoA, bool)> {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let camera = camera(pixels);
    let mirror = next(scene, &camera, |d, _, n| (add(d, n, -2.0 * dot(d, n)), f32::INFINITY));
    let mut scatter = |_: V, _: V, n: V| loop {
        let p: V = std::array::from_fn(|_| rng.random_range(-1.0f32..1.0));
        if (0.01..1.0).contains(&dot(p, p)) {
            break (add(n, normalized(p), 0.999), f32::INFINITY);
        }
    };
    let diffuse = next(scene, &camera, &mut scatter);
    let second = next(scene, &diffuse, &mut scatter);
    let light = [1.5, 2.0, 2.5];
    let shadow = next(scene, &camera, |_, place, _| (add(light, place, -1.0), 1.0));
    vec![
        ("camera", camera, false),
        ("shadow", shadow, true),
        ("mirror", mirror, false),
        ("diffuse", diffuse, false),
        ("diffuse2", second, false),
    ]
}

/// Traces rays; the flag says that any hit is enough.
type Run<'a> = Box<dyn Fn(Rays<'_>, bool) + 'a>;

/// A form on a backend.
struct Contestant<'a> {
    name: String,
    run: Run<'a>,
}

fn contestants<const W: usize>(scene: &Scene<W>) -> Vec<Contestant<'_>> {
    let mut all = Vec::new();
    enter(&mut all, Scalar::<1>, scene);
    #[cfg(target_arch = "x86_64")]
    {
        enter(&mut all, lobe_sse::Sse2::new(), scene);
        if let Some(avx2) = lobe_avx::Avx2::detect() {
            enter(&mut all, avx2, scene);
        }
    }
    all
}

fn enter<'a, L: Lanes, const W: usize>(all: &mut Vec<Contestant<'a>>, lanes: L, scene: &'a Scene<W>) {
    for form in Form::ALL {
        all.push(Contestant {
            name: format!("{} {form:?}", L::NAME),
            run: Box::new(move |rays, any| {
                let class = RayClass::Camera;
                if any {
                    let mut out = vec![false; rays.len()];
                    lanes.vectorize(Occluded::new(scene, class, rays, &mut out).by(form));
                    std::hint::black_box(out);
                } else {
                    let mut hits = HitSoA::new(rays.len());
                    lanes.vectorize(Intersect::new(scene, class, rays, hits.view()).by(form));
                    std::hint::black_box(hits);
                }
            }),
        });
    }
}

/// Rays of a piece: a few milliseconds, which often pass without an interruption.
const PIECE: usize = 1 << 14;

/// How long each contestant takes for each set: the sum of the best times of its pieces.
fn best_times(sets: &[(&str, RaySoA, bool)], contestants: &[Contestant<'_>]) -> Vec<Vec<f64>> {
    let mut best = vec![vec![0.0; sets.len()]; contestants.len()];
    for (column, (_, rays, any)) in sets.iter().enumerate() {
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

/// Millions of rays a second, and in brackets how many times the same form on the scalar backend.
fn table<const W: usize>(title: &str, scene: &Scene<W>, pixels: usize) {
    let (sets, contestants) = (sets(scene, pixels), contestants(scene));
    let best = best_times(&sets, &contestants);
    print!("\n{title}, {W} children a node: Mrays/s (times the scalar backend)\n{:16}", "");
    sets.iter().for_each(|(name, ..)| print!("{name:>16}"));
    println!();
    for (row, contestant) in best.iter().zip(&contestants) {
        print!("{:16}", contestant.name);
        let form = contestant.name.split(' ').next_back();
        let scalar = contestants.iter().position(|other| other.name.split(' ').next_back() == form).unwrap_or(0);
        for (column, time) in row.iter().enumerate() {
            let speed = sets[column].1.len() as f64 / time * 1e-6;
            print!("{speed:>9.2} ({:4.2})", best[scalar][column] / time);
        }
        println!();
    }
}

fn main() {
    let scene: Scene<8> = scene(700, 50);
    table("70 thousand triangles", &scene, 512);
    let mut criterion = Criterion::default().configure_from_args().sample_size(10);
    for (set, rays, any) in sets(&scene, 128) {
        let mut group = criterion.benchmark_group(format!("trace/{set}"));
        group.throughput(Throughput::Elements(rays.len() as u64));
        for contestant in contestants(&scene) {
            let id = BenchmarkId::from_parameter(&contestant.name);
            group.bench_function(id, |bencher| bencher.iter(|| (contestant.run)(rays.view(), any)));
        }
        group.finish();
    }
    criterion.final_summary();
}
