//! The token of a backend, and its operations.

use crate::strict::{Strictly, backend_trait};
use crate::{Block, Floats, Ints, Mask, Strict, Texels};

/// The largest number of lanes of any backend; kernels that need an array with one entry per lane use this size.
pub const MAX_LANES: usize = 16;

/// Work to be compiled for a backend's instruction set.
pub trait Kernel {
    /// The result of the work.
    type Out;

    /// Does the work. Every implementation must be `#[inline(always)]`, and so must everything generic that it calls.
    fn run<L: Lanes>(self, lanes: L) -> Self::Out;
}

/// Calls a kernel from another one instead of inlining it, so that its code exists once per backend. The call costs a
/// few nanoseconds, so it is meant for a block of work; a loop around the call cannot keep values in registers.
#[inline(never)]
pub fn call<L: Lanes, K: Kernel>(lanes: L, kernel: K) -> K::Out {
    lanes.vectorize(kernel)
}

backend_trait! {
    /// A SIMD backend: a zero-sized proof that the CPU has the instructions, and the only source of lane values.
    ///
    /// Methods that touch memory check their slices, once per call and not per lane.
    pub trait Lanes: Texels {
        /// `LANES` floats.
        type F: Floats<I = Self::I, M = Self::M>;
        /// `LANES` signed 32-bit integers.
        type I: Ints<F = Self::F, M = Self::M>;
        /// `LANES` truth values.
        type M: Mask;

        /// The backend for work that is too small for all lanes: one query, or one ray against the eight boxes of a
        /// node. Usually the backend itself.
        type Narrow: Lanes;

        /// The number of lanes: a power of two, at most [`MAX_LANES`].
        const LANES: usize;
        /// The name of the backend, as in `LOBE_BACKEND`.
        const NAME: &'static str;
        /// `true` if [`mul_add`](Lanes::mul_add) rounds once.
        const FUSED: bool;
        /// `true` if [`oct_lookup`](Lanes::oct_lookup) is a single instruction, so that small tables are best searched
        /// inside registers. For sixteen lanes, [`look_up`](Lanes::look_up) is then also a single instruction.
        const PERMUTES: bool;

        /// Runs a kernel compiled with this backend's instructions. Call it once per batch: the kernel cannot be
        /// inlined into the caller.
        fn vectorize<K: Kernel>(self, kernel: K) -> K::Out;

        /// The same backend with [`mul_add`](Lanes::mul_add) rounded twice: bit-identical on every backend and width.
        #[inline(always)]
        fn strict(self) -> Strict<Self> {
            Strict(self)
        }
        /// The token of the backend for small work.
        fn narrow(self) -> Self::Narrow;

        /// `a * b + c`, rounded once if [`FUSED`](Lanes::FUSED), otherwise twice.
        fn mul_add(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F;
    }

    handed_on as LANES_HANDED_ON {
        /// `x` in every lane.
        fn splat(self, x: f32) -> Self::F;
        /// The four floats in lanes 0 to 3, if there are so many lanes; 0 in the others.
        fn first_four(self, x: [f32; 4]) -> Self::F;
        /// `x` in every lane.
        fn splat_int(self, x: i32) -> Self::I;
        /// `0, 1, 2, ...`
        fn iota(self) -> Self::I;
        /// Set in the first `n` lanes.
        #[inline(always)]
        fn first_n(self, n: usize) -> Self::M {
            self.iota().lt(self.splat_int(if n < Self::LANES { n as i32 } else { Self::LANES as i32 }))
        }

        /// `a` where the mask is set, else `b`.
        fn select(self, mask: Self::M, a: Self::F, b: Self::F) -> Self::F;
        /// `a` where the mask is set, else `b`.
        fn select_int(self, mask: Self::M, a: Self::I, b: Self::I) -> Self::I;

        /// `a` where `sign` is negative, else `b`: only the sign bit decides, so a bit of an index can be shifted
        /// there.
        fn select_negative(self, sign: Self::I, a: Self::F, b: Self::F) -> Self::F;

        /// The first `LANES` floats of `src`.
        ///
        /// # Panics
        /// If `src` is shorter.
        fn load(self, src: &[f32]) -> Self::F;
        /// Writes to the first `LANES` floats of `dst`.
        ///
        /// # Panics
        /// If `dst` is shorter.
        fn store(self, dst: &mut [f32], x: Self::F);
        /// The first `LANES` integers of `src`.
        ///
        /// # Panics
        /// If `src` is shorter.
        fn load_int(self, src: &[i32]) -> Self::I;
        /// Writes to the first `LANES` integers of `dst`.
        ///
        /// # Panics
        /// If `dst` is shorter.
        fn store_int(self, dst: &mut [i32], x: Self::I);
        /// As many floats as `src` has, at most `LANES`; zeros in the lanes beyond.
        #[inline(always)]
        fn load_partial(self, src: &[f32]) -> Self::F {
            if src.len() >= Self::LANES {
                return self.load(src);
            }
            let mut buffer = [0.0; MAX_LANES];
            buffer[..src.len()].copy_from_slice(src);
            self.load(&buffer)
        }
        /// Writes as many lanes as fit into `dst`, at most `LANES`.
        #[inline(always)]
        fn store_partial(self, dst: &mut [f32], x: Self::F) {
            if dst.len() >= Self::LANES {
                return self.store(dst, x);
            }
            let mut buffer = [0.0; MAX_LANES];
            self.store(&mut buffer, x);
            let n = dst.len();
            dst.copy_from_slice(&buffer[..n]);
        }
        /// Writes as many lanes as fit into `dst`, at most `LANES`.
        #[inline(always)]
        fn store_int_partial(self, dst: &mut [i32], x: Self::I) {
            if dst.len() >= Self::LANES {
                return self.store_int(dst, x);
            }
            let mut buffer = [0; MAX_LANES];
            self.store_int(&mut buffer, x);
            let n = dst.len();
            dst.copy_from_slice(&buffer[..n]);
        }
        /// Prefetches cache lines if the backend can: entry `at` of a slice, on the first of these lines, will be read
        /// soon. It may be outside the slice; then the prefetch is useless but harmless.
        #[inline(always)]
        fn prefetch<const LINES: usize, T>(self, memory: &[T], at: usize) {
            let _ = (memory, at);
        }
        /// `LANES` vectors of three floats, as `[x, y, z]`.
        ///
        /// # Panics
        /// If `src` is shorter.
        fn load_xyz(self, src: &[[f32; 3]]) -> [Self::F; 3];

        /// `table[index]` in each lane. An index outside the table reads the last entry, as does a negative one.
        ///
        /// # Panics
        /// If the table is empty.
        fn gather(self, table: &[f32], index: Self::I) -> Self::F;
        /// The two floats of `table[index]` in each lane; an index outside reads the last entry.
        ///
        /// # Panics
        /// If the table is empty.
        fn gather_pair(self, table: &[[f32; 2]], index: Self::I) -> [Self::F; 2];
        /// In each lane, the four floats at `base + offset` of the block, for each of its offsets; a base that is too
        /// large is clamped to the block's last base. The result is transposed: `[corner][k]` holds float `k` of that
        /// corner in all lanes.
        fn gather_quads<const N: usize>(self, block: &Block<'_, N, 4>, base: Self::I) -> [[Self::F; 4]; N];
        /// Like [`gather_quads`](Lanes::gather_quads), from the first `LANES` bases of a slice. It is faster if they were
        /// stored long before, because the indices need not be extracted from a vector.
        ///
        /// # Panics
        /// If `bases` is shorter.
        #[inline(always)]
        fn gather_quads_at<const N: usize>(self, block: &Block<'_, N, 4>, bases: &[i32]) -> [[Self::F; 4]; N] {
            self.gather_quads(block, self.load_int(bases))
        }
        /// Like [`gather_quads`](Lanes::gather_quads), from half-precision floats.
        fn gather_quads_half<const N: usize>(self, block: &Block<'_, N, 4, u16>, base: Self::I) -> [[Self::F; 4]; N];
        /// In each lane, float `index & 7` of the eight in `table`.
        fn oct_lookup(self, table: Self::Oct, index: Self::I) -> Self::F;
        /// Entry `index` of a table in `N` registers, where `N` is 1, 2 or 4: only the bits of the index that address
        /// an entry matter.
        #[inline(always)]
        fn look_up<const N: usize>(self, table: [Self::F; N], index: Self::I) -> Self::F {
            const { assert!(N == 1 || N == 2 || N == 4, "a table in 1, 2 or 4 registers") };
            let mut entries = [0.0; 4 * MAX_LANES];
            let mut register = 0;
            while register < N {
                self.store(&mut entries[register * Self::LANES..], table[register]);
                register += 1;
            }
            self.gather(&entries, index & self.splat_int((N * Self::LANES - 1) as i32))
        }
        /// One step down a binary tree whose node `n` has the children `2 n` and `2 n + 1`: goes to the latter where
        /// the sign bit of `difference` is set.
        #[inline(always)]
        fn descend(self, node: Self::I, difference: Self::F) -> Self::I {
            node.shl::<1>() | difference.bits().shr::<31>()
        }

        /// `true` and the index if all lanes of `mask` hold the same one; `false` if they differ or no lane is set.
        #[inline(always)]
        fn uniform(self, index: Self::I, mask: Self::M) -> (bool, i32) {
            let bits = mask.bits();
            if bits == 0 {
                return (false, 0);
            }
            let first = self.extract_int(index, bits.trailing_zeros() as usize);
            let same = index.eq(self.splat_int(first));
            (same.bits() & bits == bits, first)
        }
        /// Integer in lane `lane` (modulo `LANES`).
        #[inline(always)]
        fn extract_int(self, x: Self::I, lane: usize) -> i32 {
            let mut buffer = [0; MAX_LANES];
            self.store_int(&mut buffer, x);
            buffer[lane & (Self::LANES - 1)]
        }
        /// A vector in every lane.
        #[inline(always)]
        fn splat_xyz(self, vector: [f32; 3]) -> [Self::F; 3] {
            let [x, y, z] = vector;
            [self.splat(x), self.splat(y), self.splat(z)]
        }

        /// The vector in lane `lane` (modulo `LANES`).
        #[inline(always)]
        fn extract_xyz(self, vectors: [Self::F; 3], lane: usize) -> [f32; 3] {
            let [x, y, z] = vectors;
            [self.extract(x, lane), self.extract(y, lane), self.extract(z, lane)]
        }

        /// Float in lane `lane` (modulo `LANES`).
        #[inline(always)]
        fn extract(self, x: Self::F, lane: usize) -> f32 {
            let mut buffer = [0.0; MAX_LANES];
            self.store(&mut buffer, x);
            buffer[lane & (Self::LANES - 1)]
        }
    }

    strict {
        type F = L::F;
        type I = L::I;
        type M = L::M;
        type Narrow = Strict<L::Narrow>;

        const LANES: usize = L::LANES;
        const NAME: &'static str = L::NAME;
        const FUSED: bool = false;
        const PERMUTES: bool = L::PERMUTES;

        #[inline(always)]
        fn vectorize<K: Kernel>(self, kernel: K) -> K::Out {
            self.0.vectorize(Strictly(kernel))
        }

        #[inline(always)]
        fn narrow(self) -> Strict<L::Narrow> {
            Strict(self.0.narrow())
        }

        #[inline(always)]
        fn mul_add(self, a: L::F, b: L::F, c: L::F) -> L::F {
            a * b + c
        }
    }
}
