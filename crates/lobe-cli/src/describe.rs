//! What there is to say about each representation.

use lobe_formats::sheet::{self, Data, Side};
use lobe_formats::window_xml::WindowXml;
use lobe_formats::{Document, Specular};
use lobe_table::mueller::{self, AXES};
use lobe_table::scattered::{self, ANGLE_NAMES};
use lobe_table::utia::{self, PHIS, THETAS};
use lobe_table::window::tensor_tree::Rank;
use lobe_table::window::{Block, Component};
use lobe_table::{Channels, Scatter, half_diff, rgl, specular, specular::AXIS_NAMES, spherical};
use serde::Serialize;

/// A block of values.
#[derive(Serialize)]
pub struct Part {
    pub name: String,
    /// The representation.
    pub kind: &'static str,
    pub scatter: &'static str,
    pub channels: Vec<String>,
    pub axes: Vec<Axis>,
    /// Whatever else there is to say.
    pub facts: Vec<(&'static str, String)>,
    pub values: Values,
}

#[derive(Serialize)]
pub struct Axis {
    pub name: &'static str,
    pub unit: &'static str,
    pub count: usize,
    pub first: f32,
    pub last: f32,
    pub knots: Vec<f32>,
}

#[derive(Serialize)]
pub struct Values {
    /// What they are.
    pub of: &'static str,
    pub count: usize,
    /// In memory.
    pub bytes: usize,
    pub smallest: f32,
    pub largest: f32,
    pub negative: usize,
}

const F: &str = "f in 1/sr";

impl Part {
    /// Everything but the name, as names and values for people.
    pub fn rows(&self) -> Vec<(&'static str, String)> {
        let mut rows = vec![
            ("kind", self.kind.to_string()),
            ("scatter", self.scatter.to_string()),
            ("channels", format!("{}: {}", self.channels.len(), self.channels.join(" "))),
        ];
        for Axis { name, unit, count, first, last, knots } in &self.axes {
            rows.push((
                name,
                match count {
                    1 => format!("1 knot: {first} {unit}"),
                    _ => {
                        let knots: Vec<String> = knots.iter().map(f32::to_string).collect();
                        format!("{count} knots, {first} to {last} {unit}: {}", knots.join(" "))
                    }
                },
            ));
        }
        rows.extend(self.facts.iter().cloned());
        let Values { of, count, bytes, smallest, largest, negative } = &self.values;
        rows.push(("values", format!("{count} of {of}, {smallest} to {largest}, {negative} negative, {bytes} bytes")));
        rows
    }
}

/// The parts of a file; `None` for a representation that is newer than this command.
pub fn describe(document: &Document) -> Option<Vec<Part>> {
    Some(match document {
        Document::Table(measured) => vec![table(&measured.data)],
        Document::Specular(measured) => vec![specular(&measured.data)],
        Document::Spherical(measured) => vec![spherical(&measured.data)],
        Document::Scattered(measured) => vec![scattered(&measured.data)],
        Document::Sheet(measured) => measured.data.iter().map(sheet).collect(),
        Document::Rgl(measured) => vec![rgl(&measured.data)],
        Document::HalfDiff(measured) => vec![half_diff(&measured.data)],
        Document::Utia(measured) => vec![utia(&measured.data)],
        Document::Mueller(measured) => vec![mueller(&measured.data)],
        Document::Window(measured) => window(&measured.data),
        _ => return None,
    })
}

fn part(kind: &'static str, scatter: Scatter, channels: &Channels, axes: Vec<Axis>, values: Values) -> Part {
    let scatter = match scatter {
        Scatter::Reflection => "reflection",
        Scatter::Transmission => "transmission",
    };
    Part { name: String::new(), kind, scatter, channels: channels.names(), axes, facts: Vec::new(), values }
}

fn table(data: &specular::Data) -> Part {
    let axes = angle_axes(AXIS_NAMES, data.knots());
    let mut part = part("specular table", data.scatter(), data.channels(), axes, Values::new(F, data.values()));
    if let Some(offsets) = data.refraction() {
        let refracted: Vec<f64> = data.knots()[0].iter().zip(offsets).map(|(sigma, offset)| sigma + offset).collect();
        let angles: Vec<String> = degrees(&refracted).iter().map(f32::to_string).collect();
        part.facts.push(("refracted", format!("at {} degrees for the knots of sigma", angles.join(" "))));
    }
    part
}

fn specular(data: &Specular) -> Part {
    let mut axes = angle_axes([AXIS_NAMES[0], AXIS_NAMES[1]], data.knots());
    if axes[1].count == 1 {
        axes.pop();
    }
    let values = Values::new("mirror reflectance by angle of incidence", data.values());
    part("mirror reflectance", data.scatter(), data.channels(), axes, values)
}

fn spherical(data: &spherical::Data) -> Part {
    let axes = angle_axes(ANGLE_NAMES, data.knots());
    let mut part = part("spherical grid", data.scatter(), data.channels(), axes, Values::new(F, data.values()));
    if data.is_mirrored() {
        part.facts.push(("symmetry", "the other half of phi_o is the mirror image".into()));
    }
    part
}

fn scattered(data: &scattered::Data) -> Part {
    let values: Vec<f32> = data.samples().flat_map(|(_, values)| values.to_vec()).collect();
    let mut part = part("scattered samples", data.scatter(), data.channels(), Vec::new(), Values::new(F, &values));
    let mut thetas: Vec<f32> = data.incidences().map(|[theta, _]| theta.to_degrees() as f32).collect();
    thetas.dedup();
    let thetas: Vec<String> = thetas.iter().map(f32::to_string).collect();
    let kind = if data.is_isotropic() { "isotropic" } else { "anisotropic" };
    let incidences = match data.incidences().len() {
        1 => "1 direction".into(),
        n => format!("{n} directions"),
    };
    part.facts.push(("samples", format!("{} pairs of directions, {kind}", data.samples().count())));
    part.facts.push(("light", format!("{incidences}, at {} degrees", thetas.join(" "))));
    part
}

fn sheet(data: &sheet::Part) -> Part {
    let mut part = match &data.data {
        Data::Table(data) => table(data),
        Data::Spherical(data) => spherical(data),
        Data::Scattered(data) => scattered(data),
        Data::Specular(data) => specular(data),
    };
    let side = match data.side {
        Some(Side::Front) => " from the front",
        Some(Side::Back) => " from the back",
        None => "",
    };
    part.name = format!("{} {}{side}", data.name, part.scatter).trim().into();
    part
}

fn rgl(data: &rgl::Data) -> Part {
    let parts = data.parts();
    let wide = |knots: &[f32]| knots.iter().map(|&knot| f64::from(knot)).collect::<Vec<_>>();
    let axes = angle_axes(["phi_i", "theta_i"], &[wide(&parts.phi_i), wide(&parts.theta_i)]);
    let of = if parts.jacobian { "f cos(theta_o) without the microfacet factor" } else { "f cos(theta_o) in 1/sr" };
    let values = Values::new(of, parts.spectra.texels());
    let mut part = part("RGL", Scatter::Reflection, &parts.channels, axes, values);
    let size = |[height, width]: [usize; 2]| format!("{height} x {width}");
    part.facts.push((
        "symmetry",
        match data.reduction() {
            _ if data.is_isotropic() => "isotropic".into(),
            1 => "none".into(),
            n => format!("one of {n} equal parts of the azimuths is stored"),
        },
    ));
    part.facts.push(("spectra", format!("{} texels a channel and incident direction", size(parts.spectra.size()))));
    part.facts.push(("vndf", format!("{} texels an incident direction", size(parts.vndf.size()))));
    part.facts.push(("ndf", format!("{} texels", size(parts.ndf.size()))));
    part
}

fn half_diff(data: &half_diff::Data) -> Part {
    let [h, d, p] = data.bins();
    let values = Values::new(F, data.values());
    let mut part = part("half-difference grid", Scatter::Reflection, &Channels::Rgb, Vec::new(), values);
    let unmeasured = (0..h * d * p).filter(|i| !data.is_measured([i / (d * p), i / p % d, i % p])).count();
    let turn = data.period().to_degrees();
    part.facts.push(("bins", format!("{h} of theta_h, {d} of theta_d, {p} of phi_d over {turn} degrees")));
    part.facts.push(("gaps", format!("{unmeasured} of {} bins were not measured", h * d * p)));
    part
}

fn utia(data: &utia::Data) -> Part {
    let values: Vec<f32> = data.values().iter().map(|&value| value as f32).collect();
    let mut values = Values::new("no documented unit", &values);
    values.bytes = size_of_val(data.values());
    let mut part = part("UTIA grid", Scatter::Reflection, &Channels::Rgb, Vec::new(), values);
    part.facts.push(("grid", format!("{THETAS} polar angles to 75 degrees and {PHIS} azimuths of both directions")));
    part
}

fn mueller(data: &mueller::Data) -> Part {
    let wide = |knots: &[f32]| knots.iter().map(|&knot| f64::from(knot)).collect::<Vec<_>>();
    let [phi_d, theta_d, theta_h, wavelengths] = data.knots();
    let knots = [phi_d, theta_d, theta_h].map(|knots| wide(knots));
    let axes = angle_axes([AXES[0], AXES[1], AXES[2]], &knots);
    // NaN means that nothing was measured.
    let measured: Vec<f32> = data.values().iter().copied().filter(|value| !value.is_nan()).collect();
    let values = Values::new("elements of Mueller matrices in 1/sr", &measured);
    let channels = Channels::Spectral(wide(wavelengths));
    let mut part = part("Mueller matrices", Scatter::Reflection, &channels, axes, values);
    let (all, gaps) = (data.values().len() / 16, (data.values().len() - measured.len()).div_ceil(16));
    part.facts.push(("gaps", format!("{gaps} of {all} matrices were not measured")));
    part
}

fn window(data: &WindowXml) -> Vec<Part> {
    let mut parts = Vec::new();
    for band in &data.bands {
        for block in Block::ALL {
            let Some(component) = band.window.block(block) else { continue };
            let (scatter, name) = match block {
                Block::TransmissionFront => (Scatter::Transmission, "transmission front"),
                Block::TransmissionBack => (Scatter::Transmission, "transmission back"),
                Block::ReflectionFront => (Scatter::Reflection, "reflection front"),
                Block::ReflectionBack => (Scatter::Reflection, "reflection back"),
            };
            let (kind, values, fact) = match component {
                Component::Klems(matrix) => {
                    let (incident, exit) = (matrix.incident(), matrix.exit());
                    let bases = format!(
                        "{} ({} patches) to {} ({} patches)",
                        incident.name(),
                        incident.patches(),
                        exit.name(),
                        exit.patches()
                    );
                    ("Klems matrix", matrix.values(), ("bases", bases))
                }
                Component::Tree(tree) => {
                    let dimensions = if tree.rank() == Rank::Three { 3 } else { 4 };
                    let nodes = format!("{} nodes in {dimensions} dimensions", tree.nodes().len());
                    ("tensor tree", tree.values(), ("tree", nodes))
                }
            };
            let channels = Channels::Named(vec![band.wavelength.clone()]);
            let part = part(kind, scatter, &channels, Vec::new(), Values::new(F, values));
            parts.push(Part { name: format!("{} {name}", band.wavelength), facts: vec![fact], ..part });
        }
    }
    parts
}

fn angle_axes<const N: usize>(names: [&'static str; N], knots: &[Vec<f64>; N]) -> Vec<Axis> {
    names.into_iter().zip(knots).map(|(name, knots)| Axis::new(name, knots)).collect()
}

impl Axis {
    fn new(name: &'static str, radians: &[f64]) -> Self {
        let knots = degrees(radians);
        Axis { name, unit: "degrees", count: knots.len(), first: knots[0], last: knots[knots.len() - 1], knots }
    }
}

impl Values {
    fn new(of: &'static str, values: &[f32]) -> Self {
        let (smallest, largest) = range(values.iter().copied());
        let negative = values.iter().filter(|&&value| value < 0.0).count();
        Values { of, count: values.len(), bytes: size_of_val(values), smallest, largest, negative }
    }
}

/// The smallest and the largest.
pub fn range(values: impl Iterator<Item = f32>) -> (f32, f32) {
    values.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

/// Files hold degrees that `f32` can hold, so rounding to that shows what the file says.
fn degrees(radians: &[f64]) -> Vec<f32> {
    radians.iter().map(|angle| angle.to_degrees() as f32).collect()
}
