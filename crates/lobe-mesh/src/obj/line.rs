//! Reads one line of an OBJ or MTL file, word by word.

use std::borrow::Cow;
use std::path::Path;
use std::str::SplitAsciiWhitespace;

use lobe_files::{FormatError, Place};

/// Length of the longest name, in bytes.
const LONGEST_NAME: usize = 1024;

/// The lines of a file with their numbers. A line feed, a carriage return or both end a line, unless the last byte is a
/// backslash that is not in a comment: then the next line belongs to it.
pub(super) fn whole(bytes: &[u8]) -> impl Iterator<Item = (usize, Cow<'_, [u8]>)> {
    let (mut rest, mut number) = (Some(bytes), 0);
    let mut physical = move || {
        let bytes = rest?;
        let end = bytes.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
        let (line, after) = end.map_or((bytes, None), |end| {
            let length = if bytes[end..].starts_with(b"\r\n") { 2 } else { 1 };
            (&bytes[..end], Some(&bytes[end + length..]))
        });
        rest = after;
        number += 1;
        Some((number, line))
    };
    let goes_on = |line: &[u8]| line.strip_suffix(b"\\").filter(|start| !start.contains(&b'#')).map(<[u8]>::len);
    std::iter::from_fn(move || {
        let (number, line) = physical()?;
        let Some(length) = goes_on(line) else { return Some((number, Cow::Borrowed(line))) };
        let mut start = &line[..length];
        let mut all = Vec::new();
        loop {
            all.extend_from_slice(start);
            // A word ends with its line.
            all.push(b' ');
            let Some((_, next)) = physical() else { break };
            let Some(length) = goes_on(next) else {
                all.extend_from_slice(next);
                break;
            };
            start = &next[..length];
        }
        Some((number, Cow::Owned(all)))
    })
}

/// The words of a line that have not been read yet.
pub(super) struct Line<'a> {
    path: &'a Path,
    number: usize,
    words: SplitAsciiWhitespace<'a>,
    /// `true` if the line ended early, at bytes that are not text.
    is_cut: bool,
}

impl<'a> Line<'a> {
    /// A line without its comment. It ends at bytes that are not text, which can only occur in names and comments.
    pub fn new(path: &'a Path, number: usize, bytes: &'a [u8]) -> Self {
        let content = bytes.split(|&byte| byte == b'#').next().unwrap_or_default();
        let text = content.utf8_chunks().next().map_or("", |chunk| chunk.valid());
        Line { path, number, words: text.split_ascii_whitespace(), is_cut: text.len() < content.len() }
    }

    /// The next word.
    pub fn word(&mut self) -> Option<&'a str> {
        self.words.next()
    }

    /// All remaining words, with single spaces, as a name. Its length is limited because groups repeat names.
    pub fn name(&mut self) -> Result<String, FormatError> {
        let name = self.words.by_ref().collect::<Vec<_>>().join(" ");
        if name.len() > LONGEST_NAME {
            return Err(self.wrong(format!("a name of {} bytes", name.len()), format!("at most {LONGEST_NAME}")));
        }
        Ok(name)
    }

    /// `N` finite numbers. Further numbers are ignored.
    pub fn numbers<const N: usize>(&mut self, expected: &str) -> Result<[f32; N], FormatError> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = match self.words.next() {
                Some(word) => self.number(word)?,
                None => return Err(self.wrong("the end of the line", format!("{expected}, {N} numbers"))),
            };
        }
        Ok(numbers)
    }

    /// Texture coordinates: u, and v if there is one.
    pub fn coordinates(&mut self) -> Result<[f32; 2], FormatError> {
        let [u] = self.numbers("u and v")?;
        let v = self.words.next().map_or(Ok(0.0), |word| self.number(word))?;
        Ok([u, v])
    }

    /// A word as a finite number.
    pub fn number(&self, word: &str) -> Result<f32, FormatError> {
        let number = word.parse().ok().filter(|number: &f32| number.is_finite());
        number.ok_or_else(|| self.wrong(format!("`{word}`"), "a finite number"))
    }

    /// The next corner of a face, `v`, `v/vt`, `v//vn` or `v/vt/vn`, as indices from 0; `counts` says how many of each
    /// there are.
    #[expect(clippy::type_complexity, reason = "three indices, two of which may be missing")]
    pub fn corner(&mut self, counts: [usize; 3]) -> Result<Option<(u32, Option<u32>, Option<u32>)>, FormatError> {
        const NAMES: [&str; 3] = ["vertex", "texture coordinates", "normal"];
        let Some(word) = self.words.next() else {
            return if self.is_cut { Err(self.wrong("bytes that are not text", "corners")) } else { Ok(None) };
        };
        let mut indices = [None; 3];
        for (place, text) in word.split('/').enumerate() {
            if place > 2 {
                return Err(self.wrong(format!("`{word}`"), "at most three indices"));
            }
            if !text.is_empty() {
                indices[place] = Some(self.index(text, counts[place], NAMES[place])?);
            }
        }
        match indices {
            [Some(position), uv, normal] => Ok(Some((position, uv, normal))),
            _ => Err(self.wrong(format!("`{word}`"), "the index of a vertex")),
        }
    }

    /// An index, counted from 1, or backward from the last one.
    fn index(&self, text: &str, count: usize, name: &str) -> Result<u32, FormatError> {
        let index: Option<i64> = text.parse().ok();
        let from_zero = index.and_then(|index| match index {
            0 => None,
            1.. => Some(index - 1),
            _ => (count as i64).checked_add(index),
        });
        let in_range = from_zero.and_then(|index| u32::try_from(index).ok()).filter(|&index| (index as usize) < count);
        in_range.ok_or_else(|| {
            let expected = match count {
                0 => "none, as no such line comes before this one".into(),
                1 => "1 or -1, as there is one so far".into(),
                _ => format!("1 to {count} or -1 to -{count}, as many as there are so far"),
            };
            self.wrong(format!("{name} `{text}`"), expected)
        })
    }

    /// An error about this line.
    pub fn wrong(&self, found: impl Into<String>, expected: impl Into<String>) -> FormatError {
        FormatError::new(self.path, Place::Line(self.number), found, expected)
    }
}
