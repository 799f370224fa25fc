//! Converts a material from every format to every other one, and compares the error that is stated for each conversion
//! with the one that is found at more directions.

use std::path::{Path, PathBuf};

use anyhow::bail;
use lobe::{Lookup, Material, Options, Scatter};
use lobe_files::{Files, in_memory};
use lobe_formats::{ChannelMap, ConvertError, Document, Format, Writer, convert};
use lobe_model::goniometer::rgl::Resolution;
use lobe_model::goniometer::spherical::uniform_half;
use lobe_model::goniometer::tensor_tree::Refinement;
use lobe_model::is_isotropic;
use lobe_ops::Subject;
use lobe_ops::certificate::{Certificate, ROUNDED};
use lobe_ops::certify::{PAIRS, certify, worst};
use lobe_ops::remeasure::{Mapped, MaterialSurface, Nodes, Sides, remeasure, resampled_matrices};
use lobe_table::window::klems::{self, AngleBasis};
use lobe_table::window::tensor_tree::Rank;
use serde::Serialize;

use xtask_common::Grid;

/// The name by which it can be selected.
pub const ID: &str = "conversions";

/// Pairs of directions at which the error is stated, and at which it is found.
const PAIR_COUNTS: [usize; 2] = [PAIRS, 2 * PAIRS];
/// The error that is found may be larger than the stated one by this factor, as it is an estimate from finitely many
/// pairs.
const MARGIN: f64 = 1.2;

/// One conversion.
#[derive(Clone, Debug, Serialize)]
pub struct Conversion {
    /// The format of the source.
    pub from: String,
    /// The format of the written file.
    pub to: String,
    /// The root mean square of the difference relative to that of the values, as stated; `None` if the file keeps
    /// values and nodes of the source.
    pub stated: Option<f64>,
    /// The same, found at more pairs of directions; `None` if there is nothing to compare.
    pub found: Option<f64>,
    /// Why nothing was written, or compared.
    pub refused: Option<String>,
}

impl Conversion {
    fn is_as_stated(&self) -> bool {
        match (self.stated, self.found) {
            (Some(stated), Some(found)) => found <= MARGIN * stated + ROUNDED,
            (None, Some(found)) => found <= ROUNDED,
            _ => true,
        }
    }

    fn cell(&self) -> String {
        let percent = |share: f64| match share {
            _ if share >= 0.1 => format!("{:.0}", 100.0 * share),
            _ if share >= 0.01 => format!("{:.1}", 100.0 * share),
            _ => format!("{:.2}", 100.0 * share),
        };
        match (self.stated, self.found) {
            (_, None) => "-".into(),
            (None, Some(_)) if self.is_as_stated() => "kept".into(),
            (None, Some(found)) => format!("kept, BUT {found:.1e}"),
            (Some(stated), Some(found)) => {
                let wrong = if self.is_as_stated() { "" } else { " NOT AS STATED" };
                format!("{} / {}{wrong}", percent(stated), percent(found))
            }
        }
    }
}

/// A format that can hold a material, and the nodes of its files.
struct Holder {
    name: &'static str,
    format: Format,
    writer: &'static Writer,
    /// For a format with several kinds of nodes.
    nodes: Option<Nodes>,
}

impl Holder {
    fn path(&self) -> PathBuf {
        format!("material.{}", self.writer.extensions.first().unwrap_or(&"csv")).into()
    }

    /// Nodes that are coarser than those of `lobe convert`; `None` if the format cannot hold the material.
    fn nodes(&self, isotropic: bool) -> Option<Nodes> {
        if self.nodes.is_some() {
            return self.nodes.clone();
        }
        let every_other = |knots: Vec<f64>| knots.into_iter().step_by(2).collect::<Vec<f64>>();
        Some(match Nodes::of(self.writer.resampled_as.ok()?, isotropic)? {
            Nodes::HalfDiff(bins) => Nodes::HalfDiff(bins.map(|bins| bins / 2)),
            Nodes::Rgl(resolution) => Nodes::Rgl(Resolution { theta_i: 16, spectra: 32, ..resolution }),
            Nodes::Spherical { is_half: true, .. } => Nodes::Spherical { knots: uniform_half(45, 46), is_half: true },
            Nodes::Mueller(knots) => Nodes::Mueller(knots.map(every_other)),
            nodes => nodes,
        })
    }
}

