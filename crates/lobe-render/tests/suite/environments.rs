//! Tests of environment images: every field of a header that changes radiances is taken into account, or the file is
//! refused.

use std::f32::consts::{PI, TAU};
use std::path::{Path, PathBuf};

use lobe_render::light::Environment;
use lobe_render::picture::{PictureError, read_environment};

const SIZE: [usize; 2] = [4, 2];

/// A picture of texels that all differ, as mantissas of the exponent 128: halves, quarters and so on of 1.
fn texel(x: usize, y: usize) -> [u8; 4] {
    [16 * (x as u8 + 1), 100 + 20 * y as u8, 40, 128]
}

fn expected(x: usize, y: usize) -> [f32; 3] {
    let [r, g, b, _] = texel(x, y);
    [r, g, b].map(|m| f32::from(m) / 256.0)
}

fn flat() -> Vec<u8> {
    (0..8).flat_map(|at| texel(at % 4, at / 4)).collect()
}

fn hdr(header: &str, size: &str, data: &[u8]) -> Vec<u8> {
    [format!("#?RADIANCE\n{header}\n{size}\n").as_bytes(), data].concat()
}

fn read(name: &str, bytes: &[u8]) -> Result<Environment, PictureError> {
    let folder = crate::common::folder();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    read_environment(&path, 0.0, 1.0)
}

/// The radiance in the middle of a texel.
fn at(sky: &Environment, [width, height]: [usize; 2], x: usize, y: usize) -> [f32; 3] {
    let (phi, theta) = (TAU * ((x as f32 + 0.5) / width as f32 - 0.5), PI * (y as f32 + 0.5) / height as f32);
    sky.radiance([theta.sin() * phi.sin(), theta.cos(), -theta.sin() * phi.cos()])
}

fn is_close(found: [f32; 3], expected: [f32; 3]) -> bool {
    found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= 1e-4 * b.abs().max(1e-3))
}

fn assert_picture(sky: &Environment, what: &str, factor: [f32; 3]) {
    for (x, y) in (0..8).map(|at| (at % 4, at / 4)) {
        let expected = expected(x, y);
        let expected = [0, 1, 2].map(|c| expected[c] * factor[c]);
        let found = at(sky, SIZE, x, y);
        assert!(is_close(found, expected), "{what}: {found:?} at {x}, {y}; expected {expected:?}");
    }
}

#[test]
fn a_picture_is_the_same_in_every_order_of_its_texels() {
    for (size, place) in [
        ("-Y 2 +X 4", (|i| (i % 4, i / 4)) as fn(usize) -> (usize, usize)),
        ("-Y 2 -X 4", |i| (3 - i % 4, i / 4)),
        ("+Y 2 +X 4", |i| (i % 4, 1 - i / 4)),
        ("+Y 2 -X 4", |i| (3 - i % 4, 1 - i / 4)),
        ("+X 4 -Y 2", |i| (i / 2, i % 2)),
        ("-X 4 -Y 2", |i| (3 - i / 2, i % 2)),
        ("+X 4 +Y 2", |i| (i / 2, 1 - i % 2)),
        ("-X 4 +Y 2", |i| (3 - i / 2, 1 - i % 2)),
    ] {
        let data: Vec<u8> = (0..8)
            .flat_map(|i| {
                let (x, y) = place(i);
                texel(x, y)
            })
            .collect();
        assert_picture(&read("sky.hdr", &hdr("", size, &data)).expect(size), size, [1.0; 3]);
    }
    for size in ["-Y 2 +Y 4", "-Y 2", "2 4", "-Z 2 +X 4", "-Y 0 +X 4", "-Y -2 +X 4", "-Y 2 +X 4 +Z 1"] {
        assert!(read("sky.hdr", &hdr("", size, &flat())).is_err(), "{size}");
    }
}

