//! [`Data`] prepared for evaluation in SIMD lanes.

use lobe_backend::Backend;
use lobe_lane::{Floats, Kernel, Lanes};

use super::data::{Data, MAX_ORDER};
use crate::Channels;
use crate::directions::Directions;
use crate::passes::block::BLOCK;
use crate::passes::pairs::{Evaluate, Pairs, evaluation};

/// Azimuthal orders.
const AZIMUTHAL: usize = MAX_ORDER as usize + 1;
/// Radial polynomials of all azimuthal orders.
const RADIAL: usize = 72;
/// More lanes than any backend has.
const MAX_LANES: usize = 64;

/// [`Data`] for evaluation in SIMD lanes.
///
/// The values are those of [`Data::eval`], in `f32`: `f` in 1/sr, without the cosine. The directions need not be unit
/// vectors, but their lengths have to be between 1e-15 and 1e15.
///
/// Polynomials are computed by recurrence as Jacobi polynomials of the squared radius, which loses no digits; the
/// cosines of the multiples of the azimuth are powers of a complex number, without an angle.
///
/// In strict form ([`Lanes::strict`](lobe_lane::Lanes::strict)) all backends give the same bits.
#[derive(Clone, Debug)]
pub struct Table {
    channels: Channels,
    /// The polynomials of each azimuthal order, starting with order 0.
    orders: Vec<Order>,
    /// The recurrence from a polynomial and the one before it to the next, for all polynomials of an order after the
    /// first: see [`Step`].
    steps: Vec<Step>,
    /// `[channel]`, then for each azimuthal order the factors of the products `[of wi][of wo]`.
    factors: Vec<f32>,
}

/// The polynomials of one azimuthal order.
#[derive(Clone, Copy, Debug)]
struct Order {
    count: usize,
    /// The position of its first step.
    steps: usize,
    /// The position of its first factor among those of a channel.
    factors: usize,
}

/// `(slope x + offset) last + before`, of `x = 2 rho^2 - 1`.
#[derive(Clone, Copy, Debug)]
struct Step {
    slope: f32,
    offset: f32,
    before: f32,
}

impl Step {
    /// The step from the Jacobi polynomials `P^(0, l)` of degree `k - 1` and `k - 2` to the one of degree `k`.
    fn new(l: usize, k: usize) -> Self {
        let (l, k) = (l as f64, k as f64);
        let (slope, offset, before) = match k {
            1.0 => ((l + 2.0) / 2.0, -l / 2.0, 0.0),
            _ => {
                let of = 2.0 * k * (k + l) * (2.0 * k + l - 2.0);
                let middle = 2.0 * k + l - 1.0;
                (
                    middle * (2.0 * k + l) * (2.0 * k + l - 2.0) / of,
                    -middle * l * l / of,
                    -2.0 * (k - 1.0) * (k + l - 1.0) * (2.0 * k + l) / of,
                )
            }
        };
        Step { slope: slope as f32, offset: offset as f32, before: before as f32 }
    }
}

impl Table {
    /// Gathers the terms by their polynomials.
    pub fn new(data: &Data) -> Self {
        let highest = data.order();
        let (mut orders, mut steps, mut per_channel) = (Vec::new(), Vec::new(), 0);
        for l in 0..=highest {
            let count = (highest - l) / 2 + 1;
            orders.push(Order { count, steps: steps.len(), factors: per_channel });
            steps.extend((1..count).map(|k| Step::new(l, k)));
            per_channel += count * count;
        }
        let mut factors = Vec::with_capacity(per_channel * data.channels().count());
        for micrometres in data.micrometres() {
            let mut of_channel = vec![0.0; per_channel];
            for term in data.terms() {
                let l = usize::from(term.azimuthal);
                let [n, m] = term.radial.map(|order| (usize::from(order) - l) / 2);
                let Order { count, factors, .. } = orders[l];
                let factor = term.factor(micrometres);
                of_channel[factors + n * count + m] += factor;
                of_channel[factors + m * count + n] += factor;
            }
            factors.extend(of_channel.into_iter().map(|factor: f64| factor as f32));
        }
        Table { channels: data.channels().clone(), orders, steps, factors }
    }

    /// The channels.
    pub fn channels(&self) -> &Channels {
        &self.channels
    }

