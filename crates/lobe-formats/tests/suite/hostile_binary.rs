//! Broken files: every reader refuses them, naming the file and the place, and none panics.

use lobe_formats::{Format, FormatError, Place, Sides, mbsdf, merl, pbsdf, tensor, utia};
use lobe_table::mueller;
use lobe_testing::examples::{tiny_mbsdf, tiny_merl, tiny_pbsdf, tiny_rgl};
use std::path::Path;

const FILE: &str = "broken.file";

/// A reader whose material, if there is one, is dropped.
type Read = fn(&[u8]) -> Result<(), FormatError>;

fn read_rgl(bytes: &[u8]) -> Result<(), FormatError> {
    lobe_formats::read(Format::Rgl, bytes, Path::new(FILE)).map(drop)
}

fn read_pbsdf(bytes: &[u8]) -> Result<(), FormatError> {
    lobe_formats::read(Format::Pbsdf, bytes, Path::new(FILE)).map(drop)
}

fn read_merl(bytes: &[u8]) -> Result<(), FormatError> {
    lobe_formats::read(Format::Merl, bytes, Path::new(FILE)).map(drop)
}

fn read_mbsdf(bytes: &[u8]) -> Result<(), FormatError> {
    lobe_formats::read(Format::Mbsdf, bytes, Path::new(FILE)).map(drop)
}

