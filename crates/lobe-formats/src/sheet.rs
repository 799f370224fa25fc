//! Files that hold more than one measurement of a material: reflection and transmission, or both sides of a sheet.

use lobe_table::{Channels, Scatter, scattered, specular, spherical};

use crate::Specular;

/// A side of a sheet: the front is that of z > 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// z > 0.
    Front,
    /// z < 0.
    Back,
}

/// One measurement of a sheet.
#[derive(Clone, Debug)]
pub struct Part {
    /// The name in the file; may be empty.
    pub name: String,
    /// The side from which the light comes; `None` where the file does not tell the sides apart.
    pub side: Option<Side>,
    /// The values.
    pub data: Data,
}

impl Part {
    /// A part of a file that does not tell the sides apart.
    pub fn new(name: impl Into<String>, data: Data) -> Self {
        Part { name: name.into(), side: None, data }
    }
}

/// The values of a measurement, as they were measured.
#[derive(Clone, Debug)]
pub enum Data {
    /// A BRDF or BTDF on a grid of specular coordinates.
    Table(specular::Data),
    /// A BRDF or BTDF on a grid of spherical coordinates.
    Spherical(spherical::Data),
    /// A BRDF or BTDF on no grid.
    Scattered(scattered::Data),
    /// The mirror reflectance, or the transmittance straight through.
    Specular(Specular),
}

impl Data {
    /// Reflection or transmission.
    pub fn scatter(&self) -> Scatter {
        match self {
            Data::Table(data) => data.scatter(),
            Data::Spherical(data) => data.scatter(),
            Data::Scattered(data) => data.scatter(),
            Data::Specular(data) => data.scatter(),
        }
    }

    /// What the channels stand for.
    pub fn channels(&self) -> &Channels {
        match self {
            Data::Table(data) => data.channels(),
            Data::Spherical(data) => data.channels(),
            Data::Scattered(data) => data.channels(),
            Data::Specular(data) => data.channels(),
        }
    }
}

/// What light does that is reflected, and what it does that passes through, whatever the side that it comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Sides<T> {
    /// Both directions on the same side, if the file has it.
    pub reflection: Option<T>,
    /// The directions on opposite sides, if the file has it.
    pub transmission: Option<T>,
}

impl<T> Sides<T> {
    /// The parts as those of a sheet.
    pub fn into_parts(self, data: impl Fn(T) -> Data) -> Vec<Part> {
        [self.reflection, self.transmission].into_iter().flatten().map(|part| Part::new("", data(part))).collect()
    }
}
