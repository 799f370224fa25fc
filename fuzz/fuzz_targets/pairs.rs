//! Pairs of directions, as `lobe eval --pairs` reads them.
#![no_main]

/// The program's own reader, included as a file because the program is not a library.
#[allow(dead_code, reason = "only the program uses all of it")]
#[path = "../../crates/lobe-cli/src/pairs.rs"]
mod pairs;

mod failure {
    pub enum Failure {
        File(String),
    }

    impl From<lobe_files::FormatError> for Failure {
        fn from(error: lobe_files::FormatError) -> Self {
            Failure::File(error.to_string())
        }
    }
}

mod message {
    pub fn say(text: impl std::fmt::Display) {
        drop(text.to_string());
    }
}

use failure::Failure;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    lobe_fuzz::in_file(bytes, |path| {
        let Ok(mut pairs) = pairs::Pairs::open(path) else { return };
        loop {
            match pairs.read() {
                Ok(some) if some.is_empty() => break,
                Ok(some) => {
                    for direction in some.iter().flat_map(|pair| [pair.wi, pair.wo]) {
                        let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
                        assert!((length - 1.0).abs() < 1e-9, "{direction:?}");
                    }
                }
                Err(Failure::File(message)) => {
                    assert!(message.contains("expected"), "{message}");
                    break;
                }
            }
        }
    });
});
