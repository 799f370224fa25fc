//! Code shared by all figures: margins, headings and names.

use lobe::{Scatter, Side};

use crate::scale::degrees;
use crate::shown::Shown;
use crate::svg::{Anchor, LABEL, Role, Svg, Text};
use crate::view::View;

/// The left and right margin of every figure.
pub(super) const MARGIN: f64 = 22.0;

/// An id for the parts of a figure, unique on a page.
pub(super) fn id(figure: &str, view: &View) -> String {
    format!("{figure}-{}-{:.0}", side_name(view.side), view.psi.to_degrees())
}

/// The names of the files, and the contents of the figure; returns the height at which plots begin.
pub(super) fn heading(svg: &mut Svg<'_>, shown: &[Shown<'_>], what: &str) -> f64 {
    let names: Vec<&str> = shown.iter().map(|shown| shown.subject.name()).collect();
    named_heading(svg, &names.join(", "), what)
}

/// Like [`heading`], with the name of what is shown.
pub(super) fn named_heading(svg: &mut Svg<'_>, name: &str, what: &str) -> f64 {
    let room = svg.layout().width - 2.0 * MARGIN;
    // A letter of the heading is about half as wide as it is high.
    svg.text([MARGIN, 32.0], Text { size: 20.0, is_heavy: true, ..LABEL }, &shortened(name, (room / 11.6) as usize));
    let style = Text { size: 16.0, role: Role::Muted, ..LABEL };
    let lines = wrapped(what, (room / 8.0) as usize);
    for (at, line) in lines.iter().enumerate() {
        svg.text([MARGIN, 56.0 + 20.0 * at as f64], style, line);
    }
    56.0 + 20.0 * lines.len() as f64
}

/// Muted lines, downward from `y`; returns the height below them.
pub(super) fn notes(svg: &mut Svg<'_>, y: f64, lines: &[String]) -> f64 {
    let letters = ((svg.layout().width - 2.0 * MARGIN) / 7.4) as usize;
    let mut y = y;
    for line in lines.iter().flat_map(|line| wrapped(line, letters)) {
        svg.text([MARGIN, y], Text { size: 15.0, role: Role::Muted, ..LABEL }, &line);
        y += 22.0;
    }
    y
}

/// A name of at most this many letters; a longer one loses its middle.
pub(super) fn shortened(name: &str, fits: usize) -> String {
    let count = name.chars().count();
    if count <= fits {
        return name.into();
    }
    let part = |from: usize, to: usize| name.chars().skip(from).take(to - from).collect::<String>();
    format!("{}…{}", part(0, fits / 2), part(count - (fits - fits / 2 - 1), count))
}

/// Lines of at most this many letters, unless a word is longer.
fn wrapped(text: &str, letters: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= letters => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.into()),
        }
    }
    lines
}

/// A description of the contents: the position of the light and the quantity.
pub(super) fn conditions(shown: &[Shown<'_>]) -> String {
    let Some(Shown { subject, view }) = shown.first() else { return String::new() };
    let mut words = vec![format!("ψ\u{a0}=\u{a0}{}", degrees(view.psi))];
    if subject.sides().len() > 1 {
        words.push(format!("light from the {}", side_name(view.side)));
    }
    let mut quantities: Vec<&str> = shown.iter().map(|shown| shown.view.quantity.name.as_str()).collect();
    quantities.dedup();
    quantities.retain(|name| !name.is_empty());
    words.extend(quantities.into_iter().map(String::from));
    words.join(", ")
}

/// The name of a side.
pub(crate) fn side_name(side: Side) -> &'static str {
    match side {
        Side::Front => "front",
        Side::Back => "back",
    }
}

pub(super) fn scatter_name(scatter: Scatter) -> &'static str {
    match scatter {
        Scatter::Reflection => "reflection",
        Scatter::Transmission => "transmission",
    }
}

/// Text centred on its position.
pub(super) const MIDDLE: Text = Text { anchor: Anchor::Middle, ..LABEL };

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_names_lose_their_middle() {
        assert_eq!(shortened("short.ddr", 9), "short.ddr");
        assert_eq!(shortened("a-long-name.ddr", 9), "a-lo….ddr");
        assert_eq!(shortened("a-long-name.ddr", 9).chars().count(), 9);
    }

    #[test]
    fn lines_are_filled() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("unbreakable word", 4), ["unbreakable", "word"]);
    }
}
