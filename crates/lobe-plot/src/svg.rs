//! Writing SVG.
//!
//! Every element has the colours of a figure on white as attributes, and a class with which a page may recolour it:
//! style sheets override attributes, and programs without style sheets still draw the figure.

use std::fmt::Write as _;

use quick_xml::escape::escape;

use crate::image::Image;
use crate::ink::Ink;
use crate::layout::{Layout, Paper};

/// The role of an element, which determines its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// Primary text.
    Ink,
    /// Secondary text.
    Muted,
    /// The frame of a plot.
    Frame,
    /// Lines of a grid.
    Grid,
    /// Minor lines of a grid.
    Faint,
}

impl Role {
    fn class(self) -> &'static str {
        match self {
            Role::Ink => "ink",
            Role::Muted => "muted",
            Role::Frame => "frame",
            Role::Grid => "grid",
            Role::Faint => "faint",
        }
    }

    fn colour(self) -> &'static str {
        match self {
            Role::Ink => "#1c1e21",
            Role::Muted => "#5f656d",
            Role::Frame => "#3a3f45",
            Role::Grid => "#dcdfe3",
            Role::Faint => "#eef0f2",
        }
    }
}

/// The part of a text that is at its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// The style of a text.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Text {
    pub(crate) size: f64,
    pub(crate) role: Role,
    pub(crate) anchor: Anchor,
    pub(crate) is_heavy: bool,
    /// Rotated to read upward.
    pub(crate) is_upward: bool,
    /// With a halo in the colour of the paper, so that it is legible across lines.
    pub(crate) has_halo: bool,
}

/// Text in the style of labels.
pub(crate) const LABEL: Text =
    Text { size: 17.0, role: Role::Ink, anchor: Anchor::Start, is_heavy: false, is_upward: false, has_halo: false };

/// A rectangle in the units of the figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Area {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

/// A figure that is being drawn.
pub(crate) struct Svg<'a> {
    /// Distinguishes the ids of this figure from those of others on the same page.
    name: String,
    paper: Paper<'a>,
    body: String,
    clips: usize,
}

impl<'a> Svg<'a> {
    pub(crate) fn new(name: impl Into<String>, paper: Paper<'a>) -> Self {
        Svg { name: name.into(), paper, body: String::new(), clips: 0 }
    }

    pub(crate) fn layout(&self) -> Layout {
        self.paper.layout
    }

