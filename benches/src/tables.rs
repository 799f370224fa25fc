//! Tables to measure on, of the paper's sizes and larger.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use lobe::{Channels, Samples, Scatter};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

/// A table of random positive values with knots that are finer near 0, as near a mirror peak; the poles agree.
///
/// Speed does not depend on the values, so the sizes of real tables are all that counts here.
pub fn random(nodes: [usize; 4], channels: Channels) -> Samples {
    let mut rng = Pcg32::seed_from_u64(7);
    let graded = |n: usize, end: f64, power: f64| -> Vec<f64> {
        (0..n).map(|i| if n == 1 { 0.0 } else { end * (i as f64 / (n - 1) as f64).powf(power) }).collect()
    };
    let knots = [
        graded(nodes[0], FRAC_PI_2, 1.2),
        graded(nodes[1], TAU, 1.1),
        graded(nodes[2], PI, 2.0),
        graded(nodes[3], TAU, 1.1),
    ];
    let count = channels.count() * nodes.iter().product::<usize>();
    let values = (0..count).map(|_| rng.random_range(0.01..1.0)).collect();
    Samples::new(Scatter::Reflection, knots, channels, values).expect("a valid random table")
}

/// The paper's isotropic table: 7 x 8 x 13, RGB.
pub fn isotropic() -> Samples {
    random([7, 1, 8, 13], Channels::Rgb)
}

/// The paper's anisotropic table: 17 x 7 x 17 x 13, RGB.
pub fn anisotropic() -> Samples {
    random([17, 7, 17, 13], Channels::Rgb)
}
