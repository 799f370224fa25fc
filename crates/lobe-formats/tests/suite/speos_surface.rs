//! Surfaces of Speos described by a few numbers.

use std::f64::consts::PI;
use std::path::Path;

use lobe_formats::{Document, FormatError, Part, from_bytes};
use lobe_table::{Channels, Data, Scatter};
use lobe_testing::examples::{SPEOS_COATED, SPEOS_SIMPLE};

fn read(text: &str) -> Result<Document, FormatError> {
    from_bytes(text.as_bytes(), Path::new("file"))
}

fn simple(rest: &str) -> String {
    format!("OPTIS - Simple scattering surface file v2.0\r\nScattering surface\r\n{}", rest.replace('\n', "\r\n"))
}

#[track_caller]
fn refused(text: &str, found: &str) {
    let error = read(text).map(|_| ()).expect_err("a refusal").to_string();
    assert!(error.contains(found), "{error}");
}

/// Scatter, albedo of a constant `f`, and mirror reflectances, of the parts.
fn parts(text: &str) -> Vec<(Scatter, f64)> {
    let document = read(text).unwrap_or_else(|error| panic!("{error}"));
    let of_part = |part: &Part| match &part.data {
        Data::Spherical(data) => (data.scatter(), f64::from(data.values()[0]) * PI),
        Data::Mirror(data) => (data.scatter(), 10.0 + f64::from(data.values()[0])),
        other => panic!("{other:?}"),
    };
    document.parts.iter().map(of_part).collect()
}

#[track_caller]
fn assert_parts(text: &str, wanted: &[(Scatter, f64)]) {
    let found = parts(text);
    let is_near = |(a, b): (&(Scatter, f64), &(Scatter, f64))| a.0 == b.0 && (a.1 - b.1).abs() < 1e-6;
    assert!(found.len() == wanted.len() && found.iter().zip(wanted).all(is_near), "{found:?}, not {wanted:?}");
}

#[test]
fn light_that_is_not_absorbed_is_divided() {
    let (reflection, transmission) = (Scatter::Reflection, Scatter::Transmission);
    assert_parts(&simple("Reflection\n0 100 0 5\n"), &[(reflection, 1.0)]);
    assert_parts(&simple("Reflection\n80 100 0 0"), &[(reflection, 0.2)]);
    assert_parts(&simple("Transmission\n0 0 0 25\n"), &[(transmission, 0.0), (transmission, 11.0)]);
    assert_parts(&simple("Reflection\n50 40 0 0\n"), &[(reflection, 0.2), (reflection, 10.3)]);
    let both = "Both\n\n10 20 40 0 0\n4 8\n0\n75\n";
    let wanted = [(reflection, 0.135), (reflection, 10.54), (transmission, 0.09), (transmission, 10.135)];
    assert_parts(&simple(both), &wanted);
    refused(&simple(&both.replace("\n0\n75", "\n1")), "a split by Fresnel's laws");
    refused(&simple("Reflection\n0 50 20 5\n"), "a Gaussian part of 20 percent");
    refused(&simple("Diffuse\n0 50 0 5\n"), "\"diffuse\"");
    refused(&simple("Reflection\n0 150 0 5\n"), "a Lambertian part 150");
    refused(&simple("Reflection\n0 50\n"), "the end of the file");
    lobe_testing::damage::truncations(SPEOS_SIMPLE.as_bytes(), |bytes| read(&String::from_utf8_lossy(bytes)).is_ok());
}

#[test]
fn coatings_are_mirrors_of_unpolarised_light() {
    let document = read(SPEOS_COATED).expect("a coating");
    assert!(document.source.contains(&("description".into(), "Example".into())), "{:?}", document.source);
    let [Data::Mirror(reflected), Data::Mirror(passed)] = [&document.parts[0].data, &document.parts[1].data] else {
        panic!("two mirrors")
    };
    assert_eq!((reflected.scatter(), passed.scatter()), (Scatter::Reflection, Scatter::Transmission));
    assert_eq!(reflected.channels(), &Channels::Spectral(vec![480.0, 580.0]));
    let near = |found: Vec<f64>, wanted: [f64; 2]| found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(near(reflected.at(0.0, 0.0), [0.3, 0.04]), "{:?}", reflected.at(0.0, 0.0));
    assert!(near(passed.at(0.0, 0.0), [0.7, 0.96]), "{:?}", passed.at(0.0, 0.0));
    assert!(near(reflected.at(PI / 2.0, 0.0), [1.0, 1.0]));
    refused(&SPEOS_COATED.replace("480\t\t580", "580\t\t480"), "wavelengths out of order");
    refused(&SPEOS_COATED.replace("\n90\t", "\n0\t"), "incident angle 0");
    refused(&SPEOS_COATED.replace("2 2", "2000000000 2"), "2000000000");
    refused(&SPEOS_COATED.replace("\t32\t", "\t-1\t"), "a reflectance -1");
    lobe_testing::damage::truncations(SPEOS_COATED.as_bytes(), |bytes| read(&String::from_utf8_lossy(bytes)).is_ok());
}
