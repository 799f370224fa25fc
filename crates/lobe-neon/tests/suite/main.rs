//! Every method of the NEON backend against plain arithmetic.
#![cfg(all(target_arch = "aarch64", target_feature = "neon", target_endian = "little"))]

use lobe_neon::Neon;

lobe_testing::conformance! {
    neon: Neon::detect();
}
