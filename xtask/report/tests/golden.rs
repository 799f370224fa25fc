//! Compares files of every format in the lanes of every backend with the programs that define the formats.

use std::io::Write as _;

use lobe::Backend;
use xtask_report::golden::{compare, folder};

#[test]
fn all_formats_agree_with_the_programs_that_define_them() {
    for backend in Backend::available().into_iter().flat_map(|backend| [backend.fused(), backend.strict()]) {
        let comparisons = compare(backend).unwrap_or_else(|error| panic!("{error:#}"));
        if comparisons.is_empty() {
            // Bypasses the test harness, which hides the output of passing tests.
            let _ = writeln!(std::io::stderr(), "SKIPPED: no answers in {}; set LOBE_SHARED", folder().display());
            return;
        }
        let form = if backend.is_strict() { "strict" } else { "fused" };
        for comparison in &comparisons {
            println!("{backend} {form}: {comparison:?}");
        }
        let wrong: Vec<_> = comparisons.iter().filter(|comparison| !comparison.ok()).collect();
        assert!(wrong.is_empty(), "{backend} {form}: {wrong:#?}");
        assert!(comparisons.len() >= 40, "{} files were compared", comparisons.len());
    }
}
