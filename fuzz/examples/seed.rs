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
        if *format == Format::Goniometer {
            targets.push("import".into());
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
    // What is said about a table comes before it.
    for (index, (said, table)) in SAID.iter().enumerate() {
        let folder = corpus.join("import");
        fs::create_dir_all(&folder)?;
        fs::write(folder.join(format!("said-{index}")), [said.as_bytes(), b"\0", table.as_bytes()].concat())?;
    }
    println!("{} files in {}", seeds.len(), corpus.display());
    Ok(())
}

/// Sidecars, and tables for them.
const SAID: [(&str, &str); 7] = [
    ("columns = \"theta_i=1,theta_o=2,phi_o=3,f=4\"\n", "1 2 3 4\n10 20 30 0.5\n10 30 40 0.25\n"),
    ("columns = \"theta_i=30deg\"\nvalues = \"f-cos\"\n", "theta_o;f\n10;0,5\n20;0,25\n"),
    ("unit = \"rad\"\nscale = 2\nin-plane = \"opposite-sign\"\n", "AOI\tview angle\tR\tG\tB\n-0.5\t1\t1\t2\t3\n"),
    ("holds = \"both\"\nazimuth-from = \"mirror\"\n", "theta_i,theta_o,phi_o,f\n10,20,0,1\n10,120,0,2\n"),
    ("decimal-comma = true\n", "theta_o \\ theta_i;10;20,5;30\n-10;1;2;3\n0;1,5;2,5;nan\n"),
    (
        "",
        "Sample: x\n# theta_i = 30\ntheta_o,wavelength [um],BRDF,std\n10,0.5,1,0\n10,0.6,2,0\ntheta_i: 40\n10,0.5,1,0\n10,0.6,2,0\n",
    ),
    ("values = \"luminance-factor\"\n", "theta_i,theta_o,phi_o,note,450nm,550nm\n10,20,0,a,1,2\n10,20,90,b,3,\n"),
];

/// The target of a format: `LightTools` has `light_tools`.
fn target(format: Format) -> String {
    let words = format!("{format:?}");
    let parted = words.char_indices().map(|(at, letter)| {
        let parting = if at > 0 && letter.is_ascii_uppercase() { "_" } else { "" };
        format!("{parting}{}", letter.to_ascii_lowercase())
    });
    parted.collect()
}
