//! Surface properties of TracePro.

use std::path::Path;

use lobe_formats::{Document, FormatError, tracepro};
use lobe_table::{Channels, Data, Scatter, Side};
use lobe_testing::examples::TRACE_PRO;

const HEAD: &str = "TracePro Surface Property Data\nFile Name\t/a/b.db\nTracePro Release: 7 0 0\n\nName\tmade here\nCatalog\tnone\n\
                    Scatter    5\nSolve\tBRDF\n\n";
const NAMES: &str = "Temperature\tWavelength\tIncAngle\tAziAngle\tScatterBeta\tScatterAzimuth\tBRDF\tBTDF\n";

/// Rows of a table that starts at 1 and falls by 0.1 from abscissa to abscissa, and of a transmission table with half
/// its values.
fn table(nm: f64, base: f64) -> String {
    let mut rows = String::new();
    for theta in [0, 30, 60] {
        for beta in [0.0, 0.1, 0.3, 0.6, 1.0, 1.8] {
            for azimuth in (0..360).step_by(90) {
                let value = base - 0.1 * beta;
                rows += &format!("300\t{}\t{theta}\t0\t{beta}\t{azimuth}\t{value}\t{}\t\n", nm / 1000.0, value / 2.0);
            }
        }
    }
    rows
}

fn file(specular: &str, table: &str) -> String {
    let specular =
        format!("Temperature Wavelength IncAngle AziAngle Abso_S Abso_P Refl_S Refl_P Tran_S Tran_P\n{specular}");
    format!("{HEAD}{specular}Table_BSDF_Data\n{NAMES}{table}")
}

fn read(text: &str) -> Result<Document, FormatError> {
    tracepro::read(text.as_bytes(), Path::new("file"))
}

#[track_caller]
fn refused(text: &str, found: &str) {
    let error = read(text).map(|_| ()).expect_err("a refusal").to_string();
    assert!(error.contains(found), "{error}");
}

/// A direction from its projection onto the surface.
fn projected(x: f64, y: f64) -> [f64; 3] {
    [x, y, (1.0 - x * x - y * y).sqrt()]
}

#[test]
fn values_depend_on_the_distance_of_the_projections() {
    let document = read(&file("", &table(550.0, 0.4))).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(document.parts.len(), 2);
    assert!(document.parts.iter().all(|part| part.side.is_none()));
    for (name, value) in
        [("Name", "made here"), ("TracePro Release", "7 0 0"), ("Scatter", "5"), ("Wavelength", "550 nm")]
    {
        assert!(document.source.contains(&(name.into(), value.into())), "{name}: {:?}", document.source);
    }
    let [Data::Scattered(reflection), Data::Scattered(transmission)] =
        [&document.parts[0].data, &document.parts[1].data]
    else {
        panic!("two sets of samples")
    };
    assert_eq!((reflection.scatter(), transmission.scatter()), (Scatter::Reflection, Scatter::Transmission));
    assert_eq!(reflection.channels(), &Channels::Mono);
    for theta in [0.0_f64, 30.0, 60.0] {
        let sin = theta.to_radians().sin();
        for turn in [0.0_f64, 100.0] {
            // Light at any azimuth: the table does not depend on it.
            let (c, s) = (turn.to_radians().cos(), turn.to_radians().sin());
            let wi = projected(sin * c, sin * s);
            for (beta, angle) in
                [(0.0, 0.0), (0.3, 0.0), (0.3, 90.0), (0.1, 45.0), (0.05, 120.0), (0.45, 60.0), (0.6, 10.0)]
            {
                let angle = f64::to_radians(angle);
                let (x, y) = (-sin + beta * angle.cos(), beta * angle.sin());
                let wo = projected(x * c - y * s, x * s + y * c);
                let wanted = 0.4 - 0.1 * beta;
                let found = f64::from(reflection.eval(wi, wo)[0]);
                assert!((found - wanted).abs() < 4e-4, "{theta} {beta} {angle}: {found}, not {wanted}");
                let through = f64::from(transmission.eval(wi, [wo[0], wo[1], -wo[2]])[0]);
                assert!((through - wanted / 2.0).abs() < 2e-4, "through {theta} {beta}: {through}");
            }
        }
    }
}