/// All formats that are read and written and hold values for pairs of directions.
fn holders() -> Vec<Holder> {
    let mut holders = Vec::new();
    for format in Format::writable().filter(|format| format.spec().read.is_some()) {
        let Some(writer) = format.writer() else { continue };
        let holder = |name, nodes| Holder { name, format, writer, nodes };
        match writer.resampled_as {
            Ok(klems::KIND) => holders.extend([
                holder("Klems", Some(Nodes::Klems(AngleBasis::half()))),
                holder("tree", Some(Nodes::Tree(Refinement { rank: Rank::Three, depth: 5, error: 0.05 }))),
            ]),
            Ok(_) => holders.push(holder(format.spec().word, None)),
            Err(_) => {}
        }
    }
    holders
}

/// A file that was written, and the channel of the source that it holds; `None` if it has all of them.
struct File {
    subject: Subject,
    channel: Option<String>,
    is_kept: bool,
}

/// Measures the table of all pairs of formats.
///
/// # Errors
/// If the fixture cannot be read or written, or an error cannot be measured.
pub fn all(quick: bool) -> anyhow::Result<Vec<Conversion>> {
    let fixture = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/conductor-7x8x13.ddr"));
    let (format, document) = lobe_formats::open(fixture)?;
    let source = subject(format, document)?;
    let holders = holders();
    let mut conversions = Vec::new();
    for from in &holders {
        let Written::File(file) = written(&source, "", from)? else {
            bail!("{}: the fixture was refused", from.name);
        };
        for to in &holders {
            // A quick look converts to and from the format of the fixture only.
            if quick && ![from.format, to.format].contains(&format) {
                continue;
            }
            // A failure is shown in the table; it does not end the report.
            conversions.push(conversion(&file.subject, from, to).unwrap_or_else(|error| Conversion {
                from: from.name.to_owned(),
                to: to.name.to_owned(),
                stated: None,
                found: None,
                refused: Some(format!("FAILED, {error:#}")),
            }));
        }
    }
    Ok(conversions)
}

fn conversion(source: &Subject, from: &Holder, to: &Holder) -> anyhow::Result<Conversion> {
    let (from_name, to_name) = (from.name.to_owned(), to.name.to_owned());
    match written(source, from.name, to)? {
        Written::Refused(why) => {
            Ok(Conversion { from: from_name, to: to_name, stated: None, found: None, refused: Some(why) })
        }
        Written::File(file) => {
            let error = |pairs| {
                let certified = certify(source, &file.subject, file.channel.as_deref(), pairs).unwrap_or_default();
                (!certified.is_empty()).then(|| worst(&certified))
            };
            let stated = match file.is_kept {
                true => Certificate::between_nodes(source, &file.subject, file.channel.as_deref())
                    .and_then(|stated| stated.ok().map(|certificate| certificate.worst())),
                false => error(PAIR_COUNTS[0]),
            };
            let found = error(PAIR_COUNTS[1]);
            let refused = found.is_none().then(|| "written, but with no channel to compare".to_owned());
            Ok(Conversion { from: from_name, to: to_name, stated, found, refused })
        }
    }
}

enum Written {
    File(Box<File>),
    Refused(String),
}

/// Writes a material as `lobe convert` does, in memory, and reads it back. If the format does not hold the channels of
/// the source, one of them is written.
fn written(source: &Subject, from: &str, to: &Holder) -> anyhow::Result<Written> {
    let names = source.material.channels().names();
    let preferred = |name: &&String| !["G", "Y", "Visible"].contains(&name.as_str());
    let mut channels: Vec<Option<&str>> = vec![None];
    let mut ordered: Vec<&String> = names.iter().collect();
    ordered.sort_by_key(preferred);
    channels.extend(ordered.into_iter().map(|name| Some(name.as_str())));
    let mut refused = String::new();
    for channel in channels {
        let (result, mut files) = in_memory(Files::new(), || write(source, from, to, channel));
        let is_kept = match result {
            Ok(is_kept) => is_kept,
            Err(Refusal::Channels(why)) => {
                refused = why;
                continue;
            }
            Err(Refusal::Material(why)) => return Ok(Written::Refused(format!("refused, {why}"))),
            Err(Refusal::Failed(error)) => return Err(error),
        };
        // Only the file itself, as a user would pass it on.
        files.retain(|path, _| *path == to.path());
        let (subject, _) = in_memory(files, || Subject::open(&to.path(), &Options::default()));
        return Ok(Written::File(Box::new(File { subject: subject?, channel: channel.map(str::to_owned), is_kept })));
    }
    Ok(Written::Refused(format!("refused, {refused}")))
}

