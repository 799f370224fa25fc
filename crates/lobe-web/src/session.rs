//! The files of a page, and the materials opened from them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use lobe_files::{Files, in_memory};
use lobe_plot::Subject;

use crate::Held;
use crate::held::held;

/// A material of a page.
#[derive(Debug)]
pub struct Opened {
    /// The path of its file or folder among the files of the page.
    pub path: PathBuf,
    /// The size of its files in bytes.
    pub bytes: u64,
    /// The document and the material, prepared for figures.
    pub subject: Subject,
}

/// The files of a page, and the materials opened from them, by number.
#[derive(Debug, Default)]
pub struct Session {
    files: Files,
    opened: BTreeMap<u32, Opened>,
    next: u32,
}

impl Session {
    /// Creates a session without files.
    pub fn new() -> Self {
        Session::default()
    }

    /// Adds a file, or replaces the one at the same path. Materials that are open do not change.
    pub fn add(&mut self, path: &str, bytes: Vec<u8>) {
        self.files.insert(path.into(), bytes);
    }

    /// Removes a file.
    pub fn remove(&mut self, path: &str) {
        self.files.remove(Path::new(path));
    }

    /// Opens a file, or a folder of files that form one material, as `lobe` does on disk: packed files, sidecars and
    /// all formats work. Returns the number of the material.
    ///
    /// # Errors
    /// The message that the program would report.
    pub fn open(&mut self, path: &str) -> Result<u32, String> {
        let path = PathBuf::from(path);
        let files = std::mem::take(&mut self.files);
        let (opened, files) = in_memory(files, || lobe_formats::open(&path));
        self.files = files;
        let (format, document) = opened.map_err(|error| error.to_string())?;
        let subject = Subject::new(&path, format, document).map_err(|error| error.to_string())?;
        let bytes = self.bytes(&path);
        let number = self.next;
        self.next += 1;
        self.opened.insert(number, Opened { path, bytes, subject });
        Ok(number)
    }

    /// What a file holds that can be read although it is no material: that of a mirror has no values for pairs of
    /// directions.
    ///
    /// # Errors
    /// If it cannot be read either.
    pub fn held(&mut self, path: &str) -> Result<Held, String> {
        let path = PathBuf::from(path);
        let files = std::mem::take(&mut self.files);
        let (opened, files) = in_memory(files, || lobe_formats::open(&path));
        self.files = files;
        let (format, document) = opened.map_err(|error| error.to_string())?;
        Ok(held(&path, self.bytes(&path), format, &document))
    }

    /// How large a file or the files of a folder are.
    fn bytes(&self, path: &Path) -> u64 {
        let inside = self.files.iter().filter(|(file, _)| file.starts_with(path));
        inside.map(|(_, bytes)| bytes.len() as u64).sum()
    }

    /// The material with this number.
    ///
    /// # Errors
    /// If there is none.
    pub fn opened(&self, number: u32) -> Result<&Opened, String> {
        self.opened.get(&number).ok_or_else(|| format!("found no material {number}; expected one that is open"))
    }

    /// Closes a material.
    pub fn close(&mut self, number: u32) {
        self.opened.remove(&number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_open_by_their_content_and_errors_are_those_of_the_program() {
        let mut session = Session::new();
        for (format, bytes) in lobe_testing::examples::all() {
            let name = format!("example.{}", format.spec().extensions.first().unwrap_or(&"txt"));
            session.add(&name, bytes.clone());
            match session.open(&name) {
                Ok(number) => {
                    let opened = session.opened(number).unwrap();
                    assert_eq!(opened.bytes, bytes.len() as u64, "{format}");
                    session.close(number);
                    assert!(session.opened(number).is_err());
                }
                // Mirrors have no value for a pair of directions, and some files have sides with different channels.
                Err(error) => {
                    let is_known = error.contains("mirror") || error.contains("parts with different channels");
                    assert!(is_known, "{format}: {error}");
                    let held = session.held(&name).unwrap();
                    assert_eq!((held.format, held.bytes), (format.name(), bytes.len() as u64));
                    assert!(!held.parts.is_empty());
                }
            }
            session.add(&name, bytes[..bytes.len() / 2].to_vec());
            if let Err(error) = session.open(&name) {
                assert!(error.starts_with("example.") && error.contains("expected"), "{error}");
            }
        }
        session.add("m.sdr", lobe_testing::examples::SDR.into());
        let [mirror] = session.held("m.sdr").unwrap().mirrors.try_into().unwrap();
        assert_eq!((mirror.psi, mirror.channels.len()), (None, 2));
        let row = &mirror.rows[1];
        assert_eq!((row.sigma, row.values.as_slice()), (std::f64::consts::FRAC_PI_4, [0.2, 0.0].as_slice()));
        let error = session.open("none.ddr").unwrap_err();
        assert_eq!(session.held("none.ddr").unwrap_err(), error);
        assert_eq!(error, "none.ddr: found no such file; expected a file that can be read");
    }

    #[test]
    fn a_folder_is_one_material_and_a_file_is_read_with_its_sidecar() {
        let mut session = Session::new();
        session.add("scan/a.txt", lobe_testing::examples::RPC.into());
        let others = lobe_testing::examples::RPC.replace("5.000", "35.000").replace("\n7 0\n", "\n37 0\n");
        session.add("scan/b.txt", others.into());
        let number = session.open("scan").unwrap();
        assert_eq!(session.opened(number).unwrap().subject.measured().format, lobe_formats::Format::Rpc);

        let table = "theta_i,phi_i,theta_o,phi_o,f\n0,0,0,0,1\n0,0,60,0,1\n0,0,60,120,1\n0,0,60,240,1\n";
        session.add("t.csv", table.into());
        session.add("t.csv.lobe.toml", "unit = \"deg\"\nscale = 0.5\n".into());
        let number = session.open("t.csv").unwrap();
        let mut value = [0.0];
        session.opened(number).unwrap().subject.material().eval([0.0, 0.0, 1.0], [0.0, 0.0, 1.0], &mut value);
        assert!((value[0] - 0.5).abs() < 1e-6, "{value:?}");
    }
}
