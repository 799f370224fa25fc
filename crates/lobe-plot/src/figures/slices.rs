//! All outgoing directions of each incidence, as disks.

use std::fmt::Write as _;

use lobe::Scatter;

use super::shared::{MARGIN, MIDDLE, TOP, WIDTH, conditions, degrees, heading, id, scatter_name};
use crate::evaluate::Progress;
use crate::geometry::{incident, to_disk};
use crate::image::Image;
use crate::scale::{Scale, Scaling};
use crate::slice::{Slice, slice};
use crate::subject::Subject;
use crate::svg::{Area, LABEL, Role, Svg, Text, number};
use crate::view::View;

/// More disks than this are too small to see.
const MOST: usize = 6;
const COLUMNS: usize = 3;
const CELL: f64 = (WIDTH - 2.0 * MARGIN) / COLUMNS as f64;
const RADIUS: f64 = 100.0;
/// From one row of disks to the next.
const ROW: f64 = 2.0 * RADIUS + 40.0;
/// More marks than this would hide the values.
const MARKS: usize = 1500;
/// The colour, and its share, that values that were not measured are mixed with.
const GREY: ([f32; 3], f32) = ([206.0, 209.0, 214.0], 0.74);

/// Reflection above transmission, with the same colours.
pub(super) fn draw(subject: &Subject, view: &View, progress: &dyn Progress) -> String {
    let sigmas = view.incidences(subject, MOST);
    let scatters = subject.scatters(view.side);
    // One and a half image pixels per pixel of the figure, as disks are looked at closely.
    let size = (1.5 * 2.0 * RADIUS * f64::from(view.width) / WIDTH).round().clamp(96.0, 480.0) as usize;
    let pixels = std::f64::consts::FRAC_PI_4 * (size * size) as f64;
    progress.begin("slices", (pixels * (scatters.len() * sigmas.len()) as f64) as u64);
    let of = |scatter, sigma| slice(subject, view, sigma, scatter, size, progress);
    let slices: Vec<Slice> =
        scatters.iter().flat_map(|&scatter| sigmas.iter().map(move |&sigma| of(scatter, sigma))).collect();
    let scale = scale(&slices, view.scaling.unwrap_or(Scaling::Log));

    let mut svg = Svg::new(id("slices", view));
    let what = format!("Outgoing hemisphere at each incidence σ, {}", conditions(subject, view));
    heading(&mut svg, subject.name(), &what);
    let mut top = TOP;
    for scatter in &scatters {
        if scatters.len() > 1 || *scatter == Scatter::Transmission {
            svg.text([MARGIN, top + 14.0], Text { is_heavy: true, size: 16.0, ..LABEL }, scatter_name(*scatter));
            top += 26.0;
        }
        let of: Vec<&Slice> = slices.iter().filter(|slice| slice.scatter == *scatter).collect();
        for (at, slice) in of.iter().enumerate() {
            let in_row = (of.len() - at / COLUMNS * COLUMNS).min(COLUMNS);
            let left = 0.5 * (WIDTH - CELL * in_row as f64);
            let x = left + CELL * ((at % COLUMNS) as f64 + 0.5);
            let y = top + ROW * (at / COLUMNS) as f64 + 24.0 + RADIUS;
            disk(&mut svg, [x, y], slice, view, &scale);
        }
        top += ROW * of.len().div_ceil(COLUMNS) as f64;
    }
    bar(&mut svg, top + 14.0, &scale);
    let bottom = notes(&mut svg, top + 92.0, &slices);
    let title = format!("{}: f over the outgoing hemisphere for each incidence", subject.name());
    svg.finish([WIDTH, bottom + 6.0], view.width, &title)
}

