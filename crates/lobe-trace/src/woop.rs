//! Rays against triangles, watertight.
//!
//! Woop, Benthin, Wald, *Watertight Ray/Triangle Intersection*, JCGT 2(1), 2013. The triangle is moved and sheared so
//! that the ray becomes the z axis; then the signs of three 2-D edge functions decide. Two triangles that share an edge
//! compute the same products for it, so no ray slips between them. This requires that the products are rounded: the
//! edge functions must not be fused, on any backend.

use lobe_lane::{Floats, Lanes, MAX_LANES, Mask};

use crate::block::{Block, group_rows, ray_rows};
use crate::triangles::Corners;

/// The data of rays for triangle tests, one value per lane.
#[derive(Clone, Copy)]
pub(crate) struct ShearRay<L: Lanes> {
    shear: [L::F; 3],
    pivot: [L::F; 3],
}

/// The axes that become x, y and z, for rays that mostly share them.
#[inline(always)]
pub(crate) fn axes_of(major: i32) -> [usize; 3] {
    match major {
        0 => [1, 2, 0],
        1 => [2, 0, 1],
        _ => [0, 1, 2],
    }
}

/// The same without branches, for rays whose axes are unpredictable.
#[inline(always)]
pub(crate) fn axes_of_any(major: i32) -> [usize; 3] {
    const AXES: [[usize; 3]; 4] = [[1, 2, 0], [2, 0, 1], [0, 1, 2], [0, 1, 2]];
    AXES[major as usize & 3]
}

/// The hits of triangles, one value per lane. Only the lanes of the mask are meaningful.
#[derive(Clone, Copy)]
pub(crate) struct Candidates<L: Lanes> {
    pub mask: L::M,
    pub t: L::F,
    pub u: L::F,
    pub v: L::F,
}

impl<L: Lanes> ShearRay<L> {
    /// One ray per lane.
    #[inline(always)]
    pub fn group(lanes: L, rays: &Block, at: usize) -> Self {
        ShearRay { shear: group_rows(lanes, &rays.shear, at), pivot: group_rows(lanes, &rays.pivot, at) }
    }

    /// One ray in all lanes.
    #[inline(always)]
    pub fn single(lanes: L, rays: &Block, ray: usize) -> Self {
        ShearRay { shear: ray_rows(lanes, &rays.shear, ray), pivot: ray_rows(lanes, &rays.pivot, ray) }
    }

    /// Tests triangles, their vertices given in the permuted order of axes. The t of a hit is not limited yet. `None`
    /// if all are missed: the only unpredictable branch.
    #[inline(always)]
    pub fn test(&self, lanes: L, vertices: Corners<L>, live: L::M) -> Option<Candidates<L>> {
        let mut x = [lanes.splat(0.0); 3];
        let mut y = x;
        let mut z = x;
        let mut corner = 0;
        while corner < 3 {
            z[corner] = vertices[corner][2] - self.pivot[2];
            x[corner] = lanes.mul_add(self.shear[0], z[corner], vertices[corner][0] - self.pivot[0]);
            y[corner] = lanes.mul_add(self.shear[1], z[corner], vertices[corner][1] - self.pivot[1]);
            corner += 1;
        }
        let zero = lanes.splat(0.0);
        let mut u = x[2] * y[1] - y[2] * x[1];
        let mut v = x[0] * y[2] - y[0] * x[2];
        let mut w = x[1] * y[0] - y[1] * x[0];
        let (least, most) = (u.min(v).min(w), u.max(v).max(w));
        let mut mask = live & (least.ge(zero) | most.le(zero));
        if !mask.any() {
            return None;
        }
        let mut sum = u + v + w;
        // If the signs agree, an edge function that is zero is the least or the greatest of the three.
        let unsure = mask & (least.eq(zero) | most.eq(zero) | sum.abs().lt(lanes.splat(TINY)));
        if unsure.any() {
            let mut edges = Edges { x: [[0.0; MAX_LANES]; 3], y: [[0.0; MAX_LANES]; 3] };
            let mut corner = 0;
            while corner < 3 {
                lanes.store(&mut edges.x[corner], x[corner]);
                lanes.store(&mut edges.y[corner], y[corner]);
                corner += 1;
            }
            edges.exact(L::LANES);
            u = lanes.select(unsure, lanes.load(&edges.x[0]), u);
            v = lanes.select(unsure, lanes.load(&edges.x[1]), v);
            w = lanes.select(unsure, lanes.load(&edges.x[2]), w);
            sum = u + v + w;
        }
        mask = mask & !sum.eq(zero);
        let inverse = lanes.splat(1.0) / sum;
        let (u, v, w) = (u * inverse, v * inverse, w * inverse);
        // The weights have the same sign, so t stays between the t of the vertices, up to rounding.
        let t = lanes.mul_add(u, z[0], lanes.mul_add(v, z[1], w * z[2])) * self.shear[2];
        Some(Candidates { mask, t, u: v, v: w })
    }
}

/// A sum of edge functions below this has lost digits or has no inverse.
const TINY: f32 = 1e-30;

/// Edge functions that were zero or tiny in single precision.
struct Edges {
    x: [[f32; MAX_LANES]; 3],
    y: [[f32; MAX_LANES]; 3],
}

impl Edges {
    /// Writes the edge functions divided by their sum to `x`, or zeros if their exact signs differ. The products are
    /// exact in double precision, and so are the signs of their differences.
    #[cold]
    #[inline(never)]
    fn exact(&mut self, lanes: usize) {
        for lane in 0..lanes.min(MAX_LANES) {
            let x = self.x.map(|row| f64::from(row[lane]));
            let y = self.y.map(|row| f64::from(row[lane]));
            let edges = [x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2], x[1] * y[0] - y[1] * x[0]];
            let sum = edges[0] + edges[1] + edges[2];
            let mixed = edges.iter().any(|&e| e < 0.0) && edges.iter().any(|&e| e > 0.0);
            for (row, edge) in self.x.iter_mut().zip(edges) {
                row[lane] = if mixed || sum == 0.0 { 0.0 } else { (edge / sum) as f32 };
            }
        }
    }
}
