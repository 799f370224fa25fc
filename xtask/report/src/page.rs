//! The page, self-contained and without scripts.

use std::fmt::Write;

use lobe_benches::contest::Question;
use lobe_benches::workload::Input;
use xtask_common::svg::escape;
use xtask_common::{Grid, Machine, nanoseconds, times};
use xtask_tables::paper::PaperTable;
use xtask_tables::rows::{self, Row};
use xtask_tables::sections;

use super::bars::bars;
use super::curve::{Terms, curve};
use super::equivalence::EquivalenceSummary;
use super::{Report, style};

/// The whole document.
pub fn html(report: &Report) -> String {
    let Report { machine, rows, .. } = report;
    let mut body = String::new();
    body += &heading(report);
    body += &cards(rows);
    body += READING;
    body.extend(report.equivalence.as_ref().map(equivalence));
    for section in sections::all(rows) {
        body += &match section.paper {
            Some(paper) => format!("<h2>Table {}: {}</h2>{}", paper.number, escape(section.title), printed(&paper)),
            None => format!("<h2>{}</h2>", escape(section.title)),
        };
        for question in &section.questions {
            body += &answer(rows, question, section.paper.as_ref());
        }
    }
    body.extend(report.grids().iter().map(Grid::html));
    body += &figure_2();
    body += &about(machine);
    format!(
        r#"<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1"><title>lobe: measured speed</title><style>{}</style></head><body><main>{body}</main></body></html>
"#,
        style::CSS
    )
}

