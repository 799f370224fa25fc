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
    /// An ideal depolariser, which makes all light unpolarised.
    #[inline]
    pub fn depolarising(first: [f32; N]) -> Self {
        let mut elements = [[[0.0; N]; 4]; 4];
        elements[0][0] = first;
        Mueller { elements, depolarises: true }
    }

    #[inline]
    pub(super) fn scaled(mut self, factor: f32) -> Self {
        if self.depolarises {
            self.elements[0][0].iter_mut().for_each(|x| *x *= factor);
        } else {
            self.elements.as_flattened_mut().as_flattened_mut().iter_mut().for_each(|x| *x *= factor);
        }
        self
    }
}
