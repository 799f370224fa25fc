//! Where the texels of a table lie in memory.

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

/// The texels of a table, sigma slowest, then psi, theta and phi.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub(crate) kind: Kind,
    pub(crate) channels: usize,
    storage: Storage,
    /// Floats from a node to the next along sigma, psi, theta and phi.
    strides: [usize; 4],
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
        Some(Layout { kind, channels, storage, strides })
    }

    /// All floats.
    #[inline(always)]
    pub(crate) fn data(&self) -> &[f32] {
        self.storage.as_slice()
    }

    /// Floats from a node to the next along each axis.
    #[inline(always)]
    pub(crate) fn strides(&self) -> &[usize; 4] {
        &self.strides
    }

    /// The offsets of `2^AXES` corners over the axes given, the last fastest; an axis of one knot has no upper corner.
    #[inline(always)]
    pub(crate) fn corners<const AXES: usize, const CORNERS: usize>(
        &self,
        axes: &[Axis; 4],
        over: [usize; AXES],
    ) -> [usize; CORNERS] {
        let mut offsets = [0; CORNERS];
        let mut corner = 0;
        while corner < CORNERS {
            let mut k = 0;
            while k < AXES {
                let axis = over[k];
                let upper = corner >> (AXES - 1 - k) & 1 == 1;
                let step = axis == 3 || axes[axis].knots().len() > 1;
                offsets[corner] += if upper && step { self.strides[axis] } else { 0 };
                k += 1;
            }
            corner += 1;
        }
        offsets
    }

    /// Bytes of memory that this holds.
    pub(crate) fn bytes(&self) -> usize {
        self.storage.bytes()
    }
}
