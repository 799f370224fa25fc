//! A backend whose multiply-add rounds twice.

use crate::{Block, Kernel, Lanes, Texels};

/// The backend `L` with every multiply-add rounded twice: results are the same bits on every backend and width.
#[derive(Clone, Copy, Debug)]
pub struct Strict<L>(pub(crate) L);

impl<L: Lanes> Strict<L> {
    /// The backend underneath.
    pub fn inner(self) -> L {
        self.0
    }
}

/// Hands a kernel the strict form of whatever backend it is run on.
struct Strictly<K>(K);

impl<K: Kernel> Kernel for Strictly<K> {
    type Out = K::Out;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> K::Out {
        self.0.run(Strict(lanes))
    }
}

impl<L: Lanes> Lanes for Strict<L> {
    type F = L::F;
    type I = L::I;
    type M = L::M;

    const LANES: usize = L::LANES;
    const NAME: &'static str = L::NAME;
    const FUSED: bool = false;
    const PERMUTES: bool = L::PERMUTES;

    #[inline(always)]
    fn vectorize<K: Kernel>(self, kernel: K) -> K::Out {
        self.0.vectorize(Strictly(kernel))
    }

    #[inline(always)]
    fn mul_add(self, a: L::F, b: L::F, c: L::F) -> L::F {
        a * b + c
    }

    #[inline(always)]
    fn splat(self, x: f32) -> L::F {
        self.0.splat(x)
    }

    #[inline(always)]
    fn first_four(self, x: [f32; 4]) -> L::F {
        self.0.first_four(x)
    }

    #[inline(always)]
    fn splat_int(self, x: i32) -> L::I {
        self.0.splat_int(x)
    }

    #[inline(always)]
    fn iota(self) -> L::I {
        self.0.iota()
    }

    #[inline(always)]
    fn select(self, mask: L::M, a: L::F, b: L::F) -> L::F {
        self.0.select(mask, a, b)
    }

    #[inline(always)]
    fn select_int(self, mask: L::M, a: L::I, b: L::I) -> L::I {
        self.0.select_int(mask, a, b)
    }

    #[inline(always)]
    fn select_negative(self, sign: L::I, a: L::F, b: L::F) -> L::F {
        self.0.select_negative(sign, a, b)
    }

    #[inline(always)]
    fn load(self, src: &[f32]) -> L::F {
        self.0.load(src)
    }

    #[inline(always)]
    fn store(self, dst: &mut [f32], x: L::F) {
        self.0.store(dst, x)
    }

    #[inline(always)]
    fn load_int(self, src: &[i32]) -> L::I {
        self.0.load_int(src)
    }

    #[inline(always)]
    fn store_int(self, dst: &mut [i32], x: L::I) {
        self.0.store_int(dst, x)
    }

    #[inline(always)]
    fn prefetch<const LINES: usize, T>(self, memory: &[T], at: usize) {
        self.0.prefetch::<LINES, T>(memory, at);
    }

    #[inline(always)]
    fn load_xyz(self, src: &[[f32; 3]]) -> [L::F; 3] {
        self.0.load_xyz(src)
    }

    #[inline(always)]
    fn gather(self, table: &[f32], index: L::I) -> L::F {
        self.0.gather(table, index)
    }

    #[inline(always)]
    fn gather_pair(self, table: &[[f32; 2]], index: L::I) -> [L::F; 2] {
        self.0.gather_pair(table, index)
    }

    #[inline(always)]
    fn gather_quads<const N: usize>(self, block: &Block<'_, N, 4>, base: L::I) -> [[L::F; 4]; N] {
        self.0.gather_quads(block, base)
    }

    #[inline(always)]
    fn gather_quads_half<const N: usize>(self, block: &Block<'_, N, 4, u16>, base: L::I) -> [[L::F; 4]; N] {
        self.0.gather_quads_half(block, base)
    }

    #[inline(always)]
    fn oct_lookup(self, table: L::Oct, index: L::I) -> L::F {
        self.0.oct_lookup(table, index)
    }
}

impl<L: Lanes> Texels for Strict<L> {
    type Quad = L::Quad;
    type Oct = L::Oct;

    #[inline(always)]
    fn scalar_mul_add(self, a: f32, b: f32, c: f32) -> f32 {
        a * b + c
    }

    #[inline(always)]
    fn quad_load(self, src: &[f32]) -> L::Quad {
        self.0.quad_load(src)
    }

    #[inline(always)]
    fn quad_store(self, dst: &mut [f32], x: L::Quad) {
        self.0.quad_store(dst, x)
    }

    #[inline(always)]
    fn quad_max(self, a: L::Quad, b: L::Quad) -> L::Quad {
        self.0.quad_max(a, b)
    }

    #[inline(always)]
    fn oct_load(self, src: &[f32]) -> L::Oct {
        self.0.oct_load(src)
    }

    #[inline(always)]
    fn oct_store(self, dst: &mut [f32], x: L::Oct) {
        self.0.oct_store(dst, x)
    }

    #[inline(always)]
    fn oct_splat(self, x: f32) -> L::Oct {
        self.0.oct_splat(x)
    }

    #[inline(always)]
    fn oct_corners<const N: usize>(self, block: &Block<'_, N, 8>, base: usize) -> [L::Oct; N] {
        self.0.oct_corners(block, base)
    }

    #[inline(always)]
    fn oct_corners_half<const N: usize>(self, block: &Block<'_, N, 8, u16>, base: usize) -> [L::Oct; N] {
        self.0.oct_corners_half(block, base)
    }

    #[inline(always)]
    fn oct_mul_add(self, a: L::Oct, b: L::Oct, c: L::Oct) -> L::Oct {
        a * b + c
    }

    #[inline(always)]
    fn oct_max(self, a: L::Oct, b: L::Oct) -> L::Oct {
        self.0.oct_max(a, b)
    }

    #[inline(always)]
    fn oct_halves(self, x: L::Oct) -> [L::Quad; 2] {
        self.0.oct_halves(x)
    }

    #[inline(always)]
    fn quad_corners<const N: usize>(self, block: &Block<'_, N, 4>, base: usize) -> [L::Quad; N] {
        self.0.quad_corners(block, base)
    }

    #[inline(always)]
    fn quad_corners_half<const N: usize>(self, block: &Block<'_, N, 4, u16>, base: usize) -> [L::Quad; N] {
        self.0.quad_corners_half(block, base)
    }

    #[inline(always)]
    fn quad_splat(self, x: f32) -> L::Quad {
        self.0.quad_splat(x)
    }

    #[inline(always)]
    fn quad_mul_add(self, a: L::Quad, b: L::Quad, c: L::Quad) -> L::Quad {
        a * b + c
    }

    #[inline(always)]
    fn oct_count_le(self, knots: L::Oct, x: f32) -> u32 {
        self.0.oct_count_le(knots, x)
    }
}
