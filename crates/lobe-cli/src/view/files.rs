//! The files to show, with stamps that change when the files do.

use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use lobe_formats::sidecar;
use serde::Serialize;

use crate::failure::Failure;

/// The files and folders named on the command line.
pub struct Shown {
    entries: Vec<PathBuf>,
}

/// A file or a folder, as it is listed for the page.
#[derive(Serialize)]
struct Entry {
    path: String,
    #[serde(rename = "isFolder")]
    is_folder: bool,
    /// Changes whenever one of the files changes.
    stamp: String,
    files: Vec<Part>,
}

#[derive(Serialize)]
struct Part {
    path: String,
    url: String,
}

impl Shown {
    /// Checks that the files and folders exist.
    pub fn new(files: &[PathBuf]) -> Result<Self, Failure> {
        for file in files {
            if file.is_dir() {
                continue;
            }
            // A missing file, or something that is not a file, is reported before the browser opens.
            let metadata = std::fs::metadata(file).map_err(|error| {
                Failure::File(format!("{}: found {error}; expected a file that can be read", file.display()))
            })?;
            if !metadata.is_file() {
                let message = format!("{}: found a device, a pipe or a socket; expected a file", file.display());
                return Err(Failure::File(message));
            }
        }
        Ok(Shown { entries: files.to_vec() })
    }

    /// All files, each with the index of its entry: the files of a folder, or a file and its sidecar. The position of a
    /// file in this list is its number in URLs.
    fn all(&self) -> Vec<(usize, PathBuf)> {
        let of = |(number, entry): (usize, &PathBuf)| {
            let files = match entry.is_dir() {
                true => lobe_files::files_of(entry).unwrap_or_default(),
                false => {
                    let sidecar = sidecar::path_of(entry);
                    [Some(entry.clone()), sidecar.is_file().then_some(sidecar)].into_iter().flatten().collect()
                }
            };
            files.into_iter().map(move |file| (number, file))
        };
        self.entries.iter().enumerate().flat_map(of).collect()
    }

    /// The entries as JSON.
    pub fn list(&self) -> Result<Vec<u8>, String> {
        let all = self.all();
        let entry = |(number, path): (usize, &PathBuf)| {
            let is_folder = path.is_dir();
            let of_entry = || all.iter().enumerate().filter(|(_, (entry, _))| *entry == number);
            // Entries with the same name, from different folders, are numbered.
            let name = name(path);
            let again = self.entries.iter().take(number).filter(|other| self::name(other) == name).count();
            let shown = if again > 0 { format!("{name} ({})", again + 1) } else { name };
            let part = |(url, (_, file)): (usize, &(usize, PathBuf))| {
                let path = match is_folder {
                    true => format!("{shown}/{}", self::name(file)),
                    false if file == path => shown.clone(),
                    false => sidecar::path_of(Path::new(&shown)).display().to_string(),
                };
                Part { path, url: format!("files/{url}") }
            };
            let stamp = of_entry().map(|(_, (_, file))| stamp(file)).collect::<Vec<_>>().join(" ");
            Entry { path: shown.clone(), is_folder, stamp, files: of_entry().map(part).collect() }
        };
        let entries: Vec<Entry> = self.entries.iter().enumerate().map(entry).collect();
        serde_json::to_vec(&entries).map_err(|error| error.to_string())
    }

    /// The contents of the file with this number; `None` if there is none.
    pub fn read(&self, number: usize) -> Option<Result<Vec<u8>, String>> {
        let (_, file) = self.all().into_iter().nth(number)?;
        Some(lobe_files::read(&file).map_err(|error| error.to_string()))
    }
}

/// The last component of a path.
fn name(path: &Path) -> String {
    let absolute = || std::path::absolute(path).ok()?.file_name().map(|name| name.to_string_lossy().into_owned());
    match path.file_name() {
        Some(name) => name.to_string_lossy().into_owned(),
        None => absolute().unwrap_or_else(|| "folder".into()),
    }
}

/// A text that changes when the file is written: its name, size and modification time.
fn stamp(file: &Path) -> String {
    let metadata = std::fs::metadata(file).ok();
    let size = metadata.as_ref().map_or(0, std::fs::Metadata::len);
    let time = metadata.and_then(|metadata| metadata.modified().ok()?.duration_since(UNIX_EPOCH).ok());
    format!("{}:{size}:{}", name(file), time.map_or(0, |time| time.as_nanos()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_listed_with_their_sidecars_and_stamps_change() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(&path, text).unwrap();
            path
        };
        let table = write("a/t.csv", "1");
        write("a/t.csv.lobe.toml", "scale = 2");
        let other = write("b/t.csv", "22");
        write("scan/x.txt", "x");
        let scan = folder.path().join("scan");
        let shown = Shown::new(&[table.clone(), other, scan]).unwrap();
        let list = || serde_json::from_slice::<serde_json::Value>(&shown.list().unwrap()).unwrap();
        let first = list();
        let paths = |at: usize| -> Vec<String> {
            let files = first[at]["files"].as_array().unwrap();
            files.iter().map(|file| file["path"].as_str().unwrap().into()).collect()
        };
        assert_eq!(paths(0), ["t.csv", "t.csv.lobe.toml"]);
        assert_eq!(paths(1), ["t.csv (2)"]);
        assert_eq!((paths(2), first[2]["isFolder"].as_bool()), (vec!["scan/x.txt".into()], Some(true)));
        assert_eq!(shown.read(2).unwrap().unwrap(), b"22");
        assert!(shown.read(4).is_none());
        std::fs::write(&table, "123").unwrap();
        assert_ne!(list()[0]["stamp"], first[0]["stamp"]);
        assert_eq!(list()[1]["stamp"], first[1]["stamp"]);
        assert!(Shown::new(&[folder.path().join("none")]).is_err());
    }
}
