//! Pictures of spectra and of polarised light: their colours, degree and angle of polarisation, and spectra at points.

use lobe_colour::ToneMap;

use super::Drawing;
use super::chart::Axis;
use super::legend::{Entry, Legend};
use super::polarisation::{angle_colour, bars, degree_colour, round_up};
use super::shared::{MARGIN, MIDDLE, named_heading, notes};
use super::small::{Small, Trace};
use super::sphere::ev;
use crate::image::Image;
use crate::ink::Ink;
use crate::layout::Paper;
use crate::polarised::Linear;
use crate::scale::{Scale, Scaling, short};
use crate::svg::{Area, LABEL, Svg, Text};

/// A picture to draw.
#[derive(Clone, Debug)]
pub struct Picture<'a> {
    /// The name of the file.
    pub name: &'a str,
    /// What it is a picture of, in a few words.
    pub what: &'a str,
    /// Columns and rows; at least one each.
    pub size: [usize; 2],
    /// Linear sRGB of each pixel, rows from the top.
    pub colours: &'a [[f32; 3]],
    /// The wavelengths in nm, ascending; none if there are no spectra.
    pub wavelengths: &'a [f64],
    /// `[pixel][wavelength]`.
    pub spectra: &'a [f32],
    /// The mean of each wavelength over all pixels.
    pub mean: &'a [f64],
    /// Degree and angle of linear polarisation of each pixel, the angle in radians; none if light is not polarised.
    pub polarisation: Option<&'a [[f32; 2]]>,
    /// Pixels whose values are shown, as column and row. If there are none, some in the middle row.
    pub points: &'a [[usize; 2]],
    /// The exposure of the colours in stops; `None` fits it to the brightest hundredth.
    pub exposure: Option<f32>,
    /// The scaling of spectra; linear by default.
    pub scaling: Option<Scaling>,
    /// The width of the figure in pixels.
    pub pixels: u32,
}

/// More pixels along a side are averaged before they are drawn.
const MOST: usize = 1200;
/// A picture is at most this much higher than wide.
const HIGHEST: f64 = 1.25;

/// The figure of a picture.
pub fn draw_picture(picture: &Picture<'_>) -> Drawing {
    Drawing { svg: draw_on(picture, Paper::alone(picture.pixels)), said: said(picture) }
}

/// Remarks about the figure.
pub(crate) fn said(picture: &Picture<'_>) -> Vec<String> {
    let points: Vec<String> = points(picture).iter().map(|[x, y]| format!("{x},{y}")).collect();
    vec![format!("exposed at {}", ev(f64::from(exposure(picture)))), format!("points at {}", points.join(" "))]
}

/// The pixels whose values are shown.
fn points(picture: &Picture<'_>) -> Vec<[usize; 2]> {
    let [columns, rows] = picture.size;
    match picture.points {
        [] => {
            let mut points: Vec<[usize; 2]> = [1, 2, 3].map(|k| [columns * k / 4, rows / 2]).into();
            points.dedup();
            points
        }
        some => some.to_vec(),
    }
}

/// The exposure in stops, in quarters if it is not given.
fn exposure(picture: &Picture<'_>) -> f32 {
    if let Some(exposure) = picture.exposure {
        return exposure;
    }
    let largest = |c: &[f32; 3]| c.iter().copied().fold(0.0_f32, f32::max);
    let mut bright: Vec<f32> = picture.colours.iter().map(largest).filter(|c| *c > 0.0 && c.is_finite()).collect();
    if bright.is_empty() {
        return 0.0;
    }
    bright.sort_by(f32::total_cmp);
    let at = bright[(bright.len() - 1) * 99 / 100];
    ((4.0 * (0.8 / at).log2()).round() / 4.0).clamp(-60.0, 60.0)
}

/// The pixels of an image of `of`, averaged if there are many.
fn image<T: Copy>(picture: &Picture<'_>, of: &[T], colour: impl Fn(&[T]) -> [u8; 3]) -> Image {
    let [columns, rows] = picture.size;
    let step = columns.max(rows).div_ceil(MOST).max(1);
    let (width, height) = (columns.div_ceil(step), rows.div_ceil(step));
    let mut rgba = Vec::with_capacity(4 * width * height);
    let mut block = Vec::new();
    for row in 0..height {
        for column in 0..width {
            block.clear();
            for y in row * step..rows.min((row + 1) * step) {
                block.extend_from_slice(
                    &of[y * columns + column * step..y * columns + columns.min((column + 1) * step)],
                );
            }
            let [r, g, b] = colour(&block);
            rgba.extend([r, g, b, 255]);
        }
    }
    Image { width: width as u32, height: height as u32, rgba }
}

