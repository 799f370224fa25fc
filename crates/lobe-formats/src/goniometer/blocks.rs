//! Blocks of rows, divided by empty lines, repeated names and lines of text: each may have its own wavelength, and two
//! with the same directions must not be mistaken for one measurement.

use std::path::Path;

use lobe_table::Channels;

use super::layout::Values;
use super::raw::Raw;
use crate::reading::{Content, ReadOptions};
use crate::{FormatError, Place};

/// Rows without anything between them.
struct Block {
    /// The first row.
    first: usize,
    /// The line before it.
    line: usize,
    /// The wavelength in nm that a line states.
    nm: Option<f64>,
}

/// The blocks of a table, in order.
pub(super) struct Blocks(Vec<Block>);

impl Blocks {
    pub fn new(nm: Option<f64>) -> Self {
        Blocks(vec![Block { first: 0, line: 1, nm }])
    }

    /// Begins a block before the row `first`.
    pub fn begin(&mut self, first: usize, line: usize, nm: Option<f64>) {
        match self.0.last_mut() {
            Some(last) if last.first == first => (last.line, last.nm) = (line, nm),
            _ => self.0.push(Block { first, line, nm }),
        }
    }

    /// Gives rows their wavelengths, and checks that no block repeats the directions of another.
    pub fn close(mut self, raw: &mut Raw, options: &ReadOptions, file: &Path) -> Result<(), FormatError> {
        self.0.retain(|block| block.first < raw.rows.len());
        self.wavelengths(raw, file)?;
        let is_averaged = options.columns.iter().any(|column| matches!(column.content, Content::Values(_)));
        if self.0.len() < 2 || is_averaged { Ok(()) } else { self.repeated(raw, file) }
    }

    /// The wavelength of each row, if those of the blocks differ.
    fn wavelengths(&self, raw: &mut Raw, file: &Path) -> Result<(), FormatError> {
        let mut stated: Vec<f64> = self.0.iter().filter_map(|block| block.nm).collect();
        stated.sort_by(f64::total_cmp);
        stated.dedup();
        if stated.len() < 2 {
            return Ok(());
        }
        let refused = |block: &Block, found: &str, expected: &str| {
            Err(FormatError::new(file, Place::Line(block.line), found, expected))
        };
        if let Some(block) = self.0.iter().find(|block| block.nm.is_none()) {
            return refused(block, "rows without a wavelength", "a line such as Wavelength: 550 nm above each block");
        }
        if !matches!(raw.layout.values, Values::Channels(_, Channels::Mono) | Values::Wide(..)) {
            let block = self.0.iter().find(|block| block.nm != self.0[0].nm).unwrap_or(&self.0[0]);
            let found = "another wavelength for columns that already are wavelengths or colours";
            return refused(block, found, "one column of values, or all rows without such lines");
        }
        let ends = self.0.iter().skip(1).map(|block| block.first).chain([raw.rows.len()]);
        for (block, end) in self.0.iter().zip(ends) {
            raw.wavelengths.resize(end, block.nm.unwrap_or_default());
        }
        let shown: Vec<String> = stated.iter().take(12).map(f64::to_string).collect();
        let more = if stated.len() > 12 { ", ..." } else { "" };
        raw.notes.push(format!("wavelengths as stated outside the rows: {}{more} nm", shown.join(", ")));
        Ok(())
    }

    /// Refuses a row whose directions another block also has, with another value.
    fn repeated(&self, raw: &Raw, file: &Path) -> Result<(), FormatError> {
        let count = raw.values.len() / raw.rows.len();
        let key = |row: usize| {
            let angles = raw.rows[row].map(|angle| (angle + 0.0).to_bits());
            (angles, raw.wavelengths.get(row).map_or(0, |nm| nm.to_bits()))
        };
        let block = |row: usize| self.0.partition_point(|block| block.first <= row) - 1;
        let texel = |row: usize| raw.values[row * count..][..count].iter().map(|value| value.to_bits());
        let mut order: Vec<usize> = (0..raw.rows.len()).collect();
        order.sort_by_key(|&row| (key(row), row));
        let is_repeated = |pair: &&[usize]| {
            let (a, b) = (pair[0], pair[1]);
            key(a) == key(b) && block(a) != block(b) && !texel(a).eq(texel(b))
        };
        let Some([first, again]) = order.windows(2).find(is_repeated) else { return Ok(()) };
        let found = format!(
            "the directions of line {} again, after line {} between the rows",
            raw.lines[*first],
            self.0[block(*again)].line
        );
        let expected = "blocks that differ in what is read: a line such as Wavelength: 550 nm or theta_i: 30 above each, \
                        a file for each, or --columns that name the values, so that rows are averaged";
        Err(FormatError::new(file, Place::Line(raw.lines[*again] as usize), found, expected))
    }
}
