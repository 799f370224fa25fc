//! One page with everything about a file, or about several next to each other.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write as _;

use lobe_ops::check::{Finding, Status};
use quick_xml::escape::escape;

use crate::albedo::albedos;
use crate::evaluate::Progress;
use crate::figures::picture::{Picture, draw_on, said};
use crate::figures::{
    Plate, all_curves, appearance_plate, channels_plate, curves_plate, mueller_plate, polar_plate, polarisation_plate,
    residuals_plate, side_name, slices_plate, spectra_plate, sphere_plate,
};
use crate::layout::{Layout, Paper, Sprites};
use crate::polarised::scatter;
use crate::residual::Fitted;
use crate::scale::{Scaling, degrees};
use crate::shown::Shown;
use crate::subject::Subject;
use crate::tables::{Facts, albedo_table, facts_table, findings_table};
use crate::view::View;

/// The style of the page, for light and dark screens and for paper.
const STYLE: &str = include_str!("page.css");

/// A page, and remarks about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Page {
    /// Self-contained HTML without scripts.
    pub html: String,
    /// The number of figures.
    pub figures: usize,
    /// The contents, in a few words each: the incidences, the exposures, the findings of the checks.
    pub said: Vec<String>,
}

/// A self-contained HTML page: the facts about the files, the findings of the checks in `lobe-ops`, the albedo at each
/// incidence, and all figures. An anisotropic material is shown from two azimuths, a sheet from both sides. Several
/// materials are drawn into the same figures.
///
/// `facts` holds the facts of each file.
pub fn page(shown: &[Shown<'_>], facts: &[Vec<Facts>], progress: &dyn Progress) -> Page {
    page_with_fit(shown, facts, None, progress)
}

/// Like [`page()`], with a model that was fitted to the first of the files: facts about the fit, and where it fails.
pub fn page_with_fit(
    shown: &[Shown<'_>],
    facts: &[Vec<Facts>],
    fitted: Option<&Fitted<'_>>,
    progress: &dyn Progress,
) -> Page {
    let sprites = Sprites::default();
    let mut out = Out { html: String::new(), sprites: &sprites, pixels: 0, figures: 0, said: Vec::new() };
    out.pixels = shown.first().map_or(0, |first| first.view.width);
    out.overview(shown, facts, progress);
    out.findings(shown, progress);
    if let (Some(first), Some(fitted)) = (shown.first(), fitted) {
        out.fit(*first, fitted, progress);
    }
    match shown {
        [one] => out.sections(*one, progress),
        several => out.section("In the plane of incidence and over the hemisphere", several, true, progress),
    }
    let names: Vec<&str> = shown.iter().map(|shown| shown.subject.name()).collect();
    let name = escape(names.join(", ")).into_owned();
    let summaries: String = shown
        .iter()
        .map(|shown| format!("<p>{}</p>\n", escape(summary(shown.subject, shown_name(shown, &names)))))
        .collect();
    Page { html: document(&name, &summaries, &sprites, &out.html), figures: out.figures, said: out.said }
}

/// A self-contained HTML page of a picture: the facts about it, and its figure.
pub fn page_of_picture(picture: &Picture<'_>, facts: &[Facts]) -> Page {
    let sprites = Sprites::default();
    let mut out = Out { html: String::new(), sprites: &sprites, pixels: picture.pixels, figures: 0, said: Vec::new() };
    out.put("<section class=\"cards\">\n<div class=\"stack\">");
    out.figure(&Plate { draw: Box::new(|paper| draw_on(picture, paper)), said: said(picture) });
    out.put("</div>\n<div class=\"stack\">");
    out.put(&facts_table("", facts));
    out.put("</div>\n</section>");
    let html = document(&escape(picture.name), "", &sprites, &out.html);
    Page { html, figures: out.figures, said: out.said }
}

/// The page with its style; `name` and `summaries` are HTML.
fn document(name: &str, summaries: &str, sprites: &Sprites, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>{name}</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n{}<main>\n<header>\n<h1>{name}</h1>\n{summaries}</header>\n{body}</main>\n</body>\n</html>\n",
        sprites.svg(),
    )
}

/// The name of a file if there are several.
fn shown_name<'a>(shown: &Shown<'a>, names: &[&str]) -> &'a str {
    if names.len() > 1 { shown.subject.name() } else { "" }
}

/// A one-line description of the material.
fn summary(subject: &Subject, name: &str) -> String {
    let material = subject.material();
    let said = |name: &str| material.source().iter().find(|(key, _)| key.eq_ignore_ascii_case(name));
    let named = said("description").or_else(|| said("name")).map(|(_, value)| format!("{value}. "));
    let channels = match material.channel_count() {
        1 => "1 channel".into(),
        n => format!("{n} channels"),
    };
    let prefix = if name.is_empty() { String::new() } else { format!("{name}: ") };
    format!(
        "{prefix}{}{}, {}, {channels}.",
        named.unwrap_or_default(),
        material.format().unwrap_or("made"),
        material.kind()
    )
}

/// A page that is being written.
struct Out<'a> {
    html: String,
    sprites: &'a Sprites,
    pixels: u32,
    figures: usize,
    said: Vec<String>,
}

