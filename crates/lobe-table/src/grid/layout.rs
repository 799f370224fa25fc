//! The layout of the texels of a table in memory.

use lobe_lane::Block;

use crate::grid::axis::Axis;
use crate::grid::texel::{Precision, Stored, half_scale};
use lobe_memory::Storage;

/// The storage of the channels of a node. For all but the last index of an axis, the upper neighbour is at a fixed
/// distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// One channel: for each cell of the last two axes, its four corners side by side, with the last axis faster, so
    /// that one load of four floats fetches them.
    Mono,
    /// Two or three channels: four floats per node, so that one load of eight fetches two neighbours along the last
    /// axis.
    Rgb,
    /// More channels: those of a node, padded to a multiple of eight.
    Wide,
}

/// The axis of the rotation of the sample, which has one knot in an isotropic grid.
pub(crate) const TURN: usize = 1;
/// The axis along which nodes are adjacent in memory.
pub(crate) const LAST: usize = 3;

/// The texels of a table and the corners of a cell, by kind and by whether [`TURN`] is used.
///
/// Corners are ordered by axis, the last fastest. One load fetches two corners along [`LAST`] for [`Kind::Rgb`], and
/// all four along the last two axes for [`Kind::Mono`].
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

/// The texels of a table, the first axis slowest.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub(crate) kind: Kind,
    pub(crate) channels: usize,
    memory: Memory,
    /// The factor for stored values.
    scale: f32,
    /// Floats from a node to the next along each axis.
    strides: [usize; 4],
    anisotropic: bool,
    /// The corners of a cell, from its first node: as many as [`Corners`] has for this kind.
    offsets: [usize; 16],
}

impl Layout {
    /// Lays out values at the knots of `axes`. `None` if the table has more floats than a lane can index.
    pub(crate) fn new(values: &Values<'_>, axes: &[Axis; 4], precision: Precision) -> Option<Self> {
        let channels = values.channels;
        let (kind, width) = match channels {
            1 => (Kind::Mono, 4),
            2..=3 => (Kind::Rgb, 4),
            _ => (Kind::Wide, channels.next_multiple_of(8)),
        };
        // A constant last axis is stored twice, because texels come in pairs along it.
        let nodes: [usize; 4] =
            std::array::from_fn(|axis| axes[axis].knots().len().max(if axis == LAST { 2 } else { 1 }));
        let mut strides = [width; 4];
        for axis in (0..3).rev() {
            strides[axis] = strides[axis + 1].checked_mul(nodes[axis + 1])?;
        }
        let len = strides[0].checked_mul(nodes[0])?;
        i32::try_from(len).ok()?;

        let shape = Shape { kind, width, channels, nodes };
        let (memory, scale) = match precision {
            Precision::Single => (Memory::Single(shape.fill(len, values, axes, 1.0)), 1.0),
            Precision::Half => {
                let largest = values.values.iter().fold(0.0f32, |largest, value| largest.max(value.abs()));
                let scale = half_scale(largest);
                (Memory::Half(shape.fill(len, values, axes, scale)), 1.0 / scale)
            }
        };
        let anisotropic = axes[TURN].knots().len() > 1;
        let over: &[usize] = match (kind, anisotropic) {
            (Kind::Mono, false) => &[0],
            (Kind::Mono, true) => &[0, TURN],
            (Kind::Rgb, false) => &[0, 2],
            (Kind::Rgb, true) => &[0, TURN, 2],
            (Kind::Wide, false) => &[0, 2, LAST],
            (Kind::Wide, true) => &[0, TURN, 2, LAST],
        };
        let offsets = offsets(axes, strides, over);
        Some(Layout { kind, channels, memory, scale, strides, anisotropic, offsets })
    }

    /// `true` if [`TURN`] is used.
    #[inline(always)]
    pub(crate) fn anisotropic(&self) -> bool {
        self.anisotropic
    }

    /// Floats from a node to the next along each axis.
    #[inline(always)]
    pub(crate) fn strides(&self) -> &[usize; 4] {
        &self.strides
    }

    /// The factor for stored values: a power of two.
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

/// The values of a grid as they were measured: `[axis 0][axis 1][axis 2][axis 3][channel]`.
pub(crate) struct Values<'a> {
    /// The number of nodes on each axis.
    pub(crate) nodes: [usize; 4],
    pub(crate) channels: usize,
    pub(crate) values: &'a [f32],
}

impl Values<'_> {
    /// The channels at one node.
    fn texel(&self, node: [usize; 4]) -> &[f32] {
        let at = node.iter().zip(self.nodes).fold(0, |at, (index, nodes)| at * nodes + index);
        &self.values[at * self.channels..][..self.channels]
    }
}

/// The number, the kind and the place of the stored numbers.
struct Shape {
    kind: Kind,
    width: usize,
    channels: usize,
    nodes: [usize; 4],
}

impl Shape {
    /// Writes the values of all nodes, multiplied by `scale`.
    fn fill<T: Stored>(&self, len: usize, values: &Values<'_>, axes: &[Axis; 4], scale: f32) -> Storage<T> {
        let Shape { kind, width, channels, nodes } = *self;
        let mut storage = Storage::zeros(len);
        let texel = |node: [usize; 4]| {
            // The upper neighbour of the last node is the node itself; the search gives it no weight except in
            // rounding.
            values.texel(std::array::from_fn(|axis| {
                let source = axes[axis].source();
                source[node[axis].min(source.len() - 1)]
            }))
        };
        let mut texels = storage.as_mut_slice().chunks_exact_mut(width);
        for first in 0..nodes[0] {
            for turn in 0..nodes[1] {
                for third in 0..nodes[2] {
                    for last in 0..nodes[3] {
                        let target = texels.next().expect("a texel for each node");
                        if kind == Kind::Mono {
                            for (corner, value) in target.iter_mut().enumerate() {
                                let node = [first, turn, third + corner / 2, last + corner % 2];
                                *value = T::from_f32(texel(node)[0] * scale);
                            }
                        } else {
                            let texel = texel([first, turn, third, last]);
                            for (target, value) in target[..channels].iter_mut().zip(texel) {
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

/// The offsets of the corners over the given axes, the last fastest; an axis with one knot has no upper corner, except
/// the last axis, which has that knot twice.
fn offsets(axes: &[Axis; 4], strides: [usize; 4], over: &[usize]) -> [usize; 16] {
    let mut offsets = [0; 16];
    for (corner, offset) in offsets.iter_mut().enumerate().take(1 << over.len()) {
        for (k, &axis) in over.iter().rev().enumerate() {
            let step = axis == LAST || axes[axis].knots().len() > 1;
            *offset += if corner >> k & 1 == 1 && step { strides[axis] } else { 0 };
        }
    }
    offsets
}
