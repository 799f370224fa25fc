//! Multilinear interpolation in four angles, whatever these mean.

use std::ops::Range;

use lobe_lane::{Kernel, Lanes, MAX_LANES, call};

use super::axis::Axis;
use super::cells;
use super::edges::Edges;
use super::error::TableError;
use super::layout::{Corners, Kind, LAST, Layout, TURN, Texels, Values};
use super::texel::{Precision, Stored};
use super::texels::{self, Located, Tile};
use super::weights::{self, MAX_CORNERS};
use crate::passes::block::{BLOCK, Column, registers};

/// Values at the nodes of four axes, laid out for evaluation in SIMD lanes.
///
/// A grid with one knot on the axis [`TURN`] does not depend on the rotation of the sample, and does not read that
/// angle.
#[derive(Clone, Debug)]
pub(crate) struct Interpolator {
    axes: [Axis; 4],
    layout: Layout,
    /// The lower bound of results. Texels are finite, so the least float leaves every sum unchanged.
    floor: f32,
}

/// The parts of an [`Interpolator`].
pub(crate) struct Source<'a> {
    pub(crate) names: &'a [&'static str; 4],
    /// In radians.
    pub(crate) knots: &'a [Vec<f64>; 4],
    pub(crate) channels: usize,
    pub(crate) values: &'a [f32],
}

/// The intermediate values of a block.
pub(crate) struct Scratch<const B: usize = BLOCK> {
    /// Angles in radians, which are replaced by the fractions into their cells.
    pub(crate) angles: [Column<f32, B>; 4],
    /// All bits set for queries that have a value.
    pub(crate) valid: Column<i32, B>,
    base: Column<i32, B>,
    weights: [Column<f32, B>; MAX_CORNERS],
    tile: Tile<B>,
}

impl<const B: usize> Scratch<B> {
    pub(crate) const ZERO: Self = Scratch {
        angles: [Column::<f32, B>::ZERO; 4],
        valid: Column::<i32, B>::ZERO,
        base: Column::<i32, B>::ZERO,
        weights: [Column::<f32, B>::ZERO; MAX_CORNERS],
        tile: [[0.0; B]; 4],
    };
}

impl Interpolator {
    /// Lays out values, with a policy for angles outside the knots.
    ///
    /// # Errors
    /// If the table is too large to be indexed, or a periodic axis cannot be closed.
    pub(crate) fn new(source: &Source<'_>, edges: &Edges, precision: Precision) -> Result<Self, TableError> {
        let Source { names, knots, channels, values } = *source;
        let axis = |index: usize| {
            Axis::new(&knots[index], edges.axes[index])
                .map_err(|source| TableError::Axis { axis: names[index], source })
        };
        let axes = [axis(0)?, axis(1)?, axis(2)?, axis(3)?];
        let nodes = knots.each_ref().map(Vec::len);
        let values = Values { nodes, channels, values };
        let layout = Layout::new(&values, &axes, precision).ok_or_else(|| TableError::TooLarge {
            nodes: nodes.iter().fold(1usize, |all, nodes| all.saturating_mul(*nodes)),
            channels,
        })?;
        Ok(Interpolator { axes, layout, floor: if edges.non_negative { 0.0 } else { f32::MIN } })
    }

    pub(crate) fn axes(&self) -> &[Axis; 4] {
        &self.axes
    }

    #[inline(always)]
    pub(crate) fn layout(&self) -> &Layout {
        &self.layout
    }

    #[inline(always)]
    pub(crate) fn channels(&self) -> usize {
        self.layout.channels
    }

    /// `true` if values depend on the rotation of the sample.
    #[inline(always)]
    pub(crate) fn is_anisotropic(&self) -> bool {
        self.layout.anisotropic()
    }

    #[inline(always)]
    pub(crate) fn floor(&self) -> f32 {
        self.floor
    }

    /// Bytes of memory that the grid takes.
    pub(crate) fn bytes(&self) -> usize {
        self.layout.bytes() + self.axes.iter().map(Axis::bytes).sum::<usize>()
    }

    /// Converts the angles of queries `0..n` to base indices and corner weights. `n` is a multiple of the lanes.
    #[inline(always)]
    pub(crate) fn find<L: Lanes, const B: usize>(&self, lanes: L, n: usize, scratch: &mut Scratch<B>) {
        let Scratch { angles, valid, base, weights, .. } = scratch;
        *base = Column::<i32, B>::ZERO;
        let mut index = 0;
        while index < 4 {
            if index != TURN || self.is_anisotropic() {
                let stride = self.layout.strides()[index];
                cells::run(lanes, n, &self.axes[index], stride, &mut angles[index], base, valid);
            }
            index += 1;
        }
        let [a, turn, b, last] = &*angles;
        let scale = self.layout.scale();
        match (self.layout.kind, self.is_anisotropic()) {
            (Kind::Rgb, false) => weights::run(lanes, n, [a, b], valid, scale, weights),
            (Kind::Rgb, true) => weights::run(lanes, n, [a, turn, b], valid, scale, weights),
            (_, false) => weights::run(lanes, n, [a, b, last], valid, scale, weights),
            (_, true) => weights::run(lanes, n, [a, turn, b, last], valid, scale, weights),
        }
    }

