//! A room with a torus knot, a material ball and a sphere, for this renderer and as a task for another.

use std::f32::consts::{PI, TAU};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::Context;
use lobe::{Backend, Given, Options};
use lobe_mesh::{Geometry, Group, Parts, generate, ply, shapes};
use lobe_render::integrator::Path as PathTracing;
use lobe_render::light::{Environment, Light};
use lobe_render::shader::{self, Lambert, Shader};
use lobe_render::{Camera, Filter, Rect, Settings, Shape, World, WorldBuilder};
use serde_json::{Value, json};

/// The material of a surface.
#[derive(Clone, Debug)]
pub enum Surface {
    /// Reflects this share equally in all directions.
    Diffuse([f32; 3]),
    /// A file of the EPFL database.
    Measured(PathBuf),
}

/// A mesh of one surface.
struct Part {
    name: &'static str,
    mesh: Geometry,
    /// The index of the surface; `None` for one that emits and does not reflect.
    surface: Option<usize>,
}

/// The room and the materials of its surfaces.
pub struct Room {
    parts: Vec<Part>,
    surfaces: Vec<Surface>,
}

/// Number of surfaces of a room.
pub const SURFACES: usize = 6;
/// The radiance of the panel under the ceiling.
const RADIANCE: [f32; 3] = [17.0, 16.0, 14.0];
/// The largest number of surfaces that a path may hit.
const DEPTH: u32 = 5;
/// Width and height of the sky.
const SKY: [usize; 2] = [128, 64];

const CAMERA: Camera = Camera {
    position: [0.0, 1.9, 7.6],
    target: [0.0, 1.62, 0.0],
    up: [0.0, 1.0, 0.0],
    field_of_view: 0.56,
    lens_radius: 0.0,
    focus_distance: None,
};

impl Room {
    /// A room with materials for knot, ball, its ring, sphere, walls and floor.
    pub fn new(surfaces: [Surface; SURFACES]) -> Self {
        let mut parts = Vec::new();
        let mut add = |name, mesh, surface| parts.push(Part { name, mesh, surface });
        let knot = shapes::torus_knot(2, 3, 0.19, 1000, 35);
        add("knot", placed(&knot, 0.62, [-1.25, 1.15, -0.6]), Some(0));
        let ball = generate::ball();
        for (name, surface) in [("ball", 1), ("ring", 2), ("pedestal", 2)] {
            add(name, placed(&group(&ball, name), 0.8, [1.05, 0.0, -0.2]), Some(surface));
        }
        add("sphere", placed(&shapes::sphere(0.42, 48), 1.0, [-0.45, 0.42, 1.2]), Some(3));
        let walls = [
            rectangle([-2.6, 0.0, -2.4], [5.2, 0.0, 0.0], [0.0, 3.6, 0.0]),
            rectangle([-2.6, 0.0, 2.4], [0.0, 0.0, -4.8], [0.0, 3.6, 0.0]),
            rectangle([2.6, 0.0, -2.4], [0.0, 0.0, 4.8], [0.0, 3.6, 0.0]),
            rectangle([-2.6, 3.6, -2.4], [5.2, 0.0, 0.0], [0.0, 0.0, 4.8]),
        ];
        for (name, wall) in ["back", "left", "right", "ceiling"].into_iter().zip(walls) {
            add(name, wall, Some(4));
        }
        add("floor", rectangle([-2.6, 0.0, 2.4], [5.2, 0.0, 0.0], [0.0, 0.0, -4.8]), Some(5));
        add("panel", rectangle([-0.8, 3.55, -0.6], [1.6, 0.0, 0.0], [0.0, 0.0, 1.2]), None);
        Room { parts, surfaces: surfaces.into() }
    }

    /// The room for this renderer, with measured materials indexed by one of the directions.
    ///
    /// # Errors
    /// If a file cannot be read.
    pub fn world(&self, indexed_by: Given, backend: Backend) -> anyhow::Result<World> {
        let mut world = WorldBuilder::new();
        for surface in &self.surfaces {
            let shader: Arc<dyn Shader> = match surface {
                Surface::Diffuse(albedo) => Arc::new(Lambert::new(*albedo, backend)),
                Surface::Measured(file) => shader::open(file, &Options { indexed_by, ..Options::default() }, backend)?,
            };
            world.material(shader);
        }
        let black = world.material(Arc::new(Lambert::new([0.0; 3], backend)));
        for part in &self.parts {
            let radiance = part.surface.is_none().then_some(RADIANCE);
            world.shape(&shape(&part.mesh), part.surface.unwrap_or(black), radiance, false)?;
        }
        // Both renderers interpolate between texels, but place the rows differently.
        let texels = sky(|row, rows| (row as f32 + 0.5) / rows as f32, 0.5);
        world.light(Light::Environment(Environment::image(SKY[0], SKY[1], texels, 0.0)?));
        Ok(world.build()?)
    }