#[test]
fn variables_of_a_header_are_applied() {
    for (header, factor) in [
        ("FORMAT=32-bit_rle_rgbe\n", [1.0; 3]),
        ("EXPOSURE=4.0\n", [0.25; 3]),
        ("EXPOSURE= 2\nEXPOSURE=2e0\n", [0.25; 3]),
        ("COLORCORR=2 1 0.5\n", [0.5, 1.0, 2.0]),
        ("EXPOSURE=0.5\nCOLORCORR=2 1 0.5\nCOLORCORR=1 2 1\r\n", [1.0, 1.0, 4.0]),
        // Only variables at the beginning of a line belong to the picture.
        ("# EXPOSURE=4\n\tEXPOSURE=4\npfilt -e 4\n", [1.0; 3]),
        ("SOFTWARE=a camera\nCAPDATE=2026:01:01 EXPOSURE=4\n", [1.0; 3]),
        ("PIXASPECT=1\nGAMMA=1\nPRIMARIES=0 0 0 0 0 0 0 0\n", [1.0; 3]),
        ("PIXASPECT=0.5\nPIXASPECT=2\n", [1.0; 3]),
        ("PRIMARIES=0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329\n", [1.0; 3]),
    ] {
        assert_picture(&read("sky.hdr", &hdr(header, "-Y 2 +X 4", &flat())).expect(header), header, factor);
    }
    for magic in ["#?RGBE", "#?AUTOPANO", "#?RADIANCE\r"] {
        let bytes = [format!("{magic}\n\n-Y 2 +X 4\n").as_bytes(), &flat()].concat();
        assert_picture(&read("sky.hdr", &bytes).expect(magic), magic, [1.0; 3]);
    }
}

#[test]
fn unsupported_headers_are_refused() {
    for (header, word) in [
        ("FORMAT=32-bit_rle_xyze\n", "ra_xyze"),
        ("FORMAT=Radiance_spectra\n", "32-bit_rle_rgbe"),
        ("EXPOSURE=0\n", "above 0"),
        ("EXPOSURE=-1\n", "above 0"),
        ("EXPOSURE=nan\n", "above 0"),
        ("EXPOSURE=1 2\n", "above 0"),
        ("EXPOSURE=\n", "above 0"),
        ("COLORCORR=1 2\n", "three factors"),
        ("COLORCORR=1 0 1\n", "three factors"),
        ("PIXASPECT=2\n", "square texels"),
        ("PIXASPECT=wide\n", "PIXASPECT"),
        ("GAMMA=2.2\n", "GAMMA=1"),
        ("VIEW= -vta -vh 180 -vv 180\n", "VIEW"),
        ("PRIMARIES=0.64 0.33\n", "eight"),
        ("PRIMARIES=0.3 0.3 0.3 0.3 0.3 0.3 0.3 0.3\n", "chromaticities"),
    ] {
        let error = read("sky.hdr", &hdr(header, "-Y 2 +X 4", &flat())).expect_err(header).to_string();
        assert!(error.contains("sky.hdr") && error.contains(word), "{header}: {error}");
    }
    // Texels that are not square can make a picture of all directions.
    let square: Vec<u8> = (0..4).flat_map(|at| texel(at % 2, at / 2)).collect();
    assert!(read("sky.hdr", &hdr("PIXASPECT=0.5\n", "-Y 2 +X 2", &square)).is_ok());
}

#[test]
fn other_primaries_become_srgb_and_white_stays_white() {
    let p3 = "PRIMARIES=0.68 0.32 0.265 0.69 0.15 0.06 0.3127 0.329\n";
    let white = [128, 128, 128, 129].repeat(8);
    let sky = read("sky.hdr", &hdr(p3, "-Y 2 +X 4", &white)).unwrap();
    assert!(is_close(at(&sky, SIZE, 1, 1), [1.0; 3]));
    // Red of a wider space is outside sRGB, and negative values count as 0.
    let red = [128, 0, 0, 129].repeat(8);
    let [r, g, b] = at(&read("sky.hdr", &hdr(p3, "-Y 2 +X 4", &red)).unwrap(), SIZE, 1, 1);
    assert!((r - 1.225).abs() < 3e-3 && g == 0.0 && b == 0.0, "{r} {g} {b}");
}

