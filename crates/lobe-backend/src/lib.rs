//! The choice of SIMD instructions at run time.
//!
//! This is the only crate that names the backends: each is one line of the list in `src/list.rs`, and everything else
//! uses [`Backend`]. [`Backend::run`] compiles a kernel for every backend of the target, so put a kernel behind a
//! non-generic function in the crate that defines it: it is then compiled once per backend, and not again in every
//! program.
#![forbid(unsafe_code)]

mod list;

use std::fmt;
use std::sync::OnceLock;

use lobe_lane::Kernel;
#[cfg(doc)]
use lobe_lane::Lanes;
use thiserror::Error;

use list::{Isa, NAMES};

/// The environment variable that overrides detection.
pub const BACKEND_VARIABLE: &str = "LOBE_BACKEND";

/// A backend that this CPU supports, in strict form, whose results have the same bits on every backend, or in fused
/// form.
///
/// ```
/// use lobe_backend::Backend;
/// use lobe_lane::{Kernel, Lanes};
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
/// # Ok::<(), lobe_backend::BackendError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Backend {
    isa: Isa,
    strict: bool,
}

/// The name of a backend that does not exist, or that this machine cannot run.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("backend `{name}` is {why}; this machine has: {available}")]
pub struct BackendError {
    /// The requested name.
    pub name: String,
    /// `unknown`, or `not supported by this CPU`.
    pub why: &'static str,
    /// The available backends, separated by commas.
    pub available: String,
}

impl Backend {
    /// The names of all backends, slowest first, including those that this machine cannot run.
    pub const ALL: &[&str] = NAMES;

    /// The backend named by the environment variable `LOBE_BACKEND`, or else the fastest that this CPU can run.
    ///
    /// # Errors
    /// If the variable holds a name that is unknown or that this CPU cannot run; the error lists those available.
    pub fn detect() -> Result<Self, BackendError> {
        static DETECTED: OnceLock<Result<Backend, BackendError>> = OnceLock::new();
        DETECTED
            .get_or_init(|| match std::env::var(BACKEND_VARIABLE) {
                Ok(name) if !name.is_empty() => Backend::named(&name),
                _ => Ok(Backend::best()),
            })
            .clone()
    }

    /// The fastest backend of this CPU, ignoring the environment.
    pub fn best() -> Self {
        *Backend::available().last().expect("the scalar backend is always available")
    }

    /// The scalar backend, which defines the strict results of all others.
    pub fn scalar() -> Self {
        Backend::available()[0]
    }

    /// The backend with this name.
    ///
    /// # Errors
    /// If the name is unknown, or this CPU cannot run it; the error lists those available.
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
        Isa::detect().into_iter().map(|isa| Backend { isa, strict: STRICT_BY_DEFAULT }).collect()
    }

    /// All backends of this CPU, slowest first: each in strict form and, if it differs, in fused form.
    pub fn forms() -> Vec<Self> {
        let forms = |backend: Backend| [Some(backend.strict()), backend.has_fused_form().then(|| backend.fused())];
        Backend::available().into_iter().flat_map(forms).flatten().collect()
    }

    /// The names of the backends whose instructions the CPU reports, slowest first. The backends themselves are not
    /// asked, so that their own detection can be checked: the names must be those of [`available`](Backend::available).
    pub fn reported() -> Vec<&'static str> {
        Isa::reported()
    }

    /// The same backend with every multiply-add rounded twice, which gives the same bits on every machine.
    pub fn strict(self) -> Self {
        Backend { strict: true, ..self }
    }

    /// The same backend with multiply-adds rounded once if the hardware can: fastest, and equal to the strict form
    /// within the bounds of `docs/accuracy.md`.
    pub fn fused(self) -> Self {
        Backend { strict: false, ..self }
    }

    /// `true` if results have the same bits on every machine.
    pub fn is_strict(&self) -> bool {
        self.strict
    }

    /// `true` if the fused form differs from the strict one.
    pub fn has_fused_form(&self) -> bool {
        self.isa.fuses()
    }

    /// The name, as accepted by `LOBE_BACKEND`.
    pub fn name(&self) -> &'static str {
        self.isa.name()
    }

    /// The number of lanes.
    pub fn lanes(&self) -> usize {
        self.isa.lanes()
    }

    /// Runs a kernel on this backend. Call it once per batch: each call costs a dispatch and is not inlined.
    #[inline]
    pub fn run<K: Kernel>(&self, kernel: K) -> K::Out {
        self.isa.run(self.strict, kernel)
    }

    /// The [narrow](Lanes::narrow) backend of this one, in the same form: usually the backend itself. It is faster for
    /// a few queries, and gives the same bits if this backend is strict.
    pub fn narrow(self) -> Self {
        Backend { isa: self.isa.narrow(), ..self }
    }

    /// Runs a kernel that is too small for many lanes, such as a single query, on the [narrow](Self::narrow) backend.
    /// If that is a different one, the kernel is not compiled for the wide lanes.
    #[inline]
    pub fn run_narrow<K: Kernel>(&self, kernel: K) -> K::Out {
        self.isa.run_narrow(self.strict, kernel)
    }
}

impl fmt::Display for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The form that a backend has by default; the measurement behind the choice is in `docs/accuracy.md`.
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
            assert!(Backend::ALL.contains(&backend.name()));
            let found = Backend::named(backend.name()).unwrap();
            assert_eq!((found.name(), found.lanes()), (backend.name(), backend.lanes()));
        }
    }

    #[test]
    fn narrow_backends_are_no_wider_and_round_alike() {
        for backend in Backend::forms() {
            let narrow = backend.narrow();
            assert!(narrow.lanes() <= backend.lanes(), "{narrow} of {backend}");
            assert_eq!(narrow.is_strict(), backend.is_strict());
            assert_eq!(narrow.has_fused_form(), backend.has_fused_form(), "{narrow} of {backend}");
            assert_eq!(narrow.narrow().name(), narrow.name());
        }
    }

    #[test]
    fn backends_detect_what_the_cpu_reports() {
        let found: Vec<_> = Backend::available().iter().map(Backend::name).collect();
        assert_eq!(found, Backend::reported());
    }

    #[test]
    fn the_reference_comes_first() {
        assert_eq!((Backend::scalar().name(), Backend::scalar().lanes()), ("scalar", 1));
        assert!(!Backend::scalar().has_fused_form());
    }
}
