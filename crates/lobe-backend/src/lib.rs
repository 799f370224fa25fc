//! Which SIMD instructions to use, chosen when the program runs.
//!
//! This is the only crate that names the backends: each is one line of the list in `src/list.rs`, and everything else
//! asks a [`Backend`]. [`Backend::run`] compiles a kernel for every backend of the target, so a kernel belongs behind a
//! function that is not generic, in the crate that the kernel is written in: then it is compiled once per backend and not
//! once more in every program.
#![forbid(unsafe_code)]

mod list;

use std::fmt;
use std::sync::OnceLock;

use lobe_lane::Kernel;
use thiserror::Error;

use list::{Isa, NAMES};

/// The environment variable that overrides detection.
pub const BACKEND_VARIABLE: &str = "LOBE_BACKEND";

/// A backend that this CPU has, and whether its results are the same bits as every other backend's.
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

impl Backend {
    /// The names of all backends, slowest first, whether or not this machine can run them.
    pub const ALL: &[&str] = NAMES;

    /// The backend that the environment variable `LOBE_BACKEND` names, else the fastest of this CPU.
    ///
    /// # Errors
    /// If the variable holds a name that is unknown or that this CPU cannot run; the error lists what there is.
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

    /// The scalar backend, which defines what every other gives in strict form.
    pub fn scalar() -> Self {
        Backend::available()[0]
    }

    /// The backend of that name.
    ///
    /// # Errors
    /// If the name is unknown, or this CPU cannot run it; the error lists what there is.
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

    /// All backends of this CPU, slowest first: each in strict form and, if that is another, in fused form.
    pub fn forms() -> Vec<Self> {
        let forms = |backend: Backend| [Some(backend.strict()), backend.has_fused_form().then(|| backend.fused())];
        Backend::available().into_iter().flat_map(forms).flatten().collect()
    }

    /// The names of the backends whose instructions the CPU reports, slowest first. It does not ask the backends, so
    /// that their own detection can be checked: these are the names of [`available`](Backend::available).
    pub fn reported() -> Vec<&'static str> {
        Isa::reported()
    }

    /// The same backend with every multiply-add rounded twice: the same bits on every machine.
    pub fn strict(self) -> Self {
        Backend { strict: true, ..self }
    }

    /// The same backend with multiply-adds rounded once if the hardware does so: fastest, and equal to the strict form
    /// within the bounds of `docs/accuracy.md`.
    pub fn fused(self) -> Self {
        Backend { strict: false, ..self }
    }

    /// `true` if results are the same bits on every machine.
    pub fn is_strict(&self) -> bool {
        self.strict
    }

    /// `true` if the fused form is another than the strict one.
    pub fn has_fused_form(&self) -> bool {
        self.isa.fuses()
    }

    /// The name, as `LOBE_BACKEND` takes it.
    pub fn name(&self) -> &'static str {
        self.isa.name()
    }

    /// How many lanes it has.
    pub fn lanes(&self) -> usize {
        self.isa.lanes()
    }

    /// Runs a kernel on this backend. Once per batch: the dispatch and the loss of inlining are paid each time.
    #[inline]
    pub fn run<K: Kernel>(&self, kernel: K) -> K::Out {
        self.isa.run(self.strict, kernel)
    }
}

impl fmt::Display for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
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
            assert!(Backend::ALL.contains(&backend.name()));
            let found = Backend::named(backend.name()).unwrap();
            assert_eq!((found.name(), found.lanes()), (backend.name(), backend.lanes()));
        }
    }

    #[test]
    fn backends_find_themselves_where_the_cpu_reports_their_instructions() {
        let found: Vec<_> = Backend::available().iter().map(Backend::name).collect();
        assert_eq!(found, Backend::reported());
    }

    #[test]
    fn the_reference_comes_first() {
        assert_eq!((Backend::scalar().name(), Backend::scalar().lanes()), ("scalar", 1));
        assert!(!Backend::scalar().has_fused_form());
    }
}
