//! Tokens of the text formats: words separated by white space, with their line numbers, without comments.
//!
//! Files are bytes here. Text that is not UTF-8 (such as a name in an old code page) is shown lossily and otherwise
//! ignored.

use std::borrow::Cow;
use std::path::Path;
use std::str::FromStr;

use crate::{FormatError, Place};

/// A word of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Token<'a> {
    bytes: &'a [u8],
    /// The line that it is on, counted from 1.
    pub line: usize,
}

impl<'a> Token<'a> {
    /// The word, with U+FFFD for bytes that are not UTF-8.
    pub fn text(&self) -> Cow<'a, str> {
        String::from_utf8_lossy(self.bytes)
    }

    /// `true` if the word is `word` in upper or lower case.
    pub fn is(&self, word: &str) -> bool {
        self.bytes.eq_ignore_ascii_case(word.as_bytes())
    }

    /// `true` if the word is a number.
    pub fn is_number(&self) -> bool {
        self.parse::<f64>().is_some()
    }

    fn parse<T: FromStr>(&self) -> Option<T> {
        std::str::from_utf8(self.bytes).ok().and_then(|text| text.parse().ok())
    }

    /// The word as an error message shows it: quoted, escaped, and not longer than a line.
    fn shown(&self) -> String {
        const LIMIT: usize = 40;
        let text = self.text();
        let short: String = text.chars().take(LIMIT).flat_map(char::escape_debug).collect();
        if text.chars().nth(LIMIT).is_some() { format!("`{short}...`") } else { format!("`{short}`") }
    }
}

/// A reader of tokens.
///
/// Carriage returns and tabs are white space; a byte-order mark at the start is skipped, and so is the end-of-file
/// character of DOS. A token that starts with the comment marker opens a comment to the end of its line.
pub(crate) struct Text<'a> {
    file: &'a Path,
    bytes: &'a [u8],
    marker: &'static str,
    at: usize,
    line: usize,
    comments: Vec<String>,
}

impl<'a> Text<'a> {
    /// Reads `bytes` of `file` with comments that start with `marker`.
    pub fn new(file: &'a Path, bytes: &'a [u8], marker: &'static str) -> Self {
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Text { file, bytes, marker, at, line: 1, comments: Vec::new() }
    }

