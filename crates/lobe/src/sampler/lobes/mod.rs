//! A mixture of lobes: one of reflection and one of transmission for each side, and mirrors.

mod draw;
mod mirrors;
mod sides;

use lobe_table::{
    Aspect, Distribution, DistributionOptions, PatchSampler, SamplerError, SamplerOptions, Scatter, Side,
};

use crate::material::flipped;
use crate::{Backend, Material};

const SCATTERS: [Scatter; 2] = [Scatter::Reflection, Scatter::Transmission];
const SIDES: [Side; 2] = [Side::Front, Side::Back];

/// The lobes for light from the front and from the back, of reflection and of transmission.
#[derive(Debug)]
pub(super) struct Lobes {
    lobes: [[Option<Lobe>; 2]; 2],
    luminance: Vec<f32>,
    has_mirrors: bool,
}

#[derive(Debug)]
enum Lobe {
    /// For directions with z > 0: those from the back are flipped.
    Histograms(Box<Distribution>),
    Patches(Box<PatchSampler>),
}

impl Lobes {
    pub(super) fn new(
        material: &Material,
        SamplerOptions { defensive, bytes: most, evaluations, .. }: &SamplerOptions,
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
                return Ok(Some(Lobe::Patches(Box::new(patches))));
            }
            let bytes = (material.bytes() + material.bytes() / 2).min(most.unwrap_or(usize::MAX)) / count;
            let mut options = DistributionOptions::unknown(aspect.scatter, material.is_isotropic(), bytes);
            options.defensive = *defensive;
            options.evaluations = evaluations.map(|all| all / count);
            let mut side = LitSide { material, is_front, luminance: &luminance, values: Vec::new() };
            let mut light = |wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]| side.fill(wi, wo, out);
            let mut progress = |slice: usize, all: usize| progress(done * all + slice, count * all);
            let distribution = Distribution::of_function(material.backend(), &options, &mut light, &mut progress)?;
            done += 1;
            Ok(Some(Lobe::Histograms(Box::new(distribution))))
        };
        let lobes = [[lobe(0, 0)?, lobe(0, 1)?], [lobe(1, 0)?, lobe(1, 1)?]];
        Ok(Lobes { lobes, luminance, has_mirrors: material.has_mirrors() })
    }

    /// The existing lobes: whether each is for the front, the index of its [scatter](SCATTERS), and the lobe itself.
    fn each(&self) -> impl Iterator<Item = (bool, usize, &Lobe)> {
        let lobes = self.lobes.iter().zip([true, false]);
        lobes.flat_map(|(ways, front)| {
            ways.iter().enumerate().filter_map(move |(way, lobe)| lobe.as_ref().map(|lobe| (front, way, lobe)))
        })
    }

    /// The lobe of all these directions, if there is only one.
    fn only(&self, known: &[[f32; 3]]) -> Option<&Lobe> {
        let lobe = match &self.lobes[0] {
            [Some(lobe), None] | [None, Some(lobe)] if !self.has_mirrors => lobe,
            _ => return None,
        };
        known.iter().all(|direction| direction[2] > 0.0).then_some(lobe)
    }

    pub(super) fn is_limited(&self) -> bool {
        self.each().any(|(_, _, lobe)| matches!(lobe, Lobe::Histograms(distribution) if distribution.is_limited()))
    }

    pub(super) fn bytes(&self) -> usize {
        let bytes = self.each().map(|(_, _, lobe)| match lobe {
            Lobe::Histograms(distribution) => distribution.bytes(),
            Lobe::Patches(patches) => patches.bytes(),
        });
        bytes.sum()
    }
}

impl Lobe {
    fn brightness(&self, backend: Backend, known: &[[f32; 3]], out: &mut [f32]) {
        match self {
            Lobe::Histograms(distribution) => distribution.brightness_batch(backend, known, out),
            Lobe::Patches(patches) => patches.brightness_batch(backend, known, out),
        }
    }

    fn draw(
        &self,
        backend: Backend,
        known: &[[f32; 3]],
        u: &[[f32; 2]],
        directions: &mut [[f32; 3]],
        pdfs: &mut [f32],
    ) {
        match self {
            Lobe::Histograms(distribution) => distribution.draw_batch(backend, known, u, directions, pdfs),
            Lobe::Patches(patches) => patches.draw_batch(backend, known, u, directions, pdfs),
        }
    }

    fn pdf(&self, backend: Backend, known: &[[f32; 3]], other: &[[f32; 3]], pdfs: &mut [f32]) {
        match self {
            Lobe::Histograms(distribution) => distribution.pdf_batch(backend, known, other, pdfs),
            Lobe::Patches(patches) => patches.pdf_batch(backend, known, other, pdfs),
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
    /// Luminance times `f`, for pairs given with this side up.
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
