//! Compiles programs in C and C++, runs them alone, with sanitizers and under valgrind, and compares their values with
//! the facade's.

use std::path::Path;
use std::process::{Command, Output};

use lobe::{Given, Material, Options, Sampler, SamplerOptions};
use lobe_testing::files::{fixture, shared_file};

use crate::compiler::{Language, compiled, example, has, test_program};

const SANITIZERS: &[&str] = &["-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-fno-omit-frame-pointer"];

fn run(program: &Path, arguments: &[&Path]) -> Output {
    let mut command = Command::new(program);
    command.args(arguments).env("ASAN_OPTIONS", "detect_leaks=1:detect_stack_use_after_return=1");
    command.output().unwrap_or_else(|error| panic!("{}: {error}", program.display()))
}

fn text(output: &Output) -> String {
    let [out, error] = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    assert!(output.status.success(), "{}\n{out}\n{error}", output.status);
    out
}

/// The numbers of each line except the first few.
fn numbers(text: &str) -> Vec<Vec<f32>> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| line.split(' ').map(|word| word.parse().expect("a number")).collect()).collect()
}

#[test]
fn the_example_in_c_prints_the_bits_of_the_facade() {
    let file = fixture("conductor-7x8x13.ddr");
    let Some(printed) = in_every_way(Language::C, &example("eval.c"), &file) else { return };
    let found = numbers(&printed);
    let material = Material::open(&file).expect("a material");
    let backend = material.backend().strict();
    let material = material.with_backend(backend);
    assert_eq!(found.len(), 7);
    for line in found {
        let mut f = vec![0.0; material.channel_count()];
        material.eval([0.6, 0.0, 0.8], [line[0], line[1], line[2]], &mut f);
        assert_eq!(line[3..], f);
    }
    let folder = tempfile::tempdir().expect("a folder");
    let Some(program) = compiled(Language::C, &example("eval.c"), &[], folder.path()) else { return };
    let missing = run(&program, &[Path::new("missing.ddr")]);
    assert_eq!(missing.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&missing.stderr).starts_with("missing.ddr: "));
}

#[test]
fn the_example_in_cpp_finds_the_albedo() {
    let file = fixture("conductor-7x8x13.ddr");
    let Some(printed) = in_every_way(Language::Cpp, &example("albedo.cpp"), &file) else { return };
    let material = std::sync::Arc::new(Material::open(&file).expect("a material"));
    let sampler = Sampler::new(material, &SamplerOptions::default()).expect("a sampler");
    let (mut sum, n) = ([0.0_f64; 3], 128);
    for index in 0..n * n {
        let u = [index % n, index / n].map(|i| (i as f32 + 0.5) / n as f32);
        let mut weight = [0.0; 3];
        sampler.sample(Given::Light, [0.6, 0.0, 0.8], u, &mut weight);
        sum = [0, 1, 2].map(|c| sum[c] + f64::from(weight[c]));
    }
    let expected = ["R", "G", "B"].iter().zip(sum).map(|(name, sum)| format!("{name} {:.4}\n", sum / (n * n) as f64));
    assert_eq!(printed, expected.collect::<String>());
}

/// The output of `layouts.c` and `everything.cpp`: the bits of values.
fn expected(file: &Path) -> Vec<String> {
    let material = Material::open_with(file, &Options::default()).expect("a material");
    let backend = material.backend().strict();
    let material = material.with_backend(backend);
    let count = 20_000;
    let mut state = 1_u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / 16_777_216.0
    };
    let mut direction = || {
        let [x, y, z] = [random() - 0.5, random() - 0.5, random() + 0.01];
        let length = (x * x + y * y + z * z).sqrt();
        [x / length, y / length, z / length]
    };
    let (wi, wo): (Vec<_>, Vec<_>) = (0..count).map(|_| (direction(), direction())).unzip();
    let mut f = vec![0.0; count * material.channel_count()];
    material.eval_batch(&wi, &wo, &mut f);
    let hash = f.iter().fold(14_695_981_039_346_656_037_u64, |hash, value| {
        (hash ^ u64::from(value.to_bits())).wrapping_mul(1_099_511_628_211)
    });
    vec![format!("{hash:016x}")]
}

/// What a program prints for a file; the same under valgrind and with sanitizers, which must find nothing, if these are
/// installed. `None` if it cannot be compiled.
fn in_every_way(language: Language, source: &Path, file: &Path) -> Option<String> {
    let folder = tempfile::tempdir().expect("a folder");
    let program = compiled(language, source, &[], folder.path())?;
    let printed = text(&run(&program, &[file]));
    if has("valgrind") {
        let mut command = Command::new("valgrind");
        command.args([
            "--quiet",
            "--error-exitcode=9",
            "--leak-check=full",
            // The threads of a pool live as long as the program.
            "--errors-for-leak-kinds=definite,indirect",
            "--show-leak-kinds=definite,indirect",
        ]);
        let output = command.arg(&program).arg(file).env("RAYON_NUM_THREADS", "2").output().expect("valgrind");
        assert_eq!(text(&output), printed);
        assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    let with = tempfile::tempdir().expect("a folder");
    if let Some(program) = compiled(language, source, SANITIZERS, with.path()) {
        assert_eq!(text(&run(&program, &[file])), printed);
    }
    Some(printed)
}

/// Runs `layouts.c` or `everything.cpp`, which print the bits of values.
fn with_the_bits_of_the_facade(language: Language, source: &Path, file: &Path) {
    let Some(printed) = in_every_way(language, source, file) else { return };
    for line in expected(file) {
        assert!(printed.lines().any(|printed| printed == line), "{line} is not in\n{printed}");
    }
}

#[test]
fn every_function_works_in_c_with_sanitizers_and_under_valgrind() {
    with_the_bits_of_the_facade(Language::C, &test_program("layouts.c"), &fixture("conductor-7x8x13.ddr"));
}

#[test]
fn every_function_works_in_cpp_with_sanitizers_and_under_valgrind() {
    with_the_bits_of_the_facade(Language::Cpp, &test_program("everything.cpp"), &fixture("cloth-17x7x17x13.ddr"));
}

#[test]
fn measured_files_have_the_same_bits_in_c() {
    for name in ["data/klems_xml/2011-SA1.XML", "data/rgl_bsdf/colodur_napoli_4f_rgb.bsdf"] {
        let Some(file) = shared_file(name) else { continue };
        let folder = tempfile::tempdir().expect("a folder");
        let Some(program) = compiled(Language::C, &test_program("layouts.c"), &[], folder.path()) else { return };
        let printed = text(&run(&program, &[&file]));
        for line in expected(&file) {
            assert!(printed.lines().any(|printed| printed == line), "{name}: {line} is not in\n{printed}");
        }
    }
}
