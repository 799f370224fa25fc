//! Tables for measurements, of the paper's sizes and larger.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use lobe::table::rgl::{self, Images, Parts};
use lobe::table::utia::{self, PLANE};
use lobe::table::window::klems::{AngleBasis, KlemsMatrix};
use lobe::table::window::tensor_tree::{Node, Rank, TensorTree};
use lobe::table::window::{self, Block, Component};
use lobe::table::{half_diff, mueller, polarised, scattered, spherical};
use lobe::{Channels, Scatter, specular};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

/// A table of random positive values with knots that are closer together near 0, as near a mirror peak; values at poles
/// agree.
///
/// Speed does not depend on the values, so only the sizes of real tables matter here.
pub fn random(nodes: [usize; 4], channels: Channels) -> specular::Data {
    let mut rng = Pcg32::seed_from_u64(7);
    let count = channels.count() * nodes.iter().product::<usize>();
    let values = (0..count).map(|_| rng.random_range(0.01..1.0)).collect();
    specular::Data::new(Scatter::Reflection, knots(nodes), channels, values).expect("a valid random table")
}

/// Knots over all of each axis, closer together near 0.
fn knots(nodes: [usize; 4]) -> [Vec<f64>; 4] {
    [graded(nodes[0], FRAC_PI_2, 1.2), graded(nodes[1], TAU, 1.1), theta_knots(nodes[2]), graded(nodes[3], TAU, 1.1)]
}

/// This many knots of the angle from the mirror direction, in radians.
pub fn theta_knots(count: usize) -> Vec<f64> {
    graded(count, PI, 2.0)
}

fn graded(count: usize, end: f64, power: f64) -> Vec<f64> {
    (0..count).map(|i| if count == 1 { 0.0 } else { end * (i as f64 / (count - 1) as f64).powf(power) }).collect()
}

/// An RGB table of smooth values, so that a small error in an angle remains a small error in the value even if cells
/// are narrow.
pub fn smooth(nodes: [usize; 4]) -> specular::Data {
    let knots = knots(nodes);
    let mut values = Vec::with_capacity(3 * nodes.iter().product::<usize>());
    let waves = knots.each_ref().map(|knots| knots.iter().map(|angle| angle.sin_cos()).collect::<Vec<_>>());
    for (sin_sigma, _) in &waves[0] {
        for (_, cos_psi) in &waves[1] {
            for (sin_theta, cos_theta) in &waves[2] {
                for (sin_phi, cos_phi) in &waves[3] {
                    // Independent of psi at the normal and of phi at the poles of theta, where these angles have no
                    // meaning.
                    let base = 1.0 + 0.3 * sin_sigma * cos_psi + 0.4 * cos_theta;
                    let around = 0.2 * sin_theta;
                    values.extend([base, base + around * cos_phi, base + around * sin_phi].map(|x| x as f32));
                }
            }
        }
    }
    specular::Data::new(Scatter::Reflection, knots, Channels::Rgb, values).expect("a valid smooth table")
}

/// The paper's isotropic table: 7 x 8 x 13, RGB.
pub fn isotropic() -> specular::Data {
    random([7, 1, 8, 13], Channels::Rgb)
}

/// The paper's anisotropic table: 17 x 7 x 17 x 13, RGB.
pub fn anisotropic() -> specular::Data {
    random([17, 7, 17, 13], Channels::Rgb)
}

/// An isotropic table larger than the second cache: 90 x 90 x 180, RGB, 17 MB.
pub fn large() -> specular::Data {
    smooth([90, 1, 90, 180])
}

/// An anisotropic table larger than the third cache: 16 x 36 x 90 x 108, RGB, 67 MB.
pub fn large_anisotropic() -> specular::Data {
    smooth([16, 36, 90, 108])
}

/// A material with smooth values, of the size of the RGB files of the EPFL database.
pub fn rgl() -> rgl::Data {
    smooth_rgl(vec![0.0], 8, [128, 32], Channels::Rgb, true)
}

/// A smaller one that is anisotropic and spectral, without the microfacet factor.
pub fn rgl_anisotropic() -> rgl::Data {
    let phi_i = (0..6).map(|i| std::f32::consts::PI * (0.4 * i as f32 - 1.0)).collect();
    let nanometres = (0..11).map(|i| 400.0 + 30.0 * f64::from(i)).collect();
    smooth_rgl(phi_i, 4, [24, 12], Channels::Spectral(nanometres), false)
}

