//! The token of a scalar backend.

use lobe_lane::{Block, Kernel, Lanes};

use crate::texels::{Texel, from_half};
use crate::values::each;
use crate::{Floats, Ints, Mask, Scalar};

impl<const N: usize> Lanes for Scalar<N> {
    type F = Floats<N>;
    type I = Ints<N>;
    type M = Mask<N>;
    type Narrow = Self;

    const LANES: usize = N;
    const NAME: &'static str = match N {
        1 => "scalar",
        2 => "emulated2",
        4 => "emulated4",
        8 => "emulated8",
        16 => "emulated16",
        _ => panic!("a scalar backend has 1, 2, 4, 8 or 16 lanes"),
    };
    const FUSED: bool = false;
    const PERMUTES: bool = false;

    #[inline(always)]
    fn vectorize<K: Kernel>(self, kernel: K) -> K::Out {
        kernel.run(self)
    }

    #[inline(always)]
    fn narrow(self) -> Self {
        self
    }

    #[inline(always)]
    fn splat(self, x: f32) -> Floats<N> {
        Floats([x; N])
    }
    #[inline(always)]
    fn first_four(self, x: [f32; 4]) -> Floats<N> {
        Floats(each(
            #[inline(always)]
            |lane| x.get(lane).copied().unwrap_or(0.0),
        ))
    }
    #[inline(always)]
    fn splat_int(self, x: i32) -> Ints<N> {
        Ints([x; N])
    }
    #[inline(always)]
    fn iota(self) -> Ints<N> {
        Ints(each(
            #[inline(always)]
            |lane| lane as i32,
        ))
    }
    #[inline(always)]
    fn mul_add(self, a: Floats<N>, b: Floats<N>, c: Floats<N>) -> Floats<N> {
        a * b + c
    }
    #[inline(always)]
    fn select(self, mask: Mask<N>, a: Floats<N>, b: Floats<N>) -> Floats<N> {
        Floats(each(
            #[inline(always)]
            |lane| if mask.0[lane] { a.0[lane] } else { b.0[lane] },
        ))
    }
    #[inline(always)]
    fn select_int(self, mask: Mask<N>, a: Ints<N>, b: Ints<N>) -> Ints<N> {
        Ints(each(
            #[inline(always)]
            |lane| if mask.0[lane] { a.0[lane] } else { b.0[lane] },
        ))
    }

    #[inline(always)]
    fn select_negative(self, sign: Ints<N>, a: Floats<N>, b: Floats<N>) -> Floats<N> {
        Floats(each(
            #[inline(always)]
            |lane| if sign.0[lane] < 0 { a.0[lane] } else { b.0[lane] },
        ))
    }

    #[inline(always)]
    fn load(self, src: &[f32]) -> Floats<N> {
        let src = &src[..N];
        Floats(each(
            #[inline(always)]
            |lane| src[lane],
        ))
    }
    #[inline(always)]
    fn store(self, dst: &mut [f32], x: Floats<N>) {
        dst[..N].copy_from_slice(&x.0);
    }
    #[inline(always)]
    fn load_int(self, src: &[i32]) -> Ints<N> {
        let src = &src[..N];
        Ints(each(
            #[inline(always)]
            |lane| src[lane],
        ))
    }
    #[inline(always)]
    fn store_int(self, dst: &mut [i32], x: Ints<N>) {
        dst[..N].copy_from_slice(&x.0);
    }
    #[inline(always)]
    fn load_xyz(self, src: &[[f32; 3]]) -> [Floats<N>; 3] {
        let src = &src[..N];
        let mut axes = [self.splat(0.0); 3];
        let mut axis = 0;
        while axis < 3 {
            axes[axis] = Floats(each(
                #[inline(always)]
                |lane| src[lane][axis],
            ));
            axis += 1;
        }
        axes
    }

    #[inline(always)]
    fn gather(self, table: &[f32], index: Ints<N>) -> Floats<N> {
        Floats(each(
            #[inline(always)]
            |lane| table[clamp_index(index.0[lane], table.len())],
        ))
    }
    #[inline(always)]
    fn gather_pair(self, table: &[[f32; 2]], index: Ints<N>) -> [Floats<N>; 2] {
        let mut halves = [self.splat(0.0); 2];
        let mut half = 0;
        while half < 2 {
            halves[half] = Floats(each(
                #[inline(always)]
                |lane| table[clamp_index(index.0[lane], table.len())][half],
            ));
            half += 1;
        }
        halves
    }
    #[inline(always)]
    fn gather_quads<const K: usize>(self, block: &Block<'_, K, 4>, base: Ints<N>) -> [[Floats<N>; 4]; K] {
        let mut corners = [[self.splat(0.0); 4]; K];
        let mut corner = 0;
        while corner < K {
            let found: [[f32; 4]; N] = each(
                #[inline(always)]
                |lane| {
                    let base = (base.0[lane] as u32 as usize).min(block.last_base());
                    corner_at(block.data(), base + block.offsets()[corner])
                },
            );
            corners[corner] = transposed(found);
            corner += 1;
        }
        corners
    }
    #[inline(always)]
    fn gather_quads_half<const K: usize>(self, block: &Block<'_, K, 4, u16>, base: Ints<N>) -> [[Floats<N>; 4]; K] {
        let mut corners = [[self.splat(0.0); 4]; K];
        let mut at = 0;
        while at < 4 * K {
            let (corner, k) = (at / 4, at % 4);
            let offset = block.offsets()[corner] + k;
            corners[corner][k] = Floats(each(
                #[inline(always)]
                |lane| {
                    let base = (base.0[lane] as u32 as usize).min(block.last_base());
                    from_half(block.data()[base + offset])
                },
            ));
            at += 1;
        }
        corners
    }
    #[inline(always)]
    fn oct_lookup(self, table: Texel<8>, index: Ints<N>) -> Floats<N> {
        Floats(each(
            #[inline(always)]
            |lane| table.0[(index.0[lane] & 7) as usize],
        ))
    }
}

/// The four floats of a corner. No corner of a [`Block`] lies outside; returning zeros and not panicking lets the
/// compiler drop an unused load.
#[inline(always)]
fn corner_at(table: &[f32], at: usize) -> [f32; 4] {
    match table.get(at..) {
        Some(rest) => match rest.first_chunk() {
            Some(floats) => *floats,
            None => [0.0; 4],
        },
        None => [0.0; 4],
    }
}

/// Transposes the four floats of each lane to four registers with one float per lane.
#[inline(always)]
fn transposed<const N: usize>(found: [[f32; 4]; N]) -> [Floats<N>; 4] {
    let mut out = [Floats([0.0; N]); 4];
    let mut k = 0;
    while k < 4 {
        out[k] = Floats(each(
            #[inline(always)]
            |lane| found[lane][k],
        ));
        k += 1;
    }
    out
}

/// An index outside the table reads its last entry; a negative one is far outside.
#[inline(always)]
fn clamp_index(index: i32, len: usize) -> usize {
    (index as u32 as usize).min(len - 1)
}
