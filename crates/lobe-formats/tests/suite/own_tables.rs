//! People's own tables: each spelling of one measurement is read as that measurement, or refused with a way to say it.

use std::f64::consts::PI;
use std::path::Path;

use lobe_formats::reading::{Quantity, ReadOptions, parse_columns};
use lobe_formats::{Document, Format, Place, from_bytes, from_bytes_with, open, open_with, sidecar, sniff};
use lobe_table::{Channels, Data, Scatter};

const THETA_I: [f64; 3] = [10.0, 30.0, 50.0];
const BASE: [f64; 3] = [0.25, 0.3, 0.35];

/// Polar angles of the viewer.
fn thetas() -> impl Iterator<Item = f64> {
    (-13..=13).map(|step| 6.0 * f64::from(step))
}

/// What was measured: a lobe about the mirror direction, at positive angles.
fn f(theta_i: f64, theta_o: f64, channel: usize) -> f64 {
    let value = BASE[channel] + 0.1 * (-((theta_o - theta_i) / 12.0).powi(2)).exp();
    (value * 1e4).round() / 1e4
}

/// A line per pair of directions, made of its angles and its three values.
fn rows(row: impl Fn(f64, f64, [f64; 3]) -> String) -> String {
    let pairs = THETA_I.iter().flat_map(|&theta_i| thetas().map(move |theta_o| (theta_i, theta_o)));
    pairs.map(|(i, o)| row(i, o, [0, 1, 2].map(|channel| f(i, o, channel))) + "\n").collect()
}

fn table(head: &str, delimiter: &str) -> String {
    let row = |i: f64, o: f64, [a, b, c]: [f64; 3]| [i, o, 180.0, a, b, c].map(|x| x.to_string()).join(delimiter);
    format!("{}\n{}", head.replace(',', delimiter), rows(row))
}

const HEAD: &str = "theta_i,theta_o,phi_o,450nm,550nm,650nm";

fn in_plane(head: &str) -> String {
    format!("{head}\n{}", rows(|i, o, [a, b, c]| format!("{i},{o},{a},{b},{c}")))
}

fn path() -> &'static Path {
    Path::new("scan.csv")
}

fn options(words: &[(&str, &str)]) -> ReadOptions {
    let mut options = ReadOptions::default();
    words.iter().for_each(|(key, word)| sidecar::set(&mut options, key, word).expect("an option"));
    options
}

