//! Vectors that are not contiguous `float32`: with gaps, backward, repeated, or in `float64`.

use numpy::ndarray::{ArrayViewD, Axis, Ix2};

/// A number that is rounded to `f32` once.
pub trait Component: Copy {
    fn single(self) -> f32;
}

impl Component for f32 {
    fn single(self) -> f32 {
        self
    }
}

impl Component for f64 {
    fn single(self) -> f32 {
        self as f32
    }
}

/// Vectors along the last axis of a view.
pub struct Strided<'a, T> {
    /// At least two axes; axes that can be walked as one are merged.
    view: ArrayViewD<'a, T>,
    count: usize,
}

impl<'a, T: Component> Strided<'a, T> {
    /// Takes a view of at least one axis.
    pub fn new(mut view: ArrayViewD<'a, T>) -> Self {
        if view.ndim() == 1 {
            view = view.insert_axis(Axis(0));
        }
        let count = view.shape()[..view.ndim() - 1].iter().product();
        for take in (0..view.ndim() - 2).rev() {
            if count > 0 && view.merge_axes(Axis(take), Axis(take + 1)) {
                view = view.index_axis_move(Axis(take), 0);
            }
        }
        Strided { view, count }
    }

    /// The number of vectors.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Copies vectors to `out`, beginning with vector `from`.
    ///
    /// # Panics
    /// If there are too few vectors, or they have fewer components.
    pub fn copy<const N: usize>(&self, from: usize, out: &mut [[f32; N]]) {
        self.convert(from, out, T::single);
    }

    /// Like [`copy`](Self::copy), but converts components with `single`.
    ///
    /// # Panics
    /// The same as for [`copy`](Self::copy).
    pub fn convert<const N: usize>(&self, from: usize, mut out: &mut [[f32; N]], single: impl Fn(T) -> f32 + Copy) {
        let innermost = self.view.ndim() - 2;
        let length = self.view.len_of(Axis(innermost));
        let mut at = from;
        while !out.is_empty() {
            let (mut outer, start) = (at / length, at % length);
            let count = out.len().min(length - start);
            let mut run = self.view.view();
            for axis in (0..innermost).rev() {
                let length = run.len_of(Axis(axis));
                run = run.index_axis_move(Axis(axis), outer % length);
                outer /= length;
            }
            assert_eq!(outer, 0, "vector {at} of {}", self.count);
            let run = run.into_dimensionality::<Ix2>().expect("a run of vectors");
            let (now, rest) = out.split_at_mut(count);
            match run.to_slice() {
                Some(values) => {
                    let vectors = &values.as_chunks::<N>().0[start..start + count];
                    for (to, vector) in now.iter_mut().zip(vectors) {
                        *to = vector.map(single);
                    }
                }
                None if run.strides()[0] == 0 => {
                    now.fill(std::array::from_fn(|k| single(run[[0, k]])));
                }
                None => {
                    for (index, to) in now.iter_mut().enumerate() {
                        *to = std::array::from_fn(|k| single(run[[start + index, k]]));
                    }
                }
            }
            at += count;
            out = rest;
        }
    }
}
