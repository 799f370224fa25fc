//! Writes WINDOW XML.

use std::io::{self, Write};
use std::path::Path;

use lobe_table::window::klems::AngleBasis;
use lobe_table::window::tensor_tree::{Node, Rank, TensorTree};
use lobe_table::window::{Block, Component, Data};
use quick_xml::escape::escape;

use crate::{FormatError, RESAMPLED};
use lobe_files::{unwritable, write_whole};

/// Writes a file that [`read`](super::read) restores exactly: every basis is spelled out, and values have as many
/// digits as they need. The facts `name` and `manufacturer` of `source` become those of the layer. The file appears
/// whole or not at all.
///
/// # Errors
/// [`FormatError`] if the file system refuses, if there is no block, or if matrices and trees, or trees of both ranks,
/// are mixed, which a file cannot express.
pub fn write(sheet: &Data, source: &[(String, String)], path: &Path) -> Result<(), FormatError> {
    write_with(sheet, source, &[], path)
}

/// What was kept of a file, by the names of the elements.
type Kept = [(&'static str, String)];

/// Like [`write()`], with the elements that were kept of another file: its material and its geometry.
///
/// # Errors
/// The same as for [`write()`].
pub(super) fn write_with(
    sheet: &Data,
    source: &[(String, String)],
    kept: &Kept,
    path: &Path,
) -> Result<(), FormatError> {
    write_whole(path, &to_bytes(sheet, source, kept).map_err(|error| unwritable(path, &error))?)
}

fn to_bytes(sheet: &Data, source: &[(String, String)], kept: &Kept) -> io::Result<Vec<u8>> {
    let mut out = Vec::new();
    document(&mut out, sheet, source, kept, structure(sheet)?)?;
    Ok(out)
}

fn components(sheet: &Data) -> impl Iterator<Item = &Component> {
    sheet.bands.iter().flat_map(|band| Block::ALL.into_iter().filter_map(|block| band.window.block(block)))
}

fn structure(sheet: &Data) -> io::Result<&'static str> {
    let name = |component: &Component| match component {
        Component::Klems(_) => "Columns",
        Component::Tree(tree) if tree.rank() == Rank::Three => "TensorTree3",
        Component::Tree(_) => "TensorTree4",
    };
    let refuse = |message: &str| Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    let mut names = components(sheet).map(name);
    match names.next() {
        None => refuse("no block of values to write"),
        Some(first) if names.all(|name| name == first) => Ok(first),
        Some(_) => refuse("a WINDOW file holds blocks of one kind: matrices, or trees of one rank"),
    }
}

fn document(
    out: &mut dyn Write,
    sheet: &Data,
    source: &[(String, String)],
    kept: &Kept,
    structure: &str,
) -> io::Result<()> {
    writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>")?;
    if let Some((name, value)) = source.iter().find(|(name, _)| name == RESAMPLED) {
        // Two hyphens would end the comment.
        writeln!(out, "<!-- {name} {} -->", value.replace("--", "- -"))?;
    }
    writeln!(out, "<WindowElement xmlns=\"http://windows.lbl.gov\">")?;
    writeln!(out, "<WindowElementType>System</WindowElementType>\n<FileType>BSDF</FileType>\n<Optical>\n<Layer>")?;
    let fact = |wanted: &str| {
        let found = source.iter().find(|(name, _)| name == wanted);
        escape(found.map_or("", |(_, value)| value.as_str()))
    };
    let (name, manufacturer) = (fact("name"), fact("manufacturer"));
    let element = |wanted: &str| kept.iter().find(|(name, _)| *name == wanted).map(|(_, element)| element);
    match element("Material") {
        Some(element) => writeln!(out, "{element}")?,
        None => writeln!(out, "<Material><Name>{name}</Name><Manufacturer>{manufacturer}</Manufacturer></Material>")?,
    }
    if let Some(element) = element("Geometry") {
        writeln!(out, "{element}")?;
    }
    writeln!(out, "<DataDefinition>\n<IncidentDataStructure>{structure}</IncidentDataStructure>")?;
    bases(out, sheet)?;
    writeln!(out, "</DataDefinition>")?;
    for band in &sheet.bands {
        for block in Block::ALL {
            if let Some(component) = band.window.block(block) {
                data(out, &band.wavelength, block, component)?;
            }
        }
    }
    writeln!(out, "</Layer>\n</Optical>\n</WindowElement>")
}

fn bases(out: &mut dyn Write, sheet: &Data) -> io::Result<()> {
    let mut written: Vec<&AngleBasis> = Vec::new();
    for component in components(sheet) {
        let Component::Klems(matrix) = component else { continue };
        for basis in [matrix.incident(), matrix.exit()] {
            if written.contains(&basis) {
                continue;
            }
            written.push(basis);
            writeln!(out, "<AngleBasis>\n<AngleBasisName>{}</AngleBasisName>", escape(basis.name()))?;
            for (index, ring) in basis.rings().iter().enumerate() {
                let centre = if index == 0 { 0.0 } else { 0.5 * (ring.lower + ring.upper) };
                write!(out, "<AngleBasisBlock><Theta>{centre}</Theta><nPhis>{}</nPhis>", ring.patches)?;
                write!(out, "<ThetaBounds><LowerTheta>{}</LowerTheta>", ring.lower)?;
                writeln!(out, "<UpperTheta>{}</UpperTheta></ThetaBounds></AngleBasisBlock>", ring.upper)?;
            }
            writeln!(out, "</AngleBasis>")?;
        }
    }
    Ok(())
}

fn data(out: &mut dyn Write, wavelength: &str, block: Block, component: &Component) -> io::Result<()> {
    let (direction, kind) = match block {
        Block::TransmissionFront => ("Transmission Front", "BTDF"),
        Block::TransmissionBack => ("Transmission Back", "BTDF"),
        Block::ReflectionFront => ("Reflection Front", "BRDF"),
        Block::ReflectionBack => ("Reflection Back", "BRDF"),
    };
    writeln!(out, "<WavelengthData>\n<LayerNumber>System</LayerNumber>")?;
    writeln!(out, "<Wavelength unit=\"Integral\">{}</Wavelength>\n<WavelengthDataBlock>", escape(wavelength))?;
    writeln!(out, "<WavelengthDataDirection>{direction}</WavelengthDataDirection>")?;
    match component {
        Component::Klems(matrix) => {
            let (incident, exit) = (matrix.incident(), matrix.exit());
            writeln!(out, "<ColumnAngleBasis>{}</ColumnAngleBasis>", escape(incident.name()))?;
            writeln!(out, "<RowAngleBasis>{}</RowAngleBasis>", escape(exit.name()))?;
            writeln!(out, "<ScatteringDataType>{kind}</ScatteringDataType>\n<ScatteringData>")?;
            for o in 0..exit.patches() {
                for row in matrix.values().chunks_exact(exit.patches()) {
                    write!(out, "{}, ", row[o])?;
                }
                writeln!(out)?;
            }
        }
        Component::Tree(tree) => {
            writeln!(out, "<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>")?;
            writeln!(out, "<ScatteringDataType>{kind}</ScatteringDataType>\n<ScatteringData>")?;
            braces(out, tree)?;
        }
    }
    writeln!(out, "</ScatteringData>\n</WavelengthDataBlock>\n</WavelengthData>")
}

/// Depth first; `None` on the stack closes a branch.
fn braces(out: &mut dyn Write, tree: &TensorTree) -> io::Result<()> {
    let dimensions = tree.rank().dimensions() as u32;
    let mut pending = vec![Some(0_usize)];
    while let Some(node) = pending.pop() {
        match node.map(|node| tree.nodes()[node]) {
            None => writeln!(out, "}}")?,
            Some(Node::Branch(first)) => {
                writeln!(out, "{{")?;
                pending.push(None);
                pending.extend((0..1 << dimensions).rev().map(|child: usize| Some(first as usize + child)));
            }
            Some(Node::Leaf { first, level }) => {
                let count = 1_usize << (level * dimensions);
                write!(out, "{{ ")?;
                for value in &tree.values()[first as usize..][..count] {
                    write!(out, "{value} ")?;
                }
                writeln!(out, "}}")?;
            }
        }
    }
    Ok(())
}
