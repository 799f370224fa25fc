//! Importance sampling of any material.

mod lobes;

use std::sync::Arc;

use lobe_table::bsdf::Scheme;
use lobe_table::mueller::Matrix;
use lobe_table::{Aspect, Bsdf, Channels, Directions, Given, Sampled, SamplerError, SamplerOptions, luminance};

use crate::error::{ShapeError, expect, fitting};
use crate::{Backend, Material, parallel};
use lobes::Lobes;

/// A material, and the distributions to sample directions in proportion to luminance times `f` times cosine.
///
/// Every representation is sampled in its own way: specular tables and the EPFL database by their own schemes, in
/// lanes; Klems matrices by their patches; everything else by histograms over the hemisphere, which are blended between
/// incident directions and have an exact density. Sheets and windows have a lobe for each side and scatter; light
/// chooses among the lobes of its side by their brightness, and mirrors are lobes too.
///
/// Directions are unit vectors away from the surface, normal on +z. Densities are per steradian. The density is
/// positive wherever `f` is, except for the EPFL database, whose published scheme is kept. In strict form, samples have
/// the same bits on every backend.
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
    distribution: Distribution,
}

/// The way in which directions are drawn.
#[derive(Clone, Debug)]
enum Distribution {
    /// The representation's own scheme.
    Own(Scheme),
    /// A lobe for each side and scatter.
    Lobes(Arc<Lobes>),
}

impl Sampler {
    /// Builds the distributions of a material.
    ///
    /// # Errors
    /// If the options do not apply to this material.
    pub fn new(material: Arc<Material>, options: &SamplerOptions) -> Result<Self, SamplerError> {
        Sampler::with_progress(material, options, &mut |_, _| {})
    }

