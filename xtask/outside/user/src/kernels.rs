//! Kernels as in a renderer: its own, and those of the library.

use lobe::table::{Given, Sampled, Sampler};
use lobe::{Axis, Kernel, Lanes, math, specular};

/// The arc cosine of each number.
pub struct Acos<'a> {
    pub x: &'a [f32],
    pub out: &'a mut [f32],
}

impl Kernel for Acos<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let mut at = 0;
        while at < self.x.len() {
            lanes.store_partial(&mut self.out[at..], math::acos(lanes, lanes.load_partial(&self.x[at..])));
            at += L::LANES;
        }
    }
}

/// The azimuth of each vector.
pub struct Azimuth<'a> {
    pub x: &'a [f32],
    pub y: &'a [f32],
    pub out: &'a mut [f32],
}

impl Kernel for Azimuth<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let mut at = 0;
        while at < self.x.len() {
            let (x, y) = (lanes.load_partial(&self.x[at..]), lanes.load_partial(&self.y[at..]));
            lanes.store_partial(&mut self.out[at..], math::azimuth(lanes, y, x));
            at += L::LANES;
        }
    }
}

/// The cell of each angle, and the fraction into it.
pub struct Search<'a> {
    pub axis: &'a Axis,
    pub angles: &'a [f32],
    pub cells: &'a mut [i32],
    pub fractions: &'a mut [f32],
}

impl Kernel for Search<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let mut at = 0;
        while at < self.angles.len() {
            let found = self.axis.cell(lanes, lanes.load_partial(&self.angles[at..]));
            lanes.store_int_partial(&mut self.cells[at..], found.index);
            lanes.store_partial(&mut self.fractions[at..], found.fraction);
            at += L::LANES;
        }
    }
}

/// RGB of each pair, inside a loop of the caller.
pub struct InLanes<'a> {
    pub table: &'a specular::Table,
    pub wi: &'a [[f32; 3]],
    pub wo: &'a [[f32; 3]],
    pub out: [&'a mut [f32]; 3],
}

impl Kernel for InLanes<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let mut at = 0;
        while at + L::LANES <= self.wi.len() {
            let (wi, wo) = (lanes.load_xyz(&self.wi[at..]), lanes.load_xyz(&self.wo[at..]));
            let mut rgb = [lanes.splat(0.0); 3];
            self.table.eval_lanes(lanes, wi, wo, lanes.first_n(L::LANES), &mut rgb);
            let mut channel = 0;
            while channel < 3 {
                lanes.store(&mut self.out[channel][at..], rgb[channel]);
                channel += 1;
            }
            at += L::LANES;
        }
    }
}

/// A direction sampled for each known direction.
pub struct Sample<'a> {
    pub sampler: &'a Sampler,
    pub known: &'a [[f32; 3]],
    pub uniforms: &'a [[f32; 2]],
    pub out: Sampled<'a>,
}

impl Kernel for Sample<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        self.sampler.sample_on_lanes(lanes, Given::Light, self.known, self.uniforms, self.out);
    }
}
