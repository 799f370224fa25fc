//! The materials that are sampled: fixtures, noise, and the measured files outside the project.

use std::f64::consts::{PI, TAU};
use std::path::PathBuf;
use std::sync::{Arc, LazyLock};

use lobe::{Channels, Material, Options, Sampler, SamplerOptions, Scatter, specular};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;
use rayon::prelude::*;

pub fn fixture(name: &str) -> Material {
    Material::open(lobe_testing::files::fixture(name)).unwrap()
}

pub fn of_samples(samples: specular::Data) -> Material {
    Material::from_samples(samples, &Options::default()).unwrap()
}

pub fn sampler(material: Material) -> Sampler {
    Sampler::new(Arc::new(material), &SamplerOptions::default()).unwrap()
}

/// A table of noise on uneven knots.
fn noise(seed: u64, [sigma, psi, theta, phi]: [usize; 4], channels: Channels, scatter: Scatter) -> specular::Data {
    let mut rng = Pcg32::seed_from_u64(seed);
    let mut knots = |count: usize, last: f64| {
        let mut at: Vec<f64> = vec![0.0];
        for _ in 1..count {
            at.push(at[at.len() - 1] + rng.random_range(0.3..1.0));
        }
        let all = at[count - 1].max(1e-9);
        at.iter().map(|x| x / all * last).collect::<Vec<f64>>()
    };
    let knots = [knots(sigma, 1.5), knots(psi, TAU), knots(theta, PI), knots(phi, TAU)];
    let count = sigma * psi * theta * phi * channels.count();
    // A few values are negative, as in measurements, and a few are large.
    let values = (0..count).map(|_| rng.random_range(-0.1f32..1.3).powi(3)).collect();
    specular::Data::new(scatter, knots, channels, values).unwrap()
}

/// A sampler under the name of its material.
pub struct Named {
    pub name: String,
    pub sampler: Sampler,
    /// `true` for a measured file outside the project.
    pub is_shared: bool,
}

/// Samplers of [every kind of table](made) and of the [shared] files, made once for all tests, because making them
/// takes longer than most tests.
pub fn samplers() -> &'static [Named] {
    static SAMPLERS: LazyLock<Vec<Named>> = LazyLock::new(|| {
        let made = made().into_iter().map(|(name, material)| (name, material, false));
        let all: Vec<_> = made.chain(shared().into_iter().map(|(name, material)| (name, material, true))).collect();
        let named = |(name, material, is_shared)| Named { name, sampler: sampler(material), is_shared };
        all.into_par_iter().map(named).collect()
    });
    &SAMPLERS
}

/// Every kind of table.
fn made() -> Vec<(String, Material)> {
    let spectral = Channels::Spectral(vec![450.0, 500.0, 550.0, 600.0]);
    let bent = noise(5, [5, 1, 8, 7], Channels::Mono, Scatter::Transmission);
    let offsets = bent.knots()[0].iter().map(|sigma| (sigma.sin() / 1.5).asin() - sigma).collect();
    let tables = [
        ("isotropic noise", noise(1, [6, 1, 9, 8], Channels::Rgb, Scatter::Reflection)),
        ("anisotropic noise", noise(2, [5, 4, 7, 9], Channels::Xyz, Scatter::Reflection)),
        ("transmission", noise(3, [5, 3, 8, 7], spectral, Scatter::Transmission)),
        ("refraction", bent.with_refraction(offsets).unwrap()),
    ];
    let mut made: Vec<_> = tables.into_iter().map(|(name, samples)| (name.into(), of_samples(samples))).collect();
    for name in ["conductor-7x8x13.ddr", "cloth-17x7x17x13.ddr"] {
        made.push((name.into(), fixture(name)));
    }
    made
}

/// The measured files and golden inputs outside the project that can be opened as materials.
fn shared() -> Vec<(String, Material)> {
    let Some(root) = lobe_testing::files::shared() else { return Vec::new() };
    let folders = lobe_testing::files::files(&root.join("data")).into_iter().filter(|path| path.is_dir());
    let open = |path: PathBuf| {
        let name = path.file_name()?.to_string_lossy().into_owned();
        Material::open(path).ok().map(|material| (name, material))
    };
    let files = folders.chain([root.join("golden")]).flat_map(|folder| lobe_testing::files::files(&folder));
    let files: Vec<PathBuf> = files.filter(|path| path.is_file()).collect();
    files.into_par_iter().filter_map(open).collect()
}
