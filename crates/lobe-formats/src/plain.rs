//! Conversion of texts to the form that readers expect: UTF-8 without a byte-order mark, with line feeds at the ends of
//! lines.

use std::borrow::Cow;

/// The same text in UTF-8 without a byte-order mark and with a line feed at the end of each line; other content is
/// unchanged.
///
/// UTF-16 is recognised by its mark, or by most characters at the start being ASCII in two bytes. Carriage returns
/// become line feeds if there are no line feeds.
pub fn text(bytes: &[u8]) -> Cow<'_, [u8]> {
    if let Some(order) = utf_16(bytes) {
        let units = bytes.chunks_exact(2).map(|pair| match order {
            Order::Little => u16::from_le_bytes([pair[0], pair[1]]),
            Order::Big => u16::from_be_bytes([pair[0], pair[1]]),
        });
        let text: String = char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        return Cow::Owned(match has_only_returns(text.as_bytes()) {
            true => text.replace('\r', "\n").into_bytes(),
            false => text.as_bytes().to_vec(),
        });
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match has_only_returns(bytes) {
        true => Cow::Owned(bytes.iter().map(|&byte| if byte == b'\r' { b'\n' } else { byte }).collect()),
        false => Cow::Borrowed(bytes),
    }
}

/// The text of bytes that [`text`] returned: UTF-8, or the Windows code page of western Europe, of which Latin-1 is a part.
/// A character that is cut at the end is left out.
pub fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.into(),
        Err(error) if error.error_len().is_none() => String::from_utf8_lossy(&bytes[..error.valid_up_to()]),
        Err(_) => bytes.iter().map(|&byte| of_windows(byte)).collect::<String>().into(),
    }
}

/// A character of code page 1252.
fn of_windows(byte: u8) -> char {
    /// From 0x80 to 0x9f; bytes without a character are control characters, as in Latin-1.
    const SPECIAL: [char; 32] = [
        '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}', '\u{90}', '‘',
        '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
    ];
    match byte {
        0x80..=0x9f => SPECIAL[usize::from(byte - 0x80)],
        _ => char::from(byte),
    }
}

enum Order {
    Little,
    Big,
}

/// The byte order of UTF-16 text; `None` for other text.
fn utf_16(bytes: &[u8]) -> Option<Order> {
    const SAMPLE: usize = 64;
    match bytes {
        [0xff, 0xfe, rest @ ..] if !rest.starts_with(&[0, 0]) => return Some(Order::Little),
        [0xfe, 0xff, ..] => return Some(Order::Big),
        _ => {}
    }
    let sample = &bytes[..bytes.len().min(SAMPLE) & !1];
    let is = |zero: usize| {
        let is_ascii = |byte: u8| (b' '..=b'~').contains(&byte) || byte.is_ascii_whitespace();
        let ascii = sample.chunks_exact(2).filter(|pair| pair[zero] == 0 && is_ascii(pair[1 - zero])).count();
        // Up to a quarter may be accented or Greek letters, and signs such as that of degrees.
        sample.len() >= 16 && 8 * ascii >= 3 * sample.len() && sample.chunks_exact(2).all(|pair| pair != [0, 0])
    };
    match () {
        () if is(1) => Some(Order::Little),
        () if is(0) => Some(Order::Big),
        () => None,
    }
}

/// `true` if a text has carriage returns but no line feeds.
fn has_only_returns(bytes: &[u8]) -> bool {
    let is_text = |&byte: &u8| byte != 0 && byte != b'\n';
    bytes.iter().all(is_text) && bytes.contains(&b'\r')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_all_encodings_are_the_same() {
        let wanted = "θ_i [°],theta_o,phi_o,f and a comment\n1,2 \u{b0}\n";
        let of = |units: Vec<[u8; 2]>| units.concat();
        let little = of(wanted.encode_utf16().map(u16::to_le_bytes).collect());
        let big = of(wanted.encode_utf16().map(u16::to_be_bytes).collect());
        let texts = [
            [&b"\xef\xbb\xbf"[..], wanted.as_bytes()].concat(),
            [&b"\xff\xfe"[..], &little[..]].concat(),
            [&b"\xfe\xff"[..], &big[..]].concat(),
            little,
            big,
            wanted.replace('\n', "\r").into_bytes(),
        ];
        for bytes in texts {
            assert_eq!(text(&bytes), wanted.as_bytes(), "{bytes:?}");
        }
        assert_eq!(decoded(b"30\xb0 \x96 \xb5m \x89"), "30° – µm ‰");
        assert_eq!(decoded("µ°".as_bytes()), "µ°");
        assert_eq!(decoded(b"a\xc2"), "a");
        for other in [&b"a\r\nb\r\n"[..], b"\0\r\x01", b"", b"\xff\xfe\0\0a\0\0\0", b"Z\0\0\0Z\0\0\0\xb4\0\0\0\0\0\0\0"]
        {
            assert_eq!(text(other), other);
        }
    }
}
