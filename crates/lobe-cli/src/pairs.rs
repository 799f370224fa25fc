//! Pairs of directions, from the command line or from a CSV file.

use std::io::{BufRead, BufReader, Cursor, Read, stdin};
use std::path::{Path, PathBuf};

use crate::failure::Failure;
use crate::message::say;

/// Unit vectors that point away from the surface, normal on +z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// To the light.
    pub wi: [f64; 3],
    /// To the viewer.
    pub wo: [f64; 3],
}

/// Parses `N` finite numbers separated by commas.
pub fn parse_numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let parts: Vec<&str> = text.split(',').collect();
    let parts: [&str; N] = parts
        .try_into()
        .map_err(|parts: Vec<&str>| format!("{} numbers; expected {N} separated by commas", parts.len()))?;
    let mut numbers = [0.0; N];
    for (number, part) in numbers.iter_mut().zip(parts) {
        *number = parse_number(part)?;
    }
    Ok(numbers)
}

/// Parses a direction of any length but zero; the result has length 1.
pub fn parse_direction(text: &str) -> Result<[f64; 3], String> {
    normalise(parse_numbers(text)?)
}

fn parse_number(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.trim().parse().ok();
    number
        .filter(|number| number.is_finite())
        .ok_or_else(|| format!("found `{}`; expected a finite number", text.trim()))
}

fn normalise(v: [f64; 3]) -> Result<[f64; 3], String> {
    // Scaled by the largest component first, so that no square overflows or vanishes.
    let largest = v.iter().fold(0.0_f64, |largest, c| largest.max(c.abs()));
    if largest == 0.0 {
        return Err("found a direction of zero length; expected a non-zero vector".into());
    }
    let v = v.map(|c| c / largest);
    let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
    Ok(v.map(|c| c / length))
}

/// The names of columns, in their default order.
const NAMES: [&str; 6] = ["wi.x", "wi.y", "wi.z", "wo.x", "wo.y", "wo.z"];
/// The number of pairs that are read before they are evaluated.
const BATCH: usize = 1 << 16;
/// Bytes of the longest line, so that an endless input is not read into memory.
const LONGEST: u64 = 1 << 16;

/// Pairs in six columns, wi and wo, from a file, or from standard input if the name is `-`.
///
/// Columns are separated by commas, semicolons, tabs or spaces. A first line without numbers names them: `wi.x` or
/// `wi_x` or `wix`, in any order, possibly among others. Lines that start with `#` are comments.
pub struct Pairs {
    path: PathBuf,
    input: BufReader<Box<dyn Read>>,
    /// `true` if the sender may wait for an answer before it sends the next pair.
    is_stream: bool,
    line: usize,
    columns: Option<Columns>,
}

/// The position of each number of a pair in a line.
struct Columns {
    delimiter: Delimiter,
    order: [usize; 6],
    count: usize,
}

#[derive(Clone, Copy, PartialEq)]
enum Delimiter {
    Character(char),
    Spaces,
}

impl Pairs {
    /// Opens a file, or standard input.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        let is_stream = path == Path::new("-");
        let input: Box<dyn Read> = if is_stream {
            Box::new(stdin().lock())
        } else {
            // Spreadsheets write UTF-16, byte-order marks, and bare carriage returns.
            Box::new(Cursor::new(lobe_formats::plain_text(&lobe_files::read(path)?).into_owned()))
        };
        let capacity = if is_stream { 1 << 16 } else { 1 << 20 };
        let input = BufReader::with_capacity(capacity, input);
        Ok(Pairs { path: path.into(), input, is_stream, line: 0, columns: None })
    }

    /// The next pairs: from a file as many as are evaluated at once, from a stream those that have arrived. None at the
    /// end.
    pub fn read(&mut self) -> Result<Vec<Pair>, Failure> {
        let mut pairs = Vec::new();
        while pairs.len() < BATCH {
            let is_waiting = self.is_stream && !self.input.buffer().contains(&b'\n');
            if is_waiting && !pairs.is_empty() {
                break;
            }
            let Some(line) = self.line()? else { break };
            let line = line.trim();
            if !line.is_empty() && !line.starts_with('#') {
                let failed = |what: String| Failure::File(format!("{}:{}: {what}", self.path.display(), self.line));
                pairs.extend(pair(&mut self.columns, line).map_err(failed)?);
            }
        }
        Ok(pairs)
    }

    fn line(&mut self) -> Result<Option<String>, Failure> {
        self.line += 1;
        let failed = |what: String| Failure::File(format!("{}:{}: {what}", self.path.display(), self.line));
        let mut bytes = Vec::new();
        let read = self.input.by_ref().take(LONGEST).read_until(b'\n', &mut bytes);
        match read.map_err(|error| failed(error.to_string()))? {
            0 => return Ok(None),
            length if length as u64 == LONGEST => {
                return Err(failed(format!("found a line of {LONGEST} bytes or more; expected six numbers")));
            }
            _ => {}
        }
        let bytes = if self.line == 1 { bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes) } else { &bytes };
        let text = String::from_utf8(bytes.to_vec());
        text.map(Some).map_err(|_| failed("found bytes that are not UTF-8; expected six numbers".into()))
    }
}

