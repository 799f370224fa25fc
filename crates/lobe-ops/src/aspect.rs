//! Which of the measurements of a sheet is meant: the sides that the light comes from and leaves to.

use std::fmt;

use lobe_formats::sheet::Side;
use lobe_table::Scatter;

/// One of up to four measurements of a sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Aspect {
    /// Whether the light stays on its side.
    pub scatter: Scatter,
    /// The side that the light comes from; the front is that of z > 0.
    pub light: Side,
}

impl Aspect {
    /// A BRDF, lit from the front.
    pub const REFLECTION: Aspect = Aspect { scatter: Scatter::Reflection, light: Side::Front };
    /// A BTDF, lit from the front.
    pub const TRANSMISSION: Aspect = Aspect { scatter: Scatter::Transmission, light: Side::Front };

    /// Moves two directions with z > 0 to the sides of this measurement, mirrored at the surface where they have to be.
    pub fn place(self, wi: [f64; 3], wo: [f64; 3]) -> ([f64; 3], [f64; 3]) {
        let below = |[x, y, z]: [f64; 3], is_below| [x, y, if is_below { -z } else { z }];
        let is_lit_below = self.light == Side::Back;
        (below(wi, is_lit_below), below(wo, is_lit_below != (self.scatter == Scatter::Transmission)))
    }

    /// The measurement that light takes on its way back.
    pub fn reversed(self) -> Aspect {
        let light = match (self.scatter, self.light) {
            (Scatter::Reflection, light) => light,
            (Scatter::Transmission, Side::Front) => Side::Back,
            (Scatter::Transmission, Side::Back) => Side::Front,
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
