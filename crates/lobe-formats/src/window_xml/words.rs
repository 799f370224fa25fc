//! Numbers in the text of an element.

/// The tokens separated by white space and commas, each with its offset.
pub(super) fn numbers(content: &str) -> impl Iterator<Item = (usize, &str)> {
    let is_separator = |character: char| character.is_ascii_whitespace() || character == ',';
    content
        .split(is_separator)
        .filter(|token| !token.is_empty())
        .map(|token| (token.as_ptr() as usize - content.as_ptr() as usize, token))
}

/// A finite `f32`.
pub(super) fn number(token: &str) -> Option<f32> {
    token.parse().ok().filter(|value: &f32| value.is_finite())
}

/// A token as an error shows it, cut short.
pub(super) fn quoted(token: &str) -> String {
    format!("\"{}\"", lobe_files::excerpt(token, 32))
}