    /// The room for Mitsuba: files in a directory, and a description that refers to them.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn task(&self, directory: &Path, size: [u32; 2], samples: u32) -> anyhow::Result<Value> {
        std::fs::create_dir_all(directory).with_context(|| format!("cannot create {}", directory.display()))?;
        let black = json!({ "type": "diffuse", "reflectance": { "type": "rgb", "value": 0.0 } });
        let mut surfaces = Vec::new();
        for surface in &self.surfaces {
            let front = match surface {
                Surface::Diffuse(rgb) => json!({ "type": "diffuse", "reflectance": { "type": "rgb", "value": rgb } }),
                Surface::Measured(file) => json!({ "type": "measured", "filename": file.canonicalize()? }),
            };
            surfaces.push(json!({ "type": "twosided", "front": front }));
        }
        surfaces.push(json!({ "type": "twosided", "front": black }));
        let mut meshes = Vec::new();
        for part in &self.parts {
            let file = directory.join(part.name).with_extension("ply");
            ply::write(&file, &plain(&part.mesh))?;
            let radiance = part.surface.is_none().then_some(RADIANCE);
            meshes.push(json!({
                "filename": file,
                "surface": part.surface.unwrap_or(self.surfaces.len()),
                "radiance": radiance,
            }));
        }
        let texels = sky(|row, rows| row as f32 / (rows - 1) as f32, 0.0);
        let file = directory.join("sky.f32");
        std::fs::write(&file, texels.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>())?;
        let Camera { position, target, up, field_of_view, .. } = CAMERA;
        Ok(json!({
            "surfaces": surfaces,
            "meshes": meshes,
            "sky": { "file": file, "columns": SKY[0], "rows": SKY[1] },
            "camera": { "position": position, "target": target, "up": up, "degrees": field_of_view.to_degrees() },
            "size": size,
            "samples": samples,
            // It counts the segments of a path, including the one from the camera, and starts Russian roulette where
            // this renderer does.
            "max_depth": DEPTH + 1,
            "rr_depth": 4,
        }))
    }

    /// Triangles of all parts.
    pub fn triangles(&self) -> usize {
        self.parts.iter().map(|part| part.mesh.triangles.len()).sum()
    }
}

/// The settings of this renderer for the picture.
pub fn settings(size: [u32; 2], samples: std::ops::Range<u32>, backend: Backend, threads: usize) -> Settings {
    Settings {
        camera: CAMERA,
        size,
        window: whole(size),
        filter: Filter::Box,
        integrator: Arc::new(PathTracing { depth: DEPTH, limit: f32::INFINITY }),
        samples,
        backend,
        threads,
        time: None,
    }
}

/// All pixels of a picture.
pub fn whole([width, height]: [u32; 2]) -> Rect {
    Rect { x: 0, y: 0, width, height }
}

/// A smooth sky with a wide glow that shines into the room. The position of a row is a fraction of the height; `turn`
/// is the direction of the middle of the picture, in turns from -z.
fn sky(height: impl Fn(usize, usize) -> f32, turn: f32) -> Vec<[f32; 3]> {
    let [columns, rows] = SKY;
    let glow = [-0.41, 0.52, 0.75];
    let texel = |at: usize| {
        let (sin, cos) = (PI * height(at / columns, rows)).sin_cos();
        let (across, along) = (TAU * (((at % columns) as f32 + 0.5) / columns as f32 - turn)).sin_cos();
        let direction = [sin * across, cos, -sin * along];
        let toward: f32 = (0..3).map(|k| glow[k] * direction[k]).sum();
        let bright = (9.0 * (toward - 1.0)).exp();
        let blue = 0.6 + 0.4 * cos;
        [0.30 * blue + 5.0 * bright, 0.38 * blue + 4.5 * bright, 0.55 * blue + 3.6 * bright]
    };
    (0..columns * rows).map(texel).collect()
}

/// One group of a mesh.
fn group(mesh: &Geometry, name: &str) -> Geometry {
    let of = mesh.groups.iter().find(|group| group.name == name).expect("a group of the ball");
    let range = of.triangles.start as usize..of.triangles.end as usize;
    let parts = Parts { triangles: mesh.triangles[range].to_vec(), groups: Vec::<Group>::new(), ..(**mesh).clone() };
    Geometry::new(parts).expect("part of a good mesh")
}

/// The mesh scaled and moved.
fn placed(mesh: &Geometry, scale: f32, to: [f32; 3]) -> Geometry {
    let mut parts = mesh.clone().complete().into_parts();
    parts.positions.iter_mut().for_each(|p| *p = [0, 1, 2].map(|k| scale * p[k] + to[k]));
    Geometry::new(parts).expect("a good mesh, moved")
}

/// A rectangle that faces the side from which its first edge turns counterclockwise to its second.
fn rectangle(corner: [f32; 3], u: [f32; 3], v: [f32; 3]) -> Geometry {
    let at = |a: f32, b: f32| [0, 1, 2].map(|k| corner[k] + a * u[k] + b * v[k]);
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let unit = |a: [f32; 3]| a.map(|x| x / a.iter().map(|x| x * x).sum::<f32>().sqrt());
    let [x, y, z] = unit(u);
    Geometry::new(Parts {
        positions: vec![at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)],
        normals: Some(vec![unit(cross); 4]),
        tangents: Some(vec![[x, y, z, 1.0]; 4]),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Parts::default()
    })
    .expect("a good rectangle")
}

/// A mesh for the renderer.
fn shape(mesh: &Geometry) -> Shape {
    Shape {
        positions: mesh.positions.clone(),
        normals: mesh.normals.clone().unwrap_or_default(),
        tangents: mesh.tangents.clone().unwrap_or_default(),
        triangles: mesh.triangles.clone(),
    }
}

/// A mesh for others: positions and normals.
fn plain(mesh: &Geometry) -> Geometry {
    let parts = Parts { uvs: None, tangents: None, ..(**mesh).clone() };
    Geometry::new(parts).expect("part of a good mesh")
}
