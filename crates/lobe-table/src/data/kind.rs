//! Names of representations.

use std::fmt;

/// The name of a representation, which is the same in the library, in files and on the command line.
///
/// Each representation defines its own as the constant `KIND` of its module.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Kind(&'static str);

impl Kind {
    /// A kind with this name.
    pub const fn new(name: &'static str) -> Self {
        Kind(name)
    }

    /// The name for people.
    pub const fn name(self) -> &'static str {
        self.0
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }
}
