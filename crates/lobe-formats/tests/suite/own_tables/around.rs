//! Lines around and between the rows: what they say of the values, and blocks of rows.

use lobe_table::Channels;

use super::*;

/// The measurement with one channel, below some lines.
fn below(lines: &str) -> String {
    format!("{lines}\ntheta_i,theta_o,value\n{}", rows(|i, o, [a, ..]| format!("{i},{o},{a}")))
}

/// A refusal that names the line, and none with the options.
#[track_caller]
fn is_settled_by(line: &str, words: &[(&str, &str)], found: &str) {
    // Above the names, between the rows as a comment, and below the rows.
    let plain = below("Sample: x");
    let between = plain.replace("\n30,-78,", &format!("\n# {line}\n30,-78,"));
    let last = plain.lines().count();
    for (text, number) in [
        (below(line), 1),
        (format!("# mine\n{}", below(&format!("# {line}"))), 2),
        (format!("{plain}{line}\n"), last + 1),
        (between, 30),
    ] {
        let error = from_bytes_with(text.as_bytes(), path(), &options(&[])).expect_err(line);
        assert!(error.found.contains(found) && error.place == Place::Line(number), "{line}: {error}");
        if !words.is_empty() {
            read(text.as_bytes(), words);
        }
    }
}

#[test]
fn factors_outside_the_rows_are_not_ignored() {
    let scale = [("scale", "0.001")];
    for line in [
        "Scale: 1000",
        "Scale = 1e3",
        "Factor = 0.001",
        "Multiplier: 10^-3",
        "ScaleFactor: x1000",
        "BRDF scale: 1/1000",
        "Scaling (BRDF): 1000",
        "Gain: 4",
        "Calibration factor: 0.98",
        "Skalierungsfaktor: 0.5",
        "Exponent: -3",
        "BRDF values multiplied by 1000",
        "all values are scaled by 1e3",
        "Divide by 1000",
        "BRDF x 1000",
        "BRDF values (x1000)",
        "Comment: values times 100",
    ] {
        is_settled_by(line, &scale, if line.starts_with("Exponent") { "power of ten" } else { "a factor of" });
    }
    let scaled = read(below("Scale: 1000").as_bytes(), &scale);
    let found = eval(scaled.only().expect("data"), direction(30.0, 0.0), direction(30.0, 180.0));
    assert!((found[0] - 0.35e-3).abs() < 1e-8, "{found:?}");
    for line in [
        "Units: 10^-3 1/sr",
        "Value unit: 1e-3/sr",
        "BRDF unit: ppm",
        "Einheit: %",
        "Units: deg; deg; %",
        "Unit: arbitrary units",
        "values in units of 10^-6 sr^-1",
        "BRDF values in %",
        "BRDF in percent",
    ] {
        is_settled_by(line, &scale, if line.ends_with("Einheit: %") || line.ends_with("; %") { "in %" } else { "" });
    }
    for line in ["Angle scale: 0.1", "theta multiplier: 0.5"] {
        is_settled_by(line, &[], "a factor of angles");
    }
}

#[test]
fn quantities_outside_the_rows_are_not_ignored() {
    let values = [("values", "f")];
    for (line, found) in [
        ("Quantity: luminance factor", "luminance-factor"),
        ("Values: BRDF*cos", "f-cos"),
        ("Quantity: reflectance", "another quantity"),
        ("values are cosine-corrected BRDF", "f-cos"),
        ("BRDF multiplied by cos(theta_o)", "f-cos"),
        ("BRDF values normalised to the peak", "relative values"),
        ("Normalized: yes", "relative values"),
        ("Y scale: log10", "a logarithm"),
        ("values are log10(BRDF)", "a logarithm"),
    ] {
        is_settled_by(line, &values, found);
    }
    for line in ["Angle unit: gon", "Angles: gon", "Units: gon"] {
        is_settled_by(line, &[("unit", "deg")], "angles in gon");
    }
    // The same quantity in the name of the column.
    let named = below("Quantity: luminance factor").replace("theta_o,value", "theta_o,luminance factor");
    let found = eval(read(named.as_bytes(), &[]).only().expect("data"), direction(30.0, 0.0), direction(30.0, 180.0));
    assert!((found[0] - 0.35 / std::f32::consts::PI).abs() < 1e-6, "{found:?}");
    for line in ["Quantity: BTDF", "Measurement: transmission", "Messung: Transmission"] {
        let parts = read(below(line).as_bytes(), &[]).parts;
        assert_eq!(parts[0].data.representation().scatter(), Scatter::Transmission, "{line}");
    }
}

