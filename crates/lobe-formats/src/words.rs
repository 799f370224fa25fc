//! Enums whose variants are words on the command line and in sidecars.

/// Declares an enum whose variants are words on the command line and in sidecars.
macro_rules! words {
    ($(#[$doc:meta])* $name:ident: $($(#[$of:meta])* $variant:ident = $word:literal $(or $other:literal)*),* $(,)?) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name {
            $($(#[$of])* $variant),*
        }

        impl $name {
            /// The word for each variant.
            pub const WORDS: &[(&str, $name)] = &[$(($word, $name::$variant)),*];
        }

        impl std::str::FromStr for $name {
            type Err = String;

            fn from_str(word: &str) -> Result<Self, String> {
                match word.trim().to_lowercase().as_str() {
                    $($word $(| $other)* => Ok($name::$variant),)*
                    _ => Err(format!("found {word:?}; expected {}", [$($word),*].join(" or "))),
                }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(match self { $($name::$variant => $word),* })
            }
        }
    };
}
pub(crate) use words;
