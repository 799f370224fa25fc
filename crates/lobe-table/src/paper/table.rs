//! A whole evaluation (paper, section 3).

use std::ops::Range;

use lobe_lane::{Floats, Kernel, Lanes, Mask};
use thiserror::Error;

use super::{angles, search, texels};
use crate::directions::Directions;
use crate::grid::axis::Axis;
use crate::passes::blocks::{Blocks, Blockwise};
use crate::passes::pairs::PairPadding;
use crate::{AxisError, Edge, Edges, Scatter, specular, specular::AXIS_NAMES};

/// Floats represent every integer up to this one, so no more texels can be distinguished.
const MAX_TEXELS: usize = 1 << 24;

/// An RGB table in specular coordinates, three-dimensional (isotropic) or four-dimensional, evaluated as in the paper.
///
/// Sigma and theta are clamped at their ends, psi and phi are periodic, and values below 0 become 0: the default
/// [`Edges`]. Directions and results are those of [`Table`](crate::specular::Table).
#[derive(Clone, Debug)]
pub struct PaperTable {
    axes: [Axis; 4],
    texels: Vec<[f32; 3]>,
    /// Texels from a node to the next along sigma, psi, theta and phi.
    strides: [usize; 4],
}

/// Samples that cannot form such a table.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PaperError {
    /// The kernel is written for a BRDF with three channels.
    #[error("found {found}; expected {expected}")]
    Unsupported {
        /// What the samples have.
        found: String,
        /// What the kernel supports.
        expected: &'static str,
    },
    /// Knots that cannot form an axis.
    #[error("{axis}: {source}")]
    Axis {
        /// Name of the axis.
        axis: &'static str,
        /// What is wrong with it.
        source: AxisError,
    },
}

impl PaperTable {
    /// Lays out samples with three channels.
    ///
    /// # Errors
    /// For a BTDF, for a number of channels other than three, for an axis other than psi with a single knot, and for
    /// more texels than a float can count.
    pub fn new(samples: &specular::Data) -> Result<Self, PaperError> {
        let unsupported = |found: String, expected| Err(PaperError::Unsupported { found, expected });
        if samples.scatter() != Scatter::Reflection {
            return unsupported("a BTDF".into(), "a BRDF");
        }
        if samples.channels().count() != 3 {
            return unsupported(format!("{} channels", samples.channels().count()), "3 channels");
        }
        let axis = |index: usize| {
            Axis::new(&samples.knots()[index], Edges::default().axes[index])
                .map_err(|source| PaperError::Axis { axis: AXIS_NAMES[index], source })
        };
        let axes = [axis(0)?, axis(1)?, axis(2)?, axis(3)?];
        let nodes = axes.each_ref().map(|axis| axis.knots().len());
        for index in [0, 2, 3] {
            if nodes[index] < 2 {
                return unsupported(format!("one {} knot", AXIS_NAMES[index]), "at least two");
            }
        }
        let count = nodes.iter().fold(1usize, |count, &n| count.saturating_mul(n));
        if count > MAX_TEXELS {
            return unsupported(format!("{count} texels"), "at most 2^24");
        }
        let mut texels = Vec::with_capacity(count);
        for &sigma in axes[0].source() {
            for &psi in axes[1].source() {
                for &theta in axes[2].source() {
                    for &phi in axes[3].source() {
                        let texel = samples.texel([sigma, psi, theta, phi]);
                        texels.push([texel[0], texel[1], texel[2]]);
                    }
                }
            }
        }
        let strides = [nodes[1] * nodes[2] * nodes[3], nodes[2] * nodes[3], nodes[3], 1];
        Ok(PaperTable { axes, texels, strides })
    }

    /// `true` if the value depends on the rotation of the sample.
    pub fn is_anisotropic(&self) -> bool {
        self.axes[1].knots().len() > 1
    }

