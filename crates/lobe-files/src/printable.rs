//! Text from files, made safe for a terminal.

use std::borrow::Cow;
use std::fmt::Write as _;

/// `text` made safe to show: control characters, which a terminal would obey, and characters that reorder text are
/// escaped (`\u{1b}`); other white space becomes a space.
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.chars().any(|c| is_obeyed(c) || is_blank(c)) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            _ if is_blank(c) => shown.push(' '),
            _ if is_obeyed(c) => drop(write!(shown, "{}", c.escape_unicode())),
            _ => shown.push(c),
        }
    }
    Cow::Owned(shown)
}

fn is_blank(c: char) -> bool {
    matches!(c, '\t'..='\r' | '\u{85}' | '\u{2028}' | '\u{2029}')
}

/// Control characters; marks that change the direction of text.
fn is_obeyed(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::printable;

    #[test]
    fn no_control_characters_are_left() {
        assert_eq!(printable("Größe 1 µm"), "Größe 1 µm");
        assert_eq!(printable("a\tb\r\nc"), "a b  c");
        assert_eq!(printable("\u{1b}[2Jx\u{7}\0\u{9b}\u{7f}"), "\\u{1b}[2Jx\\u{7}\\u{0}\\u{9b}\\u{7f}");
        assert_eq!(printable("\u{202e}fsb"), "\\u{202e}fsb");
    }
}
