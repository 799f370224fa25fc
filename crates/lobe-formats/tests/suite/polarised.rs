//! Mueller matrices in specular coordinates, as tensor files.

use std::path::Path;

use lobe_formats::polarised::{matches, read, to_bytes};
use lobe_formats::{Format, pbsdf, sniff};
use lobe_table::polarised;

fn data() -> polarised::Data {
    let knots = [vec![0.0, 1.0], vec![0.0], vec![0.0, 0.5, 1.5], vec![0.0, 3.0]];
    let values = (0..2 * 3 * 2 * 2 * 16).map(|i| 0.25 + (i % 7) as f32).collect();
    polarised::Data::new(knots, vec![450.5, 650.0], values).expect("matrices")
}

#[test]
fn files_are_restored_and_recognised() {
    let bytes = to_bytes(&data()).expect("bytes");
    assert!(matches(&bytes) && !pbsdf::matches(&bytes));
    assert_eq!(sniff(&bytes), Some(Format::Polarised));
    assert_eq!(read(&bytes, Path::new("x")), Ok(data()));
    assert!(read(&bytes[..bytes.len() - 1], Path::new("x")).is_err());
}

#[test]
fn errors_name_the_wrong_part() {
    let knots = || [vec![0.0], vec![0.0], vec![0.0], vec![0.0]];
    for (nm, value, expected) in [
        (vec![500.0, 450.0], 1.0, "450 after 500"),
        (vec![500.0, f64::NAN], 1.0, "NaN"),
        (vec![-1.0, 5.0], 1.0, "-1"),
        (vec![450.0, 500.0], f32::NAN, "NaN"),
    ] {
        let error = polarised::Data::new(knots(), nm, vec![value; 32]).expect_err(expected).to_string();
        assert!(error.contains(expected), "{error}");
    }
    assert!(polarised::Data::new(knots(), vec![500.0], vec![1.0; 15]).is_err());
}