#[test]
fn lines_are_flat_or_run_length_encoded_in_either_way() {
    // 600 texels of three colours: runs are longer than one byte counts.
    let (width, a, b, c) = (600, [64, 32, 16, 130], [200, 100, 50, 90], [3, 5, 250, 180]);
    let line: Vec<[u8; 4]> = [vec![a; 10], vec![b; 580], vec![c; 10]].concat();
    let flat: Vec<u8> = line.as_flattened().repeat(2);
    let old = [&a[..], &[1, 1, 1, 9], &b, &[1, 1, 1, 67], &[1, 1, 1, 2], &c, &[1, 1, 1, 9]].concat().repeat(2);
    let mut new = vec![2, 2, (width >> 8) as u8, (width & 255) as u8];
    for byte in 0..4 {
        new.push(10);
        new.extend([a[byte]; 10]);
        for run in [127, 127, 127, 127, 72] {
            new.extend([128 + run, b[byte]]);
        }
        new.extend([128 + 9, c[byte], 1, c[byte]]);
    }
    for (what, data) in [("flat", flat), ("old", old), ("new", new.repeat(2))] {
        let sky = read("sky.hdr", &hdr("", "-Y 2 +X 600", &data)).expect(what);
        for (x, [r, g, b, e]) in [(5, a), (20, b), (300, b), (580, b), (595, c)] {
            let unit = 2f32.powi(i32::from(e) - 136);
            let found = at(&sky, [600, 2], x, 1);
            let expected = [r, g, b].map(|m| f32::from(m) * unit);
            assert!(
                found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 1e-2 * e),
                "{what} {x}: {found:?} {expected:?}"
            );
        }
        for cut in [data.len() - 1, data.len() / 2, 1] {
            let error = read("sky.hdr", &hdr("", "-Y 2 +X 600", &data[..cut])).expect_err(what).to_string();
            assert!(error.contains("sky.hdr"), "{error}");
        }
    }
    let faulty: [(&[u8], &str); 4] = [
        (&[1, 1, 1, 3], "a run of length 0"),
        (&[9, 9, 9, 130, 1, 1, 1, 200], "beyond the end"),
        (&[2, 2, 0, 9, 0, 0, 0, 0], "another length"),
        (&[2, 2, 0, 8, 128 + 9, 1, 0, 0], "beyond the end"),
    ];
    for (data, word) in faulty {
        let mut data = data.to_vec();
        data.resize(200, 7);
        let error = read("sky.hdr", &hdr("", "-Y 2 +X 8", &data)).expect_err(word).to_string();
        assert!(error.contains(word) && error.contains("line 1 of 2"), "{error}");
    }
}

mod open_exr {
    use exr::meta::attribute::{Chromaticities, EnvironmentMap};
    use exr::prelude::*;

    use super::*;

    type Picture = Image<Layer<AnyChannels<FlatSamples>>>;

    fn channel(name: &str, value: impl Fn(usize) -> f32) -> AnyChannel<FlatSamples> {
        AnyChannel::new(name, FlatSamples::F32((0..8).map(value).collect()))
    }

    fn layer(channels: Vec<AnyChannel<FlatSamples>>) -> Layer<AnyChannels<FlatSamples>> {
        let attributes = LayerAttributes::default();
        Layer::new((4, 2), attributes, Encoding::UNCOMPRESSED, AnyChannels::sort(channels.into()))
    }

    fn colour(prefix: &str) -> Vec<AnyChannel<FlatSamples>> {
        let of = |c: usize| move |at: usize| expected(at % 4, at / 4)[c];
        ["R", "G", "B"].into_iter().enumerate().map(|(c, name)| channel(&format!("{prefix}{name}"), of(c))).collect()
    }

