//! Computes where a model is above and below the measurement.

use lobe::Scatter;
use lobe_ops::compare::Spheres;

use crate::evaluate::Progress;
use crate::geometry::{from_disk, incident};
use crate::quantity::Quantity;
use crate::shown::Shown;
use crate::slice::{Slice, slice};
use crate::tables::Facts;
use crate::view::View;

/// Evaluates a model for light from `wi` to `wo`, unit vectors that point away from the surface, and writes one value
/// per channel.
pub type Values<'a> = dyn Fn([f64; 3], [f64; 3], &mut [f64]) + Sync + 'a;

/// A model that was fitted to a material, for comparison on a page.
pub struct Fitted<'a> {
    /// Reflection or transmission of light from the side that is shown.
    pub scatter: Scatter,
    /// The number of channels of the model.
    pub channels: usize,
    /// The quantity of the model that is compared.
    pub modelled: Quantity,
    /// The quantity of the material that it is compared with.
    pub measured: Quantity,
    /// The values of the model.
    pub f: Box<Values<'a>>,
    /// Facts about the fit, for readers.
    pub facts: Vec<Facts>,
    /// The difference of two spheres, of the material and of the model; `None` if they have no colours, or not all of
    /// the material was fitted.
    pub spheres: Option<Spheres>,
}

/// The disk of an incidence, with the differences between a model and the measurement.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Residual {
    /// The measurement.
    pub slice: Slice,
    /// The model minus the measurement, relative to the measurement or to the mean of the disk, whichever is larger;
    /// `None` outside the disk and at directions that were not measured.
    pub difference: Vec<Option<f32>>,
}

impl Residual {
    /// The disk of light at the polar angle `sigma`.
    pub(crate) fn new(shown: Shown<'_>, fitted: &Fitted<'_>, sigma: f64, size: usize, progress: &dyn Progress) -> Self {
        let Shown { subject, view } = shown;
        let view = &View { quantity: fitted.measured.clone(), ..view.clone() };
        let slice = slice(subject, view, sigma, fitted.scatter, size, progress);
        let measured = || slice.f.iter().zip(&slice.is_measured).filter(|(_, is_measured)| **is_measured);
        let (sum, count) = measured()
            .filter_map(|(f, _)| *f)
            .fold((0.0_f64, 0_usize), |(sum, count), f| (sum + f64::from(f), count + 1));
        let mean = sum / count.max(1) as f64;
        let wi = incident(view.side, sigma, view.psi);
        let mut texel = vec![0.0; fitted.channels];
        let difference = |at: usize| {
            let f = slice.f[at].filter(|_| slice.is_measured[at])?;
            let [x, y] = [at % size, at / size].map(|pixel| 2.0 * (pixel as f64 + 0.5) / size as f64 - 1.0);
            let wo = from_disk(view.side, fitted.scatter, view.psi, x, -y)?;
            (fitted.f)(wi, wo, &mut texel);
            let apart = fitted.modelled.exact(&texel) - f64::from(f);
            Some((apart / f64::from(f).abs().max(mean.abs()).max(f64::MIN_POSITIVE)) as f32)
        };
        let difference = (0..size * size).map(difference).collect();
        Residual { slice, difference }
    }

    /// The root mean square of the differences, and the largest.
    pub(crate) fn sizes(&self) -> [f64; 2] {
        let found = self.difference.iter().flatten().map(|apart| f64::from(*apart));
        let (squares, most, count) = found.fold((0.0, 0.0_f64, 0_usize), |(squares, most, count), apart| {
            (squares + apart * apart, most.max(apart.abs()), count + 1)
        });
        [(squares / count.max(1) as f64).sqrt(), most]
    }
}
