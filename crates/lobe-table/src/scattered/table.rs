//! Scattered samples prepared for evaluation in SIMD lanes.

use lobe_backend::Backend;
use lobe_lane::{Block, Floats, Ints, Kernel, Lanes, call};
use lobe_memory::Storage;

use super::data::{Data, SAME};
use super::locate::{Builder, Locate, Located, Meshes, index_bits};
use super::mesh::Mesh;
use crate::Scatter;
use crate::bsdf;
use crate::directions::Directions;
use crate::invalid::Invalid;
use crate::passes::block::{BLOCK, Column};
use crate::passes::pairs::{Evaluate, Pairs, evaluation};
use crate::passes::unit::{POLE, across, polar, unit};

/// Floats per incident direction: sine and cosine of its polar angle, the bits of the start of the squares of its mesh,
/// and 1 if azimuths count from the sample's own axis because it is at the pole.
const LIGHT: usize = 4;
/// The most incident directions with weights for a pair, and outgoing ones for each of them.
const LIGHTS: usize = 3;

/// [`Data`] laid out for evaluation in SIMD lanes.
///
/// The values are those of [`Data::eval`], `f` in 1/sr, one per channel, except that single precision places queries
/// between samples as if the directions were off by some 1e-6; see [`Data::bound`]. Directions need not be unit
/// vectors, but their lengths have to be between 1e-15 and 1e15. If samples are too close together for single
/// precision, `f64` is used.
///
/// In strict form ([`Lanes::strict`](lobe_lane::Lanes::strict)) all backends give the same bits.
#[derive(Clone, Debug)]
pub struct Table {
    data: Data,
    meshes: Meshes,
    /// The start of the squares of the mesh of incident directions.
    root: i32,
    /// The number of incident directions that may have weights for a pair: one, two, or three.
    count: usize,
    lights: Storage<f32>,
    /// Floats from a sample to the next: one, four, or a multiple of eight.
    stride: usize,
    values: Storage<f32>,
}

impl Table {
    /// Lays out samples.
    ///
    /// # Errors
    /// [`Invalid`] if there are more than a 32-bit index can address, or rounding left no simple curve around them.
    pub fn new(data: &Data) -> Result<Self, Invalid> {
        Table::try_new(data).ok_or_else(|| {
            let found = format!("{} samples", data.samples().count());
            Invalid::new("samples", found, "triangles within a simple curve, few enough for 32-bit indices")
        })
    }

    fn try_new(data: &Data) -> Option<Self> {
        let channels = data.channels().count();
        let stride = match channels {
            1 => 1,
            2..=4 => 4,
            _ => channels.next_multiple_of(8),
        };
        let samples: usize = data.incidences.iter().map(|incidence| incidence.outgoing.len()).sum();
        let len = samples.checked_mul(stride).filter(|len| i32::try_from(*len).is_ok())?;
        let mut values = Storage::zeros(len);
        let mut target = values.as_mut_slice().chunks_exact_mut(stride);
        let mut builder = Builder::default();
        let root = builder.add(&data.mesh, |index| index * LIGHT)?;
        let (mut lights, mut first) = (Vec::with_capacity(data.incidences.len() * LIGHT), 0);
        for incidence in data.incidences.iter() {
            let mesh = builder.add(&incidence.mesh, |index| (first + index) * stride)?;
            for (texel, target) in incidence.values.chunks_exact(channels).zip(&mut target) {
                target[..channels].copy_from_slice(texel);
            }
            first += incidence.outgoing.len();
            let is_fixed_pole = !data.is_isotropic && incidence.theta <= SAME;
            let (sin, cos) = libm::sincos(incidence.theta);
            lights.extend([sin as f32, cos as f32, index_bits(mesh as usize)?, f32::from(u8::from(is_fixed_pole))]);
        }
        let count = match (&*data.mesh, data.incidences.len()) {
            (_, 1) => 1,
            (Mesh::Line(_), _) => 2,
            (Mesh::Triangles(_), _) => LIGHTS,
        };
        let lights = Storage::copied(&lights);
        Some(Table { data: data.clone(), meshes: builder.finish(), root, count, lights, stride, values })
    }

    /// The samples.
    pub fn data(&self) -> &Data {
        &self.data
    }

    /// Bytes of memory that the table takes in addition to the samples.
    pub fn bytes(&self) -> usize {
        self.meshes.bytes() + self.lights.bytes() + self.values.bytes()
    }

