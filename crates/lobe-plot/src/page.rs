//! One page with everything about a file.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write as _;

use lobe::Scatter;
use lobe_colour::encode;
use quick_xml::escape::escape;

use crate::albedo::{Albedo, albedos};
use crate::evaluate::Progress;
use crate::figures::{Figure, Series, degrees, draw, side_name};
use crate::in_plane::MOST;
use crate::scale::{Scaling, short};
use crate::subject::Subject;
use crate::view::View;

/// The style of the page, for light and dark screens and for paper.
const STYLE: &str = include_str!("page.css");

/// A table of names and values on a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Facts {
    /// Its heading.
    pub title: String,
    /// Names and values.
    pub rows: Vec<(String, String)>,
}

/// A self-contained HTML page: what is known about the file, the albedo at each incidence, and all
/// figures. An anisotropic material is shown from two azimuths, a sheet from both sides.
pub fn page(subject: &Subject, view: &View, facts: &[Facts], progress: &dyn Progress) -> String {
    let mut sections = vec![overview(subject, view, facts, progress)];
    let title = String::from("In the plane of incidence and over the hemisphere");
    let mut views = vec![Section { title, view: view.clone(), is_first: true }];
    if subject.is_anisotropic(view.side) {
        let turned = View { psi: view.psi + FRAC_PI_2, ..view.clone() };
        views[0].title = format!("The light at ψ = {}", degrees(view.psi));
        let title = format!("The light at ψ = {}", degrees(turned.psi));
        views.push(Section { title, view: turned, is_first: false });
    }
    for side in subject.sides().into_iter().filter(|&side| side != view.side) {
        let other = View { side, psi: subject.psi(side), ..view.clone() };
        views.push(Section { title: format!("The light from the {}", side_name(side)), view: other, is_first: false });
    }
    for section in &views {
        sections.push(figures(subject, section, progress));
    }
    let name = escape(subject.name());
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>{name}</title>\n\
         <style>\n{STYLE}{}</style>\n</head>\n<body>\n<main>\n<header>\n<h1>{name}</h1>\n<p>{}</p>\n</header>\n{}</main>\n</body>\n</html>\n",
        dark_series(view.incidences(subject, MOST).len()),
        escape(summary(subject)),
        sections.concat()
    )
}

/// A one-line description of the material.
fn summary(subject: &Subject) -> String {
    let material = subject.material();
    let said = |name: &str| material.source().iter().find(|(key, _)| key.eq_ignore_ascii_case(name));
    let named = said("description").or_else(|| said("name")).map(|(_, value)| format!("{value}. "));
    let channels = match material.channel_count() {
        1 => "1 channel".into(),
        n => format!("{n} channels"),
    };
    format!("{}{}, {}, {channels}.", named.unwrap_or_default(), material.format().unwrap_or("made"), material.kind())
}

/// The colours of the curves on a dark page.
fn dark_series(count: usize) -> String {
    let mut rules = String::new();
    for index in 0..count {
        let colour = Series { index, count }.colour_on_dark();
        let _ = write!(rules, ".figure .s{index} {{ stroke: {colour}; }} .figure .m{index} {{ fill: {colour}; }} ");
    }
    format!("@media screen and (prefers-color-scheme: dark) {{ {rules}}}\n")
}

/// The sphere and the albedo, and the facts next to them.
fn overview(subject: &Subject, view: &View, facts: &[Facts], progress: &dyn Progress) -> String {
    let mut out = String::from("<section class=\"cards\">\n<div class=\"stack\">\n");
    let _ =
        writeln!(out, "<figure class=\"card\">\n{}</figure>\n</div>", draw(subject, view, Figure::Sphere, progress));
    out.push_str("<div class=\"stack\">\n");
    let table = |rows: &[(String, String)]| {
        let row = |(name, value): &(String, String)| {
            format!("<tr><th>{}</th><td>{}</td></tr>\n", escape(name), escape(value))
        };
        format!("<table><tbody>\n{}</tbody></table>", rows.iter().map(row).collect::<String>())
    };
    if let Some((first, rest)) = facts.split_first() {
        // The first table is always shown; the others unfold.
        let _ = writeln!(out, "<div class=\"card\"><h3>{}</h3>{}", escape(&first.title), table(&first.rows));
        for Facts { title, rows } in rest {
            let _ = writeln!(out, "<details><summary>{}</summary>{}</details>", escape(title), table(rows));
        }
        out.push_str("</div>\n");
    }
    out.push_str(&albedo_table(view, &albedos(subject, view, progress)));
    out.push_str("</div>\n</section>\n");
    out
}

fn albedo_table(view: &View, albedos: &[Albedo]) -> String {
    let mut sigmas: Vec<f64> = Vec::new();
    let mut scatters: Vec<Scatter> = Vec::new();
    for albedo in albedos {
        if !sigmas.contains(&albedo.sigma) {
            sigmas.push(albedo.sigma);
        }
        if !scatters.contains(&albedo.scatter) {
            scatters.push(albedo.scatter);
        }
    }
    let mut out =
        String::from("<div class=\"card\"><h3>Directional albedo</h3><table class=\"numbers\"><thead><tr><th>σ</th>");
    for scatter in &scatters {
        out.push_str(match scatter {
            Scatter::Reflection => "<th>reflected</th>",
            Scatter::Transmission => "<th>transmitted</th>",
        });
    }
    out.push_str("</tr></thead><tbody>\n");
    for sigma in sigmas {
        let _ = write!(out, "<tr><th>{}</th>", degrees(sigma));
        for scatter in &scatters {
            let found = albedos.iter().find(|albedo| albedo.sigma == sigma && albedo.scatter == *scatter);
            if let Some(Albedo { value, rgb, .. }) = found {
                let [r, g, b] = rgb.map(|c| encode(c as f32));
                let _ = write!(
                    out,
                    "<td>{} <span class=\"swatch\" style=\"background:#{r:02x}{g:02x}{b:02x}\"></span></td>",
                    short(*value)
                );
            }
        }
        out.push_str("</tr>\n");
    }
    let of =
        if view.quantity.name.is_empty() { String::new() } else { format!(" of the {}", escape(&view.quantity.name)) };
    let _ = writeln!(
        out,
        "</tbody></table><p>The integral of f cos θ over the hemisphere{of}, at ψ = {}; its colour under white light.</p></div>",
        degrees(view.psi)
    );
    out
}

/// One view of the material on the page.
struct Section {
    title: String,
    view: View,
    /// The first view has the linear curves too.
    is_first: bool,
}

/// The figures of one view.
fn figures(subject: &Subject, section: &Section, progress: &dyn Progress) -> String {
    let Section { title, view, is_first } = section;
    let mut out = format!("<section>\n<h2>{}</h2>\n<div class=\"cards\">\n", escape(title));
    let log = View { scaling: Some(Scaling::Log), ..view.clone() };
    let linear = View { scaling: Some(Scaling::Linear), ..view.clone() };
    let mut wanted = vec![(Figure::Curves, log)];
    if *is_first {
        wanted.push((Figure::Curves, linear));
    }
    wanted.extend([(Figure::Polar, view.clone()), (Figure::Slices, view.clone())]);
    for (figure, view) in wanted {
        let _ = writeln!(out, "<figure class=\"card\">\n{}</figure>", draw(subject, &view, figure, progress));
    }
    out.push_str("</div>\n</section>\n");
    out
}
