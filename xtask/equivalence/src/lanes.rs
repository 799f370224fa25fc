//! Arithmetic and comparison, lane by lane, over all pairs of adversarial patterns.

use lobe_lane::{Floats, Ints, Kernel, Lanes, MAX_LANES, Mask};

use super::Record;
use lobe_testing::patterns;

/// Appends the lanes of `x`.
#[inline(always)]
pub(super) fn floats<L: Lanes>(lanes: L, x: L::F, out: &mut Vec<f32>) {
    let mut buffer = [0.0; MAX_LANES];
    lanes.store(&mut buffer, x);
    out.extend_from_slice(&buffer[..L::LANES]);
}

/// Appends the lanes of `x`.
#[inline(always)]
pub(super) fn ints<L: Lanes>(lanes: L, x: L::I, out: &mut Vec<u32>) {
    let mut buffer = [0; MAX_LANES];
    lanes.store_int(&mut buffer, x);
    out.extend(buffer[..L::LANES].iter().map(|&x| x as u32));
}

/// Appends the lanes of `mask` as 0 and 1.
#[inline(always)]
pub(super) fn mask<L: Lanes>(_lanes: L, mask: L::M, out: &mut Vec<u32>) {
    let bits = mask.bits();
    out.extend((0..L::LANES).map(|lane| bits >> lane & 1));
}

/// Records an expression of the lanes of two slices, which are loaded with `$load`; the results go through `$put`.
macro_rules! record {
    ($lanes:ident, $records:ident, $load:ident, $xs:expr, $ys:expr; $($put:ident $what:literal |$a:pat_param, $b:pat_param| $value:expr;)*) => {$({
        let (xs, ys) = (&$xs, &$ys);
        let mut out = Vec::with_capacity(xs.len());
        let mut at = 0;
        while at < xs.len() {
            let ($a, $b) = ($lanes.$load(&xs[at..]), $lanes.$load(&ys[at..]));
            $put($lanes, $value, &mut out);
            at += L::LANES;
        }
        $records.push(Record::exact($what, out));
    })*};
}

/// Every operation of [`Floats`], and those of [`Lanes`] on floats.
pub(super) struct FloatLanes;

impl Kernel for FloatLanes {
    type Out = Vec<Record>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Vec<Record> {
        let (xs, ys) = patterns::pairs(&patterns::floats());
        let mut records = Vec::new();
        record! { lanes, records, load, xs, ys;
            floats "a + b" |a, b| a + b;
            floats "a - b" |a, b| a - b;
            floats "a * b" |a, b| a * b;
            floats "a / b" |a, b| a / b;
            floats "-a" |a, _| -a;
            floats "min" |a, b| a.min(b);
            floats "max" |a, b| a.max(b);
            floats "abs" |a, _| a.abs();
            floats "sqrt" |a, _| a.sqrt();
            mask "a < b" |a, b| a.lt(b);
            mask "a <= b" |a, b| a.le(b);
            mask "a > b" |a, b| a.gt(b);
            mask "a >= b" |a, b| a.ge(b);
            mask "a == b" |a, b| a.eq(b);
            floats "masked" |a, b| a.masked(b.lt(a));
            floats "mul_sign" |a, b| a.mul_sign(b);
            ints "to_int" |a, _| a.to_int();
            ints "bits" |a, _| a.bits();
            floats "select" |a, b| lanes.select(a.lt(b), a, b);
            ints "descend" |a, b| lanes.descend(a.bits(), b);
        }

        // Three operands, by the definition of the current form.
        let all = patterns::floats();
        let mut defined = Vec::new();
        for &c in &all {
            let mut sums = Vec::with_capacity(xs.len());
            let mut at = 0;
            while at < xs.len() {
                floats(lanes, lanes.mul_add(lanes.load(&xs[at..]), lanes.load(&ys[at..]), lanes.splat(c)), &mut sums);
                at += L::LANES;
            }
            defined.extend(sums.iter().zip(xs.iter().zip(&ys)).map(|(&found, (&a, &b))| {
                let expected = if L::FUSED { a.mul_add(b, c) } else { a * b + c };
                found.to_bits() == expected.to_bits() || (found.is_nan() && expected.is_nan())
            }));
        }
        records.push(Record::exact("mul_add", defined));
        records
    }
}

/// Every operation of [`Ints`], and those of [`Lanes`] on integers.
pub(super) struct IntLanes;

impl Kernel for IntLanes {
    type Out = Vec<Record>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Vec<Record> {
        let (xs, ys) = patterns::pairs(&patterns::INTS);
        let mut records = Vec::new();
        record! { lanes, records, load_int, xs, ys;
            ints "int a + b" |a, b| a + b;
            ints "int a - b" |a, b| a - b;
            ints "int a * b" |a, b| a * b;
            ints "int a & b" |a, b| a & b;
            ints "int a | b" |a, b| a | b;
            ints "int a ^ b" |a, b| a ^ b;
            ints "int min" |a, b| a.min(b);
            ints "int max" |a, b| a.max(b);
            mask "int a < b" |a, b| a.lt(b);
            mask "int a == b" |a, b| a.eq(b);
            ints "shl 0" |a, _| a.shl::<0>();
            ints "shl 1" |a, _| a.shl::<1>();
            ints "shl 28" |a, _| a.shl::<28>();
            ints "shl 31" |a, _| a.shl::<31>();
            ints "shr 0" |a, _| a.shr::<0>();
            ints "shr 1" |a, _| a.shr::<1>();
            ints "shr 23" |a, _| a.shr::<23>();
            ints "shr 31" |a, _| a.shr::<31>();
            ints "count" |a, b| a.count(b.lt(a));
            floats "to_float" |a, _| a.to_float();
            ints "as_float" |a, _| a.as_float().bits();
            ints "select_int" |a, b| lanes.select_int(a.lt(b), a, b);
            ints "select_negative" |a, b| lanes.select_negative(a, b.as_float(), (a + b).as_float()).bits();
        }
        records
    }
}

