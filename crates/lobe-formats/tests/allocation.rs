//! No reader allocates more than a small multiple of the size of its file, whatever the file claims.

use lobe_formats::{mbsdf, merl, pbsdf, rgl, speos, tensor, window_xml};
use lobe_testing::memory::peak;
use std::path::Path;

lobe_testing::count_memory!();

/// A tensor file whose fields all share the same data, with any shapes.
fn overlapping(names: &[String], dtype: u8, shape: &[u64], data: usize) -> Vec<u8> {
    let mut bytes = b"tensor_file\0\x01\x00".to_vec();
    bytes.extend_from_slice(&(names.len() as u32).to_le_bytes());
    let headers: usize = names.iter().map(|name| 13 + name.len() + 8 * shape.len()).sum();
    for name in names {
        bytes.extend_from_slice(&(name.len() as u16).to_le_bytes());
        bytes.extend_from_slice(name.as_bytes());
        bytes.extend_from_slice(&(shape.len() as u16).to_le_bytes());
        bytes.push(dtype);
        bytes.extend_from_slice(&(18 + headers as u64).to_le_bytes());
        shape.iter().for_each(|n| bytes.extend_from_slice(&n.to_le_bytes()));
    }
    bytes.resize(bytes.len() + data, 0);
    bytes
}

/// Reads a file, and returns whether the outcome is as expected.
type Read = fn(&[u8], &Path) -> bool;

/// A single test, so that no other thread allocates meanwhile.
#[test]
fn memory_follows_the_size_of_the_file() {
    let file = Path::new("hostile.file");
    let names: Vec<String> = (0..2000).map(|i| format!("field{i}")).collect();
    let many = overlapping(&names, 10, &[10_000], 40_000);
    let fields = ["phi_i", "theta_i", "ndf", "sigma", "vndf", "luminance", "rgb", "description", "jacobian"];
    let fields = fields.map(String::from);
    let named = overlapping(&fields, 10, &[1, 4, 50, 50], 40_000);
    let flat = overlapping(&fields, 10, &[10_000], 40_000);
    let polarised = overlapping(&["M", "wvls", "phi_d", "theta_d", "theta_h"].map(String::from), 10, &[0, 1 << 40], 64);
    let block =
        [b"NVIDIA ARC MBSDF V1\nMBSDF_DATA=\n\x01\x00\x00\x00\xff\xff\x00\x00\xff\xff\x00\x00".as_slice(), &[7; 999]];
    let header: Vec<u8> = [90i32, 90, 180].iter().flat_map(|n| n.to_le_bytes()).collect();
    let short: Vec<String> = (0..4000).map(|i| format!("{i:x}")).collect();
    let headers = overlapping(&short, 10, &[], 4);
    let blocks_of_one = format!(
        "<WindowElement><WavelengthData><Wavelength>{}</Wavelength>{}</WavelengthData></WindowElement>",
        "visible".repeat(10_000),
        "<WavelengthDataBlock/>".repeat(5_000)
    );
    // A thousand samples in one table, and a spectrum of four thousand wavelengths for all of them.
    let azimuths: String = (0..500).map(|i| format!("{i} ")).collect();
    let ones = "1 ".repeat(500);
    let product = format!(
        "OPTIS - Anisotropic BSDF surface file v8.0\n0\n\n0\n\n0 1 0\n1 0\n1\n1\n0\n1\n0\n0 0\n\n4000\n{}2 500\n\
         {azimuths}\n0 {ones}\n45 {ones}",
        "1 1\n".repeat(4_000),
    );
    let cases: [(&str, Vec<u8>, Read); 9] = [
        ("a name that many blocks share", blocks_of_one.into(), |bytes, file| {
            window_xml::read(bytes, file).is_err_and(|error| error.expected == "a direction and values")
        }),
        ("samples times wavelengths", product.into(), |bytes, file| {
            speos::read(bytes, file).is_err_and(|error| error.found == "1000 samples at 4000 wavelengths")
        }),
        ("nothing but the headers of fields", headers, |bytes, file| tensor::read(bytes, file).is_ok()),
        ("many fields over the same data", many, |bytes, file| tensor::read(bytes, file).is_ok()),
        ("all fields with four dimensions", named, |bytes, file| rgl::read(bytes, file).is_err()),
        ("all fields with one dimension", flat, |bytes, file| rgl::read(bytes, file).is_err()),
        ("angles that are not there", polarised, |bytes, file| pbsdf::read(bytes, file).is_err()),
        ("a block larger than its file", block.concat(), |bytes, file| mbsdf::read(bytes, file).is_err()),
        ("a header without its values", header, |bytes, file| merl::read(bytes, file).is_err()),
    ];
    for (name, bytes, read) in cases {
        let ((), used) = peak(|| assert!(read(&bytes, file), "{name}"));
        println!("{name}: {used} bytes for a file of {}", bytes.len());
        // The header of a field, of 16 bytes or more, becomes a structure of about 130. Even a short file needs an
        // error message.
        let times = match name {
            "nothing but the headers of fields" => 12,
            // An empty block of 22 characters becomes a structure of about 200.
            "a name that many blocks share" => 24,
            "samples times wavelengths" => 8,
            _ => 4,
        };
        assert!(used < times * bytes.len() + 4096, "{name}: {used} bytes for a file of {}", bytes.len());
    }
}
