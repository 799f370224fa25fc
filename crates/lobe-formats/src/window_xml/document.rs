//! The elements of a file, taken from a stream of XML events.
//!
//! A pull parser keeps no document in memory, expands no entities that the file defines, and does not recurse, so
//! neither entity bombs nor deep nesting do any harm.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::Path;
use std::rc::Rc;

use lobe_files::printable;
use lobe_table::window::klems::{AngleBasis, KlemsMatrix};
use lobe_table::window::tensor_tree::{Rank, TensorTree};
use lobe_table::window::{Band, Block, Blocks, Component, Data};
use quick_xml::Reader;
use quick_xml::events::Event;

use super::basis::BasisReader;
use super::tree;
use super::words::{number, numbers, quoted};
use crate::{FormatError, Measured, Place, RESAMPLED};

/// The text of a file: UTF-8, or UTF-16 with a byte-order mark. Bytes that are neither can only occur in names.
pub(super) fn decode(bytes: &[u8]) -> Cow<'_, str> {
    let utf16 = |unit: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes[2..].chunks_exact(2).map(|pair| unit([pair[0], pair[1]])).collect();
        Cow::Owned(String::from_utf16_lossy(&units))
    };
    match bytes {
        [0xff, 0xfe, ..] => utf16(u16::from_le_bytes),
        [0xfe, 0xff, ..] => utf16(u16::from_be_bytes),
        _ => String::from_utf8_lossy(bytes),
    }
}

/// The order of the values of a block.
#[derive(Clone, Copy, PartialEq)]
enum Structure {
    /// Exit patch by exit patch.
    Columns,
    /// Incident patch by incident patch.
    Rows,
    /// In braces.
    Tree(Rank),
}

/// A text of the file and its position.
type Text<'a> = (Cow<'a, str>, usize);

/// A `WavelengthDataBlock` as text: the meaning of its bases and values may be stated after it.
#[derive(Default)]
struct BlockText<'a> {
    start: usize,
    /// Shared by all blocks of a `WavelengthData`, because the name may be long and the blocks many.
    wavelength: Rc<str>,
    direction: Option<Block>,
    columns: Option<Text<'a>>,
    rows: Option<Text<'a>>,
    values: Option<Text<'a>>,
}

/// A file while it is read.
pub(super) struct Document<'a> {
    text: &'a str,
    file: &'a Path,
    name: String,
    manufacturer: String,
    data: Data,
    structure: Option<Structure>,
    basis: BasisReader,
    wavelength: String,
    /// The number of layers that began, and the one whose values were read.
    layer: usize,
    layer_of_values: Option<usize>,
    /// `true` if the element is within a block, which is then the last one.
    is_in_block: bool,
    blocks: Vec<BlockText<'a>>,
    /// The first block of the `WavelengthData` that is being read.
    first_block: usize,
    /// The position of each band, by its name in lower case.
    bands: HashMap<String, usize>,
    /// The elements of [`KEPT`] as they stand in the file.
    kept: Vec<(&'static str, String)>,
    /// How the file was resampled, if a comment says so.
    resampled: Option<String>,
}

/// The elements of a layer that are not read, but kept: with the sizes of the sheet, what it is made of, its thermal
/// properties, and its shape.
const KEPT: [&str; 2] = ["Material", "Geometry"];

