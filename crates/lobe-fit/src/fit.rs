//! Fits: from several starts on a few pairs to the best of them on all pairs.

use lobe_colour::Channels;
use rayon::prelude::*;
use thiserror::Error;

use crate::fitted::Fitted;
use crate::measurement::Measurement;
use crate::model::Model;
use crate::parameter::{Parameter, Scope, Spacing};
use crate::problem::{Problem, columns, wavelengths};
use crate::uncertainty::deviations;
use crate::weights::Weights;

/// The model to fit, and the options of the fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// The model.
    pub model: Model,
    /// The weights of differences.
    pub weights: Weights,
    /// `true` if outliers count linearly instead of quadratically.
    pub robust: bool,
    /// `true` if each channel has its own shape.
    pub per_channel: bool,
    /// The number of starting points.
    pub starts: usize,
    /// The wavelength in nm for channels without one.
    pub wavelength: Option<f64>,
}

impl Request {
    /// The usual options for a model.
    pub fn new(model: Model) -> Self {
        let weights = model.default_weights();
        Request { model, weights, robust: false, per_channel: false, starts: 24, wavelength: None }
    }
}

/// An estimated parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The parameter.
    pub parameter: &'static Parameter,
    /// The index of its channel; `None` if it belongs to all channels.
    pub channel: Option<usize>,
    /// The estimate.
    pub value: f64,
    /// The standard deviation; `None` if the parameter is at a bound, or is not determined by the measurement.
    pub uncertainty: Option<f64>,
    /// `true` if the estimate is at a bound.
    pub is_at_bound: bool,
}

/// A finished fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The request.
    pub request: Request,
    /// The meaning of the channels.
    pub channels: Channels,
    /// The parameters of the shape, then those of the channels.
    pub estimates: Vec<Estimate>,
    /// The number of pairs of directions.
    pub pairs: usize,
    /// The number of pairs that are 0 in all channels, which are not used.
    pub left_out: usize,
    /// `true` if the search converged.
    pub has_converged: bool,
    /// The model with these parameters.
    pub fitted: Fitted,
}