    /// The figure, `height` units high. `title` describes it to screen readers.
    pub(crate) fn finish(self, height: f64, title: &str) -> String {
        let (width, pixels) = (self.paper.layout.width, self.paper.pixels);
        let rows = (f64::from(pixels) * height / width).round();
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"figure\" viewBox=\"0 0 {} {}\" width=\"{pixels}\" \
             height=\"{rows}\" role=\"img\" font-family=\"Roboto, 'Helvetica Neue', Arial, sans-serif\">\n\
             <title>{}</title>\n<rect class=\"paper\" width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{}</svg>\n",
            number(width),
            number(height),
            escape(title),
            self.body
        )
    }

    /// A text in which `_{x}` is a subscript and `^{x}` a superscript.
    pub(crate) fn rich(&mut self, at: [f64; 2], style: Text, text: &str) {
        let mut spans = String::new();
        let mut rest = text;
        while let Some(start) = rest.find("_{").into_iter().chain(rest.find("^{")).min() {
            let Some(end) = rest[start..].find('}').map(|end| start + end) else { break };
            let shift = if rest[start..].starts_with('_') { 0.22 } else { -0.42 };
            let shift = number(style.size * shift);
            let back = number(-shift.parse::<f64>().unwrap_or(0.0));
            let _ = write!(
                spans,
                "{}<tspan dy=\"{shift}\" font-size=\"{}\">{}</tspan>",
                escape(&rest[..start]),
                number(0.74 * style.size),
                escape(&rest[start + 2..end])
            );
            rest = &rest[end + 1..];
            if !rest.is_empty() {
                // The shift of a span lasts until the next one.
                let until = rest.find("_{").into_iter().chain(rest.find("^{")).min().unwrap_or(rest.len());
                let _ = write!(spans, "<tspan dy=\"{back}\">{}</tspan>", escape(&rest[..until]));
                rest = &rest[until..];
            }
        }
        spans.push_str(&escape(rest));
        self.write_text(at, style, &spans);
    }

    /// A text without markup.
    pub(crate) fn text(&mut self, at: [f64; 2], style: Text, text: &str) {
        self.write_text(at, style, &escape(text));
    }

    fn write_text(&mut self, [x, y]: [f64; 2], style: Text, escaped: &str) {
        let anchor = match style.anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let weight = if style.is_heavy { " font-weight=\"500\"" } else { "" };
        let place = match style.is_upward {
            true => format!("transform=\"translate({} {}) rotate(-90)\"", number(x), number(y)),
            false => format!("x=\"{}\" y=\"{}\"", number(x), number(y)),
        };
        let halo = match style.has_halo {
            true => " stroke=\"#ffffff\" stroke-width=\"4\" stroke-linejoin=\"round\" paint-order=\"stroke\"",
            false => "",
        };
        let (class, colour, size) = (style.role.class(), style.role.colour(), number(style.size));
        let _ = writeln!(
            self.body,
            "<text {place} class=\"{class}\" fill=\"{colour}\" font-size=\"{size}\"{anchor}{weight}{halo}>{escaped}</text>"
        );
    }

    pub(crate) fn line(&mut self, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], role: Role, width: f64) {
        let (x1, y1, x2, y2) = (number(x1), number(y1), number(x2), number(y2));
        let (class, colour) = (role.class(), role.colour());
        let _ = writeln!(
            self.body,
            "<path d=\"M{x1} {y1}L{x2} {y2}\" class=\"{class}\" stroke=\"{colour}\" stroke-width=\"{width}\" fill=\"none\"/>"
        );
    }

    pub(crate) fn circle(&mut self, [x, y]: [f64; 2], radius: f64, role: Role, width: f64) {
        let (x, y, radius, class, colour) = (number(x), number(y), number(radius), role.class(), role.colour());
        let _ = writeln!(
            self.body,
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" class=\"{class}\" stroke=\"{colour}\" stroke-width=\"{width}\" \
             fill=\"none\"/>"
        );
    }

    /// Half a circle or less from one point to another, clockwise or not.
    pub(crate) fn arc(&mut self, from: [f64; 2], to: [f64; 2], radius: f64, is_clockwise: bool, role: Role) {
        let ([x1, y1], [x2, y2], radius) = (from.map(number), to.map(number), number(radius));
        let (class, colour, sweep) = (role.class(), role.colour(), u8::from(is_clockwise));
        let _ = writeln!(
            self.body,
            "<path d=\"M{x1} {y1}A{radius} {radius} 0 0 {sweep} {x2} {y2}\" class=\"{class}\" stroke=\"{colour}\" \
             stroke-width=\"1\" fill=\"none\"/>"
        );
    }

    /// Lines of one series: `runs` of points, and whether each is solid.
    pub(crate) fn series(&mut self, ink: &Ink, runs: &[(bool, Vec<[f64; 2]>)]) {
        for (is_solid, points) in runs {
            let mut path = String::new();
            for (at, [x, y]) in points.iter().enumerate() {
                let _ = write!(path, "{}{} {}", if at == 0 { 'M' } else { 'L' }, number(*x), number(*y));
            }
            let dashes = if *is_solid { "" } else { " stroke-dasharray=\"2.5 4\" stroke-opacity=\"0.75\"" };
            let Ink { class, light, .. } = ink;
            let _ = writeln!(
                self.body,
                "<path d=\"{path}\" class=\"{class}\" style=\"{}\" stroke=\"{light}\" stroke-width=\"2.2\" fill=\"none\" \
                 stroke-linejoin=\"round\" stroke-linecap=\"round\"{dashes}/>",
                ink.style()
            );
        }
    }

    /// A filled shape in the colour of a series.
    pub(crate) fn mark(&mut self, ink: &Ink, corners: &[[f64; 2]]) {
        let points: Vec<String> = corners.iter().map(|[x, y]| format!("{},{}", number(*x), number(*y))).collect();
        let _ = writeln!(
            self.body,
            "<polygon points=\"{}\" style=\"{}\" fill=\"{}\"/>",
            points.join(" "),
            ink.style(),
            ink.light
        );
    }

    /// A filled shape in the colour of secondary text.
    pub(crate) fn muted_mark(&mut self, corners: &[[f64; 2]]) {
        let points: Vec<String> = corners.iter().map(|[x, y]| format!("{},{}", number(*x), number(*y))).collect();
        let colour = Role::Muted.colour();
        let _ = writeln!(self.body, "<polygon points=\"{}\" class=\"muted\" fill=\"{colour}\"/>", points.join(" "));
    }

    /// Dots in the colour of a series, as one path of lines without length.
    pub(crate) fn dots(&mut self, ink: &Ink, places: &[[f64; 2]]) {
        let path: String = places.iter().map(|[x, y]| format!("M{} {}h.01", number(*x), number(*y))).collect();
        if !path.is_empty() {
            let _ = writeln!(
                self.body,
                "<path d=\"{path}\" class=\"dots\" style=\"{}\" stroke=\"{}\" stroke-width=\"6\" \
                 stroke-linecap=\"round\" fill=\"none\"/>",
                ink.style(),
                ink.light
            );
        }
    }

    /// An invisible area that shows a text when the pointer is on it.
    pub(crate) fn hint(&mut self, [x, y]: [f64; 2], radius: f64, text: &str) {
        let _ = writeln!(
            self.body,
            "<circle cx=\"{}\" cy=\"{}\" r=\"{radius}\" class=\"hint\" fill=\"#808080\" fill-opacity=\"0\"><title>{}</title></circle>",
            number(x),
            number(y),
            escape(text)
        );
    }

    /// Raw markup, whose colours are the same on every page.
    pub(crate) fn raw(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }

    /// A picture that fills an area.
    pub(crate) fn image(&mut self, area: Area, image: &Image) {
        let [x, y, width, height] = [area.x, area.y, area.width, area.height].map(number);
        let url = image.data_url();
        let _ = match self.paper.sprites {
            Some(sprites) => writeln!(
                self.body,
                "<use href=\"#{}\" transform=\"translate({x} {y}) scale({width} {height})\"/>",
                sprites.id(url)
            ),
            None => writeln!(
                self.body,
                "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" \
                 href=\"{url}\"/>"
            ),
        };
    }

    /// The output of `draw`, clipped to the area.
    pub(crate) fn clipped(&mut self, area: Area, draw: impl FnOnce(&mut Svg<'a>)) {
        let layout = if self.paper.layout.is_narrow { "narrow-" } else { "" };
        let id = format!("{}-{layout}clip-{}", self.name, self.clips);
        self.clips += 1;
        let _ = writeln!(
            self.body,
            "<clipPath id=\"{id}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n<g clip-path=\"url(#{id})\">",
            number(area.x),
            number(area.y),
            number(area.width),
            number(area.height)
        );
        draw(self);
        self.body.push_str("</g>\n");
    }
}

