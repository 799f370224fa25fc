//! Vectors of three floats. Nothing here is fused or reassociated, so the bits are the same on every machine.

/// A point, a direction or a normal.
pub(crate) type Vec3 = [f32; 3];

pub(crate) fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn scale(a: Vec3, s: f32) -> Vec3 {
    [a[0] * s, a[1] * s, a[2] * s]
}

pub(crate) fn neg(a: Vec3) -> Vec3 {
    [-a[0], -a[1], -a[2]]
}

pub(crate) fn dot(a: Vec3, b: Vec3) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn length(a: Vec3) -> f32 {
    dot(a, a).sqrt()
}

/// The unit vector along `a`; `None` where it points nowhere.
pub(crate) fn unit(a: Vec3) -> Option<Vec3> {
    // Scaled by the largest component first, so that no square overflows or vanishes.
    let largest = a.iter().fold(0.0f32, |largest, c| largest.max(c.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let a = a.map(|c| c / largest);
    Some(scale(a, 1.0 / length(a)))
}

/// A unit vector perpendicular to the unit vector `n`.
pub(crate) fn perpendicular(n: Vec3) -> Vec3 {
    // The axis that `n` has least of, so that the cross product is never short.
    let [x, y, z] = n.map(f32::abs);
    let axis = if x <= y && x <= z {
        [1.0, 0.0, 0.0]
    } else if y <= z {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    };
    let along = cross(n, axis);
    scale(along, 1.0 / length(along))
}

/// A direction drawn in proportion to its cosine with +z: the disk of Shirley and Chiu 1997 ("A Low Distortion Map
/// Between Disk and Square"), lifted to the hemisphere. Its density is `z / pi`.
pub(crate) fn cosine_hemisphere(u: [f32; 2]) -> Vec3 {
    let [x, y] = disk(u);
    [x, y, (1.0 - x * x - y * y).max(1e-12).sqrt()]
}

/// A point of the unit disk, uniform in area.
pub(crate) fn disk([u, v]: [f32; 2]) -> [f32; 2] {
    let (a, b) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    if a == 0.0 && b == 0.0 {
        return [0.0; 2];
    }
    let (radius, turn) = if a.abs() > b.abs() { (a, 0.125 * (b / a)) } else { (b, 0.25 - 0.125 * (a / b)) };
    let (sin, cos) = sin_cos(turn);
    [radius * cos, radius * sin]
}

/// Sine and cosine of an angle in turns, no more than a few of them. The error is below 3e-7.
pub(crate) fn sin_cos(turns: f32) -> (f32, f32) {
    // The nearest quarter, by adding what leaves no place for a fraction; and what is left, at most an eighth.
    const ROUND: f32 = 12_582_912.0;
    let quarter = (4.0 * turns + ROUND) - ROUND;
    let x = (turns - 0.25 * quarter) * std::f32::consts::TAU;
    let x2 = x * x;
    // Taylor's series, whose next terms are below 2e-9 and 3e-8 where x is pi / 4.
    let sin = x * (1.0 + x2 * (-1.0 / 6.0 + x2 * (1.0 / 120.0 + x2 * (-1.0 / 5040.0 + x2 * (1.0 / 362_880.0)))));
    let cos = 1.0 + x2 * (-0.5 + x2 * (1.0 / 24.0 + x2 * (-1.0 / 720.0 + x2 * (1.0 / 40_320.0))));
    let odd = quarter as i32 & 1 != 0;
    let (a, b) = if odd { (cos, sin) } else { (sin, cos) };
    let quadrant = quarter as i32 & 3;
    (if quadrant >= 2 { -a } else { a }, if quadrant == 1 || quadrant == 2 { -b } else { b })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_of_turns() {
        for i in -3000..3000 {
            let turns = i as f32 / 1000.0;
            let (sin, cos) = sin_cos(turns);
            let (s, c) = (f64::from(turns) * std::f64::consts::TAU).sin_cos();
            assert!((f64::from(sin) - s).abs() < 3e-7 && (f64::from(cos) - c).abs() < 3e-7, "{turns}: {sin} {cos}");
        }
    }
}
