//! Lists of samples, written and read again.

use std::path::Path;

use lobe_formats::{Document, Format, astm, fred};
use lobe_table::{Channels, Data, Scatter, scattered, specular};

fn written(document: &Document, format: Format) -> Result<Vec<u8>, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("written");
    let writer = format.writer().expect("a writer");
    (writer.write)(document, &path).map_err(|error| error.to_string())?;
    Ok(std::fs::read(&path).expect("the file"))
}

/// Three incident directions of an anisotropic sample, with values that need all digits.
fn samples(channels: Channels) -> scattered::Data {
    let mut angles = Vec::new();
    for (theta_i, phi_i) in [(0.0, 0.0), (0.3, 0.1), (0.7, 4.0)] {
        for index in 0..12_u8 {
            let index = f64::from(index);
            angles.push([theta_i, phi_i, 0.1 + 0.11 * index, 0.7 + 0.51 * index]);
        }
    }
    let count = angles.len() * channels.count();
    let values: Vec<f32> = (0..count).map(|index| 0.1 / (1.0 + index as f32)).collect();
    scattered::Data::new(Scatter::Reflection, channels, &angles, &values).expect("samples")
}

fn assert_same(found: &scattered::Data, expected: &scattered::Data) {
    assert_eq!(found.channels(), expected.channels());
    assert_eq!(found.samples().count(), expected.samples().count());
    for ((found, values), (angles, expected)) in found.samples().zip(expected.samples()) {
        assert_eq!(values, expected, "at {angles:?}");
        let turns = std::f64::consts::TAU;
        for (found, angle) in found.into_iter().zip(angles) {
            let apart = (found - angle).rem_euclid(turns);
            assert!(apart.min(turns - apart) < 1e-12, "{found} for {angle}");
        }
    }
}

#[test]
fn samples_come_back() {
    for channels in [Channels::Mono, Channels::Rgb, Channels::Xyz, Channels::Spectral(vec![400.5, 550.0])] {
        let expected = samples(channels);
        let bytes = written(&Document::new(expected.clone()), Format::Astm).expect("a file");
        assert!(astm::matches(&bytes));
        assert_same(&astm::read(&bytes, Path::new("x")).expect("the same"), &expected);
    }
    let expected = samples(Channels::Mono);
    let bytes = written(&Document::new(expected.clone()), Format::Fred).expect("a file");
    assert!(fred::matches(&bytes));
    assert_same(&fred::read(&bytes, Path::new("x")).expect("the same"), &expected);
}

/// Which of two equally good triangles a query is in depends on the last digit of an angle.
#[test]
fn fred_keeps_angles_of_whole_degrees_exactly() {
    let mut angles = Vec::new();
    for theta_i in 0..8_u8 {
        for theta_o in 0..17_u8 {
            for phi_o in 0..24_u8 {
                let degrees = [10 * theta_i, 0, 5 * theta_o].map(f64::from);
                let [theta_i, phi_i, theta_o] = degrees.map(f64::to_radians);
                angles.push([theta_i, phi_i, theta_o, (15.0 * f64::from(phi_o)).to_radians()]);
            }
        }
    }
    let values = vec![1.0; angles.len()];
    let expected = scattered::Data::new(Scatter::Reflection, Channels::Mono, &angles, &values).expect("samples");
    let bytes = written(&Document::new(expected.clone()), Format::Fred).expect("a file");
    let found = fred::read(&bytes, Path::new("x")).expect("the same");
    let bits = |data: &scattered::Data| data.samples().map(|(angles, _)| angles.map(f64::to_bits)).collect::<Vec<_>>();
    assert_eq!(bits(&found), bits(&expected));
}

