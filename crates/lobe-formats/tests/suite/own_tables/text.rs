//! From text to cells, and from names to angles.

use lobe_formats::{Document, Format, from_bytes, sniff};
use lobe_table::Channels;

use super::*;

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
fn commas_of_thousands_are_not_decimals() {
    let of = |values: [&str; 3], delimiter: &str| {
        let row = |(theta, value): (i32, &str)| format!("30{delimiter}{theta}{delimiter}90{delimiter}{value}\n");
        let rows: String = [0, 20, 40].into_iter().zip(values).map(row).collect();
        format!("{}\n{rows}", ["theta_i", "theta_o", "phi_o", "f"].join(delimiter))
    };
    let large = ["250", "\"1,234\"", "\"-12,345,678\""];
    for (values, delimiter) in [(["250", "\"1,234\"", "\"12,345\""], ","), (["7", "1,234", "12,345"], "\t")] {
        refused(&of(values, delimiter), &[], "1,234", "--decimal-comma");
        let said = read(of(values, delimiter).as_bytes(), &[("decimal-comma", "true")]);
        let found = eval(said.only().expect("data"), direction(30.0, 0.0), direction(20.0, 90.0));
        assert!((found[0] - 1.234).abs() < 1e-5, "{found:?}");
    }
    assert!(from_bytes(of(large, ",").as_bytes(), path()).is_err());
    // One that cannot be of thousands decides for all, and so does a semicolon.
    for (values, delimiter) in [
        (["0,5", "1,234", "12,345"], "\t"),
        (["\"2,5\"", "\"1,234\"", "\"12,345\""], ","),
        (["0,250", "1,234", "12,345"], "\t"),
        (["7", "1,234", "12,345"], ";"),
    ] {
        let document = read(of(values, delimiter).as_bytes(), &[]);
        let found = eval(document.only().expect("data"), direction(30.0, 0.0), direction(20.0, 90.0));
        assert!((found[0] - 1.234).abs() < 1e-5, "{values:?}: {found:?}");
    }
    // Points between thousands, and a comma before decimals.
    refused("theta_i;theta_o;phi_o;R;G;B\n10;0;0;1.250,0;1.300,5;1.400,0\n", &[], "1.250,0", "rows of numbers");
    refused("theta_i;theta_o;phi_o;f\nten;none;zero;x\n", &[], "no rows of numbers", "a line of names");
}

#[test]
fn names_longer_than_other_files_are_read() {
    let wavelengths: Vec<String> = (1..=20_000).map(|step| format!("{}nm", 200.0 + 0.1 * f64::from(step))).collect();
    for end in ["\n", "\r\n"] {
        let row = |theta: u32| format!("30,{theta},0{}", ",0.25".repeat(wavelengths.len()));
        let text = [format!("theta_i,theta_o,phi_o,{}", wavelengths.join(",")), row(0), row(40)].join(end);
        assert_eq!(sniff(text.as_bytes()), Some(Format::Goniometer));
        let document = read(text.as_bytes(), &[]);
        assert_eq!(document.only().expect("data").representation().channels().count(), wavelengths.len());
    }
}

/// Each separator of a name was once a level of recursion.
#[test]
fn names_may_have_many_separators() {
    for separator in [":1", "=1", "_1"] {
        let name = separator.repeat(50_000);
        let text = format!("theta_i,theta_o,f,x{name}\n0,0,1,1\n0,30,1,1\n30,0,1,1\n30,30,1,1\n");
        assert!(read(text.as_bytes(), &[]).only().is_some());
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
    // A German spreadsheet.
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
        "Einfallswinkel (°),Beobachtungswinkel (°),Azimutdifferenz (°)",
        "Einfall,Streuung,Azimut",
        "Einfallswinkel,Ausfallswinkel,relativer Azimutwinkel",
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
    // An angle in a separate line applies until the next one.
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
    // Whatever follows the unit.
    for end in ["°", "°…", "°\u{fffd}", "²", "\u{fffd}", "\u{fffd}\u{fffd}", "…", "°°"] {
        let text = in_plane(&format!("theta_i deg{end},theta_o_deg {end},R,G,B"));
        let _ = from_bytes(text.as_bytes(), path());
        let text = in_plane(&format!("theta_i,theta_o,phi_o rad·{end},R {end},G deg{end}"));
        let _ = from_bytes(text.as_bytes(), path());
    }
    refused(&in_plane("AOI,scatter angle (from specular),R,G,B"), &[], "specular", "from the normal");
    // Units that are not read are not taken for degrees.
    for unit in ["gon", "arcmin", "mm", "turns"] {
        let named = format!("theta_i [{unit}],theta_o [{unit}],R,G,B");
        refused(&in_plane(&named), &[], unit, "degrees");
        refused(&in_plane(&format!("theta_i,theta_o,R,G,B\n{unit},{unit},,,")), &[], unit, "degrees");
    }
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
