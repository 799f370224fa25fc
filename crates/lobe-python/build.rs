//! Lets the linker of macOS leave the functions of the interpreter undefined, as the one of Linux does anyway.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    pyo3_build_config::add_extension_module_link_args();
}
