//! Every method of the four-lane backends against plain arithmetic.
#![cfg(target_arch = "x86_64")]

use lobe_sse::{Sse2, Sse41};

lobe_testing::conformance! {
    sse2: Some(Sse2::new());
    sse41: Sse41::detect();
}
