//! Rays through scenes compared with Embree in its fastest mode, and the building of trees.

use std::path::Path;
use std::rc::Rc;

use anyhow::Context;
use lobe::Backend;
use lobe_benches::contest::Contender;
use lobe_benches::tracing::{self, Parts, RaySet};
use lobe_trace::{Form, HitSoA, MISS, Mesh, Scene};

use super::comparison::Agreement;
use super::contest::{Contest, Outside};
use super::exchange::Exchange;
use super::referee::Referee;

/// The first word of the contests' names.
pub const PREFIX: &str = "trace";

/// Pixels per side of the picture with which all rays begin.
const PIXELS: usize = 512;

/// A scene with more triangles does not fit into the caches, and goals are lower.
const LARGE: usize = 200_000;

/// `t` and the index of the triangle. A ray that passes close to an edge may hit either of its two triangles, and a
/// peer may find neither; the [`Referee`] decides, and this library must always be right.
const HITS: Agreement = Agreement { relative: 1e-5, floor: 0.1, outliers: 0.0 };

/// All sets of rays in all scenes.
///
/// # Errors
/// If a mesh cannot be read, or a file cannot be written.
pub fn all(data: &Path, exchange: &Exchange) -> anyhow::Result<Vec<Contest>> {
    let mut scenes: Vec<(&'static str, Parts)> = vec![
        ("knot", tracing::knot(700, 50)),
        ("knot-fine", tracing::subdivided(tracing::subdivided(tracing::knot(640, 49)))),
    ];
    if let Some(statue) = statue(data)? {
        scenes.push(("statue-fine", tracing::subdivided(tracing::subdivided(statue.clone()))));
        scenes.insert(1, ("statue", statue));
    }
    let mut contests = Vec::new();
    for (name, parts) in scenes {
        contests.extend(Subject::new(name, tracing::in_room(parts), exchange)?.contests(exchange)?);
    }
    Ok(contests)
}

/// A scan, if the folder of meshes has it.
fn statue(data: &Path) -> anyhow::Result<Option<Parts>> {
    let path = statue_file(data);
    if !path.is_file() {
        return Ok(None);
    }
    let parts = lobe_mesh::read(&path).context("a mesh to be traced")?.into_parts();
    Ok(Some((parts.positions, parts.triangles)))
}

/// The path of the scan.
pub fn statue_file(data: &Path) -> std::path::PathBuf {
    data.join("geometry/lionstatue.obj")
}

/// A scene through which rays are traced.
struct Subject {
    name: &'static str,
    triangles: usize,
    mesh: Rc<Mesh>,
    scene: Rc<Scene>,
}

impl Subject {
    fn new(name: &'static str, mesh: Mesh, exchange: &Exchange) -> anyhow::Result<Self> {
        let corners: Vec<f32> = mesh.triangles().as_flattened().iter().map(|&vertex| vertex as f32).collect();
        exchange.floats(&format!("{name}-positions"), &[mesh.positions().as_flattened()])?;
        exchange.floats(&format!("{name}-triangles"), &[&corners])?;
        let scene = Scene::of_mesh(mesh.clone());
        Ok(Subject { name, triangles: mesh.triangles().len(), mesh: Rc::new(mesh), scene: Rc::new(scene) })
    }

    fn contests(&self, exchange: &Exchange) -> anyhow::Result<Vec<Contest>> {
        let best = Backend::best().fused();
        let large = self.triangles > LARGE;
        let mut contests = vec![self.build()];
        for set in tracing::sets(&self.scene, PIXELS) {
            let set = Rc::new(set);
            let rows: Vec<&[f32]> = set
                .rays
                .origin
                .iter()
                .chain(&set.rays.direction)
                .chain([&set.rays.t_min, &set.rays.t_max])
                .map(Vec::as_slice)
                .collect();
            exchange.floats(&format!("{}-{}", self.name, set.name), &rows)?;
            let goal = match (set.name, large) {
                ("camera", false) => 2.0,
                ("camera", true) => 1.5,
                ("shadow", false) => 1.9,
                ("shadow", true) => 1.3,
                ("mirror", false) => 1.5,
                ("mirror", true) => 1.2,
                (_, false) => 1.1,
                (_, true) => 0.9,
            };
            contests.push(self.rays(&set, best, "avx2.fast", goal));
            if set.name == "camera" {
                contests.push(self.rays(&set, best, "avx2.robust", 1.9));
                if let Ok(sse2) = Backend::named("sse2") {
                    contests.push(self.rays(&set, sse2, "sse2.fast", 1.4));
                    contests.push(self.lanes(&set, sse2)?);
                }
            }
        }
        Ok(contests)
    }

