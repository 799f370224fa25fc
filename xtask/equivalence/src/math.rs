//! Every function of `lobe_math`, over its domain and on adversarial bits.

use lobe_lane::{Kernel, Lanes};
use lobe_math::bounds;

use super::lanes::floats;
use super::record::{Bound, Record};
use lobe_testing::patterns;

/// The functions, over dense input and over all pairs of patterns.
pub(super) struct Functions;

impl Kernel for Functions {
    type Out = Vec<Record>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Vec<Record> {
        let mut records = Vec::new();
        let unit = unit_interval();
        let rest: Vec<f32> = unit.iter().map(|&x| (1.0 - f64::from(x).abs()) as f32).collect();
        one_argument(lanes, &unit, &rest, true, &mut records);
        let (x, y) = around();
        two_arguments(lanes, &x, &y, true, &mut records);
        let turns: Vec<f32> = (0..1 << 14).map(|i| (i as f32 / (1 << 13) as f32 - 1.0) * 8192.0).collect();
        angles(lanes, &turns, true, &mut records);

        let numbers: Vec<f32> = (0..1 << 14).map(|i| (f64::from(i) * -0.004).exp() as f32).collect();
        roots(lanes, &numbers, true, &mut records);

        let (x, y) = patterns::pairs(&patterns::floats());
        one_argument(lanes, &x, &y, false, &mut records);
        two_arguments(lanes, &x, &y, false, &mut records);
        angles(lanes, &x, false, &mut records);
        roots(lanes, &x, false, &mut records);
        records
    }
}

/// Applies functions of two slices; inside the domain both forms are within `abs` of the exact value, and so within
/// twice that of each other.
macro_rules! record {
    ($lanes:ident, $records:ident, $domain:ident, $xs:ident, $ys:ident; $($what:literal $abs:expr, |$a:pat_param, $b:pat_param| $value:expr;)*) => {$({
        let mut out = Vec::with_capacity($xs.len());
        let mut at = 0;
        while at < $xs.len() {
            let ($a, $b) = ($lanes.load(&$xs[at..]), $lanes.load(&$ys[at..]));
            floats($lanes, $value, &mut out);
            at += L::LANES;
        }
        $records.push(if $domain {
            Record::bounded($what, out, Bound::Within(2.0 * $abs))
        } else {
            Record::bounded(concat!($what, ", any bits"), out, Bound::StrictOnly)
        });
    })*};
}

#[inline(always)]
fn one_argument<L: Lanes>(lanes: L, xs: &[f32], rests: &[f32], domain: bool, records: &mut Vec<Record>) {
    record! { lanes, records, domain, xs, rests;
        "acos" bounds::ACOS.abs, |x, _| lobe_math::acos(lanes, x);
        "acos_from" bounds::ACOS.abs, |x, rest| lobe_math::acos_from(lanes, x, rest);
        "asin" bounds::ASIN.abs, |x, _| lobe_math::asin(lanes, x);
        // Most of the error of the paper's formula comes from its polynomial, which both forms share. The rest is the
        // rounding of fewer terms than in `acos`.
        "paper acos" bounds::ACOS.abs, |x, _| lobe_math::paper::acos(lanes, x);
        "paper asin" bounds::ACOS.abs, |x, _| lobe_math::paper::asin(lanes, x);
    }
}

#[inline(always)]
fn two_arguments<L: Lanes>(lanes: L, xs: &[f32], ys: &[f32], domain: bool, records: &mut Vec<Record>) {
    record! { lanes, records, domain, xs, ys;
        "atan2" bounds::ATAN2.abs, |x, y| lobe_math::atan2(lanes, y, x);
        "azimuth" bounds::AZIMUTH.abs, |x, y| lobe_math::azimuth(lanes, y, x);
    }
}

#[inline(always)]
fn angles<L: Lanes>(lanes: L, xs: &[f32], domain: bool, records: &mut Vec<Record>) {
    record! { lanes, records, domain, xs, xs;
        "sin" bounds::SIN_COS.abs, |x, _| lobe_math::sin_cos(lanes, x).0;
        "cos" bounds::SIN_COS.abs, |x, _| lobe_math::sin_cos(lanes, x).1;
    }
}

#[inline(always)]
fn roots<L: Lanes>(lanes: L, xs: &[f32], domain: bool, records: &mut Vec<Record>) {
    record! { lanes, records, domain, xs, xs;
        "fifth_root" bounds::FIFTH_ROOT.abs, |x, _| lobe_math::fifth_root(lanes, x);
    }
}

/// Numbers that cover `[-1, 1]` evenly, and densely near -1, 0 and 1.
fn unit_interval() -> Vec<f32> {
    let mut xs: Vec<f32> = (0..=1 << 14).map(|i| i as f32 / (1 << 13) as f32 - 1.0).collect();
    for i in 0..1 << 12 {
        let small = f32::from_bits(0x3f00_0000 - i * 8192);
        let near_one = f32::from_bits(1f32.to_bits() - i);
        xs.extend([small, -small, near_one, -near_one]);
    }
    patterns::padded(xs)
}

/// Vectors in all directions, of very different lengths, and along the axes and diagonals.
fn around() -> (Vec<f32>, Vec<f32>) {
    let spiral = (0..1 << 14).map(|i| {
        let (angle, length) = (f64::from(i) * 0.618, 10f64.powi(i % 13 - 6));
        ((length * angle.cos()) as f32, (length * angle.sin()) as f32)
    });
    let corners = [-1.0f32, -0.0, 0.0, 1.0];
    let special = corners.iter().flat_map(|&x| corners.iter().map(move |&y| (x, y)));
    spiral.chain(special).unzip()
}
