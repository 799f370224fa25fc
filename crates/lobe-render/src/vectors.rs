//! Vectors of three floats in lanes. No operations are fused, so the bits are the same on every machine.

use lobe_lane::{Floats, Ints, Lanes};

#[inline(always)]
pub(crate) fn blend<L: Lanes>([a, b, c]: [[L::F; 3]; 3], [u, v, w]: [L::F; 3]) -> [L::F; 3] {
    add::<L>(add::<L>(scale::<L>(a, u), scale::<L>(b, v)), scale::<L>(c, w))
}

#[inline(always)]
pub(crate) fn add<L: Lanes>(a: [L::F; 3], b: [L::F; 3]) -> [L::F; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub(crate) fn sub<L: Lanes>(a: [L::F; 3], b: [L::F; 3]) -> [L::F; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(crate) fn neg<L: Lanes>(a: [L::F; 3]) -> [L::F; 3] {
    [-a[0], -a[1], -a[2]]
}

#[inline(always)]
pub(crate) fn scale<L: Lanes>(a: [L::F; 3], s: L::F) -> [L::F; 3] {
    [a[0] * s, a[1] * s, a[2] * s]
}

#[inline(always)]
pub(crate) fn dot<L: Lanes>(a: [L::F; 3], b: [L::F; 3]) -> L::F {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(crate) fn cross<L: Lanes>(a: [L::F; 3], b: [L::F; 3]) -> [L::F; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
pub(crate) fn select<L: Lanes>(lanes: L, mask: L::M, a: [L::F; 3], b: [L::F; 3]) -> [L::F; 3] {
    [lanes.select(mask, a[0], b[0]), lanes.select(mask, a[1], b[1]), lanes.select(mask, a[2], b[2])]
}

#[inline(always)]
pub(crate) fn max_component<L: Lanes>(a: [L::F; 3]) -> L::F {
    a[0].abs().max(a[1].abs()).max(a[2].abs())
}

/// The unit vector along `a`, or `other` if `a` has no direction.
#[inline(always)]
pub(crate) fn unit_or<L: Lanes>(lanes: L, a: [L::F; 3], other: [L::F; 3]) -> [L::F; 3] {
    // Scaled by the largest component first, so that no square overflows or vanishes.
    let size = max_component::<L>(a);
    let sound = lanes.splat(1e-30).lt(size) & size.lt(lanes.splat(1e30));
    let one = lanes.splat(1.0);
    let a = scale::<L>(a, one / size);
    select(lanes, sound, scale::<L>(a, one / dot::<L>(a, a).sqrt()), other)
}

/// A unit vector perpendicular to the unit vector `n`.
#[inline(always)]
pub(crate) fn perpendicular<L: Lanes>(lanes: L, n: [L::F; 3]) -> [L::F; 3] {
    // Crossed with the axis along which `n` is smallest, so that the product is never short.
    let zero = lanes.splat(0.0);
    let [x, y, z] = [n[0].abs(), n[1].abs(), n[2].abs()];
    let with_y_or_z = select(lanes, y.le(z), [-n[2], zero, n[0]], [n[1], -n[0], zero]);
    let along = select(lanes, x.le(y) & x.le(z), [zero, n[2], -n[1]], with_y_or_z);
    scale::<L>(along, lanes.splat(1.0) / dot::<L>(along, along).sqrt())
}

/// A right-handed frame whose z axis is the unit vector `n`.
#[inline(always)]
pub(crate) fn frame_of<L: Lanes>(lanes: L, n: [L::F; 3]) -> [[L::F; 3]; 3] {
    let tangent = perpendicular(lanes, n);
    [tangent, cross::<L>(n, tangent), n]
}

/// Transforms a vector from a frame to the world.
#[inline(always)]
pub(crate) fn to_world<L: Lanes>(frame: [[L::F; 3]; 3], local: [L::F; 3]) -> [L::F; 3] {
    blend::<L>(frame, local)
}

/// Sines and cosines of angles in turns, at most a few turns. The error is below 3e-7.
#[inline(always)]
pub(crate) fn sin_cos<L: Lanes>(lanes: L, turns: L::F) -> [L::F; 2] {
    // The nearest quarter, by adding a number so large that no place is left for a fraction; and the rest, at most an
    // eighth.
    let (one, round) = (lanes.splat(1.0), lanes.splat(12_582_912.0));
    let quarter = (lanes.splat(4.0) * turns + round) - round;
    let x = (turns - lanes.splat(0.25) * quarter) * lanes.splat(std::f32::consts::TAU);
    let x2 = x * x;
    // Taylor's series, whose next terms are below 2e-9 and 3e-8 at x = pi / 4.
    let mut sin = lanes.splat(1.0 / 362_880.0);
    let mut cos = lanes.splat(1.0 / 40_320.0);
    let terms = [(-1.0 / 5040.0, -1.0 / 720.0), (1.0 / 120.0, 1.0 / 24.0), (-1.0 / 6.0, -0.5)];
    let mut k = 0;
    while k < terms.len() {
        sin = lanes.splat(terms[k].0) + x2 * sin;
        cos = lanes.splat(terms[k].1) + x2 * cos;
        k += 1;
    }
    let (sin, cos) = (x * (one + x2 * sin), one + x2 * cos);
    let quadrant = quarter.to_int();
    let odd = (quadrant & lanes.splat_int(1)).eq(lanes.splat_int(1));
    let (a, b) = (lanes.select(odd, cos, sin), lanes.select(odd, sin, cos));
    // Bit 1 of the quadrant is the sign of the sine; bit 1 of the next quadrant is the sign of the cosine.
    let next = quadrant + lanes.splat_int(1);
    [a.mul_sign(quadrant.shl::<30>().as_float()), b.mul_sign(next.shl::<30>().as_float())]
}

/// Points of the unit disk, uniform in area: Shirley and Chiu 1997 ("A Low Distortion Map Between Disk and Square").
#[inline(always)]
pub(crate) fn disk<L: Lanes>(lanes: L, u: [L::F; 2]) -> [L::F; 2] {
    let (one, two, zero) = (lanes.splat(1.0), lanes.splat(2.0), lanes.splat(0.0));
    let (a, b) = (two * u[0] - one, two * u[1] - one);
    let flat = b.abs().lt(a.abs());
    let radius = lanes.select(flat, a, b);
    let eighth = lanes.splat(0.125) * (lanes.select(flat, b, a) / radius);
    let turns = lanes.select(flat, eighth, lanes.splat(0.25) - eighth);
    let [sin, cos] = sin_cos(lanes, lanes.select(radius.eq(zero), zero, turns));
    [radius * cos, radius * sin]
}

/// Directions sampled in proportion to their cosine with +z: the [`disk`] lifted to the hemisphere. Their density is
/// `z / pi`.
#[inline(always)]
pub(crate) fn cosine_hemisphere<L: Lanes>(lanes: L, u: [L::F; 2]) -> [L::F; 3] {
    let [x, y] = disk(lanes, u);
    [x, y, (lanes.splat(1.0) - x * x - y * y).max(lanes.splat(1e-12)).sqrt()]
}

#[cfg(test)]
mod tests {
    use lobe_scalar::Scalar;

    use super::*;

    #[test]
    fn sines_of_turns() {
        let lanes = Scalar::<1>;
        for i in -3000..3000 {
            let turns = i as f32 / 1000.0;
            let [sin, cos] = sin_cos(lanes, lanes.splat(turns)).map(|x| f64::from(lanes.extract(x, 0)));
            let (s, c) = (f64::from(turns) * std::f64::consts::TAU).sin_cos();
            assert!((sin - s).abs() < 3e-7 && (cos - c).abs() < 3e-7, "{turns}: {sin} {cos}");
        }
    }

    #[test]
    fn points_of_the_disk_are_spread_evenly() {
        let lanes = Scalar::<1>;
        let n = 100;
        let (mut inner, mut right) = (0, 0);
        for i in 0..n * n {
            let u = [((i / n) as f32 + 0.5) / n as f32, ((i % n) as f32 + 0.5) / n as f32];
            let [x, y] = disk(lanes, u.map(|u| lanes.splat(u))).map(|x| lanes.extract(x, 0));
            assert!(x * x + y * y <= 1.0 + 1e-6);
            inner += usize::from(x * x + y * y < 0.25);
            right += usize::from(x > 0.0 && y.abs() < x);
        }
        assert!(inner.abs_diff(n * n / 4) < n && right.abs_diff(n * n / 4) < n, "{inner} {right}");
        assert_eq!(disk(lanes, [lanes.splat(0.5); 2]).map(|x| lanes.extract(x, 0)), [0.0; 2]);
    }
}