/// Tables of Speos are turned by half a turn when they are read, which leaves azimuths that no rounded degrees restore.
#[test]
fn angles_come_back_to_the_last_bit() {
    // FRED adds half a turn to the azimuth of the light, of which small ones lose digits.
    for (light, is_held_by_fred) in [(0.0, true), (std::f64::consts::PI, true), (4.0, true), (0.1, false)] {
        let mut angles = Vec::new();
        for theta_i in [0.0_f64, 20.0, 45.0] {
            for theta_o in 1..17_u8 {
                for phi_o in 0..24_u8 {
                    let phi_o = (15.0 * f64::from(phi_o)).to_radians() + std::f64::consts::PI;
                    angles.push([theta_i.to_radians(), light, (5.0 * f64::from(theta_o)).to_radians(), phi_o]);
                }
            }
        }
        let values = vec![1.0; angles.len()];
        let expected = scattered::Data::new(Scatter::Reflection, Channels::Mono, &angles, &values).expect("samples");
        let bits = |data: &scattered::Data| -> Vec<[u64; 4]> {
            data.relative_samples().map(|(angles, _)| angles.map(f64::to_bits)).collect()
        };
        let document = Document::new(expected.clone());
        let bytes = written(&document, Format::Fred).expect("a file");
        let found = fred::read(&bytes, Path::new("x")).expect("the same");
        assert_eq!(bits(&found) == bits(&expected), is_held_by_fred, "FRED, {light}");
        assert_same(&found, &expected);
        let bytes = written(&document, Format::Astm).expect("a file");
        assert_eq!(bits(&astm::read(&bytes, Path::new("x")).expect("the same")), bits(&expected), "ASTM, {light}");
    }
}

/// Between the nodes, samples are interpolated differently; at the nodes, the values are the same.
#[test]
fn tables_are_listed_by_their_nodes() {
    let degrees = |list: &[f64]| list.iter().map(|angle| angle.to_radians()).collect::<Vec<_>>();
    let around: Vec<f64> = (0..=12).map(|index| 30.0 * f64::from(index)).collect();
    let knots = [
        degrees(&[0.0, 20.0, 40.0, 60.0]),
        vec![0.0],
        degrees(&[0.0, 5.0, 15.0, 30.0, 60.0, 90.0, 180.0]),
        degrees(&around),
    ];
    // Smooth in the directions, so that a pole has one value and a turn ends with the value that it began with.
    let mut values = Vec::new();
    for &sigma in &knots[0] {
        for &theta in &knots[2] {
            for &phi in &knots[3] {
                let (_, [x, y, z]) = specular::coords::angles_to_directions([sigma, 0.0, theta, phi], |sigma| sigma);
                values.extend([2.0 + x, 2.0 + y * y, 2.0 + z].map(|value| value as f32));
            }
        }
    }
    let table = specular::Data::new(Scatter::Reflection, knots, Channels::Rgb, values).expect("a table");
    let bytes = written(&Document::new(table.clone()), Format::Astm).expect("a file");
    let found = astm::read(&bytes, Path::new("x")).expect("samples");
    assert!(found.is_isotropic() && found.incidences().count() == 4);
    let mut checked = 0;
    for (sigma, &angle) in table.knots()[0].iter().enumerate() {
        for theta in 0..6 {
            for phi in 0..12 {
                let at = [angle, 0.0, table.knots()[2][theta], table.knots()[3][phi]];
                let (wi, wo) = specular::coords::angles_to_directions(at, |sigma| sigma);
                if wo[2] < 0.01 {
                    continue;
                }
                checked += 1;
                let (value, expected) = (found.eval(wi, wo)[1], table.texel([sigma, 0, theta, phi])[1]);
                assert!((value - expected).abs() < 1e-5 * expected, "{value} for {expected} at {at:?}");
            }
        }
    }
    assert!(checked > 150, "{checked}");
}

#[test]
fn what_these_formats_cannot_express_is_refused() {
    let message = |data: Data, format| written(&Document::new(data), format).expect_err("an error");
    assert!(message(samples(Channels::Rgb).into(), Format::Fred).contains("the channels R G B"));
    let passing = scattered::Data::new(Scatter::Transmission, Channels::Mono, &[[0.0; 4]], &[1.0]).expect("a sample");
    let nm = Channels::Spectral(vec![532.0]);
    assert!(message(samples(nm).into(), Format::Fred).contains("the wavelength 532nm"));
    for format in [Format::Astm, Format::Fred] {
        assert!(message(passing.clone().into(), format).contains("of a reflectance"));
        let writer = format.writer().expect("a writer");
        assert!(!(writer.holds)(&Document::new(passing.clone())));
    }
}