/// The pair of a line; `None` if it names the columns.
fn pair(columns: &mut Option<Columns>, line: &str) -> Result<Option<Pair>, String> {
    let Some(Columns { delimiter, order, count }) = columns else {
        let delimiter = delimiter(line);
        let fields = split(line, delimiter);
        let is_header = fields.iter().all(|field| parse(field, delimiter).is_none());
        let order = if is_header { order(&fields)? } else { [0, 1, 2, 3, 4, 5] };
        let count = if is_header { fields.len() } else { 6 };
        *columns = Some(Columns { delimiter, order, count });
        return if is_header { Ok(None) } else { pair(columns, line) };
    };
    let fields = split(line, *delimiter);
    if fields.len() != *count {
        let names = if *count == 6 { ", wi and wo" } else { ", as in the first line" };
        return Err(format!("found {} columns; expected {count}{names}", fields.len()));
    }
    let mut numbers = [0.0; 6];
    for (number, column) in numbers.iter_mut().zip(*order) {
        let found = parse(fields[column], *delimiter).filter(|number| number.is_finite());
        *number = found.ok_or_else(|| format!("found `{}`; expected a finite number", fields[column]))?;
    }
    let [a, b, c, d, e, f] = numbers;
    Ok(Some(Pair { wi: normalise([a, b, c])?, wo: normalise([d, e, f])? }))
}

/// The separator of the fields of a line. A comma between digits is a decimal comma if there are semicolons.
fn delimiter(line: &str) -> Delimiter {
    match [';', ','].map(|character| line.contains(character)) {
        [true, _] => Delimiter::Character(';'),
        _ if line.matches('\t').count() >= 5 => Delimiter::Character('\t'),
        [_, true] => Delimiter::Character(','),
        _ => Delimiter::Spaces,
    }
}

fn split(line: &str, delimiter: Delimiter) -> Vec<&str> {
    match delimiter {
        Delimiter::Character(character) => line.split(character).map(|field| field.trim().trim_matches('"')).collect(),
        Delimiter::Spaces => line.split_whitespace().collect(),
    }
}

fn parse(field: &str, delimiter: Delimiter) -> Option<f64> {
    if delimiter == Delimiter::Character(',') { field.parse().ok() } else { field.replace(',', ".").parse().ok() }
}

/// The columns that hold wi and wo, from their names. If the names say nothing, the columns are in their default order.
fn order(names: &[&str]) -> Result<[usize; 6], String> {
    let plain = |name: &str| -> String { name.chars().filter(char::is_ascii_alphanumeric).collect() };
    let found = NAMES.map(|wanted| {
        let is_wanted = |name: &&str| plain(name).eq_ignore_ascii_case(&plain(wanted));
        let mut places = names.iter().enumerate().filter(|(_, name)| is_wanted(name)).map(|(place, _)| place);
        (places.next(), places.next())
    });
    let wanted = NAMES.join(", ");
    if found.iter().any(|(_, second)| second.is_some()) {
        return Err(format!("found the columns {}; expected each of {wanted} once", names.join(", ")));
    }
    if found.iter().all(|(first, _)| first.is_none()) && names.len() == 6 {
        say(format_args!("warning: the columns {} are assumed to be {wanted}", names.join(", ")));
        return Ok([0, 1, 2, 3, 4, 5]);
    }
    let mut order = [0; 6];
    for (place, (first, _)) in order.iter_mut().zip(found) {
        *place = first.ok_or_else(|| format!("found the columns {}; expected {wanted}", names.join(", ")))?;
    }
    Ok(order)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<Pair>, String> {
        let mut columns = None;
        let pairs = text.lines().map(|line| pair(&mut columns, line));
        Ok(pairs.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
    }

    #[test]
    fn columns_are_found_by_name() {
        let expected = [Pair { wi: [0.6, 0.0, 0.8], wo: [0.0, 0.0, 1.0] }];
        for text in [
            "0.6,0,0.8,0,0,1",
            "0.6;0;0.8;0;0;1",
            "0,6;0;0,8;0;0;1",
            "0.6 0\t0.8   0 0 1",
            "0.6\t0\t0.8\t0\t0\t1",
            "wo.x,wo.y,wo.z,wi.x,wi.y,wi.z\n0,0,1,0.6,0,0.8",
            "WIX;WIY;WIZ;WOX;WOY;WOZ\n0,6;0;0,8;0;0;1",
            "\"n\",\"wi_z\",\"wi_y\",\"wi_x\",\"wo_x\",\"wo_y\",\"wo_z\",f\n7,0.8,0,0.6,0,0,1,x",
            "a,b,c,d,e,f\n0.6,0,0.8,0,0,1",
        ] {
            let found = read(text).unwrap_or_else(|error| panic!("{text}: {error}"));
            assert_eq!(found.len(), 1, "{text}");
            let close = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
            assert!(close(found[0].wi, expected[0].wi) && close(found[0].wo, expected[0].wo), "{text}: {found:?}");
        }
        for (text, expected) in [
            ("wi.x,wi.y,wi.z,wo.x,wo.y\n", "expected wi.x"),
            ("wi.x,wi.y,wi.z,wo.x,wo.y,wo.y\n", "each of wi.x"),
            ("theta_i,phi_i,theta_o,phi_o\n0,0,0,0", "found the columns theta_i, phi_i"),
            ("0,0,1,0,0,1,0\n", "found 7 columns; expected 6"),
            ("wi.x,wi.y,wi.z,wo.x,wo.y,wo.z,n\n0,0,1,0,0,1\n", "expected 7, as in the first line"),
            ("0,0,1,0,0,x\n", "found `x`; expected a finite number"),
        ] {
            let error = read(text).expect_err(text);
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
