//! The `interpn` crate, a peer for interpolation only: one channel per call, no coordinates.

use interpn::multilinear::rectilinear;
use lobe::specular;

/// A table in the form that `interpn` needs: the axes that have cells, and each channel separately.
#[derive(Clone, Debug)]
pub struct Grid {
    axes: Vec<usize>,
    knots: Vec<Vec<f32>>,
    channels: [Vec<f32>; 3],
}

impl Grid {
    /// Makes it from samples of three channels.
    ///
    /// # Panics
    /// If there are not three channels.
    pub fn new(samples: &specular::Data) -> Self {
        assert_eq!(samples.channels().count(), 3, "the peers are queried for RGB");
        let axes: Vec<_> = (0..4).filter(|&axis| samples.knots()[axis].len() > 1).collect();
        let knots = axes.iter().map(|&axis| samples.knots()[axis].iter().map(|&knot| knot as f32).collect());
        let channel = |k: usize| samples.values().iter().skip(k).step_by(3).copied().collect();
        Grid { knots: knots.collect(), axes, channels: [0, 1, 2].map(channel) }
    }

    /// Red, green and blue at all points; `angles` are sigma, psi, theta and phi in radians.
    pub fn interpolate(&self, angles: [&[f32]; 4], out: &mut [Vec<f32>; 3]) {
        let knots: Vec<&[f32]> = self.knots.iter().map(Vec::as_slice).collect();
        let points: Vec<&[f32]> = self.axes.iter().map(|&axis| angles[axis]).collect();
        for (channel, out) in self.channels.iter().zip(out) {
            rectilinear::interpn(&knots, channel, &points, out).expect("a regular grid");
        }
    }
}
