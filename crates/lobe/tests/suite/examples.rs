//! The examples run. Each checks what it computes.

macro_rules! examples {
    ($($(#[$attribute:meta])* $name:ident $path:literal;)*) => {$(
        #[path = $path]
        mod $name;

        $(#[$attribute])*
        #[test]
        fn $name() {
            $name::main().unwrap();
        }
    )*};
}

examples! {
    batch "../../examples/batch.rs";
    #[cfg_attr(target_os = "wasi", ignore = "WASI has no folder for temporary files")]
    convert "../../examples/convert.rs";
    kernel "../../examples/kernel.rs";
    open "../../examples/open.rs";
    sample "../../examples/sample.rs";
}
