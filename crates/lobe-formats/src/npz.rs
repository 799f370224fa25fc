//! NumPy `.npz`: the knots and values of any document as named arrays, for `numpy.load`. Written only.
//!
//! Angles are in radians and values `f` in 1/sr unless their name says otherwise; every file has `kind` (text). Grids
//! in specular coordinates have `sigma`, `psi`, `theta`, `phi` and `values [sigma, psi, theta, phi, channel]`, with
//! `channels` (text), `scatter` (text) and, if channels are wavelengths, `wavelengths` in nm; grids in spherical
//! coordinates the same with `theta_i`, `phi_i`, `theta_o`, `phi_o`; scattered samples have one of each angle per
//! sample. Other kinds use the names of their own format. Parts of a sheet have a number and a dot before the name.

use std::io;
use std::path::Path;

use lobe_table::specular::{self, AXIS_NAMES};
use lobe_table::spherical;
use lobe_table::window::klems::AngleBasis;
use lobe_table::window::{self, Block, Component};
use lobe_table::{Channels, Data, Scatter, Side};

use crate::spec::{FormatSpec, Writer, either};
use crate::zip::Archive;
use crate::{Document, FormatError};
use lobe_files::{unwritable, write_whole};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "NumPy npz",
    word: "npz",
    extensions: &["npz"],
    matches: |_| false,
    read: None,
    read_set: None,
    writer: Some(Writer {
        extensions: &["npz"],
        holds_channels: |_| true,
        channels: "any channels",
        holds: |_| true,
        holds_sheets: true,
        scatter: either,
        resampled_as: Ok(specular::KIND),
        write,
    }),
};

/// Writes `path` whole or not at all, without compression, so that a reader may map it.
///
/// # Errors
/// [`FormatError`] if the file cannot be written, or the document has tensor trees, which are not arrays.
pub fn write(document: &Document, path: &Path) -> Result<(), FormatError> {
    let bytes = to_bytes(document).map_err(|error| unwritable(path, &error))?;
    write_whole(path, &bytes)
}

fn to_bytes(document: &Document) -> io::Result<Vec<u8>> {
    let mut arrays = Arrays { archive: Archive::default(), prefix: String::new() };
    arrays.document(document)?;
    Ok(arrays.archive.finish())
}

/// The arrays of a file that is being written.
struct Arrays {
    archive: Archive,
    prefix: String,
}