    /// The values of the first queries of a block whose places were found: `out[query][channel]` of these channels,
    /// which are all, or start at a multiple of eight.
    #[inline(always)]
    pub(crate) fn blend<L: Lanes, const B: usize>(
        &self,
        lanes: L,
        texels: &Texels<'_>,
        scratch: &mut Scratch<B>,
        channels: Range<usize>,
        out: &mut [f32],
    ) {
        match texels {
            Texels::Single(corners) => self.blend_stored(lanes, corners, scratch, channels, out),
            Texels::Half(corners) => self.blend_stored(lanes, corners, scratch, channels, out),
        }
    }

    #[inline(always)]
    fn blend_stored<L: Lanes, T: Stored, const B: usize>(
        &self,
        lanes: L,
        corners: &Corners<'_, T>,
        scratch: &mut Scratch<B>,
        channels: Range<usize>,
        out: &mut [f32],
    ) {
        let Scratch { angles, base, weights, tile, .. } = scratch;
        let (located, floor, width) = (Located { base, weights }, self.floor, channels.len());
        let n = registers(lanes, out.len() / width);
        match corners {
            Corners::MonoIso(block) => texels::mono(lanes, n, block, located, floor, tile),
            Corners::MonoAniso(block) => texels::mono(lanes, n, block, located, floor, tile),
            Corners::RgbIso(block) => texels::rgb(lanes, n, block, located, &angles[LAST], floor, tile),
            Corners::RgbAniso(block) => texels::rgb(lanes, n, block, located, &angles[LAST], floor, tile),
            // Many channels need no tile.
            Corners::WideIso(block) => return texels::wide(lanes, block, channels, located, floor, out),
            Corners::WideAniso(block) => return texels::wide(lanes, block, channels, located, floor, out),
        }
        match width {
            2 => {
                let mut query = 0;
                while query < out.len() / 2 {
                    out[2 * query..][..2].copy_from_slice(&tile.as_flattened()[3 * query..][..2]);
                    query += 1;
                }
            }
            _ => out.copy_from_slice(&tile.as_flattened()[..out.len()]),
        }
    }

    /// Converts the angles of a block to its values, `out[query][channel]`: everything after the coordinates.
    #[inline(always)]
    pub(crate) fn values<L: Lanes>(&self, lanes: L, scratch: &mut Scratch, out: &mut [f32]) {
        call(lanes, Interpolate { grid: self, scratch, out });
    }

    /// The values of one register of queries whose places were found: `out[channel]` holds that channel for all lanes.
    #[inline(always)]
    pub(crate) fn blend_lanes<L: Lanes, const B: usize>(&self, lanes: L, scratch: &mut Scratch<B>, out: &mut [L::F]) {
        // Texels are computed query by query, but the lanes need them channel by channel.
        let texels = self.layout.texels();
        let mut tile = [0.0f32; MAX_LANES * CHUNK];
        let mut from = 0;
        while from < out.len() {
            let width = CHUNK.min(out.len() - from);
            let tile = &mut tile[..L::LANES * width];
            self.blend(lanes, &texels, scratch, from..from + width, tile);
            let mut k = 0;
            while k < width {
                let mut column = [0.0f32; MAX_LANES];
                let mut lane = 0;
                while lane < L::LANES {
                    column[lane] = tile[lane * width + k];
                    lane += 1;
                }
                out[from + k] = lanes.load(&column);
                k += 1;
            }
            from += CHUNK;
        }
    }
}

/// [`Interpolator::values`] as a kernel that everything that interpolates a grid calls, so that it is compiled once.
struct Interpolate<'a> {
    grid: &'a Interpolator,
    scratch: &'a mut Scratch,
    out: &'a mut [f32],
}

impl Kernel for Interpolate<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Interpolate { grid, scratch, out } = self;
        grid.find(lanes, registers(lanes, out.len() / grid.channels()), scratch);
        grid.blend(lanes, &grid.layout.texels(), scratch, 0..grid.channels(), out);
    }
}

/// The number of channels that [`Interpolator::blend_lanes`] transposes at once.
const CHUNK: usize = 8;
