//! A fit as a least-squares problem.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use lobe_colour::Channels;
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use rayon::prelude::*;

use crate::measurement::Measurement;
use crate::model::Model;
use crate::parameter::{Parameter, Scope};
use crate::real::{Dual, MOST};
use crate::weights::Weights;

/// The conversion of a difference to a residual.
#[derive(Clone, Debug)]
enum Scale {
    /// The difference is multiplied by the weight of its value.
    Weighted(Vec<f64>),
    /// The difference of logarithms, with this floor under the values.
    Log(f64),
}

/// The residuals of a measurement.
#[derive(Clone, Debug)]
pub(crate) struct Problem<'a> {
    model: Model,
    measurement: &'a Measurement,
    wavelengths: Vec<f64>,
    scale: Scale,
    /// Residuals larger than this count linearly instead of quadratically.
    robust: Option<f64>,
    /// The free numbers: those of the shape, then those of each channel.
    free: DVector<f64>,
    /// `true` for numbers that stay as they are, because their parameters are at a bound.
    pinned: Vec<bool>,
}

/// More residuals than this are worth several threads.
const MANY: usize = 4096;
/// The tolerance and the patience with which parameters are brought near their bounds.
const LOOSE: f64 = 1e-6;
const LOOSE_PATIENCE: usize = 8;
/// The share of the median value that logarithms and relative differences use as a floor.
const FLOOR: f64 = 1e-3;

impl<'a> Problem<'a> {
    /// The problem at a start: values of the parameters, shape first, then by channel.
    pub fn new(
        model: Model,
        measurement: &'a Measurement,
        wavelengths: &[f64],
        weights: Weights,
        start: &[f64],
    ) -> Self {
        let scale = match weights {
            Weights::Log | Weights::Relative => Scale::Log(floor(measurement)),
            Weights::Cosine => Scale::Weighted(normalised(measurement, |index| {
                let pair = &measurement.pairs[index];
                (pair.cos_i() * pair.cos_o()).sqrt()
            })),
            Weights::Value => Scale::Weighted(normalised(measurement, |_| 1.0)),
        };
        let mut problem = Problem {
            model,
            measurement,
            wavelengths: wavelengths.to_vec(),
            scale,
            robust: None,
            free: DVector::zeros(start.len()),
            pinned: vec![false; start.len()],
        };
        problem.place(start);
        problem
    }

    /// Sets other values of the parameters.
    pub fn place(&mut self, values: &[f64]) {
        let free: Vec<f64> = self.columns().zip(values).map(|(parameter, value)| parameter.free(*value)).collect();
        self.free = DVector::from_vec(free);
    }

    /// Makes residuals relative to the current values of the model.
    pub fn make_relative(&mut self) {
        let floor = floor(self.measurement);
        self.scale = Scale::Weighted(self.modelled().into_iter().map(|value| (value.abs() + floor).recip()).collect());
    }

    /// Makes outliers count less: those beyond 1.345 standard deviations, after Huber.
    pub fn make_robust(&mut self) {
        self.robust = None;
        let mut sizes: Vec<f64> = self.rows().iter().map(|row| row.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let median = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
        self.robust = Some(1.345 * 1.4826 * median).filter(|width| *width > 0.0);
    }

    /// The parameters of the columns, those of the channels repeated.
    pub fn columns(&self) -> impl Iterator<Item = &'static Parameter> {
        columns(self.model, self.measurement.channels.count())
    }

    /// The values of the parameters, in the order of the columns.
    pub fn values(&self) -> Vec<f64> {
        self.columns().zip(self.free.iter()).map(|(parameter, free)| parameter.value(*free)).collect()
    }

    /// Half the sum of the squared residuals; infinite if one of them is NaN.
    pub fn cost(&self) -> f64 {
        let cost = 0.5 * self.rows().iter().map(|row| row * row).sum::<f64>();
        if cost.is_finite() { cost } else { f64::INFINITY }
    }

    /// Minimises the cost, starting with the current parameters, of which those that end at a bound are pinned there;
    /// returns whether it converged.
    ///
    /// Near a bound the free number hardly moves its parameter, so that the search would take ever smaller steps.
    pub fn settle(self, tolerance: f64, patience: usize) -> (Self, bool) {
        let (mut problem, _) = self.minimise(LOOSE, patience.min(LOOSE_PATIENCE));
        problem.pin();
        let (mut problem, has_converged) = problem.minimise(tolerance, patience);
        if problem.release() { problem.minimise(tolerance, patience) } else { (problem, has_converged) }
    }

