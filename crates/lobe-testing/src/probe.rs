//! Reads a file and evaluates its content, which must never fail badly, whatever the bytes are. A program that uses it
//! must count memory: see [`count_memory`](crate::count_memory).

use std::path::Path;

use lobe_backend::Backend;
use lobe_formats::{Document, Format, FormatError, ReadOptions};
use lobe_table::rgl::{Reference, UniformOrder};
use lobe_table::utia::Decode;
use lobe_table::{Data, Edges, specular, specular::reference};

use crate::memory::peak;

/// Directions to the light and to the viewer: at the normal, at the mirror direction, oblique, grazing, and through the
/// surface.
const PAIRS: [[[f64; 3]; 2]; 6] = [
    [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0]],
    [[0.6, 0.0, 0.8], [-0.6, 0.0, 0.8]],
    [[0.6, 0.0, 0.8], [0.0, 0.8, 0.6]],
    [[-0.28, 0.96, 1e-9], [1.0, 0.0, 1e-12]],
    [[0.0, 0.6, 0.8], [0.48, -0.6, -0.64]],
    [[0.0, 0.0, -1.0], [0.0, -0.6, -0.8]],
];

/// Memory in bytes that a reader may use regardless of the size of the file: for its own tables and for errors.
const BASE: usize = 1 << 16;

/// The most memory, in bytes, that the reader of a format may use per byte of the file.
fn bytes_per_byte(format: Format) -> usize {
    match format {
        // Bytes of a file are bytes of values, and are copied once or twice.
        Format::Pbsdf | Format::Rgl | Format::Mbsdf | Format::Merl | Format::Utia | Format::Fourier => 16,
        // Two characters of text become a number, of which there are a few copies.
        Format::WindowXml | Format::Zemax | Format::LightTools | Format::Ssdd | Format::Ddr | Format::Sdr => 64,
        // A sample is kept once per wavelength, at most 64 times per byte; see the reader. A row becomes two rings of
        // samples.
        Format::Speos | Format::TracePro => 2048,
        // A line becomes a vertex of a triangulation with its edges and triangles.
        _ => 256,
    }
}

/// Reads `bytes`, evaluates the material at some directions and drops it. Returns the peak memory use of reading.
///
/// # Panics
/// If the reader used more memory than the size of the file justifies, or an error does not name the file.
pub fn probe(format: Format, bytes: &[u8], path: &Path) -> (Result<(), FormatError>, usize) {
    probe_with(format, bytes, path, &ReadOptions::default())
}

/// Like [`probe`], with options for the reader.
///
/// # Panics
/// The same as for [`probe`].
pub fn probe_with(
    format: Format,
    bytes: &[u8],
    path: &Path,
    options: &ReadOptions,
) -> (Result<(), FormatError>, usize) {
    let (document, peak) = peak(|| lobe_formats::read_with(format, bytes, path, options));
    let most = BASE + bytes_per_byte(format) * bytes.len();
    assert!(peak <= most, "{peak} bytes of memory for a {format} file of {}; at most {most} are allowed", bytes.len());
    let result = match document {
        Ok(document) => {
            evaluate(&document);
            Ok(())
        }
        Err(error) => {
            assert_eq!(error.file, path);
            assert!(!error.found.is_empty() && !error.expected.is_empty(), "{error:?}");
            Err(error)
        }
    };
    (result, peak)
}

fn evaluate(document: &Document) {
    document.parts.iter().for_each(|part| evaluate_data(&part.data));
}

fn evaluate_data(data: &Data) {
    drop(data.representation().sections());
    match data {
        Data::Specular(samples) => table(samples),
        Data::Mirror(data) => mirror(data),
        Data::Spherical(grid) => each(|wi, wo| drop(grid.eval(wi, wo))),
        Data::Scattered(data) => each(|wi, wo| drop(data.eval(wi, wo))),
        Data::Rgl(data) => {
            let reference = Reference::new(data);
            let mut value = vec![0.0; data.parts().channels.count()];
            each(|wi, wo| {
                reference.eval(wi, wo, &mut value);
                reference.pdf(wi, wo);
                reference.eval_cos_at(wi, wo, 550.0);
                reference.sample(wi, [0.999, 0.001], UniformOrder::Pbrt);
            });
        }
        Data::HalfDiff(data) => each(|wi, wo| {
            data.eval_nearest(wi, wo);
            data.eval_linear(wi, wo);
        }),
        Data::Utia(data) => each(|wi, wo| {
            data.eval(wi, wo, Decode::Raw);
            data.eval(wi, wo, Decode::Srgb);
        }),
        Data::Mueller(data) => each(|wi, wo| {
            data.eval(wi, wo, 550.0);
        }),
        Data::Polarised(data) => each(|wi, wo| {
            data.eval(&Edges::default(), wi, wo, 550.0);
        }),
        Data::Fourier(data) => each(|wi, wo| drop(data.eval(wi, wo))),
        Data::Zernike(data) => each(|wi, wo| drop(data.eval(wi, wo))),
        Data::Window(data) => each(|wi, wo| {
            for band in &data.bands {
                band.window.eval(wi, wo);
            }
        }),
        other => panic!("no evaluation of {other:?}"),
    }
}

fn each(mut eval: impl FnMut([f64; 3], [f64; 3])) {
    PAIRS.iter().for_each(|&[wi, wo]| eval(wi, wo));
}

/// Evaluates with the reference, and in lanes.
fn table(samples: &specular::Data) {
    let edges = Edges::default();
    let channels = samples.channels().count();
    let (mut exact, mut rounded) = (vec![0.0; channels], vec![0.0; channels]);
    each(|wi, wo| reference::eval(samples, &edges, wi, wo, &mut exact));
    // A table may have more values than a lane can index, or a circle that cannot be closed.
    if let Ok(table) = specular::Table::new(samples, &edges) {
        let single = |direction: [f64; 3]| direction.map(|x| x as f32);
        each(|wi, wo| table.eval(Backend::scalar(), single(wi), single(wo), &mut rounded));
    }
}

fn mirror(data: &lobe_table::mirror::Data) {
    [-1.0, 0.0, 0.7, 9.0, f64::NAN].iter().for_each(|&angle| drop(data.at(angle, angle)));
}
