//! NIST's expansion of sintered PTFE against the measurement that it was fitted to.

use lobe::{Channels, Material, formats};
use lobe_testing::files::shared_file;

#[test]
fn published_coefficients_reproduce_the_published_measurement() {
    let paths = ["coeff", "data"].map(|what| shared_file(&format!("data/nist_mueller_csv/PTFE.{what}.csv")));
    let [Some(coefficients), Some(measured)] = paths else { return };
    let material = Material::open(coefficients).expect("coefficients");
    let (_, measured) = formats::open(&measured).expect("a measurement");
    let data = &measured.parts[0].data;
    assert_eq!(material.channels(), &Channels::Spectral(vec![351.0, 532.0, 633.0, 1064.0]));
    assert_eq!(&data.representation().channels(), material.channels());
    let direction = |theta: f64, phi: f64| {
        [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()].map(|component| component as f32)
    };
    let (mut wi, mut wo, mut wanted) = (Vec::new(), Vec::new(), Vec::new());
    for ([theta_i, phi_i, theta_o, phi_o], values) in data.representation().samples().expect("samples") {
        wi.push(direction(theta_i, phi_i));
        wo.push(direction(theta_o, phi_o));
        wanted.extend_from_slice(values);
    }
    let mut found = vec![0.0; wanted.len()];
    material.eval_batch(&wi, &wo, &mut found);
    assert!(wi.len() > 500, "{} pairs of directions", wi.len());
    let errors: Vec<f32> = found.iter().zip(&wanted).map(|(found, wanted)| found / wanted - 1.0).collect();
    let rms = (errors.iter().map(|error| f64::from(error * error)).sum::<f64>() / errors.len() as f64).sqrt();
    // The fit and the measurement were published separately; a difference of 0.023 was found.
    println!("{} values, rms difference {rms:.4}", errors.len());
    assert!(rms < 0.03, "rms difference {rms}");
}
