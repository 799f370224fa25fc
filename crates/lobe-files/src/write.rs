//! Writing a file so that it is never half-written.

#[cfg(unix)]
use std::fs::File;
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::read::{is_standard_input, not_a_file};
use crate::{FormatError, Place, memory};

/// Writes `content` to a temporary file next to `path` and renames it, so that no half-written file is ever visible.
///
/// # Errors
/// [`FormatError`] if the folder or the file cannot be written.
pub fn write_whole(path: &Path, content: &[u8]) -> Result<(), FormatError> {
    if memory::keep(path, content) {
        return Ok(());
    }
    replace(path, content).map_err(|error| unwritable(path, &error))
}

/// Like [`write_whole`], with a system error. A file that is replaced keeps its permissions; a new one has those of the
/// user's umask. A link is followed: its target is replaced.
///
/// # Errors
/// If the folder or the file cannot be written, or the path is not a writable file.
pub fn replace(path: &Path, content: &[u8]) -> io::Result<()> {
    let target = target(path)?;
    let folder = folder(&target);
    let mut file = temporary(folder)?;
    file.write_all(content)?;
    if let Ok(old) = std::fs::metadata(&target) {
        file.as_file().set_permissions(old.permissions())?;
    }
    file.as_file().sync_all()?;
    file.persist(&target)?;
    // The new name is durable only if the folder is also synced, which not every system supports.
    #[cfg(unix)]
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
    Ok(())
}

/// Checks that `path` could be written now, for programs that work for hours before they write. Also fails if it is one
/// of `inputs`, or a file in an input folder: inputs must not be replaced by accident. Names of sidecars, which say how
/// another file is read, are refused.
///
/// # Errors
/// [`FormatError`] names `path`, what is there, and what is expected.
pub fn check_output<P: AsRef<Path>>(path: &Path, inputs: &[P]) -> Result<(), FormatError> {
    let refuse = |error: io::Error| unwritable(path, &error);
    if is_standard_input(path) {
        return Err(FormatError::new(path, Place::File, "the standard input", "the name of a file to write"));
    }
    let read = |input: &Path| {
        let found = format!("the file {}, which is used otherwise", input.display());
        FormatError::new(path, Place::File, found, "another file to write")
    };
    if let Some(input) = inputs.iter().find(|input| input.as_ref() == path) {
        return Err(read(input.as_ref()));
    }
    let target = target(path).map_err(refuse)?;
    if [path, &target].iter().any(|path| is_sidecar(path)) {
        let found = "the name of a sidecar, which says how another file is read";
        return Err(FormatError::new(path, Place::File, found, "another file to write"));
    }
    if let Some(output) = located(&target) {
        let is_there = target.exists();
        let same = |input: &&P| {
            let input = self::target(input.as_ref()).unwrap_or_else(|_| input.as_ref().to_path_buf());
            located(&input).is_some_and(|input| input == output || is_there && output.parent() == Some(&*input))
        };
        if let Some(input) = inputs.iter().find(same) {
            return Err(read(input.as_ref()));
        }
    }
    temporary(folder(&target)).map_err(refuse).map(drop)
}

/// The end of the name of a sidecar, which follows the name of the file that it describes.
pub const SIDECAR: &str = ".lobe.toml";

/// Whether this is the name of a sidecar, on systems that do not distinguish the case of letters as well.
fn is_sidecar(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().to_ascii_lowercase().ends_with(SIDECAR))
}

/// The absolute path of a file, which may not exist yet.
fn located(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok().or_else(|| Some(folder(path).canonicalize().ok()?.join(path.file_name()?)))
}

/// Checks that `path` is or may become a folder, for programs that write several files into one.
///
/// # Errors
/// [`FormatError`] names `path`, what is there, and what is expected.
pub fn check_folder(path: &Path) -> Result<(), FormatError> {
    let refuse = |found: &str| Err(FormatError::new(path, Place::File, found, "the name of a folder"));
    match path.metadata() {
        _ if is_standard_input(path) => refuse("the standard input"),
        Ok(metadata) if !metadata.is_dir() => refuse(not_a_file(&metadata).unwrap_or("a file")),
        _ => Ok(()),
    }
}

