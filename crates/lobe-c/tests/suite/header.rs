//! Checks that `include/lobe.h` is the output of cbindgen for the code.

use std::path::Path;

#[test]
fn the_header_matches_the_code() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).expect("a configuration");
    let made = cbindgen::Builder::new().with_crate(root).with_config(config).generate().expect("bindings");
    let mut header = Vec::new();
    made.write(&mut header);
    let header = String::from_utf8(header).expect("text");
    let file = root.join("include/lobe.h");
    if std::env::var_os("LOBE_WRITE_HEADER").is_some() {
        std::fs::write(&file, &header).expect("a header that can be written");
    }
    let there = std::fs::read_to_string(&file).unwrap_or_default().replace("\r\n", "\n");
    let differs = there.lines().zip(header.lines()).position(|(there, made)| there != made);
    assert!(
        there == header,
        "include/lobe.h does not match the code, from line {:?} on: LOBE_WRITE_HEADER=1 cargo test -p lobe-c header writes it",
        differs.map(|line| line + 1)
    );
}
