//! Names for the up to four measurements of a sheet: the sides that light comes from and leaves to.

use std::fmt;

use crate::Scatter;

/// A side of a sheet; the front is the side of z > 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// z > 0.
    Front,
    /// z < 0.
    Back,
}

impl Side {
    /// The side that a direction points to. Directions along the surface count as pointing to the back.
    pub fn of(direction: [f32; 3]) -> Side {
        if direction[2] > 0.0 { Side::Front } else { Side::Back }
    }

    /// The other side.
    pub fn opposite(self) -> Side {
        match self {
            Side::Front => Side::Back,
            Side::Back => Side::Front,
        }
    }
}

/// One of the up to four measurements of a sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Aspect {
    /// `true` if the light stays on its side.
    pub scatter: Scatter,
    /// The side that the light comes from; the front is the side of z > 0.
    pub light: Side,
}

impl Aspect {
    /// A BRDF, lit from the front.
    pub const REFLECTION: Aspect = Aspect { scatter: Scatter::Reflection, light: Side::Front };
    /// A BTDF, lit from the front.
    pub const TRANSMISSION: Aspect = Aspect { scatter: Scatter::Transmission, light: Side::Front };

    /// All four: reflection and transmission of light from the front, then of light from the back.
    pub const ALL: [Aspect; 4] = [
        Aspect::REFLECTION,
        Aspect::TRANSMISSION,
        Aspect { scatter: Scatter::Reflection, light: Side::Back },
        Aspect { scatter: Scatter::Transmission, light: Side::Back },
    ];

    /// The scatter of light that comes from the front.
    pub fn front(scatter: Scatter) -> Aspect {
        Aspect { scatter, light: Side::Front }
    }

    /// Moves two directions with z > 0 to the sides of this measurement, mirroring them about the surface if necessary.
    pub fn place(self, wi: [f64; 3], wo: [f64; 3]) -> ([f64; 3], [f64; 3]) {
        let below = |[x, y, z]: [f64; 3], is_below| [x, y, if is_below { -z } else { z }];
        let is_lit_below = self.light == Side::Back;
        (below(wi, is_lit_below), below(wo, is_lit_below != (self.scatter == Scatter::Transmission)))
    }

    /// The measurement for light on the reverse path.
    pub fn reversed(self) -> Aspect {
        let light = match self.scatter {
            Scatter::Reflection => self.light,
            Scatter::Transmission => self.light.opposite(),
        };
        Aspect { light, ..self }
    }
}

impl fmt::Display for Aspect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match (self.scatter, self.light) {
            (Scatter::Reflection, Side::Front) => "reflection front",
            (Scatter::Reflection, Side::Back) => "reflection back",
            (Scatter::Transmission, Side::Front) => "transmission front",
            (Scatter::Transmission, Side::Back) => "transmission back",
        })
    }
}
