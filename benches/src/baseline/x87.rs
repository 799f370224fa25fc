//! The scalar code of the paper's time: x87 instructions for the arc cosine, and a binary search that branches.

use std::arch::asm;
use std::f32::consts::TAU;

use super::ScalarTable;

/// Arc cosine on the x87 unit: `fpatan(sqrt(1 - x^2), x)`.
#[inline(always)]
pub fn acos(x: f32) -> f32 {
    let mut angle = 0.0f32;
    // SAFETY: reads the four bytes of `x` and writes the four bytes of `angle`; leaves the x87 stack as it was, which is
    // declared as clobbered throughout.
    unsafe {
        asm!(
            "fld dword ptr [{x}]",
            "fld1",
            "fld st(1)",
            "fmul st(0), st(0)",
            "fsubp st(1), st(0)",
            "fsqrt",
            "fxch st(1)",
            "fpatan",
            "fstp dword ptr [{angle}]",
            x = in(reg) &x,
            angle = in(reg) &mut angle,
            out("st(0)") _, out("st(1)") _, out("st(2)") _, out("st(3)") _,
            out("st(4)") _, out("st(5)") _, out("st(6)") _, out("st(7)") _,
            options(nostack),
        );
    }
    angle
}

/// The cell of an angle by bisection with a branch at each step, as in the paper's scalar version; clamped at the ends.
pub fn bisect(knots: &[f32], angle: f32) -> usize {
    let (mut low, mut high) = (0, knots.len() - 1);
    while high - low > 1 {
        let middle = (low + high) / 2;
        if knots[middle] <= angle {
            // SAFETY: it has no instructions. It keeps the compiler from turning the branch into a conditional move,
            // because it must run only in this arm.
            unsafe { asm!("", options(nomem, nostack, preserves_flags)) };
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// The cell of an angle and the fraction into it; clamped at the ends.
pub fn locate(knots: &[f32], angle: f32) -> (usize, f32) {
    let angle = angle.clamp(knots[0], knots[knots.len() - 1]);
    let cell = bisect(knots, angle);
    (cell, (angle - knots[cell]) / (knots[cell + 1] - knots[cell]))
}

/// One evaluation, RGB in 1/sr.
pub fn eval(table: &ScalarTable, wi: [f32; 3], wo: [f32; 3]) -> [f32; 3] {
    if wi[2] <= 0.0 || wo[2] <= 0.0 {
        return [0.0; 3];
    }
    let sin_sigma = (wi[0] * wi[0] + wi[1] * wi[1]).sqrt();
    let (cos_psi, sin_psi) = if sin_sigma > 0.0 { (wi[0] / sin_sigma, wi[1] / sin_sigma) } else { (1.0, 0.0) };
    let toward = cos_psi * wo[0] + sin_psi * wo[1];
    let y = cos_psi * wo[1] - sin_psi * wo[0];
    let x = wi[2] * toward + sin_sigma * wo[2];
    let z = wi[2] * wo[2] - sin_sigma * toward;
    let length = (x * x + y * y).sqrt();

    let turn = |cos: f32, sin: f32| if sin < 0.0 { TAU - acos(cos) } else { acos(cos) };
    let mut cell = [0; 4];
    let mut fraction = [0.0; 4];
    (cell[0], fraction[0]) = locate(&table.knots[0], acos(wi[2].min(1.0)));
    (cell[2], fraction[2]) = locate(&table.knots[2], acos(z.clamp(-1.0, 1.0)));
    let cos_phi = if length > 0.0 { (x / length).clamp(-1.0, 1.0) } else { 1.0 };
    (cell[3], fraction[3]) = locate(&table.knots[3], turn(cos_phi, y));
    if table.knots[1].len() > 1 {
        (cell[1], fraction[1]) = locate(&table.knots[1], turn(cos_psi, sin_psi));
    }
    table.interpolate(cell, fraction).map(|value| value.max(0.0))
}