/// Follows links, and checks that there is nothing or a writable file.
fn target(path: &Path) -> io::Result<PathBuf> {
    /// As many links as Linux follows.
    const LINKS: usize = 40;
    let mut target = path.to_path_buf();
    for _ in 0..LINKS {
        match target.read_link() {
            Ok(link) => target = folder(&target).join(link),
            Err(_) => {
                if let Ok(metadata) = target.metadata() {
                    if let Some(kind) = not_a_file(&metadata) {
                        return Err(io::Error::other(kind));
                    }
                    if metadata.permissions().readonly() {
                        return Err(io::Error::other("a file that is read-only"));
                    }
                }
                return Ok(target);
            }
        }
    }
    Err(io::Error::other("links that lead in a circle"))
}

fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

const PREFIX: &str = ".lobe-";
const SUFFIX: &str = ".tmp";

/// A temporary file, which is locked as long as it is in use.
fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    // If the folder is missing, the error would otherwise name a temporary file in it.
    folder.metadata()?;
    #[cfg(unix)]
    clean(folder);
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    // Temporary files are private by default; this one becomes an ordinary file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    loop {
        let file = builder.tempfile_in(folder)?;
        // Between its creation and its locking, another program may have removed it as a leftover.
        #[cfg(unix)]
        if matches!(file.as_file().try_lock(), Err(std::fs::TryLockError::WouldBlock)) || !file.path().exists() {
            continue;
        }
        return Ok(file);
    }
}

/// Removes the temporary files of killed programs, which nobody has locked.
#[cfg(unix)]
fn clean(folder: &Path) {
    let Ok(entries) = folder.read_dir() else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let random = name.to_str().and_then(|name| name.strip_prefix(PREFIX)?.strip_suffix(SUFFIX));
        let is_ours = random.is_some_and(|r| r.len() == 6 && r.bytes().all(|byte| byte.is_ascii_alphanumeric()));
        if is_ours && entry.file_type().is_ok_and(|kind| kind.is_file()) {
            let locked = File::open(entry.path()).map(|file| file.try_lock().is_ok().then_some(file));
            if let Ok(Some(_file)) = locked {
                let _ = std::fs::remove_file(entry.path());
            }
        }
    }
}

