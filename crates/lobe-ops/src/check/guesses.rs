//! Warnings about values that data do not determine.

use lobe_formats::Document;

use super::finding::part_name;
use super::{azimuths, coverage, grids};

/// Sentences on which values of a file are guessed rather than measured, such as those outside the plane of incidence,
/// or far from a few measured directions. Empty if the data determine all values.
pub fn guesses(document: &Document) -> Vec<String> {
    let mut found = Vec::new();
    let mut push = |part: String, text: &str| {
        found.push(if part.is_empty() { text.to_string() } else { format!("{part}: {text}") });
    };
    for part in &document.parts {
        let data = part.data.representation();
        let Some(&aspect) = data.aspects().first().filter(|_| data.samples().is_some()) else { continue };
        let name = part_name(document, part);
        let (incidences, sparse) = (data.incidences(aspect).len(), coverage::sparse(data).len());
        if coverage::is_in_plane(data) {
            push(name.clone(), IN_PLANE);
        } else if sparse > 0 {
            let text = format!(
                "few outgoing directions were measured, for {sparse} of {incidences} incident ones; between and beyond them, values are guessed"
            );
            push(name.clone(), &text);
        }
        if coverage::has_one_view(data) {
            push(name.clone(), coverage::ONE_VIEW);
        }
        match (incidences, coverage::only_light(data)) {
            (1, _) => push(name, "light came from only one direction, which is used for all others"),
            (_, Some(theta)) => push(name, &one_light(&theta)),
            _ => {}
        }
    }
    for (part, grid) in grids(document) {
        if azimuths::is_in_plane(&grid) {
            push(part.clone(), IN_PLANE);
        }
        if let Some(theta) = grid.only_light() {
            push(part, &one_light(&theta));
        }
    }
    found
}

fn one_light(theta: &str) -> String {
    format!("light came at only one polar angle, {theta} degrees, which is used for all others")
}

const IN_PLANE: &str = "measured only in the plane of incidence, and guessed everywhere else";