/// What a file says: its values, and the elements that are kept.
pub(super) struct Parsed {
    pub measured: Measured<Data>,
    pub kept: Vec<(&'static str, String)>,
}

impl<'a> Document<'a> {
    pub(super) fn parse(text: &'a str, file: &'a Path) -> Result<Parsed, FormatError> {
        let mut document = Document {
            text,
            file,
            name: String::new(),
            manufacturer: String::new(),
            data: Data::default(),
            structure: None,
            basis: BasisReader::default(),
            wavelength: String::new(),
            layer: 0,
            layer_of_values: None,
            is_in_block: false,
            blocks: Vec::new(),
            first_block: 0,
            bands: HashMap::new(),
            kept: Vec::new(),
            resampled: None,
        };
        document.walk()?;
        for block in std::mem::take(&mut document.blocks) {
            document.keep(&block)?;
        }
        if document.data.bands.is_empty() {
            return Err(FormatError::new(file, Place::File, "no WavelengthData with values", "at least one block"));
        }
        let resampled = document.resampled.unwrap_or_default();
        let source = [("name", document.name), ("manufacturer", document.manufacturer), (RESAMPLED, resampled)];
        let stated = source.into_iter().filter(|(_, value)| !value.is_empty());
        let source = stated.map(|(name, value)| (name.into(), value)).collect();
        let measured = Measured { data: document.data, source, tis: Vec::new() };
        Ok(Parsed { measured, kept: document.kept })
    }

    fn error(&self, at: usize, found: impl Into<String>, expected: impl Into<String>) -> FormatError {
        let before = &self.text.as_bytes()[..at.min(self.text.len())];
        let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
        FormatError::new(self.file, Place::Line(line), found, expected)
    }