/// A coordinate to a hundredth of a unit.
pub(crate) fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_cannot_break_out() {
        let mut svg = Svg::new("test", Paper::alone(720));
        svg.text([0.0, 0.0], LABEL, "a<b>&\"_{c}");
        let figure = svg.finish(10.0, "</title><script>");
        assert!(figure.contains("a&lt;b&gt;&amp;&quot;_{c}"), "{figure}");
        assert!(!figure.contains("<script>"), "{figure}");
    }

    #[test]
    fn shifts_are_undone() {
        let mut svg = Svg::new("test", Paper::alone(720));
        svg.rich([0.0, 0.0], Text { size: 10.0, ..LABEL }, "f_{r} = 10^{2}/sr");
        assert!(
            svg.body.contains(
                ">f<tspan dy=\"2.2\" font-size=\"7.4\">r</tspan><tspan dy=\"-2.2\"> = 10</tspan>\
                 <tspan dy=\"-4.2\" font-size=\"7.4\">2</tspan><tspan dy=\"4.2\">/sr</tspan></text>"
            ),
            "{}",
            svg.body
        );
    }

    #[test]
    fn coordinates_are_short() {
        assert_eq!([1.0, -0.001, 0.126, 100.0].map(number).join(" "), "1 0 0.13 100");
    }
}
