//! Every operation of [`Texels`](lobe_lane::Texels): quads and octs, the same number of floats on every backend.

use lobe_lane::{Block, Kernel, Lanes};

use super::Record;
use lobe_testing::patterns;

pub(super) struct QuadsAndOcts;

/// `true` if two floats are the same value: the same bits, or both NaN.
fn same(a: f32, b: f32) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

impl Kernel for QuadsAndOcts {
    type Out = Vec<Record>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Vec<Record> {
        let (xs, ys) = patterns::pairs(&patterns::floats());
        let mut records = Vec::new();
        quads(lanes, &xs, &ys, &mut records);
        octs(lanes, &xs, &ys, &mut records);
        mul_adds(lanes, &xs, &ys, &mut records);
        corners(lanes, &mut records);
        records
    }
}

macro_rules! record {
    ($lanes:ident, $records:ident, $xs:ident, $ys:ident, $load:ident, $store:ident, $width:literal; $($what:literal |$a:pat_param, $b:pat_param| $value:expr;)*) => {$({
        let mut out = vec![0.0; $xs.len()];
        let mut at = 0;
        while at < $xs.len() {
            let ($a, $b) = ($lanes.$load(&$xs[at..]), $lanes.$load(&$ys[at..]));
            $lanes.$store(&mut out[at..], $value);
            at += $width;
        }
        $records.push(Record::exact($what, out));
    })*};
}

#[inline(always)]
fn quads<L: Lanes>(lanes: L, xs: &[f32], ys: &[f32], records: &mut Vec<Record>) {
    record! { lanes, records, xs, ys, quad_load, quad_store, 4;
        "quad a" |a, _| a;
        "quad a + b" |a, b| a + b;
        "quad a - b" |a, b| a - b;
        "quad a * b" |a, b| a * b;
        "quad_max" |a, b| lanes.quad_max(a, b);
    }
    let mut splats = Vec::new();
    for &x in xs {
        let mut splat = [0.0; 4];
        lanes.quad_store(&mut splat, lanes.quad_splat(x));
        splats.extend(splat);
    }
    records.push(Record::exact("quad_splat", splats));
}

#[inline(always)]
fn octs<L: Lanes>(lanes: L, xs: &[f32], ys: &[f32], records: &mut Vec<Record>) {
    record! { lanes, records, xs, ys, oct_load, oct_store, 8;
        "oct a" |a, _| a;
        "oct a + b" |a, b| a + b;
        "oct a * b" |a, b| a * b;
        "oct_max" |a, b| lanes.oct_max(a, b);
    }
    let (mut splats, mut halves, mut counts) = (Vec::new(), vec![0.0; xs.len()], Vec::new());
    let mut at = 0;
    while at < xs.len() {
        let oct = lanes.oct_load(&xs[at..]);
        let [low, high] = lanes.oct_halves(oct);
        // High half first, so that a backend that swaps the two is caught.
        lanes.quad_store(&mut halves[at..], high);
        lanes.quad_store(&mut halves[at + 4..], low);
        for &y in &patterns::floats() {
            counts.push(lanes.oct_count_le(oct, y));
        }
        let mut splat = [0.0; 8];
        lanes.oct_store(&mut splat, lanes.oct_splat(ys[at]));
        splats.extend(splat);
        at += 8;
    }
    records.push(Record::exact("oct_splat", splats));
    records.push(Record::exact("oct_halves", halves));
    records.push(Record::exact("oct_count_le", counts));
}

/// The result by the definition of the current form.
#[inline(always)]
fn mul_adds<L: Lanes>(lanes: L, xs: &[f32], ys: &[f32], records: &mut Vec<Record>) {
    let (mut quad, mut oct, mut scalar) = (Vec::new(), Vec::new(), Vec::new());
    for &c in &patterns::floats() {
        let mut at = 0;
        while at < xs.len() {
            let (a, b) = (&xs[at..at + 8], &ys[at..at + 8]);
            let (mut four, mut eight) = ([0.0; 4], [0.0; 8]);
            lanes
                .quad_store(&mut four, lanes.quad_mul_add(lanes.quad_load(a), lanes.quad_load(b), lanes.quad_splat(c)));
            lanes.oct_store(&mut eight, lanes.oct_mul_add(lanes.oct_load(a), lanes.oct_load(b), lanes.oct_splat(c)));
            for i in 0..8 {
                let expected = if L::FUSED { a[i].mul_add(b[i], c) } else { a[i] * b[i] + c };
                oct.push(same(eight[i], expected));
                scalar.push(same(lanes.scalar_mul_add(a[i], b[i], c), expected));
                if i < 4 {
                    quad.push(same(four[i], expected));
                }
            }
            at += 8;
        }
    }
    records.push(Record::exact("quad_mul_add", quad));
    records.push(Record::exact("oct_mul_add", oct));
    records.push(Record::exact("scalar_mul_add", scalar));
}

#[inline(always)]
fn corners<L: Lanes>(lanes: L, records: &mut Vec<Record>) {
    let (mut out, mut quads) = (Vec::new(), Vec::new());
    for len in [40, 41, 100] {
        let table: Vec<f32> = (0..len).map(|i| i as f32).collect();
        let block = Block::<4, 8>::new(&table, [0, 8, 3, 32]);
        let narrow = Block::<3, 4>::new(&table, [0, 36, 5]);
        for base in [0, 1, 2, 7, 8, len - 40, len - 39, len, 1000, u32::MAX as usize, usize::MAX / 2, usize::MAX] {
            for corner in lanes.oct_corners(&block, base) {
                let mut eight = [0.0; 8];
                lanes.oct_store(&mut eight, corner);
                out.extend(eight);
            }
            for corner in lanes.quad_corners(&narrow, base) {
                let mut four = [0.0; 4];
                lanes.quad_store(&mut four, corner);
                quads.extend(four);
            }
        }
    }
    records.push(Record::exact("oct_corners", out));
    records.push(Record::exact("quad_corners", quads));
}