    /// Pins the parameters that are near a bound to it.
    fn pin(&mut self) {
        let columns: Vec<_> = self.columns().collect();
        for (column, parameter) in columns.into_iter().enumerate() {
            if let Some(bound) = parameter.near_bound(parameter.value(self.free[column])) {
                self.free[column] = parameter.free(bound);
                self.pinned[column] = true;
            }
        }
    }

    /// Releases the pinned parameters for which the cost falls away from the bound; `false` if there are none.
    fn release(&mut self) -> bool {
        let (rows, slopes) = (self.rows(), self.slopes());
        let columns: Vec<_> = self.columns().collect();
        let mut any = false;
        for (column, parameter) in columns.into_iter().enumerate() {
            let inner = parameter.inner(parameter.value(self.free[column]));
            let inward = inner - parameter.value(self.free[column]);
            let slope: f64 =
                rows.iter().zip(slopes.chunks_exact(self.free.len())).map(|(row, by)| row * by[column]).sum();
            if self.pinned[column] && slope * inward < 0.0 {
                self.free[column] = parameter.free(inner);
                self.pinned[column] = false;
                any = true;
            }
        }
        any
    }

    /// Minimises the cost, starting with the current parameters; returns whether it converged.
    pub fn minimise(self, tolerance: f64, patience: usize) -> (Self, bool) {
        if self.pinned.iter().all(|is_pinned| *is_pinned) {
            return (self, true);
        }
        // A step is small long before the cost stops falling if another number is large.
        let method = LevenbergMarquardt::new()
            .with_ftol(tolerance)
            .with_xtol(1e-3 * tolerance)
            .with_gtol(1e-12)
            .with_patience(patience);
        let (problem, report) = method.minimize(self);
        (problem, report.termination.was_successful())
    }

    /// The values of the model, `[pair][channel]`.
    pub fn modelled(&self) -> Vec<f64> {
        let (shapes, count, values) = (self.model.shapes(), self.measurement.channels.count(), self.values());
        let of_pair = |(index, out): (usize, &mut [f64])| {
            let mut parameters = values[..shapes].to_vec();
            let own = (values.len() - shapes) / count;
            for (channel, out) in out.iter_mut().enumerate() {
                parameters.truncate(shapes);
                parameters.extend_from_slice(&values[shapes + channel * own..][..own]);
                *out = self.model.f(&self.measurement.pairs[index], self.wavelengths[channel], &parameters);
            }
        };
        let mut out = vec![0.0; self.measurement.values.len()];
        if out.len() > MANY {
            out.par_chunks_exact_mut(count).enumerate().with_min_len(256).for_each(of_pair);
        } else {
            out.chunks_exact_mut(count).enumerate().for_each(of_pair);
        }
        out
    }

    /// The residuals, `[pair][channel]`.
    pub fn rows(&self) -> Vec<f64> {
        let mut rows = self.modelled();
        for (index, row) in rows.iter_mut().enumerate() {
            *row = self.residual(index, *row)[0];
        }
        rows
    }

    /// The residual of a modelled value, and its derivative.
    fn residual(&self, index: usize, modelled: f64) -> [f64; 2] {
        let measured = self.measurement.values[index];
        let [residual, slope] = match &self.scale {
            Scale::Weighted(weights) => [weights[index] * (modelled - measured), weights[index]],
            Scale::Log(floor) => {
                let above = modelled.max(0.0) + floor;
                [(above / (measured.max(0.0) + floor)).ln(), above.recip()]
            }
        };
        match self.robust {
            // The square root of Huber's smooth loss is a residual whose square is that loss.
            Some(width) if residual.abs() > 1e-6 * width => {
                let long = (residual / width).hypot(1.0);
                let root = (2.0 * (long - 1.0)).sqrt() * width;
                [root.copysign(residual), slope * (residual / (long * root)).abs()]
            }
            _ => [residual, slope],
        }
    }

