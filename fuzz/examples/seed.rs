//! Fills `fuzz/corpus`: each target gets small files of its format, both generated ones and those in the folder named
//! by `LOBE_SHARED`, or in `shared` next to the workspace.
#![forbid(unsafe_code)]

use std::path::{Path, PathBuf};
use std::{fs, io};

use lobe_files::{inflated, unpacked};
use lobe_formats::{Format, sniff, tensor};
use lobe_fuzz::{gzip, zlib};
use lobe_testing::{examples, files};

fn main() -> io::Result<()> {
    // Two targets pack what they are given; were that unsound, they would test nothing.
    for bytes in [vec![], vec![7; 70_000]] {
        let path = Path::new("packed");
        let is_sound = inflated(&zlib(&bytes), 0, path).is_ok_and(|content| content == bytes)
            && unpacked(&gzip(&bytes), path).is_ok_and(|content| *content.bytes == *bytes);
        assert!(is_sound, "packed data of {} bytes", bytes.len());
    }
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let mut seeds = examples::all();
    seeds.push((Format::Utia, vec![0; 1_990_656]));
    if let Some(shared) = files::find_shared() {
        for path in ["golden", "data", "cases"].iter().flat_map(|folder| files::small_files(&shared.join(folder))) {
            let bytes = files::bytes(&path);
            seeds.extend(sniff(&bytes).map(|format| (format, bytes)));
        }
    }
    for (index, (format, bytes)) in seeds.iter().enumerate() {
        let mut targets = vec![target(*format)];
        // Recognised only by its size, which mutations change.
        if *format != Format::Utia {
            targets.push("sniff".into());
        }
        if *format == Format::Goniometer {
            targets.push("import".into());
        }
        if tensor::matches(bytes) {
            targets.push("tensor".into());
        }
        if bytes.len() < 4096 {
            targets.push("unpack".into());
        }
        for target in targets {
            let folder = corpus.join(target);
            fs::create_dir_all(&folder)?;
            fs::write(folder.join(format!("seed-{index}")), bytes)?;
        }
    }
    // The options of a table come before it.
    for (index, (said, table)) in SAID.iter().enumerate() {
        let folder = corpus.join("import");
        fs::create_dir_all(&folder)?;
        fs::write(folder.join(format!("said-{index}")), [said.as_bytes(), b"\0", table.as_bytes()].concat())?;
    }
    for (target, texts) in TEXTS {
        for (index, text) in texts.iter().enumerate() {
            write(&corpus, target, &format!("text-{index}"), text.as_bytes())?;
        }
    }
    write(&corpus, "serialized", "file", &serialized(true))?;
    write(&corpus, "serialized", "content", &serialized(false))?;
    let radiance = b"#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
    write(&corpus, "environment", "flat", &[radiance.as_slice(), &[128; 8]].concat())?;
    let runs = b"#?RADIANCE\nCOLORCORR=1 2 1\nFORMAT=32-bit_rle_xyze\n\n+Y 1 -X 8\n\x02\x02\x00\x08\x88\x10\x88\x20\x88\x30\x88\x80";
    write(&corpus, "environment", "runs", runs)?;
    #[cfg(feature = "pictures")]
    parts::write(&corpus)?;
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/scenes");
    for path in files::files(&scenes).into_iter().filter(|path| path.extension().is_some_and(|end| end == "toml")) {
        copy(&corpus, "scene", &path)?;
    }
    // Small files of any kind, by what they are called.
    let shared = files::find_shared().map(|shared| files::small_files(&shared)).unwrap_or_default();
    for path in shared {
        let targets: &[&str] = match path.extension().and_then(|end| end.to_str()) {
            Some("hdr") => &["environment"],
            Some("exr") => &["environment", "parts"],
            Some("ply" | "obj" | "gltf" | "glb") => &["mesh"],
            Some("serialized") => &["serialized"],
            Some("toml") => &["scene", "sidecar"],
            _ => &[],
        };
        for target in targets {
            copy(&corpus, target, &path)?;
        }
    }
    println!("{} files in {}", seeds.len(), corpus.display());
    Ok(())
}

fn write(corpus: &Path, target: &str, name: &str, bytes: &[u8]) -> io::Result<PathBuf> {
    let folder = corpus.join(target);
    fs::create_dir_all(&folder)?;
    let file = folder.join(format!("seed-{name}"));
    fs::write(&file, bytes)?;
    Ok(file)
}

fn copy(corpus: &Path, target: &str, path: &Path) -> io::Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    write(corpus, target, &name, &files::bytes(path)).map(drop)
}

#[cfg(feature = "pictures")]
mod parts {
    use std::io;
    use std::path::Path;
    use std::sync::Arc;

    use lobe_render::picture::{Meta, write_exr_in};
    use lobe_render::{Bands, Film, Rect, Rgb, Sample, StokesRgb, Transport};

    pub fn write(corpus: &Path) -> io::Result<()> {
        part::<Rgb>(corpus, "rgb", &())?;
        part::<StokesRgb>(corpus, "stokes", &())?;
        let bands = lobe_spectrum::Bands::uniform(4).map_err(io::Error::other)?;
        part::<Bands<8>>(corpus, "bands", &Arc::new(bands))
    }

