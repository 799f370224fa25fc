//! Reports the outcome of all checks, as a table for the reader and as JSON for programs.

use std::io::Write;
use std::path::Path;

use anyhow::{Context, ensure};
use comfy_table::{CellAlignment, Table, presets};
use indicatif::HumanCount;
use serde::Serialize;

use super::{Check, Form, Property, Subject, compare, facade_agrees, reference};

/// A line for each backend and form, and `true` if all checks passed.
#[derive(Serialize)]
pub(super) struct Summary {
    rows: Vec<[String; 2]>,
    ok: bool,
}

/// Writes JSON next to its target and renames it.
pub(super) fn write(path: &Path, content: &impl Serialize) -> anyhow::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let failed = || format!("{}: cannot be written", path.display());
    let mut file = tempfile::NamedTempFile::new_in(folder).with_context(failed)?;
    serde_json::to_writer_pretty(&mut file, content).with_context(failed)?;
    file.write_all(b"\n").with_context(failed)?;
    file.persist(path).with_context(failed)?;
    Ok(())
}

/// The results of all backends.
#[derive(Serialize)]
pub(super) struct Outcome {
    backends: Vec<BackendRow>,
    checks: Vec<Check>,
    ok: bool,
    #[serde(skip)]
    rows: Vec<Row>,
    /// Descriptions of failures.
    #[serde(skip)]
    faults: Vec<String>,
}

#[derive(Serialize)]
struct BackendRow {
    name: &'static str,
    lanes: Option<usize>,
    available: bool,
}

/// A line of the printed table: one property on one backend.
struct Row {
    backend: &'static str,
    form: Form,
    property: Property,
    checks: usize,
    items: usize,
    differing: usize,
    /// The check nearest to its bound, in fused form, except at steps, where the bound is meaningless.
    nearest: Option<Check>,
    ok: bool,
}

impl Outcome {
    /// The report of the backends with these names, or of all if there are none.
    pub(super) fn measure(names: &[String]) -> Self {
        let mut outcome =
            Outcome { backends: Vec::new(), checks: Vec::new(), ok: true, rows: Vec::new(), faults: Vec::new() };
        let wanted = |name: &str| names.is_empty() || names.iter().any(|wanted| wanted == name);
        let subjects: Vec<Subject> = Subject::all().into_iter().filter(|subject| wanted(subject.name())).collect();
        let mut ran = vec![false; subjects.len()];
        for property in Property::ALL {
            let expected = reference(property);
            // Definitions are also checked on the reference.
            outcome.add("scalar", Form::Strict, property, compare(&expected, &expected, "scalar", Form::Strict));
            for (subject, ran) in subjects.iter().copied().zip(&mut ran) {
                for &form in subject.forms() {
                    let Some(found) = subject.record(form, property) else { continue };
                    *ran = true;
                    outcome.add(subject.name(), form, property, compare(&found, &expected, subject.name(), form));
                }
            }
        }
        // The reference runs on every machine.
        outcome.backends.push(BackendRow { name: "scalar", lanes: Some(1), available: true });
        for (subject, ran) in subjects.into_iter().zip(ran) {
            outcome.backends.push(BackendRow { name: subject.name(), lanes: subject.lanes(), available: ran });
            if ran != subject.expected() {
                let did = if ran { "ran although" } else { "did not run although" };
                let has = if subject.expected() { "has" } else { "does not have" };
                outcome.faults.push(format!("{} {did} this CPU {has} its features", subject.name()));
            }
        }
        let ran = |name: &String| outcome.backends.iter().any(|row| row.name == *name && row.available);
        let missing: Vec<String> =
            names.iter().filter(|name| !ran(name)).map(|name| format!("{name} did not run")).collect();
        outcome.faults.extend(missing);
        if let Err(error) = facade_agrees() {
            outcome.faults.push(error.to_string());
        }
        outcome.ok = outcome.faults.is_empty();
        outcome
    }

    /// A line for each backend and form: its name and its outcome.
    pub(super) fn summary(&self) -> Summary {
        let mut lines: Vec<(&str, Form, usize, usize, bool)> = Vec::new();
        for row in &self.rows {
            match lines.iter_mut().find(|line| (line.0, line.1) == (row.backend, row.form)) {
                Some(line) => *line = (line.0, line.1, line.2 + row.items, line.3 + row.differing, line.4 && row.ok),
                None => lines.push((row.backend, row.form, row.items, row.differing, row.ok)),
            }
        }
        let words = |(backend, form, items, differing, ok): (&str, Form, usize, usize, bool)| {
            let [items, differing] = [items, differing].map(|count| HumanCount(count as u64));
            let verdict = match (form, ok) {
                (_, false) => "FAILED".to_string(),
                (Form::Strict, _) => format!("{items} results, all with the same bits"),
                (Form::Fused, _) => format!("{items} results, {differing} differ, all within their bounds"),
            };
            [format!("{backend}, {}", format!("{form:?}").to_lowercase()), verdict]
        };
        Summary { rows: lines.into_iter().map(words).collect(), ok: self.ok }
    }

    fn add(&mut self, backend: &'static str, form: Form, property: Property, checks: Vec<Check>) {
        for check in checks.iter().filter(|check| !check.ok) {
            let fault = check.first_fault.as_deref().unwrap_or_default();
            self.faults.push(format!("{backend} {form:?}, {}, {}: {fault}", property.name(), check.what));
        }
        self.rows.push(Row {
            backend,
            form,
            property,
            checks: checks.len(),
            items: checks.iter().map(|check| check.items).sum(),
            differing: checks.iter().map(|check| check.differing).sum(),
            nearest: checks
                .iter()
                .filter(|check| check.bound > 0.0 && !check.what.ends_with("at a step"))
                .max_by(|a, b| a.nearness().total_cmp(&b.nearness()))
                .cloned(),
            ok: checks.iter().all(|check| check.ok),
        });
        self.checks.extend(checks);
    }

    pub(super) fn print(&self) {
        let mut table = Table::new();
        table.load_style(presets::UTF8_HORIZONTAL_ONLY);
        table.set_header(["backend", "form", "property", "checks", "items", "differing", "nearest to its bound", ""]);
        for column in 3..6 {
            table.column_mut(column).expect("a column").set_cell_alignment(CellAlignment::Right);
        }
        for row in &self.rows {
            table.add_row([
                row.backend.to_string(),
                format!("{:?}", row.form).to_lowercase(),
                row.property.name().to_string(),
                row.checks.to_string(),
                row.items.to_string(),
                row.differing.to_string(),
                row.nearest.as_ref().map_or("-".into(), |check| {
                    format!("{:.2e} of {:.2e}, {}", check.max_abs, check.bound, check.what)
                }),
                if row.ok { "ok" } else { "FAILED" }.to_string(),
            ]);
        }
        println!("{table}");
        for row in &self.backends {
            match row.lanes {
                Some(lanes) if row.available => println!("{:>10}: {lanes} lanes, ran", row.name),
                _ => println!("{:>10}: not on this CPU", row.name),
            }
        }
        println!(
            "{} checks of {} results",
            self.checks.len(),
            self.checks.iter().map(|check| check.items).sum::<usize>()
        );
        for fault in &self.faults {
            println!("FAILED: {fault}");
        }
    }

    pub(super) fn verdict(&self) -> anyhow::Result<()> {
        ensure!(self.ok, "{} faults", self.faults.len());
        Ok(())
    }
}
