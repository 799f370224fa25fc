//! DDR, DDT, SDR and SDT: the conversion of values, and writing and reading again without loss.

use std::f64::consts::PI;
use std::path::Path;

use lobe_formats::{Format, Measured, ddr, open, sdr};
use lobe_table::specular::reference::eval;
use lobe_table::{Channels, Data, Edges, Scatter, specular};
use proptest::prelude::*;

fn read(text: &str) -> Measured<specular::Data> {
    ddr::read(text.as_bytes(), Path::new("t.ddr"), Scatter::Reflection).unwrap()
}

fn error(text: &str) -> String {
    ddr::read(text.as_bytes(), Path::new("t.ddr"), Scatter::Reflection).unwrap_err().to_string()
}

fn degrees(knots: &[f64]) -> Vec<f64> {
    knots.iter().map(|knot| (knot.to_degrees() * 1e6).round() / 1e6).collect()
}

/// One channel, sigma 0 and 60, phi 0 and 180, theta 0, 20, 40 and 180 degrees, values from a function of the node.
fn mono(symmetry: &str, quantity: &str, kbdf: &str, f: impl Fn(f64, f64, f64) -> f64) -> String {
    let mut text = format!(
        "TypeSym {symmetry}\nTypeColorModel BW\nTypeData {quantity}\nsigma 2\n 0 60\nphi 2\n 0 180\ntheta 4\n 0 20 40 180\nbw\n{kbdf}\n def\n"
    );
    for sigma in [0.0, 60.0] {
        for phi in [0.0, 180.0] {
            for theta in [0.0, 20.0, 40.0, 180.0] {
                text += &format!(" {}", f(sigma, phi, theta));
            }
            text += "\n";
        }
    }
    text + " enddef\n"
}

#[test]
fn luminance_is_pi_f_times_kbdf() {
    let samples = read(&mono("ASymmetrical", "Luminance Absolute", "kbdf 0.5 2", |s, h, t| s + h + t)).data;
    assert_eq!(samples.texel([0, 0, 1, 1]), [(200.0 * 0.5 / PI) as f32]);
    assert_eq!(samples.texel([1, 0, 3, 0]), [(240.0 * 2.0 / PI) as f32]);
    // Without kbdf the factor is 1, and with no header keyword except the angles, the quantity is the same.
    let bare = read(&mono("ASymmetrical", "Luminance Absolute", "", |s, h, t| s + h + t)).data;
    assert_eq!(bare.texel([1, 0, 3, 0]), [(240.0 / PI) as f32]);
}

#[test]
fn plane_symmetry_fills_the_circle() {
    let samples = read(&mono("PlaneSymmetrical", "Luminance Absolute", "", |_, h, t| 1000.0 * h + t)).data;
    assert_eq!(degrees(&samples.knots()[3]), [0.0, 180.0, 360.0]);
    assert_eq!(samples.texel([1, 0, 2, 2]), samples.texel([1, 0, 2, 0]));

    let text = "TypeColorModel BW sigma 1 0 theta 1 0 phi 3 10 90 170 bw def 1 2 3 enddef";
    let samples = read(text).data;
    assert_eq!(degrees(&samples.knots()[3]), [10.0, 90.0, 170.0, 190.0, 270.0, 350.0]);
    let expected: Vec<f32> = [1.0, 2.0, 3.0, 3.0, 2.0, 1.0].map(|v: f64| (v / PI) as f32).into();
    assert_eq!(samples.values(), expected);

    let one = read("TypeColorModel BW sigma 1 0 theta 1 0 phi 1 0 bw def 1 enddef").data;
    assert_eq!(degrees(&one.knots()[3]), [0.0]);
    let message = error("TypeColorModel BW sigma 1 0 theta 1 0\nphi 2 0 360\nbw def 1 1 enddef");
    assert_eq!(message, "t.ddr:2: found 360; expected phi from 0 to 180 degrees in a plane-symmetrical file");
}

