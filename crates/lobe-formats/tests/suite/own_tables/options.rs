//! Options for what files leave open: sidecars, options that do not apply, totals.

use std::f64::consts::PI;
use std::path::Path;

use lobe_formats::reading::{Quantity, ReadOptions};
use lobe_formats::{Place, from_bytes, from_bytes_with, open, open_with, sidecar};
use lobe_table::Data;

use super::*;

#[test]
fn a_sidecar_is_read_with_its_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scan.txt");
    std::fs::write(&file, rows(|i, o, [a, ..]| format!("{i};{o};{}", (PI * a).to_string().replace('.', ","))))
        .expect("a file");
    assert!(open(&file).is_err());
    let said = options(&[
        ("columns", "theta_i=1,theta_o=2,f=3"),
        ("values", "luminance-factor"),
        ("scale", "1"),
        ("unit", "deg"),
    ]);
    let text = sidecar::to_text(&said, "scan.txt");
    assert_eq!(sidecar::parse(&text, path()), Ok(said));
    std::fs::write(folder.path().join("scan.txt.lobe.toml"), &text).expect("a sidecar");
    is_the_measurement(&open(&file).unwrap_or_else(|error| panic!("{error}")).1, 1, "sidecar");
    // Given options take precedence over it.
    let other = ReadOptions { values: Some(Quantity::F), ..ReadOptions::default() };
    let found = open_with(&file, &other).unwrap_or_else(|error| panic!("{error}")).1;
    assert!(
        (eval(found.only().expect("data"), direction(30.0, 0.0), direction(30.0, 180.0))[0]
            - 0.35 * std::f32::consts::PI)
            .abs()
            < 1e-5
    );
    let odd = r#"columns = "f=\"5\",theta_i=\"a\u0001b=c\",theta_o=-1.5e-3rad""#;
    let odd = sidecar::parse(odd, path()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(sidecar::parse(&sidecar::to_text(&odd, "a\nb"), path()), Ok(odd));
    let by_table =
        "columns = { theta_i = 1, theta_o = 2, f = 3 }\nin_plane = 'same-sign'\nscale = 2\ndecimal-comma = true\n";
    let parsed = sidecar::parse(by_table, path()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(parsed.columns.len(), 3);
    assert_eq!((parsed.decimal_comma, parsed.scale.map(|scale| scale.to_string())), (Some(true), Some("2".into())));
    for (bad, line, found) in [
        ("unit = \"deg\"\ncolour = 1\n", 2, "colour"),
        ("\nscale = -1\n", 2, "-1"),
        ("values = \"g\"\n", 1, "\"g\""),
        ("unit = [1]\n", 1, "unit"),
        ("unit \n", 1, ""),
        ("decimal-comma = \"maybe\"\n", 1, "maybe"),
    ] {
        let error = sidecar::parse(bad, Path::new("x.lobe.toml")).expect_err("a refusal");
        assert!(error.place == Place::Line(line) && error.found.contains(found), "{error}");
    }
}

#[test]
fn options_that_do_not_apply_are_refused() {
    let zemax = lobe_testing::examples::ZEMAX;
    for words in [
        ("columns", "theta_i=1"),
        ("unit", "deg"),
        ("holds", "reflection"),
        ("in-plane", "same-sign"),
        ("decimal-comma", "true"),
    ] {
        refused(zemax, &[words], "Zemax", "values and scale");
    }
}

#[test]
fn stated_totals_scale_relative_values() {
    let relative = |values: &str| {
        format!(
            "Source Measured\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterType BRDF\nSampleRotation 1\n0\n\
             AngleOfIncidence 2\n0 45\nScatterAzimuth 2\n0 180\nScatterRadial 3\n0 90 180\n\nMonochrome\nDataBegin\n\
             TIS 0.5\n{values}\n{values}\nTIS 0.25\n{values}\n{values}\nDataEnd\n"
        )
    };
    let found = |text: &str, words: &[(&str, &str)]| {
        let document = read(text.as_bytes(), words);
        let Some(Data::Specular(samples)) = document.only() else { panic!("a table") };
        [0, 1].map(|sigma| f64::from(samples.texel([sigma, 0, 0, 0])[0]))
    };
    let scaled = found(&relative("7 7 7"), &[("scale", "tis")]);
    assert!((scaled[0] * PI - 0.5).abs() < 1e-4 && (scaled[1] * PI - 0.25).abs() < 1e-4, "{scaled:?}");
    assert_eq!(found(&relative("7 7 7"), &[]), [7.0, 7.0]);
    assert_eq!(found(&relative("7 7 7"), &[("scale", "0.5")]), [3.5, 3.5]);
    refused(&relative("0 0 0"), &[("scale", "tis")], "reflectance of 0", "total integrated scatter 0.5");
    let cosine = found(&relative("1 0 0"), &[("values", "f-cos")]);
    assert!((cosine[0] - 1.0).abs() < 1e-6 && (cosine[1] - 2_f64.sqrt()).abs() < 1e-6, "{cosine:?}");
    let white = found(&relative("1 1 1"), &[("values", "luminance-factor")]);
    assert!((white[0] - 1.0 / PI).abs() < 1e-6, "{white:?}");
}

#[test]
fn truncated_tables_are_read_or_refused() {
    for text in [
        table(HEAD, ";").replace('.', ","),
        format!("Angle of incidence: 10 deg\n{}", in_plane("theta_i,theta_o,R,G,B")),
        in_plane("theta_o,theta_i,wavelength,f,x"),
    ] {
        for end in 0..text.len().min(700) {
            let _ = from_bytes(&text.as_bytes()[..end], path());
            let columns = options(&[("columns", "theta_i=1,theta_o=2,f=4")]);
            let _ = from_bytes_with(&text.as_bytes()[..end], path(), &columns);
        }
    }
}
