//! Damage that every reader must survive.

/// Reads every prefix of `bytes`. `read` says whether it found a whole file; at least the first half must not be one.
pub fn truncations(bytes: &[u8], read: impl Fn(&[u8]) -> bool) {
    assert!(read(bytes), "the whole file must be readable");
    for end in 0..bytes.len() {
        let complete = read(&bytes[..end]);
        assert!(!complete || end > bytes.len() / 2, "{end} of {} bytes are accepted as a whole file", bytes.len());
    }
}