    fn picture(channels: Vec<AnyChannel<FlatSamples>>) -> Picture {
        Image::from_layer(layer(channels))
    }

    fn written(picture: &Picture) -> std::result::Result<Environment, PictureError> {
        let folder = crate::common::folder();
        let path = folder.path().join("sky.exr");
        picture.write().non_parallel().to_file(&path).unwrap();
        read_environment(&path, 0.0, 1.0)
    }

    fn refused(picture: &Picture, word: &str) {
        let error = written(picture).expect_err(word).to_string();
        assert!(error.contains("sky.exr") && error.contains(word), "{error}");
    }

    #[test]
    fn colour_comes_from_the_channels_of_radiance() {
        assert_picture(&written(&picture(colour(""))).unwrap(), "R G B", [1.0; 3]);
        assert_picture(&written(&picture(colour("env."))).unwrap(), "one layer", [1.0; 3]);
        assert_picture(
            &written(&picture([colour(""), colour("albedo.")].concat())).unwrap(),
            "the plain one",
            [1.0; 3],
        );
        let grey = written(&picture(vec![channel("Y", |at| at as f32), channel("A", |_| 1.0)])).unwrap();
        assert_eq!(at(&grey, SIZE, 1, 1).map(|x| x.round()), [5.0; 3]);

        refused(&picture([colour("a."), colour("b.")].concat()), "2 layers of colour: a.R, b.R");
        refused(&picture(vec![channel("R", |_| 1.0), channel("depth.Z", |_| 1.0)]), "R, depth.Z");
        let chroma = ["Y", "RY", "BY"].map(|name| channel(name, |_| 0.5));
        refused(&picture(chroma.into()), "BY, RY, Y");
        let xyz = ["X", "Y", "Z"].map(|name| channel(name, |_| 0.5));
        refused(&picture(xyz.into()), "X, Y, Z");
    }

    #[test]
    fn the_display_window_is_the_picture() {
        // The upper half is stored, of a picture of four rows.
        let mut cropped = picture(colour(""));
        cropped.attributes.display_window = IntegerBounds::new((0, 0), (4, 4));
        let sky = written(&cropped).unwrap();
        assert!(is_close(at(&sky, [4, 4], 2, 1), expected(2, 1)));
        assert_eq!(at(&sky, [4, 4], 2, 3), [0.0; 3]);
        // More pixels are stored than are displayed.
        let mut wide = picture(colour(""));
        wide.attributes.display_window = IntegerBounds::new((1, 0), (2, 1));
        wide.layer_data.attributes.layer_position = Vec2(0, -1);
        let sky = written(&wide).unwrap();
        assert!(is_close(at(&sky, [2, 1], 0, 0), expected(1, 1)));
        assert!(is_close(at(&sky, [2, 1], 1, 0), expected(2, 1)));
        // None of the stored pixels are displayed.
        wide.layer_data.attributes.layer_position = Vec2(100, -100);
        assert_eq!(written(&wide).unwrap().mean(), 0.0);
        // A window that the file does not justify.
        wide.attributes.display_window = IntegerBounds::new((0, 0), (100_000, 100_000));
        refused(&wide, "display window");
    }

