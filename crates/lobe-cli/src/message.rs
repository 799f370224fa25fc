//! Output of the program. Text from files is escaped before it reaches a terminal: control characters that would move
//! the cursor or set the title are shown, not obeyed. A closed or full output does not stop the work.

use std::fmt::Display;
use std::io::{self, BufWriter, StdoutLock, Write, stderr, stdout};

/// Prints to standard error. A failure to do so is ignored.
pub fn say(text: impl Display) {
    let _ = writeln!(stderr().lock(), "{}", escaped(&text.to_string()));
}

/// Standard output.
pub struct Out {
    stdout: BufWriter<StdoutLock<'static>>,
    is_json: bool,
}

/// Standard output for JSON, which escapes text itself, or for people.
pub fn out(is_json: bool) -> Out {
    Out { stdout: BufWriter::new(stdout().lock()), is_json }
}

impl Write for Out {
    /// Text arrives in whole characters, as [`Display`] wrote it.
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

/// The text, with control characters and characters that change the direction of writing shown as in `\u{1b}`.
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
    fn control_characters_are_shown() {
        let text = "\u{1b}]0;title\u{7}\u{1b}[31mred\r\u{9b}2J\u{202e}end\n\tα 5 °";
        let expected = "\\u{1b}]0;title\\u{7}\\u{1b}[31mred\\r\\u{9b}2J\\u{202e}end\n\tα 5 °";
        assert_eq!(escaped(text), expected);
    }
}
