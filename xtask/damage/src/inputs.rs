//! The files to damage, and the sound files next to them.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use lobe_formats::{Format, sniff};
use lobe_testing::{examples, files};

/// What a file was before it was damaged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Material,
    /// A material that a scene names.
    MaterialOfScene,
    Scene,
    Mesh,
    Environment,
    Spectrum,
    Part,
    Pairs,
    Sidecar,
    Plan,
    /// A matrix of daylight.
    Matrix,
    /// A fitted model.
    Fit,
}

/// A sound file.
pub struct Input {
    pub kind: Kind,
    /// The name of the input in the record.
    pub name: String,
    pub extension: String,
    pub bytes: Vec<u8>,
}

impl Input {
    fn new(kind: Kind, extension: &str, bytes: impl Into<Vec<u8>>) -> Self {
        Input { kind, name: extension.into(), extension: extension.into(), bytes: bytes.into() }
    }

    /// The name of the damaged file.
    pub fn file(&self) -> String {
        match self.kind {
            Kind::Sidecar => "table.csv.lobe.toml".into(),
            Kind::Plan => "job/plan.json".into(),
            _ => format!("in.{}", self.extension),
        }
    }

    /// The scene that names the damaged file, if the file is not an argument itself.
    pub fn scene(&self) -> Option<String> {
        let file = self.file();
        let plane = "[[object]]\nshape = \"sphere\"\nsegments = 16\nmaterial = \"floor\"\n";
        let light = "[[light]]\nkind = \"environment\"\nradiance = 1\n";
        let floor = "[material.floor]\nmodel = \"lambert\"\nalbedo = 0.5\n";
        let rest = match self.kind {
            Kind::MaterialOfScene => format!("[material.floor]\nfile = \"{file}\"\n{plane}{light}"),
            Kind::Mesh => format!("{floor}[[object]]\nfile = \"{file}\"\nmaterial = \"floor\"\n{light}"),
            Kind::Environment => {
                format!("{floor}{plane}[[light]]\nkind = \"environment\"\nfile = \"{file}\"\nturn = 30\n")
            }
            Kind::Spectrum => {
                let light = format!("[[light]]\nkind = \"environment\"\nradiance = {{ file = \"{file}\" }}\n");
                format!("[spectrum]\nbands = 8\n{floor}{plane}{light}")
            }
            _ => return None,
        };
        Some(format!("{HEAD}{rest}"))
    }
}

const HEAD: &str = "[camera]\nposition = [0, 1.2, 4]\ntarget = [0, 0.5, 0]\n[film]\nwidth = 8\nheight = 6\n[integrator]\nsamples = 4\n";
const PAIRS: &str =
    "wi.x,wi.y,wi.z,wo.x,wo.y,wo.z\n0.3,0,0.9,-0.2,0.1,0.9\n0,0,1,0.5,0.5,-0.7\n-0.28,0.96,1e-9,1,0,1e-12\n";
const TABLE: &str = "theta_i;theta_o;phi_o;f\n10;20;0;0,5\n10;20;90;0,25\n10;40;180;0,125\n30;20;0;0,5\n30;40;90;0,25\n30;120;180;0,1\n";
const SIDECARS: [&str; 3] = [
    "columns = \"theta_i=1,theta_o=2,phi_o=3,f=4\"\ndecimal-comma = true\nscale = 0.5\n",
    "columns = \"theta_i=30deg,theta_o=theta_o,phi_o=phi_o,550nm=f\"\nunit = \"rad\"\nvalues = \"f-cos\"\n",
    "holds = \"both\"\nvalues = \"luminance-factor\"\nazimuth-from = \"mirror\"\nin-plane = \"opposite-sign\"\n",
];
const PLAN: &str = "{\"parts\": 2, \"by\": \"rows\", \"size\": [8, 6], \"samples\": 4}";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
    property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0.1\n0 1 0\n4 0 1 2 3\n";
