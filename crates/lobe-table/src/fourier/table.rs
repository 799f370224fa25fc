//! [`Data`] prepared for evaluation in SIMD lanes.

use lobe_backend::Backend;
use lobe_lane::{Kernel, Lanes};

use super::data::Data;
use super::place::{Place, colours};
use crate::directions::Directions;
use crate::passes::block::{BLOCK, Column};
use crate::passes::pairs::{Evaluate, Pairs, evaluation};

/// The number of coefficients that are summed at once.
const OCT: usize = 8;
/// The number of cosines that are computed before coefficients are multiplied by them.
const CHUNK: usize = 64;

/// [`Data`] for evaluation in SIMD lanes.
///
/// The values are those of [`Data::eval`], in `f32`: `f` in 1/sr, without the cosine. The directions need not be unit
/// vectors, but their lengths have to be between 1e-15 and 1e15. The place of a pair among the knots is found in `f64`;
/// its series are summed along the coefficients, eight at a time on every backend.
///
/// In strict form ([`Lanes::strict`](lobe_lane::Lanes::strict)) all backends give the same bits.
#[derive(Clone, Debug)]
pub struct Table {
    data: Data,
}

impl Table {
    /// Stores the coefficients unchanged.
    pub fn new(data: &Data) -> Self {
        Table { data: data.clone() }
    }

    /// The coefficients.
    pub fn data(&self) -> &Data {
        &self.data
    }

    /// Bytes of memory that the table takes.
    pub fn bytes(&self) -> usize {
        let parts = self.data.parts();
        let floats = parts.mu.len() + parts.coefficients.len();
        floats * size_of::<f32>() + size_of_val(parts.series.as_slice())
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

    /// The sums of the series around a place.
    #[inline(always)]
    fn sums<L: Lanes>(&self, lanes: L, place: &Place) -> [f64; 3] {
        let channels = self.data.parts().channels.count();
        let mut cosines = Cosines::new(place.cos_phi);
        let mut terms = [0.0; CHUNK];
        let mut sums = [0.0; 3];
        let mut first = 0;
        let mut longest = 1;
        while first < longest {
            cosines.fill(&mut terms);
            let mut corner = 0;
            while corner < 16 {
                if let Some(([viewer, light], weight)) = place.corner(corner) {
                    let series = self.data.series(viewer, light);
                    let count = series.count as usize;
                    longest = longest.max(count);
                    if first < count {
                        let end = count.min(first + CHUNK);
                        let mut channel = 0;
                        while channel < channels {
                            let coefficients = &self.data.coefficients(series, channel)[first..end];
                            sums[channel] += weight * dot(lanes, coefficients, &terms);
                            channel += 1;
                        }
                    }
                }
                corner += 1;
            }
            first += CHUNK;
        }
        sums
    }
}

/// The sum of products, as eight partial sums that are added at the end.
#[inline(always)]
fn dot<L: Lanes>(lanes: L, coefficients: &[f32], terms: &[f32; CHUNK]) -> f64 {
    let mut sum = lanes.oct_splat(0.0);
    let whole = coefficients.len() / OCT * OCT;
    let mut at = 0;
    while at < whole {
        sum = lanes.oct_mul_add(lanes.oct_load(&coefficients[at..]), lanes.oct_load(&terms[at..]), sum);
        at += OCT;
    }
    if whole < coefficients.len() {
        let mut rest = [0.0; OCT];
        rest[..coefficients.len() - whole].copy_from_slice(&coefficients[whole..]);
        sum = lanes.oct_mul_add(lanes.oct_load(&rest), lanes.oct_load(&terms[whole..]), sum);
    }
    let mut sums = [0.0; OCT];
    lanes.oct_store(&mut sums, sum);
    let mut total = 0.0;
    at = 0;
    while at < OCT {
        total += f64::from(sums[at]);
        at += 1;
    }
    total
}

/// The cosines of the multiples of an angle, eight at a time: `cos((k + 8) x) = 2 cos(8 x) cos(k x) - cos((k - 8) x)`.
struct Cosines {
    before: [f64; OCT],
    next: [f64; OCT],
    twice: f64,
}

impl Cosines {
    fn new(cosine: f64) -> Self {
        let mut all = [1.0; 2 * OCT];
        all[1] = cosine;
        for k in 2..2 * OCT {
            all[k] = 2.0 * cosine * all[k - 1] - all[k - 2];
        }
        // The cosine is even, so those before 0 equal those after it.
        let before = [8, 7, 6, 5, 4, 3, 2, 1].map(|k| all[k]);
        let next = [0, 1, 2, 3, 4, 5, 6, 7].map(|k| all[k]);
        Cosines { before, next, twice: 2.0 * all[OCT] }
    }

    fn fill(&mut self, terms: &mut [f32; CHUNK]) {
        for eight in terms.chunks_exact_mut(OCT) {
            for (k, term) in eight.iter_mut().enumerate() {
                *term = self.next[k] as f32;
                let after = self.twice * self.next[k] - self.before[k];
                (self.before[k], self.next[k]) = (self.next[k], after);
            }
        }
    }
}

/// The directions of a block, component by component.
pub(crate) struct Scratch {
    wi: [Column; 3],
    wo: [Column; 3],
}

impl Evaluate for &Table {
    type Scratch = Scratch;
    const SCRATCH: Scratch = Scratch { wi: [Column::<f32>::ZERO; 3], wo: [Column::<f32>::ZERO; 3] };

    fn channel_count(self) -> usize {
        self.data.parts().channels.count()
    }

    #[inline(always)]
    fn evaluate<L: Lanes>(self, lanes: L, n: usize, pairs: Pairs<'_>, scratch: &mut Scratch, out: &mut [f32]) {
        let mut query = 0;
        while query < n {
            let (wi, wo) = (pairs.wi.load(lanes, query), pairs.wo.load(lanes, query));
            let mut axis = 0;
            while axis < 3 {
                scratch.wi[axis].store(lanes, query, wi[axis]);
                scratch.wo[axis].store(lanes, query, wo[axis]);
                axis += 1;
            }
            query += L::LANES;
        }
        let channels = self.data.parts().channels.count();
        let count = (out.len() / channels).min(BLOCK);
        query = 0;
        while query < count {
            let (mut wi, mut wo) = ([0.0; 3], [0.0; 3]);
            let mut axis = 0;
            while axis < 3 {
                wi[axis] = f64::from(scratch.wi[axis].one(query));
                wo[axis] = f64::from(scratch.wo[axis].one(query));
                axis += 1;
            }
            let (mut values, mut scale) = ([0.0; 3], 0.0);
            if let Some(place) = Place::find(&self.data, wi, wo) {
                (values, scale) = (colours(self.sums(lanes, &place), channels), place.scale);
            }
            let mut channel = 0;
            while channel < channels {
                out[query * channels + channel] = (values[channel] * scale) as f32;
                channel += 1;
            }
            query += 1;
        }
    }
}
