//! Tests of EXR and PNG: written files can be read back, equal pictures give equal bytes, and damage is reported.

use std::path::Path;

use lobe_render::picture::{
    Meta, PictureError, ToneMap, encode_png, read_environment, read_partial, write_exr, write_png,
};
use lobe_render::{Film, MergeError, Rect, Sample, Settings, merge};

use super::common::*;

const SIZE: [u32; 2] = [70, 40];

fn meta(window: Rect, samples: std::ops::Range<u32>) -> Meta {
    Meta {
        scene: "00ff".into(),
        size: SIZE,
        window,
        samples,
        total: 6,
        timed: false,
        exposure: 0.0,
        version: Meta::VERSION.into(),
        arithmetic: "strict".into(),
    }
}

#[test]
fn parts_merge_to_the_same_bytes_as_the_whole() {
    let world = mixed();
    let settings = settings(SIZE, 6, path_tracing());
    let folder = folder();
    let file = |name: &str| folder.path().join(name);
    let whole = picture(&world, &settings);
    write_exr(&file("whole.exr"), &whole, &meta(settings.window, 0..6), false).unwrap();

    let mut parts = Vec::new();
    for (k, (y, height, samples)) in [(0, 13, 0..6), (13, 27, 4..6), (13, 27, 0..4)].into_iter().enumerate() {
        let window = Rect { x: 0, y, width: 70, height };
        let film = picture(&world, &Settings { window, samples: samples.clone(), ..settings.clone() });
        let path = file(&format!("{k}.exr"));
        write_exr(&path, &film, &meta(window, samples.clone()), true).unwrap();
        let (read, said) = read_partial(&path).unwrap();
        assert!(read == film && said == meta(window, samples));
        parts.push(path);
    }
    assert!(matches!(merge(&parts[..2], false), Err(MergeError::Gaps { found, expected, .. })
        if found == 70 * (13 * 6 + 27 * 2) && expected == 70 * 40 * 6));
    let twice = [&parts[0], &parts[1], &parts[1]];
    assert!(merge(&twice, false).unwrap_err().to_string().contains("4..6"));

    let (film, said) = merge(&parts, false).unwrap();
    assert!(film == whole);
    write_exr(&file("merged.exr"), &film, &said, false).unwrap();
    assert!(std::fs::read(file("merged.exr")).unwrap() == std::fs::read(file("whole.exr")).unwrap());

    // A picture without sums is not a part, and one of another scene does not fit.
    let error = merge(&[file("whole.exr")], false).unwrap_err().to_string();
    assert!(error.contains("whole.exr") && error.contains("sum.R.0"), "{error}");
    let (part, said) = read_partial(&parts[0]).unwrap();
    write_exr(&file("other.exr"), &part, &Meta { scene: "11".into(), ..said }, true).unwrap();
    let error = merge(&[parts[1].clone(), file("other.exr")], false).unwrap_err().to_string();
    assert!(error.contains("other.exr") && error.contains("the scene"), "{error}");
}

#[test]
fn damaged_files_are_errors() {
    let settings = settings([16, 16], 1, path_tracing());
    let folder = folder();
    let path = folder.path().join("part.exr");
    let film = picture(&mixed(), &settings);
    let said = Meta { size: [16, 16], ..meta(settings.window, 0..1) };
    write_exr(&path, &film, &said, true).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    for cut in [0, 3, 20, 300, bytes.len() / 2, bytes.len() - 1] {
        std::fs::write(&path, &bytes[..cut]).unwrap();
        let error = read_partial(&path).unwrap_err();
        assert!(matches!(error, PictureError::Content { .. }), "{cut}: {error}");
        assert!(error.to_string().contains("part.exr"), "{error}");
    }
    // Every byte of the header changed in turn: an error or another picture, and no panic.
    for at in 0..bytes.len().min(1500) {
        let mut broken = bytes.clone();
        broken[at] ^= 0x55;
        std::fs::write(&path, &broken).unwrap();
        let _ = read_partial(&path);
        let _ = read_environment(&path, 0.0, 1.0);
    }
    let missing = read_partial(Path::new("/nowhere/part.exr")).unwrap_err();
    assert!(missing.to_string().contains("/nowhere/part.exr"), "{missing}");
}