enum Refusal {
    /// The format does not hold the channels.
    Channels(String),
    /// The format does not hold the material.
    Material(String),
    /// Anything else.
    Failed(anyhow::Error),
}

fn failed(error: impl Into<anyhow::Error>) -> Refusal {
    Refusal::Failed(error.into())
}

/// `true` if values and nodes were kept.
fn write(source: &Subject, from: &str, to: &Holder, channel: Option<&str>) -> Result<bool, Refusal> {
    let unfit = |error| match error {
        ConvertError::Channels(why) => Refusal::Channels(why),
        ConvertError::Write(error) => Refusal::Material(error.to_string()),
        error => failed(error),
    };
    // Matrices and trees have the same representation.
    let is_other_kind = to.nodes.is_some() && !from.is_empty() && from != to.name;
    if !is_other_kind && convert(&source.document, to.format, channel, &to.path()).map_err(unfit)?.is_some() {
        return Ok(true);
    }
    let map = ChannelMap::new(source.material.channels(), channel, to.format).map_err(unfit)?;
    let options = Options { lookup: Lookup::Linear, ..Options::default() };
    let material = Material::from_document(&source.document, &options).map_err(failed)?;
    let surface = MaterialSurface { material, scatter: Some(Scatter::Reflection) };
    let surface = Mapped { surface: &surface, map: &map };
    let Some(nodes) = to.nodes(is_isotropic(&surface)) else {
        return Err(Refusal::Material("the format holds isotropic materials only".into()));
    };
    let document = match resampled_matrices(&source.document, &nodes).map_err(failed)? {
        Some(document) => document,
        None => remeasure(&surface, true, Sides::One(Scatter::Reflection), &nodes, || {}).map_err(failed)?,
    };
    // What the format cannot hold is refused by its writer.
    (to.writer.write)(&document, &to.path()).map_err(|error| Refusal::Material(error.to_string()))?;
    Ok(false)
}

fn subject(format: Format, document: Document) -> anyhow::Result<Subject> {
    let options = Options::default();
    let material = Material::from_document(&document, &options)?;
    Ok(Subject::new(format, document, material, &options))
}

/// The table; `None` if it was not requested.
pub fn grid(conversions: &[Conversion]) -> Grid {
    let names = |name: fn(&Conversion) -> &String| {
        let mut names: Vec<&str> = Vec::new();
        for conversion in conversions {
            if !names.contains(&name(conversion).as_str()) {
                names.push(name(conversion));
            }
        }
        names
    };
    let columns = names(|conversion| &conversion.to);
    let row = |from: &&str| {
        let cell = |to: &&str| {
            let found = conversions.iter().find(|conversion| conversion.from == *from && conversion.to == *to);
            found.map_or_else(String::new, Conversion::cell)
        };
        [(*from).to_owned()].into_iter().chain(columns.iter().map(cell)).collect::<Vec<String>>()
    };
    let rows = names(|conversion| &conversion.from).iter().map(row).collect();
    let header = ["from \\ to"].into_iter().chain(columns.iter().copied());
    let stating = conversions.iter().filter(|conversion| conversion.stated.is_some()).count();
    let kept =
        conversions.iter().filter(|conversion| conversion.stated.is_none() && conversion.found.is_some()).count();
    let wrong = conversions.iter().filter(|conversion| !conversion.is_as_stated()).count();
    let verdict = if wrong == 0 { "all of them as stated".to_owned() } else { format!("{wrong} NOT AS STATED") };
    let mut notes: Vec<String> = Vec::new();
    for Conversion { from, to, refused, .. } in conversions {
        notes.extend(refused.as_ref().map(|why| format!("{from} to {to}: {why}")));
    }
    let reading = format!(
        "A conductor, written in each format and from there in each format: the error stated for the conversion / the \
         error found at twice as many directions, in per cent (root mean square of the difference, relative to that of \
         the values). {stating} conversions state an error, {verdict}; {kept} keep values and nodes. Nodes are coarser \
         than those of `lobe convert`."
    );
    Grid::new("Conversions", reading, header, rows).with_notes(notes)
}
