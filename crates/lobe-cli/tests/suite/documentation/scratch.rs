//! A folder in which commands are run, with the files that they name.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use lobe_testing::examples;
use tempfile::TempDir;

use super::root;

/// A temporary folder, and a home folder in it.
pub struct Scratch(TempDir);

impl Scratch {
    pub fn new() -> Self {
        let scratch = Scratch(tempfile::tempdir().expect("a temporary folder"));
        // Folders in which shells look for their files.
        for folder in
            [".local/share/bash-completion/completions", ".local/share/man/man1", ".zfunc", ".config/fish/completions"]
        {
            fs::create_dir_all(scratch.path("home").join(folder)).expect("a folder");
        }
        // The explorer is built by other means.
        fs::create_dir(scratch.path("home/page")).expect("a folder");
        scratch.write("home/page/index.html", "<!doctype html>");
        scratch
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).expect("a file");
    }

    /// A line for the shell, in this folder, where `lobe` is the program that was built. Renderings are small.
    pub fn shell(&self, line: &str) -> Command {
        let program = Path::new(env!("CARGO_BIN_EXE_lobe")).parent().expect("a folder");
        let path = std::env::var_os("PATH").unwrap_or_default();
        let folders =
            [program.to_path_buf()].into_iter().chain(std::env::split_paths(&path)).chain([self.path("home")]);
        let mut shell = Command::new("sh");
        shell
            .args(["-ec", line])
            .current_dir(self.0.path())
            .env("PATH", std::env::join_paths(folders).expect("a list of folders"))
            .env("HOME", self.path("home"))
            .env("LOBE_DRAFT", "64")
            .env("LOBE_PAGE", self.path("home/page"))
            .stdin(Stdio::null());
        shell
    }

    fn run(&self, line: &str) {
        let output = self.shell(line).output().expect("a shell");
        assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
    }

    /// The fixtures, and the files that cargo needs to inspect the workspace.
    pub fn fixtures(&self) {
        copy(&root().join("fixtures"), &self.path("fixtures"));
        copy(&root().join("docs/data"), &self.path("docs/data"));
    }

    /// The scene in a document, as `scene.toml`, with the files that it names.
    pub fn scene(&self, document: &str) {
        let after = document.split_once("```toml\n").expect("a scene").1;
        self.write("scene.toml", after.split_once("```").expect("the end of the scene").0);
        self.fixture("conductor-7x8x13.ddr", "paint.ddr");
        for name in ["blind.ddr", "blind.ddt", "blind-back.ddr"] {
            self.write(name, crate::common::diffuse([0.3; 3]));
        }
        self.write("bunny.obj", "g body\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\ng eyes\nf 2 4 3\n");
        self.write("dark.toml", "[camera]\nposition = [0, 1, 4]\ntarget = [0, 0, 0]\n[film]\nwidth = 32\nheight = 16\n[[light]]\nkind = \"environment\"\nradiance = 1\n");
        self.run("lobe render dark.toml -o sky.exr --quiet");
    }

    fn fixture(&self, fixture: &str, name: &str) {
        fs::copy(root().join("fixtures").join(fixture), self.path(name)).expect("a file");
    }

    /// The files that the examples of help texts name.
    pub fn examples(&self) {
        self.without_missing_programs();
        self.run("lobe generate ward paint.ddr --alpha 0.3 --specular 0.3 --diffuse 0.5,0.1,0.1");
        self.fixture("cloth-17x7x17x13.ddr", "cloth.ddr");
        for copy in ["velvet.ddr", "a.ddr", "paint-resampled.ddr"] {
            self.fixture("conductor-7x8x13.ddr", copy);
        }
        self.run("lobe generate ggx paint.bsdf --to rgl --alpha 0.3 --zeniths 8 --texels 16");
        fs::create_dir(self.path("scans")).expect("a folder");
        for copy in ["vinyl.bsdf", "old.bsdf", "new.bsdf", "scans/white.bsdf"] {
            fs::copy(self.path("paint.bsdf"), self.path(copy)).expect("a file");
        }
        self.write("sensor.bsdf", examples::ZEMAX);
        self.write("paint.brdf", glossy_cornell());
        self.write("b.brdf", glossy_cornell());
        self.write("film.csv", glossy_csv());
        self.write("scan.csv", glossy_csv());
        self.write("scan-rad.csv", "theta_i,theta_o,BRF\n0.5,-0.5,0.3\n0.5,0,0.4\n0.5,0.5,0.9\n0.5,1,0.4\n");
        self.write("scan.txt", "-60 0.2\n-30 0.3\n0 0.3\n30 0.9\n60 0.4\n");
        self.write("lens.bsdf", examples::ZEMAX);
        self.write("film.ssdd", examples::SSDD);
        self.write("gold.binary", examples::tiny_merl());
        self.run("lobe generate mueller gold.mueller --metal gold --sigma 0,30,60 --theta 0,10,40");
        let sheet = examples::sheet("Columns", "0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1");
        // Light through the sheet from its front, and light reflected by its back, as this format calls them.
        for name in ["blinds.xml", "t.xml"] {
            self.write(name, sheet.replace("Reflection Back", "Transmission Back"));
        }
        self.write("screen.xml", sheet.replace("Reflection Back", "Reflection Front"));
        for (name, rows, columns) in [
            ("v.mtx", 2, 3),
            ("vd.mtx", 2, 3),
            ("d.mtx", 3, 4),
            ("dd.mtx", 3, 4),
            ("s.mtx", 4, 2),
            ("c.mtx", 2, 5),
            ("sun.mtx", 5, 2),
        ] {
            let elements = "0.5 0.5 0.5\n".repeat(rows * columns);
            self.write(name, format!("#?RADIANCE\nNROWS={rows}\nNCOLS={columns}\nNCOMP=3\nFORMAT=ascii\n\n{elements}"));
        }
        self.run("lobe fit paint.ddr --model ggx --starts 2 -o fit.json");
        self.write("pairs.csv", "0,0,1,0,0,1\n0.6,0,0.8,-0.6,0,0.8\n");
        self.write("scene.toml", SCENE);
        self.write("glass.toml", format!("{SCENE}\n[spectrum]\nstokes = true\n"));
        self.run("lobe render glass.toml -o glass.exr --quiet");
        for tile in 1..=4 {
            self.run(&format!("lobe render scene.toml -o part{tile}.exr --tile {tile}/4 --quiet"));
        }
        self.run("lobe farm slurm scene.toml -o look.exr --parts 4");
    }

    /// Other programs in examples may be missing here; they are then replaced by programs that do nothing, so that the
    /// commands of this project are still run.
    fn without_missing_programs(&self) {
        for program in ["jq", "man"] {
            let name = self.path("home").join(program);
            fs::write(&name, "#!/bin/sh\ncat > /dev/null\n").expect("a program");
            self.run(&format!("chmod +x '{}'", name.display()));
        }
    }

    /// Removes the output file of a command that renders, because a finished part is not overwritten; with `--resume`
    /// it is kept.
    pub fn without_output(&self, line: &str) {
        let output = line.split_once(" -o ").and_then(|(_, rest)| rest.split_whitespace().next());
        if let Some(output) = output.filter(|_| line.starts_with("lobe render") && !line.contains("--resume")) {
            drop(fs::remove_file(self.path(output)));
        }
    }

    /// Another folder with the same files.
    pub fn copy(&self) -> Scratch {
        let other = Scratch(tempfile::tempdir().expect("a temporary folder"));
        copy(self.0.path(), other.0.path());
        other
    }
}

