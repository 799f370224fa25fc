//! Draws ratios as bars: how many times the speed of each baseline, backend by backend.

use xtask_common::svg::{Anchor, Svg, step};
use xtask_common::times;
use xtask_tables::rows::{self, Row};

const WIDTH: f64 = 360.0;
const LEFT: f64 = 78.0;
/// Room to the right of the longest bar for its figure.
const RIGHT: f64 = 52.0;
const TOP: f64 = 26.0;
const BAR: f64 = 12.0;
const GAP: f64 = 10.0;
const AXIS: f64 = 24.0;

/// Bars of one question on one input. `most` is the ratio at the full width, so that pictures side by side share their
/// scale; it is at least 1. `paper` is the paper's own speed-up, at most `most`, drawn as a mark.
pub fn bars(all: &[Row], id: &str, input: &str, most: f64, paper: Option<f64>) -> String {
    let backends = rows::distinct(rows::of(all, id, input), |row| &row.backend);
    let baselines = rows::distinct(rows::of(all, id, input), |row| &row.baseline);
    let group = BAR * baselines.len() as f64 + GAP;
    let bottom = TOP + group * backends.len() as f64;
    let title = format!("{id}, {input} input: times as fast as {}", baselines.join(" and "));
    let mut svg = Svg::new(WIDTH, bottom + AXIS, &title);
    let x = |ratio: f64| LEFT + ratio / most * (WIDTH - LEFT - RIGHT);

    svg.text("name", [0.0, 14.0], Anchor::Start, &format!("{input} input"));
    let step = step(most);
    let mut tick = 0.0;
    while tick <= most * 1.001 {
        svg.line("grid", [x(tick), TOP], [x(tick), bottom]);
        svg.text("tick", [x(tick), bottom + 14.0], Anchor::Middle, &format!("{tick}×"));
        tick += step;
    }
    let mut figures = Vec::new();
    for (at, backend) in backends.iter().enumerate() {
        let top = TOP + group * at as f64 + GAP / 2.0;
        let middle = top + BAR * baselines.len() as f64 / 2.0 + 4.0;
        svg.text("label", [LEFT - 6.0, middle], Anchor::End, &rows::shown(backend));
        for (series, baseline) in baselines.iter().enumerate() {
            if let Some(row) = rows::find(all, id, input, backend, baseline) {
                let y = top + BAR * series as f64;
                svg.rect(&format!("series{series}"), [LEFT, y], [(x(row.ratio) - LEFT).max(1.0), BAR - 1.0]);
                figures.push(([x(row.ratio) + 4.0, y + BAR - 2.5], times(row.ratio)));
            }
        }
    }
    // Above the bars, so that one can see whether a bar ends before or after a line, and below the figures.
    svg.line("base", [x(1.0), TOP], [x(1.0), bottom]);
    if let Some(ratio) = paper {
        svg.line("paper", [x(ratio), TOP - 4.0], [x(ratio), bottom]);
        let (shift, anchor) = if ratio < most / 2.0 { (4.0, Anchor::Start) } else { (-4.0, Anchor::End) };
        svg.text("papertext", [x(ratio) + shift, TOP - 2.0], anchor, &format!("paper {}", times(ratio)));
    }
    for (at, figure) in figures {
        svg.text("value", at, Anchor::Start, &figure);
    }
    svg.finish()
}