/// Sums that no rendering makes would overflow when samples are added to them.
#[test]
fn sums_of_more_than_their_samples_are_refused() {
    let window = Rect { x: 0, y: 0, width: 2, height: 1 };
    let folder = folder();
    let path = folder.path().join("part.exr");
    let said = Meta { size: [2, 1], ..meta(window, 0..6) };
    type Change<'a> = &'a dyn Fn(&mut Film);
    let read = |change: Change<'_>| {
        let mut film = Film::new(window);
        for pixel in film.pixels_mut() {
            pixel.add(&Sample { radiance: [f32::MAX; 3], ..Sample::EMPTY });
        }
        film.add_light_paths(5);
        change(&mut film);
        write_exr(&path, &film, &said, true).unwrap();
        read_partial(&path).map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(read(&|_| {}), Ok(()));
    let changes: [(Change<'_>, &str); 5] = [
        (&|film| film.pixels_mut()[1].radiance[2] += 1, "a sum of more than 1 samples of radiance"),
        (&|film| film.pixels_mut()[0].radiance[0] = i128::MIN, "a sum of more than 1 samples of radiance"),
        (&|film| film.pixels_mut()[0].samples = 0, "a sum of more than 0 samples of radiance"),
        (&|film| film.pixels_mut()[1].normal[0] = i64::MIN, "a sum of more than 1 samples of a surface"),
        (&|film| film.add_light_paths(1 << 62), "light paths that overflow"),
    ];
    for (change, found) in changes {
        let error = read(change).unwrap_err();
        assert!(error.contains(found), "{error}");
    }
}

#[test]
fn environments_come_from_exr_and_hdr() {
    let folder = folder();
    let path = folder.path().join("sky.hdr");
    // Two by one texels, not run-length encoded: (1, 0.5, 0.25) and black.
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n".to_vec();
    bytes.extend([128, 64, 32, 129, 0, 0, 0, 0]);
    std::fs::write(&path, &bytes).unwrap();
    let sky = read_environment(&path, 0.0, 2.0).unwrap();
    // The left half of the image is -x.
    let left = sky.radiance([-1.0, 0.0, 0.0]);
    assert!((left[0] / 2.0 - 1.0).abs() < 0.02 && (left[1] / left[0] - 0.5).abs() < 0.02, "{left:?}");
    assert_eq!(sky.radiance([1.0, 0.0, 0.0]), [0.0; 3]);
    for broken in [&bytes[..bytes.len() - 3], b"#?RADIANCE\n", b"not an image", b""] {
        std::fs::write(&path, broken).unwrap();
        let error = read_environment(&path, 0.0, 1.0).unwrap_err().to_string();
        assert!(error.contains("sky.hdr"), "{error}");
    }
    std::fs::write(&path, b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n").unwrap();
    assert!(read_environment(&path, 0.0, 1.0).is_err(), "no memory for a header that claims too much");

    let path = folder.path().join("sky.exr");
    let settings = settings([16, 8], 2, path_tracing());
    let film = picture(&mixed(), &settings);
    // The whole picture has this size; a part of a larger one would have black around it.
    let whole = Meta { size: [16, 8], ..meta(settings.window, 0..2) };
    write_exr(&path, &film, &whole, false).unwrap();
    let sky = read_environment(&path, 0.0, 1.0).unwrap();
    assert!(sky.mean() > 0.01);
}

#[test]
fn a_png_follows_the_tone_map() {
    let settings = settings([20, 10], 1, path_tracing());
    let film = picture(&mixed(), &settings);
    let tone = ToneMap { exposure: 0.5 };
    let folder = folder();
    let path = folder.path().join("picture.png");
    write_png(&path, &film, tone).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    assert_eq!(bytes, encode_png(&film, tone));
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), (20, 10));
    let expected: Vec<u8> =
        film.pixels().iter().flat_map(|pixel| pixel.mean_radiance().map(|x| tone.byte(x))).collect();
    assert_eq!(pixels, expected);
    let error = write_png(Path::new("/nowhere/picture.png"), &film, tone).unwrap_err();
    assert!(error.to_string().contains("/nowhere/picture.png"), "{error}");
}