impl Arrays {
    /// One array: its elements in row-major order, as little-endian bytes of NumPy's type `descr`.
    fn array(&mut self, name: &str, descr: &str, shape: &[usize], data: &[u8]) -> io::Result<()> {
        let sizes: String = shape.iter().map(|n| format!("{n}, ")).collect();
        let header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({}), }}", sizes.trim_end());
        // Version 1.0: the data begin at a multiple of 64, the header ends with a line feed.
        let padded = (10 + header.len() + 1).next_multiple_of(64) - 10;
        let length = (padded as u16).to_le_bytes();
        let header = format!("{header:<width$}\n", width = padded - 1);
        let parts = [b"\x93NUMPY\x01\x00".as_slice(), &length, header.as_bytes(), data];
        self.archive.add(&format!("{}{name}.npy", self.prefix), &parts);
        Ok(())
    }

    fn floats(&mut self, name: &str, shape: &[usize], data: &[f32]) -> io::Result<()> {
        self.array(name, "<f4", shape, &data.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>())
    }

    fn doubles(&mut self, name: &str, shape: &[usize], data: &[f64]) -> io::Result<()> {
        self.array(name, "<f8", shape, &data.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>())
    }

    /// Text is UTF-32 of equal lengths, padded with zeros.
    fn texts(&mut self, name: &str, shape: &[usize], texts: &[String]) -> io::Result<()> {
        let width = texts.iter().map(|text| text.chars().count()).max().unwrap_or(0).max(1);
        let padded = |text: &String| {
            let characters: Vec<u32> = text.chars().map(u32::from).chain(std::iter::repeat(0)).take(width).collect();
            characters.into_iter().flat_map(u32::to_le_bytes)
        };
        self.array(name, &format!("<U{width}"), shape, &texts.iter().flat_map(padded).collect::<Vec<u8>>())
    }

    fn text(&mut self, name: &str, text: &str) -> io::Result<()> {
        self.texts(name, &[], &[text.into()])
    }

    fn channels(&mut self, channels: &Channels) -> io::Result<()> {
        if let Channels::Spectral(wavelengths) = channels {
            self.doubles("wavelengths", &[wavelengths.len()], wavelengths)?;
        }
        self.texts("channels", &[channels.count()], &channels.names())
    }

    fn scatter(&mut self, scatter: Scatter) -> io::Result<()> {
        self.text("scatter", if scatter == Scatter::Reflection { "reflection" } else { "transmission" })
    }

    /// Knots, one array per axis, and values over all of them and the channels.
    fn grid(&mut self, names: &[&str], knots: &[Vec<f64>], channels: &Channels, values: &[f32]) -> io::Result<()> {
        for (name, knots) in names.iter().zip(knots) {
            self.doubles(name, &[knots.len()], knots)?;
        }
        self.channels(channels)?;
        let shape: Vec<usize> = knots.iter().map(Vec::len).chain([channels.count()]).collect();
        self.floats("values", &shape, values)
    }

    fn document(&mut self, document: &Document) -> io::Result<()> {
        if let Some(data) = document.only() {
            return self.data(data);
        }
        for (index, part) in document.parts.iter().enumerate() {
            self.prefix = format!("{index}.");
            self.data(&part.data)?;
            self.text("name", &part.name)?;
            if let Some(side) = part.side {
                self.text("side", if side == Side::Front { "front" } else { "back" })?;
            }
        }
        Ok(())
    }

    fn data(&mut self, data: &Data) -> io::Result<()> {
        let scatter = data.representation().scatter();
        match data {
            Data::Specular(samples) => {
                self.scatter(scatter)?;
                self.text("kind", "specular table")?;
                if let Some(offsets) = samples.refraction() {
                    self.doubles("refraction", &[offsets.len()], offsets)?;
                }
                self.grid(&AXIS_NAMES, samples.knots(), samples.channels(), samples.values())
            }
            Data::Spherical(grid) => {
                self.scatter(scatter)?;
                self.text("kind", "spherical grid")?;
                self.array("is_mirrored", "|b1", &[], &[u8::from(grid.is_mirrored())])?;
                self.grid(&spherical::AXIS_NAMES, grid.knots(), grid.channels(), grid.values())
            }
            Data::Scattered(scattered) => {
                self.scatter(scatter)?;
                self.text("kind", "scattered samples")?;
                self.channels(scattered.channels())?;
                let samples: Vec<_> = scattered.samples().collect();
                for (axis, name) in spherical::AXIS_NAMES.iter().enumerate() {
                    let angles: Vec<f64> = samples.iter().map(|(angles, _)| angles[axis]).collect();
                    self.doubles(name, &[samples.len()], &angles)?;
                }
                let values: Vec<f32> = samples.iter().flat_map(|(_, values)| values.iter().copied()).collect();
                self.floats("values", &[samples.len(), scattered.channels().count()], &values)
            }
            Data::Mirror(mirror) => {
                self.scatter(scatter)?;
                self.text("kind", "mirror reflectance")?;
                self.grid(&AXIS_NAMES[..2], mirror.knots(), mirror.channels(), mirror.values())
            }
            Data::Rgl(rgl) => {
                let parts = rgl.parts();
                let (p, t, c) = (parts.phi_i.len(), parts.theta_i.len(), parts.channels.count());
                self.text("kind", "rgl")?;
                self.channels(&parts.channels)?;
                self.floats("phi_i", &[p], &parts.phi_i)?;
                self.floats("theta_i", &[t], &parts.theta_i)?;
                let lead: [(&str, _, &[usize]); 5] = [
                    ("ndf", &parts.ndf, &[]),
                    ("sigma", &parts.sigma, &[]),
                    ("vndf", &parts.vndf, &[p, t]),
                    ("luminance", &parts.luminance, &[p, t]),
                    ("spectra", &parts.spectra, &[p, t, c]),
                ];
                for (name, images, lead) in lead {
                    self.floats(name, &[lead, &images.size()].concat(), images.texels())?;
                }
                self.array("jacobian", "|b1", &[], &[u8::from(parts.jacobian)])
            }
            Data::HalfDiff(table) => {
                let bins = table.bins();
                self.text("kind", "half-difference")?;
                self.channels(&Channels::Rgb)?;
                self.floats("values", &[3, bins[0], bins[1], bins[2]], table.values())
            }
            Data::Utia(utia) => {
                self.text("kind", "utia")?;
                self.channels(&Channels::Rgb)?;
                self.doubles("values", &[3, 6, 48, 6, 48], utia.values())
            }
            Data::Mueller(mueller) => {
                let knots = mueller.knots();
                self.text("kind", "mueller")?;
                for (name, knots) in ["phi_d", "theta_d", "theta_h", "wavelengths"].iter().zip(knots) {
                    self.floats(name, &[knots.len()], knots)?;
                }
                let shape: Vec<usize> = knots.iter().map(Vec::len).chain([4, 4]).collect();
                self.floats("M", &shape, mueller.values())
            }
            Data::Polarised(polarised) => {
                let mut shape: Vec<usize> = polarised.knots().iter().map(Vec::len).collect();
                self.text("kind", "polarised")?;
                for (name, knots) in AXIS_NAMES.iter().zip(polarised.knots()) {
                    self.doubles(name, &[knots.len()], knots)?;
                }
                self.doubles("wavelengths", &[polarised.wavelengths().len()], polarised.wavelengths())?;
                shape.extend([polarised.wavelengths().len(), 4, 4]);
                self.floats("M", &shape, polarised.values())
            }
            Data::Fourier(fourier) => {
                let parts = fourier.parts();
                let knots = parts.mu.len();
                self.text("kind", "fourier")?;
                self.channels(&parts.channels)?;
                self.doubles("eta", &[1], &[f64::from(parts.eta)])?;
                self.floats("mu", &[knots], &parts.mu)?;
                let series = parts.series.iter().flat_map(|series| [f64::from(series.start), f64::from(series.count)]);
                self.doubles("series", &[knots, knots, 2], &series.collect::<Vec<f64>>())?;
                self.floats("coefficients", &[parts.coefficients.len()], &parts.coefficients)
            }
            Data::Window(window) => self.window(window),
            other => Err(io::Error::new(io::ErrorKind::InvalidInput, other.representation().kind().name())),
        }
    }

    fn window(&mut self, sheet: &window::Data) -> io::Result<()> {
        self.text("kind", "klems")?;
        for band in &sheet.bands {
            for (block, name) in Block::ALL.into_iter().zip([
                "transmission_front",
                "transmission_back",
                "reflection_front",
                "reflection_back",
            ]) {
                match band.window.block(block) {
                    None => {}
                    Some(Component::Tree(_)) => {
                        return Err(io::Error::new(io::ErrorKind::InvalidInput, "tensor trees, which are not arrays"));
                    }
                    Some(Component::Klems(matrix)) => {
                        self.prefix = format!("{}.{name}.", band.wavelength);
                        self.basis("incident", matrix.incident())?;
                        self.basis("exit", matrix.exit())?;
                        let shape = [matrix.incident().patches(), matrix.exit().patches()];
                        self.floats("values", &shape, matrix.values())?;
                    }
                }
            }
        }
        Ok(())
    }

    /// The rings of a basis: lower bound and upper bound in degrees, and the number of patches.
    fn basis(&mut self, name: &str, basis: &AngleBasis) -> io::Result<()> {
        let rings = basis.rings();
        let rows: Vec<f64> = rings.iter().flat_map(|ring| [ring.lower, ring.upper, f64::from(ring.patches)]).collect();
        self.doubles(&format!("{name}_rings"), &[rings.len(), 3], &rows)
    }
}
