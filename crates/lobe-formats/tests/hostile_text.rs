//! Damaged, truncated and hostile files: an error that says where, never a panic.

mod common;
#[path = "common/hostile.rs"]
mod hostile;

use std::path::Path;

use lobe_formats::{FormatError, Place, ddr, sdr, sniff, zemax};
use lobe_table::Scatter;
use proptest::prelude::*;

const DDR: &str = ";; small\nSource Measured\nTypeSym PlaneSymmetrical\nTypeColorModel RGB\nTypeData Intensity Relative\nsigma 2\n 0 60\n\
    sigmat\n 0 40\npsi 2 0 90\nphi 2\n 0 180\ntheta 2\n 0 90\nred\n kbdf 1 1 1 1\n def\n 1 2 3 4 1 2 3 4\n 1 2 3 4 1 2 3 4\n enddef\n\
    gre kbdf 1 1 1 1 def 1 2 3 4 1 2 3 4 1 2 3 4 1 2 3 4 enddef\nblu kbdf 1 1 1 1 def 1 2 3 4 1 2 3 4 1 2 3 4 1 2 3 4 enddef\n";
const SDR: &str = "Source Measured\nTypeColorModel spectral 2\nsigma 3\n 0 45 90\nwl 400\ndef\n 0.1 0.2 1\nenddef\nwl 700 def 0 0 1 enddef\n";
const ZEMAX: &str = "# small\nSource Measured\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterType BRDF\nSampleRotation 1\n0\n\
    AngleOfIncidence 2\n10 50\nScatterAzimuth 2\n0 180\nScatterRadial 2\n0 90\n\nMonochrome\nDataBegin\nTIS 0.1\n1 2\n3 4\nTIS 0.2\n5 6\n7 8\nDataEnd\n";

#[derive(Clone, Copy, Debug)]
enum Reader {
    Ddr,
    Sdr,
    Zemax,
}

const READERS: [(Reader, &str); 3] = [(Reader::Ddr, DDR), (Reader::Sdr, SDR), (Reader::Zemax, ZEMAX)];

impl Reader {
    fn read(self, bytes: &[u8]) -> Result<(), FormatError> {
        let file = Path::new("t");
        match self {
            Reader::Ddr => ddr::read(bytes, file, Scatter::Transmission).map(|_| ()),
            Reader::Sdr => sdr::read(bytes, file, Scatter::Reflection).map(|_| ()),
            Reader::Zemax => zemax::read(bytes, file).map(|_| ()),
        }
    }
}

#[test]
fn every_truncation_is_an_error() {
    for (reader, text) in READERS {
        assert_eq!(reader.read(text.as_bytes()), Ok(()));
        let ends: Vec<usize> =
            text.match_indices(char::is_whitespace).map(|(at, _)| at).filter(|&at| text[at..].trim() != "").collect();
        assert!(ends.len() > 20);
        for end in ends {
            let error = reader.read(&text.as_bytes()[..end]).unwrap_err();
            assert!(
                matches!(error.place, Place::Line(line) if line <= text.lines().count()),
                "{reader:?} at {end}: {error}"
            );
        }
    }
}