#[test]
fn wavelengths_sides_and_mirrors_are_kept() {
    let two = file("", &(table(650.0, 0.5) + &table(450.0, 0.4)));
    let document = read(&two).expect("a property");
    let Data::Scattered(data) = &document.parts[0].data else { panic!("samples") };
    assert_eq!(data.channels(), &Channels::Spectral(vec![450.0, 650.0]));
    let found = data.eval(projected(0.5, 0.0), projected(-0.5, 0.0));
    assert!((found[0] - 0.4).abs() < 1e-6 && (found[1] - 0.5).abs() < 1e-6, "{found:?}");

    let specular = "300 0.55 0 0 0 0 0.1 0.3 0 0\n300 0.55 60 0 0 0 0.5 0.7 0 0\n";
    let document = read(&file(specular, &table(550.0, 0.4))).expect("a property");
    let mirror = document.parts.iter().find_map(|part| part.data.mirror()).expect("a mirror");
    assert_eq!((mirror.values(), mirror.scatter()), ([0.2, 0.6].as_slice(), Scatter::Reflection));
    let document = read(&file(specular, &table(600.0, 0.4))).expect("a property");
    assert!(document.source.iter().any(|(name, value)| name == "specular reflectance" && value.contains("not read")));

    let side = |number: i32| {
        format!("Side{number}_Data\nTemperature Wavelength\nTable_BSDF_Data\n{NAMES}{}", table(550.0, 0.4))
    };
    let parts = read(&format!("{HEAD}{}{}SAVE-DATA\n", side(1), side(2))).expect("two sides").parts;
    let sides: Vec<_> = parts.iter().map(|part| part.side).collect();
    assert_eq!(sides, [Side::Front, Side::Front, Side::Back, Side::Back].map(Some));
    refused(&format!("{HEAD}{}{}", side(1), side(1)), "Side1_Data");
}

#[test]
fn ambiguous_properties_are_refused() {
    let whole = file("", &table(550.0, 0.4));
    refused(&whole.replacen("0.1\t90\t0.39\t", "0.1\t90\t0.38\t", 1), "depends on ScatterAzimuth");
    refused(&whole.replacen("300\t0.55\t30", "310\t0.55\t30", 1), "a second temperature, 310 K");
    refused(&whole.replace("ScatterBeta", "ScatterTheta"), "ScatterTheta");
    refused(&whole.replacen("\t0.1\t90\t", "\t2.1\t90\t", 1), "ScatterBeta 2.1");
    refused(&format!("{whole}{}", table(600.0, 0.4).lines().next().expect("a row")), "without");
    refused(&format!("{whole}SAVE-DATA\n{whole}"), "one property per file");
    refused(&whole.replace("Table_BSDF_Data", "GratingData"), "a grating");
    refused(
        &format!("{HEAD}Temperature Wavelength IncAngle BRDF_A\n300 0.55 0 0.1\nSAVE-DATA"),
        "without a table of scatter",
    );
    refused(&whole.replacen("300\t0.55\t0\t0\t0\t0\t", "300\t0.55\tx\t0\t0\t0\t", 1), "found \"x\"");
    refused(&file("300 0.55 0 0 0 0 0.1\n", &table(550.0, 0.4)), "7 numbers");
    let one = file("300 0.55 0 0 0 0 0.1 0 0\n", &table(550.0, 0.4)).replace("Refl_S Refl_P", "Refl_S");
    refused(&one, "only one of refl_s and refl_p");
    lobe_testing::damage::truncations(TRACE_PRO.as_bytes(), |bytes| read(&String::from_utf8_lossy(bytes)).is_ok());
}
