//! Formats of scattered measurements: their meaning, and refused files.

use std::f64::consts::PI;
use std::path::Path;

use lobe_formats::{FormatError, Place, alta, cornell, fred, lumos, nist, openmaterial};
use lobe_table::{Channels, Scatter, scattered};
use lobe_testing::examples::{ALTA, CORNELL, FRED, LUMOS, NIST, OPEN_MATERIAL, RPC};
use lobe_testing::files::{bytes, files, shared};

type Reader = fn(&[u8], &Path) -> Result<scattered::Data, FormatError>;
type Matches = fn(&[u8]) -> bool;

/// Every format with a small example file: two incident directions and three outgoing ones each, in the order of angle.
const FORMATS: [(&str, Matches, Reader, &str); 7] = [
    ("cornell", cornell::matches, cornell::read, CORNELL),
    ("fred", fred::matches, fred::read, FRED),
    ("rpc", fred::matches_rpc, fred::read_rpc, RPC),
    ("lumos", lumos::matches, lumos::read, LUMOS),
    ("alta", alta::matches, alta::read, ALTA),
    ("openmaterial", openmaterial::matches, openmaterial::read, OPEN_MATERIAL),
    ("nist", nist::matches, nist::read, NIST),
];

fn read(name: &str, text: &str) -> Result<scattered::Data, FormatError> {
    let (_, _, read, _) = FORMATS.iter().find(|format| format.0 == name).expect("a format");
    read(text.as_bytes(), Path::new("file"))
}

fn example(name: &str) -> (&'static str, scattered::Data) {
    let (.., text) = FORMATS.iter().find(|format| format.0 == name).expect("a format");
    (text, read(name, text).unwrap_or_else(|error| panic!("{name}: {error}")))
}