/// The mean of finite colours, tone-mapped.
fn shown(tone: ToneMap, block: &[[f32; 3]]) -> [u8; 3] {
    std::array::from_fn(|k| {
        let finite = block.iter().map(|c| c[k]).filter(|c| c.is_finite());
        let (sum, count) = finite.fold((0.0, 0_u32), |(sum, count), c| (sum + c, count + 1));
        tone.byte(sum / count.max(1) as f32)
    })
}

pub(crate) fn draw_on(picture: &Picture<'_>, paper: Paper<'_>) -> String {
    let layout = paper.layout;
    let mut svg = Svg::new("picture", paper);
    let stops = exposure(picture);
    let what = format!("{}, exposure {}", picture.what, ev(f64::from(stops)));
    let mut y = named_heading(&mut svg, picture.name, &what) + 2.0;
    let tone = ToneMap { exposure: stops };
    let colours = image(picture, picture.colours, |block| shown(tone, block));
    let points = points(picture);
    let inks: Vec<Ink> = (0..points.len()).map(Ink::of_set).collect();
    let room = layout.width - 2.0 * MARGIN;
    let area = fitted(picture, MARGIN, y, room);
    svg.image(area, &colours);
    for ((index, point), ink) in points.iter().enumerate().zip(&inks) {
        marker(&mut svg, picture, area, *point, index, ink);
    }
    y = area.y + area.height + 14.0;
    if let Some(polarisation) = picture.polarisation {
        y = maps(&mut svg, picture, polarisation, y);
    }
    if picture.wavelengths.len() > 1 {
        y = spectra(&mut svg, picture, &points, &inks, y);
    }
    let lines: Vec<String> = points.iter().enumerate().map(|(index, point)| values(picture, index, *point)).collect();
    let mut lines = lines;
    if picture.polarisation.is_some() {
        lines.push(
            "Angles are counted from the right of the picture, counterclockwise; grey: less than 1 % polarised.".into(),
        );
    }
    let end = notes(&mut svg, y + 12.0, &lines);
    svg.finish(end - 4.0, &format!("{}: {}", picture.name, picture.what))
}

/// The largest area of the shape of the picture, in the middle of a column.
fn fitted(picture: &Picture<'_>, x: f64, y: f64, room: f64) -> Area {
    let shape = picture.size[1] as f64 / picture.size[0] as f64;
    let width = if shape > HIGHEST { room * HIGHEST / shape } else { room };
    Area { x: x + 0.5 * (room - width), y, width, height: width * shape }
}

/// A ring around a point, with its number.
fn marker(svg: &mut Svg<'_>, picture: &Picture<'_>, area: Area, [x, y]: [usize; 2], index: usize, ink: &Ink) {
    let [cx, cy] = [
        area.x + area.width * (x as f64 + 0.5) / picture.size[0] as f64,
        area.y + area.height * (y as f64 + 0.5) / picture.size[1] as f64,
    ];
    for (colour, width) in [("#ffffff", 4.5), (ink.light.as_str(), 2.2)] {
        svg.raw(&format!(
            "<circle cx=\"{cx:.1}\" cy=\"{cy:.1}\" r=\"7\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"/>"
        ));
    }
    svg.raw(&format!(
        "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"17\" font-weight=\"500\" fill=\"#000000\" stroke=\"#ffffff\" \
         stroke-width=\"4\" stroke-linejoin=\"round\" paint-order=\"stroke\">{}</text>",
        // To the left of points at the right edge.
        cx + if cx + 40.0 > area.x + area.width { -24.0 } else { 12.0 },
        cy + 6.0,
        index + 1
    ));
    svg.hint([cx, cy], 9.0, &values(picture, index, [x, y]));
}

/// What is known about a point, in words.
fn values(picture: &Picture<'_>, index: usize, [x, y]: [usize; 2]) -> String {
    let pixel = y * picture.size[0] + x;
    let [r, g, b] = picture.colours[pixel].map(|c| short(f64::from(c)));
    let polarised = picture.polarisation.map_or_else(String::new, |all| {
        let [degree, angle] = all[pixel];
        format!(", {:.1} % polarised at {:.0}°", 100.0 * degree, angle.to_degrees())
    });
    format!("{}: column {x}, row {y}: sRGB {r} {g} {b}{polarised}", index + 1)
}

