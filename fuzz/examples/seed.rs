//! Fills `fuzz/corpus`: each target gets small files of its format, our own ones, and those in the folder that
//! `LOBE_SHARED` names, or else in `shared` next to the workspace.
#![forbid(unsafe_code)]

use std::path::Path;
use std::{fs, io};

use lobe_formats::{Format, sniff, tensor};
use lobe_testing::{examples, files};

fn main() -> io::Result<()> {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let mut seeds = examples::all();
    seeds.push((Format::Utia, vec![0; 1_990_656]));
    if let Some(shared) = files::find_shared() {
        for path in ["golden", "data"].iter().flat_map(|folder| files::small_files(&shared.join(folder))) {
            let bytes = files::bytes(&path);
            seeds.extend(sniff(&bytes).map(|format| (format, bytes)));
        }
    }
    for (index, (format, bytes)) in seeds.iter().enumerate() {
        let mut targets = vec![target(*format)];
        // Recognised by nothing but its size, which mutations change.
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
    println!("{} files in {}", seeds.len(), corpus.display());
    Ok(())
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