#[track_caller]
fn read(bytes: &[u8], words: &[(&str, &str)]) -> Document {
    from_bytes_with(bytes, path(), &options(words)).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn refused(text: &str, words: &[(&str, &str)], found: &str, expected: &str) {
    let error = from_bytes_with(text.as_bytes(), path(), &options(words)).expect_err("a refusal");
    assert!(error.found.contains(found) && error.expected.contains(expected), "{error}");
}

fn direction(theta: f64, phi: f64) -> [f64; 3] {
    let (theta, phi) = (theta.to_radians(), phi.to_radians());
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

fn eval(data: &Data, wi: [f64; 3], wo: [f64; 3]) -> Vec<f32> {
    match data {
        Data::Scattered(data) => data.eval(wi, wo),
        Data::Spherical(data) => data.eval(wi, wo).into_iter().map(|value| value as f32).collect(),
        other => panic!("{other:?}"),
    }
}

/// Compares a document with the measurement at every sample.
#[track_caller]
fn is_the_measurement(document: &Document, channels: usize, name: &str) {
    let data = document.only().unwrap_or_else(|| panic!("{name}: one measurement"));
    assert_eq!(data.representation().scatter(), Scatter::Reflection, "{name}");
    for theta_i in THETA_I {
        for theta_o in thetas() {
            let found = eval(data, direction(theta_i, 0.0), direction(theta_o, 180.0));
            assert_eq!(found.len(), channels, "{name}");
            for (channel, found) in found.iter().enumerate() {
                let wanted = f(theta_i, theta_o, channel);
                assert!(
                    (f64::from(*found) - wanted).abs() < 1e-5,
                    "{name}: {found}, not {wanted} at {theta_i}, {theta_o}"
                );
            }
        }
    }
}

#[test]
fn delimiters_and_decimals() {
    let comma = |text: String| text.replace('.', ",");
    let quoted = rows(|i, o, values| {
        let values = values.map(|value| format!("\"{value}\"").replace('.', ","));
        format!("{i},{o},180,{}", values.join(","))
    });
    let aligned = rows(|i, o, [a, b, c]| format!("{i:>8}{o:>8}     180{a:>10}{b:>10}{c:>10}"));
    let trailing = table(HEAD, ",").replace('\n', ",\n");
    let in_quotes = table(&HEAD.split(',').map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(","), ",");
    let texts = [
        ("commas", table(HEAD, ",")),
        ("commas and blanks", table(HEAD, ", ")),
        ("semicolons", table(HEAD, ";")),
        ("tabs", table(HEAD, "\t")),
        ("bars", table(HEAD, "|")),
        ("one blank", table(HEAD, " ")),
        ("two blanks", table(HEAD, "  ")),
        ("aligned", format!(" theta_i theta_o   phi_o     450nm     550nm     650nm\n{aligned}")),
        (
            "aligned, units apart",
            format!("theta_i [deg]  theta_o [deg]  phi_o [deg]  450 nm  550 nm  650 nm\n{aligned}"),
        ),
        (
            "aligned, one blank before units",
            format!("theta_i (deg) theta_o (deg) phi_o (deg) 450nm 550nm 650nm\n{aligned}"),
        ),
        ("semicolons, decimal comma", comma(table(HEAD, ";"))),
        ("tabs, decimal comma", comma(table(HEAD, "\t"))),
        ("blanks, decimal comma", comma(table(&HEAD.replace(',', "  "), "  "))),
        ("quoted decimal commas", format!("{HEAD}\n{quoted}")),
        ("trailing delimiters", trailing.clone()),
        ("trailing delimiters in rows only", trailing.replacen("650nm,", "650nm", 1)),
        ("two trailing delimiters", trailing.replace('\n', ",\n")),
        ("quoted names", in_quotes),
        ("blank lines and an end of file", table(HEAD, ";").replace("\n30;-78", "\n\n;;;;;\n30;-78") + "\n\n\u{1a}"),
        ("minus signs", table(HEAD, ",").replace("-78", "\u{2212}78")),
        ("signs of degrees", table(HEAD, ",").replace(",180,", "°,180°,")),
        ("exponents of Fortran", table(HEAD, ",").replace(",180,", ",1.8D+02,")),
    ];
    for (name, text) in texts {
        assert_eq!(sniff(text.as_bytes()), Some(Format::Goniometer), "{name}");
        is_the_measurement(&read(text.as_bytes(), &[]), 3, name);
    }
}

#[test]
fn encodings_and_ends_of_lines() {
    let text = table(HEAD, "\t");
    let units: Vec<u16> = text.encode_utf16().collect();
    let of = |bytes: fn(u16) -> [u8; 2]| units.iter().flat_map(|&unit| bytes(unit)).collect::<Vec<u8>>();
    let marked = |mark: &[u8], bytes: Vec<u8>| [mark, &bytes].concat();
    let texts = [
        ("UTF-8 with a mark", marked(b"\xef\xbb\xbf", text.clone().into_bytes())),
        ("UTF-16 LE", marked(b"\xff\xfe", of(u16::to_le_bytes))),
        ("UTF-16 BE", marked(b"\xfe\xff", of(u16::to_be_bytes))),
        ("UTF-16 LE without a mark", of(u16::to_le_bytes)),
        ("UTF-16 BE without a mark", of(u16::to_be_bytes)),
        ("CRLF", text.replace('\n', "\r\n").into_bytes()),
        ("CR", text.replace('\n', "\r").into_bytes()),
        ("Latin-1", [&b"Gr\xf6\xdfe\t45\xb0\n"[..], text.as_bytes()].concat()),
    ];
    for (name, bytes) in texts {
        assert_eq!(sniff(&bytes), Some(Format::Goniometer), "{name}");
        is_the_measurement(&read(&bytes, &[]), 3, name);
    }
    // A spreadsheet in German.
    let german =
        table("Einfallswinkel [Grad],Streuwinkel [Grad],Azimut [Grad],450 nm,550 nm,650 nm", ";").replace('.', ",");
    let units: Vec<u8> = german.replace('\n', "\r\n").encode_utf16().flat_map(u16::to_le_bytes).collect();
    is_the_measurement(&read(&[&b"\xff\xfe"[..], &units[..]].concat(), &[]), 3, "German");
}

#[test]
fn names_of_angles_and_values() {
    for head in [
        "theta_i,theta_r,phi_r",
        "theta_i,theta_s,phi_s",
        "theta_in,theta_out,phi_out",
        "theta-in,theta-out,phi-out",
        "thetaI,thetaO,phiO",
        "thetai,thetar,phir",
        "ThetaIn,ThetaOut,PhiOut",
        "theta_i [deg],theta_o [deg],phi_o [deg]",
        "theta_i (deg),theta_o (deg),phi_o (deg)",
        "theta_i/deg,theta_o/deg,phi_o/deg",
        "theta_i_deg,theta_o_deg,phi_o_deg",
        "theta_i (in degrees),theta_o,phi_o",
        "θi,θr,φr",
        "θ_i [°],θ_s [°],φ_s [°]",
        "Incident angle,Measure angle,Azimuth",
        "Incident_angle,Scatter angle,Scatter azimuth",
        "AOI,Viewing angle,Azimuth angle",
        "Angle of incidence,Angle of reflection,Azimuth",
        "Incidence Angle,Detector Angle,Detector Azimuth",
        "incidence,view zenith,relative azimuth",
        "sza,vza,raa",
        "theta_s,theta_v,dphi",
        "theta_l,theta_v,phi_v",
        "source zenith,sensor zenith,phi_rel",
        "zenith_in,zenith_out,azimuth_out",
        "theta_i,theta,phi",
        "th_i,th_o,az_o",
    ] {
        let text = table(&format!("{head},450nm,550nm,650nm"), ",");
        is_the_measurement(&read(text.as_bytes(), &[]), 3, head);
    }
    for (values, channels) in [
        ("R,G,B", Channels::Rgb),
        ("red,green,blue", Channels::Rgb),
        ("BRDF_R,BRDF_G,BRDF_B", Channels::Rgb),
        ("X,Y,Z", Channels::Xyz),
        ("450,550,650", Channels::Spectral(vec![450.0, 550.0, 650.0])),
        (" 450 nm , 550 nm , 650 nm ", Channels::Spectral(vec![450.0, 550.0, 650.0])),
        ("BRDF_450nm,BRDF_550nm,BRDF_650nm", Channels::Spectral(vec![450.0, 550.0, 650.0])),
        ("f(450 nm),f(550 nm),f(650 nm)", Channels::Spectral(vec![450.0, 550.0, 650.0])),
        ("0.45um,0.55 um,0.65 [µm]", Channels::Spectral(vec![450.0, 550.0, 650.0])),
    ] {
        let document = read(table(&format!("theta_i,theta_o,phi_o,{values}"), ",").as_bytes(), &[]);
        assert_eq!(document.only().expect("data").representation().channels(), channels, "{values}");
        is_the_measurement(&document, 3, values);
    }
    let many: Vec<String> = (0..9).map(|step| (400 + 50 * step).to_string()).collect();
    let spectrum = format!(
        "theta_i,theta_o,{}\n{}",
        many.join(","),
        rows(|i, o, [a, ..]| format!("{i},{o}{}", format!(",{a}").repeat(9)))
    );
    assert_eq!(read(spectrum.as_bytes(), &[]).only().expect("data").representation().channels().count(), 9);
    refused(&in_plane("theta_i,theta_o,0.45,0.55,0.65"), &[], "0.45", "550nm");
    for value in ["f", "f_r", "BRDF", "BRDF [1/sr]", "BRDF (sr^-1)", "fr", "Y", "measured", "rho"] {
        let text = format!(
            "theta_i,theta_o,{value},std,comment\n{}",
            rows(|i, o, [a, ..]| format!("{i},{o},{a},{},x", a / 10.0))
        );
        let document = read(text.as_bytes(), &[]);
        assert_eq!(document.only().expect("data").representation().channels(), Channels::Mono, "{value}");
        is_the_measurement(&document, 1, value);
        assert!(document.notes.iter().any(|note| note == "not read: \"std\", \"comment\""), "{:?}", document.notes);
    }
}

#[test]
fn lines_around_the_rows() {
    let plain = table(HEAD, ",");
    let body = plain.split_once('\n').expect("lines").1;
    let texts = [
        ("metadata", format!("Instrument,goniometer X\nSample name,blue tile\nDate,2026-01-05\n\n{plain}")),
        ("metadata with colons", format!("Sample Name:\ntile 7\n\noperator: nobody\nscan 1 2 3\n{plain}")),
        ("comments", format!("# a comment\n% another\n// a third\n! one more\n{plain}")),
        ("names in a comment", format!("# a measurement of mine\n# {HEAD}\n{body}")),
        ("units below the names", plain.replacen('\n', "\ndeg,deg,deg,1/sr,1/sr,1/sr\n", 1)),
        ("a ruler below the names", plain.replacen('\n', "\n------\n", 1)),
        ("lines after the rows", format!("{plain}\nend of data\nsigned: nobody\n")),
        ("names repeated", plain.replace("30,-78", &format!("{HEAD}\n30,-78"))),
        ("a quote mark in metadata", format!("Sample,5\" tile\n{plain}")),
        ("angles of something else", format!("Tilt of the sample: 0\nScan angle range,-78,78\n{plain}")),
    ];
    for (name, text) in texts {
        is_the_measurement(&read(text.as_bytes(), &[]), 3, name);
    }
    let document = read(format!("Instrument,goniometer X\nSample name: blue, matt\n{plain}").as_bytes(), &[]);
    assert_eq!(document.source[0], ("Instrument".into(), "goniometer X".into()));
    // An angle in a line of its own holds until the next.
    let blocks: String = THETA_I
        .iter()
        .map(|i| {
            let rows: String = thetas().map(|o| format!("{o}\t{}\n", f(*i, o, 0))).collect();
            format!("Angle of incidence: {i} deg\ntheta_o\tBRDF\n{rows}")
        })
        .collect();
    is_the_measurement(&read(blocks.as_bytes(), &[]), 1, "blocks");
}

#[test]
fn the_plane_of_incidence() {
    is_the_measurement(
        &read(in_plane("Incident_angle,Measure_angle, 450nm , 550nm , 650nm ").as_bytes(), &[]),
        3,
        "in plane",
    );
    let mirrored = format!("theta_i,theta_o,f\n{}", rows(|i, o, [a, ..]| format!("{i},{},{a}", -o)));
    is_the_measurement(&read(mirrored.as_bytes(), &[("in-plane", "opposite-sign")]), 1, "opposite sign");
    let doubts = read(mirrored.as_bytes(), &[]).doubts;
    assert!(doubts.len() == 1 && doubts[0].contains("in-plane opposite-sign"), "{doubts:?}");
    assert!(read(in_plane("theta_i,theta_o,R,G,B").as_bytes(), &[]).doubts.is_empty());
    let other_side = format!("theta_i,theta_o,f\n{}", rows(|i, o, [a, ..]| format!("{},{o},{a}", -i)));
    is_the_measurement_turned(&read(other_side.as_bytes(), &[]), "light at negative angles");
    let both = other_side.replace("-30,", "30,");
    refused(&both, &[], "both signs", "opposite-sign");
    let from_mirror = table(HEAD, ",").replace(",180,", ",0,");
    is_the_measurement(&read(from_mirror.as_bytes(), &[("azimuth-from", "mirror")]), 3, "azimuths from the mirror");
    assert!(read(from_mirror.as_bytes(), &[]).doubts[0].contains("azimuth-from mirror"));
    refused(&table(HEAD, ","), &[("in-plane", "same-sign")], "azimuths", "one of them");
    refused(&in_plane("theta_i,theta_o,R,G,B"), &[("azimuth-from", "light")], "azimuth", "phi_o");
}

/// The same with the light on the other side of the normal.
fn is_the_measurement_turned(document: &Document, name: &str) {
    let data = document.only().expect("one measurement");
    for theta_o in thetas() {
        let found = eval(data, direction(30.0, 180.0), direction(theta_o, 0.0))[0];
        assert!((f64::from(found) - f(30.0, theta_o, 0)).abs() < 1e-5, "{name}: {found} at {theta_o}");
    }
}

#[test]
fn degrees_and_radians() {
    let radians = |digits: usize| {
        rows(|i, o, [a, b, c]| {
            format!("{:.digits$},{:.digits$},3.14159265,{a},{b},{c}", i.to_radians(), o.to_radians())
        })
    };
    for head in [
        "theta_i_rad,theta_o_rad,phi_o_rad",
        "theta_i [rad],theta_o [rad],phi_o [rad]",
        "theta_i (radians),theta_o,phi_o",
    ] {
        let text = format!("{head},R,G,B\n{}", radians(9));
        is_the_measurement(&read(text.as_bytes(), &[]), 3, head);
    }
    let text = format!("theta_i,theta_o,phi_o,R,G,B\n{}", radians(9));
    let document = read(text.as_bytes(), &[]);
    is_the_measurement(&document, 3, "guessed");
    assert!(document.notes.iter().any(|note| note.starts_with("angles in rad")), "{:?}", document.notes);
    is_the_measurement(&read(text.as_bytes(), &[("unit", "rad")]), 3, "said");
    is_the_measurement(&read(format!("Angle unit: rad\n{text}").as_bytes(), &[]), 3, "stated above");
    let row_of_units = format!("theta_i,theta_o,phi_o,R,G,B\n[rad],[rad],[rad],1/sr,1/sr,1/sr\n{}", radians(9));
    is_the_measurement(&read(row_of_units.as_bytes(), &[]), 3, "units in a row");
    refused("theta_i,theta_o,f\n0.5,0.5,1\n0.5,1,2\n0.5,1.5,3\n", &[], "degrees or radians", "--unit rad");
    refused(&table("theta_i_deg,theta_o_deg,phi_o_deg,R,G,B", ","), &[("unit", "rad")], "says deg", "rad");
}

#[test]
fn cells_without_a_value() {
    for word in ["nan", "NaN", "", "-", "N/A", "#NV", "null", "-1.#IND"] {
        let text = table(HEAD, ",").replacen("0.25,", &format!("{word},"), 3);
        let document = read(text.as_bytes(), &[]);
        let left_out = document.notes.iter().find(|note| note.contains("left out")).expect("a note");
        assert!(left_out.starts_with("3 of 81"), "{left_out}");
        let data = document.only().expect("data");
        let found = eval(data, direction(30.0, 0.0), direction(30.0, 180.0));
        assert!((f64::from(found[0]) - 0.35).abs() < 1e-5, "{found:?}");
    }
    refused(&table(HEAD, ",").replacen("-72", "", 1), &[], "no theta_o", "an angle");
    refused("theta_i,theta_o,f\n10,20,nan\n10,30,nan\n", &[], "empty cells", "a row");
}

#[test]
fn wide_and_long_tables() {
    let wide = |corner: &str, name: &dyn Fn(f64) -> String| {
        let head: Vec<String> = THETA_I.iter().map(|i| name(*i)).collect();
        let rows: String =
            thetas().map(|o| format!("{o};{}\n", THETA_I.map(|i| f(i, o, 0).to_string()).join(";"))).collect();
        format!("{corner};{}\n{rows}", head.join(";"))
    };
    for (name, text) in [
        ("numbers", wide("theta_o", &|i| i.to_string())),
        ("degrees", wide("Viewing angle [deg]", &|i| format!("{i}°"))),
        ("a corner", wide("theta_o \\ theta_i", &|i| format!("{i} deg"))),
        ("names with numbers", wide("theta_r", &|i| format!("theta_i={i}"))),
        ("AOI", wide("Scatter angle", &|i| format!("AOI {i}"))),
        ("decimal comma", wide("theta_o", &|i| i.to_string()).replace('.', ",")),
    ] {
        is_the_measurement(&read(text.as_bytes(), &[]), 1, name);
    }
    let nm = [450.0, 550.0, 650.0];
    let long = |head: &str, scale: f64| {
        let row = |i: f64, o: f64, values: [f64; 3]| {
            (0..3).map(|c| format!("{i},{o},{},{}", nm[c] * scale, values[c])).collect::<Vec<_>>().join("\n")
        };
        format!("{head}\n{}", rows(row))
    };
    for (head, scale) in [
        ("theta_i,theta_o,wavelength,BRDF", 1.0),
        ("theta_i,theta_o,lambda [nm],BRDF", 1.0),
        ("theta_i,theta_o,wavelength_um,BRDF", 1e-3),
        ("theta_i,theta_o,λ (µm),f", 1e-3),
    ] {
        let document = read(long(head, scale).as_bytes(), &[]);
        assert_eq!(
            document.only().expect("data").representation().channels(),
            Channels::Spectral(nm.to_vec()),
            "{head}"
        );
        is_the_measurement(&document, 3, head);
    }
}

#[test]
fn quantities_of_values() {
    let of = |name: &str, value: fn(f64, f64) -> f64, words: &[(&str, &str)]| {
        let row = |i: f64, o: f64, [a, ..]: [f64; 3]| format!("{i},{o},{}", value(a, o.to_radians().cos()));
        is_the_measurement(&read(format!("theta_i,theta_o,{name}\n{}", rows(row)).as_bytes(), words), 1, name);
    };
    of("f", |f, _| PI * f, &[("values", "luminance-factor")]);
    of("luminance factor", |f, _| PI * f, &[]);
    of("Radiance factor [%]", |f, _| 100.0 * PI * f, &[]);
    of("BRF", |f, _| PI * f, &[]);
    of("BRDF", |f, cos| f * cos, &[("values", "f-cos")]);
    of("ccBRDF", |f, cos| f * cos, &[]);
    of("BRDF*cos", |f, cos| f * cos, &[]);
    of("f", |f, _| f / 2.5, &[("scale", "2.5")]);
    of("signal [uA]", |f, _| f / 2.5, &[("scale", "2.5")]);
    of("intensity", |f, _| f, &[("values", "f")]);
    of("f", |f, cos| f * cos * 10.0, &[("values", "f-cos"), ("scale", "0.1")]);
    let named = |name: &str| in_plane("theta_i,theta_o,R,G,B").replace("R,G,B", &format!("{name},comment,n"));
    for name in ["intensity", "signal [uA]", "Reflectance", "radiance (W/sr)", "counts"] {
        refused(&named(name), &[], "", "luminance-factor");
    }
    refused(&named("BRDF [uA]"), &[], "BRDF [uA]", "scale");
    refused(&named("BRDF [%]"), &[], "%", "luminance-factor");
    refused(&in_plane("theta_i,theta_o,R,G,B"), &[("scale", "tis")], "", "total integrated scatter");
}

#[test]
fn what_passes_through() {
    let through = format!("theta_i,theta_o,BTDF\n{}", rows(|i, o, [a, ..]| format!("{i},{o},{a}")));
    let document = read(through.as_bytes(), &[]);
    assert_eq!(document.only().expect("data").representation().scatter(), Scatter::Transmission);
    let beyond = format!(
        "theta_i,theta_o,f\n{}",
        rows(|i, o, [a, ..]| format!("{i},{},{a}", (180.0 - f64::abs(o)).copysign(o)))
    );
    refused(&beyond, &[], "theta_o", "--holds transmission");
    let wi = direction(30.0, 0.0);
    let [x, y, z] = direction(30.0, 180.0);
    let down = read(beyond.as_bytes(), &[("holds", "transmission")]);
    assert!((eval(down.only().expect("data"), wi, [x, y, -z])[0] - 0.35).abs() < 1e-5);
    let body = |text: &str| text.split_once('\n').expect("lines").1.to_string();
    let reflection = in_plane("theta_i,theta_o,R,G,B");
    let values = |text: String| {
        text.lines().map(|line| line.split(',').take(3).collect::<Vec<_>>().join(",") + "\n").collect::<String>()
    };
    let both = format!("theta_i,theta_o,f\n{}{}", values(body(&reflection)), body(&beyond));
    refused(&both, &[("holds", "transmission")], "theta_o", "both");
    let sheet = read(both.as_bytes(), &[("holds", "both")]);
    assert_eq!(sheet.parts.len(), 2);
    assert!((eval(&sheet.parts[0].data, wi, [x, y, z])[0] - 0.35).abs() < 1e-5);
    assert!((eval(&sheet.parts[1].data, wi, [x, y, -z])[0] - 0.35).abs() < 1e-5);
    refused(&in_plane("theta_i,theta_o,R,G,B").replace("\n50,", "\n120,"), &[], "theta_i of 120", "0 to 90");
}

#[test]
fn columns_are_said() {
    let body = rows(|i, o, [a, b, c]| format!("{i} {o} 180 {a} {b} {c}"));
    let all = "theta_i=1,theta_o=2,phi_o=3,R=4,G=5,B=6";
    is_the_measurement(&read(body.as_bytes(), &[("columns", all)]), 3, "no names");
    is_the_measurement(&read(body.as_bytes(), &[("columns", "theta_i=1,theta_o=2,f=4")]), 1, "in plane");
    let odd = table("Motor A,Motor B,Motor C,first,second,third", ";");
    let named = "theta_i=Motor A,theta_o=motor b,phi_o=Motor C,450nm=first,550nm=second,650nm=third";
    is_the_measurement(&read(odd.as_bytes(), &[("columns", named)]), 3, "names of columns");
    is_the_measurement(&read(odd.as_bytes(), &[("columns", all)]), 3, "numbers of columns");
    let some = table("theta_i,theta_o,phi_o,a,b,c", ",");
    is_the_measurement(&read(some.as_bytes(), &[("columns", "R=4,G=5,B=6")]), 3, "values only");
    let swapped = table("theta_o,theta_i,phi_o,R,G,B", ",");
    is_the_measurement(&read(swapped.as_bytes(), &[("columns", "theta_i=1,theta_o=2")]), 3, "other angles than named");
    let one = format!("theta_o,f\n{}", thetas().map(|o| format!("{o},{}\n", f(30.0, o, 0))).collect::<String>());
    for (name, text, words) in [
        ("a constant", one.clone(), vec![("columns", "theta_i=30deg")]),
        ("a constant in radians", one.clone(), vec![("columns", "theta_i=0.5235987755982988rad")]),
        ("a line above", format!("Angle of incidence: 30 deg\n{one}"), vec![]),
        ("a comment above", format!("# theta_i = 30\n{one}"), vec![]),
    ] {
        let document = read(text.as_bytes(), &words);
        let found = eval(document.only().expect("data"), direction(30.0, 0.0), direction(30.0, 180.0));
        assert!((f64::from(found[0]) - 0.35).abs() < 1e-5, "{name}: {found:?}");
    }
    refused(&one, &[], "no column of theta_i", "theta_i=30deg");
    refused(&body, &[], "without names", "--columns theta_i=1");
    refused(&odd, &[], "1: \"Motor A\", 2: \"Motor B\"", "columns = \"...\" in scan.csv.lobe.toml");
    refused(&body, &[("columns", "theta_i=1,theta_o=7,f=4")], "theta_o=7 in rows of 6", "");
    refused(&odd, &[("columns", "theta_i=Motor X,theta_o=2,f=4")], "Motor X", "Motor A");
    refused(&body, &[("columns", "theta_i=1,theta_o=1,f=4")], "twice", "once");
    for (bad, message) in [("theta_i", "NAME=COLUMN"), ("theta_i=0", "from 1"), ("", "a list"), ("f=3,f=4", "once")] {
        assert!(parse_columns(bad).expect_err("a refusal").contains(message), "{bad}");
    }
}

#[test]
fn rows_that_contradict_each_other_are_refused() {
    let text =
        format!("theta_i,theta_o,polarisation,BRDF\n{}", rows(|i, o, [a, ..]| format!("{i},{o},s,{a}\n{i},{o},p,{a}")));
    refused(&text, &[], "\"p\" in column \"polarisation\", and \"s\" in line 2", "averaged");
    is_the_measurement(&read(text.as_bytes(), &[("columns", "f=4")]), 1, "averaged");
    let repeated = format!(
        "theta_i,theta_o,run,BRDF\n{}",
        rows(|i, o, [a, ..]| format!("{i},{o},1,{}\n{i},{o},2,{}", a - 0.1, a + 0.1))
    );
    is_the_measurement(&read(repeated.as_bytes(), &[]), 1, "runs");
    refused(&table(HEAD, ",").replace("450nm", "550nm"), &[], "twice", "once");
    refused(&table(HEAD, ",").replace("450nm", "R"), &[], "channels", "wavelengths");
    for (from, to, found) in [
        ("\n30,30,180,", "\n30,30,180,x", "\"x0.35\""),
        ("\n30,30,180,0.35,", "\n30,30,180,0,35,", "7 fields"),
        ("\n30,30,180,0.35,", "\n30,30,180,", "5 fields"),
        ("\n30,30,", "\nstop\n30,30,", "\"stop\""),
        ("\n30,30,180,", "\n30,30,180,inf", "\"inf0.35\""),
    ] {
        let text = table(HEAD, ",").replace(from, to);
        let error = from_bytes(text.as_bytes(), path()).expect_err("a refusal");
        assert!(error.found.contains(found) && error.place == Place::Line(47), "{error}");
    }
}

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
    // What is said comes before it.
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
fn options_that_do_not_fit_are_refused() {
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
fn stated_totals_scale_what_is_relative() {
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
fn cut_off_anywhere_it_is_read_or_refused() {
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
