//! The list of backends, and everything that is generated from it.

use lobe_lane::{Kernel, Lanes};

#[cfg(target_arch = "aarch64")]
use std::arch::is_aarch64_feature_detected as has;
#[cfg(target_arch = "x86_64")]
use std::arch::is_x86_feature_detected as has;

macro_rules! backends {
    ($dollar:tt $($(#[$target:meta])* $name:literal, $variant:ident($token:ty), $detect:expr, [$($feature:tt),*];)*) => {
        /// One token per backend, which proves that the CPU can run it.
        #[derive(Clone, Copy, Debug)]
        pub(crate) enum Isa {
            $($(#[$target])* $variant($token),)*
        }

        /// The names of all backends, slowest first on each target.
        pub(crate) const NAMES: &[&str] = &[$($name),*];

        /// Passes the variant and the name of every backend, of any target, to a macro: `macro! { Sse2 "sse2"; ... }`,
        /// for tests that are named by backend.
        #[doc(hidden)]
        #[macro_export]
        macro_rules! each_backend {
            ($dollar callback:ident) => {
                $dollar callback! { $($variant $name;)* }
            };
        }

        $($(#[$target])* impl From<$token> for Isa {
            fn from(token: $token) -> Self {
                Isa::$variant(token)
            }
        })*

        impl Isa {
            /// All backends that this CPU can run, slowest first.
            pub(crate) fn detect() -> Vec<Self> {
                let mut found = Vec::new();
                $($(#[$target])* found.extend(Option::<$token>::map($detect, Isa::$variant));)*
                found
            }

            /// The names of the backends whose instructions the CPU reports, without asking the backends themselves.
            pub(crate) fn reported() -> Vec<&'static str> {
                let mut names = Vec::new();
                $($(#[$target])* if true $(&& has!($feature))* {
                    names.push($name);
                })*
                names
            }

            pub(crate) fn name(self) -> &'static str {
                match self {
                    $($(#[$target])* Isa::$variant(_) => <$token>::NAME,)*
                }
            }

            pub(crate) fn lanes(self) -> usize {
                match self {
                    $($(#[$target])* Isa::$variant(_) => <$token>::LANES,)*
                }
            }

            pub(crate) fn fuses(self) -> bool {
                match self {
                    $($(#[$target])* Isa::$variant(_) => <$token>::FUSED,)*
                }
            }

            /// The narrow backend of this one.
            pub(crate) fn narrow(self) -> Self {
                match self {
                    $($(#[$target])* Isa::$variant(lanes) => lanes.narrow().into(),)*
                }
            }

            #[inline]
            pub(crate) fn run_narrow<K: Kernel>(self, strict: bool, kernel: K) -> K::Out {
                match self {
                    $($(#[$target])* Isa::$variant(lanes) => run(lanes.narrow(), strict, kernel),)*
                }
            }

            #[inline]
            pub(crate) fn run<K: Kernel>(self, strict: bool, kernel: K) -> K::Out {
                match self {
                    $($(#[$target])* Isa::$variant(lanes) => run(lanes, strict, kernel),)*
                }
            }
        }
    };
}

// One line per backend, slowest first: its name, its token, how the token is obtained, and the CPU features that it
// needs.
backends! { $
    "scalar", Scalar(lobe_scalar::Scalar<1>), Some(lobe_scalar::Scalar), [];
    #[cfg(target_arch = "x86_64")]
    "sse2", Sse2(lobe_sse::Sse2), Some(lobe_sse::Sse2::new()), ["sse2"];
    #[cfg(target_arch = "x86_64")]
    "sse4.1", Sse41(lobe_sse::Sse41), lobe_sse::Sse41::detect(), ["sse4.1"];
    #[cfg(target_arch = "x86_64")]
    "avx2", Avx2(lobe_avx::Avx2), lobe_avx::Avx2::detect(), ["avx2", "fma", "f16c", "bmi1", "bmi2", "lzcnt", "popcnt"];
    #[cfg(target_arch = "x86_64")]
    "avx512", Avx512(lobe_avx512::Avx512), lobe_avx512::Avx512::detect(), [
        "avx512f", "avx512vl", "avx512dq", "avx512bw", "avx512vbmi2",
        "avx2", "fma", "f16c", "bmi1", "bmi2", "lzcnt", "popcnt"
    ];
    #[cfg(all(target_arch = "aarch64", target_feature = "neon", target_endian = "little"))]
    "neon", Neon(lobe_neon::Neon), lobe_neon::Neon::detect(), ["neon"];
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    "simd128", Simd128(lobe_wasm::Simd128), Some(lobe_wasm::Simd128::new()), [];
}

/// Backends that never fuse have one form, which is compiled once.
#[inline]
fn run<L: Lanes, K: Kernel>(lanes: L, strict: bool, kernel: K) -> K::Out {
    if L::FUSED {
        if strict { lanes.strict().vectorize(kernel) } else { lanes.vectorize(kernel) }
    } else {
        lanes.vectorize(kernel)
    }
}
