//! Files of fits.

use lobe_colour::Channels;
use lobe_fit::output::{Report, gltf, json, materialx, read, table, toml, total};
use lobe_fit::{Fit, Fitted, Measurement, Model, Request, fit, residuals};
use lobe_ops::Aspect;

fn fitted(model: Model, channels: Channels, parameters: Vec<Vec<f64>>) -> (Fit, Measurement) {
    let truth = Fitted::new(model, channels, Some(600.0), parameters);
    let measurement = Measurement::of_bsdf(&truth, Aspect::REFLECTION, 1.3, 600);
    let request = Request { starts: 8, wavelength: Some(600.0), ..Request::new(model) };
    (fit(&measurement, &request).expect("a fit"), measurement)
}

#[test]
fn json_and_toml_hold_the_same() {
    let (fit, measurement) = fitted(Model::Ggx, Channels::Rgb, [0.1, 0.2, 0.3].map(|d| vec![0.2, d, 0.5]).to_vec());
    let residuals = residuals(&fit.fitted, &measurement);
    assert!(residuals.relative_rms < 1e-4 && residuals.pairs == measurement.count(), "{residuals:?}");
    let report = Report { aspect: "reflection front".into(), fit: &fit, residuals: &residuals, delta_e: None };
    let json: serde_json::Value = serde_json::from_str(&json(&report)).expect("JSON");
    let text = toml(&report);
    toml::de::DeTable::parse(&text).expect("TOML");
    let alpha = json["parameters"]["alpha"].as_f64().expect("a number");
    assert!((alpha - 0.2).abs() < 1e-4);
    // Numbers and lists of TOML are also JSON.
    let line = |name: &str, nth: usize| {
        let line = text.lines().filter_map(|line| line.strip_prefix(&format!("{name} = "))).nth(nth);
        serde_json::from_str::<serde_json::Value>(line.expect("a line")).expect("a value")
    };
    assert_eq!(line("alpha", 0), json["parameters"]["alpha"]);
    assert_eq!(line("diffuse", 0), json["parameters"]["diffuse"]);
    assert_eq!(line("f0", 1), json["uncertainties"]["f0"]);
    assert_eq!(line("rms", 0), json["residuals"]["rms"]);
    assert!(text.starts_with("model = \"ggx\"\n") && json["model"] == "ggx", "{text}");
}

#[test]
fn a_gltf_material_has_the_parameters() {
    let parameters = [0.8, 0.5, 0.2].map(|color| vec![0.5, 0.4, 0.7, 0.2, color]).to_vec();
    let (fit, _) = fitted(Model::GltfClearcoat, Channels::Rgb, parameters);
    let file: serde_json::Value = serde_json::from_str(&gltf(&fit, "paint").expect("glTF")).expect("JSON");
    assert_eq!(
        (file["asset"]["version"].as_str(), file["extensionsUsed"][0].as_str()),
        (Some("2.0"), Some("KHR_materials_clearcoat"))
    );
    let material = &file["materials"][0];
    let close = |value: &serde_json::Value, expected: f64| (value.as_f64().expect("a number") - expected).abs() < 0.01;
    let base = &material["pbrMetallicRoughness"];
    assert!(close(&base["metallicFactor"], 0.5) && close(&base["roughnessFactor"], 0.4), "{file}");
    assert!(close(&base["baseColorFactor"][1], 0.5) && close(&base["baseColorFactor"][3], 1.0), "{file}");
    let coat = &material["extensions"]["KHR_materials_clearcoat"];
    assert!(close(&coat["clearcoatFactor"], 0.7) && close(&coat["clearcoatRoughnessFactor"], 0.2), "{file}");
    assert_eq!(material["name"].as_str(), Some("paint"));
}

