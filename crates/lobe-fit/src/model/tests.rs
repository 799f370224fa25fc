//! Formulas against `lobe_model`, and derivatives against differences.

use lobe_model as exact;

use super::*;
use crate::real::Dual;

fn geometries() -> Vec<Geometry> {
    lobe_ops::direction_pairs(200, 1.3).into_iter().map(|(wi, wo)| Geometry::new(wi, wo)).collect()
}

fn agree(model: Model, parameters: &[f64], expected: impl exact::Model) {
    for geometry in geometries() {
        let (found, expected) = (model.f(&geometry, 550.0, parameters), expected.f(geometry.wi, geometry.wo)[0]);
        assert!((found - expected).abs() <= 1e-9 * expected.max(1e-3), "{}: {found} for {expected}", model.name());
    }
}

#[test]
fn formulas_agree_with_the_reference() {
    let (albedo, specular) = ([0.3; 3], [0.4; 3]);
    agree(Model::Lambert, &[0.3], exact::Lambert { albedo });
    agree(Model::OrenNayar, &[20.0, 0.3], exact::OrenNayar { albedo, roughness: 20f64.to_radians() });
    agree(Model::Phong, &[30.0, 0.0, 0.4], exact::Phong { specular, exponent: 30.0 });
    agree(Model::Blinn, &[30.0, 0.0, 0.4], exact::Blinn { specular, exponent: 30.0 });
    agree(Model::Ward, &[0.2, 0.0, 0.4], exact::Ward { specular, alpha: [0.2; 2] });
    agree(Model::WardAnisotropic, &[0.2, 0.5, 0.0, 0.0, 0.4], exact::Ward { specular, alpha: [0.2, 0.5] });
    let conductor = exact::Conductor { ggx: exact::Ggx { alpha: [0.2, 0.5] }, eta: [1.0; 3], k: [1e9; 3] };
    agree(Model::GgxAnisotropic, &[0.2, 0.5, 0.0, 0.0, 1.0], conductor);
    for (n, k) in [(1.5, 1e-4), (0.3, 2.5), (0.7, 1e-4), (30.0, 40.0)] {
        let facets = exact::Conductor { ggx: exact::Ggx { alpha: [0.3; 2] }, eta: [n; 3], k: [k; 3] };
        agree(Model::GgxFresnel, &[0.3, n, k, 0.0, 1.0], facets);
    }
}

/// Rotating the material equals rotating both directions the other way.
#[test]
fn rotation_is_an_azimuth() {
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let turn = |[x, y, z]: [f64; 3]| [cos * x + sin * y, cos * y - sin * x, z];
    for geometry in geometries() {
        let back = Geometry::new(turn(geometry.wi), turn(geometry.wo));
        for model in [Model::GgxAnisotropic, Model::WardAnisotropic] {
            let found = model.f(&geometry, 550.0, &[0.2, 0.5, 30.0, 0.1, 0.3]);
            let expected = model.f(&back, 550.0, &[0.2, 0.5, 0.0, 0.1, 0.3]);
            assert!((found - expected).abs() < 1e-9 * expected.max(1.0));
        }
    }
}

#[test]
fn derivatives_are_limits_of_differences() {
    for model in Model::ALL {
        let parameters = model.parameters();
        let values: Vec<f64> = parameters.iter().map(|parameter| parameter.at(0.43)).collect();
        let duals: Vec<Dual> = values.iter().enumerate().map(|(index, &value)| Dual::parameter(value, index)).collect();
        for geometry in geometries() {
            let found = model.f(&geometry, 550.0, &duals);
            assert!((found.value - model.f(&geometry, 550.0, &values)).abs() <= 1e-12 * found.value.abs());
            for index in 0..values.len() {
                let step = 1e-6 * values[index].abs().max(1e-6);
                let at = |by: f64| {
                    let mut moved = values.clone();
                    moved[index] += by;
                    model.f(&geometry, 550.0, &moved)
                };
                let expected = (at(step) - at(-step)) / (2.0 * step);
                let scale = expected.abs().max(1e-4 * found.value / values[index].abs().max(1e-6));
                let name = parameters[index].name;
                assert!(
                    (found.slopes[index] - expected).abs() < 1e-3 * scale,
                    "{} by {name}: {} for {expected}",
                    model.name(),
                    found.slopes[index]
                );
            }
        }
    }
}

/// White materials in uniform light send no more light to a viewer than they receive: layers dim the base by the
/// direction of the viewer.
#[test]
fn renderer_models_create_no_light() {
    let cases: [(Model, &[f64]); 5] = [
        (Model::OpenPbr, &[0.0, 0.5, 1.5, 0.5, 1.0]),
        (Model::OpenPbr, &[1.0, 0.5, 1.5, 0.0, 1.0]),
        (Model::Gltf, &[0.5, 0.5, 1.0]),
        (Model::GltfClearcoat, &[0.0, 0.7, 1.0, 0.3, 1.0]),
        (Model::GltfSheen, &[0.0, 0.7, 1.0, 0.5, 1.0]),
    ];
    struct White(Model, &'static [f64]);
    impl exact::Model for White {
        fn f(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
            [self.0.f(&Geometry::new(wo, wi), 550.0, self.1); 3]
        }
    }
    for (model, parameters) in cases {
        for degrees in [0.0f64, 40.0, 70.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let [albedo, ..] = exact::albedo(&White(model, parameters), [sin, 0.0, cos], 200);
            assert!(albedo > 0.7 && albedo < 1.03, "{} at {degrees}: {albedo}", model.name());
        }
    }
}