    /// A part of a picture of two pixels, with its sums and what was splatted.
    fn part<T: Transport>(corpus: &Path, name: &str, basis: &T::Basis) -> io::Result<()> {
        let window = Rect { x: 1, y: 0, width: 2, height: 1 };
        let mut film = Film::<T>::new(window);
        for pixel in film.pixels_mut() {
            pixel.add(&Sample::EMPTY);
        }
        film.add_light_paths(3);
        let meta = Meta {
            scene: "ab12".into(),
            size: [4, 2],
            window,
            samples: 0..1,
            total: 4,
            timed: false,
            exposure: 0.5,
            version: Meta::VERSION.into(),
            arithmetic: "strict".into(),
        };
        for target in ["parts", "environment"] {
            let file = super::write(corpus, target, name, b"")?;
            write_exr_in(&file, &film, basis, &meta, target == "parts").map_err(io::Error::other)?;
        }
        Ok(())
    }
}

/// A triangle as Mitsuba stores it: a file of it, or the content of its shape.
fn serialized(is_file: bool) -> Vec<u8> {
    let mut content = 0x1003_u32.to_le_bytes().to_vec();
    content.extend(b"one\0");
    content.extend(3_u64.to_le_bytes());
    content.extend(1_u64.to_le_bytes());
    let normals = [0.0, 0.0, 1.0].repeat(3);
    let numbers = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].into_iter().chain(normals);
    numbers.chain([0.0, 0.0, 1.0, 0.0, 0.0, 1.0]).for_each(|number| content.extend(number.to_le_bytes()));
    (0..3_u32).for_each(|index| content.extend(index.to_le_bytes()));
    if !is_file {
        return content;
    }
    let mut file = [&[0x1c, 4, 4, 0], zlib(&content).as_slice()].concat();
    file.extend([0; 8]);
    file.extend(1_u32.to_le_bytes());
    file
}

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
    property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\nelement face 1\n\
    property list uchar int vertex_indices\nend_header\n0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n1 1 0 0 0 1 1 1\n0 1 0 0 0 1 0 1\n\
    4 0 1 2 3\n";
const OBJ: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.2 0.2 0\nvt 0 0\nvn 0 0 1\ng a\nusemtl b\nf 1/1/1 2/1/1 3/1/1 4/1/1\n\
    f -4//1 -3//1 \\\n-2//1\ns off\n";
const GLTF: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0, "translation": [1, 0, 0], "rotation": [0, 0, 0, 1], "children": [1]}, {"mesh": 0, "scale": [1, 2, 1]}],
    "meshes": [{"name": "a", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 4, "material": 0}]}],
    "materials": [{"name": "m"}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}, {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6, "byteStride": 2}],
    "buffers": [{"byteLength": 42, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"}]}"#;
const SCENE: &str = "[camera]\nposition = [0, 1.2, 4]\ntarget = [0, 0.5, 0]\nup = [0, 1, 0]\nfield_of_view = 40\nlens_radius = 0.02\n\
    focus_distance = 4.0\n[film]\nwidth = 24\nheight = 16\nfilter = \"tent\"\nexposure = 0.5\n[integrator]\nkind = \"vcm\"\nsamples = 4\n\
    depth = 5\npaths = 100\nradius = 0.1\n[material.floor]\nmodel = \"lambert\"\nalbedo = [0.5, 0.4, 0.3]\n[material.glass]\nmodel = \"glass\"\n\
    [[object]]\nfile = \"b.obj\"\nmaterial = \"floor\"\nrotate = [0, 90, 0]\nscale = 2\nshading = \"flat\"\nradiance = [2, 1, 1]\ntwo_sided = true\n\
    [[object]]\nshape = \"sphere\"\nsegments = 8\nradius = 0.5\nrefine = 2\nmaterial = \"glass\"\n[[light]]\nkind = \"environment\"\n\
    file = \"c.hdr\"\nturn = 90\nscale = 2\n[[light]]\nkind = \"point\"\nposition = [0, 3, 0]\nintensity = 3\n";
const MEASURED: &str = "[camera]\nposition = [0, 0, 4]\ntarget = [0, 0, 0]\n[film]\nwidth = 8\nheight = 8\n[spectrum]\nbands = 8\n\
    [material.a]\nfile = \"a.ddr\"\nedge = \"zero\"\n[[object]]\nshape = \"plane\"\nmaterial = \"a\"\n[[light]]\nkind = \"sun\"\n\
    direction = [0, 1, 1]\nirradiance = { blackbody = 6500 }\n";
const TEXTS: [(&str, &[&str]); 5] = [
    (
        "pairs",
        &[
            "0.6,0,0.8,0,0,1\n# a\n\n1,0,1,0,-1,1\n",
            "wo.x;wo.y;wo.z;wi.x;wi.y;wi.z;n\n0;0;1;0,6;0;0,8;x\n",
            "\u{feff}\"wi_x\" \"wi_y\"\t\"wi_z\" wox woy woz\r\n0 0 1 0 0 1\r\n",
            "1e308,1e-320,-0,0,0,1e999\n",
        ],
    ),
    (
        "sidecar",
        &[
            "columns = \"theta_i=30deg,theta_o=1,550nm=3\"\nunit = \"rad\"\nvalues = \"f-cos\"\nscale = \"tis\"\n",
            "holds = \"both\"\nin-plane = \"same-sign\"\nazimuth_from = \"mirror\"\ndecimal-comma = \"true\"\nscale = 0.5\n",
        ],
    ),
    ("spectrum", &["# nm\nwavelength, value\n400, 0.5\n500; 1\n700\t1e-3\n", "560 1\n"]),
    ("mesh", &[PLY, OBJ, GLTF]),
    ("scene", &[SCENE, MEASURED]),
];

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
