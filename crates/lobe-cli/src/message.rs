//! What the program says, and to whom. Text of a file is never sent to the terminal as it is: what would move its cursor or
//! set its title is shown, not done. Nor does it matter to the work whether somebody listens.

use std::fmt::Display;
use std::io::{self, BufWriter, StdoutLock, Write, stderr, stdout};

/// Says something on standard error. That nobody can read it is no reason to stop.
pub fn say(text: impl Display) {
    let _ = writeln!(stderr().lock(), "{}", escaped(&text.to_string()));
}

/// The standard output.
pub struct Out {
    stdout: BufWriter<StdoutLock<'static>>,
    is_json: bool,
}

/// The standard output for JSON, which escapes text itself, or for people.
pub fn out(is_json: bool) -> Out {
    Out { stdout: BufWriter::new(stdout().lock()), is_json }
}

impl Write for Out {
    /// Text arrives in whole characters, as [`Display`] has written it.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.is_json || !bytes.iter().any(|byte| is_suspicious(*byte)) {
            return self.stdout.write(bytes);
        }
        self.stdout.write_all(escaped(&String::from_utf8_lossy(bytes)).as_bytes())?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stdout.flush()
    }
}

/// A byte that may be part of a character to be escaped.
fn is_suspicious(byte: u8) -> bool {
    !matches!(byte, b'\n' | b'\t' | b' '..=b'~')
}

/// The text, its control characters and those that turn the order of writing shown as `\u{1b}`.
pub fn escaped(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for character in text.chars() {
        let turns = matches!(character, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        if turns || character.is_control() && !matches!(character, '\n' | '\t') {
            shown.extend(character.escape_default());
        } else {
            shown.push(character);
        }
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_would_obey_is_shown() {
        let text = "\u{1b}]0;title\u{7}\u{1b}[31mred\r\u{9b}2J\u{202e}end\n\tα 5 °";
        let expected = "\\u{1b}]0;title\\u{7}\\u{1b}[31mred\\r\\u{9b}2J\\u{202e}end\n\tα 5 °";
        assert_eq!(escaped(text), expected);
    }
}