#[test]
fn intensity_is_divided_by_the_cosine_but_not_at_the_horizon() {
    let cosine = |s: f64, h: f64, t: f64| (s + if h == 0.0 { -t } else { t }).to_radians().cos();
    // Below the horizon, the file holds a number that would be 1e7 after the division.
    let intensity = |s, h, t| if cosine(s, h, t) > 1e-9 { 0.25 * cosine(s, h, t) } else { 5.0 };
    let samples = read(&mono("ASymmetrical", "Intensity Absolute", "kbdf 1 1", intensity)).data;
    for value in samples.values() {
        assert!((value - 0.25).abs() < 1e-6, "{:?}", samples.values());
    }
    // Light at 90 degrees: the mirror direction is on the horizon, and toward phi 180 everything is below it.
    let text =
        "TypeSym ASymmetrical TypeColorModel BW TypeData Intensity Absolute sigma 1 90 phi 2 0 180 theta 3 0 30 90
                bw def 7 0.5 1 7 7 7 enddef";
    let samples = read(text).data;
    let phi0: Vec<f32> = (0..3).map(|t| samples.texel([0, 0, t, 0])[0]).collect();
    assert!(phi0.iter().all(|value| (value - 1.0).abs() < 1e-6), "{phi0:?}");
    assert!((0..3).all(|t| samples.texel([0, 0, t, 1]) == [0.0]));
}

/// The integral of f cos over the hemisphere on a grid of ordinary polar angles, by the reference evaluation.
fn reflectance(samples: &specular::Data, sigma: f64) -> f64 {
    let wi = [sigma.sin(), 0.0, sigma.cos()];
    let (rings, sectors) = (360, 720);
    let mut sum = 0.0;
    let mut out = [0.0];
    for ring in 0..rings {
        let theta = (f64::from(ring) + 0.5) * PI / 2.0 / f64::from(rings);
        for sector in 0..sectors {
            let phi = (f64::from(sector) + 0.5) * 2.0 * PI / f64::from(sectors);
            let wo = [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()];
            eval(samples, &Edges::default(), wi, wo, &mut out);
            sum += out[0] * theta.cos() * theta.sin();
        }
    }
    sum * (PI / 2.0 / f64::from(rings)) * (2.0 * PI / f64::from(sectors))
}

#[test]
fn relative_values_are_scaled_to_the_reflectance_in_kbdf() {
    for quantity in ["Luminance Relative", "Intensity Relative"] {
        let lobe = |_: f64, _: f64, t: f64| 3.0 * (-t / 30.0).exp() + 0.1;
        let samples = read(&mono("PlaneSymmetrical", quantity, "kbdf 0.5 0.125", lobe)).data;
        for (sigma, kbdf) in [(0.0_f64, 0.5), (60.0, 0.125)] {
            let got = reflectance(&samples, sigma.to_radians());
            assert!((got / kbdf - 1.0).abs() < 1e-3, "{quantity}, sigma {sigma}: {got}, not {kbdf}");
        }
    }
    // A diffuse table has f = kbdf / pi.
    let samples = read(&mono("PlaneSymmetrical", "Luminance Relative", "kbdf 0.5 0.125", |_, _, _| 77.0)).data;
    assert!((f64::from(samples.texel([0, 0, 0, 0])[0]) * PI / 0.5 - 1.0).abs() < 1e-4);
    assert!((f64::from(samples.texel([1, 0, 0, 0])[0]) * PI / 0.125 - 1.0).abs() < 1e-4);
    // A slice of zeros can only have the reflectance 0.
    let blank = |s: f64, _: f64, _: f64| if s == 0.0 { 1.0 } else { 0.0 };
    assert!(
        read(&mono("PlaneSymmetrical", "Luminance Relative", "kbdf 0.5 0", blank)).data.texel([1, 0, 0, 0]) == [0.0]
    );
    assert!(error(&mono("PlaneSymmetrical", "Luminance Relative", "kbdf 0.5 0.1", blank)).contains("kbdf 0.1"));
    assert!(error(&mono("PlaneSymmetrical", "Luminance Relative", "", |_, _, _| 1.0)).contains("expected `kbdf`"));
}

/// Slices of one value each: the work per slice has to be small.
#[test]
fn thousands_of_slices_are_scaled_at_once() {
    let sigma: String = (0..4000).map(|i| format!(" {}", f64::from(i) * 0.02)).collect();
    let head = "TypeSym ASymmetrical\nTypeColorModel BW\nTypeData Luminance Relative\n";
    let psi: String = (0..10).map(|i| format!(" {}", i * 20)).collect();
    let (targets, values) = (" 0.5".repeat(40_000), " 7".repeat(40_000));
    let text =
        format!("{head}sigma 4000{sigma}\npsi 10{psi}\nphi 1 0\ntheta 1 0\nbw kbdf{targets}\ndef{values}\nenddef\n");
    let samples = read(&text).data;
    let wanted = 0.5 / PI;
    assert!(samples.values().iter().all(|f| (f64::from(*f) / wanted - 1.0).abs() < 1e-3), "{:?}", samples.values()[0]);
}

