//! Where the texels of a table lie in memory.

use lobe_lane::Block;

use crate::Samples;
use crate::axis::Axis;
use crate::storage::Storage;

/// How the channels of a node are stored. All but the last index of an axis have their upper neighbour at a fixed
/// distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// One channel: for each cell in theta and phi its four corners side by side, `(theta, phi)`, `(theta, phi + 1)`,
    /// `(theta + 1, phi)`, `(theta + 1, phi + 1)`, which one load of four floats brings.
    Mono,
    /// Two or three channels: four floats a node, so that one load of eight brings two neighbours in phi.
    Rgb,
    /// More: the channels of a node, padded to a multiple of eight.
    Wide,
}

pub(crate) const SIGMA: usize = 0;
pub(crate) const PSI: usize = 1;
pub(crate) const THETA: usize = 2;
pub(crate) const PHI: usize = 3;

/// The texels of a table and the corners of a cell, by kind and by whether psi counts.
///
/// Corners go over sigma, psi where it counts, theta and phi, the last fastest. One load brings two corners in phi of
/// [`Kind::Rgb`], and all four in theta and phi of [`Kind::Mono`].
#[derive(Clone, Copy, Debug)]
pub(crate) enum Corners<'a> {
    MonoIso(Block<'a, 2, 4>),
    MonoAniso(Block<'a, 4, 4>),
    RgbIso(Block<'a, 4, 8>),
    RgbAniso(Block<'a, 8, 8>),
    WideIso(Block<'a, 8, 8>),
    WideAniso(Block<'a, 16, 8>),
}

/// The texels of a table, sigma slowest, then psi, theta and phi.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub(crate) kind: Kind,
    pub(crate) channels: usize,
    storage: Storage,
    /// Floats from a node to the next along sigma, psi, theta and phi.
    strides: [usize; 4],
    anisotropic: bool,
    /// The corners of a cell, from its first node: as many as [`Corners`] has for this kind.
    offsets: [usize; 16],
}

impl Layout {
    /// Lays out the samples at the knots of `axes`. `None` where the table has more floats than a lane can index.
    pub(crate) fn new(samples: &Samples, axes: &[Axis; 4]) -> Option<Self> {
        let channels = samples.channels().count();
        let (kind, width) = match channels {
            1 => (Kind::Mono, 4),
            2..=3 => (Kind::Rgb, 4),
            _ => (Kind::Wide, channels.next_multiple_of(8)),
        };
        // A constant phi is stored twice, because texels come in pairs along phi.
        let nodes: [usize; 4] = std::array::from_fn(|axis| axes[axis].knots().len().max(if axis == 3 { 2 } else { 1 }));
        let mut strides = [width; 4];
        for axis in (0..3).rev() {
            strides[axis] = strides[axis + 1].checked_mul(nodes[axis + 1])?;
        }
        let len = strides[0].checked_mul(nodes[0])?;
        i32::try_from(len).ok()?;

        let mut storage = Storage::zeros(len);
        let texel = |node: [usize; 4]| {
            // The upper neighbour of the last node is itself; the search never gives it any weight but in rounding.
            samples.texel(std::array::from_fn(|axis| {
                let source = axes[axis].source();
                source[node[axis].min(source.len() - 1)]
            }))
        };
        let mut texels = storage.as_mut_slice().chunks_exact_mut(width);
        for sigma in 0..nodes[0] {
            for psi in 0..nodes[1] {
                for theta in 0..nodes[2] {
                    for phi in 0..nodes[3] {
                        let target = texels.next().expect("a texel a node");
                        if kind == Kind::Mono {
                            for (corner, value) in target.iter_mut().enumerate() {
                                *value = texel([sigma, psi, theta + corner / 2, phi + corner % 2])[0];
                            }
                        } else {
                            target[..channels].copy_from_slice(texel([sigma, psi, theta, phi]));
                        }
                    }
                }
            }
        }
        let anisotropic = axes[PSI].knots().len() > 1;
        let over: &[usize] = match (kind, anisotropic) {
            (Kind::Mono, false) => &[SIGMA],
            (Kind::Mono, true) => &[SIGMA, PSI],
            (Kind::Rgb, false) => &[SIGMA, THETA],
            (Kind::Rgb, true) => &[SIGMA, PSI, THETA],
            (Kind::Wide, false) => &[SIGMA, THETA, PHI],
            (Kind::Wide, true) => &[SIGMA, PSI, THETA, PHI],
        };
        let offsets = offsets(axes, strides, over);
        Some(Layout { kind, channels, storage, strides, anisotropic, offsets })
    }

    /// `true` where psi counts.
    #[inline(always)]
    pub(crate) fn anisotropic(&self) -> bool {
        self.anisotropic
    }

    /// Floats from a node to the next along each axis.
    #[inline(always)]
    pub(crate) fn strides(&self) -> &[usize; 4] {
        &self.strides
    }

    /// The texels with the pattern of corners that an interpolation reads.
    #[inline(always)]
    pub(crate) fn corners(&self) -> Corners<'_> {
        let data = self.storage.as_slice();
        match (self.kind, self.anisotropic) {
            (Kind::Mono, false) => Corners::MonoIso(Block::new(data, first(&self.offsets))),
            (Kind::Mono, true) => Corners::MonoAniso(Block::new(data, first(&self.offsets))),
            (Kind::Rgb, false) => Corners::RgbIso(Block::new(data, first(&self.offsets))),
            (Kind::Rgb, true) => Corners::RgbAniso(Block::new(data, first(&self.offsets))),
            (Kind::Wide, false) => Corners::WideIso(Block::new(data, first(&self.offsets))),
            (Kind::Wide, true) => Corners::WideAniso(Block::new(data, first(&self.offsets))),
        }
    }

    /// Bytes of memory that this holds.
    pub(crate) fn bytes(&self) -> usize {
        self.storage.bytes()
    }
}

#[inline(always)]
fn first<const N: usize>(offsets: &[usize; 16]) -> [usize; N] {
    *offsets.first_chunk().expect("at most 16 corners")
}

/// The offsets of the corners over the axes given, the last fastest; an axis of one knot has no upper corner, except phi,
/// which has every knot twice.
fn offsets(axes: &[Axis; 4], strides: [usize; 4], over: &[usize]) -> [usize; 16] {
    let mut offsets = [0; 16];
    for (corner, offset) in offsets.iter_mut().enumerate().take(1 << over.len()) {
        for (k, &axis) in over.iter().rev().enumerate() {
            let step = axis == PHI || axes[axis].knots().len() > 1;
            *offset += if corner >> k & 1 == 1 && step { strides[axis] } else { 0 };
        }
    }
    offsets
}