/// Copies a folder with all of its contents.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("a folder") {
        let path = entry.expect("an entry").path();
        let target = to.join(path.file_name().expect("a name"));
        match path.is_dir() {
            true => copy(&path, &target),
            false => drop(fs::copy(&path, &target).expect("a file")),
        }
    }
}

/// A lobe about the mirror direction, on a grid of angles.
fn glossy(line: impl Fn([f64; 3], f64) -> String) -> String {
    let mut lines = String::new();
    for theta_i in [0.0_f64, 20.0, 40.0, 60.0, 80.0] {
        for theta_o in (0..90).step_by(10).map(f64::from) {
            for phi_o in (0..360).step_by(30).map(f64::from) {
                let [(sin_i, cos_i), (sin_o, cos_o)] = [theta_i, theta_o].map(|angle| angle.to_radians().sin_cos());
                let cos = cos_i * cos_o - sin_i * sin_o * phi_o.to_radians().cos();
                lines += &line([theta_i, theta_o, phi_o], 0.1 + 0.1 * cos.max(0.0).powi(4));
            }
        }
    }
    lines
}

fn glossy_cornell() -> String {
    let records = glossy(|[theta_i, theta_o, phi_o], f| {
        let [a, b, c] = [theta_i, theta_o, phi_o].map(f64::to_radians);
        format!("{a} 0 {b} {c} {f} {f}\n")
    });
    format!("# num wls\n2\n# wls\n400 500\n{records}")
}

fn glossy_csv() -> String {
    let records =
        glossy(|[theta_i, theta_o, phi_o], f| format!("{theta_i},{theta_o},{phi_o},{},{f},{}\n", 0.5 * f, 0.8 * f));
    format!("theta_i,theta_o,phi_o,450nm,550nm,650nm\n{records}")
}

const SCENE: &str = "\
[camera]
position = [0, 1.2, 4]
target = [0, 0.5, 0]

[film]
width = 320
height = 256

[integrator]
samples = 128

[material.paint]
file = \"paint.ddr\"

[[object]]
shape = \"sphere\"
translate = [0, 1, 0]
material = \"paint\"

[[light]]
kind = \"environment\"
radiance = 1
";
