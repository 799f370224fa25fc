//! The page of the explorer, which is built into the program or read from a folder.

use std::path::{Component, Path, PathBuf};

use crate::failure::Failure;

/// The parts of the page built into the program; empty if it was built without the page.
static EMBEDDED: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/page.rs"));

/// The environment variable that names a folder with the page.
const VARIABLE: &str = "LOBE_PAGE";

/// The static files of the explorer.
pub enum Page {
    Embedded,
    Folder(PathBuf),
}

impl Page {
    /// Finds the page: in the folder that is asked for, or else that the environment variable names, or else in the
    /// program, in a folder next to it, or in the sources that it was built from.
    pub fn find(asked: Option<&Path>) -> Result<Self, Failure> {
        let named = asked.map(Path::to_path_buf).or_else(|| std::env::var_os(VARIABLE).map(PathBuf::from));
        if let Some(folder) = named {
            return match is_page(&folder) {
                true => Ok(Page::Folder(folder)),
                false => Err(Failure::File(format!(
                    "{}: found no index.html; expected a folder that `cargo xtask web` has made",
                    folder.display()
                ))),
            };
        }
        if !EMBEDDED.is_empty() {
            return Ok(Page::Embedded);
        }
        let program = std::env::current_exe().ok();
        let beside = program
            .as_deref()
            .and_then(Path::parent)
            .map(|folder| [folder.join("lobe-web"), folder.join("../share/lobe/web")]);
        let built = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/web");
        let candidates: Vec<PathBuf> = beside.into_iter().flatten().chain([built]).collect();
        candidates.into_iter().find(|folder| is_page(folder)).map(Page::Folder).ok_or_else(|| {
            Failure::File(format!(
                "found a program that was built without the explorer; expected one with it, or --page or {VARIABLE} with \
                 a folder that has it. In the sources, `cargo xtask web` builds it into target/web, and `cargo xtask web \
                 --embed` before `cargo install --path crates/lobe-cli` builds it into the program"
            ))
        })
    }

    /// The media type and the contents of a part of the page; `None` if there is no such part.
    pub fn part(&self, path: &str) -> Option<(&'static str, Vec<u8>)> {
        let kind = kind(path)?;
        let bytes = match self {
            Page::Embedded => EMBEDDED.iter().find(|(name, _)| *name == path)?.1.to_vec(),
            Page::Folder(folder) => {
                // Files outside the folder are not served.
                let is_inside = Path::new(path).components().all(|part| matches!(part, Component::Normal(_)));
                is_inside.then(|| lobe_files::read(&folder.join(path)).ok())??
            }
        };
        Some((kind, bytes))
    }
}

fn is_page(folder: &Path) -> bool {
    folder.join("index.html").is_file()
}

/// The media type of a part of the page; files of other types are not served.
fn kind(path: &str) -> Option<&'static str> {
    let extension = Path::new(path).extension()?.to_str()?;
    Some(match extension {
        "html" => "text/html; charset=utf-8",
        "js" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "wasm" => "application/wasm",
        "svg" => "image/svg+xml",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_parts_of_the_page_are_served() {
        let folder = tempfile::tempdir().unwrap();
        let page = folder.path().join("page");
        std::fs::create_dir_all(page.join("assets")).unwrap();
        std::fs::write(folder.path().join("secret.js"), "secret").unwrap();
        std::fs::write(page.join("assets/a.wasm"), "module").unwrap();
        assert!(Page::find(Some(&page)).is_err());
        std::fs::write(page.join("index.html"), "page").unwrap();
        std::fs::write(page.join("notes.txt"), "notes").unwrap();
        let found = Page::find(Some(&page)).unwrap();
        assert_eq!(found.part("assets/a.wasm"), Some(("application/wasm", b"module".to_vec())));
        for path in ["../secret.js", "assets/../../secret.js", "/etc/passwd.js", "notes.txt", "none.js", ""] {
            assert_eq!(found.part(path), None, "{path}");
        }
    }
}