/// `path` was not written: the file system refused, or the material does not fit the format.
pub fn unwritable(path: &Path, error: &io::Error) -> FormatError {
    let expected = match error.kind() {
        ErrorKind::InvalidInput => "a material that fits the format",
        _ => "a file that can be written",
    };
    FormatError::new(path, Place::File, error.to_string(), expected)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_and_nothing_is_left_next_to_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        write_whole(&path, b"old").unwrap();
        write_whole(&path, b"new").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_replaced_file_keeps_its_permissions() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        write_whole(&path, b"old").unwrap();
        std::fs::set_permissions(&path, PermissionsExt::from_mode(0o640)).unwrap();
        write_whole(&path, b"new").unwrap();
        assert_eq!(std::fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
    }

    #[test]
    fn a_folder_that_is_missing_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let error = write_whole(&folder.path().join("none/a"), b"").unwrap_err();
        assert!(error.file.ends_with("none/a") && error.expected == "a file that can be written", "{error}");
        assert_eq!(check_output::<PathBuf>(&folder.path().join("none/a"), &[]).unwrap_err(), error);
    }

    #[test]
    fn inputs_are_not_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (folder.path().join("a"), folder.path().join("b"));
        std::fs::write(&a, "a").unwrap();
        check_output(&b, &[&a]).unwrap();
        let other_name = folder.path().join("..").join(folder.path().file_name().unwrap()).join("a");
        for output in [&a, &other_name] {
            let error = check_output(output, &[&b, &a]).unwrap_err();
            assert!(error.expected == "another file to write" && error.found.ends_with("used otherwise"), "{error}");
        }
        // Another output that does not exist yet, by another name.
        let new = folder.path().join("new");
        std::fs::create_dir(folder.path().join("below")).unwrap();
        assert!(check_output(&new, &[folder.path().join("below/../new")]).is_err());
        check_output(&new, &[folder.path().join("below/new")]).unwrap();
        std::fs::remove_dir(folder.path().join("below")).unwrap();
        // Sidecars are inputs of every reader, whether they exist or not.
        for sidecar in ["a.lobe.toml", "new.csv.LOBE.toml", ".lobe.toml"] {
            let error = check_output::<PathBuf>(&folder.path().join(sidecar), &[]).unwrap_err();
            assert!(error.expected == "another file to write" && error.found.contains("sidecar"), "{error}");
        }
        check_output::<PathBuf>(&folder.path().join("lobe.toml"), &[]).unwrap();
        // An existing file of an input folder is refused; a new one is allowed.
        assert!(check_output(&a, &[folder.path()]).is_err());
        check_output(&b, &[folder.path()]).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn folders_are_not_files() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a");
        std::fs::write(&file, "a").unwrap();
        check_folder(folder.path()).unwrap();
        check_folder(&folder.path().join("none/below")).unwrap();
        assert_eq!(check_folder(&file).unwrap_err().found, "a file");
    }

    #[test]
    fn non_files_and_read_only_files_are_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        std::fs::create_dir(&path).unwrap();
        assert_eq!(write_whole(&path, b"new").unwrap_err().found, "a folder");
        let path = folder.path().join("b");
        std::fs::write(&path, "old").unwrap();
        let mut permissions = path.metadata().unwrap().permissions();
        permissions.set_readonly(true);
        std::fs::set_permissions(&path, permissions).unwrap();
        assert_eq!(check_output::<PathBuf>(&path, &[]).unwrap_err().found, "a file that is read-only");
        assert_eq!(write_whole(&path, b"new").unwrap_err().found, "a file that is read-only");
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        #[cfg(unix)]
        assert!(write_whole(Path::new("/dev/null"), b"new").unwrap_err().found.contains("device"));
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::create_dir(path("below")).unwrap();
        std::fs::write(path("below/file"), "old").unwrap();
        symlink("below/file", path("link")).unwrap();
        symlink("link", path("chain")).unwrap();
        symlink("new", path("dangling")).unwrap();
        symlink("circle", path("circle")).unwrap();
        for (link, file) in [("chain", "below/file"), ("dangling", "new")] {
            write_whole(&path(link), b"new").unwrap();
            assert!(path(link).symlink_metadata().unwrap().is_symlink());
            assert_eq!(std::fs::read(path(file)).unwrap(), b"new");
        }
        assert!(write_whole(&path("circle"), b"").is_err());
        symlink("scan.csv.lobe.toml", path("other")).unwrap();
        assert!(check_output::<PathBuf>(&path("other"), &[]).unwrap_err().found.contains("sidecar"));
        // A link to an input counts as the input.
        assert!(check_output(&path("chain"), &[path("below/file")]).is_err());
        symlink("later", path("to-later")).unwrap();
        assert!(check_output(&path("later"), &[path("to-later")]).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn leftovers_are_removed_and_files_in_use_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let used = temporary(folder.path()).unwrap();
        for name in [".lobe-abc123.tmp", ".lobe-notes.tmp", ".lobe-abc123"] {
            std::fs::write(path(name), "").unwrap();
        }
        write_whole(&path("a"), b"").unwrap();
        let exists = [".lobe-abc123.tmp", ".lobe-notes.tmp", ".lobe-abc123"].map(|name| path(name).exists());
        assert_eq!(exists, [false, true, true]);
        assert!(used.path().exists());
    }
}