/// The colour scale: the range of the measured values, without the lowest hundredth.
fn scale(slices: &[Slice], scaling: Scaling) -> Scale {
    let measured = |slice: &Slice| {
        let of = slice.f.iter().zip(&slice.is_measured).filter(|(_, measured)| **measured);
        of.filter_map(|(f, _)| *f).map(f64::from).filter(|f| f.is_finite()).collect::<Vec<_>>()
    };
    let mut values: Vec<f64> = slices.iter().flat_map(measured).collect();
    if values.is_empty() {
        values = slices.iter().flat_map(|slice| slice.f.iter().flatten()).map(|f| f64::from(*f)).collect();
    }
    values.retain(|value| *value > 0.0);
    values.sort_by(f64::total_cmp);
    let Some(&most) = values.last() else { return Scale::around([].into_iter(), scaling) };
    match scaling {
        Scaling::Linear => Scale::from_zero([most].into_iter()),
        Scaling::Log => Scale { scaling, low: values[values.len() / 100].clamp(1e-6 * most, 0.5 * most), high: most },
    }
}

fn colour(scale: &Scale, f: f32) -> [u8; 3] {
    let place = scale.place(f64::from(f)).clamp(0.0, 1.0);
    let colorous::Color { r, g, b } = colorous::VIRIDIS.eval_continuous(place);
    [r, g, b]
}

fn picture(slice: &Slice, scale: &Scale) -> Image {
    let (grey, share) = GREY;
    let pixel = |(f, is_measured): (&Option<f32>, &bool)| match f {
        None => [0; 4],
        Some(f) => {
            let rgb = colour(scale, *f);
            let mixed = |k: usize| ((1.0 - share) * f32::from(rgb[k]) + share * grey[k]).round() as u8;
            let [r, g, b] = if *is_measured { rgb } else { [mixed(0), mixed(1), mixed(2)] };
            [r, g, b, 255]
        }
    };
    let rgba = slice.f.iter().zip(&slice.is_measured).flat_map(pixel).collect();
    Image { width: slice.size as u32, height: slice.size as u32, rgba }
}

fn disk(svg: &mut Svg, [x, y]: [f64; 2], slice: &Slice, view: &View, scale: &Scale) {
    let area = Area { x: x - RADIUS, y: y - RADIUS, width: 2.0 * RADIUS, height: 2.0 * RADIUS };
    svg.image(area, &picture(slice, scale).data_url());
    if slice.measured.len() <= MARKS {
        let mut path = String::new();
        for [u, v] in &slice.measured {
            let _ = write!(path, "M{} {}h.01", number(x + RADIUS * u), number(y - RADIUS * v));
        }
        svg.raw(&format!(
            "<path d=\"{path}\" stroke=\"#ffffff\" stroke-opacity=\"0.5\" stroke-width=\"1.7\" stroke-linecap=\"round\" \
             fill=\"none\"/>"
        ));
    }
    for angle in [30.0_f64, 60.0] {
        let radius = RADIUS * std::f64::consts::SQRT_2 * (0.5 * angle.to_radians()).sin();
        svg.raw(&format!(
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"none\" stroke=\"#ffffff\" stroke-opacity=\"0.28\" stroke-width=\"0.9\"/>",
            number(x),
            number(y),
            number(radius)
        ));
    }
    svg.circle([x, y], RADIUS, Role::Frame, 1.4);
    // The light, where it comes from, and the mirror direction or the straight-through ray.
    let [u, v] = to_disk(view.side, view.psi, incident(view.side, slice.sigma, view.psi));
    let (light, mirror) = ([x + RADIUS * u, y - RADIUS * v], [x - RADIUS * u, y + RADIUS * v]);
    svg.raw(&sun(light));
    svg.raw(&cross_mark(mirror));
    let label = Text { is_heavy: true, size: 16.0, ..MIDDLE };
    svg.text([x, y - RADIUS - 9.0], label, &format!("σ = {}", degrees(slice.sigma)));
}

/// Marks are white with a dark rim, so that they show on every colour.
fn sun([x, y]: [f64; 2]) -> String {
    let (x, y) = (number(x), number(y));
    format!(
        "<circle cx=\"{x}\" cy=\"{y}\" r=\"5\" fill=\"none\" stroke=\"#000000\" stroke-opacity=\"0.6\" stroke-width=\"3.4\"/>\
         <circle cx=\"{x}\" cy=\"{y}\" r=\"5\" fill=\"none\" stroke=\"#ffffff\" stroke-width=\"1.7\"/>\
         <circle cx=\"{x}\" cy=\"{y}\" r=\"1.4\" fill=\"#ffffff\"/>"
    )
}

