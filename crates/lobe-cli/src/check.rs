//! `lobe check`: checks whether a measurement is sound, and reports what it covers.

use std::io::Write;
use std::path::{Path, PathBuf};

use lobe::Options;
use lobe_ops::check::{Finding, Status, Thoroughness, check, worst};
use serde::Serialize;

use crate::angles::{progress, table};
use crate::failure::Failure;
use crate::measure::integrates;
use crate::message;
use crate::reading::Reading;

/// Check measurements: values, knots, poles, seams, coverage, energy, stated totals, units, reciprocity.
#[derive(clap::Args)]
#[command(after_help = "pass: in order. note: worth knowing. warn: probably a mistake. FAIL: impossible.

Examples:
  lobe check paint.ddr
  lobe check --strict scans/*.bsdf
  lobe check --json paint.ddr | jq '.[0].findings[] | select(.status == \"fail\") | .text'

With --strict, the exit code is also 3 if a check warned.")]
pub struct Args {
    /// The files to check.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    /// Count warnings as failures.
    #[arg(long)]
    strict: bool,
    /// Print JSON: an array with one object per file.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    file: String,
    format: Option<&'static str>,
    kind: Option<&'static str>,
    channels: Vec<String>,
    /// The reason why nothing could be checked.
    unreadable: Option<String>,
    /// The worst of the findings.
    status: Option<Status>,
    findings: Vec<Finding>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let mut reports = Vec::new();
    let mut out = message::out(args.json);
    for file in &args.files {
        let report = report(file, &args.reading)?;
        if !args.json {
            report.print(&mut out)?;
        }
        reports.push(report);
    }
    if args.json {
        serde_json::to_writer_pretty(&mut out, &reports)?;
        writeln!(out)?;
    }
    out.flush()?;
    let unreadable = reports.iter().filter(|report| report.unreadable.is_some()).count();
    let limit = if args.strict { Status::Warn } else { Status::Fail };
    let failed = reports.iter().filter(|report| report.status.is_some_and(|status| status >= limit)).count();
    match (unreadable, failed) {
        (0, 0) => Ok(()),
        (0, failed) => Err(Failure::Check(format!("{failed} of {} files did not pass", reports.len()))),
        (unreadable, _) => Err(Failure::File(format!("{unreadable} of {} files could not be checked", reports.len()))),
    }
}

/// Checks one file. A file that cannot be read is reported and not fatal; an invalid backend is fatal.
fn report(file: &Path, reading: &Reading) -> Result<Report, Failure> {
    let name = file.display().to_string();
    let subject = match reading.subject(file, &Options::default()) {
        Ok(subject) => subject,
        Err(Failure::File(why)) => {
            let (channels, findings) = (Vec::new(), Vec::new());
            return Ok(Report {
                file: name,
                format: None,
                kind: None,
                channels,
                unreadable: Some(why),
                status: None,
                findings,
            });
        }
        Err(other) => return Err(other),
    };
    integrates(file, subject.material.channel_count())?;
    let bar = progress("checking");
    let findings = check(&subject, &Thoroughness::default(), &bar);
    Ok(Report {
        file: name,
        format: Some(subject.format.name()),
        kind: Some(subject.material.kind().name()),
        channels: subject.material.channels().names(),
        unreadable: None,
        status: Some(worst(&findings)),
        findings,
    })
}

impl Report {
    fn print(&self, out: &mut impl Write) -> std::io::Result<()> {
        if let Some(why) = &self.unreadable {
            return writeln!(out, "{why}\n");
        }
        let (format, kind) = (self.format.unwrap_or_default(), self.kind.unwrap_or_default());
        let channels = match self.channels.len() {
            1 => "1 channel".into(),
            n => format!("{n} channels"),
        };
        writeln!(out, "{}: {format}, {kind}, {channels}", self.file)?;
        let has_parts = self.findings.iter().any(|finding| !finding.part.is_empty());
        let header = ["", "check", "part", "finding"].into_iter().filter(|name| has_parts || *name != "part");
        let row = |finding: &Finding| {
            let mut cells = vec![finding.status.to_string(), finding.check.into()];
            if has_parts {
                cells.push(finding.part.clone());
            }
            cells.push(finding.text.clone());
            cells
        };
        let rows = self.findings.iter().map(row).collect();
        let table = table(header.map(String::from).collect(), rows, 4);
        writeln!(out, "{}\n", table.trim_fmt())
    }
}
