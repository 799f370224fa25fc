//! Reads a file of any format, and writes its values and knots as a table with named columns.

use std::error::Error;
use std::path::Path;

use lobe::formats::{self, goniometer};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/paint-12x21x13.ddr");

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let (format, document) = formats::open(Path::new(FILE))?;
    println!(
        "{format}: {}",
        document.source.iter().map(|(name, value)| format!("{name} {value}; ")).collect::<String>()
    );

    let data = document.only().ok_or("more than one measurement")?;
    let path = std::env::temp_dir().join(format!("lobe-example-{}.csv", std::process::id()));
    goniometer::write(data, &path)?;

    // Nothing is resampled: the file that is read back has the same values at the same angles.
    let (_, written) = formats::open(&path)?;
    std::fs::remove_file(&path)?;
    let count = |document: &formats::Document| document.only().map(|data| data.representation().channels().count());
    assert_eq!(count(&document), count(&written));
    println!("{} parts with {:?} channels", written.parts.len(), count(&written));
    Ok(())
}