/// Every format with a small file of it.
fn formats() -> [(&'static str, Vec<u8>, Read); 4] {
    [
        ("rgl", tiny_rgl(), read_rgl),
        ("pbsdf", tiny_pbsdf(), read_pbsdf),
        ("merl", tiny_merl(), read_merl),
        ("mbsdf", tiny_mbsdf(), read_mbsdf),
    ]
}

#[test]
fn files_cut_off_anywhere_are_refused() {
    for (name, bytes, read) in formats() {
        read(&bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
        // An MBSDF file may end after its reflection.
        let end_of_reflection = bytes.windows(18).position(|w| w == b"MBSDF_DATA_TRANSMI");
        for length in (0..bytes.len()).filter(|length| Some(*length) != end_of_reflection) {
            let Err(error) = read(&bytes[..length]) else { panic!("{name}: read {length} of {} bytes", bytes.len()) };
            assert_eq!(error.file, Path::new(FILE));
            assert!(!error.found.is_empty() && !error.expected.is_empty(), "{name}: {error}");
        }
    }
    let whole = vec![0; 1_990_656];
    assert!(utia::matches(&whole) && utia::read(&whole, Path::new(FILE)).is_ok());
    for length in [0, 1, 8, 995_328, 1_990_655] {
        let error = utia::read(&whole[..length], Path::new(FILE)).expect_err("cut off");
        assert_eq!(error.expected, "1990656 bytes");
    }
}

/// The positions of the header of a field in a tensor file, and of its type, position and dimensions.
struct Header {
    start: usize,
    dtype: usize,
    offset: usize,
    shape: usize,
}

fn header(bytes: &[u8], name: &str) -> Header {
    let named = [&(name.len() as u16).to_le_bytes()[..], name.as_bytes()].concat();
    let start = bytes.windows(named.len()).position(|w| w == named).expect("a field of this name");
    let dtype = start + named.len() + 2;
    Header { start, dtype, offset: dtype + 1, shape: dtype + 9 }
}

#[test]
fn tensor_files_with_wrong_headers_are_refused() {
    let good = tiny_rgl();
    let vndf = header(&good, "vndf");
    let data = u64::from_le_bytes(good[vndf.offset..][..8].try_into().expect("eight bytes")) as usize;
    let u64s = |n: &[u64]| n.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>();
    let half = 1u64 << 31;
    let sigma = header(&good, "sigma").start as u64;
    let at = vndf.start as u64;
    // The bytes written and their position, the place of the error, and what it says was found.
    let cases: Vec<(usize, Vec<u8>, u64, &str)> = vec![
        (0, b"tensor".map(|b| b + 1).to_vec(), 0, "ufotps_file"),
        (12, vec![2, 7], 12, "version 2.7"),
        (14, u32::MAX.to_le_bytes().to_vec(), 14, "4294967295 fields"),
        (14, 1000u32.to_le_bytes().to_vec(), 14, "1000 fields"),
        (vndf.start, vec![255, 255], at + 2, "the end of the file"),
        (vndf.start + 2, vec![0xff], at, "\\xffndf"),
        (vndf.dtype, vec![0], at, "type 0"),
        (vndf.dtype, vec![12], at, "type 12"),
        (vndf.dtype, vec![6], at, "I32"),
        (vndf.dtype, vec![11], at, "F64"),
        (vndf.offset, u64s(&[good.len() as u64 - 4]), at, "vndf"),
        (vndf.offset, u64s(&[u64::MAX]), at, "18446744073709551615"),
        (vndf.shape, u64s(&[u64::MAX]), at, "vndf"),
        (vndf.shape, u64s(&[half, half, half, half]), at, "2147483648"),
        (vndf.shape, u64s(&[1, 2, 1, 6]), at, "2 slices of 1 x 6"),
        (vndf.shape, u64s(&[2, 1, 3, 2]), at, "[2, 1, 3, 2]"),
        (vndf.shape, u64s(&[1, 2, 0, 2]), at, "2 slices of 0 x 2"),
        (data, f32::NAN.to_le_bytes().to_vec(), at, "NaN at index 0"),
        (data + 4, f32::INFINITY.to_le_bytes().to_vec(), at, "inf at index 1"),
        (header(&good, "sigma").dtype, vec![1], sigma, "U8"),
    ];
    for (position, patch, place, found) in cases {
        let mut bytes = good.clone();
        bytes[position..][..patch.len()].copy_from_slice(&patch);
        let error = read_rgl(&bytes).expect_err(found);
        assert_eq!(error.place, Place::Byte(place), "{found}: {error}");
        assert!(error.found.contains(found), "{found}: {error}");
    }
    let mut renamed = good.clone();
    renamed[vndf.start + 2..][..4].copy_from_slice(b"vnda");
    let error = read_rgl(&renamed).expect_err("no vndf");
    assert!(error.place == Place::File && error.found.contains("vnda") && error.expected.contains("vndf"), "{error}");
}

/// The product of these dimensions is a multiple of 2^64: not an empty array, but an impossible one.
#[test]
fn a_shape_beyond_the_address_space_is_not_empty() {
    let mut bytes = tiny_rgl();
    let shape = header(&bytes, "vndf").shape;
    bytes[shape..][..32].copy_from_slice(&[1u64 << 31; 4].map(u64::to_le_bytes).concat());
    let error = tensor::read(&bytes, Path::new(FILE)).expect_err("an impossible shape");
    assert!(error.found.contains("2147483648"), "{error}");
}

#[test]
fn a_name_may_occur_only_once() {
    let field = || tensor::Field::f32("twice", &[1], &[1.0]);
    let bytes = tensor::TensorFile::new(vec![field(), field()]).to_bytes().expect("bytes");
    let error = tensor::read(&bytes, Path::new(FILE)).expect_err("the name occurs twice");
    assert!(error.found.contains("a second field \"twice\"") && error.place == Place::Byte(18 + 26), "{error}");
}

#[test]
fn materials_that_do_not_fit_the_container_are_not_written() {
    let unfit = |fields| tensor::TensorFile::new(fields).to_bytes().expect_err("no file").kind();
    let invalid = std::io::ErrorKind::InvalidInput;
    assert_eq!(unfit(vec![tensor::Field::f32("short", &[2], &[1.0])]), invalid);
    assert_eq!(unfit(vec![tensor::Field::u8("huge", &[usize::MAX, 2], &[])]), invalid);
    assert_eq!(unfit(vec![tensor::Field::u8(&"n".repeat(65_536), &[0], &[])]), invalid);
    let knots = [vec![0.0], vec![0.0], vec![0.0], vec![500.5]];
    let between = mueller::Data::new(knots, vec![0.0; 16]).expect("a valid material");
    assert_eq!(pbsdf::to_bytes(&between).expect_err("half a nm").kind(), invalid);
    let neither = Sides { reflection: None, transmission: None };
    assert_eq!(mbsdf::to_bytes(&neither).expect_err("an empty file").kind(), invalid);
}

#[test]
fn polarised_files_with_wrong_shapes_are_refused() {
    let good = tiny_pbsdf();
    let at = |name: &str, shape: &[u64]| {
        let mut bytes = good.clone();
        let header = header(&bytes, name);
        for (i, n) in shape.iter().enumerate() {
            bytes[header.shape + 8 * i..][..8].copy_from_slice(&n.to_le_bytes());
        }
        (bytes, header.start as u64)
    };
    for (name, shape) in [
        ("theta_d", &[1, 1][..]),
        ("theta_d", &[2, 1]),
        ("theta_d", &[0, 1 << 40]),
        ("wvls", &[1]),
        ("M", &[2, 2, 1, 2, 2, 8]),
        ("M", &[1 << 40, 0, 1, 2, 4, 4]),
    ] {
        let (bytes, place) = at(name, shape);
        let error = read_pbsdf(&bytes).expect_err("a wrong shape");
        let named = if name == "wvls" { header(&good, "M").start as u64 } else { place };
        assert_eq!(error.place, Place::Byte(named), "{name} {shape:?}: {error}");
    }
    // Angles that are not stored are the uniform ones.
    let (bytes, _) = at("theta_d", &[0, 2]);
    let material = pbsdf::read(&bytes, Path::new(FILE)).expect("a material without theta_d");
    assert_eq!(material.knots()[1], [0.0, std::f32::consts::FRAC_PI_2]);
}

#[test]
fn merl_headers_that_lie_are_refused() {
    let good = tiny_merl();
    assert!(merl::matches(&good));
    for dims in [[-1, 1, 3], [0, 1, 3], [i32::MAX, i32::MAX, i32::MAX], [90, 90, 180], [2, 1, 4]] {
        let mut bytes = good.clone();
        bytes[..12].copy_from_slice(&dims.map(i32::to_le_bytes).concat());
        assert!(!merl::matches(&bytes));
        let error = read_merl(&bytes).expect_err("a wrong header");
        assert_eq!(error.place, Place::Byte(0), "{error}");
    }
    for (value, shown) in [(f64::NAN, "NaN"), (f64::INFINITY, "inf"), (1e300, "1000000")] {
        let mut bytes = good.clone();
        bytes[12 + 8 * 7..][..8].copy_from_slice(&value.to_le_bytes());
        let error = read_merl(&bytes).expect_err("a wrong value");
        assert!(error.place == Place::Byte(68) && error.found.starts_with(shown), "{error}");
    }
}

#[test]
fn mbsdf_blocks_that_lie_are_refused() {
    let good = tiny_mbsdf();
    let start = b"NVIDIA ARC MBSDF V1\nMBSDF_DATA_REFLECTION=\n".len();
    let block = |words: [u32; 3]| {
        let mut bytes = good.clone();
        bytes[start..][..12].copy_from_slice(&words.map(u32::to_le_bytes).concat());
        read_mbsdf(&bytes).expect_err("a wrong block").to_string()
    };
    assert!(block([2, 2, 3]).contains("type 2"));
    assert!(block([0, 0, 3]).contains("0 thetas"));
    assert!(block([0, 2, 0]).contains("0 phis"));
    assert!(block([1, u32::MAX, u32::MAX]).contains("memory"));
    assert!(block([0, 1 << 20, 1]).contains("the end of the file"));
    assert!(block([0, 2, 2]).contains("MBSDF_DATA_TRANSMISSION="));
    let mut bytes = good.clone();
    bytes[start + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(read_mbsdf(&bytes).expect_err("NaN").to_string().contains("NaN"));
    assert!(read_mbsdf(&[&good[..], b"\n"].concat()).is_ok());
    assert!(read_mbsdf(&[&good[..], b"more"].concat()).expect_err("a tail").found.contains("4 bytes more"));
    // Metadata are ignored, and the oldest heading means reflection.
    let rest = &good[start..];
    let old = [b"NVIDIA ARC MBSDF V1\nkey=\"\xff\"\n\nMBSDF_DATA=\n", rest].concat();
    assert!(mbsdf::read(&old, Path::new(FILE)).expect("an old file").reflection.is_some());
}