    fn walk(&mut self) -> Result<(), FormatError> {
        // Programs that recover an interrupted run leave a line of plain text before the XML.
        let text = self.text;
        let skipped = text.find('<').unwrap_or(text.len());
        let mut reader = Reader::from_str(&text[skipped..]);
        reader.config_mut().expand_empty_elements = true;
        let (mut content, mut start) = (Cow::Borrowed(""), skipped);
        let (mut depth, mut has_root) = (0_usize, false);
        // The element that is being kept: its name, its depth, and where it starts.
        let mut kept: Option<(&'static str, usize, usize)> = None;
        loop {
            let at = skipped + reader.buffer_position() as usize;
            let event = reader.read_event().map_err(|error| {
                self.error(skipped + reader.error_position() as usize, error.to_string(), "well-formed XML")
            })?;
            match event {
                Event::Start(tag) => {
                    if !has_root && tag.local_name().as_ref() != "WindowElement" {
                        return Err(self.error(at, format!("<{}>", tag.name().as_ref()), "<WindowElement>"));
                    }
                    has_root = true;
                    depth += 1;
                    let name = KEPT.into_iter().find(|name| *name == tag.local_name().as_ref());
                    if let (Some(name), None, false) = (name, kept, self.is_in_block) {
                        kept = Some((name, depth, at));
                    }
                    self.open(tag.local_name().as_ref(), at);
                    (content, start) = (Cow::Borrowed(""), skipped + reader.buffer_position() as usize);
                }
                Event::End(tag) => {
                    self.close(tag.local_name().as_ref(), std::mem::take(&mut content), start)?;
                    if let Some((name, _, from)) = kept.take_if(|(_, of, _)| *of == depth) {
                        self.keep_element(name, &text[from..skipped + reader.buffer_position() as usize]);
                    }
                    depth -= 1;
                    if depth == 0 {
                        return Ok(());
                    }
                }
                Event::Text(text) => append(&mut content, text.into_inner()),
                Event::CData(text) => append(&mut content, text.into_inner()),
                Event::GeneralRef(reference) => {
                    let name = reference.xml10_content();
                    let resolved = match reference.resolve_char_ref() {
                        Ok(Some(character)) => Some(character.to_string()),
                        Ok(None) => quick_xml::escape::resolve_predefined_entity(&name).map(String::from),
                        Err(_) => None,
                    };
                    let resolved =
                        resolved.ok_or_else(|| self.error(at, format!("&{name};"), "an entity that XML predefines"))?;
                    append(&mut content, Cow::Owned(resolved));
                }
                Event::Eof => return Err(self.error(self.text.len(), "the end of the file", "</WindowElement>")),
                // An empty element comes as a start and an end.
                Event::Comment(comment) => self.comment(comment.into_inner().trim()),
                Event::Empty(_) | Event::Decl(_) | Event::PI(_) | Event::DocType(_) => {}
            }
        }
    }

    /// Keeps the comment that says how the file was resampled.
    fn comment(&mut self, comment: &str) {
        if let (Some(said), None) = (comment.strip_prefix(RESAMPLED), &self.resampled) {
            self.resampled = Some(said.trim().into());
        }
    }

    /// Keeps an element, the first of its name. A prefix would lose the declaration of its name space.
    fn keep_element(&mut self, name: &'static str, element: &str) {
        let is_first = self.kept.iter().all(|(kept, _)| *kept != name);
        if is_first && element.starts_with(&format!("<{name}")) {
            self.kept.push((name, element.into()));
        }
    }

    fn open(&mut self, name: &str, start: usize) {
        match name {
            "Layer" => self.layer += 1,
            "WavelengthData" => {
                self.wavelength.clear();
                self.first_block = self.blocks.len();
            }
            "WavelengthDataBlock" => {
                self.is_in_block = true;
                self.blocks.push(BlockText { start, ..BlockText::default() });
            }
            _ => {}
        }
    }

    fn close(&mut self, name: &str, content: Cow<'a, str>, start: usize) -> Result<(), FormatError> {
        if self.is_in_block {
            return self.close_in_block(name, content, start);
        }
        let content = content.trim();
        match name {
            "Name" => self.name = content.into(),
            "Manufacturer" => self.manufacturer = content.into(),
            "Wavelength" => self.wavelength = content.into(),
            "IncidentDataStructure" => {
                let known = [
                    ("Columns", Structure::Columns),
                    ("Rows", Structure::Rows),
                    ("TensorTree3", Structure::Tree(Rank::Three)),
                    ("TensorTree4", Structure::Tree(Rank::Four)),
                ];
                let found = known.into_iter().find(|(name, _)| name.eq_ignore_ascii_case(content));
                let (_, structure) = found.ok_or_else(|| {
                    let expected = "Columns, Rows, TensorTree3 or TensorTree4";
                    self.error(start, format!("IncidentDataStructure {content:?}"), expected)
                })?;
                // It applies to all blocks, those before it as well.
                if self.structure.replace(structure).is_some_and(|before| before != structure) {
                    let expected = "the same as before: one for the file";
                    return Err(self.error(start, format!("another IncidentDataStructure, {content:?}"), expected));
                }
            }
            "WavelengthData" => {
                let wavelength: Rc<str> = self.wavelength.as_str().into();
                for block in &mut self.blocks[self.first_block..] {
                    block.wavelength = wavelength.clone();
                }
                self.first_block = self.blocks.len();
            }
            _ => self.basis.close(name, content).map_err(|(found, expected)| self.error(start, found, expected))?,
        }
        Ok(())
    }

    fn close_in_block(&mut self, name: &str, content: Cow<'a, str>, start: usize) -> Result<(), FormatError> {
        let direction = match name {
            "WavelengthDataBlock" => {
                self.is_in_block = false;
                let layer = *self.layer_of_values.get_or_insert(self.layer);
                if layer != self.layer {
                    let start = self.blocks.last().map_or(start, |block| block.start);
                    return Err(self.error(start, "values of a second Layer", "one layer in a file"));
                }
                return Ok(());
            }
            "WavelengthDataDirection" => {
                let wanted = content.split_whitespace().collect::<Vec<_>>().join(" ");
                let index = NAMES.iter().position(|name| name.eq_ignore_ascii_case(&wanted)).ok_or_else(|| {
                    let expected = "Transmission or Reflection, Front or Back";
                    self.error(start, format!("WavelengthDataDirection {:?}", content.trim()), expected)
                })?;
                Some(Block::ALL[index])
            }
            "AngleBasis" if !content.trim().eq_ignore_ascii_case("LBNL/Shirley-Chiu") => {
                return Err(self.error(start, format!("AngleBasis {:?}", content.trim()), "LBNL/Shirley-Chiu"));
            }
            _ => None,
        };
        if let Some(block) = self.blocks.last_mut() {
            match name {
                "WavelengthDataDirection" => block.direction = direction,
                "ColumnAngleBasis" => block.columns = Some((content, start)),
                "RowAngleBasis" => block.rows = Some((content, start)),
                "ScatteringData" => block.values = Some((content, start)),
                _ => {}
            }
        }
        Ok(())
    }

    /// Adds a block to its band.
    fn keep(&mut self, block: &BlockText<'_>) -> Result<(), FormatError> {
        let wavelength = &*block.wavelength;
        if wavelength.is_empty() {
            return Err(self.error(block.start, "WavelengthData without a Wavelength", "its name"));
        }
        let Some((direction, values)) = block.direction.zip(block.values.as_ref()) else {
            return Err(self.error(block.start, "a WavelengthDataBlock without them", "a direction and values"));
        };
        let component = self.component(block, values)?;
        let bands = &mut self.data.bands;
        let band = *self.bands.entry(wavelength.to_ascii_lowercase()).or_insert_with(|| {
            bands.push(Band { wavelength: printable(wavelength).into_owned(), window: Blocks::default() });
            bands.len() - 1
        });
        if bands[band].window.set(direction, component).is_some() {
            let found = format!("a second {} of {wavelength}", spelled(direction));
            return Err(self.error(block.start, found, "each block once in a band"));
        }
        Ok(())
    }

    fn find_basis(&self, (name, start): &Text<'_>) -> Result<AngleBasis, FormatError> {
        self.basis.find(name.trim()).ok_or_else(|| {
            let expected = "LBNL/Klems Full, Half or Quarter, or a basis that the file defines";
            self.error(*start, format!("basis {:?}", name.trim()), expected)
        })
    }

    fn component(&self, block: &BlockText<'_>, (content, start): &Text<'_>) -> Result<Component, FormatError> {
        let start = *start;
        let is_columns = match self.structure {
            None => {
                return Err(self.error(start, "values without an IncidentDataStructure", "the structure of the file"));
            }
            Some(Structure::Tree(rank)) => return self.tree(rank, content, start).map(Component::Tree),
            Some(Structure::Columns) => true,
            Some(Structure::Rows) => false,
        };
        let Some((columns, rows)) = block.columns.as_ref().zip(block.rows.as_ref()) else {
            return Err(self.error(start, "values without their bases", "ColumnAngleBasis and RowAngleBasis"));
        };
        let (columns, rows) = (self.find_basis(columns)?, self.find_basis(rows)?);
        let (incident, exit) = if is_columns { (columns, rows) } else { (rows, columns) };
        let (ni, no) = (incident.patches(), exit.patches());
        let found = numbers(content).count();
        if found != ni * no {
            let expected = format!("{} = {ni} incident patches x {no} exit patches", ni * no);
            return Err(self.error(start, format!("{found} values"), expected));
        }
        let mut values = vec![0.0; ni * no];
        for (index, (at, token)) in numbers(content).enumerate() {
            let value = number(token).ok_or_else(|| self.error(start + at, quoted(token), "a finite number"))?;
            let (i, o) = if is_columns { (index % ni, index / ni) } else { (index / no, index % no) };
            values[i * no + o] = value;
        }
        let matrix = KlemsMatrix::new(incident, exit, values);
        matrix.map(Component::Klems).map_err(|error| self.error(start, error.to_string(), "a Klems matrix"))
    }

    fn tree(&self, rank: Rank, content: &str, start: usize) -> Result<TensorTree, FormatError> {
        tree::parse(rank, content).map_err(|error| self.error(start + error.at, error.found, error.expected))
    }
}

/// The names of the blocks, in the order of [`Block::ALL`].
const NAMES: [&str; 4] = ["Transmission Front", "Transmission Back", "Reflection Front", "Reflection Back"];

fn spelled(block: Block) -> &'static str {
    Block::ALL.iter().position(|other| *other == block).map_or("block", |index| NAMES[index])
}

fn append<'a>(content: &mut Cow<'a, str>, more: Cow<'a, str>) {
    if content.is_empty() {
        *content = more;
    } else {
        content.to_mut().push_str(&more);
    }
}
