//! Resampling a surface at the nodes of the target format.

use std::path::Path;

use lobe::{Aspect, Lookup, Material, Options, Scatter};
use lobe_files::check_output;
use lobe_formats::mbsdf::UNIFORM_HALF;
use lobe_formats::{ChannelMap, Document, RESAMPLED};
use lobe_model::goniometer::half_diff as bins;
use lobe_model::goniometer::tensor_tree::Refinement;
use lobe_model::{Surface, is_isotropic};
use lobe_ops::certificate::Stated;
use lobe_ops::remeasure::{Mapped, Nodes, RemeasureError, Sides, refine, remeasure, resampled_matrices};
use lobe_table::window::klems;
use lobe_table::window::tensor_tree::Rank;
use lobe_table::{Kind, half_diff, mueller, polarised, rgl, spherical, utia};

use crate::certificate::{Source, report};
use crate::failure::Failure;
use crate::message::say;
use crate::output::{Output, Purpose, side};
use crate::probe::Errors;
use crate::progress::Progress;
use crate::target::Target;

/// A surface to write.
pub struct Job<'a> {
    pub surface: &'a dyn Surface,
    pub sides: Sides,
    /// A material from a file may have any value within a degree of the horizon, where many formats store values that
    /// must be divided by the cosine, so it is never evaluated there. Models are exact.
    pub is_from_file: bool,
    pub output: &'a Output,
    /// The file of the surface, with which the written one is compared.
    pub source: Option<&'a Source<'a>>,
    /// The largest relative error (root mean square) that is accepted.
    pub bound: Option<f64>,
}

/// A resampled file that was written.
pub struct Resampled {
    /// The nodes, in words.
    pub nodes: String,
    /// How the channels were changed; `None` if they were not.
    pub note: Option<String>,
    /// The error of the file, or why it is not known; `None` of models, which have no file.
    pub stated: Option<Stated>,
}

/// Measures a surface and writes it; reports the nodes and the error of the file on standard error.
///
/// Within a degree of the horizon, a material from a file may have any value, because many formats store values that
/// have to be divided by the cosine; so it is never evaluated there. Models are exact.
pub fn write(job: &Job<'_>) -> Result<Resampled, Failure> {
    let Job { surface, sides, is_from_file, output, source, bound } = *job;
    let (target, out) = (output.target()?, output.out.as_path());
    check_output::<&Path>(out, &[])?;
    let (format, writer) = (target.format, target.writer);
    let map = ChannelMap::new(surface.channels(), output.channel.as_deref(), format)?;
    let surface: &dyn Surface = &Mapped { surface, map: &map };
    let scatter = scatter(target, sides, out)?;
    let isotropic = is_isotropic(surface);
    let channels = surface.channels().count();
    let (nodes, counted) = nodes(target, output, isotropic)?;
    fits(out, &nodes.counts(), channels)?;
    // If a format has both sides, everything is measured.
    let measured = if let Nodes::Klems(_) | Nodes::Tree(_) = nodes { sides } else { Sides::One(scatter) };
    let at_nodes = |nodes: &Nodes| -> Result<Document, RemeasureError> {
        if let Some(source) = source
            && let Some(document) = resampled_matrices(source.document(), nodes)?
        {
            return Ok(document);
        }
        let progress = Progress::new(nodes.steps(measured), counted);
        let document = remeasure(surface, is_from_file, measured, nodes, || progress.step());
        document.map(|document| Document { source: facts(source, nodes, out), kept: kept(source), ..document })
    };
    let (nodes, mut document) = match (source, bound) {
        (Some(source), Some(bound)) => {
            let found = refine(nodes, channels, bound, |nodes| -> Result<(Document, f64), Failure> {
                let document = at_nodes(nodes).map_err(|error| file(out, &error))?;
                match source.certify_draft(&document, target, out)? {
                    Ok(certificate) => Ok((document, certificate.worst())),
                    Err(why) => Err(no_bound(out, &why)),
                }
            })?;
            if !found.is_met {
                let (out, reached) = (out.display(), &found.nodes);
                return Err(Failure::Check(format!(
                    "{out}: the smallest error that was reached is {:.3e}, with {reached}; expected {bound} or less. No file \
                     was written",
                    found.error
                )));
            }
            (found.nodes, found.measured)
        }
        _ => {
            let document = at_nodes(&nodes).map_err(|error| file(out, &error))?;
            (nodes, document)
        }
    };
    let stated = source.map(|source| source.certify_draft(&document, target, out)).transpose()?;
    let words = nodes.to_string();
    if let (Some(source), Some(Ok(certificate))) = (source, &stated) {
        document.source.push((RESAMPLED.into(), format!("from {}, {words}: {}", source.name(), certificate.line())));
    }
    (writer.write)(&document, out)?;
    let kind = if isotropic { "isotropic" } else { "anisotropic" };
    let side = side_of(target, sides, scatter);
    say(format_args!("{}: {format}, resampled: {kind} {side}, {words}", out.display()));
    if let Some(note) = &map.note {
        say(format_args!("  {note}"));
    }
    if let Some(convention) = convention(&nodes, source) {
        say(format_args!("  {convention}"));
    }
    let aspects: Vec<Aspect> = match &nodes {
        Nodes::Klems(_) | Nodes::Tree(_) => {
            document.parts.iter().flat_map(|part| part.data.representation().aspects()).collect()
        }
        _ => vec![Aspect::front(scatter)],
    };
    match errors(surface, target, &aspects, out)? {
        Some(errors) => {
            say(format_args!("  {errors}"));
            if errors.is_large() {
                say(format_args!("  {}", advice(&nodes)));
            }
        }
        None if stated.is_none() => say("  lobe does not read this format, so the error is not known"),
        None => {}
    }
    stated.iter().for_each(report);
    Ok(Resampled { nodes: words, note: map.note, stated })
}

