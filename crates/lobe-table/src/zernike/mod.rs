//! Isotropic reflection as an expansion in Zernike polynomials of both directions, reciprocal term by term.
//!
//! J. J. Koenderink and A. J. van Doorn, "Phenomenological description of bidirectional surface reflection", JOSA A
//! 15(11), 1998; the unpolarised part of the model that T. A. Germer fitted to sintered PTFE, Applied Optics 56(33),
//! 2017.
//!
//! A direction with polar angle `theta` is at the radius `rho = sqrt(2) sin(theta / 2)` of the unit disk. With the
//! radial polynomials `R`, a term of the orders n, m and l with the coefficient `a` adds
//!
//! ```text
//! a c / (2 pi) (R_n^l(rho_i) R_m^l(rho_o) + R_m^l(rho_i) R_n^l(rho_o)) cos(l (phi_o - phi_i)) lambda^p
//! ```
//!
//! where `lambda` is in micrometres, and `c^2` is `(n + 1) (m + 1)`, halved if `n = m`, and halved if `l = 0`.
//!
//! [`Data`] are the terms; a [`Table`] sums them in lanes.

mod data;
#[cfg(feature = "zernike")]
mod prepared;
mod reference;
mod representation;
#[cfg(feature = "zernike")]
mod table;
#[cfg(test)]
mod tests;

pub use data::{Data, MAX_ORDER, Term};
pub use representation::KIND;
#[cfg(feature = "zernike")]
pub use table::Table;
