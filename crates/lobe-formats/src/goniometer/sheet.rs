//! A text as rows of cells: the delimiter and the decimal separator.

use std::borrow::Cow;

/// The separator of cells, and the form of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Dialect {
    /// The delimiter between cells; `None` for any white space.
    pub delimiter: Option<char>,
    /// `true` if numbers have decimal commas.
    pub has_decimal_comma: bool,
}

/// A cell of a row of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cell {
    Number(f64),
    /// Empty, or a word that means "not measured".
    Missing,
    Text,
}

/// A line that is not empty, with its number in the file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'a> {
    pub number: usize,
    pub text: &'a str,
}

impl<'a> Line<'a> {
    /// The text of a comment, if the line is one.
    pub fn comment(&self) -> Option<&'a str> {
        let text = self.text.trim_start();
        let marker = ["#", "%", "//", "!"].into_iter().find(|marker| text.starts_with(marker))?;
        Some(text.trim_start_matches(marker.chars().next()?).trim())
    }
}

/// The lines that have more than white space and delimiters.
pub(super) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    let is_blank = |text: &str| text.chars().all(|c| c.is_whitespace() || [',', ';', '|'].contains(&c));
    let lines = text.lines().enumerate().map(|(index, text)| Line { number: index + 1, text });
    // 0x1a is the end-of-file character of DOS.
    lines.filter(move |line| !is_blank(line.text.trim_end_matches('\u{1a}')))
}

/// Words that people and programs write where nothing was measured.
const MISSING: &[&str] = &[
    "",
    "nan",
    "na",
    "n/a",
    "n.a.",
    "-nan",
    "+nan",
    "nan(ind)",
    "-nan(ind)",
    "1.#qnan",
    "-1.#qnan",
    "1.#ind",
    "-1.#ind",
    "null",
    "none",
    "-",
    "--",
    "---",
    "–",
    "—",
    "#n/a",
    "#nv",
    "#num!",
    "#div/0!",
    "#value!",
    "#wert!",
    "#zahl!",
    "missing",
    "nd",
    "n.d.",
];

impl Dialect {
    /// The dialect that gives the most cells of numbers in the first lines. Tabs and semicolons come before commas,
    /// commas before blanks.
    pub fn of(lines: &[Line<'_>], has_decimal_comma: Option<bool>) -> Option<Self> {
        let mut bytes = 0;
        let is_within = |(index, line): &(usize, &Line<'_>)| {
            bytes += line.text.len();
            *index < LEAST || bytes <= SAMPLE_BYTES
        };
        let sample: Vec<Line<'_>> =
            lines.iter().take(SAMPLE).enumerate().take_while(is_within).map(|(_, line)| *line).collect();
        let mut best = (0, None);
        for delimiter in [Some('\t'), Some(';'), Some('|'), Some(','), None] {
            for comma in [false, true] {
                if has_decimal_comma.is_some_and(|wanted| wanted != comma) {
                    continue;
                }
                let dialect = Dialect { delimiter, has_decimal_comma: comma };
                let count: usize = sample.iter().map(|line| dialect.numbers(line)).sum();
                if count > best.0 {
                    best = (count, Some(dialect));
                }
            }
        }
        best.1
    }

    /// The number of numbers in a line, if it is mostly numbers.
    fn numbers(self, line: &Line<'_>) -> usize {
        if line.comment().is_some() {
            return 0;
        }
        let (mut numbers, mut texts) = (0, 0);
        for cell in self.cells(line.text) {
            match self.cell(&cell) {
                Cell::Number(_) => numbers += 1,
                Cell::Text => texts += 1,
                Cell::Missing => {}
            }
        }
        if numbers >= 2 && texts <= numbers { numbers } else { 0 }
    }

    /// The cells of a line, without white space and quotes around them.
    pub fn cells(self, text: &str) -> Vec<Cow<'_, str>> {
        match self.delimiter {
            None => text.split_whitespace().map(|cell| Cow::Borrowed(cell.trim_matches('"'))).collect(),
            Some(delimiter) if text.contains('"') => quoted(text, delimiter),
            Some(delimiter) => text.split(delimiter).map(|cell| Cow::Borrowed(cell.trim())).collect(),
        }
    }

