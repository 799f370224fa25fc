//! Files in memory that replace those on disk if there is no disk, as in a browser.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Files by their paths. A folder exists if there is a file in it.
pub type Files = BTreeMap<PathBuf, Vec<u8>>;

thread_local! {
    /// The files that [`in_memory`] has put in place of the disk on this thread.
    static FILES: RefCell<Option<Files>> = const { RefCell::new(None) };
}

/// Runs `work` with `files` in place of the disk: on this thread, the functions of this crate read, find, list and
/// write only these files. Returns the result of `work`, and the files afterwards.
pub fn in_memory<R>(files: Files, work: impl FnOnce() -> R) -> (R, Files) {
    /// Restores the previous files, even if `work` panics.
    struct Outer(Option<Files>);
    impl Drop for Outer {
        fn drop(&mut self) {
            FILES.replace(self.0.take());
        }
    }
    let outer = Outer(FILES.replace(Some(files)));
    let result = work();
    let files = FILES.take().unwrap_or_default();
    drop(outer);
    (result, files)
}

/// Returns `true` if there is a file or a folder at this path.
pub fn exists(path: &Path) -> bool {
    kept(|files| files.contains_key(path) || has_folder(files, path)).unwrap_or_else(|| path.exists())
}

/// Returns `true` if there is a folder at this path.
pub fn is_folder(path: &Path) -> bool {
    kept(|files| has_folder(files, path)).unwrap_or_else(|| path.is_dir())
}

/// The files in a folder, sorted by name, without those in its subfolders.
///
/// # Errors
/// If the folder cannot be read.
pub fn files_of(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let in_memory = kept(|files| match has_folder(files, folder) {
        true => Ok(files.keys().filter(|path| path.parent() == Some(folder)).cloned().collect()),
        false => Err(missing()),
    });
    in_memory.unwrap_or_else(|| {
        let mut paths = Vec::new();
        for entry in folder.read_dir()? {
            paths.push(entry?.path());
        }
        paths.retain(|path| path.is_file());
        paths.sort();
        Ok(paths)
    })
}

/// The contents of a file in memory; `None` outside [`in_memory`].
pub(crate) fn content(path: &Path) -> Option<io::Result<Vec<u8>>> {
    kept(|files| match files.get(path) {
        Some(bytes) => Ok(bytes.clone()),
        None if has_folder(files, path) => Err(io::Error::other("a folder")),
        None => Err(missing()),
    })
}

/// Stores a file in memory; returns `false` outside [`in_memory`].
pub(crate) fn keep(path: &Path, content: &[u8]) -> bool {
    FILES.with_borrow_mut(|files| match files {
        Some(files) => {
            files.insert(path.into(), content.into());
            true
        }
        None => false,
    })
}

fn kept<R>(look: impl FnOnce(&Files) -> R) -> Option<R> {
    FILES.with_borrow(|files| files.as_ref().map(look))
}

fn has_folder(files: &Files, folder: &Path) -> bool {
    files.keys().any(|path| path != folder && path.starts_with(folder))
}

fn missing() -> io::Error {
    io::Error::new(ErrorKind::NotFound, "no such file")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{read, write_whole};

    fn files(names: &[&str]) -> Files {
        names.iter().map(|name| (PathBuf::from(name), name.as_bytes().to_vec())).collect()
    }

    #[test]
    fn files_in_memory_take_the_place_of_the_disk() {
        let disk = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
        let ((), after) = in_memory(files(&["scan/b.txt", "scan/a.txt", "scan/more/c.txt"]), || {
            assert_eq!(read(Path::new("scan/a.txt")).unwrap(), b"scan/a.txt");
            assert_eq!(files_of(Path::new("scan")).unwrap(), [Path::new("scan/a.txt"), Path::new("scan/b.txt")]);
            assert!(
                is_folder(Path::new("scan/more")) && !is_folder(Path::new("scan/a.txt")) && exists(Path::new("scan"))
            );
            assert_eq!(read(Path::new("scan")).unwrap_err().found, "a folder");
            let error = read(Path::new(disk)).unwrap_err();
            assert_eq!((error.found.as_str(), error.expected.as_str()), ("no such file", "a file that can be read"));
            assert!(files_of(Path::new("other")).is_err() && !exists(Path::new(disk)));
            write_whole(Path::new("out.txt"), b"new").unwrap();
        });
        assert_eq!(after[Path::new("out.txt")], b"new");
        assert_eq!(after.len(), 4);
        assert!(exists(Path::new(disk)) && read(Path::new("out.txt")).is_err());
    }

    #[test]
    fn the_disk_is_back_after_a_panic() {
        let caught = std::panic::catch_unwind(|| in_memory(Files::new(), || panic!("on purpose")));
        assert!(caught.is_err() && exists(Path::new(env!("CARGO_MANIFEST_DIR"))));
    }
}
