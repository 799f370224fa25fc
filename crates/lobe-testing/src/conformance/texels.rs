//! Quads and octs, which hold the same number of floats on every backend.

use half::f16;
use lobe_lane::{Block, Kernel, Lanes};

use super::{Same as _, assert_same};
use crate::patterns;

/// Every method of `Texels`.
#[derive(Clone, Copy)]
pub struct Texels;

impl Kernel for Texels {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let (xs, ys) = patterns::pairs(&patterns::floats());
        arithmetic(lanes, &xs, &ys);
        mul_adds(lanes, &xs, &ys);
        parts(lanes, &xs);
        corners(lanes);
        halves(lanes);
    }
}

macro_rules! check {
    ($lanes:ident, $xs:ident, $ys:ident, $load:ident, $store:ident, $width:literal; $($what:literal |$a:pat_param, $b:pat_param| $value:expr, |$x:pat_param, $y:pat_param| $expected:expr;)*) => {$({
        let mut at = 0;
        while at < $xs.len() {
            let ($a, $b) = ($lanes.$load(&$xs[at..]), $lanes.$load(&$ys[at..]));
            let mut found = [0.0; $width];
            $lanes.$store(&mut found, $value);
            for i in 0..$width {
                let (x, y) = ($xs[at + i], $ys[at + i]);
                let ($x, $y) = (x, y);
                assert_same($what, &[&x, &y], found[i], $expected);
            }
            at += $width;
        }
    })*};
}

#[inline(always)]
fn arithmetic<L: Lanes>(lanes: L, xs: &[f32], ys: &[f32]) {
    check! { lanes, xs, ys, quad_load, quad_store, 4;
        "quad a" |a, _| a, |x, _| x;
        "quad a + b" |a, b| a + b, |x, y| x + y;
        "quad a - b" |a, b| a - b, |x, y| x - y;
        "quad a * b" |a, b| a * b, |x, y| x * y;
        "quad_max" |a, b| lanes.quad_max(a, b), |x, y| if x > y { x } else { y };
    }
    check! { lanes, xs, ys, oct_load, oct_store, 8;
        "oct a" |a, _| a, |x, _| x;
        "oct a + b" |a, b| a + b, |x, y| x + y;
        "oct a * b" |a, b| a * b, |x, y| x * y;
        "oct_max" |a, b| lanes.oct_max(a, b), |x, y| if x > y { x } else { y };
    }
}

#[inline(always)]
fn mul_adds<L: Lanes>(lanes: L, xs: &[f32], ys: &[f32]) {
    for &z in &patterns::floats() {
        let (quad, oct) = (lanes.quad_splat(z), lanes.oct_splat(z));
        check! { lanes, xs, ys, quad_load, quad_store, 4;
            "quad_mul_add" |a, b| lanes.quad_mul_add(a, b, quad), |x, y| expected::<L>(x, y, z);
        }
        check! { lanes, xs, ys, oct_load, oct_store, 8;
            "oct_mul_add" |a, b| lanes.oct_mul_add(a, b, oct), |x, y| expected::<L>(x, y, z);
        }
        for (&x, &y) in xs.iter().zip(ys) {
            assert_same("scalar_mul_add", &[&x, &y, &z], lanes.scalar_mul_add(x, y, z), expected::<L>(x, y, z));
        }
    }
}

#[inline(always)]
fn expected<L: Lanes>(x: f32, y: f32, z: f32) -> f32 {
    if L::FUSED { x.mul_add(y, z) } else { x * y + z }
}