    /// Evaluates `f` in 1/sr of many pairs on a backend: `out[query * channels + channel]`.
    ///
    /// # Panics
    /// The same as for [`batch`](Self::batch).
    pub fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        backend.run(self.batch(wi, wo, out));
    }

    /// The evaluation of many pairs as a kernel, for lanes that are not a [`Backend`]:
    /// `out[query * channels + channel]`, in 1/sr.
    ///
    /// # Panics
    /// If the numbers of `wi` and `wo` differ, or the length of `out` is not that number times the number of channels.
    pub fn batch<'a>(
        &'a self,
        wi: Directions<'a>,
        wo: Directions<'a>,
        out: &'a mut [f32],
    ) -> impl Kernel<Out = ()> + 'a {
        evaluation(self, wi, wo, out)
    }

    /// The values of one pair in `f64`, whose channels are written to `out`.
    #[cold]
    #[inline(never)]
    fn exact(&self, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        match bsdf::unit(wi).zip(bsdf::unit(wo)) {
            Some((wi, wo)) => out.copy_from_slice(&self.data.eval(wi, wo)),
            None => out.fill(0.0),
        }
    }
}

/// The intermediate values of a block.
pub(crate) struct Scratch {
    /// Sine and cosine of the polar angle of the light, and of its azimuth.
    theta: [Column; 2],
    phi: [Column; 2],
    /// The viewer, with the light above +x.
    viewer: [Column; 3],
    /// -1 if there is a value.
    valid: Column<i32>,
    located: Located,
    lights: [Column<i32>; LIGHTS],
    shares: [Column; LIGHTS],
    samples: [Column<i32>; 3 * LIGHTS],
    weights: [Column; 3 * LIGHTS],
}

impl Evaluate for &Table {
    type Scratch = Scratch;
    const SCRATCH: Scratch = Scratch {
        theta: [Column::<f32>::ZERO; 2],
        phi: [Column::<f32>::ZERO; 2],
        viewer: [Column::<f32>::ZERO; 3],
        valid: Column::<i32>::ZERO,
        located: Located::ZERO,
        lights: [Column::<i32>::ZERO; LIGHTS],
        shares: [Column::<f32>::ZERO; LIGHTS],
        samples: [Column::<i32>::ZERO; 3 * LIGHTS],
        weights: [Column::<f32>::ZERO; 3 * LIGHTS],
    };

    fn channel_count(self) -> usize {
        self.data.channels().count()
    }

    #[inline(always)]
    fn evaluate<L: Lanes>(self, lanes: L, n: usize, pairs: Pairs<'_>, scratch: &mut Scratch, out: &mut [f32]) {
        self.frame(lanes, n, pairs, scratch);
        call(lanes, Locate { meshes: &self.meshes, n, located: &mut scratch.located });
        scratch.lights = scratch.located.corners;
        scratch.shares = scratch.located.weights;
        let mut light = 0;
        while light < self.count {
            self.turn(lanes, n, light, scratch);
            call(lanes, Locate { meshes: &self.meshes, n, located: &mut scratch.located });
            let mut corner = 0;
            while corner < 3 {
                let (sample, share) = (&mut scratch.samples[3 * light + corner], &scratch.shares[light]);
                *sample = scratch.located.corners[corner];
                let weight = &mut scratch.weights[3 * light + corner];
                let mut query = 0;
                while query < n {
                    let product = scratch.located.weights[corner].load(lanes, query) * share.load(lanes, query);
                    weight.store(lanes, query, product);
                    query += L::LANES;
                }
                corner += 1;
            }
            light += 1;
        }
        match self.stride {
            1 => self.mono(lanes, n, scratch, out),
            4 => self.few(lanes, scratch, out),
            _ => self.many(lanes, scratch, out),
        }
        self.hard(lanes, n, pairs, scratch, out);
    }
}