#[test]
fn other_lines_remain_facts() {
    for line in [
        "Scale: 1",
        "Scale factor: 1.0",
        "Scale: linear",
        "Colour scale: 256",
        "Scale bar: 10 um",
        "Full scale: 65535",
        "Detector gain: 20",
        "Form factor: 2",
        "Normalization: none",
        "Normalized: no",
        "Relative humidity: 40 %",
        "Angle unit: deg",
        "Units: deg, 1/sr",
        "Units: degrees",
        "Unit: sr^-1",
        "Spot size: 3 x 5 mm",
        "Log file: run7.txt",
        "Quantity: BRDF",
        "Values: 81",
        "values are not normalised",
        "BRDF without cosine correction",
        "measured in a dark room, normal incidence included",
        "Data: in 12 files",
        "Distance, 2 m",
        "resampled with an error of 3.2 %, values multiplied by 7",
    ] {
        is_the_measurement(&read(below(line).as_bytes(), &[]), 1, line);
        is_the_measurement(&read(below(&format!("# {line}")).as_bytes(), &[]), 1, line);
    }
}

#[test]
fn units_in_cells_and_lines() {
    let radians = rows(|i, o, [a, ..]| format!("{:.9},{:.9},{a}", i.to_radians(), o.to_radians()));
    for head in [
        "Angles: rad\ntheta_i,theta_o,f",
        "Angles in: radians\ntheta_i,theta_o,f",
        "Winkeleinheit: rad\ntheta_i,theta_o,f",
        "[rad],[rad],[1/sr]\ntheta_i,theta_o,f",
        "theta_i,theta_o,f\n(rad),(rad),(1/sr)",
    ] {
        is_the_measurement(&read(format!("{head}\n{radians}").as_bytes(), &[]), 1, head);
    }
    refused(&below("[gon],[gon],[1/sr]"), &[], "theta_i as gon", "degrees");
    let one = |line: &str| {
        format!("{line}\ntheta_o,f\n{}", thetas().map(|o| format!("{o},{}\n", f(30.0, o, 0))).collect::<String>())
    };
    for line in ["Angle of incidence: 30 gon", "Angle of incidence [gon]: 30"] {
        refused(&one(line), &[], "no column of theta_i", "theta_i=30deg");
    }
    // Signs that look like that of degrees, and dashes that look like a minus.
    for (from, to) in [(",30,", ",30º,"), (",30,", ",30˚,"), (",-78,", ",–78,"), (",-78,", ",‐78,")] {
        let text = below("Sample: x").replace(from, to);
        is_the_measurement(&read(text.as_bytes(), &[]), 1, to);
    }
    is_the_measurement(&read(below("x: y").replace("theta_o,", "theta_o [º],").as_bytes(), &[]), 1, "in a name");
    // In the code page of Windows, 0x96 is a dash: not measured, or a minus.
    let mut bytes = below("x: 30 y").into_bytes();
    let at = bytes.windows(5).position(|word| word == b"x: 30").expect("a line");
    bytes[at] = 0xb5;
    let text: Vec<u8> = bytes.iter().map(|&byte| if byte == b'-' { 0x96 } else { byte }).collect();
    is_the_measurement(&read(&text, &[]), 1, "dashes of Windows");
    for name in ["BRF %", "BRF in percent", "BRF [percent]", "reflectance factor (%)"] {
        let text = in_plane("theta_i,theta_o,a,b,c").replace(",a,b,c", &format!(",{name},std,comment"));
        let found = eval(read(text.as_bytes(), &[]).only().expect(name), direction(30.0, 0.0), direction(30.0, 180.0));
        assert!((found[0] - 0.0035 / std::f32::consts::PI).abs() < 1e-7, "{name}: {found:?}");
    }
    for name in ["BRDF [‰]", "BRDF [ppm]", "BRDF %", "BRDF [percent]"] {
        let text = in_plane("theta_i,theta_o,a,b,c").replace(",a,b,c", &format!(",{name},std,comment"));
        assert!(from_bytes_with(text.as_bytes(), path(), &options(&[])).is_err(), "{name}");
    }
    // Without azimuths, these may be azimuths.
    refused(&in_plane("theta_i,theta_o,120,180,240"), &[], "\"120\"", "550nm");
    let azimuths = table("theta_i,theta_o,phi_o,120,180,240", ",");
    assert_eq!(
        read(azimuths.as_bytes(), &[]).only().expect("data").representation().channels(),
        Channels::Spectral(vec![120.0, 180.0, 240.0])
    );
    let corner = "theta_o [deg] \\ theta_i [gon]\t10\t30\t50\n0\t1\t2\t3\n10\t4\t5\t6\n";
    assert!(from_bytes_with(corner.as_bytes(), path(), &options(&[])).is_err());
}

/// The three channels as blocks, each with a line above it.
fn blocks(line: impl Fn(usize) -> String, head: &str) -> String {
    let block = |channel: usize| {
        let rows = rows(|i, o, values| format!("{i},{o},{}", values[channel]));
        format!("{}\n{head}\n{rows}\n", line(channel))
    };
    (0..3).map(block).collect()
}

