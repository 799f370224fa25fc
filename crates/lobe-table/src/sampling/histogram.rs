//! The brightness of a material over the cells of a grid, for one incident direction.

use lobe_lane::{Kernel, Lanes};

use super::incident::{Incident, Surface};

/// Computes luminance times `f`, 1/sr, of each pair of incident and scattered directions into its last argument.
pub(crate) type Light<'a> = dyn FnMut(&[[f32; 3]], &[[f32; 3]], &mut [f32]) + 'a;

/// The luminance of values `[pair][channel]`, with the weights `luminance` of the channels.
pub(crate) fn weigh(values: &[f32], luminance: &[f32], out: &mut [f32]) {
    for (out, texel) in out.iter_mut().zip(values.chunks_exact(luminance.len())) {
        let mut brightness = 0.0;
        for (y, value) in luminance.iter().zip(texel) {
            brightness += y * value;
        }
        *out = brightness;
    }
}

/// The integrals over each cell, rows slow, by midpoints: of luminance times f times cosine, and of the cosine alone.
pub(crate) struct Histogram<'a> {
    pub(crate) light: &'a mut Light<'a>,
    pub(crate) surface: &'a Surface,
    /// The incident direction.
    pub(crate) incident: [f32; 3],
    /// The edges of rows and columns.
    pub(crate) phi: &'a [f64],
    pub(crate) root_v: &'a [f64],
    /// The number of midpoints per cell along each axis.
    pub(crate) points: usize,
}

/// The value of a histogram in one cell.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bin {
    pub(crate) light: f64,
    pub(crate) cosine: f64,
}

impl Kernel for Histogram<'_> {
    type Out = Vec<Bin>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Vec<Bin> {
        let Histogram { light, surface, incident, phi, root_v, points } = self;
        let columns = root_v.len() - 1;
        let incident_lanes = Incident::new(lanes, surface, lanes.splat_xyz(incident));

        let v = midpoints(root_v, points, |root| root * root);
        let mut scattered = vec![[0.0f32; 3]; v.len()];
        let incidents = vec![incident; v.len()];
        let mut values = vec![0.0f32; v.len()];
        let mut bins = Vec::with_capacity((phi.len() - 1) * columns);
        let mut row = 0;
        while row + 1 < phi.len() {
            bins.resize((row + 1) * columns, Bin::default());
            let bins = &mut bins[row * columns..];
            let width = (phi[row + 1] - phi[row]) / points as f64;
            let mut point = 0;
            while point < points {
                let (sin, cos) = (phi[row] + (point as f64 + 0.5) * width).sin_cos();
                let azimuth = [lanes.splat(cos as f32), lanes.splat(sin as f32)];
                let height = incident_lanes.height(lanes, azimuth[0]);
                let mut at = 0;
                while at < v.len() {
                    let rest = lanes.load_partial(&v[at..]) * height;
                    let direction = incident_lanes.direction(lanes, rest, azimuth);
                    let mut k = 0;
                    while k < L::LANES.min(v.len() - at) {
                        scattered[at + k] = lanes.extract_xyz(direction, k);
                        k += 1;
                    }
                    at += L::LANES;
                }
                light(&incidents, &scattered, &mut values);

                let solid_angle = f64::from(lanes.extract(height, 0)) * width / points as f64;
                let mut at = 0;
                while at < v.len() {
                    let column = at / points;
                    let [low, high] = [root_v[column], root_v[column + 1]];
                    let cosine = f64::from(scattered[at][2].abs()) * solid_angle * (high * high - low * low);
                    bins[column].cosine += cosine;
                    // NaN counts as dark, and infinity as the largest float.
                    let light = if values[at] > 0.0 { values[at].min(f32::MAX) } else { 0.0 };
                    bins[column].light += cosine * f64::from(light);
                    at += 1;
                }
                point += 1;
            }
            row += 1;
        }
        bins
    }
}

/// The middles of `points` equal parts of each cell, after `map` was applied to its edges.
fn midpoints(edges: &[f64], points: usize, map: impl Fn(f64) -> f64) -> Vec<f32> {
    let mut middles = Vec::with_capacity((edges.len() - 1) * points);
    for ends in edges.windows(2) {
        let (low, high) = (map(ends[0]), map(ends[1]));
        middles.extend((0..points).map(|p| (low + (p as f64 + 0.5) / points as f64 * (high - low)) as f32));
    }
    middles
}
