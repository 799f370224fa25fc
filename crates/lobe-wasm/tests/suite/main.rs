//! Every method of the WebAssembly backend against plain arithmetic.
#![cfg(all(target_arch = "wasm32", target_feature = "simd128"))]

use lobe_wasm::Simd128;

lobe_testing::conformance! {
    simd128: Some(Simd128::new());
}
