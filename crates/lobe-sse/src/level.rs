//! The instructions that SSE2 and SSE4.1 do differently.

use core::arch::x86_64::*;
use core::fmt::Debug;

use lobe_lane::{Kernel, Lanes};

use crate::Sse;

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::V2 {}
    impl Sealed for super::V41 {}
}

/// An instruction-set level of four lanes. Sealed: each level is a promise about the CPU, and each of its operations
/// takes the token that proves it.
pub trait Level: sealed::Sealed + Copy + Debug + Send + Sync + 'static {
    #[doc(hidden)]
    const NAME: &'static str;
    #[doc(hidden)]
    fn select(_proof: Sse<Self>, mask: __m128, a: __m128, b: __m128) -> __m128;
    #[doc(hidden)]
    fn select_negative(_proof: Sse<Self>, sign: __m128, a: __m128, b: __m128) -> __m128;
    #[doc(hidden)]
    fn mul(_proof: Sse<Self>, a: __m128i, b: __m128i) -> __m128i;
    #[doc(hidden)]
    fn min(_proof: Sse<Self>, a: __m128i, b: __m128i) -> __m128i;
    #[doc(hidden)]
    fn max(_proof: Sse<Self>, a: __m128i, b: __m128i) -> __m128i;
    #[doc(hidden)]
    fn enter<K: Kernel>(token: Sse<Self>, kernel: K) -> K::Out
    where
        Sse<Self>: Lanes;
}

/// SSE2.
#[derive(Clone, Copy, Debug)]
pub enum V2 {}

/// SSE4.1.
#[derive(Clone, Copy, Debug)]
pub enum V41 {}

impl Level for V2 {
    const NAME: &'static str = "sse2";

    #[inline(always)]
    fn select(_proof: Sse<Self>, mask: __m128, a: __m128, b: __m128) -> __m128 {
        op!(_mm_or_ps(_mm_and_ps(mask, a), _mm_andnot_ps(mask, b)))
    }

    #[inline(always)]
    fn select_negative(proof: Sse<Self>, sign: __m128, a: __m128, b: __m128) -> __m128 {
        let mask = op!(_mm_castsi128_ps(_mm_srai_epi32::<31>(_mm_castps_si128(sign))));
        Self::select(proof, mask, a, b)
    }

    #[inline(always)]
    fn mul(_proof: Sse<Self>, a: __m128i, b: __m128i) -> __m128i {
        op!({
            let even = _mm_mul_epu32(a, b);
            let odd = _mm_mul_epu32(_mm_srli_epi64::<32>(a), _mm_srli_epi64::<32>(b));
            _mm_unpacklo_epi32(_mm_shuffle_epi32::<0b00_00_10_00>(even), _mm_shuffle_epi32::<0b00_00_10_00>(odd))
        })
    }

    #[inline(always)]
    fn min(_proof: Sse<Self>, a: __m128i, b: __m128i) -> __m128i {
        op!({
            let less = _mm_cmplt_epi32(a, b);
            _mm_or_si128(_mm_and_si128(less, a), _mm_andnot_si128(less, b))
        })
    }

    #[inline(always)]
    fn max(_proof: Sse<Self>, a: __m128i, b: __m128i) -> __m128i {
        op!({
            let less = _mm_cmplt_epi32(a, b);
            _mm_or_si128(_mm_and_si128(less, b), _mm_andnot_si128(less, a))
        })
    }

    #[inline(always)]
    fn enter<K: Kernel>(token: Sse<Self>, kernel: K) -> K::Out {
        kernel.run(token)
    }
}

impl Level for V41 {
    const NAME: &'static str = "sse4.1";

    #[inline(always)]
    fn select(_proof: Sse<Self>, mask: __m128, a: __m128, b: __m128) -> __m128 {
        op!(_mm_blendv_ps(b, a, mask))
    }

    #[inline(always)]
    fn select_negative(_proof: Sse<Self>, sign: __m128, a: __m128, b: __m128) -> __m128 {
        op!(_mm_blendv_ps(b, a, sign))
    }

    #[inline(always)]
    fn mul(_proof: Sse<Self>, a: __m128i, b: __m128i) -> __m128i {
        op!(_mm_mullo_epi32(a, b))
    }

    #[inline(always)]
    fn min(_proof: Sse<Self>, a: __m128i, b: __m128i) -> __m128i {
        op!(_mm_min_epi32(a, b))
    }

    #[inline(always)]
    fn max(_proof: Sse<Self>, a: __m128i, b: __m128i) -> __m128i {
        op!(_mm_max_epi32(a, b))
    }

    #[inline(always)]
    fn enter<K: Kernel>(token: Sse<Self>, kernel: K) -> K::Out {
        #[target_feature(enable = "sse4.1")]
        fn inner<K: Kernel>(token: Sse41Token, kernel: K) -> K::Out {
            kernel.run(token)
        }
        type Sse41Token = Sse<V41>;
        // SAFETY: the token proves SSE4.1.
        unsafe { inner(token, kernel) }
    }
}
