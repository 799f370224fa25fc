//! The elements of a file, taken from a stream of XML events.
//!
//! A pull parser keeps no document in memory, expands no entities of the file's own, and does not recurse, so that
//! neither entity bombs nor deep nesting can hurt.

use std::borrow::Cow;
use std::path::Path;

use lobe_table::klems::{AngleBasis, KlemsMatrix};
use lobe_table::tensor_tree::{Rank, TensorTree};
use lobe_table::window::{Block, Component, Window};
use quick_xml::Reader;
use quick_xml::events::Event;

use super::basis::BasisReader;
use super::{Band, WindowXml, tree};
use crate::{FormatError, Place};

/// Text of a file: UTF-8, or UTF-16 with a byte order mark. Bytes that are neither can only be in names.
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

/// How the values of a block are listed.
#[derive(Clone, Copy)]
enum Structure {
    /// Exit patch by exit patch.
    Columns,
    /// Incident patch by incident patch.
    Rows,
    /// In braces.
    Tree(Rank),
}

/// A `WavelengthDataBlock` while it is read.
#[derive(Default)]
struct BlockReader {
    block: Option<Block>,
    columns: Option<AngleBasis>,
    rows: Option<AngleBasis>,
    component: Option<Component>,
}

/// A file while it is read.
pub(super) struct Document<'a> {
    text: &'a str,
    file: &'a Path,
    result: WindowXml,
    structure: Option<Structure>,
    basis: BasisReader,
    wavelength: String,
    block: Option<BlockReader>,
    blocks: Vec<(Block, Component)>,
}

impl<'a> Document<'a> {
    pub(super) fn parse(text: &'a str, file: &'a Path) -> Result<WindowXml, FormatError> {
        let mut document = Document {
            text,
            file,
            result: WindowXml::default(),
            structure: None,
            basis: BasisReader::default(),
            wavelength: String::new(),
            block: None,
            blocks: Vec::new(),
        };
        document.walk()?;
        if document.result.bands.is_empty() {
            return Err(FormatError::new(file, Place::File, "no WavelengthData with values", "at least one block"));
        }
        Ok(document.result)
    }

    fn error(&self, at: usize, found: impl Into<String>, expected: impl Into<String>) -> FormatError {
        let before = &self.text.as_bytes()[..at.min(self.text.len())];
        let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
        FormatError::new(self.file, Place::Line(line), found, expected)
    }

