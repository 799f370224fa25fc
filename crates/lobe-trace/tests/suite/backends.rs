//! Every form on every backend agrees with double precision, and gives the same bits as one ray at a time.

use std::sync::LazyLock;

use lobe_backend::Backend;
use lobe_lane::{Kernel, Lanes};
use lobe_scalar::Scalar;
use lobe_trace::{
    Affine, Form, HitSoA, Intersect, MISS, Mesh, Occluded, Packet, RayClass, RaySoA, Scene, SceneBuilder, Tracer,
};

use crate::{meshes, rays, reference};

pub struct Case {
    pub name: &'static str,
    pub eight: Scene<8>,
    pub four: Scene<4>,
    pub rays: RaySoA,
    /// Traced one ray at a time on the reference backend, and checked against double precision.
    pub hits: HitSoA,
}

fn single(mesh: Mesh) -> SceneBuilder {
    let mut builder = SceneBuilder::new();
    let mesh = builder.mesh(mesh);
    builder.instance(mesh, Affine::IDENTITY);
    builder
}

/// Rotated, stretched, mirrored and translated instances; two in the same place.
fn instanced() -> SceneBuilder {
    let mut builder = SceneBuilder::new();
    let (knot, cloth) = (builder.mesh(meshes::torus_knot(60, 8)), builder.mesh(meshes::cloth(12)));
    for i in 0..9 {
        let (sin, cos) = (0.7 * i as f32).sin_cos();
        let size = 0.3 + 0.05 * i as f32;
        let [x, y, z] = [(i % 3) as f32 - 1.0, (i / 3) as f32 - 1.0, 0.4 * sin];
        let turned = Affine {
            rows: [[size * cos, -size * sin, 0.1, x], [size * sin, size * cos, 0.0, y], [0.0, 0.2 * sin, -size, z]],
        };
        builder.instance(if i % 2 == 0 { knot } else { cloth }, turned);
    }
    let place = Affine::translation([0.25, -0.5, 1.0]);
    builder.instance(cloth, place);
    builder.instance(cloth, place);
    builder
}

pub static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| {
    let scenes = [
        ("sphere", single(meshes::sphere(24))),
        ("torus knot", single(meshes::torus_knot(150, 12))),
        ("cloth", single(meshes::cloth(32))),
        ("soup", single(meshes::soup(900))),
        ("instances", instanced()),
    ];
    scenes
        .into_iter()
        .map(|(name, builder)| {
            let eight: Scene<8> = builder.clone().build(|_| ()).unwrap();
            let four = builder.build(|_| ()).unwrap();
            // A number of rays that is not a multiple of any packet.
            let bounds = eight.bounds();
            let sets = [rays::camera(bounds, 32), rays::bounded(bounds, 128, 4), rays::mixed(bounds, 1500, 3)];
            let rays = rays::joined(&sets);
            let hits = intersect(Backend::scalar(), &eight, &rays, Form::Single);
            let count = reference::check(&eight, &rays, &hits, name);
            println!("{name}: {count} of {} rays hit", rays.len());
            assert!(count > rays.len() / 10 && count < rays.len(), "{name}: {count} of {} rays hit", rays.len());
            Case { name, eight, four, rays, hits }
        })
        .collect()
});

/// The tracer: a backend, through the functions that users call, or lanes that are not a backend.
pub trait Tracing: Copy {
    fn name(self) -> &'static str;
    fn is_fused(self) -> bool;
    fn run<K: Kernel>(self, kernel: K);
    fn intersect(self, scene: &Scene, form: Form, rays: &RaySoA, hits: &mut HitSoA);
    fn occluded(self, scene: &Scene, form: Form, rays: &RaySoA, out: &mut [bool]);
}

impl Tracing for Backend {
    fn name(self) -> &'static str {
        Backend::name(&self)
    }

    fn is_fused(self) -> bool {
        self.has_fused_form() && !self.is_strict()
    }

    fn run<K: Kernel>(self, kernel: K) {
        Backend::run(&self, kernel);
    }

    fn intersect(self, scene: &Scene, form: Form, rays: &RaySoA, hits: &mut HitSoA) {
        scene.intersect_by(self, form, rays.view(), hits.view());
    }

    fn occluded(self, scene: &Scene, form: Form, rays: &RaySoA, out: &mut [bool]) {
        scene.occluded_by(self, form, rays.view(), out);
    }
}

/// Lanes that are not a backend, or trees that backends have no function for.
#[derive(Clone, Copy)]
struct On<L>(L);

