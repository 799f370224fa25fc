//! Shared by all fuzz targets: reads, checks the memory used, evaluates.
//!
//! `docs/fuzzing.md` says how to run them.
#![forbid(unsafe_code)]

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use lobe_formats::Format;
use lobe_testing::probe::probe;

lobe_testing::count_memory!();

/// Reads `bytes` as a file of `format` and evaluates its content.
///
/// # Panics
/// If a reader or an evaluation does, or a reader used more memory than the size of the file justifies.
pub fn read(format: Format, bytes: &[u8]) {
    // It does not matter here if the file is valid.
    let _ = probe(format, bytes, Path::new("fuzz"));
}

/// What `run` makes of a file that holds `bytes`, for what opens files itself. Where there is one, the file is in memory.
///
/// # Panics
/// If `run` does, or the file cannot be written.
pub fn in_file<R>(bytes: &[u8], run: impl FnOnce(&Path) -> R) -> R {
    let path = folder().join("input");
    std::fs::write(&path, bytes).expect("a file in a temporary folder");
    run(&path)
}

/// A folder of this process.
///
/// # Panics
/// If it cannot be made.
pub fn folder() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let memory = Path::new("/dev/shm");
        let temporary = if memory.is_dir() { memory.into() } else { std::env::temp_dir() };
        let folder = temporary.join(format!("lobe-fuzz-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a temporary folder");
        folder
    })
}

/// The target of a reader, which is named by its variant of [`Format`].
#[macro_export]
macro_rules! reader {
    ($format:ident) => {
        libfuzzer_sys::fuzz_target!(|bytes: &[u8]| $crate::read(lobe_formats::Format::$format, bytes));
    };
}
