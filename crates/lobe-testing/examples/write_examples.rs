//! Writes a small file of every format into a folder, for tests that are not written in Rust: `write_examples FOLDER`.
#![forbid(unsafe_code)]

use std::path::PathBuf;
use std::{env, fs, io};

use lobe_formats::Format;
use lobe_testing::{examples, made};

fn main() -> io::Result<()> {
    let folder = env::args_os().nth(1).map(PathBuf::from);
    let folder = folder.ok_or_else(|| io::Error::other("found no argument; expected a folder to write into"))?;
    fs::create_dir_all(&folder)?;
    let mut all = examples::all();
    all.push((Format::Utia, made::utia_numbers()));
    for (number, (format, bytes)) in all.into_iter().enumerate() {
        let spec = format.spec();
        let extension = spec.extensions.first().copied().unwrap_or("txt");
        fs::write(folder.join(format!("{}-{number}.{extension}", spec.word)), bytes)?;
    }
    Ok(())
}
