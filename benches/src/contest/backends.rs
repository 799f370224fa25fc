//! The backends of this machine under the names of the report.

use lobe::Backend;

/// A backend in one of its forms.
#[derive(Clone, Copy, Debug)]
pub struct Named {
    /// The backend's name, with `-strict` if that is a separate form.
    pub name: &'static str,
    /// The backend.
    pub backend: Backend,
}

/// Every backend of this machine, slowest first; those that fuse multiply-adds occur in both forms.
pub fn backends() -> Vec<Named> {
    let mut found = Vec::new();
    for backend in Backend::available() {
        let backend = backend.fused();
        found.push(Named { name: backend.name(), backend });
        if backend.has_fused_form() {
            // The names are few, and live as long as the program.
            let name = format!("{}-strict", backend.name()).leak();
            found.push(Named { name, backend: backend.strict() });
        }
    }
    found
}
