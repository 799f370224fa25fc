//! What a path from the camera does to polarised light.

use super::{Bounce, Mueller, Polarisation};
use crate::vec3::{Vec3, add, cross, dot, neg, scale};

/// The first `R` rows of a Mueller matrix for each channel: the Stokes components that a film sums, of light that
/// arrives at the other end of a path. The x axis of that light is `stokes_basis` of its direction in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rows<const R: usize, const N: usize> {
    /// The elements, `[row][column][channel]`.
    pub(super) elements: [[[f32; N]; 4]; R],
    /// `true` if only the first column is not 0: after a surface that depolarises, only the energy of light matters.
    pub(super) counts_energy: bool,
}

/// The Stokes components of light, in each channel.
type Stokes<const N: usize> = [[f32; N]; 4];

/// Cosine and sine of twice an angle.
type Turn = [f32; 2];

/// The x axis of light that travels along a unit direction: the first tangent of Duff et al. 2017, as
/// [`lobe_table::mueller::stokes_basis`].
pub(super) fn stokes_basis([x, y, z]: Vec3) -> Vec3 {
    let sign = 1.0f32.copysign(z);
    let a = -1.0 / (sign + z);
    [1.0 + sign * x * x * a, sign * x * y * a, -sign * x]
}

/// Cosine and sine of twice the angle from one x axis to another, about the direction in which light travels.
pub(super) fn doubled(forward: Vec3, from: Vec3, to: Vec3) -> Turn {
    let (cos, sin) = (dot(from, to), dot(forward, cross(from, to)));
    let size = cos * cos + sin * sin;
    if size > 0.0 { [(cos * cos - sin * sin) / size, 2.0 * cos * sin / size] } else { [1.0, 0.0] }
}

fn in_world(frame: &[Vec3; 3], local: Vec3) -> Vec3 {
    add(add(scale(frame[0], local[0]), scale(frame[1], local[1])), scale(frame[2], local[2]))
}

/// How the frames of a matrix differ from those of the world.
struct Turns {
    /// From the x axis of incoming light in the world to that of the matrix.
    before: Turn,
    /// From the x axis of outgoing light of the matrix to that in the world.
    after: Turn,
    /// The handedness of the frame, as the sign of S2 and S3.
    sign: f32,
}

impl Turns {
    /// For a matrix in the frame of a surface.
    fn of(Bounce { frame, wi, wo }: &Bounce) -> Self {
        let toward = neg(*wi);
        let (toward_world, wo_world) = (in_world(frame, toward), in_world(frame, *wo));
        Turns {
            before: doubled(toward_world, stokes_basis(toward_world), in_world(frame, stokes_basis(toward))),
            after: doubled(wo_world, in_world(frame, stokes_basis(*wo)), stokes_basis(wo_world)),
            sign: if dot(cross(frame[0], frame[1]), frame[2]) < 0.0 { -1.0 } else { 1.0 },
        }
    }
}

/// A row after a rotation that is applied to light before it.
#[inline(always)]
fn turned<const N: usize>(mut row: Stokes<N>, [cos, sin]: Turn) -> Stokes<N> {
    let (a, b) = (row[1], row[2]);
    for k in 0..N {
        row[1][k] = a[k] * cos - b[k] * sin;
        row[2][k] = a[k] * sin + b[k] * cos;
    }
    row
}

#[inline(always)]
fn mirrored<const N: usize>(mut row: Stokes<N>, sign: f32) -> Stokes<N> {
    for component in &mut row[2..] {
        component.iter_mut().for_each(|x| *x *= sign);
    }
    row
}

/// A row times a matrix.
#[inline(always)]
fn product<const N: usize>(row: &Stokes<N>, matrix: &Mueller<N>) -> Stokes<N> {
    let mut out = [[0.0; N]; 4];
    for (factor, elements) in row.iter().zip(&matrix.elements) {
        for (out, element) in out.iter_mut().zip(elements) {
            for k in 0..N {
                out[k] += factor[k] * element[k];
            }
        }
    }
    out
}

#[inline(always)]
fn times<const N: usize>(mut a: [f32; N], b: &[f32; N]) -> [f32; N] {
    for k in 0..N {
        a[k] *= b[k];
    }
    a
}

impl<const R: usize, const N: usize> Rows<R, N> {
    /// Rows of the identity, which does not change light.
    pub(super) const IDENTITY: Self = {
        let mut elements = [[[0.0; N]; 4]; R];
        let mut k = 0;
        while k < R {
            elements[k][k] = [1.0; N];
            k += 1;
        }
        Rows { elements, counts_energy: false }
    };

    pub(super) fn scaled(mut self, factor: f32) -> Self {
        for row in &mut self.elements {
            if self.counts_energy {
                row[0].iter_mut().for_each(|x| *x *= factor);
            } else {
                row.as_flattened_mut().iter_mut().for_each(|x| *x *= factor);
            }
        }
        self
    }

    /// The rows for light whose x axis is turned before.
    pub(super) fn turned_before(mut self, turn: Turn) -> Self {
        self.elements.iter_mut().for_each(|row| *row = turned(*row, turn));
        self
    }