/// Every operation of [`Mask`], and operations that depend on the number of lanes and so are compared with their
/// definition.
pub(super) struct Masks;

impl Kernel for Masks {
    type Out = Vec<Record>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Vec<Record> {
        let (xs, ys) = patterns::pairs(&patterns::INTS);
        let mut records = Vec::new();
        record! { lanes, records, load_int, xs, ys;
            mask "mask a & b" |a, b| a.lt(b) & b.lt(lanes.splat_int(7));
            mask "mask a | b" |a, b| a.lt(b) | b.lt(lanes.splat_int(7));
            mask "mask a ^ b" |a, b| a.lt(b) ^ b.lt(lanes.splat_int(7));
            mask "mask !a" |a, b| !a.lt(b);
        }

        let whole = ((1u64 << L::LANES) - 1) as u32;
        let mut reductions = Vec::new();
        let mut at = 0;
        while at < xs.len() {
            let m = lanes.load_int(&xs[at..]).lt(lanes.load_int(&ys[at..]));
            let bits = (0..L::LANES).map(|lane| u32::from(xs[at + lane] < ys[at + lane]) << lane).sum::<u32>();
            reductions.extend([m.bits() == bits, m.any() == (bits != 0), m.all() == (bits == whole)]);
            reductions.push((!m).bits() == (bits ^ whole));
            at += L::LANES;
        }
        let (none, all) = (lanes.first_n(0), lanes.first_n(L::LANES));
        reductions.extend([!none.any(), !none.all(), all.any(), all.all()]);
        records.push(Record::exact("bits, any, all", reductions));

        let mut first = Vec::new();
        for n in (0..=MAX_LANES + 1).chain([usize::MAX, (1u64 << 32) as usize, i32::MAX as usize]) {
            first.push(lanes.first_n(n).bits() == ((1u64 << n.min(L::LANES)) - 1) as u32);
        }
        records.push(Record::exact("first_n", first));

        let four = [3.0, 5.0, -1.0, 0.5];
        let expected = |lane: usize| four.get(lane).copied().unwrap_or(0.0);
        let mut placed = Vec::new();
        let mut lane = 0;
        while lane < L::LANES {
            placed.push(lanes.extract(lanes.first_four(four), lane) == expected(lane));
            lane += 1;
        }
        records.push(Record::exact("first_four, extract", placed));

        let iota = lanes.iota();
        let scaled = iota.to_float() * lanes.splat(1.5);
        let (mut whole, mut halves) = (Vec::new(), Vec::new());
        lane = 0;
        while lane < 2 * MAX_LANES {
            let expected = (lane % L::LANES) as i32;
            whole.push(lanes.extract_int(iota, lane) == expected);
            halves.push(lanes.extract(scaled, lane) == 1.5 * expected as f32);
            lane += 1;
        }
        records.push(Record::exact("iota, extract_int", whole));
        records.push(Record::exact("extract", halves));

        let mut splats = Vec::new();
        for (&x, &bits) in patterns::INTS.iter().zip(&patterns::FLOATS) {
            let (mut i, mut f) = (Vec::new(), Vec::new());
            ints(lanes, lanes.splat_int(x), &mut i);
            ints(lanes, lanes.splat(f32::from_bits(bits)).bits(), &mut f);
            splats.push(i == vec![x as u32; L::LANES] && f == vec![bits; L::LANES]);
        }
        records.push(Record::exact("splat", splats));
        records.push(Record::exact("uniform", uniform(lanes)));
        records
    }
}

/// `uniform` for every mask over lanes that agree, or of which one differs.
#[inline(always)]
fn uniform<L: Lanes>(lanes: L) -> Vec<bool> {
    let mut holds = Vec::new();
    for odd in 0..=L::LANES {
        let mut index = [5; MAX_LANES];
        if odd < L::LANES {
            index[odd] = -7;
        }
        // All masks of up to eight lanes, and many of those of sixteen.
        for set in (0..1u32 << L::LANES).step_by(if L::LANES > 8 { 37 } else { 1 }) {
            let flags: [i32; MAX_LANES] = std::array::from_fn(|lane| (set >> lane & 1) as i32);
            let active = lanes.load_int(&flags).eq(lanes.splat_int(1));
            let values: Vec<i32> = (0..L::LANES).filter(|lane| set >> lane & 1 == 1).map(|lane| index[lane]).collect();
            let same = values.windows(2).all(|w| w[0] == w[1]);
            let (found, value) = lanes.uniform(lanes.load_int(&index), active);
            let expected = !values.is_empty() && same;
            holds.push(found == expected && (!expected || value == values[0]));
        }
    }
    holds
}
