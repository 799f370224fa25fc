//! The values of a material as texels, which are looked up last.

use lobe_lane::{Block, Lanes};

use super::grid::{Grid, Places, first, offsets};
use super::invert::Blend;
use crate::grid::texels::{self, Located, Tile};
use crate::grid::weights::MAX_CORNERS;
use crate::invalid::Invalid;
use crate::passes::block::{BLOCK, Column};
use crate::rgl::Images;
use lobe_memory::Storage;

/// Up to this many channels are stored as four floats per texel, so that one load fetches two neighbours; more are
/// padded to a multiple of eight.
const FEW: usize = 3;

/// The spectra, `[azimuth][zenith angle][row][column][channel]`.
#[derive(Clone, Debug)]
pub(super) struct Spectra {
    pub(super) grid: Grid,
    pub(super) channels: usize,
    texels: Storage<f32>,
    /// Corners over the slices and the rows; with many channels, also over the columns.
    offsets: [usize; MAX_CORNERS],
    /// The lower bound of values.
    floor: f32,
}

/// The places of the queries of a block in the spectra.
pub(super) struct At<'a> {
    pub(super) places: &'a Places,
    pub(super) blend: &'a Blend,
    /// The factor of each value.
    pub(super) factor: &'a Column,
}

impl Spectra {
    /// Lays out `slices` (azimuths, zenith angles) times `channels` images.
    pub(super) fn new(images: &Images, slices: [usize; 2], channels: usize, floor: f32) -> Result<Self, Invalid> {
        let [height, width] = images.size();
        let floats = if channels <= FEW { 4 } else { channels.next_multiple_of(8) };
        let incident = slices[0] * slices[1];
        let (grid, len) = Grid::new("spectra", images, [incident, height, width], floats)?;
        let mut texels = Storage::zeros(len);
        let mut target = texels.as_mut_slice().chunks_exact_mut(floats);
        for slice in 0..incident {
            for texel in 0..height * width {
                let target = target.next().expect("a texel");
                for (channel, value) in target[..channels].iter_mut().enumerate() {
                    *value = images.slice(slice * channels + channel)[texel];
                }
            }
        }
        let [column, row, slice] = grid.strides;
        let offsets = if channels <= FEW {
            let few: [usize; 8] = offsets(slices, slice, &[row]);
            std::array::from_fn(|corner| few.get(corner).copied().unwrap_or(0))
        } else {
            offsets(slices, slice, &[row, column])
        };
        Ok(Spectra { grid, channels, texels, offsets, floor })
    }

    /// The values of as many queries as fit into the output, `[query][channel]`. `n` is their number rounded up to the
    /// lanes. `FEW_CORNERS` is twice, and `MANY_CORNERS` four times the `SLICES`.
    #[inline(always)]
    pub(super) fn run<L: Lanes, const SLICES: usize, const FEW_CORNERS: usize, const MANY_CORNERS: usize>(
        &self,
        lanes: L,
        n: usize,
        At { places: Places { base, fractions: [x, y] }, blend, factor }: At<'_>,
        weights: &mut [Column; MAX_CORNERS],
        tile: &mut Tile,
        out: &mut [f32],
    ) {
        if self.channels > FEW {
            corners::<L, SLICES, 2>(lanes, n, blend, factor, [y, x], weights);
            let block = Block::new(self.texels.as_slice(), first::<MANY_CORNERS, MAX_CORNERS>(&self.offsets));
            return texels::wide(lanes, &block, 0..self.channels, Located { base, weights }, self.floor, out);
        }
        corners::<L, SLICES, 1>(lanes, n, blend, factor, [y], weights);
        let block = Block::new(self.texels.as_slice(), first::<FEW_CORNERS, MAX_CORNERS>(&self.offsets));
        texels::rgb(lanes, n, &block, Located { base, weights }, x, self.floor, tile);
        if self.channels == FEW {
            out.copy_from_slice(&tile.as_flattened()[..out.len()]);
        } else {
            for (texel, three) in out.chunks_exact_mut(self.channels).zip(tile.as_flattened().chunks_exact(FEW)) {
                texel.copy_from_slice(&three[..texel.len()]);
            }
        }
    }

    pub(super) fn bytes(&self) -> usize {
        self.texels.bytes()
    }
}

/// The weights of all corners: those of the slices times the factor of the query and both ends of `AXES` fractions, the
/// last fastest.
#[inline(always)]
fn corners<L: Lanes, const SLICES: usize, const AXES: usize>(
    lanes: L,
    n: usize,
    blend: &Blend,
    factor: &Column,
    fractions: [&Column; AXES],
    weights: &mut [Column; MAX_CORNERS],
) {
    let one = lanes.splat(1.0);
    let mut query = 0;
    while query < n {
        let factor = factor.load(lanes, query);
        let mut ends = [factor; 4];
        let mut axis = 0;
        while axis < AXES {
            let upper = fractions[axis].load(lanes, query);
            let lower = one - upper;
            // Backwards, so that each product is read before it is overwritten.
            let mut end = 1 << axis;
            while end > 0 {
                end -= 1;
                let product = ends[end];
                ends[2 * end] = product * lower;
                ends[2 * end + 1] = product * upper;
            }
            axis += 1;
        }
        let mut slice = 0;
        while slice < SLICES {
            let weight = blend.weights[slice].load(lanes, query);
            let mut end = 0;
            while end < 1 << AXES {
                weights[(slice << AXES) + end].store(lanes, query, weight * ends[end]);
                end += 1;
            }
            slice += 1;
        }
        query += L::LANES;
    }
}

const _: () = assert!(BLOCK * FEW < size_of::<Tile>() / size_of::<f32>());
