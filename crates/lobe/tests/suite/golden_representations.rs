//! Representations other than specular tables, in `f32` lanes on every backend, against the answers of the programs
//! that define their formats.

use std::path::Path;

use lobe::formats::{Format, merl, utia};
use lobe::{Backend, Data, Material, Options};
use lobe_testing::files::shared;
use lobe_testing::golden::{Worst, direction, queries, sheets, unit};
use lobe_testing::made::{merl_formula, spherical, utia_numbers};

/// All backends of this machine, fused and strict.
fn backends() -> Vec<Backend> {
    Backend::available().into_iter().flat_map(|backend| [backend.fused(), backend.strict()]).collect()
}

fn material(format: Format, bytes: &[u8], path: &Path) -> Material {
    let document = lobe::formats::read(format, bytes, path).unwrap_or_else(|error| panic!("{error}"));
    Material::from_document(&document, &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn narrow(pairs: &[([f64; 3], [f64; 3])]) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    pairs.iter().map(|(wi, wo)| (wi.map(|c| c as f32), wo.map(|c| c as f32))).unzip()
}

/// The values of all pairs on every backend; strict ones must have the same bits.
fn everywhere(mut material: Material, pairs: &[([f64; 3], [f64; 3])]) -> Vec<(Backend, Vec<f32>)> {
    let (wi, wo) = narrow(pairs);
    let mut answers: Vec<(Backend, Vec<f32>)> = Vec::new();
    for backend in backends() {
        material = material.with_backend(backend);
        let mut values = vec![f32::NAN; pairs.len() * material.channel_count()];
        material.eval_batch(&wi, &wo, &mut values);
        answers.push((backend, values));
    }
    let strict: Vec<_> = answers.iter().filter(|(backend, _)| backend.is_strict()).collect();
    for (backend, values) in &strict {
        let same = values.iter().zip(&strict[0].1).all(|(a, b)| a.to_bits() == b.to_bits());
        assert!(same, "{backend} does not have the same bits as {}", strict[0].0);
    }
    answers
}

/// The directions, rounded to `f32`.
fn rounded((wi, wo): ([f64; 3], [f64; 3])) -> ([f64; 3], [f64; 3]) {
    let round = |w: [f64; 3]| {
        let w = w.map(|c| f64::from(c as f32));
        let length = w.iter().map(|x| x * x).sum::<f64>().sqrt();
        w.map(|c| c / length)
    };
    (round(wi), round(wo))
}

#[test]
fn merl_bins_agree_with_the_reader_of_the_database() {
    let Some(shared) = shared() else { return };
    let bytes = merl_formula();
    let path = Path::new("formula.binary");
    let data = merl::read(&bytes, path).expect("a MERL material");
    let queries = queries(&shared.join("golden/merl_formula.txt"));
    assert_eq!(queries.len(), 400);
    let pairs: Vec<_> = queries.iter().map(|(q, _)| (spherical([q[0], q[1]]), spherical([q[2], q[3]]))).collect();
    let material = material(Format::Merl, &bytes, path);
    for (backend, values) in everywhere(material, &pairs) {
        let mut exact = 0;
        for (at, (_, answer)) in queries.iter().enumerate() {
            let found = [0, 1, 2].map(|channel| f64::from(values[3 * at + channel]));
            if found.as_slice() == answer {
                exact += 1;
                continue;
            }
            // Next to a border, the neighbouring bin may be chosen, here or by the other program.
            let (wi, wo) = rounded(pairs[at]);
            let candidates = data.candidates(wi, wo);
            assert!(candidates.len() > 1 && candidates.contains(&found), "{backend} {at}: {found:?}, not {answer:?}");
        }
        println!("MERL on {backend}: {exact} of {} exact", queries.len());
        assert!(exact >= 396, "{backend}: {exact} exact");
    }
}

#[test]
fn utia_values_agree_with_the_reader_of_the_database() {
    let Some(shared) = shared() else { return };
    let bytes = utia_numbers();
    let path = Path::new("lcg.bin");
    let data = utia::read(&bytes, path).expect("a UTIA material");
    let queries = queries(&shared.join("golden/utia_lcg.txt"));
    assert_eq!(queries.len(), 200);
    let pairs: Vec<_> = queries.iter().map(|(q, _)| (spherical([q[0], q[1]]), spherical([q[2], q[3]]))).collect();
    let material = material(Format::Utia, &bytes, path);
    for (backend, values) in everywhere(material, &pairs) {
        let mut worst = Worst::default();
        for (at, (_, answer)) in queries.iter().enumerate() {
            let (wi, wo) = rounded(pairs[at]);
            for (channel, expected) in answer.iter().enumerate() {
                let error = (f64::from(values[3 * at + channel]) - expected).abs() / 60.01;
                assert!(error < data.bound(wi, wo), "{backend} {at}: {error:e}");
                worst.see(error, at);
            }
        }
        println!("UTIA on {backend}: {:.2e} of the largest value", worst.error);
        assert!(worst.error < 2e-5, "{backend}: {worst:?}");
    }
}

#[test]
fn polarised_values_agree_with_mitsuba() {
    let Some(shared) = shared() else { return };
    let material = Material::open(shared.join("golden/syn.pbsdf")).expect("a polarised material");
    let wavelengths: Vec<f64> = material.wavelengths().expect("wavelengths").to_vec();
    let queries = queries(&shared.join("golden/syn.pbsdf.mitsuba.txt"));
    // The program was also queried between wavelengths, where lanes have no values.
    let at_knots: Vec<_> = queries
        .iter()
        .filter_map(|(query, answer)| Some((query, answer[0], wavelengths.iter().position(|nm| *nm == query[6])?)))
        .collect();
    assert!(at_knots.len() >= 40, "{} answers at a wavelength of the table", at_knots.len());
    let pairs: Vec<_> = at_knots.iter().map(|(query, ..)| (unit(query, 3), unit(query, 0))).collect();
    for (backend, values) in everywhere(material, &pairs) {
        let mut worst = Worst::default();
        for (at, (_, expected, channel)) in at_knots.iter().enumerate() {
            let light = pairs[at].0;
            let found = f64::from(values[at * wavelengths.len() + channel]);
            worst.see((found * light[2] - expected).abs(), at);
        }
        println!("syn.pbsdf on {backend}: {:.2e}", worst.error);
        assert!(worst.error < 2e-6, "{backend}: {worst:?}");
    }
}

/// If no border is near, the value is that of the table; Radiance is within 3.5e-4 of it, by which it perturbs values
/// on purpose.
fn check_sheet(xml: &Path, answers: &Path, exact: Option<usize>) -> usize {
    let (_, document) = lobe::formats::open(xml).unwrap_or_else(|error| panic!("{error}"));
    let Some(Data::Window(data)) = document.only() else { panic!("{} is not a sheet", xml.display()) };
    let band = data.bands.iter().position(|band| band.wavelength.eq_ignore_ascii_case("visible"));
    let band = band.expect("a visible band");
    let window = &data.bands[band].window;
    let queries = queries(answers);
    let pairs: Vec<_> = queries.iter().map(|(query, _)| (direction(query, 0), direction(query, 3))).collect();
    let material = Material::open(xml).unwrap_or_else(|error| panic!("{error}"));
    let channels = material.channel_count();
    let name = xml.file_name().expect("a name").to_string_lossy();
    for (backend, values) in everywhere(material, &pairs) {
        let mut agreed = 0;
        for (at, (_, answer)) in queries.iter().enumerate() {
            let found = f64::from(values[at * channels + band]);
            let (column, tolerance) = exact.map_or((0, 3.5e-4), |column| (column, 1e-6));
            if (found - answer[column]).abs() <= tolerance * answer[column].abs().max(1e-12) {
                agreed += 1;
                continue;
            }
            let (wi, wo) = rounded(pairs[at]);
            let candidates = window.candidates(wi, wo);
            let has_choice = candidates.iter().any(|value| *value != candidates[0]);
            assert!(has_choice && candidates.contains(&found), "{name} on {backend}, {at}: {found}, not {answer:?}");
        }
        println!("{name:<30} on {backend}: {agreed} of {}", queries.len());
        assert!(agreed * 100 >= queries.len() * 99, "{name} on {backend}: {agreed}");
    }
    queries.len()
}

#[test]
fn sheets_agree_with_radiance() {
    let Some(shared) = shared() else { return };
    let [synthetic, real] = sheets(&shared);
    let exact = synthetic.iter().map(|(xml, answers)| check_sheet(xml, answers, Some(1))).sum::<usize>();
    let count = exact + real.iter().map(|(xml, answers)| check_sheet(xml, answers, None)).sum::<usize>();
    assert!(count >= 4000, "{count} answers");
}
