//! Legends of curves.

use super::shared::{Series, degrees};
use crate::in_plane::Curve;
use crate::svg::{LABEL, Role, Svg, Text};

/// The distance between two entries.
const STEP: f64 = 25.0;

/// The incidences of curves, one per entry, from `top` down; and what the lines of a curve mean.
pub(super) fn legend(svg: &mut Svg, [x, top]: [f64; 2], sigmas: &[f64], has_continued: bool) {
    svg.rich([x, top], Text { role: Role::Muted, size: 16.0, ..LABEL }, "incidence σ");
    for (index, &sigma) in sigmas.iter().enumerate() {
        let y = top + STEP * (index + 1) as f64;
        let colour = Series { index, count: sigmas.len() }.colour();
        svg.series(index, &colour, &[(true, vec![[x, y - 5.5], [x + 26.0, y - 5.5]])]);
        svg.text([x + 36.0, y], LABEL, &degrees(sigma));
    }
    let mut y = top + STEP * (sigmas.len() + 1) as f64 + 10.0;
    let note = Text { role: Role::Muted, size: 15.0, ..LABEL };
    svg.raw(&triangle(x + 13.0, y - 9.5));
    svg.text([x + 36.0, y], note, "mirror");
    if has_continued {
        y += STEP - 3.0;
        let dashes = format!(
            "<path d=\"M{} {}h26\" class=\"muted-line\" stroke=\"#5f656d\" stroke-width=\"2.2\" stroke-dasharray=\"2.5 4\" \
             stroke-linecap=\"round\" fill=\"none\"/>",
            x,
            y - 5.0
        );
        svg.raw(&dashes);
        svg.text([x + 36.0, y], note, "not meas.");
    }
}

/// The sign of the mirror direction in the legend.
fn triangle(x: f64, y: f64) -> String {
    format!(
        "<polygon points=\"{},{} {},{} {},{}\" class=\"muted\" fill=\"#5f656d\"/>",
        x - 5.0,
        y,
        x + 5.0,
        y,
        x,
        y + 8.5
    )
}

/// The incidences of some curves, each once.
pub(super) fn incidences(curves: &[Curve]) -> Vec<f64> {
    let mut sigmas: Vec<f64> = Vec::new();
    for curve in curves {
        if !sigmas.contains(&curve.sigma) {
            sigmas.push(curve.sigma);
        }
    }
    sigmas
}

/// Whether any value of the curves was not measured.
pub(super) fn has_continued(curves: &[Curve]) -> bool {
    curves.iter().any(|curve| curve.is_measured.contains(&false))
}

/// Splits a line into runs that were measured and runs that were not. Neighbouring runs share a point, so no gap shows.
pub(super) fn runs(points: &[[f64; 2]], is_measured: &[bool], tolerance: f64) -> Vec<(bool, Vec<[f64; 2]>)> {
    let mut runs: Vec<(bool, Vec<[f64; 2]>)> = Vec::new();
    for (&point, &measured) in points.iter().zip(is_measured) {
        match runs.last_mut() {
            Some((is_solid, run)) if *is_solid == measured => run.push(point),
            Some((_, run)) => {
                let joint = run[run.len() - 1];
                runs.push((measured, vec![joint, point]));
            }
            None => runs.push((measured, vec![point])),
        }
    }
    runs.into_iter().map(|(solid, run)| (solid, crate::simplify::simplify(&run, tolerance))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_meet() {
        let points = [[0.0, 0.0], [1.0, 0.0], [2.0, 5.0], [3.0, 0.0]];
        let found = runs(&points, &[false, false, true, true], 0.0);
        assert_eq!(found, [(false, points[..2].to_vec()), (true, points[1..].to_vec())]);
    }
}
