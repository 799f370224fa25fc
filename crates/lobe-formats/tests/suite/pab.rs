//! Files of pab gonio-photometers, single and in folders.

use std::path::{Path, PathBuf};

use lobe_formats::{Document, Format, FormatError, open, pab};
use lobe_table::{Channels, Data, Scatter, Side, scattered};
use lobe_testing::examples::{PAB, RPC};

fn direction(theta: f64, phi: f64) -> [f64; 3] {
    let (theta, phi) = (theta.to_radians(), phi.to_radians());
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

/// A lobe about the mirror direction and a constant floor; half as much is transmitted straight through.
fn f(theta_i: f64, theta: f64, phi: f64) -> f64 {
    let (wi, wo) = (direction(theta_i, 0.0), direction(theta, phi));
    let (lobe, share) = if wo[2] > 0.0 { ([-wi[0], -wi[1], wi[2]], 1.0) } else { (wi.map(|c| -c), 0.5) };
    let cos: f64 = lobe.iter().zip(wo).map(|(a, b)| a * b).sum();
    let angle = cos.clamp(-1.0, 1.0).acos().to_degrees();
    share * (0.1 + (-(angle / 20.0).powi(2)).exp())
}

/// A file with light at `theta_i`, over the polar angles `thetas`.
fn made(theta_i: f64, quantity: &str, thetas: std::ops::RangeInclusive<i32>) -> String {
    let mut text =
        format!("#pgII\n#sample_name\t\"made\"\n#incident_angle\t{theta_i}\t0\n#format: theta\tphi\t{quantity}\n");
    for theta in thetas.step_by(5).map(f64::from) {
        for phi in (0..360).step_by(10).map(f64::from) {
            let scale = if quantity == "DSF" { theta.to_radians().cos().abs() } else { 1.0 };
            text += &format!("{theta}\t{phi}\t{:e}\n", scale * f(theta_i, theta, phi));
        }
    }
    text
}

fn read(text: &str) -> Result<Document, FormatError> {
    pab::read(text.as_bytes(), Path::new("file"))
}

#[track_caller]
fn scattered_of(document: &Document, part: usize) -> &scattered::Data {
    match &document.parts[part].data {
        Data::Scattered(data) => data,
        other => panic!("{other:?}"),
    }
}

#[track_caller]
fn refused(text: &str, found: &str) {
    let error = read(text).map(|_| ()).expect_err("a refusal").to_string();
    assert!(error.contains(found), "{error}");
}

#[test]
fn folders_are_one_material_for_any_quantity() {
    for quantity in ["BSDF", "brdf", "DSF"] {
        let folder = tempfile::tempdir().expect("a folder");
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
        for theta_i in [0.0, 20.0, 40.0] {
            write(&format!("r{theta_i}.txt"), &made(theta_i, quantity, 0..=85));
            write(&format!("t{theta_i}.dat"), &made(theta_i, quantity, 95..=180));
        }
        write("readme.md", "measured in March");
        write("notes.csv", "a,b\n1,2\n");
        let (format, document) = open(folder.path()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((format, document.format), (Format::Pab, Some("pab gonio-photometer")));
        assert_eq!(document.parts.len(), 2);
        assert!(document.source.contains(&("sample_name".into(), "made".into())), "{:?}", document.source);
        for (part, scatter) in [Scatter::Reflection, Scatter::Transmission].into_iter().enumerate() {
            let data = scattered_of(&document, part);
            assert_eq!((document.parts[part].side, data.scatter()), (None, scatter));
            for (theta_i, theta, phi) in [(20.0, 20.0, 180.0), (40.0, 60.0, 90.0), (0.0, 0.0, 0.0), (20.0, 70.0, 200.0)]
            {
                let theta = if scatter == Scatter::Reflection { theta } else { 180.0 - theta };
                let found = f64::from(data.eval(direction(theta_i, 0.0), direction(theta, phi))[0]);
                let wanted = f(theta_i, theta, phi);
                assert!(
                    (found - wanted).abs() < 2e-6,
                    "{quantity} {scatter:?} {theta_i} {theta} {phi}: {found}, {wanted}"
                );
            }
        }
        // The same light twice: another sample, or a repetition.
        write("r20 again.txt", &made(20.0, quantity, 0..=85).replace("made", "other"));
        let error = open(folder.path()).map(|_| ()).expect_err("two samples").to_string();
        assert!(error.contains("light at 20, 0 degrees, as in ") && error.contains("r20"), "{error}");
        std::fs::remove_file(folder.path().join("r20 again.txt")).expect("a file");
        write("diffuser.txt", RPC);
        let error = open(folder.path()).map(|_| ()).expect_err("two formats").to_string();
        assert!(error.contains("files of RPC Photonics and of pab gonio-photometer"), "{error}");
    }
    let empty = tempfile::tempdir().expect("a folder");
    let error = open(empty.path()).map(|_| ()).expect_err("nothing").to_string();
    assert!(error.contains("without measurements; expected files of one incident direction each (RPC"), "{error}");
    assert!(error.contains("RPC Photonics or pab") && !error.contains("joined"), "{error}");
    std::fs::write(empty.path().join("30.csv"), "AOI: 30 deg\ntheta_o,phi_o,BRDF\n0,0,1\n10,0,1\n").expect("a file");
    let error = open(empty.path()).map(|_| ()).expect_err("tables").to_string();
    for part in
        ["other formats (table with named columns)", "by its own name", "joined into one table, with a column theta_i"]
    {
        assert!(error.contains(part), "{part}: {error}");
    }
}

#[test]
fn light_on_the_back_makes_the_sides_distinct() {
    let front = (PathBuf::from("front"), made(30.0, "BSDF", 0..=85).into_bytes());
    let back = (PathBuf::from("back"), made(150.0, "BSDF", 95..=180).into_bytes());
    let through = (PathBuf::from("through"), made(150.0, "BTDF", 0..=85).into_bytes());
    let parts = pab::read_set(&[front, back, through]).expect("a sheet").parts;
    let found: Vec<_> = parts.iter().map(|part| (part.side, part.data.representation().aspects()[0].scatter)).collect();
    let (reflection, transmission) = (Scatter::Reflection, Scatter::Transmission);
    let back = Some(Side::Back);
    assert_eq!(found, [(Some(Side::Front), reflection), (back, reflection), (back, transmission)]);
    // Negative angles are in the other half of the plane.
    let half = read(&made(30.0, "BSDF", -85..=0)).expect("a file");
    assert_eq!(scattered_of(&half, 0).scatter(), reflection);
    let found = f64::from(scattered_of(&half, 0).eval(direction(30.0, 0.0), direction(30.0, 180.0))[0]);
    assert!((found - f(30.0, -30.0, 0.0)).abs() < 1e-6, "{found}");
}

#[test]
fn heads_may_be_written_in_many_ways() {
    let plain = made(30.0, "BSDF", 0..=85);
    let eval = |text: &str| {
        let document = read(text).unwrap_or_else(|error| panic!("{error}"));
        f64::from(scattered_of(&document, 0).eval(direction(30.0, 0.0), direction(40.0, 130.0))[0])
    };
    let wanted = eval(&plain);
    for (from, to) in [
        ("#incident_angle\t30\t0\n", "#intheta 30\n#inphi 0\n"),
        ("#incident_angle\t30\t0\n", "#intheta\t30\n"),
        ("#incident_angle\t30\t0\n", "# incident_angle: 30 0\n"),
        ("#format: theta\tphi\t", "#Format: THETA PHI "),
        ("#pgII\n", "#pgII\n\n#colorimetry: CIE-Y\n"),
        ("#pgII\n", "\u{feff}#pgII\r\n"),
    ] {
        let text = plain.replace(from, to);
        assert!(text != plain && pab::matches(text.as_bytes()), "{to}");
        assert_eq!(eval(&text), wanted, "{to}");
    }
    // The upward direction of the sample is at 90 degrees, here for light from that direction.
    let turned = plain.replace("#pgII\n", "#upphi 0\n");
    let document = read(&turned).expect("a file");
    assert_eq!(scattered_of(&document, 0).incidences().next().map(|[_, phi]| phi.to_degrees().round()), Some(90.0));
    let colours = "#intheta 0\n#colorimetry: CIE-XYZ\n#format: theta phi BSDF\n0 0 1 2 3\n10 0 1 2 3\n10 90 1 2 3\n";
    let document = read(colours).expect("colours");
    assert_eq!(scattered_of(&document, 0).channels(), &Channels::Xyz);
    refused(&colours.replace("10 0 1 2 3", "10 0 1 2"), "2 values after theta and phi; expected 3");
    refused(&plain.replace("\tBSDF", "\t[uA]"), "values of \"[uA]\"");
    refused(&plain.replace("\tBSDF", ""), "values of \"\"");
    refused(&plain.replace("#incident_angle", "#angle"), "no incident direction");
    refused(&plain.replace("#pgII", "#datapoints_in_file 9999"), "648 lines of values; the head states 9999");
    refused(&plain.replace("#pgII", "#colorimetry: RGB"), "colorimetry");
    refused(&plain.replace("#pgII", "#intheta 50"), "after 50 in a line above");
    refused(&plain.replace("\t30\t0", "\t230\t0"), "230");
    lobe_testing::damage::truncations(PAB.as_bytes(), |bytes| read(&String::from_utf8_lossy(bytes)).is_ok());
}
