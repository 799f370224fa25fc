//! The meshes of the project's own scenes, and scanned and modelled ones if they are available.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use lobe_backend::Backend;
use lobe_testing::emulation::draws;
use lobe_testing::files::{fixture, shared_file};
use lobe_trace::{Form, Mesh, Scene};

use crate::backends::intersect;
use crate::{rays, reference};

/// The number of random rays through all meshes together, from the variable `LOBE_RAYS`. A million takes minutes.
fn ray_count() -> usize {
    std::env::var("LOBE_RAYS").map_or_else(|_| draws(20_000), |count| count.parse().expect("LOBE_RAYS is a number"))
}

/// Every mesh of a folder.
fn meshes(folder: &Path) -> Vec<PathBuf> {
    let is_mesh = |path: &PathBuf| path.extension().is_some_and(|end| end == "ply" || end == "obj");
    let entries = std::fs::read_dir(folder).expect("a folder of meshes");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).filter(is_mesh).collect();
    paths.sort();
    paths
}

/// Rays from a camera and random ones: every form agrees with double precision.
fn check(path: &Path, count: usize) {
    let name = path.file_name().expect("a file").to_string_lossy();
    let parts = lobe_mesh::read(path).unwrap_or_else(|error| panic!("{error}")).into_parts();
    let mesh = Mesh::new(parts.positions, parts.triangles).expect("a mesh");
    let triangles = mesh.triangles().len();
    let scene: Scene = Scene::of_mesh(mesh);
    let rays = rays::joined(&[rays::camera(scene.bounds(), 16), rays::mixed(scene.bounds(), count, 9)]);
    let truth = intersect(Backend::scalar(), &scene, &rays, Form::Single);
    let hits = reference::check(&scene, &rays, &truth, &name);
    println!("{name}: {triangles} triangles, {hits} of {} rays hit", rays.len());
    assert!(hits > rays.len() / 20, "{name}: {hits} of {}", rays.len());
    for form in Form::ALL {
        assert_eq!(intersect(Backend::scalar(), &scene, &rays, form), truth, "{name} {form:?}");
    }
}

#[test]
fn random_rays_agree_with_double_precision_in_every_mesh() {
    let mut paths = meshes(&fixture("scenes"));
    assert!(!paths.is_empty(), "the project has meshes");
    if let Some(folder) = shared_file("data/geometry") {
        paths.extend(meshes(&folder));
    }
    let (next, count) = (AtomicUsize::new(0), ray_count().div_ceil(paths.len()));
    let work = || {
        while let Some(path) = paths.get(next.fetch_add(1, Ordering::Relaxed)) {
            check(path, count);
        }
    };
    std::thread::scope(|scope| {
        // WebAssembly cannot start threads, and has one processor.
        for _ in 1..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
        work();
    });
}
