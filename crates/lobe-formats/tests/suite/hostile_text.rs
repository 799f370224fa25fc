//! Damaged Integra and Zemax files: an error that names the place.

use std::path::Path;

use lobe_formats::{Format, FormatError, Place};
use lobe_testing::examples::{DDR, SDR, ZEMAX};

const SOUND: [(Format, &str); 3] = [(Format::Ddr, DDR), (Format::Sdr, SDR), (Format::Zemax, ZEMAX)];

fn read(format: Format, text: &str) -> Result<(), FormatError> {
    lobe_formats::read(format, text.as_bytes(), Path::new("t")).map(drop)
}

#[test]
fn every_truncation_is_an_error() {
    for (format, text) in SOUND {
        assert_eq!(read(format, text), Ok(()));
        let ends: Vec<usize> =
            text.match_indices(char::is_whitespace).map(|(at, _)| at).filter(|&at| text[at..].trim() != "").collect();
        assert!(ends.len() > 20);
        for end in ends {
            let error = read(format, &text[..end]).unwrap_err();
            assert!(
                matches!(error.place, Place::Line(line) if line <= text.lines().count()),
                "{format} {end}: {error}"
            );
        }
    }
}

/// A piece of a sound file and, for each replacement, the expected text of the error: the line, and what was found.
type Damage = (&'static str, &'static [(&'static str, &'static str)]);

const DDR_DAMAGE: &[Damage] = &[
    (
        "sigma 2\n 0 60",
        &[
            ("sigma 2000000000\n 0 60", "t:6: found a count of 2000000000 sigma angles"),
            ("sigma 0\n 0 60", "t:6: found `0`; expected the number of sigma angles, 1 or more"),
            ("sigma -2\n 0 60", "t:6: found `-2`"),
            ("sigma 2.5\n 0 60", "t:6: found `2.5`"),
            ("sigma 18446744073709551616\n 0 60", "t:6: found `18446744073709551616`"),
            ("sigma 2\n 60 0", "t:7: found 0 after 60; expected strictly ascending sigma angles"),
            ("sigma 2\n 0 0", "t:7: found 0 after 0"),
            ("sigma 2\n 0 91", "t:7: found 91; expected a sigma angle from 0 to 90 degrees"),
            ("sigma 2\n -1 60", "t:7: found -1"),
            ("sigma 2\n 0 nan", "t:7: found `nan`"),
            ("sigma 1\n 0 60", "t:7: found `60`; expected no more than 1 sigma angles"),
        ],
    ),
    ("sigma 2\n 0 60\nsigmat\n 0 40\n", &[("", "found the end of the header; expected `sigma`")]),
    ("theta 2\n 0 90", &[("", "expected `theta` and its angles before the values")]),
    ("phi 2\n 0 180", &[("phi 2\n 0 180 phi 1 0", "found a second list of phi angles")]),
    (
        "TypeData Intensity Relative",
        &[("TypeData Radiance Absolute", "t:5: found `Radiance`; expected Luminance or Intensity")],
    ),
    ("PlaneSymmetrical", &[("Pentagonal", "t:3: found `Pentagonal`")]),
    (
        "TypeColorModel RGB",
        &[
            ("TypeColorModel HSV", "t:4: found `HSV`"),
            ("TypeColorModel spectral 1000000", "t:4: found a count of 1000000 wavelengths"),
            ("TypeColorModel BW", "found `red`; expected a block `bw`"),
        ],
    ),
    (
        "red\n kbdf 1 1 1 1",
        &[("red\n", "found `def`; expected `kbdf`"), ("red\n kbdf 1 1 1", "found `def`; expected a kbdf factor")],
    ),
    (
        " def\n 1 2 3 4 1",
        &[
            (" def\n 1 2 3 4 -1.#IND", "found `-1.#IND`; expected a value, a finite number"),
            (" def\n 1 2 3 4", "found `enddef`; expected a value"),
            (" def\n 9 1 2 3 4 1", "found `4`; expected `enddef`"),
            (" def\n 1 2 3 4 1e40", "found a value that becomes inf"),
        ],
    ),
    ("gre kbdf", &[("red kbdf", "found `red`; expected a block `gre`")]),
];

const SDR_DAMAGE: &[Damage] = &[
    ("sigma 3\n 0 45 90", &[("", "expected `sigma` and its angles")]),
    (
        "0.1 0.2 1",
        &[
            ("0.1 inf 1", "t:7: found `inf`; expected a reflectance, a finite number"),
            ("0.1 1e39 1", "expected a reflectance within f32"),
        ],
    ),
    (
        "wl 700",
        &[("wl 400", "t:9: found a second block for 400 nm"), ("wl -700", "t:9: found -700; expected a wavelength")],
    ),
];

const ZEMAX_DAMAGE: &[Damage] = &[
    ("ScatterType BRDF\n", &[("", "expected `ScatterType` before the values")]),
    ("ScatterRadial 2\n0 90\n", &[("", "expected `ScatterRadial` and its angles")]),
    ("ScatterRadial 2\n0 90", &[("ScatterRadial 2\n90 0", "t:13: found 0 after 90")]),
    (
        "ScatterAzimuth 2\n0 180",
        &[("ScatterAzimuth 2\n0 270", "t:10: found 270; expected ScatterAzimuth from 0 to 180")],
    ),
    (
        "1 2\n3 4\nTIS",
        &[
            ("1 2\n3 x\nTIS", "t:19: found `x`; expected a value in 1/sr"),
            ("1 2\n3 4 5\nTIS", "found `5`; expected `TIS`"),
        ],
    ),
    (
        "SpectralContent Monochrome",
        &[("SpectralContent XYZ", "t:15: found `Monochrome`; expected the block `TristimulusX`")],
    ),
];

#[test]
fn damage_is_named_with_its_line() {
    for ((format, sound), damages) in SOUND.into_iter().zip([DDR_DAMAGE, SDR_DAMAGE, ZEMAX_DAMAGE]) {
        for (from, changes) in damages {
            assert!(sound.contains(from), "{from:?} is not in the {format} file");
            for (to, expected) in *changes {
                let message = read(format, &sound.replacen(from, to, 1)).unwrap_err().to_string();
                assert!(message.contains(expected), "{to:?} gave: {message}");
            }
        }
    }
}

/// Lists of a thousand knots each fit into a small file; the values that they require do not.
#[test]
fn products_of_counts_are_checked_before_memory_is_allocated() {
    let list: String = (0..1000).map(|i| format!(" {}", f64::from(i) * 0.09)).collect();
    let head = format!(
        "sigma 1000{list}\npsi 1000{list}\ntheta 1000{list}\nphi 1000{list}\nTypeColorModel BW\nbw def 1 enddef"
    );
    let message = read(Format::Ddr, &head).unwrap_err().to_string();
    assert!(message.contains("a count of 1000000000000 values"), "{message}");
    let head = format!(
        "Symmetry Asymmetrical\nSpectralContent XYZ\nScatterType BRDF\nAngleOfIncidence 1000{list}\nSampleRotation 1000{list}\n\
         ScatterRadial 1000{list}\nScatterAzimuth 1000{list}\nTristimulusX DataBegin"
    );
    let message = read(Format::Zemax, &head).unwrap_err().to_string();
    assert!(message.contains("a count of 1000000000000 values"), "{message}");
}