    /// After a surface that depolarises.
    fn depolarised(self, share: &[f32; N]) -> Self {
        let mut elements = [[[0.0; N]; 4]; R];
        for (out, row) in elements.iter_mut().zip(&self.elements) {
            out[0] = times(row[0], share);
        }
        Rows { elements, counts_energy: true }
    }

    /// After a surface of whose matrix only this first row matters.
    fn times_first(self, first: &Stokes<N>) -> Self {
        let mut elements = [[[0.0; N]; 4]; R];
        for (out, row) in elements.iter_mut().zip(&self.elements) {
            for (out, element) in out.iter_mut().zip(first) {
                *out = times(row[0], element);
            }
        }
        Rows { elements, counts_energy: false }
    }

    /// After a surface whose matrix has the frames of the world.
    pub(super) fn after(self, matrix: &Mueller<N>) -> Self {
        if matrix.depolarises {
            return self.depolarised(&matrix.elements[0][0]);
        }
        if self.counts_energy {
            return self.times_first(&matrix.elements[0]);
        }
        Rows { elements: self.elements.map(|row| product(&row, matrix)), counts_energy: false }
    }

    /// After a surface.
    pub(super) fn bounced(self, matrix: &Mueller<N>, bounce: &Bounce) -> Self {
        if matrix.depolarises {
            return self.depolarised(&matrix.elements[0][0]);
        }
        let Turns { before, after, sign } = Turns::of(bounce);
        if self.counts_energy {
            return self.times_first(&turned(mirrored(matrix.elements[0], sign), before));
        }
        let one = |row| turned(mirrored(product(&mirrored(turned(row, after), sign), matrix), sign), before);
        Rows { elements: self.elements.map(one), counts_energy: false }
    }

    /// After a surface with exact directions.
    pub(super) fn bounced_exactly(
        self,
        weight: &[f32; N],
        polarisation: Option<&Polarisation<[f32; N]>>,
        Bounce { frame, wi, wo }: &Bounce,
    ) -> Self {
        let Some(Polarisation { axis, b, c, s }) = polarisation else { return self.depolarised(weight) };
        let [b, c, s] = [b, c, s].map(|element| times(*weight, element));
        let (toward, wo, axis) = (in_world(frame, neg(*wi)), in_world(frame, *wo), in_world(frame, *axis));
        let before = doubled(toward, stokes_basis(toward), axis);
        if self.counts_energy {
            let zero = [0.0; N];
            return self.times_first(&turned([*weight, b, zero, zero], before));
        }
        let after = doubled(wo, axis, stokes_basis(wo));
        let one = |row: Stokes<N>| {
            let [r0, r1, r2, r3] = turned(row, after);
            let mut out = [[0.0; N]; 4];
            for k in 0..N {
                out[0][k] = weight[k] * r0[k] + b[k] * r1[k];
                out[1][k] = b[k] * r0[k] + weight[k] * r1[k];
                out[2][k] = c[k] * r2[k] - s[k] * r3[k];
                out[3][k] = s[k] * r2[k] + c[k] * r3[k];
            }
            turned(out, before)
        };
        Rows { elements: self.elements.map(one), counts_energy: false }
    }

    /// The components of light with these S1, S2 and S3 over S0; `None` if it is not polarised.
    pub(super) fn of_light(&self, emitted: &[f32; N], polarised: Option<[f32; 3]>) -> [[f32; N]; R] {
        let mut out = [[0.0; N]; R];
        for (out, row) in out.iter_mut().zip(&self.elements) {
            *out = row[0];
            if let Some([s1, s2, s3]) = polarised.filter(|_| !self.counts_energy) {
                for k in 0..N {
                    out[k] += s1 * row[1][k] + s2 * row[2][k] + s3 * row[3][k];
                }
            }
            *out = times(*out, emitted);
        }
        out
    }

    /// The components of light that a surface scatters. Cheaper than [`bounced`](Self::bounced), because a column is
    /// multiplied and not a matrix.
    pub(super) fn of_scattered_light(
        &self,
        matrix: &Mueller<N>,
        bounce: &Bounce,
        emitted: &[f32; N],
        polarised: Option<[f32; 3]>,
    ) -> [[f32; N]; R] {
        let mut light = matrix.elements.map(|row| row[0]);
        if !matrix.depolarises {
            let Turns { before: [cos, sin], after, sign } = Turns::of(bounce);
            if let Some([s1, s2, s3]) = polarised {
                let [s1, s2, s3] = [cos * s1 + sin * s2, sign * (cos * s2 - sin * s1), sign * s3];
                for (light, row) in light.iter_mut().zip(&matrix.elements) {
                    for k in 0..N {
                        light[k] += s1 * row[1][k] + s2 * row[2][k] + s3 * row[3][k];
                    }
                }
            }
            if !self.counts_energy {
                // A column turns as a row does in the other direction.
                light = turned(mirrored(light, sign), [after[0], -after[1]]);
            }
        }
        let mut out = [[0.0; N]; R];
        for (out, row) in out.iter_mut().zip(&self.elements) {
            if matrix.depolarises || self.counts_energy {
                *out = times(row[0], &light[0]);
            } else {
                for (factor, light) in row.iter().zip(&light) {
                    for k in 0..N {
                        out[k] += factor[k] * light[k];
                    }
                }
            }
            *out = times(*out, emitted);
        }
        out
    }
}

#[cfg(test)]
mod tests;