/// One change to a sound file, and what the error has to say: the line and the text that was found.
#[test]
fn damage_is_named_with_its_line() {
    let cases: &[(Reader, &str, &str, &str)] = &[
        (Reader::Ddr, "sigma 2\n 0 60", "sigma 2000000000\n 0 60", "t:6: found a count of 2000000000 sigma angles"),
        (
            Reader::Ddr,
            "sigma 2\n 0 60",
            "sigma 0\n 0 60",
            "t:6: found `0`; expected the number of sigma angles, 1 or more",
        ),
        (Reader::Ddr, "sigma 2\n 0 60", "sigma -2\n 0 60", "t:6: found `-2`"),
        (Reader::Ddr, "sigma 2\n 0 60", "sigma 2.5\n 0 60", "t:6: found `2.5`"),
        (Reader::Ddr, "sigma 2\n 0 60", "sigma 18446744073709551616\n 0 60", "t:6: found `18446744073709551616`"),
        (
            Reader::Ddr,
            "sigma 2\n 0 60",
            "sigma 2\n 60 0",
            "t:7: found 0 after 60; expected strictly ascending sigma angles",
        ),
        (Reader::Ddr, "sigma 2\n 0 60", "sigma 2\n 0 0", "t:7: found 0 after 0"),
        (Reader::Ddr, "sigma 2\n 0 60", "sigma 2\n 0 91", "t:7: found 91; expected a sigma angle from 0 to 90 degrees"),
        (Reader::Ddr, "sigma 2\n 0 60", "sigma 2\n -1 60", "t:7: found -1"),
        (Reader::Ddr, "sigma 2\n 0 60", "sigma 2\n 0 nan", "t:7: found `nan`"),
        (Reader::Ddr, "sigma 2\n 0 60", "sigma 1\n 0 60", "t:7: found `60`; expected no more than 1 sigma angles"),
        (Reader::Ddr, "sigma 2\n 0 60\nsigmat\n 0 40\n", "", "found the end of the header; expected `sigma`"),
        (Reader::Ddr, "theta 2\n 0 90", "", "expected `theta` and its angles before the values"),
        (Reader::Ddr, "phi 2\n 0 180", "phi 2\n 0 180 phi 1 0", "found a second list of phi angles"),
        (
            Reader::Ddr,
            "TypeData Intensity Relative",
            "TypeData Radiance Absolute",
            "t:5: found `Radiance`; expected Luminance or Intensity",
        ),
        (Reader::Ddr, "PlaneSymmetrical", "Pentagonal", "t:3: found `Pentagonal`"),
        (Reader::Ddr, "TypeColorModel RGB", "TypeColorModel HSV", "t:4: found `HSV`"),
        (
            Reader::Ddr,
            "TypeColorModel RGB",
            "TypeColorModel spectral 1000000",
            "t:4: found a count of 1000000 wavelengths",
        ),
        (Reader::Ddr, "TypeColorModel RGB", "TypeColorModel BW", "found `red`; expected a block `bw`"),
        (Reader::Ddr, "red\n kbdf 1 1 1 1", "red\n", "found `def`; expected `kbdf`"),
        (Reader::Ddr, "red\n kbdf 1 1 1 1", "red\n kbdf 1 1 1", "found `def`; expected a kbdf factor"),
        (
            Reader::Ddr,
            " def\n 1 2 3 4 1",
            " def\n 1 2 3 4 -1.#IND",
            "found `-1.#IND`; expected a value, a finite number",
        ),
        (Reader::Ddr, " def\n 1 2 3 4 1", " def\n 1 2 3 4", "found `enddef`; expected a value"),
        (Reader::Ddr, " def\n 1 2 3 4 1", " def\n 9 1 2 3 4 1", "found `4`; expected `enddef`"),
        (Reader::Ddr, " def\n 1 2 3 4 1", " def\n 1 2 3 4 1e40", "found a value that becomes inf"),
        (Reader::Ddr, "gre kbdf", "red kbdf", "found `red`; expected a block `gre`"),
        (Reader::Sdr, "sigma 3\n 0 45 90", "", "expected `sigma` and its angles"),
        (Reader::Sdr, "0.1 0.2 1", "0.1 inf 1", "t:7: found `inf`; expected a reflectance, a finite number"),
        (Reader::Sdr, "0.1 0.2 1", "0.1 1e39 1", "expected a reflectance within f32"),
        (Reader::Sdr, "wl 700", "wl 400", "t:9: found a second block for 400 nm"),
        (Reader::Sdr, "wl 700", "wl -700", "t:9: found -700; expected a wavelength"),
        (Reader::Zemax, "ScatterType BRDF\n", "", "expected `ScatterType` before the values"),
        (Reader::Zemax, "ScatterRadial 2\n0 90\n", "", "expected `ScatterRadial` and its angles"),
        (Reader::Zemax, "ScatterRadial 2\n0 90", "ScatterRadial 2\n90 0", "t:13: found 0 after 90"),
        (
            Reader::Zemax,
            "ScatterAzimuth 2\n0 180",
            "ScatterAzimuth 2\n0 270",
            "t:10: found 270; expected ScatterAzimuth from 0 to 180",
        ),
        (Reader::Zemax, "1 2\n3 4\nTIS", "1 2\n3 x\nTIS", "t:19: found `x`; expected a value in 1/sr"),
        (Reader::Zemax, "1 2\n3 4\nTIS", "1 2\n3 4 5\nTIS", "found `5`; expected `TIS`"),
        (
            Reader::Zemax,
            "SpectralContent Monochrome",
            "SpectralContent XYZ",
            "t:15: found `Monochrome`; expected the block `TristimulusX`",
        ),
    ];
    for (reader, from, to, expected) in cases {
        let sound = READERS.iter().find(|(r, _)| format!("{r:?}") == format!("{reader:?}")).unwrap().1;
        assert!(sound.contains(from), "{from:?} is not in the {reader:?} file");
        let message = reader.read(sound.replacen(from, to, 1).as_bytes()).unwrap_err().to_string();
        assert!(message.contains(expected), "{to:?} gave: {message}");
    }
}

