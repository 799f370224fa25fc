//! LightTools tables as instruments write them.

use std::f64::consts::PI;
use std::path::Path;

use lobe_formats::reading::Scale;
use lobe_formats::{Document, FormatError, ReadOptions, from_bytes_with, light_tools};
use lobe_table::{Channels, Data, Scatter, Side};

/// Three radial angles and four azimuths: the values are 1 more for each column, and 0.1 more for each row.
const HEAD: &str = "Symmetry Asymmetric\nSpectralContent Monochrome\nScatterAzimuth 4\n0 90 180 270\nScatterRadial 3\n\
                    0 30 60\nDataBegin\n";

fn rows(base: f64) -> String {
    let row = |column: i32| {
        let values = [0.0, 0.1, 0.2].map(|row| format!("{:.2}", base + f64::from(column) + row));
        format!("{}\n", values.join("\t"))
    };
    (0..4).map(row).collect()
}

/// Statements, and the table after them.
fn table(stated: &str, base: f64) -> String {
    format!("\n{stated}\nTIS 0.5\n{}", rows(base))
}

fn read(text: &str) -> Result<Document, FormatError> {
    light_tools::read(text.as_bytes(), Path::new("file"))
}

#[track_caller]
fn grid(text: &str) -> lobe_table::spherical::Data {
    let document = read(text).unwrap_or_else(|error| panic!("{error}"));
    match document.parts.into_iter().next().expect("a part").data {
        Data::Spherical(grid) => grid,
        other => panic!("{other:?}"),
    }
}

#[track_caller]
fn refused(text: &str, found: &str) {
    let error = read(text).map(|_| ()).expect_err("a refusal").to_string();
    assert!(error.contains(found), "{error}");
}

fn direction(theta: f64, phi: f64) -> [f64; 3] {
    let (theta, phi) = (theta.to_radians(), phi.to_radians());
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

/// The value at `wi` (polar angle, azimuth) and `wo`, in the first channel.
fn value(grid: &lobe_table::spherical::Data, wi: [f64; 2], wo: [f64; 2]) -> f64 {
    grid.eval(direction(wi[0], wi[1]), direction(wo[0], wo[1]))[0]
}

fn fact<'a>(document: &'a Document, name: &str) -> Option<&'a str> {
    document.source.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str())
}

#[test]
fn unknown_lines_of_the_head_and_of_the_tables_are_facts() {
    let plain = format!("{HEAD}{}{}DataEnd\n", table("AOI 0", 1.0), table("AOI 40", 2.0));
    let head = format!(
        "# from an instrument\nModel #: sample a\nSource\tMeasured\nOperator Ada Lovelace\nDate: 1.2.26\n{HEAD}"
    );
    let stated = table("AOI 40 Side Front\nTemperature 21 C", 2.0);
    let told = format!("{head}Gain: 3\n{}{stated}Temperature 21 C\nDataEnd\n\n", table("AOI 0", 1.0));
    assert_eq!(grid(&plain), grid(&told));
    let document = read(&told).expect("a file");
    for (name, value) in [
        ("comment", "from an instrument"),
        ("Model #", "sample a"),
        ("Source", "Measured"),
        ("Operator", "Ada Lovelace"),
        ("Date", "1.2.26"),
        ("Gain", "3"),
        ("Temperature", "21 C"),
    ] {
        assert_eq!(fact(&document, name), Some(value), "{name} of {:?}", document.source);
    }
    assert_eq!(document.source.iter().filter(|(name, _)| name == "Temperature").count(), 1);
    assert_eq!(document.tis, [0.5, 0.5]);
    // A number is not a word of the head, but one angle or value too many.
    refused(&plain.replace("0 30 60", "0 30 60 80"), "file:6: found `80`");
    refused(&plain.replace("4.20\n", "4.20 7\n"), "found `7`");
}

#[test]
fn wavelengths_are_channels_in_ascending_order() {
    let blocks = [("650 nm", 3.0), ("0.45um", 1.0), ("550", 2.0)];
    let of = |aoi: f64| {
        let of_block = |(nm, base): &(&str, f64)| table(&format!("AOI {aoi}\nWavelength {nm}"), base + aoi);
        blocks.iter().map(of_block).collect::<String>()
    };
    let found = grid(&format!("{HEAD}{}{}DataEnd", of(0.0), of(20.0)));
    assert_eq!(found.channels(), &Channels::Spectral(vec![450.0, 550.0, 650.0]));
    // The light is at azimuth 90 of the file: a viewer next to it is in the second column.
    let at = found.eval(direction(20.0, 0.0), direction(30.0, 0.0));
    for (found, wanted) in at.iter().zip([22.1, 23.1, 24.1]) {
        assert!((found - wanted).abs() < 1e-5, "{at:?}");
    }
    // A single wavelength is not a channel, but a fact.
    let one = format!("{HEAD}{}DataEnd", table("AOI 10\nWavelength 632.8nm", 1.0));
    assert_eq!(grid(&one).channels(), &Channels::Mono);
    assert_eq!(fact(&read(&one).expect("a file"), "Wavelength"), Some("632.8 nm"));
    let with = |other: &str| format!("{HEAD}{}{}DataEnd", table("AOI 0 Wavelength 450", 1.0), table(other, 2.0));
    refused(&with("AOI 0 Wavelength 450"), "a second table of AOI 0, POI 0, 450 nm");
    refused(&with("AOI 30 Wavelength 550"), "AOI 0, POI 0, 550 nm without a table");
    refused(&with("AOI 0 Wavelength 0.55"), "a wavelength of 0.55 nm");
    refused(&format!("{HEAD}{}{}", table("AOI 0", 1.0), table("AOI 0 Wavelength 550", 1.0)), "without a wavelength");
    refused(&with("AOI 0 Wavelength green"), "found `green`");
}