fn smooth_rgl(
    phi_i: Vec<f32>,
    zeniths: usize,
    [fine, coarse]: [usize; 2],
    channels: Channels,
    jacobian: bool,
) -> rgl::Data {
    let slices = phi_i.len() * zeniths;
    rgl::Data::new(Parts {
        description: "waves".into(),
        phi_i,
        theta_i: (0..zeniths).map(|i| 1.4 * i as f32 / (zeniths - 1) as f32).collect(),
        ndf: waves("ndf", [1, 2, fine], 0.1),
        sigma: waves("sigma", [1, 2, fine], 0.3),
        vndf: waves("vndf", [slices, fine, fine], 0.1),
        luminance: waves("luminance", [slices, coarse, coarse], 0.1),
        spectra: waves("spectra", [channels.count() * slices, coarse, coarse], 0.1),
        channels,
        jacobian,
        valid: None,
    })
    .expect("a valid material")
}

/// Images of values from `low` up, with equal ends along the azimuth.
fn waves(part: &'static str, [slices, height, width]: [usize; 3], low: f32) -> Images {
    let mut texels = Vec::with_capacity(slices * height * width);
    for slice in 0..slices {
        for row in 0..height {
            let around = (std::f32::consts::TAU * row as f32 / (height - 1) as f32).cos();
            for column in 0..width {
                let x = column as f32 / (width - 1) as f32;
                texels.push(low + 0.4 * (2.0 + around * x + (3.0 * x + 0.3 * slice as f32).sin()));
            }
        }
    }
    Images::new(part, [slices, height, width], texels).expect("valid images")
}

/// A number in `(0, 1]` for each index, different for neighbouring indices.
fn value(index: usize) -> f32 {
    // In this order, products fit in 32 bits.
    (1 + index % 10_007 * 7919 % 10_007) as f32 / 10_007.0
}

/// A grid with this many bins; grids of the MERL database have `[90, 90, 180]`.
pub fn half_difference(bins: [usize; 3]) -> half_diff::Data {
    half_diff::Data::new(bins, (0..3 * bins.iter().product::<usize>()).map(value).collect()).expect("a valid grid")
}

/// Half of an isotropic grid of spherical coordinates, of the size of the measured paints of the MDL library.
pub fn spherical() -> spherical::Data {
    let steps = |count: usize, limit: f64| (0..count).map(|i| limit * i as f64 / (count - 1) as f64).collect();
    let knots: [Vec<f64>; 4] = [steps(45, 1.55), vec![0.0], steps(45, 1.55), steps(90, PI)];
    let count = 3 * knots.iter().map(Vec::len).product::<usize>();
    let values = (0..count).map(value).collect();
    let grid = spherical::Data::new(Scatter::Reflection, knots, Channels::Rgb, values);
    grid.and_then(spherical::Data::mirrored).expect("a valid grid")
}

/// An anisotropic grid of spherical coordinates.
pub fn spherical_anisotropic() -> spherical::Data {
    let polar = vec![0.0, 0.2, 0.5, 0.9, 1.2, 1.4];
    let around = |count: usize| (0..count).map(|i| TAU * i as f64 / count as f64).collect();
    let knots: [Vec<f64>; 4] = [polar.clone(), around(8), polar, around(24)];
    let values = (0..knots.iter().map(Vec::len).product::<usize>()).map(value).collect();
    spherical::Data::new(Scatter::Reflection, knots, Channels::Mono, values).expect("a valid grid")
}

/// Scattered samples of an isotropic material: rings about the peak, closer to each other near it, for each of nine
/// directions of light.
pub fn scattered() -> scattered::Data {
    let mut angles = Vec::new();
    for light in 0..9 {
        let theta = 0.17 * f64::from(light);
        for (ring, sector) in (0..16).flat_map(|ring| (0..24).map(move |sector| (ring, sector))) {
            let from_peak = 1.5 * (f64::from(ring) / 16.0).powf(1.5);
            let (sin, cos) = ((f64::from(sector) + 0.5 * f64::from(ring % 2)) / 24.0 * TAU).sin_cos();
            let (x, y) = (theta + from_peak * cos, from_peak * sin);
            if x.hypot(y) < FRAC_PI_2 {
                angles.push([theta, 0.0, x.hypot(y), PI + y.atan2(x)]);
            }
        }
    }
    let values: Vec<f32> = (0..3 * angles.len()).map(value).collect();
    scattered::Data::new(Scatter::Reflection, Channels::Rgb, &angles, &values).expect("valid samples")
}