#[test]
fn blocks_have_their_own_wavelengths() {
    let head = "theta_i,theta_o,BRDF";
    let nm = |channel: usize| 450 + 100 * channel;
    let wavelengths = Channels::Spectral(vec![450.0, 550.0, 650.0]);
    for (name, text) in [
        ("lines", blocks(|channel| format!("Wavelength: {} nm", nm(channel)), head)),
        ("comments", blocks(|channel| format!("# lambda = {}", nm(channel)), head)),
        ("only a number", blocks(|channel| format!("# {} nm", nm(channel)), head)),
        ("micrometres", blocks(|channel| format!("Wavelength [um],{}", nm(channel) as f64 / 1e3), head)),
        (
            "names once",
            blocks(|channel| format!("Wavelength: {} nm", nm(channel)), "").replacen('\n', &format!("\n{head}\n"), 1),
        ),
    ] {
        let document = read(text.as_bytes(), &[]);
        assert_eq!(document.only().expect("data").representation().channels(), wavelengths, "{name}");
        is_the_measurement(&document, 3, name);
    }
    let wide = |channel: usize| {
        let row = |o: f64| format!("{o}{}\n", THETA_I.map(|i| format!("\t{}", f(i, o, channel))).concat());
        format!(
            "Wavelength: {} nm\ntheta_o \\ theta_i\t10\t30\t50\n{}\n",
            nm(channel),
            thetas().map(row).collect::<String>()
        )
    };
    is_the_measurement(&read((0..3).map(wide).collect::<String>().as_bytes(), &[]), 3, "a column per angle");
    let one = blocks(|_| "Wavelength: 550 nm".into(), head);
    let one = read(one.split_once("\n\n").expect("blocks").0.as_bytes(), &[]);
    assert_eq!(one.only().expect("data").representation().channels(), Channels::Mono);
    assert!(one.source.iter().any(|(name, value)| name == "Wavelength" && value == "550 nm"));
    let first =
        blocks(|channel| if channel == 0 { "Start".into() } else { format!("Wavelength: {} nm", nm(channel)) }, head);
    refused(&first, &[], "rows without a wavelength", "Wavelength: 550 nm above each");
    let colours = blocks(|channel| format!("# {} nm", nm(channel)), "theta_i,theta_o,BRDF_550nm");
    refused(&colours, &[], "another wavelength", "one column of values");
}

#[test]
fn blocks_that_repeat_directions_are_refused() {
    let head = "theta_i,theta_o,BRDF";
    for (name, text) in [
        ("a line", blocks(|channel| format!("Polarisation: {channel}"), head)),
        ("a comment", blocks(|channel| format!("# sample {channel}"), head)),
        ("names", blocks(|_| head.into(), "").replace("\n\n", "\n")),
        ("an empty line", blocks(|_| String::new(), "").replacen("\n\n", &format!("{head}\n"), 1)),
    ] {
        refused(&text, &[], "the directions of line", "Wavelength: 550 nm");
        let averaged = read(text.as_bytes(), &[("columns", "f=3")]);
        let found = eval(averaged.only().expect(name), direction(30.0, 0.0), direction(30.0, 180.0));
        assert!((found[0] - 0.4).abs() < 1e-6, "{name}: {found:?}");
    }
    // Runs are repetitions, and so are rows that follow each other.
    let runs = blocks(|channel| format!("# run {channel}"), "").replace("\n\n", "\n");
    let runs = runs.replacen('\n', &format!("\n{head}\n"), 1);
    let found = eval(read(runs.as_bytes(), &[]).only().expect("data"), direction(30.0, 0.0), direction(30.0, 180.0));
    assert!((found[0] - 0.4).abs() < 1e-6, "{found:?}");
    let apart = blocks(|channel| format!("# part {channel}"), head);
    let same = apart.lines().filter(|line| !line.starts_with("50,")).collect::<Vec<_>>().join("\n");
    assert!(from_bytes_with(same.as_bytes(), path(), &options(&[])).is_err());
}

#[test]
fn columns_of_units_and_factors_are_not_ignored() {
    let table = |name: &str, cell: &str| {
        let rows = rows(|i, o, [a, ..]| format!("{i},{o},{a},{cell}"));
        format!("theta_i,theta_o,value,{name}\n{rows}")
    };
    for (name, cell, found) in [
        ("unit", "1e-3/sr", "the unit 1e-3/sr"),
        ("Einheit", "%", "values in %"),
        ("scale", "1000", "a factor of 1000"),
        ("Factor", "0.5", "a factor of 0.5"),
    ] {
        let text = table(name, cell);
        let error = from_bytes_with(text.as_bytes(), path(), &options(&[])).expect_err(cell);
        assert!(error.found.contains(found) && error.place == Place::Line(2), "{name} {cell}: {error}");
        read(text.as_bytes(), &[("scale", "0.001"), ("values", "f")]);
    }
    for (name, cell) in [("unit", "1/sr"), ("units", "sr^-1"), ("scale", "1"), ("detector", "2"), ("note", "good")] {
        read(table(name, cell).as_bytes(), &[]);
    }
}