fn heading(report: &Report) -> String {
    let Machine { cpu, date, .. } = &report.machine;
    let mut text = format!(
        r#"<h1>Measured materials in SIMD lanes, measured</h1><p class="soft">{}, one thread, {}</p>"#,
        escape(cpu),
        escape(date)
    );
    if report.quick {
        text += r#"<p class="note">A quick run: few rounds, ratios accurate to about 10&nbsp;%.</p>"#;
    }
    if let Some(load) = report.machine.load.filter(|load| *load > 1.0) {
        write!(text, r#"<p class="note">The machine was busy when the run began (load {load:.1}): times are too long and ratios uncertain.</p>"#)
            .expect("a string");
    }
    text
}

/// The figures to remember: the fastest backend on incoherent input.
fn cards(all: &[Row]) -> String {
    let mut cards = String::new();
    for (id, what) in [("iso", "isotropic table"), ("aniso", "anisotropic table")] {
        for (baseline, code) in [("libm", "today's scalar code"), ("x87", "the paper's kind of scalar code")] {
            let candidates = all.iter().filter(|r| r.id == id && r.input == "incoherent" && r.baseline == baseline);
            if let Some(best) = candidates.max_by(|a, b| a.ratio.total_cmp(&b.ratio)) {
                let backend = rows::shown(&best.backend);
                let ratio = times(best.ratio);
                write!(
                    cards,
                    r#"<div class="card"><b>{ratio}</b><span>the speed of {code}: {what}, {backend}, incoherent input</span></div>"#
                )
                .expect("a string");
            }
        }
    }
    format!(r#"<div class="cards">{cards}</div>"#)
}

const READING: &str = r#"<p>Every figure is a ratio of one run: <b>12×</b> means twelve times the speed of the baseline, one twelfth of its
time for the same values. Baselines are scalar code for one query at a time. <b>libm</b> is code as one writes it today: the standard
library's arc cosine and binary search. <b>x87</b> is the code with which the paper compared in 2005: the arc cosine of the x87 unit and a
search that branches. All contenders take turns, the shortest time of each counts, and all values were compared with a
double-precision reference first. <b>Incoherent</b> input consists of unrelated directions; <b>coherent</b> input comes from the pixels of a picture of a
sphere, with neighbours next to each other.</p>"#;

fn equivalence(summary: &EquivalenceSummary) -> String {
    let verdict = if summary.ok {
        r#"<p class="good">All checks passed.</p>"#
    } else {
        r#"<p class="bad">Some checks failed.</p>"#
    };
    let lines: String = summary
        .rows
        .iter()
        .map(|[what, found]| format!("<tr><td>{}</td><td class=\"words\">{}</td></tr>", escape(what), escape(found)))
        .collect();
    format!(
        r#"<h2>Equivalence of the backends</h2>{verdict}<div class="wide"><table><tbody>{lines}</tbody></table></div>"#
    )
}

/// The paper's table as it was printed.
fn printed(paper: &PaperTable) -> String {
    let row = |name: &str, cells: [String; 3]| {
        let cells: String = cells.iter().map(|cell| format!("<td>{cell}</td>")).collect();
        format!("<tr><td>{name}</td>{cells}</tr>")
    };
    let head: String = paper.counts.iter().map(|count| format!("<th>{count}</th>")).collect();
    let seconds = |times: [&str; 3]| times.map(|time| format!("{time} s"));
    format!(
        r#"<p class="caption">As printed in 2005 (Pentium M, 1.8 GHz): {}</p><div class="wide"><table><thead><tr><th></th>{head}</tr></thead><tbody>{}{}{}</tbody></table></div>"#,
        escape(paper.counted),
        row("without SSE", seconds(paper.scalar)),
        row("with SSE", seconds(paper.sse)),
        row("times the speed", paper.speed_up.map(|ratio| format!("{ratio}×"))),
    )
}

/// One question: the outcome in a sentence, the bars, and all figures.
fn answer(all: &[Row], question: &Question, paper: Option<&PaperTable>) -> String {
    let of_question = || all.iter().filter(|row| row.id == question.id);
    let baselines = rows::distinct(of_question(), |row| &row.baseline);
    let least = paper.map_or(1.0, PaperTable::ratio);
    let most = of_question().fold(least, |most, row| most.max(row.ratio));
    let mut text = format!("<h3>{}</h3>", escape(question.title));
    if let Some(fastest) = of_question().min_by(|a, b| a.ns.total_cmp(&b.ns)) {
        let speeds: Vec<_> = baselines
            .iter()
            .filter_map(|baseline| rows::find(all, question.id, &fastest.input, &fastest.backend, baseline))
            .map(|row| format!("<b>{}</b> the speed of {}", times(row.ratio), row.baseline))
            .collect();
        let (ns, backend, input) = (nanoseconds(fastest.ns), rows::shown(&fastest.backend), &fastest.input);
        write!(text, "<p>{ns} ns per {} at best ({backend}, {input} input): {}.</p>", question.unit, speeds.join(", "))
            .expect("a string");
    }
    text += "<p class=\"soft\">Times the speed of";
    for (series, baseline) in baselines.iter().enumerate() {
        write!(text, r#"<span class="key key{series}"></span>{baseline}"#).expect("a string");
    }
    if let Some(paper) = paper {
        write!(text, r#"<span class="keymark"></span>the paper's SSE over its scalar code, {}"#, times(paper.ratio()))
            .expect("a string");
    }
    text += "</p><div class=\"pair\">";
    for input in Input::ALL {
        let picture = bars(all, question.id, input.name(), most, paper.map(PaperTable::ratio));
        write!(text, "<div>{picture}</div>").expect("a string");
    }
    text += "</div>";
    text + &figures(all, question, &baselines, paper)
}

/// All times and ratios of a question, with the paper's on top.
fn figures(all: &[Row], question: &Question, baselines: &[&str], paper: Option<&PaperTable>) -> String {
    let find =
        |input: Input, backend: &str, baseline: &str| rows::find(all, question.id, input.name(), backend, baseline);
    let backends = rows::distinct(all.iter().filter(|row| row.id == question.id), |row| &row.backend);
    let mut head = ["<tr><th></th>".to_owned(), "<tr><th></th>".to_owned()];
    for input in Input::ALL {
        head[0] += &format!(r#"<th class="split" colspan="{}">{}</th>"#, 1 + baselines.len(), input.name());
        head[1] += r#"<th class="split">ns</th>"#;
        head[1].extend(baselines.iter().map(|baseline| format!("<th>× {baseline}</th>")));
    }
    let mut lines = String::new();
    if let Some(paper) = paper {
        let [scalar, sse] = paper.nanoseconds().map(nanoseconds);
        let blank = "<td></td>".repeat(baselines.len().saturating_sub(1));
        let rest = format!(r#"<td class="split" colspan="{}">input not stated</td>"#, 1 + baselines.len());
        let ratio = times(paper.ratio());
        write!(
            lines,
            r#"<tr class="then"><td>2005 scalar</td><td class="split">{scalar}</td><td></td>{blank}{rest}</tr>"#
        )
        .expect("a string");
        write!(
            lines,
            r#"<tr class="then"><td>2005 SSE</td><td class="split">{sse}</td>{blank}<td>{ratio}</td>{rest}</tr>"#
        )
        .expect("a string");
    }
    for baseline in baselines {
        write!(lines, r#"<tr class="base"><td>{baseline}</td>"#).expect("a string");
        for input in Input::ALL {
            let row = backends.first().and_then(|backend| find(input, backend, baseline));
            let ns = row.map(|row| nanoseconds(row.baseline_ns)).unwrap_or_default();
            write!(lines, r#"<td class="split">{ns}</td>{}"#, "<td></td>".repeat(baselines.len())).expect("a string");
        }
        lines += "</tr>";
    }
    for backend in backends {
        write!(lines, "<tr><td>{}</td>", rows::shown(backend)).expect("a string");
        for input in Input::ALL {
            let ns = baselines.first().and_then(|baseline| find(input, backend, baseline));
            let ns = ns.map(|row| nanoseconds(row.ns)).unwrap_or_default();
            write!(lines, r#"<td class="split">{ns}</td>"#).expect("a string");
            for baseline in baselines {
                let ratio = find(input, backend, baseline).map(|row| times(row.ratio)).unwrap_or_default();
                write!(lines, "<td><b>{ratio}</b></td>").expect("a string");
            }
        }
        lines += "</tr>";
    }
    let [inputs, columns] = head;
    format!(
        r#"<p class="caption">Nanoseconds per {}, and times the speed of each baseline</p><div class="wide"><table><thead>{inputs}</tr>{columns}</tr></thead><tbody>{lines}</tbody></table></div>"#,
        question.unit
    )
}

fn figure_2() -> String {
    format!(
        r#"<h2>Fig. 2: error of the arc cosine</h2><p>The polynomial minus the true arc cosine over [−1, 1], in radians, each picture at its own
scale. The paper prints the first curve; the library computes the second.</p><div class="pair"><div>{}</div><div>{}</div></div>"#,
        curve("four terms (paper)", Terms::Four),
        curve("eight terms (library)", Terms::Eight)
    )
}

fn about(machine: &Machine) -> String {
    let cores = format!("{} logical", machine.cores);
    let load = machine.load.map_or_else(|| "unknown".into(), |load| format!("{load:.2} when the run began"));
    let lines = [
        ("Processor", machine.cpu.as_str()),
        ("Cores", &cores),
        ("Extensions", &machine.features.join(", ")),
        ("Load", &load),
        ("Compiler", &machine.compiler),
        ("Commit", &machine.commit),
        ("Date", &machine.date),
    ];
    let lines: String =
        lines.iter().map(|(name, value)| format!("<dt>{name}</dt><dd>{}</dd>", escape(value))).collect();
    format!("<h2>Machine</h2><dl>{lines}</dl><p class=\"soft\">Reproduce with <code>cargo xtask report</code>.</p>")
}
