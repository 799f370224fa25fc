//! The difference between a written file and its source.

use std::f64::consts::{PI, TAU};
use std::fmt;

use lobe::{Aspect, Material};
use lobe_model::{Surface, halton};

use crate::progress::Progress;

/// The number of pairs of directions that are compared.
const PROBES: u32 = 4096;

/// Differences at the probes, relative to the value, or to a hundredth of the mean value if that is larger.
pub struct Errors {
    probes: usize,
    median: f64,
    most: f64,
    largest: f64,
    rms: f64,
}

impl Errors {
    /// Compares two surfaces with the same channels, in turn on the sides of each measurement. Half of the probes are
    /// spread over both hemispheres in proportion to their cosines, half are near the mirror or straight-through
    /// direction. None is within a degree of the horizon.
    pub fn between(expected: &dyn Surface, found: &Material, aspects: &[Aspect]) -> Self {
        let channels = expected.channels().count();
        let (mut exact, mut lights, mut viewers) = (Vec::new(), Vec::new(), Vec::new());
        let narrow = |direction: [f64; 3]| direction.map(|c| c as f32);
        let progress = Progress::new(PROBES as usize, "probes");
        for n in 1..=PROBES {
            let (wi, wo) = pair(n);
            // Consecutive probes are of different kinds.
            let aspect = aspects.get(n as usize / 2 % aspects.len().max(1)).copied().unwrap_or(Aspect::REFLECTION);
            let (wi, wo) = aspect.place(wi, wo);
            let mut texel = vec![0.0; channels];
            expected.f(wi, &[wo], &mut texel);
            exact.extend(texel);
            lights.push(narrow(wi));
            viewers.push(narrow(wo));
            progress.step();
        }
        // All at once: one pair at a time takes long in some representations.
        let mut texels = vec![0.0; lights.len() * found.channel_count()];
        found.eval_batch(&lights, &viewers, &mut texels);
        let values: Vec<(f64, f64)> = exact.into_iter().zip(texels.into_iter().map(f64::from)).collect();
        let mean = values.iter().map(|(a, _)| a.abs()).sum::<f64>() / values.len() as f64;
        let error = |(a, b): &(f64, f64)| (a - b).abs() / a.abs().max(0.01 * mean).max(f64::MIN_POSITIVE);
        let mut errors: Vec<f64> = values.iter().map(error).collect();
        errors.sort_by(f64::total_cmp);
        let squares = values.iter().fold([0.0; 2], |[d, a], (x, y)| [d + (x - y).powi(2), a + x * x]);
        let at = |share: f64| errors[((errors.len() - 1) as f64 * share) as usize];
        Errors {
            probes: PROBES as usize,
            median: at(0.5),
            most: at(0.95),
            largest: at(1.0),
            rms: (squares[0] / squares[1].max(f64::MIN_POSITIVE)).sqrt(),
        }
    }
}

impl Errors {
    /// `true` if one value in twenty is wrong by more than a twentieth.
    pub fn is_large(&self) -> bool {
        self.most > 0.05
    }
}

impl fmt::Display for Errors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Errors { probes, median, most, largest, rms } = self;
        write!(
            f,
            "relative error at {probes} probes: median {median:.1e}, 95 % below {most:.1e}, largest {largest:.1e}, rms \
             {rms:.1e} of the values"
        )
    }
}

fn pair(n: u32) -> ([f64; 3], [f64; 3]) {
    let [a, b, c, d] = halton(n);
    // A point on a disc, so that the density is the cosine; the rim is the horizon.
    let up = |square: f64, turn: f64| {
        let (radius, (sin, cos)) = ((0.9997 * square).sqrt(), (TAU * turn).sin_cos());
        [radius * cos, radius * sin, (1.0 - radius * radius).sqrt()]
    };
    let wi = up(a, d);
    let wo = up(b, c);
    if n.is_multiple_of(2) {
        return (wi, wo);
    }
    // Half vectors within 20 degrees of the normal.
    let (sin, cos) = (PI / 9.0 * b).sin_cos();
    let h = [sin * (TAU * c).cos(), sin * (TAU * c).sin(), cos];
    let along = 2.0 * (wi[0] * h[0] + wi[1] * h[1] + wi[2] * h[2]);
    let mirrored = [0, 1, 2].map(|i| along * h[i] - wi[i]);
    (wi, if mirrored[2] > 0.018 { mirrored } else { wo })
}
