//! Mueller matrices for each channel of a picture.

/// A Mueller matrix for each channel, `[row][column][channel]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mueller<const N: usize> {
    /// The elements.
    pub elements: [[[f32; N]; 4]; 4],
    /// `true` if only the first element is not 0, so that outgoing light is unpolarised.
    pub depolarises: bool,
}

impl<const N: usize> Mueller<N> {
    /// The identity, which does not change light.
    pub(super) const IDENTITY: Self = {
        let mut elements = [[[0.0; N]; 4]; 4];
        let mut k = 0;
        while k < 4 {
            elements[k][k] = [1.0; N];
            k += 1;
        }
        Mueller { elements, depolarises: false }
    };

    /// An ideal depolariser, which makes all light unpolarised.
    pub fn depolarising(first: [f32; N]) -> Self {
        let mut elements = [[[0.0; N]; 4]; 4];
        elements[0][0] = first;
        Mueller { elements, depolarises: true }
    }

    pub(super) fn scaled(mut self, factor: f32) -> Self {
        if self.depolarises {
            self.elements[0][0].iter_mut().for_each(|x| *x *= factor);
        } else {
            self.elements.as_flattened_mut().as_flattened_mut().iter_mut().for_each(|x| *x *= factor);
        }
        self
    }

    /// This matrix applied after another one.
    pub(super) fn after(&self, first: &Self) -> Self {
        let mut elements = [[[0.0; N]; 4]; 4];
        let columns = if first.depolarises { 1 } else { 4 };
        for (row, out) in self.elements.iter().zip(&mut elements) {
            for (column, out) in out.iter_mut().enumerate().take(columns) {
                for (factor, other) in row.iter().zip(&first.elements).take(if columns == 1 { 1 } else { 4 }) {
                    for ((out, a), b) in out.iter_mut().zip(factor).zip(&other[column]) {
                        *out += a * b;
                    }
                }
            }
        }
        Mueller { elements, depolarises: false }
    }

    /// The matrix with the incoming x axis rotated by half an angle, given by the cosine and sine of the angle.
    pub(super) fn turned_before(mut self, [cos, sin]: [f32; 2]) -> Self {
        for row in &mut self.elements {
            let (a, b) = (row[1], row[2]);
            for k in 0..N {
                row[1][k] = a[k] * cos - b[k] * sin;
                row[2][k] = a[k] * sin + b[k] * cos;
            }
        }
        self
    }

    /// The matrix with the outgoing x axis rotated by half an angle, given by the cosine and sine of the angle.
    pub(super) fn turned_after(mut self, [cos, sin]: [f32; 2]) -> Self {
        let (a, b) = (self.elements[1], self.elements[2]);
        for column in 0..4 {
            for k in 0..N {
                self.elements[1][column][k] = cos * a[column][k] + sin * b[column][k];
                self.elements[2][column][k] = cos * b[column][k] - sin * a[column][k];
            }
        }
        self
    }

    /// The same in frames of the other handedness.
    pub(super) fn mirrored(mut self) -> Self {
        for (i, row) in self.elements.iter_mut().enumerate() {
            for (j, element) in row.iter_mut().enumerate() {
                if (i < 2) != (j < 2) {
                    element.iter_mut().for_each(|x| *x = -*x);
                }
            }
        }
        self
    }
}
