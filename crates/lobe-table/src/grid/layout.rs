//! Where the texels of a table lie in memory.

use lobe_lane::Block;

use crate::grid::axis::Axis;
use crate::grid::texel::{Precision, Stored, half_scale};
use crate::specular;
use lobe_memory::Storage;

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
pub(crate) enum Corners<'a, T> {
    MonoIso(Block<'a, 2, 4, T>),
    MonoAniso(Block<'a, 4, 4, T>),
    RgbIso(Block<'a, 4, 8, T>),
    RgbAniso(Block<'a, 8, 8, T>),
    WideIso(Block<'a, 8, 8, T>),
    WideAniso(Block<'a, 16, 8, T>),
}

/// [`Corners`] in the precision of a table.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Texels<'a> {
    Single(Corners<'a, f32>),
    Half(Corners<'a, u16>),
}

#[derive(Clone, Debug)]
enum Memory {
    Single(Storage<f32>),
    Half(Storage<u16>),
}

/// The texels of a table, sigma slowest, then psi, theta and phi.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub(crate) kind: Kind,
    pub(crate) channels: usize,
    memory: Memory,
    /// What stored values are to be multiplied by.
    scale: f32,
    /// Floats from a node to the next along sigma, psi, theta and phi.
    strides: [usize; 4],
    anisotropic: bool,
    /// The corners of a cell, from its first node: as many as [`Corners`] has for this kind.
    offsets: [usize; 16],
}

impl Layout {
    /// Lays out the samples at the knots of `axes`. `None` where the table has more floats than a lane can index.
    pub(crate) fn new(samples: &specular::Data, axes: &[Axis; 4], precision: Precision) -> Option<Self> {
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

        let shape = Shape { kind, width, channels, nodes };
        let (memory, scale) = match precision {
            Precision::Single => (Memory::Single(shape.fill(len, samples, axes, 1.0)), 1.0),
            Precision::Half => {
                let largest = samples.values().iter().fold(0.0f32, |largest, value| largest.max(value.abs()));
                let scale = half_scale(largest);
                (Memory::Half(shape.fill(len, samples, axes, scale)), 1.0 / scale)
            }
        };
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
        Some(Layout { kind, channels, memory, scale, strides, anisotropic, offsets })
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

    /// What stored values are to be multiplied by: a power of two.
    #[inline(always)]
    pub(crate) fn scale(&self) -> f32 {
        self.scale
    }

    /// The texels with the pattern of corners that an interpolation reads.
    #[inline(always)]
    pub(crate) fn texels(&self) -> Texels<'_> {
        match &self.memory {
            Memory::Single(storage) => Texels::Single(self.corners(storage.as_slice())),
            Memory::Half(storage) => Texels::Half(self.corners(storage.as_slice())),
        }
    }

    #[inline(always)]
    fn corners<'a, T>(&self, data: &'a [T]) -> Corners<'a, T> {
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
        match &self.memory {
            Memory::Single(storage) => storage.bytes(),
            Memory::Half(storage) => storage.bytes(),
        }
    }
}

/// How many numbers of what kind go where.
struct Shape {
    kind: Kind,
    width: usize,
    channels: usize,
    nodes: [usize; 4],
}

impl Shape {
    /// Writes the values of all nodes, multiplied by `scale`.
    fn fill<T: Stored>(&self, len: usize, samples: &specular::Data, axes: &[Axis; 4], scale: f32) -> Storage<T> {
        let Shape { kind, width, channels, nodes } = *self;
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
                                let node = [sigma, psi, theta + corner / 2, phi + corner % 2];
                                *value = T::from_f32(texel(node)[0] * scale);
                            }
                        } else {
                            let values = texel([sigma, psi, theta, phi]);
                            for (target, value) in target[..channels].iter_mut().zip(values) {
                                *target = T::from_f32(value * scale);
                            }
                        }
                    }
                }
            }
        }
        storage
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