/// Degree and angle next to each other, or below each other on narrow paper; returns the height below them.
fn maps(svg: &mut Svg<'_>, picture: &Picture<'_>, polarisation: &[[f32; 2]], top: f64) -> f64 {
    let layout = svg.layout();
    let light = |block: &[[f32; 2]]| mean(block);
    let most = polarisation.iter().map(|[degree, _]| *degree).fold(0.0, f32::max);
    let high = round_up(most);
    let degrees = image(picture, polarisation, |block| degree_colour(&light(block), high));
    let angles = image(picture, polarisation, |block| angle_colour(&light(block)));
    let gap = 12.0;
    let room = layout.width - 2.0 * MARGIN;
    let width = if layout.is_narrow { room } else { 0.5 * (room - gap) };
    let mut y = top;
    let style = Text { is_heavy: true, size: 16.0, ..LABEL };
    for (at, (name, map)) in [("degree of polarisation", degrees), ("angle of polarisation", angles)].iter().enumerate()
    {
        let x = if layout.is_narrow { MARGIN } else { MARGIN + (width + gap) * at as f64 };
        svg.text([x, y + 14.0], style, name);
        let area = fitted(picture, x, y + 22.0, width);
        svg.image(area, map);
        if layout.is_narrow || at == 1 {
            y = area.y + area.height + 10.0;
        }
    }
    bars(svg, y + 16.0, high)
}

/// The mean of a block, by the components of a vector of twice the angle.
fn mean(block: &[[f32; 2]]) -> Linear {
    if let [[degree, angle]] = block {
        return Linear { degree: *degree, angle: *angle };
    }
    let (mut x, mut y) = (0.0, 0.0);
    for [degree, angle] in block {
        let (sin, cos) = (2.0 * angle).sin_cos();
        (x, y) = (x + degree * cos, y + degree * sin);
    }
    let angle = 0.5 * y.atan2(x);
    let angle = if angle < 0.0 { angle + std::f32::consts::PI } else { angle };
    Linear { degree: x.hypot(y) / block.len().max(1) as f32, angle }
}

/// The spectra of the points and their mean; returns the height below them.
fn spectra(svg: &mut Svg<'_>, picture: &Picture<'_>, points: &[[usize; 2]], inks: &[Ink], top: f64) -> f64 {
    let layout = svg.layout();
    let nm = picture.wavelengths;
    let of = |[x, y]: [usize; 2]| {
        let pixel = y * picture.size[0] + x;
        picture.spectra[pixel * nm.len()..][..nm.len()].iter().map(|v| Some(*v).filter(|v| v.is_finite())).collect()
    };
    let is_measured = vec![true; nm.len()];
    let trace = |values: Vec<Option<f32>>, ink: &Ink| Trace {
        ink: ink.clone(),
        x: nm,
        values,
        is_measured: &is_measured,
        mirror: None,
    };
    let grey = Ink { class: "mean".into(), light: "#8a9099".into(), dark: "#a2a9b3".into() };
    let mut traces = vec![trace(picture.mean.iter().map(|mean| Some(*mean as f32)).collect(), &grey)];
    traces.extend(points.iter().zip(inks).map(|(point, ink)| trace(of(*point), ink)));
    let left = 80.0;
    let area = Area { x: left, y: top + 8.0, width: layout.width - left - MARGIN, height: 220.0 };
    let scaling = picture.scaling.unwrap_or(Scaling::Linear);
    let all = traces.iter().flat_map(|trace| trace.values.iter().flatten()).map(|value| f64::from(*value));
    let scale = Scale::around(all, scaling);
    let axis = Axis::Wavelength(nm[0], nm[nm.len() - 1]);
    let small = Small { area, name: "S0".into(), axis, scale, traces, has_labels: [true; 2], size: 15.0 };
    small.draw(svg);
    svg.rich([left + 0.5 * area.width, area.y + 260.0], MIDDLE, "wavelength (nm)");
    let mut entries = vec![Entry { ink: grey, label: "mean".into() }];
    entries.extend(inks.iter().enumerate().map(|(at, ink)| Entry { ink: ink.clone(), label: (at + 1).to_string() }));
    let legend =
        Legend { title: "point", entries: &entries, has_mirror: false, has_points: false, has_continued: false };
    legend.below(svg, area.y + 286.0)
}