/// A grid of the UTIA database.
pub fn utia() -> utia::Data {
    utia::Data::new((0..3 * PLANE).map(|index| f64::from(value(index))).collect()).expect("a valid grid")
}

/// Mueller matrices of the sizes of the small files of the KAIST database, over five wavelengths.
pub fn mueller() -> mueller::Data {
    mueller_over(5)
}

/// The same over four wavelengths, as many as a path in Mitsuba has.
pub fn matrices() -> mueller::Data {
    mueller_over(4)
}

fn mueller_over(wavelengths: usize) -> mueller::Data {
    let graded =
        |n: usize, from: f32, to: f32| (0..n).map(|i| from + (to - from) * i as f32 / (n - 1) as f32).collect();
    let half_turn = std::f32::consts::PI;
    let knots: [Vec<f32>; 4] = [
        graded(22, -half_turn, half_turn),
        graded(9, 0.0, half_turn / 2.0),
        graded(9, 0.0, half_turn / 2.0),
        graded(wavelengths, 450.0, 650.0),
    ];
    let count = 16 * knots.iter().map(Vec::len).product::<usize>();
    mueller::Data::new(knots, (0..count).map(value).collect()).expect("valid matrices")
}

/// Mueller matrices of smooth values in specular coordinates: 7 x 8 x 13, over four wavelengths.
pub fn polarised() -> polarised::Data {
    let knots = knots([7, 1, 8, 13]);
    let nanometres = [450.0, 500.0, 550.0, 650.0];
    let mut values = Vec::new();
    for sigma in &knots[0] {
        for theta in &knots[2] {
            for phi in &knots[3] {
                for nm in nanometres {
                    for element in 0..16 {
                        let base = (f64::from(element) + sigma + 0.5 * theta.cos() + nm / 300.0).sin();
                        let wave = 0.3 * base + 0.15 * theta.sin() * (phi + f64::from(element)).cos();
                        values.push(if element == 0 { 0.5 + wave } else { 0.5 * wave } as f32);
                    }
                }
            }
        }
    }
    polarised::Data::new(knots, nanometres.to_vec(), values).expect("valid matrices")
}

/// A sheet with the full Klems basis on both sides.
pub fn klems() -> window::Blocks {
    let basis = AngleBasis::full();
    let values: Vec<f32> = (0..basis.patches().pow(2)).map(value).collect();
    window(|| Component::Klems(KlemsMatrix::new(basis.clone(), basis.clone(), values.clone()).expect("a valid matrix")))
}

/// A sheet of trees that are divided three to six times.
pub fn tensor_tree(rank: Rank) -> window::Blocks {
    let dimensions = rank.dimensions();
    let children = 1 << dimensions;
    let (mut nodes, mut count) = (vec![Node::Branch(1)], 0_usize);
    // The children of the root; every third is divided again.
    let divided = |child: usize| child.is_multiple_of(3);
    let mut next = 1 + children;
    for child in 0..children {
        if divided(child) {
            nodes.push(Node::Branch(next as u32));
            next += children;
        } else {
            nodes.push(Node::Leaf { first: count as u32, level: 2 });
            count += 1 << (2 * dimensions);
        }
    }
    for grandchild in 0..children * (0..children).filter(|&child| divided(child)).count() {
        let level = 1 + (grandchild % 2) as u32;
        nodes.push(Node::Leaf { first: count as u32, level });
        count += 1 << (level as usize * dimensions);
    }
    let values: Vec<f32> = (0..count).map(value).collect();
    window(|| Component::Tree(TensorTree::new(rank, nodes.clone(), values.clone()).expect("a valid tree")))
}

fn window(component: impl Fn() -> Component) -> window::Blocks {
    let mut window = window::Blocks::default();
    for block in Block::ALL {
        window.set(block, component());
    }
    window
}
