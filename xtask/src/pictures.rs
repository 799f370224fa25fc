//! The pictures of the documentation: the fixtures on spheres, every pixel one query of a batch.

use std::path::{Path, PathBuf};

use anyhow::Context;
use lobe::Brdf;

/// The command's options.
#[derive(clap::Args)]
pub struct Arguments {
    /// Folder for the pictures
    #[arg(long, default_value = "docs/pictures")]
    directory: PathBuf,
}

/// Pixels across one sphere.
const SIZE: usize = 360;
/// Queries a pixel and axis.
const SAMPLES: usize = 3;
/// Where light comes from, and how strong: a key light, and a weaker one from the other side.
const LIGHTS: [([f32; 3], f32); 2] = [([0.35, 0.6, 0.72], 2.6), ([-0.75, 0.1, 0.65], 0.7)];
const BACKGROUND: [f32; 3] = [0.93, 0.93, 0.91];

/// Writes `spheres.png`: the conductor, and the cloth with its warp across and along.
///
/// # Errors
/// Where a fixture cannot be read or the picture not written.
pub fn run(arguments: Arguments) -> anyhow::Result<()> {
    let conductor = Brdf::open("fixtures/conductor-7x8x13.ddr")?;
    let cloth = Brdf::open("fixtures/cloth-17x7x17x13.ddr")?;
    let spheres = [sphere(&conductor, 0.0, 0.55), sphere(&cloth, 0.0, 1.5), sphere(&cloth, 90.0, 1.5)];
    let width = spheres.len() * SIZE;
    let mut pixels = Vec::with_capacity(width * SIZE * 3);
    for row in 0..SIZE {
        for sphere in &spheres {
            pixels.extend(sphere[row * SIZE..][..SIZE].iter().flatten().map(|&linear| encode(linear)));
        }
    }
    std::fs::create_dir_all(&arguments.directory)?;
    let path = arguments.directory.join("spheres.png");
    write_png(&path, width, SIZE, &pixels).with_context(|| path.display().to_string())?;
    println!("{}", path.display());
    Ok(())
}

/// A sphere under the lights, linear RGB, rows from the top; the sample is turned by `turn` degrees.
fn sphere(brdf: &Brdf, turn: f32, exposure: f32) -> Vec<[f32; 3]> {
    let fine = SIZE * SAMPLES;
    let (mut wi, mut wo, mut at, mut weight) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut picture = vec![[0.0; 3]; SIZE * SIZE];
    let share = 1.0 / (SAMPLES * SAMPLES) as f32;
    for py in 0..fine {
        for px in 0..fine {
            let pixel = py / SAMPLES * SIZE + px / SAMPLES;
            // The sphere fills nine tenths of its square.
            let ndc = |p: usize| (2.0 * (p as f32 + 0.5) / fine as f32 - 1.0) / 0.9;
            let (x, y) = (ndc(px), -ndc(py));
            let inside = 1.0 - x * x - y * y;
            if inside <= 0.0 {
                picture[pixel] = std::array::from_fn(|k| picture[pixel][k] + share * BACKGROUND[k]);
                continue;
            }
            let normal = [x, y, inside.sqrt()];
            let along = normalize([normal[2], 0.0, -normal[0]]);
            let across = cross(normal, along);
            let (sin, cos) = turn.to_radians().sin_cos();
            let tangent: [f32; 3] = std::array::from_fn(|k| cos * along[k] + sin * across[k]);
            let bitangent = cross(normal, tangent);
            let local = |w: [f32; 3]| [dot(w, tangent), dot(w, bitangent), dot(w, normal)];
            for (light, power) in LIGHTS {
                let light = local(normalize(light));
                wi.push(light);
                wo.push(local([0.0, 0.0, 1.0]));
                at.push(pixel);
                weight.push(share * power * exposure * light[2].max(0.0));
            }
        }
    }
    let mut f = vec![0.0; 3 * wi.len()];
    brdf.eval_batch(wi.as_slice(), wo.as_slice(), &mut f);
    for ((texel, pixel), weight) in f.chunks_exact(3).zip(at).zip(weight) {
        picture[pixel] = std::array::from_fn(|k| picture[pixel][k] + weight * texel[k]);
    }
    picture
}

/// Linear light to an sRGB byte (IEC 61966-2-1).
fn encode(linear: f32) -> u8 {
    let x = linear.clamp(0.0, 1.0);
    let encoded = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    (255.0 * encoded).round() as u8
}

fn write_png(path: &Path, width: usize, height: usize, rgb: &[u8]) -> anyhow::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    let mut file = tempfile::NamedTempFile::new_in(folder)?;
    let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(rgb)?;
    file.persist(path)?;
    Ok(())
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn normalize(a: [f32; 3]) -> [f32; 3] {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}
