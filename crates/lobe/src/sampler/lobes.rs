//! A mixture of lobes: for each side a lobe of reflection and one of transmission, and mirrors.

use lobe_table::{
    Aspect, Distribution, DistributionOptions, Given, PatchSampler, Sampled, SamplerError, SamplerOptions, Scatter,
    Side,
};

use crate::material::{flipped, mirrored};
use crate::{Backend, Material};

const SCATTERS: [Scatter; 2] = [Scatter::Reflection, Scatter::Transmission];
const SIDES: [Side; 2] = [Side::Front, Side::Back];

/// The lobes of light from the front and from the back, of reflection and of transmission.
#[derive(Debug)]
pub(super) struct Lobes {
    lobes: [[Option<Lobe>; 2]; 2],
    luminance: Vec<f32>,
}

#[derive(Debug)]
enum Lobe {
    /// About directions with z > 0: those from the back are flipped.
    Histograms(Box<Distribution>),
    Patches(PatchSampler),
}

impl Lobes {
    pub(super) fn new(
        material: &Material,
        SamplerOptions { defensive, bytes: most, .. }: &SamplerOptions,
        luminance: Vec<f32>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, SamplerError> {
        let ways = SIDES.map(|light| SCATTERS.map(|scatter| material.holds(Aspect { scatter, light })));
        let count = ways.iter().flatten().filter(|&&holds| holds).count().max(1);
        let mut done = 0;
        let mut lobe = |front: usize, way: usize| -> Result<Option<Lobe>, SamplerError> {
            if !ways[front][way] {
                return Ok(None);
            }
            let aspect = Aspect { scatter: SCATTERS[way], light: SIDES[front] };
            let is_front = aspect.light == Side::Front;
            if let Some(patches) = material.bsdf().patches(aspect, &luminance, *defensive)? {
                return Ok(Some(Lobe::Patches(patches)));
            }
            let bytes = (material.bytes() + material.bytes() / 2).min(most.unwrap_or(usize::MAX)) / count;
            let mut options = DistributionOptions::unknown(aspect.scatter, material.is_isotropic(), bytes);
            options.defensive = *defensive;
            let mut side = LitSide { material, is_front, luminance: &luminance, values: Vec::new() };
            let mut light = |wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]| side.fill(wi, wo, out);
            let mut progress = |slice: usize, all: usize| progress(done * all + slice, count * all);
            let distribution = Distribution::of_function(material.backend(), &options, &mut light, &mut progress)?;
            done += 1;
            Ok(Some(Lobe::Histograms(Box::new(distribution))))
        };
        let lobes = [[lobe(0, 0)?, lobe(0, 1)?], [lobe(1, 0)?, lobe(1, 1)?]];
        Ok(Lobes { lobes, luminance })
    }

    /// The lobes there are: whether of the front, the index of its [way](SCATTERS), and itself.
    fn each(&self) -> impl Iterator<Item = (bool, usize, &Lobe)> {
        let lobes = self.lobes.iter().zip([true, false]);
        lobes.flat_map(|(ways, front)| {
            ways.iter().enumerate().filter_map(move |(way, lobe)| lobe.as_ref().map(|lobe| (front, way, lobe)))
        })
    }

    pub(super) fn bytes(&self) -> usize {
        let bytes = self.each().map(|(_, _, lobe)| match lobe {
            Lobe::Histograms(distribution) => distribution.bytes(),
            Lobe::Patches(patches) => patches.bytes(),
        });
        bytes.sum()
    }

