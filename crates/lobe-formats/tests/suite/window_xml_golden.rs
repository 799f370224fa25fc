//! WINDOW XML against the answers of Radiance.

use std::path::Path;

use lobe_formats::window_xml;
use lobe_table::window;
use lobe_testing::files::{bytes, files, shared};
use lobe_testing::golden::{direction, queries, sheets};

fn visible(path: &Path) -> window::Blocks {
    let bytes = bytes(path);
    assert!(window_xml::matches(&bytes), "{}", path.display());
    let sheet = window_xml::read(&bytes, path).unwrap_or_else(|error| panic!("{error}"));
    sheet.data.band("visible").expect("a visible band").clone()
}

/// Radiance moves values by up to 3.5e-4 on purpose, to break ties when it samples.
const PERTURBATION: f64 = 3.5e-4;

#[test]
fn synthetic_files_agree_with_the_reference() {
    let Some(shared) = shared() else { return };
    let [synthetic, _] = sheets(&shared);
    let mut count = 0;
    for (xml, answers) in synthetic {
        let name = xml.file_stem().expect("a name").to_string_lossy();
        let window = visible(&xml);
        let (mut exact, mut perturbed) = (0.0_f64, 0.0_f64);
        for (query, answer) in queries(&answers) {
            let (wi, wo) = (direction(&query, 0), direction(&query, 3));
            let found = window.eval(wi, wo);
            let error = |wanted: f64| (found - wanted).abs() / wanted.abs().max(1e-12);
            perturbed = perturbed.max(error(answer[0]));
            exact = exact.max(error(answer[1]));
            count += 1;
        }
        println!("{name}: exact {exact:.2e}, Radiance {perturbed:.2e}");
        assert!(exact <= 1e-6, "{name}: {exact}");
        assert!(perturbed <= PERTURBATION, "{name}: {perturbed}");
    }
    assert!(count >= 1000, "{count} answers");
}

#[test]
fn real_files_agree_with_the_reference() {
    let Some(shared) = shared() else { return };
    let [_, real] = sheets(&shared);
    let mut count = 0;
    for (xml, answers) in real {
        let name = xml.file_name().expect("a name").to_string_lossy();
        let window = visible(&xml);
        let mut worst = 0.0_f64;
        for (query, answer) in queries(&answers) {
            let (wi, wo) = (direction(&query, 0), direction(&query, 3));
            let (found, wanted) = (window.eval(wi, wo), answer[0]);
            let error = (found - wanted).abs() / wanted.abs().max(1e-12);
            assert!(error <= PERTURBATION, "{name}: {found}, not {wanted} for {wi:?} {wo:?}");
            worst = worst.max(error);
            count += 1;
        }
        println!("{name}: {worst:.2e}");
    }
    assert!(count >= 3000, "{count} answers");
}

#[test]
fn every_real_file_loads_and_survives_a_round_trip() {
    let Some(shared) = shared() else { return };
    let data = shared.join("data");
    let target = tempfile::tempdir().expect("a folder");
    for path in files(&data.join("klems_xml")).into_iter().chain(files(&data.join("tensortree_xml"))) {
        let sheet = window_xml::read(&bytes(&path), &path).unwrap_or_else(|error| panic!("{error}"));
        let copy = target.path().join("copy.xml");
        window_xml::write(&sheet.data, &sheet.source, &copy).expect("a written copy");
        let again = window_xml::read(&bytes(&copy), &copy).unwrap_or_else(|error| panic!("{error}"));
        assert!(sheet == again, "{}", path.display());
        let bands: Vec<&str> = sheet.data.bands.iter().map(|band| band.wavelength.as_str()).collect();
        println!("{:?}: {bands:?}", sheet.source);
    }
}