    /// The next token; `None` at the end of the file.
    pub fn next(&mut self) -> Option<Token<'a>> {
        let (token, at, line) = self.scan();
        let marker = self.marker.as_bytes();
        let skipped = &self.bytes[self.at..token.map_or(at, |t| at - t.bytes.len())];
        for comment in skipped.split(|&b| b == b'\n').map(<[u8]>::trim_ascii).filter(|line| line.starts_with(marker)) {
            let text = String::from_utf8_lossy(&comment[marker.len()..]);
            self.comments.push(text.trim().into());
        }
        (self.at, self.line) = (at, line);
        token
    }

    /// The next token, without consuming it.
    pub fn peek(&self) -> Option<Token<'a>> {
        self.scan().0
    }

    /// The next token, its end, and its line.
    fn scan(&self) -> (Option<Token<'a>>, usize, usize) {
        let (mut at, mut line) = (self.at, self.line);
        while at < self.bytes.len() {
            let rest = &self.bytes[at..];
            if is_blank(rest[0]) {
                line += usize::from(rest[0] == b'\n');
                at += 1;
            } else if rest.starts_with(self.marker.as_bytes()) {
                at += rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
            } else {
                let length = rest.iter().position(|&b| is_blank(b)).unwrap_or(rest.len());
                return (Some(Token { bytes: &rest[..length], line }), at + length, line);
            }
        }
        (None, at, line)
    }

    /// The comments read since the last call, without their markers.
    pub fn take_comments(&mut self) -> Vec<String> {
        std::mem::take(&mut self.comments)
    }

    /// The tokens up to the end of the line of `token`, which was the last one, or up to one that `stop` recognises,
    /// separated by single spaces.
    pub fn rest_of_line(&mut self, token: Token<'_>, stop: impl Fn(Token<'_>) -> bool) -> String {
        let mut words = Vec::new();
        while let Some(next) = self.peek().filter(|&next| next.line == token.line && !stop(next)) {
            words.push(next.text().into_owned());
            self.next();
        }
        words.join(" ")
    }

    /// The rest of the line of the last token, unchanged: comment markers are ordinary characters.
    pub fn raw_rest_of_line(&mut self) -> String {
        let rest = &self.bytes[self.at..];
        let line = &rest[..rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len())];
        self.at += line.len();
        String::from_utf8_lossy(line).trim_end().into()
    }

    /// The next token, or an error that `what` is missing.
    pub fn expect(&mut self, what: &str) -> Result<Token<'a>, FormatError> {
        self.next().ok_or_else(|| self.error(self.line, "the end of the file", what))
    }

    /// The next token, which has to be `word` in upper or lower case.
    pub fn keyword(&mut self, word: &str) -> Result<Token<'a>, FormatError> {
        let token = self.expect(&format!("`{word}`"))?;
        if token.is(word) { Ok(token) } else { Err(self.unexpected(token, format!("`{word}`"))) }
    }

    /// The next token as a finite number.
    pub fn number(&mut self, what: &str) -> Result<f64, FormatError> {
        let token = self.expect(what)?;
        match token.parse::<f64>() {
            Some(number) if number.is_finite() => Ok(number),
            _ => Err(self.unexpected(token, format!("{what}, a finite number"))),
        }
    }

    /// The next token as a number that `f32` can hold.
    pub fn value(&mut self, what: &str) -> Result<f32, FormatError> {
        let number = self.number(what)?;
        let value = number as f32;
        if value.is_finite() {
            Ok(value)
        } else {
            Err(self.error(self.line, number.to_string(), format!("{what} within f32")))
        }
    }

    /// The next token as a count of `what` that follow: at least 1, and no more than fit into the rest of the file.
    pub fn count(&mut self, what: &str) -> Result<usize, FormatError> {
        let token = self.expect(&format!("the number of {what}"))?;
        match token.parse() {
            Some(count) if count > 0 => self.room(Some(count), what, token.line).map(|()| count),
            _ => Err(self.unexpected(token, format!("the number of {what}, 1 or more"))),
        }
    }

    /// Checks that `count` numbers (`None`: more than can be counted) fit into the rest of the file, one character and
    /// one space each, so that a count can be trusted before memory is allocated.
    pub fn room(&self, count: Option<usize>, what: &str, line: usize) -> Result<(), FormatError> {
        let limit = (self.bytes.len() - self.at).div_ceil(2);
        match count {
            Some(count) if count <= limit => Ok(()),
            _ => {
                let count = count.map_or("too many".into(), |count| count.to_string());
                Err(self.error(
                    line,
                    format!("a count of {count} {what}"),
                    format!("at most {limit} in the rest of the file"),
                ))
            }
        }
    }

    /// The line of the last token.
    pub fn line(&self) -> usize {
        self.line
    }

    /// An error at `line`.
    pub fn error(&self, line: usize, found: impl Into<String>, expected: impl Into<String>) -> FormatError {
        FormatError::new(self.file, Place::Line(line), found, expected)
    }

    /// An error about `token`.
    pub fn unexpected(&self, token: Token<'_>, expected: impl Into<String>) -> FormatError {
        self.error(token.line, token.shown(), expected)
    }

    /// Checks that only white space and comments are left.
    pub fn end(&mut self, expected: &str) -> Result<(), FormatError> {
        self.next().map_or(Ok(()), |token| Err(self.unexpected(token, expected)))
    }
}

/// `true` if the beginning of a text contains every one of `words` as a token, in upper or lower case.
///
/// Only the first MiB is examined, without comments; a file with a zero byte is not text.
pub(crate) fn has_words(bytes: &[u8], marker: &'static str, words: &[&str]) -> bool {
    const HEAD: usize = 1 << 20;
    let head = &bytes[..bytes.len().min(HEAD)];
    if head.contains(&0) {
        return false;
    }
    let mut text = Text::new(Path::new(""), head, marker);
    let mut missing = words.to_vec();
    while let Some(token) = text.next() {
        missing.retain(|word| !token.is(word));
        if missing.is_empty() {
            return true;
        }
    }
    false
}

