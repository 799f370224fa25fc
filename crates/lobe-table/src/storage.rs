//! Floats that begin on a cache line.

/// Bytes of a cache line.
const LINE: usize = 64;

/// A fixed run of floats whose first lies on a cache line, so that a texel never straddles two.
#[derive(Debug)]
pub(crate) struct Storage {
    buffer: Vec<f32>,
    start: usize,
    len: usize,
}

impl Storage {
    /// `len` zeros.
    pub(crate) fn zeros(len: usize) -> Self {
        let buffer = vec![0.0f32; len + LINE / size_of::<f32>()];
        let start = buffer.as_ptr().align_offset(LINE).min(buffer.len() - len);
        Storage { buffer, start, len }
    }

    #[inline(always)]
    pub(crate) fn as_slice(&self) -> &[f32] {
        &self.buffer[self.start..][..self.len]
    }

    pub(crate) fn as_mut_slice(&mut self) -> &mut [f32] {
        &mut self.buffer[self.start..][..self.len]
    }

    /// Bytes of memory that this holds.
    pub(crate) fn bytes(&self) -> usize {
        self.buffer.capacity() * size_of::<f32>()
    }
}

impl Clone for Storage {
    fn clone(&self) -> Self {
        let mut copy = Storage::zeros(self.len);
        copy.as_mut_slice().copy_from_slice(self.as_slice());
        copy
    }
}