#[test]
fn planes_of_incidence_are_azimuths_of_the_light() {
    let tables: String = [0.0, 120.0, 240.0].map(|poi| table(&format!("AOI 30\nPOI {poi}"), 1.0 + poi)).concat();
    // Perpendicular light has no azimuth: one table is enough.
    let found = grid(&format!("{HEAD}{}{tables}DataEnd", table("AOI 0\nPOI 0", 1.0)));
    assert!(!found.is_isotropic());
    for poi in [0.0, 120.0, 240.0] {
        // Column 0 of the file is at azimuth 0 - 90 of the sample, whatever the light.
        let at = value(&found, [30.0, poi], [60.0, 270.0]);
        assert!((at - (1.0 + poi + 0.2)).abs() < 1e-3, "POI {poi}: {at}");
        assert!((value(&found, [0.0, 0.0], [60.0, poi + 0.0]) - value(&found, [0.0, 90.0], [60.0, poi])).abs() < 1e-6);
    }
    // A single plane is measured like the same plane among others.
    let alone = grid(&format!("{HEAD}{}DataEnd", table("AOI 30\nPOI 120", 121.0)));
    assert!(alone.is_isotropic());
    assert!((value(&alone, [30.0, 120.0], [60.0, 270.0]) - 121.2).abs() < 1e-4);
    let negative = grid(&format!("{HEAD}{}DataEnd", table("AOI 30\nPOI -120", 241.0)));
    assert!((value(&negative, [30.0, 240.0], [60.0, 270.0]) - 241.2).abs() < 1e-4);
    refused(&format!("{HEAD}{tables}{}", table("AOI 50 POI 0", 1.0)), "AOI 50, POI 120 without a table");
    refused(&format!("{HEAD}{tables}DataEnd").replace("Asymmetric", "PlaneSymmetrical"), "3 POI");
    refused(&format!("{HEAD}{}DataEnd", table("AOI 30 POI 400", 1.0)), "POI 400");
    // A whole turn ends as it begins, or contradicts itself.
    let turn = |value: f64| format!("{HEAD}{tables}{}DataEnd", table("AOI 30 POI 360", value));
    assert_eq!(grid(&turn(1.0)).knots()[1].len(), 3);
    refused(&turn(2.0), "a second table of AOI 30, POI 0");
}

#[test]
fn the_end_word_may_be_missing_after_a_whole_table() {
    let whole = format!("{HEAD}{}{}", table("AOI 0", 1.0), table("AOI 40", 2.0));
    assert_eq!(grid(&whole), grid(&format!("{whole}DataEnd\n")));
    assert_eq!(fact(&read(&whole).expect("a file"), "DataEnd"), Some("missing"));
    assert_eq!(fact(&read(&format!("{whole}DataEnd")).expect("a file"), "DataEnd"), None);
    assert_eq!(grid(&whole.replace('\n', "\r\n")), grid(&whole));
    // A number that is cut short is still a number.
    refused(whole.trim_end(), "the end of the file within a line");
    refused(&whole[..whole.len() - 3], "the end of the file");
    refused(&format!("{whole}AOI 60\n"), "the end of the file");
    refused(HEAD, "the end of the file");
    refused(&format!("{whole}DataEnd\n{}", table("AOI 60", 3.0)), "found `AOI`");
    lobe_testing::damage::truncations(format!("{whole}DataEnd").as_bytes(), |bytes| {
        // The first table is a file of its own, if the second one is cut off before anything is stated.
        light_tools::read(bytes, Path::new("file")).is_ok_and(|document| document.tis.len() == 2)
    });
}

#[test]
fn sides_and_kinds_of_scatter_are_parts() {
    let kinds =
        ["Front\nScatterType BRDF", "Back\nScatterType BRDF", "Front\nScatterType BTDF", "Back\nScatterType BTDF"];
    let tables: String = kinds.iter().map(|kind| table(&format!("AOI 10\nSide {kind}"), 1.0)).collect();
    let parts = read(&format!("{HEAD}{tables}")).expect("a file").parts;
    let found: Vec<_> = parts.iter().map(|part| (part.side, part.data.representation().aspects()[0].scatter)).collect();
    let wanted =
        [Side::Front, Side::Back].map(|side| [Scatter::Reflection, Scatter::Transmission].map(|s| (Some(side), s)));
    assert_eq!(found, wanted.concat());
}

#[test]
fn stated_totals_scale_relative_values() {
    let slice = "5 5 5 5 5 5";
    let text = format!(
        "Symmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterAzimuth 3 90 180 270\nScatterRadial 2 0 90\nDataBegin\n\
         AOI 30 POI 0 Side Front Wavelength 550 ScatterType BRDF TIS 0.5\n{slice}\nAOI 0 TIS 0.25\n{slice}\nDataEnd\n"
    );
    let options = ReadOptions { scale: Some(Scale::Tis), ..ReadOptions::default() };
    let document = from_bytes_with(text.as_bytes(), Path::new("relative.bsdf"), &options);
    let document = document.unwrap_or_else(|error| panic!("{error}"));
    let Data::Spherical(grid) = &document.parts[0].data else { panic!("a grid") };
    // The light at 0 comes first in the grid, whatever the order in the file.
    for (theta, total) in [(0.0_f64, 0.25), (30.0, 0.5)] {
        let (sin, cos) = theta.to_radians().sin_cos();
        let found = grid.eval([sin, 0.0, cos], [0.6, 0.0, 0.8])[0];
        assert!((found * PI - total).abs() < 1e-3, "{found} at {theta}");
    }
}
