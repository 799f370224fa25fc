//! `lobe import`: a user's own measurement, from the output of an instrument or a spreadsheet to a file that every
//! program reads.

use std::io::{IsTerminal, Write, stderr, stdin};
use std::path::{Path, PathBuf};

use lobe::{Material, Options};
use lobe_files::check_output;
use lobe_formats::reading::OF_ALL_FORMATS;
use lobe_formats::{Document, Format, FormatError, Place, ReadOptions, open_with, sidecar, write_whole};
use lobe_ops::Subject;
use lobe_ops::check::{Finding, Status, Thoroughness, check};
use lobe_ops::describe::{Part, describe};
use serde::Serialize;

use crate::angles::progress;
use crate::failure::Failure;
use crate::measure::integrates;
use crate::message::{self, say};
use crate::reading::Reading;
use crate::target::parser;
use crate::{convert, plot};

/// Import your own measurement: see how a file is understood, add missing information, and write it for other programs.
#[derive(clap::Args)]
#[command(
    after_help = "The options are kept in FILE.lobe.toml next to the file, and from then on every command and the library use them. On a terminal, the command asks about whatever it does not understand.

Examples:
  lobe import scan.csv                       how it is understood
  lobe import scan.txt --columns theta_i=30deg,theta_o=1,f=2
  lobe import scan-rad.csv --unit rad --values luminance-factor --plot scan.html
  lobe import scan.csv -o scan.bsdf --to rgl   for Mitsuba and pbrt
  lobe import lens.bsdf --scale tis            values relative to a total

Exit codes: 0 done, 1 not understood or not written, 2 wrong usage, 3 read and written, but a check failed."
)]
pub struct Args {
    /// The file: a table as CSV, text or JSON, or a file of any format that lobe reads.
    file: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// Write the material to this file for other programs, as lobe convert does.
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// The format to write, if the extension does not determine it.
    #[arg(long, value_name = "FORMAT", value_parser = parser(), requires = "out")]
    to: Option<Format>,
    /// Draw the material: .html is a page, .svg and .png are curves in the plane of incidence.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Do not write FILE.lobe.toml.
    #[arg(long)]
    no_sidecar: bool,
    /// Print JSON, and ask no questions.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    file: String,
    format: &'static str,
    /// How the file was understood.
    notes: Vec<String>,
    /// Possible misunderstandings.
    doubts: Vec<String>,
    parts: Vec<Part>,
    source: Vec<(String, String)>,
    findings: Vec<Finding>,
    /// The sidecar that says how the file is read, if there is one.
    sidecar: Option<String>,
    /// The content of the sidecar.
    options: Option<String>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let file = args.file.as_path();
    let sidecar = sidecar::path_of(file);
    let mut others = vec![file, &sidecar];
    for output in args.out.iter().chain(&args.plot) {
        check_output(output, &others)?;
        others.push(output);
    }
    let given = args.reading.options();
    let mut options = given.clone().or(sidecar::find(file)?);
    let may_ask = !args.json && stdin().is_terminal() && stderr().is_terminal();
    let (format, document) = loop {
        match open_with(file, &options) {
            Ok(found) => {
                if !may_ask {
                    break found;
                }
                let mut shown = Vec::new();
                show(&mut shown, &found.1)?;
                say(String::from_utf8_lossy(&shown).trim_end());
                match ask("Right? Press Enter, or type a correction such as `values luminance-factor`: ", &mut options)?
                {
                    true => {}
                    false => break found,
                }
            }
            Err(error) if may_ask => {
                say(&error);
                first_lines(file);
                if !ask(
                    "Press Enter to give up, or type an option such as `columns theta_i=1,theta_o=2,f=3` or `unit rad`: ",
                    &mut options,
                )? {
                    return Err(error.into());
                }
            }
            Err(error) if error.expected == OF_ALL_FORMATS => return Err(args.reading.failure(error)),
            Err(error) => return Err(explained(error, file)),
        }
    };
    let material = Material::from_document(&document, &Options::default()).map_err(|error| error.in_file(file))?;
    let subject = Subject::new(format, document, material, &Options::default());
    integrates(file, subject.material.channel_count())?;
    let bar = progress("checking");
    let findings = check(&subject, &Thoroughness::default(), &bar);
    drop(bar);
    let has_failed = findings.iter().any(|finding| finding.status == Status::Fail);
    let kept = keep(args, &given, &options)?;
    let document = &subject.document;
    let report = Report {
        file: file.display().to_string(),
        format: format.name(),
        notes: document.notes.clone(),
        doubts: document.doubts.clone(),
        parts: describe(document),
        source: document.source.clone(),
        findings,
        sidecar: kept.then(|| sidecar::path_of(file).display().to_string()),
        options: kept.then(|| sidecar::to_text(&options, &name(file))),
    };
    // The files are written even if nobody reads what is printed.
    let printed = report.print_all(args.json, document);
    if let Some(page) = &args.plot {
        plot::write(file, format, document, page)?;
        say(format_args!("{}: written", page.display()));
    }
    if let Some(out) = &args.out {
        convert::write(file, document.clone(), out, args.to)?;
    }
    printed?;
    match has_failed {
        true => Err(Failure::Check(format!("{}: a check failed: see FAIL above", file.display()))),
        false => Ok(()),
    }
}

