//! Every method of the eight-lane backend against plain arithmetic.
#![cfg(target_arch = "x86_64")]

use lobe_avx::Avx2;

lobe_testing::conformance! {
    avx2: Avx2::detect();
}