impl Table {
    /// The viewer, rotated with the light onto +x, and the place of the light among the measured ones.
    #[inline(always)]
    fn frame<L: Lanes>(&self, lanes: L, n: usize, Pairs { wi, wo }: Pairs<'_>, scratch: &mut Scratch) {
        let Scratch { theta, phi, viewer, valid, located, .. } = scratch;
        let (zero, one, pole) = (lanes.splat(0.0), lanes.splat(1.0), lanes.splat(POLE));
        let (none, all) = (lanes.splat_int(0), lanes.splat_int(-1));
        let reflects = self.data.scatter() == Scatter::Reflection;
        let mut query = 0;
        while query < n {
            let (from, to) = (wi.load(lanes, query), wo.load(lanes, query));
            let on_sides = (zero.lt(from[2]) | from[2].lt(zero)) & (zero.lt(to[2]) | to[2].lt(zero));
            let crosses = zero.lt(from[2]) ^ zero.lt(to[2]);
            let fits = if reflects { !crosses } else { crosses };
            let (([x, y, z], lit), ([u, v, w], seen)) = (unit(lanes, from), unit(lanes, to));
            let z = z.abs();
            let sin = across(lanes, x, y);
            let tilted = pole.lt(sin);
            let scale = one / sin.max(pole);
            let (cos_phi, sin_phi) = (lanes.select(tilted, x * scale, one), (y * scale).masked(tilted));
            let angle = polar(lanes, sin, z);
            theta[0].store(lanes, query, sin);
            theta[1].store(lanes, query, z);
            phi[0].store(lanes, query, sin_phi);
            phi[1].store(lanes, query, cos_phi);
            viewer[0].store(lanes, query, lanes.mul_add(cos_phi, u, sin_phi * v));
            viewer[1].store(lanes, query, lanes.mul_add(cos_phi, v, -(sin_phi * u)));
            viewer[2].store(lanes, query, w.abs());
            // All lights of an isotropic material are on a line.
            let (at_x, at_y) = if self.data.is_isotropic { (angle, zero) } else { (angle * cos_phi, angle * sin_phi) };
            located.at[0].store(lanes, query, at_x);
            located.at[1].store(lanes, query, at_y);
            located.mesh.store(lanes, query, lanes.splat_int(self.root));
            located.is_hard.store(lanes, query, none);
            valid.store(lanes, query, lanes.select_int(on_sides & fits & lit & seen, all, none));
            query += L::LANES;
        }
    }

    /// The place of the viewer in the mesh of one of the lights, rotated in the plane of incidence with the mirror
    /// direction.
    #[inline(always)]
    fn turn<L: Lanes>(&self, lanes: L, n: usize, light: usize, scratch: &mut Scratch) {
        let Scratch { theta, phi, viewer, located, lights, .. } = scratch;
        let of_lights = Block::<1, LIGHT>::new(self.lights.as_slice(), [0]);
        let (zero, least) = (lanes.splat(0.0), lanes.splat(f32::MIN_POSITIVE));
        let side = lanes.splat(self.data.measured_side as f32);
        let mut query = 0;
        while query < n {
            let [[sin_light, cos_light, mesh, is_fixed_pole]] =
                lanes.gather_quads(&of_lights, lights[light].load(lanes, query));
            let (sin, cos) = (theta[0].load(lanes, query), theta[1].load(lanes, query));
            let sin_by = lanes.mul_add(sin_light, cos, -(cos_light * sin));
            let cos_by = lanes.mul_add(cos_light, cos, sin_light * sin);
            let (x, y, z) = (viewer[0].load(lanes, query), viewer[1].load(lanes, query), viewer[2].load(lanes, query));
            let ahead = lanes.mul_add(cos_by, x, -(sin_by * z));
            let up = lanes.mul_add(sin_by, x, cos_by * z).max(zero);
            let flat = across(lanes, ahead, y);
            let length = across(lanes, flat, up);
            let angle = lobe_math::double_atan(lanes, flat / (length + up).max(least));
            let scale = angle / flat.max(least);
            let (at_x, at_y) = (ahead * scale, y * scale);
            // The azimuths of a light at the pole count from the sample's own axis.
            let (sin_phi, cos_phi) = (phi[0].load(lanes, query), phi[1].load(lanes, query));
            let is_fixed = zero.lt(is_fixed_pole);
            let back_x = lanes.mul_add(cos_phi, at_x, -(sin_phi * at_y));
            let back_y = lanes.mul_add(cos_phi, at_y, sin_phi * at_x);
            let (at_x, at_y) = (lanes.select(is_fixed, back_x, at_x), lanes.select(is_fixed, back_y, at_y));
            // One side represents both if only one was measured.
            let at_y = if self.data.measured_side == 0.0 { at_y } else { at_y.abs() * side };
            located.at[0].store(lanes, query, at_x);
            located.at[1].store(lanes, query, at_y);
            located.mesh.store(lanes, query, mesh.bits());
            query += L::LANES;
        }
    }

