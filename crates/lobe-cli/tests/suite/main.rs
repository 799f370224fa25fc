//! The program as users run it: what it prints, writes and refuses.

mod albedo;
mod check;
mod cli;
mod colours;
mod common;
mod compare;
mod convert;
#[cfg(unix)]
mod documentation;
#[cfg(unix)]
mod farm;
mod fit;
mod hardening;
mod honest;
mod import;
mod matrices;
#[cfg(target_os = "linux")]
mod memory;
mod pictures;
mod plot;
mod refused;
mod render;
mod resample;
#[cfg(unix)]
mod slurm;
mod spectral_bits;
mod stated;
mod strangers;
mod sums;
