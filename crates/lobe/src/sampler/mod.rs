//! Importance sampling of any material.

mod lobes;

use std::sync::Arc;

use lobe_table::rgl::{Drawn, UniformOrder, Wanted};
use lobe_table::{Given, Sampled, SamplerError, SamplerOptions, luminance};

use crate::Material;
use crate::material::Native;
use lobes::Lobes;

/// A material and what is needed to sample directions in proportion to luminance times `f` times cosine.
///
/// Every representation is sampled in the way that fits it: specular tables and the EPFL database by their own schemes,
/// in lanes; Klems matrices by their patches; everything else by histograms over the hemisphere, blended between
/// directions of incidence, whose density is exact. Sheets and windows have a lobe for each side and each way through;
/// light chooses among the lobes of its side by how bright they are, and mirrors are lobes too.
///
/// Directions are unit vectors away from the surface, normal on +z. Densities are per steradian. The density is positive
/// wherever `f` is, but for the EPFL database, whose published scheme is kept. In strict form samples are the same bits
/// on every backend.
///
/// ```no_run
/// use std::sync::Arc;
/// use lobe::{Given, Material, Sampler, SamplerOptions};
///
/// let material = Arc::new(Material::open("paint.ddr")?);
/// let sampler = Sampler::new(material.clone(), &SamplerOptions::default())?;
/// let mut weight = vec![0.0; material.channel_count()];
/// let (wo, pdf) = sampler.sample(Given::Light, [0.6, 0.0, 0.8], [0.3, 0.7], &mut weight);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sampler {
    material: Arc<Material>,
    scheme: Scheme,
}

#[derive(Clone, Debug)]
enum Scheme {
    Table(Box<lobe_table::Sampler>),
    /// The scheme is in the material.
    Rgl,
    Lobes(Arc<Lobes>),
}

impl Sampler {
    /// Builds the distributions of a material.
    ///
    /// # Errors
    /// Where the options make no sense for this material.
    pub fn new(material: Arc<Material>, options: &SamplerOptions) -> Result<Self, SamplerError> {
        Sampler::with_progress(material, options, &mut |_, _| {})
    }