    /// Evaluates one pair per lane: red, green and blue, 0 in the lanes that `mask` leaves out.
    #[inline(always)]
    pub fn eval_lanes<L: Lanes>(&self, lanes: L, wi: [L::F; 3], wo: [L::F; 3], mask: L::M) -> [L::F; 3] {
        let zero = lanes.splat(0.0);
        let mask = mask & angles::above_horizon(lanes, wi, wo);
        if !mask.any() {
            return [zero; 3];
        }
        let [sigma, psi, theta, phi] = angles::angles(lanes, wi, wo, self.is_anisotropic());
        let rgb = if self.is_anisotropic() {
            self.interpolate::<L, 4, 16>(lanes, [(0, sigma), (1, psi), (2, theta), (3, phi)], mask)
        } else {
            self.interpolate::<L, 3, 8>(lanes, [(0, sigma), (2, theta), (3, phi)], mask)
        };
        // Lanes outside the mask have no weight, but their directions may be NaN.
        let [r, g, b] = rgb;
        [r.max(zero).masked(mask), g.max(zero).masked(mask), b.max(zero).masked(mask)]
    }

    /// Searches the given axes, multiplies their weights, and sums the `CORNERS = 2^AXES` corners.
    #[inline(always)]
    fn interpolate<L: Lanes, const AXES: usize, const CORNERS: usize>(
        &self,
        lanes: L,
        angles: [(usize, L::F); AXES],
        mask: L::M,
    ) -> [L::F; 3] {
        let mut base = lanes.splat(0.0);
        let mut weights = [lanes.splat(1.0); CORNERS];
        let mut offsets = [0; CORNERS];
        let mut k = 0;
        while k < AXES {
            let (index, angle) = angles[k];
            let axis = &self.axes[index];
            debug_assert!(matches!(axis.edge(), Edge::Clamp | Edge::Periodic));
            let angle = axis.bring_inside(lanes, angle);
            let (cell, ends) = search::weights(lanes, axis.knots(), axis.cells(), angle, mask);
            base = lanes.mul_add(cell, lanes.splat(self.strides[index] as f32), base);
            let mut corner = 0;
            while corner < CORNERS {
                let upper = corner >> (AXES - 1 - k) & 1;
                weights[corner] = if k == 0 { ends[upper] } else { weights[corner] * ends[upper] };
                offsets[corner] += upper * self.strides[index];
                corner += 1;
            }
            k += 1;
        }
        texels::interpolate(lanes, &self.texels, &offsets, base, &weights, mask)
    }

    /// The work of evaluating many pairs, as a kernel: `out[channel][query]`.
    ///
    /// # Panics
    /// If `wi`, `wo` and the three outputs differ in length.
    pub fn batch<'a>(
        &'a self,
        wi: Directions<'a>,
        wo: Directions<'a>,
        out: [&'a mut [f32]; 3],
    ) -> impl Kernel<Out = ()> + 'a {
        assert_eq!(wi.count(), wo.count(), "as many wi as wo");
        assert!(out.iter().all(|channel| channel.len() == wi.count()), "one output per query and channel");
        Blocks(Batch { table: self, wi, wo, out })
    }
}

/// All queries of a batch, packet by packet.
struct Batch<'a> {
    table: &'a PaperTable,
    wi: Directions<'a>,
    wo: Directions<'a>,
    out: [&'a mut [f32]; 3],
}

impl Blockwise for Batch<'_> {
    type Scratch = PairPadding;
    const SCRATCH: PairPadding = PairPadding::ZERO;

    fn count(&self) -> usize {
        self.wi.count()
    }

    #[inline(always)]
    fn block<L: Lanes>(&mut self, lanes: L, queries: Range<usize>, padding: &mut PairPadding) {
        let Batch { table, wi, wo, out: [red, green, blue] } = self;
        let pairs = padding.block(lanes, wi, wo, queries.start);
        let mut query = 0;
        while query < queries.len() {
            let at = queries.start + query;
            let mask = lanes.first_n(queries.end - at);
            let (wi, wo) = (pairs.wi.load(lanes, query), pairs.wo.load(lanes, query));
            let [r, g, b] = table.eval_lanes(lanes, wi, wo, mask);
            lanes.store_partial(&mut red[at..], r);
            lanes.store_partial(&mut green[at..], g);
            lanes.store_partial(&mut blue[at..], b);
            query += L::LANES;
        }
    }
}
