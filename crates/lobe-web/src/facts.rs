//! The facts of a file and its problems, in words.

use lobe::{Scatter, Side};
use lobe_formats::Document;
use lobe_ops::check::{Thoroughness, check};
use lobe_ops::describe::{Part, describe};
use serde::Serialize;

use crate::Opened;

/// The contents of a file, in words for readers, and what a page can request of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Facts {
    /// The name of the file.
    pub name: String,
    /// The path of the file among the files of the page.
    pub path: String,
    /// The format of the file.
    pub format: &'static str,
    /// The size of the file in bytes.
    pub bytes: u64,
    /// The representation.
    pub kind: &'static str,
    /// The names of the channels.
    pub channels: Vec<String>,
    /// The wavelength of each channel in nm, if they are wavelengths.
    pub wavelengths: Option<Vec<f64>>,
    /// The name of the quantity to which channels are reduced; empty if there is one channel.
    pub quantity: String,
    /// `true` if the channels have colours other than grey.
    pub has_colour: bool,
    /// `true` if the values are Mueller matrices.
    pub is_polarised: bool,
    /// `true` if the material is isotropic.
    pub is_isotropic: bool,
    /// The sides from which light was measured.
    pub sides: Vec<SideFacts>,
    /// The properties of each part.
    pub parts: Vec<Block>,
    /// The facts of the header: names and values.
    pub source: Vec<(String, String)>,
    /// How the reader has interpreted what the file leaves open.
    pub notes: Vec<String>,
    /// What may be wrong with this interpretation.
    pub doubts: Vec<String>,
}

/// What was measured with light from one side.
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

/// The properties of a part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Block {
    /// The name of the part in the file.
    pub name: String,
    /// The names and values of the properties.
    pub rows: Vec<(&'static str, String)>,
}

/// A finding of the checks.
pub use lobe_ops::check::Finding;

/// The largest number of incidences with a button in the page.
const MOST: usize = 8;

/// The word for a kind of scatter.
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

/// The facts of a material.
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

/// The findings of `lobe check`. If `quickly`, integrals are over fewer incidences and directions, so that they take
/// seconds.
pub fn findings(opened: &Opened, quickly: bool) -> Vec<Finding> {
    let thoroughness = match quickly {
        true => Thoroughness { incidences: 12, evaluations: 40_000, pairs: 4_000, ..Thoroughness::default() },
        false => Thoroughness::default(),
    };
    check(opened.subject.measured(), &thoroughness, |_| {})
}
