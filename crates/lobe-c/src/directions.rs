//! Batches in memory, in any layout: components with strides between queries.

use lobe::Directions;

use crate::border;
use crate::error::Error;

/// Directions in memory: `x[i * stride]`, `y[i * stride]` and `z[i * stride]` are the components of direction `i`.
/// Consecutive vectors are `{p, p + 1, p + 2, 3}`, columns `{x, y, z, 1}`; these two are read in place. With a stride
/// of 0, all directions are the same.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct lobe_directions {
    /// x of the first direction.
    pub x: *const f32,
    /// y of the first direction.
    pub y: *const f32,
    /// z of the first direction.
    pub z: *const f32,
    /// Distance from one direction to the next, in numbers.
    pub stride: usize,
}

/// Output of values: value `c` of query `i` is written to `data[i * query_stride + c * channel_stride]`. Consecutive
/// queries are `{p, channels, 1}`, which is the fastest layout.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct lobe_values {
    /// The first value.
    pub data: *mut f32,
    /// Distance from one query to the next, in numbers.
    pub query_stride: usize,
    /// Distance from one channel to the next, in numbers.
    pub channel_stride: usize,
}

/// Number of queries that are copied at once if kernels cannot read their layout.
pub(crate) const AT_ONCE: usize = 4096;

/// Directions that can be read, in any layout.
#[derive(Clone, Copy)]
pub enum Readable<'a> {
    /// In a layout that kernels can read.
    Placed(Directions<'a>),
    /// With other strides.
    Strided { columns: [&'a [f32]; 3], stride: usize },
}

impl lobe_directions {
    /// The same as slices.
    ///
    /// # Errors
    /// If a pointer is null or misaligned, or the last direction would be beyond memory.
    ///
    /// # Safety
    /// The pointers belong to `count` directions, which live for `'a` and are not written to.
    pub unsafe fn readable<'a>(&self, count: usize, name: &str) -> Result<Readable<'a>, Error> {
        let follow = self.y == self.x.wrapping_add(1) && self.z == self.x.wrapping_add(2);
        if self.stride == 3 && follow {
            // SAFETY: three numbers each, next to each other, by the promise of the caller.
            let vectors = unsafe { border::slice(self.x.cast::<[f32; 3]>(), count, name) }?;
            return Ok(Readable::Placed(Directions::Vectors(vectors)));
        }
        let length = extent(count, self.stride, 1, 0).ok_or_else(|| too_far(name))?;
        // SAFETY: by the promise of the caller, there is a number at every stride up to the last one, in one piece of
        // memory.
        let column = |pointer| unsafe { border::slice::<f32>(pointer, length, name) };
        let columns = [column(self.x)?, column(self.y)?, column(self.z)?];
        match self.stride {
            1 => Ok(Readable::Placed(Directions::Columns(columns))),
            stride => Ok(Readable::Strided { columns, stride }),
        }
    }
}

/// Number of floats from the first to the last of a batch.
fn extent(count: usize, stride: usize, channels: usize, channel_stride: usize) -> Option<usize> {
    match (count, channels) {
        (0, _) | (_, 0) => Some(0),
        _ => {
            let queries = (count - 1).checked_mul(stride)?;
            queries.checked_add((channels - 1).checked_mul(channel_stride)?)?.checked_add(1)
        }
    }
}

fn too_far(name: &str) -> Error {
    Error::invalid(format!("{name}: found a stride that leads beyond memory"))
}

impl<'a> Readable<'a> {
    /// The directions, if a kernel can read them.
    pub fn placed(self) -> Option<Directions<'a>> {
        match self {
            Readable::Placed(directions) => Some(directions),
            Readable::Strided { .. } => None,
        }
    }

    /// One direction.
    pub fn get(&self, index: usize) -> [f32; 3] {
        match self {
            Readable::Placed(directions) => directions.get(index),
            Readable::Strided { columns, stride } => columns.map(|column| column[index * stride]),
        }
    }

    /// Copies as many directions as there is room for, from `at` on.
    pub fn copy(&self, at: usize, out: &mut [[f32; 3]]) {
        for (index, out) in out.iter_mut().enumerate() {
            *out = self.get(at + index);
        }
    }
}

/// Values that can be written to.
pub struct Writable<'a> {
    values: &'a mut [f32],
    query_stride: usize,
    channel_stride: usize,
    channels: usize,
}

