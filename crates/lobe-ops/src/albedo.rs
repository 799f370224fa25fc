//! Directional-hemispherical reflectance or transmittance: the share of the light from one direction that is scattered.

use lobe_table::specular;
use lobe_table::specular::reference::zenith;
use serde::Serialize;

use crate::directions::spherical;
use crate::hemisphere::{Effort, Panels, integrate};
use crate::pairs::eval_pairs;
use crate::samples::signed_edges;
use crate::{Aspect, OnBackend, Subject};

/// The share of the light from one direction that is scattered: the integral of `f cos(theta_o)` over the hemisphere.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Albedo {
    /// The polar angle of the light, in radians.
    pub theta: f64,
    /// The azimuth of the light, in radians.
    pub phi: f64,
    /// One value per channel. No passive material exceeds 1.
    pub values: Vec<f64>,
    /// The largest estimated error of a channel.
    pub error: f64,
}

impl Albedo {
    /// The largest channel.
    pub fn largest(&self) -> f64 {
        self.values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }

    /// The smallest channel.
    pub fn smallest(&self) -> f64 {
        self.values.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

/// The albedo of anything for light at a polar angle and an azimuth, in radians, by adaptive quadrature in `panels`.
pub fn albedo<'a>(
    scattering: impl Into<OnBackend<'a>>,
    aspect: Aspect,
    [theta, phi]: [f64; 2],
    panels: &Panels,
    effort: Effort,
) -> Albedo {
    let (scattering, light) = (scattering.into(), spherical(theta, phi));
    let integral = integrate(panels, scattering.channels().count(), effort, |viewers, out| {
        let pairs: Vec<_> = viewers.iter().map(|&viewer| aspect.place(light, viewer)).collect();
        out.copy_from_slice(&eval_pairs(scattering, &pairs));
    });
    Albedo { theta, phi, values: integral.values, error: integral.error }
}

/// The albedo of a file for light at a polar angle and an azimuth, in radians, with the quadrature that suits its
/// representation: between the knots for grids; the exact sum over the patches for Klems matrices; refined toward the
/// mirror direction for all others.
pub fn albedo_of(subject: &Subject, aspect: Aspect, incidence: [f64; 2], effort: Effort) -> Albedo {
    let exact = subject.data(aspect).and_then(|data| data.representation().albedo(aspect, incidence));
    match exact {
        Some(values) => Albedo { theta: incidence[0], phi: incidence[1], values, error: 0.0 },
        None => albedo(&subject.material, aspect, incidence, &subject.panels(aspect, incidence), effort),
    }
}

/// The albedo of every slice of a table, `[sigma][psi]`, including negative values, as interpolated with the default
/// edge policy.
///
/// For a transmission table it is the transmittance.
pub fn albedo_of_samples(samples: &specular::Data, effort: Effort) -> Vec<Albedo> {
    let knots = samples.knots();
    let edges = signed_edges();
    let channels = samples.channels().count();
    let slice = |sigma: f64, psi: f64| {
        let polar = zenith(samples, &edges, sigma);
        let panels = Panels::of_knots(polar, psi, &knots[2], &knots[3]);
        let integral = integrate(&panels, channels, effort, |viewers, out| {
            let mut texel = vec![0.0; channels];
            for (viewer, out) in viewers.iter().zip(out.chunks_exact_mut(channels)) {
                // The slice at the horizon is included, although no light arrives from there.
                let light = spherical(sigma, psi);
                let [.., theta, phi] = lobe_table::specular::coords::directions_to_angles(light, *viewer, |_| polar);
                lobe_table::specular::reference::eval_angles(samples, &edges, [sigma, psi, theta, phi], &mut texel);
                out.iter_mut().zip(&texel).for_each(|(out, &value)| *out = value as f32);
            }
        });
        Albedo { theta: sigma, phi: psi, values: integral.values, error: integral.error }
    };
    knots[0].iter().flat_map(|&sigma| knots[1].iter().map(move |&psi| (sigma, psi))).map(|(s, p)| slice(s, p)).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::testing::{Exact, degrees, gold};
    use lobe_model::{Lambert, goniometer};

    #[test]
    fn lambert_reflects_its_albedo() {
        let model = Exact(Lambert { albedo: [0.9, 0.5, 0.0] });
        for theta in [0.0, 0.7, 1.5] {
            let panels = Panels::graded(theta, 2.0);
            let found = albedo(&model, Aspect::REFLECTION, [theta, 2.0], &panels, Effort::default());
            for (x, expected) in found.values.iter().zip([0.9, 0.5, 0.0]) {
                assert!((x - expected).abs() < 1e-4, "{found:?}");
            }
        }
    }

    #[test]
    fn a_narrow_lobe_agrees_with_the_model() {
        let model = gold(0.15);
        for theta in [0.2_f64, 0.9, 1.3] {
            let light = spherical(theta, 0.4);
            let expected = lobe_model::albedo(&model, light, 800);
            let panels = Panels::graded(theta, 0.4);
            let found = albedo(&Exact(model), Aspect::REFLECTION, [theta, 0.4], &panels, Effort::default());
            for (x, expected) in found.values.iter().zip(expected) {
                assert!((x - expected).abs() < 3e-4, "{x} is not {expected} at {theta}");
            }
        }
    }

    #[test]
    fn slices_of_a_table_are_integrated_as_they_are_interpolated() {
        let knots = [
            degrees(&[0.0, 30.0, 60.0, 90.0]),
            degrees(&[0.0, 90.0, 360.0]),
            degrees(&[0.0, 3.0, 10.0, 40.0, 180.0]),
            degrees(&[0.0, 90.0, 180.0, 270.0, 360.0]),
        ];
        let samples = goniometer::measure(&Lambert { albedo: [0.9, 0.5, 0.0] }, knots, || {}).expect("a table");
        let albedos = albedo_of_samples(&samples, Effort::default());
        assert_eq!(albedos.len(), 12);
        for found in albedos {
            for (x, expected) in found.values.iter().zip([0.9, 0.5, 0.0]) {
                assert!((x - expected).abs() < 1e-4, "{found:?}");
            }
        }
    }

    #[test]
    fn patches_of_a_window_are_summed() {
        use lobe_table::window::klems::{AngleBasis, KlemsMatrix};
        use lobe_table::window::{Band, Block, Blocks, Component, Data};
        use lobe_table::{Aspect, Representation};
        let basis = AngleBasis::full();
        let values = vec![0.3 / PI as f32; basis.patches().pow(2)];
        let matrix = KlemsMatrix::new(basis.clone(), basis, values).expect("a matrix");
        let mut window = Blocks::default();
        window.set(Block::ReflectionBack, Component::Klems(matrix));
        let data = Data { bands: vec![Band { wavelength: "Visible".into(), window }] };
        let found = data.albedo(Aspect::REFLECTION, [0.5, 0.0]).expect("a block");
        assert!((found[0] - 0.3).abs() < 1e-6, "{found:?}");
        assert_eq!(data.albedo(Aspect::TRANSMISSION, [0.5, 0.0]), None);
    }
}
