//! Conversion of tables from format to format and back: nothing may be lost except what a format cannot express.

use std::f64::consts::{PI, TAU};
use std::io::Read as _;
use std::path::Path;

use lobe_formats::goniometer;
use lobe_formats::ssdd::{self, Encoding};
use lobe_formats::{Format, Part, ddr, npz, open, zemax};
use lobe_table::{Channels, Data, Scatter, specular, spherical};
use lobe_testing::files::fixture;

type Writer = fn(&specular::Data, &Path);

const FIXTURES: [&str; 2] = ["conductor-7x8x13.ddr", "cloth-17x7x17x13.ddr"];

fn table(path: &Path) -> specular::Data {
    let (_, mut document) = open(path).expect("a file of a known format");
    match document.parts.pop().map(|part| part.data) {
        Some(Data::Specular(samples)) => samples,
        other => panic!("{other:?}"),
    }
}

/// The same table with one channel.
fn first_channel(samples: &specular::Data, scatter: Scatter, channels: Channels) -> specular::Data {
    let (from, to) = (samples.channels().count(), channels.count());
    let values = samples.values().chunks_exact(from).flat_map(|texel| texel[..to].to_vec()).collect();
    specular::Data::new(scatter, samples.knots().clone(), channels, values).expect("a table")
}

#[test]
fn ddr_files_are_written_back_unchanged() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in FIXTURES {
        let original = std::fs::read_to_string(fixture(name)).expect("a fixture");
        let copy = folder.path().join(name);
        ddr::write(&table(&fixture(name)), &copy).expect("written");
        let written = std::fs::read_to_string(&copy).expect("written");
        assert!(written == original, "{name}: the copy is another file");
    }
}

#[test]
fn conversion_through_ssdd_and_csv_loses_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in FIXTURES {
        let samples = table(&fixture(name));
        let expected = ddr::text(&samples, Path::new("x.ddr")).expect("a DDR");
        let ways: [(&str, Writer); 3] = [
            ("ascii.ssdd", |samples, path| {
                let part = Part::new("a name", Data::Specular(samples.clone()));
                ssdd::write(&[part], Encoding::Ascii, path).expect("written");
            }),
            ("binary.ssdd", |samples, path| {
                let part = Part::new("a name", Data::Specular(samples.clone()));
                ssdd::write(&[part], Encoding::Binary, path).expect("written");
            }),
            ("table.csv", |samples, path| goniometer::write(&Data::Specular(samples.clone()), path).expect("written")),
        ];
        for (way, write) in ways {
            let path = folder.path().join(way);
            write(&samples, &path);
            let back = table(&path);
            assert_eq!(back.values(), samples.values(), "{name} through {way}");
            assert!(ddr::text(&back, Path::new("x.ddr")).expect("a DDR") == expected, "{name} through {way}");
        }
    }
}

#[test]
fn zemax_files_are_restored_with_their_total_scatter() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("table.bsdf");
    let samples = table(&fixture(FIXTURES[0]));
    for (scatter, channels) in [(Scatter::Reflection, Channels::Xyz), (Scatter::Transmission, Channels::Mono)] {
        let samples = first_channel(&samples, scatter, channels.clone());
        zemax::write(&samples, &path).expect("written");
        let (format, back) = open(&path).expect("a Zemax file");
        assert_eq!(format, Format::Zemax);
        assert!(matches!(back.only(), Some(Data::Specular(found)) if *found == samples));
        assert_eq!(back.tis.len(), 7 * channels.count());
        // Between its few knots at grazing incidence, the table reflects slightly more than the metal: 1.03.
        assert!(back.tis.iter().all(|tis| (0.1..1.04).contains(tis)), "{:?}", back.tis);
    }
    // A Lambertian table of reflectance 0.6 scatters that much for every incident direction.
    let knots = [vec![0.0, 1.2], vec![0.0], vec![0.0, 1.0, PI], vec![0.0, TAU]];
    let value = (0.6 / PI) as f32;
    let white = specular::Data::new(Scatter::Reflection, knots, Channels::Mono, vec![value; 12]).expect("a table");
    zemax::write(&white, &path).expect("written");
    let Ok((_, back)) = open(&path) else { panic!("no table") };
    assert!(back.tis.iter().all(|tis| (tis - 0.6).abs() < 1e-3), "{:?}", back.tis);
}

#[test]
fn zemax_files_refuse_what_they_cannot_express() {
    let samples = table(&fixture(FIXTURES[0]));
    let refused = |samples: &specular::Data| {
        let error = zemax::write(samples, Path::new("nowhere/x.bsdf")).expect_err("not for this format");
        error.to_string()
    };
    assert_eq!(
        refused(&samples),
        "nowhere/x.bsdf: found the channels R G B; expected one channel or X Y Z in this format"
    );
    let mono = first_channel(&samples, Scatter::Transmission, Channels::Mono);
    let bent = mono.with_refraction(vec![0.1; 7]).expect("offsets");
    assert_eq!(refused(&bent), "nowhere/x.bsdf: found refraction offsets; expected none in this format");
}

