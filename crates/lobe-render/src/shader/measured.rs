//! Opening files of measured materials.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use lobe::{Material, OpenError, Options};
use lobe_formats::{Document, FormatError, Specular};
use lobe_table::rgl::{RglOptions, RglTable};
use lobe_table::{SamplerError, Scatter, Table, TableError};

use super::{Backend, Delta, DeltaShader, Evaluate, Proxied, Reduction, RglShader, Shader, Sided, TableShader};

/// Why a file makes no material.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// The file cannot be read.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// What it holds cannot be evaluated.
    #[error(transparent)]
    Open(#[from] OpenError),
    /// The data are too large for a table.
    #[error("{file}: {why}")]
    Table {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        why: TableError,
    },
    /// Directions cannot be drawn for it.
    #[error("{file}: {why}")]
    Sampler {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        why: SamplerError,
    },
    /// It is larger than a lane's integers can index.
    #[error("{file}: {why}")]
    Size {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        why: String,
    },
}

/// Opens any file that [`lobe`] opens as a material of a picture.
///
/// # Errors
/// [`MaterialError`] names the file.
pub fn open(path: &Path, options: &Options) -> Result<Arc<dyn Shader<3>>, MaterialError> {
    let (format, document) = lobe_formats::open(path)?;
    let sampler = |why| MaterialError::Sampler { file: path.into(), why };
    Ok(match document {
        Document::Table(measured) => {
            let table = Table::new(&measured.data, &options.edges)
                .map_err(|why| MaterialError::Table { file: path.into(), why })?;
            Arc::new(TableShader::new(table).map_err(sampler)?)
        }
        Document::Rgl(measured) => {
            let table = RglTable::new(&measured.data, RglOptions::default())
                .map_err(|why| MaterialError::Size { file: path.into(), why: why.to_string() })?;
            Arc::new(RglShader::new(table))
        }
        Document::Specular(measured) if measured.data.scatter() == Scatter::Reflection => {
            Arc::new(DeltaShader(mirror(&measured.data)))
        }
        document => {
            let two_sided = match &document {
                Document::Window(_) | Document::Sheet(_) => true,
                Document::Spherical(measured) => measured.data.scatter() == Scatter::Transmission,
                Document::Scattered(measured) => measured.data.scatter() == Scatter::Transmission,
                _ => false,
            };
            let material = Material::new(path, format, document, options)?;
            let reduction = Reduction::new(material.channels());
            let reduced = Reduced { material, reduction };
            if two_sided { Arc::new(Sided::new(reduced)) } else { Arc::new(Proxied::new(reduced).map_err(sampler)?) }
        }
    })
}

/// Reflectance by the angle of the light, averaged over its azimuths.
fn mirror(specular: &Specular) -> Delta<3> {
    let [sigma, psi] = specular.knots();
    let reduction = Reduction::new(specular.channels());
    let mut colours = vec![[0.0; 3]; sigma.len() * psi.len()];
    reduction.apply(specular.values(), &mut colours);
    let mean = |row: &[[f32; 3]]| -> [f32; 3] {
        std::array::from_fn(|k| (row.iter().map(|c| c[k]).sum::<f32>() / row.len() as f32).max(0.0))
    };
    let shares = sigma.iter().zip(colours.chunks_exact(psi.len())).map(|(angle, row)| (*angle as f32, mean(row)));
    Delta::Measured(shares.collect())
}

/// A material in the channels of the picture.
#[derive(Debug)]
struct Reduced {
    material: Material,
    reduction: Reduction,
}

impl Evaluate for Reduced {
    fn values(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [[f32; 3]]) {
        if self.reduction.is_identity() {
            return self.material.eval_batch_on(backend, wi, wo, out.as_flattened_mut());
        }
        let mut values = vec![0.0; wi.len() * self.reduction.channels()];
        self.material.eval_batch_on(backend, wi, wo, &mut values);
        self.reduction.apply(&values, out);
    }
}
