//! Resampling a surface at the nodes of the format that is written.

use std::path::Path;

use lobe::{Aspect, Channels, Material, Scatter};
use lobe::{Lookup, Options};
use lobe_files::check_output;
use lobe_formats::{ChannelMap, Document};
use lobe_model::goniometer::{half_diff as bins, klems as patches, measure_surface, rgl as parameterised};
use lobe_model::{Surface, is_isotropic};
use lobe_table::Kind;
use lobe_table::window::{self, Band, Block, Component, klems};
use lobe_table::{half_diff, rgl};

use crate::channels::Mapped;
use crate::failure::Failure;
use crate::message::say;
use crate::output::{Output, Purpose, side};
use crate::probe::Errors;
use crate::progress::Progress;
use crate::surface::{Lifted, MaterialSurface};
use crate::target::Target;

/// On which sides a surface has values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// One kind of scatter.
    One(Scatter),
    /// The surface distinguishes the sides.
    Both,
}

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
    // The images of RGL hold f cos.
    let lifted = Lifted(surface);
    let near: &dyn Surface = if is_from_file { &lifted } else { surface };
    let mut aspects = vec![Aspect::front(scatter)];
    let nodes = match writer.resampled_as {
        Err(expected) => return refuse("values for pairs of directions", expected),
        Ok(half_diff::KIND) if !isotropic => return refuse("an anisotropic material", "an isotropic one"),
        Ok(half_diff::KIND) => {
            let progress = Progress::new(bins::MERL[0], "bins");
            fits(out, &bins::MERL, channels)?;
            let table = bins::measure(near, bins::MERL, || progress.step()).map_err(|e| file(out, &e))?;
            (writer.write)(&Document::new(table), out)?;
            "90 x 90 x 180 bins of half and difference angles".into()
        }
        Ok(rgl::KIND) => {
            let resolution = output.rgl(isotropic);
            let parameterised::Resolution { theta_i, phi_i, spectra, .. } = resolution;
            fits(out, &[theta_i, phi_i, spectra, spectra], channels)?;
            let progress = Progress::new(resolution.steps(), "directions of the light");
            let material =
                parameterised::measure(surface, resolution, || progress.step()).map_err(|e| file(out, &e))?;
            (writer.write)(&Document::new(material), out)?;
            format!("{theta_i} theta_i x {phi_i} phi_i, {spectra} x {spectra} texels")
        }
        Ok(klems::KIND) => {
            let basis = output.basis();
            fits(out, &[4, basis.patches(), basis.patches()], channels)?;
            let sheet = sheet(near, output, sides)?;
            aspects = lobe_table::Representation::aspects(&sheet);
            let name = output.out.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            (writer.write)(&Document { source: vec![("name".into(), name)], ..Document::new(sheet) }, out)?;
            format!("means over {n} x {n} patches", n = basis.patches())
        }
        Ok(_) => {
            let knots = output.knots(isotropic);
            let [sigma, psi, theta, phi] = knots.each_ref().map(Vec::len);
            fits(out, &[sigma, psi, theta, phi], channels)?;
            let progress = Progress::new(sigma * psi, "directions of the light");
            let samples = measure_surface(near, scatter, knots, || progress.step()).map_err(|e| file(out, &e))?;
            (writer.write)(&Document::new(samples), out)?;
            format!("{sigma} sigma x {psi} psi x {theta} theta x {phi} phi")
        }
    };
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

/// The blocks of a sheet that are not dark.
fn sheet(surface: &dyn Surface, output: &Output, sides: Sides) -> Result<window::Data, Failure> {
    let names: Vec<String> = match surface.channels() {
        // Radiance uses X and Z in addition to Visible for colour.
        Channels::Xyz => ["CIE-X", "Visible", "CIE-Z"].map(String::from).into(),
        Channels::Mono => vec!["Visible".into()],
        other => other.names(),
    };
    let mut bands: Vec<Band> =
        names.into_iter().map(|wavelength| Band { wavelength, window: window::Blocks::default() }).collect();
    let basis = output.basis();
    let wanted = |block: &Block| match sides {
        Sides::Both => true,
        Sides::One(Scatter::Reflection) => matches!(block, Block::ReflectionFront | Block::ReflectionBack),
        Sides::One(Scatter::Transmission) => matches!(block, Block::TransmissionFront | Block::TransmissionBack),
    };
    let blocks: Vec<Block> = Block::ALL.into_iter().filter(wanted).collect();
    let progress = Progress::new(blocks.len() * basis.patches(), "patches");
    for block in blocks {
        let matrices = patches::measure(surface, [&basis, &basis], block, || progress.step())
            .map_err(|e| file(&output.out, &e))?;
        if matrices.iter().all(|matrix| matrix.values().iter().all(|f| *f == 0.0)) {
            continue;
        }
        for (band, matrix) in bands.iter_mut().zip(matrices) {
            band.window.set(block, Component::Klems(matrix));
        }
    }
    Ok(window::Data { bands })
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
