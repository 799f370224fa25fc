//! The subjects of the checks: backends, through the public functions, and emulated widths, which only these checks
//! compile.

use std::sync::Arc;

use lobe::Backend;
use lobe_lane::Kernel;
#[cfg(feature = "emulated")]
use lobe_lane::Lanes as _;
#[cfg(feature = "emulated")]
use lobe_scalar::Scalar;
use lobe_table::half_diff::{self, Lookup};
use lobe_table::rgl::{self, Drawn, UniformOrder, Wanted};
use lobe_table::{
    Directions, Given, PatchSampler, Sampled, Sampler, SamplerOptions, mueller, polarised, scattered, specular,
    spherical, utia, window,
};

/// Pairs of directions.
pub(crate) type Pairs<'a> = [Directions<'a>; 2];

/// A way of running everything that is checked. Each call enters the backend like the call of a user.
pub(crate) trait Machine: Copy {
    fn run<K: Kernel>(self, kernel: K) -> K::Out;
    fn eval(self, table: &specular::Table, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]);
    fn eval_batch(self, table: &specular::Table, pairs: Pairs<'_>, out: &mut [f32]);
    fn interpolate(self, table: &specular::Table, angles: [&[f32]; 4], out: &mut [f32]);
    fn half_diff(self, table: &half_diff::Table, lookup: Lookup, pairs: Pairs<'_>, out: &mut [f32]);
    fn spherical(self, table: &spherical::Table, pairs: Pairs<'_>, out: &mut [f32]);
    fn scattered(self, table: &scattered::Table, pairs: Pairs<'_>, out: &mut [f32]);
    fn utia(self, table: &utia::Table, pairs: Pairs<'_>, out: &mut [f32]);
    fn mueller(self, table: &mueller::Table, pairs: Pairs<'_>, out: &mut [f32]);
    fn matrices(self, table: &mueller::Matrices, pairs: Pairs<'_>, out: &mut [f32]);
    fn polarised(self, table: &polarised::Matrices, pairs: Pairs<'_>, out: &mut [f32]);
    fn window(self, table: &window::Table, pairs: Pairs<'_>, out: &mut [f32]);
    fn rgl(self, table: &rgl::Table, pairs: Pairs<'_>, wanted: Wanted<'_>);
    fn rgl_sample(self, table: &rgl::Table, wi: Directions<'_>, u: &[[f32; 2]], drawn: Drawn<'_>);
    fn sampler(self, table: Arc<specular::Table>) -> Sampler;
    fn sample(self, sampler: &Sampler, given: Given, known: &[[f32; 3]], u: &[[f32; 2]], out: Sampled<'_>);
    fn densities(self, sampler: &Sampler, given: Given, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]);
    fn patches(
        self,
        sampler: &PatchSampler,
        known: &[[f32; 3]],
        u: &[[f32; 2]],
        out: &mut [[f32; 3]],
        pdfs: &mut [f32],
    );
    fn patch_densities(self, sampler: &PatchSampler, known: &[[f32; 3]], other: &[[f32; 3]], out: &mut [f32]);
}

const OPTIONS: &str = "options that suit every table";

impl Machine for Backend {
    fn run<K: Kernel>(self, kernel: K) -> K::Out {
        Backend::run(&self, kernel)
    }

    fn eval(self, table: &specular::Table, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        table.eval(self, wi, wo, out);
    }

    fn eval_batch(self, table: &specular::Table, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        table.eval_batch(self, wi, wo, out);
    }

    fn interpolate(self, table: &specular::Table, angles: [&[f32]; 4], out: &mut [f32]) {
        table.interpolate_batch(self, angles, out);
    }

    fn half_diff(self, table: &half_diff::Table, lookup: Lookup, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        table.eval_batch(self, lookup, wi, wo, out);
    }

    fn spherical(self, table: &spherical::Table, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        table.eval_batch(self, wi, wo, out);
    }

    fn scattered(self, table: &scattered::Table, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        table.eval_batch(self, wi, wo, out);
    }

    fn utia(self, table: &utia::Table, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        table.eval_batch(self, wi, wo, out);
    }

    fn mueller(self, table: &mueller::Table, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        table.eval_batch(self, wi, wo, out);
    }

    fn matrices(self, table: &mueller::Matrices, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        table.eval_batch(self, wi, wo, out);
    }

    fn polarised(self, table: &polarised::Matrices, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        table.eval_batch(self, wi, wo, out);
    }

    fn window(self, table: &window::Table, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        table.eval_batch(self, wi, wo, out);
    }

    fn rgl(self, table: &rgl::Table, [wi, wo]: Pairs<'_>, wanted: Wanted<'_>) {
        table.evaluate(self, wi, wo, wanted);
    }

    fn rgl_sample(self, table: &rgl::Table, wi: Directions<'_>, u: &[[f32; 2]], drawn: Drawn<'_>) {
        table.sample_batch(self, wi, u, UniformOrder::Pbrt, drawn);
    }

    fn sampler(self, table: Arc<specular::Table>) -> Sampler {
        Sampler::new(self, table, &SamplerOptions::default()).expect(OPTIONS)
    }

    fn sample(self, sampler: &Sampler, given: Given, known: &[[f32; 3]], u: &[[f32; 2]], out: Sampled<'_>) {
        sampler.sample_batch(self, given, known, u, out);
    }

    fn densities(self, sampler: &Sampler, given: Given, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        sampler.pdf_batch(self, given, wi, wo, out);
    }

    fn patches(
        self,
        sampler: &PatchSampler,
        known: &[[f32; 3]],
        u: &[[f32; 2]],
        out: &mut [[f32; 3]],
        pdfs: &mut [f32],
    ) {
        sampler.draw_batch(self, known, u, out, pdfs);
    }

    fn patch_densities(self, sampler: &PatchSampler, known: &[[f32; 3]], other: &[[f32; 3]], out: &mut [f32]) {
        sampler.pdf_batch(self, known, other, out);
    }
}

/// `N` lanes in plain Rust.
#[cfg(feature = "emulated")]
#[derive(Clone, Copy)]
pub(crate) struct Emulated<const N: usize>;

#[cfg(feature = "emulated")]
impl<const N: usize> Machine for Emulated<N> {
    fn run<K: Kernel>(self, kernel: K) -> K::Out {
        Scalar::<N>.vectorize(kernel)
    }

    fn eval(self, table: &specular::Table, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        self.run(table.single(wi, wo, out));
    }

    fn eval_batch(self, table: &specular::Table, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        self.run(table.batch(wi, wo, out));
    }

    fn interpolate(self, table: &specular::Table, angles: [&[f32]; 4], out: &mut [f32]) {
        self.run(table.interpolation(angles, out));
    }

    fn half_diff(self, table: &half_diff::Table, lookup: Lookup, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        self.run(table.batch(lookup, wi, wo, out));
    }

    fn spherical(self, table: &spherical::Table, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        self.run(table.batch(wi, wo, out));
    }

    fn scattered(self, table: &scattered::Table, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        self.run(table.batch(wi, wo, out));
    }

    fn utia(self, table: &utia::Table, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        self.run(table.batch(wi, wo, out));
    }

    fn mueller(self, table: &mueller::Table, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        self.run(table.batch(wi, wo, out));
    }

    fn matrices(self, table: &mueller::Matrices, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        self.run(table.batch(wi, wo, out));
    }

    fn polarised(self, table: &polarised::Matrices, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        self.run(table.batch(wi, wo, out));
    }

    fn window(self, table: &window::Table, [wi, wo]: Pairs<'_>, out: &mut [f32]) {
        self.run(table.batch(wi, wo, out));
    }

    fn rgl(self, table: &rgl::Table, [wi, wo]: Pairs<'_>, wanted: Wanted<'_>) {
        self.run(table.batch(wi, wo, wanted));
    }

    fn rgl_sample(self, table: &rgl::Table, wi: Directions<'_>, u: &[[f32; 2]], drawn: Drawn<'_>) {
        self.run(table.sampling(wi, u, UniformOrder::Pbrt, drawn));
    }

    fn sampler(self, table: Arc<specular::Table>) -> Sampler {
        Sampler::on_lanes(Scalar::<N>, table, &SamplerOptions::default()).expect(OPTIONS)
    }

    fn sample(self, sampler: &Sampler, given: Given, known: &[[f32; 3]], u: &[[f32; 2]], out: Sampled<'_>) {
        sampler.sample_on_lanes(Scalar::<N>, given, known, u, out);
    }

    fn densities(self, sampler: &Sampler, given: Given, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        let (known, other) = if given == Given::Light { (wi, wo) } else { (wo, wi) };
        self.run(sampler.distribution().densities(known, other, out));
    }

    fn patches(
        self,
        sampler: &PatchSampler,
        known: &[[f32; 3]],
        u: &[[f32; 2]],
        out: &mut [[f32; 3]],
        pdfs: &mut [f32],
    ) {
        self.run(sampler.drawing(known, u, out, pdfs));
    }

    fn patch_densities(self, sampler: &PatchSampler, known: &[[f32; 3]], other: &[[f32; 3]], out: &mut [f32]) {
        self.run(sampler.densities(known, other, out));
    }
}
