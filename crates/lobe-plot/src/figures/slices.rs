//! All outgoing directions of each incidence, as disks.

use std::f64::consts::{FRAC_PI_4, SQRT_2};
use std::fmt::Write as _;

use lobe::Scatter;

use super::bar::{self, Extent};
use super::cartesian::title;
use super::shared::{MARGIN, MIDDLE, conditions, heading, id, notes, scatter_name, shortened};
use crate::evaluate::Progress;
use crate::geometry::{incident, to_disk};
use crate::image::Image;
use crate::layout::{Layout, Paper};
use crate::scale::{Scale, Scaling, degrees, short};
use crate::shown::{Shown, incidences};
use crate::slice::{Slice, slice};
use crate::svg::{Area, LABEL, Role, Svg, Text, number};
use crate::view::View;

/// More disks than this are too small to see.
const MOST: usize = 6;
/// The radius of a disk on wide paper.
const RADIUS: f64 = 100.0;
/// The space above a disk, for its incidence, and below it.
const ABOVE: f64 = 24.0;
const BELOW: f64 = 16.0;
/// More marks than this would hide the values.
const MARKS: usize = 1500;
/// The colour with which unmeasured values are mixed, and its share.
const GREY: ([f32; 3], f32) = ([206.0, 209.0, 214.0], 0.74);

/// The slices of one file, reflection before transmission, one per incidence.
pub(super) type OfFile = Vec<Slice>;

/// The slices of each file.
pub(super) fn slices(shown: &[Shown<'_>], progress: &dyn Progress) -> Vec<OfFile> {
    let sigmas = incidences(shown, MOST);
    // More image pixels than pixels of the figure, because disks are viewed closely, unless evaluation is slow.
    let density = if shown.iter().any(|shown| shown.subject.is_slow()) { 0.9 } else { 1.5 };
    let pixels = shown.first().map_or(0, |first| first.view.width);
    let size = (density * 2.0 * RADIUS * f64::from(pixels) / Layout::WIDE.width).round().clamp(96.0, 480.0) as usize;
    let disks: usize = shown.iter().map(|shown| shown.subject.scatters(shown.view.side).len() * sigmas.len()).sum();
    progress.begin("slices", (FRAC_PI_4 * (size * size * disks) as f64) as u64);
    let of_file = |&Shown { subject, view }: &Shown<'_>| {
        let of = |scatter| sigmas.iter().map(move |&sigma| slice(subject, view, sigma, scatter, size, progress));
        subject.scatters(view.side).into_iter().flat_map(of).collect()
    };
    shown.iter().map(of_file).collect()
}