    /// Like [`new`](Sampler::new), calling `progress(done, all)` after each slice of a distribution.
    ///
    /// # Errors
    /// The same as for [`new`](Sampler::new).
    pub fn with_progress(
        material: Arc<Material>,
        options: &SamplerOptions,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, SamplerError> {
        let own = match material.has_mirrors() {
            false => material.bsdf().sampled(material.backend(), options, progress)?,
            true => None,
        };
        if let Some(scheme) = own {
            return Ok(Sampler { material, distribution: Distribution::Own(scheme) });
        }
        let weights = options.luminance.clone().unwrap_or_else(|| luminance(material.channels()));
        let channels = material.channel_count();
        if weights.len() != channels || !weights.iter().all(|&y| y.is_finite() && y >= 0.0) {
            return Err(SamplerError::Luminance { found: weights, channels });
        }
        let lobes = Arc::new(Lobes::new(&material, options, weights, progress)?);
        Ok(Sampler { material, distribution: Distribution::Lobes(lobes) })
    }

    /// The material that is sampled.
    pub fn material(&self) -> &Arc<Material> {
        &self.material
    }

    /// Bytes of memory that the distributions take in addition to the material: at most one and a half times its own,
    /// except for the tiniest materials.
    pub fn bytes(&self) -> usize {
        match &self.distribution {
            Distribution::Own(scheme) => scheme.bytes,
            Distribution::Lobes(lobes) => lobes.bytes(),
        }
    }

    /// `true` if the distributions would be finer without [`SamplerOptions::evaluations`].
    pub fn is_limited(&self) -> bool {
        match &self.distribution {
            Distribution::Own(scheme) => scheme.is_limited,
            Distribution::Lobes(lobes) => lobes.is_limited(),
        }
    }

    /// Samples one direction from two numbers in `[0, 1)`. Returns it with its density, and sets `weight` to `f` times
    /// cosine over the density, one value per channel. If the draw fails, everything is 0.
    ///
    /// A mirror has a density of infinity, and its weight is its reflectance over the probability of choosing it.
    ///
    /// # Panics
    /// If the length of `weight` is not the number of channels.
    pub fn sample(&self, given: Given, direction: [f32; 3], u: [f32; 2], weight: &mut [f32]) -> ([f32; 3], f32) {
        fitting(self.try_sample(given, direction, u, weight))
    }

    /// Like [`sample`](Sampler::sample), with an error instead of a panic.
    ///
    /// # Errors
    /// If the length of `weight` is not the number of channels.
    pub fn try_sample(
        &self,
        given: Given,
        direction: [f32; 3],
        u: [f32; 2],
        weight: &mut [f32],
    ) -> Result<([f32; 3], f32), ShapeError> {
        let (mut sampled, mut pdf) = ([[0.0; 3]], [0.0]);
        let out = Sampled { directions: &mut sampled, weights: weight, pdfs: &mut pdf };
        self.try_sample_batch(given, &[direction], &[u], out)?;
        Ok((sampled[0], pdf[0]))
    }

    /// The density with which [`sample`](Sampler::sample) draws the other direction of the pair, without mirrors.
    pub fn pdf(&self, given: Given, wi: [f32; 3], wo: [f32; 3]) -> f32 {
        let mut pdf = [0.0];
        self.pdf_batch(given, &[wi], &[wo], &mut pdf);
        pdf[0]
    }

    /// Samples one direction for each given direction, as [`sample`](Sampler::sample).
    ///
    /// # Panics
    /// If `u` or a field of `out` does not have one entry per direction, or the weights do not have one per direction
    /// and channel.
    pub fn sample_batch(&self, given: Given, directions: &[[f32; 3]], u: &[[f32; 2]], out: Sampled<'_>) {
        fitting(self.try_sample_batch(given, directions, u, out));
    }

    /// Like [`sample_batch`](Sampler::sample_batch), with an error instead of a panic.
    ///
    /// # Errors
    /// If `u` or a field of `out` does not have one entry per direction, or the weights do not have one per direction
    /// and channel.
    pub fn try_sample_batch(
        &self,
        given: Given,
        directions: &[[f32; 3]],
        u: &[[f32; 2]],
        out: Sampled<'_>,
    ) -> Result<(), ShapeError> {
        let count = directions.len();
        expect("pairs of numbers", u.len(), count)?;
        expect("sampled directions", out.directions.len(), count)?;
        expect("densities", out.pdfs.len(), count)?;
        expect("weights", out.weights.len(), count * self.material.channel_count())?;
        self.sample_on(self.material.backend(), given, directions, u, out);
        Ok(())
    }

    fn sample_on(&self, backend: Backend, given: Given, known: &[[f32; 3]], u: &[[f32; 2]], out: Sampled<'_>) {
        parallel::sample(self.material.channel_count(), out, &|range, out| {
            let (known, u) = (&known[range.clone()], &u[range]);
            match &self.distribution {
                Distribution::Own(scheme) => scheme.bsdf.sample_batch(backend, given, known, u, out),
                Distribution::Lobes(lobes) => lobes.sample(&self.material, backend, given, known, u, out),
            }
        });
    }

    /// Draws directions and their densities as [`sample_batch`](Sampler::sample_batch) does, without the weights: for
    /// programs that evaluate later. A density of infinity means a mirror.
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn draw_batch(&self, known: &[[f32; 3]], u: &[[f32; 2]], directions: &mut [[f32; 3]], pdfs: &mut [f32]) {
        fitting(self.try_draw_batch(known, u, directions, pdfs));
    }

    /// Like [`draw_batch`](Sampler::draw_batch), with an error instead of a panic.
    ///
    /// # Errors
    /// If the slices do not have the same length.
    pub fn try_draw_batch(
        &self,
        known: &[[f32; 3]],
        u: &[[f32; 2]],
        directions: &mut [[f32; 3]],
        pdfs: &mut [f32],
    ) -> Result<(), ShapeError> {
        expect("pairs of numbers", u.len(), known.len())?;
        expect("sampled directions", directions.len(), known.len())?;
        expect("densities", pdfs.len(), known.len())?;
        self.draw_on(self.material.backend(), known, u, directions, pdfs);
        Ok(())
    }

    fn draw_on(
        &self,
        backend: Backend,
        known: &[[f32; 3]],
        u: &[[f32; 2]],
        directions: &mut [[f32; 3]],
        pdfs: &mut [f32],
    ) {
        parallel::fill_both(1, directions, pdfs, &|range, directions, pdfs| {
            let (known, u) = (&known[range.clone()], &u[range]);
            match &self.distribution {
                Distribution::Own(scheme) => scheme.bsdf.draw_batch(backend, known, u, directions, pdfs),
                Distribution::Lobes(lobes) => {
                    lobes.draw(&self.material, backend, known, u, directions, pdfs);
                }
            }
        });
    }

    /// The densities of many pairs, as [`pdf`](Sampler::pdf).
    ///
    /// # Panics
    /// If the numbers of `wi`, `wo` and `pdfs` differ.
    pub fn pdf_batch(&self, given: Given, wi: &[[f32; 3]], wo: &[[f32; 3]], pdfs: &mut [f32]) {
        fitting(self.try_pdf_batch(given, wi, wo, pdfs));
    }

    /// Like [`pdf_batch`](Sampler::pdf_batch), with an error instead of a panic.
    ///
    /// # Errors
    /// If the numbers of `wi`, `wo` and `pdfs` differ.
    pub fn try_pdf_batch(
        &self,
        given: Given,
        wi: &[[f32; 3]],
        wo: &[[f32; 3]],
        pdfs: &mut [f32],
    ) -> Result<(), ShapeError> {
        expect("directions wo", wo.len(), wi.len())?;
        expect("densities", pdfs.len(), wi.len())?;
        self.pdf_on(self.material.backend(), given, wi, wo, pdfs);
        Ok(())
    }

    fn pdf_on(&self, backend: Backend, given: Given, wi: &[[f32; 3]], wo: &[[f32; 3]], pdfs: &mut [f32]) {
        parallel::fill(1, pdfs, &|range, pdfs| {
            let (wi, wo) = (&wi[range.clone()], &wo[range]);
            match &self.distribution {
                Distribution::Own(scheme) => scheme.bsdf.pdf_batch(backend, given, wi, wo, pdfs),
                Distribution::Lobes(lobes) => {
                    let (known, other) = if given == Given::Light { (wi, wo) } else { (wo, wi) };
                    lobes.pdf(&self.material, backend, known, other, pdfs);
                }
            }
        });
    }

    /// Values (`f` in 1/sr, `[pair][channel]`, as from [`Material::eval_batch`]) and densities (as from
    /// [`pdf`](Sampler::pdf)) of many pairs, which weight samples drawn from lights. Computing both at once is faster
    /// than one after the other if they are read from the same place in a table.
    ///
    /// # Panics
    /// If the numbers of `wi`, `wo` and `pdfs` differ, or there is not one value per pair and channel.
    pub fn eval_pdf_batch(&self, given: Given, wi: &[[f32; 3]], wo: &[[f32; 3]], values: &mut [f32], pdfs: &mut [f32]) {
        fitting(self.try_eval_pdf_batch(given, wi, wo, values, pdfs));
    }

    /// Like [`eval_pdf_batch`](Sampler::eval_pdf_batch), with an error instead of a panic.
    ///
    /// # Errors
    /// If the numbers of `wi`, `wo` and `pdfs` differ, or there is not one value per pair and channel.
    pub fn try_eval_pdf_batch(
        &self,
        given: Given,
        wi: &[[f32; 3]],
        wo: &[[f32; 3]],
        values: &mut [f32],
        pdfs: &mut [f32],
    ) -> Result<(), ShapeError> {
        expect("directions wo", wo.len(), wi.len())?;
        expect("densities", pdfs.len(), wi.len())?;
        expect("values", values.len(), wi.len() * self.material.channel_count())?;
        self.eval_pdf_on(self.material.backend(), given, wi, wo, values, pdfs);
        Ok(())
    }

    fn eval_pdf_on(
        &self,
        backend: Backend,
        given: Given,
        wi: &[[f32; 3]],
        wo: &[[f32; 3]],
        values: &mut [f32],
        pdfs: &mut [f32],
    ) {
        let channels = self.material.channel_count();
        match &self.distribution {
            Distribution::Own(scheme) => parallel::fill_both(channels, values, pdfs, &|range, values, pdfs| {
                let (wi, wo) = (&wi[range.clone()], &wo[range]);
                scheme.bsdf.eval_pdf_batch(backend, given, wi, wo, values, pdfs);
            }),
            Distribution::Lobes(_) => {
                self.material.eval_batch_on(backend, wi, wo, values);
                self.pdf_on(backend, given, wi, wo, pdfs);
            }
        }
    }
}

impl Bsdf for Sampler {
    fn channels(&self) -> &Channels {
        self.material.channels()
    }

