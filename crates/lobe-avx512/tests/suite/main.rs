//! Every method of the sixteen-lane backend against plain arithmetic.
#![cfg(target_arch = "x86_64")]

use lobe_avx512::Avx512;

lobe_testing::conformance! {
    avx512: Avx512::detect();
}