fn direction(theta: f64, phi: f64) -> [f64; 3] {
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

#[test]
fn every_format_recognises_only_its_own_files() {
    for (name, _, _, text) in FORMATS {
        for (other, matches, ..) in FORMATS {
            assert_eq!(matches(text.as_bytes()), name == other, "{name} and {other}");
        }
    }
}

#[test]
fn hostile_input_does_no_harm() {
    for (name, matches, read, text) in FORMATS {
        println!("{name}");
        let is_whole = |bytes: &[u8]| {
            matches(bytes);
            read(bytes, Path::new("file")).is_ok()
        };
        // In these formats, every line is a record, so a prefix of the file may be a shorter file.
        if name == "openmaterial" {
            lobe_testing::damage::truncations(text.as_bytes(), is_whole);
        } else {
            (0..text.len()).for_each(|end| {
                is_whole(&text.as_bytes()[..end]);
            });
        }
    }
}

#[test]
fn cornell_angles_are_radians_and_both_directions_point_away() {
    let (text, data) = example("cornell");
    assert_eq!(data.channels(), &Channels::Spectral(vec![400.0, 500.0]));
    assert_eq!(data.eval(direction(0.1, 1.0), direction(0.3, 2.0)), [3.0, 4.0]);
    let error = read("cornell", &text.replace("0.2 3 5 6", "0.2 3 nan 6")).expect_err("a refusal");
    assert_eq!((error.place, error.found.as_str()), (Place::Line(9), "`nan`"));
    let error = read("cornell", text.trim_end().strip_suffix('8').expect("an 8")).expect_err("a refusal");
    assert!(error.found.contains("end of the file"), "{error}");
    let error = read("cornell", &text.replace("\n2\r", "\n2000000000\r")).expect_err("a refusal");
    assert_eq!(error.place, Place::Line(2), "{error}");
}

#[test]
fn fred_and_rpc_give_the_direction_in_which_light_travels() {
    let (text, data) = example("fred");
    let degrees = |theta: f64, phi: f64| direction(theta.to_radians(), phi.to_radians());
    assert_eq!(data.eval(degrees(10.0, 180.0), degrees(10.0, 0.0)), [2.0]);
    assert_eq!(data.eval(degrees(30.0, 90.0), degrees(30.0, -90.0)), [3.0]);
    let error = read("fred", &text.replace("bsdf=value", "bsdf=log")).expect_err("a refusal");
    assert_eq!((error.place, error.found.as_str()), (Place::Line(2), "\"bsdf=log\""));
    let error = read("fred", &text.replace("10\t0\n", "")).expect_err("a refusal");
    assert_eq!(error.place, Place::Line(3), "{error}");
    let scaled = read("fred", &text.replace("scale=1", "scale=0.5")).expect("a table");
    assert_eq!(scaled.eval(degrees(10.0, 180.0), degrees(10.0, 0.0)), [1.0]);

    let (_, data) = example("rpc");
    assert_eq!(data.scatter(), Scatter::Transmission);
    let [x, y, z] = degrees(5.0, 15.0);
    assert!((data.eval([-x, -y, z], [x, y, -z])[0] - 20.0).abs() < 1e-5);
    assert_eq!(data.eval([-x, -y, z], [x, y, z]), [0.0]);
}

#[test]
fn signed_polar_angles_are_the_other_half_of_the_plane() {
    let (_, data) = example("lumos");
    let at = |theta_i: f64, theta_o: f64| {
        data.eval(direction(theta_i.to_radians(), PI), direction(theta_o.to_radians(), 0.0))[0]
    };
    assert!((at(45.0, 45.0) - 9.0).abs() < 1e-5 && (at(45.0, -20.0) - 0.1).abs() < 1e-5);
    let (_, data) = example("nist");
    assert_eq!(data.channels(), &Channels::Spectral(vec![532.0, 633.0]));
    assert_eq!(data.eval(direction(PI / 6.0, PI), direction(PI / 6.0, 0.0)), [0.4, 0.5]);
}

#[test]
fn cosines_are_divided_out_of_alta_values() {
    let (text, data) = example("alta");
    assert_eq!(data.samples().count(), 4, "the sample at the horizon is left out");
    let at_retro = data.eval(direction(0.2, 1.0), direction(0.2, 1.0))[0];
    assert!((f64::from(at_retro) - 0.5 / 0.2_f64.cos()).abs() < 1e-6, "{at_retro}");
    for (from, to, line) in [("#DIM 3 1", "#DIM 2 1", 1), ("ISOTROPIC_TL_TV_PROJ_DPHI", "RUSIN_TH_PH_TD_PD", 3)] {
        let error = read("alta", &text.replace(from, to)).expect_err("a refusal");
        assert_eq!(error.place, Place::Line(line), "{error}");
    }
}

#[test]
fn wavelengths_become_channels() {
    let (text, data) = example("openmaterial");
    assert_eq!(data.channels(), &Channels::Spectral(vec![410.0, 500.0]));
    assert_eq!(data.eval(direction(0.1, 1.0), direction(0.3, 1.5)), [2.0, 4.0]);
    let error = read("openmaterial", &text.replace("[5e-07, 0.1, 0.3, 0.5, 4]", "[6e-07, 0.1, 0.3, 0.5, 4]"));
    assert!(error.expect_err("a refusal").expected.contains("all 3 wavelengths"));
    assert!(read("openmaterial", &"[".repeat(1_000_000)).is_err());
    let nested = format!("{{\"metadata\": {}, \"brdf\": 1}}", "[".repeat(1_000_000));
    assert!(read("openmaterial", &nested).is_err());
}

#[test]
fn every_real_file_loads() {
    let Some(shared) = shared() else { return };
    let data = shared.join("data");
    let mut count = 0;
    for below in
        ["cornell_brdf", "fred_txt", "rpc_txt", "lumos_csv", "alta_dat", "openmaterial3d_json", "nist_mueller_csv"]
    {
        for path in files(&data.join(below)) {
            let bytes = bytes(&path);
            let name = path.file_name().expect("a name").to_string_lossy();
            let Some((format, _, read, _)) = FORMATS.iter().find(|(_, matches, ..)| matches(&bytes)) else {
                println!("{name}: none of these formats");
                let is_other = ["README", "schema", ".frs", "coef"].iter().any(|word| name.contains(word));
                assert!(is_other, "{name}");
                continue;
            };
            let data = read(&bytes, &path).unwrap_or_else(|error| panic!("{error}"));
            let (samples, channels) = (data.samples().count(), data.channels().count());
            let kind = if data.is_isotropic() { "isotropic" } else { "anisotropic" };
            println!(
                "{name}: {format}, {kind}, {} incidences, {samples} samples x {channels}",
                data.incidences().len()
            );
            let mut worst = 0.0_f32;
            for (angles, values) in data.samples().step_by(1 + samples / 2000) {
                let [theta_i, phi_i, theta_o, phi_o] = angles;
                if theta_o > PI / 2.0 - 1e-3 {
                    continue;
                }
                let [x, y, z] = direction(theta_o, phi_o);
                let wo = if data.scatter() == Scatter::Transmission { [x, y, -z] } else { [x, y, z] };
                let found = data.eval(direction(theta_i, phi_i), wo);
                for (found, wanted) in found.iter().zip(values) {
                    worst = worst.max((found - wanted).abs() / wanted.abs().max(1e-3));
                }
            }
            assert!(worst < 1e-3, "{name}: samples come back to {worst}");
            count += 1;
        }
    }
    assert_eq!(count, 3 + 2 + 13 + 3 + 2 + 1 + 1);
}

#[test]
fn the_files_of_a_diffuser_are_one_material() {
    let Some(shared) = shared() else { return };
    let data = shared.join("data/rpc_txt");
    let diffuser = fred::read_rpc_folder(&data).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((diffuser.incidences().len(), diffuser.is_isotropic()), (13, false));
    // Light that arrives at 10 degrees toward azimuth 37.5 continues in about that direction.
    let (theta, phi) = (10_f64.to_radians(), 37.5_f64.to_radians());
    let ([x, y, z], [u, v, w]) = (direction(theta, phi), direction(theta, phi + PI));
    let (straight, back) = (diffuser.eval([-x, -y, z], [x, y, -z])[0], diffuser.eval([-x, -y, z], [u, v, -w])[0]);
    assert!(straight > 15.0 && straight > 5.0 * back, "{straight} straight through, {back} to the other side");
    assert!(fred::read_rpc_folder(&data.join("nowhere")).is_err());
}

/// A number that is finite in the unit of the file and not in that of the table.
#[test]
fn wavelengths_that_overflow_are_refused() {
    let error = read("nist", &NIST.replace("0.633", "1e300")).expect_err("a refusal");
    assert_eq!((error.place, error.found.contains("wavelength")), (Place::Line(4), true), "{error}");
    let error = read("openmaterial", &OPEN_MATERIAL.replace("[5e-07", "[1e300")).expect_err("a refusal");
    assert!(error.found.ends_with("in row 3"), "{error}");
}

#[test]
fn header_facts_are_kept() {
    let facts = |name: &str, text: &str| {
        lobe_formats::from_bytes(text.as_bytes(), Path::new(name)).unwrap_or_else(|error| panic!("{error}")).source
    };
    let fact = |name: &str, value: &str| (name.to_string(), value.to_string());
    let alta = format!("#SAMPLE \"My tape\"\n#ORIGIN my bench\n{ALTA}");
    let found = facts("a.dat", &alta);
    assert_eq!(found[..2], [fact("SAMPLE", "My tape"), fact("ORIGIN", "my bench")]);
    assert!(
        found.contains(&fact("PARAM_IN", "ISOTROPIC_TL_TV_PROJ_DPHI")) && found.iter().all(|(name, _)| name != "DIM")
    );
    let cornell = format!("# My paint\n#\n{CORNELL}");
    assert_eq!(facts("a.brdf", &cornell), [fact("comment", "My paint")]);
    assert_eq!(facts("a.txt", FRED), [fact("format", "angles=deg bsdf=value scale=1")]);
    assert_eq!(facts("a.txt", RPC), [fact("comment", "EDS 5-15")]);
    assert_eq!(facts("a.csv", LUMOS), [fact("comment", "Name")]);
    let metadata =
        "\"metadata\": {\"name\": \"asphalt\", \"year\": 2024, \"authors\": [\"A\", \"B\"], \"more\": {\"x\": 1}}";
    let found = facts("a.xompt", &OPEN_MATERIAL.replace("\"metadata\": {}", metadata));
    assert_eq!(found, [fact("authors", "A, B"), fact("name", "asphalt"), fact("year", "2024")]);
    let astm = lobe_testing::examples::ASTM;
    assert_eq!(facts("a.astm", astm), [fact("BRDF_TYPE", "measured")]);
}