#[test]
fn blocks_come_in_any_order_but_each_once() {
    let head = "typesym axisymmetrical TYPECOLORMODEL rgb sigma 1 10 phi 1 0 theta 1 0\n";
    let samples = read(&format!("{head} blue def 3 enddef RED def 1 enddef gre def 2 enddef")).data;
    assert_eq!(samples.values(), [1.0, 2.0, 3.0].map(|v: f64| (v / PI) as f32));
    assert!(
        error(&format!("{head}red def 1 enddef\nred def 1 enddef"))
            .contains("t.ddr:3: found `red`; expected a block `gre`")
    );
    assert!(error(&format!("{head}red def 1 enddef gre def 2 enddef")).contains("expected a block `blu`"));
    assert!(error(&format!("{head}red def 1 enddef gre def 1 enddef blu def 1 enddef red")).contains("nothing after"));
    let spectral = "TypeColorModel spectral 2 sigma 1 10 phi 1 0 theta 1 0 ";
    let samples = read(&format!("{spectral} wl 550 def 1 enddef wl 400.5 def 2 enddef")).data;
    assert_eq!(samples.channels(), &Channels::Spectral(vec![550.0, 400.5]));
    assert!(
        error(&format!("{spectral} wl 550 def 1 enddef wl 550 def 2 enddef")).contains("a second block for 550 nm")
    );
}

#[test]
fn the_header_is_kept_for_people() {
    let text = b";; Lacquer 7\r\n;; ------\r\nSource Measured\r\nDevice Gonio 2000 \xef\r\nTypeSym ASymmetrical 4D\r\n\
        TypeColorModel BW sigma 1 0\r\npsi 2 0 90 phi 1 0 theta 1 0 bw def 1 2 enddef\x1a";
    let measured = ddr::read(text, Path::new("t.ddr"), Scatter::Reflection).unwrap();
    let source: Vec<(&str, &str)> = measured.source.iter().map(|(name, value)| (&**name, &**value)).collect();
    let expected = [
        ("comment", "Lacquer 7"),
        ("Source", "Measured"),
        ("Device", "Gonio 2000 \u{fffd}"),
        ("TypeSym", "ASymmetrical 4D"),
        ("TypeColorModel", "BW"),
    ];
    assert_eq!(source, expected);
    assert_eq!(degrees(&measured.data.knots()[1]), [0.0, 90.0]);
}

#[test]
fn sigmat_becomes_refraction_offsets() {
    let text = "TypeColorModel BW sigma 2 0 60 sigmat 0 35.25 phi 1 0 theta 1 0 bw def 1 2 enddef";
    let samples = ddr::read(text.as_bytes(), Path::new("t.ddt"), Scatter::Transmission).unwrap().data;
    assert_eq!(degrees(samples.refraction().unwrap()), [0.0, -24.75]);
    assert!(error("TypeColorModel BW sigmat 0 35 sigma 2 0 60").contains("before `sigmat`"));
}

/// Tables of any shape whose angles are `f32` degrees, as files have them.
fn tables() -> impl Strategy<Value = specular::Data> {
    let axis = |limit: f32, most: usize| {
        proptest::collection::btree_set(0..1000_u32, 1..=most).prop_map(move |set| {
            set.into_iter().map(|k| f64::from(k as f32 * limit / 1000.0).to_radians()).collect::<Vec<_>>()
        })
    };
    let channels =
        prop_oneof![Just(Channels::Mono), Just(Channels::Rgb), Just(Channels::Spectral(vec![380.0, 555.5])),];
    (axis(90.0, 4), axis(360.0, 3), axis(180.0, 4), axis(360.0, 4), channels, any::<bool>())
        .prop_flat_map(|(sigma, psi, theta, phi, channels, refracted)| {
            let count = sigma.len() * psi.len() * theta.len() * phi.len() * channels.count();
            let value =
                prop_oneof![4 => -1.0e-3_f32..50.0, 1 => any::<f32>().prop_filter("finite", |v| v.abs() < 1e38)];
            (Just([sigma, psi, theta, phi]), Just(channels), proptest::collection::vec(value, count), Just(refracted))
        })
        .prop_map(|(knots, channels, values, refracted)| {
            if !refracted {
                return specular::Data::new(Scatter::Reflection, knots, channels, values).unwrap();
            }
            let zenith = |sigma: &f64| f64::from((sigma.to_degrees() * 0.6) as f32).to_radians();
            let offsets = knots[0].iter().map(|sigma| zenith(sigma) - sigma).collect();
            specular::Data::new(Scatter::Transmission, knots, channels, values)
                .unwrap()
                .with_refraction(offsets)
                .unwrap()
        })
}

