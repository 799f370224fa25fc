//! The tables of a page.

use std::fmt::Write as _;

use lobe::Scatter;
use lobe_colour::encode;
use lobe_ops::check::{Finding, Status};
use quick_xml::escape::escape;

use crate::albedo::Albedo;
use crate::scale::{degrees, short};
use crate::view::View;

/// A table of names and values on a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Facts {
    /// Its heading.
    pub title: String,
    /// Names and values.
    pub rows: Vec<(String, String)>,
}

/// The subject of a table, after the name of its file if there are several.
fn heading(name: &str, title: &str) -> String {
    match name.is_empty() {
        true => format!("<h3>{}</h3>", escape(title)),
        false => format!("<h3>{}: {}</h3>", escape(name), escape(title)),
    }
}

/// The first table of facts, and below it the others, which are collapsed.
pub(crate) fn facts_table(name: &str, facts: &[Facts]) -> String {
    let table = |rows: &[(String, String)]| {
        let row = |(name, value): &(String, String)| {
            format!("<tr><th>{}</th><td>{}</td></tr>\n", escape(name), escape(value))
        };
        format!("<table><tbody>\n{}</tbody></table>", rows.iter().map(row).collect::<String>())
    };
    let Some((first, rest)) = facts.split_first() else { return String::new() };
    let mut out = format!("<div class=\"card\">{}{}\n", heading(name, &first.title), table(&first.rows));
    for Facts { title, rows } in rest {
        let _ = writeln!(out, "<details><summary>{}</summary>{}</details>", escape(title), table(rows));
    }
    out.push_str("</div>");
    out
}

/// One row per finding, the worst first; passed checks are collapsed.
pub(crate) fn findings_table(name: &str, findings: &[Finding]) -> String {
    let row = |finding: &Finding| {
        let status = finding.status.to_string().to_lowercase();
        let part = if finding.part.is_empty() { String::new() } else { format!("{}: ", finding.part) };
        format!(
            "<tr><td><span class=\"status {status}\">{status}</span></td><th>{}</th><td>{}{}</td></tr>\n",
            escape(finding.check),
            escape(&part),
            escape(&finding.text)
        )
    };
    let table = |findings: &[&Finding]| {
        let rows: String = findings.iter().map(|finding| row(finding)).collect();
        format!("<table class=\"findings\"><tbody>\n{rows}</tbody></table>")
    };
    let mut sorted: Vec<&Finding> = findings.iter().collect();
    sorted.sort_by_key(|finding| std::cmp::Reverse(finding.status));
    let passed = sorted.partition_point(|finding| finding.status > Status::Pass);
    let (worth_knowing, as_it_should_be) = sorted.split_at(passed);
    let title = if name.is_empty() { String::new() } else { format!("<h3>{}</h3>", escape(name)) };
    let mut out = format!("<div class=\"card\">{title}");
    match worth_knowing.is_empty() {
        true => out.push_str("<p>Everything is in order.</p>"),
        false => out.push_str(&table(worth_knowing)),
    }
    if !as_it_should_be.is_empty() {
        let count = as_it_should_be.len();
        let checks = if count == 1 { "check" } else { "checks" };
        let _ = write!(out, "<details><summary>{count} {checks} passed</summary>{}</details>", table(as_it_should_be));
    }
    out.push_str("</div>");
    out
}

/// The albedo at each incidence, with its colour.
pub(crate) fn albedo_table(name: &str, view: &View, albedos: &[Albedo]) -> String {
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
    if albedos.is_empty() {
        let why = "No albedo: only the plane of incidence was measured.";
        return format!("<div class=\"card\">{}<p>{why}</p></div>", heading(name, "Directional albedo"));
    }
    let mut out = format!(
        "<div class=\"card\">{}<table class=\"numbers\"><thead><tr><th>σ</th>",
        heading(name, "Directional albedo")
    );
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
    let _ = write!(
        out,
        "</tbody></table><p>The integral of f cos θ over the hemisphere{of}, at ψ = {}; its colour under white light.</p></div>",
        degrees(view.psi)
    );
    out
}
