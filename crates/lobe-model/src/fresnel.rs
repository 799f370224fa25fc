//! Fresnel's equations with phases: the effect of a smooth surface on polarised light.
//!
//! The time dependence is `exp(-i omega t)`, so an absorbing medium has the index `n + i k` with `k > 0`. The x axis of
//! the Stokes frames is the normal of the plane of incidence, before and after; see M. Born and E. Wolf, *Principles of
//! optics*, 1.5 and 14.2 (7th edition). S3 is positive for right circular light, whose field turns clockwise as seen by
//! the receiver: with y across x and the direction in which light travels, it is `2 Im(E_x conj(E_y))`.

/// A complex number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Complex {
    pub(crate) re: f64,
    pub(crate) im: f64,
}

impl Complex {
    pub(crate) fn times(self, other: Self) -> Self {
        Complex { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }

    pub(crate) fn scaled(self, factor: f64) -> Self {
        Complex { re: self.re * factor, im: self.im * factor }
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Complex { re: self.re + other.re, im: self.im + other.im }
    }

    pub(crate) fn minus(self, other: Self) -> Self {
        self.plus(other.scaled(-1.0))
    }

    pub(crate) fn over(self, other: Self) -> Self {
        self.times(other.conjugate()).scaled(1.0 / other.norm())
    }

    pub(crate) fn conjugate(self) -> Self {
        Complex { re: self.re, im: -self.im }
    }

    /// The squared magnitude.
    pub(crate) fn norm(self) -> f64 {
        self.re * self.re + self.im * self.im
    }

    /// The square root whose imaginary part is not negative: a decaying wave.
    pub(crate) fn root(self) -> Self {
        let size = self.norm().sqrt();
        let re = (0.5 * (size + self.re)).max(0.0).sqrt();
        let im = (0.5 * (size - self.re)).max(0.0).sqrt();
        Complex { re: if self.im < 0.0 { -re } else { re }, im }
    }
}

/// The effect of a surface on Stokes vectors: the Mueller matrix `[[a, b, 0, 0], [b, a, 0, 0], [0, 0, c, s], [0, 0, -s,
/// c]]`, with the normal of the plane of incidence as the x axis of the frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elements {
    /// The share of unpolarised light.
    pub a: f64,
    /// The excess for light polarised perpendicular to the plane of incidence over light polarised in it.
    pub b: f64,
    /// The remaining share of diagonal and of circular light.
    pub c: f64,
    /// The share converted from one of these into the other.
    pub s: f64,
}

impl Elements {
    /// The matrix, `[row][column]`.
    pub fn matrix(&self) -> [[f64; 4]; 4] {
        let Elements { a, b, c, s } = *self;
        [[a, b, 0.0, 0.0], [b, a, 0.0, 0.0], [0.0, 0.0, c, s], [0.0, 0.0, -s, c]]
    }

    pub(crate) fn of(perpendicular: Complex, parallel: Complex) -> Self {
        let (rs, rp) = (perpendicular.norm(), parallel.norm());
        let mixed = perpendicular.times(parallel.conjugate());
        Elements { a: 0.5 * (rs + rp), b: 0.5 * (rs - rp), c: mixed.re, s: -mixed.im }
    }
}

/// Reflection at a surface and transmission through it, as shares of the energy; `eta + i k` is the relative index
/// behind the surface. There is no transmission into an absorbing medium, or at total reflection.
pub fn fresnel(cos: f64, eta: f64, k: f64) -> (Elements, Elements) {
    let cos = cos.clamp(0.0, 1.0);
    let index = Complex { re: eta, im: k };
    let index2 = index.times(index);
    let sin2 = 1.0 - cos * cos;
    // The normal component of the wave vector behind the surface, relative to the length of the one in front: n_t
    // cos_t.
    let through = index2.plus(Complex { re: -sin2, im: 0.0 }).root();
    let front = Complex { re: cos, im: 0.0 };
    let perpendicular = front.minus(through).over(front.plus(through));
    let dense = index2.scaled(cos);
    let parallel = dense.minus(through).over(dense.plus(through));
    let mirrored = Elements::of(perpendicular, parallel);
    let (ts, tp) = (1.0 - perpendicular.norm(), 1.0 - parallel.norm());
    let passes = k == 0.0 && eta * eta > sin2;
    let passed = if passes {
        Elements { a: 0.5 * (ts + tp), b: 0.5 * (ts - tp), c: (ts * tp).max(0.0).sqrt(), s: 0.0 }
    } else {
        Elements { a: 0.0, b: 0.0, c: 0.0, s: 0.0 }
    };
    (mirrored, passed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reflection_at_brewsters_angle_is_polarised() {
        for eta in [1.33f64, 1.5, 2.4] {
            let angle = eta.atan();
            let (mirrored, passed) = fresnel(angle.cos(), eta, 0.0);
            assert!((mirrored.b / mirrored.a - 1.0).abs() < 1e-12 && mirrored.c.abs() < 1e-12, "{mirrored:?}");
            assert!((mirrored.a + passed.a - 1.0).abs() < 1e-12 && (mirrored.b + passed.b).abs() < 1e-12);
        }
    }

    /// Two total reflections at 54.6 degrees in glass of 1.51 delay one part of the light by a quarter of a wave.
    #[test]
    fn fresnels_rhomb_makes_circular_light() {
        let at = |angle: f64| fresnel(angle.cos(), 1.0 / 1.51, 0.0).0;
        let delay = |angle: f64| at(angle).s.atan2(at(angle).c).abs();
        // Beyond 51 degrees the delay falls.
        let (mut low, mut high) = (51.8f64.to_radians(), 60.0f64.to_radians());
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if delay(middle) > 0.25 * std::f64::consts::PI { low = middle } else { high = middle }
        }
        assert!((low.to_degrees() - 54.62).abs() < 0.01, "{}", low.to_degrees());
        // Light at 45 degrees to the plane of incidence, twice.
        let Elements { a, b, c, s } = at(low);
        let once = |[s0, s1, s2, s3]: [f64; 4]| [a * s0 + b * s1, b * s0 + a * s1, c * s2 + s * s3, c * s3 - s * s2];
        let light = once(once([1.0, 0.0, 1.0, 0.0]));
        // The part across the plane of incidence, along x, is delayed more (Born and Wolf, 1.5.4), by a quarter of a
        // wave, so the field turns from y to x, clockwise as seen by the receiver: right circular light.
        assert!((light[3] - 1.0).abs() < 1e-9 && light[2].abs() < 1e-9 && light[1].abs() < 1e-9, "{light:?}");
        assert!((light[0] - 1.0).abs() < 1e-12, "nothing is lost");
    }

    #[test]
    fn unpolarised_light_gives_the_scalar_reflectance() {
        for (eta, k) in [(0.143, 3.983), (1.5, 0.0), (2.0, 1.0)] {
            for cos in [1.0, 0.8, 0.4, 0.05] {
                let expected = crate::fresnel_conductor(cos, eta, k);
                assert!((fresnel(cos, eta, k).0.a - expected).abs() < 1e-12, "{eta} {k} {cos}");
            }
        }
        // At the normal, both parts are equal, with opposite signs in these frames.
        let (mirrored, _) = fresnel(1.0, 1.5, 0.0);
        assert!((mirrored.c + mirrored.a).abs() < 1e-12 && mirrored.b.abs() < 1e-12);
    }
}
