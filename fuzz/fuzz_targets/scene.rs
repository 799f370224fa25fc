//! Scenes in TOML, with small files that they may name: `a.ddr`, `b.obj`, `c.hdr` and `d.csv`.
#![no_main]

use std::path::Path;
use std::sync::Once;

use lobe_backend::Backend;
use lobe_render::scene::AnyScene;
use lobe_testing::examples;

libfuzzer_sys::fuzz_target!(|text: &str| {
    static FILES: Once = Once::new();
    let folder = lobe_fuzz::folder();
    FILES.call_once(|| {
        let hdr = [b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n".as_slice(), &[128; 8]].concat();
        let files: [(&str, &[u8]); 4] = [
            ("a.ddr", examples::DDR.as_bytes()),
            ("b.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
            ("c.hdr", &hdr),
            ("d.csv", b"400,1\n700,0.5\n"),
        ];
        for (name, bytes) in files {
            std::fs::write(folder.join(name), bytes).expect("a file in a temporary folder");
        }
    });
    if is_large(text) {
        return;
    }
    let _ = AnyScene::parse(Path::new("fuzz"), folder, text, Backend::scalar());
});

/// `true` if a scene asks for meshes with too many triangles to build thousands of times per second.
fn is_large(text: &str) -> bool {
    let after = |key: &str, most: f64| {
        text.match_indices(key).any(|(at, _)| {
            let rest = text[at + key.len()..].trim_start_matches([' ', '\t', '"', '\'', '=', '+']);
            let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len());
            !rest[..end].replace('_', "").parse::<f64>().is_ok_and(|number| number <= most)
        })
    };
    let made = ["knot", "ball", "drape", "waves"].iter().any(|shape| text.contains(shape));
    made || text.contains('\\') || after("segments", 16.0) || after("refine", 2.0)
}
