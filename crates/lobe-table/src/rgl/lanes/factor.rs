//! The microfacet factor `ndf / (4 sigma)`.

use lobe_lane::{Block, Floats, Lanes};

use super::grid::{Grid, Placer};
use crate::invalid::Invalid;
use crate::passes::block::Column;
use crate::rgl::Images;
use lobe_memory::Storage;

/// Larger factors are clamped: an overflow would become NaN if a weight is 0.
const LARGEST: f32 = 1e20;

/// One image as cells: the four corners of each cell are adjacent, for one load.
#[derive(Clone, Debug)]
struct Cells {
    grid: Grid,
    texels: Storage<f32>,
}

impl Cells {
    fn new(part: &'static str, images: &Images) -> Result<Self, Invalid> {
        let [height, width] = images.size();
        let (grid, len) = Grid::new(part, images, [1, height - 1, width - 1], 4)?;
        let mut texels = Storage::zeros(len);
        for (cell, corners) in texels.as_mut_slice().chunks_exact_mut(4).enumerate() {
            let at = cell / (width - 1) * width + cell % (width - 1);
            let image = images.slice(0);
            corners.copy_from_slice(&[image[at], image[at + 1], image[at + width], image[at + width + 1]]);
        }
        Ok(Cells { grid, texels })
    }

    #[inline(always)]
    fn block(&self) -> Block<'_, 1, 4> {
        Block::new(self.texels.as_slice(), [0])
    }
}

/// The microfacet distribution and the projected area.
#[derive(Clone, Debug)]
pub(super) struct Factor {
    ndf: Cells,
    sigma: Cells,
    /// `true` if the area depends on the azimuth of `wi`.
    pub(super) azimuthal: bool,
}

impl Factor {
    pub(super) fn new(ndf: &Images, sigma: &Images) -> Result<Self, Invalid> {
        let [_, width] = sigma.size();
        let mut rows = sigma.slice(0).chunks_exact(width);
        let first = rows.next();
        let azimuthal = rows.any(|row| Some(row) != first);
        Ok(Factor { ndf: Cells::new("ndf", ndf)?, sigma: Cells::new("sigma", sigma)?, azimuthal })
    }

    /// Divides by the projected area: `factor` of queries `0..n` times `ndf / (4 sigma)`.
    #[inline(always)]
    pub(super) fn run<L: Lanes>(&self, lanes: L, n: usize, u_i: &[Column; 2], u_m: &[Column; 2], factor: &mut Column) {
        let (ndf, sigma) = (self.ndf.block(), self.sigma.block());
        let (ndf_places, sigma_places) = (self.ndf.grid.placer(lanes), self.sigma.grid.placer(lanes));
        let (four, largest) = (lanes.splat(4.0), lanes.splat(LARGEST));
        let mut query = 0;
        while query < n {
            let u = [u_m[0].load(lanes, query), u_m[1].load(lanes, query)];
            let ndf = bilinear(lanes, &ndf, &ndf_places, u);
            let u = [u_i[0].load(lanes, query), u_i[1].load(lanes, query)];
            let sigma = bilinear(lanes, &sigma, &sigma_places, u);
            let value = factor.load(lanes, query) * ndf / (four * sigma);
            factor.store(lanes, query, value.min(largest).max(-largest));
            query += L::LANES;
        }
    }

    pub(super) fn bytes(&self) -> usize {
        self.ndf.texels.bytes() + self.sigma.texels.bytes()
    }
}

#[inline(always)]
fn bilinear<L: Lanes>(lanes: L, block: &Block<'_, 1, 4>, places: &Placer<L>, u: [L::F; 2]) -> L::F {
    let (cells, [x, y]) = places.cells(lanes, u);
    let [[a, b, c, d]] = lanes.gather_quads(block, places.texel(cells));
    let (above, below) = (lanes.mul_add(x, b - a, a), lanes.mul_add(x, d - c, c));
    lanes.mul_add(y, below - above, above)
}
