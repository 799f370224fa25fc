//! Everything about a fit, by name.

use lobe_ops::compare::Visible;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use crate::fit::{Estimate, Fit};
use crate::residuals::Residuals;

/// A fit with its evaluation.
#[derive(Clone, Debug)]
pub struct Report<'a> {
    /// The measured aspect, such as `reflection front`.
    pub aspect: String,
    /// The fit.
    pub fit: &'a Fit,
    /// The difference of the model from the measurement.
    pub residuals: &'a Residuals,
    /// The visible difference of two spheres, if the channels have a colour.
    pub delta_e: Option<Visible>,
}

/// A number, or one per channel.
enum Entry {
    One(Option<f64>),
    Each(Vec<Option<f64>>),
}

impl Serialize for Entry {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Entry::One(value) => value.serialize(serializer),
            Entry::Each(values) => values.serialize(serializer),
        }
    }
}

/// Parameters in the order of the model.
struct Table(Vec<(&'static str, Entry)>);

impl Serialize for Table {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, entry) in &self.0 {
            map.serialize_entry(name, entry)?;
        }
        map.end()
    }
}

impl Table {
    fn new(fit: &Fit, value: impl Fn(&Estimate) -> Option<f64>) -> Self {
        let of = |name: &'static str| {
            let mut values: Vec<_> =
                fit.estimates.iter().filter(|found| found.parameter.name == name).map(&value).collect();
            (name, if values.len() == 1 { Entry::One(values.remove(0)) } else { Entry::Each(values) })
        };
        Table(fit.request.model.parameters().iter().map(|parameter| of(parameter.name)).collect())
    }
}

#[derive(Serialize)]
struct Whole<'a> {
    model: &'static str,
    aspect: &'a str,
    channels: Vec<String>,
    wavelengths: Option<&'a [f64]>,
    weights: &'static str,
    robust: bool,
    parameters: Table,
    uncertainties: Table,
    at_bounds: Vec<String>,
    pairs: usize,
    left_out: usize,
    converged: bool,
    residuals: &'a Residuals,
    delta_e: Option<&'a Visible>,
}

impl Report<'_> {
    /// The names of the parameters that are at a bound, with their channels.
    pub fn at_bounds(&self) -> Vec<String> {
        let names = self.fit.channels.names();
        let name = |estimate: &Estimate| match estimate.channel {
            Some(channel) if names.len() > 1 => format!("{} {}", estimate.parameter.name, names[channel]),
            _ => estimate.parameter.name.to_owned(),
        };
        self.fit.estimates.iter().filter(|estimate| estimate.is_at_bound).map(name).collect()
    }

    fn whole(&self) -> Whole<'_> {
        let fit = self.fit;
        let wavelengths = &fit.fitted.wavelengths;
        Whole {
            model: fit.request.model.name(),
            aspect: &self.aspect,
            channels: fit.channels.names(),
            wavelengths: wavelengths.iter().all(|nm| nm.is_finite()).then_some(wavelengths),
            weights: fit.request.weights.name(),
            robust: fit.request.robust,
            parameters: Table::new(fit, |estimate| Some(estimate.value)),
            uncertainties: Table::new(fit, |estimate| estimate.uncertainty),
            at_bounds: self.at_bounds(),
            pairs: fit.pairs,
            left_out: fit.left_out,
            converged: fit.has_converged,
            residuals: self.residuals,
            delta_e: self.delta_e.as_ref(),
        }
    }
}

impl Serialize for Report<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.whole().serialize(serializer)
    }
}

/// The fit as JSON. Unknown uncertainties are null.
pub fn json(report: &Report<'_>) -> String {
    serde_json::to_string_pretty(report).unwrap_or_else(|error| unreachable!("numbers and names: {error}")) + "\n"
}

/// The fit as TOML. Unknown uncertainties are nan.
pub fn toml(report: &Report<'_>) -> String {
    let whole = report.whole();
    let text = |text: &str| serde_json::Value::from(text).to_string();
    let list = |items: &[String]| items.iter().map(|item| text(item)).collect::<Vec<_>>().join(", ");
    let mut out = format!("model = {}\naspect = {}\n", text(whole.model), text(whole.aspect));
    out += &format!("channels = [{}]\n", list(&whole.channels));
    if let Some(wavelengths) = whole.wavelengths {
        out += &format!("wavelengths = {wavelengths:?}\n");
    }
    out += &format!("weights = {}\nrobust = {}\n", text(whole.weights), whole.robust);
    out += &format!("at_bounds = [{}]\n", list(&whole.at_bounds));
    out += &format!("pairs = {}\nleft_out = {}\nconverged = {}\n", whole.pairs, whole.left_out, whole.converged);
    for (name, table) in [("parameters", &whole.parameters), ("uncertainties", &whole.uncertainties)] {
        out += &format!("\n[{name}]\n");
        for (name, entry) in &table.0 {
            let number = |value: &Option<f64>| value.map_or_else(|| "nan".to_owned(), |value| format!("{value:?}"));
            let value = match entry {
                Entry::One(value) => number(value),
                Entry::Each(values) => format!("[{}]", values.iter().map(number).collect::<Vec<_>>().join(", ")),
            };
            out += &format!("{name} = {value}\n");
        }
    }
    let found = whole.residuals;
    out += &format!("\n[residuals]\npairs = {}\npeak = {:?}\nmax = {:?}\n", found.pairs, found.peak, found.max);
    out += &format!("rms = {:?}\nbias = {:?}\nrelative_rms = {:?}\n", found.rms, found.bias, found.relative_rms);
    out += &format!("log_rms = {:?}\nworst = {:?}\n", found.log_rms, found.worst);
    if let Some(visible) = whole.delta_e {
        out += &format!(
            "\n[delta_e]\nmean = {:?}\npercentile_95 = {:?}\nmax = {:?}\n",
            visible.mean, visible.percentile_95, visible.max
        );
    }
    out
}