    /// As [`new`](Sampler::new), calling `progress(done, all)` after each slice of a distribution.
    ///
    /// # Errors
    /// As [`new`](Sampler::new).
    pub fn with_progress(
        material: Arc<Material>,
        options: &SamplerOptions,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, SamplerError> {
        let scheme = match material.native() {
            Native::Table(brdf) if !material.has_mirrors() => {
                let table = brdf.table().clone();
                let sampler = lobe_table::Sampler::with_progress(material.backend(), table, options, progress)?;
                Scheme::Table(Box::new(sampler))
            }
            Native::Rgl(_) if !material.has_mirrors() => Scheme::Rgl,
            _ => {
                let weights = options.luminance.clone().unwrap_or_else(|| luminance(material.channels()));
                let channels = material.channel_count();
                if weights.len() != channels || !weights.iter().all(|&y| y.is_finite() && y >= 0.0) {
                    return Err(SamplerError::Luminance { found: weights, channels });
                }
                Scheme::Lobes(Arc::new(Lobes::new(&material, options.defensive, weights, progress)?))
            }
        };
        Ok(Sampler { material, scheme })
    }

    /// The material that is sampled.
    pub fn material(&self) -> &Arc<Material> {
        &self.material
    }

    /// Bytes of memory that the distributions take beside the material: at most one and a half times what it takes, but
    /// for the tiniest.
    pub fn bytes(&self) -> usize {
        match &self.scheme {
            Scheme::Table(sampler) => sampler.bytes(),
            Scheme::Rgl => 0,
            Scheme::Lobes(lobes) => lobes.bytes(),
        }
    }

    /// Samples one direction for two numbers in `[0, 1)`. Returns it with its density, and `weight` is set to `f` times
    /// cosine over the density, one value a channel. Where the draw leads nowhere, everything is 0.
    ///
    /// A mirror has a density of infinity, and its weight is its reflectance over the probability of choosing it.
    ///
    /// # Panics
    /// Where `weight` is not as long as there are channels.
    pub fn sample(&self, given: Given, direction: [f32; 3], u: [f32; 2], weight: &mut [f32]) -> ([f32; 3], f32) {
        let (mut sampled, mut pdf) = ([[0.0; 3]], [0.0]);
        let out = Sampled { directions: &mut sampled, weights: weight, pdfs: &mut pdf };
        self.sample_batch(given, &[direction], &[u], out);
        (sampled[0], pdf[0])
    }

    /// The density with which [`sample`](Sampler::sample) finds the direction of the pair that is not given, without
    /// mirrors.
    pub fn pdf(&self, given: Given, wi: [f32; 3], wo: [f32; 3]) -> f32 {
        let mut pdf = [0.0];
        self.pdf_batch(given, &[wi], &[wo], &mut pdf);
        pdf[0]
    }

    /// Samples a direction for each direction given, as [`sample`](Sampler::sample).
    ///
    /// # Panics
    /// Where `u` or a part of `out` does not have one entry a direction, and the weights one more a channel.
    pub fn sample_batch(&self, given: Given, directions: &[[f32; 3]], u: &[[f32; 2]], out: Sampled<'_>) {
        let (count, channels, backend) = (directions.len(), self.material.channel_count(), self.material.backend());
        assert_eq!(u.len(), count, "a pair of numbers a direction");
        assert_eq!((out.directions.len(), out.pdfs.len()), (count, count), "an output a direction");
        assert_eq!(out.weights.len(), count * channels, "a weight a direction and channel");
        match &self.scheme {
            Scheme::Table(sampler) => sampler.sample_batch(backend, given, directions, u, out),
            Scheme::Rgl => {
                let Native::Rgl(rgl) = self.material.native() else { return };
                let drawn = Drawn { wo: out.directions, pdf: out.pdfs, weights: out.weights };
                rgl.table.sample_batch(backend, directions.into(), u, UniformOrder::default(), drawn);
                if given != rgl.indexed_by {
                    // These are the weights with light and viewer exchanged.
                    let found = &*out.directions;
                    let (wi, wo) = if given == Given::Light { (directions, found) } else { (found, directions) };
                    self.material.eval_batch(wi, wo, out.weights);
                    weigh(out.weights, channels, found, out.pdfs);
                }
            }
            Scheme::Lobes(lobes) => lobes.sample(&self.material, given, directions, u, out),
        }
    }

    /// Draws directions and their densities as [`sample_batch`](Sampler::sample_batch) does, without the weights: for
    /// programs that evaluate later. A density of infinity is a mirror's.
    ///
    /// # Panics
    /// Where the slices do not have the same length.
    pub fn draw_batch(&self, known: &[[f32; 3]], u: &[[f32; 2]], directions: &mut [[f32; 3]], pdfs: &mut [f32]) {
        let count = known.len();
        assert_eq!((u.len(), directions.len(), pdfs.len()), (count, count, count), "one of each a direction");
        let backend = self.material.backend();
        match &self.scheme {
            Scheme::Table(sampler) => {
                sampler.distribution().draw_batch(backend, known, u, directions, pdfs);
            }
            Scheme::Rgl => {
                let mut weights = vec![0.0; count * self.material.channel_count()];
                self.sample_batch(Given::Light, known, u, Sampled { directions, weights: &mut weights, pdfs });
            }
            Scheme::Lobes(lobes) => {
                lobes.draw(&self.material, known, u, directions, pdfs);
            }
        }
    }

    /// The densities of many pairs, as [`pdf`](Sampler::pdf).
    ///
    /// # Panics
    /// Where there are not as many `wi` as `wo` and `pdfs`.
    pub fn pdf_batch(&self, given: Given, wi: &[[f32; 3]], wo: &[[f32; 3]], pdfs: &mut [f32]) {
        assert_eq!((wi.len(), wo.len()), (pdfs.len(), pdfs.len()), "as many wi as wo and densities");
        let backend = self.material.backend();
        let (known, other) = if given == Given::Light { (wi, wo) } else { (wo, wi) };
        match &self.scheme {
            Scheme::Table(sampler) => sampler.distribution().pdf_batch(backend, known, other, pdfs),
            Scheme::Rgl => {
                let Native::Rgl(rgl) = self.material.native() else { return };
                rgl.table.pdf_batch(backend, known.into(), other.into(), pdfs);
            }
            Scheme::Lobes(lobes) => lobes.pdf(&self.material, known, other, pdfs),
        }
    }

    /// Values, `f` in 1/sr as [`Material::eval_batch`] gives them, `[pair][channel]`, and densities, as
    /// [`pdf`](Sampler::pdf), of many pairs: what light that is drawn from lights is weighted by. Both at once take less
    /// time than one after the other where they are found in the same place of a table.
    ///
    /// # Panics
    /// Where there are not as many `wi` as `wo` and `pdfs`, and that many values a channel.
    pub fn eval_pdf_batch(&self, given: Given, wi: &[[f32; 3]], wo: &[[f32; 3]], values: &mut [f32], pdfs: &mut [f32]) {
        match self.material.native() {
            Native::Rgl(rgl) if matches!(self.scheme, Scheme::Rgl) && rgl.indexed_by == given => {
                let (known, other) = if given == Given::Light { (wi, wo) } else { (wo, wi) };
                let wanted = Wanted::ValuesAndPdf(values, pdfs);
                rgl.table.evaluate(self.material.backend(), known.into(), other.into(), wanted);
            }
            _ => {
                self.material.eval_batch(wi, wo, values);
                self.pdf_batch(given, wi, wo, pdfs);
            }
        }
    }
}

/// Values to weights: times cosine over density.
fn weigh(values: &mut [f32], channels: usize, directions: &[[f32; 3]], pdfs: &[f32]) {
    for ((texel, direction), &pdf) in values.chunks_exact_mut(channels).zip(directions).zip(pdfs) {
        let factor = if pdf > 0.0 { direction[2].abs() / pdf } else { 0.0 };
        texel.iter_mut().for_each(|value| *value *= factor);
    }
}
