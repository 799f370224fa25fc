//! Every method of the scalar backends against plain arithmetic.

mod strict;

use lobe_scalar::Scalar;

lobe_testing::conformance! {
    scalar: Some(Scalar::<1>);
    emulated2: Some(Scalar::<2>);
    emulated4: Some(Scalar::<4>);
    emulated8: Some(Scalar::<8>);
    emulated16: Some(Scalar::<16>);
}
