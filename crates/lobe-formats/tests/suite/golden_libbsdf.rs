//! The reader and the reference evaluation together against the answers of libbsdf, an independent implementation.

use std::path::Path;

use lobe_formats::open;
use lobe_table::specular::reference::eval;
use lobe_table::{Data, Edges, specular};
use lobe_testing::golden::{Worst, direction, queries};

/// The largest difference from the golden answers, relative to the largest magnitude in the table.
fn largest_error(samples: &specular::Data, answers: &Path) -> (usize, f64) {
    let scale = samples.values().iter().fold(0.0_f64, |largest, &value| largest.max(f64::from(value).abs()));
    let queries = queries(answers);
    let mut out = vec![0.0; samples.channels().count()];
    let mut worst = Worst::default();
    for (at, (query, answer)) in queries.iter().enumerate() {
        eval(samples, &Edges::extrapolate(), direction(query, 0), direction(query, 3), &mut out);
        assert_eq!(out.len(), answer.len());
        out.iter().zip(answer).for_each(|(got, expected)| worst.see((got - expected).abs() / scale, at));
    }
    (queries.len(), worst.error)
}

fn check(file: &Path, answers: &Path, expected_pairs: usize) {
    let document = open(file).unwrap().1;
    let Some(Data::Specular(samples)) = document.only() else { panic!("{} is not a table", file.display()) };
    let (pairs, error) = largest_error(samples, answers);
    println!("{}: {pairs} pairs, largest error {error:.2e} of the largest value", file.display());
    assert_eq!(pairs, expected_pairs);
    assert!(error <= 2e-6, "{}: {error:e}", file.display());
}

#[test]
fn synthetic_files_agree_with_libbsdf() {
    let Some(shared) = lobe_testing::files::shared() else { return };
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

#[test]
fn real_files_agree_with_libbsdf() {
    let Some(shared) = lobe_testing::files::shared() else { return };
    for (file, pairs) in [
        ("AnoBlackEC1onAlum.bsdf", 300),
        ("AnoBlackNiTEonINVAR.bsdf", 300),
        ("MagicBlack.bsdf", 300),
        ("IMX455.bsdf", 400),
    ] {
        let answers = shared.join("golden").join(format!("real_{file}.libbsdf.txt"));
        check(&shared.join("data/zemax_bsdf").join(file), &answers, pairs);
    }
}