impl Out<'_> {
    fn put(&mut self, html: &str) {
        self.html.push_str(html);
        self.html.push('\n');
    }

    /// A figure in a card, for wide screens and for narrow ones.
    fn figure(&mut self, plate: &Plate<'_>) {
        let paper = |layout, pixels| Paper { layout, pixels, sprites: Some(self.sprites) };
        let wide = (plate.draw)(paper(Layout::WIDE, self.pixels));
        let narrow = (plate.draw)(paper(Layout::NARROW, self.pixels.min(400)));
        let _ = writeln!(
            self.html,
            "<figure class=\"card\">\n<div class=\"wide\">\n{wide}</div>\n<div class=\"narrow\">\n{narrow}</div>\n</figure>"
        );
        self.figures += 1;
        for said in &plate.said {
            // Figures with few incidences show some of those of the first figure.
            let kind = |said: &str| said.split(" at ").next().map(String::from);
            if !self.said.iter().any(|other| kind(other) == kind(said)) {
                self.said.push(said.clone());
            }
        }
    }

    /// The spheres, and the facts and the albedos next to them.
    fn overview(&mut self, shown: &[Shown<'_>], facts: &[Vec<Facts>], progress: &dyn Progress) {
        self.put("<section class=\"cards\">\n<div class=\"stack\">");
        self.figure(&sphere_plate(shown, progress));
        self.put("</div>\n<div class=\"stack\">");
        for (shown_one, facts) in shown.iter().zip(facts) {
            let name = if shown.len() > 1 { shown_one.subject.name() } else { "" };
            self.put(&facts_table(name, facts));
            self.put(&albedo_table(name, shown_one.view, &albedos(shown_one.subject, shown_one.view, progress)));
        }
        self.put("</div>\n</section>");
    }

    /// The findings of the checks of each file.
    fn findings(&mut self, shown: &[Shown<'_>], progress: &dyn Progress) {
        self.put("<section>\n<h2>Findings of the checks</h2>\n<div class=\"cards\">");
        for Shown { subject, .. } in shown {
            let findings = subject.findings(progress);
            let name = if shown.len() > 1 { subject.name() } else { "" };
            self.put(&findings_table(name, &findings));
            let prefix = if name.is_empty() { String::new() } else { format!("{name}: ") };
            self.said.push(format!("{prefix}checks: {}", counts(&findings)));
        }
        self.put("</div>\n</section>");
    }

    /// The fit of a material, and its residuals.
    fn fit(&mut self, shown: Shown<'_>, fitted: &Fitted<'_>, progress: &dyn Progress) {
        self.put("<section>\n<h2>The fit, and where it fails</h2>\n<div class=\"cards\">");
        self.put(&facts_table("", &fitted.facts));
        self.figure(&residuals_plate(shown, fitted, progress));
        if let Some(plate) = appearance_plate(shown, fitted) {
            self.figure(&plate);
        }
        self.put("</div>\n</section>");
    }

    /// The views of one material.
    fn sections(&mut self, shown: Shown<'_>, progress: &dyn Progress) {
        let Shown { subject, view } = shown;
        if subject.is_anisotropic(view.side) {
            let turned = View { psi: view.psi + FRAC_PI_2, ..view.clone() };
            self.section(&format!("The light at ψ = {}", degrees(view.psi)), &[shown], true, progress);
            let title = format!("The light at ψ = {}", degrees(turned.psi));
            self.section(&title, &[Shown { subject, view: &turned }], false, progress);
        } else {
            self.section("In the plane of incidence and over the hemisphere", &[shown], true, progress);
        }
        for side in subject.sides().into_iter().filter(|&side| side != view.side) {
            let other = View { side, psi: subject.psi(side), ..view.clone() };
            let title = format!("The light from the {}", side_name(side));
            self.section(&title, &[Shown { subject, view: &other }], false, progress);
        }
    }

    /// The figures of one view. The first has the linear curves too, and the channels and spectra of one material.
    fn section(&mut self, title: &str, shown: &[Shown<'_>], is_first: bool, progress: &dyn Progress) {
        self.put(&format!("<section>\n<h2>{}</h2>\n<div class=\"cards\">", escape(title)));
        let curves = all_curves(shown, progress);
        self.figure(&curves_plate(shown, &curves, Some(Scaling::Log)));
        if is_first {
            self.figure(&curves_plate(shown, &curves, Some(Scaling::Linear)));
        }
        if let ([one], true) = (shown, is_first) {
            if one.subject.material().channel_count() > 1 {
                self.figure(&channels_plate(*one, progress));
            }
            if let Some(spectra) = spectra_plate(*one, progress) {
                self.figure(&spectra);
            }
        }
        if let [one] = shown
            && scatter(one.subject, one.view.side).is_some()
        {
            self.figure(&mueller_plate(*one, progress));
            self.figure(&polarisation_plate(*one, progress));
        }
        self.figure(&polar_plate(shown, curves));
        self.figure(&slices_plate(shown, progress));
        self.put("</div>\n</section>");
    }
}

/// The number of findings of each status other than a pass.
fn counts(findings: &[Finding]) -> String {
    let count = |wanted: Status| findings.iter().filter(|finding| finding.status == wanted).count();
    let words =
        [(Status::Fail, "failed", "failed"), (Status::Warn, "warning", "warnings"), (Status::Note, "note", "notes")];
    let said: Vec<String> = words
        .into_iter()
        .map(|(status, one, many)| (count(status), one, many))
        .filter(|(count, ..)| *count > 0)
        .map(|(count, one, many)| format!("{count} {}", if count == 1 { one } else { many }))
        .collect();
    if said.is_empty() { "nothing to note".into() } else { said.join(", ") }
}
