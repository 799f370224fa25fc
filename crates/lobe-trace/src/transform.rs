//! The transform of an instance.

/// An affine map `x -> A x + b` from the space of an instance to the world, as three rows `[A | b]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// Row `i` gives coordinate `i` of the image.
    pub rows: [[f32; 4]; 3],
}

impl Affine {
    /// The identity.
    pub const IDENTITY: Affine = Affine { rows: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]] };

    /// A translation.
    pub fn translation([x, y, z]: [f32; 3]) -> Self {
        Affine { rows: [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z]] }
    }

    /// The image of a point.
    pub fn point(&self, p: [f32; 3]) -> [f32; 3] {
        self.rows.map(|[a, b, c, d]| a * p[0] + b * p[1] + c * p[2] + d)
    }

    /// The inverse, computed in `f64`; `None` if the map flattens space or a number is not finite.
    pub fn inverse(&self) -> Option<Affine> {
        let m = self.rows.map(|row| row.map(f64::from));
        let cofactor = |i: usize, j: usize| {
            let ([a, b], [c, d]) = ([(i + 1) % 3, (i + 2) % 3], [(j + 1) % 3, (j + 2) % 3]);
            m[a][c] * m[b][d] - m[a][d] * m[b][c]
        };
        let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
        let inverse: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / determinant));
        let rows = inverse.map(|row| {
            let shift: f64 = -(0..3).map(|k| row[k] * m[k][3]).sum::<f64>();
            [row[0] as f32, row[1] as f32, row[2] as f32, shift as f32]
        });
        rows.as_flattened().iter().all(|x| x.is_finite()).then_some(Affine { rows })
    }
}
