//! Grids of spherical coordinates, written for LightTools, Speos and MDL and read again.

use std::path::Path;

use lobe_formats::{Document, Format, Part, RESAMPLED, open};
use lobe_table::{Channels, Data, Scatter, Side, spherical};
use lobe_testing::files::{files, shared};

/// Writes a document under a name and reads it again. The error is the reason why it was not written.
fn round_trip(document: &Document, format: Format, name: &str) -> Result<Document, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    let writer = format.writer().expect("a writer");
    (writer.write)(document, &path).map_err(|error| error.to_string())?;
    let (found, back) = open(&path).map_err(|error| error.to_string())?;
    assert_eq!(found, format);
    assert!((writer.holds)(document), "{name} was written");
    Ok(back)
}

fn degrees(list: &[f64]) -> Vec<f64> {
    list.iter().map(|angle| angle.to_radians()).collect()
}

/// Values that need all digits, smooth at the pole and around the seam.
fn grid(scatter: Scatter, phi_i: &[f64], phi_o: &[f64], channels: Channels) -> spherical::Data {
    let knots = [degrees(&[0.0, 20.0, 55.5]), degrees(phi_i), degrees(&[0.0, 15.0, 40.0, 75.0, 90.0]), degrees(phi_o)];
    let mut values = Vec::new();
    for theta_i in &knots[0] {
        for phi_i in &knots[1] {
            for theta_o in &knots[2] {
                for phi_o in &knots[3] {
                    let f = 0.1 + 0.07 * theta_o.sin() * (phi_o - 0.3 * phi_i).cos() * theta_i.sin();
                    values.extend((0..channels.count()).map(|channel| (f / (1.0 + channel as f64)) as f32));
                }
            }
        }
    }
    spherical::Data::new(scatter, knots, channels, values).expect("a grid")
}

const TURN: [f64; 9] = [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0, 360.0];

