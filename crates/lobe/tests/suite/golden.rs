//! Tables in `f32` lanes against the answers of libbsdf, an independent implementation, on every backend.

use std::path::{Path, PathBuf};

use lobe::{Backend, Data, Edges, Material, Options};
use lobe_testing::files::shared;
use lobe_testing::golden::{Worst, direction, queries};

/// Relative to the largest magnitude in the table.
const BOUND: f64 = 2e-5;

/// All backends of this machine, fused and strict.
fn backends() -> Vec<Backend> {
    Backend::available().into_iter().flat_map(|backend| [backend.fused(), backend.strict()]).collect()
}

/// The largest deviation on each backend.
fn check(file: &Path, answers: &Path, expected_pairs: usize) {
    let (_, document) = lobe::formats::open(file).unwrap_or_else(|error| panic!("{error}"));
    let Some(Data::Specular(samples)) = document.only() else { panic!("{} is not a table", file.display()) };
    let scale = samples.values().iter().fold(0.0_f64, |largest, &value| largest.max(f64::from(value).abs()));
    let queries = queries(answers);
    assert_eq!(queries.len(), expected_pairs);
    let narrow = |query: &[f64], at| direction(query, at).map(|c| c as f32);
    let (wi, wo): (Vec<_>, Vec<_>) = queries.iter().map(|(query, _)| (narrow(query, 0), narrow(query, 3))).unzip();
    let options = Options { edges: Edges::extrapolate(), ..Options::default() };
    let mut material = Material::from_document(&document, &options).unwrap_or_else(|error| panic!("{error}"));
    let channels = material.channel_count();
    let mut failures = Vec::new();
    for backend in backends() {
        material = material.with_backend(backend);
        let mut values = vec![f32::NAN; queries.len() * channels];
        material.eval_batch(&wi, &wo, &mut values);
        let mut worst = Worst::default();
        for (at, ((_, answer), value)) in queries.iter().zip(values.chunks_exact(channels)).enumerate() {
            assert_eq!(answer.len(), channels);
            let deviations = answer.iter().zip(value).map(|(expected, &got)| (f64::from(got) - expected).abs() / scale);
            deviations.for_each(|deviation| worst.see(deviation, at));
        }
        let name = file.file_name().expect("a name").to_string_lossy();
        let form = if backend.is_strict() { "strict" } else { "fused" };
        println!("{name:<26} {backend:<7} {form:<6} {:.2e} of the largest value", worst.error);
        if worst.error.is_nan() || worst.error > BOUND {
            let (query, answer) = &queries[worst.at];
            let value = &values[worst.at * channels..][..channels];
            failures
                .push(format!("{name} on {backend} {form}: {:e} at {query:?}: {value:?}, not {answer:?}", worst.error));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn synthetic_tables_agree_with_libbsdf_in_lanes() {
    let Some(shared) = shared() else { return };
    let golden = shared.join("golden");
    for (file, answers, pairs) in [
        ("p3.ddr", "p3.ddr.libbsdf.txt", 300),
        ("a3.ddr", "a3.ddr.libbsdf.txt", 300),
        ("s3.ddr", "s3.ddr.libbsdf.txt", 300),
        ("t3.ddt", "t3.ddt.libbsdf.txt", 300),
        ("zemax_plane.bsdf", "zemax_plane.libbsdf.txt", 200),
        ("zemax_4d.bsdf", "zemax_4d.libbsdf.txt", 200),
    ] {
        check(&golden.join(file), &golden.join(answers), pairs);
    }
}

/// Every real table for which there are answers.
#[test]
fn measured_tables_agree_with_libbsdf_in_lanes() {
    let Some(shared) = shared() else { return };
    let data = shared.join("data/zemax_bsdf");
    let answers = |path: &PathBuf| {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        Some(name.strip_prefix("real_")?.strip_suffix(".libbsdf.txt")?.to_owned())
    };
    let mut count = 0;
    for path in lobe_testing::files::files(&shared.join("golden")) {
        let Some(file) = answers(&path) else { continue };
        check(&data.join(&file), &path, if file == "IMX455.bsdf" { 400 } else { 300 });
        count += 1;
    }
    assert_eq!(count, 4);
}
