//! The destinations of the values of a PLY file.

use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

/// Numbers of a vertex, in the order of [`slot`].
#[derive(Debug)]
pub(super) struct Vertex([f32; 12]);

/// Place of a property among the numbers of a vertex: position, normal, texture coordinates, tangent.
fn slot(name: &str) -> Option<usize> {
    Some(match name {
        "x" => 0,
        "y" => 1,
        "z" => 2,
        "nx" => 3,
        "ny" => 4,
        "nz" => 5,
        "u" | "s" | "texture_u" | "texture_s" => 6,
        "v" | "t" | "texture_v" | "texture_t" => 7,
        "tx" => 8,
        "ty" => 9,
        "tz" => 10,
        "tw" => 11,
        _ => return None,
    })
}

impl Vertex {
    /// The slots filled by properties of these names.
    pub fn present<'a>(names: impl Iterator<Item = &'a str>) -> [bool; 12] {
        let mut present = [false; 12];
        names.filter_map(slot).for_each(|slot| present[slot] = true);
        present
    }

    /// `N` slots from `first` on.
    pub fn slots<const N: usize>(&self, first: usize) -> [f32; N] {
        std::array::from_fn(|i| self.0[first + i])
    }
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Vertex([0.0; 12])
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        match (slot(name), property.to_f32_lossy()) {
            (Some(slot), Some(value)) => {
                self.0[slot] = value;
                PropertyAccessResult::Set
            }
            (Some(_), None) => PropertyAccessResult::UnsupportedType,
            (None, _) => PropertyAccessResult::Ignored,
        }
    }
}

/// A polygon and its group.
#[derive(Debug)]
pub(super) struct Face {
    pub corners: Vec<u32>,
    pub group: u32,
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Face { corners: Vec::new(), group: 0 }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        match (name, property) {
            // Indices that are negative or not whole leave a face without corners, which is reported with its number.
            ("vertex_indices" | "vertex_index", property) => self.corners = property.to_u32_list().unwrap_or_default(),
            ("group", Property::UChar(group)) => self.group = group.into(),
            ("group", Property::UInt(group)) => self.group = group,
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}

/// Strips of triangles one after the other, each ended by an index below 0.
#[derive(Debug)]
pub(super) struct Strips {
    /// `None` ends a strip.
    pub corners: Vec<Option<u32>>,
    /// `true` if the indices were whole numbers.
    pub is_sound: bool,
}

impl PropertyAccess for Strips {
    fn new() -> Self {
        Strips { corners: Vec::new(), is_sound: false }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if !matches!(name, "vertex_indices" | "vertex_index") {
            return PropertyAccessResult::Ignored;
        }
        let signed = match property {
            Property::ListChar(corners) => Some(corners.into_iter().map(|corner| u32::try_from(corner).ok()).collect()),
            Property::ListShort(corners) => {
                Some(corners.into_iter().map(|corner| u32::try_from(corner).ok()).collect())
            }
            Property::ListInt(corners) => Some(corners.into_iter().map(|corner| u32::try_from(corner).ok()).collect()),
            // Without a sign there is one strip.
            other => other.to_u32_list().map(|corners| corners.into_iter().map(Some).collect()),
        };
        self.is_sound = signed.is_some();
        self.corners = signed.unwrap_or_default();
        PropertyAccessResult::Set
    }
}

impl Strips {
    /// The triangles, all turned as the first of their strip, without those of two equal corners, which only lead from
    /// one strip to the next.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        let strips = self.corners.split(|corner| corner.is_none());
        strips.flat_map(|strip| {
            strip.windows(3).enumerate().filter_map(|(number, corners)| {
                let &[Some(a), Some(b), Some(c)] = corners else { return None };
                let is_narrow = a == b || b == c || c == a;
                (!is_narrow).then_some(if number % 2 == 0 { [a, b, c] } else { [b, a, c] })
            })
        })
    }
}

/// An element that is not needed.
#[derive(Debug)]
pub(super) struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Skipped
    }
}