    /// One channel: lanes run across queries.
    #[inline(always)]
    fn mono<L: Lanes>(&self, lanes: L, n: usize, scratch: &Scratch, out: &mut [f32]) {
        let Scratch { valid, samples, weights, .. } = scratch;
        let (values, corners) = (self.values.as_slice(), 3 * self.count);
        let mut query = 0;
        while query < n && query < out.len() {
            let mut sum = lanes.splat(0.0);
            let mut corner = 0;
            while corner < corners {
                let value = lanes.gather(values, samples[corner].load(lanes, query));
                sum = lanes.mul_add(value, weights[corner].load(lanes, query), sum);
                corner += 1;
            }
            let is_valid = valid.load(lanes, query).lt(lanes.splat_int(0));
            lanes.store_partial(&mut out[query..], sum.masked(is_valid));
            query += L::LANES;
        }
    }

    /// Up to four channels, which are one register.
    #[inline(always)]
    fn few<L: Lanes>(&self, lanes: L, scratch: &Scratch, out: &mut [f32]) {
        let Scratch { valid, samples, weights, .. } = scratch;
        let (channels, corners) = (self.data.channels().count(), 3 * self.count);
        let values = Block::<1, 4>::new(self.values.as_slice(), [0]);
        // Each store writes one extra float, which the next store overwrites.
        let mut tile = [0.0; 4 * BLOCK];
        let mut query = 0;
        while query < out.len() / channels {
            let mut sum = lanes.quad_splat(0.0);
            let mut corner = 0;
            while corner < corners {
                let [texel] = lanes.quad_corners(&values, samples[corner].one(query) as u32 as usize);
                sum = lanes.quad_mul_add(texel, lanes.quad_splat(weights[corner].one(query)), sum);
                corner += 1;
            }
            let at = channels * (query & (BLOCK - 1));
            lanes.quad_store(&mut tile[at..][..4], sum);
            if valid.one(query) == 0 {
                tile[at..][..4].fill(0.0);
            }
            query += 1;
        }
        out.copy_from_slice(&tile[..out.len()]);
    }

    /// Many channels: lanes run along them.
    #[inline(always)]
    fn many<L: Lanes>(&self, lanes: L, scratch: &Scratch, out: &mut [f32]) {
        let Scratch { valid, samples, weights, .. } = scratch;
        let (channels, corners) = (self.data.channels().count(), 3 * self.count);
        let values = Block::<1, 8>::new(self.values.as_slice(), [0]);
        let mut query = 0;
        while query < out.len() / channels {
            let mut channel = 0;
            while channel < channels {
                let mut sum = lanes.oct_splat(0.0);
                let mut corner = 0;
                while corner < corners {
                    let [texel] = lanes.oct_corners(&values, samples[corner].one(query) as u32 as usize + channel);
                    sum = lanes.oct_mul_add(texel, lanes.oct_splat(weights[corner].one(query)), sum);
                    corner += 1;
                }
                let mut eight = [0.0; 8];
                if valid.one(query) != 0 {
                    lanes.oct_store(&mut eight, sum);
                }
                let left = if channels - channel < 8 { channels - channel } else { 8 };
                out[query * channels + channel..][..left].copy_from_slice(&eight[..left]);
                channel += 8;
            }
            query += 1;
        }
    }

    /// Evaluates the queries that lanes left to double precision.
    #[inline(always)]
    fn hard<L: Lanes>(&self, lanes: L, n: usize, Pairs { wi, wo }: Pairs<'_>, scratch: &Scratch, out: &mut [f32]) {
        let channels = self.data.channels().count();
        let mut query = 0;
        while query < n {
            let zero = lanes.splat_int(0);
            let hard = scratch.located.is_hard.load(lanes, query).lt(zero) & scratch.valid.load(lanes, query).lt(zero);
            let mut left = lobe_lane::Mask::bits(hard);
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                let one_wi = lanes.extract_xyz(wi.load(lanes, query), lane);
                let one_wo = lanes.extract_xyz(wo.load(lanes, query), lane);
                if let Some(texel) = out.get_mut((query + lane) * channels..(query + lane + 1) * channels) {
                    self.exact(one_wi, one_wo, texel);
                }
            }
            query += L::LANES;
        }
    }
}