#[test]
fn a_materialx_document_is_well_formed_and_named() {
    let parameters = [0.8, 0.5, 0.2].map(|color| vec![0.5, 0.4, 1.5, 0.2, 0.5, 20.0, color]).to_vec();
    let (fit, _) = fitted(Model::OpenPbrAnisotropic, Channels::Rgb, parameters);
    let text = materialx(&fit, "1 gold & silver").expect("MaterialX");
    let mut reader = quick_xml::Reader::from_str(&text);
    loop {
        match reader.read_event().expect("XML") {
            quick_xml::events::Event::Eof => break,
            _ => continue,
        }
    }
    assert!(text.contains("<open_pbr_surface name=\"material_1_gold___silver_shader\""), "{text}");
    assert!(text.contains("nodename=\"tangent_turned\"") && text.contains("specular_ior"), "{text}");
    let (fit, _) = fitted(Model::OrenNayar, Channels::Mono, vec![vec![30.0, 0.4]]);
    let text = materialx(&fit, "clay").expect("MaterialX");
    let roughness =
        format!("name=\"diffuse_roughness\" type=\"float\" value=\"{}", 30f64.to_radians().to_string().split_at(5).0);
    assert!(text.contains("standard_surface") && text.contains(&roughness), "{text}");
}

#[test]
fn tables_hold_the_parameters_and_the_total() {
    let (fit, _) = fitted(Model::Abg, Channels::Spectral(vec![633.0]), vec![vec![1e-3, 2.0, 0.01]]);
    let text = table(&fit).expect("a table");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("wavelength_um,A,B,g,TIS"));
    let numbers: Vec<f64> =
        lines.next().expect("a row").split(',').map(|word| word.parse().expect("a number")).collect();
    // The integral of 2 pi beta A / (B + beta^2) is pi A ln((B + 1) / B).
    let expected = [0.633, 0.01, 1e-3, 2.0, std::f64::consts::PI * 0.01 * (1.001e3_f64).ln()];
    for (found, expected) in numbers.iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < 2e-3, "{numbers:?}");
    }
}

/// The roughness of the surface determines the scattered share: (4 pi sigma / lambda)^2, for a spectrum within the
/// hemisphere.
#[test]
fn k_correlation_scatters_the_share_given_by_the_roughness() {
    let model = Fitted::new(Model::KCorrelation, Channels::Mono, Some(600.0), vec![vec![200.0, 4.0, 2.0]]);
    let expected = (4.0 * std::f64::consts::PI * 2.0 / 600.0_f64).powi(2);
    let found = total(&model, 0);
    assert!((found / expected - 1.0).abs() < 1e-2, "{found} for {expected}");
}

#[test]
fn formats_refuse_what_they_cannot_hold() {
    let (fit, _) = fitted(Model::Lambert, Channels::Xyz, vec![vec![0.3]; 3]);
    assert!(materialx(&fit, "x").expect_err("no colour").to_string().contains("found the channels X Y Z"));
    assert!(gltf(&fit, "x").expect_err("no model").to_string().contains("found a fit of lambert"));
    assert!(table(&fit).expect_err("no model").to_string().contains("abg, harvey-shack"));
}

/// The model of a file has the values of the model that was fitted.
#[test]
fn fits_are_read_from_json() {
    let (fit, measurement) = fitted(Model::Ggx, Channels::Rgb, [0.1, 0.2, 0.3].map(|d| vec![0.2, d, 0.5]).to_vec());
    let residuals = residuals(&fit.fitted, &measurement);
    let report = Report { aspect: "reflection front".into(), fit: &fit, residuals: &residuals, delta_e: None };
    let text = json(&report);
    let saved = read(&text).expect("a fit");
    assert_eq!((saved.aspect(), saved.channels.len()), (Aspect::REFLECTION, 3));
    assert!(
        saved.facts.iter().any(|(name, value)| name == "alpha" && value.starts_with("0.2000 ± ")),
        "{:?}",
        saved.facts
    );
    for (wi, wo) in [([0.6, 0.0, 0.8], [-0.6, 0.0, 0.8]), ([0.0, 0.0, 1.0], [0.0, 0.28, 0.96])] {
        let (mut found, mut expected) = ([0.0; 3], [0.0; 3]);
        saved.fitted.f(wi, wo, &mut found);
        fit.fitted.f(wi, wo, &mut expected);
        assert_eq!(found, expected);
    }
    for (from, to, found) in [
        ("\"ggx\"", "\"gx\"", "the model \"gx\""),
        ("reflection front", "reflection top", "the aspect"),
        ("\"alpha\"", "\"alfa\"", "no alpha of channel 0"),
        ("{", "[", "expected JSON"),
    ] {
        let error = read(&text.replacen(from, to, 3)).expect_err(to).to_string();
        assert!(error.contains(found), "{error}");
    }
}
