//! The backends that are checked, and in which forms.

use lobe_lane::Lanes;
use lobe_scalar::Scalar;
use serde::Serialize;

use super::{Property, Record};

/// Whether multiply-adds round twice or, where the hardware does so, once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// Twice: the same bits everywhere.
    Strict,
    /// Once.
    Fused,
}

/// A backend to be checked against the reference, [`Scalar<1>`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Four lanes in plain Rust.
    Emulated4,
    /// Eight lanes in plain Rust.
    Emulated8,
    /// Sixteen lanes in plain Rust.
    Emulated16,
    /// Four lanes on SSE2.
    Sse2,
    /// Four lanes on SSE4.1.
    Sse41,
    /// Eight lanes on AVX2 and FMA.
    Avx2,
}

impl Subject {
    /// All of them, on any machine.
    pub const ALL: [Subject; 6] =
        [Self::Emulated4, Self::Emulated8, Self::Emulated16, Self::Sse2, Self::Sse41, Self::Avx2];

    /// The name, which for those of the facade is that of `LOBE_BACKEND`.
    pub fn name(self) -> &'static str {
        match self {
            Subject::Emulated4 => "emulated4",
            Subject::Emulated8 => "emulated8",
            Subject::Emulated16 => "emulated16",
            Subject::Sse2 => "sse2",
            Subject::Sse41 => "sse4.1",
            Subject::Avx2 => "avx2",
        }
    }

    /// How many lanes it has.
    pub fn lanes(self) -> usize {
        match self {
            Subject::Emulated4 | Subject::Sse2 | Subject::Sse41 => 4,
            Subject::Emulated8 | Subject::Avx2 => 8,
            Subject::Emulated16 => 16,
        }
    }

    /// The forms in which its results may differ.
    pub fn forms(self) -> &'static [Form] {
        match self {
            Subject::Avx2 => &[Form::Strict, Form::Fused],
            _ => &[Form::Strict],
        }
    }

    /// `true` for backends that the facade offers, where the CPU has them.
    pub fn is_native(self) -> bool {
        !matches!(self, Subject::Emulated4 | Subject::Emulated8 | Subject::Emulated16)
    }

    /// Whether this CPU has to be able to run it. Asks the CPU and not the backends, whose own detection is checked
    /// against this.
    pub fn expected(self) -> bool {
        #[cfg(target_arch = "x86_64")]
        return match self {
            Subject::Sse2 => std::is_x86_feature_detected!("sse2"),
            Subject::Sse41 => std::is_x86_feature_detected!("sse4.1"),
            Subject::Avx2 => {
                std::is_x86_feature_detected!("avx2")
                    && std::is_x86_feature_detected!("fma")
                    && std::is_x86_feature_detected!("f16c")
                    && std::is_x86_feature_detected!("bmi1")
                    && std::is_x86_feature_detected!("bmi2")
                    && std::is_x86_feature_detected!("lzcnt")
                    && std::is_x86_feature_detected!("popcnt")
            }
            _ => true,
        };
        #[cfg(not(target_arch = "x86_64"))]
        return !self.is_native();
    }

    /// What `property` records on this backend; `None` where the backend says that this CPU cannot run it.
    ///
    /// Backends that never fuse have one form and are run as they are.
    pub fn record(self, form: Form, property: Property) -> Option<Vec<Record>> {
        match self {
            Subject::Emulated4 => Some(property.record(Scalar::<4>)),
            Subject::Emulated8 => Some(property.record(Scalar::<8>)),
            Subject::Emulated16 => Some(property.record(Scalar::<16>)),
            #[cfg(target_arch = "x86_64")]
            Subject::Sse2 => Some(property.record(lobe_sse::Sse2::new())),
            #[cfg(target_arch = "x86_64")]
            Subject::Sse41 => lobe_sse::Sse41::detect().map(|lanes| property.record(lanes)),
            #[cfg(target_arch = "x86_64")]
            Subject::Avx2 => lobe_avx::Avx2::detect().map(|lanes| match form {
                Form::Strict => property.record(lanes.strict()),
                Form::Fused => property.record(lanes),
            }),
            #[cfg(not(target_arch = "x86_64"))]
            _ => None,
        }
    }
}

/// What every backend is compared with.
pub fn reference(property: Property) -> Vec<Record> {
    property.record(Scalar::<1>)
}

/// Whether the facade offers exactly the native backends that this CPU has to have, beside the scalar one.
///
/// # Errors
/// The two lists, where they differ.
pub fn facade_agrees() -> anyhow::Result<()> {
    let expected: Vec<&str> = std::iter::once("scalar")
        .chain(Subject::ALL.into_iter().filter(|s| s.is_native() && s.expected()).map(Subject::name))
        .collect();
    let offered: Vec<&str> = lobe::Backend::available().iter().map(lobe::Backend::name).collect();
    anyhow::ensure!(offered == expected, "the facade offers {offered:?}; this CPU has to have {expected:?}");
    Ok(())
}