impl<L: Lanes> Tracing for On<L> {
    fn name(self) -> &'static str {
        L::NAME
    }

    fn is_fused(self) -> bool {
        L::FUSED
    }

    fn run<K: Kernel>(self, kernel: K) {
        self.0.vectorize(kernel);
    }

    fn intersect(self, scene: &Scene, form: Form, rays: &RaySoA, hits: &mut HitSoA) {
        self.run(Intersect::new(scene, form, rays.view(), hits.view()));
    }

    fn occluded(self, scene: &Scene, form: Form, rays: &RaySoA, out: &mut [bool]) {
        self.run(Occluded::new(scene, form, rays.view(), out));
    }
}

pub fn intersect(tracing: impl Tracing, scene: &Scene, rays: &RaySoA, form: Form) -> HitSoA {
    let mut hits = HitSoA::new(rays.len());
    tracing.intersect(scene, form, rays, &mut hits);
    hits
}

fn occluded(tracing: impl Tracing, scene: &Scene, rays: &RaySoA, form: Form) -> Vec<bool> {
    let mut out = vec![false; rays.len()];
    tracing.occluded(scene, form, rays, &mut out);
    out
}

/// The first ray whose hit differs in a bit.
fn first_difference(a: &HitSoA, b: &HitSoA) -> Option<usize> {
    let row = |x: &[f32], y: &[f32], i: usize| x[i].to_bits() == y[i].to_bits();
    (0..a.t.len()).find(|&i| {
        let same = row(&a.t, &b.t, i) && row(&a.u, &b.u, i) && row(&a.v, &b.v, i);
        !same || (a.primitive[i], a.instance[i]) != (b.primitive[i], b.instance[i])
    })
}

fn same_bits<const W: usize>(scene: &Scene<W>, rays: &RaySoA, found: &HitSoA, truth: &HitSoA, name: &str) {
    if let Some(i) = first_difference(found, truth) {
        let text = |hits: &HitSoA| {
            let ids = (hits.primitive[i], hits.instance[i]);
            format!("{:?} at t {:e} ({:08x}) u {:e} v {:e}", ids, hits.t[i], hits.t[i].to_bits(), hits.u[i], hits.v[i])
        };
        let at = |rows: &[Vec<f32>; 3]| [rows[0][i], rows[1][i], rows[2][i]];
        let ray = (at(&rays.origin), at(&rays.direction), rays.t_min[i], rays.t_max[i]);
        panic!("{name}, {W} children, {:?}: ray {i} {ray:?}: {} for {}", scene.bounds(), text(found), text(truth));
    }
}

/// A strict form must give the bits of the reference; a fused one those of its own single rays, which are within the
/// tolerance of the reference.
fn check_form(lanes: impl Tracing, form: Form) {
    for case in CASES.iter() {
        let name = format!("{} {} {form:?}", case.name, lanes.name());
        let found = intersect(lanes, &case.eight, &case.rays, form);
        if lanes.is_fused() {
            let single = intersect(lanes, &case.eight, &case.rays, Form::Single);
            same_bits(&case.eight, &case.rays, &found, &single, &name);
            reference::check(&case.eight, &case.rays, &found, &name);
        } else {
            same_bits(&case.eight, &case.rays, &found, &case.hits, &name);
        }
        let hit: Vec<bool> = found.primitive.iter().map(|&primitive| primitive != MISS).collect();
        assert_eq!(occluded(lanes, &case.eight, &case.rays, form), hit, "{name}");
    }
}

/// Trees with four children per node give the same as those with eight.
fn check_four(lanes: impl Tracing) {
    for case in CASES.iter() {
        let name = format!("{} {}", case.name, lanes.name());
        let truth = intersect(lanes, &case.eight, &case.rays, Form::Single);
        for form in Form::ALL {
            let mut found = HitSoA::new(case.rays.len());
            lanes.run(Intersect::new(&case.four, form, case.rays.view(), found.view()));
            same_bits(&case.four, &case.rays, &found, &truth, &name);
        }
    }
}

/// Traces a batch by the packet call, from within a kernel.
struct ByPacket<'a>(&'a Scene<8>, RayClass, &'a RaySoA, &'a mut HitSoA);