/// A model that cannot be fitted.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum FitError {
    /// There are fewer values than parameters.
    #[error("found {pairs} pairs of directions with values; expected at least {least} for the {model} model")]
    TooFew {
        /// The number of pairs found.
        pairs: usize,
        /// The number that the model needs.
        least: usize,
        /// The name of the model.
        model: &'static str,
    },
    /// Too many channels would share the shape.
    #[error("found {0} channels; expected at most {MOST_CHANNELS} that share a shape")]
    TooMany(usize),
    /// The model depends on the wavelength, which is not known.
    #[error("found channels without a wavelength; expected one for the {0} model")]
    NoWavelength(&'static str),
    /// No value is above 0.
    #[error("found no value above 0")]
    Dark,
    /// The model has no finite value near any start.
    #[error("found no start from which the {0} model could be fitted")]
    NoStart(&'static str),
}

/// The most channels that share a shape.
pub const MOST_CHANNELS: usize = 16;
/// The numbers of pairs of the first fits, from all starts and from the best of them.
const COARSE: [usize; 2] = [512, 1500];
/// The number of minima from which all channels are fitted.
const BEST: usize = 4;
/// Fits whose costs differ by less than this share are in the same minimum.
const SAME: f64 = 1e-3;
/// The number of rounds in which relative weights follow the model.
const ROUNDS: usize = 4;

/// Fits a model to a measurement.
///
/// # Errors
/// [`FitError`] says what is missing.
pub fn fit(measurement: &Measurement, request: &Request) -> Result<Fit, FitError> {
    let model = request.model;
    let count = measurement.channels.count();
    let nm = wavelengths(&measurement.channels, request.wavelength);
    if model.needs_wavelength() && nm.iter().any(|nm| !(nm.is_finite() && *nm > 0.0)) {
        return Err(FitError::NoWavelength(model.name()));
    }
    let least = 2 * model.parameters().len();
    if measurement.count() < least {
        return Err(FitError::TooFew { pairs: measurement.count(), least, model: model.name() });
    }
    if !measurement.values.iter().any(|value| *value > 0.0) {
        return Err(FitError::Dark);
    }
    if request.per_channel && count > 1 {
        let own = |channel| shared(&measurement.channel(channel), request, &nm[channel..=channel]);
        let fits: Vec<Fit> = (0..count).into_par_iter().map(own).collect::<Result<_, _>>()?;
        return Ok(joined(measurement, request, fits));
    }
    if count > MOST_CHANNELS {
        return Err(FitError::TooMany(count));
    }
    shared(measurement, request, &nm)
}

/// A fit of all channels with one shape.
fn shared(measurement: &Measurement, request: &Request, nm: &[f64]) -> Result<Fit, FitError> {
    let (model, weights) = (request.model, request.weights);
    let count = measurement.channels.count();
    let few = measurement.thinned(COARSE[0]);
    let grey = few.grey();
    let middle = [nm[count / 2]];
    // With logarithms, every lobe matters, however narrow, so that the first steps make progress.
    let first = |index: usize| {
        let start = start(model, index, &grey, &middle);
        let rough = Problem::new(model, &grey, &middle, Weights::Log, &start).minimise(1e-4, 8).0.values();
        let problem = Problem::new(model, &grey, &middle, weights, &rough).minimise(1e-6, 20).0;
        (problem.cost(), problem.values())
    };
    let mut grey_fits: Vec<_> = (0..request.starts.max(1)).into_par_iter().map(first).collect();
    grey_fits.retain(|(cost, _)| cost.is_finite());
    grey_fits.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Several starts lead to the same minimum, which may not be the best one on more pairs.
    grey_fits.dedup_by(|next, kept| (next.0 - kept.0).abs() <= SAME * kept.0);
    grey_fits.truncate(BEST);
    let more = measurement.thinned(COARSE[1]);
    let shapes = model.shapes();
    let second = |(_, values): &(f64, Vec<f64>)| {
        let values: Vec<f64> =
            model.parameters().iter().zip(values).map(|(parameter, value)| parameter.inner(*value)).collect();
        let mut start = values[..shapes].to_vec();
        (0..count).for_each(|_| start.extend_from_slice(&values[shapes..]));
        let problem = Problem::new(model, &more, nm, weights, &start).settle(1e-8, 20).0;
        (problem.cost(), problem.values())
    };
    let fits: Vec<_> = grey_fits.par_iter().map(second).collect();
    let best = fits.into_iter().filter(|(cost, _)| cost.is_finite()).min_by(|a, b| a.0.total_cmp(&b.0));
    let (_, start) = best.ok_or(FitError::NoStart(model.name()))?;
    let (problem, has_converged) = polished(Problem::new(model, measurement, nm, weights, &start), request);
    Ok(finished(measurement, request, nm, &problem, has_converged))
}

/// The last steps, on all pairs.
fn polished<'a>(problem: Problem<'a>, request: &Request) -> (Problem<'a>, bool) {
    // Smaller steps do not change the fourth digit of a residual, but may go on for long along what the measurement
    // hardly determines.
    const TOLERANCE: f64 = 1e-9;
    let (mut problem, mut has_converged) = problem.settle(TOLERANCE, 60);
    if request.weights == Weights::Relative {
        for _ in 0..ROUNDS {
            problem.make_relative();
            (problem, has_converged) = problem.minimise(TOLERANCE, 30);
        }
    }
    if request.robust {
        for _ in 0..ROUNDS {
            problem.make_robust();
            (problem, has_converged) = problem.minimise(TOLERANCE, 30);
        }
    }
    (problem, has_converged)
}