    /// Bytes of memory that the table takes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.factors.as_slice()) + size_of_val(self.steps.as_slice()) + size_of_val(self.orders.as_slice())
    }

    /// Evaluates many pairs on a backend: `out[query * channels + channel]`.
    ///
    /// # Panics
    /// The same as for [`batch`](Self::batch).
    pub fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        backend.run(self.batch(wi, wo, out));
    }

    /// The evaluation of many pairs as a kernel, for lanes that are not a [`Backend`]:
    /// `out[query * channels + channel]`.
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

    /// All Jacobi polynomials of a squared radius, without the power of the radius.
    #[inline(always)]
    fn polynomials<L: Lanes>(&self, lanes: L, square: L::F) -> [L::F; RADIAL] {
        let mut all = [lanes.splat(1.0); RADIAL];
        let x = square + square - lanes.splat(1.0);
        let (mut l, mut first) = (0, 0);
        while l < self.orders.len() {
            let Order { count, steps, .. } = self.orders[l];
            let (mut last, mut before) = (lanes.splat(1.0), lanes.splat(0.0));
            let mut k = 1;
            while k < count {
                let step = self.steps[steps + k - 1];
                let slope = lanes.mul_add(lanes.splat(step.slope), x, lanes.splat(step.offset));
                let next = lanes.mul_add(slope, last, lanes.splat(step.before) * before);
                all[first + k] = next;
                (before, last) = (last, next);
                k += 1;
            }
            first += count;
            l += 1;
        }
        all
    }

    /// The sum over all products of polynomials for one channel.
    #[inline(always)]
    fn sum<L: Lanes>(
        &self,
        lanes: L,
        channel: usize,
        of_wi: &[L::F; RADIAL],
        of_wo: &[L::F; RADIAL],
        cosines: &[L::F; AZIMUTHAL],
    ) -> L::F {
        let per_channel = self.factors.len() / self.channels.count();
        let mut sum = lanes.splat(0.0);
        let (mut l, mut first) = (0, 0);
        while l < self.orders.len() {
            let Order { count, factors, .. } = self.orders[l];
            let mut of_order = lanes.splat(0.0);
            let mut i = 0;
            while i < count {
                let row = channel * per_channel + factors + i * count;
                let mut inner = lanes.splat(0.0);
                let mut o = 0;
                while o < count {
                    inner = lanes.mul_add(lanes.splat(self.factors[row + o]), of_wo[first + o], inner);
                    o += 1;
                }
                of_order = lanes.mul_add(of_wi[first + i], inner, of_order);
                i += 1;
            }
            sum = lanes.mul_add(cosines[l], of_order, sum);
            first += count;
            l += 1;
        }
        sum
    }
}

/// The point of the unit disk of a direction, and whether the direction is above the surface and finite.
#[inline(always)]
fn on_disk<L: Lanes>(lanes: L, [x, y, z]: [L::F; 3]) -> ([L::F; 2], L::M) {
    let length = lanes.mul_add(x, x, lanes.mul_add(y, y, z * z)).sqrt();
    // 1 - cos theta without a difference: sin^2 theta / (1 + cos theta).
    let scale = lanes.splat(1.0) / (length * (length + z)).sqrt();
    let zero = lanes.splat(0.0);
    ([x * scale, y * scale], z.gt(zero) & scale.gt(zero))
}

impl Evaluate for &Table {
    type Scratch = ();
    const SCRATCH: () = ();

    fn channel_count(self) -> usize {
        self.channels.count()
    }

    #[inline(always)]
    fn evaluate<L: Lanes>(self, lanes: L, n: usize, pairs: Pairs<'_>, (): &mut (), out: &mut [f32]) {
        let channels = self.channels.count();
        let count = (out.len() / channels).min(BLOCK);
        let zero = lanes.splat(0.0);
        let mut query = 0;
        while query < n {
            let (wi, wo) = (pairs.wi.load(lanes, query), pairs.wo.load(lanes, query));
            let (([ix, iy], is_lit), ([ox, oy], is_seen)) = (on_disk(lanes, wi), on_disk(lanes, wo));
            let of_wi = self.polynomials(lanes, lanes.mul_add(ix, ix, iy * iy));
            let of_wo = self.polynomials(lanes, lanes.mul_add(ox, ox, oy * oy));
            // (rho_i rho_o)^l cos(l phi) is the real part of a power.
            let (real, imaginary) = (lanes.mul_add(ix, ox, iy * oy), lanes.mul_add(ix, oy, -(iy * ox)));
            let mut cosines = [lanes.splat(1.0); AZIMUTHAL];
            let (mut re, mut im) = (lanes.splat(1.0), zero);
            let mut l = 1;
            while l < self.orders.len() {
                (re, im) = (lanes.mul_add(re, real, -(im * imaginary)), lanes.mul_add(re, imaginary, im * real));
                cosines[l] = re;
                l += 1;
            }
            let mut values = [0.0; MAX_LANES];
            let mut channel = 0;
            while channel < channels {
                let sum = self.sum(lanes, channel, &of_wi, &of_wo, &cosines).masked(is_lit & is_seen);
                lanes.store(&mut values[..L::LANES], sum);
                let mut lane = 0;
                while lane < L::LANES && query + lane < count {
                    out[(query + lane) * channels + channel] = values[lane];
                    lane += 1;
                }
                channel += 1;
            }
            query += L::LANES;
        }
    }
}
