//! Runs the tests in Python on the module that cargo has built, and compares the bits of values between languages.

mod bits;
mod build;
mod package;

use std::io::Write as _;
use std::path::Path;

use package::Package;

/// Reports that a test, or part of one, is skipped. It bypasses the test harness, which hides the output of passing
/// tests.
fn skipped(why: &str) {
    // A test must not fail because standard error is closed.
    let _ = writeln!(std::io::stderr(), "SKIPPED: {why}");
}

#[test]
fn the_tests_in_python_pass() {
    let package = match Package::new(&["numpy", "pytest"]) {
        Ok(package) => package,
        Err(why) => return skipped(&format!("the tests in Python: {why}")),
    };
    let mut pytest = package.python();
    // Its output shows which tests it skips, and why.
    pytest.args(["-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider"]).arg(Path::new(env!("CARGO_MANIFEST_DIR")));
    if let Some(program) = build::program() {
        pytest.env("LOBE_PROGRAM", program);
    }
    let status = pytest.status().expect("an interpreter");
    assert!(status.success(), "{pytest:?}: {status}");
}