fn direction(theta: f64, phi: f64) -> [f64; 3] {
    let (theta, phi) = (theta.to_radians(), phi.to_radians());
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

/// The value for a pair of directions, given by polar angle and azimuth in degrees.
fn value(data: &Data, wi: [f64; 2], wo: [f64; 2]) -> Vec<f64> {
    let (wi, mut wo) = (direction(wi[0], wi[1]), direction(wo[0], wo[1]));
    if data.representation().scatter() == Scatter::Transmission {
        wo[2] = -wo[2];
    }
    match data {
        Data::Spherical(grid) => grid.eval(wi, wo),
        Data::Scattered(samples) => samples.eval(wi, wo).into_iter().map(f64::from).collect(),
        other => panic!("{other:?}"),
    }
}

/// Compares values at pairs of directions, up to a bound relative to the value.
#[track_caller]
fn assert_alike(found: &Data, expected: &Data, pairs: &[([f64; 2], [f64; 2])], bound: f64) {
    for (wi, wo) in pairs {
        let (found, expected) = (value(found, *wi, *wo), value(expected, *wi, *wo));
        for (found, expected) in found.iter().zip(&expected) {
            assert!((found - expected).abs() <= bound * expected.abs(), "{found}, not {expected}, at {wi:?} {wo:?}");
        }
    }
}

/// Nodes, and directions between them.
const BETWEEN: [([f64; 2], [f64; 2]); 4] = [
    ([20.0, 0.0], [40.0, 45.0]),
    ([55.5, 0.0], [75.0, 270.0]),
    ([31.0, 12.0], [22.0, 200.0]),
    ([44.0, 80.0], [61.0, 350.0]),
];

#[test]
fn light_tools_grids_come_back() {
    for channels in [Channels::Mono, Channels::Xyz, Channels::Spectral(vec![450.0, 550.5, 700.0])] {
        for (phi_i, scatter) in [(&[0.0][..], Scatter::Reflection), (&[0.0, 90.0, 200.0], Scatter::Transmission)] {
            let data: Data = grid(scatter, phi_i, &TURN, channels.clone()).into();
            let back = round_trip(&Document::new(data.clone()), Format::LightTools, "x.bsdf").expect("a file");
            let [part] = &back.parts[..] else { panic!("{back:?}") };
            assert_eq!(part.side, Some(Side::Front));
            assert_eq!(part.data.representation().channels(), channels);
            assert_alike(&part.data, &data, &BETWEEN, 1e-7);
            assert_eq!(back.tis.len(), 3 * phi_i.len() * channels.count());
        }
    }
}

/// The stated total is the integral of the values: pi times a constant.
#[test]
fn light_tools_files_state_their_totals() {
    let grid = grid(Scatter::Reflection, &[0.0], &TURN, Channels::Mono);
    let values = vec![0.2; grid.values().len()];
    let flat = spherical::Data::new(Scatter::Reflection, grid.knots().clone(), Channels::Mono, values).expect("a grid");
    let back = round_trip(&Document::new(flat), Format::LightTools, "x.bsdf").expect("a file");
    for total in back.tis {
        assert!((f64::from(total) - 0.2 * std::f64::consts::PI).abs() < 1e-4, "{total}");
    }
}

#[test]
fn light_tools_halves_and_sheets_come_back() {
    let half = grid(Scatter::Reflection, &[0.0], &[0.0, 30.0, 90.0, 150.0, 180.0], Channels::Mono);
    let half: Data = half.mirrored().expect("half").into();
    let through: Data = grid(Scatter::Reflection, &[0.0], &[0.0, 30.0, 90.0, 150.0, 180.0], Channels::Mono)
        .mirrored()
        .expect("half")
        .into();
    let part = |side, data: &Data| Part { name: String::new(), side: Some(side), data: data.clone() };
    let mut document = Document::of_parts(vec![part(Side::Front, &half), part(Side::Back, &through)]);
    document.source.push((RESAMPLED.into(), "from a file; off by 1 %".into()));
    let back = round_trip(&document, Format::LightTools, "x.bsdf").expect("a file");
    assert_eq!(back.parts.len(), 2);
    assert!(back.source.iter().any(|(_, fact)| fact == "resampled from a file; off by 1 %"), "{:?}", back.source);
    for part in &back.parts {
        assert_alike(&part.data, &half, &BETWEEN, 1e-7);
    }
}

#[test]
fn what_light_tools_cannot_express_is_refused() {
    let message =
        |grid: spherical::Data| round_trip(&Document::new(grid), Format::LightTools, "x.bsdf").expect_err("an error");
    let rgb = grid(Scatter::Reflection, &[0.0], &TURN, Channels::Rgb);
    assert!(message(rgb).contains("the channels R G B"));
    let sparse = grid(Scatter::Reflection, &[0.0], &[0.0, 180.0], Channels::Mono);
    assert!(message(sparse).contains("steps of less than half a turn"));
    let short = grid(Scatter::Reflection, &[0.0], &TURN, Channels::Spectral(vec![0.5, 0.6]));
    assert!(message(short).contains("wavelengths of 50 nm"));
    let mut open = grid(Scatter::Reflection, &[0.0], &TURN, Channels::Mono);
    let mut values = open.values().to_vec();
    values[8] *= 2.0;
    open = spherical::Data::new(Scatter::Reflection, open.knots().clone(), Channels::Mono, values).expect("a grid");
    assert!(message(open).contains("the ends of a whole turn"));
}

/// Nodes keep their values. Between them, samples are interpolated differently, though not by much on a dense grid.
#[test]
fn speos_tables_come_back() {
    let nm = Channels::Spectral(vec![400.0, 633.0]);
    for scatter in [Scatter::Reflection, Scatter::Transmission] {
        let data: Data = grid(scatter, &[0.0], &TURN, nm.clone()).into();
        for name in ["x.brdf", "x.anisotropicbsdf"] {
            let back = round_trip(&Document::new(data.clone()), Format::Speos, name).expect("a file");
            let found = back.only().expect("one measurement");
            assert_eq!((found.representation().scatter(), found.representation().channels()), (scatter, nm.clone()));
            assert!(found.representation().is_isotropic());
            assert_alike(found, &data, &[([20.0, 0.0], [40.0, 45.0]), ([55.5, 0.0], [75.0, 270.0])], 1e-6);
            assert_alike(found, &data, &[([20.0, 33.0], [40.0, 45.0 + 33.0])], 1e-6);
            assert_alike(found, &data, &BETWEEN, 0.05);
        }
    }
}

#[test]
fn rotations_of_speos_come_back() {
    let turn = [0.0, 60.0, 120.0, 180.0, 240.0, 300.0];
    let data = grid(Scatter::Reflection, &turn, &TURN, Channels::Spectral(vec![360.0, 830.0]));
    let data: Data = data.into();
    let back = round_trip(&Document::new(data.clone()), Format::Speos, "x.anisotropicbsdf").expect("a file");
    let found = back.only().expect("one measurement");
    assert!(!found.representation().is_isotropic());
    for phi in [0.0, 60.0, 240.0] {
        assert_alike(found, &data, &[([20.0, phi], [40.0, 45.0]), ([55.5, phi], [75.0, 270.0])], 1e-6);
    }
    let error = round_trip(&Document::new(data), Format::Speos, "x.brdf").expect_err("an error");
    assert!(error.contains("an anisotropic material; expected an isotropic one in .brdf"), "{error}");
}

#[test]
fn halves_and_both_kinds_of_scatter_fit_into_a_speos_file() {
    let nm = Channels::Spectral(vec![500.0]);
    let half: Data = grid(Scatter::Reflection, &[0.0], &[0.0, 30.0, 90.0, 150.0, 180.0], nm.clone())
        .mirrored()
        .expect("half")
        .into();
    let through: Data = grid(Scatter::Transmission, &[0.0], &TURN, nm).into();
    let document = Document::of_parts(vec![Part::new("", half.clone()), Part::new("", through.clone())]);
    for name in ["x.brdf", "x.anisotropicbsdf"] {
        let back = round_trip(&document, Format::Speos, name).expect("a file");
        assert_eq!(back.parts.len(), 2, "{name}");
        assert_alike(&back.parts[0].data, &half, &[([20.0, 0.0], [40.0, 30.0]), ([20.0, 0.0], [40.0, 330.0])], 1e-6);
        assert_alike(&back.parts[1].data, &through, &[([20.0, 0.0], [40.0, 45.0])], 1e-6);
    }
}

#[test]
fn what_speos_cannot_express_is_refused() {
    let message = |grid: spherical::Data, name: &str| {
        round_trip(&Document::new(grid), Format::Speos, name).expect_err("an error")
    };
    let mono = grid(Scatter::Reflection, &[0.0], &TURN, Channels::Mono);
    assert!(message(mono, "x.brdf").contains("expected wavelengths"));
    let nm = Channels::Spectral(vec![400.0, 600.0]);
    let coloured = grid(Scatter::Reflection, &[0.0, 120.0, 240.0], &TURN, nm.clone());
    let values = coloured.values().iter().enumerate().map(|(index, f)| if index % 50 == 7 { 2.0 * f } else { *f });
    let values: Vec<f32> = values.collect();
    let coloured =
        spherical::Data::new(Scatter::Reflection, coloured.knots().clone(), nm.clone(), values).expect("a grid");
    assert!(message(coloured, "x.anisotropicbsdf").contains("a spectrum that depends on the directions"));
    let dark = grid(Scatter::Reflection, &[0.0], &TURN, nm.clone());
    let values: Vec<f32> = dark.values().iter().map(|f| -f).collect();
    let dark = spherical::Data::new(Scatter::Reflection, dark.knots().clone(), nm, values).expect("a grid");
    assert!(message(dark, "x.brdf").contains("expected a positive one"));
}

/// Files written by another program come back the same, sample by sample.
#[test]
fn real_speos_files_come_back() {
    let Some(shared) = shared() else { return };
    for path in files(&shared.join("data/speos_anisotropicbsdf")) {
        let (_, document) = open(&path).expect("a file");
        let back = round_trip(&document, Format::Speos, "x.anisotropicbsdf").expect("a file");
        for (found, expected) in back.parts.iter().zip(&document.parts) {
            let (Data::Scattered(found), Data::Scattered(expected)) = (&found.data, &expected.data) else {
                panic!("other data")
            };
            let pairs = found.samples().zip(expected.samples());
            let (mut count, mut largest) = (0, 0.0_f32);
            for ((found_at, found), (at, expected)) in pairs {
                assert!((found_at[2] - at[2]).abs() < 1e-6, "{found_at:?} for {at:?}");
                for (found, expected) in found.iter().zip(expected) {
                    largest = largest.max((found - expected).abs() / expected.abs().max(1e-9));
                    count += 1;
                }
            }
            assert!(count > 1000 && largest < 1e-5, "{largest} of {count} in {}", path.display());
        }
    }
}

#[test]
fn mdl_files_state_how_they_were_made() {
    let thetas: Vec<f64> = (0..6).map(|i| std::f64::consts::FRAC_PI_2 * f64::from(i) / 6.0).collect();
    let phis: Vec<f64> = (0..5).map(|i| std::f64::consts::PI * f64::from(i) / 4.0).collect();
    let values: Vec<f32> = (0..6 * 6 * 5).map(|index| index as f32 * 0.01).collect();
    let knots = [thetas.clone(), vec![0.0], thetas, phis];
    let grid = spherical::Data::new(Scatter::Reflection, knots, Channels::Mono, values).expect("a grid");
    let grid = grid.mirrored().expect("half");
    let mut document = Document::new(grid.clone());
    document.source.push((RESAMPLED.into(), "from a file".into()));
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("x.mbsdf");
    (Format::Mbsdf.writer().expect("a writer").write)(&document, &path).expect("written");
    let bytes = std::fs::read(&path).expect("the file");
    assert!(bytes.windows(23).any(|bytes| bytes == b"\nresampled from a file\n"));
    let back = lobe_formats::mbsdf::read(&bytes, Path::new("x")).expect("a file");
    assert_eq!(back.reflection, Some(grid));
}