    /// How likely each lobe is for each direction: reflection, transmission, and the mirrors of both.
    fn shares(&self, material: &Material, backend: Backend, known: &[[f32; 3]]) -> Vec<[f32; 4]> {
        let mut shares = vec![[0.0; 4]; known.len()];
        for (front, way, lobe) in self.each() {
            let queries = of_side(known, front);
            let mut brightness = vec![0.0; queries.len()];
            match lobe {
                Lobe::Histograms(distribution) => {
                    let known = pick(known, &queries, !front);
                    distribution.brightness_batch(backend, &known, &mut brightness);
                }
                Lobe::Patches(patches) => {
                    let of = |query: &usize| patches.brightness(known[*query]);
                    brightness.iter_mut().zip(&queries).for_each(|(out, query)| *out = of(query));
                }
            }
            // A lobe is never left out: what is dark between two slices may be bright in one place. Nor does one exceed all
            // numbers, as the brightness of values near the largest does.
            let share = |b: f32| if b > 1e-6 { b.min(1e30) } else { 1e-6 };
            queries.iter().zip(&brightness).for_each(|(&query, &b)| shares[query][way] = share(b));
        }
        if material.has_mirrors() {
            let mut reflectance = vec![0.0; self.luminance.len()];
            for (share, &known) in shares.iter_mut().zip(known) {
                for (way, scatter) in SCATTERS.into_iter().enumerate() {
                    if material.mirror(known, scatter, &mut reflectance).is_some() {
                        share[2 + way] = dot(&reflectance, &self.luminance);
                    }
                }
            }
        }
        for share in &mut shares {
            let total: f32 = share.iter().sum();
            if total > 0.0 {
                share.iter_mut().for_each(|part| *part /= total);
            }
        }
        shares
    }

    /// Draws directions; mirrors have a density of infinity. Returns the lobe of each and how likely it was.
    pub(super) fn draw(
        &self,
        material: &Material,
        backend: Backend,
        known: &[[f32; 3]],
        u: &[[f32; 2]],
        directions: &mut [[f32; 3]],
        pdfs: &mut [f32],
    ) -> Vec<(usize, f32)> {
        directions.fill([0.0; 3]);
        pdfs.fill(0.0);
        let shares = self.shares(material, backend, known);
        // The first number chooses the lobe, and what is left of it is as even as it was.
        let chosen: Vec<(usize, [f32; 2])> = shares.iter().zip(u).map(|(shares, &u)| choose(shares, u)).collect();
        for (front, way, lobe) in self.each() {
            let mut queries = of_side(known, front);
            queries.retain(|&query| chosen[query].0 == way && shares[query][way] > 0.0);
            let u: Vec<[f32; 2]> = queries.iter().map(|&query| chosen[query].1).collect();
            let (mut drawn, mut found) = (vec![[0.0; 3]; queries.len()], vec![0.0; queries.len()]);
            match lobe {
                Lobe::Histograms(distribution) => {
                    let known = pick(known, &queries, !front);
                    let (directions, pdfs) = (drawn.as_mut_slice(), found.as_mut_slice());
                    distribution.draw_batch(backend, &known, &u, directions, pdfs);
                    if !front {
                        directions.iter_mut().for_each(|direction| *direction = flipped(*direction));
                    }
                }
                Lobe::Patches(patches) => {
                    for ((&query, &u), out) in queries.iter().zip(&u).zip(drawn.iter_mut().zip(&mut found)) {
                        (*out.0, *out.1) = patches.draw(known[query], u);
                    }
                }
            }
            for ((&query, direction), pdf) in queries.iter().zip(drawn).zip(found) {
                (directions[query], pdfs[query]) = (direction, pdf * shares[query][way]);
            }
        }
        for (query, &(lobe, _)) in chosen.iter().enumerate().filter(|(_, (lobe, _))| *lobe >= 2) {
            (directions[query], pdfs[query]) = (mirrored(known[query], SCATTERS[lobe - 2]), f32::INFINITY);
        }
        chosen.iter().zip(&shares).map(|(&(lobe, _), shares)| (lobe, shares[lobe])).collect()
    }

