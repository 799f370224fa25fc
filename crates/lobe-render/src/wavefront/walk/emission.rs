//! The stage that begins light paths.

use std::ops::Range;

use lobe::{Kernel, Lanes};

use super::{Walk, Wavefront};
use crate::channels::Channels;
use crate::clock::Instant;
use crate::columns::{Column, RAYS, ZEROS, ensure_len, store, vector};
use crate::connect::{Emission, Mis, Pass};
use crate::film::Sample;
use crate::light::{Light, Lights};
use crate::random::{Dimensions, Numbers, Sequence};
use crate::transport::Transport;
use crate::vec3;
use crate::wavefront::rays::Ray;
use crate::wavefront::{PathSlot, PathState};

/// 64 rays that leave lights.
#[derive(Clone, Debug)]
pub(super) struct EmittedBlock<T: Transport> {
    origin: [Column; 3],
    direction: [Column; 3],
    emitted: <T::Spectrum as Channels>::Columns,
    pdf: [Column; 2],
    light: [i32; RAYS],
    /// 1 if it carries light, otherwise 0.
    valid: Column,
}

impl<T: Transport> EmittedBlock<T> {
    const ZEROS: Self = EmittedBlock {
        origin: [ZEROS; 3],
        direction: [ZEROS; 3],
        emitted: T::Spectrum::ZERO_COLUMNS,
        pdf: [ZEROS; 2],
        light: [0; RAYS],
        valid: ZEROS,
    };
}

impl<T: Transport> Wavefront<'_, T> {
    /// Rays that leave the lights, the first wave of light paths.
    pub(super) fn emit_paths(&mut self, paths: Range<u32>, pass: &Pass) {
        let begun = Instant::now();
        self.slots.clear();
        self.rays.clear();
        let slot =
            |path| PathSlot { pixel: [0; 2], sequence: Sequence::of_light(path, pass.number), sample: Sample::EMPTY };
        self.slots.extend(paths.map(slot));
        let n = self.slots.len();
        let sequences = || self.slots.iter().map(|slot| slot.sequence);
        self.numbers.sample(self.backend, sequences(), Dimensions::Camera);
        self.walks.choices.sample(self.backend, sequences(), Dimensions::Light(0));
        ensure_len(&mut self.walks.emitted, n.div_ceil(RAYS), EmittedBlock::ZEROS);
        let lights = &self.world.lights;
        self.backend.run(EmitRays {
            lights,
            numbers: &self.numbers,
            choices: &self.walks.choices,
            n,
            out: &mut self.walks.emitted,
        });
        let (walks, blocks) = (&mut self.walks.walks, &self.walks.emitted);
        walks.clear();
        self.rays.extend(n, |out| {
            for path in 0..n {
                let (block, at) = (&blocks[path / RAYS], path % RAYS);
                let number = block.light[at] as usize;
                let (light, chance) = (&lights.all[number], lights.chance(number));
                let [position, direction] = block.pdf.each_ref().map(|column| column[at]);
                let cos = match light {
                    Light::Area(area) => direction * area.cosine_over_pdf(),
                    _ => 1.0,
                };
                let finite = !matches!(light, Light::Directional { .. } | Light::Environment(_));
                let emission = Emission { position, direction, chance, cos, finite, delta: light.is_delta() };
                let mut flux = T::Spectrum::ZERO;
                for (flux, column) in flux.as_mut().iter_mut().zip(block.emitted.as_ref()) {
                    *flux = column[at] / (position * direction * chance);
                }
                let mut origin = vector(&block.origin, at);
                let way = vector(&block.direction, at);
                if light.has_surface() {
                    // Off the surface, by the same distance as rays from other surfaces.
                    let reach = origin.iter().fold(0.0f32, |most, x| most.max(x.abs()));
                    let step = (reach / 65_536.0).max(1e-9) / cos.max(1e-3);
                    origin = vec3::add(origin, vec3::scale(way, step));
                }
                let mis = Mis::of_light(emission, pass.factors);
                walks.push(Walk { mis, flux, hit: 0, from_afar: !finite });
                let some = flux.as_ref().iter().fold(false, |some, x| some | (*x != 0.0));
                let state = PathState { slot: path as u32, throughput: T::START, pdf: f32::INFINITY };
                out.write(Ray { origin, direction: way }, f32::INFINITY, state, some & (block.valid[at] > 0.0));
            }
        });
        self.stats.light_paths += n as u64;
        self.stats.lights += begun.elapsed();
    }
}

struct EmitRays<'a, T: Transport> {
    lights: &'a Lights<T::Spectrum>,
    numbers: &'a Numbers,
    choices: &'a Numbers,
    n: usize,
    out: &'a mut [EmittedBlock<T>],
}

impl<T: Transport> Kernel for EmitRays<'_, T> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let EmitRays { lights, numbers, choices, n, out } = self;
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let mut at = 0;
        while at < n {
            let [choice, ..] = choices.lanes(lanes, at);
            let emitting = lights.sample_le(lanes, choice, numbers.lanes(lanes, at));
            let sample = emitting.sample;
            let (out, first) = (&mut out[at / RAYS], at & (RAYS - L::LANES));
            store(lanes, &mut out.origin, first, sample.origin);
            store(lanes, &mut out.direction, first, sample.direction);
            let (columns, emitted) = (out.emitted.as_mut(), sample.emitted.as_ref());
            let mut k = 0;
            while k < T::Spectrum::COUNT {
                lanes.store(&mut columns[k][first..], emitted[k]);
                k += 1;
            }
            lanes.store(&mut out.pdf[0][first..], sample.pdf.position);
            lanes.store(&mut out.pdf[1][first..], sample.pdf.direction);
            lanes.store_int(&mut out.light[first..], emitting.light);
            lanes.store(&mut out.valid[first..], lanes.select(sample.valid, one, zero));
            at += L::LANES;
        }
    }
}