    /// The derivatives of the residuals by the values of the parameters, row by row.
    pub fn slopes(&self) -> Vec<f64> {
        let (shapes, count, values) = (self.model.shapes(), self.measurement.channels.count(), self.values());
        let width = values.len();
        let own = (width - shapes) / count;
        let of_pair = |(index, out): (usize, &mut [f64])| {
            let mut parameters = [Dual { value: 0.0, slopes: [0.0; MOST] }; MOST];
            for (column, parameter) in parameters[..shapes].iter_mut().enumerate() {
                *parameter = Dual::parameter(values[column], column);
            }
            for (channel, row) in out.chunks_exact_mut(width).enumerate() {
                let first = shapes + channel * own;
                for column in 0..own {
                    parameters[shapes + column] = Dual::parameter(values[first + column], shapes + column);
                }
                let pair = &self.measurement.pairs[index];
                let found = self.model.f(pair, self.wavelengths[channel], &parameters[..shapes + own]);
                let slope = self.residual(index * count + channel, found.value)[1];
                let (of_shapes, of_channel) = found.slopes[..shapes + own].split_at(shapes);
                let scale = |(out, of): (&mut f64, &f64)| *out = slope * of;
                row[..shapes].iter_mut().zip(of_shapes).for_each(scale);
                row[first..first + own].iter_mut().zip(of_channel).for_each(scale);
            }
        };
        let mut out = vec![0.0; self.measurement.values.len() * width];
        if self.measurement.values.len() > MANY {
            out.par_chunks_exact_mut(count * width).enumerate().with_min_len(256).for_each(of_pair);
        } else {
            out.chunks_exact_mut(count * width).enumerate().for_each(of_pair);
        }
        out
    }
}

/// The parameters of a model for this many channels, in the order of a fit.
pub(crate) fn columns(model: Model, channels: usize) -> impl Iterator<Item = &'static Parameter> {
    let (shape, own) = model.parameters().split_at(model.shapes());
    debug_assert!(shape.iter().all(|parameter| parameter.scope == Scope::Shape));
    shape.iter().chain((0..channels).flat_map(move |_| own))
}

/// The wavelength of each channel in nm; `fallback` if it has none.
pub(crate) fn wavelengths(channels: &Channels, fallback: Option<f64>) -> Vec<f64> {
    match channels {
        Channels::Spectral(wavelengths) => wavelengths.clone(),
        other => vec![fallback.unwrap_or(f64::NAN); other.count()],
    }
}

/// Weights of the values, such that the weighted values have a mean square of 1.
fn normalised(measurement: &Measurement, weight: impl Fn(usize) -> f64) -> Vec<f64> {
    let count = measurement.channels.count();
    let mut weights: Vec<f64> = (0..measurement.values.len()).map(|index| weight(index / count)).collect();
    let squares: f64 = weights.iter().zip(&measurement.values).map(|(weight, value)| (weight * value).powi(2)).sum();
    let scale = (squares / weights.len().max(1) as f64).sqrt().max(f64::MIN_POSITIVE);
    weights.iter_mut().for_each(|weight| *weight /= scale);
    weights
}

/// The floor of logarithms.
fn floor(measurement: &Measurement) -> f64 {
    let mut positive: Vec<f64> = measurement.values.iter().copied().filter(|value| *value > 0.0).collect();
    positive.sort_by(f64::total_cmp);
    positive.get(positive.len() / 2).map_or(f64::MIN_POSITIVE, |median| FLOOR * median)
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, free: &DVector<f64>) {
        let moving = self.free.iter_mut().zip(&self.pinned).filter(|(_, is_pinned)| !**is_pinned);
        moving.zip(free.iter()).for_each(|((old, _), new)| *old = *new);
    }

    fn params(&self) -> DVector<f64> {
        let moving = self.free.iter().zip(&self.pinned).filter(|(_, is_pinned)| !**is_pinned);
        DVector::from_vec(moving.map(|(free, _)| *free).collect())
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let rows = self.rows();
        rows.iter().all(|row| row.is_finite()).then(|| DVector::from_vec(rows))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let (slopes, width) = (self.slopes(), self.free.len());
        let scales: Vec<f64> = self.columns().zip(self.free.iter()).map(|(column, free)| column.slope(*free)).collect();
        let moving: Vec<usize> = (0..width).filter(|column| !self.pinned[*column]).collect();
        let matrix = DMatrix::from_fn(self.measurement.values.len(), moving.len(), |row, index| {
            let column = moving[index];
            slopes[row * width + column] * scales[column]
        });
        matrix.iter().all(|slope| slope.is_finite()).then_some(matrix)
    }
}
