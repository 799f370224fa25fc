//! The examples run. Each checks what it computes.

macro_rules! examples {
    ($($name:ident $path:literal;)*) => {$(
        #[path = $path]
        mod $name;

        #[test]
        fn $name() {
            $name::main().unwrap();
        }
    )*};
}

examples! {
    batch "../../examples/batch.rs";
    convert "../../examples/convert.rs";
    kernel "../../examples/kernel.rs";
    open "../../examples/open.rs";
    sample "../../examples/sample.rs";
}