    fn holds(&self, aspect: Aspect) -> bool {
        self.material.holds(aspect)
    }

    fn is_isotropic(&self) -> bool {
        self.material.is_isotropic()
    }

    fn samples_mirrors(&self) -> bool {
        self.material.has_mirrors()
    }

    fn bytes(&self) -> usize {
        self.material.bytes() + Sampler::bytes(self)
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.material.eval_batch_on(backend, wi, wo, out);
    }

    fn sample_batch(&self, backend: Backend, given: Given, known: &[[f32; 3]], u: &[[f32; 2]], out: Sampled<'_>) {
        self.sample_on(backend, given, known, u, out);
    }

    fn draw_batch(&self, backend: Backend, known: &[[f32; 3]], u: &[[f32; 2]], out: &mut [[f32; 3]], pdfs: &mut [f32]) {
        self.draw_on(backend, known, u, out, pdfs);
    }

    fn pdf_batch(&self, backend: Backend, given: Given, wi: &[[f32; 3]], wo: &[[f32; 3]], pdfs: &mut [f32]) {
        self.pdf_on(backend, given, wi, wo, pdfs);
    }

    fn eval_pdf_batch(
        &self,
        backend: Backend,
        given: Given,
        wi: &[[f32; 3]],
        wo: &[[f32; 3]],
        values: &mut [f32],
        pdfs: &mut [f32],
    ) {
        self.eval_pdf_on(backend, given, wi, wo, values, pdfs);
    }

    fn mueller(&self, wi: [f32; 3], wo: [f32; 3], nm: f64) -> Option<Matrix> {
        self.material.mueller(wi, wo, nm)
    }

    fn is_polarised(&self) -> bool {
        self.material.is_polarised()
    }

    fn mueller_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) -> bool {
        Bsdf::mueller_batch(&*self.material, backend, wi, wo, out)
    }
}