fn finished(
    measurement: &Measurement,
    request: &Request,
    nm: &[f64],
    problem: &Problem<'_>,
    has_converged: bool,
) -> Fit {
    let (model, count) = (request.model, measurement.channels.count());
    let values = problem.values();
    let bounds: Vec<bool> =
        columns(model, count).zip(&values).map(|(parameter, value)| parameter.is_at_bound(*value)).collect();
    let free: Vec<bool> = bounds.iter().map(|is_at_bound| !is_at_bound).collect();
    let deviations = deviations(&measurement.pairs, &problem.rows(), &problem.slopes(), &free);
    let (shapes, own) = (model.shapes(), model.parameters().len() - model.shapes());
    let estimate = |(index, parameter): (usize, &'static Parameter)| Estimate {
        parameter,
        channel: (parameter.scope == Scope::Channel).then(|| (index - shapes) / own.max(1)),
        value: values[index],
        uncertainty: deviations[index],
        is_at_bound: bounds[index],
    };
    let of_channel = |channel: usize| {
        let mut all = values[..shapes].to_vec();
        all.extend_from_slice(&values[shapes + channel * own..][..own]);
        all
    };
    Fit {
        request: *request,
        channels: measurement.channels.clone(),
        estimates: columns(model, count).enumerate().map(estimate).collect(),
        pairs: measurement.count(),
        left_out: measurement.left_out,
        has_converged,
        fitted: Fitted {
            model,
            aspect: lobe_ops::Aspect::REFLECTION,
            channels: measurement.channels.clone(),
            wavelengths: nm.to_vec(),
            parameters: (0..count).map(of_channel).collect(),
        },
    }
}

/// Combines the fits of single channels.
fn joined(measurement: &Measurement, request: &Request, fits: Vec<Fit>) -> Fit {
    let own = |(channel, fit): (usize, &Fit)| {
        fit.estimates
            .iter()
            .map(move |estimate| Estimate { channel: Some(channel), ..estimate.clone() })
            .collect::<Vec<_>>()
    };
    Fit {
        request: *request,
        channels: measurement.channels.clone(),
        estimates: fits.iter().enumerate().flat_map(own).collect(),
        pairs: measurement.count(),
        left_out: measurement.left_out,
        has_converged: fits.iter().all(|fit| fit.has_converged),
        fitted: Fitted {
            model: request.model,
            aspect: lobe_ops::Aspect::REFLECTION,
            channels: measurement.channels.clone(),
            wavelengths: fits.iter().flat_map(|fit| fit.fitted.wavelengths.clone()).collect(),
            parameters: fits.into_iter().flat_map(|fit| fit.fitted.parameters).collect(),
        },
    }
}

/// Starting values of the parameters: shapes spread evenly over their ranges, and amplitudes that fit the values.
fn start(model: Model, index: usize, measurement: &Measurement, nm: &[f64]) -> Vec<f64> {
    let parameters = model.parameters();
    let share = |column: usize| {
        // Incommensurable steps (the generalised golden section, as for directions).
        let dimensions = parameters.len() as f64;
        let g = (0..60).fold(1.5_f64, |g, _| (1.0 + g).powf(1.0 / (dimensions + 1.0)));
        0.06 + 0.88 * (0.5 + (index as f64 + 1.0) * g.powi(-(column as i32 + 1))).fract()
    };
    let mut values: Vec<f64> = parameters
        .iter()
        .enumerate()
        .map(|(column, parameter)| match (parameter.spacing, parameter.scope) {
            (Spacing::Amplitude, _) => 1.0_f64.clamp(parameter.low, parameter.high),
            (_, Scope::Channel) => parameter.low + 0.3 * (parameter.high - parameter.low).min(1.0),
            _ => parameter.at(share(column)),
        })
        .collect();
    for (column, parameter) in parameters.iter().enumerate() {
        if parameter.spacing == Spacing::Amplitude {
            let step = 1.5;
            let ratio = |values: &[f64]| {
                let pairs = measurement.pairs.iter().zip(&measurement.values).filter(|(_, value)| **value > 0.0);
                let (sum, count) = pairs.fold((0.0, 0.0), |(sum, count), (pair, value)| {
                    let modelled = model.f(pair, nm[0], values).max(f64::MIN_POSITIVE);
                    (sum + (value / modelled).ln(), count + 1.0)
                });
                sum / f64::max(count, 1.0)
            };
            // The power of the amplitude to which values are proportional.
            let before = ratio(&values);
            values[column] *= step;
            let power = (before - ratio(&values)) / step.ln();
            values[column] =
                (values[column] / step * (before / power).exp()).clamp(1.2 * parameter.low, parameter.high / 1.2);
        }
    }
    values
}
