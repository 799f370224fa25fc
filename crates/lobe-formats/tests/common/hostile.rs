//! What every reader must survive.
#![allow(dead_code, reason = "every test program uses a part of this")]

use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

/// Reads every beginning of `bytes`. `read` says whether it found a whole file; at least the first half must not be one.
pub fn truncations(bytes: &[u8], read: impl Fn(&[u8]) -> bool) {
    assert!(read(bytes), "the whole file must be readable");
    for end in 0..bytes.len() {
        let complete = read(&bytes[..end]);
        assert!(!complete || end > bytes.len() / 2, "{end} of {} bytes are taken for a whole file", bytes.len());
    }
}

/// Reads `bytes` with runs of it replaced, removed and doubled, some replaced by text that has met readers before.
pub fn mutations(bytes: &[u8], read: impl Fn(&[u8]) -> bool) {
    let words: [&[u8]; 14] = [
        b"nan",
        b"-1.#IND",
        b"inf",
        b"1e999",
        b"-1",
        b"99999999999999999999",
        b"4294967296",
        b"{",
        b"}",
        b"\n",
        b"\0",
        b",",
        b"\xff\xfe",
        b"2000000000",
    ];
    let position = 0..bytes.len();
    let edit = (position, 0_usize..12, prop::sample::select(words.to_vec()), any::<u8>());
    let edits = prop::collection::vec(edit, 1..6);
    let mut runner = TestRunner::new(Config { cases: 2000, failure_persistence: None, ..Config::default() });
    let result = runner.run(&edits, |edits| {
        let mut mutant = bytes.to_vec();
        for (at, length, word, kind) in edits {
            let at = at.min(mutant.len());
            let end = (at + length).min(mutant.len());
            match kind % 4 {
                0 => drop(mutant.splice(at..end, word.iter().copied())),
                1 => drop(mutant.splice(at..end, [])),
                2 => drop(mutant.splice(at..end, [kind; 3])),
                _ => drop(mutant.splice(at..at, bytes[..length.min(bytes.len())].iter().copied())),
            }
        }
        read(&mutant);
        Ok(())
    });
    result.unwrap_or_else(|error| panic!("{error}"));
}
