//! Reads numbers from buffers (sections 3.6.1 and 3.6.2). Nothing here trusts an offset or a count.

use lobe_files::FormatError;

use super::document::{Accessor, Region};
use super::{Budget, Source};
use crate::file::wrong;

/// How a number is stored.
#[derive(Clone, Copy)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(code: u32) -> Option<Component> {
        Some(match code {
            5120 => Component::I8,
            5121 => Component::U8,
            5122 => Component::I16,
            5123 => Component::U16,
            5125 => Component::U32,
            5126 => Component::F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 => 4,
        }
    }

    /// The number in the first bytes of a slice, which must be long enough; `normalized` integers are shares of the
    /// largest.
    fn number(self, bytes: &[u8], normalized: bool) -> f64 {
        let (number, largest) = match self {
            Component::I8 => (f64::from(bytes[0] as i8), 127.0),
            Component::U8 => (f64::from(bytes[0]), 255.0),
            Component::I16 => (f64::from(i16::from_le_bytes([bytes[0], bytes[1]])), 32767.0),
            Component::U16 => (f64::from(u16::from_le_bytes([bytes[0], bytes[1]])), 65535.0),
            Component::U32 => (f64::from(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])), 1.0),
            Component::F32 => (f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])), 1.0),
        };
        if normalized { (number / largest).max(-1.0) } else { number }
    }
}

impl Source<'_> {
    /// An attribute: vectors of `N` numbers.
    pub fn vectors<const N: usize>(&self, index: usize, budget: &mut Budget<'_>) -> Result<Vec<[f32; N]>, FormatError> {
        let shape = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        let vectors = self.numbers::<N>(index, shape, budget)?;
        Ok(vectors.into_iter().map(|vector| vector.map(|number| number as f32)).collect())
    }

    /// Indices of vertices.
    pub fn indices(&self, index: usize, budget: &mut Budget<'_>) -> Result<Vec<u32>, FormatError> {
        let accessor = self.item(&self.document.accessors, index, "accessor")?;
        if !matches!(accessor.component_type, 5121 | 5123 | 5125) {
            let found = format!("component type {} in accessor {index}", accessor.component_type);
            return Err(wrong(self.path, found, "5121, 5123 or 5125 for indices"));
        }
        if accessor.normalized {
            return Err(wrong(self.path, format!("normalized indices in accessor {index}"), "integers as they are"));
        }
        // Doubles hold every index exactly.
        Ok(self.numbers::<1>(index, "SCALAR", budget)?.into_iter().map(|[number]| number as u32).collect())
    }

    pub fn numbers<const N: usize>(
        &self,
        index: usize,
        shape: &str,
        budget: &mut Budget<'_>,
    ) -> Result<Vec<[f64; N]>, FormatError> {
        let accessor = self.item(&self.document.accessors, index, "accessor")?;
        if accessor.shape != shape {
            return Err(wrong(self.path, format!("{} in accessor {index}", accessor.shape), shape));
        }
        let component = self.component(accessor.component_type, index)?;
        budget.take(accessor.count, size_of::<[f64; N]>())?;
        let mut numbers = match accessor.buffer_view {
            Some(view) => {
                self.run(view, accessor.byte_offset, component, accessor.normalized, accessor.count, index)?
            }
            None => vec![[0.0; N]; accessor.count],
        };
        self.replace(accessor, component, index, &mut numbers)?;
        Ok(numbers)
    }

    /// Puts the values of a sparse accessor in their places.
    fn replace<const N: usize>(
        &self,
        accessor: &Accessor,
        component: Component,
        index: usize,
        numbers: &mut [[f64; N]],
    ) -> Result<(), FormatError> {
        let Some(sparse) = &accessor.sparse else { return Ok(()) };
        let Region { buffer_view, byte_offset, component_type } = sparse.indices;
        let places = match component_type {
            Some(code @ (5121 | 5123 | 5125)) => self.component(code, index)?,
            other => {
                let found = format!("component type {} of sparse indices in accessor {index}", other.unwrap_or(0));
                return Err(wrong(self.path, found, "5121, 5123 or 5125"));
            }
        };
        let places = self.run::<1>(buffer_view, byte_offset, places, false, sparse.count, index)?;
        let Region { buffer_view, byte_offset, .. } = sparse.values;
        let values = self.run(buffer_view, byte_offset, component, accessor.normalized, sparse.count, index)?;
        for ([place], value) in places.into_iter().zip(values) {
            match numbers.get_mut(place as usize) {
                Some(number) => *number = value,
                None => {
                    let found = format!("sparse index {place} in accessor {index}");
                    return Err(wrong(self.path, found, format!("less than {}", accessor.count)));
                }
            }
        }
        Ok(())
    }

    /// `count` vectors from a view, all of which are in range.
    fn run<const N: usize>(
        &self,
        view: usize,
        offset: usize,
        component: Component,
        normalized: bool,
        count: usize,
        accessor: usize,
    ) -> Result<Vec<[f64; N]>, FormatError> {
        let number = view;
        let view = self.item(&self.document.buffer_views, view, "bufferView")?;
        let buffer = self.item(self.buffers, view.buffer, "buffer")?;
        let end = view.byte_offset.checked_add(view.byte_length);
        let Some(bytes) = end.and_then(|end| buffer.get(view.byte_offset..end)) else {
            let found = format!("{} bytes from {} on in bufferView {number}", view.byte_length, view.byte_offset);
            return Err(wrong(self.path, found, format!("a part of buffer {} of {} bytes", view.buffer, buffer.len())));
        };
        let size = N * component.size();
        let stride = view.byte_stride.unwrap_or(size);
        if stride < size {
            let found = format!("a byteStride of {stride} in bufferView {number}");
            return Err(wrong(self.path, found, format!("{size} or more for accessor {accessor}")));
        }
        let needed =
            count.saturating_sub(1).checked_mul(stride).and_then(|last| last.checked_add(offset)?.checked_add(size));
        if count > 0 && needed.is_none_or(|needed| needed > bytes.len()) {
            let found = format!("{count} elements from byte {offset} on in accessor {accessor}");
            return Err(wrong(
                self.path,
                found,
                format!("as many as fit in {} bytes of bufferView {number}", bytes.len()),
            ));
        }
        let vector = |i: usize| {
            let start = offset + i * stride;
            std::array::from_fn(|k| component.number(&bytes[start + k * component.size()..], normalized))
        };
        Ok((0..count).map(vector).collect())
    }

    fn component(&self, code: u32, accessor: usize) -> Result<Component, FormatError> {
        let found = || wrong(self.path, format!("component type {code} in accessor {accessor}"), "5120 to 5126");
        Component::of(code).ok_or_else(found)
    }

    /// An item of one of the lists of a document.
    pub fn item<'b, T>(&self, list: &'b [T], index: usize, name: &str) -> Result<&'b T, FormatError> {
        let found =
            || wrong(self.path, format!("{name} {index}"), format!("less than {}, the number of entries", list.len()));
        list.get(index).ok_or_else(found)
    }
}
