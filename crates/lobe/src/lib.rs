//! Measured BRDFs and BSDFs: open a file, evaluate it in batches on the best SIMD backend of the machine.
//!
//! A [`Material`] comes from a file of any format, from bytes in memory, or from samples, in any representation; a
//! [`Sampler`] draws directions for it. Both are a [`Bsdf`], and so are the models of `lobe-model`. Directions are unit
//! vectors away from the surface, whose normal is +z: `wi` toward the light, `wo` toward the viewer. Values are `f` in
//! 1/sr, without the cosine, one per channel.
//!
//! # Three ways to evaluate
//!
//! One pair of directions:
//!
//! ```no_run
//! # use lobe::Material;
//! let material = Material::open("paint.ddr")?;
//! let mut f = vec![0.0; material.channel_count()];
//! material.eval([0.6, 0.0, 0.8], [-0.6, 0.0, 0.8], &mut f);
//! # Ok::<(), lobe::OpenError>(())
//! ```
//!
//! A batch, of vectors or of [columns](Directions::columns), which is many times as fast per pair. Large batches are
//! divided among threads; batches larger than the caches are fastest in [`Buffer`]s, which are on huge pages.
//!
//! ```no_run
//! # use lobe::Material;
//! # let material = Material::open("paint.ddr")?;
//! let wi = [[0.6, 0.0, 0.8], [0.0, 0.0, 1.0]];
//! let wo = [[-0.6, 0.0, 0.8], [0.0, 0.6, 0.8]];
//! let mut f = vec![0.0; wi.len() * material.channel_count()];
//! material.eval_batch(&wi, &wo, &mut f); // f[query * channel_count + channel]
//! # Ok::<(), lobe::OpenError>(())
//! ```
//!
//! In lanes, inside a [`Kernel`] of your own, which [`Backend::run`] compiles for every backend. A renderer that is
//! itself vectorised then needs no dispatch and no memory between its own arithmetic and the table's:
//!
//! ```no_run
//! use lobe::{Kernel, Lanes, Material, specular};
//!
//! /// f of a grey table for one light and as many viewers as there are lanes.
//! struct Viewers<'a> {
//!     table: &'a specular::Table,
//!     wo: [&'a [f32]; 3],
//!     out: &'a mut [f32],
//! }
//!
//! impl Kernel for Viewers<'_> {
//!     type Out = ();
//!
//!     #[inline(always)]
//!     fn run<L: Lanes>(self, lanes: L) {
//!         let wi = lanes.splat_xyz([0.6, 0.0, 0.8]);
//!         let [x, y, z] = self.wo;
//!         let mut at = 0;
//!         while at < self.out.len() {
//!             let wo = [lanes.load_partial(&x[at..]), lanes.load_partial(&y[at..]), lanes.load_partial(&z[at..])];
//!             let mut f = [lanes.splat(0.0)];
//!             self.table.eval_lanes(lanes, wi, wo, lanes.first_n(self.out.len() - at), &mut f);
//!             lanes.store_partial(&mut self.out[at..], f[0]);
//!             at += L::LANES;
//!         }
//!     }
//! }
//!
//! # let material = Material::open("grey.ddr")?;
//! # let (x, y, z) = (vec![0.0; 9], vec![0.0; 9], vec![1.0; 9]);
//! # let mut out = vec![0.0; 9];
//! let table = material.specular_table().expect("a table in specular coordinates");
//! material.backend().run(Viewers { table, wo: [&x, &y, &z], out: &mut out });
//! # Ok::<(), lobe::OpenError>(())
//! ```
//!
//! The [examples](https://github.com/lobe-rs/lobe/tree/main/crates/lobe/examples) are complete programs.
//!
//! # Features
//!
//! All are on by default; `default-features = false` builds only specular tables, and scattered samples without lanes.
//! Opening a file that needs a missing feature gives an error that says so.
//!
//! | feature | what it adds |
//! |---|---|
//! | `rayon` | large batches are divided among the threads of the current rayon pool |
//! | `fourier` | cosine series in the azimuth |
//! | `half-diff` | grids of half and difference angles, as in the MERL database |
//! | `json` | JSON files: OpenMaterial, and users' own tables |
//! | `mueller` | Mueller matrices |
//! | `rgl` | materials of the EPFL database |
//! | `scattered` | scattered samples in lanes, rather than pair by pair |
//! | `spherical` | grids in spherical coordinates |
//! | `utia` | materials of the UTIA database |
//! | `window` | Klems matrices and tensor trees |
//! | `zernike` | expansions in Zernike polynomials |
//!
//! # Underlying crates
//!
//! Everything that most programs need is re-exported here. The rest is in [`table`] (representations), [`formats`]
//! (readers and writers) and [`math`] (functions over lanes).
#![forbid(unsafe_code)]

mod error;
mod material;
mod parallel;
mod sampler;

pub use error::{OpenError, ShapeError};
pub use lobe_backend::{BACKEND_VARIABLE, Backend, BackendError};
pub use lobe_formats as formats;
pub use lobe_lane::{Floats, Ints, Kernel, Lanes, Mask};
pub use lobe_math as math;
pub use lobe_memory::Buffer;
pub use lobe_table as table;
pub use lobe_table::half_diff::Lookup;
pub use lobe_table::utia::Decode;
pub use lobe_table::{
    Aspect, Axis, Bsdf, BsdfLanes, Channels, Data, Directions, Edge, Edges, Function, Given, Kind, Options, Precision,
    Sampled, SamplerError, SamplerOptions, Scatter, Side, luminance, specular,
};
pub use material::{Material, SHEET};
pub use parallel::PARALLEL_FROM;
pub use sampler::Sampler;
