//! What a file holds and what is wrong with it, in words.

use lobe::{Scatter, Side};
use lobe_formats::Document;
use lobe_ops::check::{Thoroughness, check};
use lobe_ops::describe::{Part, describe};
use serde::Serialize;

use crate::Opened;

/// What a file holds, for people, and what a page can ask about it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Facts {
    /// The name of the file.
    pub name: String,
    /// Its path among the files of the page.
    pub path: String,
    /// Its format.
    pub format: &'static str,
    /// Its size.
    pub bytes: u64,
    /// The representation.
    pub kind: &'static str,
    /// The names of the channels.
    pub channels: Vec<String>,
    /// The wavelength of each channel in nm, if they are wavelengths.
    pub wavelengths: Option<Vec<f64>>,
    /// What the luminance of the channels is called; empty if there is one channel.
    pub quantity: String,
    /// Whether colours of the channels are more than grey.
    pub has_colour: bool,
    /// Whether there are Mueller matrices.
    pub is_polarised: bool,
    /// Whether rotating the sample changes nothing.
    pub is_isotropic: bool,
    /// The sides from which light was measured.
    pub sides: Vec<SideFacts>,
    /// Names and values of each block of values.
    pub parts: Vec<Block>,
    /// What the header says.
    pub source: Vec<(String, String)>,
    /// What the reader made of what the file leaves open.
    pub notes: Vec<String>,
    /// What may be wrong with that.
    pub doubts: Vec<String>,
}

/// Light from one side.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SideFacts {
    /// `front` or `back`.
    pub side: &'static str,
    /// `reflection`, `transmission`, or both.
    pub scatters: Vec<&'static str>,
    /// The azimuth of the light in the default view, in radians.
    pub psi: f64,
    /// Polar angles of the light that are worth showing, in radians.
    pub sigmas: Vec<f64>,
}

/// A block of values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Block {
    /// What the file calls it.
    pub name: String,
    /// Names and values.
    pub rows: Vec<(&'static str, String)>,
}

/// A finding of the checks.
pub use lobe_ops::check::Finding;

/// How many incidences are worth a button.
const MOST: usize = 8;

/// The word of a kind of scatter.
pub(crate) fn scatter_word(scatter: Scatter) -> &'static str {
    match scatter {
        Scatter::Reflection => "reflection",
        Scatter::Transmission => "transmission",
    }
}

/// The blocks of values of a document.
pub(crate) fn blocks(document: &Document) -> Vec<Block> {
    let block = |part: &Part| Block { name: part.name.clone(), rows: part.rows() };
    describe(document).iter().map(block).collect()
}

/// What a material is.
pub fn facts(opened: &Opened) -> Facts {
    let subject = &opened.subject;
    let (measured, material) = (subject.measured(), subject.material());
    let document = &measured.document;
    let side = |side: Side| SideFacts {
        side: match side {
            Side::Front => "front",
            Side::Back => "back",
        },
        scatters: subject.scatters(side).into_iter().map(scatter_word).collect(),
        psi: subject.psi(side),
        sigmas: subject.incidences(side, MOST),
    };
    let quantity = lobe_plot::Quantity::of(material.channels()).name;
    Facts {
        name: subject.name().into(),
        path: opened.path.display().to_string(),
        format: measured.format.name(),
        bytes: opened.bytes,
        kind: material.kind().name(),
        channels: material.channels().names(),
        wavelengths: material.wavelengths().map(<[f64]>::to_vec),
        quantity,
        has_colour: !lobe_colour::Reduction::for_display(material.channels()).is_grey(),
        is_polarised: material.is_polarised(),
        is_isotropic: measured.is_isotropic(),
        sides: subject.sides().into_iter().map(side).collect(),
        parts: blocks(document),
        source: document.source.clone(),
        notes: document.notes.clone(),
        doubts: document.doubts.clone(),
    }
}

/// What `lobe check` finds. With `quickly`, integrals are over fewer incidences and as many directions as take seconds.
pub fn findings(opened: &Opened, quickly: bool) -> Vec<Finding> {
    let thoroughness = match quickly {
        true => Thoroughness { incidences: 12, evaluations: 40_000, pairs: 4_000, ..Thoroughness::default() },
        false => Thoroughness::default(),
    };
    check(opened.subject.measured(), &thoroughness, |_| {})
}