impl Kernel for ByPacket<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let ByPacket(scene, class, rays, hits) = self;
        let mut tracer = Tracer::new(scene);
        let mut at = 0;
        while at < rays.len() {
            let load = |x: &[f32]| lanes.load_partial(&x[at..]);
            let packet: Packet<L> = Packet {
                origin: [load(&rays.origin[0]), load(&rays.origin[1]), load(&rays.origin[2])],
                direction: [load(&rays.direction[0]), load(&rays.direction[1]), load(&rays.direction[2])],
                t_min: load(&rays.t_min),
                t_max: load(&rays.t_max),
            };
            let live = lanes.first_n(rays.len() - at);
            let found = tracer.intersect_packet(lanes, class, packet, live);
            lanes.store_partial(&mut hits.t[at..], found.t);
            lanes.store_partial(&mut hits.u[at..], found.u);
            lanes.store_partial(&mut hits.v[at..], found.v);
            lanes.store_int_partial(&mut hits.primitive[at..], found.primitive);
            lanes.store_int_partial(&mut hits.instance[at..], found.instance);
            use lobe_lane::Mask;
            let occluded = tracer.occluded_packet(lanes, class, packet, live);
            assert_eq!(occluded.bits(), found.mask.bits());
            at += L::LANES;
        }
    }
}

fn check_packet_call(lanes: impl Tracing) {
    for case in CASES.iter() {
        for class in [RayClass::Camera, RayClass::Diffuse] {
            let mut found = HitSoA::new(case.rays.len());
            lanes.run(ByPacket(&case.eight, class, &case.rays, &mut found));
            let name = format!("{} {} packet call", case.name, lanes.name());
            same_bits(&case.eight, &case.rays, &found, &intersect(lanes, &case.eight, &case.rays, Form::Single), &name);
        }
    }
}

/// One named test per form and backend. A backend that the CPU lacks is reported as skipped.
macro_rules! on {
    ($($name:ident: $lanes:expr;)*) => {$(
        mod $name {
            use super::*;

            fn check(form: Form) {
                match $lanes {
                    Some(lanes) => check_form(lanes, form),
                    None => println!("SKIP: {} is not on this CPU", module_path!()),
                }
            }

            #[test]
            fn packet() {
                check(Form::Packet);
            }
            #[test]
            fn hybrid() {
                check(Form::Hybrid);
            }
            #[test]
            fn large() {
                check(Form::Large);
            }
            #[test]
            fn single() {
                check(Form::Single);
            }
            #[test]
            fn packet_call() {
                match $lanes {
                    Some(lanes) => check_packet_call(lanes),
                    None => println!("SKIP: {} is not on this CPU", module_path!()),
                }
            }
        }
    )*};
}

on! {
    emulated4: Some(On(Scalar::<4>));
    emulated8: Some(On(Scalar::<8>));
    emulated16: Some(On(Scalar::<16>));
}

/// Both forms of every backend.
mod on {
    macro_rules! on_backends {
        ($($backend:ident $name:literal;)*) => {$(
            #[allow(non_snake_case, reason = "the names of the backends")]
            mod $backend {
                use super::super::*;

                on! {
                    strict: Backend::named($name).ok().map(Backend::strict);
                    fused: Backend::named($name).ok().filter(Backend::has_fused_form).map(Backend::fused);
                }
            }
        )*};
    }

    lobe_backend::each_backend! { on_backends }
}

#[test]
fn four_children_scalar() {
    check_four(On(Scalar::<1>));
}

/// More lanes than children.
#[test]
fn four_children_emulated8() {
    check_four(On(Scalar::<8>));
}

#[cfg(target_arch = "x86_64")]
#[test]
fn four_children_sse2() {
    check_four(On(lobe_sse::Sse2::new()));
}

#[cfg(feature = "rayon")]
#[test]
fn hits_do_not_depend_on_threads() {
    let case = &CASES[1];
    let rays = rays::joined(&vec![case.rays.clone(); 5]);
    let mut hits = HitSoA::new(rays.len());
    lobe_trace::intersect(Backend::best().strict(), &case.eight, RayClass::Mirror, rays.view(), hits.view());
    let n = case.rays.len();
    for run in 0..5 {
        assert_eq!(hits.primitive[run * n..][..n], case.hits.primitive);
        assert_eq!(hits.t[run * n..][..n], case.hits.t);
    }
    let mut out = vec![false; rays.len()];
    lobe_trace::occluded(Backend::best().strict(), &case.eight, RayClass::Shadow, rays.view(), &mut out);
    assert!(out.iter().zip(&hits.primitive).all(|(&hit, &primitive)| hit == (primitive != MISS)));
}