    /// A set of rays compared with Embree with this instruction set and kind of tree.
    fn rays(&self, set: &Rc<RaySet>, backend: Backend, tree: &str, goal: f64) -> Contest {
        let hits = if set.any { "any" } else { "nearest" };
        Contest {
            id: match tree {
                "avx2.fast" => "trace",
                "avx2.robust" => "trace-robust",
                _ => "trace-sse2",
            },
            on: self.on(set.name),
            unit: "ray",
            count: set.rays.len(),
            lobe: tracer("lobe", &self.scene, set, backend, None),
            inside: Vec::new(),
            outside: vec![Outside::new("Embree", "embree", format!("{}.{}.{hits}.{tree}", self.name, set.name))],
            agreement: Some(HITS),
            judge: Some(Box::new(Referee { mesh: self.mesh.clone(), set: set.clone(), agreement: HITS })),
            goal: Some(goal),
        }
    }

    /// Packets of four rays compared with the same code with one lane.
    fn lanes(&self, set: &Rc<RaySet>, sse2: Backend) -> anyhow::Result<Contest> {
        Ok(Contest {
            id: "trace-lanes",
            on: self.on(set.name),
            unit: "ray",
            count: set.rays.len(),
            lobe: tracer("lobe", &self.scene, set, sse2, Some(Form::Packet)),
            inside: vec![tracer("lobe, one lane", &self.scene, set, Backend::named("scalar")?, Some(Form::Packet))],
            outside: Vec::new(),
            agreement: Some(Agreement { relative: 0.0, ..HITS }),
            judge: None,
            goal: Some(2.8),
        })
    }

    /// Building trees; the box around everything must agree.
    fn build(&self) -> Contest {
        let mesh = self.mesh.clone();
        let run = move |out: &mut Option<Scene>| *out = Some(Scene::of_mesh(Mesh::clone(&mesh)));
        let values = |out: &Option<Scene>| {
            let bounds = out.as_ref().expect("a run").bounds();
            [bounds.lower, bounds.upper].concat()
        };
        Contest {
            id: "trace-build",
            on: self.name.to_owned(),
            unit: "triangle",
            count: self.triangles,
            lobe: Contender::new("lobe", Contender::UNCHECKED, None, run, values),
            inside: Vec::new(),
            outside: vec![Outside::new("Embree", "embree", format!("{}.build.avx2.fast", self.name))],
            agreement: Some(Agreement { relative: 1e-6, floor: 1.0, outliers: 0.0 }),
            judge: None,
            goal: Some(1.0 / 1.3),
        }
    }

    fn on(&self, set: &str) -> String {
        format!("{}, {} triangles, {set}", self.name, self.triangles)
    }
}

/// A backend that traces a set of rays, by the form of their class or by another.
fn tracer(name: &'static str, scene: &Rc<Scene>, set: &Rc<RaySet>, backend: Backend, form: Option<Form>) -> Contender {
    let (scene, set) = (scene.clone(), set.clone());
    let (count, form) = (set.rays.len(), form.unwrap_or(set.class.form()));
    if set.any {
        let run = move |out: &mut Vec<bool>| scene.occluded_by(backend, form, set.rays.view(), out);
        let values = |out: &Vec<bool>| out.iter().map(|&hit| f32::from(u8::from(hit))).collect();
        return Contender::new(name, Contender::UNCHECKED, vec![false; count], run, values);
    }
    let run = move |out: &mut HitSoA| scene.intersect_by(backend, form, set.rays.view(), out.view());
    Contender::new(name, Contender::UNCHECKED, HitSoA::new(count), run, values)
}

/// `t` of all rays, then the lower twelve bits and the other bits of the triangles' indices; -1 for a ray that hits
/// nothing. The halves are small enough that different ones are never equal within a tolerance.
fn values(hits: &HitSoA) -> Vec<f32> {
    let there = |(&found, &value): (&i32, &f32)| if found == MISS { -1.0 } else { value };
    let t = hits.primitive.iter().zip(&hits.t).map(there);
    let half = |part: fn(i32) -> i32| {
        hits.primitive.iter().map(move |&found| if found == MISS { -1.0 } else { part(found) as f32 })
    };
    t.chain(half(|number| number & 4095)).chain(half(|number| number >> 12)).collect()
}
