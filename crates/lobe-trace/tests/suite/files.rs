//! Scanned and modelled meshes, where they are at hand.

use std::path::PathBuf;

use lobe_scalar::Scalar;
use lobe_trace::{Form, Mesh, Scene};
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, Property};

use crate::backends::intersect;
use crate::{rays, reference};

/// The folder of meshes, if there is one.
fn folder() -> Option<PathBuf> {
    let root = std::env::var_os("LOBE_SHARED")
        .map_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared")), PathBuf::from);
    let folder = root.join("data/geometry");
    folder.is_dir().then_some(folder)
}

fn read_obj(path: &PathBuf) -> Mesh {
    let options = tobj::LoadOptions { triangulate: true, ..Default::default() };
    let (models, _) = tobj::load_obj(path, &options).unwrap();
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for model in models {
        let base = positions.len() as u32;
        positions.extend(model.mesh.positions.as_chunks::<3>().0);
        triangles.extend(model.mesh.indices.as_chunks::<3>().0.iter().map(|corners| corners.map(|i| i + base)));
    }
    Mesh::new(positions, triangles).unwrap()
}

fn read_ply(path: &PathBuf) -> Mesh {
    let mut file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let ply = Parser::<DefaultElement>::new().read_ply(&mut file).unwrap();
    let float = |vertex: &DefaultElement, name: &str| match vertex[name] {
        Property::Float(x) => x,
        Property::Double(x) => x as f32,
        ref other => panic!("{name} is {other:?}"),
    };
    let corners = |face: &DefaultElement| -> Vec<u32> {
        match face.values().next().unwrap() {
            Property::ListInt(list) => list.iter().map(|&i| i as u32).collect(),
            Property::ListUInt(list) => list.clone(),
            other => panic!("a face of {other:?}"),
        }
    };
    let positions = ply.payload["vertex"].iter().map(|v| [float(v, "x"), float(v, "y"), float(v, "z")]).collect();
    let fan = |face: &DefaultElement| {
        let corners = corners(face);
        (2..corners.len()).map(move |i| [corners[0], corners[i - 1], corners[i]]).collect::<Vec<_>>()
    };
    Mesh::new(positions, ply.payload["face"].iter().flat_map(fan).collect()).unwrap()
}

fn check(name: &str, pixels: usize) {
    let Some(path) = folder().map(|folder| folder.join(name)).filter(|path| path.is_file()) else {
        println!("SKIP: {name} is not there");
        return;
    };
    let mesh = if name.ends_with(".ply") { read_ply(&path) } else { read_obj(&path) };
    let triangles = mesh.triangles().len();
    let scene: Scene = Scene::of_mesh(mesh);
    let rays = rays::joined(&[rays::camera(scene.bounds(), pixels), rays::mixed(scene.bounds(), 400, 9)]);
    let truth = intersect(Scalar::<1>, &scene, &rays, Form::Single);
    let hits = reference::check(&scene, &rays, &truth, name);
    println!("{name}: {triangles} triangles, {hits} of {} rays hit", rays.len());
    assert!(hits > rays.len() / 20);
    for form in Form::ALL {
        assert_eq!(intersect(Scalar::<1>, &scene, &rays, form), truth, "{name} {form:?}");
    }
}

#[test]
fn teapot_ply() {
    check("teapot.ply", 24);
}
#[test]
fn ellipse_ply() {
    check("luxcore_ellipse.ply", 24);
}
#[test]
fn luxball_ply() {
    check("luxball-cloth.ply", 24);
}
#[test]
fn bunny_obj() {
    check("bunny.obj", 24);
}
#[test]
fn cloth_robe_obj() {
    check("cloth_robe.obj", 24);
}
#[test]
fn dragon_obj() {
    check("dragon.obj", 16);
}
#[test]
fn spot_obj() {
    check("spot.obj", 16);
}
