//! Zemax files: spellings, layouts and the conversion of values.

use std::path::Path;

use lobe_formats::{Format, Measured, sniff, zemax};
use lobe_table::{Channels, Scatter, specular};

fn header(symmetry: &str, content: &str, kind: &str) -> String {
    format!(
        "# Sample: velvet\n# =====\nSource\tMeasured\nSymmetry\t{symmetry}\nSpectralContent\t{content}\nScatterType\t{kind}\n\
         SampleRotation\t1\n0\nAngleOfIncidence\t2\n10\t50\t\nScatterAzimuth\t2\n0\t180\nScatterRadial\t3\n0\t5\t90\n\n"
    )
}

fn block(name: &str, start: u32) -> String {
    let row = |k: u32| format!("{}\t{}\t{}\t\n", start + k, start + k + 1, start + k + 2);
    format!("{name}\nDataBegin\nTIS\t0.25\n{}{}TIS 5e-1\n{}{}DataEnd\n", row(0), row(10), row(100), row(110))
}

fn read(text: &str) -> Measured<specular::Data> {
    assert_eq!(sniff(text.as_bytes()), Some(Format::Zemax));
    zemax::read(text.as_bytes(), Path::new("t.bsdf")).unwrap()
}

#[test]
fn values_and_facts_of_a_file_with_two_azimuths() {
    let measured = read(&(header("PlaneSymmetrical", "Monochrome", "BRDF") + &block("Monochrome", 1)));
    let samples = &measured.data;
    assert_eq!(samples.scatter(), Scatter::Reflection);
    assert_eq!(samples.knots().each_ref().map(Vec::len), [2, 1, 3, 3]);
    assert_eq!(samples.texel([0, 0, 1, 0]), [2.0]);
    assert_eq!(samples.texel([0, 0, 1, 1]), [12.0]);
    assert_eq!(samples.texel([0, 0, 1, 2]), [2.0], "360 degrees is 0 degrees");
    assert_eq!(samples.texel([1, 0, 2, 1]), [113.0]);
    assert_eq!(measured.tis, [0.25, 0.5]);
    assert_eq!(measured.source[0], ("comment".into(), "Sample: velvet".into()));
    assert!(measured.source.contains(&("ScatterType".into(), "BRDF".into())));
}

#[test]
fn every_spelling_of_the_four_dimensional_keyword() {
    for symmetry in
        ["Asymmetrical4D", "ASymmetrical4D", "ASYMMETRICAL4D", "asymmetrical4d", "ASymmetrical 4D", "Asymmetrical"]
    {
        let measured = read(&(header(symmetry, "Monochrome", "BRDF") + &block("Monochrome", 1)));
        assert_eq!(measured.data.knots()[3].len(), 2, "{symmetry} is not expanded");
    }
    let text = header("Spherical", "Monochrome", "BRDF") + &block("Monochrome", 1);
    let message = zemax::read(text.as_bytes(), Path::new("t.bsdf")).unwrap_err().to_string();
    let expected = "t.bsdf:4: found Symmetry `Spherical`; expected PlaneSymmetrical, Asymmetrical or Asymmetrical4D";
    assert_eq!(message, expected);
}

#[test]
fn tristimulus_blocks_and_transmission() {
    let blocks = [block("TristimulusX", 1), block("TristimulusZ", 2001), block("tristimulusy", 1001)].concat();
    let measured = read(&(header("Asymmetrical", "XYZ", "BTDF") + &blocks).replace('\n', "\r\n"));
    assert_eq!(measured.data.scatter(), Scatter::Transmission);
    assert_eq!(measured.data.channels(), &Channels::Xyz);
    assert_eq!(measured.data.texel([0, 0, 1, 1]), [12.0, 1012.0, 2012.0]);
    assert_eq!(measured.tis.len(), 6);
    let twice = header("Asymmetrical", "XYZ", "BRDF") + &block("TristimulusX", 1) + &block("TristimulusX", 1);
    let message = zemax::read(twice.as_bytes(), Path::new("t.bsdf")).unwrap_err().to_string();
    assert!(message.contains("found `TristimulusX`; expected the block `TristimulusY`"), "{message}");
}

#[test]
fn rotations_of_the_sample_are_the_psi_axis() {
    let text = "Symmetry ASymmetrical4D\nSpectralContent Monochrome\nScatterType BRDF\nSampleRotation 2\n0 90\nAngleOfIncidence 1\n20\n\
                ScatterAzimuth 1\n0\nScatterRadial 2\n0 90\nMonochrome\nDataBegin\nTIS 1\n1 2\nTIS 1\n3 4\nDataEnd\n";
    let samples = read(text).data;
    assert_eq!(samples.knots()[1], [0.0, std::f64::consts::FRAC_PI_2]);
    assert_eq!(samples.texel([0, 1, 0, 0]), [3.0]);
}
