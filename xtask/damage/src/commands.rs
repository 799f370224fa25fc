//! The commands that are run on damaged files.

use crate::inputs::Kind;

/// A command line: `{in}` is the damaged file, `{out}` a path without an extension for what is written, and other files
/// are those of [`crate::inputs::sound`].
pub struct Command {
    /// The kind of file that is damaged.
    pub kind: Kind,
    /// How often the command is run relative to the others; slow ones are run less often.
    pub share: u32,
    /// The arguments, separated by spaces.
    pub line: &'static str,
}

const fn material(share: u32, line: &'static str) -> Command {
    Command { kind: Kind::Material, share, line }
}

const fn of(kind: Kind, share: u32, line: &'static str) -> Command {
    Command { kind, share, line }
}

/// All commands.
pub const COMMANDS: &[Command] = &[
    material(14, "info {in}"),
    material(6, "info {in} --json"),
    material(16, "check {in}"),
    material(4, "check {in} --json"),
    material(8, "eval {in} --wi 0.3,0,0.9 --wo -0.2,0.1,0.9"),
    material(4, "eval {in} --angles 30,0,10,90 --json"),
    material(8, "eval {in} --pairs pairs.csv --strict"),
    material(2, "eval {in} --wi 0,0,1 --wo 0.1,0,-1 --unit rad --values f-cos --scale 0.5"),
    material(6, "albedo {in} --sigma 0,45"),
    material(3, "compare {in} sound.ddr --pairs 200 --pixels 8"),
    material(2, "compare {in} {in} --pairs 200 --pixels 8 --json"),
    material(4, "plot {in} -o {out}.svg --width 300"),
    material(3, "plot {in} -o {out}.png --kind polar --width 300"),
    material(2, "plot {in} -o {out}.svg --kind slices --width 300"),
    material(2, "plot {in} -o {out}.svg --kind sphere --width 300"),
    material(2, "plot {in} -o {out}.svg --kind spectra --width 300"),
    material(2, "plot {in} sound.ddr -o {out}.svg --width 300"),
    material(1, "plot {in} -o {out}.html --width 300"),
    material(3, "preview {in} -o {out}.png --size 8x8 --samples 1 --time 1s --show ball --quiet"),
    material(4, "convert {in} {out}.ddr"),
    material(3, "convert {in} {out}.csv --to csv"),
    material(3, "convert {in} {out}.npz"),
    material(2, "convert {in} {out}.bsdf --to zemax"),
    material(2, "convert {in} {out}.xml --to klems"),
    material(2, "convert {in} {out}.mbsdf"),
    material(2, "convert {in} {out}.ssdd --to ssdd"),
    material(4, "resample {in} {out}.ddr --sigma 0,40,80 --psi 0 --theta 0,60,180 --phi 0,180,360"),
    material(1, "resample {in} {out}.ddr --error 0.5 --fill zeros"),
    material(
        2,
        "resample {in} {out}.ddr --sigma 0,60 --psi 0 --theta 0,90,180 --phi 0,180,360 --fill negatives --beyond linear \
         --mask {out}.csv --mirror --reciprocal --conserve --colour rgb",
    ),
    material(2, "albedo {in} --sigma 30 --json --tolerance 0.01"),
    material(2, "compare sound.ddr {in} --pairs 200 --pixels 8 --within 0.1"),
    material(2, "fit {in} --model lambert --starts 1 --pairs 64 -o {out}.toml"),
    material(1, "fit {in} --model oren-nayar --starts 1 --pairs 64 --rgb --robust -o {out}.mtlx"),
    material(1, "fit {in} --model abg --starts 1 --pairs 64 -o {out}.csv"),
    material(2, "convert {in} {out}.csv --to nist"),
    material(2, "convert {in} {out}.brdf --to lighttools"),
    material(2, "fit {in} --model ggx --starts 1 --pairs 64"),
    material(1, "fit {in} --model lambert --starts 1 --pairs 64 --json"),
    material(6, "import {in} --no-sidecar --json"),
    material(4, "import {in} --columns theta_i=1,theta_o=2,phi_o=3,f=4 -o {out}.csv"),
    of(Kind::MaterialOfScene, 4, "render scene.toml -o {out}.png --samples 1 --time 1s --quiet"),
    of(Kind::Pairs, 6, "eval sound.ddr --pairs {in}"),
    of(Kind::Matrix, 3, "matrix {in} sound.mtx -o {out}.mtx --format float"),
    of(Kind::Matrix, 2, "matrix {in} {in} --plus {in} --minus sound.mtx"),
    of(Kind::Fit, 2, "plot sound.ddr --fit {in} -o {out}.html --width 300"),
    of(Kind::Part, 2, "plot {in} -o {out}.svg --kind spectra --at 3,2 --width 300"),
    of(Kind::Sidecar, 4, "eval table.csv --wi 0.3,0,0.9 --wo -0.2,0.1,0.9"),
    of(Kind::Sidecar, 3, "check table.csv"),
    of(Kind::Sidecar, 2, "import table.csv --no-sidecar"),
    of(Kind::Scene, 12, "render {in} -o {out}.png --samples 1 --time 1s --quiet"),
    of(Kind::Scene, 1, "farm slurm {in} -o {out}.exr --parts 2"),
    of(Kind::Mesh, 6, "render scene.toml -o {out}.png --samples 1 --time 1s --quiet"),
    of(Kind::Environment, 6, "render scene.toml -o {out}.png --samples 1 --time 1s --quiet"),
    of(Kind::Spectrum, 3, "render scene.toml -o {out}.png --samples 1 --time 1s --quiet"),
    of(Kind::Part, 4, "merge {in} sound-2.exr -o {out}.png"),
    of(Kind::Part, 2, "merge {in} -o {out}.exr --allow-gaps"),
    of(Kind::Part, 3, "render sound.toml -o {in} --resume --samples 6 --strict --tile 1/2 --quiet"),
    of(Kind::Plan, 2, "farm status job"),
];
