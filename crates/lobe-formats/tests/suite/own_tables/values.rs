//! The contents of value columns, and which of them are read.

use std::f64::consts::PI;

use lobe_formats::reading::parse_columns;
use lobe_formats::{Place, from_bytes};
use lobe_table::{Channels, Scatter};

use super::*;

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

/// Names that say that the numbers are not `f` in 1/sr are not ignored.
#[test]
fn names_that_state_another_scale_are_refused() {
    let named = |name: &str| {
        let row = |i: f64, o: f64, [a, ..]: [f64; 3]| format!("{i},{o},{a}");
        format!("theta_i,theta_o,{name}\n{}", rows(row))
    };
    for (name, expected) in [
        ("log BRDF", "itself"),
        ("log10(BRDF)", "itself"),
        ("BRDF_dB", "itself"),
        ("BRDF [dB]", "itself"),
        ("BRDF [10^-3 1/sr]", "scale"),
        ("BRDF [10⁻³ sr⁻¹]", "scale"),
        ("BRDF [1e-3/sr]", "scale"),
        ("BRDF (x1000)", "scale"),
        ("BRDF [1/msr]", "scale"),
        ("L [W m-2 sr-1]", "scale"),
        ("normalised BRDF", "values"),
        ("BRDF_norm", "values"),
        ("BRDF [a.u.]", "values"),
        ("relative BRDF", "values"),
        ("pi*BRDF", "luminance-factor"),
        ("πf", "luminance-factor"),
        ("HDRF", "luminance-factor"),
        ("I/F", "luminance-factor"),
        ("b*", "luminance-factor"),
        ("BRDF cos(theta_i)", "values"),
        ("BRDF*cosθi", "values"),
    ] {
        refused(&named(name), &[], "", expected);
    }
    let scaled = |name: &str, words: &[(&str, &str)]| {
        let row = |i: f64, o: f64, [a, ..]: [f64; 3]| format!("{i},{o},{}", 1000.0 * a);
        is_the_measurement(&read(format!("theta_i,theta_o,{name}\n{}", rows(row)).as_bytes(), words), 1, name);
    };
    scaled("BRDF [10^-3 1/sr]", &[("scale", "0.001")]);
    scaled("normalised BRDF", &[("scale", "0.001")]);
    refused(&named("BRDF [10^-3 1/sr]"), &[("values", "f")], "10^-3", "scale");
    refused(&named("BRDF\n,,10^-3/sr"), &[], "10^-3", "scale");
    refused(&named("BRDF\n,,%"), &[], "%", "luminance-factor");
    for name in ["BRDF [sr^-1]", "BRDF [sr⁻¹]", "f (1/sr)", "BRDF (550)"] {
        is_the_measurement(&read(named(name).as_bytes(), &[]), 1, name);
    }
    let cosine = |name: &str| {
        let row = |i: f64, o: f64, [a, ..]: [f64; 3]| format!("{i},{o},{}", a * o.to_radians().cos());
        is_the_measurement(&read(format!("theta_i,theta_o,{name}\n{}", rows(row)).as_bytes(), &[]), 1, name);
    };
    ["BRDF*cos(theta_o)", "BRDF·cosθ", "BRDF cosθ_o", "f costhetas", "ARS [1/sr]", "DSF"].into_iter().for_each(cosine);
}

#[test]
fn transmission() {
    let through = format!("theta_i,theta_o,BTDF\n{}", rows(|i, o, [a, ..]| format!("{i},{o},{a}")));
    let document = read(through.as_bytes(), &[]);
    assert_eq!(document.only().expect("data").representation().scatter(), Scatter::Transmission);
    let beyond = format!(
        "theta_i,theta_o,f\n{}",
        rows(|i, o, [a, ..]| format!("{i},{},{a}", (180.0 - f64::abs(o)).copysign(o)))
    );
    refused(&beyond, &[], "theta_o", "--holds transmission");
    for kind in ["Mode: Transmittance", "# Scatter type: BTDF", "Measurement type, transmitted light"] {
        let document = read(format!("{kind}\n{}", through.replace("BTDF", "f")).as_bytes(), &[]);
        assert_eq!(document.only().expect("data").representation().scatter(), Scatter::Transmission, "{kind}");
    }
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
fn columns_can_be_named() {
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