#[test]
fn columns_hold_every_kind_of_grid() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("table.csv");
    let values: Vec<f32> = (0..2 * 3 * 4).map(|i| i as f32 / 7.0).collect();
    let knots = [vec![0.0, 0.5], vec![0.0], vec![0.1, 0.2, 0.3], vec![0.0, 1.0, 3.0, 6.0]];
    let grid = spherical::Data::new(Scatter::Transmission, knots, Channels::Mono, values).expect("a grid");
    goniometer::write(&Data::Spherical(grid.clone()), &path).expect("written");
    let (_, document) = open(&path).expect("a table");
    let Some(Data::Spherical(back)) = document.only() else { panic!("no grid") };
    assert_eq!((back.scatter(), back.values()), (Scatter::Transmission, grid.values()));
    for (knot, expected) in back.knots().concat().iter().zip(grid.knots().concat()) {
        assert!((knot - expected).abs() < 1e-10);
    }

    // A table that is constant in phi stays so.
    let knots = [vec![0.0, 1.0], vec![0.0], vec![0.0, 0.5, 1.0], vec![0.0]];
    let channels = Channels::Spectral(vec![450.0, 632.8]);
    let ring = specular::Data::new(Scatter::Reflection, knots, channels.clone(), (0..12).map(|i| i as f32).collect());
    goniometer::write(&Data::Specular(ring.expect("a table")), &path).expect("written");
    let back = table(&path);
    assert_eq!(back.channels(), &channels);
    for node in 0..6 {
        for phi in 0..2 {
            let at = [node / 3, 0, node % 3, phi];
            assert_eq!(back.texel(at), [2.0 * node as f32, 2.0 * node as f32 + 1.0], "{at:?}");
        }
    }
}

#[test]
fn columns_of_scattered_samples_are_read_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let (first, second) = (folder.path().join("a.csv"), folder.path().join("b.csv"));
    std::fs::write(&first, "theta_i,theta_o,phi_o,550nm\n10,0,0,0.5\n10,20,0,0.25\n10,20,140,0.125\n")
        .expect("written");
    let (_, samples) = open(&first).expect("samples");
    let Some(Data::Scattered(samples)) = samples.only() else { panic!("not scattered") };
    goniometer::write(&Data::Scattered(samples.clone()), &second).expect("written");
    let (_, back) = open(&second).expect("samples");
    let Some(Data::Scattered(back)) = back.only() else { panic!("not scattered") };
    assert_eq!(back.channels(), samples.channels());
    let sorted = |data: &lobe_table::scattered::Data| {
        let mut all: Vec<String> = data.samples().map(|(angles, f)| format!("{angles:.9?} {f:?}")).collect();
        all.sort();
        all
    };
    assert_eq!(sorted(back), sorted(samples));
}

/// Values at many pairs of directions, on both sides, as bits.
fn bits(data: &Data) -> Vec<u32> {
    use lobe_table::Directions;
    let prepared = data.representation().prepare(&lobe_table::Options::default()).expect("prepared");
    let direction = |n: f32| {
        let (z, phi) = (0.02 + 0.97 * (n * 0.618_034).fract(), n * 2.4);
        let r = (1.0 - z * z).sqrt();
        [r * phi.cos(), r * phi.sin(), z]
    };
    let wi: Vec<[f32; 3]> = (0..3000).map(|n| direction(n as f32)).collect();
    let is_transmission = data.representation().scatter() == Scatter::Transmission;
    let below = |[x, y, z]: [f32; 3]| [x, y, if is_transmission { -z } else { z }];
    let wo: Vec<[f32; 3]> = (0..3000).map(|n| below(direction(0.37 + 1.7 * n as f32))).collect();
    let mut out = vec![0.0; wi.len() * data.representation().channels().count()];
    let backend = lobe_backend::Backend::best().strict();
    prepared.eval_batch(backend, Directions::from(&wi[..]), Directions::from(&wo[..]), &mut out);
    out.into_iter().map(f32::to_bits).collect()
}

/// Writes and reads a document of any kind.
fn through_csv(data: &Data) -> Data {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.csv");
    goniometer::write(data, &path).expect("written");
    let (_, mut document) = open(&path).expect("a table");
    document.parts.pop().expect("one part").data
}

