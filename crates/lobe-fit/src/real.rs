//! Numbers with derivatives.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// The number type of formulas: a number, or a number with its derivatives.
pub(crate) trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// A constant.
    fn of(value: f64) -> Self;
    /// The number itself.
    fn value(self) -> f64;
    /// A function of one number, from its value and its derivative there.
    fn chain(self, value: f64, derivative: f64) -> Self;

    fn exp(self) -> Self {
        let exp = self.value().exp();
        self.chain(exp, exp)
    }

    fn ln(self) -> Self {
        self.chain(self.value().ln(), self.value().recip())
    }

    fn sqrt(self) -> Self {
        let root = self.value().sqrt();
        self.chain(root, 0.5 / root)
    }

    fn recip(self) -> Self {
        let recip = self.value().recip();
        self.chain(recip, -recip * recip)
    }

    fn square(self) -> Self {
        self * self
    }

    /// A power of a number that is not negative.
    fn powf(self, exponent: Self) -> Self {
        if self.value() > 0.0 { (exponent * self.ln()).exp() } else { Self::of(0.0) }
    }

    /// `1 - self`.
    fn rest(self) -> Self {
        -self + 1.0
    }

    /// Interpolates from `self` to `other` by the share `t`.
    fn lerp(self, other: Self, t: Self) -> Self {
        self + (other - self) * t
    }
}

impl Real for f64 {
    fn of(value: f64) -> Self {
        value
    }

    fn value(self) -> f64 {
        self
    }

    fn chain(self, value: f64, _: f64) -> Self {
        value
    }
}

/// The most parameters that a model has for one channel.
pub(crate) const MOST: usize = 8;

/// A value and its derivatives by up to [`MOST`] parameters: forward automatic differentiation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dual {
    pub value: f64,
    pub slopes: [f64; MOST],
}

impl Dual {
    /// The parameter at an index.
    pub fn parameter(value: f64, index: usize) -> Self {
        let mut slopes = [0.0; MOST];
        slopes[index] = 1.0;
        Dual { value, slopes }
    }

    fn combine(self, other: Self, value: f64, a: f64, b: f64) -> Self {
        let mut slopes = [0.0; MOST];
        for (index, slope) in slopes.iter_mut().enumerate() {
            *slope = a * self.slopes[index] + b * other.slopes[index];
        }
        Dual { value, slopes }
    }
}

impl Real for Dual {
    fn of(value: f64) -> Self {
        Dual { value, slopes: [0.0; MOST] }
    }

    fn value(self) -> f64 {
        self.value
    }

    fn chain(self, value: f64, derivative: f64) -> Self {
        Dual { value, slopes: self.slopes.map(|slope| slope * derivative) }
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.combine(other, self.value + other.value, 1.0, 1.0)
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.combine(other, self.value - other.value, 1.0, -1.0)
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.combine(other, self.value * other.value, other.value, self.value)
    }
}

impl Div for Dual {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        self.combine(other, quotient, other.value.recip(), -quotient / other.value)
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl Add<f64> for Dual {
    type Output = Self;
    fn add(self, other: f64) -> Self {
        Dual { value: self.value + other, ..self }
    }
}

impl Sub<f64> for Dual {
    type Output = Self;
    fn sub(self, other: f64) -> Self {
        Dual { value: self.value - other, ..self }
    }
}

impl Mul<f64> for Dual {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        self.chain(self.value * other, other)
    }
}

impl Div<f64> for Dual {
    type Output = Self;
    fn div(self, other: f64) -> Self {
        self.chain(self.value / other, other.recip())
    }
}
