//! Fills `fuzz/corpus`: each target gets small files of its format, our own ones, and those in the folder that
//! `LOBE_SHARED` names or in `shared` beside the workspace.
#![forbid(unsafe_code)]

use std::path::{Path, PathBuf};
use std::{env, fs, io};

use lobe_formats::{Format, sniff, tensor};

#[path = "../../crates/lobe-formats/tests/common/mod.rs"]
mod common;
#[path = "../../crates/lobe-formats/tests/common/examples.rs"]
mod examples;

fn main() -> io::Result<()> {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let mut files = examples::all();
    files.push((Format::Utia, vec![0; 1_990_656]));
    if let Some(shared) = shared() {
        for path in ["golden", "data"].iter().flat_map(|folder| common::small_files(&shared.join(folder))) {
            let bytes = common::bytes(&path);
            files.extend(sniff(&bytes).map(|format| (format, bytes)));
        }
    }
    for (index, (format, bytes)) in files.iter().enumerate() {
        let mut targets = vec![target(*format)];
        // Told by nothing but its size, which mutations change.
        if *format != Format::Utia {
            targets.push("sniff".into());
        }
        if tensor::matches(bytes) {
            targets.push("tensor".into());
        }
        for target in targets {
            let folder = corpus.join(target);
            fs::create_dir_all(&folder)?;
            fs::write(folder.join(format!("seed-{index}")), bytes)?;
        }
    }
    println!("{} files in {}", files.len(), corpus.display());
    Ok(())
}

/// The folder with measured files, if there is one.
fn shared() -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared");
    let folder = env::var_os("LOBE_SHARED").map_or_else(beside, PathBuf::from);
    folder.join("golden").is_dir().then_some(folder)
}

/// The target of a format: `LightTools` has `light_tools`.
fn target(format: Format) -> String {
    let words = format!("{format:?}");
    let parted = words.char_indices().map(|(at, letter)| {
        let parting = if at > 0 && letter.is_ascii_uppercase() { "_" } else { "" };
        format!("{parting}{}", letter.to_ascii_lowercase())
    });
    parted.collect()
}