/// A number with nine significant digits, which is enough to distinguish every `f32` from its neighbours, in the
/// shortest equivalent form.
pub fn nine_digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.8e}").parse().expect("a number that was just printed");
    match rounded.abs() {
        magnitude if magnitude != 0.0 && !(1e-5..1e9).contains(&magnitude) => format!("{rounded:e}"),
        _ => format!("{rounded}"),
    }
}

fn is_blank(byte: u8) -> bool {
    // 0x1a is the end-of-file character of DOS, 0x0b the vertical tab.
    byte.is_ascii_whitespace() || matches!(byte, 0x0b | 0x1a)
}

/// Adds a line of numbers.
pub(crate) fn push_row(out: &mut String, numbers: impl Iterator<Item = f64>) {
    for number in numbers {
        out.push(' ');
        out.push_str(&nine_digits(number));
    }
    out.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(bytes: &[u8]) -> Text<'_> {
        Text::new(Path::new("t"), bytes, ";;")
    }

    #[test]
    fn tokens_keep_their_lines() {
        let mut t = text(b"\xef\xbb\xbf;; one\r\nalpha\tBETA ;; two\n\n;;three\n\xff4\x1a");
        let mut seen = Vec::new();
        while let Some(token) = t.next() {
            seen.push((token.text().into_owned(), token.line));
        }
        assert_eq!(seen, [("alpha".into(), 2), ("BETA".into(), 2), ("\u{fffd}4".into(), 5)]);
        assert_eq!(t.take_comments(), ["one", "two", "three"]);
    }

    #[test]
    fn numbers_are_finite_or_an_error_with_a_line() {
        let mut t = text(b"1 -.5 +2e+001 1.E-02\n");
        let got: Vec<f64> = (0..4).map(|_| t.number("x").unwrap()).collect();
        assert_eq!(got, [1.0, -0.5, 20.0, 0.01]);
        for bad in ["nan", "NaN", "inf", "-Infinity", "1e999", "-1.#IND", "1,5", "x", "0x10", "1.5.2", "--1"] {
            let bytes = format!("\n\n{bad}");
            let error = text(bytes.as_bytes()).number("a value").unwrap_err();
            assert_eq!(error.to_string(), format!("t:3: found `{bad}`; expected a value, a finite number"));
        }
        assert_eq!(
            text(b"\n").number("a value").unwrap_err().to_string(),
            "t:2: found the end of the file; expected a value"
        );
    }

    #[test]
    fn counts_are_checked_against_the_file() {
        assert_eq!(text(b"3 1 2 3").count("knots").unwrap(), 3);
        for bad in ["0", "-1", "1.5", "2000000000 1 2", "99999999999999999999999", "4 1 2 3"] {
            assert!(text(bad.as_bytes()).count("knots").is_err(), "{bad}");
        }
    }

    #[test]
    fn long_and_odd_words_are_shown_short() {
        let word = [b"\x01\xff".as_slice(), &[b'a'; 1000]].concat();
        let message = text(&word).number("a value").unwrap_err().to_string();
        assert!(message.len() < 120 && message.contains("\\u{1}"), "{message}");
    }

    #[test]
    fn nine_digits_distinguish_every_f32() {
        for (x, expected) in
            [(0.1, "0.1"), (1.0, "1"), (0.0, "0"), (-2.5e-7, "-2.5e-7"), (3e12, "3e12"), (1.0 / 3.0, "0.333333333")]
        {
            assert_eq!(nine_digits(x), expected);
        }
        for x in [f32::MIN_POSITIVE, f32::MAX, 1.000_000_1, 16_777_217.0, 1e-45, 0.3] {
            let back: f64 = nine_digits(f64::from(x)).parse().unwrap();
            assert_eq!(back as f32, x);
        }
    }
}