#[inline(always)]
fn parts<L: Lanes>(lanes: L, xs: &[f32]) {
    for x in patterns::floats() {
        let (mut four, mut eight) = ([0.0; 4], [0.0; 8]);
        lanes.quad_store(&mut four, lanes.quad_splat(x));
        lanes.oct_store(&mut eight, lanes.oct_splat(x));
        assert!(four.iter().chain(&eight).all(|found| found.same(x)), "splat of {x}: {four:?} {eight:?}");
    }
    let mut at = 0;
    while at < xs.len() {
        let eight = &xs[at..at + 8];
        let oct = lanes.oct_load(eight);
        let mut found = [0.0; 8];
        let [low, high] = lanes.oct_halves(oct);
        lanes.quad_store(&mut found[..4], low);
        lanes.quad_store(&mut found[4..], high);
        assert!(found.iter().zip(eight).all(|(found, x)| found.same(*x)), "halves of {eight:?}: {found:?}");
        for x in patterns::floats() {
            let expected = eight.iter().take_while(|knot| **knot <= x).count();
            assert_eq!(lanes.oct_count_le(oct, x) as usize, expected, "{eight:?} <= {x}");
        }
        at += 8;
    }
    // Ascending knots, as in searches.
    let knots = [-3.0, -0.0, 0.0, 1.0, 1.0, 2.5, f32::MAX, f32::INFINITY];
    for x in knots.into_iter().chain([-4.0, 0.5, 2.0, f32::NAN]) {
        let expected = knots.iter().filter(|knot| **knot <= x).count();
        assert_eq!(lanes.oct_count_le(lanes.oct_load(&knots), x) as usize, expected, "knots <= {x}");
    }
    // A store leaves the rest untouched.
    let mut target = [7.0; 10];
    lanes.quad_store(&mut target[1..], lanes.quad_splat(1.0));
    assert_eq!(target, [7.0, 1.0, 1.0, 1.0, 1.0, 7.0, 7.0, 7.0, 7.0, 7.0]);
    lanes.oct_store(&mut target[1..], lanes.oct_splat(2.0));
    assert_eq!(target, [7.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 7.0]);
}

#[inline(always)]
fn corners<L: Lanes>(lanes: L) {
    for len in [40, 41, 100] {
        let table: Vec<f32> = (0..len).map(|i| i as f32 + 0.5).collect();
        let half_table: Vec<u16> = table.iter().map(|x| f16::from_f32(*x).to_bits()).collect();
        let (octs, quads) = (Block::<4, 8>::new(&table, [0, 8, 3, 32]), Block::<3, 4>::new(&table, [0, 36, 5]));
        let half_octs = Block::<4, 8, u16>::new(&half_table, [0, 8, 3, 32]);
        let half_quads = Block::<3, 4, u16>::new(&half_table, [0, 36, 5]);
        for base in [0, 1, 2, 7, 8, len - 40, len - 39, len, 1000, u32::MAX as usize, usize::MAX / 2, usize::MAX] {
            let (of_single, of_half) = (lanes.oct_corners(&octs, base), lanes.oct_corners_half(&half_octs, base));
            for corner in 0..4 {
                let (mut single, mut half) = ([0.0; 8], [0.0; 8]);
                lanes.oct_store(&mut single, of_single[corner]);
                lanes.oct_store(&mut half, of_half[corner]);
                let expected = &table[base.min(octs.last_base()) + octs.offsets()[corner]..][..8];
                assert_eq!((&single[..], &half[..]), (expected, expected), "oct {corner} at {base} of {len}");
            }
            let (of_single, of_half) = (lanes.quad_corners(&quads, base), lanes.quad_corners_half(&half_quads, base));
            for corner in 0..3 {
                let (mut single, mut half) = ([0.0; 4], [0.0; 4]);
                lanes.quad_store(&mut single, of_single[corner]);
                lanes.quad_store(&mut half, of_half[corner]);
                let expected = &table[base.min(quads.last_base()) + quads.offsets()[corner]..][..4];
                assert_eq!((&single[..], &half[..]), (expected, expected), "quad {corner} at {base} of {len}");
            }
        }
    }
}

/// Every finite half, including subnormals and both zeros.
#[inline(always)]
fn halves<L: Lanes>(lanes: L) {
    let finite: Vec<u16> = (0..=u16::MAX).filter(|bits| f16::from_bits(*bits).is_finite()).collect();
    let (octs, quads) = (Block::<1, 8, u16>::new(&finite, [0]), Block::<1, 4, u16>::new(&finite, [0]));
    for base in (0..finite.len()).step_by(8) {
        let (mut eight, mut four) = ([0.0; 8], [0.0; 4]);
        lanes.oct_store(&mut eight, lanes.oct_corners_half(&octs, base)[0]);
        lanes.quad_store(&mut four, lanes.quad_corners_half(&quads, base)[0]);
        let of_lanes = lanes.gather_quads_half(&quads, lanes.splat_int(base as i32));
        for i in 0..8 {
            let expected = f16::from_bits(finite[base + i]).to_f32();
            assert_same("oct of halves", &[&finite[base + i]], eight[i], expected);
            if i < 4 {
                assert_same("quad of halves", &[&finite[base + i]], four[i], expected);
                assert_same("gather of halves", &[&finite[base + i]], lanes.extract(of_lanes[0][i], 0), expected);
            }
        }
    }
}