#[test]
fn samples_on_circles_are_interpolated_as_before() {
    // Four neighbours of a ring are on a circle, so either diagonal is as good, and rounding decides.
    for (step, turn, lights) in [(15.0, 180.0, vec![(0.0, 0.0), (15.0, 15.0)]), (7.3, 0.1, vec![(33.3, 12.3)])] {
        for scatter in [Scatter::Reflection, Scatter::Transmission] {
            let mut angles = Vec::new();
            for (theta_i, phi_i) in &lights {
                for ring in 0..6 {
                    let around = (360.0_f64 / step) as usize;
                    let angle = |at: usize| [*theta_i, phi_i + turn, 3.7 * f64::from(ring), step * at as f64];
                    angles.extend((0..around).map(|at| angle(at).map(f64::to_radians)));
                }
            }
            let values: Vec<f32> = (0..angles.len()).map(|i| (i * 7919 % 1000) as f32 / 999.0).collect();
            let data = lobe_table::scattered::Data::new(scatter, Channels::Mono, &angles, &values).expect("samples");
            let data = Data::Scattered(data);
            let back = through_csv(&data);
            assert!(matches!(back, Data::Scattered(_)), "{step}");
            assert!(bits(&back) == bits(&data), "{step}: other values than before");
        }
    }
}

#[test]
fn samples_at_grid_nodes_stay_samples_and_half_a_grid_stays_a_grid() {
    let mut angles = Vec::new();
    for theta_i in [0.2, 0.7] {
        for theta_o in [0.3, 0.9] {
            angles.extend((0..8).map(|step| [theta_i, 0.0, theta_o, f64::from(step) * PI / 4.0]));
        }
    }
    let values: Vec<f32> = (0..angles.len()).map(|i| (i * 37 % 11) as f32).collect();
    let samples = lobe_table::scattered::Data::new(Scatter::Reflection, Channels::Mono, &angles, &values);
    let samples = Data::Scattered(samples.expect("samples"));
    let back = through_csv(&samples);
    assert!(matches!(back, Data::Scattered(_)) && bits(&back) == bits(&samples));

    for (azimuths, is_mirrored) in [(vec![0.0, 1.0, PI], true), (vec![0.5], true), (vec![0.2, 1.0, 2.0], false)] {
        let knots = [vec![0.0, 0.5, 1.2], vec![0.0], vec![0.0, 0.6], azimuths];
        let values: Vec<f32> = (0..6 * knots[3].len()).map(|i| (i * 5 % 7) as f32).collect();
        let grid = spherical::Data::new(Scatter::Reflection, knots, Channels::Mono, values).expect("a grid");
        let grid = if is_mirrored { grid.mirrored().expect("half a grid") } else { grid };
        let Data::Spherical(back) = through_csv(&Data::Spherical(grid.clone())) else { panic!("no grid") };
        assert_eq!((back.is_mirrored(), back.values()), (is_mirrored, grid.values()));
        for (knot, expected) in back.knots().concat().iter().zip(grid.knots().concat()) {
            assert!((knot - expected).abs() < 1e-10);
        }
    }
    // The comment has to be true.
    let wrong = "# rows: nodes of a grid\ntheta_i,theta_o,phi_o,Y\n0,0,0,1\n0,10,0,1\n0,20,90,1\n";
    let error = lobe_formats::from_bytes(wrong.as_bytes(), Path::new("a.csv")).expect_err("no grid");
    assert!(error.to_string().contains("each node of a grid once"), "{error}");
}

/// The parts that NumPy reads: the dictionary of the header and the data after it.
fn member(archive: &mut zip::ZipArchive<std::fs::File>, name: &str) -> (String, Vec<u8>) {
    let mut bytes = Vec::new();
    archive.by_name(name).expect(name).read_to_end(&mut bytes).expect("stored bytes");
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let end = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    assert_eq!((end % 64, bytes[end - 1]), (0, b'\n'));
    let data = bytes.split_off(end);
    (String::from_utf8_lossy(&bytes[10..]).trim_end().into(), data)
}

#[test]
fn arrays_have_names_shapes_and_values() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("table.npz");
    let (_, document) = open(&fixture(FIXTURES[0])).expect("a DDR");
    npz::write(&document, &path).expect("written");
    let Some(Data::Specular(samples)) = document.only() else { panic!("no table") };
    let mut archive = zip::ZipArchive::new(std::fs::File::open(&path).expect("written")).expect("an archive");
    let (header, data) = member(&mut archive, "values.npy");
    assert_eq!(header, "{'descr': '<f4', 'fortran_order': False, 'shape': (7, 1, 8, 13, 3,), }");
    let values: Vec<f32> = data.as_chunks().0.iter().map(|x| f32::from_le_bytes(*x)).collect();
    assert_eq!(values, samples.values());
    let (header, data) = member(&mut archive, "theta.npy");
    assert_eq!(header, "{'descr': '<f8', 'fortran_order': False, 'shape': (8,), }");
    let knots: Vec<f64> = data.as_chunks().0.iter().map(|x| f64::from_le_bytes(*x)).collect();
    assert_eq!(knots, samples.knots()[2]);
    let (header, data) = member(&mut archive, "scatter.npy");
    assert_eq!(header, "{'descr': '<U10', 'fortran_order': False, 'shape': (), }");
    assert_eq!((data.len(), &data[..8]), (40, &b"r\0\0\0e\0\0\0"[..]));
}