/// Writes the sidecar if there is something new; returns whether there is one.
fn keep(args: &Args, given: &ReadOptions, options: &ReadOptions) -> Result<bool, Failure> {
    let path = sidecar::path_of(&args.file);
    let before = sidecar::find(&args.file)?;
    if options.is_empty() || *options == before {
        return Ok(!before.is_empty());
    }
    if args.no_sidecar {
        return Ok(false);
    }
    write_whole(&path, sidecar::to_text(options, &name(&args.file)).as_bytes())?;
    let how = if given.is_empty() { "what was said" } else { "these options" };
    say(format_args!("{}: {how}, which every command and the library read from there", path.display()));
    Ok(true)
}

fn name(file: &Path) -> String {
    file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

impl Report {
    fn print_all(&self, is_json: bool, document: &Document) -> Result<(), Failure> {
        let mut out = message::out(is_json);
        if is_json {
            serde_json::to_writer_pretty(&mut out, self)?;
            writeln!(out)?;
        } else {
            self.print(&mut out, document)?;
        }
        Ok(out.flush()?)
    }

    fn print(&self, out: &mut impl Write, document: &Document) -> Result<(), Failure> {
        writeln!(out, "{}: {}", self.file, self.format)?;
        show(out, document)?;
        for finding in self.findings.iter().filter(|finding| finding.status >= Status::Warn) {
            let part = if finding.part.is_empty() { String::new() } else { format!("{}: ", finding.part) };
            writeln!(out, "  {}: {}: {part}{}", finding.status, finding.check, finding.text)?;
        }
        let passed = self.findings.iter().filter(|finding| finding.status < Status::Warn).count();
        writeln!(out, "  {passed} of {} checks passed; lobe check shows them all", self.findings.len())?;
        Ok(())
    }
}

/// Prints how the file was understood, and the resulting material.
fn show(out: &mut impl Write, document: &Document) -> Result<(), Failure> {
    for note in &document.notes {
        writeln!(out, "  {note}")?;
    }
    for doubt in &document.doubts {
        writeln!(out, "  doubtful: {doubt}")?;
    }
    for part in describe(document) {
        for (name, value) in part.rows() {
            let value: String = value.chars().take(160).collect();
            writeln!(out, "  {name:<9} {value}")?;
        }
    }
    Ok(())
}

/// The number of lines of the text that an error shows.
const SHOWN: usize = 6;

fn first_lines(file: &Path) {
    if let Some(lines) = head(file) {
        say(lines.trim_end());
    }
}

/// The first lines of a text, with their numbers.
fn head(file: &Path) -> Option<String> {
    // Not of a device or a pipe, which would never end.
    let bytes = lobe_files::read(file).ok()?;
    let bytes = lobe_formats::plain_text(&bytes);
    let text = lobe_formats::decoded(&bytes[..bytes.len().min(1 << 16)]);
    let is_text = !text.contains('\0');
    let shown = |line: &str| {
        let mut shown = String::new();
        for c in line.chars().take(120) {
            match c.is_control() && c != '\t' {
                true => shown.extend(c.escape_default()),
                false => shown.push(c),
            }
        }
        shown
    };
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()).take(SHOWN);
    let lines: String = lines.map(|(index, line)| format!("{:>6} | {}\n", index + 1, shown(line))).collect();
    is_text.then_some(lines)
}

/// An error with the first lines of the file.
fn explained(error: FormatError, file: &Path) -> Failure {
    let is_about_a_line = matches!(error.place, Place::Line(_) | Place::File);
    match head(file).filter(|_| is_about_a_line && error.file == file) {
        Some(lines) => Failure::File(format!("{error}\n{}", lines.trim_end())),
        None => error.into(),
    }
}

/// Asks for an option until the answer can be understood, and sets it; `false` if the answer is empty.
fn ask(question: &str, options: &mut ReadOptions) -> Result<bool, Failure> {
    loop {
        write!(stderr(), "{question}")?;
        stderr().flush()?;
        let mut answer = String::new();
        let count = stdin().read_line(&mut answer)?;
        let answer = answer.trim().trim_start_matches('-');
        if count == 0 || answer.is_empty() {
            return Ok(false);
        }
        let (key, word) = answer.split_once([' ', '=']).unwrap_or((answer, ""));
        match sidecar::set(options, key.trim(), word.trim().trim_matches('"')) {
            Ok(()) => return Ok(true),
            Err(message) => say(message),
        }
    }
}