/// The kind of scatter that is written.
fn scatter(target: Target, sides: Sides, out: &Path) -> Result<Scatter, Failure> {
    let refuse = |found: &str, expected: &str| {
        let format = target.format;
        Err(Failure::Usage(format!("{}: found {found}; expected {expected} in {format}", out.display())))
    };
    match ((target.writer.scatter)(out), sides) {
        (Some(Scatter::Reflection), Sides::One(Scatter::Transmission)) => refuse("transmission", "reflection"),
        (Some(Scatter::Transmission), Sides::One(Scatter::Reflection)) => refuse("reflection", "transmission"),
        (_, Sides::One(scatter)) | (Some(scatter), Sides::Both) => Ok(scatter),
        (None, Sides::Both) => Ok(Scatter::Reflection),
    }
}

/// The requested nodes, and the unit of their progress.
fn nodes(target: Target, output: &Output, isotropic: bool) -> Result<(Nodes, &'static str), Failure> {
    let (format, out) = (target.format, output.out.display());
    let refuse = |found: &str, expected: &str| {
        Err(Failure::Usage(format!("{out}: found {found}; expected {expected} in {format}")))
    };
    output.check_knots()?;
    let kind = match target.writer.resampled_as {
        Ok(kind) => kind,
        Err(expected) => {
            output.refuse_others(&[])?;
            return refuse("values for pairs of directions", expected);
        }
    };
    let is_tree = output.basis.is_some_and(|basis| basis.rank().is_some());
    output.refuse_others(match kind {
        rgl::KIND if isotropic => &[Purpose::Images],
        rgl::KIND => &[Purpose::Images, Purpose::Azimuths],
        klems::KIND if is_tree => &[Purpose::Patches, Purpose::Leaves],
        klems::KIND => &[Purpose::Patches],
        half_diff::KIND | UNIFORM_HALF | mueller::KIND | utia::KIND => &[],
        _ => &[Purpose::Knots],
    })?;
    Ok(match kind {
        half_diff::KIND | UNIFORM_HALF | mueller::KIND if !isotropic => {
            return refuse("an anisotropic material", "an isotropic one");
        }
        half_diff::KIND => (Nodes::HalfDiff(bins::MERL), "bins"),
        mueller::KIND | UNIFORM_HALF | utia::KIND => match Nodes::of(kind, isotropic) {
            Some(nodes) => (nodes, "directions of the light"),
            None => return refuse("an anisotropic material", "an isotropic one"),
        },
        polarised::KIND => (Nodes::Polarised(output.knots(isotropic)), "directions of the light"),
        rgl::KIND => (Nodes::Rgl(output.rgl(isotropic)), "directions of the light"),
        klems::KIND => match output.window() {
            Nodes::Tree(Refinement { rank: Rank::Three, .. }) if !isotropic => {
                return refuse(
                    "an anisotropic material",
                    "an isotropic one in a tree of three dimensions, or --basis tree4,",
                );
            }
            nodes @ Nodes::Tree(_) => (nodes, "branches"),
            nodes => (nodes, "patches"),
        },
        spherical::KIND => {
            let knots = output.spherical(isotropic);
            (Nodes::Spherical { knots, is_half: false }, "directions of the light")
        }
        _ => (Nodes::Specular(output.knots(isotropic)), "directions of the light"),
    })
}

