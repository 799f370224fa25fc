//! Figures of Mueller matrices that are known everywhere.

use std::path::Path;

use lobe::formats::{Document, Format};
use lobe::table::polarised;
use lobe::{Channels, Scatter, specular};
use lobe_plot::{DrawError, Figure, Shown, Silent, Subject, View, draw, page, rasterise};

/// The same matrix for every pair of directions, in the frames of the plane of the two.
fn everywhere(matrix: [f32; 16]) -> Subject {
    let knots = [vec![0.0, 0.5, 1.0], vec![0.0], vec![0.0, 3.1], vec![0.0]];
    let values = (0..3 * 2 * 2).flat_map(|_| matrix).collect();
    let data = polarised::Data::new(knots, vec![500.0, 600.0], values).expect("matrices");
    Subject::new(Path::new("film.mueller"), Format::Polarised, Document::new(data)).expect("a material")
}

/// Unpolarised light becomes half polarised along the diagonal from the normal of the plane toward its y axis.
fn diagonal() -> [f32; 16] {
    let mut matrix = [0.0; 16];
    (matrix[0], matrix[8], matrix[5], matrix[10], matrix[15]) = (0.2, 0.1, 0.1, -0.05, 0.16);
    matrix
}

fn one(subject: &Subject, figure: Figure) -> Result<String, DrawError> {
    let view = View { sigmas: vec![0.5], ..View::new(subject) };
    draw(&[Shown { subject, view: &view }], figure, &Silent).map(|drawing| drawing.svg)
}

/// The heights of the ends of the curves in the order of the panels.
fn heights(svg: &str) -> Vec<f64> {
    let curves = svg
        .lines()
        .filter(|line| line.contains("stroke-linejoin=\"round\" stroke-linecap") && line.contains("class=\"s0\""));
    let last = |line: &str| line.split("d=\"").nth(1)?.split('"').next()?.rsplit(' ').next()?.parse().ok();
    // The last is in the legend.
    let mut all: Vec<f64> = curves.filter_map(last).collect();
    all.pop();
    all
}

#[test]
fn elements_are_relative_to_the_first_and_in_their_panels() {
    let svg = one(&everywhere(diagonal()), Figure::Mueller).expect("a figure");
    for (row, column) in (0..4).flat_map(|row| (0..4).map(move |column| (row, column))) {
        assert!(svg.contains(&format!(">m<tspan dy=\"3.08\" font-size=\"10.36\">{row}{column}</tspan>")), "{svg}");
    }
    let heights = heights(&svg);
    assert_eq!(heights.len(), 16, "a curve per panel");
    // Each panel is 116 units high, and elements go from -1 to 1; in its row, an element that is 0 is in the middle.
    let rise = |row: usize, column: usize, zero: usize| (heights[4 * row + zero] - heights[4 * row + column]) / 58.0;
    for (row, column, zero, expected) in
        [(1, 1, 0, 0.5), (2, 0, 1, 0.5), (2, 2, 1, -0.25), (3, 3, 0, 0.8), (0, 1, 2, 0.0), (1, 3, 0, 0.0)]
    {
        let found = rise(row, column, zero);
        assert!((found - expected).abs() < 2e-3, "{row} {column}: {found}, not {expected}");
    }
    rasterise(&svg, 720).expect("a picture");
}

#[test]
fn degrees_and_angles_are_said_at_the_pointer() {
    let svg = one(&everywhere(diagonal()), Figure::Polarisation).expect("a figure");
    assert!(svg.contains("σ = 28.6°, θ = 45°, 90° from the mirror side: 50 %, 45°</title>"), "{svg}");
    assert_eq!(svg.matches(": 50 %, 45°").count(), 2 * 61, "at every marked direction of both disks");
    // Two disks and two bars.
    assert_eq!(svg.matches("<image").count(), 4);
    // Light across the normal is at 90 degrees.
    let mut across = diagonal();
    (across[4], across[8]) = (-0.04, 0.0);
    assert!(one(&everywhere(across), Figure::Polarisation).expect("a figure").contains(": 20 %, 90°"));
}

#[test]
fn pages_have_polarisation_and_other_materials_are_refused() {
    let subject = everywhere(diagonal());
    let view = View::new(&subject);
    let html = page(&[Shown { subject: &subject, view: &view }], &[Vec::new()], &Silent).html;
    assert!(html.contains("Mueller matrix in the plane of incidence") && html.contains("degree of polarisation (%)"));
    let knots = [vec![0.0, 1.0], vec![0.0], vec![0.0, 1.0], vec![0.0]];
    let data = specular::Data::new(Scatter::Reflection, knots, Channels::Mono, vec![0.1; 4]).expect("a table");
    let plain = Subject::new(Path::new("plain.ddr"), Format::Ddr, Document::new(data)).expect("a material");
    for figure in [Figure::Mueller, Figure::Polarisation] {
        let error = one(&plain, figure).expect_err("no matrices").to_string();
        assert!(error.ends_with(&format!("expected Mueller matrices for the figure {figure}")), "{error}");
    }
}