/// Reflection above transmission, one file above the other, all with the same colours.
pub(super) fn draw(shown: &[Shown<'_>], of_files: &[OfFile], paper: Paper<'_>) -> String {
    let Some(first) = shown.first() else { return String::new() };
    let all: Vec<&Slice> = of_files.iter().flatten().collect();
    let scale = scale(&all, first.view.scaling.unwrap_or(Scaling::Log));
    let layout = paper.layout;
    let columns = if layout.is_narrow { 2 } else { 3 };
    let cell = (layout.width - 2.0 * MARGIN) / columns as f64;
    let radius = RADIUS.min(0.5 * cell - 8.0);
    let row = 2.0 * radius + ABOVE + BELOW;
    let mut svg = Svg::new(id("slices", first.view), paper);
    let what = format!("Outgoing hemisphere at each incidence σ, {}", conditions(shown));
    let mut top = heading(&mut svg, shown, &what);
    for (shown_one, slices) in shown.iter().zip(of_files) {
        let has_both = slices.iter().any(|slice| slice.scatter == Scatter::Reflection)
            && slices.iter().any(|slice| slice.scatter == Scatter::Transmission);
        for scatter in [Scatter::Reflection, Scatter::Transmission] {
            let of: Vec<&Slice> = slices.iter().filter(|slice| slice.scatter == scatter).collect();
            if of.is_empty() {
                continue;
            }
            let mut words = Vec::new();
            if shown.len() > 1 {
                words.push(shortened(shown_one.subject.name(), (layout.width / 14.0) as usize));
            }
            if has_both || scatter == Scatter::Transmission {
                words.push(scatter_name(scatter).into());
            }
            if !words.is_empty() {
                let name = Text { is_heavy: true, size: 16.0, ..LABEL };
                svg.text([MARGIN, top + 14.0], name, &words.join(", "));
                top += 26.0;
            }
            for (at, slice) in of.iter().enumerate() {
                let in_row = (of.len() - at / columns * columns).min(columns);
                let left = 0.5 * (layout.width - cell * in_row as f64);
                let x = left + cell * ((at % columns) as f64 + 0.5);
                let y = top + row * (at / columns) as f64 + ABOVE + radius;
                disk(&mut svg, Place { x, y, radius }, slice, shown_one.view, &scale);
            }
            top += row * of.len().div_ceil(columns) as f64;
        }
    }
    scale_bar(&mut svg, top + 14.0, &scale);
    let bottom = signs_and_notes(&mut svg, top + 92.0, &all);
    svg.finish(bottom, &title(shown, "f over the outgoing hemisphere for each incidence"))
}

/// The colour scale: the range of the measured values, without the lowest hundredth.
fn scale(slices: &[&Slice], scaling: Scaling) -> Scale {
    let measured = |slice: &Slice| {
        let of = slice.f.iter().zip(&slice.is_measured).filter(|(_, measured)| **measured);
        of.filter_map(|(f, _)| *f).map(f64::from).filter(|f| f.is_finite()).collect::<Vec<_>>()
    };
    let mut values: Vec<f64> = slices.iter().flat_map(|slice| measured(slice)).collect();
    if values.is_empty() {
        values = slices.iter().flat_map(|slice| slice.f.iter().flatten()).map(|f| f64::from(*f)).collect();
    }
    values.retain(|value| *value > 0.0);
    values.sort_by(f64::total_cmp);
    let Some(&most) = values.last() else { return Scale::around([].into_iter(), scaling) };
    match scaling {
        Scaling::Linear => Scale::around([most].into_iter(), scaling),
        Scaling::Log => Scale::between(values[values.len() / 100].clamp(1e-6 * most, 0.5 * most), most),
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

/// The position of a disk.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) radius: f64,
}

impl Place {
    /// The place of a point of the unit disk.
    pub(super) fn at(self, [u, v]: [f64; 2]) -> [f64; 2] {
        [self.x + self.radius * u, self.y - self.radius * v]
    }
}

fn disk(svg: &mut Svg<'_>, place: Place, slice: &Slice, view: &View, scale: &Scale) {
    let Place { x, y, radius } = place;
    svg.image(Area { x: x - radius, y: y - radius, width: 2.0 * radius, height: 2.0 * radius }, &picture(slice, scale));
    if slice.measured.len() <= MARKS {
        let mut path = String::new();
        for &point in &slice.measured {
            let [x, y] = place.at(point);
            let _ = write!(path, "M{} {}h.01", number(x), number(y));
        }
        svg.raw(&format!(
            "<path d=\"{path}\" stroke=\"#ffffff\" stroke-opacity=\"0.5\" stroke-width=\"1.7\" stroke-linecap=\"round\" \
             fill=\"none\"/>"
        ));
    }
    rings(svg, place);
    light_and_mirror(svg, place, view, slice.sigma);
    hints(svg, place, slice);
    let label = Text { is_heavy: true, size: 16.0, ..MIDDLE };
    svg.text([x, y - radius - 9.0], label, &format!("σ = {}", degrees(slice.sigma)));
}

/// The rings of polar angles, and the rim.
pub(super) fn rings(svg: &mut Svg<'_>, Place { x, y, radius }: Place) {
    for angle in [30.0_f64, 60.0] {
        svg.raw(&format!(
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"none\" stroke=\"#ffffff\" stroke-opacity=\"0.28\" stroke-width=\"0.9\"/>",
            number(x),
            number(y),
            number(radius * ring(angle))
        ));
    }
    svg.circle([x, y], radius, Role::Frame, 1.4);
}

/// The light, at the direction it comes from, and the mirror direction or the straight-through ray.
pub(super) fn light_and_mirror(svg: &mut Svg<'_>, place: Place, view: &View, sigma: f64) {
    let [u, v] = to_disk(view.side, view.psi, incident(view.side, sigma, view.psi));
    svg.raw(&sun(place.at([u, v])));
    svg.raw(&cross_mark(place.at([-u, -v])));
}

/// The radius on the unit disk of a polar angle in degrees.
pub(super) fn ring(angle: f64) -> f64 {
    SQRT_2 * (0.5 * angle.to_radians()).sin()
}

/// The values at the normal and at polar angles and azimuths in steps, shown when the pointer is there.
fn hints(svg: &mut Svg<'_>, place: Place, slice: &Slice) {
    let mut say = |theta: f64, turn: f64| {
        let (sin, cos) = turn.to_radians().sin_cos();
        let point = [ring(theta) * cos, ring(theta) * sin];
        let pixel = |c: f64| (((1.0 + c) * 0.5 * slice.size as f64) as usize).min(slice.size - 1);
        let at = pixel(-point[1]) * slice.size + pixel(point[0]);
        let Some(f) = slice.f[at] else { return };
        let kind = if slice.is_measured[at] { "" } else { ", not measured" };
        let turn = if theta > 0.0 { format!(", {turn}° from the mirror side") } else { String::new() };
        let text = format!("σ = {}, θ = {theta}°{turn}: {} 1/sr{kind}", degrees(slice.sigma), short(f64::from(f)));
        svg.hint(place.at(point), 0.07 * place.radius, &text);
    };
    say(0.0, 0.0);
    for theta in [15.0, 30.0, 45.0, 60.0, 75.0] {
        (-5..=6).for_each(|step| say(theta, 30.0 * f64::from(step)));
    }
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

/// The colour bar, with its quantity at the right end, or above it if there is no room.
fn scale_bar(svg: &mut Svg<'_>, y: f64, scale: &Scale) {
    let Extent { left, length } = bar::framed(svg, y, |share| colorous::VIRIDIS.eval_continuous(share));
    let mut end = f64::NEG_INFINITY;
    for tick in scale.ticks() {
        let x = left + length * scale.place(tick.value);
        if !(left - 0.5..=left + length + 0.5).contains(&x) {
            continue;
        }
        // Labels that would overlap are left out. A letter is about half as wide as it is high.
        let half = 4.0 * tick.label.as_ref().map_or(0, |label| label.chars().count()) as f64;
        let label = tick.label.as_ref().filter(|_| x - half > end);
        svg.line([x, y + 16.0], [x, y + if label.is_some() { 22.0 } else { 19.5 }], Role::Frame, 1.0);
        if let Some(label) = label {
            svg.rich([x, y + 40.0], Text { size: 16.0, ..MIDDLE }, label);
            end = x + half + 6.0;
        }
    }
    let scaling = if scale.scaling == Scaling::Log { "log scale" } else { "linear scale" };
    let muted = Text { size: 16.0, role: Role::Muted, ..LABEL };
    if svg.layout().is_narrow {
        svg.rich([left + 0.5 * length, y - 8.0], Text { size: 16.0, ..MIDDLE }, &format!("f (1/sr), {scaling}"));
    } else {
        svg.rich([left + length + 14.0, y + 14.0], LABEL, "f (1/sr)");
        svg.text([left - 100.0, y + 14.0], muted, scaling);
    }
}

/// The explanation of the disks; returns the height at which the figure ends.
fn signs_and_notes(svg: &mut Svg<'_>, y: f64, slices: &[&Slice]) -> f64 {
    let style = Text { size: 15.0, role: Role::Muted, ..LABEL };
    let direction = match slices.iter().any(|slice| slice.scatter == Scatter::Transmission) {
        true => "mirror direction or straight ray",
        false => "mirror direction",
    };
    svg.raw(&sun([MARGIN + 7.0, y - 5.0]));
    svg.text([MARGIN + 20.0, y], style, "light, on the left");
    let (x, next) = if svg.layout().is_narrow { (MARGIN, y + 22.0) } else { (MARGIN + 156.0, y) };
    svg.raw(&cross_mark([x + 7.0, next - 5.0]));
    svg.text([x + 20.0, next], style, direction);
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
    if !slices.iter().any(|slice| slice.f.iter().flatten().any(|f| *f > 0.0)) {
        lines.push("No value is above 0.".into());
    }
    notes(svg, next + 22.0, &lines)
}
