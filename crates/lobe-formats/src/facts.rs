//! Facts that people wrote into the header of a text file, kept for `Document::source`.

/// Names and values.
pub(crate) type Facts = Vec<(String, String)>;

/// The comments among the first lines, up to the first line that is neither empty nor a comment, without empty ones and
/// those that are `structure`.
pub(crate) fn comments(bytes: &[u8], marker: &str, structure: impl Fn(&str) -> bool) -> Facts {
    let head = bytes.split(|&byte| matches!(byte, b'\n' | b'\r')).map(<[u8]>::trim_ascii);
    let lines = head.take_while(|line| line.is_empty() || line.starts_with(marker.as_bytes()));
    let text = |line: &[u8]| String::from_utf8_lossy(line).trim_start_matches(marker).trim().to_string();
    let worded = lines.map(text).filter(|text| text.chars().any(char::is_alphanumeric) && !structure(text));
    worded.map(|text| ("comment".into(), text)).collect()
}

/// Lines with a name and a value, up to the first one without a name.
pub(crate) fn named<'a>(bytes: &'a [u8], name: impl Fn(&str) -> Option<String> + 'a) -> Facts {
    let lines = bytes.split(|&byte| matches!(byte, b'\n' | b'\r')).map(|line| String::from_utf8_lossy(line));
    let fact = |line: std::borrow::Cow<'_, str>| {
        let (key, value) = line.trim().split_once(char::is_whitespace).unwrap_or((line.trim(), ""));
        Some((name(key)?, value.trim().trim_matches('"').to_string()))
    };
    lines.filter(|line| !line.trim().is_empty()).map_while(fact).filter(|(_, value)| !value.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_named_lines_end_where_the_data_begin() {
        let text = b"# A paint\r\n#\n#   of 1995  \n# num wls\n1\n# later\n";
        let found = comments(text, "#", |text| text == "num wls");
        assert_eq!(found, [("comment".into(), "A paint".into()), ("comment".into(), "of 1995".to_string())]);
        let found = named(b"#SAMPLE \"My tape\"\n#DIM 3 1\n#EMPTY\n0 1 2\n#LATE x\n", |key| {
            key.strip_prefix('#').map(String::from)
        });
        assert_eq!(found, [("SAMPLE".into(), "My tape".into()), ("DIM".into(), "3 1".to_string())]);
    }
}
