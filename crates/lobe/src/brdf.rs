//! A material from a file, ready to be evaluated.

use std::path::Path;
use std::sync::Arc;

use lobe_formats::FormatError;
use lobe_table::{Data, Directions, Edges, Invalid, TableError, specular};
use thiserror::Error;

use crate::{Backend, BackendError};

/// Batches of at least this many queries are shared among threads; below it, starting them would cost more than it saves.
pub const PARALLEL_FROM: usize = 16_384;

/// Queries a task: a few tens of microseconds of work.
#[cfg(feature = "rayon")]
const TASK: usize = 4_096;

/// Why a material could not be opened.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum OpenError {
    /// The file cannot be read.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The file holds something that has no value for a pair of directions.
    #[error("{file}: found {found}; expected a BRDF or BTDF")]
    NotATable {
        /// The file.
        file: String,
        /// What it holds.
        found: &'static str,
    },
    /// The data are too large for a table.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The data are more than lanes can index.
    #[error("{file}: {source}")]
    TooLarge {
        /// The file.
        file: String,
        /// Which part.
        source: Invalid,
    },
    /// `LOBE_BACKEND` names no backend of this machine.
    #[error(transparent)]
    Backend(#[from] BackendError),
}

/// A measured BRDF or BTDF and the backend that evaluates it.
///
/// `wi` points to the light and `wo` to the viewer: unit vectors away from the surface, normal on +z. Values are `f` in
/// 1/sr, without the cosine.
///
/// ```no_run
/// let brdf = lobe::Brdf::open("paint.ddr")?;
/// let wi = [[0.5, 0.0, 0.866], [0.0, 0.6, 0.8]];
/// let wo = [[-0.5, 0.0, 0.866], [0.0, -0.6, 0.8]];
/// let mut f = vec![0.0; wi.len() * brdf.channel_count()];
/// brdf.eval_batch(&wi, &wo, &mut f);
/// # Ok::<(), lobe::OpenError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Brdf {
    table: Arc<specular::Table>,
    backend: Backend,
}

impl Brdf {
    /// Opens a file of any format that `lobe_formats` reads, with the default [`Edges`], on the detected backend.
    ///
    /// # Errors
    /// [`OpenError`] where the file cannot be read, holds no table, or `LOBE_BACKEND` is wrong.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, OpenError> {
        Brdf::open_with(path, &Edges::default())
    }

    /// As [`open`](Brdf::open), with a policy for queries outside the measured angles.
    ///
    /// # Errors
    /// As [`open`](Brdf::open).
    pub fn open_with(path: impl AsRef<Path>, edges: &Edges) -> Result<Self, OpenError> {
        let path = path.as_ref();
        match lobe_formats::open(path)?.1.only() {
            Some(Data::Specular(samples)) => Brdf::new(samples, edges),
            _ => Err(OpenError::NotATable { file: path.display().to_string(), found: "no specular table" }),
        }
    }

    /// A material from samples, on the detected backend.
    ///
    /// # Errors
    /// [`OpenError`] where the data are too large for a table, or `LOBE_BACKEND` is wrong.
    pub fn new(samples: &specular::Data, edges: &Edges) -> Result<Self, OpenError> {
        Ok(Brdf { table: Arc::new(specular::Table::new(samples, edges)?), backend: Backend::detect()? })
    }

    /// The same material on another backend.
    pub fn with_backend(self, backend: Backend) -> Self {
        Brdf { backend, ..self }
    }

    /// The backend that evaluates.
    pub fn backend(&self) -> Backend {
        self.backend
    }

    /// The table, for its axes and channels, and for evaluation inside a kernel of your own.
    pub fn table(&self) -> &Arc<specular::Table> {
        &self.table
    }

    /// How many channels a value has.
    pub fn channel_count(&self) -> usize {
        self.table.channel_count()
    }

    /// Evaluates one pair into `out`, one value a channel. For many pairs use [`eval_batch`](Brdf::eval_batch).
    ///
    /// # Panics
    /// Where `out` is not as long as there are channels.
    pub fn eval(&self, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        self.table.eval(self.backend, wi, wo, out);
    }

    /// Evaluates many pairs: `out[query * channel_count + channel]`. `wi` and `wo` are slices of vectors, or
    /// [columns](Directions::columns) of components.
    ///
    /// From [`PARALLEL_FROM`] queries on, the work is shared among the threads of the current rayon pool (feature
    /// `rayon`); the results do not depend on how many there are.
    ///
    /// # Panics
    /// Where there are not as many `wi` as `wo`, or `out` is not that many times the channels long.
    pub fn eval_batch<'a>(&self, wi: impl Into<Directions<'a>>, wo: impl Into<Directions<'a>>, out: &mut [f32]) {
        self.eval_directions(wi.into(), wo.into(), out);
    }

    fn eval_directions(&self, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        #[cfg(feature = "rayon")]
        if wi.count() >= PARALLEL_FROM {
            return self.eval_parallel(wi, wo, out);
        }
        self.table.eval_batch(self.backend, wi, wo, out);
    }

    #[cfg(feature = "rayon")]
    fn eval_parallel(&self, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        use rayon::prelude::*;
        assert_eq!(wi.count(), wo.count(), "as many wi as wo");
        assert_eq!(out.len(), wi.count() * self.channel_count(), "one output a query and channel");
        out.par_chunks_mut(TASK * self.channel_count()).enumerate().for_each(|(task, out)| {
            let from = task * TASK;
            let range = from..from + out.len() / self.channel_count();
            self.table.eval_batch(self.backend, wi.part(range.clone()), wo.part(range), out);
        });
    }
}