    pub(super) fn sample(
        &self,
        material: &Material,
        backend: Backend,
        given: Given,
        known: &[[f32; 3]],
        u: &[[f32; 2]],
        mut out: Sampled<'_>,
    ) {
        let channels = material.channel_count();
        let lobes = self.draw(material, backend, known, u, out.directions, out.pdfs);
        let (wi, wo) = if given == Given::Light { (known, &*out.directions) } else { (&*out.directions, known) };
        material.eval_batch_on(backend, wi, wo, out.weights);
        out.times_cosine_over_density();
        for (query, &(lobe, share)) in lobes.iter().enumerate().filter(|(_, (lobe, _))| *lobe >= 2) {
            let weight = &mut out.weights[query * channels..][..channels];
            if material.mirror(known[query], SCATTERS[lobe - 2], weight).is_some() {
                weight.iter_mut().for_each(|reflectance| *reflectance /= share);
            }
        }
    }

    pub(super) fn pdf(
        &self,
        material: &Material,
        backend: Backend,
        known: &[[f32; 3]],
        other: &[[f32; 3]],
        pdfs: &mut [f32],
    ) {
        let shares = self.shares(material, backend, known);
        pdfs.fill(0.0);
        for (front, way, lobe) in self.each() {
            let mut queries = of_side(known, front);
            let is_above = |query: usize| (known[query][2] > 0.0) == (other[query][2] > 0.0);
            queries.retain(|&query| is_above(query) == (SCATTERS[way] == Scatter::Reflection));
            let mut found = vec![0.0; queries.len()];
            match lobe {
                Lobe::Histograms(distribution) => {
                    let [known, other] = [known, other].map(|from| pick(from, &queries, !front));
                    distribution.pdf_batch(backend, &known, &other, &mut found);
                }
                Lobe::Patches(patches) => {
                    let of = |query: &usize| patches.pdf(known[*query], other[*query]);
                    found.iter_mut().zip(&queries).for_each(|(out, query)| *out = of(query));
                }
            }
            queries.iter().zip(found).for_each(|(&query, pdf)| pdfs[query] = pdf * shares[query][way]);
        }
    }
}

/// A material lit from one side.
struct LitSide<'a> {
    material: &'a Material,
    is_front: bool,
    luminance: &'a [f32],
    values: Vec<f32>,
}

impl LitSide<'_> {
    /// Luminance times `f` of pairs that are given with this side up.
    fn fill(&mut self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        let channels = self.luminance.len();
        self.values.resize(wi.len() * channels, 0.0);
        if self.is_front {
            self.material.eval_batch(wi, wo, &mut self.values);
        } else {
            let [wi, wo] = [wi, wo].map(|from| from.iter().map(|&w| flipped(w)).collect::<Vec<_>>());
            self.material.eval_batch(&wi, &wo, &mut self.values);
        }
        for (out, texel) in out.iter_mut().zip(self.values.chunks_exact(channels)) {
            *out = dot(texel, self.luminance);
        }
    }
}

fn dot(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Which directions lie on that side.
fn of_side(directions: &[[f32; 3]], front: bool) -> Vec<usize> {
    let on_side = |z: f32| if front { z > 0.0 } else { z < 0.0 };
    (0..directions.len()).filter(|&query| on_side(directions[query][2])).collect()
}

/// Some of the directions, flipped if the back is to be up.
fn pick(directions: &[[f32; 3]], queries: &[usize], flip: bool) -> Vec<[f32; 3]> {
    let of = |&query: &usize| if flip { flipped(directions[query]) } else { directions[query] };
    queries.iter().map(of).collect()
}

/// The lobe that the first number falls on, and two numbers to draw from it with.
fn choose(shares: &[f32; 4], [u, w]: [f32; 2]) -> (usize, [f32; 2]) {
    let mut below = 0.0;
    let mut last = (0, [u, w]);
    for (lobe, &share) in shares.iter().enumerate().filter(|(_, share)| **share > 0.0) {
        last = (lobe, [((u - below) / share).clamp(0.0, 1.0), w]);
        if u < below + share {
            break;
        }
        below += share;
    }
    last
}
