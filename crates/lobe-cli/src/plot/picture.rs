//! `lobe plot` of an OpenEXR picture.

use std::io::Write;

use lobe_files::write_whole;
use lobe_plot::{Drawing, Facts, Page, Picture, Scaling, draw_picture, page_of_picture, rasterise};
use lobe_render::picture::read_spectral;

use super::{Args, Target};
use crate::failure::Failure;
use crate::info::picture::{light, rows};
use crate::message;

/// A pixel: its column and its row.
#[derive(Clone, Copy, Debug)]
pub struct Point([usize; 2]);

/// Parses `X,Y`.
pub fn parse_point(text: &str) -> Result<Point, String> {
    let wrong = || format!("found `{text}`; expected a column and a row, such as 120,80");
    let (x, y) = text.split_once(',').ok_or_else(wrong)?;
    let whole = |text: &str| text.trim().parse::<usize>().map_err(|_| wrong());
    Ok(Point([whole(x)?, whole(y)?]))
}

/// Draws a picture.
pub fn run(args: &Args, target: Target) -> Result<(), Failure> {
    let file = refuse_idle(args)?;
    let picture = read_spectral(file)?;
    let [columns, rows_of_pixels] = picture.size;
    if let Some(Point([x, y])) = args.at.iter().find(|Point([x, y])| *x >= columns || *y >= rows_of_pixels) {
        return Err(Failure::Usage(format!(
            "{}: found --at {x},{y}; expected a pixel of the {columns} x {rows_of_pixels}",
            file.display()
        )));
    }
    let name = file.file_name().map_or_else(|| file.display().to_string(), |name| name.to_string_lossy().into());
    let polarisation = picture.linear_polarisation();
    let wavelengths: &[f64] = match &picture.channels {
        lobe::Channels::Spectral(nm) => nm,
        _ => &[],
    };
    let points: Vec<[usize; 2]> = args.at.iter().map(|Point(at)| *at).collect();
    let drawn = Picture {
        name: &name,
        what: &light(&picture),
        size: picture.size,
        colours: &picture.colours,
        wavelengths,
        spectra: &picture.stokes[0],
        mean: &picture.mean(),
        polarisation: polarisation.as_deref(),
        points: &points,
        exposure: args.exposure,
        scaling: match (args.log, args.linear) {
            (true, _) => Some(Scaling::Log),
            (_, true) => Some(Scaling::Linear),
            _ => None,
        },
        pixels: args.width,
    };
    let (bytes, said) = match target {
        Target::Page => {
            let facts = [Facts { title: "The picture".into(), rows: rows(file, &picture) }];
            let Page { html, said, .. } = page_of_picture(&drawn, &facts);
            (html.into_bytes(), said)
        }
        Target::Svg(_) => {
            let Drawing { svg, said } = draw_picture(&drawn);
            (svg.into_bytes(), said)
        }
        Target::Png(_) => {
            let Drawing { svg, said } = draw_picture(&drawn);
            let png = rasterise(&svg, args.width);
            (png.map_err(|error| Failure::File(format!("{}: {error}", args.out.display())))?, said)
        }
    };
    write_whole(&args.out, &bytes)?;
    let mut out = message::out(false);
    writeln!(out, "{}: a picture, {} bytes; {}", args.out.display(), bytes.len(), said.join("; "))?;
    Ok(out.flush()?)
}

/// The only file, if no option is for materials.
fn refuse_idle(args: &Args) -> Result<&std::path::Path, Failure> {
    let [file] = &args.files[..] else {
        let message = format!("found {} files, with a picture among them; expected one picture", args.files.len());
        return Err(Failure::Usage(message));
    };
    args.reading.refuse(file, "a picture")?;
    let of_materials = [
        ("--kind", args.kind.is_some_and(|kind| kind != super::Kind::Page)),
        ("--sigma", !args.sigma.is_empty()),
        ("--theta", !args.theta.is_empty()),
        ("--psi", args.psi.is_some()),
        ("--side", args.side.is_some()),
        ("--channel", args.channel.is_some()),
        ("--fit", args.fit.is_some()),
    ];
    match of_materials.into_iter().find(|(_, is_given)| *is_given) {
        Some((name, _)) => Err(Failure::Usage(format!(
            "{}: found {name}, which is for materials, but the file is a picture; expected none",
            file.display()
        ))),
        None => Ok(file),
    }
}