    /// The cells of a line without empty ones at its end.
    pub fn cells_to_the_last(self, text: &str) -> Vec<Cow<'_, str>> {
        let mut cells = self.cells(text);
        while cells.last().is_some_and(|cell| cell.is_empty()) {
            cells.pop();
        }
        cells
    }

    /// The content of a cell.
    pub fn cell(self, text: &str) -> Cell {
        let text = text.trim_matches(|c: char| c == '\u{1a}' || c.is_whitespace());
        if MISSING.iter().any(|word| word.eq_ignore_ascii_case(text)) {
            return Cell::Missing;
        }
        self.number(text).map_or(Cell::Text, Cell::Number)
    }

    /// A finite number, perhaps with a sign for degrees.
    pub fn number(self, text: &str) -> Option<f64> {
        let text = text.strip_suffix(['°', 'º', '˚']).map_or(text, str::trim_end);
        let has_digit = text.bytes().any(|byte| byte.is_ascii_digit());
        let is_decimal = |c: char| c == if self.has_decimal_comma { ',' } else { '.' };
        let fits = |c: char| c.is_ascii_digit() || is_decimal(c) || "+-−–‐eEdD".contains(c);
        if !has_digit || !text.chars().all(fits) {
            return None;
        }
        let number = if text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte)) {
            text.parse()
        } else {
            text.replace(',', ".").replace(['−', '–', '‐'], "-").replace(['d', 'D'], "e").parse()
        };
        number.ok().filter(|number: &f64| number.is_finite())
    }

    /// The first number whose comma may be a decimal comma or separate thousands, with its line; `None` if another
    /// number of these lines decides. Spreadsheets quote both kinds. If semicolons separate the cells, a comma is
    /// decimal.
    pub fn ambiguous(self, lines: &[Line<'_>]) -> Option<(usize, String)> {
        if !self.has_decimal_comma || self.delimiter == Some(';') {
            return None;
        }
        let mut first = None;
        for line in lines.iter().filter(|line| line.text.contains(',')) {
            for cell in self.cells(line.text) {
                if cell.contains(',') && self.number(&cell).is_some() {
                    if !is_grouped(&cell) {
                        return None;
                    }
                    first.get_or_insert_with(|| (line.number, cell.into_owned()));
                }
            }
        }
        first
    }

    /// A description for people.
    pub fn describe(self) -> String {
        let between = match self.delimiter {
            Some('\t') => "tabs",
            Some(';') => "semicolons",
            Some(',') => "commas",
            Some('|') => "bars",
            _ => "blanks",
        };
        let decimals = if self.has_decimal_comma { "a comma" } else { "a point" };
        format!("{between} between cells, {decimals} before decimals")
    }
}

/// `true` if a number could be an integer with commas between thousands, such as 12,345.
fn is_grouped(number: &str) -> bool {
    let mut groups = number.trim_start_matches(['+', '-', '\u{2212}']).split(',');
    let is_whole = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    let is_first = |group: &str| (1..=3).contains(&group.len()) && !group.starts_with('0') && is_whole(group);
    groups.next().is_some_and(is_first) && groups.all(|group| group.len() == 3 && is_whole(group))
}

/// The number of lines that are examined to find the dialect: fewer if they are long, but always some, however long the
/// names of the columns are.
const SAMPLE: usize = 400;
const SAMPLE_BYTES: usize = 1 << 20;
const LEAST: usize = 8;

/// Cells, some of which are in quotes; within quotes, a delimiter is text and two quotes mean one.
fn quoted(text: &str, delimiter: char) -> Vec<Cow<'_, str>> {
    let mut cells = Vec::new();
    let mut cell = String::new();
    let mut is_inside = false;
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '"' if is_inside && chars.peek() == Some(&'"') => {
                chars.next();
                cell.push('"');
            }
            '"' if is_inside || cell.trim().is_empty() => is_inside = !is_inside,
            _ if c == delimiter && !is_inside => cells.push(Cow::Owned(std::mem::take(&mut cell).trim().to_string())),
            _ => cell.push(c),
        }
    }
    cells.push(Cow::Owned(cell.trim().to_string()));
    cells
}

/// The cells of a line of names. With blanks as delimiters, a name may have several words if names are separated by two
/// or more blanks, and a unit in brackets belongs to the name before it.
pub(super) fn names(dialect: Dialect, text: &str, width: usize) -> Vec<String> {
    let single: Vec<String> = dialect.cells_to_the_last(text).into_iter().map(Cow::into_owned).collect();
    if dialect.delimiter.is_some() || single.len() == width {
        return single;
    }
    let apart: Vec<String> = text
        .split("  ")
        .flat_map(|part| part.split('\t'))
        .map(str::trim)
        .filter(|part| !part.is_empty())
        .map(String::from)
        .collect();
    if apart.len() == width {
        return apart;
    }
    // Commas or semicolons between names only.
    for delimiter in [';', ',', '|'] {
        let cells: Vec<String> = Dialect { delimiter: Some(delimiter), ..dialect }
            .cells_to_the_last(text)
            .into_iter()
            .map(Cow::into_owned)
            .collect();
        if cells.len() == width {
            return cells;
        }
    }
    let mut joined: Vec<String> = Vec::new();
    for word in &single {
        match joined.last_mut() {
            Some(last)
                if word.starts_with(['[', '(', '/'])
                    || last.matches(['[', '(']).count() > last.matches([']', ')']).count() =>
            {
                last.push(' ');
                last.push_str(word);
            }
            _ => joined.push(word.clone()),
        }
    }
    if joined.len() == width { joined } else { single }
}