/// The facts of the file: those of the source if it has the same format, otherwise its name.
fn facts(source: Option<&Source<'_>>, nodes: &Nodes, out: &Path) -> Vec<(String, String)> {
    let (Nodes::Klems(_) | Nodes::Tree(_)) = nodes else { return Vec::new() };
    let of_source = source.filter(|source| !source.document().kept.is_empty());
    match of_source {
        Some(source) => source.document().source.iter().filter(|(name, _)| name != RESAMPLED).cloned().collect(),
        None => {
            let name = out.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            vec![("name".into(), name)]
        }
    }
}

fn kept(source: Option<&Source<'_>>) -> Vec<(&'static str, String)> {
    source.map_or_else(Vec::new, |source| source.document().kept.clone())
}

/// What the format leaves open, and how it is written.
fn convention(nodes: &Nodes, source: Option<&Source<'_>>) -> Option<&'static str> {
    match nodes {
        Nodes::Utia => Some("the format states no unit; these values are in 1/sr"),
        nodes if nodes.are_of_matrices() => {
            let is_polarised = source.is_some_and(|source| source.is_polarised());
            let unknown = "the polarisation is not known: the matrices are those of an ideal depolariser";
            (!is_polarised).then_some(unknown)
        }
        _ => None,
    }
}

/// How to make a large error smaller.
fn advice(nodes: &Nodes) -> &'static str {
    match nodes {
        Nodes::Rgl(_) => "for a smaller error: more --zeniths, --azimuths or --texels",
        Nodes::Klems(_) => "these are means over patches, which are smallest with --basis full; trees divide further",
        Nodes::Tree(_) => "for a smaller error: a larger --depth, and a smaller --leaf-error",
        Nodes::HalfDiff(_) | Nodes::Utia => {
            "the grid of this format cannot be refined; --to rgl and specular tables can"
        }
        Nodes::Spherical { is_half: true, .. } | Nodes::Mueller(_) => "for a smaller error: convert with --error",
        Nodes::Specular(_) | Nodes::Polarised(_) | Nodes::Spherical { .. } => {
            "for a smaller error: denser --sigma, --psi, --theta or --phi, or --to rgl, whose nodes follow the peak"
        }
    }
}

fn side_of(target: Target, sides: Sides, scatter: Scatter) -> &'static str {
    if target.writer.resampled_as == Ok(klems::KIND) && sides == Sides::Both {
        "reflection and transmission"
    } else {
        side(scatter)
    }
}

/// Fails if there is no memory for values of this many nodes.
pub fn fits(out: &Path, nodes: &[usize], channels: usize) -> Result<(), Failure> {
    /// Bytes per value: the value, temporary copies, and its text in a file.
    const VALUE: u64 = 40;
    let values = nodes.iter().chain([&channels]).fold(1_u64, |product, &count| product.saturating_mul(count as u64));
    lobe_memory::require(values.saturating_mul(VALUE)).map_err(|no_room| {
        let nodes: Vec<String> = nodes.iter().map(ToString::to_string).collect();
        let message = format!("found {} nodes with {channels} channels, which take {no_room}", nodes.join(" x "));
        Failure::File(format!("{}: {message}; expected a size that fits into memory", out.display()))
    })
}

/// Fails if there is no memory to integrate over directions, which takes the values of all channels at many of them.
pub fn integrates(file: &Path, channels: usize) -> Result<(), Failure> {
    /// The most directions whose values are kept at once: albedos take 120 kB per channel.
    const DIRECTIONS: usize = 4096;
    fits(file, &[DIRECTIONS], channels)
}

fn file(out: &Path, error: &dyn std::fmt::Display) -> Failure {
    Failure::File(format!("{}: {error}", out.display()))
}

/// The failure if an error is to be bounded that is not known.
pub fn no_bound(out: &Path, why: &dyn std::fmt::Display) -> Failure {
    let expected = "a format that lobe reads, and a side and channels or colours that the source also has";
    Failure::Usage(format!("{}: found no error to bound ({why}); expected {expected}", out.display()))
}

/// Reads the file back and compares it with the surface.
fn errors(surface: &dyn Surface, target: Target, aspects: &[Aspect], out: &Path) -> Result<Option<Errors>, Failure> {
    if target.format.spec().read.is_none() {
        return Ok(None);
    }
    let options = Options { lookup: Lookup::Linear, ..Options::default() };
    Ok(Some(Errors::between(surface, &Material::open_with(out, &options)?, aspects)))
}

/// `true` if a kind of nodes has the sides of a sheet.
pub fn is_of_sheets(kind: Result<Kind, &str>) -> bool {
    kind == Ok(klems::KIND)
}
