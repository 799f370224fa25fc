//! Resampling a surface at the nodes of the format that is written.

use std::path::Path;

use lobe::{Aspect, Lookup, Material, Options, Scatter};
use lobe_files::check_output;
use lobe_formats::{ChannelMap, Document};
use lobe_model::goniometer::half_diff as bins;
use lobe_model::goniometer::rgl::Resolution;
use lobe_model::{Surface, is_isotropic};
use lobe_ops::remeasure::{Mapped, MaterialSurface, Nodes, Sides, remeasure};
use lobe_table::window::klems;
use lobe_table::{Kind, half_diff, rgl};

use crate::failure::Failure;
use crate::message::say;
use crate::output::{Output, Purpose, side};
use crate::probe::Errors;
use crate::progress::Progress;
use crate::target::Target;

/// Measures a surface and writes it; reports the nodes and the error of the file on standard error.
///
/// A material from a file may have any value within a degree of the horizon, where many formats store what has to be divided
/// by the cosine, so that it is never looked at there. Models are exact.
pub fn write(surface: &dyn Surface, sides: Sides, is_from_file: bool, output: &Output) -> Result<(), Failure> {
    let (target, out) = (output.target()?, output.out.as_path());
    check_output::<&Path>(out, &[])?;
    let (format, writer) = (target.format, target.writer);
    let map = ChannelMap::new(surface.channels(), output.channel.as_deref(), format)?;
    let surface: &dyn Surface = &Mapped { surface, map: &map };
    let refuse = |found: &str, expected: &str| {
        Err(Failure::Usage(format!("{}: found {found}; expected {expected} in {format}", out.display())))
    };
    let scatter = match ((writer.scatter)(out), sides) {
        (Some(Scatter::Reflection), Sides::One(Scatter::Transmission)) => return refuse("transmission", "reflection"),
        (Some(Scatter::Transmission), Sides::One(Scatter::Reflection)) => return refuse("reflection", "transmission"),
        (_, Sides::One(scatter)) => scatter,
        (Some(scatter), Sides::Both) => scatter,
        (None, Sides::Both) => Scatter::Reflection,
    };
    let isotropic = is_isotropic(surface);
    let channels = surface.channels().count();
    output.refuse_others(match writer.resampled_as {
        Ok(rgl::KIND) if isotropic => &[Purpose::Images],
        Ok(rgl::KIND) => &[Purpose::Images, Purpose::Azimuths],
        Ok(klems::KIND) => &[Purpose::Patches],
        Ok(half_diff::KIND) | Err(_) => &[],
        Ok(_) => &[Purpose::Knots],
    })?;
    let (nodes, counted) = match writer.resampled_as {
        Err(expected) => return refuse("values for pairs of directions", expected),
        Ok(half_diff::KIND) if !isotropic => return refuse("an anisotropic material", "an isotropic one"),
        Ok(half_diff::KIND) => (Nodes::HalfDiff(bins::MERL), "bins"),
        Ok(rgl::KIND) => (Nodes::Rgl(output.rgl(isotropic)), "directions of the light"),
        Ok(klems::KIND) => (Nodes::Klems(output.basis()), "patches"),
        Ok(_) => (Nodes::Specular(output.knots(isotropic)), "directions of the light"),
    };
    fits(out, &nodes.counts(), channels)?;
    // Of a format that has both sides, all is measured.
    let measured = if let Nodes::Klems(_) = nodes { sides } else { Sides::One(scatter) };
    let progress = Progress::new(nodes.steps(measured), counted);
    let document =
        remeasure(surface, is_from_file, measured, &nodes, || progress.step()).map_err(|error| file(out, &error))?;
    drop(progress);
    let aspects = match &nodes {
        Nodes::Klems(_) => document.parts.iter().flat_map(|part| part.data.representation().aspects()).collect(),
        _ => vec![Aspect::front(scatter)],
    };
    let name = out.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let source = if let Nodes::Klems(_) = nodes { vec![("name".into(), name)] } else { Vec::new() };
    (writer.write)(&Document { source, ..document }, out)?;
    let nodes = described(&nodes);
    let kind = if isotropic { "isotropic" } else { "anisotropic" };
    let side = side_of(target, sides, scatter);
    say(format_args!("{}: {format}, resampled: {kind} {side}, {nodes}", out.display()));
    if let Some(note) = &map.note {
        say(format_args!("  {note}"));
    }
    match errors(surface, target, &aspects, out)? {
        Some(errors) => {
            say(format_args!("  {errors}"));
            if errors.is_large() {
                say(format_args!("  {}", advice(writer.resampled_as)));
            }
        }
        None => say("  lobe does not read this format, so the error is not known"),
    }
    Ok(())
}

/// How to make a large error smaller.
fn advice(kind: Result<Kind, &str>) -> &'static str {
    match kind {
        Ok(rgl::KIND) => "for a smaller error: more --zeniths, --azimuths or --texels",
        Ok(klems::KIND) => "these are means over patches, which are the smallest with --basis full",
        Ok(half_diff::KIND) => "the grid of this format cannot be refined; --to rgl and specular tables can",
        Ok(_) | Err(_) => {
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

/// Fails if there is no memory for values of so many nodes.
pub fn fits(out: &Path, nodes: &[usize], channels: usize) -> Result<(), Failure> {
    /// Bytes of a value: itself, copies while it is on its way, and its text in a file.
    const VALUE: u64 = 40;
    let values = nodes.iter().chain([&channels]).fold(1_u64, |product, &count| product.saturating_mul(count as u64));
    lobe_memory::require(values.saturating_mul(VALUE)).map_err(|no_room| {
        let nodes: Vec<String> = nodes.iter().map(ToString::to_string).collect();
        let message = format!("found {} nodes of {channels} channels, which take {no_room}", nodes.join(" x "));
        Failure::File(format!("{}: {message}; expected what fits into memory", out.display()))
    })
}

fn file(out: &Path, error: &dyn std::fmt::Display) -> Failure {
    Failure::File(format!("{}: {error}", out.display()))
}

/// Nodes in words.
fn described(nodes: &Nodes) -> String {
    match nodes {
        Nodes::Specular(knots) => {
            let [sigma, psi, theta, phi] = knots.each_ref().map(Vec::len);
            format!("{sigma} sigma x {psi} psi x {theta} theta x {phi} phi")
        }
        Nodes::HalfDiff([halves, differences, turns]) => {
            format!("{halves} x {differences} x {turns} bins of half and difference angles")
        }
        Nodes::Rgl(Resolution { theta_i, phi_i, spectra, .. }) => {
            format!("{theta_i} theta_i x {phi_i} phi_i, {spectra} x {spectra} texels")
        }
        Nodes::Klems(basis) => format!("means over {n} x {n} patches", n = basis.patches()),
    }
}

/// Reads the file back and compares what was written.
fn errors(surface: &dyn Surface, target: Target, aspects: &[Aspect], out: &Path) -> Result<Option<Errors>, Failure> {
    if target.format.spec().read.is_none() {
        return Ok(None);
    }
    let options = Options { lookup: Lookup::Linear, ..Options::default() };
    let found = MaterialSurface { material: Material::open_with(out, &options)?, scatter: None };
    Ok(Some(Errors::between(surface, &found, aspects)))
}
