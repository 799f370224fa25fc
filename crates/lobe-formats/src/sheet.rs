//! Files with both reflection and transmission.

use lobe_table::Data;

use crate::Part;

/// Reflection and transmission, for light from either side.
#[derive(Clone, Debug, PartialEq)]
pub struct Sides<T> {
    /// Both directions on the same side, if the file has it.
    pub reflection: Option<T>,
    /// The directions on opposite sides, if the file has it.
    pub transmission: Option<T>,
}

impl<T: Into<Data>> Sides<T> {
    /// The parts of a document.
    pub fn into_parts(self) -> Vec<Part> {
        [self.reflection, self.transmission].into_iter().flatten().map(|part| Part::new("", part)).collect()
    }
}
