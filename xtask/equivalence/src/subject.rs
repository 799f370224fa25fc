//! The backends that are checked, and their forms.

use lobe::Backend;
use serde::Serialize;

#[cfg(feature = "emulated")]
use super::machine::Emulated;
use super::{Property, Record};

/// Rounding of multiply-adds: twice, or once if the hardware supports it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// Twice: the same bits everywhere.
    Strict,
    /// Once.
    Fused,
}

/// A subject that is checked against the reference, the scalar backend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Four lanes in plain Rust.
    Emulated4,
    /// Eight lanes in plain Rust.
    Emulated8,
    /// Sixteen lanes in plain Rust.
    Emulated16,
    /// A backend by name.
    Native(&'static str),
}

impl Subject {
    /// All subjects, on any machine.
    pub fn all() -> Vec<Subject> {
        let emulated: &[Subject] =
            if cfg!(feature = "emulated") { &[Self::Emulated4, Self::Emulated8, Self::Emulated16] } else { &[] };
        emulated.iter().copied().chain(Backend::ALL[1..].iter().map(|name| Self::Native(name))).collect()
    }

    /// The name, which for backends is the one that `LOBE_BACKEND` takes.
    pub fn name(self) -> &'static str {
        match self {
            Subject::Emulated4 => "emulated4",
            Subject::Emulated8 => "emulated8",
            Subject::Emulated16 => "emulated16",
            Subject::Native(name) => name,
        }
    }

    /// The backend, if this is one and this CPU has it.
    fn backend(self) -> Option<Backend> {
        match self {
            Subject::Native(name) => Backend::named(name).ok(),
            _ => None,
        }
    }

    /// The number of lanes; `None` if this CPU does not have the backend.
    pub fn lanes(self) -> Option<usize> {
        match self {
            Subject::Emulated4 => Some(4),
            Subject::Emulated8 => Some(8),
            Subject::Emulated16 => Some(16),
            Subject::Native(_) => self.backend().map(|backend| backend.lanes()),
        }
    }

    /// The forms in which its results may differ.
    pub fn forms(self) -> &'static [Form] {
        match self.backend() {
            Some(backend) if backend.has_fused_form() => &[Form::Strict, Form::Fused],
            _ => &[Form::Strict],
        }
    }

    /// `true` if this CPU should be able to run it. It asks the CPU and not the backends, whose own detection is
    /// checked against this.
    pub fn expected(self) -> bool {
        match self {
            Subject::Native(name) => Backend::reported().contains(&name),
            _ => cfg!(feature = "emulated"),
        }
    }

    /// The records of `property` in this form; `None` if the backend says that this CPU cannot run it.
    pub fn record(self, form: Form, property: Property) -> Option<Vec<Record>> {
        match self {
            #[cfg(feature = "emulated")]
            Subject::Emulated4 => Some(property.record(Emulated::<4>)),
            #[cfg(feature = "emulated")]
            Subject::Emulated8 => Some(property.record(Emulated::<8>)),
            #[cfg(feature = "emulated")]
            Subject::Emulated16 => Some(property.record(Emulated::<16>)),
            #[cfg(not(feature = "emulated"))]
            Subject::Emulated4 | Subject::Emulated8 | Subject::Emulated16 => None,
            Subject::Native(_) => self
                .backend()
                .map(|backend| property.record(if form == Form::Strict { backend.strict() } else { backend.fused() })),
        }
    }
}

/// The reference, with which everything else is compared.
pub fn reference(property: Property) -> Vec<Record> {
    property.record(Backend::scalar().strict())
}

/// Checks that exactly those backends are available that this CPU should have.
///
/// # Errors
/// The two lists, if they differ.
pub fn facade_agrees() -> anyhow::Result<()> {
    let expected = Backend::reported();
    let offered: Vec<&str> = Backend::available().iter().map(Backend::name).collect();
    anyhow::ensure!(offered == expected, "the facade offers {offered:?}; this CPU should have {expected:?}");
    Ok(())
}