/// Lists of a thousand knots each fit into a small file; the values they ask for do not.
#[test]
fn products_of_counts_are_checked_before_memory_is_asked_for() {
    let list: String = (0..1000).map(|i| format!(" {}", f64::from(i) * 0.09)).collect();
    let head = format!(
        "sigma 1000{list}\npsi 1000{list}\ntheta 1000{list}\nphi 1000{list}\nTypeColorModel BW\nbw def 1 enddef"
    );
    let message = Reader::Ddr.read(head.as_bytes()).unwrap_err().to_string();
    assert!(message.contains("a count of 1000000000000 values"), "{message}");
    let head = format!(
        "Symmetry Asymmetrical\nSpectralContent XYZ\nScatterType BRDF\nAngleOfIncidence 1000{list}\nSampleRotation 1000{list}\n\
         ScatterRadial 1000{list}\nScatterAzimuth 1000{list}\nTristimulusX DataBegin"
    );
    let message = Reader::Zemax.read(head.as_bytes()).unwrap_err().to_string();
    assert!(message.contains("a count of 1000000000000 values"), "{message}");
}

/// Words of the formats, numbers good and bad, and noise.
fn words() -> impl Strategy<Value = String> {
    let vocabulary: Vec<&str> = [DDR, SDR, ZEMAX].iter().flat_map(|text| text.split_whitespace()).collect();
    let word = prop_oneof![
        8 => proptest::sample::select(vocabulary).prop_map(String::from),
        1 => any::<f64>().prop_map(|x| x.to_string()),
        1 => any::<i64>().prop_map(|x| x.to_string()),
        1 => "\\PC{1,8}",
    ];
    proptest::collection::vec((word, prop_oneof![Just(" "), Just("\n"), Just("\r\n"), Just("\t")]), 0..120)
        .prop_map(|words| words.into_iter().flat_map(|(word, space)| [word, space.to_string()]).collect())
}

fn read_with_all(bytes: &[u8]) {
    sniff(bytes);
    for (reader, _) in READERS {
        // Whether it is an error is not the question here; a panic would fail the test.
        let _ = reader.read(bytes);
    }
}

fn own_and_golden_files() -> Vec<Vec<u8>> {
    let mut files: Vec<Vec<u8>> = READERS.iter().map(|(_, text)| text.as_bytes().to_vec()).collect();
    if let Some(shared) = common::shared() {
        for name in ["a3.ddr", "s3.ddr", "t3.ddt", "zemax_plane.bsdf", "zemax_4d.bsdf"] {
            files.push(std::fs::read(shared.join("golden").join(name)).unwrap());
        }
    }
    files
}

proptest! {
    #[test]
    fn arbitrary_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        read_with_all(&bytes);
    }

    #[test]
    fn arbitrary_words_never_panic(text in words()) {
        read_with_all(text.as_bytes());
    }
}

#[test]
fn mutated_files_never_panic() {
    for bytes in own_and_golden_files() {
        hostile::mutations(&bytes, |bytes| {
            read_with_all(bytes);
            true
        });
    }
}
