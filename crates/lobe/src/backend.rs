//! Which SIMD instructions to use, chosen when the program runs.

use std::fmt;
use std::sync::OnceLock;

use lobe_lane::{Kernel, Lanes};
use lobe_scalar::Scalar;
use thiserror::Error;

/// The environment variable that overrides detection.
pub const BACKEND_VARIABLE: &str = "LOBE_BACKEND";

/// A backend that this CPU has, and whether its results are the same bits as every other backend's.
///
/// ```
/// use lobe::{Backend, Kernel, Lanes};
///
/// struct Width;
/// impl Kernel for Width {
///     type Out = usize;
///     #[inline(always)]
///     fn run<L: Lanes>(self, _lanes: L) -> usize {
///         L::LANES
///     }
/// }
///
/// let backend = Backend::detect()?;
/// assert_eq!(backend.run(Width), backend.lanes());
/// # Ok::<(), lobe::BackendError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Backend {
    isa: Isa,
    strict: bool,
}

/// One token a backend: having one proves that the CPU can run it.
#[derive(Clone, Copy, Debug)]
enum Isa {
    Scalar,
    #[cfg(target_arch = "x86_64")]
    Sse2(lobe_sse::Sse2),
    #[cfg(target_arch = "x86_64")]
    Sse41(lobe_sse::Sse41),
    #[cfg(target_arch = "x86_64")]
    Avx2(lobe_avx::Avx2),
}

/// A name that is no backend of this machine.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("backend `{name}` is {why}; this machine has: {available}")]
pub struct BackendError {
    /// The name asked for.
    pub name: String,
    /// `unknown`, or `not supported by this CPU`.
    pub why: &'static str,
    /// The backends that there are, separated by commas.
    pub available: String,
}

/// Every name that some machine may have, slowest first.
const NAMES: [&str; 4] = ["scalar", "sse2", "sse4.1", "avx2"];

impl Backend {
    /// The backend that the environment variable `LOBE_BACKEND` names, else the fastest of this CPU.
    ///
    /// # Errors
    /// Where the variable holds a name that is unknown or that this CPU cannot run; the error lists what there is.
    pub fn detect() -> Result<Self, BackendError> {
        static DETECTED: OnceLock<Result<Backend, BackendError>> = OnceLock::new();
        DETECTED
            .get_or_init(|| match std::env::var(BACKEND_VARIABLE) {
                Ok(name) if !name.is_empty() => Backend::named(&name),
                _ => Ok(Backend::best()),
            })
            .clone()
    }

    /// The fastest backend of this CPU, whatever the environment says.
    pub fn best() -> Self {
        *Backend::available().last().expect("the scalar backend is always there")
    }

    /// The backend of that name.
    ///
    /// # Errors
    /// Where the name is unknown, or this CPU cannot run it; the error lists what there is.
    pub fn named(name: &str) -> Result<Self, BackendError> {
        let available = Backend::available();
        available.iter().copied().find(|backend| backend.name() == name).ok_or_else(|| BackendError {
            name: name.into(),
            why: if NAMES.contains(&name) { "not supported by this CPU" } else { "unknown" },
            available: available.iter().map(Backend::name).collect::<Vec<_>>().join(", "),
        })
    }

    /// All backends of this CPU, slowest first.
    pub fn available() -> Vec<Self> {
        let mut found = vec![Isa::Scalar];
        cfg_if::cfg_if! {
            if #[cfg(target_arch = "x86_64")] {
                found.push(Isa::Sse2(lobe_sse::Sse2::new()));
                found.extend(lobe_sse::Sse41::detect().map(Isa::Sse41));
                found.extend(lobe_avx::Avx2::detect().map(Isa::Avx2));
            }
        }
        found.into_iter().map(|isa| Backend { isa, strict: STRICT_BY_DEFAULT }).collect()
    }

    /// The same backend with every multiply-add rounded twice: the same bits on every machine.
    pub fn strict(self) -> Self {
        Backend { strict: true, ..self }
    }

    /// The same backend with multiply-adds rounded once where the hardware does: fastest, and equal to the strict form
    /// within the bounds of `docs/accuracy.md`.
    pub fn fused(self) -> Self {
        Backend { strict: false, ..self }
    }

    /// `true` where results are the same bits on every machine.
    pub fn is_strict(&self) -> bool {
        self.strict
    }

    /// The name, as `LOBE_BACKEND` takes it.
    pub fn name(&self) -> &'static str {
        match self.isa {
            Isa::Scalar => Scalar::<1>::NAME,
            #[cfg(target_arch = "x86_64")]
            Isa::Sse2(_) => lobe_sse::Sse2::NAME,
            #[cfg(target_arch = "x86_64")]
            Isa::Sse41(_) => lobe_sse::Sse41::NAME,
            #[cfg(target_arch = "x86_64")]
            Isa::Avx2(_) => lobe_avx::Avx2::NAME,
        }
    }

    /// How many lanes it has.
    pub fn lanes(&self) -> usize {
        match self.isa {
            Isa::Scalar => Scalar::<1>::LANES,
            #[cfg(target_arch = "x86_64")]
            Isa::Sse2(_) => lobe_sse::Sse2::LANES,
            #[cfg(target_arch = "x86_64")]
            Isa::Sse41(_) => lobe_sse::Sse41::LANES,
            #[cfg(target_arch = "x86_64")]
            Isa::Avx2(_) => lobe_avx::Avx2::LANES,
        }
    }

    /// Runs a kernel on this backend. Once per batch: the dispatch and the loss of inlining are paid each time.
    #[inline]
    pub fn run<K: Kernel>(&self, kernel: K) -> K::Out {
        // Backends that never fuse have one form, compiled once.
        match (self.isa, self.strict) {
            (Isa::Scalar, _) => Scalar::<1>.vectorize(kernel),
            #[cfg(target_arch = "x86_64")]
            (Isa::Sse2(lanes), _) => lanes.vectorize(kernel),
            #[cfg(target_arch = "x86_64")]
            (Isa::Sse41(lanes), _) => lanes.vectorize(kernel),
            #[cfg(target_arch = "x86_64")]
            (Isa::Avx2(lanes), false) => lanes.vectorize(kernel),
            #[cfg(target_arch = "x86_64")]
            (Isa::Avx2(lanes), true) => lanes.strict().vectorize(kernel),
        }
    }
}

impl fmt::Display for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.name())
    }
}

/// Which form a backend has unless told otherwise; the measurement that decided is in `docs/accuracy.md`.
const STRICT_BY_DEFAULT: bool = false;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_names_are_refused_with_a_list() {
        let error = Backend::named("mmx").unwrap_err();
        assert_eq!(error.why, "unknown");
        assert!(error.to_string().contains("scalar"), "{error}");
    }

    #[test]
    fn every_available_backend_is_found_by_its_name() {
        for backend in Backend::available() {
            assert!(NAMES.contains(&backend.name()));
            let found = Backend::named(backend.name()).unwrap();
            assert_eq!((found.name(), found.lanes()), (backend.name(), backend.lanes()));
        }
    }
}