proptest! {
    #[test]
    fn a_written_table_is_restored(samples in tables()) {
        let folder = tempfile::tempdir().unwrap();
        let name = if samples.scatter() == Scatter::Reflection { "t.ddr" } else { "t.DDT" };
        let path = folder.path().join(name);
        ddr::write(&samples, &path).unwrap();
        let (format, document) = open(&path).unwrap();
        prop_assert_eq!(format, Format::Ddr);
        let Some(Data::Specular(back)) = document.only() else { panic!("no table") };
        prop_assert_eq!(back.values(), samples.values());
        prop_assert_eq!(back.channels(), samples.channels());
        prop_assert_eq!(back.scatter(), samples.scatter());
        let near = |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15);
        for axis in 0..4 {
            prop_assert!(back.knots()[axis] == samples.knots()[axis]);
        }
        // The difference of two angles and their sum differ by one rounding.
        prop_assert!(near(back.refraction().unwrap_or(&[]), samples.refraction().unwrap_or(&[])));
        // From then on, everything is the same to the last bit.
        ddr::write(back, &path).unwrap();
        let document = open(&path).unwrap().1;
        let Some(Data::Specular(again)) = document.only() else { panic!("no table") };
        prop_assert_eq!(again, back);
    }
}

#[test]
fn writers_refuse_misleading_extensions() {
    let folder = tempfile::tempdir().unwrap();
    let table = |scatter, channels: Channels| {
        let values = vec![1.0; channels.count()];
        specular::Data::new(scatter, [vec![0.0], vec![0.0], vec![0.0], vec![0.0]], channels, values).unwrap()
    };
    let message =
        |name: &str, samples: &specular::Data| ddr::write(samples, &folder.path().join(name)).unwrap_err().to_string();
    assert!(message("a.ddr", &table(Scatter::Transmission, Channels::Mono)).contains("expected the extension .ddt"));
    assert!(message("a.ddt", &table(Scatter::Reflection, Channels::Mono)).contains("expected the extension .ddr"));
    assert!(message("a.ddr", &table(Scatter::Reflection, Channels::Xyz)).contains("found the channels X Y Z"));
    assert!(message("none/a.ddr", &table(Scatter::Reflection, Channels::Mono)).contains("a file that can be written"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "a failed write leaves nothing");
}

#[test]
fn mirror_reflectances_are_read_interpolated_and_written() {
    let text = "source Measured\ntypecolormodel RGB\nSIGMA 3\n 0 45 90\nBLU\ndef 3 6 9 enddef RED def 0.04 0.5 1 enddef gre def 0 0 0 enddef\n";
    let measured = sdr::read(text.as_bytes(), Path::new("t.sdr"), Scatter::Reflection).unwrap();
    assert_eq!(measured.source[0], ("source".into(), "Measured".into()));
    let specular = measured.data;
    assert_eq!(specular.values(), [0.04, 0.0, 3.0, 0.5, 0.0, 6.0, 1.0, 0.0, 9.0]);
    let at = specular.at(67.5_f64.to_radians(), 0.0);
    assert!((at[0] - 0.75).abs() < 1e-12 && (at[2] - 7.5).abs() < 1e-12);
    assert_eq!(specular.at(-1.0, 0.0)[2], 3.0);
    assert_eq!(specular.at(2.0, 0.0)[2], 9.0);

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.sdr");
    sdr::write(&specular, &path).unwrap();
    let (format, document) = open(&path).unwrap();
    assert_eq!(format, Format::Sdr);
    let Some(Data::Mirror(back)) = document.only() else { panic!("no mirror reflectance") };
    assert_eq!(*back, specular);
    assert!(sdr::write(&specular, &folder.path().join("t.sdt")).is_err());
}