impl lobe_values {
    /// The same as a slice.
    ///
    /// # Errors
    /// If the pointer is null or misaligned, or values of different queries or channels would be at the same place.
    ///
    /// # Safety
    /// There is room for the values of `count` queries, which lives for `'a`, and which nothing else uses. Numbers
    /// between them are not changed.
    pub unsafe fn writable<'a>(&self, count: usize, channels: usize, name: &str) -> Result<Writable<'a>, Error> {
        let &lobe_values { data, query_stride, channel_stride } = self;
        let length = extent(count, query_stride, channels, channel_stride).ok_or_else(|| too_far(name))?;
        // One of the two strides steps over everything that the other one spans.
        let queries_apart = extent(1, 0, channels, channel_stride).is_some_and(|span| query_stride >= span);
        let channels_apart = extent(count, query_stride, 1, 0).is_some_and(|span| channel_stride >= span);
        let is_apart = match (count, channels) {
            (0, _) | (_, 0) | (1, 1) => true,
            (_, 1) => query_stride > 0,
            (1, _) => channel_stride > 0,
            _ => query_stride > 0 && channel_stride > 0 && (queries_apart || channels_apart),
        };
        if !is_apart {
            return Err(Error::invalid(format!(
                "{name}: found strides of {query_stride} and {channel_stride} for {count} queries of {channels} channels; \
                 expected a separate place for each value"
            )));
        }
        // SAFETY: by the promise of the caller.
        let values = unsafe { border::slice_mut(data, length, name) }?;
        Ok(Writable { values, query_stride, channel_stride, channels })
    }
}

impl Writable<'_> {
    /// All values, if they are where a kernel writes them.
    pub fn placed(&mut self) -> Option<&mut [f32]> {
        let is_placed = self.query_stride == self.channels && (self.channel_stride == 1 || self.channels <= 1);
        is_placed.then_some(&mut *self.values)
    }

    /// Writes values, `[query][channel]`, from query `at` on.
    pub fn copy(&mut self, at: usize, from: &[f32]) {
        if self.channels == 0 {
            return;
        }
        for (index, texel) in from.chunks_exact(self.channels).enumerate() {
            for (channel, &value) in texel.iter().enumerate() {
                self.values[(at + index) * self.query_stride + channel * self.channel_stride] = value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(query_stride: usize, channel_stride: usize, count: usize, channels: usize) -> Result<usize, Error> {
        let mut data = vec![0.0; 1000];
        let values = lobe_values { data: data.as_mut_ptr(), query_stride, channel_stride };
        // SAFETY: no case is longer than the vector.
        unsafe { values.writable(count, channels, "f") }.map(|writable| writable.values.len())
    }

    #[test]
    fn every_value_has_a_separate_place() {
        assert_eq!(values(3, 1, 10, 3).unwrap(), 30);
        assert_eq!(values(4, 1, 10, 3).unwrap(), 39);
        assert_eq!(values(1, 10, 10, 3).unwrap(), 30);
        assert_eq!(values(1, 0, 10, 1).unwrap(), 10);
        assert_eq!(values(0, 1, 1, 3).unwrap(), 3);
        assert_eq!(values(0, 0, 0, 3).unwrap(), 0);
        assert_eq!(values(0, 0, 1, 1).unwrap(), 1);
        for (query, channel, count, channels) in
            [(2, 1, 10, 3), (1, 9, 10, 3), (3, 0, 10, 3), (0, 1, 2, 3), (0, 0, 1, 2), (0, 0, 2, 1), (1, 1, 2, 2)]
        {
            assert!(values(query, channel, count, channels).is_err(), "{query} {channel} {count} {channels}");
        }
    }

    #[test]
    fn strides_beyond_memory_are_errors() {
        let numbers = [0.0_f32; 3];
        let [x, y, z] = [0, 1, 2].map(|k| numbers[k..].as_ptr());
        let far = lobe_directions { x, y, z, stride: usize::MAX / 2 };
        // SAFETY: nothing is read.
        assert!(unsafe { far.readable(4, "wi") }.is_err());
        let none = lobe_directions { x: std::ptr::null(), y: std::ptr::null(), z: std::ptr::null(), stride: 3 };
        // SAFETY: nothing is read.
        unsafe {
            assert!(none.readable(1, "wi").is_err());
            assert!(none.readable(0, "wi").is_ok());
        }
    }

    #[test]
    fn layouts_of_kernels_are_not_copied() {
        let numbers: Vec<f32> = (0..24).map(|i| i as f32).collect();
        let at = |k: usize| numbers[k..].as_ptr();
        let cases = [
            (lobe_directions { x: at(0), y: at(1), z: at(2), stride: 3 }, true, [3.0, 4.0, 5.0]),
            (lobe_directions { x: at(0), y: at(8), z: at(16), stride: 1 }, true, [1.0, 9.0, 17.0]),
            (lobe_directions { x: at(0), y: at(1), z: at(2), stride: 4 }, false, [4.0, 5.0, 6.0]),
            (lobe_directions { x: at(2), y: at(1), z: at(0), stride: 3 }, false, [5.0, 4.0, 3.0]),
            (lobe_directions { x: at(7), y: at(8), z: at(9), stride: 0 }, false, [7.0, 8.0, 9.0]),
        ];
        for (directions, is_placed, second) in cases {
            // SAFETY: two directions, or four, are within the vector.
            let readable = unsafe { directions.readable(2, "wi") }.unwrap();
            assert_eq!(readable.placed().is_some(), is_placed);
            assert_eq!(readable.get(1), second);
            let mut copied = [[0.0; 3]];
            readable.copy(1, &mut copied);
            assert_eq!(copied, [second]);
        }
    }
}