const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.2 0.2 0\nvt 0 0\nvn 0 0 1\ng a\nusemtl b\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf -4//1 -3//1 \\\n-2//1\n";
const GLTF: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "scale": [1, 2, 1]}],
"meshes": [{"name": "a", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}, {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
"buffers": [{"byteLength": 42, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"}]}"#;
const SCENE: &str = "[material.floor]\nmodel = \"lambert\"\nalbedo = [0.5, 0.4, 0.3]\n[material.glass]\nmodel = \"glass\"\n[material.a]\n\
    file = \"sound.ddr\"\nedge = \"zero\"\n[[object]]\nshape = \"plane\"\nmaterial = \"a\"\nrotate = [0, 90, 0]\nsize = 3\n[[object]]\n\
    shape = \"sphere\"\nsegments = 16\nradius = 0.5\ntranslate = [0, 0.5, 0]\nmaterial = \"glass\"\n[[object]]\nshape = \"disk\"\nscale = 2\n\
    material = \"floor\"\nradiance = [2, 1, 1]\ntwo_sided = true\n[[light]]\nkind = \"point\"\nposition = [0, 3, 0]\nintensity = 3\n";

const MATRIX: &str = "#?RADIANCE\nNROWS=2\nNCOLS=2\nNCOMP=3\nFORMAT=ascii\n\n1 0.5 0.25\t0 0 0\n0.1 0.2 0.3\t1 1 1\n";

/// All inputs: our own small files, and those in the folder `LOBE_SHARED` if there is one.
pub fn all() -> Vec<Input> {
    let mut inputs = Vec::new();
    let mut materials = examples::all();
    for path in files::find_shared().iter().flat_map(|shared| ["golden", "data", "cases"].map(|name| shared.join(name)))
    {
        let small = if path.is_dir() { files::small_files(&path) } else { Vec::new() };
        for bytes in small.iter().map(|path| files::bytes(path)) {
            materials.extend(sniff(&bytes).map(|format| (format, bytes)));
        }
    }
    for (format, bytes) in materials {
        for kind in [Kind::Material, Kind::MaterialOfScene] {
            inputs
                .push(Input { name: format.spec().word.into(), ..Input::new(kind, extension(format), bytes.clone()) });
        }
    }
    inputs.extend([("ply", PLY), ("obj", OBJ), ("gltf", GLTF)].map(|(end, text)| Input::new(Kind::Mesh, end, text)));
    let flat = [b"#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n".as_slice(), &[128; 32]].concat();
    inputs.push(Input::new(Kind::Environment, "hdr", flat));
    inputs.push(Input::new(Kind::Spectrum, "csv", "# nm\nwavelength, value\n400, 0.5\n500; 1\n700\t1e-3\n"));
    inputs.push(Input::new(Kind::Pairs, "csv", PAIRS));
    inputs.extend(SIDECARS.map(|text| Input::new(Kind::Sidecar, "toml", text)));
    inputs.push(Input::new(Kind::Plan, "json", PLAN));
    inputs.push(Input::new(Kind::Matrix, "mtx", MATRIX));
    let floats: Vec<u8> = (0..12_u8).flat_map(|value| (f32::from(value) / 8.0).to_le_bytes()).collect();
    let head = MATRIX.split_once("ascii").expect("a format").0.as_bytes();
    inputs.push(Input::new(Kind::Matrix, "mtx", [head, b"float\n\n", &floats].concat()));
    inputs.push(Input::new(Kind::Scene, "toml", format!("{HEAD}{SCENE}")));
    for kind in ["bdpt", "vcm", "light", "ao", "whitted"] {
        let scene = format!("{HEAD}{SCENE}").replace("[integrator]\n", &format!("[integrator]\nkind = \"{kind}\"\n"));
        inputs.push(Input::new(Kind::Scene, "toml", scene));
    }
    let spectral = format!("{HEAD}{SCENE}").replace("[material.floor]", "[spectrum]\nbands = 8\n[material.floor]");
    inputs.push(Input::new(Kind::Scene, "toml", spectral));
    inputs
}

fn extension(format: Format) -> &'static str {
    format.spec().extensions.first().copied().unwrap_or("dat")
}

/// Writes the sound files that commands read next to the damaged one, and returns those that the program itself writes,
/// to be damaged as well.
///
/// # Errors
/// If a file cannot be written, or the program refuses a sound one.
pub fn sound(program: &Path, folder: &Path) -> Result<Vec<Input>> {
    std::fs::create_dir_all(folder.join("job"))?;
    let write = |name: &str, bytes: &[u8]| -> Result<PathBuf> {
        let path = folder.join(name);
        std::fs::write(&path, bytes).with_context(|| path.display().to_string())?;
        Ok(path)
    };
    write("sound.ddr", examples::DDR.as_bytes())?;
    write("pairs.csv", PAIRS.as_bytes())?;
    write("table.csv", TABLE.as_bytes())?;
    write("sound.mtx", MATRIX.as_bytes())?;
    write("sound.toml", format!("{HEAD}{SCENE}").as_bytes())?;
    let mut made = Vec::new();
    for (part, tile) in [("sound-1.exr", "1/2"), ("sound-2.exr", "2/2")] {
        let mut command = Command::new(program);
        command.args(["render", "sound.toml", "-o", part, "--tile", tile, "--strict", "--quiet"]).current_dir(folder);
        let done = command.stdin(Stdio::null()).output().context("the program")?;
        ensure!(done.status.success(), "{part}: {}", String::from_utf8_lossy(&done.stderr));
    }
    let mut fit = Command::new(program);
    fit.args("fit sound.ddr --model lambert --starts 1 --pairs 64 -o fit.json".split(' ')).current_dir(folder);
    let done = fit.stdin(Stdio::null()).output().context("the program")?;
    ensure!(done.status.success(), "fit.json: {}", String::from_utf8_lossy(&done.stderr));
    made.push(Input::new(Kind::Fit, "json", std::fs::read(folder.join("fit.json"))?));
    let part = std::fs::read(folder.join("sound-1.exr"))?;
    std::fs::write(folder.join("job/part-1.exr"), &part)?;
    made.push(Input::new(Kind::Part, "exr", part.clone()));
    made.push(Input::new(Kind::Environment, "exr", part));
    Ok(made)
}
