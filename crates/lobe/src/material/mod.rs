//! A material from a file, whatever its representation, ready to be evaluated.

mod evaluator;
mod half_diff;
mod kind;
mod mirror;
mod mueller;
mod rgl;
mod sheet;
mod spherical;
mod table;
mod utia;
mod window;

use std::path::Path;

use lobe_formats::{self as formats, Document, Format};
pub use lobe_table::half_diff::Lookup;
use lobe_table::mueller::Matrix;
use lobe_table::utia::Decode;
use lobe_table::{Channels, Data, Edges, Given, Scatter, Side};

use crate::{Backend, Brdf, OpenError};
use evaluator::Evaluator;
pub(crate) use evaluator::Native;
pub use kind::Kind;
use mirror::Mirror;
pub(crate) use mirror::mirrored;
pub(crate) use sheet::flipped;

/// What a file leaves open.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// What holds outside the measured angles of specular tables. The other representations have their own rule, which
    /// is that of the programs that defined them.
    pub edges: Edges,
    /// How half-difference grids are looked up.
    pub lookup: Lookup,
    /// What to make of the numbers of the UTIA database, whose unit is not documented.
    pub decode: Decode,
    /// Which direction finds the slice of a material of the EPFL database: the light, as it was measured, or the viewer,
    /// as renderers that trace from the camera do (Mitsuba, pbrt). They differ as far as the data are not reciprocal. The
    /// direction given is the one that is best sampled by.
    pub indexed_by: Given,
}

/// The measurements of a sheet as they are read.
#[derive(Default)]
struct Parts {
    parts: Vec<sheet::Part>,
    mirrors: Vec<Mirror>,
}

impl Parts {
    fn add(&mut self, path: &Path, side: Option<Side>, data: Data, options: &Options) -> Result<(), OpenError> {
        if let Some(data) = data.representation().mirror() {
            self.mirrors.push(Mirror { side, data: data.clone() });
            return Ok(());
        }
        let scatter = data.representation().scatter();
        self.parts.push(sheet::Part { scatter, side, evaluator: evaluator(path, data, options)? });
        Ok(())
    }

    fn finish(self, path: &Path, (format, source): (Format, Vec<(String, String)>)) -> Result<Material, OpenError> {
        let Parts { parts, mirrors } = self;
        let not_a_table = |found: &'static str| OpenError::NotATable { file: path.display().to_string(), found };
        let channels = parts.first().ok_or_else(|| not_a_table("mirror reflectances"))?.evaluator.channels().clone();
        let differ = parts.iter().any(|part| *part.evaluator.channels() != channels)
            || mirrors.iter().any(|mirror| *mirror.data.channels() != channels);
        if differ {
            return Err(not_a_table("parts with different channels"));
        }
        let evaluator = Box::new(sheet::Sheet { channels, parts });
        Ok(Material { format, source, evaluator, mirrors, backend: Backend::detect()? })
    }
}

fn evaluator(path: &Path, data: Data, options: &Options) -> Result<Box<dyn Evaluator>, OpenError> {
    let not_a_table = |found: &'static str| OpenError::NotATable { file: path.display().to_string(), found };
    let too_large = |error| OpenError::TooLarge { file: path.display().to_string(), source: error };
    Ok(match data {
        Data::Specular(data) => Box::new(Brdf::new(&data, &options.edges)?),
        Data::Spherical(data) => Box::new(lobe_table::spherical::Table::new(&data)?),
        Data::Scattered(data) => Box::new(data),
        Data::Rgl(data) => {
            let table = lobe_table::rgl::Table::new(&data, lobe_table::rgl::Options::default()).map_err(too_large)?;
            Box::new(rgl::Parametrised { table, indexed_by: options.indexed_by })
        }
        Data::HalfDiff(data) => {
            let table = lobe_table::half_diff::Table::new(&data).map_err(too_large)?;
            Box::new(half_diff::HalfDifference { table, lookup: options.lookup })
        }
        Data::Utia(data) => {
            let table = lobe_table::utia::Table::new(&data, options.decode).map_err(too_large)?;
            Box::new(utia::UtiaGrid { table })
        }
        Data::Mueller(data) => Box::new(mueller::Polarised::new(data).map_err(too_large)?),
        Data::Window(data) => Box::new(window::Bands::new(data).map_err(too_large)?),
        other => return Err(not_a_table(other.representation().kind().name())),
    })
}

