//! Formats that hold grids or both sides of a sheet: their meaning, and refused files.

use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;

use lobe_formats::goniometer::Unit;
use lobe_formats::reading::{Holds, ReadOptions};
use lobe_formats::ssdd::Encoding;
use lobe_formats::{FormatError, Part, Place, astm, goniometer, light_tools, speos, ssdd};
use lobe_table::{Channels, Data, Scatter, Side, mirror, specular, spherical};
use lobe_testing::examples::{ASTM, JSON, LIGHT_TOOLS, SSDD, csv, speos_file};
use lobe_testing::files::{bytes, files, shared};

fn file() -> &'static Path {
    Path::new("file")
}

fn direction(theta: f64, phi: f64) -> [f64; 3] {
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

fn degrees(theta: f64, phi: f64) -> [f64; 3] {
    direction(theta.to_radians(), phi.to_radians())
}

#[track_caller]
fn refused<T>(result: Result<T, FormatError>, place: Place, found: &str) {
    let error = result.map(|_| ()).expect_err("a refusal");
    assert_eq!(error.place, place, "{error}");
    assert!(error.found.contains(found), "{error}");
}

#[test]
fn ssdd_blocks_are_put_in_order_and_unfolded() {
    assert!(ssdd::matches(SSDD.as_bytes()));
    let blocks = ssdd::read(SSDD.as_bytes(), file()).unwrap_or_else(|error| panic!("{error}"));
    let Data::Specular(samples) = &blocks[0].data else { panic!("specular coordinates") };
    assert_eq!((blocks[0].name.as_str(), samples.scatter()), ("thin film", Scatter::Transmission));
    let phis: Vec<f64> = samples.knots()[3].iter().map(|phi| phi.to_degrees().round()).collect();
    assert_eq!(phis, [0.0, 90.0, 180.0, 270.0, 360.0]);
    assert_eq!(samples.texel([1, 0, 0, 0]), [1.0, 0.0, 1.0]);
    assert_eq!(samples.texel([0, 0, 1, 0])[0], 2.0);
    assert_eq!([1, 2, 3, 4].map(|phi| samples.texel([1, 0, 1, phi])[0]), [7.0, 11.0, 7.0, 3.0]);
    assert_eq!(samples.refraction().map(|offsets| offsets[1].to_degrees().round()), Some(-5.0));
    let Data::Mirror(mirror) = &blocks[1].data else { panic!("a mirror") };
    assert_eq!((mirror.values(), mirror.knots()[1].as_slice()), ([0.04, 1.0].as_slice(), [0.0].as_slice()));
}

#[test]
fn ssdd_survives_a_round_trip() {
    let radians = |angles: &[f64]| angles.iter().map(|angle| f64::to_radians(*angle)).collect::<Vec<_>>();
    let knots =
        [radians(&[0.0, 15.0, 77.5]), radians(&[0.0, 120.0]), radians(&[0.0, 30.1]), radians(&[0.0, 90.0, 360.0])];
    let values: Vec<f32> = (0..36 * 2).map(|index| (index as f32 * 0.7).sin()).collect();
    let channels = Channels::Spectral(vec![400.0, 700.5]);
    let samples =
        specular::Data::new(Scatter::Reflection, knots.clone(), channels.clone(), values.clone()).expect("samples");
    let grid = spherical::Data::new(Scatter::Transmission, knots, channels, values).expect("a grid");
    let knots = [radians(&[0.0, 90.0]), vec![0.0]];
    let values = vec![0.1, 0.2, 0.3, 1.0, 1.0, 1.0];
    let mirror = mirror::Data::new(Scatter::Reflection, knots, Channels::Xyz, values).expect("a mirror");
    let blocks = [
        Part::new("a b", Data::Specular(samples)),
        Part::new("", Data::Spherical(grid)),
        Part::new("c", Data::Mirror(mirror)),
    ];
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("table.ssdd");
    for encoding in [Encoding::Ascii, Encoding::Binary] {
        ssdd::write(&blocks, encoding, &path).expect("a written file");
        let bytes = std::fs::read(&path).expect("the file");
        assert!(ssdd::matches(&bytes));
        let found = ssdd::read(&bytes, &path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(found.len(), 3);
        for (found, wanted) in found.iter().zip(&blocks) {
            assert_eq!(found.name, wanted.name);
            match (&found.data, &wanted.data) {
                (Data::Specular(a), Data::Specular(b)) => {
                    assert_eq!((a.values(), a.channels(), a.scatter()), (b.values(), b.channels(), b.scatter()));
                    let knots = a.knots().iter().flatten().zip(b.knots().iter().flatten());
                    assert!(knots.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 1e-11);
                }
                (Data::Spherical(a), Data::Spherical(b)) => {
                    assert_eq!((a.values(), a.channels(), a.scatter()), (b.values(), b.channels(), b.scatter()));
                }
                (Data::Mirror(a), Data::Mirror(b)) => assert_eq!(a, b),
                _ => panic!("another kind of block"),
            }
        }
        lobe_testing::damage::truncations(&bytes, |bytes| {
            ssdd::read(bytes, file()).is_ok_and(|blocks| blocks.len() == 3)
        });
    }
    let twice = [blocks[0].clone(), blocks[0].clone()];
    let refused = |parts: &[Part]| ssdd::write(parts, Encoding::Ascii, &path).unwrap_err().to_string();
    assert!(refused(&twice).contains("two of the same type"));
    assert!(refused(&[Part { side: Some(Side::Back), ..blocks[0].clone() }]).contains("one side of a sheet"));
}

#[test]
fn ssdd_refuses_what_it_cannot_express() {
    let change = |from: &str, to: &str| ssdd::read(SSDD.replace(from, to).as_bytes(), file());
    refused(change("specular_coordinate", "half_difference_coordinate"), Place::Line(5), "half_difference");
    refused(change("specular_coordinate", "distorted_spherical_coordinate"), Place::Line(5), "distorted");
    refused(change("bilateral_symmetry", "reciprocity"), Place::Line(6), "reciprocity");
    refused(change("11 0 1\n", "11 nan 1\n"), Place::Line(25), "nan");
    refused(change("11 0 1\n", "11 0\n"), Place::Line(25), "2 values");
    refused(change("PARAM0_LIST 0 60", "PARAM0_LIST 60 0"), Place::Line(25), "sigma");
    refused(change("DATA_TYPE specular_reflectance", "DATA_TYPE btdf"), Place::Line(29), "a second btdf");
}

#[test]
fn light_tools_has_the_light_at_azimuth_90() {
    assert!(light_tools::matches(LIGHT_TOOLS.as_bytes()));
    let parts = light_tools::read(LIGHT_TOOLS.as_bytes(), file()).unwrap_or_else(|error| panic!("{error}")).parts;
    assert_eq!((parts.len(), parts[0].side), (1, Some(Side::Front)));
    let Data::Spherical(grid) = &parts[0].data else { panic!("a grid") };
    let at = |phi: f64| grid.eval(degrees(30.0, 0.0), degrees(60.0, phi));
    assert!((at(0.0)[0] - 2.0).abs() < 1e-5 && (at(0.0)[1] - 6.0).abs() < 1e-5, "{:?}", at(0.0));
    assert!((at(90.0)[0] - 3.0).abs() < 1e-5 && (at(270.0)[0] - 3.0).abs() < 1e-5, "mirrored: {:?}", at(270.0));
    assert!((at(180.0)[0] - 4.0).abs() < 1e-5);
    let change = |from: &str, to: &str| light_tools::read(LIGHT_TOOLS.replace(from, to).as_bytes(), file());
    refused(change("AOI 0", "AOI 91"), Place::Line(11), "AOI 91");
    refused(change("AOI 0 ", ""), Place::Line(11), "a second table of AOI 30");
    refused(change("3 90 180 270", "2000000000 90"), Place::Line(4), "2000000000");
    refused(change("TrisZ TIS 1 9 9 9 9 9 9", "TrisZ"), Place::Line(14), "AOI 0, POI 0 without them");
    refused(change("3 90 180 270", "3 0 90 180"), Place::Line(14), "azimuths");
    lobe_testing::damage::truncations(LIGHT_TOOLS.as_bytes(), |bytes| light_tools::read(bytes, file()).is_ok());
}

#[test]
fn speos_tables_are_scaled_to_their_percentages() {
    for (kind, transmitted) in [("anisotropic", vec![0.1]), ("brdf", vec![0.1, 0.2])] {
        let text = speos_file(kind, 1);
        assert!(speos::matches(text.as_bytes()));
        let found = speos::read(text.as_bytes(), file()).unwrap_or_else(|error| panic!("{kind}: {error}"));
        let (reflection, transmission) =
            (found.reflection.expect("reflection"), found.transmission.expect("transmission"));
        assert_eq!(reflection.channels(), &Channels::Spectral(vec![400.0, 700.0]));
        let reflected = reflection.eval(degrees(30.0, 200.0), degrees(40.0, 3.0));
        let [x, y, z] = degrees(40.0, 3.0);
        let through = transmission.eval(degrees(30.0, 200.0), [x, y, -z]);
        let wanted = [0.5, 0.25].into_iter().chain(transmitted).map(|albedo| albedo / PI);
        for (found, wanted) in reflected.into_iter().chain(through).zip(wanted) {
            // The trapezoids of the integral are accurate to 1e-4 at steps of a degree.
            assert!((f64::from(found) / wanted - 1.0).abs() < 2e-4, "{kind}: {found}, not {wanted}");
        }
    }
    let change = |from: &str, to: &str| speos::read(speos_file("brdf", 1).replacen(from, to, 1).as_bytes(), file());
    refused(change("\n0\nComment", "\n1\nComment"), Place::Line(3), "binary");
    refused(change("91 5", "91 2000000000"), Place::Line(12), "2000000000");
    refused(change("1 2\n30", "1 2\n130"), Place::Line(9), "incident angle 130");
}

#[test]
fn hostile_speos_files_do_no_harm() {
    for kind in ["anisotropic", "brdf"] {
        let text = speos_file(kind, 1);
        for end in (0..text.len()).step_by(101) {
            let whole = speos::read(&text.as_bytes()[..end], file()).is_ok();
            assert!(!whole || end > text.len() / 2, "{kind} {end}");
        }
    }
}

#[test]
fn every_real_speos_file_loads() {
    let Some(shared) = shared() else { return };
    for path in files(&shared.join("data/speos_anisotropicbsdf")) {
        let found = speos::read(&bytes(&path), &path).unwrap_or_else(|error| panic!("{error}"));
        for part in [found.reflection, found.transmission].into_iter().flatten() {
            // The albedo at normal incidence, from the midpoints of a fine grid.
            let (mut albedo, (n, m)) = (0.0, (180, 90));
            for (i, j) in (0..n).flat_map(|i| (0..m).map(move |j| (i, j))) {
                let theta = (f64::from(i) + 0.5) / f64::from(n) * FRAC_PI_2;
                let [x, y, z] = direction(theta, (f64::from(j) + 0.5) / f64::from(m) * 2.0 * PI);
                let wo = if part.scatter() == Scatter::Transmission { [x, y, -z] } else { [x, y, z] };
                let weight = theta.sin() * theta.cos() * FRAC_PI_2 / f64::from(n) * 2.0 * PI / f64::from(m);
                albedo += f64::from(part.eval(degrees(8.0, 0.0), wo)[0]) * weight;
            }
            let name = path.file_name().expect("a name").to_string_lossy();
            let (kind, samples) = (part.scatter(), part.samples().count());
            println!("{name}: {kind:?}, {} incidences, {samples} samples, albedo {albedo:.3}", part.incidences().len());
            let wanted = match (&*name, kind) {
                ("aniso_bsdf.anisotropicbsdf", Scatter::Reflection) => 0.6227,
                ("Gaussian_Fresnel_10_deg.anisotropicbsdf", Scatter::Reflection) => 0.04,
                ("Gaussian_Fresnel_10_deg.anisotropicbsdf", Scatter::Transmission) => 0.95,
                other => panic!("{other:?}"),
            };
            assert!((albedo / wanted - 1.0).abs() < 0.03, "{name}: {albedo}, not {wanted}");
        }
    }
}

#[test]
fn astm_records_are_radians() {
    assert!(astm::matches(ASTM.as_bytes()));
    let data = astm::read(ASTM.as_bytes(), file()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(data.channels(), &Channels::Spectral(vec![400.0, 500.0]));
    assert_eq!(data.eval(direction(0.1, 0.0), direction(0.4, 1.0)), [3.0, 4.0]);
    let three = ASTM.replace("phi_i,", "").replace("0.1,0,", "0.1,");
    let found = astm::read(three.as_bytes(), file()).expect("records of three angles");
    assert_eq!(found.eval(direction(0.1, 0.0), direction(0.4, 1.0)), [3.0, 4.0]);
    refused(astm::read(ASTM.replace("POINTS 3", "POINTS 4").as_bytes(), file()), Place::File, "3 records");
    refused(astm::read(ASTM.replace("3,4\n", "3\n").as_bytes(), file()), Place::Line(6), "5 numbers");
    refused(astm::read(ASTM.replace("400nm", "a").as_bytes(), file()), Place::Line(3), "a,500nm");
    lobe_testing::damage::truncations(ASTM.as_bytes(), |bytes| astm::read(bytes, file()).is_ok());
}

#[test]
fn shape_and_unit_of_goniometer_tables_are_recognised() {
    let radian = 1_f64.to_radians();
    for (head, unit, delimiter) in
        [("phi_o,theta_i,theta_o,f", 1.0, ","), ("phi_o_rad,theta_i_rad,theta_o_rad,550nm", radian, ";")]
    {
        let text = csv(head, unit).replace(',', delimiter);
        assert!(goniometer::matches(text.as_bytes()), "{head}");
        let Ok(Data::Spherical(grid)) = goniometer::read(text.as_bytes(), file()) else { panic!("{head}: a grid") };
        assert!((grid.eval(degrees(40.0, 5.0), degrees(30.0, 95.0))[0] - 9.0).abs() < 1e-4, "{head}");
        assert_eq!(grid.knots().each_ref().map(Vec::len), [2, 1, 2, 4]);
    }
    let text = csv("phi_deg,sigma,theta,Y", 1.0);
    let Ok(Data::Specular(samples)) = goniometer::read(text.as_bytes(), file()) else { panic!("a grid") };
    assert_eq!(samples.texel([1, 0, 1, 1]), [9.0]);
    // With a row missing, it is not a grid, and the direction of each row is unchanged.
    let less = text.rsplit_once("\n").and_then(|(text, _)| text.rsplit_once('\n')).expect("lines").0;
    let Ok(Data::Scattered(data)) = goniometer::read(less.as_bytes(), file()) else { panic!("samples") };
    assert!(
        (data.eval(degrees(40.0, 0.0), degrees(40.0, 180.0))[0] - 5.5).abs() < 1.6,
        "a mean at the mirror direction"
    );
    let toward_light = data.eval(degrees(40.0, 0.0), degrees(10.0, 180.0))[0];
    assert!((toward_light - 8.0).abs() < 1e-4, "phi 0 leads from the mirror direction to the normal: {toward_light}");
    let options = ReadOptions { holds: Some(Holds::Transmission), unit: Some(Unit::Rad), ..ReadOptions::default() };
    let text = csv("phi_o,theta_i,theta_o,f", radian);
    let found = goniometer::read_with(text.as_bytes(), file(), &options).unwrap_or_else(|error| panic!("{error}"));
    assert!(matches!(found.only(), Some(Data::Spherical(grid)) if grid.scatter() == Scatter::Transmission));
}

#[test]
fn json_tables_have_one_list_per_column() {
    let text = JSON;
    assert!(goniometer::matches(text.as_bytes()));
    let Ok(Data::Scattered(data)) = goniometer::read(text.as_bytes(), file()) else { panic!("samples") };
    assert_eq!(data.channels(), &Channels::Rgb);
    assert_eq!(data.eval(degrees(10.0, 0.0), degrees(20.0, 90.0)), [3.0, 6.0, 9.0]);
    lobe_testing::damage::truncations(text.as_bytes(), |bytes| goniometer::read(bytes, file()).is_ok());
    refused(goniometer::read(text.replace("[7, 8, 9]", "[7, 8]").as_bytes(), file()), Place::File, "numbers in column");
    assert!(goniometer::read(format!("{{\"a\": {}", "[".repeat(1_000_000)).as_bytes(), file()).is_err());
}

#[test]
fn bad_tables_of_goniometers_are_refused() {
    let text = csv("phi_o,theta_i,theta_o,f", 1.0);
    let change = |from: &str, to: &str| goniometer::read(text.replace(from, to).as_bytes(), file());
    refused(change("theta_o", "theta_x"), Place::Line(2), "no column of theta_o");
    refused(change("phi_o", "theta_i_rad"), Place::Line(2), "a second column of theta_i");
    for word in ["x", "inf", "1e999", "1.5.2", "0x10"] {
        refused(change("90,10,30,13", &format!("90,10,30,{word}")), Place::Line(11), word);
    }
    refused(change("90,10,30,13", "nan,10,30,13"), Place::Line(11), "no phi_o");
    refused(change("90,10,30,13", "90,10,30"), Place::Line(11), "3 fields");
    refused(change("90,10,30,13", "90,10,95,13"), Place::Line(11), "theta_o");
    (0..text.len()).for_each(|end| {
        let _ = goniometer::read(&text.as_bytes()[..end], file());
    });
}
