//! Tensor files with any fields; a file that is read and written again must be the same.
#![no_main]

use std::path::Path;

use lobe_formats::tensor;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let file = Path::new("fuzz");
    let Ok(tensors) = tensor::read(bytes, file) else { return };
    // Fields may overlap, but the written file has each of them in full.
    if tensors.fields.iter().map(|field| field.data.len()).sum::<usize>() > 1 << 20 {
        return;
    }
    let written = tensors.to_bytes().expect("a file that was read can be written");
    let again = tensor::read(&written, file).expect("a file that was written can be read");
    for (field, same) in tensors.fields.iter().zip(&again.fields) {
        assert_eq!(
            (&field.name, field.dtype, &field.shape, &field.data),
            (&same.name, same.dtype, &same.shape, &same.data)
        );
    }
    assert_eq!(tensors.fields.len(), again.fields.len());
});