/// A measured material in the form in which it was measured: nothing is resampled.
///
/// `wi` points to the light and `wo` to the viewer: unit vectors away from the surface, normal on +z. Values are `f` in
/// 1/sr, without the cosine, one per channel. All representations are evaluated in the SIMD lanes of the backend, except for
/// scattered samples, which are evaluated in `f64`, pair by pair.
///
/// ```no_run
/// let material = lobe::Material::open("paint.bsdf")?;
/// println!("{} with {}", material.kind(), material.channels().names().join(" "));
/// let wi = [[0.5, 0.0, 0.866], [0.0, 0.6, 0.8]];
/// let wo = [[-0.5, 0.0, 0.866], [0.0, -0.6, 0.8]];
/// let mut f = vec![0.0; wi.len() * material.channel_count()];
/// material.eval_batch(&wi, &wo, &mut f);
/// # Ok::<(), lobe::OpenError>(())
/// ```
#[derive(Debug)]
pub struct Material {
    format: Format,
    source: Vec<(String, String)>,
    evaluator: Box<dyn Evaluator>,
    mirrors: Vec<Mirror>,
    backend: Backend,
}

impl Material {
    /// Opens a file of any format that `lobe_formats` reads, on the detected backend.
    ///
    /// # Errors
    /// [`OpenError`] where the file cannot be read or holds nothing that has a value for a pair of directions, or
    /// `LOBE_BACKEND` is wrong.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, OpenError> {
        Material::open_with(path, &Options::default())
    }

    /// As [`open`](Material::open), with answers to what the file leaves open.
    ///
    /// # Errors
    /// As [`open`](Material::open).
    pub fn open_with(path: impl AsRef<Path>, options: &Options) -> Result<Self, OpenError> {
        let path = path.as_ref();
        let (format, document) = lobe_formats::open(path)?;
        Material::new(path, format, document, options)
    }

    /// The material of a document that was read from `path`, which is named in errors.
    ///
    /// # Errors
    /// As [`open`](Material::open).
    pub fn new(path: &Path, format: Format, document: Document, options: &Options) -> Result<Self, OpenError> {
        let Document { mut parts, source, .. } = document;
        if let [formats::Part { side: None, .. }] = parts.as_slice()
            && let Some(part) = parts.pop()
        {
            let evaluator = evaluator(path, part.data, options)?;
            return Ok(Material { format, source, evaluator, mirrors: Vec::new(), backend: Backend::detect()? });
        }
        let mut sheet = Parts::default();
        for part in parts {
            sheet.add(path, part.side, part.data, options)?;
        }
        sheet.finish(path, (format, source))
    }

    /// A sheet of which both sides, and both ways through, were measured into files of their own: those measured with
    /// light on the front (z > 0), and those with light on the back, each with its own side up. Files of mirror
    /// reflectance (SDR) and of transmittance straight through (SDT) are its [mirrors](Material::mirror).
    ///
    /// Transmission that was measured in one direction only is the same in the other one; a side without reflection is
    /// black.
    ///
    /// # Errors
    /// As [`open`](Material::open), and if the files do not have the same channels, or one of them is a sheet itself.
    pub fn open_sheet<P: AsRef<Path>>(front: &[P], back: &[P], options: &Options) -> Result<Self, OpenError> {
        let mut parts_of_sheet = Parts::default();
        let sides = [(front, Side::Front), (back, Side::Back)];
        let mut last = None;
        for (path, side) in sides.iter().flat_map(|(paths, side)| paths.iter().map(|path| (path.as_ref(), *side))) {
            let (format, document) = lobe_formats::open(path)?;
            let Document { mut parts, source, .. } = document;
            let is_two_sided = |part: &formats::Part| part.data.representation().is_two_sided();
            let (Some(part), true) =
                (parts.pop().filter(|part| part.side.is_none() && !is_two_sided(part)), parts.is_empty())
            else {
                let found = "data that are no part of a sheet";
                return Err(OpenError::NotATable { file: path.display().to_string(), found });
            };
            parts_of_sheet.add(path, Some(side), part.data, options)?;
            last = Some((path, (format, source)));
        }
        let Some((path, what)) = last else {
            return Err(OpenError::NotATable { file: "a sheet".into(), found: "no files" });
        };
        parts_of_sheet.finish(path, what)
    }

    /// The same material on another backend.
    pub fn with_backend(self, backend: Backend) -> Self {
        Material { backend, ..self }
    }

    /// The backend that evaluates.
    pub fn backend(&self) -> Backend {
        self.backend
    }

    /// The format of the file.
    pub fn format(&self) -> Format {
        self.format
    }

    /// The representation.
    pub fn kind(&self) -> Kind {
        self.evaluator.kind()
    }

    /// What the header of the file says: names and values in its order.
    pub fn source(&self) -> &[(String, String)] {
        &self.source
    }

    /// What the channels stand for.
    pub fn channels(&self) -> &Channels {
        self.evaluator.channels()
    }

    /// How many channels a value has.
    pub fn channel_count(&self) -> usize {
        self.channels().count()
    }

    /// The wavelength of each channel in nm, where channels are wavelengths.
    pub fn wavelengths(&self) -> Option<&[f64]> {
        match self.channels() {
            Channels::Spectral(wavelengths) => Some(wavelengths),
            _ => None,
        }
    }

    /// Bytes of memory that the data take.
    pub fn bytes(&self) -> usize {
        self.evaluator.bytes()
    }

    /// `true` where values do not depend on the rotation of the sample.
    pub fn is_isotropic(&self) -> bool {
        self.evaluator.is_isotropic()
    }

    /// Whether there are values for light from the side of z > 0 (`front`), or from that of z < 0, that is reflected or
    /// transmitted.
    pub fn holds(&self, front: bool, scatter: Scatter) -> bool {
        self.evaluator.holds(front, scatter)
    }

    /// The share of the light from `wi` that is mirrored, or goes straight through, into `out`, one value a channel; and
    /// where it goes. `None` where that was not measured. These have no value for a pair of directions.
    ///
    /// # Panics
    /// Where `out` is not as long as there are channels.
    pub fn mirror(&self, wi: [f32; 3], scatter: Scatter, out: &mut [f32]) -> Option<[f32; 3]> {
        let mirror = self.mirrors.iter().find(|mirror| mirror.answers(wi[2] > 0.0, scatter))?;
        out.copy_from_slice(&mirror.reflectance(wi));
        Some(mirrored(wi, scatter))
    }

    /// Whether there is a [mirror](Material::mirror).
    pub fn has_mirrors(&self) -> bool {
        !self.mirrors.is_empty()
    }

    /// What makes a sampler better than the values alone do.
    pub(crate) fn native(&self) -> Native<'_> {
        self.evaluator.native()
    }

    /// Evaluates one pair into `out`, one value a channel. For many pairs use [`eval_batch`](Material::eval_batch).
    ///
    /// # Panics
    /// Where `out` is not as long as there are channels.
    pub fn eval(&self, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        self.eval_batch(&[wi], &[wo], out);
    }

    /// Evaluates many pairs: `out[query * channel_count + channel]`.
    ///
    /// # Panics
    /// Where there are not as many `wi` as `wo`, or `out` is not that many times the channels long.
    pub fn eval_batch(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        self.eval_batch_on(self.backend, wi, wo, out);
    }

    /// As [`eval_batch`](Material::eval_batch), on the backend given: for a renderer that chooses one for all of a picture.
    ///
    /// # Panics
    /// As [`eval_batch`](Material::eval_batch).
    pub fn eval_batch_on(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        assert_eq!(wi.len(), wo.len(), "as many wi as wo");
        assert_eq!(out.len(), wi.len() * self.channel_count(), "one output a query and channel");
        self.evaluator.eval_batch(backend, wi, wo, out);
    }

    /// The Mueller matrix in 1/sr for light from `wi` to `wo` at a wavelength in nm, in the Stokes frames of
    /// [`stokes_basis`](lobe_table::mueller::stokes_basis). `None` where the representation has no polarisation.
    pub fn mueller(&self, wi: [f32; 3], wo: [f32; 3], nm: f64) -> Option<Matrix> {
        self.evaluator.mueller(wi, wo, nm)
    }
}
