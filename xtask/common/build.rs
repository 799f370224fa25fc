//! Records the compiler that builds the kernels measured by the report.

use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let version = Command::new(rustc).arg("-V").output();
    let version = version.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned()).unwrap_or_default();
    println!("cargo::rustc-env=LOBE_RUSTC={version}");
    let variable = |name| std::env::var(name).unwrap_or_default();
    println!("cargo::rustc-env=LOBE_TARGET={}", variable("TARGET"));
    println!("cargo::rustc-env=LOBE_OPT_LEVEL={}", variable("OPT_LEVEL"));
}
