//! Reading whole files, and recording which were read.

use std::cell::RefCell;
use std::fs::{File, Metadata};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use sha2::{Digest as _, Sha256};

use crate::{FormatError, Place, memory};

/// Reads a whole file. Devices, pipes and sockets, which may be endless or never answer, are refused before they are
/// opened.
///
/// # Errors
/// [`FormatError`] if the file cannot be read, is not an ordinary file, or does not fit into memory.
pub fn read(path: &Path) -> Result<Vec<u8>, FormatError> {
    if is_standard_input(path) {
        let bytes = standard_input(path)?;
        note(path, &bytes);
        return Ok(bytes);
    }
    let unreadable = |found: String, expected: &str| FormatError::new(path, Place::File, found, expected);
    if let Some(content) = memory::content(path) {
        let bytes = content.map_err(|error| unreadable(error.to_string(), READABLE))?;
        note(path, &bytes);
        return Ok(bytes);
    }
    let metadata = path.metadata().map_err(|error| unreadable(error.to_string(), READABLE))?;
    if let Some(kind) = not_a_file(&metadata) {
        return Err(unreadable(kind.into(), "a file"));
    }
    let bytes = content(path, metadata.len()).map_err(|error| unreadable(error.to_string(), READABLE))?;
    note(path, &bytes);
    Ok(bytes)
}

/// Whether a file begins with these bytes. `false` if it cannot be read, or is a folder or a device.
pub fn begins_with(path: &Path, bytes: &[u8]) -> bool {
    if is_standard_input(path) || memory::content(path).is_some() {
        return read(path).is_ok_and(|content| content.starts_with(bytes));
    }
    let is_file = path.metadata().is_ok_and(|metadata| not_a_file(&metadata).is_none());
    let mut head = vec![0; bytes.len()];
    is_file && File::open(path).and_then(|mut file| file.read_exact(&mut head)).is_ok() && head == bytes
}

/// The name of standard input, for programs that enable it.
const DASH: &str = "-";

static IS_DASH_STANDARD_INPUT: AtomicBool = AtomicBool::new(false);

/// From now on, the file name `-` means standard input, which is for programs and not for libraries.
pub fn name_standard_input() {
    IS_DASH_STANDARD_INPUT.store(true, Ordering::Relaxed);
}

/// `true` if a file with this name is standard input.
pub fn is_standard_input(path: &Path) -> bool {
    path == Path::new(DASH) && IS_DASH_STANDARD_INPUT.load(Ordering::Relaxed)
}

/// All of standard input, which can be read only once but may be requested as often as any other file.
fn standard_input(path: &Path) -> Result<Vec<u8>, FormatError> {
    /// Larger than any known measurement.
    const MOST: u64 = 4 << 30;
    static BYTES: OnceLock<Result<Vec<u8>, String>> = OnceLock::new();
    let read = || {
        let mut bytes = Vec::new();
        match io::stdin().lock().take(MOST).read_to_end(&mut bytes) {
            Ok(size) if size as u64 == MOST => Err(format!("{MOST} bytes or more")),
            Ok(_) => Ok(bytes),
            Err(error) => Err(error.to_string()),
        }
    };
    BYTES.get_or_init(read).clone().map_err(|found| FormatError::new(path, Place::File, found, READABLE))
}

const READABLE: &str = "a file that can be read";

/// Reads like [`read`], with a system error, for callers whose errors name the file themselves.
///
/// # Errors
/// The same as for [`read`].
pub fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    read(path).map_err(|FormatError { found, expected, .. }| {
        io::Error::other(if expected == READABLE { found } else { format!("found {found}; expected {expected}") })
    })
}

fn content(path: &Path, size: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let too_large = |_| io::Error::other(format!("{size} bytes, which do not fit into memory"));
    bytes.try_reserve_exact(usize::try_from(size).unwrap_or(usize::MAX)).map_err(too_large)?;
    File::open(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Describes something that is not an ordinary file.
pub(crate) fn not_a_file(metadata: &Metadata) -> Option<&'static str> {
    let kind = metadata.file_type();
    match (kind.is_file(), kind.is_dir()) {
        (true, _) => None,
        (_, true) => Some("a folder"),
        _ => Some("a device, a pipe or a socket"),
    }
}

/// The files that a piece of work read, in order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reads {
    /// The paths of the files.
    pub files: Vec<PathBuf>,
    /// SHA-256 of their sizes and contents, without their names.
    pub hash: [u8; 32],
}

#[derive(Default)]
struct Record {
    files: Vec<PathBuf>,
    hash: Sha256,
}

thread_local! {
    /// The files that [`recorded`] collects on this thread.
    static RECORD: RefCell<Option<Record>> = const { RefCell::new(None) };
}

/// Runs `work`, and returns the files that it read with [`read`] and [`bytes`] on this thread, including those that a
/// reader opens next to the file that it was given.
pub fn recorded<R>(work: impl FnOnce() -> R) -> (R, Reads) {
    let outer = RECORD.replace(Some(Record::default()));
    let result = work();
    let Record { files, hash } = RECORD.replace(outer).unwrap_or_default();
    for file in &files {
        RECORD.with_borrow_mut(|outer| outer.iter_mut().for_each(|outer| outer.files.push(file.clone())));
    }
    let hash: [u8; 32] = hash.finalize().into();
    RECORD.with_borrow_mut(|outer| outer.iter_mut().for_each(|outer| outer.hash.update(hash)));
    (result, Reads { files, hash })
}

fn note(path: &Path, bytes: &[u8]) {
    RECORD.with_borrow_mut(|record| {
        if let Some(record) = record {
            record.files.push(path.into());
            record.hash.update((bytes.len() as u64).to_le_bytes());
            record.hash.update(bytes);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_recorded_by_content() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, content: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, content).unwrap();
            path
        };
        let (a, b, c) = (write("a", "one"), write("b", "two"), write("c", "one"));
        let reads = |files: &[&PathBuf]| recorded(|| files.iter().for_each(|file| drop(read(file).unwrap()))).1;
        let both = reads(&[&a, &b]);
        assert_eq!(both.files, [a.clone(), b.clone()]);
        assert_eq!(both.hash, reads(&[&c, &b]).hash);
        assert_ne!(both.hash, reads(&[&b, &a]).hash);
        assert_ne!(both.hash, reads(&[&a]).hash);
        let (inner, outer) = recorded(|| recorded(|| read(&a)).1);
        assert_eq!((inner.files.len(), outer.files), (1, vec![a]));
    }

    #[test]
    fn folders_and_devices_are_refused_before_they_are_opened() {
        let folder = tempfile::tempdir().unwrap();
        let error = read(folder.path()).unwrap_err();
        assert_eq!((error.found.as_str(), error.expected.as_str()), ("a folder", "a file"));
        #[cfg(unix)]
        for device in ["/dev/zero", "/dev/null"] {
            let error = read(Path::new(device)).unwrap_err();
            assert_eq!(error.found, "a device, a pipe or a socket");
            let error = bytes(Path::new(device)).unwrap_err();
            assert_eq!(error.to_string(), "found a device, a pipe or a socket; expected a file");
        }
    }

    /// Opening a pipe that nobody writes to would wait forever.
    #[cfg(unix)]
    #[test]
    fn a_pipe_is_not_waited_for() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        if made.is_ok_and(|status| status.success()) {
            assert_eq!(read(&pipe).unwrap_err().expected, "a file");
        }
    }
}
