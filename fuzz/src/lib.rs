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

/// Calls `run` with the path of a file that contains `bytes`, for code that opens files itself. The file is in memory
/// if the system has a folder for that.
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

/// Blocks of deflate that hold `bytes` as they are: an encoder would take longer than the reader that is tested.
fn stored(bytes: &[u8]) -> Vec<u8> {
    /// The most that a block holds.
    const BLOCK: usize = 0xffff;
    let count = bytes.len().div_ceil(BLOCK).max(1);
    let mut blocks = Vec::with_capacity(bytes.len() + 5 * count);
    for block in 0..count {
        let piece = &bytes[block * BLOCK..bytes.len().min((block + 1) * BLOCK)];
        let length = piece.len() as u16;
        blocks.push(u8::from(block + 1 == count));
        blocks.extend(length.to_le_bytes());
        blocks.extend((!length).to_le_bytes());
        blocks.extend(piece);
    }
    blocks
}

/// A stream of zlib that unpacks to `bytes`.
pub fn zlib(bytes: &[u8]) -> Vec<u8> {
    let adler = |(a, b): (u32, u32), byte: &u8| {
        let a = (a + u32::from(*byte)) % 65521;
        (a, (b + a) % 65521)
    };
    let (a, b) = bytes.iter().fold((1, 0), adler);
    [&[0x78, 0x01], stored(bytes).as_slice(), &((b << 16) | a).to_be_bytes()].concat()
}

/// A file of gzip that unpacks to `bytes`.
pub fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut crc = flate2::Crc::new();
    crc.update(bytes);
    let head = [0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255];
    [&head, stored(bytes).as_slice(), &crc.sum().to_le_bytes(), &(bytes.len() as u32).to_le_bytes()].concat()
}

/// The target of a reader, which is named by its variant of [`Format`].
#[macro_export]
macro_rules! reader {
    ($format:ident) => {
        libfuzzer_sys::fuzz_target!(|bytes: &[u8]| $crate::read(lobe_formats::Format::$format, bytes));
    };
}
