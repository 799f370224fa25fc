//! A pair of directions, with the quantities that models need.

/// Two directions above the surface, normal on +z, and their half vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Geometry {
    /// To the light.
    pub wi: [f64; 3],
    /// To the viewer.
    pub wo: [f64; 3],
    /// The half vector, of unit length.
    pub h: [f64; 3],
    /// The cosine of the angle between either direction and `h`.
    pub cos_d: f64,
}

impl Geometry {
    /// The pair of two unit vectors with z > 0.
    pub fn new(wi: [f64; 3], wo: [f64; 3]) -> Self {
        let sum = [wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]];
        let length = sum.iter().map(|c| c * c).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
        let h = sum.map(|c| c / length);
        // wi and wo have the same cosine with h, and together they are `length` along it.
        Geometry { wi, wo, h, cos_d: (0.5 * length).min(1.0) }
    }

    /// The cosine of the polar angle of the light.
    pub fn cos_i(&self) -> f64 {
        self.wi[2]
    }

    /// The cosine of the polar angle of the viewer.
    pub fn cos_o(&self) -> f64 {
        self.wo[2]
    }

    /// The distance of the viewer from the mirror direction in direction cosines, `|beta - beta_0|`.
    pub fn off_mirror(&self) -> f64 {
        (self.wi[0] + self.wo[0]).hypot(self.wi[1] + self.wo[1])
    }
}
