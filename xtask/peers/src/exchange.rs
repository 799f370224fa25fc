//! Files exchanged between the programs: floats in binary, tasks in JSON.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use serde_json::Value;

/// A directory of files, and the tasks that refer to them.
#[derive(Debug)]
pub struct Exchange {
    directory: PathBuf,
    tasks: BTreeMap<String, Value>,
}

impl Exchange {
    /// In `exchange` under that directory.
    ///
    /// # Errors
    /// If the directory cannot be created.
    pub fn new(out: &Path) -> anyhow::Result<Self> {
        let directory = out.join("exchange");
        std::fs::create_dir_all(&directory).with_context(|| format!("cannot create {}", directory.display()))?;
        Ok(Exchange { directory, tasks: BTreeMap::new() })
    }

    /// Writes rows of floats one after the other, little-endian.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn floats(&self, name: &str, rows: &[&[f32]]) -> anyhow::Result<PathBuf> {
        let path = self.directory.join(name).with_extension("f32");
        let bytes: Vec<u8> = rows.iter().copied().flatten().flat_map(|x| x.to_le_bytes()).collect();
        std::fs::write(&path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
        Ok(path)
    }

    /// The path to which a program must write the result of a task.
    pub fn answer(&self, program: &str, task: &str) -> PathBuf {
        self.directory.join(format!("{program}-{task}.f32"))
    }

    /// The floats of such a file.
    ///
    /// # Errors
    /// If there are not `count` of them.
    pub fn read(&self, path: &Path, count: usize) -> anyhow::Result<Vec<f32>> {
        let bytes = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
        let (floats, rest) = bytes.as_chunks::<4>();
        if floats.len() != count || !rest.is_empty() {
            bail!("{}: {} bytes; expected {count} floats", path.display(), bytes.len());
        }
        Ok(floats.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect())
    }

    /// Adds a task for the programs that read their tasks from a file.
    pub fn task(&mut self, name: &str, task: Value) {
        self.tasks.insert(name.to_owned(), task);
    }

    /// Writes all tasks that were added.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_tasks(&self) -> anyhow::Result<PathBuf> {
        let path = self.directory.join("tasks.json");
        xtask_common::replace(&path, serde_json::to_string(&self.tasks)?)?;
        Ok(path)
    }

    /// The directory of all files.
    pub fn directory(&self) -> &Path {
        &self.directory
    }

    /// The arguments of the arc cosine.
    pub fn cosines(&self) -> PathBuf {
        self.directory.join("cosines.f32")
    }
}