    fn walk(&mut self) -> Result<(), FormatError> {
        // Programs that recover an interrupted run leave a line of plain text before the XML.
        let skipped = self.text.find('<').unwrap_or(self.text.len());
        let mut reader = Reader::from_str(&self.text[skipped..]);
        reader.config_mut().expand_empty_elements = true;
        let (mut content, mut start) = (Cow::Borrowed(""), skipped);
        let (mut depth, mut has_root) = (0_usize, false);
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
                    self.open(tag.local_name().as_ref());
                    (content, start) = (Cow::Borrowed(""), skipped + reader.buffer_position() as usize);
                }
                Event::End(tag) => {
                    self.close(tag.local_name().as_ref(), &content, start)?;
                    content = Cow::Borrowed("");
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
                Event::Empty(_) | Event::Comment(_) | Event::Decl(_) | Event::PI(_) | Event::DocType(_) => {}
            }
        }
    }

    fn open(&mut self, name: &str) {
        match name {
            "WavelengthData" => self.wavelength.clear(),
            "WavelengthDataBlock" => self.block = Some(BlockReader::default()),
            _ => {}
        }
    }

    fn close(&mut self, name: &str, content: &str, start: usize) -> Result<(), FormatError> {
        if let Some(mut block) = self.block.take() {
            self.close_in_block(&mut block, name, content, start)?;
            if name == "WavelengthDataBlock" {
                let Some(found) = block.block.zip(block.component) else {
                    return Err(self.error(start, "a WavelengthDataBlock without them", "a direction and values"));
                };
                self.blocks.push(found);
            } else {
                self.block = Some(block);
            }
            return Ok(());
        }
        match name {
            "Name" => self.result.name = content.trim().into(),
            "Manufacturer" => self.result.manufacturer = content.trim().into(),
            "Wavelength" => self.wavelength = content.trim().into(),
            "IncidentDataStructure" => {
                let known = [
                    ("Columns", Structure::Columns),
                    ("Rows", Structure::Rows),
                    ("TensorTree3", Structure::Tree(Rank::Three)),
                    ("TensorTree4", Structure::Tree(Rank::Four)),
                ];
                let found = known.into_iter().find(|(name, _)| name.eq_ignore_ascii_case(content.trim()));
                let (_, structure) = found.ok_or_else(|| {
                    let expected = "Columns, Rows, TensorTree3 or TensorTree4";
                    self.error(start, format!("IncidentDataStructure {:?}", content.trim()), expected)
                })?;
                self.structure = Some(structure);
            }
            "WavelengthData" => self.close_band(start)?,
            _ => self.basis.close(name, content).map_err(|(found, expected)| self.error(start, found, expected))?,
        }
        Ok(())
    }

    fn close_band(&mut self, start: usize) -> Result<(), FormatError> {
        if self.blocks.is_empty() {
            return Ok(());
        }
        if self.wavelength.is_empty() {
            return Err(self.error(start, "WavelengthData without a Wavelength", "its name"));
        }
        let bands = &mut self.result.bands;
        let known = bands.iter().position(|band| band.wavelength.eq_ignore_ascii_case(&self.wavelength));
        let band = known.unwrap_or_else(|| {
            bands.push(Band { wavelength: self.wavelength.clone(), window: Window::default() });
            bands.len() - 1
        });
        for (block, component) in std::mem::take(&mut self.blocks) {
            if self.result.bands[band].window.set(block, component).is_some() {
                let found = format!("a second {block:?} of {}", self.wavelength);
                return Err(self.error(start, found, "each block once in a band"));
            }
        }
        Ok(())
    }

    fn close_in_block(
        &self,
        block: &mut BlockReader,
        name: &str,
        content: &str,
        start: usize,
    ) -> Result<(), FormatError> {
        match name {
            "WavelengthDataDirection" => {
                let names = ["transmission front", "transmission back", "reflection front", "reflection back"];
                let wanted = content.split_whitespace().collect::<Vec<_>>().join(" ").to_ascii_lowercase();
                let index = names.iter().position(|name| *name == wanted).ok_or_else(|| {
                    let expected = "Transmission or Reflection, Front or Back";
                    self.error(start, format!("WavelengthDataDirection {:?}", content.trim()), expected)
                })?;
                block.block = Some(Block::ALL[index]);
            }
            "ColumnAngleBasis" => block.columns = Some(self.find_basis(content, start)?),
            "RowAngleBasis" => block.rows = Some(self.find_basis(content, start)?),
            "AngleBasis" if !content.trim().eq_ignore_ascii_case("LBNL/Shirley-Chiu") => {
                return Err(self.error(start, format!("AngleBasis {:?}", content.trim()), "LBNL/Shirley-Chiu"));
            }
            "ScatteringData" => block.component = Some(self.component(block, content, start)?),
            _ => {}
        }
        Ok(())
    }

    fn find_basis(&self, name: &str, start: usize) -> Result<AngleBasis, FormatError> {
        self.basis.find(name.trim()).ok_or_else(|| {
            let expected = "LBNL/Klems Full, Half or Quarter, or a basis that the file defines";
            self.error(start, format!("basis {:?}", name.trim()), expected)
        })
    }

    fn component(&self, block: &BlockReader, content: &str, start: usize) -> Result<Component, FormatError> {
        let Some(structure) = self.structure else {
            return Err(self.error(start, "values before an IncidentDataStructure", "the structure first"));
        };
        // A missing structure element was caught above; both bases are needed for a matrix only.
        let is_columns = matches!(structure, Structure::Columns);
        let (incident, exit) = match (structure, &block.columns, &block.rows) {
            (Structure::Tree(rank), ..) => return self.tree(rank, content, start).map(Component::Tree),
            (Structure::Columns, Some(columns), Some(rows)) => (columns, rows),
            (Structure::Rows, Some(columns), Some(rows)) => (rows, columns),
            _ => return Err(self.error(start, "values before their bases", "ColumnAngleBasis and RowAngleBasis")),
        };
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
        let matrix = KlemsMatrix::new(incident.clone(), exit.clone(), values);
        matrix.map(Component::Klems).map_err(|error| self.error(start, error.to_string(), "a Klems matrix"))
    }

    fn tree(&self, rank: Rank, content: &str, start: usize) -> Result<TensorTree, FormatError> {
        tree::parse(rank, content).map_err(|error| self.error(start + error.at, error.found, error.expected))
    }
}

fn append<'a>(content: &mut Cow<'a, str>, more: Cow<'a, str>) {
    if content.is_empty() {
        *content = more;
    } else {
        content.to_mut().push_str(&more);
    }
}

/// The tokens between white space and commas, each with its offset.
fn numbers(content: &str) -> impl Iterator<Item = (usize, &str)> {
    let is_separator = |character: char| character.is_ascii_whitespace() || character == ',';
    content
        .split(is_separator)
        .filter(|token| !token.is_empty())
        .map(|token| (token.as_ptr() as usize - content.as_ptr() as usize, token))
}

/// A finite `f32`.
pub(super) fn number(token: &str) -> Option<f32> {
    token.parse().ok().filter(|value: &f32| value.is_finite())
}

/// A token as an error shows it, cut short.
pub(super) fn quoted(token: &str) -> String {
    format!("{:?}", token.chars().take(32).collect::<String>())
}