    #[test]
    fn attributes_are_applied_or_refused() {
        let mut cube = picture(colour(""));
        cube.layer_data.attributes.environment_map = Some(EnvironmentMap::Cube);
        refused(&cube, "cube");
        let mut world = picture(colour(""));
        world.layer_data.attributes.environment_map = Some(EnvironmentMap::LatitudeLongitude);
        assert_picture(&written(&world).unwrap(), "latlong", [1.0; 3]);
        let mut turned = picture(colour(""));
        turned.layer_data.attributes.other.insert("Orientation".into(), AttributeValue::I32(3));
        refused(&turned, "Orientation");
        let mut flat = picture(colour(""));
        flat.attributes.pixel_aspect = 2.0;
        refused(&flat, "square texels");
        let of = |white| Chromaticities { red: Vec2(0.64, 0.33), green: Vec2(0.3, 0.6), blue: Vec2(0.15, 0.06), white };
        let mut srgb = picture(colour(""));
        srgb.attributes.chromaticities = Some(of(Vec2(0.3127, 0.329)));
        assert_picture(&written(&srgb).unwrap(), "sRGB", [1.0; 3]);
        let mut grey = picture(["R", "G", "B"].map(|name| channel(name, |_| 0.5)).into());
        grey.attributes.chromaticities = Some(of(Vec2(1.0 / 3.0, 1.0 / 3.0)));
        assert!(is_close(at(&written(&grey).unwrap(), SIZE, 0, 0), [0.5; 3]));
        srgb.attributes.chromaticities = Some(of(Vec2(1.0 / 3.0, 1.0 / 3.0)));
        let converted = at(&written(&srgb).unwrap(), SIZE, 0, 0);
        assert!(!is_close(converted, expected(0, 0)), "{converted:?}");
        grey.attributes.chromaticities = Some(of(Vec2(0.3, 0.0)));
        refused(&grey, "chromaticities");
    }

    #[test]
    fn values_that_are_not_numbers_are_refused_with_their_place() {
        for wrong in [f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
            let mut channels = colour("");
            channels[1] = channel("G", |at| if at == 6 { wrong } else { 0.25 });
            refused(&picture(channels), "column 2 of row 1");
        }
    }

    #[test]
    fn several_parts_with_colour_are_refused_by_name() {
        let named = |name: &str, channels| {
            let mut layer = layer(channels);
            layer.attributes.layer_name = Some(name.into());
            layer
        };
        let folder = crate::common::folder();
        let write = |layers: Vec<Layer<AnyChannels<FlatSamples>>>| {
            let path: PathBuf = folder.path().join("sky.exr");
            let bounds = IntegerBounds::new((0, 0), (4, 2));
            let image = Image::from_layers(ImageAttributes::new(bounds), layers);
            image.write().non_parallel().to_file(&path).unwrap();
            read_environment(&path, 0.0, 1.0)
        };
        let error = write(vec![named("left", colour("")), named("right", colour(""))]).unwrap_err().to_string();
        assert!(error.contains("R of left, R of right"), "{error}");
        let depth = vec![channel("Z", |_| 1.0)];
        let sky = write(vec![named("depth", depth), named("beauty", colour(""))]).unwrap();
        assert_picture(&sky, "the part with colour", [1.0; 3]);
    }
}

#[test]
fn files_that_are_neither_are_refused() {
    for bytes in [&b""[..], b"#?RADIANCE", b"#?RADIANCE\nEXPOSURE=4\n", b"not an image\n\n-Y 2 +X 4\n", b"\x89PNG\r\n"]
    {
        assert!(read("sky.hdr", bytes).is_err());
    }
    assert!(read_environment(Path::new("/nowhere/sky.hdr"), 0.0, 1.0).is_err());
}

#[test]
fn damage_is_an_error_or_another_picture() {
    let line = [2, 2, 0, 16, 128 + 16, 64, 16, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 128 + 16, 3];
    let line = [&line[..], &[128 + 16, 128]].concat();
    let whole =
        hdr("EXPOSURE=2\nPRIMARIES=0.64 0.33 0.29 0.6 0.15 0.06 0.3333 0.3333\n", "-Y 8 +X 16", &line.repeat(8));
    assert!(read("sky.hdr", &whole).is_ok());
    for cut in 0..whole.len() {
        assert!(read("sky.hdr", &whole[..cut]).is_err(), "cut at {cut}");
    }
    for at in 0..whole.len() {
        for change in [0x01, 0x55, 0x80, 0xff] {
            let mut broken = whole.clone();
            broken[at] ^= change;
            let _ = read("sky.hdr", &broken);
        }
    }
}