fn cross_mark([x, y]: [f64; 2]) -> String {
    let path = format!("M{} {}l9 9m0 -9l-9 9", number(x - 4.5), number(y - 4.5));
    format!(
        "<path d=\"{path}\" fill=\"none\" stroke=\"#000000\" stroke-opacity=\"0.6\" stroke-width=\"3.4\"/>\
         <path d=\"{path}\" fill=\"none\" stroke=\"#ffffff\" stroke-width=\"1.7\"/>"
    )
}

/// The colour bar.
fn bar(svg: &mut Svg, y: f64, scale: &Scale) {
    const LEFT: f64 = 150.0;
    const LENGTH: f64 = WIDTH - 2.0 * LEFT;
    const STEPS: usize = 256;
    let rgba = (0..STEPS).flat_map(|step| {
        let colorous::Color { r, g, b } = colorous::VIRIDIS.eval_rational(step, STEPS);
        [r, g, b, 255]
    });
    let ramp = Image { width: STEPS as u32, height: 1, rgba: rgba.collect() };
    svg.raw(&format!(
        "<image x=\"{LEFT}\" y=\"{}\" width=\"{LENGTH}\" height=\"16\" preserveAspectRatio=\"none\" href=\"{}\"/>",
        number(y),
        ramp.data_url()
    ));
    for (from, to) in [
        ([LEFT, y], [LEFT + LENGTH, y]),
        ([LEFT, y + 16.0], [LEFT + LENGTH, y + 16.0]),
        ([LEFT, y], [LEFT, y + 16.0]),
        ([LEFT + LENGTH, y], [LEFT + LENGTH, y + 16.0]),
    ] {
        svg.line(from, to, Role::Frame, 1.0);
    }
    for tick in scale.ticks() {
        let x = LEFT + LENGTH * scale.place(tick.value);
        if !(LEFT - 0.5..=LEFT + LENGTH + 0.5).contains(&x) {
            continue;
        }
        svg.line([x, y + 16.0], [x, y + if tick.label.is_some() { 22.0 } else { 19.5 }], Role::Frame, 1.0);
        if let Some(label) = tick.label {
            svg.rich([x, y + 40.0], Text { size: 16.0, ..MIDDLE }, &label);
        }
    }
    svg.rich([LEFT + LENGTH + 14.0, y + 14.0], LABEL, "f (1/sr)");
    let scaling = if scale.scaling == Scaling::Log { "log scale" } else { "linear scale" };
    svg.text([LEFT - 86.0, y + 14.0], Text { size: 16.0, role: Role::Muted, ..LABEL }, scaling);
}

/// How to read the disks; returns the y at which the figure ends.
fn notes(svg: &mut Svg, y: f64, slices: &[Slice]) -> f64 {
    let style = Text { size: 15.0, role: Role::Muted, ..LABEL };
    let direction = match slices.iter().any(|slice| slice.scatter == Scatter::Transmission) {
        true => "mirror direction or straight ray",
        false => "mirror direction",
    };
    svg.raw(&sun([MARGIN + 7.0, y - 5.0]));
    svg.text([MARGIN + 20.0, y], style, "light, on the left");
    svg.raw(&cross_mark([MARGIN + 163.0, y - 5.0]));
    svg.text([MARGIN + 176.0, y], style, direction);
    let mut lines = vec!["Lambert equal-area disks, rings at 30° and 60°.".to_string()];
    let marks = slices.iter().map(|slice| slice.measured.len()).max().unwrap_or(0);
    let is_continued =
        slices.iter().any(|slice| slice.f.iter().zip(&slice.is_measured).any(|(f, measured)| f.is_some() && !measured));
    match marks {
        0 => {}
        1..=MARKS => lines.push("Dots: measured directions.".into()),
        _ => lines.push(format!("Up to {marks} directions were measured per incidence, too many to mark.")),
    }
    if is_continued {
        lines.push("Grey: not measured; extrapolated from the nearest measured values.".into());
    }
    for (at, line) in lines.iter().enumerate() {
        svg.text([MARGIN, y + 22.0 * (at + 1) as f64], style, line);
    }
    y + 22.0 * lines.len() as f64 + 12.0
}
